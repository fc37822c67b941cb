//! Scripted gestures of a hand with each tool.

use std::sync::atomic::{AtomicUsize, Ordering};

use base::{Budget, Executor, Run};
use glam::{DQuat, DVec3};
use plant::{AxisId, AxisKind, Plant};
use shape::{
    AxisKey, Context, Destination, GrowFrom, Growth, HandEdit, Input, KeptGrowth, LeafRegion, Mirror,
    Pointer, Ray, Reach, Response, Shaping, Tool, ToolKind, ViewPlane, apply, pick,
};

/// Makes a trunk of 4 m with a limb to the right at 2 m, which bears one of its own.
fn tree() -> Plant {
    let mut p = Plant::default();
    let line =
        |a: DVec3, b: DVec3| -> Vec<DVec3> { (0..=8).map(|i| a.lerp(b, f64::from(i) / 8.0)).collect() };
    let trunk = p.add_axis(AxisKind::Branch, None, 1, &line(DVec3::ZERO, DVec3::Y * 4.0), None);
    let fork = p.axis(trunk).node_ids().nth(4);
    let limb = p.add_axis(AxisKind::Branch, fork, 2, &line(DVec3::Y * 2.0, DVec3::new(2.0, 2.0, 0.0)), None);
    let fork = p.axis(limb).node_ids().nth(4);
    p.add_axis(AxisKind::Branch, fork, 3, &line(DVec3::new(1.0, 2.0, 0.0), DVec3::new(1.0, 3.0, 0.0)), None);
    p.nodes.radius_m.iter_mut().for_each(|r| *r = 0.02);
    assert_eq!(p.validate().count(), 0, "a sound plant");
    p
}

/// Makes a mouse at (x, y) of the plane z = 0, seen from a camera at z = 10.
fn mouse(x: f64, y: f64) -> Pointer {
    let eye = DVec3::new(0.0, 2.0, 10.0);
    let ray = Ray { origin: eye, direction: DVec3::new(x, y, 0.0) - eye };
    Pointer { ray, forward: DVec3::NEG_Z, up: DVec3::Y, pressure: 1.0, tip: None, hand: None }
}

/// Makes a controller that points anywhere, with its tip at a place in space.
fn controller(tip: DVec3) -> Pointer {
    Pointer { tip: Some(tip), ..mouse(tip.x, tip.y) }
}

/// Presses at the first pointer, moves over the others and releases at the last.
fn drag(tool: &mut Tool, plant: &Plant, way: &[Pointer]) -> Response {
    let mut previews = 0;
    tool.handle(plant, &Input::Down(way[0]));
    for p in &way[1..] {
        let r = tool.handle(plant, &Input::Move(*p));
        assert!(r.commit.is_none(), "nothing is done before the end");
        previews += usize::from(r.preview.is_some());
    }
    let last = tool.handle(plant, &Input::Up(*way.last().expect("some")));
    assert!(last.preview.is_none() && !tool.is_busy(), "let go");
    assert!(last.commit.is_none() || previews > 0 || way.len() == 1, "what is done was shown");
    last
}

fn after(plant: &Plant, edit: HandEdit) -> Plant {
    let applied = apply(plant, &[edit], &Context::default(), &Run::plain()).expect("not cancelled");
    assert!(applied.outcomes[0].is_done(), "{}", applied.outcomes[0]);
    assert_eq!(applied.plant.validate().count(), 0, "a sound plant");
    applied.plant
}

#[test]
fn picking_takes_what_is_nearest_with_a_tolerance_that_grows() {
    let plant = tree();
    let at = |x, y| pick(&plant, &mouse(x, y).ray, Reach::default()).map(|k| k.axis.index());
    assert_eq!((at(0.0, 1.0), at(1.6, 2.0), at(1.0, 2.6), at(-2.0, 1.0)), (Some(0), Some(1), Some(2), None));
    // 0.15 m from the trunk: within a degree at 10 m, not at 3.
    let near = Ray { origin: DVec3::new(0.15, 1.0, 3.0), direction: DVec3::NEG_Z };
    let far = Ray { origin: DVec3::new(0.15, 1.0, 10.0), direction: DVec3::NEG_Z };
    let reach = Reach { metres: 0.0, per_metre: 0.02, bearers: 0 };
    assert!(pick(&plant, &near, reach).is_none() && pick(&plant, &far, reach).is_some());
    // Or its bearer: at the place of the branch, and no further than there are bearers.
    let up = |bearers| {
        let reach = Reach { bearers, ..Reach::default() };
        pick(&plant, &mouse(1.0, 2.6).ray, reach).map(|k| (k.axis.index(), k.at))
    };
    assert_eq!((up(1), up(2), up(u32::MAX)), (Some((1, 0.5)), Some((0, 0.5)), Some((0, 0.5))));
    let nothing = Ray { origin: DVec3::NAN, direction: DVec3::ZERO };
    assert!(pick(&plant, &nothing, reach).is_none());
}

#[test]
fn a_drag_around_the_base_rotates_by_its_angle() {
    let plant = tree();
    let way: Vec<Pointer> = (0..=9)
        .map(|i| {
            let (s, c) = base::ops::sin_cos(f64::from(i) * 10.0_f64.to_radians());
            mouse(1.6 * c, 2.0 + 1.6 * s)
        })
        .collect();
    let edit = drag(&mut Tool::new(ToolKind::Rotate), &plant, &way).commit.expect("rotated");
    let HandEdit::Rotate { turn, .. } = &edit else { panic!("{edit:?}") };
    assert!((turn.degrees - 90.0).abs() < 0.5 && turn.about == DVec3::Z, "{turn:?}");
    let turned = after(&plant, edit);
    let tip = *turned.axis_points(AxisId::new(1)).last().expect("some");
    assert!(tip.distance(DVec3::new(0.0, 4.0, 0.0)) < 0.05, "{tip}");
    // Two turns around the base add up instead of starting again.
    let way: Vec<Pointer> = (0..=72)
        .map(|i| {
            let (s, c) = base::ops::sin_cos(f64::from(i) * 10.0_f64.to_radians());
            mouse(1.6 * c, 2.0 + 1.6 * s)
        })
        .collect();
    let edit = drag(&mut Tool::new(ToolKind::Rotate), &plant, &way).commit;
    assert!(matches!(edit, Some(HandEdit::Rotate { turn, .. }) if (turn.degrees - 720.0).abs() < 1.0));
}

