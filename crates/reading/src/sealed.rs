//! The area that lines enclose although they leave gaps: `lines + gap -> the largest piece, and its outline`.
//!
//! A ball larger than the gaps rolls round the drawing; the area that it cannot reach is inside (trapped-ball
//! segmentation, Zhang, Chen, Zhang, Hu and Martin 2009, section 4). Bays wider than the ball stay bays.

use geom::{simple_outline, simplify};
use glam::DVec2;

use crate::raster::{Cells, around, ball, drawn, flood, grown, largest};

/// Cells along the longer side of the drawing.
const ALONG: usize = 96;
/// Greatest radius of a ball in cells. A ball as wide as the drawing finds no way into any gap; if the lines are tiny
/// compared with the ball, the picture would hold nothing else.
const WIDEST_BALL: f64 = ALONG as f64;
/// Corners of the outline lie within this of its cells, in cells.
const CALM: f64 = 0.5;

/// The largest piece of a drawing that a ball cannot reach.
pub(crate) struct Sealed {
    cells: Cells,
    piece: Vec<bool>,
}

impl Sealed {
    /// Finds the piece that a ball of this radius leaves; `None` if there is none, or if the ball is larger than all
    /// the lines. Cost: linear in points, and the picture times the ball.
    pub(crate) fn new(lines: &[&[DVec2]], radius: f64) -> Option<Self> {
        let size = Cells::size_for(lines, ALONG)?;
        let reach = radius / size;
        if reach > WIDEST_BALL {
            return None;
        }
        let cells = Cells::new(lines, ALONG, reach.ceil() + 2.0)?;
        let ball = ball(reach);
        let near = grown(&cells, &drawn(&cells, lines), &ball);
        let middles = flood(&cells, 0, &|k| !near[k]);
        let outside = grown(&cells, &middles, &ball);
        let piece = largest(&cells, &|k| !outside[k])?;
        Some(Self { cells, piece })
    }

    /// Returns its outline, counter-clockwise, without a crossing: it runs along the lines, off them by less than a
    /// hundredth of the drawing.
    pub(crate) fn outline(&self) -> Option<Vec<DVec2>> {
        simple_outline(&simplify(&around(&self.cells, &self.piece)?, CALM * self.cells.size))
    }

    /// Returns the largest piece of it in which a ball of this radius rolls, so that single lines drop out (opening,
    /// Serra 1982).
    pub(crate) fn opened(&self, radius: f64) -> Option<Self> {
        let (cells, ball) = (self.cells.clone(), ball(radius / self.cells.size));
        let out: Vec<bool> = self.piece.iter().map(|p| !p).collect();
        let rim = grown(&cells, &out, &ball);
        let deep: Vec<bool> = rim.iter().map(|r| !r).collect();
        let open = grown(&cells, &deep, &ball);
        let piece = largest(&cells, &|k| open[k])?;
        Some(Self { cells, piece })
    }
}

#[cfg(test)]
mod tests {
    use geom::{contains, signed_area};

    use super::*;

    fn sealed(lines: &[&[DVec2]], radius: f64) -> Vec<DVec2> {
        Sealed::new(lines, radius).and_then(|s| s.outline()).expect("lines have cells")
    }

    fn square(gap: f64) -> Vec<DVec2> {
        let corners =
            [[0.5 + 0.5 * gap, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0], [0.5 - 0.5 * gap, 0.0]];
        corners.map(DVec2::from).to_vec()
    }

    #[test]
    fn a_gap_narrower_than_the_ball_is_closed_and_a_wider_one_is_not() {
        let area = |gap: f64| signed_area(&sealed(&[&square(gap)], 0.05));
        assert!((area(0.08) - 1.0).abs() < 0.03, "{}", area(0.08));
        assert!(area(0.2) < 0.1, "{}", area(0.2));
    }

    #[test]
    fn a_bay_wider_than_the_ball_stays_a_bay() {
        let p = |x: f64, y: f64| DVec2::new(x, y);
        let bay = [
            p(0.0, 0.0),
            p(0.4, 0.0),
            p(0.4, 0.6),
            p(0.6, 0.6),
            p(0.6, 0.0),
            p(1.0, 0.0),
            p(1.0, 1.0),
            p(0.0, 1.0),
            p(0.0, 0.0),
        ];
        let outline = sealed(&[&bay], 0.05);
        assert!(
            !contains(&outline, p(0.5, 0.3))
                && contains(&outline, p(0.2, 0.3))
                && contains(&outline, p(0.5, 0.8))
        );
    }

    #[test]
    fn a_ball_larger_than_the_lines_is_given_up_at_once() {
        let speck =
            |size: f64| Sealed::new(&[&square(0.1).iter().map(|p| *p * size).collect::<Vec<_>>()], 0.05);
        assert!(speck(0.06).is_some());
        // Pictures of 500 thousand million cells, as the ball needs room.
        assert!(speck(1e-5).is_none() && speck(1e-300).is_none());
    }

    #[test]
    fn lines_without_extent_have_no_outline() {
        assert!(Sealed::new(&[], 0.05).is_none());
        assert!(Sealed::new(&[&[DVec2::ONE, DVec2::ONE]], 0.05).is_none());
    }
}
