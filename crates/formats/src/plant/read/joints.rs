//! Joints that hang on one another -> axes of plants.

use core::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec3;
use plant::{AxisKind, NodeId, PipeModel, Plant, Taper, pipe_radii};

use super::{Fault, LIMITS, StructureTally, fault_at};
use crate::error::FileFault;

/// Connection of a joint to its parent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Link {
    /// It is the next node of the same axis.
    Follows,
    /// An axis begins there.
    Branches,
    /// The file does not say.
    Unsaid,
}

/// A place on an axis.
#[derive(Clone, Debug)]
pub(super) struct Joint {
    /// Metres, +Y up.
    pub(super) at: DVec3,
    /// Radius there, metres; not a number if unknown, as in the next two fields.
    pub(super) radius: f64,
    /// Radius at the base of the axis that begins with this joint, metres.
    pub(super) base_radius: f64,
    /// Radius of the cylinder that ends here, metres.
    pub(super) cylinder: f64,
    /// The joint on which it hangs.
    pub(super) parent: Option<usize>,
    pub(super) link: Link,
    /// Kind of the axis that begins with it.
    pub(super) kind: AxisKind,
    /// The plant of the file that it belongs to, if the file has plants.
    pub(super) plant: Option<usize>,
    /// Its line in the file.
    pub(super) line: usize,
}

impl Joint {
    pub(super) fn new(at: DVec3, parent: Option<usize>, link: Link, line: usize) -> Self {
        let unknown = f64::NAN;
        Self {
            at,
            radius: unknown,
            base_radius: unknown,
            cylinder: unknown,
            parent,
            link,
            kind: AxisKind::Branch,
            plant: None,
            line,
        }
    }
}

/// The plants, and the place of each joint in them.
pub(super) struct Built {
    pub(super) plants: Vec<Plant>,
    /// The plant and node of each joint; none if it is in no plant.
    pub(super) nodes: Vec<Option<(usize, NodeId)>>,
    pub(super) tally: StructureTally,
}

/// Stems whose feet are nearer to each other than this share of their greatest height form one plant: a clump of
/// hazel 6 m high is half a metre wide.
const CLUMP: f64 = 0.1;
/// Greatest distance of such feet, metres: trees of a forest stand farther apart.
const CLUMP_MOST_M: f64 = 1.0;
/// Radii that differ by less than this share do not decide which branch continues the axis.
const AS_THICK: f64 = 0.05;
/// Joints nearer to each other than this share of one metre plus their distance from the origin are the same.
const SAME: f64 = 1e-9;
/// Radii of an axis without any, at its base and at its tip, as shares of its bearer's radius.
const THINNED: [f64; 2] = [0.5, 0.15];

/// Joins joints to axes, and axes to plants.
///
/// # Errors
/// Parents that form a circle, too many roots.
pub(super) fn build(joints: &[Joint]) -> Result<Built, Fault> {
    let order = ordered(joints)?;
    let tree = Tree::new(joints, &order);
    let groups = tree.plants(joints)?;
    let mut built = Built {
        plants: Vec::new(),
        nodes: vec![None; joints.len()],
        tally: StructureTally { entries: joints.len() as u64, ..StructureTally::default() },
    };
    for roots in groups {
        tree.add_plant(joints, &roots, &mut built);
    }
    // Joints at the same place share a node.
    for &j in &order {
        if tree.same_as[j] != j {
            built.nodes[j] = built.nodes[tree.same_as[j]];
        }
    }
    built.tally.used = built.nodes.iter().filter(|n| n.is_some()).count() as u64;
    Ok(built)
}

/// Returns the rows of joints, parents before their children.
fn ordered(joints: &[Joint]) -> Result<Vec<usize>, Fault> {
    let children = Children::new(joints.len(), |j| joints[j].parent);
    let mut order: Vec<usize> = (0..joints.len()).filter(|&j| joints[j].parent.is_none()).collect();
    let mut next = 0;
    while let Some(&j) = order.get(next) {
        order.extend_from_slice(children.get(j));
        next += 1;
    }
    if order.len() == joints.len() {
        return Ok(order);
    }
    let mut seen = vec![false; joints.len()];
    order.iter().for_each(|&j| seen[j] = true);
    let first = seen.iter().position(|s| !s).unwrap_or(0);
    let advice = "an axis grows from what is below it: mend the parents";
    Err(fault_at(joints[first].line, "what it hangs on leads round in a circle", advice))
}

