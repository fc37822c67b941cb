//! Thresholds of several modules, and the conventions for all such numbers.
//!
//! A threshold has a name, and its comment gives its meaning. Those of one module stand at its top; those of several
//! stand here, or in the `mod.rs` of the rules. `cargo xtask habits` finds numbers without names.
//!
//! - **Unit.** Ink units, where the diagonal of the drawing is 1, or a share of the quantity that the comment names.
//!   Counts and angles (radians) are marked as such.
//! - **Origin.** Learnt numbers are data (`data/kinds.csv`, and the classifier's in `ink`), not constants. A constant
//!   was chosen by looking at public drawings of the learning and the choosing part, never of the final test part,
//!   unless its comment derives it: from *geometry*, from how densely ink is *sampled* (steps of 0.005), or from our
//!   own *fixtures*, which show each way to draw a plant once.

/// Points or numbers that differ by less are the same: *geometry*, the rounding of sums of some thousand numbers of
/// about 1.
pub(crate) const ROUNDING: f64 = 1e-9;
/// Shorter lines have no direction: far less than a step of the pen. *Sampled*.
pub(crate) const NO_LENGTH: f64 = 1e-6;
/// A stroke whose ends are farther apart than this share of its length is a line, not an outline; as for a single line
/// in `ink`, where half a circle has 0.64 (*geometry*).
pub(crate) const STRAIGHT: f64 = 0.7;
/// A stroke whose ends are nearer than this share of its length is an outline, though with a wide mouth, such as a
/// circle of which three tenths are missing (*geometry*).
pub(crate) const MOUTH: f64 = 0.35;
/// Fewest petals of a flower, leaves of a rosette or fronds of a palm: two are a pair of leaves (He and Cheng 2021,
/// section 4.1: more than 2).
pub(crate) const FEWEST_PETALS: usize = 3;
/// Points nearer than this were drawn in one place: two steps of the pen. *Sampled*.
pub(crate) const SAME_PLACE: f64 = 0.01;
/// A line that ends within this distance of another line or an outline was meant to meet it, though the pen stopped
/// short.
pub(crate) const STOPPED_SHORT: f64 = 0.03;
/// The same distance as [`STOPPED_SHORT`], for an end that has nothing else to belong to.
pub(crate) const WELL_SHORT: f64 = 0.06;
