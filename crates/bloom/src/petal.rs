//! One petal on one day: its profile, nested within those outside it, and the resulting grid of points.

use base::{Seed, ops};
use glam::DVec3;
use plant::OrganKind;

use crate::foliage::Ground;
use crate::organs::{Bed, Grid};
use crate::wanted::{FlowerSpec, PetalMesh, rad};
use crate::whorl::{Aestivation, Fate, Whorl};
use crate::{GrowthLaw, Quantity};

/// Colour of a closed bud, linear.
const BUD: [f32; 3] = [0.27, 0.40, 0.09];
/// Steps of a profile.
const FINE: usize = 96;
/// Longest duration of the fall of a petal, as a share of the wilting.
const FALL: f64 = 0.03;

/// Times at which each petal of each ring falls, by its rank: one after another, none while another is falling.
pub(crate) struct Falls {
    rings: Vec<Vec<f64>>,
    /// Duration of a fall.
    long: f64,
}

impl Falls {
    pub(crate) fn new(rings: &[Whorl]) -> Self {
        let mut times: Vec<(f64, usize, usize)> = Vec::new();
        let mut out: Vec<Vec<f64>> = rings.iter().map(|w| vec![1.0; w.count as usize]).collect();
        for (ring, whorl) in rings.iter().enumerate().filter(|(_, w)| w.fate != Fate::Cling) {
            let last = f64::from(whorl.count.max(2) - 1);
            let spread = 0.5 * (0.9 - whorl.falls);
            let own = (0..whorl.count).map(|rank| whorl.falls + spread * f64::from(rank) / last);
            if whorl.fate == Fate::Gone {
                // No falling petal could meet another.
                out[ring] = own.collect();
            } else {
                times.extend(own.enumerate().map(|(rank, time)| (time, ring, rank)));
            }
        }
        base::sort_by(&mut times, |a, b| a.0.total_cmp(&b.0));
        let first = times.first().map_or(0.0, |t| t.0.max(0.0));
        let gap = (1.1 * FALL).min((0.95 - first) / times.len().max(1) as f64);
        let mut soonest = f64::NEG_INFINITY;
        for row in &mut times {
            row.0 = row.0.max(soonest);
            soonest = row.0 + gap;
        }
        // All have fallen by the end.
        let mut latest = 0.95;
        for &(time, ring, rank) in times.iter().rev() {
            out[ring][rank] = time.min(latest);
            latest = out[ring][rank] - gap;
        }
        Self { rings: out, long: 0.95 * gap }
    }
}

/// Age of a flower.
pub(crate) struct Times<'a> {
    law: &'a GrowthLaw,
    /// Share of the opening, below 0 for a bud that is younger than the first day.
    share: f64,
    /// Age: -1 is the bud, 0 full bloom, 1 the end.
    pub life: f64,
    /// Degree of opening, wilting and ripening, 0 to 1.
    pub open: f64,
    pub wilt: f64,
    pub ripe: f64,
    ripening: f64,
}

impl<'a> Times<'a> {
    pub(crate) fn new(spec: &FlowerSpec, law: &'a GrowthLaw, day: f64) -> Self {
        let [opening, wilting] = [spec.opening_days, spec.wilting_days].map(|d| d.max(1e-6));
        let share = day / opening;
        let life = if day < opening { (share - 1.0).max(-1.0) } else { ((day - opening) / wilting).min(1.0) };
        let times = Self {
            law,
            share,
            life,
            open: spec.opened(law, day),
            wilt: 0.0,
            ripe: 0.0,
            ripening: spec.ripening.clamp(0.0, 0.9),
        };
        let [wilt, ripe] = times.late(life);
        Self { wilt, ripe, ..times }
    }

    /// Returns the degrees of wilting and ripening at an age.
    fn late(&self, life: f64) -> [f64; 2] {
        let wilt = (life / (1.0 - self.ripening)).clamp(0.0, 1.0);
        let ripe = ((life - 1.0 + self.ripening) / self.ripening.max(1e-9)).clamp(0.0, 1.0);
        [wilt, if self.ripening > 0.0 { ripe } else { 0.0 }]
    }
}

