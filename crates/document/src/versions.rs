//! The structs of each version of `document.json`, and the conversion of a version to the next.

use std::sync::Arc;

use bloom::{FlowerSpec, GrowthLaw};
use glam::DVec2;
use growth::Obstacle;
use ink::{InkSample, Layer, Stroke, StrokeClass, StrokeMode};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use shape::HandEdit;
use sketch::SketchSpec;
use skin::{OrganMaterial, PetalColor, SkinSpec, Wear};

use crate::makers::{DEFAULT_DAY, DEFAULT_FLOWER};
use crate::state::is_width;
use crate::{DocumentStroke, PhotoPlace, SettingFault};

/// Version 7: as version 6, with groups of plants, branches that are turned while they are moved, and trees that are
/// scaled to a height. A program that
/// reads version 6 would reject the new field names.
pub(crate) type DocumentV7 = DocumentV6;

/// Version 6: as version 5, with materials of organs, layers, and widths of the pen. All of these may be left out, so
/// the structs of version 5 have them too.
pub(crate) type DocumentV6 = DocumentV5;

/// Version 5: as version 4, with the whole spec of a flower, and plants whose place is locked.
pub(crate) type DocumentV5 = DocumentV4<MakerV5>;

/// Version 4: as version 3, with hand edits.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct DocumentV4<M = MakerV3> {
    pub(crate) name: String,
    pub(crate) plants: Vec<PlantV4<M>>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct PlantV4<M> {
    pub(crate) name: String,
    pub(crate) seed: u64,
    #[serde(default, skip_serializing_if = "is_false")]
    pub(crate) locked: bool,
    #[serde(default, skip_serializing_if = "is_false")]
    pub(crate) fixed: bool,
    #[serde(default, skip_serializing_if = "is_false")]
    pub(crate) hidden: bool,
    /// From version 7 on.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub(crate) group: String,
    /// Position, metres.
    #[serde(default)]
    pub(crate) position: [f64; 3],
    #[serde(default)]
    pub(crate) yaw_deg: f64,
    #[serde(default = "one")]
    pub(crate) scale: f64,
    /// From version 6 on; for strokes, see [`StrokeV1::material`].
    #[serde(default, skip_serializing_if = "is_bare", deserialize_with = "spec::through_json::read")]
    pub(crate) wear: Wear,
    /// The names of its pictures `picture-NAME.png`; from version 6 on.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) pictures: Vec<String>,
    pub(crate) maker: M,
    /// In the order in which they are applied.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) edits: Vec<EditV4>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct EditV4 {
    #[serde(deserialize_with = "spec::through_json::read")]
    pub(crate) edit: HandEdit,
    #[serde(default, skip_serializing_if = "is_false")]
    pub(crate) off: bool,
}

impl TryFrom<DocumentV4> for DocumentV5 {
    /// A flower of an unknown species.
    type Error = SettingFault;

    fn try_from(v4: DocumentV4) -> Result<Self, SettingFault> {
        let plants = v4.plants.into_iter().map(|p| {
            let PlantV4 {
                name,
                seed,
                locked,
                fixed,
                hidden,
                group,
                position,
                yaw_deg,
                scale,
                wear,
                pictures,
                maker,
                edits,
            } = p;
            let maker = maker.try_into()?;
            Ok(PlantV4 {
                name,
                seed,
                locked,
                fixed,
                hidden,
                group,
                position,
                yaw_deg,
                scale,
                wear,
                pictures,
                maker,
                edits,
            })
        });
        Ok(Self { name: v4.name, plants: plants.collect::<Result<_, SettingFault>>()? })
    }
}

impl From<DocumentV3> for DocumentV4 {
    fn from(v3: DocumentV3) -> Self {
        let plants = v3.plants.into_iter().map(|p| {
            let PlantV3 { name, seed, locked, hidden, position, yaw_deg, scale, maker } = p;
            let (fixed, group) = (false, String::new());
            let (edits, wear, pictures) = (Vec::new(), Wear::default(), Vec::new());
            PlantV4 {
                name,
                seed,
                locked,
                fixed,
                hidden,
                group,
                position,
                yaw_deg,
                scale,
                wear,
                pictures,
                maker,
                edits,
            }
        });
        Self { name: v3.name, plants: plants.collect() }
    }
}

/// Version 3: a scene of plants.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct DocumentV3 {
    pub(crate) name: String,
    pub(crate) plants: Vec<PlantV3>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct PlantV3 {
    pub(crate) name: String,
    pub(crate) seed: u64,
    #[serde(default)]
    pub(crate) locked: bool,
    #[serde(default)]
    pub(crate) hidden: bool,
    #[serde(default)]
    pub(crate) position: [f64; 3],
    #[serde(default)]
    pub(crate) yaw_deg: f64,
    #[serde(default = "one")]
    pub(crate) scale: f64,
    pub(crate) maker: MakerV3,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde's signature")]
fn is_false(b: &bool) -> bool {
    !b
}

fn is_bare(wear: &Wear) -> bool {
    *wear == Wear::default()
}

fn one() -> f64 {
    1.0
}

/// Externally tagged: an internal tag would make the reader hold every point twice.
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[expect(clippy::large_enum_variant, reason = "one for each plant, and only while a file is read or written")]
pub(crate) enum MakerV5 {
    Sketch(SketchV3),
    Tree(TreeV3),
    Leaf(LeafV3),
    Flower(FlowerV5),
}

#[derive(Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum MakerV3 {
    Sketch(SketchV3),
    Tree(TreeV3),
    Leaf(LeafV3),
    Flower(FlowerV3),
}

