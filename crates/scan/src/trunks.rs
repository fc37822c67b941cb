//! Trunks: round, upright pieces that continue from near the ground to above a person's head.
//!
//! Trunks are detected in slices below and above breast height, so that neither undergrowth at their feet nor
//! touching crowns hide the number of trees.

use base::{CancelToken, Cancelled, Draw, Seed};
use glam::{DVec2, DVec3};

use crate::circle::fit_circle;
use crate::stems::{Site, Trunk};
use crate::ways::{NONE, Ways};

/// Positions of the slices, and limits of a trunk in them.
struct TrunkLimits {
    /// Lower end of the lowest slice, metres, in a tree of height [`Self::tall_m`].
    lowest_m: f64,
    /// Thickness of each slice, metres, in such a tree.
    slice_m: f64,
    /// Number of slices.
    slices: usize,
    /// Height of a tree below which slices shrink in proportion, metres.
    tall_m: f64,
    /// Least number of slices that show a trunk, one of them among the upper two, which a person does not reach.
    seen: usize,
    /// Greatest radius of a trunk, metres.
    radius_most_m: f64,
    /// Least share of a circle's circumference that has points.
    covered: f64,
    /// Least share of the points on the circle.
    share: f64,
    /// Greatest share of the points inside it.
    inside: f64,
    /// Greatest horizontal distance between the centres of one trunk in two slices, metres.
    lean_m: f64,
    /// Greatest ratio of its radii in two slices.
    ratio: f64,
    /// Trunks with less space than this between them, metres, are one tree that forks near the ground.
    apart_m: f64,
}

const TRUNKS: TrunkLimits = TrunkLimits {
    lowest_m: 0.3,
    slice_m: 0.4,
    slices: 6,
    tall_m: 6.0,
    seen: 4,
    radius_most_m: 1.5,
    covered: 0.3,
    share: 0.4,
    inside: 0.15,
    lean_m: 0.15,
    ratio: 2.0,
    apart_m: 0.5,
};

/// A possible trunk in one slice.
struct Disc {
    slice: usize,
    middle: DVec3,
    radius: f64,
    cubes: Vec<u32>,
}

/// Returns all trunks, the thickest first. Cost: linear.
pub(crate) fn find_trunks(
    points: &[DVec3],
    ways: &Ways,
    site: &Site<'_>,
    noise: f64,
    cancel: &CancelToken,
) -> Result<Vec<Trunk>, Cancelled> {
    let scale = (site.height / TRUNKS.tall_m).min(1.0);
    let mut discs: Vec<Disc> = vec![];
    for slice in 0..TRUNKS.slices {
        let from = scale * (TRUNKS.lowest_m + TRUNKS.slice_m * slice as f64);
        let range = from..from + scale * TRUNKS.slice_m;
        let is_in = |c: usize| range.contains(&site.over(ways.means[c]));
        let (piece, sizes) = ways.pieces(2, is_in, cancel)?;
        let mut cubes: Vec<Vec<u32>> = sizes.iter().map(|_| vec![]).collect();
        for (c, &p) in (0_u32..).zip(&piece) {
            if p != NONE {
                cubes[p as usize].push(c);
            }
        }
        discs.extend(cubes.into_iter().filter_map(|cubes| disc(points, ways, slice, cubes, noise)));
    }
    Ok(joined(discs, scale))
}

/// Returns a round piece of a slice.
fn disc(points: &[DVec3], ways: &Ways, slice: usize, cubes: Vec<u32>, noise: f64) -> Option<Disc> {
    let cell = ways.voxels.cell();
    let mean = cubes.iter().map(|&c| ways.means[c as usize]).sum::<DVec3>() / cubes.len() as f64;
    let rows: Vec<u32> = cubes.iter().flat_map(|&c| ways.voxels.rows(c as usize)).copied().collect();
    let flat: Vec<DVec2> = rows
        .iter()
        .step_by(rows.len() / 400 + 1)
        .map(|&i| points[i as usize] - mean)
        .map(|d| DVec2::new(d.x, d.z))
        .collect();
    let wide = flat.iter().map(|p| p.length()).fold(0.0, f64::max);
    if cubes.len() < 3 || flat.len() < 6 {
        return None;
    }
    // The roundness of a piece that is a few cubes wide cannot be measured.
    if wide < 2.0 * cell {
        return Some(Disc { slice, middle: mean, radius: 0.7 * wide, cubes });
    }
    let mut stream = Seed::new(u64::from(cubes[0])).stream(Draw::Sampling);
    let circle = fit_circle(&flat, noise.max(0.5 * cell), wide.min(TRUNKS.radius_most_m), &mut stream)?;
    let is_round =
        circle.covered >= TRUNKS.covered && circle.share >= TRUNKS.share && circle.inside <= TRUNKS.inside;
    if !is_round {
        return None;
    }
    let middle = mean + DVec3::new(circle.centre.x, 0.0, circle.centre.y);
    // Branches and undergrowth that touch the trunk are not among its cubes.
    let near = circle.radius + 2.0 * cell + noise;
    let on = |c: &u32| {
        let d = ways.means[*c as usize] - middle;
        DVec2::new(d.x, d.z).length() < near
    };
    let cubes: Vec<u32> = cubes.into_iter().filter(on).collect();
    (!cubes.is_empty()).then_some(Disc { slice, middle, radius: circle.radius, cubes })
}

/// Joins discs above one another to trunks.
fn joined(discs: Vec<Disc>, scale: f64) -> Vec<Trunk> {
    let mut runs: Vec<Vec<Disc>> = vec![];
    for disc in discs {
        let fits = |run: &Vec<Disc>| {
            let last = &run[run.len() - 1];
            let steps = disc.slice - last.slice;
            let off = (disc.middle - last.middle).with_y(0.0).length();
            let ratio = (disc.radius / last.radius).max(last.radius / disc.radius);
            (1..=2).contains(&steps) && off < TRUNKS.lean_m * scale * steps as f64 && ratio < TRUNKS.ratio
        };
        match runs.iter().position(fits) {
            Some(run) => runs[run].push(disc),
            None => runs.push(vec![disc]),
        }
    }
    let mut trunks: Vec<Trunk> = vec![];
    for run in runs {
        let top = run[run.len() - 1].slice;
        if run.len() < TRUNKS.seen || top + 2 < TRUNKS.slices {
            continue;
        }
        let mut radii: Vec<f64> = run.iter().map(|d| d.radius).collect();
        base::sort_numbers(&mut radii);
        let (middle, radius) = (run[0].middle, radii[radii.len() / 2]);
        trunks.push(Trunk { middle, radius, cubes: run.into_iter().flat_map(|d| d.cubes).collect() });
    }
    base::sort_by(&mut trunks, |a, b| b.radius.total_cmp(&a.radius).then(a.middle.x.total_cmp(&b.middle.x)));
    let mut kept: Vec<Trunk> = vec![];
    for trunk in trunks {
        let near = |k: &&mut Trunk| {
            let free = (k.middle - trunk.middle).with_y(0.0).length() - k.radius - trunk.radius;
            free < TRUNKS.apart_m * scale
        };
        match kept.iter_mut().find(near) {
            Some(one) => one.cubes.extend(trunk.cubes),
            None => kept.push(trunk),
        }
    }
    kept
}
