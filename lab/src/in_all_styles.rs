//! Drawings by people in all available styles: doodles, icons, line art, illustrations; of plants and of other things.
//!
//! They serve requirements that must hold across styles. A third of each set is held out for one look at the end:
//! drawings of things by word, so that no word of the end is learnt, icons and line art every third by name, "Quick,
//! Draw!" and trees by hand as everywhere.

use std::fs;
use std::path::{Path, PathBuf};

use glam::DVec2;
use ink::Drawing;
use reading::Kind;

use crate::made_drawings;
use crate::quickdraw::{drawing_of, json_lines, read, text_of};
use crate::read_drawings::{self, Part};
use xtask::shell::{Outcome, command, output, prepare, say, target_dir};

/// Source of a drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Set {
    /// Doodles of other things ("Quick, Draw!").
    Things,
    /// Icons of other things: Lucide (ISC).
    Lucide,
    /// Icons of other things: Tabler (MIT). No model learns from them.
    Tabler,
    /// Made drawings of other things.
    MadeThings,
    /// Doodles of plants and of their parts.
    Public,
    Spg,
    /// Trees by hand. No model learns from them.
    TreesByHand,
    Icons,
    LineArt,
    Illustrations,
    /// Two plants as drawing programs write them.
    Programs,
    /// Made drawings of plants.
    MadePlants,
    /// Several plants, drawn by people and put next to one another, or made.
    Scenes,
}

impl Set {
    pub(crate) const ALL: [Self; 13] = [
        Self::Things,
        Self::Lucide,
        Self::Tabler,
        Self::MadeThings,
        Self::Public,
        Self::Spg,
        Self::TreesByHand,
        Self::Icons,
        Self::LineArt,
        Self::Illustrations,
        Self::Programs,
        Self::MadePlants,
        Self::Scenes,
    ];

    pub(crate) const fn word(self) -> &'static str {
        match self {
            Self::Things => "doodles of other things",
            Self::Lucide => "icons of other things, Lucide",
            Self::Tabler => "icons of other things, Tabler",
            Self::MadeThings => "made, other things",
            Self::Public => "doodles of plants",
            Self::Spg => "SPG",
            Self::TreesByHand => "trees by hand",
            Self::Icons => "icons of plants",
            Self::LineArt => "line art",
            Self::Illustrations => "illustrations",
            Self::Programs => "as programs write them",
            Self::MadePlants => "made, plants",
            Self::Scenes => "several plants",
        }
    }

    pub(crate) const fn shows_a_plant(self) -> bool {
        !matches!(self, Self::Things | Self::Lucide | Self::Tabler | Self::MadeThings)
    }

    pub(crate) const fn is_learnt_from(self) -> bool {
        !matches!(self, Self::Tabler | Self::TreesByHand)
    }

    /// Whether people drew them.
    pub(crate) const fn is_by_people(self) -> bool {
        !matches!(self, Self::MadeThings | Self::MadePlants | Self::Scenes)
    }
}

/// One drawing.
pub(crate) struct Styled {
    pub(crate) set: Set,
    pub(crate) drawing: Drawing,
    /// Group that is learnt from or held out as a whole: its word, or its name.
    pub(crate) group: String,
    /// Kind of plant that it shows, where that is known.
    pub(crate) kind: Option<Kind>,
    /// Whether it is held out for the end.
    pub(crate) is_kept: bool,
}

/// One of this many is held out.
const KEPT: u64 = 3;
/// Number of made drawings of each way to draw something.
const MADE: u64 = 20;

/// Returns a hash by which lots are drawn, the same for the same text (Fowler, Noll and Vo's FNV-1a).
pub(crate) fn lot(text: &str) -> u64 {
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |h, b| (h ^ u64::from(b)).wrapping_mul(0x100_0000_01b3))
}

/// Collects all drawings of a folder of sketches, and icons of other things from npm.
pub(crate) fn gathered(folder: &Path) -> Outcome<Vec<Styled>> {
    let mut found = things(folder)?;
    found.extend(other_icons()?);
    found.extend(people(folder)?);
    found.extend(vectors(folder)?);
    found.extend(made());
    found.extend(scenes(folder)?);
    for set in Set::ALL {
        if !found.iter().any(|s| s.set == set) {
            say(&format!("skipped: {}, of which there are none here", set.word()));
        }
    }
    Ok(found)
}

