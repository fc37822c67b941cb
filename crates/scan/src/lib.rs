//! Whole trees and seedlings from laser scans.
//!
//! `points -> ground, noise -> stems -> paths along the surface -> level sets -> axes -> radii -> Plant`
//!
//! | module | owns |
//! |---|---|
//! | `ground` | [`Ground`]: the terrain below a tree |
//! | `ways` | paths along the surface from the foot, across gaps |
//! | `trunks` | trunks at breast height: the number of trees |
//! | `stems` | things on the ground: the tree, and others, which are left out |
//! | `foliage` | separation of leaves and wood |
//! | `levels` | level sets of the paths: the skeleton |
//! | `circle` | circles through noisy points |
//! | `radii` | radii from circles, the pipe model where points are few |
//! | `intervals` | [`Intervals`] of volume, diameter and height |
//! | `tree` | [`find_tree`]: all steps |
//! | `plot` | [`find_plot`]: many trees, with the points assigned to them |
//! | `surface` | [`wood_gap`]: distance between the wood of two plants |
//! | `scanner` | [`scan`]: the points that a scanner would measure on a mesh, for trials |
//! | `survey`, `survey_spec`, `beams` | [`survey()`]: plants and stands as a scanner sees them, each point with its part |

mod beams;
mod circle;
mod error;
mod foliage;
mod ground;
mod intervals;
mod levels;
mod plot;
mod radii;
mod scanner;
mod stems;
mod surface;
mod survey;
mod survey_spec;
mod tree;
mod trunks;
mod wanted;
mod ways;

pub use error::ScanTreeError;
pub use ground::Ground;
pub use intervals::{Interval, Intervals};
pub use plot::{Plot, PlotTree, find_plot};
pub use radii::PipeSource;
pub use scanner::{ScannerSpec, scan, wood_mesh};
pub use surface::{Gap, wood_gap};
pub use survey::{Stood, Surveyed, survey, survey_stand};
pub use survey_spec::{SurveyError, SurveySpec};
pub use tree::{FoundTree, find_tree};
pub use wanted::{ScanPoints, ScanTally, TreeScanSpec};
