//! Line drawings of plants, as a person would draw them from life.
//!
//! `Plant, Model -> visible parts from the front -> stems and outlines, or limbs and the outline of the crown`

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use base::{Cancelled, Run, ops};
use glam::{DVec2, DVec3};
use ink::{Drawing, Layer, Stroke};
use mesh::{Model, Part};
use plant::{AxisKind, NodeId, OrganKind, Plant};
use render::{PictureSpec, View};
use skin::{Layout, NOTHING, triangle_labels};

/// Most visible organs of a plant that are drawn one by one.
const MOST_ORGANS: usize = 60;
/// Most limbs that are drawn in addition to the trunk.
const MOST_LIMBS: usize = 12;
/// Least radius of a limb that is drawn, as a share of the radius at the foot of the trunk.
const THICK: f64 = 0.12;
/// Order of the finest limbs that are drawn.
const FINEST_LIMB: u32 = 2;
/// Least visible share of a limb that is drawn.
const BARE: f64 = 0.5;
/// Foliage that covers more than this share of its outline hides the parts inside.
const DENSE: f64 = 0.4;
/// Height to which a trunk continues into the foliage, as a share of the foliage's height.
const BEHIND: f64 = 0.1;
/// Least area of an organ that is drawn, as a share of the picture: a smaller one is a detail.
const LARGE: f64 = 0.0003;
/// Width above which wood is drawn by its two edges, as a share of the plant's size.
const WIDE: f64 = 0.025;
/// Least visible share of an organ's outline area: an organ that shows less is behind others.
const SEEN: f64 = 0.2;
/// Number of directions in which the reach of a crown is measured.
const SECTORS: usize = 48;
/// Width in pixels of the picture that determines visibility.
const PIXELS: u32 = 768;
/// A rim that spans this share of an organ, in both directions, goes around it.
const AROUND: f64 = 0.9;
/// Tolerance of lines, as a share of the plant's size.
const FINE: f64 = 0.002;
/// Largest width over length of an organ drawn as a line.
const SLENDER: f64 = 0.25;
/// Number of pieces of a slender organ whose middles make its line.
const PIECES: usize = 6;
/// Distance in metres below which two places are one: a seam is not a rim.
const SAME_M: f64 = 1e-9;

/// Subject of a line of a drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DrawnKind {
    /// A stem, a trunk or a branch: along its middle, or around it.
    Axis,
    /// A thin organ, along its middle.
    Stalk,
    /// The outline of an organ.
    Blade,
    /// The outline of all foliage.
    Crown,
}

impl DrawnKind {
    /// Returns the word for it; in a file it is the layer.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Axis => "axis",
            Self::Stalk => "stalk",
            Self::Blade => "blade",
            Self::Crown => "crown",
        }
    }
}

/// A line of a drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnLine {
    /// Its subject.
    pub kind: DrawnKind,
    /// Points in metres, x to the right, y upwards; the plant stands at the origin. An outline ends where it starts.
    pub points: Vec<DVec2>,
    /// Row of its axis or organ; [`NOTHING`] for a crown.
    pub row: i32,
}

