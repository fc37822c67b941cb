//! Height, crown and leaf area.

use base::ops;
use glam::{DVec2, DVec3};

use crate::{AxisKind, Blade, NeedleMap, OrganKind, Plant, Shape};

pub(super) struct Crown {
    pub(super) height_m: f64,
    pub(super) base_m: Option<f64>,
    pub(super) volume_m3: f64,
    pub(super) projection_m2: f64,
}

/// Measures the crown; see [`super::Measures`] for its definition.
pub(super) fn crown(plant: &Plant, shoot: &[bool]) -> Crown {
    let has_leaves = plant.organs.iter().any(|o| o.kind == OrganKind::Leaf);
    let live = live_axes(plant, has_leaves);
    let base_m = base(plant, shoot, &live);
    let mut points = Vec::new();
    let foot = foot(plant);
    let mut top = foot;
    for (i, axis) in plant.axes.iter().enumerate().filter(|(i, _)| shoot[*i]) {
        let rows = axis.nodes.start as usize..axis.nodes.end as usize;
        let line = &plant.nodes.position[rows];
        top = line.iter().fold(top, |h, p| h.max(p.y));
        if axis.bearer.is_some() {
            points.extend(line.iter().filter(|_| live[i]));
        } else if let Some(base) = base_m {
            points.extend(line.iter().filter(|p| p.y >= base));
        }
    }
    let margins: Vec<Vec<DVec3>> = plant.shapes.iter().map(margin).collect();
    for organ in plant.organs.iter().filter(|o| o.kind != OrganKind::Pot) {
        let places = margins[organ.shape.index()].iter().map(|&p| organ.frame.place(p, organ.scale));
        top = places.fold(top, |h, p| h.max(p.y));
    }
    leaves_outside(plant, &margins, &mut points);
    let hull = geom::convex_hull3(&points);
    // The projected hull of a body is that of its corners, which are far fewer than the points of all leaves.
    let corners = hull.as_ref().map_or(&points[..], |h| &h.points);
    let flat: Vec<DVec2> = corners.iter().map(|p| DVec2::new(p.x, p.z)).collect();
    let projection_m2 = geom::signed_area(&geom::convex_hull(&flat)).abs();
    let volume_m3 = hull.map_or(0.0, |h| h.volume());
    let base_m = base_m.map(|base| base - foot);
    Crown { height_m: top - foot, base_m, volume_m3, projection_m2 }
}

/// Returns the height of the lowest foot: the start of an axis without a bearer, roots excepted; 0 if there is none.
fn foot(plant: &Plant) -> f64 {
    let free = plant.axes.iter().filter(|a| a.bearer.is_none() && a.kind != AxisKind::Root);
    let feet = free.filter_map(|a| plant.nodes.position.get(a.nodes.start as usize).map(|p| p.y));
    feet.reduce(f64::min).unwrap_or(0.0)
}

/// Adds to `points` those of the leaves that may lie on the convex hull of all: most leaves lie deep inside a crown.
pub(super) fn leaves_outside(plant: &Plant, margins: &[Vec<DVec3>], points: &mut Vec<DVec3>) {
    // Flowers and fruits reach higher, but are not part of the crown.
    let leaves = || {
        let leaves = plant.organs.iter().filter(|o| o.kind == OrganKind::Leaf);
        leaves.filter_map(|o| margins[o.shape.index()].first().map(|first| (o, *first)))
    };
    // One point of each leaf; all other points are within `reach` of it.
    points.extend(leaves().map(|(o, first)| o.frame.place(first, o.scale)));
    let core = geom::convex_hull3(points).map(|hull| hull.planes()).unwrap_or_default();
    let reach_of = |m: &Vec<DVec3>| m.iter().fold(0.0_f64, |r, p| r.max(p.distance(m[0])));
    let reaches: Vec<f64> = margins.iter().map(reach_of).collect();
    for (leaf, first) in leaves() {
        let (at, reach) = (leaf.frame.place(first, leaf.scale), reaches[leaf.shape.index()] * leaf.scale);
        let inside = core.iter().all(|(normal, offset)| normal.dot(at) + reach < *offset);
        if core.is_empty() || !inside {
            points.extend(margins[leaf.shape.index()].iter().map(|&p| leaf.frame.place(p, leaf.scale)));
        }
    }
}

/// Returns for each axis whether it bears leaves, itself or through others; true for all on a plant without leaves.
fn live_axes(plant: &Plant, has_leaves: bool) -> Vec<bool> {
    let mut live = vec![!has_leaves; plant.axes.len()];
    let axis_of = |node: crate::NodeId| plant.nodes.axis[node.index()].index();
    for organ in plant.organs.iter().filter(|o| o.kind == OrganKind::Leaf) {
        if let Some(b) = organ.bearer {
            live[axis_of(b)] = true;
        }
    }
    for i in (0..live.len()).rev().filter(|_| has_leaves) {
        if let Some(b) = plant.axes[i].bearer.filter(|_| live[i]) {
            live[axis_of(b)] = true;
        }
    }
    live
}

