//! Strokes in memory to meshes in memory, on two threads. `cargo bench --bench sketch`

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a benchmark without its input is worth nothing"
)]

use burgeon::glam::DVec2;
use burgeon::ink::Drawing;
use burgeon::{Budget, CancelToken, Evaluator, Made, Run, Seed, SketchOptions, make_from_sketch};
use burgeon_bench::{Pile, Stopwatch, TABLE1, TwoThreads, table1};

fn main() {
    stage_shares();
    divan::main();
}

fn make(drawing: &Drawing) -> Made {
    let (cancel, clock) = (CancelToken::new(), Stopwatch::start());
    let budget = Budget { times: 10.0, ..Budget::default() };
    let run = Run { cancel: &cancel, executor: &TwoThreads, clock: &clock, budget };
    make_from_sketch(drawing, &SketchOptions::default(), Seed::new(1), &run).unwrap()
}

/// Prints the median run of 25 of each drawing, by stage.
fn stage_shares() {
    println!("sketch     ms   preprocess classify structure depth  mesh   triangles");
    for name in TABLE1 {
        let drawing = table1(name);
        let mut runs: Vec<Made> = (0..25).map(|_| make(&drawing)).collect();
        runs.sort_by(|a, b| a.item.timings_ms.total.total_cmp(&b.item.timings_ms.total));
        let made = &runs[runs.len() / 2];
        let t = made.item.timings_ms;
        let share = |ms: f64| 100.0 * ms / t.total;
        println!(
            "{name:6} {:6.2} {:11.0} % {:6.0} % {:7.0} % {:3.0} % {:3.0} % {:10}",
            t.total,
            share(t.preprocess),
            share(t.classify),
            share(t.structure),
            share(t.depth),
            share(t.mesh),
            made.item.counts.triangles
        );
    }
}

/// The paper needed 145 to 1711 ms.
#[divan::bench(args = TABLE1)]
fn table1_sketch(bencher: divan::Bencher<'_, '_>, name: &str) {
    let drawing = table1(name);
    bencher.bench(|| make(&drawing));
}

/// One more stroke on an existing drawing: from each of its points to meshes, on one thread as in a browser.
#[divan::bench(args = TABLE1)]
fn under_the_pen(bencher: divan::Bencher<'_, '_>, name: &str) {
    let (drawing, options) = (table1(name), SketchOptions::default());
    let (seed, run) = (Seed::new(1), Run::plain());
    let mut whole = Evaluator::default();
    whole.update(&drawing, &options, seed, &run).unwrap();
    let mut pen = Evaluator::previewing();
    assert!(pen.follow(&whole, &drawing), "what is known of the drawing helps");
    let points = || drawing.strokes.iter().flat_map(|s| &s.samples).map(|s| s.at);
    let (lo, hi) =
        points().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), p| (lo.min(p), hi.max(p)));
    let (middle, unit) = (lo.midpoint(hi), lo.distance(hi) / 1000.0);
    let line: Vec<DVec2> = (0..=30)
        .map(|i| {
            middle
                + DVec2::new(
                    2.0 * f64::from(i),
                    3.0 * f64::from(i) - 8.0 * base::ops::sin(f64::from(i) / 4.0),
                ) * unit
        })
        .collect();
    let mut end = 1;
    bencher.bench_local(|| {
        end = end % 30 + 2;
        let mut now = drawing.clone();
        now.strokes.extend(Drawing::from_polylines("", &[line[..end.min(31)].to_vec()]).strokes);
        pen.update(&now, &options, seed, &run).unwrap()
    });
}

/// Every leaf is a stroke of its own: the time must grow linearly.
#[divan::bench(args = [1_000, 10_000, 100_000], sample_count = 3, sample_size = 1)]
fn drawn_leaves(bencher: divan::Bencher<'_, '_>, leaves: u32) {
    let drawing = leafy(leaves);
    bencher.bench(|| make(&drawing));
}

/// Strokes that lie on one another: the time must grow linearly here, too.
#[divan::bench(args = Pile::ALL, consts = [1_000, 10_000, 100_000], sample_count = 3, sample_size = 1)]
fn overlapping_ink<const STROKES: u32>(bencher: divan::Bencher<'_, '_>, pile: Pile) {
    let drawing = pile.drawing(STROKES);
    bencher.bench(|| make(&drawing));
}

/// Draws branches one above the other, each with a hundred leaves above and below.
fn leafy(leaves: u32) -> Drawing {
    let rows = leaves.div_ceil(100);
    let mut lines = vec![vec![DVec2::ZERO, DVec2::new(0.0, f64::from(rows) * 4.0)]];
    for row in 0..rows {
        let y = f64::from(row) * 4.0 + 2.0;
        lines.push(vec![DVec2::new(0.0, y), DVec2::new(104.0, y)]);
        for k in 0..100.min(leaves - row * 100) {
            let root = DVec2::new(2.0 + f64::from(k), y);
            let up = if k % 2 == 0 { 1.0 } else { -1.0 };
            let outline =
                [(0.0, 0.0), (0.35, 0.4), (0.4, 0.9), (0.0, 1.6), (-0.4, 0.9), (-0.35, 0.4), (-0.02, 0.02)];
            lines.push(outline.map(|(x, y)| root + DVec2::new(x, y * up)).to_vec());
        }
    }
    Drawing::from_polylines("leaves", &lines)
}
