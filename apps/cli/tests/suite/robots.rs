//! Plants as bodies and joints: files of every maker, and what is refused.
#![expect(clippy::unwrap_used, reason = "tests")]

use std::fs;
use std::path::Path;

use crate::tools::{FLOWER, bad, burgeon, folder, good, names, status};

const TOMATO: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/illustrations/01_tomato.svg");

/// The values of an attribute, in the order of the file.
fn values<'a>(text: &'a str, tag: &str, attribute: &str) -> Vec<&'a str> {
    let (open, key) = (format!("<{tag} "), format!(" {attribute}=\""));
    let lines = text.lines().filter(|line| line.trim_start().starts_with(&open));
    lines.filter_map(|line| line.split_once(&key)?.1.split('"').next()).collect()
}

/// Every mesh that a file names lies beside it as a binary STL with triangles.
fn check_meshes(dir: &Path, text: &str, (tag, attribute): (&str, &str)) {
    let files = values(text, tag, attribute);
    assert!(!files.is_empty(), "no mesh");
    for file in files {
        let bytes = fs::read(dir.join(file)).unwrap();
        let count = u32::from_le_bytes(bytes[80..84].try_into().unwrap()) as usize;
        assert!(count > 0 && bytes.len() == 84 + 50 * count, "{file}");
    }
}

#[test]
fn a_drawn_tomato_is_a_robot_with_fruits_that_come_off() {
    let dir = folder("robots-tomato");
    good(&dir, &["sketch", TOMATO, "-o", "tomato.xml", "-q"]);
    let text = fs::read_to_string(dir.join("tomato.xml")).unwrap();
    let hinges = values(&text, "joint", "stiffness");
    assert!((2..=200).contains(&hinges.len()), "{} hinges", hinges.len());
    assert!(hinges.iter().all(|k| k.parse::<f64>().unwrap() > 0.0));
    let fruits = values(&text, "weld", "body2");
    assert!(!fruits.is_empty(), "it bears fruits");
    for fruit in fruits {
        let force = format!("<numeric name=\"break_force_{fruit}\" data=\"");
        let force: f64 = text.split_once(&force).unwrap().1.split('"').next().unwrap().parse().unwrap();
        assert!(force > 0.0 && force < 1e4, "{fruit}: {force} N");
    }
    check_meshes(&dir, &text, ("mesh", "file"));
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
fn it_is_said_what_was_assumed() {
    let dir = folder("robots-said");
    let out = burgeon(&dir, &["grow", "spruce", "-o", "spruce.xml"]);
    assert_eq!(status(&out), 0);
    let said = String::from_utf8(out.stderr).unwrap();
    assert!(said.contains("softwood (8 GPa, not measured)"), "{said}");
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
