//! Bernstein free-form deformation of points by control points in a box (Huai, Yang and Cai 2019, eq 5).

use base::{Run, map_until_cancelled};
use glam::DVec3;

use crate::kernel::{self, LANES, Stu};
use crate::{BloomError, Obb};

/// Fewest and most control points along an axis. Above 16 the degree of the lattice exceeds any scan's detail.
const COUNTS: core::ops::RangeInclusive<usize> = 2..=kernel::MOST;

/// Control points of a lattice, in world coordinates.
///
/// `counts` control points along s, t and u give polynomials of degree `counts - 1`.
///
/// ```
/// use bloom::{Lattice, Obb, Weights};
/// use glam::DVec3;
/// let points = [DVec3::ZERO, DVec3::new(1.0, 0.5, 0.1), DVec3::new(0.3, 0.4, 0.05)];
/// let obb = Obb::fit(&points, 0.05).unwrap();
/// let mut lattice = Lattice::from_box(&obb, [4, 4, 4])?;
/// let weights = Weights::new(&obb, [4, 4, 4], &points)?;
/// lattice.points.iter_mut().for_each(|p| *p += DVec3::Y);
/// let moved = weights.apply(&lattice, &base::Run::plain())?;
/// assert!((moved[1] - points[1] - DVec3::Y).length() < 1e-12);
/// # Ok::<(), bloom::BloomError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Lattice {
    /// Control points along s, t and u, each 2 to 16.
    pub counts: [usize; 3],
    /// Row `(i * counts[1] + j) * counts[2] + k` is control point (i, j, k), metres.
    pub points: Vec<DVec3>,
}

fn check_counts(counts: [usize; 3]) -> Result<usize, BloomError> {
    if counts.iter().all(|c| COUNTS.contains(c)) {
        Ok(counts.iter().product())
    } else {
        Err(BloomError::Lattice { counts })
    }
}

impl Lattice {
    /// Makes the undeformed lattice of a box: evaluating it returns every point (linear precision).
    ///
    /// # Errors
    /// [`BloomError::Lattice`] unless each count is 2 to 16.
    pub fn from_box(obb: &Obb, counts: [usize; 3]) -> Result<Self, BloomError> {
        check_counts(counts)?;
        let points = Self::parameters(counts).map(|stu| obb.world(stu)).collect();
        Ok(Self { counts, points })
    }

    /// Returns the coordinates (s, t, u) of each control point of the undeformed lattice, in row order.
    pub fn parameters(counts: [usize; 3]) -> impl Iterator<Item = DVec3> {
        let [l, m, n] = counts;
        let share = |i: usize, n: usize| i as f64 / (n.max(2) - 1) as f64;
        (0..l * m * n)
            .map(move |row| DVec3::new(share(row / (m * n), l), share(row / n % m, m), share(row % n, n)))
    }
}

/// Coordinates of a set of points in a box, computed once and used for every frame.
///
/// Stores the coordinates, not the weights that follow from them: three numbers per point instead of one for each
/// control point, and faster, as memory is slower than the dozen operations of an axis.
#[derive(Clone, Debug)]
pub struct Weights {
    counts: [usize; 3],
    len: usize,
    /// s, t and u of eight points each; the last block is padded with zeros.
    blocks: Vec<Stu>,
}

impl Weights {
    /// Computes the coordinates of `points` in the undeformed lattice of `obb`.
    ///
    /// Points outside the box are extrapolated; points that are not finite become NaN. Cost: linear.
    ///
    /// # Errors
    /// [`BloomError::Lattice`] unless each count is 2 to 16.
    pub fn new(obb: &Obb, counts: [usize; 3], points: &[DVec3]) -> Result<Self, BloomError> {
        check_counts(counts)?;
        let blocks = points
            .chunks(LANES)
            .map(|chunk| {
                let mut block: Stu = [[0.0; LANES]; 3];
                for (lane, &p) in chunk.iter().enumerate() {
                    let local = obb.local(p).to_array();
                    block.iter_mut().zip(local).for_each(|(row, x)| row[lane] = x);
                }
                block
            })
            .collect();
        Ok(Self { counts, len: points.len(), blocks })
    }

    /// Returns the number of points.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Returns the deformed positions of all points. Cost: points times control points, spread over the threads of
    /// `run`; see `docs/bloom.md` for times.
    ///
    /// # Errors
    /// [`BloomError::Lattice`] if the lattice has other counts, [`BloomError::Cancelled`].
    pub fn apply(&self, lattice: &Lattice, run: &Run<'_>) -> Result<Vec<DVec3>, BloomError> {
        let mut out = vec![DVec3::ZERO; self.len];
        self.apply_with(lattice, &mut out, run)?;
        Ok(out)
    }

    /// As [`apply`](Self::apply), into `out`, which must have one row per point.
    ///
    /// # Errors
    /// As [`apply`](Self::apply), and [`BloomError::Length`].
    pub fn apply_with(&self, lattice: &Lattice, out: &mut [DVec3], run: &Run<'_>) -> Result<(), BloomError> {
        run.cancel.check()?;
        if lattice.counts != self.counts || lattice.points.len() != check_counts(self.counts)? {
            return Err(BloomError::Lattice { counts: lattice.counts });
        }
        if out.len() != self.len {
            return Err(BloomError::Length { what: "the deformed points", is: out.len(), wanted: self.len });
        }
        let steps = kernel::differences(self.counts, &lattice.points);
        // 1024 blocks: 0.1 ms of work, and 400 kB to read and write, a part of a core's cache.
        let pieces: Vec<_> = out
            .chunks_mut(1024 * LANES)
            .zip(self.blocks.chunks(1024))
            .map(|piece| std::sync::Mutex::new(Some(piece)))
            .collect();
        map_until_cancelled(run, pieces.len(), |i| {
            let piece = pieces[i].lock().ok().and_then(|mut p| p.take());
            if let Some((out, points)) = piece {
                kernel::deform(self.counts, &steps, points, out);
            }
        })?;
        Ok(())
    }

