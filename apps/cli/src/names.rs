//! Names of files made of names of drawings: safe on every system, and all different.

use std::collections::BTreeMap;

use burgeon::formats::file_name;
use unicode_normalization::UnicodeNormalization as _;

/// Most characters of a name.
const MOST_CHARS: usize = 80;
/// Most bytes of a name: names derived from it (`NAME--leaf.png`) must fit in the 255 that file systems allow.
const MOST_BYTES: usize = 200;

/// Returns a file name, without extension, from a drawing's name: the characters that [`file_name`] keeps, in Unicode's
/// composed form, never two `-` in a row (which separate the names of textures), and no name that Windows reserves for
/// a device.
pub(crate) fn safe(name: &str) -> String {
    let name: String = name.nfc().take(4 * MOST_CHARS).collect();
    let mut out = String::new();
    for c in file_name(&name, "").chars() {
        if !(c == '-' && out.ends_with('-')) {
            out.push(c);
        }
    }
    let out = limited(out.trim_start_matches(['-', '.']), 0);
    match out.as_str() {
        "" => "drawing".into(),
        name if is_device(name) => format!("{name}-drawing"),
        _ => out,
    }
}

/// Returns the start of a name that leaves room for `more` bytes.
fn limited(name: &str, more: usize) -> String {
    let mut out = String::new();
    for c in name.chars().take(MOST_CHARS.saturating_sub(more)) {
        if out.len() + c.len_utf8() + more > MOST_BYTES {
            break;
        }
        out.push(c);
    }
    out.truncate(out.trim_end_matches(['-', '.']).len());
    out
}

/// Whether Windows reserves the name for a device.
fn is_device(name: &str) -> bool {
    let name = name.split('.').next().unwrap_or(name).to_ascii_lowercase();
    let numbered = ["com", "lpt"].iter().find_map(|d| name.strip_prefix(d));
    let one_digit = |s: &str| {
        let mut digits = s.chars();
        matches!((digits.next(), digits.next()), (Some('0'..='9' | '¹' | '²' | '³'), None))
    };
    matches!(name.as_str(), "con" | "prn" | "aux" | "nul") || numbered.is_some_and(one_digit)
}

/// Returns a name as seen by a disk that ignores case and Unicode's normal forms.
pub(crate) fn folded(name: &str) -> String {
    // Upper case first: both ß and ẞ are then SS.
    name.nfd().flat_map(char::to_uppercase).flat_map(char::to_lowercase).collect::<String>().nfd().collect()
}

/// Returns `name`, or `name-2`, `name-3`, ...: no two of them equal when [`folded`]. `taken` holds every name given and
/// the next number to try for it.
pub(crate) fn unique(taken: &mut BTreeMap<String, u64>, name: &str) -> String {
    let key = folded(name);
    let Some(&first) = taken.get(&key) else {
        taken.insert(key, 2);
        return name.to_owned();
    };
    let mut k = first;
    loop {
        let end = format!("-{k}");
        let next = limited(name, end.len()) + &end;
        k += 1;
        if !taken.contains_key(&folded(&next)) {
            taken.insert(folded(&next), 2);
            taken.insert(key, k);
            return next;
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn names_are_safe_and_unique() {
        for (name, want) in [
            ("flower 3/../x", "flower-3-..-x"),
            ("..", "drawing"),
            ("", "drawing"),
            ("NUL", "NUL-drawing"),
            ("com1.x", "com1.x-drawing"),
            ("LPT²", "LPT²-drawing"),
            ("com10", "com10"),
            ("Grüne Rose", "Grüne-Rose"),
            ("花", "花"),
            ("夏の花 🌹", "夏の花-🌹"),
            ("हिन्दी", "हिन्दी"),
            ("a.b", "a.b"),
            ("a--b", "a-b"),
            ("a\u{202e}gpj", "agpj"),
            ("e\u{301}", "é"),
        ] {
            assert_eq!(safe(name), want, "{name:?}");
        }
        assert_eq!(safe(&"x".repeat(500)).len(), 80);
        assert_eq!(safe(&"花".repeat(500)).len(), 198);
        let mut taken = BTreeMap::new();
        let names = ["rose", "Rose", "rose-2", "rose", "É", "e\u{301}", "straße", "STRASSE"];
        let names = names.map(|n| unique(&mut taken, n));
        assert_eq!(names, ["rose", "Rose-2", "rose-2-2", "rose-3", "É", "e\u{301}-2", "straße", "STRASSE-2"]);
        let long = "y".repeat(80);
        assert_eq!([0, 1].map(|_| unique(&mut taken, &long).len()), [80, 80]);
    }

    proptest! {
        #[test]
        fn every_name_is_safe(names in proptest::collection::vec(".{0,300}", 1..8)) {
            let mut taken = BTreeMap::new();
            let mut seen = std::collections::BTreeSet::new();
            for name in &names {
                let name = unique(&mut taken, &safe(name));
                prop_assert!(!name.is_empty() && name.chars().count() <= 80 && name.len() <= MOST_BYTES);
                prop_assert!(!name.contains(['/', '\\', ':', '\0']) && !name.contains("--"), "{name:?}");
                prop_assert!(!name.starts_with('.') && !name.ends_with(['.', ' ', '-']) && !is_device(&name));
                prop_assert!(!name.chars().any(|c| c.is_control() || c.is_whitespace()));
                // Textures have the name of the drawing.
                prop_assert_eq!(&file_name(&name, "model"), &name);
                prop_assert!(seen.insert(folded(&name)), "{name:?} twice");
            }
        }
    }
}
