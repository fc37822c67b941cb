//! Twigs in a branch contour.
//!
//! `bearers + contour -> twigs by Eq 2 until near the contour`

use base::ops::{self, sin_cos};
use base::{Draw, Seed};
use glam::{DVec2, DVec3};
use plant::{AxisId, AxisKind, Phyllotaxis, Plant};

use super::crown::{MOST_TWIGS, count_of};
use super::grow::{Site, add_axis, add_sites, attach, eq2, grow_toward};
use super::scatter::{scatter, scatter_rim};
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
    /// Which contour of its bearer this is.
    pub(super) salt: u64,
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
        sites.extend(inner_sites(plant, v, self.bearers, self.salt));
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
        let contour = self.attractors(reach, 320, &mut stream);
        let mut wobble = self.seed.stream(Draw::TwigPlace);
        let step = reach / 7.0;
        let starts = spaced(plant, sites, spacing);
        let spiral = Phyllotaxis::default();
        let turn = self.seed.stream(Draw::Phyllotaxis).range(0.0, ops::TAU);
        let mut points = Vec::new();
        for (rank, &i) in starts.iter().enumerate().take(MOST_TWIGS) {
            let azimuth = turn + spiral.azimuth(u32::try_from(rank).unwrap_or(u32::MAX), 0);
            self.follow(sites[i], azimuth, step, &contour, &mut wobble, &mut points);
            let path = sites[i].path;
            if let Some(axis) = self.keep(plant, &mut sites[i], &points, step) {
                add_sites(plant, axis, 1, path, sites);
            }
        }
        // Second order: twigs from twigs to what no twig has come near to.
        let gap = 0.42 * reach / ops::cbrt(self.spec.density);
        let covered = |sites: &[Site], p: DVec3| {
            sites.iter().any(|s| {
                let d = s.at - p;
                // Gaps in depth are not seen in the drawing: they count half.
                d.truncate().length_squared() + 0.25 * d.z * d.z < gap * gap
            })
        };
        let n = count_of(90.0 * self.spec.density, 40, MOST_TWIGS);
        let empty = self.attractors(reach, n, &mut stream);
        // A twig that starts near the contour would run along it.
        let mut inner: Vec<Site> = sites.iter().filter(|s| v.inset(s.at) > 0.3 * reach).copied().collect();
        for target in empty.into_iter().take(MOST_TWIGS.saturating_sub(starts.len())) {
            if covered(sites, target) {
                continue;
            }
            let Some(i) = attach(v, &inner, target, 0) else { continue };
            let from = inner[i];
            grow_toward(v, &self.spec, (from.at, from.tangent), target, step, &mut stream, &mut points);
            if let Some(axis) = self.keep(plant, &mut inner[i], &points, step) {
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
    fn attractors(&self, reach: f64, n: usize, stream: &mut base::Stream) -> Vec<DVec3> {
        let v = self.volume;
        let margin = (0.12 * reach).max(v.cell());
        let mut points = scatter_rim(v, n / 2, (margin, 0.4), stream);
        points.extend(scatter(v, n - points.len(), stream, |p| {
            let inset = v.inset(p);
            inset > margin && inset < margin + 0.22 * v.inradius
        }));
        points
    }

    /// One twig by Eq 2: in every step towards the nearest attraction points on its side, along its
    /// bearer, and on as it went.
    fn follow(
        &self,
        site: Site,
        azimuth: f64,
        step: f64,
        contour: &[DVec3],
        wobble: &mut base::Stream,
        out: &mut Vec<DVec3>,
    ) {
        let v = self.volume;
        out.clear();
        out.push(site.at);
        let across = site.tangent.cross(DVec3::Z).try_normalize().unwrap_or(DVec3::X);
        let front = across.cross(site.tangent);
        let (sa, ca) = sin_cos(azimuth);
        // Rather in the drawing's plane than towards the viewer: that is where the contour was drawn.
        let side = (across * ca + front * (0.65 * sa)).normalize_or_zero();
        let (mut p, mut last) = (site.at, site.tangent);
        for _ in 0..60 {
            // The paper takes the nearest point; a mean that falls off as 1/d^4 is as near and does not jump.
            let (mut toward, mut nearest) = (DVec3::ZERO, f64::INFINITY);
            for &a in contour {
                let from_start = a - site.at;
                if from_start.dot(side) > 0.4 * from_start.length() {
                    let d2 = p.distance_squared(a).max(1e-18);
                    toward += (a - p) / (d2 * d2 * d2.sqrt());
                    nearest = nearest.min(d2);
                }
            }
            let Some(toward) = toward.try_normalize() else { return };
            let noise = DVec3::new(wobble.normal(), wobble.normal(), wobble.normal()) * 0.06;
            let pull =
                eq2(&self.spec, toward, site.tangent, last) + DVec3::Y * (0.5 * self.spec.tropism) + noise;
            let q = p + pull * step;
            if !(v.contains_xy(q.truncate()) && v.contains_xy(p.lerp(q, 0.5).truncate())) {
                return;
            }
            out.push(q);
            if nearest.sqrt() < 0.6 * step || v.inset(q) < 0.5 * step {
                return;
            }
            last = (q - p).try_normalize().unwrap_or(last);
            p = q;
        }
    }
}

/// Places on the drawn axes inside the contour; where there is none, the place nearest to it.
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
