//! Stands that grow: `ForestSpec + Ground -> placed trees -> years of competition -> Stand`.
//!
//! A tree takes light from trees whose crowns lie below its own. The remaining light determines how fast a tree grows
//! and how likely it dies. Crowns in stands cover ground as the diameter to the power of 1.6; so a full stand thins
//! itself along Reineke's line, without an explicit rule.
//!
//! | module | owns |
//! |---|---|
//! | `place` | where the first trees stand |
//! | `step` | light, growth, death, seedlings |
//! | `grid` | trees by cells, for neighbours |
//! | `shapes` | keep-outs and water |

mod grid;
mod place;
mod shapes;
mod step;
#[cfg(test)]
mod tests;

use base::{Cancelled, Draw, OverBudget, Report, Run, Seed, Stopped, ops};
use glam::{DVec2, DVec3};

use crate::spec::{ForestSpec, SpeciesSpec};
use crate::{Allometry, BREAST_M, Given, Ground, GroundError, Mask, Setting, Stand, Tree, UnknownSpecies};
use shapes::Shapes;
use step::{freedom, last_look, pushed, sorted, vigour};

/// Most species of one stand.
const MOST_SPECIES: usize = 64;
/// Most corners of outlines, keep-outs and water together.
const MOST_CORNERS: usize = 1_000_000;
/// A species fades out beyond its range over this share of the range.
const FADE: f64 = 0.25;
/// Least distance over which a species fades out, in the unit of its range.
const LEAST_FADE: f64 = 1.0;

/// Error of growing a stand.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ForestError {
    /// A number is out of its range.
    #[error(transparent)]
    Range(#[from] spec::RangeFault),
    /// The spec names no species.
    #[error("the stand has no species: name at least one in [[species]], with a share above 0")]
    NoSpecies,
    /// There are more species than a stand may have.
    #[error("the stand has {0} species; at most {MOST_SPECIES} can compete: name the most frequent ones")]
    TooManySpecies(usize),
    /// A species is unknown.
    #[error("species {number}: {unknown}")]
    Species {
        /// Number of the species, from 1.
        number: usize,
        /// The unknown name, and the nearest known one.
        unknown: UnknownSpecies,
    },
    /// A range has its low end above the high one.
    #[error("species {number}: {field} goes from {low} to {high}; write the smaller number first")]
    Backwards {
        /// Number of the species, from 1.
        number: usize,
        /// Name of the field.
        field: &'static str,
        /// The first number.
        low: f64,
        /// The second.
        high: f64,
    },
    /// A polygon has fewer than three corners, or corners that are not finite.
    #[error("{0} needs {1} corners or more, all of finite numbers")]
    Polygon(&'static str, usize),
    /// There are too many corners.
    #[error(
        "outline, keep_out and water have {0} corners; at most {MOST_CORNERS} can be asked: simplify them"
    )]
    TooManyCorners(usize),
    /// A mask has cells that would not be square.
    #[error(
        "mask {number} is {columns} by {rows} cells, the area {width_m} by {depth_m} m: make both of one shape"
    )]
    MaskSize {
        /// Number of the mask, from 1.
        number: usize,
        /// Its columns.
        columns: usize,
        /// Its rows.
        rows: usize,
        /// Width of the area, metres.
        width_m: f64,
        /// Depth of the area, metres.
        depth_m: f64,
    },
    /// A mask is named but not given, or given but not named.
    #[error("the stand names {named} masks, and {given} were given")]
    Masks {
        /// Number of masks that the spec names.
        named: usize,
        /// Number of masks given with the ground.
        given: usize,
    },
    /// A mask is for a species that the stand does not have.
    #[error("mask {0} is about a species that the stand does not name")]
    MaskSpecies(usize),
    /// No tree may stand anywhere.
    #[error("no tree stands: {0}")]
    Empty(&'static str),
    /// There are more trees than numbers.
    #[error("more than four billion trees came up: lower seedlings or years")]
    TooMany,
    /// The ground or a mask is unusable.
    #[error(transparent)]
    Ground(#[from] GroundError),
    /// The stand exceeds the budget.
    #[error(transparent)]
    OverBudget(#[from] OverBudget),
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl From<Stopped> for ForestError {
    fn from(stopped: Stopped) -> Self {
        match stopped {
            Stopped::Cancelled(e) => e.into(),
            Stopped::OverBudget(e) => e.into(),
        }
    }
}

base::coded!(ForestError {
    Self::NoSpecies => "forest-no-species" {},
    Self::TooManySpecies(species) => "forest-species-count" { species },
    Self::Species { number, unknown } => "forest-species" { number, unknown => UnknownSpecies },
    Self::Backwards { number, field, low, high } => "forest-backwards" { number, field, low, high },
    Self::Polygon(what, corners) => "forest-polygon" { what, corners },
    Self::TooManyCorners(corners) => "forest-corners" { corners },
    Self::MaskSize { number, columns, rows, width_m, depth_m } => "forest-mask-size" { number, columns, rows, width_m, depth_m },
    Self::Masks { named, given } => "forest-masks" { named, given },
    Self::MaskSpecies(number) => "forest-mask-species" { number },
    Self::Empty(why) => "forest-empty" { why },
    Self::TooMany => "forest-too-many" {},
} wraps {
    Self::Range(e) => e, spec::RangeFault;
    Self::Ground(e) => e, GroundError;
    Self::OverBudget(e) => e, OverBudget;
    Self::Cancelled(e) => e, Cancelled;
});

/// A stand at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StandYear {
    /// Years since the trees were placed.
    pub year: u32,
    /// Number of living trees.
    pub trees: usize,
    /// Number of living trees per hectare of the area.
    pub trees_ha: f64,
    /// Diameter of the tree of mean basal area, metres.
    pub mean_dbh_m: f64,
    /// Basal area, square metres per hectare.
    pub basal_area_m2_ha: f64,
    /// Mean height of the hundred thickest trees per hectare, metres.
    pub top_height_m: f64,
    /// Number of trees that died since the moment before.
    pub died: usize,
    /// Number of seedlings that came up since the moment before.
    pub came: usize,
}

/// A grown stand and the course of its growth.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GrownStand {
    /// The living trees.
    pub stand: Stand,
    /// The first moment, and that after each step.
    pub history: Vec<StandYear>,
    /// Warnings.
    pub report: Report,
}

/// Site of a stand.
#[derive(Clone, Copy, Debug)]
pub struct Site<'a> {
    /// The ground.
    pub ground: &'a Ground,
    /// The masks of [`ForestSpec::masks`], in order.
    pub masks: &'a [Mask],
}

