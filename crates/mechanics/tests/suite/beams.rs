//! Rods and forks against the theory of beams.
#![expect(clippy::disallowed_methods, reason = "tests")]

use std::f64::consts::{PI, TAU};

use base::{Report, Run};
use glam::DVec3;
use mechanics::{MechanicsSpec, Mechanism, WoodGroup, articulate};
use plant::{AxisKind, NodeId, Plant};

const RADIUS_M: f64 = 0.01;
const LENGTH_M: f64 = 1.0;

fn second_moment() -> f64 {
    PI * RADIUS_M * RADIUS_M * RADIUS_M * RADIUS_M / 4.0
}

fn bending_stiffness() -> f64 {
    WoodGroup::Hardwood.tissue().modulus_pa * second_moment()
}

fn kilograms_per_metre() -> f64 {
    WoodGroup::Hardwood.tissue().density_kg_m3 * PI * RADIUS_M * RADIUS_M
}

fn weightless() -> MechanicsSpec {
    MechanicsSpec { gravity: 0.0, ..MechanicsSpec::default() }
}

fn made(plant: &Plant, spec: &MechanicsSpec) -> Mechanism {
    articulate(plant, spec, &Run::plain(), &mut Report::default()).expect("a mechanism")
}

/// A rod of `nodes` nodes that leans by an angle from the vertical.
fn rod(nodes: u32, lean: f64) -> Plant {
    let along = DVec3::new(lean.sin(), lean.cos(), 0.0);
    let place = |k: u32| along * (LENGTH_M * f64::from(k) / f64::from(nodes - 1));
    let mut plant = Plant::default();
    plant.add_axis(AxisKind::Branch, None, 1, &(0..nodes).map(place).collect::<Vec<_>>(), None);
    plant.nodes.radius_m.fill(RADIUS_M);
    plant
}

/// A stem of a metre with two arms of half a metre, which spread by 40 degrees.
fn fork() -> Plant {
    let mut plant = rod(6, 0.0);
    for (key, side) in [(2, 1.0), (3, -1.0)] {
        let reach = DVec3::new(side * 40_f64.to_radians().sin(), 40_f64.to_radians().cos(), 0.0) * 0.5;
        let points: Vec<DVec3> = (0..4).map(|k| DVec3::Y * LENGTH_M + reach * (f64::from(k) / 3.0)).collect();
        plant.add_axis(AxisKind::Branch, Some(NodeId::new(5)), key, &points, None);
    }
    plant.nodes.radius_m.fill(RADIUS_M);
    plant
}

#[test]
fn the_tip_of_a_rod_goes_as_far_as_euler_and_bernoulli_say() {
    let force = 0.5;
    let wanted = force * LENGTH_M * LENGTH_M * LENGTH_M / (3.0 * bending_stiffness());
    for nodes in [2, 3, 10, 101] {
        for lean in [0.0, 0.7, PI / 2.0] {
            let made = made(&rod(nodes, lean), &weightless());
            let along = DVec3::new(lean.sin(), lean.cos(), 0.0);
            for across in [DVec3::Z, along.cross(DVec3::Z)] {
                let moved = made.deflection(made.bodies.len() - 1, along * LENGTH_M, across * force);
                let error = moved.dot(across) / wanted - 1.0;
                assert!(error.abs() < 0.05, "{nodes} nodes at {lean}: {error:+.3}");
            }
        }
    }
}

#[test]
fn a_tapered_rod_bends_as_the_integral_of_its_curvature() {
    let mut plant = rod(5, 0.0);
    plant.nodes.radius_m = vec![0.012, 0.0105, 0.009, 0.0075, 0.006];
    let made = made(&plant, &weightless());
    let modulus = WoodGroup::Hardwood.tissue().modulus_pa;
    let steps = 100_000;
    let slice = |k: u32| {
        let s = (f64::from(k) + 0.5) / f64::from(steps);
        let r = 0.012 - 0.006 * s;
        (1.0 - s) * (1.0 - s) / (modulus * PI * r * r * r * r / 4.0) / f64::from(steps)
    };
    let wanted: f64 = (0..steps).map(slice).sum();
    let moved = made.deflection(made.bodies.len() - 1, DVec3::Y, DVec3::X).x;
    assert!((moved / wanted - 1.0).abs() < 0.05, "{moved} for {wanted}");
}

