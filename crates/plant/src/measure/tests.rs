//! Every expected number here was derived by hand.

use base::ops::{self, PI};
use base::{Draw, Seed};
use glam::{DVec2, DVec3};
use proptest::prelude::*;

use crate::*;

fn near(a: f64, b: f64) {
    assert!((a - b).abs() <= 1e-9 * (1.0 + b.abs()), "{a} is not {b}");
}

/// Adds an axis with radii.
fn axis(p: &mut Plant, bearer: Option<NodeId>, line: &[DVec3], radii: &[f64]) -> AxisId {
    let id = p.add_axis(AxisKind::Branch, bearer, p.axes.len() as u64, line, None);
    let rows = p.axis(id).nodes.start as usize..p.axis(id).nodes.end as usize;
    p.nodes.radius_m[rows].copy_from_slice(radii);
    id
}

fn node(p: &Plant, axis: AxisId, k: usize) -> NodeId {
    p.axis(axis).node_ids().nth(k).expect("there")
}

/// Adds a square leaf of the given edge whose root is the centre of its lower edge.
fn square(p: &mut Plant, edge: f64, lift: Lift) -> ShapeId {
    let h = edge / 2.0;
    let outline = [(-h, 0.0), (h, 0.0), (h, edge), (-h, edge)].map(|(x, y)| DVec2::new(x, y)).to_vec();
    let midrib = vec![DVec2::ZERO, DVec2::new(0.0, edge)];
    p.add_shape(Shape::Blade(Blade {
        outline,
        midrib,
        veins: vec![],
        needles: None,
        lift,
        relief: Relief::default(),
    }))
}

fn leaf(p: &mut Plant, bearer: NodeId, shape: ShapeId, along: DVec3, scale: f64) {
    let frame = Frame::looking(p.nodes.position[bearer.index()], along, DVec3::Y);
    let key = p.organs.len() as u64;
    let (kind, bearer) = (OrganKind::Leaf, Some(bearer));
    p.organs.push(Organ {
        kind,
        bearer,
        flower: None,
        shape,
        frame,
        scale,
        paint: Paint::default(),
        key,
        source: None,
    });
}

#[test]
fn a_cone_has_its_volume_area_and_diameter_at_breast_height() {
    let mut p = Plant::default();
    let line: Vec<DVec3> = (0..=4).map(|i| DVec3::Y * f64::from(i) * 1.3).collect();
    axis(&mut p, None, &line, &[0.2, 0.15, 0.1, 0.05, 0.0]);
    let m = p.measure();
    near(m.wood_volume_m3, PI * 0.2 * 0.2 * 5.2 / 3.0);
    near(m.wood_area_m2, PI * 0.2 * (0.2_f64 * 0.2 + 5.2 * 5.2).sqrt());
    near(m.dbh_m.expect("tall"), 0.3);
    near(m.height_m, 5.2);
    near(m.length_m, 5.2);
    assert_eq!((m.stems, m.crown_base_m, m.lai, m.radius_exponent), (1, None, None, None));
    assert_eq!((m.strahler.order, m.strahler.streams, m.strahler.bifurcation_ratio), (1, vec![1], None));
    assert_eq!((m.crown_volume_m3, m.crown_projection_m2, m.leaf_area_m2), (0.0, 0.0, 0.0));
}

#[test]
fn breast_height_is_above_the_foot_and_stems_add_their_basal_areas() {
    let mut p = Plant::default();
    // On a slope: the foot stands at 2 m. Diameter at 1.3 m above it: 0.6 and 0.8, together 1.
    axis(&mut p, None, &[DVec3::Y * 2.0, DVec3::Y * 4.6], &[0.5, 0.1]);
    axis(&mut p, None, &[DVec3::X, DVec3::X + DVec3::Y * 2.6], &[0.6, 0.2]);
    near(p.measure().dbh_m.expect("tall"), 1.0);
    let mut low = Plant::default();
    axis(&mut low, None, &[DVec3::ZERO, DVec3::Y * 1.29], &[0.1, 0.1]);
    assert_eq!(low.measure().dbh_m, None);
}

