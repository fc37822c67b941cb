//! Attraction points in a uniform grid, each with its nearest joint.
//!
//! Flat arrays sorted by cell. Every cell stores the largest distance of its points from their joints, so a new joint
//! visits only cells in which it can be nearer to some point: that, not the perception radius, determines the cost.
//! Cells and points are filtered in f32, eight at a time and with a margin for its errors; the rest is tested in f64.
//! So the precision of the filter never affects a result.

use glam::{DVec3, DVec4, Vec4};

use crate::sieve::{BLOCK, Cells, EMPTY, LANES, Near, Probe, SIDE, Sieve, near_groups, near_in};

/// No joint.
pub(crate) const NOBODY: u32 = u32::MAX;
/// No slot: the point is removed.
const GONE: u32 = u32::MAX;
/// Marks a point whose owner did not change in this round.
const STILL: u32 = u32::MAX - 1;
/// Target of points per cell: fewer cost more cells to visit, more cost more points to test.
const PER_CELL: f64 = 6.0;

/// Effect of a round of offers on one point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Change {
    /// The previous joint; [`NOBODY`] if none.
    pub(crate) from: u32,
    /// The new joint.
    pub(crate) to: u32,
    /// Position of the point.
    pub(crate) place: DVec3,
    /// The square of its distance to the new joint.
    pub(crate) d2: f64,
    /// Its index in the input.
    pub(crate) id: u32,
    /// Unit vector from the previous joint; zero if none.
    pub(crate) pull: DVec3,
    /// Whether it was near enough to be consumed, and is removed.
    pub(crate) killed: bool,
}

/// One point; in one struct, because all of it is read together.
#[derive(Clone, Copy, Debug)]
struct Spot {
    place: DVec3,
    /// Squared distance to the nearest joint so far; the squared perception radius if there is none.
    best2: f64,
    /// Unit vector to it from its joint when the last round was settled.
    pull: DVec3,
    owner: u32,
    /// The owner before this round, or [`STILL`].
    before: u32,
    id: u32,
}

#[derive(Clone, Debug)]
pub(crate) struct Field {
    /// By slot. A cell's slots begin at a multiple of [`LANES`].
    spots: Vec<Spot>,
    /// The same points, `LANES` slots each.
    sieve: Vec<Sieve>,
    /// Slot of each point by input index, or [`GONE`].
    slot: Vec<u32>,
    /// Slots of the points that changed owners in this round (`moves` of them; capacity for all and one more), and
    /// input indices of those to be removed.
    moved: Vec<u32>,
    moves: usize,
    dead: Vec<u32>,
    /// Workspaces of an offer: as many as cells and groups, and one more.
    near_cells: Vec<u32>,
    near_groups: Vec<Near>,
    /// First slot of each cell and number of its remaining points. The 64 cells of a block are adjacent.
    start: Vec<u32>,
    left: Vec<u32>,
    /// Upper bound of `best2` in each cell, by block; 0 if it is empty.
    reach2: Vec<[f32; BLOCK]>,
    /// The same for each block.
    block_reach2: Vec<f32>,
    /// Lower and upper ends of the cells of each block, by axis; the outermost extend to infinity.
    edges: [Vec<[Vec4; 2]>; 3],
    /// Squared gaps between a joint and the cells, by axis: a workspace.
    gaps: [Vec<Vec4>; 3],
    /// Largest coordinate in the sieve and of the cells.
    span: f64,
    far: f64,
    lo: DVec3,
    cell: f64,
    /// Numbers of blocks.
    blocks: [usize; 3],
    alive: usize,
}