    /// Returns all weights of a point, one for each control point, in row order: a row of the matrix B of the fit.
    pub fn row(&self, point: usize, out: &mut Vec<f64>) {
        out.clear();
        if point >= self.len {
            return;
        }
        let (block, lane) = (&self.blocks[point / LANES], point % LANES);
        let axis = |a: usize| {
            let mut w = Vec::new();
            bernstein(self.counts[a], block[a][lane], &mut w);
            // As in the loop: the first weight is the remainder of the others.
            w[0] = 1.0 - w[1..].iter().sum::<f64>();
            w
        };
        let [s, t, u] = [0, 1, 2].map(axis);
        out.extend(
            s.iter().flat_map(|a| t.iter().map(move |b| a * b)).flat_map(|w| u.iter().map(move |c| w * c)),
        );
    }
}

/// Evaluates the `count` Bernstein polynomials of degree `count - 1` at `x`, by de Casteljau's recurrence: stable for
/// any degree.
fn bernstein(count: usize, x: f64, out: &mut Vec<f64>) {
    out.clear();
    out.push(1.0);
    for _ in 1..count {
        let mut carry = 0.0;
        for w in out.iter_mut() {
            let before = *w;
            *w = carry + before * (1.0 - x);
            carry = before * x;
        }
        out.push(carry);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::ops;
    use proptest::prelude::*;

    fn points(n: usize) -> Vec<DVec3> {
        (0..n)
            .map(|i| {
                let a = i as f64 * 0.37;
                DVec3::new(ops::cos(a) * 3.0, ops::sin(a * 1.7) + 10.0, 0.2 * ops::sin(a * 0.3))
            })
            .collect()
    }

    proptest! {
        #[test]
        fn undeformed_lattice_gives_every_point_back(l in 2..9_usize, m in 2..9_usize, n in 2..9_usize, count in 0..60_usize) {
            let points = points(count);
            let obb = Obb::fit(&points, 0.05).unwrap_or(Obb { corner: DVec3::ZERO, axes: DVec3::AXES, size: [1.0; 3] });
            let w = Weights::new(&obb, [l, m, n], &points).unwrap();
            let got = w.apply(&Lattice::from_box(&obb, [l, m, n]).unwrap(), &Run::plain()).unwrap();
            for (got, want) in got.iter().zip(&points) {
                prop_assert!((*got - *want).length() < 1e-12, "{got} {want}");
            }
        }
    }

    #[test]
    fn any_affine_map_of_the_lattice_is_that_map_of_the_points() {
        let points = points(100);
        let obb = Obb::fit(&points, 0.05).unwrap();
        let map = |p: DVec3| DVec3::new(2.0 * p.x - p.y, p.z * 3.0 + 1.0, p.x + 0.1 * p.y);
        let mut lattice = Lattice::from_box(&obb, [5, 3, 2]).unwrap();
        lattice.points.iter_mut().for_each(|p| *p = map(*p));
        let got = Weights::new(&obb, [5, 3, 2], &points).unwrap().apply(&lattice, &Run::plain()).unwrap();
        assert!(got.iter().zip(&points).all(|(g, &p)| (*g - map(p)).length() < 1e-11), "not affine");
    }

    #[test]
    fn equals_the_triple_sum_of_the_paper() {
        let points = points(37);
        let obb = Obb::fit(&points, 0.05).unwrap();
        let counts = [4, 4, 4];
        let mut lattice = Lattice::from_box(&obb, counts).unwrap();
        for (i, p) in lattice.points.iter_mut().enumerate() {
            *p += DVec3::new(ops::sin(i as f64), ops::cos(i as f64 * 2.0), ops::sin(i as f64 * 3.0));
        }
        let got = Weights::new(&obb, counts, &points).unwrap().apply(&lattice, &Run::plain()).unwrap();
        let cubic = |i: usize, x: f64| {
            let binomial = [1.0, 3.0, 3.0, 1.0][i];
            binomial * (0..i).map(|_| x).product::<f64>() * (i..3).map(|_| 1.0 - x).product::<f64>()
        };
        let mut row = Vec::new();
        let weights = Weights::new(&obb, counts, &points).unwrap();
        for (index, (&p, got)) in points.iter().zip(&got).enumerate() {
            let l = obb.local(p);
            weights.row(index, &mut row);
            let mut want = DVec3::ZERO;
            for i in 0..4 {
                for j in 0..4 {
                    for k in 0..4 {
                        let w = cubic(i, l.x) * cubic(j, l.y) * cubic(k, l.z);
                        assert!((w - row[(i * 4 + j) * 4 + k]).abs() < 1e-14, "row {index}");
                        want += lattice.points[(i * 4 + j) * 4 + k] * w;
                    }
                }
            }
            assert!((want - *got).length() < 1e-12, "{want} {got}");
        }
    }

    #[test]
    fn wrong_counts_are_refused() {
        let obb = Obb::fit(&points(9), 0.05).unwrap();
        assert!(matches!(Lattice::from_box(&obb, [1, 4, 4]), Err(BloomError::Lattice { .. })));
        assert!(matches!(Weights::new(&obb, [4, 17, 4], &[]), Err(BloomError::Lattice { .. })));
        let w = Weights::new(&obb, [2, 2, 2], &points(9)).unwrap();
        let other = Lattice::from_box(&obb, [3, 2, 2]).unwrap();
        assert!(w.apply(&other, &Run::plain()).is_err(), "other counts");
    }
}
