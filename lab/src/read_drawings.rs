//! `cargo xtask read-drawings`: results of reading drawings by people, and made ones: by kind of plant and by number.
//!
//! The plant that was built of a drawing ([`Kind::from_reading`]) counts, never the confidence of a classifier.
//! Drawings are divided into three parts: one for training, one for choosing, and one that is used once, at the end.

mod changed;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use base::{Draw, Report, Run, Seed};
use glam::DVec2;
use ink::{Classified, Drawing, Ink, Source};
use reading::{Kind, OrganWord, Reading};
use serde_json::{Value, json};

use crate::contact_sheet::{self, Cell, Frame};
use crate::made_drawings::{self, side_by_side};
use crate::quickdraw::{drawing_of, json_lines, text_of};
use crate::written;
use xtask::shell::{Outcome, built_burgeon, burgeon, command, repository, say};

const USAGE: &str = "usage: cargo xtask read-drawings [SKETCHES FOLDER] [--part train|choose] [--sheets | --pictures | --changed | --without RULE | --written [WAY]] [--hundred] [--test]";

/// Number of sets of real drawings put next to one another.
const SIDE_BY_SIDE: u64 = 60;
/// Number of drawings that are inspected one by one.
const HUNDRED: usize = 100;

/// A part of the drawings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    Train,
    Choose,
    Test,
}

impl Part {
    /// Returns the part of a drawing: by its key, or by the person who drew it.
    fn from_line(line: &Value) -> Option<Self> {
        if let Some(person) = line.get("person").and_then(Value::as_u64) {
            return Some(if person.is_multiple_of(2) { Self::Choose } else { Self::Test });
        }
        Self::from_key(text_of(line, "key_id"))
    }

    /// Returns the part of a drawing of "Quick, Draw!".
    pub(crate) fn from_key(key: &str) -> Option<Self> {
        match key.parse::<u64>().ok()? % 5 {
            2 => Some(Self::Train),
            3 => Some(Self::Choose),
            4 => Some(Self::Test),
            _ => None,
        }
    }
}

/// Kinds that are right for the drawings of a category, and kinds that a person would accept.
const CATEGORIES: [(&str, &[Kind], &[Kind]); 30] = {
    use Kind::{
        Bush, Cactus, Conifer, Flower, Flowers, Fruit, Grass, HousePlant, Leaf, Palm, Stem, Tree, Vegetable,
    };
    [
        ("tree", &[Tree, Conifer], &[Palm, Bush]),
        ("bush", &[Bush], &[Tree, Grass]),
        ("palm tree", &[Palm], &[Tree]),
        ("cactus", &[Cactus], &[]),
        ("flower", &[Flower, Flowers], &[HousePlant]),
        ("grass", &[Grass], &[Bush, Stem]),
        ("leaf", &[Leaf], &[Stem]),
        ("house plant", &[HousePlant], &[Flower, Flowers, Stem]),
        ("broccoli", &[Vegetable], &[Tree, Bush]),
        ("garden", &[Flower, Flowers, Grass, Stem, Tree, Bush, HousePlant, Vegetable], &[]),
        ("apple", &[Fruit], &[Vegetable]),
        ("pear", &[Fruit], &[Vegetable]),
        ("banana", &[Fruit], &[Vegetable]),
        ("blackberry", &[Fruit], &[Vegetable]),
        ("blueberry", &[Fruit], &[Vegetable]),
        ("grapes", &[Fruit], &[Vegetable]),
        ("pineapple", &[Fruit], &[Vegetable]),
        ("strawberry", &[Fruit], &[Vegetable]),
        ("watermelon", &[Fruit], &[Vegetable]),
        ("asparagus", &[Vegetable], &[Stem, Fruit, Cactus]),
        ("carrot", &[Vegetable], &[Fruit]),
        ("mushroom", &[Vegetable], &[Fruit, Tree]),
        ("onion", &[Vegetable], &[Fruit]),
        ("peas", &[Vegetable], &[Fruit]),
        ("potato", &[Vegetable], &[Fruit]),
        ("string bean", &[Vegetable], &[Fruit, Leaf]),
        ("spg apple", &[Fruit], &[Vegetable]),
        ("spg cactus", &[Cactus], &[]),
        ("spg pineapple", &[Fruit], &[Vegetable]),
        ("by hand tree", &[Tree, Conifer], &[Palm, Bush]),
    ]
};

