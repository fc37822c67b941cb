//! Errors as shells pass them on.

use core::fmt::Display;
use std::collections::BTreeMap;

use base::{Coded, Told};
use schemars::JsonSchema;
use serde::Serialize;

/// Reason why a request was refused, for a shell: a sentence in English, and the values for one in another language.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Refusal {
    /// A word in kebab-case that never changes its meaning.
    pub code: String,
    /// Names and values, as people read them.
    pub fields: BTreeMap<String, String>,
    /// Fields that are refusals themselves.
    #[serde(skip_serializing_if = "BTreeMap::is_empty", default)]
    pub causes: BTreeMap<String, Self>,
    /// The sentence in English.
    pub message: String,
}

/// Inserts rows in order; collecting would sort them first.
fn in_order<V>(rows: impl Iterator<Item = (String, V)>) -> BTreeMap<String, V> {
    let mut map = BTreeMap::new();
    map.extend(rows);
    map
}

impl Refusal {
    /// Makes a refusal of any error with a code.
    pub fn from_error(error: &(impl Coded + Display)) -> Self {
        Self::from_told(error.details(), error.to_string())
    }

    /// Makes a refusal of a fault that a shell itself found.
    pub fn plain(code: &str, fields: &[(&str, &str)], message: String) -> Self {
        let fields = in_order(fields.iter().map(|&(name, value)| (name.into(), value.into())));
        Self { code: code.into(), fields, causes: BTreeMap::new(), message }
    }

    /// Returns its JSON, which shells throw.
    pub fn into_json(self) -> String {
        serde_json::to_string(&self).unwrap_or(self.message)
    }

    fn from_told(Told { code, fields, causes }: Told, message: String) -> Self {
        let sentence = |name| fields.get(name).cloned().unwrap_or_default();
        let causes =
            causes.into_iter().map(|(name, told)| (name.into(), Self::from_told(told, sentence(name))));
        let causes = in_order(causes);
        let fields = in_order(fields.into_iter().map(|(name, value)| (name.into(), value)));
        Self { code: code.into(), fields, causes, message }
    }
}
