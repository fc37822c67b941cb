//! Segments a cleaned plant into stem and leaves, each with the path along it.
//!
//! Distances along the surface from the foot cut the plant into bands; connected pieces of bands make a tree (a
//! Reeb graph); its branches are organs.

use std::sync::Arc;

use base::{Cancelled, Run};
use glam::DVec3;

use crate::BloomError;
use crate::reeb::Tree;
use crate::ways::{SegmentSpec, Ways};

/// One organ of a scan.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ScanOrgan {
    /// `stem`, `leaf-1`, ... or a name that the user gave.
    pub name: String,
    /// Rows of the organ's points in the cloud it was cut from.
    pub rows: Vec<usize>,
    /// The points, metres.
    pub points: Vec<DVec3>,
    /// Colours of the points, sRGB bytes; empty or one per point.
    pub colors: Vec<[u8; 3]>,
    /// Position along the organ from its base, 0 to 1, one per point.
    pub way: Vec<f64>,
    /// Joint on its bearer.
    pub base: DVec3,
    /// Its farthest place along the surface.
    pub tip: DVec3,
    /// Corners of the triangles among the points, if it is a model; otherwise empty. Models of equal triangles have the
    /// same vertices in the same order, and need no search for corresponding points.
    pub faces: Arc<[[u32; 3]]>,
}

impl ScanOrgan {
    /// Adds the colours of the cloud that it was cut from; none, if there is not one per point.
    #[must_use]
    pub fn coloured(mut self, colors: &[[u8; 3]]) -> Self {
        let own: Vec<[u8; 3]> = self.rows.iter().filter_map(|&row| colors.get(row).copied()).collect();
        self.colors = if own.len() == self.points.len() { own } else { Vec::new() };
        self
    }

    /// Whether points of the same row in both organs correspond.
    pub(crate) fn shares_vertices(&self, other: &Self) -> bool {
        !self.faces.is_empty() && self.points.len() == other.points.len() && self.faces == other.faces
    }

    /// Returns the rows of `points` by region: equal parts of the path from base to tip, base first.
    pub fn regions(&self, count: usize) -> Vec<Vec<usize>> {
        let count = count.max(1);
        let mut out = vec![Vec::new(); count];
        for (i, w) in self.way.iter().enumerate() {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to count")]
            let k = ((w * count as f64) as usize).min(count - 1);
            out[k].push(i);
        }
        out
    }
}

/// Segments a plant into stem and leaves. The stem comes first; leaves follow by size, largest first.
///
/// Pieces that are not connected with the foot are bridged over the shortest gap. A stem runs from the foot through forks
/// as long as what lies beyond stands around it; what stands on one side is a leaf, with its leaflets. Guaranteed: every
/// finite point belongs to exactly one organ; a cloud that is turned about `up`, moved or shuffled has the same organs, but
/// for points at the seams. Not guaranteed: that all touching organs are separated. Cost: n log n.
///
/// # Errors
/// [`BloomError::TooFew`] below 16 finite points; cancelled.
pub fn organs(points: &[DVec3], spec: &SegmentSpec, run: &Run<'_>) -> Result<Vec<ScanOrgan>, BloomError> {
    let ways = Ways::new(points, spec, run.cancel)?;
    let tree = Tree::new(&ways, spec, run.cancel)?;
    let labels = tree.labels(&ways, spec);
    let count = labels.iter().copied().max().unwrap_or(0) + 1;
    let one = |label| run.cancel.check().map(|()| cut(points, &ways, |c| labels[c] == label));
    let mut out: Vec<ScanOrgan> = (0..count).map(one).collect::<Result<_, Cancelled>>()?;
    for (i, organ) in out.iter_mut().enumerate() {
        organ.name = if i == 0 { "stem".into() } else { format!("leaf-{i}") };
    }
    Ok(out)
}

/// Returns the organ nearest to a seed point that a person picked.
///
/// # Errors
/// As [`organs`].
pub fn organ_at(
    points: &[DVec3],
    place: DVec3,
    spec: &SegmentSpec,
    run: &Run<'_>,
) -> Result<ScanOrgan, BloomError> {
    let all = organs(points, spec, run)?;
    let nearest =
        |o: &ScanOrgan| o.points.iter().map(|p| p.distance_squared(place)).fold(f64::INFINITY, f64::min);
    let best = all.into_iter().min_by(|a, b| nearest(a).total_cmp(&nearest(b)));
    best.ok_or_else(|| BloomError::TooFew { what: "the scan".into(), is: 0, wanted: 16 })
}

/// Takes the whole cloud as one organ, such as a petal that was cut out already.
///
/// # Errors
/// [`BloomError::TooFew`] below 16 finite points; cancelled.
pub fn single_organ(
    points: &[DVec3],
    name: &str,
    spec: &SegmentSpec,
    run: &Run<'_>,
) -> Result<ScanOrgan, BloomError> {
    let ways = Ways::new(points, spec, run.cancel)?;
    let mut organ = cut(points, &ways, |_| true);
    organ.name = name.to_owned();
    Ok(organ)
}

