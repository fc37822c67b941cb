//! `burgeon leaf` as other programs call it.
#![expect(clippy::unwrap_used, reason = "tests")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

fn folder(test: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    let _ = fs::remove_dir_all(&path);
    fs::create_dir_all(&path).unwrap();
    path
}

fn burgeon(folder: &Path, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_burgeon")).args(args).current_dir(folder).output().unwrap()
}

fn good(folder: &Path, args: &[&str]) -> String {
    let out = burgeon(folder, args);
    assert_eq!(out.status.code(), Some(0), "{args:?}: {}", String::from_utf8_lossy(&out.stderr));
    String::from_utf8(out.stdout).unwrap()
}

fn bad(folder: &Path, args: &[&str]) -> String {
    let out = burgeon(folder, args);
    let text = String::from_utf8(out.stderr).unwrap();
    assert_eq!(out.status.code(), Some(2), "{args:?}: {text}");
    assert_eq!(text.lines().count(), 1, "one line, not {text:?}");
    text
}

fn fixture(name: &str) -> String {
    format!("{}/../../fixtures/leaves/{name}", env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn report_has_the_counts_of_table_1() {
    let at = folder("leaf-table");
    let want = [("leaf1.csv", [3610, 3500, 1581, 1500]), ("leaf2.csv", [6130, 5950, 2666, 2550])];
    for (name, counts) in want {
        let text = good(&at, &["leaf", &fixture(name), "-o", "leaf.glb", "--json", "--texture", "plain"]);
        let report: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(report["command"], "leaf");
        let leaf = &report["items"][0]["leaf"];
        let n = |a: &str, b: &str| leaf[a][b].as_u64().unwrap();
        let got = [n("veins", "vertices"), n("veins", "faces"), n("blade", "vertices"), n("blade", "faces")];
        assert_eq!(got, counts);
        assert!(leaf["vein_gap_mm"].as_f64().unwrap() < 1e-6);
        assert_eq!(&fs::read(at.join("leaf.glb")).unwrap()[..4], b"glTF");
    }
}

#[test]
fn template_asks_for_what_is_missing() {
    let at = folder("leaf-template");
    let text = good(&at, &["leaf", "--template", "--rows", "3"]);
    assert!(text.contains("row,mark,x,y,z,thickness,midrib") && text.contains("3,7,,,,,"), "{text}");
    good(&at, &["leaf", "--template", "-o", "marks.csv"]);
    let error = bad(&at, &["leaf", "marks.csv", "-o", "leaf.glb"]);
    assert!(error.contains("marks.csv") && error.contains("x is missing"), "{error}");
    assert!(!at.join("leaf.glb").exists());
}

#[test]
fn growth_pose_and_plant_are_made() {
    let at = folder("leaf-more");
    let (a, b) = (fixture("leaf2.csv"), fixture("leaf1.csv"));
    good(&at, &["leaf", &a, &b, "--days", "5,9", "--day", "7", "-o", "seven.obj", "--texture", "plain"]);
    good(
        &at,
        &["leaf", &b, "--curl", "0.3", "--wilt", "1", "-o", "limp.stl", "--rings", "envelope", "--caps"],
    );
    let plant = ["leaf", &b, &a, "--plant", "--leaves", "5", "-o", "p.glb", "--json", "--subdivisions", "2"];
    let report: Value = serde_json::from_str(&good(&at, &plant)).unwrap();
    assert_eq!(report["items"][0]["counts"]["leaves"], 5);
    let error = bad(&at, &["leaf", &a, &b, "--days", "5,9", "--day", "12", "-o", "x.glb"]);
    assert!(error.contains("day 12 is outside"), "{error}");
    let error = bad(&at, &["leaf", &a, &b, "--days", "9,5", "--day", "7", "-o", "x.glb"]);
    assert!(error.contains("order"), "{error}");
    let error = bad(&at, &["leaf", &a, &b, "-o", "x.glb"]);
    assert!(error.contains("--plant"), "{error}");
    assert!(bad(&at, &["leaf"]).contains("--template"));
    assert!(bad(&at, &["leaf", "none.csv", "-o", "x.glb"]).contains("none.csv"));
}
