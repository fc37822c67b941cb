//! Registers the first and last shape of an organ: finds the lattice that carries one into the other.

use base::Run;
use geom::{KdTree, best_rotation, solve_positive};
use glam::{DQuat, DVec3};

use crate::thin::thin;
use crate::{BloomError, Lattice, Obb, ScanOrgan, ShapeError, Weights, compare};

/// Settings of the registration of two shapes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RegisterSpec {
    /// Control points of the lattice along the three axes of the first shape's box, each 2 to 16. Default 4 x 4 x 4.
    pub counts: [usize; 3],
    /// Least edge of the box as a share of the longest, 0 to 1. Default 0.05.
    pub floor: f64,
    /// Final weight of smoothness against nearness, above 0. Default 0.002; more is stiffer.
    pub smoothness: f64,
    /// Rounds of nearest points and lattice fit, 1 to 200. Default 40.
    pub rounds: usize,
    /// Points of each shape that take part, spread evenly. Default 1500.
    pub sample: usize,
}

impl Default for RegisterSpec {
    fn default() -> Self {
        Self { counts: [4, 4, 4], floor: 0.05, smoothness: 0.002, rounds: 40, sample: 1500 }
    }
}

/// The motion of an organ from its first to its last shape.
#[derive(Clone, Debug)]
pub struct Registration {
    /// The box of the first shape.
    pub obb: Obb,
    /// The undeformed lattice of the first shape, P0.
    pub first: Lattice,
    /// The lattice whose deformation of the first shape is the last one, P1.
    pub last: Lattice,
    /// Joint of the organ on its bearer, in the first shape.
    pub first_base: DVec3,
    /// The same in the last shape.
    pub last_base: DVec3,
    /// The rotation of the organ about its base.
    pub turn: DQuat,
    /// Uniform growth about the base, 1 for none.
    pub scale: f64,
    /// Residual between the deformed first and the last shape.
    pub residual: ShapeError,
}

/// Registers two shapes of one organ that share no vertices.
///
/// Rigid at the base: the first shape is turned and scaled about its base so that the two overlap best (eight starts,
/// then iterated nearest points). Then `P1 = argmin |B P - X|^2 + mu |L P|^2`, with `X` the nearest points in both
/// directions, B the Bernstein matrix and L second differences, from stiff to soft. Guaranteed: the same result for any
/// thread count. Not guaranteed: that corresponding parts meet if a shape has no features; the residual measures only
/// the surfaces. Cost: about a fifth of a second for a 4 x 4 x 4 lattice.
///
/// # Errors
/// [`BloomError::TooFew`] below 8 finite points, [`BloomError::Lattice`], [`BloomError::Cancelled`].
pub fn register(
    first: &[DVec3],
    first_base: DVec3,
    last: &[DVec3],
    last_base: DVec3,
    spec: &RegisterSpec,
    run: &Run<'_>,
) -> Result<Registration, BloomError> {
    are_enough([("the first shape", first), ("the last shape", last)])?;
    let pick = |points: &[DVec3]| -> Vec<DVec3> {
        thin(points, spec.sample.max(8)).into_iter().map(|i| points[i as usize]).collect()
    };
    let (from, to) = (pick(first), pick(last));
    let rigid = align(&from, first_base, &to, last_base, run)?;
    let partners = Partners::Nearest(&to);
    fitted((first, last), &from, partners, rigid, spec, run)
}

