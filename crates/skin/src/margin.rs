//! Distance of each vertex of a blade from its margin.

use std::collections::BTreeMap;

use glam::DVec3;
use mesh::TriMesh;
use plant::Shape;

use crate::sleeve::wide;

/// Share of a blade's length, from its tip, beyond which the root is cut off and has no margin.
const ROOT: f32 = 0.96;
/// Half widths of a petal between its middle and its tip.
const SLENDER: f32 = 4.0;

/// Returns distances from 0 on the margin to 1 at the farthest place of a blade; of a petal that bends from day to day
/// by its own columns and rows, so that they are constant. Cost: vertices times edges of the margin.
pub(crate) fn from_margin(shape: &Shape, mesh: &TriMesh) -> Vec<f32> {
    if mesh.uvs.len() != mesh.positions.len() {
        return Vec::new();
    }
    if matches!(shape, Shape::Sheet(_)) {
        return mesh.uvs.iter().map(|&[u, v]| (2.0 * u.min(1.0 - u)).min(SLENDER * v).max(0.0)).collect();
    }
    let edges = margin(mesh);
    let at = |i: u32| wide(mesh.positions[i as usize]);
    let distance = |p: DVec3| {
        let far = edges.iter().map(|&(a, b)| from_segment(p, at(a), at(b)));
        far.fold(f64::INFINITY, f64::min)
    };
    let all: Vec<f64> = mesh.positions.iter().map(|&p| distance(wide(p))).collect();
    let most = all.iter().copied().filter(|d| d.is_finite()).fold(0.0, f64::max).max(f64::MIN_POSITIVE);
    #[expect(clippy::cast_possible_truncation, reason = "a texture coordinate")]
    all.iter().map(|d| (d / most).clamp(0.0, 1.0) as f32).collect()
}

/// Returns the edges that belong to only one triangle, except those across the root.
fn margin(mesh: &TriMesh) -> Vec<(u32, u32)> {
    let mut uses: BTreeMap<(u32, u32), u32> = BTreeMap::new();
    for &[a, b, c] in &mesh.triangles {
        for (a, b) in [(a, b), (b, c), (c, a)] {
            *uses.entry((a.min(b), a.max(b))).or_default() += 1;
        }
    }
    let root = |i: u32| mesh.uvs[i as usize][1] > ROOT;
    let margin = |&(a, b): &(u32, u32)| !(root(a) && root(b));
    uses.into_iter().filter(|(edge, n)| *n == 1 && margin(edge)).map(|(edge, _)| edge).collect()
}

fn from_segment(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let along = b - a;
    let length = along.length_squared();
    let at = if length > 0.0 { ((p - a).dot(along) / length).clamp(0.0, 1.0) } else { 0.0 };
    p.distance(a + along * at)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;
    use plant::{Blade, Lift, Relief};

    #[test]
    fn the_margin_of_a_blade_is_0_and_its_middle_1() {
        let half: Vec<DVec2> =
            (0..=12).map(|k| f64::from(k) / 12.0).map(|t| DVec2::new(t * (1.0 - t), t)).collect();
        let mut outline = half.clone();
        outline.extend(half[1..12].iter().rev().map(|p| DVec2::new(-p.x, p.y)));
        let midrib = vec![DVec2::ZERO, DVec2::new(0.0, 0.5), DVec2::Y];
        let blade = Blade {
            outline,
            midrib,
            veins: vec![],
            needles: None,
            lift: Lift::Flat,
            relief: Relief::default(),
        };
        let mesh = crate::blade_mesh(&blade, 200.0);
        let inner = from_margin(&Shape::Blade(blade), &mesh);
        for (p, inner) in mesh.positions.iter().zip(&inner) {
            let (x, y) = (f64::from(p[0]), f64::from(p[1]));
            // Along x the margin is at most this far, and no nearer than its steepness allows.
            let across = (y * (1.0 - y) - x.abs()).max(0.0) / 0.25;
            let inner = f64::from(*inner);
            assert!(
                inner <= across / 0.8 + 0.06 && inner >= 0.55 * across - 0.08,
                "{x} {y}: {inner} of {across}"
            );
        }
        assert!(inner.contains(&1.0) && inner.iter().filter(|&&i| i == 0.0).count() > 10);
    }
}
