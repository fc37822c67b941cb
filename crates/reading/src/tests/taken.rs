//! Drawings taken for a kind, and the plants that are then built.

use std::cell::RefCell;

use geom::signed_area;

use super::*;
use crate::bare::BareWood;
use crate::draft::Draft;
use crate::silhouette::{Drawn, Shaping, Silhouette};

/// Reads lines taken for a kind.
fn taken(kind: Kind, lines: &[Vec<DVec2>]) -> Reading {
    let ink = clean(&Drawing::from_polylines("taken", lines), &mut Report::default());
    let classes = ink::classify(&ink, &base::Run::plain());
    let r = read_as(Some(kind), &ink, &classes, &mut Report::default());
    assert_eq!(r.validate().count(), 0);
    r
}

fn has_silhouette(ink: &ink::Ink) -> bool {
    Shaping::find(ink, &Reading::default()).is_some_and(|s| Silhouette::find(&Drawn::new(&s.lines)).is_some())
}

fn thick(r: &Reading) -> usize {
    r.axes.iter().filter(|a| !a.half_width.is_empty()).count()
}

#[test]
fn a_tree_of_bare_branches_has_no_crown_and_no_thorns() {
    // A trunk of two lines, and crooked twigs that enclose next to nothing.
    let trunk = [line((-0.6, 0.0), (-0.4, 5.0)), line((0.6, 0.0), (0.4, 5.0))];
    let twig = |k: i32| {
        let (side, y) = (if k % 2 == 0 { 1.0 } else { -1.0 }, 3.0 + 0.4 * f64::from(k));
        path(&[(side * 0.4, y), (side * 1.6, y + 0.6), (side * 1.9, y + 1.9)])
    };
    let lines: Vec<Vec<DVec2>> = trunk.into_iter().chain((0..6).map(twig)).collect();
    let ink = clean(&Drawing::from_polylines("bare tree", &lines), &mut Report::default());
    let said = |k| perhaps(if k < 2 { StrokeClass::TrunkOutline } else { StrokeClass::Crown }, 0.5);
    let classes: Vec<Classified> = (0..lines.len()).map(said).collect();
    let r = read_as(Some(Kind::Tree), &ink, &classes, &mut Report::default());
    assert_eq!(r.validate().count(), 0);
    assert_eq!(Kind::from_reading(&r), Kind::Tree);
    assert!(r.regions.is_empty() && r.thorns.is_empty() && r.leaves.is_empty(), "{:?}", r.strokes);
    assert!(r.axes.iter().filter(|a| a.bearer.is_some()).count() >= 6, "each twig is borne");
    // With its crown it is as before.
    let crown = [lines[..2].to_vec(), vec![circle((0.0, 6.5), 2.4)]].concat();
    let ink = clean(&Drawing::from_polylines("tree", &crown), &mut Report::default());
    let r = read_as(Some(Kind::Tree), &ink, &classes[..3], &mut Report::default());
    assert_eq!((Kind::from_reading(&r), r.regions.len()), (Kind::Tree, 1));
}

#[test]
fn a_fir_of_single_twigs_has_branches_on_both_sides() {
    let trunk = line((0.0, 0.0), (0.0, 10.0));
    let twig = |k: i32| {
        let (y, half) = (3.0 + 1.2 * f64::from(k), 3.4 - 0.5 * f64::from(k));
        path(&[(-half, y - 0.8), (0.0, y), (half, y - 0.8)])
    };
    let lines: Vec<Vec<DVec2>> = core::iter::once(trunk).chain((0..6).map(twig)).collect();
    let r = taken(Kind::Tree, &lines);
    assert!(r.woody && r.leaves.is_empty() && r.regions.is_empty(), "{:?}", r.strokes);
    assert_eq!(r.axes.iter().filter(|a| a.bearer.is_some()).count(), 12, "each twig is two branches");
}

