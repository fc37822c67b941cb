//! Leaves in space (He and Cheng 2021, section 5.3; docs/papers.md), and drawn outlines as blades.
//!
//! `BladeReading + its bearer -> Blade + Frame`

use base::{Draw, ops};
use glam::{DVec2, DVec3};
use plant::{AxisKind, Blade, BladeVein, Frame, Lift, Organ, OrganKind, Plant, Relief, Shape, ShapeId};
use reading::{BladeReading, VeinReading};

use super::axes::{Part, key_of};
use super::scene::{Bearing, Scene, around_one, sane, usable};
use crate::LeafDepth;

/// Largest slope of a `drawn` leaf out of the plane along its axis: 35 degrees.
const TILT_ALONG: f64 = 35.0 * (ops::PI / 180.0);
/// Largest slope of a `drawn` leaf out of the plane across its axis: 25 degrees.
const TILT_ACROSS: f64 = 25.0 * (ops::PI / 180.0);
/// Least slope along it, 8 degrees: or the plant is a card when seen from the side.
const TILT_LEAST: f64 = 8.0 * (ops::PI / 180.0);
/// Leaflets leave the plane of their leaf by up to 6 degrees.
const UNEVEN: f64 = 6.0 * (ops::PI / 180.0);
/// The disturbance of He and Cheng (2021), section 5.3: uniform within 30 degrees.
const DISTURBED: f64 = 30.0 * (ops::PI / 180.0);

/// A drawn outline in its own frame, metres: root at the origin, tip on +y.
#[derive(Clone, Debug)]
pub(crate) struct LocalBlade {
    pub(crate) outline: Vec<DVec2>,
    pub(crate) midrib: Vec<DVec2>,
    pub(crate) veins: Vec<BladeVein>,
    /// Unit, in the drawing plane.
    pub(crate) right: DVec2,
    pub(crate) along: DVec2,
}

impl LocalBlade {
    /// `mirrored`: the blade's upper side looks away from the viewer; `boldness`: of its stroke. `None` for an outline
    /// without extent.
    pub(crate) fn new(
        blade: &BladeReading,
        metres_per_ink: f64,
        mirrored: bool,
        boldness: impl Fn(Option<u32>) -> f64,
    ) -> Option<Self> {
        let sound = |p: &DVec2| usable(*p);
        let mut outline: Vec<DVec2> = blade.outline.iter().copied().filter(sound).collect();
        outline.dedup();
        if outline.len() < 3 || !sound(&blade.root) {
            return None;
        }
        let root = blade.root;
        let far = |a: DVec2, b: &DVec2| {
            if a.distance_squared(root) >= b.distance_squared(root) { a } else { *b }
        };
        let farthest = outline.iter().fold(root, far);
        let tip = if sound(&blade.tip) && blade.tip.distance(root) > 1e-6 { blade.tip } else { farthest };
        let along = (tip - root).try_normalize().filter(|_| tip.distance(root) > 1e-6)?;
        let turned = DVec2::new(along.y, -along.x);
        let right = if mirrored { -turned } else { turned };
        let local = |p: &DVec2| DVec2::new((*p - root).dot(right), (*p - root).dot(along)) * metres_per_ink;
        let line =
            |points: &[DVec2]| -> Vec<DVec2> { points.iter().filter(|p| sound(p)).map(local).collect() };
        let mut flat: Vec<DVec2> = outline.iter().map(local).collect();
        if mirrored {
            flat.reverse();
        }
        let end = local(&tip);
        let mut midrib = line(&blade.midrib);
        midrib.dedup();
        let near = 0.02 * end.y;
        midrib.retain(|p| p.length() > near && p.distance(end) > near);
        midrib.insert(0, DVec2::ZERO);
        midrib.push(end);
        let vein = |v: &VeinReading| BladeVein { line: line(&v.points), boldness: boldness(v.source) };
        let veins = blade.veins.iter().map(vein).filter(|v| v.line.len() >= 2).collect();
        Some(Self { outline: flat, midrib, veins, right, along })
    }

    pub(crate) fn frame(&self, origin: DVec3) -> Frame {
        let (right, along) = (self.right.extend(0.0), self.along.extend(0.0));
        Frame { origin, right, along, normal: right.cross(along) }
    }
}

/// Returns the key of a blade: its stroke and its rank in that stroke.
pub(crate) fn blade_key(part: Part, blade: &BladeReading, rank: usize, bearer_key: u64) -> u64 {
    key_of(part, blade.source, rank as u64, bearer_key)
}

