//! What travels between worker and session as JSON, and the same as TypeScript types.

use burgeon::ItemReport;
use burgeon::document::{Command, Photo};
use burgeon::glam::DVec2;
use burgeon::sketch::{SketchSpec, StrokeClass, StrokeMode};
use burgeon::skin::{PetalColor, SkinSpec};
use burgeon::{Seed, Unit, UpAxis, document::StrokeId, formats::ExportSpec};
use serde::{Deserialize, Serialize};
use wasm_bindgen::prelude::*;

#[wasm_bindgen(typescript_custom_section)]
const TYPES: &str = r#"
export type StrokeClass = "blade" | "corolla" | "axis" | "trunk_outline" | "crown" | "vein" | "disc" | "pot" | "ground"
  | "fruit" | "scribble" | "other";
export type StrokeMode = "parts" | "branch-contour" | "leaf-contour";
export type PetalColor = "pink" | "white" | "yellow" | "violet" | "red" | "orange" | "blue" | "magenta";
export interface SketchSpec {
  height_m: number | null; branch_depth: "paper" | "riesz"; leaf_depth: "paper" | "signed" | "drawn";
  flipped_flowers: number[]; pipe_exponent: number | null;
  taper: { s: number; alpha: number; m: number };
  fill: { contour_pull: number; bearer_pull: number; memory: number; density: number; tropism: number };
  relief: { petal_bend_a: number; petal_bend_b: number; petal_hollow: number; leaf_bend_a: number; leaf_bend_b: number;
    leaf_fold: number };
  phototropism: number; gravity: number;
}
export interface Skin { detail: number; sides: number; textures: boolean; petals: PetalColor | null; variation: number }
export type Command =
  | { do: "remove"; ids: number[] } | { do: "move"; ids: number[]; x: number; y: number }
  | { do: "class"; ids: number[]; class: StrokeClass | null } | { do: "mode"; ids: number[]; mode: StrokeMode }
  | { do: "color"; ids: number[]; color: [number, number, number] | null } | { do: "clear" } | { do: "new" }
  | { do: "duplicate"; ids: number[]; x: number; y: number }
  | { do: "photo"; x: number; y: number; width: number; opacity: number; paint: boolean } | { do: "photo-off" }
  | { do: "rename"; name: string } | { do: "seed"; seed: string } | { do: "sketch"; spec: SketchSpec }
  | { do: "skin"; skin: Skin };
export interface StrokeState { id: number; mode: StrokeMode; class: StrokeClass | null; color: [number, number, number] | null }
export interface DocumentState {
  revision: number; undo: string | null; redo: string | null; steps: number; name: string; seed: string;
  sketch: SketchSpec; skin: Skin; strokes: StrokeState[]; photo: PhotoState | null;
}
export interface PhotoState {
  x: number; y: number; width: number; height: number; opacity: number; paint: boolean; pixels: [number, number];
}
export interface ExportOptions { levels: number; up: "y" | "z"; unit: "m" | "cm" | "mm" }
export interface Opened { kind: "project" | "drawing" | "model"; name: string; names: string[]; warnings: string[] }
export interface StrokeReport { index: number; class: StrokeClass; organ: string; confidence: number }
export interface Item {
  name: string; strokes: StrokeReport[];
  counts: { flowers: number; petals: number; leaves: number; branches: number; nodes: number; axes: number;
    vertices: number; triangles: number };
  timings_ms: { total: number } & Record<string, number>; fidelity: { reprojection_mean: number; reprojection_p95: number };
  digest: string; warnings: string[];
}
export interface MaterialView {
  name: string; kind: string; color: [number, number, number]; roughness: number; translucency: number; masked: boolean;
  two_sided: boolean; texture: { number: number; width: number; height: number } | null;
}
export interface View {
  revision: number; item: Item | null; stages: string[]; front: { metres_per_unit: number; x: number; y: number } | null;
  min: [number, number, number]; max: [number, number, number]; parts: { name: string; material: number }[];
  materials: MaterialView[];
}
"#;

