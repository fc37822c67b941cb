//! A spec inside of something else that serde reads and writes: `#[serde(with = "spec::through_json")]`.
//!
//! By way of a JSON value, so that a spec is read by one reader only: each further one would be a copy of the code that
//! reads all its fields, which is a good part of what a browser downloads.

use core::ops::Deref;
use std::sync::Arc;

use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::Value;

use crate::{Spec, from_json, to_json};

/// Writes a spec that is borrowed or shared.
///
/// # Errors
/// The writer's own.
pub fn serialize<P: Deref<Target: Spec>, S: Serializer>(spec: &P, to: S) -> Result<S::Ok, S::Error> {
    to_json(&**spec).serialize(to)
}

/// Reads a spec; ranges are not looked at ([`from_json`]).
///
/// # Errors
/// What is wrong, with the names of the fields that lead to it.
pub fn deserialize<'de, T: Spec, D: Deserializer<'de>>(from: D) -> Result<Arc<T>, D::Error> {
    from_json(&Value::deserialize(from)?).map(Arc::new).map_err(D::Error::custom)
}
