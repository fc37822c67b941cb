//! Markers: drawn once for the cone of any bud, turned for each, and counted in the cells of a grid.
//!
//! `cone -> pool of markers -> (turned) -> cells -> number of others' markers in the same cells`
//!
//! A bud's own markers are random, as in the VR paper, and are summed in advance. Others' markers are sampled by far
//! fewer evenly spread ones.
//!
//! The work for each marker runs over columns of 32-bit numbers, which compilers process four at a time. Sums always
//! use four lanes: the same bits everywhere.

use base::ops::{self, PI, TAU};
use base::{Draw, Seed};
use glam::{DVec3, Vec3, Vec4};

use super::GuidedSpec;
use super::room::{Guide, Room};

/// Least size of the pool of markers: each bud takes consecutive ones, from a start of its own.
const POOL: usize = 4096;
/// Number of rotations about a bud's heading that its markers may have.
const TURNS: usize = 1024;
/// Marks a place that is in no tile.
const NO_TILE: u32 = u32::MAX;
/// 2^23: 32-bit numbers from here to its double are whole.
const WHOLE: f32 = 8_388_608.0;
/// Largest length of a cone, in cells.
const LONGEST: f64 = 1e6;
/// Bits that number the cells of a tile, which is 4 cells long, wide and high.
const TILE: u32 = 6;
/// Most tiles of a grid whose cells are numbered in 32 bits.
const MOST_TILES: u64 = 1 << 25;
/// Most tiles in excess of the number of markers: a grid with more is nearly empty.
const MORE_TILES: u64 = 65_536;
/// Most cells per marker of a grid whose cells serve directly as rows.
const FEW_CELLS: u64 = 1;
/// Least number of places at which a cone is probed for markers of others. They are evenly spread: 32 and 260 even ones
/// have no larger error than 60 and 650 random ones, if cells are slightly larger than the share of a place (over 150
/// buds in balls of 1, 2 and 3 m, compared with 2,000 for each).
const PROBES: usize = 32;
/// Markers per probe, if that gives more probes.
const OF_EACH: usize = 4;
/// Ratio of the volume of a cell to the share of a probe.
const LARGER: f64 = 1.15;
/// Steps whose multiples modulo 1 fill a cube evenly: powers of the root of x^4 = x + 1. Any consecutive multiples are
/// as even (Roberts 2018).
const EVENLY: [f64; 3] = [0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_2];
/// Markers that are processed together.
const TOGETHER: usize = 64;

/// Numbers in three columns.
type Columns<T> = [T; 3];

/// Markers in the frame of a bud: its heading, side and across. Columns that are used at different times are stored
/// apart.
#[derive(Clone, Debug, Default)]
struct Pool {
    way: Columns<Vec<f32>>,
    /// Position along its direction of each, in cells.
    place: Columns<Vec<f32>>,
    weight: Vec<f32>,
}

/// Running sums over all markers before each: of their weights, and of their directions times these.
#[derive(Clone, Debug, Default)]
struct Running {
    whole: Vec<f64>,
    pull: Vec<DVec3>,
}

impl Running {
    fn push(&mut self, way: DVec3, weight: f64) {
        self.whole.push(self.whole.last().copied().unwrap_or(0.0) + weight);
        self.pull.push(self.pull.last().copied().unwrap_or(DVec3::ZERO) + way * weight);
    }
}

impl Pool {
    fn push(&mut self, way: DVec3, place: DVec3, weight: f64) {
        let push = |columns: &mut Columns<Vec<f32>>, v: DVec3| {
            for (column, x) in columns.iter_mut().zip(v.as_vec3().to_array()) {
                column.push(x);
            }
        };
        push(&mut self.way, way);
        push(&mut self.place, place);
        self.weight.push(short(weight));
    }
}

/// The cone of perception, the same for all buds except for its position.
#[derive(Clone, Debug)]
pub(super) struct Cone {
    /// Random markers, whose sums determine a bud's own room.
    own: Running,
    /// Evenly spread markers, which sample the markers of others.
    pool: Pool,
    /// Sine and cosine of each rotation about a bud's heading.
    turns: Vec<[f64; 2]>,
    /// Number of markers of one bud.
    markers: usize,
    /// Number of those that sample the markers of others.
    probes: usize,
    far: f64,
    /// Side of a cell.
    cell: f64,
    /// A probe's share of the cone's volume, in cells.
    share: f64,
}

