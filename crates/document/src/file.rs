//! The project file: a zip of versioned JSON.
//!
//! `manifest.json` names the kind of file and its version; `document.json` is the document in that version. Each
//! version has its own structs here, so that the types of the program may change without breaking files.

use std::sync::Arc;

use base::Seed;
use glam::DVec3;
use growth::TreeSpec;
use serde::de::Error as _;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use shape::HandEdit;
use skin::Wear;
use spec::SpecFault;

use crate::archive::{ArchiveError, pack, unpack};
use crate::fault::MAX_PICTURES;
use crate::makers::{FlowerMaker, LeafData, LeafMaker, Maker, NamedObstacle, SketchSettings, TreeSettings};
use crate::names::shortened;
use crate::state::{MAX_PLANTS, Placement, PlantEdit, range_fault};
use crate::versions::{
    DocumentV1, DocumentV2, DocumentV3, DocumentV4, DocumentV5, DocumentV7, EditV4, FlowerV5, LeafV3,
    MakerV5, ObstacleV3, PlantV4, SketchV3, SkinV1, StrokeV1, TreeV3, from_file, to_file,
};
use crate::{
    Document, DocumentPlant, DocumentStroke, Photo, PhotoError, PictureError, PlantId, SettingFault,
    Settings, WornPicture, WornPictures,
};

/// The version that is written, in the words of `manifest.json`.
pub const PROJECT_SCHEMA: &str = "project/7";
/// Earlier versions that can be read.
const EARLIER: [&str; 6] = ["project/1", "project/2", "project/3", "project/4", "project/5", "project/6"];
/// Largest project file that is read; 64 MiB.
pub const MAX_PROJECT_BYTES: usize = 64 << 20;
/// Largest entry of a project file that is read; 256 MiB.
const MAX_ENTRY_BYTES: usize = 256 << 20;
/// Most strokes of a document that is read.
const MAX_STROKES: usize = 100_000;
/// Most points of all strokes together.
const MAX_POINTS: usize = 4_000_000;

const MANIFEST: &str = "manifest.json";
const DOCUMENT: &str = "document.json";
/// Entry of the photograph in versions 1 and 2; later ones have `photo-ROW.png`.
const PHOTO: &str = "photo.png";

