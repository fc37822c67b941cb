//! A scanned leaf -> midrib, outline, stalk and a surface, with its distances from the cloud.
//!
//! points -> an even sample without outliers -> stalk (where the cloud is linear) -> plane of the blade -> height field
//! -> margins, midrib -> grid -> distances of all points

mod lines;
mod near;
#[cfg(test)]
mod tests;

use base::{Draw, Report, Run, Seed, map_indexed};
use geom::{Ball, BallBSpline, HeightField, KdTree, SplineError, one_a_cube};
use glam::{DVec2, DVec3};

use self::lines::Lines;
use self::near::{Near, segment_distance};
use crate::marks::{MARKS_A_ROW, MarkRow, Marks};

/// Settings of the search for a leaf in a cloud. Lengths in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScanSpec {
    /// Rows of the surface's grid, 8 to 400. Default 64.
    pub rows: usize,
    /// Columns of the grid, 8 to 400, made odd. Default 41.
    pub columns: usize,
    /// Distance within which the model explains a point. Default 0.002.
    pub explained_m: f64,
    /// Stiffness of the surface, above 0: 0.01 follows the cloud, 1 is smooth. Default 0.05.
    pub smoothing: f64,
    /// Attachment of the blade to its stalk, if known: then the points are those of the blade alone. Default `None`.
    pub base: Option<DVec3>,
}

impl Default for ScanSpec {
    fn default() -> Self {
        Self { rows: 64, columns: 41, explained_m: 0.002, smoothing: 0.05, base: None }
    }
}

/// A leaf found in a scan, in the scan's coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct ScanLeaf {
    /// Points of the blade, row after row from base to tip, each from left to right.
    pub grid: Vec<DVec3>,
    /// Points per row; the midrib is the middle one.
    pub columns: usize,
    /// The stalk, from the blade outwards, if the cloud has one.
    pub stalk: Option<BallBSpline>,
    /// Number of points of the cloud that were used.
    pub used: usize,
    /// Number of outliers, which are far from their neighbours compared with the others.
    pub outliers: usize,
    /// Distance of each used point from the model, metres.
    pub distances: Vec<f64>,
    /// Share of all points of the cloud, including outliers, that are within `explained_m` of the model.
    pub explained: f64,
    /// Share of the blade that has a point of the cloud within `explained_m`; the rest is a hole or was bridged.
    pub covered: f64,
    /// The blade as marks, for the other commands; thickness unknown except for the stalk's at the last row.
    pub marks: Marks,
}

/// Reason why no leaf was found.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ScanError {
    /// There are too few points, or they all lie at one point or on a line.
    #[error(
        "{0} points are too few for a leaf, or lie on a line; a blade needs at least 100 that spread over it"
    )]
    TooFew(usize),
    /// There are more points than one leaf needs.
    #[error("{0} points are too many for one leaf; thin the cloud out to at most {1}")]
    TooMany(usize, usize),
    /// The surface could not be fitted.
    #[error("no surface fits the cloud: {0}")]
    Spline(#[from] SplineError),
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] base::Cancelled),
}

/// Most points of a cloud, as for a scan's reader.
const MOST_POINTS: usize = 32 << 20;
/// Points from which the leaf is made; all are measured against it. On a leaf of a hand's length they are a quarter of
/// a millimetre apart, which is finer than its grid.
const SAMPLE: usize = 100_000;
/// Points whose surroundings are searched for a stalk.
const STALK_SAMPLE: usize = 4096;
/// Distance within which a neighbour keeps a point from being an outlier, as a share of the size of the leaf: in a
/// sparse cloud a stalk has few points.
const COMPANY: f64 = 0.15;
/// Largest ratio of the second variance to the first at which a cloud is a line: that of a strip three times as long as
/// wide; the margin of a blade has 0.25 and more.
const SLIM: f64 = 0.09;
/// Radius, in reaches, of the neighbourhood over which the median of that ratio is taken.
const AROUND: f64 = 0.5;
/// Least number of neighbours that define a direction.
const FEW: usize = 8;
/// Longest gap within a stalk, as a share of the deviation of the cloud along itself, which is 0.29 of its length.
const GAP: f64 = 0.7;
/// Directions that are tried for the midrib of a leaf without a stalk.
const WAYS: u32 = 36;
/// Least length of the blade along such a direction, as a share of the longest.
const AS_LONG: f64 = 0.85;
/// Cubes along a leaf, each of which counts once when its plane is fitted, however dense the cloud is there.
const EVEN: f64 = 40.0;

