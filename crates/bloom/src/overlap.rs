//! Finds intersections of parts of a flower: triangles of different parts that cross.

use base::ops;
use glam::DVec3;
use plant::{FlowerId, OrganKind, Plant, Shape};

/// A triangle and the part that it belongs to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartTriangle {
    /// The part. Stem, stalks and receptacle are one, 0; so are a stamen and its anther, and the disc of a head.
    pub part: u32,
    /// Kind of its organ; `None` for a stem.
    pub kind: Option<OrganKind>,
    /// Whether it is the foot of its part, which grows out of the stem.
    pub foot: bool,
    /// Its corners, metres.
    pub corners: [DVec3; 3],
}

/// The part of stem, stalks and receptacles.
const STEM: u32 = 0;
/// Sides of a strand or stem in the measurement.
const SIDES: u32 = 6;

/// Returns the share of triangles that cross a triangle of another group, 0 to 1; each comes with its group, the petal.
///
/// Touching within 1e-12 of the box's size does not count. Cost: about n log n for petals of similar resolution.
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
    let rows: Vec<PartTriangle> = rows
        .iter()
        .map(|&(part, corners)| PartTriangle { part: part + 1, kind: None, foot: false, corners })
        .collect();
    share(&crossed(&rows))
}

fn share(crossed: &[Option<usize>]) -> f64 {
    crossed.iter().flatten().count() as f64 / crossed.len().max(1) as f64
}

/// Returns for each triangle one of another part that it crosses, if any. The foot of a part may lie in the stem.
pub fn crossed(rows: &[PartTriangle]) -> Vec<Option<usize>> {
    let mut crossed = vec![None; rows.len()];
    let low = |t: &[DVec3; 3]| t[0].min(t[1]).min(t[2]);
    let high = |t: &[DVec3; 3]| t[0].max(t[1]).max(t[2]);
    let boxes: Vec<(DVec3, DVec3)> = rows.iter().map(|r| (low(&r.corners), high(&r.corners))).collect();
    let (bottom, top) = boxes
        .iter()
        .filter(|b| b.0.is_finite() && b.1.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x.0.y), b.max(x.1.y)));
    // Slices of the height, and in each a sweep along x: candidates have overlapping boxes.
    const SLICES: usize = 160;
    let thick = ((top - bottom) / SLICES as f64).max(1e-12);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to SLICES")]
    let slice = |y: f64| (((y - bottom) / thick).clamp(0.0, SLICES as f64) as usize).min(SLICES - 1);
    let mut slices: Vec<Vec<usize>> = vec![Vec::new(); SLICES];
    for (i, b) in boxes.iter().enumerate().filter(|(_, b)| b.0.is_finite() && b.1.is_finite()) {
        slices[slice(b.0.y)..=slice(b.1.y)].iter_mut().for_each(|s| s.push(i));
    }
    for order in &mut slices {
        base::sort_by(order, |&a, &b| boxes[a].0.x.total_cmp(&boxes[b].0.x));
        let mut open: Vec<usize> = Vec::new();
        for &i in order.iter() {
            let (a, b) = boxes[i];
            open.retain(|&k| boxes[k].1.x >= a.x);
            for &k in &open {
                let (p, q) = (&rows[i], &rows[k]);
                let grown = (p.foot && q.part == STEM) || (q.foot && p.part == STEM);
                if p.part == q.part || grown || (crossed[i].is_some() && crossed[k].is_some()) {
                    continue;
                }
                let (c, d) = boxes[k];
                let apart = c.y > b.y || d.y < a.y || c.z > b.z || d.z < a.z;
                if !apart && crosses(&p.corners, &q.corners) {
                    crossed[i] = Some(k);
                    crossed[k] = Some(i);
                }
            }
            open.push(i);
        }
    }
    crossed
}

/// Returns the share of the triangles of all parts that cross another part's; of one flower, or of the whole plant with
/// its stems and leaves.
pub fn part_overlap(plant: &Plant, flower: Option<FlowerId>) -> f64 {
    share(&crossed(&part_triangles(plant, flower)))
}

