//! [`mechanics::Mechanism`] -> bytes: plants as robots, for simulators. In metres, +Z up.

mod mjcf;
mod urdf;
mod usd;

use std::collections::BTreeSet;

use base::{Unit, UpAxis};
use glam::{DMat3, DVec3};
use mechanics::Mechanism;
use mesh::{Material, MaterialId, MaterialKind, Model, Part, TriMesh};

use crate::model::file_name;
use crate::{Beside, BesideFile, ExportSpec, ModelFiles, RobotFormat, WriteError, write_stl};

/// Visible mesh of a body: triangles of one kind of surface.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyMesh {
    /// Row of [`Mechanism::bodies`].
    pub body: usize,
    /// Kind of surface, such as `leaves`: together with the body's name it names the mesh.
    pub part: String,
    /// Its mean colour, linear RGB.
    pub color: [f32; 3],
    /// The triangles, in the plant's coordinates.
    pub mesh: TriMesh,
}

/// Limit of each hinge, radians: a right angle, beyond which every stem breaks.
const MOST_TURN_RAD: f64 = 1.57;

/// Writes a mechanism with its meshes as companion files, in binary STL, named `STEM-BODY_PART.stl`, with a number
/// from the second of the same name on; `stem` is the file's name without its extension.
///
/// Guaranteed: masses, stiffness and places to nine digits. Meshes with fewer than four corners are left out. MJCF
/// has springs that hold the pose, fruits on welds with the force at which they break, areas for the wind, and the
/// time step. URDF itself has no springs: ours are for Gazebo; its fruits do not come off. USD has its meshes in the
/// file itself, springs as drives of joints with two free angles, and fruits on joints that break. Cost: linear.
///
/// # Errors
/// [`WriteError`] for meshes that are not sound.
///
/// ```
/// use glam::DVec3;
/// let mut p = plant::Plant::default();
/// p.add_axis(plant::AxisKind::Branch, None, 1, &[DVec3::ZERO, DVec3::Y * 2.0], None);
/// p.nodes.radius_m = vec![0.02, 0.01];
/// let (run, mut report) = (base::Run::plain(), base::Report::default());
/// let made = mechanics::articulate(&p, &mechanics::MechanicsSpec::default(), &run, &mut report)?;
/// for format in formats::RobotFormat::ALL {
///     let files = formats::robot_files(&made, &[], format, "rod")?;
///     assert!(String::from_utf8(files.own)?.contains("branch_1_1"));
/// }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
pub fn robot_files(
    mechanism: &Mechanism,
    meshes: &[BodyMesh],
    format: RobotFormat,
    stem: &str,
) -> Result<ModelFiles, WriteError> {
    let stem = file_name(stem, "plant");
    let named = named_meshes(mechanism, meshes, &stem);
    let own = match format {
        RobotFormat::Mjcf => mjcf::text(mechanism, &named),
        RobotFormat::Urdf => urdf::text(mechanism, &named),
        RobotFormat::Usd => {
            // Its meshes are in the file itself.
            let own = usd::text(mechanism, &named);
            return Ok(ModelFiles { own: own.into_bytes(), beside: Vec::new() });
        }
    };
    let beside = named.into_iter().map(Seen::file).collect::<Result<_, _>>()?;
    Ok(ModelFiles { own: own.into_bytes(), beside })
}

/// Returns the meshes that can be written, each with a unique name: surfaces of one kind and several colours share a
/// part's name, and simulators refuse a mesh or a material that is named twice.
fn named_meshes<'a>(mechanism: &Mechanism, meshes: &'a [BodyMesh], stem: &str) -> Vec<Seen<'a>> {
    let mut taken = BTreeSet::new();
    let mut all = Vec::with_capacity(meshes.len());
    for mesh in meshes.iter().filter(|mesh| has_four_corners(&mesh.mesh)) {
        let Some(body) = mechanism.bodies.get(mesh.body) else { continue };
        let name = file_name(&format!("{}_{}", body.name, mesh.part), "mesh");
        // Some file systems treat names that differ only in case as the same.
        let mut names = (1_u32..).map(|k| if k == 1 { name.clone() } else { format!("{name}_{k}") });
        let Some(name) = names.find(|name| taken.insert(name.to_lowercase())) else { continue };
        all.push(Seen { mesh, origin: body.origin, file: format!("{stem}-{name}.stl"), name });
    }
    all
}

/// Returns whether a mesh has four corners at different places: `MuJoCo` refuses one with fewer, which is an
/// invisible sliver.
fn has_four_corners(mesh: &TriMesh) -> bool {
    let mut places: Vec<[u32; 3]> = Vec::new();
    for p in mesh.positions.iter().map(|p| p.map(f32::to_bits)) {
        if !places.contains(&p) {
            places.push(p);
        }
        if places.len() == 4 {
            return true;
        }
    }
    false
}

/// A mesh with its names.
struct Seen<'a> {
    mesh: &'a BodyMesh,
    origin: DVec3,
    /// `BODY_PART`, with a number from the second of the same name on.
    name: String,
    file: String,
}