#[test]
fn a_rod_swings_as_often_as_a_beam() {
    // The first root of cos x cosh x = -1.
    let root = 1.875_104_07_f64;
    let hertz = root * root * (bending_stiffness() / kilograms_per_metre()).sqrt() / TAU;
    for nodes in [2, 7, 50] {
        let found = made(&rod(nodes, 0.0), &weightless()).frequencies().expect("joints").lowest_hz;
        assert!((found / hertz - 1.0).abs() < 0.1, "{found} Hz, a beam has {hertz}");
    }
}

#[test]
fn a_fork_swings_as_often_as_a_fine_one_of_beams() {
    let found = made(&fork(), &weightless()).frequencies().expect("joints").lowest_hz;
    let fine = fine_fork_hz(DVec3::Z).min(fine_fork_hz(DVec3::X));
    assert!((found / fine - 1.0).abs() < 0.1, "{found} Hz, of fine beams {fine}");
}

/// Returns the lowest frequency of the fork in which it moves along `sway`, by the method of Stodola with 1,500 pieces:
/// the form under the forces of inertia of the form before. Forces act at the middle of each piece, and arms bend and
/// move with their bearer.
fn fine_fork_hz(sway: DVec3) -> f64 {
    const PIECES: usize = 500;
    let (stem, arm) = (LENGTH_M / PIECES as f64, 0.5 / PIECES as f64);
    let reach = |side: f64| DVec3::new(side * 40_f64.to_radians().sin(), 40_f64.to_radians().cos(), 0.0);
    let mut lines = Vec::new();
    lines.push((0..PIECES).map(|k| DVec3::Y * (stem * (k as f64 + 0.5))).collect::<Vec<_>>());
    for side in [1.0, -1.0] {
        lines.push(
            (0..PIECES).map(|k| DVec3::Y * LENGTH_M + reach(side) * (arm * (k as f64 + 0.5))).collect(),
        );
    }
    let mass = |line: usize| kilograms_per_metre() * if line == 0 { stem } else { arm };
    let compliance = |line: usize| if line == 0 { stem } else { arm } / bending_stiffness();
    let mut form: Vec<Vec<DVec3>> =
        lines.iter().map(|l| l.iter().map(|p| sway * p.y * p.y).collect()).collect();
    let mut squared = 0.0;
    for _ in 0..30 {
        // Sums of force and of moment about the origin of all pieces beyond each piece.
        let beyond = |line: usize, start: (DVec3, DVec3)| {
            let mut sums = vec![start; PIECES];
            let mut sum = start;
            for k in (0..PIECES).rev() {
                let force = form[line][k] * mass(line);
                sums[k] = (sum.0 + force / 2.0, sum.1 + lines[line][k].cross(force) / 2.0);
                sum = (sum.0 + force, sum.1 + lines[line][k].cross(force));
            }
            (sums, sum)
        };
        let none = (DVec3::ZERO, DVec3::ZERO);
        let (left, right) = (beyond(1, none), beyond(2, none));
        let both = (left.1.0 + right.1.0, left.1.1 + right.1.1);
        let sums = [beyond(0, both).0, left.0, right.0];
        let turn = |line: usize, k: usize| {
            let (force, moment) = sums[line][k];
            let along = if line == 0 { DVec3::Y } else { reach(if line == 1 { 1.0 } else { -1.0 }) };
            let bending = moment - lines[line][k].cross(force);
            // No torsion.
            (bending - along * bending.dot(along)) * compliance(line)
        };
        let (mut next, mut crotch) = (form.clone(), (DVec3::ZERO, DVec3::ZERO));
        for line in 0..3 {
            // Accumulated rotation, and the sum of rotation x place: a place p has moved by rotation x p - sum.
            let (mut turned, mut sum) = if line == 0 { (DVec3::ZERO, DVec3::ZERO) } else { crotch };
            for k in 0..PIECES {
                let own = turn(line, k);
                let half = (turned + own / 2.0, sum + own.cross(lines[line][k]) / 2.0);
                next[line][k] = half.0.cross(lines[line][k]) - half.1;
                (turned, sum) = (turned + own, sum + own.cross(lines[line][k]));
            }
            if line == 0 {
                crotch = (turned, sum);
            }
        }
        let dot = |a: &[Vec<DVec3>], b: &[Vec<DVec3>]| -> f64 {
            (0..3).map(|l| a[l].iter().zip(&b[l]).map(|(a, b)| a.dot(*b)).sum::<f64>() * mass(l)).sum()
        };
        squared = dot(&form, &next) / dot(&next, &next);
        let size = dot(&next, &next).sqrt();
        form = next.into_iter().map(|line| line.into_iter().map(|p| p / size).collect()).collect();
    }
    squared.sqrt() / TAU
}

