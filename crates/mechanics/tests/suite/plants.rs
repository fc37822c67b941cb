//! Whole plants: mass, joints, fruits, names.
#![expect(clippy::disallowed_methods, reason = "tests")]

use std::collections::BTreeSet;
use std::f64::consts::PI;

use base::{Report, Run};
use glam::{DVec2, DVec3};
use mechanics::{MechanicsSpec, Mechanism, WoodGroup, articulate};
use plant::{AxisId, AxisKind, Frame, NodeId, Organ, OrganId, OrganKind, Paint, Plant, Shape};

fn made(plant: &Plant) -> (Mechanism, Report) {
    let mut report = Report::default();
    let made = articulate(plant, &MechanicsSpec::default(), &Run::plain(), &mut report).expect("a mechanism");
    (made, report)
}

/// A trunk with many branches, tapered, and a root.
fn tree(branches: u32) -> Plant {
    let mut plant = Plant { name: "Tree".into(), ..Plant::default() };
    let trunk: Vec<DVec3> = (0..=branches).map(|k| DVec3::Y * (0.2 + 0.1 * f64::from(k))).collect();
    plant.add_axis(AxisKind::Branch, None, 1, &trunk, None);
    for k in 1..branches {
        let turn = f64::from(k) * 2.4;
        let out = DVec3::new(turn.cos(), 0.6, turn.sin()) * (0.3 + 0.004 * f64::from(branches - k));
        let foot = trunk[k as usize];
        let bearer = Some(NodeId::new(k as usize));
        plant.add_axis(
            AxisKind::Branch,
            bearer,
            u64::from(k) + 1,
            &[foot, foot + out * 0.5, foot + out],
            None,
        );
    }
    plant.add_axis(AxisKind::Root, None, 9999, &[DVec3::Y * 0.2, DVec3::NEG_Y], None);
    for axis in 0..plant.axes.len() {
        let nodes = plant.axes[axis].nodes.clone();
        let (foot, count) = (if axis == 0 { 0.05 } else { 0.008 }, f64::from(nodes.end - nodes.start));
        for (k, node) in nodes.enumerate() {
            plant.nodes.radius_m[node as usize] = foot * (1.0 - 0.9 * k as f64 / count);
        }
    }
    plant
}

/// A stem with a fruit on a stalk.
fn fruited() -> Plant {
    let mut plant = Plant::default();
    plant.add_axis(AxisKind::Stem, None, 1, &[DVec3::ZERO, DVec3::Y * 0.5], None);
    let hanging = [DVec3::Y * 0.5, DVec3::new(0.05, 0.48, 0.0)];
    plant.add_axis(AxisKind::Petiole, Some(NodeId::new(1)), 2, &hanging, None);
    plant.nodes.radius_m = vec![0.005, 0.004, 0.0015, 0.001];
    let profile = (0..=16).map(|k| f64::from(k) * PI / 16.0);
    let profile = profile.map(|a| DVec2::new(0.03 * a.sin(), 0.03 - 0.03 * a.cos())).collect();
    let shape = plant.add_shape(Shape::Revolution { profile });
    plant.organs.push(Organ {
        kind: OrganKind::Fruit,
        bearer: Some(NodeId::new(3)),
        flower: None,
        shape,
        frame: Frame::looking(hanging[1], DVec3::NEG_Y, DVec3::Z),
        scale: 1.0,
        paint: Paint::default(),
        key: 3,
        source: None,
    });
    plant
}

#[test]
fn the_mass_is_volume_times_density() {
    for branches in [2, 30, 150] {
        let plant = tree(branches);
        let (made, _) = made(&plant);
        // Roots are in the soil.
        let wanted = plant.measure().wood_volume_m3 * WoodGroup::Hardwood.tissue().density_kg_m3;
        assert!((made.mass() / wanted - 1.0).abs() < 1e-9, "{} kg of {wanted}", made.mass());
    }
}

#[test]
fn joints_are_at_most_as_many_as_asked_for_and_go_where_most_bends() {
    let plant = tree(150);
    for most in [0, 2, 21, 200] {
        let spec = MechanicsSpec { most_joints: most, ..MechanicsSpec::default() };
        let made = articulate(&plant, &spec, &Run::plain(), &mut Report::default()).expect("a mechanism");
        assert!(made.joints() <= most as usize, "{} of {most}", made.joints());
        assert!(made.joints() + 2 > most as usize, "{} of {most}", made.joints());
        if most == 2 {
            assert_eq!(made.bodies[1].axis, Some(AxisId::new(0)), "the trunk bends first");
        }
    }
}