/// The plane in which the blade is viewed: x across, y from base to tip, z the upper side.
#[derive(Clone, Copy)]
struct Plane {
    origin: DVec3,
    x: DVec3,
    y: DVec3,
    z: DVec3,
}

impl Plane {
    fn local(&self, p: DVec3) -> DVec3 {
        let d = p - self.origin;
        DVec3::new(d.dot(self.x), d.dot(self.y), d.dot(self.z))
    }

    fn world(&self, p: DVec3) -> DVec3 {
        self.origin + self.x * p.x + self.y * p.y + self.z * p.z
    }
}

/// Finds one leaf in a cloud of points: outliers, stalk, midrib, margins, surface.
///
/// The blade must be a height field over its own plane (folded back on itself it is not). The base is where the stalk
/// is; without a stalk it is the broader end, and `report` says so. The upper side is chosen by +Y. Repeated points and
/// uneven density do no harm: the leaf is made from an even sample. Cost: n log n; 5 million points take some seconds.
///
/// # Errors
/// [`ScanError`].
pub fn fit_scan(
    points: &[DVec3],
    spec: &ScanSpec,
    run: &Run<'_>,
    report: &mut Report,
) -> Result<ScanLeaf, ScanError> {
    let all: Vec<DVec3> = points.iter().copied().filter(|p| p.abs().max_element() <= 1e9).collect();
    if all.len() < 100 {
        return Err(ScanError::TooFew(all.len()));
    }
    if all.len() > MOST_POINTS {
        return Err(ScanError::TooMany(all.len(), MOST_POINTS));
    }
    let Some(sample) = Sample::from_cloud(&all, run) else { return Err(ScanError::TooFew(all.len())) };
    let Sample { points: kept, spacing, .. } = &sample;
    if kept.len() < 100 || *spacing <= 0.0 {
        return Err(ScanError::TooFew(kept.len()));
    }
    run.cancel.check()?;
    let thin = match spec.base {
        Some(_) => vec![false; kept.len()],
        None => stalk_points(kept, *spacing, run),
    };
    let blade: Vec<DVec3> = kept.iter().zip(&thin).filter(|(_, t)| !**t).map(|(p, _)| *p).collect();
    let stem: Vec<DVec3> = kept.iter().zip(&thin).filter(|(_, t)| **t).map(|(p, _)| *p).collect();
    if blade.len() < 100 {
        return Err(ScanError::TooFew(blade.len()));
    }
    run.cancel.check()?;
    let known: Vec<DVec3> = spec.base.into_iter().collect();
    let joint = if known.is_empty() { &stem } else { &known };
    let plane = plane_of(&blade, joint, report).ok_or(ScanError::TooFew(blade.len()))?;
    let flat: Vec<DVec3> = blade.iter().map(|&p| plane.local(p)).collect();
    let field = surface_of(&flat, *spacing, spec.smoothing)?;
    run.cancel.check()?;
    let lines = Lines::from_points(&flat, &field, spec.rows.clamp(8, 400), *spacing);
    let columns = spec.columns.clamp(8, 400) | 1;
    let grid: Vec<DVec3> = lines.grid(columns, &field).into_iter().map(|p| plane.world(p)).collect();
    let stalk = stalk_curve(&stem, grid[columns / 2]);
    run.cancel.check()?;
    let model = Near::new(&grid, columns, stalk.as_ref());
    let pieces: Vec<&[DVec3]> = all.chunks(4096).collect();
    let measured = map_indexed(run.executor, pieces.len(), |k| {
        pieces[k].iter().map(|&p| (model.distance(p), sample.is_stray(p))).collect::<Vec<_>>()
    });
    let near = measured.iter().flatten().filter(|(d, _)| *d <= spec.explained_m).count();
    let explained = near as f64 / all.len() as f64;
    let distances: Vec<f64> = measured.iter().flatten().filter(|(_, stray)| !stray).map(|m| m.0).collect();
    let outliers = all.len() - distances.len();
    if outliers > 0 {
        base::warn!(
            report,
            "outliers",
            { count = outliers },
            "{count} points far from their neighbours were left out"
        );
    }
    let cloud = KdTree::new(kept);
    let covered = grid.iter().filter(|&&p| cloud.nearest(p, spec.explained_m).is_some()).count();
    let covered = covered as f64 / grid.len() as f64;
    let marks = marks_of(&grid, columns, stalk.as_ref());
    Ok(ScanLeaf {
        grid,
        columns,
        stalk,
        used: distances.len(),
        outliers,
        distances,
        explained,
        covered,
        marks,
    })
}

