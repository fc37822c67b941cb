//! Forks: a fillet from the bearer's surface to the branch's own tube.

use glam::DVec3;

use crate::rings::Ring;
use crate::sleeve::{Circle, Sleeve};
use crate::spine::{Reach, Spine, Station};

/// The bearer of a branch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bearer<'a> {
    pub spine: &'a Spine,
    /// The sample at which the branch starts, or the last one before it.
    pub sample: usize,
    /// Sides of the bearer's tube, whose flat faces lie deeper than its radius.
    pub sides: u32,
    /// Arc lengths from which on the bearer is visible, outside of its own bearer, and up to which it is a fillet
    /// itself.
    pub exit: f64,
    pub top: f64,
    /// Normals of the rings at the samples of the spine as drawn: oblique at sharp turns; empty for a smooth line,
    /// whose rings are perpendicular to it.
    pub planes: &'a [DVec3],
}

/// Rows of a fillet: `rows` x (sides + 1) corners and normals, from foot to top; the top row is the tube's first ring.
#[derive(Debug, Default)]
pub(crate) struct Collar {
    pub corners: Vec<DVec3>,
    pub normals: Vec<DVec3>,
    pub width: usize,
    /// A point inside the bearer.
    inside: DVec3,
}

// Largest depth of a fillet's rows below the line's radius, as a share of it.
const HOLLOW: f64 = 0.25;

// Pieces beyond the nearest in the search for the cross-section through a point, and halvings that find it in its
// piece.
const FARTHEST: usize = 6;
const HALVINGS: usize = 24;

// Share of the radius that certainly lies inside a bearer below its fillet, where it is not drawn.
const BELOW: f64 = 0.1;

// Sine of the angle below which a fillet is cut short: a branch that runs along its bearer leaves it only far out.
const SHALLOWEST: f64 = 0.22;

// Least cosine between a fillet, which runs straight to the branch's first ring, and the branch (35 degrees): beyond it
// the ring would be oblique and make a flat band of the fillet, next to what the branch bears there.
const STRAIGHT: f64 = 0.82;

// Least height of a fillet, in radii of the branch: sharp turns happen in its rings.
const LOWEST: f64 = 0.6;

/// Returns the point where the centre line of `branch` leaves its bearer, and the bearer's station there; `None` if it
/// never does (it ends inside).
fn exit(branch: &Spine, bearer: &Bearer<'_>) -> Option<(Station, Station)> {
    let mut hint = bearer.sample;
    let mut depth = |p: DVec3| {
        let found = bearer.spine.outside(p, hint);
        hint = found.2;
        found
    };
    let mut inside = None;
    let (k, mut outside) = branch.p.iter().enumerate().find_map(|(k, &p)| {
        let here = depth(p);
        let found = here.0 > 0.0;
        if !found {
            inside = Some(here.0);
        }
        found.then_some((k, here))
    })?;
    let station = |(_, s, piece): (f64, f64, usize)| bearer.spine.station(piece, s);
    let Some(mut inside) = inside else { return Some((branch.station_at(0.0), station(outside))) };
    // Samples are coarser than bearers are thick: false position (Illinois) finds the surface.
    let (mut a, mut b) = (branch.s[k - 1], branch.s[k]);
    for _ in 0..4 {
        let s = b - (b - a) * (outside.0 / (outside.0 - inside)).clamp(0.0, 1.0);
        let u = if b > a { (s - branch.s[k - 1]) / (branch.s[k] - branch.s[k - 1]) } else { 0.0 };
        let here = depth(branch.p[k - 1].lerp(branch.p[k], u));
        if here.0 > 0.0 {
            (b, outside) = (s, here);
            inside *= 0.5;
        } else {
            (a, inside) = (s, here.0);
        }
    }
    Some((branch.station(k - 1, b), station(outside)))
}

