//! Guided growth: buds that make their own markers, keep away from others' and follow a brush.
//!
//! `buds -> (markers in their cones -> directions, free space -> vigour -> shoots) x rounds -> Skeleton` (the VR paper)

mod cone;
mod room;
mod spec;

use base::ops::{self, PI};
use base::{Counted, Draw, Report, Run, Seed, map_indexed};
use glam::DVec3;

use self::spec::Numbers;
use crate::colonize::{grow_bole, plant_roots};
use crate::{GrowthError, JointId, Obstacles, Skeleton};
use cone::{Cone, Scratch, Stand, Sums};
use room::Room;

pub use self::spec::{BrushStroke, GuidedChange, GuidedSpec};

/// A bud from which growth starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StartBud {
    /// The joint that bears it.
    pub joint: JointId,
    /// Direction of growth; any length above 0.
    pub heading: DVec3,
    /// The round, from 0, in which it becomes active.
    pub wakes: u32,
}

/// Result of guided growth.
#[derive(Clone, Debug, PartialEq)]
pub struct Guided {
    /// The joints, those given first.
    pub skeleton: Skeleton,
    /// Markers made in all rounds.
    pub markers: usize,
    /// Buds that died for lack of room.
    pub died: usize,
    /// Rounds in which something grew.
    pub rounds: u32,
}

/// Grows a tree from each root; they compete.
///
/// Direction of a bud A with its own markers i and other buds' markers j in its cone, `w` Gaussian in the distance to
/// the markers' own bud (mean `(near + far) / 2`, deviation `(far - near) / 4`), in strokes by the distance to the
/// stroke: `V = sum w_i v_i + sum w_i k_s t_i - k_r sum w_j u_j + k_g W g`. A bud dies when buds older than it have
/// more markers in its cone than itself, or when V is shorter than a tenth of W. Vigour is shared as in Palubicki et
/// al. 2009, section 4.2, with free space in the place of light. Guaranteed: it ends; a clean `validate()`; no joint in
/// an obstacle; the same bits for any thread count. Cost: buds x markers of each round.
///
/// # Errors
/// [`GrowthError`]: numbers out of range, no roots, a root in an obstacle, cancelled.
///
/// ```
/// use base::{Report, Run, Seed};
/// use glam::DVec3;
/// use growth::{GuidedSpec, Obstacles, guide};
/// let (spec, run, none) = (GuidedSpec { rounds: 8, ..GuidedSpec::default() }, Run::plain(), Obstacles::none());
/// let tree = guide(&[DVec3::ZERO], &none, &spec, Seed::new(1), &run, &mut Report::default())?;
/// assert!(tree.skeleton.len() > 40 && tree.markers > 1000);
/// # Ok::<(), growth::GrowthError>(())
/// ```
pub fn guide(
    roots: &[DVec3],
    obstacles: &Obstacles,
    spec: &GuidedSpec,
    seed: Seed,
    run: &Run<'_>,
    report: &mut Report,
) -> Result<Guided, GrowthError> {
    Growing::plant(roots, obstacles, spec, seed, run)?.through(run, report)
}

/// As [`guide`], from existing wood: only `buds` grow, in the order given; earlier ones count as older.
///
/// An `envelope` is relative to the skeleton's roots. Buds of joints that do not exist are left out.
///
/// # Errors
/// As [`guide`].
pub fn guide_from(
    skeleton: Skeleton,
    buds: &[StartBud],
    obstacles: &Obstacles,
    spec: &GuidedSpec,
    seed: Seed,
    run: &Run<'_>,
    report: &mut Report,
) -> Result<Guided, GrowthError> {
    Growing::from_wood(skeleton, buds, obstacles, spec, seed, run)?.through(run, report)
}

#[derive(Clone, Copy, Debug)]
struct Bud {
    joint: u32,
    heading: DVec3,
    side: DVec3,
    /// Number of its joint along its axis, for phyllotaxis.
    rank: u32,
    /// Whether it continues the axis that its joint ends.
    terminal: bool,
    wakes: u32,
    key: Seed,
    lives: bool,
}

/// Perception of a bud in a round.
#[derive(Clone, Copy, Debug, Default)]
struct Look {
    direction: DVec3,
    free: f64,
    dies: bool,
}

