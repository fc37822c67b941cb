//! Branches that a hand drew in space, and branches that a brush guides.

use base::Seed;
use base::ops::{self, PI, TAU};
use glam::DVec3;
use growth::{BrushStroke, GuidedSpec, StartBud, Tropism, guide_from};
use plant::AxisKind;

use crate::bench::{Bench, Stop, unread};
use crate::draft::{At, Branch, Draft};
use crate::fill::joint_of;
use crate::graft::{Hosts, graft_all, out_of_bark};
use crate::habit::{Habit, kind_on, softened};
use crate::key::AxisKey;
use crate::leaves::dress;
use crate::outcome::{Changed, Why};
use crate::pipes::Pipes;

const DRAWN: u64 = 0x6472_6177;
const BRUSH: u64 = 0x6272_7573;

/// A branch that was drawn.
pub(crate) struct Drawn<'a> {
    pub(crate) bearer: &'a AxisKey,
    pub(crate) at: Option<f64>,
    pub(crate) points: &'a [DVec3],
    pub(crate) twigs: f64,
}

/// A stroke of the brush.
pub(crate) struct Stroke<'a> {
    pub(crate) points: &'a [DVec3],
    pub(crate) radius_m: &'a [f64],
    pub(crate) density: f64,
}

/// Returns a usable line: finite, of some length, with distinct neighbours.
fn usable_line(points: &[DVec3], size_m: f64) -> Result<Vec<DVec3>, Why> {
    if !points.iter().all(|p| p.is_finite() && p.abs().max_element() < 1e6) {
        return Err(Why::BadNumber { field: "points" });
    }
    let mut line = points.to_vec();
    line.dedup_by(|a, b| a.distance(*b) < 1e-9 * size_m);
    if line.len() < 2 || geom::polyline_length3(&line) < 1e-3 * size_m {
        return Err(Why::TooSmall { what: "line" });
    }
    Ok(line)
}

pub(crate) fn add(
    draft: &mut Draft,
    drawn: &Drawn<'_>,
    seed: Seed,
    bench: &Bench<'_>,
) -> Result<Changed, Stop> {
    if !(0.0..=4.0).contains(&drawn.twigs) {
        return Err(Why::BadNumber { field: "twigs" }.into());
    }
    let habit = bench.habit(draft);
    let line = usable_line(drawn.points, habit.size_m)?;
    let (host, by_likeness) = drawn.bearer.find_in(draft)?;
    let share = match drawn.at {
        Some(at) if at.is_finite() => at.clamp(0.0, 1.0),
        Some(_) => return Err(Why::BadNumber { field: "at" }.into()),
        None => geom::nearest_on_polyline3(&draft.branches[host].points, line[0]).1,
    };
    let node = draft.node_at(host, share);
    let at = At { branch: host, node };
    let start = draft.branches[host].points[node];
    let course = course(start, line, &habit, bench)?;
    let length = geom::polyline_length3(&course);
    let own = own_seed(draft, seed.child(DRAWN).child(draft.branches[host].key), course[course.len() / 2]);
    let limit = 0.9 * draft.branches[host].radii[node].max(habit.tip_m);
    let base = (habit.slender * length).max(1.5 * habit.tip_m).min(limit.max(habit.tip_m));
    let lengths = lengths(&course);
    let radii = lengths.iter().map(|l| {
        let left = 1.0 - l / length.max(1e-300);
        habit.tip_m.min(base) + (base - habit.tip_m).max(0.0) * ops::powf(left.max(0.0), 0.8)
    });
    let b = draft.branches.len();
    draft.branches.push(Branch {
        kind: kind_on(draft.branches[host].kind),
        key: own.number(),
        source: None,
        colors: Vec::new(),
        bearer: Some(at),
        radii: radii.collect(),
        points: course,
        alive: true,
        fresh: true,
    });
    let mut pipes = Pipes::default();
    pipes.bounded = true;
    pipes.book(Some(at), base, 1.0, habit.exponent);
    pipes.settle(draft, habit.exponent, habit.tip_m);
    let added = 1 + twigs(draft, b, drawn.twigs, &habit, own, bench)?;
    dress(draft, &habit, bench)?;
    Ok(Changed { added, by_likeness, ..Changed::default() })
}

fn lengths(line: &[DVec3]) -> Vec<f64> {
    let mut sum = 0.0;
    let of = (0..line.len()).map(|i| {
        sum += if i > 0 { line[i].distance(line[i - 1]) } else { 0.0 };
        sum
    });
    of.collect()
}