/// Returns the position of the fillet of `branch` on its bearer; `None` if the branch ends inside.
pub(crate) fn reach(branch: &Spine, bearer: &Bearer<'_>) -> Option<Reach> {
    let (exit, at) = exit(branch, bearer)?;
    let cos = exit.tangent.dot(at.tangent);
    let sin = (1.0 - cos * cos).max(0.0).sqrt().max(SHALLOWEST);
    // On a thick bearer the fillet is as long as the branch is thick; on one of similar thickness it may take 1.2 of
    // the bearer's radius.
    let length = 1.2 * at.radius.min(2.2 * exit.radius);
    let top = exit.s + exit.radius * cos.abs() / sin + length;
    let room = branch.length() - exit.s;
    let top = straight(branch, &exit, top.min(exit.s + 0.6 * room));
    Some(Reach { exit, on: at.s, top })
}

/// Returns the arc length, at most `top`, up to which a branch continues straight enough after it leaves its bearer.
fn straight(branch: &Spine, exit: &Station, top: f64) -> f64 {
    let least = exit.s + LOWEST * exit.radius;
    let mut straight = least;
    let first = branch.piece(exit.s) + 1;
    for k in first..branch.s.len() {
        let along = branch.p[k] - exit.centre;
        if branch.s[k] >= top {
            return top;
        }
        if branch.s[k] > least && branch.t[k].dot(along) < STRAIGHT * along.length() {
            break;
        }
        straight = branch.s[k].max(least);
    }
    straight.min(top)
}

impl Collar {
    /// Makes the fillet of a branch on its bearer, with `steps` rows between its foot and the branch's first ring,
    /// `top`.
    ///
    /// Its foot lies on the bearer's surface, sunk just below the flat faces, with the bearer's normals: shading passes
    /// from one to the other without an edge. If the bearer is given as drawn, the foot reaches it even if the smooth
    /// line runs elsewhere.
    ///
    /// `ridge` is the height of the bark ridge between the two on the upper side, relative to the spread of the foot.
    pub(crate) fn new(
        reach: &Reach,
        top: &Ring,
        bearer: &Bearer<'_>,
        circle: &Circle,
        (steps, ridge): (u32, f64),
    ) -> Self {
        let at = &reach.exit;
        let (axis, hint) = bearer.spine.nearest(at.centre, bearer.sample);
        // Seen from the top ring, the branch comes from its exit on the bearer.
        let back = (at.centre - top.centre).try_normalize().unwrap_or(-top.tangent);
        // Spread of the foot along the bearer's surface, beyond its intersection with the bare tube.
        let spread = 0.8 * top.radius.min(axis.radius);
        let width = circle.sides() + 1;
        let mut collar = Self {
            corners: vec![DVec3::ZERO; width * (steps as usize + 2)],
            normals: vec![DVec3::ZERO; width * (steps as usize + 2)],
            width,
            inside: axis.centre,
        };
        for (j, &corner) in circle.0[..width - 1].iter().enumerate() {
            let ray = top.ray(corner);
            let q = top.centre + ray * top.radius;
            let knee = bearer.surface(hit(q, back, &axis), hint);
            let out = (ray - knee.1 * ray.dot(knee.1)).normalize_or_zero();
            let foot = bearer.below(knee.0 + out * spread, hint);
            // Highest in the crotch, and zero half-way round.
            let hollow = (foot.0 + q - knee.0 * 2.0).normalize_or_zero();
            let raised = hollow * (ridge * spread * out.dot(axis.tangent).max(0.0));
            for k in 0..=steps + 1 {
                // Even steps of the parameter are slightly denser at the knee, where the fillet turns.
                let u = f64::from(k) / f64::from(steps + 1);
                let (a, b, c) = ((1.0 - u) * (1.0 - u), 2.0 * u * (1.0 - u), u * u);
                let ridge = raised * (b * b * 4.0);
                collar.corners[k as usize * width + j] = foot.0 * a + knee.0 * b + q * c + ridge;
            }
            collar.normals[j] = foot.1;
            collar.normals[width * (steps as usize + 1) + j] = top.normal(ray);
        }
        // The last corner of each row equals its first.
        for row in
            [&mut collar.corners, &mut collar.normals].into_iter().flat_map(|c| c.chunks_exact_mut(width))
        {
            row[width - 1] = row[0];
        }
        collar.inner_normals(steps as usize);
        collar
    }

