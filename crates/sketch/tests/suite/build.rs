//! Readings made by hand and at random -> plants.

use crate::tools;
use base::{CancelToken, Report, Run, Seed, ops};
use glam::{DVec2, DVec3};
use plant::{AxisId, AxisKind, Lift, OrganKind, Paint, Plant, Shape};
use proptest::prelude::*;
use reading::{
    Attachment, AxisReading, BladeReading, DiscReading, FlowerReading, FruitReading, PlantReading,
    PotReading, Reading, RegionKind, RegionReading, VeinReading,
};
use sketch::{BranchDepth, Built, LeafDepth, SketchSpec, build};
use tools::{blade, made, v};

fn around(k: u32, n: u32, phase: f64) -> DVec2 {
    let (s, c) = ops::sin_cos(ops::TAU * f64::from(k) / f64::from(n) + phase);
    v(c, s)
}

fn axis(points: Vec<DVec2>, bearer: Option<(usize, f64)>, source: u32) -> AxisReading {
    AxisReading {
        points,
        kind: AxisKind::Stem,
        bearer: bearer.map(|(axis, at)| Attachment { axis, at }),
        half_width: vec![],
        source: Some(source),
    }
}

fn daisy(centre: DVec2, n: u32, size: f64, first_source: u32) -> FlowerReading {
    let petals = (0..n)
        .map(|k| {
            let d = around(k, n, 0.3);
            blade(centre + d * (0.2 * size), centre + d * size, 0.45, first_source + k)
        })
        .collect();
    let disc = Some(DiscReading { centre, radius: 0.2 * size, source: Some(first_source + n), color: None });
    FlowerReading { centre, petals, disc, stamens: vec![], bearer: None }
}

fn herb() -> Reading {
    let wavy = (0..=30).map(f64::from).map(|i| v(0.3 + 0.02 * ops::sin(i * 0.2), i * 0.02)).collect();
    let mut flower = daisy(v(0.30, 0.62), 7, 0.16, 10);
    flower.bearer = Some(Attachment { axis: 0, at: 0.61 });
    let mut leaves = Vec::new();
    for i in 0..5_u32 {
        let h = 0.1 + 0.08 * f64::from(i);
        let side = if i % 2 == 0 { 1.0 } else { -1.0 };
        let mut leaf = blade(v(0.3 + 0.03 * side, h), v(0.3 + 0.16 * side, h + 0.08), 0.4, 1 + i);
        leaf.bearer = Some(Attachment { axis: 0, at: h });
        leaves.push(leaf);
    }
    Reading { axes: vec![axis(wavy, None, 0)], flowers: vec![flower], leaves, ..Reading::default() }
}

fn tree() -> Reading {
    let mut axes = vec![axis(vec![v(0.3, 0.0), v(0.31, 0.4), v(0.3, 0.8)], None, 0)];
    for i in 0..6_u32 {
        let h = 0.3 + 0.07 * f64::from(i);
        let side = if i % 2 == 0 { 1.0 } else { -1.0 };
        let at = geom::closest_on_polyline(&axes[0].points, v(0.3, h)).expect("a line");
        let line = vec![at.point, at.point + v(0.12 * side, 0.05), at.point + v(0.2 * side, 0.15)];
        axes.push(axis(line, Some((0, at.at)), i + 1));
    }
    axes.iter_mut().for_each(|a| a.kind = AxisKind::Branch);
    Reading { axes, woody: true, ..Reading::default() }
}

/// The front view of every drawn blade of a kind, in ink.
fn front(built: &Built, kind: OrganKind) -> Vec<(u32, Vec<DVec2>)> {
    let plant = &built.plant;
    let organs = plant.organs.iter().filter(|o| o.kind == kind);
    organs
        .filter_map(|o| {
            let Shape::Blade(b) = &plant.shapes[o.shape.index()] else { return None };
            let points = b.surface().points(&b.outline).into_iter().map(|p| o.frame.place(p, o.scale));
            Some((o.source?, points.map(|p| built.map.ink_from_plant(p.truncate())).collect()))
        })
        .collect()
}

fn same_loop(a: &[DVec2], b: &[DVec2]) -> f64 {
    let nearest = |p: DVec2, of: &[DVec2]| of.iter().map(|q| q.distance(p)).fold(f64::INFINITY, f64::min);
    a.iter().map(|&p| nearest(p, b)).chain(b.iter().map(|&p| nearest(p, a))).fold(0.0, f64::max)
}

#[test]
fn front_view_of_petals_and_drawn_leaves_is_the_drawing() {
    let reading = herb();
    for flipped_flowers in [vec![], vec![0]] {
        let built = made(&reading, &SketchSpec { flipped_flowers, ..SketchSpec::default() });
        assert_eq!(built.plant.validate().next(), None);
        for (kind, drawn) in [
            (OrganKind::Petal, reading.flowers[0].petals.iter().collect::<Vec<_>>()),
            (OrganKind::Leaf, reading.leaves.iter().collect()),
        ] {
            let seen = front(&built, kind);
            assert_eq!(seen.len(), drawn.len());
            for blade in drawn {
                let (_, outline) = seen.iter().find(|s| Some(s.0) == blade.source).expect("there");
                assert!(same_loop(outline, &blade.outline) < 1e-9, "{kind:?} {:?}", blade.source);
            }
        }
    }
}

