//! A species -> a whole flower at any day: bud, bloom, wilting.
//!
//! Petals lie on surfaces of revolution about the flower's axis. Their profile (angle to the axis at base, middle
//! and tip) goes from bud to bloom by the growth law of the region, and on to wilting. Within a whorl each petal
//! leans: one edge lies inside its neighbour, the other outside, so petals may overlap but never meet; whorls are
//! nested.

use base::{Budget, Counted, OverBudget, Seed, ops, turn};
use glam::{DQuat, DVec2, DVec3};
use plant::{Flower, FlowerId, OrganKind, Plant, PlantPaint};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::organs::{Bed, Grid, Seat};
use crate::{GrowthLaw, Quantity};

/// One ring of petals.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Whorl {
    /// Petals, 1 to 200, default 6.
    #[schemars(range(min = 1, max = 200))]
    pub count: u32,
    /// Length of an open petal, metres, default 0.05.
    #[schemars(range(min = 1e-4, max = 10.0), extend("x-unit" = "m"))]
    pub length_m: f64,
    /// Greatest width, metres, default 0.02.
    #[schemars(range(min = 1e-5, max = 10.0), extend("x-unit" = "m"))]
    pub width_m: f64,
    /// Place of the greatest width along the petal, 0.2 to 0.9, default 0.5.
    #[schemars(range(min = 0.2, max = 0.9))]
    pub widest: f64,
    /// Width at the base as a share of the greatest, default 0.3.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub claw: f64,
    /// How pointed the tip is: 1 is a point, 0 is round; default 0.5.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub point: f64,
    /// Where petals are inserted.
    pub insertion: Insertion,
    /// Angle to the axis at base, middle and tip in the bud, degrees.
    #[schemars(inner(range(min = -180.0, max = 360.0)), extend("x-unit" = "deg"))]
    pub bud_deg: [f64; 3],
    /// Angle to the axis at base, middle and tip in full bloom, degrees.
    #[schemars(inner(range(min = -180.0, max = 360.0)), extend("x-unit" = "deg"))]
    pub open_deg: [f64; 3],
    /// Angle to the axis at base, middle and tip when wilted, degrees.
    #[schemars(inner(range(min = -180.0, max = 360.0)), extend("x-unit" = "deg"))]
    pub wilted_deg: [f64; 3],
    /// Days that the whorl opens later than the first, as a share of the opening, 0 to 0.9, default 0.
    #[schemars(range(min = 0.0, max = 0.9))]
    pub delay: f64,
    /// Turn of the whorl about the axis, degrees, default 0.
    #[schemars(range(min = -360.0, max = 3600.0), extend("x-unit" = "deg"))]
    pub phase_deg: f64,
    /// Lean within the whorl: distance of one edge to the other across the petal, metres, default 0.002.
    #[schemars(range(min = -1.0, max = 1.0), extend("x-unit" = "m"))]
    pub lean_m: f64,
    /// Linear colour at the base: shares of red, green and blue light.
    #[schemars(inner(range(min = 0.0, max = 1.0)), extend("x-unit" = "linear-colour"))]
    pub base_color: [f32; 3],
    /// Linear colour at the tip.
    #[schemars(inner(range(min = 0.0, max = 1.0)), extend("x-unit" = "linear-colour"))]
    pub tip_color: [f32; 3],
    /// How green the bud still is, 0 to 1, default 0.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub green: f64,
    /// Sepals or bracts: they keep their form when petals are replaced. Default false.
    pub sepal: bool,
    /// The petal's own outline, drawn or measured; without one it is made of the shares above. Not saved.
    #[serde(skip)]
    pub form: Option<PetalForm>,
}

/// Where the petals of a whorl are inserted.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Insertion {
    /// Distance from the axis, metres.
    #[schemars(range(min = 0.0, max = 10.0), extend("x-unit" = "m"))]
    pub radius_m: f64,
    /// Height above the base of the flower, metres.
    #[schemars(range(min = -10.0, max = 10.0), extend("x-unit" = "m"))]
    pub height_m: f64,
}

