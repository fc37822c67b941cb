//! Twigs in a branch contour.
//!
//! `bearers + contour -> twigs by Eq 2 until near the contour`

use base::ops::{self, sin_cos};
use base::{Draw, Seed};
use glam::{DVec2, DVec3};
use plant::{AxisId, AxisKind, Phyllotaxis, Plant};

use super::crown::{MOST_TWIGS, count_of};
use super::grow::{Site, Turned, add_axis, add_sites, attach, grow_to_contour, grow_toward};
use super::scatter::{scatter_front, scatter_rim};
use super::volume::Volume;
use crate::FillSpec;

/// A contour in which twigs grow.
#[derive(Debug)]
pub(super) struct Twigs<'a> {
    pub(super) volume: &'a Volume,
    pub(super) spec: FillSpec,
    pub(super) seed: Seed,
    pub(super) bearers: &'a [AxisId],
    pub(super) kind: AxisKind,
    /// Twigs wanted.
    pub(super) wanted: usize,
    /// Rank of this contour among those of its bearer.
    pub(super) salt: u64,
}

/// Room of one twig, as the edge of a square over the height of its plant. Table 1 of He and Cheng (2021): sketch (a)
/// grows 45 twigs in four contours, sketch (f) 11 in one. In our drawings of them these enclose 0.303 and 0.085 of the
/// plant's squared height: a twig for each 1/144.
const ROOM: f64 = 1.0 / 12.0;

/// Attraction points on a contour: 2.6 degrees of a circle apart.
const ATTRACTORS: usize = 140;
/// Distance from the contour at which a twig ends, over the radius of the contour's greatest inscribed circle.
const NEAR: f64 = 0.1;

/// Returns the number of twigs that fill a contour of some area, square metres, of a plant of some height, metres.
pub(super) fn twigs_for(area: f64, height_m: f64, density: f64) -> usize {
    let room = ROOM * height_m;
    // A person who draws a contour means a cluster.
    count_of(density * area / (room * room), 4, MOST_TWIGS)
}