/// Flow through a joint: free space on its way down, then vigour on its way up.
#[derive(Clone, Copy, Debug, Default)]
struct Flow {
    /// The gathered free space; then the vigour that reaches the main axis beyond the joint.
    all: f64,
    /// The part of the main axis; then the vigour for each unit of free space at its side.
    main: f64,
}

/// Buds of one job of a parallel map.
const GROUP: usize = 32;

/// State after a round.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GrowthStep {
    /// Some buds may grow on.
    Goes,
    /// No bud is alive.
    Ended,
    /// The limit of joints is reached; nothing was grown.
    Full,
}

/// Guided growth that can be inspected after every round, and continued with other numbers.
///
/// All changes, with their rounds, are part of the [record](Growing::record): growth from the record gives the same
/// tree.
///
/// ```
/// use base::{Report, Run, Seed};
/// use glam::DVec3;
/// use growth::{Growing, GuidedChange, GuidedSpec, Obstacles, guide};
/// let (spec, none, run, seed) = (GuidedSpec::default(), Obstacles::none(), Run::plain(), Seed::new(1));
/// let mut growing = Growing::plant(&[DVec3::ZERO], &none, &spec, seed, &run)?;
/// for round in 0..8 {
///     if round == 4 {
///         growing.change(GuidedChange { branch_angle_deg: Some(80.0), ..GuidedChange::default() }, &run)?;
///     }
///     growing.step(&run)?;
/// }
/// let record = growing.record();
/// let tree = growing.finish();
/// assert_eq!(tree, guide(&[DVec3::ZERO], &none, &record, seed, &run, &mut Report::default())?);
/// # Ok::<(), growth::GrowthError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Growing {
    skeleton: Skeleton,
    /// Whether each joint continues the axis of its parent.
    is_main: Vec<bool>,
    /// Number of joints that were given.
    given: usize,
    /// The living buds, the oldest first.
    buds: Vec<Bud>,
    scratch: Scratch,
    /// Flow through each joint; the memory is reused by the next round.
    flow: Vec<Flow>,
    room: Room,
    /// The original spec.
    asked: GuidedSpec,
    /// The spec with the changes so far, and without a list of changes.
    spec: GuidedSpec,
    numbers: Numbers,
    cone: Cone,
    seed: Seed,
    /// The next round.
    round: u32,
    grew: u32,
    /// The next change of the original spec.
    next_change: usize,
    markers_made: usize,
    died: usize,
}

/// Remedy if buds need too many markers.
const TOO_MANY: &str = "lower markers, rounds or alpha, or give fewer roots";

fn place_key(p: DVec3) -> u64 {
    p.x.to_bits() ^ p.y.to_bits().rotate_left(21) ^ p.z.to_bits().rotate_left(42)
}

/// Returns the room around the roots of a skeleton, and the numbers derived from a spec.
fn room_of(
    skeleton: &Skeleton,
    obstacles: &Obstacles,
    spec: &GuidedSpec,
    run: &Run<'_>,
) -> Result<(Room, Numbers), GrowthError> {
    let roots = skeleton.position.iter().zip(&skeleton.parent).filter(|(_, p)| p.is_none());
    let room = Room::new(spec, roots.map(|(p, _)| *p).collect(), obstacles, &run.budget)?;
    Ok((room, spec.check()?))
}

impl Growing {
    /// Plants a tree at each root; they compete.
    ///
    /// # Errors
    /// [`GrowthError`]: numbers out of range, no roots, a root in an obstacle, cancelled.
    pub fn plant(
        roots: &[DVec3],
        obstacles: &Obstacles,
        spec: &GuidedSpec,
        seed: Seed,
        run: &Run<'_>,
    ) -> Result<Self, GrowthError> {
        let mut skeleton = plant_roots(roots, obstacles, run)?;
        let (room, numbers) = room_of(&skeleton, obstacles, spec, run)?;
        let mut buds = Vec::new();
        for root in 0..skeleton.len() {
            let root = JointId::new(root);
            let top = grow_bole(&mut skeleton, root, room.foot(), spec.internode_m, obstacles, run)?;
            buds.push(StartBud { joint: top, heading: DVec3::Y, wakes: 0 });
        }
        Ok(Self::new(skeleton, &buds, room, spec, numbers, seed))
    }

