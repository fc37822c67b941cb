//! Rings of outlines that all point away from a common centre.
//!
//! `spokes -> wheels`
//!
//! Mean shift on roots finds petals that begin at one point. If they begin on a ring around an undrawn centre, no
//! bandwidth that is a share of a petal fits: a wide one takes leaves for petals, a narrow one splits the ring. So the
//! spacing in the drawing sets how far a petal searches for its neighbours, and all must point away from one centre.

use base::ops;
use glam::DVec2;

use crate::KdTree2;
use crate::vector::Vector;

/// Fewest petals of a ring: fewer could form one by chance, as two pairs of leaves do.
const FEWEST: usize = 5;
/// Largest ratio of the distance between neighbours on a ring to that of the second nearest: 1 if they are even.
const UNEVEN: f64 = 1.5;
/// Least cosine of the angle between neighbours: five petals have 72 degrees, this allows 100.
const APART: f64 = -0.17;
/// Largest distance of a petal's own line from the centre, as a share of its size: 11 degrees from its tip.
const ASIDE: f64 = 0.2;
/// Largest radius of the ring relative to a petal's size: a wider one is a wreath.
const WIDEST: f64 = 0.8;
/// Widest gap between petals, radians: a fifth of a turn and a half.
const GAP: f64 = 1.9;

/// An outline that may be a petal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spoke {
    /// Point at which the pen began and ended: its root or its tip.
    pub gap: DVec2,
    /// Its centre.
    pub middle: DVec2,
    /// Its longest diameter.
    pub size: f64,
}

/// A ring of petals.
#[derive(Clone, Debug, PartialEq)]
pub struct Wheel {
    /// Common point of their lines.
    pub centre: DVec2,
    /// Rows of the spokes, ascending.
    pub spokes: Vec<usize>,
}

/// Finds the wheels among spokes: 5 or more neighbours that point away from one centre, with no gap wider than 109
/// degrees, that begin within 0.8 of their size from it. A spoke belongs to at most one wheel; spokes that are not
/// finite belong to none.
///
/// Cost: `n log n`.
///
/// ```
/// use glam::DVec2;
/// let spoke = |k: u32| {
///     let way = DVec2::from_angle(f64::from(k) * std::f64::consts::TAU / 8.0);
///     geom::Spoke { gap: way * 0.3, middle: way * 0.6, size: 0.7 }
/// };
/// let spokes: Vec<_> = (0..8).map(spoke).collect();
/// let wheels = geom::wheels(&spokes);
/// assert_eq!(wheels.len(), 1);
/// assert!(wheels[0].spokes.len() == 8 && wheels[0].centre.length() < 1e-9);
/// assert!(geom::wheels(&spokes[..4]).is_empty());
/// ```
pub fn wheels(spokes: &[Spoke]) -> Vec<Wheel> {
    if spokes.len() < FEWEST {
        return Vec::new();
    }
    let groups = neighbours(spokes).into_iter().filter(|group| group.len() >= FEWEST);
    groups.filter_map(|group| wheel(spokes, group)).collect()
}

/// Groups neighbouring outlines: on a ring each has one on either side, so the second nearest sets the distance of the
/// search, and neighbours point nearly the same way. Petals of two flowers that touch point at one another.
fn neighbours(spokes: &[Spoke]) -> Vec<Vec<usize>> {
    let sound = |s: &Spoke| s.gap.usable() && s.middle.usable() && s.size.is_finite();
    let sound: Vec<usize> = (0..spokes.len()).filter(|&i| sound(&spokes[i])).collect();
    let n = sound.len();
    let middles: Vec<DVec2> = sound.iter().map(|&i| spokes[i].middle).collect();
    let tree = KdTree2::new(&middles);
    let second: Vec<f64> = middles
        .iter()
        .map(|&m| {
            let mut nearest = [f64::INFINITY; 3];
            tree.nearest_distances(m, &mut nearest);
            nearest[2]
        })
        .collect();
    let way: Vec<DVec2> = sound.iter().map(|&i| along(&spokes[i]).unwrap_or_default()).collect();
    let near = |i: usize, j: usize| {
        way[i].dot(way[j]) > APART && middles[i].distance(middles[j]) <= UNEVEN * second[i].min(second[j])
    };
    let mut found = Vec::new();
    let mut group_of: Vec<Option<usize>> = vec![None; n];
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for start in 0..n {
        if group_of[start].is_some() {
            continue;
        }
        group_of[start] = Some(groups.len());
        let mut group = vec![start];
        let mut next = 0;
        while let Some(&i) = group.get(next) {
            next += 1;
            // Outlines that coincide, or have fewer than two neighbours, set no distance for the search.
            if !(second[i] > 0.0 && second[i].is_finite()) {
                continue;
            }
            found.clear();
            tree.within(middles[i], UNEVEN * second[i], &mut found);
            for &j in &found {
                if group_of[j].is_none() && near(i, j) {
                    group_of[j] = Some(groups.len());
                    group.push(j);
                }
            }
        }
        group.sort_unstable();
        groups.push(group.into_iter().map(|i| sound[i]).collect());
    }
    groups
}

