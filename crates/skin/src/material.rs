//! Materials that a user gives to leaves, petals and sepals, instead of the plant's own.

use base::LiteMap;
use std::sync::Arc;

use mesh::Texture;
use plant::{Organ, OrganKind};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use spec::Colour;

/// Pattern that is painted on an organ.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Pattern {
    /// One colour.
    #[default]
    Plain,
    /// From the second colour at the root to the first at the tip.
    Shaded,
    /// Midrib and side veins in the second colour.
    Veined,
    /// Lines of the second colour that fan out from the throat.
    Streaked,
    /// Spots of the second colour, more of them towards the throat.
    Speckled,
    /// A margin of the second colour (picotee).
    Picotee,
    /// An uneven margin of the second colour that runs into the first (variegated leaf).
    Variegated,
    /// A picture, upright from root to tip.
    Picture,
}

base::words!(Pattern {
    Plain = "plain",
    Shaded = "shaded",
    Veined = "veined",
    Streaked = "streaked",
    Speckled = "speckled",
    Picotee = "picotee",
    Variegated = "variegated",
    Picture = "picture",
});

impl Pattern {
    /// Whether it is painted by the distance from the margin, not by the position across.
    pub(crate) const fn follows_margin(self) -> bool {
        matches!(self, Self::Picotee | Self::Variegated)
    }
}

/// A material of leaves, petals or sepals.
///
/// ```
/// let rim: skin::OrganMaterial = spec::from_toml("pattern = \"picotee\"\ncolor = \"#ffffff\"\nsecond = \"#c03060\"")?;
/// assert_eq!((rim.pattern, rim.amount), (skin::Pattern::Picotee, 0.5));
/// # Ok::<(), spec::SpecFault>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct OrganMaterial {
    /// The painted pattern.
    pub pattern: Pattern,
    /// The first colour, which covers most of the organ. A picture is shown in its own colours.
    pub color: Colour,
    /// The second colour, for veins, streaks, spots, the margin, the root.
    pub second: Colour,
    /// Amount of the second colour, 0 to 1, default 0.5.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub amount: f64,
    /// Roughness: 0 is as glossy as wet leaves, 1 as matt as velvet; default 0.6.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub roughness: f64,
    /// Picture of the pattern `picture`. In a file of materials the path of a PNG or JPEG relative to it; in a document
    /// the name under which it is stored.
    pub picture: Option<String>,
}

impl Default for OrganMaterial {
    fn default() -> Self {
        Self {
            pattern: Pattern::Plain,
            color: Colour([0xd9, 0x6a, 0x8c]),
            second: Colour([0xf6, 0xe6, 0xd8]),
            amount: 0.5,
            roughness: 0.6,
            picture: None,
        }
    }
}

/// Predefined materials, by the words under which users know them.
pub static MATERIALS: [(&str, OrganMaterial); 12] = [
    ("rose", organ_material(Pattern::Shaded, 0x00c8_2f4e, 0x00f2_d9b0, 0.35, 0.75)),
    ("velvet", organ_material(Pattern::Plain, 0x006a_0f24, 0x002a_0610, 0.5, 1.0)),
    ("geranium", organ_material(Pattern::Veined, 0x00b5_8ad6, 0x0055_1f7c, 0.5, 0.65)),
    ("orchid", organ_material(Pattern::Streaked, 0x00f4_dcea, 0x00a1_1c5e, 0.6, 0.5)),
    ("foxglove", organ_material(Pattern::Speckled, 0x00e2_8fc0, 0x006a_163c, 0.5, 0.6)),
    ("tiger-lily", organ_material(Pattern::Speckled, 0x00ee_7a1c, 0x003a_120a, 0.35, 0.5)),
    ("picotee", organ_material(Pattern::Picotee, 0x00fb_f6ee, 0x00c4_2a62, 0.3, 0.65)),
    ("tulip", organ_material(Pattern::Picotee, 0x00c6_1a22, 0x00f4_c828, 0.4, 0.45)),
    ("hosta", organ_material(Pattern::Variegated, 0x003f_7834, 0x00ee_eabd, 0.4, 0.6)),
    ("camellia", organ_material(Pattern::Veined, 0x001f_4f24, 0x006f_964e, 0.35, 0.2)),
    ("sage", organ_material(Pattern::Veined, 0x008d_a382, 0x00c2_cfb4, 0.4, 1.0)),
    ("autumn", organ_material(Pattern::Shaded, 0x00c8_4a16, 0x00e6_b42c, 0.6, 0.7)),
];

