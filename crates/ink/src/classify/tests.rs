//! The committed models, figures and odd ink.

use base::{Draw, Report, Run, Seed, ops};
use glam::DVec2;
use proptest::prelude::*;

use super::*;
use crate::{Drawing, InkStroke, clean};

fn committed() -> StrokeModelTexts {
    StrokeModelTexts {
        scale: include_str!("../../data/strokes.scale").to_owned(),
        classes: include_str!("../../data/strokes.model").to_owned(),
    }
}

fn table() -> Vec<StrokeRow> {
    read_stroke_table(include_str!("../../data/strokes.csv")).expect("the committed table can be read")
}

#[test]
fn committed_models_are_what_the_table_trains() {
    let (rows, kept) = (table(), committed());
    let fresh = train_strokes(&rows).expect("the table trains");
    let kept = StrokeModels::parse(&kept).expect("the committed models can be read");
    let fresh = StrokeModels::parse(&fresh).expect("the trained models can be read");
    // The texts are not compared: training calls std's exp, whose last digit differs between platforms.
    for row in &rows {
        let (a, b) = (kept.decide(&row.features), fresh.decide(&row.features));
        let same = a.class == b.class && (a.confidence - b.confidence).abs() < 1e-3;
        assert!(same, "run `cargo xtask train-strokes`: {} {} {a:?} {b:?}", row.drawing, row.stroke);
    }
}

#[test]
fn the_packed_machine_is_that_of_the_text() {
    let packed: &[u8] = include_bytes!("../../data/strokes.packed");
    let columns = StrokeFeatures::NAMES.len();
    assert!(
        committed().packed_classes().is_ok_and(|bytes| bytes == packed),
        "run `cargo xtask train-strokes`: strokes.packed is not strokes.model"
    );
    let machine = packed::unpack(packed, columns).expect("the packed machine can be read");
    // Packed again, because -0 equals 0 but is another bit.
    assert_eq!(training::pack(&machine, columns).as_deref(), Ok(packed));
    let read = StrokeModels::parse(&committed()).expect("the committed models can be read");
    assert_eq!(StrokeModels::unpack(&committed().scale, packed), Ok(read), "lengths and squares too");
    let short = (0..packed.len()).step_by(97).chain(packed.len() - 9..packed.len());
    assert!(short.clone().all(|n| packed::unpack(&packed[..n], columns).is_err()), "cut off anywhere");
    assert!(packed::unpack(packed, columns - 1).is_err(), "of other features");
    let mut huge = packed.to_vec();
    huge[4..8].fill(0xff);
    assert!(packed::unpack(&huge, columns).is_err(), "hostile counts");
}

#[test]
fn table_round_trips() {
    let rows = table();
    assert_eq!(write_stroke_table(&rows), include_str!("../../data/strokes.csv"), "written as it was read");
}

#[test]
fn held_out_drawings_are_recognised() {
    let rows = table();
    let mut macro_f1 = 0.0;
    for seed in 0..3 {
        let figures = cross_validate_strokes(&rows, Seed::new(seed)).expect("the table trains");
        assert!(figures.three_features >= 0.99, "the three features alone: {}", figures.three_features);
        assert!(figures.not_swapped >= 0.99, "closed or line: {}", figures.not_swapped);
        macro_f1 += figures.macro_f1 / 3.0;
    }
    assert!(macro_f1 >= 0.80, "macro F1 {macro_f1}");
}

#[test]
fn features_do_not_depend_on_direction_nor_on_left_and_right() {
    let mut stream = Seed::new(3).stream(Draw::Test);
    let lines: Vec<Vec<DVec2>> = (0..12)
        .map(|_| {
            let mut p = DVec2::new(stream.uniform(), stream.uniform());
            (0..20)
                .map(|_| {
                    p += DVec2::new(stream.range(-0.1, 0.1), stream.range(-0.1, 0.1));
                    p
                })
                .collect()
        })
        .collect();
    let rows_of = |lines: &[Vec<DVec2>]| {
        features(&clean(&Drawing::from_polylines("x", lines), &mut Report::default()), &Run::plain())
    };
    let plain = rows_of(&lines);
    let turned: Vec<Vec<DVec2>> = lines
        .iter()
        .map(|l| l.iter().rev().map(|p| DVec2::new(-p.x, p.y) * 250.0 + DVec2::new(7.0, -3.0)).collect())
        .collect();
    for (i, (a, b)) in plain.iter().zip(rows_of(&turned)).enumerate() {
        for ((name, x), y) in StrokeFeatures::NAMES.iter().zip(a.values()).zip(b.values()) {
            // Counts may flip where a corner or an end lies just at its threshold; sizes and shares may not.
            let smooth =
                ["gap", "slim", "box_area", "round", "solid", "hull", "length", "bottom", "width", "order"];
            if smooth.contains(name) {
                assert!((x - y).abs() < 0.02, "stroke {i}, {name}: {x} and {y}");
            }
        }
    }
}

