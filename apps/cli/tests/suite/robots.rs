//! Plants as bodies and joints: files of every maker, and refusals.
#![expect(clippy::unwrap_used, reason = "tests")]

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::tools::{FLOWER, bad, burgeon, folder, good, names, status};

const TOMATO: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/illustrations/01_tomato.svg");

/// Returns the values of an attribute, in the order of the file.
fn values<'a>(text: &'a str, tag: &str, attribute: &str) -> Vec<&'a str> {
    let (open, key) = (format!("<{tag} "), format!(" {attribute}=\""));
    let lines = text.lines().filter(|line| line.trim_start().starts_with(&open));
    lines.filter_map(|line| line.split_once(&key)?.1.split('"').next()).collect()
}

/// Checks that every mesh that a file names lies next to it as a binary STL with triangles.
fn check_meshes(dir: &Path, text: &str, (tag, attribute): (&str, &str)) {
    let files = values(text, tag, attribute);
    assert!(!files.is_empty(), "no mesh");
    for file in files {
        let bytes = fs::read(dir.join(file)).unwrap();
        let count = u32::from_le_bytes(bytes[80..84].try_into().unwrap()) as usize;
        assert!(count > 0 && bytes.len() == 84 + 50 * count, "{file}");
    }
}

/// Returns a number of the JSON report about a robot.
fn robot_number(report: &serde_json::Value, field: &str) -> f64 {
    report["items"][0]["robot"][field].as_f64().unwrap()
}

#[test]
fn a_drawn_tomato_keeps_the_fruits_that_outweigh_its_thin_stems() {
    let dir = folder("robots-tomato");
    let out = burgeon(&dir, &["sketch", TOMATO, "-o", "tomato.xml", "--report", "r.json"]);
    assert_eq!(status(&out), 0);
    let text = fs::read_to_string(dir.join("tomato.xml")).unwrap();
    let hinges = values(&text, "joint", "stiffness");
    assert!((2..=200).contains(&hinges.len()), "{} hinges", hinges.len());
    assert!(hinges.iter().all(|k| k.parse::<f64>().unwrap() > 0.0));
    // Fruits of 0.15 kg on stems of 0.00002 kg: welded, they would fall off by themselves.
    assert!(values(&text, "weld", "body2").is_empty() && !text.contains("freejoint"));
    let said = String::from_utf8(out.stderr).unwrap();
    assert!(
        said.contains("fruits weigh more than 50 times") && said.contains("make stems thicker"),
        "{said}"
    );
    let report = serde_json::from_slice(&fs::read(dir.join("r.json")).unwrap()).unwrap();
    let kilograms: f64 = values(&text, "inertial", "mass").iter().map(|m| m.parse::<f64>().unwrap()).sum();
    assert!(
        (kilograms / robot_number(&report, "mass_kg") - 1.0).abs() < 1e-6 && kilograms > 0.5,
        "{kilograms} kg"
    );
    check_meshes(&dir, &text, ("mesh", "file"));
}

#[test]
fn a_plant_in_bloom_names_each_mesh_and_material_once() {
    let dir = folder("robots-rose");
    for (file, tag) in [("rose.xml", "mesh"), ("rose.urdf", "material")] {
        good(&dir, &["grow", "rose", "-o", file, "-q"]);
        let text = fs::read_to_string(dir.join(file)).unwrap();
        let opening = format!("<{tag} name=\"");
        let names: Vec<&str> =
            text.split(&opening).skip(1).filter_map(|rest| rest.split('"').next()).collect();
        let different: BTreeSet<&str> = names.iter().copied().collect();
        assert!(names.iter().any(|name| name.contains("petals")), "{file}: it is in bloom");
        assert_eq!(names.len(), different.len(), "{file}");
    }
}

#[test]
fn makers_write_both_files_and_the_same_bytes_each_time() {
    let dir = folder("robots-makers");
    fs::write(dir.join("flower.svg"), FLOWER).unwrap();
    let edits = good(&dir, &["shape", "--template"]);
    fs::write(dir.join("edits.json"), edits).unwrap();
    let shaped = ["shape", "oak", "--edits", "edits.json"];
    for maker in [&["grow", "wheat"][..], &["sketch", "flower.svg"], &shaped] {
        good(&dir, &[maker, &["-o", "x.urdf", "-q"]].concat());
        let text = fs::read_to_string(dir.join("x.urdf")).unwrap();
        let turning = values(&text, "joint", "type").into_iter().filter(|t| *t == "revolute").count();
        assert!(turning > 0 && turning <= 200, "{maker:?}: {turning}");
        assert_eq!(text.matches("<springStiffness>").count(), turning);
        good(&dir, &[maker, &["-o", "y.urdf", "-q"]].concat());
        let again = fs::read_to_string(dir.join("y.urdf")).unwrap();
        assert!(text.replace("\"x-", "\"y-") == again, "{maker:?}");
    }
}

