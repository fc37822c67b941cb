//! Many points -> few, evenly spread.

use geom::cubes;
use glam::DVec3;

/// Occupied cubes of a cloud, sorted, each with its points.
#[derive(Clone, Debug)]
pub(crate) struct Voxels {
    /// Edge of a cube, metres.
    pub(crate) cell: f64,
    /// Places of the cubes: z, y, x.
    pub(crate) keys: Vec<[i32; 3]>,
    /// First row of each cube in `order`, and the number of rows at the end.
    pub(crate) start: Vec<usize>,
    /// Indices of points, cube by cube.
    pub(crate) order: Vec<u32>,
    /// First cube of each line of cubes along x, line (z, y) at `z * wide + y`.
    lines: Vec<u32>,
    wide: i32,
}

impl Voxels {
    /// Cubes as fine as 1/256 of the cloud, or coarser until a cube holds `occupancy` points in the mean.
    pub(crate) fn new(points: &[DVec3], occupancy: f64) -> Self {
        let mut cell = (extent(points) / 256.0).max(1e-12);
        loop {
            let keyed = cubes(points, cell);
            let cubes = count(&keyed);
            if keyed.len() as f64 >= occupancy * cubes as f64 || cubes <= 8 {
                return Self::of(&keyed, cell);
            }
            cell *= 1.3;
        }
    }

    fn of(keyed: &[([i32; 3], u32)], cell: f64) -> Self {
        let mut v = Self {
            cell,
            keys: vec![],
            start: vec![],
            order: Vec::with_capacity(keyed.len()),
            lines: vec![],
            wide: keyed.iter().map(|k| k.0[1]).max().unwrap_or(0) + 1,
        };
        for cube in keyed.chunk_by(|a, b| a.0 == b.0) {
            let key = cube[0].0;
            let line = v.line(key[0], key[1]);
            #[expect(
                clippy::cast_possible_truncation,
                reason = "no more cubes than points, whose indices are u32"
            )]
            let row = v.keys.len() as u32;
            // At most 257 x 257 lines: cubes are no finer than 1/256 of the cloud.
            v.lines.resize(v.lines.len().max(line + 1), row);
            v.keys.push(key);
            v.start.push(v.order.len());
            v.order.extend(cube.iter().map(|&(_, i)| i));
        }
        v.start.push(v.order.len());
        v
    }

    #[expect(clippy::cast_sign_loss, reason = "z and y are not negative")]
    fn line(&self, z: i32, y: i32) -> usize {
        z as usize * self.wide as usize + y as usize
    }

    /// The cubes of a line along x.
    fn cubes_of(&self, z: i32, y: i32) -> core::ops::Range<usize> {
        if z < 0 || !(0..self.wide).contains(&y) {
            return 0..0;
        }
        let line = self.line(z, y);
        let Some(&first) = self.lines.get(line) else { return 0..0 };
        first as usize..self.lines.get(line + 1).map_or(self.keys.len(), |&end| end as usize)
    }

    pub(crate) fn len(&self) -> usize {
        self.keys.len()
    }

    /// Points of a cube.
    pub(crate) fn rows(&self, cube: usize) -> &[u32] {
        &self.order[self.start[cube]..self.start[cube + 1]]
    }

    /// Calls `f` with every occupied cube at most `reach` cubes away along each axis, itself too.
    pub(crate) fn near(&self, cube: usize, reach: i32, mut f: impl FnMut(usize)) {
        let [z, y, x] = self.keys[cube];
        for dz in -reach..=reach {
            for dy in -reach..=reach {
                let line = self.cubes_of(z + dz, y + dy);
                let first = line.start + self.keys[line.clone()].partition_point(|k| k[2] < x - reach);
                for at in first..line.end {
                    if self.keys[at][2] > x + reach {
                        break;
                    }
                    f(at);
                }
            }
        }
    }

    /// Mean of each cube's points.
    pub(crate) fn means(&self, points: &[DVec3]) -> Vec<DVec3> {
        (0..self.len())
            .map(|c| {
                let rows = self.rows(c);
                rows.iter().map(|&i| points[i as usize]).sum::<DVec3>() / rows.len() as f64
            })
            .collect()
    }
}

/// Edge of the box around the finite points, the longest.
pub(crate) fn extent(points: &[DVec3]) -> f64 {
    let (low, high) = points
        .iter()
        .filter(|p| p.is_finite())
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), &p| (a.min(p), b.max(p)));
    (high - low).max_element().max(0.0)
}

/// Indices of at most about `wanted` points, one a cube, so that a dense part weighs no more than a sparse one.
///
/// Of a cube the point nearest to the mean of the cube's points is kept. All finite points if they are few.
pub(crate) fn thin(points: &[DVec3], wanted: usize) -> Vec<u32> {
    let size = extent(points);
    if size <= 0.0 || points.iter().filter(|p| p.is_finite()).count() <= wanted {
        #[expect(clippy::cast_possible_truncation, reason = "indices are below 2^32 points")]
        return (0..points.len()).filter(|&i| points[i].is_finite()).map(|i| i as u32).collect();
    }
    // The search needs counts only: on at most 50,000 points it is quick, and such a sample fills the cubes.
    let sample: Vec<DVec3> = points.iter().copied().step_by(points.len().div_ceil(50_000)).collect();
    let (mut low, mut high) = (size / 4096.0, size);
    for _ in 0..24 {
        let middle = (low * high).sqrt();
        if count(&cubes(&sample, middle)) > wanted { low = middle } else { high = middle }
    }
    geom::one_a_cube(points, high)
}

fn count(keyed: &[([i32; 3], u32)]) -> usize {
    keyed.chunk_by(|a, b| a.0 == b.0).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_finds_what_is_near() {
        let mut s = base::Seed::new(5).stream(base::Draw::Test);
        let points: Vec<DVec3> =
            (0..3000).map(|_| DVec3::new(s.uniform(), s.uniform(), 0.1 * s.uniform())).collect();
        let v = Voxels::new(&points, 2.0);
        for c in (0..v.len()).step_by(7) {
            let mut got = vec![];
            v.near(c, 2, |k| got.push(k));
            let far = |k: usize| (0..3).map(|a| (v.keys[k][a] - v.keys[c][a]).abs()).max();
            let want: Vec<usize> = (0..v.len()).filter(|&k| far(k) <= Some(2)).collect();
            assert_eq!(got, want, "cube {c}");
        }
    }

    #[test]
    fn a_dense_half_weighs_no_more_than_a_sparse_one() {
        let mut s = base::Seed::new(1).stream(base::Draw::Test);
        let mut points: Vec<DVec3> = (0..20_000).map(|_| DVec3::new(s.uniform(), s.uniform(), 0.0)).collect();
        points.extend((0..2_000).map(|_| DVec3::new(1.0 + s.uniform(), s.uniform(), 0.0)));
        let kept = thin(&points, 400);
        let right = kept.iter().filter(|&&i| points[i as usize].x > 1.0).count();
        assert!((200..=480).contains(&kept.len()), "{}", kept.len());
        assert!(right * 5 > kept.len() * 2, "{right} of {}", kept.len());
        assert_eq!(
            thin(&[DVec3::NAN, DVec3::ONE, DVec3::ONE], 1).len(),
            2,
            "points at one place are all kept"
        );
    }
}
