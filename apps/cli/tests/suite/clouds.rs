//! Clouds in the coordinates of a map, and clouds that become models.
#![expect(clippy::unwrap_used, reason = "tests")]

use crate::tools;
use std::fs;
use std::path::Path;

use serde_json::Value;
use tools::{bad, folder, good};

/// Easting, northing and height, +Z up.
const FAR: [f64; 3] = [432_100.0, 5_612_300.0, 312.0];

fn report(folder: &Path, args: &[&str]) -> Value {
    serde_json::from_str(&good(folder, &[args, &["--json"]].concat())).unwrap()
}

/// Writes a blade of 60 mm x 36 mm in points 0.8 mm apart, scaled by `size`, moved by `by`; +Z up.
fn blade(folder: &Path, name: &str, size: f64, by: [f64; 3]) {
    let mut text = String::new();
    for i in 0..75 {
        for j in -22..=22 {
            let (x, y) = (f64::from(j) * 0.0008, f64::from(i) * 0.0008);
            let t = y / 0.06;
            if x.abs() < 0.072 * t * (1.0 - t) {
                let z = 0.25 * x.abs() - 6.0 * (y - 0.02) * (y - 0.02);
                let p = [x, y, z].map(|c| c * size);
                text += &format!("{:.6} {:.6} {:.6}\n", p[0] + by[0], p[1] + by[1], p[2] + by[2]);
            }
        }
    }
    fs::write(folder.join(name), text).unwrap();
}

#[test]
fn a_leaf_far_from_the_origin_is_the_leaf_near_it() {
    let at = folder("far-leaf");
    blade(&at, "near.xyz", 1.0, [0.0; 3]);
    blade(&at, "far.xyz", 1.0, FAR);
    let near = report(&at, &["leaf", "--scan", "near.xyz", "--up", "z", "-o", "near.glb"]);
    let far = report(&at, &["leaf", "--scan", "far.xyz", "--up", "z", "-o", "far.glb"]);
    assert!(near["input"]["offset_m"].is_null());
    assert_eq!(far["input"]["offset_m"].as_array().map(|o| o[1].as_f64()), Some(Some(FAR[1])));
    for figure in ["length_mm", "area_mm2"] {
        let of = |r: &Value| r["items"][0]["leaf"][figure].as_f64().unwrap();
        assert!((of(&near) - of(&far)).abs() < 0.002 * of(&near), "{figure}: {} {}", of(&near), of(&far));
    }
    assert!(far["items"][0]["warnings"].to_string().contains("far from their origin"));
    let glb = fs::read(at.join("far.glb")).unwrap();
    let text = String::from_utf8_lossy(&glb);
    assert!(text.contains("\"offset_m\":[432100.0,312.0,-5612300.0]"), "+Y up: {}", &text[..400]);
}

#[test]
fn a_series_far_from_the_origin_has_one_offset() {
    let at = folder("far-series");
    blade(&at, "first.xyz", 1.0, FAR);
    blade(&at, "last.xyz", 1.5, FAR);
    let args = ["bloom", "run", "first.xyz", "--end", "last.xyz", "--up", "z", "--whole", "--day", "1"];
    let told = report(&at, &[&args[..], &["-o", "day.ply", "--compare", "last.xyz"]].concat());
    assert!(told["input"]["offset_m"][0].as_f64().is_some_and(|x| (x - FAR[0]).abs() < 2.0));
    assert!(told["error"]["mean_mm"].as_f64().unwrap() < 1.0, "{}", told["error"]);
    let ply = fs::read(at.join("day.ply")).unwrap();
    assert!(String::from_utf8_lossy(&ply[..200]).contains("comment offset 432100 5612300 312"));
}

