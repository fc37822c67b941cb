//! Leaves measured in side view, as JSON: midribs `x`, `y` and widths `r` at `s`.

use std::io::Read;

use base::{Unit, UpAxis};
use glam::DVec2;
use leaf::LeafProfile;
use serde::Deserialize;
use serde_json::Value;

use super::{LeafFileError, MarksAxes};
use crate::error::{FileFault, Place};

/// Most leaves, more than a plant has, and most points on one, more than anybody digitises.
const MOST: usize = 10_000;

/// One leaf of a file of profiles.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadProfile {
    /// Its name in the file: `name`, else `rank` and `i`; may be empty.
    pub name: String,
    /// The leaf, metres.
    pub profile: LeafProfile,
}

/// Contents of a file of profiles.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadProfiles {
    /// The leaves in their order, at least one.
    pub leaves: Vec<ReadProfile>,
    /// The unit that was used: the file's, or the one given to the reader.
    pub axes: MarksAxes,
    /// The file gives its unit; if not, that of the reader was used.
    pub is_unit_said: bool,
}

#[derive(Deserialize)]
struct LeafEntry {
    x: Vec<f64>,
    y: Vec<f64>,
    s: Vec<f64>,
    r: Vec<f64>,
    #[serde(default)]
    name: Option<String>,
    #[serde(default)]
    rank: Option<Value>,
    #[serde(default)]
    i: Option<Value>,
}

#[derive(Deserialize)]
struct FileEntry {
    #[serde(default)]
    unit: Option<String>,
    leaves: Vec<LeafEntry>,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum File {
    Bare(Vec<LeafEntry>),
    Named(FileEntry),
    One(Box<LeafEntry>),
}

const ADVICE: &str = "a leaf is {\"x\": [...], \"y\": [...], \"s\": [...], \"r\": [...]}: the midrib from base to tip seen from \
                      the side (y upwards), and the whole width r at the length s from the base; several stand in a list";

/// Reads profiles: one such object, a list of them, or `{"unit": "cm", "leaves": [...]}`.
///
/// `r` is the whole width from margin to margin. The unit is `unit` (m, cm, mm), else that of `axes`; y is upwards
/// whatever `axes` say.
///
/// # Errors
/// [`LeafFileError`] for text that is not such JSON, lists of different lengths, and an unknown unit.
pub fn read_profiles(input: impl Read, name: &str, axes: MarksAxes) -> Result<ReadProfiles, LeafFileError> {
    let file = |fault| LeafFileError::new(Place::File, fault);
    let text = super::text(input)?;
    let value: Value = serde_json::from_str(&text).map_err(|e| {
        let place = Place::Line { line: e.line() as u64, column: Some(e.column() as u64) };
        LeafFileError::new(place, FileFault::malformed(e.to_string(), ADVICE))
    })?;
    let read: File = serde_json::from_value(value).map_err(|_of_three_forms| {
        file(FileFault::malformed("a leaf lacks x, y, s or r, or one of them holds no numbers", ADVICE))
    })?;
    let (unit, leaves) = match read {
        File::Bare(leaves) => (None, leaves),
        File::Named(f) => (f.unit, f.leaves),
        File::One(leaf) => (None, vec![*leaf]),
    };
    let is_unit_said = unit.is_some();
    let unit = match unit.as_deref() {
        None => axes.unit,
        Some(word) => Unit::from_word(word).ok_or_else(|| {
            let what = format!("the unit \"{}\" is not known", word.chars().take(20).collect::<String>());
            file(FileFault::malformed(what, "a unit is m, cm or mm"))
        })?,
    };
    if leaves.is_empty() {
        return Err(file(FileFault::Empty));
    }
    if leaves.len() > MOST || leaves.iter().any(|l| l.x.len().max(l.s.len()) > MOST) {
        let advice = "split the file";
        return Err(file(FileFault::TooMuch {
            what: "the number of leaves or points",
            limit: MOST as u64,
            advice,
        }));
    }
    let metres = unit.metres();
    let one = |(k, l): (usize, LeafEntry)| {
        if l.x.len() != l.y.len() || l.s.len() != l.r.len() {
            let what = format!(
                "leaf {} has {} x and {} y, {} s and {} r",
                k + 1,
                l.x.len(),
                l.y.len(),
                l.s.len(),
                l.r.len()
            );
            return Err(file(FileFault::malformed(what, "give as many x as y, and as many s as r")));
        }
        let word = |v: Value| v.as_str().map_or_else(|| v.to_string(), str::to_owned);
        let numbers: Vec<String> = [l.rank, l.i].into_iter().flatten().map(word).collect();
        let own = l.name.unwrap_or_else(|| numbers.join("-"));
        Ok(ReadProfile {
            name: [name, &own]
                .into_iter()
                .filter(|n| !n.is_empty())
                .collect::<Vec<_>>()
                .join(" ")
                .chars()
                .take(200)
                .collect(),
            profile: LeafProfile {
                midrib: l.x.iter().zip(&l.y).map(|(&x, &y)| DVec2::new(x, y) * metres).collect(),
                width: l.s.iter().zip(&l.r).map(|(&s, &r)| (s * metres, r * metres)).collect(),
            },
        })
    };
    let leaves = leaves.into_iter().enumerate().map(one).collect::<Result<_, _>>()?;
    Ok(ReadProfiles { leaves, axes: MarksAxes { unit, up: UpAxis::Y }, is_unit_said })
}

#[cfg(test)]
mod tests {
    use super::*;

    const LEAF: &str =
        r#"{"rank": "10", "i": 3, "x": [0, 1, 3], "y": [0, 4, 5], "s": [0, 3, 6.4], "r": [1, 2, 0]}"#;

    #[test]
    fn one_leaf_a_list_and_a_file_with_a_unit_are_read() {
        let axes = MarksAxes { unit: Unit::Centimetre, ..MarksAxes::default() };
        let one = read_profiles(LEAF.as_bytes(), "maize", axes).unwrap();
        let list = read_profiles(format!("[{LEAF}, {LEAF}]").as_bytes(), "maize", axes).unwrap();
        let named = format!("{{\"unit\": \"mm\", \"leaves\": [{LEAF}]}}");
        let named = read_profiles(named.as_bytes(), "maize", axes).unwrap();
        assert_eq!((one.leaves.len(), list.leaves.len(), &one.leaves[0]), (1, 2, &list.leaves[1]));
        assert_eq!(one.leaves[0].name, "maize 10-3");
        assert!((one.leaves[0].profile.midrib[2] - DVec2::new(0.03, 0.05)).length() < 1e-15);
        assert!(named.is_unit_said && !one.is_unit_said);
        assert!((named.leaves[0].profile.width[1].1 - 0.002).abs() < 1e-15);
    }

    #[test]
    fn faults_say_what_to_do() {
        let message =
            |text: &str| read_profiles(text.as_bytes(), "x", MarksAxes::default()).unwrap_err().to_string();
        assert!(message("[]").contains("empty"));
        assert!(message("[1]").contains("lacks x, y, s or r"));
        assert!(message("[{").contains("line 1"));
        assert!(message(&LEAF.replace("[1, 2, 0]", "[1, 2]")).contains("3 s and 2 r"));
        assert!(message(&format!("{{\"unit\": \"inch\", \"leaves\": [{LEAF}]}}")).contains("m, cm or mm"));
    }
}
