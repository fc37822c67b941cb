//! Drawings, and the class of each stroke (He and Cheng 2021, sections 3 and 4.1).
//!
//! `Drawing -> Ink (clean strokes) -> classes`
//!
//! | step | module | paper |
//! |---|---|---|
//! | strokes as drawn | `drawing` | |
//! | shapes of drawing programs, as plain strokes | `normal` | |
//! | strokes turned, pulled, smoothed, cut, joined, partly erased | `edit` | |
//! | resample, smooth, normalise | `clean` | section 3, Eq 1 |
//! | which strokes form one plant | `subjects` | |
//! | the classes, and the class of each stroke | `class`, `classify` | section 4.1 |
//!
//! The feature `training` adds the code that trains the classifier; programs that make plants do without it.

mod again;
mod beds;
mod class;
mod classify;
mod clean;
mod drawing;
mod edit;
mod normal;
mod subjects;

pub use class::StrokeClass;
pub use classify::{
    COMMON_GROUND, Classified, DRAWN_AGAIN, KeptMeasures, LONE_LINE, Source, StrokeFeatures, SvmError,
    classify, classify_again, features,
};
#[cfg(any(test, feature = "training"))]
pub use classify::{
    FEW_CLEAR, HeldOut, StrokeFigures, StrokeModelTexts, StrokeRow, StrokeSource, cross_validate_strokes,
    held_out_strokes, read_stroke_table, train_strokes, write_stroke_table,
};
pub use clean::{Ink, InkMap, InkStroke, clean, clean_again};
pub use drawing::{Drawing, InkSample, Layer, Stroke, StrokeMode};
pub use edit::{StrokePull, StrokeTurn, cut, joined, rubbed, smoothed};
pub use normal::{Change, Figure, Fill, Normal, hue, hues_apart, normalise};
pub use subjects::Subjects;
