//! Plants of files of structure, through the commands that accept plants; growth tables with groups, and of workbooks.
#![expect(clippy::unwrap_used, reason = "tests")]

use crate::tools;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use serde_json::Value;
use tools::{bad, burgeon, folder, good, json, status};

/// A trunk of three cylinders and two branches, in metres.
const TABLE: &str = "radius,start_x,start_y,start_z,end_x,end_y,end_z,parent,branch\n\
    0.12,10,5,2,10,5,4,0,1\n0.1,10,5,4,10,5,6,1,1\n0.06,10,5,6,10.2,5,8,2,1\n\
    0.04,10,5,4,11.5,5,5.5,1,2\n0.03,10,5,6,8.8,5.4,7.2,2,3\n";

fn measures(f: &Path, args: &[&str]) -> Value {
    let info: Value = serde_json::from_str(&good(f, &[&["info"], args, &["--json"]].concat())).unwrap();
    info["structure"]["plants"][0]["measures"].clone()
}

#[test]
fn a_table_of_cylinders_is_a_plant_for_every_command() {
    let f = folder("structure-commands");
    fs::write(f.join("tree.csv"), TABLE).unwrap();
    let table = measures(&f, &["tree.csv"]);
    assert_eq!(table["height_m"].as_f64(), Some(6.0));
    good(&f, &["render", "tree.csv", "-o", "tree.png", "--size", "64x64"]);
    assert!(fs::metadata(f.join("tree.png")).unwrap().len() > 500);
    // Leaves, edits and all options of exports.
    let args =
        ["shape", "tree.csv", "--leaves", "birch", "-o", "tree.glb", "--lods", "1", "--report", "r.json"];
    good(&f, &[&args[..], &["--no-textures", "--detail", "0.3"]].concat());
    let item = &json(&f.join("r.json"))["items"][0];
    assert!(item["counts"]["leaves"].as_u64().unwrap() > 20, "{item}");
    assert!(item["warnings"].to_string().contains("moved to the origin"), "{item}");
    assert!(f.join("tree-lod1.glb").is_file());
    fs::write(
        f.join("edits.json"),
        r#"{"schema": "burgeon.edits/1", "edits": [{"op": "prune", "axis": {"path": [0, 0]}}]}"#,
    )
    .unwrap();
    good(&f, &["shape", "tree.csv", "--edits", "edits.json", "-o", "cut.mtg"]);
    assert!(measures(&f, &["cut.mtg"])["length_m"].as_f64() < table["length_m"].as_f64());
    // From format to format nothing is lost, and nothing moves.
    for name in ["a.mtg", "b.swc", "c.opf", "d.qsm.csv"] {
        good(&f, &["convert", "tree.csv", "-o", name]);
        let other = measures(&f, &[name]);
        for key in ["length_m", "height_m", "wood_volume_m3"] {
            let (a, b) = (table[key].as_f64().unwrap(), other[key].as_f64().unwrap());
            let tolerance = if name == "b.swc" && key == "wood_volume_m3" { 0.1 } else { 1e-5 };
            assert!((a - b).abs() < tolerance * (1.0 + a), "{name}, {key}: {a} {b}");
        }
    }
    assert!(fs::read_to_string(f.join("b.swc")).unwrap().contains(" 10 5 2 "), "where it stood");
    good(&f, &["convert", "a.mtg", "-o", "tree.obj"]);
}

