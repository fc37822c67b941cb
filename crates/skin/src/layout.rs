//! Position of a branch in the parts of a model: while the user drags it, its triangles are moved, not made again.
//!
//! `assembled parts -> triangles of each axis and organ -> triangles of a branch with all that it bears`

use core::ops::Range;

use plant::{AxisId, NodeId, OrganId, Plant};

/// Consecutive triangles of a part that belong together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Piece {
    of: Of,
    triangles: u32,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Of {
    Axis(AxisId),
    /// Consecutive axes that form one tube.
    Chain(Box<[AxisId]>),
    Organ(u32),
}

impl Piece {
    pub(crate) fn tube(axes: &[AxisId], triangles: usize) -> Self {
        let of = match axes {
            [one] => Of::Axis(*one),
            all => Of::Chain(all.into()),
        };
        Self { of, triangles: crate::sleeve::index(triangles) }
    }

    pub(crate) fn organ(row: usize, triangles: usize) -> Self {
        Self { of: Of::Organ(crate::sleeve::index(row)), triangles: crate::sleeve::index(triangles) }
    }
}

/// Position of the axes and organs of a plant in the parts of its model.
///
/// ```
/// use glam::DVec3;
/// use plant::{AxisKind, Plant};
/// let mut p = Plant::default();
/// let trunk = p.add_axis(AxisKind::Branch, None, 1, &[DVec3::ZERO, DVec3::Y, DVec3::Y * 2.0], None);
/// let fork = p.axis(trunk).node_ids().nth(1);
/// let limb = p.add_axis(AxisKind::Branch, fork, 2, &[DVec3::Y, DVec3::new(1.0, 1.5, 0.0)], None);
/// p.nodes.radius_m = vec![0.05; 5];
/// let run = base::Run::plain();
/// let (model, layout) = skin::skin_laid_out(&p, &skin::SkinSpec::default(), Default::default(), None, &run)?;
/// let rows = layout.branch(&p, limb).expect("a tube of its own");
/// let held: usize = rows[0].iter().map(|r| r.len()).sum();
/// assert!(held > 0 && held < model.parts[0].mesh.triangles.len());
/// # Ok::<(), base::Stopped>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Layout {
    parts: Vec<Vec<Piece>>,
}

/// Owner of consecutive triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Owner<'a> {
    /// One tube along these axes, each of which continues the one before.
    Axes(&'a [AxisId]),
    /// An organ.
    Organ(OrganId),
}

impl Layout {
    /// Iterates over the owners of the triangles of each part, in their order, with their numbers of triangles.
    pub fn owners(&self) -> impl Iterator<Item = impl Iterator<Item = (Owner<'_>, u32)>> {
        fn owner(p: &Piece) -> Owner<'_> {
            match &p.of {
                Of::Axis(axis) => Owner::Axes(core::slice::from_ref(axis)),
                Of::Chain(axes) => Owner::Axes(axes),
                Of::Organ(row) => Owner::Organ(OrganId::new(*row as usize)),
            }
        }
        self.parts.iter().map(|pieces| pieces.iter().map(|p| (owner(p), p.triangles)))
    }

    pub(crate) fn push<'a>(&mut self, pieces: impl Iterator<Item = &'a Piece>) {
        self.parts.push(pieces.cloned().collect());
    }

    /// Returns the triangles of a branch and of all that it bears, as ranges of each part, ascending and disjoint.
    /// `plant`: the one that the model is of.
    ///
    /// `None` if the branch is part of a tube that does not belong to it as a whole: then nothing can be moved alone.
    /// Cost: linear in the plant.
    pub fn branch(&self, plant: &Plant, axis: AxisId) -> Option<Vec<Vec<Range<u32>>>> {
        if axis.index() >= plant.axes.len() {
            return None;
        }
        let borne = plant.borne_by(axis);
        let has = |a: AxisId| borne.get(a.index()) == Some(&true);
        let on = |node: Option<NodeId>| {
            node.is_some_and(|n| plant.nodes.axis.get(n.index()).is_some_and(|a| has(*a)))
        };
        let organ = |row: u32| {
            plant.organs.get(row as usize).is_some_and(|o| {
                let flower = o.flower.and_then(|f| plant.flowers.get(f.index()));
                on(o.bearer) || flower.is_some_and(|f| on(f.bearer))
            })
        };
        let of_part = |pieces: &Vec<Piece>| {
            let (mut rows, mut first): (Vec<Range<u32>>, u32) = (Vec::new(), 0);
            for piece in pieces {
                let held = match &piece.of {
                    Of::Axis(a) => has(*a),
                    Of::Organ(row) => organ(*row),
                    Of::Chain(axes) => {
                        let all = axes.iter().filter(|a| has(**a)).count();
                        if all != 0 && all != axes.len() {
                            return None;
                        }
                        all > 0
                    }
                };
                let end = first.checked_add(piece.triangles)?;
                match rows.last_mut().filter(|last| held && last.end == first) {
                    Some(last) => last.end = end,
                    None if held && end > first => rows.push(first..end),
                    None => {}
                }
                first = end;
            }
            Some(rows)
        };
        self.parts.iter().map(of_part).collect()
    }

    /// Returns its approximate size in bytes.
    pub fn bytes(&self) -> usize {
        self.parts.iter().map(|p| size_of_val(p.as_slice())).sum()
    }
}