impl Twigs<'_> {
    /// Grows the twigs; returns their number. `sites` gets the places on bearers and twigs inside the contour.
    ///
    /// A bearer that ends well below the far side of its contour goes on there as a leading shoot. Twigs start along
    /// bearers and leaders at equal arc lengths, in a spiral around them, and are attracted by the contour on their
    /// side (He and Cheng 2021, section 4.3). Twigs on twigs reach the rest.
    pub(super) fn grow(&self, plant: &mut Plant, sites: &mut Vec<Site>) -> usize {
        let before = plant.axes.len();
        let v = self.volume;
        sites.extend(inner_sites(plant, v, self.bearers, self.salt));
        if sites.is_empty() {
            return 0;
        }
        let wanted = self.wanted;
        let mut wobble = self.seed.stream(Draw::TwigPlace);
        let mut points = Vec::new();
        self.leaders(plant, sites, &mut wobble, &mut points);
        let leaders = plant.axes.len() - before;
        // Three in five from the bearers: crowns of young trees branch about once more.
        let first = count_of(0.62 * (wanted as f64), 1, MOST_TWIGS).saturating_sub(leaders).max(1);
        let starts = spaced(plant, sites, first);
        let rim = v.rim(ATTRACTORS);
        let spiral = Phyllotaxis::default();
        let turn = self.seed.stream(Draw::Phyllotaxis).range(0.0, ops::TAU);
        for (rank, &i) in starts.iter().enumerate() {
            let azimuth = turn + spiral.azimuth(u32::try_from(rank).unwrap_or(u32::MAX), 0);
            let from = sites[i];
            if let Some(axis) = self.twig(plant, &mut sites[i], azimuth, &rim, &mut wobble, &mut points) {
                add_sites(plant, axis, 1, from.path, sites);
            }
        }
        let mut stream = self.seed.stream(Draw::Attractors);
        let margin = (0.1 * v.inradius).max(v.cell());
        let mut empty = scatter_rim(v, 3 * wanted, (margin, 0.4), &mut stream);
        empty.extend(scatter_front(v, 3 * wanted, (margin, 0.7), &mut stream));
        // Squared distance of each place to the nearest site; gaps in depth are not seen in the drawing and count half.
        let mut gaps = vec![f64::INFINITY; empty.len()];
        let mut seen = 0;
        while plant.axes.len() - before < wanted {
            for s in &sites[seen..] {
                for (gap, t) in gaps.iter_mut().zip(&empty) {
                    let d = s.at - *t;
                    let d2 = d.truncate().length_squared() + 0.25 * d.z * d.z;
                    *gap = if d2 < *gap { d2 } else { *gap };
                }
            }
            seen = sites.len();
            // Always into the widest gap.
            let widest = (0..empty.len()).max_by(|&a, &b| gaps[a].total_cmp(&gaps[b]));
            let Some(k) = widest else { break };
            let target = empty.swap_remove(k);
            gaps.swap_remove(k);
            let Some(i) = attach(v, sites, target, 0) else { continue };
            let from = sites[i];
            if let Some(axis) = self.shoot(plant, &mut sites[i], target, &mut stream, &mut points) {
                add_sites(plant, axis, from.level + 1, from.path, sites);
            }
        }
        plant.axes.len() - before
    }

    /// Continues bearers whose tips are far from the contour ahead of them.
    fn leaders(
        &self,
        plant: &mut Plant,
        sites: &mut Vec<Site>,
        wobble: &mut base::Stream,
        points: &mut Vec<DVec3>,
    ) {
        let v = self.volume;
        let middle = 0.5 * (v.low() + v.high());
        let middle = middle.extend(v.mid(middle));
        // The last place of every bearer is its tip, or where the contour was left.
        let axis_of = |plant: &Plant, s: &Site| plant.nodes.axis[s.node.index()];
        let tips: Vec<usize> = (0..sites.len())
            .filter(|&i| {
                let last =
                    plant.axis(axis_of(plant, &sites[i])).nodes.end as usize == sites[i].node.index() + 1;
                last || sites.len() == 1
            })
            .collect();
        for i in tips {
            let from = sites[i];
            let start = if v.contains(from.at) { from.at } else { from.at.lerp(middle, 0.35) };
            let to_middle = (middle - start).normalize_or_zero();
            let ahead = (from.tangent + 0.5 * to_middle).try_normalize().unwrap_or(from.tangent);
            let room = v.ray(start, ahead, 2.0 * v.height() + 4.0 * v.half_width);
            if room < 0.4 * v.inradius {
                continue;
            }
            let target = start + ahead * (0.9 * room);
            if let Some(axis) = self.shoot(plant, &mut sites[i], target, wobble, points) {
                add_sites(plant, axis, 0, from.path, sites);
            }
        }
    }

    /// Grows one twig by Eq 2 to the contour, on the side given by an azimuth about its bearer.
    fn twig(
        &self,
        plant: &mut Plant,
        site: &mut Site,
        azimuth: f64,
        rim: &[DVec2],
        wobble: &mut base::Stream,
        points: &mut Vec<DVec3>,
    ) -> Option<AxisId> {
        let v = self.volume;
        let across = site.tangent.cross(DVec3::Z).try_normalize().unwrap_or(DVec3::X);
        let front = across.cross(site.tangent);
        let (sa, ca) = sin_cos(azimuth);
        // Rather in the drawing's plane than towards the viewer: that is where the contour was drawn.
        let out = (across * ca + front * (0.65 * sa)).try_normalize().unwrap_or(across);
        let contour = Turned::new(rim, (site.at, site.tangent), out);
        let step = 0.12 * v.inradius;
        let near = NEAR * v.inradius;
        grow_to_contour(v, &self.spec, (site.at, site.tangent), &contour, (step, near), wobble, points);
        let long = points.last().is_some_and(|end| end.distance(site.at) > 2.0 * step);
        if long { add_axis(plant, site, self.kind, points) } else { None }
    }

    /// Grows one twig by Eq 2, unless it would be no more than a bud.
    fn shoot(
        &self,
        plant: &mut Plant,
        site: &mut Site,
        target: DVec3,
        wobble: &mut base::Stream,
        points: &mut Vec<DVec3>,
    ) -> Option<AxisId> {
        let whole = site.at.distance(target);
        let step = (whole / 9.0).max(0.04 * self.volume.inradius);
        if whole < 0.2 * self.volume.inradius {
            return None;
        }
        grow_toward(self.volume, &self.spec, (site.at, site.tangent), target, step, wobble, points);
        let long = points.last().is_some_and(|end| end.distance(site.at) > 2.0 * step);
        if long { add_axis(plant, site, self.kind, points) } else { None }
    }
}

/// Returns places on the drawn axes inside the contour; if there are none, the place nearest to it.
pub(super) fn inner_sites(plant: &Plant, volume: &Volume, bearers: &[AxisId], salt: u64) -> Vec<Site> {
    let mut sites = Vec::new();
    let mut outside: Option<(f64, Site)> = None;
    for &axis in bearers {
        let mut own = Vec::new();
        add_sites(plant, axis, 0, 0.0, &mut own);
        for s in own {
            if volume.contains_xy(s.at.truncate()) {
                sites.push(s);
            } else {
                let d = distance_to(volume, s.at.truncate());
                if outside.is_none_or(|(b, _)| d < b) {
                    outside = Some((d, s));
                }
            }
        }
    }
    if sites.is_empty() {
        sites.extend(outside.map(|(_, s)| s));
    }
    sites.iter_mut().for_each(|s| s.salt = salt);
    sites
}

fn distance_to(volume: &Volume, p: DVec2) -> f64 {
    volume.nearest_xy(p).distance(p)
}

/// Returns about `n` sites at equal arc lengths, counted through all axes; half a space is left at the start.
fn spaced(plant: &Plant, sites: &[Site], n: usize) -> Vec<usize> {
    let mut along = Vec::with_capacity(sites.len());
    let mut sum = 0.0;
    for (i, s) in sites.iter().enumerate() {
        let same = i > 0 && plant.nodes.axis[s.node.index()] == plant.nodes.axis[sites[i - 1].node.index()];
        if same {
            sum += s.at.distance(sites[i - 1].at);
        }
        along.push(sum);
    }
    let mut out: Vec<usize> = (0..n)
        .map(|k| sum * (k as f64 + 0.5) / n as f64)
        .map(|at| along.partition_point(|a| *a < at).min(sites.len() - 1))
        .collect();
    out.dedup();
    out
}