/// Adds the shape of a drawn leaf, independent of its place. `None` for an outline without extent.
pub(crate) fn leaf_shape(
    plant: &mut Plant,
    scene: &Scene<'_>,
    leaf: &BladeReading,
    key: u64,
) -> Option<(ShapeId, LocalBlade)> {
    let local = LocalBlade::new(leaf, scene.map.metres_per_ink, false, |of| scene.boldness(of))?;
    let seed = scene.seed.child(key);
    let relief = &scene.spec.relief;
    let mut curl = seed.stream(Draw::Curl);
    let drawn = scene.spec.leaf_depth == LeafDepth::Drawn;
    let lift = if drawn { Lift::Tilt { slope: tilt(scene, leaf, &local, key) } } else { Lift::Flat };
    let relief = Relief {
        bend_a: sane(relief.leaf_bend_a, 1.0) * around_one(curl.uniform(), 0.4),
        bend_b: sane(relief.leaf_bend_b, 1.0) * around_one(curl.uniform(), 0.4),
        hollow: 0.0,
        fold: sane(relief.leaf_fold, 2.0) * around_one(curl.uniform(), 0.3),
        wave: 0.008 * curl.uniform(),
        keep_length: !drawn,
    };
    let blade = Blade {
        outline: local.outline.clone(),
        midrib: local.midrib.clone(),
        veins: local.veins.clone(),
        needles: None,
        lift,
        relief,
    };
    Some((plant.add_shape(Shape::Blade(blade)), local))
}

/// Returns the tilt towards the viewer or away: with its compound leaf, as the drawing shows, or else by chance.
fn tilt(scene: &Scene<'_>, leaf: &BladeReading, local: &LocalBlade, key: u64) -> DVec2 {
    let mut s = scene.seed.child(key).stream(Draw::LeafAngle);
    if let Some(rise) = leaf.bearer.and_then(|b| scene.plans.leaflet_gradient(b)) {
        let unevenness = s.range(-UNEVEN, UNEVEN);
        return DVec2::new(rise.dot(local.right), rise.dot(local.along) + ops::tan(unevenness));
    }
    let sign = if s.chance(0.5) { 1.0 } else { -1.0 };
    let by_chance = sign * s.range(TILT_LEAST, TILT_ALONG);
    let along = leaf.front.map_or(by_chance, |front| sane(front, 1.0).clamp(-1.0, 1.0) * TILT_ALONG);
    let across = s.range(-TILT_ACROSS, TILT_ACROSS);
    DVec2::new(ops::tan(across), ops::tan(along))
}

/// Puts a drawn leaf into the plant: at its bearer's depth (or at a given seat), turned by the spec's leaf mode.
pub(crate) fn place_leaf(
    plant: &mut Plant,
    scene: &Scene<'_>,
    leaf: &BladeReading,
    (shape, local): (ShapeId, &LocalBlade),
    key: u64,
    seat: Option<(Bearing, DVec3)>,
) {
    let bearing = match seat {
        Some((b, _)) => Some(b),
        None => scene.bearing(plant, leaf.bearer),
    };
    let seat = seat.map_or_else(|| scene.seat(leaf.root, bearing.as_ref()), |(_, at)| at);
    let link = key_of(Part::Link, None, 0, key);
    let bearer = scene.stalk(plant, bearing.as_ref(), leaf.root, seat, AxisKind::Petiole, link);
    let frame = match scene.spec.leaf_depth {
        LeafDepth::Drawn => local.frame(seat),
        mode => {
            let bearer_along = bearing.map_or(DVec2::Y, |b| b.along);
            let mut s = scene.seed.child(key).stream(Draw::LeafAngle);
            let disturbed = DVec2::new(s.range(-DISTURBED, DISTURBED), s.range(-DISTURBED, DISTURBED));
            let turned = match mode {
                LeafDepth::Signed => {
                    let by_chance = s.chance(0.5);
                    if leaf.front.map_or(by_chance, |f| f > 0.0) { Turned::ToFront } else { Turned::ToBack }
                }
                _ => Turned::AsPrinted,
            };
            light_frame(seat, local.along, bearer_along, disturbed, turned)
        }
    };
    plant.organs.push(Organ {
        kind: OrganKind::Leaf,
        bearer,
        flower: None,
        shape,
        frame,
        scale: 1.0,
        paint: scene.paint(key, leaf.color),
        key,
        source: leaf.source,
    });
}

/// Directions in which the light prior turns a leaf.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Turned {
    /// Every leaf to +X and on towards -Z.
    AsPrinted,
    /// Left leaves stay left, and turn away from the viewer, or towards the viewer: the drawing does not show which.
    ToBack,
    ToFront,
}