#[test]
fn a_tree_in_one_line_is_cut_at_its_waist_and_bare_limbs_are_not() {
    // A trunk with a wide foot, half as wide as its crown.
    let waist = path(&[
        (-2.4, 0.0),
        (-1.2, 1.0),
        (-1.2, 3.0),
        (-3.0, 3.6),
        (-3.0, 6.4),
        (0.0, 7.6),
        (3.0, 6.4),
        (3.0, 3.6),
        (1.2, 3.0),
        (1.2, 1.0),
        (2.4, 0.0),
        (-2.4, 0.0),
    ]);
    let r = taken(Kind::Tree, &[waist]);
    assert_eq!((r.regions.len(), thick(&r)), (1, 1), "{:?}", r.strokes);
    assert_eq!(Kind::from_reading(&r), Kind::Tree);
    // Three limbs on a trunk, in one line.
    let limbs = path(&[
        (-1.0, 0.0),
        (-0.8, 4.0),
        (-3.6, 8.0),
        (-3.0, 8.4),
        (-0.3, 5.4),
        (-0.4, 9.4),
        (0.4, 9.4),
        (0.3, 5.4),
        (3.0, 8.4),
        (3.6, 8.0),
        (0.8, 4.0),
        (1.0, 0.0),
    ]);
    let r = taken(Kind::Tree, &[limbs]);
    assert_eq!((r.regions.len(), thick(&r), r.woody), (0, 3, true), "{:?}", r.strokes);
}

#[test]
fn lines_all_round_a_disc_are_the_petals_of_a_flower() {
    let ray = |k: i32| {
        let (s, c) = ops::sin_cos(ops::TAU * f64::from(k) / 12.0 + 0.1);
        line((1.1 * c, 8.0 + 1.1 * s), (3.0 * c, 8.0 + 3.0 * s))
    };
    let lines: Vec<Vec<DVec2>> =
        [circle((0.0, 8.0), 1.0), line((0.0, 0.0), (0.0, 7.0))].into_iter().chain((0..12).map(ray)).collect();
    let r = taken(Kind::Flower, &lines);
    assert_eq!(r.flowers.iter().map(|f| f.petals.len()).collect::<Vec<_>>(), [12], "{:?}", r.strokes);
    assert_eq!(r.axes.len(), 1, "the stem");
}

#[test]
fn rows_of_grass_are_no_flower() {
    let row = |x: f64| {
        path(&[
            (x, 0.0),
            (x + 0.4, 3.0),
            (x + 0.8, 0.6),
            (x + 1.3, 4.0),
            (x + 1.7, 0.4),
            (x + 2.2, 3.0),
            (x + 2.5, 0.0),
        ])
    };
    let r = taken(Kind::Grass, &[row(0.0), row(3.4), row(6.6)]);
    assert_eq!((r.flowers.len(), r.axes.len(), r.leaves.len()), (0, 0, 9), "{:?}", r.strokes);
}