/// One drawing and its right readings.
struct Case {
    set: String,
    drawing: Drawing,
    right: Vec<Kind>,
    acceptable: Vec<Kind>,
    /// Number of plants in it, where that is known.
    plants: Option<usize>,
    /// For a made drawing: the kinds of its plants, from left to right.
    kinds: Vec<Kind>,
    /// Number of strokes that belong to plants; later ones do not.
    own: usize,
}

/// Result for one drawing.
struct Judged {
    reading: Reading,
    kind: Kind,
    plants: usize,
    verdict: Frame,
    number: bool,
}

/// Reads drawings by kind and number. With `--sheets`, writes contact sheets into `out/read`: each drawing next to its
/// reading; with `--pictures`, next to the plant that the command makes of it. With `--changed`, reports instead how
/// many of people's drawings are read as something else when they are drawn differently; with `--without`, how many are
/// read rightly without a rule. With `--hundred`, uses only a hundred drawings by people, drawn by lot, the same ones
/// each time.
///
/// # Errors
/// A sentence: a wrong option, or a file that cannot be read.
pub(crate) fn run(args: &[String]) -> Outcome {
    let mut folder = repository().join("../shared/data/sketches");
    let (mut part, mut sheets, mut pictures, mut again) = (Part::Choose, false, false, false);
    let mut hundred = false;
    let mut written: Option<Option<String>> = None;
    let mut wanted = args.iter().peekable();
    while let Some(arg) = wanted.next() {
        match arg.as_str() {
            "--test" => part = Part::Test,
            "--sheets" => sheets = true,
            "--changed" => again = true,
            "--hundred" => hundred = true,
            "--written" => {
                let way = wanted.next_if(|way| !way.starts_with("--"));
                written = Some(way.cloned());
            }
            "--without" => {
                let name = wanted.next().ok_or_else(|| USAGE.to_owned())?;
                say(&Chosen::collect(&folder)?.told_without(name));
                return Ok(());
            }
            "--pictures" => (sheets, pictures) = (true, true),
            "--part" => {
                part = match wanted.next().map(String::as_str) {
                    Some("train") => Part::Train,
                    Some("choose") => Part::Choose,
                    Some("test") => {
                        return Err("the test part is looked at once, at the end: say --test".to_owned());
                    }
                    _ => return Err(USAGE.to_owned()),
                }
            }
            other if other.starts_with('-') => return Err(USAGE.to_owned()),
            other => folder = PathBuf::from(other),
        }
    }
    if !folder.is_dir() {
        say(&format!("skipped: drawings of people, because {} is not here", folder.display()));
    }
    if let Some(way) = written {
        return told_written(&folder, part, way.as_deref());
    }
    if again {
        let drawings: Vec<Drawing> = people(&folder, part, OF_SPG)?.into_iter().map(|c| c.drawing).collect();
        say(&format!("{} drawings of people:\n\n{}", drawings.len(), changed::table(&drawings)));
        return Ok(());
    }
    let mut cases = if hundred { by_lot(people(&folder, part, OF_SPG)?) } else { cases(&folder, part)? };
    if !hundred {
        cases.extend(ways(part));
    }
    let mut rows: BTreeMap<String, Vec<(Case, Judged)>> = BTreeMap::new();
    // Reported as no plant: drawings by people, all others.
    let mut called = [0_usize; 2];
    for case in cases {
        let (reading, unlike) = read(&case.drawing);
        let people = case.kinds.is_empty() && !case.right.is_empty() && !case.set.starts_with("way: ");
        called[usize::from(!people)] += usize::from(unlike);
        let judged = judge(&case, reading);
        rows.entry(case.set.clone()).or_default().push((case, judged));
    }
    say(&table(&rows));
    let things = made_drawings::kinds::make_of_kinds(part as u64 + 1, MADE_TO_TEST).into_iter();
    let things: Vec<_> = things.filter(|(_, kind, _)| *kind == Kind::None).collect();
    let known =
        things.iter().filter(|(word, _, lines)| read(&Drawing::from_polylines(*word, lines)).1).count();
    say(&format!(
        "called no plant: {} drawings by people, {} others, {known} of {} made ones that are none\n",
        called[0],
        called[1],
        things.len()
    ));
    say(&words(&rows));
    say(&format!("our own drawings: {}\n", own_drawings()?.join(", ")));
    if sheets {
        if pictures {
            built_burgeon()?;
        }
        for (set, drawings) in &mut rows {
            // Errors come first.
            drawings.sort_by_key(|(_, j)| (j.number, core::cmp::Reverse(j.verdict)));
            sheet(set, drawings, pictures)?;
        }
        say("contact sheets: out/read");
    }
    Ok(())
}