/// Position and orientation of a cone.
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
    /// Cells from the centre of a cone to its farthest reach.
    reach: u32,
    /// Tiles along x and y.
    tiles: [u64; 2],
    /// Number of all tiles, if their cells are numbered in 32 bits.
    all: Option<usize>,
    /// Whether counts are stored for all cells of the grid, and not only for those with markers.
    is_full: bool,
}

/// The markers of one bud.
#[derive(Clone, Copy, Debug)]
struct Of {
    /// The first of its markers in the pool.
    first: usize,
    side: DVec3,
    across: DVec3,
    /// End of its own markers in the batch.
    end: usize,
    /// All of them found room, and nothing guides them: none is listed individually.
    is_whole: bool,
}

/// The markers of some buds that found room.
#[derive(Clone, Debug, Default)]
pub(super) struct Batch {
    of: Vec<Of>,
    /// The cells of the markers, bud by bud, later replaced by their rows among the cells with markers.
    rows: Vec<u32>,
    /// The cells, if 32 bits do not number them.
    cells: Vec<u64>,
    /// Index in the pool of each marker, for buds whose markers are not whole; others have none.
    which: Vec<u32>,
    /// Guidance by strokes for each of these; empty without strokes.
    guides: Vec<Guide>,
}

/// Sums over a bud's markers.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sums {
    /// Number of own markers.
    pub(super) own: f64,
    /// Sum of their weights.
    pub(super) whole: f64,
    /// Sum of the directions to them and along their strokes, each times its weight.
    pub(super) pull: DVec3,
    /// Sum of the directions to the markers of other buds, each times its weight.
    pub(super) push: DVec3,
    /// Number of markers of older buds.
    pub(super) older: f64,
}

/// Markers in a cell.
#[derive(Clone, Copy, Debug, Default)]
struct Held {
    count: u32,
    weight: f32,
}

/// Memory of one round, reused by the next: allocating it anew would cost as much as filling it.
#[derive(Clone, Debug, Default)]
pub(super) struct Scratch {
    tiles: Tiles,
    held: Vec<Held>,
    own: OwnColumns,
}

/// A bud's own markers, in columns, if they are not consecutive in the pool.
#[derive(Clone, Debug, Default)]
struct OwnColumns {
    way: Columns<Vec<f32>>,
    weight: Vec<f32>,
}

/// A bud's own markers.
#[derive(Clone, Copy, Debug)]
struct Own<'a> {
    rows: &'a [u32],
    way: Columns<&'a [f32]>,
    weight: &'a [f32],
}

impl Cone {
    pub(super) fn new(spec: &GuidedSpec, seed: Seed) -> Self {
        let (near, far) = (spec.near * spec.internode_m, spec.far * spec.internode_m);
        let (mean, sigma) = (0.5 * (near + far), 0.25 * (far - near).max(1e-12));
        let half = spec.half_angle_deg * (PI / 180.0);
        let (near3, far3, cos_half) = (near * near * near, far * far * far, ops::cos(half));
        let markers = spec.markers as usize;
        // Strokes weigh each marker.
        let few = if spec.strokes.is_empty() { PROBES.max(markers.div_ceil(OF_EACH)) } else { markers };
        let probes = few.min(markers);
        // As large as a probe's share, so that the cell of a probe holds the markers in its part. But a cone must be
        // two cells wide and deep, or cells would extend out of it.
        let volume = TAU / 3.0 * (1.0 - cos_half) * (far3 - near3) / probes as f64;
        let wide = far * if half < 0.5 * PI { ops::sin(half) } else { 1.0 };
        let cell = (LARGER * ops::cbrt(volume)).min(0.5 * wide).min(0.5 * (far - near)).max(far / LONGEST);
        let marker = |[c, around, deep]: [f64; 3]| {
            let c = ops::lerp(cos_half, 1.0, c);
            let (s, around) = ((1.0 - c * c).max(0.0).sqrt(), ops::sin_cos(TAU * around));
            let distance = ops::cbrt(ops::lerp(near3, far3, deep));
            let x = (distance - mean) / sigma;
            (DVec3::new(c, s * around.1, s * around.0), distance / cell, ops::exp(-0.5 * x * x))
        };
        let mut stream = seed.stream(Draw::Attractors);
        let count = POOL.max(markers);
        let by_chance: Vec<_> = (0..count).map(|_| marker([(); 3].map(|()| stream.uniform()))).collect();
        let mut own = Running { whole: vec![0.0], pull: vec![DVec3::ZERO] };
        // The first ones are repeated at its end: those of a bud are consecutive.
        for &(way, _, weight) in by_chance.iter().chain(&by_chance[..markers]) {
            own.push(way, weight);
        }
        let mut pool = Pool::default();
        let evenly = |k: usize| EVENLY.map(|step| (k as f64 * step).fract());
        for (way, distance, weight) in (0..count + probes).map(evenly).map(marker) {
            pool.push(way, way * distance, weight);
        }
        let turns = (0..TURNS).map(|k| <[f64; 2]>::from(ops::sin_cos(TAU * k as f64 / TURNS as f64)));
        Self {
            own,
            pool,
            turns: turns.collect(),
            markers,
            probes,
            far,
            cell,
            share: volume / (cell * cell * cell),
        }
    }

