//! Data for placing an organ: the reading, the map to metres, the axes that exist already.

use base::{Draw, LiteMap, Seed, ops};
use glam::{DVec2, DVec3};
use plant::{AxisId, AxisKind, NodeId, Paint, Plant};
use reading::{Attachment, BladeReading};

use super::Plans;
use crate::{PlantMap, SketchSpec};

/// Roots farther from their bearer than this get a stalk, ink units: nearer ones read as touching.
const TOUCHING: f64 = 0.012;

/// The half-built plant for organs to be placed on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scene<'a> {
    pub(crate) spec: &'a SketchSpec,
    pub(crate) seed: Seed,
    pub(crate) map: PlantMap,
    pub(crate) plans: &'a Plans,
    /// The plant's axis of each planned row.
    pub(crate) ids: &'a [Option<AxisId>],
    /// Whether it was drawn with coloured pens: organs take the colour in which they were drawn.
    pub(crate) coloured: bool,
    /// The colour of petals that were drawn in ink alone, in a coloured drawing: that of most petals with one.
    pub(crate) petals: Option<[u8; 3]>,
    /// Boldness of the strokes that differ from the usual one, relative to it.
    pub(crate) pressed: &'a LiteMap<u32, f64>,
}

/// The node that bears something.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bearing {
    pub(crate) node: NodeId,
    /// Its position, metres.
    pub(crate) position: DVec3,
    /// Its place in the drawing, ink units.
    pub(crate) drawn: DVec2,
    /// Direction of the axis in the drawing, unit.
    pub(crate) along: DVec2,
    /// Drawn half width of the axis, ink units; 0 for a line.
    pub(crate) half_width: f64,
    /// Key of the axis.
    pub(crate) key: u64,
}

impl Scene<'_> {
    /// Returns the node of an attachment; `None` if there is no such axis.
    pub(crate) fn bearing(&self, plant: &Plant, at: Option<Attachment>) -> Option<Bearing> {
        let (row, node) = self.plans.locate(at?)?;
        let plan = self.plans.rows.get(row)?.as_ref()?;
        let id = (*self.ids.get(row)?)?;
        let handle = plant.axis(id).node_ids().nth(node)?;
        Some(Bearing {
            node: handle,
            position: *plant.nodes.position.get(handle.index())?,
            drawn: *plan.drawn.get(node)?,
            along: plan.direction(node, 0.03),
            half_width: plan.width_at(node),
            key: plan.key,
        })
    }

    /// Returns the seat of an organ drawn at `root` (ink): at its bearer's depth, in front of the bark of a bearer
    /// drawn thick.
    pub(crate) fn seat(&self, root: DVec2, bearing: Option<&Bearing>) -> DVec3 {
        let Some(b) = bearing else { return self.map.plant_at_depth(root, 0.0) };
        let shift = b.position.truncate() - self.map.plant_from_ink(b.drawn);
        let off = (root - b.drawn).dot(b.along.perp()).abs();
        let front = (b.half_width * b.half_width - off * off).max(0.0).sqrt() * self.map.metres_per_ink;
        (self.map.plant_from_ink(root) + shift).extend(b.position.z + front)
    }

    /// Returns the node that bears an organ seated at `seat` and drawn at `root`: the bearing's own if they touch,
    /// else the end of a new stalk between them. The stalk has no source: it was not drawn.
    pub(crate) fn stalk(
        &self,
        plant: &mut Plant,
        bearing: Option<&Bearing>,
        root: DVec2,
        seat: DVec3,
        kind: AxisKind,
        key: u64,
    ) -> Option<NodeId> {
        let b = bearing?;
        let gap = root.distance(b.drawn);
        if gap <= TOUCHING.max(1.1 * b.half_width) {
            return Some(b.node);
        }
        let reach = seat - b.position;
        // A slight bow away from straight, upwards, as stalks grow.
        let bow = DVec3::Y * (0.06 * reach.truncate().length());
        let points: Vec<DVec3> = (0..=4_i32)
            .map(|i| {
                let t = f64::from(i) / 4.0;
                b.position + reach * t + bow * (4.0 * t * (1.0 - t))
            })
            .collect();
        let mut points = points;
        points[0] = b.position;
        points[4] = seat;
        let id = plant.add_axis(kind, Some(b.node), key, &points, None);
        plant.axis(id).node_ids().last()
    }

    /// Returns how boldly a stroke was drawn: 1 as usual.
    pub(crate) fn boldness(&self, source: Option<u32>) -> f64 {
        source.and_then(|source| self.pressed.get(&source).copied()).unwrap_or(1.0)
    }

    /// Returns the colour in which an organ was drawn, if the drawing is coloured, else white; varied slightly in
    /// brightness and warmth, so that no two organs look alike.
    pub(crate) fn paint(&self, key: u64, color: Option<[u8; 3]>) -> Paint {
        let mut s = self.seed.child(key).stream(Draw::Tint);
        let (light, warm) = (s.range(0.88, 1.12), s.range(-0.05, 0.05));
        let drawn = color.filter(|_| self.coloured).and_then(drawn_light);
        let varied = [light * (1.0 + warm), light, light * (1.0 - warm)];
        #[expect(clippy::cast_possible_truncation, reason = "a colour")]
        let times = |light: [f64; 3]| [0, 1, 2].map(|i| (light[i] * varied[i]) as f32);
        drawn.map_or_else(|| Paint::Natural(times([1.0; 3])), |light| Paint::Drawn(times(light)))
    }
}

