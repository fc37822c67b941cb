//! Tests of the guarantees of guided growth.

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
        let spec = GuidedSpec { markers: 12, ..GuidedSpec::from_crown(envelope.clone()) };
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
        GuidedSpec::from_crown(bad.clone()),
        GuidedSpec { envelope: Some(bad), ..GuidedSpec::default() }
    );
}

#[test]
fn buds_that_all_look_at_one_another_are_refused() {
    // In such a narrow cone no bud obstructs another, and all of them stand together.
    let spec = GuidedSpec { half_angle_deg: 1.0, ..GuidedSpec::default() };
    let budget = base::Budget { times: 0.002, ..base::Budget::default() };
    let run = Run { budget, ..Run::plain() };
    let got = guide(&[DVec3::ZERO], &Obstacles::none(), &spec, Seed::new(1), &run, &mut Report::default());
    let Err(GrowthError::OverBudget(over)) = got else { panic!("refused") };
    assert!(matches!(over.what, Counted::MarkerQueries | Counted::Points), "{over}");
}

/// Grows rounds one by one, with these changes, each before its round.
fn by_hand(rounds: u32, changes: &[GuidedChange]) -> (GuidedSpec, Guided) {
    let (none, run) = (Obstacles::none(), Run::plain());
    let mut growing =
        Growing::plant(&[DVec3::ZERO], &none, &GuidedSpec::default(), Seed::new(3), &run).expect("sound");
    for round in 0..rounds {
        for change in changes.iter().filter(|c| c.round == round) {
            growing.change(change.clone(), &run).expect("sound");
        }
        let before = growing.skeleton().clone();
        growing.step(&run).expect("sound");
        let after = growing.skeleton();
        assert_eq!(after.position[..before.len()], before.position, "wood stays where it is");
    }
    (growing.record(), growing.finish())
}

#[test]
fn a_record_grows_the_same_tree() {
    let line: Vec<DVec3> = (0..9).map(|i| DVec3::new(0.3 * f64::from(i), 1.5, 0.0)).collect();
    let stroke = BrushStroke { points: line, radius_m: vec![0.6], pull: 1.0 };
    let changes = [
        GuidedChange { round: 2, branch_angle_deg: Some(85.0), ..GuidedChange::default() },
        GuidedChange { round: 5, alpha: Some(4.0), lambda: Some(0.4), ..GuidedChange::default() },
        GuidedChange { round: 5, markers: Some(20), repulsion: Some(0.0), ..GuidedChange::default() },
        GuidedChange {
            round: 7,
            tropisms: Some(Vec::new()),
            strokes: Some(vec![stroke]),
            ..GuidedChange::default()
        },
    ];
    let again = |spec: &GuidedSpec| {
        let (none, run) = (Obstacles::none(), Run::plain());
        guide(&[DVec3::ZERO], &none, spec, Seed::new(3), &run, &mut Report::default()).expect("sound")
    };
    let mut grown = Vec::new();
    for count in 0..=changes.len() {
        let (record, tree) = by_hand(10, &changes[..count]);
        assert_eq!((record.rounds, record.changes.len()), (10, count));
        let text = serde_json::to_string(&record).expect("written");
        assert_eq!(serde_json::from_str::<GuidedSpec>(&text).expect("read"), record);
        assert_eq!(again(&record), tree);
        assert!(!grown.contains(&tree), "each change shows: {count}");
        grown.push(tree);
    }
    // A record made before the end contains none of the later changes.
    let spec = GuidedSpec { rounds: 10, changes: changes.to_vec(), ..GuidedSpec::default() };
    let (none, run) = (Obstacles::none(), Run::plain());
    let mut growing = Growing::plant(&[DVec3::ZERO], &none, &spec, Seed::new(3), &run).expect("sound");
    for _ in 0..4 {
        growing.step(&run).expect("sound");
    }
    assert_eq!(growing.record(), by_hand(4, &changes).0);
    // An earlier change by the user replaces a later one of the spec.
    let turned = GuidedChange { alpha: Some(1.0), ..GuidedChange::default() };
    growing.change(turned, &run).expect("sound");
    while growing.rounds() < 10 {
        growing.step(&run).expect("sound");
    }
    let record = growing.record();
    assert_eq!(record.changes.iter().map(|c| c.round).collect::<Vec<_>>(), [2, 4]);
    assert_eq!(again(&record), growing.finish());
}

#[test]
fn a_change_that_is_wrong_changes_nothing() {
    let (none, run) = (Obstacles::none(), Run::plain());
    let spec = GuidedSpec::default();
    let mut growing = Growing::plant(&[DVec3::ZERO], &none, &spec, Seed::new(3), &run).expect("sound");
    growing.step(&run).expect("sound");
    let bad_stroke = BrushStroke { points: vec![DVec3::NAN; 2], radius_m: vec![0.6], pull: 1.0 };
    for bad in [
        GuidedChange { alpha: Some(-1.0), ..GuidedChange::default() },
        GuidedChange { markers: Some(0), ..GuidedChange::default() },
        GuidedChange { strokes: Some(vec![bad_stroke]), ..GuidedChange::default() },
    ] {
        assert!(growing.change(bad.clone(), &run).is_err());
        let spec = GuidedSpec { changes: vec![GuidedChange { round: 1, ..bad }], ..GuidedSpec::default() };
        assert!(Growing::plant(&[DVec3::ZERO], &none, &spec, Seed::new(3), &run).is_err());
    }
    assert_eq!(growing.record(), GuidedSpec { rounds: 1, ..spec });
    let back = |round| GuidedChange { round, ..GuidedChange::default() };
    let spec = GuidedSpec { changes: vec![back(3), back(1)], ..GuidedSpec::default() };
    assert!(Growing::plant(&[DVec3::ZERO], &none, &spec, Seed::new(3), &run).is_err());
}
