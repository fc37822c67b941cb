//! Colours of leaves and bark, and the season.
//!
//! `Plant + Model + Look -> tinted leaves that have not fallen, the bark to paint, a dark foot`

use base::ops;
use base::{Draw, Seed};
use glam::DVec3;
use growth::{Bark, Look};
use mesh::{MaterialKind, Model};
use plant::{BladeForm, Organ, OrganKind, Paint, Plant};
use skin::{BarkKind, BarkSpec, SkinSpec, VeinPattern};
use spec::Colour;

/// Colour towards which leaves are tinted when they unfold: they reach their size before their chlorophyll.
const YOUNG: Colour = Colour([0xc4, 0xd6, 0x5c]);
/// Share of that tint at the beginning.
const YOUNG_SHARE: f64 = 0.6;
/// Size of a leaf as it leaves its bud, relative to the grown one.
const BURST: f64 = 0.12;
/// Time that a leaf takes to unfold, as a share of that from bare to summer.
const UNFOLDING: f64 = 0.4;
/// Delay of the last leaf after the first, as a share of the same time: for leaves that appear successively, and for
/// those that appear almost together (Koike 1990).
const SPREAD: [f64; 2] = [0.6, 0.25];

/// Gives each leaf its colour, and removes those that have not unfolded or have fallen by the season; returns how many.
/// Leaves that have a picture only vary in brightness.
pub(super) fn tint(look: &Look, plant: &mut Plant, pictured: bool, seed: Seed) -> usize {
    let pair = |from: Colour, to: Option<Colour>| [from.linear(), to.unwrap_or(from).linear()];
    let plain = [[1.0; 3], [0.8; 3]];
    let summer = if pictured { plain } else { pair(look.leaf_color, look.leaf_color_to) };
    let season = look.leaf_season();
    let late = match season {
        s if s > 0.0 => lateness(plant, look.autumn_outside, seed),
        // The inside is warmer and unfolds first.
        s if s < 0.0 => lateness(plant, false, seed),
        _ => Vec::new(),
    };
    let autumn = look
        .autumn_color
        .filter(|_| season > 0.0)
        .map(|color| if pictured { plain } else { pair(color, look.autumn_color_to) });
    let spread = SPREAD[usize::from(look.autumn_outside)];
    for (row, organ) in plant.organs.iter_mut().enumerate().filter(|(_, o)| o.kind == OrganKind::Leaf) {
        let share = look.leaf_variation * seed.child(organ.key).stream(Draw::Tint).uniform();
        let mixed = |[from, to]: [[f64; 3]; 2]| [0, 1, 2].map(|i| ops::lerp(from[i], to[i], share));
        let towards =
            |from: [f64; 3], to: [f64; 3], share: f64| [0, 1, 2].map(|i| ops::lerp(from[i], to[i], share));
        let green = mixed(summer);
        let color = match autumn {
            Some(colours) => {
                let turned = turned(season, late[row]);
                let gold = mixed(colours);
                if turned < 1.0 { towards(green, gold, turned) } else { gold }
            }
            None if season < 0.0 => {
                let Spring { open, age } = Spring::compute(season, spread * late[row]);
                organ.scale *= ops::lerp(BURST, 1.0, open);
                if pictured { green } else { towards(green, YOUNG.linear(), YOUNG_SHARE * (1.0 - age)) }
            }
            None => green,
        };
        #[expect(clippy::cast_possible_truncation, reason = "a colour")]
        let color = color.map(|c| c as f32);
        organ.paint = if pictured { Paint::Natural(color) } else { Paint::Tinted(color) };
    }
    if late.is_empty() {
        return 0;
    }
    let before = plant.organs.len();
    let mut late = late.into_iter();
    plant.organs.retain(|o| {
        let late = late.next().unwrap_or(0.0);
        let bud = || Spring::compute(season, spread * late).age <= 0.0;
        let away = if season < 0.0 { bud() } else { has_fallen(season, late) };
        o.kind != OrganKind::Leaf || !away
    });
    before - plant.organs.len()
}

/// A leaf in spring.
struct Spring {
    /// Degree of unfolding, 0 to 1.
    open: f64,
    /// Share of its development from bud to summer that is complete.
    age: f64,
}

impl Spring {
    /// Computes the state of a leaf that leaves its bud at a share of the time from bare to summer.
    fn compute(season: f64, begins: f64) -> Self {
        let (now, left) = (season + 1.0, 1.0 - begins);
        let age = ((now - begins) / left).clamp(0.0, 1.0);
        Self { open: ops::smoothstep(begins, begins + UNFOLDING, now), age }
    }
}

/// Returns how far the colour of a leaf has turned, 0 to 1: the last ones turn when the first are about to fall.
fn turned(season: f64, late: f64) -> f64 {
    if season >= 0.5 { 1.0 } else { ((season - 0.3 * late) / 0.2).clamp(0.0, 1.0) }
}

/// Whether a leaf has fallen: the first leaves to turn fall first.
fn has_fallen(season: f64, late: f64) -> bool {
    season >= 1.0 || season - 0.5 > 0.5 * late
}

