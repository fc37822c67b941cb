//! A vein graph whose chief veins start together -> [`Rays`].
//!
//! largest piece -> hub from which thick veins part -> chief veins -> margin between them -> rays

use base::{Report, ops};
use glam::{DVec2, DVec3};

use crate::graph::{GraphError, Net, VeinGraph, median_near, trace};
use crate::rays::{ChiefVein, Rays};

/// Marks on each ray, including the base.
const MARKS: usize = 9;
/// Rays between two chief veins.
const BETWEEN: usize = 7;
/// Rays from the outermost chief vein back to the stalk.
const OUTER: usize = 5;

/// A thick vein that leaves the hub.
struct Chief {
    /// Node at its end.
    tip: u32,
    /// Mean radius at its start.
    radius: f64,
    /// Angle of its tip at the hub, anticlockwise from +x.
    angle: f64,
}

/// A hub from which thick veins part, and the cheapest paths from there.
struct Hub {
    at: DVec2,
    before: Vec<u32>,
    chiefs: Vec<Chief>,
    /// Nodes of the stalk.
    stalk: Vec<bool>,
}

impl VeinGraph {
    /// Returns the chief veins and the margin of a palmate leaf; `None` if the network has one midrib
    /// ([`VeinGraph::marks`]).
    ///
    /// A leaf is palmate if three or more veins leave one point, the outer ones at least a third as thick and as long
    /// as the thickest, those next to the middle one half as long as it, the middle one among the thickest, and nothing
    /// but a stalk on the opposite side. Between chief veins the blade reaches as far as the network does. The middle
    /// vein stands upright, base at the origin. Not kept: the small veins. Cost: n log n in the nodes, for at most 25
    /// points.
    ///
    /// # Errors
    /// [`GraphError`].
    pub fn rays(&self, report: &mut Report) -> Result<Option<Rays>, GraphError> {
        let net = Net::new(self, report)?;
        let thickest = net.members.iter().map(|&k| net.radius(k)).fold(0.0, f64::max);
        let thick: Vec<u32> =
            net.members.iter().copied().filter(|&k| net.radius(k) >= 0.6 * thickest).collect();
        // Joints first: veins part only there.
        let joints: Vec<u32> = thick.iter().copied().filter(|&k| net.near[k as usize].len() > 2).collect();
        let places = if joints.is_empty() { thick } else { joints };
        let step = places.len().div_ceil(24).max(1);
        let hubs = places.iter().step_by(step).filter_map(|&k| hub(&net, k));
        let best = hubs.reduce(|a, b| {
            let key = |h: &Hub| (h.chiefs.len(), h.chiefs.iter().map(|c| c.radius).sum::<f64>());
            if key(&b) > key(&a) { b } else { a }
        });
        Ok(best.map(|h| rays_of(&net, &h)))
    }
}

