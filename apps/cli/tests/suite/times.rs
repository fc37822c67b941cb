//! The time that a command reports is the time that it takes.

use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use serde_json::Value;

/// Strokes that lie on one another, as InkML: stages that were not timed took nine tenths of the time.
#[test]
fn the_stages_of_a_drawing_are_its_whole_time() {
    let at = Path::new(env!("CARGO_TARGET_TMPDIR")).join("stages");
    let _ = fs::remove_dir_all(&at);
    fs::create_dir_all(&at).unwrap();
    let points: Vec<String> = (0..40).map(|i| format!("{} {}", 100 + (i % 7), 100 + 5 * i)).collect();
    let trace = format!("<trace>{}</trace>\n", points.join(", "));
    let ink = format!("<ink xmlns=\"http://www.w3.org/2003/InkML\">\n{}</ink>\n", trace.repeat(700));
    fs::write(at.join("pile.inkml"), ink).unwrap();
    let options = ["--png", "p.png", "--size", "800x600", "--json"];
    let run = Command::new(env!("CARGO_BIN_EXE_burgeon"));
    let out = { run }
        .args(["sketch", "pile.inkml", "-o", "pile.glb"])
        .args(options)
        .current_dir(&at)
        .output()
        .unwrap();
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    let report: Value = serde_json::from_slice(&out.stdout).unwrap();
    let times = report["items"][0]["timings_ms"].as_object().unwrap();
    let ms = |of: &dyn Fn(&str) -> bool| -> f64 {
        times.iter().filter(|(name, _)| of(name)).map(|(_, ms)| ms.as_f64().unwrap()).sum()
    };
    let (stages, total) = (ms(&|name| name != "total"), ms(&|name| name == "total"));
    assert!(stages >= 0.95 * total && stages <= 1.001 * total, "{stages:.0} of {total:.0} ms: {times:?}");
}

#[test]
fn the_total_is_the_whole_command() {
    let at = Path::new(env!("CARGO_TARGET_TMPDIR")).join("times");
    let _ = fs::remove_dir_all(&at);
    fs::create_dir_all(&at).unwrap();
    let fixture = |name: &str| format!("{}/../../fixtures/{name}", env!("CARGO_MANIFEST_DIR"));
    let (rose, marks) = (fixture("sketches/table1/a.svg"), fixture("leaves/leaf1.csv"));
    fs::write(at.join("none.json"), "{\"schema\": \"burgeon.edits/1\", \"edits\": []}").unwrap();
    // The picture takes most of each: it was not counted.
    let picture = ["--png", "p.png", "--size", "800x600"];
    let commands: [&[&str]; 7] = [
        &["grow", "grass", "-o", "grass.glb"],
        &["sketch", &rose, "-o", "rose.glb"],
        &["leaf", &marks, "-o", "leaf.glb"],
        &["bloom", "run", "lily", "--day", "4", "-o", "lily.glb"],
        &["convert", "grass.glb", "-o", "grass.ply"],
        &["shape", "grass", "--edits", "none.json", "-o", "b.glb"],
        &["render", "grass.glb", "-o", "r.png", "--size", "800x600"],
    ];
    for command in commands {
        let more: &[&str] = if command[0] == "render" { &[] } else { &picture };
        let start = Instant::now();
        let run = Command::new(env!("CARGO_BIN_EXE_burgeon"));
        let out = { run }.args(command).args(more).arg("--json").current_dir(&at).output().unwrap();
        let wall = start.elapsed().as_secs_f64() * 1e3;
        assert!(out.status.success(), "{command:?}: {}", String::from_utf8_lossy(&out.stderr));
        let report: Value = serde_json::from_slice(&out.stdout).unwrap();
        let total = report["items"][0]["timings_ms"]["total"].as_f64().unwrap();
        assert!(total <= wall && total > 0.7 * wall - 60.0, "{command:?}: {total:.0} ms of {wall:.0} ms");
    }
}