/// A command as the page sends it.
#[derive(Debug, Deserialize)]
#[serde(tag = "do", rename_all = "kebab-case", deny_unknown_fields)]
pub(crate) enum WireCommand {
    Remove {
        ids: Vec<u32>,
    },
    Move {
        ids: Vec<u32>,
        x: f64,
        y: f64,
    },
    Class {
        ids: Vec<u32>,
        class: Option<StrokeClass>,
    },
    Mode {
        ids: Vec<u32>,
        mode: StrokeMode,
    },
    Color {
        ids: Vec<u32>,
        color: Option<[u8; 3]>,
    },
    Duplicate {
        ids: Vec<u32>,
        x: f64,
        y: f64,
    },
    /// How the photograph lies.
    Photo {
        x: f64,
        y: f64,
        width: f64,
        opacity: f64,
        paint: bool,
    },
    PhotoOff,
    /// An empty document in the place of this one.
    New,
    Clear,
    Rename {
        name: String,
    },
    Seed {
        seed: String,
    },
    Sketch {
        spec: Box<SketchSpec>,
    },
    Skin {
        skin: Skin,
    },
}

impl WireCommand {
    /// `photo`: the one that lies under the drawing now.
    pub(crate) fn command(self, photo: Option<&Photo>) -> Result<Command, String> {
        let ids = |ids: Vec<u32>| ids.into_iter().map(StrokeId).collect();
        Ok(match self {
            Self::Remove { ids: i } => Command::RemoveStrokes(ids(i)),
            Self::Move { ids: i, x, y } => Command::MoveStrokes(ids(i), DVec2::new(x, y)),
            Self::Class { ids: i, class } => Command::SetClass(ids(i), class),
            Self::Mode { ids: i, mode } => Command::SetMode(ids(i), mode),
            Self::Color { ids: i, color } => Command::SetColor(ids(i), color),
            Self::Duplicate { ids: i, x, y } => Command::Duplicate(ids(i), DVec2::new(x, y)),
            Self::Photo { x, y, width, opacity, paint } => {
                let mut photo = photo.cloned().ok_or("there is no photograph under the drawing")?;
                (photo.x, photo.y, photo.width) = (x, y, width);
                (photo.opacity, photo.paint) = (opacity, paint);
                Command::SetPhoto(Some(Box::new(photo)))
            }
            Self::PhotoOff => Command::SetPhoto(None),
            Self::New => Command::Open(Box::default()),
            Self::Clear => Command::Clear,
            Self::Rename { name } => Command::Rename(name),
            Self::Seed { seed } => {
                let number = seed.parse().ok().ok_or("the seed is a whole number from 0 to 2^64 - 1")?;
                Command::SetSeed(Seed::new(number))
            }
            Self::Sketch { spec } => Command::SetSketch(spec),
            Self::Skin { skin } => Command::SetSkin(skin.spec()?),
        })
    }
}

/// The skin's settings by their words.
#[derive(Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Skin {
    detail: f64,
    sides: u32,
    textures: bool,
    petals: Option<String>,
    variation: f64,
}

impl Skin {
    pub(crate) fn of(s: &SkinSpec) -> Self {
        Self {
            detail: s.detail,
            sides: s.sides,
            textures: s.textures,
            petals: s.petals.map(|p| p.word().into()),
            variation: s.variation,
        }
    }

    fn spec(self) -> Result<SkinSpec, String> {
        let Self { detail, sides, textures, petals, variation } = self;
        let color = |word: String| {
            let found = PetalColor::ALL.into_iter().find(|c| c.word() == word);
            found.ok_or_else(|| format!("the petal colour {word:?} is unknown"))
        };
        let petals = petals.map(color).transpose()?;
        Ok(SkinSpec { detail, sides, textures, petals, variation, ..SkinSpec::default() })
    }
}