/// Makes a plant whose shoots fork, `depth` times, into one that continues straight and one at 40 degrees; at each fork
/// `r^n = 2 (r 2^(-1/n))^n`.
fn binary(depth: u32, n: f64) -> Plant {
    let mut p = Plant::default();
    let thin = ops::powf(2.0, -1.0 / n);
    let (s, c) = ops::sin_cos(40.0_f64.to_radians());
    let mut todo = vec![(None, DVec3::ZERO, DVec3::Y, 0, 1.0)];
    while let Some((bearer, from, up, level, radius)) = todo.pop() {
        // One internode a level; the node at its end has the radius below the fork.
        let line: Vec<DVec3> = (0..=depth - level + 1).map(|i| from + up * f64::from(i)).collect();
        let mut radii = vec![radius];
        (0..line.len() - 1).fold(radius, |r, _| {
            radii.push(r);
            r * thin
        });
        let id = axis(&mut p, bearer, &line, &radii);
        for (i, below) in (1..line.len() - 1).zip(level + 1..) {
            // About an axis of the plane's own, so that no two shoots meet.
            let side = up.any_orthonormal_vector();
            let (at, r) = (node(&p, id, i), radii[i] * thin);
            todo.push((Some(at), line[i], up * c + side * s, below, r));
        }
    }
    p
}

#[test]
fn a_perfect_binary_tree_has_the_orders_of_strahler_and_gravelius() {
    for (depth, n) in [(1, 2.0), (4, 2.0), (6, 2.6), (5, 3.0)] {
        let p = binary(depth, n);
        let m = p.measure();
        // 2^depth tips of order 1, half as many of order 2, ...: every ratio is 2.
        let expected: Vec<usize> = (0..=depth).rev().map(|k| 1_usize << k).collect();
        assert_eq!(m.strahler.streams, expected);
        assert_eq!(m.strahler.order, depth + 1);
        assert_eq!(m.strahler.ratios, vec![2.0; depth as usize]);
        near(m.strahler.bifurcation_ratio.expect("orders"), 2.0);
        // Axes of order k start at a choice of k of the depth levels: binomial(depth, k).
        let mut binomial = 1;
        for (k, order) in (0..=depth).zip(&m.orders) {
            assert_eq!((order.order, order.axes), (k, binomial), "depth {depth}");
            binomial = binomial * (depth - k) as usize / (k as usize + 1);
            if k > 0 {
                near(order.angle_mean_deg.expect("borne"), 40.0);
                assert!(order.angle_sd_deg.is_none_or(|sd| sd < 1e-9));
            }
        }
        assert_eq!(m.orders[0].angle_mean_deg, None);
        near(m.orders[0].length_m, f64::from(depth + 1));
        let e = m.radius_exponent.expect("forks");
        assert!((e.exponent - n).abs() < 1e-9 && e.residual < 1e-9, "{e:?}");
        assert_eq!(e.forks, (1 << depth) - 1);
    }
}

#[test]
fn a_herringbone_is_of_order_two_however_long() {
    let mut p = Plant::default();
    let line: Vec<DVec3> = (0..=8).map(|i| DVec3::Y * f64::from(i)).collect();
    let trunk = axis(&mut p, None, &line, &[0.1; 9]);
    for (k, &from) in line.iter().enumerate().take(8).skip(1) {
        let at = node(&p, trunk, k);
        axis(&mut p, Some(at), &[from, from + DVec3::X], &[0.01; 2]);
    }
    let m = p.measure();
    // Seven twigs and the trunk's own tip against one stream of order 2.
    assert_eq!(m.strahler.streams, [8, 1]);
    assert_eq!(m.strahler.ratios, [8.0]);
    near(m.orders[1].angle_mean_deg.expect("borne"), 90.0);
    near(m.orders[1].length_m, 7.0);
    near(m.orders[1].volume_m3, 7.0 * PI * 1e-4);
}

#[test]
fn angles_spread_as_they_were_made() {
    let mut p = Plant::default();
    let trunk = axis(&mut p, None, &[DVec3::ZERO, DVec3::Y, DVec3::Y * 2.0], &[0.1; 3]);
    let at = node(&p, trunk, 1);
    for deg in [30.0_f64, 60.0, 90.0] {
        let (s, c) = ops::sin_cos(deg.to_radians());
        axis(&mut p, Some(at), &[DVec3::Y, DVec3::new(s, 1.0 + c, 0.0)], &[0.05; 2]);
    }
    let m = p.measure();
    // Mean 60, squares 900 + 0 + 900 over 2.
    near(m.orders[1].angle_mean_deg.expect("borne"), 60.0);
    near(m.orders[1].angle_sd_deg.expect("three"), 30.0);
    // Three twigs and the trunk's end at one fork: 0.1^n = 3 (0.05)^n + 0.1^n has no answer below the bound.
    near(m.radius_exponent.expect("a fork").exponent, 10.0);
}

