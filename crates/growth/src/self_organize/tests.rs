use super::*;
use crate::{Envelope, Obstacle, Tropism};

fn grow(spec: &SelfOrganizingSpec, roots: &[DVec3]) -> SelfOrganized {
    let none = Obstacles::none();
    let got = self_organize(roots, &none, spec, Seed::new(1), &Run::plain(), &mut Report::default())
        .expect("sound");
    assert_eq!(got.skeleton.validate().count(), 0);
    got
}

fn height(s: &Skeleton) -> f64 {
    s.position.iter().map(|p| p.y).fold(0.0, f64::max)
}

#[test]
fn vigour_is_shared_without_loss() {
    // A fork with a tip, a waiting bud and a branch.
    let mut root = Skeleton::default();
    root.push_root(DVec3::ZERO, 0);
    let mut grove = Grove::new(root, 1);
    let a = grove.grow(0, None, DVec3::Y, 1.0, 1);
    let b = grove.grow(a, None, DVec3::Y, 1.0, 1);
    grove.grow(a, Some(a), DVec3::X, 1.0, 2);
    let light = [0.0, 0.0, 0.8, 0.3];
    for sharing in [Sharing::Fork { lambda: 0.5 }, Sharing::Rank { w_max: 1.0, w_min: 0.1, kappa: 2 }] {
        let mut flow = Flow::default();
        flow.gather(&grove, &light);
        assert!((flow.light[0] - 2.2).abs() < 1e-12 && flow.size[0] == 4.0, "{flow:?}");
        // A hundredth of the total is enough for every bud.
        flow.share(&grove, &light, 200.0, sharing);
        let all: f64 = flow.fed.iter().map(|f| f.vigour).sum();
        assert!((all - 440.0).abs() < 1e-9, "{sharing:?}: {all}");
        assert!(flow.fed.is_sorted_by_key(|f| f.joint) && flow.fed.len() == 4, "{sharing:?}: {:?}", flow.fed);
        // The light of two buds is enough for two at most.
        flow.share(&grove, &light, 0.9, sharing);
        assert!(
            flow.fed.len() < 3 && flow.fed.iter().all(|f| f.vigour > 0.99),
            "{sharing:?}: {:?}",
            flow.fed
        );
    }
    let mut flow = Flow::default();
    flow.gather(&grove, &light);
    flow.share(&grove, &light, 2.0, Sharing::Fork { lambda: 0.6 });
    // At a: Q_m 1.6, Q_l 0.6; the main side gets .96 / (.96 + .24) of 4.4, its tip .6 / (.6 + .4) of that.
    let main = 4.4 * 0.96 / 1.2;
    let tip = flow.fed.iter().find(|f| f.joint == b && f.bud.is_none());
    assert!(tip.is_some_and(|f| (f.vigour - main * 0.6).abs() < 1e-12), "{flow:?}");
}

#[test]
fn more_leader_bias_makes_a_taller_and_slimmer_tree() {
    let of = |lambda: f64| {
        let resource = Resource::BorchertHonda { lambda, lambda_late: None };
        let tree = grow(&SelfOrganizingSpec { resource, ..SelfOrganizingSpec::default() }, &[DVec3::ZERO]);
        let wide = tree.skeleton.position.iter().map(|p| p.x.abs().max(p.z.abs())).fold(0.0, f64::max);
        (height(&tree.skeleton), wide)
    };
    let (bush, leader) = (of(0.46), of(0.56));
    assert!(leader.0 > 1.2 * bush.0, "{leader:?} {bush:?}");
    assert!(leader.1 / leader.0 < bush.1 / bush.0, "{leader:?} {bush:?}");
}

#[test]
fn later_years_only_add_and_shed() {
    let spec = SelfOrganizingSpec::default();
    let five = grow(&SelfOrganizingSpec { years: 5, ..spec.clone() }, &[DVec3::ZERO]);
    let ten = grow(&SelfOrganizingSpec { years: 10, ..spec }, &[DVec3::ZERO]);
    assert!(ten.skeleton.len() > 2 * five.skeleton.len());
    let young = ten.skeleton.at_age(5);
    assert!(young.position.iter().all(|p| five.skeleton.position.contains(p)));
    assert_eq!(ten.skeleton.len(), 1 + ten.generated - ten.shed);
}

