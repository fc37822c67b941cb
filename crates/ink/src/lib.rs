//! What the pen drew, and what each stroke is (He and Cheng 2021, sections 3 and 4.1).
//!
//! `Drawing -> Ink (clean strokes) -> classes`
//!
//! | step | module | paper |
//! |---|---|---|
//! | strokes as they were drawn | `drawing` | |
//! | what drawing programs paint, as plain strokes | `normal` | |
//! | turned, pulled, smoothed, cut, joined, rubbed out in part | `edit` | |
//! | resample, smooth, normalise | `clean` | section 3, Eq 1 |
//! | which strokes are of one plant | `subjects` | |
//! | what a stroke can be, and what each one is | `class`, `classify` | section 4.1 |
//!
//! The feature `training` adds what trains the classifier; programs that make plants do without it.

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
pub use normal::{Change, Figure, Fill, Normal, normalise};
pub use subjects::Subjects;