fn things(folder: &Path) -> Outcome<Vec<Styled>> {
    let path = folder.join("no_plants/no_plants.ndjson");
    if !path.is_file() {
        return Ok(Vec::new());
    }
    let styled = |line: &serde_json::Value| {
        let word = text_of(line, "word").to_owned();
        let is_kept = lot(&word) % KEPT == KEPT - 1;
        Styled { set: Set::Things, drawing: drawing_of(line), group: word, kind: None, is_kept }
    };
    Ok(json_lines(&path)?.iter().map(styled).collect())
}

/// Packages of icons, with version, folder, step between the icons used, and set.
const PACKAGES: [(&str, &str, &str, u64, Set); 2] = [
    ("lucide-static", "1.62.0", "package/icons", 1, Set::Lucide),
    ("@tabler/icons", "3.52.0", "package/icons/outline", 6, Set::Tabler),
];
/// Parts of the names of icons that may show a plant or a part of one, or hold one.
const OF_PLANTS: [&str; 64] = [
    "leaf",
    "leave",
    "flower",
    "plant",
    "tree",
    "apple",
    "cherry",
    "carrot",
    "clover",
    "cactus",
    "palm",
    "sprout",
    "wheat",
    "grape",
    "banana",
    "citrus",
    "salad",
    "bean",
    "nut",
    "rose",
    "cannabis",
    "mushroom",
    "vegan",
    "seed",
    "grass",
    "bouquet",
    "lemon",
    "pepper",
    "melon",
    "pumpkin",
    "corn",
    "shrub",
    "fruit",
    "egg",
    "bonsai",
    "christmas",
    "pear",
    "berry",
    "avocado",
    "onion",
    "potato",
    "radish",
    "fern",
    "botan",
    "ecology",
    "eco",
    "mint",
    "flax",
    "nature",
    "growth",
    "garden",
    "forest",
    "lotus",
    "tulip",
    "hop",
    "barley",
    "grain",
    "cotton",
    "pine",
    "spinach",
    "cabbage",
    "olive",
    "peas",
    "brand",
];

/// Collects icons of things other than plants, fetched if they are missing.
fn other_icons() -> Outcome<Vec<Styled>> {
    let mut found = Vec::new();
    for (package, version, inner, every, set) in PACKAGES {
        let name = package.trim_start_matches('@').replace('/', "-");
        let folder = target_dir().join("icons").join(&name);
        let icons = folder.join(inner);
        if !icons.is_dir() {
            fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
            let mut npm =
                prepare("npm", &["pack", "--silent", &format!("{package}@{version}"), "--pack-destination"]);
            npm.arg(&folder);
            output(npm)?;
            let archive = folder.join(format!("{name}-{version}.tgz"));
            command("tar", &["-xzf", &archive.to_string_lossy(), "-C", &folder.to_string_lossy()])?;
        }
        for file in svgs(&icons) {
            let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            if OF_PLANTS.iter().any(|p| name.contains(p)) || !lot(&name).is_multiple_of(every) {
                continue;
            }
            // Of sets that no model learns from, half is for the end.
            let is_kept = !set.is_learnt_from() && lot(&name) / every % 2 == 1;
            found.extend(drawings(&file)?.into_iter().map(|drawing| Styled {
                set,
                drawing,
                group: name.clone(),
                kind: None,
                is_kept,
            }));
        }
    }
    Ok(found)
}

/// Collects doodles of plants, the SPG set, and trees by hand.
fn people(folder: &Path) -> Outcome<Vec<Styled>> {
    let mut found = Vec::new();
    for part in [Part::Train, Part::Choose, Part::Test] {
        let all = read_drawings::by_people(folder, part)?;
        found.extend(all.into_iter().map(|(word, kind, drawing)| {
            let set = match &*word {
                "by hand tree" => Set::TreesByHand,
                w if w.starts_with("spg ") => Set::Spg,
                _ => Set::Public,
            };
            let group = drawing.name.clone();
            Styled { set, drawing, group, kind, is_kept: part == Part::Test }
        }));
    }
    Ok(found)
}

/// Beginnings of the names of illustrations that have one right kind; a rosette and a plant over its runners have none.
const ILLUSTRATED: [(&str, Kind); 14] = [
    ("01_", Kind::Stem),
    ("03_", Kind::Flower),
    ("05_", Kind::Flower),
    ("07_", Kind::Tree),
    ("09_", Kind::Flower),
    ("11_", Kind::Flower),
    ("15_", Kind::Flower),
    ("17_", Kind::Stem),
    ("19_", Kind::Tree),
    ("21_", Kind::Stem),
    ("25_", Kind::Stem),
    ("27_", Kind::Flower),
    ("29_", Kind::Flower),
    ("31_", Kind::Flower),
];

