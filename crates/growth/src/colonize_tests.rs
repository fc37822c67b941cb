use base::{CancelToken, Draw, Seed};
use proptest::prelude::*;

use super::*;
use crate::{Envelope, Obstacle};

fn grow(
    roots: &[DVec3],
    points: &[DVec3],
    obstacles: &Obstacles,
    spec: &ColonizeSpec,
) -> (Colonized, Report) {
    let mut report = Report::default();
    let grown = colonize(roots, points, obstacles, spec, &Run::plain(), &mut report).expect("sound input");
    (grown, report)
}

fn ball(n: usize) -> Vec<DVec3> {
    let region = Envelope::default().prepare().expect("sound");
    region.scatter(n, 0.0, Seed::new(3), |_| true).expect("room")
}

/// Runs the published method without grid, queue or memory.
fn by_the_book(root: DVec3, points: &[DVec3], di: f64, dk: f64, step: f64, rounds: usize) -> Vec<DVec3> {
    let mut joints = vec![root];
    let mut left: Vec<DVec3> =
        points.iter().copied().filter(|p| p.distance_squared(root) > dk * dk).collect();
    let mut children: Vec<Vec<DVec3>> = vec![vec![]];
    for _ in 0..rounds {
        let mut sum = vec![DVec3::ZERO; joints.len()];
        for p in &left {
            let near = joints.iter().enumerate().map(|(j, q)| (q.distance_squared(*p), j));
            let (d2, j) = near.reduce(|a, b| if b.0 < a.0 { b } else { a }).expect("joints");
            if d2 < di * di {
                sum[j] += (*p - joints[j]).normalize();
            }
        }
        let old = joints.len();
        for j in 0..old {
            if sum[j] == DVec3::ZERO {
                continue;
            }
            let child = joints[j] + sum[j].normalize() * step;
            if children[j].iter().all(|c| c.distance(child) >= 1e-3 * step) {
                children[j].push(child);
                joints.push(child);
                children.push(vec![]);
            }
        }
        left.retain(|p| joints[old..].iter().all(|q| q.distance_squared(*p) > dk * dk));
    }
    joints
}

#[test]
fn the_fast_way_grows_what_the_printed_way_grows() {
    let points = ball(300);
    let root = DVec3::new(0.0, 1.8, 0.0);
    let spec = ColonizeSpec { attraction_m: 1.0, kill_m: 0.25, step_m: Some(0.1), ..Default::default() };
    // Beyond 40 rounds stalls begin, which the published method does not break.
    let (fast, _) = grow(&[root], &points, &Obstacles::none(), &spec);
    let mut slow = by_the_book(root, &points, 1.0, 0.25, 0.1, 30);
    let mut fast = fast.skeleton.at_age(30).position;
    let order = |a: &DVec3, b: &DVec3| a.x.total_cmp(&b.x);
    slow.sort_by(order);
    fast.sort_by(order);
    assert_eq!(fast.len(), slow.len());
    assert!(fast.len() > 200, "{}", fast.len());
    for (a, b) in fast.iter().zip(&slow) {
        assert!(a.distance(*b) < 1e-6, "{a} {b}");
    }
}

#[test]
fn every_point_of_a_ball_is_reached() {
    for seed in 0..5 {
        let region = Envelope::default().prepare().expect("sound");
        let points = region.scatter(2000, 0.0, Seed::new(seed), |_| true).expect("room");
        let spec = ColonizeSpec { attraction_m: 0.9, kill_m: 0.15, ..Default::default() };
        let (grown, report) = grow(&[DVec3::ZERO], &points, &Obstacles::none(), &spec);
        assert!(grown.fates.iter().all(|f| matches!(f, PointFate::Reached(_))), "seed {seed}: {report:?}");
        for (f, p) in grown.fates.iter().zip(&points) {
            if let PointFate::Reached(j) = f {
                assert!(grown.skeleton.position[j.index()].distance(*p) <= 0.15 + 1e-12);
            }
        }
    }
}