/// Number of trees by people that are written in all ways.
const TREES_WRITTEN: usize = 24;

/// Reports the reading of our own drawings and trees by people, as programs write them, and of those of `programs`.
/// Every third of ours, by name, is held out for one look at the end.
fn told_written(folder: &Path, part: Part, way: Option<&str>) -> Outcome {
    let mut drawings: Vec<(String, Drawing)> = Vec::new();
    for sub in ["sketches/table1", "sketches/gallery", "illustrations"] {
        for (place, file) in svgs_in(&repository().join("fixtures").join(sub))?.into_iter().enumerate() {
            if (place % 3 == 2) == (part == Part::Test) {
                let bytes = fs::read(&file).map_err(|e| format!("{}: {e}", file.display()))?;
                let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
                let items = formats::read_drawings(bytes.as_slice(), formats::DrawingFormat::Svg, &name);
                drawings.extend(items.filter_map(|i| Some((name.clone(), i.ok()?.drawing))));
            }
        }
    }
    let trees = people(folder, part, OF_SPG)?.into_iter().filter(|c| c.set == "by hand tree");
    let trees = trees.step_by(2).take(TREES_WRITTEN).enumerate();
    drawings.extend(trees.map(|(k, c)| (format!("tree {k}"), c.drawing)));
    say(&format!("{} drawings:\n\n{}", drawings.len(), written::table(&drawings, way)?));
    let programs = folder.join("programs");
    if programs.is_dir() {
        say(&written::programs(&programs)?);
    } else {
        say(&format!("skipped: what programs write, because {} is not here", programs.display()));
    }
    Ok(())
}

/// Returns the pictures of a folder, by name.
fn svgs_in(folder: &Path) -> Outcome<Vec<PathBuf>> {
    let entries = fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let mut files: Vec<PathBuf> = entries.flatten().map(|f| f.path()).collect();
    files.retain(|f| f.extension().is_some_and(|e| e == "svg"));
    files.sort();
    Ok(files)
}

/// Reports the words of drawings by people that show a fruit or a vegetable and are read as that.
fn words(rows: &BTreeMap<String, Vec<(Case, Judged)>>) -> String {
    let (mut all, mut told, mut right) = (0, 0, 0);
    for (set, drawings) in rows {
        let asked = set.trim_start_matches("spg ");
        let kind = reading::glance::WORDS.iter().find(|w| w.0 == asked).map(|w| w.1);
        for (_, judged) in
            drawings.iter().filter(|(_, j)| kind.is_some_and(|k| k.is_like(Kind::Fruit) && k == j.kind))
        {
            let word = judged.reading.plants.first().and_then(|p| p.word);
            all += 1;
            told += usize::from(word.is_some());
            right += usize::from(word == Some(asked));
        }
    }
    format!("words: of {all} fruits and vegetables {told} are told by a word, {right} of them rightly\n")
}

/// Reports the kinds as which the drawings of `fixtures` are read.
fn own_drawings() -> Outcome<Vec<String>> {
    let mut found = Vec::new();
    for folder in ["table1", "gallery"] {
        let files = svgs_in(&repository().join("fixtures/sketches").join(folder))?;
        for file in files {
            let bytes = fs::read(&file).map_err(|e| format!("{}: {e}", file.display()))?;
            let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            for item in formats::read_drawings(bytes.as_slice(), formats::DrawingFormat::Svg, &name) {
                let drawing = item.map_err(|e| format!("{name}: {e}"))?;
                let (reading, unlike) = read(&drawing.drawing);
                let kinds: Vec<&str> = reading.plants.iter().map(|p| p.kind.word()).collect();
                found.push(format!("{name} {}{}", kinds.join("+"), if unlike { " (no plant)" } else { "" }));
            }
        }
    }
    Ok(found)
}

/// Returns the reading, and whether the drawing was reported as no plant.
fn read(drawing: &Drawing) -> (Reading, bool) {
    read_without(&[], &Seen::from_drawing(drawing))
}

/// A drawing and the classes of its strokes by the classifier.
struct Seen {
    ink: Ink,
    classes: Vec<Classified>,
}

impl Seen {
    fn from_drawing(drawing: &Drawing) -> Self {
        let ink = ink::clean(drawing, &mut Report::default());
        let classes = ink::classify(&ink, &Run::plain());
        Self { ink, classes }
    }
}

