//! Names of documents, plants, layers and files.

/// Longest name of a plant, in characters.
pub(crate) const NAME_LENGTH: usize = 200;

pub(crate) fn too_long(name: &str) -> bool {
    name.chars().count() > NAME_LENGTH
}

/// Returns a name cut to its greatest length, without line breaks.
pub(crate) fn shortened(name: &str) -> String {
    name.chars().map(|c| if c.is_control() { ' ' } else { c }).take(NAME_LENGTH).collect()
}
