//! Places the first trees.

use base::{Counted, Draw, Run, Seed, map_until_cancelled, ops};
use glam::DVec2;

use super::{Area, ForestError, Kind, Member, Placed};
use crate::spec::PlantingPattern;

/// Side of the cells with separate random numbers, metres: a larger area keeps its trees.
const CELL_M: f64 = 10.0;
/// Width of the groups of a species, as a multiple of its seed spread.
const GROUP_PER_SPREAD: f64 = 2.0;
/// Least frequency of a species outside of its groups, as a share of that within.
const LEAST_OUTSIDE: f64 = 0.005;

/// Key of the random numbers for places.
const PLACES: u64 = 1;
/// Key of the random numbers for groups.
const GROUPS: u64 = 2;

/// Returns a number for each cell of the plane, whose coordinates are whole.
fn cell_key(cell: DVec2) -> u64 {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "whole and small; the bits are a key"
    )]
    let bits = |v: f64| v as i64 as u64;
    bits(cell.x) ^ bits(cell.y).rotate_left(32)
}

/// Returns smooth noise of one species, 0 to 1, with hills `wide` metres apart.
fn noise(seed: Seed, p: DVec2, wide: f64) -> f64 {
    let at = p / wide;
    let (cell, t) = (at.floor(), at - at.floor());
    let value = |x: f64, y: f64| seed.child(cell_key(DVec2::new(x, y))).stream(Draw::Stand).uniform();
    let smooth = |v: f64| ops::smoothstep(0.0, 1.0, v);
    let row = |y: f64| ops::lerp(value(cell.x, y), value(cell.x + 1.0, y), smooth(t.x));
    ops::lerp(row(cell.y), row(cell.y + 1.0), smooth(t.y))
}

/// Chooses the species of a place.
struct Chooser<'a> {
    area: &'a Area<'a>,
    seed: Seed,
    shares: f64,
    /// More than one species: they form groups.
    has_groups: bool,
}

impl Chooser<'_> {
    /// Computes the relative frequency of each species at a place; returns the share of trees that come up at all.
    /// Groups determine the species of a tree, not the number of trees.
    fn weigh(&self, p: DVec2, weights: &mut [f64]) -> f64 {
        let Some(conditions) = self.area.conditions(p) else { return 0.0 };
        let mut share = 0.0;
        for (k, (kind, weight)) in self.area.kinds.iter().zip(weights).enumerate() {
            let own = kind.share / self.shares * self.area.suits(k, &conditions, p);
            share += own;
            *weight = own * if self.has_groups { self.group(k, kind, p) } else { 1.0 };
        }
        share
    }

    /// Returns how far a place lies in a group of a species: 1 at its centre, next to nothing outside.
    fn group(&self, species: usize, kind: &Kind, p: DVec2) -> f64 {
        let hill = noise(self.seed.child(GROUPS).child(species as u64), p, GROUP_PER_SPREAD * kind.spread_m);
        // The fourth power is steep, so that groups are distinct.
        LEAST_OUTSIDE + hill * hill * hill * hill
    }

    /// Returns a tree at a place, if one comes up there.
    fn tree(&self, p: DVec2, key: Seed) -> Option<Member> {
        if !self.area.is_within(p) || !self.area.shapes.is_open(p) {
            return None;
        }
        let mut weights = [0.0; super::MOST_SPECIES];
        let weights = &mut weights[..self.area.kinds.len()];
        let share = self.weigh(p, weights);
        let mut stream = key.stream(Draw::Stand);
        if !stream.chance(share) {
            return None;
        }
        let mut left = stream.uniform() * weights.iter().sum::<f64>();
        let species = weights.iter().position(|w| {
            left -= w;
            left < 0.0
        });
        let species = species.or_else(|| weights.iter().rposition(|w| *w > 0.0))?;
        let kind: &Kind = &self.area.kinds[species];
        let age = stream.range(kind.age_years[0], kind.age_years[1]);
        Some(Member::planted(p, species, age, kind))
    }
}

impl Chooser<'_> {
    /// Returns random trees in a row of cells, of which the first has these whole coordinates.
    fn row_of_cells(&self, first: DVec2, columns: u32, density: f64) -> Vec<Member> {
        let mut found = Vec::new();
        for column in 0..columns {
            let index = first + DVec2::new(f64::from(column), 0.0);
            let cell = self.seed.child(cell_key(index));
            let mut stream = cell.stream(Draw::Scatter);
            let wanted = density * CELL_M * CELL_M;
            let count = ops::whole(wanted) + u32::from(stream.chance(wanted.fract()));
            for k in 0..u64::from(count) {
                let p = (index + DVec2::new(stream.uniform(), stream.uniform())) * CELL_M;
                found.extend(self.tree(p, cell.child(k)));
            }
        }
        found
    }
}

