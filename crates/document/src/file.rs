//! The project file: a zip of versioned JSON.
//!
//! `manifest.json` says what the file is and which form it has; `document.json` is the document in that form. Each
//! form has its own structs here, so that the types of the program may change without breaking files.

use std::sync::Arc;

use base::Seed;
use glam::DVec2;
use serde::{Deserialize, Serialize};
use sketch::{InkSample, SketchSpec, Stroke, StrokeClass, StrokeMode};
use skin::{PetalColor, SkinSpec};

use crate::archive::{ArchiveError, pack, unpack};
use crate::state::{range_fault, shortened};
use crate::{Document, DocumentStroke, Photo, PhotoError, Settings, StrokeId};

/// The form that this version writes, as `manifest.json` names it.
pub const PROJECT_SCHEMA: &str = "project/2";
/// Earlier forms that are read.
const EARLIER: [&str; 1] = ["project/1"];
/// Largest project file that is read, and largest entry in it: 64 MiB and 256 MiB.
pub const MAX_PROJECT_BYTES: usize = 64 << 20;
const MAX_ENTRY_BYTES: usize = 256 << 20;
/// Most strokes of a document that is read.
const MAX_STROKES: usize = 100_000;
/// Most points of all strokes together.
const MAX_POINTS: usize = 4_000_000;

const MANIFEST: &str = "manifest.json";
const DOCUMENT: &str = "document.json";
const PHOTO: &str = "photo.png";

/// Why a project could not be read or written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ProjectError {
    /// The zip file is not sound.
    #[error("project file: {0}")]
    Archive(#[from] ArchiveError),
    /// An entry is missing.
    #[error("project file: there is no \"{0}\" in it; it was not made by Burgeon or is damaged")]
    Missing(&'static str),
    /// Made by a version that this one does not know.
    #[error(
        "project file: its form is {found:?}, this version reads {PROJECT_SCHEMA:?}; take a newer Burgeon"
    )]
    Version {
        /// What `manifest.json` says.
        found: String,
    },
    /// An entry is no JSON, or not of the form.
    #[error("project file, {entry}: {source}")]
    Json {
        /// Which entry.
        entry: &'static str,
        /// What and where.
        source: serde_json::Error,
    },
    /// A stroke is not sound.
    #[error("project file, stroke {row}: {what}")]
    Stroke {
        /// Its row, from 0.
        row: usize,
        /// What is wrong and what to do.
        what: &'static str,
    },
    /// A setting is out of its range.
    #[error("project file: {0}")]
    Setting(String),
    /// The photograph cannot be used.
    #[error("project file, photo.png: {0}")]
    Photo(#[from] PhotoError),
    /// Beyond the bounds that keep hostile files harmless.
    #[error("project file: more than {limit} {what}; split the drawing")]
    TooMuch {
        /// What is counted.
        what: &'static str,
        /// The bound.
        limit: usize,
    },
}

#[derive(Serialize, Deserialize)]
struct Manifest {
    burgeon: String,
    #[serde(default)]
    made_by: String,
}

/// Form 2: as form 1, and a photograph.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct DocumentV2 {
    name: String,
    seed: u64,
    #[serde(default)]
    sketch: SketchSpec,
    #[serde(default)]
    skin: SkinV1,
    strokes: Vec<StrokeV1>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    photo: Option<PhotoV2>,
}

/// How `photo.png` lies under the drawing.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PhotoV2 {
    x: f64,
    y: f64,
    width: f64,
    opacity: f64,
    paint: bool,
}

