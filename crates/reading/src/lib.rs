//! Reads the meaning of a drawing's strokes (He and Cheng 2021, section 4), still flat.
//!
//! `Ink + classes -> Reading`
//!
//! | module | reads | paper |
//! |---|---|---|
//! | `several` | each plant of a drawing separately | beyond |
//! | `read`, `draft` | the order of the steps, and the partly understood drawing | |
//! | `rules` | classes that the whole drawing contradicts | beyond |
//! | `outlines`, `contour`, `rings`, `body` | trunks, cactus bodies and crowns drawn as outlines | beyond |
//! | `blade`, `corolla`, `veins` | outlines, roots, tips and midribs of leaves and petals | 4.1, 4.3 |
//! | `flowers` | which blades are petals of one flower | 4.1 |
//! | `branches` | the hierarchy of axes | 4.2 |
//! | `overlap` | which of overlapping blades lies in front | beyond |
//! | `palette` | the meaning of colours | beyond |
//! | `steady`, `pressed` | lines without tremor, and how boldly they were drawn | beyond |
//! | `attach` | the bearer of each part | beyond |
//! | `several`, `aside` | several plants in one drawing, and things drawn next to them | beyond |
//! | `kind`, `built`, `kinds` | the kind that the parts form together, and the kind that explains the drawing best |
//! beyond |
//! | [`glance`](mod@glance) | how a drawing looks, whatever its strokes are | beyond |
//! | `structure` | enclosure, cover, containment and repetition of strokes | beyond |
//! | `inertia` | strokes keep the class that was shown, unless the whole clearly contradicts it | beyond |
//! | `kept` | results of single strokes, kept while these do not change | |
//! | `rows`, `validate` | the result, and the guarantees of every reading | |
//! | `thresholds` | numbers that several of these compare with, and the origin of all such numbers | |

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
pub use palette::is_in_blue_pen;
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