/// Grows a stand.
///
/// Guaranteed: the same spec, ground and seed give the same trees on any number of threads; trunks do not touch; no
/// tree stands in a keep-out, in water, outside of the outline or where the ground has no height; rows ascend and are
/// the numbers of the trees in order of their birth. Not guaranteed: that a stand resembles one certain forest;
/// `docs/forests.md` measures how realistic stands are.
///
/// Cost: linear in trees times steps, at one density.
///
/// # Errors
/// [`ForestError`].
///
/// Botkin, Janak and Wallis (1972) for light and death, Richards (1959) for the diameter, Rasche et al. (2012) for
/// the idea that light determines how slender a stem grows.
pub fn grow_stand(
    spec: &ForestSpec,
    ground: &Ground,
    seed: Seed,
    run: &Run<'_>,
) -> Result<Stand, ForestError> {
    grow_stand_on(spec, &Site { ground, masks: &[] }, seed, run).map(|grown| grown.stand)
}

/// Grows a stand as [`grow_stand`] does, with masks, and also returns the course of its growth.
///
/// # Errors
/// As [`grow_stand`].
pub fn grow_stand_on(
    spec: &ForestSpec,
    site: &Site<'_>,
    seed: Seed,
    run: &Run<'_>,
) -> Result<GrownStand, ForestError> {
    let area = Area::new(spec, site)?;
    let mut placed = place::place(&area, seed, run)?;
    let mut report = Report::default();
    area.tell_placed(&placed, &mut report)?;
    let members = &mut placed.members;
    for (id, member) in (0_u32..).zip(members.iter_mut()) {
        member.id = id;
        member.vigour = vigour(seed.child(VIGOURS).child(u64::from(id)).stream(Draw::Size).normal());
    }
    let mut next_id = u32::try_from(members.len()).unwrap_or(u32::MAX);
    let mut history = vec![area.moment(0, members, step::Turnover::default())];
    let mut year = 0;
    while year < spec.years {
        let years = spec.step_years.max(1).min(spec.years - year);
        // Seedlings of the last step would not have met their neighbours.
        let has_seedlings = year + years < spec.years;
        let own = seed.child(YEARS).child(u64::from(year));
        let turnover =
            step::step(members, &area, f64::from(years), has_seedlings.then_some(&mut next_id), own, run)?;
        year += years;
        history.push(area.moment(year, members, turnover));
        run.cancel.reached(f64::from(year) / f64::from(spec.years));
    }
    let stand = area.stand(placed.members, seed, run)?;
    if let Some(last) = history.last_mut() {
        // If trunks came to touch in the last step, the thinner tree died.
        last.died += last.trees - stand.trees.len();
        last.trees = stand.trees.len();
    }
    if stand.trees.is_empty() {
        return Err(ForestError::Empty("all trees have died; grow fewer years, or species that live longer"));
    }
    Ok(GrownStand { stand, history, report })
}