impl TryFrom<MakerV3> for MakerV5 {
    type Error = SettingFault;

    fn try_from(v3: MakerV3) -> Result<Self, SettingFault> {
        Ok(match v3 {
            MakerV3::Sketch(sketch) => Self::Sketch(sketch),
            MakerV3::Tree(tree) => Self::Tree(tree),
            MakerV3::Leaf(leaf) => Self::Leaf(leaf),
            MakerV3::Flower(flower) => Self::Flower(flower.try_into()?),
        })
    }
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SketchV3 {
    #[serde(default, deserialize_with = "spec::through_json::read")]
    pub(crate) sketch: SketchSpec,
    #[serde(default)]
    pub(crate) skin: SkinV1,
    pub(crate) strokes: Vec<StrokeV1>,
    /// Layers from below upwards; from version 6 on.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) layers: Vec<Layer>,
    /// Place of `photo-ROW.png` under the drawing, with ROW the plant's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) photo: Option<PhotoPlace>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) day: Option<f64>,
    /// Row of the plant whose leaf it bears.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) leaf: Option<u32>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct TreeV3 {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) preset: Option<String>,
    pub(crate) spec: Value,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) obstacles: Vec<ObstacleV3>,
    /// From version 7 on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) height_m: Option<f64>,
    #[serde(default)]
    pub(crate) skin: SkinV1,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) leaf: Option<u32>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ObstacleV3 {
    pub(crate) name: String,
    #[serde(deserialize_with = "spec::through_json::read")]
    pub(crate) shape: Obstacle,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct LeafV3 {
    /// Name of the file of marks or veins; `text` is its text.
    pub(crate) file: String,
    pub(crate) data: String,
    #[serde(default, deserialize_with = "spec::through_json::read")]
    pub(crate) settings: leaf::LeafSpec,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct FlowerV5 {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) preset: Option<String>,
    #[serde(deserialize_with = "spec::through_json::read")]
    pub(crate) spec: FlowerSpec,
    pub(crate) day: f64,
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "spec::through_json::read")]
    pub(crate) law: Option<GrowthLaw>,
}

/// A species by name, with the settings that differ from it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct FlowerV3 {
    #[serde(default, deserialize_with = "spec::through_json::read")]
    settings: FlowerSettingsV3,
    #[serde(default, deserialize_with = "spec::through_json::read")]
    law: Option<GrowthLaw>,
}

#[derive(Deserialize)]
#[serde(default, deny_unknown_fields)]
struct FlowerSettingsV3 {
    species: String,
    day: f64,
    opening_days: Option<f64>,
    wilting_days: Option<f64>,
    stalk_m: Option<f64>,
    nod_deg: Option<f64>,
}

impl Default for FlowerSettingsV3 {
    fn default() -> Self {
        let (species, day) = (DEFAULT_FLOWER.into(), DEFAULT_DAY);
        Self { species, day, opening_days: None, wilting_days: None, stalk_m: None, nod_deg: None }
    }
}

impl TryFrom<FlowerV3> for FlowerV5 {
    type Error = SettingFault;

    fn try_from(v3: FlowerV3) -> Result<Self, SettingFault> {
        let FlowerV3 { settings: old, law } = v3;
        let unknown = || SettingFault::Flower { name: base::quoted(&old.species).to_string() };
        let own = bloom::preset(&old.species).ok_or_else(unknown)?;
        let spec = FlowerSpec {
            opening_days: old.opening_days.unwrap_or(own.opening_days),
            wilting_days: old.wilting_days.unwrap_or(own.wilting_days),
            stalk_m: old.stalk_m.unwrap_or(own.stalk_m),
            nod_deg: old.nod_deg.unwrap_or(own.nod_deg),
            ..own
        };
        Ok(Self { preset: Some(old.species), spec, day: old.day, law })
    }
}

impl From<DocumentV2> for DocumentV3 {
    fn from(v2: DocumentV2) -> Self {
        let DocumentV2 { name, seed, sketch, skin, strokes, photo } = v2;
        let maker = MakerV3::Sketch(SketchV3 {
            sketch,
            skin,
            strokes,
            layers: Vec::new(),
            photo,
            day: None,
            leaf: None,
        });
        let plant = PlantV3 {
            name: name.clone(),
            seed,
            locked: false,
            hidden: false,
            position: [0.0; 3],
            yaw_deg: 0.0,
            scale: 1.0,
            maker,
        };
        Self { name, plants: vec![plant] }
    }
}

