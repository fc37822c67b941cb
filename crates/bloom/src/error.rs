//! Distances between two shapes without shared vertices.

use base::{Run, map_indexed, map_until_cancelled};
use geom::KdTree;
use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::BloomError;

/// Distances from the points of one shape to the nearest points of another, metres.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Distances {
    /// The error as Huai, Yang and Cai (2019) define it: the mean over x, y and z of the absolute difference. Up to
    /// root 3 below the Euclidean mean.
    pub paper: f64,
    /// Mean Euclidean distance.
    pub mean: f64,
    /// Root mean square distance.
    pub rms: f64,
    /// 95th percentile of the distances.
    pub p95: f64,
    /// Greatest distance.
    pub max: f64,
    /// Number of measured points.
    pub points: usize,
}

/// Distances in both directions, and the share of the measured shape that is covered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ShapeError {
    /// Distances from each measured point to the reconstruction: the error that the paper states.
    pub to_model: Distances,
    /// Distances from each reconstructed point to the measurement: these show parts of the model that do not exist.
    pub to_scan: Distances,
    /// Share of measured points nearer than [`ShapeError::TOLERANCE`] to the reconstruction, 0 to 1.
    pub coverage: f64,
}

impl ShapeError {
    /// Distance within which a measured point counts as covered: the 2 mm of Huai, Yang and Cai (2019).
    pub const TOLERANCE: f64 = 0.002;
}

/// Compares a measured with a reconstructed shape, point to nearest point.
///
/// Points that are not finite are left out. The distances include the spacing of the points: a resampled shape is not
/// at distance 0 from itself. Cost: n log n, wherever the two shapes lie.
///
/// # Errors
/// [`BloomError::TooFew`] if a shape has no finite point, [`BloomError::Cancelled`].
///
/// ```
/// use glam::DVec3;
/// let measured = [DVec3::ZERO, DVec3::X];
/// let moved = measured.map(|p| p + DVec3::new(0.003, 0.0, 0.004));
/// let e = bloom::compare(&measured, &moved, &base::Run::plain())?;
/// assert!((e.to_model.mean - 0.005).abs() < 1e-12);
/// assert!((e.to_model.paper - 0.007 / 3.0).abs() < 1e-12);
/// # Ok::<(), bloom::BloomError>(())
/// ```
pub fn compare(measured: &[DVec3], model: &[DVec3], run: &Run<'_>) -> Result<ShapeError, BloomError> {
    run.cancel.check()?;
    let sides = [measured, model];
    let trees = map_indexed(run.executor, 2, |k| KdTree::new(sides[k]));
    let (to_model, coverage) = one_way((measured, &trees[0]), (model, &trees[1]), "the model", run)?;
    let (to_scan, _) = one_way((model, &trees[1]), (measured, &trees[0]), "the scan", run)?;
    Ok(ShapeError { to_model, to_scan, coverage })
}

type Side<'a> = (&'a [DVec3], &'a KdTree);

fn one_way(
    (from, places): Side<'_>,
    (to, tree): Side<'_>,
    what: &str,
    run: &Run<'_>,
) -> Result<(Distances, f64), BloomError> {
    run.cancel.check()?;
    // Neighbours that follow one another traverse the same part of the tree.
    let order: Vec<usize> = places.order().collect();
    let pieces: Vec<&[usize]> = order.chunks(4096).collect();
    let rows = map_until_cancelled(run, pieces.len(), |k| {
        let near = |&i: &usize| tree.nearest(from[i], f64::INFINITY).map(|k| (to[k] - from[i]).abs());
        pieces[k].iter().map(near).collect::<Vec<Option<DVec3>>>()
    })?;
    let mut found = vec![None; from.len()];
    order.iter().zip(rows.into_iter().flatten()).for_each(|(&i, gap)| found[i] = gap);
    let gaps: Vec<DVec3> = found.into_iter().flatten().collect();
    if gaps.is_empty() {
        return Err(BloomError::TooFew { what: what.to_owned(), is: 0, wanted: 1 });
    }
    let n = gaps.len() as f64;
    let mut lengths: Vec<f64> = gaps.iter().map(|d| d.length()).collect();
    let met = lengths.iter().filter(|&&d| d <= ShapeError::TOLERANCE).count() as f64 / n;
    let paper = gaps.iter().map(|d| d.x + d.y + d.z).sum::<f64>() / (3.0 * n);
    let mean = lengths.iter().sum::<f64>() / n;
    let rms = (lengths.iter().map(|d| d * d).sum::<f64>() / n).sqrt();
    base::sort_numbers(&mut lengths);
    let last = lengths.len() - 1;
    let figures = Distances {
        paper,
        mean,
        rms,
        p95: lengths[last * 95 / 100],
        max: lengths[last],
        points: lengths.len(),
    };
    Ok((figures, met))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_far_apart_and_of_different_size_take_no_longer() {
        // A search in ever larger boxes between them took minutes.
        let mut s = base::Seed::new(2).stream(base::Draw::Test);
        let small: Vec<DVec3> =
            (0..60_000).map(|_| DVec3::new(s.uniform(), s.uniform(), s.uniform())).collect();
        let large: Vec<DVec3> = small.iter().map(|p| *p * 1000.0 + DVec3::X * 5e4).collect();
        let start = std::time::Instant::now();
        let e = compare(&small, &large, &Run::plain()).unwrap();
        assert!(start.elapsed().as_secs() < 10, "{:?}", start.elapsed());
        assert!(e.to_model.mean > 49_900.0 && e.to_scan.max < 52_000.0, "{e:?}");
        let brute = large.iter().map(|q| q.distance(small[7])).fold(f64::INFINITY, f64::min);
        let alone = compare(&small[7..8], &large, &Run::plain()).unwrap();
        assert!((alone.to_model.max - brute).abs() <= 1e-9 * brute);
    }

    #[test]
    fn figures_of_a_known_shift_and_a_part_that_is_missing() {
        let grid: Vec<DVec3> =
            (0..100).map(|i| DVec3::new(f64::from(i % 10), f64::from(i / 10), 0.0)).collect();
        let shift = DVec3::new(0.001, -0.002, 0.002);
        let moved: Vec<DVec3> = grid.iter().map(|p| *p + shift).collect();
        let e = compare(&grid, &moved, &Run::plain()).unwrap();
        let (a, b) = (e.to_model, e.to_scan);
        assert!((a.mean - 0.003).abs() < 1e-9 && (a.rms - 0.003).abs() < 1e-9, "{e:?}");
        assert!((a.paper - 0.005 / 3.0).abs() < 1e-9 && (b.max - 0.003).abs() < 1e-9, "{e:?}");
        assert!(e.coverage <= 0.0, "3 mm is not met: {e:?}");
        let e = compare(&grid, &moved[..50], &Run::plain()).unwrap();
        assert!(e.to_model.max > 4.9 && e.to_scan.max < 0.004, "the missing half shows one way: {e:?}");
        assert!(compare(&grid, &[DVec3::NAN], &Run::plain()).is_err(), "nothing to compare with");
    }
}
