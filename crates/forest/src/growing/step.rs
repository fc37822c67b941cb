//! One step of growth: light, growth, death, seedlings.

use core::ops::Range;

use base::{Counted, Draw, Run, Seed, map_until_cancelled, ops};
use glam::DVec2;

use super::grid::Grid;
use super::{Area, ForestError, Kind, Member};
use crate::BREAST_M;

/// Number of neighbours that one job examines, which takes some milliseconds.
const JOB_LOOKS: f64 = 400_000.0;
/// Most trees of one job.
const MOST_OF_A_JOB: usize = 4096;
/// Relative height difference over which the effect of a neighbour rises from none (it is lower by this share of the
/// tree's height) to full (it is higher by as much).
const HEIGHT_BAND: f64 = 0.9;
/// Share of growth in full light below which trees begin to die of shade.
const STRESS_FROM: f64 = 0.13;
/// Range below that share over which the mortality rises to its maximum.
const STRESS_OVER: f64 = 0.1;
/// Yearly chance of death of a tree that does not grow (Botkin et al. 1972: 1 in 100 survives ten such years).
const STARVED: f64 = 0.368;
/// One tree in a hundred reaches the life span of its species: `-ln 0.01`.
const ONE_IN_A_HUNDRED: f64 = 4.605;
/// Growth of forest trees in full light as a share of that in gardens and streets, on a good site: top heights at 50
/// years are then those of yield tables (pine 20 m, spruce 25 m).
const STAND_RATE: f64 = 0.7;
/// Light up to which the stem of a tree is as slender as in a closed stand, and from which the tree stands free.
const FREE_LIGHT: [f64; 2] = [0.5, 0.95];
/// Standard deviation of the logarithm of the vigour of single trees.
const VIGOUR: f64 = 0.18;
/// Share of its life from which a tree has seeds.
const SEED_SHARE: f64 = 0.1;
/// Least and greatest age at which trees begin to have seeds, years.
const SEED_AGE: [f64; 2] = [8.0, 40.0];
/// Diameter of a seedling that has reached breast height, metres.
pub(super) const SEEDLING_DBH_M: f64 = 0.008;
/// Greatest push of a crown, as a share of its radius.
const MOST_PUSH: f64 = 0.5;

/// Effect of the neighbours on one tree.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Around {
    /// Light that reaches its crown, 0 to 1.
    pub(super) light: f64,
    /// Direction in which the neighbours push its crown: the sum of unit vectors away from them, weighted by their
    /// shade.
    pub(super) push: DVec2,
    /// Sum of these weights.
    pub(super) crowding: f64,
    /// Its trunk touches that of a thicker tree.
    pub(super) is_touched: bool,
}

/// Examines the neighbours of a tree.
///
/// Light decreases with the crowns above by Beer's law. A crown above counts by its share of the tree's own crown, by
/// its shade, and by how much higher its tree is. The overlap of two discs is approximated by a smooth step of how
/// far one reaches into the other, which is within 3 % of the disc's area of the exact one.
pub(super) fn look(members: &[Member], grid: &Grid, kinds: &[Kind], i: usize) -> Around {
    let me = members[i];
    let (mut depth, mut crowding, mut push, mut is_touched) = (0.0, 0.0, DVec2::ZERO, false);
    for run in grid.near(me.place()) {
        for (j, other) in members[run.clone()].iter().enumerate() {
            let (dx, dz) = (me.x - other.x, me.z - other.z);
            let (gap2, reach) = (dx * dx + dz * dz, me.radius + other.radius);
            if gap2 >= reach * reach {
                continue;
            }
            let j = run.start + j;
            if j == i {
                continue;
            }
            let gap = gap2.sqrt();
            let is_thinner = (me.dbh, other.id) < (other.dbh, me.id);
            is_touched |= is_thinner && gap < 0.5 * (me.dbh + other.dbh);
            let over = 0.5 + 0.5 * (other.height - me.height) / (HEIGHT_BAND * me.height);
            if over <= 0.0 {
                continue;
            }
            let least = me.radius.min(other.radius);
            let t = (0.5 * (reach - gap) / least).min(1.0);
            let share = t * t * (3.0 - 2.0 * t) * (least * least) / (me.radius * me.radius);
            let weight = over.min(1.0) * share;
            depth += weight * kinds[usize::from(other.species)].shade;
            crowding += weight;
            if gap > 0.0 {
                push += DVec2::new(dx, dz) * (weight / gap);
            }
        }
    }
    Around { light: ops::exp(-depth), push, crowding, is_touched }
}