/// The children of each row.
struct Children {
    starts: Vec<usize>,
    rows: Vec<usize>,
}

impl Children {
    fn new(count: usize, parent: impl Fn(usize) -> Option<usize>) -> Self {
        let mut starts = vec![0; count + 1];
        (0..count).filter_map(&parent).for_each(|p| starts[p + 1] += 1);
        for k in 0..count {
            starts[k + 1] += starts[k];
        }
        let mut next = starts.clone();
        let mut rows = vec![0; starts[count]];
        for j in 0..count {
            if let Some(p) = parent(j) {
                rows[next[p]] = j;
                next[p] += 1;
            }
        }
        Self { starts, rows }
    }

    fn get(&self, row: usize) -> &[usize] {
        &self.rows[self.starts[row]..self.starts[row + 1]]
    }
}

/// Joints without those that lie at the place of their parent.
struct Tree {
    /// The joint at whose place each lies: itself for most.
    same_as: Vec<usize>,
    parent: Vec<Option<usize>>,
    link: Vec<Link>,
    radius: Vec<f64>,
    base_radius: Vec<f64>,
    children: Children,
    /// The child that continues the axis of each joint.
    next: Vec<Option<usize>>,
}

impl Tree {
    fn new(joints: &[Joint], order: &[usize]) -> Self {
        let count = joints.len();
        let mut same_as: Vec<usize> = (0..count).collect();
        let mut parent = vec![None; count];
        let mut link: Vec<Link> = joints.iter().map(|j| j.link).collect();
        let mut radius: Vec<f64> = joints.iter().map(|j| j.radius).collect();
        let mut base_radius: Vec<f64> = joints.iter().map(|j| j.base_radius).collect();
        for &j in order {
            let Some(before) = joints[j].parent else { continue };
            let on = same_as[before];
            // If the first place of a branch lies on its bearer, the branch begins with the next place.
            if before != on && link[before] == Link::Branches {
                link[j] = Link::Branches;
                if base_radius[j].is_nan() {
                    let own = base_radius[before];
                    base_radius[j] = if own.is_nan() { joints[before].radius } else { own };
                }
            }
            let apart = joints[j].at.distance(joints[on].at);
            if apart > SAME * (1.0 + joints[j].at.length()) {
                parent[j] = Some(on);
                continue;
            }
            same_as[j] = on;
            if radius[on].is_nan() {
                radius[on] = radius[j];
            }
        }
        let children = Children::new(count, |j| parent[j]);
        let mut far = vec![0.0_f64; count];
        for &j in order.iter().rev() {
            if let Some(p) = parent[j] {
                far[p] = far[p].max(far[j] + joints[j].at.distance(joints[p].at));
            }
        }
        let mut tree = Self { same_as, parent, link, radius, base_radius, children, next: vec![None; count] };
        for j in 0..count {
            tree.next[j] = tree.going_on(j, joints, &far);
        }
        tree
    }

    /// Returns the child that continues the axis of a joint.
    fn going_on(&self, row: usize, joints: &[Joint], far: &[f64]) -> Option<usize> {
        let children = self.children.get(row);
        if let Some(&said) = children.iter().find(|&&c| self.link[c] == Link::Follows) {
            return Some(said);
        }
        // An axis has at least two places.
        let is_root = self.parent[row].is_none();
        let able = children.iter().copied().filter(|&c| is_root || self.link[c] == Link::Unsaid);
        able.reduce(|best, c| {
            let thick =
                |c: usize| if joints[c].cylinder.is_nan() { self.radius[c] } else { joints[c].cylinder };
            let (a, b) = (thick(best), thick(c));
            let differ = (a - b).abs() > AS_THICK * a.max(b);
            let reach = |c: usize| far[c] + joints[c].at.distance(joints[row].at);
            let better = if differ { b > a } else { reach(c) > reach(best) };
            if better { c } else { best }
        })
    }