const fn organ_material(
    pattern: Pattern,
    color: u32,
    second: u32,
    amount: f64,
    roughness: f64,
) -> OrganMaterial {
    OrganMaterial { pattern, color: rgb(color), second: rgb(second), amount, roughness, picture: None }
}

const fn rgb(hex: u32) -> Colour {
    let [_, r, g, b] = hex.to_be_bytes();
    Colour([r, g, b])
}

/// The organs that can wear a material.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Wearer {
    /// Leaves.
    Leaf,
    /// Petals.
    Petal,
    /// Sepals and bracts.
    Sepal,
}

impl Wearer {
    /// Every one, in the order of [`Worn::kinds`].
    pub const ALL: [Self; 3] = [Self::Leaf, Self::Petal, Self::Sepal];

    /// Returns the word in files and in names of materials.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Leaf => "leaf",
            Self::Petal => "petal",
            Self::Sepal => "sepal",
        }
    }

    /// Returns the word for several, in names of parts.
    pub(crate) const fn words(self) -> &'static str {
        match self {
            Self::Leaf => "leaves",
            Self::Petal => "petals",
            Self::Sepal => "sepals",
        }
    }

    pub(crate) const fn from_kind(kind: OrganKind) -> Option<Self> {
        match kind {
            OrganKind::Leaf => Some(Self::Leaf),
            OrganKind::Petal => Some(Self::Petal),
            OrganKind::Sepal => Some(Self::Sepal),
            _ => None,
        }
    }
}

/// Materials of the organs of a plant: a file of materials.
///
/// The material of a stroke takes precedence over that of its kind of organ. Not guaranteed: that a plant has such
/// organs.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Wear {
    /// Material of all leaves.
    pub leaf: Option<OrganMaterial>,
    /// Material of all petals.
    pub petal: Option<OrganMaterial>,
    /// Material of all sepals and bracts.
    pub sepal: Option<OrganMaterial>,
    /// Materials of the organs that were drawn by single strokes.
    pub strokes: Vec<StrokeWear>,
}

/// Material of strokes of a drawing.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct StrokeWear {
    /// Strokes by their numbers in the report, from 0.
    pub strokes: Vec<u32>,
    /// Their material.
    pub material: OrganMaterial,
}

spec::schemas!(Wear = include_str!("../schemas/materials.json"));
spec::schemas!(OrganMaterial => Wear, "/$defs/OrganMaterial");

impl Wear {
    /// Returns the material of the organs of a kind.
    pub const fn material(&self, wearer: Wearer) -> Option<&OrganMaterial> {
        match wearer {
            Wearer::Leaf => self.leaf.as_ref(),
            Wearer::Petal => self.petal.as_ref(),
            Wearer::Sepal => self.sepal.as_ref(),
        }
    }

    /// Gives the organs of a kind a material, or takes it away.
    pub fn set(&mut self, wearer: Wearer, material: Option<OrganMaterial>) {
        *match wearer {
            Wearer::Leaf => &mut self.leaf,
            Wearer::Petal => &mut self.petal,
            Wearer::Sepal => &mut self.sepal,
        } = material;
    }

    /// Iterates over all materials, those of kinds first.
    pub fn materials(&self) -> impl Iterator<Item = &OrganMaterial> {
        let kinds = Wearer::ALL.into_iter().filter_map(|w| self.material(w));
        kinds.chain(self.strokes.iter().map(|s| &s.material))
    }

