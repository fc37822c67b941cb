use base::ops;
use ink::Drawing;

use super::*;

const GREEN: [u8; 3] = [90, 160, 60];
const RED: [u8; 3] = [230, 50, 50];
const YELLOW: [u8; 3] = [250, 205, 60];
const BROWN: [u8; 3] = [110, 70, 45];

fn p(x: f64, y: f64) -> DVec2 {
    DVec2::new(x, y)
}

/// An ellipse about a middle, its longer half axis in a direction.
fn ellipse(middle: DVec2, half: DVec2, width: f64) -> Vec<DVec2> {
    let across = half.perp().normalize() * width;
    (0..=48)
        .map(|k| ops::sin_cos(ops::TAU * f64::from(k) / 48.0))
        .map(|(s, c)| middle + half * c + across * s)
        .collect()
}

/// A leaf with two corners, from its root to its tip.
fn leaf(root: DVec2, tip: DVec2) -> Vec<DVec2> {
    let across = (tip - root).perp() * 0.25;
    let side = |sign: f64| {
        move |k: i32| {
            let t = f64::from(k) / 24.0;
            root.lerp(tip, t) + across * (sign * 4.0 * t * (1.0 - t))
        }
    };
    (0..=24).map(side(1.0)).chain((0..24).rev().map(side(-1.0))).collect()
}

fn painted(lines: &[(Vec<DVec2>, [u8; 3])]) -> Ink {
    let points: Vec<Vec<DVec2>> = lines.iter().map(|l| l.0.clone()).collect();
    let mut drawing = Drawing::from_polylines("test", &points);
    drawing.strokes.iter_mut().zip(lines).for_each(|(stroke, line)| stroke.color = Some(line.1));
    ink::clean(&drawing, &mut base::Report::default())
}

fn count(proposal: &Proposal, class: StrokeClass) -> usize {
    proposal.parts.iter().filter(|p| p.class == class).count()
}

/// Two cherries on stalks, with a leaf where these meet.
fn cherries() -> Vec<(Vec<DVec2>, [u8; 3])> {
    vec![
        (vec![p(4.0, 9.0), p(3.0, 6.5), p(2.0, 3.5)], GREEN),
        (vec![p(4.0, 9.0), p(5.2, 6.5), p(6.0, 3.5)], GREEN),
        (leaf(p(4.0, 9.0), p(8.0, 9.5)), GREEN),
        (ellipse(p(2.0, 2.0), p(1.5, 0.0), 1.5), RED),
        (ellipse(p(6.0, 2.0), p(1.5, 0.0), 1.5), RED),
    ]
}

#[test]
fn red_discs_that_hang_on_green_lines_are_fruits() {
    let plant = propose(&painted(&cherries())).expect("a plant");
    assert_eq!(plant.kind, Kind::Fruit);
    let counts = [StrokeClass::Fruit, StrokeClass::Axis, StrokeClass::Blade].map(|c| count(&plant, c));
    assert_eq!(counts, [2, 2, 1]);
}

#[test]
fn a_leaf_is_attached_where_it_touches_the_end_of_a_stem() {
    let ink = painted(&cherries());
    let plant = propose(&ink).expect("a plant");
    let leaf = plant.parts.iter().find(|p| p.class == StrokeClass::Blade).expect("a leaf");
    let root = ink.map.to_drawing(leaf.root.expect("a root"));
    assert!(root.distance(p(4.0, 9.0)) < 0.3, "{root:?}");
}

#[test]
fn petals_round_a_disc_on_a_stem_are_a_flower_from_the_front() {
    let middle = p(4.0, 8.0);
    let petal = |k: u32| {
        let (s, c) = ops::sin_cos(ops::TAU * f64::from(k) / 7.0);
        (ellipse(middle + p(c, s) * 2.2, p(c, s) * 1.2, 0.7), RED)
    };
    let mut lines: Vec<_> = (0..7).map(petal).collect();
    lines.push((ellipse(middle, p(0.9, 0.0), 0.9), YELLOW));
    lines.push((vec![p(4.0, 7.0), p(4.0, 0.0)], GREEN));
    lines.push((leaf(p(4.0, 2.0), p(7.0, 4.0)), GREEN));
    let plant = propose(&painted(&lines)).expect("a plant");
    assert_eq!((plant.kind, plant.heads.len()), (Kind::Flower, 1));
    assert_eq!(plant.heads[0].len(), 8);
    assert_eq!(count(&plant, StrokeClass::Disc), 1);
    // The leaf is no petal.
    assert_eq!(count(&plant, StrokeClass::Blade), 8);
}