#[test]
fn shade_is_shed_and_makes_a_bole() {
    let spec = SelfOrganizingSpec { years: 30, ..SelfOrganizingSpec::default() };
    let (kept, all) =
        (grow(&spec, &[DVec3::ZERO]), grow(&SelfOrganizingSpec { shed_below: 0.0, ..spec }, &[DVec3::ZERO]));
    assert!(kept.shed > 0 && all.shed == 0);
    let low =
        |s: &Skeleton| s.position.iter().filter(|p| p.y < 0.25 * height(s)).count() as f64 / s.len() as f64;
    assert!(low(&kept.skeleton) < low(&all.skeleton), "{} {}", low(&kept.skeleton), low(&all.skeleton));
}

#[test]
fn wood_remembers_what_was_shed() {
    let tree = grow(&SelfOrganizingSpec { years: 30, ..SelfOrganizingSpec::default() }, &[DVec3::ZERO]);
    let s = &tree.skeleton;
    let n = SelfOrganizingSpec::default().pipe_exponent;
    let mut above = vec![0.0; s.len()];
    for j in (1..s.len()).rev() {
        let p = s.parent[j].expect("one tree").index();
        above[p] += ops::powf(s.radius_m[j], n);
        assert!(s.radius_m[p] >= s.radius_m[j] * (1.0 - 1e-9), "{j}");
    }
    assert!(ops::powf(s.radius_m[0], n) > above[0] * 0.999);
    let thicker = (0..s.len()).filter(|&j| ops::powf(s.radius_m[j], n) > above[j] * 1.001 && above[j] > 0.0);
    let thicker = thicker.count();
    assert!(thicker > 0, "wood of shed branches is still there: {thicker}, {} shed", tree.shed);
}

#[test]
fn a_neighbour_takes_light() {
    let spec = SelfOrganizingSpec { years: 20, ..SelfOrganizingSpec::default() };
    let apart = [DVec3::ZERO, DVec3::X * 0.8];
    let (alone, both) = (grow(&spec, &apart[..1]), grow(&spec, &apart));
    let first = both.skeleton.tree(0);
    let mean = |s: &Skeleton| s.position.iter().map(|p| p.x).sum::<f64>() / s.len() as f64;
    assert!(mean(&first) < mean(&alone.skeleton) - 0.05, "{} {}", mean(&first), mean(&alone.skeleton));
}

#[test]
fn space_and_priority_models_grow_trees_too() {
    let light = Light::Space {
        envelope: Envelope::Ellipsoid {
            centre: DVec3::new(0.0, 3.0, 0.0),
            radii_m: DVec3::new(2.0, 3.0, 2.0),
        },
        markers: 20_000,
        occupancy: 2.0,
        perception: 4.0,
        half_angle_deg: 45.0,
    };
    let resource = Resource::Priority { w_max: 1.0, w_min: 0.1, kappa: 5 };
    for (light, resource) in
        [(light.clone(), Resource::default()), (Light::default(), resource), (light, resource)]
    {
        let spec = SelfOrganizingSpec {
            light,
            resource,
            years: 20,
            // Lit or dark: one lit tip on a branch of ten internodes is enough light.
            shed_below: 0.03,
            ..SelfOrganizingSpec::default()
        };
        let tree = grow(&spec, &[DVec3::ZERO]);
        assert!(
            height(&tree.skeleton) > 2.0 && tree.skeleton.len() > 150,
            "{spec:?}: {}",
            tree.skeleton.len()
        );
        let forks = tree.skeleton.children().iter().filter(|&&c| c > 1).count();
        assert!(forks > 10, "{forks}");
    }
}