/// Places the first trees.
pub(super) fn place(area: &Area<'_>, seed: Seed, run: &Run<'_>) -> Result<Placed, ForestError> {
    let shares: f64 = area.kinds.iter().map(|k| k.share).sum();
    let seed = seed.child(PLACES);
    let chooser = Chooser { area, seed, shares, has_groups: area.kinds.len() > 1 };
    let proposed = match area.spec.pattern {
        PlantingPattern::Natural => by_chance(&chooser, run)?,
        PlantingPattern::Rows { .. } => in_rows(&chooser, run)?,
    };
    let all = proposed.len();
    let members = keep_apart(area, proposed)?;
    Ok(Placed { dropped: all - members.len(), members })
}

fn by_chance(chooser: &Chooser<'_>, run: &Run<'_>) -> Result<Vec<Member>, ForestError> {
    let area = chooser.area;
    let size = area.high - area.low;
    let density = area.spec.density_ha / 10_000.0;
    run.budget.check_estimate(Counted::Trees, density * size.x * size.y, "lower density_ha or area_m")?;
    // Cells are those of the whole plane.
    let first = (area.low / CELL_M).floor();
    let last = (area.high / CELL_M).ceil();
    let (columns, rows) = (ops::whole(last.x - first.x), ops::whole(last.y - first.y));
    let row = |r: usize| chooser.row_of_cells(first + DVec2::new(0.0, r as f64), columns, density);
    let found = map_until_cancelled(run, rows as usize, row)?;
    Ok(found.into_iter().flatten().collect())
}

fn in_rows(chooser: &Chooser<'_>, run: &Run<'_>) -> Result<Vec<Member>, ForestError> {
    let area = chooser.area;
    let PlantingPattern::Rows { spacing_m, row_m, angle_deg, jitter_m } = area.spec.pattern else {
        return Ok(Vec::new());
    };
    let along = base::turn::direction(angle_deg * (ops::PI / 180.0));
    let across = DVec2::new(-along.y, along.x);
    let half = 0.5 * (area.high - area.low).length();
    let steps = |distance: f64| (half / distance).floor();
    let (per_row, rows) = (steps(spacing_m), steps(row_m));
    run.budget.check_estimate(
        Counted::Trees,
        (2.0 * per_row + 1.0) * (2.0 * rows + 1.0),
        "lower area_m, or plant wider apart",
    )?;
    let count = 2 * ops::whole(per_row) as usize + 1;
    // Rows and trees are numbered from the origin: a larger area keeps its trees.
    let tree = |row: f64, place: f64| {
        let key = chooser.seed.child(cell_key(DVec2::new(place, row)));
        let mut stream = key.stream(Draw::Scatter);
        let off = DVec2::new(stream.range(-jitter_m, jitter_m), stream.range(-jitter_m, jitter_m));
        chooser.tree(across * (row * row_m) + along * (place * spacing_m) + off, key)
    };
    let row = |r: usize| -> Vec<Member> {
        (0..count).filter_map(|k| tree(r as f64 - rows, k as f64 - per_row)).collect()
    };
    let found = map_until_cancelled(run, 2 * ops::whole(rows) as usize + 1, row)?;
    Ok(found.into_iter().flatten().collect())
}

/// Removes each tree that stands nearer to an earlier one than its species demands.
fn keep_apart(area: &Area<'_>, proposed: Vec<Member>) -> Result<Vec<Member>, ForestError> {
    let spacing = |m: &Member| area.kinds[usize::from(m.species)].spacing_m;
    let widest = proposed.iter().map(spacing).fold(0.0, f64::max);
    let size = area.high - area.low;
    let side = widest.max((size.x * size.y / proposed.len().max(1) as f64).sqrt()).max(0.05);
    let columns = ops::whole((size.x / side).ceil()).max(1) as usize;
    let rows = ops::whole((size.y / side).ceil()).max(1) as usize;
    const END: u32 = u32::MAX;
    let mut heads = vec![END; columns * rows];
    let mut kept: Vec<Member> = Vec::with_capacity(proposed.len());
    let mut next: Vec<u32> = Vec::with_capacity(proposed.len());
    for member in proposed {
        let p = member.place();
        let index = |v: f64, count: usize| (ops::whole(v / side) as usize).min(count - 1);
        let (x, y) = (index(p.x - area.low.x, columns), index(p.y - area.low.y, rows));
        let (least, mut is_free) = (spacing(&member), true);
        for row in y.saturating_sub(1)..=(y + 1).min(rows - 1) {
            for column in x.saturating_sub(1)..=(x + 1).min(columns - 1) {
                let mut k = heads[row * columns + column];
                while k != END && is_free {
                    is_free = kept[k as usize].place().distance_squared(p) >= least * least;
                    k = next[k as usize];
                }
            }
        }
        if is_free {
            let head = &mut heads[y * columns + x];
            next.push(*head);
            *head = u32::try_from(kept.len()).unwrap_or(END);
            kept.push(member);
        }
    }
    Ok(kept)
}
