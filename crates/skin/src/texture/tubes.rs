//! Bark, stems and roots: repeat in both directions; v runs along the axis.

use super::noise::{cells, gradient, octaves};
use super::{Paint, mix, shade};
use base::ops;

/// Grey-brown bark: ridges along the trunk that part and meet again, dark furrows between.
pub(super) fn bark(u: f64, v: f64) -> Paint {
    const FURROW: Paint = [0.175, 0.135, 0.105];
    const BROWN: Paint = [0.415, 0.335, 0.260];
    const GREY: Paint = [0.585, 0.530, 0.460];
    // Furrows are where slow noise, stretched along the trunk, passes zero; a sway keeps them from being
    // straight.
    let sway = 0.30 * gradient(3.0 * u, 4.0 * v, (3, 4), 11) + 0.10 * gradient(8.0 * u, 9.0 * v, (8, 9), 12);
    let wide =
        gradient(6.0 * u + sway, 2.0 * v, (6, 2), 3) + 0.45 * gradient(12.0 * u + sway, 5.0 * v, (12, 5), 4);
    let fine = gradient(17.0 * u + 1.5 * sway, 5.0 * v, (17, 5), 5)
        + 0.4 * gradient(34.0 * u, 11.0 * v, (34, 11), 6);
    // Short cross breaks cut ridges into plates.
    let breaks = gradient(5.0 * u, 11.0 * v, (5, 11), 7);
    let depth =
        ops::smoothstep(0.0, 0.30, wide.abs()) * (0.62 + 0.38 * ops::smoothstep(0.0, 0.30, fine.abs()));
    let depth = depth * (1.0 - 0.35 * ops::smoothstep(0.45, 0.75, breaks));
    let grain = octaves(40.0 * u, 16.0 * v, (40, 16), 9, 2);
    let patch = gradient(2.0 * u, 2.0 * v, (2, 2), 21);
    let ridge = mix(BROWN, GREY, 0.42 + 0.35 * patch + 0.45 * (wide.abs() - 0.3) + 0.5 * grain);
    let ridge = shade(ridge, 1.0 + 0.22 * grain);
    mix(FURROW, ridge, 0.10 + 0.90 * depth)
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
