//! From a drawing to all its results.

use base::LiteMap;

use base::{Cancelled, OverBudget, Stopped};
use document::{DocumentPlant, Photo, PlantEdit};
use ink::StrokeClass;
use makers::LeafTemplate;
use sketch::SketchSpec;
use skin::{SkinSpec, Worn};

/// Classes that the user set, by stroke index in the drawing.
pub type ClassOverrides = LiteMap<u32, StrokeClass>;

/// Options of a sketch, saved with the document.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SketchOptions {
    /// Settings for reading the drawing and giving it depth.
    pub spec: SketchSpec,
    /// Settings for meshing the plant.
    pub skin: SkinSpec,
    /// Classes that the user set.
    pub classes: ClassOverrides,
    /// Classes that strokes were shown as while the drawing grew, by stroke index: not given up without clear evidence.
    /// Empty for a drawing without such a history.
    pub shown: LiteMap<u32, StrokeClass>,
    /// A photograph under the drawing, whose colours traced organs take.
    pub photo: Option<Photo>,
    /// The leaf that the plant bears instead of the drawn or built-in ones.
    pub leaf: Option<LeafTemplate>,
    /// Hand edits, applied to the plant in this order.
    pub edits: Vec<PlantEdit>,
}

impl SketchOptions {
    /// Returns the options of a sketch of a document; colours follow its seed as everything else does. The defaults for
    /// a plant of another maker. A leaf that it bears is not included: [`crate::SceneEvaluator`] finds it.
    pub fn from_plant(plant: &DocumentPlant) -> Self {
        let settings = plant.settings();
        let Some(sketch) = settings.sketch() else { return Self::default() };
        Self {
            spec: sketch.sketch.clone(),
            skin: SkinSpec { seed: settings.seed, worn: worn(plant), ..sketch.skin.clone() },
            classes: plant.classes(),
            shown: plant.shown(),
            photo: sketch.photo.clone(),
            leaf: None,
            edits: settings.edits.clone(),
        }
    }
}

/// Returns the materials that the organs of a plant of a document wear, with the pixels of their pictures. A picture
/// that does not decode is left out, and its organs are plain.
pub fn worn(plant: &DocumentPlant) -> Worn {
    let pictures = &plant.settings().pictures;
    plant.wear().worn(|name| pictures.get(name)?.texture(formats::read_picture))
}

/// Reason why nothing was made.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum MakeError {
    /// The drawing has no stroke that could be used.
    #[error(
        "drawing \"{name}\" has no usable stroke ({strokes} in the file): draw at least one line of two points"
    )]
    NoStrokes {
        /// Name of the drawing.
        name: String,
        /// Number of strokes in the file.
        strokes: usize,
    },
    /// A class was set for a stroke that does not exist.
    #[error(
        "a class is set for stroke {index}, but drawing \"{name}\" has {strokes} strokes (numbered from 0)"
    )]
    NoSuchStroke {
        /// Name of the drawing.
        name: String,
        /// The index given.
        index: u32,
        /// Number of strokes in the drawing.
        strokes: usize,
    },
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The result would exceed the budget.
    #[error(transparent)]
    OverBudget(#[from] OverBudget),
}

impl From<Stopped> for MakeError {
    fn from(stopped: Stopped) -> Self {
        match stopped {
            Stopped::Cancelled(c) => Self::Cancelled(c),
            Stopped::OverBudget(o) => Self::OverBudget(o),
        }
    }
}

base::coded!(MakeError {
    Self::NoStrokes { name, .. } => "no-strokes" { name },
    Self::NoSuchStroke { index, .. } => "class-without-stroke" { index },
} wraps {
    Self::Cancelled(e) => e, Cancelled;
    Self::OverBudget(e) => e, OverBudget;
});