impl Field {
    /// Sorts usable points into cells; the others count as removed from the start. `usable` has one entry for each
    /// point; `perception_m` is above 0.
    pub(crate) fn new(points: &[DVec3], usable: &[bool], perception_m: f64) -> Self {
        let good: Vec<u32> = (0..index(points.len())).filter(|&i| usable[i as usize]).collect();
        let (lo, cell, blocks) = layout(points, &good, perception_m);
        let count = blocks[0] * blocks[1] * blocks[2];
        let cells = count * BLOCK;
        let n = good.len();
        let mut field = Self {
            spots: Vec::new(),
            sieve: Vec::new(),
            slot: vec![GONE; points.len()],
            moved: vec![0; n + 1],
            moves: 0,
            dead: Vec::new(),
            near_cells: vec![0; cells + 1],
            near_groups: Vec::new(),
            start: vec![0; cells + 1],
            left: vec![0; cells],
            reach2: vec![[0.0; BLOCK]; count],
            block_reach2: vec![0.0; count],
            edges: blocks.map(|n| edges(cell, n)),
            gaps: blocks.map(|n| vec![Vec4::ZERO; n]),
            span: blocks.iter().map(|n| (n * SIDE) as f64 * cell).fold(0.0, f64::max),
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
        let far2 = above(perception_m * perception_m);
        for c in 0..cells {
            let room = field.left[c].next_multiple_of(index(LANES));
            field.start[c + 1] = field.start[c] + room;
            if field.left[c] > 0 {
                field.reach2[c / BLOCK][c % BLOCK] = far2;
                field.block_reach2[c / BLOCK] = far2;
            }
        }
        let slots = field.start[cells] as usize;
        let best2 = perception_m * perception_m;
        let none = Spot { place: DVec3::ZERO, best2, pull: DVec3::ZERO, owner: NOBODY, before: STILL, id: 0 };
        field.spots = vec![none; slots];
        field.sieve = vec![EMPTY; slots / LANES];
        field.near_groups = vec![Near::default(); slots / LANES + 1];
        let mut next = field.start.clone();
        for (&i, &c) in good.iter().zip(&of) {
            let s = next[c as usize] as usize;
            next[c as usize] += 1;
            let place = points[i as usize];
            field.spots[s] = Spot { place, id: i, ..none };
            field.span = field.span.max((place - lo).abs().max_element());
            field.sift(s);
            field.slot[i as usize] = index(s);
        }
        field
    }

    /// Copies a slot into the sieve.
    fn sift(&mut self, slot: usize) {
        let spot = &self.spots[slot];
        let (at, k) = ((spot.place - self.lo).as_vec3(), slot % LANES);
        let lane = &mut self.sieve[slot / LANES];
        (lane.x[k], lane.y[k], lane.z[k]) = (at.x, at.y, at.z);
        lane.best2[k] = above(spot.best2);
    }

    /// Returns the number of points not yet consumed or given up.
    pub(crate) const fn alive(&self) -> usize {
        self.alive
    }

    /// Lets every point that is nearer to the new joint at `p` than to its own choose it, if `sees` holds.
    ///
    /// One level after another, each in a loop of its own that always stores and keeps the relevant entries: which
    /// points change owners is random, so branches on it would be mispredicted.
    #[inline]
    pub(crate) fn offer(&mut self, p: DVec3, joint: u32, sees: impl Fn(DVec3) -> bool) {
        let new = self.newcomer(p);
        let cells = self.near_cells(&new);
        if cells == 0 {
            return;
        }
        let cells = Cells {
            near: &self.near_cells[..cells],
            start: &self.start,
            left: &self.left,
            sieve: &self.sieve,
        };
        let groups = near_groups(cells, &new.probe, &mut self.near_groups);
        for n in 0..groups {
            let Near { group, mut lanes, .. } = self.near_groups[n];
            let sieve = &mut self.sieve[group as usize];
            while lanes != 0 {
                let k = lanes.trailing_zeros() as usize % LANES;
                lanes &= lanes - 1;
                let slot = group as usize * LANES + k;
                let spot = &mut self.spots[slot];
                let d2 = spot.place.distance_squared(p);
                if d2 < spot.best2 && sees(spot.place) {
                    self.moved[self.moves] = index(slot);
                    self.moves += usize::from(spot.before == STILL);
                    spot.before = if spot.before == STILL { spot.owner } else { spot.before };
                    spot.owner = joint;
                    spot.best2 = d2;
                    sieve.best2[k] = above(d2);
                }
            }
        }
        self.lower(groups);
    }

    /// Finds the cells in which the joint can be nearer to some point, in their order; returns their number.
    #[inline]
    fn near_cells(&mut self, new: &Newcomer) -> usize {
        let (from, to) = (self.block_of(new.p - self.far), self.block_of(new.p + self.far));
        for axis in 0..3 {
            let blocks = from[axis]..=to[axis];
            let edges = &self.edges[axis][blocks.clone()];
            for (gap, [low, high]) in self.gaps[axis][blocks].iter_mut().zip(edges) {
                *gap = new.gap(axis, *low, *high);
            }
        }
        let mut count = 0;
        for k in from[2]..=to[2] {
            let gz = self.gaps[2][k];
            let near_z = gz.min_element();
            for j in from[1]..=to[1] {
                let gy = self.gaps[1][j];
                let near_yz = near_z + gy.min_element();
                let row = (k * self.blocks[1] + j) * self.blocks[0];
                for i in from[0]..=to[0] {
                    let gx = self.gaps[0][i];
                    let block = row + i;
                    if self.block_reach2[block] > near_yz + gx.min_element() {
                        let mut near = near_in(&self.reach2[block], &[gx, gy, gz].map(|g| g.to_array()));
                        while near != 0 {
                            self.near_cells[count] = index(block * BLOCK) + near.trailing_zeros();
                            near &= near - 1;
                            count += 1;
                        }
                    }
                }
            }
        }
        count
    }

    /// Lowers the bounds of the cells and blocks of these groups.
    #[inline]
    fn lower(&mut self, groups: usize) {
        let mut last = NOBODY;
        for n in 0..groups {
            let Near { cell, .. } = self.near_groups[n];
            if cell == last {
                continue;
            }
            last = cell;
            let cell = cell as usize;
            let from = self.start[cell] as usize / LANES;
            let to = from + (self.left[cell] as usize).div_ceil(LANES);
            let worst = self.sieve[from..to].iter().flat_map(|s| rows(&s.best2)).fold(Vec4::ZERO, Vec4::max);
            self.reach2[cell / BLOCK][cell % BLOCK] = worst.max_element();
        }
        let mut last = usize::MAX;
        for n in 0..groups {
            let block = self.near_groups[n].cell as usize / BLOCK;
            if block != last {
                last = block;
                let most = rows(&self.reach2[block]).fold(Vec4::ZERO, Vec4::max);
                self.block_reach2[block] = most.max_element();
            }
        }
    }

    fn newcomer(&self, p: DVec3) -> Newcomer {
        let at = p - self.lo;
        // Coordinates in f32 are off by 2^-24 of their size, their difference by as much again: e on each axis. For a
        // point at d that makes at most 2 sqrt(3) d e + 3 e^2.
        let e = (self.span + at.abs().max_element()) / 8_388_608.0;
        let slack = above(4.0 * self.far * e + 4.0 * e * e);
        // The ends of cells are products, with slightly larger errors.
        let blur = Vec4::splat(above(4.0 * e));
        Newcomer { p, probe: Probe { at: at.as_vec3().to_array(), slack }, blur }
    }

    /// Ends a round of offers: reports every point that changed owners, and removes those within the kill distance.
    /// `changed` returns the unit vector from the new joint to the point.
    pub(crate) fn settle(&mut self, kill2: f64, mut changed: impl FnMut(Change) -> DVec3) {
        let moves = core::mem::take(&mut self.moves);
        for &slot in &self.moved[..moves] {
            let spot = &mut self.spots[slot as usize];
            let Spot { place, best2: d2, before: from, owner: to, id, pull } = *spot;
            let killed = d2 <= kill2;
            spot.before = STILL;
            if killed {
                self.dead.push(id);
            }
            spot.pull = changed(Change { from, to, place, d2, id, pull, killed });
        }
        // Only now: removing one moves another to its slot.
        let mut dead = core::mem::take(&mut self.dead);
        for &id in &dead {
            self.remove(self.slot[id as usize] as usize);
        }
        dead.clear();
        self.dead = dead;
    }

    /// Removes the point of slot `a` from its cell; the cell's last one takes its slot.
    fn remove(&mut self, a: usize) {
        debug_assert!(self.moves == 0, "slots are fixed during a round");
        let cell = self.cell_index(self.spots[a].place);
        let last = (self.start[cell] + self.left[cell]) as usize - 1;
        self.slot[self.spots[a].id as usize] = GONE;
        if a != last {
            self.spots[a] = self.spots[last];
            self.sift(a);
            self.slot[self.spots[a].id as usize] = index(a);
        }
        self.sieve[last / LANES].best2[last % LANES] = f32::NEG_INFINITY;
        self.left[cell] -= 1;
        self.alive -= 1;
        if self.left[cell] == 0 {
            self.reach2[cell / BLOCK][cell % BLOCK] = 0.0;
        }
    }

    /// Gives up the point with input index `id`; returns its joint, [`NOBODY`] if it had none, and the unit vector from
    /// there.
    pub(crate) fn give_up(&mut self, id: u32) -> Option<(u32, DVec3)> {
        let a = self.slot[id as usize];
        if a == GONE {
            return None;
        }
        let Spot { owner, pull, .. } = self.spots[a as usize];
        self.remove(a as usize);
        Some((owner, pull))
    }

    /// Narrows the search to the largest distance that is still needed. Call occasionally.
    pub(crate) fn narrow(&mut self) {
        self.far = f64::from(self.block_reach2.iter().copied().fold(0.0, f32::max)).sqrt();
    }

    /// Iterates over the remaining points: input index, position, owner, squared distance to it.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (u32, DVec3, u32, f64)> + '_ {
        (0..self.left.len()).flat_map(move |c| {
            let start = self.start[c] as usize;
            (start..start + self.left[c] as usize)
                .map(|a| &self.spots[a])
                .map(|s| (s.id, s.place, s.owner, s.best2))
        })
    }