impl Default for Whorl {
    /// Six slender petals of 5 cm.
    fn default() -> Self {
        Self {
            count: 6,
            length_m: 0.05,
            width_m: 0.02,
            widest: 0.5,
            claw: 0.3,
            point: 0.5,
            insertion: Insertion { radius_m: 0.004, height_m: 0.0 },
            bud_deg: [20.0, 0.0, -8.0],
            open_deg: [30.0, 50.0, 80.0],
            wilted_deg: [60.0, 100.0, 140.0],
            delay: 0.0,
            phase_deg: 0.0,
            lean_m: 0.002,
            base_color: [0.8; 3],
            tip_color: [0.8; 3],
            green: 0.0,
            sepal: false,
            form: None,
        }
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

/// A flower that opens. Saved as TOML; the species that come with the program are such files ([`preset`](crate::preset)).
///
/// ```
/// let text = "name = \"star\"\nstalk_m = 0.1\n[[whorls]]\ncount = 5\nlength_m = 0.03";
/// let star: bloom::FlowerSpec = spec::from_toml(text)?;
/// assert_eq!((star.whorls[0].count, star.umbel, star.opening_days), (5, 1, 6.0));
/// # Ok::<(), spec::SpecFault>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct FlowerSpec {
    /// Name of the species.
    pub name: String,
    /// Rings of petals, outermost first.
    pub whorls: Vec<Whorl>,
    /// Stamens; default none.
    pub stamens: Stamens,
    /// Length of the pistil, metres; 0, the default, for none.
    #[schemars(range(min = 0.0, max = 5.0), extend("x-unit" = "m"))]
    pub pistil_m: f64,
    /// Radius of a disc of florets, metres; 0, the default, for none.
    #[schemars(range(min = 0.0, max = 5.0), extend("x-unit" = "m"))]
    pub disc_m: f64,
    /// Length of the stalk, metres, 0 to 5, default 0.25; 0 for a flower without one, such as one that is put on a plant.
    #[schemars(range(min = 0.0, max = 5.0), extend("x-unit" = "m"))]
    pub stalk_m: f64,
    /// Angle by which the open flower nods, degrees, 0 to 90, default 0; wilting adds to it.
    #[schemars(range(min = 0.0, max = 90.0), extend("x-unit" = "deg"))]
    pub nod_deg: f64,
    /// Flowers of an umbel, 1 to 200; 1, the default, for a single flower.
    #[schemars(range(min = 1, max = 200))]
    pub umbel: u32,
    /// Days from bud to full bloom, 0.1 to 60, default 6.
    #[schemars(range(min = 0.1, max = 60.0), extend("x-unit" = "d"))]
    pub opening_days: f64,
    /// Days from full bloom to wilted, 0.1 to 40, default 4.
    #[schemars(range(min = 0.1, max = 40.0), extend("x-unit" = "d"))]
    pub wilting_days: f64,
    /// Rate of the flower's own growth law, per day, 0.01 to 100, default 0.95.
    #[schemars(range(min = 0.01, max = 100.0))]
    pub rate_per_day: f64,
    /// How fine a petal is meshed.
    pub mesh: PetalMesh,
}

spec::schemas!(FlowerSpec = include_str!("../schemas/flower.json"));

/// The stamens of a flower.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stamens {
    /// How many, 0 to 500.
    #[schemars(range(min = 0, max = 500))]
    pub count: u32,
    /// Length of one in an open flower, metres.
    #[schemars(range(min = 0.0, max = 5.0), extend("x-unit" = "m"))]
    pub length_m: f64,
    /// Angle by which they spread from the axis, degrees, 0 to 180.
    #[schemars(range(min = 0.0, max = 180.0), extend("x-unit" = "deg"))]
    pub spread_deg: f64,
}

/// How fine a petal is meshed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PetalMesh {
    /// Rows from base to tip, 2 to 100.
    #[schemars(range(min = 2, max = 100))]
    pub rows: u32,
    /// Columns across, 2 to 100.
    #[schemars(range(min = 2, max = 100))]
    pub columns: u32,
}

