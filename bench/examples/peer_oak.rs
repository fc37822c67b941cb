//! One oak, from its spec to meshes, timed for `bench/peers`: prints a line of JSON. Arguments: `full` or `small`, and
//! how many threads, 1 or 2.

#![expect(clippy::print_stdout, reason = "its output is what it is for")]

use base::Run;
use burgeon::Clock as _;
use burgeon_bench::{Oak, Stopwatch, TwoThreads};

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let oak = if args.iter().any(|a| a == "small") { Oak::SMALL } else { Oak::FULL };
    let plain = Run::plain();
    let run = if args.iter().any(|a| a == "2") { Run { executor: &TwoThreads, ..plain } } else { plain };
    let watch = Stopwatch::start();
    let mut times: Vec<f64> = (0..25)
        .map(|_| {
            let from = watch.now_ms();
            oak.made(&run);
            watch.now_ms() - from
        })
        .collect();
    times.sort_by(f64::total_cmp);
    let (tree, model, _) = oak.made(&run);
    let leaves = model.parts.iter().filter(|p| p.name.starts_with("lea"));
    println!(
        "{{\"best_ms\":{:.2},\"median_ms\":{:.2},\"vertices\":{},\"triangles\":{},\"leaf_triangles\":{},\"leaves\":{},\"axes\":{}}}",
        times[0],
        times[times.len() / 2],
        model.vertex_count(),
        model.triangle_count(),
        leaves.map(|p| p.mesh.triangles.len()).sum::<usize>(),
        tree.leaves.kept,
        tree.plant.axes.len(),
    );
}