    /// Makes a grid that contains the cones of buds at these positions.
    pub(super) fn grid(&self, places: impl Iterator<Item = DVec3>) -> Grid {
        let none = (0_u64, DVec3::INFINITY, DVec3::NEG_INFINITY);
        let (buds, lo, hi) = places.fold(none, |(n, lo, hi), p| (n + 1, lo.min(p), hi.max(p)));
        let most = MOST_TILES.min(buds.saturating_mul(self.probes as u64).saturating_add(MORE_TILES));
        let per_m = 1.0 / self.cell;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "at most a little over LONGEST"
        )]
        let reach = (self.far * per_m) as u32 + 2;
        let from = lo - f64::from(reach + 1) * self.cell;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
        let count = |cells: f64| ((cells as u64).saturating_add(u64::from(reach)) >> 2) + 2;
        let [x, y, z] = ((hi - from) * per_m).to_array().map(count);
        let all = x.checked_mul(y).and_then(|n| n.checked_mul(z)).filter(|n| *n <= most);
        let few = buds.saturating_mul(self.probes as u64).saturating_mul(FEW_CELLS);
        let is_full = all.is_some_and(|n| n << TILE <= few);
        Grid { from, per_m, reach, tiles: [x, y], all: all.and_then(|n| usize::try_from(n).ok()), is_full }
    }

    /// Returns the markers of buds, except those that find no room.
    pub(super) fn markers(&self, stands: impl Iterator<Item = Stand>, grid: &Grid, room: &Room) -> Batch {
        let (mut batch, mut near) = (Batch::default(), Vec::new());
        let mut kept: Columns<Vec<f32>> = Columns::default();
        let buds = stands.size_hint().0;
        batch.of.reserve(buds);
        if grid.all.is_some() {
            batch.rows.reserve(buds * self.probes);
        }
        kept.iter_mut().for_each(|column| column.reserve(self.probes));
        for stand in stands {
            let mut stream = stand.key.stream(Draw::Attractors);
            let first = stream.below(self.own.whole.len() - 1 - self.markers);
            let [sin, cos] = self.turns[stream.below(TURNS)];
            let across = stand.heading.cross(stand.side);
            let (side, across) = (stand.side * cos + across * sin, across * cos - stand.side * sin);
            let turned = grid.turned(stand.at, [stand.heading, side, across]);
            let [x, y, z] = self.pool.place.each_ref().map(|c| &c[first..first + self.probes]);
            let is_whole = room.is_open(stand.at, self.far);
            if is_whole {
                batch.add(x, y, z, &turned, grid);
            } else {
                let of_cell = [stand.heading, side, across].map(|v| v * self.cell);
                kept.iter_mut().for_each(Vec::clear);
                let first = u32::try_from(first).unwrap_or(0);
                for (((&x, &y), &z), which) in x.iter().zip(y).zip(z).zip(first..) {
                    let [h, s, a] = of_cell;
                    let p = stand.at + h * f64::from(x) + s * f64::from(y) + a * f64::from(z);
                    let guide = if room.is_plain() {
                        room.surrounds(p).then_some(None)
                    } else {
                        room.guide_at(p, &mut near).map(Some)
                    };
                    let Some(guide) = guide else { continue };
                    batch.which.push(which);
                    if room.is_guided() {
                        batch.guides.extend(guide);
                    }
                    for (column, n) in kept.iter_mut().zip([x, y, z]) {
                        column.push(n);
                    }
                }
                let [x, y, z] = &kept;
                batch.add(x, y, z, &turned, grid);
            }
            let end = batch.rows.len().max(batch.cells.len());
            batch.of.push(Of { first, side, across, end, is_whole });
        }
        batch
    }

    /// Sums the markers of each bud, with those of all others. The earlier a bud, the older.
    ///
    /// Markers of others in a bud's cone are found by its own: these are spread evenly over its room, so that the sum
    /// over them of the contents of their cells estimates that over the cone. Some represent all, for others' markers
    /// as for its own. Cost: linear in these.
    pub(super) fn sums(
        &self,
        grid: &Grid,
        batches: &mut [Batch],
        headings: &[DVec3],
        scratch: &mut Scratch,
    ) -> Vec<Sums> {
        let mut sums = Vec::with_capacity(headings.len());
        // Number of markers that a probe represents.
        let each = self.markers as f64 / self.probes as f64;
        let Scratch { tiles, held, own } = scratch;
        let cells = match grid.all.filter(|_| grid.is_full) {
            Some(all) => all << TILE,
            None => {
                tiles.begin(grid, batches);
                for batch in &mut *batches {
                    tiles.number(batch);
                }
                tiles.cells()
            }
        };
        held.clear();
        held.resize(cells, Held::default());
        for batch in &*batches {
            self.each(batch, own, |of, own, _| {
                let mut sum = if of.is_whole {
                    let (from, to) = (of.first, of.first + self.markers);
                    let Running { whole, pull } = &self.own;
                    Sums { whole: whole[to] - whole[from], pull: pull[to] - pull[from], ..Sums::default() }
                } else {
                    let (whole, pull) = (own.whole() * each, own.dot(0, own.weight, |w| w) * each);
                    Sums { whole, pull, ..Sums::default() }
                };
                sum.own = own.rows.len() as f64 * each;
                (sum.older, sum.push) = own.meet(held);
                sums.push(sum);
            });
        }
        let mut next = sums.iter_mut().zip(headings);
        for batch in &*batches {
            self.each(batch, own, |of, own, guides| {
                let Some((sum, &heading)) = next.next() else { return };
                let world = |v: DVec3| heading * v.x + of.side * v.y + of.across * v.z;
                sum.push = world(sum.push + own.see(held)) * (self.share * each);
                sum.older *= self.share * each;
                sum.pull = world(sum.pull);
                for g in guides {
                    sum.pull += g.along * (g.weight * each);
                }
            });
        }
        sums
    }

    /// Calls `f` with the markers of each bud of a batch, and their guidance by strokes.
    fn each(&self, batch: &Batch, columns: &mut OwnColumns, mut f: impl FnMut(&Of, Own<'_>, &[Guide])) {
        let (mut from, mut part) = (0, 0);
        for of in &batch.of {
            let rows = &batch.rows[from..of.end];
            from = of.end;
            if of.is_whole {
                let window = of.first..of.first + self.probes;
                let way = self.pool.way.each_ref().map(|c| &c[window.clone()]);
                f(of, Own { rows, way, weight: &self.pool.weight[window] }, &[]);
                continue;
            }
            let these = part..part + rows.len();
            part = these.end;
            let (which, guides) = (&batch.which[these.clone()], batch.guides.get(these).unwrap_or_default());
            let pick = |to: &mut Vec<f32>, from: &[f32]| {
                to.clear();
                to.extend(which.iter().map(|w| from[*w as usize]));
            };
            for (to, from) in columns.way.iter_mut().zip(&self.pool.way) {
                pick(to, from);
            }
            if guides.is_empty() {
                pick(&mut columns.weight, &self.pool.weight);
            } else {
                columns.weight.clear();
                columns.weight.extend(guides.iter().map(|g| short(g.weight)));
            }
            let way = columns.way.each_ref().map(Vec::as_slice);
            f(of, Own { rows, way, weight: &columns.weight }, guides);
        }
    }
}

