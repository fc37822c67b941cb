//! What guided growth promises.

use super::*;
use crate::{Envelope, Obstacle};

fn tree(spec: &GuidedSpec) -> Guided {
    let none = Obstacles::none();
    guide(&[DVec3::ZERO], &none, spec, Seed::new(1), &Run::plain(), &mut Report::default()).expect("sound")
}

#[test]
fn a_tree_forks_and_stays_in_its_envelope() {
    let envelope = Envelope::Sphere { centre: DVec3::Y * 3.0, radius_m: 1.8 };
    let spec = GuidedSpec { envelope: Some(envelope), ..GuidedSpec::default() };
    let got = tree(&spec);
    let s = &got.skeleton;
    assert_eq!(s.validate().next(), None);
    let forks = s.children().iter().filter(|c| **c > 1).count();
    assert!(s.len() > 80 && forks > 20, "{} joints, {forks} forks", s.len());
    assert!(s.position.iter().all(|p| p.y < 1.3 || p.distance(DVec3::Y * 3.0) < 1.81));
    assert!(got.died > 20, "{}", got.died);
}

#[test]
fn a_stroke_leads_growth_along_itself() {
    let line: Vec<DVec3> =
        (0..=20).map(|i| DVec3::new(0.2 * f64::from(i), 2.0 + 0.05 * f64::from(i), 0.0)).collect();
    let stroke = BrushStroke { points: line, radius_m: vec![0.5], pull: 1.0 };
    let mut start = Skeleton::default();
    let root = start.push_root(DVec3::Y * 2.0, 0);
    let bud = StartBud { joint: root, heading: DVec3::Y, wakes: 0 };
    let spec = GuidedSpec { strokes: vec![stroke], rounds: 20, internode_m: 0.15, ..GuidedSpec::default() };
    let (none, run) = (Obstacles::none(), Run::plain());
    let got =
        guide_from(start, &[bud], &none, &spec, Seed::new(1), &run, &mut Report::default()).expect("sound");
    let p = &got.skeleton.position;
    assert!(p.len() > 30, "{}", p.len());
    let off = |p: &DVec3| {
        let y = 2.0 + 0.25 * p.x.clamp(0.0, 4.0);
        (p.y - y).abs().max(p.z.abs())
    };
    assert!(p.iter().all(|p| off(p) < 0.55), "inside the tube");
    assert!(p.iter().map(|p| p.x).fold(0.0, f64::max) > 3.2, "to its end");
}

#[test]
fn neighbours_lean_apart() {
    let lean = |repulsion: f64| {
        let mut start = Skeleton::default();
        let places = [DVec3::ZERO, DVec3::X * 0.4];
        let buds: Vec<StartBud> = (0_u32..)
            .zip(places)
            .map(|(tree, at)| StartBud { joint: start.push_root(at, tree), heading: DVec3::Y, wakes: 0 })
            .collect();
        let spec =
            GuidedSpec { repulsion, rounds: 1, alpha: 20.0, tropisms: vec![], ..GuidedSpec::default() };
        let (none, run) = (Obstacles::none(), Run::plain());
        let got = guide_from(start, &buds, &none, &spec, Seed::new(1), &run, &mut Report::default());
        let s = got.expect("sound").skeleton;
        let first =
            |tree: u32| (2..s.len()).find(|&j| s.tree[j] == tree).map(|j| s.heading(JointId::new(j)).x);
        first(1).expect("grew") - first(0).expect("grew")
    };
    assert!(lean(1.0) > lean(0.0) + 0.2, "{} {}", lean(1.0), lean(0.0));
}

#[test]
fn growth_goes_around_obstacles() {
    let rock = Obstacle::Sphere { centre: DVec3::new(0.3, 1.6, 0.0), radius_m: 0.6 };
    let obstacles = Obstacles::new(&[rock], 0.05).expect("sound");
    let spec = GuidedSpec { rounds: 10, ..GuidedSpec::default() };
    let got = guide(&[DVec3::ZERO], &obstacles, &spec, Seed::new(2), &Run::plain(), &mut Report::default());
    let got = got.expect("sound").skeleton;
    assert!(got.len() > 40 && got.position.iter().all(|p| obstacles.inside(*p).is_none()));
}

#[test]
fn nonsense_is_refused() {
    let try_it = |spec: GuidedSpec| {
        let none = Obstacles::none();
        guide(&[DVec3::ZERO], &none, &spec, Seed::new(1), &Run::plain(), &mut Report::default()).err()
    };
    let base = GuidedSpec::default;
    assert!(try_it(GuidedSpec { markers: 0, ..base() }).is_some());
    assert!(try_it(GuidedSpec { far: 1.0, ..base() }).is_some());
    assert!(try_it(GuidedSpec { internode_m: f64::NAN, ..base() }).is_some());
    let stroke = |points, radius_m| vec![BrushStroke { points, radius_m, pull: 1.0 }];
    assert!(try_it(GuidedSpec { strokes: stroke(vec![DVec3::ZERO], vec![1.0]), ..base() }).is_some());
    let line = vec![DVec3::ZERO, DVec3::Y, DVec3::Y * 2.0];
    assert!(try_it(GuidedSpec { strokes: stroke(line.clone(), vec![1.0, 2.0]), ..base() }).is_some());
    assert!(try_it(GuidedSpec { strokes: stroke(line, vec![-1.0]), ..base() }).is_some());
}

#[test]
fn crowns_of_any_size_are_filled() {
    let none = Obstacles::none();
    for scale in [0.3, 5.0] {
        let envelope = Envelope::Sphere { centre: DVec3::Y * 2.0 * scale, radius_m: scale };
        let spec = GuidedSpec { markers: 12, ..GuidedSpec::of_crown(envelope.clone()) };
        let run = Run::plain();
        let tree =
            guide(&[DVec3::ZERO], &none, &spec, Seed::new(1), &run, &mut Report::default()).expect("sound");
        let region = envelope.prepare().expect("sound");
        let places = region.scatter(300, 0.0, Seed::new(2), |_| true).expect("room");
        let near =
            |p: &&DVec3| tree.skeleton.position.iter().any(|q| q.distance(**p) < spec.far * spec.internode_m);
        let filled = places.iter().filter(near).count();
        assert!((4_000..40_000).contains(&tree.skeleton.len()), "{scale}: {}", tree.skeleton.len());
        assert!(filled > 285, "{scale}: {filled} of 300 places have wood near");
    }
    let bad = Envelope::Sphere { centre: DVec3::ZERO, radius_m: -1.0 };
    assert_eq!(
        GuidedSpec::of_crown(bad.clone()),
        GuidedSpec { envelope: Some(bad), ..GuidedSpec::default() }
    );
}

#[test]
fn buds_that_all_look_at_one_another_are_refused() {
    // In so narrow a cone no bud is in another one's way, and all of them stand together.
    let spec = GuidedSpec { half_angle_deg: 1.0, ..GuidedSpec::default() };
    let budget = base::Budget { times: 0.002, ..base::Budget::default() };
    let run = Run { budget, ..Run::plain() };
    let got = guide(&[DVec3::ZERO], &Obstacles::none(), &spec, Seed::new(1), &run, &mut Report::default());
    let Err(GrowthError::OverBudget(over)) = got else { panic!("refused") };
    assert!(matches!(over.what, Counted::Looks | Counted::Points), "{over}");
}
