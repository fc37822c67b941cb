//! A polygon that is tested against many points.

use glam::DVec2;

/// Number of level bands into which the edges are sorted.
const BANDS: usize = 16;

/// The inside of a polygon by the even-odd rule, edges sorted by height so that a test checks few of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Region {
    low: f64,
    bands_per_height: f64,
    /// One list of edges for each band; empty for an empty region.
    edges: Vec<Vec<(DVec2, DVec2)>>,
}

impl Region {
    /// Makes the region of a polygon whose first point is not repeated; empty for fewer than 3 points.
    pub(super) fn new(polygon: &[DVec2]) -> Self {
        let (low, high) =
            polygon.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), p| (a.min(p.y), b.max(p.y)));
        let Some(&last) = polygon.last().filter(|_| polygon.len() > 2 && high > low) else {
            return Self::default();
        };
        let mut region =
            Self { low, bands_per_height: BANDS as f64 / (high - low), edges: vec![Vec::new(); BANDS] };
        let mut a = last;
        for &b in polygon {
            if let Some((from, to)) = region.band(a.y.min(b.y)).zip(region.band(a.y.max(b.y))) {
                for band in &mut region.edges[from..=to] {
                    band.push((a, b));
                }
            }
            a = b;
        }
        region
    }

    /// Returns the band of a height, the outermost ones for heights outside; `None` for NaN.
    fn band(&self, y: f64) -> Option<usize> {
        let band = ((y - self.low) * self.bands_per_height).clamp(0.0, (BANDS - 1) as f64);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the bands")]
        (!band.is_nan()).then_some(band as usize)
    }

    /// Whether `p` lies inside.
    pub(super) fn contains(&self, p: DVec2) -> bool {
        let mut odd = false;
        for &(a, b) in self.band(p.y).and_then(|k| self.edges.get(k)).into_iter().flatten() {
            if (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) {
                odd = !odd;
            }
        }
        odd
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn region_of_a_frame_has_a_hole() {
        let ring = [
            (0.0, 0.0),
            (4.0, 0.0),
            (4.0, 4.0),
            (0.0, 4.0),
            (0.0, 0.0),
            (1.0, 1.0),
            (3.0, 1.0),
            (3.0, 3.0),
            (1.0, 3.0),
            (1.0, 1.0),
        ];
        let region = Region::new(&ring.map(|(x, y)| DVec2::new(x, y)));
        assert!(
            region.contains(DVec2::new(0.5, 2.0)) && region.contains(DVec2::new(2.0, 3.5)),
            "in the frame"
        );
        for out in [DVec2::new(2.0, 2.0), DVec2::new(5.0, 2.0), DVec2::new(2.0, 9.0), DVec2::NAN] {
            assert!(!region.contains(out), "{out} lies outside");
        }
        assert!(!Region::new(&[DVec2::ZERO, DVec2::X]).contains(DVec2::ZERO), "two points enclose nothing");
    }
}
