//! Kinds of surface: their materials, and the parts that gather them.

use std::borrow::Cow;
use std::sync::Arc;

use base::{Cancelled, Executor, Run};
use glam::DVec2;
use mesh::{AlphaMode, Material, MaterialId, MaterialKind, Model, Part, Texture, TriMesh};
use plant::{Blade, Lift, OrganKind, Paint, Plant, Relief, Shape, ShapeId};

use crate::coloured::is_coloured;
use crate::layout::{Layout, Piece};
use crate::pictures::SurfacePictures;
use crate::texture::{
    GREEN, LEAF_ROUGHNESS, LeafInks, Leafage, Motif, PALE_GREEN, PALE_PETAL, Surface, any_blade, atlas, bark,
    leaf, paint_material, painted_material, petal_inks, petals,
};
use crate::{BarkSpec, Cloth, PetalColor, SkinSpec, VeinPattern, Wearer, Worn};

/// Kind of surface; one part and one material each, in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Slot {
    Bark,
    YoungBark,
    /// Wood without bark, in vertex colours.
    DeadWood,
    Stem,
    Root,
    Leaf(Coat),
    /// Leaves that are shoots in needles.
    Needles(Coat),
    /// Measured leaves of one form, which may have a texture of its own.
    Form(u32, Coat),
    /// Veins of measured leaves.
    Veins,
    /// In the natural colour of the plant's petals.
    Petal(Coat, PetalColor),
    Sepal(Coat),
    Disc(Coat),
    Fruit(Coat),
    /// A fruit with eyes, in the colour of a pineapple.
    Syncarp,
    Body,
    /// In the colour of its clay.
    Pot,
    Stamen(Coat),
    Thorn,
    /// In the colours of the photograph over which it was traced.
    Traced(MaterialKind),
    /// In a material that a user chose: a row of [`crate::Worn::cloths`].
    Worn(Wearer, usize),
}

/// Source of the colour of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Coat {
    Natural,
    /// Vertex colours over a texture without a hue.
    Tinted,
    /// Vertex colours that differ over the surface, and no texture.
    Own,
    /// As tinted, but drawn in colour by the user; it has a part of its own.
    Drawn,
}

impl Coat {
    pub(crate) fn choose(paint: Paint, shape: &Shape) -> Self {
        match paint {
            _ if matches!(shape, Shape::Sheet(s) if !s.colors.is_empty()) => Self::Own,
            Paint::Natural(_) => Self::Natural,
            Paint::Tinted(_) => Self::Tinted,
            Paint::Drawn(_) => Self::Drawn,
        }
    }
}

impl Slot {
    /// Returns the same surface in the colours of a photograph, where branches and twigs are one.
    pub(crate) fn traced(self) -> Self {
        match self.kind() {
            MaterialKind::YoungBark => Self::Traced(MaterialKind::Bark),
            kind => Self::Traced(kind),
        }
    }

    fn kind(self) -> MaterialKind {
        match self {
            Self::Traced(kind) => kind,
            Self::Worn(Wearer::Leaf, _) => MaterialKind::Leaf,
            Self::Worn(Wearer::Petal | Wearer::Sepal, _) => MaterialKind::Petal,
            Self::Bark | Self::DeadWood => MaterialKind::Bark,
            Self::YoungBark => MaterialKind::YoungBark,
            Self::Stem | Self::Body | Self::Thorn => MaterialKind::Stem,
            Self::Root => MaterialKind::Root,
            Self::Leaf(_) | Self::Needles(_) | Self::Form(..) | Self::Veins => MaterialKind::Leaf,
            Self::Petal(..) | Self::Sepal(_) => MaterialKind::Petal,
            Self::Disc(_) => MaterialKind::Disc,
            Self::Fruit(_) | Self::Syncarp => MaterialKind::Fruit,
            Self::Stamen(_) => MaterialKind::Stamen,
            Self::Pot => MaterialKind::Other,
        }
    }

