use base::ops;
use ink::Drawing;

use geom::polyline_length;

use super::*;

/// Many short lines that run away from a middle, from a share of the radius outwards.
fn hatched(middle: DVec2, radius: impl Fn(f64) -> f64) -> Vec<Vec<DVec2>> {
    let line = |k: u32| {
        let angle = ops::TAU * f64::from(k) / 90.0;
        let way = DVec2::new(ops::cos(angle), ops::sin(angle));
        let from = if k.is_multiple_of(2) { 0.15 } else { 0.55 };
        [from, from + 0.2, from + 0.4].map(|share| middle + way * share * radius(angle)).to_vec()
    };
    (0..90).map(line).collect()
}

fn rim(middle: DVec2, radius: impl Fn(f64) -> f64) -> Vec<DVec2> {
    let at = |k: u32| {
        let angle = ops::TAU * f64::from(k) / 180.0;
        middle + DVec2::new(ops::cos(angle), ops::sin(angle)) * radius(angle)
    };
    (0..=180).map(at).collect()
}

fn proposed(lines: &[Vec<DVec2>]) -> Option<Proposal> {
    propose(&ink::clean(&Drawing::from_polylines("test", lines), &mut base::Report::default()))
}

fn count(proposal: &Proposal, class: StrokeClass) -> usize {
    proposal.parts.iter().filter(|p| p.class == class).count()
}

/// A head with its rim in pieces, on a stem with two sides.
fn head_on_stem(radius: impl Fn(f64) -> f64 + Copy) -> Vec<Vec<DVec2>> {
    let middle = DVec2::new(0.0, 10.0);
    let mut lines = hatched(middle, radius);
    lines.extend(rim(middle, radius).chunks(13).map(<[DVec2]>::to_vec));
    for x in [-0.12, 0.12] {
        lines.push(vec![DVec2::new(x, 0.0), DVec2::new(x, 10.0 - radius(-0.25 * ops::TAU))]);
    }
    lines
}

#[test]
fn a_hatched_head_with_lobes_is_a_flower_of_as_many_petals_on_its_stem() {
    let radius = |angle: f64| 3.0 + 0.8 * ops::cos(5.0 * angle);
    let flower = proposed(&head_on_stem(radius)).expect("a head");
    assert_eq!(flower.kind, Kind::Flower);
    assert_eq!((count(&flower, StrokeClass::Blade), count(&flower, StrokeClass::Disc)), (5, 1));
    let stem = flower.parts.iter().find(|p| p.class == StrokeClass::Axis).expect("a stem");
    assert!(polyline_length(&stem.points) > 0.3, "{:?}", stem.points);
}

#[test]
fn a_hatched_head_without_lobes_has_rays() {
    let flower = proposed(&head_on_stem(|_| 3.0)).expect("a head");
    assert_eq!(count(&flower, StrokeClass::Blade), MASSES.rays);
}

#[test]
fn lines_round_a_middle_or_in_all_directions_are_no_flower() {
    let rings: Vec<Vec<DVec2>> = (1..30).map(|k| rim(DVec2::ZERO, |_| 0.1 * f64::from(k))).collect();
    assert!(proposed(&rings).is_none());
    assert!(proposed(&[]).is_none() && proposed(&[vec![DVec2::ZERO, DVec2::X]]).is_none());
}

#[test]
fn a_stem_is_found_between_two_masses() {
    let square = |x: f64| {
        [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0], [0.0, 0.0]]
            .map(|p| DVec2::from(p) + DVec2::X * x)
            .to_vec()
    };
    let between = vec![DVec2::new(2.0, 1.0), DVec2::new(6.0, 1.0)];
    let lines = [square(0.0), square(6.0), between];
    let drawing = Drawing::from_polylines("test", &lines);
    let ink = ink::clean(&drawing, &mut base::Report::default());
    let lines: Vec<&[DVec2]> = ink.strokes.iter().map(|s| s.points.as_slice()).collect();
    let areas = Areas::new(&lines).expect("lines have an extent");
    assert_eq!((areas.masses.len(), areas.stems.len()), (2, 1));
    let strokes = |rows: &[usize]| rows.to_vec();
    assert_eq!(strokes(&areas.stems[0].strokes), [2]);
}

#[test]
fn pieces_beyond_a_few_are_texture() {
    // Flecks too far apart to be one area, each a piece of its own.
    let fleck = |k: u32| {
        let at = DVec2::new(f64::from(k % 38), f64::from(k / 38)) * 26.0;
        vec![at, at + DVec2::new(4.0, 0.0), at + DVec2::new(2.0, 3.0)]
    };
    let lines: Vec<Vec<DVec2>> = (0..1444).map(fleck).collect();
    let drawing = Drawing::from_polylines("test", &lines);
    let ink = ink::clean(&drawing, &mut base::Report::default());
    let lines: Vec<&[DVec2]> = ink.strokes.iter().map(|s| s.points.as_slice()).collect();
    let areas = Areas::new(&lines).expect("lines have an extent");
    assert!(areas.masses.len() <= MASSES.most && areas.stems.len() <= MASSES.most);
    assert!(propose(&ink).is_none());
}
