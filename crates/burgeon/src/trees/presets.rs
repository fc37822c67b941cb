//! The species that come with the program.

use growth::TreeSpec;
use spec::SpecFault;

/// A species, as TOML.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Preset {
    /// Word by which it is requested.
    pub key: &'static str,
    /// Its file.
    pub toml: &'static str,
    /// Preset of the same tree, grown by another method: lists of species show only that one.
    pub same_as: Option<&'static str>,
}

macro_rules! presets {
    (@same) => { None };
    (@same $key:literal) => { Some($key) };
    ($($key:literal $(is $same:literal)?),* $(,)?) => {
        /// Every preset, those of Yang et al. (2019) first. No constant: each crate that names one has a copy of its own.
        pub static PRESETS: &[Preset] = &[$(Preset {
            key: $key,
            toml: include_str!(concat!("../../presets/", $key, ".toml")),
            same_as: presets!(@same $($same)?),
        }),*];
    };
}

presets![
    "pine",
    "terminalia",
    "chinese-fir",
    "oak",
    "oak-colonization" is "oak",
    "oak-lsystem" is "oak",
    "birch",
    "lime",
    "maple",
    "spruce",
    "willow",
    "poplar",
    "palm",
    "bamboo",
    "hazel",
    "dead-oak",
    "alder",
    "umbrella-pine",
    "cypress",
    "cherry",
    "rose",
    "grass",
    "beech",
    "cedar",
    "ash",
    "elm",
    "plane-tree",
    "apple",
    "olive",
    "larch",
    "yew",
    "ginkgo",
    "eucalyptus",
    "acacia",
    "magnolia-tree",
    "plum",
    "juniper",
    "date-palm",
    "tree-fern",
    "banana",
    "maize",
    "saguaro",
    "wheat",
    "lavender",
    "reed",
    "baobab",
    "agave",
    "fig",
    "mangrove",
    "boston-ivy",
];

impl Preset {
    /// Returns the preset of a key.
    ///
    /// ```
    /// assert!(burgeon::Preset::find("oak").is_some() && burgeon::Preset::find("fern").is_none());
    /// assert_eq!(burgeon::Preset::find("Quercus robur").map(|p| p.key), Some("oak"));
    /// ```
    pub fn find(key: &str) -> Option<&'static Self> {
        let named =
            || PRESETS.iter().find(|p| p.latin().is_some_and(|latin| latin.eq_ignore_ascii_case(key)));
        PRESETS.iter().find(|p| p.key == key).or_else(named)
    }

    /// Returns the name of its plants, from its file.
    pub(crate) fn title(&self) -> Option<&'static str> {
        self.toml.lines().find_map(|line| line.strip_prefix("name = \"")?.strip_suffix('"'))
    }

    /// Returns the Latin name of its species, from its file.
    pub fn latin(&self) -> Option<&'static str> {
        self.toml.lines().find_map(|line| line.strip_prefix("species = \"")?.strip_suffix('"'))
    }

    /// Returns its spec.
    ///
    /// # Errors
    /// [`SpecFault`] if the file is faulty: our bug.
    pub fn spec(&self) -> Result<TreeSpec, SpecFault> {
        spec::from_toml(self.toml)
    }
}
