mod coherence;
mod flowers;
mod marks;
mod taken;

use base::Report;
use base::ops;
use geom::contains;
use glam::DVec2;
use plant::AxisKind;
use proptest::prelude::*;

use ink::{Classified, Drawing, Source, StrokeClass, StrokeMode, clean};

use crate::{Kind, READ_AS, RULES, Reading, RegionKind, read, read_as, read_without};

fn line(from: (f64, f64), to: (f64, f64)) -> Vec<DVec2> {
    let (a, b) = (DVec2::from(from), DVec2::from(to));
    (0..=30).map(|i| a.lerp(b, f64::from(i) / 30.0)).collect()
}

fn path(corners: &[(f64, f64)]) -> Vec<DVec2> {
    corners.windows(2).flat_map(|w| line(w[0], w[1])).collect()
}

/// A pointed blade from `root` towards `to`, `wide` wide, drawn from its root and back.
fn leaf(root: (f64, f64), to: (f64, f64), wide: f64) -> Vec<DVec2> {
    let (root, to) = (DVec2::from(root), DVec2::from(to));
    let across = (to - root).normalize().perp() * (0.5 * wide);
    let side = |sign: f64| {
        move |i: i32| {
            let t = f64::from(i) / 20.0;
            root.lerp(to, t) + across * (sign * ops::sin(ops::PI * t))
        }
    };
    (0..20).map(side(1.0)).chain((1..=20).rev().map(side(-1.0))).collect()
}

fn circle(centre: (f64, f64), r: f64) -> Vec<DVec2> {
    let angle = |i: i32| ops::TAU * f64::from(i) / 60.0;
    (0..60).map(|i| DVec2::from(centre) + DVec2::new(ops::cos(angle(i)), ops::sin(angle(i))) * r).collect()
}

fn petals(centre: (f64, f64), n: i32, reach: f64) -> Vec<Vec<DVec2>> {
    let to = |k: i32| {
        let a = ops::TAU * f64::from(k) / f64::from(n) + 0.3;
        (centre.0 + reach * ops::cos(a), centre.1 + reach * ops::sin(a))
    };
    (0..n).map(|k| leaf(centre, to(k), 0.5 * reach)).collect()
}

fn reading(strokes: &[(StrokeClass, Vec<DVec2>)]) -> (Reading, Report) {
    let mut report = Report::default();
    let lines: Vec<Vec<DVec2>> = strokes.iter().map(|s| s.1.clone()).collect();
    let ink = clean(&Drawing::from_polylines("test", &lines), &mut report);
    let classes: Vec<Classified> =
        ink.strokes.iter().map(|s| Classified::by_user(strokes[s.index as usize].0)).collect();
    let reading = read(&ink, &classes, &mut report);
    let faults: Vec<String> = reading.validate().map(|f| f.to_string()).collect();
    assert!(faults.is_empty(), "{faults:?}");
    (reading, report)
}

/// A class of a classifier that is not sure.
fn perhaps(class: StrokeClass, confidence: f64) -> Classified {
    Classified { class, confidence, ..Classified::default() }
}

fn organs(reading: &Reading) -> Vec<&'static str> {
    reading.strokes.iter().map(|s| s.organ.word()).collect()
}

#[test]
fn a_flower_with_a_stem_and_two_leaves() {
    let mut strokes: Vec<_> =
        petals((5.0, 10.0), 5, 2.0).into_iter().map(|p| (StrokeClass::Blade, p)).collect();
    strokes.push((StrokeClass::Axis, line((5.0, 9.8), (5.2, 0.0))));
    strokes.push((StrokeClass::Blade, leaf((5.1, 4.0), (7.5, 5.5), 0.8)));
    strokes.push((StrokeClass::Blade, leaf((5.1, 3.0), (2.5, 4.5), 0.8)));
    let (r, _) = reading(&strokes);
    assert_eq!((r.flowers.len(), r.flowers[0].petals.len(), r.leaves.len(), r.axes.len()), (1, 5, 2, 1));
    assert_eq!(organs(&r), ["petal", "petal", "petal", "petal", "petal", "branch", "leaf", "leaf"]);
    let stem = &r.axes[0].points;
    assert!(
        stem[0].y < 0.01 && stem.last().is_some_and(|p| p.distance(r.flowers[0].centre) < 1e-6),
        "to the centre"
    );
    assert!(r.flowers[0].bearer.is_some() && r.leaves.iter().all(|l| l.bearer.is_some_and(|b| b.axis == 0)));
    assert!(!r.woody, "a herb");
    for leaf in &r.leaves {
        assert!(leaf.root.distance(leaf.tip) > 0.15 && leaf.midrib[0] == leaf.root, "{leaf:?}");
    }
}

#[test]
fn a_tree_of_lines_is_woody() {
    let (r, _) = reading(&[
        (StrokeClass::Axis, line((5.0, 0.0), (5.0, 10.0))),
        (StrokeClass::Axis, line((5.0, 5.0), (8.0, 8.0))),
        (StrokeClass::Axis, line((5.0, 6.0), (2.0, 9.0))),
        (StrokeClass::Axis, line((7.0, 7.0), (8.5, 7.2))),
    ]);
    assert!(r.woody && r.axes.iter().all(|a| a.kind == AxisKind::Branch), "{r:?}");
    assert_eq!(r.axes.iter().filter(|a| a.bearer.is_some()).count(), 3);
}