#[test]
fn a_tree_of_many_open_arcs_is_read_by_its_silhouette() {
    let at = |c: (f64, f64), r: f64, a: f64| DVec2::new(c.0 + r * ops::cos(a), c.1 + r * ops::sin(a));
    let arc = |c: (f64, f64), from: f64| -> Vec<DVec2> {
        (0..=12).map(|i| at(c, 1.3, from - 1.3 + 2.6 * f64::from(i) / 12.0)).collect()
    };
    // Twelve arcs round a crown that meet nowhere, marks in it, two sides of a trunk, the ground.
    let mut lines: Vec<Vec<DVec2>> = (0..12)
        .map(|k| ops::TAU * (f64::from(k) + 0.5) / 12.0)
        .map(|a| arc((3.6 * ops::cos(a), 8.0 + 3.0 * ops::sin(a)), a))
        .collect();
    lines.extend((0..4).map(|k| arc((-1.5 + f64::from(k), 7.0 + f64::from(k % 2)), 1.0)));
    lines.push(path(&[(-0.8, 0.0), (-0.6, 2.0), (-0.7, 4.2)]));
    lines.push(path(&[(0.9, 0.0), (0.6, 2.0), (0.7, 4.2)]));
    lines.push(path(&[(-4.0, 0.1), (0.0, 0.0), (4.0, 0.1)]));
    let ink = clean(&Drawing::from_polylines("tree", &lines), &mut Report::default());
    let kept = RefCell::default();
    let mut draft = Draft::new(&ink, &[], &kept);
    let shaping = Shaping::find(&ink, &Reading::default()).expect("it has lines");
    let silhouette = || Silhouette::find(&Drawn::new(&shaping.lines)).expect("a tree");
    assert!(silhouette().fit(&Reading::default()) < 0.01, "nothing covers nothing");
    let fit = silhouette().fit(&taken(Kind::Tree, &lines));
    assert!(fit > 0.75, "what was read of it covers {fit}");
    silhouette().read(&shaping, &mut draft);
    let trunk = &draft.forest.axes[draft.bodies[0]];
    let (foot, top) = (trunk.points[0], trunk.points[trunk.points.len() - 1]);
    // Ink has diagonal 1; the trunk is a tenth as wide as it is high above the ground, and ends under the crown.
    let scale = ink.map.scale;
    assert!((foot.x - top.x).abs() < 0.4 * scale && (3.5..5.5).contains(&((top.y - foot.y) / scale)));
    assert!(trunk.half_width.iter().all(|w| (0.4..1.6).contains(&(w / scale))), "{:?}", trunk.half_width);
    let crown = signed_area(&draft.regions[0].outline) / (scale * scale);
    assert!((50.0..75.0).contains(&crown), "{crown}: the ellipse has {:.1}", ops::PI * 4.9 * 4.3);
    // A bare tree has no silhouette with a neck, and stays bare.
    let bare: Vec<Vec<DVec2>> = (0..9)
        .map(|k| at((0.0, 0.0), 6.0, 0.4 + 0.3 * f64::from(k)))
        .map(|tip| vec![DVec2::ZERO, tip * 0.5, tip])
        .chain([path(&[(0.0, -5.0), (0.0, 0.0)])])
        .collect();
    let ink = clean(&Drawing::from_polylines("bare", &bare), &mut Report::default());
    assert!(!has_silhouette(&ink));
    // Nor has a crown on a single line, whose branches enclose something between them.
    let crown: Vec<DVec2> = (0..=60).map(|i| at((0.0, 8.0), 3.0, ops::TAU * f64::from(i) / 60.0)).collect();
    let single = [
        crown,
        path(&[(0.0, 0.0), (0.0, 8.0)]),
        path(&[(0.0, 2.5), (-1.6, 3.6), (-2.0, 6.0)]),
        path(&[(0.0, 2.8), (1.6, 3.8), (2.0, 6.0)]),
    ];
    let ink = clean(&Drawing::from_polylines("single", &single), &mut Report::default());
    assert!(!has_silhouette(&ink));
}

#[test]
fn a_cap_and_the_lines_of_its_stem_are_one_body_and_a_stalk_is_none() {
    let cap: Vec<DVec2> = (0..=40)
        .map(|i| ops::TAU * f64::from(i) / 40.0 - 1.3)
        .map(|a| DVec2::new(4.0 * ops::cos(a), 6.0 + 2.0 * ops::sin(a)))
        .collect();
    // Foot, one side and the cap in one go; then the other side.
    let foot = path(&[(-0.9, 0.0), (0.9, 0.0), (0.9, 4.05)]);
    let r = taken(Kind::Vegetable, &[path(&[(-0.9, 0.1), (-0.8, 4.1)]), [foot, cap.clone()].concat()]);
    assert_eq!((r.fruits.len(), r.axes.len()), (1, 0), "{:?}", r.strokes);
    let (lo, hi) = geom::bounds(&r.fruits[0].outline).expect("a body");
    assert!((hi.y - lo.y) / (hi.x - lo.x) > 0.9, "the stem is of the body: {lo} to {hi}");
    let r = taken(Kind::Vegetable, &[cap, path(&[(0.0, 8.0), (0.2, 9.6)])]);
    let (lo, hi) = geom::bounds(&r.fruits[0].outline).expect("a body");
    assert!((hi.y - lo.y) / (hi.x - lo.x) < 0.6, "the stalk is not: {lo} to {hi}");
}

