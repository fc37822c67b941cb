//! Discs, fruits, cactus bodies, stamens, thorns.

use super::noise::{gradient, octaves};
use super::{Paint, byte, canvas, line, mix, shade};
use base::{Executor, ops};
use mesh::Texture;

/// The colours of a flower's disc.
pub(super) struct DiscInks {
    young: Paint,
    open: Paint,
    rim: Paint,
    gap: Paint,
}

pub(super) const YELLOW_DISC: DiscInks = DiscInks {
    young: [0.56, 0.55, 0.14],
    open: [0.93, 0.68, 0.12],
    rim: [0.80, 0.47, 0.08],
    gap: [0.36, 0.20, 0.05],
};
pub(super) const PALE_DISC: DiscInks = DiscInks {
    young: [0.88, 0.90, 0.80],
    open: [1.0, 1.0, 0.97],
    rim: [0.90, 0.88, 0.86],
    gap: [0.50, 0.47, 0.45],
};

// The green of the receptacle below a disc; it fills the corners outside the round disc.
const RECEPTACLE: Paint = [0.36, 0.49, 0.20];
/// Radius of the disc in its texture: the corners beyond are the receptacle's.
pub(crate) const DISC_RADIUS: f64 = 0.47;
/// A place in the texture that shows the receptacle.
pub(crate) const RECEPTACLE_AT: (f64, f64) = (0.035, 0.035);
/// Number of florets of a disc, by Vogel's rule (radius c sqrt(n), angle n x 137.508 degrees).
const FLORETS: u32 = 233;

/// Returns the position of floret `n`: polar radius (0 to 1) and angle.
fn floret(n: u32) -> (f64, f64) {
    const GOLDEN: f64 = 2.399_963_229_728_653;
    (((f64::from(n) + 0.5) / f64::from(FLORETS)).sqrt(), f64::from(n) * GOLDEN)
}

/// Paints florets in spirals, opening from the rim inwards.
pub(super) fn disc(executor: &dyn Executor, size: u32, inks: &DiscInks) -> Texture {
    let ground = canvas(executor, size, size, &|u, v| {
        let r = ops::hypot(u - 0.5, v - 0.5) / DISC_RADIUS;
        if r < 1.03 { shade(inks.gap, 0.9 + 0.2 * gradient(9.0 * u, 9.0 * v, (9, 9), 2)) } else { RECEPTACLE }
    });
    let mut texture = ground;
    let pixels = f64::from(size);
    // Half the distance between neighbours in a Vogel lattice, slightly overlapping.
    let radius = 1.05 * DISC_RADIUS / f64::from(FLORETS).sqrt();
    for n in 0..FLORETS {
        let (r, angle) = floret(n);
        let (sin, cos) = ops::sin_cos(angle);
        let (cx, cy) = (0.5 + DISC_RADIUS * 0.97 * r * cos, 0.5 + DISC_RADIUS * 0.97 * r * sin);
        let body = mix(inks.young, inks.open, ops::smoothstep(0.15, 0.55, r));
        let body = mix(body, inks.rim, ops::smoothstep(0.75, 1.0, r));
        let reach = (radius * pixels).ceil() + 1.0;
        let low = |c: f64| ops::whole((c * pixels - reach).max(0.0));
        let high = |c: f64| ops::whole((c * pixels + reach).min(pixels - 1.0));
        for j in low(cy)..=high(cy) {
            for i in low(cx)..=high(cx) {
                let (u, v) = ((f64::from(i) + 0.5) / pixels, (f64::from(j) + 0.5) / pixels);
                let d = ops::hypot(u - cx, v - cy) / radius;
                if d >= 1.0 {
                    continue;
                }
                // A bud is a ball with a dimple.
                let tone = 1.12 - 0.38 * d * d - 0.22 * line(d, 0.35);
                let paint = mix(inks.gap, shade(body, tone), 1.0 - ops::smoothstep(0.72, 1.0, d));
                let at = 4 * (j * size + i) as usize;
                for (k, x) in paint.into_iter().enumerate() {
                    texture.pixels[at + k] = byte(x);
                }
            }
        }
    }
    texture
}

/// The colours of a fruit: sunny side, shadow side, dots.
pub(super) struct FruitInks {
    sun: Paint,
    shadow: Paint,
    dot: Paint,
}

pub(super) const RED_FRUIT: FruitInks =
    FruitInks { sun: [0.78, 0.12, 0.08], shadow: [0.80, 0.62, 0.20], dot: [0.92, 0.80, 0.52] };
pub(super) const PALE_FRUIT: FruitInks =
    FruitInks { sun: [0.93, 0.93, 0.93], shadow: [1.0, 1.0, 0.96], dot: [1.0, 1.0, 1.0] };

