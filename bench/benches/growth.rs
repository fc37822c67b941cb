//! Space colonisation to the end. `cargo bench --bench growth`
//!
//! The balls of attraction points that other programs were timed on (root (0, 0, 3), step 0.1, influence 2.0, kill
//! 0.3) come from files where there are any, and are scattered anew where there are none.

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a benchmark without its input is worth nothing"
)]

use std::path::PathBuf;
use std::time::Instant;

use base::{Report, Run, Seed};
use burgeon::glam::DVec3;
use growth::{ColonizeSpec, Colonized, Envelope, Fate, Obstacles, colonize};

fn main() {
    scaling();
    divan::main();
}

/// The file of that many points, or as many scattered in the same ball.
fn ball(n: usize) -> Vec<DVec3> {
    let path =
        PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("../../shared/data/attractors/ball_{n}.xyz"));
    let centre = DVec3::new(0.0, 0.0, 8.0);
    match std::fs::read_to_string(path) {
        Ok(text) => text
            .lines()
            .map(|l| {
                let c: Vec<f64> = l.split_whitespace().map(|w| w.parse().unwrap()).collect();
                DVec3::new(c[0], c[1], c[2])
            })
            .collect(),
        Err(_) => {
            let region = Envelope::Sphere { centre, radius_m: 5.0 }.prepare().unwrap();
            region.scatter(n, 0.0, Seed::new(1), |_| true).unwrap()
        }
    }
}

fn grow(points: &[DVec3]) -> Colonized {
    let spec = ColonizeSpec { attraction_m: 2.0, kill_m: 0.3, step_m: Some(0.1), ..ColonizeSpec::default() };
    let root = DVec3::new(0.0, 0.0, 3.0);
    colonize(&[root], points, &Obstacles::none(), &spec, &Run::plain(), &mut Report::default()).unwrap()
}

/// Time against number of points, and the exponent fitted to it. Other parameters shrink with the spacing.
fn scaling() {
    println!("points      ms   joints  rounds  unreached");
    let mut logs = Vec::new();
    for n in [3_000, 10_000, 30_000, 100_000, 300_000, 1_000_000] {
        let points = ball(n);
        let runs = (5_000_000 / (n * 10)).clamp(1, 20);
        let mut best = f64::INFINITY;
        let mut grown = None;
        for _ in 0..runs {
            let started = Instant::now();
            grown = Some(grow(&points));
            best = best.min(started.elapsed().as_secs_f64() * 1e3);
        }
        let grown = grown.unwrap();
        let lost = grown.fates.iter().filter(|f| **f == Fate::Unreached).count();
        println!("{n:7} {best:8.2} {:8} {:7} {lost:8}", grown.skeleton.len(), grown.rounds);
        logs.push((base::ops::ln(n as f64), base::ops::ln(best)));
    }
    let k = logs.len() as f64;
    let (mx, my) = (logs.iter().map(|l| l.0).sum::<f64>() / k, logs.iter().map(|l| l.1).sum::<f64>() / k);
    let over: f64 = logs.iter().map(|l| (l.0 - mx) * (l.1 - my)).sum();
    let under: f64 = logs.iter().map(|l| (l.0 - mx) * (l.0 - mx)).sum();
    println!("time grows as points^{:.2}", over / under);
}

/// Targets: 4 ms and 60 ms.
#[divan::bench(args = [3_000, 30_000])]
fn ball_to_the_end(bencher: divan::Bencher<'_, '_>, n: usize) {
    let points = ball(n);
    bencher.bench(|| grow(&points));
}
