//! Space colonisation: branches grow towards their nearest attraction points.
//!
//! `roots + attractors -> Skeleton` (Runions, Lane and Prusinkiewicz 2007; Yang et al. 2019, Eq 1 and 2)

use base::{Counted, Report, Run};
use glam::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::envelope::Crown;
use crate::error::{GrowthError, usable};
use crate::field::{Change, Field, NOBODY};
use crate::{JointId, Obstacles, Skeleton, Tropism};

/// Settings of the growth towards attraction points.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ColonizeSpec {
    /// Distance `d_i` within which a joint perceives a point, metres, above 0, default 1.
    #[schemars(range(min = 1e-6, max = 1e6), extend("x-unit" = "m"))]
    pub attraction_m: f64,
    /// Distance `d_k` at which a point is consumed, metres, above 0 and at most `attraction_m` (otherwise that is
    /// raised to it, with a warning), default 0.4.
    #[schemars(range(min = 1e-6, max = 1e6), extend("x-unit" = "m"))]
    pub kill_m: f64,
    /// Length D of one step, metres; default half of `kill_m`. Above twice `kill_m`, points can be stepped over.
    #[schemars(range(min = 1e-6, max = 1e6), extend("x-unit" = "m"))]
    pub step_m: Option<f64>,
    /// Other directions of growth: light, gravity, wind. Default none.
    pub tropisms: Vec<Tropism>,
    /// Share of the last direction kept in each step, 0 to 10, default 0.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub inertia: f64,
    /// Whether a point steers one step before it is consumed, as in Yang et al. (2019), instead of being consumed as
    /// soon as a joint comes near (Runions). Needed if `kill_m` is near `attraction_m`: otherwise hardly any point
    /// steers. Default false.
    pub steer_before_kill: bool,
    /// Growth stops, with a warning, at this many joints; 1 to 2^31, default 4 million.
    #[schemars(range(min = 1, max = 2_147_483_648_u64))]
    pub max_joints: u32,
}

spec::schemas!(ColonizeSpec => crate::TreeSpec, "/$defs/ColonizeSpec");

impl Default for ColonizeSpec {
    fn default() -> Self {
        Self {
            attraction_m: 1.0,
            kill_m: 0.4,
            step_m: None,
            tropisms: Vec::new(),
            inertia: 0.0,
            steer_before_kill: false,
            max_joints: 4_000_000,
        }
    }
}

/// Fate of an attraction point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointFate {
    /// Consumed by a joint.
    Reached(JointId),
    /// Not reached: too far from every joint, or hidden behind obstacles.
    Unreached,
    /// It lies in the obstacle of this index, or in the clearance of one (`None`).
    Buried(Option<usize>),
    /// It is not a finite point within 1e6 m.
    Unusable,
}

/// Result of colonisation.
#[derive(Clone, Debug, PartialEq)]
pub struct Colonized {
    /// The joints, those given first.
    pub skeleton: Skeleton,
    /// Fate of each attraction point, in the order given.
    pub fates: Vec<PointFate>,
    /// Rounds of growth, including those of the trunk.
    pub rounds: u32,
}

/// The checked numbers of a spec.
#[derive(Clone, Debug)]
struct Steps {
    attraction: f64,
    kill: f64,
    step: f64,
    pull: DVec3,
    inertia: f64,
    late: bool,
    most: usize,
}

impl ColonizeSpec {
    fn check(&self, report: &mut Report) -> Result<Steps, GrowthError> {
        spec::check(self)?;
        let (kill, mut attraction) = (self.kill_m, self.attraction_m);
        if kill > attraction {
            base::warn!(
                report,
                "attraction-raised",
                { attraction = attraction, kill = kill },
                "attraction distance {attraction} m is below the kill distance: {kill} m was used for both"
            );
            attraction = kill;
        }
        let step = self.step_m.unwrap_or(0.5 * kill);
        let pull = Tropism::sum(&self.tropisms)?;
        if step > 2.0 * kill {
            base::warn!(
                report,
                "step-long",
                { step = step, kill = kill },
                "steps of {step} m can pass points by, which are consumed within {kill} m only"
            );
        }
        Ok(Steps {
            attraction,
            kill,
            step,
            pull,
            inertia: self.inertia,
            late: self.steer_before_kill,
            most: self.max_joints as usize,
        })
    }
}

