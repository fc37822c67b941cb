//! Plants of drawings that change: results taken over from the last update have the same bits as a fresh start.

use std::path::Path;
use std::sync::atomic::{AtomicU32, Ordering};

use burgeon::formats::{DrawingFormat, read_drawings};
use burgeon::glam::DVec2;
use burgeon::ink::Drawing;
use burgeon::{CancelToken, Clock, Evaluator, MakeError, Run, Seed, SketchOptions};

fn drawing(name: &str) -> Drawing {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../fixtures/sketches/{name}.svg"));
    let bytes = std::fs::read(path).expect("a fixture");
    let read = read_drawings(bytes.as_slice(), DrawingFormat::Svg, name).next();
    read.expect("one drawing").expect("a sound drawing").drawing
}

#[test]
fn a_drawing_that_changes_gives_what_a_fresh_start_gives() {
    for name in ["a", "d", "g"] {
        let whole = drawing(&format!("table1/{name}"));
        let mut kept = Evaluator::default();
        let mut options = SketchOptions::default();
        let mut check = |drawing: &Drawing, options: &SketchOptions, what: &str| {
            let (seed, run) = (Seed::new(1), Run::plain());
            kept.update(drawing, options, seed, &run).expect("a plant");
            let mut fresh = Evaluator::default();
            fresh.update(drawing, options, seed, &run).expect("a plant");
            assert!(kept.plant() == fresh.plant() && kept.model() == fresh.model(), "{name}: {what}");
        };
        check(&whole, &options, "whole");
        let mut fewer = whole.clone();
        fewer.strokes.pop();
        check(&fewer, &options, "without its last stroke");
        check(&whole, &options, "with it again");
        let mut moved = whole.clone();
        let middle = moved.strokes.len() / 2;
        moved.strokes[middle].samples.iter_mut().for_each(|s| s.at.x += 3.0);
        check(&moved, &options, "one stroke moved");
        moved.strokes.remove(middle);
        check(&moved, &options, "and taken away");
        options.skin.detail = 0.4;
        check(&moved, &options, "coarser");
    }
}

/// Cancels when a stage begins or ends, which is when the clock is read; counts how often that is.
struct StopAt<'a> {
    reads: AtomicU32,
    last: u32,
    cancel: &'a CancelToken,
}

impl Clock for StopAt<'_> {
    fn now_ms(&self) -> f64 {
        if self.reads.fetch_add(1, Ordering::Relaxed) == self.last {
            self.cancel.cancel();
        }
        0.0
    }
}

#[test]
fn a_stage_that_is_no_longer_wanted_is_the_last_and_spoils_nothing() {
    let (drawing, options, seed) = (drawing("gallery/tulip"), SketchOptions::default(), Seed::new(1));
    let mut fresh = Evaluator::default();
    fresh.update(&drawing, &options, seed, &Run::plain()).expect("a plant");
    let mut stopped = 0;
    for last in 0.. {
        let cancel = CancelToken::new();
        let clock = StopAt { reads: AtomicU32::new(0), last, cancel: &cancel };
        let run = Run { cancel: &cancel, clock: &clock, ..Run::plain() };
        let mut kept = Evaluator::default();
        let made = kept.update(&drawing, &options, seed, &run);
        let reads = clock.reads.into_inner();
        if reads <= last {
            break;
        }
        if made.is_err() {
            assert!(matches!(made, Err(MakeError::Cancelled(_))), "at {last}");
            // The stage ends, and the next one reads the clock before it stops.
            assert!(reads <= last + 3, "another stage went on: {reads} after {last}");
            stopped += 1;
        }
        kept.update(&drawing, &options, seed, &Run::plain()).expect("a plant");
        assert!(kept.plant() == fresh.plant() && kept.model() == fresh.model(), "at {last}");
    }
    assert!(stopped >= 10, "{stopped}");
}