#[test]
fn a_tree_grows_on_points_far_from_the_origin() {
    let at = folder("far-tree");
    let mut near = String::new();
    let mut far = String::new();
    for k in 0..512_u32 {
        let p = [k % 8, k / 8 % 8, k / 64].map(|c| 0.25 * f64::from(c));
        near += &format!("{} {} {}\n", p[0] - 1.0, p[1] - 1.0, p[2] + 2.0);
        far += &format!("{} {} {}\n", p[0] - 1.0 + FAR[0], p[1] - 1.0 + FAR[1], p[2] + 2.0 + FAR[2]);
    }
    fs::write(at.join("near.xyz"), near).unwrap();
    fs::write(at.join("far.xyz"), far).unwrap();
    let grow = ["--up", "z", "--influence", "1", "--kill", "0.3"];
    let near = report(&at, &[&["grow", "--attractors", "near.xyz", "-o", "near.obj"], &grow[..]].concat());
    let args = ["grow", "--attractors", "far.xyz", "--root", "432100,5612300,312", "-o", "far.obj"];
    let far = report(&at, &[&args[..], &grow[..]].concat());
    assert_eq!(far["items"][0]["growth"]["consumed"], near["items"][0]["growth"]["consumed"]);
    let obj = fs::read_to_string(at.join("far.obj")).unwrap();
    let offset = obj.lines().find(|l| l.starts_with("# offset ")).unwrap();
    assert!(offset.ends_with(" 5612300 315") || offset.ends_with(" 5612300 314"), "{offset}");
    let told = bad(&at, &[&["grow", "--attractors", "far.xyz", "-o", "x.obj"], &grow[..]].concat());
    assert!(told.contains("--root"), "{told}");
    assert!(!at.join("x.obj").exists());
}

#[test]
fn clouds_convert_and_have_no_place_in_stl() {
    let at = folder("cloud-convert");
    blade(&at, "far.xyz", 1.0, FAR);
    blade(&at, "near.xyz", 1.0, [0.0; 3]);
    let axes = ["--in-up", "z", "--up", "z"];
    let told = report(&at, &[&["convert", "far.xyz", "-o", "far.ply"], &axes[..]].concat());
    let points = told["items"][0]["counts"]["vertices"].as_u64().unwrap();
    let lines = fs::read_to_string(at.join("far.xyz")).unwrap().lines().count();
    assert_eq!((points, told["input"]["offset_m"][2].as_f64()), (lines as u64, Some(FAR[2])));
    // Double precision: the first point of the file, less the offset, to a micrometre.
    let ply = fs::read(at.join("far.ply")).unwrap();
    let head = ply.windows(11).position(|w| w == b"end_header\n").unwrap() + 11;
    let read = |k: usize| f64::from_le_bytes(ply[head + 8 * k..head + 8 * k + 8].try_into().unwrap());
    let text = fs::read_to_string(at.join("far.xyz")).unwrap();
    let first: Vec<f64> = text.lines().next().unwrap().split(' ').map(|w| w.parse().unwrap()).collect();
    assert!((0..3).all(|k| (first[k] - FAR[k] - read(k)).abs() < 2e-6), "{first:?}");
    report(&at, &["convert", "far.xyz", "-o", "far.usda", "--in-up", "z", "--up", "z"]);
    assert!(
        fs::read_to_string(at.join("far.usda")).unwrap().contains("double3 offset = (432100, 5612300, 312)")
    );
    report(&at, &["convert", "near.xyz", "-o", "near.obj"]);
    for input in ["far.xyz", "near.obj"] {
        let told = bad(&at, &["convert", input, "-o", "x.stl"]);
        assert!(told.ends_with("choose .ply, .obj or .glb\n"), "{told}");
        assert!(!at.join("x.stl").exists());
    }
}