/// State of one petal on one day.
#[derive(Clone, Copy)]
pub(crate) struct State {
    pub angle: [f64; 3],
    length: f64,
    width: f64,
    /// Degree of opening and wilting, 0 to 1.
    open: f64,
    wilt: f64,
    /// Share of the colour of age.
    aged: f64,
}

fn blend3(a: [f64; 3], b: [f64; 3], g: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| ops::lerp(a[k], b[k], g[k]))
}

impl Whorl {
    /// Returns the state of a petal that opens later than the first of its ring by a share of the opening.
    pub(crate) fn state(&self, times: &Times<'_>, later: f64) -> State {
        self.state_at(times, later, times.life)
    }

    fn state_at(&self, times: &Times<'_>, later: f64, life: f64) -> State {
        let law = times.law;
        let share = if life < 0.0 { times.share.min(1.0 + life) } else { times.share };
        // The law's own time is stretched to the opening; a petal with a delay starts later and ends with the others.
        let delay = (self.delay + later).clamp(0.0, 0.9);
        let share = ((share - delay) / (1.0 - delay)).clamp(0.0, 1.0);
        let (span, now) = (law.span_days, share * law.span_days);
        // Each part of a petal opens as its region moves; without laws of regions, as the organ grows.
        let g = [0.15, 0.5, 0.85].map(|along| law.pace_at("petal", along, 0.0, span, now).clamp(0.0, 1.0));
        let size = law.progress("petal", Quantity::Size, 0.5, 0.0, span, now).clamp(0.0, 1.0);
        let [late, ripe] = times.late(life.max(0.0));
        let wilt = ops::smoothstep(0.0, 1.0, late);
        let open = blend3(self.bud_deg, self.open_deg, g);
        let wilted = blend3(open, self.wilted_deg, [wilt; 3]);
        let ripe = ops::smoothstep(0.0, 0.6, ripe) * self.ripens;
        let young = if self.sepal { [0.82, 0.8] } else { [0.62, 0.55] };
        let [short, narrow] = [0.24, 0.45].map(|x| 1.0 - x * self.shrivel * wilt);
        State {
            angle: blend3(wilted, self.ripe_deg, [ripe; 3]).map(rad),
            // Sepals and bracts are nearly grown in the bud. Withered petals are about a quarter shorter and half as
            // wide: they roll in and dry.
            length: self.length_m * ops::lerp(young[0], 1.0, size) * short,
            width: self.width_m * ops::lerp(young[1], 1.0, size) * narrow,
            open: size,
            wilt,
            aged: ops::smoothstep(-0.15, 0.55, life) * self.aging,
        }
    }

    /// Returns the colour at a point: from base to tip, slightly deeper along the middle; withering browns it from the
    /// margin and the tip inwards.
    #[expect(clippy::cast_possible_truncation, reason = "colours are f32")]
    fn color(&self, u: f64, v: f64, state: &State) -> [f32; 3] {
        let share = ops::smoothstep(0.0, 0.6, v) as f32;
        let middle = (1.0 - 0.14 * (1.0 - u.abs()) * (1.0 - u.abs())) as f32;
        let dry = if self.sepal { [0.17, 0.15, 0.045] } else { [0.14, 0.08, 0.033] };
        // The margin is brown at half of the wilting, the middle at its end.
        let inner = 1.0 - (v * v).max(u * u);
        let withered = ops::smoothstep(0.0, 1.0, (1.9 * state.wilt - 0.9 * inner).clamp(0.0, 1.0));
        // A petal that shrivels little keeps its colour.
        let withered = (withered * (0.35 + 0.65 * self.shrivel)) as f32;
        // The bud greens from its base and along its middle, and the green disappears as it opens.
        let young = 1.0 - ops::smoothstep(0.0, 0.75, state.open);
        let green = (self.green * young * (1.0 - 0.5 * v * v) * (1.0 - 0.25 * u * u)) as f32;
        let (guide, aged) = (self.guide.strength_at(u, v) as f32, state.aged as f32);
        // Pink over green is grey: the tip's own colour comes when most of the green has gone.
        let late = (1.0 - green) * (1.0 - green);
        [0, 1, 2].map(|q| {
            let fair = self.base_color[q] + (self.tip_color[q] - self.base_color[q]) * share * late;
            let fair = fair + (self.aged_color[q] - fair) * aged;
            let own = (fair + (self.guide.color[q] - fair) * guide) * middle;
            let fresh = own + (BUD[q] - own) * green;
            // Some of the petal's own colour stays.
            fresh + (0.88 * dry[q] + 0.12 * fresh - fresh) * withered
        })
    }
}