#[test]
fn two_lines_and_a_crown_are_a_tree() {
    let (r, _) = reading(&[
        (StrokeClass::TrunkOutline, line((4.5, 0.0), (4.6, 4.2))),
        (StrokeClass::TrunkOutline, line((5.4, 4.2), (5.5, 0.0))),
        (StrokeClass::Crown, circle((5.0, 7.0), 3.0)),
    ]);
    assert_eq!((r.axes.len(), r.regions.len(), r.woody), (1, 1, true));
    assert_eq!((r.regions[0].kind, &r.regions[0].bearers[..]), (RegionKind::Crown, &[0][..]));
    let trunk = &r.axes[0];
    let size = ops::hypot(6.0, 10.0);
    assert!((trunk.half_width[1] - 0.5 / size).abs() < 0.012, "{:?}", trunk.half_width);
    assert!(trunk.points.last().is_some_and(|p| contains(&r.regions[0].outline, *p)), "into the crown");
    assert_eq!(organs(&r), ["trunk", "trunk", "leaf_contour"]);
}

#[test]
fn a_crown_alone_gets_stems_and_one_in_the_air_a_trunk() {
    let (bush, _) = reading(&[(StrokeClass::Crown, circle((5.0, 3.0), 3.0))]);
    assert!(bush.regions[0].bearers.len() >= 3, "several stems");
    let (tree, _) = reading(&[
        (StrokeClass::Crown, circle((5.0, 7.0), 3.0)),
        (StrokeClass::Ground, line((0.0, 0.0), (10.0, 0.0))),
    ]);
    assert_eq!(tree.regions[0].bearers.len(), 1);
    assert!(tree.axes[0].points[0].y < 0.01, "from the ground");
}

#[test]
fn a_lone_leaf_has_its_midrib_and_petiole() {
    let (r, _) = reading(&[
        (StrokeClass::Blade, leaf((5.0, 3.0), (5.0, 10.0), 4.0)),
        (StrokeClass::Vein, line((5.0, 9.5), (5.0, 0.0))),
        (StrokeClass::Vein, line((5.0, 6.0), (6.0, 7.0))),
    ]);
    assert_eq!((r.leaves.len(), r.axes.len()), (1, 1));
    let l = &r.leaves[0];
    assert_eq!(l.veins.len(), 1);
    assert!(
        l.tip.y > l.root.y + 0.4 && l.midrib.iter().all(|p| (p.x - l.root.x).abs() < 0.02),
        "{:?}",
        l.midrib
    );
    assert!(r.axes[0].points[0].y < 0.01 && l.bearer.is_some(), "borne by its petiole");
    assert_eq!(organs(&r), ["leaf", "vein", "vein"]);
}

#[test]
fn a_palm_has_its_fronds_on_top() {
    let fronds = path(&[
        (5.0, 8.0),
        (1.0, 7.0),
        (4.8, 8.1),
        (2.0, 10.5),
        (5.0, 8.2),
        (8.0, 10.5),
        (5.2, 8.1),
        (9.0, 7.0),
        (5.0, 7.8),
    ]);
    let (r, _) = reading(&[
        (StrokeClass::TrunkOutline, line((4.7, 0.0), (4.8, 8.0))),
        (StrokeClass::TrunkOutline, line((5.2, 8.0), (5.3, 0.0))),
        (StrokeClass::Corolla, fronds),
        (StrokeClass::Axis, line((5.1, 8.0), (7.0, 5.0))),
    ]);
    assert_eq!(r.flowers.len(), 0);
    assert!(
        r.leaves.len() >= 4 && r.leaves.iter().all(|l| l.bearer.is_some_and(|b| b.axis == 0)),
        "{:?}",
        r.leaves.len()
    );
    assert!(r.woody, "a trunk");
}

#[test]
fn a_cactus_has_arms_and_thorns_and_no_bark() {
    let body = path(&[
        (4.0, 0.0),
        (4.0, 8.0),
        (5.0, 10.0),
        (6.0, 8.0),
        (6.0, 5.0),
        (8.0, 5.0),
        (8.0, 7.0),
        (9.0, 7.0),
        (9.0, 4.0),
        (6.0, 4.0),
        (6.0, 0.0),
    ]);
    let (r, _) = reading(&[
        (StrokeClass::TrunkOutline, body),
        (StrokeClass::Axis, line((4.0, 3.0), (3.2, 3.3))),
        (StrokeClass::Axis, line((4.0, 5.0), (3.2, 5.3))),
        (StrokeClass::Axis, line((6.0, 2.0), (6.8, 2.3))),
    ]);
    assert_eq!((r.axes.len(), r.thorns.len(), r.woody), (2, 3, false));
    assert!(r.axes[1].bearer.is_some_and(|b| b.axis == 0), "the arm stands on the body");
    assert!(r.thorns.iter().all(|t| t.1.is_some()), "thorns are borne");
    assert_eq!(organs(&r)[1..], ["thorn", "thorn", "thorn"]);
}

#[test]
fn a_pot_is_no_part_of_the_plant_that_stands_in_it() {
    let (r, _) = reading(&[
        (StrokeClass::Pot, path(&[(3.0, 3.0), (7.0, 3.0), (6.5, 0.0), (3.5, 0.0), (3.0, 3.0)])),
        (StrokeClass::Axis, line((5.0, 1.5), (5.0, 9.0))),
        (StrokeClass::Blade, leaf((5.0, 6.0), (7.5, 7.5), 0.8)),
    ]);
    assert_eq!((organs(&r)[0], r.axes.len(), r.leaves.len()), ("pot", 1, 1));
    let rim = 3.0 / ops::hypot(4.5, 9.0);
    assert!((r.axes[0].points[0].y - rim).abs() < 0.02, "{}", r.axes[0].points[0].y);
}

