//! Settings of a ring of petals: numbers, form, angles, colours, aestivation and fate.

use base::ops;
use glam::DVec2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// One ring of petals.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Whorl {
    /// Number of petals, 1 to 200, default 6.
    #[schemars(range(min = 1, max = 200))]
    pub count: u32,
    /// Rings with this number of petals, one within the other, 1 to 20, default 1.
    #[schemars(range(min = 1, max = 20))]
    pub rings: u32,
    /// The innermost of several rings.
    pub innermost: Innermost,
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
    /// Share of the petal that is as narrow as its base (a clawed petal), 0 to 0.7, default 0.
    #[schemars(range(min = 0.0, max = 0.7))]
    pub claw_length: f64,
    /// Pointedness of the tip: 1 is a point, 0 is round; default 0.5.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub point: f64,
    /// Depth of a notch in the tip, as a share of the length, 0 to 0.5, default 0.
    #[schemars(range(min = 0.0, max = 0.5))]
    pub notch: f64,
    /// Depth of the fringe of the margin, 0 to 1, default 0.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub fringe: f64,
    /// Rise of the margins towards the axis of the flower, as a share of half the width, -1 to 1, default 0.
    #[schemars(range(min = -1.0, max = 1.0))]
    pub cup: f64,
    /// Insertion of the petals.
    pub insertion: Insertion,
    /// Arrangement of the petals in the bud.
    pub aestivation: Aestivation,
    /// Turn of the tips about the axis in the bud, degrees, default 0.
    #[schemars(range(min = -720.0, max = 720.0), extend("x-unit" = "deg"))]
    pub twist_deg: f64,
    /// Angle to the axis at base, middle and tip in the bud, degrees.
    #[schemars(inner(range(min = -180.0, max = 360.0)), extend("x-unit" = "deg"))]
    pub bud_deg: [f64; 3],
    /// Angle to the axis at base, middle and tip in full bloom, degrees.
    #[schemars(inner(range(min = -180.0, max = 360.0)), extend("x-unit" = "deg"))]
    pub open_deg: [f64; 3],
    /// Angle to the axis at base, middle and tip when wilted, degrees.
    #[schemars(inner(range(min = -180.0, max = 360.0)), extend("x-unit" = "deg"))]
    pub wilted_deg: [f64; 3],
    /// Angle to the axis at base, middle and tip when the fruit is ripe, degrees: for a flower with `ripening`.
    #[schemars(inner(range(min = -180.0, max = 360.0)), extend("x-unit" = "deg"))]
    pub ripe_deg: [f64; 3],
    /// Share of the way from the wilted to the ripe angles, 0 to 1, default 0.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub ripens: f64,
    /// Delay of the opening of the whorl, as a share of the opening, 0 to 0.9, default 0.
    #[schemars(range(min = 0.0, max = 0.9))]
    pub delay: f64,
    /// Delay of the last petal of the ring after the first, as a share of the opening, 0 to 0.6, default 0. Petals of a
    /// `contorted` or `fused` ring open together.
    #[schemars(range(min = 0.0, max = 0.6))]
    pub succession: f64,
    /// Turn of the whorl about the axis, degrees, default 0.
    #[schemars(range(min = -360.0, max = 3600.0), extend("x-unit" = "deg"))]
    pub phase_deg: f64,
    /// Angle from one petal to the next, degrees, 0 to 360; 0, the default, for evenly around the axis.
    #[schemars(range(min = 0.0, max = 360.0), extend("x-unit" = "deg"))]
    pub spacing_deg: f64,
    /// Lean within the whorl: distance of one edge to the other across the petal, metres, default 0.002. In an
    /// `imbricate` ring: from one petal to the next within it.
    #[schemars(range(min = -1.0, max = 1.0), extend("x-unit" = "m"))]
    pub lean_m: f64,
    /// Strength of the waves of petals in bloom and of their crumpling when withered, 0 to 3, default 1.
    #[schemars(range(min = 0.0, max = 3.0))]
    pub crumple: f64,
    /// Shrinking of withered petals, 0 not at all to 1, default 1: a quarter shorter, nearly half as wide.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub shrivel: f64,
    /// Fate of the petals at the end.
    pub fate: Fate,
    /// Time at which the first of them falls, -1 to 0.9, default 0.3: -1 is the bud, 0 full bloom, 1 the end of
    /// wilting.
    #[schemars(range(min = -1.0, max = 0.9))]
    pub falls: f64,
    /// Linear colour at the base: shares of red, green and blue light.
    #[schemars(inner(range(min = 0.0, max = 1.0)), extend("x-unit" = "linear-colour"))]
    pub base_color: [f32; 3],
    /// Linear colour at the tip.
    #[schemars(inner(range(min = 0.0, max = 1.0)), extend("x-unit" = "linear-colour"))]
    pub tip_color: [f32; 3],
    /// Linear colour that petals take as the days pass after full bloom.
    #[schemars(inner(range(min = 0.0, max = 1.0)), extend("x-unit" = "linear-colour"))]
    pub aged_color: [f32; 3],
    /// Share of that colour, 0 to 1, default 0.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub aging: f64,
    /// A mark that guides visitors to the nectar.
    pub guide: Guide,
    /// Greenness of the bud, 0 to 1, default 0.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub green: f64,
    /// Whether they are sepals or bracts, which keep their form when petals are replaced. Default false.
    pub sepal: bool,
    /// The petal's own outline, drawn or measured; without one it is computed from the shares above. Not saved.
    #[serde(skip)]
    pub form: Option<PetalForm>,
}

