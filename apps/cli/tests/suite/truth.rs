//! The report of `burgeon grow` is true: vertices in obstacles, axes and units of options, lines of faults, nothing
//! instead of something empty.
#![expect(clippy::unwrap_used, reason = "tests")]

use crate::tools;
use std::fs;
use std::path::Path;

use burgeon::document::{Editor, PlantId, SceneCommand, write_project};
use serde_json::Value;
use tools::{bad, burgeon, folder, good, names};

fn item(at: &Path, args: &[&str]) -> Value {
    let report: Value = serde_json::from_str(&good(at, &[&["grow"], args, &["--json"]].concat())).unwrap();
    report["items"][0].clone()
}

fn write(at: &Path, name: &str, text: &str) {
    fs::write(at.join(name), text).unwrap();
}

/// Writes a box as OBJ.
fn block(at: &Path, name: &str, lo: [f64; 3], hi: [f64; 3]) {
    let mut text = String::new();
    for i in 0..8 {
        let side = |bit: usize, k: usize| if i & bit == 0 { lo[k] } else { hi[k] };
        text += &format!("v {} {} {}\n", side(1, 0), side(2, 1), side(4, 2));
    }
    for face in ["1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6"] {
        text += &format!("f {face}\n");
    }
    write(at, name, &text);
}

/// Computes how deep each vertex of an OBJ lies in a box, without the program.
fn depths(file: &Path, lo: [f64; 3], hi: [f64; 3]) -> Vec<f64> {
    let text = fs::read_to_string(file).unwrap();
    let vertices = text.lines().filter_map(|l| l.strip_prefix("v "));
    let depth = |l: &str| {
        let p: Vec<f64> = l.split(' ').map(|w| w.parse().unwrap()).collect();
        (0..3).map(|k| (p[k] - lo[k]).min(hi[k] - p[k])).fold(f64::INFINITY, f64::min)
    };
    vertices.map(depth).collect()
}

#[test]
fn no_vertex_that_is_written_lies_in_an_obstacle() {
    let at = folder("truth-obstacles");
    let beside = ([0.35, 0.0, -0.6], [1.5, 2.2, 0.6]);
    let wall = ([1.2, 0.0, -6.0], [1.5, 9.0, 6.0]);
    block(&at, "beside.obj", beside.0, beside.1);
    block(&at, "wall.obj", wall.0, wall.1);
    for (preset, seed) in [("oak", "2"), ("alder", "1"), ("oak-lsystem", "1"), ("maple", "3")] {
        for (name, (lo, hi)) in [("beside.obj", beside), ("wall.obj", wall)] {
            let args = [preset, "--seed", seed, "--obstacle", name, "-o", "tree.obj", "--no-textures"];
            let growth = item(&at, &args)["growth"].clone();
            let all = depths(&at.join("tree.obj"), lo, hi);
            let inside = all.iter().filter(|d| **d > 0.001).count();
            assert_eq!(growth["inside_obstacle"].as_u64(), Some(inside as u64), "{preset} {name}: {growth}");
            assert_eq!((inside, all.len() > 50_000), (0, true), "{preset} {name}");
            assert!(growth["inside_obstacle_depth_m"].as_f64() < Some(0.001), "{growth}");
        }
    }
    // Leaves of coarser copies are larger.
    for preset in ["oak", "alder", "pine"] {
        good(
            &at,
            &["grow", preset, "--obstacle", "wall.obj", "-o", "far.obj", "--lods", "3", "--no-textures"],
        );
        for name in ["far-lod1.obj", "far-lod2.obj", "far-lod3.obj"] {
            let all = depths(&at.join(name), wall.0, wall.1);
            assert_eq!(all.iter().filter(|d| **d > 0.001).count(), 0, "{preset} {name}");
        }
    }
}

#[test]
fn without_obstacles_nothing_is_said_of_them() {
    let at = folder("truth-null");
    let spec = "[method]\nkind = \"competition\"\npoints = 200\n";
    write(&at, "free.toml", spec);
    let growth = item(&at, &["free.toml"])["growth"].clone();
    assert_eq!(
        (&growth["inside_obstacle"], &growth["inside_obstacle_depth_m"]),
        (&Value::Null, &Value::Null)
    );
    let ball = "[[obstacles]]\nshape = \"sphere\"\ncentre = [0, 3, 0]\nradius_m = 0.6\n";
    write(&at, "ball.toml", &format!("{ball}{spec}"));
    let growth = item(&at, &["ball.toml"])["growth"].clone();
    assert_eq!((&growth["inside_obstacle"], &growth["inside_obstacle_depth_m"]), (&0.into(), &0.0.into()));
}

#[test]
fn a_trunk_beside_its_root_is_told() {
    let at = folder("truth-foot");
    block(&at, "wall.obj", [0.02, 0.0, -3.0], [0.3, 6.0, 3.0]);
    let item = item(&at, &["oak", "--obstacle", "wall.obj"]);
    assert_eq!(item["growth"]["inside_obstacle"], 0);
    assert!(item["warnings"].to_string().contains("its foot stands 0."), "{}", item["warnings"]);
}

