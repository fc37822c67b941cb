//! Lines that lead from words to what they name, with their heads.

use glam::DVec2;

use super::{Change, Extent, Work, chord_of, is_closed, length_of};

/// Least words with a line: a single one may be a title, and a plant stands over its name.
const FEWEST: usize = 2;
/// A line from words begins beside them within this share of their height, and no higher or lower than half of it.
const BESIDE: f64 = 1.2;
const HIGHER: f64 = 0.5;
/// A line from words bends no more than this: its chord over its length.
const NEARLY_STRAIGHT: f64 = 0.9;
/// A head lies about the end of its line within this share of the drawing's diagonal, and touches it within that share.
const HEAD: f64 = 0.035;
const TOUCHES: f64 = 0.012;
/// Points of a head that is drawn as an angle, and most of one that is an area.
const ANGLE: usize = 3;
const MOST_POINTS: usize = 5;

impl Work {
    /// Leaves out lines from words, and heads of arrows at their ends. `words`: boxes around words.
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