/// Key of the random numbers for vigours.
const VIGOURS: u64 = 3;
/// Key of the random numbers for years of growth.
const YEARS: u64 = 4;
/// Key of the random numbers for rotations.
const YAWS: u64 = 5;

/// A growing tree.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Member {
    x: f64,
    z: f64,
    height: f64,
    dbh: f64,
    /// Radius of the zone around its foot from which it takes light, metres.
    radius: f64,
    age: f64,
    vigour: f64,
    id: u32,
    species: u16,
}

impl Member {
    fn place(&self) -> DVec2 {
        DVec2::new(self.x, self.z)
    }

    fn planted(p: DVec2, species: usize, age: f64, kind: &Kind) -> Self {
        let mut tree = Self {
            x: p.x,
            z: p.y,
            age,
            vigour: 1.0,
            species: u16::try_from(species).unwrap_or(u16::MAX),
            ..Self::default()
        };
        let (dbh, height) = kind.young();
        tree.dbh = dbh.max(kind.allometry.dbh_at_age_m(age));
        tree.height = if tree.dbh > dbh { kind.allometry.height_m(tree.dbh, Setting::Stand) } else { height };
        if !kind.allometry.has_trunk() {
            kind.grow(&mut tree, age, 1.0);
        }
        tree.radius = kind.radius(&tree);
        tree
    }
}

/// Trees as they are placed.
struct Placed {
    members: Vec<Member>,
    /// Number of trees that were left out because they stood too near.
    dropped: usize,
}

/// One species of a stand.
struct Kind {
    allometry: &'static Allometry,
    share: f64,
    age_years: [f64; 2],
    spacing_m: f64,
    light: f64,
    spread_m: f64,
    seedlings: f64,
    /// Exponent of Beer's law for the light that its crown takes.
    shade: f64,
    slope: Option<[f64; 2]>,
    height_m: Option<[f64; 2]>,
    water_m: Option<[f64; 2]>,
    /// Rows of the masks for it.
    masks: Vec<usize>,
}

/// Width of the zone from which a tree takes light, as a multiple of its crown width in a closed stand (zones of
/// influence, Bella 1971): light also comes from the side. Chosen so that basal areas are those of full stands.
const ZONE: f64 = 1.6;
/// Exponents of Beer's law under the crown of a shade-tolerant species, and of a light-demanding one: the first casts
/// more shade.
const SHADES: [f64; 2] = [1.25, 0.95];

