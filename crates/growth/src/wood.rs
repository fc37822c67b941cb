//! Converts a skeleton to a plant: axes with orders, smooth courses and radii.
//!
//! `Skeleton -> main child of each joint -> axes -> C1 Bezier -> pipe radii -> Plant`

use base::ops;
use base::{Cancelled, Run, Seed};
use glam::DVec3;
use plant::{AxisKind, NodeId, Plant};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::beside::{Course, Foot, Room};
use crate::error::within;
use crate::{GrowthError, JointId, Obstacles, Skeleton};

/// Conversion of a skeleton to wood.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct WoodSpec {
    /// Exponent t of `r^t = sum of r_i^t` (Yang et al. 2019, Eq 4), 1 to 4, default 2.4; trees are measured at 1.8 to
    /// 2.6.
    #[schemars(range(min = 1.0, max = 4.0))]
    pub pipe_exponent: f64,
    /// Radius of a tip, metres, above 0, default 0.004.
    #[schemars(range(min = 1e-6, max = 10.0), extend("x-unit" = "m"))]
    pub tip_radius_m: f64,
    /// Contribution of every internode to the pipes, as a share of a tip's, 0 to 1, default 0.05. It makes shoots taper
    /// between forks; 0 is Eq 4 exactly.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub internode_share: f64,
    /// Radius at the foot of the thickest trunk when the tree is complete, metres: all radii, including those of the
    /// tips and [`FoliageSpec::max_radius_m`](crate::FoliageSpec::max_radius_m), are scaled to it, so that the pipe
    /// model holds. Default none: that of the pipe model.
    #[schemars(range(min = 1e-6, max = 100.0), extend("x-unit" = "m"))]
    pub trunk_radius_m: Option<f64>,
    /// Factor on the thickness of the bole relative to that which its crown needs, 1 to 20, default 1: baobabs and
    /// bottle trees store water there. Limbs are unchanged.
    #[schemars(range(min = 1.0, max = 20.0))]
    pub swell: f64,
    /// Roots that arch from the bole to the ground. Default none.
    pub props: PropSpec,
    /// Visible roots around the foot of each stem. Default none.
    pub surface_roots: SurfaceRootSpec,
    /// Remains of lost branches on stems. Default none.
    pub scars: ScarSpec,
    /// Smooths courses to quadratic Bezier pieces that join with one tangent (Eq 3, C1 variant). Default true.
    pub smooth: bool,
    /// Number of times that every joint is moved half-way to its parent (Runions 2007, step e), 0 to 10: angles at
    /// forks become acute and courses straighter; each time costs half an internode of size. Default 1.
    #[schemars(range(min = 0, max = 10))]
    pub relax: u32,
    /// Tolerance for leaving out joints that bear nothing: the displacement of the course as a share of the radius, 0
    /// to 10, default 0.25.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub thin_out: f64,
}

spec::schemas!(WoodSpec => crate::TreeSpec, "/$defs/WoodSpec");

impl Default for WoodSpec {
    fn default() -> Self {
        Self {
            pipe_exponent: 2.4,
            tip_radius_m: 0.004,
            internode_share: 0.05,
            trunk_radius_m: None,
            swell: 1.0,
            props: PropSpec::default(),
            surface_roots: SurfaceRootSpec::default(),
            scars: ScarSpec::default(),
            smooth: true,
            relax: 1,
            thin_out: 0.25,
        }
    }
}

/// Roots that arch from the stem to the ground and carry it: mangroves, screw pines.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct PropSpec {
    /// Number of props that leave the stem, 0 to 200, default 0.
    #[schemars(range(min = 0, max = 200))]
    pub count: u32,
    /// Height up to which they leave it when the tree is complete, metres, 0.01 to 50, default 1.5.
    #[schemars(range(min = 0.01, max = 50.0), extend("x-unit" = "m"))]
    pub rise_m: f64,
    /// Distance from the stem at which the highest reach the ground, metres, 0.01 to 50, default 1.5; each varies by
    /// half.
    #[schemars(range(min = 0.01, max = 50.0), extend("x-unit" = "m"))]
    pub reach_m: f64,
    /// Mean radius, metres, 0.001 to 5, default 0.025.
    #[schemars(range(min = 0.001, max = 5.0), extend("x-unit" = "m"))]
    pub radius_m: f64,
    /// Probability that a further arch leaves one half-way down, 0 to 1, default 0.5.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub fork: f64,
}

