//! Project files that are hostile, damaged, newer or older.
#![expect(clippy::unwrap_used, reason = "tests")]

use document::{Document, DocumentPlant, Maker, ProjectError, is_project, pack, read_project, write_project};
use glam::DVec2;
use ink::Drawing;
use proptest::prelude::*;

fn sample() -> Vec<u8> {
    let lines = [vec![DVec2::ZERO, DVec2::new(0.1, 0.7), DVec2::new(0.2, 1.4)], vec![DVec2::ONE, DVec2::X]];
    write_project(&Document::from_drawing(&Drawing::from_polylines("sample", &lines)), "test").unwrap()
}

fn project(manifest: &str, document: &str) -> Vec<u8> {
    let entry = |name: &str, text: &str| (name.to_owned(), text.as_bytes().to_vec());
    pack(&[entry("manifest.json", manifest), entry("document.json", document)]).unwrap()
}

const V1: &str = r#"{"burgeon":"project/1"}"#;
const V2: &str = r#"{"burgeon":"project/2"}"#;

const V3: &str = r#"{"burgeon":"project/3"}"#;

const V4: &str = r#"{"burgeon":"project/4"}"#;

/// Returns the only plant of a document of an earlier form.
fn only(document: &Document) -> &DocumentPlant {
    document.only_sketch().unwrap()
}

fn refusal(bytes: &[u8]) -> String {
    read_project(bytes).unwrap_err().to_string()
}