#[test]
fn a_thumbstick_rotates_exactly_and_a_slip_does_nothing() {
    let plant = tree();
    let mut tool = Tool::new(ToolKind::Rotate);
    tool.handle(&plant, &Input::Down(mouse(1.6, 2.0)));
    tool.handle(&plant, &Input::Twist(0.25));
    tool.handle(&plant, &Input::Twist(0.25));
    let edit = tool.handle(&plant, &Input::Up(mouse(1.6, 2.0))).commit;
    assert!(
        matches!(edit, Some(HandEdit::Rotate { turn, .. }) if (turn.degrees - 0.5_f64.to_degrees()).abs() < 1e-9)
    );
    let way = [mouse(1.6, 2.0), mouse(1.6, 2.001)];
    let mut tool = Tool::new(ToolKind::Rotate);
    tool.handle(&plant, &Input::Down(way[0]));
    assert_eq!(tool.handle(&plant, &Input::Up(way[1])).commit, None);
}

#[test]
fn a_branch_follows_a_controller_out_of_the_plane() {
    let plant = tree();
    let base = DVec3::Y * 2.0;
    let start = DVec3::new(1.6, 2.0, 0.0);
    let mut tool = Tool::new(ToolKind::Rotate);
    for to in [DVec3::new(0.0, 3.0, 1.0), DVec3::new(-1.6, 2.0, 0.0), DVec3::new(1.2, 2.3, -1.0)] {
        let way = [start, start.lerp(to, 0.5) + DVec3::Z * 0.1, to].map(controller);
        let edit = drag(&mut tool, &plant, &way).commit.expect("rotated");
        let end = *after(&plant, edit).axis_points(AxisId::new(1)).last().expect("some");
        let wanted = base + (to - base).normalize() * 2.0;
        assert!(end.distance(wanted) < 1e-6, "{to}: {end}, not {wanted}");
    }
    // A thumb turns it further about the view direction, by exactly this angle.
    tool.handle(&plant, &Input::Down(controller(start)));
    let up = DVec3::new(0.0, 2.0, 1.6);
    tool.handle(&plant, &Input::Move(controller(up)));
    tool.handle(&plant, &Input::Twist(90.0_f64.to_radians()));
    let edit = tool.handle(&plant, &Input::Up(controller(up))).commit.expect("rotated");
    let turned = after(&plant, edit);
    let end = *turned.axis_points(AxisId::new(1)).last().expect("some");
    assert!(end.distance(base + DVec3::Z * 2.0) < 1e-6, "the view direction: {end}");
    let twig = turned.axis_points(AxisId::new(2));
    let along = (twig[8] - twig[0]).normalize();
    assert!(along.distance(DVec3::NEG_X) < 1e-6, "upwards before, to the left now: {along}");
}

/// Makes a controller whose hand is turned by some degrees about an axis.
fn turned(tip: DVec3, about: DVec3, degrees: f64) -> Pointer {
    Pointer { hand: Some(base::turn::about(about, degrees.to_radians())), ..controller(tip) }
}

#[test]
fn a_hand_that_turns_rolls_the_branch_that_it_holds() {
    let plant = tree();
    let base = DVec3::Y * 2.0;
    let start = DVec3::new(1.6, 2.0, 0.0);
    let ends = |from: Pointer, to: Pointer| {
        let mut tool = Tool::new(ToolKind::Rotate);
        let edit = drag(&mut tool, &plant, &[from, to]).commit.expect("rotated");
        assert!(matches!(edit, HandEdit::Rotate { .. }), "{edit:?}");
        let after = after(&plant, edit);
        let twig = after.axis_points(AxisId::new(2));
        let limb = after.axis_points(AxisId::new(1));
        ((limb[8] - base) / 2.0, (twig[8] - twig[0]).normalize())
    };
    // In place: the twig that stood upright lies towards the viewer.
    let (limb, twig) = ends(turned(start, DVec3::X, 0.0), turned(start, DVec3::X, 90.0));
    assert!(limb.distance(DVec3::X) < 1e-9 && twig.distance(DVec3::Z) < 1e-9, "{limb} {twig}");
    // Position and orientation together, from a hand that was turned when it took hold.
    let up = DVec3::new(0.0, 3.6, 0.0);
    let was = base::turn::about(DVec3::new(0.6, 0.0, 0.8), 1.1);
    let by = base::turn::about(DVec3::Y, 0.5) * base::turn::about(DVec3::Z, 90.0_f64.to_radians());
    let posed = |tip, hand| Pointer { hand: Some(hand), ..controller(tip) };
    let (limb, twig) = ends(posed(start, was), posed(up, by * was));
    assert!(limb.distance(DVec3::Y) < 1e-9 && twig.distance(by * DVec3::Y) < 1e-9, "{limb} {twig}");
    // A hand that swings with its arm rolls nothing, and one with an invalid orientation is a tip alone.
    let plain = ends(controller(start), controller(up));
    let swung = ends(turned(start, DVec3::Z, 10.0), turned(up, DVec3::Z, 100.0));
    assert!(plain.0.distance(swung.0) < 1e-9 && plain.1.distance(swung.1) < 1e-9);
    for hand in [DQuat::from_array([0.0; 4]), DQuat::from_array([f64::NAN; 4])] {
        assert_eq!(ends(posed(start, hand), posed(up, hand)), plain);
    }
}

