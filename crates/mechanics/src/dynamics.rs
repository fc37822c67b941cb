//! Small movements about the rest pose: mass and stiffness, frequencies, springs that hold the pose.

use base::Report;
use glam::{DMat3, DVec3};

use crate::mechanism::parallel;
use crate::{MechanicsError, MechanicsSpec, Mechanism};

/// Longest time step, seconds: the usual one of simulators of robots.
const LONGEST_STEP_S: f64 = 0.002;

/// Longest time step of a plant whose fruits hang by welds, times the highest frequency of the wood without them in radians
/// a second: a weld of `MuJoCo` that holds a fruit of up to 50 times the mass of its bearer shakes it more and more from
/// 0.5 on, and is still at 0.35.
const WELD_STEP: f64 = 0.25;

/// Steps of the iterations for frequencies: the ratio of two neighbouring frequencies is seldom nearer to 1 than 0.9,
/// and the frequency converges twice as fast as the mode.
const ITERATIONS: usize = 60;

/// Most times that springs are stiffened by half until a plant stands: 40 times is more than ten million fold.
const MOST_STIFFENED: u32 = 40;

/// Factor between the stiffness of a stiffened axis and the least that bears its load.
const MARGIN: f64 = 2.0;

/// Lowest and highest frequency of a mechanism, hertz.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frequencies {
    /// Lowest frequency.
    pub lowest_hz: f64,
    /// Highest frequency, which bounds the time step.
    pub highest_hz: f64,
}

/// A hinge in the rest pose.
#[derive(Clone, Copy, Debug)]
struct Hinge {
    body: usize,
    axis: DVec3,
    at: DVec3,
    stiffness: f64,
}

/// A body together with all bodies that move on it.
#[derive(Clone, Copy, Debug)]
struct Limb {
    mass: f64,
    centre: DVec3,
    /// Inertia about the centre of mass.
    inertia: DMat3,
}

impl Limb {
    fn join(&mut self, other: &Self) {
        let mass = self.mass + other.mass;
        if mass <= 0.0 {
            return;
        }
        let centre = (self.centre * self.mass + other.centre * other.mass) / mass;
        let moved = |limb: &Self| limb.inertia + parallel(limb.mass, limb.centre - centre);
        *self = Self { mass, centre, inertia: moved(self) + moved(other) };
    }

    /// Returns the inertia about an axis through a place.
    fn about(&self, axis: DVec3, at: DVec3) -> f64 {
        axis.dot(self.inertia * axis) + self.mass * axis.cross(self.centre - at).length_squared()
    }
}

/// A symmetric matrix, row by row.
#[derive(Clone, Debug)]
struct Matrix {
    side: usize,
    rows: Vec<f64>,
}

impl Matrix {
    fn times(&self, x: &[f64]) -> Vec<f64> {
        self.rows.chunks_exact(self.side).map(|row| row.iter().zip(x).map(|(a, b)| a * b).sum()).collect()
    }

    /// Solves for `right`; `None` if the matrix is not positive definite. Scales to a diagonal of ones first, as a
    /// trunk's inertia may be 1e12 times that of a twig.
    fn solve(&self, right: &[f64]) -> Option<Vec<f64>> {
        let n = self.side;
        let scale: Vec<f64> = (0..n).map(|i| 1.0 / self.rows[i * n + i].sqrt()).collect();
        if !scale.iter().all(|s| s.is_finite()) {
            return None;
        }
        let mut scaled: Vec<f64> = (0..n * n).map(|k| self.rows[k] * scale[k / n] * scale[k % n]).collect();
        let mut x: Vec<f64> = right.iter().zip(&scale).map(|(b, s)| b * s).collect();
        geom::solve_positive(&mut scaled, &mut x)?;
        Some(x.iter().zip(&scale).map(|(x, s)| x * s).collect())
    }
}

impl Mechanism {
    /// Returns the lowest and the highest frequency of small oscillations about the rest pose, with gravity and without
    /// damping; `None` for a mechanism without joints.
    ///
    /// Frequencies of the generalised eigenproblem K x = w^2 M x in the angles of the hinges, by inverse and by direct
    /// iteration; the highest may be a few per cent too low if several are close. Cost: n^3, some 0.1 s for 200 hinges.
    pub fn frequencies(&self) -> Option<Frequencies> {
        let (mass, stiffness) = self.matrices();
        let lowest = squared_frequency(&stiffness, &mass, |x| stiffness.solve(&mass.times(x)))?;
        let highest = squared_frequency(&stiffness, &mass, |x| mass.solve(&stiffness.times(x)))?;
        let hertz = |squared: f64| squared.max(0.0).sqrt() / base::ops::TAU;
        Some(Frequencies { lowest_hz: hertz(lowest), highest_hz: hertz(highest) })
    }