#[test]
fn a_scan_in_another_unit_is_the_leaf_or_says_so() {
    let at = folder("leaf-units");
    for (name, size) in [("m.xyz", 1.0), ("cm.xyz", 100.0), ("mm.xyz", 1000.0)] {
        blade(&at, name, size, [0.0; 3]);
    }
    let length = |r: &Value| r["items"][0]["leaf"]["length_mm"].as_f64().unwrap();
    let truth = length(&report(&at, &["leaf", "--scan", "m.xyz", "--up", "z", "-o", "x.glb"]));
    for (name, unit) in [("cm.xyz", "--unit cm"), ("mm.xyz", "--unit mm")] {
        let told = report(&at, &["leaf", "--scan", name, "--up", "z", "-o", "x.glb"]);
        assert!((length(&told) / truth - 1.0).abs() < 0.01, "{name}: {} {truth}", length(&told));
        let warnings = told["items"][0]["warnings"].to_string();
        assert!(warnings.contains(unit), "{name}: {warnings}");
    }
    for (name, unit) in [("m.xyz", "mm"), ("mm.xyz", "m")] {
        let told = report(&at, &["leaf", "--scan", name, "--up", "z", "--unit", unit, "-o", "x.glb"]);
        assert!(told["items"][0]["warnings"].to_string().contains("is --unit right?"), "{name} {unit}");
    }
    // Mirrored, and with another axis up, it has the same length.
    let text = fs::read_to_string(at.join("m.xyz")).unwrap();
    let flipped: String = text.lines().map(|l| format!("-{l}\n").replace("--", "")).collect();
    fs::write(at.join("mirrored.xyz"), flipped).unwrap();
    for (name, up) in [("mirrored.xyz", "z"), ("m.xyz", "y")] {
        let told = report(&at, &["leaf", "--scan", name, "--up", up, "-o", "x.glb"]);
        assert!((length(&told) / truth - 1.0).abs() < 0.03, "{name} {up}: {} {truth}", length(&told));
    }
}

#[test]
fn a_plant_is_no_leaf_and_a_table_or_a_thing_beside_it_is_left_out() {
    let at = folder("leaf-alone");
    blade(&at, "leaf.xyz", 1.0, [0.0, 0.0, 0.01]);
    let leaf = fs::read_to_string(at.join("leaf.xyz")).unwrap();
    let length = |name: &str, want: &str| {
        let told = report(&at, &["leaf", "--scan", name, "--up", "z", "-o", "x.glb"]);
        let warnings = told["items"][0]["warnings"].to_string();
        assert!(warnings.contains(want), "{name}: {warnings}");
        told["items"][0]["leaf"]["length_mm"].as_f64().unwrap()
    };
    let truth = length("leaf.xyz", "");
    let table: String = (0..6400)
        .map(|k| format!("{} {} -0.02\n", 0.002 * f64::from(k % 80) - 0.08, 0.002 * f64::from(k / 80) - 0.05))
        .collect();
    fs::write(at.join("table.xyz"), format!("{leaf}{table}")).unwrap();
    assert!((length("table.xyz", "a table") / truth - 1.0).abs() < 0.03);
    blade(&at, "other.xyz", 0.5, [0.2, 0.0, 0.0]);
    let other = fs::read_to_string(at.join("other.xyz")).unwrap();
    fs::write(at.join("two.xyz"), format!("{leaf}{other}")).unwrap();
    assert!((length("two.xyz", "stand apart") / truth - 1.0).abs() < 0.03);
    // Two leaves on a stalk.
    let mut plant = leaf.clone();
    for line in leaf.lines() {
        let p: Vec<f64> = line.split(' ').map(|w| w.parse().unwrap()).collect();
        plant += &format!("{} {} {}\n", p[0], -p[1], p[2]);
    }
    for k in 0..300 {
        plant += &format!("{} 0 {}\n", 0.0005 * f64::from(k % 3), 0.01 - 0.0002 * f64::from(k));
    }
    fs::write(at.join("plant.xyz"), plant).unwrap();
    let told = bad(&at, &["leaf", "--scan", "plant.xyz", "--up", "z", "-o", "y.glb"]);
    assert!(told.contains("2 blades") && told.contains("--plant"), "{told}");
    assert!(!at.join("y.glb").exists());
}
