//! Turns a plant into a mechanism.

use base::{Counted, Report, Run};
use glam::{DMat3, DVec3};
use plant::{AxisId, AxisKind, Organ, Plant};

use crate::choice::{Bend, choose};
use crate::fruits::{Fruits, tell_of_overload};
use crate::line::{Line, Lines, Weight, is_fruit, place_of};
use crate::mechanism::{Runs, outer, parallel};
use crate::{Body, Capsule, MechanicsError, Mechanism, SpringJoint, Stalk, WoodGroup};

/// Settings of the conversion of a plant to a mechanism.
///
/// ```
/// assert_eq!(mechanics::MechanicsSpec::default().most_joints, 200);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MechanicsSpec {
    /// Most hinges; two make a joint. Default 200.
    pub most_joints: u32,
    /// Group of the woody axes; green stems and stalks count as green in any group. Default hardwood.
    pub group: WoodGroup,
    /// Share of critical damping with which each limb swings in its lowest mode, above 0. Default 0.1: trees and stems
    /// in still air have 0.02 to 0.2 (Moore and Maguire 2004 give the range of trees).
    pub damping_ratio: f64,
    /// Gravity, metres per second squared, downwards; 0 for none. Default 9.81.
    pub gravity: f64,
}

impl Default for MechanicsSpec {
    fn default() -> Self {
        Self { most_joints: 200, group: WoodGroup::Hardwood, damping_ratio: 0.1, gravity: 9.81 }
    }
}

/// Gravity of the reference load if the mechanism has none, m/s2: only ratios of energies matter.
const REFERENCE_GRAVITY: f64 = 9.81;

/// Most capsules of a mechanism; the largest are kept.
const MOST_CAPSULES: usize = 1000;

/// Deviation of wood from a capsule's axis, as a share of its length, above which the capsule is divided.
const STRAIGHT: f64 = 0.05;

/// Share of the trace of the inertia that is added about each axis, so that no axis exceeds the sum of the other two
/// after the numbers are rounded for a file (for flat bodies they are equal).
const ROUNDING: f64 = 1e-5;

/// Least inertia about any axis of any body, kg m2: a thousandth of that of the lightest limb
/// (`choice::LIGHTEST_KG_M2`), so that a hair is still a body for `MuJoCo`.
const LEAST_INERTIA_KG_M2: f64 = 1e-12;

/// Converts a plant to rigid bodies and springy joints.
///
/// Guaranteed: at most [`MechanicsSpec::most_joints`] hinges; the masses of the bodies are volume times density of all
/// wood above the ground plus the weight of all organs; the plant rests in the pose in which it was made; a fruit that
/// can break off hangs on a stalk that holds twice its weight, on wood that is heavy enough for a simulator to hold it;
/// the same bits on every platform. Roots are held by the soil and weigh nothing; stubs, and stalks of single fruits
/// that can break off, do not bend. Not modelled: torsion of wood, growth stresses, the taper of a joint's run (its
/// compliance is that of the tapered wood), collisions of the plant with itself.
/// Cost: linear in nodes and organs; some 0.1 s for the frequencies of 200 hinges.
///
/// Joints: see `docs/engines/robots.md`. Euler-Bernoulli beams, I = pi r^4 / 4, k = E I / L; the frequency of a limb by
/// Dunkerley (1894).
///
/// # Errors
/// [`MechanicsError`] for a plant without stems, without thickness or beyond the budget.
pub fn articulate(
    plant: &Plant,
    spec: &MechanicsSpec,
    run: &Run<'_>,
    report: &mut Report,
) -> Result<Mechanism, MechanicsError> {
    let pieces = plant.nodes.position.len() as u64 + plant.organs.len() as u64;
    run.budget.check(Counted::Pieces, pieces, "grow a smaller plant, or one without leaves")?;
    if let Some(fault) = plant.validate().next() {
        return Err(MechanicsError::Unsound(fault));
    }
    let gravity = if spec.gravity > 0.0 { spec.gravity } else { REFERENCE_GRAVITY };
    let mut lines = Lines::new(plant, spec.group, gravity);
    check(&lines)?;
    let fruits = Fruits::new(plant, &mut lines, gravity);
    let bends = choose(&lines, spec.most_joints / 2);
    let base = Draft::new("base".to_owned(), None, foot(plant));
    let mut build = Build { plant, lines: &lines, bodies: vec![base], runs: Vec::new() };
    for (row, bends) in bends.iter().enumerate() {
        build.axis(row, bends);
    }
    let organ_bodies = build.organs(&fruits, report);
    tell_of_overload(&lines, report);
    let Build { bodies, runs, .. } = build;
    let mut bodies: Vec<Body> = bodies.into_iter().map(Draft::body).collect();
    keep_largest(&mut bodies);
    let mut made = Mechanism {
        name: plant.name.clone(),
        bodies,
        gravity: spec.gravity,
        time_step_s: 0.0,
        runs,
        organ_bodies,
    };
    made.settle(spec, report)?;
    Ok(made)
}

