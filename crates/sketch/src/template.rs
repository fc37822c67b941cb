//! Leaves for drawings in which nobody drew one.
//!
//! `LeafForm -> Blade (length 1)`

use base::ops::{PI, cos, powf, sin};
use glam::DVec2;
use plant::{Blade, Needles, Relief};

/// A botanical form of blade, drawn by formula.
///
/// ```
/// for form in sketch::LeafForm::ALL {
///     let blade = form.blade();
///     assert!((blade.length() - 1.0).abs() < 1e-12, "{form:?} has length 1");
/// }
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum LeafForm {
    /// Broadest below the middle, drawn-out tip: pear, cherry, poplar.
    Ovate,
    /// Broadest in the middle: beech, laurel.
    Elliptic,
    /// Narrow: willow, olive.
    Lanceolate,
    /// Heart-shaped: lime, lilac.
    Cordate,
    /// Round lobes on both sides: oak.
    Lobed,
    /// A short shoot with its needles: fir, spruce, pine.
    Spray,
    /// A long narrow leaflet, broadest near its root: palm, grass.
    Leaflet,
}

impl LeafForm {
    /// Every form.
    pub const ALL: [Self; 7] = [
        Self::Ovate,
        Self::Elliptic,
        Self::Lanceolate,
        Self::Cordate,
        Self::Lobed,
        Self::Spray,
        Self::Leaflet,
    ];

    /// The blade: root at the origin, tip at (0, 1), counter-clockwise, flat, 12 to 34 points.
    pub fn blade(self) -> Blade {
        let right = match self {
            // Needles of 2.6 cm on a shoot of 35, as a spruce's.
            Self::Spray => return Blade::shoot(Needles::of_length(0.075), 3, 1.0),
            // Half widths over length from herbarium-like proportions: 0.27 is a pear leaf, 0.09 a willow's.
            Self::Ovate => beta(0.27, 0.62, 1.25, 9),
            Self::Elliptic => beta(0.23, 0.72, 0.85, 9),
            Self::Lanceolate => beta(0.095, 0.7, 1.0, 8),
            Self::Leaflet => beta(0.055, 0.4, 0.8, 7),
            Self::Cordate => cordate(),
            Self::Lobed => lobed(),
        };
        let relief = match self {
            Self::Leaflet => Relief { bend_b: 0.3, fold: 0.35, ..Relief::default() },
            _ => Relief { bend_a: 0.05, bend_b: 0.12, fold: 0.2, ..Relief::default() },
        };
        Blade::mirrored(&right, relief)
    }
}

/// Right margin with half width `half * v^a (1 - v)^b`, scaled to reach `half`; `n` points, ends left out.
fn beta(half: f64, a: f64, b: f64, n: u32) -> Vec<DVec2> {
    let peak = a / (a + b);
    let top = powf(peak, a) * powf(1.0 - peak, b);
    (1..=n)
        .map(|i| {
            // Denser towards both ends, where the margin turns.
            let v = 0.5 - 0.5 * cos(PI * f64::from(i) / f64::from(n + 1));
            DVec2::new(half * powf(v, a) * powf(1.0 - v, b) / top, v)
        })
        .collect()
}

/// Two round ears below the root, a drawn-out tip.
fn cordate() -> Vec<DVec2> {
    [
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
    ]
    .map(|(x, y)| DVec2::new(x, y))
    .to_vec()
}

/// Four lobes a side on a wedge that widens upwards.
fn lobed() -> Vec<DVec2> {
    (1..=16)
        .map(|i| {
            let v = f64::from(i) / 17.0;
            let hull = 0.31 * powf(v, 0.75) * powf(1.0 - v, 0.45) / 0.53;
            let lobe = 0.74 + 0.26 * sin(2.0 * PI * 4.0 * (v - 0.04) - 0.6);
            DVec2::new((hull * lobe).max(0.012), v)
        })
        .collect()
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
        for form in LeafForm::ALL {
            let blade = form.blade();
            let o = &blade.outline;
            let n = o.len();
            assert!((12..=34).contains(&n), "{form:?}: {n} points");
            let area: f64 = (0..n).map(|i| o[i].perp_dot(o[(i + 1) % n])).sum::<f64>() * 0.5;
            assert!(area > 0.04 && area < 0.6, "{form:?}: area {area}");
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