/// Returns a seed of its own for a branch: two branches that are drawn alike must not share one key.
pub(crate) fn own_seed(draft: &Draft, seed: Seed, place: DVec3) -> Seed {
    let bits = place.x.to_bits() ^ place.y.to_bits().rotate_left(21) ^ place.z.to_bits().rotate_left(42);
    let mut own = seed.child(bits);
    while draft.branches.iter().any(|b| b.key == own.number()) {
        own = own.child(1);
    }
    own
}

/// Joins a line to its bearer, softens it, and ends it where an obstacle stands in its way.
fn course(start: DVec3, mut line: Vec<DVec3>, habit: &Habit, bench: &Bench<'_>) -> Result<Vec<DVec3>, Why> {
    let length = geom::polyline_length3(&line);
    // A hand starts near the bearer, hardly ever on it.
    if line[0].distance(start) < 0.15 * length && line.len() > 2 {
        line[0] = start;
    } else {
        line.insert(0, start);
    }
    line.dedup_by(|a, b| a.distance(*b) < 1e-9 * habit.size_m);
    let length = geom::polyline_length3(&line);
    let step = (0.6 * habit.internode_m).clamp(length / 60.0, length / 5.0);
    let mut course = softened(&geom::resample3(&line, step), 3);
    if !bench.obstacles.is_empty() {
        let open = course.iter().skip(1).take_while(|p| bench.obstacles.free(**p)).count();
        course.truncate(open + 1);
    }
    if course.len() < 2 { Err(Why::NothingGrew) } else { Ok(course) }
}

/// Grows twigs on a drawn branch: longer ones below, none at its base. Returns how many branches grew.
fn twigs(
    draft: &mut Draft,
    b: usize,
    density: f64,
    habit: &Habit,
    seed: Seed,
    bench: &Bench<'_>,
) -> Result<usize, Stop> {
    let branch = &draft.branches[b];
    // A herb's stems hardly branch: a drawn one branches only if others do.
    let forks = draft.branches.iter().filter(|c| c.alive && c.is_shoot() && c.bearer.is_some()).count();
    let bare = branch.kind == AxisKind::Root || (branch.kind == AxisKind::Stem && forks < 4);
    let length = branch.length();
    let internode = (0.8 * habit.internode_m).min(0.12 * length);
    if density <= 0.0 || bare || internode <= 0.0 {
        return Ok(0);
    }
    let wish = (density * 0.75 * length / internode).round().clamp(0.0, 80.0);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 80")]
    let (count, rounds) = (wish as u32, (0.35 * length / internode).round().clamp(2.0, 8.0) as u32);
    let hosts = Hosts::collect(draft, |i| i == b);
    let branch = &draft.branches[b];
    let lengths = branch.lengths();
    let mut buds = Vec::new();
    for k in 0..count {
        let share = 0.22 + 0.75 * (f64::from(k) + 0.5) / f64::from(count);
        let node = lengths.partition_point(|l| *l < share * length).clamp(1, lengths.len() - 1);
        let Some(joint) = joint_of(&hosts, At { branch: b, node }) else { continue };
        let along = branch.tangent(node);
        let side = along.any_orthonormal_vector();
        let around = f64::from(k) * 137.507_764 * (PI / 180.0)
            + 0.3 * seed.child(u64::from(k)).stream(base::Draw::Phyllotaxis).normal();
        let ((st, ct), (sa, ca)) =
            (ops::sin_cos(habit.angle_deg.min(60.0) * (PI / 180.0)), ops::sin_cos(around.rem_euclid(TAU)));
        let heading = along * ct + (side * ca + along.cross(side) * sa) * st;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share of the rounds")]
        let wakes = (share * f64::from(rounds)).floor() as u32;
        buds.push(StartBud { joint, heading, wakes });
    }
    let spec = GuidedSpec {
        rounds,
        internode_m: internode.clamp(1e-4, 1e3),
        markers: 40,
        branch_angle_deg: habit.angle_deg.min(60.0),
        lambda: 0.6,
        most_per_shoot: 2,
        shed_up_to: 0,
        near: 1.0,
        far: 3.5,
        max_joints: 40_000,
        ..GuidedSpec::default()
    };
    let start = hosts.skeleton.clone();
    let grown = guide_from(start, &buds, bench.obstacles, &spec, seed, bench.run, &mut unread())?;
    Ok(graft_all(draft, &hosts, &grown.skeleton, habit, Pipes::default(), seed, bench)?.len())
}