/// Returns the lowest height at which a main axis bears a live axis (also a leaf stalk) or a leaf.
fn base(plant: &Plant, shoot: &[bool], live: &[bool]) -> Option<f64> {
    let on_main = |node: crate::NodeId| {
        let axis = plant.nodes.axis[node.index()].index();
        shoot[axis] && plant.axes[axis].bearer.is_none()
    };
    let axes = plant
        .axes
        .iter()
        .zip(live)
        .filter(|(a, live)| **live && !matches!(a.kind, AxisKind::Root | AxisKind::Stub));
    let leaves = plant.organs.iter().filter(|o| o.kind == OrganKind::Leaf);
    let bearers = axes.filter_map(|(a, _)| a.bearer).chain(leaves.filter_map(|o| o.bearer));
    let heights = bearers.filter(|b| on_main(*b)).map(|b| plant.nodes.position[b.index()].y);
    heights.fold(None, |low: Option<f64>, y| Some(low.map_or(y, |l| l.min(y))))
}

/// Returns local points whose convex hull is nearly that of the shape: a bent blade bulges between its margin and
/// midrib.
pub(super) fn margin(shape: &Shape) -> Vec<DVec3> {
    match shape {
        Shape::Blade(b) => {
            let surface = b.surface();
            let mut points = surface.points(&b.outline);
            points.extend(surface.points(&b.midrib));
            points
        }
        Shape::Dome { radius_m, height_m } => {
            let mut points = ring(*radius_m, |x, z| DVec3::new(x, z, 0.0));
            points.push(DVec3::Z * *height_m);
            points
        }
        Shape::Revolution { profile } => {
            profile.iter().flat_map(|p| ring(p.x, |x, z| DVec3::new(x, p.y, z))).collect()
        }
        Shape::Spline(_) | Shape::Sheet(_) => shape.corners(1.0),
        Shape::Strand { path, .. } => path.clone(),
    }
}

fn ring(radius: f64, place: impl Fn(f64, f64) -> DVec3) -> Vec<DVec3> {
    let at = |i: u32| ops::sin_cos(f64::from(i) * ops::TAU / 8.0);
    (0..8).map(at).map(|(s, c)| place(radius * c, radius * s)).collect()
}

/// Returns the area of one side of all leaves.
pub(super) fn leaf_area(plant: &Plant) -> f64 {
    let areas: Vec<Option<f64>> = {
        let mut used = vec![false; plant.shapes.len()];
        let leaves = plant.organs.iter().filter(|o| o.kind == OrganKind::Leaf);
        leaves.for_each(|o| used[o.shape.index()] = true);
        plant.shapes.iter().zip(used).map(|(s, used)| used.then(|| s.one_side_m2())).collect()
    };
    let leaves = plant.organs.iter().filter(|o| o.kind == OrganKind::Leaf);
    // Starts at 0, because the sum of no numbers is -0.
    leaves.map(|o| areas[o.shape.index()].unwrap_or(0.0) * o.scale * o.scale).fold(0.0, |sum, a| sum + a)
}

impl Shape {
    /// Returns the area of one side at scale 1, square metres: of the bent sheet for a blade (to about half a per
    /// cent), half of the surface for round shapes (Chen and Black 1992). Of a blade that is a shoot in needles or
    /// scales, it is the area that these cover, flat as on a scanner: without the gaps between them, without the wood,
    /// and counting overlaps once. Cost: a blade is triangulated; some milliseconds for a shoot in needles.
    pub fn one_side_m2(&self) -> f64 {
        match self {
            Self::Blade(b) => blade_area(b),
            // A spherical cap, and half of the surface for round shapes.
            Self::Dome { radius_m: r, height_m: h } => ops::PI * (r * r + h * h) / 2.0,
            Self::Revolution { profile } => {
                let strip = |w: &[DVec2]| ops::PI * (w[0].x + w[1].x) * w[0].distance(w[1]);
                profile.windows(2).map(strip).sum::<f64>() / 2.0
            }
            Self::Spline(blade) => blade.area_m2(),
            Self::Sheet(sheet) => crate::sheet::area(&sheet.points, sheet.triangles()),
            Self::Strand { path, radius_m, .. } => {
                let piece = |(p, r): (&[DVec3], &[f64])| ops::PI * (r[0] + r[1]) * p[0].distance(p[1]);
                path.windows(2).zip(radius_m.windows(2)).map(piece).sum::<f64>() / 2.0
            }
        }
    }
}

/// Returns the area of the bent sheet, for a shoot in needles reduced to the share that they cover.
fn blade_area(blade: &Blade) -> f64 {
    let plane = geom::signed_area(&blade.outline).abs();
    match NeedleMap::from_blade(blade) {
        Some(map) if plane > 0.0 => sheet_area(blade, plane) * (map.covered() / plane),
        _ => sheet_area(blade, plane),
    }
}

/// Returns the area of the bent sheet: that of its outline in the plane, times the stretching of its triangles by
/// bending.
fn sheet_area(blade: &Blade, plane: f64) -> f64 {
    let size = blade.outline.iter().fold(0.0_f64, |s, p| s.max(p.length()));
    // A twelfth of the blade: bends are smooth at that scale.
    let Ok(flat) = geom::triangulate_blade(&blade.outline, &[], size / 12.0) else { return plane };
    let bent = blade.surface().points(&flat.points);
    let (mut flat_area, mut bent_area) = (0.0, 0.0);
    for t in &flat.triangles {
        let [a, b, c] = t.map(|i| flat.points[i as usize]);
        flat_area += (b - a).perp_dot(c - a) / 2.0;
        let [a, b, c] = t.map(|i| bent[i as usize]);
        bent_area += (b - a).cross(c - a).length() / 2.0;
    }
    // An outline that crosses itself was mended: then only the triangles give its area.
    let mended = (plane - flat_area).abs() > 0.05 * flat_area;
    if mended || flat_area <= 0.0 { bent_area.max(flat_area) } else { plane * (bent_area / flat_area) }
}