#[test]
fn axes_project_onto_their_strokes() {
    let reading = tree();
    for branch_depth in [BranchDepth::Paper, BranchDepth::Riesz] {
        let built = made(&reading, &SketchSpec { branch_depth, ..SketchSpec::default() });
        assert_eq!(built.plant.validate().next(), None);
        for (i, a) in built.plant.axes.iter().enumerate() {
            let line = &reading.axes[a.source.expect("drawn") as usize].points;
            for p in built.plant.axis_points(AxisId::new(i)) {
                let ink = built.map.ink_from_plant(p.truncate());
                let off = geom::closest_on_polyline(line, ink).expect("a line").distance;
                assert!(off < 1e-9, "axis {i}: {off}");
            }
        }
        let depth = built.plant.nodes.position.iter().map(|p| p.z.abs()).fold(0.0, f64::max);
        assert!(depth > 0.5, "an 8 m tree has depth, not {depth}");
    }
}

#[test]
fn a_made_cone_is_recovered() {
    // 8 petals on a cone of half angle 40 degrees whose axis is 35 degrees out of the sheet.
    let (theta, half) = (35.0_f64.to_radians(), 40.0_f64.to_radians());
    let axis = DVec3::new(0.0, ops::cos(theta), ops::sin(theta));
    let across = axis.cross(DVec3::X);
    let tip = |k: u32| {
        let d = around(k, 8, 0.2);
        (axis * ops::cos(half) + (DVec3::X * d.x + across * d.y) * ops::sin(half)) * 0.2
    };
    let centre = v(0.5, 0.3);
    let petals = (0..8).map(|k| blade(centre, centre + tip(k).truncate(), 0.2, k)).collect();
    let flower = FlowerReading { centre, petals, disc: None, stamens: vec![], bearer: None };
    let built = made(&Reading { flowers: vec![flower], ..Reading::default() }, &SketchSpec::default());
    let got = &built.plant.flowers[0];
    assert!((got.half_angle - half).abs() < 1e-6, "{} {half}", got.half_angle);
    assert!(got.axis.distance(axis) < 1e-6, "{}", got.axis);
    let petals = built.plant.organs.iter().filter(|o| o.kind == OrganKind::Petal);
    for o in petals {
        let Shape::Blade(b) = &built.plant.shapes[o.shape.index()] else { panic!("a blade") };
        let mut flat = b.clone();
        flat.relief = plant::Relief::default();
        let z = o.frame.place(flat.point(*b.midrib.last().expect("a tip")), 1.0).z - got.centre.z;
        let want = tip(o.source.expect("drawn")).z * built.map.metres_per_ink;
        // Neighbours are set apart by 1.5 % of a petal, the last of an odd ring by twice that.
        assert!((z - want).abs() < 0.035 * 0.2 * built.map.metres_per_ink, "{:?}: {z} {want}", o.source);
    }
}

#[test]
fn edge_on_flowers_keep_their_area_and_use_both_sheets() {
    let centre = v(0.5, 0.2);
    let petals = (0..5_u32)
        .map(|k| {
            let x = -0.16 + 0.08 * f64::from(k);
            blade(centre + v(0.2 * x, 0.0), v(0.5 + x, 0.42), 0.4, k)
        })
        .collect();
    let flower = FlowerReading { centre, petals, disc: None, stamens: vec![], bearer: None };
    let built = made(&Reading { flowers: vec![flower], ..Reading::default() }, &SketchSpec::default());
    assert_eq!(built.plant.validate().next(), None);
    let mut sides = [0, 0];
    for o in built.plant.organs.iter().filter(|o| o.kind == OrganKind::Petal) {
        let Shape::Blade(b) = &built.plant.shapes[o.shape.index()] else { panic!("a blade") };
        let points: Vec<DVec3> =
            b.surface().points(&b.outline).iter().map(|&p| o.frame.place(p, 1.0)).collect();
        let area: f64 = (1..points.len() - 1)
            .map(|i| 0.5 * (points[i] - points[0]).cross(points[i + 1] - points[0]).length())
            .sum();
        assert!(area > 1e-4, "{area}");
        sides[usize::from(points.iter().map(|p| p.z).sum::<f64>() > 0.0)] += 1;
    }
    assert!(sides[0] >= 2 && sides[1] >= 2, "{sides:?}");
}

