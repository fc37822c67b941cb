//! Fruits, roots and cacti: their form and their skin.

use crate::tools;
use base::ops;
use glam::DVec2;
use plant::{OrganKind, Paint, Shape};
use reading::{BladeReading, FruitReading, Kind, PlantReading, Reading};
use sketch::{Built, SketchSpec};
use tools::{blade, made, v};

/// One outline that is the whole plant.
fn whole(kind: Kind, half_width: impl Fn(f64) -> f64, color: Option<[u8; 3]>) -> Reading {
    let side = |k: u32, s: f64| v(0.5 + s * half_width(f64::from(k) / 20.0), f64::from(k) / 20.0);
    let outline = (0..=20).map(|k| side(k, 1.0)).chain((1..20).rev().map(|k| side(k, -1.0))).collect();
    let plant = PlantReading { strokes: vec![0], height: 1.0, kind, ..PlantReading::default() };
    Reading {
        fruits: vec![FruitReading { outline, bearer: None, source: Some(0), color }],
        plants: vec![plant],
        ..Reading::default()
    }
}

#[test]
fn large_fruits_have_the_skin_of_their_form_and_only_what_is_no_fruit_is_a_green_body() {
    let ball = |t: f64| (0.25 - (t - 0.5) * (t - 0.5)).max(0.0).sqrt();
    let [red, green, blue] = [0, 1, 2];
    let look = |kind, width: &dyn Fn(f64) -> f64| {
        let built = made(&whole(kind, width, None), &SketchSpec::default());
        let organ = &built.plant.organs[0];
        (organ.kind, organ.paint)
    };
    assert!(matches!(look(Kind::Fruit, &ball), (OrganKind::Fruit, Paint::Natural(_))), "an apple");
    let tinted = |kind, width: &dyn Fn(f64) -> f64| match look(kind, width) {
        (OrganKind::Fruit, Paint::Tinted(c)) => c,
        other => panic!("{other:?}"),
    };
    let banana = tinted(Kind::Fruit, &|t| 0.3 * ball(t));
    let carrot = tinted(Kind::Vegetable, &|t| 0.4 * t * (1.0 - t * t * t).max(0.0));
    let pod = tinted(Kind::Vegetable, &|t| 0.3 * ball(t));
    let tuber = tinted(Kind::Vegetable, &|t| 0.8 * ball(t));
    assert!(banana[green] > 0.5 * banana[red] && banana[blue] < 0.2 * banana[red]);
    assert!(carrot[green] < 0.5 * carrot[red] && carrot[blue] < 0.1 * carrot[red]);
    assert!(pod[green] > 1.5 * pod[red] && tuber[red] > tuber[green] && tuber[blue] > 0.2 * tuber[red]);
    // A cactus is green flesh, and a body drawn in colour keeps it.
    assert_eq!(look(Kind::Cactus, &ball).0, OrganKind::Body);
    assert_eq!(look(Kind::None, &ball).0, OrganKind::Body);
    let mut drawn = whole(Kind::Fruit, |t| 0.3 * ball(t), Some([20, 60, 200]));
    let leaf = BladeReading { color: Some([20, 160, 30]), ..blade(v(0.5, 1.0), v(0.8, 1.2), 0.1, 1) };
    drawn.leaves.push(leaf);
    let drawn = made(&drawn, &SketchSpec::default());
    let fruit = drawn.plant.organs.iter().find(|o| o.kind == OrganKind::Fruit).expect("a fruit");
    assert!(matches!(fruit.paint, Paint::Drawn(c) if c[blue] > c[red]), "{:?}", fruit.paint);
}