/// Positions of rows and columns of a petal.
pub(crate) struct Rows {
    across: Vec<f64>,
    along: Vec<f64>,
}

impl Rows {
    pub(crate) fn new(mesh: PetalMesh) -> Self {
        let (rows, columns) = (mesh.rows.max(2), mesh.columns.max(2));
        let even = |n: u32| (0..=n).map(move |i| f64::from(i) / f64::from(n));
        Self {
            across: even(columns).collect(),
            // Rows are closer towards the tip, where the outline turns.
            along: even(rows).map(|t| 1.0 - ops::powf(1.0 - t, 1.6)).collect(),
        }
    }
}

/// Outward bending of the petals outside, by the length along them from their base: nothing inside bends farther.
pub(crate) struct Nest {
    /// Step, metres.
    step: f64,
    angle: [f64; FINE + 1],
    /// Radius of the free space in a closed bud at each height, and its top.
    room: [f64; FINE + 1],
    top: f64,
}

/// Reduction of the radius inside a closed bud, as a share of the distance from the axis.
const WITHIN: f64 = 0.16;
/// Largest such reduction, as a share of its length.
const MARGIN: f64 = 0.02;
/// Largest overlap of edges in a closed bud, in distances from the axis.
const OVER: f64 = 0.06;

impl Nest {
    pub(crate) fn new(reach: f64) -> Self {
        let far = [f64::INFINITY; FINE + 1];
        Self { step: reach.max(1e-6) / FINE as f64, angle: far, room: far, top: f64::INFINITY }
    }

    /// Returns the greatest distance from the axis at a height, in a closing bud.
    fn room(&self, height: f64) -> f64 {
        self.room[self.bin(height)]
    }

    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to FINE")]
    fn bin(&self, height: f64) -> usize {
        // Insertions may lie below the base of the flower.
        (height / self.step + 0.1 * FINE as f64).clamp(0.0, FINE as f64) as usize
    }

    /// Limits the room inside a closing bud, where it bends inwards.
    fn shut_in(&mut self, curve: &Curve) {
        if curve.closed <= 0.0 {
            return;
        }
        let mut wide = [0.0_f64; FINE + 1];
        let inwards = curve.points.windows(2).zip(&curve.angles).filter(|(_, a)| **a < 0.0);
        for (pair, _) in inwards {
            let [a, b] = [pair[0][1], pair[1][1]].map(|h| self.bin(h));
            let r = pair[0][0].max(pair[1][0]);
            wide[a.min(b)..=a.max(b)].iter_mut().for_each(|w| *w = w.max(r));
        }
        let top = curve.points.iter().map(|p| p[1]).fold(f64::NEG_INFINITY, f64::max);
        let (end, last) = (curve.points[FINE][0], self.bin(top));
        let tight = ops::smoothstep(0.0, 0.4, curve.closed);
        for (k, w) in wide.into_iter().enumerate() {
            let r = if w > 0.0 {
                w
            } else if k > last {
                end
            } else {
                continue;
            };
            let within = r - (WITHIN * r).min(MARGIN * curve.length);
            self.room[k] = self.room[k].min(ops::lerp(1.6 * r, within, tight));
        }
        self.top = self.top.min(top - 2.0 * self.step + (1.0 / tight.max(1e-9) - 1.0) * curve.length);
    }

