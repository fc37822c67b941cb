//! A species -> a whole flower at any day: bud, bloom, wilting.
//!
//! Petals lie on surfaces of revolution about the flower's axis. Their profile (angle to the axis at base, middle
//! and tip) goes from bud to bloom by the growth law of the region, and on to wilting. Within a whorl each petal
//! leans: one edge lies inside its neighbour, the other outside, so petals may overlap but never meet; whorls are
//! nested.

use base::{Seed, ops, turn};
use glam::{DQuat, DVec2, DVec3};
use plant::{Flower, FlowerId, OrganKind, Plant};

use crate::organs::{Bed, Grid, Seat};
use crate::{GrowthLaw, Quantity};

/// One ring of petals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Whorl {
    /// Petals.
    pub count: u32,
    /// Length of an open petal, metres.
    pub length: f64,
    /// Greatest width, metres.
    pub width: f64,
    /// Place of the greatest width along the petal, 0.2 to 0.9.
    pub widest: f64,
    /// Width at the base as a share of the greatest.
    pub claw: f64,
    /// How pointed the tip is: 1 is a point, 0 is round.
    pub point: f64,
    /// Radius and height of the insertion, metres.
    pub insertion: [f64; 2],
    /// Angle to the axis at base, middle and tip in the bud, degrees.
    pub bud: [f64; 3],
    /// The same in full bloom.
    pub open: [f64; 3],
    /// The same when wilted.
    pub wilted: [f64; 3],
    /// Days that the whorl opens later than the first, as a share of the opening.
    pub delay: f64,
    /// Turn of the whorl about the axis, degrees.
    pub phase: f64,
    /// Lean within the whorl: distance of one edge to the other across the petal, metres.
    pub lean: f64,
    /// Linear colour at the base and at the tip.
    pub colors: [[f32; 3]; 2],
    /// How green the bud still is, 0 to 1.
    pub green: f64,
    /// Sepals or bracts: they keep their form when petals are replaced.
    pub sepal: bool,
    /// The petal's own outline, drawn or measured; without one it is made of the shares above.
    pub form: Option<PetalForm>,
}

impl Default for Whorl {
    /// Six slender petals of 5 cm.
    fn default() -> Self {
        crate::species::PLAIN
    }
}

/// Half widths of a petal at even places from base to tip, as shares of the greatest.
///
/// ```
/// use glam::DVec2;
/// let rhombus = [DVec2::ZERO, DVec2::new(0.3, 0.5), DVec2::Y, DVec2::new(-0.3, 0.5)];
/// let (form, aspect) = bloom::PetalForm::of_outline(&rhombus).unwrap();
/// assert!((aspect - 0.6).abs() < 1e-9 && (form.half_width(0.25) - 0.5).abs() < 0.03);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PetalForm(pub [f64; 17]);

impl PetalForm {
    /// From an outline with its root at the origin and its tip on +y; also its width as a share of its length.
    /// None for an outline without area.
    pub fn of_outline(outline: &[DVec2]) -> Option<(Self, f64)> {
        let tip = outline.iter().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max);
        let sound = tip.is_finite() && tip > 0.0 && outline.len() >= 3;
        if !sound {
            return None;
        }
        let width = |y: f64| {
            let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
            for (a, b) in outline.iter().zip(outline.iter().cycle().skip(1)) {
                if (a.y <= y) != (b.y <= y) {
                    let x = ops::lerp(a.x, b.x, (y - a.y) / (b.y - a.y));
                    (low, high) = (low.min(x), high.max(x));
                }
            }
            (high - low).max(0.0)
        };
        // A little inside the ends, where an outline is one point.
        let widths: [f64; 17] = core::array::from_fn(|k| width(tip * (0.004 + 0.992 * k as f64 / 16.0)));
        let widest = widths.iter().copied().fold(0.0, f64::max);
        let aspect = widest / tip;
        (aspect.is_finite() && aspect > 0.01).then(|| (Self(widths.map(|w| w / widest)), aspect))
    }

    /// The mean of several.
    pub fn mean(forms: &[Self]) -> Option<Self> {
        let n = forms.len() as f64;
        (n > 0.0).then(|| Self(core::array::from_fn(|k| forms.iter().map(|f| f.0[k]).sum::<f64>() / n)))
    }

    /// Half the width at `v`, 0 at the base to 1 at the tip, as a share of the greatest.
    pub fn half_width(&self, v: f64) -> f64 {
        let at = v.clamp(0.0, 1.0) * 16.0;
        let low = at.floor().min(15.0);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 15")]
        let k = low as usize;
        ops::lerp(self.0[k], self.0[k + 1], at - low)
    }
}