#[test]
fn a_tie_between_two_points_is_broken() {
    // Both pull equally: the published method grows straight on between them for ever.
    let points = [DVec3::new(1.0, 0.0, 0.0), DVec3::new(-1.0, 0.0, 0.0)];
    let spec = ColonizeSpec { attraction_m: 2.0, kill_m: 0.2, ..Default::default() };
    let (grown, report) = grow(&[DVec3::ZERO], &points, &Obstacles::none(), &spec);
    assert!(grown.fates.iter().all(|f| matches!(f, PointFate::Reached(_))), "{report:?}");
}

#[test]
fn points_out_of_reach_are_reported() {
    let mut points = ball(300);
    points.extend([DVec3::splat(90.0), DVec3::NAN, DVec3::splat(1e9)]);
    let (grown, report) = grow(&[DVec3::ZERO], &points, &Obstacles::none(), &ColonizeSpec::default());
    assert_eq!(grown.fates[300..], [PointFate::Unreached, PointFate::Unusable, PointFate::Unusable]);
    let codes: Vec<_> = report.warnings.iter().map(|w| w.code).collect();
    assert_eq!(codes, ["attractors-unreached", "attractors-unusable"]);
}

#[test]
fn a_trunk_grows_up_to_the_crown() {
    let (grown, _) = grow(&[DVec3::ZERO], &ball(300), &Obstacles::none(), &ColonizeSpec::default());
    let s = &grown.skeleton;
    assert!((0..4).all(|j| s.position[j].x == 0.0 && s.parent[j].is_none_or(|p| p.index() + 1 == j)));
    assert!(s.position.iter().map(|p| p.y).fold(0.0, f64::max) > 5.5);
}

#[test]
fn trees_share_the_space_between_them() {
    let points = ball(1500);
    let spec = ColonizeSpec { kill_m: 0.2, ..Default::default() };
    let roots = [DVec3::new(-1.5, 0.0, 0.0), DVec3::new(1.5, 0.0, 0.0)];
    let (grown, _) = grow(&roots, &points, &Obstacles::none(), &spec);
    let (left, right) = (grown.skeleton.tree(0), grown.skeleton.tree(1));
    assert!(left.len() > 200 && right.len() > 200, "{} {}", left.len(), right.len());
    let mean = |s: &Skeleton| s.position.iter().map(|p| p.x).sum::<f64>() / s.len() as f64;
    assert!(mean(&left) < -0.4 && mean(&right) > 0.4, "{} {}", mean(&left), mean(&right));
}

#[test]
fn growth_goes_around_a_wall_and_reaches_what_is_behind() {
    // A wall through the crown that is open at its sides and top.
    let wall = Obstacle::Box { min: DVec3::new(0.4, 0.0, -1.0), max: DVec3::new(0.6, 4.5, 1.0) };
    let obstacles = Obstacles::new(&[wall], 0.05).expect("sound");
    let spec = ColonizeSpec { attraction_m: 1.0, kill_m: 0.25, ..Default::default() };
    let (grown, _) = grow(&[DVec3::ZERO], &ball(1500), &obstacles, &spec);
    let s = &grown.skeleton;
    for j in 0..s.len() {
        assert!(obstacles.free(s.position[j]), "{}", s.position[j]);
        if let Some(p) = s.parent[j] {
            assert!(!obstacles.blocks(s.position[p.index()], s.position[j]), "{j}");
        }
    }
    let behind = |p: &&DVec3| p.x > 0.7 && p.y < 4.2 && p.z.abs() < 0.8;
    assert!(s.position.iter().filter(behind).count() > 50);
    let reached = grown.fates.iter().filter(|f| matches!(f, PointFate::Reached(_))).count();
    let open = grown.fates.iter().filter(|f| !matches!(f, PointFate::Buried(_))).count();
    assert!(reached * 100 > open * 97, "{reached} of {open}");
}

