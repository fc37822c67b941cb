//! Every edit on plants of every maker: sound, deterministic, and reported truthfully.

use base::{Budget, Counted, Executor, NoClock, OverBudget, Report, Run, Seed, Stopped};
use glam::{DVec2, DVec3};
use growth::{
    CompetitionSpec, FoliageSpec, GuidedChange, GuidedSpec, Method, OAK_RULES, SelfOrganizingSpec, TreeSpec,
    grow,
};
use plant::{AxisId, AxisKind, NodeId, OrganKind, Plant};
use proptest::prelude::*;
use shape::{
    Applied, AxisKey, Context, Destination, GrowFrom, HandEdit, LeafRegion, Mirror, Outcome, Turn, ViewPlane,
    Why, apply,
};

fn method(kind: usize) -> Method {
    match kind {
        0 => Method::Competition(CompetitionSpec { points: 260, ..CompetitionSpec::default() }),
        1 => Method::SelfOrganizing(SelfOrganizingSpec { years: 11, ..SelfOrganizingSpec::default() }),
        2 => Method::Guided(GuidedSpec { rounds: 7, ..GuidedSpec::default() }),
        _ => Method::Lsystem { rules: OAK_RULES.into(), most_modules: 200_000 },
    }
}

fn tree(kind: usize, seed: u64) -> Plant {
    let leaves = FoliageSpec { spacing_m: 0.15, ..FoliageSpec::default() };
    let age = (kind == 3).then_some(6);
    let spec = TreeSpec { method: method(kind), leaves, age, ..TreeSpec::default() };
    grow(&spec, None, Seed::new(seed), &Run::plain(), &mut Report::default()).expect("sound").plant
}

/// Returns a tree and a flower drawn with pens.
fn drawn(kind: usize, seed: u64) -> Plant {
    let line = |points: &[(f64, f64)]| -> Vec<DVec2> {
        let points: Vec<DVec2> = points.iter().map(|&(x, y)| DVec2::new(x, y)).collect();
        geom::resample(&points, 2.0)
    };
    let strokes = if kind == 0 {
        vec![
            line(&[(0.0, 0.0), (2.0, 100.0), (-3.0, 200.0)]),
            line(&[(1.0, 60.0), (50.0, 120.0), (70.0, 180.0)]),
            line(&[(0.0, 90.0), (-50.0, 130.0), (-80.0, 190.0)]),
            line(&[(50.0, 120.0), (90.0, 130.0)]),
        ]
    } else {
        let ring = |k: f64| -> Vec<DVec2> {
            let (s, c) = base::ops::sin_cos(k * base::ops::TAU / 6.0);
            let (out, side) = (DVec2::new(c, s), DVec2::new(-s, c));
            let centre = DVec2::new(0.0, 150.0);
            let at = |u: f64, v: f64| centre + out * u + side * v;
            geom::resample(&[at(2.0, 0.0), at(20.0, 10.0), at(40.0, 0.0), at(20.0, -10.0), at(2.0, 0.0)], 2.0)
        };
        let mut all: Vec<Vec<DVec2>> = (0..6).map(|k| ring(f64::from(k))).collect();
        all.push(line(&[(0.0, 0.0), (3.0, 70.0), (0.0, 148.0)]));
        all.push(line(&[(2.0, 60.0), (30.0, 90.0), (50.0, 95.0), (28.0, 75.0), (2.0, 60.0)]));
        all
    };
    let drawing = ink::Drawing::from_polylines("drawn", &strokes);
    let mut report = Report::default();
    let ink = ink::clean(&drawing, &mut report);
    let classes = ink::classify(&ink, &Run::plain());
    let reading = reading::read(&ink, &classes, &mut report);
    let spec = sketch::SketchSpec::default();
    sketch::build(&reading, &spec, Seed::new(seed), &Run::plain(), &mut report).expect("not cancelled").plant
}

fn plant_of(kind: usize, seed: u64) -> Plant {
    if kind < 4 { tree(kind, seed) } else { drawn(kind - 4, seed) }
}

fn done(plant: &Plant, edits: &[HandEdit]) -> Applied {
    let applied = apply(plant, edits, &Context::default(), &Run::plain()).expect("not cancelled");
    assert_eq!(applied.outcomes.len(), edits.len(), "one outcome for each edit");
    assert_eq!(applied.plant.validate().next(), None, "{edits:?}");
    applied
}

struct Backwards;
impl Executor for Backwards {
    fn for_each(&self, n: usize, job: &(dyn Fn(usize) + Sync)) {
        std::thread::scope(|s| {
            for k in 0..2 {
                s.spawn(move || (0..n).rev().filter(|i| i % 2 == k).for_each(job));
            }
        });
    }
}

fn key() -> impl Strategy<Value = AxisKey> {
    prop_oneof![
        prop::collection::vec(0_u32..5, 1..4).prop_map(AxisKey::Path),
        point().prop_map(AxisKey::Near),
        Just(AxisKey::Near(DVec3::new(0.0, 3.0, 0.0))),
    ]
}

fn point() -> impl Strategy<Value = DVec3> {
    prop_oneof![
        12 => (-2.0..2.0, -0.5..7.0, -2.0..2.0).prop_map(|(x, y, z)| DVec3::new(x, y, z)),
        1 => Just(DVec3::NAN),
        1 => Just(DVec3::ZERO),
    ]
}

fn line() -> impl Strategy<Value = Vec<DVec3>> {
    prop::collection::vec(point(), 0..6)
}

fn mirror() -> impl Strategy<Value = Option<Mirror>> {
    proptest::option::of((point(), point()).prop_map(|(point, normal)| Mirror { point, normal }))
}

