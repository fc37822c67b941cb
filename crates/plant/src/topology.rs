//! Axes and nodes.

use core::ops::Range;

use base::{Digest, Digestible};
use glam::DVec3;

use crate::ids::{AxisId, NodeId, ShapeId};
use crate::{Flower, Organ, PlantPaint, Shape};

/// Kind of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum AxisKind {
    /// Woody: trunk or branch.
    Branch,
    /// Woody, grown by the program inside a contour.
    Twig,
    /// Green stem of a herb or flower.
    Stem,
    /// Stalk of one leaf.
    Petiole,
    /// Below ground.
    Root,
    /// Woody and dead: the remains of a branch that broke off or rotted away, and the wood that grew over it.
    Stub,
}

impl AxisKind {
    /// Whether it is a living shoot that others may grow out of: not a leaf's stalk, a root, or the remains of a
    /// branch.
    pub const fn is_shoot(self) -> bool {
        !matches!(self, Self::Petiole | Self::Root | Self::Stub)
    }
}

/// One axis. Its nodes are consecutive rows, base first.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Its kind.
    pub kind: AxisKind,
    /// The node that bears it; `None` for an axis that stands on the ground. The axis's own first node lies at the
    /// bearer's position.
    pub bearer: Option<NodeId>,
    /// Branching order: 0 for an axis without a bearer, otherwise one more than that of the bearer's axis.
    pub order: u32,
    /// A key that is stable under edits of other parts, from which random draws for this axis are derived.
    pub key: u64,
    /// Rows of its nodes.
    pub nodes: Range<u32>,
    /// The stroke it was read from, by index in the drawing; `None` for axes that the program grew.
    pub source: Option<u32>,
    /// Its colours at even shares of its length, base first, linear RGB; empty if its surface decides. For stems and
    /// stalks only.
    pub colors: Vec<[f32; 3]>,
}

impl Axis {
    /// Iterates over the handles of its nodes, base first.
    pub fn node_ids(&self) -> impl DoubleEndedIterator<Item = NodeId> + ExactSizeIterator + use<> {
        (self.nodes.start as usize..self.nodes.end as usize).map(NodeId::new)
    }
}

/// The node columns, all of one length.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Nodes {
    /// Position, metres, +Y up, ground at y = 0.
    pub position: Vec<DVec3>,
    /// Radius of the axis at the node, metres, 0 or more. The first node of a borne axis has the radius of the new
    /// axis, not of its bearer.
    pub radius_m: Vec<f64>,
    /// The axis that each node belongs to.
    pub axis: Vec<AxisId>,
}

/// A plant made by any maker.
///
/// ```
/// use glam::DVec3;
/// use plant::{AxisKind, Plant};
/// let mut p = Plant::default();
/// let stem = p.add_axis(AxisKind::Stem, None, 1, &[DVec3::ZERO, DVec3::Y], None);
/// let node = p.axis(stem).node_ids().last().ok_or("empty")?;
/// p.add_axis(AxisKind::Stem, Some(node), 2, &[DVec3::Y, DVec3::new(0.5, 1.5, 0.0)], None);
/// assert_eq!((p.axes.len(), p.nodes.position.len(), p.axes[1].order), (2, 4, 1));
/// assert_eq!(p.validate().count(), 0);
/// # Ok::<(), &str>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plant {
    /// Name for files and reports.
    pub name: String,
    /// Axes; a bearer's axis always comes before the axes that it bears.
    pub axes: Vec<Axis>,
    /// Node columns.
    pub nodes: Nodes,
    /// Leaves, petals, discs, fruits, stamens.
    pub organs: Vec<Organ>,
    /// Flowers, each a group of organs.
    pub flowers: Vec<Flower>,
    /// Organ shapes; many organs may share one.
    pub shapes: Vec<Shape>,
    /// Colours of stems and veins.
    pub paint: PlantPaint,
}

impl Plant {
    /// Adds an axis through `points` (at least 2; the first at the bearer), radii 0 until set.
    pub fn add_axis(
        &mut self,
        kind: AxisKind,
        bearer: Option<NodeId>,
        key: u64,
        points: &[DVec3],
        source: Option<u32>,
    ) -> AxisId {
        let id = AxisId::new(self.axes.len());
        let start = NodeId::new(self.nodes.position.len()).raw();
        let end = NodeId::new(self.nodes.position.len() + points.len()).raw();
        let order = bearer.map_or(0, |b| self.axes[self.nodes.axis[b.index()].index()].order + 1);
        self.nodes.position.extend_from_slice(points);
        self.nodes.radius_m.extend(points.iter().map(|_| 0.0));
        self.nodes.axis.extend(points.iter().map(|_| id));
        self.axes.push(Axis { kind, bearer, order, key, nodes: start..end, source, colors: Vec::new() });
        id
    }