spec::schemas!(PropSpec => crate::TreeSpec, "/$defs/PropSpec");

impl Default for PropSpec {
    fn default() -> Self {
        Self { count: 0, rise_m: 1.5, reach_m: 1.5, radius_m: 0.025, fork: 0.5 }
    }
}

/// Roots that run along the ground from the foot of a stem, half sunk, until they are out of sight. Their thickness
/// follows that of the stem, and they taper quickly. Stems of less than 12 cm radius have smaller ones, those of less
/// than 2 cm none.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SurfaceRootSpec {
    /// Number of roots of each stem, 0 to 40, default 0; half of them fork. Trees have 4 to 11 main ones (Perry,
    /// Journal of Arboriculture 8, 1982).
    #[schemars(range(min = 0, max = 40))]
    pub count: u32,
    /// Distance from the centre of the stem up to which they show, in its radii at the foot, 1.5 to 40, default 5; each
    /// varies by two fifths.
    #[schemars(range(min = 1.5, max = 40.0))]
    pub reach: f64,
}

spec::schemas!(SurfaceRootSpec => crate::TreeSpec, "/$defs/SurfaceRootSpec");

impl Default for SurfaceRootSpec {
    fn default() -> Self {
        Self { count: 0, reach: 5.0 }
    }
}

/// Remains of lost branches on stems: mean numbers, which vary from seed to seed. All lie around the stem below its
/// crown and among its first limbs; a stem that is branched from the ground has few. Stems of 10 cm radius have all
/// stubs and knots, those of 25 cm the rest too; those of 4 and 10 cm have none yet.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ScarSpec {
    /// Stubs of dead branches per metre, 0 to 30, default 0.
    #[schemars(range(min = 0.0, max = 30.0))]
    pub stubs: f64,
    /// Knots, where the stem has grown around a stub, per metre, 0 to 30, default 0.
    #[schemars(range(min = 0.0, max = 30.0))]
    pub knots: f64,
    /// Burls, 0 to 50, default 0.
    #[schemars(range(min = 0.0, max = 50.0))]
    pub burls: f64,
    /// Hollows, where a stub has rotted away, 0 to 50, default 0.
    #[schemars(range(min = 0.0, max = 50.0))]
    pub hollows: f64,
    /// Limbs that broke off, 0 to 50, default 0.
    #[schemars(range(min = 0.0, max = 50.0))]
    pub broken_limbs: f64,
}

spec::schemas!(ScarSpec => crate::TreeSpec, "/$defs/ScarSpec");

/// A plant made from a skeleton.
#[derive(Clone, Debug, PartialEq)]
pub struct Wood {
    /// Axes only; `validate()` finds nothing wrong with it.
    pub plant: Plant,
    /// The node of each joint; `None` for joints that were left out and for trees without a single internode.
    pub node_of_joint: Vec<Option<NodeId>>,
}

/// Makes a plant from a skeleton.
///
/// The child with most wood above it, turned least, continues an axis; the others start axes of the next order. Radii
/// follow the pipe model, except where the skeleton has its own (`radius_m` above 0). Guaranteed: a clean `validate()`;
/// next to obstacles bark keeps their clearance where there is room (wood is moved aside by its thickness, including
/// that of a foot, and is thinner where it cannot be moved); an axis's key depends only on its start and on its
/// bearer's key. Cost: n log n in joints at most.
///
/// # Errors
/// [`GrowthError::Range`], [`GrowthError::Cancelled`].
///
/// ```
/// use base::Run;
/// use glam::DVec3;
/// use growth::{Obstacles, Skeleton, WoodSpec, make_wood};
/// let mut s = Skeleton::default();
/// let root = s.push_root(DVec3::ZERO, 0);
/// let fork = s.push(DVec3::Y, root, 1);
/// s.push(DVec3::new(0.5, 2.0, 0.0), fork, 2);
/// s.push(DVec3::new(-0.1, 2.0, 0.0), fork, 2);
/// let spec = WoodSpec { pipe_exponent: 2.0, internode_share: 0.0, ..WoodSpec::default() };
/// let wood = make_wood(&s, &spec, &Obstacles::none(), &Run::plain())?;
/// assert_eq!(wood.plant.axes.len(), 2);
/// assert!((wood.plant.nodes.radius_m[0] - 0.004 * 2_f64.sqrt()).abs() < 1e-12);
/// # Ok::<(), growth::GrowthError>(())
/// ```
pub fn make_wood(
    skeleton: &Skeleton,
    spec: &WoodSpec,
    obstacles: &Obstacles,
    run: &Run<'_>,
) -> Result<Wood, GrowthError> {
    let thick = thickening(skeleton, spec)?;
    make_wood_of(skeleton, spec, &[thick], obstacles, run)
}