impl Default for FlowerSpec {
    /// A stalk without petals.
    fn default() -> Self {
        Self {
            name: "flower".into(),
            whorls: Vec::new(),
            stamens: Stamens::default(),
            pistil_m: 0.0,
            disc_m: 0.0,
            stalk_m: 0.25,
            nod_deg: 0.0,
            umbel: 1,
            opening_days: 6.0,
            wilting_days: 4.0,
            rate_per_day: 0.95,
            mesh: PetalMesh { rows: 18, columns: 14 },
        }
    }
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
        let [opening, wilting] = [spec.opening_days, spec.wilting_days].map(|d| d.max(1e-6));
        // The law's own time is stretched to the opening; a whorl with a delay starts later and ends with the others.
        let share = ((day / opening - self.delay) / (1.0 - self.delay.clamp(0.0, 0.9))).clamp(0.0, 1.0);
        let (span, now) = (law.span_days, share * law.span_days);
        // Each part of a petal opens as its region moves; without laws of regions, as the organ grows.
        let g = [0.15, 0.5, 0.85].map(|along| law.pace_at("petal", along, 0.0, span, now).clamp(0.0, 1.0));
        let size = law.progress("petal", Quantity::Size, 0.5, 0.0, span, now).clamp(0.0, 1.0);
        let wilt = ops::smoothstep(0.0, 1.0, ((day - opening) / wilting).clamp(0.0, 1.0));
        let open = blend3(self.bud_deg, self.open_deg, g);
        let young = if self.sepal { [0.82, 0.8] } else { [0.62, 0.55] };
        Profile {
            angle: blend3(open, self.wilted_deg, [wilt; 3]).map(rad),
            // Sepals and bracts are nearly grown in the bud. Withered petals are about a quarter shorter and half as
            // wide: they roll in and dry.
            length: self.length_m * ops::lerp(young[0], 1.0, size) * (1.0 - 0.24 * wilt),
            width: self.width_m * ops::lerp(young[1], 1.0, size) * (1.0 - 0.45 * wilt),
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

/// Of stalks, linear.
const STALK: [f32; 3] = [0.16, 0.32, 0.07];
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
            let own = (self.base_color[q] + (self.tip_color[q] - self.base_color[q]) * share * late) * middle;
            let fresh = own + (BUD[q] - own) * green;
            // Some of the petal's own colour stays.
            fresh + (0.88 * dry[q] + 0.12 * fresh - fresh) * withered
        })
    }
}

impl FlowerSpec {
    /// Days from bud to full bloom, and from there to wilted.
    pub const fn days(&self) -> [f64; 2] {
        [self.opening_days, self.wilting_days]
    }

    /// Fails if its petals have more triangles than the budget allows.
    ///
    /// # Errors
    /// [`OverBudget`].
    pub fn check(&self, budget: &Budget) -> Result<(), OverBudget> {
        let petals: u64 = self.whorls.iter().map(|w| u64::from(w.count)).sum();
        let each = 2 * u64::from(self.mesh.rows) * u64::from(self.mesh.columns);
        let all = petals.saturating_mul(u64::from(self.umbel)).saturating_mul(each);
        budget.check(Counted::Triangles, all, "lower count, umbel or mesh")
    }

    /// The growth law of the species itself.
    pub fn own_law(&self) -> GrowthLaw {
        GrowthLaw::logistic(&self.name, self.opening_days, self.rate_per_day)
    }

    /// The flower at `day`: 0 is the bud, `opening_days` full bloom, `wilting_days` later it has wilted.
    ///
    /// Guaranteed: the same axes, organs and grids at every day; `validate()` finds nothing. `law` sets the pace by its
    /// size and region laws, whatever species it was fitted to (Huai, Yang and Cai 2019, figure 13).
    pub fn at(&self, day: f64, law: &GrowthLaw, seed: Seed) -> Plant {
        let paint = PlantPaint { stem: Some(STALK), ..PlantPaint::default() };
        let mut plant = Plant { name: self.name.clone(), paint, ..Plant::default() };
        self.add_to(&mut plant, &Seat::default(), day, law, seed);
        plant
    }

    /// As [`at`](Self::at), on a plant that there is already.
    pub fn add_to(&self, plant: &mut Plant, seat: &Seat, day: f64, law: &GrowthLaw, seed: Seed) {
        let [opening, wilting] = [self.opening_days, self.wilting_days].map(|d| d.max(1e-6));
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
        let longest = self.whorls.iter().map(|w| w.length_m).fold(self.disc_m, f64::max);
        let pedicel = if self.umbel > 1 { self.pedicel() } else { 0.0 };
        self.stalk_m + pedicel + 2.0 * longest
    }