/// Returns the veins that leave `centre`, if they are those of a palmate leaf.
fn hub(net: &Net<'_>, centre: u32) -> Option<Hub> {
    let at = net.node_position(centre);
    let far = |k: u32| net.node_position(k).distance(at);
    let reach = net.members.iter().map(|&k| far(k)).fold(0.0, f64::max);
    let near = 0.12 * reach;
    let (cost, before) = net.ways(&[centre]);
    // Every node beyond the circle belongs to the first node outside it on its path; nearer nodes come first.
    let mut order = net.members.clone();
    base::sort_by(&mut order, |&a, &b| cost[a as usize].total_cmp(&cost[b as usize]).then(a.cmp(&b)));
    let mut gate = vec![u32::MAX; before.len()];
    let mut gates: Vec<u32> = Vec::new();
    let mut count = vec![0_usize; before.len()];
    let mut tip = vec![u32::MAX; before.len()];
    for &k in &order {
        let parent = before[k as usize];
        let from = if parent == u32::MAX { u32::MAX } else { gate[parent as usize] };
        let own = if from != u32::MAX {
            from
        } else if far(k) > near {
            gates.push(k);
            k
        } else {
            continue;
        };
        gate[k as usize] = own;
        count[own as usize] += 1;
        let t = tip[own as usize];
        if t == u32::MAX || far(k) > far(t) {
            tip[own as usize] = k;
        }
    }
    let mut chiefs = Vec::new();
    let mut stalk = vec![false; before.len()];
    for &g in &gates {
        let end = tip[g as usize];
        let way = trace(&before, end);
        let outside = way.iter().filter(|&&k| far(k) > near).count();
        // A stalk is a line: nothing leaves it.
        if 10 * count[g as usize] <= 12 * outside && outside > 3 && far(end) > 0.15 * reach {
            for &k in &net.members {
                stalk[k as usize] |= gate[k as usize] == g;
            }
            continue;
        }
        let ring: Vec<f64> = way
            .iter()
            .filter(|&&k| (0.5 * near..1.5 * near).contains(&far(k)))
            .map(|&k| net.radius(k))
            .collect();
        let radius = ring.iter().sum::<f64>() / ring.len().max(1) as f64;
        let d = net.node_position(end) - at;
        chiefs.push(Chief { tip: end, radius, angle: ops::atan2(d.y, d.x) });
    }
    let widest = chiefs.iter().map(|c| c.radius).fold(0.0, f64::max);
    let longest = chiefs.iter().map(|c| far(c.tip)).fold(0.0, f64::max);
    chiefs.retain(|c| c.radius >= 0.33 * widest && far(c.tip) >= 0.33 * longest);
    if chiefs.len() < 3 || chiefs.len() > 15 {
        return None;
    }
    base::sort_by(&mut chiefs, |a, b| a.angle.total_cmp(&b.angle));
    // The stalk enters in the widest gap: the order begins after it.
    let n = chiefs.len();
    let gap = |i: usize| {
        let d = chiefs[(i + 1) % n].angle - chiefs[i].angle;
        if d <= 0.0 { d + ops::TAU } else { d }
    };
    let widest_gap = (0..n).max_by(|&a, &b| gap(a).total_cmp(&gap(b)).then(b.cmp(&a)))?;
    // 75 degrees.
    if gap(widest_gap) < 1.3 {
        return None;
    }
    chiefs.rotate_left((widest_gap + 1) % n);
    // On a midrib that continues in both directions the vein opposite to the gap is a side vein.
    let middle = chiefs.get(n / 2).filter(|c| c.radius >= 0.75 * widest)?;
    // The basal pair of side veins of a leaf with a midrib is short; the lobes next to the middle one are not.
    let m = n / 2;
    let neighbours = [m.checked_sub(1).and_then(|i| chiefs.get(i)), chiefs.get(m + 1)];
    let long = |c: Option<&Chief>, share: f64| c.is_some_and(|c| far(c.tip) >= share * far(middle.tip));
    if far(middle.tip) < 0.7 * longest || !neighbours.into_iter().all(|c| long(c, 0.5)) {
        return None;
    }
    // No vein goes back next to the stalk, and the sides are alike; neither holds for a midrib that continues in both
    // directions.
    let spread =
        [chiefs.first(), chiefs.last()].map(|c| c.map_or(0.0, |c| wrapped(c.angle - middle.angle).abs()));
    let [narrow, wide] = [spread[0].min(spread[1]), spread[0].max(spread[1])];
    if narrow < 0.35 || wide > 2.45 || wide > 1.8 * narrow {
        return None;
    }
    Some(Hub { at, before, chiefs, stalk })
}

/// Returns an angle in (-pi, pi].
fn wrapped(angle: f64) -> f64 {
    let turned = (angle + ops::PI).rem_euclid(ops::TAU);
    turned - ops::PI
}

/// Positions and thickness along a chief vein, at even lengths, in the hub's frame as angle (right is positive) and
/// distance.
struct Line {
    angle: [f64; MARKS],
    far: [f64; MARKS],
    thickness: [f64; MARKS],
}

