//! Petals, discs and groups of blades that are no flower.

use super::*;

#[test]
fn petals_begun_at_their_tips_are_rooted_in_the_middle() {
    let mut strokes: Vec<_> = petals((5.0, 10.0), 6, 2.0)
        .into_iter()
        .map(|mut p| {
            p.rotate_left(20);
            (StrokeClass::Blade, p)
        })
        .collect();
    strokes.push((StrokeClass::Axis, line((5.0, 8.0), (5.2, 0.0))));
    let (r, _) = reading(&strokes);
    assert_eq!((r.flowers.len(), r.leaves.len()), (1, 0));
    let f = &r.flowers[0];
    assert_eq!(f.petals.len(), 6);
    assert!(f.petals.iter().all(|p| p.root.distance(f.centre) < 0.03), "roots in the middle");
}

#[test]
fn a_disc_gathers_its_petals_and_two_whorls_are_told_apart() {
    let mut strokes = vec![(StrokeClass::Disc, circle((5.0, 10.0), 0.6))];
    strokes.extend(petals((5.0, 10.0), 6, 3.0).into_iter().map(|p| (StrokeClass::Blade, p)));
    strokes.extend(petals((5.0, 10.0), 6, 1.7).into_iter().map(|p| (StrokeClass::Blade, p)));
    strokes.push((StrokeClass::Axis, line((5.0, 7.0), (5.2, 0.0))));
    let (r, _) = reading(&strokes);
    assert_eq!((r.flowers.len(), r.flowers[0].petals.len()), (1, 12));
    let inner = r.flowers[0].petals.iter().filter(|p| p.whorl == 1).count();
    assert_eq!(inner, 6);
    assert!(r.flowers[0].disc.is_some_and(|d| d.centre.distance(r.flowers[0].centre) < 1e-9));
}

/// `n` petals on a ring of a share of their reach, unevenly by up to a tenth of it, begun at their roots or their tips.
fn ring_of_petals(n: i32, ring: f64, seed: u64) -> Vec<Vec<DVec2>> {
    let r = &mut base::Seed::new(seed).stream(base::Draw::Test);
    let mut petals = Vec::new();
    for k in 0..n {
        let a = ops::TAU * (f64::from(k) + r.range(-0.1, 0.1)) / f64::from(n) + 0.3;
        let reach = 3.0 * r.range(0.93, 1.07);
        let (foot, lean) = (3.0 * ring * r.range(0.9, 1.1), a + r.range(-0.04, 0.04));
        let root = (5.0 + foot * ops::cos(a), 10.0 + foot * ops::sin(a));
        let tip = (5.0 + reach * ops::cos(lean), 10.0 + reach * ops::sin(lean));
        let wide = (3.6 * (0.5 + 0.5 * ring) * ops::PI / f64::from(n)).min(1.6);
        let mut petal = leaf(root, tip, wide);
        if seed.is_multiple_of(2) {
            petal.rotate_left(20);
        }
        petals.push(petal);
    }
    petals
}

#[test]
fn petals_on_a_ring_without_a_disc_are_one_flower() {
    for (n, ring) in [(6, 0.25), (6, 0.35), (8, 0.2), (8, 0.3), (8, 0.4), (12, 0.2), (12, 0.3), (16, 0.35)] {
        for seed in 1..=12 {
            let mut strokes: Vec<_> =
                ring_of_petals(n, ring, seed).into_iter().map(|p| (StrokeClass::Blade, p)).collect();
            strokes.push((StrokeClass::Axis, line((5.0, 10.0 - 3.0 * ring), (5.2, 0.0))));
            strokes.push((StrokeClass::Blade, leaf((5.1, 4.0), (7.5, 5.5), 0.8)));
            strokes.push((StrokeClass::Blade, leaf((5.1, 3.0), (2.5, 4.5), 0.8)));
            let (r, _) = reading(&strokes);
            let petals: Vec<usize> = r.flowers.iter().map(|f| f.petals.len()).collect();
            let what = format!("{n} petals at {ring}, seed {seed}");
            assert_eq!((petals, r.leaves.len()), (vec![n.unsigned_abs() as usize], 2), "{what}");
            assert!(r.flowers[0].bearer.is_some(), "{what}: on its stem");
            strokes.truncate(n.unsigned_abs() as usize);
            let (r, _) = reading(&strokes);
            assert_eq!((r.flowers.len(), r.leaves.len()), (1, 0), "{what}, alone");
        }
    }
}