#[test]
fn roots_in_obstacles_and_bad_numbers_are_refused() {
    let rock =
        Obstacles::new(&[Obstacle::Sphere { centre: DVec3::ZERO, radius_m: 1.0 }], 0.0).expect("sound");
    let run = Run::plain();
    let go = |roots: &[DVec3], spec: &ColonizeSpec| {
        colonize(roots, &[DVec3::Y], &rock, spec, &run, &mut Report::default()).err()
    };
    let spec = ColonizeSpec::default();
    assert_eq!(
        go(&[DVec3::ZERO], &spec),
        Some(GrowthError::RootInObstacle { root: 0, obstacle: 0, name: "a sphere".into() })
    );
    assert_eq!(go(&[], &spec), Some(GrowthError::NoRoots));
    assert_eq!(go(&[DVec3::NAN], &spec), Some(GrowthError::Root { root: 0 }));
    for bad in [f64::NAN, 0.0, -1.0, f64::INFINITY] {
        let spec = ColonizeSpec { kill_m: bad, ..Default::default() };
        assert!(matches!(go(&[DVec3::Y * 2.0], &spec), Some(GrowthError::Range(f)) if f.path == "kill_m"));
    }
}

#[test]
fn kill_distance_above_attraction_distance_is_told_and_borne() {
    let spec = ColonizeSpec { attraction_m: 0.2, kill_m: 0.5, steer_before_kill: true, ..Default::default() };
    let (grown, report) = grow(&[DVec3::ZERO], &ball(1500), &Obstacles::none(), &spec);
    assert_eq!(report.warnings[0].code, "attraction-raised");
    let reached = grown.fates.iter().filter(|f| matches!(f, PointFate::Reached(_))).count();
    // Each joint steers once, so there is one limb: a path through the ball, and no more.
    assert!(reached > 300 && grown.skeleton.children().iter().all(|&c| c < 2), "{reached}");
}

#[test]
fn many_points_in_one_place_are_one() {
    let points = vec![DVec3::new(0.3, 2.0, 0.0); 100_000];
    let (grown, _) = grow(&[DVec3::ZERO], &points, &Obstacles::none(), &ColonizeSpec::default());
    assert!(grown.fates.iter().all(|f| matches!(f, PointFate::Reached(_))) && grown.skeleton.len() < 30);
    let (none, _) = grow(&[DVec3::ZERO], &[], &Obstacles::none(), &ColonizeSpec::default());
    assert_eq!(none.skeleton.len(), 1);
}

#[test]
fn growth_stops_where_it_is_told_and_when_cancelled() {
    let spec = ColonizeSpec { max_joints: 50, ..Default::default() };
    let (grown, report) = grow(&[DVec3::ZERO], &ball(500), &Obstacles::none(), &spec);
    assert!(grown.skeleton.len() <= 50 && report.warnings.iter().any(|w| w.code == "growth-stopped"));
    let cancel = CancelToken::new();
    cancel.cancel();
    let run = Run { cancel: &cancel, ..Run::plain() };
    let spec = ColonizeSpec::default();
    let got = colonize(&[DVec3::ZERO], &ball(9), &Obstacles::none(), &spec, &run, &mut Report::default());
    assert!(matches!(got, Err(GrowthError::Cancelled(_))));
}

#[test]
fn a_pull_bends_the_tree() {
    let wind = vec![Tropism { direction: DVec3::X, strength: 0.6 }];
    let lean = |tropisms: Vec<Tropism>| {
        let spec = ColonizeSpec { tropisms, attraction_m: 5.0, kill_m: 0.3, ..Default::default() };
        let (g, _) = grow(&[DVec3::ZERO], &[DVec3::Y * 3.0], &Obstacles::none(), &spec);
        assert!(matches!(g.fates[0], PointFate::Reached(_)), "the point wins in the end");
        g.skeleton.position.iter().map(|p| p.x).fold(0.0, f64::max)
    };
    assert!(lean(wind) > 0.5 && lean(vec![]) == 0.0);
}

#[test]
fn a_pruned_branch_grows_again_and_the_rest_stays() {
    let points = ball(800);
    let spec = ColonizeSpec { kill_m: 0.25, ..Default::default() };
    let (grown, mut report) = grow(&[DVec3::ZERO], &points, &Obstacles::none(), &spec);
    let s = &grown.skeleton;
    let limb =
        (0..s.len()).find(|&j| s.parent[j].is_some_and(|p| s.children()[p.index()] == 2)).expect("forks");
    let cut = s.prune(JointId::new(limb));
    let none = Obstacles::none();
    let again =
        regrow(&grown, JointId::new(limb), &points, &none, &spec, &Run::plain(), &mut report).expect("sound");
    assert!(cut.len() < s.len() && again.skeleton.len() > cut.len(), "{} {}", s.len(), cut.len());
    assert_eq!(again.skeleton.position[..cut.len()], cut.position[..]);
    for (f, p) in again.fates.iter().zip(&points) {
        let PointFate::Reached(j) = f else { panic!("{p} was reached before and can be again") };
        assert!(again.skeleton.position[j.index()].distance(*p) < 0.25 + 1e-9);
    }
}

