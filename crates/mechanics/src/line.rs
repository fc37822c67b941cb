//! Axes as polylines with taper, and the load borne at each place.

use std::collections::BTreeMap;

use base::ops::PI;
use glam::DVec3;
use plant::{AxisKind, NodeId, OrganKind, Plant, Shape};

use crate::tissue::{Weighed, weigh};
use crate::{Tissue, WoodGroup};

/// Least radius for stiffness as a share of the mean radius of the axis: drawn tips taper to nothing, and would be
/// infinitely soft.
const THINNEST_SHARE: f64 = 0.25;

/// Least radius for stiffness, metres: 0.05 mm, the finest of hairs.
const THINNEST_M: f64 = 5e-5;

/// Least number of steps along an axis, within which compliance and load are constant.
const STEPS: usize = 16;

/// A set of masses: their sum, and their first and second moments about the plant's origin.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Masses {
    pub(crate) mass: f64,
    /// Mass times position, kg m.
    pub(crate) first: DVec3,
    /// Mass times squared distance from the origin, kg m2.
    pub(crate) second: f64,
    /// Share of the mass that is fruits, kilograms.
    fruits: f64,
}

impl Masses {
    pub(crate) fn point(mass: f64, at: DVec3) -> Self {
        Self { mass, first: at * mass, second: mass * at.length_squared(), fruits: 0.0 }
    }

    fn organ(kind: OrganKind, weight: &Weight) -> Self {
        let fruits = if is_fruit(kind) { weight.mass } else { 0.0 };
        Self { fruits, ..Self::point(weight.mass, weight.centre) }
    }

    pub(crate) fn add(&mut self, other: &Self) {
        self.mass += other.mass;
        self.first += other.first;
        self.second += other.second;
        self.fruits += other.fruits;
    }

    /// Returns the polar second moment about a place, kg m2: for slender limbs, that about any transverse axis.
    fn about(&self, place: DVec3) -> f64 {
        (self.second - 2.0 * self.first.dot(place) + self.mass * place.length_squared()).max(0.0)
    }
}

/// An organ as a mass.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Weight {
    pub(crate) mass: f64,
    pub(crate) centre: DVec3,
    /// Area of one side of a leaf or petal, square metres.
    pub(crate) area_m2: f64,
    /// Half of the longest side of its bounding box, metres.
    pub(crate) reach_m: f64,
}

/// One step along an axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Step {
    /// Arc lengths of its ends, metres.
    pub(crate) from: f64,
    pub(crate) to: f64,
    /// Integral of ds / (E I), radians per newton metre.
    pub(crate) compliance: f64,
    /// Mass borne at its middle, kilograms.
    pub(crate) borne: f64,
    /// Bending energy under the reference load, joules.
    pub(crate) energy: f64,
    /// Compliance times the polar inertia of the borne load, square seconds (a term of Dunkerley's sum).
    pub(crate) slowness: f64,
    /// The same for the axis's own wood alone, s2.
    pub(crate) bare_slowness: f64,
    /// Ratio of the bending stress at rest to the strength of the tissue, if most of the borne load is fruits;
    /// otherwise 0.
    pub(crate) fruit_stress: f64,
}

/// An axis as a polyline.
#[derive(Clone, Debug)]
pub(crate) struct Line {
    pub(crate) points: Vec<DVec3>,
    pub(crate) radii: Vec<f64>,
    /// Arc length at each point.
    pub(crate) arcs: Vec<f64>,
    pub(crate) tissue: Tissue,
    pub(crate) kind: AxisKind,
    /// The axis that bears it, and the arc length there; `None` if it stands on the ground.
    pub(crate) bearer: Option<(usize, f64)>,
    /// The axis is below the ground, or on one that is: held by the soil.
    pub(crate) is_buried: bool,
    /// The axis moves with its bearer, however much it would bend.
    pub(crate) is_rigid: bool,
}

impl Line {
    fn new(plant: &Plant, row: usize, group: WoodGroup) -> Self {
        let axis = &plant.axes[row];
        let rows = axis.nodes.start as usize..axis.nodes.end as usize;
        let points = plant.nodes.position[rows.clone()].to_vec();
        let mut arcs = vec![0.0; points.len()];
        for k in 1..points.len() {
            arcs[k] = arcs[k - 1] + points[k].distance(points[k - 1]);
        }
        Self {
            points,
            radii: plant.nodes.radius_m[rows].to_vec(),
            arcs,
            tissue: group.group_of_axis(axis.kind).tissue(),
            kind: axis.kind,
            bearer: None,
            is_buried: axis.kind == AxisKind::Root,
            is_rigid: axis.kind == AxisKind::Stub,
        }
    }

    pub(crate) fn length(&self) -> f64 {
        self.arcs.last().copied().unwrap_or(0.0)
    }

    /// Returns position and radius at an arc length.
    pub(crate) fn point_and_radius_at(&self, arc: f64) -> (DVec3, f64) {
        let after = self.arcs.partition_point(|a| *a <= arc).clamp(1, self.arcs.len() - 1);
        let (s, t) = (self.arcs[after - 1], self.arcs[after]);
        let share = if t > s { ((arc - s) / (t - s)).clamp(0.0, 1.0) } else { 0.0 };
        let point = self.points[after - 1].lerp(self.points[after], share);
        (point, base::ops::lerp(self.radii[after - 1], self.radii[after], share))
    }

