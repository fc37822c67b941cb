//! A vein graph -> marks: the midrib, pairs of side veins, seven marks on each pair.
//!
//! nodes with radii, edges -> largest piece -> midrib (thickest path along the leaf) -> side veins (thickest paths to
//! the margin) -> pairs -> marks

use core::cmp::Ordering;
use std::collections::BinaryHeap;

use base::Report;
use glam::{DVec2, DVec3};

use crate::marks::{MARKS_A_ROW, MarkRow, Marks};

/// The veins of a flat leaf as a network, metres.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VeinGraph {
    /// Points where veins meet, end or bend; x to the right, y upwards, seen on the upper side.
    pub nodes: Vec<DVec2>,
    /// Half the thickness of the vein at each node, above 0.
    pub radii: Vec<f64>,
    /// Pairs of nodes joined by a vein.
    pub edges: Vec<[u32; 2]>,
}

/// Reason why a vein graph makes no leaf.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum GraphError {
    /// A node has no usable place or radius.
    #[error("node {0} has a coordinate that is no number, or a radius that is not above 0")]
    Node(usize),
    /// The numbers of radii and nodes differ.
    #[error("{nodes} nodes have {radii} radii; give each node one")]
    Radii {
        /// Nodes given.
        nodes: usize,
        /// Radii given.
        radii: usize,
    },
    /// An edge names a node that does not exist.
    #[error("edge {edge} joins node {node}, but nodes count from 0 to {last}")]
    Edge {
        /// Index of the edge.
        edge: usize,
        /// The missing node.
        node: u32,
        /// The last node.
        last: usize,
    },
    /// The network is too small.
    #[error("the largest connected piece has {0} nodes; a leaf needs a midrib and side veins: at least 20")]
    TooSmall(usize),
    /// There are fewer than two rows.
    #[error("the network has no margin on both sides of its midrib; is it a whole leaf?")]
    OneSided,
}

/// The prepared network: neighbours of each node, and the leaf's own axis.
pub(crate) struct Net<'a> {
    graph: &'a VeinGraph,
    pub(crate) near: Vec<Vec<u32>>,
    /// Nodes of the largest piece.
    pub(crate) members: Vec<u32>,
}

#[derive(PartialEq)]
struct Open(f64, u32);

impl Eq for Open {}

