//! Clouds far from their origin, such as those in UTM coordinates: brought near it, and what was taken off is kept.

use burgeon::Report;
use burgeon::formats::ExportSpec;
use burgeon::glam::DVec3;
use burgeon::mesh::PointCloud;

/// What is taken off the clouds of one series: the first decides for all.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Origin {
    decided: bool,
    /// Metres, +Y up.
    pub(crate) offset_m: Option<DVec3>,
}

impl Origin {
    /// Brings points near the origin, as the first of their series. `axes` are those of their file.
    pub(crate) fn bring(&mut self, points: &mut [DVec3], axes: &ExportSpec, report: &mut Report) {
        if !self.decided {
            *self = Self { decided: true, offset_m: PointCloud::far_offset(points) };
            if let Some([x, y, z]) = self.told(axes) {
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

    /// The offset in metres, in the axes of the cloud's file: for the report.
    pub(crate) fn told(&self, axes: &ExportSpec) -> Option<[f64; 3]> {
        let metres = ExportSpec { up: axes.up, ..ExportSpec::default() };
        self.offset_m.map(|o| metres.place(o))
    }

    /// A place that a person gives in the coordinates of the cloud, as everything is placed here.
    pub(crate) fn place(&self, p: DVec3) -> DVec3 {
        p - self.offset_m.unwrap_or_default()
    }
}