    /// Converts it for meshing; `picture` returns the pixels of a picture by its name.
    pub fn worn(&self, mut picture: impl FnMut(&str) -> Option<Arc<Texture>>) -> Worn {
        let mut worn = Worn::default();
        for wearer in Wearer::ALL {
            worn.kinds[wearer as usize] = self.material(wearer).map(|m| worn.row(m, &mut picture));
        }
        for StrokeWear { strokes, material } in &self.strokes {
            let row = worn.row(material, &mut picture);
            for &stroke in strokes {
                worn.strokes.insert(stroke, row);
            }
        }
        worn
    }
}

/// A material with the pixels of its picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Cloth {
    /// The material.
    pub material: OrganMaterial,
    /// The picture of the pattern `picture`; without one the material is plain.
    pub picture: Option<Arc<Texture>>,
}

/// The materials that organs of a plant wear, as [`Wear::worn`] makes them. Default: none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Worn {
    /// Each material once.
    pub cloths: Vec<Cloth>,
    /// Rows of `cloths`, by [`Wearer::ALL`].
    pub kinds: [Option<usize>; 3],
    /// Rows of `cloths`, by the stroke that an organ was read from; they take precedence over those of kinds.
    pub strokes: LiteMap<u32, usize>,
    /// Whether they are painted even if no other surface has a texture ([`crate::SkinSpec::textures`]).
    pub always: bool,
}

impl Worn {
    /// Sets whether they are painted even if no other surface has a texture.
    #[must_use]
    pub fn always(self, always: bool) -> Self {
        Self { always, ..self }
    }

    fn row(
        &mut self,
        material: &OrganMaterial,
        picture: &mut impl FnMut(&str) -> Option<Arc<Texture>>,
    ) -> usize {
        if let Some(row) = self.cloths.iter().position(|c| c.material == *material) {
            return row;
        }
        let name = material.picture.as_deref().filter(|_| material.pattern == Pattern::Picture);
        let picture = name.and_then(picture);
        self.cloths.push(Cloth { material: material.clone(), picture });
        self.cloths.len() - 1
    }

    /// Returns the material of an organ.
    pub(crate) fn material(&self, organ: &Organ) -> Option<(Wearer, usize)> {
        let wearer = Wearer::from_kind(organ.kind)?;
        let own = organ.source.and_then(|s| self.strokes.get(&s)).copied();
        let row = own.or(self.kinds[wearer as usize])?;
        (row < self.cloths.len()).then_some((wearer, row))
    }

    /// Whether a material of a model is one that organs wear, by its name.
    pub fn is_worn(&self, material: &str) -> bool {
        let names = |row: usize| Wearer::ALL.map(|w| self.name(w, row));
        (0..self.cloths.len()).flat_map(names).any(|name| name == material)
    }

    /// Returns the name of a material within a model.
    pub(crate) fn name(&self, wearer: Wearer, row: usize) -> String {
        let pattern = self.cloths.get(row).map_or(Pattern::Plain, |c| c.material.pattern);
        format!("{}-{}-{}", wearer.word(), pattern.word(), row + 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_of_materials_is_read_and_each_is_there_once() {
        let text = "[petal]\npattern = \"picotee\"\n[leaf]\npattern = \"picotee\"\n\
                    [[strokes]]\nstrokes = [3, 4]\nmaterial = { pattern = \"picture\", picture = \"a.png\" }";
        let wear: Wear = spec::from_toml(text).expect("a file of materials");
        let mut asked = Vec::new();
        let worn = wear.worn(|name| {
            asked.push(name.to_owned());
            None
        });
        assert_eq!((worn.cloths.len(), worn.kinds), (2, [Some(0), Some(0), None]));
        assert_eq!((worn.strokes.get(&4), asked), (Some(&1), vec!["a.png".to_owned()]));
        assert!(worn.is_worn("petal-picotee-1") && !worn.is_worn("petal-pink"));
        let wrong = spec::from_toml::<Wear>("[leaf]\nroughness = 2.0").expect_err("out of range");
        assert!(wrong.to_string().contains("leaf.roughness"), "{wrong}");
    }

    #[test]
    fn the_library_is_within_its_ranges() {
        for (name, material) in &MATERIALS {
            assert!(spec::check(material).is_ok(), "{name}");
        }
    }
}