/// Version 2: as version 1, with a photograph.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct DocumentV2 {
    pub(crate) name: String,
    pub(crate) seed: u64,
    #[serde(default, deserialize_with = "spec::through_json::read")]
    pub(crate) sketch: SketchSpec,
    #[serde(default)]
    pub(crate) skin: SkinV1,
    pub(crate) strokes: Vec<StrokeV1>,
    #[serde(default)]
    pub(crate) photo: Option<PhotoPlace>,
}

impl From<DocumentV1> for DocumentV2 {
    fn from(v1: DocumentV1) -> Self {
        let DocumentV1 { name, seed, sketch, skin, strokes } = v1;
        Self { name, seed, sketch, skin, strokes, photo: None }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct DocumentV1 {
    pub(crate) name: String,
    pub(crate) seed: u64,
    #[serde(default, deserialize_with = "spec::through_json::read")]
    pub(crate) sketch: SketchSpec,
    #[serde(default)]
    pub(crate) skin: SkinV1,
    pub(crate) strokes: Vec<StrokeV1>,
}

#[derive(Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct SkinV1 {
    pub(crate) detail: f64,
    pub(crate) sides: u32,
    pub(crate) textures: bool,
    pub(crate) petals: Option<String>,
    pub(crate) variation: f64,
}

impl Default for SkinV1 {
    fn default() -> Self {
        Self::from(&SkinSpec::default())
    }
}

impl From<&SkinSpec> for SkinV1 {
    fn from(s: &SkinSpec) -> Self {
        Self {
            detail: s.detail,
            sides: s.sides,
            textures: s.textures,
            petals: s.petals.map(|p| p.word().into()),
            variation: s.variation,
        }
    }
}

/// Columns, because a stroke has hundreds of points.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct StrokeV1 {
    #[serde(default)]
    pub(crate) mode: StrokeMode,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) class: Option<StrokeClass>,
    /// Class in which it was shown when the last stroke was drawn.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) shown: Option<StrokeClass>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) color: Option<[u8; 3]>,
    /// From version 6 on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) width: Option<f64>,
    /// Name of its layer; from version 6 on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) layer: Option<Arc<str>>,
    /// From version 6 on.
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "spec::through_json::read")]
    pub(crate) material: Option<OrganMaterial>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) id: Option<String>,
    pub(crate) x: Vec<f64>,
    pub(crate) y: Vec<f64>,
    /// Milliseconds; empty if unknown for all.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) t: Vec<Option<f64>>,
    /// Pressure 0 to 1; empty if unknown for all.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) p: Vec<Option<f64>>,
}

impl SkinV1 {
    /// # Errors
    /// [`SettingFault::Petals`].
    pub(crate) fn spec(self) -> Result<SkinSpec, SettingFault> {
        let petals = match self.petals.as_deref() {
            None => None,
            Some(word) => Some(PetalColor::from_word(word).ok_or_else(|| {
                let known = PetalColor::ALL.map(PetalColor::word).join(", ");
                SettingFault::Petals { word: word.into(), known }
            })?),
        };
        let Self { detail, sides, textures, variation, .. } = self;
        Ok(SkinSpec { detail, sides, textures, petals, variation, ..SkinSpec::default() })
    }
}

pub(crate) fn to_file(s: &DocumentStroke) -> StrokeV1 {
    let samples = &s.stroke.samples;
    let column = |of: fn(&InkSample) -> Option<f64>| -> Vec<Option<f64>> {
        if samples.iter().any(|p| of(p).is_some()) { samples.iter().map(of).collect() } else { Vec::new() }
    };
    StrokeV1 {
        mode: s.stroke.mode,
        class: s.class,
        shown: s.shown,
        color: s.stroke.color,
        width: s.stroke.width,
        layer: s.stroke.layer.clone(),
        material: s.material.as_deref().cloned(),
        id: s.stroke.id.clone(),
        x: samples.iter().map(|p| p.at.x).collect(),
        y: samples.iter().map(|p| p.at.y).collect(),
        t: column(|p| p.time_ms),
        p: column(|p| p.pressure),
    }
}

pub(crate) fn from_file(s: StrokeV1) -> Result<Stroke, &'static str> {
    let n = s.x.len();
    if n == 0 {
        return Err("it has no point; erase it");
    }
    if s.y.len() != n || ![0, n].contains(&s.t.len()) || ![0, n].contains(&s.p.len()) {
        return Err("its columns x, y, t and p are not of one length; the file is damaged");
    }
    let cell = |column: &[Option<f64>], i: usize| column.get(i).copied().flatten();
    let samples: Vec<InkSample> = (0..n)
        .map(|i| InkSample {
            at: DVec2::new(s.x[i], s.y[i]),
            time_ms: cell(&s.t, i),
            pressure: cell(&s.p, i),
        })
        .collect();
    if samples.iter().any(|p| !p.at.is_finite()) {
        return Err("a point is not finite; the file is damaged");
    }
    if s.width.is_some_and(|w| !is_width(w)) {
        return Err("its width is none; the file is damaged");
    }
    Ok(Stroke {
        samples,
        mode: s.mode,
        color: s.color,
        width: s.width,
        layer: s.layer,
        hidden: false,
        id: s.id,
    })
}
