//! Labels of points, pixels and triangles: the parts that they lie on, as words, and their rows.

use glam::DVec3;
use mesh::Model;
use plant::{AxisId, AxisKind, OrganKind, Plant};

use crate::layout::{Layout, Owner};

/// Parts that a point can lie on, by the row that is its label.
pub const PARTS: [&str; 21] = [
    "branch", "twig", "stem", "petiole", "root", "leaf", "petal", "disc", "fruit", "stamen", "pistil",
    "thorn", "pedicel", "sepal", "anther", "floret", "body", "pot", "stub", "soil", "stone",
];

/// Row of soil in [`PARTS`].
pub const PART_OF_SOIL: u8 = 19;

/// Row of stones in [`PARTS`].
pub const PART_OF_STONE: u8 = 20;

/// Returns the row of an axis in [`PARTS`].
pub const fn part_of_axis(kind: AxisKind) -> u8 {
    match kind {
        AxisKind::Branch => 0,
        AxisKind::Twig => 1,
        AxisKind::Stem => 2,
        AxisKind::Petiole => 3,
        AxisKind::Stub => 18,
        _ => 4,
    }
}

/// Whether a row of [`PARTS`] is an axis, not an organ.
pub const fn part_is_of_axis(part: u8) -> bool {
    part < 5 || part == part_of_axis(AxisKind::Stub)
}

/// Returns the row of an organ in [`PARTS`].
pub const fn part_of_organ(kind: OrganKind) -> u8 {
    match kind {
        OrganKind::Leaf => 5,
        OrganKind::Petal => 6,
        OrganKind::Disc => 7,
        OrganKind::Fruit | OrganKind::Syncarp => 8,
        OrganKind::Stamen => 9,
        OrganKind::Pistil => 10,
        OrganKind::Thorn => 11,
        OrganKind::Pedicel => 12,
        OrganKind::Sepal => 13,
        OrganKind::Anther => 14,
        OrganKind::Floret => 15,
        OrganKind::Pot => 17,
        _ => 16,
    }
}

/// Row that means no axis or no organ.
pub const NOTHING: i32 = -1;

/// Label of a place of a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Label {
    /// Row of [`PARTS`].
    pub part: u8,
    /// Row of the plant's axes: the axis itself, or the one that bears the organ; [`NOTHING`] for none.
    pub axis: i32,
    /// Row of the plant's organs; [`NOTHING`] on axes.
    pub organ: i32,
    /// Branching order of the axis; 0 for none.
    pub order: i32,
}

/// Labels of the places of a model: the ends of the runs of each part, and their axes or organs.
#[derive(Clone, Debug)]
pub struct Labels<'a> {
    plant: &'a Plant,
    ends: Vec<Vec<(u32, Owner<'a>)>>,
}

impl<'a> Labels<'a> {
    /// Prepares the labels of a model of `plant`. `layout`: of this model.
    pub fn new(plant: &'a Plant, layout: &'a Layout) -> Self {
        let ends = layout.owners().map(|owners| {
            let mut end = 0;
            let run = |(owner, count): (Owner<'a>, u32)| {
                end += count;
                (end, owner)
            };
            owners.map(run).collect()
        });
        Self { plant, ends: ends.collect() }
    }

    /// Returns the label of the place `at` on a triangle of a part, in the coordinates of the plant; `None` outside the
    /// model. Of axes that share one tube it is the one whose line passes nearest.
    pub fn label(&self, part: u32, triangle: u32, at: DVec3) -> Option<Label> {
        let ends = self.ends.get(part as usize)?;
        let (_, owner) = ends.get(ends.partition_point(|(end, _)| *end <= triangle))?;
        Some(match owner {
            Owner::Axes(axes) => self.label_axis(self.nearest(axes, at)?),
            Owner::Organ(organ) => {
                let found = self.plant.organs.get(organ.index())?;
                let bearer = found.bearer.and_then(|n| self.plant.nodes.axis.get(n.index()));
                let axis = bearer.map_or(NOTHING, |a| row(a.index()));
                let order = bearer.map_or(0, |a| self.order(*a));
                Label { part: part_of_organ(found.kind), axis, organ: row(organ.index()), order }
            }
        })
    }

    fn label_axis(&self, axis: AxisId) -> Label {
        let (part, order) = (part_of_axis(self.plant.axis(axis).kind), self.order(axis));
        Label { part, axis: row(axis.index()), organ: NOTHING, order }
    }

    fn order(&self, axis: AxisId) -> i32 {
        self.plant.axes.get(axis.index()).map_or(0, |a| i32::try_from(a.order).unwrap_or(i32::MAX))
    }

    /// Returns, of axes that share one tube, the one whose line passes nearest.
    fn nearest(&self, axes: &[AxisId], at: DVec3) -> Option<AxisId> {
        let [first, others @ ..] = axes else { return None };
        if others.is_empty() {
            return Some(*first);
        }
        let away = |axis: &AxisId| {
            let lines = self.plant.axis_points(*axis).windows(2);
            lines.map(|l| squared_distance(at, l[0], l[1])).fold(f64::INFINITY, f64::min)
        };
        axes.iter().map(|a| (away(a), *a)).min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, axis)| axis)
    }
}

/// Returns the squared distance of a place from the segment between `a` and `b`.
fn squared_distance(at: DVec3, a: DVec3, b: DVec3) -> f64 {
    let way = b - a;
    let along = ((at - a).dot(way) / way.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    at.distance_squared(a + way * along)
}

fn row(index: usize) -> i32 {
    i32::try_from(index).unwrap_or(i32::MAX)
}

/// Returns the labels of the triangles of each part of a model: rows of [`PARTS`], of the plant's axes
/// and of its organs.
///
/// `layout`: of this model. A triangle of a tube along several axes has the axis that is nearest to its middle.
pub fn triangle_labels(plant: &Plant, model: &Model, layout: &Layout) -> Vec<Vec<[i32; 3]>> {
    let labels = Labels::new(plant, layout);
    let of_part = |(row, part): (u32, &mesh::Part)| {
        let triangles = (0_u32..).zip(&part.mesh.triangles);
        let of_triangle = |(k, corners): (u32, &[u32; 3])| {
            let corner = |i: u32| part.mesh.positions.get(i as usize).map_or(DVec3::ZERO, to_f64);
            let middle = corners.iter().map(|&i| corner(i)).sum::<DVec3>() / 3.0;
            let label = labels.label(row, k, middle);
            label.map_or([NOTHING; 3], |l| [i32::from(l.part), l.axis, l.organ])
        };
        triangles.map(of_triangle).collect()
    };
    (0_u32..).zip(&model.parts).map(of_part).collect()
}

fn to_f64(p: &[f32; 3]) -> DVec3 {
    DVec3::from_array(p.map(f64::from))
}
