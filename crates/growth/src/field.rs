//! Attraction points in a uniform grid, each with the joint that is nearest to it.
//!
//! Flat arrays sorted by cell. Every cell knows how far the nearest joint of its worst-served point is, so a new
//! joint visits only cells in which it can be nearer to something: that, not the perception radius, sets the cost.

use glam::DVec3;

/// No joint.
pub(crate) const NOBODY: u32 = u32::MAX;
/// No place: the point is gone.
const GONE: u32 = u32::MAX;
/// Points per cell aimed at: fewer cost more cells to visit, more cost more points to test.
const PER_CELL: f64 = 5.0;

/// What an offer did to one point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Change {
    /// The joint that had it; [`NOBODY`] if none.
    pub(crate) from: u32,
    /// The point.
    pub(crate) place: DVec3,
    /// Its index in the input.
    pub(crate) id: u32,
    /// It was near enough to be consumed.
    pub(crate) killed: bool,
}

#[derive(Clone, Debug)]
pub(crate) struct Field {
    x: Vec<f64>,
    y: Vec<f64>,
    z: Vec<f64>,
    /// Squared distance to the nearest joint so far; the squared perception radius while there is none.
    best2: Vec<f64>,
    owner: Vec<u32>,
    id: Vec<u32>,
    /// Slot of each point by input index, or [`GONE`].
    slot: Vec<u32>,
    /// First slot of each cell and number of points left in it.
    start: Vec<u32>,
    left: Vec<u32>,
    /// Upper bound of `best2` in each cell; 0 where it is empty.
    reach2: Vec<f64>,
    far: f64,
    lo: DVec3,
    cell: f64,
    dims: [usize; 3],
    alive: usize,
}

impl Field {
    /// Puts usable points into cells; the others are gone from the start. `usable` has one entry for each point;
    /// `perception_m` is above 0.
    pub(crate) fn new(points: &[DVec3], usable: &[bool], perception_m: f64) -> Self {
        let good: Vec<u32> = (0..index(points.len())).filter(|&i| usable[i as usize]).collect();
        let (lo, cell, dims) = layout(points, &good, perception_m);
        let cells = dims[0] * dims[1] * dims[2];
        let mut field = Self {
            x: vec![0.0; good.len()],
            y: vec![0.0; good.len()],
            z: vec![0.0; good.len()],
            best2: vec![perception_m * perception_m; good.len()],
            owner: vec![NOBODY; good.len()],
            id: vec![0; good.len()],
            slot: vec![GONE; points.len()],
            start: vec![0; cells + 1],
            left: vec![0; cells],
            reach2: vec![0.0; cells],
            far: perception_m,
            lo,
            cell,
            dims,
            alive: good.len(),
        };
        // Counting sort: the order within a cell is the order of the input.
        let of: Vec<u32> = good.iter().map(|&i| index(field.cell_index(points[i as usize]))).collect();
        for &c in &of {
            field.left[c as usize] += 1;
        }
        for c in 0..cells {
            field.start[c + 1] = field.start[c] + field.left[c];
            if field.left[c] > 0 {
                field.reach2[c] = perception_m * perception_m;
            }
        }
        let mut next = field.start.clone();
        for (&i, &c) in good.iter().zip(&of) {
            let s = next[c as usize] as usize;
            next[c as usize] += 1;
            let p = points[i as usize];
            (field.x[s], field.y[s], field.z[s], field.id[s]) = (p.x, p.y, p.z, i);
            field.slot[i as usize] = index(s);
        }
        field
    }

    /// Points not yet consumed or given up.
    pub(crate) const fn alive(&self) -> usize {
        self.alive
    }

    /// Lets every point within its present distance choose the new joint at `p`, where `sees` the point.
    #[inline]
    pub(crate) fn offer(
        &mut self,
        p: DVec3,
        joint: u32,
        kill2: f64,
        sees: impl Fn(DVec3) -> bool,
        mut changed: impl FnMut(Change),
    ) {
        let (from, to) = (self.coordinates(p - self.far), self.coordinates(p + self.far));
        for k in from[2]..=to[2] {
            let dz = self.gap(p.z, 2, k);
            let dz2 = dz * dz;
            for j in from[1]..=to[1] {
                let dy = self.gap(p.y, 1, j);
                let dyz2 = dy * dy + dz2;
                let row = (k * self.dims[1] + j) * self.dims[0];
                for i in from[0]..=to[0] {
                    let reach2 = self.reach2[row + i];
                    if reach2 <= dyz2 {
                        continue;
                    }
                    let dx = self.gap(p.x, 0, i);
                    if reach2 > dx * dx + dyz2 {
                        self.offer_cell(row + i, p, joint, kill2, &sees, &mut changed);
                    }
                }
            }
        }
    }

