//! Bark, stems and roots: repeat in both directions; v runs along the axis.

use super::noise::{cells, gradient, octaves};
use super::{Paint, mix, shade};
use base::ops;

/// Grey-brown bark: ridges along the trunk that part and meet again, dark furrows between.
pub(super) fn bark(u: f64, v: f64) -> Paint {
    const FURROW: Paint = [0.225, 0.175, 0.135];
    const BROWN: Paint = [0.40, 0.325, 0.255];
    const GREY: Paint = [0.57, 0.515, 0.445];
    // Seven wavering furrows run through the tile; neighbours come near one another and part.
    let sway =
        0.60 * gradient(6.0 * u, 3.0 * v, (6, 3), 11) + 0.24 * gradient(15.0 * u, 8.0 * v, (15, 8), 12);
    let first = furrow(7.0 * u + sway, 0.13 + 0.10 * gradient(6.0 * u, 4.0 * v, (6, 4), 13));
    // Others start and end between them.
    let sway =
        0.60 * gradient(7.0 * u, 4.0 * v, (7, 4), 14) + 0.24 * gradient(16.0 * u, 9.0 * v, (16, 9), 15);
    let alive = ops::smoothstep(-0.05, 0.35, gradient(6.0 * u, 3.0 * v, (6, 3), 16));
    let second = alive * furrow(7.0 * u + 0.5 + sway, 0.09);
    let fibre = octaves(34.0 * u + 0.8 * sway, 3.0 * v, (34, 3), 9, 2);
    let grain = octaves(56.0 * u, 26.0 * v, (56, 26), 10, 2);
    let patch = gradient(2.0 * u, 2.0 * v, (2, 2), 21);
    let depth = (1.0 - first) * (1.0 - 0.75 * second);
    let ridge = mix(BROWN, GREY, 0.10 + 0.55 * depth + 0.25 * patch + 0.55 * fibre + 0.25 * grain);
    mix(FURROW, shade(ridge, 1.0 + 0.20 * grain), 0.12 + 0.88 * depth + 0.35 * fibre)
}

/// 1 in the middle of a furrow, which is where `phase` is whole; 0 beyond `width`.
fn furrow(phase: f64, width: f64) -> f64 {
    let off = (phase - phase.round()).abs();
    1.0 - ops::smoothstep(0.15 * width, 1.7 * width.max(0.02), off)
}

/// Smooth bark of a young branch, olive brown with pale breathing pores across it.
pub(super) fn young_bark(u: f64, v: f64) -> Paint {
    const DARK: Paint = [0.30, 0.235, 0.155];
    const LIGHT: Paint = [0.50, 0.415, 0.29];
    const PORE: Paint = [0.64, 0.57, 0.45];
    let streak = octaves(10.0 * u, 2.0 * v, (10, 2), 2, 3);
    let mottle = octaves(4.0 * u, 4.0 * v, (4, 4), 5, 3);
    let (near, _) = cells(7.0 * u, 12.0 * v, (7, 12), 8);
    let pore = 1.0 - ops::smoothstep(0.10, 0.20, near);
    mix(mix(DARK, LIGHT, 0.5 + 0.55 * streak + 0.45 * mottle), PORE, 0.55 * pore)
}

/// Green stem with faint ridges along it.
pub(super) fn stem(u: f64, v: f64) -> Paint {
    const DARK: Paint = [0.285, 0.42, 0.15];
    const LIGHT: Paint = [0.47, 0.60, 0.27];
    let ridge = 0.5 + 0.5 * ops::cos(ops::TAU * (7.0 * u + 0.10 * gradient(4.0 * u, 2.0 * v, (4, 2), 1)));
    let mottle = octaves(8.0 * u, 4.0 * v, (8, 4), 2, 3);
    let fibre = gradient(40.0 * u, 3.0 * v, (40, 3), 3);
    mix(DARK, LIGHT, 0.40 + 0.22 * ridge + 0.5 * mottle + 0.12 * fibre)
}

/// Pale brown root skin with cross wrinkles.
pub(super) fn root(u: f64, v: f64) -> Paint {
    const DARK: Paint = [0.40, 0.30, 0.20];
    const LIGHT: Paint = [0.69, 0.58, 0.44];
    let wrinkle = gradient(5.0 * u, 22.0 * v, (5, 22), 4);
    let mottle = octaves(6.0 * u, 6.0 * v, (6, 6), 6, 3);
    mix(DARK, LIGHT, 0.55 + 0.35 * wrinkle + 0.5 * mottle)
}