fn read_without(off: &[&str], seen: &Seen) -> (Reading, bool) {
    let mut report = Report::default();
    let reading = reading::read_without(off, &seen.ink, &seen.classes, &mut report);
    (reading, report.warnings.iter().any(|w| w.code == reading::UNLIKE_A_PLANT))
}

/// Salt that only these made drawings use, and from which no model has learnt.
const UNSEEN: u64 = 8;

/// Makes drawings of each way to draw a plant from which no model has learnt.
fn ways(part: Part) -> Vec<Case> {
    let made = made_drawings::kinds::make_of_kinds(UNSEEN + part as u64, MADE_TO_TEST).into_iter();
    made.filter(|w| w.1 != Kind::None)
        .enumerate()
        .map(|(k, (word, kind, lines))| Case {
            set: format!("way: {word}"),
            drawing: Drawing::from_polylines(format!("{word} {k}"), &lines),
            right: Kind::ALL.into_iter().filter(|k| same(*k, kind)).collect(),
            acceptable: Kind::ALL.into_iter().filter(|k| k.is_like(kind)).collect(),
            plants: Some(1),
            kinds: Vec::new(),
            own: usize::MAX,
        })
        .collect()
}

/// Drawings for choosing, to be read repeatedly with different rules.
pub(crate) struct Chosen(Vec<(Case, Seen)>);

impl Chosen {
    /// Collects those of the people of `folder`, and made ones: those used for judging, and of each way to draw a plant
    /// some from which no model has learnt.
    pub(crate) fn collect(folder: &Path) -> Outcome<Self> {
        Ok(Self(
            cases(folder, Part::Choose)?
                .into_iter()
                .chain(ways(Part::Choose))
                .map(|case| {
                    let seen = Seen::from_drawing(&case.drawing);
                    (case, seen)
                })
                .collect(),
        ))
    }

    /// Returns the number of drawings.
    pub(crate) const fn count(&self) -> usize {
        self.0.len()
    }

    /// Counts the drawings read rightly, and those that a person would accept, with some rules switched off.
    pub(crate) fn judged(&self, off: &[&str]) -> [usize; 2] {
        let found = self.verdicts(off);
        [Frame::Right, Frame::Acceptable].map(|f| found.iter().filter(|v| **v == f).count())
    }

    fn verdicts(&self, off: &[&str]) -> Vec<Frame> {
        self.0.iter().map(|(case, seen)| judge(case, read_without(off, seen).0).verdict).collect()
    }

    /// Reports the effects of a rule, drawing by drawing.
    fn told_without(&self, rule: &str) -> String {
        let (with, without) = (self.verdicts(&[]), self.verdicts(&[rule]));
        let mut out = String::new();
        for ((case, _), (a, b)) in self.0.iter().zip(with.iter().zip(&without)).filter(|(_, (a, b))| a != b) {
            let _ = writeln!(out, "{}, {}: {a:?}, without `{rule}` {b:?}", case.set, case.drawing.name);
        }
        let right = |list: &[Frame]| list.iter().filter(|v| **v == Frame::Right).count();
        let _ =
            write!(out, "{} right of {}, without `{rule}` {}", right(&with), self.count(), right(&without));
        out
    }
}

/// Collects all drawings of a part.
fn cases(folder: &Path, part: Part) -> Outcome<Vec<Case>> {
    let mut cases = people(folder, part, OF_SPG)?;
    let together = together(&cases, part, SIDE_BY_SIDE);
    cases.extend(together);
    cases.extend(made(part));
    Ok(cases)
}

/// Draws a hundred of them by lot, each set named after its place among four sheets.
fn by_lot(mut all: Vec<Case>) -> Vec<Case> {
    let r = &mut Seed::new(20).stream(Draw::Test);
    for k in 0..all.len().min(HUNDRED) {
        let other = k + r.below(all.len() - k);
        all.swap(k, other);
    }
    all.truncate(HUNDRED);
    for (k, case) in all.iter_mut().enumerate() {
        case.drawing.name = format!("{} {}", case.set, case.drawing.name);
        case.set = format!("hundred {}", 1 + 4 * k / HUNDRED);
    }
    all
}

/// Of this many drawings of the SPG set one is read for judging: they show only three things.
const OF_SPG: usize = 4;

