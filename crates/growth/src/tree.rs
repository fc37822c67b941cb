//! The whole process from a spec to a plant.
//!
//! `TreeSpec -> Skeleton (any method) -> wood -> leaves -> Plant`

use base::{Counted, Draw, Report, Run, Seed, ops};
use glam::DVec3;
use plant::{Blade, Frame, NodeId, Plant};

use crate::colonize::{colonize_part, grow_frame, plant_roots};
use crate::competition::compete_each;
use crate::envelope::crowns;
use crate::life::{fronds_by, grown_by, slimmer, younger};
use crate::props::add_props;
use crate::scars::add_scars;
use crate::surface_roots::add_surface_roots;
use crate::variation::Habit;
use crate::wood::{main_children, make_wood_of, pipes, radii, thickening};
use crate::{
    Ages, ColonizeSpec, Colonized, Cycle, FoliageSpec, GrowthError, JointId, LeafCount, LeafMark, Lsystem,
    Method, Obstacles, PointFate, SelfOrganizingSpec, Skeleton, TreeSpec, VariationSpec, Wood, WoodSpec,
    add_leaves, grow_lsystem, guide, self_organize,
};

/// Key under which a seed draws the fates of limbs.
const FATE: u64 = 0x0066_6174_6573;

/// Key under which a seed draws the flowers that rules set.
const FLOWERS: u64 = 0x0066_6c6f_7765_7273;

/// Share of the work that is done, for people who wait, when the wood is complete. Measured on an oak.
const WOODY: f64 = 0.45;
/// Share of the work that is done when the leaves are complete; meshes are the rest.
const LEAFY: f64 = 0.6;

/// Counts of growth itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GrowthTally {
    /// Number of attraction points or markers, of all cycles; 0 for rules and light.
    pub attractors: usize,
    /// Number of these that were consumed.
    pub consumed: usize,
    /// Number of these that were neither consumed nor in obstacles: no joint came near them.
    pub unreachable: usize,
    /// Years of a tree that has [`TreeSpec::years`]; otherwise rounds, years or rewriting steps.
    pub iterations: u32,
    /// Life cycles of Yang et al. (2019); 1 for methods without.
    pub cycles: u32,
}

/// A grown plant with its origin.
#[derive(Clone, Debug, PartialEq)]
pub struct Grown {
    /// The plant: `plant.validate()` finds nothing wrong with it.
    pub plant: Plant,
    /// The skeleton under it: for pruning, ages and measures.
    pub skeleton: Skeleton,
    /// Counts of growth.
    pub tally: GrowthTally,
    /// Leaves placed, fallen and kept.
    pub leaves: LeafCount,
    /// Positions of flowers that rules set; these are not organs yet: a later stage makes them.
    pub flowers: Vec<FlowerPlace>,
}

/// Longest blade of needles, which is a shoot, relative to the size of a young tree; shoots stand closer by the same
/// factor.
const LONGEST_SHOOT: f64 = 0.4;

/// Position of a flower.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlowerPlace {
    /// Node that bears it.
    pub bearer: NodeId,
    /// Frame at the foot of its stalk; the flower faces along it.
    pub frame: Frame,
    /// Relative size, 0.01 to 100.
    pub scale: f64,
    /// Key for its random choices.
    pub key: u64,
}

