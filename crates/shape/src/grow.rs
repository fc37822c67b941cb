//! A shoot that grows by itself while it is held: the automatic growth of the VR paper.

use base::Seed;
use base::ops::{self, PI};
use glam::DVec3;
use growth::{Growing, GrowthStep, Guided, GuidedChange, GuidedSpec, Skeleton, StartBud};

use crate::bench::{Bench, Stop};
use crate::draft::{At, Branch, Draft};
use crate::edit::GrowFrom;
use crate::graft::{Hosts, graft_all, out_of_bark};
use crate::habit::Habit;
use crate::leaves::dress;
use crate::outcome::{Changed, Why};
use crate::pipes::Pipes;
use crate::sketch_branch::own_seed;

const GROW: u64 = 0x6772_6f77;
/// Most markers that the buds of a held shoot test before it stops growing: a larger shoot would be too slow in the
/// hand, and one over the budget would be refused. Some 15,000 joints, or 3,000 branches.
const MOST_LOOKS: u64 = 1_600_000;
/// A shoot that starts nearer to the tip of a branch than this share of its length continues the branch.
const TIP: f64 = 0.02;

/// The requested growth.
pub(crate) struct Wish<'a> {
    pub(crate) from: &'a GrowFrom,
    pub(crate) towards: Option<DVec3>,
    pub(crate) rounds: u32,
    pub(crate) changes: &'a [GuidedChange],
}

/// Growth kept from one round to the next while a shoot is held, so that more rounds cost only themselves.
///
/// It belongs to one plant with its obstacles; other differences are detected.
#[derive(Clone, Debug, Default)]
pub struct KeptGrowth(Option<Box<Sprout>>);

/// The last growth and its start.
#[derive(Clone, Debug)]
struct Sprout {
    from: Skeleton,
    bud: StartBud,
    seed: Seed,
    growing: Growing,
}

impl KeptGrowth {
    /// Returns the number of rounds kept; 0 where nothing is.
    pub fn rounds(&self) -> u32 {
        self.0.as_ref().map_or(0, |s| s.growing.rounds())
    }

    /// Returns the same tree as grown from its start, but reuses earlier growth.
    fn grow(
        &mut self,
        (from, bud): (Skeleton, StartBud),
        spec: &GuidedSpec,
        seed: Seed,
        bench: &Bench<'_>,
    ) -> Result<Guided, Stop> {
        let mut kept = self.0.take().filter(|s| (&s.from, s.bud, s.seed) == (&from, bud, seed));
        let goes_on = match &mut kept {
            Some(kept) => kept.growing.goes_on_as(spec)?,
            None => false,
        };
        let mut sprout = match kept.filter(|_| goes_on) {
            Some(kept) => kept,
            None => {
                let growing =
                    Growing::from_wood(from.clone(), &[bud], bench.obstacles, spec, seed, bench.run)?;
                Box::new(Sprout { from, bud, seed, growing })
            }
        };
        let growing = &mut sprout.growing;
        while growing.rounds() < spec.rounds && growing.looks() < MOST_LOOKS {
            if growing.step(bench.run)? != GrowthStep::Goes {
                break;
            }
        }
        Ok(self.0.insert(sprout).growing.finish())
    }
}

