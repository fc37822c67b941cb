//! Species by the names that people write: `name -> Allometry`.

use core::fmt;

use crate::Allometry;
use crate::species::SPECIES;

/// A species found by its name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FoundSpecies {
    /// Its relations.
    pub allometry: &'static Allometry,
    /// Only the genus is known: the species is another one of it.
    pub by_genus: bool,
}

/// A name that no species has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownSpecies {
    /// The name.
    pub name: String,
    /// The nearest known name, if one is near.
    pub nearest: Option<&'static str>,
}

impl core::error::Error for UnknownSpecies {}

impl fmt::Display for UnknownSpecies {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "there is no species `{}`", base::quoted(&self.name))?;
        match self.nearest {
            Some(nearest) => write!(f, "; is `{nearest}` meant?"),
            None => write!(f, "; write the word of a preset, such as oak, or a scientific name"),
        }
    }
}

base::coded!(UnknownSpecies {
    Self { name, nearest } => "species-unknown" { name, nearest = nearest.unwrap_or_default() },
});

/// Returns a name in lower case, without cultivar, authors' brackets and marks of hybrids, with single spaces.
fn plain(name: &str) -> String {
    let mut out = String::with_capacity(name.len());
    let (mut quoted, mut depth) = (false, 0_u32);
    for c in name.chars() {
        match c {
            '\'' | '"' | '\u{2018}' | '\u{2019}' => quoted = !quoted,
            '(' | '[' => depth += 1,
            ')' | ']' => depth = depth.saturating_sub(1),
            _ if quoted || depth > 0 => {}
            '\u{d7}' => out.push('x'),
            '_' | '-' => out.push(' '),
            c => out.extend(c.to_lowercase()),
        }
    }
    out.split_whitespace().filter(|word| *word != "x").collect::<Vec<_>>().join(" ")
}

/// Most characters of a name that are read.
const LONGEST_NAME: usize = 200;

impl Allometry {
    /// Returns all species, in order of their presets' words.
    pub const fn all() -> &'static [Self] {
        SPECIES
    }

    /// Finds the species of a preset's word, a scientific or a common name. Upper case, cultivars, authors, hyphens
    /// and the marks of hybrids make no difference. A scientific name with only a known genus gives the first species
    /// of the genus, and a mark in the result.
    ///
    /// Cost: linear in the species; some microseconds.
    ///
    /// # Errors
    /// [`UnknownSpecies`] with the nearest known name.
    pub fn find(name: &str) -> Result<FoundSpecies, UnknownSpecies> {
        let short: String = name.chars().take(LONGEST_NAME).collect();
        let exact = short.trim().to_lowercase();
        if let Some(allometry) = SPECIES.iter().find(|s| s.preset == exact) {
            return Ok(FoundSpecies { allometry, by_genus: false });
        }
        let wanted = plain(&short);
        // The plain oak comes before the oaks of other models, and before the dead one.
        let rank = |s: &&Self| u8::from(s.preset.contains("oak") && s.preset != "oak");
        let named = |s: &&Self| plain(s.latin) == wanted || s.names.iter().any(|n| plain(n) == wanted);
        if let Some(allometry) = SPECIES.iter().filter(named).min_by_key(rank) {
            return Ok(FoundSpecies { allometry, by_genus: false });
        }
        let mut words = wanted.split(' ');
        let (genus, epithet) = (words.next().unwrap_or_default(), words.next().unwrap_or_default());
        let by_two = |s: &&Self| {
            let latin = plain(s.latin);
            !epithet.is_empty() && latin.split(' ').take(2).eq([genus, epithet])
        };
        if let Some(allometry) = SPECIES.iter().filter(by_two).min_by_key(rank) {
            return Ok(FoundSpecies { allometry, by_genus: false });
        }
        let nearest = base::nearest(&wanted, SPECIES.iter().map(|s| s.preset))
            .or_else(|| nearest_latin(&wanted))
            .or_else(|| base::nearest(&wanted, SPECIES.iter().flat_map(|s| s.names.iter().copied())));
        let is_slip = nearest.is_some_and(|n| plain(n).split(' ').next() == Some(genus));
        let of_genus = |s: &&Self| plain(s.latin).split(' ').next() == Some(genus);
        match SPECIES.iter().filter(of_genus).min_by_key(rank) {
            // A typing error in the second word does not make another species.
            Some(allometry) if !is_slip || epithet == "sp." || epithet == "spp." => {
                Ok(FoundSpecies { allometry, by_genus: true })
            }
            _ => Err(UnknownSpecies { name: short, nearest }),
        }
    }
}