#[test]
fn roots_go_down_from_a_trunk() {
    let (r, _) = reading(&[
        (StrokeClass::TrunkOutline, line((4.5, 3.0), (4.6, 8.0))),
        (StrokeClass::TrunkOutline, line((5.4, 8.0), (5.5, 3.0))),
        (StrokeClass::Crown, circle((5.0, 10.0), 2.5)),
        (StrokeClass::Ground, line((0.0, 3.0), (10.0, 3.0))),
        (StrokeClass::Axis, line((4.6, 2.9), (3.0, 1.0))),
        (StrokeClass::Axis, line((6.5, 0.0), (5.4, 2.9))),
    ]);
    let roots: Vec<_> = r.axes.iter().filter(|a| a.kind == AxisKind::Root).collect();
    assert_eq!(roots.len(), 2);
    assert!(roots.iter().all(|a| a.points[0].y > a.points[a.points.len() - 1].y), "upper end first");
    assert_eq!(organs(&r)[4..], ["root", "root"]);
}

#[test]
fn a_user_contour_needs_no_class_and_gets_a_bearer() {
    let mut drawing = Drawing::from_polylines("c", &[circle((5.0, 5.0), 3.0), line((5.0, 0.0), (5.0, 3.5))]);
    drawing.strokes[0].mode = StrokeMode::LeafContour;
    let ink = clean(&drawing, &mut Report::default());
    let classes = [StrokeClass::Other, StrokeClass::Axis].map(Classified::by_user);
    let r = read(&ink, &classes, &mut Report::default());
    assert_eq!((r.regions[0].kind, &r.regions[0].bearers[..]), (RegionKind::Leaves, &[0][..]));
    assert_eq!(organs(&r), ["leaf_contour", "branch"]);
    assert_eq!(r.validate().count(), 0);
}

#[test]
fn a_scribble_alone_becomes_a_plant_with_a_warning() {
    let scribble: Vec<DVec2> =
        (0..400).map(f64::from).map(|t| DVec2::new(ops::sin(t * 1.3), ops::sin(t * 0.7 + 1.0))).collect();
    for class in [StrokeClass::Scribble, StrokeClass::Other, StrokeClass::Pot] {
        let (r, report) = reading(&[(class, scribble.clone())]);
        assert!(!r.axes.is_empty() && !r.regions.is_empty(), "{class:?}");
        assert!(report.warnings.iter().any(|w| w.code == "scribble"), "{class:?}");
    }
}

#[test]
fn thousands_of_strokes_of_any_class() {
    for alike in [false, true] {
        let lines: Vec<Vec<DVec2>> = (0..4_000)
            .map(|i: i32| {
                let (x, y) = if alike { (1.0, 1.0) } else { (f64::from(i % 100), f64::from(i / 100)) };
                vec![
                    DVec2::new(x, y),
                    DVec2::new(x + 0.7, y + 0.4),
                    DVec2::new(x + 0.1, y + 0.8),
                    DVec2::new(x, y + 0.01),
                ]
            })
            .collect();
        let ink = clean(&Drawing::from_polylines("many", &lines), &mut Report::default());
        for class in [StrokeClass::Axis, StrokeClass::Blade, StrokeClass::TrunkOutline, StrokeClass::Corolla]
        {
            let classes = vec![Classified::by_user(class); ink.strokes.len()];
            let r = read(&ink, &classes, &mut Report::default());
            assert_eq!(r.strokes.len(), 4_000, "{class:?}");
        }
    }
}

#[test]
fn a_fruit_or_a_contour_drawn_as_a_line_is_still_a_plant() {
    let (r, report) = reading(&[(StrokeClass::Fruit, line((0.0, 2.0), (1.0, 1.0)))]);
    assert_eq!((r.axes.len(), r.fruits.len()), (1, 0));
    assert!(report.warnings.iter().any(|w| w.code == "scribble-stem"), "{report:?}");
    let mut drawing = Drawing::from_polylines("c", &[line((0.0, 0.0), (1.0, 1.0))]);
    drawing.strokes[0].mode = StrokeMode::LeafContour;
    let ink = clean(&drawing, &mut Report::default());
    assert_eq!(read(&ink, &[], &mut Report::default()).axes.len(), 1);
}

#[test]
fn a_leaf_taken_for_a_body_is_seen_by_its_midrib_unless_the_user_says_so() {
    let strokes = [leaf((5.0, 3.0), (5.0, 10.0), 4.0), line((5.0, 9.5), (5.0, 0.0))];
    let ink = clean(&Drawing::from_polylines("leaf", &strokes), &mut Report::default());
    let body =
        |confidence| [StrokeClass::TrunkOutline, StrokeClass::Axis].map(|class| perhaps(class, confidence));
    let guessed = read_without(&[READ_AS], &ink, &body(0.6), &mut Report::default());
    assert_eq!((guessed.leaves.len(), guessed.strokes[0].class), (1, StrokeClass::Blade));
    let set = read(&ink, &body(1.0), &mut Report::default());
    assert_eq!((set.leaves.len(), set.strokes[0].class), (0, StrokeClass::TrunkOutline));
}

