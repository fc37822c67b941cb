//! A leaf of parallel veins measured from the side: its midrib and its width along it -> chief veins.

use glam::{DVec2, DVec3};

use crate::rays::Rays;

/// A midrib seen from the side, and the width of the blade along it, as leaves of grasses are digitised (Prevot, Aries
/// and Monestiez 1991).
///
/// ```
/// use glam::DVec2;
/// use leaf::LeafProfile;
/// let midrib = vec![DVec2::ZERO, DVec2::new(0.1, 0.3), DVec2::new(0.3, 0.4)];
/// let leaf = LeafProfile { midrib, width: vec![(0.0, 0.02), (0.3, 0.05), (0.55, 0.0)] };
/// let rays = leaf.rays(10).expect("a midrib and a width").rays;
/// assert_eq!((rays.len(), rays[5].points[9]), (11, glam::DVec3::new(0.3, 0.4, 0.0)));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LeafProfile {
    /// Points of the midrib from base to tip, metres: x away from the stem, y upwards.
    pub midrib: Vec<DVec2>,
    /// Widths of the blade from margin to margin by length along the midrib from the base, metres, in rising order.
    pub width: Vec<(f64, f64)>,
}

/// Reason why a profile makes no leaf.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ProfileError {
    /// There are too few distinct points.
    #[error("the midrib has {0} points that differ; at least 2 are needed")]
    Midrib(usize),
    /// There are too few widths, or none above 0.
    #[error("the blade has {0} widths above 0; at least 1 is needed, and 2 places along the midrib")]
    Width(usize),
    /// Positions along the midrib do not rise, or a width is negative or not a number.
    #[error(
        "width {0}: places along the midrib must rise and be finite, and widths be 0 or more; measure it again"
    )]
    Order(usize),
}

/// Least width as a share of the greatest: veins do not meet in a point.
const LEAST_WIDTH: f64 = 0.01;
/// Number of veins, as in [`crate::ParallelSpec`].
const VEINS: u32 = 9;

impl LeafProfile {
    /// Makes a flat blade across the midrib with parallel veins, nine and the margins, through `marks` (3 or more) even
    /// lengths.
    ///
    /// The midrib lies in the plane z = 0; seen on its upper side with the tip up, the right margin is at +z. Positions
    /// of widths are scaled if their total is not the midrib's length (widths are measured on the leaf laid flat,
    /// midribs on a picture). Number and thickness of the veins are those of [`Rays::parallel`], not measured. Nothing
    /// is invented beyond the profile: the blade has no keel, and its margins do not wave.
    ///
    /// # Errors
    /// [`ProfileError`].
    pub fn rays(&self, marks: usize) -> Result<Rays, ProfileError> {
        let line: Vec<DVec3> = self.midrib.iter().map(|p| p.extend(0.0)).collect();
        let length = geom::polyline_length3(&line);
        let usable = line.iter().all(|p| p.is_finite());
        if line.len() < 2 || !usable || length <= 0.0 {
            let differ = self.midrib.windows(2).filter(|w| w[0] != w[1]).count();
            return Err(ProfileError::Midrib(differ + usize::from(!line.is_empty())));
        }
        let ordered = |k: usize| k == 0 || self.width[k - 1].0 < self.width[k].0;
        let sound = |&k: &usize| {
            let (s, w) = self.width[k];
            s.is_finite() && w.is_finite() && w >= 0.0 && ordered(k)
        };
        if let Some(k) = (0..self.width.len()).find(|k| !sound(k)) {
            return Err(ProfileError::Order(k + 1));
        }
        let widest = self.width.iter().map(|w| w.1).fold(0.0, f64::max);
        if self.width.len() < 2 || widest <= 0.0 {
            return Err(ProfileError::Width(self.width.iter().filter(|w| w.1 > 0.0).count()));
        }
        let (from, to) = (self.width[0].0, self.width[self.width.len() - 1].0);
        let marks = marks.max(3);
        let place = |share: f64, across: f64| {
            let half = 0.5 * self.width_at(from + share * (to - from)).max(LEAST_WIDTH * widest);
            self.midrib_point(share * length).extend(across * half)
        };
        Ok(Rays::side_by_side(VEINS, marks, 0.5 * widest, place))
    }