    fn inner_normals(&mut self, steps: usize) {
        let w = self.width;
        for k in 1..=steps {
            for j in 0..w - 1 {
                let (before, after) = (if j == 0 { w - 2 } else { j - 1 }, j + 1);
                let around = self.corners[k * w + after] - self.corners[k * w + before];
                let along = self.corners[(k + 1) * w + j] - self.corners[(k - 1) * w + j];
                let normal = around.cross(along).try_normalize();
                self.normals[k * w + j] = normal.unwrap_or(self.normals[(steps + 1) * w + j]);
            }
            self.normals[(k + 1) * w - 1] = self.normals[k * w];
        }
    }

    /// Writes every row except the last, which is the tube's first ring; and the base that closes it, unless the bearer
    /// is open there.
    pub(crate) fn write(&self, out: &mut Sleeve<'_>, radius: f64, closed: bool) {
        let rows = self.corners.len() / self.width - 1;
        for k in 0..rows {
            let row = k * self.width..(k + 1) * self.width;
            let corners = &self.corners[row.clone()];
            #[expect(clippy::cast_precision_loss, reason = "at most 64 sides")]
            let centre = corners[1..].iter().sum::<DVec3>() / (self.width - 1) as f64;
            out.row(centre, radius, corners, &self.normals[row]);
            if k == 0 && closed {
                out.hidden_base(self.inside, (self.inside - centre).try_normalize().unwrap_or(DVec3::NEG_Y));
            }
        }
    }
}

impl Bearer<'_> {
    /// Returns the point of the bearer's surface nearest to `p`, and the normal there.
    fn surface(&self, p: DVec3, hint: usize) -> (DVec3, DVec3) {
        self.shrunk(p, hint, |_| 1.0)
    }

    /// Returns the same point sunk just below the flat faces, or below the rows of the bearer's own fillet.
    fn below(&self, p: DVec3, hint: usize) -> (DVec3, DVec3) {
        let faces = base::ops::cos(base::ops::PI / f64::from(self.sides.max(3))) * 0.97;
        self.shrunk(p, hint, |s| match s {
            s if s < self.exit => faces * BELOW,
            s if s < self.top => faces * HOLLOW,
            _ => faces,
        })
    }

    /// Returns the point of the surface in the cross-section through `p`, whose radius is a share, by arc length, of
    /// the bearer's.
    fn shrunk(&self, p: DVec3, hint: usize, share: impl Fn(f64) -> f64) -> (DVec3, DVec3) {
        let (near, piece) = self.spine.nearest(p, hint);
        let (at, plane) = self.section(p, piece).unwrap_or((near, near.tangent));
        let d = p - at.centre;
        let out = d - plane * d.dot(plane);
        let ray = out.try_normalize().unwrap_or_else(|| plane.any_orthonormal_vector());
        (at.centre + ray * (at.radius * share(at.s)), (ray - at.tangent * at.slope).normalize())
    }

    /// Returns the cross-section through `p` of the tube as drawn, between oblique rings: its position on the line, and
    /// its normal. Searched from a piece on; `None` before the first ring and beyond the last.
    fn section(&self, p: DVec3, piece: usize) -> Option<(Station, DVec3)> {
        let plane = |k: usize, u: f64| {
            let (a, b) = (self.planes.get(k)?, self.planes.get(k + 1)?);
            let centre = self.spine.p[k].lerp(self.spine.p[k + 1], u);
            let normal = a.lerp(*b, u).try_normalize()?;
            Some(((p - centre).dot(normal), normal))
        };
        let mut k = piece;
        for _ in 0..FARTHEST {
            if plane(k, 0.0)?.0 < 0.0 {
                k = k.checked_sub(1)?;
            } else if plane(k, 1.0)?.0 > 0.0 {
                k += 1;
            } else {
                break;
            }
        }
        // Before the plane of one ring and behind that of the next.
        let (mut low, mut high) = (0.0, 1.0);
        if plane(k, low)?.0 < 0.0 || plane(k, high)?.0 > 0.0 {
            return None;
        }
        // Side of the plane at u of the piece on which p lies: the sign of a quadratic function of u.
        let (from, to) = (p - self.spine.p[k], self.spine.p[k + 1] - self.spine.p[k]);
        let (a, turn) = (self.planes[k], self.planes[k + 1] - self.planes[k]);
        let [c0, c1, c2] = [from.dot(a), from.dot(turn) - to.dot(a), to.dot(turn)];
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if c0 + middle * (c1 - middle * c2) > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        let u = 0.5 * (low + high);
        let s = base::ops::lerp(self.spine.s[k], self.spine.s[k + 1], u);
        Some((self.spine.station(k, s), plane(k, u)?.1))
    }
}

