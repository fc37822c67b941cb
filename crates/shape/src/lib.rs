//! Hand edits on any plant: rotate, move, copy, prune, regrow, sketch, brush, grow, fill a silhouette, thin leaves (the
//! VR paper).
//!
//! `Plant + [HandEdit] -> Plant + [Outcome]`
//!
//! | module | owns |
//! |---|---|
//! | `edit` | the edits as plain data |
//! | `key` | names of branches that survive a change |
//! | `apply` | one edit after another; rotate, move, prune |
//! | `carry` | the motion of a branch in the hand, with all that it bears |
//! | `bench` | the context of every edit, and reasons why one stops |
//! | `draft` | the plant in pieces while it is edited |
//! | `habit` | properties of new wood, learnt from the plant |
//! | `pipes` | radii below a change |
//! | `graft` | grown wood, added to the plant |
//! | `sketch_branch`, `grow`, `fill`, `leaves` | drawn and brushed branches; held growth; regrowth and silhouettes; leaves |
//! | `seat` | the new seat of a branch that is moved or copied |
//! | `twin` | duplicates of a branch: copies and mirror images |
//! | `mask` | an outline as markers in space |
//! | `pick` | the branch that a ray points at |
//! | `thumb` | rotations and tilts from a touchpad or stick |
//! | `tool` | gestures of a hand as state machines |
//! | `outcome` | success, or the reason why not, in plain words |

mod apply;
mod bench;
mod carry;
mod draft;
mod edit;
mod fill;
mod graft;
mod grow;
mod habit;
mod key;
mod leaves;
mod mask;
mod outcome;
mod pick;
mod pipes;
mod seat;
mod sketch_branch;
mod thumb;
mod tool;
mod twin;

pub use apply::{Applied, Context, Shaping, apply};
pub use carry::Carried;
pub use edit::{
    Destination, EDITS_SCHEMA, EditsFile, GrowFrom, HandEdit, LeafRegion, MOST_POINTS, MOST_ROUNDS, Mirror,
    Turn, ViewPlane,
};
pub use grow::KeptGrowth;
pub use key::{AxisKey, Found, KindWord, Mark};
pub use outcome::{Changed, Outcome, Why};
pub use pick::{Pick, Ray, Reach, pick};
pub use thumb::{Thumb, lean_of_thumb};
pub use tool::{Growth, Input, Pointer, Response, Tool, ToolKind};
