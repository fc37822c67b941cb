//! Self-organising trees: buds compete for light or space, and the tree shares out what they gather.
//!
//! `roots -> (light of buds -> shares -> shoots -> shedding -> wood) x years -> Skeleton` (Palubicki et al. 2009)

mod grove;
mod resource;
mod shadow;
mod space;
mod spec;

use base::ops::{self, PI};
use base::{Draw, Report, Run, Seed};
use glam::DVec3;
use plant::Phyllotaxis;

use crate::colonize::plant_roots;
use crate::{GrowthError, Obstacles, Skeleton};
use grove::{Grove, NONE};
use resource::{Flow, Sharing};
use space::Space;

pub use spec::{Light, Resource, SelfOrganizingSpec};

pub(crate) use shadow::ShadowGrid;

/// What self-organising growth made.
#[derive(Clone, Debug, PartialEq)]
pub struct SelfOrganized {
    /// All trees, with the radii that their wood has reached.
    pub skeleton: Skeleton,
    /// Internodes ever grown, shed ones included.
    pub generated: usize,
    /// Internodes shed.
    pub shed: usize,
}

/// Grows trees year by year, one from each root; they shade one another.
///
/// Guaranteed: it ends; a clean `validate()`; no joint in an obstacle; radii that never fell; the tree of year n does
/// not depend on how many years follow. Cost: linear in the internodes of each year.
///
/// # Errors
/// [`GrowthError`]: numbers out of range, no roots, a root in an obstacle, an envelope without room, cancelled.
///
/// ```
/// use base::{Report, Run, Seed};
/// use glam::DVec3;
/// use growth::{Obstacles, SelfOrganizingSpec, self_organize};
/// let spec = SelfOrganizingSpec { years: 10, ..SelfOrganizingSpec::default() };
/// let (run, mut report) = (Run::plain(), Report::default());
/// let tree = self_organize(&[DVec3::ZERO], &Obstacles::none(), &spec, Seed::new(1), &run, &mut report)?;
/// assert!(tree.skeleton.len() > 100 && tree.skeleton.radius_m[0] > tree.skeleton.radius_m[9]);
/// # Ok::<(), growth::GrowthError>(())
/// ```
pub fn self_organize(
    roots: &[DVec3],
    obstacles: &Obstacles,
    spec: &SelfOrganizingSpec,
    seed: Seed,
    run: &Run<'_>,
    report: &mut Report,
) -> Result<SelfOrganized, GrowthError> {
    let numbers = spec.check()?;
    let started = run.clock.now_ms();
    let skeleton = plant_roots(roots, obstacles)?;
    let light = match &spec.light {
        Light::Shadow { voxel_m, a, b, layers, full } => {
            let voxel = voxel_m.unwrap_or(2.0 * spec.internode_m);
            LightModel::Shadow(ShadowGrid::new(voxel, *a, *b, *layers), *full)
        }
        Light::Space { envelope, markers, occupancy, perception, half_angle_deg } => {
            let reach = (occupancy * spec.internode_m, perception * spec.internode_m);
            let region = envelope.prepare()?;
            let mut places = Vec::new();
            for (root, i) in roots.iter().zip(0_u64..) {
                let free = |p: DVec3| obstacles.free(*root + p);
                let own = region.scatter(*markers as usize, 0.0, seed.child(i), free)?;
                places.extend(own.into_iter().map(|p| *root + p));
            }
            LightModel::Space(Space::new(&places, reach, half_angle_deg * (PI / 180.0)))
        }
    };
    let grove = Grove::new(skeleton, numbers.phyllotaxis.per_node() as usize);
    let mut forest = Forest {
        spec,
        obstacles,
        seed,
        phyllotaxis: numbers.phyllotaxis,
        pull: numbers.pull,
        grove,
        light,
        flow: Flow::default(),
        bud_light: Vec::new(),
        bud_pull: Vec::new(),
        mean_light: Vec::new(),
        generated: 0,
        shed: 0,
    };
    forest.cast_from(0);
    for year in 0..spec.years {
        run.cancel.check()?;
        if forest.grove.len() >= spec.max_joints as usize {
            let n = forest.grove.len();
            report.warn(
                "growth-stopped",
                format!("growth stopped in year {year} at {n} joints, the most allowed"),
            );
            break;
        }
        forest.year(year);
    }
    let Forest { mut grove, generated, shed, .. } = forest;
    for (r, w) in grove.skeleton.radius_m.iter_mut().zip(&grove.wood) {
        *r = ops::powf(*w, 1.0 / spec.pipe_exponent);
    }
    report.book("grow", run.clock.now_ms() - started);
    debug_assert_eq!(grove.skeleton.validate().next(), None, "a grown skeleton is sound");
    Ok(SelfOrganized { skeleton: grove.skeleton, generated, shed })
}