    /// Starts from existing wood: only `buds` grow, in the order given; earlier ones count as older.
    ///
    /// An `envelope` is relative to the skeleton's roots. Buds of joints that do not exist are left out.
    ///
    /// # Errors
    /// As [`Growing::plant`].
    pub fn from_wood(
        skeleton: Skeleton,
        buds: &[StartBud],
        obstacles: &Obstacles,
        spec: &GuidedSpec,
        seed: Seed,
        run: &Run<'_>,
    ) -> Result<Self, GrowthError> {
        if skeleton.is_empty() {
            return Err(GrowthError::NoRoots);
        }
        let (room, numbers) = room_of(&skeleton, obstacles, spec, run)?;
        Ok(Self::new(skeleton, buds, room, spec, numbers, seed))
    }

    fn new(
        skeleton: Skeleton,
        buds: &[StartBud],
        room: Room,
        spec: &GuidedSpec,
        numbers: Numbers,
        seed: Seed,
    ) -> Self {
        let given = skeleton.len();
        let mut continued = vec![false; given];
        let is_main = skeleton.parent.iter().map(|p| match p {
            Some(p) => !core::mem::replace(&mut continued[p.index()], true),
            None => true,
        });
        let is_main: Vec<bool> = is_main.collect();
        let sound = buds.iter().filter(|b| b.joint.index() < given);
        let buds = sound.zip(0_u64..).map(|(b, i)| {
            let heading = b.heading.try_normalize().unwrap_or(DVec3::Y);
            let place = skeleton.position[b.joint.index()];
            Bud {
                joint: b.joint.raw(),
                heading,
                side: heading.any_orthonormal_vector(),
                rank: 0,
                terminal: !continued[b.joint.index()],
                wakes: b.wakes,
                key: seed.child(place_key(place)).child(i),
                lives: true,
            }
        });
        let buds: Vec<Bud> = buds.collect();
        Self {
            is_main,
            given,
            scratch: Scratch::default(),
            flow: Vec::new(),
            buds,
            skeleton,
            room,
            asked: spec.clone(),
            spec: GuidedSpec { changes: Vec::new(), ..spec.clone() },
            numbers,
            cone: Cone::new(spec, seed),
            seed,
            round: 0,
            grew: 0,
            next_change: 0,
            markers_made: 0,
            died: 0,
        }
    }

    /// Runs all requested rounds.
    fn through(mut self, run: &Run<'_>, report: &mut Report) -> Result<Guided, GrowthError> {
        let started = run.clock.now_ms();
        self.go_on(run, report)?;
        let grown = self.finish();
        report.book("grow", run.clock.now_ms() - started);
        Ok(grown)
    }

    /// Grows the requested rounds that are still missing, or until nothing grows any more.
    ///
    /// Guaranteed: the same tree, for any division into steps and calls.
    ///
    /// # Errors
    /// As [`Growing::step`].
    pub fn go_on(&mut self, run: &Run<'_>, report: &mut Report) -> Result<(), GrowthError> {
        while self.round < self.asked.rounds {
            match self.step(run)? {
                GrowthStep::Goes => {}
                GrowthStep::Ended => break,
                GrowthStep::Full => {
                    let (round, n) = (self.round, self.skeleton.len());
                    base::warn!(
                        report,
                        "growth-stopped",
                        { round = round, joints = n },
                        "growth stopped in round {round} at {joints} joints, the most allowed"
                    );
                    break;
                }
            }
        }
        Ok(())
    }

    /// Replaces the spec by another for which the growth so far is valid: one that differs only in its rounds, no fewer
    /// than were grown, and in changes of rounds still to come. Returns whether it did; if not, nothing changed.
    ///
    /// # Errors
    /// [`GrowthError`]: numbers out of range.
    ///
    /// ```
    /// use base::{Report, Run, Seed};
    /// use glam::DVec3;
    /// use growth::{Growing, GuidedChange, GuidedSpec, Obstacles, guide};
    /// let (none, run, seed) = (Obstacles::none(), Run::plain(), Seed::new(1));
    /// let mut spec = GuidedSpec { rounds: 5, ..GuidedSpec::default() };
    /// let mut growing = Growing::plant(&[DVec3::ZERO], &none, &spec, seed, &run)?;
    /// growing.go_on(&run, &mut Report::default())?;
    /// spec.rounds = 8;
    /// spec.changes.push(GuidedChange { round: 6, alpha: Some(4.0), ..GuidedChange::default() });
    /// assert!(growing.goes_on_as(&spec)?);
    /// growing.go_on(&run, &mut Report::default())?;
    /// let whole = guide(&[DVec3::ZERO], &none, &spec, seed, &run, &mut Report::default())?;
    /// assert_eq!(growing.finish(), whole);
    /// # Ok::<(), growth::GrowthError>(())
    /// ```
    pub fn goes_on_as(&mut self, spec: &GuidedSpec) -> Result<bool, GrowthError> {
        let plain = |s: &GuidedSpec| GuidedSpec { rounds: 0, changes: Vec::new(), ..s.clone() };
        let past = self.next_change;
        let same = self.round <= spec.rounds
            && spec.changes.get(..past) == Some(&self.asked.changes[..past])
            && spec.changes.get(past).is_none_or(|next| next.round >= self.round)
            && plain(spec) == plain(&self.asked);
        if same {
            spec.check()?;
            self.asked = spec.clone();
        }
        Ok(same)
    }