/// The innermost of several rings, relative to the outermost; the rings between are interpolated.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Innermost {
    /// Size of its petals as a share, 0.05 to 2, default 1.
    #[schemars(range(min = 0.05, max = 2.0))]
    pub size: f64,
    /// Share by which it opens and wilts from the bud, 0 to 1, default 1.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub open: f64,
    /// Distance from the axis as a share, 0 to 1, default 0.7.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub radius: f64,
    /// Additional height of its insertion, metres, 0 to 1, default 0.002.
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "m"))]
    pub height_m: f64,
    /// Delay of its opening, as a share of the opening, 0 to 0.6, default 0.
    #[schemars(range(min = 0.0, max = 0.6))]
    pub delay: f64,
}

impl Default for Innermost {
    /// Returns one like the outermost, slightly within it.
    fn default() -> Self {
        Self { size: 1.0, open: 1.0, radius: 0.7, height_m: 0.002, delay: 0.0 }
    }
}

/// Arrangement of the petals of a ring in the bud.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Aestivation {
    /// Each has one edge over and one under its neighbours.
    #[default]
    Contorted,
    /// One within the other along a spiral, the outermost first: of five, two lie outside and two inside (quincuncial).
    Imbricate,
    /// Edge to edge; none covers another.
    Valvate,
    /// Grown together to a tube or funnel.
    Fused,
}

/// Fate of the petals at the end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Fate {
    /// They wither in place.
    #[default]
    Cling,
    /// They fall, one after another, and lie on the ground.
    Drop,
    /// They fall and disappear: for flowers high above the ground.
    Gone,
}

/// A mark on petals that guides visitors to the nectar.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Guide {
    /// Its linear colour.
    #[schemars(inner(range(min = 0.0, max = 1.0)), extend("x-unit" = "linear-colour"))]
    pub color: [f32; 3],
    /// Reach from the base along the petal, 0 to 1; 0, the default, for none.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub reach: f64,
    /// Width across the petal, 0 to 1, default 1.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub width: f64,
    /// Strength, 0 to 1, default 1.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub strength: f64,
    /// Number of lines, 0 to 9; 0, the default, for a blotch.
    #[schemars(range(min = 0, max = 9))]
    pub lines: u32,
}

impl Default for Guide {
    /// Returns settings that draw no guide.
    fn default() -> Self {
        Self { color: [0.8; 3], reach: 0.0, width: 1.0, strength: 1.0, lines: 0 }
    }
}