#[test]
fn a_cubic_crown_has_its_volume_projection_and_leaf_area_index() {
    let mut p = Plant::default();
    let line = [DVec3::ZERO, DVec3::Y, DVec3::Y * 3.0, DVec3::Y * 4.0];
    let trunk = axis(&mut p, None, &line, &[0.1; 4]);
    let shape = square(&mut p, 0.1, Lift::Flat);
    // A dead branch at 1 m, which widens nothing; eight live ones from 3 m to the corners of a cube from 2 to 4 m.
    let (low, high) = (node(&p, trunk, 1), node(&p, trunk, 2));
    axis(&mut p, Some(low), &[line[1], DVec3::new(9.0, 1.0, 0.0)], &[0.01; 2]);
    for i in 0..8_u8 {
        let sign = |b: u8| if i & b == 0 { -1.0 } else { 1.0 };
        let corner = DVec3::new(sign(1), 3.0 + sign(2), sign(4));
        let id = axis(&mut p, Some(high), &[line[2], corner], &[0.01; 2]);
        let tip = node(&p, id, 1);
        // Leaves that point inwards do not enlarge the cube.
        leaf(&mut p, tip, shape, DVec3::new(0.0, 3.0, 0.0) - corner, 0.2);
    }
    assert_eq!(p.validate().next(), None);
    let m = p.measure();
    near(m.crown_base_m.expect("alive"), 3.0);
    near(m.leaf_area_m2, 8.0 * 0.0004);
    // The inner leaves' corners stand out of the cube by less than half a leaf's diagonal.
    assert!((8.0..8.3).contains(&m.crown_volume_m3), "{}", m.crown_volume_m3);
    assert!((4.0..4.1).contains(&m.crown_projection_m2), "{}", m.crown_projection_m2);
    near(m.lai.expect("leaves"), m.leaf_area_m2 / m.crown_projection_m2);
    // In winter the cube is exact, and the low branch counts.
    p.organs.clear();
    let m = p.measure();
    near(m.crown_base_m.expect("branches"), 1.0);
    assert!(m.crown_volume_m3 > 8.5 && m.crown_projection_m2 > 4.0 && m.lai == Some(0.0));
}

#[test]
fn the_bare_cube_is_exact() {
    let mut p = Plant::default();
    let trunk = axis(&mut p, None, &[DVec3::ZERO, DVec3::Y * 3.0], &[0.1; 2]);
    let top = node(&p, trunk, 1);
    for i in 0..8_u8 {
        let sign = |b: u8| if i & b == 0 { -1.0 } else { 1.0 };
        let corner = DVec3::new(sign(1), 3.0 + sign(2), sign(4));
        axis(&mut p, Some(top), &[DVec3::Y * 3.0, corner], &[0.01; 2]);
    }
    let m = p.measure();
    near(m.crown_volume_m3, 8.0);
    near(m.crown_projection_m2, 4.0);
    near(m.height_m, 4.0);
}

#[test]
fn leaf_area_is_that_of_the_bent_sheet() {
    let mut p = Plant::default();
    let stem = axis(&mut p, None, &[DVec3::ZERO, DVec3::Y], &[0.01; 2]);
    let at = node(&p, stem, 1);
    // z = 3/4 x: every square metre becomes 5/4.
    let tilted = square(&mut p, 0.2, Lift::Tilt { slope: DVec2::new(0.75, 0.0) });
    leaf(&mut p, at, tilted, DVec3::X, 1.0);
    near(p.measure().leaf_area_m2, 0.04 * 1.25);
    near(p.measure().height_m, 1.0 + 0.1 * 0.75);
    // A needle 2 cm long and 1 mm thick: half of its mantle, 0.5 * pi * d * l.
    let path = vec![DVec3::ZERO, DVec3::Y * 0.02];
    let needle = p.add_shape(Shape::Strand { path, radius_m: vec![0.0005; 2], knob_m: 0.0 });
    p.organs.clear();
    leaf(&mut p, at, needle, DVec3::X, 1.0);
    near(p.measure().leaf_area_m2, 0.5 * PI * 0.001 * 0.02);
    assert_eq!((p.measure().leaves, p.measure().crown_base_m), (1, Some(1.0)));
}

