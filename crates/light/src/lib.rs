//! Light on plants: where it comes from, what each organ absorbs, and what becomes of the rest.
//!
//! `place, day, turbidity -> Beams; triangles with optics -> LitScene; both -> absorb -> Absorption`
//!
//! | module | owns |
//! |---|---|
//! | `sky` | [`Beams`]: a sky of 46 directions, overcast, uniform or clear, or as it was measured, and suns |
//! | `sun` | [`SunPlace`], [`Sunlight`]: where the sun stands, and how bright it and a clear sky are |
//! | `scene` | [`LitScene`]: triangles, what they belong to, and how these reflect and transmit |
//! | `lines` | parallel lines through a scene, and all that each of them crosses |
//! | `exchange` | [`absorb`]: first order, then bounces between what lies next to one another on lines |

mod error;
mod exchange;
mod lines;
mod scene;
mod sky;
mod sun;

pub use error::LightError;
pub use exchange::{Absorption, DirectionLight, EnergyBalance, LightSpec, PatchLight, ReceiverLight, absorb};
pub use scene::{LitScene, Optics};
pub use sky::{Beam, Beams, SkyKind, TURTLE_DIRECTIONS};
pub use sun::{SunPlace, SunPosition, Sunlight, direction_to};