#[test]
fn leaves_along_a_stem_and_two_flowers_side_by_side_are_no_ring() {
    // Five pairs of leaves, and two flowers in which each petal is nearer to the other flower's than to its own.
    let mut strokes = vec![(StrokeClass::Axis, line((5.0, 12.0), (5.2, 0.0)))];
    for k in 0..5 {
        let y = 2.0 + 2.0 * f64::from(k);
        strokes.push((StrokeClass::Blade, leaf((5.05, y), (7.5, y + 1.0), 0.8)));
        strokes.push((StrokeClass::Blade, leaf((5.05, y), (2.5, y + 1.0), 0.8)));
    }
    let (r, _) = reading(&strokes);
    assert_eq!((r.flowers.len(), r.leaves.len()), (0, 10));
    for seed in 1..=12 {
        let mut strokes = Vec::new();
        for x in [0.0, 6.6] {
            for mut petal in ring_of_petals(8, 0.3, seed) {
                petal.iter_mut().for_each(|p| p.x += x);
                strokes.push((StrokeClass::Blade, petal));
            }
            strokes.push((StrokeClass::Axis, line((5.0 + x, 9.1), (5.2 + x, 0.0))));
        }
        let (r, _) = reading(&strokes);
        let petals: Vec<usize> = r.flowers.iter().map(|f| f.petals.len()).collect();
        assert_eq!(petals, [8, 8], "seed {seed}");
    }
}

/// The petals of a cone with radius and height, whose axis stands out of the sheet by an angle, as they appear.
fn petals_of_a_cone(n: i32, (radius, height): (f64, f64), out: f64) -> Vec<Vec<DVec2>> {
    let (s, c) = ops::sin_cos(out.to_radians());
    let seen = |t: f64, a: f64| {
        let (x, v) = (radius * t * ops::cos(a), radius * t * ops::sin(a));
        DVec2::new(400.0 + x, 600.0 + height * t * c + v * s)
    };
    let half = 0.8 * ops::PI / f64::from(n);
    let petal = |k: i32| {
        let a = ops::TAU * f64::from(k) / f64::from(n) + 0.3;
        let side = |sign: f64| {
            move |i: i32| {
                let t = f64::from(i) / 20.0;
                seen(t, a + sign * half * ops::sin(ops::PI * t).sqrt())
            }
        };
        (0..20).map(side(1.0)).chain((0..=20).rev().map(side(-1.0))).collect()
    };
    (0..n).map(petal).collect()
}

#[test]
fn no_petal_of_a_tilted_cone_is_lost() {
    for (radius, height) in [(120.0, 100.0), (120.0, 60.0), (120.0, 2.0), (100.0, 150.0)] {
        for out in [20.0, 30.0, 45.0, 60.0] {
            for n in [5, 6, 8, 12] {
                let petals = petals_of_a_cone(n, (radius, height), out).into_iter();
                let mut strokes: Vec<_> = petals.map(|p| (StrokeClass::Blade, p)).collect();
                strokes.push((StrokeClass::Axis, line((400.0, 600.0), (405.0, 200.0))));
                let (r, _) = reading(&strokes);
                let petals: Vec<usize> = r.flowers.iter().map(|f| f.petals.len()).collect();
                let what = format!("radius {radius}, height {height}, {out} degrees, {n} petals");
                assert_eq!((petals, r.leaves.len()), (vec![n.unsigned_abs() as usize], 0), "{what}");
            }
        }
    }
}

#[test]
fn a_rose_window_in_one_stroke() {
    let scallops: Vec<DVec2> = (0..=400)
        .map(|i| ops::TAU * f64::from(i) / 400.0)
        .map(|t| {
            DVec2::new(5.0, 10.0) + DVec2::new(ops::cos(t), ops::sin(t)) * (2.0 + ops::sin(4.0 * t).abs())
        })
        .collect();
    let (r, _) =
        reading(&[(StrokeClass::Corolla, scallops), (StrokeClass::Axis, line((5.0, 8.0), (5.0, 0.0)))]);
    assert_eq!((r.flowers.len(), r.leaves.len(), r.axes.len()), (1, 0, 1));
    assert_eq!(r.flowers[0].petals.len(), 8);
    assert_eq!(organs(&r), ["petal", "branch"]);
}

#[test]
fn leaves_thick_along_a_branch_are_no_flower() {
    let mut strokes = vec![(StrokeClass::Axis, line((0.0, 0.0), (10.0, 3.0)))];
    for i in 0..30 {
        let x = 0.5 + 0.3 * f64::from(i);
        let up = if i % 2 == 0 { 1.0 } else { -1.0 };
        strokes.push((StrokeClass::Blade, leaf((x, 0.3 * x), (x + 0.5, 0.3 * x + up), 0.4)));
    }
    let (r, _) = reading(&strokes);
    assert_eq!((r.flowers.len(), r.leaves.len()), (0, 30));
    assert!(r.leaves.iter().all(|l| l.bearer.is_some()), "all borne");
}