#[test]
fn a_preview_of_a_crown_is_coarse_and_what_follows_is_whole() {
    let (options, seed, run) = (SketchOptions::default(), Seed::new(1), Run::plain());
    for name in ["bush", "oak", "tulip"] {
        let drawing = drawing(&format!("gallery/{name}"));
        let mut look = Evaluator::previewing();
        look.update(&drawing, &options, seed, &run).expect("a plant");
        let mut whole = Evaluator::default();
        whole.update(&drawing, &options, seed, &run).expect("a plant");
        // The plant is the same; only the view of a large one is coarser, and of the same size.
        assert_eq!(look.plant().map(|p| &p.organs), whole.plant().map(|p| &p.organs), "{name}");
        let [coarse, fine] = [&look, &whole].map(|e| e.model().expect("a model"));
        assert_eq!(coarse.validate().next(), None);
        let share = coarse.triangle_count() as f64 / fine.triangle_count() as f64;
        assert!(if name == "tulip" { share > 0.999 } else { share < 0.25 }, "{name}: {share}");
        let [small, large] = [coarse, fine].map(|m| m.bounds().max - m.bounds().min);
        assert!((small / large - 1.0).abs().max_element() < 0.15, "{name}: {small} of {large}");
    }
}

/// Returns a rotation, given the tangent of half its angle.
fn turned(half: f64) -> DVec2 {
    DVec2::new(1.0 - half * half, 2.0 * half) / (1.0 + half * half)
}

/// Draws blades, lines and rings of many sizes, next to one another.
fn many(count: u32) -> Drawing {
    let step = turned(0.0807); // 39 of them are one round
    let line = |s: u32| {
        let at = 20.0 * DVec2::new(f64::from(s % 30), f64::from(s / 30));
        let (turn, size) = (turned(0.3 * f64::from(s % 9)), 5.0 + f64::from(s % 5));
        let mut round = DVec2::X;
        let point = |i: u32| {
            round = step.rotate(round);
            let p = match s % 3 {
                0 => DVec2::new(f64::from(i) / 39.0 - 0.5, 0.05 * round.y),
                1 => DVec2::new(0.5, 0.2) * round,
                _ => 0.4 * round,
            };
            at + size * turn.rotate(p)
        };
        (0..40).map(point).collect()
    };
    Drawing::from_polylines("many", &(0..count).map(line).collect::<Vec<Vec<DVec2>>>())
}

#[test]
fn a_large_drawing_that_grows_gives_what_a_fresh_start_gives() {
    let mut drawing = many(700);
    let (mut kept, options, run) = (Evaluator::default(), SketchOptions::default(), Run::plain());
    let mut check = |drawing: &Drawing, what: &str| {
        let item = kept.update(drawing, &options, Seed::new(1), &run).expect("a plant");
        let mut fresh = Evaluator::default();
        let wanted = fresh.update(drawing, &options, Seed::new(1), &run).expect("a plant");
        assert_eq!(item, wanted, "{what}");
        assert!(kept.plant() == fresh.plant() && kept.model() == fresh.model(), "{what}");
    };
    check(&drawing, "whole");
    let stroke = |from: DVec2, to: DVec2| {
        let line: Vec<DVec2> = (0..=12).map(|i| from.lerp(to, f64::from(i) / 12.0)).collect();
        Drawing::from_polylines("", &[line]).strokes.remove(0)
    };
    let at = DVec2::new(301.0, 227.0);
    // The sixth is among the strokes that describe the whole.
    for (k, to) in [(3.0, 4.0), (90.0, 170.0), (-2.0, 7.0), (11.0, 0.5), (-40.0, 60.0), (5.0, 5.0)]
        .into_iter()
        .enumerate()
    {
        drawing.strokes.push(stroke(at, at + DVec2::from(to)));
        check(&drawing, &format!("stroke {k} more"));
    }
    drawing.strokes.push(stroke(at, at + DVec2::new(0.0, 900.0)));
    check(&drawing, "one that makes the drawing larger");
    drawing.strokes.remove(40);
    check(&drawing, "without an early one");
    drawing.strokes[80].samples.iter_mut().for_each(|s| s.at.x += 3.0);
    check(&drawing, "one moved");
}