impl Ord for Open {
    fn cmp(&self, other: &Self) -> Ordering {
        // The cheapest first; equal costs by index, for the same path everywhere.
        other.0.total_cmp(&self.0).then(other.1.cmp(&self.1))
    }
}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<'a> Net<'a> {
    pub(crate) fn new(graph: &'a VeinGraph, report: &mut Report) -> Result<Self, GraphError> {
        let n = graph.nodes.len();
        if graph.radii.len() != n {
            return Err(GraphError::Radii { nodes: n, radii: graph.radii.len() });
        }
        let usable = |k: usize| {
            graph.nodes[k].is_finite()
                && graph.nodes[k].abs().max_element() < 1e6
                && graph.radii[k] > 0.0
                && graph.radii[k] < 1e6
        };
        if let Some(k) = (0..n).find(|&k| !usable(k)) {
            return Err(GraphError::Node(k));
        }
        let mut near = vec![Vec::new(); n];
        for (edge, &[a, b]) in graph.edges.iter().enumerate() {
            if let Some(node) = [a, b].into_iter().find(|&k| k as usize >= n) {
                return Err(GraphError::Edge { edge, node, last: n.saturating_sub(1) });
            }
            if a != b {
                near[a as usize].push(b);
                near[b as usize].push(a);
            }
        }
        let mut piece = vec![u32::MAX; n];
        let mut best: Vec<u32> = Vec::new();
        for start in 0..n {
            if piece[start] != u32::MAX {
                continue;
            }
            let id = index(start);
            let mut members = vec![id];
            piece[start] = id;
            let mut next = 0;
            while let Some(&k) = members.get(next) {
                next += 1;
                for &m in &near[k as usize] {
                    if piece[m as usize] == u32::MAX {
                        piece[m as usize] = id;
                        members.push(m);
                    }
                }
            }
            if members.len() > best.len() {
                best = members;
            }
        }
        if best.len() < 20 {
            return Err(GraphError::TooSmall(best.len()));
        }
        if best.len() < n {
            base::warn!(
                report,
                "nodes-apart",
                { count = n - best.len(), all = n },
                "{count} of {all} nodes hang together with no vein of the leaf and were left out"
            );
        }
        best.sort_unstable();
        Ok(Self { graph, near, members: best })
    }

    pub(crate) fn node_position(&self, k: u32) -> DVec2 {
        self.graph.nodes[k as usize]
    }

    pub(crate) fn radius(&self, k: u32) -> f64 {
        self.graph.radii[k as usize]
    }

    /// Returns the cheapest paths from all of `from`: the cost of each node and the node before it. A vein of twice the
    /// radius is eight times as cheap (the conductance of a pipe is the fourth power; the cube is less sensitive to one
    /// badly measured node).
    pub(crate) fn ways(&self, from: &[u32]) -> (Vec<f64>, Vec<u32>) {
        let n = self.graph.nodes.len();
        let (mut cost, mut before) = (vec![f64::INFINITY; n], vec![u32::MAX; n]);
        let mut open = BinaryHeap::new();
        for &k in from {
            cost[k as usize] = 0.0;
            open.push(Open(0.0, k));
        }
        while let Some(Open(c, k)) = open.pop() {
            if c > cost[k as usize] {
                continue;
            }
            for &m in &self.near[k as usize] {
                let r = 0.5 * (self.radius(k) + self.radius(m));
                let next = c + self.node_position(k).distance(self.node_position(m)) / (r * r * r);
                if next < cost[m as usize] {
                    cost[m as usize] = next;
                    before[m as usize] = k;
                    open.push(Open(next, m));
                }
            }
        }
        (cost, before)
    }

    /// Returns the midrib from the leaf's base to its tip.
    fn midrib(&self) -> Vec<u32> {
        let count = self.members.len() as f64;
        let centre = self.members.iter().map(|&k| self.node_position(k)).sum::<DVec2>() / count;
        let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
        for &k in &self.members {
            let d = self.node_position(k) - centre;
            xx += d.x * d.x;
            xy += d.x * d.y;
            yy += d.y * d.y;
        }
        let half = 0.5 * base::ops::atan2(2.0 * xy, xx - yy);
        let long = DVec2::new(base::ops::cos(half), base::ops::sin(half));
        let along = |k: u32| (self.node_position(k) - centre).dot(long);
        let span = self
            .members
            .iter()
            .map(|&k| along(k))
            .fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x), b.max(x)));
        let thickest = |a: &u32, b: &u32| self.radius(*a).total_cmp(&self.radius(*b)).then(b.cmp(a));
        let start = self.members.iter().copied().max_by(thickest).unwrap_or(0);
        let (cost, before) = self.ways(&[start]);
        // The midrib is the first to reach the outermost twentieth; its end is the farthest point in the same line.
        let end = |sign: f64| {
            let far = if sign > 0.0 { span.1 } else { -span.0 };
            let within = |k: &&u32| sign * along(**k) > far - 0.05 * (span.1 - span.0);
            let cheaper =
                |a: &&u32, b: &&u32| cost[**a as usize].total_cmp(&cost[**b as usize]).then(a.cmp(b));
            let first = self.members.iter().filter(within).min_by(cheaper).copied().unwrap_or(start);
            let way = trace(&before, first);
            // Its direction over the last fifth of its path.
            let back = self.node_position(way[way.len() - 1 - way.len() / 5]);
            let ahead = (self.node_position(first) - back).try_normalize().unwrap_or(long * sign);
            let score = |k: u32| {
                let d = self.node_position(k) - self.node_position(first);
                d.dot(ahead) - 1.5 * d.perp_dot(ahead).abs()
            };
            let ends = self.members.iter().filter(within).copied();
            ends.max_by(|&a, &b| score(a).total_cmp(&score(b)).then(b.cmp(&a))).unwrap_or(first)
        };
        let mut line = trace(&before, end(-1.0));
        line.reverse();
        line.extend(trace(&before, end(1.0)).into_iter().skip(1));
        let third = line.len() / 3;
        let mean =
            |part: &[u32]| part.iter().map(|&k| self.radius(k)).sum::<f64>() / part.len().max(1) as f64;
        if mean(&line[..third]) < mean(&line[line.len() - third..]) {
            line.reverse();
        }
        line
    }
}

