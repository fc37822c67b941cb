//! Pots as bodies of revolution, thorns as strands.

use base::{Draw, ops};
use glam::{DVec2, DVec3};
use plant::{Frame, Organ, OrganKind, Paint, Plant, Shape};
use reading::{Attachment, PotReading};

use super::axes::{Part, key_of};
use super::scene::{Scene, drawn_light, usable};

/// Rings of the wall of a pot.
const POT_RINGS: usize = 13;
/// Distance from a pot's floor and its rim within which lines belong to these, as a share of the pot's height.
const FLAT: f64 = 0.04;
/// Thickness of a pot's wall, as a share of its largest half width.
const THICK_WALL: f64 = 0.09;
/// Depth of the soil below the rim, as a share of the pot's height.
const SOIL_BELOW: f64 = 0.12;
/// Linear red, green and blue of fired clay.
const CLAY: [f32; 3] = [0.48, 0.16, 0.07];
/// Linear red, green and blue of soil.
const EARTH: [f32; 3] = [0.06, 0.04, 0.025];

/// Returns the leftmost and rightmost places where edges cross a height; infinite if none does.
pub(super) fn span(edges: impl Iterator<Item = [DVec2; 2]>, y: f64) -> [f64; 2] {
    let crossing = edges.filter(|[a, b]| (a.y - y) * (b.y - y) <= 0.0 && a.y != b.y);
    let xs = crossing.map(|[a, b]| ops::lerp(a.x, b.x, ((y - a.y) / (b.y - a.y)).clamp(0.0, 1.0)));
    xs.fold([f64::INFINITY, f64::NEG_INFINITY], |[left, right], x| [left.min(x), right.max(x)])
}

/// Adds a drawn pot: open above, its wall as wide as drawn, with soil a little below its rim.
pub(crate) fn place_pot(plant: &mut Plant, scene: &Scene<'_>, pot: &PotReading) {
    let Some((centre, low, wall)) = wall(pot) else { return };
    let s = scene.map.metres_per_ink;
    let wall: Vec<DVec2> = wall.into_iter().map(|p| p * s).collect();
    let (rim, wide) = (wall[wall.len() - 1], wall.iter().map(|p| p.x).fold(0.0, f64::max));
    let thick = (THICK_WALL * wide).min(0.4 * rim.x);
    let soil = rim.y - (SOIL_BELOW * rim.y).min(wide);
    let inner = |y: f64| {
        let above = wall.windows(2).find(|w| w[1].y >= y).map_or(rim.x, |w| {
            let t = (y - w[0].y) / (w[1].y - w[0].y).max(1e-12);
            ops::lerp(w[0].x, w[1].x, t.clamp(0.0, 1.0))
        });
        (above - thick).max(0.2 * above)
    };
    let mut outside = vec![DVec2::new(0.0, 0.0)];
    outside.extend(&wall);
    outside.extend([DVec2::new(rim.x - thick, rim.y), DVec2::new(inner(soil), soil)]);
    let level = DVec2::new(0.0, soil);
    let earth =
        vec![level - DVec2::Y * thick, DVec2::new(inner(soil), soil), level + DVec2::Y * (0.1 * thick)];
    // At the depth of the plant in it.
    let middle = scene.map.plant_from_ink(DVec2::new(centre, low));
    let feet = plant.axes.iter().filter(|a| a.bearer.is_none()).filter_map(|a| a.node_ids().next());
    let feet = feet.map(|n| plant.nodes.position[n.index()]).filter(|p| (p.x - middle.x).abs() < wide);
    let foot = feet.min_by(|a, b| (a.x - middle.x).abs().total_cmp(&(b.x - middle.x).abs()));
    let at = middle.extend(foot.map_or(0.0, |p| p.z));
    let drawn = pot.color.filter(|_| scene.coloured).and_then(drawn_light);
    #[expect(clippy::cast_possible_truncation, reason = "a colour")]
    let clay = drawn.map_or(Paint::Tinted(CLAY), |c| Paint::Drawn(c.map(|x| x as f32)));
    for (rank, profile, paint) in [(0, outside, clay), (1, earth, Paint::Tinted(EARTH))] {
        let shape = plant.add_shape(Shape::Revolution { profile });
        plant.organs.push(Organ {
            kind: OrganKind::Pot,
            bearer: None,
            flower: None,
            shape,
            frame: Frame::looking(at, DVec3::Y, DVec3::Z),
            scale: 1.0,
            paint,
            key: key_of(Part::Pot, pot.source, rank, 0),
            source: pot.source,
        });
    }
}

