//! Specs, which say what people ask of a maker: read from text, described by a JSON Schema and checked against it.
//!
//! `TOML | JSON -> Node -> a maker's spec -> ranges of its schema`
//!
//! A spec is plain data in its maker's own crate. Ranges, units and meaning are given on its fields and nowhere else:
//! the schema is derived from them, and [`check`] compares every number with it.
//!
//! | module | owns |
//! |---|---|
//! | `located` | a text as a tree that knows where each value stands |
//! | `schema` | the schema of a type, made once |
//! | `range` | the check of ranges |
//! | `read` | reading, and setting a single field |
//! | `through_json` | a spec inside of something else |
//! | `colour` | a colour as `#rrggbb` |

mod colour;
mod located;
mod range;
mod read;
mod schema;
pub mod through_json;

pub use colour::Colour;
pub use located::{Entry, Kind, Node, TextFault};
pub use range::{RangeFault, check, range};
pub use read::{SpecFault, from_json, from_toml, line_at, set, to_json, with_fields};
pub use schema::{Spec, kept_schema, made_schema};

#[doc(hidden)]
pub use {schemars, serde_json};
