//! Mechanism -> USD as text, with the schemas of `UsdPhysics`.

use std::fmt::Write as _;

use base::ops;
use glam::{DMat3, DQuat, DVec3};
use mechanics::{Body, Capsule, Mechanism, SpringJoint};

use super::{MOST_TURN_RAD, Seen, number, turned, turned_inertia};
use crate::model::{Identifiers, Quoted, identifier};

/// Most sweeps of Jacobi's method: the off-diagonal of a matrix of three rows is zero to the last bit after six or so.
const SWEEPS: u32 = 24;

/// Returns the text of a layer whose root is an articulation: one rigid body for each body, side by side, and one joint
/// of two free angles for each place where wood bends.
pub(super) fn text(mechanism: &Mechanism, seen: &[Seen<'_>]) -> String {
    let name = mechanism.name.trim();
    let name = if name.is_empty() { "plant" } else { name };
    let root = identifier(name, "plant");
    let mut taken = Identifiers::default();
    taken.fresh("wood", "wood");
    let paths = mechanism.bodies.iter().map(|body| format!("/{root}/{}", taken.fresh(&body.name, "body")));
    let paths: Vec<String> = paths.collect();
    let mut writer = Writer { mechanism, seen, root, paths, taken, out: String::new() };
    writer.all(name);
    writer.out
}

struct Writer<'a> {
    mechanism: &'a Mechanism,
    seen: &'a [Seen<'a>],
    root: String,
    /// Path of each body.
    paths: Vec<String>,
    /// Names of the children of the root.
    taken: Identifiers,
    out: String,
}

