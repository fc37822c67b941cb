//! The margin around a network of veins: as close around the veins as their meshes allow.

use base::Report;
use geom::{AlphaShape, KdTree2};
use glam::DVec2;

use crate::graph::{GraphError, Net, VeinGraph};

/// Spacing of the points that stand for a vein between two nodes, in widths of the median vein.
const STEP: f64 = 0.5;
/// Ratio of successive radii of the alpha shape that are tried.
const WIDER: f64 = 1.15;
/// Most nodes that a margin may exclude, as a share of all: the first radius that satisfies this is taken.
const LEFT_OUT: f64 = 0.005;
/// Most area that may stay open in meshes of the network, as a share of the whole.
const OPEN: f64 = 0.002;
/// Widest bay of a margin, as a share of the leaf's length.
const WIDEST: f64 = 0.25;
/// Tolerance for leaving out points of the margin, as a share of the median vein's radius.
const EVEN: f64 = 0.5;
/// Longest extension of a corner, in radii.
const MITRE: f64 = 2.5;

impl VeinGraph {
    /// Returns the margin around the largest connected piece of the network, counter-clockwise, in the network's own
    /// coordinates; `None` if there is none. It is that of [`marks`](Self::marks).
    ///
    /// # Errors
    /// [`GraphError`].
    pub fn margin(&self) -> Result<Option<Vec<DVec2>>, GraphError> {
        let net = Net::new(self, &mut Report::default())?;
        Ok(self.outline(&net.members))
    }

    /// Returns the margin of the leaf, counter-clockwise, a vein's radius outside the outermost veins: an alpha shape
    /// (Edelsbrunner, Kirkpatrick and Seidel 1983) of the veins.
    ///
    /// `members` are the nodes to enclose. The radius is the smallest at which the shape encloses all but 0.5 % of them
    /// in one piece, with the network's own meshes closed. `None` if there is none: for networks without area. Cost: n
    /// log n, some thirty times.
    pub(crate) fn outline(&self, members: &[u32]) -> Option<Vec<DVec2>> {
        let at = |k: u32| self.nodes.get(k as usize).copied();
        let mut lengths: Vec<f64> = self
            .edges
            .iter()
            .filter_map(|&[a, b]| Some(at(a)?.distance(at(b)?)))
            .filter(|l| *l > 0.0)
            .collect();
        base::sort_numbers(&mut lengths);
        let step = STEP * lengths.get(lengths.len() / 2)?;
        // The radius of the vein at each point.
        let mut points = self.nodes.clone();
        let mut radii = self.radii.clone();
        for &[a, b] in &self.edges {
            let (p, q) = (at(a)?, at(b)?);
            let (r, s) = (self.radii.get(a as usize)?, self.radii.get(b as usize)?);
            // 64: a vein of that length has no bay next to it that is this narrow.
            let parts = (p.distance(q) / step).ceil().clamp(1.0, 64.0);
            let mut k = 1.0;
            while k < parts {
                points.push(p.lerp(q, k / parts));
                radii.push(base::ops::lerp(*r, *s, k / parts));
                k += 1.0;
            }
        }
        let (lo, hi) =
            points.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(a, b), &p| (a.min(p), b.max(p)));
        let shape = AlphaShape::new(&points);
        let mut radius = step;
        let line = loop {
            if radius > WIDEST * (hi - lo).max_element() {
                return None;
            }
            radius *= WIDER;
            let Some(found) = shape.outline(radius).filter(|o| o.holes <= OPEN) else { continue };
            let line: Vec<DVec2> = found.points.iter().map(|&k| points[k]).collect();
            let on: std::collections::BTreeSet<usize> = found.points.iter().copied().collect();
            let out = members.iter().filter(|&&k| {
                !on.contains(&(k as usize)) && at(k).is_some_and(|p| !geom::contains(&line, p))
            });
            if out.count() as f64 <= LEFT_OUT * members.len() as f64 {
                break found.points;
            }
        };
        let mut sorted = self.radii.clone();
        base::sort_numbers(&mut sorted);
        let even = EVEN * sorted.get(sorted.len() / 2)?;
        let own: Vec<(DVec2, f64)> = line.iter().map(|&k| (points[k], radii[k])).collect();
        let wide = grown(&own);
        let simple = |line: &[DVec2]| (geom::self_crossings(line) == 0).then(|| line.to_vec());
        let closed: Vec<DVec2> = wide.iter().copied().chain(wide.first().copied()).collect();
        let mut thin = geom::simplify(&closed, even);
        thin.pop();
        let bare: Vec<DVec2> = own.iter().map(|o| o.0).collect();
        simple(&thin).or_else(|| simple(&wide)).or_else(|| simple(&bare))
    }
}

/// Moves a closed counter-clockwise line outwards, each point by its radius.
fn grown(line: &[(DVec2, f64)]) -> Vec<DVec2> {
    let n = line.len();
    let own: Vec<DVec2> = line.iter().map(|l| l.0).collect();
    let around = KdTree2::new(&own);
    let place = |k: usize| {
        let (p, r) = line[k];
        let (before, after) = (own[(k + n - 1) % n], own[(k + 1) % n]);
        let out = |a: DVec2, b: DVec2| (b - a).try_normalize().map_or(DVec2::ZERO, |d| DVec2::new(d.y, -d.x));
        let (a, b) = (out(before, p), out(p, after));
        let Some(middle) = (a + b).try_normalize() else { return p };
        let far = (r / middle.dot(a).max(1.0 / MITRE)).min(MITRE * r);
        // In a narrow bay there is room for only a third of it.
        let mut near = Vec::new();
        around.within(p + middle * far, far, &mut near);
        let free = near.iter().all(|&j| [0, 1, n - 1].contains(&((j + n - k) % n)));
        p + middle * if free { far } else { far / 3.0 }
    };
    (0..n).map(place).collect()
}
