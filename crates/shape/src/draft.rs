//! The plant during an edit: branches as lists, so that cutting and grafting need no renumbering.
//!
//! `Plant -> Draft -> edits -> Plant`

use glam::{DQuat, DVec3};
use plant::{AxisKind, Flower, FlowerId, NodeId, Organ, Plant, PlantPaint, Shape};

use crate::carry::{self, Seat};

/// A node of a branch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct At {
    pub(crate) branch: usize,
    pub(crate) node: usize,
}

/// One axis.
#[derive(Clone, Debug)]
pub(crate) struct Branch {
    pub(crate) kind: AxisKind,
    pub(crate) key: u64,
    pub(crate) source: Option<u32>,
    pub(crate) colors: Vec<[f32; 3]>,
    pub(crate) bearer: Option<At>,
    pub(crate) points: Vec<DVec3>,
    pub(crate) radii: Vec<f64>,
    pub(crate) alive: bool,
    /// Whether the current edit made it.
    pub(crate) fresh: bool,
}

impl Branch {
    /// Returns the arc length at every node.
    pub(crate) fn lengths(&self) -> Vec<f64> {
        carry::lengths(&self.points)
    }

    pub(crate) fn length(&self) -> f64 {
        self.points.windows(2).map(|w| w[0].distance(w[1])).sum()
    }

    /// Returns the direction from base to tip, or any direction of a branch that ends where it starts.
    pub(crate) fn direction(&self) -> DVec3 {
        carry::direction(&self.points)
    }

    /// Returns the unit tangent at a node.
    pub(crate) fn tangent(&self, node: usize) -> DVec3 {
        carry::tangent(&self.points, node)
    }

    /// Whether it bears twigs, rather than being a leaf's stalk or a root.
    pub(crate) fn is_shoot(&self) -> bool {
        self.kind.is_shoot()
    }
}

/// An organ or flower and its seat.
#[derive(Clone, Debug)]
pub(crate) struct Borne<T> {
    pub(crate) what: T,
    pub(crate) at: Option<At>,
    pub(crate) alive: bool,
}

/// A plant in pieces.
#[derive(Clone, Debug)]
pub(crate) struct Draft {
    name: String,
    pub(crate) branches: Vec<Branch>,
    pub(crate) organs: Vec<Borne<Organ>>,
    pub(crate) flowers: Vec<Borne<Flower>>,
    pub(crate) shapes: Vec<Shape>,
    paint: PlantPaint,
}

impl Draft {
    pub(crate) fn new(plant: &Plant) -> Self {
        let at = |node: NodeId| {
            let axis = plant.nodes.axis.get(node.index())?.index();
            let node = node.index().checked_sub(plant.axes.get(axis)?.nodes.start as usize)?;
            Some(At { branch: axis, node })
        };
        let branches = (0..plant.axes.len()).map(|i| {
            let id = plant::AxisId::new(i);
            let axis = plant.axis(id);
            Branch {
                kind: axis.kind,
                key: axis.key,
                source: axis.source,
                colors: axis.colors.clone(),
                bearer: axis.bearer.and_then(at),
                points: plant.axis_points(id).to_vec(),
                radii: plant.axis_radii(id).to_vec(),
                alive: true,
                fresh: false,
            }
        });
        let organs = plant.organs.iter();
        let organs =
            organs.map(|o| Borne { what: o.clone(), at: o.bearer.and_then(at), alive: true }).collect();
        let flowers = plant.flowers.iter();
        let flowers =
            flowers.map(|f| Borne { what: f.clone(), at: f.bearer.and_then(at), alive: true }).collect();
        Self {
            name: plant.name.clone(),
            branches: branches.collect(),
            organs,
            flowers,
            shapes: plant.shapes.clone(),
            paint: plant.paint,
        }
    }

