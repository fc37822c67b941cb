//! Growth of one axis towards its attraction point, and the places where further ones may start.
//!
//! He and Cheng (2021), Eq 2: `p' = p + r (k_p v_p + k_b v_b + k_m v_m)`, all three directions unit vectors.

use base::Stream;
use glam::{DVec2, DVec3};
use plant::{AxisId, AxisKind, NodeId, Plant};

use super::volume::Volume;
use crate::FillSpec;

/// A place where an axis may start.
#[derive(Clone, Copy, Debug)]
pub(super) struct Site {
    pub(super) node: NodeId,
    pub(super) at: DVec3,
    /// Unit direction of its axis.
    pub(super) tangent: DVec3,
    /// 0 trunk, 1 limb, 2 branch, 3 twig: distance from the trunk, counted in axes grown here.
    pub(super) level: u32,
    /// Arc length from the trunk's entry, metres.
    pub(super) path: f64,
    /// Number of axes that already start here.
    pub(super) used: u32,
    /// Distinguishes the contours of one drawn axis: 0 for a grown axis.
    pub(super) salt: u64,
}

/// Adds the inner nodes of an axis to `sites`.
pub(super) fn add_sites(plant: &Plant, axis: AxisId, level: u32, path: f64, sites: &mut Vec<Site>) {
    let points = plant.axis_points(axis);
    let mut at = path;
    for (i, node) in plant.axis(axis).node_ids().enumerate().skip(1) {
        at += points[i].distance(points[i - 1]);
        sites.push(Site {
            node,
            at: points[i],
            tangent: tangent(points, i),
            level,
            path: at,
            used: 0,
            salt: 0,
        });
    }
}

/// Returns the unit direction of a line at one of its points; up if it has none.
pub(super) fn tangent(points: &[DVec3], i: usize) -> DVec3 {
    let (a, b) = (points[i.saturating_sub(1)], points[(i + 1).min(points.len() - 1)]);
    (b - a).try_normalize().unwrap_or(DVec3::Y)
}

/// Returns the right-hand side of Eq 2 without the step: the pull, the direction of the bearer, the last direction.
pub(super) fn eq2(spec: &FillSpec, pull: DVec3, bearer: DVec3, last: DVec3) -> DVec3 {
    spec.contour_pull * pull + spec.bearer_pull * bearer + spec.memory * last
}

/// Grows from `from` to the attraction point `target` by Eq 2 in steps of `step`, inside `volume`.
///
/// The bearer's pull fades along the way, so that the axis leaves along its bearer and arrives at its target. Not
/// guaranteed: that it arrives; it ends if the contour is in the way. `out` starts with `from`.
pub(super) fn grow_toward(
    volume: &Volume,
    spec: &FillSpec,
    (from, bearer): (DVec3, DVec3),
    target: DVec3,
    step: f64,
    wobble: &mut Stream,
    out: &mut Vec<DVec3>,
) {
    out.clear();
    out.push(from);
    let whole = from.distance(target);
    if !(whole > 0.0 && step > 0.0) {
        return;
    }
    let (mut p, mut last) = (from, bearer);
    // At most three times the straight distance: a longer way has lost its target.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "bounded by min")]
    let steps = (3.0 * whole / step).ceil().min(200.0) as usize;
    for _ in 0..steps {
        let to = target - p;
        let left = to.length();
        if left <= 1.3 * step {
            push_inside(volume, p, target, out);
            return;
        }
        let fade = (left / whole).min(1.0);
        let fade = fade * fade;
        let noise = DVec3::new(wobble.normal(), wobble.normal(), wobble.normal()) * 0.05;
        let sum = eq2(spec, to / left, bearer * fade, last) + DVec3::Y * (spec.tropism * fade) + noise;
        last = sum.try_normalize().unwrap_or(to / left);
        let Some(q) = push_inside(volume, p, p + last * step, out) else {
            return;
        };
        p = q;
    }
}

/// The contour of a region, turned about one place of a bearer: it attracts a twig that starts there.
///
/// The drawing shows the contour in its plane only. A twig that leaves its bearer towards the viewer is attracted by
/// the same contour, turned about the bearer to the twig's side.
#[derive(Clone, Debug)]
pub(super) struct Turned(Vec<DVec3>);

impl Turned {
    /// Collects the attraction points `rim` on the side of `out`, a unit vector across the bearer, and not behind the
    /// place: the nearest of those behind would pull against the bearer, and the twig would curl up. All points if
    /// there are none.
    pub(super) fn new(rim: &[DVec2], (from, bearer): (DVec3, DVec3), out: DVec3) -> Self {
        let along = bearer.truncate().try_normalize().unwrap_or(DVec2::Y);
        let right = if out.truncate().perp_dot(along) < 0.0 { -1.0 } else { 1.0 };
        let turned = |q: &DVec2| {
            let way = *q - from.truncate();
            let (ahead, aside) = (way.dot(along), way.perp_dot(along) * right);
            // Samples lie a few degrees apart: there need not be one level with the place.
            (aside > 0.0 && ahead > -0.06 * aside).then(|| from + (along * ahead).extend(0.0) + out * aside)
        };
        let points: Vec<DVec3> = rim.iter().filter_map(turned).collect();
        if points.is_empty() { Self(rim.iter().map(|q| q.extend(from.z)).collect()) } else { Self(points) }
    }

