//! Light on plants: its sources, its absorption by each organ, and its reflection and transmission.
//!
//! `place, day, turbidity -> Beams; triangles with optics -> LitScene; both -> absorb -> Absorption`
//!
//! | module | owns |
//! |---|---|
//! | `sky` | [`Beams`]: a sky of 46 directions, overcast, uniform, clear or measured, and suns |
//! | `sun` | [`SunPlace`], [`Sunlight`]: position of the sun, brightness of the sun and of a clear sky |
//! | `scene` | [`LitScene`]: triangles with their owners, and the reflectance and transmittance of these |
//! | `lines` | parallel lines through a scene, and all their crossings |
//! | `exposure` | [`exposure()`]: first order alone, with the direction that it comes from |
//! | `exchange` | [`absorb`]: first order, then bounces between neighbours along lines |

mod error;
mod exchange;
mod exposure;
mod lines;
mod scene;
mod sky;
mod sun;

pub use error::LightError;
pub use exchange::{Absorption, DirectionLight, EnergyBalance, LightSpec, PatchLight, ReceiverLight, absorb};
pub use exposure::{Exposure, exposure};
pub use scene::{LitScene, Optics};
pub use sky::{Beam, Beams, SKY_DIRECTIONS, SkyKind};
pub use sun::{SunPlace, SunPosition, Sunlight, direction_to};