/// Returns growth at a light, as a share of that in full light: between the curves of shade-tolerant and
/// light-demanding trees (Botkin et al. 1972).
pub(super) fn response(light: f64, demand: f64) -> f64 {
    let bears = 1.0 - ops::exp(-4.64 * (light - 0.05));
    let needs = 2.24 * (1.0 - ops::exp(-1.136 * (light - 0.08)));
    ops::lerp(bears, needs, demand).clamp(0.0, 1.0)
}

/// Returns how free a tree stands, 0 to 1.
pub(super) fn freedom(light: f64) -> f64 {
    ops::smoothstep(FREE_LIGHT[0], FREE_LIGHT[1], light)
}

/// Returns the tree some years later; none if it died.
fn grown(me: Member, around: &Around, kind: &Kind, site: f64, years: f64, seed: Seed) -> Option<Member> {
    let mut stream = seed.stream(Draw::Stand);
    let growth = response(around.light, kind.light);
    let stress = ((STRESS_FROM - growth) / STRESS_OVER).clamp(0.0, 1.0);
    let yearly = (ONE_IN_A_HUNDRED / kind.allometry.life_years + STARVED * stress).min(1.0);
    let lives = ops::exp(years * ops::ln((1.0 - yearly).max(1e-12)));
    // If two trunks touch, the thinner tree dies.
    if around.is_touched || !stream.chance(lives) {
        return None;
    }
    let mut me = Member { age: me.age + years, ..me };
    let free_years = STAND_RATE * growth * site * me.vigour * years;
    kind.grow(&mut me, free_years, freedom(around.light));
    Some(me)
}

/// Result of one job.
#[derive(Default)]
struct Part {
    lived: Vec<Member>,
    seedlings: Vec<Member>,
}

/// One step of a stand.
struct Stride<'a> {
    area: &'a Area<'a>,
    members: &'a [Member],
    grid: Grid,
    years: f64,
    has_seedlings: bool,
    seed: Seed,
}

impl Stride<'_> {
    /// Grows some of the trees.
    fn part(&self, range: Range<usize>) -> Part {
        let mut part = Part { lived: Vec::with_capacity(range.len()), seedlings: Vec::new() };
        for i in range {
            let me = self.members[i];
            let kind = &self.area.kinds[usize::from(me.species)];
            let around = look(self.members, &self.grid, &self.area.kinds, i);
            let own = self.seed.child(u64::from(me.id));
            let Some(later) = grown(me, &around, kind, self.area.spec.site, self.years, own) else {
                continue;
            };
            if self.has_seedlings {
                self.sow(&later, &around, kind, own, &mut part.seedlings);
            }
            part.lived.push(later);
        }
        part
    }
}

/// Divides all trees among jobs of some milliseconds.
///
/// # Errors
/// More examined neighbours than the budget allows, or the user asked to stop.
fn in_jobs<T: Send>(
    members: usize,
    grid: &Grid,
    run: &Run<'_>,
    job: impl Fn(Range<usize>) -> T + Sync,
) -> Result<Vec<T>, ForestError> {
    let neighbours = grid.neighbours(members).max(1.0);
    let advice = "lower density_ha or the age of the widest trees";
    run.budget.check_estimate(Counted::Looks, neighbours * members as f64, advice)?;
    let size = (ops::whole(JOB_LOOKS / neighbours) as usize).clamp(16, MOST_OF_A_JOB);
    let range = |k: usize| k * size..((k + 1) * size).min(members);
    Ok(map_until_cancelled(run, members.div_ceil(size), |k| job(range(k)))?)
}

/// Counts of one step.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Turnover {
    pub(super) died: usize,
    pub(super) came: usize,
}