/// Returns the factor on all radii with which the thickest trunk gets the thickness in the spec.
///
/// # Errors
/// [`GrowthError::Range`].
pub(crate) fn thickening(skeleton: &Skeleton, spec: &WoodSpec) -> Result<f64, GrowthError> {
    spec::check(spec)?;
    let Some(wanted) = spec.trunk_radius_m else { return Ok(1.0) };
    within("trunk_radius_m", wanted, spec.tip_radius_m, 100.0, "the tips' radius to 100 m")?;
    let thickest = radii(skeleton, spec).into_iter().fold(0.0, f64::max);
    Ok(if thickest > spec.tip_radius_m * 1.0001 { wanted / thickest } else { 1.0 })
}

/// As [`make_wood`], with the factors on the radii of each tree (one number for all, or one for each).
pub(crate) fn make_wood_of(
    skeleton: &Skeleton,
    spec: &WoodSpec,
    thick: &[f64],
    obstacles: &Obstacles,
    run: &Run<'_>,
) -> Result<Wood, GrowthError> {
    spec::check(spec)?;
    let mut radius = radii(skeleton, spec);
    for (r, tree) in radius.iter_mut().zip(&skeleton.tree) {
        *r *= thick.get(*tree as usize).or(thick.last()).copied().unwrap_or(1.0);
    }
    let relaxed = relax(skeleton, spec.relax, obstacles);
    let skeleton = &relaxed;
    run.cancel.check()?;
    let main = main_children(skeleton, &radius);
    if spec.swell > 1.0 {
        swell(&mut radius, skeleton, &main, spec.swell);
    }
    let wood = axes(skeleton, &main, &radius, spec, obstacles, run)?;
    debug_assert_eq!(wood.plant.validate().next(), None, "wood is sound");
    Ok(wood)
}

/// Length above the bole on which its swelling fades out, as a share of the bole's.
const SHOULDER: f64 = 0.5;

/// Returns for each joint whether it lies on a trunk below its lowest limb.
pub(crate) fn boles(full: &Skeleton, main: &[Option<JointId>]) -> Vec<bool> {
    let n = full.len();
    let mut above = vec![1_u32; n];
    for j in (0..n).rev() {
        if let Some(p) = full.parent[j] {
            above[p.index()] += above[j];
        }
    }
    let mut on_bole = vec![false; n];
    // For each joint, the number of its lateral children.
    let mut aside = vec![0_u32; n];
    for (j, wood) in above.iter().enumerate() {
        if let Some(p) = full.parent[j].map(JointId::index).filter(|&p| main[p] != Some(JointId::new(j))) {
            aside[p] += wood;
        }
    }
    for (root, whole) in (0..n).filter(|&j| full.parent[j].is_none()).map(|j| (j, above[j])) {
        let limb = (whole / 200).max(2);
        let mut at = Some(root);
        while let Some(j) = at {
            on_bole[j] = true;
            at = main[j].filter(|_| aside[j] < limb).map(JointId::index);
        }
    }
    on_bole
}

