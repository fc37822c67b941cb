//! Scans of single leaves, made by other people and by us, whole and thinned out.

#![expect(clippy::expect_used, reason = "tests")]

use crate::missing;
use std::fs;
use std::path::Path;

use base::{Draw, Report, Run, Seed};
use glam::DVec3;
use leaf::{ScanLeaf, ScanSpec, fit_scan};

fn read(path: &Path) -> Vec<DVec3> {
    let text = fs::read_to_string(path).unwrap_or_default();
    let point = |line: &str| {
        let mut words = line.split([',', ' ']).map(|w| w.parse::<f64>().unwrap_or(f64::NAN));
        let mut next = || 0.001 * words.next().unwrap_or(f64::NAN);
        let (x, y, z) = (next(), next(), next());
        // Millimetres, +Z up.
        DVec3::new(x, z, -y)
    };
    text.lines().map(point).collect()
}

fn area(leaf: &ScanLeaf) -> f64 {
    let n = leaf.columns;
    let cells = (0..leaf.grid.len() / n - 1).flat_map(|i| (0..n - 1).map(move |j| i * n + j));
    let at = |k: usize| leaf.grid[k];
    cells.map(|k| 0.5 * (at(k + n + 1) - at(k)).cross(at(k + n) - at(k + 1)).length()).sum()
}

#[test]
fn half_and_a_quarter_of_the_points_are_the_same_leaf() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/scans/single_leaves");
    let Ok(files) = fs::read_dir(&folder) else {
        return missing::skipped(folder.display());
    };
    let mut files: Vec<_> = files.filter_map(|f| Some(f.ok()?.path())).collect();
    files.retain(|f| f.extension().is_some_and(|e| e == "txt"));
    files.sort();
    for file in files {
        thinned(&file);
    }
}

#[test]
fn half_and_a_quarter_of_our_own_scan_are_the_same_leaf() {
    thinned(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/scans/leaf.txt"));
}

/// Makes a leaf from all points, and from a part of them.
#[expect(clippy::print_stdout, reason = "figures for whoever looks for them")]
fn thinned(file: &Path) {
    let all = read(file);
    let fit = |points: &[DVec3]| {
        fit_scan(points, &ScanSpec::default(), &Run::plain(), &mut Report::default()).expect("a leaf")
    };
    let whole = fit(&all);
    let (length, wide) = (geom::polyline_length3(&whole.midrib()), area(&whole));
    println!("{}: {:.1} mm, {:.0} mm2", file.display(), 1e3 * length, 1e6 * wide);
    for (step, may) in [(2, 0.06), (4, 0.12)] {
        let mut stream = Seed::new(step).stream(Draw::Test);
        let some: Vec<DVec3> =
            all.iter().copied().filter(|_| stream.uniform() * (step as f64) < 1.0).collect();
        let part = fit(&some);
        let off = [geom::polyline_length3(&part.midrib()) / length - 1.0, area(&part) / wide - 1.0];
        println!("  1/{step}: {} points, {:+.3} {:+.3}", some.len(), off[0], off[1]);
        assert!(off.iter().all(|o| o.abs() < may), "{} 1/{step}: {off:?}", file.display());
        assert_eq!(part.stalk.is_some(), whole.stalk.is_some(), "{} 1/{step}", file.display());
    }
}
