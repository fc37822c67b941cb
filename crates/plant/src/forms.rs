//! Shapes of leaf blades by formula.
//!
//! `BladeForm -> Blade (length 1)`

use base::ops::{self, PI};
use glam::DVec2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{Blade, Needles, Relief};

/// The shape of a leaf blade, defined by a formula.
///
/// ```
/// for form in plant::BladeForm::ALL {
///     let blade = form.blade();
///     assert!((blade.length() - 1.0).abs() < 1e-12, "{form:?} has length 1");
/// }
/// ```
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "kebab-case")]
pub enum BladeForm {
    /// Broadest below the middle, drawn-out tip: pear, birch, poplar.
    #[default]
    Ovate,
    /// Broadest in the middle: beech.
    Elliptic,
    /// Broadest above the middle: Terminalia, magnolia.
    Obovate,
    /// Narrow: willow, olive, bamboo.
    Lanceolate,
    /// Heart-shaped: lime.
    Cordate,
    /// Nearly a triangle on a broad base: poplar, birch.
    Deltoid,
    /// Round lobes on both sides: oak.
    Lobed,
    /// Five pointed lobes from one place: maple, plane.
    Palmate,
    /// Five blunt lobes from one place, deep notches between them: fig.
    Fingered,
    /// Three pointed lobes, broad and toothed: Boston ivy, grape.
    Tricuspid,
    /// A fan on a wedge, with a notch in the middle: ginkgo.
    Fan,
    /// Leaflets in pairs along a midrib: ash, walnut, rowan.
    Pinnate,
    /// A feather of many narrow leaflets, or one feather of a larger leaf: acacia, fern.
    Feather,
    /// A long narrow leaflet: palm, grass.
    Leaflet,
    /// One needle.
    Needle,
    /// A bundle of needles that spread from one place: pine, larch.
    Tuft,
    /// A shoot with side shoots, all in needles or scales: fir, spruce, yew, cypress.
    Spray,
    /// The end of a shoot in long needles, a third of its length, that lean forward: pine.
    Brush,
}

impl BladeForm {
    /// Every form.
    pub const ALL: [Self; 18] = [
        Self::Ovate,
        Self::Elliptic,
        Self::Obovate,
        Self::Lanceolate,
        Self::Cordate,
        Self::Deltoid,
        Self::Lobed,
        Self::Palmate,
        Self::Fingered,
        Self::Tricuspid,
        Self::Fan,
        Self::Pinnate,
        Self::Feather,
        Self::Leaflet,
        Self::Needle,
        Self::Tuft,
        Self::Spray,
        Self::Brush,
    ];

    /// Returns the blade: root at the origin, tip at (0, 1), counter-clockwise, flat. A spray is made by
    /// [`Blade::shoot`] with needles of length 0.075 and three side shoots on each side, as in spruce.
    pub fn blade(self) -> Blade {
        let soft = Relief { bend_a: 0.05, bend_b: 0.12, fold: 0.2, ..Relief::default() };
        let stiff = |bend_b, fold| Relief { bend_b, fold, ..Relief::default() };
        let (right, relief) = match self {
            // Half widths over length from herbarium-like proportions: 0.27 is a pear leaf, 0.09 a willow's.
            Self::Ovate => (beta(0.27, 0.62, 1.25, 9), soft),
            Self::Elliptic => (beta(0.23, 0.72, 0.85, 9), soft),
            Self::Obovate => (obovate(), soft),
            Self::Lanceolate => (beta(0.095, 0.7, 1.0, 8), soft),
            Self::Leaflet => (beta(0.055, 0.4, 0.8, 7), stiff(0.3, 0.35)),
            Self::Cordate => (cordate(), soft),
            Self::Deltoid => (deltoid(), soft),
            Self::Lobed => (lobed(), soft),
            Self::Palmate => (palmate(), Relief { fold: 0.12, ..soft }),
            Self::Fingered => (fingered(), Relief { fold: 0.1, ..soft }),
            Self::Tricuspid => (tricuspid(), Relief { fold: 0.12, ..soft }),
            Self::Fan => (fan(), Relief { fold: 0.15, ..soft }),
            Self::Pinnate => (pinnate(), stiff(0.25, 0.25)),
            Self::Feather => (feather(), stiff(0.15, 0.2)),
            Self::Needle => (needle(), stiff(0.0, 0.3)),
            Self::Tuft => (tuft(), stiff(0.05, 0.35)),
            Self::Brush => (brush(), stiff(-0.06, 0.5)),
            Self::Spray => return Blade::shoot(Needles::with_length(0.075), 3, 1.0),
        };
        Blade::mirrored(&right, relief)
    }
}

/// Returns a right margin with half width `half * v^a (1 - v)^b`, scaled to reach `half`; `n` points, ends left out.
fn beta(half: f64, a: f64, b: f64, n: u32) -> Vec<DVec2> {
    let peak = a / (a + b);
    let top = ops::powf(peak, a) * ops::powf(1.0 - peak, b);
    (1..=n)
        .map(|i| {
            // Denser towards both ends, where the margin turns.
            let v = 0.5 - 0.5 * ops::cos(PI * f64::from(i) / f64::from(n + 1));
            DVec2::new(half * ops::powf(v, a) * ops::powf(1.0 - v, b) / top, v)
        })
        .collect()
}

