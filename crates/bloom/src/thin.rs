//! Thins many points to few, evenly spread ones.

use geom::{cubes, extent};
use glam::DVec3;

/// Returns the indices of at most about `wanted` points, one per cube, so that a dense part weighs no more than a
/// sparse one.
///
/// In each cube the point nearest to the mean of the cube's points is kept. All finite points if they are few.
pub(crate) fn thin(points: &[DVec3], wanted: usize) -> Vec<u32> {
    let size = extent(points);
    if size <= 0.0 || points.iter().filter(|p| p.is_finite()).count() <= wanted {
        #[expect(clippy::cast_possible_truncation, reason = "indices are below 2^32 points")]
        return (0..points.len()).filter(|&i| points[i].is_finite()).map(|i| i as u32).collect();
    }
    // The search needs counts only: on at most 50,000 points it is fast, and such a sample fills the cubes.
    let sample: Vec<DVec3> = points.iter().copied().step_by(points.len().div_ceil(50_000)).collect();
    let (mut low, mut high) = (size / 4096.0, size);
    for _ in 0..24 {
        let middle = (low * high).sqrt();
        if count(&cubes(&sample, middle)) > wanted { low = middle } else { high = middle }
    }
    geom::one_a_cube(points, high)
}

fn count(keyed: &[([i32; 3], u32)]) -> usize {
    keyed.chunk_by(|a, b| a.0 == b.0).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dense_half_weighs_no_more_than_a_sparse_one() {
        let mut s = base::Seed::new(1).stream(base::Draw::Test);
        let mut points: Vec<DVec3> = (0..20_000).map(|_| DVec3::new(s.uniform(), s.uniform(), 0.0)).collect();
        points.extend((0..2_000).map(|_| DVec3::new(1.0 + s.uniform(), s.uniform(), 0.0)));
        let kept = thin(&points, 400);
        let right = kept.iter().filter(|&&i| points[i as usize].x > 1.0).count();
        assert!((200..=480).contains(&kept.len()), "{}", kept.len());
        assert!(right * 5 > kept.len() * 2, "{right} of {}", kept.len());
        assert_eq!(
            thin(&[DVec3::NAN, DVec3::ONE, DVec3::ONE], 1).len(),
            2,
            "points at one place are all kept"
        );
    }
}
