//! The table of measured strokes from which the models are trained: text with one row per stroke.

use core::fmt::Write as _;

use crate::StrokeClass;
use crate::classify::features::StrokeFeatures;
use crate::classify::svm::SvmError;

/// Source of a stroke, which decides how it is used.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum StrokeSource {
    /// Drawn by the public in "Quick, Draw!": trained on and counted in the figures.
    Public,
    /// Drawn by the public, parts labelled by others (SPG): trained on a little, with separate figures.
    Parts,
    /// Made by our own programs: trained on only.
    Made,
}

impl StrokeSource {
    const fn word(self) -> &'static str {
        match self {
            Self::Public => "public",
            Self::Parts => "parts",
            Self::Made => "made",
        }
    }
}

/// One stroke of the table.
#[derive(Clone, Debug, PartialEq)]
pub struct StrokeRow {
    /// Its source.
    pub source: StrokeSource,
    /// Subject of the drawing; used to spread kinds over the folds, never to classify.
    pub kind: String,
    /// The drawing's key.
    pub drawing: String,
    /// The stroke's number in the drawing.
    pub stroke: u32,
    /// Its class according to the labeller.
    pub label: StrokeClass,
    /// Whether the labeller was unsure.
    pub unsure: bool,
    /// Whether it is several things at once.
    pub mixed: bool,
    /// Its measured features.
    pub features: StrokeFeatures,
}

impl StrokeRow {
    /// Whether it is neither unsure nor mixed: trained on and counted.
    pub fn is_clear(&self) -> bool {
        !self.unsure && !self.mixed
    }
}

const HEAD: &str = "source,kind,drawing,stroke,label,flags";

/// Writes a table: a header line, then one line per stroke, five digits after the point.
pub fn write_stroke_table(rows: &[StrokeRow]) -> String {
    let mut text = format!("{HEAD},{}\n", StrokeFeatures::NAMES.join(","));
    for row in rows {
        let flags = match (row.unsure, row.mixed) {
            (true, true) => "unsure mixed",
            (true, false) => "unsure",
            (false, true) => "mixed",
            (false, false) => "",
        };
        // Writing to a String cannot fail.
        let _ = write!(
            text,
            "{},{},{},{},{},{flags}",
            row.source.word(),
            row.kind,
            row.drawing,
            row.stroke,
            row.label.word()
        );
        for value in row.features.values() {
            let digits = format!("{value:.5}");
            let short = digits.trim_end_matches('0').trim_end_matches('.');
            let _ = write!(text, ",{}", if short == "-0" { "0" } else { short });
        }
        text.push('\n');
    }
    text
}

/// Reads a table.
///
/// # Errors
/// [`SvmError`] with the faulty line; also where the features are not those measured now.
pub fn read_stroke_table(text: &str) -> Result<Vec<StrokeRow>, SvmError> {
    let fault = |line: usize, what: &str| SvmError { line, what: what.to_owned() };
    let mut lines = text.lines().enumerate();
    let want = format!("{HEAD},{}", StrokeFeatures::NAMES.join(","));
    if lines.next().is_none_or(|(_, head)| head != want) {
        return Err(fault(
            1,
            "the columns have changed: run `cargo xtask train-strokes --measure <sketches>`",
        ));
    }
    lines
        .map(|(k, content)| {
            let line = k + 1;
            let cells: Vec<&str> = content.split(',').collect();
            let [source, kind, drawing, stroke, label, flags, numbers @ ..] = &cells[..] else {
                return Err(fault(line, "too few cells"));
            };
            let source = [StrokeSource::Public, StrokeSource::Parts, StrokeSource::Made]
                .into_iter()
                .find(|s| s.word() == *source)
                .ok_or_else(|| fault(line, "unknown source"))?;
            let numbers: Vec<f64> = numbers
                .iter()
                .map(|n| n.parse().ok().filter(|x: &f64| x.is_finite()))
                .collect::<Option<_>>()
                .ok_or_else(|| fault(line, "a feature is not a number"))?;
            Ok(StrokeRow {
                source,
                kind: (*kind).to_owned(),
                drawing: (*drawing).to_owned(),
                stroke: stroke.parse().map_err(|_e| fault(line, "the stroke is not a number"))?,
                label: StrokeClass::from_word(label).ok_or_else(|| fault(line, "unknown label"))?,
                unsure: flags.contains("unsure"),
                mixed: flags.contains("mixed"),
                features: numbers
                    .try_into()
                    .map(StrokeFeatures::from_values)
                    .map_err(|_e| fault(line, "too few or too many features"))?,
            })
        })
        .collect()
}