impl ScanLeaf {
    /// Returns the midrib from base to tip.
    pub fn midrib(&self) -> Vec<DVec3> {
        self.grid.chunks(self.columns).map(|row| row[self.columns / 2]).collect()
    }

    /// Returns the outline, up the right margin from the base and down the left.
    pub fn outline(&self) -> Vec<DVec3> {
        let n = self.columns;
        let right = self.grid.chunks(n).map(|row| row[n - 1]);
        let left = self.grid.chunks(n).rev().map(|row| row[0]);
        right.chain(left).collect()
    }
}

/// The finite points of a cloud, reduced to a manageable even sample.
struct Sample {
    /// Points that are not outliers.
    points: Vec<DVec3>,
    /// Typical distance from a point to its sixth neighbour.
    spacing: f64,
    /// Distance without neighbours at which a point is an outlier.
    alone: f64,
    /// All points, and which of them are outliers.
    all: KdTree,
    stray: Vec<bool>,
    /// Box outside which nothing belongs to the leaf.
    bounds: [DVec3; 2],
}

impl Sample {
    fn from_cloud(cloud: &[DVec3], run: &Run<'_>) -> Option<Self> {
        let [lo, hi] = usual_box(&some(cloud, SAMPLE))?;
        let size = (hi - lo).max_element();
        if size <= 0.0 {
            return None;
        }
        // A leaf may be three times as long as the box that contains all but a few of its points.
        let bounds = [lo - DVec3::splat(3.0 * size), hi + DVec3::splat(3.0 * size)];
        let inside: Vec<DVec3> = cloud.iter().copied().filter(|&p| within(p, bounds)).collect();
        // Coincident points count once, and details below 1/16,384 of the size are ignored.
        let one_each: Vec<DVec3> =
            one_a_cube(&inside, size / 16_384.0).into_iter().map(|i| inside[i as usize]).collect();
        let points = some(&one_each, SAMPLE);
        let tree = KdTree::new(&points);
        let sixth = map_indexed(run.executor, points.len(), |k| {
            // The nearest is the point itself.
            let mut near = [0.0; 7];
            tree.nearest_distances(points[k], &mut near);
            near[6]
        });
        let mut sorted = sixth.clone();
        base::sort_numbers(&mut sorted);
        let (median, tenth) = (sorted[sorted.len() / 2], sorted[sorted.len() * 9 / 10]);
        // Four times: stalks have fewer points than blades, and these must stay. As many as a tenth are not outliers:
        // most points then crowd in a part of the leaf, and the others determine the spacing. On an even sheet the
        // tenth is at 4/3 of the median.
        let spacing = if tenth > 4.0 * median { 0.75 * tenth } else { median };
        let alone = (4.0 * spacing).max(COMPANY * size);
        let stray: Vec<bool> = sixth.iter().map(|&d| d > alone).collect();
        let good: Vec<DVec3> = points.iter().zip(&stray).filter(|(_, s)| !**s).map(|(p, _)| *p).collect();
        let evenly = if spacing > 0.0 && spacing.is_finite() { 0.25 * spacing } else { return None };
        let kept = one_a_cube(&good, evenly).into_iter().map(|i| good[i as usize]).collect();
        Some(Self { points: kept, spacing, alone, all: tree, stray, bounds })
    }