/// Returns a right margin that is broadest at two thirds.
fn obovate() -> Vec<DVec2> {
    let at = |i: u32| {
        let v = f64::from(i) / 9.0;
        DVec2::new(0.3 * ops::powf(v, 1.1) * ops::powf(1.0 - v, 0.55) / 0.362, v)
    };
    (1..=8).map(at).collect()
}

/// Makes a right margin from its points.
fn margin(points: &[(f64, f64)]) -> Vec<DVec2> {
    points.iter().map(|&(x, y)| DVec2::new(x, y)).collect()
}

/// Returns a right margin with a round ear below the root and a drawn-out tip.
fn cordate() -> Vec<DVec2> {
    margin(&[
        (0.09, -0.065),
        (0.2, -0.075),
        (0.31, -0.015),
        (0.375, 0.1),
        (0.385, 0.23),
        (0.345, 0.38),
        (0.27, 0.53),
        (0.18, 0.67),
        (0.095, 0.8),
        (0.035, 0.91),
    ])
}

/// Returns the right margin of a triangle with round corners.
fn deltoid() -> Vec<DVec2> {
    margin(&[
        (0.16, -0.01),
        (0.3, 0.05),
        (0.385, 0.16),
        (0.36, 0.28),
        (0.28, 0.44),
        (0.18, 0.62),
        (0.08, 0.82),
    ])
}

/// Returns a right margin of four round lobes between narrow notches, the third the largest, on a wedge that widens
/// upwards from small ears (Quercus robur).
fn lobed() -> Vec<DVec2> {
    const LOBES: f64 = 4.0;
    const STEPS: u32 = 56;
    (1..STEPS)
        .map(|i| {
            let v = f64::from(i) / f64::from(STEPS);
            let hull = 0.33 * ops::powf(v, 0.8) * ops::powf(1.0 - v, 0.42) / 0.53;
            let phase = LOBES * ops::powf((v - 0.03).max(0.0), 0.92) - 0.08;
            let notch = ops::powf(0.5 + 0.5 * ops::cos(2.0 * PI * phase), 2.2);
            // Shallow towards the tip, which is one blunt lobe.
            let deep = 0.46 * (1.0 - ops::smoothstep(0.72, 0.95, v));
            let ear = 0.045 * ops::powf((1.0 - (v - 0.035).abs() / 0.035).max(0.0), 0.5);
            let wide = (hull * (1.0 - deep * notch) + ear).max(0.012);
            // Lobes point forward.
            DVec2::new(wide, v + 0.10 * hull * (1.0 - notch) * (1.0 - v))
        })
        .collect()
}

/// Returns the right half of five lobes around the end of the stalk, each drawn out to a point with a tooth or two next
/// to it (Acer platanoides): two on each side, the middle one is the tip.
fn palmate() -> Vec<DVec2> {
    margin(&[
        (0.1, -0.06),
        (0.22, -0.11),
        (0.36, -0.13),
        (0.35, -0.06),
        (0.45, -0.02),
        (0.38, 0.04),
        (0.33, 0.1),
        (0.45, 0.13),
        (0.58, 0.16),
        (0.56, 0.23),
        (0.67, 0.35),
        (0.56, 0.36),
        (0.55, 0.46),
        (0.43, 0.4),
        (0.3, 0.37),
        (0.18, 0.39),
        (0.2, 0.52),
        (0.24, 0.64),
        (0.34, 0.74),
        (0.23, 0.74),
        (0.18, 0.78),
        (0.18, 0.87),
        (0.09, 0.87),
    ])
}

/// Returns the right half of five blunt lobes on a heart-shaped foot, widest near their ends (Ficus carica).
fn fingered() -> Vec<DVec2> {
    margin(&[
        (0.1, -0.06),
        (0.24, -0.1),
        (0.36, -0.07),
        (0.42, 0.02),
        (0.38, 0.09),
        (0.27, 0.13),
        (0.38, 0.2),
        (0.5, 0.33),
        (0.54, 0.46),
        (0.48, 0.54),
        (0.37, 0.52),
        (0.24, 0.42),
        (0.14, 0.36),
        (0.19, 0.5),
        (0.25, 0.64),
        (0.26, 0.78),
        (0.2, 0.9),
        (0.1, 0.975),
    ])
}

/// Returns the right half of three pointed lobes with coarse teeth on a heart-shaped foot (Parthenocissus
/// tricuspidata).
#[expect(clippy::approx_constant, reason = "a place on a margin")]
fn tricuspid() -> Vec<DVec2> {
    margin(&[
        (0.086, -0.08),
        (0.206, -0.12),
        (0.31, -0.08),
        (0.378, 0.02),
        (0.404, 0.1),
        (0.447, 0.19),
        (0.473, 0.29),
        (0.516, 0.4),
        (0.542, 0.55),
        (0.43, 0.5),
        (0.396, 0.51),
        (0.318, 0.47),
        (0.241, 0.46),
        (0.241, 0.59),
        (0.206, 0.66),
        (0.189, 0.75),
        (0.12, 0.82),
        (0.086, 0.9),
    ])
}