/// A flower that opens.
#[derive(Clone, Debug, PartialEq)]
pub struct FlowerSpec {
    /// Name of the species.
    pub name: String,
    /// Outermost first.
    pub whorls: Vec<Whorl>,
    /// Stamens: number, open length in metres, spread in degrees.
    pub stamens: (u32, f64, f64),
    /// Length of the pistil, metres; 0 for none.
    pub pistil: f64,
    /// Radius of a disc of florets, metres; 0 for none.
    pub disc: f64,
    /// Length of the stalk, metres; 0 for a flower without one, such as one that is put on a plant.
    pub stalk: f64,
    /// Angle by which the open flower nods, degrees; wilting adds to it.
    pub nod: f64,
    /// Flowers of an umbel; 1 for a single flower.
    pub umbel: u32,
    /// Days from bud to full bloom, and from there to wilted.
    pub days: [f64; 2],
    /// Rate of the default law, per day.
    pub rate: f64,
    /// Rows and columns of a petal's grid, each at least 2.
    pub mesh: [u32; 2],
}

/// State of one whorl at one day.
struct Profile {
    angle: [f64; 3],
    length: f64,
    width: f64,
    /// How far it has opened and wilted, 0 to 1.
    open: f64,
    wilt: f64,
}

/// Degrees to radians.
pub(crate) fn rad(d: f64) -> f64 {
    d * (ops::PI / 180.0)
}

fn blend3(a: [f64; 3], b: [f64; 3], g: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| ops::lerp(a[k], b[k], g[k]))
}

impl Whorl {
    fn profile(&self, spec: &FlowerSpec, law: &GrowthLaw, day: f64) -> Profile {
        let [opening, wilting] = spec.days.map(|d| d.max(1e-6));
        // The law's own time is stretched to the opening; a whorl with a delay starts later and ends with the others.
        let share = ((day / opening - self.delay) / (1.0 - self.delay.clamp(0.0, 0.9))).clamp(0.0, 1.0);
        let at = |along: f64, axis| {
            law.progress("petal", axis, along, 0.0, law.span_days, share * law.span_days).clamp(0.0, 1.0)
        };
        let g = [0.15, 0.5, 0.85].map(|along| at(along, Quantity::Size).max(0.0));
        let size = at(0.5, Quantity::Size);
        let wilt = ops::smoothstep(0.0, 1.0, ((day - opening) / wilting).clamp(0.0, 1.0));
        let open = blend3(self.bud, self.open, g);
        let young = if self.sepal { [0.82, 0.8] } else { [0.62, 0.55] };
        Profile {
            angle: blend3(open, self.wilted, [wilt; 3]).map(rad),
            // Sepals and bracts are nearly grown in the bud. Withered petals are about a quarter shorter and half as
            // wide: they roll in and dry.
            length: self.length * ops::lerp(young[0], 1.0, size) * (1.0 - 0.24 * wilt),
            width: self.width * ops::lerp(young[1], 1.0, size) * (1.0 - 0.45 * wilt),
            open: size.clamp(0.0, 1.0),
            wilt,
        }
    }

    /// Half width at `v` as a share of the greatest.
    fn outline(&self, v: f64) -> f64 {
        if let Some(form) = &self.form {
            return form.half_width(v).max(0.02);
        }
        let w = self.widest.clamp(0.2, 0.9);
        if v < w {
            let t = v / w;
            ops::lerp(self.claw, 1.0, t * t * (3.0 - 2.0 * t))
        } else {
            let t = (v - w) / (1.0 - w);
            let round = (1.0 - t * t).max(0.0).sqrt();
            ops::lerp(round, 1.0 - t * t * (1.0 - 0.3 * (1.0 - t)), self.point).max(0.0) * (1.0 - 0.02) + 0.02
        }
    }
}

/// Of a closed bud, linear.
const BUD: [f32; 3] = [0.27, 0.40, 0.09];

