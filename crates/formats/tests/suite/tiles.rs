//! Tiles: what their extensions ask for, and that copies stand where they should.
#![expect(clippy::unwrap_used, reason = "tests")]

use std::collections::BTreeMap;
use std::sync::Arc;

use base::Report;
use formats::{
    ExportSpec, FileStems, Group, Instance, Linking, ModelFormat, Packing, PngCache, SharedModel, TileNode,
    Tileset, TreeRow, TreeTable, WriteError, gltf_files, no_files, read_model, share_pictures, stand_usda,
    tileset_json, write_glb_joined, write_tile,
};
use glam::{DQuat, DVec3};
use mesh::{Bounds, Material, MaterialId, MaterialKind, Model, Part, Texture, TriMesh};
use serde_json::Value;

/// A wedge with a textured face, and a bare one, off its origin.
fn plant(red: u8) -> Model {
    let face = |x: f32| TriMesh {
        positions: vec![[x, 0.5, 0.0], [x + 1.0, 0.5, 0.0], [x, 3.5, 0.5]],
        normals: vec![[0.0, 0.0, 1.0]; 3],
        uvs: vec![[0.0, 1.0], [1.0, 1.0], [0.0, 0.0]],
        triangles: vec![[0, 1, 2]],
        ..TriMesh::default()
    };
    let pixels = [red, 90, 30, 255].repeat(16);
    let texture = Some(Arc::new(Texture { width: 4, height: 4, pixels }));
    let bark = Material { texture, ..Material::plain("bark", MaterialKind::Bark, [1.0; 3]) };
    let leaf = Material::plain("leaf", MaterialKind::Leaf, [0.1, 0.5, 0.1]);
    let part = |name: &str, material, x| Part {
        name: name.into(),
        material: MaterialId::new(material),
        mesh: face(x),
    };
    Model {
        name: "tree".into(),
        parts: vec![part("wood", 0, -0.25), part("leaves", 1, -1.5)],
        materials: vec![bark, leaf],
        offset_m: None,
    }
}

/// A model as tiles name it, and its files.
fn shared(model: &Model, stem: &str, packing: Packing) -> (SharedModel, BTreeMap<String, Vec<u8>>) {
    let mut glb = Vec::new();
    write_glb_joined(model, packing, &mut PngCache::new(), &mut glb).unwrap();
    let files = gltf_files(glb, ModelFormat::Gltf, FileStems { model: stem, textures: stem }).unwrap();
    let files = share_pictures(files, "tree").unwrap();
    let beside = files.beside.into_iter().map(|f| (format!("models/{}", f.name), f.bytes)).collect();
    (SharedModel::read(&files.own, "models/").unwrap(), beside)
}

fn stands() -> Vec<Instance> {
    let quarter = std::f64::consts::FRAC_1_SQRT_2;
    vec![
        Instance {
            at: DVec3::new(100.0, 20.0, -40.0),
            turn: DQuat::IDENTITY,
            scale: DVec3::splat(1.0),
            tree: 1,
        },
        Instance {
            at: DVec3::new(-7.0, 1.0, 30.0),
            turn: DQuat::from_xyzw(0.0, quarter, 0.0, quarter),
            scale: DVec3::new(2.0, 0.5, 2.0),
            tree: 0,
        },
    ]
}

fn rows() -> [TreeRow; 3] {
    [7, 9, 12].map(|row| TreeRow {
        species: u16::from(row == 9),
        row,
        height_m: f64::from(row) * 1.5,
        dbh_m: 0.25,
        crown_width_m: 3.0,
        age_years: 40.0,
    })
}

fn document(glb: &[u8]) -> (Value, Vec<u8>) {
    let length = u32::from_le_bytes(glb[12..16].try_into().unwrap()) as usize;
    (serde_json::from_slice(&glb[20..20 + length]).unwrap(), glb[28 + length..].to_vec())
}

fn whole_number(row: &Value, key: &str) -> usize {
    usize::try_from(row[key].as_u64().unwrap_or_else(|| panic!("{key} of {row}"))).unwrap()
}