/// Makes a file with one plant of a maker.
fn scene(maker: &str, more: &str) -> Vec<u8> {
    let plant = format!(r#"{{"name":"a","seed":1,"maker":{maker}{more}}}"#);
    project(V3, &format!(r#"{{"name":"a","plants":[{plant}]}}"#))
}

/// Makes a file with one plant and one hand edit.
fn edited(maker: &str, edit: &str) -> Vec<u8> {
    let plant = format!(r#"{{"name":"a","seed":1,"maker":{maker},"edits":[{{"edit":{edit}}}]}}"#);
    project(V4, &format!(r#"{{"name":"a","plants":[{plant}]}}"#))
}

/// A material whose picture is not in the file, and layers that share a name.
#[test]
fn materials_and_layers_that_do_not_hold_together_are_refused() {
    let v6 = r#"{"burgeon":"project/6"}"#;
    let plant = |more: &str, sketch: &str| {
        let strokes = r#"[{"x":[0,1],"y":[0,1],"layer":"a"}]"#;
        let maker = format!(r#"{{"sketch":{{"strokes":{strokes}{sketch}}}}}"#);
        let plant = format!(r#"{{"name":"a","seed":1{more},"maker":{maker}}}"#);
        project(v6, &format!(r#"{{"name":"a","plants":[{plant}]}}"#))
    };
    let sound = r#","layers":[{"name":"a"}]"#;
    assert!(read_project(&plant("", sound)).is_ok());
    let worn = |picture: &str| format!(r#","wear":{{"leaf":{{"pattern":"picture"{picture}}}}}"#);
    for (more, sketch, words) in [
        (String::new(), "", "a layer that is not there"),
        (String::new(), r#","layers":[{"name":"a"},{"name":"a"}]"#, "a name of its own"),
        (worn(""), sound, "the picture of a material is not there"),
        (worn(r#","picture":"x""#), sound, "the picture of a material is not there"),
        (r#","pictures":["x"]"#.into(), sound, "picture-x.png"),
        (r#","wear":{"leaf":{"amount":7}}"#.into(), sound, "amount"),
    ] {
        let said = refusal(&plant(&more, sketch));
        assert!(said.contains(words), "{said}");
    }
}

/// Files without groups showed plants of one name and maker as one entry if there were three or more.
#[test]
fn plants_of_one_name_are_a_group_in_files_that_have_none() {
    let groups = |version: &str, names: &[&str], more: &str| -> Vec<String> {
        let plant =
            |n: &&str| format!(r#"{{"name":"{n}","seed":1{more},"maker":{{"sketch":{{"strokes":[]}}}}}}"#);
        let plants = names.iter().map(plant).collect::<Vec<_>>().join(",");
        let manifest = format!(r#"{{"burgeon":"{version}"}}"#);
        let read =
            read_project(&project(&manifest, &format!(r#"{{"name":"a","plants":[{plants}]}}"#))).unwrap();
        read.plants().iter().map(|p| p.settings().group.clone()).collect()
    };
    assert_eq!(groups("project/6", &["a", "b", "a", "a"], ""), ["a", "", "a", "a"]);
    assert_eq!(groups("project/6", &["a", "b", "a"], ""), ["", "", ""]);
    assert_eq!(groups("project/7", &["a", "a", "a"], ""), ["", "", ""]);
    assert_eq!(groups("project/7", &["a", "b"], r#","group":"bed""#), ["bed", "bed"]);
}

#[test]
fn refusals_say_what_and_what_to_do() {
    assert!(is_project(&sample()));
    for (bytes, words) in [
        (Vec::new(), "not a whole zip"),
        (b"PK\x03\x04 but no more".to_vec(), "not a whole zip"),
        (sample()[..sample().len() / 2].to_vec(), "not a whole zip"),
        (pack(&[("x.txt".into(), vec![1])]).unwrap(), "no \"manifest.json\""),
        (pack(&[("manifest.json".into(), V1.into())]).unwrap(), "no \"document.json\""),
        (project(r#"{"burgeon":"project/8"}"#, "{}"), "take a newer Burgeon"),
        (
            project(
                V2,
                r#"{"name":"a","seed":1,"strokes":[],"photo":{"x":0,"y":0,"width":1,"opacity":1,"paint":true}}"#,
            ),
            "no \"photo.png\"",
        ),
        (project("[", "{}"), "manifest.json: EOF"),
        (project(V1, "{}"), "missing field `name`"),
        (project(V1, r#"{"name":"a","seed":1,"strokes":[],"more":1}"#), "unknown field `more`"),
        (project(V1, r#"{"name":"a","seed":1,"strokes":[{"x":[1],"y":[]}]}"#), "stroke 0: its columns"),
        (project(V1, r#"{"name":"a","seed":1,"strokes":[{"x":[],"y":[]}]}"#), "no point"),
        (project(V1, r#"{"name":"a","seed":1,"strokes":[{"x":[1e999],"y":[0]}]}"#), "out of range"),
        (project(V1, r#"{"name":"a","seed":-1,"strokes":[]}"#), "invalid value"),
        (project(V1, r#"{"name":"a","seed":1,"strokes":[],"skin":{"petals":"plaid"}}"#), "petal colour"),
        (project(V1, r#"{"name":"a","seed":1,"strokes":[],"skin":{"detail":1e9}}"#), "0.1 to 8"),
        (
            project(V1, r#"{"name":"a","seed":1,"strokes":[],"sketch":{"fill":{"density":1e300}}}"#),
            "fill.density must be 0.1 to 10",
        ),
        (
            project(V3, r#"{"name":"a","plants":[{"name":"a","seed":1,"maker":{"shrub":{}}}]}"#),
            "unknown variant",
        ),
        (scene(r#"{"flower":{"settings":{"species":"weed"}}}"#, ""), "\"weed\" is unknown"),
        (scene(r#"{"flower":{"settings":{"day":1e300}}}"#, ""), "day must be 0 to 100 d, not 1e"),
        (
            scene(r#"{"leaf":{"file":"m","data":"","settings":{"sides":1}}}"#, ""),
            "sides must be 3 to 64, not 1",
        ),
        (scene(r#"{"tree":{"spec":[]}}"#, ""), "JSON object"),
        (scene(r#"{"tree":{"spec":{},"height_m":-2}}"#, ""), "height_m must be 0.001 to 1000 m, not -2"),
        (scene(r#"{"tree":{"spec":{},"leaf":0}}"#, ""), "bears the leaf"),
        (scene(r#"{"tree":{"spec":{},"leaf":7}}"#, ""), "bears the leaf"),
        (scene(r#"{"tree":{"spec":{}}}"#, r#","edits":[]"#), "unknown field `edits`"),
        (
            edited(r#"{"sketch":{"strokes":[]}}"#, r#"{"op":"prune","axis":{"path":[0]},"at":2}"#),
            "edit 0 by hand: at is not",
        ),
        (
            edited(r#"{"tree":{"spec":{}}}"#, r#"{"op":"explode","axis":{"path":[0]}}"#),
            "unknown variant `explode`",
        ),
        (
            edited(
                r#"{"leaf":{"file":"m","data":"","settings":{}}}"#,
                r#"{"op":"prune","axis":{"path":[0]}}"#,
            ),
            "a leaf has no branches",
        ),
        (scene(r#"{"flower":{}}"#, r#","scale":0"#), "100 km"),
        (scene(r#"{"flower":{}}"#, r#","position":[1e9,0,0]"#), "100 km"),
    ] {
        let said = refusal(&bytes);
        assert!(said.starts_with("project file") && said.contains(words), "{said:?} has no {words:?}");
    }
}

#[test]
fn a_bomb_is_refused_before_it_unfolds() {
    let zeros = vec![b' '; 300 << 20];
    let bomb = pack(&[("manifest.json".into(), V1.into()), ("document.json".into(), zeros)]).unwrap();
    assert!(bomb.len() < 2 << 20, "{} bytes", bomb.len());
    assert!(matches!(read_project(&bomb), Err(ProjectError::Archive(_))));
    assert!(refusal(&bomb).contains("bytes in one file"));
    let many: Vec<_> = (0..300).map(|k| (format!("{k}"), Vec::new())).collect();
    assert!(refusal(&pack(&many).unwrap()).contains("256 files"));
}

#[test]
fn a_deep_document_is_refused() {
    let deep = format!(r#"{{"name":"a","seed":1,"strokes":[{}"#, "[".repeat(100_000));
    assert!(refusal(&project(V1, &deep)).starts_with("project file, document.json"));
}

#[test]
fn files_of_version_1_stay_readable() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/projects/version-1.burgeon");
    let document = read_project(&std::fs::read(path).unwrap()).unwrap();
    let plant = only(&document);
    assert_eq!((document.name(), plant.settings().name.as_str()), ("sample", "sample"));
    assert_eq!((plant.strokes().len(), plant.settings().seed.number()), (15, 7));
    assert_eq!(plant.classes().len(), 1, "one correction");
    let sketch = plant.settings().sketch().unwrap();
    assert_eq!(sketch.skin.petals.map(skin::PetalColor::word), Some("violet"));
    assert_eq!(plant.strokes()[0].stroke.samples.len(), 141);
}

#[test]
fn files_of_version_2_stay_readable() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/projects/version-2.burgeon");
    let document = read_project(&std::fs::read(path).unwrap()).unwrap();
    let plant = only(&document);
    assert_eq!((plant.strokes().len(), plant.settings().seed.number()), (15, 7));
    let photo = plant.settings().photo().unwrap();
    assert_eq!(
        (photo.size(), photo.place.x, photo.place.y, photo.place.width),
        ((8, 8), -10.0, -20.0, 900.0)
    );
    assert_eq!((photo.place.opacity, photo.place.paint, photo.height()), (0.25, true, 900.0));
    let again = read_project(&write_project(&document, "test").unwrap()).unwrap();
    assert_eq!(again, document);
}

#[test]
fn files_of_version_3_stay_readable() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/projects/version-3.burgeon");
    let document = read_project(&std::fs::read(path).unwrap()).unwrap();
    let [drawn, bush, leaf, lily] = document.plants() else { panic!("{document:?}") };
    let sketch = drawn.settings().sketch().unwrap();
    assert_eq!((drawn.strokes().len(), sketch.day, sketch.leaf), (15, Some(4.5), Some(leaf.id())));
    assert_eq!(drawn.settings().photo().unwrap().size(), (8, 8));
    let Maker::Tree(tree) = &bush.settings().maker else { panic!("{bush:?}") };
    assert_eq!(
        (tree.preset.as_deref(), tree.obstacles.len(), tree.leaf),
        (Some("hazel"), 2, Some(leaf.id()))
    );
    assert!(leaf.settings().hidden && bush.settings().locked && lily.settings().placement.scale == 2.0);
    let again = read_project(&write_project(&document, "test").unwrap()).unwrap();
    assert_eq!(again, document);
}

#[test]
fn files_of_version_4_stay_readable() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/projects/version-4.burgeon");
    let document = read_project(&std::fs::read(path).unwrap()).unwrap();
    let [drawn, bush, ..] = document.plants() else { panic!("{document:?}") };
    let words: Vec<&str> = bush.settings().edits.iter().map(|e| e.edit.word()).collect();
    assert_eq!(
        words[..5],
        ["rotate", "move", "prune", "regrow", "sketch-branch"],
        "in the order in which they are done"
    );
    assert_eq!((words.len(), bush.settings().edits.iter().filter(|e| e.off).count()), (10, 1));
    assert_eq!(drawn.settings().edits.len(), 1);
    let again = read_project(&write_project(&document, "test").unwrap()).unwrap();
    assert_eq!(again, document);
}

#[test]
fn files_of_version_5_stay_readable() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/projects/version-5.burgeon");
    let document = read_project(&std::fs::read(path).unwrap()).unwrap();
    let [.., lily] = document.plants() else { panic!("{document:?}") };
    let Maker::Flower(flower) = &lily.settings().maker else { panic!("{lily:?}") };
    assert_eq!((flower.preset.as_deref(), flower.day, flower.spec.nod_deg), (Some("lily"), 3.25, 40.0));
    assert_eq!((flower.spec.whorls[0].tip_color, flower.spec.whorls.len()), ([0.9, 0.2, 0.1], 3));
    let again = read_project(&write_project(&document, "test").unwrap()).unwrap();
    assert_eq!(again, document);
}

/// As version 6, and its plant is in a group.
#[test]
fn files_of_version_7_stay_readable() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/projects/version-7.burgeon");
    let document = read_project(&std::fs::read(path).unwrap()).unwrap();
    assert_eq!(only(&document).settings().group, "a bed");
    let again = read_project(&write_project(&document, "test").unwrap()).unwrap();
    assert_eq!(again, document);
}

/// A drawing with layers, a wide pen, materials of a kind and of a stroke, and a picture.
#[test]
fn files_of_version_6_stay_readable() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/projects/version-6.burgeon");
    let document = read_project(&std::fs::read(path).unwrap()).unwrap();
    let plant = only(&document);
    let names: Vec<_> = plant.layers().iter().map(|l| (&*l.name, l.hidden, l.locked)).collect();
    assert_eq!(names, [("stem", false, true), ("petals", false, false), ("notes", true, false)]);
    let on = |name: &str| plant.strokes().iter().filter(|s| s.stroke.layer.as_deref() == Some(name)).count();
    assert_eq!((on("petals"), on("notes")), (2, 1));
    assert_eq!(plant.strokes()[0].stroke.width, Some(2.5));
    let wear = plant.wear();
    assert_eq!(wear.petal.as_ref().map(|m| m.pattern), Some(skin::Pattern::Picotee));
    assert_eq!((wear.strokes.len(), wear.strokes[0].material.pattern), (1, skin::Pattern::Picture));
    let picture = wear.strokes[0].material.picture.as_ref().unwrap();
    assert_eq!(&plant.settings().pictures[picture].name(), picture);
    let again = read_project(&write_project(&document, "test").unwrap()).unwrap();
    assert_eq!(again, document);
}

#[test]
fn a_tree_a_leaf_and_a_flower_come_back() {
    let law = r#"{"schema":"burgeon.law/1","name":"x","first_day":0.0,"span_days":6.0,"regions":1,"laws":[{"organ":"any","region":0,"axis":"size","K":1.0,"p0":0.1,"r":0.9,"offset":0.0,"standard_errors":null,"r2":1.0,"r2_adjusted":null,"loo_rmse":null,"days":[],"values":[]}]}"#;
    let text = format!(
        r#"{{"name":"three","plants":[
        {{"name":"leaf","seed":2,"maker":{{"leaf":{{"file":"m.csv","data":"row,mark\n","settings":{{"curl":0.1}}}}}}}},
        {{"name":"tree","seed":3,"locked":true,"position":[1,0,-0.1],"yaw_deg":30.1,"scale":0.3,"maker":{{"tree":{{
            "preset":"oak","spec":{{"age":3,"clearance_m":0.1}},"leaf":0,"height_m":4.5,
            "obstacles":[{{"name":"ball","shape":{{"shape":"sphere","centre":[0,1,0],"radius_m":0.5}}}}]}}}}}},
        {{"name":"flower","seed":4,"hidden":true,"maker":{{"flower":{{"settings":{{"species":"rose","day":2.5,"stalk_m":0.4}},"law":{law}}}}}}}
        ]}}"#
    );
    let document = read_project(&project(V3, &text)).unwrap();
    let [leaf, tree, flower] = document.plants() else { panic!("{document:?}") };
    assert!(
        matches!(&leaf.settings().maker, Maker::Leaf(l) if &*l.data.text == "row,mark\n" && l.settings.curl == 0.1)
    );
    let Maker::Tree(t) = &tree.settings().maker else { panic!("{tree:?}") };
    assert_eq!((t.obstacles.len(), t.leaf, tree.settings().locked), (1, Some(leaf.id()), true));
    assert_eq!(t.height_m, Some(4.5));
    let Maker::Flower(f) = &flower.settings().maker else { panic!("{flower:?}") };
    let rose = bloom::preset("rose").unwrap();
    assert!(f.law.is_some() && f.preset.as_deref() == Some("rose") && flower.settings().hidden);
    assert_eq!((f.day, &*f.spec), (2.5, &bloom::FlowerSpec { stalk_m: 0.4, ..rose }));
    let unknown = text.replace(r#""rose""#, r#""weed""#);
    assert!(read_project(&project(V3, &unknown)).unwrap_err().to_string().contains("weed"));
    let again = read_project(&write_project(&document, "test").unwrap()).unwrap();
    assert_eq!(again, document);
}

#[test]
fn photographs_are_bounded() {
    let doc =
        r#"{"name":"a","seed":1,"strokes":[],"photo":{"x":0,"y":0,"width":W,"opacity":1,"paint":true}}"#;
    let with = |png: &[u8], width: &str| {
        let entry = |name: &str, bytes: &[u8]| (name.to_owned(), bytes.to_vec());
        let document = doc.replace('W', width);
        let all = [
            entry("manifest.json", V2.as_bytes()),
            entry("document.json", document.as_bytes()),
            entry("photo.png", png),
        ];
        read_project(&pack(&all).unwrap()).map_err(|e| e.to_string())
    };
    let png =
        |w: u32, h: u32| [&b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR"[..], &w.to_be_bytes(), &h.to_be_bytes()].concat();
    assert!(with(&png(4096, 1), "1").is_ok());
    for (bytes, width, words) in [
        (png(4097, 1), "1", "smaller"),
        (png(0, 1), "1", "no PNG"),
        (b"JFIF".to_vec(), "1", "no PNG"),
        (png(1, 1), "0", "out of reach"),
        (png(1, 1), "1e300", "out of reach"),
    ] {
        let said = with(&bytes, width).unwrap_err();
        assert!(said.contains(words), "{said}");
    }
}

#[test]
fn a_compact_document_is_small_and_looks_the_same() {
    let line: Vec<DVec2> =
        (0..500).map(|k| DVec2::new(f64::from(k) * 0.731_234_567, f64::from(k % 7) / 3.0)).collect();
    let document = Document::from_drawing(&Drawing::from_polylines("line", std::slice::from_ref(&line)));
    let compact = document.compact();
    assert_eq!(compact.validate().count(), 0);
    let size = |d: &Document| write_project(d, "test").unwrap().len();
    assert!(size(&compact) * 3 < size(&document) * 2, "{} {}", size(&compact), size(&document));
    for (a, b) in only(&compact).strokes()[0].stroke.samples.iter().zip(&line) {
        assert!((a.at - *b).length() < 365.0 / 10_000.0, "{} {b}", a.at);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn damaged_files_never_panic(
        edits in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        cut in any::<prop::sample::Index>(),
        shorten in any::<bool>(),
    ) {
        let mut bytes = sample();
        for (at, value) in edits {
            let at = at.index(bytes.len());
            bytes[at] = value;
        }
        if shorten { bytes.truncate(cut.index(bytes.len())); }
        if let Ok(document) = read_project(&bytes) {
            prop_assert_eq!(document.validate().collect::<Vec<_>>(), vec![]);
        }
    }
}
