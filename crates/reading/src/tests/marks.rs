//! Other marks on a sheet: lines drawn twice or in one go, fruits on twigs, stamens, roots, shading.

use super::*;

/// Reads lines as [`drawn`] does; returns the organs of the strokes, too.
fn read_of(lines: &[Vec<DVec2>]) -> (Reading, Vec<&'static str>) {
    let (reading, _) = drawn(lines);
    assert_eq!(reading.validate().count(), 0);
    let words = organs(&reading);
    (reading, words)
}

fn again(points: &[DVec2], by: f64) -> Vec<DVec2> {
    points.iter().rev().map(|p| *p + DVec2::new(by * ops::sin(3.0 * p.y), by * ops::cos(2.0 * p.x))).collect()
}

/// A trunk in two lines and a round crown.
fn tree() -> Vec<Vec<DVec2>> {
    vec![line((4.4, 0.0), (4.6, 5.4)), line((5.6, 0.0), (5.4, 5.4)), circle((5.0, 8.0), 3.0)]
}

#[test]
fn what_was_drawn_twice_is_one_line() {
    let once = tree();
    let mut lines = once.clone();
    lines.extend([again(&once[2], 0.04), again(&once[0], 0.04)]);
    let (r, words) = read_of(&lines);
    assert_eq!((r.plants[0].kind, r.regions.len(), r.plants[0].strokes.len()), (Kind::Tree, 1, 5));
    assert_eq!((words[3], words[4]), (words[2], words[0]));
    // The longer one of two is the line.
    let twice = |s: &&crate::StrokeReading| s.source == Source::Rule(ink::DRAWN_AGAIN);
    let twice: Vec<u32> = r.strokes.iter().filter(twice).map(|s| s.index).collect();
    assert_eq!(twice.len(), 2, "{:?}", r.strokes);
    let (plain, _) = read_of(&once);
    assert_eq!((r.axes.len(), r.leaves.len()), (plain.axes.len(), 0));
    // The class that the user sets stays.
    let ink = clean(&Drawing::from_polylines("tree", &lines), &mut Report::default());
    let mut classes = ink::classify(&ink, &base::Run::plain());
    let named = twice[0] as usize;
    classes[named] = Classified::by_user(StrokeClass::Ground);
    let r = read(&ink, &classes, &mut Report::default());
    assert_eq!((r.strokes[named].class, r.strokes[3].organ.word()), (StrokeClass::Ground, "leaf_contour"));
    assert_eq!(r.validate().count(), 0);
}

#[test]
fn stems_with_leaves_in_one_go_are_taken_apart() {
    for lean in [0.3, 0.5] {
        let stem = |side: f64| {
            let top = (5.0 + side * lean * 6.0, 6.0);
            let mut points = line((5.0, 0.0), top);
            points.extend(leaf(top, (top.0 + side * 1.5, 9.0), 1.5).into_iter().skip(1));
            points
        };
        let (r, words) = read_of(&[stem(-1.0), stem(1.0)]);
        assert_eq!((r.leaves.len(), words), (2, vec!["leaf"; 2]), "{:?}", r.strokes);
        assert_eq!(r.axes.iter().filter(|a| a.half_width.is_empty()).count(), 2);
    }
    // A leaf on either side of a stem that goes on.
    let mut points = line((5.0, 0.0), (5.0, 3.0));
    points.extend(leaf((5.0, 3.0), (8.0, 5.0), 1.4));
    points.extend(line((5.0, 3.0), (5.0, 5.0)));
    points.extend(leaf((5.0, 5.0), (2.0, 7.0), 1.4));
    points.extend(line((5.0, 5.0), (5.0, 9.0)));
    let (r, _) = read_of(&[points]);
    assert_eq!((r.leaves.len(), r.axes.len()), (2, 1), "{:?}", r.strokes);
    assert!(r.leaves.iter().all(|l| l.bearer.is_some()));
}

#[test]
fn rings_on_bare_twigs_are_apples() {
    let mut lines = vec![line((5.0, 0.0), (5.1, 10.0))];
    let mut apples = 0;
    for (k, y) in [4.0, 5.5, 7.0, 8.5].into_iter().enumerate() {
        let side = if k % 2 == 0 { 1.0 } else { -1.0 };
        let tip = (5.0 + side * 3.0, y + 1.5);
        lines.push(line((5.0, y), tip));
        lines.push(line(tip, (tip.0, tip.1 - 0.4)));
        lines.push(circle((tip.0, tip.1 - 0.8), 0.4));
        apples += 1;
    }
    let (r, words) = read_of(&lines);
    assert_eq!(r.fruits.len(), apples, "{:?}", r.strokes);
    assert_eq!(words.iter().filter(|w| **w == "fruit").count(), apples);
    assert!(r.fruits.iter().all(|f| f.bearer.is_some()) && r.flowers.is_empty());
}