fn nearest_latin(wanted: &str) -> Option<&'static str> {
    let plain_names: Vec<String> = SPECIES.iter().map(|s| plain(s.latin)).collect();
    let near = base::nearest(wanted, plain_names.iter().map(String::as_str))?;
    let row = plain_names.iter().position(|n| n == near)?;
    SPECIES.get(row).map(|s| s.latin)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn species(name: &str) -> &'static Allometry {
        Allometry::find(name).expect("it is known").allometry
    }

    #[test]
    fn every_name_finds_its_species() {
        for s in Allometry::all() {
            assert_eq!(species(s.preset).preset, s.preset);
            assert_eq!(plain(species(s.latin).latin), plain(s.latin), "{}", s.preset);
            for name in s.names {
                assert_eq!(species(&name.to_uppercase()).preset, s.preset, "{name}");
            }
        }
        assert!(SPECIES.windows(2).all(|w| w[0].preset < w[1].preset), "in order");
    }

    #[test]
    fn every_tree_preset_has_a_row() {
        let folder = std::path::PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../burgeon/presets");
        // The package alone has no folder of presets.
        let Ok(entries) = std::fs::read_dir(folder) else { return };
        for entry in entries.filter_map(Result::ok) {
            let word = entry.file_name().to_string_lossy().trim_end_matches(".toml").to_owned();
            let text = std::fs::read_to_string(entry.path()).expect("a preset can be read");
            let row = SPECIES.iter().find(|s| s.preset == word);
            let latin = text.lines().find_map(|l| l.strip_prefix("species = "));
            assert_eq!(
                row.map(|s| format!("\"{}\"", s.latin)),
                latin.map(str::to_owned),
                "the row of {word}"
            );
        }
    }

    #[test]
    fn names_as_people_write_them() {
        for (name, preset) in [
            ("Platanus \u{d7} hispanica", "plane-tree"),
            ("Platanus x acerifolia 'Bloodgood'", "plane-tree"),
            ("Quercus robur L.", "oak"),
            ("QUERCUS ROBUR", "oak"),
            ("Populus nigra 'Italica'", "poplar"),
            ("Picea abies (L.) H.Karst.", "spruce"),
            ("London Plane", "plane-tree"),
        ] {
            let found = Allometry::find(name).unwrap_or_else(|e| panic!("{e}"));
            assert_eq!((found.allometry.preset, found.by_genus), (preset, false), "{name}");
        }
        for (name, preset) in
            [("Quercus petraea", "oak"), ("Acer sp.", "maple"), ("Tilia", "lime"), ("Quercus spp.", "oak")]
        {
            let found = Allometry::find(name).unwrap_or_else(|e| panic!("{e}"));
            assert_eq!((found.allometry.preset, found.by_genus), (preset, true), "{name}");
        }
        for (name, nearest) in
            [("oka", Some("oak")), ("Betula pendla", Some("Betula pendula")), ("xyzzy", None)]
        {
            let unknown = Allometry::find(name).expect_err("a slip");
            assert_eq!(unknown.nearest, nearest, "{name}");
        }
        assert!(Allometry::find("").is_err() && Allometry::find(&"a".repeat(1 << 20)).is_err());
    }
}
