//! Any text as a description: text that is read and within its ranges gives a sound result, or is refused with a
//! reason.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, OnceLock};

use burgeon::bloom::FlowerSpec;
use burgeon::document::{Photo, WornPicture};
use burgeon::formats::{
    ExportSpec, ModelFormat, NoFile, SideFile, no_files, read_model, read_picture, write_glb, write_png,
};
use burgeon::glam::{DVec2, DVec3};
use burgeon::ink::Drawing;
use burgeon::leaf::LeafSpec;
use burgeon::mesh::{MeshFault, Model, Texture};
use burgeon::plant::Plant;
use burgeon::sketch::SketchSpec;
use burgeon::skin::{Pattern, SkinSpec, Wear, skin};
use burgeon::{
    Budget, FlowerOptions, LeafOptions, NamedMesh, Report, Run, Seed, SketchOptions, Spec, TreeError,
    TreeOptions, make_flower, make_from_sketch, make_leaf, make_tree, read_tree_spec, spec,
};

use super::{refused, split_first_line};

/// A hundredth of the default limits: what fits is made in some tenths of a second.
const SMALL: Budget = Budget { times: 0.01, raise: None };

/// Most bytes of one file that a model of `links` names: a mutant never contains much.
const MOST_COMPANION_BYTES: usize = 1 << 20;

fn small() -> Run<'static> {
    Run { budget: SMALL, ..Run::plain() }
}

pub(super) fn assert_plant(plant: &Plant) {
    assert_eq!(plant.validate().next(), None, "a sound plant");
}

pub(super) fn assert_model(model: &Model) {
    let bad = model.validate().find(|f| !matches!(f, MeshFault::Degenerate(_)));
    assert_eq!(bad, None, "a sound model");
}

/// Reads a spec of the kind that the first line names: `tree`, `flower`, `leaf`, `sketch` or `skin`.
pub fn specs(bytes: &[u8]) -> bool {
    let (kind, rest) = split_first_line(bytes);
    let Ok(text) = core::str::from_utf8(rest) else { return false };
    match kind.as_str() {
        "tree" => grow(text),
        "flower" => {
            let Some(flower) = read::<FlowerSpec>(text) else { return false };
            let (law, mut any) = (flower.own_law(), false);
            for day in [0.0, flower.opening_days, flower.opening_days + 0.5 * flower.wilting_days] {
                let options = FlowerOptions {
                    skin: SkinSpec { textures: false, ..SkinSpec::default() },
                    ..FlowerOptions::default()
                };
                match make_flower("fuzz", &flower, (day, &law), &options, Seed::new(1), &small()) {
                    Ok(made) => {
                        assert_plant(&made.plant);
                        assert_model(&made.model);
                        any = true;
                    }
                    Err(e) => any |= refused(&e),
                }
            }
            any
        }
        "leaf" => {
            let Some(leaf) = read::<LeafSpec>(text) else { return false };
            let options = LeafOptions { spec: leaf.clone(), ..LeafOptions::default() };
            match make_leaf("fuzz", &leaf.form.marks(), &options, Seed::new(1), &small()) {
                Ok(made) => {
                    assert_plant(&made.plant);
                    assert_model(&made.model);
                    true
                }
                Err(e) => refused(&e),
            }
        }
        "sketch" => {
            let Some(sketch) = read::<SketchSpec>(text) else { return false };
            draw(&SketchOptions { spec: sketch, ..plain_sketch() })
        }
        "skin" => {
            let Some(skin) = read::<SkinSpec>(text) else { return false };
            draw(&SketchOptions { skin: SkinSpec { textures: false, ..skin }, ..SketchOptions::default() })
        }
        _ => false,
    }
}

/// Reads a spec, if it is valid and within its ranges; checks that it is the same after it was written.
fn read<T: Spec + PartialEq + std::fmt::Debug>(text: &str) -> Option<T> {
    let read: T = match spec::from_toml(text) {
        Ok(read) => read,
        Err(e) => {
            refused(&e);
            return None;
        }
    };
    if let Err(e) = spec::check(&read) {
        refused(&e);
        return None;
    }
    let again: T = spec::from_json(&spec::to_json(&read)).expect("reads what it wrote");
    assert_eq!(again, read, "a spec is the same after it was written");
    Some(read)
}

