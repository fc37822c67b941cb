//! Every reader against thousands of broken files: a result or an error, never a panic, never a hang.
//!
//! Seeded, so that a failure comes back; the fuzz targets in `fuzz/` go on from here without end.
#![allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "test data are small numbers")]
#![allow(clippy::print_stdout, reason = "how many mutants were read, shown with --nocapture")]

use std::time::{Duration, Instant};

use base::{Draw, Report, Seed, Stream};
use formats::{
    CloudFormat, DrawingFormat, DrawingSummary, ExportSpec, MarksAxes, ModelFormat, ModelSummary, NoFile,
    SideFile, StructureFormat, StructureSpec, is_rays, no_files, obj_files, read_cloud, read_drawings,
    read_marks, read_model, read_rays, read_structure, read_vein_graph, write_cloud_ply, write_drawing,
    write_glb, write_model, write_structure,
};
use mesh::{Material, MaterialId, MaterialKind, Model, Part, TriMesh};

/// Mutants of each file, unless `BURGEON_MUTANTS` says how many: a longer run without a nightly compiler.
const MUTANTS: u64 = 6_000;

fn mutants() -> u64 {
    std::env::var("BURGEON_MUTANTS").ok().and_then(|n| n.parse().ok()).unwrap_or(MUTANTS)
}

const SVG: &[u8] = br##"<?xml version="1.0"?><!DOCTYPE svg [<!ENTITY c "red">]>
<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" viewBox="0 0 100 100">
<style>.a{stroke:&c;fill:none}</style><defs><g id="t"><path class="a" d="M0 0C1 2,3 4 5 6s1 1 2 2q1 1 2 0t1-1a3 2 30 1 0 5 5z"/></g></defs>
<g id="leaf-contour 1" transform="translate(3,4) rotate(30 1 2)"><use xlink:href="#t" x="3"/><polyline points="1,2 3,4 5.5e1,6" stroke="#123"/>
<rect x="1" y="2" width="5%" height="3mm" rx="1" stroke="rgb(1,2,3)"/><circle cx="5" cy="5" r="3" style="stroke:blue;fill:none"/></g>
<path fill="#123" d="M10 10L50 12L90 10L90 11L50 13L10 11Z"/><ellipse rx="3" ry="2" stroke="red"/><line x2="4" y2="5" stroke="red"/></svg>"##;

const INKML: &[u8] = br##"<ink xmlns="http://www.w3.org/2003/InkML"><definitions><brush xml:id="b"><brushProperty name="color" value="#102030"/></brush>
<context xml:id="c"><inkSource><traceFormat><channel name="X"/><channel name="Y"/><channel name="F" max="1023"/>
<intermittentChannels><channel name="T" units="s"/></intermittentChannels></traceFormat></inkSource></context></definitions>
<traceGroup contextRef="#c"><trace xml:id="a" brushRef="#b">1 2 3 4,'1'1'0,"2"2"0,!5!6!7</trace></traceGroup>
<trace continuation="end" priorRef="#a">1125 18432,'23'43,"7"-8,3-5,*?</trace></ink>"##;

const NDJSON: &[u8] = br#"{"word":"leaf","key_id":"123","recognized":true,"drawing":[[[1,2,3],[4,5,6],[0,10,20]],[[1.5],[2.5]]]}
{"word":"tree","drawing":[[[1,2],[3,4]]]}
{"burgeon":"drawing/1","strokes":[{"points":[[1,2]]}]}"#;

const JSON: &[u8] = br##"{"burgeon":"drawing/1","name":"a","y":"down","strokes":[{"id":"s","mode":"leaf-contour","color":"#a0b0c0",
"points":[[1,2,0,0.5],[3.5,4e1,16,null],[5,6,null,0.1]]},{"points":[[1,2],[3,4]]}]}"##;

const OBJ: &[u8] = b"# model x\nmtllib a.mtl\no one\nv 0 0 0 1 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 1\nvn 0 0 1\nusemtl red\nf 1/1/1 2/1/1 3/1/1 4/1/1\ng two\nf -4//-1 -2//1 \\\n-1//1\nl 1 2\n";
const MTL: &[u8] = b"newmtl red\n# burgeon kind=leaf translucency=0.5 double-sided\nKd 1 0 0\nPr 0.5\nmap_Kd t.png\nmap_d t.png\n";

const PLY_TEXT: &[u8] = b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 255 0 0\n1 0 0 0 255 0\n1 1 0 0 0 255\n3 0 1 2\n";
const STL_TEXT: &[u8] = b"solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid x\n";

