//! Levels of detail of any plant, and the other parts of its export.
//!
//! `plant, its finest meshes -> coarser plants -> meshes of at most half the triangles each -> copies, impostor`

use std::sync::Arc;

use base::{Cancelled, Run, Stopped};
use formats::{Assembly, Level};
use mesh::{Copies, Model, Texture};
use plant::{AxisKind, OrganKind, Plant};
use skin::{Layout, SkinSpec, coarser};

use crate::assembly::{AssemblyError, assemble};

/// A model, its plant, and the places of that plant's parts in the model.
pub(crate) type LaidOut = (Model, (Plant, Layout));

/// Exports of a plant in addition to its finest meshes, for any maker.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LevelSpec {
    /// Coarser copies, at most 6. Default 0.
    pub lods: u32,
    /// Also extract leaves of one form from each level ([`skin::copies`]). Default false.
    pub copies: bool,
    /// Side in pixels of an atlas of views from all sides, 128 to 4096, that is added as the last level
    /// ([`render::impostor`]). Default none.
    pub impostor: Option<u32>,
    /// Also make an assembly of the finest level ([`assemble`]). Default false.
    pub assembly: bool,
}

/// Coarser copies of a plant, the finest first.
#[derive(Clone, Debug, Default)]
pub struct Levels {
    /// Their meshes; the impostor is the last.
    pub lods: Vec<Model>,
    /// For the plant and each of `lods`, the model without leaves of one form, and these. Empty unless requested.
    pub copies: Vec<(Model, Vec<Copies>)>,
    /// The plant with a skeleton, if requested.
    pub assembly: Option<Result<Assembly, AssemblyError>>,
}

impl Levels {
    /// Makes the levels: `finest` is the plant itself, `at` returns one of its levels, 1 to 6.
    pub(crate) fn new<E: From<Cancelled>>(
        spec: &LevelSpec,
        (model, plant, layout): (&Model, &Plant, &Layout),
        mut at: impl FnMut(u32) -> Result<Option<LaidOut>, E>,
        run: &Run<'_>,
    ) -> Result<Self, E> {
        let mut levels = Self::default();
        if spec.assembly {
            levels.assembly = Some(assemble((plant, model, layout), run));
        }
        if spec.copies {
            levels.copies.push(skin::copies(plant, model, layout));
        }
        for level in 1..=spec.lods.min(MOST_LEVELS) {
            let Some((model, (plant, layout))) = at(level)? else { continue };
            if spec.copies {
                levels.copies.push(skin::copies(&plant, &model, &layout));
            }
            levels.lods.push(model);
        }
        if let Some(size) = spec.impostor
            && let Some(far) = render::impostor(model, size, run)?
        {
            if spec.copies {
                levels.copies.push((far.clone(), Vec::new()));
            }
            levels.lods.push(far);
        }
        Ok(levels)
    }
}

/// Most coarser copies.
const MOST_LEVELS: u32 = 6;
/// Least axes of a plant that loses axes at coarser levels: of fewer, each is seen.
const FEW_AXES: usize = 100;
/// Least leaves of a plant that loses leaves at coarser levels: of fewer, each is seen.
const FEW_LEAVES: usize = 300;
/// Most attempts to mesh a level more coarsely until it has at most half of the triangles of the one before.
const TRIES: u32 = 5;
/// Share of the triangles allowed that a further attempt aims at, because their number cannot be set exactly.
const AIM: f64 = 0.9;

/// Makes a plant at level `level` (1 to 6) with the materials of `fine`, its finest meshes, which `skin` describes.
///
/// Guaranteed: each level has at most half of the triangles of the one before, unless every part of it is as coarse as
/// possible. Many leaves and axes become fewer ([`coarser`]); of few, and of flowers, each part becomes coarser. Cost:
/// that of meshing the finer levels, too.
pub(crate) fn level_of(
    plant: &Plant,
    (skin, fine): (&SkinSpec, &Model),
    level: u32,
    mesh: impl Fn(&Plant, &SkinSpec) -> Result<(Model, Layout), Stopped>,
) -> Result<LaidOut, Stopped> {
    let mut last = Coarse::from_finest(fine);
    let mut made = next_level((plant, skin, fine), 1, &mut last, &mesh)?;
    for at in 2..=level.min(MOST_LEVELS) {
        made = next_level((plant, skin, fine), at, &mut last, &mesh)?;
    }
    Ok(made)
}

/// Makes levels 1 to `count` (at most 6) as [`level_of`] makes each. Cost: that of meshing each once.
pub(crate) fn levels_of(
    plant: &Plant,
    (skin, fine): (&SkinSpec, &Model),
    count: u32,
    mesh: impl Fn(&Plant, &SkinSpec) -> Result<(Model, Layout), Stopped>,
) -> Result<Vec<LaidOut>, Stopped> {
    let mut last = Coarse::from_finest(fine);
    (1..=count.min(MOST_LEVELS))
        .map(|level| next_level((plant, skin, fine), level, &mut last, &mesh))
        .collect()
}

