//! Hand-drawn strokes to a plant (He and Cheng 2021, "paper 000").
//!
//! `Drawing -> Ink (clean strokes) -> classes -> Reading (what was meant) -> Plant`
//!
//! | step | module | paper |
//! |---|---|---|
//! | resample, smooth, normalise | `clean` | section 3, Eq 1 |
//! | stroke classes | `classify` | section 4.1 |
//! | flowers, leaves, branch hierarchy | `structure` | sections 4.1, 4.2 |
//! | fill contours | `fill` | section 4.3, Eq 2 |
//! | depth | `depth` | section 5, Eq 3, 4 |
//! | radii, plant | `build` | section 6, Eq 5 to 7 |

mod build;
mod classify;
mod clean;
mod depth;
mod drawing;
mod fidelity;
mod fill;
mod front;
mod map;
mod reading;
mod spec;
mod structure;
mod template;

pub use build::{Built, build, build_again};
pub use classify::{
    Classified, KeptMeasures, ModelError, StrokeFeatures, StrokeFigures, StrokeModelTexts, StrokeRow,
    StrokeSource, classify, classify_again, cross_validate_strokes, features, read_stroke_table,
    train_strokes, write_stroke_table,
};
pub use clean::{Ink, InkMap, InkStroke, clean};
pub use drawing::{Drawing, InkSample, Stroke, StrokeMode};
pub use fidelity::{Fidelity, StrokeFidelity, fidelity};
pub use fill::KeptBodies;
pub use map::PlantMap;
pub use reading::{
    Attachment, AxisReading, BladeReading, DiscReading, FlowerReading, FruitReading, OrganWord, Reading,
    RegionKind, RegionReading, StrokeClass, StrokeReading,
};
pub use spec::{BranchDepth, FillSpec, LeafDepth, ReliefSpec, SketchSpec, SpecFault, TaperSpec};
pub use structure::{ReadingFault, read};
pub use template::LeafForm;
