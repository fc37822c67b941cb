//! Leaves of scans of 1,000 to 5 million points, from points in memory to the leaf: prints a table. The cloud is a bent
//! and folded blade with a stalk, noise of 0.2 mm and 1 % outliers; the same blade at every size.
//!
//! `cargo run --release -p burgeon-bench --example leaf_scan`

#![expect(clippy::print_stdout, reason = "its output is what it is for")]
#![expect(clippy::expect_used, reason = "a benchmark without its input is worth nothing")]

use base::{Draw, Run, Seed, ops};
use burgeon::Clock as _;
use burgeon::glam::DVec3;
use burgeon::leaf::ScanSpec;
use burgeon::make_leaf_from_scan;
use burgeon::mesh::PointCloud;
use burgeon_bench::{Stopwatch, TwoThreads};

/// Makes a blade of 60 mm x 36 mm with a stalk of 40 mm: 93 of 100 points on the blade, 6 on the stalk, 1 anywhere.
fn cloud(count: usize) -> Vec<DVec3> {
    let mut s = Seed::new(11).stream(Draw::Test);
    let mut out = Vec::with_capacity(count);
    while out.len() < count {
        match out.len() % 100 {
            0 => out.push(DVec3::new(s.range(-0.3, 0.3), s.range(-0.3, 0.3), s.range(-0.3, 0.3))),
            1..7 => {
                let (t, a) = (s.range(0.0, 0.04), s.range(0.0, ops::PI));
                out.push(DVec3::new(0.001 * ops::cos(a), 0.3 * t + 0.001 * ops::sin(a), t));
            }
            _ => {
                let (x, y) = (s.range(-0.018, 0.018), s.range(0.0, 0.06));
                if x.abs() < 0.018 * ops::sin(ops::PI * (y / 0.06)) {
                    let up = 0.25 * x.abs() - 6.0 * (y - 0.01) * (y - 0.01) + 0.0002 * s.normal();
                    out.push(DVec3::new(x, up, -y));
                }
            }
        }
    }
    out
}

fn main() {
    let watch = Stopwatch::start();
    let run = Run { executor: &TwoThreads, ..Run::plain() };
    println!("| points | seconds | length, mm | RMS, mm | explained | outliers |\n|---|---|---|---|---|---|");
    for count in [1_000, 10_000, 100_000, 1_000_000, 5_000_000] {
        let cloud = PointCloud { points: cloud(count), ..PointCloud::default() };
        let from = watch.now_ms();
        let (made, _) =
            make_leaf_from_scan("leaf", &cloud, &ScanSpec::default(), &run).expect("the cloud is a leaf");
        let seconds = 1e-3 * (watch.now_ms() - from);
        let leaf = made.item.leaf.expect("a leaf");
        let fit = leaf.fit_error;
        println!(
            "| {count} | {seconds:.2} | {:.1} | {:.3} | {:.3} | {} |",
            leaf.length_mm,
            fit.rms_mm,
            fit.explained,
            leaf.scan.map_or(0, |s| s.outliers)
        );
    }
}