/// Collects icons of plants, line art, illustrations, and files of drawing programs.
fn vectors(folder: &Path) -> Outcome<Vec<Styled>> {
    let kinds = folder.join("icons/kinds.csv");
    let kinds = if kinds.is_file() { read(&kinds)? } else { String::new() };
    let kind_of = |name: &str| {
        let line = kinds.lines().find(|l| l.split(',').next() == Some(name))?;
        match line.split(',').nth(1)? {
            "mushroom" => Some(Kind::Vegetable),
            word => Kind::from_word(word),
        }
    };
    let mut found = Vec::new();
    let sets = [
        ("icons", Set::Icons),
        ("lineart", Set::LineArt),
        ("illustrations", Set::Illustrations),
        ("programs", Set::Programs),
    ];
    for (sub, set) in sets {
        let own = folder.join(sub);
        for (place, file) in svgs(&own).into_iter().enumerate() {
            let name = file.strip_prefix(&own).unwrap_or(&file).to_string_lossy().into_owned();
            let shown = ILLUSTRATED.iter().find(|(n, _)| set == Set::Illustrations && name.starts_with(n));
            let kind = shown.map(|(_, k)| *k).or_else(|| kind_of(&name).filter(|_| set == Set::Icons));
            let is_kept = place as u64 % KEPT == KEPT - 1;
            found.extend(drawings(&file)?.into_iter().map(|drawing| Styled {
                set,
                drawing,
                group: name.clone(),
                kind,
                is_kept,
            }));
        }
    }
    Ok(found)
}

/// Collects icons of plants whose kind is known, without those held out. The name "plant" does not say whether it
/// stands in a pot.
pub(crate) fn icons_of_kinds(folder: &Path) -> Outcome<Vec<(Kind, Drawing)>> {
    let is_learnt = |s: &Styled| s.set == Set::Icons && !s.is_kept && !s.group.contains("plant");
    let icons = vectors(folder)?.into_iter().filter(is_learnt);
    Ok(icons.filter_map(|s| Some((s.kind?, s.drawing))).collect())
}

fn made() -> Vec<Styled> {
    let one = made_drawings::kinds::make_of_kinds(MADE_SALT, MADE).into_iter().enumerate();
    one.map(|(k, (word, kind, lines))| Styled {
        set: if kind == Kind::None { Set::MadeThings } else { Set::MadePlants },
        drawing: Drawing::from_polylines(format!("made {word} {k}"), &lines),
        group: word.to_owned(),
        kind: Some(kind),
        is_kept: false,
    })
    .collect()
}

/// Salt that only these made drawings use.
const MADE_SALT: u64 = 40;

/// Collects drawings of several plants: people's drawings put next to one another, and made rows.
fn scenes(folder: &Path) -> Outcome<Vec<Styled>> {
    let mut found = Vec::new();
    for part in [Part::Train, Part::Choose, Part::Test] {
        found.extend(read_drawings::collect_several(folder, part)?.into_iter().map(|drawing| Styled {
            set: Set::Scenes,
            group: drawing.name.clone(),
            drawing,
            kind: None,
            is_kept: part == Part::Test,
        }));
    }
    Ok(found)
}

/// Returns the pictures of a folder and of those in it, by name.
fn svgs(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for path in fs::read_dir(folder).into_iter().flatten().flatten().map(|f| f.path()) {
        if path.is_dir() {
            found.extend(svgs(&path));
        } else if path.extension().is_some_and(|e| e == "svg") {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// Returns the drawings of a file; empty for one that holds none.
fn drawings(file: &Path) -> Outcome<Vec<Drawing>> {
    let bytes = fs::read(file).map_err(|e| format!("{}: {e}", file.display()))?;
    let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let items = formats::read_drawings(bytes.as_slice(), formats::DrawingFormat::Svg, &name);
    let drawn = |d: &Drawing| d.strokes.iter().flat_map(|s| &s.samples).any(|s| s.at != DVec2::ZERO);
    Ok(items.into_iter().filter_map(|item| Some(item.ok()?.drawing)).filter(drawn).collect())
}
