//! Needles and scales of a shoot.

use base::Digest;

/// The needles of a blade that is a whole shoot. Lengths are shares of the blade's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Needles {
    /// Length of a needle.
    pub length: f64,
    /// Greatest width of a needle.
    pub width: f64,
    /// Distance between neighbouring needles on one side of an axis.
    pub spacing: f64,
    /// Angle between a needle and its axis, radians.
    pub angle: f64,
}

/// Length of needles, as a share of the shoot's, below which they are scales.
const SCALES: f64 = 0.045;

impl Needles {
    /// Makes needles of a length relative to that of the shoot, 0.01 to 0.6; scales if they are short. Scales lie close
    /// and overlap, needles stand off.
    pub fn with_length(length: f64) -> Self {
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