fn edit() -> impl Strategy<Value = HandEdit> {
    let number = prop_oneof![8 => -1.0..6.0, 1 => Just(f64::NAN), 1 => Just(0.0), 1 => Just(1.0)];
    let turn = (point(), -400.0..400.0).prop_map(|(about, degrees)| Turn { about, degrees });
    let to = prop_oneof![
        (-3.0..3.0).prop_map(Destination::SlideM),
        (key(), number.clone()).prop_map(|(axis, at)| Destination::Place { axis, at }),
        point().prop_map(Destination::ByM),
    ];
    let region = prop_oneof![
        Just(LeafRegion::All),
        key().prop_map(LeafRegion::Branch),
        (line(), number.clone()).prop_map(|(points, radius_m)| LeafRegion::Stroke { points, radius_m }),
    ];
    let outline = prop::collection::vec((-3.0..3.0, 0.0..8.0).prop_map(|(x, y)| DVec2::new(x, y)), 0..7);
    prop_oneof![
        (key(), turn).prop_map(|(axis, turn)| HandEdit::Rotate { axis, turn }),
        (key(), to.clone(), prop::option::of((point(), -400.0..400.0_f64))).prop_map(|(axis, to, turn)| {
            let turn = turn.map(|(about, degrees)| Turn { about, degrees });
            HandEdit::Move { axis, to, turn }
        }),
        (key(), to).prop_map(|(axis, to)| HandEdit::Copy { axis, to }),
        (key(), number.clone()).prop_map(|(axis, at)| HandEdit::Prune { axis, at }),
        (key(), 0_u64..9).prop_map(|(axis, seed)| HandEdit::Regrow { axis, seed }),
        (key(), line(), number.clone(), mirror()).prop_map(|(bearer, points, twigs, mirror)| {
            HandEdit::SketchBranch { bearer, at: None, points, twigs, seed: 1, mirror }
        }),
        (line(), 0.05..0.8, mirror()).prop_map(|(points, r, mirror)| HandEdit::Brush {
            bearer: None,
            points,
            radius_m: vec![r],
            density: 1.0,
            seed: 1,
            mirror
        }),
        (key(), number.clone(), proptest::option::of(point()), 0_u32..12, mirror()).prop_map(
            |(axis, at, towards, rounds, mirror)| HandEdit::Grow {
                from: GrowFrom::Branch { axis, at },
                towards,
                rounds,
                changes: vec![GuidedChange { round: 2, alpha: Some(at), ..GuidedChange::default() }],
                seed: 1,
                mirror,
            }
        ),
        (point(), mirror()).prop_map(|(foot, mirror)| HandEdit::Grow {
            from: GrowFrom::Ground(foot),
            towards: None,
            rounds: 6,
            changes: Vec::new(),
            seed: 1,
            mirror
        }),
        (outline, any::<bool>(), mirror()).prop_map(|(outline, trim, mirror)| HandEdit::Silhouette {
            plane: ViewPlane::default(),
            outline,
            density: 0.5,
            trim,
            seed: 1,
            mirror
        }),
        (region, number).prop_map(|(region, keep)| HandEdit::LeafDensity { region, keep, seed: 1 }),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_edits_of_any_plant_leave_it_sound(kind in 0_usize..6, seed in 0_u64..4, edits in prop::collection::vec(edit(), 1..5)) {
        let plant = plant_of(kind, seed);
        prop_assert_eq!(plant.validate().next(), None);
        let one = done(&plant, &edits);
        // Edits one after another give the same as all at once, and threads do not matter.
        let run = Run { executor: &Backwards, clock: &NoClock, ..Run::plain() };
        let other = apply(&plant, &edits, &Context::default(), &run).expect("not cancelled");
        prop_assert_eq!(one.plant.digest_hex(), other.plant.digest_hex());
        let mut step = plant.clone();
        for (edit, outcome) in edits.iter().zip(&one.outcomes) {
            let before = step.digest_hex();
            let single = done(&step, std::slice::from_ref(edit));
            if let Outcome::NotDone(why) = outcome {
                prop_assert!(single.plant.digest_hex() == before && !why.to_string().is_empty());
            }
            step = single.plant;
        }
        for axis in (0..plant.axes.len()).step_by(7).map(AxisId::new) {
            let key = AxisKey::for_axis(&plant, axis).expect("there");
            prop_assert_eq!(key.find(&plant).map(|f| (plant.axis(f.axis).key, f.by_likeness)), Ok((plant.axis(axis).key, false)));
        }
    }
}

fn path(p: &[u32]) -> AxisKey {
    AxisKey::Path(p.to_vec())
}

#[test]
fn no_edit_is_the_identity_and_a_turn_back_undoes_a_turn() {
    for kind in 0..6 {
        let plant = plant_of(kind, 1);
        assert_eq!(done(&plant, &[]).plant.digest_hex(), plant.digest_hex());
        let keep = HandEdit::LeafDensity { region: LeafRegion::All, keep: 1.0, seed: 0 };
        if plant.organs.iter().any(|o| o.kind == OrganKind::Leaf) {
            assert_eq!(done(&plant, &[keep]).plant.digest_hex(), plant.digest_hex(), "{kind}");
        }
        let turn = |degrees| HandEdit::Rotate { axis: path(&[0]), turn: Turn { about: DVec3::Z, degrees } };
        let there = done(&plant, &[turn(70.0)]).plant;
        assert_ne!(there, plant);
        let back = done(&plant, &[turn(70.0), turn(-70.0)]).plant;
        let apart = |a: &Plant, b: &Plant| {
            let pairs = a.nodes.position.iter().zip(&b.nodes.position);
            pairs.map(|(p, q)| p.distance(*q)).fold(0.0, f64::max)
        };
        assert!(apart(&back, &plant) < 1e-9 && apart(&there, &plant) > 0.01, "{kind}");
    }
}

#[test]
fn pruning_thins_what_bore_the_branch_and_nothing_else() {
    let plant = tree(0, 1);
    let limb = path(&[0, 3]).find(&plant).expect("there").axis;
    let bearer = plant.axis(limb).bearer.expect("borne").index();
    let cut = done(&plant, &[HandEdit::Prune { axis: path(&[0, 3]), at: 0.0 }]);
    let Outcome::Done(changed) = cut.outcomes[0] else { panic!("{}", cut.outcomes[0]) };
    assert!(changed.removed >= 1 && changed.leaves_removed > 0, "{}", cut.outcomes[0]);
    let trunk = plant.axis_radii(AxisId::new(0));
    let after = cut.plant.axis_radii(AxisId::new(0));
    assert_eq!(trunk.len(), after.len());
    assert!(after[0] < trunk[0] && after[bearer + 1..] == trunk[bearer + 1..]);
    assert!(after.windows(2).all(|w| w[1] <= w[0] + 1e-12), "falling");
    let gone = cut.plant.axes.iter().filter(|a| plant.axes.iter().any(|b| b.key == a.key)).count();
    assert_eq!(gone + changed.removed, plant.axes.len(), "no other branch is touched");
    // A stump keeps its wood.
    let half = done(&plant, &[HandEdit::Prune { axis: path(&[0, 3]), at: 0.5 }]);
    assert_eq!(half.plant.axis_radii(AxisId::new(0)), trunk);
    let whole = done(&plant, &[HandEdit::Prune { axis: path(&[0]), at: 0.0 }]);
    assert_eq!(whole.outcomes[0], Outcome::NotDone(Why::NothingLeft));
}

#[test]
fn a_moved_branch_takes_its_children_and_its_pipes_along() {
    let plant = tree(0, 1);
    let limb = path(&[0, 2]).find(&plant).expect("there").axis;
    let key = plant.axis(limb).key;
    let moved =
        done(&plant, &[HandEdit::Move { axis: path(&[0, 2]), to: Destination::SlideM(0.6), turn: None }]);
    let now = moved.plant.axes.iter().position(|a| a.key == key).map(AxisId::new).expect("there");
    let up = moved.plant.axis_points(now)[0].y - plant.axis_points(limb)[0].y;
    assert!(up > 0.3 && up < 0.7, "{up}");
    let length = |p: &Plant, a| geom::polyline_length3(p.axis_points(a));
    assert!((length(&plant, limb) - length(&moved.plant, now)).abs() < 1e-9);
    assert_eq!(plant.organs.len(), moved.plant.organs.len());
    let to = Destination::Place { axis: path(&[0, 2]), at: 0.5 };
    let own = HandEdit::Move { axis: path(&[0]), to, turn: None };
    assert_eq!(done(&plant, &[own]).outcomes[0], Outcome::NotDone(Why::OntoItself));
}

#[test]
fn regrowing_one_branch_leaves_the_rest() {
    for kind in [0, 1, 3] {
        let plant = tree(kind, 1);
        let again = |seed| done(&plant, &[HandEdit::Regrow { axis: path(&[0, 2]), seed }]);
        let (a, b) = (again(1), again(2));
        let Outcome::Done(changed) = a.outcomes[0] else { panic!("{kind}: {}", a.outcomes[0]) };
        assert!(changed.added > 0 && changed.removed > 0, "{kind}: {}", a.outcomes[0]);
        assert_ne!(a.plant.digest_hex(), b.plant.digest_hex());
        let limb = path(&[0, 2]).find(&plant).expect("there").axis;
        let mut gone = vec![false; plant.axes.len()];
        gone[limb.index()] = true;
        for i in 0..plant.axes.len() {
            let bearer = plant.axes[i].bearer.map(|n| plant.nodes.axis[n.index()].index());
            gone[i] |= bearer.is_some_and(|b| gone[b]);
        }
        for (i, axis) in plant.axes.iter().enumerate().filter(|(i, _)| !gone[*i]) {
            let same = a.plant.axes.iter().position(|b| b.key == axis.key).map(AxisId::new).expect("kept");
            assert_eq!(a.plant.axis_points(same), plant.axis_points(AxisId::new(i)));
        }
        // The base is where it was, and the key is the same.
        let now = path(&[0, 2]).find(&a.plant).expect("there").axis;
        assert_eq!(a.plant.axis(now).key, plant.axis(limb).key);
    }
}

#[test]
fn sketched_and_brushed_branches_grow_with_twigs_and_leaves() {
    let plant = tree(0, 1);
    let line: Vec<DVec3> =
        (0..12).map(|i| DVec3::new(0.2 * f64::from(i), 2.0 + 0.1 * f64::from(i), 0.0)).collect();
    let draw = |twigs| HandEdit::SketchBranch {
        bearer: path(&[0]),
        at: None,
        points: line.clone(),
        twigs,
        seed: 1,
        mirror: None,
    };
    let (bare, twigged) = (done(&plant, &[draw(0.0)]), done(&plant, &[draw(1.0)]));
    let added = |a: &Applied| match a.outcomes[0] {
        Outcome::Done(c) => (c.added, c.leaves_added),
        Outcome::NotDone(why) => panic!("{why}"),
    };
    assert_eq!(added(&bare).0, 1);
    assert!(added(&twigged).0 > 6 && added(&twigged).1 > added(&bare).1, "{:?}", added(&twigged));
    let foot = |a: &Applied| a.plant.nodes.radius_m[0];
    assert!(foot(&twigged) > foot(&bare) && foot(&bare) > plant.nodes.radius_m[0]);
    let brush = HandEdit::Brush {
        bearer: None,
        points: line,
        radius_m: vec![0.35],
        density: 1.0,
        seed: 1,
        mirror: None,
    };
    let brushed = done(&plant, &[brush]);
    assert!(added(&brushed).0 > 4 && added(&brushed).1 > 10, "{:?}", added(&brushed));
    let reach =
        brushed.plant.nodes.position[plant.nodes.position.len()..].iter().map(|p| p.x).fold(0.0, f64::max);
    assert!(reach > 1.6, "{reach}");
}

#[test]
fn a_branch_that_leaves_a_silhouette_and_comes_back_is_cut_where_it_leaves() {
    let mut plant = Plant::default();
    let line = |points: &[(f64, f64)]| points.iter().map(|p| DVec3::new(p.0, p.1, 0.0)).collect::<Vec<_>>();
    let branch = AxisKind::Branch;
    let trunk = plant.add_axis(
        branch,
        None,
        1,
        &line(&[(0.0, 0.0), (0.0, 1.0), (0.0, 3.0), (0.0, 5.0), (0.0, 6.0)]),
        None,
    );
    let at = |plant: &Plant, node: u32| Some(NodeId::new((plant.axis(trunk).nodes.start + node) as usize));
    // To the right and back; a line that starts below and rises into it.
    let bearer = at(&plant, 2);
    let back = line(&[(0.0, 3.0), (1.5, 3.4), (4.0, 3.8), (4.2, 4.6), (1.2, 5.0), (0.5, 5.2)]);
    plant.add_axis(branch, bearer, 2, &back, None);
    let bearer = at(&plant, 1);
    plant.add_axis(branch, bearer, 3, &line(&[(0.0, 1.0), (-1.0, 1.4), (-1.4, 2.6), (-1.4, 4.0)]), None);
    plant.nodes.radius_m = plant.nodes.axis.iter().map(|a| if *a == trunk { 0.1 } else { 0.03 }).collect();
    let outline = [(-2.0, 2.0), (2.0, 2.0), (2.0, 6.5), (-2.0, 6.5)].map(DVec2::from).to_vec();
    let plane = ViewPlane::default();
    let fill = HandEdit::Silhouette { plane, outline, density: 1.0, trim: true, seed: 3, mirror: None };
    let filled = done(&plant, &[fill]);
    assert!(filled.outcomes[0].is_done(), "{}", filled.outcomes[0]);
    let nodes = &filled.plant.nodes.position;
    let far = nodes.iter().map(|p| p.x.abs()).fold(0.0, f64::max);
    assert!(far < 2.3, "wood {far} m from the middle");
    assert!(nodes.iter().any(|p| p.distance(DVec3::new(-1.0, 1.4, 0.0)) < 1e-9), "what rises into it stays");
}

#[test]
fn a_silhouette_is_filled_and_what_leaves_it_is_cut() {
    let outline: Vec<DVec2> =
        [(-1.0, 2.0), (1.0, 2.0), (2.2, 4.0), (0.0, 6.5), (-2.2, 4.0)].map(DVec2::from).to_vec();
    for kind in [0, 3, 4] {
        let plant = plant_of(kind, 1);
        let fill = HandEdit::Silhouette {
            plane: ViewPlane::default(),
            outline: outline.clone(),
            density: 1.0,
            trim: true,
            seed: 3,
            mirror: None,
        };
        let filled = done(&plant, &[fill]);
        assert!(filled.outcomes[0].is_done(), "{kind}: {}", filled.outcomes[0]);
        let p = &filled.plant;
        let mut grown = outline.clone();
        grown.push(outline[0]);
        let off = |q: DVec2| {
            if geom::contains(&outline, q) {
                0.0
            } else {
                geom::closest_on_polyline(&grown, q).map_or(9.0, |c| c.distance)
            }
        };
        let crown = p.nodes.position.iter().filter(|q| q.y > 2.3).map(|q| off(q.truncate()));
        assert!(crown.fold(0.0, f64::max) < 0.45, "{kind}: nothing stands out");
        // Cells of the outline that wood passes through.
        let hit = |x: f64, y: f64| {
            p.nodes.position.iter().any(|q| (q.x - x).abs() < 0.35 && (q.y - y).abs() < 0.35)
        };
        let cells: Vec<(f64, f64)> = (0..100)
            .map(|i| (-2.2 + 0.44 * f64::from(i % 10), 2.0 + 0.45 * f64::from(i / 10)))
            .filter(|c| geom::contains(&outline, DVec2::from(*c)))
            .collect();
        let full = cells.iter().filter(|c| hit(c.0, c.1)).count();
        assert!(full * 10 >= cells.len() * 8, "{kind}: {full} of {}", cells.len());
    }
}

#[test]
fn fewer_leaves_are_a_part_of_more() {
    let plant = tree(0, 1);
    let count = |p: &Plant| p.organs.iter().filter(|o| o.kind == OrganKind::Leaf).count();
    let with = |keep| done(&plant, &[HandEdit::LeafDensity { region: LeafRegion::All, keep, seed: 1 }]).plant;
    let (all, half, few, twice) = (count(&plant), with(0.5), with(0.2), with(2.0));
    let near = |n: usize, share: f64| (n as f64 / all as f64 - share).abs() < 0.06;
    assert!(near(count(&half), 0.5) && near(count(&few), 0.2) && count(&twice) == 2 * all);
    let keys: std::collections::BTreeSet<u64> = half.organs.iter().map(|o| o.key).collect();
    assert!(few.organs.iter().all(|o| keys.contains(&o.key)));
    let nowhere = LeafRegion::Stroke { points: vec![DVec3::splat(50.0)], radius_m: 1.0 };
    let none = done(&plant, &[HandEdit::LeafDensity { region: nowhere, keep: 0.0, seed: 1 }]);
    assert_eq!(none.outcomes[0], Outcome::NotDone(Why::NoLeaves));
}

#[test]
fn marks_survive_other_edits_and_drawn_branches_a_change_of_seed() {
    let plant = drawn(0, 1);
    let other = drawn(0, 9);
    for axis in (0..plant.axes.len()).map(AxisId::new).filter(|a| plant.axis(*a).source.is_some()) {
        let key = AxisKey::for_axis(&plant, axis).expect("there");
        let found = key.find(&other).expect("a drawn branch is there for every seed");
        assert_eq!(other.axis(found.axis).source, plant.axis(axis).source);
    }
    let tree = tree(0, 1);
    let axis = path(&[0, 4]).find(&tree).expect("there").axis;
    let key = AxisKey::for_axis(&tree, axis).expect("there");
    let cut = done(&tree, &[HandEdit::Prune { axis: path(&[0, 1]), at: 0.0 }]).plant;
    assert_eq!(key.find(&cut).map(|f| cut.axis(f.axis).key), Ok(tree.axis(axis).key));
    let gone = done(
        &tree,
        &[HandEdit::Prune { axis: key.clone(), at: 0.0 }, HandEdit::Prune { axis: key, at: 0.0 }],
    );
    // Either nothing is like it, or a similar branch is found: never a fault.
    assert!(gone.outcomes[0].is_done());
}

#[test]
fn edits_are_read_back_from_their_file_form() {
    let text = include_str!("../../../burgeon/src/edits-template.json");
    let file: shape::EditsFile = serde_json::from_str(text).expect("the template is an edits file");
    assert!(file.edits.len() == 11 && file.schema == shape::EDITS_SCHEMA);
    let again = serde_json::to_string(&file).expect("plain data");
    assert_eq!(serde_json::from_str::<shape::EditsFile>(&again).ok(), Some(file));
    assert!(
        serde_json::from_str::<HandEdit>(r#"{"op": "prune", "axis": {"path": [0]}, "sort": 1}"#).is_err()
    );
}

#[test]
fn what_is_filled_or_brushed_leaves_the_trunk_as_thick_as_it_was() {
    // Many times the previous wood: by the pipe model alone the trunk would be twice as thick.
    let wide = [(-3.0, 1.5), (3.0, 1.5), (4.0, 4.5), (0.0, 8.0), (-4.0, 4.5)].map(DVec2::from).to_vec();
    for kind in [0, 3] {
        let plant = tree(kind, 1);
        for trim in [false, true] {
            let fill = HandEdit::Silhouette {
                plane: ViewPlane::default(),
                outline: wide.clone(),
                density: 3.0,
                trim,
                seed: 1,
                mirror: None,
            };
            let filled = done(&plant, &[fill]);
            let Outcome::Done(changed) = filled.outcomes[0] else { panic!("{}", filled.outcomes[0]) };
            assert!(changed.added > 30, "{kind}: {}", filled.outcomes[0]);
            let (before, after) = (plant.nodes.radius_m[0], filled.plant.nodes.radius_m[0]);
            let tip = plant.nodes.radius_m.iter().copied().fold(f64::INFINITY, f64::min);
            assert!(after <= 1.1 * before + 4.0 * tip && after > 0.8 * before, "{kind}: {before} to {after}");
            for (i, axis) in filled.plant.axes.iter().enumerate() {
                let radii = filled.plant.axis_radii(AxisId::new(i));
                let on = axis.bearer.map_or(f64::INFINITY, |n| filled.plant.nodes.radius_m[n.index()]);
                assert!(radii[0] <= on + 1e-9, "{kind}: axis {i} of {} m on {on} m", radii[0]);
            }
        }
    }
}

#[test]
fn a_brush_that_begins_in_the_bark_begins_at_the_surface() {
    let mut plant = tree(0, 1);
    // A trunk as thick as an old one's.
    let trunk: Vec<usize> = plant.axes[0].nodes.clone().map(|n| n as usize).collect();
    trunk.iter().for_each(|&n| plant.nodes.radius_m[n] = plant.nodes.radius_m[n].max(0.25));
    let start = plant.nodes.position[trunk[trunk.len() / 3]];
    // Up inside the trunk for a while, then out of it.
    let inside = (0..6).map(|i| start + DVec3::new(0.02 * f64::from(i), 0.05 * f64::from(i), 0.0));
    let outside =
        (1..12).map(|i| start + DVec3::new(0.1 + 0.18 * f64::from(i), 0.25 + 0.1 * f64::from(i), 0.0));
    let points: Vec<DVec3> = inside.chain(outside).collect();
    let brush = |points| HandEdit::Brush {
        bearer: None,
        points,
        radius_m: vec![0.35],
        density: 1.0,
        seed: 1,
        mirror: None,
    };
    let brushed = done(&plant, &[brush(points.clone())]);
    let old = plant.axes.len();
    let [.., grown] = [&plant, &brushed.plant];
    assert!(grown.axes.len() > old + 4, "{}", brushed.outcomes[0]);
    let on_trunk = |axis: &plant::Axis| axis.bearer.is_some_and(|n| grown.nodes.axis[n.index()].index() == 0);
    let axis_of_trunk = grown.axis_points(AxisId::new(0));
    let depth = |p: DVec3| {
        axis_of_trunk
            .windows(2)
            .map(|w| {
                let d = w[1] - w[0];
                p.distance(w[0] + d * ((p - w[0]).dot(d) / d.length_squared()).clamp(0.0, 1.0))
            })
            .fold(f64::INFINITY, f64::min)
    };
    // The branches of the new ones start outside the trunk.
    for axis in grown.axes.iter().filter(|a| !plant.axes.iter().any(|b| b.key == a.key) && !on_trunk(a)) {
        let base = axis.bearer.map(|n| grown.nodes.position[n.index()]).expect("borne");
        assert!(depth(base) > 0.2, "a branch starts {} m from the middle of a trunk of 0.25 m", depth(base));
    }
    // A stroke that never comes out grows nothing.
    let hidden = brush(points[..6].to_vec());
    assert_eq!(done(&plant, &[hidden]).outcomes[0], Outcome::NotDone(Why::NothingGrew));
}

#[test]
fn a_copy_is_the_branch_again_with_all_that_it_bears() {
    for kind in 0..6 {
        let plant = plant_of(kind, 3);
        let paths = AxisKey::paths(&plant);
        // A flower has only a stem: it is copied over the ground.
        let limb = paths.iter().find(|(_, p)| p.len() == 2);
        let (limb, path_of) = limb.unwrap_or(&paths[0]);
        assert!(kind == 5 || path_of.len() == 2, "a limb on plant {kind}");
        let to = match path_of.len() {
            1 => Destination::ByM(DVec3::X),
            _ => Destination::Place { axis: path(&[0]), at: 0.85 },
        };
        let copy = HandEdit::Copy { axis: AxisKey::Path(path_of.clone()), to };
        let a = done(&plant, core::slice::from_ref(&copy));
        assert!(a.outcomes[0].is_done(), "plant {kind}: {}", a.outcomes[0]);
        let inside = plant.borne_by(*limb);
        let borne = inside.iter().filter(|i| **i).count();
        assert_eq!(a.plant.axes.len(), plant.axes.len() + borne, "plant {kind}");
        let count = |p: &Plant| p.organs.len() + p.flowers.len();
        let on = |n: &Option<NodeId>| n.is_some_and(|n| inside[plant.nodes.axis[n.index()].index()]);
        let organs = plant.organs.iter().filter(|o| on(&o.bearer)).count();
        let flowers = plant.flowers.iter().filter(|f| on(&f.bearer)).count();
        assert!(
            (organs > 0) == (kind != 4) && (flowers > 0) == (kind == 5),
            "plant {kind}: {organs} {flowers}"
        );
        assert_eq!(count(&a.plant), count(&plant) + organs + flowers, "plant {kind}");
        // All keys are new, and the copy is as long and as crooked as the branch.
        let mut keys: Vec<u64> = a.plant.axes.iter().map(|x| x.key).collect();
        keys.sort_unstable();
        let before = plant.axes.len() - {
            let mut old: Vec<u64> = plant.axes.iter().map(|x| x.key).collect();
            old.sort_unstable();
            old.dedup();
            old.len()
        };
        keys.dedup();
        assert!(a.plant.axes.len() - keys.len() <= 2 * before, "plant {kind}: new keys");
        let old = plant.axis_points(*limb);
        let chords = |line: &[DVec3]| -> Vec<f64> { line.iter().map(|p| p.distance(line[0])).collect() };
        let twin = a.plant.axes.iter().enumerate().skip(1).find(|&(i, x)| {
            let line = a.plant.axis_points(AxisId::new(i));
            !plant.axes.iter().any(|y| y.key == x.key)
                && line.len() == old.len()
                && chords(line).iter().zip(chords(old)).all(|(a, b)| (a - b).abs() < 1e-9 * (1.0 + b))
        });
        assert!(twin.is_some(), "plant {kind}: a branch of the same form");
        // Parts that are not below the copy have not moved by a bit.
        let leaf = |p: &Plant| p.organs.iter().take(5).map(|o| o.frame).collect::<Vec<_>>();
        assert_eq!(leaf(&a.plant), leaf(&plant), "plant {kind}");
        // The same copy twice: two branches with keys of their own.
        let twice = done(&plant, &[copy.clone(), copy]);
        assert_eq!(twice.plant.axes.len(), plant.axes.len() + 2 * borne, "plant {kind}");
    }
}

/// Makes a stem of this many nodes, and an edit that copies it with all its copies onto itself.
fn doubling(nodes: i32) -> (Plant, HandEdit) {
    let mut plant = Plant::default();
    let line: Vec<DVec3> = (0..nodes).map(|i| DVec3::Y * (1e-4 * f64::from(i))).collect();
    plant.add_axis(AxisKind::Branch, None, 1, &line, None);
    (plant, HandEdit::Copy { axis: path(&[0]), to: Destination::Place { axis: path(&[0]), at: 1.0 } })
}

fn over_budget(plant: &Plant, edits: &[HandEdit], times: f64) -> Option<OverBudget> {
    let run = Run { budget: Budget { times, ..Budget::default() }, ..Run::plain() };
    match apply(plant, edits, &Context::default(), &run) {
        Ok(_) => None,
        Err(Stopped::OverBudget(much)) => Some(much),
        Err(Stopped::Cancelled(_)) => panic!("nobody cancelled"),
    }
}

#[test]
fn copies_of_copies_are_refused_before_they_are_made() {
    let (plant, double) = doubling(50_000);
    let four = vec![double.clone(); 4];
    assert_eq!(over_budget(&plant, &four, 1.0), None);
    let made = done(&plant, &four).plant.nodes.position.len();
    assert!((800_000..=1_000_000).contains(&made), "{made}");
    for (copies, times) in [(5, 1.0), (200, 1.0), (4, 0.25)] {
        let much = over_budget(&plant, &vec![double.clone(); copies], times).expect("too much");
        assert_eq!(much.what, Counted::Pieces);
        // The copy that would exceed the limit is not begun: the plant was within the limit, and doubles.
        assert!((much.limit + 1..=2 * much.limit + 16).contains(&much.number), "{much}");
        assert!(much.to_string().contains("copy fewer branches"), "{much}");
    }
}

#[test]
fn edits_of_a_large_plant_are_counted_by_what_they_go_through() {
    let (plant, _) = doubling(100_000);
    let none = HandEdit::Prune { axis: path(&[0, 7]), at: 0.0 };
    // A thousandth of the limit: 60,000 pieces.
    let much = over_budget(&plant, core::slice::from_ref(&none), 0.001).expect("too much");
    assert_eq!((much.what, much.number, much.limit), (Counted::EditedPieces, 100_000, 60_000));
    assert_eq!(over_budget(&plant, &vec![none.clone(); 3], 0.005), None);
    let much = over_budget(&plant, &vec![none; 4], 0.005).expect("edits that are not done take time, too");
    assert_eq!((much.what, much.number), (Counted::EditedPieces, 400_000));
}

/// Makes a trunk with a limb on either side of the plane x = 0, and leaves on them.
fn even() -> Plant {
    let tree = tree(0, 1);
    let mut p = Plant { shapes: tree.shapes.clone(), ..Plant::default() };
    let line =
        |a: DVec3, b: DVec3| -> Vec<DVec3> { (0..=8).map(|i| a.lerp(b, f64::from(i) / 8.0)).collect() };
    let trunk = p.add_axis(AxisKind::Branch, None, 1, &line(DVec3::ZERO, DVec3::Y * 4.0), None);
    for (key, side) in [(2, 1.0), (3, -1.0)] {
        let fork = p.axis(trunk).node_ids().nth(4);
        let tip = DVec3::new(2.0 * side, 2.6, 0.0);
        let limb = p.add_axis(AxisKind::Branch, fork, key, &line(DVec3::Y * 2.0, tip), None);
        for (k, node) in p.axis(limb).node_ids().enumerate().skip(2) {
            let leaf = tree.organs.iter().find(|o| o.kind == OrganKind::Leaf).expect("a leaf").clone();
            let origin = p.nodes.position[node.index()];
            let frame = plant::Frame::looking(origin, DVec3::new(side, 1.0, 0.2), DVec3::Y);
            p.organs.push(plant::Organ { bearer: Some(node), frame, key: 40 * key + k as u64, ..leaf });
        }
    }
    p.nodes.radius_m.iter_mut().for_each(|r| *r = 0.02);
    assert_eq!(p.validate().next(), None, "sound");
    p
}

#[test]
fn what_is_made_on_one_side_of_a_mirror_is_made_on_the_other() {
    let plant = even();
    let mirror = Some(Mirror { point: DVec3::ZERO, normal: DVec3::X * 3.0 });
    let points: Vec<DVec3> = (0..9)
        .map(|i| DVec3::new(1.0 + 0.08 * f64::from(i), 2.3 + 0.15 * f64::from(i), 0.05 * f64::from(i)))
        .collect();
    let right = path(&[0, 0]);
    let grow = |from| HandEdit::Grow { from, towards: None, rounds: 9, changes: Vec::new(), seed: 3, mirror };
    let edits = [
        HandEdit::SketchBranch {
            bearer: right.clone(),
            at: Some(0.5),
            points: points.clone(),
            twigs: 1.0,
            seed: 1,
            mirror,
        },
        HandEdit::Brush {
            bearer: Some(right.clone()),
            points,
            radius_m: vec![0.3],
            density: 1.0,
            seed: 1,
            mirror,
        },
        grow(GrowFrom::Branch { axis: right, at: 0.75 }),
        grow(GrowFrom::Ground(DVec3::new(1.5, 0.0, 0.5))),
    ];
    let image = |p: &DVec3| DVec3::new(-p.x, p.y, p.z);
    for edit in edits {
        let word = edit.word();
        let a = done(&plant, core::slice::from_ref(&edit));
        let Outcome::Done(c) = a.outcomes[0] else { panic!("{word}: {}", a.outcomes[0]) };
        assert_eq!(c.alone, 0, "{word}");
        assert!(c.added >= 4 && c.leaves_added > 8, "{word}: {c:?}");
        // Every node and every leaf has its image, to a nanometre.
        let has = |of: &[DVec3], p: DVec3| of.iter().any(|q| q.distance(p) < 1e-9);
        let nodes = &a.plant.nodes.position;
        let lone = nodes.iter().find(|p| !has(nodes, image(p)));
        assert_eq!(lone, None, "{word}");
        let leaves: Vec<DVec3> = a.plant.organs.iter().map(|o| o.frame.origin).collect();
        let tips: Vec<DVec3> = a.plant.organs.iter().map(|o| o.frame.origin + o.frame.along).collect();
        assert!(leaves.iter().all(|p| has(&leaves, image(p))), "{word}");
        assert!(tips.iter().all(|p| has(&tips, image(p))), "{word}");
        // One side alone is the same as without a mirror.
        let mut plain = edit;
        match &mut plain {
            HandEdit::SketchBranch { mirror, .. }
            | HandEdit::Brush { mirror, .. }
            | HandEdit::Grow { mirror, .. } => *mirror = None,
            _ => panic!("{word}"),
        }
        let one = done(&plant, &[plain]).plant;
        assert_eq!(2 * (one.axes.len() - plant.axes.len()), a.plant.axes.len() - plant.axes.len(), "{word}");
        assert!(one.nodes.position.iter().all(|p| nodes.contains(p)), "{word}");
    }
}

#[test]
fn an_outline_and_its_image_are_filled_at_once() {
    let right: Vec<DVec2> = [(0.6, 2.0), (2.4, 2.4), (2.2, 4.6), (0.6, 5.4)].map(DVec2::from).to_vec();
    let whole: Vec<DVec2> = [(-2.0, 2.0), (2.0, 2.0), (2.0, 5.5), (-2.0, 5.5)].map(DVec2::from).to_vec();
    let mirror = Some(Mirror { point: DVec3::ZERO, normal: DVec3::X });
    for kind in [0, 3, 4] {
        let plant = plant_of(kind, 1);
        let fill = |outline: &[DVec2], trim, mirror| {
            let (plane, outline) = (ViewPlane::default(), outline.to_vec());
            let edit = HandEdit::Silhouette { plane, outline, density: 1.0, trim, seed: 3, mirror };
            let filled = done(&plant, &[edit]);
            let Outcome::Done(changed) = filled.outcomes[0] else { panic!("{kind}: {}", filled.outcomes[0]) };
            (filled.plant, changed)
        };
        let inside = |p: &Plant, outline: &[DVec2], side: f64| {
            let seen = p.nodes.position.iter().map(|q| DVec2::new(q.x * side, q.y));
            seen.filter(|q| geom::contains(outline, *q)).count()
        };
        let (one, _) = fill(&right, false, None);
        let (both, told) = fill(&right, false, mirror);
        let new = |p, side| inside(p, &right, side).saturating_sub(inside(&plant, &right, side));
        assert!(new(&both, -1.0) > 30, "{kind}: {} on the other side", new(&both, -1.0));
        let sides = [inside(&both, &right, 1.0), inside(&both, &right, -1.0)];
        assert!(
            2 * sides[1] > sides[0] && 2 * sides[0] > sides[1],
            "{kind}: as full as the first: {sides:?}"
        );
        assert!(new(&one, -1.0) < 10 && told.alone == 0, "{kind}: {told:?}");
        // The parts cut are those within neither outline; a stem next to both stays.
        let (cut, _) = fill(&right, true, mirror);
        let borne = cut.nodes.position.iter().zip(&cut.nodes.axis);
        let borne = borne.filter(|(_, a)| cut.axis(**a).bearer.is_some()).map(|(q, _)| q);
        let crown: Vec<_> = borne.filter(|q| q.y > 2.3 && q.x.abs() > 0.6).collect();
        let out = crown.iter().find(|q| q.x.abs() > 2.9 || q.y > 5.9);
        assert_eq!(out, None, "{kind}: nothing stands out");
        assert!(crown.iter().any(|q| q.x > 1.2) && crown.iter().any(|q| q.x < -1.2), "{kind}: two halves");
        // An outline that is its own image is filled once.
        let (once, twice) = (fill(&whole, true, None).1, fill(&whole, true, mirror).1);
        assert!(twice.added < once.added * 3 / 2 + 10, "{kind}: {} and {}", twice.added, once.added);
    }
}

#[test]
fn a_mirror_says_what_has_no_other_side() {
    // Nothing on the left: a branch drawn far out on the right stays alone.
    let whole = even();
    let bare = done(&whole, &[HandEdit::Prune { axis: path(&[0, 1]), at: 0.0 }]).plant;
    let mirror = Some(Mirror { point: DVec3::ZERO, normal: DVec3::X });
    let points: Vec<DVec3> =
        (0..6).map(|i| DVec3::new(1.5, 2.5 + 0.1 * f64::from(i), 0.1 * f64::from(i))).collect();
    let draw =
        HandEdit::SketchBranch { bearer: path(&[0, 0]), at: Some(0.75), points, twigs: 0.0, seed: 1, mirror };
    let a = done(&bare, core::slice::from_ref(&draw));
    let Outcome::Done(c) = a.outcomes[0] else { panic!("{}", a.outcomes[0]) };
    assert_eq!((c.added, c.alone), (1, 1));
    assert!(a.outcomes[0].to_string().contains("1 branch on one side only"), "{}", a.outcomes[0]);
    // A wall on the left: the image ends in front of it.
    let at = DVec3::new(-1.5, 3.4, 0.0);
    let wall = growth::Obstacle::Box { min: at - DVec3::splat(0.6), max: at + DVec3::splat(0.6) };
    let obstacles = growth::Obstacles::new(&[wall], 0.0).expect("sound");
    let context = Context { obstacles: obstacles.clone(), ..Context::default() };
    let a = apply(&whole, &[draw], &context, &Run::plain()).expect("not cancelled");
    assert_eq!(a.plant.validate().next(), None);
    let new = &a.plant.nodes.position[whole.nodes.position.len()..];
    assert!(new.iter().any(|p| p.x < -1.0) && new.iter().all(|p| obstacles.free(*p)), "{new:?}");
    let length = |side: f64| {
        let lines = a.plant.axes.iter().enumerate().skip(3).map(|(i, _)| a.plant.axis_points(AxisId::new(i)));
        lines.filter(|l| l[1].x * side > 0.0).map(geom::polyline_length3).sum::<f64>()
    };
    assert!(length(-1.0) < 0.9 * length(1.0), "{} {}", length(-1.0), length(1.0));
    // A stem on the plane is its own image.
    let stem = HandEdit::Grow {
        from: GrowFrom::Ground(DVec3::new(0.0, 0.0, 1.0)),
        towards: None,
        rounds: 4,
        changes: Vec::new(),
        seed: 1,
        mirror,
    };
    let stems = |p: &Plant| p.axes.iter().filter(|a| a.bearer.is_none()).count();
    assert_eq!(stems(&done(&whole, &[stem]).plant), 2);
    let Some(bad) = mirror.map(|m| Mirror { normal: DVec3::ZERO, ..m }) else { panic!() };
    let refused = HandEdit::Grow {
        from: GrowFrom::Ground(DVec3::X),
        towards: None,
        rounds: 4,
        changes: Vec::new(),
        seed: 1,
        mirror: Some(bad),
    };
    assert_eq!(refused.check(), Err(Why::BadNumber { field: "mirror" }));
    assert_eq!(done(&whole, &[refused]).outcomes[0], Outcome::NotDone(Why::BadNumber { field: "mirror" }));
}