/// Grows trees from `roots` until every attraction point is consumed or cannot be reached.
///
/// `roots`: one tree each; they compete. `attractors`: any points; those that are not finite or lie in an obstacle are
/// left out. Guaranteed: it ends; every point has a [`PointFate`]; a clean `validate()`; no joint in an obstacle or its
/// clearance; the same bits everywhere. If growth stalls (a joint is pulled equally to two sides), the joint grows
/// straight to its nearest point. A root that perceives nothing first grows a trunk: up, then to the nearest point. Not
/// guaranteed: that all points are reached. Cost: about linear in points and joints.
///
/// # Errors
/// [`GrowthError`]: numbers out of range, no roots, a root in an obstacle, cancelled.
///
/// ```
/// use base::{Counted, Report, Run};
/// use glam::DVec3;
/// use growth::{ColonizeSpec, PointFate, Obstacles, colonize};
/// let attractors = [DVec3::new(1.0, 2.0, 0.0), DVec3::new(-1.0, 2.0, 0.0)];
/// let spec = ColonizeSpec { attraction_m: 1.5, kill_m: 0.2, ..ColonizeSpec::default() };
/// let none = Obstacles::none();
/// let tree = colonize(&[DVec3::ZERO], &attractors, &none, &spec, &Run::plain(), &mut Report::default())?;
/// assert!(tree.fates.iter().all(|f| matches!(f, PointFate::Reached(_))));
/// # Ok::<(), growth::GrowthError>(())
/// ```
pub fn colonize(
    roots: &[DVec3],
    attractors: &[DVec3],
    obstacles: &Obstacles,
    spec: &ColonizeSpec,
    run: &Run<'_>,
    report: &mut Report,
) -> Result<Colonized, GrowthError> {
    colonize_from(plant_roots(roots, obstacles, run)?, attractors, obstacles, spec, run, report)
}

/// Makes the skeleton of roots alone.
pub(crate) fn plant_roots(
    roots: &[DVec3],
    obstacles: &Obstacles,
    run: &Run<'_>,
) -> Result<Skeleton, GrowthError> {
    run.budget.check(Counted::Roots, roots.len() as u64, "give fewer roots")?;
    if roots.is_empty() {
        return Err(GrowthError::NoRoots);
    }
    let mut skeleton = Skeleton::default();
    for (root, &at) in roots.iter().enumerate() {
        if !usable(at) {
            return Err(GrowthError::Root { root });
        }
        if let Some(obstacle) = obstacles.inside(at) {
            let name = obstacles.name(obstacle);
            return Err(GrowthError::RootInObstacle { root, obstacle, name });
        }
        #[expect(clippy::cast_possible_truncation, reason = "fewer roots than joints")]
        skeleton.push_root(at, root as u32);
    }
    Ok(skeleton)
}

/// Grows trunks and limbs along the lines that crowns drew, before anything else.
pub(crate) fn grow_frame(
    skeleton: Skeleton,
    crowns: &[Crown],
    roots: &[DVec3],
    obstacles: &Obstacles,
    step: f64,
    run: &Run<'_>,
) -> Result<Skeleton, GrowthError> {
    let of = |(root, crown): (&DVec3, &Crown)| crown.lines.iter().map(|p| *root + *p).collect::<Vec<_>>();
    let lines: Vec<DVec3> = roots.iter().zip(crowns.iter().cycle()).flat_map(of).collect();
    if lines.is_empty() {
        return Ok(skeleton);
    }
    // As narrow as lines can be followed: no branch may cut across to the next limb.
    let spec = ColonizeSpec {
        attraction_m: 2.4 * step,
        kill_m: 1.05 * step,
        step_m: Some(step),
        ..ColonizeSpec::default()
    };
    let part = (0.0, 0.05 * crate::GROWN);
    // Warnings about points in obstacles are dropped here.
    let mut told = Report::default();
    Ok(colonize_part(skeleton, &lines, obstacles, &spec, part, run, &mut told)?.skeleton)
}