#[test]
fn a_hand_that_pulls_takes_a_branch_to_other_wood() {
    let plant = tree();
    let start = DVec3::new(1.0, 2.6, 0.0);
    let mut tool = Tool::new(ToolKind::Rotate);
    let straight = |tip| turned(tip, DVec3::Z, 0.0);
    tool.handle(&plant, &Input::Down(straight(start)));
    // At its old distance from its base, it turns; a third of its length further away, it comes off.
    for (to, host) in [
        (DVec3::new(1.7, 2.0, 0.0), None),
        (DVec3::new(-0.4, 1.2, 0.0), Some(0)),
        (DVec3::new(1.0, 2.5, 0.0), None),
        (DVec3::new(-0.5, 1.0, 0.3), Some(0)),
    ] {
        let shown = tool.handle(&plant, &Input::Move(straight(to)));
        assert_eq!(tool.host().map(AxisId::index), host, "{to}");
        let moved = matches!(shown.preview, Some(HandEdit::Move { turn: Some(_), .. }));
        assert_eq!(moved, host.is_some(), "{to}");
    }
    // Turned by a quarter on the way: it stands on the trunk as the hand holds it, not at its old angle to its bearer.
    for (degrees, along) in [(0.0, DVec3::Y), (90.0, DVec3::NEG_X)] {
        let to = turned(DVec3::new(-0.9, 1.5, 0.2), DVec3::Z, degrees);
        tool.handle(&plant, &Input::Move(to));
        let carried = tool.carried(&plant).expect("in the hand");
        let edit = tool.clone().handle(&plant, &Input::Up(to)).commit.expect("moved");
        let moved = after(&plant, edit);
        let twig = moved.axis_points(AxisId::new(2));
        assert!((twig[8] - twig[0]).normalize().distance(along) < 1e-9, "{degrees}: {twig:?}");
        let bearer = moved.axis(AxisId::new(2)).bearer.expect("borne");
        assert_eq!(moved.nodes.axis[bearer.index()].index(), 0);
        let was = plant.axis_points(AxisId::new(2));
        assert!(was.iter().zip(twig).all(|(p, q)| carried.place(*p).distance(*q) < 1e-9));
    }
    // A branch on the ground stays there, however a hand pulls.
    let foot = DVec3::new(0.0, 1.0, 0.0);
    let mut tool = Tool::new(ToolKind::Rotate);
    tool.handle(&plant, &Input::Down(straight(foot)));
    tool.handle(&plant, &Input::Move(straight(DVec3::new(1.0, 9.0, 0.0))));
    assert!(tool.is_busy() && tool.host().is_none());
}

#[test]
fn every_tool_works_at_the_tip_of_a_controller() {
    let plant = tree();
    // In the air in front of the wood, pointing at it from a hand's breadth.
    let held = |tip: DVec3| Pointer {
        ray: Ray { origin: tip + DVec3::Z * 0.1, direction: DVec3::NEG_Z },
        ..controller(tip)
    };
    let at = DVec3::new(1.5, 2.0, 0.02);
    let click = |kind| {
        let mut tool = Tool::new(kind);
        let down = tool.handle(&plant, &Input::Down(held(at)));
        assert_eq!(down.picked.map(|k| k.axis.index()), Some(1), "{kind:?}");
        tool.handle(&plant, &Input::Up(held(at))).commit
    };
    assert_eq!(click(ToolKind::Pick), None);
    let cut = click(ToolKind::Prune { whole: false }).expect("cut");
    assert!(matches!(&cut, HandEdit::Prune { at, .. } if (at - 0.75).abs() < 1e-9), "{cut:?}");
    let end = after(&plant, cut).axis_points(AxisId::new(1)).last().copied().expect("some");
    assert!(end.distance(DVec3::new(1.5, 2.0, 0.0)) < 1e-6, "{end}");
    assert!(matches!(click(ToolKind::Regrow), Some(HandEdit::Regrow { .. })));
    // A brush follows the tip out of every plane, as thick as the trigger is pressed.
    let way: Vec<Pointer> = (0..9)
        .map(|k| {
            let k = f64::from(k);
            Pointer {
                pressure: 1.0 - 0.08 * k,
                ..held(DVec3::new(1.5 + 0.1 * k, 2.0 + 0.12 * k, 0.02 + 0.15 * k))
            }
        })
        .collect();
    let brushed = drag(&mut Tool::new(ToolKind::Brush { radius_m: 0.3, density: 1.0 }), &plant, &way);
    let edit = brushed.commit.expect("brushed");
    let HandEdit::Brush { points, radius_m, .. } = &edit else { panic!("{edit:?}") };
    let tips: Vec<DVec3> = way.iter().filter_map(|p| p.tip).collect();
    assert_eq!((points, radius_m.len()), (&tips, tips.len()));
    assert!((radius_m[0] - 0.3).abs() < 1e-12, "{radius_m:?}");
    assert!(radius_m.windows(2).all(|w| w[1] < w[0]), "{radius_m:?}");
    let grown = after(&plant, edit);
    let out = grown.nodes.position.iter().map(|p| p.z).fold(0.0, f64::max);
    assert!(grown.axes.len() > plant.axes.len() && out > 0.4, "{out}");
    // Leaves are thinned where the tip goes.
    let thinned = drag(&mut Tool::new(ToolKind::Leaves { radius_m: 0.2, keep: 0.5 }), &plant, &way).commit;
    let Some(HandEdit::LeafDensity { region: LeafRegion::Stroke { points, .. }, .. }) = thinned else {
        panic!("{thinned:?}")
    };
    assert_eq!(points, tips);
    // A shoot grows from the touched branch, in the direction of the hand; on the ground, from the point under the ray.
    let mut tool = Tool::new(ToolKind::Grow(Growth::default()));
    let shoot = tool.handle(&plant, &Input::Down(held(at))).preview;
    let Some(HandEdit::Grow { from: GrowFrom::Branch { at: share, .. }, towards, .. }) = shoot else {
        panic!("{shoot:?}")
    };
    assert!((share - 0.75).abs() < 1e-9 && towards == Some(DVec3::NEG_Z));
    tool.handle(&plant, &Input::Cancel);
    let tip = DVec3::new(3.0, 1.0, 1.0);
    let down = Pointer { ray: Ray { origin: tip, direction: DVec3::NEG_Y }, ..controller(tip) };
    let stem = tool.handle(&plant, &Input::Down(down)).preview;
    assert!(
        matches!(&stem, Some(HandEdit::Grow { from: GrowFrom::Ground(foot), .. }) if foot.distance(DVec3::new(3.0, 0.0, 1.0)) < 1e-9),
        "{stem:?}"
    );
}