#[test]
fn a_flower_in_profile_is_as_deep_as_it_is_wide() {
    let centre = v(0.5, 0.2);
    for n in [3_u32, 5] {
        // A fan of 90 degrees that opens upwards.
        let petals = (0..n).map(|k| {
            let turn = (0.5 * ops::FRAC_PI_2) * (1.0 - 2.0 * f64::from(k) / f64::from(n - 1));
            blade(centre, centre + v(-ops::sin(turn), ops::cos(turn)) * 0.2, 0.5, k)
        });
        let petals = petals.collect();
        let flower = FlowerReading { centre, petals, disc: None, stamens: vec![], bearer: None };
        let built = made(&Reading { flowers: vec![flower], ..Reading::default() }, &SketchSpec::default());
        let got = &built.plant.flowers[0];
        assert!(got.axis.distance(DVec3::Y) < 1e-9, "{}", got.axis);
        assert!((0.5..0.8).contains(&got.half_angle), "{}", got.half_angle);
        let petals = built.plant.organs.iter().filter(|o| o.kind == OrganKind::Petal);
        let points = petals.clone().flat_map(|o| {
            let Shape::Blade(b) = &built.plant.shapes[o.shape.index()] else { panic!("a blade") };
            let points = b.surface().points(&b.outline);
            points.into_iter().map(|p| o.frame.place(p, 1.0)).collect::<Vec<_>>()
        });
        let far = points.fold(DVec3::ZERO, |far, p| far.max((p - got.centre).abs()));
        assert!((0.7..1.2).contains(&(far.z / far.x)), "{n}: {far}");
        // Each petal has another one behind it or in front of it.
        assert_eq!(petals.count(), 2 * n as usize);
    }
}

#[test]
fn inner_whorls_stand_steeper_and_nearer() {
    let mut flower = daisy(v(0.5, 0.5), 6, 0.2, 0);
    let mut inner = daisy(v(0.5, 0.5), 6, 0.2, 10).petals;
    inner.iter_mut().for_each(|p| p.whorl = 1);
    flower.petals.extend(inner);
    let built = made(&Reading { flowers: vec![flower], ..Reading::default() }, &SketchSpec::default());
    assert_eq!(built.plant.flowers[0].whorls, 2);
    let tip = |source: u32| {
        let o = built.plant.organs.iter().find(|o| o.source == Some(source)).expect("there");
        let Shape::Blade(b) = &built.plant.shapes[o.shape.index()] else { panic!("a blade") };
        let Lift::Cone { cone, .. } = b.lift else { panic!("on a cone") };
        (o.frame.place(b.point(*b.midrib.last().expect("tip")), 1.0).z, cone.half_angle)
    };
    let (outer, inner) = (tip(0), tip(10));
    assert!(inner.0 > outer.0 && inner.1 < outer.1, "{outer:?} {inner:?}");
}

#[test]
fn the_same_seed_gives_the_same_plant_and_another_seed_another() {
    let digest = |seed: u64| {
        let run = Run::plain();
        let built = build(&herb(), &SketchSpec::default(), Seed::new(seed), &run, &mut Report::default());
        built.expect("not cancelled").plant.digest_hex()
    };
    assert_eq!(digest(1), digest(1));
    assert_ne!(digest(1), digest(2));
}

#[test]
fn a_new_leaf_leaves_the_other_organs_as_they_were() {
    let reading = herb();
    let mut more = reading.clone();
    let mut leaf = blade(v(0.33, 0.14), v(0.45, 0.1), 0.4, 90);
    leaf.bearer = Some(Attachment { axis: 0, at: 0.14 });
    more.leaves.insert(2, leaf);
    let (a, b) = (made(&reading, &SketchSpec::default()), made(&more, &SketchSpec::default()));
    for o in a.plant.organs.iter().filter(|o| o.source.is_some()) {
        let p = b.plant.organs.iter().find(|p| p.source == o.source && p.kind == o.kind).expect("there");
        assert_eq!((o.key, o.frame, o.paint), (p.key, p.frame, p.paint));
        assert_eq!(a.plant.shapes[o.shape.index()], b.plant.shapes[p.shape.index()]);
    }
}

#[test]
fn cancelling_stops_the_build() {
    let token = CancelToken::new();
    token.cancel();
    let run = Run { cancel: &token, ..Run::plain() };
    let got = build(&herb(), &SketchSpec::default(), Seed::new(1), &run, &mut Report::default());
    assert!(got.is_err());
}

#[test]
fn heights_are_those_asked_for() {
    for (woody, height_m, want) in
        [(true, None, 8.0), (false, None, 0.5), (false, Some(1.2), 1.2), (true, Some(f64::NAN), 8.0)]
    {
        let built = made(&Reading { woody, ..tree() }, &SketchSpec { height_m, ..SketchSpec::default() });
        let top = built.plant.nodes.position.iter().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max);
        assert!((top - want).abs() < 1e-9, "{top} {want}");
        assert_eq!(built.plant.nodes.position[0], DVec3::ZERO, "the main axis stands at the origin");
    }
}

#[test]
fn light_modes_lay_leaves_flat() {
    for leaf_depth in [LeafDepth::Paper, LeafDepth::Signed] {
        let built = made(&herb(), &SketchSpec { leaf_depth, ..SketchSpec::default() });
        assert_eq!(built.plant.validate().next(), None);
        for o in built.plant.organs.iter().filter(|o| o.kind == OrganKind::Leaf) {
            assert!(o.frame.normal.y > 0.8, "within 30 degrees of the horizontal: {}", o.frame.normal);
        }
    }
}