    /// Petals of this form in all whorls but those of sepals; `aspect` is width over length.
    #[must_use]
    pub fn with_petals(mut self, form: PetalForm, aspect: f64) -> Self {
        for whorl in self.whorls.iter_mut().filter(|w| !w.sepal) {
            whorl.form = Some(form);
            whorl.width_m = whorl.length_m * aspect;
        }
        self
    }

    /// Where flower `f` of the umbel sits, and how it is turned.
    pub(crate) fn place(&self, f: u32, day: f64) -> (DVec3, DQuat) {
        let n = self.umbel.max(1);
        if n == 1 {
            let [opening, wilting] = [self.opening_days, self.wilting_days].map(|d| d.max(1e-6));
            let open = ops::smoothstep(0.0, 1.0, (day / opening).clamp(0.0, 1.0));
            let wilt = ops::smoothstep(0.0, 1.0, ((day - opening) / wilting).clamp(0.0, 1.0));
            let nod = rad(self.nod_deg * (0.35 + 0.65 * open + 0.6 * wilt));
            let (s, c) = ops::sin_cos(0.5 * nod);
            // The stalk stays where it is: only the head turns, towards +Z.
            let forward = 0.22 * self.stalk_m * ops::sin(rad(self.nod_deg));
            return (DVec3::new(0.0, self.stalk_m, forward), DQuat::from_xyzw(s, 0.0, 0.0, c));
        }
        // Evenly over a cap of 75 degrees (Vogel's spiral), each on its own pedicel.
        let t = (f64::from(f) + 0.5) / f64::from(n);
        let tilt = ops::acos_clamped(1.0 - t * (1.0 - ops::cos(rad(75.0))));
        let azimuth = f64::from(f) * rad(137.507_8);
        let (s, c) = ops::sin_cos(azimuth);
        let direction = DVec3::new(ops::sin(tilt) * c, ops::cos(tilt), ops::sin(tilt) * s);
        (DVec3::Y * self.stalk_m + direction * self.pedicel(), turn::between(DVec3::Y, direction))
    }

    fn pedicel(&self) -> f64 {
        self.whorls.first().map_or(0.05, |w| 1.1 * w.length_m)
    }

    /// Height of the waves of margins, as a share of the petal's length: soft in bloom, crumpled when withered.
    fn waves(&self, azimuth: f64, v: f64, profile: &Profile) -> f64 {
        let soft = 0.010 * profile.open * ops::sin(5.0 * azimuth + 2.0 * v);
        let crumpled = ops::sin(9.0 * azimuth + 7.0 * v) + 0.6 * ops::sin(16.0 * azimuth - 11.0 * v);
        soft * (1.0 - profile.wilt) + 0.019 * profile.wilt * crumpled
    }

    /// One petal in the flower's own coordinates.
    fn petal(&self, whorl: &Whorl, profile: &Profile, k: u32) -> Grid {
        let (rows, columns) = (self.mesh.rows.max(2), self.mesh.columns.max(2));
        let across = (0..=columns).map(|j| f64::from(j) / f64::from(columns)).collect();
        let mut grid = Grid { points: Vec::new(), across, along: Vec::new(), colors: Vec::new() };
        let apart = ops::TAU / f64::from(whorl.count.max(1));
        let azimuth = rad(whorl.phase_deg) + apart * f64::from(k);
        // The profile by small steps; angles between the three places by a parabola through them.
        let fine = 8 * rows;
        let [a, b, c] = profile.angle;
        let angle =
            |v: f64| a * (1.0 - v) * (1.0 - 2.0 * v) + 4.0 * b * v * (1.0 - v) + c * v * (2.0 * v - 1.0);
        let (mut radius, mut height) = (whorl.insertion.radius_m, whorl.insertion.height_m);
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
                    let lean = whorl.lean_m * u + wave;
                    let (r, y) = (radius + lean * c, height - lean * s);
                    grid.points.push(DVec3::new(r.max(1e-5) * cos, y, r.max(1e-5) * sin));
                    grid.colors.push(whorl.color(u, v, profile));
                }
            }
            // A profile that comes to the axis runs up along it.
            radius = (radius + s * step).max(whorl.insertion.radius_m.min(0.0012));
            height += c * step;
        }
        grid
    }
}