    /// Changes numbers from the next round on, and drops the changes in the original spec for later rounds.
    ///
    /// # Errors
    /// [`GrowthError`]: numbers out of range; then nothing changed.
    pub fn change(&mut self, change: GuidedChange, run: &Run<'_>) -> Result<(), GrowthError> {
        let change = GuidedChange { round: self.round, ..change };
        self.apply(&change, run)?;
        self.asked.changes.truncate(self.next_change);
        self.asked.changes.push(change);
        self.next_change += 1;
        Ok(())
    }

    fn apply(&mut self, change: &GuidedChange, run: &Run<'_>) -> Result<(), GrowthError> {
        let spec = change.applied(&self.spec);
        let numbers = spec.check()?;
        if change.strokes.is_some() {
            self.room.set_strokes(&spec.strokes, &run.budget)?;
        }
        if change.markers.is_some() || change.strokes.is_some() {
            self.cone = Cone::new(&spec, self.seed);
        }
        (self.spec, self.numbers) = (spec, numbers);
        Ok(())
    }

    /// Grows one round, however many were requested.
    ///
    /// Guaranteed: existing wood does not change, new joints come after it; the same bits for any thread count. Cost:
    /// living buds x markers, and linear in joints.
    ///
    /// # Errors
    /// [`GrowthError`]: cancelled, or over budget. Earlier growth stays.
    pub fn step(&mut self, run: &Run<'_>) -> Result<GrowthStep, GrowthError> {
        run.cancel.check()?;
        if self.skeleton.len() >= self.spec.max_joints as usize {
            return Ok(GrowthStep::Full);
        }
        run.budget.check(
            Counted::Joints,
            self.skeleton.len() as u64,
            "lower rounds, alpha or max_joints, or make internode_m longer",
        )?;
        while let Some(change) = self.asked.changes.get(self.next_change).filter(|c| c.round <= self.round) {
            self.apply(&change.clone(), run)?;
            self.next_change += 1;
        }
        let goes = self.grow(self.round, run)?;
        self.round += 1;
        if goes {
            self.grew = self.round;
        }
        Ok(if goes { GrowthStep::Goes } else { GrowthStep::Ended })
    }

    /// Returns the wood so far, including the twigs that [`finish`](Self::finish) sheds.
    pub const fn skeleton(&self) -> &Skeleton {
        &self.skeleton
    }

    /// Returns the number of buds that may grow on.
    pub const fn living(&self) -> usize {
        self.buds.len()
    }

    /// Returns the number of markers made so far: the measure of the cost of growth.
    pub const fn looks(&self) -> u64 {
        self.markers_made as u64
    }

    /// Returns the number of rounds so far.
    pub const fn rounds(&self) -> u32 {
        self.round
    }

    /// Returns the spec that grows the tree as it is now: the original one, with the changes until now and the number
    /// of rounds grown.
    pub fn record(&self) -> GuidedSpec {
        let changes = self.asked.changes.iter().filter(|c| c.round < self.round).cloned().collect();
        GuidedSpec { rounds: self.round, changes, ..self.asked.clone() }
    }

    /// Returns the tree as it is now, without the twigs that are shed at the end. It may grow on.
    pub fn finish(&self) -> Guided {
        let skeleton = self.shed();
        debug_assert_eq!(skeleton.validate().next(), None, "a grown skeleton is sound");
        Guided { skeleton, markers: self.markers_made, died: self.died, rounds: self.grew }
    }

