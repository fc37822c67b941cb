//! Picking: the branch that a pointer means.
//!
//! `ray + plant -> the nearest axis and the place on it`

use glam::DVec3;
use plant::{AxisId, Plant};

/// A line of sight: from an eye through a pixel, or along a controller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Start, metres.
    pub origin: DVec3,
    /// Direction; any length above 0.
    pub direction: DVec3,
}

impl Ray {
    /// Returns the point where it meets a plane; `None` if it does not, or behind its start, or much too far away (a
    /// glancing ray).
    pub fn meets(&self, through: DVec3, normal: DVec3) -> Option<DVec3> {
        let d = self.direction.try_normalize()?;
        let slope = d.dot(normal.try_normalize()?);
        let t = (through - self.origin).dot(normal.normalize()) / slope;
        // A plane seen under less than 3 degrees is an edge: the hand's tremble would leap by metres.
        (slope.abs() > 0.05 && t.is_finite() && t >= 0.0).then(|| self.origin + d * t)
    }
}

/// Largest distance of a pointer from a branch that it means: `metres + per_metre * distance`, so that it is constant
/// on the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// Distance at the ray's start, metres, 0 or more.
    pub metres: f64,
    /// Increase for every metre along the ray, 0 or more; 0.02 is about 1 degree to either side.
    pub per_metre: f64,
    /// Number of steps from the branch to its bearers towards the ground; default 0. In a dense crown every pointer
    /// meets a twig, but boughs are meant, too.
    pub bearers: u32,
}

impl Default for Reach {
    fn default() -> Self {
        Self { metres: 0.005, per_metre: 0.02, bearers: 0 }
    }
}

/// A branch under a pointer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pick {
    /// The axis.
    pub axis: AxisId,
    /// Place on it, as a share of its length.
    pub at: f64,
    /// That place, metres.
    pub point: DVec3,
    /// Distance along the ray, metres.
    pub distance_m: f64,
}

/// Returns the shoot that a ray means: the nearest one that it hits, else the one that it passes at the smallest angle.
///
/// With [`Reach::bearers`], returns its bearer instead, at the place of the branch; the lowest bearer, if there are no
/// more. Stalks of leaves and roots are not picked. `None` if none is within `reach`. Cost: linear in nodes.
///
/// ```
/// use glam::DVec3;
/// use plant::{AxisKind, Plant};
/// use shape::{Ray, Reach, pick};
/// let mut p = Plant::default();
/// let trunk = p.add_axis(AxisKind::Branch, None, 1, &[DVec3::ZERO, DVec3::Y * 2.0], None);
/// let ray = Ray { origin: DVec3::new(0.01, 0.5, 5.0), direction: DVec3::NEG_Z };
/// let got = pick(&p, &ray, Reach::default()).map(|k| (k.axis, k.at));
/// assert_eq!(got, Some((trunk, 0.25)));
/// ```
pub fn pick(plant: &Plant, ray: &Ray, reach: Reach) -> Option<Pick> {
    let d = ray.direction.try_normalize().filter(|_| ray.origin.is_finite())?;
    let mut best: Option<(f64, Pick)> = None;
    for (i, axis) in plant.axes.iter().enumerate() {
        if !axis.kind.is_shoot() {
            continue;
        }
        let id = AxisId::new(i);
        let (points, radii) = (plant.axis_points(id), plant.axis_radii(id));
        let whole = geom::polyline_length3(points);
        let mut sum = 0.0;
        for (w, r) in points.windows(2).zip(radii) {
            let length = w[0].distance(w[1]);
            let (s, t) = nearest(ray.origin, d, w[0], w[1]);
            let (on, distance_m) = (w[0].lerp(w[1], s), t);
            let gap = (on.distance(ray.origin + d * t) - r).max(0.0);
            let allowed = reach.metres.max(0.0) + reach.per_metre.max(0.0) * t;
            let score = gap / allowed.max(1e-12);
            let nearer = best
                .as_ref()
                .is_none_or(|(b, k)| score < b - 1e-12 || (score <= b + 1e-12 && distance_m < k.distance_m));
            if score <= 1.0 && nearer {
                let at = if whole > 0.0 { (sum + s * length) / whole } else { 0.0 };
                best = Some((score, Pick { axis: id, at, point: on, distance_m }));
            }
            sum += length;
        }
    }
    best.map(|(_, mut pick)| {
        // At most as many steps as there are axes: a sound plant has no cycle.
        for _ in plant.axes.iter().take(reach.bearers as usize) {
            let Some(bearer) = bearer_of(plant, pick) else { break };
            pick = bearer;
        }
        pick
    })
}

/// Returns the bearer of a branch, at the place of the branch.
fn bearer_of(plant: &Plant, pick: Pick) -> Option<Pick> {
    let node = plant.axis(pick.axis).bearer?.index();
    let (axis, point) = (*plant.nodes.axis.get(node)?, *plant.nodes.position.get(node)?);
    let (_, at) = geom::nearest_on_polyline3(plant.axis_points(axis), point);
    Some(Pick { axis, at, point, ..pick })
}

/// Finds where a segment and a ray are nearest: the share along the segment and the distance along the ray.
pub(crate) fn nearest(origin: DVec3, d: DVec3, a: DVec3, b: DVec3) -> (f64, f64) {
    let (u, w) = (b - a, a - origin);
    let (uu, ud, uw, dw) = (u.length_squared(), u.dot(d), u.dot(w), d.dot(w));
    let bottom = uu - ud * ud;
    let mut s = if bottom > 1e-12 * uu.max(1e-300) { ((ud * dw - uw) / bottom).clamp(0.0, 1.0) } else { 0.0 };
    let mut t = ud * s + dw;
    if t < 0.0 {
        t = 0.0;
        s = if uu > 0.0 { (-uw / uu).clamp(0.0, 1.0) } else { 0.0 };
    }
    (s, t)
}