fn cut(points: &[DVec3], ways: &Ways, mine: impl Fn(usize) -> bool) -> ScanOrgan {
    let cubes: Vec<usize> = (0..ways.way.len()).filter(|&c| mine(c)).collect();
    let low = cubes.iter().map(|&c| ways.way[c]).fold(f64::INFINITY, f64::min);
    let high = cubes.iter().map(|&c| ways.way[c]).fold(0.0, f64::max);
    let span = (high - low).max(1e-12);
    let mut organ = ScanOrgan::default();
    let tip = cubes.iter().copied().max_by(|&a, &b| ways.way[a].total_cmp(&ways.way[b]));
    organ.tip = tip.map_or(DVec3::ZERO, |c| ways.means[c]);
    // The base: the mean of the first 4 % of the path.
    let first: Vec<DVec3> =
        cubes.iter().filter(|&&c| ways.way[c] <= low + 0.04 * span).map(|&c| ways.means[c]).collect();
    organ.base = first.iter().sum::<DVec3>() / first.len().max(1) as f64;
    let mut rows: Vec<(usize, f64)> = cubes
        .iter()
        .flat_map(|&c| ways.voxels.rows(c).iter().map(move |&i| (i as usize, (ways.way[c] - low) / span)))
        .collect();
    base::sort_by_key(&mut rows, |r| r.0);
    for (i, way) in rows {
        organ.rows.push(i);
        organ.points.push(points[i]);
        organ.way.push(way.clamp(0.0, 1.0));
    }
    organ
}

/// Returns pairs of the same organ on two days: rows of `a` and of `b`, each at most once.
///
/// The stem matches the stem. A leaf matches the one whose direction has turned least (at most 80 degrees), lengths and
/// shares of the points deciding between near ones. One that has turned far and is also of another size is no match: an
/// organ that appears or vanishes stays single. As pots are turned and stems twist, all leaves may turn together about
/// `up` by up to 60 degrees, at a cost.
pub fn match_organs(a: &[ScanOrgan], b: &[ScanOrgan], up: DVec3) -> Vec<(usize, usize)> {
    let up = up.try_normalize().unwrap_or(DVec3::Y);
    let mut best: Option<(f64, Vec<(usize, usize)>)> = None;
    for step in -6..=6_i32 {
        let angle = f64::from(step) * (10.0 / 180.0 * base::ops::PI);
        let (cost, pairs) = match_turned(a, b, up, angle);
        let cost = cost + 0.4 * angle.abs();
        if best.as_ref().is_none_or(|(c, _)| cost < *c) {
            best = Some((cost, pairs));
        }
    }
    best.map_or_else(Vec::new, |b| b.1)
}

