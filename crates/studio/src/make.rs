//! From a drawing to everything that is made of it.

use base::LiteMap;

use base::{Cancelled, OverBudget, Stopped};
use document::{DocumentPlant, Photo, PlantEdit};
use ink::StrokeClass;
use sketch::SketchSpec;
use skin::{SkinSpec, Worn};

use crate::template::LeafTemplate;

/// Classes that the user set, by stroke index in the drawing.
pub type ClassOverrides = LiteMap<u32, StrokeClass>;

/// What is asked of a sketch: saved with the document.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SketchOptions {
    /// How the drawing is understood and given depth.
    pub spec: SketchSpec,
    /// How the plant is meshed.
    pub skin: SkinSpec,
    /// Classes that the user set.
    pub classes: ClassOverrides,
    /// What strokes were shown as while the drawing grew, by stroke index: not given up without clear evidence. Empty for
    /// a drawing without such a history.
    pub shown: LiteMap<u32, StrokeClass>,
    /// A photograph under the drawing, whose colours traced organs take.
    pub photo: Option<Photo>,
    /// The leaf that the plant bears instead of the drawn or built-in ones.
    pub leaf: Option<LeafTemplate>,
    /// Edits by hand, done on the plant in this order.
    pub edits: Vec<PlantEdit>,
}

impl SketchOptions {
    /// What a sketch of a document asks for; colours follow its seed as everything else does. The defaults for a
    /// plant of another maker. A leaf that it bears is not among them: [`crate::SceneEvaluator`] finds it.
    pub fn of_plant(plant: &DocumentPlant) -> Self {
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

/// The materials that the organs of a plant of a document wear, with the pixels of their pictures. A picture that does not
/// decode is left out: what wears it is plain.
pub fn worn(plant: &DocumentPlant) -> Worn {
    let pictures = &plant.settings().pictures;
    plant.wear().worn(|name| pictures.get(name)?.texture(formats::read_picture))
}

/// Why nothing was made.
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
        /// Strokes that the file holds.
        strokes: usize,
    },
    /// A class was set for a stroke that is not there.
    #[error(
        "a class is set for stroke {index}, but drawing \"{name}\" has {strokes} strokes (numbered from 0)"
    )]
    NoSuchStroke {
        /// Name of the drawing.
        name: String,
        /// The index given.
        index: u32,
        /// Strokes that the drawing holds.
        strokes: usize,
    },
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// It would have been too much.
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
