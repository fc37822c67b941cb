//! Leaves that stand as petals do, and petals that hide their roots.

use super::*;

/// A stem, and on it whorls of six leaves each.
fn whorled_stem(whorls: i32) -> Vec<(StrokeClass, Vec<DVec2>)> {
    let mut strokes = vec![(StrokeClass::Axis, line((5.0, 0.0), (5.0, 14.0)))];
    for k in 1..=whorls {
        let leaves = petals((5.0, 3.0 * f64::from(k)), 6, 1.4);
        strokes.extend(leaves.into_iter().map(|p| (StrokeClass::Blade, p)));
    }
    strokes
}

#[test]
fn whorls_along_a_stem_are_leaves() {
    let (r, _) = reading(&whorled_stem(3));
    assert_eq!((r.flowers.len(), r.leaves.len()), (0, 18));
}

#[test]
fn one_ring_of_petals_before_a_stem_may_be_a_flower() {
    let (r, _) = reading(&whorled_stem(1));
    assert_eq!((r.flowers.len(), r.leaves.len()), (1, 0));
}

#[test]
fn a_rosette_at_the_foot_of_a_stem_is_of_leaves() {
    let fan = (0..5).map(|k| {
        let (s, c) = ops::sin_cos(0.25 * ops::PI + 0.125 * ops::PI * f64::from(k));
        (StrokeClass::Blade, leaf((5.0, 0.0), (5.0 + 3.0 * c, 3.0 * s), 0.6))
    });
    let mut strokes: Vec<_> = fan.collect();
    strokes.push((StrokeClass::Axis, line((5.0, 0.0), (5.2, 11.0))));
    strokes.extend(petals((5.2, 11.0), 6, 2.0).into_iter().map(|p| (StrokeClass::Blade, p)));
    let (r, _) = reading(&strokes);
    assert_eq!((r.flowers.len(), r.leaves.len()), (1, 5), "{:?}", organs(&r));
    assert_eq!(r.flowers[0].petals.len(), 6);
}

#[test]
fn the_heart_of_a_rosette_without_a_stem_is_of_leaves() {
    let ring = |count: usize, from: f64, long: f64| -> Vec<_> {
        let turn = ops::TAU / count as f64;
        let leaves = (0..count).map(move |k| {
            let (s, c) = ops::sin_cos(turn * (k as f64 + 0.5 * from));
            leaf((from * c, from * s), ((from + long) * c, (from + long) * s), 0.8)
        });
        leaves.map(|l| (StrokeClass::Blade, l)).collect()
    };
    let rosette = [ring(5, 0.0, 1.0), ring(7, 0.9, 1.6), ring(9, 2.1, 2.0)].concat();
    let (r, _) = reading(&rosette);
    assert_eq!((r.flowers.len(), r.leaves.len()), (0, 21));
    let (r, _) = reading(&rosette[..5]);
    assert_eq!((r.flowers.len(), r.leaves.len()), (1, 0), "petals alone are a flower");
}

#[test]
fn three_blades_at_the_ends_of_several_stalks_are_trifoliate_leaves() {
    let mut strokes = vec![(StrokeClass::Axis, line((0.0, 0.0), (0.0, 10.0)))];
    for (k, side) in [(2.0, 1.0), (4.0, -1.0), (6.0, 1.0)] {
        let end = (4.0 * side, k + 2.0);
        strokes.push((StrokeClass::Axis, line((0.0, k), end)));
        strokes.extend(petals(end, 3, 1.5).into_iter().map(|p| (StrokeClass::Blade, p)));
    }
    let (r, _) = reading(&strokes);
    assert_eq!((r.flowers.len(), r.leaves.len()), (0, 9));
}

#[test]
fn tubes_that_are_alike_along_a_stem_are_flowers_of_one_petal() {
    let mut strokes = vec![(StrokeClass::Axis, line((0.0, 0.0), (0.0, 12.0)))];
    for k in 0..5 {
        let (x, y) = (if k % 2 == 0 { 1.0 } else { -1.0 }, 4.0 + 1.6 * f64::from(k));
        strokes.push((StrokeClass::Axis, line((0.0, y), (x, y - 0.2))));
        // Narrow above, flared below, and closed by a rim.
        let bell = path(&[
            (x, y - 0.2),
            (x + 0.3, y - 0.4),
            (x + 0.35, y - 1.0),
            (x + 0.5, y - 1.5),
            (x - 0.5, y - 1.5),
            (x - 0.35, y - 1.0),
            (x - 0.3, y - 0.4),
            (x, y - 0.2),
        ]);
        strokes.push((StrokeClass::Blade, bell));
    }
    let (r, _) = reading(&strokes);
    assert_eq!((r.flowers.len(), r.leaves.len()), (5, 0), "{:?}", organs(&r));
    assert!(r.flowers.iter().all(|f| f.petals.len() == 1 && f.bearer.is_some()));
    assert_eq!(Kind::from_reading(&r), Kind::Flowers);
}

/// Blades that fan out from the top of a stem, each on a stalk of this length; those behind stop at those in front.
fn fan_on_stalks(stalk: f64) -> Vec<(StrokeClass, Vec<DVec2>)> {
    let top = DVec2::new(5.0, 8.0);
    let mut strokes = vec![(StrokeClass::Axis, line((5.0, 0.0), (5.0, 8.0)))];
    for k in 0..5 {
        let (s, c) = ops::sin_cos(0.2 * ops::PI + 0.15 * ops::PI * f64::from(k));
        let way = DVec2::new(c, s);
        let (foot, tip) = (top + way * stalk, top + way * (stalk + 3.0));
        if stalk > 0.0 {
            strokes.push((StrokeClass::Axis, line((5.0, 8.0), (foot.x, foot.y))));
        }
        strokes.push((StrokeClass::Blade, leaf((foot.x, foot.y), (tip.x, tip.y), 1.2)));
    }
    strokes
}

#[test]
fn blades_on_petioles_round_the_top_of_a_stem_are_leaves_and_without_they_are_petals() {
    let (r, _) = reading(&fan_on_stalks(0.0));
    assert_eq!((r.flowers.len(), r.leaves.len()), (1, 0), "{:?}", organs(&r));
    let (r, _) = reading(&fan_on_stalks(0.9));
    assert_eq!((r.flowers.len(), r.leaves.len()), (0, 5), "{:?}", organs(&r));
}
