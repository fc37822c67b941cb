//! Removes stray points and the ground plane from a raw scan.

use base::{Cancelled, Draw, Run, Seed};
use geom::Voxels;
use glam::DVec3;

use crate::thin::thin;
use geom::extent;

/// Settings of the cleaning of a scan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CleanSpec {
    /// Whether to remove stray points and specks. Default true.
    pub outliers: bool,
    /// Whether to remove a ground plane (table, soil, turntable) if there is one. Default true.
    pub plane: bool,
    /// Upward direction of the scan; the ground is perpendicular to it, at the bottom. Default +Y.
    pub up: DVec3,
    /// Box of points to keep, corner to corner. Default everything.
    pub crop: Option<[DVec3; 2]>,
    /// Least share of the points in a plane for it to be ground, 0 to 1. Default 0.1.
    pub plane_share: f64,
}

impl Default for CleanSpec {
    fn default() -> Self {
        Self { outliers: true, plane: true, up: DVec3::Y, crop: None, plane_share: 0.1 }
    }
}

/// Points that were kept, and the numbers of removed points by reason.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cleaned {
    /// Rows of the points that were kept, in order.
    pub kept: Vec<usize>,
    /// Points outside the crop box, or not finite.
    pub cropped: usize,
    /// Points of the ground plane.
    pub ground: usize,
    /// Stray points and specks.
    pub outliers: usize,
    /// Points of objects apart from the largest: people, other plants.
    pub others: usize,
    /// Axis to which a ground-like plane is perpendicular, with the plant on its side of it, if none is perpendicular
    /// to `up`: the scan may lie down.
    pub ground_across: Option<DVec3>,
}

/// Removes stray points and the ground from a scan.
///
/// A point is stray if the cubes around its own contain less than a tenth of the usual number, or if its connected
/// piece contains less than 1 point in 200. A plane is ground if it is perpendicular to `up` (within 25 degrees),
/// contains `plane_share` of the points and 97 of 100 of the others lie above it. Guaranteed: at least one point is
/// kept of a cloud with a finite point inside the crop box. Cost: n log n; 5 million points take a few seconds.
///
/// # Errors
/// [`Cancelled`].
pub fn clean(points: &[DVec3], spec: &CleanSpec, seed: Seed, run: &Run<'_>) -> Result<Cleaned, Cancelled> {
    let inside = |p: DVec3| match spec.crop {
        Some([a, b]) => p.cmpge(a.min(b)).all() && p.cmple(a.max(b)).all(),
        None => true,
    };
    let mut kept: Vec<usize> =
        (0..points.len()).filter(|&i| points[i].is_finite() && inside(points[i])).collect();
    let mut out = Cleaned { cropped: points.len() - kept.len(), ..Cleaned::default() };
    run.cancel.check()?;
    if spec.plane {
        let before = kept.len();
        let here: Vec<DVec3> = kept.iter().map(|&i| points[i]).collect();
        if let Some((normal, level, width)) = ground(&here, spec, seed) {
            kept.retain(|&i| normal.dot(points[i]) - level > width);
        } else {
            out.ground_across = lying(&here, spec, seed);
        }
        out.ground = before - kept.len();
    }
    run.cancel.check()?;
    if spec.outliers && kept.len() > 32 {
        let before = kept.len();
        let here: Vec<DVec3> = kept.iter().map(|&i| points[i]).collect();
        let good = dense(&here);
        let mut row = 0;
        kept.retain(|_| {
            row += 1;
            good[row - 1]
        });
        out.outliers = before - kept.len();
        run.cancel.check()?;
        let here: Vec<DVec3> = kept.iter().map(|&i| points[i]).collect();
        if let Some(largest) = largest_thing(&here) {
            out.others = kept.len() - largest.len();
            kept = largest.into_iter().map(|i| kept[i]).collect();
        }
    }
    out.kept = kept;
    Ok(out)
}

