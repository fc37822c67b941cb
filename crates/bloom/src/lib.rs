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
//! | `forms` | [`choose`]: one law for several series, if they determine one |
//! | `clean` | [`clean`]: stray points and the ground go |
//! | `segment` | [`organs`]: stem and leaves, and regions along them |
//! | `law` | [`GrowthLaw`]: fitted, saved, moved to another species |
//! | `pose` | [`settle`]: motion of plant and organs apart from growth |
//! | `trial` | [`leave_one_out`]: the model against its rivals |
//! | `motion` | [`Motion`]: the shape at any day |
//! | `flower`, `centre`, `organs`, `species` | [`FlowerSpec`]: whole flowers that open and wilt, day -> `Plant` |
//! | `overlap` | [`overlap_share`]: do petals pass through one another |
//! | `plot` | [`plot_svg`]: fits with their points |
//! | `register` | [`register`]: the lattice that carries one scan into another |
//! | `error` | [`compare`]: distances both ways |

mod centre;
mod clean;
mod error;
mod errors;
mod flower;
mod forms;
mod kernel;
mod lattice;
mod law;
mod logistic;
mod motion;
mod obb;
mod organs;
mod overlap;
mod plot;
mod pose;
mod register;
mod segment;
mod species;
mod thin;
mod trial;

pub use clean::{CleanSpec, Cleaned, clean};
pub use error::{Distances, ShapeError, compare};
pub use errors::BloomError;
pub use flower::{FlowerSpec, Insertion, PetalForm, PetalMesh, Stamens, Whorl};
pub use forms::{Choice, Form, Series, SharedFit, choose, fit_shared};
pub use lattice::{Lattice, Weights};
pub use law::{GrowthLaw, LAW_SCHEMA, LawFault, LawSpec, Quantity, RegionLaw, Stage, fit_sizes, fit_stages};
pub use logistic::{Fit, FitError, Logistic, Offset, fit_law, fit_logistic};
pub use motion::{Motion, MotionSpec, name_alike};
pub use obb::Obb;
pub use organs::Seat;
pub use overlap::{overlap_share, petal_overlap};
pub use plot::plot_svg;
pub use pose::{OrganStep, PoseStep, RigidMotion, Settled, settle};
pub use register::{RegisterSpec, Registration, register};
pub use segment::{Organ, SegmentSpec, match_organs, organ_at, organs, single_organ};
pub use species::preset;
pub use trial::{Rival, Trial, TrialRow, best_move, leave_one_out};