/// State that a level passes to the next.
struct Coarse {
    /// Most triangles of the next level.
    most: usize,
    /// Factor by which its parts are finer or coarser than the default.
    detail: f64,
}

impl Coarse {
    fn from_finest(fine: &Model) -> Self {
        Self { most: fine.triangle_count() / 2, detail: 1.0 }
    }
}

fn next_level(
    (plant, skin, fine): (&Plant, &SkinSpec, &Model),
    level: u32,
    last: &mut Coarse,
    mesh: &impl Fn(&Plant, &SkinSpec) -> Result<(Model, Layout), Stopped>,
) -> Result<LaidOut, Stopped> {
    let (copy, style) = if is_crowd(plant) {
        coarser(plant, skin, level)
    } else {
        let sides = skin.sides.saturating_sub(2 * level).max(3);
        let detail = skin.detail / f64::from(1_u32 << level);
        (plant.clone(), SkinSpec { detail, sides, ..skin.clone() })
    };
    let meshed = |detail: f64| mesh(&copy, &SkinSpec { detail: style.detail * detail, ..style.clone() });
    let (mut model, mut layout) = meshed(last.detail)?;
    for _ in 0..TRIES {
        let count = model.triangle_count();
        if count <= last.most {
            break;
        }
        let detail = last.detail * AIM * last.most as f64 / count as f64;
        let smaller = meshed(detail)?;
        if smaller.0.triangle_count() >= count {
            break;
        }
        ((model, layout), last.detail) = (smaller, detail);
    }
    last.most = model.triangle_count() / 2;
    // Cards of leaves have separate textures.
    if style.foliage == skin.foliage {
        for material in &mut model.materials {
            if let Some(same) = fine.materials.iter().find(|m| m.name == material.name) {
                *material = same.clone();
            }
        }
    }
    Ok((model, (copy, layout)))
}

/// Whether a plant has so many leaves or axes that fewer of them look the same from afar.
fn is_crowd(plant: &Plant) -> bool {
    let leaves = plant.organs.iter().filter(|o| o.kind == OrganKind::Leaf).count();
    let axes = plant.axes.iter().filter(|a| a.kind != AxisKind::Petiole).count();
    leaves >= FEW_LEAVES || axes >= FEW_AXES
}

/// Largest size of the written form of a plant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Allowance {
    /// Most triangles of the model. Default any.
    pub triangles: Option<u64>,
    /// Most bytes of its files. Default any.
    pub bytes: Option<u64>,
}

/// A plant that fits its allowance.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// The model, perhaps a coarser level.
    pub model: Model,
    /// Its coarser copies.
    pub levels: Levels,
    /// Level of detail of the model, 0 for the finest.
    pub level: usize,
    /// Number of halvings of the sides of its textures.
    pub halvings: u32,
}

impl Fitted {
    /// Describes in words how the plant was reduced; `None` if it is unchanged.
    pub fn line(&self) -> Option<String> {
        let level = (self.level > 0).then(|| format!("the model is level of detail {}", self.level));
        let textures = (self.halvings > 0).then(|| {
            format!("textures have a {} of their sides", ["half", "quarter"][self.halvings as usize - 1])
        });
        let parts: Vec<String> = level.into_iter().chain(textures).collect();
        (!parts.is_empty()).then(|| format!("to keep within the budget, {}", parts.join(" and ")))
    }
}

/// Reason why a plant cannot be as small as requested.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum AllowanceError {
    /// Even its coarsest level has more triangles.
    #[error(
        "the plant has at least {least} triangles, at its coarsest level; allow as many, or make it coarser"
    )]
    Triangles {
        /// Triangles of the coarsest level.
        least: u64,
    },
    /// Even its coarsest level is larger.
    #[error(
        "the file has at least {:.3} megabytes, at the coarsest level and with the smallest textures; allow as many, or ask for \
         fewer levels in it",
        *least as f64 / 1e6
    )]
    Bytes {
        /// Bytes of the coarsest level.
        least: u64,
    },
}

base::coded!(AllowanceError {
    Self::Triangles { least } => "least-triangles" { least },
    Self::Bytes { least } => "least-megabytes" { least = format!("{:.3}", *least as f64 / 1e6) },
});

/// Most halvings of the sides of textures for a budget: of 512 pixels, 128 remain.
const HALVINGS: u32 = 2;

impl Allowance {
    /// Range of [`Self::triangles`] in requests.
    pub const TRIANGLES: (u64, u64) = (100, 4_000_000_000);
    /// Range of [`Self::bytes`] in requests, in megabytes.
    pub const MEGABYTES: (f64, f64) = (0.001, 4000.0);

    /// Makes it from a request: triangles, and megabytes of a million bytes.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a cast saturates")]
    pub fn new(triangles: Option<u64>, megabytes: Option<f64>) -> Self {
        Self { triangles, bytes: megabytes.map(|m| (m * 1e6) as u64) }
    }

    /// Whether there is one.
    pub fn is_any(&self) -> bool {
        self.triangles.is_some() || self.bytes.is_some()
    }

