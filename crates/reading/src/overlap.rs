//! Finds which of overlapping blades lies in front.
//!
//! `blades + their strokes -> the layer of each`

use geom::{bounds, contains, distance_to_polyline};
use glam::DVec2;
use ink::Ink;

use crate::BladeReading;

/// Most blades that are compared: with more, nobody drew one over another on purpose.
const MOST: usize = 600;
/// Two overlap if more than this share of an outline lies within the other: neighbours meet at their feet.
const OVER: f64 = 0.08;
/// An outline is open if its ends are farther apart than this share of its length.
const OPEN: f64 = 0.06;
/// An end lies on another outline if it is nearer than this share of that outline's size.
const ON: f64 = 0.06;
/// Places of an outline that are looked at.
const PLACES: usize = 24;

/// One blade as it was drawn.
struct Drawn<'a> {
    blade: &'a BladeReading,
    low: DVec2,
    high: DVec2,
    /// Ends of its stroke, where they are apart.
    ends: Option<[DVec2; 2]>,
}

/// Returns the layer of each blade, -1 behind all that it overlaps to 1 in front; `None` for one that overlaps no
/// other.
///
/// A line that stops at both ends on the outline of another blade goes on behind that one: it is hidden there (a
/// T-junction: Guzman 1968). If both outlines are whole, the later one was drawn over the earlier one. Cost: pairs
/// that are near.
pub(crate) fn layers(blades: &[BladeReading], ink: &Ink) -> Vec<Option<f64>> {
    if blades.len() < 2 || blades.len() > MOST {
        return vec![None; blades.len()];
    }
    let drawn: Vec<Drawn<'_>> = blades
        .iter()
        .map(|blade| {
            let (low, high) = bounds(&blade.outline).unwrap_or_default();
            let row = blade.source.and_then(|k| ink.strokes.binary_search_by_key(&k, |s| s.index).ok());
            let ends = row.map(|row| &ink.strokes[row]).and_then(|s| {
                let ends = [*s.points.first()?, *s.points.last()?];
                (ends[0].distance(ends[1]) > OPEN * s.length).then_some(ends)
            });
            Drawn { blade, low, high, ends }
        })
        .collect();
    // For each pair, the blade behind and the blade in front.
    let mut over: Vec<(usize, usize)> = Vec::new();
    for (i, a) in drawn.iter().enumerate() {
        for (j, b) in drawn.iter().enumerate().skip(i + 1) {
            let apart = a.low.cmpgt(b.high).any() || b.low.cmpgt(a.high).any();
            if apart || a.blade.source == b.blade.source || (within(a, b).max(within(b, a)) < OVER) {
                continue;
            }
            over.push(match (stops_at(a, b), stops_at(b, a)) {
                (true, false) => (i, j),
                (false, true) => (j, i),
                _ if a.blade.source < b.blade.source => (i, j),
                _ => (j, i),
            });
        }
    }
    levels(blades.len(), &over)
}

/// Returns the share of an outline that lies within another one.
fn within(inner: &Drawn<'_>, outer: &Drawn<'_>) -> f64 {
    let outline = &inner.blade.outline;
    let step = (outline.len() / PLACES).max(1);
    let places = outline.iter().step_by(step);
    let (count, inside) = (places.len(), places.filter(|p| contains(&outer.blade.outline, **p)).count());
    inside as f64 / count.max(1) as f64
}

/// Whether the line around one blade stops on the outline of another.
fn stops_at(one: &Drawn<'_>, other: &Drawn<'_>) -> bool {
    let reach = ON * other.low.distance(other.high);
    let on = |p: &DVec2| distance_to_polyline(&other.blade.outline, *p).is_some_and(|d| d < reach);
    one.ends.is_some_and(|ends| ends.iter().all(on))
}

/// Turns pairs (behind, in front) into levels, evenly from -1 to 1 among connected blades. Cycles, which petals may
/// form, are cut.
fn levels(count: usize, over: &[(usize, usize)]) -> Vec<Option<f64>> {
    let mut level = vec![0_usize; count];
    let mut group: Vec<usize> = (0..count).collect();
    for _ in 0..count {
        let mut still = true;
        for &(behind, front) in over {
            let least = group[behind].min(group[front]);
            still &= group[behind] == least && group[front] == least;
            (group[behind], group[front]) = (least, least);
        }
        if still {
            break;
        }
    }
    let mut size = vec![0_usize; count];
    group.iter().for_each(|&g| size[g] += 1);
    for _ in 0..count {
        let mut still = true;
        for &(behind, front) in over {
            if level[front] <= level[behind] && level[behind] + 1 < size[group[front]] {
                (level[front], still) = (level[behind] + 1, false);
            }
        }
        if still {
            break;
        }
    }
    let mut most = vec![0_usize; count];
    (0..count).for_each(|k| most[group[k]] = most[group[k]].max(level[k]));
    (0..count)
        .map(|k| match most[group[k]] {
            0 => None,
            most => Some(2.0 * level[k] as f64 / most as f64 - 1.0),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use base::Report;
    use ink::{Drawing, InkSample, Stroke};

    use super::*;

    fn leaf(at: f64, open: bool) -> Vec<DVec2> {
        let n = if open { 17 } else { 24 };
        (0..=n)
            .map(|k| {
                let (s, c) = base::ops::sin_cos(base::ops::TAU * (f64::from(k) - 8.5) / 24.0);
                // Open on its left.
                DVec2::new(at + c, 0.5 * s)
            })
            .collect()
    }

    fn overlaps_of_lines(lines: &[Vec<DVec2>]) -> Vec<Option<f64>> {
        let stroke = |line: &Vec<DVec2>| Stroke {
            samples: line.iter().map(|p| InkSample::from(*p)).collect(),
            ..Stroke::default()
        };
        let drawing = Drawing { strokes: lines.iter().map(stroke).collect(), ..Drawing::default() };
        let ink = ink::clean(&drawing, &mut Report::default());
        let blade = |s: &ink::InkStroke| BladeReading {
            outline: s.points.clone(),
            root: s.points[0],
            tip: s.points[0],
            midrib: Vec::new(),
            veins: Vec::new(),
            bearer: None,
            whorl: 0,
            front: None,
            source: Some(s.index),
            color: None,
        };
        layers(&ink.strokes.iter().map(blade).collect::<Vec<_>>(), &ink)
    }

    #[test]
    fn what_was_drawn_over_what_lies_in_front() {
        assert_eq!(
            overlaps_of_lines(&[leaf(0.0, false), leaf(1.2, false), leaf(2.4, false)]),
            [Some(-1.0), Some(0.0), Some(1.0)]
        );
        assert_eq!(
            overlaps_of_lines(&[leaf(0.0, false), leaf(2.2, false), leaf(4.4, false)]),
            [None; 3],
            "they do not overlap"
        );
    }

    #[test]
    fn a_line_that_stops_at_a_leaf_goes_on_behind_it() {
        // Both orders of drawing.
        assert_eq!(overlaps_of_lines(&[leaf(0.0, false), leaf(0.9, true)]), [Some(1.0), Some(-1.0)]);
        assert_eq!(overlaps_of_lines(&[leaf(0.9, true), leaf(0.0, false)]), [Some(-1.0), Some(1.0)]);
    }

    #[test]
    fn a_circle_is_cut_and_levels_stay_within_their_range() {
        let found = levels(4, &[(0, 1), (1, 2), (2, 0)]);
        assert!(found[..3].iter().all(|l| l.is_some_and(|l| (-1.0..=1.0).contains(&l))), "{found:?}");
        assert_eq!(found[3], None);
    }
}