/// Writes a ball of points around (0, 0, 8) with +Z up, in units of which a metre has `per_metre`.
fn ball(at: &Path, name: &str, per_metre: f64) {
    let mut text = String::new();
    for i in -8..=8 {
        for j in -8..=8 {
            for k in -8..=8_i32 {
                let p = [i, j, k].map(|c| 0.6 * f64::from(c));
                if p.iter().map(|c| c * c).sum::<f64>() <= 25.0 {
                    let [x, y, z] = [p[0], p[1], p[2] + 8.0].map(|c| c * per_metre);
                    text += &format!("{x} {y} {z}\n");
                }
            }
        }
    }
    write(at, name, &text);
}

#[test]
fn root_and_lengths_are_in_the_axes_and_unit_of_the_points() {
    let at = folder("truth-axes");
    ball(&at, "ball.xyz", 1.0);
    ball(&at, "ball_mm.xyz", 1000.0);
    let foot = |model: &str| {
        let text = fs::read_to_string(at.join(model)).unwrap();
        let first = text.lines().find_map(|l| l.strip_prefix("v ")).unwrap().to_owned();
        first.split(' ').map(|w| w.parse().unwrap()).collect::<Vec<f64>>()
    };
    let args =
        ["--attractors", "ball.xyz", "--root", "0,0,3", "--up", "z", "--step", "0.1", "--influence", "2.0"];
    let metres = item(&at, &[&args[..], &["--kill", "0.3", "-o", "ball.obj"]].concat());
    assert_eq!(metres["growth"]["unreachable"], 0);
    assert_eq!(foot("ball.obj"), [0.0, 0.0, 3.0], "three metres up, not to the side");
    let args =
        ["--attractors", "ball_mm.xyz", "--root", "0,0,3000", "--up", "z", "--unit", "mm", "--step", "100"];
    let args = [&args[..], &["--influence", "2000", "--kill", "300", "-o", "mm.obj"]].concat();
    let millimetres = item(&at, &args);
    assert_eq!(foot("mm.obj"), [0.0, 0.0, 3000.0]);
    let (a, b) =
        (metres["plant"]["height_m"].as_f64().unwrap(), millimetres["plant"]["height_m"].as_f64().unwrap());
    assert!((a - b).abs() < 0.2 && (8.0..14.0).contains(&a), "{a} m, {b} m");
    // A second mesh to grow around: it stands on +Z.
    block(&at, "z.obj", [0.35, -0.6, 0.0], [1.5, 0.6, 2.2]);
    let z = item(&at, &["oak", "--obstacle", "z.obj", "--up", "z"]);
    block(&at, "y.obj", [0.35, 0.0, -0.6], [1.5, 2.2, 0.6]);
    assert_eq!(z["digest"], item(&at, &["oak", "--obstacle", "y.obj"])["digest"]);
}

#[test]
fn nothing_is_an_error_that_says_why() {
    let at = folder("truth-nothing");
    let rules = |rules: &str| {
        format!("[method]\nkind = \"lsystem\"\nmost_modules = 100\nrules = '''\n{rules}\n'''\n")
    };
    let light = |light: &str| format!("[method]\nkind = \"self-organizing\"\n{light}\n");
    write(&at, "reach.xyz", "0 0.1 0\n0.1 0.1 0\n");
    for (text, wants) in [
        (rules("axiom = F(1)\nF -> F F"), vec!["F with 1 number", "F with no number"]),
        (rules("axiom = + A\nA -> [ + A ]"), vec!["draws a step `F`"]),
        (
            light("[method.light]\nkind = \"shadow\"\na = 0.03\nb = 1.8\nlayers = 6\nfull = 0.000001"),
            vec!["light.full (0.000001)", "raise light.full or alpha"],
        ),
        (light("alpha = 0.01"), vec!["alpha (0.01)"]),
        (light("years = 0"), vec!["years is 0"]),
        (
            light(
                "[method.light]\nkind = \"space\"\nmarkers = 10\noccupancy = 2\nperception = 0.01\nhalf_angle_deg = 45\nenvelope = { shape = \"sphere\", centre = [0, 4, 0], radius_m = 2 }",
            ),
            vec!["light.perception (0.01"],
        ),
        ("age = 0\n[method]\nkind = \"competition\"\npoints = 100\n".into(), vec!["at the age of 0"]),
    ] {
        write(&at, "nothing.toml", &text);
        let told = bad(&at, &["grow", "nothing.toml", "-o", "out.glb"]);
        assert!(told.contains("nothing grew: "), "{told}");
        for want in wants {
            assert!(told.contains(want), "{want}: {told}");
        }
    }
    let told = bad(&at, &["grow", "--attractors", "reach.xyz", "--kill", "0.5", "-o", "out.glb"]);
    assert!(told.contains("--kill"), "{told}");
    // The only points lie inside.
    write(&at, "behind.xyz", "5 2 0\n5 2.5 0\n");
    block(&at, "shell.obj", [4.0, 1.0, -1.0], [6.0, 4.0, 1.0]);
    let told = bad(&at, &["grow", "--attractors", "behind.xyz", "--obstacle", "shell.obj", "-o", "out.glb"]);
    assert!(told.contains("none of 2 attraction points is a finite point outside obstacles"), "{told}");
    assert!(!names(&at).contains(&"out.glb".to_owned()));
}