/// Grows a bole from a root straight up, around obstacles, to a height, and returns its top.
///
/// # Errors
/// [`GrowthError::OverBudget`].
pub(crate) fn grow_bole(
    skeleton: &mut Skeleton,
    root: JointId,
    height_m: f64,
    step_m: f64,
    obstacles: &Obstacles,
    run: &Run<'_>,
) -> Result<JointId, GrowthError> {
    let steps = height_m / step_m;
    run.budget.check_estimate(
        Counted::Course,
        steps,
        "make internode_m longer or put the envelope nearer to the root",
    )?;
    let all = skeleton.len() as f64 + steps;
    run.budget.check_estimate(Counted::Joints, all, "make internode_m longer or give fewer roots")?;
    let (mut top, mut left) = (root, height_m);
    while left > 0.0 {
        let at = skeleton.position[top.index()];
        let step = step_m.min(left.max(0.1 * step_m));
        let Some(to) =
            (if obstacles.is_empty() { Some(DVec3::Y) } else { obstacles.steer(at, DVec3::Y, step) })
        else {
            break;
        };
        top = skeleton.push(at + to * step, top, 0);
        left -= step;
    }
    Ok(top)
}

/// As [`colonize`], from an existing skeleton: its joints stay as they are, and all may grow on.
///
/// Later life cycles, and branches after pruning, grow in this way.
///
/// # Errors
/// As [`colonize`].
pub fn colonize_from(
    skeleton: Skeleton,
    attractors: &[DVec3],
    obstacles: &Obstacles,
    spec: &ColonizeSpec,
    run: &Run<'_>,
    report: &mut Report,
) -> Result<Colonized, GrowthError> {
    colonize_part(skeleton, attractors, obstacles, spec, (0.0, 1.0), run, report)
}

/// As [`colonize_from`], as the part of a computation between two shares of it.
pub(crate) fn colonize_part(
    skeleton: Skeleton,
    attractors: &[DVec3],
    obstacles: &Obstacles,
    spec: &ColonizeSpec,
    part: (f64, f64),
    run: &Run<'_>,
    report: &mut Report,
) -> Result<Colonized, GrowthError> {
    let steps = spec.check(report)?;
    if skeleton.is_empty() {
        return Err(GrowthError::NoRoots);
    }
    let started = run.clock.now_ms();
    run.budget.check(Counted::Points, attractors.len() as u64, "give fewer attraction points")?;
    let mut fates = vec![PointFate::Unreached; attractors.len()];
    for (fate, &p) in fates.iter_mut().zip(attractors) {
        if !usable(p) {
            *fate = PointFate::Unusable;
        } else if !obstacles.is_empty() && !obstacles.free(p) {
            *fate = PointFate::Buried(obstacles.inside(p));
        }
    }
    sane_step(&skeleton, attractors, &fates, steps.step)?;
    let free: Vec<bool> = fates.iter().map(|f| *f == PointFate::Unreached).collect();
    let field = Field::new(attractors, &free, steps.attraction);
    let birth = skeleton.age();
    let mut colony = Colony {
        load: Load::new(&skeleton),
        skeleton,
        field,
        fates,
        obstacles,
        steps,
        birth,
        fresh: vec![],
        doomed: vec![],
    };
    colony.settle(run)?;
    colony.grow(part, run, report)?;
    let rounds = colony.birth - birth;
    let Colony { skeleton, fates, .. } = colony;
    tell(&fates, report);
    report.book("grow", run.clock.now_ms() - started);
    debug_assert_eq!(skeleton.validate().next(), None, "a grown skeleton is sound");
    Ok(Colonized { skeleton, fates, rounds })
}

