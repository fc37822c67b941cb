//! Attraction points in a uniform grid, each with the joint that is nearest to it.
//!
//! Flat arrays sorted by cell. Every cell knows how far the nearest joint of its worst-served point is, so a new
//! joint visits only cells in which it can be nearer to something: that, not the perception radius, sets the cost.

use glam::DVec3;

/// No joint.
pub(crate) const NOBODY: u32 = u32::MAX;
/// No place: the point is gone.
const GONE: u32 = u32::MAX;
/// Not moved in this round.
const STILL: u32 = u32::MAX - 1;
/// Points per cell aimed at: fewer cost more cells to visit, more cost more points to test.
const PER_CELL: f64 = 6.0;
/// Cells along a side of a block, and in a block.
const SIDE: usize = 4;
const BLOCK: usize = SIDE * SIDE * SIDE;

/// What a round of offers did to one point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Change {
    /// The joint that had it before; [`NOBODY`] if none.
    pub(crate) from: u32,
    /// The joint that has it now.
    pub(crate) to: u32,
    /// The point.
    pub(crate) place: DVec3,
    /// Its index in the input.
    pub(crate) id: u32,
    /// It was near enough to be consumed, and is gone.
    pub(crate) killed: bool,
}

#[derive(Clone, Debug)]
pub(crate) struct Field {
    /// x, y, z, and the squared distance to the nearest joint so far; the squared perception radius while there is
    /// none. Side by side, because they are always read together.
    points: Vec<[f64; 4]>,
    owner: Vec<u32>,
    /// The owner before this round, or [`STILL`].
    before: Vec<u32>,
    id: Vec<u32>,
    /// Slot of each point by input index, or [`GONE`].
    slot: Vec<u32>,
    /// Points that changed hands in this round, by input index.
    moved: Vec<u32>,
    /// First slot of each cell and number of points left in it. The 64 cells of a block lie side by side.
    start: Vec<u32>,
    left: Vec<u32>,
    /// Upper bound of `best2` in each cell; 0 where it is empty.
    reach2: Vec<f64>,
    /// The same for each block.
    block_reach2: Vec<f64>,
    far: f64,
    lo: DVec3,
    cell: f64,
    /// Numbers of blocks.
    blocks: [usize; 3],
    alive: usize,
}