/// Returns the first intersection of the line from `q` along `d` with the cylinder of a station; its nearest point if
/// it misses.
fn hit(q: DVec3, d: DVec3, cylinder: &Station) -> DVec3 {
    let square = |v: DVec3| v - cylinder.tangent * v.dot(cylinder.tangent);
    let (w, a) = (square(q - cylinder.centre), square(d));
    let aa = a.length_squared();
    if aa < 1e-9 {
        return q;
    }
    let b = -w.dot(a) / aa;
    let inside = b * b - (w.length_squared() - cylinder.radius * cylinder.radius) / aa;
    // Beyond 8 radii the line runs along the bearer rather than into it.
    let far = 8.0 * cylinder.radius + (q - cylinder.centre).length();
    q + d * (b - inside.max(0.0).sqrt()).clamp(0.0, far)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rings::{drawn, rings};

    #[test]
    fn foot_lies_inside_the_bearer_and_top_outside() {
        for (angle, thick) in [(1.5, 0.02), (1.0, 0.05), (0.6, 0.08), (0.3, 0.03), (2.3, 0.095)] {
            let (sin, cos) = base::ops::sin_cos(angle);
            let trunk = Spine::new(&[DVec3::ZERO, DVec3::Y * 2.0], &[0.1, 0.1], 100, None).unwrap();
            let dir = DVec3::new(sin, cos, 0.0);
            let branch =
                Spine::new(&[DVec3::Y, DVec3::Y + dir * 1.5], &[thick, thick * 0.6], 100, None).unwrap();
            let bearer = Bearer { spine: &trunk, sample: 50, sides: 8, exit: 0.0, top: 0.0, planes: &[] };
            let circle = Circle::new(8);
            let reach = reach(&branch, &bearer).unwrap();
            let (line, first) = drawn(&branch, Some(&reach), 20.0, |_| f64::INFINITY);
            let rings = rings(&line, first);
            let collar = Collar::new(&reach, &rings[0], &bearer, &circle, (3, 0.0));
            for foot in &collar.corners[..collar.width] {
                let r = (foot.x * foot.x + foot.z * foot.z).sqrt();
                // Inside even the flat faces of the eight-sided bearer.
                assert!(r < 0.1 * base::ops::cos(base::ops::PI / 8.0), "angle {angle}: foot at {r}");
            }
            let top = &collar.corners[collar.corners.len() - collar.width..];
            let clear = (rings[0].centre - trunk.station_at(1.0).centre).length() > 0.1;
            assert!(clear && top.iter().all(|p| p.is_finite()), "angle {angle}: top at {}", rings[0].centre);
        }
    }

    #[test]
    fn branch_that_ends_inside_has_no_collar() {
        let trunk = Spine::new(&[DVec3::ZERO, DVec3::Y * 2.0], &[0.5, 0.5], 100, None).unwrap();
        let twig = Spine::new(&[DVec3::Y, DVec3::new(0.2, 1.0, 0.0)], &[0.01, 0.01], 10, None).unwrap();
        let bearer = Bearer { spine: &trunk, sample: 50, sides: 8, exit: 0.0, top: 0.0, planes: &[] };
        assert!(reach(&twig, &bearer).is_none());
    }
}