    /// Returns the factor by which [`rays`](Self::rays) stretches the positions of the widths, so that their total is
    /// the midrib's length: 1 where the two agree. The area grows by the same factor. Not finite, or 0, if the profile
    /// makes no leaf.
    pub fn stretch(&self) -> f64 {
        let line: Vec<DVec3> = self.midrib.iter().map(|p| p.extend(0.0)).collect();
        let span = self.width.last().zip(self.width.first()).map_or(0.0, |(last, first)| last.0 - first.0);
        geom::polyline_length3(&line) / span
    }

    /// Returns the point of the midrib at `s` from its base.
    fn midrib_point(&self, s: f64) -> DVec2 {
        crate::graph::along(&self.midrib, s).0
    }

    fn width_at(&self, s: f64) -> f64 {
        let after = self.width.partition_point(|w| w.0 <= s).clamp(1, self.width.len() - 1);
        let ((a, x), (b, y)) = (self.width[after - 1], self.width[after]);
        base::ops::lerp(x, y, ((s - a) / (b - a)).clamp(0.0, 1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn blade() -> LeafProfile {
        LeafProfile {
            midrib: vec![DVec2::ZERO, DVec2::new(0.0, 0.3), DVec2::new(0.4, 0.3)],
            width: vec![(0.0, 0.02), (0.35, 0.06), (0.7, 0.0)],
        }
    }

    #[test]
    fn veins_lie_across_the_midrib_as_wide_as_measured() {
        let rays = blade().rays(8).unwrap();
        assert_eq!(rays.validate().next(), None);
        assert_eq!((rays.rays.len(), rays.rays.iter().filter(|r| r.is_vein()).count()), (11, 9));
        assert!((rays.length() - 0.7).abs() < 1e-12);
        // The fifth of eight points is 0.4 along the midrib, in the second leg of the bend.
        let across: Vec<DVec3> = rays.rays.iter().map(|r| r.points[4]).collect();
        assert!((across[5] - DVec3::new(0.1, 0.3, 0.0)).length() < 1e-12, "{across:?}");
        let want = 0.06 * (0.7 - 0.4) / 0.35;
        assert!((across[0].distance(across[10]) - want).abs() < 1e-12, "{across:?}");
        assert!(across[0].z > 0.0, "the right margin is at +z");
        assert!(crate::RayLeaf::new(&rays, crate::ThicknessRule::Diameter).is_ok());
    }

    #[test]
    fn widths_that_are_stretched_to_the_midrib_are_told() {
        assert!((blade().stretch() - 1.0).abs() < 1e-12);
        let mut short = blade();
        short.width.iter_mut().for_each(|w| w.0 *= 0.5);
        assert!((short.stretch() - 2.0).abs() < 1e-12);
        let area = |leaf: &LeafProfile| {
            let rays = leaf.rays(40).unwrap().rays;
            let width = |k: usize| rays[0].points[k].distance(rays[10].points[k]);
            (0..40).map(width).sum::<f64>() * leaf.stretch().max(1.0)
        };
        assert!(area(&short) > 1.9 * area(&blade()));
    }

    #[test]
    fn profiles_that_make_no_leaf_say_why() {
        let fault = |change: fn(&mut LeafProfile)| {
            let mut leaf = blade();
            change(&mut leaf);
            leaf.rays(9).unwrap_err()
        };
        assert_eq!(fault(|l| l.midrib.truncate(1)), ProfileError::Midrib(1));
        assert_eq!(fault(|l| l.midrib = vec![DVec2::ONE; 4]), ProfileError::Midrib(1));
        assert_eq!(fault(|l| l.midrib[1].x = f64::NAN), ProfileError::Midrib(3));
        assert_eq!(fault(|l| l.width[1].0 = 0.0), ProfileError::Order(2));
        assert_eq!(fault(|l| l.width[2].1 = -1.0), ProfileError::Order(3));
        assert_eq!(fault(|l| l.width.truncate(1)), ProfileError::Width(1));
        assert_eq!(fault(|l| l.width.iter_mut().for_each(|w| w.1 = 0.0)), ProfileError::Width(0));
    }
}
