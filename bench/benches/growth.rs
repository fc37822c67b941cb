//! Trees: space colonisation to the end, self-organisation, a whole oak. `cargo bench --bench growth`
//!
//! The balls of attraction points with which other programs were timed (root (0, 0, 3), step 0.1, influence 2.0, kill
//! 0.3) come from files if there are any, and are scattered anew otherwise.

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a benchmark without its input is worth nothing"
)]

use std::path::PathBuf;
use std::time::Instant;

use base::{Clock as _, Report, Run, Seed};
use burgeon::glam::DVec3;
use burgeon_bench::{Oak, Stopwatch, TwoThreads};
use growth::{
    ColonizeSpec, Colonized, Envelope, Obstacles, PointFate, SelfOrganized, SelfOrganizingSpec, colonize,
    self_organize,
};

fn main() {
    scaling();
    metamers();
    oak_stages();
    divan::main();
}

/// Time on the processor where the system reports it (so that other programs hardly count), else by the clock.
struct Watch(Instant);

impl base::Clock for Watch {
    fn now_ms(&self) -> f64 {
        let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
        let ns = told.and_then(|t| t.split_whitespace().next()?.parse::<f64>().ok());
        ns.map_or_else(|| self.0.elapsed().as_secs_f64() * 1e3, |ns| ns / 1e6)
    }
}

/// Returns the mean time of several runs, milliseconds, and the result of the last one. Not the least: the system
/// counts time on the processor in ticks.
fn mean<T>(runs: usize, mut work: impl FnMut() -> T) -> (f64, T) {
    let watch = Watch(Instant::now());
    let started = watch.now_ms();
    let mut made = work();
    for _ in 1..runs {
        made = work();
    }
    ((watch.now_ms() - started) / runs.max(1) as f64, made)
}

/// Returns the largest memory of this process so far, MiB; 0 where the system does not report it.
fn peak_mib() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"));
    line.and_then(|l| l.split_whitespace().next()?.parse::<u64>().ok()).unwrap_or(0) / 1024
}

/// Reads the file of that many points, or scatters as many in the same ball.
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

/// Prints time against number of points, and the exponent fitted to it. Other parameters shrink with the spacing.
fn scaling() {
    println!(" points       ms   joints  rounds unreached  peak MiB");
    let mut logs = Vec::new();
    for n in [3_000, 10_000, 30_000, 100_000, 300_000, 1_000_000] {
        let points = ball(n);
        let runs = (3_000_000 / (n * 10)).clamp(1, 50);
        let (ms, grown) = mean(runs, || grow(&points));
        let lost = grown.fates.iter().filter(|f| **f == PointFate::Unreached).count();
        let (joints, rounds, peak) = (grown.skeleton.len(), grown.rounds, peak_mib());
        println!("{n:7} {ms:8.2} {joints:8} {rounds:7} {lost:9} {peak:9}");
        logs.push((base::ops::ln(n as f64), base::ops::ln(ms)));
    }
    let k = logs.len() as f64;
    let (mx, my) = (logs.iter().map(|l| l.0).sum::<f64>() / k, logs.iter().map(|l| l.1).sum::<f64>() / k);
    let over: f64 = logs.iter().map(|l| (l.0 - mx) * (l.1 - my)).sum();
    let under: f64 = logs.iter().map(|l| (l.0 - mx) * (l.0 - mx)).sum();
    println!("time grows as points^{:.2}", over / under);
}

/// Self-organisation without end: most metamers are shed again.
fn self_organizing(years: u32) -> SelfOrganized {
    let spec = SelfOrganizingSpec { years, ..SelfOrganizingSpec::default() };
    let none = Obstacles::none();
    self_organize(&[DVec3::ZERO], &none, &spec, Seed::new(1), &Run::plain(), &mut Report::default()).unwrap()
}

/// Measures metamers. Target: 1.5 million generated a second on one core.
fn metamers() {
    println!("\nyears        ms  generated     shed     kept  generated/s");
    for years in [20, 40, 60] {
        let (ms, tree) = mean(3, || self_organizing(years));
        let (n, kept) = (tree.generated, tree.skeleton.len());
        println!("{years:5} {ms:9.1} {n:10} {:8} {kept:8} {:12.0}", tree.shed, n as f64 / ms * 1e3);
    }
}

fn oak_stages() {
    let clock = Stopwatch::start();
    let one = Run { clock: &clock, ..Run::plain() };
    let two = Run { executor: &TwoThreads, ..one };
    let (tree, model, _) = Oak::FULL.made(&one);
    println!(
        "\noak: {} triangles, {} leaves, {} axes, {} nodes (medians of 25, on one thread and on two)",
        model.triangle_count(),
        tree.leaves.kept,
        tree.plant.axes.len(),
        tree.plant.nodes.position.len()
    );
    let runs = [one, two].map(|run| (0..25).map(|_| Oak::FULL.made(&run).2).collect::<Vec<_>>());
    for name in ["grow", "wood", "leaves", "mesh"] {
        let [one, two] = runs.each_ref().map(|reports| {
            let of = |r: &Report| r.stages.iter().filter(|s| s.name == name).map(|s| s.ms).sum::<f64>();
            let mut ms: Vec<f64> = reports.iter().map(of).collect();
            ms.sort_by(f64::total_cmp);
            ms[ms.len() / 2]
        });
        println!("  {name:7} {one:7.2} ms {two:7.2} ms");
    }
    println!();
}

/// Times an oak. Target: 30 ms from spec to meshes.
#[divan::bench(args = [1, 2])]
fn oak_to_meshes(threads: usize) -> usize {
    let one = Run::plain();
    let run = if threads == 2 { Run { executor: &TwoThreads, ..one } } else { one };
    Oak::FULL.made(&run).1.triangle_count()
}

/// Times a ball of points. Targets: 4 ms and 60 ms.
#[divan::bench(args = [3_000, 30_000])]
fn ball_to_the_end(bencher: divan::Bencher<'_, '_>, n: usize) {
    let points = ball(n);
    bencher.bench(|| grow(&points));
}
