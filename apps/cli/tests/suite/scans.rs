//! Scans of trees and plots: implausible values are reported with the option that helps, and a plot becomes its trees.
#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "tests"
)]

use std::fs;
use std::path::Path;

use crate::tools;
use serde_json::Value;
use tools::{bad, folder, good};

/// Adds points of a cone from `a` to `b`, some millimetres apart and seen all around.
fn cone(out: &mut Vec<[f64; 3]>, a: [f64; 3], b: [f64; 3], [r, s]: [f64; 2]) {
    let d = [0, 1, 2].map(|k| b[k] - a[k]);
    let length = d.iter().map(|x| x * x).sum::<f64>().sqrt();
    let along = d.map(|x| x / length);
    let up = if along[2].abs() < 0.9 { [0.0, 0.0, 1.0] } else { [1.0, 0.0, 0.0] };
    let cross = |p: [f64; 3], q: [f64; 3]| {
        [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]
    };
    let u = cross(along, up);
    let size = u.iter().map(|x| x * x).sum::<f64>().sqrt();
    let u = u.map(|x| x / size);
    let v = cross(along, u);
    let rings = (length / 0.015) as u32;
    for i in 0..=rings {
        let t = f64::from(i) / f64::from(rings);
        let radius = r + (s - r) * t;
        for j in 0..24 {
            let turn = (f64::from(j) + 0.37 * f64::from(i)) * core::f64::consts::TAU / 24.0;
            let (sin, cos) = turn.sin_cos();
            out.push([0, 1, 2].map(|k| a[k] + d[k] * t + radius * (cos * u[k] + sin * v[k])));
        }
    }
}

/// Makes a tree of 5 m with eight boughs, at a place.
fn tree([x, y]: [f64; 2]) -> Vec<[f64; 3]> {
    let mut out = vec![];
    cone(&mut out, [x, y, 0.0], [x, y, 5.0], [0.09, 0.012]);
    for k in 0..8 {
        let z = 2.0 + 0.34 * f64::from(k);
        let (sin, cos) = (2.4 * f64::from(k)).sin_cos();
        let long = 0.3 * (5.4 - z);
        let tip = [x + long * cos, y + long * sin, z + 0.5 * long];
        cone(&mut out, [x, y, z], tip, [0.035 - 0.003 * f64::from(k), 0.008]);
    }
    out
}

fn ground(size: f64) -> Vec<[f64; 3]> {
    let n = (2.0 * size / 0.06) as i32;
    let at = |i: i32| 0.06 * f64::from(i) - size;
    (0..=n)
        .flat_map(|i| (0..=n).map(move |j| [at(i), at(j), 0.004 * f64::from((i * 7 + j * 3) % 5)]))
        .collect()
}

fn write(folder: &Path, name: &str, clouds: &[Vec<[f64; 3]>]) {
    let lines = clouds.iter().flatten().map(|[x, y, z]| format!("{x:.4} {y:.4} {z:.4}\n"));
    fs::write(folder.join(name), lines.collect::<String>()).unwrap();
}

fn report(folder: &Path, args: &[&str]) -> Value {
    serde_json::from_str(&good(folder, &[args, &["--json"]].concat())).unwrap()
}

#[test]
fn a_scan_that_is_not_plausible_says_which_option_helps() {
    let at = folder("scan-plausible");
    let whole = tree([0.0, 0.0]);
    write(&at, "tree.xyz", &[whole.clone(), ground(2.5)]);
    let told = report(&at, &["scan", "tree.xyz", "-o", "tree.glb"]);
    let scan = &told["scan"];
    assert!(scan["explained"].as_f64().unwrap() > 0.9, "{scan}");
    assert_eq!((scan["stems"].as_u64(), scan["pipe_source"].as_str()), (Some(1), Some("fitted")), "{scan}");
    let volume = told["items"][0]["plant"]["wood_volume_m3"].as_f64().unwrap();
    let interval = &scan["intervals"]["wood_volume_m3"];
    assert!(interval[0].as_f64().unwrap() < volume && volume < interval[1].as_f64().unwrap(), "{interval}");
    // Metres taken for millimetres.
    let error = bad(&at, &["scan", "tree.xyz", "--unit", "mm", "-o", "x.glb"]);
    assert!(error.contains("--unit m") && !at.join("x.glb").exists(), "{error}");
    // A gap in the trunk: bridged and reported; or left, and reported with its size.
    let gap: Vec<[f64; 3]> = whole.into_iter().filter(|p| !(1.0..1.6).contains(&p[2])).collect();
    write(&at, "gap.xyz", &[gap, ground(2.5)]);
    let told = report(&at, &["scan", "gap.xyz", "-o", "gap.glb"]);
    assert!(told["items"][0]["plant"]["height_m"].as_f64().unwrap() > 4.8);
    assert!(told["items"][0]["warnings"].to_string().contains("--gap"), "{}", told["items"][0]["warnings"]);
    let told = report(&at, &["scan", "gap.xyz", "--gap", "0.2", "-o", "stump.glb"]);
    let warnings = told["items"][0]["warnings"].to_string();
    assert!(warnings.contains("--gap 0.7") || warnings.contains("--gap 0.8"), "{warnings}");
    let failed = |name: &str| {
        let checks = told["items"][0]["checks"].as_array().unwrap();
        checks.iter().any(|c| c["name"] == name && c["ok"] == false)
    };
    assert!(failed("scan-loose") && failed("tree-cut"), "{}", told["items"][0]["checks"]);
}