/// Grows trees of any method and dresses them with leaves of the given blade ([`crate::FoliageSpec::blade`] if none).
///
/// Guaranteed: the same plant for the same spec and seed, on every platform and any thread count; it ends; a clean
/// `validate()`. Books its time under `grow`, `wood` and `leaves`, and reports its progress to the run's token.
///
/// # Errors
/// [`GrowthError`]: any fault of the spec, or cancelled.
///
/// ```
/// use base::{Report, Run, Seed};
/// use growth::{TreeSpec, grow};
/// let tree = grow(&TreeSpec::default(), None, Seed::new(1), &Run::plain(), &mut Report::default())?;
/// assert!(tree.plant.axes.len() > 100 && tree.leaves.kept == tree.plant.organs.len());
/// # Ok::<(), growth::GrowthError>(())
/// ```
pub fn grow(
    spec: &TreeSpec,
    blade: Option<Blade>,
    seed: Seed,
    run: &Run<'_>,
    report: &mut Report,
) -> Result<Grown, GrowthError> {
    spec.check(&run.budget)?;
    let obstacles = Obstacles::new(&spec.obstacles, spec.clearance_m)?;
    let mut bones = bones(spec, &obstacles, seed, run, report)?;
    run.cancel.reached(crate::GROWN);
    let started = run.clock.now_ms();
    let mut wood_spec = spec.wood.clone();
    if let Method::SelfOrganizing(s) = &spec.method {
        // One exponent and one tip for the wood that growth computed itself.
        (wood_spec.pipe_exponent, wood_spec.tip_radius_m) = (s.pipe_exponent, s.tip_radius_m);
    }
    let mut thick = differ(spec, &wood_spec, &obstacles, seed, &mut bones)?;
    let life = spec.age.zip(spec.years).map_or(1.0, |(age, years)| f64::from(age) / f64::from(years));
    take_limbs(&spec.variation, &wood_spec, life, seed, &mut bones);
    if spec.end_of_life().is_none() && !matches!(spec.method, Method::Lsystem { .. }) {
        // Rounds, which are known only now.
        spec.check_age(bones.skeleton.age())?;
    }
    let slim = age(spec, &wood_spec, &mut bones);
    // One number for all, or one for each tree.
    thick.resize(thick.len().max(slim.len()), thick.first().copied().unwrap_or(1.0));
    thick.iter_mut().zip(slim).for_each(|(thick, slim)| *thick *= slim);
    strip_twigs(&wood_spec, &mut bones);
    let grown = bones.skeleton.len();
    add_props(&mut bones.skeleton, &wood_spec, grown_by(life, spec.years.unwrap_or(1)), seed);
    let Bones { skeleton, marks, dead: mut leafless, mut tally, .. } = bones;
    if skeleton.len() > grown {
        leafless.resize(grown, false);
        leafless.resize(skeleton.len(), true);
    }
    if let Some(years) = spec.years.filter(|_| !matches!(spec.method, Method::SelfOrganizing(_))) {
        tally.iterations = spec.age.map_or(years, |age| age.min(years));
    }
    let wood = make_wood_of(&skeleton, &wood_spec, &thick, &obstacles, run)?;
    tell_moved_feet(&skeleton, &wood, report);
    report.book("wood", run.clock.now_ms() - started);
    run.cancel.reached(WOODY);
    let mut plant = wood.plant;
    if plant.axes.is_empty() {
        return Err(GrowthError::Nothing { why: why_nothing(spec, &tally) });
    }
    plant.name.clone_from(&spec.name);
    let flowers = flower_places(&plant, &marks, &wood.node_of_joint, seed);
    let mut leaves = LeafCount::default();
    if !spec.bare {
        let leaf = &spec.leaves;
        let leaf_marks = marks.iter().filter(|m| !m.flower);
        let places: Vec<(NodeId, LeafMark)> =
            leaf_marks.filter_map(|m| Some((wood.node_of_joint[m.joint.index()]?, *m))).collect();
        let blade = blade.unwrap_or_else(|| leaf.blade());
        // Shoots that are thicker by a factor bear leaves up to a radius that is larger by the same factor.
        let mean = thick.iter().sum::<f64>() / thick.len().max(1) as f64;
        let mut leaf = FoliageSpec { max_radius_m: (leaf.max_radius_m * mean).min(100.0), ..leaf.clone() };
        if life < 1.0 && blade.needles.is_some() && places.is_empty() {
            let smaller = (LONGEST_SHOOT * skeleton.size() / leaf.length_m).min(1.0);
            leaf.length_m *= smaller;
            leaf.spacing_m *= smaller;
        }
        leaves = add_leaves(&mut plant, &leaf, blade, &places, &obstacles, seed, run, report)?;
        let gone = strip_leaves(&mut plant, &wood.node_of_joint, &leafless);
        (leaves.kept, leaves.fallen) = (leaves.kept - gone, leaves.fallen + gone);
    }
    run.cancel.reached(LEAFY);
    add_scars(&mut plant, &wood_spec, &obstacles, seed);
    add_surface_roots(&mut plant, &wood_spec, &obstacles, seed);
    debug_assert_eq!(plant.validate().next(), None, "a grown plant is sound");
    Ok(Grown { plant, skeleton, tally, leaves, flowers })
}

