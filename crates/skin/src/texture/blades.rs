//! Leaves and petals: u across with the midrib at one half, v from the tip (0) down to the root (1).

use super::noise::{gradient, octaves, random};
use super::{Paint, line, mix, shade};
use crate::PetalColor;
use base::ops;

/// The colours of a leaf.
pub(crate) struct LeafInks {
    pub(super) dark: Paint,
    pub(super) light: Paint,
    pub(super) vein: Paint,
}

pub(crate) const GREEN: LeafInks =
    LeafInks { dark: [0.190, 0.365, 0.105], light: [0.385, 0.565, 0.185], vein: [0.64, 0.73, 0.40] };
pub(crate) const PALE_GREEN: LeafInks =
    LeafInks { dark: [0.80, 0.82, 0.80], light: [0.98, 0.99, 0.97], vein: [1.0, 1.0, 1.0] };

// Side veins on each side of the midrib.
const SIDE_VEINS: f64 = 9.0;

/// Paints a mottled leaf with midrib and pinnate side veins that arch towards the tip.
pub(super) fn leaf(inks: &LeafInks, u: f64, v: f64) -> Paint {
    let (x, y) = (2.0 * u - 1.0, 1.0 - v);
    let across = x.abs();
    // Start on the midrib of the side vein through this point. Right and left are offset by half a step.
    let wobble = 0.012 * gradient(5.0 * u, 7.0 * v, (5, 7), 1);
    let start = y - 0.26 * across - 0.13 * across * across + wobble;
    let phase = start * SIDE_VEINS + if x > 0.0 { 0.5 } else { 0.0 };
    let nearest = phase.round();
    #[expect(clippy::cast_possible_truncation, reason = "a small count")]
    let jitter = 0.22 * (random(nearest as i32, if x > 0.0 { 8 } else { 9 }) - 0.5);
    let off = (phase - nearest - jitter).abs();
    let alive = ops::smoothstep(-0.06, 0.02, start) * (1.0 - ops::smoothstep(0.90, 0.97, start));
    let fade = 1.0 - 0.65 * across;
    let side = alive * fade * line(off, 0.085 * (1.15 - 0.7 * across));
    let midrib = line(x, 0.060 * (1.08 - 0.85 * y));
    // The finest net, hardly visible.
    let net = 1.0 - ops::smoothstep(0.0, 0.14, gradient(22.0 * u, 34.0 * v, (22, 34), 2).abs());
    // The lamina swells between veins: lighter in the middle, dark along them.
    let swell = 0.5 - 0.5 * ops::cos(ops::TAU * off.min(0.5));
    let mottle = octaves(5.0 * u, 8.0 * v, (5, 8), 7, 3);
    let lamina = mix(inks.dark, inks.light, 0.34 + 0.26 * swell * alive + 0.75 * mottle + 0.10 * y);
    let lamina = mix(lamina, inks.vein, 0.07 * net);
    let shadow = 1.0 - 0.16 * line(x, 0.16) * (1.0 - midrib);
    mix(shade(lamina, shadow), inks.vein, (0.95 * midrib).max(0.62 * side))
}

/// The colours of a petal from root to tip, and of its veins.
pub(crate) struct PetalInks {
    root: Paint,
    middle: Paint,
    tip: Paint,
    vein: Paint,
}

pub(crate) const PALE_PETAL: PetalInks = PetalInks {
    root: [1.0, 1.0, 0.96],
    middle: [0.97, 0.97, 0.97],
    tip: [0.90, 0.90, 0.90],
    vein: [0.76, 0.76, 0.76],
};

/// Returns the palette of a petal colour.
pub(crate) const fn inks(color: PetalColor) -> PetalInks {
    let (root, middle, tip, vein) = match color {
        PetalColor::Pink => ([0.97, 0.90, 0.84], [0.95, 0.70, 0.75], [0.90, 0.45, 0.58], [0.78, 0.28, 0.46]),
        PetalColor::White => ([0.86, 0.90, 0.66], [0.97, 0.97, 0.93], [0.98, 0.97, 0.95], [0.86, 0.87, 0.80]),
        PetalColor::Yellow => {
            ([0.93, 0.66, 0.10], [0.98, 0.82, 0.16], [0.99, 0.88, 0.26], [0.88, 0.60, 0.06])
        }
        PetalColor::Violet => {
            ([0.92, 0.88, 0.95], [0.60, 0.45, 0.80], [0.42, 0.28, 0.68], [0.29, 0.15, 0.50])
        }
        PetalColor::Red => ([0.30, 0.04, 0.06], [0.80, 0.10, 0.08], [0.90, 0.18, 0.10], [0.55, 0.03, 0.05]),
        PetalColor::Orange => {
            ([0.98, 0.80, 0.24], [0.97, 0.58, 0.13], [0.93, 0.42, 0.08], [0.78, 0.28, 0.04])
        }
        PetalColor::Blue => ([0.95, 0.96, 0.98], [0.52, 0.64, 0.90], [0.33, 0.46, 0.82], [0.22, 0.32, 0.66]),
        PetalColor::Magenta => {
            ([0.96, 0.84, 0.88], [0.83, 0.28, 0.56], [0.72, 0.12, 0.44], [0.50, 0.05, 0.30])
        }
    };
    PetalInks { root, middle, tip, vein }
}

impl PetalInks {
    /// Returns all of them.
    pub(super) const fn each(&self) -> [Paint; 4] {
        [self.root, self.middle, self.tip, self.vein]
    }
}

/// Paints a petal whose colour deepens towards the tip, with fine veins that fan out from its root; also returns the
/// strength of a vein, 0 to 1.
pub(super) fn petal(inks: &PetalInks, u: f64, v: f64) -> (Paint, f64) {
    let (x, y) = (2.0 * u - 1.0, 1.0 - v);
    let mottle = octaves(4.0 * u, 6.0 * v, (4, 6), 3, 3);
    let along = y + 0.10 * mottle;
    let body = mix(inks.root, inks.middle, ops::smoothstep(0.02, 0.42, along));
    let body = mix(body, inks.tip, ops::smoothstep(0.35, 1.0, along));
    // Veins are lines of equal fan; they waver and fork slightly further out.
    let fan = x / (0.30 + 0.85 * y) + 0.018 * gradient(6.0 * u, 5.0 * v, (6, 5), 4);
    let vein = |n: f64, width: f64| {
        let phase = fan * n;
        line(phase - phase.round(), width)
    };
    // At most the resolution of the texture: four pixels per line at its finest.
    let coarse = vein(5.0, 0.22) * ops::smoothstep(0.03, 0.15, y) * (1.0 - ops::smoothstep(0.55, 0.98, y));
    let fine = vein(13.0, 0.42) * ops::smoothstep(0.25, 0.6, y) * (1.0 - ops::smoothstep(0.75, 1.0, y));
    let veined = mix(body, inks.vein, 0.34 * coarse + 0.14 * fine);
    // The petal is thicker, and so deeper in colour, along the middle of the lower half.
    let keel = line(x, 0.35) * (1.0 - y);
    (shade(mix(veined, inks.vein, 0.10 * keel), 1.0 + 0.05 * mottle), coarse.max(0.5 * fine))
}
