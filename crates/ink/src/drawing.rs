//! What the pen left on the sheet.

use glam::DVec2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// In which mode a stroke was drawn (He and Cheng 2021, section 4.1).
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "kebab-case")]
pub enum StrokeMode {
    /// A part of the plant: what it is, is found out.
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
    /// Any unit, y up. May be anything the file said, even NaN: cleaning deals with it.
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
    /// The pen's way.
    pub samples: Vec<InkSample>,
    /// The mode that it was drawn in.
    pub mode: StrokeMode,
    /// Its colour as sRGB, if the file has one.
    pub color: Option<[u8; 3]>,
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
}

impl Drawing {
    /// A drawing in `parts` mode from bare polylines, y up.
    pub fn from_polylines(name: impl Into<String>, lines: &[Vec<DVec2>]) -> Self {
        let strokes = lines
            .iter()
            .map(|line| Stroke { samples: line.iter().map(|&p| p.into()).collect(), ..Stroke::default() })
            .collect();
        Self { name: name.into(), strokes }
    }
}