#[test]
fn margin_and_midrib_in_one_go_with_side_veins_are_a_leaf() {
    let (margin, midrib) = (leaf((5.0, 0.0), (5.0, 10.0), 4.0), line((5.0, 0.0), (5.0, 10.0)));
    let mut on_from_the_tip = leaf((5.0, 10.0), (5.0, 0.0), 4.0);
    on_from_the_tip.splice(0..0, midrib.clone());
    for outline in [[margin, midrib].concat(), on_from_the_tip] {
        let veins = [3.0, 5.0, 7.0].map(|y| line((4.2, y), (5.8, y + 0.4)));
        let strokes: Vec<_> = [outline].into_iter().chain(veins).collect();
        let ink = clean(&Drawing::from_polylines("leaf", &strokes), &mut Report::default());
        let class = |k| if k == 0 { StrokeClass::TrunkOutline } else { StrokeClass::Axis };
        let classes = [0, 1, 2, 3].map(|k| perhaps(class(k), 0.6));
        let r = read(&ink, &classes, &mut Report::default());
        assert_eq!((r.leaves.len(), r.thorns.len()), (1, 0), "{r:?}");
        assert!(r.strokes[1..].iter().all(|s| s.class == StrokeClass::Vein), "{:?}", r.strokes);
    }
}

#[test]
fn grass_is_neither_trunks_nor_a_crown() {
    let stalks: Vec<_> = (0..6).map(|i| line((f64::from(i), 0.0), (f64::from(i) + 0.3, 3.0))).collect();
    let ink = clean(&Drawing::from_polylines("grass", &stalks), &mut Report::default());
    let r = read(&ink, &[perhaps(StrokeClass::TrunkOutline, 0.5); 6], &mut Report::default());
    assert_eq!((r.axes.len(), r.leaves.len()), (0, 6), "{r:?}");
    assert!(r.leaves.iter().all(|l| l.root.y < 0.02 && l.tip.y > 0.2), "rooted on the ground");
    let zigzag = path(&[
        (0.0, 0.0),
        (0.5, 3.0),
        (1.0, 0.0),
        (1.5, 3.0),
        (2.0, 0.0),
        (2.5, 3.0),
        (3.0, 0.0),
        (3.5, 3.0),
        (4.0, 0.0),
    ]);
    let ink = clean(&Drawing::from_polylines("grass", &[zigzag]), &mut Report::default());
    let r = read(&ink, &[perhaps(StrokeClass::Crown, 0.5)], &mut Report::default());
    assert_eq!((r.leaves.len(), r.regions.len()), (4, 0));
}

#[test]
fn a_lawn_drawn_as_a_flat_line_and_a_zigzag_is_grass() {
    let flat = path(&[(-0.2, 2.4), (-0.3, 0.3), (6.0, 0.0)]);
    let zigzag = path(&[
        (6.5, 0.0),
        (7.5, 2.0),
        (8.0, 0.6),
        (9.5, 2.6),
        (10.0, 0.8),
        (11.0, 2.0),
        (11.5, 0.8),
        (12.5, 1.8),
    ]);
    let r =
        guessed(&[(StrokeClass::TrunkOutline, flat.clone()), (StrokeClass::TrunkOutline, zigzag.clone())]);
    assert_eq!((r.axes.len(), r.strokes[0].class), (0, StrokeClass::Ground), "{:?}", r.strokes);
    assert!(r.leaves.len() >= 3, "{} blades", r.leaves.len());
    // Without the rule the kind of the whole is a cactus.
    let kinds = ["", "zigzag"].map(|off| whole_without(off, &[zigzag.clone(), flat.clone()]).0);
    assert_eq!(kinds, [Kind::Grass, Kind::Cactus]);
}

/// Returns the kind and the leaf count of the one plant that programs read, with a rule switched off.
fn whole_without(off: &str, lines: &[Vec<DVec2>]) -> (Kind, usize) {
    let ink = clean(&Drawing::from_polylines("whole", lines), &mut Report::default());
    let classes = ink::classify(&ink, &base::Run::plain());
    let r = read_without(&[off], &ink, &classes, &mut Report::default());
    assert_eq!(r.plants.len(), 1);
    (r.plants[0].kind, r.leaves.len())
}

fn guessed(strokes: &[(StrokeClass, Vec<DVec2>)]) -> Reading {
    let lines: Vec<Vec<DVec2>> = strokes.iter().map(|s| s.1.clone()).collect();
    let ink = clean(&Drawing::from_polylines("guessed", &lines), &mut Report::default());
    let classes: Vec<Classified> =
        ink.strokes.iter().map(|s| perhaps(strokes[s.index as usize].0, 0.5)).collect();
    // The kind of the whole would recognise them, too.
    read_without(&[READ_AS], &ink, &classes, &mut Report::default())
}

/// Reads a drawing as programs do.
fn read_whole(name: &str, lines: &[Vec<DVec2>]) -> Reading {
    let ink = clean(&Drawing::from_polylines(name, lines), &mut Report::default());
    let classes = ink::classify(&ink, &base::Run::plain());
    read(&ink, &classes, &mut Report::default())
}