    /// Whether a point of the cloud is far from its neighbours, as decided by the nearest of the sample.
    fn is_stray(&self, p: DVec3) -> bool {
        !within(p, self.bounds) || self.all.nearest(p, self.alone).is_none_or(|k| self.stray[k])
    }
}

fn within(p: DVec3, [lo, hi]: [DVec3; 2]) -> bool {
    p.cmpge(lo).all() && p.cmple(hi).all()
}

/// Returns at most `most` points, spread over the list but not at even steps, which a scanner's lines may have too.
fn some(points: &[DVec3], most: usize) -> Vec<DVec3> {
    if points.len() <= most {
        return points.to_vec();
    }
    let mut stream = Seed::new(1).stream(Draw::Sampling);
    let at = |k: usize| k * points.len() / most;
    (0..most).map(|k| points[at(k) + stream.below(at(k + 1) - at(k))]).collect()
}

/// Returns the box of the points except 1 in 200 at either end of each axis; coincident points count once.
fn usual_box(points: &[DVec3]) -> Option<[DVec3; 2]> {
    let mut places = points.to_vec();
    let order =
        |a: &DVec3, b: &DVec3| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)).then(a.z.total_cmp(&b.z));
    base::sort_by(&mut places, order);
    places.dedup();
    let ends = |axis: fn(&DVec3) -> f64| {
        let mut x: Vec<f64> = places.iter().map(axis).collect();
        base::sort_numbers(&mut x);
        (x[x.len() / 200], x[x.len() - 1 - x.len() / 200])
    };
    if points.is_empty() {
        return None;
    }
    let [x, y, z] = [ends(|p| p.x), ends(|p| p.y), ends(|p| p.z)];
    Some([DVec3::new(x.0, y.0, z.0), DVec3::new(x.1, y.1, z.1)])
}