#[test]
fn the_tuft_on_a_fruit_is_leaves() {
    let around = |a: f64, r: f64| DVec2::new(r * ops::cos(a), r * ops::sin(a));
    let body: Vec<DVec2> =
        (0..=40).map(|i| around(ops::TAU * f64::from(i) / 40.0, 3.0) * DVec2::new(0.7, 1.0)).collect();
    // Five points in one stroke, from the top of the body and back to it.
    let tuft: Vec<DVec2> = (0..=10)
        .map(|i| (0.35 + 0.24 * f64::from(i), if i % 2 == 0 { 0.6 } else { 3.2 }))
        .map(|(a, r)| DVec2::new(0.0, 3.0) + around(a, r))
        .collect();
    let ink = clean(&Drawing::from_polylines("pineapple", &[body, tuft]), &mut Report::default());
    let classes = ink::classify(&ink, &base::Run::plain());
    for kind in [Kind::Fruit, Kind::Vegetable] {
        let r = read_as(Some(kind), &ink, &classes, &mut Report::default());
        assert_eq!((r.fruits.len(), r.flowers.len()), (1, 0), "{:?}", r.strokes);
        assert!(r.leaves.len() >= 4, "{:?}", r.strokes);
    }
}

/// Half of a ring about (0, 3), from its top down on one side.
fn half(side: f64) -> Vec<DVec2> {
    let at = |k: i32| ops::sin_cos(ops::PI * f64::from(k) / 30.0);
    (0..=30).map(at).map(|(s, c)| DVec2::new(side * 2.4 * s, 3.0 + 3.0 * c)).collect()
}

#[test]
fn two_halves_are_one_fruit_and_two_arcs_apart_are_two() {
    use StrokeClass::{Axis, Fruit};
    let count = |lines: &[Vec<DVec2>]| {
        let ink = clean(&Drawing::from_polylines("apple", lines), &mut Report::default());
        let classes: Vec<Classified> =
            (0..lines.len()).map(|k| Classified::by_user(if k < 2 { Fruit } else { Axis })).collect();
        read(&ink, &classes, &mut Report::default()).fruits.len()
    };
    let stalk = line((0.0, 6.0), (0.3, 7.5));
    assert_eq!(count(&[half(1.0), half(-1.0), stalk.clone()]), 1);
    let away =
        |x: f64, line: Vec<DVec2>| line.into_iter().map(|p| p + DVec2::new(x, 0.0)).collect::<Vec<_>>();
    assert_eq!(count(&[away(4.0, half(1.0)), away(-4.0, half(-1.0)), stalk]), 2);
}

#[test]
fn a_leaf_on_a_fruit_is_no_body_and_an_open_stem_below_a_cap_is_one() {
    let body = circle((0.0, 3.0), 3.0);
    let leaf = leaf((0.0, 6.0), (3.5, 9.0), 2.4);
    let r = taken(Kind::Fruit, &[body, leaf]);
    assert_eq!((r.fruits.len(), r.leaves.len()), (1, 1), "{:?}", r.strokes);
    let cap: Vec<DVec2> = path(&[(3.0, 4.0), (-3.0, 4.0)])
        .into_iter()
        .chain(
            (0..=30)
                .map(|k| ops::sin_cos(ops::PI * f64::from(k) / 30.0))
                .map(|(s, c)| DVec2::new(-3.0 * c, 4.0 + 2.5 * s)),
        )
        .collect();
    let sides = [line((-0.8, 3.9), (-0.9, 0.0)), line((0.8, 3.9), (0.9, 0.1))];
    let cup = path(&[(-0.8, 3.9), (-0.9, 0.0), (0.9, 0.0), (0.8, 3.9)]);
    for stem in [sides.to_vec(), vec![cup]] {
        let r = taken(Kind::Vegetable, &[vec![cap.clone()], stem].concat());
        assert_eq!((r.fruits.len(), r.axes.len()), (2, 0), "{:?}", r.strokes);
    }
    // One root is no stem.
    let r = taken(Kind::Vegetable, &[cap, line((0.0, 3.9), (0.1, 0.0))]);
    assert_eq!(r.fruits.len(), 1, "{:?}", r.strokes);
}

