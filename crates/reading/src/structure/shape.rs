//! The form of an outline: how convex and how slender it is, and where its corners are.

use base::ops;
use geom::{centroid, convex_hull, perimeter, resample, signed_area, smooth_gaussian_closed};
use glam::DVec2;

use super::sheet::slenderness;

/// Points round an outline at which it is looked at.
const ROUND: usize = 64;
/// The turn at a point is taken over so many points to either side.
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
    /// Area over the area of the hull: 1 of a convex outline.
    pub(crate) convexity: f64,
    /// Width over length, by second moments: 0 to 1.
    pub(crate) slenderness: f64,
    /// Where it points outwards.
    pub(crate) corners: Vec<DVec2>,
    /// Where it points inwards.
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

    /// Longest diameter.
    pub(crate) fn length(&self) -> f64 {
        self.ends[0].distance(self.ends[1])
    }

    /// The corner farthest from a point.
    pub(crate) fn tip_from(&self, root: DVec2) -> Option<DVec2> {
        let far = |a: &&DVec2, b: &&DVec2| a.distance_squared(root).total_cmp(&b.distance_squared(root));
        self.corners.iter().max_by(far).copied()
    }
}

/// Corners and notches of an outline of even steps: the sharpest place of each.
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