pub(crate) fn index(k: usize) -> u32 {
    u32::try_from(k).unwrap_or(u32::MAX)
}

/// Returns the path back from `end` to its start; `end` is last.
pub(crate) fn trace(before: &[u32], end: u32) -> Vec<u32> {
    let mut line = vec![end];
    let mut k = end;
    while let Some(&b) = before.get(k as usize).filter(|&&b| b != u32::MAX) {
        line.push(b);
        k = b;
    }
    line.reverse();
    line
}

/// A side vein: its path from the midrib outwards.
struct Side {
    /// Length along the midrib of its start, and of its end.
    from: f64,
    to: f64,
    line: Vec<DVec2>,
    radii: Vec<f64>,
    /// Evidence that it is a vein.
    strength: f64,
}

/// Smooths the kinks of a line at its side veins, its ends kept: points next to a kink would have no station.
fn evened(mut line: Vec<DVec2>) -> Vec<DVec2> {
    for _ in 0..line.len().min(60) {
        let old = line.clone();
        for i in 1..old.len() - 1 {
            line[i] = 0.25 * old[i - 1] + 0.5 * old[i] + 0.25 * old[i + 1];
        }
    }
    line
}

/// The midrib as a line with arc lengths and sides.
struct Axis {
    points: Vec<DVec2>,
    lengths: Vec<f64>,
}

impl Axis {
    fn new(points: Vec<DVec2>) -> Self {
        let mut sum = 0.0;
        let mut lengths = vec![0.0];
        lengths.extend(points.windows(2).map(|w| {
            sum += w[0].distance(w[1]);
            sum
        }));
        Self { points, lengths }
    }

    fn length(&self) -> f64 {
        self.lengths.last().copied().unwrap_or(0.0)
    }

    /// Returns the length along the line of the nearest point, and the signed distance from it (right is positive).
    fn place(&self, p: DVec2) -> (f64, f64) {
        let mut best = (f64::INFINITY, 0.0, 0.0);
        for (w, s) in self.points.windows(2).zip(&self.lengths) {
            let d = w[1] - w[0];
            let l = d.length();
            if l <= 0.0 {
                continue;
            }
            let t = ((p - w[0]).dot(d) / (l * l)).clamp(0.0, 1.0);
            let off = p - (w[0] + d * t);
            let gap = off.length();
            if gap < best.0 {
                best = (gap, s + t * l, -d.perp_dot(p - w[0]).signum() * gap);
            }
        }
        (best.1, best.2)
    }

    fn point_at(&self, s: f64) -> DVec2 {
        let k = self.lengths.partition_point(|&l| l < s).clamp(1, self.points.len() - 1);
        let (a, b) = (self.lengths[k - 1], self.lengths[k]);
        let t = if b > a { ((s - a) / (b - a)).clamp(0.0, 1.0) } else { 0.0 };
        self.points[k - 1].lerp(self.points[k], t)
    }
}

/// Returns the margin on one side: the greatest reach of the network from the midrib at even stations.
fn margin(places: &[(f64, f64)], side: f64, length: f64) -> Vec<f64> {
    const STATIONS: usize = 60;
    let mut reach = vec![0.0_f64; STATIONS + 1];
    for &(s, off) in places {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to STATIONS")]
        let k = (s / length * STATIONS as f64).round().clamp(0.0, STATIONS as f64) as usize;
        for near in reach[k.saturating_sub(1)..(k + 2).min(STATIONS + 1)].iter_mut() {
            *near = near.max(side * off);
        }
    }
    reach
}

