//! The front view of the model, as lines in ink coordinates.
//!
//! `Built + Reading -> ShownLine`

use core::ops::Range;

use base::ops;
use glam::{DVec2, DVec3};
use plant::{AxisId, Organ, OrganKind, Plant, Shape};
use reading::Reading;

use crate::Built;

/// Corners of a circle.
const CORNERS: u32 = 48;

/// A line that the model shows.
#[derive(Debug)]
pub(super) struct ShownLine {
    pub(super) points: Vec<DVec2>,
    /// An outline or an axis; else a detail within one (vein, midrib, stamen): ink may be there, but need not.
    pub(super) outline: bool,
}

/// Returns the lines of all parts that did not grow in a contour: axes, or both edges of those that were drawn as an
/// outline; outlines of blades, discs, fruits; thorns, veins, stamens. Leaves that the light prior turned are left
/// out.
pub(super) fn shown_lines(built: &Built, reading: &Reading) -> Vec<ShownLine> {
    let plant = &built.plant;
    let seen = |p: DVec3| built.map.ink_from_plant(p.truncate());
    let grown_axis = rows_within(plant.axes.len(), built.grown.iter().map(|g| g.axes.clone()));
    let grown_organ = rows_within(plant.organs.len(), built.grown.iter().map(|g| g.organs.clone()));
    let drawn_thick = reading.axes.iter().filter(|a| !a.half_width.is_empty());
    let thick = base::set_of(drawn_thick.filter_map(|a| a.source));
    let mut lines = Vec::new();
    for (i, axis) in plant.axes.iter().enumerate().filter(|&(i, _)| !grown_axis[i]) {
        let id = AxisId::new(i);
        let middle: Vec<DVec2> = plant.axis_points(id).iter().map(|&p| seen(p)).collect();
        let drawn_thick = axis.source.is_some_and(|s| thick.contains_key(&s));
        let points =
            if drawn_thick { edges(&middle, plant.axis_radii(id), built.map.metres_per_ink) } else { middle };
        lines.push(ShownLine { points, outline: true });
    }
    for (_, organ) in plant.organs.iter().enumerate().filter(|&(i, o)| !grown_organ[i] && lies_as_drawn(o)) {
        organ_lines(plant, organ, seen, &mut lines);
    }
    lines
}

/// Marks the rows below `count` that lie in one of the ranges.
fn rows_within(count: usize, ranges: impl Iterator<Item = Range<usize>>) -> Vec<bool> {
    let mut within = vec![false; count];
    for range in ranges {
        within[range.start.min(count)..range.end.min(count)].fill(true);
    }
    within
}

/// Whether the front view of an organ is meant to be its drawing.
pub(super) fn lies_as_drawn(organ: &Organ) -> bool {
    match organ.kind {
        OrganKind::Leaf => organ.frame.normal.z.abs() > 1.0 - 1e-9,
        // Evened out: as wide on both sides.
        OrganKind::Pot => false,
        _ => true,
    }
}

/// Returns one line around a tube: left edge, over the tip, right edge.
fn edges(middle: &[DVec2], radii_m: &[f64], metres_per_ink: f64) -> Vec<DVec2> {
    let edge = |side: f64| -> Vec<DVec2> {
        let pairs = middle.iter().zip(radii_m).enumerate();
        pairs
            .map(|(k, (&p, r))| {
                let next = middle[(k + 1).min(middle.len() - 1)];
                let along = (next - middle[k.saturating_sub(1)]).try_normalize().unwrap_or(DVec2::Y);
                p + along.perp() * (side * r / metres_per_ink)
            })
            .collect()
    };
    let mut around = edge(1.0);
    around.extend(edge(-1.0).into_iter().rev());
    around
}

fn organ_lines(plant: &Plant, organ: &Organ, seen: impl Fn(DVec3) -> DVec2, lines: &mut Vec<ShownLine>) {
    let at = |p: DVec3| seen(organ.frame.place(p, organ.scale));
    let mut show = |mut points: Vec<DVec2>, outline: bool| {
        if outline {
            points.extend(points.first().copied());
        }
        lines.push(ShownLine { points, outline });
    };
    match plant.shapes.get(organ.shape.index()) {
        Some(Shape::Blade(blade)) => {
            let surface = blade.surface();
            let line = |points: &[DVec2]| points.iter().map(|&p| at(surface.point(p))).collect();
            show(line(&blade.outline), true);
            blade.lines().for_each(|l| show(line(l), false));
        }
        Some(Shape::Dome { radius_m, .. }) => {
            let corner = |i: u32| {
                let (s, c) = ops::sin_cos(ops::TAU * f64::from(i) / f64::from(CORNERS));
                at(DVec3::new(c, s, 0.0) * *radius_m)
            };
            show((0..CORNERS).map(corner).collect(), true);
        }
        Some(Shape::Revolution { profile }) => {
            let side = |x: f64| profile.iter().map(move |p| DVec3::new(x * p.x, p.y, 0.0));
            show(side(1.0).chain(side(-1.0).rev()).map(at).collect(), true);
        }
        // A body that bends.
        Some(shape @ Shape::Strand { path, radius_m, .. }) if shape.is_bent_body() => {
            let edge = |side: f64| -> Vec<DVec3> {
                let flat: Vec<DVec2> = path.iter().map(|p| p.truncate()).collect();
                let across = |k: usize| {
                    let along = flat[(k + 1).min(flat.len() - 1)] - flat[k.saturating_sub(1)];
                    along.normalize_or_zero().perp()
                };
                let radii = radius_m.iter().enumerate();
                radii.map(|(k, r)| path[k] + (across(k) * (side * r)).extend(0.0)).collect()
            };
            show(edge(1.0).into_iter().chain(edge(-1.0).into_iter().rev()).map(at).collect(), true);
        }
        Some(Shape::Strand { path, .. }) => {
            let thorn = organ.kind == OrganKind::Thorn;
            lines.push(ShownLine { points: path.iter().map(|&p| at(p)).collect(), outline: thorn });
        }
        _ => {}
    }
}