#[test]
fn petals_that_stand_off_their_disc_are_led_to_it() {
    for (n, gap) in [(5_u8, 0.3), (7, 0.5), (9, 0.7)] {
        let mut lines = vec![circle((5.0, 8.0), 0.9), line((5.0, 0.0), (5.0, 4.9))];
        for k in 0..n {
            let (s, c) = ops::sin_cos(ops::TAU * f64::from(k) / f64::from(n) + 0.2);
            let at = |r: f64| (5.0 + r * c, 8.0 + r * s);
            lines.push(leaf(at(0.9 + gap), at(3.0), 0.9));
        }
        let (r, _) = read_of(&lines);
        let flower = r.flowers.first().expect("a flower");
        assert_eq!((r.flowers.len(), flower.petals.len(), r.leaves.len()), (1, usize::from(n), 0), "{gap}");
        let disc = flower.disc.expect("drawn");
        let off = flower.petals.iter().map(|p| p.root.distance(disc.centre) - disc.radius);
        assert!(off.into_iter().all(|d| d.abs() < 0.02), "each begins at the disc");
    }
}

#[test]
fn a_bare_trunk_of_two_lines_stays_a_trunk() {
    let mut lines = vec![line((4.5, 0.0), (4.9, 10.0)), line((5.5, 0.0), (5.1, 10.0))];
    for k in 0..5_i32 {
        let (t, side) = (0.35 + 0.11 * f64::from(k), if k % 2 == 0 { 1.0 } else { -1.0 });
        let from = (5.0 + side * 0.5 * (1.0 - 0.8 * t), 10.0 * t);
        lines.push(line(from, (from.0 + side * 3.0, from.1 + 2.0)));
    }
    let (r, words) = read_of(&lines);
    assert_eq!(r.plants[0].kind, Kind::Tree, "{:?}", r.strokes);
    assert_eq!((words[0], words[1]), ("trunk", "trunk"), "{:?}", r.strokes);
    assert_eq!(r.axes.iter().filter(|a| a.bearer.is_none()).count(), 1, "nothing else stands");
}

#[test]
fn stamens_over_petals_are_no_veins() {
    for knobs in [false, true] {
        let mut lines = petals((5.0, 9.0), 5, 3.0);
        lines.push(line((5.0, 6.0), (5.0, 0.0)));
        let mut stamens = 0;
        for k in 0..6 {
            let (s, c) = ops::sin_cos(ops::TAU * f64::from(k) / 6.0 + 0.75);
            let at = |r: f64| (5.0 + r * c, 9.0 + r * s);
            lines.push(line(at(0.15), at(1.2)));
            stamens += 1;
            if knobs {
                lines.push(circle(at(1.28), 0.1));
            }
        }
        let (r, words) = read_of(&lines);
        let flower = r.flowers.first().expect("a flower");
        assert_eq!(
            (r.flowers.len(), flower.petals.len(), flower.stamens.len()),
            (1, 5, stamens),
            "{:?}",
            r.strokes
        );
        assert!(words[6..].iter().all(|w| *w == "stamen"), "{words:?}");
    }
    // A lily in profile, out of which they stand.
    let fan = |n: i32, k: i32, each: f64| {
        let (s, c) = ops::sin_cos(ops::FRAC_PI_2 + each * (f64::from(k) - 0.5 * f64::from(n - 1)));
        move |r: f64| (5.0 + r * c, 5.0 + r * s)
    };
    let mut lines: Vec<_> = (0..5).map(|k| leaf((5.0, 5.0), fan(5, k, 0.42)(3.0), 1.2)).collect();
    lines.push(line((5.0, 5.0), (5.1, 0.0)));
    lines.extend((0..4).map(|k| line((5.0, 5.1), fan(4, k, 0.22)(3.4))));
    let (r, _) = read_of(&lines);
    let flower = r.flowers.first().expect("a flower");
    assert_eq!((r.flowers.len(), flower.petals.len(), flower.stamens.len()), (1, 5, 4), "{:?}", r.strokes);
    // Midribs are.
    let mut lines = petals((5.0, 9.0), 5, 3.0);
    lines.push(line((5.0, 6.0), (5.0, 0.0)));
    for k in 0..5 {
        let (s, c) = ops::sin_cos(ops::TAU * f64::from(k) / 5.0 + 0.3);
        lines.push(line((5.0 + 0.3 * c, 9.0 + 0.3 * s), (5.0 + 2.4 * c, 9.0 + 2.4 * s)));
    }
    let (r, words) = read_of(&lines);
    assert_eq!((r.flowers.len(), &words[6..]), (1, &["vein"; 5][..]), "{:?}", r.strokes);
}