/// Gap between two objects, as a share of the size of the cloud; leaves of one plant, and scraps of a torn leaf, are
/// nearer.
const APART: f64 = 0.12;
/// Share of the points below which a piece is not an object but stray points.
const A_THING: f64 = 0.05;

/// Returns the rows of the largest of several separate objects in a cloud; `None` if there is only one, stray points
/// aside.
pub fn largest_thing(points: &[DVec3]) -> Option<Vec<usize>> {
    let mut rows: Vec<usize> = (0..points.len()).filter(|&i| points[i].is_finite()).collect();
    let mut found = false;
    // Far points make the cubes large: each round resolves the rest more finely.
    for _ in 0..6 {
        let here: Vec<DVec3> = rows.iter().map(|&i| points[i]).collect();
        let size = extent(&here);
        if size <= 0.0 {
            break;
        }
        let cubes = Voxels::with_cell(&here, 0.5 * APART * size);
        let mut piece = vec![usize::MAX; cubes.len()];
        let mut sizes: Vec<usize> = Vec::new();
        let mut stack = Vec::new();
        for first in 0..cubes.len() {
            if piece[first] != usize::MAX {
                continue;
            }
            sizes.push(0);
            piece[first] = sizes.len() - 1;
            stack.push(first);
            while let Some(c) = stack.pop() {
                sizes[piece[first]] += cubes.rows(c).len();
                cubes.near(c, 1, |k| {
                    if piece[k] == usize::MAX {
                        piece[k] = piece[first];
                        stack.push(k);
                    }
                });
            }
        }
        let Some(best) = (0..sizes.len()).max_by_key(|&k| (sizes[k], core::cmp::Reverse(k))) else { break };
        if sizes.len() == 1 {
            break;
        }
        let least = A_THING * sizes[best] as f64;
        found |= sizes.iter().enumerate().any(|(k, &n)| k != best && n as f64 >= least);
        let mut keep = vec![false; here.len()];
        for c in (0..cubes.len()).filter(|&c| piece[c] == best) {
            cubes.rows(c).iter().for_each(|&i| keep[i as usize] = true);
        }
        let mut row = 0;
        rows.retain(|_| {
            row += 1;
            keep[row - 1]
        });
    }
    found.then_some(rows)
}

/// Least share of the points above a table, and least height of the objects on it relative to the size of the cloud.
const ON_TABLE: f64 = 0.05;

/// Returns the rows of the objects on a table or turntable in a cloud, whichever axis is up; `None` if there is none.
///
/// A table is a filled plane of a quarter of the points with everything else on one side of it, unless that rest is a
/// line: a flat blade with its stalk is not a table.
pub fn on_table(points: &[DVec3], seed: Seed) -> Option<Vec<usize>> {
    let axes = [DVec3::Y, DVec3::Z, DVec3::X, DVec3::NEG_Y, DVec3::NEG_Z, DVec3::NEG_X];
    let finite: Vec<usize> = (0..points.len()).filter(|&i| points[i].is_finite()).collect();
    let all: Vec<DVec3> = finite.iter().map(|&i| points[i]).collect();
    let few: Vec<DVec3> = thin(&all, 3000).into_iter().map(|i| all[i as usize]).collect();
    axes.into_iter().find_map(|up| {
        let spec = CleanSpec { up, plane_share: 0.25, ..CleanSpec::default() };
        let (normal, level, width) = ground(&few, &spec, seed)?;
        let over = |p: DVec3| normal.dot(p) - level;
        let above: Vec<DVec3> = few.iter().copied().filter(|p| over(*p) > width).collect();
        let height = above.iter().map(|p| over(*p)).fold(0.0, f64::max);
        let (_, _, [first, second, _]) = geom::pca3(&above)?;
        let stands = above.len() as f64 > ON_TABLE * few.len() as f64
            && height > ON_TABLE * extent(&few)
            && second > 0.06 * first
            && filled(&few, normal, level, width)
            && reaches_over(&few, normal, level, width);
        stands.then(|| finite.iter().copied().filter(|&i| over(points[i]) > width).collect())
    })
}