    /// Grows one round; returns whether any bud may still grow.
    fn grow(&mut self, round: u32, run: &Run<'_>) -> Result<bool, GrowthError> {
        let awake = (0_u32..).zip(&self.buds).filter(|(_, bud)| bud.wakes <= round);
        let awake: Vec<u32> = awake.map(|(b, _)| b).collect();
        if awake.is_empty() {
            return Ok(!self.buds.is_empty());
        }
        let all = u64::from(self.spec.markers) * awake.len() as u64;
        run.budget.check(Counted::Points, all, TOO_MANY)?;
        run.budget.check(Counted::MarkerQueries, self.looks() + all, TOO_MANY)?;
        let stand = |&b: &u32| {
            let bud = &self.buds[b as usize];
            let at = self.skeleton.position[bud.joint as usize];
            Stand { at, heading: bud.heading, side: bud.side, key: bud.key.child(u64::from(round)) }
        };
        let grid = self.cone.grid(awake.iter().map(|b| stand(b).at));
        let groups = awake.len().div_ceil(GROUP);
        let mut batches = map_indexed(run.executor, groups, |g| {
            let of = &awake[g * GROUP..awake.len().min((g + 1) * GROUP)];
            self.cone.markers(of.iter().map(stand), &grid, &self.room)
        });
        run.cancel.check()?;
        let headings: Vec<DVec3> = awake.iter().map(|&b| self.buds[b as usize].heading).collect();
        let sums = self.cone.sums(&grid, &mut batches, &headings, &mut self.scratch);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "markers of a round")]
        let made = sums.iter().map(|s| s.own).sum::<f64>() as usize;
        self.markers_made += made;
        let looks: Vec<Look> = sums.iter().zip(&headings).map(|(s, h)| self.look(s, *h)).collect();
        let vigour = self.share(&awake, &looks);
        for ((&b, look), v) in awake.iter().zip(&looks).zip(vigour) {
            if look.dies {
                self.buds[b as usize].lives = false;
                self.died += 1;
            } else if self.skeleton.len() < self.spec.max_joints as usize {
                self.shoot(b as usize, look.direction, v, round + 1);
            }
        }
        self.buds.retain(|bud| bud.lives);
        Ok(!self.buds.is_empty())
    }

    /// Returns direction and free space of a bud.
    fn look(&self, sums: &Sums, heading: DVec3) -> Look {
        if sums.own <= 0.0 {
            return Look { dies: true, ..Look::default() };
        }
        let spec = &self.spec;
        let v = sums.pull - sums.push * spec.repulsion + self.numbers.pull * sums.whole;
        // If half of the markers are in a wall, half of the room remains.
        let room = sums.own / f64::from(spec.markers);
        let crowd = sums.older / sums.own;
        // With strokes, markers fill only the tube, however narrow: only the competition with others counts.
        let room = if self.room.is_guided() { room.sqrt() } else { room };
        Look {
            direction: v.normalize_or(heading),
            free: (1.0 - crowd).max(0.0) * room,
            dies: crowd > 1.0 || v.length() < 0.1 * sums.whole,
        }
    }

    /// Distributes vigour to the active buds: `alpha` times the free space of each tree, shared at its forks (Palubicki
    /// 2009, 4.2).
    fn share(&mut self, awake: &[u32], looks: &[Look]) -> Vec<f64> {
        let n = self.skeleton.len();
        let flow = &mut self.flow;
        flow.clear();
        flow.resize(n, Flow::default());
        for (&b, look) in awake.iter().zip(looks).filter(|(_, l)| !l.dies) {
            let bud = &self.buds[b as usize];
            let here = &mut flow[bud.joint as usize];
            here.all += look.free;
            if bud.terminal {
                here.main += look.free;
            }
        }
        let joints = || self.skeleton.parent.iter().zip(&self.is_main).enumerate();
        for (j, (parent, is_main)) in joints().rev() {
            let Some(p) = parent else { continue };
            let all = flow[j].all;
            let below = &mut flow[p.index()];
            below.all += all;
            if *is_main {
                below.main += all;
            }
        }
        let lambda = self.spec.lambda;
        for (j, (parent, is_main)) in joints() {
            let here = flow[j];
            let vigour = match parent.map(|p| flow[p.index()]) {
                None => self.spec.alpha * here.all,
                Some(below) if *is_main => below.all,
                Some(below) => below.main * here.all,
            };
            let side = (here.all - here.main).max(0.0);
            let (m, l) = (lambda * here.main, (1.0 - lambda) * side);
            flow[j] = Flow::default();
            if m + l > 0.0 {
                flow[j].all = vigour * m / (m + l);
                flow[j].main = if side > 0.0 { vigour * (l / (m + l)) / side } else { 0.0 };
            }
        }
        let of = |(&b, look): (&u32, &Look)| {
            let bud = &self.buds[b as usize];
            let here = flow[bud.joint as usize];
            if bud.terminal { here.all } else { here.main * look.free }
        };
        awake.iter().zip(looks).map(of).collect()
    }

    fn shoot(&mut self, b: usize, direction: DVec3, vigour: f64, birth: u32) {
        let vigour = vigour.min(f64::from(self.spec.most_per_shoot) + 0.999);
        let n = vigour.floor();
        if n.is_nan() || n < 1.0 {
            return;
        }
        let length = self.spec.internode_m * vigour / n;
        let mut left = n;
        let mut near = Vec::new();
        while left >= 1.0 {
            left -= 1.0;
            let bud = self.buds[b];
            let from = bud.joint as usize;
            let at = self.skeleton.position[from];
            let obstacles = self.room.obstacles();
            let to =
                if obstacles.is_empty() { Some(direction) } else { obstacles.steer(at, direction, length) };
            let place = to.map(|to| at + to * length);
            let Some((to, place)) =
                to.zip(place).filter(|(_, p)| self.room.guide_at(*p, &mut near).is_some())
            else {
                self.buds[b].lives = false;
                return;
            };
            let joint = self.skeleton.push(place, JointId::new(from), birth);
            self.is_main.push(bud.terminal);
            // The bud is now at the tip of its shoot, which continues as its own axis.
            let side = (bud.side - to * bud.side.dot(to)).try_normalize();
            let tip = Bud {
                joint: joint.raw(),
                heading: to,
                side: side.unwrap_or_else(|| to.any_orthonormal_vector()),
                rank: if bud.terminal { bud.rank + 1 } else { 1 },
                terminal: true,
                ..bud
            };
            self.buds[b] = tip;
            self.set_buds(tip, birth);
        }
    }

    /// Sets axillary buds on a new joint, around it by phyllotaxis.
    fn set_buds(&mut self, tip: Bud, birth: u32) {
        let place = self.skeleton.position[tip.joint as usize];
        let key = self.seed.child(place_key(place));
        let mut stream = key.stream(Draw::Phyllotaxis);
        let across = tip.heading.cross(tip.side);
        let jitter = self.spec.jitter_deg * (PI / 180.0);
        for (k, azimuth) in (0_u64..).zip(self.numbers.phyllotaxis.azimuths(tip.rank)) {
            let [aside, open] = stream.normals();
            let turn = azimuth + jitter * aside;
            let tilt = self.spec.branch_angle_deg * (PI / 180.0) + jitter * open;
            let ((st, ct), (sa, ca)) = (ops::sin_cos(tilt), ops::sin_cos(turn));
            let heading = (tip.heading * ct + (tip.side * ca + across * sa) * st).normalize_or(tip.heading);
            self.buds.push(Bud {
                joint: tip.joint,
                heading,
                side: heading.any_orthonormal_vector(),
                rank: 0,
                terminal: false,
                wakes: birth,
                key: key.child(k),
                lives: true,
            });
        }
    }

    /// Removes short twigs that have stopped, repeatedly as others become short twigs, until none is left.
    fn shed(&self) -> Skeleton {
        let most = self.spec.shed_up_to as usize;
        let n = self.skeleton.len();
        if most == 0 || n == self.given {
            return self.skeleton.clone();
        }
        let (mut size, mut alive) = (vec![1_usize; n], vec![false; n]);
        for b in self.buds.iter().filter(|b| b.terminal) {
            alive[b.joint as usize] = true;
        }
        let mut stays = vec![true; n];
        for j in (self.given..n).rev() {
            let Some(p) = self.skeleton.parent[j].map(JointId::index) else { continue };
            let starts = !self.is_main[j];
            if starts && size[j] <= most && !alive[j] {
                stays[j] = false;
            } else {
                size[p] += size[j];
                alive[p] |= alive[j];
            }
        }
        self.skeleton.keep(|j| stays[j])
    }
}

#[cfg(test)]
#[path = "tests.rs"]
mod tests;