#[test]
fn a_leaf_on_a_bunch_is_no_berry() {
    let mut lines: Vec<Vec<DVec2>> =
        (0..6).map(|k| circle((2.0 * f64::from(k % 3), 2.0 * f64::from(k / 3)), 0.95)).collect();
    lines.push(leaf((2.0, 3.2), (6.5, 5.0), 1.8));
    let r = taken(Kind::Fruit, &lines);
    assert_eq!((r.fruits.len(), r.leaves.len()), (6, 1), "{:?}", r.strokes);
}

#[test]
fn a_bare_tree_in_lines_around_its_limbs_has_a_trunk_and_limbs() {
    let lines = [
        path(&[(-1.0, 0.0), (-0.8, 4.0), (-3.6, 7.0)]),
        path(&[(-3.2, 7.4), (-0.5, 5.0), (-0.4, 9.0)]),
        path(&[(0.4, 9.0), (0.5, 5.0), (3.2, 7.4)]),
        path(&[(3.6, 7.0), (0.8, 4.0), (1.0, 0.0)]),
    ];
    let r = taken(Kind::Tree, &lines);
    assert!(r.woody && r.regions.is_empty(), "{:?}", r.strokes);
    assert_eq!((thick(&r), r.axes.len()), (3, 3), "a trunk that goes on, and a limb on each side");
    let highest = r.axes.iter().flat_map(|a| &a.points).map(|p| p.y).fold(0.0, f64::max);
    let tallest = r.axes.iter().map(|a| a.half_width.iter().copied().fold(0.0, f64::max)).fold(0.0, f64::max);
    assert!(tallest < 0.25 * highest, "no ball of wood: {tallest}");
}

#[test]
fn cacti_have_no_wood() {
    let column = path(&[(-1.0, 0.0), (-1.0, 6.0), (0.0, 7.0), (1.0, 6.0), (1.0, 0.0)]);
    let arm = path(&[(1.0, 3.0), (3.0, 3.0), (3.0, 5.0)]);
    let twigs = [line((3.0, 4.0), (4.0, 4.6)), line((3.5, 4.3), (3.6, 5.2))];
    let lines = [vec![column, arm], twigs.to_vec()].concat();
    let r = taken(Kind::Cactus, &lines);
    assert!(!r.woody && r.axes.iter().all(|a| a.kind != AxisKind::Branch), "{:?}", r.axes);
}

#[test]
fn a_foot_that_flares_is_as_wide_as_it_was_drawn_and_no_roots() {
    use StrokeClass::{Crown, TrunkOutline};
    let flared = path(&[
        (-4.0, 0.0),
        (-1.5, 1.0),
        (-1.0, 3.0),
        (-0.9, 7.0),
        (0.9, 7.0),
        (1.0, 3.0),
        (1.5, 1.0),
        (4.0, 0.0),
        (0.0, 0.3),
        (-4.0, 0.0),
    ]);
    let (r, _) = reading(&[(Crown, circle((0.0, 10.0), 4.0)), (TrunkOutline, flared)]);
    assert_eq!(thick(&r), 1, "{:?}", r.axes);
    let trunk = r.axes.iter().find(|a| !a.half_width.is_empty()).expect("a trunk");
    let (foot, middle) = (trunk.half_width[0], trunk.half_width[trunk.half_width.len() / 2]);
    assert!(foot > 1.3 * middle, "{:?}", trunk.half_width);
}

#[test]
fn a_short_trunk_with_an_outline_makes_a_tree_and_a_short_line_a_bush() {
    use StrokeClass::{Axis, Crown, TrunkOutline};
    let crown = circle((0.0, 5.0), 4.5);
    let sides = path(&[(-0.6, 1.8), (-0.7, 0.0), (0.7, 0.0), (0.6, 1.8)]);
    assert_eq!(Kind::from_reading(&reading(&[(Crown, crown.clone()), (TrunkOutline, sides)]).0), Kind::Tree);
    assert_eq!(
        Kind::from_reading(&reading(&[(Crown, crown), (Axis, line((0.0, 1.8), (0.0, 0.0)))]).0),
        Kind::Bush
    );
}

