//! What the strokes of a drawing mean (He and Cheng 2021, section 4), still flat.
//!
//! `Ink + classes -> Reading`
//!
//! | module | reads | paper |
//! |---|---|---|
//! | `several` | each plant of a drawing by itself | beyond |
//! | `read`, `draft` | the order of the steps, and the drawing half understood | |
//! | `rules` | classes that the whole drawing contradicts | beyond |
//! | `outlines`, `contour`, `rings`, `body` | trunks, cactus bodies and crowns drawn as outlines | beyond |
//! | `blade`, `corolla`, `veins` | outlines, roots, tips and midribs of leaves and petals | 4.1, 4.3 |
//! | `flowers` | which blades are petals of one flower | 4.1 |
//! | `branches` | the hierarchy of axes | 4.2 |
//! | `overlap` | which of the blades that overlap lies in front | beyond |
//! | `palette` | what colours say | beyond |
//! | `steady`, `pressed` | lines without tremor, and how boldly they were drawn | beyond |
//! | `attach` | what bears what | beyond |
//! | `several`, `aside` | several plants in one drawing, and what is drawn beside them | beyond |
//! | `kind`, `built`, `kinds` | what the parts are together, and which kind explains the drawing best | beyond |
//! | [`glance`](mod@glance) | what a drawing looks like, whatever its strokes are | beyond |
//! | `structure` | what strokes enclose, what covers them, what lies in them, what is repeated | beyond |
//! | `inertia` | what was shown keeps its class, unless the whole clearly says otherwise | beyond |
//! | `kept` | what single strokes gave, kept while they stay as they are | |
//! | `rows`, `validate` | the result, and what every reading guarantees | |
//! | `thresholds` | numbers that several of these compare with, and where all such numbers come from | |

mod aside;
mod attach;
mod bare;
mod blade;
mod body;
mod branches;
mod built;
mod coherence;
mod confidence;
mod contour;
mod corolla;
mod draft;
mod flowers;
pub mod glance;
mod grid;
mod inertia;
mod kept;
mod kind;
mod kinds;
mod look;
mod near;
mod no_plant;
mod outlines;
mod overlap;
mod palette;
mod pressed;
mod profile;
mod raster;
mod read;
mod rings;
mod rows;
mod rules;
mod sealed;
mod several;
mod silhouette;
mod steady;
mod structure;
mod tangle;
#[cfg(test)]
mod tests;
mod thresholds;
mod validate;
mod veins;

pub use aside::BESIDE_THE_PLANT;
pub use confidence::{CONFIDENCE_LIMITS, ConfidenceLimits, EVIDENCE_NAMES, Evidence};
pub use inertia::AS_SHOWN;
pub use kept::KeptStrokes;
pub use kind::{Kind, Scored};
pub use kinds::{KIND_FEATURE_LIMIT, SEVERAL, kind_feature_names, kind_features};
pub use no_plant::{NO_PLANT_LIMITS, NoPlantLimits, no_plant_feature_names};
pub use read::{
    UNLIKE_A_PLANT, kind_row, no_plant_row, read, read_again, read_as, read_but_last, read_without,
};
pub use rows::{
    Attachment, AxisReading, BladeReading, DiscReading, FlowerReading, FruitReading, OrganWord, PlantReading,
    PotReading, Reading, RegionKind, RegionReading, StrokeReading, VeinReading,
};
pub use rules::{READ_AS, RULES, Rule};
pub use structure::ARRANGEMENT;
pub use tangle::{TANGLE_LIMITS, TangleLimits, tangled_length};
pub use validate::ReadingFault;