#[test]
fn a_project_without_plants_is_empty() {
    let at = folder("truth-empty");
    let mut editor = Editor::default();
    let all: Vec<PlantId> = editor.document().plants().iter().map(|p| p.id()).collect();
    editor.run(SceneCommand::Remove(all)).unwrap();
    fs::write(at.join("none.burgeon"), write_project(editor.document(), "test").unwrap()).unwrap();
    let told = bad(&at, &["sketch", "none.burgeon", "-o", "none.glb"]);
    assert!(told.contains("none.burgeon") && told.contains("empty project"), "{told}");
    assert_eq!(names(&at), ["none.burgeon"]);
    let out = burgeon(&at, &["info", "none.burgeon"]);
    assert!(out.status.success() && String::from_utf8_lossy(&out.stdout).contains("empty"), "{out:?}");
}

#[test]
fn faults_name_their_field_their_line_and_not_three_megabytes() {
    let at = folder("truth-lines");
    write(&at, "flat.obj", "v 0 0 0\nv 1 0 0\nf 1 2 1\n");
    block(&at, "box.obj", [3.0, 0.0, 3.0], [4.0, 1.0, 4.0]);
    for (text, want) in [
        (
            "name = \"a\"\n\n\n[method]\nkind = \"competition\"\n\n\nkill_m = \"two\"\n".to_owned(),
            "line 8: method.kill_m: ",
        ),
        ("[method]\nkind = \"competition\"\n\nkill_m = -2\n".into(), "line 4: method.kill_m must be"),
        (
            "[method]\nkind = \"lsystem\"\nmost_modules = 9\nrules = \"\"\"\naxiom = A\n\nA -> [ F\n\"\"\"\n"
                .into(),
            "line 7: a ] is missing",
        ),
        ("[[obstacles]]\nshape = \"mesh\"\nfile = \"flat.obj\"\n".into(), "line 1: obstacle 1 (flat.obj): "),
        (
            "[[obstacles]]\nshape = \"cylinder\"\nbase = [9, 0, 0]\nradius_m = 1\nheight_m = 0\n".into(),
            "line 5: obstacles[0].height_m must be 1e-6 to 1,000,000 m, not 0",
        ),
    ] {
        write(&at, "slip.toml", &text);
        let told = bad(&at, &["grow", "slip.toml", "-o", "out.glb"]);
        assert!(told.contains(want), "{want}: {told}");
    }
    let told = bad(&at, &["grow", "oak", "--obstacle", "box.obj", "--obstacle", "flat.obj", "-o", "out.glb"]);
    assert!(told.contains("obstacle 2 (flat.obj): "), "{told}");
    let long = "x".repeat(3_000_000);
    for (name, text) in [
        ("long.toml", format!("[method]\nkind = \"{long}\"\n")),
        ("field.toml", format!("{long} = 1\n")),
        (
            "rules.toml",
            format!("[method]\nkind = \"lsystem\"\nmost_modules = 9\nrules = \"axiom = A({long})\"\n"),
        ),
    ] {
        write(&at, name, &text);
        let told = bad(&at, &["grow", name, "-o", "out.glb"]);
        assert!(told.len() < 1700, "{name}: {} bytes", told.len());
    }
    for (name, text) in [
        ("long.obj", format!("v 0 0 {long}\n")),
        ("word.xyz", format!("1 2 3\n1 2 {long}\n")),
        ("long.csv", format!("# unit: {long}\nrow,mark,x,y,z\n")),
        ("long.json", format!("{{\"{long}\": 1}}")),
        (
            "long.svg",
            format!("<svg xmlns=\"http://www.w3.org/2000/svg\"><path id=\"{long}\" d=\"M0 0Q\"/></svg>"),
        ),
        ("long.ply", format!("ply\nformat ascii 1.0\nelement {long} 9\nend_header\n")),
    ] {
        write(&at, name, &text);
        let args = match name.rsplit('.').next().unwrap() {
            "xyz" => vec!["grow", "--attractors", name, "-o", "out.glb"],
            "csv" => vec!["leaf", name, "-o", "out.glb"],
            "svg" | "json" => vec!["sketch", name, "-o", "out.glb"],
            _ => vec!["convert", name, "-o", "out.glb"],
        };
        let told = bad(&at, &args);
        assert!(told.len() < 1700, "{name}: {} bytes", told.len());
    }
    assert!(!names(&at).contains(&"out.glb".to_owned()));
}