    /// Returns the names of the part and of its material.
    fn names(self, worn: &Worn) -> (Cow<'static, str>, String) {
        let (part, material) = match self {
            Self::Worn(wearer, row) => {
                let material = worn.name(wearer, row);
                let rest = material.strip_prefix(wearer.word()).unwrap_or_default();
                return (format!("{}{rest}", wearer.words()).into(), material);
            }
            Self::Form(0, _) => ("leaves", "leaf".into()),
            Self::Form(k, _) => return (format!("leaves-{}", k + 1).into(), format!("leaf-{}", k + 1)),
            Self::Veins => ("veins", "leaf-veins".into()),
            Self::Bark => ("branches", "bark".into()),
            Self::YoungBark => ("twigs", "bark-young".into()),
            Self::DeadWood => ("dead-wood", "dead-wood".into()),
            Self::Stem => ("stems", "stem".into()),
            Self::Root => ("roots", "root".into()),
            Self::Leaf(Coat::Drawn) => ("leaves-drawn", "leaf-drawn".into()),
            Self::Leaf(_) => ("leaves", "leaf".into()),
            Self::Needles(Coat::Drawn) => ("needles-drawn", "needles-drawn".into()),
            Self::Needles(_) => ("needles", "needles".into()),
            Self::Petal(Coat::Natural, color) => ("petals", format!("petal-{}", color.word())),
            Self::Petal(Coat::Tinted | Coat::Own, _) => ("petals", "petal".into()),
            Self::Petal(Coat::Drawn, _) => ("petals-drawn", "petal-drawn".into()),
            Self::Sepal(_) => ("sepals", "sepal".into()),
            Self::Disc(Coat::Drawn) => ("discs-drawn", "disc-drawn".into()),
            Self::Disc(_) => ("discs", "disc".into()),
            Self::Fruit(Coat::Drawn) => ("fruits-drawn", "fruit-drawn".into()),
            Self::Fruit(_) => ("fruits", "fruit".into()),
            Self::Syncarp => ("fruits-with-eyes", "fruit-with-eyes".into()),
            Self::Body => ("bodies", "body".into()),
            Self::Pot => ("pots", "pot".into()),
            Self::Stamen(_) => ("stamens", "stamen".into()),
            Self::Thorn => ("thorns", "thorn".into()),
            Self::Traced(kind) => {
                let part = match kind {
                    MaterialKind::Bark | MaterialKind::YoungBark => "branches-traced",
                    MaterialKind::Stem => "stems-traced",
                    MaterialKind::Leaf => "leaves-traced",
                    MaterialKind::Petal => "petals-traced",
                    MaterialKind::Disc => "discs-traced",
                    MaterialKind::Fruit => "fruits-traced",
                    MaterialKind::Root => "roots-traced",
                    MaterialKind::Stamen => "stamens-traced",
                    MaterialKind::Other => "others-traced",
                };
                (part, format!("{}-traced", kind.word()))
            }
        };
        (part.into(), material)
    }

    /// Returns its texture; `None` if it has none of its own, or one with relief.
    fn motif(self) -> Option<Motif> {
        Some(match self {
            Self::Form(..) | Self::Veins | Self::Sepal(_) | Self::Worn(..) | Self::Traced(_) => return None,
            Self::Stamen(coat) if coat != Coat::Natural => return None,
            Self::Bark
            | Self::YoungBark
            | Self::DeadWood
            | Self::Leaf(_)
            | Self::Needles(_)
            | Self::Petal(..) => return None,
            // Florets of a disc are organs of their own.
            Self::Disc(Coat::Own | Coat::Tinted) => return None,
            Self::Stem => Motif::Stem,
            Self::Root => Motif::Root,
            Self::Disc(Coat::Natural) => Motif::Disc,
            Self::Disc(_) => Motif::PaleDisc,
            Self::Fruit(Coat::Natural) => Motif::Fruit,
            Self::Fruit(_) => Motif::PaleFruit,
            Self::Syncarp => Motif::Eyes,
            Self::Body => Motif::Body,
            Self::Pot => Motif::Clay,
            Self::Stamen(_) => Motif::Stamen,
            Self::Thorn => Motif::Thorn,
        })
    }