#[test]
fn shoots_keep_out_of_obstacles_and_within_limits() {
    let roof = Obstacle::Box { min: DVec3::new(-3.0, 1.5, -3.0), max: DVec3::new(0.5, 1.8, 3.0) };
    let obstacles = Obstacles::new(&[roof], 0.02).expect("sound");
    let spec = SelfOrganizingSpec { years: 16, max_joints: 700, ..SelfOrganizingSpec::default() };
    let mut report = Report::default();
    let got = self_organize(&[DVec3::ZERO], &obstacles, &spec, Seed::new(1), &Run::plain(), &mut report);
    let s = got.expect("sound").skeleton;
    assert!(s.position.iter().all(|&p| obstacles.inside(p).is_none()));
    assert!(height(&s) > 1.9, "it finds its way out: {}", height(&s));
    assert!(s.len() <= 700);
    let bad = SelfOrganizingSpec {
        tropisms: vec![Tropism { direction: DVec3::NAN, strength: 1.0 }],
        ..SelfOrganizingSpec::default()
    };
    let none = Obstacles::none();
    let got = self_organize(&[DVec3::ZERO], &none, &bad, Seed::new(1), &Run::plain(), &mut report);
    assert!(matches!(got, Err(GrowthError::Field { field: "tropism.direction", .. })));
}

#[test]
fn weak_shade_does_not_run_away() {
    let grow = |light: Light, years, alpha| {
        let spec = SelfOrganizingSpec {
            light,
            years,
            alpha,
            arrangement: crate::Arrangement::Decussate,
            max_joints: 20_000,
            ..SelfOrganizingSpec::default()
        };
        let mut report = Report::default();
        let none = Obstacles::none();
        let got = self_organize(&[DVec3::ZERO], &none, &spec, Seed::new(1), &Run::plain(), &mut report);
        (got.expect("sound"), report)
    };
    let weak = Light::Shadow { voxel_m: None, a: 0.04, b: 2.2, layers: 4, full: 2.0 };
    let (tree, report) = grow(weak.clone(), 40, 2.0);
    let told = &report.warnings.iter().find(|w| w.code == "growth-too-much").expect("it stops").message;
    let n = tree.skeleton.len();
    assert!((2_000..=20_000).contains(&n), "{n}");
    for word in
        ["max_joints (20000)", "light.a (0.04)", "light.full (2)", "alpha (2)", &format!("{n} joints")]
    {
        assert!(told.contains(word), "{word}: {told}");
    }
    // A whole tree: as if no more years had been requested. Joints shed in the last year are not restored.
    let last = tree.skeleton.age();
    let (before, report) = grow(weak, last, 2.0);
    assert!(report.warnings.is_empty() && last < 40, "{last}");
    assert!(tree.skeleton.position.iter().all(|p| before.skeleton.position.contains(p)));
    let (_, report) = grow(Light::default(), 16, 2.0);
    assert!(report.warnings.is_empty(), "{report:?}");
}

#[test]
fn a_bole_carries_the_buds_to_markers_that_begin_high_up() {
    let spec = SelfOrganizingSpec {
        light: Light::Space {
            envelope: Envelope::Sphere { centre: DVec3::new(0.0, 6.0, 0.0), radius_m: 2.0 },
            markers: 8_000,
            occupancy: 2.0,
            perception: 5.0,
            half_angle_deg: 45.0,
        },
        shed_below: 0.02,
        ..SelfOrganizingSpec::default()
    };
    let tree = grow(&spec, &[DVec3::ZERO, DVec3::X * 5.0]).skeleton;
    for root in 0..2 {
        let own = tree.tree(root);
        assert!(own.len() > 300 && height(&own) > 6.5, "{} joints, {} m", own.len(), height(&own));
        let foot = own.position[0];
        let low = own.position.iter().filter(|p| p.y < 3.0);
        assert!(low.clone().count() > 10 && low.clone().all(|p| (*p - foot).with_y(0.0).length() < 1e-9));
    }
}

#[test]
fn a_budget_refuses_and_never_makes_another_tree() {
    let spec = SelfOrganizingSpec { years: 18, ..SelfOrganizingSpec::default() };
    let with = |times: f64, spec: &SelfOrganizingSpec| {
        let run = Run { budget: base::Budget { times, ..base::Budget::default() }, ..Run::plain() };
        let none = Obstacles::none();
        self_organize(&[DVec3::ZERO], &none, spec, Seed::new(1), &run, &mut Report::default())
    };
    let whole = with(f64::INFINITY, &spec).expect("sound");
    for times in [1000.0, 1.0, 0.01, 0.001, 0.0001] {
        match with(times, &spec) {
            Ok(tree) => assert_eq!(tree, whole, "{times}"),
            Err(e) => assert!(times < 1.0 && matches!(e, GrowthError::OverBudget(_)), "{times}: {e}"),
        }
    }
    assert!(with(0.0001, &spec).is_err());
    // Few joints that live long.
    let old = SelfOrganizingSpec { years: 1000, shed_below: 1e6, shed_after_years: 0, ..spec };
    let Err(GrowthError::OverBudget(over)) = with(0.001, &old) else {
        panic!("1000 years pass a thousandth")
    };
    assert_eq!(over.what, Counted::JointYears);
}