#[test]
fn a_disc_that_nobody_drew_fills_the_ring_of_the_roots() {
    for ring in [0.2, 0.3, 0.4] {
        let mut flower = daisy(v(0.5, 0.5), 8, 0.2, 0);
        flower.disc = None;
        for (k, petal) in (0..).zip(&mut flower.petals) {
            let d = around(k, 8, 0.3);
            *petal = blade(v(0.5, 0.5) + d * (0.2 * ring), v(0.5, 0.5) + d * 0.2, 0.3, k);
        }
        let built = made(&Reading { flowers: vec![flower], ..Reading::default() }, &SketchSpec::default());
        let disc = built.plant.organs.iter().find(|o| o.kind == OrganKind::Disc).expect("a disc");
        let Shape::Dome { radius_m, .. } = built.plant.shapes[disc.shape.index()] else { panic!("a dome") };
        let drawn = 0.2 * ring * built.map.metres_per_ink;
        assert!((radius_m / drawn - 1.0).abs() < 0.02, "{radius_m} m in a ring of {drawn} m");
    }
}

#[test]
fn a_petal_that_goes_leaves_the_colours_of_the_flower() {
    for disc in [true, false] {
        let mut reading = herb();
        reading.flowers[0] = daisy(v(0.30, 0.62), 10, 0.16, 10);
        reading.flowers[0].bearer = Some(Attachment { axis: 0, at: 0.61 });
        if !disc {
            reading.flowers[0].disc = None;
        }
        let all = made(&reading, &SketchSpec::default()).plant;
        let known: std::collections::BTreeMap<u64, Paint> =
            all.organs.iter().map(|o| (o.key, o.paint)).collect();
        for gone in 0..10 {
            let mut fewer = reading.clone();
            fewer.flowers[0].petals.remove(gone);
            let plant = made(&fewer, &SketchSpec::default()).plant;
            assert_eq!(plant.organs.len() + 1, all.organs.len());
            for o in &plant.organs {
                assert_eq!(
                    known.get(&o.key),
                    Some(&o.paint),
                    "{:?} {:?} without petal {gone}",
                    o.kind,
                    o.source
                );
            }
        }
    }
}

#[test]
fn signed_leaves_fill_all_round_their_stem() {
    // Stems upright, leaning and level, with leaves of any slope on both sides.
    for lean in [0.0, 0.7, 1.5] {
        let (s, c) = ops::sin_cos(lean);
        let (along, across) = (v(s, c), v(c, -s));
        let foot = v(0.3, 0.1);
        let mut reading = Reading { axes: vec![axis(vec![foot, foot + along * 0.6], None, 0)], ..herb() };
        reading.leaves = (0..24_u32)
            .map(|i| {
                let (h, side) = (0.02 + 0.024 * f64::from(i), if i % 2 == 0 { 1.0 } else { -1.0 });
                let out = across * (0.1 * side) + along * (0.02 * f64::from(i % 5));
                let mut leaf = blade(foot + along * h, foot + along * h + out, 0.3, 1 + i);
                leaf.bearer = Some(Attachment { axis: 0, at: h });
                leaf
            })
            .collect();
        reading.flowers.clear();
        let spec = SketchSpec { leaf_depth: LeafDepth::Signed, ..SketchSpec::default() };
        for seed in 1..=12 {
            let built = build(&reading, &spec, Seed::new(seed), &Run::plain(), &mut Report::default());
            let plant = built.expect("not cancelled").plant;
            let leaves: Vec<_> = plant.organs.iter().filter(|o| o.kind == OrganKind::Leaf).collect();
            let front = leaves.iter().filter(|o| o.frame.along.z > 0.0).count();
            // By chance: 4 to 20 of 24 but once in 7,000.
            assert!((4..=20).contains(&front), "lean {lean}, seed {seed}: {front} of 24 in front");
            let kept = |o: &&&plant::Organ| {
                let drawn = &reading.leaves[o.source.expect("drawn") as usize - 1];
                let x = drawn.tip.x - drawn.root.x;
                x.abs() < 0.03 || o.frame.along.x * x > -0.03
            };
            assert!(leaves.iter().filter(kept).count() >= 20, "lean {lean}, seed {seed}: left and right");
        }
    }
}

#[test]
fn drawn_leaves_fan_out_in_depth() {
    let built = made(&herb(), &SketchSpec::default());
    let mut tips = Vec::new();
    for o in built.plant.organs.iter().filter(|o| o.kind == OrganKind::Leaf) {
        let Shape::Blade(b) = &built.plant.shapes[o.shape.index()] else { panic!("a blade") };
        tips.push(o.frame.place(b.point(*b.midrib.last().expect("tip")), 1.0).z);
    }
    let spread = tips.iter().copied().fold(f64::NEG_INFINITY, f64::max)
        - tips.iter().copied().fold(f64::INFINITY, f64::min);
    assert!(spread > 0.02, "a herb of half a metre is no card: {tips:?}");
}