#[test]
fn green_beside_petals_of_another_colour_is_a_leaf() {
    let mut lines = vec![circle((5.0, 8.0), 0.8)];
    lines.extend(petals((5.0, 8.0), 8, 3.0));
    lines.push(line((5.0, 7.2), (5.0, 0.0)));
    let mut drawing = Drawing::from_polylines("flower", &lines);
    let of = |drawing: &Drawing, off: &[&str]| {
        let ink = clean(drawing, &mut Report::default());
        let class = |k: u32| match k {
            0 => StrokeClass::Disc,
            9 => StrokeClass::Axis,
            _ => StrokeClass::Blade,
        };
        let classes: Vec<Classified> = ink.strokes.iter().map(|s| perhaps(class(s.index), 0.9)).collect();
        let r = read_without(off, &ink, &classes, &mut Report::default());
        (r.flowers.iter().map(|f| f.petals.len()).sum::<usize>(), r.leaves.len())
    };
    let paint = |drawing: &mut Drawing, petal: [u8; 3], two: [u8; 3]| {
        for (k, s) in drawing.strokes.iter_mut().enumerate() {
            s.color = Some(if k == 3 || k == 7 { two } else { petal });
        }
    };
    paint(&mut drawing, [200, 30, 60], [40, 150, 50]);
    assert_eq!(of(&drawing, &[]), (6, 2));
    assert_eq!(of(&drawing, &["green-leaves"]), (8, 0));
    // If all are green, or none is, colours mean nothing.
    paint(&mut drawing, [40, 150, 50], [90, 180, 60]);
    assert_eq!(of(&drawing, &[]), (8, 0));
    paint(&mut drawing, [200, 30, 60], [230, 200, 40]);
    assert_eq!(of(&drawing, &[]), (8, 0));
}

#[test]
fn round_petals_about_a_disc_are_a_flower() {
    let mut lines = vec![circle((5.0, 8.0), 0.7), line((5.0, 0.0), (5.0, 6.0))];
    lines.extend((0..5).map(|k| ops::sin_cos(ops::TAU * f64::from(k) / 5.0)).map(|(s, c)| {
        let way = DVec2::new(c, s) * 1.7 + DVec2::new(5.0, 8.0);
        circle((way.x, way.y), 0.95)
    }));
    let ink = clean(&Drawing::from_polylines("flower", &lines), &mut Report::default());
    let r = read(&ink, &ink::classify(&ink, &base::Run::plain()), &mut Report::default());
    assert_eq!((r.flowers.len(), r.flowers.first().map(|f| f.petals.len())), (1, Some(5)), "{:?}", r.strokes);
    assert_eq!((r.plants[0].kind, r.regions.len()), (Kind::Flower, 0));
}

/// A cup with points above, its foot at the origin of its stem.
fn cup(points: &[(f64, f64)]) -> Vec<DVec2> {
    let sides = [(16.0, 100.0), (10.0, 84.0), (0.0, 80.0), (-10.0, 84.0), (-16.0, 100.0)];
    path(&[points, &sides, &points[..1]].concat())
}

#[test]
fn a_tulip_is_petals_that_begin_at_its_stem() {
    let three = [(-15.0, 120.0), (-7.0, 108.0), (0.0, 120.0), (7.0, 108.0), (15.0, 120.0)];
    let two = [(-15.0, 120.0), (0.0, 105.0), (15.0, 120.0)];
    let stem = line((0.0, 80.0), (0.0, 0.0));
    let leaves = [leaf((0.0, 2.0), (-22.0, 60.0), 9.0), leaf((0.0, 2.0), (22.0, 60.0), 9.0)];
    for head in [&three[..], &two] {
        let lines = [&[cup(head), stem.clone()][..], &leaves].concat();
        let (reading, _) = drawn(&lines);
        let [flower] = &reading.flowers[..] else { panic!("{:?}", reading.flowers.len()) };
        assert_eq!((flower.petals.len(), reading.leaves.len()), (3, 2));
        let foot = reading.axes[0].points.last().expect("a line");
        assert!(flower.petals.iter().all(|p| p.root.distance(*foot) < 0.05), "petals begin at the stem");
    }
    // Its points and its round half in two strokes.
    let half = path(&[
        (-15.0, 120.0),
        (-16.0, 100.0),
        (-10.0, 84.0),
        (0.0, 80.0),
        (10.0, 84.0),
        (16.0, 100.0),
        (15.0, 120.0),
    ]);
    let (reading, _) = drawn(&[&[stem, half, path(&three)][..], &leaves].concat());
    assert_eq!(reading.flowers.iter().map(|f| f.petals.len()).collect::<Vec<_>>(), [3]);
}