    /// Returns the displacement of a place of a body under a small steady force on it, metres, by the springs alone:
    /// angles q = k^-1 J^T F of the joints below it, and J q.
    ///
    /// `body`: a row of [`bodies`](Self::bodies). Not included: the weight of the plant, and the effect of large
    /// angles.
    pub fn deflection(&self, body: usize, place: DVec3, force: DVec3) -> DVec3 {
        let mut moved = DVec3::ZERO;
        let mut at = Some(body);
        while let Some(body) = at.and_then(|row| self.bodies.get(row)) {
            for axis in body.joint.iter().flat_map(|j| j.axes) {
                let (stiffness, lever) =
                    (body.joint.map_or(f64::INFINITY, |j| j.stiffness), axis.cross(place - body.origin));
                moved += lever * (lever.dot(force) / stiffness);
            }
            at = body.parent;
        }
        moved
    }

    /// Sets springs, dampers and the time step.
    pub(crate) fn settle(&mut self, spec: &MechanicsSpec, report: &mut Report) -> Result<(), MechanicsError> {
        self.stand(report);
        let limbs = self.limbs();
        self.damp(spec.damping_ratio, &limbs);
        for (body, limb) in self.bodies.iter_mut().zip(&limbs) {
            let Some(joint) = &mut body.joint else { continue };
            let weight = DVec3::Y * (self.gravity * limb.mass);
            let lever = limb.centre - body.origin;
            joint.rest_rad = joint.axes.map(|axis| axis.cross(lever).dot(weight) / joint.stiffness);
        }
        let unknown = if self.joints() > 0 { f64::NAN } else { 0.0 };
        let highest = self.frequencies().map_or(unknown, |f| f.highest_hz * base::ops::TAU);
        self.time_step_s = if highest > 0.0 { LONGEST_STEP_S.min(1.0 / highest) } else { LONGEST_STEP_S };
        if let Some(free) = self.frequencies_without_fruits() {
            self.time_step_s = self.time_step_s.min(WELD_STEP / (free.highest_hz * base::ops::TAU));
        }
        let numbers = [("the mass", self.mass()), ("the highest frequency", highest)];
        match numbers.into_iter().find(|(_, value)| !value.is_finite()) {
            Some((what, value)) => Err(MechanicsError::Number { what, value }),
            None => Ok(()),
        }
    }

    /// Returns the frequencies once all fruits that can break off are gone; `None` without such fruits.
    fn frequencies_without_fruits(&self) -> Option<Frequencies> {
        let mut bare = self.clone();
        let mut fruits = bare.bodies.iter_mut().filter(|body| body.stalk.is_some()).peekable();
        fruits.peek()?;
        for fruit in fruits {
            (fruit.mass, fruit.inertia) = (0.0, DMat3::ZERO);
        }
        bare.frequencies().filter(|f| f.highest_hz > 0.0)
    }

    /// Stiffens the springs of a plant that would fall over under its own weight, and warns: first of each axis that
    /// sags by itself, then of the whole plant, if that still falls.
    fn stand(&mut self, report: &mut Report) {
        let (mut most, mut axes) = (1.0, 0);
        for rows in self.axes_of_joints() {
            let times = self.stiffen(&rows);
            if times > 1.0 {
                // An axis that just bears its load by itself would not do so on a bearer that yields.
                self.multiply_stiffness(&rows, MARGIN);
                axes += 1;
                most = (times * MARGIN).max(most);
            }
        }
        let all: Vec<usize> =
            (0..self.bodies.len()).filter(|&row| self.bodies[row].joint.is_some()).collect();
        let whole = self.stiffen(&all);
        let (axes, times) =
            if whole > 1.0 { (self.axes_of_joints().len(), whole * most) } else { (axes, most) };
        if times > 1.0 {
            base::warn!(
                report,
                "would-fall",
                { axes = axes, times = format!("{times:.1}") },
                "{axes} of its axes are too thin for what they bear: their joints were made up to {times} times as stiff so that they stand; give them thicker stems"
            );
        }
    }

    /// Returns, for each axis with joints, the rows of the bodies that these move.
    fn axes_of_joints(&self) -> Vec<Vec<usize>> {
        let mut all: Vec<Vec<usize>> = Vec::new();
        for (row, body) in self.bodies.iter().enumerate().filter(|(_, b)| b.joint.is_some()) {
            match all.last_mut().filter(|rows| self.bodies[rows[0]].axis == body.axis) {
                Some(rows) => rows.push(row),
                None => all.push(vec![row]),
            }
        }
        all
    }

    /// Stiffens some joints by half repeatedly until they bear the load that moves on them, the rest of the plant being
    /// rigid; returns the factor.
    fn stiffen(&mut self, rows: &[usize]) -> f64 {
        let mut times = 1.0;
        for _ in 0..MOST_STIFFENED {
            let hinges = self.hinges();
            let own: Vec<usize> = (0..hinges.len()).filter(|&i| rows.contains(&hinges[i].body)).collect();
            let (_, stiffness) = self.matrices();
            let part = own.iter().flat_map(|&i| own.iter().map(move |&j| (i, j)));
            let values = part.map(|(i, j)| stiffness.rows[i * stiffness.side + j]).collect();
            let part = Matrix { side: own.len(), rows: values };
            if own.is_empty() || part.solve(&vec![1.0; own.len()]).is_some() {
                break;
            }
            times *= 1.5;
            self.multiply_stiffness(rows, 1.5);
        }
        times
    }