/// Returns the place where the plant stands: the foot of its first axis on the ground that is not below it.
fn foot(plant: &Plant) -> DVec3 {
    let standing = plant.axes.iter().find(|a| a.bearer.is_none() && a.kind != AxisKind::Root);
    standing.map_or(DVec3::ZERO, |a| plant.nodes.position[a.nodes.start as usize])
}

fn check(lines: &Lines) -> Result<(), MechanicsError> {
    let mut shoot = lines.all.iter().filter(|l| !l.is_buried && l.length() > 0.0).peekable();
    if shoot.peek().is_none() {
        return Err(MechanicsError::NoStem);
    }
    if shoot.all(|l| l.radii.iter().all(|r| *r <= 0.0)) {
        return Err(MechanicsError::NoThickness);
    }
    for step in lines.steps.iter().flatten() {
        let numbers =
            [("the compliance", step.compliance), ("the mass", step.borne), ("the load", step.energy)];
        if let Some((what, value)) = numbers.into_iter().find(|(_, value)| !value.is_finite()) {
            return Err(MechanicsError::Number { what, value });
        }
    }
    Ok(())
}

/// A body under construction.
#[derive(Debug)]
struct Draft {
    body: Body,
    first: DVec3,
    /// Inertia about the body's origin.
    about_origin: DMat3,
}

impl Draft {
    fn new(name: String, parent: Option<usize>, origin: DVec3) -> Self {
        let body = Body {
            name,
            axis: None,
            parent,
            origin,
            joint: None,
            stalk: None,
            mass: 0.0,
            centre: origin,
            inertia: DMat3::ZERO,
            capsules: Vec::new(),
            wood_area_m2: 0.0,
            leaf_area_m2: 0.0,
        };
        Self { body, first: DVec3::ZERO, about_origin: DMat3::ZERO }
    }

    /// Adds a mass with its own inertia about its centre.
    fn add(&mut self, mass: f64, centre: DVec3, own: DMat3) {
        let r = centre - self.body.origin;
        self.body.mass += mass;
        self.first += r * mass;
        self.about_origin += own + parallel(mass, r);
    }

    /// Adds a frustum of wood, as a cylinder of the same mean radius and mass.
    fn add_wood(&mut self, line: &Line, from: f64, to: f64) {
        let ((p, a), (q, b)) = (line.point_and_radius_at(from), line.point_and_radius_at(to));
        let (mass, length) = (line.mass(from, to), p.distance(q));
        let (Some(along), radius) = ((q - p).try_normalize(), f64::midpoint(a, b)) else { return };
        let round = mass * radius * radius / 2.0;
        let across = mass * (3.0 * radius * radius + length * length) / 12.0;
        let own = DMat3::IDENTITY * across + outer(along, along) * (round - across);
        // The centroid of a frustum lies towards its thicker end.
        let thick = a * a + a * b + b * b;
        let share = if thick > 0.0 { (a * a + 2.0 * a * b + 3.0 * b * b) / (4.0 * thick) } else { 0.5 };
        self.add(mass, p.lerp(q, share), own);
        self.body.wood_area_m2 += (a + b) * length;
    }

