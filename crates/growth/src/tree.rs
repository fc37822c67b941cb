//! The whole way from a spec to a plant.
//!
//! `TreeSpec -> Skeleton (any method) -> wood -> leaves -> Plant`

use base::{Counted, Report, Run, Seed};
use glam::DVec3;
use plant::{Blade, NodeId, Plant};

use crate::colonize::{colonize_part, plant_roots};
use crate::{
    ColonizeSpec, Colonized, Cycle, Fate, GrowthError, LeafCount, LeafMark, Lsystem, Method, Obstacles,
    SelfOrganizingSpec, Skeleton, TreeSpec, Wood, add_leaves, compete, grow_lsystem, guide, make_wood,
    self_organize,
};

/// The shares of the work that are done, for people who wait, when it is wood, and when it has leaves; meshes are the
/// rest. As of an oak.
const WOODY: f64 = 0.45;
const LEAFY: f64 = 0.6;

/// What growth itself counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Attraction points or markers, of all cycles; 0 for rules and light.
    pub attractors: usize,
    /// Of these, consumed.
    pub consumed: usize,
    /// Of these, neither consumed nor lying in obstacles: no joint came near them.
    pub unreachable: usize,
    /// Rounds, years or rewriting steps.
    pub iterations: u32,
    /// Life cycles of Yang et al. (2019); 1 for methods without.
    pub cycles: u32,
}

/// A grown plant and what it was made of.
#[derive(Clone, Debug, PartialEq)]
pub struct Grown {
    /// The plant: `plant.validate()` finds nothing wrong with it.
    pub plant: Plant,
    /// The skeleton under it: for pruning, ages and measures.
    pub skeleton: Skeleton,
    /// What growth counted.
    pub tally: Tally,
    /// Leaves placed, fallen and kept.
    pub leaves: LeafCount,
}

/// Grows trees of any method and dresses them with leaves of the given blade ([`crate::FoliageSpec::blade`] if none).
///
/// Guaranteed: the same plant for the same spec and seed, on every platform and any thread count; it ends; a clean
/// `validate()`. Books its time under `grow`, `wood` and `leaves`, and tells the run's token how far it is.
///
/// # Errors
/// [`GrowthError`]: whatever is wrong with the spec, or cancelled.
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
    let Bones { mut skeleton, marks, tally } = bones(spec, &obstacles, seed, run, report)?;
    run.cancel.reached(crate::GROWN);
    let by_birth = !matches!(spec.method, Method::Lsystem { .. } | Method::SelfOrganizing(_));
    if let Some(age) = spec.age.filter(|_| by_birth) {
        skeleton = skeleton.at_age(age);
    }
    let started = run.clock.now_ms();
    let mut wood_spec = spec.wood.clone();
    if let Method::SelfOrganizing(s) = &spec.method {
        // One exponent and one tip for the wood that growth kept account of.
        (wood_spec.pipe_exponent, wood_spec.tip_radius_m) = (s.pipe_exponent, s.tip_radius_m);
    }
    let wood = make_wood(&skeleton, &wood_spec, &obstacles, run)?;
    tell_moved_feet(&skeleton, &wood, report);
    report.book("wood", run.clock.now_ms() - started);
    run.cancel.reached(WOODY);
    let mut plant = wood.plant;
    if plant.axes.is_empty() {
        return Err(GrowthError::Nothing { why: why_nothing(spec, &tally) });
    }
    plant.name.clone_from(&spec.name);
    let mut leaves = LeafCount::default();
    if !spec.bare {
        let leaf = &spec.leaves;
        let places: Vec<(NodeId, LeafMark)> =
            marks.iter().filter_map(|m| Some((wood.node_of_joint[m.joint.index()]?, *m))).collect();
        let blade = blade.unwrap_or_else(|| leaf.blade());
        leaves = add_leaves(&mut plant, leaf, blade, &places, &obstacles, seed, run, report)?;
    }
    run.cancel.reached(LEAFY);
    debug_assert_eq!(plant.validate().next(), None, "a grown plant is sound");
    Ok(Grown { plant, skeleton, tally, leaves })
}

/// Warns of trunks that stand beside their roots, because an obstacle has no room for them there.
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

/// Why a tree came out without wood.
fn why_nothing(spec: &TreeSpec, tally: &Tally) -> String {
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
            "every attraction point lies within the kill distance (--kill, kill_m) of a root; make it smaller"
                .into()
        }
        _ => "no root came near an attraction point".into(),
    }
}