impl Whorl {
    /// The colour at a place: from base to tip, a little deeper along the middle; withering browns it from the
    /// margin and the tip inwards.
    #[expect(clippy::cast_possible_truncation, reason = "colours are f32")]
    fn color(&self, u: f64, v: f64, profile: &Profile) -> [f32; 3] {
        let share = ops::smoothstep(0.0, 0.6, v) as f32;
        let middle = (1.0 - 0.14 * (1.0 - u.abs()) * (1.0 - u.abs())) as f32;
        let dry = if self.sepal { [0.17, 0.15, 0.045] } else { [0.14, 0.08, 0.033] };
        // The margin is brown at half of the wilting, the middle at its end.
        let inner = 1.0 - (v * v).max(u * u);
        let withered = ops::smoothstep(0.0, 1.0, (1.9 * profile.wilt - 0.9 * inner).clamp(0.0, 1.0)) as f32;
        // The bud greens from its base and along its middle, and the green goes as it opens.
        let young = 1.0 - ops::smoothstep(0.0, 0.75, profile.open);
        let green = (self.green * young * (1.0 - 0.5 * v * v) * (1.0 - 0.25 * u * u)) as f32;
        // Pink over green is grey: the tip's own colour comes when most of the green has gone.
        let late = (1.0 - green) * (1.0 - green);
        [0, 1, 2].map(|q| {
            let own = (self.colors[0][q] + (self.colors[1][q] - self.colors[0][q]) * share * late) * middle;
            let fresh = own + (BUD[q] - own) * green;
            // Some of the petal's own colour stays.
            fresh + (0.88 * dry[q] + 0.12 * fresh - fresh) * withered
        })
    }
}

