//! The sheet of a leaf or petal: an outline in the plane, lifted and bent into space.

use base::{Digest, Digestible};
use glam::DVec2;

use crate::Needles;

/// A leaf or petal in its own frame: x across, y from root to tip, z towards the upper side.
///
/// The outline is a simple polygon, counter-clockwise, without a repeated first point, in metres at scale 1.
/// The root is the origin. A point `(x, y)` of the plane is put into space by [`Blade::point`].
#[derive(Clone, Debug, PartialEq)]
pub struct Blade {
    /// The margin, at least 3 points.
    pub outline: Vec<DVec2>,
    /// The midrib from root to tip, at least 2 points, inside the outline (ends may lie on it).
    pub midrib: Vec<DVec2>,
    /// Further veins that the user drew.
    pub veins: Vec<BladeVein>,
    /// Needles or scales of a blade that is a whole shoot, too fine for outlines; its veins are the axes of the shoot.
    pub needles: Option<Needles>,
    /// The surface on which the blade lies before it is bent.
    pub lift: Lift,
    /// Bending of the blade.
    pub relief: Relief,
}

/// A vein of a blade other than its midrib.
#[derive(Clone, Debug, PartialEq)]
pub struct BladeVein {
    /// At least 2 points in the plane of the blade, in either direction.
    pub line: Vec<DVec2>,
    /// Width relative to the usual one, about 0.5 to 2.
    pub boldness: f64,
}

impl From<Vec<DVec2>> for BladeVein {
    /// Makes a vein of the usual width.
    fn from(line: Vec<DVec2>) -> Self {
        Self { line, boldness: 1.0 }
    }
}

impl Digestible for BladeVein {
    fn digest(&self, d: &mut Digest) {
        d.add(&self.line);
        // The usual boldness adds nothing to the digest.
        if self.boldness != 1.0 {
            d.add(&self.boldness);
        }
    }
}

/// The height of the undeformed blade over its frame's plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Lift {
    /// In the plane.
    #[default]
    Flat,
    /// In a tilted plane through the root: `z = slope.x * x + slope.y * y`. The view along z stays as drawn.
    Tilt {
        /// Rise per unit across and along the blade.
        slope: DVec2,
    },
    /// On a cone (He and Cheng 2021, Eq 3; see `geom::Cone`), in the blade's local coordinates.
    Cone {
        /// The cone and the sheet of it on which this petal lies.
        cone: geom::Cone,
        /// Sheet of the cone on which the petal lies.
        sheet: geom::ConeSheet,
    },
}

/// Bending and hollowing (He and Cheng 2021, Eq 5 and section 6.2), all as shares of the blade's length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relief {
    /// Quartic coefficient A of Eq 5; a positive one bends the tip away from the upper side. About -0.2 to 0.2.
    pub bend_a: f64,
    /// Quadratic coefficient B of Eq 5. About -0.3 to 0.5.
    pub bend_b: f64,
    /// Depth of the hollow at the centre, H. About 0 to 0.2; negative bulges.
    pub hollow: f64,
    /// Fold along the midrib: slope of the halves, 0 flat, positive lifts the margins (V section).
    pub fold: f64,
    /// Amplitude of waves along the margin. 0 to about 0.1.
    pub wave: f64,
    /// Keep lengths along the midrib when bending, instead of keeping the projection (x, y).
    pub keep_length: bool,
}

impl Default for Relief {
    fn default() -> Self {
        Self { bend_a: 0.0, bend_b: 0.0, hollow: 0.0, fold: 0.0, wave: 0.0, keep_length: false }
    }
}

impl Digestible for Blade {
    fn digest(&self, d: &mut Digest) {
        d.add(&self.outline).add(&self.midrib).add(&self.veins);
        match self.lift {
            Lift::Flat => {
                d.add(&0_u8);
            }
            Lift::Cone { cone, sheet } => {
                d.add(&1_u8).add(&cone.apex).add(&cone.axis).add(&cone.half_angle).add(&(sheet as u8));
            }
            Lift::Tilt { slope } => {
                d.add(&2_u8).add(&slope);
            }
        }
        if let Some(needles) = self.needles {
            needles.digest(d);
        }
        let r = self.relief;
        d.add(&r.bend_a).add(&r.bend_b).add(&r.hollow).add(&r.fold).add(&r.wave).add(&r.keep_length);
    }
}

impl Blade {
    /// Makes a flat blade of length 1 from its right margin, given without root and tip.
    pub fn mirrored(right: &[DVec2], relief: Relief) -> Self {
        let mut outline = vec![DVec2::ZERO];
        outline.extend_from_slice(right);
        outline.push(DVec2::Y);
        outline.extend(right.iter().rev().map(|p| DVec2::new(-p.x, p.y)));
        let midrib = (0..=4).map(|i| DVec2::new(0.0, f64::from(i) / 4.0)).collect();
        Self { outline, midrib, veins: Vec::new(), needles: None, lift: Lift::Flat, relief }
    }

    /// Iterates over the lines of its midrib and its other veins.
    pub fn lines(&self) -> impl Iterator<Item = &Vec<DVec2>> {
        core::iter::once(&self.midrib).chain(self.veins.iter().map(|v| &v.line))
    }

    /// Returns the length from root to tip in the plane, metres.
    pub fn length(&self) -> f64 {
        self.midrib.last().map_or(0.0, |tip| tip.length())
    }
}