#[test]
fn leaflets_lie_in_the_plane_of_their_rachis() {
    let stem = axis(vec![v(0.3, 0.0), v(0.3, 0.8)], None, 0);
    let rachis = axis(vec![v(0.3, 0.3), v(0.6, 0.6)], Some((0, 0.3)), 1);
    let along = v(1.0, 1.0).normalize();
    let mut reading = Reading { axes: vec![stem, rachis], ..Reading::default() };
    for i in 0..8_u32 {
        let at = 0.08 + 0.08 * f64::from(i / 2);
        let side = if i % 2 == 0 { along.perp() } else { -along.perp() };
        let root = v(0.3, 0.3) + along * at;
        let mut leaf = blade(root, root + (side + along * 0.4) * 0.08, 0.4, 2 + i);
        leaf.bearer = Some(Attachment { axis: 1, at });
        reading.leaves.push(leaf);
    }
    for seed in 1..=8 {
        let built =
            build(&reading, &SketchSpec::default(), Seed::new(seed), &Run::plain(), &mut Report::default());
        let built = built.expect("not cancelled");
        let rachis = built.plant.axis_points(AxisId::new(1));
        let (foot, end) = (rachis[0], rachis[rachis.len() - 1]);
        assert!((end.z - foot.z).abs() > 0.01, "seed {seed}: it leaves the plane of the drawing");
        let way = (end - foot).normalize();
        // The plane of the leaf: the rachis, and the direction across it in the drawing.
        let normal = way.cross(along.perp().extend(0.0)).normalize();
        for o in built.plant.organs.iter().filter(|o| o.kind == OrganKind::Leaf) {
            let Shape::Blade(b) = &built.plant.shapes[o.shape.index()] else { panic!("a blade") };
            let Lift::Tilt { slope } = b.lift else { panic!("tilted") };
            let tip = *b.midrib.last().expect("tip");
            let lifted = o.frame.place(tip.extend(slope.dot(tip)), 1.0) - o.frame.origin;
            let off = lifted.normalize().dot(normal).abs();
            assert!(off < 0.12, "seed {seed}: {off} out of the plane");
        }
    }
}

#[test]
fn a_flower_of_one_petal_is_a_bell_with_a_wall_and_an_open_end() {
    let mut bell = blade(v(0.3, 0.5), v(0.3, 0.4), 0.8, 1);
    bell.outline = vec![v(0.3, 0.5), v(0.27, 0.48), v(0.25, 0.4), v(0.35, 0.4), v(0.33, 0.48)];
    let stem = axis(vec![v(0.3, 0.0), v(0.31, 0.3), v(0.3, 0.5)], None, 0);
    let bearer = Some(Attachment { axis: 0, at: 0.5 });
    let flower = FlowerReading { centre: bell.root, petals: vec![bell], disc: None, stamens: vec![], bearer };
    let reading = Reading { axes: vec![stem], flowers: vec![flower], ..Reading::default() };
    let built = made(&reading, &SketchSpec::default());
    let petals: Vec<_> = built.plant.organs.iter().filter(|o| o.kind == OrganKind::Petal).collect();
    assert_eq!((petals.len(), built.plant.flowers.len()), (1, 1));
    let Shape::Revolution { profile } = &built.plant.shapes[petals[0].shape.index()] else {
        panic!("a bell")
    };
    let widest = profile.iter().map(|p| p.x).fold(0.0, f64::max);
    let long = profile.iter().map(|p| p.y).fold(0.0, f64::max);
    let rim: Vec<f64> = profile.iter().filter(|p| p.y > 0.99 * long).map(|p| p.x).collect();
    assert!(rim.len() == 2 && rim.iter().all(|r| *r > 0.7 * widest), "{profile:?}");
    assert!(petals[0].frame.along.y < -0.9, "it hangs");
}

#[test]
fn coloured_pens_colour_organs_and_one_pen_does_not() {
    let tints = |leaf: [u8; 3], petal: [u8; 3]| {
        let mut reading = herb();
        reading.leaves.iter_mut().for_each(|b| b.color = Some(leaf));
        reading.flowers[0].petals.iter_mut().for_each(|b| b.color = Some(petal));
        let built = made(&reading, &SketchSpec::default());
        let of = |kind| built.plant.organs.iter().find(|o| o.kind == kind).expect("there").paint;
        (of(OrganKind::Leaf), of(OrganKind::Petal))
    };
    let (leaf, petal) = tints([40, 160, 30], [230, 40, 90]);
    let (Paint::Drawn(leaf), Paint::Drawn(petal)) = (leaf, petal) else { panic!("{leaf:?} {petal:?}") };
    assert!(leaf[1] > 3.0 * leaf[0] && petal[0] > 3.0 * petal[1], "{leaf:?} {petal:?}");
    for one in [[0, 0, 0], [20, 20, 230]] {
        let (leaf, petal) = tints(one, one);
        let (Paint::Natural(leaf), Paint::Natural(petal)) = (leaf, petal) else {
            panic!("{leaf:?} {petal:?}")
        };
        assert!(leaf.iter().chain(&petal).all(|c| (0.8..1.2).contains(c)), "a pen's colour: {leaf:?}");
    }
}

#[test]
fn leaves_take_the_colour_of_their_crown() {
    let mut reading = tree();
    for (x, color) in [(0.15, [40, 160, 30]), (0.45, [230, 60, 20])] {
        reading.regions.push(RegionReading {
            outline: (0..40).map(|k| v(x, 0.7) + around(k, 40, 0.0) * 0.14).collect(),
            kind: RegionKind::Crown,
            bearers: vec![0],
            source: Some(20),
            color: Some(color),
        });
    }
    let built = made(&reading, &SketchSpec::default());
    let leaves = || built.plant.organs.iter().filter(|o| o.kind == OrganKind::Leaf).map(|o| o.paint.rgb());
    let (green, red) = (leaves().filter(|t| t[1] > 2.0 * t[0]), leaves().filter(|t| t[0] > 2.0 * t[1]));
    let (green, red) = (green.count(), red.count());
    assert!(green > 20 && red > 20 && green + red == leaves().count(), "{green} green, {red} red");
}