impl FlowerSpec {
    /// The names of the presets.
    pub const PRESETS: [&'static str; 5] = ["rose", "lily", "tulip", "sunflower", "clivia"];

    /// The flower at `day`: 0 is the bud, `days[0]` full bloom, `days[0] + days[1]` wilted.
    ///
    /// Guaranteed: the same axes, organs and grids at every day; `validate()` finds nothing. `law` sets the pace by its
    /// size and region laws, whatever species it was fitted to (paper 003, figure 13).
    pub fn at(&self, day: f64, law: &GrowthLaw, seed: Seed) -> Plant {
        let mut plant = Plant { name: self.name.clone(), ..Plant::default() };
        self.add_to(&mut plant, &Seat::default(), day, law, seed);
        plant
    }

    /// As [`at`](Self::at), on a plant that there is already.
    pub fn add_to(&self, plant: &mut Plant, seat: &Seat, day: f64, law: &GrowthLaw, seed: Seed) {
        let [opening, wilting] = self.days.map(|d| d.max(1e-6));
        let share = (day / opening).clamp(0.0, 1.0);
        let g = law
            .progress("petal", Quantity::Size, 0.3, 0.0, law.span_days, share * law.span_days)
            .clamp(0.0, 1.0);
        let wilt = ((day - opening) / wilting).clamp(0.0, 1.0);
        let profiles: Vec<Profile> = self.whorls.iter().map(|w| w.profile(self, law, day)).collect();
        let petals = || self.whorls.iter().zip(&profiles).filter(|(w, _)| !w.sepal);
        let half_angle = petals().next().map_or(0.0, |(_, p)| p.angle[1].clamp(0.0, ops::FRAC_PI_2));
        let whorls = u32::try_from(petals().count()).unwrap_or(u32::MAX);
        let bearers = self.stalks(plant, seat, day, seed);
        for (f, bearer) in (0..).zip(bearers) {
            let (centre, turn) = self.place(f, day);
            let place = (seat.at(centre), seat.turn * turn);
            let (flower, axis) = (FlowerId::new(plant.flowers.len()), place.1 * DVec3::Y);
            let axis = axis.normalize_or(DVec3::Y);
            plant.flowers.push(Flower { bearer, centre: place.0, axis, half_angle, whorls });
            let seed = seed.child(u64::from(f));
            let mut bed = Bed { plant: &mut *plant, flower, bearer, place, seed };
            self.receptacle(&mut bed);
            for (whorl, profile) in self.whorls.iter().zip(&profiles) {
                let kind = if whorl.sepal { OrganKind::Sepal } else { OrganKind::Petal };
                for k in 0..whorl.count {
                    bed.petal(kind, self.petal(whorl, profile, k));
                }
            }
            self.centre(&mut bed, g, wilt);
        }
    }

    /// About how large the open flower is with its stalk, metres.
    pub fn size_m(&self) -> f64 {
        let longest = self.whorls.iter().map(|w| w.length).fold(self.disc, f64::max);
        let pedicel = if self.umbel > 1 { self.pedicel() } else { 0.0 };
        self.stalk + pedicel + 2.0 * longest
    }

    /// Petals of this form in all whorls but those of sepals; `aspect` is width over length.
    #[must_use]
    pub fn with_petals(mut self, form: PetalForm, aspect: f64) -> Self {
        for whorl in self.whorls.iter_mut().filter(|w| !w.sepal) {
            whorl.form = Some(form);
            whorl.width = whorl.length * aspect;
        }
        self
    }

    /// Where flower `f` of the umbel sits, and how it is turned.
    pub(crate) fn place(&self, f: u32, day: f64) -> (DVec3, DQuat) {
        let n = self.umbel.max(1);
        if n == 1 {
            let [opening, wilting] = self.days.map(|d| d.max(1e-6));
            let open = ops::smoothstep(0.0, 1.0, (day / opening).clamp(0.0, 1.0));
            let wilt = ops::smoothstep(0.0, 1.0, ((day - opening) / wilting).clamp(0.0, 1.0));
            let nod = rad(self.nod * (0.35 + 0.65 * open + 0.6 * wilt));
            let (s, c) = ops::sin_cos(0.5 * nod);
            // The stalk stays where it is: only the head turns, towards +Z.
            let forward = 0.22 * self.stalk * ops::sin(rad(self.nod));
            return (DVec3::new(0.0, self.stalk, forward), DQuat::from_xyzw(s, 0.0, 0.0, c));
        }
        // Evenly over a cap of 75 degrees (Vogel's spiral), each on its own pedicel.
        let t = (f64::from(f) + 0.5) / f64::from(n);
        let tilt = ops::acos_clamped(1.0 - t * (1.0 - ops::cos(rad(75.0))));
        let azimuth = f64::from(f) * rad(137.507_8);
        let (s, c) = ops::sin_cos(azimuth);
        let direction = DVec3::new(ops::sin(tilt) * c, ops::cos(tilt), ops::sin(tilt) * s);
        (DVec3::Y * self.stalk + direction * self.pedicel(), turn::between(DVec3::Y, direction))
    }

    fn pedicel(&self) -> f64 {
        self.whorls.first().map_or(0.05, |w| 1.1 * w.length)
    }

    /// Height of the waves of margins, as a share of the petal's length: soft in bloom, crumpled when withered.
    fn waves(&self, azimuth: f64, v: f64, profile: &Profile) -> f64 {
        let soft = 0.010 * profile.open * ops::sin(5.0 * azimuth + 2.0 * v);
        let crumpled = ops::sin(9.0 * azimuth + 7.0 * v) + 0.6 * ops::sin(16.0 * azimuth - 11.0 * v);
        soft * (1.0 - profile.wilt) + 0.019 * profile.wilt * crumpled
    }

    /// One petal in the flower's own coordinates.
    fn petal(&self, whorl: &Whorl, profile: &Profile, k: u32) -> Grid {
        let (rows, columns) = (self.mesh[0].max(2), self.mesh[1].max(2));
        let across = (0..=columns).map(|j| f64::from(j) / f64::from(columns)).collect();
        let mut grid = Grid { points: Vec::new(), across, along: Vec::new(), colors: Vec::new() };
        let apart = ops::TAU / f64::from(whorl.count.max(1));
        let azimuth = rad(whorl.phase) + apart * f64::from(k);
        // The profile by small steps; angles between the three places by a parabola through them.
        let fine = 8 * rows;
        let [a, b, c] = profile.angle;
        let angle =
            |v: f64| a * (1.0 - v) * (1.0 - 2.0 * v) + 4.0 * b * v * (1.0 - v) + c * v * (2.0 * v - 1.0);
        let (mut radius, mut height) = (whorl.insertion[0], whorl.insertion[1]);
        // Rows are closer towards the tip, where the outline turns.
        let row_at = |i: u32| 1.0 - ops::powf(1.0 - f64::from(i) / f64::from(fine), 1.6);
        for i in 0..=fine {
            let v = row_at(i);
            let step = profile.length * (row_at((i + 1).min(fine)) - v);
            let (s, c) = ops::sin_cos(angle(v));
            if i.is_multiple_of(8) {
                grid.along.push(v);
                let half = 0.5 * profile.width * whorl.outline(v);
                // A petal wraps the axis, but neither itself nor more than its next neighbours.
                let spread = (half / radius.max(1e-4)).min(0.9 * ops::PI).min(0.85 * apart);
                for j in 0..=columns {
                    let u = 2.0 * f64::from(j) / f64::from(columns) - 1.0;
                    let (sin, cos) = ops::sin_cos(azimuth + u * spread);
                    // Waves are those of the whole flower: petals that lie over one another wave together.
                    // Near the axis there is no room for them.
                    let room = profile.length.min(4.0 * radius) * v * v;
                    let wave = room * self.waves(azimuth + u * spread, v, profile);
                    let lean = whorl.lean * u + wave;
                    let (r, y) = (radius + lean * c, height - lean * s);
                    grid.points.push(DVec3::new(r.max(1e-5) * cos, y, r.max(1e-5) * sin));
                    grid.colors.push(whorl.color(u, v, profile));
                }
            }
            // A profile that comes to the axis runs up along it.
            radius = (radius + s * step).max(whorl.insertion[0].min(0.0012));
            height += c * step;
        }
        grid
    }
}