    #[inline]
    fn offer_cell(
        &mut self,
        cell: usize,
        p: DVec3,
        joint: u32,
        kill2: f64,
        sees: &impl Fn(DVec3) -> bool,
        changed: &mut impl FnMut(Change),
    ) {
        let mut a = self.start[cell] as usize;
        let mut end = a + self.left[cell] as usize;
        let mut worst = 0.0_f64;
        while a < end {
            let (dx, dy, dz) = (self.x[a] - p.x, self.y[a] - p.y, self.z[a] - p.z);
            let d2 = dx * dx + dy * dy + dz * dz;
            if d2 < self.best2[a] {
                let place = DVec3::new(self.x[a], self.y[a], self.z[a]);
                if sees(place) {
                    let killed = d2 <= kill2;
                    changed(Change { from: self.owner[a], place, id: self.id[a], killed });
                    if killed {
                        end -= 1;
                        self.remove(cell, a);
                        continue;
                    }
                    self.best2[a] = d2;
                    self.owner[a] = joint;
                }
            }
            worst = worst.max(self.best2[a]);
            a += 1;
        }
        self.reach2[cell] = worst;
    }

    /// Takes the point of slot `a` out of its cell; the cell's last one takes its slot.
    fn remove(&mut self, cell: usize, a: usize) {
        let last = (self.start[cell] + self.left[cell]) as usize - 1;
        self.slot[self.id[a] as usize] = GONE;
        if a != last {
            self.x[a] = self.x[last];
            self.y[a] = self.y[last];
            self.z[a] = self.z[last];
            self.best2[a] = self.best2[last];
            self.owner[a] = self.owner[last];
            self.id[a] = self.id[last];
            self.slot[self.id[a] as usize] = index(a);
        }
        self.left[cell] -= 1;
        self.alive -= 1;
    }

    /// Gives up the point with input index `id`; its joint if it had one, and its place.
    pub(crate) fn give_up(&mut self, id: u32) -> Option<(u32, DVec3)> {
        let a = self.slot[id as usize];
        if a == GONE {
            return None;
        }
        let a = a as usize;
        let place = DVec3::new(self.x[a], self.y[a], self.z[a]);
        let owner = self.owner[a];
        self.remove(self.cell_index(place), a);
        Some((owner, place))
    }

    /// Narrows the search to what the worst-served point still needs. Call now and then.
    pub(crate) fn narrow(&mut self) {
        self.far = self.reach2.iter().copied().fold(0.0, f64::max).sqrt();
    }

    /// Every point left: input index, place, owner, squared distance to it.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (u32, DVec3, u32, f64)> + '_ {
        (0..self.left.len()).flat_map(move |c| {
            let start = self.start[c] as usize;
            (start..start + self.left[c] as usize).map(|a| {
                (self.id[a], DVec3::new(self.x[a], self.y[a], self.z[a]), self.owner[a], self.best2[a])
            })
        })
    }

    /// Squared distance of point `id` to its joint; `None` if it is gone.
    pub(crate) fn distance2(&self, id: u32) -> Option<f64> {
        let a = self.slot[id as usize];
        (a != GONE).then(|| self.best2[a as usize])
    }

    /// Distance from a coordinate to a cell's range; the outermost cells reach to infinity.
    #[inline]
    fn gap(&self, p: f64, axis: usize, i: usize) -> f64 {
        let low = self.lo[axis] + i as f64 * self.cell;
        let below = if i == 0 { 0.0 } else { low - p };
        let above = if i + 1 == self.dims[axis] { 0.0 } else { p - (low + self.cell) };
        below.max(above).max(0.0)
    }

    fn coordinates(&self, p: DVec3) -> [usize; 3] {
        let q = (p - self.lo) / self.cell;
        [0, 1, 2].map(|i| clamp_to(q[i], self.dims[i]))
    }

    fn cell_index(&self, p: DVec3) -> usize {
        let [i, j, k] = self.coordinates(p);
        (k * self.dims[1] + j) * self.dims[0] + i
    }
}