#[test]
fn a_shoot_counts_what_its_needles_cover() {
    let mut p = Plant::default();
    let stem = axis(&mut p, None, &[DVec3::ZERO, DVec3::Y], &[0.01; 2]);
    let at = node(&p, stem, 1);
    let flat = Blade { relief: Relief::default(), ..Blade::shoot(Needles::with_length(0.1), 3, 1.0) };
    let outline = geom::signed_area(&flat.outline).abs();
    let covered = NeedleMap::from_blade(&flat).expect("needles").covered();
    let shoot = p.add_shape(Shape::Blade(flat.clone()));
    leaf(&mut p, at, shoot, DVec3::X, 0.2);
    near(p.measure().leaf_area_m2, covered * 0.04);
    assert!(covered < 0.75 * outline, "{covered} of {outline}");
    // Without needles it is a leaf like any other.
    let plain = p.add_shape(Shape::Blade(Blade { needles: None, ..flat }));
    p.organs.clear();
    leaf(&mut p, at, plain, DVec3::X, 0.2);
    near(p.measure().leaf_area_m2, outline * 0.04);
}

#[test]
fn roots_and_stalks_are_no_shoots() {
    let mut p = Plant::default();
    let stem = axis(&mut p, None, &[DVec3::ZERO, DVec3::Y], &[0.01; 2]);
    let (foot, top) = (node(&p, stem, 0), node(&p, stem, 1));
    p.add_axis(AxisKind::Root, Some(foot), 7, &[DVec3::ZERO, DVec3::NEG_Y], None);
    p.add_axis(AxisKind::Petiole, Some(top), 8, &[DVec3::Y, DVec3::Y * 1.5], None);
    let m = p.measure();
    assert_eq!((m.orders.len(), m.strahler.streams, m.length_m, m.height_m), (1, vec![1], 1.0, 1.0));
    assert_eq!(Plant::default().measure(), Measures::default());
}

/// Makes a plant of random axes.
fn wild(seed: u64, axes: usize) -> Plant {
    let mut s = Seed::new(seed).stream(Draw::Attractors);
    let mut p = Plant::default();
    let shape = square(&mut p, 0.1, Lift::Flat);
    for i in 0..axes {
        let count = p.nodes.position.len();
        let bearer = (i > 0 && !s.chance(0.1)).then(|| {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to count")]
            NodeId::new(((s.uniform() * count as f64) as usize).min(count - 1))
        });
        let mut line =
            vec![bearer.map_or(DVec3::new(s.normal(), 0.0, s.normal()), |b| p.nodes.position[b.index()])];
        for _ in 0..1 + i % 4 {
            // Occasionally an internode without length.
            let step = if s.chance(0.05) { 0.0 } else { 1.0 };
            let last = line[line.len() - 1];
            line.push(last + DVec3::new(s.normal(), s.uniform(), s.normal()) * step);
        }
        let radii: Vec<f64> =
            line.iter().map(|_| if s.chance(0.05) { 0.0 } else { s.uniform() * 0.1 }).collect();
        let id = axis(&mut p, bearer, &line, &radii);
        if s.chance(0.5) {
            let tip = node(&p, id, line.len() - 1);
            leaf(&mut p, tip, shape, DVec3::new(s.normal(), s.normal(), s.normal()), 0.5 + s.uniform());
        }
    }
    p
}

fn numbers(m: &Measures) -> (Vec<f64>, Vec<f64>, Vec<f64>, Vec<f64>) {
    let mut plain: Vec<f64> = m.strahler.ratios.clone();
    plain.extend(m.strahler.bifurcation_ratio.iter().chain(&m.lai));
    plain.extend(m.radius_exponent.iter().flat_map(|e| [e.exponent, e.residual]));
    plain.extend(m.orders.iter().flat_map(|o| [o.angle_mean_deg, o.angle_sd_deg]).flatten());
    let mut length = vec![m.height_m, m.length_m];
    length.extend(m.crown_base_m);
    length.extend(m.orders.iter().map(|o| o.length_m));
    let area = vec![m.crown_projection_m2, m.leaf_area_m2, m.wood_area_m2];
    (plain, length, area, vec![m.crown_volume_m3, m.wood_volume_m3])
}