impl Own<'_> {
    fn whole(&self) -> f64 {
        self.weight.iter().map(|w| f64::from(*w)).sum()
    }

    /// Returns the sum of the directions from a marker on, each times a number: in four lanes on every machine.
    #[inline]
    fn dot<T: Copy>(&self, from: usize, of: &[T], mut number: impl FnMut(T) -> f32) -> DVec3 {
        let [x, y, z] = self.way.map(|way| way[from..from + of.len()].as_chunks::<4>());
        let (of, of_end) = of.as_chunks::<4>();
        let mut sum = [Vec4::ZERO; 3];
        for (((x, y), z), of) in x.0.iter().zip(y.0).zip(z.0).zip(of) {
            let number = Vec4::from_array(of.map(&mut number));
            for (sum, way) in sum.iter_mut().zip([x, y, z]) {
                *sum += Vec4::from_array(*way) * number;
            }
        }
        let mut sum = sum.map(|s| s.to_array());
        for (lane, of) in of_end.iter().enumerate() {
            let number = number(*of);
            for (sum, way) in sum.iter_mut().zip([x.1, y.1, z.1]) {
                sum[lane] += way[lane] * number;
            }
        }
        Vec3::from_array(sum.map(|s| (s[0] + s[1]) + (s[2] + s[3]))).as_dvec3()
    }

    /// Returns the number of markers of older buds in the cells of its markers, and their push, less the part of its
    /// own in [`see`](Self::see); then adds its own to the cells.
    fn meet(&self, held: &mut [Held]) -> (f64, DVec3) {
        let (mut older, mut push) = (0.0, DVec3::ZERO);
        for (k, rows) in self.rows.chunks(TOGETHER).enumerate() {
            let mut count = 0;
            push += self.dot(k * TOGETHER, rows, |row| {
                let there = held[row as usize];
                count += there.count;
                there.weight
            });
            older += f64::from(count);
        }
        for (row, w) in self.rows.iter().zip(self.weight) {
            let there = &mut held[*row as usize];
            there.count += 1;
            there.weight += w;
        }
        (older, push - self.see(held))
    }

    /// Returns the push by everything in the cells of its markers.
    fn see(&self, held: &[Held]) -> DVec3 {
        let rows = self.rows.chunks(TOGETHER).enumerate();
        rows.map(|(k, rows)| self.dot(k * TOGETHER, rows, |row| held[row as usize].weight)).sum()
    }
}