impl Field {
    /// Puts usable points into cells; the others are gone from the start. `usable` has one entry for each point;
    /// `perception_m` is above 0.
    pub(crate) fn new(points: &[DVec3], usable: &[bool], perception_m: f64) -> Self {
        let good: Vec<u32> = (0..index(points.len())).filter(|&i| usable[i as usize]).collect();
        let (lo, cell, blocks) = layout(points, &good, perception_m);
        let count = blocks[0] * blocks[1] * blocks[2];
        let cells = count * BLOCK;
        let n = good.len();
        let mut field = Self {
            points: vec![[0.0; 4]; n],
            owner: vec![NOBODY; n],
            before: vec![STILL; n],
            id: vec![0; n],
            slot: vec![GONE; points.len()],
            moved: Vec::with_capacity(n),
            start: vec![0; cells + 1],
            left: vec![0; cells],
            reach2: vec![0.0; cells],
            block_reach2: vec![0.0; count],
            far: perception_m,
            lo,
            cell,
            blocks,
            alive: n,
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
                field.block_reach2[c / BLOCK] = perception_m * perception_m;
            }
        }
        let mut next = field.start.clone();
        for (&i, &c) in good.iter().zip(&of) {
            let s = next[c as usize] as usize;
            next[c as usize] += 1;
            let p = points[i as usize];
            field.points[s] = [p.x, p.y, p.z, perception_m * perception_m];
            field.id[s] = i;
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
    pub(crate) fn offer(&mut self, p: DVec3, joint: u32, sees: impl Fn(DVec3) -> bool) {
        let (from, to) = (self.block_of(p - self.far), self.block_of(p + self.far));
        for k in from[2]..=to[2] {
            let gz = self.gaps(p.z, 2, k);
            for j in from[1]..=to[1] {
                let gy = self.gaps(p.y, 1, j);
                let near_yz = least(&gy) + least(&gz);
                let row = (k * self.blocks[1] + j) * self.blocks[0];
                for i in from[0]..=to[0] {
                    let reach2 = self.block_reach2[row + i];
                    if reach2 <= near_yz {
                        continue;
                    }
                    let gx = self.gaps(p.x, 0, i);
                    if reach2 > near_yz + least(&gx) {
                        self.offer_block(row + i, [&gx, &gy, &gz], p, joint, &sees);
                    }
                }
            }
        }
    }

    #[inline]
    fn offer_block(
        &mut self,
        block: usize,
        gaps: [&[f64; SIDE]; 3],
        p: DVec3,
        joint: u32,
        sees: &impl Fn(DVec3) -> bool,
    ) {
        let first = block * BLOCK;
        let reach2 = self.block_reach2[block];
        let mut visited = false;
        for (z, gz) in gaps[2].iter().enumerate() {
            for (y, gy) in gaps[1].iter().enumerate() {
                let yz = gy + gz;
                if reach2 <= yz {
                    continue;
                }
                let row = first + (z * SIDE + y) * SIDE;
                // Read at once: the four are one line of memory.
                let Some(&reach) = self.reach2[row..].first_chunk::<SIDE>() else { continue };
                for (x, gx) in gaps[0].iter().enumerate() {
                    if reach[x] > yz + gx {
                        self.offer_cell(row + x, p, joint, sees);
                        visited = true;
                    }
                }
            }
        }
        if visited {
            let cells = &self.reach2[first..first + BLOCK];
            self.block_reach2[block] = cells.iter().copied().fold(0.0, |a, b| if b > a { b } else { a });
        }
    }

    #[inline]
    fn offer_cell(&mut self, cell: usize, p: DVec3, joint: u32, sees: &impl Fn(DVec3) -> bool) {
        let from = self.start[cell] as usize;
        let Self { points, owner, before, id, moved, .. } = self;
        let mut worst = 0.0_f64;
        for (q, a) in points[from..from + self.left[cell] as usize].iter_mut().zip(from..) {
            let (dx, dy, dz) = (q[0] - p.x, q[1] - p.y, q[2] - p.z);
            let d2 = dx * dx + dy * dy + dz * dz;
            if d2 < q[3] && sees(DVec3::new(q[0], q[1], q[2])) {
                if before[a] == STILL {
                    before[a] = owner[a];
                    moved.push(id[a]);
                }
                owner[a] = joint;
                q[3] = d2;
            }
            worst = if q[3] > worst { q[3] } else { worst };
        }
        self.reach2[cell] = worst;
    }

    /// Ends a round of offers: tells of every point that changed hands, and removes those within the kill distance.
    pub(crate) fn settle(&mut self, kill2: f64, mut changed: impl FnMut(Change)) {
        let mut moved = core::mem::take(&mut self.moved);
        for &id in &moved {
            let a = self.slot[id as usize] as usize;
            let place = self.place(a);
            let killed = self.points[a][3] <= kill2;
            changed(Change { from: self.before[a], to: self.owner[a], place, id, killed });
            self.before[a] = STILL;
            if killed {
                self.remove(self.cell_index(place), a);
            }
        }
        moved.clear();
        self.moved = moved;
    }

    /// Takes the point of slot `a` out of its cell; the cell's last one takes its slot.
    fn remove(&mut self, cell: usize, a: usize) {
        let last = (self.start[cell] + self.left[cell]) as usize - 1;
        self.slot[self.id[a] as usize] = GONE;
        if a != last {
            self.points[a] = self.points[last];
            self.owner[a] = self.owner[last];
            self.before[a] = self.before[last];
            self.id[a] = self.id[last];
            self.slot[self.id[a] as usize] = index(a);
        }
        self.left[cell] -= 1;
        self.alive -= 1;
        if self.left[cell] == 0 {
            self.reach2[cell] = 0.0;
        }
    }

    fn place(&self, a: usize) -> DVec3 {
        let [x, y, z, _] = self.points[a];
        DVec3::new(x, y, z)
    }

    /// Gives up the point with input index `id`; its joint if it had one, and its place.
    pub(crate) fn give_up(&mut self, id: u32) -> Option<(u32, DVec3)> {
        let a = self.slot[id as usize];
        if a == GONE {
            return None;
        }
        let a = a as usize;
        let place = self.place(a);
        let owner = self.owner[a];
        self.remove(self.cell_index(place), a);
        Some((owner, place))
    }

    /// Narrows the search to what the worst-served point still needs. Call now and then.
    pub(crate) fn narrow(&mut self) {
        self.far = self.block_reach2.iter().copied().fold(0.0, f64::max).sqrt();
    }

    /// Every point left: input index, place, owner, squared distance to it.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (u32, DVec3, u32, f64)> + '_ {
        (0..self.left.len()).flat_map(move |c| {
            let start = self.start[c] as usize;
            (start..start + self.left[c] as usize)
                .map(|a| (self.id[a], self.place(a), self.owner[a], self.points[a][3]))
        })
    }