/// Checks that files that a tree's spec names are requested by their names, and that the spec is refused without them.
fn grow(text: &str) -> bool {
    let asked = RefCell::new(Vec::new());
    let open = |name: &str| -> Option<NamedMesh> {
        asked.borrow_mut().push(name.to_owned());
        let corners = [DVec3::ZERO, DVec3::X, DVec3::new(0.0, 2.0, 0.5), DVec3::new(0.3, 1.0, -1.0)];
        let corners = corners.map(|corner| corner + DVec3::new(1.5, 0.5, 1.5)).to_vec();
        (name == "beside.obj").then(|| (corners, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]))
    };
    let tree = match read_tree_spec(text, &open) {
        Ok(tree) => tree,
        Err(e) => {
            refused(&e);
            if let TreeError::File { file } = &e {
                assert!(asked.borrow().contains(file), "{file} was never asked for");
            }
            return false;
        }
    };
    assert!(asked.borrow().iter().all(|name| name == "beside.obj"), "made without what it names");
    let options =
        TreeOptions { skin: SkinSpec { textures: false, ..SkinSpec::default() }, ..TreeOptions::default() };
    match make_tree(&tree, Seed::new(1), &options, &small()) {
        Ok(made) => {
            assert_plant(&made.grown.plant);
            assert_model(&made.model);
            true
        }
        Err(e) => refused(&e.in_text(text)),
    }
}

fn plain_sketch() -> SketchOptions {
    SketchOptions { skin: SkinSpec { textures: false, ..SkinSpec::default() }, ..SketchOptions::default() }
}

/// Draws a stem with two leaves and a crown above it, in pixels.
fn drawing() -> &'static Drawing {
    static DRAWING: OnceLock<Drawing> = OnceLock::new();
    DRAWING.get_or_init(|| {
        let ring = |x: f64, y: f64, rx: f64, ry: f64| -> Vec<DVec2> {
            let turn = |k: i32| base::ops::sin_cos(f64::from(k) * base::ops::PI / 12.0);
            (0..=24).map(turn).map(|(sin, cos)| DVec2::new(x + rx * cos, y + ry * sin)).collect()
        };
        let stem = (0..20).map(|k| DVec2::new(100.0 + 0.2 * f64::from(k), 10.0 * f64::from(k))).collect();
        let lines = [
            stem,
            ring(130.0, 80.0, 26.0, 9.0),
            ring(70.0, 110.0, 28.0, 8.0),
            ring(104.0, 230.0, 60.0, 45.0),
        ];
        Drawing::from_polylines("fuzz", &lines)
    })
}

fn draw(options: &SketchOptions) -> bool {
    let run = Run { budget: Budget { times: 0.05, ..SMALL }, ..Run::plain() };
    match make_from_sketch(drawing(), options, Seed::new(1), &run) {
        Ok(made) => {
            assert_plant(&made.plant);
            assert_model(&made.model);
            true
        }
        Err(e) => refused(&e),
    }
}

/// Reads a file of materials: a flower wears it, and only pictures that it names are requested.
pub fn materials(bytes: &[u8]) -> bool {
    static FLOWER: OnceLock<Plant> = OnceLock::new();
    let Ok(text) = core::str::from_utf8(bytes) else { return false };
    let Some(wear) = read::<Wear>(text) else { return false };
    let named: Vec<&str> = wear.materials().filter_map(|m| m.picture.as_deref()).collect();
    let asked = RefCell::new(Vec::new());
    let picture = |name: &str| {
        asked.borrow_mut().push(name.to_owned());
        (name == "petal.png")
            .then(|| Arc::new(Texture { width: 2, height: 1, pixels: vec![200, 40, 90, 255, 90, 10, 40, 0] }))
    };
    let worn = wear.worn(picture);
    assert!(asked.borrow().iter().all(|name| named.contains(&name.as_str())), "asks for what is not named");
    let flower = FLOWER.get_or_init(|| {
        let lily = burgeon::bloom::preset("lily").expect("a species that comes with the program");
        lily.make_on_day(lily.opening_days, &lily.own_law(), Seed::new(1))
    });
    // Textures this small are enough to paint every pattern.
    let spec = SkinSpec { worn: worn.always(true), textures: false, texture_size: 64, ..SkinSpec::default() };
    match skin(flower, &spec, &Run::plain()) {
        Ok(model) => {
            assert_model(&model);
            let fits = |t: &Texture| t.pixels.len() as u64 == 4 * u64::from(t.width) * u64::from(t.height);
            let textures = model.materials.iter().filter_map(|m| m.texture.as_deref());
            assert!(textures.into_iter().all(fits), "four bytes for each pixel");
        }
        Err(e) => return refused(&e),
    }
    // A document knows its pictures: it refuses materials that name others.
    for material in wear.materials() {
        let unknown = material.pattern == Pattern::Picture || material.picture.is_some();
        let mut workspace = workspace::Workspace::default();
        let add =
            workspace::Action::Add { name: "fuzz".into(), maker: workspace::NewMaker::Flower("lily".into()) };
        workspace.act(&add).expect("a species that comes with the program");
        let id = workspace.current().expect("the plant that was added");
        let put = burgeon::document::PlantCommand::Wear(burgeon::skin::Wearer::Petal, Some(material.clone()));
        let done = workspace.run(put.for_plant(id));
        assert!(!unknown || done.is_err(), "a picture that the document has not");
        assert_eq!(workspace.document().validate().next(), None, "a sound document");
    }
    true
}