/// As [`register`], for two organs, of which the first may have been moved: points and base are its current ones.
///
/// Models with the same triangles share their vertices: corresponding points are known, and need no search.
pub(crate) fn register_organ(
    organ: &ScanOrgan,
    (points, base): (&[DVec3], DVec3),
    next: &ScanOrgan,
    spec: &RegisterSpec,
    run: &Run<'_>,
) -> Result<Registration, BloomError> {
    if !organ.shares_vertices(next) {
        return register(points, base, &next.points, next.base, spec, run);
    }
    are_enough([("the first shape", points), ("the last shape", &next.points)])?;
    let rows = thin(points, spec.sample.max(8)).into_iter().map(|i| i as usize);
    let rows = rows.filter(|&i| next.points[i].is_finite());
    let (from, to): (Vec<DVec3>, Vec<DVec3>) = rows.map(|i| (points[i], next.points[i])).unzip();
    are_enough([("what both shapes have", &from)])?;
    let middle = |points: &[DVec3]| points.iter().sum::<DVec3>() / points.len() as f64;
    let (a, b) = (middle(&from), middle(&to));
    let pairs: Vec<(DVec3, DVec3)> = from.iter().zip(&to).map(|(p, q)| (*p - a, *q - b)).collect();
    let moved = Rigid { from: a, to: b, turn: DQuat::IDENTITY, scale: 1.0, rod: rod(&pairs) }.nearest(&pairs);
    // The base of each by itself is its lowest point, which need not be the same vertex.
    let rigid = Rigid { from: base, to: moved.apply(base), ..moved };
    fitted((points, &next.points), &from, Partners::Known(&to), rigid, spec, run)
}

/// Checks that both shapes have enough finite points for a fit.
fn are_enough<const N: usize>(shapes: [(&str, &[DVec3]); N]) -> Result<(), BloomError> {
    for (what, points) in shapes {
        let is = points.iter().filter(|p| p.is_finite()).count();
        if is < FEWEST_POINTS {
            return Err(BloomError::TooFew { what: what.to_owned(), is, wanted: FEWEST_POINTS });
        }
    }
    Ok(())
}

/// Least number of points of a shape for a registration.
const FEWEST_POINTS: usize = 8;

