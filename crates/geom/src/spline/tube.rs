//! Rings of points around a ball B-spline: the surface of a vein.

use base::ops;
use glam::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::ball::{BallBSpline, Jet};
use crate::frame::{perpendicular, rotation_minimising_frames};

/// Placement of a ring of the tube.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RingRule {
    /// A circle of the ball's radius in the plane across the centre line (Wang et al. 2011).
    #[default]
    Plain,
    /// The circle in which the ball touches the envelope of all balls: the exact surface. The same as plain
    /// where the radius does not change.
    Envelope,
}

/// Closing of the ends of a tube.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EndCap {
    /// Nothing: the paper's tubes are open.
    #[default]
    Open,
    /// The free part of the end ball, in this many rings (at least 1) and a pole.
    Round(u32),
}

/// Resolution and rule of the sampling of a tube.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallTubeSpec {
    /// The rule of the rings.
    pub rings: RingRule,
    /// Points per ring, 3 to 1024; the paper has 10.
    pub sides: usize,
    /// The ends.
    pub cap: EndCap,
    /// Direction of the first point of the first ring; chosen by a fixed rule if absent.
    pub first_normal: Option<DVec3>,
}

impl Default for BallTubeSpec {
    fn default() -> Self {
        Self { rings: RingRule::Plain, sides: 10, cap: EndCap::Open, first_normal: None }
    }
}

/// The surface of a tube.
///
/// The first `rings * sides` points are the rings in order; caps follow. Quads and triangles wind
/// counter-clockwise seen from outside.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tube {
    /// Points.
    pub positions: Vec<DVec3>,
    /// Outward unit vectors, one per point.
    pub normals: Vec<DVec3>,
    /// Number of rings along the tube, without those of the caps.
    pub rings: usize,
    /// Points per ring.
    pub sides: usize,
    /// Faces between rings.
    pub quads: Vec<[u32; 4]>,
    /// Faces at the poles of the caps.
    pub triangles: Vec<[u32; 3]>,
    /// Rings whose ball lies inside its neighbours (|r'| >= |c'|), so that it does not touch the envelope;
    /// such a ring is the pole of its ball. Always 0 for plain rings.
    pub swallowed: usize,
    /// Rings at which the tube is thicker than its centre line bends (radius times curvature at least 1): its surface
    /// intersects itself there.
    pub crossing: usize,
}

/// One ring before its points are made.
struct Ring {
    centre: DVec3,
    tangent: DVec3,
    radius: f64,
    // Sine of the angle by which the ring is shifted along the tangent and its normals lean: -r' / |c'|.
    lean: f64,
}

impl BallBSpline {
    /// Makes the tube's surface with a ring at each of `parameters`, which should increase.
    ///
    /// Frames rotate as little as possible (double reflection). With [`RingRule::Envelope`] every point lies on the
    /// envelope: `x = c - (r r' / |c'|^2) c' + r sqrt(1 - r'^2 / |c'|^2) (N cos + B sin)` with the outward normal
    /// `(x - c) / r`. Fewer than 2 parameters give an empty tube. Cost: linear in the points.
    pub fn tube(&self, parameters: &[f64], spec: &BallTubeSpec) -> Tube {
        let sides = spec.sides.clamp(3, 1024);
        let mut tube = Tube { sides, ..Tube::default() };
        if parameters.len() < 2 {
            return tube;
        }
        let jets: Vec<Jet> = parameters.iter().map(|&t| self.jet(t)).collect();
        let centres: Vec<DVec3> = jets.iter().map(|j| j.ball.centre).collect();
        let frames = rotation_minimising_frames(&centres, spec.first_normal);
        let mut ends = Vec::with_capacity(2);
        for (k, (jet, frame)) in jets.iter().zip(&frames).enumerate() {
            let speed = jet.first.centre.length();
            // The frames' tangents are those of the sampled line; the ring is across the curve's own.
            let tangent = jet.first.centre.try_normalize().unwrap_or(frame.tangent);
            let normal = perpendicular(tangent, Some(frame.normal));
            if jet.ball.radius * curvature(jet) >= 1.0 {
                tube.crossing += 1;
            }
            let mut lean = 0.0;
            if spec.rings == RingRule::Envelope && speed > 0.0 {
                let slope = jet.first.radius / speed;
                if slope.abs() >= 1.0 {
                    tube.swallowed += 1;
                }
                lean = -slope.clamp(-1.0, 1.0);
            }
            let ring = Ring { centre: jet.ball.centre, tangent, radius: jet.ball.radius, lean };
            tube.push_ring(&ring, normal);
            if k == 0 || k + 1 == jets.len() {
                ends.push((ring, normal));
            }
        }
        tube.rings = parameters.len();
        for k in 1..tube.rings {
            tube.join((k - 1) * sides, k * sides);
        }
        if let (EndCap::Round(rings), [first, last]) = (spec.cap, ends.as_slice()) {
            tube.close(first, 0, true, rings);
            tube.close(last, (tube.rings - 1) * sides, false, rings);
        }
        tube
    }
}

fn curvature(jet: &Jet) -> f64 {
    let (a, b) = (jet.first.centre, jet.second.centre);
    let speed = a.length();
    if speed > 0.0 { a.cross(b).length() / (speed * speed * speed) } else { 0.0 }
}

impl Tube {
    /// Returns the number of faces: quads between rings and triangles of the caps.
    pub fn faces(&self) -> usize {
        self.quads.len() + self.triangles.len()
    }

    fn push_ring(&mut self, ring: &Ring, normal: DVec3) {
        let binormal = ring.tangent.cross(normal);
        let flat = (1.0 - ring.lean * ring.lean).max(0.0).sqrt();
        for k in 0..self.sides {
            let (sin, cos) = ops::sin_cos(ops::TAU * k as f64 / self.sides as f64);
            let out = ring.tangent * ring.lean + (normal * cos + binormal * sin) * flat;
            self.positions.push(ring.centre + out * ring.radius);
            self.normals.push(out);
        }
    }

    /// Adds the quads between two rings, the second further along the tangent.
    fn join(&mut self, from: usize, to: usize) {
        let index = |i: usize| u32::try_from(i).unwrap_or(u32::MAX);
        for k in 0..self.sides {
            let next = (k + 1) % self.sides;
            self.quads.push([from + k, from + next, to + next, to + k].map(index));
        }
    }

    /// Adds the rest of the end ball beyond the ring that starts at `edge`.
    fn close(&mut self, (end, normal): &(Ring, DVec3), edge: usize, start: bool, rings: u32) {
        let rings = rings.clamp(1, 64);
        let pole: f64 = if start { -1.0 } else { 1.0 };
        let (from, to) = (ops::asin(end.lean), pole * ops::FRAC_PI_2);
        let mut last = edge;
        for k in 1..rings {
            let lean = ops::sin(from + (to - from) * f64::from(k) / f64::from(rings));
            let place = self.positions.len();
            self.push_ring(&Ring { lean, ..*end }, *normal);
            if start {
                self.join(place, last)
            } else {
                self.join(last, place)
            }
            last = place;
        }
        let tip = self.positions.len();
        self.positions.push(end.centre + end.tangent * (pole * end.radius));
        self.normals.push(end.tangent * pole);
        let index = |i: usize| u32::try_from(i).unwrap_or(u32::MAX);
        for k in 0..self.sides {
            let (a, b) = (last + k, last + (k + 1) % self.sides);
            let corners = if start { [tip, b, a] } else { [a, b, tip] };
            self.triangles.push(corners.map(index));
        }
    }
}
