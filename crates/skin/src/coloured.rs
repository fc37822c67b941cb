//! Colours the vertices of tubes by the colours of their axes.

use mesh::TriMesh;
use plant::{AxisId, Plant};

use crate::sleeve::wide;
use crate::spine::Spine;

/// Default green of stems, linear.
const GREEN: [f32; 3] = [0.18, 0.30, 0.07];

/// Whether some axes of a plant have colours of their own.
pub(crate) fn is_coloured(plant: &Plant) -> bool {
    plant.axes.iter().any(|a| !a.colors.is_empty())
}

/// A plant whose axes have colours of their own.
pub(crate) struct Coloured<'a>(&'a Plant);

impl<'a> Coloured<'a> {
    /// Returns `None` for a plant without such an axis.
    pub(crate) fn new(plant: &'a Plant) -> Option<Self> {
        is_coloured(plant).then_some(Self(plant))
    }

    /// Colours the vertices of the tube of consecutive axes; an axis without colours gets that of stems.
    pub(crate) fn tube(&self, mesh: &mut TriMesh, axes: &[AxisId], spine: &Spine) {
        let lengths: Vec<f64> = axes.iter().map(|&a| geom::polyline_length3(self.0.axis_points(a))).collect();
        let whole = lengths.iter().sum::<f64>().max(f64::MIN_POSITIVE);
        let mut hint = 0;
        mesh.colors.clear();
        for p in &mesh.positions {
            let (station, near) = spine.nearest(wide(*p), hint);
            hint = near;
            // The length along the nodes: the smooth line is slightly longer.
            let mut way = station.s / spine.length().max(f64::MIN_POSITIVE) * whole;
            let mut row = 0;
            while row + 1 < axes.len() && way > lengths[row] {
                way -= lengths[row];
                row += 1;
            }
            let share = way / lengths.get(row).copied().unwrap_or(0.0).max(f64::MIN_POSITIVE);
            let color = axes.get(row).map_or(GREEN, |&a| self.colour_at(a, share));
            mesh.colors.push(color);
        }
    }

    /// Returns the colour of an axis at a share of its length.
    fn colour_at(&self, axis: AxisId, share: f64) -> [f32; 3] {
        let colors = &self.0.axis(axis).colors;
        let Some(last) = colors.len().checked_sub(1) else { return self.0.paint.stem.unwrap_or(GREEN) };
        // Each represents an equal part, and is its colour at the centre.
        let at = (share * colors.len() as f64 - 0.5).clamp(0.0, last as f64);
        let at = if at.is_finite() { at } else { 0.0 };
        let k = (base::ops::whole(at) as usize).min(last);
        let (a, b) = (colors[k], colors[(k + 1).min(last)]);
        #[expect(clippy::cast_possible_truncation, reason = "a colour of the mesh")]
        let t = (at - k as f64) as f32;
        [0, 1, 2].map(|c| a[c] + (b[c] - a[c]) * t)
    }
}