#[test]
fn lines_below_a_long_level_line_are_roots() {
    let mut lines = vec![
        line((0.0, 5.0), (10.0, 5.05)),
        line((5.0, 5.0), (5.1, 0.5)),
        path(&[(5.0, 4.0), (3.5, 2.5)]),
        path(&[(5.0, 3.0), (6.8, 1.5)]),
        line((5.0, 5.0), (5.0, 9.0)),
        leaf((5.0, 7.0), (3.0, 9.0), 0.8),
        leaf((5.0, 7.5), (7.0, 9.4), 0.8),
    ];
    let r = read_whole("root", &lines);
    assert_eq!(r.strokes[0].class, StrokeClass::Ground, "{:?}", r.strokes);
    let roots = r.axes.iter().filter(|a| a.kind == AxisKind::Root).count();
    assert_eq!((roots, r.leaves.len()), (3, 2), "{:?}", r.strokes);
    // A level twig with an apple that hangs from it is none.
    lines.truncate(1);
    lines.extend([line((5.0, 5.0), (5.0, 4.0)), circle((5.0, 2.5), 1.5), line((3.0, 5.0), (3.2, 7.0))]);
    assert_ne!(read_whole("twig", &lines).strokes[0].class, StrokeClass::Ground);
}

#[test]
fn a_tuft_of_grass_in_strokes_down_and_up_again_is_no_crown() {
    let v = |x: f64| path(&[(x - 1.0, 4.0), (x, 0.0), (x + 1.2, 4.0)]);
    let r = guessed(&[
        (StrokeClass::Crown, v(0.0)),
        (StrokeClass::Fruit, v(3.0)),
        (StrokeClass::Axis, line((6.0, 0.0), (6.3, 3.0))),
    ]);
    assert_eq!((r.regions.len(), r.fruits.len(), r.leaves.len()), (0, 0, 5), "{:?}", r.strokes);
    // Four of them are grass by the whole, too, but without the rule each is one broad blade.
    let four = [0.0, 3.0, 6.0, 9.0].map(v);
    assert_eq!(["", "tuft"].map(|off| whole_without(off, &four)), [(Kind::Grass, 8), (Kind::Grass, 4)]);
    // A trough is no root: an outline that is round below stays a crown.
    let bowl: Vec<DVec2> = (0..=40)
        .map(|i| ops::PI * f64::from(i) / 40.0)
        .map(|a| DVec2::new(-ops::cos(a), 1.0 - ops::sin(a)))
        .collect();
    assert_eq!(guessed(&[(StrokeClass::Crown, bowl)]).regions.len(), 1);
}

#[test]
fn half_a_cactus_stands_upright() {
    // Up the left side, round an arm and the top, and left off half way down the right side.
    let half = path(&[
        (1.0, 0.0),
        (1.0, 2.0),
        (0.0, 2.0),
        (0.0, 3.5),
        (0.5, 3.5),
        (0.5, 2.6),
        (1.0, 2.6),
        (1.0, 5.0),
        (1.9, 5.0),
        (1.9, 2.5),
    ]);
    let r = guessed(&[(StrokeClass::TrunkOutline, half)]);
    let trunk = &r.axes[0];
    let (foot, top) = (trunk.points[0], trunk.points[trunk.points.len() - 1]);
    assert!((foot.x - top.x).abs() < 0.05, "leans from {foot} to {top}");
    let wide = |tenths: usize| trunk.half_width[(trunk.half_width.len() - 1) * tenths / 10];
    assert!(wide(1) > 0.7 * wide(7), "{} at the foot, {} above", wide(1), wide(7));
}

fn any_class() -> impl Strategy<Value = StrokeClass> {
    (0..StrokeClass::ALL.len()).prop_map(|k| StrokeClass::ALL[k])
}

fn any_stroke() -> impl Strategy<Value = Vec<DVec2>> {
    let coarse = (0..6, 0..6).prop_map(|(x, y)| DVec2::new(f64::from(x), f64::from(y)));
    let fine = (0.0..6.0, 0.0..6.0).prop_map(|(x, y)| DVec2::new(x, y));
    let shape = (0.0..5.0, 0.0..5.0, 0.1..2.0).prop_map(|(x, y, r)| circle((x, y), r));
    prop_oneof![
        3 => prop::collection::vec(coarse, 1..9),
        2 => prop::collection::vec(fine, 1..30),
        1 => shape,
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]
    #[test]
    fn any_strokes_and_classes_give_a_sound_reading(
        strokes in prop::collection::vec((any_class(), any_stroke(), 0..10), 0..12)
    ) {
        let mut drawing = Drawing::from_polylines("any", &strokes.iter().map(|s| s.1.clone()).collect::<Vec<_>>());
        for (s, (_, _, mode)) in drawing.strokes.iter_mut().zip(&strokes) {
            s.mode = match mode { 0 => StrokeMode::BranchContour, 1 => StrokeMode::LeafContour, _ => StrokeMode::Parts };
        }
        let mut report = Report::default();
        let ink = clean(&drawing, &mut report);
        let classes: Vec<Classified> = ink.strokes.iter().map(|s| perhaps(strokes[s.index as usize].0, 0.5)).collect();
        let r = read(&ink, &classes, &mut report);
        let faults: Vec<String> = r.validate().map(|f| f.to_string()).collect();
        prop_assert!(faults.is_empty(), "{:?}", faults);
        prop_assert_eq!(r.strokes.len(), strokes.len());
        let organs = r.axes.len() + r.leaves.len() + r.flowers.len() + r.regions.len() + r.fruits.len();
        prop_assert!(ink.strokes.is_empty() || organs > 0, "no plant at all");
    }
}

