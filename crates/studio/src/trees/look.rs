//! Colours of leaves and bark.
//!
//! `Plant + Model + Look -> tinted leaves, repainted bark`

use std::sync::Arc;

use base::ops::{self, TAU};
use base::{Draw, Executor, Run, Seed, map_indexed};
use growth::{Bark, Look};
use mesh::{Material, MaterialKind, Model, Texture};
use plant::{OrganKind, Paint, Plant};
use spec::Colour;

/// Gives each leaf its colour. Leaves that have a picture only vary in brightness.
pub(super) fn tint(look: &Look, plant: &mut Plant, pictured: bool, seed: Seed) {
    let (mut from, mut to) =
        (look.leaf_color.linear(), look.leaf_color_to.unwrap_or(look.leaf_color).linear());
    if pictured {
        (from, to) = ([1.0; 3], [0.8; 3]);
    }
    for organ in plant.organs.iter_mut().filter(|o| o.kind == OrganKind::Leaf) {
        let share = look.leaf_variation * seed.child(organ.key).stream(Draw::Tint).uniform();
        #[expect(clippy::cast_possible_truncation, reason = "a colour")]
        let mixed = [0, 1, 2].map(|i| ops::lerp(from[i], to[i], share) as f32);
        organ.paint = if pictured { Paint::Natural(mixed) } else { Paint::Tinted(mixed) };
    }
}

/// Repaints the bark of a model, with what is kept where it is the same.
pub(super) fn paint(look: &Look, model: &mut Model, kept: &mut KeptBarks, run: &Run<'_>) {
    let known = core::mem::take(kept);
    // A slender tree has no part with old bark: then its stem is among the young ones.
    let old = model.materials.iter().any(|m| m.kind == MaterialKind::Bark);
    for material in &mut model.materials {
        if !matches!(material.kind, MaterialKind::Bark | MaterialKind::YoungBark) {
            continue;
        }
        let twig = old && material.kind == MaterialKind::YoungBark;
        let colour = if twig { look.twig_color } else { look.bark_color };
        repaint(look, material, (colour, twig), (&known, kept), run.executor);
    }
    if let Some(foot) = look.foot_color {
        darken_foot(look, model, if old { MaterialKind::Bark } else { MaterialKind::YoungBark }, foot);
    }
}

/// Vertex colours that turn the bark of one material into the foot's, from `foot_height` downwards.
fn darken_foot(look: &Look, model: &mut Model, kind: MaterialKind, foot: Colour) {
    let bounds = model.bounds();
    let height = (bounds.max.y * look.foot_height).max(f64::MIN_POSITIVE);
    let patches = Lattice::new((16, 16), 41);
    let (bark, foot) = (look.bark_color.linear(), foot.linear());
    let ratio = [0, 1, 2].map(|i| (foot[i] / bark[i].max(1e-3)).clamp(0.0, 1.0));
    let chosen: Vec<bool> = model.materials.iter().map(|m| m.kind == kind).collect();
    for part in &mut model.parts {
        if !chosen.get(part.material.index()).copied().unwrap_or(false) {
            continue;
        }
        let mesh = &mut part.mesh;
        mesh.colors.resize(mesh.positions.len(), [1.0; 3]);
        for (p, color) in mesh.positions.iter().zip(&mut mesh.colors) {
            let [x, y, z] = p.map(f64::from);
            // Patches as large as the trunk is thick, so that the border is ragged.
            let patch = patches.noise(0.37 * x + 0.11 * z + 0.5, 0.31 * y + 0.17 * z + 0.5);
            let share = 1.0 - ops::smoothstep(0.25, 1.0, y / height + 0.22 * patch);
            #[expect(clippy::cast_possible_truncation, reason = "a colour of the mesh")]
            let shade = ratio.map(|r| ops::lerp(1.0, r, share) as f32);
            *color = [0, 1, 2].map(|i| color[i] * shade[i]);
        }
    }
}

fn repaint(
    look: &Look,
    material: &mut Material,
    (colour, twig): (Colour, bool),
    (known, kept): (&KeptBarks, &mut KeptBarks),
    executor: &dyn Executor,
) {
    let Some(old) = &material.texture else {
        #[expect(clippy::cast_possible_truncation, reason = "a colour")]
        let plain = colour.linear().map(|x| x as f32);
        material.base_color = plain;
        return;
    };
    let from = Painted { bark: look.bark, colour, twig, old: Arc::clone(old) };
    let texture = match known.0.iter().find(|(k, _)| k.same(&from)) {
        Some((_, texture)) => Arc::clone(texture),
        None => Arc::new(from.paint(executor)),
    };
    kept.0.push((from, Arc::clone(&texture)));
    material.texture = Some(texture);
}

/// The bark of the last model: painting it takes longer than the meshes of a small tree. Changes no result.
#[derive(Clone, Debug, Default)]
pub(super) struct KeptBarks(Vec<(Painted, Arc<Texture>)>);

/// What bark is painted from.
#[derive(Clone, Debug)]
struct Painted {
    bark: Bark,
    colour: Colour,
    twig: bool,
    /// The surface's own, without its colour.
    old: Arc<Texture>,
}

