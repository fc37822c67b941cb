//! Turns a scribble into the simple polygon that it represents.
//!
//! The closed line is rounded to a grid of whole numbers, where the tests below are exact in f64, and cut wherever it
//! meets itself. A walk along the outer side of the resulting net, split at knots where parts are attached at one point
//! only, gives simple polygons, and the largest is the result. So loops at the closing point, overshoot and loops along
//! the margin disappear, and anything drawn inside is ignored.

use crate::polygon::{convex_hull, signed_area};
use crate::vector::distinct_closed;
use glam::DVec2;

// Grid steps over the drawing, 2^24: 6e-8 of its size; products of two differences stay below 2^53, so are exact.
const STEPS: f64 = 16_777_216.0;
// Most corners of a closed line; others are thinned out: no outline needs more, and time grows with the square at
// worst.
const MAX_CORNERS: usize = 12_000;
// Offset of the limit of 4 n + this crossings, above which a net is a hatching, whose outline is as well given by every
// second point.
const MANY_CROSSINGS: usize = 4_000;
// Most rounds of rounding: rounding a crossing to the grid can create a new one with a line close by; two rounds are
// usual.
const MAX_ROUNDS: usize = 12;
// Area as a share of the squared size below which a line only goes to and fro.
const NO_AREA: f64 = 1e-9;

/// Intersection of two segments.
enum Meeting {
    Apart,
    /// They cross or touch at one point.
    At(DVec2),
    /// They share a stretch of one straight line.
    Overlap,
}

/// Returns twice the signed area of a triangle; exact for whole numbers up to 2^25.
fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

fn within_box(a: DVec2, b: DVec2, p: DVec2) -> bool {
    p.cmpge(a.min(b)).all() && p.cmple(a.max(b)).all()
}