    /// Adds an organ, as a ball of its radius.
    fn add_organ(&mut self, weight: &Weight) {
        let own = DMat3::IDENTITY * (0.4 * weight.mass * weight.reach_m * weight.reach_m);
        self.add(weight.mass, weight.centre, own);
        self.body.leaf_area_m2 += weight.area_m2;
    }

    fn body(self) -> Body {
        let mut body = self.body;
        if body.mass > 0.0 {
            let r = self.first / body.mass;
            body.centre = body.origin + r;
            let about_centre = self.about_origin - parallel(body.mass, r);
            let trace = about_centre.x_axis.x + about_centre.y_axis.y + about_centre.z_axis.z;
            body.inertia = about_centre + DMat3::IDENTITY * (trace * ROUNDING + LEAST_INERTIA_KG_M2);
        }
        body
    }
}

struct Build<'a> {
    plant: &'a Plant,
    lines: &'a Lines,
    bodies: Vec<Draft>,
    runs: Vec<Runs>,
}

impl Build<'_> {
    /// Makes the bodies of an axis: the first part moves with its bearer, and a new body begins at each bend.
    fn axis(&mut self, row: usize, bends: &[Bend]) {
        let line = &self.lines.all[row];
        let length = line.length();
        let mut body = line.bearer.map_or(0, |(bearer, arc)| self.body_at(bearer, arc));
        let mut runs: Runs = vec![(0.0, body)];
        let mut from = 0.0;
        let ends = bends.iter().skip(1).map(|bend| bend.arc).chain([length]);
        // A tip that tapers to nothing would be a body without mass.
        let heavy = bends.iter().zip(ends).filter(|(bend, end)| line.mass_between(bend.arc, *end) > 0.0);
        for (k, (bend, _)) in heavy.enumerate() {
            self.wood(body, line, from, bend.arc);
            let name = format!("{}_{}_{}", word(line.kind), row + 1, k + 1);
            let mut draft = Draft::new(name, Some(body), line.point_and_radius_at(bend.arc).0);
            let tangent = line.tangent(bend.arc);
            let across = tangent.any_orthonormal_vector();
            draft.body.axis = Some(AxisId::new(row));
            draft.body.joint = Some(SpringJoint {
                axes: [across, tangent.cross(across)],
                stiffness: 1.0 / bend.compliance,
                damping: 0.0,
                rest_rad: [0.0; 2],
            });
            body = self.bodies.len();
            self.bodies.push(draft);
            runs.push((bend.arc / length, body));
            from = bend.arc;
        }
        self.wood(body, line, from, length);
        self.runs.push(runs);
    }

    /// Returns the body to which a place of an axis belongs.
    fn body_at(&self, axis: usize, arc: f64) -> usize {
        let (runs, length) = (&self.runs[axis], self.lines.all[axis].length());
        let share = if length > 0.0 { arc / length } else { 0.0 };
        runs[runs.partition_point(|(from, _)| *from <= share).max(1) - 1].1
    }

    /// Adds the wood of a part of an axis to a body, and its capsules.
    fn wood(&mut self, body: usize, line: &Line, from: f64, to: f64) {
        if line.is_buried || to <= from {
            return;
        }
        let draft = &mut self.bodies[body];
        let stops = line.stops(from, to);
        stops.windows(2).for_each(|s| draft.add_wood(line, s[0], s[1]));
        capsules(line, &stops, &mut draft.body.capsules);
    }

    /// Adds the organs and returns the body of each. Fruits that can break off are bodies of their own, the others are
    /// part of their bearer.
    fn organs(&mut self, fruits: &Fruits, report: &mut Report) -> Vec<usize> {
        let bearers: Vec<usize> = self.plant.organs.iter().map(|organ| self.bearer_of(organ)).collect();
        // The mass of its wood alone: leaves weigh little, and other fruits hang by welds themselves.
        let wood: Vec<f64> = self.bodies.iter().map(|draft| draft.body.mass).collect();
        let hanging = fruits.breakable(|row| wood[bearers[row]], report);
        let mut rows = Vec::with_capacity(bearers.len());
        for (k, (organ, weight)) in self.plant.organs.iter().zip(&self.lines.organs).enumerate() {
            let bearer = bearers[k];
            let row = hanging.get(&k).map_or(bearer, |&break_force_n| {
                let mut draft = Draft::new(format!("fruit_{}", k + 1), Some(bearer), organ.frame.origin);
                draft.body.stalk = Some(Stalk { at: organ.frame.origin, break_force_n });
                self.bodies.push(draft);
                self.bodies.len() - 1
            });
            let draft = &mut self.bodies[row];
            draft.add_organ(weight);
            if is_fruit(organ.kind) && weight.reach_m > 0.0 {
                let (from, to) = (weight.centre, weight.centre);
                draft.body.capsules.push(Capsule { from, to, radius_m: weight.reach_m });
            }
            rows.push(row);
        }
        rows
    }

    /// Returns the body of the wood that an organ sits on; for an organ without a bearer, the body on the ground.
    fn bearer_of(&self, organ: &Organ) -> usize {
        let place = organ.bearer.map(|node| place_of(self.plant, &self.lines.all, node));
        place.map_or(0, |(axis, arc)| self.body_at(axis, arc))
    }
}

