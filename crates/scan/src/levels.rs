//! Level sets of the paths from the foot -> the skeleton: a tree of rings (a Reeb graph; Xu, Gossett and Chen 2007).

use base::{CancelToken, Cancelled};
use glam::DVec3;

use crate::ways::{CUBES_AT_ONCE, NONE, Ways};

/// One connected piece of a level set.
#[derive(Clone, Debug)]
pub(crate) struct Ring {
    /// Its cubes.
    pub(crate) cubes: Vec<u32>,
    /// Mean position; later the centre of its circle.
    pub(crate) middle: DVec3,
    /// The ring below; [`NONE`] for the foot.
    pub(crate) below: u32,
    /// Root mean square distance of its cubes from their mean.
    pub(crate) spread: f64,
    /// Length of all wood above it, including its own part.
    pub(crate) load: f64,
    /// Longest path above it.
    pub(crate) reach: f64,
    /// Whether it is not pruned.
    pub(crate) alive: bool,
}

/// All rings; a ring comes after the one below it.
#[derive(Clone, Debug)]
pub(crate) struct Rings {
    pub(crate) rings: Vec<Ring>,
    pub(crate) band: f64,
}

impl Rings {
    /// Cuts the cubes of one plant into bands of path length.
    pub(crate) fn new(
        ways: &Ways,
        band: f64,
        mine: impl Fn(usize) -> bool,
        cancel: &CancelToken,
    ) -> Result<Self, Cancelled> {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "ways are finite and short"
        )]
        let band_of = |c: usize| (ways.way[c] / band) as u32;
        #[expect(clippy::cast_possible_truncation, reason = "cubes are u32")]
        let mut order: Vec<(u32, u32)> =
            (0..ways.len()).filter(|&c| mine(c)).map(|c| (band_of(c), c as u32)).collect();
        order.sort_unstable();
        let mut ring_of = vec![NONE; ways.len()];
        let mut rings: Vec<Ring> = vec![];
        let mut stack = vec![];
        for (done, &(level, first)) in order.iter().enumerate() {
            if done.is_multiple_of(CUBES_AT_ONCE) {
                cancel.check()?;
            }
            if ring_of[first as usize] != NONE {
                continue;
            }
            #[expect(clippy::cast_possible_truncation, reason = "fewer rings than cubes")]
            let mark = rings.len() as u32;
            let mut cubes = vec![];
            stack.push(first);
            ring_of[first as usize] = mark;
            while let Some(c) = stack.pop() {
                cubes.push(c);
                ways.voxels.near(c as usize, 2, |k| {
                    if ring_of[k] == NONE && mine(k) && band_of(k) == level {
                        ring_of[k] = mark;
                        #[expect(clippy::cast_possible_truncation, reason = "cubes are u32")]
                        stack.push(k as u32);
                    }
                });
            }
            let lowest = cubes
                .iter()
                .copied()
                .min_by(|&a, &b| ways.way[a as usize].total_cmp(&ways.way[b as usize]).then(a.cmp(&b)));
            let mut from = lowest.map_or(NONE, |c| ways.parent[c as usize]);
            while from != NONE && ring_of[from as usize] == mark {
                from = ways.parent[from as usize];
            }
            let below = if from == NONE { NONE } else { ring_of[from as usize] };
            let middle = cubes.iter().map(|&c| ways.means[c as usize]).sum::<DVec3>() / cubes.len() as f64;
            let square: f64 = cubes.iter().map(|&c| ways.means[c as usize].distance_squared(middle)).sum();
            let spread = (square / cubes.len() as f64).sqrt();
            cubes.sort_unstable();
            let below = if below < mark { below } else { NONE };
            rings.push(Ring { cubes, middle, below, spread, load: 0.0, reach: 0.0, alive: true });
        }
        let mut all = Self { rings, band };
        all.weigh();
        Ok(all)
    }

    /// Computes loads and reaches again, after pruning.
    pub(crate) fn weigh(&mut self) {
        for r in &mut self.rings {
            (r.load, r.reach) = (self.band, self.band);
        }
        for k in (1..self.rings.len()).rev() {
            let (load, reach, below) = (self.rings[k].load, self.rings[k].reach, self.rings[k].below);
            if below == NONE || !self.rings[k].alive {
                continue;
            }
            let gap = self.rings[k].middle.distance(self.rings[below as usize].middle);
            let step = gap.min(4.0 * self.band).max(self.band) - self.band;
            let under = &mut self.rings[below as usize];
            under.load += load + step;
            under.reach = under.reach.max(reach + self.band);
        }
    }

    /// Returns the rings above each ring that are alive.
    pub(crate) fn above(&self) -> Vec<Vec<u32>> {
        let mut above = vec![vec![]; self.rings.len()];
        for (k, r) in (0_u32..).zip(&self.rings) {
            if r.alive && r.below != NONE && self.rings[r.below as usize].alive {
                above[r.below as usize].push(k);
            }
        }
        above
    }

    /// Prunes spurs: side branches that reach no farther than the bearing wood is thick, or than `least` bands. They
    /// are bumps of bark, and rings that fell into pieces.
    pub(crate) fn prune(&mut self, least: f64) {
        // Several rounds: after a spur is pruned, the rest may be a spur itself.
        for _ in 0..3 {
            let above = self.above();
            let mut dead = vec![false; self.rings.len()];
            for (k, heads) in above.iter().enumerate() {
                let Some(main) = self.main_of(heads) else { continue };
                let thick = self.rings[k].spread;
                for &h in heads.iter().filter(|&&h| h != main) {
                    let r = &self.rings[h as usize];
                    dead[h as usize] = r.reach < (least * self.band).max(1.2 * thick + self.band);
                }
            }
            let mut count = 0;
            for (k, d) in dead.into_iter().enumerate() {
                let below = self.rings[k].below;
                let gone = below != NONE && !self.rings[below as usize].alive;
                if self.rings[k].alive && (d || gone) {
                    self.rings[k].alive = false;
                    count += 1;
                }
            }
            self.weigh();
            if count == 0 {
                break;
            }
        }
    }

    /// Returns the ring that continues the axis among the rings above one: that with the most wood.
    pub(crate) fn main_of(&self, heads: &[u32]) -> Option<u32> {
        heads.iter().copied().max_by(|&a, &b| {
            self.rings[a as usize].load.total_cmp(&self.rings[b as usize].load).then(b.cmp(&a))
        })
    }

    /// Returns the axes: runs of rings from a fork to a tip, each with the ring that bears it; bearers first.
    pub(crate) fn axes(&self) -> Vec<(u32, Vec<u32>)> {
        let above = self.above();
        let mut out: Vec<(u32, Vec<u32>)> = vec![];
        let mut work: std::collections::VecDeque<(u32, u32)> = std::collections::VecDeque::new();
        // A short piece next to the stem is grass or a root.
        let high = self.rings.iter().filter(|r| r.below == NONE).map(|r| r.reach).fold(0.0, f64::max);
        let feet = (0_u32..).zip(&self.rings);
        let feet = feet.filter(|(_, r)| r.below == NONE && r.alive && r.reach >= 0.25 * high);
        work.extend(feet.map(|(k, _)| (NONE, k)));
        while let Some((bearer, first)) = work.pop_front() {
            let mut run = vec![first];
            let mut at = first;
            while let Some(main) = self.main_of(&above[at as usize]) {
                work.extend(above[at as usize].iter().filter(|&&h| h != main).map(|&h| (at, h)));
                run.push(main);
                at = main;
            }
            out.push((bearer, run));
        }
        out
    }
}