#[derive(Debug, Serialize)]
pub(crate) struct StrokeState {
    pub(crate) id: u32,
    pub(crate) mode: StrokeMode,
    pub(crate) class: Option<StrokeClass>,
    pub(crate) color: Option<[u8; 3]>,
}

#[derive(Debug, Serialize)]
pub(crate) struct DocumentState<'a> {
    pub(crate) revision: u64,
    pub(crate) undo: Option<&'a str>,
    pub(crate) redo: Option<&'a str>,
    pub(crate) steps: usize,
    pub(crate) name: &'a str,
    /// As text: JavaScript's numbers hold 53 bits.
    pub(crate) seed: String,
    pub(crate) sketch: &'a SketchSpec,
    pub(crate) skin: Skin,
    pub(crate) strokes: Vec<StrokeState>,
    pub(crate) photo: Option<PhotoState>,
}

#[derive(Debug, Serialize)]
pub(crate) struct PhotoState {
    x: f64,
    y: f64,
    width: f64,
    height: f64,
    opacity: f64,
    paint: bool,
    pixels: (u32, u32),
}

impl PhotoState {
    pub(crate) fn of(p: &Photo) -> Self {
        let Photo { x, y, width, opacity, paint, .. } = *p;
        Self { x, y, width, height: p.height(), opacity, paint, pixels: p.size() }
    }
}

/// How a model is written.
#[derive(Debug, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct ExportOptions {
    /// Levels of detail, 1 to 4: each has about a third of the triangles of the one before.
    pub(crate) levels: u32,
    pub(crate) up: String,
    pub(crate) unit: String,
}

impl Default for ExportOptions {
    fn default() -> Self {
        Self { levels: 1, up: "y".into(), unit: "m".into() }
    }
}

impl ExportOptions {
    pub(crate) fn spec(&self) -> Result<ExportSpec, String> {
        let up = match self.up.as_str() {
            "y" => UpAxis::Y,
            "z" => UpAxis::Z,
            other => return Err(format!("up is y or z, not {other:?}")),
        };
        let unit = match self.unit.as_str() {
            "m" => Unit::Metre,
            "cm" => Unit::Centimetre,
            "mm" => Unit::Millimetre,
            other => return Err(format!("the unit is m, cm or mm, not {other:?}")),
        };
        Ok(ExportSpec { up, unit })
    }
}

#[derive(Debug, Default, Serialize)]
pub(crate) struct Opened {
    pub(crate) kind: &'static str,
    pub(crate) name: String,
    /// Every drawing of the file, at most a thousand.
    pub(crate) names: Vec<String>,
    pub(crate) warnings: Vec<String>,
}

#[derive(Debug, Serialize)]
pub(crate) struct TextureView {
    pub(crate) number: usize,
    pub(crate) width: u32,
    pub(crate) height: u32,
}

#[derive(Debug, Serialize)]
pub(crate) struct MaterialView {
    pub(crate) name: String,
    pub(crate) kind: &'static str,
    pub(crate) color: [f32; 3],
    pub(crate) roughness: f32,
    pub(crate) translucency: f32,
    pub(crate) masked: bool,
    pub(crate) two_sided: bool,
    pub(crate) texture: Option<TextureView>,
}

#[derive(Debug, Serialize)]
pub(crate) struct PartView {
    pub(crate) name: String,
    pub(crate) material: usize,
}

#[derive(Debug, Serialize)]
pub(crate) struct Front {
    pub(crate) metres_per_unit: f64,
    pub(crate) x: f64,
    pub(crate) y: f64,
}

#[derive(Debug, Serialize)]
pub(crate) struct View {
    pub(crate) revision: u64,
    pub(crate) item: Option<ItemReport>,
    pub(crate) stages: Vec<&'static str>,
    pub(crate) front: Option<Front>,
    pub(crate) min: [f64; 3],
    pub(crate) max: [f64; 3],
    pub(crate) parts: Vec<PartView>,
    pub(crate) materials: Vec<MaterialView>,
}