/// Returns the colour of most blades that have one; on a tie the first. Blades that have none are hidden in part:
/// their colour lies under those in front.
pub(crate) fn usual_colour<'a>(blades: impl Iterator<Item = &'a BladeReading>) -> Option<[u8; 3]> {
    let mut counts: Vec<([u8; 3], usize)> = Vec::new();
    for color in blades.filter_map(|b| b.color).filter(|&c| drawn_light(c).is_some()) {
        match counts.iter_mut().find(|(c, _)| *c == color) {
            Some((_, count)) => *count += 1,
            None => counts.push((color, 1)),
        }
    }
    let most = counts.iter().map(|(_, count)| *count).max()?;
    counts.into_iter().find(|(_, count)| *count == most).map(|(color, _)| color)
}

/// Whether a drawing was made with coloured pens: its organs have at least two different colours, at least one of
/// which is not an ink colour. A drawing in one colour shows only the colour of the pen; no colour counts as different
/// from a colour.
pub(crate) fn coloured(mut colors: impl Iterator<Item = Option<[u8; 3]>> + Clone) -> bool {
    let Some(first) = colors.next() else { return false };
    let differ = |c: Option<[u8; 3]>| match c.zip(first) {
        Some((c, first)) => c.iter().zip(&first).any(|(a, b)| a.abs_diff(*b) > 24),
        None => c != first,
    };
    let other = colors.clone().any(differ);
    other && (first.is_some_and(is_coloured) || colors.flatten().any(is_coloured))
}

/// Returns the linear light of a drawn colour; `None` for ink: black or grey. Among colours white counts, since nobody
/// draws with white ink: the petals of a daisy.
pub(crate) fn drawn_light(color: [u8; 3]) -> Option<[f64; 3]> {
    let light = color.map(base::light_of_byte);
    // The hue of the darkest ink cannot be seen.
    let is_seen = is_coloured(color) && light.into_iter().any(|x| x > 0.04);
    (is_seen || is_white(color)).then_some(light)
}

fn is_white(c: [u8; 3]) -> bool {
    c.into_iter().all(|x| x > 200)
}

/// Whether a colour is neither black, grey nor white.
fn is_coloured(c: [u8; 3]) -> bool {
    let (low, high) = c.iter().fold((u8::MAX, 0), |(l, h), &x| (l.min(x), h.max(x)));
    high - low > 30
}

/// Returns a number of the spec, clamped to the range that the geometry allows; nonsense becomes 0.
pub(crate) fn sane(x: f64, most: f64) -> f64 {
    if x.is_finite() { x.clamp(-most, most) } else { 0.0 }
}

/// Returns a factor around 1.
pub(crate) fn around_one(u: f64, share: f64) -> f64 {
    ops::lerp(1.0 - share, 1.0 + share, u)
}

/// Whether geometry can use a coordinate pair: finite and not farther off than any drawing reaches.
pub(crate) fn usable(p: DVec2) -> bool {
    p.is_finite() && p.abs().max_element() < 1e6
}