/// Returns for each point whether it belongs to the stalk: around such points the cloud is a line, and together they
/// are a long piece.
fn stalk_points(points: &[DVec3], spacing: f64, run: &Run<'_>) -> Vec<bool> {
    let Some((_, _, variances)) = geom::pca3(points) else { return vec![false; points.len()] };
    // Wider than a stalk is thick, narrower than a blade.
    let reach = (0.45 * variances[0].sqrt()).max(3.0 * spacing);
    let few = some(points, STALK_SAMPLE);
    let tree = KdTree::new(&few);
    let slim = map_indexed(run.executor, few.len(), |k| {
        let mut near = Vec::new();
        let mut away = [0.0; FEW + 1];
        tree.nearest_distances(few[k], &mut away);
        tree.within(few[k], reach.max(1.001 * away[FEW]), &mut near);
        // At most 64 neighbours, evenly taken: enough for a direction.
        let step = near.len().div_ceil(64).max(1);
        let near: Vec<DVec3> = near.iter().step_by(step).map(|&i| few[i]).collect();
        geom::pca3(&near).filter(|_| near.len() >= FEW).map_or(1.0, |(_, _, v)| v[1] / v[0].max(1e-300))
    });
    // With few points a single one is unreliable: the median of its neighbours decides.
    let line = map_indexed(run.executor, few.len(), |k| {
        let mut near = Vec::new();
        tree.within(few[k], AROUND * reach, &mut near);
        let mut all: Vec<f64> = near.iter().map(|&i| slim[i]).collect();
        base::sort_numbers(&mut all);
        all[all.len() / 2] < SLIM
    });
    let apart = (4.0 * spacing).max(GAP * variances[0].sqrt());
    let (group, groups) = pieces(&few, &tree, apart, |i| line[i]);
    let extent = |members: &[usize]| {
        let first = few[members[0]];
        let far = members.iter().map(|&i| few[i].distance(first)).fold(0.0, f64::max);
        members.iter().map(|&i| few[i].distance(first)).fold(far, f64::max)
    };
    let longest = groups.iter().enumerate().map(|(k, m)| (k, extent(m), m.len()));
    let longest = longest.filter(|g| g.2 >= 10).max_by(|a, b| a.1.total_cmp(&b.1));
    // A fragment of margin is not a stalk: that must be a considerable part of the leaf.
    let stalk = longest.filter(|g| g.1 > 0.5 * variances[0].sqrt()).map(|g| g.0);
    let Some(stalk) = stalk else { return vec![false; points.len()] };
    let next = map_indexed(run.executor, points.len(), |k| tree.nearest(points[k], f64::INFINITY));
    let mut thin: Vec<bool> = next.into_iter().map(|k| k.is_some_and(|k| group[k] == Some(stalk))).collect();
    let link = 4.0 * spacing;
    let linked = KdTree::new(points);
    // The largest remainder is the blade. Other pieces join the nearer part: the loose end of a stalk joins the stalk,
    // the far side of a hole the blade.
    let (rest, rests) = pieces(points, &linked, link, |i| !thin[i]);
    let blade = (0..rests.len()).max_by_key(|&k| rests[k].len());
    let of = |wanted: &dyn Fn(usize) -> bool| -> Vec<DVec3> {
        (0..points.len()).filter(|&i| wanted(i)).map(|i| points[i]).collect()
    };
    let blade_points = of(&|i| rest[i].is_some() && rest[i] == blade);
    let stalk_points = of(&|i| thin[i]);
    let (near_blade, near_stalk) = (KdTree::new(&blade_points), KdTree::new(&stalk_points));
    for (_, members) in rests.iter().enumerate().filter(|(k, _)| Some(*k) != blade) {
        let nearest = |tree: &KdTree, of: &[DVec3]| {
            let each = members
                .iter()
                .filter_map(|&i| Some(of[tree.nearest(points[i], f64::INFINITY)?].distance(points[i])));
            each.fold(f64::INFINITY, f64::min)
        };
        if nearest(&near_stalk, &stalk_points) < nearest(&near_blade, &blade_points) {
            members.iter().for_each(|&i| thin[i] = true);
        }
    }
    thin
}

/// Divides the points chosen by `wanted` into pieces linked by steps of at most `link`: the piece of each point, and
/// the pieces.
fn pieces(
    points: &[DVec3],
    grid: &KdTree,
    link: f64,
    wanted: impl Fn(usize) -> bool,
) -> (Vec<Option<usize>>, Vec<Vec<usize>>) {
    let mut group = vec![None; points.len()];
    let mut groups: Vec<Vec<usize>> = Vec::new();
    let mut near = Vec::new();
    for start in 0..points.len() {
        if !wanted(start) || group[start].is_some() {
            continue;
        }
        let id = Some(groups.len());
        let mut members = vec![start];
        group[start] = id;
        let mut next = 0;
        while next < members.len() {
            grid.within(points[members[next]], link, &mut near);
            for &i in near.iter().filter(|&&i| wanted(i)) {
                if group[i].is_none() {
                    group[i] = id;
                    members.push(i);
                }
            }
            next += 1;
        }
        groups.push(members);
    }
    (group, groups)
}