    /// Returns living branches, bearers first, otherwise in the order of their creation.
    pub(crate) fn order(&self) -> Vec<usize> {
        let n = self.branches.len();
        let mut state = vec![0_u8; n];
        let mut order = Vec::with_capacity(n);
        let mut stack = Vec::new();
        for i in 0..n {
            let mut b = i;
            // Up to the first bearer that is placed already; a branch met twice on this path is in a cycle and left
            // out.
            while state[b] == 0 && self.branches[b].alive {
                state[b] = 1;
                stack.push(b);
                match self.branches[b].bearer {
                    Some(at) if at.branch < n => b = at.branch,
                    _ => break,
                }
            }
            while let Some(b) = stack.pop() {
                let placed = self.branches[b].bearer.is_none_or(|at| {
                    state.get(at.branch) == Some(&2) && at.node < self.branches[at.branch].points.len()
                });
                if placed && self.branches[b].points.len() >= 2 {
                    state[b] = 2;
                    order.push(b);
                }
            }
        }
        order
    }

    /// Makes a plant of the living parts. Guaranteed: a clean `validate()` where the draft's numbers are finite.
    pub(crate) fn into_plant(self) -> Plant {
        let order = self.order();
        let (name, shapes, paint) = (self.name.clone(), self.shapes.clone(), self.paint);
        let mut plant = Plant { name, shapes, paint, ..Plant::default() };
        let mut start: Vec<Option<u32>> = vec![None; self.branches.len()];
        let node_of = |start: &[Option<u32>], at: At| {
            let first = start.get(at.branch).copied().flatten()?;
            (at.node < self.branches[at.branch].points.len()).then(|| NodeId::new(first as usize + at.node))
        };
        let mut points = Vec::new();
        for &b in &order {
            let branch = &self.branches[b];
            let bearer = branch.bearer.and_then(|at| node_of(&start, at));
            points.clear();
            points.extend_from_slice(&branch.points);
            if let (Some(node), Some(first)) = (bearer, points.first_mut()) {
                *first = plant.nodes.position[node.index()];
            }
            let id = plant.add_axis(branch.kind, bearer, branch.key, &points, branch.source);
            let rows = plant.axis(id).nodes.clone();
            plant.nodes.radius_m[rows.start as usize..].copy_from_slice(&branch.radii);
            plant.axes[id.index()].colors.clone_from(&branch.colors);
            start[b] = Some(rows.start);
        }
        let seated = |at: Option<At>| at.map(|at| node_of(&start, at));
        let mut flower_id = vec![None; self.flowers.len()];
        for (i, f) in self.flowers.iter().enumerate() {
            let bearer = seated(f.at);
            if f.alive && bearer != Some(None) {
                flower_id[i] = Some(FlowerId::new(plant.flowers.len()));
                plant.flowers.push(Flower { bearer: bearer.flatten(), ..f.what.clone() });
            }
        }
        for o in &self.organs {
            let bearer = seated(o.at);
            let flower = o.what.flower.map(|f| flower_id.get(f.index()).copied().flatten());
            if o.alive && bearer != Some(None) && flower != Some(None) {
                plant.organs.push(Organ {
                    bearer: bearer.flatten(),
                    flower: flower.flatten(),
                    ..o.what.clone()
                });
            }
        }
        plant
    }

    /// Counts nodes, leaves and flowers, also of dead branches: the pieces that an edit visits.
    pub(crate) fn pieces(&self) -> u64 {
        let nodes: usize = self.branches.iter().map(|b| b.points.len()).sum();
        (nodes + self.organs.len() + self.flowers.len()) as u64
    }

    /// Returns the numbers of the living branches that each branch bears.
    pub(crate) fn children(&self) -> Vec<Vec<usize>> {
        let mut children = vec![Vec::new(); self.branches.len()];
        for (i, b) in self.branches.iter().enumerate().filter(|(_, b)| b.alive) {
            if let Some(at) = b.bearer {
                children[at.branch].push(i);
            }
        }
        children
    }