/// Collects the drawings of people of one part; of the SPG set one of `of_spg`.
fn people(folder: &Path, part: Part, of_spg: usize) -> Outcome<Vec<Case>> {
    let mut cases = Vec::new();
    for (sub, prefix) in
        [("quickdraw", ""), ("quickdraw_more", ""), ("spg", "spg "), ("trees_by_hand", "by hand ")]
    {
        let Ok(entries) = fs::read_dir(folder.join(sub)) else { continue };
        let mut files: Vec<PathBuf> = entries.flatten().map(|f| f.path()).collect();
        files.retain(|f| f.extension().is_some_and(|e| e == "ndjson"));
        files.sort();
        for file in files {
            let stem = file.file_stem().unwrap_or_default().to_string_lossy();
            let set = format!("{prefix}{stem}");
            let Some((_, right, acceptable)) = CATEGORIES.iter().find(|c| c.0 == set) else {
                say(&format!("skipped: {set}, because nobody said what it shows"));
                continue;
            };
            let every = if sub == "spg" { of_spg } else { 1 };
            let lines = json_lines(&file)?;
            let own = lines.iter().filter(|l| Part::from_line(l) == Some(part)).step_by(every);
            cases.extend(own.map(|line| Case {
                set: set.clone(),
                drawing: drawing_of(line),
                right: right.to_vec(),
                acceptable: acceptable.to_vec(),
                plants: (!MANY.contains(&&*set)).then_some(1),
                kinds: Vec::new(),
                own: usize::MAX,
            }));
        }
    }
    Ok(cases)
}

/// Returns the given folder of drawings, or the default one; reports a missing one.
pub(crate) fn sketches(args: &[String]) -> Option<PathBuf> {
    let folder = args.iter().find(|a| !a.starts_with('-'));
    let folder = folder.map_or_else(|| repository().join("../shared/data/sketches"), PathBuf::from);
    let found = folder.is_dir();
    if !found {
        say(&format!("skipped: {} is not here", folder.display()));
    }
    found.then_some(folder)
}

/// A drawing whose plants are known.
pub(crate) struct Labelled {
    pub(crate) drawing: Drawing,
    /// Kinds of its plants, from left to right.
    pub(crate) kinds: Vec<Kind>,
    pub(crate) origin: Origin,
}

/// Origin of a labelled drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Origin {
    /// "Quick, Draw!".
    Public,
    /// The SPG set: three categories, each with many drawings.
    Spg,
    /// Rows of plants and trees of one trunk and one crown.
    Rows,
    /// Drawings by people, put next to one another; the kinds of their plants are learnt elsewhere.
    Together,
    /// One plant of any kind, or none.
    Kinds,
    /// Icons of plants, by the kind that their file's name says.
    Icons,
}

/// Collects drawings of a part whose plants are known. Trees by hand are excluded: no model learns from those.
pub(crate) fn labelled(folder: &Path, part: Part) -> Outcome<Vec<Labelled>> {
    let people = people(folder, part, 1)?;
    let sets = if part == Part::Train { 4 * SIDE_BY_SIDE } else { SIDE_BY_SIDE };
    let together = together(&people, part, sets).into_iter().map(|c| Labelled {
        drawing: c.drawing,
        kinds: vec![Kind::None; c.plants.unwrap_or(0)],
        origin: Origin::Together,
    });
    let together: Vec<Labelled> = together.collect();
    let known = people.into_iter().filter(|c| c.set != "garden" && c.set != "by hand tree");
    let known = known.map(|c| Labelled {
        origin: if c.set.starts_with("spg") { Origin::Spg } else { Origin::Public },
        kinds: c.right.into_iter().take(1).collect(),
        drawing: c.drawing,
    });
    // Thirty similar flowers teach little more than one.
    let rows =
        made(part).into_iter().filter(|c| c.own == usize::MAX && c.set != made_drawings::BEDS_OF_FLOWERS);
    let rows = rows.map(|c| Labelled { drawing: c.drawing, kinds: c.kinds, origin: Origin::Rows });
    let each = if part == Part::Train { MADE_TO_LEARN } else { MADE_TO_TEST };
    let kinds = made_drawings::kinds::make_of_kinds(part as u64 + 1, each).into_iter().enumerate();
    let kinds = kinds.map(|(k, (word, kind, lines))| Labelled {
        drawing: Drawing::from_polylines(format!("made {word} {k}"), &lines),
        kinds: vec![kind],
        origin: Origin::Kinds,
    });
    Ok(known.chain(together).chain(rows).chain(kinds).collect())
}