#[test]
fn a_corolla_in_one_area_has_a_petal_for_each_lobe() {
    let lobed = (0..=120).map(|k| {
        let angle = ops::TAU * f64::from(k) / 120.0;
        let (s, c) = ops::sin_cos(angle);
        p(4.0, 8.0) + p(c, s) * (2.5 + 0.7 * ops::cos(5.0 * angle))
    });
    let lines = [
        (lobed.collect(), RED),
        (ellipse(p(4.0, 8.0), p(0.8, 0.0), 0.8), YELLOW),
        (vec![p(4.0, 5.2), p(4.0, 0.0)], GREEN),
    ];
    let plant = propose(&painted(&lines)).expect("a plant");
    assert_eq!((plant.kind, count(&plant, StrokeClass::Blade)), (Kind::Flower, 5));
}

#[test]
fn a_tree_is_left_to_other_readers() {
    let trunk = vec![p(3.0, 0.0), p(5.0, 0.0), p(4.6, 5.0), p(3.4, 5.0), p(3.0, 0.0)];
    let lines = [(trunk, BROWN), (ellipse(p(4.0, 8.0), p(3.0, 0.0), 3.0), GREEN)];
    assert!(propose(&painted(&lines)).is_none());
}

#[test]
fn without_colours_nothing_is_proposed() {
    let ink = |color: [u8; 3]| {
        let lines: Vec<_> = cherries().into_iter().map(|(line, _)| (line, color)).collect();
        painted(&lines)
    };
    assert!(propose(&ink([20, 20, 20])).is_none());
    assert!(propose(&ink(GREEN)).is_none());
}

#[test]
fn a_rim_round_green_lines_is_no_leaf() {
    // A stem with a branch, and an outline at the same distance from both all round.
    let stem = [p(0.0, 0.0), p(0.0, 10.0)];
    let rim = [
        p(-1.0, -1.0),
        p(1.0, -1.0),
        p(1.0, 4.0),
        p(5.0, 4.0),
        p(5.0, 6.0),
        p(1.0, 6.0),
        p(1.0, 11.0),
        p(-1.0, 11.0),
        p(-1.0, -1.0),
    ];
    let lines = [
        (rim.to_vec(), [40, 90, 40]),
        (stem.to_vec(), GREEN),
        (vec![p(0.0, 5.0), p(4.0, 5.0)], GREEN),
        (ellipse(p(0.0, 12.5), p(1.4, 0.0), 1.4), RED),
    ];
    let plant = propose(&painted(&lines)).expect("a plant");
    assert!(plant.parts.iter().all(|p| p.strokes != [0]), "{plant:?}");
}

#[test]
fn colours_contradict_green_petals_and_red_crowns() {
    use crate::{OrganWord, Reading, StrokeReading};
    let ink = painted(&cherries());
    let read = |organs: [OrganWord; 5]| Reading {
        strokes: (0..5)
            .zip(organs)
            .map(|(index, organ)| StrokeReading { organ, ..StrokeReading::left_out(index) })
            .collect(),
        ..Reading::default()
    };
    let (stem, fruit) = (OrganWord::Branch, OrganWord::Fruit);
    let right = read([stem, stem, OrganWord::Leaf, fruit, fruit]);
    let colours = Colours::new(&ink).expect("colours of a plant");
    assert!(colours.contradicted(&right, Kind::Fruit) == 0.0);
    let crown = OrganWord::LeafContour;
    let wrong = read([stem, stem, OrganWord::Petal, crown, crown]);
    assert!(colours.contradicted(&wrong, Kind::Tree) > 0.9);
}

#[test]
fn an_icon_in_shades_of_blue_says_nothing_by_its_colours() {
    let shades = [[40, 110, 250], [150, 190, 250]];
    let lines: Vec<_> =
        cherries().into_iter().enumerate().map(|(k, (line, _))| (line, shades[k % 2])).collect();
    assert!(propose(&painted(&lines)).is_none());
}
