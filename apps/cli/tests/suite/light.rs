//! `burgeon light`: from a plant to a table, figures and colours.
#![expect(clippy::unwrap_used, reason = "tests")]

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::tools::{FLOWER, bad, folder, good};

const SMALL: &str = r#"
name = "small"
[method]
kind = "colonization"
points = 60
envelope = { shape = "sphere", centre = [0.0, 1.0, 0.0], radius_m = 0.5 }
[method.steps]
attraction_m = 0.8
kill_m = 0.3
"#;

fn ready(name: &str) -> std::path::PathBuf {
    let dir = folder(name);
    fs::write(dir.join("small.toml"), SMALL).unwrap();
    fs::write(dir.join("bare.toml"), format!("bare = true\n{SMALL}")).unwrap();
    fs::write(dir.join("rose.svg"), FLOWER).unwrap();
    dir
}

fn report(dir: &Path, args: &[&str]) -> Value {
    serde_json::from_str(&good(dir, &[&["light"], args, &["--json"]].concat())).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

#[test]
fn the_table_has_what_the_report_sums_up() {
    let dir = ready("light-table");
    let told = report(&dir, &["small.toml", "--repeat", "1.2x1.2", "-o", "small.csv", "--rays", "20000"]);
    let light = &told["light"];
    let text = fs::read_to_string(dir.join("small.csv")).unwrap();
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let column = |name: &str| names.iter().position(|n| *n == name).unwrap();
    let rows: Vec<Vec<&str>> = lines.map(|l| l.split(',').collect()).collect();
    assert_eq!(rows.len() as u64, light["rows"].as_u64().unwrap());
    let sum = |name: &str, kind: &str| -> f64 {
        let of_kind = rows.iter().filter(|r| kind.is_empty() || r[column("kind")] == kind);
        of_kind.map(|r| r[column(name)].parse::<f64>().unwrap()).sum()
    };
    let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-9, "{a}, not {b}");
    near(sum("absorbed_w", ""), number(&light["absorbed"]));
    near(sum("absorbed_w", "leaf"), number(&light["leaf_absorbed"]));
    near(sum("area_m2", "leaf") / 1.44, number(&light["leaf_area_index"]));
    let balance = &light["balance"];
    let kept: f64 = ["plants", "soil", "reflected", "lost"].iter().map(|k| number(&balance[*k])).sum();
    assert!((kept / number(&balance["incoming"]) - 1.0).abs() < 1e-3, "{balance}");
    near(number(&balance["incoming"]), 144.0);
    let (fapar, k) = (number(&light["fapar"]), number(&light["extinction"]));
    // A small plant in a large cell: about as much as its leaf area times the mean extinction.
    assert!((0.03..0.2).contains(&fapar) && (0.2..1.2).contains(&k), "{light}");
    // Without a sun nothing is sunlit.
    assert!(light["sunlit"].is_null() && rows.iter().all(|r| r[column("sunlit")].is_empty()));
}

#[test]
fn threads_do_not_matter_and_suns_do() {
    let dir = ready("light-threads");
    let at = ["light", "small.toml", "--place", "48.1,11.6", "--date", "2026-06-21", "--rays", "5000", "-q"];
    good(&dir, &[&at[..], &["--threads", "1", "-o", "one.csv"]].concat());
    good(&dir, &[&at[..], &["--threads", "4", "-o", "four.csv"]].concat());
    good(&dir, &[&at[..], &["--hour", "8", "-o", "early.csv"]].concat());
    let read = |name: &str| fs::read(dir.join(name)).unwrap();
    assert_eq!(read("one.csv"), read("four.csv"));
    assert_ne!(read("one.csv"), read("early.csv"));
    let noon = report(&dir, &[&at[1..8], &["--zone", "2", "--hour", "13.25"]].concat());
    // Munich at the solstice: 90 - 48.1 + 23.4 degrees, in the south.
    let sun = &noon["light"];
    assert!((number(&sun["sun_elevation_deg"]) - 65.3).abs() < 0.2, "{sun}");
    assert!((number(&sun["sun_azimuth_deg"]) - 180.0).abs() < 3.0, "{sun}");
    assert!((0.2..0.9).contains(&number(&sun["sunlit"])), "{sun}");
    assert!((350.0..480.0).contains(&number(&sun["direct_per_m2"])), "{sun}");
}

#[test]
fn a_day_is_the_sum_of_its_hours() {
    let dir = ready("light-day");
    let day =
        report(&dir, &["small.toml", "--place", "0,0", "--date", "2026-03-20", "--daily", "--rays", "1000"]);
    let light = &day["light"];
    assert_eq!(light["unit"], "MJ");
    assert!((number(&light["day_hours"]) - 12.0).abs() <= 0.5, "{light}");
    // Clear days on the equator have some 27 MJ of all wavelengths.
    assert!((11.0..15.0).contains(&number(&light["incoming_per_m2"])), "{light}");
    let polar = ["light", "small.toml", "--place", "80,0", "--date", "2026-12-21"];
    let said = bad(&dir, &[&polar[..], &["--daily", "-o", "x.csv"]].concat());
    assert!(said.contains("does not rise"), "{said}");
    let said = bad(&dir, &[&polar[..], &["-o", "x.csv"]].concat());
    assert!(said.contains("below the horizon"), "{said}");
    assert!(!dir.join("x.csv").exists());
}

