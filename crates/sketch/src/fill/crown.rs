//! The crown of a tree from its contour.
//!
//! `contour + trunk -> leader and limbs -> branches -> twigs -> leaves`
//!
//! From large to small (Runions 2007, Fig 8): every level scatters attraction points in the space that the last one
//! left empty, joins each to the place from which it is best reached, and grows there by Eq 2 of He and Cheng (2021).

use base::ops::sin_cos;
use base::{Draw, Seed, ops};
use glam::{DVec2, DVec3};
use plant::{AxisId, AxisKind, Phyllotaxis, Plant};

use super::foliage::{Foliage, dress};
use super::grow::{Site, add_axis, add_sites, attach, grow_toward, tangent};
use super::scatter::{scatter, scatter_front, scatter_rim};
use super::volume::Volume;
use crate::FillSpec;

/// Leaves that a twig of a crown bears, with its share of those on the branches.
const LEAVES_A_TWIG: f64 = 9.5;
/// Most twigs of one region.
pub(super) const MOST_TWIGS: usize = 4_000;

/// Input of the growth of a crown.
#[derive(Debug)]
pub(super) struct Crown<'a> {
    pub(super) volume: &'a Volume,
    pub(super) spec: FillSpec,
    pub(super) seed: Seed,
    /// Drawn axes that run into it, the trunk first.
    pub(super) bearers: &'a [AxisId],
    pub(super) foliage: Foliage,
    /// Leaves wanted.
    pub(super) leaves: usize,
    pub(super) habit: Habit,
    /// Whether branches are woody.
    pub(super) woody: bool,
    /// Rank of this contour among those of its bearer.
    pub(super) salt: u64,
}

/// The build of a crown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Habit {
    /// The trunk dissolves into limbs: most broad-leaved trees.
    Decurrent,
    /// The trunk runs through to the top and bears whorls: conifers.
    Excurrent,
    /// Several stems from the ground.
    Shrub,
}

impl Habit {
    /// Returns the habit that a contour and its trunk suggest.
    ///
    /// A crown with a height of at least 0.9 times its width, whose upper part is less than 0.45 times as wide as its
    /// lower part, is a conifer's (a circle has 0.9, an egg 0.6, a triangle 0.25). If the trunk below it is too short,
    /// it is a shrub.
    pub(super) fn infer(volume: &Volume, trunk: &[DVec3]) -> Self {
        let (low, height) = (volume.low().y, volume.height());
        let mean = |from: f64, to: f64| {
            let rows = (0..6).map(|i| ops::lerp(from, to, f64::from(i) / 5.0));
            rows.filter_map(|t| volume.row(low + t * height)).map(|(_, w)| w).sum::<f64>() / 6.0
        };
        let pointed = mean(0.74, 0.92) < 0.45 * mean(0.08, 0.35);
        if pointed && height > 1.8 * volume.half_width {
            return Self::Excurrent;
        }
        let foot = trunk.first().map_or(low, |p| p.y);
        if low - foot < 0.1 * height { Self::Shrub } else { Self::Decurrent }
    }
}