/// Returns the wheel that a group forms, leaving out at most a quarter of it.
fn wheel(spokes: &[Spoke], mut group: Vec<usize>) -> Option<Wheel> {
    let whole = group.len();
    let mut centre = meeting(spokes, &group)?;
    for _ in 0..3 {
        let before = group.len();
        group.retain(|&i| {
            let b = &spokes[i];
            along(b).is_some_and(|d| (b.middle - centre).perp_dot(d).abs() < ASIDE * b.size)
        });
        if group.len() < FEWEST || group.len() * 4 < whole * 3 {
            return None;
        }
        if group.len() == before {
            break;
        }
        centre = meeting(spokes, &group)?;
    }
    let rooted = |&i: &usize| {
        let s = &spokes[i];
        let (out, begun) = (s.middle.distance(centre), s.gap.distance(centre));
        // A petal that was begun at its tip has its root as far on the other side of its centre.
        let foot = if begun < out { begun } else { (2.0 * out - begun).max(0.0) };
        foot < WIDEST * s.size && foot + 0.2 * s.size < out
    };
    if !group.iter().all(rooted) {
        return None;
    }
    let widest = widest_gap(group.iter().map(|&i| spokes[i].middle - centre));
    (widest < GAP).then_some(Wheel { centre, spokes: group })
}

/// Returns the widest angle between neighbouring directions, radians: a whole turn for a single one or none.
///
/// Cost: `n log n`.
///
/// ```
/// use glam::DVec2;
/// let widest = geom::widest_gap([DVec2::X, DVec2::Y].into_iter());
/// assert!((widest - 1.5 * std::f64::consts::PI).abs() < 1e-12);
/// ```
pub fn widest_gap(ways: impl Iterator<Item = DVec2>) -> f64 {
    let mut angles: Vec<f64> = ways.map(|v| ops::atan2(v.y, v.x)).collect();
    base::sort_numbers(&mut angles);
    let around = angles.first().zip(angles.last()).map_or(ops::TAU, |(a, b)| a + ops::TAU - b);
    angles.windows(2).map(|w| w[1] - w[0]).fold(around, f64::max)
}

/// Returns the direction of an outline, away from or towards its start.
fn along(spoke: &Spoke) -> Option<DVec2> {
    (spoke.middle - spoke.gap).try_normalize()
}

/// Returns the point nearest to all lines (least squares); `None` if they are parallel.
fn meeting(spokes: &[Spoke], group: &[usize]) -> Option<DVec2> {
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    let mut right = DVec2::ZERO;
    for &i in group {
        let Some(across) = along(&spokes[i]).map(DVec2::perp) else { continue };
        xx += across.x * across.x;
        xy += across.x * across.y;
        yy += across.y * across.y;
        right += across * across.dot(spokes[i].middle);
    }
    let det = xx * yy - xy * xy;
    // For n lines in all directions it is n^2 / 4.
    (det > 1e-3 * (xx + yy) * (xx + yy))
        .then(|| DVec2::new((yy * right.x - xy * right.y) / det, (xx * right.y - xy * right.x) / det))
}
