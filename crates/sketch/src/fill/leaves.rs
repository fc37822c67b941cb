//! Leaves in a leaf contour.
//!
//! `bearers + contour + templates -> midribs by Eq 2 -> leaves`

use base::{Draw, Seed};
use glam::DVec3;
use plant::{AxisId, AxisKind, Frame, Organ, OrganKind, Paint, Plant};

use super::crown::count_of;
use super::foliage::Foliage;
use super::grow::{Site, add_axis, add_sites, attach, child_key, grow_toward};
use super::scatter::scatter_front;
use super::twigs::inner_sites;
use super::volume::Volume;
use crate::FillSpec;

/// Most leaves of one region.
pub(super) const MOST_LEAVES: usize = 20_000;

/// A contour in which leaves grow.
#[derive(Debug)]
pub(super) struct Leaves<'a> {
    pub(super) volume: &'a Volume,
    pub(super) spec: FillSpec,
    pub(super) seed: Seed,
    pub(super) bearers: &'a [AxisId],
    pub(super) foliage: Foliage,
    /// Leaves wanted.
    pub(super) leaves: usize,
    /// Rank of this contour among those of its bearer.
    pub(super) salt: u64,
}

impl Leaves<'_> {
    /// Grows the leaves; returns the number of axes and leaves added.
    ///
    /// The middles of leaves are scattered evenly over the contour; each midrib starts at the place of a bearer from
    /// which its middle is best reached, and runs on beyond it by half the length of a leaf. Middles too far away for
    /// that first get a stalk, which may carry further ones.
    pub(super) fn grow(&self, plant: &mut Plant) -> (usize, usize) {
        let v = self.volume;
        let axes = plant.axes.len();
        let mut sites = inner_sites(plant, v, self.bearers, self.salt);
        if sites.is_empty() {
            return (0, 0);
        }
        let length = self.foliage.length;
        let mut stream = self.seed.stream(Draw::Attractors);
        let mut middles = scatter_front(v, self.leaves, (0.25 * length, 0.75), &mut stream);
        // From the bearer outwards, so that twigs grown for near leaves carry the far ones.
        base::sort_by(&mut middles, |a, b| {
            let near =
                |t: &DVec3| sites.iter().map(|s| s.at.distance_squared(*t)).fold(f64::INFINITY, f64::min);
            near(a).total_cmp(&near(b))
        });
        let mut points = Vec::new();
        let mut placed = 0;
        for middle in middles {
            let Some(mut i) = attach(v, &sites, middle, u32::MAX) else { continue };
            let from = sites[i];
            let way = from.at.distance(middle);
            if way > 0.85 * length && from.level < 4 {
                let target = from.at.lerp(middle, (way - 0.45 * length) / way);
                let step = 0.3 * length;
                grow_toward(v, &self.spec, (from.at, from.tangent), target, step, &mut stream, &mut points);
                let Some(axis) = add_axis(plant, &mut sites[i], AxisKind::Petiole, &points) else { continue };
                add_sites(plant, axis, from.level + 1, from.path, &mut sites);
                i = sites.len() - 1;
            }
            if self.leaf(plant, &mut sites[i], middle, &mut stream, &mut points) {
                placed += 1;
            }
        }
        (plant.axes.len() - axes, placed)
    }

    /// Grows one midrib from a site through a middle, and its leaf: root on its start, tip on its end.
    fn leaf(
        &self,
        plant: &mut Plant,
        site: &mut Site,
        middle: DVec3,
        stream: &mut base::Stream,
        points: &mut Vec<DVec3>,
    ) -> bool {
        let v = self.volume;
        let f = &self.foliage;
        if !v.contains_xy(site.at.truncate()) {
            return false;
        }
        let leaf = Seed::new(child_key(plant, site));
        let size = f.length * (1.0 + 0.15 * leaf.stream(Draw::Size).normal()).clamp(0.75, 1.2);
        let way = middle - site.at;
        // Half a leaf beyond the middle, within the size range of leaves of one plant.
        let size = size * (way.length() / f.length + 0.5).clamp(0.85, 1.15);
        let target = site.at + way.normalize_or_zero() * size;
        grow_toward(v, &self.spec, (site.at, site.tangent), target, size / 5.0, stream, points);
        let Some(&end) = points.last() else { return false };
        let mut midrib = end - site.at;
        // If the body recedes from its bearer, a midrib would run to the back rather than across the drawing.
        let flat = midrib.truncate().length();
        midrib.z = midrib.z.clamp(-0.8 * flat, 0.8 * flat);
        // A midrib that the contour cut short becomes no leaf.
        if midrib.length() < 0.45 * f.length {
            return false;
        }
        let mut angle = leaf.stream(Draw::LeafAngle);
        let jitter = DVec3::new(angle.normal(), angle.normal(), angle.normal()) * 0.3;
        let out = (site.at - f.core).normalize_or_zero();
        let frame = Frame::looking(site.at, midrib, DVec3::Z * 0.7 + DVec3::Y * 0.5 + out * 0.3 + jitter);
        let (shape, unit) = f.shapes[leaf.stream(Draw::Template).below(f.shapes.len())];
        let value = leaf.stream(Draw::Tint).range(0.85, 1.1);
        #[expect(clippy::cast_possible_truncation, reason = "colours are f32")]
        let value = value as f32;
        plant.organs.push(Organ {
            kind: OrganKind::Leaf,
            bearer: Some(site.node),
            flower: None,
            shape,
            frame,
            // Drawn leaves of one plant differ by a fifth or so: larger ones would be of another plant.
            scale: (midrib.length().clamp(0.75 * f.length, 1.2 * f.length) / unit).max(f64::MIN_POSITIVE),
            paint: Paint::Natural([value; 3]),
            key: leaf.number(),
            source: None,
        });
        true
    }
}

/// Returns the number of leaves that cover a contour of some area about `layers` times.
pub(super) fn leaves_for(area: f64, length: f64, layers: f64) -> usize {
    // A leaf covers half of length^2 lying flat, half of that on average as it hangs.
    count_of(layers * area / (0.25 * length * length), 3, MOST_LEAVES)
}

/// Length of a leaf that was not drawn over the height of its plant. The twelve leaf contours of our drawings for
/// Table 1 enclose 0.087 of the plant's squared height on average: leaves of this length number 35 there.
pub(super) const DEFAULT_LENGTH: f64 = 0.08;
