//! The reading's lines as rows of nodes: one node at each attachment, the others evenly between.

use base::Seed;
use glam::{DVec2, DVec3};
use plant::AxisKind;

use reading::{Attachment, Reading};

/// Distance of nodes, ink units: 50 to the drawing's diagonal keep a drawn curve smooth.
const STEP: f64 = 0.02;
/// Two attachments nearer than this share a node, ink units.
const SAME: f64 = 1e-4;
/// Most nodes of one line that are kept apart (a scribble may be many drawings long).
const MOST_NODES: f64 = 2000.0;

/// One axis of the reading, ready to get its depth. Ink units; `z` towards the viewer.
#[derive(Clone, Debug)]
pub(crate) struct AxisPlan {
    /// Nodes, base first, at least 2; `xy` on the drawn line.
    pub(crate) points: Vec<DVec3>,
    /// The nodes as they were drawn, whatever bends `points` later.
    pub(crate) drawn: Vec<DVec2>,
    /// Place of each node along the drawn line; below 0 for the link to a bearer that it does not touch.
    pub(crate) at: Vec<f64>,
    /// Drawn half width at each node; empty for a line.
    pub(crate) half_width: Vec<f64>,
    /// Row of the bearing axis and its node.
    pub(crate) bearer: Option<(usize, usize)>,
    /// Kind of axis.
    pub(crate) kind: AxisKind,
    /// Stable key.
    pub(crate) key: u64,
    /// The stroke that it was drawn as.
    pub(crate) source: Option<u32>,
}

impl AxisPlan {
    /// Returns the node nearest to a place along the drawn line.
    pub(crate) fn node_at(&self, at: f64) -> usize {
        let i = self.at.partition_point(|&a| a < at);
        if i == 0 {
            0
        } else if i >= self.at.len() || at - self.at[i - 1] < self.at[i] - at {
            i - 1
        } else {
            i
        }
    }

    /// Returns the unit direction of the drawing at a node, over about `window` ink units to both sides.
    pub(crate) fn direction(&self, node: usize, window: f64) -> DVec2 {
        let (lo, hi) = self.window(node, window);
        (self.points[hi] - self.points[lo]).truncate().try_normalize().unwrap_or(DVec2::Y)
    }

    /// Returns the rise of `z` per unit of drawn length at a node.
    pub(crate) fn slope(&self, node: usize, window: f64) -> f64 {
        let (lo, hi) = self.window(node, window);
        let run = (self.points[hi] - self.points[lo]).truncate().length();
        if run > 1e-9 { (self.points[hi].z - self.points[lo].z) / run } else { 0.0 }
    }

    fn window(&self, node: usize, window: f64) -> (usize, usize) {
        let last = self.points.len() - 1;
        let node = node.min(last);
        let mut lo = node;
        while lo > 0 && self.at[node] - self.at[lo] < window {
            lo -= 1;
        }
        let mut hi = node;
        while hi < last && self.at[hi] - self.at[node] < window {
            hi += 1;
        }
        (lo, hi)
    }

    /// Returns the drawn half width at a node, 0 for a line.
    pub(crate) fn width_at(&self, node: usize) -> f64 {
        self.half_width.get(node).copied().unwrap_or(0.0)
    }
}

/// The planned axes, one slot for each row of `Reading::axes`; `None` for a line without length.
#[derive(Clone, Debug, Default)]
pub(crate) struct Plans {
    pub(crate) rows: Vec<Option<AxisPlan>>,
    /// Bearer that takes the place of each row without length.
    stand_in: Vec<Option<Attachment>>,
    /// Rows that are the rachis of a compound leaf, or the petiole at whose end its leaflets stand.
    rachis: Vec<bool>,
}

/// Fewest leaflets of a compound leaf.
const FEWEST_LEAFLETS: usize = 3;