#[test]
fn a_controller_drops_a_branch_on_the_wood_that_is_nearest() {
    let plant = tree();
    let twig = DVec3::new(1.0, 2.6, 0.0);
    let drop = |to: DVec3| {
        let way = [twig, twig.lerp(to, 0.5), to].map(controller);
        let edit = drag(&mut Tool::new(ToolKind::Move), &plant, &way).commit.expect("moved");
        let moved = after(&plant, edit);
        let bearer = moved.axis(AxisId::new(2)).bearer.expect("borne");
        (moved.nodes.axis[bearer.index()].index(), moved.nodes.position[bearer.index()])
    };
    let (bearer, at) = drop(DVec3::new(0.1, 1.0, 0.2));
    assert!(bearer == 0 && at.distance(DVec3::Y) < 0.3, "{bearer} {at}");
    let (bearer, at) = drop(DVec3::new(1.9, 2.1, -0.1));
    assert!(bearer == 1 && at.distance(DVec3::new(1.9, 2.0, 0.0)) < 0.3, "{bearer} {at}");
}

#[test]
fn a_branch_slides_along_its_bearer_and_a_stem_over_the_ground() {
    let plant = tree();
    let way = [mouse(1.0, 2.0), mouse(0.9, 2.5), mouse(0.8, 3.0)];
    let edit = drag(&mut Tool::new(ToolKind::Move), &plant, &way).commit.expect("moved");
    let HandEdit::Move { to: Destination::Place { at, .. }, .. } = &edit else { panic!("{edit:?}") };
    assert!((at - 0.75).abs() < 0.03, "{at}");
    let base = after(&plant, edit).axis_points(AxisId::new(1))[0];
    assert!((base.y - 3.0).abs() < 0.12 && base.x == 0.0, "{base}");
    let from_above = |x: f64| Pointer {
        ray: Ray { origin: DVec3::new(x, 10.0, 10.0), direction: DVec3::new(0.0, -1.0, -1.0) },
        ..mouse(0.0, 0.0)
    };
    let way = [from_above(0.0), from_above(0.7), from_above(1.5)];
    let edit = drag(&mut Tool::new(ToolKind::Move), &plant, &way).commit.expect("moved");
    assert!(
        matches!(edit, HandEdit::Move { to: Destination::ByM(by), .. } if by.distance(DVec3::X * 1.5) < 1e-9)
    );
}

#[test]
fn a_stem_follows_the_pointer_wherever_it_is_grabbed() {
    let plant = tree();
    // From 6 m up and 10 m away; the same path on the screen, from the foot and from high up.
    let eye = DVec3::new(0.0, 6.0, 10.0);
    let at = |p: DVec3| Pointer {
        ray: Ray { origin: eye, direction: p - eye },
        forward: DVec3::new(0.0, -0.5, -1.0).normalize(),
        ..mouse(0.0, 0.0)
    };
    let moved = |from: DVec3, to: DVec3| {
        let edit = drag(&mut Tool::new(ToolKind::Move), &plant, &[at(from), at(from.lerp(to, 0.5)), at(to)]);
        let Some(HandEdit::Move { to: Destination::ByM(by), .. }) = edit.commit else { panic!("{edit:?}") };
        by
    };
    let foot = moved(DVec3::ZERO, DVec3::new(1.0, 0.0, 0.5));
    assert!(foot.distance(DVec3::new(1.0, 0.0, 0.5)) < 1e-9, "{foot}");
    let high = DVec3::new(0.0, 1.5, 0.0);
    let along = moved(high, high + DVec3::X);
    // A metre across at 11 m from the eye is 1.02 m across at the foot; before, it was 1.3 m.
    assert!((along.x - 1.0).abs() < 0.1 && along.z.abs() < 0.2, "{along}");
    // Beyond the horizon it stays at its last place over the ground.
    let near = high + DVec3::X;
    let way = [at(high), at(near), at(DVec3::new(0.0, 30.0, -10.0))];
    let up = drag(&mut Tool::new(ToolKind::Move), &plant, &way).commit;
    assert_eq!(up, drag(&mut Tool::new(ToolKind::Move), &plant, &[at(high), at(near)]).commit);
    assert!(up.is_some());
}

#[test]
fn a_click_prunes_or_regrows_and_escape_does_neither() {
    let plant = tree();
    let click = |kind| {
        let mut tool = Tool::new(kind);
        tool.handle(&plant, &Input::Down(mouse(1.6, 2.0)));
        tool.handle(&plant, &Input::Up(mouse(1.6, 2.0))).commit
    };
    let cut = click(ToolKind::Prune { whole: false }).expect("cut");
    assert!(matches!(&cut, HandEdit::Prune { at, .. } if (at - 0.8).abs() < 0.01));
    assert_eq!(after(&plant, cut).axes.len(), 3);
    let all = click(ToolKind::Prune { whole: true }).expect("cut");
    assert_eq!(after(&plant, all).axes.len(), 1);
    assert!(matches!(click(ToolKind::Regrow), Some(HandEdit::Regrow { seed: 1, .. })));
    for kind in
        [ToolKind::Regrow, ToolKind::Rotate, ToolKind::Move, ToolKind::Sketch { twigs: 1.0, tilt_deg: 0.0 }]
    {
        let mut tool = Tool::new(kind);
        tool.handle(&plant, &Input::Down(mouse(1.6, 2.0)));
        tool.handle(&plant, &Input::Move(mouse(1.6, 3.0)));
        assert_eq!(tool.handle(&plant, &Input::Cancel), Response::default());
        assert_eq!(tool.handle(&plant, &Input::Up(mouse(1.0, 1.0))).commit, None);
    }
    // Into the void: nothing.
    let mut tool = Tool::new(ToolKind::Prune { whole: true });
    tool.handle(&plant, &Input::Down(mouse(-3.0, 1.0)));
    assert_eq!(tool.handle(&plant, &Input::Up(mouse(-3.0, 1.0))).commit, None);
}

