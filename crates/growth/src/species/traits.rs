//! Measures how the axes of a plant branch, order by order.

use base::ops;
use glam::DVec3;
use plant::{Axis, NodeId, Plant};

/// Measure of every axis of an order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Trait {
    /// Length of a trunk, metres.
    Length,
    /// Radius of a trunk at the base as a share of its length.
    Slenderness,
    /// Angle between the axis and its bearer at its start, degrees.
    Angle,
    /// Its length as a share of its bearer's.
    LengthRatio,
    /// Its radius at the base as a share of its bearer's there.
    RadiusRatio,
    /// Its radius half way along as a share of that at its base.
    Taper,
    /// Distance from its base to the first axis that it bears, metres.
    First,
    /// Distance from each axis that it bears to the next, metres.
    Internode,
}

impl Trait {
    /// All traits.
    pub const ALL: [Self; 8] = [
        Self::Length,
        Self::Slenderness,
        Self::Angle,
        Self::LengthRatio,
        Self::RadiusRatio,
        Self::Taper,
        Self::First,
        Self::Internode,
    ];

    /// Returns the word in reports and pictures.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Length => "length",
            Self::Slenderness => "slenderness",
            Self::Angle => "angle",
            Self::LengthRatio => "length ratio",
            Self::RadiusRatio => "radius ratio",
            Self::Taper => "taper",
            Self::First => "first branch",
            Self::Internode => "internode",
        }
    }

    /// Returns its unit; empty for a share.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Length | Self::First | Self::Internode => "m",
            Self::Angle => "degrees",
            Self::Slenderness | Self::LengthRatio | Self::RadiusRatio | Self::Taper => "",
        }
    }

    /// Whether axes of an order have it: trunks have no bearer, all others one.
    pub const fn is_of(self, order: usize) -> bool {
        match self {
            Self::Length | Self::Slenderness => order == 0,
            Self::Angle | Self::LengthRatio | Self::RadiusRatio => order > 0,
            Self::Taper | Self::First | Self::Internode => true,
        }
    }
}

/// All values of one order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OrderTraits {
    /// Number of axes.
    pub axes: usize,
    /// Most axes that one of them bears.
    pub most_borne: usize,
    /// Lower bounds of [`Trait::First`] and of [`Trait::Internode`] for axes that ended before the next one, metres.
    pub unended: [Vec<f64>; 2],
    values: [Vec<f64>; Trait::ALL.len()],
}

impl OrderTraits {
    /// Returns the values of a trait, of all plants in turn.
    pub fn values(&self, which: Trait) -> &[f64] {
        &self.values[which as usize]
    }

    fn add(&mut self, which: Trait, value: f64) {
        if value.is_finite() {
            self.values[which as usize].push(value);
        }
    }
}

/// Branching of the axes of plants, order by order: trunks first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Traits {
    /// Order 0, 1, and so on.
    pub orders: Vec<OrderTraits>,
}

/// Share of an axis's length over which directions are measured: one internode of a scan is mostly noise.
const CHORD: f64 = 0.1;

impl Traits {
    /// Measures a plant and adds its values. Roots, leaf stalks and stubs do not count as axes here, nor do axes
    /// without length.
    ///
    /// Cost: linear, and a sort of the axes that each axis bears.
    pub fn add(&mut self, plant: &Plant) {
        let shoot = plant.shoot();
        let lines: Vec<Line> = plant.axes.iter().map(|axis| Line::new(plant, axis)).collect();
        let is_axis = |i: usize| shoot[i] && lines[i].length() > 0.0;
        let bearer_of = |b: NodeId| plant.nodes.axis[b.index()].index();
        let mut borne: Vec<Vec<f64>> = vec![Vec::new(); plant.axes.len()];
        for (i, axis) in plant.axes.iter().enumerate().filter(|(i, _)| is_axis(*i)) {
            let order = axis.order as usize;
            if self.orders.len() <= order {
                self.orders.resize(order + 1, OrderTraits::default());
            }
            let own = &mut self.orders[order];
            let line = &lines[i];
            own.axes += 1;
            own.add(Trait::Taper, line.radius_at(0.5 * line.length()) / line.base_radius());
            let Some(b) = axis.bearer else {
                own.add(Trait::Length, line.length());
                own.add(Trait::Slenderness, line.base_radius() / line.length());
                continue;
            };
            let (row, bearer) = (bearer_of(b), &lines[bearer_of(b)]);
            if !is_axis(row) {
                continue;
            }
            let at = bearer.way[b.index() - plant.axes[row].nodes.start as usize];
            borne[row].push(at);
            let (along, away) = (bearer.direction_below(at), line.direction_above());
            if let Some((along, away)) = along.zip(away) {
                own.add(
                    Trait::Angle,
                    ops::atan2(along.cross(away).length(), along.dot(away)) * 180.0 / ops::PI,
                );
            }
            own.add(Trait::LengthRatio, line.length() / bearer.length());
            own.add(Trait::RadiusRatio, line.base_radius() / bearer.radius_at(at));
        }
        for (i, mut places) in borne.into_iter().enumerate().filter(|(i, _)| is_axis(*i)) {
            let own = &mut self.orders[plant.axes[i].order as usize];
            base::sort_numbers(&mut places);
            own.most_borne = own.most_borne.max(places.len());
            let Some((&first, &last)) = places.first().zip(places.last()) else {
                own.unended[0].push(lines[i].length());
                continue;
            };
            own.add(Trait::First, first);
            places.windows(2).for_each(|w| own.add(Trait::Internode, w[1] - w[0]));
            own.unended[1].push((lines[i].length() - last).max(0.0));
        }
    }