#[test]
fn drawings_flowers_and_projects_stand_in_the_light() {
    let dir = ready("light-makers");
    let project = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/projects/version-3.burgeon");
    fs::copy(project, dir.join("scene.burgeon")).unwrap();
    for (what, plants) in [("rose.svg", 1), ("tulip", 1), ("scene.burgeon", 2)] {
        let told = report(&dir, &[what, "-o", "x.csv", "--rays", "3000"]);
        assert!(number(&told["light"]["absorbed"]) > 0.0, "{what}");
        assert!(told["items"].as_array().unwrap().len() >= plants, "{what}");
        let last = fs::read_to_string(dir.join("x.csv")).unwrap();
        let last = last.lines().last().unwrap().split(',').next().unwrap().parse::<usize>().unwrap();
        assert!(last >= plants, "{what}: {last}");
    }
    good(&dir, &["light", "rose.svg", "-o", "rose.glb", "--png", "rose.png", "--size", "60x40", "-q"]);
    let told = good(&dir, &["info", "rose.glb", "--json"]);
    assert!(told.contains("light"), "{told}");
    assert!(fs::metadata(dir.join("rose.png")).unwrap().len() > 500);
}

#[test]
fn plants_without_leaves_and_odd_skies_are_told_of() {
    let dir = ready("light-odd");
    let bare = report(&dir, &["bare.toml", "--rays", "3000"]);
    assert!(bare["items"][0]["warnings"].to_string().contains("0 leaves"), "{bare}");
    assert!(bare["light"]["leaf_share"].is_null());
    let said = bad(&dir, &["light", "bare.toml", "-o", "x.csv", "--strict"]);
    assert!(said.contains("0 leaves") && !dir.join("x.csv").exists(), "{said}");
    fs::write(dir.join("sky.csv"), "# measured\nazimuth,elevation,par\n0,30,20\n180,60,70\n").unwrap();
    let sky = report(&dir, &["small.toml", "--sky-table", "sky.csv", "--rays", "3000"]);
    assert!((number(&sky["light"]["incoming_per_m2"]) - 90.0).abs() < 1e-9, "{sky}");
    for (text, part) in [
        ("0,30,x\n0,30,y\n", "line 2"),
        ("0,-30,20\n", "below the horizon"),
        ("0,30,NaN\n", "line 1"),
        ("0,30\n", "azimuth"),
        ("", "holds no light"),
    ] {
        fs::write(dir.join("bad.csv"), text).unwrap();
        let said = bad(&dir, &["light", "small.toml", "--sky-table", "bad.csv", "-o", "x.csv"]);
        assert!(said.contains(part), "{text}: {said}");
    }
    for (args, part) in [
        (&["--sun", "180,-5", "--direct", "10"][..], "below the horizon"),
        (&["--diffuse", "0"], "no light"),
        (&["--sky", "clear"], "--sun"),
        (&["--direct", "10"], "--sun"),
        (&["--repeat", "0.001x0.001"], "larger cells"),
        (&["--leaf", "0.7,0.7"], "at most 1"),
        (&["--place", "48,2", "--date", "2026-02-30"], "day"),
        (&["--place", "98,2", "--date", "2026-02-03"], "latitude"),
    ] {
        let said = bad(&dir, &[&["light", "small.toml", "-o", "x.csv"], args].concat());
        assert!(said.contains(part), "{args:?}: {said}");
    }
    let said = bad(&dir, &["light", "small.toml", "-o", "x.obj"]);
    assert!(said.contains(".csv"), "{said}");
}

#[test]
fn structure_has_light_in_columns_of_its_own() {
    let dir = ready("light-structure");
    report(&dir, &["small.toml", "-o", "x.csv", "--rays", "3000"]);
    report(&dir, &["small.toml", "-o", "x.mtg", "--rays", "3000"]);
    report(&dir, &["small.toml", "-o", "x.opf", "--rays", "3000"]);
    let table = fs::read_to_string(dir.join("x.csv")).unwrap();
    let mut lines = table.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let at = |name: &str| names.iter().position(|n| *n == name).unwrap();
    let leaves = lines.map(|l| l.split(',').collect::<Vec<_>>()).filter(|r| r[at("kind")] == "leaf");
    let leaves: Vec<(usize, f64)> =
        leaves.map(|r| (r[at("id")].parse().unwrap(), r[at("absorbed_w_m2")].parse().unwrap())).collect();
    let mtg = fs::read_to_string(dir.join("x.mtg")).unwrap();
    let head = mtg.lines().find(|l| l.starts_with("ENTITY-CODE")).unwrap();
    let column = head.split('\t').position(|n| n == "AbsorbedPAR").unwrap();
    let mut found = 0;
    for line in mtg.lines() {
        let cells: Vec<&str> = line.split('\t').collect();
        let code = cells.iter().find(|c| !c.is_empty()).copied().unwrap_or_default();
        let Some(number) = code.strip_prefix("+L") else { continue };
        let row = number.parse::<usize>().unwrap() - 1;
        let (_, wanted) = leaves.iter().find(|(id, _)| *id == row).unwrap();
        let there: f64 = cells[column].parse().unwrap();
        assert!((there - wanted).abs() < 1e-8, "leaf {row}: {there}, not {wanted}");
        found += 1;
    }
    assert!(found == leaves.len() && found > 10, "{found}");
    let opf = fs::read_to_string(dir.join("x.opf")).unwrap();
    assert!(opf.matches("<AbsorbedPAR>").count() > found, "leaves and axes");
    let project = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/projects/version-3.burgeon");
    fs::copy(project, dir.join("scene.burgeon")).unwrap();
    let said = bad(&dir, &["light", "scene.burgeon", "-o", "both.mtg", "--rays", "3000"]);
    assert!(said.contains("one plant") && !dir.join("both.mtg").exists(), "{said}");
}