#[test]
fn a_branch_is_drawn_on_a_plane_that_faces_the_viewer_or_leans() {
    let plant = tree();
    let way: Vec<Pointer> =
        (0..=10).map(|i| mouse(-0.15 * f64::from(i), 3.0 + 0.08 * f64::from(i))).collect();
    let draw = |tilt_deg: f64| {
        let edit = drag(&mut Tool::new(ToolKind::Sketch { twigs: 0.0, tilt_deg }), &plant, &way)
            .commit
            .expect("drawn");
        let HandEdit::SketchBranch { points, at, bearer, .. } = edit.clone() else { panic!("{edit:?}") };
        assert!(
            (at.unwrap_or(0.0) - 0.75).abs() < 0.01 && bearer.find(&plant).map(|f| f.axis.index()) == Ok(0)
        );
        assert_eq!(after(&plant, edit).axes.len(), 4);
        points
    };
    let flat = draw(0.0);
    assert!(flat.len() > 8 && flat.iter().all(|p| p.z.abs() < 1e-9), "{flat:?}");
    let leaning = draw(35.0);
    let depth = leaning.last().map_or(0.0, |p| p.z);
    assert!(depth < -0.3, "up on the screen goes away from the viewer: {depth}");
    // Tilting the plane while drawing leaves the drawn part in place.
    let mut tool = Tool::new(ToolKind::Sketch { twigs: 0.0, tilt_deg: 0.0 });
    tool.handle(&plant, &Input::Down(way[0]));
    way[1..6].iter().for_each(|p| drop(tool.handle(&plant, &Input::Move(*p))));
    tool.handle(&plant, &Input::Twist(0.6));
    way[6..].iter().for_each(|p| drop(tool.handle(&plant, &Input::Move(*p))));
    let Some(HandEdit::SketchBranch { points, .. }) = tool.handle(&plant, &Input::Up(way[10])).commit else {
        panic!()
    };
    assert!(points[..5].iter().all(|p| p.z.abs() < 1e-9) && points.last().is_some_and(|p| p.z < -0.1));
}

#[test]
fn a_branch_that_is_begun_in_the_sky_grows_from_the_wood_beside_it() {
    let plant = tree();
    let drawn = |x: f64| {
        let way: Vec<Pointer> =
            (0..=10).map(|i| mouse(x - 0.1 * f64::from(i), 3.0 + 0.03 * f64::from(i))).collect();
        drag(&mut Tool::new(ToolKind::Sketch { twigs: 0.0, tilt_deg: 0.0 }), &plant, &way).commit
    };
    let edit = drawn(-0.6).expect("the trunk is near");
    let HandEdit::SketchBranch { points, at, bearer, .. } = &edit else { panic!("{edit:?}") };
    assert!((at.unwrap_or(0.0) - 0.75).abs() < 0.03 && bearer.find(&plant).map(|f| f.axis.index()) == Ok(0));
    assert!((points[0].x + 0.6).abs() < 0.01, "what was drawn stays as it was drawn");
    let with = after(&plant, edit);
    let new = with.axes.iter().find(|a| !plant.axes.iter().any(|b| b.key == a.key)).expect("a branch");
    let foot = with.nodes.position[new.nodes.start as usize];
    assert!(foot.x.abs() < 0.05 && (foot.y - 3.0).abs() < 0.1, "it begins on the trunk: {foot}");
    assert_eq!(drawn(-3.0), None, "too far from all wood");
}

#[test]
fn a_controller_draws_in_space_with_the_same_tool() {
    let plant = tree();
    let way: Vec<Pointer> =
        (0..=10).map(|i| controller(DVec3::new(-0.1 * f64::from(i), 3.0, 0.12 * f64::from(i)))).collect();
    let edit = drag(&mut Tool::new(ToolKind::Sketch { twigs: 0.0, tilt_deg: 0.0 }), &plant, &way).commit;
    let Some(HandEdit::SketchBranch { points, .. }) = edit else { panic!("{edit:?}") };
    assert_eq!(points.last(), Some(&DVec3::new(-1.0, 3.0, 1.2)));
}

#[test]
fn a_brush_follows_pressure_and_its_radius_can_change_on_the_way() {
    let plant = tree();
    let mut tool = Tool::new(ToolKind::Brush { radius_m: 0.4, density: 1.0 });
    let press = |x: f64, pressure| Pointer { pressure, ..mouse(x, 3.2) };
    tool.handle(&plant, &Input::Down(press(0.0, 1.0)));
    (1..6).for_each(|i| drop(tool.handle(&plant, &Input::Move(press(-0.2 * f64::from(i), 0.5)))));
    tool.handle(&plant, &Input::Brush(0.2, 2.0));
    (6..10).for_each(|i| drop(tool.handle(&plant, &Input::Move(press(-0.2 * f64::from(i), 0.5)))));
    let edit = tool.handle(&plant, &Input::Up(press(-1.8, 0.5))).commit.expect("brushed");
    let HandEdit::Brush { radius_m, points, density, .. } = &edit else { panic!("{edit:?}") };
    assert_eq!((radius_m.len(), *density), (points.len(), 2.0));
    assert!(
        (radius_m[0] - 0.4).abs() < 1e-12
            && (radius_m[2] - 0.28).abs() < 1e-12
            && (radius_m[8] - 0.14).abs() < 1e-12
    );
    assert!(after(&plant, edit).axes.len() > 5);
}

#[test]
fn a_lasso_becomes_a_silhouette_in_the_viewers_plane() {
    let plant = tree();
    let ring: Vec<Pointer> = (0..24)
        .map(|i| {
            let (s, c) = base::ops::sin_cos(f64::from(i) * base::ops::TAU / 24.0);
            mouse(1.8 * c, 3.5 + 1.4 * s)
        })
        .collect();
    let edit =
        drag(&mut Tool::new(ToolKind::Silhouette { density: 0.5, trim: false, plane: None }), &plant, &ring)
            .commit;
    let edit = edit.expect("drawn");
    let HandEdit::Silhouette { plane, outline, .. } = &edit else { panic!("{edit:?}") };
    assert!(plane.right == DVec3::X && plane.up == DVec3::Y && outline.len() > 20);
    assert!(geom::signed_area(outline) > 5.0);
    assert!(after(&plant, edit).axes.len() > 20);
}