#[test]
fn what_looks_like_one_thing_has_its_colour_and_slices_of_a_melon_show_their_flesh() {
    let ball = |t: f64| (0.25 - (t - 0.5) * (t - 0.5)).max(0.0).sqrt();
    // Half a disc stands on its rind, as wide as it is at the top.
    let slice = |t: f64| (1.0 - (1.0 - t) * (1.0 - t)).max(0.0).sqrt();
    let look = |kind, word, width: &dyn Fn(f64) -> f64| {
        let mut reading = whole(kind, width, None);
        reading.plants[0].word = word;
        made(&reading, &SketchSpec::default()).plant.organs[0].paint
    };
    let tinted = |kind, word| match look(kind, Some(word), &ball) {
        Paint::Tinted(c) => c,
        other => panic!("{other:?}"),
    };
    let [red, green, blue] = [0, 1, 2];
    let (broccoli, mushroom) = (tinted(Kind::Vegetable, "broccoli"), tinted(Kind::Vegetable, "mushroom"));
    assert!(broccoli[green] > 1.5 * broccoli[red] && mushroom[red] > mushroom[green]);
    let berry = tinted(Kind::Fruit, "blueberry");
    assert!(berry[blue] > 2.0 * berry[red]);
    let mut on_a_stalk = whole(Kind::Fruit, ball, None);
    on_a_stalk.plants[0].word = Some("blueberry");
    on_a_stalk.axes.push(reading::AxisReading {
        points: vec![v(0.5, 0.95), v(0.55, 1.3)],
        kind: plant::AxisKind::Stem,
        bearer: None,
        half_width: Vec::new(),
        source: None,
    });
    let on_a_stalk = made(&on_a_stalk, &SketchSpec::default()).plant;
    let on_a_stalk = on_a_stalk.organs.iter().find(|o| o.kind == OrganKind::Fruit).expect("a fruit").paint;
    assert!(matches!(on_a_stalk, Paint::Natural(_)), "a fruit on a stalk of its own is an apple");
    let melon = tinted(Kind::Fruit, "watermelon");
    assert!(melon[green] > 1.5 * melon[red]);
    assert!(matches!(look(Kind::Fruit, Some("watermelon"), &slice), Paint::Natural(_)), "red flesh");
    assert!(matches!(look(Kind::Fruit, Some("apple"), &ball), Paint::Natural(_)), "red");
    // For a word that determines no colour the form does.
    assert_eq!(look(Kind::Vegetable, Some("cactus"), &ball), look(Kind::Vegetable, None, &ball));
}

/// An arc of a circle of radius 1 about (1, 1), with the half width given at each share of its length, drawn all
/// round.
fn arc_body(half_width: impl Fn(f64) -> f64) -> Vec<DVec2> {
    let at = |t: f64, side: f64| {
        let (s, c) = ops::sin_cos(ops::PI * (1.0 + 0.6 * (t - 0.5)) + 0.5 * ops::PI);
        v(1.0 + c * (1.0 + side * half_width(t)), 1.0 + s * (1.0 + side * half_width(t)))
    };
    let share = |k: u32| f64::from(k) / 40.0;
    (0..=40).map(|k| at(share(k), 1.0)).chain((1..40).rev().map(|k| at(share(k), -1.0))).collect()
}

fn body_of(outline: Vec<DVec2>, kind: Kind) -> Built {
    let mut reading = whole(kind, |_| 0.1, None);
    reading.fruits[0].outline = outline;
    made(&reading, &SketchSpec::default())
}

#[test]
fn a_banana_lies_along_its_middle_and_half_a_disc_does_not() {
    let built = body_of(arc_body(|t| 0.18 * ops::sin(ops::PI * t).max(0.0).sqrt()), Kind::Fruit);
    assert_eq!(built.plant.validate().next(), None);
    let organ = &built.plant.organs[0];
    let Shape::Strand { path, radius_m, .. } = &built.plant.shapes[organ.shape.index()] else {
        panic!("bent")
    };
    // Its middle is an arc of radius 1, and as thick there as it was drawn.
    for (p, r) in path.iter().zip(radius_m).skip(4).take(17) {
        let drawn = built.map.ink_from_plant(organ.frame.place(*p, organ.scale).truncate());
        assert!((drawn.distance(v(1.0, 1.0)) - 1.0).abs() < 0.03, "{drawn}");
        assert!((0.06..0.2).contains(&(r / built.map.metres_per_ink)), "{r}");
    }
    let widest = radius_m.iter().copied().fold(0.0, f64::max) / built.map.metres_per_ink;
    assert!((widest - 0.18).abs() < 0.02, "{widest}");
    assert!(matches!(organ.paint, Paint::Tinted(c) if c[1] > 0.5 * c[0] && c[2] < 0.2 * c[0]), "yellow");
    // The cap of a mushroom bows, too, and turns about its middle.
    let dome = (0..=40).map(|k| ops::PI * f64::from(k) / 40.0).map(|a| v(ops::cos(a), 0.8 * ops::sin(a)));
    let cap = body_of(dome.collect(), Kind::Vegetable);
    let Shape::Revolution { profile } = &cap.plant.shapes[0] else { panic!("a body of revolution") };
    let widest = profile.iter().map(|p| p.x).fold(0.0, f64::max) / cap.map.metres_per_ink;
    assert!((widest - 1.0).abs() < 0.05 && cap.plant.organs[0].frame.along.y < -0.99, "{widest}");
}