/// Draws a plant from the front, as lines in the order in which a person draws: wood and stems, then organs from
/// behind.
///
/// Stems and branches are lines along their middle, thick wood is a line along both its edges. Visible organs are
/// outlines; of a plant that shows many, trunk and limbs are drawn as far as foliage does not hide them, and the
/// outline of the crown around the foliage. `layout`: of this model.
///
/// Guaranteed: the same bits for any executor. Not guaranteed: that the program reads the same plant from it. Cost:
/// that of a picture of 768 x 768 pixels.
///
/// # Errors
/// [`Cancelled`] when the run was cancelled.
pub fn drawn(
    (plant, model, layout): (&Plant, &Model, &Layout),
    run: &Run<'_>,
) -> Result<Vec<DrawnLine>, Cancelled> {
    let labels = triangle_labels(plant, model, layout);
    let front = PictureSpec {
        width: PIXELS,
        height: PIXELS,
        view: View::Front,
        supersample: 1,
        ..PictureSpec::default()
    };
    let framed = f64::from(PIXELS) * (1.0 - 2.0 * front.margin);
    let hits = render::hits(model, &[front], run)?;
    let size = size(model);
    let sheet = Sheet { plant, size, fine: FINE * size, pixel: size / framed };
    let (mut organs, mut wood) = (BTreeMap::new(), BTreeMap::new());
    for hit in hits.iter().flatten() {
        let label = labels.get(hit.part as usize).and_then(|part| part.get(hit.triangle as usize));
        match label {
            Some(&[_, _, organ]) if organ != NOTHING => *organs.entry(organ).or_insert(0_u32) += 1,
            Some(&[_, axis, _]) if axis != NOTHING => *wood.entry(axis).or_insert(0_u32) += 1,
            _ => {}
        }
    }
    // Roots are not part of the plant's outline.
    let above = |row: i32| usize::try_from(row).is_ok_and(|i| plant.axes[i].kind != AxisKind::Root);
    wood.retain(|axis, _| above(*axis));
    let all: u32 = organs.values().sum();
    organs.retain(|_, count| f64::from(*count) >= LARGE * f64::from(PIXELS * PIXELS));
    if organs.len() <= MOST_ORGANS && 2 * organs.values().sum::<u32>() >= all {
        let stems: Vec<(i32, f64)> = wood.keys().map(|axis| (*axis, f64::INFINITY)).collect();
        let mut lines = sheet.stems(&stems);
        lines.extend(sheet.organs(model, &labels, &organs));
        return Ok(lines);
    }
    let crown = crown(plant);
    let covered = f64::from(all) * sheet.pixel * sheet.pixel;
    let hidden = (covered > DENSE * geom::signed_area(&crown).abs()).then_some(&*crown);
    let mut lines = sheet.stems(&sheet.limbs(&wood, hidden));
    lines.push(DrawnLine { kind: DrawnKind::Crown, points: crown, row: NOTHING });
    Ok(lines)
}

/// Makes a drawing of lines: each lies on the layer of its word.
pub fn drawing_of<'a>(name: &str, lines: impl IntoIterator<Item = (&'a str, Vec<DVec2>)>) -> Drawing {
    let mut drawing = Drawing { name: name.to_owned(), ..Drawing::default() };
    for (word, line) in lines {
        let layer: Arc<str> = word.into();
        if drawing.layers.iter().all(|l| l.name != layer) {
            drawing.layers.push(Layer { name: Arc::clone(&layer), ..Layer::default() });
        }
        let samples = line.into_iter().map(Into::into).collect();
        drawing.strokes.push(Stroke { samples, layer: Some(layer), ..Stroke::default() });
    }
    drawing
}

/// Returns the largest extent of a model, metres.
fn size(model: &Model) -> f64 {
    let points = || model.parts.iter().flat_map(|part| &part.mesh.positions);
    let extent = |axis: usize| {
        let (mut low, mut high) = (f32::INFINITY, f32::NEG_INFINITY);
        for point in points() {
            (low, high) = (low.min(point[axis]), high.max(point[axis]));
        }
        f64::from(high - low)
    };
    (0..3).map(extent).fold(SAME_M, f64::max)
}

/// The plant that is drawn, and its size.
struct Sheet<'a> {
    plant: &'a Plant,
    /// Largest extent of the plant, metres.
    size: f64,
    /// Tolerance of its lines, metres.
    fine: f64,
    /// Side of a pixel of the picture, metres: the picture holds the whole plant, with a margin.
    pixel: f64,
}

