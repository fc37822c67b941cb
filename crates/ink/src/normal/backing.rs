//! Backings: areas that lie under the whole drawing and extend all round it by the same width, such as the rim of a
//! sticker or the dark layer that shows as an outline between coloured areas.

use glam::DVec2;

use super::{Change, Extent, LIMITS, Work, places, some_of};

/// Most backings that are removed: nobody stacks more.
const LAYERS: usize = 3;
/// Number of places of the outline at which its width is measured.
const ROUND: usize = 96;
/// Most points of what lies on the backing that are compared with its outline.
const UPON: usize = 4096;
/// Largest width by which a backing stands out anywhere, as a share of the drawing's diagonal.
const WIDEST: f64 = 0.1;
/// Largest mean width by which a backing stands out, as a share of the drawing's diagonal.
const WIDE: f64 = 0.045;
/// Least areas that lie on it.
const FEWEST: usize = 2;

impl Work {
    /// Removes backings. Cost: for each layer, places of its outline times points on it.
    pub(super) fn leave_backings_out(&mut self) {
        for _ in 0..LAYERS {
            let Some(backing) = self.backing() else { break };
            let count = self.figures[backing].lines.len();
            self.figures.remove(backing);
            self.note(Change::Paper, count);
        }
    }

    /// Returns the first area, if it is a backing of all that is painted after it.
    fn backing(&self) -> Option<usize> {
        let area = self.figures.iter().position(|f| !f.lines.is_empty())?;
        let figure = &self.figures[area];
        let upon = &self.figures[area + 1..];
        let is_area = |f: &super::Figure| f.fill.is_some() && !f.lined;
        if !is_area(figure) || upon.iter().filter(|f| is_area(f)).count() < FEWEST {
            return None;
        }
        let largest = |l: &&Vec<_>| Extent::from_line(l).map_or(0.0, Extent::area);
        let outline = places(figure.lines.iter().max_by(|a, b| largest(a).total_cmp(&largest(b)))?);
        let all: Vec<DVec2> = upon.iter().flat_map(|f| &f.lines).flatten().map(|s| s.at).collect();
        let upon: Vec<DVec2> = some_of(&all, UPON).filter(|p| p.is_finite()).collect();
        let inside = upon.iter().filter(|p| geom::contains(&outline, **p)).count();
        #[expect(clippy::cast_precision_loss, reason = "numbers of points")]
        if upon.is_empty() || (inside as f64) < LIMITS.held * upon.len() as f64 {
            return None;
        }
        let diagonal = self.diagonal();
        let even = geom::resample(&outline, geom::polyline_length(&outline) / ROUND as f64);
        let width = |p: &DVec2| upon.iter().map(|q| q.distance(*p)).fold(f64::INFINITY, f64::min);
        let widths: Vec<f64> = even.iter().map(width).collect();
        let widest = widths.iter().copied().fold(0.0, f64::max);
        #[expect(clippy::cast_precision_loss, reason = "a few places")]
        let mean = widths.iter().sum::<f64>() / widths.len().max(1) as f64;
        (widest < WIDEST * diagonal && mean < WIDE * diagonal).then_some(area)
    }
}
