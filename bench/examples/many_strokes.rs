//! One more stroke on a drawing of thousands, on one thread: the time of each stage, and whether the plant equals one
//! made from scratch. `cargo run --release --package burgeon-bench --example many_strokes`

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a benchmark without its input is worth nothing"
)]

use base::turn::direction;
use burgeon::glam::DVec2;
use burgeon::ink::{Drawing, Stroke};
use burgeon::{CancelToken, Clock, Evaluator, ItemReport, Run, Seed, SketchOptions};
use burgeon_bench::{Stopwatch, table1};

fn main() {
    let sketch = table1("a");
    for (name, drawing) in
        [("blades, lines and rings", grid(4990)), ("sketch a, again and again", again(&sketch))]
    {
        println!("{name}: {} strokes", drawing.strokes.len());
        println!("              ms  preprocess  classify  structure  depth  mesh  triangles");
        let (mut evaluator, mut drawing) = (Evaluator::default(), drawing);
        step("at first", &mut evaluator, &drawing);
        for k in 0..3 {
            drawing.strokes.push(line(&drawing, 0.3 + 0.1 * f64::from(k)));
            let item = step("one more", &mut evaluator, &drawing);
            let mut fresh = Evaluator::default();
            let anew =
                fresh.update(&drawing, &SketchOptions::default(), Seed::new(1), &Run::plain()).unwrap();
            assert!(item.digest == anew.digest && item.strokes == anew.strokes, "read as from scratch");
            assert!(
                evaluator.model() == fresh.model() && evaluator.plant() == fresh.plant(),
                "as from scratch"
            );
        }
    }
}

fn step(what: &str, evaluator: &mut Evaluator, drawing: &Drawing) -> ItemReport {
    let (cancel, clock) = (CancelToken::new(), Stopwatch::start());
    let run = Run { cancel: &cancel, clock: &clock, ..Run::plain() };
    let start = clock.now_ms();
    let item = evaluator.update(drawing, &SketchOptions::default(), Seed::new(1), &run).unwrap();
    let total = clock.now_ms() - start;
    let t = item.timings_ms;
    println!(
        "{what}  {total:8.1} {:11.1} {:9.1} {:10.1} {:6.1} {:5.1} {:10}",
        t.preprocess, t.classify, t.structure, t.depth, t.mesh, item.counts.triangles
    );
    item
}

/// Makes a short line within the drawing.
fn line(drawing: &Drawing, across: f64) -> Stroke {
    let places = || drawing.strokes.iter().flat_map(|s| &s.samples).map(|s| s.at);
    let (low, high) =
        (places().fold(DVec2::INFINITY, DVec2::min), places().fold(DVec2::NEG_INFINITY, DVec2::max));
    let from = low + (high - low) * DVec2::new(across, 0.5);
    let step = 0.002 * (high - low).length();
    let points = (0..12).map(|i| from + step * f64::from(i) * DVec2::new(0.3, 1.0));
    Stroke { samples: points.map(Into::into).collect(), ..Stroke::default() }
}

/// Draws blades, lines and rings of many sizes, next to one another: as in the benchmark of the Studio.
fn grid(count: u32) -> Drawing {
    let mut seed = 1_u64;
    let mut random = || {
        seed = seed * 16807 % 2_147_483_647;
        #[expect(clippy::cast_precision_loss, reason = "31 bits")]
        let share = seed as f64 / 2_147_483_647.0;
        share
    };
    let lines: Vec<Vec<DVec2>> = (0..count)
        .map(|s| {
            let place = 20.0 * DVec2::new(f64::from(s % 100), f64::from(s / 100));
            let (size, turn) = (5.0 + 4.0 * random(), direction(6.3 * random()));
            let point = |t: f64| match s % 3 {
                0 => DVec2::new(t - 0.5, 0.05 * direction(6.0 * t).y),
                1 => direction(6.25 * t) * DVec2::new(0.5, 0.2),
                _ => 0.4 * direction(6.25 * t),
            };
            (0..40).map(|i| place + size * turn.rotate(point(f64::from(i) / 39.0))).collect()
        })
        .collect();
    Drawing::from_polylines("many", &lines)
}

/// Repeats a drawing next to itself until there are close to 5,000 strokes.
fn again(drawing: &Drawing) -> Drawing {
    let mut out = Drawing { name: "again".into(), ..Drawing::default() };
    let mut k = 0;
    while out.strokes.len() + drawing.strokes.len() <= 4990 {
        let by = 1200.0 * DVec2::new(f64::from(k % 25), -f64::from(k / 25));
        out.strokes.extend(drawing.strokes.iter().cloned().map(|mut s| {
            s.samples.iter_mut().for_each(|p| p.at += by);
            s
        }));
        k += 1;
    }
    out
}
