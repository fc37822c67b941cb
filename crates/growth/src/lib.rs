//! Trees that grow by competition for space and light.
//!
//! `spec + seed -> attractors -> Skeleton -> Plant`
//!
//! | module | owns |
//! |---|---|
//! | `envelope` | the space of a crown, attraction points scattered in it |
//! | `obstacle` | boxes, balls, cylinders, planes and meshes that growth goes around |
//! | `colonize` | space colonisation (Runions 2007) |
//! | `competition` | life cycles of attraction points (paper 001) |
//! | `skeleton` | what growers make: joints and the joints they grew from |

mod colonize;
mod competition;
mod envelope;
mod error;
mod field;
mod obstacle;
mod skeleton;
mod solid;
mod tropism;

pub use colonize::{ColonizeSpec, Colonized, Fate, colonize, colonize_from, regrow};
pub use competition::{Competed, CompetitionSpec, Cycle, compete};
pub use envelope::{Envelope, Region};
pub use error::{GrowthError, MeshFault};
pub use obstacle::{Obstacle, Obstacles};
pub use skeleton::{JointId, Skeleton, SkeletonFault};
pub use tropism::Tropism;