/// Grows a shoot. Cost: linear in the plant, and in the growth beyond what is kept.
pub(crate) fn grow(
    draft: &mut Draft,
    wish: &Wish<'_>,
    seed: Seed,
    kept: &mut KeptGrowth,
    bench: &Bench<'_>,
) -> Result<Changed, Stop> {
    let habit = bench.habit(draft);
    let spec = GuidedSpec {
        rounds: wish.rounds,
        internode_m: habit.internode_m.clamp(1e-4, 1e3),
        near: 1.0,
        far: 4.0,
        branch_angle_deg: habit.angle_deg,
        most_per_shoot: 2,
        max_joints: 60_000,
        changes: wish.changes.to_vec(),
        ..GuidedSpec::default()
    };
    let start = match wish.from {
        GrowFrom::Branch { axis, at } => {
            let (host, by_likeness) = axis.find_in(draft)?;
            on_wood(draft, host, *at, wish.towards, &habit, by_likeness)
        }
        GrowFrom::Ground(foot) => on_ground(draft, *foot, &habit, bench)?,
    };
    let own = own_seed(draft, seed.child(GROW), start.place);
    if let Some(b) = start.stem {
        draft.branches[b].key = own.number();
    }
    let bud = StartBud { joint: start.joint, heading: start.heading, wakes: 0 };
    let grown = kept.grow((start.from, bud), &spec, own, bench)?;
    if grown.skeleton.len() < start.least {
        return Err(Why::NothingGrew.into());
    }
    let made = graft_all(draft, &start.hosts, &grown.skeleton, &habit, Pipes::default(), own, bench)?;
    dress(draft, &habit, bench)?;
    let added = made.len() + usize::from(start.stem.is_some());
    Ok(Changed { added, by_likeness: start.by_likeness, ..Changed::default() })
}

/// Start of a shoot.
struct Start {
    hosts: Hosts,
    /// The hosts, and the wood between them and the bud.
    from: Skeleton,
    joint: growth::JointId,
    heading: DVec3,
    place: DVec3,
    /// Least number of joints that counts as growth.
    least: usize,
    /// A stem made for the shoot.
    stem: Option<usize>,
    by_likeness: bool,
}

/// Starts out of the bark of a branch, at the angle of the plant's branches; at its tip, continues it.
fn on_wood(
    draft: &mut Draft,
    host: usize,
    at: f64,
    towards: Option<DVec3>,
    habit: &Habit,
    by_likeness: bool,
) -> Start {
    let tip = at > 1.0 - TIP;
    let node = draft.node_at(host, if tip { 1.0 } else { at });
    let branch = &draft.branches[host];
    let (place, along) = (branch.points[node], branch.tangent(node));
    let wanted = towards.filter(|t| t.is_finite()).unwrap_or(DVec3::Y);
    let side = (wanted - along * wanted.dot(along)).try_normalize();
    let side = side.unwrap_or_else(|| along.any_orthonormal_vector());
    let (sin, cos) = ops::sin_cos(habit.angle_deg * (PI / 180.0));
    let heading = if tip { along } else { along * cos + side * sin };
    let (hosts, mut from, mut joint) = out_of_bark(draft, At { branch: host, node }, heading);
    if tip {
        // There is no bark in front of the tip.
        (from, joint) = (hosts.skeleton.clone(), growth::JointId::new(0));
    }
    let least = from.len() + 1;
    Start { hosts, from, joint, heading, place: place + heading, least, stem: None, by_likeness }
}

/// Starts a new stem of one internode.
fn on_ground(draft: &mut Draft, foot: DVec3, habit: &Habit, bench: &Bench<'_>) -> Result<Start, Stop> {
    let first = foot + DVec3::Y * habit.internode_m;
    if !bench.obstacles.free(foot) || !bench.obstacles.free(first) {
        return Err(Why::NothingGrew.into());
    }
    let stems = draft.branches.iter().find(|b| b.alive && b.is_shoot() && b.bearer.is_none());
    let kind = stems.ok_or(Why::NoBranches)?.kind;
    let stem = draft.branches.len();
    draft.branches.push(Branch {
        kind,
        key: 0,
        source: None,
        colors: Vec::new(),
        bearer: None,
        points: vec![foot, first],
        radii: vec![habit.tip_m; 2],
        alive: true,
        fresh: true,
    });
    let hosts = Hosts::collect(draft, |i| i == stem);
    let from = hosts.skeleton.clone();
    let joint = growth::JointId::new(from.len() - 1);
    let least = from.len() + 1;
    let stem = Some(stem);
    Ok(Start { hosts, from, joint, heading: DVec3::Y, place: first, least, stem, by_likeness: false })
}