#[expect(clippy::cast_possible_truncation, reason = "more than 2^32 attractors do not fit in memory")]
const fn index(i: usize) -> u32 {
    i as u32
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to 0..n")]
fn clamp_to(x: f64, n: usize) -> usize {
    if x > 0.0 { (x as usize).min(n - 1) } else { 0 }
}

/// Lower corner, cell size and numbers of cells. Laid over the bulk of the points: a far outlier falls into an
/// outermost cell and must not make all cells large.
fn layout(points: &[DVec3], good: &[u32], perception_m: f64) -> (DVec3, f64, [usize; 3]) {
    if good.is_empty() {
        return (DVec3::ZERO, perception_m, [1; 3]);
    }
    let (mut lo, mut hi) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for &i in good {
        lo = lo.min(points[i as usize]);
        hi = hi.max(points[i as usize]);
    }
    // A thousand points tell where the bulk is.
    let every = good.len() / 1000 + 1;
    for axis in 0..3 {
        let mut sample: Vec<f64> = good.iter().step_by(every).map(|&i| points[i as usize][axis]).collect();
        sample.sort_unstable_by(f64::total_cmp);
        let (a, b) = (sample[sample.len() / 50], sample[sample.len() - 1 - sample.len() / 50]);
        let margin = 0.5 * (b - a) + perception_m;
        lo[axis] = lo[axis].max(a - margin);
        hi[axis] = hi[axis].min(b + margin);
    }
    let size = (hi - lo).max(DVec3::splat(1e-9));
    let per_cell = size.x * size.y * size.z * PER_CELL / good.len() as f64;
    // An eighth: below that a new joint visits more cells than points.
    let mut cell = base::ops::cbrt(per_cell).clamp(perception_m / 8.0, perception_m);
    let most = 2.0 * good.len() as f64 + 64.0;
    let counts = |cell: f64| size.to_array().map(|s| (s / cell).floor() + 1.0);
    while counts(cell).iter().product::<f64>() > most {
        cell *= 1.25;
    }
    (lo, cell, counts(cell).map(|c| clamp_to(c, usize::MAX)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::{Draw, Seed};

    #[test]
    fn owners_are_the_nearest_joints_by_brute_force() {
        let mut s = Seed::new(11).stream(Draw::Test);
        let mut points: Vec<DVec3> =
            (0..600).map(|_| DVec3::new(s.normal(), s.normal(), s.normal())).collect();
        points.extend([DVec3::splat(500.0), DVec3::NAN, points[0], points[0]]);
        let finite: Vec<bool> = points.iter().map(|p| p.is_finite()).collect();
        let joints: Vec<DVec3> = (0..150).map(|_| DVec3::new(s.normal(), s.normal(), s.normal())).collect();
        for (perception, kill) in [(0.4, 0.05), (3.0, 0.2), (2000.0, 0.1)] {
            let mut field = Field::new(&points, &finite, perception);
            let mut killed = vec![false; points.len()];
            for (j, &p) in joints.iter().enumerate() {
                field.offer(
                    p,
                    index(j),
                    kill * kill,
                    |_| true,
                    |c| {
                        if c.killed {
                            killed[c.id as usize] = true;
                        }
                    },
                );
                if j % 10 == 0 {
                    field.narrow();
                }
            }
            let mut got = vec![NOBODY; points.len()];
            field.iter().for_each(|(id, _, owner, _)| got[id as usize] = owner);
            for (i, &q) in points.iter().enumerate().filter(|(_, q)| q.is_finite()) {
                let near = joints.iter().enumerate().map(|(j, p)| (p.distance_squared(q), j));
                let (d2, j) = near.min_by(|a, b| a.0.total_cmp(&b.0)).expect("joints");
                assert_eq!(killed[i], d2 <= kill * kill, "point {i}");
                if !killed[i] {
                    let want = if d2 < perception * perception { index(j) } else { NOBODY };
                    assert_eq!(got[i], want, "point {i}, perception {perception}");
                }
            }
            assert_eq!(field.alive(), points.len() - 1 - killed.iter().filter(|&&k| k).count());
        }
    }

    #[test]
    fn a_far_outlier_does_not_coarsen_the_grid() {
        let mut s = Seed::new(1).stream(Draw::Test);
        let mut points: Vec<DVec3> =
            (0..5000).map(|_| DVec3::new(s.uniform(), s.uniform(), s.uniform())).collect();
        points.push(DVec3::splat(1e5));
        let field = Field::new(&points, &vec![true; points.len()], 0.5);
        assert!(field.cell < 0.3, "{}", field.cell);
        assert!(field.left.iter().all(|&n| n < 60));
    }

    #[test]
    fn given_up_points_are_gone() {
        let mut field = Field::new(&[DVec3::ZERO, DVec3::X], &[true; 2], 2.0);
        field.offer(DVec3::Y, 7, 0.01, |_| true, |_| ());
        assert_eq!(field.distance2(1), Some(2.0));
        assert_eq!(field.give_up(1), Some((7, DVec3::X)));
        assert_eq!((field.give_up(1), field.distance2(1), field.alive()), (None, None, 1));
    }
}
