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
/// The cell of a marker that found no room, and its row among the cells that are met.
const NOWHERE: u64 = u64::MAX;
const NO_ROW: u32 = u32::MAX;
/// 2^52: numbers from here to its double are whole.
const WHOLE: f64 = 4_503_599_627_370_496.0;
/// A tile of the grid is 4 cells long, wide and high: so many bits number those in it.
const TILE: u32 = 6;

/// Markers in the frame of a bud: its heading, side and across. What is asked for at different times lies apart.
#[derive(Clone, Debug, Default)]
struct Pool {
    way: Vec<DVec3>,
    /// As far along its way as each is.
    place: Vec<DVec3>,
    weight: Vec<f64>,
}

/// The cone of perception, the same for all buds but for where it stands.
#[derive(Clone, Debug)]
pub(super) struct Cone {
    pool: Pool,
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
    tiles: [u64; 3],
}

/// The markers of some buds.
#[derive(Clone, Debug, Default)]
pub(super) struct Batch {
    /// For each bud: its first sample, side and across.
    turned: Vec<(usize, DVec3, DVec3)>,
    /// The cells of the markers, bud by bud, and their rows among those that are met.
    cells: Vec<u64>,
    rows: Vec<u32>,
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

/// Memory of one round, taken again by the next: a fresh one would cost as much as what is written to it.
#[derive(Clone, Debug, Default)]
pub(super) struct Scratch {
    tiles: Tiles,
    held: Vec<Held>,
    younger: Vec<f64>,
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
            let way = DVec3::new(c, s * around.1, s * around.0);
            (way, way * distance, ops::exp(-0.5 * x * x))
        };
        let samples: Vec<_> = (0..POOL.max(markers)).map(sample).collect();
        let mut pool = Pool::default();
        // Its first ones once more at its end: those of a bud follow one another.
        for &(way, place, weight) in samples.iter().chain(&samples[..markers]) {
            pool.way.push(way);
            pool.place.push(place);
            pool.weight.push(weight);
        }
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
        let tiles = ((hi + self.far - from) * per_m).to_array().map(|n| (n as u64 >> 2) + 2);
        Grid { from, per_m, tiles }
    }

    /// The markers of buds, but for those that find no room.
    pub(super) fn markers(&self, stands: impl Iterator<Item = Stand>, grid: &Grid, room: &Room) -> Batch {
        let (mut batch, mut near) = (Batch::default(), Vec::new());
        for stand in stands {
            let mut stream = stand.key.stream(Draw::Attractors);
            let first = stream.below(self.pool.way.len() - self.markers);
            let (sin, cos) = ops::sin_cos(TAU * stream.uniform());
            let across = stand.heading.cross(stand.side);
            let (side, across) = (stand.side * cos + across * sin, across * cos - stand.side * sin);
            batch.turned.push((first, side, across));
            let places = self.pool.place[first..first + self.markers].iter();
            if room.is_open(stand.at, self.far) {
                let of = grid.turned(stand.at, [stand.heading, side, across]);
                batch.cells.extend(places.map(|&at| of.cell(at)));
                continue;
            }
            let placed = |at: &DVec3| stand.at + stand.heading * at.x + side * at.y + across * at.z;
            if room.is_plain() {
                let cell = |p| if room.surrounds(p) { grid.cell(p) } else { NOWHERE };
                batch.cells.extend(places.map(|at| cell(placed(at))));
                continue;
            }
            batch.cells.extend(places.map(|at| {
                let p = placed(at);
                let guide = room.at(p, &mut near);
                if room.is_guided() {
                    batch.guides.push(guide.unwrap_or(Guide { weight: 0.0, along: DVec3::ZERO }));
                }
                if guide.is_some() { grid.cell(p) } else { NOWHERE }
            }));
        }
        batch
    }

    /// What the markers of each bud sum up to, beside those of all others. The earlier a bud, the older.
    ///
    /// Markers of others in a bud's cone are found by its own: these are spread evenly over its room, so that the sum
    /// over them of what their cells hold estimates that over the cone. Cost: linear in markers.
    pub(super) fn sums(
        &self,
        grid: &Grid,
        batches: &mut [Batch],
        headings: &[DVec3],
        scratch: &mut Scratch,
    ) -> Vec<Sums> {
        let mut sums = Vec::with_capacity(headings.len());
        let Scratch { tiles, held, younger } = scratch;
        tiles.begin(grid, batches);
        held.clear();
        for batch in &mut *batches {
            batch.rows.clear();
            batch.rows.reserve(batch.cells.len());
            for k in 0..batch.turned.len() {
                let Batch { cells, rows, .. } = &mut *batch;
                rows.extend(cells[k * self.markers..(k + 1) * self.markers].iter().map(|&c| tiles.row(c)));
                held.resize(tiles.cells(), Held::default());
                sums.push(self.meet(batch, k, held));
            }
        }
        younger.clear();
        younger.resize(tiles.cells(), 0.0);
        let mut row = headings.len();
        for batch in batches.iter().rev() {
            for k in (0..batch.turned.len()).rev() {
                row -= 1;
                let (sum, heading) = (&mut sums[row], headings[row]);
                let (_, side, across) = batch.turned[k];
                let world = |v: DVec3| heading * v.x + side * v.y + across * v.z;
                sum.push = world(sum.push + self.meet_younger(batch, k, younger)) * self.share;
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
    #[inline]
    fn placed(&self, batch: &Batch, k: usize, mut f: impl FnMut(DVec3, f64, usize)) {
        let (of, first) = (k * self.markers..(k + 1) * self.markers, batch.turned[k].0);
        let own = first..first + self.markers;
        let weights = match batch.guides.get(of.clone()) {
            Some(guides) => Weights::Guided(guides),
            None => Weights::Own(&self.pool.weight[own.clone()]),
        };
        let rows = &batch.rows[of];
        let ways = &self.pool.way[own];
        match weights {
            Weights::Guided(guides) => {
                for ((way, &row), g) in ways.iter().zip(rows).zip(guides).filter(|((_, r), _)| **r != NO_ROW)
                {
                    f(*way, g.weight, row as usize);
                }
            }
            Weights::Own(weights) => {
                for ((way, &row), w) in ways.iter().zip(rows).zip(weights).filter(|((_, r), _)| **r != NO_ROW)
                {
                    f(*way, *w, row as usize);
                }
            }
        }
    }

    /// What a bud's own markers are, and what they meet in their cells, in its frame; then they are held, too.
    fn meet(&self, batch: &Batch, k: usize, held: &mut [Held]) -> Sums {
        let mut sums = Sums::default();
        self.placed(batch, k, |way, weight, cell| {
            let there = held[cell];
            sums.own += 1;
            sums.whole += weight;
            sums.pull += way * weight;
            sums.push += way * there.weight;
            sums.older += there.count;
        });
        self.placed(batch, k, |_, weight, cell| {
            let there = &mut held[cell];
            there.count += 1.0;
            there.weight += weight;
        });
        sums
    }

    /// How what its markers meet pushes a bud, in its frame; then they are held, too.
    fn meet_younger(&self, batch: &Batch, k: usize, held: &mut [f64]) -> DVec3 {
        let mut push = DVec3::ZERO;
        self.placed(batch, k, |way, _, cell| push += way * held[cell]);
        self.placed(batch, k, |_, weight, cell| held[cell] += weight);
        push
    }
}

/// Of a bud's markers.
enum Weights<'a> {
    Own(&'a [f64]),
    Guided(&'a [Guide]),
}

/// A bud's frame in a grid, in cells.
struct Turned<'a> {
    grid: &'a Grid,
    at: DVec3,
    frame: [DVec3; 3],
}

impl Turned<'_> {
    fn cell(&self, p: DVec3) -> u64 {
        let [heading, side, across] = self.frame;
        self.grid.at(self.at + heading * p.x + side * p.y + across * p.z)
    }
}

impl Grid {
    /// The tile of a place, and the cell in it.
    fn cell(&self, p: DVec3) -> u64 {
        self.at((p - self.from) * self.per_m - 0.5)
    }

    /// The same for many places about a bud, given in its frame.
    fn turned(&self, at: DVec3, frame: [DVec3; 3]) -> Turned<'_> {
        Turned { grid: self, at: (at - self.from) * self.per_m - 0.5, frame: frame.map(|v| v * self.per_m) }
    }

    /// Of half a cell before a place, in cells.
    fn at(&self, place: DVec3) -> u64 {
        // The nearest whole numbers, as the last bits of a number that has no room for others: far faster than a cast.
        let [x, y, z] = (place + WHOLE).to_array().map(|n| n.to_bits() & (NOWHERE >> 12));
        let [nx, ny, _] = self.tiles;
        let inner = (x & 3) | (y & 3) << 2 | (z & 3) << 4;
        let [x, y, z] = [x >> 2, y >> 2, z >> 2];
        let tile = x.wrapping_add(nx.wrapping_mul(y.wrapping_add(ny.wrapping_mul(z))));
        (tile << TILE | inner) & (NOWHERE >> 1)
    }
}