#[test]
fn a_fruit_hangs_on_a_stalk_that_breaks() {
    let plant = fruited_on(0.01, 0.001);
    let (made, report) = made(&plant);
    let fruit = &made.bodies[made.body_of_organ(OrganId::new(0))];
    let stalk = fruit.stalk.expect("a stalk");
    // The cross-section of the stalk's end times the strength of green tissue.
    assert!((stalk.break_force_n - 5e6 * PI * 1e-6).abs() < 1e-9, "{}", stalk.break_force_n);
    let ball = 1000.0 * 4.0 / 3.0 * PI * 0.03 * 0.03 * 0.03;
    assert!((fruit.mass / ball - 1.0).abs() < 0.02, "{} kg of {ball}", fruit.mass);
    let parent = &made.bodies[fruit.parent.expect("a parent")];
    // Not on the stalk, which weighs a four hundredth of its fruit: it is rigid with the stem.
    assert!(parent.name.starts_with("stem_1"), "{}", parent.name);
    assert!(!made.bodies.iter().any(|b| b.name.starts_with("stalk")), "{:?}", made.bodies);
    assert!((fruit.centre - DVec3::new(0.05, 0.45, 0.0)).length() < 1e-6);
    // The wood swings faster without the fruit, and its weld wants shorter steps than that.
    let highest = made.frequencies().expect("joints").highest_hz * 2.0 * PI;
    assert!(made.time_step_s < 0.3 / highest, "{} s at {highest} radians a second", made.time_step_s);
    assert!(report.warnings.is_empty(), "{:?}", report.warnings);
}

#[test]
fn fruits_beyond_what_may_break_are_fixed_and_it_is_said() {
    let mut plant = fruited_on(0.01, 0.001);
    let (one, stalk) = (plant.organs[0].clone(), [plant.nodes.position[2], plant.nodes.position[3]]);
    for key in 4..43 {
        plant.add_axis(AxisKind::Petiole, Some(NodeId::new(1)), key, &stalk, None);
        let bearer = Some(NodeId::new(plant.nodes.position.len() - 1));
        plant.organs.push(Organ { bearer, key, ..one.clone() });
    }
    plant.nodes.radius_m.iter_mut().skip(4).for_each(|radius| *radius = 0.001);
    let (made, report) = made(&plant);
    assert_eq!(made.bodies.iter().filter(|b| b.stalk.is_some()).count(), 24);
    assert!(report.warnings.iter().any(|w| w.code == "fruits-fixed"));
}

/// The same plant with other radii of the stem and of the stalk's end, metres.
fn fruited_on(stem_m: f64, stalk_m: f64) -> Plant {
    let mut plant = fruited();
    plant.nodes.radius_m = vec![stem_m, stem_m, stalk_m, stalk_m];
    plant
}

#[test]
fn a_fruit_that_its_stalk_does_not_hold_is_fixed_and_it_is_said() {
    // The fruit pulls with 1.1 N; a stalk of 0.3 mm breaks at 1.4 N, one of 0.4 mm at 2.5 N.
    let (weak, report) = made(&fruited_on(0.005, 0.0003));
    assert_eq!(weak.bodies.iter().filter(|b| b.stalk.is_some()).count(), 0);
    assert!(report.warnings.iter().any(|w| w.code == "fruit-stalks-weak"), "{:?}", report.warnings);
    let fruit = weak.bodies.iter().flat_map(|b| &b.capsules).find(|c| c.from == c.to);
    assert!(fruit.is_some_and(|c| (c.radius_m - 0.03).abs() < 1e-9), "it can still be touched");
    let (strong, _) = made(&fruited_on(0.005, 0.0004));
    assert_eq!(strong.bodies.iter().filter(|b| b.stalk.is_some()).count(), 1);
    assert!((weak.mass() - strong.mass()).abs() < 1e-3, "{} and {} kg", weak.mass(), strong.mass());
}

#[test]
fn a_fruit_that_outweighs_its_stem_is_fixed_and_it_is_said() {
    let (made, report) = made(&fruited_on(0.0005, 0.0005));
    assert_eq!(made.bodies.iter().filter(|b| b.stalk.is_some()).count(), 0);
    assert!(report.warnings.iter().any(|w| w.code == "fruits-outweigh"), "{:?}", report.warnings);
}