impl Guide {
    /// Returns its strength at a place, 0 to 1.
    pub(crate) fn strength_at(&self, u: f64, v: f64) -> f64 {
        if self.reach <= 0.0 {
            return 0.0;
        }
        let along = 1.0 - ops::smoothstep(0.6 * self.reach, self.reach.max(1e-6), v);
        let across = if self.width >= 1.0 {
            1.0
        } else {
            1.0 - ops::smoothstep(0.5 * self.width, self.width.max(1e-6), u.abs())
        };
        let lines = if self.lines == 0 {
            1.0
        } else {
            ops::smoothstep(0.3, 0.8, 0.5 + 0.5 * ops::cos(ops::TAU * 0.5 * f64::from(self.lines) * u))
        };
        self.strength * along * across * lines
    }
}

/// Insertion of the petals of a whorl.
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
    /// Returns six slender petals of 5 cm.
    fn default() -> Self {
        Self {
            count: 6,
            rings: 1,
            innermost: Innermost::default(),
            length_m: 0.05,
            width_m: 0.02,
            widest: 0.5,
            claw: 0.3,
            claw_length: 0.0,
            point: 0.5,
            notch: 0.0,
            fringe: 0.0,
            cup: 0.0,
            insertion: Insertion { radius_m: 0.004, height_m: 0.0 },
            aestivation: Aestivation::Contorted,
            twist_deg: 0.0,
            bud_deg: [20.0, 0.0, -8.0],
            open_deg: [30.0, 50.0, 80.0],
            wilted_deg: [60.0, 100.0, 140.0],
            ripe_deg: [60.0, 100.0, 140.0],
            ripens: 0.0,
            delay: 0.0,
            succession: 0.0,
            phase_deg: 0.0,
            spacing_deg: 0.0,
            lean_m: 0.002,
            crumple: 1.0,
            shrivel: 1.0,
            fate: Fate::Cling,
            falls: 0.3,
            base_color: [0.8; 3],
            tip_color: [0.8; 3],
            aged_color: [0.8; 3],
            aging: 0.0,
            guide: Guide::default(),
            green: 0.0,
            sepal: false,
            form: None,
        }
    }
}

impl Whorl {
    /// Returns one of its rings, outermost first, as a whorl of one ring.
    pub(crate) fn ring(&self, ring: u32) -> Self {
        let t = if self.rings > 1 { f64::from(ring) / f64::from(self.rings - 1) } else { 0.0 };
        let Innermost { size, open, radius, height_m, delay } = self.innermost;
        let size = ops::lerp(1.0, size, t);
        let open = ops::lerp(1.0, open, t);
        let towards = |to: [f64; 3]| [0, 1, 2].map(|k| ops::lerp(self.bud_deg[k], to[k], open));
        let inside = 1.0 - 0.25 * t * (1.0 - self.innermost.open);
        let Insertion { radius_m, height_m: low } = self.insertion;
        Self {
            rings: 1,
            length_m: self.length_m * size,
            width_m: self.width_m * size,
            insertion: Insertion {
                radius_m: radius_m * ops::lerp(1.0, radius, t),
                height_m: low + height_m * t,
            },
            bud_deg: self.bud_deg.map(|a| a * inside),
            open_deg: towards(self.open_deg),
            wilted_deg: towards(self.wilted_deg),
            delay: (self.delay + delay * t).min(0.9),
            // The golden share of the way to the next petal: no ring stands behind an earlier one.
            phase_deg: self.phase_deg + f64::from(ring) * 0.618 * 360.0 / f64::from(self.count.max(1)),
            falls: ops::lerp(self.falls, 0.5 * (self.falls + 0.9), 0.6 * t),
            ..*self
        }
    }

    /// Returns the azimuth from one petal to the next, radians.
    pub(crate) fn apart(&self) -> f64 {
        if self.spacing_deg > 0.0 {
            self.spacing_deg * (ops::PI / 180.0)
        } else {
            ops::TAU / f64::from(self.count.max(1))
        }
    }

    /// Returns the least azimuth between two neighbours, radians.
    pub(crate) fn narrowest(&self) -> f64 {
        let gap = ops::TAU - self.apart() * f64::from(self.count.max(1) - 1);
        if gap > 0.0 { gap.min(self.apart()) } else { self.apart() }
    }

