//! The trained models and their classification of one stroke.

use core::fmt;

use super::features::StrokeFeatures;
use super::packed::unpack;
use super::svm::{Scale, Svm, SvmError};
use crate::StrokeClass;

/// Source of a stroke's class.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Source {
    /// The user set it.
    User,
    /// The trained classifier.
    #[default]
    Classifier,
    /// A rule, by its name: the other strokes contradict the classifier.
    Rule(&'static str),
}

impl fmt::Display for Source {
    /// Writes `user`, `classifier` or `rule:NAME`: the words of reports.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::User => f.write_str("user"),
            Self::Classifier => f.write_str("classifier"),
            Self::Rule(name) => write!(f, "rule:{name}"),
        }
    }
}

/// Result of classifying a stroke.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Classified {
    /// The class.
    pub class: StrokeClass,
    /// Confidence in that class, 0 to 1: its share among all classes, or 1 where no rule of reading may change it. See
    /// `docs/strokes.md` for how often a share is right.
    pub confidence: f64,
    /// What decided the class.
    pub source: Source,
    /// The classifier's share of every class, in the order of [`StrokeClass::ALL`]; zeros where it was not run.
    pub shares: [f64; StrokeClass::ALL.len()],
    /// The class that a person was shown while the drawing grew: reading departs from it only for clear evidence.
    pub shown: Option<StrokeClass>,
}

impl Classified {
    /// Makes a class that the user set, with full confidence.
    ///
    /// ```
    /// use ink::{Classified, Source, StrokeClass};
    /// let stem = Classified::by_user(StrokeClass::Axis);
    /// assert_eq!((stem.confidence, stem.source), (1.0, Source::User));
    /// assert_eq!(Source::Rule("lone-line").to_string(), "rule:lone-line");
    /// ```
    pub fn by_user(class: StrokeClass) -> Self {
        Self { class, confidence: 1.0, source: Source::User, ..Self::default() }
    }

    /// Whether no rule of reading may change it.
    pub fn is_sure(&self) -> bool {
        self.confidence >= 1.0
    }

    /// Returns the class with the largest share, the first of equals.
    pub fn by_shares(shares: [f64; StrokeClass::ALL.len()]) -> Self {
        let mut best = Self { shares, ..Self::default() };
        for (class, share) in StrokeClass::ALL.into_iter().zip(shares) {
            if share > best.confidence {
                (best.class, best.confidence) = (class, share);
            }
        }
        best
    }
}

/// The models, ready to decide.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct StrokeModels {
    pub(super) scale: Scale,
    pub(super) classes: Svm,
}

impl StrokeModels {
    /// Reads the models as programs carry them.
    ///
    /// # Errors
    /// [`SvmError`] where the bytes are not models of today's features.
    pub(super) fn unpack(scale: &str, classes: &[u8]) -> Result<Self, SvmError> {
        Ok(Self {
            scale: Scale::parse(scale, &StrokeFeatures::NAMES)?,
            classes: unpack(classes, StrokeFeatures::NAMES.len())?,
        })
    }

    /// Returns the class of a stroke.
    pub(super) fn decide(&self, f: &StrokeFeatures) -> Classified {
        let found = self.classes.shares(&self.scale.apply(&f.values()));
        let mut shares = [0.0; StrokeClass::ALL.len()];
        for (&label, share) in self.classes.labels.iter().zip(found) {
            if let Some(slot) = usize::try_from(label).ok().and_then(|k| shares.get_mut(k)) {
                *slot = share;
            }
        }
        Classified::by_shares(shares)
    }
}
