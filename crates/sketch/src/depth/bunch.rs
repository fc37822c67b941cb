//! Bunches: fruits that touch one another all round (grapes, berries) fill a volume instead of a plane, and those that are
//! partly hidden are completed behind the others.

use std::borrow::Cow;

use base::ops;
use geom::{KdTree2, bounds, centroid, distance_to_polyline, signed_area};
use glam::DVec2;
use reading::FruitReading;

/// Requirements of a bunch.
struct BunchLimits {
    /// Fewest fruits.
    fewest: usize,
    /// Fruits touch if their middles are nearer than this factor of both radii.
    touch: f64,
    /// Mean number of fruits that each touches: in a row, as peas in a pod, it is below 2.
    neighbours: f64,
    /// The smallest radius is at least this share of the largest.
    alike: f64,
    /// Fruits within this many radii of one another in height are at one level.
    level: f64,
    /// A bunch reaches beyond the middles of its outermost fruits by this share of their radius.
    beyond: f64,
    /// A fruit may be partly hidden if its area is below this share of that of the usual fruit.
    hidden: f64,
    /// The free part of the outline of a hidden fruit lies within this share of the radius from a circle.
    round: f64,
    /// A point of an outline is free if it lies farther than this share of the radius from the outlines of all others.
    free: f64,
    /// Points of a completed outline.
    points: u32,
}

const BUNCH: BunchLimits = BunchLimits {
    fewest: 5,
    touch: 1.25,
    neighbours: 2.0,
    alike: 0.45,
    level: 1.2,
    beyond: 0.5,
    hidden: 0.85,
    round: 0.15,
    free: 0.2,
    points: 48,
};

/// A fruit as it is placed.
pub(crate) struct Placed<'a> {
    pub(crate) fruit: Cow<'a, FruitReading>,
    /// Distance towards the viewer from its place in the plane of the drawing, ink units.
    pub(crate) depth: f64,
}

/// Gives the fruits of bunches a depth: each lies on the surface that the bunch has if it is turned about its middle at
/// that height, by turns in front and behind. Fruits that are partly hidden become whole and lie behind. Cost: the number of
/// fruits, times its logarithm and the numbers of those that each touches or that lie at its level.
pub(crate) fn fill_bunches(fruits: &[FruitReading]) -> Vec<Placed<'_>> {
    let mut placed: Vec<Placed<'_>> =
        fruits.iter().map(|f| Placed { fruit: Cow::Borrowed(f), depth: 0.0 }).collect();
    let balls: Vec<Ball> = fruits.iter().map(Ball::new).collect();
    let touching = touching(&balls);
    for mut bunch in bunches(&balls, &touching) {
        base::sort_by(&mut bunch, |&a, &b| {
            let (p, q) = (balls[a].middle, balls[b].middle);
            q.y.total_cmp(&p.y).then(p.x.total_cmp(&q.x))
        });
        let usual = usual_radius(&balls, &bunch);
        for (k, &row) in bunch.iter().enumerate() {
            let whole =
                completed(&fruits[row].outline, touching[row].iter().map(|&k| &fruits[k].outline), usual);
            let is_front = k % 2 == 0 && whole.is_none();
            let depth = depth_in(&balls, &bunch, k);
            placed[row].depth = if is_front { depth } else { -depth };
            if let Some(outline) = whole {
                placed[row].fruit.to_mut().outline = outline;
            }
        }
    }
    placed
}

/// A fruit as a circle. Half of one that is hidden is as wide as the whole.
struct Ball {
    middle: DVec2,
    radius: f64,
}

impl Ball {
    fn new(fruit: &FruitReading) -> Self {
        let size = bounds(&fruit.outline).map_or(DVec2::ZERO, |(low, high)| high - low);
        Self { middle: centroid(&fruit.outline), radius: 0.5 * size.max_element() }
    }

    fn touches(&self, other: &Self) -> bool {
        self.middle.distance(other.middle) < BUNCH.touch * (self.radius + other.radius)
    }
}

/// Returns for each fruit the rows of those that touch it.
fn touching(balls: &[Ball]) -> Vec<Vec<usize>> {
    let tree = KdTree2::new(&balls.iter().map(|b| b.middle).collect::<Vec<_>>());
    let largest = balls.iter().map(|b| b.radius).fold(0.0, f64::max);
    let near = |(row, ball): (usize, &Ball)| {
        let mut found = Vec::new();
        tree.within(ball.middle, BUNCH.touch * (ball.radius + largest), &mut found);
        found.retain(|&k| k != row && balls[k].touches(ball));
        found
    };
    balls.iter().enumerate().map(near).collect()
}

/// Returns the rows of the fruits of each bunch.
fn bunches(balls: &[Ball], touching: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let mut is_taken = vec![false; balls.len()];
    let mut found = Vec::new();
    for first in 0..balls.len() {
        if core::mem::replace(&mut is_taken[first], true) {
            continue;
        }
        let mut bunch = vec![first];
        let mut next = 0;
        while next < bunch.len() {
            for &k in &touching[bunch[next]] {
                if !core::mem::replace(&mut is_taken[k], true) {
                    bunch.push(k);
                }
            }
            next += 1;
        }
        if is_bunch(balls, touching, &bunch) {
            found.push(bunch);
        }
    }
    found
}

fn is_bunch(balls: &[Ball], touching: &[Vec<usize>], rows: &[usize]) -> bool {
    let contacts: usize = rows.iter().map(|&k| touching[k].len()).sum();
    let radii = || rows.iter().map(|&k| balls[k].radius);
    let (least, most) = radii().fold((f64::INFINITY, 0.0_f64), |(l, m), r| (l.min(r), m.max(r)));
    #[expect(clippy::cast_precision_loss, reason = "numbers of fruits")]
    let mean = contacts as f64 / rows.len().max(1) as f64;
    rows.len() >= BUNCH.fewest && mean > BUNCH.neighbours && least >= BUNCH.alike * most
}