/// Fails where points were given and none is used, with the distance that there is.
fn reached_some(
    roots: &[DVec3],
    points: &[DVec3],
    steps: &ColonizeSpec,
    obstacles: &Obstacles,
    grown: &Colonized,
) -> Result<(), GrowthError> {
    if grown.fates.iter().any(|f| matches!(f, Fate::Reached(_))) {
        return Ok(());
    }
    let usable = points.iter().filter(|p| crate::error::usable(**p));
    let open = usable.filter(|p| obstacles.is_empty() || obstacles.free(**p));
    let away = open.flat_map(|p| roots.iter().map(|r| r.distance(*p))).fold(f64::INFINITY, f64::min);
    let why = if away.is_finite() {
        format!(
            "none of {} attraction points was reached: the nearest is {away:.4} m from a root; with an attraction \
             distance (--influence, attraction_m) of {away:.4} m or more instead of {} the root perceives it",
            points.len(),
            steps.attraction_m
        )
    } else {
        format!("none of {} attraction points is a finite point outside obstacles", points.len())
    };
    Err(GrowthError::Nothing { why })
}

/// A skeleton, the leaves that rules set, and what was counted.
struct Bones {
    skeleton: Skeleton,
    marks: Vec<LeafMark>,
    tally: Tally,
}

impl Bones {
    fn colonized(grown: Colonized) -> Self {
        let count = |f: fn(&Fate) -> bool| grown.fates.iter().filter(|x| f(x)).count();
        let tally = Tally {
            attractors: grown.fates.len(),
            consumed: count(|f| matches!(f, Fate::Reached(_))),
            unreachable: count(|f| *f == Fate::Unreached),
            iterations: grown.rounds,
            cycles: 1,
        };
        Self { skeleton: grown.skeleton, marks: Vec::new(), tally }
    }
}

/// The skeleton by whichever method.
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
            let region = envelope.prepare()?;
            let mut attractors = Vec::new();
            for (root, i) in spec.roots.iter().zip(0_u64..) {
                let free = |p: DVec3| obstacles.free(*root + p);
                let own = region.scatter(*points as usize, *hollow, seed.child(i), free)?;
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
            let grown = compete(&spec.roots, obstacles, s, seed, run, report)?;
            let sum = |of: fn(&Cycle) -> usize| grown.cycles.iter().map(of).sum();
            let tally = Tally {
                attractors: sum(|c| c.points),
                consumed: sum(|c| c.reached),
                unreachable: sum(|c| c.points - c.reached),
                iterations: grown.skeleton.age(),
                cycles: s.lifespan,
            };
            Ok(Bones { skeleton: grown.skeleton, marks: Vec::new(), tally })
        }
        Method::SelfOrganizing(s) => {
            // Younger trees still have the branches that older ones have shed.
            let years = spec.age.map_or(s.years, |age| age.min(s.years));
            let s = SelfOrganizingSpec { years, ..s.clone() };
            let skeleton = self_organize(&spec.roots, obstacles, &s, seed, run, report)?.skeleton;
            let tally = Tally { iterations: years, cycles: 1, ..Tally::default() };
            Ok(Bones { skeleton, marks: Vec::new(), tally })
        }
        Method::Guided(s) => {
            let grown = guide(&spec.roots, obstacles, s, seed, run, report)?;
            // Its markers live for one round: none is consumed or left.
            let tally = Tally { iterations: grown.rounds, cycles: 1, ..Tally::default() };
            Ok(Bones { skeleton: grown.skeleton, marks: Vec::new(), tally })
        }
        Method::Lsystem { rules, most_modules } => {
            plant_roots(&spec.roots, obstacles, run)?;
            let mut system = Lsystem::parse(rules)?;
            system.steps = spec.age.map_or(system.steps, |age| age.min(system.steps));
            let tally = Tally { iterations: system.steps, cycles: 1, ..Tally::default() };
            let tree = grow_lsystem(&spec.roots, &system, *most_modules, seed, run, report)?;
            if obstacles.is_empty() {
                return Ok(Bones { skeleton: tree.skeleton, marks: tree.leaves, tally });
            }
            let s = &tree.skeleton;
            let open = |j: usize| match s.parent[j] {
                None => true,
                Some(p) => {
                    obstacles.free(s.position[j]) && !obstacles.blocks(s.position[p.index()], s.position[j])
                }
            };
            let (skeleton, new_id) = s.keep_mapped(open);
            let marks = tree.leaves.iter();
            let marks = marks.filter_map(|m| Some(LeafMark { joint: new_id[m.joint.index()]?, ..*m }));
            Ok(Bones { skeleton, marks: marks.collect(), tally })
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