fn plane_of(blade: &[DVec3], stem: &[DVec3], report: &mut Report) -> Option<Plane> {
    let [low, high] = usual_box(blade)?;
    let even: Vec<DVec3> =
        one_a_cube(blade, (high - low).max_element() / EVEN).into_iter().map(|i| blade[i as usize]).collect();
    let (centre, axes, variances) = geom::pca3(&even)?;
    if variances[1] <= 1e-9 * variances[0] {
        return None;
    }
    let z = if axes[2].y < 0.0 { -axes[2] } else { axes[2] };
    let tree = KdTree::new(blade);
    let gap = |p: DVec3| Some(blade[tree.nearest(p, f64::INFINITY)?].distance_squared(p));
    let join = stem.iter().filter_map(|&p| Some((gap(p)?, p))).min_by(|a, b| a.0.total_cmp(&b.0));
    let y = match join {
        // From the junction of the stalk across the middle of the blade.
        Some((_, join)) => centre - join,
        None => {
            report.warn(
                "no-stalk",
                "no stalk was found: the broader end was taken for the base, which may be wrong",
            );
            let flat: Vec<DVec2> = even
                .iter()
                .map(|p| DVec2::new((*p - centre).dot(axes[0]), (*p - centre).dot(axes[1])))
                .collect();
            let way = mirror_line(&flat);
            let along = flat.iter().map(|p| p.dot(way));
            let (low, high) = along.fold((0.0_f64, 0.0_f64), |(a, b), t| (a.min(t), b.max(t)));
            // The centroid of the blade is nearer to its broader end.
            let way = if high > -low { way } else { -way };
            axes[0] * way.x + axes[1] * way.y
        }
    };
    let y = (y - z * y.dot(z)).try_normalize()?;
    Some(Plane { origin: centre, x: y.cross(z), y, z })
}

/// Returns the direction along a blade: among the directions in which its length is nearly the greatest, the one about
/// which its two sides are most alike. A long blade leaves no choice; for a round one the longest direction is random.
fn mirror_line(flat: &[DVec2]) -> DVec2 {
    let lift = |p: &DVec2| p.extend(0.0);
    let tree = KdTree::new(&flat.iter().map(lift).collect::<Vec<DVec3>>());
    let ways: Vec<(DVec2, f64)> = (0..WAYS)
        .map(|k| {
            let (sin, cos) = base::ops::sin_cos(base::ops::PI * f64::from(k) / f64::from(WAYS));
            let way = DVec2::new(cos, sin);
            let mut along: Vec<f64> = flat.iter().map(|p| p.dot(way)).collect();
            base::sort_numbers(&mut along);
            // One in a hundred at either end may be ragged.
            let cut = along.len() / 100;
            (way, along[along.len() - 1 - cut] - along[cut])
        })
        .collect();
    let longest = ways.iter().map(|w| w.1).fold(0.0, f64::max);
    let unlike = |way: DVec2| {
        let other = |p: &DVec2| 2.0 * p.dot(way) * way - *p;
        let gap = |p: DVec2| Some(flat[tree.nearest(p.extend(0.0), f64::INFINITY)?].distance(p));
        flat.iter().filter_map(|p| gap(other(p))).sum::<f64>()
    };
    let able = ways.iter().filter(|w| w.1 >= AS_LONG * longest).map(|w| (unlike(w.0), w.0));
    able.min_by(|a, b| a.0.total_cmp(&b.0)).map_or(DVec2::X, |w| w.1)
}