impl Sheet<'_> {
    /// Draws axes as lines from their bearers to their tips, or to the height given with each; around those that are
    /// thick.
    fn stems(&self, rows: &[(i32, f64)]) -> Vec<DrawnLine> {
        let line = |&(row, end): &(i32, f64)| {
            let axis = self.plant.axes.get(usize::try_from(row).ok()?)?;
            let nodes = axis.bearer.into_iter().chain(axis.node_ids());
            let (whole, radii): (Vec<DVec2>, Vec<f64>) = nodes
                .map(|n| {
                    (self.plant.nodes.position[n.index()].truncate(), self.plant.nodes.radius_m[n.index()])
                })
                .unzip();
            let mut points: Vec<DVec2> = whole.iter().copied().take_while(|p| p.y <= end).collect();
            let cut = points.len();
            if let (Some(last), Some(next)) = (points.last().copied(), whole.get(cut)) {
                points.push(last.lerp(*next, (end - last.y) / (next.y - last.y)));
            }
            if points.len() < 2 || extent(&points).max_element() <= self.fine {
                return None;
            }
            let is_thick = axis.kind == AxisKind::Branch && 2.0 * radii[points.len() / 4] > WIDE * self.size;
            if is_thick {
                let beside: Vec<DVec2> = (0..points.len())
                    .map(|k| {
                        let (before, after) = (k.saturating_sub(1), (k + 1).min(points.len() - 1));
                        let along = points[after] - points[before];
                        along.try_normalize().unwrap_or_default().perp() * radii[k]
                    })
                    .collect();
                let left = points.iter().zip(&beside).map(|(p, b)| *p + *b);
                let right = points.iter().zip(&beside).map(|(p, b)| *p - *b);
                // Wood that continues behind foliage is open at its upper end, other wood at its foot.
                points = if cut < whole.len() {
                    left.rev().chain(right).collect()
                } else {
                    left.chain(right.rev()).collect()
                };
            }
            Some(DrawnLine { kind: DrawnKind::Axis, points: geom::simplify(&points, self.fine), row })
        };
        rows.iter().filter_map(line).collect()
    }

    /// Returns trunks, and the longest of the thick limbs that foliage does not hide, with the heights at which they
    /// end: a trunk a little above the edge of the foliage that hides it. `seen`: pixels of each axis.
    fn limbs(&self, seen: &BTreeMap<i32, u32>, foliage: Option<&[DVec2]>) -> Vec<(i32, f64)> {
        let (axes, nodes) = (&self.plant.axes, &self.plant.nodes);
        let foot = |axis: &plant::Axis| nodes.radius_m.get(axis.nodes.start as usize).copied().unwrap_or(0.0);
        let thick = THICK * axes.iter().filter(|a| a.order == 0).map(foot).fold(0.0, f64::max);
        let (mut trunks, mut limbs, mut hidden) = (Vec::new(), Vec::new(), BTreeSet::new());
        for (row, axis) in (0_i32..).zip(axes) {
            if axis.order == 0 {
                let place = |n: NodeId| nodes.position[n.index()].truncate();
                let inside = |crown| axis.node_ids().map(place).find(|p| geom::contains(crown, *p));
                let edge = foliage.and_then(|crown| Some(inside(crown)?.y + BEHIND * extent(crown).y));
                let end = edge.unwrap_or(f64::INFINITY);
                hidden.extend(axis.node_ids().filter(|n| place(*n).y > end));
                trunks.push((row, end));
                continue;
            }
            if axis.bearer.is_some_and(|b| hidden.contains(&b)) {
                continue;
            }
            if axis.order > FINEST_LIMB || foot(axis) < thick {
                continue;
            }
            let rows = axis.nodes.start as usize..axis.nodes.end as usize;
            let (points, radii) = (&nodes.position[rows.clone()], &nodes.radius_m[rows]);
            let steps = || points.windows(2).map(|p| p[1] - p[0]);
            let length: f64 = steps().map(DVec3::length).sum();
            let whole: f64 = steps().zip(&radii[1..]).map(|(s, r)| s.truncate().length() * 2.0 * r).sum();
            let shown = f64::from(seen.get(&row).copied().unwrap_or(0)) * self.pixel * self.pixel;
            if whole > 0.0 && shown >= BARE * whole {
                limbs.push((length, row));
            }
        }
        base::sort_by(&mut limbs, |a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        limbs.truncate(MOST_LIMBS);
        // A limb without its bearer would hang in the air.
        let mut drawn: BTreeSet<usize> = trunks.iter().filter_map(|t| usize::try_from(t.0).ok()).collect();
        base::sort_by_key(&mut limbs, |limb| limb.1);
        limbs.retain(|&(_, row)| {
            let axis = usize::try_from(row).ok();
            let bearer = axis.and_then(|row| axes[row].bearer).map(|n| nodes.axis[n.index()].index());
            let held = bearer.is_some_and(|b| drawn.contains(&b));
            drawn.extend(axis.filter(|_| held));
            held
        });
        trunks.into_iter().chain(limbs.into_iter().map(|(_, row)| (row, f64::INFINITY))).collect()
    }

    /// Draws the visible organs, those behind first; `seen`: pixels of each.
    fn organs(&self, model: &Model, labels: &[Vec<[i32; 3]>], seen: &BTreeMap<i32, u32>) -> Vec<DrawnLine> {
        let mut found: BTreeMap<i32, (f64, DrawnLine)> = BTreeMap::new();
        for (part, labels) in model.parts.iter().zip(labels) {
            let mut faces: BTreeMap<i32, Vec<[u32; 3]>> = BTreeMap::new();
            for (triangle, [_, _, organ]) in part.mesh.triangles.iter().zip(labels) {
                if seen.contains_key(organ) {
                    faces.entry(*organ).or_default().push(*triangle);
                }
            }
            for (row, faces) in faces {
                let Some(organ) = usize::try_from(row).ok().and_then(|k| self.plant.organs.get(k)) else {
                    continue;
                };
                let points = corners(part, &faces);
                let depth = points.values().map(|p| p.z).sum::<f64>() / points.len() as f64;
                let flat: Vec<DVec2> = points.values().map(|p| p.truncate()).collect();
                if is_thin(organ.kind) {
                    // A short and wide organ, such as the foot of a flower, is behind the organs that it bears.
                    if let Some(points) = middle(&flat) {
                        found.insert(row, (depth, DrawnLine { kind: DrawnKind::Stalk, points, row }));
                    }
                    continue;
                }
                let Some(outline) = outline(&points, &faces, &flat) else { continue };
                let area = geom::signed_area(&outline).abs();
                // An organ of two parts has the outline of the larger one.
                let larger =
                    found.get(&row).is_none_or(|(_, was)| area > geom::signed_area(&was.points).abs());
                let shown = f64::from(seen.get(&row).copied().unwrap_or(0)) * self.pixel * self.pixel;
                if larger && area > 0.0 && shown >= SEEN * area {
                    let points = geom::simplify(&outline, self.fine);
                    found.insert(row, (depth, DrawnLine { kind: DrawnKind::Blade, points, row }));
                }
            }
        }
        let mut lines: Vec<(f64, DrawnLine)> = found.into_values().collect();
        base::sort_by(&mut lines, |a, b| a.0.total_cmp(&b.0).then(a.1.row.cmp(&b.1.row)));
        lines.into_iter().map(|(_, line)| line).collect()
    }
}

