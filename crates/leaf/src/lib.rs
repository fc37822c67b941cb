//! Leaves from measured veins (Wang et al. 2011): marks -> veins with thickness and a blade through the same points.
//!
//! `Marks -> complete -> Leaf { veins, blade } -> plant::SplineBlade`
//!
//! | module | owns |
//! |---|---|
//! | `marks` | [`Marks`]: measurements, their gaps, the rule of Wang et al. (2011) for missing thickness |
//! | `margin` | [`MarginPoint`]: a margin of the leaf's own, that follows the blade |
//! | `form` | [`LeafForm`]: a few numbers -> marks |
//! | `graph` | [`VeinGraph`]: a network of veins with radii -> marks |
//! | `outline` | the margin around a network of veins |
//! | `palmate` | a network whose chief veins start together -> rays |
//! | `blade` | [`Leaf`]: the four surfaces, veins that lie on them |
//! | `leaf_blade` | [`leaf_blade()`]: a leaf as the blade of another maker's plant |
//! | `pose` | curl and wilt |
//! | `balls` | [`BallMove`]: control balls moved by hand |
//! | `profile` | [`LeafProfile`]: a midrib from the side and the width along it -> rays |
//! | `growth` | a leaf between measured stages |
//! | `rays` | [`Rays`], [`RayLeaf`]: palmate and parallel leaves, made or measured |
//! | `lobes` | side veins of the lobes of palmate leaves |
//! | `scan` | a leaf found in a cloud of points |
//!
//! Lengths are metres. A leaf knows nothing of the plant that bears it; its triangles are `skin`'s to make.

mod balls;
mod blade;
mod form;
mod graph;
mod growth;
mod leaf_blade;
mod lobes;
mod margin;
mod marks;
mod outline;
mod palmate;
mod pose;
mod profile;
mod rays;
mod scan;
mod spec;
mod thickness;

pub use balls::{BallMove, ball_sides, ball_sides_of_rays};
pub use blade::Leaf;
pub use form::LeafForm;
pub use graph::{GraphError, VeinGraph};
pub use growth::{LeafGrowth, StagesError};
pub use leaf_blade::leaf_blade;
pub use marks::{FullMarks, FullRow, MARKS_A_ROW, MarginPoint, MarkRow, Marks, MarksError};
pub use pose::Pose;
pub use profile::{LeafProfile, ProfileError};
pub use rays::{ChiefVein, PalmateSpec, ParallelSpec, RayLeaf, Rays, RaysError};
pub use scan::{ScanError, ScanLeaf, ScanSpec, fit_scan};
pub use spec::{LeafPaint, LeafSpec, SurfaceKind, VeinParameters};
pub use thickness::ThicknessRule;