impl Plans {
    /// Plans every axis of a reading. Never fails: lines without two different finite points are left out, and the
    /// parts that they bear go to their own bearer.
    pub(crate) fn new(reading: &Reading) -> Self {
        let lines: Vec<Option<Line>> =
            reading.axes.iter().map(|a| Line::new(&a.points, &a.half_width)).collect();
        let mut plans = Self {
            rows: vec![None; reading.axes.len()],
            stand_in: reading.axes.iter().map(|a| a.bearer).collect(),
            rachis: rachises(reading),
        };
        for (row, slot) in plans.stand_in.iter_mut().enumerate() {
            *slot = slot.filter(|b| b.axis < row); // a bearer is always an earlier row
        }
        let mut stations: Vec<Vec<f64>> = vec![Vec::new(); reading.axes.len()];
        let organs = reading
            .leaves
            .iter()
            .map(|l| l.bearer)
            .chain(reading.flowers.iter().map(|f| f.bearer))
            .chain(reading.fruits.iter().map(|f| f.bearer))
            .chain(reading.thorns.iter().map(|t| t.1));
        let axes = plans.stand_in.iter().copied();
        for bearer in axes.chain(organs).flatten() {
            if let Some(a) = plans.resolve_in(bearer, |row| lines.get(row).is_some_and(Option::is_some)) {
                stations[a.axis].push(a.at);
            }
        }
        let mut born = vec![0_u64; reading.axes.len()];
        for (row, line) in lines.iter().enumerate() {
            let Some(line) = line else { continue };
            let axis = &reading.axes[row];
            let (mut points, mut at, mut half_width) = line.nodes(&stations[row]);
            let bearer = plans.stand_in[row].and_then(|b| plans.locate(b));
            let mut bearer_key = 0;
            if let Some((on, node)) = bearer
                && let Some(parent) = &plans.rows[on]
            {
                bearer_key = parent.key;
                let base = parent.points[node];
                if points[0].distance(base) < 1e-6 {
                    points[0] = base;
                } else {
                    at.insert(0, -points[0].distance(base));
                    points.insert(0, base);
                    if let Some(&first) = half_width.first() {
                        half_width.insert(0, first);
                    }
                }
            }
            let rank = bearer.map_or(row as u64, |(on, _)| {
                born[on] += 1;
                born[on]
            });
            let key =
                key_of(Part::Axis, axis.source, if axis.source.is_some() { 0 } else { rank }, bearer_key);
            plans.rows[row] = Some(AxisPlan {
                drawn: points.iter().map(|p| p.truncate()).collect(),
                points,
                at,
                half_width,
                bearer,
                kind: axis.kind,
                key,
                source: axis.source,
            });
        }
        plans
    }

    /// Returns the rise of the compound leaf's surface towards the viewer at one of its leaflets, per unit of the
    /// drawing; `None` if `bearer` is no part of a compound leaf.
    ///
    /// Leaflets lie in the plane of their rachis and of the direction across it, in which the drawing shows their full
    /// width.
    pub(crate) fn leaflet_gradient(&self, bearer: Attachment) -> Option<DVec2> {
        let (mut row, mut node) = self.locate(bearer)?;
        if !self.rachis[row] {
            let stalk = self.rows[row].as_ref().filter(|p| p.kind == AxisKind::Petiole)?;
            (row, node) = stalk.bearer?;
        }
        let plan = self.rows[row].as_ref().filter(|_| self.rachis[row])?;
        Some(plan.direction(node, LEAFLET_WINDOW) * plan.slope(node, LEAFLET_WINDOW))
    }

    /// Returns the row and node of a bearer: the attachment's own, or that which takes the place of a line without
    /// length.
    pub(crate) fn locate(&self, bearer: Attachment) -> Option<(usize, usize)> {
        let a = self.resolve_in(bearer, |row| self.rows.get(row).is_some_and(Option::is_some))?;
        let node = self.rows.get(a.axis)?.as_ref()?.node_at(a.at);
        Some((a.axis, node))
    }