/// Collects all drawings of a part by people: the requested word, its kind, if it is one, and the drawing.
pub(crate) fn by_people(folder: &Path, part: Part) -> Outcome<Vec<(String, Option<Kind>, Drawing)>> {
    let one = |right: &[Kind]| right.first().copied().filter(|k| right.iter().all(|r| r.is_like(*k)));
    Ok(people(folder, part, 1)?.into_iter().map(|c| (c.set, one(&c.right), c.drawing)).collect())
}

/// Collects drawings of several plants of a part: drawings by people put next to one another, and made ones.
pub(crate) fn collect_several(folder: &Path, part: Part) -> Outcome<Vec<Drawing>> {
    let together = together(&people(folder, part, OF_SPG)?, part, SIDE_BY_SIDE);
    let all = together.into_iter().chain(made(part)).filter(|c| c.kinds.len() != 1 && c.own == usize::MAX);
    Ok(all.map(|c| c.drawing).collect())
}

/// Collects drawings of a part by people who were asked for a word, with the word.
pub(crate) fn asked_for(folder: &Path, part: Part) -> Outcome<Vec<(String, Drawing)>> {
    let people =
        people(folder, part, 1)?.into_iter().filter(|c| !c.set.contains("spg") && !c.set.contains("by hand"));
    Ok(people.map(|c| (c.set, c.drawing)).collect())
}

/// Number of made drawings for training, of each way to draw a kind.
const MADE_TO_LEARN: u64 = 120;
/// Number of made drawings for testing, of each way to draw a kind.
const MADE_TO_TEST: u64 = 12;

/// Categories in which a drawing may show several plants.
const MANY: [&str; 7] = ["garden", "asparagus", "blackberry", "blueberry", "string bean", "mushroom", "peas"];
/// Categories that stand on a ground, one plant in each drawing.
const STANDING: [&str; 7] = ["tree", "palm tree", "cactus", "flower", "bush", "house plant", "by hand tree"];
/// Others that may lie or stand among them.
const AMONG: [&str; 3] = ["apple", "carrot", "peas"];

/// Puts drawings of people next to one another: two to six plants, now and then with something else among them.
fn together(cases: &[Case], part: Part, sets: u64) -> Vec<Case> {
    let of = |sets: &[&str]| -> Vec<&Case> {
        cases.iter().filter(|c| sets.contains(&&*c.set) && c.drawing.strokes.len() < 40).collect()
    };
    let (standing, among) = (of(&STANDING), of(&AMONG));
    if standing.is_empty() {
        return Vec::new();
    }
    let seed = Seed::new(77 + part as u64);
    let mut found = Vec::new();
    for k in 0..sets {
        let r = &mut seed.child(k).stream(Draw::Template);
        let n = 2 + r.below(5);
        let mut chosen: Vec<&Case> = (0..n).map(|_| standing[r.below(standing.len())]).collect();
        if n > 2 && !among.is_empty() && r.chance(0.25) {
            chosen[r.below(n)] = among[r.below(among.len())];
        }
        let lines = chosen.iter().map(|c| unit(&c.drawing)).collect();
        found.push(Case {
            set: "people's drawings side by side".to_owned(),
            drawing: Drawing::from_polylines(format!("together-{k}"), &side_by_side(r, lines)),
            right: Vec::new(),
            acceptable: Vec::new(),
            plants: Some(n),
            kinds: Vec::new(),
            own: usize::MAX,
        });
    }
    found
}

/// Returns the lines of a drawing, scaled to height 1.
fn unit(drawing: &Drawing) -> Vec<Vec<DVec2>> {
    let lines: Vec<Vec<DVec2>> =
        drawing.strokes.iter().map(|s| s.samples.iter().map(|p| p.at).collect()).collect();
    let all = lines.iter().flatten();
    let (lo, hi) =
        all.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), &p: &DVec2| (lo.min(p), hi.max(p)));
    let scale = 1.0 / (hi.y - lo.y).max(0.6 * (hi.x - lo.x)).max(1e-9);
    lines.into_iter().map(|l| l.into_iter().map(|p| (p - lo) * scale).collect()).collect()
}

fn made(part: Part) -> Vec<Case> {
    let salt = part as u64 + 1;
    let cases = (0_u32..).zip(made_drawings::shown(salt)).map(|(k, shown)| Case {
        set: shown.set.to_owned(),
        drawing: Drawing::from_polylines(format!("made-{k}"), &shown.lines),
        right: if let [one] = shown.plants[..] { vec![one] } else { Vec::new() },
        acceptable: Vec::new(),
        plants: Some(shown.plants.len()),
        own: shown.own,
        kinds: shown.plants,
    });
    cases.collect()
}

