//! What a scanner sees of trees and stands.

use burgeon::glam::{self, DVec3};
use burgeon::mesh::Standing;
use burgeon::plant::AxisId;
use burgeon::{
    NOTHING, Run, Seed, Stood, SurveySpec, Surveyed, TreeEvaluator, TreeOptions, TreeSpec, survey,
    survey_stand,
};

/// Returns the distance of a place from the segment between `a` and `b`.
fn from_segment(at: DVec3, a: DVec3, b: DVec3) -> f64 {
    let way = b - a;
    let along = ((at - a).dot(way) / way.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    at.distance(a + way * along)
}

fn tree() -> TreeEvaluator {
    let mut evaluator = TreeEvaluator::default();
    let made = evaluator.update(&TreeSpec::default(), Seed::new(3), &TreeOptions::default(), &Run::plain());
    made.expect("a tree");
    evaluator
}

fn scanned(evaluator: &TreeEvaluator, spec: &SurveySpec) -> Surveyed {
    let of = (
        evaluator.plant().expect("a plant"),
        evaluator.model().expect("a model"),
        evaluator.layout().expect("a layout"),
    );
    survey(of, spec, Seed::new(5), &Run::plain()).expect("a cloud")
}

#[test]
fn points_of_an_axis_lie_within_its_radius_and_those_of_leaves_near_their_leaf() {
    let tree = tree();
    let plant = tree.plant().expect("a plant");
    let cloud = scanned(&tree, &SurveySpec { points: 5000, ..SurveySpec::default() });
    assert_eq!(cloud.points.len(), 5000);
    let (mut on_axes, mut on_leaves) = (0, 0);
    for (k, p) in cloud.points.iter().enumerate() {
        let at = DVec3::from_array(*p);
        if cloud.organ[k] == NOTHING {
            on_axes += 1;
            let axis = AxisId::new(usize::try_from(cloud.axis[k]).expect("a row"));
            let thick = plant.axis_radii(axis).iter().copied().fold(0.0, f64::max);
            let away = plant.axis_points(axis).windows(2).map(|l| from_segment(at, l[0], l[1]));
            let away = away.fold(f64::INFINITY, f64::min);
            assert!(away <= 3.0 * thick + 0.03, "{away} m from an axis of {thick} m");
        } else {
            on_leaves += 1;
            let organ = &plant.organs[usize::try_from(cloud.organ[k]).expect("a row")];
            let reach = organ.scale * plant.shapes[organ.shape.index()].reach();
            assert!(at.distance(organ.frame.origin) <= 1.5 * reach + 1e-3);
            assert_eq!(cloud.part[k], 5);
        }
    }
    assert!(on_axes > 50 && on_leaves > 1000, "{on_axes} on axes, {on_leaves} on leaves");
}

#[test]
fn noise_moves_points_along_their_beams_only() {
    let tree = tree();
    let plain = SurveySpec { points: 2000, ..SurveySpec::default() };
    let still = scanned(&tree, &plain);
    let moved = scanned(&tree, &SurveySpec { noise_m: 0.02, ..plain.clone() });
    let off: Vec<f64> = still
        .points
        .iter()
        .zip(&moved.points)
        .map(|(a, b)| DVec3::from_array(*a).distance(DVec3::from_array(*b)))
        .collect();
    let rms = (off.iter().map(|x| x * x).sum::<f64>() / off.len() as f64).sqrt();
    assert!((rms - 0.02).abs() < 0.002, "{rms}");
    assert_eq!((still.part, still.organ), (moved.part, moved.organ));
}

#[test]
fn trees_of_a_stand_hide_one_another_and_keep_their_labels() {
    let tree = tree();
    let (plant, model) = (tree.plant().expect("a plant"), tree.model().expect("a model"));
    let layout = tree.layout().expect("a layout");
    let spec = SurveySpec { points: 6000, ..SurveySpec::default() };
    let at = |x: f64, scale: f64| {
        let turn = glam::DQuat::from_xyzw(0.0, 0.6, 0.0, 0.8);
        let standing = Standing { position: DVec3::X * x, scale, turn, ..Standing::home("a tree", model) };
        Stood { standing, plant, layout }
    };
    let alone = Stood { standing: Standing::home("a tree", model), plant, layout };
    let (same, plants) = survey_stand(&[alone], None, &spec, (Seed::new(5), &Run::plain())).expect("a cloud");
    assert_eq!(same, scanned(&tree, &spec));
    assert!(plants.iter().all(|p| *p == 0));
    let stand = [at(-2.0, 1.0), at(0.0, 0.7), at(2.0, 1.2)];
    let (cloud, plants) = survey_stand(&stand, None, &spec, (Seed::new(5), &Run::plain())).expect("a cloud");
    assert_eq!((cloud.points.len(), plants.len()), (6000, 6000));
    for (k, p) in cloud.points.iter().enumerate().filter(|(k, _)| cloud.organ[*k] != NOTHING) {
        let Stood { standing, .. } = stand[usize::try_from(plants[k]).expect("of a plant")];
        let organ = &plant.organs[usize::try_from(cloud.organ[k]).expect("a row")];
        let root = standing.turn * (organ.frame.origin * standing.scale) + standing.position;
        let reach = standing.scale * organ.scale * plant.shapes[organ.shape.index()].reach();
        assert!(DVec3::from_array(*p).distance(root) <= 1.5 * reach + 1e-3);
    }
    let of = |row: i32| plants.iter().filter(|p| **p == row).count();
    // The small one stands in the middle.
    assert!(of(1) > 0 && of(1) < of(0).min(of(2)), "{} {} {}", of(0), of(1), of(2));
}

#[test]
fn wide_beams_see_the_same_tree_and_say_where_they_are_split() {
    let tree = tree();
    let plain = SurveySpec { points: 4000, ..SurveySpec::default() };
    let (still, wide) =
        (scanned(&tree, &plain), scanned(&tree, &SurveySpec { beam_mrad: 3.0, ..plain.clone() }));
    assert_eq!((wide.points.len(), wide.share.len(), wide.time.len()), (4000, 4000, 4000));
    assert!(still.share.iter().all(|s| *s == 1.0) && still.echoes.iter().all(|n| *n == 1));
    let leaves = |c: &Surveyed| c.organ.iter().filter(|o| **o != NOTHING).count() as f64;
    assert!((leaves(&still) / leaves(&wide) - 1.0).abs() < 0.1, "{} {}", leaves(&still), leaves(&wide));
    let mixed = wide.share.iter().filter(|s| **s < 1.0).count();
    assert!(mixed > 1000, "{mixed}");
    assert!(wide.share.iter().all(|s| (0.0..=1.0).contains(s)));
    assert!(wide.echo.iter().zip(&wide.echoes).all(|(k, n)| k < n));
    let again = SurveySpec { beam_mrad: 3.0, ..plain };
    assert_eq!(scanned(&tree, &again), wide);
}

#[test]
fn a_path_goes_past_trees_and_not_through_their_wood() {
    let tree = tree();
    let along = |x: f64| vec![DVec3::new(x, 1.0, -9.0), DVec3::new(x, 1.0, 0.0), DVec3::new(x, 1.0, 9.0)];
    let spec = |x| SurveySpec { points: 2000, path: along(x), ..SurveySpec::default() };
    let seen = scanned(&tree, &spec(6.0));
    assert_eq!(seen.points.len(), 2000);
    assert!(seen.time.windows(2).all(|w| w[0] <= w[1]));
    for (p, (time, leg)) in seen.points.iter().zip(seen.time.iter().zip(&seen.station)) {
        assert!((p[2] - (18.0 * time - 9.0)).abs() < 1e-6);
        assert_eq!(*leg == 0, *time <= 0.5);
    }
    let of =
        (tree.plant().expect("a plant"), tree.model().expect("a model"), tree.layout().expect("a layout"));
    let refused = survey(of, &spec(0.0), Seed::new(5), &Run::plain()).expect_err("in the trunk");
    assert_eq!(refused.to_string(), "path[1] lies in the wood of the plant: lead the path around it");
}
