//! Do petals pass through one another? Triangles of different petals that cross.

use glam::DVec3;
use plant::{FlowerId, OrganKind, Plant, Shape};

/// Share of triangles that cross a triangle of another group, 0 to 1; each comes with its group, the petal.
///
/// Touching within 1e-12 of the box's size is no crossing. Cost: about n log n for petals of like fineness.
///
/// ```
/// use glam::DVec3;
/// let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.2, 0.2, -1.0], [0.2, 0.2, 1.0], [0.9, 0.9, 0.0]];
/// let corner = |k: usize| DVec3::from_array(points[k]);
/// let [a, b] = [[0, 1, 2], [3, 4, 5]].map(|t| t.map(corner));
/// assert_eq!(bloom::overlap_share(&[(0, a), (1, b)]), 1.0);
/// assert_eq!(bloom::overlap_share(&[(0, a), (0, b)]), 0.0);
/// ```
pub fn overlap_share(rows: &[(u32, [DVec3; 3])]) -> f64 {
    if rows.is_empty() {
        return 0.0;
    }
    // Sweep along x: candidates are those whose boxes overlap.
    let low = |t: &[DVec3; 3]| t[0].min(t[1]).min(t[2]);
    let high = |t: &[DVec3; 3]| t[0].max(t[1]).max(t[2]);
    let mut order: Vec<usize> = (0..rows.len()).collect();
    base::sort_by(&mut order, |&a, &b| low(&rows[a].1).x.total_cmp(&low(&rows[b].1).x));
    let mut crossed = vec![false; rows.len()];
    let mut open: Vec<usize> = Vec::new();
    for &i in &order {
        let (a, b) = (low(&rows[i].1), high(&rows[i].1));
        open.retain(|&k| high(&rows[k].1).x >= a.x);
        for &k in &open {
            if rows[k].0 == rows[i].0 || (crossed[i] && crossed[k]) {
                continue;
            }
            let (c, d) = (low(&rows[k].1), high(&rows[k].1));
            let apart = c.y > b.y || d.y < a.y || c.z > b.z || d.z < a.z;
            if !apart && crosses(&rows[i].1, &rows[k].1) {
                crossed[i] = true;
                crossed[k] = true;
            }
        }
        open.push(i);
    }
    crossed.iter().filter(|c| **c).count() as f64 / rows.len() as f64
}

/// Share of the triangles of petals and sepals that cross another one's; of one flower, or of all together.
///
/// Only sheets are looked at: petals as they are at a day.
pub fn petal_overlap(plant: &Plant, flower: Option<FlowerId>) -> f64 {
    let mut rows = Vec::new();
    let petals = plant.organs.iter().filter(|o| matches!(o.kind, OrganKind::Petal | OrganKind::Sepal));
    for (petal, organ) in (0..).zip(petals.filter(|o| flower.is_none() || o.flower == flower)) {
        let Some(Shape::Sheet(sheet)) = plant.shapes.get(organ.shape.index()) else { continue };
        let points: Vec<DVec3> = sheet.points.iter().map(|&p| organ.frame.place(p, organ.scale)).collect();
        rows.extend(sheet.triangles().map(|t| (petal, t.map(|k| points[k]))));
    }
    overlap_share(&rows)
}

/// An edge of one passes through the inside of the other.
fn crosses(a: &[DVec3; 3], b: &[DVec3; 3]) -> bool {
    (0..3).any(|k| pierces(a[k], a[(k + 1) % 3], b)) || (0..3).any(|k| pierces(b[k], b[(k + 1) % 3], a))
}

/// Signed volumes: the segment's ends lie on both sides, and the line passes all edges on one side.
fn pierces(p: DVec3, q: DVec3, t: &[DVec3; 3]) -> bool {
    let normal = (t[1] - t[0]).cross(t[2] - t[0]);
    let (dp, dq) = (normal.dot(p - t[0]), normal.dot(q - t[0]));
    let tiny = 1e-12 * normal.length();
    if !((dp > tiny && dq < -tiny) || (dp < -tiny && dq > tiny)) {
        return false;
    }
    let line = q - p;
    let side = |a: DVec3, b: DVec3| line.dot((a - p).cross(b - p));
    let (x, y, z) = (side(t[0], t[1]), side(t[1], t[2]), side(t[2], t[0]));
    (x > 0.0 && y > 0.0 && z > 0.0) || (x < 0.0 && y < 0.0 && z < 0.0)
}