    /// Returns the direction at an arc length, a unit vector.
    pub(crate) fn tangent(&self, arc: f64) -> DVec3 {
        let reach = self.length() * 1e-3;
        let (a, b) = (
            self.point_and_radius_at((arc - reach).max(0.0)).0,
            self.point_and_radius_at((arc + reach).min(self.length())).0,
        );
        (b - a).try_normalize().unwrap_or(DVec3::Y)
    }

    /// Returns two arc lengths and those of the points between them, in order, each once.
    pub(crate) fn stops(&self, from: f64, to: f64) -> Vec<f64> {
        let inner = self.arcs.iter().copied().filter(|a| *a > from && *a < to);
        let mut all: Vec<f64> = core::iter::once(from).chain(inner).chain([to]).collect();
        all.dedup();
        all
    }

    fn mean_radius(&self) -> f64 {
        let area: f64 = (1..self.arcs.len())
            .map(|k| (self.arcs[k] - self.arcs[k - 1]) * f64::midpoint(self.radii[k], self.radii[k - 1]))
            .sum();
        if self.length() > 0.0 { area / self.length() } else { 0.0 }
    }

    /// Returns the integral of ds / (E I) with I = pi r^4 / 4 over a linearly changing radius; 0 if there is no wood to
    /// bend.
    fn compliance(&self, from: f64, to: f64, thinnest: f64) -> f64 {
        if self.mass(from, to) <= 0.0 {
            return 0.0;
        }
        let (a, b) =
            (self.point_and_radius_at(from).1.max(thinnest), self.point_and_radius_at(to).1.max(thinnest));
        let fourth = (a * a + a * b + b * b) / (3.0 * a * a * a * b * b * b);
        4.0 * (to - from) * fourth / (PI * self.tissue.modulus_pa)
    }

    /// Returns the mass between two places within one straight piece, kilograms: that of a frustum.
    pub(crate) fn mass(&self, from: f64, to: f64) -> f64 {
        let (a, b) = (self.point_and_radius_at(from).1, self.point_and_radius_at(to).1);
        self.tissue.density_kg_m3 * PI / 3.0 * (to - from) * (a * a + a * b + b * b)
    }

    /// Returns the mass between two places, kilograms.
    pub(crate) fn mass_between(&self, from: f64, to: f64) -> f64 {
        self.stops(from, to).windows(2).map(|s| self.mass(s[0], s[1])).sum()
    }

    /// Returns the least radius for its stiffness and its stress, metres.
    fn thinnest(&self) -> f64 {
        (self.mean_radius() * THINNEST_SHARE).max(THINNEST_M)
    }

    /// Returns the ratio of the bending stress 4 M / pi r^3 at rest to the strength of the tissue, if most of the borne
    /// load is fruits; otherwise 0.
    fn fruit_stress(&self, borne: &Masses, arc: f64, thinnest: f64, gravity: f64) -> f64 {
        if borne.fruits <= borne.mass / 2.0 {
            return 0.0;
        }
        let (place, radius) = self.point_and_radius_at(arc);
        let arm = borne.first - place * borne.mass;
        let radius = radius.max(thinnest);
        let stress = 4.0 * gravity * base::ops::hypot(arm.x, arm.z) / (PI * radius * radius * radius);
        stress / self.tissue.strength_pa
    }

    /// Makes the steps, base first, without loads.
    fn steps(&self) -> Vec<Step> {
        let thinnest = self.thinnest();
        let longest = self.length() / STEPS as f64;
        let mut steps = Vec::new();
        for ends in self.arcs.windows(2) {
            let pieces = base::ops::whole(((ends[1] - ends[0]) / longest).ceil()).max(1);
            for k in 0..pieces {
                let share = |k: u32| base::ops::lerp(ends[0], ends[1], f64::from(k) / f64::from(pieces));
                let (from, to) = (share(k), share(k + 1));
                if to > from {
                    let compliance = self.compliance(from, to, thinnest);
                    steps.push(Step {
                        from,
                        to,
                        compliance,
                        borne: 0.0,
                        energy: 0.0,
                        slowness: 0.0,
                        bare_slowness: 0.0,
                        fruit_stress: 0.0,
                    });
                }
            }
        }
        steps
    }
}

/// All axes of a plant, with their steps and the load on each.
#[derive(Debug)]
pub(crate) struct Lines {
    pub(crate) all: Vec<Line>,
    pub(crate) steps: Vec<Vec<Step>>,
    /// A weight for each organ of the plant.
    pub(crate) organs: Vec<Weight>,
}