/// Returns the normal (upwards), level and half width of a ground plane.
fn ground(points: &[DVec3], spec: &CleanSpec, seed: Seed) -> Option<(DVec3, f64, f64)> {
    let few: Vec<DVec3> = thin(points, 3000).into_iter().map(|i| points[i as usize]).collect();
    if few.len() < 50 {
        return None;
    }
    let up = spec.up.try_normalize().unwrap_or(DVec3::Y);
    let width = extent(points) * 0.008;
    let mut stream = seed.stream(Draw::Sampling);
    let mut best: Option<(usize, DVec3, f64)> = None;
    for _ in 0..400 {
        let [a, b, c] = [0; 3].map(|_: u8| few[stream.below(few.len())]);
        let Some(n) = (b - a).cross(c - a).try_normalize() else { continue };
        let n = if n.dot(up) < 0.0 { -n } else { n };
        // cos 25 degrees
        if n.dot(up) < 0.906 {
            continue;
        }
        let level = n.dot(a);
        let count = few.iter().filter(|p| (n.dot(**p) - level).abs() <= width).count();
        if best.as_ref().is_none_or(|b| count > b.0) {
            best = Some((count, n, level));
        }
    }
    let (_, n, level) = best?;
    // Least squares through the points near it.
    let near: Vec<DVec3> = few.iter().copied().filter(|p| (n.dot(*p) - level).abs() <= width).collect();
    let (centre, [_, _, refined], _) = geom::pca3(&near)?;
    let refined = if refined.dot(up) < 0.0 { -refined } else { refined };
    let n = if refined.dot(up) > 0.906 { refined } else { n };
    let level = n.dot(centre);
    let within = points.iter().filter(|p| (n.dot(**p) - level).abs() <= width).count();
    let below = points.iter().filter(|p| n.dot(**p) - level < -width).count();
    let others = points.len() - within;
    let is_ground = within as f64 >= spec.plane_share * points.len() as f64
        && below as f64 <= 0.03 * others as f64
        && others > 16;
    is_ground.then_some((n, level, width))
}

/// Returns the axis to which a ground is perpendicular, if it is not `up`: a quarter of the points, and a plant that
/// stands out.
fn lying(points: &[DVec3], spec: &CleanSpec, seed: Seed) -> Option<DVec3> {
    let few: Vec<DVec3> = thin(points, 3000).into_iter().map(|i| points[i as usize]).collect();
    let up = spec.up.try_normalize().unwrap_or(DVec3::Y);
    let axes = [DVec3::Z, DVec3::NEG_Z, DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y];
    // Not upside down: a level leaf on a stalk looks like that.
    axes.into_iter().filter(|a| a.dot(up).abs() < 0.9).find(|&axis| {
        let there = CleanSpec { up: axis, plane_share: 0.25, ..*spec };
        ground(&few, &there, seed).is_some_and(|(normal, level, width)| {
            let height = few.iter().map(|p| normal.dot(*p) - level).fold(0.0, f64::max);
            height > 0.25 * extent(&few) && filled(&few, normal, level, width)
        })
    })
}

/// Whether a table is as wide as the objects on it, on all sides, which the flat part of a blade is not.
fn reaches_over(points: &[DVec3], normal: DVec3, level: f64, width: f64) -> bool {
    let (u, v) = normal.any_orthonormal_pair();
    let limits = |on: bool, axis: DVec3| {
        let side = points.iter().filter(|p| ((normal.dot(**p) - level).abs() <= width) == on);
        side.map(|p| axis.dot(*p)).fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)))
    };
    [u, v].iter().all(|&axis| {
        let ((low, high), (least, most)) = (limits(true, axis), limits(false, axis));
        let slack = 0.05 * (high - low);
        least >= low - slack && most <= high + slack
    })
}