impl Seen<'_> {
    /// Returns sRGB with an opacity of 1, each 0 to 1.
    fn rgba(&self) -> String {
        let [r, g, b] = self.mesh.color.map(|c| number(base::srgb_of_linear(f64::from(c).clamp(0.0, 1.0))));
        format!("{r} {g} {b} 1")
    }

    /// Returns a file of the triangles, with the body's origin as their origin.
    fn file(self) -> Result<BesideFile, WriteError> {
        let mut mesh = TriMesh {
            positions: self.mesh.mesh.positions.clone(),
            triangles: self.mesh.mesh.triangles.clone(),
            ..TriMesh::default()
        };
        for p in &mut mesh.positions {
            *p = (DVec3::from_array(p.map(f64::from)) - self.origin).as_vec3().to_array();
        }
        mesh.compute_normals();
        let part = Part { name: self.name, material: MaterialId::new(0), mesh };
        let material = Material::plain("seen", MaterialKind::Other, [0.5; 3]);
        let model = Model { parts: vec![part], materials: vec![material], ..Model::default() };
        let mut bytes = Vec::new();
        write_stl(&model, &ExportSpec { up: UpAxis::Z, unit: Unit::Metre }, &mut bytes)?;
        Ok(BesideFile { what: Beside::Meshes, name: self.file, bytes })
    }
}

/// Converts the plant's axes to those of robots: +Z up.
fn turned(v: DVec3) -> DVec3 {
    DVec3::new(v.x, -v.z, v.y)
}

/// Returns the inertia in the axes of robots: xx, yy, zz, xy, xz, yz.
fn turned_inertia(inertia: DMat3) -> [f64; 6] {
    let turn = DMat3::from_cols(turned(DVec3::X), turned(DVec3::Y), turned(DVec3::Z));
    let i = turn * inertia * turn.transpose();
    [i.x_axis.x, i.y_axis.y, i.z_axis.z, i.y_axis.x, i.z_axis.x, i.z_axis.y]
}

/// Formats a number with nine digits, as short as possible.
fn number(x: f64) -> String {
    let size = x.abs();
    if size == 0.0 {
        "0".to_owned()
    } else if (1e-3..1e6).contains(&size) {
        let text = format!("{x:.9}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        let text = format!("{x:.8e}");
        let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        let digits =
            if digits.contains('.') { digits.trim_end_matches('0').trim_end_matches('.') } else { digits };
        format!("{digits}e{exponent}")
    }
}

fn numbers(values: impl IntoIterator<Item = f64>) -> String {
    values.into_iter().map(number).collect::<Vec<_>>().join(" ")
}

/// Formats a place or direction of the plant in the axes of robots.
fn triple(v: DVec3) -> String {
    numbers(turned(v).to_array())
}

/// Escapes a name for an attribute.
fn attribute(name: &str) -> String {
    base::escaped_xml(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A body with three surfaces, two of which have one name and the third the same in capitals.
    #[test]
    fn meshes_of_one_name_get_numbers() {
        let mut plant = plant::Plant::default();
        plant.add_axis(plant::AxisKind::Branch, None, 1, &[DVec3::ZERO, DVec3::Y], None);
        plant.nodes.radius_m = vec![0.02, 0.01];
        let spec = mechanics::MechanicsSpec::default();
        let (run, mut report) = (base::Run::plain(), base::Report::default());
        let mechanism = mechanics::articulate(&plant, &spec, &run, &mut report).expect("a rod");
        let mesh = TriMesh {
            positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..TriMesh::default()
        };
        let meshes = ["petals", "petals", "Petals"].map(|part| BodyMesh {
            body: 0,
            part: part.into(),
            color: [0.5; 3],
            mesh: mesh.clone(),
        });
        let wanted = ["base_petals", "base_petals_2", "base_Petals_3"];
        for format in [RobotFormat::Mjcf, RobotFormat::Urdf] {
            let files = robot_files(&mechanism, &meshes, format, "rose").expect("files");
            let names: Vec<&str> = files.beside.iter().map(|f| f.name.as_str()).collect();
            assert_eq!(names, wanted.map(|name| format!("rose-{name}.stl")));
            let text = String::from_utf8(files.own).expect("text");
            for name in wanted {
                let named = match format {
                    RobotFormat::Mjcf => format!("<mesh name=\"{name}\""),
                    _ => format!("<material name=\"{name}\""),
                };
                assert_eq!(text.matches(&named).count(), 1, "{text}");
            }
        }
    }

    #[test]
    fn numbers_keep_nine_digits_and_no_more_than_it_takes() {
        let written = [0.0, 1.0, -0.5, 1.0 / 3.0, 1.5e-7, -2e9, 0.002].map(number);
        assert_eq!(written, ["0", "1", "-0.5", "0.333333333", "1.5e-7", "-2e9", "0.002"]);
    }

    #[test]
    fn inertia_turns_with_its_axes() {
        let inertia =
            DMat3::from_cols(DVec3::new(1.0, 0.1, 0.2), DVec3::new(0.1, 2.0, 0.3), DVec3::new(0.2, 0.3, 3.0));
        // The plant's y is z, and its z is -y.
        assert_eq!(turned_inertia(inertia), [1.0, 3.0, 2.0, -0.2, 0.1, -0.3]);
    }
}