fn rays_of(net: &Net<'_>, hub: &Hub) -> Rays {
    let up = hub.chiefs[hub.chiefs.len() / 2].angle;
    // Right of the middle vein is clockwise.
    let polar = |p: DVec2| {
        let d = p - hub.at;
        (wrapped(up - ops::atan2(d.y, d.x)), d.length())
    };
    let line = |c: &Chief| {
        let way = trace(&hub.before, c.tip);
        let points: Vec<DVec2> = way.iter().map(|&k| net.node_position(k)).collect();
        let radii: Vec<f64> = way.iter().map(|&k| net.radius(k)).collect();
        let total = geom::polyline_length(&points);
        let mut out = Line { angle: [0.0; MARKS], far: [0.0; MARKS], thickness: [0.0; MARKS] };
        let end = polar(net.node_position(c.tip)).0;
        for m in 0..MARKS {
            let (p, node) = crate::graph::along(&points, total * m as f64 / (MARKS - 1) as f64);
            let (angle, far) = polar(p);
            // Near the hub an angle is meaningless, and a turn of pi is not real.
            out.angle[m] = if m == 0 { end } else { end + wrapped(angle - end) };
            out.far[m] = far;
            out.thickness[m] = 2.0 * median_near(&radii, node);
        }
        out.angle[0] = out.angle[1];
        out
    };
    // Chiefs run anticlockwise, rays from right to left: the same order.
    let lines: Vec<Line> = hub.chiefs.iter().map(line).collect();
    let all: Vec<(f64, f64)> = net
        .members
        .iter()
        .filter(|&&k| !hub.stalk[k as usize])
        .map(|&k| polar(net.node_position(k)))
        .filter(|p| p.1 > 0.0)
        .collect();
    let longest = all.iter().map(|p| p.1).fold(0.0, f64::max);
    // Reach of the network about an angle.
    let margin = |angle: f64, half: f64| {
        let within = all.iter().filter(|p| wrapped(p.0 - angle).abs() <= half).map(|p| p.1);
        within.fold(0.0, f64::max).max(0.05 * longest)
    };
    let mut out = Rays::default();
    let mut ray =
        |angle: &dyn Fn(usize) -> f64, far: &dyn Fn(usize) -> f64, thickness: Option<[f64; MARKS]>| {
            let points = (0..MARKS).map(|m| {
                let (s, c) = ops::sin_cos(angle(m));
                DVec3::new(far(m) * s, far(m) * c, 0.0)
            });
            let points = points.collect();
            let thickness = (0..MARKS).map(|m| thickness.map(|t| t[m])).collect();
            out.rays.push(ChiefVein { points, thickness });
        };
    let even = |far: f64| move |m: usize| far * m as f64 / (MARKS - 1) as f64;
    let outer = |line: &Line, side: f64| {
        let end = side * line.angle[MARKS - 1];
        let beyond = all.iter().filter(|p| p.1 > 0.08 * longest).map(|p| side * p.0);
        // The blade ends before the stalk, 10 degrees from straight down.
        let limit = beyond.filter(|a| *a > 0.0).fold(end + 0.1, f64::max).min(ops::PI - 0.17).max(end + 0.05);
        (end, limit)
    };
    let last = MARKS - 1;
    let sides = [(0, 1.0), (lines.len() - 1, -1.0)];
    for k in (1..=OUTER).rev() {
        let line = &lines[sides[0].0];
        let (end, limit) = outer(line, 1.0);
        let add = (limit - end) * k as f64 / OUTER as f64;
        ray(
            &|m| line.angle[m] + add,
            &even(margin(line.angle[last] + add, 0.5 * (limit - end) / OUTER as f64)),
            None,
        );
    }
    for (i, line) in lines.iter().enumerate() {
        ray(&|m| line.angle[m], &|m| line.far[m], Some(line.thickness));
        let Some(next) = lines.get(i + 1) else { continue };
        let half = 0.5 * (line.angle[last] - next.angle[last]).abs() / (BETWEEN + 1) as f64;
        for k in 1..=BETWEEN {
            let w = k as f64 / (BETWEEN + 1) as f64;
            let angle = |m: usize| ops::lerp(line.angle[m], next.angle[m], w);
            ray(&angle, &even(margin(angle(last), half)), None);
        }
    }
    for k in 1..=OUTER {
        let line = &lines[sides[1].0];
        let (end, limit) = outer(line, -1.0);
        let add = (limit - end) * k as f64 / OUTER as f64;
        ray(
            &|m| line.angle[m] - add,
            &even(margin(line.angle[last] - add, 0.5 * (limit - end) / OUTER as f64)),
            None,
        );
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::index;
    use crate::{PalmateSpec, RayLeaf, ThicknessRule};

    /// Makes the network of a palmate leaf: chief veins, the side veins of their lobes, twigs of these, a stalk.
    fn network(veins: u32, turn: f64, stalk: bool) -> VeinGraph {
        let rays = Rays::palmate(&PalmateSpec { veins, ..PalmateSpec::default() });
        let mut leaf = RayLeaf::new(&rays, ThicknessRule::Diameter).unwrap();
        leaf.add_side_veins(&rays, 5);
        let mut g = VeinGraph::default();
        let (s, c) = ops::sin_cos(turn);
        let add = |g: &mut VeinGraph, p: DVec3, r: f64| {
            g.nodes.push(DVec2::new(c * p.x - s * p.y, s * p.x + c * p.y) + DVec2::new(0.3, -0.2));
            g.radii.push(r);
            index(g.nodes.len() - 1)
        };
        let hub = add(&mut g, DVec3::ZERO, 0.0009);
        let nearest = |g: &VeinGraph, k: u32| {
            let p = g.nodes[k as usize];
            let others = (0..g.nodes.len()).filter(|&i| i != k as usize);
            index(others.min_by(|&a, &b| g.nodes[a].distance(p).total_cmp(&g.nodes[b].distance(p))).unwrap())
        };
        for vein in &leaf.veins {
            let mut before = hub;
            for k in 1..=120 {
                let ball = vein.curve.ball(f64::from(k) / 120.0);
                let here = add(&mut g, ball.centre, ball.radius);
                g.edges.push([before, here]);
                before = here;
            }
        }
        for side in &leaf.sides {
            let mut before = u32::MAX;
            for k in 0..=30 {
                let ball = side.curve.ball(f64::from(k) / 30.0);
                let here = add(&mut g, ball.centre + DVec3::X * 1e-6, ball.radius);
                let other = if before == u32::MAX { nearest(&g, here) } else { before };
                g.edges.push([other, here]);
                before = here;
                if k % 5 == 3 {
                    let twig = add(&mut g, ball.centre + DVec3::new(0.001, 0.0012, 0.0), 0.00004);
                    g.edges.push([here, twig]);
                }
            }
        }
        if stalk {
            let mut before = hub;
            for k in 1..=40 {
                let here = add(&mut g, DVec3::NEG_Y * (0.0012 * f64::from(k)), 0.001);
                g.edges.push([before, here]);
                before = here;
            }
        }
        g
    }

    #[test]
    fn chief_veins_of_a_network_come_back() {
        for (veins, turn, stalk) in [(5, 0.0, true), (5, 2.0, false), (7, -1.1, true), (3, 0.5, true)] {
            let rays = network(veins, turn, stalk).rays(&mut Report::default()).unwrap().expect("palmate");
            assert_eq!(rays.validate().next(), None, "{veins} {turn}");
            let found: Vec<&ChiefVein> = rays.rays.iter().filter(|r| r.is_vein()).collect();
            assert_eq!(found.len(), veins as usize, "{turn}");
            let given = Rays::palmate(&PalmateSpec { veins, ..PalmateSpec::default() });
            for (a, b) in found.iter().zip(given.rays.iter().filter(|r| r.is_vein())) {
                let (a, b) = (a.points[MARKS - 1], b.points[8]);
                assert!(a.truncate().distance(b.truncate()) < 0.004, "{veins} {turn}: {a} instead of {b}");
            }
            let middle = found[veins as usize / 2];
            let thickness = middle.thickness[2].unwrap();
            assert!((thickness - 0.0012).abs() < 0.0004, "{thickness}");
            let leaf = RayLeaf::new(&rays, ThicknessRule::Diameter).unwrap();
            assert!(leaf.vein_gap(8) < 1e-9, "{}", leaf.vein_gap(8));
        }
    }
}