impl Writer<'_> {
    fn line(&mut self, depth: usize, text: &str) {
        // Writing to a string cannot fail.
        let _ = writeln!(self.out, "{:width$}{text}", "", width = 4 * depth);
    }

    /// Opens a prim with schemas that are applied to it.
    fn open(&mut self, depth: usize, head: &str, schemas: &[&str]) {
        if schemas.is_empty() {
            self.line(depth, head);
        } else {
            let listed: Vec<String> = schemas.iter().map(|schema| format!("\"{schema}\"")).collect();
            self.line(depth, &format!("{head} ("));
            self.line(depth + 1, &format!("prepend apiSchemas = [{}]", listed.join(", ")));
            self.line(depth, ")");
        }
        self.line(depth, "{");
    }

    fn all(&mut self, name: &str) {
        let root = self.root.clone();
        self.line(0, "#usda 1.0\n(");
        self.line(1, &format!("defaultPrim = \"{root}\""));
        self.line(1, &format!("doc = \"Burgeon {}\"", env!("CARGO_PKG_VERSION")));
        self.line(1, "kilogramsPerUnit = 1\n    metersPerUnit = 1\n    upAxis = \"Z\"\n)\n");
        self.line(0, &format!("def Xform \"{root}\" ("));
        self.line(1, "prepend apiSchemas = [\"PhysicsArticulationRootAPI\"]");
        self.line(1, &format!("assetInfo = {{\n        string name = {}\n    }}", Quoted(name)));
        self.line(1, "kind = \"component\"\n)\n{");
        self.group();
        for (row, body) in self.mechanism.bodies.iter().enumerate() {
            self.body(row, body);
        }
        for (row, body) in self.mechanism.bodies.iter().enumerate() {
            self.joint(row, body);
        }
        self.line(0, "}");
    }

    /// Writes the group that keeps the plant from colliding with itself.
    fn group(&mut self) {
        let root = self.root.clone();
        self.open(1, "def PhysicsCollisionGroup \"wood\"", &["CollectionAPI:colliders"]);
        self.line(2, "uniform token collection:colliders:expansionRule = \"expandPrims\"");
        self.line(2, &format!("rel collection:colliders:includes = </{root}>"));
        self.line(2, &format!("rel physics:filteredGroups = </{root}/wood>"));
        self.line(1, "}\n");
    }

    fn body(&mut self, row: usize, body: &Body) {
        let name = self.paths[row].rsplit('/').next().unwrap_or_default().to_owned();
        let massive = body.mass > 0.0;
        let schemas: &[&str] =
            if massive { &["PhysicsRigidBodyAPI", "PhysicsMassAPI"] } else { &["PhysicsRigidBodyAPI"] };
        self.open(1, &format!("def Xform \"{name}\""), schemas);
        if massive {
            let (moments, axes) = principal(body.inertia);
            self.line(2, &format!("point3f physics:centerOfMass = {}", point(body.centre - body.origin)));
            self.line(2, &format!("float3 physics:diagonalInertia = {}", listed(moments)));
            self.line(2, &format!("float physics:mass = {}", number(body.mass)));
            self.line(2, &format!("quatf physics:principalAxes = {}", turn(axes)));
        }
        self.line(2, &format!("double3 xformOp:translate = {}", point(body.origin)));
        self.line(2, "uniform token[] xformOpOrder = [\"xformOp:translate\"]");
        for (k, capsule) in body.capsules.iter().enumerate() {
            self.shape(k + 1, capsule, body.origin);
        }
        let mut own = Identifiers::default();
        for seen in self.seen.iter().filter(|s| s.mesh.body == row) {
            let name = own.fresh(&seen.mesh.part, "part");
            self.mesh(&name, seen);
        }
        self.line(1, "}\n");
    }

    fn shape(&mut self, number_of_shape: usize, capsule: &Capsule, origin: DVec3) {
        let (radius, length) = (capsule.radius_m, capsule.from.distance(capsule.to));
        let kind = if length > 0.0 { "Capsule" } else { "Sphere" };
        let head = format!("def {kind} \"touched_{number_of_shape}\"");
        self.open(2, &head, &["PhysicsCollisionAPI"]);
        let half = if length > 0.0 { 0.5 * length + radius } else { radius };
        let (low, high) = (listed([-radius, -radius, -half]), listed([radius, radius, half]));
        self.line(3, &format!("float3[] extent = [{low}, {high}]"));
        if length > 0.0 {
            self.line(3, "uniform token axis = \"Z\"");
            self.line(3, &format!("double height = {}", number(length)));
        }
        self.line(3, "uniform token purpose = \"guide\"");
        self.line(3, &format!("double radius = {}", number(radius)));
        let middle = capsule.from.midpoint(capsule.to) - origin;
        let way = turned(capsule.to - capsule.from).try_normalize().unwrap_or(DVec3::Z);
        self.line(3, &format!("quatf xformOp:orient = {}", turn(base::turn::between(DVec3::Z, way))));
        self.line(3, &format!("double3 xformOp:translate = {}", point(middle)));
        self.line(3, "uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:orient\"]");
        self.line(2, "}");
    }

    fn mesh(&mut self, name: &str, seen: &Seen<'_>) {
        let mesh = &seen.mesh.mesh;
        let place = |p: &[f32; 3]| turned(DVec3::from_array(p.map(f64::from)) - seen.origin);
        let points: Vec<DVec3> = mesh.positions.iter().map(place).collect();
        let low = points.iter().fold(DVec3::INFINITY, |m, p| m.min(*p));
        let high = points.iter().fold(DVec3::NEG_INFINITY, |m, p| m.max(*p));
        self.open(2, &format!("def Mesh \"{name}\""), &[]);
        self.line(3, "uniform bool doubleSided = 1");
        self.line(3, &format!("float3[] extent = [{}, {}]", fine(low), fine(high)));
        let counts = vec!["3"; mesh.triangles.len()].join(",");
        self.line(3, &format!("int[] faceVertexCounts = [{counts}]"));
        let corners: Vec<String> = mesh.triangles.iter().flatten().map(u32::to_string).collect();
        self.line(3, &format!("int[] faceVertexIndices = [{}]", corners.join(",")));
        let places: Vec<String> = points.iter().map(|p| fine(*p)).collect();
        self.line(3, &format!("point3f[] points = [{}]", places.join(",")));
        let colour = seen.mesh.color.map(|c| f64::from(c).clamp(0.0, 1.0));
        self.line(3, &format!("color3f[] primvars:displayColor = [{}] (", listed(colour)));
        self.line(4, "interpolation = \"constant\"");
        self.line(3, ")");
        self.line(3, "uniform token subdivisionScheme = \"none\"");
        self.line(2, "}");
    }

    fn joint(&mut self, row: usize, body: &Body) {
        let name = self.paths[row].rsplit('/').next().unwrap_or_default();
        let name = self.taken.fresh(&format!("{name}_joint"), "joint");
        match (&body.joint, body.stalk) {
            (Some(joint), _) => {
                let names = ["transX", "transY", "transZ", "rotX", "rotY", "rotZ"];
                let limits = names.map(|n| format!("PhysicsLimitAPI:{n}"));
                let drives = ["rotY", "rotZ"].map(|n| format!("PhysicsDriveAPI:{n}"));
                let schemas: Vec<&str> = limits.iter().chain(&drives).map(String::as_str).collect();
                self.open(1, &format!("def PhysicsJoint \"{name}\""), &schemas);
                self.frames(row, body, axes_of(joint));
                self.spring(joint);
            }
            (None, stalk) => {
                self.open(1, &format!("def PhysicsFixedJoint \"{name}\""), &[]);
                self.frames(row, body, DQuat::IDENTITY);
                if let Some(stalk) = stalk {
                    self.line(2, &format!("float physics:breakForce = {}", number(stalk.break_force_n)));
                    // Solvers of articulations know no joint that breaks.
                    self.line(2, "uniform bool physics:excludeFromArticulation = 1");
                }
            }
        }
        self.line(1, "}\n");
    }

    /// Writes the bodies of a joint and its frame in each.
    fn frames(&mut self, row: usize, body: &Body, axes: DQuat) {
        let parent = body.parent.map(|p| (self.paths[p].clone(), self.mechanism.bodies[p].origin));
        let path = self.paths[row].clone();
        if let Some((parent, _)) = &parent {
            self.line(2, &format!("rel physics:body0 = <{parent}>"));
        }
        self.line(2, &format!("rel physics:body1 = <{path}>"));
        let origin = parent.map_or(DVec3::ZERO, |(_, origin)| origin);
        self.line(2, &format!("point3f physics:localPos0 = {}", point(body.origin - origin)));
        self.line(2, "point3f physics:localPos1 = (0, 0, 0)");
        self.line(2, &format!("quatf physics:localRot0 = {}", turn(axes)));
        self.line(2, &format!("quatf physics:localRot1 = {}", turn(axes)));
    }

    fn spring(&mut self, joint: &SpringJoint) {
        // A low limit above the high one locks a direction.
        for name in ["transX", "transY", "transZ", "rotX"] {
            self.line(2, &format!("float limit:{name}:physics:high = -1"));
            self.line(2, &format!("float limit:{name}:physics:low = 1"));
        }
        let (most, degree) = (number(MOST_TURN_RAD / DEGREE), DEGREE);
        for (name, rest) in ["rotY", "rotZ"].into_iter().zip(joint.rest_rad) {
            self.line(2, &format!("float limit:{name}:physics:high = {most}"));
            self.line(2, &format!("float limit:{name}:physics:low = -{most}"));
            self.line(2, &format!("float drive:{name}:physics:damping = {}", number(joint.damping * degree)));
            self.line(
                2,
                &format!("float drive:{name}:physics:stiffness = {}", number(joint.stiffness * degree)),
            );
            self.line(2, &format!("float drive:{name}:physics:targetPosition = {}", number(rest / degree)));
            self.line(2, &format!("uniform token drive:{name}:physics:type = \"force\""));
        }
    }
}