pub(crate) fn brush(
    draft: &mut Draft,
    bearer: Option<&AxisKey>,
    stroke: &Stroke<'_>,
    seed: Seed,
    bench: &Bench<'_>,
) -> Result<Changed, Stop> {
    let habit = bench.habit(draft);
    let mut radii = stroke.radius_m.to_vec();
    if radii.len() != 1 && radii.len() != stroke.points.len()
        || !radii.iter().all(|r| r.is_finite() && *r > 1e-6 && *r < 1e5)
    {
        return Err(Why::BadNumber { field: "radius_m" }.into());
    }
    if !(0.1..=10.0).contains(&stroke.density) {
        return Err(Why::BadNumber { field: "density" }.into());
    }
    usable_line(stroke.points, habit.size_m)?;
    let mut points = stroke.points.to_vec();
    if radii.len() == 1 {
        radii = vec![radii[0]; points.len()];
    }
    let (host, by_likeness) = match bearer {
        Some(key) => key.find_in(draft)?,
        None => (nearest_shoot(draft, points[0], 0.5 * habit.size_m)?, false),
    };
    // The part inside the bark of the bearer is hidden: the branch begins where the stroke comes out.
    let hidden = points.iter().take_while(|p| draft.depth_in(host, **p) > 0.0).count();
    if hidden == points.len() {
        return Err(Why::NothingGrew.into());
    }
    points.drain(..hidden.saturating_sub(1));
    radii.drain(..hidden.saturating_sub(1));
    let share = geom::nearest_on_polyline3(&draft.branches[host].points, points[0]).1;
    let node = draft.node_at(host, share);
    let (at, start) = (At { branch: host, node }, draft.branches[host].points[node]);
    // A hand starts near the bearer, hardly ever on it: a short first piece would point anywhere.
    if points[0].distance(start) > radii[0] {
        points.insert(0, start);
        radii.insert(0, radii[0]);
    } else {
        points[0] = start;
    }
    let length = geom::polyline_length3(&points);
    let mean = radii.iter().sum::<f64>() / radii.len() as f64;
    let finer = ops::cbrt(stroke.density);
    let internode = habit.internode_m.min(0.45 * mean).max(length / 400.0) / finer;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "4 to 500, 4 to 600")]
    let (rounds, markers) = (
        (0.8 * length / internode + 4.0).ceil().clamp(4.0, 500.0) as u32,
        (60.0 * stroke.density).round().clamp(24.0, 600.0) as u32,
    );
    let ahead = geom::point_at3(&points, 2.0 * internode).unwrap_or(points[1]);
    let heading = (ahead - start).normalize_or(DVec3::Y);
    let spec = GuidedSpec {
        rounds,
        markers,
        internode_m: internode.clamp(1e-4, 1e3),
        near: 1.0,
        far: 4.0,
        lambda: 0.6,
        branch_angle_deg: habit.angle_deg,
        most_per_shoot: 2,
        tropisms: vec![Tropism { strength: 0.05, ..Tropism::UPWARDS }],
        strokes: vec![BrushStroke { points, radius_m: radii, pull: 1.0 }],
        max_joints: 60_000,
        ..GuidedSpec::default()
    };
    let own = own_seed(draft, seed.child(BRUSH).child(draft.branches[host].key), start + heading);
    let (hosts, from, out) = out_of_bark(draft, at, heading);
    let bud = StartBud { joint: out, heading, wakes: 0 };
    let grown = guide_from(from, &[bud], bench.obstacles, &spec, own, bench.run, &mut unread())?;
    if grown.skeleton.len() < 4 {
        return Err(Why::NothingGrew.into());
    }
    let made = graft_all(draft, &hosts, &grown.skeleton, &habit, Pipes::default(), own, bench)?;
    dress(draft, &habit, bench)?;
    Ok(Changed { added: made.len(), by_likeness, ..Changed::default() })
}

/// Finds the shoot nearest to a point.
fn nearest_shoot(draft: &Draft, p: DVec3, within_m: f64) -> Result<usize, Why> {
    let shoots = draft.branches.iter().enumerate().filter(|(_, b)| b.alive && b.is_shoot());
    let best = shoots
        .map(|(i, b)| (geom::nearest_on_polyline3(&b.points, p).0, i))
        .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    best.filter(|(d, _)| *d <= within_m).map(|(_, i)| i).ok_or(Why::NothingNear { within_m })
}