#[test]
fn a_plot_becomes_its_trees_and_goes_on_where_it_was_stopped() {
    let at = folder("scan-plot");
    write(&at, "plot.xyz", &[tree([0.0, 0.0]), tree([2.5, 0.3]), ground(4.0)]);
    // Never one tree without a warning.
    let told = report(&at, &["scan", "plot.xyz", "-o", "one.glb"]);
    let warnings = told["items"][0]["warnings"].to_string();
    assert!(
        warnings.contains("2 trunks") && warnings.contains("--all") && warnings.contains("--at "),
        "{warnings}"
    );
    let all = ["scan", "plot.xyz", "--all", "-o", "plot"];
    let told = report(&at, &all);
    assert_eq!((told["ok"].as_u64(), told["plot"]["stems"].as_u64()), (Some(2), Some(2)), "{told}");
    for (tree, x) in told["trees"].as_array().unwrap().iter().zip([0.0, 2.5]) {
        assert!((tree["place"][0].as_f64().unwrap() - x).abs() < 0.05, "{tree}");
        assert!((tree["height_m"].as_f64().unwrap() - 5.0).abs() < 0.1, "{tree}");
        assert!((tree["dbh_m"].as_f64().unwrap() - 0.14).abs() < 0.015, "{tree}");
    }
    let inventory = fs::read_to_string(at.join("plot/inventory.csv")).unwrap();
    assert_eq!(inventory.lines().count(), 3, "{inventory}");
    for name in ["tree-001.glb", "tree-001.csv", "tree-002.glb", "tree-002.csv", "map.png"] {
        assert!(at.join("plot").join(name).is_file(), "{name}");
    }
    // One file is missing: only it is made again, with the same bytes.
    let first = fs::read(at.join("plot/tree-001.glb")).unwrap();
    fs::remove_file(at.join("plot/tree-001.glb")).unwrap();
    let told = report(&at, &all);
    assert_eq!((told["ok"].as_u64(), told["plot"]["kept"].as_u64()), (Some(2), Some(1)), "{told}");
    assert_eq!(fs::read(at.join("plot/tree-001.glb")).unwrap(), first);
    // With other options, all are made again.
    let told = report(&at, &[&all[..], &["--gap", "0.3"]].concat());
    assert_eq!(told["plot"]["kept"].as_u64(), Some(0));
    let error = bad(&at, &["scan", "plot.xyz", "--all", "-o", "plot.glb"]);
    assert!(error.contains("FOLDER"), "{error}");
}

#[test]
fn a_law_says_what_there_is_on_any_day_and_a_table_which_unit_was_taken() {
    let at = folder("law-at");
    let mut table = "Date,Height (cm),Plant\n".to_owned();
    for (k, day) in
        ["2024-05-01", "2024-05-08", "2024-05-15", "2024-05-22", "2024-05-29", "2024-06-05", "2024-06-12"]
            .iter()
            .enumerate()
    {
        let size =
            90.0 / (1.0 + 14.0 * (-0.12 * 7.0 * k as f64).exp()) + [0.4, -0.5, 0.3, -0.2, 0.5, -0.4, 0.2][k];
        table += &format!("{day},{size:.2},a\n");
    }
    fs::write(at.join("a.csv"), &table).unwrap();
    good(&at, &["bloom", "fit", "a.csv", "-o", "a.json"]);
    let told = report(&at, &["bloom", "at", "a.json", "--day", "10", "--day", "60"]);
    let [near, far] = [0, 1].map(|k| &told["values"][k]);
    let truth = 0.9 / (1.0 + 14.0 * (-1.2_f64).exp());
    assert!(
        near["determined"].as_bool().unwrap() && (near["value_m"].as_f64().unwrap() - truth).abs() < 0.02,
        "{near}"
    );
    assert!(near["low_m"].as_f64().unwrap() < truth && truth < near["high_m"].as_f64().unwrap(), "{near}");
    assert!(
        far["extrapolated"].as_bool().unwrap() && told["warnings"].to_string().contains("beyond"),
        "{told}"
    );
    // No unit anywhere: the assumed one is reported.
    fs::write(at.join("b.csv"), table.replace("Height (cm)", "height")).unwrap();
    let told = report(&at, &["bloom", "fit", "b.csv", "-o", "b.json"]);
    assert!(
        told["items"][0]["warnings"].to_string().contains("taken for metres"),
        "{}",
        told["items"][0]["warnings"]
    );
    // A warning says that three days determine nothing.
    fs::write(at.join("c.tsv"), "day\tsize_mm\n0\t20\n1\t22\n5\t31\n").unwrap();
    let told = good(&at, &["bloom", "fit", "c.tsv", "-o", "c.json"]);
    assert!(told.contains("3 days determine no law") && told.contains("best guess"), "{told}");
}
