//! Training `table -> models` and its quality: cross-validation by drawing, never by stroke.

use std::collections::{BTreeMap, BTreeSet};

use base::{Draw, Run, Seed};

use super::features::StrokeFeatures;
use super::model::StrokeModels;
use super::svm::{Scale, Svm, SvmError};
use super::{Classified, KeptMeasures, judge};
use crate::{Ink, StrokeClass};
use libsvm::RbfLearner;
pub(super) use libsvm::pack;
pub use table::{StrokeRow, StrokeSource, read_stroke_table, write_stroke_table};

mod libsvm;
mod table;

/// Settings for the classes, chosen by cross-validation among 1 to 100.
const CLASSES: RbfLearner = RbfLearner { cost: 10.0, gamma: 0.3 };
/// Settings for closed outline or line, by the three features of He and Cheng (2021), section 4.1.
const CLOSED: RbfLearner = RbfLearner { cost: 10.0, gamma: 3.0 };
/// Number of folds that drawings are dealt into.
const FOLDS: usize = 10;
/// Least clear strokes of a class that counts in the macro F1: with fewer, chance would dominate.
pub const FEW_CLEAR: usize = 20;

/// The models as text, as they are kept in the repository.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StrokeModelTexts {
    /// Name, mean and one over the deviation of every feature.
    pub scale: String,
    /// The classes, LIBSVM text; label numbers are places in [`StrokeClass::ALL`].
    pub classes: String,
}

impl StrokeModelTexts {
    /// Returns the classes as programs carry them: the same machine in a quarter of the bytes.
    ///
    /// # Errors
    /// [`SvmError`] where the text is not a model of today's features.
    pub fn packed_classes(&self) -> Result<Vec<u8>, SvmError> {
        let columns = StrokeFeatures::NAMES.len();
        pack(&Svm::parse(&self.classes, columns)?, columns)
    }
}

impl StrokeModels {
    /// Reads the models.
    ///
    /// # Errors
    /// [`SvmError`] where a text is not a model of today's features.
    pub(super) fn parse(texts: &StrokeModelTexts) -> Result<Self, SvmError> {
        Ok(Self {
            scale: Scale::parse(&texts.scale, &StrokeFeatures::NAMES)?,
            classes: Svm::parse(&texts.classes, StrokeFeatures::NAMES.len())?,
        })
    }
}

/// How well strokes of drawings outside the training set were recognised.
#[derive(Clone, Debug, PartialEq)]
pub struct StrokeFigures {
    /// Rows are labels, columns classes found, both in the order of [`StrokeClass::ALL`].
    pub confusion: [[u32; 12]; 12],
    /// F1 of each class that has at least 20 clear strokes, else `None`.
    pub f1: [Option<f64>; 12],
    /// Mean of the F1 values.
    pub macro_f1: f64,
    /// Share of closed outlines (blade, corolla, crown, disc) and lines (axis, vein) whose class found is in the
    /// same group; any third class counts as wrong.
    pub grouped: f64,
    /// Share of those strokes that were not taken for the other group.
    pub not_swapped: f64,
    /// Share of those strokes that the machine with the three features of He and Cheng (2021) alone classifies
    /// correctly.
    pub three_features: f64,
    /// Kind of drawing, label and class found for every clear stroke of SPG.
    pub parts: Vec<(String, StrokeClass, StrokeClass)>,
}

/// Returns 1 for closed outlines, 0 for lines, `None` for other classes.
fn closed(class: StrokeClass) -> Option<bool> {
    match class {
        StrokeClass::Blade | StrokeClass::Corolla | StrokeClass::Crown | StrokeClass::Disc => Some(true),
        StrokeClass::Axis | StrokeClass::Vein => Some(false),
        _ => None,
    }
}

/// Trains the models of a table.
///
/// Deterministic on one platform; on another one the training's `exp` may round differently and change last
/// digits, not decisions.
///
/// # Errors
/// [`SvmError`] where the table has fewer than two classes.
pub fn train_strokes(rows: &[StrokeRow]) -> Result<StrokeModelTexts, SvmError> {
    train(&rows.iter().collect::<Vec<_>>())
}

fn train(rows: &[&StrokeRow]) -> Result<StrokeModelTexts, SvmError> {
    let clear: Vec<&&StrokeRow> = rows.iter().filter(|r| r.is_clear()).collect();
    let values: Vec<Vec<f64>> = clear.iter().map(|r| r.features.values().to_vec()).collect();
    let scale = Scale::fit(&values);
    let scaled: Vec<Vec<f64>> = values.iter().map(|v| scale.apply(v)).collect();
    let labels: Vec<i32> = clear.iter().map(|r| r.label as i32).collect();
    Ok(StrokeModelTexts {
        scale: scale.to_text(&StrokeFeatures::NAMES),
        classes: CLASSES.learn(&scaled, &labels)?,
    })
}

/// Returns the three features of He and Cheng (2021), section 4.1, each in \[0, 1\].
fn three(row: &StrokeRow) -> Vec<f64> {
    vec![row.features.gap, row.features.slim, row.features.box_area]
}

/// Trains the machine of He and Cheng (2021) itself: closed outline (1) or line (0) by the three features alone. It
/// serves as a baseline.
fn train_three(rows: &[&StrokeRow]) -> Result<Svm, SvmError> {
    let clear = rows.iter().filter(|r| r.is_clear());
    let (values, sides): (Vec<Vec<f64>>, Vec<i32>) =
        clear.filter_map(|r| closed(r.label).map(|c| (three(r), i32::from(c)))).unzip();
    Svm::parse(&CLOSED.learn(&values, &sides)?, 3)
}

