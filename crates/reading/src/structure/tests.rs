//! A rosette of petals that hide one another, a cone with scales, and a careless doodle.

use base::{Report, ops};
use glam::DVec2;
use ink::{Classified, Drawing, StrokeClass, clean};

use super::sheet::{Form, Sheet};
use super::{LIMITS, Structure, score};
use crate::{Kind, read};

const TAU: f64 = std::f64::consts::TAU;

fn polar(angle: f64, radius: f64) -> DVec2 {
    DVec2::new(radius * ops::cos(angle), radius * ops::sin(angle))
}

fn straight(from: (f64, f64), to: (f64, f64)) -> Vec<DVec2> {
    let (from, to) = (DVec2::from(from), DVec2::from(to));
    (0..=40).map(|i| from.lerp(to, f64::from(i) / 40.0)).collect()
}

/// A ring of arcs, each from the end of the one before to the start of the next, round the middle.
fn arcs(count: u32, radius: f64, height: f64, phase: f64) -> Vec<Vec<DVec2>> {
    let step = TAU / f64::from(count);
    (0..count)
        .map(|k| {
            let from = phase + step * f64::from(k);
            let bulge = |t: f64| radius + height * (4.0 * t * (1.0 - t)).sqrt();
            (0..=24).map(|i| f64::from(i) / 24.0).map(|t| polar(from + step * t, bulge(t))).collect()
        })
        .collect()
}

/// A disc in two rings of petals, hidden lines removed.
fn rosette() -> Vec<Vec<DVec2>> {
    let disc = (0..=60).map(|k| polar(TAU * f64::from(k) / 60.0, 0.2)).collect();
    let mut lines = vec![disc];
    lines.extend(arcs(8, 0.2, 0.12, 0.0));
    lines
}

#[test]
fn petals_that_go_on_behind_a_disc_are_bays_with_hidden_roots() {
    let ink = clean(&Drawing::from_polylines("rosette", &rosette()), &mut Report::default());
    let sheet = Sheet::new(&ink);
    let forms: Vec<Form> = sheet.facts.iter().map(|f| f.form).collect();
    assert_eq!(forms[0], Form::Ring);
    assert!(forms[1..].iter().all(|f| *f == Form::Bay), "{forms:?}");
    assert!(sheet.is_careful());
    assert_eq!(sheet.alike(1).len(), 8, "the petals are alike, and the disc is none of them");
    let said = vec![Classified::by_shares([0.0; StrokeClass::ALL.len()]); ink.strokes.len()];
    assert!(Structure::new(&sheet, &[], &said).differs(&said));
}

#[test]
fn petals_drawn_behind_a_disc_become_petals() {
    let ink = clean(&Drawing::from_polylines("rosette", &rosette()), &mut Report::default());
    let classes = ink::classify(&ink, &base::Run::plain());
    let reading = read(&ink, &classes, &mut Report::default());
    let organs = reading.flowers.iter().map(|f| f.petals.len()).sum::<usize>() + reading.leaves.len();
    assert!(organs >= 8, "{organs} petals and leaves, {:?}", Kind::from_reading(&reading));
    assert_eq!(reading.validate().count(), 0);
    let sheet = Sheet::new(&ink);
    assert!(score(&ink, &sheet, &reading, &[]) > 0.9);
}

#[test]
fn marks_in_an_outline_are_texture_if_there_are_many_and_veins_if_few() {
    let body: Vec<DVec2> = (0..=60).map(|k| polar(TAU * f64::from(k) / 60.0, 1.0)).collect();
    let mark = |k: usize| {
        let y = -0.6 + 0.15 * k as f64;
        vec![DVec2::new(-0.2, y), DVec2::new(0.0, y + 0.02), DVec2::new(0.2, y)]
    };
    for (marks, want) in [(3, StrokeClass::Vein), (LIMITS.texture + 1, StrokeClass::Scribble)] {
        let lines: Vec<Vec<DVec2>> = std::iter::once(body.clone()).chain((0..marks).map(mark)).collect();
        let ink = clean(&Drawing::from_polylines("body", &lines), &mut Report::default());
        let sheet = Sheet::new(&ink);
        assert_eq!(sheet.facts[0].marks, marks);
        assert!(sheet.facts[1..].iter().all(|f| f.holder == Some(0)));
        let said = vec![Classified::default(); ink.strokes.len()];
        let classes = Structure::new(&sheet, &[], &said).classes().to_vec();
        assert!(classes[1..].iter().all(|c| *c == Some(want)), "{marks}: {classes:?}");
    }
}

