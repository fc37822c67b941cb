//! The oriented box of points, in which a lattice is placed.

use glam::DVec3;

/// An oriented bounding box: `corner + s * edge0 + t * edge1 + u * edge2` with s, t, u in \[0, 1\].
///
/// ```
/// use glam::DVec3;
/// let flat = [DVec3::ZERO, DVec3::X * 4.0, DVec3::Y * 2.0, DVec3::new(4.0, 2.0, 0.0)];
/// let b = bloom::Obb::fit(&flat, 0.05).unwrap();
/// assert!((b.size[2] - 0.2).abs() < 1e-4, "a flat organ gets the floor: {:?}", b.size);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Obb {
    /// The corner with s = t = u = 0, metres.
    pub corner: DVec3,
    /// Unit edge directions, right-handed, greatest variance first.
    pub axes: [DVec3; 3],
    /// Edge lengths, metres, all above 0.
    pub size: [f64; 3],
}

impl Obb {
    /// Fits principal axes of the finite points and the box around them (Huai, Yang and Cai 2019, algorithm 1).
    ///
    /// `floor`: the least edge as a share of the longest, 0 to 1; a flat petal with 0 thickness would have no third
    /// coordinate. The paper gives none; 0.05 suits petals. Each edge is padded by 1e-6 of itself so that s, t and u
    /// stay inside \[0, 1\]. `None` without a finite point. Cost: linear.
    pub fn fit(points: &[DVec3], floor: f64) -> Option<Self> {
        let (_, [major, middle, _], _) = geom::pca3(points)?;
        let (major, middle) = (towards_positive(major), towards_positive(middle));
        Some(Self::along(points, [major, middle, major.cross(middle)], floor))
    }

    /// Makes the box around the finite points along given right-handed orthonormal axes.
    pub fn along(points: &[DVec3], axes: [DVec3; 3], floor: f64) -> Self {
        let usable = || points.iter().copied().filter(|p| p.is_finite());
        let origin = usable().next().unwrap_or(DVec3::ZERO);
        let mut low = [0.0_f64; 3];
        let mut size = [0.0_f64; 3];
        for k in 0..3 {
            let along = || usable().map(|p| (p - origin).dot(axes[k]));
            low[k] = along().fold(0.0, f64::min);
            size[k] = along().fold(0.0, f64::max) - low[k];
        }
        let longest = size.iter().copied().fold(0.0, f64::max);
        // 1e-9: a single point still gets a box.
        let least = (longest * floor.clamp(0.0, 1.0)).max(1e-9);
        let mut corner = origin;
        for k in 0..3 {
            let whole = size[k].max(least) * (1.0 + 2e-6);
            corner += axes[k] * (low[k] - 0.5 * (whole - size[k]));
            size[k] = whole;
        }
        Self { corner, axes, size }
    }

    /// Returns a point's coordinates (s, t, u); inside the box each is in \[0, 1\] (Sederberg and Parry, eq 1).
    pub fn local(&self, p: DVec3) -> DVec3 {
        let d = p - self.corner;
        DVec3::new(
            d.dot(self.axes[0]) / self.size[0],
            d.dot(self.axes[1]) / self.size[1],
            d.dot(self.axes[2]) / self.size[2],
        )
    }

    /// Returns the point with coordinates (s, t, u).
    pub fn world(&self, stu: DVec3) -> DVec3 {
        self.corner
            + self.axes[0] * (stu.x * self.size[0])
            + self.axes[1] * (stu.y * self.size[1])
            + self.axes[2] * (stu.z * self.size[2])
    }

    /// Returns the centre of the box.
    pub fn centre(&self) -> DVec3 {
        self.world(DVec3::splat(0.5))
    }
}

// The sign of an eigenvector is arbitrary: the largest coordinate is made positive.
fn towards_positive(v: DVec3) -> DVec3 {
    let a = v.abs();
    let largest = if a.x >= a.y && a.x >= a.z {
        v.x
    } else if a.y >= a.z {
        v.y
    } else {
        v.z
    };
    if largest < 0.0 { -v } else { v }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn every_point_lies_inside_and_comes_back(
            points in prop::collection::vec((-1.0..1.0_f64, -0.2..0.2_f64, -0.01..0.01_f64), 1..40),
            angle in 0.0..6.0_f64, far in -1e3..1e3_f64,
        ) {
            let q = base::turn::about(DVec3::new(0.6, 0.0, 0.8), angle);
            let points: Vec<DVec3> =
                points.iter().map(|&(x, y, z)| q * DVec3::new(x, y, z) + DVec3::splat(far)).collect();
            let b = Obb::fit(&points, 0.05).unwrap();
            for &p in &points {
                let l = b.local(p);
                prop_assert!(l.min_element() >= 0.0 && l.max_element() <= 1.0, "{l}");
                prop_assert!((b.world(l) - p).length() < 1e-9);
            }
            let longest = b.size.iter().copied().fold(0.0, f64::max);
            prop_assert!(b.size.iter().all(|&s| s >= 0.0499 * longest));
            prop_assert!((b.axes[0].cross(b.axes[1]) - b.axes[2]).length() < 1e-9);
        }
    }

    #[test]
    fn hostile_points_are_left_out() {
        assert_eq!(Obb::fit(&[DVec3::NAN], 0.05), None);
        let b = Obb::fit(&[DVec3::ONE, DVec3::INFINITY], 0.05).unwrap();
        assert!(b.size.iter().all(|s| *s > 0.0), "{b:?}");
    }
}