#[test]
fn a_line_round_a_crown_and_down_one_side_of_its_trunk_is_a_tree() {
    let round = (4..=60).map(|i| {
        let a = ops::TAU * f64::from(i) / 64.0 - 0.5 * ops::PI;
        DVec2::new(5.0 + 3.0 * ops::cos(a), 8.0 + 3.0 * ops::sin(a))
    });
    let mut crown: Vec<DVec2> = line((5.6, 0.0), (5.6, 5.0));
    crown.extend(round);
    crown.extend([DVec2::new(5.1, 5.05), DVec2::new(5.5, 5.0)]);
    let r = read_whole("tree", &[crown, line((4.6, 5.0), (4.6, 0.0))]);
    assert_eq!((r.regions.len(), r.plants[0].kind), (1, Kind::Tree), "{:?}", r.strokes);
}

#[test]
fn a_scribble_at_the_top_of_a_trunk_is_its_crown() {
    let scribble = (0..400).map(|i| {
        let t = f64::from(i) * 0.7;
        DVec2::new(5.0 + 3.0 * ops::sin(t), 8.0 + 2.0 * ops::cos(1.37 * t))
    });
    let strokes = [
        // They meet above: a body without an open top could be a cactus.
        (StrokeClass::TrunkOutline, line((4.5, 0.0), (5.0, 6.0))),
        (StrokeClass::TrunkOutline, line((5.5, 0.0), (5.0, 6.0))),
        (StrokeClass::Scribble, scribble.collect()),
    ];
    assert_eq!(guessed(&strokes).regions.len(), 1);
}

#[test]
fn a_class_says_what_decided_it_and_how_sure_it_is() {
    let strokes = [leaf((5.0, 3.0), (5.0, 10.0), 4.0), line((5.0, 9.5), (5.0, 0.0))];
    let ink = clean(&Drawing::from_polylines("leaf", &strokes), &mut Report::default());
    let said = |class: StrokeClass, share: f64, other: StrokeClass| {
        let mut shares = [0.0; StrokeClass::ALL.len()];
        (shares[class.place()], shares[other.place()]) = (share, 1.0 - share);
        Classified::by_shares(shares)
    };
    let body = said(StrokeClass::TrunkOutline, 0.75, StrokeClass::Blade);
    let classes = [body, said(StrokeClass::Vein, 0.5, StrokeClass::Axis)];
    let of = |r: &Reading| r.strokes.iter().map(|s| (s.class, s.source, s.confidence)).collect::<Vec<_>>();
    let line = |class, source| (class, source, 0.5);
    let all = read_without(&[READ_AS], &ink, &classes, &mut Report::default());
    // The rule agrees about the line: the classifier's class is shown, and its share.
    let rule = (StrokeClass::Blade, Source::Rule("whole-leaf"), 0.25);
    assert_eq!(of(&all)[0], rule);
    assert_eq!(of(&all)[1].0, StrokeClass::Vein);
    let off =
        read_without(&[READ_AS, "whole-leaf", "tree-in-one-stroke"], &ink, &classes, &mut Report::default());
    assert_eq!(of(&off)[0], (StrokeClass::TrunkOutline, Source::Classifier, 0.75));
    let set = [Classified::by_user(StrokeClass::TrunkOutline), classes[1]];
    let set = read(&ink, &set, &mut Report::default());
    assert_eq!(of(&set)[0], (StrokeClass::TrunkOutline, Source::User, 1.0));
    assert_eq!(of(&set)[1], line(classes[1].class, Source::Classifier));
}

#[test]
fn a_line_by_itself_is_the_classifiers_where_its_rule_is_off() {
    let ink =
        clean(&Drawing::from_polylines("line", &[line((0.0, 0.0), (1.0, 9.0))]), &mut Report::default());
    let classes = ink::classify(&ink, &base::Run::plain());
    let on = read(&ink, &classes, &mut Report::default()).strokes[0];
    assert_eq!((on.class, on.source), (StrokeClass::Axis, Source::Rule(ink::LONE_LINE)));
    let off = read_without(&[ink::LONE_LINE, READ_AS], &ink, &classes, &mut Report::default()).strokes[0];
    assert_eq!((off.class, off.source), (Classified::by_shares(classes[0].shares).class, Source::Classifier));
}

/// A crown of bumps, and its trunk drawn in four ways.
fn trees() -> Vec<Vec<Vec<DVec2>>> {
    let crown: Vec<DVec2> = (0..=90)
        .map(|i| ops::TAU * f64::from(i) / 90.0)
        .map(|a| (a, 3.0 + 0.3 * ops::sin(4.0 * a).abs()))
        .map(|(a, r)| DVec2::new(5.0 + r * ops::cos(a), 8.0 + r * ops::sin(a)))
        .collect();
    let open = path(&[(4.5, 5.3), (4.4, 0.0), (5.6, 0.0), (5.5, 5.3)]);
    let closed = [open.clone(), path(&[(5.5, 5.3), (4.5, 5.3)])].concat();
    let two = vec![line((4.5, 5.3), (4.4, 0.0)), line((5.6, 0.0), (5.5, 5.3))];
    let trunks = [two, vec![closed], vec![open], vec![line((5.0, 0.0), (5.0, 5.2))]];
    trunks
        .into_iter()
        .flat_map(|trunk| {
            let crown_last = [trunk.clone(), vec![crown.clone()]].concat();
            let crown_first = [vec![crown.clone()], trunk].concat();
            [crown_last, crown_first]
        })
        .collect()
}