    /// Marks the branches that are `top` or hang on it.
    pub(crate) fn subtree(&self, top: usize) -> Vec<bool> {
        let children = self.children();
        let mut inside = vec![false; self.branches.len()];
        let mut stack = vec![top];
        while let Some(b) = stack.pop() {
            if !inside[b] {
                inside[b] = true;
                stack.extend(&children[b]);
            }
        }
        inside
    }

    /// Removes branches with all that they bear. Returns how many there were.
    pub(crate) fn remove(&mut self, gone: &[bool]) -> usize {
        let mut count = 0;
        for (branch, gone) in self.branches.iter_mut().zip(gone) {
            count += usize::from(*gone && branch.alive);
            branch.alive &= !gone;
        }
        self.drop_fallen(|at| gone.get(at.branch) == Some(&true));
        count
    }

    /// Removes organs and flowers whose seat satisfies `gone`.
    pub(crate) fn drop_fallen(&mut self, gone: impl Fn(At) -> bool) {
        for f in &mut self.flowers {
            f.alive &= !f.at.is_some_and(&gone);
        }
        for o in &mut self.organs {
            o.alive &= !o.at.is_some_and(&gone);
            o.alive &= o.what.flower.is_none_or(|f| self.flowers.get(f.index()).is_some_and(|f| f.alive));
        }
    }

