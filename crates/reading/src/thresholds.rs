//! Numbers that several modules compare with, and how all such numbers are kept.
//!
//! A number that something is compared with has a name and says what it separates. Those of one module stand at its top;
//! those of several stand here, or in the `mod.rs` of the rules. `cargo xtask habits` finds what has no name.
//!
//! - **Unit.** Ink units, where the diagonal of the drawing is 1, or a share of what the comment names. Counts and angles
//!   (radians) say so.
//! - **Origin.** What is learnt is data (`data/kinds.csv`, and the classifier's in `ink`), not a constant. A constant was
//!   chosen by looking at drawings of the public in the parts to learn from and to choose by, never in the part for the
//!   end, unless its comment derives it: from *geometry*, from how densely ink is *sampled* (steps of 0.005), or
//!   from our own *fixtures*, which show each way to draw a plant once.

/// What differs by less is the same point or number: *geometry*, the rounding of sums of some thousand numbers of about 1.
pub(crate) const ROUNDING: f64 = 1e-9;
/// Shorter lines have no direction: far less than a step of the pen. *Sampled*.
pub(crate) const NO_LENGTH: f64 = 1e-6;
/// Ends farther apart than this share of the length: a line, not an outline; as for a line by itself in `ink`, where half a
/// circle has 0.64 (*geometry*).
pub(crate) const STRAIGHT: f64 = 0.7;
/// Ends nearer than this share of the length: an outline, though with a wide mouth, such as a circle of which three tenths are
/// missing (*geometry*).
pub(crate) const MOUTH: f64 = 0.35;
/// Petals of a flower, leaves of a rosette or fronds of a palm at least: two are a pair of leaves (He and Cheng 2021, section
/// 4.1: more than 2).
pub(crate) const FEWEST_PETALS: usize = 3;
/// What lies apart by less than this was drawn in one place: two steps of the pen. *Sampled*.
pub(crate) const SAME_PLACE: f64 = 0.01;
/// What ends within this of a line or an outline was meant to meet it, though the pen stopped short.
pub(crate) const STOPPED_SHORT: f64 = 0.03;
/// As [`STOPPED_SHORT`], where an end has nothing else that it could belong to.
pub(crate) const WELL_SHORT: f64 = 0.06;
