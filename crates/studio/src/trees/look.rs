//! Colours of leaves and bark.
//!
//! `Plant + Model + Look -> tinted leaves, the bark to paint, a dark foot`

use base::ops;
use base::{Draw, Seed};
use growth::{Bark, BladeForm, Look};
use mesh::{MaterialKind, Model};
use plant::{OrganKind, Paint, Plant};
use skin::{BarkKind, BarkSpec, SkinSpec, Venation};
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

/// A surface with the bark of a look, and leaves with the veins of their form.
pub(super) fn dressed(skin: SkinSpec, look: &Look, form: BladeForm) -> SkinSpec {
    let kind = match look.bark {
        Bark::Furrowed => BarkKind::Furrowed,
        Bark::Smooth => BarkKind::Smooth,
        Bark::Plated => BarkKind::Plated,
        Bark::Birch => BarkKind::Birch,
        Bark::Cherry => BarkKind::Cherry,
        Bark::Ringed => BarkKind::Ringed,
        Bark::Cane => BarkKind::Cane,
    };
    let venation = match form {
        BladeForm::Palmate => Venation::Palmate,
        BladeForm::Pinnate => Venation::Compound,
        BladeForm::Leaflet => Venation::Parallel,
        // What has canes is a grass.
        BladeForm::Lanceolate if look.bark == Bark::Cane => Venation::Parallel,
        BladeForm::Needle | BladeForm::Tuft | BladeForm::Spray | BladeForm::Brush => Venation::Needle,
        _ => Venation::Pinnate,
    };
    let bark = BarkSpec { kind, colour: look.bark_color, twig: look.twig_color };
    SkinSpec { bark: Some(bark), venation: Some(venation), ..skin }
}

/// Darkens the foot of a model's trunk, where the look says so.
pub(super) fn paint(look: &Look, model: &mut Model) {
    let Some(foot) = look.foot_color else { return };
    // A slender tree has no part with old bark: then its stem is among the young ones.
    let old = model.materials.iter().any(|m| m.kind == MaterialKind::Bark);
    darken_foot(look, model, if old { MaterialKind::Bark } else { MaterialKind::YoungBark }, foot);
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
