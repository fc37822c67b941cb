//! Markers: drawn once for the cone of any bud, turned for each, and counted in the cells of a grid.
//!
//! `cone -> pool of markers -> (turned) -> cells -> how many of others are where one's own are`

use base::ops::{self, PI, TAU};
use base::{Draw, Seed};
use glam::DVec3;

use super::GuidedSpec;
use super::room::{Guide, Room};

/// Markers of the pool, at least: each bud takes some that follow one another, from a place of its own.
const POOL: usize = 4096;
/// The cell of a marker that found no room.
const NOWHERE: u64 = u64::MAX;

/// A marker in the frame of a bud: its heading, side and across.
#[derive(Clone, Copy, Debug)]
struct Sample {
    way: DVec3,
    distance: f64,
    weight: f64,
}

/// The cone of perception, the same for all buds but for where it stands.
#[derive(Clone, Debug)]
pub(super) struct Cone {
    pool: Vec<Sample>,
    /// Of one bud.
    markers: usize,
    far: f64,
    /// Side of a cell.
    cell: f64,
    /// A marker's share of the cone's volume, in cells.
    share: f64,
}

/// Where a cone stands.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stand {
    pub(super) at: DVec3,
    pub(super) heading: DVec3,
    pub(super) side: DVec3,
    pub(super) key: Seed,
}

/// A grid around all cones of a round.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    from: DVec3,
    per_m: f64,
    cells: [u64; 3],
}

/// The markers of some buds.
#[derive(Clone, Debug, Default)]
pub(super) struct Batch {
    /// For each bud: its first sample, side and across.
    turned: Vec<(usize, DVec3, DVec3)>,
    /// The cells of the markers, bud by bud.
    cells: Vec<u64>,
    /// What strokes add to each marker; none without strokes.
    guides: Vec<Guide>,
}

/// What a bud's markers sum up to.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sums {
    /// Own markers.
    pub(super) own: usize,
    /// Of their weights.
    pub(super) whole: f64,
    /// Of the ways to them and along their strokes, each times its weight.
    pub(super) pull: DVec3,
    /// Of the ways to the markers of other buds, each times its weight.
    pub(super) push: DVec3,
    /// Markers of older buds.
    pub(super) older: f64,
}

/// Markers in a cell.
#[derive(Clone, Copy, Debug, Default)]
struct Held {
    count: f64,
    weight: f64,
}

impl Cone {
    pub(super) fn new(spec: &GuidedSpec, seed: Seed) -> Self {
        let (near, far) = (spec.near * spec.internode_m, spec.far * spec.internode_m);
        let (mean, sigma) = (0.5 * (near + far), 0.25 * (far - near).max(1e-12));
        let half = spec.half_angle_deg * (PI / 180.0);
        let (near3, far3, cos_half) = (near * near * near, far * far * far, ops::cos(half));
        let markers = spec.markers as usize;
        let mut stream = seed.stream(Draw::Attractors);
        let sample = |_| {
            let c = stream.range(cos_half, 1.0);
            let (s, around) = ((1.0 - c * c).max(0.0).sqrt(), ops::sin_cos(TAU * stream.uniform()));
            let distance = ops::cbrt(ops::lerp(near3, far3, stream.uniform()));
            let x = (distance - mean) / sigma;
            Sample {
                way: DVec3::new(c, s * around.1, s * around.0),
                distance,
                weight: ops::exp(-0.5 * x * x),
            }
        };
        let pool = (0..POOL.max(markers)).map(sample).collect();
        // As large as a marker's share, so that a marker meets in its cell those that are in its way. But a cone must
        // be two cells wide and deep, or cells would reach out of it.
        let volume = TAU / 3.0 * (1.0 - cos_half) * (far3 - near3) / f64::from(spec.markers);
        let wide = far * if half < 0.5 * PI { ops::sin(half) } else { 1.0 };
        let cell = ops::cbrt(volume).min(0.5 * wide).min(0.5 * (far - near));
        Self { pool, markers, far, cell, share: volume / (cell * cell * cell) }
    }

    /// A grid that holds the cones of buds at these places.
    pub(super) fn grid(&self, places: impl Iterator<Item = DVec3>) -> Grid {
        let none = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let (lo, hi) = places.fold(none, |(lo, hi), p| (lo.min(p), hi.max(p)));
        let (from, per_m) = (lo - self.far - self.cell, 1.0 / self.cell);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
        let cells = ((hi + self.far - from) * per_m).to_array().map(|n| n as u64 + 2);
        Grid { from, per_m, cells }
    }

    /// The markers of buds, but for those that find no room.
    pub(super) fn markers(&self, stands: impl Iterator<Item = Stand>, grid: &Grid, room: &Room) -> Batch {
        let (mut batch, mut near) = (Batch::default(), Vec::new());
        for stand in stands {
            let mut stream = stand.key.stream(Draw::Attractors);
            let first = stream.below(self.pool.len());
            let (sin, cos) = ops::sin_cos(TAU * stream.uniform());
            let across = stand.heading.cross(stand.side);
            let (side, across) = (stand.side * cos + across * sin, across * cos - stand.side * sin);
            batch.turned.push((first, side, across));
            batch.cells.extend(self.samples(first).map(|s| {
                let way = stand.heading * s.way.x + side * s.way.y + across * s.way.z;
                let p = stand.at + way * s.distance;
                let guide = room.at(p, &mut near);
                if room.is_guided() {
                    batch.guides.push(guide.unwrap_or(Guide { weight: 0.0, along: DVec3::ZERO }));
                }
                if guide.is_some() { grid.cell(p) } else { NOWHERE }
            }));
        }
        batch
    }

