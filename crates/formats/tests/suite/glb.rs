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
fn attributes_of_the_wind_are_of_one_width_for_the_importer_of_blender() {
    use formats::{Packing, write_glb_packed};
    let m = carried();
    let (mut plain, mut packed) = (Vec::new(), Vec::new());
    write_glb(&m, &mut plain).expect("writes");
    write_glb_packed(&m, Packing::Quantized, &mut PngCache::new(), &mut packed).expect("writes");
    for glb in [plain, packed] {
        let j = json_of(&glb);
        for mesh in j["meshes"].as_array().expect("meshes") {
            let attributes = &mesh["primitives"][0]["attributes"];
            let shape = |name: &str| {
                let accessor = attributes[name].as_u64().and_then(|i| usize::try_from(i).ok());
                &j["accessors"][accessor.expect(name)]["type"]
            };
            assert_eq!([shape("_WIND"), shape("_PIVOT")], ["VEC4"; 2], "{}", mesh["name"]);
        }
        let back = read_back(&glb);
        assert!(back.parts.iter().all(|p| p.mesh.pivots.iter().all(|&p| p == [0.5, 0.0, 0.25])));
    }
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

/// Files for the validator of the standard's authors: `GLB_OUT=DIR cargo test -p burgeon-formats --test suite glb::`.
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

/// [`model`] with reliefs, wind, and bark whose texture repeats.
fn carried() -> Model {
    let mut m = model(24);
    let picture = |c: [u8; 4]| Some(Arc::new(Texture { width: 32, height: 32, pixels: c.repeat(1024) }));
    for material in &mut m.materials {
        material.maps.normal = picture([128, 128, 255, 255]);
        material.maps.orm = picture([255, 200, 0, 255]);
        material.maps.through = picture([255, 255, 255, 90]);
    }
    m.materials[2].texture = picture([120, 90, 60, 255]);
    let mesh = &mut m.parts[2].mesh;
    mesh.uvs = mesh.positions.iter().map(|p| [3.0 * p[0], 7.5 * p[1] - 1.0]).collect();
    for part in &mut m.parts {
        part.mesh.wind = vec![[0.25, 0.5, 0.0, 1.0]; part.mesh.positions.len()];
        part.mesh.pivots = vec![[0.5, 0.0, 0.25]; part.mesh.positions.len()];
    }
    m
}

fn read_back(glb: &[u8]) -> Model {
    let mut report = base::Report::default();
    let spec = formats::ExportSpec::default();
    let read =
        formats::read_model(glb, formats::ModelFormat::Glb, "x", &spec, &formats::no_files, &mut report);
    assert!(report.warnings.is_empty(), "{:?}", report.warnings);
    read.expect("reads")
}

#[test]
fn reliefs_are_written_and_read_back() {
    let m = carried();
    let mut glb = Vec::new();
    write_glb(&m, &mut glb).expect("writes");
    let j = json_of(&glb);
    let leaf = &j["materials"][0];
    assert_eq!(leaf["occlusionTexture"], leaf["pbrMetallicRoughness"]["metallicRoughnessTexture"]);
    let through = &leaf["extensions"]["KHR_materials_diffuse_transmission"];
    assert_eq!(
        (&through["diffuseTransmissionFactor"], through["diffuseTransmissionTexture"]["index"].is_u64()),
        (&0.25.into(), true)
    );
    assert!(j["materials"][2].get("extensions").is_none(), "wood lets no light through");
    assert_eq!(j["extensionsUsed"], serde_json::json!(["KHR_materials_diffuse_transmission"]));
    assert!(j.get("extensionsRequired").is_none(), "plain where a viewer does not know it");
    let back = read_back(&glb);
    for (a, b) in m.materials.iter().zip(&back.materials) {
        assert_eq!(
            (&a.maps.normal, &a.maps.orm, a.translucency),
            (&b.maps.normal, &b.maps.orm, b.translucency),
            "{}",
            a.name
        );
    }
    assert_eq!(back.materials[0].maps.through, m.materials[0].maps.through);
}

#[test]
fn packed_files_are_small_and_come_back_as_they_were() {
    use formats::{Packing, write_glb_packed};
    let m = carried();
    let mut plain = Vec::new();
    write_glb(&m, &mut plain).expect("writes");
    for (packing, most) in [(Packing::Quantized, 0.75), (Packing::Compressed, 0.4)] {
        let mut glb = Vec::new();
        write_glb_packed(&m, packing, &mut PngCache::new(), &mut glb).expect("writes");
        let mut again = Vec::new();
        write_glb_packed(&m, packing, &mut PngCache::new(), &mut again).expect("writes");
        assert_eq!(glb, again, "the same bytes");
        let share = glb.len() as f64 / plain.len() as f64;
        assert!(share < most, "{packing:?}: {share}");
        let back = read_back(&glb);
        assert_eq!(back.validate().collect::<Vec<_>>(), []);
        for (a, b) in m.parts.iter().zip(&back.parts) {
            assert_eq!(a.name, b.name);
            // Compressed: normals to a degree, texture coordinates in steps of a 512th, positions of an 8,192th of
            // the size.
            let compressed = packing == Packing::Compressed;
            let (normal, uv, position) = if compressed { (0.0175, 1e-3, 1e-4) } else { (0.01, 2e-4, 2e-5) };
            let near = |x: &[f32], y: &[f32], off: f32| x.iter().zip(y).all(|(x, y)| (x - y).abs() <= off);
            // Corner by corner: vertices may be in another order, and corners turned.
            for (t, s) in a.mesh.triangles.iter().zip(&b.mesh.triangles) {
                let same = |k: usize| {
                    (0..3).all(|c| {
                        let (i, j) = (t[c] as usize, s[(c + k) % 3] as usize);
                        near(&a.mesh.positions[i], &b.mesh.positions[j], position)
                            && near(&a.mesh.normals[i], &b.mesh.normals[j], normal)
                            && near(&a.mesh.uvs[i], &b.mesh.uvs[j], uv)
                            && near(&a.mesh.wind[i], &b.mesh.wind[j], 1e-4)
                            && near(&a.mesh.pivots[i], &b.mesh.pivots[j], 1e-5)
                            && a.mesh.colors.get(i).is_none_or(|x| near(x, &b.mesh.colors[j], 0.003))
                    })
                };
                assert!((0..3).any(same), "{packing:?} {}: {t:?} {s:?}", a.name);
            }
            assert_eq!(a.mesh.triangles.len(), b.mesh.triangles.len());
        }
        // Without loss where there are holes.
        assert!(back.materials[0].maps.through == m.materials[0].maps.through, "to the pixel");
        let webp = packing == Packing::Compressed && cfg!(feature = "webp");
        let length = u32::from_le_bytes([glb[12], glb[13], glb[14], glb[15]]) as usize;
        let json: serde_json::Value = serde_json::from_slice(&glb[20..20 + length]).expect("JSON");
        let kinds: Vec<&str> =
            json["images"].as_array().expect("there").iter().filter_map(|i| i["mimeType"].as_str()).collect();
        assert_eq!((kinds.contains(&"image/webp"), kinds.contains(&"image/png")), (webp, !webp));
        let needed = json["extensionsRequired"].as_array().expect("there");
        assert_eq!(needed.iter().filter(|e| *e == "EXT_texture_webp").count(), usize::from(webp));
        let cut = &glb[..glb.len() - glb.len() / 3];
        let spec = formats::ExportSpec::default();
        let read = formats::read_model(
            cut,
            formats::ModelFormat::Glb,
            "x",
            &spec,
            &formats::no_files,
            &mut base::Report::default(),
        );
        assert!(read.is_err(), "a file that was cut is an error");
    }
}

/// The floats behind an accessor of a plain GLB, by its JSON alone.
fn floats(glb: &[u8], j: &serde_json::Value, accessor: &serde_json::Value) -> Vec<f32> {
    let of = |v: &serde_json::Value| v.as_u64().unwrap_or(0) as usize;
    let accessor = &j["accessors"][of(accessor)];
    let view = &j["bufferViews"][of(&accessor["bufferView"])];
    let bin = 28 + u32::from_le_bytes([glb[12], glb[13], glb[14], glb[15]]) as usize;
    let from = bin + of(&view["byteOffset"]);
    glb[from..from + of(&view["byteLength"])]
        .as_chunks::<4>()
        .0
        .iter()
        .map(|b| f32::from_le_bytes(*b))
        .collect()
}

fn read(glb: &[u8]) -> Model {
    let mut report = base::Report::default();
    let spec = formats::ExportSpec::default();
    formats::read_model(glb, formats::ModelFormat::Glb, "x", &spec, &formats::no_files, &mut report)
        .expect("reads")
}

/// A thousandth of a leaf in places about a crown.
fn copies() -> mesh::Copies {
    let place = |k: u32| {
        let angle = 0.7 * f64::from(k);
        mesh::CopyPlace {
            at: glam::DVec3::new(base::ops::sin(angle), 2.0 + 0.1 * f64::from(k), base::ops::cos(angle)),
            turn: base::turn::about(glam::DVec3::new(0.6, 0.0, 0.8), angle),
            scale: 0.05 + 0.01 * f64::from(k % 3),
            color: [0.5, 1.0, 0.25 + 0.02 * k as f32],
        }
    };
    let mut mesh = grid(2);
    mesh.colors.clear();
    mesh::Copies {
        name: "leaves".into(),
        material: MaterialId::new(0),
        mesh,
        places: (0..20).map(place).collect(),
    }
}

#[test]
fn levels_stand_in_one_file_and_share_their_textures() {
    use formats::{Level, Packing, write_glb_levels};
    let (fine, coarse, far) = (model(8), model(4), model(2));
    let levels = [&fine, &coarse, &far].map(Level::plain);
    for packing in [None, Some(Packing::Quantized), Some(Packing::Compressed)] {
        let mut glb = Vec::new();
        write_glb_levels(&levels, packing, &mut PngCache::new(), &mut glb).expect("writes");
        let j = json_of(&glb);
        assert!(
            j["extensionsUsed"].as_array().is_some_and(|e| e.contains(&"MSFT_lod".into())),
            "{packing:?}"
        );
        assert!(
            !j["extensionsRequired"].to_string().contains("MSFT_lod"),
            "who knows no levels shows the first"
        );
        let ids = j["nodes"][0]["extensions"]["MSFT_lod"]["ids"].as_array().expect("levels").clone();
        assert_eq!(j["nodes"][0]["extras"]["MSFT_screencoverage"], serde_json::json!([0.5, 0.25, 0.0]));
        assert_eq!((j["scenes"][0]["nodes"].clone(), ids.len()), (serde_json::json!([0]), 2));
        assert_eq!(j["images"].as_array().map(Vec::len), Some(1), "{packing:?}");
        // Each level has its triangles.
        let of = |v: &serde_json::Value| v.as_u64().expect("a row") as usize;
        let count = |node: usize| -> usize {
            let children = j["nodes"][node]["children"].as_array().expect("parts").clone();
            let mesh = |c: &serde_json::Value| of(&j["nodes"][of(c)]["mesh"]);
            let indices = |c| of(&j["meshes"][mesh(c)]["primitives"][0]["indices"]);
            children.iter().map(|c| of(&j["accessors"][indices(c)]["count"]) / 3).sum()
        };
        let counted: Vec<usize> = core::iter::once(0).chain(ids.iter().map(of)).map(count).collect();
        assert_eq!(counted, [&fine, &coarse, &far].map(Model::triangle_count), "{packing:?}");
        assert_eq!(
            read(&glb).triangle_count(),
            fine.triangle_count(),
            "a reader without levels sees the first"
        );
    }
}

#[test]
fn copies_are_read_back_where_they_stand() {
    use formats::{Level, Packing, write_glb_levels};
    let (tree, copies) = (model(3), [copies()]);
    let flat = copies[0].flattened();
    for packing in [None, Some(Packing::Quantized), Some(Packing::Compressed)] {
        let mut glb = Vec::new();
        let level = Level { model: &tree, copies: &copies };
        write_glb_levels(&[level], packing, &mut PngCache::new(), &mut glb).expect("writes");
        let back = read(&glb);
        let leaves = &back.parts.last().expect("a part").mesh;
        assert_eq!(leaves.triangles.len(), flat.mesh.triangles.len());
        // Packed, vertices have another order: corners of triangles are compared.
        let corners = |m: &TriMesh| {
            let mut all: Vec<[i64; 3]> = (m.triangles.iter().flatten())
                .map(|&i| m.positions[i as usize].map(|x| (f64::from(x) * 2000.0).round() as i64))
                .collect();
            all.sort_unstable();
            all
        };
        let far = |a: &[i64; 3], b: &[i64; 3]| (0..3).map(|k| (a[k] - b[k]).abs()).max().unwrap_or(0);
        let (a, b) = (corners(leaves), corners(&flat.mesh));
        let near = a.iter().filter(|p| b.iter().any(|q| far(p, q) <= 1)).count();
        assert_eq!(near, a.len(), "{packing:?}");
        // Compressed, a tint is in bytes.
        let is_tint = |c: &[f32; 3]| c.iter().zip([0.5, 1.0, 0.25]).all(|(a, b)| (a - b).abs() < 1.0 / 255.0);
        assert!(leaves.colors.iter().any(is_tint), "{packing:?}: {:?}", leaves.colors.first());
        if packing.is_none() {
            // As a program of its own would read it.
            let j = json_of(&glb);
            assert!(j["extensionsRequired"].to_string().contains("EXT_mesh_gpu_instancing"));
            let node = j["nodes"].as_array().and_then(|n| n.last()).expect("a node");
            let attributes = &node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
            let at = floats(&glb, &j, &attributes["TRANSLATION"]);
            let place = copies[0].places[3];
            assert_eq!(at[9..12], place.at.to_array().map(|x| x as f32));
            assert_eq!(floats(&glb, &j, &attributes["_COLOR_0"])[9..12], place.color);
        }
    }
}

#[test]
fn joints_move_vertices_as_the_rig_says() {
    use formats::write_glb_rigged;
    use mesh::{Hold, Joint, Rig};
    let tree = model(4);
    let joint = |name: &str, y: f64| Joint { name: name.into(), at: glam::DVec3::Y * y };
    let hold = |p: &[f32; 3]| Hold { joints: [0, 1, 0, 0], shares: [1.0 - p[1], p[1], 0.0, 0.0] };
    let turned = |k: usize| {
        let angle = [0.0, 0.3, 0.0][k];
        (base::turn::about(glam::DVec3::Z, angle), glam::DVec3::X * [0.0, 0.1, 0.0][k])
    };
    let rig = Rig {
        joints: vec![joint("ground", 0.0), joint("limb", 0.25)],
        holds: tree.parts.iter().map(|p| p.mesh.positions.iter().map(hold).collect()).collect(),
        seconds: vec![0.0, 1.0, 2.0],
        moves: vec![vec![(glam::DQuat::IDENTITY, glam::DVec3::ZERO); 3], (0..3).map(turned).collect()],
    };
    let mut glb = Vec::new();
    write_glb_rigged(&tree, &rig, &mut PngCache::new(), &mut glb).expect("writes");
    let j = json_of(&glb);
    let of = |v: &serde_json::Value| v.as_u64().expect("a row") as usize;
    // Skinned meshes stand at the top of the scene and nowhere else.
    let tops = j["scenes"][0]["nodes"].as_array().expect("nodes").clone();
    assert_eq!(tops.len(), 1 + tree.parts.len());
    let part = &j["nodes"][of(&tops[1])];
    assert!(part["skin"] == 0 && part.get("translation").is_none());
    let attributes = &j["meshes"][of(&part["mesh"])]["primitives"][0]["attributes"];
    let weights = floats(&glb, &j, &attributes["WEIGHTS_0"]);
    let positions = floats(&glb, &j, &attributes["POSITION"]);
    // The second key, by the file alone: of the joint's turn and place, and the inverse of how it was bound.
    let animation = &j["animations"][0];
    let track = |path: &str| {
        let channel =
            animation["channels"].as_array().expect("channels").iter().find(|c| c["target"]["path"] == path);
        floats(&glb, &j, &animation["samplers"][of(&channel.expect("a channel")["sampler"])]["output"])
    };
    let (turn, place) = (track("rotation"), track("translation"));
    let turn = glam::Quat::from_slice(&turn[4..8]);
    let place = glam::Vec3::from_slice(&place[3..6]);
    let bound = floats(&glb, &j, &j["skins"][0]["inverseBindMatrices"]);
    let back = glam::Mat4::from_cols_slice(&bound[16..32]);
    for (k, p) in positions.chunks_exact(3).enumerate() {
        let p = glam::Vec3::from_slice(p);
        let moved = (glam::Mat4::from_rotation_translation(turn, place) * back).transform_point3(p);
        let w = &weights[4 * k..4 * k + 4];
        let seen = p * w[0] + moved * w[1];
        let said = rig.moved(p.as_dvec3(), &rig.holds[0][k], 1).as_vec3();
        assert!(seen.distance(said) < 1e-5 && (w[0] + w[1] - 1.0).abs() < 1e-6, "{p}: {seen} and {said}");
    }
    let short = Rig { seconds: vec![0.0, 1.0], ..rig };
    let refused = write_glb_rigged(&tree, &short, &mut PngCache::new(), &mut Vec::new());
    assert!(matches!(refused, Err(formats::WriteError::Rig)));
}

#[test]
fn levels_and_shapes_are_named_nodes_and_wind_is_in_sets_of_coordinates() {
    use formats::{NamedNodes, write_glb_nodes};
    let fine = carried();
    let mut coarse = fine.clone();
    coarse.parts.truncate(1);
    let shape = grid(1);
    let levels = vec![("oak_LOD0".to_owned(), &fine), ("oak_LOD1".to_owned(), &coarse)];
    let shapes = vec![("oak_collider".to_owned(), shape)];
    let mut glb = Vec::new();
    let cells = vec![vec![vec![[0.25, 0.75]; fine.parts[0].mesh.positions.len()]]];
    let nodes = NamedNodes { name: "oak".into(), levels, shapes, cells };
    write_glb_nodes(&nodes, &mut PngCache::new(), &mut glb).expect("writes");
    let j = json_of(&glb);
    let names: Vec<&str> =
        j["nodes"].as_array().expect("nodes").iter().filter_map(|n| n["name"].as_str()).collect();
    assert_eq!(names, ["oak", "oak_LOD0", "oak_LOD1", "oak_collider"]);
    assert_eq!(j["nodes"][0]["children"], serde_json::json!([1, 2, 3]));
    assert_eq!(j["materials"].as_array().map(Vec::len), Some(fine.materials.len()), "levels share materials");
    assert!(j["meshes"][2]["primitives"][0].get("material").is_none(), "a shape has none");
    let attributes = &j["meshes"][0]["primitives"][0]["attributes"];
    assert_eq!(floats(&glb, &j, &attributes["TEXCOORD_1"])[..2], [0.25, 0.75]);
    let coarser = &j["meshes"][1]["primitives"][0]["attributes"];
    assert_eq!(coarser["TEXCOORD_1"], coarser["TEXCOORD_0"], "without cells");
    let mesh = &fine.parts[0].mesh;
    let [pair, last] =
        [floats(&glb, &j, &attributes["TEXCOORD_2"]), floats(&glb, &j, &attributes["TEXCOORD_5"])];
    assert_eq!(pair[..2], mesh.wind[0][..2]);
    assert_eq!(last[..2], [mesh.pivots[0][2], 1.0]);
}