    /// Returns the roots of each plant.
    fn plants(&self, joints: &[Joint]) -> Result<Vec<Vec<usize>>, Fault> {
        let is_root = |j: &usize| self.parent[*j].is_none() && self.next[*j].is_some();
        let roots: Vec<usize> = (0..joints.len()).filter(is_root).collect();
        if roots.len() > LIMITS.roots {
            let (what, limit) = ("the number of axes that stand on nothing", LIMITS.roots as u64);
            let fault =
                FileFault::TooMuch { what, limit, advice: "are their parents missing? Or split the file" };
            return Err((0, fault));
        }
        let ys = || joints.iter().map(|j| j.at.y);
        let height = ys().fold(f64::NEG_INFINITY, f64::max) - ys().fold(f64::INFINITY, f64::min);
        let near = (CLUMP * height).min(CLUMP_MOST_M);
        let together = |a: usize, b: usize| match (joints[a].plant, joints[b].plant) {
            (Some(a), Some(b)) => a == b,
            _ => (joints[a].at - joints[b].at).with_y(0.0).length() <= near,
        };
        let mut groups: Vec<Vec<usize>> = Vec::new();
        for root in roots {
            let (with, without): (Vec<_>, Vec<_>) =
                groups.into_iter().partition(|g: &Vec<usize>| g.iter().any(|&r| together(r, root)));
            let mut one: Vec<usize> = with.into_iter().flatten().collect();
            one.push(root);
            groups = without;
            groups.push(one);
        }
        base::sort_by_key(&mut groups, |g| g[0]);
        Ok(groups)
    }

    fn add_plant(&self, joints: &[Joint], roots: &[usize], built: &mut Built) {
        let number = built.plants.len();
        let mut plant = Plant::default();
        let mut cylinders: Vec<f64> = Vec::new();
        let mut waiting: BinaryHeap<Reverse<(usize, usize)>> =
            roots.iter().map(|&r| Reverse((joints[r].line, r))).collect();
        while let Some(Reverse((_, first))) = waiting.pop() {
            let way: Vec<usize> = core::iter::successors(Some(first), |&j| self.next[j]).collect();
            let bearer = self.parent[first].and_then(|p| built.nodes[p]).map(|(_, node)| node);
            let foot = bearer.map(|b| plant.nodes.position[b.index()]);
            let points: Vec<DVec3> = foot.into_iter().chain(way.iter().map(|&j| joints[j].at)).collect();
            let id = plant.add_axis(joints[first].kind, bearer, first as u64 + 1, &points, None);
            let own = plant.axis(id).node_ids().skip(usize::from(bearer.is_some()));
            for (&j, node) in way.iter().zip(own) {
                built.nodes[j] = Some((number, node));
                plant.nodes.radius_m[node.index()] = self.radius[j];
                built.tally.radii_missing += u64::from(
                    self.radius[j].is_nan() && joints[j].cylinder.is_nan() && self.parent[j].is_some(),
                );
                let others = self.children.get(j).iter().filter(|&&c| Some(c) != self.next[j]);
                waiting.extend(others.map(|&c| Reverse((joints[c].line, c))));
            }
            if bearer.is_some() {
                plant.nodes.radius_m[plant.axes[id.index()].nodes.start as usize] = self.base_radius[first];
                cylinders.push(f64::NAN);
            }
            cylinders.extend(way.iter().map(|&j| joints[j].cylinder));
        }
        set_radii(&mut plant, &cylinders);
        built.plants.push(plant);
    }
}

