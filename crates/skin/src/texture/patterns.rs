//! Materials that a user chose: v from the tip (0) down to the root (1); u across with the midrib at one half, or, for
//! patterns of the margin, from the margin (0) to the middle (1).

use std::sync::{Arc, Mutex, PoisonError};

use base::{Executor, ops};
use mesh::Texture;

use super::blades::{self, LeafInks};
use super::noise::{cells, gradient, octaves};
use super::{Paint, canvas, mix, shade};
use crate::material::{OrganMaterial, Pattern};

/// Most painted textures that are kept: more than a user sees in a session would waste memory.
const KEPT: usize = 32;

/// Everything on which a painting depends.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Key {
    pattern: Pattern,
    colors: [[u8; 3]; 2],
    amount: f64,
    size: (u32, u32),
}

/// Returns the texture of a material that is not a picture, painted on first use (up to about 30 ms on one thread). The
/// last 32 are kept.
pub(crate) fn painted(material: &OrganMaterial, executor: &dyn Executor) -> Arc<Texture> {
    static PAINTED: Mutex<Vec<(Key, Arc<Texture>)>> = Mutex::new(Vec::new());
    let size = if material.pattern == Pattern::Veined { (256, 512) } else { (128, 256) };
    let OrganMaterial { pattern, color, second, amount, .. } = *material;
    let key = Key { pattern, colors: [color.0, second.0], amount, size };
    let known = |kept: &[(Key, Arc<Texture>)]| kept.iter().find(|(k, _)| *k == key).map(|(_, t)| t.clone());
    if let Some(texture) = known(&PAINTED.lock().unwrap_or_else(PoisonError::into_inner)) {
        return texture;
    }
    // Not under the lock: the executor may paint other plants meanwhile.
    let texture = Arc::new(paint(material, size, executor));
    let mut kept = PAINTED.lock().unwrap_or_else(PoisonError::into_inner);
    if kept.len() >= KEPT {
        kept.remove(0);
    }
    kept.push((key, Arc::clone(&texture)));
    texture
}

/// Paints a material; a picture as if it were plain.
pub(crate) fn paint(
    material: &OrganMaterial,
    (width, height): (u32, u32),
    executor: &dyn Executor,
) -> Texture {
    canvas(executor, width, height, &|u, v| colour_at(material, u, v))
}

/// Paints a petal in this material on a transparent ground, tip up; a picture as if it were plain. For choosing
/// materials.
///
/// `width` and `height` in pixels, each at least 1. Cost: about 100 ns a pixel.
pub fn swatch(material: &OrganMaterial, width: u32, height: u32, executor: &dyn Executor) -> Texture {
    let mut texture = canvas(executor, width.max(1), height.max(1), &|u, v| {
        let (inner, _) = within(u, v);
        colour_at(material, if material.pattern.follows_margin() { inner } else { u }, v)
    });
    let (width, height) = (f64::from(texture.width), f64::from(texture.height));
    for (k, pixel) in (0_u32..).zip(texture.pixels.chunks_exact_mut(4)) {
        let (u, v) = (f64::from(k % texture.width) + 0.5, f64::from(k / texture.width) + 0.5);
        let (_, seen) = within(u / width, v / height);
        pixel[3] = super::byte(0.5 + seen * width);
    }
    texture
}

/// Returns, for a point in the outline of the swatch's petal, the distance from its margin, 0 to 1, and the depth
/// inside as a share of its width.
fn within(u: f64, v: f64) -> (f64, f64) {
    let (x, y) = ((2.0 * u - 1.0).abs(), 1.0 - v);
    // Widest at two thirds, on a narrow claw.
    let half = 0.96 * ops::powf((4.0 * y * y * (1.0 - y) * 1.6875).clamp(0.0, 1.0), 0.5) + 0.02;
    let inside = half - x;
    ((inside / 0.96).clamp(0.0, 1.0), 0.5 * inside)
}

/// Returns the colour at a place.
fn colour_at(material: &OrganMaterial, u: f64, v: f64) -> Paint {
    let amount = if material.amount.is_finite() { material.amount.clamp(0.0, 1.0) } else { 0.5 };
    let (first, second) = (material.color.srgb(), material.second.srgb());
    let leaf = LeafInks { dark: shade(first, 0.88), light: shade(first, 1.06), vein: second };
    match material.pattern {
        Pattern::Plain | Pattern::Picture => body(first, u, v),
        Pattern::Shaded => shaded(first, second, amount, (u, v)),
        Pattern::Veined => mix(body(first, u, v), blades::leaf(&leaf, u, v), 0.25 + 0.75 * amount),
        Pattern::Streaked => streaked(first, second, amount, (u, v)),
        Pattern::Speckled => speckled(first, second, amount, (u, v)),
        Pattern::Picotee => picotee(first, second, amount, (u, v)),
        Pattern::Variegated => variegated(first, second, amount, (u, v)),
    }
}

/// Paints one colour, slightly uneven, like tissue.
fn body(color: Paint, u: f64, v: f64) -> Paint {
    shade(color, 1.0 + 0.05 * octaves(4.0 * u, 6.0 * v, (4, 6), 3, 3))
}

fn shaded(tip: Paint, root: Paint, amount: f64, (u, v): (f64, f64)) -> Paint {
    let along = 1.0 - v + 0.06 * octaves(4.0 * u, 5.0 * v, (4, 5), 41, 3);
    let share = ops::smoothstep(0.15 * amount, 0.15 + 1.25 * amount, along);
    body(mix(root, tip, share), u, v)
}