    /// Measures several plants.
    pub fn measure<'a>(plants: impl IntoIterator<Item = &'a Plant>) -> Self {
        let mut out = Self::default();
        plants.into_iter().for_each(|plant| out.add(plant));
        out
    }
}

/// The course of an axis with the length from its base to each of its nodes.
struct Line {
    points: Vec<DVec3>,
    radii: Vec<f64>,
    way: Vec<f64>,
}

impl Line {
    fn new(plant: &Plant, axis: &Axis) -> Self {
        let rows = axis.nodes.start as usize..axis.nodes.end as usize;
        let points = plant.nodes.position[rows.clone()].to_vec();
        let mut way = Vec::with_capacity(points.len());
        let mut sum = 0.0;
        for (k, p) in points.iter().enumerate() {
            sum += if k > 0 { p.distance(points[k - 1]) } else { 0.0 };
            way.push(sum);
        }
        Self { points, radii: plant.nodes.radius_m[rows].to_vec(), way }
    }

    fn length(&self) -> f64 {
        self.way.last().copied().unwrap_or(0.0)
    }

    /// Returns the radius beyond the collar: the node on the bearer's line has no surface of its own.
    fn base_radius(&self) -> f64 {
        self.radii.get(1).or(self.radii.first()).copied().unwrap_or(0.0)
    }

    fn radius_at(&self, at: f64) -> f64 {
        self.between(at, |k, l, share| ops::lerp(self.radii[k], self.radii[l], share))
    }

    fn point_at(&self, at: f64) -> DVec3 {
        self.between(at, |k, l, share| self.points[k].lerp(self.points[l], share))
    }

    fn between<T>(&self, at: f64, of: impl Fn(usize, usize, f64) -> T) -> T {
        let next = self.way.partition_point(|w| *w < at).clamp(1.min(self.way.len() - 1), self.way.len() - 1);
        let before = next.saturating_sub(1);
        let span = self.way[next] - self.way[before];
        let share = if span > 0.0 { ((at - self.way[before]) / span).clamp(0.0, 1.0) } else { 0.0 };
        of(before, next, share)
    }

    /// Returns the direction towards a place from below; at the base the direction from there on.
    fn direction_below(&self, at: f64) -> Option<DVec3> {
        let chord = CHORD * self.length();
        let low = (at - chord).max(0.0);
        (self.point_at(at.max(low + chord)) - self.point_at(low)).try_normalize()
    }

    /// Returns the direction at the base.
    fn direction_above(&self) -> Option<DVec3> {
        (self.point_at(CHORD * self.length()) - self.points.first().copied()?).try_normalize()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use plant::AxisKind;

    #[test]
    fn a_known_plant_has_its_traits() {
        let mut p = Plant::default();
        let up = |y: f64| DVec3::Y * y;
        let trunk = p.add_axis(AxisKind::Stem, None, 1, &[up(0.0), up(2.0), up(3.0), up(4.0)], None);
        let nodes: Vec<NodeId> = p.axis(trunk).node_ids().collect();
        let (sin, cos) = ops::sin_cos(ops::PI / 3.0);
        let aside = |y: f64, length: f64| up(y) + DVec3::new(sin, cos, 0.0) * length;
        p.add_axis(AxisKind::Branch, Some(nodes[1]), 2, &[up(2.0), aside(2.0, 0.5), aside(2.0, 1.0)], None);
        p.add_axis(AxisKind::Branch, Some(nodes[2]), 3, &[up(3.0), aside(3.0, 2.0)], None);
        for (axis, radius) in [(0, 0.2), (1, 0.1), (2, 0.05)] {
            let rows = p.axes[axis].nodes.clone();
            for (k, row) in rows.enumerate() {
                p.nodes.radius_m[row as usize] = radius * (1.0 - 0.1 * k as f64);
            }
        }
        let t = Traits::measure([&p]);
        assert_eq!(
            (t.orders.len(), t.orders[0].axes, t.orders[1].axes, t.orders[0].most_borne),
            (2, 1, 2, 2)
        );
        let near = |got: &[f64], want: &[f64]| {
            assert!(
                got.len() == want.len() && got.iter().zip(want).all(|(g, w)| (g - w).abs() < 1e-9),
                "{got:?} {want:?}"
            );
        };
        near(t.orders[0].values(Trait::Length), &[4.0]);
        near(t.orders[0].values(Trait::Slenderness), &[0.18 / 4.0]);
        near(t.orders[1].values(Trait::Angle), &[60.0, 60.0]);
        near(t.orders[1].values(Trait::LengthRatio), &[0.25, 0.5]);
        near(t.orders[1].values(Trait::RadiusRatio), &[0.09 / 0.18, 0.045 / 0.16]);
        near(t.orders[0].values(Trait::First), &[2.0]);
        near(t.orders[0].values(Trait::Internode), &[1.0]);
        near(&t.orders[0].unended[1], &[1.0]);
        near(&t.orders[1].unended[0], &[1.0, 2.0]);
        assert!(t.orders[1].values(Trait::First).is_empty() && t.orders[0].values(Trait::Angle).is_empty());
    }
}
