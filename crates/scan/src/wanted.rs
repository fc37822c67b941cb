//! Settings of a search for a tree, and its report on the points.

use glam::DVec3;
use mesh::{PointClass, PointCloud};

use crate::radii::PipeSource;

/// The points of a scan, metres, +Y up, and what their file says of them.
#[derive(Clone, Copy, Debug)]
pub struct ScanPoints<'a> {
    /// Where they lie.
    pub places: &'a [DVec3],
    /// Their classes; empty, or one for each point.
    pub classes: &'a [PointClass],
}

impl<'a> From<&'a [DVec3]> for ScanPoints<'a> {
    fn from(places: &'a [DVec3]) -> Self {
        Self { places, classes: &[] }
    }
}

impl<'a> From<&'a Vec<DVec3>> for ScanPoints<'a> {
    fn from(places: &'a Vec<DVec3>) -> Self {
        places.as_slice().into()
    }
}

impl<'a> From<&'a PointCloud> for ScanPoints<'a> {
    fn from(cloud: &'a PointCloud) -> Self {
        Self { places: &cloud.points, classes: &cloud.classes }
    }
}

/// How a tree is sought in a cloud. Lengths in metres, +Y up.
#[derive(Clone, Debug, PartialEq)]
pub struct TreeScanSpec {
    /// Place of the stem, x and z; default the largest thing on the ground.
    pub at: Option<[f64; 2]>,
    /// Greatest distance of a stem from [`at`](Self::at). Default 2.
    pub at_within_m: f64,
    /// Edge of the cubes into which the cloud is divided; default by the spacing of the points.
    pub cell_m: Option<f64>,
    /// Widest gap that is bridged; default by the height, at most 0.6, and wider if much of the tree lies beyond it.
    pub gap_m: Option<f64>,
    /// Error of a point of bark. Default 0.006.
    pub noise_m: f64,
}

impl Default for TreeScanSpec {
    fn default() -> Self {
        Self { at: None, at_within_m: 2.0, cell_m: None, gap_m: None, noise_m: 0.006 }
    }
}

/// Counts of the points, and of the parts found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ScanTally {
    /// Number of usable points.
    pub points: usize,
    /// Number of points of the ground.
    pub ground: usize,
    /// Number of strays, and of points of pieces that no path reaches.
    pub noise: usize,
    /// Number of points of other things: other trees, people, walls.
    pub others: usize,
    /// Number of points of leaves; 0 for a bare tree.
    pub leaves: usize,
    /// Share of places around which the cloud is neither a line nor a surface.
    pub scattered: f64,
    /// Number of points of wood.
    pub wood: usize,
    /// Number of trunks detected at breast height, including that of the tree.
    pub stems: usize,
    /// Number of points of large pieces that are connected with nothing on the ground: a part of `noise`.
    pub loose: usize,
    /// Distance from the tree to the nearest of these pieces, metres; none without one.
    pub next_gap_m: Option<f64>,
    /// The widest bridged gap beyond the usual one, metres, if much of the tree lay beyond it.
    pub wide_gap_m: Option<f64>,
    /// Share of the points that may be the tree's (neither ground nor a separate thing) that are leaf, or wood near
    /// the found surface.
    pub explained: f64,
    /// The same for each tenth of the height, from below; none for tenths without points.
    pub coverage: [Option<f64>; 10],
    /// The height of the highest of these points over the ground, metres.
    pub top_m: f64,
    /// Number of other things on the ground.
    pub other_things: usize,
    /// Number of bridged gaps.
    pub bridges: usize,
    /// Edge of the cubes, metres.
    pub cell_m: f64,
    /// Number of rings of the skeleton.
    pub rings: usize,
    /// Number of rings with a circle.
    pub circles: usize,
    /// Exponent n of the pipe model `r^n ~ wood above`, according to the circles.
    pub pipe_exponent: f64,
    /// Number of sound circles for its fit.
    pub pipe_circles: usize,
    /// Source of that exponent.
    pub pipe_source: PipeSource,
    /// Scatter of the circles about the model, of the logarithm.
    pub pipe_scatter: f64,
}
