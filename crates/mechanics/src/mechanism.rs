//! The input of a simulator: rigid bodies, joints, capsules, stalks.

use glam::{DMat3, DVec3};
use plant::{AxisId, OrganId, Plant};

/// A place where a limb bends: two hinges at right angles, the second borne by the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpringJoint {
    /// Unit vectors of the two hinges, at right angles to the limb and to one another.
    pub axes: [DVec3; 2],
    /// Stiffness of each hinge, newton metres per radian: k = 1 / (integral of ds / E I), which is E I / L of a uniform
    /// run.
    pub stiffness: f64,
    /// Damping of each hinge, newton metre seconds per radian.
    pub damping: f64,
    /// Rest angles of the springs, radians: with gravity, the plant then rests in the pose in which it was made.
    pub rest_rad: [f64; 2],
}

/// A capsule for collisions, in the plant's coordinates; a ball if both ends are equal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capsule {
    /// One end of its line, metres.
    pub from: DVec3,
    /// The other end.
    pub to: DVec3,
    /// Its radius, metres, above 0.
    pub radius_m: f64,
}

impl Capsule {
    /// Returns the volume of its cylinder and its two half balls, cubic metres.
    pub fn volume_m3(&self) -> f64 {
        let r = self.radius_m;
        base::ops::PI * r * r * (self.from.distance(self.to) + 4.0 / 3.0 * r)
    }
}

/// Breakable stalk that holds a fruit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stalk {
    /// Point where the fruit hangs, in the plant's coordinates, metres.
    pub at: DVec3,
    /// Pull at which it breaks, newtons: the strength of its tissue times its cross-section.
    pub break_force_n: f64,
}

/// A rigid body of a plant. All coordinates are those of the plant, metres, +Y up.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Name, unique in the mechanism: letters, digits and `_`.
    pub name: String,
    /// The axis of the plant that its joint is on; `None` for the first body and for fruits.
    pub axis: Option<AxisId>,
    /// Row of the body that it moves on; `None` for the one that stands on the ground, which is the first.
    pub parent: Option<usize>,
    /// Origin of its coordinates: its joint or its stalk.
    pub origin: DVec3,
    /// Joint to its parent; `None` if it is fixed.
    pub joint: Option<SpringJoint>,
    /// For a fruit, the stalk by which it hangs on its parent.
    pub stalk: Option<Stalk>,
    /// Mass, kilograms, above 0 except for a first body without a part above the ground.
    pub mass: f64,
    /// Centre of mass.
    pub centre: DVec3,
    /// Inertia about the centre of mass in the plant's axes, kg m2.
    pub inertia: DMat3,
    /// Collision shape: the thickest wood, and fruits. Leaves have none.
    pub capsules: Vec<Capsule>,
    /// Area of its wood seen from the side, square metres: twice the radius times the length.
    pub wood_area_m2: f64,
    /// Area of one side of its leaves and petals plus the projected area of its fruits, square metres.
    pub leaf_area_m2: f64,
}

/// Returns the inertia of a point mass about the origin, kg m2 (Huygens and Steiner).
pub(crate) fn parallel(mass: f64, r: DVec3) -> DMat3 {
    DMat3::IDENTITY * (mass * r.length_squared()) + outer(r, r) * -mass
}

/// Returns the matrix that maps x to a (b . x).
pub(crate) fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

/// Bodies along an axis: each from a share of its length on, until the next.
pub(crate) type Runs = Vec<(f64, usize)>;

/// A plant as rigid bodies and springy joints.
///
/// ```
/// use glam::DVec3;
/// use mechanics::{MechanicsSpec, articulate};
/// let mut p = plant::Plant::default();
/// p.add_axis(plant::AxisKind::Branch, None, 1, &[DVec3::ZERO, DVec3::Y * 2.0], None);
/// p.nodes.radius_m = vec![0.02, 0.01];
/// let mut report = base::Report::default();
/// let made = articulate(&p, &MechanicsSpec::default(), &base::Run::plain(), &mut report)?;
/// let volume = std::f64::consts::PI / 3.0 * 2.0 * (0.02_f64 * 0.02 + 0.02 * 0.01 + 0.01 * 0.01);
/// assert!((made.mass() - 1000.0 * volume).abs() < 1e-9);
/// assert!(made.joints() <= 200 && made.time_step_s <= 0.002);
/// # Ok::<(), mechanics::MechanicsError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Mechanism {
    /// The plant's name.
    pub name: String,
    /// Its bodies, the one on the ground first, parents before those that move on them.
    pub bodies: Vec<Body>,
    /// Gravity that the springs are set for, m/s2, downwards.
    pub gravity: f64,
    /// Longest time step for a good simulation, seconds: 2 ms, or one over its highest frequency in radians a second,
    /// which is half of the limit of stability; with fruits that can break off, a quarter of one over the highest
    /// frequency of the wood without them.
    pub time_step_s: f64,
    pub(crate) runs: Vec<Runs>,
    pub(crate) organ_bodies: Vec<usize>,
}

impl Mechanism {
    /// Returns the mass of all bodies, kilograms.
    pub fn mass(&self) -> f64 {
        self.bodies.iter().map(|b| b.mass).sum()
    }

    /// Returns the number of hinges: two for each joint.
    pub fn joints(&self) -> usize {
        2 * self.bodies.iter().filter(|b| b.joint.is_some()).count()
    }

    /// Returns the body that an organ of the plant belongs to.
    pub fn body_of_organ(&self, organ: OrganId) -> usize {
        self.organ_bodies.get(organ.index()).copied().unwrap_or(0)
    }

    /// Returns the body to which the part of an axis nearest to a place belongs. `plant`: the one that the mechanism
    /// was made from.
    pub fn body_on_axis(&self, plant: &Plant, axis: AxisId, place: DVec3) -> usize {
        let Some(runs) = self.runs.get(axis.index()) else { return 0 };
        match runs.as_slice() {
            [] => 0,
            [(_, body)] => *body,
            _ => {
                let (_, share) = geom::nearest_on_polyline3(plant.axis_points(axis), place);
                let after = runs.partition_point(|(from, _)| *from <= share);
                runs[after.max(1) - 1].1
            }
        }
    }
}