#[test]
fn a_pot_is_read_of_all_its_strokes() {
    let pot = path(&[(-20.0, 0.0), (-14.0, -40.0), (14.0, -40.0), (20.0, 0.0), (-20.0, 0.0)]);
    let rim = path(&[(-22.0, 0.0), (-22.0, 8.0), (22.0, 8.0), (22.0, 0.0), (-22.0, 0.0)]);
    let strokes = [
        (StrokeClass::Pot, pot),
        (StrokeClass::Pot, rim),
        (StrokeClass::Axis, line((0.0, 8.0), (0.0, 70.0))),
        (StrokeClass::Blade, leaf((0.0, 40.0), (30.0, 60.0), 10.0)),
    ];
    let (r, _) = reading(&strokes);
    let [pot] = &r.pots[..] else { panic!("{:?}", r.pots) };
    assert_eq!((pot.lines.len(), pot.source), (2, Some(0)));
    assert!(r.strokes[..2].iter().all(|s| s.organ == crate::OrganWord::Pot));
}

#[test]
fn green_is_no_bark_in_a_painted_drawing() {
    let lines = [line((3.0, 0.0), (4.0, 9.0)), line((5.0, 0.0), (6.0, 9.0)), circle((5.0, 10.0), 1.5)];
    let mut drawing = Drawing::from_polylines("herb", &lines);
    let woods = |drawing: &Drawing| {
        let ink = clean(drawing, &mut Report::default());
        let class = |k: u32| if k < 2 { StrokeClass::TrunkOutline } else { StrokeClass::Blade };
        let classes: Vec<Classified> = ink.strokes.iter().map(|s| perhaps(class(s.index), 0.5)).collect();
        let r = read_without(&[READ_AS], &ink, &classes, &mut Report::default());
        (r.strokes.iter().filter(|s| s.class == StrokeClass::TrunkOutline).count(), r.woody)
    };
    assert_eq!(woods(&drawing).0, 2);
    for (stroke, color) in drawing.strokes.iter_mut().zip([[60, 140, 40], [60, 140, 40], [250, 220, 30]]) {
        stroke.color = Some(color);
    }
    assert_eq!(woods(&drawing), (0, false));
    // An outline that is pointed at both ends is a leaf, and one that branches may be a stem.
    let is_blade = |outline: Vec<DVec2>| {
        let mut painted = Drawing::from_polylines("herb", &[outline, circle((4.0, 7.0), 1.5)]);
        painted.strokes[0].color = Some([60, 140, 40]);
        painted.strokes[1].color = Some([250, 220, 30]);
        let ink = clean(&painted, &mut Report::default());
        let classes = [perhaps(StrokeClass::TrunkOutline, 0.3), perhaps(StrokeClass::Blade, 0.5)];
        let r = read_without(&[READ_AS], &ink, &classes, &mut Report::default());
        r.strokes[0].class == StrokeClass::Blade
    };
    assert!(is_blade(leaf((0.0, 0.0), (4.0, 6.0), 1.2)));
    assert!(!is_blade(path(&[(3.0, 0.0), (3.0, 8.0), (4.0, 8.0), (4.0, 0.0), (3.0, 0.0)])));
    // In a drawing of one colour, green is the pen's.
    drawing.strokes.iter_mut().for_each(|s| s.color = Some([60, 140, 40]));
    assert_eq!(woods(&drawing).0, 2);
}

#[test]
fn a_stem_of_two_lines_under_a_wide_flower_is_no_wood() {
    let head = (5.0, 20.0);
    let mut strokes: Vec<(StrokeClass, Vec<DVec2>)> = vec![
        (StrokeClass::TrunkOutline, line((4.8, 0.0), (4.8, 19.0))),
        (StrokeClass::TrunkOutline, line((5.2, 0.0), (5.2, 19.0))),
        (StrokeClass::Disc, circle(head, 0.8)),
        (StrokeClass::Blade, leaf((5.2, 8.0), (9.0, 10.0), 0.8)),
    ];
    strokes.extend(petals(head, 8, 3.0).into_iter().map(|p| (StrokeClass::Blade, p)));
    let (r, _) = reading(&strokes);
    assert_eq!((r.flowers.len(), r.woody), (1, false));
    // A blossom that is small compared with the trunk leaves it wood.
    strokes[0].1 = line((2.0, 0.0), (2.0, 17.0));
    strokes[1].1 = line((8.0, 0.0), (8.0, 17.0));
    let (r, _) = reading(&strokes);
    assert!(r.woody, "{:?}", r.strokes);
}
