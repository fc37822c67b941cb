//! Needles and scales of a shoot.

use base::Digest;

/// The needles of a blade that is a whole shoot of them. Lengths are shares of the blade's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Needles {
    /// Of a needle.
    pub length: f64,
    /// Of a needle where it is widest.
    pub width: f64,
    /// From a needle to the next on one side of an axis.
    pub spacing: f64,
    /// Between a needle and its axis, radians.
    pub angle: f64,
}

/// Below this share of the shoot's length needles are scales.
const SCALES: f64 = 0.045;

impl Needles {
    /// Needles of a length over that of the shoot, 0.01 to 0.6; scales if they are short. Scales lie close and overlap,
    /// needles stand off.
    pub fn of_length(length: f64) -> Self {
        let length = if length.is_finite() { length.clamp(0.01, 0.6) } else { 0.1 };
        if length < SCALES {
            return Self { length, width: 0.4 * length, spacing: 0.5 * length, angle: 0.5 };
        }
        let width = (0.075 * length).clamp(0.005, 0.02);
        Self { length, width, spacing: 2.2 * width, angle: 0.95 }
    }

    pub(crate) fn digest(&self, d: &mut Digest) {
        d.add(&self.length).add(&self.width).add(&self.spacing).add(&self.angle);
    }
}