    /// The samples of a bud.
    fn samples(&self, first: usize) -> impl Iterator<Item = &Sample> {
        let (start, end) = self.pool.split_at(first);
        end.iter().chain(start).take(self.markers)
    }

    /// What the markers of each bud sum up to, beside those of all others. The earlier a bud, the older.
    ///
    /// Markers of others in a bud's cone are found by its own: these are spread evenly over its room, so that the sum
    /// over them of what their cells hold estimates that over the cone. Cost: linear in markers.
    pub(super) fn sums(&self, grid: &Grid, batches: &mut [Batch], headings: &[DVec3]) -> Vec<Sums> {
        let mut sums = vec![Sums::default(); headings.len()];
        let mut held = vec![Held::default(); grid.number(batches)];
        let turned = |batch: &Batch, k: usize| batch.turned[k];
        let mut bud = 0;
        for batch in &*batches {
            for k in 0..batch.turned.len() {
                let (own, older) = (self.own(batch, k), self.meet(batch, k, &mut held));
                sums[bud] = Sums { older: older.1, push: older.0, ..own };
                bud += 1;
            }
        }
        held.fill(Held::default());
        for batch in batches.iter().rev() {
            for k in (0..batch.turned.len()).rev() {
                bud -= 1;
                let (sum, (_, side, across)) = (&mut sums[bud], turned(batch, k));
                let push = sum.push + self.meet(batch, k, &mut held).0;
                let world = |v: DVec3| headings[bud] * v.x + side * v.y + across * v.z;
                sum.push = world(push) * self.share;
                sum.older *= self.share;
                sum.pull = world(sum.pull);
                for (g, _) in self.guides(batch, k) {
                    sum.pull += g.along * g.weight;
                }
            }
        }
        sums
    }

    fn guides<'a>(&self, batch: &'a Batch, k: usize) -> impl Iterator<Item = (&'a Guide, u64)> {
        let of = k * self.markers..(k + 1) * self.markers;
        let guides = batch.guides.get(of.clone()).unwrap_or_default();
        guides.iter().zip(batch.cells[of].iter().copied()).filter(|(_, c)| *c != NOWHERE)
    }

    /// A bud's markers that have room: way in its frame, weight, cell.
    fn placed<'a>(&'a self, batch: &'a Batch, k: usize) -> impl Iterator<Item = (DVec3, f64, usize)> + 'a {
        let of = k * self.markers..(k + 1) * self.markers;
        let guides = batch.guides.get(of.clone());
        let cells = self.samples(batch.turned[k].0).zip(&batch.cells[of]).enumerate();
        cells.filter(|(_, (_, c))| **c != NOWHERE).map(move |(i, (s, c))| {
            #[expect(clippy::cast_possible_truncation, reason = "a place of a vector")]
            let cell = *c as usize;
            (s.way, guides.map_or(s.weight, |g| g[i].weight), cell)
        })
    }

    fn own(&self, batch: &Batch, k: usize) -> Sums {
        self.placed(batch, k).fold(Sums::default(), |sum, (way, weight, _)| Sums {
            own: sum.own + 1,
            whole: sum.whole + weight,
            pull: sum.pull + way * weight,
            ..sum
        })
    }

    /// What a bud's markers meet in their cells: weighted ways, in its frame, and how many; then they are held, too.
    fn meet(&self, batch: &Batch, k: usize, held: &mut [Held]) -> (DVec3, f64) {
        let met = self.placed(batch, k).fold((DVec3::ZERO, 0.0), |(push, met), (way, _, cell)| {
            (push + way * held[cell].weight, met + held[cell].count)
        });
        for (_, weight, cell) in self.placed(batch, k) {
            held[cell].count += 1.0;
            held[cell].weight += weight;
        }
        met
    }
}

impl Grid {
    fn cell(&self, p: DVec3) -> u64 {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
        let [x, y, z] = ((p - self.from) * self.per_m).to_array().map(|n| n as u64);
        let [nx, ny, _] = self.cells;
        x.wrapping_add(nx.wrapping_mul(y.wrapping_add(ny.wrapping_mul(z)))) & (NOWHERE >> 1)
    }

    /// Numbers the cells of markers from 0 where most of the grid is empty; how many cells there are then.
    fn number(&self, batches: &mut [Batch]) -> usize {
        let markers: usize = batches.iter().map(|b| b.cells.len()).sum();
        let all = self.cells.iter().try_fold(1_u64, |n, &side| n.checked_mul(side));
        if let Some(all) = all.and_then(|n| usize::try_from(n).ok()).filter(|&n| n <= 8 * markers + 65_536) {
            return all;
        }
        let mut met: Vec<u64> =
            batches.iter().flat_map(|b| &b.cells).copied().filter(|c| *c != NOWHERE).collect();
        met.sort_unstable();
        met.dedup();
        for cell in batches.iter_mut().flat_map(|b| &mut b.cells).filter(|c| **c != NOWHERE) {
            *cell = met.partition_point(|m| m < cell) as u64;
        }
        met.len()
    }
}
