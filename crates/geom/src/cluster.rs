//! Groups points into clusters of unknown number.

use crate::kd::KdTree2;
use crate::vector::Vector;
use glam::DVec2;

// Flat-kernel paths settle in about 10 steps; 100 bounds a path that creeps along a ridge.
const MAX_STEPS: usize = 100;

/// Mean shift with a flat kernel: returns the cluster number of each point, numbered by first member.
///
/// Each point moves to the mean of the points within `bandwidth` until it rests; resting places closer than `bandwidth`
/// are one cluster, the most crowded first. An unusable point is a cluster of its own, as is every distinct point when
/// `bandwidth` is not positive. The result depends on nothing but the input. Cost per step: the number of pairs within
/// reach, linear for points that are spread wider than the bandwidth.
///
/// Comaniciu and Meer 2002; used by He and Cheng (2021) on petal roots.
///
/// ```
/// use glam::DVec2;
/// let roots = [DVec2::ZERO, DVec2::new(5.0, 0.0), DVec2::new(0.1, 0.0)];
/// assert_eq!(geom::mean_shift(&roots, 1.0), [0, 1, 0]);
/// ```
pub fn mean_shift(points: &[DVec2], bandwidth: f64) -> Vec<usize> {
    let reach = if bandwidth > 0.0 { bandwidth } else { 0.0 };
    let grid = KdTree2::new(points);
    let mut near = Vec::new();
    let rests: Vec<Option<(DVec2, usize)>> = points
        .iter()
        .map(|&start| start.usable().then(|| settle(points, &grid, start, reach, &mut near)))
        .collect();

    let mut order: Vec<usize> = (0..points.len()).filter(|&i| rests[i].is_some()).collect();
    base::sort_by_key(&mut order, |&i| (core::cmp::Reverse(rests[i].map_or(0, |r| r.1)), i));
    let mut modes: Vec<DVec2> = Vec::new();
    let nearest = |modes: &[DVec2], rest: DVec2| {
        let distances = modes.iter().enumerate().map(|(k, &m)| (Vector::distance(m, rest), k));
        distances.filter(|&(d, _)| d < reach || d <= 0.0).min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, k)| k)
    };
    for (rest, _) in order.into_iter().filter_map(|i| rests[i]) {
        if nearest(&modes, rest).is_none() {
            modes.push(rest);
        }
    }
    // Only now that all modes are known: otherwise equal points could go to different ones.
    let label = rests.into_iter().map(|rest| rest.and_then(|(rest, _)| nearest(&modes, rest)));

    let mut number: Vec<Option<usize>> = vec![None; modes.len()];
    let mut next = 0;
    let mut fresh = || {
        next += 1;
        next - 1
    };
    label
        .map(|mode| match mode {
            Some(m) => *number[m].get_or_insert_with(&mut fresh),
            None => fresh(),
        })
        .collect()
}

/// Returns the resting place of the walk from `start`, and the number of points within reach there.
fn settle(
    points: &[DVec2],
    grid: &KdTree2,
    start: DVec2,
    reach: f64,
    near: &mut Vec<usize>,
) -> (DVec2, usize) {
    let mut here = start;
    let mut crowd = 1;
    for _ in 0..MAX_STEPS {
        grid.within(here, reach, near);
        if near.is_empty() {
            break;
        }
        crowd = near.len();
        let offset: DVec2 = near.iter().map(|&i| points[i] - here).sum::<DVec2>() / crowd as f64;
        here += offset;
        // A thousandth of the bandwidth: below it no cluster changes.
        if offset.length() <= reach * 1e-3 {
            break;
        }
    }
    (here, crowd)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_clumps_are_three_clusters() {
        let centres = [DVec2::ZERO, DVec2::new(3.0, 0.0), DVec2::new(0.0, 4.0)];
        let points: Vec<DVec2> = (0..30_u32)
            .map(|i| centres[i as usize % 3] + base::turn::direction(f64::from(i)) * 0.3)
            .collect();
        let labels = mean_shift(&points, 1.0);
        assert!(labels.iter().enumerate().all(|(i, &l)| l == i % 3), "{labels:?}");
    }

    #[test]
    fn wild_points_stand_alone() {
        let points = [DVec2::NAN, DVec2::ONE, DVec2::NAN, DVec2::ONE, DVec2::new(1e300, 0.0)];
        assert_eq!(mean_shift(&points, 0.5), [0, 1, 2, 1, 3]);
        assert_eq!(mean_shift(&points[1..], f64::NAN), [0, 1, 0, 2]);
        assert_eq!(mean_shift(&[], 1.0), [] as [usize; 0]);
    }

    #[test]
    fn order_of_the_points_decides_the_numbers_only() {
        let points = [0.0, 0.2, 5.0, 5.3, 0.1].map(|x| DVec2::new(x, 0.0));
        let mut reversed = points;
        reversed.reverse();
        assert_eq!(mean_shift(&points, 1.0), [0, 0, 1, 1, 0]);
        assert_eq!(mean_shift(&reversed, 1.0), [0, 1, 1, 0, 0]);
    }
}