    /// Returns the greatest angle to the axis at a length from the base, radians.
    pub(crate) fn limit(&self, way: f64) -> f64 {
        let at = (way / self.step).clamp(0.0, FINE as f64);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to FINE")]
        let low = at.floor() as usize;
        let (a, b) = (self.angle[low], self.angle[(low + 1).min(FINE)]);
        if a.is_finite() && b.is_finite() { ops::lerp(a, b, at - low as f64) } else { a.min(b) }
    }

    /// Adds a profile: the next ones lie inside it.
    fn hold(&mut self, curve: &Curve) {
        for (k, angle) in self.angle.iter_mut().enumerate() {
            let way = k as f64 * self.step;
            if way <= curve.length {
                *angle = angle.min(curve.angle(way / curve.length.max(1e-9)));
            }
        }
    }
}

/// The line that a petal follows in the half plane of its azimuth, in even steps.
#[derive(Clone)]
pub(crate) struct Curve {
    length: f64,
    /// Distance from the axis, height, and sine and cosine of the angle to the axis.
    points: [[f64; 4]; FINE + 1],
    angles: [f64; FINE + 1],
    /// Degree to which it returns to the axis, 0 to 1: a returning one closes a bud.
    closed: f64,
}

impl Curve {
    fn new(whorl: &Whorl, state: &State, nest: &Nest) -> Self {
        let [a, b, c] = state.angle;
        // Angles between the three places by a parabola through them.
        let bent =
            |v: f64| a * (1.0 - v) * (1.0 - 2.0 * v) + 4.0 * b * v * (1.0 - v) + c * v * (2.0 * v - 1.0);
        let (mut radius, mut height) = (whorl.insertion.radius_m, whorl.insertion.height_m);
        let least = radius.min(0.0012).min(0.03 * state.length);
        let step = state.length / FINE as f64;
        let mut points = [[0.0; 4]; FINE + 1];
        let mut angles = [0.0; FINE + 1];
        for k in 0..=FINE {
            let v = k as f64 / FINE as f64;
            let angle = bent(v).min(nest.limit(v * state.length));
            let (sin, cos) = ops::sin_cos(angle);
            angles[k] = angle;
            points[k] = [radius, height, sin, cos];
            // A profile that reaches the axis runs up along it.
            radius = (radius + sin * step).max(least);
            height = (height + cos * step).min(nest.top.max(height));
            radius = radius.min(nest.room(height));
        }
        let widest = points.iter().map(|p| p[0]).fold(0.0, f64::max);
        let comes_back = 1.0 - ops::smoothstep(0.3, 0.7, points[FINE][0] / widest.max(1e-9));
        let closed = comes_back * (1.0 - ops::smoothstep(0.25, 0.6, state.open));
        Self { length: state.length, points, angles, closed }
    }

    fn interpolate(&self, v: f64) -> [f64; 4] {
        let (low, t) = Self::row(v);
        let (a, b) = (&self.points[low], &self.points[low + 1]);
        [0, 1, 2, 3].map(|q| ops::lerp(a[q], b[q], t))
    }

    fn angle(&self, v: f64) -> f64 {
        let (low, t) = Self::row(v);
        ops::lerp(self.angles[low], self.angles[low + 1], t)
    }

    fn row(v: f64) -> (usize, f64) {
        let at = v.clamp(0.0, 1.0) * FINE as f64;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to FINE - 1")]
        let low = (at.floor() as usize).min(FINE - 1);
        (low, at - low as f64)
    }
}