    /// Returns its colour with relief; `None` if it has no relief. `old`: the plant has old bark, so that young bark is
    /// of twigs.
    fn surface(
        self,
        spec: &SkinSpec,
        plant: &Plant,
        old: bool,
        run: &Run<'_>,
    ) -> Result<Option<Surface>, Cancelled> {
        let size = spec.texture_size.clamp(64, 4096);
        let leaves = |inks: &LeafInks, needled: bool| {
            let venation = if needled { Some(VeinPattern::Needle) } else { spec.venation };
            let mut leaves = plant.organs.iter().filter(|o| o.kind == OrganKind::Leaf);
            let own = leaves.find_map(|o| blade(plant, o.shape).filter(|b| b.needles.is_some() == needled));
            if spec.cards(needled) {
                let shoots = spec.shoots(needled);
                let shown = shoots.map(|s| &s.leaf).or(own).cloned();
                let what = Leafage {
                    venation: venation.unwrap_or(VeinPattern::Pinnate),
                    leaf: &shown.unwrap_or_else(any_blade),
                    shoots,
                    inks,
                    wood: spec.bark.unwrap_or_default().kind_and_colour(true).1.srgb(),
                };
                return atlas(&what, size, run);
            }
            match venation {
                Some(venation) => leaf(venation, &own.cloned().unwrap_or_else(any_blade), inks, size, run),
                None => leaf(VeinPattern::Pinnate, &veined(plant), inks, size, run),
            }
        };
        let painted = match self {
            Self::Bark | Self::YoungBark => {
                let twig = old && self == Self::YoungBark;
                let (kind, colour) = spec.bark.unwrap_or_default().kind_and_colour(twig);
                bark(kind, colour.srgb(), if twig { size / 2 } else { size }, run)
            }
            Self::Leaf(Coat::Natural) => leaves(&GREEN, false),
            Self::Leaf(Coat::Tinted | Coat::Drawn) => leaves(&PALE_GREEN, false),
            Self::Needles(Coat::Natural) => leaves(&GREEN, true),
            Self::Needles(Coat::Tinted | Coat::Drawn) => leaves(&PALE_GREEN, true),
            Self::Petal(Coat::Natural, color) => petals(&petal_inks(color), size / 2, run),
            Self::Petal(Coat::Tinted | Coat::Drawn, _) => petals(&PALE_PETAL, size / 2, run),
            _ => return Ok(None),
        };
        painted.map(Some)
    }

    /// Returns the linear colour that replaces the texture if none is requested: its mean.
    fn plain_color(self) -> [f32; 3] {
        match self {
            Self::Bark => [0.126, 0.084, 0.055],
            Self::YoungBark => [0.13, 0.095, 0.055],
            Self::DeadWood => [0.16, 0.115, 0.075],
            Self::Stem => [0.111, 0.223, 0.034],
            Self::Root => [0.27, 0.168, 0.092],
            Self::Leaf(Coat::Natural) | Self::Needles(Coat::Natural) | Self::Form(_, Coat::Natural) => {
                [0.051, 0.149, 0.018]
            }
            Self::Petal(Coat::Natural, color) => color.linear(),
            Self::Disc(Coat::Natural) => [0.55, 0.25, 0.02],
            Self::Fruit(Coat::Natural) => [0.56, 0.06, 0.02],
            Self::Syncarp => [0.36, 0.22, 0.05],
            Self::Body => [0.06, 0.16, 0.05],
            Self::Stamen(Coat::Natural) => [0.72, 0.55, 0.15],
            Self::Thorn => [0.28, 0.16, 0.08],
            Self::Veins => [0.44, 0.52, 0.18],
            Self::Leaf(_)
            | Self::Needles(_)
            | Self::Form(..)
            | Self::Petal(..)
            | Self::Sepal(_)
            | Self::Stamen(_)
            | Self::Disc(_)
            | Self::Fruit(_)
            | Self::Pot
            | Self::Worn(..)
            | Self::Traced(_) => [1.0; 3],
        }
    }

    /// Returns the colour that the plant's maker gave it.
    fn known_color(self, plant: &Plant, spec: &SkinSpec, old: bool) -> Option<[f32; 3]> {
        match self {
            Self::Bark | Self::YoungBark if !spec.textures => {
                #[expect(clippy::cast_possible_truncation, reason = "a colour")]
                let plain = |b: BarkSpec| {
                    b.kind_and_colour(old && self == Self::YoungBark).1.linear().map(|x| x as f32)
                };
                spec.bark.map(plain)
            }
            // The colours of its axes are in the mesh.
            Self::Stem | Self::Body if is_coloured(plant) => Some([1.0; 3]),
            Self::Stem => plant.paint.stem,
            Self::Veins => plant.paint.veins,
            _ => None,
        }
    }