impl Kind {
    fn new(number: usize, wanted: &SpeciesSpec) -> Result<Self, ForestError> {
        let found =
            Allometry::find(&wanted.name).map_err(|unknown| ForestError::Species { number, unknown })?;
        let ranges = [
            ("age_years", Some(wanted.age_years)),
            ("slope_deg", wanted.slope_deg),
            ("height_m", wanted.height_m),
            ("water_m", wanted.water_m),
        ];
        for (field, range) in ranges {
            if let Some([low, high]) = range.filter(|[low, high]| low > high) {
                return Err(ForestError::Backwards { number, field, low, high });
            }
        }
        let light = wanted.light.unwrap_or(found.allometry.light);
        Ok(Self {
            allometry: found.allometry,
            share: wanted.share,
            age_years: wanted.age_years,
            spacing_m: wanted.spacing_m,
            light,
            spread_m: wanted.seed_spread_m.unwrap_or(found.allometry.spread_m),
            seedlings: wanted.seedlings,
            shade: ops::lerp(SHADES[0], SHADES[1], light),
            slope: wanted.slope_deg,
            height_m: wanted.height_m,
            water_m: wanted.water_m,
            masks: Vec::new(),
        })
    }

    /// Returns diameter and height of a tree that has just reached breast height.
    fn young(&self) -> (f64, f64) {
        if self.allometry.has_trunk() {
            let dbh = step::SEEDLING_DBH_M;
            (dbh, self.allometry.height_m(dbh, Setting::Stand))
        } else {
            (0.0, 0.02 * self.allometry.top_m)
        }
    }

    fn radius(&self, tree: &Member) -> f64 {
        0.5 * ZONE * self.allometry.stand_crown_width_m(tree.dbh, tree.height)
    }

    /// Grows a tree by some years in full light.
    fn grow(&self, tree: &mut Member, years: f64, freedom: f64) {
        let thicker = self.allometry.dbh_after_m(tree.dbh, years);
        let top = self.allometry.top_m;
        if self.allometry.has_trunk() {
            let [free, stand] = [Setting::Free, Setting::Stand].map(|s| self.allometry.slope(s));
            let left = ((top - tree.height) / (top - BREAST_M)).max(0.0);
            tree.height += ops::lerp(stand, free, freedom) * left * (thicker - tree.dbh);
            tree.dbh = thicker;
        } else {
            tree.height =
                top - (top - tree.height).max(0.0) * ops::exp(-4.0 * years / self.allometry.life_years);
        }
        tree.radius = self.radius(tree);
    }
}

/// Properties of the ground at a place.
struct Conditions {
    height_m: f64,
    slope_deg: f64,
}

/// Place and species of a stand, checked.
struct Area<'a> {
    spec: &'a ForestSpec,
    site: Site<'a>,
    low: DVec2,
    high: DVec2,
    kinds: Vec<Kind>,
    shapes: Shapes,
    /// Some species has a range of slopes or heights.
    asks_ground: bool,
}

impl<'a> Area<'a> {
    fn new(spec: &'a ForestSpec, site: &Site<'a>) -> Result<Self, ForestError> {
        spec::check(spec)?;
        let size = DVec2::from(spec.area_m);
        check_corners(spec)?;
        if spec.species.len() > MOST_SPECIES {
            return Err(ForestError::TooManySpecies(spec.species.len()));
        }
        let kinds = (1..).zip(&spec.species).map(|(number, s)| Kind::new(number, s));
        let mut kinds = kinds.collect::<Result<Vec<Kind>, _>>()?;
        if !kinds.iter().any(|k| k.share > 0.0) {
            return Err(ForestError::NoSpecies);
        }
        check_masks(spec, site, &mut kinds)?;
        let reach = |k: &Kind| k.water_m.map_or(0.0, |[low, high]| high + fade(low, high));
        let reach_m = kinds.iter().map(reach).fold(0.0, f64::max);
        let low = -0.5 * size;
        Ok(Self {
            spec,
            site: *site,
            low,
            high: 0.5 * size,
            shapes: Shapes::new(low, size, &spec.outline, &spec.keep_out, &spec.water, reach_m),
            asks_ground: kinds.iter().any(|k| k.slope.is_some() || k.height_m.is_some()),
            kinds,
        })
    }

    fn is_within(&self, p: DVec2) -> bool {
        p.cmpge(self.low).all() && p.cmplt(self.high).all()
    }