    /// Returns the attraction point nearest to `p`.
    fn nearest(&self, p: DVec3) -> Option<DVec3> {
        self.0.iter().copied().min_by(|a, b| a.distance_squared(p).total_cmp(&b.distance_squared(p)))
    }
}

/// Grows from `from` by Eq 2 as in He and Cheng (2021): each step goes towards the currently nearest attraction point
/// of the contour, until the contour is `near`. `out` starts with `from`.
///
/// As in the paper, the bearer pulls all along. Every step has the length `step`: their rate r over the length of the
/// sum.
pub(super) fn grow_to_contour(
    volume: &Volume,
    spec: &FillSpec,
    (from, bearer): (DVec3, DVec3),
    contour: &Turned,
    (step, near): (f64, f64),
    wobble: &mut Stream,
    out: &mut Vec<DVec3>,
) {
    out.clear();
    out.push(from);
    let (mut p, mut last) = (from, bearer);
    // Three times across the body: a longer twig runs along the contour.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "bounded by min")]
    let steps = (6.0 * volume.inradius.max(volume.half_width) / step.max(1e-12)).ceil().min(200.0) as usize;
    for _ in 0..steps {
        let Some(to) = contour.nearest(p).map(|q| q - p) else { return };
        let left = to.length();
        if left < near {
            return;
        }
        let noise = DVec3::new(wobble.normal(), wobble.normal(), wobble.normal()) * 0.05;
        let sum = eq2(spec, to / left, bearer, last) + DVec3::Y * spec.tropism + noise;
        last = sum.try_normalize().unwrap_or(to / left);
        let Some(q) = push_inside(volume, p, p + last * step, out) else { return };
        p = q;
        if volume.contains_xy(p.truncate()) && volume.inset(p) < 0.5 * near {
            return;
        }
    }
}

/// Appends `q` if the segment from `p` stays inside the contour, else the nearest inner point for which it does.
fn push_inside(volume: &Volume, p: DVec3, mut q: DVec3, out: &mut Vec<DVec3>) -> Option<DVec3> {
    let entering = !volume.contains_xy(p.truncate());
    if !entering && !volume.contains_xy(q.truncate()) {
        let wall = volume.nearest_xy(q.truncate());
        let back = wall + (wall - q.truncate()).normalize_or_zero() * volume.cell();
        q = back.extend(q.z);
        if !volume.contains_xy(back) {
            return None;
        }
    }
    if !entering {
        let xy = q.truncate();
        let (mid, half) = (volume.mid(xy), volume.half_depth(xy));
        q.z = q.z.clamp(mid - half, mid + half);
        let crosses = [0.25, 0.5, 0.75].iter().any(|&t| !volume.contains_xy(p.lerp(q, t).truncate()));
        if crosses || p.distance(q) < 1e-3 * volume.cell() {
            return None;
        }
    }
    out.push(q);
    Some(q)
}

/// Returns the site from which `target` is best reached, or `None` if none is fit.
///
/// Cost: the distance to the target, increased if the angle of departure is not within 25 to 75 degrees, if many axes
/// start there already, or if the contour is in between; plus a share of the path back to the trunk (balancing factor
/// of Cuntz et al. 2010), which keeps detours short.
pub(super) fn attach(volume: &Volume, sites: &[Site], target: DVec3, avoid_level: u32) -> Option<usize> {
    let mut best: Option<(f64, usize)> = None;
    for (i, s) in sites.iter().enumerate() {
        let to = target - s.at;
        let bound = best.map_or(f64::INFINITY, |(c, _)| c);
        // No cost is less than the distance itself: most sites end here, without a root.
        let d2 = to.length_squared();
        if d2 < 1e-18 || d2 >= bound * bound {
            continue;
        }
        let d = d2.sqrt();
        let c = to.dot(s.tangent) / d;
        // cos 75 = 0.26, cos 25 = 0.91.
        let angle = 2.0 * (0.26 - c).max(0.0) + 2.0 * (c - 0.91).max(0.0);
        let level = if s.level <= avoid_level { 0.5 } else { 0.0 };
        let mut cost = d * (1.0 + angle + level + 0.35 * f64::from(s.used)) + 0.2 * s.path;
        if cost < bound && !volume.sees(s.at.truncate(), target.truncate()) {
            cost += 3.0 * d;
        }
        if cost < bound {
            best = Some((cost, i));
        }
    }
    best.map(|(_, i)| i)
}

/// Adds an axis that starts at a site; `None` for fewer than 2 points.
pub(super) fn add_axis(
    plant: &mut Plant,
    site: &mut Site,
    kind: AxisKind,
    points: &[DVec3],
) -> Option<AxisId> {
    if points.len() < 2 {
        return None;
    }
    let key = child_key(plant, site);
    Some(plant.add_axis(kind, Some(site.node), key, points, None))
}

/// Returns the next key of an axis that starts at a site: from the bearer's key, the node's rank on it and the birth
/// rank there.
pub(super) fn child_key(plant: &Plant, site: &mut Site) -> u64 {
    let bearer = plant.axis(plant.nodes.axis[site.node.index()]);
    let rank = u64::from(site.node.raw() - bearer.nodes.start);
    let key = key_of(bearer.key, site.salt << 48 | rank << 16 | u64::from(site.used & 0xffff));
    site.used += 1;
    key
}

/// Returns a key from the bearer's key and the birth rank.
pub(super) const fn key_of(bearer: u64, rank: u64) -> u64 {
    base::Seed::new(bearer).child(rank).number()
}