#[test]
fn lines_that_stop_short_of_one_another_are_no_structure() {
    let lines: Vec<Vec<DVec2>> = arcs(8, 0.2, 0.25, 0.0)
        .into_iter()
        .enumerate()
        .map(|(k, line)| line.into_iter().map(|p| p + polar(k as f64, 0.05)).collect())
        .collect();
    let ink = clean(&Drawing::from_polylines("doodle", &lines), &mut Report::default());
    assert!(!Sheet::new(&ink).is_careful());
}

#[test]
fn classes_of_the_user_stay() {
    let ink = clean(&Drawing::from_polylines("rosette", &rosette()), &mut Report::default());
    let said = vec![Classified::by_user(StrokeClass::Axis); ink.strokes.len()];
    let structure = Structure::new(&Sheet::new(&ink), &[], &said);
    assert!(!structure.differs(&said));
}

#[test]
fn lines_side_by_side_up_a_stem_are_one_and_hatching_is_none() {
    let upright = |x: f64| straight((x, 0.0), (x + 1.0, 60.0));
    let tubes_of = |lines: &[Vec<DVec2>]| {
        let ink = clean(&Drawing::from_polylines("sheaths", lines), &mut Report::default());
        super::tubes(&ink, &Sheet::new(&ink))
    };
    let found = tubes_of(&[0.0, 1.5, 3.0, 4.5].map(upright));
    assert_eq!(found.len(), 1);
    assert_eq!((found[0].sides, found[0].between.len()), ([0, 3], 2));
    // Short strokes side by side, and more than a stem has, are hatching.
    let short: Vec<Vec<DVec2>> =
        (0..4).map(|k| straight((2.0 * f64::from(k), 0.0), (2.0 * f64::from(k), 9.0))).collect();
    let mut lines = vec![straight((30.0, 0.0), (30.0, 60.0))];
    lines.extend(short);
    assert!(tubes_of(&lines).is_empty());
    let many: Vec<Vec<DVec2>> = (0..9).map(|k| upright(0.8 * f64::from(k))).collect();
    assert!(tubes_of(&many).is_empty());
}

/// A flower of three petals round a small ring, hidden lines removed.
fn orchid(centre: DVec2) -> Vec<Vec<DVec2>> {
    let ring: Vec<DVec2> = (0..=30).map(|k| centre + polar(TAU * f64::from(k) / 30.0, 0.06)).collect();
    let petal = |k: i32| {
        let way = TAU * f64::from(k) / 3.0;
        let middle = centre + polar(way, 0.31);
        (0..=40).map(|i| middle + polar(way + TAU * f64::from(i) / 40.0, 0.25)).collect()
    };
    let mut lines = vec![ring];
    lines.extend((0..3).map(petal));
    lines
}

#[test]
fn small_rings_where_petals_meet_are_discs_and_rings_on_stalks_are_none() {
    let classes_of = |lines: &[Vec<DVec2>]| {
        let ink = clean(&Drawing::from_polylines("spray", lines), &mut Report::default());
        let said = vec![Classified::by_shares([0.0; StrokeClass::ALL.len()]); ink.strokes.len()];
        Structure::new(&Sheet::new(&ink), &[], &said).classes().to_vec()
    };
    let flowers: Vec<Vec<DVec2>> = (0..4).flat_map(|k| orchid(DVec2::new(1.5 * f64::from(k), 0.0))).collect();
    let classes = classes_of(&flowers);
    assert!((0..4).all(|k| classes[4 * k] == Some(StrokeClass::Disc)), "{classes:?}");
    // The same rings each at the end of a line.
    let berries: Vec<Vec<DVec2>> = (0..4)
        .flat_map(|k| {
            let x = 1.5 * f64::from(k);
            let ring = orchid(DVec2::new(x, 0.0)).swap_remove(0);
            [ring, straight((x, 0.06), (x, 1.0))]
        })
        .collect();
    assert!(!classes_of(&berries).contains(&Some(StrokeClass::Disc)));
}

/// One side of a leaf, from its foot to its tip, `bend` wide at half its length.
fn side(foot: (f64, f64), tip: (f64, f64), bend: f64) -> Vec<DVec2> {
    let (foot, tip) = (DVec2::from(foot), DVec2::from(tip));
    let out = (tip - foot).perp().normalize_or_zero() * bend;
    let to = |t: f64| foot.lerp(tip, t) + out * (4.0 * t * (1.0 - t));
    (0..=30).map(|k| to(f64::from(k) / 30.0)).collect()
}