#[test]
fn odd_ink_is_survived() {
    let stroke = |points: Vec<DVec2>| InkStroke { points, ..InkStroke::default() };
    let with = |strokes: Vec<InkStroke>| Ink { strokes, ..Ink::default() };
    assert!(classify(&with(vec![]), &Run::plain()).is_empty(), "no strokes, no answers");
    let odd = with(vec![
        stroke(vec![]),
        stroke(vec![DVec2::ONE]),
        stroke(vec![DVec2::ONE; 5]),
        stroke(vec![DVec2::NAN; 5]),
        stroke(vec![DVec2::splat(1e300), DVec2::splat(-1e300)]),
        stroke(vec![DVec2::ZERO, DVec2::X]),
    ]);
    assert_eq!(classify(&odd, &Run::plain()).len(), 6, "one answer per stroke");
    let alike = with(vec![stroke((0..40).map(|k| DVec2::new(f64::from(k), 1.0) * 0.01).collect()); 60]);
    for row in features(&alike, &Run::plain()).iter().chain(&features(&odd, &Run::plain())) {
        assert!(row.values().iter().all(|x| x.is_finite()), "{row:?}");
    }
}

#[test]
fn many_strokes_are_linear() {
    let mut stream = Seed::new(8).stream(Draw::Test);
    let one = |p: DVec2| InkStroke { points: vec![p, p + DVec2::new(0.01, 0.02)], ..InkStroke::default() };
    let mut strokes: Vec<InkStroke> =
        (0..1500).map(|_| one(DVec2::new(stream.uniform(), stream.uniform()))).collect();
    strokes.extend((0..1500).map(|_| one(DVec2::splat(0.5))));
    let ink = Ink { strokes, ..Ink::default() };
    let most = context::companion_counts(&ink).into_iter().max().unwrap_or(0);
    assert!(most <= 52, "a stroke is compared with {most} others");
    assert_eq!(classify(&ink, &Run::plain()).len(), 3000, "one answer per stroke");
}

#[test]
fn broken_models_are_refused_with_their_line() {
    let good = committed();
    let spoilt = StrokeModelTexts { classes: good.classes.replacen("1:", "x:", 1), ..good.clone() };
    assert!(StrokeModels::parse(&spoilt).is_err_and(|e| e.line > 0), "a vector without an index");
    let short = StrokeModelTexts { scale: good.scale.lines().skip(1).collect(), ..good };
    assert!(StrokeModels::parse(&short).is_err(), "a feature is missing");
}

/// Makes a hand-drawn closed loop: root, tip, half width.
fn petal(root: DVec2, tip: DVec2, half: f64, wobble: &mut base::Stream) -> Vec<DVec2> {
    let along = tip - root;
    let across = along.perp().normalize_or_zero() * half;
    (0..=40)
        .map(|k| {
            let a = f64::from(k) / 40.0 * ops::TAU;
            let t = (1.0 - ops::cos(a)) / 2.0;
            let jitter = DVec2::new(wobble.range(-1.0, 1.0), wobble.range(-1.0, 1.0)) * half * 0.03;
            root + along * t + across * ops::sin(a) + jitter
        })
        .collect()
}

