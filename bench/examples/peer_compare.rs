//! Distances between two clouds both ways, timed for `bench/peers_bloom.py`: prints a line of JSON. Arguments: two
//! files of points as little-endian doubles x y z.

#![expect(clippy::print_stdout, reason = "its output is what it is for")]
#![expect(clippy::expect_used, reason = "a benchmark without its input is worth nothing")]

use base::Run;
use burgeon::Clock as _;
use burgeon::bloom::compare;
use burgeon::glam::DVec3;
use burgeon_bench::{Stopwatch, TwoThreads};

fn points(path: &str) -> Vec<DVec3> {
    let bytes = std::fs::read(path).expect("a file of points");
    let numbers: Vec<f64> = bytes.as_chunks::<8>().0.iter().map(|b| f64::from_le_bytes(*b)).collect();
    numbers.as_chunks::<3>().0.iter().map(|p| DVec3::from_array(*p)).collect()
}

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [a, b] = [0, 1].map(|k| points(args.get(k).expect("two files of points")));
    let watch = Stopwatch::start();
    let timed = |run: &Run<'_>| {
        let least = (0..3).map(|_| {
            let from = watch.now_ms();
            let found = compare(&a, &b, run).expect("points");
            (watch.now_ms() - from, found)
        });
        least.min_by(|x, y| x.0.total_cmp(&y.0)).expect("three runs")
    };
    let (one, found) = timed(&Run::plain());
    let (two, _) = timed(&Run { executor: &TwoThreads, ..Run::plain() });
    println!(
        "{{\"one_thread_ms\":{one:.2},\"two_threads_ms\":{two:.2},\"mean\":{:e},\"back_mean\":{:e}}}",
        found.to_model.mean, found.to_scan.mean
    );
}