#[test]
fn stalks_bridge_the_gap_to_the_bearer() {
    let built = made(&herb(), &SketchSpec::default());
    for o in built.plant.organs.iter().filter(|o| o.kind == OrganKind::Leaf) {
        let node = o.bearer.expect("borne");
        assert!(built.plant.nodes.position[node.index()].distance(o.frame.origin) < 1e-12);
    }
    assert!(built.plant.axes.iter().any(|a| a.kind == AxisKind::Petiole && a.source.is_none()));
}

#[test]
fn radii_are_sane_for_trees_and_herbs() {
    let (tree, herb) = (made(&tree(), &SketchSpec::default()), made(&herb(), &SketchSpec::default()));
    let base = |b: &Built| b.plant.nodes.radius_m[0];
    assert!((0.1..0.35).contains(&base(&tree)), "{}", base(&tree));
    assert!((0.003..0.01).contains(&base(&herb)), "{}", base(&herb));
    for b in [&tree, &herb] {
        for (i, a) in b.plant.axes.iter().enumerate() {
            let r = b.plant.axis_radii(AxisId::new(i));
            assert!(r.iter().all(|r| *r > 0.0) && r.windows(2).all(|w| w[1] <= w[0] + 1e-15));
            assert!(a.bearer.is_none_or(|n| r[0] <= b.plant.nodes.radius_m[n.index()]));
        }
    }
}

#[test]
fn what_is_drawn_in_a_crown_hangs_on_what_grows_there() {
    let ring = |centre: DVec2, r: f64| (0..40).map(|k| centre + around(k, 40, 0.0) * r).collect::<Vec<_>>();
    let mut reading = tree();
    reading.regions.push(RegionReading {
        outline: ring(v(0.3, 0.6), 0.3),
        kind: RegionKind::Crown,
        bearers: vec![0],
        source: Some(20),
        color: None,
    });
    let outline = ring(v(0.42, 0.6), 0.03);
    reading.fruits.push(FruitReading { outline, bearer: None, source: Some(21), color: None });
    let built = made(&reading, &SketchSpec::default());
    assert_eq!(built.plant.validate().next(), None);
    let fruit = built.plant.organs.iter().find(|o| o.kind == OrganKind::Fruit).expect("an apple");
    assert!(fruit.bearer.is_some(), "it hangs on a twig");
}

fn any_point() -> impl Strategy<Value = DVec2> {
    let coordinate = prop_oneof![
        24 => -0.2..1.2_f64,
        4 => Just(0.5),
        1 => prop_oneof![Just(f64::NAN), Just(f64::INFINITY), Just(1e300), Just(-1e12), Just(1e-300)],
    ];
    (coordinate.clone(), coordinate).prop_map(|(x, y)| v(x, y))
}

fn any_line(most: usize) -> impl Strategy<Value = Vec<DVec2>> {
    prop_oneof![
        4 => prop::collection::vec(any_point(), 0..most),
        1 => (any_point(), 0..most).prop_map(|(p, n)| vec![p; n]),
    ]
}

fn any_bearer() -> impl Strategy<Value = Option<Attachment>> {
    prop::option::of((0..6_usize, prop_oneof![4 => -0.5..2.0_f64, 1 => Just(f64::NAN)]))
        .prop_map(|b| b.map(|(axis, at)| Attachment { axis, at }))
}

fn any_axis() -> impl Strategy<Value = AxisReading> {
    let kinds = [AxisKind::Branch, AxisKind::Stem, AxisKind::Petiole, AxisKind::Root, AxisKind::Twig];
    let kind = prop::sample::select(kinds.to_vec());
    (any_line(9), kind, any_bearer(), prop::bool::ANY, prop::option::of(0..5_u32)).prop_map(
        |(points, kind, bearer, wide, source)| {
            let half_width = if wide { points.iter().map(|p| 0.05 * p.x).collect() } else { vec![] };
            AxisReading { points, kind, bearer, half_width, source }
        },
    )
}

fn any_blade() -> impl Strategy<Value = BladeReading> {
    (any_line(9), any_point(), any_point(), any_line(4), any_bearer(), 0..3_u32, prop::option::of(0..5_u32))
        .prop_map(|(outline, root, tip, midrib, bearer, whorl, source)| BladeReading {
            veins: vec![VeinReading { points: midrib.clone(), source }],
            outline,
            root,
            tip,
            midrib,
            bearer,
            whorl,
            front: None,
            source,
            color: None,
        })
}

fn any_flower() -> impl Strategy<Value = FlowerReading> {
    let disc = prop::option::of((any_point(), -0.1..0.3_f64));
    let stamens = prop::collection::vec(any_line(4), 0..3);
    (any_point(), prop::collection::vec(any_blade(), 0..7), disc, stamens, any_bearer()).prop_map(
        |(centre, petals, disc, stamens, bearer)| FlowerReading {
            centre,
            petals,
            disc: disc.map(|(centre, radius)| DiscReading { centre, radius, source: None, color: None }),
            stamens,
            bearer,
        },
    )
}