fn model() -> Model {
    let mut mesh = TriMesh {
        positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        uvs: vec![[0.0; 2], [1.0, 0.0], [0.0, 1.0]],
        colors: vec![[1.0; 3]; 3],
        wind: vec![[0.0, 0.25, 0.5, 1.0]; 3],
        pivots: vec![[0.0; 3]; 3],
        triangles: vec![[0, 1, 2]],
        ..TriMesh::default()
    };
    mesh.compute_normals();
    let texture = mesh::Texture { width: 2, height: 2, pixels: vec![200; 16] };
    let material = Material {
        texture: Some(texture.into()),
        ..Material::plain("leaf", MaterialKind::Leaf, [0.1, 0.5, 0.1])
    };
    let part = Part { name: "leaves".into(), material: MaterialId::new(0), mesh };
    Model { name: "m".into(), parts: vec![part], materials: vec![material], ..Model::default() }
}

/// Words that break readers: numbers beyond everything, openings without closings, prefixes of other things.
const NASTY: [&[u8]; 28] = [
    b"NaN",
    b"1e999",
    b"-1e300",
    b"1e-400",
    b"99999999999999999999",
    b"-",
    b"\0",
    b"\xff\xff\xff\xff",
    b"<",
    b">",
    b"&a;",
    b"\"",
    b"'",
    b"[[[[[[[[",
    b"{\"a\":",
    b"#",
    b"<g>",
    b"</g>",
    b"<use href=\"#t\"/>",
    b"A1e300 1 0 1 1 9 9",
    b",",
    b"\n",
    b"null",
    b"4294967295",
    b"\x7f\x7f\x7f\x7f",
    b"*",
    b"?",
    b"!",
];

fn mutate(seed: &[u8], rng: &mut Stream) -> Vec<u8> {
    let mut bytes = seed.to_vec();
    for _ in 0..=rng.below(6) {
        if bytes.is_empty() {
            break;
        }
        let at = rng.below(bytes.len());
        let length = rng.below(1 + (bytes.len() - at).min(40));
        match rng.below(8) {
            0 => bytes[at] ^= 1 << rng.below(8),
            1 => bytes[at] = rng.below(256) as u8,
            2 => bytes.truncate(at),
            3 => drop(bytes.drain(at..at + length)),
            4 => {
                let copy = bytes[at..at + length].to_vec();
                let to = rng.below(bytes.len());
                bytes.splice(to..to, copy);
            }
            5 => {
                let word = NASTY[rng.below(NASTY.len())];
                bytes.splice(at..at, word.iter().copied());
            }
            6 => {
                let word = NASTY[rng.below(NASTY.len())];
                let end = (at + word.len()).min(bytes.len());
                bytes.splice(at..end, word.iter().copied());
            }
            _ => {
                // A number grows: counts, lengths and indices are where readers believe too much.
                if let Some(digit) = bytes[at..].iter().position(u8::is_ascii_digit) {
                    bytes[at + digit] = b'0' + rng.below(10) as u8;
                    bytes.splice(at + digit..at + digit, *b"98");
                }
            }
        }
    }
    bytes
}

fn each_mutant(name: u64, seed: &[u8], mut read: impl FnMut(&[u8]) -> bool) {
    let (mut good, mut worst) = (0_u64, Duration::ZERO);
    let all = mutants();
    for i in 0..all {
        let mut rng = Seed::new(name).child(i).stream(Draw::Test);
        let bytes = mutate(seed, &mut rng);
        let from = Instant::now();
        good += u64::from(read(&bytes));
        worst = worst.max(from.elapsed());
    }
    assert!(worst < Duration::from_secs(2), "one mutant took {worst:?}");
    // Both paths must have been gone: some still read, some are refused.
    assert!(good > all / 100 && good < all, "{good} of {all} were read");
    println!("{all} mutants, {good} read, the slowest in {worst:?}");
}

fn drawings(format: DrawingFormat, bytes: &[u8]) -> bool {
    let mut good = 0;
    for read in read_drawings(bytes, format, "m").take(10_000) {
        match read {
            Ok(read) => {
                good += 1;
                let info = DrawingSummary::from_drawing(&read.drawing, &read.warnings);
                assert!(info.strokes > 0, "a drawing without strokes is an error");
                write_drawing(&read.drawing, std::io::sink()).expect("writes what it read");
            }
            Err(e) => assert!(e.to_string().len() > 10, "the error says something"),
        }
    }
    good > 0
}

fn models(format: ModelFormat, bytes: &[u8]) -> bool {
    let mtl = |f: SideFile<'_>| if f.name == "a.mtl" { Ok(MTL.to_vec()) } else { Err(NoFile::Missing) };
    let mut report = Report::default();
    match read_model(bytes, format, "m", &ExportSpec::default(), &mtl, &mut report) {
        Ok(m) => {
            let bad = m.validate().find(|f| !matches!(f, mesh::MeshFault::Degenerate(_)));
            assert_eq!(bad, None, "what was read is sound");
            assert_eq!(
                ModelSummary::from_model(&m, &report.warnings).triangles,
                m.triangle_count(),
                "all counted"
            );
            write_glb(&m, std::io::sink()).expect("writes what it read");
            true
        }
        Err(e) => {
            assert!(e.to_string().len() > 10, "the error says something");
            false
        }
    }
}

