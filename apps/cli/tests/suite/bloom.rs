//! `burgeon bloom` as other programs call it.
#![expect(clippy::unwrap_used, reason = "tests")]

use crate::tools;
use std::fs;
use std::path::Path;

use serde_json::Value;
use tools::{burgeon, folder, good, json};

/// Checks that the command is refused in a line that holds `want`.
fn bad(folder: &Path, args: &[&str], want: &str) {
    let text = tools::bad(folder, args);
    assert!(text.contains(want), "{text:?} should say {want:?}");
}

/// Writes a leaf of `length` mm that rises by `rise`.
fn leaf(length: f64, rise: f64) -> String {
    let mut text = String::new();
    for i in 0..40 {
        for j in 0..15 {
            let (v, u) = (f64::from(i) / 39.0, f64::from(j) / 7.0 - 1.0);
            let half = 0.2 * length * (1.0 - (2.0 * v - 1.0) * (2.0 * v - 1.0)) + 0.5;
            text += &format!("{} {} {}\n", u * half, rise * v * length, v * length);
        }
    }
    text
}

#[test]
fn a_law_is_fitted_and_drives_a_day_an_animation_and_another_species() {
    let dir = folder("bloom_law");
    let mut stages = String::from("name = \"made\"\nunit = \"mm\"\nsplit = \"none\"\n");
    for (k, (day, length)) in [(0, 20.0), (2, 31.0), (4, 42.0), (7, 50.0), (9, 52.0)].iter().enumerate() {
        fs::write(dir.join(format!("s{k}.xyz")), leaf(*length, 0.2 + 0.01 * f64::from(*day))).unwrap();
        stages += &format!("[[stage]]\nfile = \"s{k}.xyz\"\nday = {day}\nbase = [0, 0, 0]\n");
    }
    fs::write(dir.join("stages.toml"), &stages).unwrap();
    good(
        &dir,
        &["bloom", "fit", "stages.toml", "-o", "law.json", "--plot", "fit.svg", "--report", "fit.json"],
    );
    let laws = json(&dir.join("fit.json"))["laws"].as_array().unwrap().clone();
    assert_eq!(laws.len(), 10, "size, and three coordinates of three regions");
    assert!(laws.iter().all(|l| l["K"].is_f64() && l["organ"] == "organ"), "{laws:?}");
    assert!(laws[0]["r2"].as_f64().unwrap() > 0.98 && laws[0]["loo_rmse"].is_f64(), "{:?}", laws[0]);
    assert!(fs::read_to_string(dir.join("fit.svg")).unwrap().contains("<polyline"));

    let run = [
        "bloom",
        "run",
        "s0.xyz",
        "--end",
        "s4.xyz",
        "--law",
        "law.json",
        "--unit",
        "mm",
        "--whole",
        "--no-clean",
    ];
    let with = |more: &[&'static str]| [&run[..], more].concat();
    good(&dir, &with(&["--day", "4", "-o", "day4.ply", "--compare", "s2.xyz", "--report", "run.json"]));
    let report = json(&dir.join("run.json"));
    let error = &report["error"];
    assert!(error["mean_mm"].as_f64().unwrap() < 1.5, "{error}");
    assert!(error["paper_mm"].as_f64().unwrap() <= error["mean_mm"].as_f64().unwrap(), "{error}");
    assert!(error["coverage"].as_f64().unwrap() > 0.8, "{error}");
    good(&dir, &with(&["--frames", "5", "-o", "grow.glb"]));
    let glb = fs::read(dir.join("grow.glb")).unwrap();
    assert!(glb.windows(11).any(|w| w == b"\"animations"), "a morph animation");
    good(
        &dir,
        &["bloom", "run", "lily", "--law", "law.json", "--frames", "3", "-o", "lily", "--format", "obj"],
    );
    assert!(["lily-000.obj", "lily-002.obj"].iter().all(|n| dir.join("lily").join(n).is_file()));
}

#[test]
fn a_flower_of_your_own_is_a_file() {
    let dir = folder("bloom_own");
    // The example in docs/bloom.md.
    let docs = include_str!("../../../../docs/bloom.md");
    let star = docs.split("```toml").find(|part| part.contains("name = \"star\"")).unwrap();
    let star = star.split("```").next().unwrap().trim_start();
    fs::write(dir.join("star.toml"), star).unwrap();
    good(&dir, &["bloom", "run", "star.toml", "-o", "star.glb", "--day", "6", "--report", "star.json"]);
    let report = json(&dir.join("star.json"));
    assert_eq!(
        (&report["items"][0]["name"], &report["items"][0]["counts"]["petals"]),
        (&"star".into(), &5.into())
    );
    // A preset's file gives the preset.
    let lily = include_str!("../../../../crates/bloom/presets/lily.toml");
    fs::write(dir.join("mine.toml"), lily).unwrap();
    for (start, out) in [("mine.toml", "mine.ply"), ("lily", "own.ply")] {
        good(&dir, &["bloom", "run", start, "-o", out, "--day", "3"]);
    }
    assert_eq!(fs::read(dir.join("mine.ply")).unwrap(), fs::read(dir.join("own.ply")).unwrap());
    for (text, want) in [
        (
            star.replace("count = 5\nlength", "petals = 5\nlength"),
            "line 5: whorls[0]: unknown field `petals`",
        ),
        (star.replace("0.12", "9"), "line 2: stalk_m must be 0 to 5 m, not 9"),
        (format!("umbel = 200\nmesh = {{ rows = 100, columns = 100 }}\n{star}"), "triangles"),
    ] {
        fs::write(dir.join("bad.toml"), text).unwrap();
        bad(&dir, &["bloom", "run", "bad.toml", "-o", "bad.glb"], want);
    }
}

#[test]
fn flowers_open_and_their_overlap_is_told() {
    let dir = folder("bloom_flower");
    good(
        &dir,
        &["bloom", "run", "tulip", "-o", "tulip.glb", "--frames", "4", "--report", "r.json", "--quiet"],
    );
    let report = json(&dir.join("r.json"));
    let overlap = report["overlap"].as_array().unwrap();
    assert!(overlap.len() == 4 && overlap.iter().all(|o| o.as_f64() == Some(0.0)), "{overlap:?}");
    assert_eq!((&report["frames"], &report["items"][0]["counts"]["petals"]), (&4.into(), &6.into()));
}

#[test]
fn bad_input_is_one_clear_line() {
    let dir = folder("bloom_bad");
    fs::write(dir.join("a.xyz"), leaf(20.0, 0.1)).unwrap();
    fs::write(dir.join("nan.xyz"), "nan nan nan\n").unwrap();
    let stage = |days: &[i32]| {
        days.iter()
            .map(|d| format!("[[stage]]\nfile = \"a.xyz\"\nday = {d}\norgan = \"x\"\n"))
            .collect::<String>()
    };
    fs::write(dir.join("one.toml"), stage(&[1])).unwrap();
    fs::write(dir.join("disorder.toml"), stage(&[1, 3, 2])).unwrap();
    fs::write(dir.join("none.toml"), "name = \"x\"\n").unwrap();
    fs::write(dir.join("typo.toml"), "[[stage]]\nfil = \"a.xyz\"\nday = 1\n").unwrap();
    fs::write(dir.join("nan.toml"), "[[stage]]\nfile = \"nan.xyz\"\nday = 1\n").unwrap();
    fs::write(dir.join("law.json"), "{\"schema\": \"burgeon.law/1\"}").unwrap();
    let fit = |name: &str, want: &str| bad(&dir, &["bloom", "fit", name, "-o", "law"], want);
    fit("one.toml", "at least 3");
    fit("disorder.toml", "does not come after");
    fit("none.toml", "names no stage");
    fit("typo.toml", "fil");
    fit("nan.toml", "finite");
    fit("missing.toml", "no such file");
    bad(&dir, &["bloom", "run", "hyacinth", "-o", "x.glb"], "no such flower");
    bad(&dir, &["bloom", "run", "rose", "--law", "law.json", "-o", "x.glb"], "no growth law");
    bad(&dir, &["bloom", "run", "a.xyz", "-o", "x.glb"], "--end is missing");
    bad(&dir, &["bloom", "run", "a.xyz", "--end", "a.xyz", "-o", "x.glb", "--lattice", "1x4x4"], "2 to 16");
    assert!(!dir.join("law").exists() && !dir.join("x.glb").exists(), "nothing is half-written");
}

/// Writes a stages file of three days, all the same scan as one organ.
fn thrice(dir: &Path, scan: &str) -> String {
    let stage = |d| format!("[[stage]]\nfile = \"{scan}\"\nday = {d}\norgan = \"x\"\n");
    let name = format!("{scan}.toml");
    fs::write(dir.join(&name), (1..=3).map(stage).collect::<String>()).unwrap();
    name
}

fn las(offset: f64, scale: f64, at: u32, count: u32) -> Vec<u8> {
    let mut file = vec![0; 227];
    file[..4].copy_from_slice(b"LASF");
    (file[24], file[25]) = (1, 2);
    file[94..96].copy_from_slice(&227_u16.to_le_bytes());
    file[96..100].copy_from_slice(&at.to_le_bytes());
    file[105..107].copy_from_slice(&20_u16.to_le_bytes());
    file[107..111].copy_from_slice(&count.to_le_bytes());
    for k in 0..3 {
        file[131 + 8 * k..139 + 8 * k].copy_from_slice(&scale.to_le_bytes());
        file[155 + 8 * k..163 + 8 * k].copy_from_slice(&offset.to_le_bytes());
    }
    for i in 0..100_i32 {
        [i * 7 % 31, i * 11 % 57, i].iter().for_each(|x| file.extend((x * 10).to_le_bytes()));
        file.extend([0; 8]);
    }
    file
}

#[test]
fn hostile_scans_are_told_in_one_line() {
    let dir = folder("bloom_hostile");
    let ply = |count: &str, points: i32| {
        let mut file = format!(
            "ply\nformat binary_little_endian 1.0\nelement vertex {count}\nproperty float x\nproperty float y\n\
             property float z\nend_header\n"
        )
        .into_bytes();
        for i in 0..points {
            [i * 7 % 31, i * 11 % 57, i].iter().for_each(|&x| file.extend((x as f32).to_le_bytes()));
        }
        file
    };
    let endless = format!("ply\nformat ascii 1.0\n{}", "comment x\n".repeat(100_000));
    for (name, bytes, want) in [
        ("more.ply", ply("200", 100), "200 rows are announced, at most 100 are there"),
        ("huge.ply", ply("18446744073709551615", 100), "at most 100 are there"),
        ("negative.ply", ply("-5", 100), "the number of rows is broken"),
        ("endless.ply", endless.into_bytes(), "the header does not end"),
        ("far.las", las(1e300, 1e-3, 227, 100), "offset 1e300 of a coordinate is absurd"),
        ("nan.las", las(f64::NAN, 1e-3, 227, 100), "offset NaN of a coordinate is absurd"),
        ("flat.las", las(0.0, 0.0, 227, 100), "the scale 0 of a coordinate is no use"),
        ("outside.las", las(0.0, 1e-3, 4_000_000_000, 100), "the points begin at byte 4000000000 of 2227"),
        ("count.las", las(0.0, 1e-3, 227, u32::MAX), "4294967295 are announced, 100 are there"),
    ] {
        fs::write(dir.join(name), bytes).unwrap();
        bad(&dir, &["bloom", "fit", &thrice(&dir, name), "-o", "law"], want);
    }
    assert!(!dir.join("law").exists(), "nothing is half-written");
}

/// Returns sine and cosine of the angle whose half has this tangent.
fn sin_cos(half: f64) -> (f64, f64) {
    (2.0 * half / (1.0 + half * half), (1.0 - half * half) / (1.0 + half * half))
}

/// Writes a seedling in mm, +Y up: a stem and two leaves of `length`, rotated about the stem by the angle whose half
/// has the tangent `turn`, and moved along x by `shift`.
fn seedling(length: f64, turn: f64, shift: f64) -> String {
    let mut points: Vec<[f64; 3]> = Vec::new();
    for i in 0..60 {
        for j in 0..12_usize {
            // Twelve places round the stem, from the tangents of half of their angles.
            let (sin, cos) =
                sin_cos([0.0, 0.27, 0.58, 1.0, 1.73, 3.73, 1e9, -3.73, -1.73, -1.0, -0.58, -0.27][j]);
            points.push([1.2 * cos, 0.5 * f64::from(i), 1.2 * sin]);
        }
    }
    for (azimuth, longer) in [(0.1, 1.0), (8.0, 0.8)] {
        let (sin, cos) = sin_cos(azimuth);
        for i in 0..70 {
            for j in 0..21 {
                let (v, u) = (f64::from(i) / 69.0, f64::from(j) / 10.0 - 1.0);
                let bulge = 1.0 - (v - 0.6) * (v - 0.6) / 0.16;
                let half = if v < 0.2 { 0.8 } else { 6.0 * bulge.max(0.0).sqrt() + 0.5 };
                let (out, across) = (length * longer * v, u * half);
                points.push([out * cos - across * sin, 30.0 + 0.2 * out, out * sin + across * cos]);
            }
        }
    }
    let (sin, cos) = sin_cos(turn);
    let mut text = String::new();
    for [x, y, z] in points {
        text += &format!("{:.4} {y:.4} {:.4}\n", x * cos + z * sin + shift, z * cos - x * sin);
    }
    text
}

#[test]
fn the_turn_of_a_pot_is_told_and_each_day_is_left_out() {
    let dir = folder("bloom_pose");
    let mut stages = String::from("name = \"made\"\nunit = \"mm\"\n");
    for (k, (day, length, turn, shift)) in
        [(0, 24.0, 0.0, 0.0), (2, 30.0, 0.25, 7.0), (4, 33.0, 0.25, 7.0), (8, 36.0, 0.1, 3.0)]
            .iter()
            .enumerate()
    {
        fs::write(dir.join(format!("s{k}.xyz")), seedling(*length, *turn, *shift)).unwrap();
        stages += &format!("[[stage]]\nfile = \"s{k}.xyz\"\nday = {day}\n");
    }
    fs::write(dir.join("stages.toml"), &stages).unwrap();
    good(&dir, &["bloom", "fit", "stages.toml", "-o", "law.json", "--leave-one-out", "--report", "fit.json"]);
    let fit = json(&dir.join("fit.json"));
    let plant = &fit["poses"][0]["plant"];
    assert!((plant["turn_deg"].as_f64().unwrap() - 28.07).abs() < 2.0, "{plant}");
    assert!((plant["move_mm"].as_f64().unwrap() - 7.0).abs() < 1.5, "{plant}");
    let still = &fit["poses"][1]["plant"];
    assert!(still["turn_deg"].as_f64().unwrap() < 2.0 && still["move_mm"].as_f64().unwrap() < 1.5, "{still}");
    for organ in fit["poses"][1]["organs"].as_array().unwrap() {
        assert!(organ["turn_deg"].as_f64().unwrap() < 6.0, "no organ turned by itself: {organ}");
        let leaf = organ["organ"] != "stem";
        let scale = organ["scale"].as_f64().unwrap();
        assert!(!leaf || scale > 1.02, "leaves grew: {organ}");
    }
    let trials = fit["leave_one_out"].as_array().unwrap();
    assert_eq!(
        (trials.len(), &trials[0]["extrapolated"], &trials[1]["extrapolated"]),
        (4, &true.into(), &false.into())
    );
    let mean = |way: usize| {
        let of = |t: &Value, key: &str| t["ways"][way]["aligned"][key].as_f64().unwrap();
        trials[1..3].iter().map(|t| of(t, "mean_mm") + of(t, "back_mean_mm")).sum::<f64>()
    };
    assert_eq!(trials[1]["ways"][2]["way"], "nearest day");
    assert!(mean(0) < mean(2), "{} {}", mean(0), mean(2));
    // In the frame of the plant it stands as on the first day; in the scanner's as on its own day.
    let run = [
        "bloom",
        "run",
        "stages.toml",
        "--law",
        "law.json",
        "--day",
        "2",
        "-o",
        "d.ply",
        "--report",
        "r.json",
    ];
    let error = |more: &[&str]| {
        good(&dir, &[&run[..], more].concat());
        json(&dir.join("r.json"))["items"][0]["digest"].clone()
    };
    assert_ne!(error(&[]), error(&["--frame", "plant"]));
    good(&dir, &[&run[..], &["--compare", "s1.xyz", "--unit", "mm"]].concat());
    let report = json(&dir.join("r.json"));
    let [as_it_stands, aligned] = ["error", "aligned"].map(|k| report[k]["mean_mm"].as_f64().unwrap());
    assert!(as_it_stands < 0.5 && aligned <= as_it_stands + 0.05, "{as_it_stands} {aligned}");
    let pair =
        ["bloom", "run", "s0.xyz", "--end", "s1.xyz", "--whole", "--unit", "mm", "-o", "x.ply", "--day", "1"];
    bad(&dir, &[&pair[..], &["--frame", "plant"]].concat(), "--frame is for plants");
}

#[test]
fn a_growth_table_gives_laws_with_errors() {
    let dir = folder("bloom_table");
    let mut text = String::from("# unit: mm\nday;size;organ;plant\n");
    for (index, (plant, k)) in (0..).zip([("a", 40.0), ("b", 55.0), ("c", 47.0)]) {
        for day in [0, 2, 4, 7, 10, 14] {
            let wobble = 1.0 + 0.01 * f64::from((day * 7 + index * 13) % 5 - 2);
            let truth = burgeon::bloom::Logistic { k, p0: 0.1 * k, r: 0.5, offset: 0.0 };
            let size = wobble * truth.value(f64::from(day));
            text +=
                &format!("{day};{:.3};leaf-1;{plant}\n", size).replace('.', ",").replace("leaf,", "leaf-");
        }
    }
    fs::write(dir.join("t.csv"), &text).unwrap();
    good(&dir, &["bloom", "fit", "t.csv", "-o", "law.json", "--report", "r.json", "--plot", "p.svg"]);
    let laws = json(&dir.join("r.json"))["laws"].as_array().unwrap().clone();
    assert_eq!(laws.len(), 3);
    for (law, k) in laws.iter().zip([0.040, 0.055, 0.047]) {
        assert!(law["determined"] == true && law["form"] == "logistic", "{law}");
        let [got, se] = [law["K"].as_f64().unwrap(), law["standard_errors"][0].as_f64().unwrap()];
        assert!((got - k).abs() < 3.0 * se && se < 0.002, "{law}");
        assert!((law["r"].as_f64().unwrap() - 0.5).abs() < 0.05, "{law}");
    }
    good(&dir, &["bloom", "run", "lily", "--law", "law.json", "-o", "lily.glb", "--day", "3"]);
    let fit = |text: &str, want: &str| {
        fs::write(dir.join("bad.csv"), text).unwrap();
        bad(&dir, &["bloom", "fit", "bad.csv", "-o", "x.json"], want);
    };
    fit("day,size\n1,2\n2,3\n", "2 stages cannot determine");
    fit("day,size\n1,2\n1,3\n3,4\n", "two sizes on day 1");
    fit("day,size\n1,2\nx,3\n", "line 3");
    bad(&dir, &["bloom", "fit", "t.csv", "-o", "x.json", "--leave-one-out"], "--leave-one-out is for scans");
    // Quantities that three values of one plant cannot determine are reported.
    fs::write(dir.join("few.csv"), "day,size\n1,2\n2,3\n3,3.5\n").unwrap();
    good(&dir, &["bloom", "fit", "few.csv", "-o", "few.json", "--report", "few.r.json"]);
    assert_eq!(json(&dir.join("few.r.json"))["laws"][0]["determined"], false);
    let out = burgeon(&dir, &["bloom", "run", "rose", "--law", "few.json", "--day", "3", "-o", "rose.glb"]);
    assert!(out.status.success());
    assert!(String::from_utf8_lossy(&out.stderr).contains("at an even pace"), "{out:?}");
}

#[test]
fn odd_stages_are_taken_with_a_warning() {
    let dir = folder("bloom_odd");
    fs::write(dir.join("a.xyz"), leaf(20.0, 0.1)).unwrap();
    fs::write(dir.join("b.xyz"), leaf(30.0, 0.1) + "nan nan nan\ninf 0 0\n").unwrap();
    // In metres, the others in millimetres.
    fs::write(dir.join("c.xyz"), leaf(0.04, 0.1)).unwrap();
    let stage = |(d, file): (i32, &str)| format!("[[stage]]\nfile = \"{file}\"\nday = {d}\norgan = \"x\"\n");
    let stages: String = [(1, "a.xyz"), (2, "b.xyz"), (3, "c.xyz")].map(stage).concat();
    fs::write(dir.join("stages.toml"), format!("unit = \"mm\"\n{stages}")).unwrap();
    let out = burgeon(&dir, &["bloom", "fit", "stages.toml", "-o", "law.json"]);
    let text = String::from_utf8_lossy(&out.stderr);
    assert!(out.status.success(), "{text}");
    assert!(text.contains("2 points that are not finite numbers"), "{text}");
    assert!(text.contains("are their units the same?"), "{text}");
}

#[test]
fn drawn_flowers_open_and_own_petals_are_taken() {
    let dir = folder("bloom_drawn");
    let fixture = |name: &str| format!("{}/../../fixtures/{name}", env!("CARGO_MANIFEST_DIR"));
    let drawing = fixture("sketches/gallery/tulip.svg");
    good(&dir, &["bloom", "run", &drawing, "-o", "t.glb", "--frames", "4", "--report", "t.json", "--quiet"]);
    let report = json(&dir.join("t.json"));
    assert!(report["items"][0]["counts"]["flowers"].as_u64() >= Some(1), "{report}");
    assert!(report["items"][0]["counts"]["petals"].as_u64() >= Some(3), "{report}");
    assert_eq!(report["overlap"].as_array().unwrap().len(), 4);
    let digest = |args: &[&str]| {
        good(&dir, &[args, &["--day", "6", "-o", "x.glb", "--report", "x.json", "--quiet"]].concat());
        json(&dir.join("x.json"))["items"][0]["digest"].as_str().unwrap().to_owned()
    };
    let marks = fixture("leaves/leaf1.csv");
    let own = [
        digest(&["bloom", "run", "lily"]),
        digest(&["bloom", "run", "lily", "--petal", &marks]),
        digest(&["bloom", "run", "lily", "--petal", &drawing]),
    ];
    assert!(own[0] != own[1] && own[1] != own[2] && own[0] != own[2], "{own:?}");
    bad(&dir, &["bloom", "run", &fixture("sketches/gallery/oak.svg"), "-o", "x.glb"], "no flower was found");
    bad(&dir, &["bloom", "run", &drawing, "--petal", &marks, "-o", "y.glb"], "--petal is for whole flowers");
    assert!(!dir.join("y.glb").exists());
}