    fn resolve_in(&self, mut a: Attachment, there: impl Fn(usize) -> bool) -> Option<Attachment> {
        // Rows fall with every step: it ends.
        while !there(a.axis) {
            a = (*self.stand_in.get(a.axis)?)?;
        }
        Some(Attachment { axis: a.axis, at: if a.at.is_finite() { a.at } else { 0.0 } })
    }
}

/// Length of a rachis over which the plane of its leaflets is measured, ink units.
const LEAFLET_WINDOW: f64 = 0.05;

/// Finds the axes that bear the leaflets of one compound leaf: they are borne themselves, and bear nothing but leaves.
fn rachises(reading: &Reading) -> Vec<bool> {
    let count = reading.axes.len();
    let mut leaves = vec![0_usize; count];
    let mut others = vec![false; count];
    // A petiolule leads from the rachis to a leaflet that does not touch it.
    let is_stalk = |row: usize| reading.axes[row].kind == AxisKind::Petiole;
    for leaf in &reading.leaves {
        let Some(on) = leaf.bearer.map(|b| b.axis).filter(|&row| row < count) else { continue };
        let stem = reading.axes[on].bearer.map(|b| b.axis).filter(|&row| is_stalk(on) && row < count);
        leaves[on] += 1;
        stem.into_iter().for_each(|row| leaves[row] += 1);
    }
    let axes = reading.axes.iter().enumerate().filter(|(row, _)| !is_stalk(*row)).map(|(_, a)| a.bearer);
    let organs = reading.flowers.iter().map(|f| f.bearer);
    let organs = organs.chain(reading.fruits.iter().map(|f| f.bearer));
    for bearer in axes.chain(organs).flatten().filter(|b| b.axis < count) {
        others[bearer.axis] = true;
    }
    (0..count)
        .map(|row| reading.axes[row].bearer.is_some() && leaves[row] >= FEWEST_LEAFLETS && !others[row])
        .collect()
}

/// The part that a key names, so that an axis and a leaf of one stroke differ.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Part {
    Axis = 1,
    Leaf = 2,
    Flower = 3,
    Petal = 4,
    Stamen = 5,
    Disc = 6,
    Fruit = 7,
    Thorn = 8,
    Link = 9,
    Pot = 10,
}

/// Returns a key that is stable under edits of other parts: by the stroke for a drawn part, else by bearer and rank.
/// `rank` distinguishes several parts of one stroke.
pub(crate) fn key_of(part: Part, source: Option<u32>, rank: u64, bearer_key: u64) -> u64 {
    let seed = Seed::new(part as u64);
    match source {
        Some(stroke) => seed.child(1).child(u64::from(stroke)).child(rank),
        None => seed.child(2).child(bearer_key).child(rank),
    }
    .number()
}

/// A drawn line without repeated or infinite points.
struct Line {
    points: Vec<DVec2>,
    at: Vec<f64>,
    half_width: Vec<f64>,
}

impl Line {
    fn new(points: &[DVec2], half_width: &[f64]) -> Option<Self> {
        let widths = half_width.len() == points.len();
        let mut line = Self { points: Vec::new(), at: Vec::new(), half_width: Vec::new() };
        let mut sum = 0.0;
        for (i, &p) in points.iter().enumerate() {
            // 1e6: far outside any drawing, and its square is still exact enough.
            if !p.is_finite() || p.abs().max_element() > 1e6 {
                continue;
            }
            if let Some(&last) = line.points.last() {
                let d = p.distance(last);
                if d < 1e-9 {
                    continue;
                }
                sum += d;
            }
            line.points.push(p);
            line.at.push(sum);
            if widths {
                let w = half_width[i];
                line.half_width.push(if w.is_finite() { w.clamp(0.0, 1e6) } else { 0.0 });
            }
        }
        (line.points.len() >= 2).then_some(line)
    }

    fn length(&self) -> f64 {
        self.at.last().copied().unwrap_or(0.0)
    }

