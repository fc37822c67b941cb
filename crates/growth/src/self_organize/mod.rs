//! Self-organising trees: buds compete for light or space, and the tree distributes the gathered resource.
//!
//! `roots -> (light of buds -> shares -> shoots -> shedding -> wood) x years -> Skeleton` (Palubicki et al. 2009)

mod grove;
mod resource;
mod shadow;
mod sky;
mod space;
mod spec;

use core::fmt::Display;

use base::ops::{self, PI};
use base::{Counted, Draw, Report, Run, Seed};
use glam::DVec3;
use plant::Phyllotaxis;

use crate::colonize::{grow_bole, plant_roots};
use crate::{GrowthError, JointId, Obstacles, Skeleton};
use grove::{Grove, Kept};
use resource::{Fed, Flow, Sharing};
use shadow::OUTSIDE;
use sky::Sky;
use space::Space;

pub use self::spec::{Light, Resource, SelfOrganizingSpec};

pub(crate) use shadow::ShadowGrid;

/// Result of self-organising growth.
#[derive(Clone, Debug, PartialEq)]
pub struct SelfOrganized {
    /// All trees, with the radii that their wood has reached.
    pub skeleton: Skeleton,
    /// Number of internodes ever grown, including shed ones.
    pub generated: usize,
    /// Number of shed internodes.
    pub shed: usize,
}