/// Returns the flowers among the marks that rules set.
fn flower_places(
    plant: &Plant,
    marks: &[LeafMark],
    node_of_joint: &[Option<NodeId>],
    seed: Seed,
) -> Vec<FlowerPlace> {
    let place = |(i, m): (u64, &LeafMark)| {
        let bearer = node_of_joint[m.joint.index()].filter(|_| m.flower && m.scale > 0.0)?;
        let frame = Frame::looking(plant.nodes.position[bearer.index()], m.heading, m.up);
        let key = seed.child(FLOWERS).child(i).number();
        Some(FlowerPlace { bearer, frame, scale: m.scale.clamp(0.01, 100.0), key })
    };
    (0..).zip(marks).filter_map(place).collect()
}

/// Applies the variation of trees whose methods do not draw a crown of their own size, and removes lost limbs; returns
/// the factor on the radii of each tree.
fn differ(
    spec: &TreeSpec,
    wood: &WoodSpec,
    obstacles: &Obstacles,
    seed: Seed,
    bones: &mut Bones,
) -> Result<Vec<f64>, GrowthError> {
    let variation = &spec.variation;
    let thick = thickening(&bones.skeleton, wood)?;
    if variation.is_none() {
        return Ok(vec![thick]);
    }
    let habits: Vec<Habit> = (0..spec.roots.len() as u64).map(|root| variation.habit(seed, root)).collect();
    // Envelopes have grown with the tree, and their pipes with them.
    let drawn_up =
        matches!(spec.method, Method::Competition(_) | Method::Colonization { .. } | Method::Points { .. });
    if !drawn_up {
        let s = &mut bones.skeleton;
        for (p, tree) in s.position.iter_mut().zip(&s.tree) {
            let (root, habit) = (spec.roots[*tree as usize], &habits[*tree as usize]);
            *p = root + habit.place(*p - root);
        }
        if !obstacles.is_empty() {
            bones.cut_off(obstacles);
        }
    }
    let factor = |habit: &Habit| {
        let crown = if drawn_up { 1.0 } else { ops::powf(habit.volume(), 1.0 / wood.pipe_exponent) };
        thick * habit.girth * crown
    };
    Ok(habits.iter().map(factor).collect())
}

/// Share of a tree's life before which no limb has died; after it, each dead limb has its own time.
const LIMBS_LIVE: f64 = 0.4;

/// Removes lost limbs; marks those that are dead at a share of the tree's life.
fn take_limbs(variation: &VariationSpec, wood: &WoodSpec, life: f64, seed: Seed, bones: &mut Bones) {
    if variation.lost <= 0.0 && variation.dead <= 0.0 {
        return;
    }
    let n = bones.skeleton.len();
    let (mut lost, mut dead) = (vec![false; n], vec![false; n]);
    for (j, i) in limbs(&bones.skeleton, wood).into_iter().zip(0_u64..) {
        let draw = |k: u64| seed.child(FATE).child(i).child(k).stream(Draw::Habit);
        lost[j] = draw(0).chance(variation.lost);
        let died = ops::lerp(LIMBS_LIVE, 1.0, draw(2).uniform());
        dead[j] = life >= died && draw(1).chance(variation.dead);
    }
    for j in 0..n {
        dead[j] |= bones.skeleton.parent[j].is_some_and(|p| dead[p.index()]);
    }
    bones.dead = dead;
    bones.keep(|j| !lost[j]);
}

/// Returns the first joints of branches that leave a trunk and have between a 200th and a sixth of its wood.
fn limbs(skeleton: &Skeleton, wood: &WoodSpec) -> Vec<usize> {
    let main = main_children(skeleton, &radii(skeleton, wood));
    let pipes = pipes(skeleton, wood.internode_share);
    let mut trunk = vec![0.0; skeleton.len()];
    let mut limbs = Vec::new();
    for j in 0..skeleton.len() {
        match skeleton.parent[j].map(JointId::index) {
            None => trunk[j] = pipes[j],
            Some(p) if main[p] == Some(JointId::new(j)) => trunk[j] = trunk[p],
            Some(p) if (trunk[p] / 200.0..trunk[p] / 6.0).contains(&pipes[j]) => limbs.push(j),
            Some(_) => {}
        }
    }
    limbs
}