/// Checks the demands of the extensions' texts; returns the rows of the table that copies name, in their order.
fn check_tile(glb: &[u8], species: &[String]) -> Vec<usize> {
    let (root, bin) = document(glb);
    assert_eq!(
        u32::from_le_bytes(glb[8..12].try_into().unwrap()) as usize,
        glb.len(),
        "the length in the header"
    );
    let list = |name: &str| root[name].as_array().cloned().unwrap_or_default();
    let (views, accessors, buffers) = (list("bufferViews"), list("accessors"), list("buffers"));
    assert!(
        buffers[0].get("uri").is_none() && whole_number(&buffers[0], "byteLength") == bin.len(),
        "the first buffer is the file's own"
    );
    for view in &views {
        let end = |v: &Value| v["byteOffset"].as_u64().unwrap_or(0) + v["byteLength"].as_u64().unwrap();
        let buffer = |v: &Value| &buffers[whole_number(v, "buffer")];
        assert!(end(view) <= buffer(view)["byteLength"].as_u64().unwrap(), "{view}");
        let packed = &view["extensions"]["EXT_meshopt_compression"];
        assert!(
            packed.is_null() || end(packed) <= buffer(packed)["byteLength"].as_u64().unwrap(),
            "{packed}"
        );
    }
    assert!(accessors.iter().all(|a| whole_number(a, "bufferView") < views.len()), "views of accessors");
    for (name, key, of) in [("textures", "source", "images"), ("nodes", "mesh", "meshes")] {
        assert!(
            list(name).iter().all(|row| row.get(key).is_none() || whole_number(row, key) < list(of).len()),
            "{name}"
        );
    }
    let metadata = &root["extensions"]["EXT_structural_metadata"];
    let table = &metadata["propertyTables"][0];
    let count = whole_number(table, "count");
    assert_eq!(
        metadata["schema"]["enums"]["species"]["values"].as_array().unwrap().len(),
        species.len(),
        "species"
    );
    let class = &metadata["schema"]["classes"]["tree"]["properties"];
    for (name, property) in table["properties"].as_object().unwrap() {
        let view = &views[whole_number(property, "values")];
        let size = if class[name]["componentType"] == "UINT32" { 4 } else { 2 };
        assert_eq!(whole_number(view, "byteLength"), size * count, "{name}");
        assert_eq!(
            (whole_number(view, "buffer"), whole_number(view, "byteOffset") % 8),
            (0, 0),
            "{name}: aligned"
        );
    }
    let scene: Vec<usize> = (0..list("nodes").len()).collect();
    assert_eq!(root["scenes"][0]["nodes"], serde_json::json!(scene), "all at the top");
    let mut named = Vec::new();
    for node in list("nodes") {
        for key in ["translation", "rotation", "scale", "matrix", "children"] {
            assert!(node.get(key).is_none(), "a node of copies has no transform of its own");
        }
        let attributes = node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"].as_object().unwrap();
        let counts: Vec<usize> = attributes
            .values()
            .map(|a| whole_number(&accessors[usize::try_from(a.as_u64().unwrap()).unwrap()], "count"))
            .collect();
        assert!(counts.windows(2).all(|c| c[0] == c[1]), "{counts:?}");
        let features = &node["extensions"]["EXT_instance_features"]["featureIds"][0];
        assert_eq!(
            (
                whole_number(features, "featureCount"),
                whole_number(features, "propertyTable"),
                whole_number(features, "attribute")
            ),
            (count, 0, 0),
            "features of copies"
        );
        named.push(counts[0]);
    }
    for word in ["EXT_mesh_gpu_instancing", "EXT_instance_features", "EXT_structural_metadata"] {
        assert!(root["extensionsUsed"].as_array().unwrap().iter().any(|w| w == word), "{word}");
    }
    named
}

