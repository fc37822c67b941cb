//! Arrangement of leaves around their axis.
//!
//! `rank of the node -> azimuths of its leaves`

use base::ops::{PI, TAU};
use base::{Angle, NotFinite};

/// The angle between successive leaves of a spiral, radians.
///
/// ```
/// use plant::Divergence;
/// assert!((Divergence::GOLDEN.radians().to_degrees() - 137.507_764).abs() < 1e-6);
/// assert!((Divergence::fraction(2, 5)?.radians().to_degrees() - 144.0).abs() < 1e-9);
/// assert!(Divergence::fraction(1, 0).is_err());
/// # Ok::<(), base::NotFinite>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Divergence(f64);

impl Divergence {
    /// 360 degrees over the square of the golden ratio, the limit of most spirals (Vogel 1979).
    pub const GOLDEN: Self = Self(2.399_963_229_728_653);
    /// Half a turn: two rows, as in elm and lime.
    pub const HALF: Self = Self(PI);

    /// Makes a divergence from degrees; any finite number, also negative (a spiral in the opposite sense).
    ///
    /// # Errors
    /// [`NotFinite`] for NaN and infinities.
    pub fn from_deg(degrees: f64) -> Result<Self, NotFinite> {
        Angle::from_deg(degrees).map(|a| Self(a.radians()))
    }

    /// Makes the classical fraction: `turns` turns around the axis until a leaf, `leaves` leaves on, stands above the
    /// first (1/3 beech, 2/5 oak and apple, 3/8 poplar and rose, 5/13 willow).
    ///
    /// # Errors
    /// [`NotFinite`] if `leaves` is 0.
    pub fn fraction(turns: u32, leaves: u32) -> Result<Self, NotFinite> {
        let value = f64::from(turns) / f64::from(leaves);
        if leaves == 0 {
            return Err(NotFinite { what: "a phyllotactic fraction", range: "turns / leaves", value });
        }
        Ok(Self(value * TAU))
    }

    /// Returns the angle in radians.
    pub const fn radians(self) -> f64 {
        self.0
    }
}

/// The arrangement of leaves (or branches) around an axis.
///
/// Azimuths are measured around the axis from a direction that the caller chooses, right-handed about the
/// direction of growth.
///
/// ```
/// use plant::Phyllotaxis;
/// let maple = Phyllotaxis::Decussate;
/// let degrees = |node| maple.azimuths(node).map(|a| a.to_degrees().round()).collect::<Vec<_>>();
/// assert_eq!((degrees(0), degrees(1)), (vec![0.0, 180.0], vec![90.0, 270.0]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Phyllotaxis {
    /// One leaf per node, each turned by the divergence from the one before.
    Spiral(Divergence),
    /// One leaf per node in two rows: elm, lime, grasses.
    Distichous,
    /// Two leaves per node, all in one plane: many conifers' sprays.
    Opposite,
    /// Two leaves per node, each pair at right angles to the next: maple, ash, lilac.
    Decussate,
    /// This number of leaves per node (0 is read as 1), each whorl turned by half the angle between its leaves.
    Whorled(u32),
}

impl Default for Phyllotaxis {
    fn default() -> Self {
        Self::Spiral(Divergence::GOLDEN)
    }
}

impl Phyllotaxis {
    /// Returns the number of leaves on one node, 1 or more.
    pub const fn per_node(self) -> u32 {
        match self {
            Self::Spiral(_) | Self::Distichous => 1,
            Self::Opposite | Self::Decussate => 2,
            Self::Whorled(k) => {
                if k == 0 {
                    1
                } else {
                    k
                }
            }
        }
    }

    /// Returns the azimuth of leaf `leaf` (0 to [`per_node`](Self::per_node) - 1) of node `node` counted from the base,
    /// radians in \[0, 2 pi).
    ///
    /// ```
    /// use plant::{Divergence, Phyllotaxis};
    /// let spiral = Phyllotaxis::Spiral(Divergence::fraction(1, 3)?);
    /// assert!((spiral.azimuth(4, 0).to_degrees() - 120.0).abs() < 1e-9);
    /// # Ok::<(), base::NotFinite>(())
    /// ```
    pub fn azimuth(self, node: u32, leaf: u32) -> f64 {
        let node = f64::from(node);
        let k = f64::from(self.per_node());
        let within = f64::from(leaf) * TAU / k;
        let turned = match self {
            Self::Spiral(d) => node * d.radians(),
            Self::Distichous => node * PI,
            Self::Opposite => 0.0,
            // The next whorl stands in the gaps of the last: pi / 2 for pairs.
            Self::Decussate | Self::Whorled(_) => node * PI / k,
        };
        (within + turned).rem_euclid(TAU)
    }

    /// Returns the azimuths of all leaves of node `node`.
    pub fn azimuths(self, node: u32) -> impl ExactSizeIterator<Item = f64> {
        (0..self.per_node()).map(move |leaf| self.azimuth(node, leaf))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn degrees(p: Phyllotaxis, node: u32) -> Vec<i32> {
        #[expect(clippy::cast_possible_truncation, reason = "angles below 360")]
        p.azimuths(node).map(|a| a.to_degrees().round() as i32).collect()
    }

    #[test]
    fn arrangements_of_the_textbook() {
        assert_eq!(degrees(Phyllotaxis::Distichous, 3), [180]);
        assert_eq!(degrees(Phyllotaxis::Opposite, 3), [0, 180]);
        assert_eq!(degrees(Phyllotaxis::Decussate, 2), [180, 0]);
        assert_eq!(degrees(Phyllotaxis::Whorled(3), 0), [0, 120, 240]);
        assert_eq!(degrees(Phyllotaxis::Whorled(3), 1), [60, 180, 300]);
        assert_eq!(degrees(Phyllotaxis::Whorled(0), 5).len(), 1, "0 is read as 1");
        assert_eq!(degrees(Phyllotaxis::default(), 1), [138]);
    }

    #[test]
    fn the_golden_spiral_never_repeats_a_row_for_long() {
        // Among 34 successive leaves no two stand nearer than 360 / 34 / 2 degrees: the golden angle's mark.
        let all: Vec<f64> = (0..34).map(|n| Phyllotaxis::default().azimuth(n, 0)).collect();
        let mut nearest = TAU;
        for (i, a) in all.iter().enumerate() {
            for b in &all[..i] {
                let d = (a - b).abs();
                nearest = nearest.min(d.min(TAU - d));
            }
        }
        assert!(nearest > TAU / 68.0, "{}", nearest.to_degrees());
    }

    #[test]
    fn divergences_are_checked_at_the_door() {
        assert!(Divergence::from_deg(f64::NAN).is_err());
        assert!(Divergence::from_deg(-137.5).is_ok_and(|d| d.radians() < 0.0));
        let a = Phyllotaxis::Spiral(Divergence(-1.0)).azimuth(7, 0);
        assert!((0.0..TAU).contains(&a), "{a}");
    }
}