prop_compose! {
    fn any_reading()(
        axes in prop::collection::vec(any_axis(), 0..6),
        flowers in prop::collection::vec(any_flower(), 0..3),
        leaves in prop::collection::vec(any_blade(), 0..4),
        fruits in prop::collection::vec((any_line(8), any_bearer()), 0..3),
        thorns in prop::collection::vec((any_line(4), any_bearer()), 0..3),
        woody in prop::bool::ANY,
    ) -> Reading {
        let fruits = fruits.into_iter().map(|(outline, bearer)| FruitReading {
            outline, bearer, source: None, color: None,
        }).collect();
        let thorns = thorns.into_iter().map(|(line, bearer)| (line, bearer, None)).collect();
        Reading { axes, flowers, leaves, fruits, thorns, woody, ..Reading::default() }
    }
}

fn all_finite(plant: &Plant) -> bool {
    plant.organs.iter().all(|o| o.frame.origin.is_finite())
        && plant.nodes.position.iter().all(|p| p.is_finite())
        && plant.nodes.radius_m.iter().all(|r| r.is_finite())
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(300) })]
    #[test]
    fn any_reading_gives_a_sound_plant(
        reading in any_reading(),
        paper in prop::bool::ANY,
        leaf_depth in prop::sample::select(vec![LeafDepth::Paper, LeafDepth::Signed, LeafDepth::Drawn]),
        pull in prop::sample::select(vec![0.0, 0.7, f64::NAN]),
    ) {
        let branch_depth = if paper { BranchDepth::Paper } else { BranchDepth::Riesz };
        let mut spec = SketchSpec {
            branch_depth, leaf_depth, phototropism: pull, gravity: pull, ..SketchSpec::default()
        };
        spec.relief.leaf_bend_b = pull;
        let built = made(&reading, &spec);
        prop_assert_eq!(built.plant.validate().next(), None);
        prop_assert!(all_finite(&built.plant));
        prop_assert_eq!(built.plant.digest_hex(), made(&reading, &spec).plant.digest_hex());
    }
}

#[test]
fn contours_by_the_thousand_share_the_leaves() {
    let contours = |n: u32| {
        let mut reading = tree();
        reading.regions = (0..n)
            .map(|i| {
                let centre = v(0.05 * f64::from(i % 20), 0.3 + 0.05 * f64::from(i / 20 % 20));
                RegionReading {
                    outline: (0..16).map(|k| centre + around(k, 16, 0.0) * 0.1).collect(),
                    kind: RegionKind::Leaves,
                    bearers: vec![0],
                    source: Some(20 + i),
                    color: None,
                }
            })
            .collect();
        let mut spec = SketchSpec::default();
        spec.fill.density = 10.0;
        made(&reading, &spec).plant.organs.len()
    };
    let (few, many) = (contours(10), contours(3000));
    assert!(few > 1000, "{few}: density is kept");
    assert!((100_000..=200_000).contains(&many), "{many}: bounded, whatever is drawn");
}

#[test]
fn a_bold_line_is_thick_and_nothing_is_thicker_than_what_bears_it() {
    let stem = axis(vec![v(0.5, 0.0), v(0.5, 1.0)], None, 0);
    let twig = |at: f64, source| axis(vec![v(0.5, at), v(0.8, at + 0.2)], Some((0, at)), source);
    let plain = Reading { axes: vec![stem, twig(0.4, 1), twig(0.6, 2)], ..Reading::default() };
    let radii = |pressed: Vec<(u32, f64)>| -> Vec<f64> {
        let plant = made(&Reading { pressed, ..plain.clone() }, &SketchSpec::default()).plant;
        (0..3).map(|k| plant.axis_radii(AxisId::new(k))[0]).collect()
    };
    let usual = radii(Vec::new());
    let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
    // A bold stem carries thicker twigs; a light twig is thinner than the other.
    let bold = radii(vec![(0, 1.6), (2, 0.5)]);
    assert!(near(bold[0], 1.6 * usual[0]) && near(bold[1], 1.6 * usual[1]), "{usual:?} {bold:?}");
    assert!(near(bold[2], 0.5 * usual[2]), "{usual:?} {bold:?}");
    // The trunk limits even a boldly drawn twig.
    let thin = radii(vec![(0, 0.5), (1, 2.0)]);
    assert!(thin[1] <= thin[0], "{thin:?}");
    assert_eq!(radii(vec![(0, f64::NAN), (9, 2.0)]), usual);
}