/// Reduces the tree to its age; returns the factor on the thickness of each tree's wood relative to its pipes.
fn age(spec: &TreeSpec, wood: &WoodSpec, bones: &mut Bones) -> Vec<f64> {
    let Some(age) = spec.age else { return Vec::new() };
    match (&spec.method, spec.years) {
        // Light and rules without years were computed only up to this age.
        _ if bones.aged => {}
        (Method::SelfOrganizing(_), _) | (Method::Lsystem { .. }, None) => {}
        (_, Some(years)) if age < years => {
            let life = f64::from(age) / f64::from(years);
            let (young, ids) = younger(&bones.skeleton, wood, life, years);
            // Fronds and blades that are a part of the tree's own height grow with it.
            if spec.leaves.length_m > 0.05 * bones.skeleton.size() {
                let shorter = fronds_by(&bones.skeleton, spec.leaves.length_m, life, years);
                bones.marks.iter_mut().for_each(|m| m.scale *= shorter);
            }
            let slim = slimmer(&bones.skeleton, &young, wood);
            bones.become_of(young, &ids);
            return slim;
        }
        (_, Some(_)) => {}
        (_, None) => {
            let s = &bones.skeleton;
            let (mut young, ids) = s.keep_mapped(|j| s.birth[j] <= age);
            young.radius_m.fill(0.0);
            bones.become_of(young, &ids);
        }
    }
    Vec::new()
}

/// Removes the fine twigs of dead limbs, which the wind breaks first; the rest keeps its thickness.
fn strip_twigs(wood: &WoodSpec, bones: &mut Bones) {
    if !bones.dead.iter().any(|d| *d) {
        return;
    }
    let (radius, pipes) = (radii(&bones.skeleton, wood), pipes(&bones.skeleton, wood.internode_share));
    let dead = bones.dead.clone();
    for (j, r) in bones.skeleton.radius_m.iter_mut().enumerate().filter(|(j, _)| dead[*j]) {
        *r = radius[j];
    }
    bones.keep(|j| !dead[j] || pipes[j] >= 4.0);
}

/// Removes the leaves of dead limbs and of props; returns their number.
fn strip_leaves(plant: &mut Plant, node_of_joint: &[Option<NodeId>], leafless: &[bool]) -> usize {
    let mut bare = vec![false; plant.axes.len()];
    for node in node_of_joint.iter().zip(leafless).filter(|(_, d)| **d).filter_map(|(node, _)| *node) {
        bare[plant.nodes.axis[node.index()].index()] = true;
    }
    if !bare.contains(&true) {
        return 0;
    }
    let before = plant.organs.len();
    let nodes = &plant.nodes;
    plant.organs.retain(|o| o.bearer.is_none_or(|b| !bare[nodes.axis[b.index()].index()]));
    before - plant.organs.len()
}

/// Warns of trunks that stand next to their roots, because an obstacle leaves no room for them there.
fn tell_moved_feet(skeleton: &Skeleton, wood: &Wood, report: &mut Report) {
    let roots = skeleton.parent.iter().zip(&wood.node_of_joint).enumerate();
    for (j, node) in
        roots.filter(|(_, (parent, _))| parent.is_none()).filter_map(|(j, (_, n))| Some((j, (*n)?)))
    {
        let aside = wood.plant.nodes.position[node.index()].distance(skeleton.position[j]);
        if aside > 1e-6 {
            let root = skeleton.tree[j];
            base::warn!(
                report,
                "foot-moved",
                { root = root + 1, aside = format_args!("{aside:.2}") },
                "an obstacle leaves the trunk on root {root} no room: its foot stands {aside} m aside, as far as the trunk \
                 is thick"
            );
        }
    }
}