/// Whether a plane fills its box, as a table or a turntable does and leaves do not: 60 of 100 cells of 10 x 10.
fn filled(points: &[DVec3], normal: DVec3, level: f64, width: f64) -> bool {
    let (u, v) = normal.any_orthonormal_pair();
    let near = points.iter().filter(|p| (normal.dot(**p) - level).abs() <= width);
    let flat: Vec<[f64; 2]> = near.map(|p| [u.dot(*p), v.dot(*p)]).collect();
    let low = [0, 1].map(|i| flat.iter().map(|p| p[i]).fold(f64::INFINITY, f64::min));
    let high = [0, 1].map(|i| flat.iter().map(|p| p[i]).fold(f64::NEG_INFINITY, f64::max));
    let mut seen = [false; 100];
    for p in &flat {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 9")]
        let [i, j] = [0, 1]
            .map(|k| (10.0 * (p[k] - low[k]) / (high[k] - low[k]).max(1e-300)).clamp(0.0, 9.0) as usize);
        seen[10 * i + j] = true;
    }
    seen.iter().filter(|s| **s).count() >= 60
}

/// Returns for each point whether its surroundings are dense enough.
fn dense(points: &[DVec3]) -> Vec<bool> {
    let v = Voxels::new(points, 4.0);
    let mut company = vec![0_usize; v.len()];
    for (c, sum) in company.iter_mut().enumerate() {
        v.near(c, 1, |k| *sum += v.rows(k).len());
    }
    let mut sorted: Vec<usize> = company.clone();
    sorted.sort_unstable();
    let usual = sorted[sorted.len() / 2];
    let mut piece = vec![usize::MAX; v.len()];
    let mut sizes: Vec<usize> = Vec::new();
    let mut stack = Vec::new();
    for c in 0..v.len() {
        if piece[c] != usize::MAX || company[c] * 10 < usual {
            continue;
        }
        let mark = sizes.len();
        sizes.push(0);
        piece[c] = mark;
        stack.push(c);
        while let Some(c) = stack.pop() {
            sizes[mark] += v.rows(c).len();
            v.near(c, 2, |k| {
                if piece[k] == usize::MAX && company[k] * 10 >= usual {
                    piece[k] = mark;
                    stack.push(k);
                }
            });
        }
    }
    let mut good = vec![false; points.len()];
    for c in 0..v.len() {
        if piece[c] != usize::MAX && sizes[piece[c]] * 200 >= points.len() {
            v.rows(c).iter().for_each(|&i| good[i as usize] = true);
        }
    }
    // A cloud of specks only is kept as it is.
    if good.iter().any(|g| *g) { good } else { vec![true; points.len()] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::ops;

    /// Makes a stem of 10 cm on a table of 30 x 30 cm, with stray points far above.
    fn scene() -> (Vec<DVec3>, usize, usize) {
        let mut s = Seed::new(3).stream(Draw::Test);
        let mut p = Vec::new();
        for _ in 0..8000 {
            p.push(DVec3::new(s.range(-0.15, 0.15), 0.0003 * s.normal(), s.range(-0.15, 0.15)));
        }
        let table = p.len();
        for _ in 0..4000 {
            let a = s.range(0.0, ops::TAU);
            p.push(DVec3::new(0.005 * ops::cos(a), s.range(0.004, 0.1), 0.005 * ops::sin(a)));
        }
        for _ in 0..20 {
            p.push(DVec3::new(s.range(-0.1, 0.1), s.range(0.12, 0.2), s.range(-0.1, 0.1)));
        }
        p.push(DVec3::NAN);
        (p, table, table + 4000)
    }

    #[test]
    fn the_stem_stays_the_table_and_the_strays_go() {
        let (p, table, stem) = scene();
        let c = clean(&p, &CleanSpec::default(), Seed::new(1), &Run::plain()).unwrap();
        let kept_stem = c.kept.iter().filter(|&&i| (table..stem).contains(&i)).count();
        assert!(kept_stem > 3900, "{kept_stem} of the stem's 4000 points are left");
        assert!(c.kept.len() - kept_stem < 5, "{} others are left", c.kept.len() - kept_stem);
        assert_eq!((c.cropped, c.kept.len() + c.cropped + c.ground + c.outliers), (1, p.len()));
        assert_eq!(c.others, 0);
    }

    #[test]
    fn people_are_left_out_and_a_table_is_seen_whichever_way_is_up() {
        let (mut p, table, stem) = scene();
        let person: Vec<DVec3> =
            p[table..stem].iter().step_by(3).map(|q| DVec3::new(0.9, 0.0, 0.2) + *q * 9.0).collect();
        p.extend(&person);
        let c = clean(&p, &CleanSpec::default(), Seed::new(1), &Run::plain()).unwrap();
        assert!(c.others > 1200 && c.kept.iter().all(|&i| i < stem), "{} {}", c.others, c.kept.len());
        assert_eq!(largest_thing(&p[table..stem]), None);
        assert_eq!(largest_thing(&[DVec3::ONE; 9]), None);
        // A blade over a table: +Z up, +Y up, upside down.
        let mut s = Seed::new(4).stream(Draw::Test);
        let mut scan: Vec<DVec3> = p[..table].iter().map(|q| *q * 0.4).collect();
        let first = scan.len();
        scan.extend((0..5000).map(|_| {
            let (x, z) = (s.range(-0.02, 0.02), s.range(0.0, 0.05));
            DVec3::new(x, 0.02 + 3.0 * z * z, z)
        }));
        for turn in [|p: DVec3| p, |p: DVec3| DVec3::new(p.x, -p.z, p.y), |p: DVec3| -p] {
            let turned: Vec<DVec3> = scan.iter().map(|p| turn(*p)).collect();
            let kept = on_table(&turned, Seed::new(1)).unwrap();
            assert!(kept.len() > 4900 && kept.iter().all(|&i| i >= first), "{}", kept.len());
        }
        assert_eq!(on_table(&scan[first..], Seed::new(1)), None, "the flat part of a blade");
        assert_eq!(on_table(&[DVec3::NAN; 100], Seed::new(1)), None);
    }

    #[test]
    fn a_scene_that_lies_down_is_told() {
        let (p, _, _) = scene();
        // As written by a scanner with +Z up.
        let lying: Vec<DVec3> = p.iter().map(|p| DVec3::new(p.x, -p.z, p.y)).collect();
        let c = clean(&lying, &CleanSpec::default(), Seed::new(1), &Run::plain()).unwrap();
        assert_eq!((c.ground, c.ground_across), (0, Some(DVec3::Z)));
        let c = clean(&p, &CleanSpec::default(), Seed::new(1), &Run::plain()).unwrap();
        assert_eq!(c.ground_across, None);
    }

    #[test]
    fn a_leaf_is_no_ground() {
        let mut s = Seed::new(5).stream(Draw::Test);
        // A level leaf on a stalk: most of the points in one plane, but the stalk hangs below.
        let mut p: Vec<DVec3> =
            (0..3000).map(|_| DVec3::new(s.range(0.0, 0.04), 0.05, s.range(0.0, 0.02))).collect();
        p.extend((0..600).map(|_| DVec3::new(0.0, s.range(0.0, 0.05), 0.01)));
        let c = clean(&p, &CleanSpec::default(), Seed::new(1), &Run::plain()).unwrap();
        assert_eq!((c.ground, c.ground_across), (0, None));
        assert!(c.kept.len() > 3500, "{c:?}");
    }

    #[test]
    fn crop_and_hostile_points() {
        let spec = CleanSpec { crop: Some([DVec3::ONE, DVec3::ZERO]), ..CleanSpec::default() };
        let p = [DVec3::splat(0.5), DVec3::splat(2.0), DVec3::NAN];
        let c = clean(&p, &spec, Seed::new(1), &Run::plain()).unwrap();
        assert_eq!((c.kept, c.cropped), (vec![0], 2));
        assert!(clean(&[], &CleanSpec::default(), Seed::new(1), &Run::plain()).unwrap().kept.is_empty());
    }
}
