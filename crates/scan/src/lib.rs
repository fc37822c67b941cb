//! Whole trees and seedlings from laser scans.
//!
//! `points -> ground, noise -> stems -> ways along the surface -> level sets -> axes -> radii -> Plant`
//!
//! | module | owns |
//! |---|---|
//! | `ground` | [`Ground`]: the terrain below a tree |
//! | `ways` | ways along the surface from the foot, across gaps |
//! | `trunks` | trunks seen at breast height: how many trees there are |
//! | `stems` | what stands on the ground: the tree, and what is left out |
//! | `foliage` | leaves told from wood |
//! | `levels` | level sets of the ways: the skeleton |
//! | `circle` | circles through noisy points |
//! | `radii` | radii from circles, the pipe model where points are few |
//! | `intervals` | [`Intervals`]: between which values volume, diameter and height lie |
//! | `tree` | [`find_tree`]: the whole way |
//! | `plot` | [`find_plot`]: many trees, points shared among them |
//! | `surface` | [`wood_gap`]: how far the wood of two plants is apart |
//! | `scanner` | [`scan`]: what a scanner would see of a mesh, for trials |

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
pub use tree::{FoundTree, find_tree};
pub use wanted::{ScanTally, TreeScanSpec};
