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
        // Its first ones once more at its end: those of a bud follow one another.
        let mut pool: Vec<Sample> = (0..POOL.max(markers)).map(sample).collect();
        pool.extend_from_within(..markers);
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
            let first = stream.below(self.pool.len() - self.markers);
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
    fn samples(&self, first: usize) -> core::slice::Iter<'_, Sample> {
        self.pool[first..first + self.markers].iter()
    }

    /// What the markers of each bud sum up to, beside those of all others. The earlier a bud, the older.
    ///
    /// Markers of others in a bud's cone are found by its own: these are spread evenly over its room, so that the sum
    /// over them of what their cells hold estimates that over the cone. Cost: linear in markers.
    pub(super) fn sums(&self, grid: &Grid, batches: &mut [Batch], headings: &[DVec3]) -> Vec<Sums> {
        let mut sums = Vec::with_capacity(headings.len());
        let mut held = vec![Held::default(); grid.number(batches)];
        for batch in &*batches {
            sums.extend((0..batch.turned.len()).map(|k| self.meet(batch, k, &mut held)));
        }
        held.fill(Held::default());
        let all = batches.iter().flat_map(|batch| (0..batch.turned.len()).map(move |k| (batch, k)));
        let all: Vec<_> = all.zip(headings).collect();
        for (sum, ((batch, k), heading)) in sums.iter_mut().zip(all).rev() {
            let (_, side, across) = batch.turned[k];
            let world = |v: DVec3| heading * v.x + side * v.y + across * v.z;
            sum.push = world(sum.push + self.meet(batch, k, &mut held).push) * self.share;
            sum.older *= self.share;
            sum.pull = world(sum.pull);
            for (g, _) in self.guides(batch, k) {
                sum.pull += g.along * g.weight;
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
    #[inline]
    fn placed(&self, batch: &Batch, k: usize, mut f: impl FnMut(DVec3, f64, usize)) {
        let of = k * self.markers..(k + 1) * self.markers;
        let places = self.samples(batch.turned[k].0).zip(&batch.cells[of.clone()]);
        #[expect(clippy::cast_possible_truncation, reason = "a place of a vector")]
        match batch.guides.get(of) {
            Some(guides) => {
                for ((s, &c), g) in places.zip(guides).filter(|((_, c), _)| **c != NOWHERE) {
                    f(s.way, g.weight, c as usize);
                }
            }
            None => {
                for (s, &c) in places.filter(|(_, c)| **c != NOWHERE) {
                    f(s.way, s.weight, c as usize);
                }
            }
        }
    }

    /// What a bud's own markers are, and what they meet in their cells, in its frame; then they are held, too.
    fn meet(&self, batch: &Batch, k: usize, held: &mut [Held]) -> Sums {
        let mut sums = Sums::default();
        self.placed(batch, k, |way, weight, cell| {
            sums.own += 1;
            sums.whole += weight;
            sums.pull += way * weight;
            sums.push += way * held[cell].weight;
            sums.older += held[cell].count;
        });
        self.placed(batch, k, |_, weight, cell| {
            held[cell].count += 1.0;
            held[cell].weight += weight;
        });
        sums
    }
}

impl Grid {
    fn cell(&self, p: DVec3) -> u64 {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
        let [x, y, z] = ((p - self.from) * self.per_m).to_array().map(|n| n as i64 as u64);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Obstacles;
    use base::{Budget, Stream};

    /// What the markers of each bud sum up to, by looking at all of all others.
    fn brute(cone: &Cone, spec: &GuidedSpec, stands: &[Stand], batch: &Batch) -> Vec<(DVec3, f64)> {
        let cos_half = ops::cos(spec.half_angle_deg * (PI / 180.0));
        let near = spec.near * spec.internode_m;
        let placed = |k: usize| {
            let (_, side, across) = batch.turned[k];
            cone.samples(batch.turned[k].0).map(move |s| {
                let way = stands[k].heading * s.way.x + side * s.way.y + across * s.way.z;
                (stands[k].at + way * s.distance, s.weight)
            })
        };
        let of = |a: usize| {
            let (mut push, mut older) = (DVec3::ZERO, 0.0);
            for b in (0..stands.len()).filter(|b| *b != a) {
                for (p, weight) in placed(b) {
                    let d = p - stands[a].at;
                    let far = d.length();
                    if far >= near && far <= cone.far && d.dot(stands[a].heading) >= cos_half * far {
                        push += d / far * weight;
                        older += if b < a { 1.0 } else { 0.0 };
                    }
                }
            }
            (push, older)
        };
        (0..stands.len()).map(of).collect()
    }

    fn ball(stream: &mut Stream, radius: f64) -> DVec3 {
        let way = DVec3::new(stream.normal(), stream.normal(), stream.normal()).normalize_or(DVec3::Y);
        way * radius * ops::cbrt(stream.uniform())
    }

    #[test]
    fn cells_estimate_what_is_in_the_cone() {
        for (markers, half_angle_deg) in
            [(12, 45.0), (30, 45.0), (60, 45.0), (60, 20.0), (60, 120.0), (1300, 45.0)]
        {
            let spec = GuidedSpec { markers, half_angle_deg, ..GuidedSpec::default() };
            let room =
                Room::new(&spec, vec![DVec3::ZERO], &Obstacles::none(), &Budget::default()).expect("room");
            let cone = Cone::new(&spec, Seed::new(1));
            let mut stream = Seed::new(2).stream(Draw::Test);
            let n = 150;
            let stands: Vec<Stand> = (0..n)
                .map(|k| {
                    let heading = ball(&mut stream, 1.0).normalize_or(DVec3::Y);
                    let side = heading.any_orthonormal_vector();
                    Stand { at: ball(&mut stream, 2.0), heading, side, key: Seed::new(3).child(k) }
                })
                .collect();
            let grid = cone.grid(stands.iter().map(|s| s.at));
            let mut batches = [cone.markers(stands.iter().copied(), &grid, &room)];
            let headings: Vec<DVec3> = stands.iter().map(|s| s.heading).collect();
            let sums = cone.sums(&grid, &mut batches, &headings);
            let truth = brute(&cone, &spec, &stands, &batches[0]);
            // The sum of differences by the sum of what is there; by chance, as many as there are markers decide.
            let share = |differ: f64, there: f64| differ / there;
            let there = truth.iter().map(|t| t.1).sum::<f64>();
            let bias = share(sums.iter().map(|s| s.older).sum::<f64>() - there, there);
            let off = share(sums.iter().zip(&truth).map(|(s, t)| (s.older - t.1).abs()).sum(), there);
            let pushed = truth.iter().map(|t| t.0.length()).sum();
            let away = share(sums.iter().zip(&truth).map(|(s, t)| s.push.distance(t.0)).sum(), pushed);
            let chance = 1.0 / f64::from(markers).sqrt();
            assert!(bias.abs() < 0.05, "{markers} in {half_angle_deg}: {bias}");
            assert!(off < 0.02 + 1.5 * chance, "{markers} in {half_angle_deg}: {off}");
            // All around a bud, others push from all sides, and little is left.
            let most = if half_angle_deg > 90.0 { 4.0 } else { 2.0 };
            assert!(away < 0.02 + most * chance, "{markers} in {half_angle_deg}: {away}");
        }
    }
}