proptest! {
    #[test]
    fn leaves_deep_inside_a_crown_are_in_its_hull_already(seed in 0..1000_u64, axes in 20..400_usize) {
        let plant = wild(seed, axes);
        let margins: Vec<Vec<DVec3>> = plant.shapes.iter().map(super::crown::margin).collect();
        let (mut some, mut all) = (plant.nodes.position.clone(), plant.nodes.position.clone());
        super::crown::leaves_outside(&plant, &margins, &mut some);
        for o in &plant.organs {
            all.extend(margins[o.shape.index()].iter().map(|&p| o.frame.place(p, o.scale)));
        }
        let volume = |points: &[DVec3]| geom::convex_hull3(points).map_or(0.0, |hull| hull.volume());
        prop_assert!((volume(&some) - volume(&all)).abs() <= 1e-8 * volume(&all));
        prop_assert!(axes < 200 || some.len() < all.len() * 9 / 10, "{} of {}", some.len(), all.len());
    }

    #[test]
    fn measures_scale_as_their_units_do(seed in 0..1000_u64, axes in 1..40_usize) {
        let small = wild(seed, axes);
        prop_assert_eq!(small.validate().next(), None);
        let mut large = small.clone();
        let by = 2.0;
        large.nodes.position.iter_mut().for_each(|p| *p *= by);
        large.nodes.radius_m.iter_mut().for_each(|r| *r *= by);
        for o in &mut large.organs {
            o.scale *= by;
            o.frame.origin *= by;
        }
        let (a, b) = (numbers(&small.measure()), numbers(&large.measure()));
        let pairs = [(&a.0, &b.0, 1.0), (&a.1, &b.1, by), (&a.2, &b.2, by * by), (&a.3, &b.3, by * by * by)];
        for (a, b, factor) in pairs {
            prop_assert_eq!(a.len(), b.len());
            for (x, y) in a.iter().zip(b) {
                prop_assert!(x.is_finite() && (x * factor - y).abs() <= 1e-7 * (1.0 + y.abs()), "{} {}", x, y);
            }
        }
        let m = small.measure();
        prop_assert_eq!(m.orders.iter().map(|o| o.axes).sum::<usize>(), axes);
        prop_assert!(m.strahler.streams.iter().all(|n| *n > 0));
    }
}

#[test]
fn a_plant_in_the_coordinates_of_a_scanner_is_as_high_as_at_the_origin() {
    let plant = |foot: DVec3| {
        let mut p = Plant::default();
        let stem = axis(&mut p, None, &[foot, foot + DVec3::Y * 2.0], &[0.1; 2]);
        let at = node(&p, stem, 1);
        let blade = square(&mut p, 0.2, Lift::Tilt { slope: DVec2::new(0.75, 0.0) });
        leaf(&mut p, at, blade, DVec3::X, 1.0);
        p.measure()
    };
    let (here, there) = (plant(DVec3::ZERO), plant(DVec3::new(4.0, -317.25, 2.0)));
    assert!((here.height_m - there.height_m).abs() < 1e-9, "{} {}", here.height_m, there.height_m);
    assert!((here.crown_base_m.unwrap() - there.crown_base_m.unwrap()).abs() < 1e-9);
    assert!(there.dbh_m.is_some());
}

#[test]
fn columns_add_up_to_the_measures() {
    let mut p = Plant::default();
    p.add_axis(AxisKind::Branch, None, 1, &[DVec3::ZERO, DVec3::Y * 2.0], None);
    let side = [DVec3::Y * 2.0, DVec3::new(3.0, 2.0, 0.0), DVec3::new(3.0, 6.0, 0.0)];
    p.add_axis(AxisKind::Branch, Some(NodeId::new(1)), 2, &side, None);
    p.nodes.radius_m = vec![0.1; 5];
    assert_eq!(p.axis_lengths_m(), [2.0, 7.0]);
    let angles = p.axis_angles_deg();
    assert!(angles[0].is_nan());
    near(angles[1], 90.0);
    near(p.axis_lengths_m().iter().sum(), p.measure().length_m);
    assert!(p.organ_areas_m2().is_empty());
}