fn meet(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> Meeting {
    let (c_side, d_side) = (turn(a, b, c), turn(a, b, d));
    let (a_side, b_side) = (turn(c, d, a), turn(c, d, b));
    if (c_side > 0.0 && d_side > 0.0) || (c_side < 0.0 && d_side < 0.0) {
        return Meeting::Apart;
    }
    if (a_side > 0.0 && b_side > 0.0) || (a_side < 0.0 && b_side < 0.0) {
        return Meeting::Apart;
    }
    let touching = [
        (c_side == 0.0 && within_box(a, b, c)).then_some(c),
        (d_side == 0.0 && within_box(a, b, d)).then_some(d),
        (a_side == 0.0 && within_box(c, d, a)).then_some(a),
        (b_side == 0.0 && within_box(c, d, b)).then_some(b),
    ];
    let mut places = touching.into_iter().flatten();
    if let Some(first) = places.next() {
        return if places.any(|p| p != first) { Meeting::Overlap } else { Meeting::At(first) };
    }
    if c_side == 0.0 || d_side == 0.0 || a_side == 0.0 || b_side == 0.0 {
        return Meeting::Apart; // in line but beyond the end
    }
    Meeting::At(c + (d - c) * (c_side / (c_side - d_side)))
}

/// Calls `f` for every pair of segments (lower index first) whose boxes overlap; stops when it returns false.
///
/// Sweeps along the longer side of the drawing. Cost: n log n for outlines, n^2 / 2 box tests at worst.
fn meeting_boxes(segments: &[(DVec2, DVec2)], mut f: impl FnMut(usize, usize) -> bool) {
    let (boxes, order) = boxes_in_order(segments);
    let mut open: Vec<usize> = Vec::new();
    for i in order {
        let (lo, hi) = boxes[i];
        open.retain(|&j| boxes[j].1.x >= lo.x);
        for &j in &open {
            if boxes[j].1.y >= lo.y && boxes[j].0.y <= hi.y && !f(i.min(j), i.max(j)) {
                return;
            }
        }
        open.push(i);
    }
}

/// Returns the box around each segment, with the longer side of all along x, and the order in which they begin.
fn boxes_in_order(segments: &[(DVec2, DVec2)]) -> (Vec<(DVec2, DVec2)>, Vec<usize>) {
    let (mut lo, mut hi) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for &(a, b) in segments {
        (lo, hi) = (lo.min(a).min(b), hi.max(a).max(b));
    }
    let turned = (hi - lo).x < (hi - lo).y;
    let flat = |p: DVec2| if turned { DVec2::new(p.y, p.x) } else { p };
    let boxes: Vec<(DVec2, DVec2)> =
        segments.iter().map(|&(a, b)| (flat(a.min(b)), flat(a.max(b)))).collect();
    let mut order: Vec<usize> = (0..segments.len()).collect();
    base::sort_by(&mut order, |&i, &j| boxes[i].0.x.total_cmp(&boxes[j].0.x).then(i.cmp(&j)));
    (boxes, order)
}

fn closed_segments(corners: &[DVec2]) -> Vec<(DVec2, DVec2)> {
    let n = corners.len();
    (0..n).map(|i| (corners[i], corners[(i + 1) % n])).collect()
}

/// Returns the number of pairs of edges of a closed line that meet although they should not.
///
/// Neighbouring edges count if they lie on each other, others if they cross, touch or overlap. 0 means a
/// simple polygon. Unusable and repeated points are left out. Cost: n log n for outlines, n^2 at worst.
///
/// ```
/// use glam::DVec2;
/// let bow = [DVec2::ZERO, DVec2::ONE, DVec2::X, DVec2::Y];
/// assert_eq!(geom::self_crossings(&bow), 1);
/// ```
pub fn self_crossings(points: &[DVec2]) -> usize {
    crossings_up_to(&distinct_closed(points), usize::MAX)
}

/// Returns the points at which a closed line crosses or touches itself, at most `most`; see [`self_crossings`] for the
/// definition.
///
/// For edges that overlap, the start of the later one. In no particular order. Cost: as [`self_crossings`], less if
/// `most` is reached.
///
/// ```
/// use glam::DVec2;
/// let bow = [DVec2::ZERO, DVec2::ONE, DVec2::X, DVec2::Y];
/// assert_eq!(geom::crossing_points(&bow, 10), [DVec2::splat(0.5)]);
/// ```
pub fn crossing_points(points: &[DVec2], most: usize) -> Vec<DVec2> {
    let mut found = Vec::new();
    each_crossing(&distinct_closed(points), |p| {
        found.push(p);
        found.len() < most
    });
    found.truncate(most);
    found
}

pub(crate) fn crossings_up_to(corners: &[DVec2], enough: usize) -> usize {
    let mut count = 0;
    each_crossing(corners, |_| {
        count += 1;
        count < enough
    });
    count
}

/// Calls `seen` with each crossing until it returns false.
fn each_crossing(corners: &[DVec2], mut seen: impl FnMut(DVec2) -> bool) {
    let n = corners.len();
    if n < 3 {
        return;
    }
    let segments = closed_segments(corners);
    meeting_boxes(&segments, |i, j| {
        let ((a, b), (c, d)) = (segments[i], segments[j]);
        let neighbours = j == i + 1 || (i == 0 && j == n - 1);
        match meet(a, b, c, d) {
            Meeting::At(p) if !neighbours => seen(p),
            Meeting::Overlap => seen(c),
            Meeting::Apart | Meeting::At(_) => true,
        }
    });
}

/// Returns the simple counter-clockwise polygon that a closed scribble represents; `None` if it encloses no area.
///
/// The line is closed from its last point to its first. The area that it encloses, seen from outside, is split where it
/// is connected at one point only, and the largest part is returned: overshoot at the closing point, small loops and
/// everything inside the outline disappear. Guaranteed: at least 3 points, [`self_crossings`] is 0, the area is
/// positive. A line that is already simple keeps its own points (reversed if it ran clockwise); otherwise the points
/// lie within 1e-7 of the drawing's size of the drawn ones. Unusable and repeated points are dropped, lines of more
/// than 12 000 points and dense hatchings are thinned. Cost: n log n for outlines.
///
/// ```
/// use glam::DVec2;
/// let p = |x, y| DVec2::new(x, y);
/// // A square whose sides run past each other where the pen came back.
/// let drawn = [p(0.0, -0.1), p(0.0, 1.0), p(1.0, 1.0), p(1.0, 0.0), p(-0.1, 0.0)];
/// let square = geom::simple_outline(&drawn).unwrap();
/// assert!((geom::signed_area(&square) - 1.0).abs() < 1e-6);
/// ```
pub fn simple_outline(points: &[DVec2]) -> Option<Vec<DVec2>> {
    let mut corners = distinct_closed(points);
    let thin = |corners: &[DVec2], by: usize| -> Vec<DVec2> { corners.iter().copied().step_by(by).collect() };
    if corners.len() > MAX_CORNERS {
        corners = thin(&corners, corners.len().div_ceil(MAX_CORNERS));
    }
    let (mut lo, mut hi) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for &p in &corners {
        (lo, hi) = (lo.min(p), hi.max(p));
    }
    let size = (hi - lo).max_element();
    let big_enough = size > 0.0;
    if corners.len() < 3 || !big_enough {
        return None;
    }
    let no_area = NO_AREA * size * size;
    // Reversed before the test, not after it: a touch that is decided by the last bit may be decided differently when
    // the same edges run in the opposite direction.
    if signed_area(&corners) < 0.0 {
        corners.reverse();
    }
    if crossings_up_to(&corners, 1) == 0 {
        return (signed_area(&corners) > no_area).then_some(corners);
    }
    // At least the spacing of floating-point numbers at the drawing's position, so that the way back from the grid is
    // exact.
    let unit = (size / STEPS).max(lo.abs().max(hi.abs()).max_element() * 4.0 * f64::EPSILON);
    let unit = power_of_two_from(unit)?;
    let origin = (lo / unit).floor() * unit;
    let mut whole: Vec<DVec2> =
        distinct_closed(&corners.iter().map(|&p| ((p - origin) / unit).round()).collect::<Vec<_>>());
    let outer = loop {
        if whole.len() < 3 {
            return None;
        }
        if let Some(net) = cut_at_meetings(&whole) {
            break outer_polygon(net);
        }
        if whole.len() < 16 {
            break convex_hull(&whole);
        }
        whole = distinct_closed(&thin(&whole, 2));
    };
    let outline: Vec<DVec2> = outer.into_iter().map(|p| origin + p * unit).collect();
    (outline.len() >= 3 && signed_area(&outline) > no_area).then_some(outline)
}

/// Returns the smallest power of two that is at least `x`; `None` outside the range of normal numbers.
fn power_of_two_from(x: f64) -> Option<f64> {
    if !x.is_normal() {
        return None;
    }
    let below = f64::from_bits(x.to_bits() & 0x7ff0_0000_0000_0000);
    Some(if below < x { below * 2.0 } else { below })
}

/// Returns the line's pieces between the points where it meets itself, on whole numbers; they meet only at their ends.
/// `None` if there are too many.
fn cut_at_meetings(corners: &[DVec2]) -> Option<Vec<(DVec2, DVec2)>> {
    let enough = 4 * corners.len() + MANY_CROSSINGS;
    let mut segments = closed_segments(corners);
    for _ in 0..MAX_ROUNDS {
        tidy(&mut segments);
        let mut cuts: Vec<(usize, DVec2)> = Vec::new();
        meeting_boxes(&segments, |i, j| {
            let ((a, b), (c, d)) = (segments[i], segments[j]);
            let mut cut = |k: usize, p: DVec2| {
                let (s, e) = segments[k];
                if p != s && p != e {
                    cuts.push((k, p));
                }
            };
            match meet(a, b, c, d) {
                Meeting::Apart => {}
                Meeting::At(p) => {
                    cut(i, p.round());
                    cut(j, p.round());
                }
                Meeting::Overlap => {
                    for p in [c, d].into_iter().filter(|&p| within_box(a, b, p)) {
                        cut(i, p);
                    }
                    for p in [a, b].into_iter().filter(|&p| within_box(c, d, p)) {
                        cut(j, p);
                    }
                }
            }
            cuts.len() < enough
        });
        if cuts.is_empty() {
            return Some(segments);
        }
        if cuts.len() >= enough {
            return None;
        }
        segments = apply_cuts(&segments, cuts);
    }
    None
}

/// Drops segments without length and repetitions in either direction.
fn tidy(segments: &mut Vec<(DVec2, DVec2)>) {
    for s in segments.iter_mut() {
        if order(s.1, s.0).is_lt() {
            *s = (s.1, s.0);
        }
    }
    segments.retain(|s| s.0 != s.1);
    base::sort_by(segments, |s, t| order(s.0, t.0).then(order(s.1, t.1)));
    segments.dedup();
}

fn order(p: DVec2, q: DVec2) -> core::cmp::Ordering {
    // + 0.0: rounding produces negative zeros, which are different bits for the same point.
    (p.x + 0.0).total_cmp(&(q.x + 0.0)).then((p.y + 0.0).total_cmp(&(q.y + 0.0)))
}

fn apply_cuts(segments: &[(DVec2, DVec2)], mut cuts: Vec<(usize, DVec2)>) -> Vec<(DVec2, DVec2)> {
    let along = |k: usize, p: DVec2| (p - segments[k].0).dot(segments[k].1 - segments[k].0);
    base::sort_by(&mut cuts, |&(i, p), &(j, q)| {
        i.cmp(&j).then_with(|| along(i, p).total_cmp(&along(j, q))).then(order(p, q))
    });
    let mut out = Vec::with_capacity(segments.len() + cuts.len());
    let mut cuts = cuts.into_iter().peekable();
    for (k, &(mut from, to)) in segments.iter().enumerate() {
        while let Some((_, p)) = cuts.next_if(|&(i, _)| i == k) {
            out.push((from, p));
            from = p;
        }
        out.push((from, to));
    }
    out
}

/// Returns the largest simple polygon on the outer side of a connected net of segments that meet only at their ends.
fn outer_polygon(net: Vec<(DVec2, DVec2)>) -> Vec<DVec2> {
    let mut knots: Vec<DVec2> = net.iter().flat_map(|&(a, b)| [a, b]).collect();
    base::sort_by(&mut knots, |&p, &q| order(p, q));
    knots.dedup();
    let knot = |p: DVec2| knots.partition_point(|&q| order(q, p).is_lt());
    let mut neighbours: Vec<Vec<usize>> = vec![vec![]; knots.len()];
    for (a, b) in net.into_iter().map(|(a, b)| (knot(a), knot(b))) {
        neighbours[a].push(b);
        neighbours[b].push(a);
    }
    for (k, around) in neighbours.iter_mut().enumerate() {
        let away = |j: usize| knots[j] - knots[k];
        // Counter-clockwise from just past the direction of -y; exact, as all differences are whole.
        let first_half = |d: DVec2| d.x > 0.0 || (d.x == 0.0 && d.y > 0.0);
        base::sort_by(around, |&i, &j| {
            let (d, e) = (away(i), away(j));
            first_half(e).cmp(&first_half(d)).then_with(|| 0.0_f64.total_cmp(&(d.perp_dot(e) + 0.0)))
        });
    }
    // The walk starts at the leftmost lowest knot, from where all others are in the first half of directions:
    // the first neighbour counter-clockwise has nothing outside it.
    let Some(&second) = neighbours.first().and_then(|n| n.first()) else { return vec![] };
    let mut best: (f64, Vec<DVec2>) = (0.0, vec![]);
    let mut path = vec![0_usize];
    let mut place: Vec<Option<usize>> = vec![None; knots.len()];
    place[0] = Some(0);
    let (mut from, mut here) = (0, second);
    // Every piece is passed at most once in each direction.
    let most = neighbours.iter().map(Vec::len).sum::<usize>();
    for _ in 0..most {
        if let Some(start) = place[here] {
            let polygon: Vec<DVec2> = path[start..].iter().map(|&k| knots[k]).collect();
            let area = signed_area(&polygon);
            if area > best.0 {
                best = (area, polygon);
            }
            for k in path.drain(start + 1..) {
                place[k] = None;
            }
        } else {
            place[here] = Some(path.len());
            path.push(here);
        }
        let around = &neighbours[here];
        let back = around.iter().position(|&k| k == from).unwrap_or(0);
        let next = around[(back + 1) % around.len()];
        if here == 0 && next == second {
            break;
        }
        (from, here) = (here, next);
    }
    best.1
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::ops;
    use proptest::prelude::*;

    fn p(x: f64, y: f64) -> DVec2 {
        DVec2::new(x, y)
    }

    #[test]
    fn a_touch_that_the_last_bit_decides_is_simple_whichever_way_it_runs() {
        // The last corner lies on the fourth edge, except for rounding.
        let mut corners: Vec<DVec2> = [
            (0.3055251773482429, 0.0016531079842704414),
            (0.30828245342287797, 0.0016742396690292633),
            (0.32188778828911147, 0.0057297216443345875),
            (0.7291009440347793, 0.14149686972335282),
            (0.3055326330044744, 0.5650651807536579),
            (0.2914136893034643, 0.5526142563493811),
            (0.16434319599437278, 0.42554376304028957),
            (0.18160799885096526, 0.42442439280151834),
            (0.44617342095661383, 0.4244243928015184),
        ]
        .map(|(x, y)| p(x, y))
        .to_vec();
        for _ in 0..2 {
            for start in 0..corners.len() {
                let mut ring = corners.clone();
                ring.rotate_left(start);
                let outline = simple_outline(&ring).unwrap();
                assert_eq!(self_crossings(&outline), 0, "from corner {start}");
                assert!(signed_area(&outline) > 0.03, "the larger part, if it falls into two");
            }
            corners.reverse();
        }
    }

    /// Makes a circle drawn by hand: from angle `from` over `turns` turns, with a varying radius.
    fn drawn_circle(n: u32, from: f64, turns: f64, wobble: f64) -> Vec<DVec2> {
        (0..n)
            .map(|i| {
                let a = from + turns * ops::TAU * f64::from(i) / f64::from(n - 1);
                base::turn::direction(a) * (1.0 + wobble * ops::sin(7.3 * a))
            })
            .collect()
    }

    fn check(points: &[DVec2]) -> Option<f64> {
        let outline = simple_outline(points)?;
        assert_eq!(self_crossings(&outline), 0, "{outline:?}");
        assert!(outline.len() >= 3 && signed_area(&outline) > 0.0, "{outline:?}");
        Some(signed_area(&outline))
    }

    #[test]
    fn simple_polygons_keep_their_points() {
        let square = [p(0.0, 0.0), p(1.0, 0.0), p(1.0, 1.0), p(0.0, 1.0)];
        assert_eq!(simple_outline(&square), Some(square.to_vec()));
        let mut clockwise = square;
        clockwise.reverse();
        assert_eq!(simple_outline(&clockwise), Some(square.to_vec()));
    }

    #[test]
    fn overshoot_falls_away() {
        let area = check(&drawn_circle(200, 0.3, 1.08, 0.03)).unwrap();
        assert!((area - ops::PI).abs() < 0.15, "{area}");
    }

    #[test]
    fn a_gap_is_closed_straight() {
        let area = check(&drawn_circle(200, 0.3, 0.97, 0.0)).unwrap();
        assert!((area - ops::PI).abs() < 0.01, "{area}");
    }

    #[test]
    fn a_line_drawn_twice_round_is_its_outer_side() {
        let area = check(&drawn_circle(400, 0.0, 2.0, 0.02)).unwrap();
        assert!((area - ops::PI).abs() < 0.25, "{area}");
    }

    #[test]
    fn loops_along_the_margin_fall_away() {
        // A hypotrochoid: a large circle with twelve small loops outside.
        let n = 1200;
        let line: Vec<DVec2> = (0..n)
            .map(|i| ops::TAU * f64::from(i) / f64::from(n))
            .map(|a| base::turn::direction(a) + base::turn::direction(-11.0 * a) * 0.12)
            .collect();
        let outline = simple_outline(&line).unwrap();
        assert_eq!(self_crossings(&outline), 0);
        let area = signed_area(&outline);
        assert!(area > 2.2 && area < 3.2, "{area}");
        assert!(outline.iter().all(|q| q.length() < 1.1), "the loops reach out to 1.12");
    }

    #[test]
    fn of_a_figure_eight_the_larger_half() {
        let eight = [p(0.0, 0.0), p(2.0, 2.0), p(2.0, 0.0), p(-1.0, 1.5), p(-1.0, -1.0)];
        let area = check(&eight).unwrap();
        let crossing_less = [p(0.0, 0.0), p(0.0, 1.0), p(1.0, 0.0)];
        assert!(area > 0.5 && check(&crossing_less) == Some(0.5), "{area}");
        let bow = [p(0.0, 0.0), p(1.0, 1.0), p(1.0, 0.0), p(0.0, 1.0)];
        assert!((check(&bow).unwrap() - 0.25).abs() < 1e-6);
    }

    #[test]
    fn without_area_none() {
        for line in [
            vec![],
            vec![p(0.0, 0.0); 5],
            vec![p(0.0, 0.0), p(1.0, 1.0), p(2.0, 2.0), p(0.5, 0.5)],
            vec![DVec2::NAN; 4],
            vec![p(0.0, 0.0), p(1.0, 0.0), p(1.0, 1.0), p(1.0, 0.0)],
        ] {
            assert_eq!(simple_outline(&line), None, "{line:?}");
        }
    }

    #[test]
    fn a_spike_is_cut_off() {
        let line = [p(0.0, 0.0), p(1.0, 0.0), p(1.0, 1.0), p(2.0, 2.0), p(1.0, 1.0), p(0.0, 1.0)];
        assert!((check(&line).unwrap() - 1.0).abs() < 1e-6);
    }

    #[test]
    fn ten_thousand_points_and_hatching_are_bounded() {
        assert!((check(&drawn_circle(10_000, 0.0, 1.02, 0.05)).unwrap() - ops::PI).abs() < 0.2);
        // Hatching from side to side: every stroke crosses many others.
        let hatch: Vec<DVec2> = (0..10_000_u32)
            .map(|i| {
                let k = (i.wrapping_mul(2_654_435_761)) >> 8;
                p(f64::from(k & 0xfff) / 4096.0, f64::from(k >> 12) / 4096.0)
            })
            .collect();
        assert!(check(&hatch).unwrap() > 0.5);
    }

    fn coordinate() -> impl Strategy<Value = f64> {
        prop_oneof![
            8 => (-4..4_i32).prop_map(|i| f64::from(i) * 0.5),
            8 => -2.0..2.0,
            2 => (-4..4_i32, -1.0..1.0).prop_map(|(i, e)| f64::from(i) * 0.5 + e * 1e-9),
            1 => prop::sample::select(vec![f64::NAN, f64::INFINITY, 1e300, -1e300, 1e-300]),
        ]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(400))]
        #[test]
        fn outlines_are_simple(
            points in prop::collection::vec((coordinate(), coordinate()).prop_map(|(x, y)| p(x, y)), 0..60),
            scale in prop::sample::select(vec![1.0, 1e-8, 1e8, 1e90]),
            shift in prop::sample::select(vec![0.0, 1.0, 1e6, -1e12]),
        ) {
            let points: Vec<DVec2> = points.into_iter().map(|q| q * scale + DVec2::splat(shift)).collect();
            check(&points);
        }

        #[test]
        fn wobbly_circles_keep_their_area(from in 0.0..6.0, turns in 0.95..1.3, wobble in 0.0..0.06) {
            let area = check(&drawn_circle(150, from, turns, wobble));
            prop_assert!(area.is_some_and(|a| (a - ops::PI).abs() < 0.5), "{:?}", area);
        }
    }
}