/// Thickens boles by a factor: most in their lower half, and decreasingly above their lowest limb.
fn swell(radius: &mut [f64], skeleton: &Skeleton, main: &[Option<JointId>], factor: f64) {
    let on_bole = boles(skeleton, main);
    for root in (0..skeleton.len()).filter(|&j| skeleton.parent[j].is_none()) {
        let trunk: Vec<usize> =
            core::iter::successors(Some(root), |&j| main[j].map(JointId::index)).collect();
        let mut along = vec![0.0];
        for w in trunk.windows(2) {
            along.push(along[along.len() - 1] + skeleton.position[w[0]].distance(skeleton.position[w[1]]));
        }
        let bole =
            trunk.iter().zip(&along).filter(|(j, _)| on_bole[**j]).map(|(_, s)| *s).fold(1e-9, f64::max);
        for (&j, s) in trunk.iter().zip(&along) {
            let u = s / bole;
            // A bottle: its shoulder begins at two thirds of the bole.
            let share = 1.0 - ops::smoothstep(0.65, 1.0 + SHOULDER, u);
            let belly = 1.0 + 0.1 * ops::sin(ops::PI * u.clamp(0.0, 1.0));
            radius[j] *= 1.0 + (factor * belly - 1.0) * share;
        }
    }
}

/// Computes radii by Eq 4 from the tips down; given radii of the skeleton take precedence.
pub(crate) fn radii(skeleton: &Skeleton, spec: &WoodSpec) -> Vec<f64> {
    let t = spec.pipe_exponent;
    let tip = ops::powf(spec.tip_radius_m, t);
    let own = |j: usize| Some(skeleton.radius_m[j]).filter(|r| *r > 0.0).map(|r| ops::powf(r, t));
    gathered(skeleton, tip, tip * spec.internode_share, own)
        .into_iter()
        .map(|p| ops::powf(p, 1.0 / t))
        .collect()
}

/// Returns the pipes at each joint, in units of a tip's, whatever radii the skeleton has.
pub(crate) fn pipes(skeleton: &Skeleton, internode_share: f64) -> Vec<f64> {
    gathered(skeleton, 1.0, internode_share, |_| None)
}

fn gathered(skeleton: &Skeleton, tip: f64, internode: f64, own: impl Fn(usize) -> Option<f64>) -> Vec<f64> {
    let mut pipes = vec![0.0; skeleton.len()];
    for j in (0..skeleton.len()).rev() {
        let is_tip = pipes[j] <= 0.0;
        pipes[j] += if is_tip { tip } else { internode };
        if let Some(own) = own(j) {
            pipes[j] = own;
        }
        // The foot of a tree is as thick as the stem on it.
        if let Some(p) = skeleton.parent[j] {
            pipes[p.index()] += pipes[j];
        }
    }
    pipes
}

/// Moves joints half-way to their parents, unless that leads into an obstacle.
fn relax(skeleton: &Skeleton, times: u32, obstacles: &Obstacles) -> Skeleton {
    let mut relaxed = skeleton.clone();
    for _ in 0..times {
        // Parents come first: going backwards, each still has its old position when its children read it.
        for j in (0..relaxed.len()).rev() {
            let Some(p) = relaxed.parent[j] else { continue };
            let middle = (relaxed.position[j] + relaxed.position[p.index()]) * 0.5;
            if obstacles.is_empty() || obstacles.free(middle) {
                relaxed.position[j] = middle;
            }
        }
    }
    relaxed
}

/// Returns the child that continues each joint's axis.
pub(crate) fn main_children(skeleton: &Skeleton, radius: &[f64]) -> Vec<Option<JointId>> {
    let mut main: Vec<Option<JointId>> = vec![None; skeleton.len()];
    let mut best = vec![f64::NEG_INFINITY; skeleton.len()];
    for (j, thickness) in radius.iter().enumerate() {
        let Some(p) = skeleton.parent[j] else { continue };
        let id = JointId::new(j);
        let turn = skeleton.heading(id).dot(skeleton.heading(p));
        // A straight child of two thirds of the radius wins over a thick one at right angles.
        let score = thickness * (2.0 + turn);
        if score > best[p.index()] {
            best[p.index()] = score;
            main[p.index()] = Some(id);
        }
    }
    main
}

/// One axis to be made: its first joint beyond the bearer, and the position of the bearer.
struct Start {
    joint: usize,
    key: u64,
}