impl FlowerSpec {
    /// Adds all petals of a ring, and their profile to the nest.
    pub(crate) fn ring(
        &self,
        bed: &mut Bed<'_>,
        kind: OrganKind,
        ring: &Whorl,
        (times, rows, falls): (&Times<'_>, &Rows, (&Falls, usize)),
        (nest, ground): (&mut Nest, &mut Ground),
    ) {
        let together = matches!(ring.aestivation, Aestivation::Contorted | Aestivation::Fused);
        let n = ring.count.max(1);
        let mut order: Vec<(u32, u32)> = (0..n).map(|k| (ring.rank(k), k)).collect();
        order.sort_unstable();
        if together {
            order.iter_mut().zip(0..).for_each(|(row, k)| row.1 = k);
        }
        let size = (1.05 * ring.length_m.max(ring.width_m)) * bed.size;
        if ring.fate == Fate::Drop {
            ground.next_ring(n, size);
        }
        let mut shared: Option<(Curve, State, Vec<[f32; 3]>)> = None;
        let mut innermost: Option<Curve> = None;
        for &(rank, k) in &order {
            let last = f64::from(n.max(2) - 1);
            let later = if together { 0.0 } else { ring.succession * f64::from(rank) / last };
            let seed = bed.seed.child(u64::from(k)).child(ring.length_m.to_bits());
            let released = falls.0.rings[falls.1][rank as usize];
            let loose = ring.fate != Fate::Cling && times.life > released;
            let alone = loose || (!together && ring.succession > 0.0);
            if alone || shared.is_none() {
                let life = if loose { released } else { times.life };
                let mut state = ring.state_at(times, later, life);
                let curve = Curve::new(ring, &state, nest);
                let fallen = if loose { ((times.life - released) / falls.0.long).min(1.0) } else { 0.0 };
                // A loosely hanging petal still encloses those inside it.
                if fallen < 0.6 {
                    nest.hold(&curve);
                }
                if loose {
                    state.wilt = (state.wilt + 0.6 * (times.life - released)).min(0.85);
                }
                if !loose {
                    innermost = Some(curve.clone());
                }
                let colors = Self::colors(ring, &state, rows);
                if alone {
                    let grid = self.petal(ring, (&curve, &state, colors), rows, (k, rank));
                    place(bed, kind, grid, (ring, k, fallen), ground, seed);
                    continue;
                }
                shared = Some((curve, state, colors));
            }
            if let Some((curve, state, colors)) = &shared {
                let grid = self.petal(ring, (curve, state, colors.clone()), rows, (k, rank));
                bed.petal(kind, grid);
            }
        }
        // Petals of one ring overlap one another; the next ring lies within.
        if let Some(curve) = innermost {
            nest.shut_in(&curve);
        }
    }

    fn colors(ring: &Whorl, state: &State, rows: &Rows) -> Vec<[f32; 3]> {
        let across = || rows.across.iter().map(|&t| 2.0 * t - 1.0);
        rows.along.iter().flat_map(|&v| across().map(move |u| ring.color(u, v, state))).collect()
    }

    /// Returns the height of the waves of margins, as a share of the petal's length: soft in bloom, crumpled when
    /// withered.
    fn waves(azimuth: f64, v: f64, state: &State) -> f64 {
        let soft = 0.010 * state.open * ops::sin(5.0 * azimuth + 2.0 * v) * (1.0 - state.wilt);
        if state.wilt <= 0.0 {
            return soft;
        }
        let crumpled = ops::sin(9.0 * azimuth + 7.0 * v) + 0.6 * ops::sin(16.0 * azimuth - 11.0 * v);
        soft + 0.019 * state.wilt * crumpled
    }

    /// Makes one petal in the flower's own coordinates.
    fn petal(
        &self,
        whorl: &Whorl,
        (curve, state, colors): (&Curve, &State, Vec<[f32; 3]>),
        rows: &Rows,
        (k, rank): (u32, u32),
    ) -> Grid {
        let mut points = Vec::with_capacity(colors.len());
        let apart = whorl.apart();
        let azimuth = rad(whorl.phase_deg) + apart * f64::from(k);
        // A petal wraps the axis, but neither itself nor more than its next neighbours.
        let widest = match whorl.aestivation {
            Aestivation::Contorted => 0.85 * apart,
            Aestivation::Imbricate => 0.95 * apart,
            Aestivation::Valvate => 0.485 * whorl.narrowest(),
            Aestivation::Fused => 0.5 * apart,
        };
        // In a closing bud, neighbours meet; as it opens, they get their own width.
        let meet = match whorl.aestivation {
            Aestivation::Contorted | Aestivation::Imbricate => 0.54 * apart,
            Aestivation::Valvate => widest,
            Aestivation::Fused => 0.0,
        };
        let lean = whorl.lean_m.abs()
            * if whorl.aestivation == Aestivation::Imbricate { 0.5 * f64::from(whorl.count) } else { 1.0 };
        let even = whorl.spacing_deg <= 0.0 && whorl.count > 1;
        let shut = if even { curve.closed * (1.0 - ops::smoothstep(0.0, 0.35, state.open)) } else { 0.0 };
        let level = 0.5 * f64::from(whorl.count.max(1) - 1) - f64::from(rank);
        let twist = rad(whorl.twist_deg) * (1.0 - state.open);
        for (i, &row) in rows.along.iter().enumerate() {
            let half = 0.5 * state.width * whorl.outline(row);
            let fused = whorl.aestivation == Aestivation::Fused;
            for (j, &t) in rows.across.iter().enumerate() {
                let u = 2.0 * t - 1.0;
                let mut v = whorl.place(u, row);
                let mut broad = half;
                if whorl.fringe > 0.0 {
                    v -= 0.14 * whorl.fringe * row * row * row * f64::from(u8::from(j % 2 == 1));
                    broad *= 1.0 - 0.35 * whorl.fringe * row * f64::from(u8::from(i % 2 == 1));
                }
                let [radius, height, s, c] = curve.interpolate(v);
                let wrapped = if fused { widest } else { broad / radius.max(1e-4) };
                let shut = shut * meet * (1.0 - ops::smoothstep(0.92, 1.0, v));
                let spread = wrapped.max(shut).min(0.9 * ops::PI).min(widest);
                let angle = azimuth + u * spread + twist * v;
                let (sin, cos) = ops::sin_cos(angle);
                // The waves belong to the whole flower: overlapping petals wave together. Near the axis there is no
                // room for them.
                let room = state.length.min(4.0 * radius) * v * v * whorl.crumple;
                let own = match whorl.aestivation {
                    Aestivation::Contorted => whorl.lean_m * u,
                    Aestivation::Imbricate => whorl.lean_m * level,
                    _ => 0.0,
                };
                let own = own * (OVER * radius / (curve.closed * lean).max(1e-12)).min(1.0);
                let cup = whorl.cup * state.open * half * u * u * v.min(0.3) / 0.3;
                let lean = own - cup + room * Self::waves(angle, v, state);
                let (r, y) = ((radius + lean * c).max(1e-5), height - lean * s);
                points.push(DVec3::new(r * cos, y, r * sin));
            }
        }
        Grid { points, across: rows.across.clone(), along: rows.along.clone(), colors }
    }
}

/// Places one petal: in the flower, on its way down, on the ground, or gone.
fn place(
    bed: &mut Bed<'_>,
    kind: OrganKind,
    mut grid: Grid,
    (ring, k, fallen): (&Whorl, u32, f64),
    ground: &Ground,
    seed: Seed,
) {
    if fallen > 0.0 && ring.fate == Fate::Gone {
        let columns = grid.across.len();
        let root = grid.points[columns / 2];
        grid.points.iter_mut().for_each(|p| *p = root + (*p - root) * (1.0 - fallen));
    }
    if fallen > 0.0 && ring.fate == Fate::Drop {
        grid.points.iter_mut().for_each(|p| *p = bed.transform(*p));
        ground.drop(&mut grid, (bed.place.0, ground.azimuth(k)), fallen, seed);
        bed.loose_petal(kind, grid);
    } else {
        bed.petal(kind, grid);
    }
}