#[test]
fn what_goes_down_from_the_ground_is_a_root() {
    let mut herb = vec![line((0.0, 5.0), (10.0, 5.0)), line((5.0, 5.0), (5.0, 10.0))];
    for k in 0..4_i32 {
        let (y, side) = (6.2 + 0.9 * f64::from(k), if k % 2 == 0 { 1.0 } else { -1.0 });
        herb.push(leaf((5.0, y), (5.0 + side * 1.8, y + 1.0), 0.7));
    }
    let mut lines = herb.clone();
    lines.push(line((5.0, 5.0), (5.1, 0.5)));
    for k in 0..4_i32 {
        let (y, side) = (4.2 - 0.8 * f64::from(k), if k % 2 == 0 { 1.0 } else { -1.0 });
        lines.push(line((5.05, y), (5.05 + side * 1.4, y - 0.8)));
    }
    let (r, words) = read_of(&lines);
    assert_eq!(words[0], "ignored", "{:?}", r.strokes);
    assert!(words[6..].iter().all(|w| *w == "root"), "{words:?}");
    assert_eq!(r.leaves.len(), 4);
    // A turnip under the line of the ground: the line is no branch.
    let root = path(&[(4.4, 5.0), (4.5, 3.6), (5.0, 0.0), (5.5, 3.6), (5.6, 5.0)]);
    let leaves = (0..5_i32).map(|k| ops::sin_cos(0.9 + 0.34 * f64::from(k)));
    let mut lines = vec![line((0.0, 5.0), (10.0, 5.0)), root];
    lines.extend(leaves.map(|(s, c)| leaf((5.0, 5.0), (5.0 + 4.0 * c, 5.0 + 4.0 * s), 0.9)));
    let (r, words) = read_of(&lines);
    assert_eq!((words[0], r.leaves.len()), ("ignored", 5), "{:?}", r.strokes);
}

#[test]
fn shading_is_nothing_that_grows() {
    let zigzag = |(x, y): (f64, f64), wide: f64, rise: f64| {
        let corner = |i: i32| (x + if i % 2 == 0 { -wide } else { wide }, y + rise * f64::from(i));
        path(&(0..10).map(corner).collect::<Vec<_>>())
    };
    let mut lines = tree();
    lines.push(zigzag((6.0, 6.8), 0.7, 0.25));
    let (r, words) = read_of(&lines);
    assert_eq!((words[3], r.regions.len(), r.leaves.len()), ("ignored", 1, 0), "{:?}", r.strokes);
    // Lines side by side.
    let mut lines = tree();
    lines.extend((0..6_i32).map(|k| {
        let x = 3.6 + 0.5 * f64::from(k);
        line((x, 7.2), (x + 0.6, 9.0))
    }));
    let (r, words) = read_of(&lines);
    assert!(words[3..].iter().all(|w| *w == "ignored"), "{words:?}");
    assert_eq!((r.plants[0].kind, r.regions.len()), (Kind::Tree, 1));
    // In leaves.
    let mut lines = vec![line((5.0, 0.0), (5.0, 10.0))];
    for (y, side) in [(3.0, 1.0), (4.5, -1.0), (6.0, 1.0), (7.5, -1.0)] {
        lines.push(leaf((5.0, y), (5.0 + side * 3.4, y + 0.4), 1.5));
    }
    lines.push(
        zigzag((6.6, 3.0), 0.3, 0.05)
            .into_iter()
            .map(|p| DVec2::new(5.9 + 3.0 * (p.y - 3.0), 3.2 + p.x - 6.6))
            .collect(),
    );
    let (r, words) = read_of(&lines);
    assert_eq!((words[5], r.leaves.len()), ("ignored", 4), "{:?}", r.strokes);
}

#[test]
fn rings_under_fronds_are_nuts_and_long_outlines_in_a_crown_leaves() {
    let mut palm = vec![path(&[(4.7, 6.0), (4.6, 0.0), (5.4, 0.0), (5.3, 6.0)])];
    for k in 0..6 {
        let a = -0.3 + (ops::PI + 0.6) * f64::from(k) / 5.0;
        palm.push(leaf((5.0, 6.0), (5.0 + 3.0 * ops::cos(a), 5.8 + 2.4 * ops::sin(a)), 0.8));
    }
    palm.extend([circle((4.75, 5.7), 0.22), circle((5.25, 5.7), 0.22)]);
    let (r, _) = read_of(&palm);
    assert_eq!((r.plants[0].kind, r.fruits.len(), r.leaves.len()), (Kind::Palm, 2, 6), "{:?}", r.strokes);
    let mut lines = tree();
    lines.extend([circle((3.6, 8.4), 0.3), circle((6.0, 9.0), 0.3), circle((5.4, 6.6), 0.3)]);
    lines.extend([leaf((4.5, 9.0), (5.3, 9.8), 0.4), leaf((6.4, 7.4), (7.2, 7.0), 0.4)]);
    let (r, _) = read_of(&lines);
    assert_eq!((r.regions.len(), r.fruits.len(), r.leaves.len()), (1, 3, 2), "{:?}", r.strokes);
}
