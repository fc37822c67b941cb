//! GLB files: sound models become files that other programs read.
#![allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "test data are small numbers")]

use std::sync::Arc;

use formats::{PngCache, write_glb, write_glb_scene, write_glb_with};
use mesh::{AlphaMode, Material, MaterialId, MaterialKind, Model, Part, Standing, Texture, TriMesh};

/// A grid of `n` by `n` squares with every column filled.
fn grid(n: u32) -> TriMesh {
    let mut m = TriMesh::default();
    let f = |i: u32| f64::from(i) / f64::from(n);
    for j in 0..=n {
        for i in 0..=n {
            m.push(glam::DVec3::new(f(i), f(j), 0.1 * f(i) * f(j)));
            m.uvs.push([f(i) as f32, f(j) as f32]);
            m.colors.push([1.0, 0.5, f(j) as f32]);
        }
    }
    for j in 0..n {
        for i in 0..n {
            let a = j * (n + 1) + i;
            m.triangles.extend([[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]);
        }
    }
    m.compute_normals();
    m
}

fn model(n: u32) -> Model {
    let mut pixels = vec![0_u8; 4 * 64 * 64];
    for (i, p) in pixels.chunks_exact_mut(4).enumerate() {
        p.copy_from_slice(&[(i % 251) as u8, 120, 40, if i % 7 == 0 { 0 } else { 255 }]);
    }
    let texture = Arc::new(Texture { width: 64, height: 64, pixels });
    let leaf = Material {
        texture: Some(Arc::clone(&texture)),
        alpha: AlphaMode::Mask,
        double_sided: true,
        translucency: 0.25,
        ..Material::plain("leaf", MaterialKind::Leaf, [0.25, 0.5, 0.125])
    };
    let petal =
        Material { texture: Some(texture), ..Material::plain("petal", MaterialKind::Petal, [1.0; 3]) };
    let bark = Material::plain("bark", MaterialKind::Bark, [0.5, 0.25, 0.125]);
    let mut bare = grid(2);
    bare.colors.clear();
    bare.uvs.clear();
    let part = |name: &str, id, mesh| Part { name: name.into(), material: MaterialId::new(id), mesh };
    Model {
        name: "oak".into(),
        parts: vec![part("leaves", 0, grid(n)), part("petals", 1, grid(3)), part("trunk", 2, bare)],
        materials: vec![leaf, petal, bark],
        offset_m: None,
    }
}

fn json_of(glb: &[u8]) -> serde_json::Value {
    let length = u32::from_le_bytes([glb[12], glb[13], glb[14], glb[15]]) as usize;
    serde_json::from_slice(&glb[20..20 + length]).expect("the JSON chunk is JSON")
}

#[test]
fn the_file_says_what_the_model_says() {
    let mut glb = Vec::new();
    write_glb(&model(8), &mut glb).expect("writes");
    let total = u32::from_le_bytes([glb[8], glb[9], glb[10], glb[11]]) as usize;
    assert_eq!((&glb[..4], total), (&b"glTF"[..], glb.len()));
    let j = json_of(&glb);
    assert_eq!(j["nodes"][0]["name"], "oak");
    assert_eq!(j["nodes"][0]["children"], serde_json::json!([1, 2, 3]));
    assert_eq!(j["nodes"][1]["name"], "leaves");
    assert_eq!(j["materials"][0]["alphaMode"], "MASK");
    assert_eq!(j["materials"][0]["doubleSided"], true);
    assert_eq!(j["images"].as_array().map(Vec::len), Some(1), "a shared texture is written once");
    assert_eq!(j["accessors"][0]["max"][0], 1.0);
    assert!(j["meshes"][2]["primitives"][0]["attributes"].get("COLOR_0").is_none());
    assert_eq!(j["asset"]["extras"]["unit"], "metre");
}

#[test]
fn the_same_model_gives_the_same_bytes() {
    let (mut a, mut b) = (Vec::new(), Vec::new());
    write_glb(&model(8), &mut a).expect("writes");
    let mut cache = PngCache::new();
    let m = model(8);
    write_glb_with(&m, &mut cache, &mut b).expect("writes");
    assert_eq!(a, b);
    b.clear();
    write_glb_with(&m, &mut cache, &mut b).expect("writes");
    assert_eq!(a, b, "with the texture from the cache");
}

#[test]
fn unsound_models_are_refused_by_name() {
    let mut m = model(2);
    m.parts[1].mesh.positions[3][1] = f32::NAN;
    let e = write_glb(&m, Vec::new()).expect_err("NaN").to_string();
    assert!(e.contains("`petals`") && e.contains("vertex 3"), "{e}");
    let mut m = model(2);
    m.parts[0].mesh.triangles[0][0] = 1000;
    assert!(write_glb(&m, Vec::new()).is_err(), "dangling");
    let mut m = model(2);
    m.materials.truncate(1);
    assert!(write_glb(&m, Vec::new()).is_err(), "no material");
}

/// Files for the validator of the standard's authors: `GLB_OUT=DIR cargo test -p burgeon-formats --test glb`.
#[test]
fn samples_for_the_validator() {
    let Some(dir) = std::env::var_os("GLB_OUT") else {
        println!("GLB_OUT is not set: no sample files were written");
        return;
    };
    let dir = std::path::PathBuf::from(dir);
    let mut large = model(300);
    large.parts[2].mesh.triangles.clear();
    for (name, model) in [("small", model(8)), ("large", large), ("empty", Model::default())] {
        let mut glb = Vec::new();
        write_glb(&model, &mut glb).expect("writes");
        std::fs::write(dir.join(format!("{name}.glb")), glb).expect("saves");
    }
}

#[test]
fn a_model_that_stands_in_a_scene_several_times_is_written_once() {
    let (oak, elm) = (model(8), Model { name: "elm".into(), ..model(4) });
    let turn = glam::DQuat::from_xyzw(0.0, 0.6, 0.0, 0.8);
    let far = Standing {
        position: glam::DVec3::new(3.0, 0.0, -2.0),
        turn,
        scale: 2.0,
        ..Standing::home("b", &oak)
    };
    let plants = [Standing::home("a", &oak), far, Standing::home("c", &elm)];
    let mut glb = Vec::new();
    write_glb_scene("grove", &plants, &mut PngCache::new(), &mut glb).expect("writes");
    let j = json_of(&glb);
    let many = |key: &str| j[key].as_array().map_or(0, Vec::len);
    assert_eq!((many("meshes"), many("images"), many("nodes")), (6, 1, 1 + 3 + 9));
    let named = |name: &str| {
        let nodes = j["nodes"].as_array().expect("nodes");
        nodes.iter().find(|n| n["name"] == name).expect("there").clone()
    };
    assert_eq!(named("grove")["children"].as_array().map(Vec::len), Some(3));
    assert_eq!(named("b")["translation"], serde_json::json!([3.0, 0.0, -2.0]));
    assert_eq!(named("b")["rotation"], serde_json::json!([0.0, 0.6, 0.0, 0.8]));
    assert_eq!(named("b")["scale"], serde_json::json!([2.0, 2.0, 2.0]));
    let meshes = |name: &str| -> Vec<serde_json::Value> {
        let children = named(name)["children"].as_array().expect("parts").clone();
        children.iter().map(|c| j["nodes"][c.as_u64().expect("a row") as usize]["mesh"].clone()).collect()
    };
    assert_eq!(meshes("a"), meshes("b"));
    assert!(meshes("c").iter().all(|m| !meshes("a").contains(m)));
    // Each material is that of its own model.
    let mut report = base::Report::default();
    let spec = formats::ExportSpec::default();
    let read = formats::ModelFormat::Glb;
    let back =
        formats::read_model(&glb[..], read, "x", &spec, &formats::no_files, &mut report).expect("reads");
    let triangles = |m: &Model| m.triangle_count();
    assert_eq!(triangles(&back), 2 * triangles(&oak) + triangles(&elm));
    let corner = far.turn * (glam::DVec3::new(1.0, 1.0, 0.1) * far.scale) + far.position;
    let near = |p: &[f32; 3]| glam::DVec3::from(p.map(f64::from)).distance(corner) < 1e-5;
    assert!(back.parts.iter().any(|p| p.mesh.positions.iter().any(near)), "the copy is where it stands");
}

#[test]
fn one_plant_that_stands_where_it_was_made_is_written_as_its_model() {
    let oak = model(8);
    let (mut scene, mut plain) = (Vec::new(), Vec::new());
    write_glb_scene("oak", &[Standing::home("a", &oak)], &mut PngCache::new(), &mut scene).expect("writes");
    write_glb(&oak, &mut plain).expect("writes");
    assert!(scene == plain);
}