fn reach_at(reach: &[f64], share: f64) -> f64 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the stations")]
    let k = (share * (reach.len() - 1) as f64).round().clamp(0.0, (reach.len() - 1) as f64) as usize;
    reach[k]
}

impl VeinGraph {
    /// Returns the marks of the leaf of this network: one row for each pair of side veins, and one at the base.
    ///
    /// The midrib is the thickest path from one end of the leaf to the other, its thicker end the base; side veins are
    /// the thickest paths from there to the margin, none crossing another. A pair leaves the midrib from one mark, half
    /// way between the two where they alternate. Marks lie at equal lengths along a vein, thickness is twice the
    /// radius. The margin is as close around the network as its meshes allow. The marks stand upright: the root at the
    /// origin, the tip on +Y, the upper side towards +Z.
    /// Not kept: the small veins between. Cost: n log n in the nodes, times the midrib's for their positions.
    ///
    /// # Errors
    /// [`GraphError`].
    pub fn marks(&self, report: &mut Report) -> Result<Marks, GraphError> {
        let net = Net::new(self, report)?;
        let whole = net.midrib();
        // 400 points are finer than a midrib bends, and keep the search for nearest points short.
        let step = whole.len().div_ceil(400).max(1);
        let last = whole.len().saturating_sub(1);
        let midrib: Vec<u32> =
            whole.iter().enumerate().filter(|(i, _)| i % step == 0 || *i == last).map(|(_, &k)| k).collect();
        let axis = Axis::new(evened(midrib.iter().map(|&k| net.node_position(k)).collect()));
        let length = axis.length();
        if midrib.len() < 3 || length <= 0.0 {
            return Err(GraphError::TooSmall(midrib.len()));
        }
        let (_, before) = net.ways(&whole);
        let places: Vec<(f64, f64)> = net.members.iter().map(|&k| axis.place(net.node_position(k))).collect();
        let margins = [1.0, -1.0].map(|side| margin(&places, side, length));
        let widest = |m: &[f64]| m.iter().copied().fold(0.0, f64::max);
        if margins.iter().any(|m| widest(m) < 0.02 * length) {
            return Err(GraphError::OneSided);
        }
        let sides = [1.0, -1.0].map(|side| {
            let reach = if side > 0.0 { &margins[0] } else { &margins[1] };
            let near_margin = |&(_, &(s, off)): &(&u32, &(f64, f64))| {
                let full = reach_at(reach, s / length);
                side * off > 0.9 * full && full > 0.02 * length
            };
            let ends = net.members.iter().zip(&places).filter(near_margin);
            let all = ends.filter_map(|(&end, &(to, _))| side_vein(&net, &before, &axis, end, to)).collect();
            chosen(all, length)
        });
        let outline = self.outline(&net.members);
        let (rows_of, lone) = rows(sides, &axis, &margins, outline.as_deref());
        if rows_of.len() < 2 {
            return Err(GraphError::OneSided);
        }
        if lone > 0 {
            base::warn!(
                report,
                "veins-unpaired",
                { count = lone },
                "{count} side veins have no partner on the other side: there a straight vein to the margin was taken"
            );
        }
        let near = |s: f64| {
            // The midrib's thickness is the median over a fortieth of its length: single nodes are uneven.
            let within = midrib.iter().zip(&axis.lengths).filter(|(_, l)| (**l - s).abs() < 0.0125 * length);
            let mut radii: Vec<f64> = within.map(|(&k, _)| net.radius(k)).collect();
            base::sort_numbers(&mut radii);
            radii.get(radii.len() / 2).map(|r| 2.0 * r)
        };
        let frame = Frame { origin: axis.points[0], up: upright(&axis) };
        let mut rows: Vec<MarkRow> =
            rows_of.iter().rev().map(|[right, left]| frame.row(&axis, right, left, near)).collect();
        rows.push(frame.base(&axis, (&margins, outline.as_deref()), near(0.0)));
        let tip = frame.place(axis.point_at(length));
        let margin = outline.into_iter().flatten().map(|p| frame.place(p)).collect();
        let mut marks = Marks { rows, tip, tip_thickness: near(length), margin };
        if marks.margin.is_empty() || marks.complete(&mut Report::default()).is_err() {
            // Faults of the marks apart from the margin are reported where the marks are used.
            marks.margin.clear();
            report.warn(
                "margin-not-found",
                "the veins show no margin that goes once round them: the leaf ends where its side veins end",
            );
        }
        Ok(marks)
    }
}

