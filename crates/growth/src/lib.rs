//! Trees that grow by competition for space and light.
//!
//! `spec + seed -> attractors -> Skeleton -> Plant`
//!
//! | module | owns |
//! |---|---|
//! | `envelope` | the space of a crown, attraction points scattered in it |
//! | `limbs` | crowns of limbs and masses of foliage, drawn anew by each seed |
//! | `variation` | variation between trees of one kind |
//! | `life` | a tree at a younger age |
//! | `obstacle` | boxes, balls, cylinders, planes and meshes that growth goes around |
//! | `beside` | courses of wood next to obstacles: room for bark |
//! | `mesh_faults` | whether a mesh is closed, for warnings |
//! | `colonize` | space colonisation (Runions 2007) |
//! | `competition` | life cycles of attraction points (Yang et al. 2019) |
//! | `self_organize` | buds that compete for light, shedding, wood (Palubicki 2009) |
//! | `guided` | buds with markers of their own, repulsion, strokes of a brush (the VR paper) |
//! | `lsystem` | rules read from text |
//! | `skeleton` | the result of growers: joints and their parents |
//! | `wood` | axes, smooth courses, radii |
//! | `props` | roots that arch from the stem to the ground |
//! | `scars` | stubs, knots, burls, hollows and broken limbs on stems |
//! | `surface_roots` | roots that run along the ground from the foot of a stem |
//! | `leaves` | phyllotaxis, culled by shadow propagation |
//! | `blossom` | flowers in place of leaves |
//! | `species` | rules fitted to measured trees so that they branch alike, and the agreement of both |
//! | `spec`, `look` | [`TreeSpec`]: all settings of a tree, and its appearance |
//! | `tree` | the whole process: [`grow`] |

mod arrangement;
mod beside;
mod blossom;
mod colonize;
mod competition;
mod envelope;
mod error;
mod field;
mod guided;
mod leaves;
mod life;
mod limbs;
mod look;
mod lsystem;
mod mesh_faults;
mod obstacle;
mod props;
mod scars;
mod self_organize;
mod set_down;
mod sieve;
mod skeleton;
mod solid;
mod spec;
mod species;
mod surface_roots;
mod tree;
mod tropism;
mod variation;
mod wood;

pub use self::spec::{Method, TreeSpec};
pub use arrangement::Arrangement;
pub use blossom::add_blossom;
pub use colonize::{ColonizeSpec, Colonized, PointFate, colonize, colonize_from, regrow};
pub use competition::{Competed, CompetitionSpec, Cycle, compete};
pub use envelope::{Envelope, Region};
pub use error::{GrowthError, LsystemError, RuleFault, SolidFault};
pub use guided::{
    BrushStroke, Growing, GrowthStep, Guided, GuidedChange, GuidedSpec, StartBud, guide, guide_from,
};
pub use leaves::{FoliageSpec, LeafCount, add_leaves};
pub use limbs::LimbsSpec;
pub use look::{Bark, BladeSpec, BlossomSpec, Look};
pub use lsystem::{Ages, LeafMark, Lsystem, LsystemTree, OAK_RULES, grow_lsystem};
pub use mesh_faults::{open_edges, signed_volume};
pub use obstacle::{Obstacle, Obstacles};
pub use self_organize::{Light, Resource, SelfOrganized, SelfOrganizingSpec, self_organize};
pub use set_down::SetDown;
pub use skeleton::{JointId, Skeleton, SkeletonFault};
pub use species::{
    Agreement, FittedSpecies, OrderTraits, SpeciesError, SpeciesLimits, Trait, Traits, Unfitted, agree,
    fit_species,
};
pub use tree::{FlowerPlace, Grown, GrowthTally, grow};
pub use tropism::Tropism;
pub use variation::VariationSpec;
pub use wood::{PropSpec, ScarSpec, SurfaceRootSpec, Wood, WoodSpec, make_wood};

/// Share of the work that is done, for people who wait, when the skeleton is complete; the rest is wood, leaves and
/// meshes. Measured on an oak.
pub(crate) const GROWN: f64 = 0.4;
