//! A measured leaf -> the bent blade of another maker's plant.

use glam::DVec3;

use crate::blade::Leaf;
use crate::marks::FullMarks;

/// Returns a flat leaf as the blade of another maker's plant: outline, midrib and veins, of length `length_m`.
///
/// The measured relief becomes that of He and Cheng (2021): the bend along the midrib (Eq 5) and the fold of the
/// halves, fitted to the marks by least squares.
pub fn leaf_blade(leaf: &Leaf, marks: &FullMarks, length_m: f64) -> plant::Blade {
    let flat = leaf.blade().flat(3);
    let midrib = flat.midrib();
    let length = midrib.last().map_or(1.0, |tip| tip.length()).max(f64::MIN_POSITIVE);
    let scale = length_m / length;
    let mut outline = flat.outline();
    if geom::self_crossings(&outline) > 0 {
        // A folded or badly measured base overlaps itself when it is laid flat.
        outline = geom::simple_outline(&outline).unwrap_or(outline);
    }
    let scaled = |line: Vec<glam::DVec2>| line.into_iter().map(|p| p * scale).collect::<Vec<_>>();
    let mut relief = plant::Relief { keep_length: true, ..plant::Relief::default() };
    (relief.bend_a, relief.bend_b) = bend_of(marks);
    relief.fold = fold_of(marks);
    plant::Blade {
        outline: scaled(outline),
        midrib: scaled(midrib),
        veins: flat.side_veins().into_iter().map(|v| scaled(v).into()).collect(),
        needles: None,
        lift: plant::Lift::Flat,
        relief,
    }
}

/// Fits A and B of `y = A xi^4 + B xi^2` along minus the normal, for the midrib seen from its root's tangent.
fn bend_of(marks: &FullMarks) -> (f64, f64) {
    let line = marks.midrib();
    let Some(start) = line.get(1).and_then(|p| (*p - line[0]).try_normalize()) else { return (0.0, 0.0) };
    let length = geom::polyline_length3(&line).max(f64::MIN_POSITIVE);
    let up = upper(marks, marks.rows.len() - 1);
    let up = (up - start * up.dot(start)).try_normalize().unwrap_or(DVec3::Y);
    let (mut s44, mut s42, mut s22, mut r4, mut r2) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for p in &line[1..] {
        let d = *p - line[0];
        let (x, y) = (d.dot(start) / length, -d.dot(up) / length);
        let (q, w) = (x * x * x * x, x * x);
        s44 += q * q;
        s42 += q * w;
        s22 += w * w;
        r4 += q * y;
        r2 += w * y;
    }
    let det = s44 * s22 - s42 * s42;
    if det <= 1e-12 * s44 * s22 {
        return (0.0, if s22 > 0.0 { (r2 / s22).clamp(-0.5, 0.8) } else { 0.0 });
    }
    let (a, b) = ((r4 * s22 - r2 * s42) / det, (r2 * s44 - r4 * s42) / det);
    (a.clamp(-0.5, 0.5), b.clamp(-0.5, 0.8))
}

/// Returns the direction of the upper side at a row (from 0 at the tip): across times along.
fn upper(marks: &FullMarks, row: usize) -> DVec3 {
    let r = &marks.rows[row];
    let next = if row == 0 { marks.tip } else { marks.rows[row - 1].points[3] };
    (r.points[0] - r.points[6]).cross(next - r.points[3])
}

/// Returns the mean slope of the halves towards the upper side.
fn fold_of(marks: &FullMarks) -> f64 {
    let (mut rise, mut wide) = (0.0, 0.0);
    for (k, row) in marks.rows.iter().enumerate() {
        let Some(up) = upper(marks, k).try_normalize() else { continue };
        let Some(across) = (row.points[0] - row.points[6]).try_normalize() else { continue };
        for j in [1, 5] {
            let d = row.points[j] - row.points[3];
            rise += d.dot(up) * d.dot(across).abs();
            wide += d.dot(across) * d.dot(across);
        }
    }
    if wide > 0.0 { (rise / wide).clamp(-1.0, 1.0) } else { 0.0 }
}
