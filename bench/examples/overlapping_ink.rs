//! Drawings of many strokes that lie on one another, on one thread: the time of each stage, and its growth. `cargo run
//! --release --package burgeon-bench --example overlapping_ink [DRAWING ...] [STROKES ...]`

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a benchmark without its input is worth nothing"
)]

use base::ops;
use burgeon::{Budget, CancelToken, Clock, Run, Seed, SketchOptions, make_from_sketch};
use burgeon_bench::{Pile, Stopwatch};

fn main() {
    let (mut counts, mut piles) = (Vec::new(), Vec::new());
    for arg in std::env::args().skip(1) {
        match Pile::ALL.into_iter().find(|pile| pile.name() == arg) {
            Some(pile) => piles.push(pile),
            None => counts.push(arg.parse::<u32>().unwrap()),
        }
    }
    if counts.is_empty() {
        counts = vec![1_000, 10_000, 100_000];
    }
    if piles.is_empty() {
        piles = Pile::ALL.to_vec();
    }
    println!("seconds    strokes   whole  preprocess classify structure   depth fidelity    mesh  exponent");
    for pile in piles {
        let mut before: Option<(u32, f64)> = None;
        for &count in &counts {
            let drawing = pile.drawing(count);
            let (cancel, clock) = (CancelToken::new(), Stopwatch::start());
            let budget = Budget { times: 1000.0, ..Budget::default() };
            let run = Run { cancel: &cancel, clock: &clock, budget, ..Run::plain() };
            let made = make_from_sketch(&drawing, &SketchOptions::default(), Seed::new(1), &run).unwrap();
            let whole = clock.now_ms() / 1e3;
            let t = made.item.timings_ms;
            let [preprocess, classify, structure, depth, fidelity, mesh] =
                [t.preprocess, t.classify, t.structure, t.depth, t.fidelity, t.mesh].map(|ms| ms / 1e3);
            let exponent = before.map_or(String::new(), |(fewer, less)| {
                let times = f64::from(count) / f64::from(fewer);
                format!("{:.2}", ops::ln(whole / less) / ops::ln(times))
            });
            println!(
                "{:9} {count:8} {whole:7.2} {preprocess:11.2} {classify:8.2} {structure:9.2} {depth:7.2} {fidelity:8.2} \
                 {mesh:7.2} {exponent:>9}",
                pile.name()
            );
            before = Some((count, whole));
        }
    }
}
