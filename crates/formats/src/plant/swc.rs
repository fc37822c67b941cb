//! Plant -> SWC, the plain table of points that programs exchange for skeletons of trees, roots and neurons.

use std::io::Write;

use base::UpAxis;
use plant::{AxisKind, Plant};

use super::{decimal, length, micrometres, numbered, place, standing_on};
use crate::{ExportSpec, WriteError};

/// The first of the types that SWC leaves to its users.
pub(super) const FIRST_OWN: u32 = 5;
/// The comment that explains the types; it shows our reader that the rows of an axis follow one another.
pub(super) const TYPES: &str = "type: 5 branch, 6 twig, 7 stem, 8 petiole, 9 root, 10 stub";
/// Start of the comment that lists axes whose first row follows right after the row that bears them: without it the
/// reader would take them for a continuation of their bearer.
pub(super) const TIPS: &str = "begin on the row before:";

/// Writes the axes of a sound plant as SWC: after comments a row for each node, `id type x y z radius parent`,
/// separated by spaces. The comments give the unit, the axis that points up, and the meaning of the types. `id`
/// counts from 1, bearers come before the axes that they bear, and `parent` is -1 on the ground. `type`: 5 branch, 6
/// twig, 7 stem, 8 petiole, 9 root (0 to 4 are types of neurons). The first node of a borne axis lies on its bearer
/// and has no row of its own.
///
/// Lengths are in `spec`'s unit, to a micrometre, radii to 10 nanometres. Not written: organs, orders, names. Cost:
/// linear.
///
/// # Errors
/// [`WriteError::Io`].
///
/// ```
/// use glam::DVec3;
/// let mut p = plant::Plant::default();
/// p.add_axis(plant::AxisKind::Branch, None, 1, &[DVec3::ZERO, DVec3::Y * 2.0], None);
/// p.nodes.radius_m = vec![0.1, 0.05];
/// let mut out = Vec::new();
/// formats::write_swc(&p, &formats::ExportSpec::default(), &mut out)?;
/// assert!(String::from_utf8(out)?.ends_with("\n1 5 0 0 0 0.1 -1\n2 5 0 2 0 0.05 1\n"));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
pub fn write_swc(plant: &Plant, spec: &ExportSpec, mut out: impl Write) -> Result<(), WriteError> {
    writeln!(out, "# SWC: id type x y z radius parent")?;
    let up = match spec.up {
        UpAxis::Y => 'Y',
        UpAxis::Z => 'Z',
    };
    writeln!(out, "# Lengths in {} and {up} upwards", spec.unit.plural())?;
    writeln!(out, "# {TYPES}")?;
    let tips = tips(plant);
    if !tips.is_empty() {
        writeln!(out, "# {TIPS} {}", tips.join(" "))?;
    }
    let mut row_of = vec![0_usize; plant.nodes.position.len()];
    let mut row = 0;
    for (id, _) in numbered(plant) {
        let axis = plant.axis(id);
        let kind = FIRST_OWN
            + match axis.kind {
                AxisKind::Twig => 1,
                AxisKind::Stem => 2,
                AxisKind::Petiole => 3,
                AxisKind::Root => 4,
                AxisKind::Stub => 5,
                _ => 0,
            };
        let mut parent = axis.bearer.map_or(0, |b| row_of[standing_on(plant, b).index()]);
        let nodes = axis.node_ids().zip(plant.axis_points(id)).zip(plant.axis_radii(id));
        for ((node, &at), &radius) in nodes.skip(usize::from(parent > 0)) {
            row += 1;
            row_of[node.index()] = row;
            let [x, y, z] = place(spec, at).to_array().map(|x| micrometres(spec, x));
            let radius = decimal(length(spec, radius), 8);
            let bearer = if parent == 0 { "-1".to_owned() } else { parent.to_string() };
            writeln!(out, "{row} {kind} {x} {y} {z} {radius} {bearer}")?;
            parent = row;
        }
    }
    Ok(())
}

/// Returns the first rows of axes that begin right after the row that bears them.
fn tips(plant: &Plant) -> Vec<String> {
    let mut row_of = vec![0_usize; plant.nodes.position.len()];
    let (mut row, mut tips) = (0, Vec::new());
    for (id, _) in numbered(plant) {
        let axis = plant.axis(id);
        let bearer = axis.bearer.map_or(0, |b| row_of[standing_on(plant, b).index()]);
        if bearer > 0 && bearer == row {
            tips.push((row + 1).to_string());
        }
        for node in axis.node_ids().skip(usize::from(bearer > 0)) {
            row += 1;
            row_of[node.index()] = row;
        }
    }
    tips
}
