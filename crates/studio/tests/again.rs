//! Plants of drawings that change: what is taken over from the last time gives the same bits as a fresh start.

use std::path::Path;

use burgeon::formats::{DrawingFormat, read_drawings};
use burgeon::ink::Drawing;
use burgeon::{Evaluator, Run, Seed, SketchOptions};

fn drawing(name: &str) -> Drawing {
    let path =
        Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../fixtures/sketches/table1/{name}.svg"));
    let bytes = std::fs::read(path).expect("a fixture");
    let read = read_drawings(bytes.as_slice(), DrawingFormat::Svg, name).next();
    read.expect("one drawing").expect("a sound drawing").drawing
}

#[test]
fn a_drawing_that_changes_gives_what_a_fresh_start_gives() {
    for name in ["a", "d", "g"] {
        let whole = drawing(name);
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
