//! The form of an outline: how convex and how slender it is, and where its corners are.

use base::ops;
use geom::{centroid, convex_hull, perimeter, resample, signed_area, simple_outline, smooth_gaussian_closed};
use glam::DVec2;

use super::sheet::slenderness;

/// Points round an outline at which it is measured.
const ROUND: usize = 64;
/// Points to either side over which the turn at a point is measured.
const SPAN: usize = 4;
/// A corner turns by more than this, radians; a circle turns by 0.4 over as many points.
const CORNER: f64 = 0.95;
/// A notch turns inwards by more than this, radians.
const NOTCH: f64 = 0.55;

/// The form of a simple outline, counter-clockwise.
#[derive(Clone, Debug)]
pub(crate) struct Shape {
    pub(crate) area: f64,
    pub(crate) perimeter: f64,
    pub(crate) middle: DVec2,
    /// Area over the area of the hull: 1 for a convex outline.
    pub(crate) convexity: f64,
    /// Width over length, by second moments: 0 to 1.
    pub(crate) slenderness: f64,
    /// Points at which it turns outwards.
    pub(crate) corners: Vec<DVec2>,
    /// Points at which it turns inwards.
    pub(crate) notches: Vec<DVec2>,
    /// Its two points that are farthest apart.
    pub(crate) ends: [DVec2; 2],
}

impl Shape {
    pub(crate) fn new(outline: &[DVec2]) -> Option<Self> {
        let area = signed_area(outline);
        let hull = convex_hull(outline);
        if area <= 0.0 || hull.len() < 3 {
            return None;
        }
        let mut closed = outline.to_vec();
        closed.extend(outline.first());
        let perimeter = perimeter(outline);
        let step = perimeter / ROUND as f64;
        let mut even = resample(&closed, step);
        let slenderness = slenderness(&even);
        even.pop();
        let (corners, notches) = corners(&smooth_gaussian_closed(&even, 1, step * step));
        let (a, b) = geom::farthest_pair(outline)?;
        Some(Self {
            area,
            perimeter,
            middle: centroid(outline),
            convexity: area / signed_area(&hull).max(f64::MIN_POSITIVE),
            slenderness,
            corners,
            notches,
            ends: [outline[a], outline[b]],
        })
    }

    /// Returns the longest diameter.
    pub(crate) fn length(&self) -> f64 {
        self.ends[0].distance(self.ends[1])
    }

    /// Returns the corner farthest from a point.
    pub(crate) fn tip_from(&self, root: DVec2) -> Option<DVec2> {
        let far = |a: &&DVec2, b: &&DVec2| a.distance_squared(root).total_cmp(&b.distance_squared(root));
        self.corners.iter().max_by(far).copied()
    }
}

/// Least convexity of a lens (area over that of the hull).
const LENS_CONVEX: f64 = 0.93;
/// Slenderness of a lens (width over length).
const LENS_SLENDER: core::ops::Range<f64> = 0.08..0.6;
/// A lens covers less than this share of the box along it; a strip with flat ends covers more.
const LENS_FULL: f64 = 0.8;
/// The two corners of a lens are farther apart than this share of its length.
const LENS_ENDS: f64 = 0.85;

/// Whether a closed line is a lens: convex and slender, with exactly two corners, one at each end. Leaves and petals
/// have this form; fruits and roots are blunt at one end at least.
pub(crate) fn is_lens(line: &[DVec2]) -> bool {
    is_lens_of(line, LENS_SLENDER)
}

/// Whether a closed line is a lens of such a slenderness (width over length).
pub(crate) fn is_lens_of(line: &[DVec2], slender: core::ops::Range<f64>) -> bool {
    let Some(shape) = simple_outline(line).and_then(|outline| Shape::new(&outline)) else { return false };
    let [a, b] = shape.corners[..] else { return false };
    let across = (b - a).normalize_or_zero().perp();
    let (low, high) =
        line.iter().map(|p| (*p - a).dot(across)).fold((0.0_f64, 0.0_f64), |(l, h), w| (l.min(w), h.max(w)));
    shape.convexity > LENS_CONVEX
        && shape.area < LENS_FULL * (high - low) * shape.length()
        && slender.contains(&shape.slenderness)
        && a.distance(b) > LENS_ENDS * shape.length()
}

/// Returns corners and notches of an outline of even steps: the sharpest place of each.
fn corners(even: &[DVec2]) -> (Vec<DVec2>, Vec<DVec2>) {
    let n = even.len();
    if n <= 2 * SPAN {
        return (Vec::new(), Vec::new());
    }
    let turn = |i: usize| {
        let (a, b) = (even[i] - even[(i + n - SPAN) % n], even[(i + SPAN) % n] - even[i]);
        ops::atan2(a.perp_dot(b), a.dot(b))
    };
    let turns: Vec<f64> = (0..n).map(turn).collect();
    let sharpest = |sign: f64, least: f64| {
        let is_peak = |&i: &usize| {
            let own = sign * turns[i];
            own > least
                && (1..=SPAN).all(|d| own >= sign * turns[(i + d) % n])
                && (1..=SPAN).all(|d| own > sign * turns[(i + n - d) % n])
        };
        (0..n).filter(is_peak).map(|i| even[i]).collect::<Vec<_>>()
    };
    (sharpest(1.0, CORNER), sharpest(-1.0, NOTCH))
}