fn streaked(first: Paint, second: Paint, amount: f64, (u, v): (f64, f64)) -> Paint {
    let (x, y) = (2.0 * u - 1.0, 1.0 - v);
    let fan = x / (0.30 + 0.85 * y) + 0.03 * gradient(6.0 * u, 5.0 * v, (6, 5), 42);
    let phase = 6.0 * fan;
    let off = (phase - phase.round()).abs();
    // Streaks thin out and end at different heights.
    let reach = 0.18 + 0.85 * amount;
    let end = reach * (0.7 + 0.3 * gradient(9.0 * fan + 20.0, 0.5, (64, 1), 43));
    let width = 0.36 * (1.0 - ops::smoothstep(0.0, end.max(0.05), y));
    let streak = 1.0 - ops::smoothstep(0.6 * width, width + 0.05, off);
    let alive = 1.0 - ops::smoothstep(0.8 * end, end.max(0.06), y);
    let throat = 1.0 - ops::smoothstep(0.02, 0.05 + 0.25 * amount, y);
    mix(body(first, u, v), second, (0.9 * streak * alive).max(0.7 * throat))
}

fn speckled(first: Paint, second: Paint, amount: f64, (u, v): (f64, f64)) -> Paint {
    let y = 1.0 - v;
    // Cells twice as long as they are wide on the sheet are round on a petal.
    let (near, next) = cells(10.0 * u, 16.0 * v, (10, 16), 44);
    let wanted = (0.10 + 0.42 * amount) * (1.15 - 0.75 * y);
    // Some cells have no spot, and none is at the very tip.
    let some = gradient(4.0 * u, 7.0 * v, (4, 7), 45);
    let alive = ops::smoothstep(-0.35, 0.1, some + amount - 0.35) * (1.0 - ops::smoothstep(0.8, 0.97, y));
    let size = wanted * alive;
    let spot = 1.0 - ops::smoothstep(0.7 * size, size.max(1e-6), near);
    let apart = ops::smoothstep(0.0, 0.08, next - near);
    mix(body(first, u, v), second, spot * apart * ops::smoothstep(0.03, 0.08, size))
}

fn picotee(first: Paint, second: Paint, amount: f64, (inner, v): (f64, f64)) -> Paint {
    let wave = 0.35 * gradient(1.0, 16.0 * v, (4, 16), 46) + 0.25 * gradient(1.5, 41.0 * v, (4, 41), 47);
    let edge = (0.03 + 0.75 * amount) * (1.0 + wave);
    // It vanishes completely at amount 0.
    let rim = (1.0 - ops::smoothstep(0.55 * edge, edge, inner)) * ops::smoothstep(0.0, 0.04, amount);
    let flush = 0.22 * (1.0 - ops::smoothstep(edge, 2.4 * edge, inner));
    mix(body(first, inner, v), second, rim.max(flush * amount))
}

fn variegated(first: Paint, second: Paint, amount: f64, (inner, v): (f64, f64)) -> Paint {
    // Tongues run inwards along the side veins.
    let tongue = |n: i32, salt| gradient(0.7 * inner + 0.5, f64::from(n) * (v + 0.18 * inner), (4, n), salt);
    let ragged = 0.42 * tongue(9, 48) + 0.24 * tongue(23, 49) + 0.10 * tongue(60, 50);
    let edge = (0.05 + 0.8 * amount) * (1.0 + ragged);
    let rim = 1.0 - ops::smoothstep(0.88 * edge, edge.max(1e-6), inner);
    let half = 1.0 - ops::smoothstep(1.25 * edge, 1.4 * edge.max(1e-6), inner + 0.05 * tongue(31, 51));
    let share = rim.max(0.4 * half) * ops::smoothstep(0.0, 0.04, amount);
    body(mix(first, second, share), inner, v)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::MATERIALS;
    use base::Serial;

    #[test]
    fn patterns_show_both_colours_and_more_of_the_second_with_more_of_it() {
        for pattern in Pattern::ALL {
            let share = |amount| {
                let material = OrganMaterial {
                    pattern,
                    color: spec::Colour([230, 230, 230]),
                    second: spec::Colour([40, 20, 20]),
                    amount,
                    ..OrganMaterial::default()
                };
                let t = paint(&material, (64, 128), &Serial);
                let dark: usize =
                    t.pixels.chunks(4).map(|p| 230_usize.saturating_sub(usize::from(p[0]))).sum();
                assert!(t.pixels.chunks(4).all(|p| p[3] == 255), "{pattern:?} is opaque");
                // In thousandths of the second colour.
                dark * 1000 / (190 * 64 * 128)
            };
            let [little, some, much] = [0.1, 0.5, 0.9].map(share);
            if matches!(pattern, Pattern::Plain | Pattern::Picture) {
                assert!(little == much && much < 30, "{pattern:?}: {little} {much}");
            } else {
                assert!(little < some && some < much, "{pattern:?}: {little} {some} {much}");
                assert!((20..980).contains(&some), "{pattern:?}: {some}");
            }
        }
    }

    #[test]
    fn a_painting_is_made_once_and_kept() {
        let material = &MATERIALS[0].1;
        assert!(Arc::ptr_eq(&painted(material, &Serial), &painted(material, &Serial)));
    }
}
