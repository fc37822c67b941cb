//! Detects drawings that came out as a tangle of bare lines: `Reading -> length of axes that lead to nothing`.
//!
//! Engravings and traced scans are areas of ink whose centre lines run along outlines, shading and veins alike. The
//! readers take most of these for axes. A plant of bare axes is a bare tree; a plant that has organs bears them on its
//! axes.

use geom::polyline_length;
use plant::AxisKind;

use crate::Reading;

/// Limits beyond which bare lines are a tangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TangleLimits {
    /// The bare lines together are longer than this many diagonals of the drawing.
    pub length_most: f64,
    /// They are more than this share of all axes.
    pub share_most: f64,
}

/// The limits for all drawings. Measured on 88 pieces of line art by people and 16 illustrations: see
/// `docs/strokes.md`.
pub const TANGLE_LIMITS: TangleLimits = TangleLimits { length_most: 3.0, share_most: 0.4 };

/// Returns the length of all axes that lead to no organ and no crown, in diagonals of the drawing, if that makes a
/// tangle; else 0. Roots are bare, and so are all axes of a plant without organs: these do not count. Cost: linear.
pub fn tangled_length(reading: &Reading) -> f64 {
    let Reading { axes, leaves, flowers, fruits, regions, thorns, .. } = reading;
    let borne = leaves.iter().map(|l| l.bearer).chain(flowers.iter().map(|f| f.bearer));
    let borne = borne.chain(fruits.iter().map(|f| f.bearer)).chain(thorns.iter().map(|t| t.1));
    let bearers =
        borne.flatten().map(|b| b.axis).chain(regions.iter().flat_map(|r| r.bearers.iter().copied()));
    let mut leads = vec![false; axes.len()];
    for bearer in bearers {
        let mut next = Some(bearer);
        // A chain of bearers that was followed already is known to lead somewhere.
        while let Some(k) = next.filter(|&k| leads.get(k) == Some(&false)) {
            leads[k] = true;
            next = axes[k].bearer.map(|b| b.axis);
        }
    }
    if !leads.contains(&true) {
        return 0.0;
    }
    let counted = || axes.iter().zip(&leads).filter(|(a, _)| a.kind != AxisKind::Root);
    let whole: f64 = counted().map(|(a, _)| polyline_length(&a.points)).sum();
    let bare: f64 = counted().filter(|(_, leads)| !**leads).map(|(a, _)| polyline_length(&a.points)).sum();
    let is_tangle = bare > TANGLE_LIMITS.length_most && bare > TANGLE_LIMITS.share_most * whole;
    if is_tangle { bare } else { 0.0 }
}
