//! Properties of any envelope, any obstacles and every method: growth ends, every attractor is consumed or reported,
//! nothing grows beyond the envelope or into an obstacle, and the result is sound.

#![expect(clippy::expect_used, reason = "a test")]

use base::{Report, Run, Seed};
use glam::{DVec2, DVec3};
use growth::{
    ColonizeSpec, CompetitionSpec, Envelope, FoliageSpec, GrowthError, Light, Lsystem, Method, OAK_RULES,
    Obstacle, Obstacles, PointFate, Resource, SelfOrganizingSpec, TreeSpec, colonize, compete, grow,
};
use proptest::prelude::*;

/// Envelopes that are rotationally symmetric about the vertical through the origin.
fn envelope() -> impl Strategy<Value = Envelope> {
    let size = || 0.3..4.0_f64;
    let low = || (0.0..2.0_f64).prop_map(|y| DVec3::new(0.0, y, 0.0));
    prop_oneof![
        (size(), size()).prop_map(|(y, radius_m)| {
            Envelope::Sphere { centre: DVec3::new(0.0, y + radius_m, 0.0), radius_m }
        }),
        (size(), size(), size()).prop_map(|(y, wide, high)| Envelope::Ellipsoid {
            centre: DVec3::new(0.0, y + high, 0.0),
            radii_m: DVec3::new(wide, high, wide),
        }),
        (low(), size(), size()).prop_map(|(base, radius_m, height_m)| Envelope::Cone {
            base,
            radius_m,
            height_m
        }),
        (low(), size(), size()).prop_map(|(base, radius_m, height_m)| Envelope::Cylinder {
            base,
            radius_m,
            height_m
        }),
        (low(), prop::collection::vec((0.0..2.0_f64, 0.1..1.5_f64), 2..6)).prop_map(|(base, steps)| {
            let mut y = 0.0;
            let profile = steps.into_iter().map(|(r, dy)| {
                y += dy;
                DVec2::new(r + 0.05, y)
            });
            Envelope::Revolution { base, profile: profile.collect() }
        }),
    ]
}

/// Returns how far the convex hull of an envelope reaches in a direction.
fn support(envelope: &Envelope, u: DVec3) -> f64 {
    let flat = DVec2::new(u.x, u.z).length();
    match envelope {
        Envelope::Sphere { centre, radius_m } => centre.dot(u) + radius_m,
        Envelope::Ellipsoid { centre, radii_m } => centre.dot(u) + (*radii_m * u).length(),
        Envelope::Cone { base, radius_m, height_m } => base.dot(u) + (radius_m * flat).max(height_m * u.y),
        Envelope::Cylinder { base, radius_m, height_m } => {
            base.dot(u) + radius_m * flat + (height_m * u.y).max(0.0)
        }
        Envelope::Revolution { base, profile } => {
            let reach = profile.iter().map(|p| p.x * flat + p.y * u.y);
            base.dot(u) + reach.fold(f64::NEG_INFINITY, f64::max)
        }
        _ => f64::INFINITY,
    }
}

/// Returns directions all around, about equally far from each other.
fn directions() -> Vec<DVec3> {
    let n = 300;
    (0..n)
        .map(|k| {
            let y = 1.0 - (2.0 * f64::from(k) + 1.0) / f64::from(n);
            let (s, c) = base::ops::sin_cos(2.399_963 * f64::from(k));
            let r = (1.0 - y * y).sqrt();
            DVec3::new(r * c, y, r * s)
        })
        .chain([DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z])
        .collect()
}

fn obstacle() -> impl Strategy<Value = Obstacle> {
    let place = || (-3.0..3.0_f64, -1.0..5.0_f64, -3.0..3.0_f64).prop_map(|(x, y, z)| DVec3::new(x, y, z));
    let size = || 0.1..1.5_f64;
    prop_oneof![
        (place(), size(), size(), size())
            .prop_map(|(min, x, y, z)| Obstacle::Box { min, max: min + DVec3::new(x, y, z) }),
        (place(), size()).prop_map(|(centre, radius_m)| Obstacle::Sphere { centre, radius_m }),
        (place(), size(), size()).prop_map(|(base, radius_m, height_m)| Obstacle::Cylinder {
            base,
            radius_m,
            height_m
        }),
        (place(), place()).prop_map(|(point, normal)| Obstacle::Plane { point, normal }),
        (place(), size()).prop_map(|(at, s)| {
            // A tetrahedron: closed, every face outwards.
            let vertices = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|v| at + v * s).to_vec();
            Obstacle::Mesh { vertices, triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]] }
        }),
    ]
}

fn colonization() -> impl Strategy<Value = Method> {
    let steps = (0.2..2.0_f64, 0.1..0.6_f64, 0.0..1.0_f64).prop_map(|(attraction_m, kill_m, inertia)| {
        ColonizeSpec { attraction_m, kill_m, inertia, max_joints: 20_000, ..ColonizeSpec::default() }
    });
    (envelope(), 1..300_u32, 0.0..0.9_f64, steps).prop_map(|(envelope, points, hollow, steps)| {
        Method::Colonization { envelope, points, hollow, steps }
    })
}

fn competition() -> impl Strategy<Value = Method> {
    (envelope(), 1..300_u32, 1..4_u32, 0.3..1.0_f64).prop_map(|(envelope, points, lifespan, shrink)| {
        Method::Competition(CompetitionSpec {
            envelope,
            points,
            lifespan,
            shrink,
            points_per_joint: 12,
            ..CompetitionSpec::default()
        })
    })
}