#[test]
fn leaves_are_brushed_and_hovering_picks() {
    let plant = tree();
    let way = [mouse(0.0, 3.0), mouse(0.2, 3.1), mouse(0.4, 3.2)];
    let edit = drag(&mut Tool::new(ToolKind::Leaves { radius_m: 0.5, keep: 0.2 }), &plant, &way).commit;
    let Some(HandEdit::LeafDensity { region: LeafRegion::Stroke { points, radius_m }, keep, .. }) = edit
    else {
        panic!("{edit:?}")
    };
    assert_eq!((points.len(), radius_m, keep), (3, 0.5, 0.2));
    let mut tool = Tool::new(ToolKind::Rotate);
    let over = tool.handle(&plant, &Input::Move(mouse(1.6, 2.0)));
    assert_eq!((over.picked.map(|k| k.axis.index()), over.preview, tool.is_busy()), (Some(1), None, false));
    assert!(matches!(AxisKey::for_axis(&plant, AxisId::new(1)), Some(AxisKey::Mark(_))));
}

#[test]
fn no_input_is_a_fault() {
    let plant = tree();
    let bad = Pointer {
        ray: Ray { origin: DVec3::NAN, direction: DVec3::ZERO },
        forward: DVec3::ZERO,
        up: DVec3::NAN,
        pressure: f64::NAN,
        tip: Some(DVec3::NAN),
        hand: Some(DQuat::from_array([f64::NAN; 4])),
    };
    for kind in [
        ToolKind::Rotate,
        ToolKind::Move,
        ToolKind::Copy,
        ToolKind::Prune { whole: true },
        ToolKind::Regrow,
        ToolKind::Sketch { twigs: f64::NAN, tilt_deg: f64::NAN },
        ToolKind::Brush { radius_m: -1.0, density: f64::NAN },
        ToolKind::Silhouette {
            density: 0.0,
            trim: true,
            plane: Some(ViewPlane { right: DVec3::NAN, ..ViewPlane::default() }),
        },
        ToolKind::Leaves { radius_m: f64::NAN, keep: -2.0 },
    ] {
        for plant in [&plant, &Plant::default()] {
            let mut tool = Tool::new(kind);
            for first in [mouse(1.6, 2.0), bad] {
                tool.handle(plant, &Input::Down(first));
                tool.handle(plant, &Input::Move(bad));
                tool.handle(plant, &Input::Move(mouse(0.3, 3.0)));
                tool.handle(plant, &Input::Twist(f64::INFINITY));
                tool.handle(plant, &Input::Brush(f64::NAN, 2.0));
                let edit = tool.handle(plant, &Input::Up(bad)).commit;
                let edits: Vec<HandEdit> = edit.into_iter().collect();
                let applied =
                    apply(plant, &edits, &Context::default(), &Run::plain()).expect("not cancelled");
                assert_eq!(applied.plant.validate().count(), 0);
            }
        }
    }
}

#[test]
fn what_is_held_grows_round_by_round_with_numbers_that_change() {
    let plant = tree();
    let mut tool = Tool::new(ToolKind::Grow(Growth::default()));
    let wood = |p: &Plant| p.axes.len();
    // On the limb, then on the ground next to the tree.
    for (at, said) in [(mouse(1.5, 2.0), 2), (mouse(3.0, -0.6), 1)] {
        let first = tool.handle(&plant, &Input::Down(at)).preview.expect("it grows at once");
        assert!(matches!(first, HandEdit::Grow { rounds: 1, .. }));
        let mut counts = vec![wood(&after(&plant, first))];
        for round in 0..12 {
            if round == 6 {
                tool.handle(
                    &plant,
                    &Input::Grow(Growth { angle_deg: 85.0, vigour: 2.5, ..Growth::default() }),
                );
                tool.handle(&plant, &Input::Grow(Growth { vigour: -1.0, ..Growth::default() }));
            }
            let r = tool.handle(&plant, &Input::Round);
            counts.push(wood(&after(&plant, r.preview.expect("still growing"))));
        }
        assert!(counts.windows(2).filter(|w| w[1] > w[0]).count() >= 4, "{counts:?}");
        assert!(counts[12] > counts[0] + 8, "{counts:?}");
        let edit = tool.handle(&plant, &Input::Up(at)).commit.expect("kept");
        edit.check().expect("sound");
        let HandEdit::Grow { rounds, changes, .. } = &edit else { panic!("{edit:?}") };
        // The tool keeps the settings that it was given.
        assert_eq!((*rounds, changes.len()), (13, said));
        assert_eq!(changes[said - 1].round, if said == 2 { 7 } else { 0 });
        assert_eq!(changes[said - 1].branch_angle_deg, Some(85.0));
        // The record is the edit: read back, it gives the same tree.
        let text = serde_json::to_string(&edit).expect("JSON");
        let again: HandEdit = serde_json::from_str(&text).expect("read back");
        assert_eq!(after(&plant, again), after(&plant, edit));
    }
    // Nothing grows in the sky.
    let up = Pointer {
        ray: Ray { origin: DVec3::Z * 10.0, direction: DVec3::new(0.3, 1.0, 0.0) },
        ..mouse(0.0, 0.0)
    };
    assert!(tool.handle(&plant, &Input::Down(up)).preview.is_none() && !tool.is_busy());
}

/// Counts the jobs that it is asked to run: two for each round of growth.
#[derive(Default)]
struct Counting(AtomicUsize);

impl Executor for Counting {
    fn for_each(&self, n: usize, job: &(dyn Fn(usize) + Sync)) {
        self.0.fetch_add(1, Ordering::Relaxed);
        (0..n).for_each(job);
    }
}

