//! Strokes as the pen left them on the sheet.

use std::sync::Arc;

use glam::DVec2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Mode in which a stroke was drawn (He and Cheng 2021, section 4.1).
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "kebab-case")]
pub enum StrokeMode {
    /// A part of the plant: the stroke is classified.
    #[default]
    Parts,
    /// A contour to be filled with twigs.
    BranchContour,
    /// A contour to be filled with leaves.
    LeafContour,
}

/// One point of a stroke.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InkSample {
    /// Position in any unit, y up. May be any number in the file, even NaN: cleaning deals with it.
    pub at: DVec2,
    /// Milliseconds since the stroke or the drawing began, if known.
    pub time_ms: Option<f64>,
    /// Pen pressure 0 to 1, if known.
    pub pressure: Option<f64>,
}

impl From<DVec2> for InkSample {
    fn from(at: DVec2) -> Self {
        Self { at, time_ms: None, pressure: None }
    }
}

/// One movement of the pen on the sheet.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stroke {
    /// Samples along the pen's path.
    pub samples: Vec<InkSample>,
    /// The mode in which it was drawn.
    pub mode: StrokeMode,
    /// Its colour as sRGB, if the file has one.
    pub color: Option<[u8; 3]>,
    /// Width of the pen, in the drawing's unit, above 0; `None` for the default pen of the sheet. It affects only how
    /// the line looks: how thick wood is follows from what it bears.
    pub width: Option<f64>,
    /// The name of its layer in [`Drawing::layers`]; `None` for the sheet itself, which lies below all layers.
    pub layer: Option<Arc<str>>,
    /// Whether its layer is hidden, so that it is not part of the plant.
    pub hidden: bool,
    /// Its name in the file (an SVG id), for messages.
    pub id: Option<String>,
}

/// A whole drawing, strokes in the order in which they were drawn.
///
/// ```
/// use glam::DVec2;
/// let d = ink::Drawing::from_polylines("stem", &[vec![DVec2::ZERO, DVec2::Y]]);
/// assert_eq!(d.strokes.len(), 1);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drawing {
    /// Name for reports and files.
    pub name: String,
    /// The strokes.
    pub strokes: Vec<Stroke>,
    /// The layers from below upwards, each with a name of its own.
    pub layers: Vec<Layer>,
}

/// A layer of a drawing.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Layer {
    /// Its name, unique in the drawing, 1 to 200 characters.
    pub name: Arc<str>,
    /// Whether its strokes are invisible and not part of the plant. Default false.
    #[serde(default)]
    pub hidden: bool,
    /// Whether its strokes are protected from changes. Default false.
    #[serde(default)]
    pub locked: bool,
}

impl Drawing {
    /// Makes a drawing in `parts` mode from bare polylines, y up.
    pub fn from_polylines(name: impl Into<String>, lines: &[Vec<DVec2>]) -> Self {
        let strokes = lines
            .iter()
            .map(|line| Stroke { samples: line.iter().map(|&p| p.into()).collect(), ..Stroke::default() })
            .collect();
        Self { name: name.into(), strokes, layers: Vec::new() }
    }
}