#[test]
fn a_tree_is_a_tree_however_and_in_which_order_it_is_drawn() {
    for lines in trees() {
        let ink = clean(&Drawing::from_polylines("tree", &lines), &mut Report::default());
        let classes = ink::classify(&ink, &base::Run::plain());
        let r = read(&ink, &classes, &mut Report::default());
        assert_eq!(r.plants.iter().map(|p| p.kind).collect::<Vec<_>>(), [Kind::Tree], "{:?}", r.strokes);
        let standing = r.axes.iter().filter(|a| a.bearer.is_none()).count();
        assert_eq!((r.regions.len(), standing, r.fruits.len(), r.leaves.len()), (1, 1, 0, 0));
        assert_eq!(r.validate().count(), 0);
    }
}

#[test]
fn a_line_added_later_takes_nothing_that_was_understood() {
    for mut lines in trees() {
        lines.push(line((3.5, 8.5), (4.2, 9.0)));
        lines.push(line((5.8, 7.0), (6.6, 7.4)));
        let ink = clean(&Drawing::from_polylines("tree", &lines), &mut Report::default());
        let classes = ink::classify(&ink, &base::Run::plain());
        let r = read(&ink, &classes, &mut Report::default());
        assert_eq!((r.plants[0].kind, r.regions.len()), (Kind::Tree, 1), "{:?}", r.strokes);
    }
}

#[test]
fn each_of_several_plants_is_read_by_itself_and_stays_where_it_was_drawn() {
    let all = trees();
    let mut lines: Vec<Vec<DVec2>> = Vec::new();
    for (k, (x, scale)) in [(0, (0.0, 1.0)), (3, (9.0, 0.6)), (6, (16.0, 1.2))] {
        let to = |p: &DVec2| *p * scale + DVec2::new(x, 0.0);
        lines.extend(all[k].iter().map(|l| l.iter().map(to).collect::<Vec<_>>()));
    }
    lines.insert(2, line((-2.0, -0.05), (28.0, 0.05)));
    let ink = clean(&Drawing::from_polylines("trees", &lines), &mut Report::default());
    assert_eq!((ink.subjects.plants.len(), &ink.subjects.ground[..]), (3, &[2][..]));
    let classes = ink::classify(&ink, &base::Run::plain());
    let r = read(&ink, &classes, &mut Report::default());
    assert_eq!(r.validate().count(), 0);
    assert_eq!(r.strokes.len(), lines.len());
    assert_eq!(r.strokes[2].class, StrokeClass::Ground);
    assert_eq!(r.plants.iter().map(|p| p.kind).collect::<Vec<_>>(), [Kind::Tree; 3]);
    assert_eq!((r.regions.len(), r.axes.iter().filter(|a| a.bearer.is_none()).count()), (3, 3));
    // Each crown lies where it was drawn.
    for region in &r.regions {
        let stroke = &ink.strokes[region.source.expect("drawn") as usize].points;
        let mean = |points: &[DVec2]| points.iter().sum::<DVec2>() / points.len() as f64;
        assert!(mean(stroke).distance(mean(&region.outline)) < 0.01);
    }
    // A class that the user set holds in its plant.
    let mut set = classes;
    set[0] = Classified::by_user(StrokeClass::Fruit);
    let r = read(&ink, &set, &mut Report::default());
    assert_eq!(r.strokes[0].class, StrokeClass::Fruit);
}

#[test]
fn the_line_at_the_foot_of_a_bush_is_no_fruit() {
    let bush: Vec<DVec2> = (0..=40)
        .map(|i| ops::PI * f64::from(i) / 40.0)
        .map(|a| DVec2::new(5.0 * ops::cos(a), 3.0 * ops::sin(a)))
        .collect();
    let foot = path(&[(-5.0, 0.0), (0.0, 0.2), (5.0, 0.0)]);
    let r = guessed(&[(StrokeClass::Crown, bush.clone()), (StrokeClass::Fruit, foot)]);
    assert_eq!((r.fruits.len(), r.strokes[1].class, r.regions.len()), (0, StrokeClass::Ground, 1));
    let stalk = line((0.0, 0.0), (0.2, -2.0));
    let r = guessed(&[(StrokeClass::Crown, bush), (StrokeClass::Fruit, stalk)]);
    assert_eq!((r.fruits.len(), r.strokes[1].class), (0, StrokeClass::Axis));
}

#[test]
fn the_user_may_take_a_drawing_for_another_kind() {
    let lines = &trees()[6];
    let ink = clean(&Drawing::from_polylines("tree", lines), &mut Report::default());
    let classes = ink::classify(&ink, &base::Run::plain());
    for kind in Kind::ALL {
        let r = read_as(Some(kind), &ink, &classes, &mut Report::default());
        assert_eq!((r.validate().count(), r.plants[0].kind), (0, kind));
    }
    let r = read_as(Some(Kind::Fruit), &ink, &classes, &mut Report::default());
    assert_eq!((r.fruits.len(), r.regions.len()), (1, 0), "{:?}", r.strokes);
    assert!(r.strokes.iter().any(|s| s.source == Source::Rule(READ_AS)), "{:?}", r.strokes);
    // The scores fall, and the kind that was read comes first.
    let r = read(&ink, &classes, &mut Report::default());
    let readings = &r.plants[0].readings;
    assert_eq!((readings.len(), readings[0].kind), (3, r.plants[0].kind));
    assert!(readings.windows(2).all(|w| w[0].score >= w[1].score), "{readings:?}");
}

