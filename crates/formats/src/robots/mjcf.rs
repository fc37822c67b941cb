//! Mechanism -> MJCF, for `MuJoCo`.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use glam::DVec3;
use mechanics::{Body, Capsule, Mechanism};

use super::{MOST_TURN_RAD, Seen, attribute, number, numbers, triple, turned_inertia};

/// Impedance of a weld, at rest and beyond a millimetre, and the width between. A fruit sags by some 0.01 mm times
/// the ratio of its weight to that of its bearer, and by 0.07 mm with `MuJoCo`'s default of 0.95; with 0.999, light
/// limbs become unstable.
const STIFF: &str = "0.99 0.99 0.001";

/// Returns the text of a model. Fruits are floating bodies, each welded to its bearer: the weld can be switched off.
pub(super) fn text(mechanism: &Mechanism, seen: &[Seen<'_>]) -> String {
    let mut writer = Writer { mechanism, seen, out: String::new() };
    writer.all();
    writer.out
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

    fn all(&mut self) {
        let name = self.mechanism.name.trim();
        let name = if name.is_empty() { "plant" } else { name };
        self.line(0, &format!(r#"<mujoco model="{}">"#, attribute(name)));
        self.line(1, r#"<compiler angle="radian" autolimits="true"/>"#);
        let (step, gravity) = (number(floored(self.mechanism.time_step_s)), number(-self.mechanism.gravity));
        let option =
            format!(r#"<option timestep="{step}" integrator="implicitfast" gravity="0 0 {gravity}"/>"#);
        self.line(1, &option);
        self.line(1, r#"<size nuser_body="2"/>"#);
        self.defaults();
        self.assets();
        self.breaking();
        self.line(1, "<worldbody>");
        let rows: Vec<usize> = (0..self.mechanism.bodies.len()).collect();
        for row in rows {
            let body = &self.mechanism.bodies[row];
            if body.parent.is_none() || body.stalk.is_some() {
                self.body(row, DVec3::ZERO, 2);
            }
        }
        self.line(1, "</worldbody>");
        self.welds();
        self.line(0, "</mujoco>");
    }

    fn defaults(&mut self) {
        self.line(1, "<default>");
        self.line(2, r#"<default class="bend">"#);
        let range = number(MOST_TURN_RAD);
        self.line(3, &format!(r#"<joint type="hinge" range="-{range} {range}"/>"#));
        self.line(2, "</default>");
        self.line(2, r#"<default class="touched">"#);
        // Two shapes touch if the type of one is in the affinity of the other: never two of the plant.
        self.line(3, r#"<geom group="3" contype="0" conaffinity="1" rgba="0.5 0.4 0.3 0.4"/>"#);
        self.line(2, "</default>");
        self.line(2, r#"<default class="seen">"#);
        self.line(3, r#"<geom type="mesh" group="2" contype="0" conaffinity="0"/>"#);
        self.line(2, "</default>");
        self.line(1, "</default>");
    }

    fn assets(&mut self) {
        if self.seen.is_empty() {
            return;
        }
        self.line(1, "<asset>");
        for seen in self.seen {
            let (name, file) = (attribute(&seen.name), attribute(&seen.file));
            // A shell, because leaves have no volume from which to compute an inertia.
            self.line(2, &format!(r#"<mesh name="{name}" file="{file}" inertia="shell"/>"#));
        }
        self.line(1, "</asset>");
    }

    /// Writes the force at which each stalk breaks, newtons.
    fn breaking(&mut self) {
        let stalks = self.mechanism.bodies.iter().filter_map(|b| Some((b, b.stalk?)));
        let lines: Vec<String> = stalks
            .map(|(body, stalk)| {
                let (name, force) = (attribute(&body.name), number(stalk.break_force_n));
                format!(r#"<numeric name="break_force_{name}" data="{force}"/>"#)
            })
            .collect();
        if lines.is_empty() {
            return;
        }
        self.line(1, "<custom>");
        lines.iter().for_each(|line| self.line(2, line));
        self.line(1, "</custom>");
    }

    fn welds(&mut self) {
        let stalks: Vec<String> = self.mechanism.bodies.iter().filter_map(|b| self.weld(b)).collect();
        if stalks.is_empty() {
            return;
        }
        self.line(1, "<equality>");
        stalks.iter().for_each(|line| self.line(2, line));
        self.line(1, "</equality>");
    }

    fn weld(&self, body: &Body) -> Option<String> {
        body.stalk?;
        let (name, parent) = (attribute(&body.name), attribute(&self.mechanism.bodies[body.parent?].name));
        // The anchor is the fruit's attachment, the origin of its body.
        Some(format!(
            r#"<weld name="stalk_{name}" body1="{parent}" body2="{name}" anchor="0 0 0" solimp="{STIFF}"/>"#
        ))
    }

    /// Writes a body and all that move on it. `frame`: the origin of the coordinates in which it is written.
    fn body(&mut self, row: usize, frame: DVec3, depth: usize) {
        let body = &self.mechanism.bodies[row];
        let name = attribute(&body.name);
        let (place, areas) = (triple(body.origin - frame), numbers([body.wood_area_m2, body.leaf_area_m2]));
        self.line(depth, &format!(r#"<body name="{name}" pos="{place}" user="{areas}">"#));
        if body.stalk.is_some() {
            self.line(depth + 1, &format!(r#"<freejoint name="{name}"/>"#));
        }
        if body.mass > 0.0 {
            let (at, mass) = (triple(body.centre - body.origin), number(body.mass));
            let inertia = numbers(turned_inertia(body.inertia));
            self.line(depth + 1, &format!(r#"<inertial pos="{at}" mass="{mass}" fullinertia="{inertia}"/>"#));
        }
        self.hinges(body, &name, depth + 1);
        for capsule in &body.capsules {
            self.line(depth + 1, &geom(capsule, body.origin));
        }
        for seen in self.seen.iter().filter(|s| s.mesh.body == row) {
            let (mesh, rgba) = (attribute(&seen.name), seen.rgba());
            self.line(
                depth + 1,
                &format!(r#"<geom class="seen" name="{mesh}" mesh="{mesh}" rgba="{rgba}"/>"#),
            );
        }
        let origin = body.origin;
        let bodies = self.mechanism.bodies.iter().enumerate();
        let moving: BTreeSet<usize> =
            bodies.filter(|(_, b)| b.parent == Some(row) && b.stalk.is_none()).map(|(k, _)| k).collect();
        for child in moving {
            self.body(child, origin, depth + 1);
        }
        self.line(depth, "</body>");
    }

    fn hinges(&mut self, body: &Body, name: &str, depth: usize) {
        let Some(joint) = body.joint else { return };
        for ((side, axis), rest) in ["a", "b"].into_iter().zip(joint.axes).zip(joint.rest_rad) {
            let (axis, stiffness) = (triple(axis), number(joint.stiffness));
            let (damping, rest) = (number(joint.damping), number(rest));
            self.line(
                depth,
                &format!(
                    r#"<joint class="bend" name="{name}_{side}" axis="{axis}" stiffness="{stiffness}" damping="{damping}" springref="{rest}"/>"#
                ),
            );
        }
    }
}

fn geom(capsule: &Capsule, origin: DVec3) -> String {
    let radius = number(capsule.radius_m);
    if capsule.from == capsule.to {
        let at = triple(capsule.from - origin);
        return format!(r#"<geom class="touched" type="sphere" size="{radius}" pos="{at}"/>"#);
    }
    let ends = format!("{} {}", triple(capsule.from - origin), triple(capsule.to - origin));
    format!(r#"<geom class="touched" type="capsule" size="{radius}" fromto="{ends}"/>"#)
}

/// Rounds a time step down to one digit.
fn floored(seconds: f64) -> f64 {
    let mut unit = 1.0;
    while unit * 10.0 > seconds && unit > 1e-12 {
        unit /= 10.0;
    }
    (seconds / unit * (1.0 + 1e-12)).floor() * unit
}
