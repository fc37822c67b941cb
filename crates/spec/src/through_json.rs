//! Reads and writes a spec inside another serde type: `#[serde(with = "spec::through_json")]`; reads anything else from
//! JSON: `#[serde(deserialize_with = "spec::through_json::read")]`, or [`from_text`].
//!
//! The spec passes through a JSON value, so that one reader reads all specs: a second reader would be another copy of
//! the code that reads all their fields, which is a good part of what a browser downloads.

use core::ops::Deref;
use std::sync::Arc;

use serde::de::{DeserializeOwned, Error as _};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::Value;

use crate::{Node, Spec, TextFault, from_json, to_json};

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
/// A message with the names of the fields that lead to the fault.
pub fn deserialize<'de, T: Spec, D: Deserializer<'de>>(from: D) -> Result<Arc<T>, D::Error> {
    from_json(&Value::deserialize(from)?).map(Arc::new).map_err(D::Error::custom)
}

/// Reads any type.
///
/// # Errors
/// A message with the names of the fields that lead to the fault.
pub fn read<'de, T: DeserializeOwned, D: Deserializer<'de>>(from: D) -> Result<T, D::Error> {
    Node::from_json(&Value::deserialize(from)?).read().map_err(|TextFault { path, message, .. }| {
        if path.is_empty() {
            D::Error::custom(message)
        } else {
            D::Error::custom(format!("{path}: {message}"))
        }
    })
}

/// Reads any type from JSON text.
///
/// # Errors
/// A message with the names of the fields that lead to the fault; for text that is not JSON, with the place.
///
/// ```
/// let pairs: Vec<(u8, bool)> = spec::through_json::from_text("[[1, true], [2, false]]")?;
/// assert_eq!(pairs, [(1, true), (2, false)]);
/// assert!(spec::through_json::from_text::<Vec<u8>>("[1, 2, 256]").is_err());
/// # Ok::<(), spec::serde_json::Error>(())
/// ```
pub fn from_text<T: DeserializeOwned>(text: &str) -> Result<T, serde_json::Error> {
    read(serde_json::from_str::<Value>(text)?)
}