/// Explains why a tree has no wood.
fn why_nothing(spec: &TreeSpec, tally: &GrowthTally) -> String {
    match &spec.method {
        _ if spec.age == Some(0) => "the tree is asked for at the age of 0; ask for 1 or more".into(),
        Method::SelfOrganizing(s) if s.years == 0 => "years is 0; make it 1 or more".into(),
        Method::Guided(s) if s.rounds == 0 => "rounds is 0; make it 1 or more".into(),
        Method::Lsystem { .. } if tally.iterations == 0 => {
            "the axiom draws no step `F`, and steps is 0; make it 1 or more".into()
        }
        Method::Lsystem { .. } if spec.obstacles.is_empty() => {
            "neither the axiom nor what is made of it draws a step `F` of any length".into()
        }
        Method::Guided(s) => format!(
            "no bud found room: its markers lie `near` ({}) to `far` ({}) internodes from it, inside the envelope and \
             the strokes; make these larger or alpha ({}) higher",
            s.near, s.far, s.alpha
        ),
        _ if !spec.obstacles.is_empty() => {
            "obstacles leave no room at the roots for a twig; move them or the roots".into()
        }
        _ if tally.consumed > 0 => {
            "every attraction point lies within the kill distance (kill_m) of a root; make it smaller".into()
        }
        _ => "no root came near an attraction point".into(),
    }
}

/// Fails if points were given and none is used, with the actual distance.
fn reached_some(
    roots: &[DVec3],
    points: &[DVec3],
    steps: &ColonizeSpec,
    obstacles: &Obstacles,
    grown: &Colonized,
) -> Result<(), GrowthError> {
    if grown.fates.iter().any(|f| matches!(f, PointFate::Reached(_))) {
        return Ok(());
    }
    let usable = points.iter().filter(|p| crate::error::usable(**p));
    let open = usable.filter(|p| obstacles.is_empty() || obstacles.free(**p));
    let away = open.flat_map(|p| roots.iter().map(|r| r.distance(*p))).fold(f64::INFINITY, f64::min);
    let why = if away.is_finite() {
        format!(
            "none of {} attraction points was reached: the nearest is {away:.4} m from a root; with an attraction \
             distance (attraction_m) of {away:.4} m or more instead of {} the root perceives it",
            points.len(),
            steps.attraction_m
        )
    } else {
        format!("none of {} attraction points is a finite point outside obstacles", points.len())
    };
    Err(GrowthError::Nothing { why })
}

/// A skeleton, the leaves that rules set, and the counts.
struct Bones {
    skeleton: Skeleton,
    marks: Vec<LeafMark>,
    /// Whether each joint belongs to a dead limb; may be empty.
    dead: Vec<bool>,
    /// Whether rules have followed its life up to its age.
    aged: bool,
    tally: GrowthTally,
}

impl Bones {
    fn new(skeleton: Skeleton, tally: GrowthTally) -> Self {
        Self { skeleton, marks: Vec::new(), dead: Vec::new(), aged: false, tally }
    }

    /// Keeps the joints for which `stays` holds and their descendants, with all that they bear.
    fn keep(&mut self, stays: impl Fn(usize) -> bool) {
        let (skeleton, ids) = self.skeleton.keep_mapped(stays);
        self.become_of(skeleton, &ids);
    }

    /// Replaces its skeleton; `ids`: the new handles of its joints.
    fn become_of(&mut self, skeleton: Skeleton, ids: &[Option<JointId>]) {
        self.skeleton = skeleton;
        let marks = self.marks.iter();
        self.marks = marks.filter_map(|m| Some(LeafMark { joint: ids[m.joint.index()]?, ..*m })).collect();
        let kept = |(d, id): (&bool, &Option<JointId>)| id.is_some().then_some(*d);
        self.dead = self.dead.iter().zip(ids).filter_map(kept).collect();
    }

    /// Removes joints in obstacles, or behind one.
    fn cut_off(&mut self, obstacles: &Obstacles) {
        let s = self.skeleton.clone();
        self.keep(|j| {
            s.parent[j].is_none_or(|p| {
                obstacles.free(s.position[j]) && !obstacles.blocks(s.position[p.index()], s.position[j])
            })
        });
    }