/// Cuts off `joint` and all that grew from it, and lets the tree grow into the freed room.
///
/// `grown` and `attractors`: the result of [`colonize`] and its input. Guaranteed: the remaining joints stay in place;
/// the points that the cut branch had consumed attract again, all others do not.
///
/// # Errors
/// As [`colonize`].
///
/// ```
/// use base::{Counted, Report, Run};
/// use glam::DVec3;
/// use growth::{ColonizeSpec, JointId, Obstacles, colonize, regrow};
/// let points = [DVec3::new(1.0, 1.0, 0.0), DVec3::new(-1.0, 1.0, 0.0)];
/// let (spec, none) = (ColonizeSpec { attraction_m: 3.0, ..ColonizeSpec::default() }, Obstacles::none());
/// let (run, mut report) = (Run::plain(), Report::default());
/// let tree = colonize(&[DVec3::ZERO], &points, &none, &spec, &run, &mut report)?;
/// let again = regrow(&tree, JointId::new(3), &points, &none, &spec, &run, &mut report)?;
/// assert_eq!(again.skeleton.position[..3], tree.skeleton.position[..3]);
/// # Ok::<(), growth::GrowthError>(())
/// ```
pub fn regrow(
    grown: &Colonized,
    joint: JointId,
    attractors: &[DVec3],
    obstacles: &Obstacles,
    spec: &ColonizeSpec,
    run: &Run<'_>,
    report: &mut Report,
) -> Result<Colonized, GrowthError> {
    let (left, new_id) = grown.skeleton.keep_mapped(|j| j != joint.index());
    let mut fates = grown.fates.clone();
    let mut freed = Vec::new();
    for (i, fate) in fates.iter_mut().enumerate() {
        if let PointFate::Reached(j) = *fate {
            match new_id.get(j.index()).copied().flatten() {
                Some(now) => *fate = PointFate::Reached(now),
                None => freed.push(i),
            }
        }
    }
    let points: Vec<DVec3> = freed.iter().filter_map(|&i| attractors.get(i).copied()).collect();
    let again = colonize_from(left, &points, obstacles, spec, run, report)?;
    for (&i, &fate) in freed.iter().zip(&again.fates) {
        fates[i] = fate;
    }
    Ok(Colonized { fates, ..again })
}

/// Rejects steps that leap far over everything and make no tree.
fn sane_step(
    skeleton: &Skeleton,
    points: &[DVec3],
    fates: &[PointFate],
    step_m: f64,
) -> Result<(), GrowthError> {
    let free = points.iter().zip(fates).filter(|(_, f)| **f == PointFate::Unreached).map(|(p, _)| p);
    let all = skeleton.position.iter().chain(free);
    let (lo, hi) = all.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), &p| (lo.min(p), hi.max(p)));
    let space_m = (lo.distance(hi) * 1000.0).round() / 1000.0;
    // Ten times: a tree of a single step that overshoots is odd, but harmless.
    let sane = step_m <= 10.0 * space_m || space_m <= 0.0;
    if sane { Ok(()) } else { Err(GrowthError::StepTooLong { step_m, space_m }) }
}

fn tell(fates: &[PointFate], report: &mut Report) {
    let count = |f: fn(&PointFate) -> bool| fates.iter().filter(|x| f(x)).count();
    let n = fates.len();
    let lost = count(|f| *f == PointFate::Unreached);
    if lost > 0 {
        base::warn!(
            report,
            "attractors-unreached",
            { count = lost, all = n },
            "{count} of {all} attraction points could not be reached"
        );
    }
    let buried = count(|f| matches!(f, PointFate::Buried(_)));
    if buried > 0 {
        base::warn!(
            report,
            "attractors-buried",
            { count = buried, all = n },
            "{count} of {all} attraction points lie in obstacles"
        );
    }
    let bad = count(|f| *f == PointFate::Unusable);
    if bad > 0 {
        base::warn!(
            report,
            "attractors-unusable",
            { count = bad, all = n },
            "{count} of {all} attraction points are no finite points within 1e6 m"
        );
    }
}

