//! Mechanism -> URDF, for ROS, Gazebo and Isaac Sim.

use std::fmt::Write as _;

use glam::{DMat3, DVec3};
use mechanics::{Body, Capsule, Mechanism, SpringJoint};

use super::{MOST_TURN_RAD, Seen, attribute, number, triple, turned, turned_inertia};

/// Share of a body's mass and inertia that goes to the link between its two hinges: a link without mass is refused.
const BETWEEN: f64 = 1e-3;

/// Least inertia of that link, kilogram square metres: readers refuse less than 1e-15.
const LEAST_INERTIA: f64 = 1e-14;

/// Limits of a hinge's moment and speed, newton metres and radians a second. URDF demands them; springs of plants do
/// not reach them.
const LIMITS: [f64; 2] = [1e6, 1e3];

/// Returns the text of a robot, fixed to the link `world`.
pub(super) fn text(mechanism: &Mechanism, seen: &[Seen<'_>]) -> String {
    let mut writer = Writer { mechanism, seen, out: String::new() };
    let name = mechanism.name.trim();
    let name = if name.is_empty() { "plant" } else { name };
    writer.line(0, r#"<?xml version="1.0"?>"#);
    writer.line(0, &format!(r#"<robot name="{}">"#, attribute(name)));
    writer.line(1, r#"<link name="world"/>"#);
    for (row, body) in mechanism.bodies.iter().enumerate() {
        writer.body(row, body);
    }
    writer.line(0, "</robot>");
    writer.out
}

/// Returns the inertia that is alike about all axes and as large as half of the trace: about the largest of a rod. Readers
/// find the axes of a tensor up to 1e-12 of a kilogram square metre, below which a slender link has none.
fn even(inertia: DMat3) -> DMat3 {
    let trace = inertia.x_axis.x + inertia.y_axis.y + inertia.z_axis.z;
    DMat3::from_diagonal(DVec3::splat((0.5 * trace).max(LEAST_INERTIA)))
}

struct Writer<'a> {
    mechanism: &'a Mechanism,
    seen: &'a [Seen<'a>],
    out: String,
}

impl Writer<'_> {
    fn line(&mut self, depth: usize, text: &str) {
        // Writing to a string cannot fail.
        let _ = writeln!(self.out, "{:width$}{text}", "", width = 2 * depth);
    }

    fn body(&mut self, row: usize, body: &Body) {
        let name = attribute(&body.name);
        let parent = body.parent.map(|p| &self.mechanism.bodies[p]);
        let (bearer, frame) = parent.map_or(("world", DVec3::ZERO), |p| (p.name.as_str(), p.origin));
        let bearer = attribute(bearer);
        match &body.joint {
            Some(joint) => {
                let between = format!("{name}_between");
                self.line(1, &format!(r#"<link name="{between}">"#));
                self.inertia(body, BETWEEN * body.mass, even(BETWEEN * body.inertia));
                self.line(1, "</link>");
                self.link(row, body, 1.0 - BETWEEN);
                self.hinge(&format!("{name}_a"), (&bearer, &between), body.origin - frame, joint, 0);
                self.hinge(&format!("{name}_b"), (&between, &name), DVec3::ZERO, joint, 1);
            }
            None => {
                self.link(row, body, 1.0);
                self.line(1, &format!(r#"<joint name="{name}_fixed" type="fixed">"#));
                self.between((&bearer, &name), body.origin - frame);
                self.line(1, "</joint>");
            }
        }
    }

    fn link(&mut self, row: usize, body: &Body, share: f64) {
        self.line(1, &format!(r#"<link name="{}">"#, attribute(&body.name)));
        self.inertia(body, share * body.mass, share * body.inertia);
        for capsule in &body.capsules {
            self.collision(capsule, body.origin);
        }
        for seen in self.seen.iter().filter(|s| s.mesh.body == row) {
            let (name, file, rgba) = (attribute(&seen.name), attribute(&seen.file), seen.rgba());
            self.line(2, &format!(r#"<visual name="{name}">"#));
            self.line(3, &format!(r#"<geometry><mesh filename="{file}"/></geometry>"#));
            self.line(3, &format!(r#"<material name="{name}"><color rgba="{rgba}"/></material>"#));
            self.line(2, "</visual>");
        }
        self.line(1, "</link>");
    }

    /// Writes a mass with its inertia about the centre of a body.
    fn inertia(&mut self, body: &Body, mass: f64, inertia: DMat3) {
        if body.mass <= 0.0 {
            return;
        }
        let [xx, yy, zz, xy, xz, yz] = turned_inertia(inertia).map(number);
        self.line(2, "<inertial>");
        self.line(3, &format!(r#"<origin xyz="{}"/>"#, triple(body.centre - body.origin)));
        self.line(3, &format!(r#"<mass value="{}"/>"#, number(mass)));
        self.line(
            3,
            &format!(r#"<inertia ixx="{xx}" iyy="{yy}" izz="{zz}" ixy="{xy}" ixz="{xz}" iyz="{yz}"/>"#),
        );
        self.line(2, "</inertial>");
    }

    /// Writes a cylinder with a ball at each end: URDF has no capsules.
    fn collision(&mut self, capsule: &Capsule, origin: DVec3) {
        let radius = number(capsule.radius_m);
        let mut ends = vec![capsule.from];
        if capsule.from != capsule.to {
            ends.push(capsule.to);
            let (middle, length) = (capsule.from.midpoint(capsule.to), capsule.from.distance(capsule.to));
            let [roll, pitch] = lying(capsule.to - capsule.from).map(number);
            self.line(2, "<collision>");
            let place = triple(middle - origin);
            self.line(3, &format!(r#"<origin xyz="{place}" rpy="{roll} {pitch} 0"/>"#));
            let length = number(length);
            self.line(3, &format!(r#"<geometry><cylinder radius="{radius}" length="{length}"/></geometry>"#));
            self.line(2, "</collision>");
        }
        for end in ends {
            self.line(2, "<collision>");
            self.line(3, &format!(r#"<origin xyz="{}"/>"#, triple(end - origin)));
            self.line(3, &format!(r#"<geometry><sphere radius="{radius}"/></geometry>"#));
            self.line(2, "</collision>");
        }
    }

    fn between(&mut self, (parent, child): (&str, &str), place: DVec3) {
        self.line(2, &format!(r#"<origin xyz="{}"/>"#, triple(place)));
        self.line(2, &format!(r#"<parent link="{parent}"/>"#));
        self.line(2, &format!(r#"<child link="{child}"/>"#));
    }

    fn hinge(&mut self, name: &str, links: (&str, &str), place: DVec3, joint: &SpringJoint, side: usize) {
        let [effort, speed] = LIMITS.map(number);
        let range = number(MOST_TURN_RAD);
        self.line(1, &format!(r#"<joint name="{name}" type="revolute">"#));
        self.between(links, place);
        self.line(2, &format!(r#"<axis xyz="{}"/>"#, triple(joint.axes[side])));
        self.line(
            2,
            &format!(r#"<limit lower="-{range}" upper="{range}" effort="{effort}" velocity="{speed}"/>"#),
        );
        self.line(2, &format!(r#"<dynamics damping="{}" friction="0"/>"#, number(joint.damping)));
        self.line(1, "</joint>");
        self.line(1, &format!(r#"<gazebo reference="{name}">"#));
        self.line(2, "<implicitSpringDamper>1</implicitSpringDamper>");
        self.line(2, &format!("<springReference>{}</springReference>", number(joint.rest_rad[side])));
        self.line(2, &format!("<springStiffness>{}</springStiffness>", number(joint.stiffness)));
        self.line(1, "</gazebo>");
    }
}

/// Returns the roll and pitch that turn the z axis of a cylinder along a direction of the plant: the axis becomes
/// (sin p cos r, -sin r, cos p cos r).
fn lying(direction: DVec3) -> [f64; 2] {
    let d = turned(direction).try_normalize().unwrap_or(DVec3::Z);
    let roll = base::ops::atan2(-d.y, base::ops::hypot(d.x, d.z));
    [roll, base::ops::atan2(d.x, d.z)]
}

#[cfg(test)]
mod tests {
    use glam::DMat3;

    use super::*;

    #[test]
    fn cylinders_lie_along_their_wood() {
        let directions = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_Y, DVec3::new(1.0, 2.0, -3.0)];
        for direction in directions {
            let [roll, pitch] = lying(direction);
            let ((sr, cr), (sp, cp)) = (base::ops::sin_cos(roll), base::ops::sin_cos(pitch));
            // R_y(pitch) R_x(roll) z.
            let turned_axis = DMat3::from_cols(
                DVec3::new(cp, 0.0, -sp),
                DVec3::new(sp * sr, cr, cp * sr),
                DVec3::new(sp * cr, -sr, cp * cr),
            ) * DVec3::Z;
            assert!((turned_axis - turned(direction).normalize()).length() < 1e-12, "{direction}");
        }
    }
}
