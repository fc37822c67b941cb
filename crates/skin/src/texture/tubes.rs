//! Bark, stems and roots: repeat in both directions; v runs along the axis.

use super::noise::{cells, gradient, octaves};
use super::{Paint, mix, shade};
use base::ops;

/// Grey-brown bark with long fissures between plates.
pub(super) fn bark(u: f64, v: f64) -> Paint {
    const CREVICE: Paint = [0.17, 0.125, 0.09];
    const BROWN: Paint = [0.40, 0.315, 0.235];
    const GREY: Paint = [0.56, 0.50, 0.425];
    // Plates three times as long as wide, their borders bent by slow noise.
    let bend = 0.55 * gradient(6.0 * u, 4.0 * v, (6, 4), 11);
    let (near, next) = cells(9.0 * u + bend, 3.0 * v + 0.5 * bend, (9, 3), 3);
    let fissure = ops::smoothstep(0.02, 0.34, next - near);
    let streaks = octaves(24.0 * u, 4.0 * v, (24, 4), 5, 3);
    let grain = octaves(48.0 * u, 24.0 * v, (48, 24), 9, 2);
    let patch = 0.5 + 0.5 * gradient(3.0 * u, 2.0 * v, (3, 2), 21);
    let plate = mix(BROWN, GREY, 0.25 + 0.5 * patch + 0.9 * streaks);
    let plate = shade(plate, 1.0 + 0.30 * grain + 0.12 * streaks - 0.10 * near);
    mix(CREVICE, plate, 0.12 + 0.88 * fissure + 0.25 * streaks)
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