/// Grows trees year by year, one from each root; they shade one another.
///
/// Guaranteed: it ends; a clean `validate()`; no joint in an obstacle; radii never decrease; the tree of year n does
/// not depend on the number of years that follow. With too little shade trees multiply from year to year: growth then
/// ends, with the warning `growth-too-much`, before the year that would exceed `max_joints`. Cost: linear in the
/// internodes of each year.
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
    let mut skeleton = plant_roots(roots, obstacles, run)?;
    let light = match &spec.light {
        Light::Shadow { voxel_m, a, b, layers, full } => {
            let voxel = voxel_m.unwrap_or(2.0 * spec.internode_m);
            let grid = ShadowGrid::new(voxel, *a, *b, *layers);
            LightModel::Shadow(Shade { grid, full: *full, voxel: Vec::new() })
        }
        Light::Sky { leaf_m, lines, full } => {
            LightModel::Sky(Box::new(Sky::new(leaf_m.unwrap_or(spec.internode_m), *lines, *full)?))
        }
        Light::Space { envelope, markers, occupancy, perception, half_angle_deg } => {
            let reach = (occupancy * spec.internode_m, perception * spec.internode_m);
            let all = u64::from(*markers) * roots.len() as u64;
            run.budget.check(Counted::Points, all, "lower light.markers or give fewer roots")?;
            let region = envelope.prepare()?;
            let mut places = Vec::new();
            for (root, i) in roots.iter().zip(0_u64..) {
                let free = |p: DVec3| obstacles.free(*root + p);
                let own = region.scatter(*markers as usize, 0.0, seed.child(i), free)?;
                places.extend(own.into_iter().map(|p| *root + p));
            }
            // Markers begin at the foot of the crown: without a bole no bud would perceive any.
            for root in 0..roots.len() {
                let foot = (region.foot() - reach.0).max(0.0);
                grow_bole(&mut skeleton, JointId::new(root), foot, spec.internode_m, obstacles, run)?;
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
        mean_light: Vec::new(),
        stays: Vec::new(),
        kept: Kept::default(),
        generated: 0,
        shed: 0,
        work: 0,
    };
    forest.cast_from(0);
    for year in 0..spec.years {
        run.cancel.check()?;
        if let Some(next) = forest.year(year, run)? {
            let (joints, years) = (forest.grove.len(), spec.years);
            let fields: [(&'static str, &dyn Display); 5] = [
                ("year", &year),
                ("years", &years),
                ("joints", &joints),
                ("next", &next),
                ("most", &spec.max_joints),
            ];
            report.warn_of("growth-too-much", &fields, too_much(spec, year, joints, next));
            break;
        }
        // Later years take longer.
        let share = f64::from(year + 1) / f64::from(spec.years);
        run.cancel.reached(crate::GROWN * share * share);
    }
    let bare = forest.grove.skeleton.parent.iter().all(Option::is_none);
    if spec.years > 0 && (bare || forest.generated == 0) {
        return Err(GrowthError::Nothing { why: forest.why_nothing(run)? });
    }
    let Forest { mut grove, generated, shed, .. } = forest;
    // Consecutive joints of one shoot are often equal.
    let (mut wood, mut radius) = (0.0, 0.0);
    for r in &mut grove.skeleton.radius_m {
        if *r != wood {
            (wood, radius) = (*r, ops::powf(*r, 1.0 / spec.pipe_exponent));
        }
        *r = radius;
    }
    report.book("grow", run.clock.now_ms() - started);
    debug_assert_eq!(grove.skeleton.validate().next(), None, "a grown skeleton is sound");
    Ok(SelfOrganized { skeleton: grove.skeleton, generated, shed })
}

/// Explains why growth stopped before its last year, and which numbers to change.
fn too_much(spec: &SelfOrganizingSpec, year: u32, joints: usize, next: usize) -> String {
    let (alpha, below, most, years) = (spec.alpha, spec.shed_below, spec.max_joints, spec.years);
    let cause = match &spec.light {
        Light::Shadow { a, full, .. } => format!(
            "so little shade lets too much of it sprout, raise light.a ({a}) or shed_below ({below}), or lower \
             light.full ({full}), alpha ({alpha}) or years"
        ),
        Light::Sky { full, .. } => format!(
            "so little shade lets too much of it sprout, raise light.leaf_m or shed_below ({below}), or lower light.full \
             ({full}), alpha ({alpha}) or years"
        ),
        Light::Space { .. } => format!("raise shed_below ({below}), or lower alpha ({alpha}) or years"),
    };
    format!(
        "growth stopped after year {year} of {years} with {joints} joints: the next year would make {next}, above \
         max_joints ({most}); {cause}"
    )
}

enum LightModel {
    Shadow(Shade),
    Sky(Box<Sky>),
    Space(Space),
}

/// The shadow model.
struct Shade {
    grid: ShadowGrid,
    /// Light without any shadow.
    full: f64,
    /// Voxel of each joint.
    voxel: Vec<u32>,
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
    /// Light Q of each bud at a joint.
    bud_light: Vec<f64>,
    /// Light per internode of each branch over the last years, by its first joint.
    mean_light: Vec<f64>,
    /// Workspaces of shedding.
    stays: Vec<bool>,
    kept: Kept,
    generated: usize,
    shed: usize,
    /// Number of joints, and a share of the voxels, summed over all years so far.
    work: u64,
}

impl Forest<'_> {
    /// Explains which number keeps every bud of a forest of bare roots dormant.
    fn why_nothing(&mut self, run: &Run<'_>) -> Result<String, GrowthError> {
        let (alpha, years, below) = (self.spec.alpha, self.spec.years, self.spec.shed_below);
        if self.generated > 0 {
            return Ok(format!(
                "all that grew in {years} years was shed: shed_below ({below}) is more than the light per internode \
                 of any branch; lower it, or raise alpha ({alpha})"
            ));
        }
        self.look(0, run)?;
        let light = self.bud_light.iter().copied().fold(0.0, f64::max);
        Ok(match &self.spec.light {
            _ if light > 0.0 && light * alpha >= 1.0 => {
                "obstacles stand around every root; move them, or lower internode_m".into()
            }
            Light::Shadow { full, a, .. } => format!(
                "no bud has the vigour of 1 that a shoot takes: light.full ({full}) less the shadow of light.a ({a}), \
                 times alpha ({alpha}), is {:.4}; raise light.full or alpha",
                light * alpha
            ),
            Light::Sky { full, .. } => format!(
                "no bud has the vigour of 1 that a shoot takes: the light of the brightest bud ({light:.4}), times alpha \
                 ({alpha}); raise light.full ({full}) or alpha"
            ),
            Light::Space { perception, .. } if light <= 0.0 => format!(
                "no bud sees a marker within light.perception ({perception} internodes); raise it, \
                 light.half_angle_deg or light.markers, or lower light.occupancy"
            ),
            Light::Space { .. } => {
                format!("no bud has the vigour of 1 that a shoot takes: it is alpha ({alpha}); raise it")
            }
        })
    }

    /// Grows one year; returns the number of joints that there would be, if that exceeds the limit: then nothing has
    /// sprouted.
    fn year(&mut self, year: u32, run: &Run<'_>) -> Result<Option<usize>, GrowthError> {
        let of_light = match &self.light {
            // A voxel takes about a 64th of the time of a joint.
            LightModel::Shadow(shade) => shade.grid.voxels() / 64,
            LightModel::Sky(sky) => sky.work(self.grove.len()),
            LightModel::Space(_) => 0,
        };
        self.work += (self.grove.len() + of_light) as u64;
        run.budget.check(
            Counted::JointYears,
            self.work,
            "lower years or max_joints (or make light.voxel_m larger)",
        )?;
        self.look(year, run)?;
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
        let next = self.grove.len() + self.sprouting();
        if next > self.spec.max_joints as usize {
            return Ok(Some(next));
        }
        run.budget.check(Counted::Joints, next as u64, "lower years, alpha or max_joints")?;
        self.sprout(year + 1);
        let tip = ops::powf(self.spec.tip_radius_m, self.spec.pipe_exponent);
        self.grove.thicken(tip);
        Ok(None)
    }

    /// Computes the light of every bud.
    fn look(&mut self, year: u32, run: &Run<'_>) -> Result<(), GrowthError> {
        let n = self.grove.len();
        self.bud_light.clear();
        match &mut self.light {
            LightModel::Shadow(Shade { grid, full, voxel }) => {
                grid.spread();
                let own = if self.spec.self_shadow { 0.0 } else { grid.own() };
                let light = voxel.iter().map(|v| (*full - grid.shade(*v) + own).max(0.0));
                self.bud_light.extend(light);
            }
            LightModel::Sky(sky) => {
                sky.look(&self.grove.skeleton.position, self.seed.child(u64::from(year)), run)?;
                self.bud_light.extend(sky.lights());
            }
            LightModel::Space(space) => {
                space.look(&self.grove, &run.budget)?;
                self.bud_light.extend((0..n).map(|j| space.light_at(j)));
            }
        }
        Ok(())
    }

    /// Sheds branches that gather too little light for their size (Takenaka 1994).
    fn drop_dark_branches(&mut self, year: u32) {
        let n = self.grove.len();
        self.mean_light.resize(n, f64::NAN);
        // The space model has only lit and dark: the mean of about five years decides.
        let fresh = if matches!(self.light, LightModel::Space(_)) { 0.2 } else { 1.0 };
        let mut stays = core::mem::take(&mut self.stays);
        stays.clear();
        stays.resize(n, true);
        let mut any = false;
        for j in 0..n {
            let Some(parent) = self.grove.parent(j) else { continue };
            if !stays[parent] {
                stays[j] = false;
                continue;
            }
            if self.grove.main[parent] as usize == j {
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
        if any {
            self.drop(&stays);
        }
        self.stays = stays;
    }

    fn drop(&mut self, stays: &[bool]) {
        let kept = &mut self.kept;
        kept.set(stays);
        self.shed += stays.iter().filter(|&&s| !s).count();
        self.grove.keep(kept);
        kept.squeeze(&mut self.mean_light, 1);
        kept.squeeze(&mut self.bud_light, 1);
        match &mut self.light {
            // Shed joints no longer cast shadow; their light no longer counts below.
            LightModel::Shadow(Shade { grid, voxel, .. }) => {
                let gone = voxel.iter().zip(stays).filter(|(_, stays)| !**stays).map(|(v, _)| *v);
                grid.add_all(gone, -1);
                kept.squeeze(voxel, 1);
            }
            LightModel::Sky(sky) => sky.keep(kept),
            LightModel::Space(space) => space.keep(kept),
        }
        self.flow.gather(&self.grove, &self.bud_light);
    }

    /// Returns the vigour that a shoot uses, at most that of the spec: a seedling in full light would grow too fast.
    fn used(&self, vigour: f64) -> f64 {
        vigour.min(f64::from(self.spec.most_per_shoot) + 0.999)
    }

    /// Returns the number of internodes for which this year's vigour suffices.
    fn sprouting(&self) -> usize {
        self.flow.fed.iter().map(|f| internodes(self.used(f.vigour)) as usize).sum()
    }

    /// Grows internodes from buds with a vigour of 1 or more, one for each unit.
    fn sprout(&mut self, birth: u32) {
        let n = self.grove.len();
        let fed = core::mem::take(&mut self.flow.fed);
        for at_joint in fed.chunk_by(|a, b| a.joint == b.joint) {
            at_joint.iter().for_each(|fed| self.shoot(*fed, birth));
        }
        self.flow.fed = fed;
        self.cast_from(n);
        self.generated += self.grove.len() - n;
    }

    fn shoot(&mut self, Fed { joint, bud, vigour }: Fed, birth: u32) {
        let vigour = self.used(vigour);
        if vigour < 1.0 {
            return;
        }
        let n = internodes(vigour);
        let length = self.spec.internode_m * vigour / f64::from(n);
        let v = match &self.light {
            LightModel::Shadow(Shade { grid, voxel, .. }) => grid.slope(voxel[joint]).normalize_or_zero(),
            LightModel::Sky(sky) => sky.towards(joint),
            LightModel::Space(space) => space.direction_of_bud(joint, bud),
        };
        let mut heading = match bud {
            None => self.grove.heading[joint],
            Some(k) => {
                let place = k - joint * self.grove.per_node;
                bud_headings(self.spec, self.phyllotaxis, self.seed, &self.grove, joint)
                    .nth(place)
                    .unwrap_or(self.grove.heading[joint])
            }
        };
        let lead = v * self.spec.light_weight + self.pull;
        let (mut from, mut bud) = (joint, bud);
        for _ in 0..n {
            let Some(wish) = (heading + lead).try_normalize() else { return };
            let open = self.obstacles.is_empty();
            let at = self.grove.skeleton.position[from];
            let Some(to) = (if open { Some(wish) } else { self.obstacles.steer(at, wish, length) }) else {
                return;
            };
            (from, heading) = (self.grove.grow(from, bud.take(), to, length, birth), to);
        }
    }

    /// Adds the shadow or the occupied space of the joints from `first` on.
    fn cast_from(&mut self, first: usize) {
        let all = &self.grove.skeleton.position;
        let fresh = &all[first..];
        match &mut self.light {
            LightModel::Shadow(Shade { grid, voxel, .. }) => {
                let corners = fresh.iter().fold(None, |c: Option<(DVec3, DVec3)>, &p| {
                    Some(c.map_or((p, p), |(lo, hi)| (lo.min(p), hi.max(p))))
                });
                if let Some((lo, hi)) = corners {
                    grid.cover(lo, hi, voxel);
                }
                voxel.resize(all.len(), OUTSIDE);
                for (voxel, &p) in voxel.iter_mut().zip(all).filter(|(voxel, _)| **voxel == OUTSIDE) {
                    *voxel = grid.voxel_of(p);
                }
                grid.add_all(voxel[first..].iter().copied(), 1);
            }
            // Leaves are set out anew each year.
            LightModel::Sky(_) => {}
            LightModel::Space(space) => {
                space.take_room(fresh);
                let (spec, grove) = (self.spec, &self.grove);
                for j in first..grove.len() {
                    space.set_buds(bud_headings(spec, self.phyllotaxis, self.seed, grove, j));
                }
            }
        }
    }
}

/// Returns the whole internodes of a vigour.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to a hundred")]
const fn internodes(vigour: f64) -> u32 {
    vigour as u32
}

/// Returns the directions of the axillary buds of a joint: around it by phyllotaxis. Every call gives the same.
fn bud_headings(
    spec: &SelfOrganizingSpec,
    phyllotaxis: Phyllotaxis,
    seed: Seed,
    grove: &Grove,
    joint: usize,
) -> impl Iterator<Item = DVec3> {
    let (heading, side) = (grove.heading[joint], grove.side[joint]);
    let across = heading.cross(side);
    let place = grove.skeleton.position[joint];
    let key = (place.x.to_bits() ^ place.z.to_bits().rotate_left(21)) ^ place.y.to_bits().rotate_left(42);
    let mut stream = seed.child(key).stream(Draw::Phyllotaxis);
    let (jitter, angle) = (spec.jitter_deg * (PI / 180.0), spec.branch_angle_deg * (PI / 180.0));
    phyllotaxis.azimuths(grove.rank[joint]).map(move |azimuth| {
        let turn = azimuth + jitter * stream.normal();
        let tilt = angle + jitter * stream.normal();
        let ((st, ct), (sa, ca)) = (ops::sin_cos(tilt), ops::sin_cos(turn));
        heading * ct + (side * ca + across * sa) * st
    })
}

#[cfg(test)]
#[path = "tests.rs"]
mod tests;
