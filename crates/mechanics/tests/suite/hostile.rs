//! Plants that no simulator accepts are refused; odd ones give finite numbers.

use base::{Budget, Report, Run};
use glam::DVec3;
use mechanics::{MechanicsError, MechanicsSpec, Mechanism, articulate};
use plant::{AxisKind, NodeId, Plant};
use proptest::prelude::*;

fn made(plant: &Plant) -> Result<Mechanism, MechanicsError> {
    articulate(plant, &MechanicsSpec::default(), &Run::plain(), &mut Report::default())
}

#[test]
fn a_plant_without_wood_says_what_is_missing() {
    let mut plant = Plant::default();
    assert_eq!(made(&plant), Err(MechanicsError::NoStem));
    plant.add_axis(AxisKind::Root, None, 1, &[DVec3::ZERO, DVec3::NEG_Y], None);
    plant.nodes.radius_m.fill(0.01);
    let error = made(&plant).expect_err("roots alone");
    assert!(error.to_string().contains("no stem or branch above the ground"), "{error}");
    plant.add_axis(AxisKind::Stem, None, 2, &[DVec3::ZERO, DVec3::Y], None);
    assert_eq!(made(&plant), Err(MechanicsError::NoThickness));
}

#[test]
fn more_than_the_budget_is_refused_before_work() {
    let mut plant = Plant::default();
    plant.add_axis(AxisKind::Stem, None, 1, &[DVec3::ZERO, DVec3::Y], None);
    let run = Run { budget: Budget { times: 1e-6, raise: None }, ..Run::plain() };
    let error = articulate(&plant, &MechanicsSpec::default(), &run, &mut Report::default());
    assert!(matches!(error, Err(MechanicsError::OverBudget(_))), "{error:?}");
}

#[test]
fn a_tip_that_runs_out_to_nothing_is_no_body_without_mass() {
    let mut plant = Plant::default();
    let points: Vec<DVec3> = (0..6).map(|k| DVec3::Y * f64::from(k)).collect();
    plant.add_axis(AxisKind::Branch, None, 1, &points, None);
    plant.nodes.radius_m = vec![0.05, 0.02, 0.0, 0.0, 0.0, 0.0];
    let made = made(&plant).expect("a mechanism");
    assert!(made.bodies.iter().all(|b| b.mass > 0.0));
    assert!(made.frequencies().is_some());
}

/// Sizes that generators of plants get wrong: nothing, hairs, giants.
fn size() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), Just(1e-9), Just(1e6), 1e-4..1.0_f64]
}

fn points() -> impl Strategy<Value = Vec<DVec3>> {
    prop::collection::vec((size(), size(), size()), 2..6)
        .prop_map(|all| all.into_iter().map(|(x, y, z)| DVec3::new(x, y, z)).collect())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn any_plant_is_refused_or_gives_finite_numbers(
        stem in points(),
        side in points(),
        radii in prop::collection::vec(size(), 12),
    ) {
        let mut plant = Plant::default();
        plant.add_axis(AxisKind::Branch, None, 1, &stem, None);
        let mut side = side;
        side[0] = stem[1];
        plant.add_axis(AxisKind::Stem, Some(NodeId::new(1)), 2, &side, None);
        plant.nodes.radius_m.iter_mut().zip(radii).for_each(|(r, radius)| *r = radius);
        if let Ok(made) = made(&plant) {
            prop_assert!(made.time_step_s > 0.0 && made.mass().is_finite());
            for body in &made.bodies {
                prop_assert!(body.centre.is_finite() && body.inertia.is_finite());
                if let Some(joint) = body.joint {
                    prop_assert!(body.mass > 0.0 && joint.stiffness > 0.0 && joint.stiffness.is_finite());
                    prop_assert!(joint.damping.is_finite() && joint.rest_rad.iter().all(|r| r.is_finite()));
                }
            }
        }
    }
}