/// Numbers the tiles in which markers lie from 0, in the order in which buds come to them: most of the grid is empty, and
/// what buds beside one another look at lies together.
#[derive(Clone, Debug, Default)]
struct Tiles {
    /// Of each tile of the grid, or of each that is met, its number.
    numbers: Vec<u32>,
    /// Of a grid that is nearly empty, as of trees far apart: only its tiles that are met, in order.
    met: Option<Vec<u64>>,
    next: u32,
}

impl Tiles {
    fn begin(&mut self, grid: &Grid, batches: &[Batch]) {
        let markers: usize = batches.iter().map(|b| b.cells.len()).sum();
        let all = grid.tiles.iter().try_fold(1_u64, |n, &side| n.checked_mul(side));
        let all = all.and_then(|n| usize::try_from(n).ok()).filter(|&n| n <= markers + 65_536);
        self.met = all.is_none().then(|| {
            let cells = batches.iter().flat_map(|b| &b.cells).filter(|c| **c != NOWHERE);
            let mut met: Vec<u64> = cells.map(|c| c >> TILE).collect();
            base::sort_by_key(&mut met, |&tile| tile);
            met.dedup();
            met
        });
        self.next = 0;
        self.numbers.clear();
        self.numbers.resize(all.unwrap_or_else(|| self.met.as_ref().map_or(0, Vec::len)), NO_ROW);
    }

    /// The row of a cell.
    #[inline]
    fn row(&mut self, cell: u64) -> u32 {
        let tile = cell >> TILE;
        let at = match &self.met {
            None => tile as usize,
            Some(met) => met.partition_point(|m| *m < tile),
        };
        // None of a marker that found no room: its tile is beyond all others.
        let Some(number) = self.numbers.get_mut(at) else { return NO_ROW };
        if *number == NO_ROW {
            *number = self.next;
            self.next += 1;
        }
        let inner = (cell & ((1 << TILE) - 1)) as u32;
        *number << TILE | inner
    }

    /// So many cells lie in tiles that were met.
    const fn cells(&self) -> usize {
        (self.next as usize) << TILE
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
            let first = batch.turned[k].0;
            (first..first + cone.markers).map(move |s| {
                let place = cone.pool.place[s];
                let turned = stands[k].heading * place.x + side * place.y + across * place.z;
                (stands[k].at + turned, cone.pool.weight[s])
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
            let sums = cone.sums(&grid, &mut batches, &headings, &mut Scratch::default());
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