#[test]
fn fruits_have_the_skin_of_their_form() {
    let [red, green, blue] = [0, 1, 2];
    let pear = |t: f64| (0.3 * ops::sin(ops::PI * (1.0 - t).clamp(0.0, 1.0)) * (1.25 - t)).max(0.0);
    let built = made(&whole(Kind::Fruit, pear, None), &SketchSpec::default());
    let paint = built.plant.organs[0].paint;
    assert!(
        matches!(paint, Paint::Tinted(c) if c[green] > 0.9 * c[red] && c[blue] < 0.3 * c[green]),
        "{paint:?}"
    );
    // With a tuft it is a pineapple; the same leaves below it are none.
    let ball = |t: f64| 0.8 * (0.25 - (t - 0.5) * (t - 0.5)).max(0.0).sqrt();
    let kind = |root: f64, tip: f64| {
        let mut reading = whole(Kind::Fruit, ball, None);
        let tufted = |k: u32| blade(v(0.5, root), v(0.2 + 0.3 * f64::from(k), tip), 0.1, 1 + k);
        reading.leaves.extend((0..3).map(tufted));
        made(&reading, &SketchSpec::default()).plant.organs[0..4].iter().map(|o| o.kind).collect::<Vec<_>>()
    };
    assert!(kind(0.98, 1.5).contains(&OrganKind::Syncarp));
    assert!(kind(0.02, -0.5).contains(&OrganKind::Fruit));
    // Four alike are berries, and peas.
    let many = |kind: Kind| {
        let mut reading = whole(kind, ball, None);
        let one = reading.fruits[0].clone();
        reading.plants[0].strokes = vec![0, 1, 2, 3];
        reading.fruits = (0..4)
            .map(|k| FruitReading {
                outline: one.outline.iter().map(|p| *p + v(1.2 * f64::from(k), 0.0)).collect(),
                source: Some(k),
                ..one.clone()
            })
            .collect();
        match made(&reading, &SketchSpec::default()).plant.organs[2].paint {
            Paint::Tinted(c) => c,
            other => panic!("{other:?}"),
        }
    };
    let (berry, pea) = (many(Kind::Fruit), many(Kind::Vegetable));
    assert!(berry[blue] > berry[green] && berry[red] < 0.2, "{berry:?}");
    assert!(pea[green] > 1.5 * pea[red], "{pea:?}");
}

#[test]
fn a_body_under_many_florets_is_a_green_involucre_and_under_a_calyx_a_fruit() {
    let [red, green, blue] = [0, 1, 2];
    let ball = |t: f64| 0.8 * (0.25 - (t - 0.5) * (t - 0.5)).max(0.0).sqrt();
    let paint = |florets: u32, tip: f64| {
        let mut reading = whole(Kind::Stem, ball, None);
        let floret =
            |k: u32| blade(v(0.4 + 0.02 * f64::from(k), 0.9), v(0.1 * f64::from(k), tip), 0.03, 1 + k);
        reading.leaves.extend((0..florets).map(floret));
        let organs = made(&reading, &SketchSpec::default()).plant.organs;
        organs.iter().find(|o| matches!(o.kind, OrganKind::Fruit | OrganKind::Body)).map(|o| o.paint)
    };
    let is_green = |p: Option<Paint>| matches!(p, Some(Paint::Tinted(c)) if c[green] > 1.5 * c[red] && c[green] > 2.0 * c[blue]);
    assert!(is_green(paint(10, 1.8)));
    assert!(!is_green(paint(5, 1.8)), "sepals are few");
    assert!(!is_green(paint(10, 1.1)), "and short");
}
