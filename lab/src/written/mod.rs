//! `cargo xtask read-drawings --written`: whether a drawing gives the same plant in all the ways in which programs
//! write it.
//!
//! `drawings -> for each way, the file that a program writes -> its strokes and its plant, compared with those of plain
//! strokes`

mod lines;
mod page;
mod programs;
mod sheets;
mod ways;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use base::{Draw, Report, Run, Seed};
use formats::DrawingFormat;
use glam::DVec2;
use ink::Drawing;
use reading::{Kind, Reading};

use page::Page;
use ways::WAYS;
use xtask::shell::{Outcome, repository};

/// Distance within which lengths are compared, as a share of the sheet's diagonal, and the width of a broad pen.
const NEAR: f64 = 0.012;
/// Distance between the places at which lines are compared, as a share of the diagonal.
const STEP: f64 = 0.004;
/// A stroke is the plain one if its points are nearer than this, in units of the sheet.
const SAME_PLACE: f64 = 0.05;
/// Ink is missing or foreign if it is more than this share of all.
const MUCH_INK: f64 = 0.02;
/// Least number of organs from which on it may differ by one, or by [`FEW_OF_MANY`].
const MANY: usize = 5;
/// Share by which the numbers of many organs may differ.
const FEW_OF_MANY: f64 = 0.1;

/// A plant in numbers: kinds sorted; axes, leaves, flowers, petals, fruits, pots, contours.
#[derive(Debug, PartialEq, Eq)]
struct Numbers {
    kinds: Vec<Kind>,
    organs: [usize; 7],
}

impl Numbers {
    fn count(reading: &Reading) -> Self {
        let mut kinds: Vec<Kind> = reading.plants.iter().map(|p| p.kind).collect();
        kinds.sort_unstable();
        let petals = reading.flowers.iter().map(|f| f.petals.len()).sum();
        let organs = [
            reading.axes.len(),
            reading.leaves.len(),
            reading.flowers.len(),
            petals,
            reading.fruits.len(),
            reading.pots.len(),
            reading.regions.len(),
        ];
        Self { kinds, organs }
    }

    /// Whether it has the same kinds, and as many organs: of five or more, one or a tenth of them more or less.
    fn is_same_plant(&self, other: &Self) -> bool {
        let is_as_many = |(a, b): (&usize, &usize)| {
            let most = *a.max(b);
            let free = if most < MANY { 0.0 } else { (FEW_OF_MANY * most as f64).max(1.0) };
            a.abs_diff(*b) as f64 <= free
        };
        self.kinds == other.kinds && self.organs.iter().zip(&other.organs).all(is_as_many)
    }
}

impl core::fmt::Display for Numbers {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let kinds: Vec<&str> = self.kinds.iter().map(|k| k.word()).collect();
        write!(f, "{}", kinds.join("+"))?;
        let words = ["axes", "leaves", "flowers", "petals", "fruits", "pots", "contours"];
        for (word, count) in words.iter().zip(self.organs).filter(|(_, n)| *n > 0) {
            write!(f, ", {word} {count}")?;
        }
        Ok(())
    }
}

/// A file as read.
struct ReadFile {
    drawing: Drawing,
    codes: Vec<String>,
}

impl ReadFile {
    fn read(bytes: &[u8], format: DrawingFormat) -> Outcome<Self> {
        let read = formats::read_drawings(bytes, format, "written").next();
        let read = read.ok_or("no drawing")?.map_err(|e| e.to_string())?;
        let codes = read.warnings.iter().map(|w| w.code.to_owned()).collect();
        Ok(Self { drawing: read.drawing, codes })
    }

    fn numbers(&self) -> Numbers {
        let ink = ink::clean(&self.drawing, &mut Report::default());
        let classes = ink::classify(&ink, &Run::plain());
        Numbers::count(&reading::read(&ink, &classes, &mut Report::default()))
    }

    fn lines(&self) -> Vec<Vec<DVec2>> {
        let seen = self.drawing.strokes.iter().filter(|s| !s.hidden);
        seen.map(|s| s.samples.iter().map(|p| p.at).collect()).collect()
    }

    /// Whether its strokes are those of the other one, point by point, in their order and colours.
    fn has_strokes_of(&self, other: &Self) -> bool {
        let (a, b) = (self.lines(), other.lines());
        let is_same = |(a, b): (&Vec<DVec2>, &Vec<DVec2>)| {
            a.len() == b.len() && a.iter().zip(b).all(|(p, q)| p.distance(*q) <= SAME_PLACE)
        };
        let colors =
            |file: &Self| -> Vec<Option<[u8; 3]>> { file.drawing.strokes.iter().map(|s| s.color).collect() };
        a.len() == b.len() && colors(self) == colors(other) && a.iter().zip(&b).all(is_same)
    }
}