/// Deals the drawings into folds, kinds evenly, trains on nine tenths and measures on the rest, ten times.
///
/// `seed` shuffles the dealing. Takes about a second.
///
/// # Errors
/// [`SvmError`] where the table has too few rows.
pub fn cross_validate_strokes(rows: &[StrokeRow], seed: Seed) -> Result<StrokeFigures, SvmError> {
    let mut found = vec![None; rows.len()];
    for (held, training) in folds(rows, seed) {
        let models = StrokeModels::parse(&train(&training)?)?;
        let paper = train_three(&training)?;
        for i in held {
            let row = &rows[i];
            let is_closed =
                paper.labels.iter().zip(paper.shares(&three(row))).any(|(&l, s)| l == 1 && s > 0.5);
            found[i] = Some((models.decide(&row.features).class, is_closed));
        }
    }
    Ok(figures(rows, &found))
}

/// A classifier that was trained without some drawings, for fair figures of results that depend on its classes.
#[derive(Clone, Debug)]
pub struct HeldOut {
    /// Keys of the drawings left out of training.
    pub drawings: BTreeSet<String>,
    models: StrokeModels,
}

impl HeldOut {
    /// Classifies as [`classify`](crate::classify) does, with this classifier.
    pub fn classify(&self, ink: &Ink, run: &Run<'_>) -> Vec<Classified> {
        judge(Some(&self.models), ink, &[], &mut KeptMeasures::default(), run)
    }
}

/// Trains a classifier for each tenth of the drawings, dealt as for [`cross_validate_strokes`].
///
/// # Errors
/// [`SvmError`] where the table has too few rows.
pub fn held_out_strokes(rows: &[StrokeRow], seed: Seed) -> Result<Vec<HeldOut>, SvmError> {
    let fold = |(held, training): (Vec<usize>, Vec<&StrokeRow>)| {
        let drawings = held.into_iter().map(|i| rows[i].drawing.clone()).collect();
        Ok(HeldOut { drawings, models: StrokeModels::parse(&train(&training)?)? })
    };
    folds(rows, seed).map(fold).collect()
}

/// Returns for each fold the numbers of the rows that it holds out, and all the other rows.
fn folds(rows: &[StrokeRow], seed: Seed) -> impl Iterator<Item = (Vec<usize>, Vec<&StrokeRow>)> {
    let fold = deal(rows, seed);
    (0..FOLDS).map(move |k| {
        let held = (0..rows.len()).filter(|&i| fold[i] == k).collect();
        (held, rows.iter().zip(&fold).filter(|(_, f)| **f != k).map(|(r, _)| r).collect())
    })
}

/// Returns the fold of every row: by drawing, kinds dealt evenly.
fn deal(rows: &[StrokeRow], seed: Seed) -> Vec<usize> {
    let mut kinds: BTreeMap<(StrokeSource, &str), Vec<&str>> = BTreeMap::new();
    for row in rows {
        let keys = kinds.entry((row.source, &row.kind)).or_default();
        if !keys.contains(&row.drawing.as_str()) {
            keys.push(&row.drawing);
        }
    }
    let mut stream = seed.stream(Draw::Folds);
    let mut fold_of: BTreeMap<&str, usize> = BTreeMap::new();
    for keys in kinds.values_mut() {
        keys.sort_unstable();
        for k in (1..keys.len()).rev() {
            keys.swap(k, stream.below(k + 1));
        }
        let start = stream.below(FOLDS);
        for (k, key) in keys.iter().enumerate() {
            fold_of.insert(key, (start + k) % FOLDS);
        }
    }
    rows.iter().map(|r| fold_of.get(r.drawing.as_str()).copied().unwrap_or(0)).collect()
}

fn figures(rows: &[StrokeRow], found: &[Option<(StrokeClass, bool)>]) -> StrokeFigures {
    let mut confusion = [[0_u32; 12]; 12];
    let mut parts = Vec::new();
    let (mut pairs, mut same, mut kept, mut three) = (0_u32, 0_u32, 0_u32, 0_u32);
    for (row, found) in rows.iter().zip(found) {
        let Some((class, is_closed)) = found.filter(|_| row.is_clear()) else { continue };
        match row.source {
            StrokeSource::Made => continue,
            StrokeSource::Parts => {
                parts.push((row.kind.clone(), row.label, class));
                continue;
            }
            StrokeSource::Public => {}
        }
        confusion[row.label.place()][class.place()] += 1;
        if let Some(side) = closed(row.label) {
            pairs += 1;
            same += u32::from(closed(class) == Some(side));
            kept += u32::from(closed(class) != Some(!side));
            three += u32::from(is_closed == side);
        }
    }
    let mut f1 = [None; 12];
    for (k, slot) in f1.iter_mut().enumerate() {
        let labelled: u32 = confusion[k].iter().sum();
        let taken: u32 = confusion.iter().map(|r| r[k]).sum();
        if labelled as usize >= FEW_CLEAR {
            *slot = Some(2.0 * f64::from(confusion[k][k]) / f64::from(labelled + taken));
        }
    }
    let counted: Vec<f64> = f1.iter().flatten().copied().collect();
    let of = |n: u32| f64::from(n) / f64::from(pairs.max(1));
    StrokeFigures {
        confusion,
        f1,
        macro_f1: counted.iter().sum::<f64>() / (counted.len().max(1) as f64),
        grouped: of(same),
        not_swapped: of(kept),
        three_features: of(three),
        parts,
    }
}