fn axes(
    skeleton: &Skeleton,
    main: &[Option<JointId>],
    radius: &[f64],
    spec: &WoodSpec,
    obstacles: &Obstacles,
    run: &Run<'_>,
) -> Result<Wood, Cancelled> {
    let mut plant = Plant::default();
    let mut node_of_joint: Vec<Option<NodeId>> = vec![None; skeleton.len()];
    // Children of each joint that start axes, in order.
    let mut starts: Vec<Start> = Vec::new();
    let mut side: Vec<Vec<u32>> = vec![Vec::new(); skeleton.len()];
    for j in 0..skeleton.len() {
        match skeleton.parent[j] {
            None => {
                starts.push(Start { joint: j, key: Seed::new(u64::from(skeleton.tree[j])).child(1).number() })
            }
            Some(p) if main[p.index()] != Some(JointId::new(j)) => {
                side[p.index()].push(JointId::new(j).raw())
            }
            Some(_) => {}
        }
    }
    let (mut chain, mut way, mut kept) = (Vec::new(), Course::default(), Vec::new());
    let room = Room::new(obstacles, skeleton.size(), spec.tip_radius_m);
    // Largest radius of wood on each node: smaller where it was squeezed.
    let mut caps: Vec<f64> = Vec::new();
    let mut next = 0;
    while next < starts.len() {
        if next % 256 == 0 {
            run.cancel.check()?;
        }
        let Start { joint, key } = starts[next];
        next += 1;
        chain.clear();
        chain.extend(skeleton.parent[joint].map(JointId::index));
        let mut at = Some(joint);
        while let Some(j) = at {
            chain.push(j);
            at = main[j].map(JointId::index);
        }
        if chain.len() < 2 {
            continue;
        }
        let bearer = skeleton.parent[joint].and_then(|p| node_of_joint[p.index()]);
        if skeleton.parent[joint].is_some() && bearer.is_none() {
            continue;
        }
        course(skeleton, &chain, spec, radius, obstacles, &mut way);
        way.rooted = bearer.is_none();
        let mut foot = Foot { moved: DVec3::ZERO, cap: f64::INFINITY, within: 0.0 };
        if let Some(b) = bearer {
            let start = plant.nodes.position[b.index()];
            let straight = core::mem::replace(&mut way.points[0], start);
            // A borne axis starts with its own radius, not with its bearer's.
            way.radii[0] = way.radii[1];
            if !obstacles.is_empty() {
                let within = plant.nodes.radius_m[b.index()];
                foot = Foot { moved: start - straight, cap: caps[b.index()], within };
            }
        }
        room.clear(&mut way, foot);
        if way.points.len() < 2 {
            continue;
        }
        // Scars lie anywhere on a stem: it keeps its nodes for them.
        let scarred = bearer.is_none() && spec.scars != ScarSpec::default();
        let bears = |i: usize| scarred || way.joint[i].is_some_and(|k| !side[chain[k]].is_empty());
        thin_out(&way, bears, &mut kept);
        let line: Vec<DVec3> = kept.iter().map(|&i| way.points[i]).collect();
        let id = plant.add_axis(AxisKind::Branch, bearer, key, &line, None);
        for (node, &i) in plant.axis(id).node_ids().zip(&kept) {
            plant.nodes.radius_m[node.index()] = way.radii[i];
            if !obstacles.is_empty() {
                caps.push(way.cap[i]);
            }
            if let Some(k) = way.joint[i].filter(|&k| k > 0 || bearer.is_none()) {
                node_of_joint[chain[k]] = Some(node);
            }
        }
        for &j in &chain[usize::from(bearer.is_some())..] {
            for &s in &side[j] {
                let p = skeleton.position[s as usize];
                let place = p.x.to_bits() ^ p.y.to_bits().rotate_left(21) ^ p.z.to_bits().rotate_left(42);
                starts.push(Start { joint: s as usize, key: Seed::new(key).child(place).number() });
            }
        }
    }
    Ok(Wood { plant, node_of_joint })
}

/// Returns positions along a chain of joints. Smooth: the middle of each Bezier piece, whose ends are the middles of
/// the internodes and whose control point is the joint (Eq 3 with P0 = (M0 + M1) / 2, P1 = M1, P2 = (M1 + M2) / 2).
fn course(
    skeleton: &Skeleton,
    chain: &[usize],
    spec: &WoodSpec,
    radius: &[f64],
    obstacles: &Obstacles,
    way: &mut Course,
) {
    let at = |i: usize| skeleton.position[chain[i]];
    way.clear();
    for (i, &joint) in chain.iter().enumerate() {
        let here = at(i);
        let inner = spec.smooth && i > 0 && i + 1 < chain.len();
        let middle = if inner { (at(i - 1) + here * 6.0 + at(i + 1)) / 8.0 } else { here };
        // A course that was steered around a corner must not be smoothed into it.
        let open = obstacles.is_empty() || obstacles.free(middle);
        let point = if open { middle } else { here };
        way.add(point, radius[joint], Some(i), spec.thin_out * radius[joint]);
    }
}