/// Reads a picture: it has the stated number of pixels, and is the same after it was written; its header is trusted
/// only within bounds.
pub fn pictures(bytes: &[u8]) -> bool {
    let read = read_picture(bytes);
    if let Some(picture) = &read {
        assert_eq!(
            picture.pixels.len() as u64,
            4 * u64::from(picture.width) * u64::from(picture.height),
            "four bytes for each pixel"
        );
        let mut png = Vec::new();
        write_png(picture.width, picture.height, &picture.pixels, &mut png).expect("writes what it read");
        assert!(read_picture(&png).as_ref() == Some(picture), "the same after it was written");
    }
    match Photo::new(bytes.into()) {
        Ok(photo) => {
            assert!(photo.height().is_finite() && photo.height() > 0.0, "a height");
            let same = |p: &Texture| (p.width, p.height) == photo.size();
            assert!(read.as_ref().is_none_or(same), "its size is that of its pixels");
        }
        Err(e) => drop(refused(&e)),
    }
    match WornPicture::new(bytes.into()) {
        Ok(worn) => assert!(worn.texture(read_picture).as_deref() == read.as_ref(), "its pixels"),
        Err(e) => drop(refused(&e)),
    }
    read.is_some()
}

/// Reads a model with the files that it names: the name of the model, the model, and each file after a line `=== NAME`.
///
/// A file that is not given does not exist. If the shape of a model needs it, the error names it; otherwise a warning
/// does.
pub fn links(bytes: &[u8]) -> bool {
    let (name, rest) = split_first_line(bytes);
    let Some(format) = name.rsplit_once('.').and_then(|(_, end)| ModelFormat::from_extension(end)) else {
        return false;
    };
    let mut files: BTreeMap<String, &[u8]> = BTreeMap::new();
    let mut model = rest;
    let mark = b"\n=== ";
    let find = |within: &[u8]| within.windows(mark.len()).position(|w| w == mark);
    if let Some(at) = find(rest) {
        model = &rest[..at];
        let mut left = &rest[at + mark.len()..];
        loop {
            let end = find(left).unwrap_or(left.len());
            let (name, file) = split_first_line(&left[..end]);
            files.insert(name, &file[..file.len().min(MOST_COMPANION_BYTES)]);
            if end == left.len() {
                break;
            }
            left = &left[end + mark.len()..];
        }
    }
    let missing = RefCell::new(Vec::new());
    let asked = RefCell::new(BTreeSet::new());
    let resolve = |file: SideFile<'_>| {
        let key = (file.by.map(str::to_owned), file.name.to_owned());
        assert!(asked.borrow_mut().insert(key), "{} is read twice", file.name);
        files.get(file.name).map(|file| file.to_vec()).ok_or_else(|| {
            missing.borrow_mut().push(file.name.to_owned());
            NoFile::Missing
        })
    };
    let mut report = Report::default();
    let taken = match read_model(model, format, "fuzz", &ExportSpec::default(), &resolve, &mut report) {
        Ok(read) => {
            assert_model(&read);
            write_glb(&read, std::io::sink()).expect("writes what it read");
            // An OBJ is whole without its materials, and warns of missing ones.
            let told = !report.warnings.is_empty() || format != ModelFormat::Obj;
            assert!(missing.borrow().is_empty() || told, "nothing is said of {:?}", missing.borrow());
            true
        }
        Err(e) => refused(&e),
    };
    // Without any file no more is read than with them.
    let alone = read_model(model, format, "fuzz", &ExportSpec::default(), &no_files, &mut Report::default());
    if let Ok(alone) = alone {
        assert!(
            alone.materials.iter().all(|m| m.texture.is_none() || is_within(model)),
            "a picture of nowhere"
        );
    }
    taken
}

/// Whether a model may contain pictures itself.
fn is_within(model: &[u8]) -> bool {
    let holds = |word: &[u8]| model.windows(word.len()).any(|w| w == word);
    holds(b"data:") || holds(b"bufferView")
}