/// The heights and stems of the table of [`rows`], by the rules of `EXT_structural_metadata` for normalised integers.
fn check_measures(glb: &[u8]) {
    let (root, bin) = document(glb);
    let metadata = &root["extensions"]["EXT_structural_metadata"];
    for (name, wanted, off) in [("height_m", [10.5, 13.5, 18.0], 0.005), ("dbh_m", [0.25; 3], 0.0005)] {
        let class = &metadata["schema"]["classes"]["tree"]["properties"][name];
        let values = &metadata["propertyTables"][0]["properties"][name];
        let view = &root["bufferViews"][whole_number(values, "values")];
        let start = view["byteOffset"].as_u64().map_or(0, |n| usize::try_from(n).unwrap());
        let own = bin[start..].as_chunks::<2>().0.iter().map(|b| f64::from(u16::from_le_bytes(*b)));
        let scale = class["scale"].as_f64().unwrap();
        for (n, wanted) in own.zip(wanted) {
            let measure = n / 65_535.0 * scale;
            assert!((measure - wanted).abs() <= off, "{name}: {measure} for {wanted}");
        }
    }
}

#[test]
fn copies_stand_scaled_turned_and_moved_in_each_packing() {
    let species = ["oak".to_owned(), "a \"b\"".to_owned()];
    for packing in [Packing::Quantized, Packing::Compressed] {
        let (model, files) = shared(&plant(120), "tree-lod0", packing);
        let own = plant(120).bounds();
        let near = |a: Bounds, b: Bounds, by: f64| {
            assert!(
                (a.min - b.min).abs().max_element() < by && (a.max - b.max).abs().max_element() < by,
                "{a:?} {b:?}"
            );
        };
        near(model.bounds(), own, 2e-3);
        assert_eq!(model.triangles(), 2);
        let instances = stands();
        let groups = [Group { model: &model, instances: &instances }];
        let table = TreeTable { species: &species, rows: &rows() };
        let open = |uri: &str| Ok::<_, WriteError>(files[uri].clone());
        let mut glb = Vec::new();
        write_tile("trees", &groups, &table, Some(packing), Linking::Embedded(&open), &mut glb).unwrap();
        assert_eq!(check_tile(&glb, &species), [2], "a node a plant");
        check_measures(&glb);
        let mut report = Report::default();
        let back =
            read_model(&glb[..], ModelFormat::Glb, "x", &ExportSpec::default(), &no_files, &mut report)
                .unwrap();
        assert_eq!(back.triangle_count(), 4);
        let mut expected = Bounds::EMPTY;
        for i in &instances {
            for p in plant(120).parts.iter().flat_map(|p| p.mesh.positions.clone()) {
                expected.include(i.at + i.turn * (i.scale * DVec3::from(p.map(f64::from))));
            }
        }
        // Compressed turns are true to two thirds of a degree.
        near(back.bounds(), expected, 0.08);
    }
}

