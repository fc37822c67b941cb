//! Points far away from all others: echoes of mirrors, clouds and birds, and zeros for what is missing.

use glam::DVec3;
use mesh::PointCloud;

/// Clouds of fewer points show no strays.
const FEWEST: usize = 100;
/// One in so many points may be a stray.
const RARE: usize = 1_000;
/// How many times the extent of all but the rarest points a stray lies beyond them.
const FAR: f64 = 10.0;

/// Takes strays out; how many there were.
pub(super) fn leave_out(cloud: &mut PointCloud) -> u64 {
    let points = &cloud.points;
    if points.len() < FEWEST {
        return 0;
    }
    let rare = (points.len() / RARE).max(1);
    let mut column = Vec::with_capacity(points.len());
    let mut core = [DVec3::ZERO; 2];
    for k in 0..3 {
        column.clear();
        column.extend(points.iter().map(|p| p[k]));
        let last = column.len() - 1 - rare;
        core[0][k] = *column.select_nth_unstable_by(rare, f64::total_cmp).1;
        core[1][k] = *column.select_nth_unstable_by(last, f64::total_cmp).1;
    }
    let reach = FAR * (core[1] - core[0]).max_element();
    if reach <= 0.0 {
        return 0;
    }
    let is_stray = |p: &DVec3| (core[0] - *p).max(*p - core[1]).max_element() > reach;
    let count = points.iter().filter(|p| is_stray(p)).count();
    if count > 0 {
        let kept: Vec<usize> = (0..points.len()).filter(|&i| !is_stray(&points[i])).collect();
        *cloud = cloud.select(&kept);
    }
    count as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cloud(strays: &[DVec3]) -> PointCloud {
        let grid =
            (0..1000).map(|i| DVec3::new(f64::from(i % 10), f64::from(i / 10 % 10), f64::from(i / 100)));
        let points: Vec<DVec3> = grid.chain(strays.iter().copied()).collect();
        let colors = points.iter().map(|p| if p.x > 9.0 { [255; 3] } else { [0; 3] }).collect();
        PointCloud { points, colors, ..PointCloud::default() }
    }

    #[test]
    fn a_stray_goes_with_its_colour_and_what_is_a_part_of_the_cloud_stays() {
        let mut far = cloud(&[DVec3::new(-4e5, 0.0, 3.0)]);
        assert_eq!((leave_out(&mut far), far.points.len(), far.colors.len()), (1, 1000, 1000));
        let mut near = cloud(&[DVec3::new(60.0, 0.0, 3.0)]);
        assert_eq!((leave_out(&mut near), near.points.len()), (0, 1001));
        // More than one in a thousand on a side are a thing of their own.
        let mut thing = cloud(&[DVec3::new(900.0, 0.0, 3.0); 5]);
        assert_eq!(leave_out(&mut thing), 0);
        let mut same = PointCloud { points: vec![DVec3::ONE; 200], ..PointCloud::default() };
        assert_eq!(leave_out(&mut same), 0);
    }
}