fn judge(case: &Case, reading: Reading) -> Judged {
    let plants = reading.plants.len();
    let number = case.plants.is_none_or(|n| n == plants && built(case, &reading));
    let kind = match &reading.plants[..] {
        [one] => one.kind,
        _ => Kind::from_reading(&reading),
    };
    let verdict = if !case.kinds.is_empty() && case.kinds.len() > 1 {
        let found: Vec<Kind> = reading.plants.iter().map(|p| p.kind).collect();
        let alike = found.iter().zip(&case.kinds).filter(|(a, b)| same(**a, **b)).count();
        if !number {
            Frame::Wrong
        } else if alike == case.kinds.len() {
            Frame::Right
        } else {
            Frame::Acceptable
        }
    } else if case.right.is_empty() {
        if number { Frame::Right } else { Frame::Wrong }
    } else if number && case.right.contains(&kind) && whole(case, &reading) {
        Frame::Right
    } else if case.right.contains(&kind) || case.acceptable.contains(&kind) {
        Frame::Acceptable
    } else {
        Frame::Wrong
    };
    Judged { kind, plants, verdict, number, reading }
}

fn same(found: Kind, meant: Kind) -> bool {
    let group = |k| if k == Kind::Conifer { Kind::Tree } else { k };
    group(found) == group(meant)
}

/// Whether the plant has as many plants as were drawn: flowers, crowns or stems.
fn built(case: &Case, reading: &Reading) -> bool {
    let meant = |k: Kind| case.kinds.iter().filter(|&&m| m == k).count();
    if case.kinds.iter().any(|k| ![Kind::Flower, Kind::Tree, Kind::Stem, Kind::Bush].contains(k)) {
        return true;
    }
    let flowers = reading.flowers.iter().filter(|f| f.petals.len() >= 3).count();
    let standing = reading.axes.iter().filter(|a| a.bearer.is_none()).count();
    let lobes = case.kinds.len() == 1;
    match case.kinds.len() {
        0 => true,
        n if meant(Kind::Flower) == n => flowers == n && standing == n,
        n if meant(Kind::Tree) == n => (lobes || reading.regions.len() == n) && standing == n && flowers == 0,
        n if meant(Kind::Stem) == n => standing == n && flowers == 0,
        _ => flowers == meant(Kind::Flower),
    }
}

/// Whether no line of a made drawing was taken for something else.
fn whole(case: &Case, reading: &Reading) -> bool {
    if case.own == usize::MAX {
        return case.kinds.is_empty() || whole_tree(reading);
    }
    reading.strokes.iter().all(|s| {
        let left = s.source == Source::Rule(reading::BESIDE_THE_PLANT);
        left == (s.index as usize >= case.own)
    })
}

/// Whether nothing of a tree of one trunk and one crown was taken for something else.
fn whole_tree(reading: &Reading) -> bool {
    use OrganWord::{Branch, LeafContour, Trunk};
    let parts = reading.strokes.iter().all(|s| [Branch, LeafContour, Trunk].contains(&s.organ));
    let axes = reading.axes.iter().filter(|a| a.bearer.is_none()).count();
    parts && axes == 1 && reading.leaves.is_empty() && reading.fruits.is_empty() && reading.flowers.is_empty()
}

fn table(rows: &BTreeMap<String, Vec<(Case, Judged)>>) -> String {
    let mut out = String::new();
    let _ = writeln!(
        out,
        "{:34} {:>4} {:>6} {:>6} {:>6} {:>7}  found",
        "drawings", "all", "right", "accept", "wrong", "number"
    );
    let mut sum = [[0_usize; 5]; 4];
    for (set, list) in rows {
        let count = |f: Frame| list.iter().filter(|(_, j)| j.verdict == f).count();
        let counts = [
            list.len(),
            count(Frame::Right),
            count(Frame::Acceptable),
            count(Frame::Wrong),
            list.iter().filter(|(_, j)| j.number).count(),
        ];
        let group = match list.first() {
            Some((c, _)) if c.kinds.len() == 1 => 2,
            Some((c, _)) if c.right.is_empty() => 1,
            Some((c, _)) if c.set.starts_with("way: ") => 3,
            _ => 0,
        };
        sum[group].iter_mut().zip(counts).for_each(|(s, c)| *s += c);
        let mut found: BTreeMap<String, usize> = BTreeMap::new();
        for (case, j) in list {
            let word = if case.right.is_empty() {
                format!("{}/{}", j.plants, case.plants.unwrap_or(0))
            } else if j.plants == 1 {
                j.kind.word().to_owned()
            } else {
                format!("{} x{}", j.kind.word(), j.plants)
            };
            *found.entry(word).or_default() += 1;
        }
        let mut found: Vec<(usize, String)> = found.into_iter().map(|(k, n)| (n, k)).collect();
        found.sort_by(|a, b| b.0.cmp(&a.0).then(a.1.cmp(&b.1)));
        let words: Vec<String> = found.iter().map(|(n, k)| format!("{k} {n}")).collect();
        let [all, right, accept, wrong, number] = counts;
        let _ = writeln!(
            out,
            "{set:34} {all:>4} {right:>6} {accept:>6} {wrong:>6} {number:>7}  {}",
            words.join(", ")
        );
    }
    for (name, [all, right, accept, wrong, number]) in
        ["one drawing", "several plants", "made trees", "ways to draw one"].iter().zip(sum)
    {
        let _ = writeln!(
            out,
            "{:34} {all:>4} {right:>6} {accept:>6} {wrong:>6} {number:>7}",
            format!("= {name}")
        );
    }
    out
}