fn upright(axis: &Axis) -> DVec2 {
    (axis.point_at(axis.length()) - axis.points[0]).try_normalize().unwrap_or(DVec2::Y)
}

/// Returns the path to a margin node, if it is a vein and not a detour.
fn side_vein(net: &Net<'_>, before: &[u32], axis: &Axis, end: u32, to: f64) -> Option<Side> {
    let way = trace(before, end);
    let line: Vec<DVec2> = way.iter().map(|&k| net.node_position(k)).collect();
    let (first, last) = (*line.first()?, *line.last()?);
    let (from, _) = axis.place(first);
    let long = geom::polyline_length(&line);
    let direct = first.distance(last);
    // Side veins run outwards and towards the tip, nearly straight.
    if way.len() < 4 || direct < 0.02 * axis.length() || long > 1.5 * direct || to < from {
        return None;
    }
    let radii: Vec<f64> = way.iter().map(|&k| net.radius(k)).collect();
    // The radius of a uniform vein of the same conductance, over the outer two thirds: near the midrib every path is
    // thick, and a path through the net has thin places. Detours reduce it.
    let outer = way.len() / 3;
    let cost: f64 = (outer + 1..way.len())
        .map(|i| {
            let r = 0.5 * (radii[i - 1] + radii[i]);
            line[i - 1].distance(line[i]) / (r * r * r)
        })
        .sum();
    let strength = geom::polyline_length(&line[outer..]) / cost * (direct / long) * (direct / long);
    Some(Side { from, to, line, radii, strength })
}

/// Returns the strongest veins that keep their order and their distance from one another.
fn chosen(mut all: Vec<Side>, length: f64) -> Vec<Side> {
    base::sort_by(&mut all, |a, b| {
        b.strength.total_cmp(&a.strength).then(a.from.total_cmp(&b.from)).then(a.to.total_cmp(&b.to))
    });
    let mut kept: Vec<Side> = Vec::new();
    for one in all {
        // 0.035: in leaves with more than some 25 pairs, side veins no longer differ from the net.
        let apart = |k: &Side| {
            let (a, b) = (one.from - k.from, one.to - k.to);
            a.abs() > 0.035 * length && b.abs() > 0.02 * length && (a > 0.0) == (b > 0.0)
        };
        if kept.iter().all(apart) && one.from < 0.95 * length {
            kept.push(one);
        }
    }
    base::sort_by(&mut kept, |a, b| a.from.total_cmp(&b.from));
    kept
}

