//! The trained models and what they say of one stroke.

use super::features::StrokeFeatures;
use super::packed::unpack;
use super::svm::{ModelError, Scale, Svm};
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
    pub(super) scale: Scale,
    pub(super) classes: Svm,
}

impl StrokeModels {
    /// Reads the models as programs carry them.
    ///
    /// # Errors
    /// [`ModelError`] where they are no models of today's features.
    pub(super) fn unpack(scale: &str, classes: &[u8]) -> Result<Self, ModelError> {
        Ok(Self {
            scale: Scale::parse(scale, &StrokeFeatures::NAMES)?,
            classes: unpack(classes, StrokeFeatures::NAMES.len())?,
        })
    }

    /// The class of a stroke: the one with the largest share, the first of equals.
    pub(super) fn decide(&self, f: &StrokeFeatures) -> Classified {
        let shares = self.classes.shares(&self.scale.apply(&f.values()));
        let mut best = Classified { class: StrokeClass::Other, confidence: 0.0 };
        for (&label, share) in self.classes.labels.iter().zip(shares) {
            let class = usize::try_from(label).ok().and_then(|k| StrokeClass::ALL.get(k));
            if let Some(&class) = class.filter(|_| share > best.confidence) {
                best = Classified { class, confidence: share };
            }
        }
        best
    }
}