fn written(format: ModelFormat) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_model(&model(), format, &ExportSpec::default(), &mut bytes, &mut Report::default())
        .expect("writes");
    bytes
}

#[test]
fn svg() {
    each_mutant(1, SVG, |b| drawings(DrawingFormat::Svg, b));
}

#[test]
fn inkml() {
    each_mutant(2, INKML, |b| drawings(DrawingFormat::InkMl, b));
}

#[test]
fn ndjson() {
    each_mutant(3, NDJSON, |b| drawings(DrawingFormat::Ndjson, b));
}

#[test]
fn json() {
    each_mutant(4, JSON, |b| drawings(DrawingFormat::Json, b));
}

#[test]
fn glb() {
    each_mutant(5, &written(ModelFormat::Glb), |b| models(ModelFormat::Glb, b));
}

#[test]
fn obj_with_its_materials() {
    each_mutant(6, OBJ, |b| models(ModelFormat::Obj, b));
    let obj = obj_files(&model(), "a", &ExportSpec::default()).expect("writes").obj;
    each_mutant(7, &obj, |b| models(ModelFormat::Obj, b));
    let mut report = Report::default();
    let all = mutants();
    for i in 0..all {
        let mtl = mutate(MTL, &mut Seed::new(8).child(i).stream(Draw::Test));
        let resolve =
            |f: SideFile<'_>| if f.name == "a.mtl" { Ok(mtl.clone()) } else { Err(NoFile::Missing) };
        read_model(OBJ, ModelFormat::Obj, "m", &ExportSpec::default(), &resolve, &mut report)
            .expect("a broken material file spoils no shape");
    }
}

#[test]
fn ply() {
    each_mutant(9, &written(ModelFormat::Ply), |b| models(ModelFormat::Ply, b));
    each_mutant(10, PLY_TEXT, |b| models(ModelFormat::Ply, b));
}

#[test]
fn stl() {
    each_mutant(11, &written(ModelFormat::Stl), |b| models(ModelFormat::Stl, b));
    each_mutant(12, STL_TEXT, |b| models(ModelFormat::Stl, b));
}

#[test]
fn files_of_one_format_given_as_another() {
    let all = [
        SVG,
        INKML,
        NDJSON,
        JSON,
        OBJ,
        PLY_TEXT,
        STL_TEXT,
        b"",
        b" ",
        b"\xef\xbb\xbf",
        b"{",
        b"[",
        b"<",
        b"\0\0\0\0",
    ];
    for bytes in all {
        for format in DrawingFormat::ALL {
            drawings(format, bytes);
        }
        for format in ModelFormat::ALL {
            if let Ok(m) =
                read_model(bytes, format, "m", &ExportSpec::default(), &no_files, &mut Report::default())
            {
                assert!(m.vertex_count() > 0, "{format:?} of {:?}", String::from_utf8_lossy(bytes));
            }
        }
    }
}

fn clouds(format: CloudFormat, bytes: &[u8]) -> bool {
    let mut report = Report::default();
    match read_cloud(bytes, format, &ExportSpec::default(), &mut report) {
        Ok(cloud) => {
            assert!(cloud.is_sound() && !cloud.points.is_empty(), "what was read is sound");
            write_cloud_ply(&cloud, &ExportSpec::default(), std::io::sink()).expect("writes what it read");
            true
        }
        Err(e) => {
            assert!(e.to_string().len() > 10, "the error says something");
            false
        }
    }
}

/// A LAS 1.2 file of 40 points, format 0.
fn las() -> Vec<u8> {
    let mut b = vec![0_u8; 227];
    b[..4].copy_from_slice(b"LASF");
    (b[24], b[25], b[104]) = (1, 2, 0);
    b[94..96].copy_from_slice(&227_u16.to_le_bytes());
    b[96..100].copy_from_slice(&227_u32.to_le_bytes());
    b[105..107].copy_from_slice(&20_u16.to_le_bytes());
    b[107..111].copy_from_slice(&40_u32.to_le_bytes());
    for k in 0..3 {
        b[131 + 8 * k..139 + 8 * k].copy_from_slice(&0.001_f64.to_le_bytes());
    }
    for i in 0..40_i32 {
        for x in [i * 37 % 11, i, i * 17 % 7] {
            b.extend(x.to_le_bytes());
        }
        b.extend([0; 8]);
    }
    b
}