/// Writes a page of the drawings of a set.
fn sheet(set: &str, drawings: &[(Case, Judged)], pictures: bool) -> Outcome {
    const MOST: usize = 48;
    let name: String = set.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect();
    let folder = repository().join("out/read");
    let fault = |p: &Path, e: &dyn std::fmt::Display| format!("{}: {e}", p.display());
    fs::create_dir_all(&folder).map_err(|e| fault(&folder, &e))?;
    let shown = &drawings[..drawings.len().min(MOST)];
    let mut notes = String::new();
    for (k, (case, j)) in drawings.iter().enumerate() {
        let strokes: Vec<String> = (j.reading.strokes.iter())
            .map(|s| {
                format!("{}={}:{}({:.2},{})", s.index, s.class.word(), s.organ.word(), s.confidence, s.source)
            })
            .collect();
        let plants = j.reading.plants.iter();
        let kinds: Vec<String> = plants
            .map(|p| {
                let scores = p.readings.iter().map(|r| format!("{} {:.2}", r.kind.word(), r.score));
                scores.collect::<Vec<_>>().join("|")
            })
            .collect();
        let _ = writeln!(notes, "{k:3} {} {} [{}]", case.drawing.name, kinds.join(","), strokes.join(" "));
    }
    fs::write(folder.join(format!("{name}.txt")), notes).map_err(|e| fault(&folder, &e))?;
    let plants = pictures.then(|| made_pictures(&folder.join(&name), shown)).transpose()?;
    let cells: Vec<Cell<'_>> = shown
        .iter()
        .enumerate()
        .map(|(k, (case, j))| Cell {
            drawing: &case.drawing,
            reading: &j.reading,
            picture: plants.as_ref().map(|p| p.join(format!("d{k:03}.png"))),
            frame: j.verdict,
        })
        .collect();
    contact_sheet::write(&cells, &folder.join(format!("{name}.png")))
}

/// Makes the plants of drawings with the command, as any user would; returns the folder of their pictures.
fn made_pictures(folder: &Path, drawings: &[(Case, Judged)]) -> Outcome<PathBuf> {
    let fault = |p: &Path, e: &dyn std::fmt::Display| format!("{}: {e}", p.display());
    if folder.exists() {
        fs::remove_dir_all(folder).map_err(|e| fault(folder, &e))?;
    }
    fs::create_dir_all(folder).map_err(|e| fault(folder, &e))?;
    let mut lines = String::new();
    for (k, (case, _)) in drawings.iter().enumerate() {
        let strokes: Vec<Value> = case
            .drawing
            .strokes
            .iter()
            .map(|s| {
                let column =
                    |get: fn(DVec2) -> f64| s.samples.iter().map(|p| get(p.at)).collect::<Vec<f64>>();
                json!([column(|p| p.x), column(|p| -p.y)])
            })
            .collect();
        let _ = writeln!(lines, "{}", json!({"key_id": format!("d{k:03}"), "drawing": strokes}));
    }
    let input = folder.join("drawings.ndjson");
    fs::write(&input, lines).map_err(|e| fault(&input, &e))?;
    let pictures = folder.join("png");
    let text = |p: &Path| p.to_string_lossy().into_owned();
    command(
        burgeon("release"),
        &["sketch", &text(&input), "--png", &text(&pictures), "--size", "240x240", "--quiet"],
    )?;
    Ok(pictures)
}