const fn word(kind: AxisKind) -> &'static str {
    match kind {
        AxisKind::Stem => "stem",
        AxisKind::Petiole => "stalk",
        AxisKind::Twig => "twig",
        AxisKind::Root => "root",
        AxisKind::Stub => "stub",
        _ => "branch",
    }
}

/// Makes capsules along a part of an axis, one for each piece that is straight enough; each has the volume of its
/// piece, not counting its ends.
fn capsules(line: &Line, stops: &[f64], out: &mut Vec<Capsule>) {
    let (Some(&from), Some(&to)) = (stops.first(), stops.last()) else { return };
    let ((p, _), (q, _)) = (line.point_and_radius_at(from), line.point_and_radius_at(to));
    let volume = line.mass_between(from, to) / line.tissue.density_kg_m3;
    let radius_m = (volume / (base::ops::PI * (to - from))).sqrt();
    let away = |k: &usize| geom::nearest_on_polyline3(&[p, q], line.point_and_radius_at(stops[*k]).0).0;
    let farthest = (1..stops.len() - 1).map(|k| (away(&k), k)).reduce(|a, b| if b.0 > a.0 { b } else { a });
    match farthest.filter(|(distance, _)| *distance > radius_m.max(STRAIGHT * (to - from))) {
        Some((_, k)) => {
            capsules(line, &stops[..=k], out);
            capsules(line, &stops[k..], out);
        }
        None if radius_m > 0.0 && radius_m.is_finite() => out.push(Capsule { from: p, to: q, radius_m }),
        None => {}
    }
}

/// Removes all but the largest capsules.
fn keep_largest(bodies: &mut [Body]) {
    let mut volumes: Vec<f64> = bodies.iter().flat_map(|b| &b.capsules).map(Capsule::volume_m3).collect();
    if volumes.len() <= MOST_CAPSULES {
        return;
    }
    base::sort_by(&mut volumes, |a, b| b.total_cmp(a));
    let least = volumes[MOST_CAPSULES - 1];
    let mut left = MOST_CAPSULES;
    for body in bodies {
        let mut keep = |c: &Capsule| {
            let keep = left > 0 && c.volume_m3() >= least;
            left -= usize::from(keep);
            keep
        };
        body.capsules.retain(&mut keep);
    }
}