const PCD: &[u8] = b"# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH 3\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 3\nDATA ascii\n0 0 0 4.2e6\n1 0 0 4.2e6\n1 1 nan 0\n";

#[test]
fn scans() {
    each_mutant(21, PLY_TEXT, |b| clouds(CloudFormat::Ply, b));
    each_mutant(22, &written(ModelFormat::Ply), |b| clouds(CloudFormat::Ply, b));
    each_mutant(23, b"x;y;z;label\n1 2 3 4\n1,5;2,5e0;3;4\n// note\n4 5 6 7\n", |b| {
        clouds(CloudFormat::Xyz, b)
    });
    each_mutant(24, PCD, |b| clouds(CloudFormat::Pcd, b));
    each_mutant(25, OBJ, |b| clouds(CloudFormat::Obj, b));
    each_mutant(26, &las(), |b| clouds(CloudFormat::Las, b));
}

/// Whatever plants are read are sound and can be measured and written.
fn structure(format: StructureFormat, bytes: &[u8]) -> bool {
    let mut report = Report::default();
    match read_structure(bytes, format, "m", &StructureSpec::default(), &mut report) {
        Ok(read) => {
            for plant in &read.plants {
                assert_eq!(plant.validate().next(), None, "what was read is sound");
                assert!(!plant.axes.is_empty() && plant.measure().height_m.is_finite(), "it can be measured");
                write_structure(plant, &[], format, &ExportSpec::default(), std::io::sink()).expect("writes");
            }
            true
        }
        Err(e) => {
            assert!(e.to_string().len() > 10, "the error says something");
            false
        }
    }
}

#[test]
fn structures() {
    let mut plant = plant::Plant::default();
    let up = glam::DVec3::Y;
    plant.add_axis(plant::AxisKind::Branch, None, 1, &[up * 0.0, up, up * 2.0], None);
    let bearer = plant.axes[0].node_ids().nth(1);
    plant.add_axis(plant::AxisKind::Branch, bearer, 2, &[up, glam::DVec3::ONE], None);
    plant.nodes.radius_m = vec![0.2, 0.1, 0.0, 0.05, 0.01];
    for (k, format) in (31..).zip(StructureFormat::ALL) {
        let mut bytes = Vec::new();
        write_structure(&plant, &[], format, &ExportSpec::default(), &mut bytes).expect("written");
        each_mutant(k, &bytes, |b| structure(format, b));
    }
}

/// Whatever marks are read are completed or refused.
fn leaves(bytes: &[u8]) -> bool {
    let axes = MarksAxes::default();
    if is_rays(bytes) {
        read_rays(bytes, "m", axes).is_ok_and(|r| r.rays.validate().next().is_none())
    } else {
        read_marks(bytes, "m", axes).is_ok_and(|r| r.marks.complete(&mut Report::default()).is_ok())
    }
}

#[test]
fn marks_of_leaves() {
    let mut rows = String::from("# unit: mm\n# up: z\nrow,mark,x,y,z,thickness,midrib\ntip,,0,40,0,,0.5\n");
    let mut rays = String::from("# unit: mm\nvein,mark,x,y,z,thickness\n");
    for row in 1..=3 {
        for mark in 1..=7 {
            rows += &format!(
                "{row},{mark},{},{},1,{},{}\n",
                8 - 2 * mark,
                40 - 9 * row,
                0.1 * f64::from(mark),
                if mark == 4 { "0.5" } else { "" }
            );
            rays += &format!("{row},{mark},{},{},0,0.{mark}\n", (2 - row) * mark, 5 * mark);
        }
    }
    each_mutant(27, rows.as_bytes(), leaves);
    each_mutant(28, rays.as_bytes(), leaves);
}

#[test]
fn vein_graphs() {
    let mut nodes = vec!["[0,0,3]".to_owned()];
    let mut edges = Vec::new();
    for k in 1..40 {
        nodes.push(format!("[{},{},{}]", (k % 3 - 1) * (k / 3), k * 2, 3.0 - 0.05 * f64::from(k)));
        edges.push(format!("[{},{k}]", (k - 3).max(0)));
    }
    let text =
        format!("{{\"unit\":\"pixel\",\"nodes_xyr\":[{}],\"edges\":[{}]}}", nodes.join(","), edges.join(","));
    each_mutant(29, text.as_bytes(), |b| {
        let Ok(read) = read_vein_graph(b) else { return false };
        let mut report = Report::default();
        if let Ok(marks) = read.graph.marks(&mut report) {
            drop(marks.complete(&mut report));
        }
        if let Ok(Some(rays)) = read.graph.rays(&mut report) {
            drop(leaf::RayLeaf::new(&rays, leaf::ThicknessRule::Diameter));
        }
        true
    });
}