/// The points that have a joint as their nearest; stored together, because they change together.
#[derive(Clone, Copy, Default)]
struct Pull {
    /// Sum of unit vectors to them.
    sum: DVec3,
    count: u32,
    queued: bool,
}

/// The pull on each joint, and the joints whose pull has changed since they last grew.
struct Load {
    pulls: Vec<Pull>,
    queue: Vec<u32>,
    /// Children as lists: a joint never grows the same child twice.
    first: Vec<u32>,
    next: Vec<u32>,
}

impl Load {
    fn new(skeleton: &Skeleton) -> Self {
        let n = skeleton.len();
        let mut load = Self {
            pulls: vec![Pull::default(); n],
            queue: Vec::with_capacity(256),
            first: vec![NOBODY; n],
            next: vec![NOBODY; n],
        };
        for (j, parent) in skeleton.parent.iter().enumerate() {
            if let Some(p) = parent {
                load.adopt(p.index(), JointId::new(j).raw());
            }
        }
        load
    }

    fn add_joint(&mut self, parent: usize, joint: u32) {
        self.pulls.push(Pull::default());
        self.first.push(NOBODY);
        self.next.push(NOBODY);
        self.adopt(parent, joint);
    }

    fn adopt(&mut self, parent: usize, joint: u32) {
        self.next[joint as usize] = self.first[parent];
        self.first[parent] = joint;
    }

    /// Removes a point that pulled with this unit vector from a joint.
    fn lose(&mut self, joint: u32, pulled: DVec3) {
        let pull = &mut self.pulls[joint as usize];
        pull.count -= 1;
        // Without points the sum is exactly zero, not the rounding error of many additions.
        pull.sum = if pull.count == 0 { DVec3::ZERO } else { pull.sum - pulled };
        if !core::mem::replace(&mut pull.queued, true) {
            self.queue.push(joint);
        }
    }

    /// Adds a point in that direction to a joint.
    fn gain(&mut self, joint: u32, pulls: DVec3) {
        let pull = &mut self.pulls[joint as usize];
        pull.count += 1;
        pull.sum += pulls;
        if !core::mem::replace(&mut pull.queued, true) {
            self.queue.push(joint);
        }
    }
}

fn towards(from: DVec3, to: DVec3) -> DVec3 {
    (to - from).normalize_or_zero()
}

struct Colony<'a> {
    skeleton: Skeleton,
    field: Field,
    load: Load,
    fates: Vec<PointFate>,
    obstacles: &'a Obstacles,
    steps: Steps,
    birth: u32,
    /// Joints of this round that have not been offered to the points yet.
    fresh: Vec<u32>,
    /// Points that steer once more before they are consumed.
    doomed: Vec<u32>,
}