#[test]
fn the_sides_of_a_bare_trunk_run_on_into_limbs() {
    // A line for each limb, between the two that the sides become.
    let left = path(&[(-1.0, 0.0), (-0.6, 1.5), (-0.6, 4.0), (-3.4, 7.6)]);
    let right = left.iter().map(|p| DVec2::new(-p.x, p.y)).collect();
    let limbs = [
        line((-0.4, 4.4), (-2.0, 8.4)),
        line((-0.1, 4.6), (-0.4, 8.6)),
        line((0.2, 4.6), (0.8, 8.5)),
        line((0.5, 4.4), (2.2, 8.2)),
        line((-2.0, 5.8), (-3.8, 5.9)),
        line((2.0, 5.8), (3.9, 5.8)),
    ];
    let lines = [vec![left, right], limbs.to_vec()].concat();
    let ink = clean(&Drawing::from_polylines("bare", &lines), &mut Report::default());
    let kept = RefCell::default();
    let mut draft = Draft::new(&ink, &[], &kept);
    let shaping = Shaping::find(&ink, &Reading::default()).expect("it has lines");
    let wood = BareWood::find(&Drawn::new(&shaping.lines), &Reading::default()).expect("a trunk");
    assert!(wood.fit(&Reading::default()) < 0.01, "nothing covers nothing");
    wood.read(&shaping, &mut draft);
    let (scale, trunk) = (ink.map.scale, &draft.forest.axes[draft.bodies[0]]);
    let (foot, points) = (trunk.points[0].y, &trunk.points);
    let at = |y: f64| points.iter().position(|p| p.y - foot > y * scale).expect("so high");
    let half = trunk.half_width[at(3.0)] / scale;
    assert!((half - 0.6).abs() < 0.15, "{half}");
    let top = (points[points.len() - 1].y - foot) / scale;
    assert!(top > 3.5 && top < 6.5, "it ends where the limbs part: {top}");
    assert_eq!(draft.lines.len(), 8, "both sides go on, and six lines");
}

#[test]
fn a_wide_arc_under_everything_is_a_hill_and_the_foot_of_a_trunk_is_none() {
    let arc = |wide: f64, tall: f64| -> Vec<DVec2> {
        let at = |k: i32| ops::PI * f64::from(k) / 40.0;
        (0..=40).map(|k| DVec2::new(-wide * ops::cos(at(k)), tall * ops::sin(at(k)))).collect()
    };
    let tree = [line((-0.4, 2.0), (-0.4, 4.0)), line((0.4, 2.0), (0.4, 4.0)), circle((0.0, 6.0), 2.2)];
    let r = taken(Kind::Tree, &[vec![arc(5.0, 2.0)], tree.to_vec()].concat());
    assert_eq!(r.strokes[0].class, StrokeClass::Ground);
    assert_eq!((r.regions.len(), thick(&r)), (1, 1), "{:?}", r.strokes);
    // A trunk in one line, whose foot is as wide as its crown.
    let bell = path(&[(-2.2, 0.0), (-0.6, 1.0), (-0.5, 3.8), (0.5, 3.8), (0.6, 1.0), (2.2, 0.0)]);
    let r = taken(Kind::Tree, &[bell, circle((0.0, 6.0), 2.2)]);
    assert_eq!(r.strokes[0].class, StrokeClass::TrunkOutline);
}