impl Painted {
    fn same(&self, other: &Self) -> bool {
        let form = |p: &Self| (p.bark, p.colour, p.twig);
        form(self) == form(other) && Arc::ptr_eq(&self.old, &other.old)
    }

    fn paint(&self, executor: &dyn Executor) -> Texture {
        let (old, colour) = (&self.old, self.colour);
        match self.bark {
            // Twigs have the same bark on every kind but one: a bamboo's are canes too.
            Bark::Cane => painted(executor, cane(colour)),
            _ if self.twig => recoloured(old, colour, 0.7),
            Bark::Furrowed => recoloured(old, colour, 1.0),
            Bark::Smooth => recoloured(old, colour, 0.35),
            Bark::Plated => painted(executor, plated(colour)),
            Bark::Birch => painted(executor, birch(colour)),
            Bark::Ringed => painted(executor, ringed(colour)),
        }
    }
}

/// The pattern of a texture in another mean colour.
fn recoloured(old: &Texture, colour: Colour, contrast: f64) -> Texture {
    let light = |p: &[u8]| 0.3 * f64::from(p[0]) + 0.6 * f64::from(p[1]) + 0.1 * f64::from(p[2]);
    let pixels = old.pixels.chunks_exact(4);
    let count = (old.pixels.len() / 4).max(1) as f64;
    let mean = (pixels.clone().map(light).sum::<f64>() / count).max(1.0);
    let want = colour.srgb();
    let new = pixels.flat_map(|p| {
        let relative = 1.0 + contrast * (light(p) / mean - 1.0);
        let [r, g, b] = want.map(|c| byte(c * relative));
        [r, g, b, p[3]]
    });
    Texture { width: old.width, height: old.height, pixels: new.collect() }
}

const SIDE: u32 = 256;

/// A square texture; `paint` gives sRGB at u and v, both 0 to 1, and repeats in both.
fn painted(executor: &dyn Executor, paint: impl Fn(f64, f64) -> [f64; 3] + Sync) -> Texture {
    let at = |i: usize| (i as f64 + 0.5) / f64::from(SIDE);
    let side = SIDE as usize;
    let rows = map_indexed(executor, side, |j| -> Vec<u8> {
        let pixels = (0..side).map(|i| paint(at(i), at(j)).map(byte));
        pixels.flat_map(|[r, g, b]| [r, g, b, 255]).collect()
    });
    Texture { width: SIDE, height: SIDE, pixels: rows.concat() }
}

fn byte(x: f64) -> u8 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to a byte's range")]
    let b = (x.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
    b
}

/// Fixed numbers from 0 to 1 in the cells of a pattern that repeats.
struct Lattice {
    size: (i64, i64),
    cells: Vec<f64>,
}

impl Lattice {
    fn new(size: (i64, i64), pattern: u64) -> Self {
        let cell = |x: i64, y: i64| {
            #[expect(clippy::cast_sign_loss, reason = "rows and columns")]
            let key = (x as u64) << 12 | y as u64;
            Seed::new(pattern).child(key).stream(Draw::Texture).uniform()
        };
        let cells = (0..size.1).flat_map(|y| (0..size.0).map(move |x| (x, y)));
        Self { size, cells: cells.map(|(x, y)| cell(x, y)).collect() }
    }

    fn at(&self, x: i64, y: i64) -> f64 {
        let (nx, ny) = self.size;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the lattice")]
        let cell = (y.rem_euclid(ny) * nx + x.rem_euclid(nx)) as usize;
        self.cells[cell]
    }

    /// Smooth noise between the cells, -1 to 1; u and v from 0 to 1 are one repetition.
    fn noise(&self, u: f64, v: f64) -> f64 {
        let (x, y) = (u * self.size.0 as f64, v * self.size.1 as f64);
        let (x0, y0) = (x.floor(), y.floor());
        let (fx, fy) = (ops::smoothstep(0.0, 1.0, x - x0), ops::smoothstep(0.0, 1.0, y - y0));
        #[expect(clippy::cast_possible_truncation, reason = "cells of a small lattice")]
        let (i, j) = (x0 as i64, y0 as i64);
        let low = ops::lerp(self.at(i, j), self.at(i + 1, j), fx);
        let high = ops::lerp(self.at(i, j + 1), self.at(i + 1, j + 1), fx);
        2.0 * ops::lerp(low, high, fy) - 1.0
    }
}

fn shaded(colour: Colour, factor: f64) -> [f64; 3] {
    colour.srgb().map(|c| c * factor)
}

fn mixed(a: [f64; 3], b: [f64; 3], share: f64) -> [f64; 3] {
    [0, 1, 2].map(|i| ops::lerp(a[i], b[i], share.clamp(0.0, 1.0)))
}

