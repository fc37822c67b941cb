//! Plant -> quantitative structure model: one cylinder a row, in the form of `TreeQSM`.

use std::io::Write;

use plant::Plant;

use super::{decimal, length, micrometres, numbered, place, standing_on, turn};
use crate::{ExportSpec, WriteError};

/// Writes the shoot of a sound plant as a table of cylinders (CSV with a head), in the terms of `TreeQSM` (Raumonen
/// et al. 2013): `radius`, `length`, `start_x` to `start_z`, `axis_x` to `axis_z` (unit vector), `parent` (row from
/// 1; 0 on the ground), `extension` (the row that continues the branch; 0 at its end), `branch` (from 1),
/// `BranchOrder` (0 for the trunk), `PositionInBranch` (from 1). After these come the names that R has for the same
/// numbers and without which rTwig refuses a table: `UnmodRadius` (the radius before a correction), `start.x` to
/// `axis.z`, and `added` (1 for a cylinder that closes a gap: none does). Last come the radii at both ends of the
/// internode, `start_radius` and `end_radius`, from which [`read_structure`](crate::read_structure) restores the same
/// nodes.
///
/// There is one cylinder for each internode with a length, base first, bearers before the axes that they bear; its
/// radius gives it the internode's volume. Lengths are in `spec`'s unit. Not written: roots, leaf stalks, organs.
/// Cost: linear.
///
/// # Errors
/// [`WriteError::Io`].
///
/// ```
/// use glam::DVec3;
/// let mut p = plant::Plant::default();
/// p.add_axis(plant::AxisKind::Branch, None, 1, &[DVec3::ZERO, DVec3::Y * 2.0], None);
/// p.nodes.radius_m = vec![0.1, 0.1];
/// let mut out = Vec::new();
/// formats::write_qsm(&p, &formats::ExportSpec::default(), &mut out)?;
/// assert!(String::from_utf8(out)?.ends_with("\n0.1,2,0,0,0,0,1,0,0,0,1,0,1,0.1,0,0,0,0,1,0,0,0.1,0.1\n"));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
pub fn write_qsm(plant: &Plant, spec: &ExportSpec, mut out: impl Write) -> Result<(), WriteError> {
    writeln!(
        out,
        "radius,length,start_x,start_y,start_z,axis_x,axis_y,axis_z,parent,extension,branch,BranchOrder,\
         PositionInBranch,UnmodRadius,start.x,start.y,start.z,axis.x,axis.y,axis.z,added,\
         start_radius,end_radius"
    )?;
    let shoot = plant.shoot();
    // The cylinder that ends at each node, from 1.
    let mut ends_at = vec![0_usize; plant.nodes.position.len()];
    let (mut row, mut branch) = (0, 0);
    for (id, _) in numbered(plant).filter(|(id, _)| shoot[id.index()]) {
        let axis = plant.axis(id);
        branch += 1;
        let points = plant.axis_points(id);
        let last = points.windows(2).rposition(|w| w[0] != w[1]);
        let mut parent = axis.bearer.map_or(0, |b| ends_at[standing_on(plant, b).index()]);
        // An axis on the foot of its bearer hangs on the bearer's first cylinder.
        if let Some(b) = axis.bearer.filter(|_| parent == 0) {
            let below = plant.axis(plant.nodes.axis[standing_on(plant, b).index()]);
            parent = below.node_ids().map(|n| ends_at[n.index()]).find(|r| *r > 0).unwrap_or(0);
        }
        let mut position = 0;
        for (k, (w, node)) in points.windows(2).zip(axis.node_ids().skip(1)).enumerate() {
            if w[0] == w[1] {
                ends_at[node.index()] = parent;
                continue;
            }
            row += 1;
            position += 1;
            let (r, s) = (plant.axis_radii(id)[k], plant.axis_radii(id)[k + 1]);
            let radius = length(spec, ((r * r + r * s + s * s) / 3.0).sqrt());
            let start = place(spec, w[0]);
            let axis_of = turn(spec, (w[1] - w[0]).normalize_or_zero());
            let extension = if Some(k) == last { 0 } else { row + 1 };
            let long = length(spec, w[0].distance(w[1]));
            // Radii are written to 10 nanometres, because twigs are thin.
            let [radius, from, to] = [radius, length(spec, r), length(spec, s)].map(|r| decimal(r, 8));
            let [x, y, z] = start.to_array().map(|x| micrometres(spec, x));
            let [u, v, w] = axis_of.to_array().map(|x| decimal(x, 8));
            let (line, order) = (format!("{x},{y},{z},{u},{v},{w}"), axis.order);
            write!(out, "{radius},{},{line},{parent},{extension},", micrometres(spec, long))?;
            writeln!(out, "{branch},{order},{position},{radius},{line},0,{from},{to}")?;
            ends_at[node.index()] = row;
            parent = row;
        }
    }
    Ok(())
}
