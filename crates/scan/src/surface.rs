//! Distance between the wood of two plants.

use base::ops;
use geom::KdTree;
use glam::DVec3;
use plant::{AxisId, Plant};

/// Distances from the surface of one plant's wood to that of another, metres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Gap {
    /// Mean distance.
    pub mean: f64,
    /// Median distance.
    pub median: f64,
    /// 95 % quantile of the distances.
    pub p95: f64,
    /// Greatest distance.
    pub max: f64,
}

/// Measures from the surface of the wood of `from` to that of `to`, at places about `step` metres apart; none if
/// either has no wood. Only wood of `from` with a radius of at least `least_radius_m` counts.
///
/// Each distance is that to the tangent plane at the nearest place of the other surface. Cost: n log n in places.
pub fn wood_gap(from: &Plant, to: &Plant, step: f64, least_radius_m: f64) -> Option<Gap> {
    let (a, _) = places(from, step, least_radius_m);
    let (b, normals) = places(to, 0.7 * step, 0.0);
    if a.is_empty() || b.is_empty() {
        return None;
    }
    let tree = KdTree::new(&b);
    let mut all: Vec<f64> = a
        .iter()
        .filter_map(|p| {
            let k = tree.nearest(*p, f64::INFINITY)?;
            let d = *p - b[k];
            // The surface continues around a place as its plane; farther away, the distance to the place itself
            // counts.
            let flat = (d - normals[k] * d.dot(normals[k])).length();
            Some(if flat < step { d.dot(normals[k]).abs() } else { d.length() })
        })
        .collect();
    base::sort_numbers(&mut all);
    let at = |share: f64| {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a row")]
        let row = (share * (all.len() - 1) as f64) as usize;
        all[row]
    };
    Some(Gap {
        mean: all.iter().sum::<f64>() / all.len() as f64,
        median: at(0.5),
        p95: at(0.95),
        max: at(1.0),
    })
}

/// Returns places on the surface of wood, about `step` metres apart.
pub(crate) fn surface_places(plant: &Plant, step: f64) -> Vec<DVec3> {
    places(plant, step, 0.0).0
}

/// Returns places on the surface of wood, with their normals.
fn places(plant: &Plant, step: f64, least: f64) -> (Vec<DVec3>, Vec<DVec3>) {
    let (mut points, mut normals) = (vec![], vec![]);
    for id in (0..plant.axes.len()).map(AxisId::new) {
        let (line, radii) = (plant.axis_points(id), plant.axis_radii(id));
        let first = usize::from(plant.axis(id).bearer.is_some());
        for i in first..line.len().saturating_sub(1) {
            let (a, b) = (line[i], line[i + 1]);
            let Some(along) = (b - a).try_normalize() else { continue };
            if 0.5 * (radii[i] + radii[i + 1]) < least {
                continue;
            }
            let (u, v) = along.any_orthonormal_pair();
            let steps = count((b - a).length() / step);
            for k in 0..steps {
                let t = (k as f64 + 0.5) / steps as f64;
                let r = ops::lerp(radii[i], radii[i + 1], t);
                let around = count(ops::TAU * r / step).max(4);
                for j in 0..around {
                    let (sin, cos) =
                        ops::sin_cos(ops::TAU * (j as f64 + 0.5 * (k % 2) as f64) / around as f64);
                    let n = u * cos + v * sin;
                    points.push(a.lerp(b, t) + n * r);
                    normals.push(n);
                }
            }
        }
    }
    (points, normals)
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not negative, and few")]
fn count(x: f64) -> usize {
    (x.ceil() as usize).max(1)
}