    /// Returns the properties of the ground; none if there is no ground.
    fn conditions(&self, p: DVec2) -> Option<Conditions> {
        let height_m = self.site.ground.height_m(p.x, p.y)?;
        if !self.asks_ground {
            return Some(Conditions { height_m, slope_deg: 0.0 });
        }
        let normal = self.site.ground.normal(p.x, p.y)?;
        Some(Conditions { height_m, slope_deg: ops::acos_clamped(normal.y) * (180.0 / ops::PI) })
    }

    /// Returns how well a place suits a species, 0 to 1.
    fn suits(&self, species: usize, conditions: &Conditions, p: DVec2) -> f64 {
        let kind = &self.kinds[species];
        let mut suits = 1.0;
        for (range, value) in [(kind.slope, conditions.slope_deg), (kind.height_m, conditions.height_m)] {
            suits *= range.map_or(1.0, |range| suitability(range, value));
        }
        if let Some(range) = kind.water_m {
            suits *= suitability(range, self.shapes.water_m(p));
        }
        let share = (p - self.low) / (self.high - self.low);
        kind.masks.iter().fold(suits, |suits, &mask| suits * self.site.masks[mask].share(share))
    }

    fn hectares(&self) -> f64 {
        let size = self.high - self.low;
        size.x * size.y / 10_000.0
    }

    /// Warns of trees that were left out, and fails if there is none.
    fn tell_placed(&self, placed: &Placed, report: &mut Report) -> Result<(), ForestError> {
        if placed.members.is_empty() {
            return Err(ForestError::Empty(
                "keep-outs, masks, water, the ground's edge and what species like leave no place, or the density is too low",
            ));
        }
        let (dropped, kept) = (placed.dropped, placed.members.len());
        if dropped > kept / 10 {
            base::warn!(report, "forest-spacing", { dropped = dropped, kept = kept }, "{dropped} trees were not placed, as they would stand nearer to others than their spacing_m; {kept} stand: lower density_ha or spacing_m");
        }
        Ok(())
    }

    /// Measures a stand.
    fn moment(&self, year: u32, members: &[Member], turnover: step::Turnover) -> StandYear {
        let hectares = self.hectares();
        let squares: f64 = members.iter().map(|m| m.dbh * m.dbh).sum();
        let count = members.len().max(1) as f64;
        let top = (ops::whole(100.0 * hectares) as usize).clamp(1, members.len().max(1));
        let mut by_dbh: Vec<(f64, f64)> = members.iter().map(|m| (m.dbh, m.height)).collect();
        if top < by_dbh.len() {
            by_dbh.select_nth_unstable_by(top, |a, b| b.0.total_cmp(&a.0).then(b.1.total_cmp(&a.1)));
            by_dbh.truncate(top);
        }
        // The order after a selection depends on the standard library: sums are over sorted rows.
        by_dbh.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(b.1.total_cmp(&a.1)));
        StandYear {
            year,
            trees: members.len(),
            trees_ha: members.len() as f64 / hectares,
            mean_dbh_m: (squares / count).sqrt(),
            basal_area_m2_ha: 0.25 * ops::PI * squares / hectares,
            top_height_m: by_dbh.iter().map(|t| t.1).sum::<f64>() / by_dbh.len().max(1) as f64,
            died: turnover.died,
            came: turnover.came,
        }
    }

    /// Returns the living trees, on their ground, with crowns pushed by their neighbours.
    fn stand(&self, mut members: Vec<Member>, seed: Seed, run: &Run<'_>) -> Result<Stand, ForestError> {
        let grid = sorted(&mut members, self);
        let around = last_look(&members, &grid, self, run)?;
        let mut order: Vec<(u32, u32)> = (0..)
            .zip(&members)
            .filter(|(i, _)| !around[*i as usize].is_touched)
            .map(|(i, m)| (m.id, i))
            .collect();
        order.sort_unstable();
        let mut species: Vec<String> = Vec::new();
        let mut rows = vec![None; self.kinds.len()];
        let mut trees = Vec::with_capacity(order.len());
        for (id, i) in order {
            let (m, around) = (members[i as usize], around[i as usize]);
            let kind = &self.kinds[usize::from(m.species)];
            let row = *rows[usize::from(m.species)].get_or_insert_with(|| {
                let known = species.iter().position(|s| s == kind.allometry.preset).unwrap_or_else(|| {
                    species.push(kind.allometry.preset.to_owned());
                    species.len() - 1
                });
                u16::try_from(known).unwrap_or(u16::MAX)
            });
            let free = kind.allometry.crown_width_m(m.dbh, m.height);
            let crown_width_m = ops::lerp(2.0 / ZONE * m.radius, free, freedom(around.light));
            let push = pushed(&around, 0.5 * crown_width_m);
            trees.push(Tree {
                foot_m: DVec3::new(m.x, 0.0, m.z),
                species: row,
                row: id + 1,
                age_years: m.age,
                height_m: m.height,
                dbh_m: m.dbh,
                crown_width_m,
                yaw: seed.child(YAWS).child(u64::from(id)).stream(Draw::Stand).range(0.0, ops::TAU),
                up: DVec3::Y,
                crown_offset_m: DVec3::new(push.x, 0.0, push.y),
                given: Given::default(),
            });
        }
        let mut stand = Stand { species, trees, origin_m: DVec3::ZERO };
        self.site.ground.set_down(&mut stand, self.spec.lean, run)?;
        Ok(stand)
    }
}