#[test]
fn a_line_that_leaves_a_crown_and_comes_back_is_a_lobe_of_it_and_one_that_ends_outside_is_a_branch() {
    let tree = [line((-0.4, 0.0), (-0.4, 4.2)), line((0.4, 0.0), (0.4, 4.2)), circle((0.0, 6.0), 2.2)];
    let kinds = [StrokeClass::TrunkOutline, StrokeClass::TrunkOutline, StrokeClass::Crown, StrokeClass::Axis];
    let read_with = |more: &[DVec2], said: fn(StrokeClass) -> Classified| {
        let lines = [&tree[..], &[more.to_vec()]].concat();
        let ink = clean(&Drawing::from_polylines("tree", &lines), &mut Report::default());
        read(&ink, &kinds.map(said), &mut Report::default())
    };
    let unsure = |class| perhaps(class, 0.5);
    let ear = path(&[(-1.4, 7.0), (-2.6, 8.4), (-1.6, 9.6), (-0.4, 8.9), (-0.4, 7.6)]);
    let lobe = read_with(&ear, unsure);
    let branch = read_with(&line((1.0, 6.0), (4.0, 8.0)), unsure);
    assert_eq!(read_with(&ear, Classified::by_user).strokes[3].class, StrokeClass::Axis, "the user knows");
    assert_eq!(lobe.strokes[3].class, StrokeClass::Crown);
    assert_eq!(branch.strokes[3].class, StrokeClass::Axis);
    let tall = |r: &Reading| {
        geom::bounds(&r.regions[0].outline).map_or(0.0, |b| (b.1.y - b.0.y) / r.plants[0].height)
    };
    // The crown has 5.8 of the 9.6 of the drawing with a lobe.
    assert!((tall(&lobe) - 5.8 / 9.6).abs() < 0.03, "the crown reaches as high as the lobe: {}", tall(&lobe));
}

#[test]
fn fronds_of_a_palm_may_begin_beside_the_top_of_its_trunk() {
    let trunk = [line((-0.4, 0.0), (-0.3, 6.0)), line((0.4, 0.0), (0.3, 6.0))];
    let frond = |k: i32| {
        let (side, up) = (if k % 2 == 0 { 1.0 } else { -1.0 }, 0.4 * f64::from(k));
        path(&[(side * 1.0, 6.2), (side * 2.4, 6.6 + up), (side * 3.6, 5.4 + up)])
    };
    let lines: Vec<Vec<DVec2>> = trunk.into_iter().chain((0..5).map(frond)).collect();
    let r = taken(Kind::Palm, &lines);
    assert_eq!((r.leaves.len(), thick(&r)), (5, 1), "{:?}", r.strokes);
}

#[test]
fn a_tree_that_came_apart_keeps_its_roots() {
    let side = |x: f64| [line((x, 0.0), (x, 1.8)), line((1.1 * x, 2.0), (x, 4.0))];
    let arcs = (0..10).map(|k| {
        let at = |i: i32| ops::TAU * (f64::from(k) + 0.94 * f64::from(i) / 12.0) / 10.0;
        let place = |a: f64| DVec2::new(0.0, 6.0) + 2.3 * DVec2::new(ops::cos(a), ops::sin(a));
        (0..=12).map(|i| place(at(i))).collect()
    });
    let roots = [line((-0.4, -0.1), (-1.6, -1.8)), line((0.4, -0.1), (1.5, -1.6))];
    let lines: Vec<Vec<DVec2>> =
        arcs.chain(side(-0.5)).chain(side(0.5)).chain([line((-3.0, 0.0), (3.0, 0.0))]).chain(roots).collect();
    let ink = clean(&Drawing::from_polylines("rooted", &lines), &mut Report::default());
    let class = |k: usize| match k {
        14 => StrokeClass::Ground,
        15 | 16 => StrokeClass::Axis,
        _ => StrokeClass::Other,
    };
    let classes: Vec<Classified> = (0..lines.len()).map(|k| Classified::by_user(class(k))).collect();
    let known = read(&ink, &classes, &mut Report::default());
    let roots = known.axes.iter().filter(|a| a.kind == AxisKind::Root).count();
    assert_eq!(roots, 2, "{:?}", known.strokes);
    let kept = RefCell::default();
    let mut draft = Draft::new(&ink, &classes, &kept);
    let shaping = Shaping::find(&ink, &known).expect("it has lines");
    let silhouette = Silhouette::find(&Drawn::new(&shaping.lines)).expect("a trunk and a crown");
    silhouette.read(&shaping, &mut draft);
    assert_eq!((draft.regions.len(), draft.bodies.len(), draft.lines.len()), (1, 1, 2));
    let foot = draft.forest.axes[draft.bodies[0]].points[0].y;
    let ground = ink.strokes[14].points[0].y;
    assert!((foot - ground).abs() < 0.02, "it stands on the ground: {foot}, {ground}");
}