    /// Squared distance of point `id` to its joint; `None` if it is gone.
    pub(crate) fn distance2(&self, id: u32) -> Option<f64> {
        let a = self.slot[id as usize];
        (a != GONE).then(|| self.points[a as usize][3])
    }

    /// Squared distances from a coordinate to the ranges of a block's cells; the outermost cells of the grid reach
    /// to infinity.
    #[inline]
    fn gaps(&self, p: f64, axis: usize, block: usize) -> [f64; SIDE] {
        let last = self.blocks[axis] * SIDE - 1;
        let mut gaps = [0.0; SIDE];
        for (k, gap) in gaps.iter_mut().enumerate() {
            let i = block * SIDE + k;
            let low = self.lo[axis] + i as f64 * self.cell;
            let below = if i == 0 { 0.0 } else { low - p };
            let above = if i == last { 0.0 } else { p - (low + self.cell) };
            let d = if below > above { below } else { above };
            let d = if d > 0.0 { d } else { 0.0 };
            *gap = d * d;
        }
        gaps
    }

    fn cell_of(&self, p: DVec3) -> [usize; 3] {
        let q = (p - self.lo) / self.cell;
        [0, 1, 2].map(|i| clamp_to(q[i], self.blocks[i] * SIDE))
    }

    fn block_of(&self, p: DVec3) -> [usize; 3] {
        self.cell_of(p).map(|c| c / SIDE)
    }

    fn cell_index(&self, p: DVec3) -> usize {
        let [i, j, k] = self.cell_of(p);
        let block = (k / SIDE * self.blocks[1] + j / SIDE) * self.blocks[0] + i / SIDE;
        block * BLOCK + (k % SIDE * SIDE + j % SIDE) * SIDE + i % SIDE
    }
}

/// The least of a block's squared gaps.
#[inline]
fn least(gaps: &[f64; SIDE]) -> f64 {
    gaps.iter().copied().fold(f64::INFINITY, |a, b| if b < a { b } else { a })
}

#[expect(clippy::cast_possible_truncation, reason = "more than 2^32 attractors do not fit in memory")]
const fn index(i: usize) -> u32 {
    i as u32
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to 0..n")]
fn clamp_to(x: f64, n: usize) -> usize {
    if x > 0.0 { (x as usize).min(n - 1) } else { 0 }
}

/// Lower corner, cell size and numbers of blocks. Laid over the bulk of the points: a far outlier falls into an
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
        let margin = 0.2 * (b - a);
        lo[axis] = lo[axis].max(a - margin);
        hi[axis] = hi[axis].min(b + margin);
    }
    let size = (hi - lo).max(DVec3::splat(1e-9));
    let per_cell = size.x * size.y * size.z * PER_CELL / good.len() as f64;
    // A sixteenth: below that a new joint visits more cells than points.
    let mut cell = base::ops::cbrt(per_cell).clamp(perception_m / 16.0, perception_m);
    let most = 2.0 * good.len() as f64 + 64.0;
    let counts = |cell: f64| size.to_array().map(|s| (s / (cell * SIDE as f64)).floor() + 1.0);
    while counts(cell).iter().product::<f64>() * BLOCK as f64 > most && counts(cell) != [1.0; 3] {
        cell *= 1.1;
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
                field.offer(p, index(j), |_| true);
                if j % 3 == 0 || j + 1 == joints.len() {
                    field.settle(kill * kill, |c| {
                        killed[c.id as usize] |= c.killed;
                        assert_ne!(c.from, c.to);
                    });
                }
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
        assert!(field.left.iter().all(|&n| n < 80));
    }

    #[test]
    fn given_up_points_are_gone() {
        let mut field = Field::new(&[DVec3::ZERO, DVec3::X], &[true; 2], 2.0);
        field.offer(DVec3::Y, 7, |_| true);
        field.settle(0.01, |c| assert_eq!((c.from, c.to, c.killed), (NOBODY, 7, false)));
        assert_eq!(field.distance2(1), Some(2.0));
        assert_eq!(field.give_up(1), Some((7, DVec3::X)));
        assert_eq!((field.give_up(1), field.distance2(1), field.alive()), (None, None, 1));
    }
}