#[test]
fn the_fine_reference_knows_the_frequency_of_a_rod() {
    // A rod of one and a half metres is a fork whose arms lie on one line, but with twice the mass: only its order is
    // known here.
    let root = 1.875_104_07_f64;
    let rod = root * root * (bending_stiffness() / kilograms_per_metre()).sqrt() / TAU;
    let fork = fine_fork_hz(DVec3::Z);
    assert!(fork > rod / 4.0 && fork < rod, "{fork} of {rod}");
}

#[test]
fn a_stem_that_bears_much_swings_more_slowly_and_one_too_thin_is_stiffened() {
    let plant = rod(10, 0.0);
    let light = made(&plant, &weightless()).frequencies().expect("joints").lowest_hz;
    let heavy = made(&plant, &MechanicsSpec::default()).frequencies().expect("joints").lowest_hz;
    assert!(heavy < light, "{heavy} of {light}");
    // Greenhill (1881): a rod of this radius falls over beyond 1.986 (E I / w)^(1/3).
    let radius: f64 = 0.0005;
    let tissue = WoodGroup::Hardwood.tissue();
    let weight = tissue.density_kg_m3 * PI * radius * radius * 9.81;
    let highest = 1.986 * (tissue.modulus_pa * PI * radius.powi(4) / 4.0 / weight).cbrt();
    for (times, falls) in [(0.9, false), (1.15, true)] {
        let mut plant = rod(20, 0.0);
        plant.nodes.position.iter_mut().for_each(|p| *p *= highest * times);
        plant.nodes.radius_m.fill(radius);
        let mut report = Report::default();
        articulate(&plant, &MechanicsSpec::default(), &Run::plain(), &mut report).expect("a mechanism");
        assert_eq!(
            report.warnings.iter().any(|w| w.code == "would-fall"),
            falls,
            "{times} times {highest} m"
        );
    }
}

#[test]
fn springs_hold_a_leaning_rod_where_it_was() {
    let made = made(&rod(10, 0.9), &MechanicsSpec::default());
    for (row, body) in made.bodies.iter().enumerate() {
        let Some(joint) = body.joint else { continue };
        for (axis, rest) in joint.axes.iter().zip(joint.rest_rad) {
            // The moment of all bodies that move on it.
            let weight: f64 = made.bodies[row..]
                .iter()
                .map(|b| axis.dot((b.centre - body.origin).cross(DVec3::NEG_Y * (9.81 * b.mass))))
                .sum();
            assert!((joint.stiffness * rest + weight).abs() < 1e-9 * joint.stiffness, "{row}");
        }
    }
}

#[test]
fn the_time_step_is_half_bits_what_is_stable() {
    let made = made(&rod(10, 0.0), &MechanicsSpec::default());
    let fastest = made.frequencies().expect("joints").highest_hz * TAU;
    assert!(made.time_step_s * fastest <= 1.0 + 1e-9, "{} s", made.time_step_s);
    assert!(made.time_step_s >= 1e-4, "{} s", made.time_step_s);
}