#[expect(clippy::cast_possible_truncation, reason = "the nearest")]
const fn short(x: f64) -> f32 {
    x as f32
}

/// A bud's frame in a grid, in cells.
struct Turned {
    /// The cell from which the numbers below count.
    cell: [u64; 3],
    /// The bud's position, minus half a cell.
    at: [f32; 3],
    /// For each of x, y and z, the change of the cell along heading, side and across.
    frame: [[f32; 3]; 3],
}

impl Batch {
    /// Adds markers at positions in a bud's frame, in cells.
    #[inline]
    fn add(&mut self, x: &[f32], y: &[f32], z: &[f32], turned: &Turned, grid: &Grid) {
        let [tx, ty, tz] = turned.frame;
        let [ax, ay, az] = turned.at;
        // The nearest whole numbers, as the last bits of a number that has no room for others: far faster than a cast.
        let whole = |x: f32| (x + WHOLE).to_bits() & 0x7f_ffff;
        let local = |(x, y, z): (f32, f32, f32)| {
            let along = |at: f32, t: [f32; 3]| whole(at + x * t[0] + y * t[1] + z * t[2]);
            [along(ax, tx), along(ay, ty), along(az, tz)]
        };
        let places = x.iter().zip(y).zip(z).map(|((x, y), z)| local((*x, *y, *z)));
        if grid.all.is_none() {
            let [nx, ny] = grid.tiles;
            self.cells.extend(places.map(|n| {
                let [x, y, z] = [0, 1, 2].map(|i| turned.cell[i].wrapping_add(u64::from(n[i])));
                let inner = (x & 3) | (y & 3) << 2 | (z & 3) << 4;
                let tile =
                    (z >> 2).wrapping_mul(ny).wrapping_add(y >> 2).wrapping_mul(nx).wrapping_add(x >> 2);
                tile << TILE | inner
            }));
            return;
        }
        #[expect(clippy::cast_possible_truncation, reason = "a grid of few tiles")]
        let ([cx, cy, cz], [nx, ny]) = (turned.cell.map(|n| n as u32), grid.tiles.map(|n| n as u32));
        // Written to existing rows, as this runs four at a time; a push for each would check the capacity.
        let from = self.rows.len();
        self.rows.resize(from + x.len(), 0);
        for (row, [x, y, z]) in self.rows[from..].iter_mut().zip(places) {
            let (x, y, z) = (cx.wrapping_add(x), cy.wrapping_add(y), cz.wrapping_add(z));
            let inner = (x & 3) | (y & 3) << 2 | (z & 3) << 4;
            let tile = (z >> 2).wrapping_mul(ny).wrapping_add(y >> 2).wrapping_mul(nx).wrapping_add(x >> 2);
            *row = tile << TILE | inner;
        }
    }
}

