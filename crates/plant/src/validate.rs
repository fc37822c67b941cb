//! Invariants of a sound plant.

use crate::{AxisId, NodeId, OrganId, Plant, Shape, ShapeId};

/// A fault of a plant: always our bug, never the user's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PlantFault {
    /// The node columns differ in length.
    #[error("the node columns differ in length")]
    RaggedNodes,
    /// A node's position or radius is not finite, or its radius is negative.
    #[error("{0}: position or radius is not finite, or the radius is negative")]
    Node(NodeId),
    /// An axis's node range is out of bounds, overlaps another, or has fewer than 2 nodes.
    #[error("{0}: bad node range")]
    Range(AxisId),
    /// An axis's bearer does not exist, or belongs to the same or a later axis.
    #[error("{0}: the bearer does not come before it")]
    Bearer(AxisId),
    /// An axis's order is not one more than its bearer's.
    #[error("{0}: wrong order")]
    Order(AxisId),
    /// An axis does not start at its bearer.
    #[error("{0}: does not start at its bearer")]
    Detached(AxisId),
    /// An organ names a node, shape or flower that does not exist.
    #[error("{0}: names something that is not there")]
    OrganLink(OrganId),
    /// An organ's frame is not right-handed and orthonormal, or its scale is not above 0.
    #[error("{0}: bad frame or scale")]
    OrganFrame(OrganId),
    /// A shape has too few points, or a coordinate that is not finite.
    #[error("{0}: bad shape")]
    Shape(ShapeId),
    /// A flower's numbers are not finite, or it names a node that does not exist.
    #[error("flower {0}: bad numbers or bearer")]
    Flower(usize),
}

impl Plant {
    /// Iterates over all faults. An empty plant is sound. Cost: linear.
    pub fn validate(&self) -> impl Iterator<Item = PlantFault> + '_ {
        let n = &self.nodes;
        let ragged = n.position.len() != n.radius_m.len() || n.position.len() != n.axis.len();
        let nodes = n.position.iter().zip(&n.radius_m).enumerate();
        let nodes = nodes
            .filter(|(_, (p, r))| !(p.is_finite() && r.is_finite() && **r >= 0.0))
            .map(|(i, _)| PlantFault::Node(NodeId::new(i)));
        ragged
            .then_some(PlantFault::RaggedNodes)
            .into_iter()
            .chain(nodes)
            .chain((0..self.axes.len()).filter_map(|i| self.axis_fault(AxisId::new(i))))
            .chain((0..self.organs.len()).filter_map(|i| self.organ_fault(OrganId::new(i))))
            .chain((0..self.shapes.len()).filter_map(|i| self.shape_fault(ShapeId::new(i))))
            .chain((0..self.flowers.len()).filter_map(|i| self.flower_fault(i)))
    }

    fn axis_fault(&self, id: AxisId) -> Option<PlantFault> {
        let axis = self.axis(id);
        let (start, end) = (axis.nodes.start as usize, axis.nodes.end as usize);
        let expected = if id.index() == 0 { 0 } else { self.axes[id.index() - 1].nodes.end as usize };
        let last = id.index() + 1 == self.axes.len();
        if start != expected
            || end < start + 2
            || end > self.nodes.position.len()
            || (last && end != self.nodes.position.len())
            || self.nodes.axis.get(start..end).is_none_or(|a| a.iter().any(|&a| a != id))
        {
            return Some(PlantFault::Range(id));
        }
        let Some(bearer) = axis.bearer else {
            return (axis.order != 0).then_some(PlantFault::Order(id));
        };
        let Some(&bearer_axis) = self.nodes.axis.get(bearer.index()).filter(|a| a.index() < id.index())
        else {
            return Some(PlantFault::Bearer(id));
        };
        if axis.order != self.axis(bearer_axis).order + 1 {
            return Some(PlantFault::Order(id));
        }
        let gap = self.nodes.position[start].distance(self.nodes.position[bearer.index()]);
        let size = 1.0 + self.nodes.position[start].length();
        (gap > 1e-9 * size).then_some(PlantFault::Detached(id))
    }

    fn organ_fault(&self, id: OrganId) -> Option<PlantFault> {
        let organ = &self.organs[id.index()];
        if organ.bearer.is_some_and(|n| n.index() >= self.nodes.position.len())
            || organ.shape.index() >= self.shapes.len()
            || organ.flower.is_some_and(|f| f.index() >= self.flowers.len())
        {
            return Some(PlantFault::OrganLink(id));
        }
        let f = &organ.frame;
        let orthonormal = (f.right.cross(f.along) - f.normal).length() < 1e-6
            && (f.right.length() - 1.0).abs() < 1e-6
            && (f.along.length() - 1.0).abs() < 1e-6
            && f.right.dot(f.along).abs() < 1e-6;
        let sound = f.origin.is_finite() && orthonormal && organ.scale.is_finite() && organ.scale > 0.0;
        (!sound).then_some(PlantFault::OrganFrame(id))
    }

    fn shape_fault(&self, id: ShapeId) -> Option<PlantFault> {
        let positive = |r: f64| r.is_finite() && r > 0.0;
        let sound = match &self.shapes[id.index()] {
            Shape::Blade(b) => {
                b.outline.len() >= 3
                    && b.lines().all(|l| l.len() >= 2)
                    && b.veins.iter().all(|v| positive(v.boldness))
                    && b.outline.iter().chain(b.lines().flatten()).all(|p| p.is_finite())
                    && b.surface().points(&b.outline).iter().all(|p| p.is_finite())
            }
            Shape::Dome { radius_m, height_m } => positive(*radius_m) && height_m.is_finite(),
            Shape::Revolution { profile } => {
                profile.len() >= 2 && profile.iter().all(|p| p.is_finite() && p.x >= 0.0)
            }
            Shape::Spline(blade) => blade.sound(),
            Shape::Sheet(sheet) => sheet.sound(),
            Shape::Strand { path, radius_m, knob_m } => {
                path.len() >= 2
                    && path.len() == radius_m.len()
                    && path.iter().all(|p| p.is_finite())
                    && radius_m.iter().all(|r| r.is_finite() && *r >= 0.0)
                    && knob_m.is_finite()
                    && *knob_m >= 0.0
            }
        };
        (!sound).then_some(PlantFault::Shape(id))
    }

    fn flower_fault(&self, index: usize) -> Option<PlantFault> {
        let f = &self.flowers[index];
        let sound = f.centre.is_finite()
            && (f.axis.length() - 1.0).abs() < 1e-6
            && (0.0..=base::ops::FRAC_PI_2 + 1e-9).contains(&f.half_angle)
            && f.bearer.is_none_or(|n| n.index() < self.nodes.position.len());
        (!sound).then_some(PlantFault::Flower(index))
    }
}
