//! Leader lines from words to the parts that they name, with their heads.

use glam::DVec2;

use super::{Change, Extent, Work, chord_of, is_closed, length_of};

/// Least words with a line: a single one may be a title, and a plant stands over its name.
const FEWEST: usize = 2;
/// Largest distance of a leader line's beginning to the side of its words, as a multiple of their height.
const BESIDE: f64 = 1.2;
/// Largest distance of a leader line's beginning above or below its words, as a share of their height.
const HIGHER: f64 = 0.5;
/// Least chord over length of a leader line.
const NEARLY_STRAIGHT: f64 = 0.9;
/// Largest distance of a head's points from the end of its line, as a share of the drawing's diagonal.
const HEAD: f64 = 0.035;
/// Distance within which a head touches the end of its line, as a share of the drawing's diagonal.
const TOUCHES: f64 = 0.012;
/// Number of points of a head that is drawn as an angle.
const ANGLE: usize = 3;
/// Most points of a head that is an area.
const MOST_POINTS: usize = 5;

impl Work {
    /// Leaves out leader lines and the heads of arrows at their ends. `words`: boxes around words.
    pub(super) fn leave_labels_out(&mut self, words: &[(DVec2, DVec2)]) {
        let boxes: Vec<Extent> = words.iter().map(|&(lo, hi)| Extent { lo, hi }).collect();
        if boxes.len() < FEWEST || boxes.len() * self.figures.len() > super::LIMITS.pairs {
            return;
        }
        let diagonal = self.diagonal();
        let mut out = self.none_out();
        let mut ends: Vec<DVec2> = Vec::new();
        for (figure, out) in self.figures.iter().zip(&mut out) {
            let [line] = figure.lines.as_slice() else { continue };
            let [Some(a), Some(b)] = [line.first(), line.last()].map(|s| s.map(|s| s.at)) else { continue };
            let straight = chord_of(line).length() >= NEARLY_STRAIGHT * length_of(line);
            if !(figure.lined && straight) {
                continue;
            }
            let is_by_words = |p: DVec2| boxes.iter().any(|b| is_beside(*b, p));
            let end = match (is_by_words(a), is_by_words(b)) {
                (true, false) => b,
                (false, true) => a,
                _ => continue,
            };
            ends.push(end);
            out[0] = true;
        }
        if ends.len() < FEWEST {
            return;
        }
        for (figure, out) in self.figures.iter().zip(&mut out) {
            let [line] = figure.lines.as_slice() else { continue };
            // A head is an angle of two lines, or a small area.
            let is_head = |end: &DVec2| {
                let near = line.iter().all(|s| s.at.distance(*end) <= HEAD * diagonal);
                near && line.iter().any(|s| s.at.distance(*end) <= TOUCHES * diagonal)
            };
            let is_angle = line.len() == ANGLE || (line.len() <= MOST_POINTS && is_closed(line));
            if is_angle && ends.iter().any(is_head) {
                out[0] = true;
            }
        }
        self.leave_out(&out, Change::Labels);
    }
}

/// Whether a point lies to the left or right of words.
fn is_beside(words: Extent, p: DVec2) -> bool {
    let height = words.size().y;
    let away = (words.lo - p).max(p - words.hi);
    away.y <= HIGHER * height && away.x <= BESIDE * height && away.x >= -height
}