impl Colony<'_> {
    /// Assigns the points to the existing joints, and grows a trunk from a root that perceives none.
    fn settle(&mut self, run: &Run<'_>) -> Result<(), GrowthError> {
        for j in 0..self.skeleton.len() {
            if j % 1024 == 0 {
                run.cancel.check()?;
            }
            self.offer(JointId::new(j).raw());
        }
        self.settle_points();
        let children = self.skeleton.children();
        let lonely = |j: &usize| self.skeleton.parent[*j].is_none() && children[*j] == 0;
        let roots: Vec<usize> = (0..self.skeleton.len()).filter(lonely).collect();
        let started = self.birth;
        let mut last = started;
        for root in roots {
            run.cancel.check()?;
            self.birth = started;
            self.grow_trunk(JointId::new(root).raw(), run)?;
            last = last.max(self.birth);
        }
        self.birth = last;
        Ok(())
    }

    /// Grows up to the height of the nearest point, then towards it, until the tip perceives something.
    fn grow_trunk(&mut self, root: u32, run: &Run<'_>) -> Result<(), GrowthError> {
        let from = self.skeleton.position[root as usize];
        let nearest = |p: DVec3| {
            let all = self.field.iter().map(|(_, q, ..)| q);
            all.reduce(|a, b| if b.distance_squared(p) < a.distance_squared(p) { b } else { a })
        };
        if self.load.pulls[root as usize].count > 0 {
            return Ok(());
        }
        let Some(goal) = nearest(from) else { return Ok(()) };
        let straight = (from.distance(goal) - self.steps.attraction) / self.steps.step;
        run.budget.check_estimate(
            Counted::Course,
            straight,
            "make step_m (or kill_m, of which it is half) longer or put the attraction points nearer to the root",
        )?;
        // Three times the straight distance leaves room to go up first and around obstacles.
        let budget = 3.0 * from.distance(goal) / self.steps.step + 8.0;
        let (mut tip, mut heading, mut steps) = (root, DVec3::Y, 0.0);
        while self.load.pulls[tip as usize].count == 0
            && steps < budget
            && self.skeleton.len() < self.steps.most
        {
            let at = self.skeleton.position[tip as usize];
            let below = at.y + 0.5 * self.steps.attraction < goal.y;
            let aim = if below { DVec3::Y } else { (heading + towards(at, goal)).normalize_or(DVec3::Y) };
            self.birth += 1;
            let Some(next) = self.push(tip, aim, self.steps.step) else { break };
            let Some(&p) = self.skeleton.position.get(next as usize) else { break };
            heading = towards(at, p);
            tip = next;
            steps += 1.0;
            self.offer_fresh();
        }
        Ok(())
    }

    fn grow(&mut self, part: (f64, f64), run: &Run<'_>, report: &mut Report) -> Result<(), GrowthError> {
        let all = self.field.alive().max(1) as f64;
        // Twice the rounds to the farthest perceived point: after that growth goes in circles.
        let patience = 2.0 * self.steps.attraction / self.steps.step + 2.0;
        let mut quiet = 0.0;
        let mut queue = Vec::with_capacity(self.load.queue.capacity());
        while self.field.alive() > 0 {
            run.cancel.check()?;
            run.cancel.reached(part.1 - (part.1 - part.0) * (self.field.alive() as f64 / all));
            if self.skeleton.len() >= self.steps.most {
                let n = self.skeleton.len();
                base::warn!(
                    report,
                    "growth-stopped",
                    { joints = n },
                    "growth stopped at {joints} joints, the most allowed"
                );
                break;
            }
            run.budget.check(
                Counted::Joints,
                self.skeleton.len() as u64,
                "make step_m or kill_m longer, give fewer points, or lower max_joints",
            )?;
            self.birth += 1;
            let before = self.field.alive();
            core::mem::swap(&mut queue, &mut self.load.queue);
            for &joint in &queue {
                self.load.pulls[joint as usize].queued = false;
                self.sprout(joint);
            }
            queue.clear();
            self.consume_doomed();
            if self.fresh.is_empty() || quiet > patience {
                if !self.go_straight() {
                    self.birth -= 1;
                    break;
                }
                quiet = 0.0;
            } else {
                self.offer_fresh();
            }
            quiet = if self.field.alive() < before { 0.0 } else { quiet + 1.0 };
            self.field.narrow();
        }
        Ok(())
    }

    /// Grows one step along the mean direction of the points that are nearest to this joint (Eq 1 and 2).
    fn sprout(&mut self, joint: u32) {
        let j = joint as usize;
        let Pull { sum, count, .. } = self.load.pulls[j];
        if count == 0 || self.skeleton.len() >= self.steps.most {
            return;
        }
        let mean = sum.normalize_or_zero();
        let inertia = self.steps.inertia;
        let last = if inertia > 0.0 { self.skeleton.heading(JointId::new(j)) * inertia } else { DVec3::ZERO };
        if let Some(direction) = (mean + last + self.steps.pull).try_normalize() {
            self.push(joint, direction, self.steps.step);
        }
    }

    /// Adds a child one step away, around obstacles, unless it exists already; returns its row.
    fn push(&mut self, parent: u32, wish: DVec3, step: f64) -> Option<u32> {
        let from = self.skeleton.position[parent as usize];
        let direction =
            if self.obstacles.is_empty() { wish } else { self.obstacles.steer(from, wish, step)? };
        let at = from + direction * step;
        let twin2 = 1e-6 * self.steps.step * self.steps.step;
        let mut child = self.load.first[parent as usize];
        while child != NOBODY {
            if self.skeleton.position[child as usize].distance_squared(at) < twin2 {
                return None;
            }
            child = self.load.next[child as usize];
        }
        let joint = self.skeleton.push(at, JointId::new(parent as usize), self.birth).raw();
        self.load.add_joint(parent as usize, joint);
        self.fresh.push(joint);
        Some(joint)
    }

    /// Consumes the points that have steered their last step.
    fn consume_doomed(&mut self) {
        let mut doomed = core::mem::take(&mut self.doomed);
        for &id in &doomed {
            if let Some((owner, pull)) = self.field.give_up(id) {
                self.fates[id as usize] = PointFate::Reached(JointId::new(owner as usize));
                self.load.lose(owner, pull);
            }
        }
        doomed.clear();
        self.doomed = doomed;
    }

    fn offer_fresh(&mut self) {
        let mut fresh = core::mem::take(&mut self.fresh);
        for &joint in &fresh {
            self.offer(joint);
        }
        fresh.clear();
        self.fresh = fresh;
        self.settle_points();
    }

    /// Lets points that are nearer to this joint than to their own switch to it.
    fn offer(&mut self, joint: u32) {
        let Self { field, skeleton, obstacles, .. } = self;
        let at = skeleton.position[joint as usize];
        if obstacles.is_empty() {
            field.offer(at, joint, |_| true);
        } else {
            field.offer(at, joint, |place| !obstacles.blocks(at, place));
        }
    }

    /// Ends a round: moves the pull of points that changed their joint, and consumes those that were reached.
    fn settle_points(&mut self) {
        let Self { field, load, skeleton, fates, steps, doomed, .. } = self;
        let kill2 = steps.kill * steps.kill;
        field.settle(if steps.late { -1.0 } else { kill2 }, |change: Change| {
            if change.from != NOBODY {
                load.lose(change.from, change.pull);
            }
            if change.killed {
                fates[change.id as usize] = PointFate::Reached(JointId::new(change.to as usize));
                return DVec3::ZERO;
            }
            let way = change.place - skeleton.position[change.to as usize];
            let pull = if change.d2 > 0.0 { way * change.d2.sqrt().recip() } else { DVec3::ZERO };
            load.gain(change.to, pull);
            if steps.late && change.d2 <= kill2 {
                doomed.push(change.id);
            }
            pull
        });
    }

    /// Breaks a stall: every joint with points grows straight to the nearest of them. A point that does not come nearer
    /// is given up, so that each call makes progress. Returns whether there was anything to do.
    fn go_straight(&mut self) -> bool {
        self.offer_fresh();
        let mut goals: Vec<(u32, f64, u32, DVec3)> = self
            .field
            .iter()
            .filter(|&(_, _, owner, _)| owner != NOBODY)
            .map(|(id, place, owner, d2)| (owner, d2, id, place))
            .collect();
        base::sort_by(&mut goals, |a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(&b.2)));
        goals.dedup_by_key(|g| g.0);
        for &(owner, d2, _, place) in &goals {
            let at = self.skeleton.position[owner as usize];
            let step = self.steps.step.min(d2.sqrt());
            if self.skeleton.len() < self.steps.most && step > 0.0 {
                self.push(owner, towards(at, place), step);
            }
        }
        self.offer_fresh();
        for &(owner, before, id, _) in &goals {
            if self.field.distance2(id).is_some_and(|now| now >= before)
                && let Some((_, pull)) = self.field.give_up(id)
            {
                self.load.lose(owner, pull);
            }
        }
        !goals.is_empty()
    }
}

#[cfg(test)]
#[path = "colonize_tests.rs"]
mod tests;