    fn multiply_stiffness(&mut self, rows: &[usize], times: f64) {
        for &row in rows {
            if let Some(joint) = &mut self.bodies[row].joint {
                joint.stiffness *= times;
            }
        }
    }

    /// Damps each limb: d = 2 z k / w, with w the lowest frequency of the limb by itself, 1 / w^2 = sum of I / k over
    /// its joints (Dunkerley 1894). In its lowest mode it then has the share z of critical damping, in faster ones
    /// more.
    fn damp(&mut self, ratio: f64, limbs: &[Limb]) {
        for rows in self.axes_of_joints() {
            let own = |row: &usize| {
                let body = &self.bodies[*row];
                let joint = body.joint?;
                let inertia = joint.axes.map(|axis| limbs[*row].about(axis, body.origin));
                Some(f64::midpoint(inertia[0], inertia[1]) / joint.stiffness)
            };
            let slowness: f64 = rows.iter().filter_map(own).sum();
            for row in rows {
                if let Some(joint) = &mut self.bodies[row].joint {
                    joint.damping = 2.0 * ratio * joint.stiffness * slowness.sqrt();
                }
            }
        }
    }

    /// Returns each body together with all bodies that move on it.
    fn limbs(&self) -> Vec<Limb> {
        let limb = |b: &crate::Body| Limb { mass: b.mass, centre: b.centre, inertia: b.inertia };
        let mut limbs: Vec<Limb> = self.bodies.iter().map(limb).collect();
        for row in (1..self.bodies.len()).rev() {
            let own = limbs[row];
            if let Some(parent) = self.bodies[row].parent {
                limbs[parent].join(&own);
            }
        }
        limbs
    }

    fn hinges(&self) -> Vec<Hinge> {
        let rows = self.bodies.iter().enumerate().filter_map(|(row, body)| Some((row, body, body.joint?)));
        let both = |(body, b, j): (usize, &crate::Body, crate::SpringJoint)| {
            j.axes.map(|axis| Hinge { body, axis, at: b.origin, stiffness: j.stiffness })
        };
        rows.flat_map(both).collect()
    }

    /// Returns mass and stiffness in the angles of the hinges.
    ///
    /// `M_ij = a_i . (I a_j) + m (a_i x r_i) . (a_j x r_j)` of the limb that both move, r from each hinge to its
    /// centre; `K_ij = k_i d_ij + m g up . (a_i x (a_j x r_j))`, whose second term is the effect of weight.
    fn matrices(&self) -> (Matrix, Matrix) {
        let (hinges, limbs) = (self.hinges(), self.limbs());
        let side = hinges.len();
        let mut mass = Matrix { side, rows: vec![0.0; side * side] };
        let mut stiffness = mass.clone();
        for (j, hinge) in hinges.iter().enumerate() {
            let limb = &limbs[hinge.body];
            let (spin, sweep) = (limb.inertia * hinge.axis, hinge.axis.cross(limb.centre - hinge.at));
            for i in self.hinges_below(&hinges, j) {
                let other = &hinges[i];
                let lever = other.axis.cross(limb.centre - other.at);
                let m = other.axis.dot(spin) + limb.mass * lever.dot(sweep);
                let spring = if i == j { hinge.stiffness } else { 0.0 };
                let k = spring + limb.mass * self.gravity * other.axis.cross(sweep).y;
                for (row, column) in [(i, j), (j, i)] {
                    mass.rows[row * side + column] = m;
                    stiffness.rows[row * side + column] = k;
                }
            }
        }
        (mass, stiffness)
    }

    /// Returns the rows of the hinges that move a hinge's body: its own, and those of the bodies that it moves on.
    fn hinges_below(&self, hinges: &[Hinge], row: usize) -> Vec<usize> {
        let mut below = Vec::new();
        let mut at = Some(hinges[row].body);
        while let Some(body) = at {
            // Two hinges per body, in the order of the bodies.
            let first = hinges.partition_point(|h| h.body < body);
            below.extend((first..hinges.len()).take_while(|&i| hinges[i].body == body && i <= row));
            at = self.bodies[body].parent;
        }
        below
    }
}

/// Returns the squared frequency to which an iteration converges, by Rayleigh's quotient.
fn squared_frequency(
    stiffness: &Matrix,
    mass: &Matrix,
    step: impl Fn(&[f64]) -> Option<Vec<f64>>,
) -> Option<f64> {
    if mass.side == 0 {
        return None;
    }
    // Uneven, so that it has a component in every mode.
    let mut x: Vec<f64> = (0_u32..).take(mass.side).map(|i| 1.0 + f64::from(i * 7 % 11) / 11.0).collect();
    for _ in 0..ITERATIONS {
        x = step(&x)?;
        let size = x.iter().map(|v| v.abs()).fold(0.0, f64::max);
        if size <= 0.0 || !size.is_finite() {
            return None;
        }
        x.iter_mut().for_each(|v| *v /= size);
    }
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    Some(dot(&x, &stiffness.times(&x)) / dot(&x, &mass.times(&x)))
}