/// Returns the middle of a pot, its foot, and the line of its wall from the foot to the rim, `(half width, height)`,
/// ink units.
fn wall(pot: &PotReading) -> Option<(f64, f64, Vec<DVec2>)> {
    let points = || pot.lines.iter().flatten().copied().filter(|&p| usable(p));
    let (low, high) = geom::bounds(&points().collect::<Vec<_>>())?;
    let tall = high.y - low.y;
    if tall < 1e-3 || high.x - low.x < 1e-3 {
        return None;
    }
    let edges = || {
        let all = pot.lines.iter().flat_map(|l| l.windows(2)).map(|w| [w[0], w[1]]);
        all.filter(|[a, b]| usable(*a) && usable(*b))
    };
    let mut line = Vec::with_capacity(POT_RINGS);
    for k in 0..POT_RINGS {
        #[expect(clippy::cast_precision_loss, reason = "rings are few")]
        let share = k as f64 / (POT_RINGS - 1) as f64;
        // Its floor and its rim are lines: a little inside of both.
        let y = low.y + tall * share.clamp(FLAT, 1.0 - FLAT);
        let [left, right] = span(edges(), y);
        // A single side does not give the width.
        if right - left > 0.1 * (high.x - low.x) {
            line.push(DVec2::new(0.5 * (right - left), tall * share));
        }
    }
    if line.is_empty() {
        line = vec![DVec2::new(0.4 * (high.x - low.x), 0.0), DVec2::new(0.5 * (high.x - low.x), tall)];
    }
    let (first, last) = (line[0].x, line[line.len() - 1].x);
    line.insert(0, DVec2::new(first, 0.0));
    line.push(DVec2::new(last, tall));
    line.dedup();
    Some((0.5 * (low.x + high.x), low.y, line))
}

/// Adds a drawn thorn: a strand that thins to a point, outside the bark of a bearer that was drawn thick.
pub(crate) fn place_thorn(
    plant: &mut Plant,
    scene: &Scene<'_>,
    thorn: &(Vec<DVec2>, Option<Attachment>, Option<u32>),
    rank: usize,
) {
    let line: Vec<DVec2> = thorn.0.iter().copied().filter(|&p| usable(p)).collect();
    let (Some(&root), Some(&tip)) = (line.first(), line.last()) else { return };
    let length = root.distance(tip);
    if length < 1e-6 {
        return;
    }
    let bearing = scene.bearing(plant, thorn.1);
    let key = key_of(Part::Thorn, thorn.2, rank as u64, bearing.map_or(0, |b| b.key));
    let origin = scene.seat(root, bearing.as_ref());
    let front = bearing.map_or(0.0, |b| origin.z - b.position.z);
    let width = bearing.map_or(0.0, |b| b.half_width) * scene.map.metres_per_ink;
    // On the front of a thick bearer thorns stand out towards the viewer; at its edge they stay in the plane.
    let outward = if width > 0.0 { (front / width).clamp(0.0, 1.0) } else { 0.0 };
    let sway = scene.seed.child(key).stream(Draw::LeafAngle).range(-0.4, 0.4);
    let rise = outward + sway;
    let s = scene.map.metres_per_ink;
    let mut path = Vec::with_capacity(line.len());
    for p in &line {
        let q = *p - root;
        path.push((q * s).extend(q.length() * s * rise));
    }
    path.dedup();
    if path.len() < 2 {
        return;
    }
    let mut passed = 0.0;
    let total: f64 = path.windows(2).map(|w| w[0].distance(w[1])).sum();
    let mut radius_m = Vec::with_capacity(path.len());
    for (i, p) in path.iter().enumerate() {
        if i > 0 {
            passed += p.distance(path[i - 1]);
        }
        radius_m.push(s * length * ops::lerp(0.09, 0.008, passed / total));
    }
    let shape = plant.add_shape(Shape::Strand { path, radius_m, knob_m: 0.0 });
    plant.organs.push(Organ {
        kind: OrganKind::Thorn,
        bearer: bearing.map(|b| b.node),
        flower: None,
        shape,
        frame: Frame { origin, right: DVec3::X, along: DVec3::Y, normal: DVec3::Z },
        scale: 1.0,
        paint: Paint::default(),
        key,
        source: thorn.2,
    });
}