impl Crown<'_> {
    /// Grows the crown; returns the number of axes and leaves added.
    pub(super) fn grow(&self, plant: &mut Plant) -> (usize, usize) {
        let axes = plant.axes.len();
        let mut sites = self.drawn_sites(plant);
        let mut placed = 0;
        match self.habit {
            Habit::Excurrent => self.whorls(plant, &mut sites, &mut placed),
            Habit::Decurrent | Habit::Shrub => {
                let limbs = self.limbs(plant, &mut sites);
                let branches = self.branches(plant, &mut sites, limbs);
                self.twigs(plant, &mut sites, &branches, &mut placed);
            }
        }
        (plant.axes.len() - axes, placed)
    }

    fn kind(&self) -> AxisKind {
        if self.woody { AxisKind::Branch } else { AxisKind::Stem }
    }

    fn twig_kind(&self) -> AxisKind {
        if self.woody { AxisKind::Twig } else { AxisKind::Stem }
    }

    /// Returns places on the drawn axes from which the crown may grow: those inside, else the trunk's tip.
    fn drawn_sites(&self, plant: &Plant) -> Vec<Site> {
        let mut sites = Vec::new();
        for &axis in self.bearers {
            let mut own = Vec::new();
            add_sites(plant, axis, 0, 0.0, &mut own);
            let tip = own.last().copied();
            own.retain(|s| self.volume.contains_xy(s.at.truncate()));
            if own.is_empty() {
                own.extend(tip);
            }
            let entry = own.first().map_or(0.0, |s| s.path);
            own.iter_mut().for_each(|s| s.path -= entry);
            sites.extend(own);
        }
        if self.habit == Habit::Shrub {
            // Stems leave the trunk's foot as well.
            if let Some(&axis) = self.bearers.first() {
                let points = plant.axis_points(axis);
                if let (Some(node), Some(&at)) = (plant.axis(axis).node_ids().next(), points.first()) {
                    let tangent = tangent(points, 0);
                    sites.insert(0, Site { node, at, tangent, level: 0, path: 0.0, used: 0, salt: 0 });
                }
            }
        }
        sites.iter_mut().for_each(|s| s.salt = self.salt);
        sites
    }

    /// Returns a point of the body seen from `from` in the direction of an azimuth and an elevation, at `share` of the
    /// distance to the surface.
    fn aim(&self, from: DVec3, azimuth: f64, elevation: f64, share: f64) -> DVec3 {
        let ((sa, ca), (se, ce)) = (sin_cos(azimuth), sin_cos(elevation));
        let direction = DVec3::new(ca * ce, se, sa * ce);
        let reach =
            self.volume.ray(from, direction, 2.0 * self.volume.height() + 4.0 * self.volume.half_width);
        from + direction * (reach * share)
    }

    /// Extends the trunk to `top`; adds the new places.
    fn leader(&self, plant: &mut Plant, sites: &mut Vec<Site>, top: DVec3, step: f64) -> Option<AxisId> {
        let highest = (0..sites.len()).max_by(|&a, &b| sites[a].at.y.total_cmp(&sites[b].at.y))?;
        let from = sites[highest];
        if top.y - from.at.y < 1.5 * step {
            return None;
        }
        let mut wobble = self.seed.stream(Draw::BranchDepth);
        let mut points = Vec::new();
        // A leader keeps its course.
        let spec = FillSpec { bearer_pull: 0.3, contour_pull: 0.5, memory: 0.4, tropism: 0.1, ..self.spec };
        grow_toward(self.volume, &spec, (from.at, from.tangent), top, step, &mut wobble, &mut points);
        let axis = add_axis(plant, &mut sites[highest], self.kind(), &points)?;
        add_sites(plant, axis, 0, from.path, sites);
        // If the trunk ends below the crown, the crown grows from the places inside only.
        let inside = |s: &Site| self.volume.contains_xy(s.at.truncate());
        if sites.iter().any(inside) {
            sites.retain(inside);
        }
        Some(axis)
    }

    /// Grows the main limbs around the trunk (golden angle) or from the ground. Returns the axes.
    fn limbs(&self, plant: &mut Plant, sites: &mut Vec<Site>) -> Vec<AxisId> {
        let v = self.volume;
        let (low, height) = (v.low().y, v.height());
        let step = 0.06 * height.min(2.0 * v.half_width).max(0.5 * height);
        let drawn = sites.iter().filter(|s| v.contains_xy(s.at.truncate())).count();
        let mut limbs = Vec::new();
        // Three drawn branches inside are the tree's own limbs: nothing to add to them.
        if self.bearers.len() >= 4 && drawn >= 12 {
            return limbs;
        }
        let mut stream = self.seed.stream(Draw::Phyllotaxis);
        let start = stream.range(0.0, ops::TAU);
        let mut points = Vec::new();
        let spiral = Phyllotaxis::default();
        let shrub = self.habit == Habit::Shrub;
        if !shrub {
            let (x, _) = v.row(low + 0.62 * height).unwrap_or((0.5 * (v.low().x + v.high().x), 0.0));
            let top = DVec2::new(x, low + 0.62 * height);
            limbs.extend(self.leader(plant, sites, top.extend(v.mid(top)), step));
        }
        let bases: Vec<usize> = if shrub {
            vec![0]
        } else {
            (0..sites.len()).filter(|&i| sites[i].at.y < low + 0.66 * height).collect()
        };
        if bases.is_empty() || sites.is_empty() {
            return limbs;
        }
        let wide = (2.0 * v.half_width / height).clamp(0.5, 2.0);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "4 to 11")]
        let count = (6.0 + 2.0 * (wide - 0.5)).round() as u32;
        for i in 0..count {
            let f = (f64::from(i) + stream.range(0.2, 0.8)) / f64::from(count);
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "f is below 1")]
            let site = bases[((f * bases.len() as f64) as usize).min(bases.len() - 1)];
            let azimuth = start + spiral.azimuth(i, 0) + stream.range(-0.25, 0.25);
            // Low limbs spread, high ones rise; shrubs' stems fan out from steep to slanting.
            let elevation =
                if shrub { ops::lerp(1.35, 0.55, f) } else { ops::lerp(0.3, 1.15, f) / wide.max(0.8) };
            let from = sites[site].at;
            let anchor = if v.contains(from) { from } else { self.entry(from) };
            let target = self.aim(anchor, azimuth, elevation, 0.74);
            if target.distance(from) < 2.5 * step {
                continue;
            }
            let bearer = sites[site].tangent;
            grow_toward(v, &self.spec, (from, bearer), target, step, &mut stream, &mut points);
            let path = sites[site].path;
            if let Some(axis) = add_axis(plant, &mut sites[site], self.kind(), &points) {
                add_sites(plant, axis, 1, path, sites);
                limbs.push(axis);
            }
        }
        limbs
    }

    /// Returns a point inside the body near one that is not.
    fn entry(&self, from: DVec3) -> DVec3 {
        let v = self.volume;
        let middle = 0.5 * (v.low() + v.high());
        (1..20)
            .map(|i| from.truncate().lerp(middle, f64::from(i) / 20.0))
            .find(|&p| v.clearance(p) > 2.0 * v.cell())
            .map_or_else(|| middle.extend(v.mid(middle)), |p| p.extend(v.mid(p)))
    }

    /// Grows branches of the second level, towards points scattered through the body. Returns all axes that may bear
    /// leaves at their ends.
    fn branches(&self, plant: &mut Plant, sites: &mut Vec<Site>, mut axes: Vec<AxisId>) -> Vec<AxisId> {
        let v = self.volume;
        let n = count_of(26.0 * ops::powf(self.spec.density, 0.6), 6, MOST_TWIGS / 6);
        let depth = v.inradius;
        let mut stream = self.seed.child(2).stream(Draw::Attractors);
        let mut targets = scatter(v, n, &mut stream, |p| {
            let inset = v.inset(p);
            inset > 0.08 * depth && inset < 0.6 * depth
        });
        near_first(&mut targets, sites);
        let mut points = Vec::new();
        let step = 0.09 * depth.max(0.3 * v.height());
        for target in targets {
            let Some(i) = attach(v, sites, target, 0) else { continue };
            let from = sites[i];
            if from.at.distance(target) < 2.0 * step {
                continue;
            }
            grow_toward(v, &self.spec, (from.at, from.tangent), target, step, &mut stream, &mut points);
            if let Some(axis) = add_axis(plant, &mut sites[i], self.kind(), &points) {
                add_sites(plant, axis, 2, from.path, sites);
                axes.push(axis);
            }
        }
        axes
    }

    /// Grows twigs of the third level, on the shell of the body, and the leaves.
    fn twigs(&self, plant: &mut Plant, sites: &mut [Site], branches: &[AxisId], placed: &mut usize) {
        let v = self.volume;
        let n = count_of(self.leaves as f64 / LEAVES_A_TWIG, 24, MOST_TWIGS);
        self.fill_shell(plant, sites, n, placed);
        for &axis in branches {
            dress(plant, v, &self.foliage, axis, 0.5, placed);
        }
    }

    /// Grows up to `n` leafy twigs from `sites` to points of the shell and of the contour's rim.
    fn fill_shell(&self, plant: &mut Plant, sites: &mut [Site], n: usize, placed: &mut usize) {
        let v = self.volume;
        let length = self.foliage.length;
        let mut stream = self.seed.child(3).stream(Draw::Attractors);
        // Leaves live where light is: a shell of 0.55 of the radius.
        let margin = (0.3 * length).min(0.2 * v.inradius);
        let mut targets = scatter_rim(v, n / 7, (margin, 0.5), &mut stream);
        // As many evenly in the drawing's plane as in the shell: no holes in the front view.
        targets.extend(scatter_front(v, n / 2, (margin, 0.95), &mut stream));
        targets.extend(scatter(v, n - targets.len(), &mut stream, |p| {
            let inset = v.inset(p);
            inset > margin && inset < 0.55 * v.inradius
        }));
        near_first(&mut targets, sites);
        let step = (0.45 * length).min(0.2 * v.inradius);
        let mut points = Vec::new();
        for target in targets {
            let Some(i) = attach(v, sites, target, 1) else { continue };
            let from = sites[i];
            grow_toward(v, &self.spec, (from.at, from.tangent), target, step, &mut stream, &mut points);
            if let Some(axis) = add_axis(plant, &mut sites[i], self.twig_kind(), &points) {
                dress(plant, v, &self.foliage, axis, 0.18, placed);
            }
        }
    }

    /// Grows a conifer: a leader to the top, whorls of boughs, sprays on both sides of each.
    fn whorls(&self, plant: &mut Plant, sites: &mut Vec<Site>, placed: &mut usize) {
        let v = self.volume;
        let (low, height) = (v.low().y, v.height());
        let top = (0..24)
            .map(|i| low + height * (0.985 - 0.01 * f64::from(i)))
            .find_map(|y| v.row(y).map(|(x, _)| DVec2::new(x, y)))
            .unwrap_or(0.5 * (v.low() + v.high()));
        let step = height / 48.0;
        if let Some(leader) = self.leader(plant, sites, top.extend(v.mid(top)), step) {
            dress(plant, v, &self.foliage, leader, 0.88, placed);
        }
        let trunk = sites.clone();
        let mut stream = self.seed.stream(Draw::Phyllotaxis);
        let mut points = Vec::new();
        let density = ops::powf(self.spec.density, 0.5);
        let mut boughs = Vec::new();
        let (mut y, mut whorl) = (low + 0.035 * height, 0);
        while y < top.y - 0.02 * height && whorl < 60 {
            let up = ((y - low) / height).clamp(0.0, 1.0);
            let spacing = height * ops::lerp(0.075, 0.045, up) / density;
            // An even number, every other whorl with boughs in the drawing plane: they reach the drawn contour.
            let per = 2 * count_of(ops::lerp(3.6, 2.6, up) * density, 2, 8);
            for k in 0..per {
                let rank = whorl * 16 + k;
                let turn = k as f64 + if whorl % 2 == 0 { 0.0 } else { 0.5 };
                let azimuth = ops::TAU * turn / per as f64 + stream.range(-0.14, 0.14);
                // Old boughs stand out flat, young ones rise.
                let elevation = ops::lerp(0.0, 0.7, up * up) + stream.range(-0.05, 0.06);
                // Boughs of one whorl start at nearly, not quite, the same height.
                let start = y + spacing * stream.range(-0.35, 0.35);
                let Some(site) = nearest_in_height(&trunk, start) else { return };
                let own =
                    self.bough(plant, &mut sites[site], (azimuth, elevation, rank), &mut points, placed);
                boughs.extend(own);
            }
            whorl += 1;
            y += spacing;
        }
        // The gaps between whorls: short shoots from the boughs.
        boughs.extend(trunk);
        let n = count_of(self.leaves as f64 / 5.0, 24, MOST_TWIGS);
        self.fill_shell(plant, &mut boughs, n, placed);
    }

    /// Grows one bough with its laterals and sprays.
    fn bough(
        &self,
        plant: &mut Plant,
        site: &mut Site,
        (azimuth, elevation, rank): (f64, f64, usize),
        points: &mut Vec<DVec3>,
        placed: &mut usize,
    ) -> Vec<Site> {
        let v = self.volume;
        let length = self.foliage.length;
        let from = site.at;
        let anchor = if v.contains(from) { from } else { self.entry(from) };
        let target = self.aim(anchor, azimuth, elevation, 0.93);
        let reach = target.distance(from);
        let step = (0.55 * length).max(reach / 24.0);
        if reach < 1.2 * step {
            return Vec::new();
        }
        let seed = self.seed.child(rank as u64);
        let mut stream = seed.stream(Draw::TwigPlace);
        // Old boughs sag and lift their ends, young ones start upwards.
        let up = ((from.y - v.low().y) / v.height()).clamp(0.0, 1.0);
        let flat = (target - from).with_y(0.0).normalize_or_zero() + DVec3::Y * ops::lerp(-0.3, 0.5, up);
        let spec = FillSpec { tropism: 0.0, ..self.spec };
        grow_toward(v, &spec, (from, flat), target, step, &mut stream, points);
        let Some(axis) = add_axis(plant, site, self.kind(), points) else { return Vec::new() };
        let bough: Vec<DVec3> = points.clone();
        dress(plant, v, &self.foliage, axis, 0.1, placed);
        let mut own = Vec::new();
        add_sites(plant, axis, 1, site.path, &mut own);
        let n = bough.len();
        for (i, s) in own.iter_mut().enumerate().take(n.saturating_sub(2)) {
            let share = (i + 1) as f64 / (n - 1) as f64;
            let side = if i % 2 == 0 { 1.0 } else { -1.0 };
            let across = s.tangent.cross(DVec3::Y).normalize_or_zero() * side;
            // Longest at a third of the bough.
            let long = reach * 0.42 * (1.0 - share) * (0.5 + 1.5 * share).min(1.0);
            if long < 0.7 * length {
                continue;
            }
            let direction = (s.tangent * 0.75 + across * 0.9 - DVec3::Y * 0.12).normalize_or_zero();
            let room = v.ray(s.at, direction, long);
            let target = s.at + direction * room;
            grow_toward(v, &spec, (s.at, s.tangent), target, step, &mut stream, points);
            if let Some(twig) = add_axis(plant, s, self.twig_kind(), points) {
                dress(plant, v, &self.foliage, twig, 0.2, placed);
            }
        }
        own
    }
}

/// Returns a count from a real number, bounded; `least` for NaN.
pub(super) fn count_of(x: f64, least: usize, most: usize) -> usize {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "float casts saturate")]
    let n = x.round().max(0.0) as usize;
    n.clamp(least, most)
}

fn nearest_in_height(sites: &[Site], y: f64) -> Option<usize> {
    (0..sites.len()).min_by(|&a, &b| (sites[a].at.y - y).abs().total_cmp(&(sites[b].at.y - y).abs()))
}

/// Sorts targets by their distance to existing places, nearest first: near ones become stepping stones.
fn near_first(targets: &mut Vec<DVec3>, sites: &[Site]) {
    let mut keyed: Vec<(f64, DVec3)> = targets
        .iter()
        .map(|t| (sites.iter().map(|s| s.at.distance_squared(*t)).fold(f64::INFINITY, f64::min), *t))
        .collect();
    base::sort_by(&mut keyed, |a, b| a.0.total_cmp(&b.0));
    targets.clear();
    targets.extend(keyed.into_iter().map(|(_, t)| t));
}