/// Whether an organ is drawn as a line along its middle.
const fn is_thin(kind: OrganKind) -> bool {
    matches!(kind, OrganKind::Stamen | OrganKind::Pistil | OrganKind::Thorn | OrganKind::Pedicel)
}

/// Returns the vertices of some triangles.
fn corners(part: &Part, faces: &[[u32; 3]]) -> BTreeMap<u32, DVec3> {
    let place = |&i: &u32| {
        let point = part.mesh.positions.get(i as usize)?;
        Some((i, DVec3::from_array(point.map(f64::from))))
    };
    faces.iter().flatten().filter_map(place).collect()
}

fn extent(points: &[DVec2]) -> DVec2 {
    let low = points.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    let high = points.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
    high - low
}

/// Returns a line through the middle of a long and thin set of points; `None` for any other.
fn middle(points: &[DVec2]) -> Option<Vec<DVec2>> {
    let axes = geom::pca2(points)?;
    let [long, wide] = axes.lambda.map(f64::sqrt);
    if points.len() < 2 || wide > SLENDER * long {
        return None;
    }
    let along = |p: &DVec2| (*p - axes.centre).dot(axes.major);
    let (low, high) =
        points.iter().map(along).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
    let mut sums = [(DVec2::ZERO, 0.0); PIECES];
    for point in points {
        let share = (along(point) - low) / (high - low).max(f64::MIN_POSITIVE) * PIECES as f64;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 6")]
        let (sum, count) = &mut sums[(share as usize).min(PIECES - 1)];
        *sum += *point;
        *count += 1.0;
    }
    let middles: Vec<DVec2> =
        sums.into_iter().filter(|(_, count)| *count > 0.0).map(|(sum, count)| sum / count).collect();
    let inner = middles.get(1..middles.len().saturating_sub(1)).unwrap_or_default();
    let ends = [low, high].map(|end| axes.centre + axes.major * end);
    Some([ends[0]].into_iter().chain(inner.iter().copied()).chain([ends[1]]).collect())
}