/// Returns the pairs if all leaves turned by `angle`, and their cost; an organ without partner costs 1.
fn match_turned(a: &[ScanOrgan], b: &[ScanOrgan], up: DVec3, angle: f64) -> (f64, Vec<(usize, usize)>) {
    let turn = base::turn::about(up, angle);
    let direction = |o: &ScanOrgan| {
        let d = o.tip - o.base;
        let level = d - up * d.dot(up);
        level.try_normalize().or_else(|| d.try_normalize()).unwrap_or(DVec3::X)
    };
    let total = |all: &[ScanOrgan]| all.iter().map(|o| o.points.len()).sum::<usize>().max(1) as f64;
    let (all_a, all_b) = (total(a), total(b));
    let size = |o: &ScanOrgan| o.base.distance(o.tip).max(1e-9);
    let mut out = Vec::new();
    let mut costs = Vec::new();
    for (i, x) in a.iter().enumerate() {
        for (j, y) in b.iter().enumerate() {
            let stems = (x.name == "stem", y.name == "stem");
            if stems == (true, true) {
                out.push((i, j));
            } else if stems == (false, false) {
                let angle = base::ops::acos_clamped((turn * direction(x)).dot(direction(y)));
                let growth = base::ops::ln(size(y) / size(x)).abs();
                let share = (y.points.len().max(1) as f64 / all_b) / (x.points.len().max(1) as f64 / all_a);
                let cost = angle + 0.4 * growth + 0.2 * base::ops::ln(share).abs();
                if cost < 1.4 {
                    costs.push((cost, i, j));
                }
            }
        }
    }
    base::sort_by(&mut costs, |x, y| x.0.total_cmp(&y.0).then((x.1, x.2).cmp(&(y.1, y.2))));
    let mut sum = 0.0;
    for (cost, i, j) in costs {
        if out.iter().all(|&(p, q)| p != i && q != j) {
            out.push((i, j));
            sum += cost;
        }
    }
    sum += (a.len().min(b.len()) - out.len().min(a.len().min(b.len()))) as f64;
    base::sort_by_key(&mut out, |&pair| pair);
    (sum, out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::{CancelToken, Draw, Seed, ops};

    /// Makes a stem of 30 mm with three leaves at azimuths 0, 120 and 240 degrees; also returns the numbers of points.
    fn seedling(lengths: [f64; 3]) -> (Vec<DVec3>, Vec<usize>) {
        let mut s = Seed::new(2).stream(Draw::Test);
        let mut points = Vec::new();
        for _ in 0..3000 {
            let a = s.range(0.0, ops::TAU);
            points.push(DVec3::new(0.0012 * ops::cos(a), s.range(0.0, 0.03), 0.0012 * ops::sin(a)));
        }
        let mut sizes = vec![3000];
        for (k, length) in lengths.into_iter().enumerate() {
            let (sin, cos) = ops::sin_cos(ops::TAU * k as f64 / 3.0);
            for _ in 0..5000 {
                let (v, u) = (s.uniform(), s.range(-1.0, 1.0));
                let half =
                    if v < 0.25 { 0.001 } else { 0.008 * ops::sin(ops::PI * (v - 0.25) / 0.75) + 0.0005 };
                let (r, across) = (length * v, u * half);
                points.push(DVec3::new(
                    r * cos - across * sin,
                    0.03 + 0.3 * r * (1.0 - v),
                    r * sin + across * cos,
                ));
            }
            sizes.push(5000);
        }
        (points, sizes)
    }

    #[test]
    fn a_seedling_falls_into_its_stem_and_leaves() {
        let (points, sizes) = seedling([0.03, 0.03, 0.03]);
        let got = organs(&points, &SegmentSpec::default(), &Run::plain()).unwrap();
        assert_eq!(got.len(), 4, "{:?}", got.iter().map(|o| (&o.name, o.rows.len())).collect::<Vec<_>>());
        assert_eq!(got.iter().map(|o| o.rows.len()).sum::<usize>(), points.len());
        let mut begin = 0;
        for size in sizes {
            let share =
                |o: &ScanOrgan| o.rows.iter().filter(|&&i| (begin..begin + size).contains(&i)).count();
            let best = got.iter().map(share).max().unwrap();
            assert!(best * 100 > size * 88, "{best} of {size} points lie in one organ");
            begin += size;
        }
        assert!(got[0].base.y < 0.003 && got[0].tip.y > 0.025, "{:?} {:?}", got[0].base, got[0].tip);
        for leaf in &got[1..] {
            assert!(
                leaf.tip.length() > 0.03 && leaf.base.distance(DVec3::Y * 0.03) < 0.006,
                "{:?}",
                leaf.base
            );
            let regions = leaf.regions(3);
            assert!(
                regions.iter().all(|r| r.len() > 300),
                "{:?}",
                regions.iter().map(Vec::len).collect::<Vec<_>>()
            );
            let mean = |r: &[usize]| {
                r.iter().map(|&i| leaf.points[i].distance(leaf.base)).sum::<f64>() / r.len() as f64
            };
            assert!(mean(&regions[0]) < mean(&regions[1]) && mean(&regions[1]) < mean(&regions[2]));
        }
    }

    #[test]
    fn a_seed_point_picks_its_organ_and_leaves_are_found_again_after_turning() {
        let (points, _) = seedling([0.03, 0.025, 0.02]);
        let one =
            organ_at(&points, DVec3::new(0.025, 0.031, 0.0), &SegmentSpec::default(), &Run::plain()).unwrap();
        assert!(one.points.iter().filter(|p| p.x > 0.01).count() * 2 > one.points.len(), "{:?}", one.tip);
        let q = base::turn::about(DVec3::Y, 0.6);
        let turned: Vec<DVec3> = points.iter().map(|p| q * *p * 1.2).collect();
        let (a, b) = (
            organs(&points, &SegmentSpec::default(), &Run::plain()).unwrap(),
            organs(&turned, &SegmentSpec::default(), &Run::plain()).unwrap(),
        );
        let pairs = match_organs(&a, &b, DVec3::Y);
        assert_eq!(pairs.len(), 4);
        for (i, j) in pairs {
            assert!((q * a[i].tip * 1.2).distance(b[j].tip) < 0.006, "{} is not {}", a[i].name, b[j].name);
        }
    }

    #[test]
    fn a_cancelled_run_cuts_nothing() {
        let (points, cancel) = (seedling([0.03; 3]).0, CancelToken::new());
        let (spec, run) = (SegmentSpec::default(), Run { cancel: &cancel, ..Run::plain() });
        assert!(organs(&points, &spec, &run).is_ok());
        cancel.cancel();
        assert!(matches!(organs(&points, &spec, &run), Err(BloomError::Cancelled)));
        assert!(matches!(single_organ(&points, "petal", &spec, &run), Err(BloomError::Cancelled)));
        assert_eq!(crate::blades(&points, &run), Err(Cancelled));
    }

    #[test]
    fn one_petal_and_too_few_points() {
        let (points, _) = seedling([0.03; 3]);
        let petal = single_organ(
            &points[3000..8000],
            "petal",
            &SegmentSpec { foot: Some(DVec3::ZERO), ..Default::default() },
            &Run::plain(),
        );
        let petal = petal.unwrap();
        assert!(petal.rows.len() == 5000 && petal.base.length() < 0.032, "{:?}", petal.base);
        assert!(matches!(
            organs(&points[..9], &SegmentSpec::default(), &Run::plain()),
            Err(BloomError::TooFew { is: 9, .. })
        ));
    }
}
