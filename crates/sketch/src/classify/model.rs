//! The trained models and what they say of one stroke.

use super::features::StrokeFeatures;
use super::svm::{ModelError, Scale, Svm};
use super::training::{StrokeModelTexts, closed};
use crate::StrokeClass;

/// What a stroke was found to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Classified {
    /// The class.
    pub class: StrokeClass,
    /// The class's share among all classes, 0 to 1: see `docs/strokes.md` for how often a share is right.
    pub confidence: f64,
}

/// The models, ready to decide.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct StrokeModels {
    scale: Scale,
    classes: Svm,
    closed: Svm,
}

impl StrokeModels {
    /// Reads the models.
    ///
    /// # Errors
    /// [`ModelError`] where a text is not a model of today's features.
    pub(super) fn parse(texts: &StrokeModelTexts) -> Result<Self, ModelError> {
        Ok(Self {
            scale: Scale::parse(&texts.scale, &StrokeFeatures::NAMES)?,
            classes: Svm::parse(&texts.classes, StrokeFeatures::NAMES.len())?,
            closed: Svm::parse(&texts.closed, 3)?,
        })
    }

    /// The paper's three features (section 4.1), each in \[0, 1\].
    pub(super) fn three(f: &StrokeFeatures) -> [f64; 3] {
        [f.gap, f.slim, f.box_area]
    }

    /// Closed outline rather than line, by the three features alone.
    pub(super) fn is_closed(&self, f: &StrokeFeatures) -> bool {
        let shares = self.closed.shares(&Self::three(f));
        self.closed.labels.iter().zip(shares).any(|(&l, s)| l == 1 && s > 0.5)
    }

    /// The class of a stroke.
    ///
    /// The three features have the last word on closed or line: a class of the other group is left out.
    pub(super) fn decide(&self, f: &StrokeFeatures) -> Classified {
        let side = self.is_closed(f);
        let shares = self.classes.shares(&self.scale.apply(&f.values()));
        let mut best = Classified { class: StrokeClass::Other, confidence: 0.0 };
        for (&label, share) in self.classes.labels.iter().zip(shares) {
            let class = usize::try_from(label).ok().and_then(|k| StrokeClass::ALL.get(k));
            let Some(&class) = class.filter(|c| closed(**c) != Some(!side)) else { continue };
            if share > best.confidence {
                best = Classified { class, confidence: share };
            }
        }
        best
    }
}