    /// Returns the squared distance of point `id` to its joint; `None` if it is removed.
    pub(crate) fn distance2(&self, id: u32) -> Option<f64> {
        let a = self.slot[id as usize];
        (a != GONE).then(|| self.spots[a as usize].best2)
    }

    fn cell_of(&self, p: DVec3) -> [usize; 3] {
        let (q, [x, y, z]) = ((p - self.lo) / self.cell, self.blocks);
        [clamp_to(q.x, x * SIDE), clamp_to(q.y, y * SIDE), clamp_to(q.z, z * SIDE)]
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

/// A new joint.
struct Newcomer {
    p: DVec3,
    probe: Probe,
    /// Bound of the error of a distance from the end of a cell.
    blur: Vec4,
}

impl Newcomer {
    /// Returns lower bounds of the squared distances along an axis to cells between `low` and `high`.
    #[inline]
    fn gap(&self, axis: usize, low: Vec4, high: Vec4) -> Vec4 {
        let at = Vec4::splat(self.probe.at[axis]);
        let gap = ((low - at).max(at - high) - self.blur).max(Vec4::ZERO);
        // The factor covers the rounding of the square: a millionth less.
        gap * gap * Vec4::splat(0.999_999)
    }
}

/// Iterates over the rows of a block.
#[inline]
fn rows(block: &[f32]) -> impl Iterator<Item = Vec4> + '_ {
    block.as_chunks::<SIDE>().0.iter().map(|row| Vec4::from_array(*row))
}

/// Returns the lower and upper ends of `blocks` blocks of cells from 0 on.
fn edges(cell: f64, blocks: usize) -> Vec<[Vec4; 2]> {
    let last = blocks * SIDE;
    let at = |i: usize| DVec4::splat(cell) * (DVec4::new(0.0, 1.0, 2.0, 3.0) + i as f64);
    let mut edges: Vec<[Vec4; 2]> =
        (0..last).step_by(SIDE).map(|i| [at(i).as_vec4(), at(i + 1).as_vec4()]).collect();
    if let [first, ..] = edges.as_mut_slice() {
        first[0].x = f32::NEG_INFINITY;
    }
    if let [.., last] = edges.as_mut_slice() {
        last[1].w = f32::INFINITY;
    }
    edges
}

/// Rounds `x`, which is 0 or more, up: a millionth covers the rounding of f32, in sums of three, too.
#[expect(clippy::cast_possible_truncation, reason = "rounded up after")]
#[inline]
fn above(x: f64) -> f32 {
    if x > 0.0 { (x as f32) * 1.000_001 + f32::MIN_POSITIVE } else { 0.0 }
}

#[expect(clippy::cast_possible_truncation, reason = "more than 2^32 attractors do not fit in memory")]
const fn index(i: usize) -> u32 {
    i as u32
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to 0..n")]
fn clamp_to(x: f64, n: usize) -> usize {
    if x > 0.0 { (x as usize).min(n - 1) } else { 0 }
}

/// Returns lower corner, cell size and numbers of blocks. Laid over the bulk of the points: a far outlier falls into an
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
    // A thousand points show where the bulk is.
    let every = good.len() / 1000 + 1;
    for axis in 0..3 {
        let mut sample: Vec<f64> = good.iter().step_by(every).map(|&i| points[i as usize][axis]).collect();
        base::sort_numbers(&mut sample);
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
                        DVec3::ZERO
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
        field.settle(0.01, |c| {
            assert_eq!((c.from, c.to, c.killed, c.pull), (NOBODY, 7, false, DVec3::ZERO));
            DVec3::NEG_Y
        });
        assert_eq!(field.distance2(1), Some(2.0));
        assert_eq!(field.give_up(1), Some((7, DVec3::NEG_Y)));
        assert_eq!((field.give_up(1), field.distance2(1), field.alive()), (None, None, 1));
    }
}