fn by_sky(full: f64) -> SelfOrganizingSpec {
    let light = Light::Sky { leaf_m: None, lines: 16_384, full };
    SelfOrganizingSpec { light, years: 12, ..SelfOrganizingSpec::default() }
}

#[test]
fn a_leaf_in_the_open_gets_all_light_and_one_below_another_less() {
    let mut sky = Sky::new(0.2, 60_000, 1.0).expect("a sky");
    // One in the open, and one close below another of the same size.
    let joints = [DVec3::new(3.0, 0.0, 0.0), DVec3::new(0.0, 1.0, 0.0), DVec3::new(0.0, 0.8, 0.0)];
    sky.look(&joints, Seed::new(1), &Run::plain()).expect("light");
    let light: Vec<f64> = sky.lights().collect();
    assert!((light[0] - 1.0).abs() < 0.02 && (light[1] - 1.0).abs() < 0.02, "{light:?}");
    // Two squares at the distance of their edge: the sky that the upper one hides is the view factor of opposite sides of
    // a cube, 0.1998, by the mean light of the overcast sky there.
    let hidden = 1.0 - light[2];
    assert!(hidden > 0.1998 && hidden < 0.1998 * 9.0 / 7.0, "{light:?}");
    assert!(sky.towards(0).y > 0.99, "{}", sky.towards(0));
}

#[test]
fn a_bud_beside_a_roof_turns_to_the_open_side() {
    let mut sky = Sky::new(0.1, 60_000, 1.0).expect("a sky");
    let mut joints = vec![DVec3::ZERO];
    for x in 0..30 {
        for z in -15..15 {
            joints.push(DVec3::new(0.1 * f64::from(x), 0.5, 0.1 * f64::from(z)));
        }
    }
    sky.look(&joints, Seed::new(1), &Run::plain()).expect("light");
    assert!(sky.towards(0).x < -0.3, "{}", sky.towards(0));
}

#[test]
fn trees_in_the_light_of_the_sky_are_repeatable_and_shade_one_another() {
    let spec = by_sky(1.0);
    let alone = grow(&spec, &[DVec3::ZERO]);
    assert_eq!(alone, grow(&spec, &[DVec3::ZERO]));
    assert!(alone.skeleton.len() > 100, "{}", alone.skeleton.len());
    let near: Vec<DVec3> =
        (0..9).map(|k| DVec3::new(f64::from(k % 3), 0.0, f64::from(k / 3)) * 0.8).collect();
    let crowded = grow(&spec, &near);
    let each = crowded.skeleton.len() / near.len();
    assert!(each < alone.skeleton.len(), "{each}, alone {}", alone.skeleton.len());
    // The last years leave the first as they were.
    let fewer = grow(&SelfOrganizingSpec { years: 8, ..spec }, &[DVec3::ZERO]);
    assert!(fewer.skeleton.len() < alone.skeleton.len());
    assert_eq!(fewer.skeleton.position[..4], alone.skeleton.position[..4]);
}

#[test]
fn too_dim_a_sky_is_an_error_that_says_so() {
    let none = Obstacles::none();
    let spec = by_sky(0.1);
    let found =
        self_organize(&[DVec3::ZERO], &none, &spec, Seed::new(1), &Run::plain(), &mut Report::default());
    let why = found.expect_err("nothing grows").to_string();
    assert!(why.contains("light.full"), "{why}");
    let light = Light::Sky { leaf_m: Some(1e9), lines: 16_384, full: 1.0 };
    let wide = SelfOrganizingSpec { light, ..spec };
    let found =
        self_organize(&[DVec3::ZERO], &none, &wide, Seed::new(1), &Run::plain(), &mut Report::default());
    assert!(found.expect_err("a range").to_string().contains("light.leaf_m"));
}
