//! Occupied cubes of a cloud and their neighbours.

use glam::DVec3;

use crate::cubes;

/// Occupied cubes of a cloud, sorted, each with its points.
#[derive(Clone, Debug)]
pub struct Voxels {
    cell: f64,
    /// Positions of the cubes: z, y, x.
    keys: Vec<[i32; 3]>,
    /// First row of each cube in `order`, and the number of rows at the end.
    start: Vec<usize>,
    /// Indices of points, cube by cube.
    order: Vec<u32>,
    /// First cube of each line of cubes along x, line (z, y) at `z * wide + y`.
    lines: Vec<u32>,
    wide: i32,
}

impl Voxels {
    /// Makes cubes of 1/256 of the cloud, or coarser until a cube holds `occupancy` points on average.
    pub fn new(points: &[DVec3], occupancy: f64) -> Self {
        let mut cell = (extent(points) / 256.0).max(1e-12);
        loop {
            let keyed = cubes(points, cell);
            let cubes = count(&keyed);
            if keyed.len() as f64 >= occupancy * cubes as f64 || cubes <= 8 {
                return Self::from_keys(&keyed, cell);
            }
            cell *= 1.3;
        }
    }

    /// Makes cubes of edge `cell`, or larger ones if a box around the points has more than 2^24 lines of such cubes.
    pub fn with_cell(points: &[DVec3], cell: f64) -> Self {
        let finite = || points.iter().copied().filter(|p| p.is_finite());
        let (low, high) =
            finite().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), p| (a.min(p), b.max(p)));
        let size = high - low;
        let mut cell = cell.max(1e-12);
        while (size.y / cell + 1.0) * (size.z / cell + 1.0) > 16_777_216.0 {
            cell *= 1.3;
        }
        Self::from_keys(&cubes(points, cell), cell)
    }

    fn from_keys(keyed: &[([i32; 3], u32)], cell: f64) -> Self {
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
            // At most 2^24 lines: cubes are coarse enough.
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

    /// Returns the cubes of a line along x.
    fn cubes_of(&self, z: i32, y: i32) -> core::ops::Range<usize> {
        if z < 0 || !(0..self.wide).contains(&y) {
            return 0..0;
        }
        let line = self.line(z, y);
        let Some(&first) = self.lines.get(line) else { return 0..0 };
        first as usize..self.lines.get(line + 1).map_or(self.keys.len(), |&end| end as usize)
    }

    /// Returns the edge of a cube.
    pub const fn cell(&self) -> f64 {
        self.cell
    }

    /// Returns the position of a cube: z, y, x in cubes from the lowest corner.
    pub fn key(&self, cube: usize) -> [i32; 3] {
        self.keys[cube]
    }

    /// Returns the number of occupied cubes.
    pub fn len(&self) -> usize {
        self.keys.len()
    }

    /// Whether no cube is occupied.
    pub fn is_empty(&self) -> bool {
        self.keys.is_empty()
    }

    /// Returns the points of a cube.
    pub fn rows(&self, cube: usize) -> &[u32] {
        &self.order[self.start[cube]..self.start[cube + 1]]
    }

    /// Calls `f` with every occupied cube at most `reach` cubes away along each axis, including itself.
    pub fn near(&self, cube: usize, reach: i32, mut f: impl FnMut(usize)) {
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

    /// Returns the mean of each cube's points.
    pub fn means(&self, points: &[DVec3]) -> Vec<DVec3> {
        (0..self.len())
            .map(|c| {
                let rows = self.rows(c);
                rows.iter().map(|&i| points[i as usize]).sum::<DVec3>() / rows.len() as f64
            })
            .collect()
    }
}

/// Returns the longest edge of the box around the finite points; 0 without any. Linear.
pub fn extent(points: &[DVec3]) -> f64 {
    let (low, high) = points
        .iter()
        .filter(|p| p.is_finite())
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), &p| (a.min(p), b.max(p)));
    (high - low).max_element().max(0.0)
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
}