    /// Returns the number of coarser copies to make where `lods` are asked for: with an allowance, the model may become one
    /// that nobody asked for.
    pub fn levels(&self, lods: u32) -> u32 {
        if self.is_any() { MOST_LEVELS } else { lods }
    }
}

impl Levels {
    /// Returns a model and its levels as files hold them: each without the leaves that are copies, and these copies.
    pub fn split<'a>(&'a self, model: &'a Model) -> Vec<Level<'a>> {
        let all = std::iter::once(model).chain(&self.lods).enumerate();
        let level = |(k, model): (usize, &'a Model)| {
            let split = self.copies.get(k).map(|(rest, copies)| Level { model: rest, copies: &copies[..] });
            split.unwrap_or(Level::plain(model))
        };
        all.map(level).collect()
    }

    /// Finds the finest level that fits, as the model, with `lods` coarser ones, and the impostor if there is one.
    /// Smaller textures are preferred to fewer triangles. `weigh` returns the bytes of a model.
    ///
    /// # Errors
    /// Those of `weigh`; inside, [`AllowanceError`] with the least possible size.
    pub fn within<E>(
        mut self,
        model: Model,
        allowance: Allowance,
        (lods, impostor): (u32, bool),
        mut weigh: impl FnMut(&Model, &Self) -> Result<u64, E>,
    ) -> Result<Result<Fitted, AllowanceError>, E> {
        let far = if impostor { self.lods.pop().map(|far| (far, self.copies.pop())) } else { None };
        self.lods.insert(0, model);
        let mut fault = AllowanceError::Triangles { least: 0 };
        for level in 0..self.lods.len() {
            let triangles = self.lods[level].triangle_count() as u64;
            if allowance.triangles.is_some_and(|most| triangles > most) {
                fault = AllowanceError::Triangles { least: triangles };
                continue;
            }
            let last = self.lods.len().min(level + 1 + lods as usize);
            let copies = self.copies.get(level..last).unwrap_or_default().to_vec();
            let mut kept = Self { lods: self.lods[level + 1..last].to_vec(), copies, assembly: None };
            let mut model = self.lods[level].clone();
            if let Some((far, copies)) = &far {
                kept.lods.push(far.clone());
                kept.copies.extend(copies.clone());
            }
            for halvings in 0..=HALVINGS {
                if halvings > 0 {
                    let rest = kept.copies.iter_mut().map(|(rest, _)| rest);
                    halve_textures(kept.lods.iter_mut().chain(rest).chain([&mut model]));
                }
                let Some(most) = allowance.bytes else {
                    return Ok(Ok(Fitted { model, levels: kept, level, halvings }));
                };
                let bytes = weigh(&model, &kept)?;
                if bytes <= most {
                    return Ok(Ok(Fitted { model, levels: kept, level, halvings }));
                }
                fault = AllowanceError::Bytes { least: bytes };
            }
        }
        Ok(Err(fault))
    }
}

/// Halves the sides of all textures, each once: shared ones stay shared.
fn halve_textures<'a>(models: impl Iterator<Item = &'a mut Model>) {
    let mut done: Vec<(Arc<Texture>, Arc<Texture>)> = Vec::new();
    let mut half = |texture: &mut Option<Arc<Texture>>| {
        let Some(whole) = texture else { return };
        let known = done.iter().find(|(before, _)| Arc::ptr_eq(before, whole));
        let smaller = known.map_or_else(|| Arc::new(halved(whole)), |(_, after)| Arc::clone(after));
        if known.is_none() {
            done.push((Arc::clone(whole), Arc::clone(&smaller)));
        }
        *whole = smaller;
    };
    // The size of an impostor is set by the user, and the alpha of its normals is depth.
    for material in models.flat_map(|m| &mut m.materials).filter(|m| m.impostor.is_none()) {
        half(&mut material.texture);
        half(&mut material.maps.normal);
        half(&mut material.maps.orm);
        half(&mut material.maps.through);
    }
}

/// Returns a texture of half the sides: each pixel is the mean of four, with colours weighted by their coverage.
fn halved(texture: &Texture) -> Texture {
    let (width, height) = (texture.width.div_ceil(2).max(1), texture.height.div_ceil(2).max(1));
    let mut pixels = Vec::with_capacity(4 * width as usize * height as usize);
    for y in 0..height {
        for x in 0..width {
            let (mut sum, mut cover) = ([0_u32; 3], 0_u32);
            for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                let (x, y) = ((2 * x + dx).min(texture.width - 1), (2 * y + dy).min(texture.height - 1));
                let at = 4 * (y as usize * texture.width as usize + x as usize);
                let Some(&[r, g, b, a]) = texture.pixels.get(at..at + 4) else { continue };
                let a = u32::from(a);
                cover += a;
                for (sum, c) in sum.iter_mut().zip([r, g, b]) {
                    *sum += u32::from(c) * a.max(1);
                }
            }
            let weight = cover.max(4);
            #[expect(clippy::cast_possible_truncation, reason = "means of bytes")]
            pixels.extend(sum.map(|s| (s / weight).min(255) as u8).into_iter().chain([(cover / 4) as u8]));
        }
    }
    Texture { width, height, pixels }
}