/// Returns the longest loop of edges with one triangle each, closed; the hull for a body that its rim does not go
/// around.
fn outline(points: &BTreeMap<u32, DVec3>, faces: &[[u32; 3]], flat: &[DVec2]) -> Option<Vec<DVec2>> {
    let rim = longest_loop(points, faces);
    if rim.len() > 3 {
        let (around, own) = (extent(&rim), extent(flat));
        // The open end of a tube is not its outline.
        if around.cmpge(AROUND * own).all() {
            return Some(rim);
        }
    }
    let hull = geom::convex_hull(flat);
    (hull.len() > 2).then(|| hull.iter().chain(hull.first()).copied().collect())
}

fn longest_loop(points: &BTreeMap<u32, DVec3>, faces: &[[u32; 3]]) -> Vec<DVec2> {
    // Vertices at the same place are one.
    let mut places: Vec<DVec2> = Vec::new();
    let mut at: BTreeMap<[i64; 2], usize> = BTreeMap::new();
    let mut same: BTreeMap<u32, usize> = BTreeMap::new();
    for (vertex, point) in points {
        #[expect(clippy::cast_possible_truncation, reason = "metres of a plant in nanometres")]
        let key = [point.x, point.y].map(|x| (x / SAME_M).round_ties_even() as i64);
        let place = *at.entry(key).or_insert_with(|| {
            places.push(point.truncate());
            places.len() - 1
        });
        same.insert(*vertex, place);
    }
    let edge = |face: &[u32; 3], k: usize| {
        let (a, b) = (same.get(&face[k])?, same.get(&face[(k + 1) % 3])?);
        (a != b).then_some((*a, *b))
    };
    let edges: Vec<(usize, usize)> =
        (0..3).flat_map(|k| faces.iter().filter_map(move |face| edge(face, k))).collect();
    let mut counts: BTreeMap<(usize, usize), u32> = BTreeMap::new();
    for (a, b) in &edges {
        *counts.entry((*a.min(b), *a.max(b))).or_default() += 1;
    }
    let rim: Vec<(usize, usize)> =
        edges.into_iter().filter(|(a, b)| counts.get(&(*a.min(b), *a.max(b))) == Some(&1)).collect();
    let mut after: BTreeMap<usize, usize> = rim.iter().copied().collect();
    let mut best: Vec<usize> = Vec::new();
    for (start, _) in rim {
        let (mut one, mut here) = (Vec::new(), start);
        while let Some(next) = after.remove(&here) {
            one.push(here);
            here = next;
        }
        if here == start && one.len() > best.len() {
            best = one;
        }
    }
    best.iter().chain(best.first()).map(|k| places[*k]).collect()
}

/// Returns a closed line around foliage: its reach in each direction from its middle, smoothed.
fn crown(plant: &Plant) -> Vec<DVec2> {
    let points: Vec<DVec2> = plant.organs.iter().map(|o| o.frame.origin.truncate()).collect();
    let middle = DVec2::new(median(points.iter().map(|p| p.x)), median(points.iter().map(|p| p.y)));
    let mut reach = [0.0_f64; SECTORS];
    for away in points.iter().map(|p| *p - middle) {
        let turn = (ops::atan2(away.y, away.x) + ops::PI) / ops::TAU * SECTORS as f64;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 48")]
        let sector = &mut reach[turn as usize % SECTORS];
        *sector = sector.max(away.length());
    }
    let full = filled(&reach);
    let even = |k: usize| {
        let (before, after) = ((k + SECTORS - 1) % SECTORS, (k + 1) % SECTORS);
        (full[before] + 2.0 * full[k] + full[after]) / 4.0
    };
    let place = |k: usize| {
        let angle = (k as f64 + 0.5) / SECTORS as f64 * ops::TAU - ops::PI;
        middle + even(k) * DVec2::new(ops::cos(angle), ops::sin(angle))
    };
    (0..=SECTORS).map(|k| place(k % SECTORS)).collect()
}