/// Returns the share of the length of some lines that is near no other line.
fn ink_apart(lines: &[Vec<DVec2>], others: &[Vec<DVec2>], diagonal: f64) -> f64 {
    let (near, step) = (NEAR * diagonal, STEP * diagonal);
    let boxes: Vec<(DVec2, DVec2)> = others.iter().filter_map(|l| geom::bounds(l)).collect();
    let is_near = |p: DVec2| {
        let by_box = |((lo, hi), line): (&(DVec2, DVec2), &Vec<DVec2>)| {
            let is_in = (*lo - near).cmple(p).all() && (*hi + near).cmpge(p).all();
            is_in && geom::distance_to_polyline(line, p).is_some_and(|d| d <= near)
        };
        boxes.iter().zip(others).any(by_box)
    };
    let (mut all, mut apart) = (0_usize, 0_usize);
    for p in lines.iter().flat_map(|l| geom::resample(l, step)) {
        all += 1;
        apart += usize::from(!is_near(p));
    }
    apart as f64 / all.max(1) as f64
}

/// Effects of one way on drawings.
#[derive(Clone, Default)]
struct Tally {
    drawings: usize,
    other_plant: usize,
    other_strokes: usize,
    missing: usize,
    foreign: usize,
    /// Number of drawings whose strokes differ without a warning.
    silent: usize,
    /// Descriptions of those with a different plant.
    faults: Vec<String>,
}

impl Tally {
    fn add(&mut self, other: &Self) {
        self.drawings += other.drawings;
        self.other_plant += other.other_plant;
        self.other_strokes += other.other_strokes;
        self.missing += other.missing;
        self.foreign += other.foreign;
        self.silent += other.silent;
        self.faults.extend(other.faults.iter().cloned());
    }

    fn row(&self) -> String {
        let share = 100.0 * self.other_plant as f64 / self.drawings.max(1) as f64;
        format!(
            "{} | {} | {share:.0} % | {} | {} | {} | {}",
            self.drawings, self.other_plant, self.other_strokes, self.missing, self.foreign, self.silent
        )
    }
}

/// A drawing as plain strokes, and its plant.
struct Plain {
    name: String,
    page: Page,
    file: ReadFile,
    lines: Vec<Vec<DVec2>>,
    numbers: Numbers,
}

impl Plain {
    fn new(name: &str, drawing: &Drawing) -> Option<Self> {
        let page = Page::new(drawing)?;
        let written = page.svg(&page.paths());
        let file = ReadFile::read(&written.bytes, written.format).ok()?;
        let numbers = file.numbers();
        Some(Self { name: name.to_owned(), lines: file.lines(), page, file, numbers })
    }

    /// Compares the result of one way with the plain strokes.
    fn judge(&self, way: usize, keep: Option<&Path>) -> Tally {
        let stream = &mut Seed::new(77).child(way as u64).stream(Draw::Test);
        let Some(written) = (WAYS[way].2)(&self.page, stream) else { return Tally::default() };
        let mut tally = Tally { drawings: 1, ..Tally::default() };
        let read = match ReadFile::read(&written.bytes, written.format) {
            Ok(read) => read,
            Err(why) => {
                (tally.other_plant, tally.other_strokes, tally.missing) = (1, 1, 1);
                tally.faults.push(format!("{}: {why}", self.name));
                return tally;
            }
        };
        if read.has_strokes_of(&self.file) {
            return tally;
        }
        let (lines, diagonal) = (read.lines(), self.page.size.length());
        let missing = ink_apart(&self.lines, &lines, diagonal);
        let foreign = ink_apart(&lines, &self.lines, diagonal);
        tally.other_strokes = usize::from(lines.len() != self.lines.len());
        tally.missing = usize::from(missing > MUCH_INK);
        tally.foreign = usize::from(foreign > MUCH_INK);
        let differs = tally.other_strokes + tally.missing + tally.foreign > 0;
        tally.silent = usize::from(differs && read.codes.is_empty());
        let numbers = read.numbers();
        if !numbers.is_same_plant(&self.numbers) {
            tally.other_plant = 1;
            tally.faults.push(format!(
                "{}: {} strokes for {}, {:.0} % missing, {:.0} % foreign; {numbers} for {}; {}",
                self.name,
                lines.len(),
                self.lines.len(),
                100.0 * missing,
                100.0 * foreign,
                self.numbers,
                read.codes.join(" ")
            ));
            if let Some(folder) = keep {
                let ending = written.format.extension();
                let file = format!("{} {}.{ending}", self.name, WAYS[way].1.replace(['<', '>'], ""));
                // A picture for inspection; if it cannot be written, the table is still valid.
                let _ = fs::write(folder.join(file), &written.bytes);
            }
        }
        tally
    }
}