enum LightModel {
    Shadow(ShadowGrid, f64),
    Space(Space),
}

struct Forest<'a> {
    spec: &'a SelfOrganizingSpec,
    obstacles: &'a Obstacles,
    seed: Seed,
    phyllotaxis: Phyllotaxis,
    pull: DVec3,
    grove: Grove,
    light: LightModel,
    flow: Flow,
    /// Light Q and best direction V of the buds at each joint; terminal and axillary buds of a joint share them in
    /// the shadow model, and are told apart in `bud_pull` in the space model.
    bud_light: Vec<f64>,
    bud_pull: Vec<DVec3>,
    /// Light per internode of each branch over the last years, by its first joint.
    mean_light: Vec<f64>,
    generated: usize,
    shed: usize,
}

impl Forest<'_> {
    fn year(&mut self, year: u32) {
        self.look();
        self.flow.gather(&self.grove, &self.bud_light);
        self.drop_dark_branches(year);
        let share = (f64::from(year) / f64::from(self.spec.lambda_years.max(1))).min(1.0);
        let sharing = match self.spec.resource {
            Resource::BorchertHonda { lambda, lambda_late } => {
                Sharing::Fork { lambda: lambda + (lambda_late.unwrap_or(lambda) - lambda) * share }
            }
            Resource::Priority { w_max, w_min, kappa } => Sharing::Rank { w_max, w_min, kappa },
        };
        self.flow.share(&self.grove, &self.bud_light, self.spec.alpha, sharing);
        self.sprout(year + 1);
        let tip = ops::powf(self.spec.tip_radius_m, self.spec.pipe_exponent);
        self.grove.thicken(tip);
    }

    /// Light and direction of every bud.
    fn look(&mut self) {
        let n = self.grove.len();
        self.bud_light.clear();
        self.bud_light.resize(n, 0.0);
        self.bud_pull.clear();
        self.bud_pull.resize(n, DVec3::ZERO);
        match &mut self.light {
            LightModel::Shadow(grid, full) => {
                for j in 0..n {
                    if self.grove.main[j] != NONE && self.grove.waiting_buds(j) == 0 {
                        continue;
                    }
                    let (s, slope) = grid.sample(self.grove.skeleton.position[j]);
                    let own = if self.spec.self_shadow { 0.0 } else { grid.own() };
                    self.bud_light[j] = (*full - s + own).max(0.0);
                    self.bud_pull[j] = slope.normalize_or_zero();
                }
            }
            LightModel::Space(space) => {
                space.look(&self.grove);
                for j in 0..n {
                    let (q, v) = space.of_joint(j);
                    self.bud_light[j] = q;
                    self.bud_pull[j] = v;
                }
            }
        }
    }

    /// Sheds branches that gather too little light for their size (Takenaka 1994).
    fn drop_dark_branches(&mut self, year: u32) {
        let n = self.grove.len();
        self.mean_light.resize(n, f64::NAN);
        // The space model knows lit and dark only: there the mean of about five years decides.
        let fresh = if matches!(self.light, LightModel::Space(_)) { 0.2 } else { 1.0 };
        let mut stays = vec![true; n];
        let mut any = false;
        for j in 0..n {
            let parent = self.grove.parent(j);
            if parent.is_some_and(|p| !stays[p]) {
                stays[j] = false;
                continue;
            }
            if parent.is_none() || !self.grove.starts_axis(j) {
                continue;
            }
            let now = self.flow.light[j] / self.flow.size[j];
            let before = if self.mean_light[j].is_nan() { now.max(1.0) } else { self.mean_light[j] };
            self.mean_light[j] = before + (now - before) * fresh;
            let old_enough = year > self.grove.skeleton.birth[j] + self.spec.shed_after_years;
            if old_enough && self.mean_light[j] < self.spec.shed_below {
                stays[j] = false;
                any = true;
            }
        }
        if !any {
            return;
        }
        // What is shed no longer casts shadow; its light no longer counts below.
        if let LightModel::Shadow(grid, _) = &mut self.light {
            (0..n).filter(|&j| !stays[j]).for_each(|j| grid.add(self.grove.skeleton.position[j], -1));
        }
        self.shed += stays.iter().filter(|&&s| !s).count();
        self.grove.keep(&stays);
        let mut kept = stays.iter();
        let keep = |_: &f64| kept.next().copied().unwrap_or(false);
        self.mean_light.retain(keep);
        let mut kept = stays.iter();
        self.bud_light.retain(|_| kept.next().copied().unwrap_or(false));
        let mut kept = stays.iter();
        self.bud_pull.retain(|_| kept.next().copied().unwrap_or(false));
        if let LightModel::Space(space) = &mut self.light {
            space.keep(&stays);
        }
        self.flow.gather(&self.grove, &self.bud_light);
    }

    /// Buds with a vigour of 1 or more grow as many internodes.
    fn sprout(&mut self, birth: u32) {
        let n = self.grove.len();
        for j in 0..n {
            if self.grove.len() >= self.spec.max_joints as usize {
                break;
            }
            if self.grove.main[j] == NONE {
                let v = self.flow.terminal[j];
                self.shoot(j, None, self.grove.heading[j], v, birth);
            }
            for k in self.grove.bud_range(j) {
                if self.grove.waits[k] {
                    let v = self.flow.axillary[k];
                    self.shoot(j, Some(k), self.grove.bud_heading[k], v, birth);
                }
            }
        }
        self.cast_from(n);
        self.generated += self.grove.len() - n;
    }

    fn shoot(&mut self, joint: usize, bud: Option<usize>, heading: DVec3, vigour: f64, birth: u32) {
        // Never more than the spec allows: a seedling in full light would leap.
        let vigour = vigour.min(f64::from(self.spec.most_per_shoot) + 0.999);
        let n = vigour.floor();
        if n < 1.0 {
            return;
        }
        let length = self.spec.internode_m * vigour / n;
        let mut v = self.bud_pull[joint];
        if let LightModel::Space(space) = &self.light {
            v = space.of_bud(joint, bud);
        }
        let lead = v * self.spec.light_weight + self.pull;
        let (mut from, mut bud, mut heading, mut left) = (joint, bud, heading, n);
        while left >= 1.0 {
            let Some(wish) = (heading + lead).try_normalize() else { return };
            let open = self.obstacles.is_empty();
            let at = self.grove.skeleton.position[from];
            let Some(to) = (if open { Some(wish) } else { self.obstacles.steer(at, wish, length) }) else {
                return;
            };
            let next = self.grove.grow(from, bud.take(), to, length, birth);
            self.set_buds(next);
            (from, heading) = (next, to);
            left -= 1.0;
        }
    }

    /// Axillary buds of a new joint, around it by phyllotaxis.
    fn set_buds(&mut self, joint: usize) {
        let grove = &mut self.grove;
        let (heading, side) = (grove.heading[joint], grove.side[joint]);
        let across = heading.cross(side);
        let place = self.grove.skeleton.position[joint];
        let key = (place.x.to_bits() ^ place.z.to_bits().rotate_left(21)) ^ place.y.to_bits().rotate_left(42);
        let mut stream = self.seed.child(key).stream(Draw::Phyllotaxis);
        let grove = &mut self.grove;
        for (k, azimuth) in grove.bud_range(joint).zip(self.phyllotaxis.azimuths(grove.rank[joint])) {
            let jitter = self.spec.jitter_deg * (PI / 180.0);
            let turn = azimuth + jitter * stream.normal();
            let tilt = self.spec.branch_angle_deg * (PI / 180.0) + jitter * stream.normal();
            let ((st, ct), (sa, ca)) = (ops::sin_cos(tilt), ops::sin_cos(turn));
            grove.bud_heading[k] = heading * ct + (side * ca + across * sa) * st;
            grove.waits[k] = true;
        }
    }

    /// Lets the joints from `first` on cast shadow or take room.
    fn cast_from(&mut self, first: usize) {
        let fresh = &self.grove.skeleton.position[first..];
        match &mut self.light {
            LightModel::Shadow(grid, _) => {
                let corners = fresh.iter().fold(None, |c: Option<(DVec3, DVec3)>, &p| {
                    Some(c.map_or((p, p), |(lo, hi)| (lo.min(p), hi.max(p))))
                });
                if let Some((lo, hi)) = corners {
                    grid.cover(lo, hi);
                }
                fresh.iter().for_each(|&p| grid.add(p, 1));
            }
            LightModel::Space(space) => space.take_room(fresh),
        }
    }
}

#[cfg(test)]
#[path = "tests.rs"]
mod tests;