/// Returns a right margin of five leaflets.
fn pinnate() -> Vec<DVec2> {
    let mut right = Vec::with_capacity(25);
    for i in 0..5 {
        let v = 0.1 + 0.165 * f64::from(i);
        let reach = 0.3 - 0.03 * f64::from(i);
        right.extend([
            DVec2::new(0.008, v),
            DVec2::new(0.55 * reach, v + 0.1 * reach),
            DVec2::new(reach, v + 0.55 * reach),
            DVec2::new(0.5 * reach, v + 0.55 * reach),
            DVec2::new(0.008, v + 0.07),
        ]);
    }
    right.extend([DVec2::new(0.06, 0.9), DVec2::new(0.05, 0.96)]);
    right
}

/// Returns a right margin of eight leaflets, the longest below the middle, each half as wide as its place on the midrib
/// is long.
fn feather() -> Vec<DVec2> {
    const LEAFLETS: u32 = 8;
    let mut right = Vec::with_capacity(26);
    for i in 0..LEAFLETS {
        let place = 0.88 / f64::from(LEAFLETS);
        let v = 0.04 + place * f64::from(i);
        let u = (f64::from(i) + 0.5) / f64::from(LEAFLETS);
        let reach = 0.24 * ops::powf(u, 0.35) * ops::powf(1.0 - u, 0.45) / 0.52;
        right.extend([
            DVec2::new(0.01, v),
            DVec2::new(0.9 * reach, v + 0.34 * reach),
            DVec2::new(reach, v + 0.34 * reach + 0.32 * place),
            DVec2::new(0.01, v + 0.58 * place),
        ]);
    }
    right.push(DVec2::new(0.03, 0.95));
    right
}

/// Returns a right margin with a straight side and half of a wavy edge that is notched in the middle (Ginkgo biloba).
fn fan() -> Vec<DVec2> {
    margin(&[
        (0.045, 0.1),
        (0.19, 0.3),
        (0.36, 0.52),
        (0.52, 0.74),
        (0.55, 0.82),
        (0.48, 0.92),
        (0.42, 0.96),
        (0.34, 1.05),
        (0.26, 1.08),
        (0.15, 1.14),
        (0.07, 1.12),
        (0.022, 1.07),
    ])
}

/// Returns three needles of the right side and half of the one in the middle, which is the tip.
fn tuft() -> Vec<DVec2> {
    let mut right = Vec::with_capacity(6);
    for (degrees, reach) in [(62.0, 0.86), (40.0, 0.94), (19.0, 0.98)] {
        let (s, c) = ops::sin_cos(degrees * (PI / 180.0));
        right.push(DVec2::new(reach * s, reach * c));
        let (s, c) = ops::sin_cos((degrees - 10.5) * (PI / 180.0));
        right.push(DVec2::new(0.12 * s, 0.12 * c));
    }
    right
}

/// Returns five needles of the right side, each from its place on the shoot, and half of the one at the end, which is
/// the tip.
fn brush() -> Vec<DVec2> {
    let mut right = Vec::with_capacity(11);
    for i in 0..5 {
        let v = 0.06 + 0.125 * f64::from(i);
        let (s, c) = ops::sin_cos((58.0 - 7.0 * f64::from(i)) * (PI / 180.0));
        right.push(DVec2::new(0.014, v));
        right.push(DVec2::new(0.014 + BRUSH_NEEDLE * s, v + 0.03 + BRUSH_NEEDLE * c));
    }
    right.push(DVec2::new(0.014, 0.7));
    right
}

/// Length of a needle relative to that of the brush.
const BRUSH_NEEDLE: f64 = 0.34;

/// Returns a thin right margin with a point.
fn needle() -> Vec<DVec2> {
    vec![DVec2::new(0.02, 0.1), DVec2::new(0.024, 0.5), DVec2::new(0.015, 0.85)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn crosses(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> bool {
        let side = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p);
        side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
    }

    #[test]
    fn every_form_is_a_simple_counter_clockwise_leaf() {
        for form in BladeForm::ALL {
            let blade = form.blade();
            let o = &blade.outline;
            let n = o.len();
            assert!((8..=150).contains(&n), "{form:?}: {n} points");
            let area: f64 = (0..n).map(|i| o[i].perp_dot(o[(i + 1) % n])).sum::<f64>() * 0.5;
            assert!(area > 0.01 && area < 0.7, "{form:?}: area {area}");
            for i in 0..n {
                for j in i + 1..n {
                    assert!(
                        !crosses(o[i], o[(i + 1) % n], o[j], o[(j + 1) % n]),
                        "{form:?}: edges {i} and {j} cross"
                    );
                }
            }
            assert_eq!((o[0], blade.midrib[0]), (DVec2::ZERO, DVec2::ZERO));
            assert!(o.contains(&DVec2::Y), "{form:?} has its tip");
        }
    }
}