/// Returns for each way to write a drawing the number with a plant other than that of plain strokes, and the reasons.
///
/// `only`: ways or kinds of faults with this in their names; their faults are listed one by one, and their files are
/// written to `out/written`.
///
/// # Errors
/// A sentence: the way does not exist, or a folder cannot be made.
pub(crate) fn table(drawings: &[(String, Drawing)], only: Option<&str>) -> Outcome<String> {
    const HANDS: usize = 2;
    let is_wanted = |way: &usize| only.is_none_or(|o| WAYS[*way].0.contains(o) || WAYS[*way].1.contains(o));
    let ways: Vec<usize> = (0..WAYS.len()).filter(is_wanted).collect();
    if ways.is_empty() {
        return Err(format!("no way to write a drawing has `{}` in its name", only.unwrap_or_default()));
    }
    let folder = repository().join("out/written");
    let keep = only.map(|_| folder.as_path());
    if keep.is_some() {
        fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    }
    let mut found: Vec<Vec<Tally>> = vec![Vec::new(); drawings.len()];
    let part = drawings.len().div_ceil(HANDS).max(1);
    std::thread::scope(|scope| {
        for (drawings, found) in drawings.chunks(part).zip(found.chunks_mut(part)) {
            let ways = &ways;
            scope.spawn(move || {
                for ((name, drawing), found) in drawings.iter().zip(found) {
                    let plain = Plain::new(name, drawing);
                    *found =
                        plain.map_or_else(Vec::new, |p| ways.iter().map(|w| p.judge(*w, keep)).collect());
                }
            });
        }
    });
    let mut sums: Vec<Tally> = vec![Tally::default(); ways.len()];
    for row in &found {
        sums.iter_mut().zip(row).for_each(|(sum, tally)| sum.add(tally));
    }
    Ok(format_table(&ways, &sums, only.is_some()))
}

fn format_table(ways: &[usize], sums: &[Tally], each: bool) -> String {
    const HEAD: &str = "| drawings | another plant | share | another number of strokes | ink missing | ink foreign | silent |\n|---|---|---|---|---|---|---|---|\n";
    let mut out = format!("| way {HEAD}");
    let mut kinds: BTreeMap<&str, Tally> = BTreeMap::new();
    for (way, sum) in ways.iter().zip(sums) {
        let (kind, name, _) = WAYS[*way];
        let _ = writeln!(out, "| {kind}: {name} | {} |", sum.row());
        kinds.entry(kind).or_default().add(sum);
        if each {
            sum.faults.iter().for_each(|fault| {
                let _ = writeln!(out, "    {fault}");
            });
        }
    }
    let mut worst: Vec<(&str, Tally)> = kinds.into_iter().collect();
    let share = |t: &Tally| t.other_plant as f64 / t.drawings.max(1) as f64;
    worst.sort_by(|a, b| share(&b.1).total_cmp(&share(&a.1)));
    let _ = write!(out, "\n| kind of fault {HEAD}");
    for (kind, sum) in worst {
        let _ = writeln!(out, "| {kind} | {} |", sum.row());
    }
    out
}

/// Compares the daisy and the tree of `programs` with their controls, file by file.
///
/// # Errors
/// A sentence: there is no control, or a file cannot be read at all.
pub(crate) fn programs(folder: &Path) -> Outcome<String> {
    let mut files: Vec<PathBuf> = fs::read_dir(folder)
        .map_err(|e| format!("{}: {e}", folder.display()))?
        .flatten()
        .map(|f| f.path())
        .collect();
    files.sort();
    let read = |file: &Path| {
        let ending = file.extension().unwrap_or_default().to_string_lossy().into_owned();
        let format =
            DrawingFormat::from_extension(&ending).ok_or(format!("{}: no drawing", file.display()))?;
        ReadFile::read(&fs::read(file).map_err(|e| format!("{}: {e}", file.display()))?, format)
    };
    let name = |file: &Path| file.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let control = |plant: &str| -> Outcome<Numbers> {
        let file = files.iter().find(|f| name(f).starts_with(&format!("00-control_{plant}")));
        Ok(read(file.ok_or(format!("no control of the {plant}"))?)?.numbers())
    };
    let controls = [("daisy", control("daisy")?), ("tree", control("tree")?)];
    let (mut out, mut same, mut all) = (String::new(), 0, 0);
    for file in files.iter().filter(|f| !name(f).starts_with("00-control")) {
        let name = name(file);
        // A file whose name does not say it shows the daisy.
        let named = |(plant, _): &&(&str, Numbers)| name.contains(&format!("_{plant}"));
        let meant = controls.iter().find(named).unwrap_or(&controls[0]);
        let (numbers, codes) = match read(file) {
            Ok(read) => (read.numbers(), read.codes.join(" ")),
            Err(why) => (Numbers { kinds: Vec::new(), organs: [0; 7] }, why),
        };
        let is_same = numbers.is_same_plant(&meant.1);
        all += 1;
        same += usize::from(is_same);
        let _ = writeln!(out, "{} {name}: {numbers}; {codes}", if is_same { "same " } else { "OTHER" });
    }
    let _ =
        writeln!(out, "{same} of {all} give the plant of the control ({}; {})", controls[0].1, controls[1].1);
    Ok(out)
}