#[test]
fn usd_with_physics_has_the_bodies_springs_and_masses_of_the_other_files() {
    let dir = folder("robots-usd");
    let asked = ["grow", "hazel", "--age", "4", "-q", "--report", "r.json", "-o"];
    good(&dir, &[&asked[..], &["hazel.xml"]].concat());
    good(&dir, &[&asked[..], &["hazel.physics.usda", "--for", "isaac"]].concat());
    let (mjcf, usd) = (dir.join("hazel.xml"), dir.join("hazel.physics.usda"));
    let (mjcf, usd) = (fs::read_to_string(mjcf).unwrap(), fs::read_to_string(usd).unwrap());
    let numbers = |text: &str, key: &str| -> Vec<f64> {
        text.lines().filter_map(|line| line.split_once(key)?.1.trim().parse().ok()).collect()
    };
    let mass: f64 = numbers(&usd, "physics:mass = ").iter().sum();
    let wanted: f64 = values(&mjcf, "inertial", "mass").iter().map(|m| m.parse::<f64>().unwrap()).sum();
    assert!((mass / wanted - 1.0).abs() < 1e-7, "{mass} of {wanted}");
    let springs = numbers(&usd, "physics:stiffness = ");
    let radians: Vec<f64> = values(&mjcf, "joint", "stiffness").iter().map(|k| k.parse().unwrap()).collect();
    assert_eq!(springs.len(), radians.len());
    let degree = std::f64::consts::PI / 180.0;
    let sum = |all: &[f64]| all.iter().sum::<f64>();
    assert!((sum(&springs) / (sum(&radians) * degree) - 1.0).abs() < 1e-6, "newton metres a degree");
    let report: serde_json::Value = serde_json::from_slice(&fs::read(dir.join("r.json")).unwrap()).unwrap();
    assert!(report["for"]["set"].to_string().contains("springy joints"), "{}", report["for"]);
    let refused = bad(&dir, &["grow", "hazel", "-o", "x.physics.usda", "--for", "unreal"]);
    assert!(refused.contains(".physics.usda"), "{refused}");
    assert!(names(&dir).iter().all(|name| !name.contains("physics-")), "meshes are in the file");
}

#[test]
fn the_report_says_what_was_assumed_and_only_a_guess_is_warned_of() {
    let dir = folder("robots-said");
    let out = burgeon(&dir, &["grow", "spruce", "-o", "spruce.xml", "--report", "r.json"]);
    assert_eq!(status(&out), 0);
    let said = String::from_utf8(out.stderr).unwrap();
    assert!(!said.contains("GPa"), "{said}");
    let report: serde_json::Value = serde_json::from_slice(&fs::read(dir.join("r.json")).unwrap()).unwrap();
    assert_eq!(report["items"][0]["robot"]["wood"], "softwood");
    assert_eq!(robot_number(&report, "modulus_pa"), 8e9);
    assert!(robot_number(&report, "mass_kg") > 10.0 && robot_number(&report, "lowest_hz") > 0.0);
    // A trunk of fibres in soft tissue.
    let out = burgeon(&dir, &["grow", "palm", "-o", "palm.xml"]);
    assert_eq!(status(&out), 0);
    let said = String::from_utf8(out.stderr).unwrap();
    assert!(said.contains("as stiff as any hardwood (9 GPa)"), "{said}");
}

#[test]
fn what_robots_have_no_room_for_is_refused_and_nothing_is_left() {
    let dir = folder("robots-refused");
    for option in [&["--up", "y"][..], &["--lods", "2"], &["--wind"], &["--sway"], &["--for", "unity"]] {
        let line = bad(&dir, &[&["grow", "wheat", "-o", "x.xml"], option].concat());
        assert!(line.contains(option[0]), "{line}");
    }
    // A drawing of a flower without a stem.
    let petals = FLOWER.lines().filter(|l| !l.contains("M100 100") && !l.contains("M101 2"));
    fs::write(dir.join("petals.svg"), petals.collect::<Vec<_>>().join("\n")).unwrap();
    let line = bad(&dir, &["sketch", "petals.svg", "-o", "x.urdf"]);
    assert!(line.contains("no stem or branch above the ground"), "{line}");
    assert_eq!(names(&dir), ["petals.svg"]);
}
