//! The multiscale plant: every maker's output, and the input of skin, formats and studio.
//!
//! `maker -> Plant -> skin -> Model`
//!
//! Topology (axes, nodes, organs by `u32` handles) is stored apart from geometry (columns). Scales follow MTG (Godin
//! and Caraglio 1998): a plant is decomposed (`/`) into axes, an axis into nodes that succeed one another (`<`); axes
//! and organs are borne (`+`) by nodes.

mod blade;
mod flat;
mod forms;
mod frame;
mod ids;
mod measure;
mod needle_map;
mod needles;
mod organ;
mod phyllotaxis;
mod pipe;
mod relief;
mod rim;
mod sheet;
mod shoot;
mod topology;
mod validate;

pub use blade::{Blade, BladeVein, Lift, Relief};
pub use flat::FlatLeaf;
pub use forms::BladeForm;
pub use frame::Frame;
pub use ids::{AxisId, FlowerId, NodeId, OrganId, ShapeId};
pub use measure::{Measures, OrderMeasures, RadiusExponent, Strahler};
pub use needle_map::{NeedleMap, SeenNeedle};
pub use needles::Needles;
pub use organ::{DRAWN_WIDER, Flower, Organ, OrganKind, Paint, PlantPaint, Shape};
pub use phyllotaxis::{Divergence, Phyllotaxis};
pub use pipe::{PipeModel, Taper, pipe_radii};
pub use relief::BladeSurface;
pub use rim::Netted;
pub use sheet::{Chart, RimPoint, Sheet, SplineBlade, Vein, VeinShade, Venation};
pub use topology::{Axis, AxisKind, Nodes, Plant};
pub use validate::PlantFault;