    fn material(
        self,
        (spec, pictures): (&SkinSpec, SurfacePictures<'_>),
        plant: &Plant,
        old: bool,
        run: &Run<'_>,
    ) -> Result<Material, Cancelled> {
        let textures = spec.textures.then_some(run.executor);
        let (kind, known) = (self.kind(), self.known_color(plant, spec, old));
        let mut m = Material::plain(self.names(&spec.worn).1, kind, [1.0; 3]);
        m.double_sided = matches!(kind, MaterialKind::Leaf | MaterialKind::Petal);
        if let Self::Worn(_, row) = self {
            let painted = spec.textures || spec.worn.always;
            if let Some(cloth) = spec.worn.cloths.get(row) {
                cloth.dress(&mut m, painted, run.executor);
            }
            return Ok(m);
        }
        m.texture = match self {
            Self::Traced(_) => pictures.traced.map(|t| Arc::clone(&t.texture)),
            Self::Form(form, _) => pictures.leaves.get(form as usize).cloned().flatten(),
            _ if known.is_some() => None,
            _ => textures.zip(self.motif()).map(|(executor, motif)| motif.texture(executor)),
        };
        let relief = if spec.textures { self.surface(spec, plant, old, run)? } else { None };
        if m.texture.is_none() {
            m.base_color = known.unwrap_or_else(|| self.plain_color());
        }
        (m.roughness, m.translucency) = match kind {
            // Measured veins are solid.
            _ if self == Self::Veins => (0.65, 0.0),
            _ if self == Self::Syncarp => (0.8, 0.0),
            MaterialKind::Leaf => (0.55, 0.4),
            MaterialKind::Petal => (0.65, 0.4),
            MaterialKind::Stem => (0.65, 0.0),
            MaterialKind::Fruit => (0.35, 0.0),
            MaterialKind::Stamen | MaterialKind::Disc => (0.8, 0.0),
            _ => (0.95, 0.0),
        };
        if let Some(Surface { color, maps }) = relief {
            (m.texture, m.maps, m.base_color) = (Some(color), maps, [1.0; 3]);
            // The map determines the roughness of the rest.
            m.roughness = if m.double_sided { LEAF_ROUGHNESS } else { 1.0 };
            let cards = match self {
                Self::Leaf(_) => spec.cards(false),
                Self::Needles(_) => spec.cards(true),
                _ => false,
            };
            if cards {
                m.alpha = AlphaMode::Mask;
            }
        }
        Ok(m)
    }
}

/// Returns the leaf with the most drawn veins, from which all leaves of a plant have their surface: a species has one
/// venation. A single vein is a fold or a shade. At length 1 and in invisibly small steps, so that it is the same
/// surface when the plant has grown by a line.
fn veined(plant: &Plant) -> Blade {
    const FEWEST: usize = 2;
    const STEPS: f64 = 4096.0;
    let leaves = plant.organs.iter().filter(|o| o.kind == OrganKind::Leaf);
    let blades = leaves.filter_map(|o| blade(plant, o.shape)).filter(|b| b.needles.is_none());
    // Among several keep the first.
    let most = blades.fold(None, |most: Option<&Blade>, b| {
        let more = b.veins.len() > most.map_or(FEWEST - 1, |m| m.veins.len());
        if more { Some(b) } else { most }
    });
    let Some(most) = most.filter(|b| b.length() > 0.0) else { return any_blade() };
    let even = |p: &mut DVec2| *p = (*p * (STEPS / most.length())).round() / STEPS;
    let mut leaf = Blade { relief: Relief::default(), lift: Lift::Flat, ..most.clone() };
    leaf.outline.iter_mut().chain(&mut leaf.midrib).for_each(even);
    leaf.veins.iter_mut().flat_map(|v| &mut v.line).for_each(even);
    leaf
}

/// Returns the blade of a shape that is one.
fn blade(plant: &Plant, shape: ShapeId) -> Option<&Blade> {
    match plant.shapes.get(shape.index()) {
        Some(Shape::Blade(blade)) => Some(blade),
        _ => None,
    }
}

impl Cloth {
    /// Applies it to a material of a blade; without `painted` in its mean colour.
    fn dress(&self, m: &mut Material, painted: bool, executor: &dyn Executor) {
        #[expect(clippy::cast_possible_truncation, reason = "0 to 1")]
        let roughness = self.material.roughness.clamp(0.0, 1.0) as f32;
        // Glossy and velvety blades alike transmit light.
        (m.roughness, m.translucency) = (roughness, 0.4);
        let picture = self.picture.as_ref();
        if painted {
            let own = || painted_material(&self.material, executor);
            m.texture = Some(picture.map_or_else(own, Arc::clone));
            let holes = picture.is_some_and(|t| t.pixels.chunks_exact(4).any(|p| p[3] < 128));
            m.alpha = if holes { AlphaMode::Mask } else { AlphaMode::Opaque };
        } else {
            let small = || Arc::new(paint_material(&self.material, (16, 32), executor));
            m.base_color = mean(&picture.map_or_else(small, Arc::clone));
        }
    }
}

/// Returns the mean of the visible part of a texture, linear.
fn mean(texture: &Texture) -> [f32; 3] {
    let seen = || texture.pixels.chunks_exact(4).filter(|p| p[3] >= 128);
    #[expect(clippy::cast_precision_loss, reason = "counts far below 2^52")]
    let count = seen().count().max(1) as f64;
    #[expect(clippy::cast_possible_truncation, reason = "a colour")]
    [0, 1, 2].map(|k| (seen().map(|p| base::light_of_byte(p[k])).sum::<f64>() / count) as f32)
}

/// Collects meshes by slot, in slot order; empty ones leave no part. Textures are painted if they are requested. Also
/// returns the position of axes and organs in the parts.
pub(crate) fn model(
    plant: &Plant,
    mut meshes: Vec<(Slot, TriMesh, Vec<Piece>)>,
    spec: &SkinSpec,
    pictures: SurfacePictures<'_>,
    run: &Run<'_>,
) -> Result<(Model, Layout), Cancelled> {
    let mut model = Model { name: plant.name.clone(), ..Model::default() };
    let mut layout = Layout::default();
    meshes.retain(|(_, m, _)| !m.triangles.is_empty());
    // Stable: meshes of one slot keep their order.
    base::sort_by_key(&mut meshes, |(slot, ..)| *slot);
    let old = meshes.iter().any(|(slot, ..)| *slot == Slot::Bark);
    let mut rest = meshes.as_slice();
    while let Some(&(slot, ref first, _)) = rest.first() {
        let n = rest.iter().take_while(|(s, ..)| *s == slot).count();
        let (these, after) = rest.split_at(n);
        rest = after;
        run.cancel.check()?;
        let mesh = match these {
            [_] => first.clone(),
            _ => joined(these),
        };
        let material = MaterialId::new(model.materials.len());
        model.materials.push(slot.material((spec, pictures), plant, old, run)?);
        layout.push(these.iter().flat_map(|(_, _, pieces)| pieces));
        model.parts.push(Part { name: slot.names(&spec.worn).0.into_owned(), material, mesh });
    }
    Ok((model, layout))
}

fn joined(meshes: &[(Slot, TriMesh, Vec<Piece>)]) -> TriMesh {
    let mut all = TriMesh::default();
    let (vertices, triangles) =
        meshes.iter().fold((0, 0), |(v, t), (_, m, _)| (v + m.positions.len(), t + m.triangles.len()));
    all.positions.reserve_exact(vertices);
    all.normals.reserve_exact(vertices);
    all.uvs.reserve_exact(vertices);
    // A body may be tube or organ: tubes have no tint, so next to tinted meshes they are white.
    let tinted = meshes.iter().any(|(_, m, _)| !m.colors.is_empty());
    all.colors.reserve_exact(if tinted { vertices } else { 0 });
    all.triangles.reserve_exact(triangles);
    let blown = meshes.iter().any(|(_, m, _)| !m.wind.is_empty());
    all.wind.reserve_exact(if blown { vertices } else { 0 });
    all.pivots.reserve_exact(if blown { vertices } else { 0 });
    for (_, m, _) in meshes {
        all.append(m);
        if tinted {
            all.colors.resize(all.positions.len(), [1.0; 3]);
        }
    }
    all
}