/// Pairs veins of the two sides that leave the midrib near one another, nearest first, in order.
fn paired(right: &[Side], left: &[Side], length: f64) -> Vec<(usize, usize)> {
    let mut all: Vec<(f64, usize, usize)> = Vec::new();
    for (i, r) in right.iter().enumerate() {
        for (j, l) in left.iter().enumerate() {
            let gap = (r.from - l.from).abs();
            if gap < 0.06 * length {
                all.push((gap, i, j));
            }
        }
    }
    base::sort_by(&mut all, |a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let mut pairs: Vec<(usize, usize)> = Vec::new();
    for (_, i, j) in all {
        if pairs.iter().all(|&(a, b)| (i > a && j > b) || (i < a && j < b)) {
            pairs.push((i, j));
        }
    }
    base::sort_by_key(&mut pairs, |&pair| pair);
    pairs
}

/// Returns pairs of veins from the base up, right and left, and the number of veins that were given a missing partner.
fn rows(
    [right, left]: [Vec<Side>; 2],
    axis: &Axis,
    margins: &[Vec<f64>; 2],
    outline: Option<&[DVec2]>,
) -> (Vec<[Side; 2]>, usize) {
    let length = axis.length();
    let pairs = paired(&right, &left, length);
    let mut middles: Vec<f64> = pairs.iter().map(|&(i, j)| 0.5 * (right[i].from + left[j].from)).collect();
    let ends = |of: &[Side]| of.iter().map(|s| (s.from, s.to)).collect::<Vec<_>>();
    let ends = [ends(&right), ends(&left)];
    let (mut right, mut left): (Vec<Option<Side>>, Vec<Option<Side>>) =
        (right.into_iter().map(Some).collect(), left.into_iter().map(Some).collect());
    let mut out: Vec<[Side; 2]> = Vec::new();
    for &(i, j) in &pairs {
        if let (Some(r), Some(l)) = (right[i].take(), left[j].take()) {
            out.push([r, l]);
        }
    }
    let mut lone = 0;
    for (k, vein) in right.into_iter().map(|v| (0, v)).chain(left.into_iter().map(|v| (1, v))) {
        let Some(vein) = vein else { continue };
        // Rows nearer than 3 % of the length would make narrow folds of the blade.
        if middles.iter().any(|m| (m - vein.from).abs() < 0.03 * length) {
            continue;
        }
        let Some(partner) =
            partner(&vein, &ends[1 - k], axis, &margins[1 - k], (if k == 0 { -1.0 } else { 1.0 }, outline))
        else {
            continue;
        };
        middles.push(vein.from);
        out.push(if k == 0 { [vein, partner] } else { [partner, vein] });
        lone += 1;
    }
    base::sort_by(&mut out, |a, b| (a[0].from + a[1].from).total_cmp(&(b[0].from + b[1].from)));
    // The ends keep the order of the rows on both sides.
    let mut last = [f64::NEG_INFINITY; 2];
    out.retain(|[r, l]| {
        let ordered = r.to > last[0] && l.to > last[1];
        if ordered {
            last = [r.to, l.to];
        }
        ordered
    });
    (out, lone)
}

/// Makes a straight vein on the other side (right is 1), to the end expected from those of its neighbours.
fn partner(
    vein: &Side,
    ends: &[(f64, f64)],
    axis: &Axis,
    margin: &[f64],
    (side, outline): (f64, Option<&[DVec2]>),
) -> Option<Side> {
    let after = ends.partition_point(|e| e.0 < vein.from);
    let to = match (after.checked_sub(1).map(|k| ends[k]), ends.get(after)) {
        (Some(a), Some(b)) => base::ops::lerp(a.1, b.1, (vein.from - a.0) / (b.0 - a.0)),
        (Some(e), None) | (None, Some(&e)) => (vein.from + e.1 - e.0).min(0.99 * axis.length()),
        (None, None) => return None,
    };
    let length = axis.length();
    let along = (axis.point_at(to + 0.02 * length) - axis.point_at(to - 0.02 * length)).try_normalize()?;
    let across = DVec2::new(along.y, -along.x) * side;
    let end = axis.point_at(to) + across * (0.97 * reach_at(margin, to / length)).max(0.01 * length);
    let foot = axis.point_at(vein.from);
    // The margin may have a notch there.
    let end = outline.map_or(end, |o| foot.lerp(end, share_within(o, foot, end)));
    let line = (0..=6).map(|k| foot.lerp(end, f64::from(k) / 6.0)).collect();
    let radii = (0..=6).map(|k| vein.radii[k * (vein.radii.len() - 1) / 6]).collect();
    Some(Side { from: vein.from, to, line, radii, strength: vein.strength })
}

/// Returns the share of the path from the midrib outwards at which an end lies within the margin: at least a tenth.
fn share_within(outline: &[DVec2], from: DVec2, to: DVec2) -> f64 {
    let shares = (0..18).map(|k| 1.0 - 0.05 * f64::from(k));
    shares.into_iter().find(|&s| geom::contains(outline, from.lerp(to, s))).unwrap_or(0.1)
}

/// The transformation from the graph's plane to the marks' space.
struct Frame {
    origin: DVec2,
    up: DVec2,
}

impl Frame {
    fn place(&self, p: DVec2) -> DVec3 {
        let d = p - self.origin;
        DVec3::new(-self.up.perp_dot(d), self.up.dot(d), 0.0)
    }

    fn row(&self, axis: &Axis, right: &Side, left: &Side, near: impl Fn(f64) -> Option<f64>) -> MarkRow {
        let middle = 0.5 * (right.from + left.from);
        let mut row = MarkRow { midrib: near(middle), ..MarkRow::default() };
        let foot = axis.point_at(middle);
        for (side, at) in [(right, [2, 1, 0]), (left, [4, 5, 6])] {
            let mut line = side.line.clone();
            line[0] = foot;
            let total = geom::polyline_length(&line);
            for (k, j) in at.into_iter().enumerate() {
                let share = (k + 1) as f64 / 3.0;
                let (p, node) = along(&line, share * total);
                row.points[j] = self.place(p);
                row.thickness[j] = Some(2.0 * median_near(&side.radii, node));
            }
        }
        row.points[MARKS_A_ROW / 2] = self.place(foot);
        let ends = [right, left].map(|s| median_near(&s.radii, s.radii.len().min(3)));
        row.thickness[MARKS_A_ROW / 2] = Some(ends[0] + ends[1]);
        row
    }

    /// Makes the lowest row: across the leaf where the midrib begins, as wide as the leaf is there.
    fn base(
        &self,
        axis: &Axis,
        (margins, outline): (&[Vec<f64>; 2], Option<&[DVec2]>),
        midrib: Option<f64>,
    ) -> MarkRow {
        let across = DVec2::new(self.up.y, -self.up.x);
        let length = axis.length();
        let mut row = MarkRow { midrib, ..MarkRow::default() };
        for j in 0..MARKS_A_ROW {
            let side = (MARKS_A_ROW / 2) as f64 - j as f64;
            let margin = if side > 0.0 { &margins[0] } else { &margins[1] };
            // Not wider than the leaf is a thirtieth farther up, not narrower than 1 % of its length.
            let wide = reach_at(margin, 0.0).min(reach_at(margin, 1.0 / 30.0)).max(0.01 * length);
            // Within the margin there, if it has one of its own.
            let end = axis.points[0] + across * (side.signum() * wide);
            let part = outline.map_or(1.0, |o| share_within(o, axis.points[0], end));
            row.points[j] = self.place(axis.points[0] + across * (side / 3.0 * wide * part));
        }
        row
    }
}

/// Returns the point at `s` along a line, and the node before it.
pub(crate) fn along(line: &[DVec2], s: f64) -> (DVec2, usize) {
    let mut left = s;
    for (k, w) in line.windows(2).enumerate() {
        let l = w[0].distance(w[1]);
        if left <= l && l > 0.0 {
            return (w[0].lerp(w[1], left / l), k);
        }
        left -= l;
    }
    (line.last().copied().unwrap_or_default(), line.len().saturating_sub(1))
}

pub(crate) fn median_near(radii: &[f64], k: usize) -> f64 {
    base::median(radii[k.saturating_sub(3)..(k + 4).min(radii.len())].to_vec()).unwrap_or(1e-5)
}

base::coded!(GraphError {
    Self::Node(node) => "graph-node" { node },
    Self::Radii { nodes, radii } => "graph-radii" { nodes, radii },
    Self::Edge { edge, node, last } => "graph-edge" { edge, node, last },
    Self::TooSmall(nodes) => "graph-small" { nodes },
    Self::OneSided => "graph-one-sided" {},
});

#[cfg(test)]
mod tests {
    use super::*;

    /// Makes a leaf: a midrib of 100 mm, `pairs` of side veins at 45 degrees, small veins between.
    fn made(pairs: u32, turn: f64) -> VeinGraph {
        let mut g = VeinGraph::default();
        let (s, c) = base::ops::sin_cos(turn);
        let node = |g: &mut VeinGraph, p: DVec2, r: f64| {
            g.nodes.push(DVec2::new(c * p.x - s * p.y, s * p.x + c * p.y));
            g.radii.push(r);
            index(g.nodes.len() - 1)
        };
        let mut last = None;
        let mut midrib = Vec::new();
        for k in 0..=100 {
            let y = 0.001 * f64::from(k);
            let n = node(&mut g, DVec2::new(0.0, y), 0.0006 - 0.000_004 * f64::from(k));
            g.edges.extend(last.map(|l| [l, n]));
            last = Some(n);
            midrib.push(n);
        }
        for k in 0..pairs {
            let at = 4 + 88 * k / pairs;
            let wide = 0.03 - 0.000_25 * f64::from(at);
            for side in [-1.0, 1.0] {
                let mut last = midrib[at as usize];
                for i in 1..=12 {
                    let t = f64::from(i) / 12.0 * wide;
                    let n = node(&mut g, DVec2::new(side * t, 0.001 * f64::from(at) + 0.5 * t), 0.0002);
                    g.edges.push([last, n]);
                    // A thin vein towards the tip at every third node.
                    if i % 3 == 0 {
                        let m = node(
                            &mut g,
                            DVec2::new(side * t, 0.001 * f64::from(at) + 0.5 * t + 0.003),
                            0.00005,
                        );
                        g.edges.push([n, m]);
                    }
                    last = n;
                }
            }
        }
        g
    }

    #[test]
    fn made_leaf_has_its_rows_however_it_is_turned() {
        for turn in [0.0, 0.7, 2.5, -1.2] {
            let mut report = Report::default();
            let marks = made(8, turn).marks(&mut report).unwrap();
            assert_eq!(marks.validate().next(), None);
            assert_eq!(marks.rows.len(), 9, "{turn}: 8 pairs and the base");
            assert!((marks.length() - 0.1).abs() < 0.002, "{turn}: {}", marks.length());
            // The right margin is at +x, the tip up, the third of 8 pairs 26 mm above the root.
            let row = &marks.rows[5];
            assert!(row.points[0].x > 0.01 && row.points[6].x < -0.01, "{turn}: {row:?}");
            assert!((row.points[3].y - 0.026).abs() < 0.001, "{turn}: {row:?}");
            assert!((row.thickness[1].unwrap_or(0.0) - 0.0004).abs() < 1e-9, "{turn}: {row:?}");
            assert!(row.midrib.is_some_and(|m| (m - 0.001).abs() < 0.000_05), "{turn}: {row:?}");
            assert!(marks.complete(&mut report).is_ok());
        }
    }

    #[test]
    fn a_leaf_with_a_midrib_is_not_palmate() {
        for turn in [0.0, 0.7, 2.5] {
            assert_eq!(made(8, turn).rays(&mut Report::default()), Ok(None), "{turn}");
        }
    }

    #[test]
    fn faults_are_named() {
        let fault = |change: fn(&mut VeinGraph)| {
            let mut g = made(8, 0.0);
            change(&mut g);
            g.marks(&mut Report::default()).unwrap_err()
        };
        assert_eq!(fault(|g| g.radii[7] = 0.0), GraphError::Node(7));
        assert_eq!(fault(|g| g.nodes[3].x = f64::NAN), GraphError::Node(3));
        assert!(matches!(fault(|g| g.edges[5][1] = 99_999), GraphError::Edge { edge: 5, node: 99_999, .. }));
        assert!(matches!(fault(|g| g.radii.truncate(4)), GraphError::Radii { radii: 4, .. }));
        assert_eq!(fault(|g| g.edges.clear()), GraphError::TooSmall(1));
        assert_eq!(fault(|g| g.edges.truncate(60)), GraphError::OneSided);
    }
}