    /// Cuts a branch off at a share of its length; removes all of it if nothing would remain. Returns how many branches
    /// were removed with it.
    pub(crate) fn cut(&mut self, b: usize, at: f64) -> usize {
        let whole = self.branches[b].length();
        if at.is_nan() || at <= 1e-6 || whole <= 0.0 {
            let gone = self.subtree(b);
            return self.remove(&gone);
        }
        if at >= 1.0 {
            return 0;
        }
        let last = self.node_at(b, at);
        if last == 0 {
            let gone = self.subtree(b);
            return self.remove(&gone);
        }
        let mut gone = vec![false; self.branches.len()];
        for (i, branch) in self.branches.iter().enumerate() {
            if branch.alive && branch.bearer.is_some_and(|p| p.branch == b && p.node > last) {
                for (g, s) in gone.iter_mut().zip(self.subtree(i)) {
                    *g |= s;
                }
            }
        }
        let count = self.remove(&gone);
        // A leaf may sit a little above the node that bears it.
        let (end, along) = (self.branches[b].points[last], self.branches[b].tangent(last));
        self.branches[b].points.truncate(last + 1);
        self.branches[b].radii.truncate(last + 1);
        let kept = self.branches[b].length() / whole;
        let colors = &mut self.branches[b].colors;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "at most as many as there are"
        )]
        colors.truncate((colors.len() as f64 * kept).ceil().max(1.0) as usize);
        let slack = self.branches[b].radii[last];
        self.drop_fallen(|p| p.branch == b && p.node > last);
        for o in &mut self.organs {
            let above = (o.what.frame.origin - end).dot(along) > slack;
            o.alive &= !(above && o.at == Some(At { branch: b, node: last }));
        }
        count
    }

    /// Returns how deep a point lies below the bark of a branch, metres; negative outside.
    pub(crate) fn depth_in(&self, b: usize, p: DVec3) -> f64 {
        let branch = &self.branches[b];
        let (distance, share) = geom::nearest_on_polyline3(&branch.points, p);
        let lengths = branch.lengths();
        let at = share * lengths.last().copied().unwrap_or(0.0);
        let i = lengths.partition_point(|l| *l < at).min(branch.radii.len().saturating_sub(1));
        branch.radii.get(i).copied().unwrap_or(0.0) - distance
    }

    /// Returns the node at a share of a branch's length, inserted if there is none; a node within a hundredth of the
    /// length is used.
    pub(crate) fn node_at(&mut self, b: usize, share: f64) -> usize {
        let (i, t) = match Seat::find(&self.branches[b].points, share) {
            Seat::Node(node) => return node,
            Seat::Before(i, t) => (i, t),
        };
        let branch = &mut self.branches[b];
        let (p, q) = (branch.points[i - 1], branch.points[i]);
        let (r, r2) = (branch.radii[i - 1], branch.radii[i]);
        branch.points.insert(i, p.lerp(q, t));
        branch.radii.insert(i, r + (r2 - r) * t);
        let shift = |at: &mut Option<At>| {
            if let Some(at) = at.as_mut().filter(|at| at.branch == b && at.node >= i) {
                at.node += 1;
            }
        };
        self.branches.iter_mut().for_each(|b| shift(&mut b.bearer));
        self.organs.iter_mut().for_each(|o| shift(&mut o.at));
        self.flowers.iter_mut().for_each(|f| shift(&mut f.at));
        i
    }

    /// Moves branches with all that they bear: `p -> to + turn * (p - from)`.
    pub(crate) fn carry(&mut self, what: &[bool], from: DVec3, to: DVec3, turn: DQuat) {
        let place = |p: DVec3| to + turn * (p - from);
        for (branch, _) in self.branches.iter_mut().zip(what).filter(|(_, w)| **w) {
            branch.points.iter_mut().for_each(|p| *p = place(*p));
        }
        let hangs = |at: Option<At>| at.is_some_and(|at| what.get(at.branch) == Some(&true));
        for o in self.organs.iter_mut().filter(|o| hangs(o.at)) {
            let f = &mut o.what.frame;
            f.origin = place(f.origin);
            f.along = (turn * f.along).normalize_or(f.along);
            let normal = turn * f.normal;
            // Rounding of many turns adds up, so the frame is made orthonormal again.
            let right =
                f.along.cross(normal).try_normalize().unwrap_or_else(|| f.along.any_orthonormal_vector());
            (f.right, f.normal) = (right, right.cross(f.along));
        }
        for f in self.flowers.iter_mut().filter(|f| hangs(f.at)) {
            f.what.centre = place(f.what.centre);
            f.what.axis = (turn * f.what.axis).normalize_or(f.what.axis);
        }
    }

    /// Moves a living branch into the row of a dead one.
    pub(crate) fn exchange(&mut self, living: usize, dead: usize) {
        self.branches.swap(living, dead);
        let follow = |at: &mut Option<At>| {
            if let Some(at) = at.as_mut().filter(|at| at.branch == living) {
                at.branch = dead;
            }
        };
        self.branches.iter_mut().filter(|b| b.alive).for_each(|b| follow(&mut b.bearer));
        self.organs.iter_mut().filter(|o| o.alive).for_each(|o| follow(&mut o.at));
        self.flowers.iter_mut().filter(|f| f.alive).for_each(|f| follow(&mut f.at));
    }

    /// Returns the diagonal of the box around all living branches, metres; 1 for a plant without any.
    pub(crate) fn size(&self) -> f64 {
        let points = self.branches.iter().filter(|b| b.alive).flat_map(|b| &b.points);
        let (lo, hi) =
            points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), p| (lo.min(*p), hi.max(*p)));
        let size = (hi - lo).length();
        if size.is_finite() && size > 1e-9 { size } else { 1.0 }
    }

    /// Returns the share of its bearer's length at which a branch sits.
    pub(crate) fn share_of_bearer(&self, b: usize) -> f64 {
        let Some(at) = self.branches[b].bearer else { return 0.0 };
        let lengths = self.branches[at.branch].lengths();
        let whole = lengths.last().copied().unwrap_or(0.0);
        let s = lengths.get(at.node).copied().unwrap_or(0.0);
        if whole > 0.0 { s / whole } else { 0.0 }
    }

    /// Returns the shoots that stand on the ground (`None`) or on a branch, from its base up.
    pub(crate) fn shoots_on(&self, bearer: Option<usize>) -> Vec<usize> {
        let on = |b: &Branch| b.alive && b.is_shoot() && b.bearer.map(|at| at.branch) == bearer;
        let mut all: Vec<usize> = (0..self.branches.len()).filter(|&i| on(&self.branches[i])).collect();
        base::sort_by_key(&mut all, |&i| (self.branches[i].bearer.map(|at| at.node), i));
        all
    }
}