/// Returns the distance over which a range fades out on each side.
fn fade(low: f64, high: f64) -> f64 {
    (FADE * (high - low)).max(LEAST_FADE)
}

/// Returns 1 within a range, 0 well outside of it.
fn suitability([low, high]: [f64; 2], value: f64) -> f64 {
    let beyond = (low - value).max(value - high).max(0.0);
    (1.0 - beyond / fade(low, high)).max(0.0)
}

/// Fails unless outlines, keep-outs and water are polygons and lines.
fn check_corners(spec: &ForestSpec) -> Result<(), ForestError> {
    let is_finite = |points: &[[f64; 2]]| points.iter().flatten().all(|v| v.abs() < 1e9);
    if !spec.outline.is_empty() && (spec.outline.len() < 3 || !is_finite(&spec.outline)) {
        return Err(ForestError::Polygon("outline", 3));
    }
    if spec.keep_out.iter().any(|p| p.len() < 3 || !is_finite(p)) {
        return Err(ForestError::Polygon("keep_out", 3));
    }
    for water in &spec.water {
        let least = if water.width_m.is_some() { 2 } else { 3 };
        if water.points.len() < least || !is_finite(&water.points) {
            return Err(ForestError::Polygon("water", least));
        }
    }
    let water: usize = spec.water.iter().map(|w| w.points.len()).sum();
    let corners = spec.outline.len() + spec.keep_out.iter().map(Vec::len).sum::<usize>() + water;
    if corners > MOST_CORNERS { Err(ForestError::TooManyCorners(corners)) } else { Ok(()) }
}

/// Fails unless the masks are those that the spec names, fit its area and are for its species; assigns them to the
/// species.
fn check_masks(spec: &ForestSpec, site: &Site<'_>, kinds: &mut [Kind]) -> Result<(), ForestError> {
    if spec.masks.len() != site.masks.len() {
        return Err(ForestError::Masks { named: spec.masks.len(), given: site.masks.len() });
    }
    for (k, (wanted, mask)) in spec.masks.iter().zip(site.masks).enumerate() {
        let [width_m, depth_m] = spec.area_m;
        if !mask.fits(DVec2::from(spec.area_m)) {
            let [columns, rows] = mask.size();
            return Err(ForestError::MaskSize { number: k + 1, columns, rows, width_m, depth_m });
        }
        let mut is_used = false;
        for (kind, named) in kinds.iter_mut().zip(&spec.species) {
            if wanted.species.as_ref().is_none_or(|name| *name == named.name) {
                kind.masks.push(k);
                is_used = true;
            }
        }
        if !is_used {
            return Err(ForestError::MaskSpecies(k + 1));
        }
    }
    Ok(())
}