/// Returns the frame of the light prior: the blade turns about its axis until it stands on edge, then to the
/// horizontal (but for the first disturbance), then about the plumb line by `phi * pi^(-|cos phi|)` plus the second.
///
/// `va`, `vb`: unit directions of leaf and bearer in the drawing (docs/papers.md).
fn light_frame(origin: DVec3, va: DVec2, vb: DVec2, disturbed: DVec2, turned: Turned) -> Frame {
    let phi = ops::acos_clamped(va.dot(vb));
    let turn = phi * ops::powf(ops::PI, -ops::cos(phi).abs()) + disturbed.y;
    let (lift, level) = ops::sin_cos(disturbed.x);
    let out = if va.x < 0.0 && turned != Turned::AsPrinted { -1.0 } else { 1.0 };
    let azimuth = match turned {
        Turned::AsPrinted => turn,
        Turned::ToBack => out * turn,
        Turned::ToFront => -out * turn,
    };
    let (s, c) = ops::sin_cos(azimuth);
    let about_y = |v: DVec3| DVec3::new(c * v.x + s * v.z, v.y, c * v.z - s * v.x);
    let along = about_y(DVec3::new(out * level, lift, 0.0));
    let normal = about_y(DVec3::new(-out * lift, level, 0.0));
    Frame { origin, right: along.cross(normal), along, normal }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn azimuths_are_those_of_the_paper() {
        // 45 -> 20.0, 60 -> 33.9, 90 -> 90, 135 -> 60.1, 180 -> 57.3 degrees; towards -Z.
        for (phi, want) in
            [(0.0, 0.0), (45.0, 20.0), (60.0, 33.9), (90.0, 90.0), (135.0, 60.1), (180.0, 57.3)]
        {
            let (s, c) = ops::sin_cos(f64::to_radians(phi));
            let f = light_frame(DVec3::ZERO, DVec2::new(s, c), DVec2::Y, DVec2::ZERO, Turned::AsPrinted);
            let got = ops::atan2(-f.along.z, f.along.x).to_degrees();
            assert!((got - want).abs() < 0.06, "{phi}: {got}");
            assert!(f.normal.distance(DVec3::Y) < 1e-12, "horizontal, upper side up");
            assert!((f.right.cross(f.along) - f.normal).length() < 1e-12);
        }
    }

    #[test]
    fn signed_mode_keeps_left_leaves_left() {
        for (va, vb) in [(DVec2::new(-0.8, 0.6), DVec2::Y), (DVec2::new(0.8, 0.6), DVec2::Y)] {
            let f = light_frame(DVec3::ZERO, va, vb, DVec2::new(0.3, -0.2), Turned::ToBack);
            assert!(f.along.x * va.x > 0.0, "{va}");
            let other = DVec2::new(-va.x, va.y);
            let mirrored = light_frame(DVec3::ZERO, other, vb, DVec2::new(0.3, -0.2), Turned::ToBack);
            assert!(
                (f.along.x + mirrored.along.x).abs() < 1e-12 && (f.along.z - mirrored.along.z).abs() < 1e-12
            );
        }
        let left = light_frame(DVec3::ZERO, DVec2::new(-0.8, 0.6), DVec2::Y, DVec2::ZERO, Turned::AsPrinted);
        assert!(left.along.x > 0.0, "as printed, the left leaf lands on the right");
    }

    #[test]
    fn mirrored_blades_keep_their_orientation_and_their_place() {
        let p = DVec2::new;
        let reading = BladeReading {
            outline: vec![p(0.1, 0.1), p(0.3, 0.15), p(0.4, 0.4), p(0.15, 0.3)],
            root: p(0.1, 0.1),
            tip: p(0.4, 0.4),
            midrib: vec![p(0.1, 0.1), p(0.25, 0.3), p(0.4, 0.4)],
            veins: vec![VeinReading { points: vec![p(0.25, 0.3), p(0.3, 0.25)], source: Some(3) }],
            bearer: None,
            whorl: 0,
            front: None,
            source: None,
            color: None,
        };
        for mirrored in [false, true] {
            let local = LocalBlade::new(&reading, 2.0, mirrored, |_| 1.5).expect("a blade");
            let area: f64 = (0..4).map(|i| local.outline[i].perp_dot(local.outline[(i + 1) % 4])).sum();
            assert!(area > 0.0, "counter-clockwise");
            assert_eq!(
                (local.veins.len(), local.veins[0].boldness),
                (1, 1.5),
                "the vein is as bold as it was drawn"
            );
            let f = local.frame(DVec3::ZERO);
            assert_eq!(f.normal.z > 0.0, !mirrored);
            let mut drawn: Vec<DVec2> = local
                .outline
                .iter()
                .map(|q| f.place(q.extend(0.0), 1.0).truncate() / 2.0 + reading.root)
                .collect();
            if mirrored {
                drawn.reverse();
            }
            for (a, b) in drawn.iter().zip(&reading.outline) {
                assert!(a.distance(*b) < 1e-12);
            }
        }
    }
}
