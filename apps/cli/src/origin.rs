//! Clouds far from their origin, such as those in UTM coordinates: moved near it, with the offset kept.

use burgeon::Report;
use burgeon::formats::ExportSpec;
use burgeon::glam::DVec3;
use burgeon::mesh::PointCloud;

/// Offset subtracted from the clouds of one series: the first cloud decides for all.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Origin {
    decided: bool,
    /// Offset in metres, +Y up.
    pub(crate) offset_m: Option<DVec3>,
}

impl Origin {
    /// Moves points near the origin, as the first of their series decides. `axes` are those of their file.
    pub(crate) fn bring(&mut self, points: &mut [DVec3], axes: &ExportSpec, report: &mut Report) {
        if !self.decided {
            *self = Self { decided: true, offset_m: PointCloud::far_offset(points) };
            if let Some([x, y, z]) = self.offset_in(axes) {
                report.warn(
                    "far-from-origin",
                    format!(
                        "the points lie far from their origin: {x}, {y}, {z} m were taken off their coordinates, which \
                         single precision would blur; files keep this offset as a note, the report as input.offset_m"
                    ),
                );
            }
        }
        if let Some(offset) = self.offset_m {
            points.iter_mut().for_each(|p| *p -= offset);
        }
    }

    /// Returns the offset in metres, in the axes of the cloud's file: for the report.
    pub(crate) fn offset_in(&self, axes: &ExportSpec) -> Option<[f64; 3]> {
        let metres = ExportSpec { up: axes.up, ..ExportSpec::default() };
        self.offset_m.map(|o| metres.place(o))
    }

    /// Moves a place that a person gives in the coordinates of the cloud in the same way.
    pub(crate) fn place(&self, p: DVec3) -> DVec3 {
        p - self.offset_m.unwrap_or_default()
    }
}
