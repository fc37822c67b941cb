//! The plant of a drawing that was read (He and Cheng 2021).
//!
//! `Reading -> Plant`
//!
//! | step | module | paper |
//! |---|---|---|
//! | fill contours | `fill` | section 4.3, Eq 2 |
//! | depth | `depth` | section 5, Eq 3, 4 |
//! | radii, plant | `build` | section 6, Eq 5 to 7 |
//! | fidelity of the plant to the drawing | `fidelity` | |

mod bodies;
mod build;
mod depth;
mod fidelity;
mod fill;
mod front;
mod map;
mod spec;

pub use self::spec::{BranchDepth, FillSpec, LeafDepth, PullSet, ReliefSpec, SketchSpec, TaperSpec};
pub use build::{Built, build, build_again};
pub use fidelity::{Fidelity, StrokeFidelity, fidelity};
pub use fill::{GrownContour, KeptBodies};
pub use map::PlantMap;
