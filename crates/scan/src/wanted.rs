//! What can be asked of a search for a tree, and what it tells of the points.

use crate::radii::PipeSource;

/// How a tree is sought in a cloud. Lengths in metres, +Y up.
#[derive(Clone, Debug, PartialEq)]
pub struct TreeScanSpec {
    /// Where the stem stands, x and z; default the largest thing that stands on the ground.
    pub at: Option<[f64; 2]>,
    /// How far from [`at`](Self::at) a stem may stand. Default 2.
    pub at_within_m: f64,
    /// Edge of the cubes that the cloud is seen in; default by the spacing of the points.
    pub cell_m: Option<f64>,
    /// Widest gap that is bridged; default by the height, at most 0.6, and wider where most of the tree lies beyond it.
    pub gap_m: Option<f64>,
    /// What a point of bark may be off. Default 0.006.
    pub noise_m: f64,
}

impl Default for TreeScanSpec {
    fn default() -> Self {
        Self { at: None, at_within_m: 2.0, cell_m: None, gap_m: None, noise_m: 0.006 }
    }
}

/// What became of the points, and what was found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ScanTally {
    /// Usable points.
    pub points: usize,
    /// Of the ground.
    pub ground: usize,
    /// Strays, and pieces that nothing leads to.
    pub noise: usize,
    /// Of other things: other trees, people, walls.
    pub others: usize,
    /// Of leaves; 0 for a bare tree.
    pub leaves: usize,
    /// Share of places about which the cloud is neither a line nor a surface.
    pub scattered: f64,
    /// Of wood.
    pub wood: usize,
    /// Trunks that were seen at breast height, that of the tree too.
    pub stems: usize,
    /// Of large pieces that hang together with nothing that stands: a part of `noise`.
    pub loose: usize,
    /// How far the nearest of these is from the tree, metres; none without one.
    pub next_gap_m: Option<f64>,
    /// The widest gap beyond the usual one that was bridged, metres, as most of the tree lay beyond it.
    pub wide_gap_m: Option<f64>,
    /// Of the points that may be the tree's (no ground, nothing that stands apart), the share that is leaf, or wood near the
    /// surface that was found.
    pub explained: f64,
    /// The same for each tenth of the height, from below; none where there are no points.
    pub coverage: [Option<f64>; 10],
    /// The height of the highest of these points over the ground, metres.
    pub top_m: f64,
    /// Other things that stand on the ground.
    pub other_things: usize,
    /// Gaps that were bridged.
    pub bridges: usize,
    /// Edge of the cubes, metres.
    pub cell_m: f64,
    /// Rings of the skeleton, and those with a circle of their own.
    pub rings: usize,
    /// Rings with a circle.
    pub circles: usize,
    /// Exponent n of the pipe model `r^n ~ wood above`, as the circles have it.
    pub pipe_exponent: f64,
    /// Sound circles that it could be fitted to.
    pub pipe_circles: usize,
    /// Where that exponent comes from.
    pub pipe_source: PipeSource,
    /// Scatter of the circles about it, of the logarithm.
    pub pipe_scatter: f64,
}