#[test]
fn what_is_held_grows_on_from_where_it_is() {
    let plant = tree();
    let counting = Counting::default();
    let run = Run { executor: &counting, ..Run::plain() };
    let mut kept = KeptGrowth::default();
    let mut push = |edit: &HandEdit| {
        let before = counting.0.load(Ordering::Relaxed);
        let mut shaping = Shaping::new(&plant);
        let outcome = shaping.push_again(edit, &Context::default(), &mut kept, &run).expect("not cancelled");
        assert!(outcome.is_done(), "{outcome}");
        assert_eq!(shaping.into_plant(), after(&plant, edit.clone()), "as from its start");
        (counting.0.load(Ordering::Relaxed) - before, kept.rounds())
    };
    for down in [mouse(1.5, 2.0), mouse(3.0, -0.6)] {
        let mut tool = Tool::new(ToolKind::Grow(Growth { vigour: 1.2, ..Growth::default() }));
        tool.handle(&plant, &Input::Down(down));
        let mut most = 0;
        for round in 2..13 {
            if round % 6 == 0 {
                let vigour = 1.2 + 0.02 * f64::from(round);
                tool.handle(&plant, &Input::Grow(Growth { vigour, ..Growth::default() }));
            }
            let edit = tool.handle(&plant, &Input::Round).preview.expect("it grows");
            let (jobs, rounds) = push(&edit);
            assert_eq!(rounds, round);
            most = if round > 2 { most.max(jobs) } else { most };
        }
        assert!(most < 20, "a round is one round of growth: {most}");
        // The edit that is kept is the last preview: nothing grows anew.
        let edit = tool.handle(&plant, &Input::Up(down)).commit.expect("kept");
        assert!(push(&edit).0 < most);
        // A shoot held for a shorter time, and one that grows elsewhere, begins anew.
        let HandEdit::Grow { from, towards, changes, seed, mirror, .. } = edit.clone() else { panic!() };
        let early = changes.into_iter().filter(|c| c.round < 5).collect::<Vec<_>>();
        let short = |seed, from: GrowFrom| HandEdit::Grow {
            from,
            towards,
            rounds: 5,
            changes: early.clone(),
            seed,
            mirror,
        };
        push(&short(seed, from.clone()));
        push(&short(seed + 1, from));
        push(&edit);
    }
    // Another edit drops it.
    let cut = HandEdit::Prune { axis: AxisKey::Path(vec![0, 0]), at: 0.0 };
    assert_eq!(push(&cut).1, 0);
}

#[test]
fn what_is_carried_is_where_the_edit_puts_it() {
    let plant = tree();
    let twig = DVec3::new(1.0, 2.6, 0.0);
    let places = [DVec3::new(0.1, 1.0, 0.2), DVec3::new(1.9, 2.1, -0.1), DVec3::new(0.1, 3.71, 0.3)];
    let cases = places.iter().flat_map(|to| {
        [
            (ToolKind::Rotate, [controller(twig), controller(*to)]),
            (ToolKind::Move, [controller(twig), controller(*to)]),
            (ToolKind::Rotate, [mouse(1.6, 2.0), mouse(to.x, to.y)]),
            (ToolKind::Move, [mouse(1.6, 2.0), mouse(0.4 * to.x, to.y + 0.13)]),
            (ToolKind::Move, [mouse(0.0, 0.9), mouse(0.4, 0.7)]),
        ]
    });
    for (kind, [from, to]) in cases {
        let mut tool = Tool::new(kind);
        tool.handle(&plant, &Input::Down(from));
        let edit = tool.handle(&plant, &Input::Move(to)).preview;
        let Some(edit) = edit else { continue };
        let carried = tool.carried(&plant).expect("it is in the hand");
        let moved = after(&plant, edit);
        let borne = plant.borne_by(carried.axis);
        for (row, borne) in borne.iter().enumerate().filter(|(row, _)| *row != carried.axis.index()) {
            // A new node on the bearer does not matter here: it is not borne by the branch.
            let (was, now) = (plant.axis_points(AxisId::new(row)), moved.axis_points(AxisId::new(row)));
            for (p, q) in was.iter().zip(now).filter(|_| *borne) {
                assert!(carried.place(*p).distance(*q) < 1e-9, "{kind:?} {p} {q}");
            }
        }
        let (was, now) = (plant.axis_points(carried.axis), moved.axis_points(carried.axis));
        assert!(was.iter().zip(now).all(|(p, q)| carried.place(*p).distance(*q) < 1e-9), "{kind:?}");
        assert!(tool.handle(&plant, &Input::Up(to)).commit.is_some() && tool.carried(&plant).is_none());
    }
    // A brush, and a hand that holds nothing, carry nothing.
    let mut tool = Tool::new(ToolKind::Leaves { radius_m: 0.1, keep: 0.5 });
    tool.handle(&plant, &Input::Down(mouse(1.0, 2.0)));
    assert_eq!(tool.carried(&plant), None);
}

#[test]
fn an_outline_is_drawn_on_the_plane_that_was_placed() {
    let plant = tree();
    // Next to the plant, tilted back, turned a third of the way round; a tip that shakes in front of and behind it.
    let towards = DVec3::new(0.8, 0.3, 0.5);
    let plane = ViewPlane::facing(DVec3::new(0.3, 3.2, 0.1), towards, DVec3::Y).expect("a direction");
    let [right, up, normal] = plane.axes().expect("orthonormal");
    assert!(normal.distance(towards.normalize()) < 1e-12 && up.y > 0.9);
    let ring = |hand: &dyn Fn(f64, DVec3) -> Pointer| -> Vec<Pointer> {
        let at = |i: u32| {
            let (s, c) = base::ops::sin_cos(f64::from(i) * base::ops::TAU / 32.0);
            hand(f64::from(i % 3) - 1.0, plane.origin + right * (1.2 * c) + up * (1.2 * s))
        };
        (0..32).map(at).collect()
    };
    let kind = ToolKind::Silhouette { density: 0.5, trim: false, plane: Some(plane) };
    let eye = DVec3::new(3.0, 4.0, 9.0);
    for way in [
        ring(&|off, p| controller(p + normal * (0.2 * off))),
        ring(&|_, p| Pointer { ray: Ray { origin: eye, direction: p - eye }, ..mouse(0.0, 0.0) }),
    ] {
        let edit = drag(&mut Tool::new(kind), &plant, &way).commit.expect("drawn");
        let HandEdit::Silhouette { plane: drawn, outline, .. } = &edit else { panic!("{edit:?}") };
        assert!(drawn.origin == plane.origin && drawn.right.distance(right) < 1e-12);
        assert!(outline.iter().all(|p| (p.length() - 1.2).abs() < 1e-9), "{outline:?}");
        let grown = after(&plant, edit);
        let new = grown.axes.iter().enumerate().filter(|(_, a)| !plant.axes.iter().any(|b| b.key == a.key));
        let tips: Vec<DVec3> =
            new.filter_map(|(row, _)| grown.axis_points(AxisId::new(row)).last().copied()).collect();
        let outside = tips.iter().filter(|p| {
            let d = **p - plane.origin;
            (d - normal * d.dot(normal)).length() > 1.5
        });
        assert!(tips.len() > 10 && outside.count() * 20 < tips.len(), "{} tips", tips.len());
    }
    // A plane placed by a hand that points along the vertical has some upright direction, and no direction gives no
    // plane.
    let flat = ViewPlane::facing(DVec3::ZERO, DVec3::Y, DVec3::Y).expect("a direction");
    assert!(flat.axes().is_ok());
    for (point, towards) in [(DVec3::NAN, DVec3::X), (DVec3::ZERO, DVec3::ZERO), (DVec3::ZERO, DVec3::NAN)] {
        assert_eq!(ViewPlane::facing(point, towards, DVec3::Y), None);
    }
}