#[test]
fn what_a_file_does_not_say_is_asked_for() {
    let f = folder("structure-asked");
    fs::write(f.join("tree.swc"), "1 1 0 0 0 100 -1\n2 1 0 0 900 50 1\n").unwrap();
    assert!(bad(&f, &["render", "tree.swc", "-o", "x.png"]).contains("--in-unit"), "900 m high");
    let out = burgeon(&f, &["info", "tree.swc", "--in-unit", "cm", "--thickness-unit", "mm"]);
    assert_eq!(status(&out), 0);
    assert!(String::from_utf8_lossy(&out.stdout).contains("9 m high"), "{out:?}");
    fs::write(f.join("thick.swc"), "1 1 0 0 0 500 -1\n2 1 0 0 900 300 1\n").unwrap();
    let out = burgeon(&f, &["info", "thick.swc", "--in-unit", "cm"]);
    assert!(String::from_utf8_lossy(&out.stdout).contains("--thickness-unit"), "10 m thick: {out:?}");
    // Two plants: the number is missing.
    fs::write(f.join("two.swc"), "1 1 0 0 0 1 -1\n2 1 0 0 9 1 1\n3 1 50 0 0 1 -1\n4 1 50 0 8 1 3\n").unwrap();
    assert!(bad(&f, &["convert", "two.swc", "-o", "x.mtg"]).contains("--plant 1 to --plant 2"));
    good(&f, &["convert", "two.swc", "-o", "x.mtg", "--plant", "2"]);
    assert!(bad(&f, &["convert", "two.swc", "-o", "y.mtg", "--plant", "3"]).contains("from 1 to 2"));
    // Options of such files apply to nothing else, and everything else needs edits.
    assert!(
        bad(&f, &["shape", "oak", "--list", "--leaves", "birch"])
            .contains("--leaves is for files of structure")
    );
    assert!(bad(&f, &["shape", "oak", "-o", "x.glb"]).contains("--edits"));
    fs::write(f.join("bad.csv"), TABLE.replace(",2,3\n", ",9,3\n")).unwrap();
    let line = bad(&f, &["shape", "bad.csv", "-o", "x.glb"]);
    assert!(line.contains("line 6") && line.contains("the cylinder 9"), "{line}");
    assert!(!f.join("x.glb").exists());
    assert!(bad(&f, &["sketch", "two.swc", "-o", "x.glb"]).contains("burgeon shape"));
}

/// Writes heights of twelve plants by treatment, in years; six of them grow to about half as much.
fn trial(separator: char) -> String {
    let mut text = format!("Seed{separator}treatment{separator}Age (years){separator}height_cm\n");
    for plant in 0..12_u32 {
        let (treatment, end) = if plant % 2 == 0 { ("wet", 80.0) } else { ("dry", 45.0) };
        for year in 0..7 {
            let age = 2.0 * f64::from(year);
            let noise = f64::from((plant * 7 + year * 5) % 5) - 2.0;
            #[expect(clippy::disallowed_methods, reason = "points of a test")]
            let height = end / (1.0 + 9.0 * (-0.6 * age).exp()) + 0.4 * noise;
            writeln!(text, "{plant}{separator}{treatment}{separator}{age}{separator}{height:.2}").unwrap();
        }
    }
    text
}

#[test]
fn groups_of_a_growth_table_are_told_apart() {
    let f = folder("growth-groups");
    fs::write(f.join("trial.tsv"), trial('\t')).unwrap();
    let args = ["bloom", "fit", "trial.tsv", "-o", "law.json", "--plant", "Seed", "--by", "treatment"];
    let told = good(&f, &[&args[..], &["--plot", "fit.svg", "--report", "r.json"]].concat());
    assert!(told.contains("a year") && told.contains("they grow apart"), "{told}");
    let report = json(&f.join("r.json"));
    assert!(report["groups"]["p_permuted"].as_f64().unwrap() < 0.05, "{report}");
    let ends: Vec<f64> =
        report["laws"].as_array().unwrap().iter().map(|l| l["final_m"].as_f64().unwrap()).collect();
    assert!((ends[0] - 0.80).abs() < 0.02 && (ends[1] - 0.45).abs() < 0.02, "{ends:?}");
    assert!(fs::read_to_string(f.join("fit.svg")).unwrap().contains("mm by year"));
    let at = good(&f, &["bloom", "at", "law.json", "--day", "6"]);
    assert!(at.contains("year 6: wet") && at.contains(" to "), "{at}");
    // Without groups each plant has a law; without the column of plants there are two sizes on a day.
    good(&f, &["bloom", "fit", "trial.tsv", "-o", "each.json", "--plant", "Seed"]);
    let twice = bad(&f, &["bloom", "fit", "trial.tsv", "-o", "x.json"]);
    assert!(twice.contains("--plant COLUMN"), "{twice}");
    assert!(bad(&f, &[&args[..7], &["--by", "block"]].concat()).contains("treatment"));
}

#[test]
fn a_workbook_is_a_growth_table() {
    let f = folder("growth-workbook");
    let book = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/tables/heights.xlsx");
    let out = burgeon(&f, &["bloom", "fit", book, "-o", "law.json", "--report", "r.json"]);
    assert_eq!(status(&out), 0, "{out:?}");
    let said = String::from_utf8_lossy(&out.stderr).into_owned();
    assert!(said.contains("Heights") && said.contains("2024-02-28"), "{said}");
    assert_eq!(json(&f.join("r.json"))["laws"][0]["organ"], "plant a");
    assert!(bad(&f, &["bloom", "fit", book, "-o", "x.json", "--sheet", "Leaves"]).contains("Heights, Notes"));
}