/// Interpolates directions without foliage from those around them.
fn filled(reach: &[f64; SECTORS]) -> [f64; SECTORS] {
    let mut full = *reach;
    for (k, one) in full.iter_mut().enumerate().filter(|(_, one)| **one <= 0.0) {
        let before = (1..SECTORS).find(|d| reach[(k + SECTORS - d) % SECTORS] > 0.0);
        let after = (1..SECTORS).find(|d| reach[(k + d) % SECTORS] > 0.0);
        if let (Some(before), Some(after)) = (before, after) {
            let (a, b) = (reach[(k + SECTORS - before) % SECTORS], reach[(k + after) % SECTORS]);
            *one = a + (b - a) * before as f64 / (before + after) as f64;
        }
    }
    full
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    base::sort_numbers(&mut values);
    let half = values.len() / 2;
    match values.as_slice() {
        [] => 0.0,
        all if all.len() % 2 == 1 => all[half],
        all => f64::midpoint(all[half - 1], all[half]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mesh::TriMesh;

    fn flat(points: &[[f32; 2]], triangles: &[[u32; 3]]) -> (BTreeMap<u32, DVec3>, Vec<DVec2>) {
        let positions = points.iter().map(|p| [p[0], p[1], 0.0]).collect();
        let mesh = TriMesh { positions, ..TriMesh::default() };
        let part = Part { name: "one".into(), material: mesh::MaterialId::new(0), mesh };
        let corners = corners(&part, triangles);
        let flat = corners.values().map(|p| p.truncate()).collect();
        (corners, flat)
    }

    #[test]
    fn the_outline_of_a_blade_is_its_rim_and_a_seam_is_none() {
        // A notched blade of two halves that meet at x = 0 with vertices of their own.
        let points = [[0.0, 0.0], [-1.0, 1.0], [0.0, 0.5], [0.0, 0.0], [0.0, 0.5], [1.0, 1.0]];
        let faces = [[0, 2, 1], [3, 5, 4]];
        let (corners, flat) = flat(&points, &faces);
        let rim = outline(&corners, &faces, &flat).expect("an outline");
        assert_eq!((rim.len(), rim.first()), (5, rim.last()));
        assert!((geom::signed_area(&rim).abs() - 0.5).abs() < 1e-12, "{rim:?}");
    }

    #[test]
    fn the_outline_of_a_body_without_a_rim_is_its_hull() {
        // Both sides of a square: each edge has two triangles.
        let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let faces = [[0, 1, 2], [0, 2, 3], [2, 1, 0], [3, 2, 0]];
        let (corners, flat) = flat(&points, &faces);
        let hull = outline(&corners, &faces, &flat).expect("an outline");
        assert_eq!((hull.len(), geom::signed_area(&hull)), (5, 1.0));
        let (corners, flat) = self::flat(&points[..2], &[]);
        assert_eq!(outline(&corners, &[], &flat), None, "two points have no outline");
    }

    #[test]
    fn a_slender_organ_is_a_line_along_its_middle_and_a_round_one_is_none() {
        let rod: Vec<DVec2> =
            (0..60).map(|k| DVec2::new(f64::from(k) / 59.0, 0.01 * f64::from(k % 3 - 1))).collect();
        let line = middle(&rod).expect("a line");
        assert!(
            line.iter().all(|p| p.y.abs() < 0.01)
                && (line[0].distance(line[line.len() - 1]) - 1.0).abs() < 0.01
        );
        let round: Vec<DVec2> =
            (0..12).map(|k| DVec2::new(ops::cos(f64::from(k)), ops::sin(f64::from(k)))).collect();
        assert_eq!(middle(&round), None);
        assert_eq!(middle(&[]), None);
    }

    #[test]
    fn directions_without_foliage_reach_as_far_as_those_around_them() {
        let mut reach = [0.0; SECTORS];
        (reach[0], reach[4], reach[5]) = (1.0, 5.0, 2.0);
        let full = filled(&reach);
        assert_eq!([full[0], full[1], full[2], full[3], full[4]], [1.0, 2.0, 3.0, 4.0, 5.0]);
        // Over the seam, from 5 to 48.
        assert!(full[6] < 2.0 && full[SECTORS - 1] > 1.0 && full[SECTORS - 1] < full[SECTORS - 2]);
    }
}