fn self_organizing() -> impl Strategy<Value = Method> {
    (1..14_u32, 0.4..0.6_f64, any::<bool>(), prop::option::of(envelope())).prop_map(
        |(years, lambda, ranked, room)| {
            let resource = if ranked {
                Resource::Priority { w_max: 1.0, w_min: 0.1, kappa: 4 }
            } else {
                Resource::BorchertHonda { lambda, lambda_late: None }
            };
            let light = room.map_or_else(Light::default, |envelope| Light::Space {
                envelope,
                markers: 3000,
                occupancy: 2.0,
                perception: 4.0,
                half_angle_deg: 45.0,
            });
            let spec = SelfOrganizingSpec { years, resource, light, ..SelfOrganizingSpec::default() };
            Method::SelfOrganizing(SelfOrganizingSpec { max_joints: 3000, ..spec })
        },
    )
}

fn method() -> impl Strategy<Value = Method> {
    let rules = Just(Method::Lsystem { rules: OAK_RULES.into(), most_modules: 200_000 });
    prop_oneof![colonization(), competition(), self_organizing(), rules]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn no_joint_lies_outside_the_envelope_plus_a_step(
        envelope in envelope(),
        points in 1..400_u32,
        hollow in 0.0..0.9_f64,
        attraction_m in 0.3..3.0_f64,
        kill in 0.1..1.0_f64,
        lifespan in 1..4_u32,
        seed: u64,
    ) {
        let kill_m = kill * attraction_m;
        // Below the envelope: the gap belongs to the tree's space.
        let root = DVec3::ZERO;
        let (run, none, mut told) = (Run::plain(), Obstacles::none(), Report::default());
        let crown = envelope.prepare().expect("sound");
        let attractors = crown.scatter(points as usize, hollow, Seed::new(seed), |_| true).expect("room");
        let steps = ColonizeSpec { attraction_m, kill_m, ..ColonizeSpec::default() };
        let grown = colonize(&[root], &attractors, &none, &steps, &run, &mut told).expect("sound");
        let reached = grown.fates.iter().filter(|f| matches!(f, PointFate::Reached(_))).count();
        let lost = grown.fates.iter().filter(|f| **f == PointFate::Unreached).count();
        prop_assert_eq!((grown.fates.len(), reached + lost), (attractors.len(), attractors.len()));
        let spec = CompetitionSpec {
            envelope: envelope.clone(),
            points,
            hollow,
            attraction_m,
            kill_m,
            lifespan,
            points_per_joint: 10,
            ..CompetitionSpec::default()
        };
        let competed = compete(&[root], &none, &spec, Seed::new(seed), &run, &mut told).expect("sound");
        let step = 0.5 * kill_m;
        for skeleton in [&grown.skeleton, &competed.skeleton] {
            prop_assert_eq!(skeleton.validate().next(), None);
            for u in directions() {
                let most = support(&envelope, u).max(root.dot(u)) + step;
                let out = skeleton.position.iter().map(|p| p.dot(u) - most).fold(f64::NEG_INFINITY, f64::max);
                prop_assert!(out < 1e-9, "{} m too far along {}", out, u);
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn every_method_ends_sound_and_keeps_out_of_obstacles(
        method in method(),
        obstacles in prop::collection::vec(obstacle(), 0..4),
        roots in prop::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64), 1..3),
        leaf_keep in 0.0..1.0_f64,
        age in prop::option::of(0..30_u32),
        seed: u64,
    ) {
        // At its end an L-system is the same as at its sixth step, but larger.
        let rules = matches!(method, Method::Lsystem { .. });
        let age = if rules { Some(age.map_or(6, |a| a.min(6))) } else { age };
        let spec = TreeSpec {
            roots: roots.iter().map(|&(x, z)| DVec3::new(x, 0.0, z)).collect(),
            obstacles,
            age,
            method,
            leaves: FoliageSpec { leaf_keep, max_leaves: 20_000, ..FoliageSpec::default() },
            ..TreeSpec::default()
        };
        let mut report = Report::default();
        let grown = match grow(&spec, None, Seed::new(seed), &Run::plain(), &mut report) {
            Ok(grown) => grown,
            // A root in an obstacle, an envelope that obstacles fill, a plane's normal without a length, an age beyond
            // life.
            Err(
                GrowthError::RootInObstacle { .. }
                | GrowthError::NoRoom { .. }
                | GrowthError::Nothing { .. }
                | GrowthError::Obstacle { .. }
                | GrowthError::BeyondLife { .. },
            ) => return Ok(()),
            Err(other) => return Err(TestCaseError::fail(other.to_string())),
        };
        prop_assert_eq!(grown.skeleton.validate().next(), None);
        prop_assert_eq!(grown.plant.validate().next(), None);
        let all = Obstacles::new(&spec.obstacles, spec.clearance_m).expect("as before");
        prop_assert!(grown.plant.nodes.position.iter().all(|p| all.depth(*p) <= 0.0));
        prop_assert!(grown.plant.organs.iter().all(|o| all.depth(o.frame.origin) <= 0.0));
        prop_assert_eq!(grown.tally.consumed + grown.tally.unreachable, grown.tally.attractors);
        let leaves = grown.leaves;
        prop_assert_eq!(leaves.placed, leaves.buried + leaves.fallen + leaves.kept);
        let again = grow(&spec, None, Seed::new(seed), &Run::plain(), &mut report).expect("as before");
        prop_assert_eq!(grown.plant.digest_hex(), again.plant.digest_hex());
    }
}

#[test]
fn rules_of_the_oak_are_read() {
    assert!(Lsystem::parse(OAK_RULES).is_ok_and(|system| system.steps >= 6));
}
