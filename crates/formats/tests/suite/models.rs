//! Written files read back the same.
#![allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "test data are small numbers")]

use crate::missing;
use std::sync::Arc;

use base::{Report, Unit, UpAxis};
use formats::{
    ExportSpec, FileStems, ModelFormat, ModelSummary, NoFile, SideFile, file_name, no_files, obj_files,
    read_model, usd_files, write_glb, write_model,
};
use mesh::{AlphaMode, Material, MaterialId, MaterialKind, Model, Part, Texture, TriMesh};

fn grid(n: u32, at: f64) -> TriMesh {
    let mut m = TriMesh::default();
    let f = |i: u32| f64::from(i) / f64::from(n);
    for j in 0..=n {
        for i in 0..=n {
            m.push(glam::DVec3::new(f(i) + at, f(j), 0.1 * f(i) * f(j)));
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

fn model() -> Model {
    let pixels: Vec<u8> =
        (0..16 * 8).flat_map(|i| [i as u8, 120, 40, if i % 7 == 0 { 0 } else { 255 }]).collect();
    let texture = Arc::new(Texture { width: 16, height: 8, pixels });
    let leaf = Material {
        texture: Some(Arc::clone(&texture)),
        alpha: AlphaMode::Mask,
        double_sided: true,
        translucency: 0.25,
        roughness: 0.5,
        ..Material::plain("leaf", MaterialKind::Leaf, [0.25, 0.5, 0.125])
    };
    let petal =
        Material { texture: Some(texture), ..Material::plain("rose petal", MaterialKind::Petal, [1.0; 3]) };
    let bark = Material::plain("bark", MaterialKind::Bark, [0.5, 0.25, 0.125]);
    let mut bare = grid(2, 3.0);
    bare.colors.clear();
    bare.uvs.clear();
    let part = |name: &str, id, mesh| Part { name: name.into(), material: MaterialId::new(id), mesh };
    Model {
        name: "an oak".into(),
        parts: vec![
            part("leaves", 0, grid(9, 0.0)),
            part("petals 2", 1, grid(3, 1.5)),
            part("trunk", 2, bare),
        ],
        materials: vec![leaf, petal, bark],
        offset_m: None,
    }
}

fn read(bytes: &[u8], format: ModelFormat, spec: &ExportSpec) -> Model {
    let mut report = Report::default();
    let m = read_model(bytes, format, "x", spec, &no_files, &mut report).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(report.warnings, [], "nothing to warn of");
    assert_eq!(m.validate().collect::<Vec<_>>(), [], "sound");
    m
}

fn worst<const N: usize>(a: &[[f32; N]], b: &[[f32; N]]) -> f32 {
    assert_eq!(a.len(), b.len(), "as many rows");
    a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

#[test]
fn glb_comes_back_identical() {
    let m = model();
    let mut glb = Vec::new();
    write_glb(&m, &mut glb).expect("writes");
    assert_eq!(read(&glb, ModelFormat::Glb, &ExportSpec::default()), m);
}

#[test]
fn large_indices_come_back() {
    let mut m = model();
    m.parts[0].mesh = grid(260, 0.0);
    let mut glb = Vec::new();
    write_glb(&m, &mut glb).expect("writes");
    assert_eq!(read(&glb, ModelFormat::Glb, &ExportSpec::default()), m);
}

#[test]
fn obj_comes_back_with_its_materials() {
    let m = model();
    let spec = ExportSpec { up: UpAxis::Z, unit: Unit::Centimetre };
    let files = obj_files(&m, "my oak", &spec).expect("writes");
    assert_eq!(files.textures.len(), 1, "a shared texture is written once");
    let resolve = |file: SideFile<'_>| match file.name {
        "my-oak.mtl" => Ok(files.mtl.clone()),
        name => files.textures.iter().find(|(n, _)| n == name).map(|(_, b)| b.clone()).ok_or(NoFile::Missing),
    };
    let mut report = Report::default();
    let back =
        read_model(&files.obj[..], ModelFormat::Obj, "x", &spec, &resolve, &mut report).expect("reads");
    assert_eq!(report.warnings, []);
    assert_eq!((&back.name, &back.materials), (&m.name, &m.materials));
    for (a, b) in m.parts.iter().zip(&back.parts) {
        assert_eq!((&a.name, a.material, &a.mesh.triangles), (&b.name, b.material, &b.mesh.triangles));
        assert!(worst(&a.mesh.positions, &b.mesh.positions) < 1e-6);
        assert!(worst(&a.mesh.normals, &b.mesh.normals) < 1e-6);
        assert!(worst(&a.mesh.uvs, &b.mesh.uvs) < 1e-6);
        assert!(worst(&a.mesh.colors, &b.mesh.colors) < 1e-5);
    }
}

#[test]
fn names_beside_a_model_are_of_any_script_and_differ() {
    for (name, want) in [
        ("two words", "two-words"),
        ("花", "花"),
        ("हिन्दी 🌹", "हिन्दी-🌹"),
        ("a\u{202e}b\u{200d}c", "abc"),
        ("..", "model"),
        ("a/b\\c:d\0e\u{fffd}f\u{2028}g", "a-b-c-d-e-f-g"),
    ] {
        assert_eq!(file_name(name, "model"), want, "{name:?}");
    }
    assert_eq!((file_name(&"花".repeat(99), "").len(), file_name(&"x".repeat(999), "").len()), (207, 100));

    let mut m = model();
    let texture = m.materials.iter().find_map(|m| m.texture.clone()).expect("one has a texture");
    for (material, name) in m.materials.iter_mut().zip(["Leaf", "leaf"]) {
        material.name = name.into();
        let mut own = (*texture).clone();
        own.pixels[0] = own.pixels[0].wrapping_add(u8::from(name == "leaf"));
        material.texture = Some(own.into());
    }
    let stems = FileStems { model: "a", textures: "a-" };
    let files = obj_files(&m, stems, &ExportSpec::default()).expect("writes");
    assert_eq!(files.mtl_name, "a.mtl");
    // Names that differ only in case stay distinct.
    let names: Vec<&str> = files.textures.iter().map(|t| t.0.as_str()).collect();
    assert_eq!(names, ["a--Leaf.png", "a--leaf-2.png"]);
    let mtl = String::from_utf8(files.mtl).expect("text");
    assert!(names.iter().all(|n| mtl.contains(&format!("map_Kd {n}\n"))), "{mtl}");
}

#[test]
fn obj_of_other_programs_is_read() {
    let text = "mtllib a.mtl\ng one\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl red\nf 1 2 3 4\nf -4 -2 \\\n -1\ng two\nl 1 2\nf 1 2 4\n";
    let mut report = Report::default();
    let m = read_model(
        text.as_bytes(),
        ModelFormat::Obj,
        "x",
        &ExportSpec::default(),
        &|file| match file.name {
            "a.mtl" => Ok(b"newmtl red\nKd 1 0 0\nmap_Kd -s 1 1 1 gone.png\n".to_vec()),
            _ => Err(NoFile::Missing),
        },
        &mut report,
    )
    .expect("reads");
    assert_eq!(m.parts.iter().map(|p| p.mesh.triangles.len()).collect::<Vec<_>>(), [3, 1]);
    assert_eq!(m.materials[0].base_color, [1.0, 0.0, 0.0]);
    assert_eq!(m.parts[0].mesh.normals[0], [0.0, 0.0, 1.0], "normals are made where there are none");
    let codes: Vec<_> = report.warnings.iter().map(|w| w.code).collect();
    assert_eq!(codes, ["texture-missing", "obj-left-out"]);
}

#[test]
fn ply_comes_back_as_one_mesh() {
    let m = model();
    for spec in [ExportSpec::default(), ExportSpec { up: UpAxis::Z, unit: Unit::Millimetre }] {
        let mut ply = Vec::new();
        write_model(&m, ModelFormat::Ply, &spec, &mut ply, &mut Report::default()).expect("writes");
        let back = read(&ply, ModelFormat::Ply, &spec);
        let mesh = &back.parts[0].mesh;
        assert_eq!((mesh.positions.len(), mesh.triangles.len()), (m.vertex_count(), m.triangle_count()));
        let first = &m.parts[0].mesh;
        assert!(worst(&first.positions, &mesh.positions[..100]) < 1e-6);
        assert!(worst(&first.normals, &mesh.normals[..100]) < 1e-6);
        assert!(worst(&first.uvs, &mesh.uvs[..100]) < 1e-6);
        assert_eq!(first.triangles[..], mesh.triangles[..first.triangles.len()]);
        let trunk = mesh.colors.last().expect("colours");
        assert!(worst(&[*trunk], &[[0.5, 0.25, 0.125]]) < 0.005, "base colour as vertex colour: {trunk:?}");
    }
}

#[test]
fn ply_text_and_big_endian_are_read() {
    let header = |format: &str| {
        format!(
            "ply\nformat {format} 1.0\ncomment x\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
             property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\nproperty list uchar int vertex_indices\n\
             element edge 1\nproperty int a\nend_header\n"
        )
    };
    let text = header("ascii") + "0 0 0 255 0 0\n1 0 0 0 255 0\n1 1 0 0 0 255\n0 1 0 9 9 9\n4 0 1 2 3\n7\n";
    let mut big = header("binary_big_endian").into_bytes();
    for (p, c) in [
        ([0.0, 0.0], [255, 0, 0]),
        ([1.0, 0.0], [0, 255, 0]),
        ([1.0, 1.0], [0, 0, 255]),
        ([0.0_f32, 1.0], [9, 9, 9_u8]),
    ] {
        [p[0], p[1], 0.0].iter().for_each(|x: &f32| big.extend(x.to_be_bytes()));
        big.extend(c);
    }
    big.push(4);
    (0..4_i32).chain([7]).for_each(|i| big.extend(i.to_be_bytes()));
    let mut models = Vec::new();
    for bytes in [text.into_bytes(), big] {
        let mut report = Report::default();
        let m = read_model(&bytes[..], ModelFormat::Ply, "q", &ExportSpec::default(), &no_files, &mut report);
        assert_eq!(report.warnings.len(), 1, "edges are left out and said");
        models.push(m.unwrap_or_else(|e| panic!("{e}")));
    }
    assert_eq!(models[0], models[1]);
    assert_eq!(models[0].parts[0].mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(models[0].parts[0].mesh.colors[0], [1.0, 0.0, 0.0]);
}

#[test]
fn stl_comes_back_welded() {
    let m = model();
    let spec = ExportSpec { up: UpAxis::Z, unit: Unit::Metre };
    let mut stl = Vec::new();
    write_model(&m, ModelFormat::Stl, &spec, &mut stl, &mut Report::default()).expect("writes");
    let back = read(&stl, ModelFormat::Stl, &spec);
    assert_eq!(back.triangle_count(), m.triangle_count());
    assert_eq!(back.vertex_count(), m.vertex_count(), "one vertex for each place");
    let (a, b) = (m.bounds(), back.bounds());
    assert!((a.min - b.min).length() + (a.max - b.max).length() < 1e-5);
    let text = "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid x\n";
    assert_eq!(read(text.as_bytes(), ModelFormat::Stl, &ExportSpec::default()).triangle_count(), 1);
}

#[test]
fn gltf_node_transforms_are_applied() {
    // One triangle in a data URI; the node turns it by a quarter about z, mirrors x, and lifts it by 10.
    let json = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
        "nodes":[{"name":"plant","children":[1],"translation":[0,10,0]},{"name":"leaf","mesh":0,"rotation":[0,0,0.70710678118654752,0.70710678118654752],"scale":[-1,1,1]}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
        "bufferViews":[{"buffer":0,"byteLength":36}],
        "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}"#;
    let m = read(json.as_bytes(), ModelFormat::Gltf, &ExportSpec::default());
    assert_eq!((m.name.as_str(), m.parts[0].name.as_str()), ("plant", "leaf"));
    let mesh = &m.parts[0].mesh;
    assert!(
        worst(&mesh.positions, &[[0.0, 10.0, 0.0], [0.0, 9.0, 0.0], [-1.0, 10.0, 0.0]]) < 1e-6,
        "{mesh:?}"
    );
    assert_eq!(mesh.triangles, [[0, 2, 1]], "a mirrored triangle is turned to face outside");
    assert_eq!(mesh.normals[0], [0.0, 0.0, 1.0]);
}

#[test]
fn hostile_gltf_is_refused_with_its_place() {
    let with = |nodes: &str, meshes: &str, accessor: &str| {
        format!(
            r#"{{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0]}}],"nodes":{nodes},"meshes":{meshes},
            "accessors":[{accessor}],"bufferViews":[{{"buffer":0,"byteLength":36}}],
            "buffers":[{{"byteLength":36,"uri":"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}}]}}"#
        )
    };
    let good = r#"{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}"#;
    let mesh = r#"[{"primitives":[{"attributes":{"POSITION":0}}]}]"#;
    let cases = [
        (with(r#"[{"children":[0]}]"#, mesh, good), "node 0"),
        (with(r#"[{"mesh":7}]"#, mesh, good), "mesh 7"),
        (with(r#"[{"mesh":0}]"#, mesh, &good.replace("\"count\":3", "\"count\":4000000000")), "TooMuch"),
        (
            with(r#"[{"mesh":0}]"#, mesh, &good.replace("\"count\":3", "\"count\":4")),
            "accessor 0: it reaches beyond",
        ),
        (with(r#"[{"mesh":0}]"#, mesh, &good.replace("5126", "5125000")), "component type"),
        (with(r#"[{"mesh":0}]"#, &mesh.replace(":0}", ":0},\"material\":3"), good), "material 3"),
        (with(r#"[{"mesh":0}]"#, mesh, &good.replace("\"count\"", "\"sparse\":{},\"count\"")), "sparse"),
    ];
    for (json, want) in cases {
        let e = read_model(
            json.as_bytes(),
            ModelFormat::Gltf,
            "x",
            &ExportSpec::default(),
            &no_files,
            &mut Report::default(),
        )
        .expect_err(want);
        let told = format!("{e} {:?}", e.fault);
        assert!(told.contains(want), "{want} in {told}");
    }
}

#[test]
fn lying_headers_are_refused_before_anything_is_reserved() {
    let ply = "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000000\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
    let list = "ply\nformat binary_little_endian 1.0\nelement face 1\nproperty list uint int vertex_indices\nend_header\n\u{7f}\u{7f}\u{7f}\u{7f}";
    let mut stl = [0_u8; 84];
    stl[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    for (bytes, format) in [
        (ply.as_bytes(), ModelFormat::Ply),
        (list.as_bytes(), ModelFormat::Ply),
        (&stl[..], ModelFormat::Stl),
        (b"glTF\x02\0\0\0\xff\xff\xff\xff\xff\xff\xff\xffJSON{}", ModelFormat::Glb),
    ] {
        let e = read_model(bytes, format, "x", &ExportSpec::default(), &no_files, &mut Report::default())
            .expect_err("refused");
        assert!(e.to_string().contains("cut off"), "{e}");
    }
}

#[test]
fn a_wish_for_other_units_of_gltf_is_answered() {
    let mut report = Report::default();
    let spec = ExportSpec { up: UpAxis::Z, unit: Unit::Metre };
    write_model(&model(), ModelFormat::Glb, &spec, Vec::new(), &mut report).expect("writes");
    assert_eq!(report.warnings[0].code, "gltf-fixed-units");
    for format in ModelFormat::ALL {
        let written = write_model(&model(), format, &spec, Vec::new(), &mut report);
        assert_eq!(written.is_ok(), format.row().is_written(), "{format:?}: {written:?}");
    }
}

#[test]
fn wind_comes_back_and_is_missed_where_there_is_no_room() {
    let mut m = model();
    for part in &mut m.parts {
        part.mesh.wind = part.mesh.positions.iter().map(|p| [p[0].min(1.0), p[1], 0.5, 0.25]).collect();
        part.mesh.pivots = part.mesh.positions.iter().map(|p| [p[0], 0.0, p[2]]).collect();
    }
    let mut glb = Vec::new();
    write_glb(&m, &mut glb).expect("writes");
    assert_eq!(read(&glb, ModelFormat::Glb, &ExportSpec::default()), m);
    assert!(ModelSummary::from_model(&m, &[]).parts.iter().all(|p| p.wind));
    for format in [ModelFormat::Obj, ModelFormat::Ply, ModelFormat::Stl] {
        let mut report = Report::default();
        write_model(&m, format, &ExportSpec::default(), Vec::new(), &mut report).expect("writes");
        assert_eq!(report.warnings[0].code, "wind-left-out", "{format:?}");
    }
    let mut report = Report::default();
    write_model(&m, ModelFormat::Usda, &ExportSpec::default(), Vec::new(), &mut report).expect("writes");
    assert_eq!(report.warnings, []);
}

#[test]
fn wind_of_other_programs_is_left_out() {
    let mut m = model();
    m.parts.truncate(1);
    let n = m.parts[0].mesh.positions.len();
    m.parts[0].mesh.wind = vec![[0.25; 4]; n];
    let mut glb = Vec::new();
    write_glb(&m, &mut glb).expect("writes");
    // A value of another program, beyond our 0 to 1.
    let ours = [0.25_f32; 4].map(f32::to_le_bytes).concat();
    let at = glb.windows(16).rposition(|w| w == ours).expect("wind");
    glb[at..at + 4].copy_from_slice(&7.0_f32.to_le_bytes());
    let mut report = Report::default();
    let back = read_model(&glb[..], ModelFormat::Glb, "x", &ExportSpec::default(), &no_files, &mut report);
    let back = back.expect("reads");
    assert_eq!(report.warnings[0].code, "gltf-wind-left-out");
    assert_eq!(back.parts[0].mesh, TriMesh { wind: Vec::new(), ..m.parts[0].mesh.clone() });
}

/// The numbers of an array of the text, by its name.
fn usd_numbers(text: &str, from: usize, name: &str) -> Vec<f64> {
    let start = text[from..].find(&format!("{name} = [")).unwrap_or_else(|| panic!("no {name}")) + from;
    let array = &text[start + name.len() + 4..];
    let array = &array[..array.find(']').expect("closed")];
    array.split([',', '(', ')']).filter_map(|w| w.trim().parse().ok()).collect()
}

#[test]
fn usd_says_what_the_model_says() {
    let m = model();
    let spec = ExportSpec { up: UpAxis::Z, unit: Unit::Centimetre };
    let files = usd_files(&m, "my oak", &spec).expect("writes");
    assert_eq!(files.textures.len(), 1, "a shared texture is written once");
    assert_eq!(files.textures[0].0, "my-oak-leaf.png");
    let text = String::from_utf8(files.usda).expect("UTF-8");
    let head = text.split(")\n").next().expect("a head");
    for line in ["defaultPrim = \"an_oak\"", "metersPerUnit = 0.01", "upAxis = \"Z\""] {
        assert!(head.contains(line), "{line} in {head}");
    }
    assert_eq!(text.matches('{').count(), text.matches('}').count());
    for (part, name) in m.parts.iter().zip(["leaves", "petals_2", "trunk"]) {
        let from = text.find(&format!("def Mesh \"{name}\"")).expect("each part");
        let points = usd_numbers(&text, from, "points");
        let want: Vec<f64> = part.mesh.positions.iter().flat_map(|&p| spec.point(p)).map(f64::from).collect();
        assert_eq!(points.len(), want.len());
        assert!(points.iter().zip(&want).all(|(a, b)| (a - b).abs() < 1e-4), "{name}");
        let corners = usd_numbers(&text, from, "faceVertexIndices");
        assert_eq!(corners, part.mesh.triangles.iter().flatten().map(|&i| f64::from(i)).collect::<Vec<_>>());
        assert_eq!(usd_numbers(&text, from, "faceVertexCounts"), vec![3.0; part.mesh.triangles.len()]);
        assert_eq!(usd_numbers(&text, from, "normals").len(), points.len());
    }
    assert_eq!(text.matches("subdivisionScheme = \"none\"").count(), 3);
    assert_eq!(text.matches("UsdPreviewSurface").count(), 3);
    assert_eq!(text.matches("inputs:opacityThreshold = 0.5").count(), 1, "the leaf has holes");
    assert_eq!(text.matches("uniform bool doubleSided = 1").count(), 1);
    assert!(!text.contains("primvars:wind") && !text.contains("primvars:pivot"));
    let trunk = text.find("def Mesh \"trunk\"").expect("trunk");
    assert!(!text[trunk..].contains("primvars:st"), "no coordinates where there are none");
    let v = usd_numbers(&text, 0, "primvars:st")[1];
    assert!((v - (1.0 - f64::from(m.parts[0].mesh.uvs[0][1]))).abs() < 1e-6, "t points up");
    let again = usd_files(&m, "my oak", &spec).expect("writes");
    assert_eq!(text.as_bytes(), again.usda, "the same bytes");
}

#[test]
fn usd_is_not_read_and_says_so() {
    let files = usd_files(&model(), "x", &ExportSpec::default()).expect("writes");
    assert_eq!(ModelFormat::sniff(&files.usda), Some(ModelFormat::Usda));
    let read = read_model(
        &files.usda[..],
        ModelFormat::Usda,
        "x",
        &ExportSpec::default(),
        &no_files,
        &mut Report::default(),
    );
    let e = read.expect_err("is refused").to_string();
    assert!(e.contains("reading USD is not supported") && e.contains(".glb"), "{e}");
}

/// Files for other readers: `USD_OUT=DIR cargo test -p burgeon-formats --test suite models::`.
#[test]
fn samples_for_readers_of_usd() {
    let Some(dir) = std::env::var_os("USD_OUT").map(std::path::PathBuf::from) else {
        println!("USD_OUT is not set: no sample files were written");
        return;
    };
    let mut m = model();
    m.parts[1].mesh.wind = vec![[0.5; 4]; m.parts[1].mesh.positions.len()];
    m.parts[1].mesh.pivots = m.parts[1].mesh.positions.clone();
    m.parts[2].mesh.triangles.clear();
    m.parts[1].name = "\u{82b1} \"x\"".into();
    m.name = "a \"strange\" \\ name".into();
    let files = usd_files(&m, "sample", &ExportSpec::default()).expect("writes");
    std::fs::write(dir.join("sample.usda"), files.usda).expect("saves");
    for (name, png) in files.textures {
        std::fs::write(dir.join(name), png).expect("saves");
    }
}

#[test]
fn the_summary_says_what_is_there() {
    let info = ModelSummary::from_model(&model(), &[]);
    assert_eq!((info.parts.len(), info.materials[0].texture, info.vertices), (3, Some([16, 8]), 125));
    assert_eq!((info.min, info.unit, info.warnings.len()), ([0.0; 3], "m", 0));
    assert!(serde_json::to_string(&info).expect("JSON").contains("\"kind\":\"leaf\""));
}

/// The real scan in the shared data folder, where it is there.
#[test]
fn a_real_scan_is_read() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data/scans/tomato_series/03-10.ply");
    let Ok(bytes) = std::fs::read(path) else {
        return missing::skipped(path);
    };
    let m = read_model(
        &bytes[..],
        ModelFormat::Ply,
        "scan",
        &ExportSpec::default(),
        &no_files,
        &mut Report::default(),
    )
    .unwrap_or_else(|e| panic!("{e}"));
    assert!(m.vertex_count() > 10_000, "{}", m.vertex_count());
    assert!(m.bounds().size().min_element() > 0.0);
}

#[test]
fn a_scan_of_our_own_is_read_as_a_model_of_points() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/scans/leaf.ply");
    let bytes = std::fs::read(path).unwrap_or_else(|e| panic!("{path}: {e}"));
    let m = read(&bytes, ModelFormat::Ply, &ExportSpec::default());
    assert_eq!(m.vertex_count(), 2064);
    assert!(m.bounds().size().min_element() > 0.0);
}

/// Found by fuzzing: the squares of these normals are beyond f32.
#[test]
fn tiny_and_huge_normals_become_units() {
    for n in ["1e-23 0 0", "1e-42 2e-42 0", "1e30 -1e30 0", "3e38 3e38 3e38", "0 0 0"] {
        let text = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn {n}\nf 1//1 2//1 3//1\n");
        let read = read(text.as_bytes(), ModelFormat::Obj, &ExportSpec::default());
        assert_eq!(read.validate().next(), None, "{n}");
    }
}

/// Who asks for what, in order.
fn asked_of(
    bytes: &[u8],
    format: ModelFormat,
    give: &dyn Fn(SideFile<'_>) -> Result<Vec<u8>, NoFile>,
) -> (Result<Model, formats::ModelError>, Vec<String>) {
    let asked = core::cell::RefCell::new(Vec::new());
    let resolve = |file: SideFile<'_>| {
        asked.borrow_mut().push(format!("{} by {}", file.name, file.by.unwrap_or("the model")));
        give(file)
    };
    let read = read_model(bytes, format, "x", &ExportSpec::default(), &resolve, &mut Report::default());
    (read, asked.into_inner())
}

#[test]
fn a_file_is_asked_for_once_and_by_who_names_it() {
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let give = |file: SideFile<'_>| match file.name {
        "m/a.mtl" | "b.mtl" => Ok(b"newmtl a\nmap_Kd t.png\nnewmtl b\nmap_Kd t.png\n".to_vec()),
        _ => Err(NoFile::Missing),
    };
    let text = "mtllib m/a.mtl\nmtllib gone.mtl\nmtllib b.mtl\n".repeat(100) + triangle;
    let (read, asked) = asked_of(text.as_bytes(), ModelFormat::Obj, &give);
    assert!(read.is_ok(), "{read:?}");
    let want = [
        "m/a.mtl by the model",
        "t.png by m/a.mtl",
        "t.png by the model",
        "gone.mtl by the model",
        "b.mtl by the model",
        "t.png by b.mtl",
    ];
    assert_eq!(asked, want);
    let many: String = (0..5000).map(|k| format!("mtllib {k}.mtl\n")).collect();
    let (read, asked) = asked_of((many + triangle).as_bytes(), ModelFormat::Obj, &give);
    let line = read.expect_err("too many").to_string();
    assert!(line.contains("line 4097") && line.contains("the number of files that it names"), "{line}");
    assert_eq!(asked.len(), 4096);
}

#[test]
fn buffers_of_one_file_are_one_and_together_no_more_than_a_model() {
    let gltf = |buffers: &str, view: u32| {
        format!(
            r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
            "buffers":[{buffers}],"bufferViews":[{{"buffer":{view},"byteLength":36}}],"accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}}]}}"#
        )
    };
    let corners = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let bytes: Vec<u8> = corners.iter().flat_map(|x| x.to_le_bytes()).collect();
    let give = |_: SideFile<'_>| Ok(bytes.clone());
    let same = vec![r#"{"uri":"a.bin","byteLength":36}"#; 2000].join(",");
    let (read, asked) = asked_of(gltf(&same, 1999).as_bytes(), ModelFormat::Gltf, &give);
    assert_eq!(read.expect("reads").triangle_count(), 1);
    assert_eq!(asked, ["a.bin by the model"]);
    let large = |_: SideFile<'_>| Ok(vec![0; 400 << 20]);
    let three = [0, 1, 2].map(|k| format!(r#"{{"uri":"{k}.bin","byteLength":36}}"#)).join(",");
    let (read, asked) = asked_of(gltf(&three, 0).as_bytes(), ModelFormat::Gltf, &large);
    let line = read.expect_err("too large").to_string();
    assert!(line.contains("buffer 2") && line.contains("1073741824"), "{line}");
    assert_eq!(asked.len(), 3);
}

#[test]
fn what_must_not_be_read_ends_the_model_and_what_is_missing_does_not() {
    let why = || "a.obj: names \"../x\", which is not below its folder".to_owned();
    let refuse = |file: SideFile<'_>| match (file.name, file.by) {
        ("a.mtl", None) => Ok(b"newmtl a\nmap_Kd ../x\n".to_vec()),
        _ => Err(NoFile::Refused(why())),
    };
    let image = r#"{"asset":{"version":"2.0"},"images":[{"uri":"../x"}],"textures":[{"source":0}],
        "materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}]}"#;
    for (format, text) in [
        (ModelFormat::Obj, "mtllib ../x\nv 0 0 0\n"),
        (ModelFormat::Obj, "mtllib a.mtl\nv 0 0 0\n"),
        (ModelFormat::Gltf, image),
        (ModelFormat::Gltf, r#"{"asset":{"version":"2.0"},"buffers":[{"uri":"../x","byteLength":1}]}"#),
    ] {
        let (read, _) = asked_of(text.as_bytes(), format, &refuse);
        let fault = read.expect_err("refused").fault;
        assert!(
            matches!(&fault, formats::FileFault::Refused { why: said } if *said == why()),
            "{text}: {fault:?}"
        );
    }
    let (read, asked) = asked_of(b"mtllib ../x\nv 0 0 0\n", ModelFormat::Obj, &|_| Err(NoFile::Missing));
    assert!(read.is_ok() && asked == ["../x by the model"], "{read:?} {asked:?}");
}
