//! Levels of detail of any plant, and what else is exported with it.
//!
//! `plant, its finest meshes -> coarser plants -> meshes of at most half the triangles each -> copies, impostor`

use std::sync::Arc;

use base::{Cancelled, Run, Stopped};
use mesh::{Copies, Model, Texture};
use plant::{AxisKind, OrganKind, Plant};
use skin::{Layout, SkinSpec};

use crate::lod::coarser;

/// A model, and the plant that it is of with what of it lies where in the model.
pub(crate) type LaidOut = (Model, (Plant, Layout));

/// What is exported of a plant besides its finest meshes, of whatever maker.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LevelSpec {
    /// Coarser copies, at most 6. Default 0.
    pub lods: u32,
    /// Also take leaves that are one form out of each level ([`skin::copies`]). Default false.
    pub copies: bool,
    /// One more level, the last: views from all sides in an atlas of so many pixels a side, 128 to 4096 ([`render::impostor`]).
    /// Default none.
    pub impostor: Option<u32>,
}

/// The coarser copies of a plant, the finest first.
#[derive(Clone, Debug, Default)]
pub struct Levels {
    /// Their meshes; the impostor is the last.
    pub lods: Vec<Model>,
    /// Of the plant and of each of `lods`, what is left without leaves that are one form, and these. Empty unless they are
    /// asked for.
    pub copies: Vec<(Model, Vec<Copies>)>,
}

impl Levels {
    /// Makes them: `finest` is the plant as it is, `at` gives one of its levels, 1 to 6.
    pub(crate) fn new<E: From<Cancelled>>(
        spec: &LevelSpec,
        (model, plant, layout): (&Model, &Plant, &Layout),
        mut at: impl FnMut(u32) -> Result<Option<LaidOut>, E>,
        run: &Run<'_>,
    ) -> Result<Self, E> {
        let mut levels = Self::default();
        if spec.copies {
            levels.copies.push(skin::copies(plant, model, layout));
        }
        for level in 1..=spec.lods.min(6) {
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

/// A plant of fewer axes and leaves than these keeps all of them at every level: each of them is seen.
const FEW_AXES: usize = 100;
const FEW_LEAVES: usize = 300;
/// A level is meshed again, coarser, so many times at most until it has at most half of the triangles of the one before.
const TRIES: u32 = 5;
/// A further try aims at this share of the triangles that a level may have, because meshes have no exact number of them.
const AIM: f64 = 0.9;

/// A plant at level `level` (1 to 6) with the materials of `fine`, its finest meshes, which `skin` describes.
///
/// Guaranteed: each level has at most half of the triangles of the one before, unless every part of it is as coarse as a part
/// can be. Many leaves and axes become fewer ([`coarser`]); of few, and of flowers, each part becomes coarser. Cost: that of
/// meshing the finer levels, too.
pub(crate) fn level_of(
    plant: &Plant,
    (skin, fine): (&SkinSpec, &Model),
    level: u32,
    mesh: impl Fn(&Plant, &SkinSpec) -> Result<(Model, Layout), Stopped>,
) -> Result<LaidOut, Stopped> {
    let mut last = Coarse::of_finest(fine);
    let mut made = next_level((plant, skin, fine), 1, &mut last, &mesh)?;
    for at in 2..=level.min(6) {
        made = next_level((plant, skin, fine), at, &mut last, &mesh)?;
    }
    Ok(made)
}

/// Levels 1 to `count` (at most 6) as [`level_of`] makes each. Cost: that of meshing each once.
pub(crate) fn levels_of(
    plant: &Plant,
    (skin, fine): (&SkinSpec, &Model),
    count: u32,
    mesh: impl Fn(&Plant, &SkinSpec) -> Result<(Model, Layout), Stopped>,
) -> Result<Vec<LaidOut>, Stopped> {
    let mut last = Coarse::of_finest(fine);
    (1..=count.min(6)).map(|level| next_level((plant, skin, fine), level, &mut last, &mesh)).collect()
}

/// What a level leaves to the next.
struct Coarse {
    /// Triangles that the next one may have.
    most: usize,
    /// How much coarser than by rule its parts are: a factor of their fineness.
    detail: f64,
}

impl Coarse {
    fn of_finest(fine: &Model) -> Self {
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
    // Cards of leaves have textures of their own.
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

/// How large what is written of a plant may be.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Allowance {
    /// Triangles of the model. Default any.
    pub triangles: Option<u64>,
    /// Bytes of its files. Default any.
    pub bytes: Option<u64>,
}

/// A plant that is as large as it may be.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// What is the model now.
    pub model: Model,
    /// Its coarser copies.
    pub levels: Levels,
    /// The level of detail that the model is, 0 for the finest.
    pub level: usize,
    /// How often the sides of its textures were halved.
    pub halvings: u32,
}

impl Fitted {
    /// What became of the plant, in words; none if it is as it was.
    pub fn line(&self) -> Option<String> {
        let level = (self.level > 0).then(|| format!("the model is level of detail {}", self.level));
        let textures = (self.halvings > 0).then(|| {
            format!("textures have a {} of their sides", ["half", "quarter"][self.halvings as usize - 1])
        });
        let parts: Vec<String> = level.into_iter().chain(textures).collect();
        (!parts.is_empty()).then(|| format!("to keep within the budget, {}", parts.join(" and ")))
    }
}

/// Why a plant cannot be as small as it is to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum AllowanceError {
    /// Even its coarsest level has more triangles.
    #[error(
        "the plant has at least {least} triangles, at its coarsest level; allow as many, or make it coarser"
    )]
    Triangles {
        /// Those of the coarsest level.
        least: u64,
    },
    /// Even its coarsest level is larger.
    #[error(
        "the file has at least {:.3} megabytes, at the coarsest level and with the smallest textures; allow as many, or ask for \
         fewer levels in it",
        *least as f64 / 1e6
    )]
    Bytes {
        /// Those of the coarsest level.
        least: u64,
    },
}

/// Textures of a budget have sides halved so often at most: of 512 pixels, 128 are left.
const HALVINGS: u32 = 2;

impl Levels {
    /// The finest level that fits, as the model, with `lods` coarser ones, and the impostor if there is one. Of two that fit
    /// that with smaller textures comes before that with fewer triangles. `weigh` says how many bytes a model takes.
    ///
    /// # Errors
    /// Those of `weigh`; inside, [`AllowanceError`] with the least that there can be.
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
            let mut kept = Self { lods: self.lods[level + 1..last].to_vec(), copies };
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

/// Halves the sides of all textures, each once: those that are one stay one.
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
    // The size of an impostor is asked for, and depth stands in the alpha of its normals.
    for material in models.flat_map(|m| &mut m.materials).filter(|m| m.impostor.is_none()) {
        half(&mut material.texture);
        half(&mut material.maps.normal);
        half(&mut material.maps.orm);
        half(&mut material.maps.through);
    }
}

/// A texture of half the sides: each pixel is the mean of four, colours by how much they cover.
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
