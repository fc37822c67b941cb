//! The value of each rule of reading: `table + labelled drawings -> one row for each rule`, with that rule switched
//! off.
//!
//! Classes come from classifiers that were trained without the drawing that is read, as in the figures of the
//! classifier: on drawings that it knows by heart no rule would be needed.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use base::{Report, Run};
use formats::DrawingFormat;
use ink::{
    Classified, Drawing, FEW_CLEAR, HeldOut, Ink, StrokeClass, StrokeRow, StrokeSource, held_out_strokes,
};
use reading::{RULES, Reading, read_without};

use crate::made_strokes::made_sketches;
use crate::quickdraw::drawings_of;
use crate::read_drawings::{Chosen, Part};

/// Number of dealings of the drawings over which the strokes read right are summed.
const DEALINGS: u64 = 4;

/// A drawing with its classes, and labels by stroke.
struct Sheet<'a> {
    ink: Ink,
    classes: Vec<Classified>,
    rows: Vec<&'a StrokeRow>,
}

impl Sheet<'_> {
    /// Whether no model and no choice has used it.
    fn is_of_the_end(&self) -> bool {
        self.rows
            .iter()
            .any(|r| r.source == StrokeSource::Public && Part::from_key(&r.drawing) == Some(Part::Test))
    }

    fn read(&self, off: &[&str]) -> Reading {
        read_without(off, &self.ink, &self.classes, &mut Report::default())
    }
}

/// Results for the labelled strokes, over all dealings.
#[derive(Default)]
struct Score {
    /// Confusion on the public's drawings: rows are labels, columns the classes read.
    confusion: [[u32; StrokeClass::ALL.len()]; StrokeClass::ALL.len()],
    /// Strokes of the public about which the labeller was unsure, or that are two things at once, read as labelled.
    doubtful: u32,
    /// Parts labelled by others that were read right.
    parts: u32,
}

impl Score {
    fn add(&mut self, sheet: &Sheet<'_>, reading: &Reading) {
        for row in &sheet.rows {
            let Some(found) = reading.strokes.iter().find(|s| s.index == row.stroke) else { continue };
            match row.source {
                StrokeSource::Public if !row.is_clear() => {
                    self.doubtful += u32::from(found.class == row.label);
                }
                StrokeSource::Public => self.confusion[row.label.place()][found.class.place()] += 1,
                StrokeSource::Parts => self.parts += u32::from(found.class == row.label),
                StrokeSource::Made => {}
            }
        }
    }

    fn right(&self) -> u32 {
        (0..StrokeClass::ALL.len()).map(|k| self.confusion[k][k]).sum()
    }

    /// Counts the clear strokes of a class by the public.
    fn labelled(&self, class: usize) -> u32 {
        self.confusion[class].iter().sum()
    }

    /// Returns the classes with enough clear strokes.
    fn counted(&self) -> Vec<usize> {
        let enough = |k: &usize| u64::from(self.labelled(*k)) >= FEW_CLEAR as u64 * DEALINGS;
        (0..StrokeClass::ALL.len()).filter(enough).collect()
    }

    fn macro_f1(&self) -> f64 {
        self.mean_f1(&self.counted())
    }

    fn mean_f1(&self, classes: &[usize]) -> f64 {
        let f1 = |&k: &usize| {
            let taken: u32 = self.confusion.iter().map(|r| r[k]).sum();
            2.0 * f64::from(self.confusion[k][k]) / f64::from(self.labelled(k) + taken).max(1.0)
        };
        classes.iter().map(f1).sum::<f64>() / classes.len().max(1) as f64
    }
}