#[test]
fn axes_that_would_break_under_their_fruits_are_told_of() {
    let told = |radius_m: f64| {
        let mut plant = fruited_on(radius_m, 0.0005);
        // A stem that lies flat, so that its fruit bends it: 0.5 m times 1.1 N.
        let end = DVec3::X * 0.5;
        plant.nodes.position[1..].copy_from_slice(&[end, end, end - DVec3::Y * 0.05]);
        plant.organs[0].frame.origin = plant.nodes.position[3];
        let report = made(&plant).1;
        report.warnings.into_iter().find(|w| w.code == "fruits-overload")
    };
    // 4 M / pi r^3 with the stem's own weight is 4.0 of 5 MPa at 6 mm, and 6.4 MPa at 5 mm.
    assert_eq!(told(0.006), None);
    assert!(told(0.005).is_some_and(|w| w.message.contains("1.3 times")), "{:?}", told(0.005));
}

#[test]
fn names_are_unique_and_parents_come_first() {
    let (made, _) = made(&tree(60));
    let names: BTreeSet<&str> = made.bodies.iter().map(|b| b.name.as_str()).collect();
    assert_eq!(names.len(), made.bodies.len());
    for (row, body) in made.bodies.iter().enumerate() {
        assert!(body.parent.is_none_or(|p| p < row));
        assert!(body.name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_'), "{}", body.name);
        assert!(body.mass > 0.0 && body.inertia.determinant() > 0.0, "{}", body.name);
    }
    assert_eq!((made.bodies[0].parent, made.bodies[0].joint), (None, None));
}

#[test]
fn a_place_on_an_axis_is_on_the_body_that_has_it() {
    let plant = tree(30);
    let (made, _) = made(&plant);
    let trunk = AxisId::new(0);
    assert_eq!(made.body_on_axis(&plant, trunk, DVec3::Y * 0.2), 0);
    let tip = made.body_on_axis(&plant, trunk, DVec3::Y * 3.2);
    assert_eq!(made.bodies[tip].axis, Some(trunk));
    assert!(made.bodies[tip].origin.y > 1.0);
}

#[test]
fn the_same_plant_gives_the_same_bits() {
    let plant = tree(80);
    assert_eq!(made(&plant).0, made(&plant).0);
}

#[test]
fn a_stalk_like_a_hair_is_stiffened_and_not_the_stem() {
    let mut plant = fruited();
    // Upright, so that it would sag.
    let shape = plant.organs[0].shape;
    let points = [DVec3::Y * 0.5, DVec3::Y * 0.6];
    plant.add_axis(AxisKind::Petiole, Some(NodeId::new(1)), 4, &points, None);
    plant.nodes.radius_m[4..].fill(0.0002);
    // Not a fruit: fruits let their stalks be rigid.
    plant.organs.push(Organ {
        kind: OrganKind::Disc,
        bearer: Some(NodeId::new(5)),
        shape,
        frame: Frame::looking(points[1], DVec3::Y, DVec3::Z),
        scale: 0.3,
        key: 5,
        ..plant.organs[0].clone()
    });
    let stem = |m: &Mechanism| {
        let first = m.bodies.iter().find(|b| b.axis == Some(AxisId::new(0))).expect("a joint");
        first.joint.expect("a joint").stiffness
    };
    let (thick, thin) = (made(&fruited()).0, made(&plant));
    assert!(thin.1.warnings.iter().any(|w| w.code == "would-fall"));
    // The place of the stem's joint depends a little on the load.
    assert!((stem(&thin.0) / stem(&thick) - 1.0).abs() < 0.3, "{} of {}", stem(&thin.0), stem(&thick));
}

#[test]
fn tips_that_weigh_nothing_are_no_bodies() {
    let mut plant = fruited();
    let tip = [DVec3::Y * 0.5, DVec3::new(0.0, 0.5, 0.001)];
    plant.add_axis(AxisKind::Stem, Some(NodeId::new(1)), 4, &tip, None);
    plant.nodes.radius_m[4..].fill(0.00005);
    let (made, _) = made(&plant);
    assert!(made.bodies.iter().all(|b| b.axis != Some(AxisId::new(2))));
    assert!(made.time_step_s > 1e-4, "{} s", made.time_step_s);
}

#[test]
fn a_plant_of_stems_alone_is_green() {
    assert_eq!(WoodGroup::seen_in(&fruited()), WoodGroup::Green);
    assert_eq!(WoodGroup::seen_in(&tree(3)), WoodGroup::Hardwood);
}
