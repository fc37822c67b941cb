//! Flowers that open: organs from scans, growth laws fitted to stages, deformation over time.
//!
//! `stages -> organs -> regions -> GrowthLaw -> Lattice -> any day`
//!
//! After Huai, Yang and Cai (2019): control points of a lattice around an organ move along a logistic
//! law that was fitted to scans of other days.
//!
//! | module | owns |
//! |---|---|
//! | `obb` | [`Obb`]: the box of an organ |
//! | `lattice` | [`Lattice`], [`Weights`]: Bernstein free-form deformation |
//! | `logistic` | [`fit_logistic`]: K, p0, r with their errors |
//! | `forms` | [`fit_shared`]: one curve for several series |
//! | `left_out` | residuals of an organ on a day, predicted without it |
//! | `choice` | [`choose`]: one law for several series, if they determine one |
//! | `tails` | tails of the distribution of F |
//! | `clean` | [`clean`]: removal of stray points and the ground |
//! | `segment` | [`organs`]: stem and leaves, and regions along them |
//! | `ways`, `reeb` | ways along the surface from the foot; bands of equal way, and which branches are leaves |
//! | `blades` | [`blades`]: one leaf, or several |
//! | `limb` | [`stem`], [`stalk`]: lines with radii of stems and stalks |
//! | `law` | [`GrowthLaw`]: fitted, saved, applied to another species |
//! | `pose` | [`settle`]: motion of plant and organs apart from growth |
//! | `odd` | [`odd_stages`]: scans that are mirrored, lie down, or have another scale |
//! | `trial` | [`leave_one_out`]: the model against its rivals |
//! | `coloured` | [`OrganPoints`]: points of a day with their colours |
//! | `motion` | [`Motion`]: the shape at any day |
//! | `groups` | [`fit_groups`]: curves of groups of plants, and the test of whether one would do |
//! | `wanted`, `parts` | [`FlowerSpec`], [`Stamens`], [`Disc`], [`Fruit`], [`Achenes`], [`Cluster`], [`Foliage`]:
//! settings of a flower |
//! | `flower`, `species` | whole flowers that open and wilt, day -> `Plant` |
//! | `whorl`, `petal` | [`Whorl`]: rings of petals, nested within one another |
//! | `centre` | stamens, pistil, disc and fruit on a day |
//! | `cluster`, `foliage`, `organs` | positions of flowers and leaves; petals on the ground |
//! | `overlap` | [`part_overlap`]: intersections of parts |
//! | `plot` | [`plot_svg`]: fits with their points |
//! | `register` | [`register`]: the lattice that carries one scan into another |
//! | `error` | [`compare`]: distances in both directions |

mod blades;
mod centre;
mod choice;
mod clean;
mod cluster;
mod coloured;
mod error;
mod errors;
mod flower;
mod foliage;
mod forms;
mod groups;
mod kernel;
mod lattice;
mod law;
mod left_out;
mod limb;
mod logistic;
mod motion;
mod obb;
mod odd;
mod organs;
mod overlap;
mod parts;
mod petal;
mod plot;
mod pose;
mod reeb;
mod register;
mod segment;
mod species;
mod tails;
mod thin;
mod trial;
mod wanted;
mod ways;
mod whorl;

pub use blades::blades;
pub use choice::{Choice, choose};
pub use clean::{CleanSpec, Cleaned, clean, largest_thing, on_table};
pub use coloured::OrganPoints;
pub use error::{Distances, ShapeError, compare};
pub use errors::BloomError;
pub use forms::{Form, Series, SharedErrors, SharedFit, fit_shared};
pub use groups::{GroupTest, Groups, Permuted, PlantGroup, fit_groups};
pub use lattice::{Lattice, Weights};
pub use law::{
    GrowthLaw, LAW_SCHEMA, LawFault, LawSpec, Prediction, Quantity, RegionLaw, Stage, fit_sizes, fit_stages,
};
pub use limb::{Limb, joint, stalk, stem, surface_places};
pub use logistic::{Fit, FitError, Logistic, Offset, fit_law, fit_logistic};
pub use motion::{Motion, MotionSpec, name_alike};
pub use obb::Obb;
pub use odd::{OddStage, Oddity, odd_stages};
pub use organs::Seat;
pub use overlap::{PartTriangle, crossed, overlap_share, part_overlap, part_triangles};
pub use parts::{Achenes, Cluster, ClusterForm, Disc, Foliage, Fruit, Nods, Stamens};
pub use plot::plot_svg;
pub use pose::{OrganStep, PoseDoubt, PoseStep, RigidMotion, Settled, settle};
pub use register::{RegisterSpec, Registration, register};
pub use segment::{ScanOrgan, match_organs, organ_at, organs, single_organ};
pub use species::{preset, preset_text};
pub use trial::{Rival, Trial, TrialRow, best_move, leave_one_out};
pub use wanted::{FlowerSpec, PetalMesh};
pub use ways::SegmentSpec;
pub use whorl::{Aestivation, Fate, Guide, Innermost, Insertion, PetalForm, Whorl};