/// Paints fruit skin: u around, v from the upper pole (0) to the lower one (1).
pub(super) fn fruit(inks: &FruitInks, u: f64, v: f64) -> Paint {
    let patch = octaves(3.0 * u, 2.0 * v, (3, 2), 1, 3);
    let streak = gradient(26.0 * u, 2.0 * v, (26, 2), 2);
    // Paler in the shade below and around the stalk.
    let from = v + 0.25 * patch;
    let ends = 0.30 * ops::smoothstep(0.55, 1.1, from) + 0.25 * (1.0 - ops::smoothstep(0.0, 0.3, from));
    let skin = mix(inks.sun, inks.shadow, 0.14 + 0.6 * patch + 0.22 * streak + ends);
    let (near, _) = super::noise::cells(14.0 * u, 10.0 * v, (14, 10), 4);
    mix(skin, inks.dot, 0.5 * line(near, 0.10))
}

/// Paints skin of a fruit with eyes in spirals in both directions, as in pineapple: u around, v from its tip (0) to its
/// tuft (1), where it is greener.
pub(super) fn eyes(u: f64, v: f64) -> Paint {
    const GOLD: Paint = [0.83, 0.56, 0.16];
    const GREEN: Paint = [0.48, 0.48, 0.18];
    const GROOVE: Paint = [0.36, 0.25, 0.10];
    const SPINE: Paint = [0.30, 0.20, 0.10];
    // Equal numbers of spirals in both directions, so that eyes are diamonds: slightly wider than high on a body half
    // again as long as wide.
    const AROUND: f64 = 11.0;
    const ALONG: f64 = 6.0;
    let (left, right) = (AROUND * u + ALONG * v, AROUND * u - ALONG * v);
    // Distance from the centre of the eye, 0 to 1 at its edge, along both spirals.
    let [a, b] = [left, right].map(|x| 2.0 * (x - x.floor()) - 1.0);
    let patch = octaves(6.0 * u, 4.0 * v, (6, 4), 9, 3);
    let skin = mix(GOLD, GREEN, ops::smoothstep(0.35, 1.1, v + 0.35 * patch));
    let edge = a.abs().max(b.abs());
    let eye = shade(skin, 1.12 - 0.35 * edge * edge);
    let eye = mix(eye, GROOVE, 0.85 * ops::smoothstep(0.78, 0.97, edge));
    mix(eye, SPINE, 0.8 * line(ops::hypot(a, b), 0.28))
}

/// Paints the green body of a cactus: ribs with pale areoles, u around.
pub(super) fn ribbed(u: f64, v: f64) -> Paint {
    const GROOVE: Paint = [0.15, 0.30, 0.15];
    const CREST: Paint = [0.38, 0.55, 0.30];
    const WOOL: Paint = [0.86, 0.83, 0.70];
    let rib = 0.5 + 0.5 * ops::cos(ops::TAU * 16.0 * u);
    let mottle = octaves(8.0 * u, 6.0 * v, (8, 6), 3, 3);
    let skin = mix(GROOVE, CREST, 0.15 + 0.75 * rib + 0.5 * mottle);
    let (across, along) = (16.0 * u - (16.0 * u).round(), 10.0 * v - (10.0 * v).round());
    mix(skin, WOOL, 0.9 * line(ops::hypot(across, along), 0.20))
}

/// Paints pale fired clay: grains, and faint rings of the wheel around it.
pub(super) fn clay(u: f64, v: f64) -> Paint {
    let patch = octaves(4.0 * u, 3.0 * v, (4, 3), 6, 4);
    let grain = gradient(48.0 * u, 48.0 * v, (48, 48), 7);
    let ring = gradient(2.0 * u, 40.0 * v, (2, 40), 8);
    let light = 0.9 + 0.1 * patch + 0.06 * grain + 0.04 * ring;
    [light; 3].map(|x| x.clamp(0.6, 1.0))
}

/// Paints in the upper half (v below one half) the anther's pollen, in the lower half the filament, pale at its foot.
pub(super) fn stamen(u: f64, v: f64) -> Paint {
    const POLLEN: Paint = [0.93, 0.70, 0.16];
    const GRAIN: Paint = [0.72, 0.42, 0.08];
    const TOP: Paint = [0.93, 0.90, 0.66];
    const FOOT: Paint = [0.78, 0.85, 0.56];
    if v < 0.5 {
        let (near, _) = super::noise::cells(8.0 * u, 16.0 * v, (8, 16), 5);
        mix(POLLEN, GRAIN, ops::smoothstep(0.25, 0.7, near))
    } else {
        mix(TOP, FOOT, 2.0 * v - 1.0)
    }
}

/// Paints a thorn: pale at the foot (v = 0), red-brown at the point.
pub(super) fn thorn(u: f64, v: f64) -> Paint {
    const FOOT: Paint = [0.72, 0.64, 0.44];
    const POINT: Paint = [0.38, 0.20, 0.12];
    let fibre = gradient(6.0 * u, 2.0 * v, (6, 2), 6);
    mix(FOOT, POINT, v + 0.15 * fibre)
}