/// Returns the triangles of all parts: petals, sepals, stamens, pistil, disc, fruit, receptacle; if no flower is given
/// also leaves and stems. The same rows on every day of a flower.
pub fn part_triangles(plant: &Plant, flower: Option<FlowerId>) -> Vec<PartTriangle> {
    let mut rows = Vec::new();
    let mut part = STEM;
    let mut before: Option<(OrganKind, Option<FlowerId>)> = None;
    for organ in plant.organs.iter().filter(|o| flower.is_none() || o.flower == flower) {
        let kind = organ.kind;
        let same = before.is_some_and(|(last, of)| of == organ.flower && joined(last, kind));
        before = Some((kind, organ.flower));
        let shape = plant.shapes.get(organ.shape.index());
        let petiole = kind == OrganKind::Leaf && matches!(shape, Some(Shape::Strand { .. }));
        if !same {
            part += 1;
        }
        let own = if kind == OrganKind::Pedicel || petiole { STEM } else { part };
        match shape {
            Some(Shape::Sheet(sheet)) => {
                let points: Vec<DVec3> =
                    sheet.points.iter().map(|&p| organ.frame.place(p, organ.scale)).collect();
                let first = 2 * (sheet.across.len() - 1);
                rows.extend(sheet.triangles().enumerate().map(|(i, t)| PartTriangle {
                    part: own,
                    kind: Some(kind),
                    foot: i < first,
                    corners: t.map(|k| points[k]),
                }));
            }
            Some(Shape::Strand { path, radius_m, .. }) => {
                let line: Vec<DVec3> = path.iter().map(|&p| organ.frame.place(p, organ.scale)).collect();
                let foot = !matches!(kind, OrganKind::Anther);
                tube(&mut rows, (own, Some(kind)), &line, |k| radius_m[k] * organ.scale, foot);
            }
            _ => {}
        }
    }
    if flower.is_none() {
        for axis in &plant.axes {
            let nodes = axis.nodes.start as usize..axis.nodes.end as usize;
            let radii = &plant.nodes.radius_m[nodes.clone()];
            tube(&mut rows, (STEM, None), &plant.nodes.position[nodes], |k| radii[k], false);
        }
    }
    rows
}

/// Whether consecutive organs are one part: an anther on its filament, a pistil on its ovary, florets on their disc, a
/// parachute on its fruit.
const fn joined(last: OrganKind, next: OrganKind) -> bool {
    use OrganKind::{Anther, Disc, Floret, Fruit, Pistil, Stamen};
    matches!((last, next), (Stamen, Anther) | (Fruit, Pistil) | (Disc | Floret, Floret) | (Fruit, Floret))
}

/// Adds a strand as a tube of few sides.
fn tube(
    rows: &mut Vec<PartTriangle>,
    (part, kind): (u32, Option<OrganKind>),
    line: &[DVec3],
    radius: impl Fn(usize) -> f64,
    foot: bool,
) {
    let ring = |k: usize| -> Vec<DVec3> {
        let (a, b) = (line[k.saturating_sub(1)], line[(k + 1).min(line.len() - 1)]);
        let along = (b - a).try_normalize().unwrap_or(DVec3::Y);
        let right = along.cross(DVec3::new(0.36, 0.48, 0.8)).try_normalize().unwrap_or(DVec3::X);
        let up = along.cross(right);
        let corner = |j: u32| {
            let (s, c) = ops::sin_cos(ops::TAU * f64::from(j) / f64::from(SIDES));
            line[k] + (right * c + up * s) * radius(k)
        };
        (0..SIDES).map(corner).collect()
    };
    let rings: Vec<Vec<DVec3>> = (0..line.len()).map(ring).collect();
    for (k, pair) in rings.windows(2).enumerate() {
        let (a, b) = (&pair[0], &pair[1]);
        for j in 0..a.len() {
            let next = (j + 1) % a.len();
            for corners in [[a[j], b[j], a[next]], [a[next], b[j], b[next]]] {
                rows.push(PartTriangle { part, kind, foot: foot && k == 0, corners });
            }
        }
    }
}

/// Whether an edge of one passes through the inside of the other.
fn crosses(a: &[DVec3; 3], b: &[DVec3; 3]) -> bool {
    (0..3).any(|k| pierces(a[k], a[(k + 1) % 3], b)) || (0..3).any(|k| pierces(b[k], b[(k + 1) % 3], a))
}

/// Tests by signed volumes: the segment's ends lie on both sides, and the line passes all edges on one side.
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
