//! Stems and roots: repeat in both directions; v runs along the axis.

use super::noise::{gradient, octaves};
use super::{Paint, mix};
use base::ops;

/// Paints a green stem with faint ridges along it.
pub(super) fn stem(u: f64, v: f64) -> Paint {
    const DARK: Paint = [0.285, 0.42, 0.15];
    const LIGHT: Paint = [0.47, 0.60, 0.27];
    let ridge = 0.5 + 0.5 * ops::cos(ops::TAU * (7.0 * u + 0.10 * gradient(4.0 * u, 2.0 * v, (4, 2), 1)));
    let mottle = octaves(8.0 * u, 4.0 * v, (8, 4), 2, 3);
    let fibre = gradient(40.0 * u, 3.0 * v, (40, 3), 3);
    mix(DARK, LIGHT, 0.40 + 0.22 * ridge + 0.5 * mottle + 0.12 * fibre)
}

/// Paints pale brown root skin with cross wrinkles.
pub(super) fn root(u: f64, v: f64) -> Paint {
    const DARK: Paint = [0.40, 0.30, 0.20];
    const LIGHT: Paint = [0.69, 0.58, 0.44];
    let wrinkle = gradient(5.0 * u, 22.0 * v, (5, 22), 4);
    let mottle = octaves(6.0 * u, 6.0 * v, (6, 6), 6, 3);
    mix(DARK, LIGHT, 0.55 + 0.35 * wrinkle + 0.5 * mottle)
}
