//! Measured trees made into a species, and trees of it.
#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "tests: trees that are made here and now"
)]

use crate::tools;
use std::fmt::Write as _;
use std::fs;

use serde_json::Value;
use tools::{bad, burgeon, folder, good, json};

/// Pseudo-random numbers from 0 to 1 that follow from a seed.
struct Numbers(u64);

impl Numbers {
    /// Successive seeds give unrelated numbers.
    fn new(seed: u64) -> Self {
        let mixed = (seed + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        Self((mixed ^ (mixed >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9))
    }
}

impl Numbers {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// A table of cylinders, written axis by axis.
#[derive(Default)]
struct Table {
    rows: String,
    count: usize,
    branches: usize,
}

const UP: [f64; 3] = [0.0, 0.0, 1.0];

/// Returns the direction that leaves another by an angle, at an azimuth about it.
fn away([x, y, z]: [f64; 3], degrees: f64, azimuth: f64) -> [f64; 3] {
    // Two directions across the first: any direction not parallel to it gives one.
    let other = if z.abs() < 0.9 { UP } else { [1.0, 0.0, 0.0] };
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    let unit = |a: [f64; 3]| {
        let length = a.iter().map(|c| c * c).sum::<f64>().sqrt();
        a.map(|c| c / length)
    };
    let u = unit(cross([x, y, z], other));
    let v = cross([x, y, z], u);
    let [(s, c), (sa, ca)] = [degrees.to_radians(), azimuth.to_radians()].map(f64::sin_cos);
    [0, 1, 2].map(|k| [x, y, z][k] * c + (u[k] * ca + v[k] * sa) * s)
}

impl Table {
    /// Adds an axis of ten cylinders that tapers to a third; returns the number of each cylinder.
    fn axis(
        &mut self,
        foot: [f64; 3],
        way: [f64; 3],
        [length, radius]: [f64; 2],
        parent: usize,
    ) -> Vec<usize> {
        self.branches += 1;
        let place = |k: usize| [0, 1, 2].map(|c| foot[c] + way[c] * length * k as f64 / 10.0);
        let mut parent = parent;
        let mut all = Vec::new();
        for k in 0..10 {
            let (a, b, r) = (place(k), place(k + 1), radius * (1.0 - 0.066 * k as f64));
            writeln!(
                self.rows,
                "{r:.6},{:.6},{:.6},{:.6},{:.6},{:.6},{:.6},{parent},{}",
                a[0], a[1], a[2], b[0], b[1], b[2], self.branches
            )
            .unwrap();
            self.count += 1;
            parent = self.count;
            all.push(parent);
        }
        all
    }

    /// Adds a trunk of 5 to 7 m with nine boughs at 40 to 70 degrees, each of which bears three twigs.
    fn tree(&mut self, n: &mut Numbers, at: f64) {
        let length = n.between(5.0, 7.0);
        let radius = length * n.between(0.014, 0.018);
        let foot = [at, 0.0, 0.0];
        let trunk = self.axis(foot, UP, [length, radius], 0);
        for &cylinder in &trunk[..9] {
            let k = trunk.iter().position(|c| *c == cylinder).unwrap();
            let place = [at, 0.0, length * (k + 1) as f64 / 10.0];
            let way = away(UP, n.between(40.0, 70.0), n.between(0.0, 360.0));
            let long = length * n.between(0.15, 0.35);
            let thick = radius * (1.0 - 0.066 * k as f64) * n.between(0.3, 0.5);
            let bough = self.axis(place, way, [long, thick], cylinder);
            for j in [2, 5, 7] {
                let place = [0, 1, 2].map(|c| place[c] + way[c] * long * (j + 1) as f64 / 10.0);
                let twig = away(way, n.between(25.0, 55.0), n.between(0.0, 360.0));
                let size = [long * n.between(0.2, 0.5), thick * n.between(0.3, 0.5)];
                self.axis(place, twig, size, bough[j]);
            }
        }
    }
}

const HEAD: &str = "radius,start_x,start_y,start_z,end_x,end_y,end_z,parent,branch\n";

/// Writes a table of trees that stand 20 m apart.
pub(crate) fn trees(count: usize, seed: u64) -> String {
    let (mut table, mut numbers) = (Table::default(), Numbers::new(seed));
    (0..count).for_each(|k| table.tree(&mut numbers, 20.0 * k as f64));
    format!("{HEAD}{}", table.rows)
}

fn row<'a>(report: &'a Value, order: u64, name: &str) -> &'a Value {
    let rows = report["traits"].as_array().unwrap();
    rows.iter().find(|r| r["order"] == order && r["name"] == name).unwrap()
}

#[test]
fn trees_of_a_fitted_species_branch_as_those_that_were_kept_out() {
    let f = folder("species-fit");
    for k in 0..12 {
        fs::write(f.join(format!("t{k:02}.csv")), trees(1, 40 + k)).unwrap();
    }
    let files: Vec<String> = (0..12).map(|k| format!("t{k:02}.csv")).collect();
    let names: Vec<&str> = files.iter().map(String::as_str).collect();
    let rest = ["-o", "my-oak.toml", "--png", "my-oak.png", "--report", "r.json"];
    let out = burgeon(&f, &[&["species", "fit"], &names[..], &rest].concat());
    let said = String::from_utf8_lossy(&out.stderr).into_owned() + &String::from_utf8_lossy(&out.stdout);
    assert!(out.status.success(), "{said}");
    let report = json(&f.join("r.json"));
    assert_eq!((report["trees_fitted"].as_u64(), report["trees_kept_out"].as_u64()), (Some(8), Some(4)));
    assert_eq!(report["trees_grown"].as_u64(), Some(200));
    for (order, name, low, high) in [
        (0, "length", 5.0, 7.0),
        (1, "angle", 50.0, 60.0),
        (1, "length ratio", 0.22, 0.28),
        (1, "radius ratio", 0.3, 0.5),
        (2, "angle", 35.0, 45.0),
        (2, "length ratio", 0.3, 0.4),
    ] {
        let r = row(&report, order, name);
        let median = r["median"].as_f64().unwrap();
        assert!((low..high).contains(&median), "{r}");
        let [a, b] = [0, 1].map(|k| r["median_interval"][k].as_f64().unwrap());
        assert!(a <= median && median <= b, "{r}");
        // Seven tests are made at once: for trees that were not fitted, chance gives one below 0.007 in 20 runs.
        for (lot, least) in [("fitted", 0.05), ("kept_out", 0.007)] {
            assert!(r[lot]["p"].as_f64().unwrap() > least, "{lot}: {r}");
        }
    }
    // All axes of these trees taper alike: a single value has no distribution, but it is reproduced.
    let taper = row(&report, 1, "taper");
    let medians = [0, 1].map(|k| taper["fitted"]["medians"][k].as_f64().unwrap());
    assert!((medians[0] / medians[1] - 1.0).abs() < 0.01, "{taper}");
    // Boughs have their original distances: the rules continue from each to the next.
    let apart = row(&report, 0, "internode");
    let medians = &apart["fitted"]["medians"];
    assert!((medians[0].as_f64().unwrap() / medians[1].as_f64().unwrap() - 1.0).abs() < 0.1, "{apart}");
    assert!(said.contains("species-") || said.contains("neither is fitted"), "{said}");
    let png = fs::read(f.join("my-oak.png")).unwrap();
    assert!(png.starts_with(b"\x89PNG") && png.len() > 3000, "{}", png.len());
    // It is a species like others.
    good(&f, &["grow", "my-oak.toml", "-o", "oak.qsm.csv", "--seed", "3"]);
    good(&f, &["grow", "my-oak.toml", "-o", "oak.glb", "--no-textures", "--detail", "0.2"]);
    // The same again, on one thread.
    let again = ["-o", "again/my-oak.toml", "--threads", "1", "--report", "again.json"];
    fs::create_dir(f.join("again")).unwrap();
    good(&f, &[&["species", "fit"], &names[..], &again].concat());
    assert_eq!(fs::read(f.join("my-oak.toml")).unwrap(), fs::read(f.join("again/my-oak.toml")).unwrap());
    assert_eq!(json(&f.join("again.json"))["traits"], report["traits"]);
}

#[test]
fn trees_that_tell_too_little_are_refused_or_told() {
    let f = folder("species-few");
    let bare = format!("{HEAD}0.1,0,0,0,0,0,2,0,1\n0.08,0,0,2,0,0,4,1,1\n");
    fs::write(f.join("bare.csv"), bare).unwrap();
    fs::write(f.join("one.csv"), trees(3, 7)).unwrap();
    fs::write(f.join("leaf.svg"), tools::FLOWER).unwrap();
    fs::write(f.join("cm.csv"), format!("{HEAD}0.1,0,0,0,0,0,200,0,1\n0.08,0,0,200,0,0,400,1,1\n")).unwrap();
    for (args, want) in [
        (&["bare.csv", "-o", "x.toml"][..], "branches of the first order"),
        (&["cm.csv", "-o", "x.toml"], "--in-unit"),
        (&["leaf.svg", "-o", "x.toml"], "no structure of trees"),
        (&["one.csv", "-o", "x.json"], "name a file .toml"),
        (&["one.csv", "-o", "x.toml", "--keep-none-out"], "six trees or more"),
    ] {
        let said = bad(&f, &[&["species", "fit"], args].concat());
        assert!(said.contains(want), "{said}");
    }
    assert!(!f.join("x.toml").exists());
    let out = burgeon(&f, &["species", "fit", "one.csv", "-o", "x.toml", "--trees", "20"]);
    let said = String::from_utf8_lossy(&out.stderr);
    assert!(out.status.success() && said.contains("no tree was kept out"), "{said}");
}