/// Grows a stand by some years. `next_id`: the number of the next tree, if seedlings may come up.
pub(super) fn step(
    members: &mut Vec<Member>,
    area: &Area<'_>,
    years: f64,
    next_id: Option<&mut u32>,
    seed: Seed,
    run: &Run<'_>,
) -> Result<Turnover, ForestError> {
    let grid = sorted(members, area);
    let count = members.len();
    let stride = Stride { area, members, grid, years, has_seedlings: next_id.is_some(), seed };
    let parts = in_jobs(count, &stride.grid, run, |range| stride.part(range))?;
    let before = members.len();
    members.clear();
    parts.iter().for_each(|part| members.extend_from_slice(&part.lived));
    let died = before - members.len();
    let mut came = 0;
    if let Some(id) = next_id {
        for mut seedling in parts.into_iter().flat_map(|part| part.seedlings) {
            seedling.id = *id;
            *id = id.checked_add(1).ok_or(ForestError::TooMany)?;
            came += 1;
            members.push(seedling);
        }
    }
    run.budget.check(Counted::Trees, members.len() as u64, "lower seedlings, years or area_m")?;
    Ok(Turnover { died, came })
}

/// Sorts trees into cells as wide as the widest crown.
pub(super) fn sorted(members: &mut Vec<Member>, area: &Area<'_>) -> Grid {
    let widest = members.iter().map(|m| m.radius.max(m.dbh)).fold(0.1, f64::max);
    Grid::sort(members, area.low, area.high - area.low, 2.0 * widest)
}

impl Stride<'_> {
    /// Adds the seedlings of a tree that reach breast height.
    fn sow(&self, parent: &Member, around: &Around, kind: &Kind, seed: Seed, into: &mut Vec<Member>) {
        let area = self.area;
        let seed_age = (SEED_SHARE * kind.allometry.life_years).clamp(SEED_AGE[0], SEED_AGE[1]);
        if parent.age < seed_age || kind.seedlings <= 0.0 {
            return;
        }
        let mut stream = seed.stream(Draw::Scatter);
        let wanted = kind.seedlings * self.years * around.light;
        let count = ops::whole(wanted) + u32::from(stream.chance(wanted.fract()));
        for _ in 0..count {
            // Distances are exponential, with the seed spread of the species as their mean.
            let far = -kind.spread_m * ops::ln(1.0 - stream.uniform());
            let p = parent.place() + base::turn::direction(stream.range(0.0, ops::TAU)) * far;
            let (luck, normal) = (stream.uniform(), stream.normal());
            if !area.is_within(p) || !area.shapes.is_open(p) {
                continue;
            }
            let suits = area.conditions(p).map_or(0.0, |c| area.suits(usize::from(parent.species), &c, p));
            if luck < suits {
                into.push(Member::seedling(p, parent.species, kind, normal));
            }
        }
    }
}

/// Examines the neighbours of each tree in the grown stand, for its crown.
pub(super) fn last_look(
    members: &[Member],
    grid: &Grid,
    area: &Area<'_>,
    run: &Run<'_>,
) -> Result<Vec<Around>, ForestError> {
    let looks = |range: Range<usize>| range.map(|i| look(members, grid, &area.kinds, i)).collect::<Vec<_>>();
    Ok(in_jobs(members.len(), grid, run, looks)?.into_iter().flatten().collect())
}

/// Returns the push of a crown of a radius, metres: the more one-sided its neighbours are and the more they shade it,
/// the longer.
pub(super) fn pushed(around: &Around, radius: f64) -> DVec2 {
    if around.crowding <= 0.0 {
        return DVec2::ZERO;
    }
    around.push * (MOST_PUSH * radius * ops::tanh(around.crowding) / around.crowding)
}

impl Member {
    /// Returns a seedling; `normal`: a random number for its vigour.
    fn seedling(p: DVec2, species: u16, kind: &Kind, normal: f64) -> Self {
        let mut seedling = Self { x: p.x, z: p.y, species, vigour: vigour(normal), ..Self::default() };
        seedling.age = kind.allometry.age_years(SEEDLING_DBH_M, BREAST_M);
        (seedling.dbh, seedling.height) = kind.young();
        seedling.radius = kind.radius(&seedling);
        seedling
    }
}

pub(super) fn vigour(normal: f64) -> f64 {
    ops::exp(VIGOUR * normal.clamp(-2.5, 2.5))
}
