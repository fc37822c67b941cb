//! Errors as shells pass them on.

use core::fmt::Display;
use std::collections::BTreeMap;

use base::{Coded, Told};
use schemars::JsonSchema;
use serde::Serialize;

/// Why something was not done, for a shell: words for people in English, and what another language needs for its own.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Refusal {
    /// A word in kebab-case that never changes its meaning.
    pub code: String,
    /// Names and values, as people read them.
    pub fields: BTreeMap<String, String>,
    /// Those of the fields that are refusals themselves.
    #[serde(skip_serializing_if = "BTreeMap::is_empty", default)]
    pub causes: BTreeMap<String, Self>,
    /// The sentence in English.
    pub message: String,
}

/// Not collected, which would sort them first.
fn in_order<V>(rows: impl Iterator<Item = (String, V)>) -> BTreeMap<String, V> {
    let mut map = BTreeMap::new();
    map.extend(rows);
    map
}

impl Refusal {
    /// Of any error with a code.
    pub fn of(error: &(impl Coded + Display)) -> Self {
        Self::told(error.told(), error.to_string())
    }

    /// Of what a shell itself finds wrong.
    pub fn plain(code: &str, fields: &[(&str, &str)], message: String) -> Self {
        let fields = in_order(fields.iter().map(|&(name, value)| (name.into(), value.into())));
        Self { code: code.into(), fields, causes: BTreeMap::new(), message }
    }

    /// As shells throw it: its JSON.
    pub fn into_json(self) -> String {
        serde_json::to_string(&self).unwrap_or(self.message)
    }

    fn told(Told { code, fields, causes }: Told, message: String) -> Self {
        let sentence = |name| fields.get(name).cloned().unwrap_or_default();
        let causes = causes.into_iter().map(|(name, told)| (name.into(), Self::told(told, sentence(name))));
        let causes = in_order(causes);
        let fields = in_order(fields.into_iter().map(|(name, value)| (name.into(), value)));
        Self { code: code.into(), fields, causes, message }
    }
}