/// Leaves out joints that bear nothing and hardly bend the course.
fn thin_out(way: &Course, bears: impl Fn(usize) -> bool, kept: &mut Vec<usize>) {
    let points = &way.points;
    kept.clear();
    kept.push(0);
    let mut last = 0;
    let end = points.len() - 1;
    for i in 1..end {
        let (a, b) = (points[last], points[i + 1]);
        let d = (b - a).normalize_or_zero();
        let aside = |p: DVec3| (p - a - d * (p - a).dot(d)).length();
        // At most eight at a time: a long straight trunk still gets some nodes.
        let straight = i - last < 8 && (last + 1..=i).all(|k| aside(points[k]) < way.aside[k]);
        let thins = (way.radii[i + 1] / way.radii[last.max(1)]) < 0.7;
        if bears(i) || !straight || thins {
            kept.push(i);
            last = i;
        }
    }
    kept.push(end);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CompetitionSpec, Obstacle, compete};
    use base::Report;

    fn oak(obstacles: &Obstacles) -> Skeleton {
        let run = Run::plain();
        let spec = CompetitionSpec { points: 600, ..CompetitionSpec::default() };
        compete(&[DVec3::ZERO], obstacles, &spec, Seed::new(1), &run, &mut Report::default())
            .expect("sound")
            .skeleton
    }

    #[test]
    fn eq_4_holds_at_every_fork_of_the_plant() {
        let s = oak(&Obstacles::none());
        for t in [2.0, 2.4, 3.0] {
            let spec =
                WoodSpec { pipe_exponent: t, internode_share: 0.0, thin_out: 0.0, ..WoodSpec::default() };
            let wood = make_wood(&s, &spec, &Obstacles::none(), &Run::plain()).expect("sound");
            let p = &wood.plant;
            let power = |r: f64| ops::powf(r, t);
            let mut forks = 0;
            for a in &p.axes {
                let rows: Vec<usize> = a.node_ids().map(NodeId::index).collect();
                for w in rows.windows(2).skip(1) {
                    let side: f64 = p
                        .axes
                        .iter()
                        .filter(|b| b.bearer.is_some_and(|n| n.index() == w[0]))
                        .map(|b| power(p.nodes.radius_m[b.nodes.start as usize]))
                        .sum();
                    let (below, above) = (power(p.nodes.radius_m[w[0]]), power(p.nodes.radius_m[w[1]]));
                    assert!((below - above - side).abs() < 1e-9 * below, "{t}");
                    forks += usize::from(side > 0.0);
                }
            }
            assert!(forks > 50, "{forks}");
        }
    }

    #[test]
    fn every_joint_that_forks_or_ends_is_a_node() {
        let s = oak(&Obstacles::none());
        let wood = make_wood(&s, &WoodSpec::default(), &Obstacles::none(), &Run::plain()).expect("sound");
        let children = s.children();
        for (j, c) in children.iter().enumerate() {
            if *c != 1 {
                assert!(wood.node_of_joint[j].is_some(), "{j}");
            }
        }
        let p = &wood.plant;
        assert_eq!(p.validate().count(), 0);
        let tips = children.iter().filter(|&&c| c == 0).count();
        assert_eq!(p.axes.len(), tips, "an axis for each tip");
        assert!(p.nodes.position.len() < s.len() + p.axes.len());
        assert!(p.axes.iter().map(|a| a.order).max() > Some(2));
        let keys: std::collections::BTreeSet<u64> = p.axes.iter().map(|a| a.key).collect();
        assert_eq!(keys.len(), p.axes.len());
    }

    #[test]
    fn pruning_one_branch_leaves_the_keys_of_others() {
        let s = oak(&Obstacles::none());
        let spec = WoodSpec { smooth: false, relax: 0, ..WoodSpec::default() };
        let keys = |s: &Skeleton| -> std::collections::BTreeSet<u64> {
            let wood = make_wood(s, &spec, &Obstacles::none(), &Run::plain()).expect("sound");
            wood.plant.axes.iter().map(|a| a.key).collect()
        };
        let last_tip = JointId::new(s.len() - 1);
        let (all, cut) = (keys(&s), keys(&s.prune(last_tip)));
        assert!(cut.difference(&all).count() <= 2, "{}", cut.difference(&all).count());
    }

    #[test]
    fn smoothing_softens_the_turns_and_keeps_out_of_obstacles() {
        let rock = Obstacle::Box { min: DVec3::new(0.5, 2.5, -1.0), max: DVec3::new(1.5, 4.5, 1.0) };
        let obstacles = Obstacles::new(&[rock], 0.03).expect("sound");
        let s = oak(&obstacles);
        let turn = |smooth: bool| {
            let relax = u32::from(smooth);
            let spec = WoodSpec { smooth, relax, thin_out: 0.0, ..WoodSpec::default() };
            let p = make_wood(&s, &spec, &obstacles, &Run::plain()).expect("sound").plant;
            assert!(p.nodes.position.iter().all(|&q| obstacles.inside(q).is_none()));
            // Next to the rock there are more nodes, which turn less.
            let p = make_wood(&s, &spec, &Obstacles::none(), &Run::plain()).expect("sound").plant;
            let axes = (0..p.axes.len()).map(plant::AxisId::new);
            let turns = axes.flat_map(|a| {
                let points = p.axis_points(a);
                let turn =
                    |w: &[DVec3]| ops::acos_clamped((w[1] - w[0]).normalize().dot((w[2] - w[1]).normalize()));
                points.windows(3).map(turn).collect::<Vec<_>>()
            });
            let turns: Vec<f64> = turns.collect();
            turns.iter().sum::<f64>() / turns.len() as f64
        };
        assert!(turn(true) < 0.85 * turn(false), "{} {}", turn(true), turn(false));
    }

    #[test]
    fn a_swollen_bole_is_a_bottle_and_limbs_are_as_thick_as_ever() {
        let s = oak(&Obstacles::none());
        let made = |swell: f64| {
            let spec = WoodSpec { swell, thin_out: 0.0, ..WoodSpec::default() };
            make_wood(&s, &spec, &Obstacles::none(), &Run::plain()).expect("sound").plant
        };
        let (plain, swollen) = (made(1.0), made(4.0));
        let ratio: Vec<f64> =
            swollen.nodes.radius_m.iter().zip(&plain.nodes.radius_m).map(|(a, b)| a / b).collect();
        let trunk = plain.axis(plant::AxisId::new(0)).nodes.clone();
        let foot = ratio[trunk.start as usize];
        assert!((3.9..4.5).contains(&foot), "{foot}");
        assert!((ratio[trunk.end as usize - 1] - 1.0).abs() < 1e-9);
        assert!(ratio[trunk.end as usize..].iter().all(|r| (r - 1.0).abs() < 1e-9));
    }

    #[test]
    fn a_trunk_as_thick_as_asked_for_and_a_root_alone() {
        let s = oak(&Obstacles::none());
        let spec = WoodSpec { trunk_radius_m: Some(0.3), ..WoodSpec::default() };
        let p = make_wood(&s, &spec, &Obstacles::none(), &Run::plain()).expect("sound").plant;
        assert!((p.nodes.radius_m[0] - 0.3).abs() < 1e-9);
        // The pipe model still holds: every radius is larger by one factor.
        let plain =
            make_wood(&s, &WoodSpec::default(), &Obstacles::none(), &Run::plain()).expect("sound").plant;
        let factor = 0.3 / plain.nodes.radius_m[0];
        let thinnest = |p: &Plant| p.nodes.radius_m.iter().copied().fold(1.0, f64::min);
        assert!((thinnest(&p) - factor * thinnest(&plain)).abs() < 1e-9, "{factor}");
        let mut alone = Skeleton::default();
        alone.push_root(DVec3::ZERO, 0);
        let p = make_wood(&alone, &spec, &Obstacles::none(), &Run::plain()).expect("sound").plant;
        assert!(p.axes.is_empty() && p.validate().count() == 0);
    }
}