    fn colonized(grown: Colonized) -> Self {
        let count = |f: fn(&PointFate) -> bool| grown.fates.iter().filter(|x| f(x)).count();
        let tally = GrowthTally {
            attractors: grown.fates.len(),
            consumed: count(|f| matches!(f, PointFate::Reached(_))),
            unreachable: count(|f| *f == PointFate::Unreached),
            iterations: grown.rounds,
            cycles: 1,
        };
        Self::new(grown.skeleton, tally)
    }
}

/// Makes the skeleton by the method of the spec.
fn bones(
    spec: &TreeSpec,
    obstacles: &Obstacles,
    seed: Seed,
    run: &Run<'_>,
    report: &mut Report,
) -> Result<Bones, GrowthError> {
    match &spec.method {
        Method::Colonization { envelope, points, hollow, steps } => {
            let all = u64::from(*points) * spec.roots.len() as u64;
            run.budget.check(Counted::Points, all, "lower points or give fewer roots")?;
            let roots = plant_roots(&spec.roots, obstacles, run)?;
            spec::check(steps)?;
            let step = steps.step_m.unwrap_or(0.5 * steps.kill_m);
            let crowns = crowns(envelope, &spec.variation, spec.roots.len(), step, seed)?;
            let roots = grow_frame(roots, &crowns, &spec.roots, obstacles, step, run)?;
            let mut attractors = Vec::new();
            for ((root, i), crown) in spec.roots.iter().zip(0_u64..).zip(crowns.iter().cycle()) {
                let free = |p: DVec3| obstacles.free(*root + p);
                let count = crown.region.count(*points);
                let own = crown.region.scatter(count, *hollow, seed.child(i), free)?;
                attractors.extend(own.into_iter().map(|p| *root + p));
            }
            let part = (0.0, crate::GROWN);
            Ok(Bones::colonized(colonize_part(roots, &attractors, obstacles, steps, part, run, report)?))
        }
        Method::Points { points, steps } => {
            let roots = plant_roots(&spec.roots, obstacles, run)?;
            let part = (0.0, crate::GROWN);
            let grown = colonize_part(roots, points, obstacles, steps, part, run, report)?;
            reached_some(&spec.roots, points, steps, obstacles, &grown)?;
            Ok(Bones::colonized(grown))
        }
        Method::Competition(s) => {
            let grown = compete_each(&spec.roots, obstacles, s, &spec.variation, seed, run, report)?;
            let sum = |of: fn(&Cycle) -> usize| grown.cycles.iter().map(of).sum();
            let tally = GrowthTally {
                attractors: sum(|c| c.points),
                consumed: sum(|c| c.reached),
                unreachable: sum(|c| c.points - c.reached),
                iterations: grown.skeleton.age(),
                cycles: s.lifespan,
            };
            Ok(Bones::new(grown.skeleton, tally))
        }
        Method::SelfOrganizing(s) => {
            // Younger trees still have the branches that older ones have shed.
            let years = spec.age.map_or(s.years, |age| age.min(s.years));
            let s = SelfOrganizingSpec { years, ..s.clone() };
            let skeleton = self_organize(&spec.roots, obstacles, &s, seed, run, report)?.skeleton;
            let tally = GrowthTally { iterations: years, cycles: 1, ..GrowthTally::default() };
            Ok(Bones::new(skeleton, tally))
        }
        Method::Guided(s) => {
            let grown = guide(&spec.roots, obstacles, s, seed, run, report)?;
            // Its markers live for one round: none is consumed or left.
            let tally = GrowthTally { iterations: grown.rounds, cycles: 1, ..GrowthTally::default() };
            Ok(Bones::new(grown.skeleton, tally))
        }
        Method::Lsystem { rules, most_modules } => {
            plant_roots(&spec.roots, obstacles, run)?;
            let lived = |(age, years): (u32, u32)| f64::from(age) / f64::from(years.max(1));
            let life = spec.age.zip(spec.years).map_or(1.0, lived);
            let mut system = Lsystem::parse_at(rules, life)?;
            if spec.years.is_none() {
                spec.check_age(system.steps)?;
            }
            // For a tree with years, all steps make the whole, which is made younger later, unless the rules follow
            // growth.
            let last = match (spec.age, spec.years) {
                (Some(age), Some(years)) if system.ages == Ages::Steps => {
                    Some((system.steps * age.min(years)).div_ceil(years.max(1)))
                }
                (age, years) => age.filter(|_| years.is_none()),
            };
            system.steps = last.map_or(system.steps, |age| age.min(system.steps));
            let tally = GrowthTally { iterations: system.steps, cycles: 1, ..GrowthTally::default() };
            let tree = grow_lsystem(&spec.roots, &system, *most_modules, seed, run, report)?;
            let aged = spec.years.is_some() && system.ages != Ages::Whole;
            let mut bones = Bones { marks: tree.leaves, aged, ..Bones::new(tree.skeleton, tally) };
            if !obstacles.is_empty() {
                bones.cut_off(obstacles);
            }
            Ok(bones)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::OAK_RULES;
    use crate::{CompetitionSpec, Envelope, GuidedSpec, Obstacle};

    fn methods() -> Vec<Method> {
        vec![
            Method::Colonization {
                envelope: Envelope::default(),
                points: 600,
                hollow: 0.0,
                steps: ColonizeSpec::default(),
            },
            Method::Competition(CompetitionSpec { points: 600, ..CompetitionSpec::default() }),
            Method::SelfOrganizing(SelfOrganizingSpec { years: 14, ..SelfOrganizingSpec::default() }),
            Method::Guided(GuidedSpec { rounds: 9, ..GuidedSpec::default() }),
            Method::Lsystem { rules: OAK_RULES.into(), most_modules: 1_000_000 },
        ]
    }

    fn tree(spec: &TreeSpec) -> Grown {
        let got = grow(spec, None, Seed::new(3), &Run::plain(), &mut Report::default()).expect("sound");
        assert_eq!(got.plant.validate().next(), None, "{}", spec.name);
        got
    }

    #[test]
    fn every_method_makes_a_sound_plant_again_and_again() {
        for method in methods() {
            let spec = TreeSpec { name: format!("{method:?}"), method, ..TreeSpec::default() };
            let a = tree(&spec);
            assert!(a.plant.axes.len() > 40 && a.leaves.kept > 300, "{}: {:?}", spec.name, a.leaves);
            assert_eq!(a.plant.digest_hex(), tree(&spec).plant.digest_hex());
        }
    }

    #[test]
    fn every_method_keeps_out_of_obstacles() {
        let house = Obstacle::Box { min: DVec3::new(0.6, 0.0, -3.0), max: DVec3::new(6.0, 4.5, 3.0) };
        for method in methods() {
            let obstacles = vec![house.clone()];
            let spec = TreeSpec { name: format!("{method:?}"), method, obstacles, ..TreeSpec::default() };
            let got = tree(&spec);
            let all = Obstacles::new(&spec.obstacles, spec.clearance_m).expect("sound");
            let nodes = &got.plant.nodes;
            for (p, r) in nodes.position.iter().zip(&nodes.radius_m) {
                let free = all.nearest(*p).is_none_or(|(d, _)| d > 0.0);
                assert!(free && all.depth(*p + DVec3::X * *r * 0.9) <= 0.0, "{}: {p} {r}", spec.name);
            }
            for o in &got.plant.organs {
                let corners = got.plant.shapes[o.shape.index()].corners(1.0);
                let deepest =
                    corners.iter().map(|c| all.depth(o.frame.place(*c, o.scale))).fold(0.0, f64::max);
                assert!(deepest <= 0.0, "{}: {deepest}", spec.name);
            }
            assert!(got.plant.axes.len() > 20, "{}", spec.name);
        }
    }

    #[test]
    fn a_younger_tree_is_smaller() {
        for method in &methods() {
            let spec = TreeSpec { method: method.clone(), ..TreeSpec::default() };
            let old = tree(&spec);
            let young = tree(&TreeSpec { age: Some(old.tally.iterations / 2), ..spec });
            assert!(young.skeleton.len() < old.skeleton.len() && !young.plant.axes.is_empty());
            // Rules may set the trunk's diameter for every age.
            let thinner = young.plant.nodes.radius_m[0] < old.plant.nodes.radius_m[0];
            assert!(thinner || matches!(method, Method::Lsystem { .. }));
        }
    }

    #[test]
    fn props_bear_no_leaves() {
        let props = crate::PropSpec { count: 12, radius_m: 0.002, ..crate::PropSpec::default() };
        let wood = WoodSpec { props, ..WoodSpec::default() };
        let got = tree(&TreeSpec { wood, ..TreeSpec::default() });
        let low = |p: &DVec3| p.y < 1.0 && DVec3::new(p.x, 0.0, p.z).length() > 0.4;
        assert!(got.plant.nodes.position.iter().filter(|p| low(p)).count() > 24);
        assert!(!got.plant.organs.iter().any(|o| low(&o.frame.origin)));
    }

    #[test]
    fn limbs_that_died_lived_before() {
        let leaves = |dead: f64, age: u32| {
            let variation = VariationSpec { dead, ..VariationSpec::default() };
            tree(&TreeSpec { years: Some(50), age: Some(age), variation, ..TreeSpec::default() }).leaves.kept
        };
        assert_eq!(leaves(0.8, 15), leaves(0.0, 15), "each of them is young");
        assert!(leaves(0.8, 50) < leaves(0.0, 50));
    }

    #[test]
    fn rules_that_follow_growth_give_ages_by_their_steps() {
        let of = |ages: &str, age: u32| {
            let rules = format!("axiom = A\nsteps = 40\n{ages}\nA -> !(0.4) F(0.2) A");
            let method = Method::Lsystem { rules, most_modules: 1000 };
            let got = tree(&TreeSpec {
                years: Some(80),
                age: Some(age),
                method,
                bare: true,
                wood: WoodSpec { relax: 0, smooth: false, ..WoodSpec::default() },
                ..TreeSpec::default()
            });
            let nodes = &got.plant.nodes;
            let top = nodes.position.iter().map(|p| p.y).fold(0.0, f64::max);
            (top, nodes.radius_m.last().copied().unwrap_or(0.0))
        };
        let (top, tip) = of("ages = steps", 20);
        assert!((top - 2.0).abs() < 1e-9 && (tip - 0.2).abs() < 1e-9, "{top} {tip}");
        assert!((of("ages = steps", 80).0 - 8.0).abs() < 1e-9);
        // Without it a quarter of the life has the height given by the law of growth.
        assert!((of("", 20).0 / 8.0 - grown_by(0.25, 80)).abs() < 1e-9);
    }

    #[test]
    fn rules_may_know_the_share_of_a_life() {
        let of = |ages: &str, age: Option<u32>| {
            let rules = format!(
                "{ages}\nlet q = 0.2 + 0.8 * life\naxiom = A(9.5 * q)\nsteps = 40\nA(n) if n > 0 -> F(q) A(n - 1)"
            );
            let method = Method::Lsystem { rules, most_modules: 1000 };
            let wood = WoodSpec { relax: 0, smooth: false, ..WoodSpec::default() };
            let spec = TreeSpec { years: Some(80), age, method, bare: true, wood, ..TreeSpec::default() };
            tree(&spec).plant.nodes.position.iter().map(|p| p.y).fold(0.0, f64::max)
        };
        assert!((of("ages = rules", None) - 10.0).abs() < 1e-9);
        // Half a life: six pieces of six tenths, and nothing is scaled back.
        assert!((of("ages = rules", Some(40)) - 3.6).abs() < 1e-9);
        assert!((of("ages = rules", Some(80)) - 10.0).abs() < 1e-9, "as old as it gets");
        // A user's constant of that name takes precedence.
        assert!((of("let life = 1", None) - 10.0).abs() < 1e-9);
        assert!((of("let life = 0.5", None) - 3.6).abs() < 1e-9);
    }

    #[test]
    fn specs_are_read_back_from_their_file_form() {
        for method in methods() {
            let spec = TreeSpec { method, ..TreeSpec::default() };
            let text = serde_json::to_string(&spec).expect("plain data");
            assert_eq!(serde_json::from_str::<TreeSpec>(&text).ok(), Some(spec), "{text}");
        }
        let few = r#"{"method": {"kind": "competition", "points": 100}, "roots": [[0, 0, 0], [3, 0, 0]]}"#;
        assert_eq!(serde_json::from_str::<TreeSpec>(few).map(|s| s.roots.len()).ok(), Some(2));
    }
}