/// Returns the table of rules, with the value of each; the table was measured from the drawings of `sketches`.
///
/// # Errors
/// A sentence that names the file and its fault.
pub(crate) fn block(rows: &[StrokeRow], sketches: &Path, fixtures: &Path) -> Result<String, String> {
    let labelled = labelled(rows, sketches)?;
    let fixtures: Vec<Sheet<'_>> = fixtures_of(fixtures)?.into_iter().map(shipped).collect();
    let made = made_sketches().into_iter().map(|made| {
        let lines: Vec<_> = made.lines.into_iter().map(|l| l.0).collect();
        Drawing::from_polylines(made.kind, &lines)
    });
    let mut others = Vec::new();
    for folder in ["quickdraw", "quickdraw_more", "trees_by_hand", "spg"] {
        others.extend(drawings_of(&sketches.join(folder))?.into_values());
    }
    let others: Vec<Sheet<'_>> = others.into_iter().chain(made).map(shipped).collect();

    let chosen = Chosen::collect(sketches)?;
    let [right, acceptable] = chosen.judged(&[]);

    let all = Score::measure(&labelled, &[]);
    let (end, rest): (Vec<Sheet<'_>>, Vec<Sheet<'_>>) = labelled.into_iter().partition(Sheet::is_of_the_end);
    let last = Score::measure(&end, &[]);
    let labelled: Vec<Sheet<'_>> = end.into_iter().chain(rest).collect();
    let strokes = labelled.iter().flat_map(|s| &s.rows);
    let count =
        |source, clear| strokes.clone().filter(|r| r.source == source && r.is_clear() == clear).count();
    let mut out = format!(
        "Measured with classifiers that have not seen the drawing, and with all rules, over {DEALINGS} random splits. \
         Correct: {} of\n{} clear strokes of the public, {} of {} doubtful ones (the labeller was unsure, or they are \
         two things at once),\nand {} of {} parts labelled by others. The macro F1 is {:.4}.\n\n\
         Of drawings that the model of kinds has not seen either (those for the end): {} of {} clear strokes; the macro \
         F1 of\nthe same classes is {:.4}.\n\n\
         Of {} whole drawings to choose by (below), {right} are right and {acceptable} acceptable.\n\n\
         The table shows how these figures change without each rule, and how many of {} fixtures and {} other drawings \
         are\nthen read differently.\n\n\
         | rule | why | clear | doubtful | parts | macro F1 | right | acceptable | fixtures | others |\n\
         |---|---|---|---|---|---|---|---|---|---|\n",
        all.right(),
        count(StrokeSource::Public, true),
        all.doubtful,
        count(StrokeSource::Public, false),
        all.parts,
        count(StrokeSource::Parts, true),
        all.macro_f1(),
        last.right(),
        (0..StrokeClass::ALL.len()).map(|k| last.labelled(k)).sum::<u32>(),
        last.mean_f1(&all.counted()),
        chosen.count(),
        fixtures.len(),
        others.len(),
    );
    let with_all = |sheets: &[Sheet<'_>]| sheets.iter().map(|s| s.read(&[])).collect::<Vec<_>>();
    let (fixtures_read, others_read) = (with_all(&fixtures), with_all(&others));
    for rule in RULES {
        let off = [rule.name];
        let score = Score::measure(&labelled, &off);
        let now = chosen.judged(&off);
        let change = |now: usize, before: usize| now.cast_signed() - before.cast_signed();
        let changed = |sheets: &[Sheet<'_>], before: &[Reading]| {
            sheets.iter().zip(before).filter(|(s, before)| differs(&s.read(&off), before)).count()
        };
        let _ = writeln!(
            out,
            "| `{}` | {} | {:+} | {:+} | {:+} | {:+.4} | {:+} | {:+} | {} | {} |",
            rule.name,
            rule.why,
            i64::from(score.right()) - i64::from(all.right()),
            i64::from(score.doubtful) - i64::from(all.doubtful),
            i64::from(score.parts) - i64::from(all.parts),
            score.macro_f1() - all.macro_f1(),
            change(now[0], right),
            change(now[1], acceptable),
            changed(&fixtures, &fixtures_read),
            changed(&others, &others_read),
        );
    }
    Ok(out)
}

impl Score {
    fn measure(sheets: &[Sheet<'_>], off: &[&str]) -> Self {
        let mut score = Self::default();
        for sheet in sheets {
            score.add(sheet, &sheet.read(off));
        }
        score
    }
}

/// Whether another plant would grow. The source of a class does not matter.
fn differs(a: &Reading, b: &Reading) -> bool {
    let plain = |r: &Reading| Reading { strokes: Vec::new(), ..r.clone() };
    let same = a.strokes.iter().zip(&b.strokes).all(|(a, b)| (a.class, a.organ) == (b.class, b.organ));
    !same || plain(a) != plain(b)
}

/// Returns a drawing with the classes of the model that programs carry.
fn shipped<'a>(drawing: Drawing) -> Sheet<'a> {
    let ink = ink::clean(&drawing, &mut Report::default());
    let classes = ink::classify(&ink, &Run::plain());
    Sheet { ink, classes, rows: Vec::new() }
}

/// Returns the labelled drawings once for each dealing, with classes of a classifier that has not seen them.
fn labelled<'a>(rows: &'a [StrokeRow], sketches: &Path) -> Result<Vec<Sheet<'a>>, String> {
    let mut drawings = drawings_of(&sketches.join("quickdraw"))?;
    drawings.extend(drawings_of(&sketches.join("spg"))?);
    let mut by_drawing: BTreeMap<&str, Vec<&StrokeRow>> = BTreeMap::new();
    for row in rows.iter().filter(|r| r.source != StrokeSource::Made) {
        by_drawing.entry(&row.drawing).or_default().push(row);
    }
    let mut dealings = Vec::new();
    for seed in 0..DEALINGS {
        dealings.push(held_out_strokes(rows, base::Seed::new(seed)).map_err(|e| e.to_string())?);
    }
    let mut sheets = Vec::new();
    for (key, rows) in by_drawing {
        let drawing = drawings.get(key).ok_or_else(|| format!("there is no drawing {key}"))?;
        let ink = ink::clean(drawing, &mut Report::default());
        for folds in &dealings {
            let fold = folds.iter().find(|f: &&HeldOut| f.drawings.contains(key));
            let fold = fold.ok_or_else(|| format!("drawing {key} is in no fold"))?;
            let classes = fold.classify(&ink, &Run::plain());
            sheets.push(Sheet { ink: ink.clone(), classes, rows: rows.clone() });
        }
    }
    Ok(sheets)
}

/// Returns the repository's own drawings.
pub(crate) fn fixtures_of(folder: &Path) -> Result<Vec<Drawing>, String> {
    let mut files = vec![folder.join("sample.svg")];
    for part in ["gallery", "table1"] {
        let folder = folder.join(part);
        let entries = std::fs::read_dir(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
        files.extend(
            entries.flatten().map(|f| f.path()).filter(|p| p.extension().is_some_and(|e| e == "svg")),
        );
    }
    files.sort();
    let mut drawings = Vec::new();
    for file in files {
        let fault = |e: &dyn core::fmt::Display| format!("{}: {e}", file.display());
        let bytes = std::fs::read(&file).map_err(|e| fault(&e))?;
        for item in formats::read_drawings(bytes.as_slice(), DrawingFormat::Svg, "fixture") {
            drawings.push(item.map_err(|e| fault(&e))?.drawing);
        }
    }
    Ok(drawings)
}