fn words(lines: &[Vec<DVec2>]) -> Vec<&'static str> {
    let ink = clean(&Drawing::from_polylines("made", lines), &mut Report::default());
    classify(&ink, &Run::plain()).iter().map(|c| c.class.word()).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    #[test]
    fn any_ink_is_classified_without_panic(
        lines in prop::collection::vec(prop::collection::vec((-1e3..1e3_f64, prop_oneof![-1.0..1.0_f64, Just(0.0)]), 0..12), 0..70)
    ) {
        let lines: Vec<Vec<DVec2>> = lines.into_iter().map(|l| l.into_iter().map(|(x, y)| DVec2::new(x, y)).collect()).collect();
        let ink = clean(&Drawing::from_polylines("any", &lines), &mut Report::default());
        let found = classify(&ink, &Run::plain());
        prop_assert_eq!(found.len(), ink.strokes.len());
        prop_assert!(found.iter().all(|c| c.confidence > 0.0 && c.confidence <= 1.0));
    }
}

#[test]
fn petal_of_a_flower_is_closed_and_its_stem_a_line() {
    let mut wobble = Seed::new(2).stream(Draw::Test);
    let mut lines =
        vec![(0..30).map(|k| DVec2::new(0.02 * ops::sin(f64::from(k) * 0.2), f64::from(k) / 30.0)).collect()];
    for k in 0..6 {
        let (s, c) = ops::sin_cos(f64::from(k) * ops::TAU / 6.0 + 0.3);
        let centre = DVec2::new(0.0, 1.0);
        lines.push(petal(
            centre + DVec2::new(c, s) * 0.05,
            centre + DVec2::new(c, s) * 0.4,
            0.1,
            &mut wobble,
        ));
    }
    let found = words(&lines);
    assert_eq!(found[0], "axis", "{found:?}");
    assert!(found[1..].iter().filter(|w| **w == "blade").count() >= 5, "{found:?}");
}

#[test]
fn a_second_look_measures_what_a_first_one_does() {
    let mut stream = Seed::new(5).stream(Draw::Test);
    let mut ink = Ink::default();
    let mut kept = KeptMeasures::default();
    let none = Run::plain();
    // Includes the number from which strokes are compared with only some others.
    for n in 1..=56 {
        let root = DVec2::new(stream.uniform(), stream.uniform());
        let tip = root + DVec2::new(stream.range(-0.3, 0.3), stream.range(-0.3, 0.3));
        let points = if n % 3 == 0 {
            vec![root, (root + tip) * 0.51, tip]
        } else {
            petal(root, tip, 0.05, &mut stream)
        };
        ink.strokes.push(InkStroke { points, ..InkStroke::default() });
        if n % 20 == 0 {
            ink.strokes.remove(n / 4);
        }
        let wanted: Vec<bool> = ink.strokes.iter().map(|_| stream.uniform() < 0.4).collect();
        let (again, fresh) =
            (context::features_again(&ink, |i| wanted[i], &mut kept, &none), features(&ink, &none));
        for (i, (a, b)) in again.iter().zip(&fresh).enumerate().filter(|(i, _)| wanted[*i]) {
            assert_eq!(a.values().map(f64::to_bits), b.values().map(f64::to_bits), "stroke {i} of {n}");
        }
    }
}

#[test]
fn a_second_look_at_many_strokes_measures_what_a_first_one_does() {
    let mut stream = Seed::new(6).stream(Draw::Test);
    let mut made = |n: usize, far: f64| {
        let root = DVec2::new(stream.range(0.1, 0.9), stream.range(0.1, 0.9));
        let tip = root + DVec2::new(stream.range(-far, far), stream.range(-far, far));
        let upright = root + DVec2::new(stream.range(-0.01, 0.01), 0.3);
        let points = match n % 4 {
            0 => vec![root, (root + tip) * 0.51, tip],
            // Stems next to one another.
            3 => (0..9).map(|k| root.lerp(upright, f64::from(k) / 8.0)).collect(),
            1 => (0..9).map(|k| root.lerp(tip, f64::from(k) / 8.0)).collect(),
            _ => petal(root, tip, 0.3 * far, &mut stream),
        };
        InkStroke { points, ..InkStroke::default() }
    };
    // A frame, so that strokes drawn within it leave the whole as it is.
    let frame = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y, DVec2::ZERO];
    let mut ink = Ink::default();
    ink.strokes.push(InkStroke { points: frame.to_vec(), ..InkStroke::default() });
    ink.strokes.extend((0..150).map(|n| made(n, 0.05)));
    let mut kept = KeptMeasures::default();
    for n in 0..90 {
        let at = (37 * n) % ink.strokes.len();
        match n % 6 {
            0 => drop(ink.strokes.remove(at)),
            1 => ink.strokes[at] = made(n, 0.05),
            2 => ink.strokes.push(made(n, 0.6)),
            3 => ink.strokes.insert(at, made(n, 0.05)),
            _ => ink.strokes.push(made(n, 0.02)),
        }
        let wanted = |i: usize| !(i + n).is_multiple_of(5);
        let again = context::features_again(&ink, wanted, &mut kept, &Run::plain());
        let fresh = features(&ink, &Run::plain());
        for (i, (a, b)) in again.iter().zip(&fresh).enumerate().filter(|(i, _)| wanted(*i)) {
            assert_eq!(a.values().map(f64::to_bits), b.values().map(f64::to_bits), "stroke {i}, step {n}");
        }
    }
}