#[test]
fn a_pot_stands_on_the_ground_and_bears_its_plant() {
    let axis = AxisReading {
        points: vec![v(0.5, 0.4), v(0.5, 1.0)],
        kind: AxisKind::Stem,
        bearer: None,
        half_width: Vec::new(),
        source: Some(1),
    };
    let bare = Reading { axes: vec![axis], ..Reading::default() };
    // Wider above than below, and drawn in two strokes.
    let sides = vec![v(0.35, 0.4), v(0.4, 0.1), v(0.6, 0.1), v(0.65, 0.4)];
    let pot =
        PotReading { lines: vec![sides, vec![v(0.35, 0.4), v(0.65, 0.4)]], source: Some(0), color: None };
    let potted = Reading { pots: vec![pot], ..bare.clone() };
    let spec = SketchSpec { height_m: Some(0.6), ..SketchSpec::default() };
    let (bare, potted) = (made(&bare, &spec).plant, made(&potted, &spec).plant);
    let foot = |p: &Plant| p.nodes.position.iter().map(|n| n.y).fold(f64::INFINITY, f64::min);
    assert!(foot(&bare).abs() < 1e-9 && (foot(&potted) - 0.3).abs() < 1e-9, "{}", foot(&potted));
    let pots: Vec<_> = potted.organs.iter().filter(|o| o.kind == OrganKind::Pot).collect();
    assert_eq!(pots.len(), 2, "clay and soil");
    assert!(pots.iter().all(|o| o.frame.origin.y.abs() < 1e-9));
    let Shape::Revolution { profile } = &potted.shapes[pots[0].shape.index()] else { panic!("a vessel") };
    let tall = profile.iter().map(|p| p.y).fold(0.0, f64::max);
    let wide = profile.iter().map(|p| p.x).fold(0.0, f64::max);
    assert!((tall - 0.3).abs() < 1e-9 && (wide - 0.15).abs() < 0.005, "{tall} {wide}");
    // The pot is not measured.
    let [one, other] = [&bare, &potted].map(Plant::measure);
    assert_eq!((one.crown_volume_m3, one.leaf_area_m2), (other.crown_volume_m3, other.leaf_area_m2));
}

#[test]
fn what_lies_in_front_leans_to_the_viewer() {
    let slope = |front| {
        let leaf = BladeReading { front, ..blade(v(0.5, 0.5), v(0.9, 0.7), 0.1, 1) };
        let built = made(&Reading { leaves: vec![leaf], ..Reading::default() }, &SketchSpec::default());
        match &built.plant.shapes[built.plant.organs[0].shape.index()] {
            Shape::Blade(plant::Blade { lift: Lift::Tilt { slope }, .. }) => slope.y,
            other => panic!("{other:?}"),
        }
    };
    assert!(slope(Some(1.0)) > 0.1 && slope(Some(-1.0)) < -0.1 && slope(Some(0.0)).abs() < 1e-9);
    assert!(slope(None).abs() > 0.1, "by chance");
}

#[test]
fn a_crown_has_the_leaves_of_its_own_plant_and_a_pot_is_as_deep_as_the_plant_in_it() {
    let mut reading = tree();
    reading.leaves.clear();
    reading.regions.push(RegionReading {
        outline: (0..40).map(|k| v(0.3, 0.6) + around(k, 40, 0.0) * 0.3).collect(),
        kind: RegionKind::Crown,
        bearers: vec![0],
        source: Some(20),
        color: None,
    });
    // A blade of grass next to it.
    reading.leaves.push(blade(v(0.9, 0.0), v(0.95, 0.3), 0.02, 30));
    let shapes_of = |plants: Vec<PlantReading>| {
        let built = made(&Reading { plants, ..reading.clone() }, &SketchSpec::default());
        let leaves = built.plant.organs.iter().filter(|o| o.kind == OrganKind::Leaf && o.source != Some(30));
        let grass = built.plant.organs.iter().find(|o| o.source == Some(30)).expect("grass").shape;
        (leaves.clone().count(), leaves.filter(|o| o.shape == grass).count())
    };
    let plant = |strokes: &[u32]| PlantReading { strokes: strokes.to_vec(), ..PlantReading::default() };
    let (all, grass) = shapes_of(vec![plant(&[0, 1, 2, 3, 4, 5, 20]), plant(&[30])]);
    assert!(all > 100 && grass == 0, "{grass} of {all} leaves are grass");
    // Drawn for the same plant, it is its leaf.
    let (_, own) = shapes_of(vec![plant(&[0, 1, 2, 3, 4, 5, 20, 30])]);
    assert!(own > 10, "{own}");

    let stem = |x: f64, source| AxisReading {
        points: vec![v(x, 0.3), v(x, 0.9)],
        kind: AxisKind::Stem,
        bearer: None,
        half_width: Vec::new(),
        source: Some(source),
    };
    let pot = |x: f64, source| PotReading {
        lines: vec![vec![v(x - 0.1, 0.3), v(x - 0.07, 0.1), v(x + 0.07, 0.1), v(x + 0.1, 0.3)]],
        source: Some(source),
        color: None,
    };
    let row: Vec<f64> = (0..4).map(|k| 0.2 + 0.3 * f64::from(k)).collect();
    let axes = row.iter().zip(0..).map(|(x, k)| stem(*x, k)).collect();
    let pots = row.iter().zip(10..).map(|(x, k)| pot(*x, k)).collect();
    let built = made(&Reading { axes, pots, ..Reading::default() }, &SketchSpec::default());
    for organ in built.plant.organs.iter().filter(|o| o.kind == OrganKind::Pot) {
        let at = organ.frame.origin;
        let stands = |p: &&DVec3| (p.x - at.x).abs() < 1e-9 && (p.z - at.z).abs() < 1e-9;
        assert!(built.plant.nodes.position.iter().any(|p| stands(&p)), "a stem stands in the pot at {at}");
    }
}