/// White with short dark stripes across and black diamonds where branches have been.
fn birch(colour: Colour) -> impl Fn(f64, f64) -> [f64; 3] {
    const DARK: [f64; 3] = [0.16, 0.14, 0.13];
    let tones = [Lattice::new((9, 5), 1), Lattice::new((24, 60), 2)];
    let stripes = [Lattice::new((6, 34), 3), Lattice::new((18, 68), 4)];
    let scars = [Lattice::new((4, 4), 5), Lattice::new((12, 16), 6)];
    move |u, v| {
        let base = shaded(colour, 1.0 + 0.05 * tones[0].noise(u, v) + 0.04 * tones[1].noise(u, v));
        // Stripes: narrow along v, some cells across u wide.
        let stripe = stripes[0].noise(u, v) + 0.35 * stripes[1].noise(u, v);
        let scar = scars[0].noise(u, v) + 0.4 * scars[1].noise(u, v);
        let dark = 0.75 * ops::smoothstep(0.62, 0.86, stripe) + ops::smoothstep(0.78, 0.98, scar);
        mixed(base, DARK, dark)
    }
}

/// Flakes of a cellular pattern, drawn out along the trunk, with dark cracks between.
fn plated(colour: Colour) -> impl Fn(f64, f64) -> [f64; 3] {
    const CRACK: [f64; 3] = [0.17, 0.12, 0.10];
    let (nx, ny) = (6_i64, 4_i64);
    let bent = [Lattice::new((12, 8), 11), Lattice::new((12, 8), 12)];
    let [across, along, tones] = [13, 14, 15].map(|pattern| Lattice::new((nx, ny), pattern));
    let grain = Lattice::new((20, 50), 16);
    move |u, v| {
        let x = u * nx as f64 + 0.35 * bent[0].noise(u, v);
        let y = v * ny as f64 + 0.3 * bent[1].noise(u, v);
        let (mut near, mut next, mut tone) = (9.0_f64, 9.0_f64, 0.0);
        for dy in -1..=1 {
            for dx in -1..=1 {
                #[expect(clippy::cast_possible_truncation, reason = "cells of a small lattice")]
                let (i, j) = (x.floor() as i64 + dx, y.floor() as i64 + dy);
                let (cx, cy) = (i as f64 + across.at(i, j), j as f64 + along.at(i, j));
                let d = ((cx - x) * (cx - x) + (cy - y) * (cy - y)).sqrt();
                if d < near {
                    (next, near, tone) = (near, d, tones.at(i, j));
                } else {
                    next = next.min(d);
                }
            }
        }
        let flake = shaded(colour, 0.9 + 0.28 * tone + 0.10 * grain.noise(u, v));
        mixed(CRACK, flake, ops::smoothstep(0.02, 0.16, next - near))
    }
}

/// Narrow rings across the stem, uneven, with fibres between.
fn ringed(colour: Colour) -> impl Fn(f64, f64) -> [f64; 3] {
    let uneven = Lattice::new((5, 7), 21);
    let fibres = [Lattice::new((50, 8), 22), Lattice::new((9, 16), 23)];
    move |u, v| {
        let y = 7.0 * v + 0.16 * uneven.noise(u, v);
        let phase = y - y.floor();
        let edge = 1.0 - ops::smoothstep(0.0, 0.22, phase.min(1.0 - phase));
        let fibre = 0.08 * fibres[0].noise(u, v) + 0.06 * fibres[1].noise(u, v);
        shaded(colour, 1.08 - 0.42 * edge + 0.12 * phase + fibre)
    }
}

/// One joint for each turn of the texture: a pale ring of wax below a dark line.
fn cane(colour: Colour) -> impl Fn(f64, f64) -> [f64; 3] {
    let gloss = Lattice::new((30, 2), 31);
    move |u, v| {
        let sheen = 1.0 + 0.05 * ops::cos(TAU * u) + 0.05 * gloss.noise(u, v);
        let base = shaded(colour, sheen);
        let from = (v - 0.5).abs();
        let pale = mixed(base, [0.86, 0.87, 0.75], 0.6 * (1.0 - ops::smoothstep(0.02, 0.07, from)));
        mixed(pale, shaded(colour, 0.45), 1.0 - ops::smoothstep(0.006, 0.016, from))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn barks_have_their_mean_colour_and_repeat() {
        let colour = Colour([0x80, 0x70, 0x60]);
        let paints: [&(dyn Fn(f64, f64) -> [f64; 3] + Sync); 4] =
            [&birch(colour), &plated(colour), &ringed(colour), &cane(colour)];
        for (i, paint) in paints.into_iter().enumerate() {
            let t = painted(&base::Serial, paint);
            let red = t.pixels.chunks_exact(4).map(|p| f64::from(p[0])).sum::<f64>();
            let red = red / f64::from(SIDE * SIDE);
            assert!((80.0..150.0).contains(&red), "{i}: {red}");
            for k in 0..40 {
                let v = f64::from(k) / 40.0;
                let [a, b] = [paint(1e-9, v), paint(1.0 - 1e-9, v)];
                assert!((a[0] - b[0]).abs() < 0.02, "{i}: no seam at {v}: {a:?} {b:?}");
            }
        }
        let old = Texture { width: 2, height: 1, pixels: vec![100, 100, 100, 255, 50, 50, 50, 255] };
        let new = recoloured(&old, colour, 1.0);
        assert_eq!((new.pixels[0], new.pixels[4]), (171, 85), "a third lighter, a third darker");
    }
}