/// Gives every node a radius: from the file, from the adjacent cylinders, or from its neighbours. `cylinders`: radius
/// of the cylinder that ends at each node.
fn set_radii(plant: &mut Plant, cylinders: &[f64]) {
    let known = plant.nodes.radius_m.iter().chain(cylinders).any(|r| !r.is_nan());
    if !known {
        plant.nodes.radius_m.fill(0.0);
        pipe_radii(plant, &usual_pipes());
        return;
    }
    for i in 0..plant.axes.len() {
        let rows = plant.axes[i].nodes.start as usize..plant.axes[i].nodes.end as usize;
        let points = plant.nodes.position[rows.clone()].to_vec();
        let below = plant.axes[i].bearer.map(|b| plant.nodes.radius_m[b.index()]);
        let radii = &mut plant.nodes.radius_m[rows.clone()];
        from_cylinders(radii, &cylinders[rows], &points);
        if radii.iter().all(|r| r.is_nan()) {
            let whole = geom::polyline_length3(&points);
            let base = below.unwrap_or(whole / 60.0);
            thin_out(radii, &points, base);
        }
        between(radii, &points);
    }
}

/// Returns the pipe model of a plant without measured radii: its foot is a sixtieth of its height.
fn usual_pipes() -> PipeModel {
    let taper = Taper { s: 1.0, alpha: 0.5, m: 0.0 };
    let (ground, drawn) = (vec![], vec![]);
    PipeModel { exponent: 2.5, taper, min_radius_m: 0.0, max_per_length: 0.05, ground, drawn }
}

/// Sets the radii of an axis that has none: from half of its bearer's at the base to less at the tip.
fn thin_out(radii: &mut [f64], points: &[DVec3], below: f64) {
    let whole = geom::polyline_length3(points).max(f64::MIN_POSITIVE);
    let mut gone = 0.0;
    for k in 0..points.len() {
        gone += if k > 0 { points[k].distance(points[k - 1]) } else { 0.0 };
        radii[k] = below * base::ops::lerp(THINNED[0], THINNED[1], gone / whole);
    }
}

/// Sets missing radii from the cylinders on both sides, such that the axis keeps its volume.
fn from_cylinders(radii: &mut [f64], cylinders: &[f64], points: &[DVec3]) {
    let count = radii.len();
    let unknown: Vec<usize> = (0..count).filter(|&k| radii[k].is_nan()).collect();
    for &k in &unknown {
        let sides = [cylinders[k], cylinders.get(k + 1).copied().unwrap_or(f64::NAN)];
        let there: Vec<f64> = sides.into_iter().filter(|r| !r.is_nan()).collect();
        if !there.is_empty() {
            radii[k] = (there.iter().map(|r| r * r).sum::<f64>() / there.len() as f64).sqrt();
        }
    }
    // Only if all are missing; otherwise the scale would change radii relative to those from the file.
    if unknown.len() < count || cylinders[1..].iter().chain(&*radii).any(|r| r.is_nan()) {
        return;
    }
    let (mut table, mut axis) = (0.0, 0.0);
    for k in 1..count {
        let long = points[k].distance(points[k - 1]);
        let (r, s) = (radii[k - 1], radii[k]);
        table += long * cylinders[k] * cylinders[k];
        axis += long * (r * r + r * s + s * s) / 3.0;
    }
    if axis > 0.0 {
        let scale = (table / axis).sqrt();
        radii.iter_mut().for_each(|r| *r *= scale);
    }
}

/// Interpolates missing radii between their neighbours, by the distance along the axis.
fn between(radii: &mut [f64], points: &[DVec3]) {
    let mut gone = vec![0.0; points.len()];
    for k in 1..points.len() {
        gone[k] = gone[k - 1] + points[k].distance(points[k - 1]);
    }
    let mut last: Option<usize> = None;
    for k in 0..radii.len() {
        if radii[k].is_nan() {
            continue;
        }
        for m in last.map_or(0, |l| l + 1)..k {
            radii[m] = match last {
                None => radii[k],
                Some(l) => {
                    let whole = (gone[k] - gone[l]).max(f64::MIN_POSITIVE);
                    base::ops::lerp(radii[l], radii[k], (gone[m] - gone[l]) / whole)
                }
            };
        }
        last = Some(k);
    }
    if let Some(last) = last {
        let end = radii[last];
        radii[last + 1..].fill(end);
    }
}