/// Partners in the last shape of the points of the first.
#[derive(Clone, Copy)]
enum Partners<'a> {
    /// The nearest of these, in both directions.
    Nearest(&'a [DVec3]),
    /// These, one per point.
    Known(&'a [DVec3]),
}

/// Fits the lattice after the rigid part, and returns the residual of both.
fn fitted(
    (first, last): (&[DVec3], &[DVec3]),
    from: &[DVec3],
    partners: Partners<'_>,
    rigid: Rigid,
    spec: &RegisterSpec,
    run: &Run<'_>,
) -> Result<Registration, BloomError> {
    let obb = Obb::fit(first, spec.floor).ok_or_else(|| BloomError::TooFew {
        what: "the first shape".into(),
        is: 0,
        wanted: FEWEST_POINTS,
    })?;
    let rest = Lattice::from_box(&obb, spec.counts)?;
    let mut start = rest.clone();
    start.points.iter_mut().for_each(|p| *p = rigid.apply(*p));
    let lattice = fit_lattice(from, partners, &obb, start, spec, run)?;
    let weights = Weights::new(&obb, spec.counts, first)?;
    let residual = compare(last, &weights.apply(&lattice, run)?, run)?;
    Ok(Registration {
        obb,
        first: rest,
        last: lattice,
        first_base: rigid.from,
        last_base: rigid.to,
        turn: rigid.turn,
        scale: rigid.scale,
        residual,
    })
}

/// Penalties on the rotation of an organ between two scans in the comparison of starts.
struct TurnPrice {
    /// Share of the mismatch per radian: an organ seldom turns far between two scans, so of two equal fits the smaller
    /// rotation wins.
    each: f64,
    /// Angle, radians, beyond which an organ is rolled over: its upper side faces down.
    rolled: f64,
    /// Ratio by which a shape that is rolled over must fit better. A petal that opens reverses its bend, and so fits
    /// better rolled over than as it grew, by a factor of up to 3; a shape that really was rolled over fits without any
    /// mismatch.
    rolled_over: f64,
}

const TURN_PRICE: TurnPrice = TurnPrice { each: 0.35, rolled: 2.1, rolled_over: 5.0 };

impl TurnPrice {
    fn factor(&self, angle: f64) -> f64 {
        (1.0 + self.each * angle) * if angle > self.rolled { self.rolled_over } else { 1.0 }
    }
}

/// Rotation and growth about the base.
#[derive(Clone, Copy, Debug)]
struct Rigid {
    from: DVec3,
    to: DVec3,
    turn: DQuat,
    scale: f64,
    /// Direction of a rod, which does not roll, as that is not observable.
    rod: Option<DVec3>,
}

/// Ratio of the second to the first spread of its points below which an organ is a rod.
const ROD: f64 = 0.2;

/// Returns the spread of the points across their longest direction as a share of that along it.
fn slimness(points: &[DVec3]) -> f64 {
    geom::pca3(points).map_or(1.0, |(_, _, [first, second, _])| (second.max(0.0) / first.max(1e-300)).sqrt())
}

/// Returns the direction of an organ that is a rod before and after.
pub(crate) fn rod(pairs: &[(DVec3, DVec3)]) -> Option<DVec3> {
    let before: Vec<DVec3> = pairs.iter().map(|p| p.0).collect();
    let after: Vec<DVec3> = pairs.iter().map(|p| p.1).collect();
    let thin = slimness(&before) < ROD && slimness(&after) < ROD;
    thin.then(|| geom::pca3(&before)).flatten().map(|(_, axes, _)| axes[0])
}

impl Rigid {
    /// Returns the rotation and growth that bring points nearest to their partners, both from their base.
    fn nearest(&self, pairs: &[(DVec3, DVec3)]) -> Self {
        let turn = best_rotation(pairs.iter().copied());
        let turn = match self.rod {
            Some(a) => base::turn::between(a, (turn * a).normalize_or(a)),
            None => turn,
        };
        let dot: f64 = pairs.iter().map(|(a, b)| (turn * *a).dot(*b)).sum();
        let square: f64 = pairs.iter().map(|(a, _)| a.length_squared()).sum();
        let scale = dot / square;
        let scale = if scale.is_finite() && scale > 0.0 { scale } else { self.scale };
        Self { turn, scale, ..*self }
    }

    fn apply(&self, p: DVec3) -> DVec3 {
        self.to + self.turn * (p - self.from) * self.scale
    }
}

fn align(
    from: &[DVec3],
    from_base: DVec3,
    to: &[DVec3],
    to_base: DVec3,
    run: &Run<'_>,
) -> Result<Rigid, BloomError> {
    let reach = |points: &[DVec3], base: DVec3| {
        (points.iter().map(|p| p.distance_squared(base)).sum::<f64>() / points.len() as f64).sqrt()
    };
    let scale = reach(to, to_base) / reach(from, from_base).max(1e-12);
    let scale = if scale.is_finite() && scale > 0.0 { scale } else { 1.0 };
    let few = |points: &[DVec3]| -> Vec<DVec3> {
        thin(points, 400).into_iter().map(|i| points[i as usize]).collect()
    };
    let (small_from, small_to) = (few(from), few(to));
    let grid = KdTree::new(&small_to);
    let along = |points: &[DVec3], base: DVec3| {
        points.iter().map(|&p| p - base).sum::<DVec3>().try_normalize().unwrap_or(DVec3::Y)
    };
    let (a, b) = (along(from, from_base), along(to, to_base));
    // The least rotation of one direction onto the other, then rolls about it: the direction of a petal alone does not
    // determine its upper side.
    let least = base::turn::between(a, b);
    let rod = (slimness(from) < ROD && slimness(to) < ROD).then_some(a);
    let mut best: Option<(f64, Rigid)> = None;
    for k in 0..if rod.is_some() { 1 } else { 8 } {
        let roll = base::turn::about(b, base::ops::TAU * f64::from(k) / 8.0);
        let mut rigid = Rigid { from: from_base, to: to_base, turn: roll * least, scale, rod };
        for _ in 0..12 {
            run.cancel.check()?;
            rigid = improved(&rigid, &small_from, &small_to, &grid);
        }
        let score = mismatch(&rigid, &small_from, &small_to, &grid);
        let score = score * TURN_PRICE.factor(2.0 * base::ops::acos_clamped(rigid.turn.w.abs()));
        if best.as_ref().is_none_or(|(s, _)| score < *s) {
            best = Some((score, rigid));
        }
    }
    let start = Rigid { from: from_base, to: to_base, turn: least, scale, rod };
    let mut rigid = best.map_or(start, |(_, r)| r);
    let grid = KdTree::new(to);
    for _ in 0..10 {
        run.cancel.check()?;
        rigid = improved(&rigid, from, to, &grid);
    }
    Ok(rigid)
}

fn improved(rigid: &Rigid, from: &[DVec3], to: &[DVec3], grid: &KdTree) -> Rigid {
    let moved: Vec<DVec3> = from.iter().map(|&p| rigid.apply(p)).collect();
    let mut pairs: Vec<(DVec3, DVec3)> = Vec::with_capacity(from.len() + to.len());
    for (p, m) in from.iter().zip(&moved) {
        if let Some(k) = grid.nearest(*m, f64::INFINITY) {
            pairs.push((*p - rigid.from, to[k] - rigid.to));
        }
    }
    let back = KdTree::new(&moved);
    for q in to {
        if let Some(k) = back.nearest(*q, f64::INFINITY) {
            pairs.push((from[k] - rigid.from, *q - rigid.to));
        }
    }
    rigid.nearest(&pairs)
}

fn mismatch(rigid: &Rigid, from: &[DVec3], to: &[DVec3], grid: &KdTree) -> f64 {
    let moved: Vec<DVec3> = from.iter().map(|&p| rigid.apply(p)).collect();
    let back = KdTree::new(&moved);
    let there = moved.iter().filter_map(|m| Some(to[grid.nearest(*m, f64::INFINITY)?].distance(*m)));
    let here = to.iter().filter_map(|q| Some(moved[back.nearest(*q, f64::INFINITY)?].distance(*q)));
    there.sum::<f64>() / from.len() as f64 + here.sum::<f64>() / to.len() as f64
}

fn fit_lattice(
    from: &[DVec3],
    partners: Partners<'_>,
    obb: &Obb,
    start: Lattice,
    spec: &RegisterSpec,
    run: &Run<'_>,
) -> Result<Lattice, BloomError> {
    let weights = Weights::new(obb, spec.counts, from)?;
    let mut rows = Vec::with_capacity(from.len());
    let mut row = Vec::new();
    for i in 0..from.len() {
        weights.row(i, &mut row);
        rows.push(row.clone());
    }
    let n = start.points.len();
    let stiffness = stiffness(spec.counts);
    let (grid, rounds) = match partners {
        Partners::Nearest(to) => (Some(KdTree::new(to)), spec.rounds.clamp(1, 200)),
        // Nothing changes from round to round.
        Partners::Known(_) => (None, 1),
    };
    let mut lattice = start.clone();
    for round in 0..rounds {
        run.cancel.check()?;
        let share = if grid.is_none() { 1.0 } else { round as f64 / (rounds.max(2) - 1) as f64 };
        let pairs = match (partners, &grid) {
            (Partners::Nearest(to), Some(grid)) => pairs(&weights.apply(&lattice, run)?, to, grid, share),
            (Partners::Nearest(to) | Partners::Known(to), _) => {
                to.iter().enumerate().map(|(i, q)| (i, *q, 1.0)).collect()
            }
        };
        // From nearly affine to soft, evenly in the logarithm.
        let soft = spec.smoothness.max(1e-9);
        let mu = soft * base::ops::powf(50.0 / soft.min(50.0), 1.0 - share);
        let mut a = vec![0.0; n * n];
        let mut b = vec![DVec3::ZERO; n];
        for &(i, q, w) in &pairs {
            let r = &rows[i];
            let gap = q - start_at(r, &start);
            for (j, &x) in r.iter().enumerate() {
                let x = x * w;
                b[j] += gap * x;
                for (c, &y) in a[j * n..].iter_mut().zip(&r[..=j]) {
                    *c += x * y;
                }
            }
        }
        let total: f64 = pairs.iter().map(|p| p.2).sum();
        let mu = mu * total / n as f64;
        for (c, s) in a.iter_mut().zip(&stiffness) {
            *c += mu * s;
        }
        // Control points without data stay where the rigid motion put them.
        for j in 0..n {
            a[j * n + j] += 1e-6 * total / n as f64;
        }
        if solve_positive(&mut a, &mut b).is_none() {
            break;
        }
        for ((p, s), d) in lattice.points.iter_mut().zip(&start.points).zip(&b) {
            *p = *s + *d;
        }
    }
    Ok(lattice)
}

fn start_at(row: &[f64], start: &Lattice) -> DVec3 {
    row.iter().zip(&start.points).map(|(w, p)| *p * *w).sum()
}

/// Returns nearest points in both directions: row of the first shape, position in the last one, weight. Far pairs weigh
/// less: they are holes of a scan (Geman and Mc Clure's weight). Its width falls from 30 times the median to 4 times:
/// at first a far pair is growth that is still to be followed.
fn pairs(moved: &[DVec3], to: &[DVec3], grid: &KdTree, share: f64) -> Vec<(usize, DVec3, f64)> {
    let back = KdTree::new(moved);
    let there = moved.iter().enumerate().filter_map(|(i, m)| Some((i, to[grid.nearest(*m, f64::INFINITY)?])));
    let here = to.iter().filter_map(|q| Some((back.nearest(*q, f64::INFINITY)?, *q)));
    let mut out: Vec<(usize, DVec3, f64)> =
        there.chain(here).map(|(i, q)| (i, q, moved[i].distance(q))).collect();
    let mut gaps: Vec<f64> = out.iter().map(|p| p.2).collect();
    base::sort_numbers(&mut gaps);
    let width = (4.0 + 26.0 * (1.0 - share)) * gaps.get(gaps.len() / 2).copied().unwrap_or(1.0).max(1e-12);
    for p in &mut out {
        let r = p.2 / width;
        p.2 = 1.0 / ((1.0 + r * r) * (1.0 + r * r));
    }
    out
}

/// Returns L^T L of the second differences along the three axes (which leave affine maps free), and a small share of
/// the first ones, so that two control points along an axis do not diverge.
fn stiffness(counts: [usize; 3]) -> Vec<f64> {
    let [_, m, n] = counts;
    let total: usize = counts.iter().product();
    let mut s = vec![0.0; total * total];
    let strides = [m * n, n, 1];
    let mut add = |terms: &[(usize, f64)], weight: f64| {
        for &(i, a) in terms {
            for &(j, b) in terms {
                s[i * total + j] += weight * a * b;
            }
        }
    };
    for row in 0..total {
        let at = [row / (m * n), row / n % m, row % n];
        for axis in 0..3 {
            let step = strides[axis];
            if at[axis] + 2 < counts[axis] {
                add(&[(row, 1.0), (row + step, -2.0), (row + 2 * step, 1.0)], 1.0);
            }
            if at[axis] + 1 < counts[axis] {
                add(&[(row, 1.0), (row + step, -1.0)], 1e-3);
                // Mixed differences: they penalise the shear of a cell against its neighbour.
                for other in axis + 1..3 {
                    if at[other] + 1 < counts[other] {
                        let o = strides[other];
                        add(&[(row, 1.0), (row + step, -1.0), (row + o, -1.0), (row + step + o, 1.0)], 0.5);
                    }
                }
            }
        }
    }
    s
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::ops;
    use std::sync::Arc;

    /// Makes a petal of 60 mm, sampled at points that depend on `seed`.
    fn petal(seed: u64, n: usize) -> Vec<DVec3> {
        let mut s = base::Seed::new(seed).stream(base::Draw::Test);
        (0..n)
            .map(|_| {
                let (v, u) = (s.uniform(), s.range(-1.0, 1.0));
                let half = 0.02 * ops::sin(ops::PI * ops::powf(v, 0.7)) + 0.001;
                DVec3::new(u * half, 0.06 * v, 0.008 * u * u + 0.01 * v * v)
            })
            .collect()
    }

    fn opened(p: DVec3) -> DVec3 {
        // Bent outwards along its length, wider and longer.
        let angle = 9.0 * p.y;
        let (s, c) = ops::sin_cos(angle);
        DVec3::new(1.25 * p.x, 1.2 * (p.y * c - p.z * s), 1.2 * (p.y * s + p.z * c))
            + DVec3::new(0.1, 0.2, 0.3)
    }

    #[test]
    fn an_opened_petal_is_met_without_shared_vertices() {
        let first = petal(1, 1500);
        let last: Vec<DVec3> = petal(2, 2000).into_iter().map(opened).collect();
        let r = register(
            &first,
            DVec3::ZERO,
            &last,
            opened(DVec3::ZERO),
            &RegisterSpec::default(),
            &Run::plain(),
        )
        .unwrap();
        // The truth itself is not nearer than the spacing of the samples.
        let truth: Vec<DVec3> = first.iter().map(|p| opened(*p)).collect();
        let floor = compare(&last, &truth, &Run::plain()).unwrap();
        assert!(r.residual.to_model.mean < 1.4 * floor.to_model.mean, "{:?} {floor:?}", r.residual);
        assert!(r.residual.to_scan.mean < 1.4 * floor.to_scan.mean, "{:?} {floor:?}", r.residual);
        // Corresponding parts meet, not only surfaces: the true positions of the points are known here.
        let weights = Weights::new(&r.obb, [4, 4, 4], &first).unwrap();
        let moved = weights.apply(&r.last, &Run::plain()).unwrap();
        let off: f64 =
            moved.iter().zip(&first).map(|(m, p)| m.distance(opened(*p))).sum::<f64>() / first.len() as f64;
        assert!(off < 0.0055, "mean distance from the true place: {off}");
    }

    #[test]
    fn a_turned_copy_is_met_exactly_by_the_rigid_part() {
        let first = petal(3, 600);
        let q = base::turn::about(DVec3::new(0.0, 0.6, 0.8), 0.5);
        let last: Vec<DVec3> = first.iter().map(|p| q * *p * 1.3 + DVec3::X).collect();
        let r =
            register(&first, DVec3::ZERO, &last, DVec3::X, &RegisterSpec::default(), &Run::plain()).unwrap();
        assert!(r.turn.dot(q).abs() > 1.0 - 1e-4, "{:?} {q:?}", r.turn);
        assert!((r.scale - 1.3).abs() < 0.01, "{}", r.scale);
        assert!(r.residual.to_model.mean < 3e-4, "{:?}", r.residual);
    }

    /// Makes a petal bent along its length by `bend` (in total, radians), its margins raised by `cup`, and leaning by
    /// `lean`; nearly its own mirror image.
    fn bent(seed: u64, [bend, cup, lean]: [f64; 3]) -> Vec<DVec3> {
        let mut s = base::Seed::new(seed).stream(base::Draw::Test);
        (0..1200)
            .map(|_| {
                let (v, u) = (s.uniform(), s.range(-1.0, 1.0));
                let half = 0.02 * ops::sin(ops::PI * ops::powf(v, 0.8)) + 0.001;
                let (sin, cos) = ops::sin_cos(v * bend);
                let (radius, raised) = (0.06 / bend, cup * u * u);
                let (y, z) = (radius * sin - raised * sin, radius * (1.0 - cos) + raised * cos);
                let (sin, cos) = ops::sin_cos(lean);
                DVec3::new(u * half + 0.0012 * v * v, y * cos - z * sin, y * sin + z * cos)
            })
            .collect()
    }

    #[test]
    fn a_nearly_symmetric_petal_that_opens_is_not_rolled_over() {
        let (mut rolled, mut all) = (0, 0);
        for (k, bend) in [-1.3, -0.9, -0.5, -0.15].into_iter().enumerate() {
            for (j, opened) in [0.15, 0.5, 0.9, 1.3].into_iter().enumerate() {
                for cup in [0.002, -0.004] {
                    let first = bent(40 + k as u64, [bend, 0.006, 0.0]);
                    let last: Vec<DVec3> =
                        bent(80 + j as u64, [opened, cup, 0.7]).into_iter().map(|p| p * 1.2).collect();
                    let spec = RegisterSpec { sample: 500, rounds: 5, ..RegisterSpec::default() };
                    let r = register(&first, DVec3::ZERO, &last, DVec3::ZERO, &spec, &Run::plain()).unwrap();
                    // The left margin stays on the left.
                    all += 1;
                    rolled += usize::from((r.turn * DVec3::X).x < 0.0);
                }
            }
        }
        println!("{rolled} of {all} rolled over");
        assert_eq!(rolled, 0, "of {all}");
        // One that was scanned upside down is matched all the same.
        let first = bent(7, [0.8, 0.006, 0.0]);
        let over = base::turn::about(DVec3::Y, ops::PI);
        let last: Vec<DVec3> = first.iter().map(|p| over * *p * 1.1).collect();
        let r = register(&first, DVec3::ZERO, &last, DVec3::ZERO, &RegisterSpec::default(), &Run::plain());
        let turn = r.unwrap().turn;
        assert!(turn.dot(over).abs() > 0.999, "{turn:?}");
    }

    #[test]
    fn models_of_the_same_vertices_are_matched_by_them() {
        // The shape of a round disc does not show its rotation in its plane; its vertices do.
        let mut points = vec![DVec3::ZERO];
        let mut faces = Vec::new();
        for ring in 1..=6_u32 {
            for k in 0..24_u32 {
                let (sin, cos) = ops::sin_cos(ops::TAU * f64::from(k) / 24.0);
                points.push(DVec3::new(cos, 0.0, sin) * (0.01 * f64::from(ring)));
                faces.push([0, 24 * (ring - 1) + k + 1, 1 + (k + 1) % 24]);
            }
        }
        let quarter = base::turn::about(DVec3::Y, 1.5);
        let organ = |points: Vec<DVec3>| ScanOrgan {
            name: "disc".into(),
            rows: (0..points.len()).collect(),
            way: vec![0.5; points.len()],
            faces: faces.clone().into(),
            points,
            ..ScanOrgan::default()
        };
        let cupped = |p: &DVec3| quarter * *p * 1.3 + DVec3::Y * (2.0 * p.length_squared());
        let (first, last) = (organ(points.clone()), organ(points.iter().map(cupped).collect()));
        let spec = RegisterSpec::default();
        let run = Run::plain();
        let place = (&first.points[..], DVec3::ZERO);
        let r = register_organ(&first, place, &last, &spec, &run).unwrap();
        assert!(r.turn.dot(quarter).abs() > 0.999, "{:?}", r.turn);
        let weights = Weights::new(&r.obb, spec.counts, &first.points).unwrap();
        let moved = weights.apply(&r.last, &run).unwrap();
        let off = moved.iter().zip(&last.points).map(|(m, q)| m.distance(*q)).fold(0.0, f64::max);
        assert!(off < 5e-4, "{off}: the lattice bends as a square does");
        // With other triangles they are two scans.
        let other = ScanOrgan { faces: Arc::from([[0, 1, 2]]), ..last };
        let r = register_organ(&first, place, &other, &spec, &run).unwrap();
        assert!(r.turn.dot(quarter).abs() < 0.999, "{:?}", r.turn);
    }

    #[test]
    fn too_few_points_are_an_error() {
        let e = register(
            &[DVec3::ZERO; 3],
            DVec3::ZERO,
            &petal(1, 50),
            DVec3::ZERO,
            &RegisterSpec::default(),
            &Run::plain(),
        );
        assert!(matches!(e, Err(BloomError::TooFew { is: 3, .. })), "{e:?}");
    }
}