impl Grid {
    fn turned(&self, at: DVec3, frame: [DVec3; 3]) -> Turned {
        let place = (at - self.from) * self.per_m;
        let cell = place.floor();
        let reach = f64::from(self.reach);
        let [h, s, a] = frame.map(|v| v.as_vec3().to_array());
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
        let from = (cell - reach).to_array().map(|n| n as u64);
        Turned {
            cell: from,
            at: (place - cell + reach - 0.5).as_vec3().to_array(),
            frame: [0, 1, 2].map(|i| [h[i], s[i], a[i]]),
        }
    }
}

/// Numbers the tiles that contain markers from 0, in the order in which buds reach them: most of the grid is empty, and
/// the data of neighbouring buds is stored together.
#[derive(Clone, Debug, Default)]
struct Tiles {
    /// Number of each tile of the grid, or of each tile with markers.
    numbers: Vec<u32>,
    /// For a grid that is nearly empty, as with trees far apart: only its tiles with markers, in order.
    met: Vec<u64>,
    next: u32,
}

impl Tiles {
    fn begin(&mut self, grid: &Grid, batches: &[Batch]) {
        self.met.clear();
        self.met.extend(batches.iter().flat_map(|b| &b.cells).map(|c| c >> TILE));
        base::sort_by_key(&mut self.met, |&tile| tile);
        self.met.dedup();
        self.next = 0;
        self.numbers.clear();
        self.numbers.resize(grid.all.unwrap_or(self.met.len()), NO_TILE);
    }

    /// Replaces the cells of a batch by rows.
    fn number(&mut self, batch: &mut Batch) {
        let Self { numbers, met, next } = self;
        let mut row = |tile: usize, inner: u32| {
            // A position that is not a number must be in some tile, too.
            let tile = if tile < numbers.len() { tile } else { 0 };
            let number = &mut numbers[tile];
            if *number == NO_TILE {
                *number = *next;
                *next += 1;
            }
            *number << TILE | inner
        };
        const INNER: u32 = (1 << TILE) - 1;
        for cell in &mut batch.rows {
            *cell = row((*cell >> TILE) as usize, *cell & INNER);
        }
        let far = batch.cells.iter().map(|cell| {
            let tile = met.partition_point(|m| *m < cell >> TILE);
            #[expect(clippy::cast_possible_truncation, reason = "6 bits")]
            row(tile, (cell & u64::from(INNER)) as u32)
        });
        batch.rows.extend(far);
    }

    /// Returns the number of cells in numbered tiles.
    const fn cells(&self) -> usize {
        (self.next as usize) << TILE
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Obstacles;
    use base::{Budget, Stream};

    /// Sums the markers of each bud against all of all others, with far more of them.
    fn brute(cone: &Cone, spec: &GuidedSpec, stands: &[Stand], batch: &Batch) -> Vec<(DVec3, f64)> {
        const MANY: usize = 2000;
        let each = cone.markers as f64 / MANY as f64;
        let cos_half = ops::cos(spec.half_angle_deg * (PI / 180.0));
        let near = spec.near * spec.internode_m;
        let placed = |k: usize| {
            let Of { side, across, .. } = batch.of[k];
            (0..MANY).map(move |s| {
                let [x, y, z] = cone.pool.place.each_ref().map(|c| f64::from(c[s]) * cone.cell);
                let turned = stands[k].heading * x + side * y + across * z;
                (stands[k].at + turned, f64::from(cone.pool.weight[s]))
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
            (push * each, older * each)
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
            // The sum of differences over the sum of totals. The same number of random markers was off by up to 1.9
            // over the root of their number.
            let share = |differ: f64, there: f64| differ / there;
            let there = truth.iter().map(|t| t.1).sum::<f64>();
            let bias = share(sums.iter().map(|s| s.older).sum::<f64>() - there, there);
            let off = share(sums.iter().zip(&truth).map(|(s, t)| (s.older - t.1).abs()).sum(), there);
            let pushed = truth.iter().map(|t| t.0.length()).sum();
            let away = share(sums.iter().zip(&truth).map(|(s, t)| s.push.distance(t.0)).sum(), pushed);
            let chance = 1.0 / f64::from(markers).sqrt();
            assert!(bias.abs() < 0.05, "{markers} in {half_angle_deg}: {bias}");
            assert!(off < 0.02 + 1.7 * chance, "{markers} in {half_angle_deg}: {off}");
            // If buds perceive all around, others push from all sides, and little remains.
            let most = if half_angle_deg > 90.0 { 4.0 } else { 2.0 };
            assert!(away < 0.02 + most * chance, "{markers} in {half_angle_deg}: {away}");
        }
    }
}
