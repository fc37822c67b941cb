//! Points with colours, and their colours between two scans.

use base::{Cancelled, Run, map_until_cancelled};
use geom::KdTree;
use glam::DVec3;

use crate::ScanOrgan;

/// The points of an organ on a day.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OrganPoints {
    /// Its name: `stem`, `leaf-1`, ...
    pub name: String,
    /// Metres, +Y up.
    pub points: Vec<DVec3>,
    /// sRGB bytes; empty or one per point.
    pub colors: Vec<[u8; 3]>,
}

impl From<&ScanOrgan> for OrganPoints {
    fn from(organ: &ScanOrgan) -> Self {
        Self { name: organ.name.clone(), points: organ.points.clone(), colors: organ.colors.clone() }
    }
}

impl OrganPoints {
    /// Adds the points of the same organ in another scan. Colours are kept if both have some.
    pub(crate) fn add(&mut self, more: Self) {
        self.points.extend(more.points);
        self.colors.extend(more.colors);
        if self.colors.len() != self.points.len() {
            self.colors.clear();
        }
    }
}

/// Returns, for each point, the colour of the nearest point of another cloud; empty for a cloud without colours.
pub(crate) fn nearest(
    points: &[DVec3],
    others: &[DVec3],
    colors: &[[u8; 3]],
    run: &Run<'_>,
) -> Result<Vec<[u8; 3]>, Cancelled> {
    if colors.is_empty() || colors.len() != others.len() {
        return Ok(Vec::new());
    }
    let tree = KdTree::new(others);
    let of = |i: usize| tree.nearest(points[i], f64::INFINITY).map_or([0; 3], |k| colors[k]);
    map_until_cancelled(run, points.len(), of)
}

/// Mixes the light of two colours of each point, the second with this share; a point with a colour on one day only
/// keeps it.
pub(crate) fn mixed([first, last]: &[Vec<[u8; 3]>; 2], share: f64) -> Vec<[u8; 3]> {
    let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 1.0 };
    if last.is_empty() || (share <= 0.0 && !first.is_empty()) {
        return first.clone();
    }
    if first.is_empty() || share >= 1.0 {
        return last.clone();
    }
    let mix = |a: u8, b: u8| base::ops::lerp(base::light_of_byte(a), base::light_of_byte(b), share);
    let one = |(a, b): (&[u8; 3], &[u8; 3])| [0, 1, 2].map(|k| base::byte_of_light(mix(a[k], b[k])));
    first.iter().zip(last).map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_between_two_days_are_means_of_light() {
        let both = [vec![[0, 255, 10]], vec![[255, 255, 10]]];
        assert_eq!((mixed(&both, -1.0), mixed(&both, 1.5)), (both[0].clone(), both[1].clone()));
        // Half of the light of white is 188 of 255.
        assert_eq!(mixed(&both, 0.5), [[188, 255, 10]]);
        assert_eq!(mixed(&[vec![], vec![[1, 2, 3]]], 0.0), [[1, 2, 3]]);
        assert_eq!(mixed(&[vec![[1, 2, 3]], vec![]], 1.0), [[1, 2, 3]]);
        assert_eq!(mixed(&both, f64::NAN), both[1]);
    }
}