/// Reason why a project could not be read or written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ProjectError {
    /// The zip file is not sound.
    #[error("project file: {0}")]
    Archive(#[from] ArchiveError),
    /// An entry is missing.
    #[error("project file: there is no \"{0}\" in it; it was not made by Burgeon or is damaged")]
    Missing(String),
    /// The file has a version that this program does not know.
    #[error(
        "project file: its version is {found:?}, this program reads {PROJECT_SCHEMA:?}; take a newer Burgeon"
    )]
    Version {
        /// The version in `manifest.json`.
        found: String,
    },
    /// An entry is not JSON, or does not fit the version.
    #[error("project file, {entry}: {}", base::brief(&base::plainly(&source.to_string())))]
    Json {
        /// Name of the entry.
        entry: &'static str,
        /// The error with its place.
        source: serde_json::Error,
    },
    /// A stroke is not sound.
    #[error("project file, stroke {row}: {what}")]
    Stroke {
        /// Row of the stroke, from 0.
        row: usize,
        /// The fault and its remedy.
        what: &'static str,
    },
    /// The spec of a tree is invalid.
    #[error("project file, spec of a tree: {0}")]
    Tree(#[source] SpecFault),
    /// A setting is out of its range.
    #[error("project file: {0}")]
    Setting(#[source] SettingFault),
    /// The scene is inconsistent.
    #[error("project file: {0}; it was not made by Burgeon or is damaged")]
    Scene(crate::DocumentFault),
    /// The photograph cannot be used.
    #[error("project file, photograph: {0}")]
    Photo(#[from] PhotoError),
    /// A picture of a material cannot be used.
    #[error("project file: {0}")]
    Picture(#[from] PictureError),
    /// The file exceeds the bounds that keep hostile files harmless.
    #[error("project file: more than {limit} {what}; split the drawing")]
    TooMuch {
        /// The limited quantity.
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

/// Whether the first bytes of a file look like a project.
pub fn is_project(start: &[u8]) -> bool {
    start.starts_with(b"PK\x03\x04")
}

/// Writes a document as a `.burgeon` file.
///
/// Guaranteed: [`read_project`] gives back the same plants, strokes and settings, bit for bit. The undo history and
/// the numbers of plants and strokes are not kept.
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
    let row =
        |id: PlantId| document.plants().iter().position(|p| p.id() == id).and_then(|r| u32::try_from(r).ok());
    let plants = document.plants().iter().map(|p| plant_to_file(p, &row)).collect();
    let file = DocumentV7 { name: document.name().into(), plants };
    let manifest = Manifest { burgeon: PROJECT_SCHEMA.into(), made_by: version.into() };
    let json = |entry, source| ProjectError::Json { entry, source };
    let mut files = vec![
        (MANIFEST.to_owned(), serde_json::to_vec(&manifest).map_err(|e| json(MANIFEST, e))?),
        (DOCUMENT.to_owned(), serde_json::to_vec(&file).map_err(|e| json(DOCUMENT, e))?),
    ];
    for (row, plant) in document.plants().iter().enumerate() {
        files.extend(plant.settings().photo().map(|p| (photo_name(row), p.png().to_vec())));
    }
    // Plants that wear the same picture share it.
    let pictures = base::map_of(document.plants().iter().flat_map(|p| &p.settings().pictures));
    files.extend(pictures.into_iter().map(|(name, picture)| (picture_name(name), picture.png().to_vec())));
    Ok(pack(&files)?)
}

fn photo_name(row: usize) -> String {
    format!("photo-{row}.png")
}

fn picture_name(name: &str) -> String {
    format!("picture-{name}.png")
}

fn plant_to_file(plant: &DocumentPlant, row: &dyn Fn(PlantId) -> Option<u32>) -> PlantV4<MakerV5> {
    let s = plant.settings();
    let maker = match &s.maker {
        Maker::Sketch(k) => MakerV5::Sketch(SketchV3 {
            sketch: k.sketch.clone(),
            skin: SkinV1::from(&k.skin),
            strokes: plant.strokes().iter().map(to_file).collect(),
            layers: k.layers.clone(),
            photo: k.photo.as_ref().map(|p| p.place),
            day: k.day,
            leaf: k.leaf.and_then(row),
        }),
        Maker::Tree(t) => MakerV5::Tree(TreeV3 {
            preset: t.preset.clone(),
            spec: spec_to_file(&t.spec),
            obstacles: t
                .obstacles
                .iter()
                .map(|o| ObstacleV3 { name: o.name.clone(), shape: (*o.shape).clone() })
                .collect(),
            height_m: t.height_m,
            skin: SkinV1::from(&t.skin),
            leaf: t.leaf.and_then(row),
        }),
        Maker::Leaf(l) => MakerV5::Leaf(LeafV3 {
            file: l.data.name.clone(),
            data: (*l.data.text).into(),
            settings: l.settings.clone(),
        }),
        Maker::Flower(f) => MakerV5::Flower(FlowerV5 {
            preset: f.preset.clone(),
            spec: (*f.spec).clone(),
            day: f.day,
            law: f.law.as_ref().map(|l| (**l).clone()),
        }),
    };
    let Placement { position, yaw_deg, scale } = s.placement;
    let edits = s.edits.iter().map(|e| EditV4 { edit: HandEdit::clone(&e.edit), off: e.off });
    PlantV4 {
        name: s.name.clone(),
        seed: s.seed.number(),
        locked: s.locked,
        fixed: s.fixed,
        hidden: s.hidden,
        group: s.group.clone(),
        position: position.to_array(),
        yaw_deg,
        scale,
        wear: s.wear.clone(),
        pictures: s.pictures.keys().cloned().collect(),
        maker,
        edits: edits.collect(),
    }
}

/// Reads a `.burgeon` file. The bytes may be hostile: sizes are bounded and everything is checked.
///
/// Guaranteed: a document whose `validate()` is empty. Its plants and strokes are numbered from 0.
/// Not guaranteed: that the numbers of a tree's spec or the marks of a leaf yield a plant; their makers report that.
///
/// # Errors
/// [`ProjectError`]: the fault, its place and its remedy.
pub fn read_project(bytes: &[u8]) -> Result<Document, ProjectError> {
    if bytes.len() > MAX_PROJECT_BYTES {
        return Err(ProjectError::TooMuch { what: "bytes", limit: MAX_PROJECT_BYTES });
    }
    let mut entries = unpack(bytes, &[MANIFEST, DOCUMENT], MAX_ENTRY_BYTES)?;
    let missing = |name: &str| ProjectError::Missing(name.into());
    let manifest = entries.remove(MANIFEST).ok_or_else(|| missing(MANIFEST))?;
    let manifest: Manifest =
        from_json(&manifest).map_err(|source| ProjectError::Json { entry: MANIFEST, source })?;
    let version = manifest.burgeon.as_str();
    if version != PROJECT_SCHEMA && !EARLIER.contains(&version) {
        return Err(ProjectError::Version { found: base::quoted(&manifest.burgeon) });
    }
    let document = entries.remove(DOCUMENT).ok_or_else(|| missing(DOCUMENT))?;
    let json = |source| ProjectError::Json { entry: DOCUMENT, source };
    // Every version is read by its own structs and then converted to the next; each has a file in fixtures/projects.
    let second = |v1: DocumentV1| DocumentV2::from(v1);
    let third = |v2: DocumentV2| DocumentV3::from(v2);
    let fifth = |v4: DocumentV4| DocumentV5::try_from(v4).map_err(ProjectError::Setting);
    let mut file = match version {
        "project/1" => fifth(third(second(from_json(&document).map_err(json)?)).into())?,
        "project/2" => fifth(third(from_json(&document).map_err(json)?).into())?,
        "project/3" => fifth(from_json::<DocumentV3>(&document).map_err(json)?.into())?,
        "project/4" => fifth(from_json(&document).map_err(json)?)?,
        _ => from_json(&document).map_err(json)?,
    };
    drop(document);
    if version != PROJECT_SCHEMA {
        group_alike(&mut file);
    }
    let earlier = matches!(version, "project/1" | "project/2");
    let entry = |name: String| {
        let png = unpack(bytes, &[&name], MAX_ENTRY_BYTES)?.remove(&name);
        png.ok_or(ProjectError::Missing(name))
    };
    let photo = |row| {
        let png = entry(if earlier { PHOTO.to_owned() } else { photo_name(row) })?;
        Ok(Photo::new(png.into())?)
    };
    let mut had = WornPictures::new();
    let mut pictures = |names: Vec<String>| {
        if names.len() > MAX_PICTURES {
            return Err(ProjectError::Setting(SettingFault::Pictures));
        }
        let mut own = WornPictures::new();
        for name in names {
            let picture = match had.get(&name) {
                Some(picture) => picture.clone(),
                None => WornPicture::new(entry(picture_name(&name))?.into())?,
            };
            had.insert(name.clone(), picture.clone());
            own.insert(name, picture);
        }
        Ok(own)
    };
    checked(file, photo, &mut pictures)
}

/// Least number of plants with one name and maker that were shown as one entry before plants had groups.
const ALIKE: usize = 3;

/// Puts plants of files without groups into the groups in which they were shown.
fn group_alike(file: &mut DocumentV7) {
    let key = |p: &PlantV4<MakerV5>| (p.name.clone(), core::mem::discriminant(&p.maker));
    let keys: Vec<_> = file.plants.iter().map(key).collect();
    for (plant, own) in file.plants.iter_mut().zip(&keys) {
        if keys.iter().filter(|k| *k == own).count() >= ALIKE {
            plant.group = shortened(plant.name.trim());
        }
    }
}

/// As text, because commands are read from text: reading from bytes would compile all that code a second time.
fn from_json<'a, T: Deserialize<'a>>(bytes: &'a [u8]) -> Result<T, serde_json::Error> {
    serde_json::from_str(core::str::from_utf8(bytes).map_err(serde_json::Error::custom)?)
}

fn checked(
    file: DocumentV7,
    photo: impl Fn(usize) -> Result<Photo, ProjectError>,
    pictures_of: &mut dyn FnMut(Vec<String>) -> Result<WornPictures, ProjectError>,
) -> Result<Document, ProjectError> {
    if file.plants.len() > MAX_PLANTS {
        return Err(ProjectError::TooMuch { what: "plants", limit: MAX_PLANTS });
    }
    let strokes = || {
        file.plants.iter().flat_map(|p| if let MakerV5::Sketch(s) = &p.maker { &s.strokes[..] } else { &[] })
    };
    if strokes().count() > MAX_STROKES {
        return Err(ProjectError::TooMuch { what: "strokes", limit: MAX_STROKES });
    }
    if strokes().map(|s| s.x.len()).sum::<usize>() > MAX_POINTS {
        return Err(ProjectError::TooMuch { what: "points", limit: MAX_POINTS });
    }
    let mut document =
        Document { name: shortened(&file.name), plants: Vec::new(), next_stroke: 0, next_plant: 0 };
    for (row, plant) in file.plants.into_iter().enumerate() {
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
        } = plant;
        let (maker, strokes) = match maker {
            MakerV5::Sketch(sketch) => from_sketch(sketch, row, &photo)?,
            MakerV5::Tree(tree) => (from_tree(tree)?, Vec::new()),
            MakerV5::Leaf(LeafV3 { file, data, settings }) => {
                let data = LeafData { name: shortened(&file), text: data.into() };
                (Maker::Leaf(Box::new(LeafMaker { data, settings })), Vec::new())
            }
            MakerV5::Flower(FlowerV5 { preset, spec, day, law }) => {
                let (preset, spec, law) = (preset.map(|p| shortened(&p)), Arc::new(spec), law.map(Arc::new));
                (Maker::Flower(Box::new(FlowerMaker { preset, spec, day, law })), Vec::new())
            }
        };
        let settings = Settings {
            name: shortened(&name),
            seed: Seed::new(seed),
            locked,
            fixed,
            hidden,
            group: shortened(&group),
            placement: Placement { position: DVec3::from_array(position), yaw_deg, scale },
            wear: Wear { strokes: Vec::new(), ..wear },
            pictures: pictures_of(pictures)?,
            maker,
            edits: edits.into_iter().map(|e| PlantEdit { edit: Arc::new(e.edit), off: e.off }).collect(),
        };
        if let Some(fault) = range_fault(&settings) {
            return Err(ProjectError::Setting(fault));
        }
        let mut kept = Vec::with_capacity(strokes.len());
        for (row, stroke) in strokes.into_iter().enumerate() {
            let (class, shown) = (stroke.class, stroke.shown);
            let material = stroke.material.clone().map(Arc::new);
            let stroke = from_file(stroke).map_err(|what| ProjectError::Stroke { row, what })?;
            kept.push(DocumentStroke {
                id: document.give_stroke(),
                stroke: Arc::new(stroke),
                class,
                shown,
                material,
            });
        }
        document.plants.push(DocumentPlant { id: PlantId(document.next_plant), settings, strokes: kept });
        document.next_plant += 1;
    }
    // Points are sound by now: this checks the references to other plants.
    let fault = document.validate().next();
    fault.map_or(Ok(document), |fault| Err(ProjectError::Scene(fault)))
}

fn from_sketch(
    sketch: SketchV3,
    row: usize,
    photo: &impl Fn(usize) -> Result<Photo, ProjectError>,
) -> Result<(Maker, Vec<StrokeV1>), ProjectError> {
    let SketchV3 { sketch, skin, strokes, layers, photo: lies, day, leaf } = sketch;
    let photo = match lies {
        Some(place) => Some(Photo { place, ..photo(row)? }),
        None => None,
    };
    let skin = skin.spec().map_err(ProjectError::Setting)?;
    let settings = SketchSettings { sketch, skin, layers, photo, day, leaf: leaf.map(PlantId) };
    Ok((Maker::Sketch(Box::new(settings)), strokes))
}

/// Stores obstacles next to the spec, with their names.
fn spec_to_file(spec: &TreeSpec) -> Value {
    let mut value = spec::to_json(spec);
    value.as_object_mut().map(|fields| fields.remove("obstacles"));
    value
}

fn from_tree(tree: TreeV3) -> Result<Maker, ProjectError> {
    let TreeV3 { preset, spec, obstacles, height_m, skin, leaf } = tree;
    let obstacles = obstacles
        .into_iter()
        .map(|o| NamedObstacle { name: shortened(&o.name), shape: Arc::new(o.shape) })
        .collect();
    let spec = spec::from_json(&spec).map_err(ProjectError::Tree)?;
    Ok(Maker::Tree(Box::new(TreeSettings {
        preset: preset.map(|p| shortened(&p)),
        spec: Arc::new(spec),
        obstacles,
        height_m,
        skin: skin.spec().map_err(ProjectError::Setting)?,
        leaf: leaf.map(PlantId),
    })))
}

base::coded!(ProjectError {
    Self::Archive(why) => "project-archive" { why },
    Self::Missing(name) => "project-missing" { name },
    Self::Version { found } => "project-version" { found },
    Self::Json { entry, source } => "project-json" {
        entry, why = &base::Slip::from_message(&source.to_string()) => base::Slip
    },
    Self::Stroke { row, what } => "project-stroke" { row, why = what },
    Self::Setting(why) => "project-setting" { why => SettingFault },
    Self::Scene(why) => "project-scene" { why },
    Self::TooMuch { what, limit } => "project-too-much" { what, limit },
} wraps {
    Self::Tree(e) => e, SpecFault;
    Self::Photo(e) => e, PhotoError;
    Self::Picture(e) => e, PictureError;
});
