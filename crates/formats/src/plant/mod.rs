//! [`plant::Plant`] <-> bytes: the text formats that plant scientists use for the structure of plants.

mod mtg;
mod opf;
mod qsm;
mod read;
mod swc;

pub use mtg::write_mtg;
pub use opf::write_opf;
pub use qsm::write_qsm;
pub use read::{ReadStructure, StructureError, StructureSpec, StructureTally, read_structure};
pub use swc::write_swc;

use std::io::Write;

use base::{Unit, UpAxis};
use glam::DVec3;
use mesh::TriMesh;
use plant::{AxisId, NodeId, Plant};

use crate::{ExportSpec, StructureFormat, WriteError};

/// Writes the structure of a sound plant. `shapes`: the meshes of its shapes, which a format with meshes
/// ([`Room::OrganMeshes`](crate::Room::OrganMeshes)) writes with its organs ([`write_opf`]); the others need none.
/// Cost: linear.
///
/// # Errors
/// [`WriteError::Io`].
///
/// ```
/// use formats::{ExportSpec, StructureFormat, write_structure};
/// use glam::DVec3;
/// let mut p = plant::Plant::default();
/// p.add_axis(plant::AxisKind::Branch, None, 1, &[DVec3::ZERO, DVec3::Y * 2.0], None);
/// for format in StructureFormat::ALL {
///     let mut out = Vec::new();
///     write_structure(&p, &[], format, &ExportSpec::default(), &mut out)?;
///     assert!(!out.is_empty());
/// }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
pub fn write_structure(
    plant: &Plant,
    shapes: &[TriMesh],
    format: StructureFormat,
    spec: &ExportSpec,
    out: impl Write,
) -> Result<(), WriteError> {
    write_structure_with(plant, shapes, &[], format, spec, out)
}

/// A column of computed numbers of a plant's axes and organs, for files that have room for it.
///
/// A missing row, or one without a number, stays empty. Numbers are written unchanged, whatever the unit of the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AddedColumn {
    /// Its name: letters and digits, the first a letter.
    pub name: String,
    /// The number of each axis.
    pub axes: Vec<Option<f64>>,
    /// The number of each organ.
    pub organs: Vec<Option<f64>>,
}

/// Writes as [`write_structure`] does, with further columns of axes and organs; MTG and OPF have room for them, other
/// formats leave them out.
///
/// # Errors
/// [`WriteError::Io`].
pub fn write_structure_with(
    plant: &Plant,
    shapes: &[TriMesh],
    added: &[AddedColumn],
    format: StructureFormat,
    spec: &ExportSpec,
    out: impl Write,
) -> Result<(), WriteError> {
    match format {
        StructureFormat::Mtg => mtg::write_mtg_with(plant, added, spec, out),
        StructureFormat::Opf => opf::write_opf_with(plant, shapes, added, spec, out),
        StructureFormat::Qsm => write_qsm(plant, spec, out),
        StructureFormat::Swc => write_swc(plant, spec, out),
    }
}

/// Subject of a line of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Subject {
    Axis(usize),
    Organ(usize),
}

impl AddedColumn {
    /// Returns the number as written, to nine decimal places; empty for none.
    fn cell(&self, subject: Option<Subject>) -> String {
        let number = match subject {
            Some(Subject::Axis(row)) => self.axes.get(row),
            Some(Subject::Organ(row)) => self.organs.get(row),
            None => None,
        };
        let number = number.copied().flatten().filter(|x| x.is_finite());
        number.map_or_else(String::new, |x| decimal(x, 9))
    }
}

/// Converts a length in metres to the unit of the file.
fn length(spec: &ExportSpec, metres: f64) -> f64 {
    match spec.unit {
        Unit::Metre => metres,
        Unit::Centimetre => metres * 100.0,
        Unit::Millimetre => metres * 1000.0,
        Unit::Foot => metres / spec.unit.metres(),
    }
}

/// Converts a direction to the axes of the file.
fn turn(spec: &ExportSpec, v: DVec3) -> DVec3 {
    match spec.up {
        UpAxis::Y => v,
        UpAxis::Z => DVec3::new(v.x, -v.z, v.y),
    }
}

fn place(spec: &ExportSpec, p: DVec3) -> DVec3 {
    DVec3::from_array(spec.place(p))
}

/// Formats a plain decimal with at most `digits` decimal places: readers of MTG split at the `+` of `1e+5`.
fn decimal(x: f64, digits: usize) -> String {
    let mut text = format!("{x:.digits$}");
    if text.contains('.') {
        text.truncate(text.trim_end_matches('0').trim_end_matches('.').len());
    }
    if text == "-0" { "0".into() } else { text }
}

/// Formats a length or position to a micrometre.
fn micrometres(spec: &ExportSpec, x: f64) -> String {
    let digits = match spec.unit {
        Unit::Metre | Unit::Foot => 6,
        Unit::Centimetre => 4,
        Unit::Millimetre => 3,
    };
    decimal(x, digits)
}

/// Returns the bearer of an axis as a node with a place of its own: the first node of a borne axis has none, it lies
/// at its bearer.
fn standing_on(plant: &Plant, mut node: NodeId) -> NodeId {
    loop {
        let axis = plant.axis(plant.nodes.axis[node.index()]);
        match axis.bearer {
            // Bearers come first, so this descends to an end.
            Some(bearer) if axis.nodes.start as usize == node.index() => node = bearer,
            _ => return node,
        }
    }
}

/// The axes and organs that each node bears: their rows, in order.
struct Borne {
    axes: Vec<(NodeId, AxisId)>,
    organs: Vec<(NodeId, usize)>,
}

impl Borne {
    fn from_plant(plant: &Plant) -> Self {
        let axes =
            numbered(plant).filter_map(|(id, _)| Some((standing_on(plant, plant.axis(id).bearer?), id)));
        let organs = plant.organs.iter().enumerate();
        let organs = organs.filter_map(|(i, o)| Some((standing_on(plant, o.bearer?), i)));
        let (mut axes, mut organs): (Vec<_>, Vec<_>) = (axes.collect(), organs.collect());
        // The sort is stable: at each node, the order is that of the plant.
        base::sort_by_key(&mut axes, |(node, _)| *node);
        base::sort_by_key(&mut organs, |(node, _)| *node);
        Self { axes, organs }
    }

    fn on<T: Copy>(list: &[(NodeId, T)], node: NodeId) -> impl Iterator<Item = T> + '_ {
        let from = list.partition_point(|(n, _)| *n < node);
        list[from..].iter().take_while(move |(n, _)| *n == node).map(|(_, x)| *x)
    }
}

/// Returns the axes, and the number of each on the way up, from 1.
fn numbered(plant: &Plant) -> impl Iterator<Item = (AxisId, usize)> + '_ {
    (0..plant.axes.len()).map(|i| (AxisId::new(i), i + 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_plain_decimals() {
        let written = [1.0, -0.0, 0.1, 1e-9, -1e-9, 123_456.789_012_3, 1e10, -2.5].map(|x| decimal(x, 6));
        assert_eq!(written, ["1", "0", "0.1", "0", "0", "123456.789012", "10000000000", "-2.5"]);
    }
}