#[test]
fn tiles_name_shared_files_once() {
    let packing = Packing::Compressed;
    let (a, files) = shared(&plant(120), "a", packing);
    let (b, more) = shared(&plant(120), "b", packing);
    let (c, _) = shared(&plant(10), "c", packing);
    let pictures = |files: &BTreeMap<String, Vec<u8>>| {
        files.keys().filter(|f| !f.ends_with(".bin")).cloned().collect::<Vec<_>>()
    };
    assert_eq!(pictures(&files), pictures(&more), "equal pictures have one name");
    let instances = stands();
    let groups = [&a, &b, &c].map(|model| Group { model, instances: &instances });
    let species = ["oak".to_owned(), "elm".to_owned()];
    let table = TreeTable { species: &species, rows: &rows() };
    let write = || {
        let mut glb = Vec::new();
        write_tile("trees", &groups, &table, Some(packing), Linking::Named, &mut glb).unwrap();
        glb
    };
    let glb = write();
    assert_eq!(glb, write(), "the same bytes");
    assert_eq!(check_tile(&glb, &species).len(), 3);
    let (root, _) = document(&glb);
    let count = |name: &str| root[name].as_array().unwrap().len();
    // Of each plant five views (position, normal, texture coordinates, colour, triangles) less the colours that these do not have,
    // an accessor for each and one more for its second part; of the tile four columns of copies and six of the table.
    assert_eq!(count("bufferViews"), 3 * 4 + 4 + 6);
    assert_eq!(count("accessors"), 3 * (5 + 4));
    assert_eq!(count("buffers"), 3 + 2, "one of what is compressed");
    let uris: Vec<&str> =
        root["buffers"].as_array().unwrap().iter().filter_map(|b| b["uri"].as_str()).collect();
    assert_eq!(uris, ["models/a.bin", "models/b.bin", "models/c.bin"]);
    assert_eq!(root["images"].as_array().unwrap().len(), 2, "two of three trees share theirs");
    assert_eq!(root["materials"].as_array().unwrap().len(), 3);
    let text = |n: usize| {
        let groups: Vec<Group<'_>> = groups.iter().cycle().take(n).copied().collect();
        let mut glb = Vec::new();
        write_tile("trees", &groups, &table, Some(packing), Linking::Named, &mut glb).unwrap();
        u32::from_le_bytes(glb[12..16].try_into().unwrap())
    };
    let more = (text(9) - text(3)) / 6;
    assert!(more < 2_000, "{more} bytes of text for a plant more");
}

#[test]
fn tilesets_have_boxes_that_hold_their_children_and_z_up() {
    let bounds = |low: [f64; 3], high: [f64; 3]| Bounds { min: low.into(), max: high.into() };
    let leaf = TileNode {
        bounds: bounds([0.0, 1.0, -20.0], [10.0, 31.0, -4.0]),
        geometric_error_m: 0.0,
        content: "tiles/1/0-0-0.glb".into(),
        children: Vec::new(),
    };
    let root = TileNode {
        geometric_error_m: 2.5,
        content: "tiles/0/0-0-1.glb".into(),
        children: vec![leaf.clone()],
        ..leaf
    };
    let tileset =
        Tileset { root: &root, geometric_error_m: 5.0, transform: None, origin_m: DVec3::new(3.0, 1.0, 2.0) };
    let text: Value = serde_json::from_slice(&tileset_json(&tileset)).unwrap();
    assert_eq!(
        (root.count(), &text["asset"]["version"], &text["root"]["refine"]),
        (2, &"1.1".into(), &"REPLACE".into())
    );
    let numbers: Vec<f64> = text["root"]["boundingVolume"]["box"]
        .as_array()
        .unwrap()
        .iter()
        .map(|x| x.as_f64().unwrap())
        .collect();
    // East 0 to 10, north 4 to 20, up 1 to 31.
    assert_eq!(numbers[..3], [5.0, 12.0, 16.0]);
    let halves = [numbers[3], numbers[7], numbers[11]];
    assert!(
        halves.iter().zip([5.0, 8.0, 15.0]).all(|(h, least)| *h >= least && *h < least + 0.05),
        "{halves:?}"
    );
    assert_eq!(text["root"]["children"][0]["geometricError"], 0.0);
}

#[test]
fn a_stand_is_written_as_usd() {
    let instances = stands();
    let prototypes = [formats::Prototype { file: "models/a.usda", instances: &instances }];
    let species = ["oak".to_owned(), "a \"b\"".to_owned()];
    let text = stand_usda(&prototypes, &TreeTable { species: &species, rows: &rows() }).unwrap();
    let text = String::from_utf8(text).unwrap();
    for line in [
        "string[] species = [\"oak\", \"a \\\"b\\\"\"]",
        "int[] protoIndices = [0, 0]",
        "int64[] ids = [9, 7]",
        "point3f[] positions = [(100.0000, 20.0000, -40.0000), (-7.0000, 1.0000, 30.0000)]",
        "quath[] orientations = [(1.0000, 0.0000, 0.0000, 0.0000), (0.7071, 0.0000, 0.7071, 0.0000)]",
        "prepend references = @models/a.usda@",
    ] {
        assert!(text.contains(line), "{line}: {text}");
    }
}