fn usual_radius(balls: &[Ball], rows: &[usize]) -> f64 {
    let mut radii: Vec<f64> = rows.iter().map(|&k| balls[k].radius).collect();
    base::sort_numbers(&mut radii);
    // Hidden fruits look smaller: the upper quartile.
    radii[radii.len() * 3 / 4]
}

/// Returns how far a fruit lies from the plane through the middle of its bunch. `bunch`: from the highest to the lowest.
fn depth_in(balls: &[Ball], bunch: &[usize], place: usize) -> f64 {
    let own = &balls[bunch[place]];
    let is_level = |b: &&Ball| (b.middle.y - own.middle.y).abs() < BUNCH.level * own.radius;
    let above = bunch[..place].iter().rev().map(|&k| &balls[k]).take_while(is_level);
    let below = bunch[place + 1..].iter().map(|&k| &balls[k]).take_while(is_level);
    let (left, right) = above
        .chain(below)
        .fold((own.middle.x, own.middle.x), |(l, r), b| (l.min(b.middle.x), r.max(b.middle.x)));
    let half = 0.5 * (right - left) + BUNCH.beyond * own.radius;
    let aside = own.middle.x - 0.5 * (left + right);
    (half * half - aside * aside).max(0.0).sqrt()
}

/// Returns the whole outline of a fruit that is partly hidden by others, which touch it: the circle through the free part
/// of its outline.
fn completed<'a>(
    outline: &[DVec2],
    others: impl Iterator<Item = &'a Vec<DVec2>>,
    usual: f64,
) -> Option<Vec<DVec2>> {
    if signed_area(outline).abs() > BUNCH.hidden * ops::PI * usual * usual {
        return None;
    }
    let rings: Vec<Vec<DVec2>> = others.map(|o| o.iter().chain(o.first()).copied().collect()).collect();
    let is_far =
        |ring: &Vec<DVec2>, p: DVec2| distance_to_polyline(ring, p).is_none_or(|d| d > BUNCH.free * usual);
    let is_free = |p: &DVec2| rings.iter().all(|ring| is_far(ring, *p));
    let free: Vec<DVec2> = outline.iter().copied().filter(is_free).collect();
    let middle = middle_of_arc(&free)?;
    let is_round = free.iter().all(|p| (p.distance(middle) - usual).abs() < BUNCH.round * usual);
    is_round.then(|| {
        (0..BUNCH.points)
            .map(|k| {
                let (sin, cos) = ops::sin_cos(ops::TAU * f64::from(k) / f64::from(BUNCH.points));
                middle + DVec2::new(cos, sin) * usual
            })
            .collect()
    })
}

/// Returns the middle of the circle that fits an arc best: the algebraic fit of Kasa (1976), from moments about the
/// arc's mean.
fn middle_of_arc(arc: &[DVec2]) -> Option<DVec2> {
    /// Fewest points of an arc.
    const FEWEST: usize = 5;
    if arc.len() < FEWEST {
        return None;
    }
    #[expect(clippy::cast_precision_loss, reason = "points are few")]
    let mean = arc.iter().sum::<DVec2>() / arc.len() as f64;
    let sum = |moment: fn(DVec2) -> f64| arc.iter().map(|p| moment(*p - mean)).sum::<f64>();
    let (xx, xy, yy) = (sum(|d| d.x * d.x), sum(|d| d.x * d.y), sum(|d| d.y * d.y));
    let (x, y) = (sum(|d| d.x * d.length_squared()), sum(|d| d.y * d.length_squared()));
    let det = xx * yy - xy * xy;
    let offset = DVec2::new(x * yy - y * xy, y * xx - x * xy) / (2.0 * det);
    (det > 0.0 && offset.is_finite()).then(|| mean + offset)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circle(x: f64, y: f64, r: f64) -> FruitReading {
        let at = |k: u32| {
            let (sin, cos) = ops::sin_cos(ops::TAU * f64::from(k) / 32.0);
            DVec2::new(x + r * cos, y + r * sin)
        };
        let outline = (0..32).map(at).collect();
        FruitReading { outline, bearer: None, source: None, color: None }
    }

    fn grapes() -> Vec<FruitReading> {
        let places = [(0.0, 2.0), (1.0, 2.0), (2.0, 2.0), (0.5, 1.15), (1.5, 1.15), (1.0, 0.3)];
        places.iter().map(|&(x, y)| circle(x * 0.2, y * 0.2, 0.1)).collect()
    }

    #[test]
    fn a_bunch_has_depth_and_a_row_has_none() {
        let grapes = grapes();
        let placed = fill_bunches(&grapes);
        assert!(placed.iter().any(|p| p.depth > 0.1) && placed.iter().any(|p| p.depth < -0.05));
        let row: Vec<FruitReading> = (0..6).map(|k| circle(0.2 * f64::from(k), 0.0, 0.1)).collect();
        assert!(fill_bunches(&row).iter().all(|p| p.depth == 0.0));
    }

    #[test]
    fn a_hidden_grape_is_whole_behind_the_others() {
        let mut grapes = grapes();
        // The lower half of the middle grape of the first row is visible.
        grapes[5].outline.retain(|p| p.y < 0.06);
        let placed = fill_bunches(&grapes);
        let area = signed_area(&placed[5].fruit.outline).abs();
        assert!((area / (ops::PI * 0.01) - 1.0).abs() < 0.1, "{area}");
        assert!(placed[5].depth < 0.0);
        assert!(placed[..5].iter().all(|p| matches!(p.fruit, Cow::Borrowed(_))));
    }
}