/// Returns for each organ how late in autumn it turns and falls, or unfolds in spring, 0 to below 1.
///
/// Trees of early successions turn from the inside of the crown outwards, others from its outside (Koike 1990); twigs
/// and leaves vary in addition to that.
fn lateness(plant: &Plant, outside: bool, seed: Seed) -> Vec<f64> {
    let axis_of = |o: &Organ| o.bearer.map(|b| plant.nodes.axis[b.index()].index());
    // Each crown by itself: bearers come before the axes that they bear.
    let mut tree: Vec<usize> = (0..plant.axes.len()).collect();
    for (row, axis) in plant.axes.iter().enumerate() {
        if let Some(bearer) = axis.bearer {
            tree[row] = tree[plant.nodes.axis[bearer.index()].index()];
        }
    }
    let mut crowns = vec![[DVec3::INFINITY, DVec3::NEG_INFINITY]; plant.axes.len()];
    let leaves = || plant.organs.iter().filter(|o| o.kind == OrganKind::Leaf);
    for (axis, at) in leaves().filter_map(|o| Some((axis_of(o)?, o.frame.origin))) {
        let [low, high] = &mut crowns[tree[axis]];
        (*low, *high) = (low.min(at), high.max(at));
    }
    let late = |o: &Organ| {
        let Some(axis) = axis_of(o) else { return 0.0 };
        let [low, high] = crowns[tree[axis]];
        let half = (0.5 * (high - low)).max(DVec3::splat(1e-9));
        let out = ((o.frame.origin - 0.5 * (low + high)) / half).length().min(1.0);
        let draw = |key: u64| seed.child(key).stream(Draw::Season).uniform();
        0.45 * draw(o.key) + 0.2 * draw(plant.axes[axis].key) + 0.35 * if outside { 1.0 - out } else { out }
    };
    plant.organs.iter().map(|o| if o.kind == OrganKind::Leaf { late(o) } else { 0.0 }).collect()
}

/// Returns skin settings with the bark of a look, and leaves with the veins of their form.
pub(super) fn dressed(skin: SkinSpec, look: &Look, form: BladeForm) -> SkinSpec {
    let kind = match look.bark {
        Bark::Furrowed => BarkKind::Furrowed,
        Bark::Smooth => BarkKind::Smooth,
        Bark::Plated => BarkKind::Plated,
        Bark::Birch => BarkKind::Birch,
        Bark::Cherry => BarkKind::Cherry,
        Bark::Ringed => BarkKind::Ringed,
        Bark::Cane => BarkKind::Cane,
        Bark::Ribbed => BarkKind::Ribbed,
    };
    let venation = match form {
        BladeForm::Palmate | BladeForm::Fingered | BladeForm::Tricuspid | BladeForm::Fan => {
            VeinPattern::Palmate
        }
        BladeForm::Pinnate | BladeForm::Feather => VeinPattern::Compound,
        BladeForm::Leaflet => VeinPattern::Parallel,
        // Plants with canes are grasses.
        BladeForm::Lanceolate if look.bark == Bark::Cane => VeinPattern::Parallel,
        BladeForm::Needle | BladeForm::Tuft | BladeForm::Spray | BladeForm::Brush => VeinPattern::Needle,
        _ => VeinPattern::Pinnate,
    };
    let (ribs, rib_depth) = (look.ribs.min(32), look.rib_depth);
    let bark = BarkSpec { kind, colour: look.bark_color, twig: look.twig_color, ribs, rib_depth };
    SkinSpec { bark: Some(bark), venation: Some(venation), ..skin }
}

/// Darkens the foot of a model's trunk, if the look has a foot colour.
pub(super) fn paint(look: &Look, model: &mut Model) {
    let Some(foot) = look.foot_color else { return };
    // A slender tree has no part with old bark: then its stem is among the young ones.
    let old = model.materials.iter().any(|m| m.kind == MaterialKind::Bark);
    darken_foot(look, model, if old { MaterialKind::Bark } else { MaterialKind::YoungBark }, foot);
}

/// Sets vertex colours that turn the bark of one material into the foot's, from `foot_height` downwards.
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
            // Patches of the size of the trunk's diameter make the border ragged.
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

    fn cell(&self, x: i64, y: i64) -> f64 {
        let (nx, ny) = self.size;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the lattice")]
        let cell = (y.rem_euclid(ny) * nx + x.rem_euclid(nx)) as usize;
        self.cells[cell]
    }

    /// Returns smooth noise between the cells, -1 to 1; u and v from 0 to 1 are one repetition.
    fn noise(&self, u: f64, v: f64) -> f64 {
        let (x, y) = (u * self.size.0 as f64, v * self.size.1 as f64);
        let (x0, y0) = (x.floor(), y.floor());
        let (fx, fy) = (ops::smoothstep(0.0, 1.0, x - x0), ops::smoothstep(0.0, 1.0, y - y0));
        #[expect(clippy::cast_possible_truncation, reason = "cells of a small lattice")]
        let (i, j) = (x0 as i64, y0 as i64);
        let low = ops::lerp(self.cell(i, j), self.cell(i + 1, j), fx);
        let high = ops::lerp(self.cell(i, j + 1), self.cell(i + 1, j + 1), fx);
        2.0 * ops::lerp(low, high, fy) - 1.0
    }
}
