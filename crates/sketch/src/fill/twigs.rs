//! Twigs in a branch contour.
//!
//! `bearers + contour -> twigs by Eq 2 until near the contour`

use base::ops::{self, sin_cos};
use base::{Draw, Seed};
use glam::{DVec2, DVec3};
use plant::{AxisId, AxisKind, Phyllotaxis, Plant};

use super::crown::{MOST_TWIGS, count_of};
use super::grow::{Site, add_axis, add_sites, attach, eq2, grow_toward};
use super::scatter::scatter;
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
}

impl Twigs<'_> {
    /// Grows the twigs; returns how many. `sites` gets the places on bearers and twigs inside the contour.
    ///
    /// Twigs start along the bearers at equal arc lengths, in a spiral around them, and are drawn to the
    /// nearest attraction point on their side (paper 000, section 4.3). What stays empty then is reached by
    /// twigs from twigs.
    pub(super) fn grow(&self, plant: &mut Plant, sites: &mut Vec<Site>) -> usize {
        let before = plant.axes.len();
        let v = self.volume;
        sites.extend(inner_sites(plant, v, self.bearers));
        if sites.is_empty() {
            return 0;
        }
        let mean =
            sites.iter().map(|s| v.clearance(s.at.truncate()).max(0.0)).sum::<f64>() / sites.len() as f64;
        let reach = mean.max(0.25 * v.inradius);
        // 0.3: a contour five times as long as its half width gets some fifteen twigs, as in sketch (a) of the
        // paper's Table 1.
        let spacing = 0.3 * reach / self.spec.density;
        let mut stream = self.seed.stream(Draw::Attractors);
        let attractors = self.attractors(reach, &mut stream);
        let step = reach / 7.0;
        let starts = spaced(plant, sites, spacing);
        let spiral = Phyllotaxis::default();
        let turn = self.seed.stream(Draw::Phyllotaxis).range(0.0, ops::TAU);
        let mut points = Vec::new();
        let mut taken = vec![false; attractors.len()];
        for (rank, &i) in starts.iter().enumerate().take(MOST_TWIGS) {
            let azimuth = turn + spiral.azimuth(u32::try_from(rank).unwrap_or(u32::MAX), 0);
            self.follow(sites[i], azimuth, step, &attractors, &mut taken, &mut points);
            let path = sites[i].path;
            if let Some(axis) = self.keep(plant, &mut sites[i], &points, step) {
                add_sites(plant, axis, 1, path, sites);
            }
        }
        // Second order: what is farther from every twig than they are from each other.
        let gap = 1.1 * ops::cbrt(v.bulk() / count_of(2.2 * starts.len() as f64, 8, MOST_TWIGS) as f64);
        let empty: Vec<DVec3> = attractors
            .iter()
            .filter(|a| sites.iter().all(|s| s.at.distance_squared(**a) > 0.4 * gap * gap))
            .copied()
            .collect();
        for target in empty.into_iter().take(MOST_TWIGS.saturating_sub(starts.len())) {
            if sites.iter().any(|s| s.at.distance_squared(target) < 0.4 * gap * gap) {
                continue;
            }
            let Some(i) = attach(v, sites, target, 0) else { continue };
            let from = sites[i];
            grow_toward(v, &self.spec, (from.at, from.tangent), target, step, &mut stream, &mut points);
            if let Some(axis) = self.keep(plant, &mut sites[i], &points, step) {
                add_sites(plant, axis, 2, from.path, sites);
            }
        }
        plant.axes.len() - before
    }

    fn keep(&self, plant: &mut Plant, site: &mut Site, points: &[DVec3], step: f64) -> Option<AxisId> {
        // Shorter than two steps it would be a bud.
        let long = points.first().zip(points.last()).is_some_and(|(a, b)| a.distance(*b) > 1.5 * step);
        if long { add_axis(plant, site, self.kind, points) } else { None }
    }

    /// Points on the contour (drawn in by a little) and on the body's front and back.
    fn attractors(&self, reach: f64, stream: &mut base::Stream) -> Vec<DVec3> {
        let v = self.volume;
        let margin = (0.12 * reach).max(v.cell());
        let n = count_of(110.0 * self.spec.density, 40, MOST_TWIGS);
        scatter(v, n, stream, |p| {
            let inset = v.inset(p);
            inset > margin && inset < margin + 0.22 * v.inradius
        })
    }

    /// One twig by Eq 2: in every step towards the nearest free attraction point on its side, along its
    /// bearer, and on as it went.
    fn follow(
        &self,
        site: Site,
        azimuth: f64,
        step: f64,
        attractors: &[DVec3],
        taken: &mut [bool],
        out: &mut Vec<DVec3>,
    ) {
        let v = self.volume;
        out.clear();
        out.push(site.at);
        let across = site.tangent.cross(DVec3::Z).try_normalize().unwrap_or(DVec3::X);
        let front = across.cross(site.tangent);
        let (sa, ca) = sin_cos(azimuth);
        let side = (across * ca + front * (0.8 * sa)).normalize_or_zero();
        let (mut p, mut last) = (site.at, site.tangent);
        for _ in 0..60 {
            let mut best: Option<(f64, usize)> = None;
            for (k, a) in attractors.iter().enumerate() {
                let from_start = *a - site.at;
                let d = p.distance_squared(*a);
                if !taken[k]
                    && best.is_none_or(|(b, _)| d < b)
                    && from_start.dot(side) > 0.3 * from_start.length()
                    && from_start.dot(site.tangent) > -0.1 * from_start.length()
                {
                    best = Some((d, k));
                }
            }
            let Some((d, k)) = best else { return };
            let to = (attractors[k] - p) / d.sqrt().max(1e-12);
            let pull = eq2(&self.spec, to, site.tangent, last) + DVec3::Y * (0.5 * self.spec.tropism);
            let q = p + pull * step;
            let arrived = d.sqrt() < 1.2 * step;
            let q = if arrived { attractors[k] } else { q };
            let mid = p.lerp(q, 0.5).truncate();
            if !(v.contains_xy(q.truncate()) && v.contains_xy(mid)) {
                return;
            }
            out.push(q);
            if arrived || v.inset(q) < 0.5 * step {
                taken[k] = true;
                return;
            }
            last = (q - p).try_normalize().unwrap_or(last);
            p = q;
        }
    }
}

/// Places on the drawn axes inside the contour; where there is none, the place nearest to it.
pub(super) fn inner_sites(plant: &Plant, volume: &Volume, bearers: &[AxisId]) -> Vec<Site> {
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
    sites
}

fn distance_to(volume: &Volume, p: DVec2) -> f64 {
    volume.nearest_xy(p).distance(p)
}

/// Sites about `spacing` apart along each axis, the tip's included.
pub(super) fn spaced(plant: &Plant, sites: &[Site], spacing: f64) -> Vec<usize> {
    let mut out = Vec::new();
    let mut last: Option<(AxisId, f64)> = None;
    for (i, s) in sites.iter().enumerate() {
        let axis = plant.nodes.axis[s.node.index()];
        let far = match last {
            Some((a, at)) => a != axis || s.path - at >= spacing,
            None => true,
        };
        if far {
            out.push(i);
            last = Some((axis, s.path));
        }
    }
    out
}