    /// Returns the axis of a handle.
    pub fn axis(&self, id: AxisId) -> &Axis {
        &self.axes[id.index()]
    }

    /// Returns the positions along an axis, base first.
    pub fn axis_points(&self, id: AxisId) -> &[DVec3] {
        let r = &self.axes[id.index()].nodes;
        &self.nodes.position[r.start as usize..r.end as usize]
    }

    /// Returns the radii along an axis, base first, metres.
    pub fn axis_radii(&self, id: AxisId) -> &[f64] {
        let r = &self.axes[id.index()].nodes;
        &self.nodes.radius_m[r.start as usize..r.end as usize]
    }

    /// Returns for each axis whether it is `top` or is borne by it, directly or indirectly; all false if there is no
    /// such axis.
    ///
    /// Guaranteed: it terminates, even for a plant that is not sound. Cost: linear.
    ///
    /// ```
    /// use glam::DVec3;
    /// use plant::{AxisId, AxisKind, NodeId, Plant};
    /// let mut plant = Plant::default();
    /// let stem = plant.add_axis(AxisKind::Stem, None, 1, &[DVec3::ZERO, DVec3::Y], None);
    /// let branch = plant.add_axis(AxisKind::Branch, Some(NodeId::new(1)), 2, &[DVec3::Y, DVec3::ONE], None);
    /// assert_eq!(plant.borne_by(stem), [true, true]);
    /// assert_eq!(plant.borne_by(branch), [false, true]);
    /// ```
    pub fn borne_by(&self, top: AxisId) -> Vec<bool> {
        let bearer = |i: usize| Some(self.nodes.axis.get(self.axes[i].bearer?.index())?.index());
        let mut known: Vec<Option<bool>> = vec![None; self.axes.len()];
        if let Some(top) = known.get_mut(top.index()) {
            *top = Some(true);
        }
        for i in 0..self.axes.len() {
            let (mut way, mut at) = (vec![i], bearer(i));
            if known[i].is_some() {
                continue;
            }
            // No longer than the number of axes: a sound plant has no cycle.
            while let Some(b) = at.filter(|&b| known[b].is_none() && way.len() <= self.axes.len()) {
                way.push(b);
                at = bearer(b);
            }
            let is = at.and_then(|b| known[b]).unwrap_or(false);
            way.into_iter().for_each(|w| known[w] = Some(is));
        }
        known.into_iter().map(|k| k == Some(true)).collect()
    }

    /// Returns the lowest and highest corner of the box around nodes and organs, roughly: an organ counts with its root
    /// and its reach. Positions that are not finite or absurdly far are left out; `None` if nothing remains.
    pub fn extent(&self) -> Option<(DVec3, DVec3)> {
        // A shape is measured once, however many organs have it.
        let reaches: Vec<f64> = self.shapes.iter().map(Shape::reach).collect();
        let organs = self.organs.iter().flat_map(|o| {
            let reach = reaches.get(o.shape.index()).copied().unwrap_or(0.0) * o.scale;
            [o.frame.origin, o.frame.origin + o.frame.along * reach]
        });
        let points = self.nodes.position.iter().copied().chain(organs);
        points
            .filter(|p| p.is_finite() && p.abs().max_element() < 1e12)
            .map(|p| (p, p))
            .reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
    }

    /// Adds a shape and returns its handle.
    pub fn add_shape(&mut self, shape: Shape) -> ShapeId {
        self.shapes.push(shape);
        ShapeId::new(self.shapes.len() - 1)
    }

    /// Returns the fingerprint of the whole plant: the same on every platform and for any thread count.
    pub fn digest_hex(&self) -> String {
        let mut d = Digest::new();
        d.add(self);
        d.hex()
    }
}

impl Digestible for Plant {
    fn digest(&self, d: &mut Digest) {
        d.add(&(self.axes.len() as u64));
        for a in &self.axes {
            d.add(&(a.kind as u8)).add(&a.bearer.map(NodeId::raw)).add(&a.order).add(&a.key);
            d.add(&a.nodes.start).add(&a.nodes.end).add(&a.source);
            if !a.colors.is_empty() {
                d.add(&a.colors);
            }
        }
        d.add(&self.nodes.position).add(&self.nodes.radius_m);
        d.add(&self.organs).add(&self.flowers).add(&self.shapes).add(&self.paint);
    }
}