    fn sample(&self, at: f64) -> (DVec2, Option<f64>) {
        let i = self.at.partition_point(|&a| a <= at).clamp(1, self.at.len() - 1);
        let t = ((at - self.at[i - 1]) / (self.at[i] - self.at[i - 1])).clamp(0.0, 1.0);
        let width = self.half_width.get(i).map(|&w| base::ops::lerp(self.half_width[i - 1], w, t));
        (self.points[i - 1].lerp(self.points[i], t), width)
    }

    /// Returns nodes at the stations and evenly between: points, places, half widths.
    fn nodes(&self, stations: &[f64]) -> (Vec<DVec3>, Vec<f64>, Vec<f64>) {
        let length = self.length();
        let pieces = (length / STEP).ceil().clamp(4.0, MOST_NODES);
        let step = length / pieces;
        let same = SAME.min(0.1 * step);
        let mut at: Vec<f64> = stations.iter().map(|s| s.clamp(0.0, length)).collect();
        at.push(0.0);
        at.push(length);
        base::sort_numbers(&mut at);
        let mut kept: Vec<f64> = vec![0.0];
        for a in at {
            if a - kept[kept.len() - 1] > same && (length - a > same || a >= length) {
                kept.push(a);
            }
        }
        let mut all: Vec<f64> = Vec::with_capacity(kept.len() * 2);
        for pair in kept.windows(2) {
            all.push(pair[0]);
            let between = ((pair[1] - pair[0]) / step).round().clamp(1.0, MOST_NODES);
            let mut k = 1.0;
            while k < between {
                all.push(pair[0] + (pair[1] - pair[0]) * (k / between));
                k += 1.0;
            }
        }
        all.push(length);
        let samples: Vec<(DVec2, Option<f64>)> = all.iter().map(|&a| self.sample(a)).collect();
        let points = samples.iter().map(|s| s.0.extend(0.0)).collect();
        (points, all, samples.iter().filter_map(|s| s.1).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use reading::AxisReading;

    fn axis(points: Vec<DVec2>, bearer: Option<Attachment>) -> AxisReading {
        AxisReading { points, kind: AxisKind::Branch, bearer, half_width: vec![], source: None }
    }

    #[test]
    fn a_node_stands_wherever_something_is_borne() {
        let trunk = axis(vec![DVec2::ZERO, DVec2::new(0.0, 0.5)], None);
        let twig = axis(
            vec![DVec2::new(0.0, 0.1234), DVec2::new(0.2, 0.3)],
            Some(Attachment { axis: 0, at: 0.1234 }),
        );
        let plans = Plans::new(&Reading { axes: vec![trunk, twig], ..Reading::default() });
        let (trunk, twig) = (plans.rows[0].as_ref().expect("trunk"), plans.rows[1].as_ref().expect("twig"));
        let (on, node) = twig.bearer.expect("borne");
        assert_eq!(on, 0);
        assert!((trunk.at[node] - 0.1234).abs() < 1e-12);
        assert_eq!(twig.points[0], trunk.points[node]);
        assert!(trunk.at.windows(2).all(|w| w[1] - w[0] < 0.03 && w[1] > w[0]));
    }

    #[test]
    fn lines_without_length_hand_their_load_down() {
        let trunk = axis(vec![DVec2::ZERO, DVec2::Y], None);
        let dot = axis(vec![DVec2::Y; 3], Some(Attachment { axis: 0, at: 1.0 }));
        let twig = axis(vec![DVec2::Y, DVec2::ONE], Some(Attachment { axis: 1, at: 0.0 }));
        let selfish = axis(vec![DVec2::Y, DVec2::ONE], Some(Attachment { axis: 7, at: 0.0 }));
        let plans = Plans::new(&Reading { axes: vec![trunk, dot, twig, selfish], ..Reading::default() });
        assert!(plans.rows[1].is_none());
        let twig = plans.rows[2].as_ref().expect("twig");
        assert_eq!(twig.bearer.map(|b| b.0), Some(0));
        assert!(plans.rows[3].as_ref().expect("there").bearer.is_none());
    }
}