    /// Returns the rank of petal `k` in the order in which they stand on the axis, outermost first.
    pub(crate) fn rank(&self, k: u32) -> u32 {
        let n = self.count.max(1);
        // Two fifths of a turn and similar fractions: the step nearest to the golden one that reaches every petal.
        let golden = (f64::from(n) * 0.382).round();
        let step = (1..n)
            .filter(|&s| coprime(s, n))
            .min_by(|&a, &b| (f64::from(a) - golden).abs().total_cmp(&(f64::from(b) - golden).abs()));
        let step = step.unwrap_or(1);
        (0..n).find(|r| (r * step) % n == k % n).unwrap_or(0)
    }

    /// Returns the half width at `v` as a share of the greatest.
    pub(crate) fn outline(&self, v: f64) -> f64 {
        if let Some(form) = &self.form {
            return form.half_width(v).max(0.02);
        }
        let w = self.widest.clamp(0.2, 0.9).max(self.claw_length + 0.1);
        if v < w {
            let t = ((v - self.claw_length) / (w - self.claw_length)).max(0.0);
            ops::lerp(self.claw, 1.0, t * t * (3.0 - 2.0 * t))
        } else {
            let t = ((v - w) / (1.0 - w).max(1e-6)).min(1.0);
            let round = (1.0 - t * t).max(0.0).sqrt();
            let tip = ops::lerp(round, 1.0 - t * t * (1.0 - 0.3 * (1.0 - t)), self.point).max(0.0);
            // A notched tip is blunt: its middle is drawn back instead.
            if self.notch > 0.0 { tip.max(0.62 - 0.25 * t) } else { tip * (1.0 - 0.02) + 0.02 }
        }
    }

    /// Returns the position along the petal of column `u` in row `v`: a notch draws the middle back, and rounds its
    /// lobes.
    pub(crate) fn place(&self, u: f64, v: f64) -> f64 {
        if self.notch <= 0.0 {
            return v;
        }
        let near = v * v * v;
        let middle = (1.0 - u.abs() / 0.45).max(0.0);
        let lobe = ((u.abs() - 0.45) / 0.55).max(0.0);
        v - near * (self.notch * middle * middle.sqrt() + 0.16 * lobe * lobe)
    }
}

const fn coprime(mut a: u32, mut b: u32) -> bool {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a == 1
}

/// Half widths of a petal at even places from base to tip, as shares of the greatest.
///
/// ```
/// use glam::DVec2;
/// let rhombus = [DVec2::ZERO, DVec2::new(0.3, 0.5), DVec2::Y, DVec2::new(-0.3, 0.5)];
/// let (form, aspect) = bloom::PetalForm::from_outline(&rhombus).unwrap();
/// assert!((aspect - 0.6).abs() < 1e-9 && (form.half_width(0.25) - 0.5).abs() < 0.03);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PetalForm(pub [f64; 17]);

impl PetalForm {
    /// Makes a form from an outline with its root at the origin and its tip on +y; also returns its width as a share of
    /// its length. `None` for an outline without area.
    pub fn from_outline(outline: &[DVec2]) -> Option<(Self, f64)> {
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
        // Slightly inside the ends, where an outline is a single point.
        let widths: [f64; 17] = core::array::from_fn(|k| width(tip * (0.004 + 0.992 * k as f64 / 16.0)));
        let widest = widths.iter().copied().fold(0.0, f64::max);
        let aspect = widest / tip;
        (aspect.is_finite() && aspect > 0.01).then(|| (Self(widths.map(|w| w / widest)), aspect))
    }

    /// Returns the mean of several forms.
    pub fn mean(forms: &[Self]) -> Option<Self> {
        let n = forms.len() as f64;
        (n > 0.0).then(|| Self(core::array::from_fn(|k| forms.iter().map(|f| f.0[k]).sum::<f64>() / n)))
    }

    /// Returns half the width at `v`, 0 at the base to 1 at the tip, as a share of the greatest.
    pub fn half_width(&self, v: f64) -> f64 {
        let at = v.clamp(0.0, 1.0) * 16.0;
        let low = at.floor().min(15.0);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 15")]
        let k = low as usize;
        ops::lerp(self.0[k], self.0[k + 1], at - low)
    }
}
