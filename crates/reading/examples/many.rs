//! How long it takes to read drawings of 5,000 strokes, and again with one stroke more, natively, on one thread.
//!
//! `cargo run --release -p burgeon-reading --example many`
//!
//! The drawings are those of `cargo xtask bench-web`: blades, lines and rings of many sizes side by side, and sketch a of the
//! gallery again and again.

#![expect(clippy::print_stdout, reason = "the figures are what it is for")]

use std::time::Instant;

use base::{Draw, Report, Run, Seed, ops};
use formats::DrawingFormat;
use glam::DVec2;
use ink::Drawing;
use reading::{KeptStrokes, Reading};

const STROKES: usize = 4990;
const RUNS: usize = 5;

fn main() {
    for (name, drawing) in [("made", made()), ("sketch a", again())] {
        let before =
            Drawing { strokes: drawing.strokes[..drawing.strokes.len() - 1].to_vec(), ..drawing.clone() };
        let [(old, old_classes), (ink, mut classes)] = [&before, &drawing].map(|drawing| {
            let ink = ink::clean(drawing, &mut Report::default());
            let classes = ink::classify(&ink, &Run::plain());
            (ink, classes)
        });
        // What the strokes were shown as before the last one was drawn.
        let mut kept = KeptStrokes::default();
        let was = reading::read_again(None, &[], (&old, &old_classes), &mut kept, &mut Report::default());
        for (class, was) in classes.iter_mut().zip(&was.strokes).filter(|(c, _)| c.confidence >= 0.3) {
            class.shown = Some(was.class);
        }
        let read = |kept: &KeptStrokes| {
            let mut runs: Vec<(f64, Reading)> = (0..RUNS)
                .map(|_| {
                    let mut kept = kept.clone();
                    let start = Instant::now();
                    let reading =
                        reading::read_again(None, &[], (&ink, &classes), &mut kept, &mut Report::default());
                    (1e3 * start.elapsed().as_secs_f64(), reading)
                })
                .collect();
            runs.sort_by(|a, b| a.0.total_cmp(&b.0));
            runs.swap_remove(RUNS / 2)
        };
        let ((all, afresh), (one, again)) = (read(&KeptStrokes::default()), read(&kept));
        assert_eq!(afresh, again, "what is kept changes nothing");
        println!(
            "{name}: {} strokes, {} axes, {} leaves, {} flowers; all read in {all:.1} ms, one more in {one:.1} ms; {:016x}",
            ink.strokes.len(),
            again.axes.len(),
            again.leaves.len(),
            again.flowers.len(),
            digest(&again)
        );
    }
}

fn digest(reading: &Reading) -> u64 {
    let text = format!("{reading:?}");
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |h, b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3))
}

fn made() -> Drawing {
    let r = &mut Seed::new(1).stream(Draw::Template);
    let mut line = |s: usize| {
        let at = DVec2::new(20.0 * (s % 100) as f64, 20.0 * (s / 100) as f64);
        let (size, turn) = (5.0 + 4.0 * r.uniform(), base::turn::direction(ops::TAU * r.uniform()));
        (0..40)
            .map(|i| {
                let t = f64::from(i) / 39.0;
                let (sin, cos) = ops::sin_cos(ops::TAU * t);
                let p = match s % 3 {
                    0 => DVec2::new(t - 0.5, 0.05 * ops::sin(6.0 * t)),
                    1 => DVec2::new(0.5 * cos, 0.2 * sin),
                    _ => DVec2::new(0.4 * cos, 0.4 * sin),
                };
                at + size * turn.rotate(p)
            })
            .collect()
    };
    Drawing::from_polylines("made", &(0..STROKES).map(&mut line).collect::<Vec<Vec<DVec2>>>())
}

fn again() -> Drawing {
    let svg = include_bytes!("../../../fixtures/sketches/table1/a.svg");
    let lines: Vec<Vec<DVec2>> = formats::read_drawings(svg.as_slice(), DrawingFormat::Svg, "a")
        .flat_map(|item| item.expect("it is one of ours").drawing.strokes)
        .map(|s| s.samples.iter().map(|p| p.at).collect())
        .collect();
    let copies = (0..STROKES / lines.len()).flat_map(|k| {
        let by = 1200.0 * DVec2::new((k % 25) as f64, -((k / 25) as f64));
        lines.iter().map(move |l| l.iter().map(|p| *p + by).collect()).collect::<Vec<Vec<DVec2>>>()
    });
    Drawing::from_polylines("again", &copies.collect::<Vec<_>>())
}
