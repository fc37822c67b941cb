//! Leaves on twigs.
//!
//! `twig nodes + phyllotaxis + light -> organs`

use base::ops::sin_cos;
use base::{Draw, Seed, ops};
use glam::DVec3;
use plant::{AxisId, Frame, NodeId, Organ, OrganKind, Paint, Phyllotaxis, Plant, Shape, ShapeId};

use super::grow::{key_of, tangent};
use super::volume::Volume;

/// The look of the leaves of one region.
#[derive(Clone, Debug)]
pub(super) struct Foliage {
    /// Shapes to choose from, each with its length at scale 1; never empty.
    pub(super) shapes: Vec<(ShapeId, f64)>,
    /// Length of a leaf, metres.
    pub(super) length: f64,
    pub(super) phyllotaxis: Phyllotaxis,
    /// Angle between twig and leaf, radians.
    pub(super) insertion: f64,
    /// Strength with which leaves turn to the light, 0 to 1.
    pub(super) light: f64,
    /// Light comes from above, and from the sides away from this point.
    pub(super) core: DVec3,
    /// Most leaves of the region.
    pub(super) most: usize,
}

/// Puts leaves on the nodes of an axis from the share `from` of its length to its tip, and one at the tip.
///
/// No leaf is rooted outside the contour. Stops when the region has its `most` leaves.
pub(super) fn dress(
    plant: &mut Plant,
    volume: &Volume,
    foliage: &Foliage,
    axis: AxisId,
    from: f64,
    placed: &mut usize,
) {
    let (key, nodes) = (plant.axis(axis).key, plant.axis(axis).nodes.clone());
    let n = plant.axis_points(axis).len();
    let start = Seed::new(key).stream(Draw::Phyllotaxis).range(0.0, ops::TAU);
    for i in 1..n {
        let share = i as f64 / (n - 1) as f64;
        if share < from {
            continue;
        }
        let points = plant.axis_points(axis);
        let (at, along) = (points[i], tangent(points, i));
        if !volume.contains_xy(at.truncate()) {
            continue;
        }
        let rank = u32::try_from(i).unwrap_or(u32::MAX);
        let node = NodeId::new(nodes.start as usize + i);
        for (k, azimuth) in foliage.phyllotaxis.azimuths(rank).enumerate() {
            if *placed >= foliage.most {
                return;
            }
            let leaf = Seed::new(key_of(key, u64::from(rank) << 8 | k as u64));
            let organ = organ(foliage, node, at, along, azimuth + start, leaf);
            plant.organs.push(held_in(volume, foliage, organ));
            *placed += 1;
        }
        if i == n - 1 && *placed < foliage.most {
            // The terminal leaf continues the twig.
            let leaf = Seed::new(key_of(key, u64::from(rank) << 8 | 0xff));
            let terminal = Foliage { insertion: 0.2, ..foliage.clone() };
            let organ = organ(&terminal, node, at, along, start, leaf);
            plant.organs.push(held_in(volume, foliage, organ));
            *placed += 1;
        }
    }
}

/// Makes a leaf smaller (at most by half) if its tip would stand out from the contour by more than a third of its
/// length.
fn held_in(volume: &Volume, foliage: &Foliage, mut organ: Organ) -> Organ {
    let reach = |scale: f64| organ.frame.origin + organ.frame.along * (foliage.length * scale);
    for scale in [1.0, 0.75] {
        let over = -volume.clearance(reach(scale).truncate());
        if over > 0.33 * foliage.length {
            organ.scale *= 0.72;
        }
    }
    organ
}

fn organ(foliage: &Foliage, node: NodeId, at: DVec3, twig: DVec3, azimuth: f64, leaf: Seed) -> Organ {
    let mut angle = leaf.stream(Draw::LeafAngle);
    let side = twig.cross(DVec3::Y).try_normalize().unwrap_or_else(|| twig.any_orthonormal_vector());
    let upper = side.cross(twig);
    // Azimuth and inclination scatter by about 12 and 10 degrees in real crowns.
    let (sa, ca) = sin_cos(azimuth + 0.22 * angle.normal());
    let (si, ci) = sin_cos(foliage.insertion + 0.18 * angle.normal());
    let out = (at - foliage.core).normalize_or_zero();
    let mut along = twig * ci + (side * ca + upper * sa) * si;
    // Petioles bend so that blades spread outwards and hang a little rather than stand inside.
    along += out * (0.35 * foliage.light) - DVec3::Y * (0.12 * foliage.light);
    let jitter = DVec3::new(angle.normal(), angle.normal(), angle.normal()) * 0.22;
    let light = DVec3::Y * 0.8 + out * 0.55 + jitter;
    let towards = upper.lerp(light, foliage.light);
    let frame = Frame::looking(at, along, towards);
    let (shape, unit) = foliage.shapes[leaf.stream(Draw::Template).below(foliage.shapes.len())];
    let size = (1.0 + 0.16 * leaf.stream(Draw::Size).normal()).clamp(0.6, 1.4);
    let mut tint = leaf.stream(Draw::Tint);
    let (value, warm) = (tint.range(0.82, 1.12), tint.range(-0.08, 0.1));
    #[expect(clippy::cast_possible_truncation, reason = "colours are f32")]
    let tint = [(value * (1.0 + warm)) as f32, value as f32, (value * (1.0 - warm)) as f32];
    Organ {
        kind: OrganKind::Leaf,
        bearer: Some(node),
        flower: None,
        shape,
        frame,
        scale: (foliage.length * size / unit).max(f64::MIN_POSITIVE),
        paint: Paint::Natural(tint),
        key: leaf.number(),
        source: None,
    }
}

/// Returns a shape with its length; `None` for one without.
pub(super) fn measured(plant: &Plant, shape: ShapeId) -> Option<(ShapeId, f64)> {
    match plant.shapes.get(shape.index()) {
        Some(Shape::Blade(b)) if b.length() > 1e-9 && b.length().is_finite() => Some((shape, b.length())),
        _ => None,
    }
}

/// Returns the median of the lengths of [`measured`] shapes.
pub(super) fn median_length(shapes: &[(ShapeId, f64)]) -> Option<f64> {
    base::median(shapes.iter().map(|(_, l)| *l).collect())
}