impl From<DocumentV1> for DocumentV2 {
    fn from(v1: DocumentV1) -> Self {
        let DocumentV1 { name, seed, sketch, skin, strokes } = v1;
        Self { name, seed, sketch, skin, strokes, photo: None }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct DocumentV1 {
    name: String,
    seed: u64,
    #[serde(default)]
    sketch: SketchSpec,
    #[serde(default)]
    skin: SkinV1,
    strokes: Vec<StrokeV1>,
}

#[derive(Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct SkinV1 {
    detail: f64,
    sides: u32,
    textures: bool,
    petals: Option<String>,
    variation: f64,
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
struct StrokeV1 {
    #[serde(default)]
    mode: StrokeMode,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    class: Option<StrokeClass>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    color: Option<[u8; 3]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    id: Option<String>,
    x: Vec<f64>,
    y: Vec<f64>,
    /// Milliseconds; empty if unknown for all.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    t: Vec<Option<f64>>,
    /// Pressure 0 to 1; empty if unknown for all.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    p: Vec<Option<f64>>,
}

/// Whether the first bytes of a file look like a project.
pub fn is_project(start: &[u8]) -> bool {
    start.starts_with(b"PK\x03\x04")
}

/// Writes a document as a `.burgeon` file.
///
/// Guaranteed: [`read_project`] gives back the same strokes and settings, bit for bit. The undo history and the
/// numbers of strokes are not kept.
///
/// # Errors
/// [`ProjectError`] if the bytes cannot be packed.
///
/// ```
/// let bytes = document::write_project(&document::Document::default(), "0.1.0")?;
/// assert_eq!(document::read_project(&bytes)?, document::Document::default());
/// # Ok::<(), document::ProjectError>(())
/// ```
pub fn write_project(document: &Document, version: &str) -> Result<Vec<u8>, ProjectError> {
    let settings = document.settings();
    let photo = settings.photo.as_ref();
    let file = DocumentV2 {
        name: settings.name.clone(),
        seed: settings.seed.number(),
        sketch: settings.sketch.clone(),
        skin: SkinV1::from(&settings.skin),
        strokes: document.strokes().iter().map(to_file).collect(),
        photo: photo.map(|p| PhotoV2 { x: p.x, y: p.y, width: p.width, opacity: p.opacity, paint: p.paint }),
    };
    let manifest = Manifest { burgeon: PROJECT_SCHEMA.into(), made_by: version.into() };
    let json = |entry, source| ProjectError::Json { entry, source };
    let mut files = vec![
        (MANIFEST.to_owned(), serde_json::to_vec(&manifest).map_err(|e| json(MANIFEST, e))?),
        (DOCUMENT.to_owned(), serde_json::to_vec(&file).map_err(|e| json(DOCUMENT, e))?),
    ];
    files.extend(photo.map(|p| (PHOTO.to_owned(), p.png().to_vec())));
    Ok(pack(&files)?)
}

fn to_file(s: &DocumentStroke) -> StrokeV1 {
    let samples = &s.stroke.samples;
    let column = |of: fn(&InkSample) -> Option<f64>| -> Vec<Option<f64>> {
        if samples.iter().any(|p| of(p).is_some()) { samples.iter().map(of).collect() } else { Vec::new() }
    };
    StrokeV1 {
        mode: s.stroke.mode,
        class: s.class,
        color: s.stroke.color,
        id: s.stroke.id.clone(),
        x: samples.iter().map(|p| p.at.x).collect(),
        y: samples.iter().map(|p| p.at.y).collect(),
        t: column(|p| p.time_ms),
        p: column(|p| p.pressure),
    }
}

/// Reads a `.burgeon` file. The bytes may be hostile: sizes are bounded and nothing is believed unseen.
///
/// Guaranteed: a document whose `validate()` is empty. Its strokes are numbered from 0.
///
/// # Errors
/// [`ProjectError`]: what is wrong, where, and what to do.
pub fn read_project(bytes: &[u8]) -> Result<Document, ProjectError> {
    if bytes.len() > MAX_PROJECT_BYTES {
        return Err(ProjectError::TooMuch { what: "bytes", limit: MAX_PROJECT_BYTES });
    }
    let mut entries = unpack(bytes, &[MANIFEST, DOCUMENT, PHOTO], MAX_ENTRY_BYTES)?;
    let manifest = entries.remove(MANIFEST).ok_or(ProjectError::Missing(MANIFEST))?;
    let manifest: Manifest =
        serde_json::from_slice(&manifest).map_err(|source| ProjectError::Json { entry: MANIFEST, source })?;
    let earlier = EARLIER.contains(&manifest.burgeon.as_str());
    if manifest.burgeon != PROJECT_SCHEMA && !earlier {
        return Err(ProjectError::Version { found: manifest.burgeon.chars().take(40).collect() });
    }
    let document = entries.remove(DOCUMENT).ok_or(ProjectError::Missing(DOCUMENT))?;
    let json = |source| ProjectError::Json { entry: DOCUMENT, source };
    // Every form is read by its own structs and then brought forward; each has a file in fixtures/projects.
    let mut file: DocumentV2 = if earlier {
        serde_json::from_slice::<DocumentV1>(&document).map_err(json)?.into()
    } else {
        serde_json::from_slice(&document).map_err(json)?
    };
    let photo = match file.photo.take() {
        Some(PhotoV2 { x, y, width, opacity, paint }) => {
            let png = entries.remove(PHOTO).ok_or(ProjectError::Missing(PHOTO))?;
            Some(Photo { x, y, width, opacity, paint, ..Photo::new(png.into())? })
        }
        None => None,
    };
    checked(file, photo)
}

fn checked(file: DocumentV2, photo: Option<Photo>) -> Result<Document, ProjectError> {
    if file.strokes.len() > MAX_STROKES {
        return Err(ProjectError::TooMuch { what: "strokes", limit: MAX_STROKES });
    }
    if file.strokes.iter().map(|s| s.x.len()).sum::<usize>() > MAX_POINTS {
        return Err(ProjectError::TooMuch { what: "points", limit: MAX_POINTS });
    }
    let petals = match file.skin.petals.as_deref() {
        None => None,
        Some(word) => Some(PetalColor::ALL.into_iter().find(|c| c.word() == word).ok_or_else(|| {
            let known = PetalColor::ALL.map(PetalColor::word).join(", ");
            ProjectError::Setting(format!("the petal colour {word:?} is unknown; use one of {known}"))
        })?),
    };
    let SkinV1 { detail, sides, textures, variation, .. } = file.skin;
    let skin = SkinSpec { detail, sides, textures, petals, variation, ..SkinSpec::default() };
    let settings = Settings {
        name: shortened(&file.name),
        seed: Seed::new(file.seed),
        sketch: file.sketch,
        skin,
        photo,
    };
    let mut document = Document { settings, ..Document::default() };
    if let Some(fault) = range_fault(&document.settings) {
        return Err(ProjectError::Setting(fault));
    }
    for (row, stroke) in file.strokes.into_iter().enumerate() {
        let class = stroke.class;
        let stroke = from_file(stroke).map_err(|what| ProjectError::Stroke { row, what })?;
        let id: StrokeId = document.give_id();
        document.strokes.push(DocumentStroke { id, stroke: Arc::new(stroke), class });
    }
    Ok(document)
}

fn from_file(s: StrokeV1) -> Result<Stroke, &'static str> {
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
    Ok(Stroke { samples, mode: s.mode, color: s.color, id: s.id })
}