/// A degree in radians: angles of joints and springs of `UsdPhysics` are in degrees.
const DEGREE: f64 = ops::PI / 180.0;

/// Returns the frame of a joint: x along the limb, y and z its hinges.
fn axes_of(joint: &SpringJoint) -> DQuat {
    let [y, z] = joint.axes.map(|axis| turned(axis).normalize());
    DQuat::from_mat3(&DMat3::from_cols(y.cross(z), y, z)).normalize()
}

fn listed(values: [f64; 3]) -> String {
    format!("({})", values.map(number).join(", "))
}

/// Formats a place or direction of the plant in the axes of robots.
fn point(v: DVec3) -> String {
    listed(turned(v).to_array())
}

/// Formats a corner to a hundredth of a millimetre.
fn fine(v: DVec3) -> String {
    let short = |x: f64| {
        let text = format!("{x:.5}");
        let text = text.trim_end_matches('0').trim_end_matches('.');
        if text == "-0" { "0".to_owned() } else { text.to_owned() }
    };
    format!("({})", v.to_array().map(short).join(","))
}

/// Formats a rotation, real part first.
fn turn(q: DQuat) -> String {
    format!("({})", [q.w, q.x, q.y, q.z].map(number).join(", "))
}

/// Returns the moments of inertia about the principal axes and the rotation to these, in the axes of robots (Jacobi).
fn principal(inertia: DMat3) -> ([f64; 3], DQuat) {
    let [xx, yy, zz, xy, xz, yz] = turned_inertia(inertia);
    let mut a = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    let mut v = DMat3::IDENTITY;
    for _ in 0..SWEEPS {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if a[p][q].abs() <= f64::MIN_POSITIVE {
                continue;
            }
            let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
            let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
            let c = 1.0 / (t * t + 1.0).sqrt();
            let s = t * c;
            let mut turn = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
            (turn[p][p], turn[q][q], turn[p][q], turn[q][p]) = (c, c, s, -s);
            // Columns of the matrix that rotates by this angle in the plane of p and q.
            let turn = DMat3::from_cols(
                DVec3::new(turn[0][0], turn[1][0], turn[2][0]),
                DVec3::new(turn[0][1], turn[1][1], turn[2][1]),
                DVec3::new(turn[0][2], turn[1][2], turn[2][2]),
            );
            let full = turn.transpose() * DMat3::from_cols(a[0].into(), a[1].into(), a[2].into()) * turn;
            a = [full.x_axis.to_array(), full.y_axis.to_array(), full.z_axis.to_array()];
            v *= turn;
        }
    }
    ([a[0][0], a[1][1], a[2][2]], DQuat::from_mat3(&v).normalize())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn principal_axes_give_the_inertia_back() {
        let plain = DMat3::from_diagonal(DVec3::new(1.0, 2.0, 4.0));
        let turns = [DQuat::IDENTITY, DQuat::from_xyzw(0.1, -0.5, 0.3, 0.8).normalize()];
        for q in turns {
            let m = DMat3::from_quat(q);
            let inertia = m * plain * m.transpose();
            let (moments, axes) = principal(inertia);
            let back = DMat3::from_quat(axes);
            let back = back * DMat3::from_diagonal(DVec3::from_array(moments)) * back.transpose();
            let wanted = turned_inertia(inertia);
            let got =
                [back.x_axis.x, back.y_axis.y, back.z_axis.z, back.y_axis.x, back.z_axis.x, back.z_axis.y];
            assert!(got.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-12), "{got:?} {wanted:?}");
        }
    }

    #[test]
    fn the_frame_of_a_joint_has_its_hinges_as_y_and_z() {
        let joint =
            SpringJoint { axes: [DVec3::X, DVec3::Z], stiffness: 1.0, damping: 0.1, rest_rad: [0.0, 0.0] };
        let frame = axes_of(&joint);
        assert!((frame * DVec3::Y - turned(DVec3::X)).length() < 1e-12);
        assert!((frame * DVec3::Z - turned(DVec3::Z)).length() < 1e-12);
    }
}