#[test]
fn the_documented_rules_are_these() {
    let docs = include_str!("../../../docs/strokes.md");
    let rows = docs.lines().filter(|l| l.starts_with("| `") && l.contains("` | "));
    let documented: Vec<&str> = rows.filter_map(|l| l.split('|').nth(1)).map(str::trim).collect();
    let names: Vec<String> = RULES.iter().map(|r| format!("`{}`", r.name)).collect();
    assert_eq!(documented, names, "run `cargo xtask train-strokes`");
    for rule in RULES {
        assert!(
            docs.contains(&format!("| `{}` | {} |", rule.name, rule.why)),
            "{} is told otherwise",
            rule.name
        );
        let kebab = rule.name.chars().all(|c| c.is_ascii_lowercase() || c == '-');
        assert!(kebab && rule.why.ends_with('.'), "{} is a name, its reason a sentence", rule.name);
    }
}

/// Reads lines as a person would have drawn them; returns whether the result was called no plant.
fn drawn(lines: &[Vec<DVec2>]) -> (Reading, bool) {
    let mut report = Report::default();
    let ink = clean(&Drawing::from_polylines("drawn", lines), &mut report);
    let classes = ink::classify(&ink, &base::Run::plain());
    let r = read(&ink, &classes, &mut report);
    (r, report.warnings.iter().any(|w| w.code == crate::UNLIKE_A_PLANT))
}

#[test]
fn a_house_and_a_cat_are_unlike_a_plant_and_plants_are_not() {
    let house = vec![
        path(&[(0.0, 0.0), (0.0, 60.0), (90.0, 60.0), (90.0, 0.0), (0.0, 0.0)]),
        path(&[(-6.0, 60.0), (45.0, 98.0), (96.0, 60.0)]),
        path(&[(36.0, 0.0), (36.0, 32.0), (53.0, 32.0), (53.0, 0.0)]),
        path(&[(10.0, 28.0), (10.0, 45.0), (25.0, 45.0), (25.0, 28.0), (10.0, 28.0)]),
    ];
    let mut cat = vec![circle((0.0, 0.0), 40.0), circle((-14.0, 9.0), 5.0), circle((14.0, 9.0), 5.0)];
    for s in [-1.0, 1.0] {
        cat.push(path(&[(s * 34.0, 22.0), (s * 33.0, 56.0), (s * 10.0, 39.0)]));
        cat.push(line((s * 12.0, -6.0), (s * 52.0, 0.0)));
        cat.push(line((s * 12.0, -11.0), (s * 50.0, -16.0)));
    }
    cat.push(path(&[(-12.0, -18.0), (0.0, -24.0), (12.0, -18.0)]));
    for (what, lines) in [("house", house), ("cat", cat)] {
        let (reading, warned) = drawn(&lines);
        assert!(warned, "{what}: {:?}", reading.plants);
        assert!(
            !reading.axes.is_empty() || !reading.fruits.is_empty() || !reading.leaves.is_empty(),
            "{what}"
        );
    }
    let way = |k: i32| ops::sin_cos(ops::TAU * f64::from(k) / 6.0 + 0.3);
    let round = |k: i32| circle((18.0 * way(k).1, 18.0 * way(k).0), 9.0);
    let mut flower: Vec<Vec<DVec2>> = (0..6).map(round).collect();
    flower.extend([circle((0.0, 0.0), 9.0), line((0.0, -28.0), (0.0, -80.0))]);
    // Pointed petals that begin in the middle, under the disc that was drawn over them, on a bare stalk.
    let mut daisy: Vec<Vec<DVec2>> =
        (0..6).map(|k| leaf((0.0, 0.0), (30.0 * way(k).1, 30.0 * way(k).0), 14.0)).collect();
    daisy.extend([circle((0.0, 0.0), 8.0), line((0.0, -24.0), (1.0, -120.0))]);
    let leaf = vec![leaf((0.0, 0.0), (0.0, 80.0), 40.0), line((0.0, -20.0), (0.0, 74.0))];
    let trees = trees().into_iter().map(|lines| (Kind::Tree, lines));
    for (kind, lines) in trees.chain([(Kind::Flower, flower), (Kind::Flower, daisy), (Kind::Leaf, leaf)]) {
        let (reading, warned) = drawn(&lines);
        assert!(!warned, "{kind:?}: {:?}", reading.plants);
        assert_eq!(reading.plants[0].kind, kind, "{:?}", reading.strokes);
    }
}

#[test]
fn rings_in_a_bunch_are_one_fruit_and_no_row_of_plants() {
    let mut lines: Vec<Vec<DVec2>> = Vec::new();
    for row in 0..4_u32 {
        for k in 0..4 - row {
            let x = f64::from(k) * 22.0 + f64::from(row) * 11.0;
            lines.push(circle((x, -19.0 * f64::from(row)), 10.0));
        }
    }
    lines.push(line((33.0, 10.0), (33.0, 34.0)));
    let (reading, _) = drawn(&lines);
    assert_eq!(reading.plants.iter().map(|p| p.kind).collect::<Vec<_>>(), [Kind::Fruit], "{reading:?}");
}