#[test]
fn what_is_held_on_to_for_long_stops_growing_and_stays() {
    let plant = tree();
    let mut tool = Tool::new(ToolKind::Grow(Growth { vigour: 6.0, ..Growth::default() }));
    tool.handle(&plant, &Input::Down(mouse(1.5, 2.0)));
    let mut edit = None;
    for _ in 0..60 {
        edit = tool.handle(&plant, &Input::Round).preview;
    }
    // The budget of a browser: over it, nothing would grow.
    let run = Run { budget: Budget { times: 0.25, ..Budget::default() }, ..Run::plain() };
    let (mut shaping, mut kept) = (Shaping::new(&plant), KeptGrowth::default());
    let edit = edit.expect("it grows");
    let outcome = shaping.push_again(&edit, &Context::default(), &mut kept, &run).expect("not cancelled");
    assert!(outcome.is_done() && kept.rounds() < 60, "{outcome}, {} rounds", kept.rounds());
    let axes = shaping.into_plant().axes.len();
    assert!((1_000..10_000).contains(&axes), "{axes}");
}

#[test]
fn a_copy_is_dropped_on_the_wood_that_is_meant_and_the_branch_stays() {
    let plant = tree();
    let twig = DVec3::new(1.0, 2.6, 0.0);
    let host_of_copy = |edit: HandEdit| {
        assert!(matches!(edit, HandEdit::Copy { .. }), "{edit:?}");
        let copied = after(&plant, edit);
        assert_eq!(copied.axes.len(), 4, "one more");
        assert_eq!(copied.axis_points(AxisId::new(2)), plant.axis_points(AxisId::new(2)), "it stays");
        let bearer = copied.axis(AxisId::new(3)).bearer.expect("borne");
        (copied.nodes.axis[bearer.index()].index(), copied.nodes.position[bearer.index()])
    };
    // By the tip of a controller, and with a mouse: onto the trunk.
    let way = [twig, DVec3::new(0.5, 2.0, 0.1), DVec3::new(0.05, 1.0, 0.1)].map(controller);
    let mut tool = Tool::new(ToolKind::Copy);
    let (bearer, at) = host_of_copy(drag(&mut tool, &plant, &way).commit.expect("copied"));
    assert!(bearer == 0 && at.distance(DVec3::Y) < 0.3, "{bearer} {at}");
    let way = [mouse(1.0, 2.6), mouse(0.5, 2.5), mouse(0.0, 3.0)];
    let (bearer, at) = host_of_copy(drag(&mut tool, &plant, &way).commit.expect("copied"));
    assert!(bearer == 0 && at.distance(DVec3::Y * 3.0) < 0.1, "{bearer} {at}");
    // A click, or a hand that hardly moved, copies nothing; nothing is moved instead of the branch.
    assert!(drag(&mut tool, &plant, &[mouse(1.0, 2.6), mouse(1.0, 2.6)]).commit.is_none());
    let near = [twig, twig + DVec3::X * 0.01].map(controller);
    assert!(drag(&mut tool, &plant, &near).commit.is_none());
    tool.handle(&plant, &Input::Down(way[0]));
    tool.handle(&plant, &Input::Move(way[2]));
    assert!(tool.is_busy() && !tool.carries() && tool.carried(&plant).is_none());
    tool.handle(&plant, &Input::Cancel);
    // A stem is copied over the ground.
    let way = [mouse(0.0, 1.0), mouse(0.8, 1.0), mouse(1.5, 1.0)];
    let edit = drag(&mut tool, &plant, &way).commit.expect("copied");
    let two = after(&plant, edit);
    assert_eq!(two.axes.iter().filter(|a| a.bearer.is_none()).count(), 2);
    assert_eq!(two.axes.len(), 6);
}

#[test]
fn a_mirror_stands_between_the_hands_and_is_in_the_edit() {
    let plant = tree();
    let mirror = Mirror::between_hands(&plant, DVec3::new(3.0, 1.0, 0.0)).expect("a stem");
    assert_eq!((mirror.point, mirror.normal), (DVec3::ZERO, DVec3::X));
    assert!(Mirror::between_hands(&plant, DVec3::Y).is_none());
    assert!(Mirror::between_hands(&plant, DVec3::NAN).is_none());
    assert!(Mirror::between_hands(&Plant::default(), DVec3::X).is_none());
    let mut tool = Tool::new(ToolKind::Sketch { twigs: 0.0, tilt_deg: 0.0 }).mirrored(Some(mirror));
    let way = [DVec3::new(0.02, 3.0, 0.0), DVec3::new(0.5, 3.3, 0.3), DVec3::new(1.0, 3.4, 0.5)];
    let edit = drag(&mut tool, &plant, &way.map(controller)).commit.expect("drawn");
    let text = serde_json::to_string(&edit).expect("JSON");
    assert_eq!(serde_json::from_str::<HandEdit>(&text).expect("read back"), edit);
    let both = after(&plant, edit);
    assert_eq!(both.axes.len(), 5);
    let (one, other) = (both.axis_points(AxisId::new(3)), both.axis_points(AxisId::new(4)));
    assert_eq!(one.len(), other.len());
    for (p, q) in one.iter().zip(other) {
        assert!(q.distance(DVec3::new(-p.x, p.y, p.z)) < 1e-9, "{p} {q}");
    }
}