fn chains_of(lines: &[Vec<DVec2>]) -> Vec<Vec<usize>> {
    let ink = clean(&Drawing::from_polylines("herb", lines), &mut Report::default());
    super::chains(&ink, &Sheet::new(&ink), |_| true).into_iter().map(|c| c.rows).collect()
}

#[test]
fn sides_that_bend_outwards_and_meet_at_a_tip_are_one_blade_and_stalks_from_one_foot_are_none() {
    let stem = straight((0.0, -40.0), (0.0, 40.0));
    let left = side((0.0, 0.0), (30.0, 25.0), 4.0);
    let right: Vec<DVec2> = side((1.0, -6.0), (30.0, 25.0), -4.0);
    let mut found = chains_of(&[stem.clone(), left.clone(), right.clone()]);
    found.iter_mut().for_each(|rows| rows.sort_unstable());
    assert_eq!(found, [[1, 2]]);
    // In three parts, with the midrib up to the tip.
    let (low, high) = (right[..16].to_vec(), right[15..].to_vec());
    let midrib = straight((0.0, -3.0), (30.0, 25.0));
    let mut found = chains_of(&[stem.clone(), left, low, high, midrib]);
    found.iter_mut().for_each(|rows| rows.sort_unstable());
    assert_eq!(found, [[1, 2, 3]]);
    // Stalks are straight, or bend apart.
    for bend in [0.0, 4.0] {
        let one = side((0.0, -40.0), (-12.0, 20.0), -bend);
        let other = side((0.0, -40.0), (12.0, 20.0), bend);
        assert!(chains_of(&[one, other]).is_empty(), "{bend}");
    }
}

#[test]
fn blades_with_a_midrib_and_side_veins_are_leaves() {
    let leaf = |way: f64| {
        let turn = |p: DVec2| polar(way, 1.0).rotate(p);
        let outline: Vec<DVec2> = (0..=60)
            .map(|k| DVec2::new(6.0, 0.0) + polar(TAU * f64::from(k) / 60.0, 1.0) * DVec2::new(5.0, 2.5))
            .collect();
        let vein = |x: f64, y: f64| straight((x, 0.0), (x + 1.5, y));
        let midrib = straight((1.0, 0.0), (11.0, 0.0));
        let lines = [outline, midrib, vein(3.0, 1.2), vein(4.0, -1.4), vein(5.0, 1.4)];
        lines.map(|line| line.into_iter().map(turn).collect::<Vec<_>>())
    };
    let lines: Vec<Vec<DVec2>> = (0..5).flat_map(|k| leaf(TAU * f64::from(k) / 5.0)).collect();
    let ink = clean(&Drawing::from_polylines("whorl", &lines), &mut Report::default());
    let sheet = Sheet::new(&ink);
    assert!((0..5).all(|k| sheet.facts[5 * k].is_veined && !sheet.facts[5 * k].is_textured));
    let said = vec![Classified::by_shares([0.0; StrokeClass::ALL.len()]); ink.strokes.len()];
    assert_eq!(Structure::new(&sheet, &[], &said).leaves(), [0, 5, 10, 15, 20]);
}

/// A sheet of equal circles, each touching its neighbours.
fn circles(side: u32) -> Sheet {
    let circle = |i: u32| {
        let middle = DVec2::new(f64::from(i % side), f64::from(i / side));
        (0..=24).map(|k| middle + polar(TAU * f64::from(k) / 24.0, 0.5)).collect()
    };
    let lines: Vec<Vec<DVec2>> = (0..side * side).map(circle).collect();
    Sheet::new(&clean(&Drawing::from_polylines("circles", &lines), &mut Report::default()))
}

#[test]
fn outlines_that_are_all_alike_are_looked_at_together() {
    let seconds = |side: u32| {
        let sheet = circles(side);
        let said = vec![Classified::by_shares([0.0; StrokeClass::ALL.len()]); sheet.facts.len()];
        let time = |_| {
            let start = std::time::Instant::now();
            let structure = Structure::new(&sheet, &[], &said);
            let taken = start.elapsed().as_secs_f64();
            let first = structure.classes()[0];
            assert!(first.is_some() && structure.classes().iter().all(|c| *c == first), "{side}");
            taken
        };
        (0..3).map(time).fold(f64::INFINITY, f64::min)
    };
    // Sixteen times as many took 148 times as long when each was looked at by itself among all others, and now take 3
    // times as long.
    let (few, many) = (seconds(5), seconds(20));
    assert!(many < 32.0 * few, "25 in {few} s, 400 in {many} s");
}
