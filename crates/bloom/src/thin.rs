//! Many points -> few, evenly spread.

use glam::DVec3;

/// Indices of points that are sorted into cubes of edge `cell`, with the cube of each: by z, y, x.
pub(crate) fn voxels(points: &[DVec3], cell: f64) -> Vec<([i32; 3], u32)> {
    let low = points.iter().filter(|p| p.is_finite()).fold(DVec3::INFINITY, |a, &p| a.min(p));
    #[expect(
        clippy::cast_possible_truncation,
        reason = "saturation is wanted; indices are below 2^32 points"
    )]
    let mut keyed: Vec<([i32; 3], u32)> = points
        .iter()
        .enumerate()
        .filter(|(_, p)| p.is_finite())
        .map(|(i, &p)| {
            let c = ((p - low) / cell).floor();
            ([c.z as i32, c.y as i32, c.x as i32], i as u32)
        })
        .collect();
    keyed.sort_unstable();
    keyed
}

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
}

impl Voxels {
    /// Cubes as fine as 1/256 of the cloud, or coarser until a cube holds `occupancy` points in the mean.
    pub(crate) fn new(points: &[DVec3], occupancy: f64) -> Self {
        let mut cell = (extent(points) / 256.0).max(1e-12);
        loop {
            let keyed = voxels(points, cell);
            let cubes = count(&keyed);
            if keyed.len() as f64 >= occupancy * cubes as f64 || cubes <= 8 {
                return Self::of(&keyed, cell);
            }
            cell *= 1.3;
        }
    }

    fn of(keyed: &[([i32; 3], u32)], cell: f64) -> Self {
        let mut v = Self { cell, keys: vec![], start: vec![], order: Vec::with_capacity(keyed.len()) };
        for cube in keyed.chunk_by(|a, b| a.0 == b.0) {
            v.keys.push(cube[0].0);
            v.start.push(v.order.len());
            v.order.extend(cube.iter().map(|&(_, i)| i));
        }
        v.start.push(v.order.len());
        v
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
                let low = [z.saturating_add(dz), y.saturating_add(dy), x.saturating_sub(reach)];
                let mut at = self.keys.partition_point(|k| *k < low);
                while let Some(k) = self.keys.get(at) {
                    if k[0] != low[0] || k[1] != low[1] || k[2] > x.saturating_add(reach) {
                        break;
                    }
                    f(at);
                    at += 1;
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
    let all = voxels(points, f64::MAX);
    let size = extent(points);
    if all.len() <= wanted || size <= 0.0 {
        return all.into_iter().map(|(_, i)| i).collect();
    }
    // The search needs counts only: on at most 50,000 points it is quick, and such a sample fills the cubes.
    let sample: Vec<DVec3> = points.iter().copied().step_by(points.len().div_ceil(50_000)).collect();
    let (mut low, mut high) = (size / 4096.0, size);
    for _ in 0..24 {
        let middle = (low * high).sqrt();
        if count(&voxels(&sample, middle)) > wanted { low = middle } else { high = middle }
    }
    let keyed = voxels(points, high);
    let mut out = Vec::new();
    for cube in keyed.chunk_by(|a, b| a.0 == b.0) {
        let at = |&(_, i): &([i32; 3], u32)| points[i as usize];
        let mean = cube.iter().map(at).sum::<DVec3>() / cube.len() as f64;
        let nearest =
            cube.iter().min_by(|a, b| at(a).distance_squared(mean).total_cmp(&at(b).distance_squared(mean)));
        out.extend(nearest.map(|&(_, i)| i));
    }
    out
}

fn count(keyed: &[([i32; 3], u32)]) -> usize {
    keyed.chunk_by(|a, b| a.0 == b.0).count()
}

#[cfg(test)]
mod tests {
    use super::*;

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