fn place() -> impl Strategy<Value = DVec3> {
    // A few coordinates recur, so that points coincide, line up and tie.
    let c = prop_oneof![
        4 => -3.0..3.0_f64,
        2 => (-3..=3_i32).prop_map(f64::from),
        1 => Just(f64::NAN),
        1 => Just(1e300),
        1 => Just(1e-300),
    ];
    prop_oneof![
        9 => (-3.0..3.0_f64, -3.0..3.0_f64, -3.0..3.0_f64).prop_map(|(x, y, z)| DVec3::new(x, y, z)),
        3 => (-3..=3_i32, -3..=3_i32, -3..=3_i32).prop_map(|(x, y, z)| DVec3::new(f64::from(x), f64::from(y), f64::from(z))),
        1 => (c.clone(), c.clone(), c).prop_map(|(x, y, z)| DVec3::new(x, y, z)),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]
    #[test]
    fn growth_ends_and_every_point_has_its_fate(
        points in prop::collection::vec(place(), 0..120),
        roots in prop::collection::vec(place(), 1..3),
        attraction_m in 0.1..5.0_f64,
        kill_m in 0.05..2.0_f64,
        step in prop::option::of(0.05..3.0_f64),
        walled: bool,
        seed in 0..4_u64,
    ) {
        let mut s = Seed::new(seed).stream(Draw::Test);
        let wall = Obstacle::Sphere { centre: DVec3::splat(s.range(-2.0, 2.0)), radius_m: s.range(0.2, 1.0) };
        let obstacles = if walled { Obstacles::new(&[wall], 0.02).expect("sound") } else { Obstacles::none() };
        let pull = Tropism { direction: DVec3::new(s.normal(), 1.0, 0.0), strength: s.range(-1.5, 1.5) };
        let spec = ColonizeSpec {
            attraction_m, kill_m, step_m: step, tropisms: vec![pull], inertia: 0.3, steer_before_kill: seed % 2 == 1, max_joints: 20_000,
        };
        let mut report = Report::default();
        let grown = match colonize(&roots, &points, &obstacles, &spec, &Run::plain(), &mut report) {
            Ok(grown) => grown,
            Err(GrowthError::Root { .. } | GrowthError::RootInObstacle { .. }) => return Ok(()),
            Err(other) => return Err(TestCaseError::fail(other.to_string())),
        };
        prop_assert_eq!(grown.skeleton.validate().count(), 0);
        prop_assert!(grown.skeleton.len() <= 20_000);
        prop_assert!(!report.warnings.iter().any(|w| w.code == "growth-stopped"), "{:?}", report);
        for (fate, p) in grown.fates.iter().zip(&points) {
            match fate {
                PointFate::Reached(j) => {
                    prop_assert!(grown.skeleton.position[j.index()].distance(*p) <= kill_m + 1e-9);
                }
                PointFate::Unreached => {
                    let near = grown.skeleton.position.iter().map(|q| q.distance(*p)).fold(f64::INFINITY, f64::min);
                    prop_assert!(near > kill_m || walled, "{} {}", near, kill_m);
                    // Without walls every perceived point is reached, as long as steps do not pass it by.
                    let perceived = near < attraction_m.max(kill_m) * (1.0 - 1e-9);
                    prop_assert!(walled || !perceived, "{} at {}", p, near);
                }
                PointFate::Buried(_) => prop_assert!(walled && !obstacles.free(*p)),
                PointFate::Unusable => prop_assert!(!usable(*p)),
            }
        }
        if walled {
            for p in grown.skeleton.position.iter().skip(roots.len()) {
                prop_assert!(obstacles.inside(*p).is_none(), "{}", p);
            }
        }
    }
}