#[test]
fn a_cancelled_run_judges_nothing() {
    let line = |x: f64| (0..9).map(|i| DVec2::new(x, f64::from(i))).collect::<Vec<_>>();
    let ink = clean(&Drawing::from_polylines("stems", &[line(0.0), line(5.0)]), &mut Report::default());
    let cancel = base::CancelToken::new();
    let run = Run { cancel: &cancel, ..Run::plain() };
    assert!(classify(&ink, &run).iter().all(|c| c.confidence > 0.0));
    cancel.cancel();
    assert_eq!(classify(&ink, &run), [Classified::default(); 2]);
}

#[test]
fn the_first_line_that_anybody_draws_is_a_stem() {
    for bow in [0.0, 2.0, 10.0, 40.0] {
        let line: Vec<DVec2> = (0..=20)
            .map(|i| f64::from(i) / 20.0)
            .map(|t| DVec2::new(20.0 * t + 4.0 * bow * t * (1.0 - t), 460.0 * t))
            .collect();
        let ink = clean(&Drawing::from_polylines("line", &[line]), &mut Report::default());
        let found = classify(&ink, &Run::plain())[0];
        assert_eq!((found.class, found.source), (StrokeClass::Axis, Source::Rule(LONE_LINE)), "bow {bow}");
        assert!(found.shares.iter().sum::<f64>() > 0.99, "the classifier was asked, too");
    }
}

#[test]
fn a_class_has_the_number_of_its_place() {
    assert!(StrokeClass::ALL.iter().enumerate().all(|(k, c)| c.place() == k), "the models' label numbers");
}

#[test]
fn a_held_out_drawing_is_in_one_fold() {
    let rows = table();
    let folds = held_out_strokes(&rows, Seed::new(0)).expect("the table trains");
    let held: Vec<&String> = folds.iter().flat_map(|f| &f.drawings).collect();
    let drawings: std::collections::BTreeSet<&String> = rows.iter().map(|r| &r.drawing).collect();
    assert_eq!((held.len(), held.iter().copied().collect()), (drawings.len(), drawings));
}

#[test]
fn a_stroke_more_leaves_most_of_a_large_drawing_as_it_measured() {
    let ring = |k: u32| {
        let at = DVec2::new(f64::from(k % 30), f64::from(k / 30));
        let size = 0.2 + 0.01 * f64::from(k % 17);
        let point = |i: u32| {
            let (s, c) = ops::sin_cos(ops::TAU * f64::from(i) / 30.0);
            at + size * DVec2::new(c, 0.3 * s)
        };
        (0..=30).map(point).collect::<Vec<DVec2>>()
    };
    let mut lines: Vec<Vec<DVec2>> = (0..710).map(ring).collect();
    let measured = |lines: &[Vec<DVec2>]| {
        let ink = clean(&Drawing::from_polylines("rings", lines), &mut Report::default());
        features(&ink, &Run::plain())
    };
    let before = measured(&lines);
    // Longer than all the others.
    lines.push((0..=30).map(|i| DVec2::new(12.3, 9.4 + 0.15 * f64::from(i))).collect());
    let after = measured(&lines);
    let changed = before.iter().zip(&after).filter(|(a, b)| a != b).count();
    assert!(changed > 2 && changed < 100, "{changed} of {}", before.len());
}
