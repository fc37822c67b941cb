//! The ground that every Burgeon crate stands on: portable maths, seeds, cancellation, tasks, reports, digests.
//!
//! Nothing here knows about geometry or files.
//!
//! | module | owns |
//! |---|---|
//! | [`ops`] | transcendental functions with the same bits on every platform |
//! | [`turn`] | turns and directions, likewise |
//! | `seed` | [`Seed`], [`Draw`], [`Stream`]: randomness as a value |
//! | `budget` | [`Budget`], [`OverBudget`]: limits on the amount that a computation makes |
//! | `coded` | [`Coded`], [`coded!`]: errors as codes with fields |
//! | `slip` | [`Slip`]: messages of readers about a text, as codes; [`plainly`] for people |
//! | `task` | [`CancelToken`], [`Executor`], [`Run`], [`Telling`]: the means of a computation, never its subject |
//! | `nearest` | [`nearest()`], [`meant`]: which of the known words was meant |
//! | `quote` | [`brief`], [`quoted`]: quoted text cut to a length that fits messages; [`escaped_xml`] |
//! | `check` | [`Check`]: a value of a result against the bound of what is plausible |
//! | `report` | [`Report`], [`Warning`]: messages of a computation to its user |
//! | `digest` | [`Digest`]: a fingerprint of a result that does not depend on the machine |
//! | `sort` | [`sort_by`], [`sort_numbers`], [`map_of`]: sorting that is compiled once |
//! | `srgb` | [`linear_of_srgb`], [`srgb_of_linear`], [`light_of_byte`], [`byte_of_light`] |
//! | `units` | [`Unit`], [`UpAxis`], [`Angle`]: conversions at input and output |
//! | `words` | [`words!`], [`either`]: choices by the words that people write |
//! | `ids` | [`define_id!`]: typed `u32` handles |

mod budget;
mod check;
mod coded;
mod digest;
mod exps;
mod ids;
mod nearest;
pub mod ops;
mod quote;
mod report;
mod seed;
mod slip;
mod sort;
mod srgb;
mod task;
pub mod turn;
mod units;
mod words;

pub use budget::{Budget, Counted, OverBudget, grouped};
pub use check::{Bound, Check, Severity};
pub use coded::{Code, Coded, Told};
pub use digest::{Digest, Digestible};
pub use litemap::LiteMap;
pub use nearest::{meant, nearest};
pub use quote::{brief, escaped_xml, quoted};
pub use report::{Report, Stage, Warning, gathered};
pub use seed::{Draw, Seed, Stream};
pub use slip::{Slip, plainly};
pub use sort::{Set, first_of, map_of, median, set_of, sort_by, sort_by_key, sort_numbers, sorted_order};
pub use srgb::{byte_of_light, light_of_byte, linear_color, linear_of_srgb, srgb_of_linear};
pub use task::{
    CancelToken, Cancelled, Clock, Executor, NoClock, Run, Serial, Stopped, Telling, map_indexed,
    map_until_cancelled,
};
pub use units::{Angle, NotFinite, TimeUnit, Tolerance, Unit, UpAxis};
pub use words::either;