/// Fits the surface, by repeated fits that give far points less weight (Tukey's biweight).
fn surface_of(flat: &[DVec3], spacing: f64, smoothing: f64) -> Result<HeightField, SplineError> {
    let size = |axis: fn(&DVec3) -> f64| {
        let (lo, hi) =
            flat.iter().map(axis).fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
        hi - lo
    };
    let (wide, long) = (size(|p| p.x), size(|p| p.y));
    // A control every four points' distances, at most 18 per side: folds of a centimetre on a leaf of a hand's length.
    let step = (wide.max(long) / 15.0).max(4.0 * spacing);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped before the cast")]
    let count = |x: f64| ((x / step).ceil().clamp(1.0, 15.0) as usize) + 3;
    let controls = [count(wide), count(long)];
    let mut weights = vec![1.0; flat.len()];
    let mut field = HeightField::fit(flat, &weights, controls, smoothing)?;
    for _ in 0..4 {
        let off: Vec<f64> = flat.iter().map(|p| (p.z - field.height(p.x, p.y).0).abs()).collect();
        let mut sorted = off.clone();
        base::sort_numbers(&mut sorted);
        // 4.685 deviations, the deviation estimated from the median (Huber 1981); not below rounding.
        let scale = (4.685 * 1.4826 * sorted[sorted.len() / 2]).max(1e-9);
        for (w, d) in weights.iter_mut().zip(&off) {
            let x = d / scale;
            *w = if x < 1.0 { (1.0 - x * x) * (1.0 - x * x) } else { 0.0 };
        }
        field = HeightField::fit(flat, &weights, controls, smoothing)?;
    }
    Ok(field)
}

/// Fits the stalk's centre line by distance from its junction, with its mean radius.
fn stalk_curve(stem: &[DVec3], base: DVec3) -> Option<BallBSpline> {
    let far = stem.iter().map(|p| p.distance(base)).fold(0.0, f64::max);
    let bins = 10;
    let mut sums = vec![(DVec3::ZERO, 0.0); bins];
    let bin = |p: DVec3| {
        let k = (p.distance(base) / far * bins as f64).floor();
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "clamped before the cast"
        )]
        let k = k.clamp(0.0, (bins - 1) as f64) as usize;
        k
    };
    if stem.is_empty() || far <= 0.0 {
        return None;
    }
    for &p in stem {
        let sum = &mut sums[bin(p)];
        sum.0 += p;
        sum.1 += 1.0;
    }
    let mut line = vec![base];
    line.extend(sums.iter().filter(|s| s.1 > 0.0).map(|s| s.0 / s.1));
    let off = |p: DVec3| {
        let d = |w: &[DVec3]| segment_distance(p, w[0], w[1]);
        line.windows(2).map(d).fold(f64::INFINITY, f64::min)
    };
    let mut radii: Vec<f64> = stem.iter().map(|&p| off(p)).collect();
    base::sort_numbers(&mut radii);
    // The scanner sees the near half: its points lie about a radius from their mean line, outliers farther.
    let radius = radii[radii.len() / 2].max(1e-6);
    let balls: Vec<Ball> = line.iter().map(|&p| Ball::new(p, radius)).collect();
    BallBSpline::interpolate(&balls).ok()
}

/// Makes twelve rows of seven marks, from the tip down, right to left.
fn marks_of(grid: &[DVec3], columns: usize, stalk: Option<&BallBSpline>) -> Marks {
    let rows = grid.len() / columns;
    let count = 12.min(rows - 1);
    let at = |k: usize| {
        // Row 1 is next to the tip, the last is the base.
        let i = (rows - 1) * (count - 1 - k) / count;
        let row = &grid[i * columns..(i + 1) * columns];
        let points = core::array::from_fn(|j| row[(MARKS_A_ROW - 1 - j) * (columns - 1) / (MARKS_A_ROW - 1)]);
        MarkRow { points, ..MarkRow::default() }
    };
    let mut marks = Marks { rows: (0..count).map(at).collect(), ..Marks::default() };
    marks.tip = grid[(rows - 1) * columns + columns / 2];
    let length = marks.length();
    let base = stalk.map_or(0.012 * length, |s| 2.0 * s.ball(0.0).radius);
    if let Some(last) = marks.rows.last_mut() {
        last.midrib = Some(base);
    }
    if let Some(first) = marks.rows.first_mut() {
        first.midrib = Some(0.25 * base);
    }
    marks
}

base::coded!(ScanError {
    Self::TooFew(points) => "scan-too-few" { points },
    Self::TooMany(points, most) => "scan-too-many" { points, most },
    Self::Spline(why) => "scan-surface" { why => SplineError },
} wraps {
    Self::Cancelled(e) => e, base::Cancelled;
});