impl Lines {
    pub(crate) fn new(plant: &Plant, group: WoodGroup, gravity: f64) -> Self {
        let mut all: Vec<Line> = (0..plant.axes.len()).map(|row| Line::new(plant, row, group)).collect();
        for (row, axis) in plant.axes.iter().enumerate() {
            let Some(bearer) = axis.bearer else { continue };
            let (b, arc) = place_of(plant, &all, bearer);
            all[row].bearer = Some((b, arc));
            all[row].is_buried |= all[b].is_buried;
        }
        let organs = weights(plant);
        let mut lines = Self { steps: all.iter().map(Line::steps).collect(), all, organs };
        lines.load(plant, gravity);
        lines
    }

    /// Computes the load on each step, tips first: borne axes come after their bearers.
    ///
    /// The reference load is gravity along each of the three axes in turn, for the same wood must resist its own weight
    /// and wind from any side. With the mass m borne, r from the step to its centre, and the tangent t, the three
    /// moments without their torsion give the bending energy U = (L / 2 E I) (m g)^2 (|r|^2 + (r . t)^2).
    fn load(&mut self, plant: &Plant, gravity: f64) {
        let mut hanging: Vec<Vec<(f64, Masses)>> = vec![Vec::new(); self.all.len()];
        for (organ, weight) in plant.organs.iter().zip(&self.organs) {
            let Some(bearer) = organ.bearer else { continue };
            let (axis, arc) = place_of(plant, &self.all, bearer);
            hanging[axis].push((arc, Masses::organ(organ.kind, weight)));
        }
        for row in (0..self.all.len()).rev() {
            let (line, mut loads) = (&self.all[row], core::mem::take(&mut hanging[row]));
            let thinnest = line.thinnest();
            base::sort_by(&mut loads, |a, b| a.0.total_cmp(&b.0));
            let (mut borne, mut bare) = (Masses::default(), Masses::default());
            for step in self.steps[row].iter_mut().rev() {
                let middle = f64::midpoint(step.from, step.to);
                while let Some((_, load)) = loads.pop_if(|(arc, _)| *arc >= middle) {
                    borne.add(&load);
                }
                let (place, half) = (line.point_and_radius_at(middle).0, line.mass(step.from, step.to) / 2.0);
                let above = Masses::point(half, line.point_and_radius_at(f64::midpoint(middle, step.to)).0);
                let below = Masses::point(half, line.point_and_radius_at(f64::midpoint(middle, step.from)).0);
                borne.add(&above);
                bare.add(&above);
                step.bear(&borne, (place, line.tangent(middle)), gravity);
                step.bare_slowness = step.compliance * bare.about(place);
                step.fruit_stress = line.fruit_stress(&borne, middle, thinnest, gravity);
                borne.add(&below);
                bare.add(&below);
            }
            loads.iter().for_each(|(_, load)| borne.add(load));
            if let Some((bearer, arc)) = line.bearer {
                hanging[bearer].push((arc, borne));
            }
        }
    }
}

impl Step {
    fn bear(&mut self, borne: &Masses, (place, tangent): (DVec3, DVec3), gravity: f64) {
        let arm = borne.first - place * borne.mass;
        let along = arm.dot(tangent);
        self.borne = borne.mass;
        self.energy = self.compliance / 2.0 * gravity * gravity * (arm.length_squared() + along * along);
        self.slowness = self.compliance * borne.about(place);
    }
}

pub(crate) const fn is_fruit(kind: OrganKind) -> bool {
    matches!(kind, OrganKind::Fruit | OrganKind::Syncarp)
}

/// Returns the axis of a node and the arc length there. The first node of a borne axis lies at its base.
pub(crate) fn place_of(plant: &Plant, lines: &[Line], node: NodeId) -> (usize, f64) {
    let axis = plant.nodes.axis[node.index()].index();
    (axis, lines[axis].arcs[node.index() - plant.axes[axis].nodes.start as usize])
}

/// Returns the organs as masses. Cost: each shape is measured once for each kind of organ that has it.
fn weights(plant: &Plant) -> Vec<Weight> {
    let mut known: BTreeMap<(usize, OrganKind), (Weighed, Middle)> = BTreeMap::new();
    let mut all = Vec::with_capacity(plant.organs.len());
    for organ in &plant.organs {
        let shape = &plant.shapes[organ.shape.index()];
        let measured = known.entry((organ.shape.index(), organ.kind));
        let (weighed, middle) = *measured.or_insert_with(|| (weigh(organ.kind, shape), Middle::new(shape)));
        let square = organ.scale * organ.scale;
        all.push(Weight {
            mass: weighed.mass * square * if weighed.is_flat { 1.0 } else { organ.scale },
            centre: organ.frame.place(middle.centre, organ.scale),
            area_m2: weighed.area_m2 * square,
            reach_m: middle.reach_m * organ.scale,
        });
    }
    all
}

/// Centre of the bounding box of a shape at scale 1, and half of its longest side.
#[derive(Clone, Copy, Debug)]
struct Middle {
    centre: DVec3,
    reach_m: f64,
}

impl Middle {
    fn new(shape: &Shape) -> Self {
        let boxes =
            shape.corners(1.0).into_iter().map(|p| (p, p)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        let (low, high) = boxes.unwrap_or_default();
        Self { centre: low.midpoint(high), reach_m: (high - low).max_element() / 2.0 }
    }
}
