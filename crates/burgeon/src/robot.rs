//! A plant as a robot: bodies, joints and their visible meshes.
//!
//! `Plant -> mechanics::Mechanism; Plant -> skin -> triangles of each body -> formats::robot_files`

use std::collections::BTreeMap;

use base::{Report, Run, Stopped};
use formats::{BodyMesh, ModelFiles, RobotFormat, WriteError, robot_files};
use glam::DVec3;
use mechanics::{MechanicsError, MechanicsSpec, Mechanism, WoodGroup, articulate};
use mesh::{Model, Part, TriMesh};
use plant::{AxisId, OrganId, Plant};
use skin::SkinSpec;

use crate::PRESETS;
use crate::report::RobotReport;
use skin::triangle_labels;

/// Reason why a plant cannot be written as a robot.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RobotError {
    /// It has no mechanism.
    #[error(transparent)]
    Mechanics(#[from] MechanicsError),
    /// Stopped, or too many triangles.
    #[error(transparent)]
    Stopped(#[from] Stopped),
    /// Its meshes cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// Fineness of the visible meshes, relative to that of models: simulators draw them but compute nothing with them.
const SEEN_DETAIL: f64 = 0.5;

/// Woody plants that are not hardwoods: their trunks are fibres in soft tissue, whose stiffness differs between
/// species.
const NO_HARDWOOD: [&str; 4] = ["Coconut palm", "Date palm", "Tree fern", "Saguaro"];

/// A plant as a robot.
#[derive(Clone, Debug, PartialEq)]
pub struct Robot {
    /// Its own file and its mesh files.
    pub files: ModelFiles,
    /// Its structure, and the assumed properties of its tissues.
    pub report: RobotReport,
}

/// Returns the report of a mechanism and of its wood.
fn reported(mechanism: &Mechanism, group: WoodGroup) -> RobotReport {
    let tissue = group.tissue();
    RobotReport {
        bodies: mechanism.bodies.len() as u64,
        hinges: mechanism.joints() as u64,
        breakable_fruits: mechanism.bodies.iter().filter(|body| body.stalk.is_some()).count() as u64,
        mass_kg: mechanism.mass(),
        lowest_hz: mechanism.frequencies().map_or(0.0, |f| f.lowest_hz),
        time_step_s: mechanism.time_step_s,
        wood: group.word().to_owned(),
        modulus_pa: tissue.modulus_pa,
        density_kg_m3: tissue.density_kg_m3,
        strength_pa: tissue.strength_pa,
    }
}

/// Writes a plant as a robot, with its meshes in separate files: see [`articulate`] and [`robot_files`]. `stem`: the
/// file's name without its ending.
///
/// Guaranteed: the same bits for any executor. `report` warns of wood whose kind is unknown, and of what [`articulate`]
/// warns of. Cost: that of [`skin::skin`] at half its fineness.
///
/// # Errors
/// [`RobotError`] of a plant without stems or thickness, or beyond the budget.
///
/// ```
/// use glam::DVec3;
/// use burgeon::formats::RobotFormat;
/// let mut p = burgeon::plant::Plant::default();
/// p.add_axis(burgeon::plant::AxisKind::Stem, None, 1, &[DVec3::ZERO, DVec3::Y], None);
/// p.nodes.radius_m = vec![0.01, 0.005];
/// let mut report = burgeon::Report::default();
/// let made = burgeon::write_robot(&p, RobotFormat::Mjcf, "stem", &burgeon::Run::plain(), &mut report)?;
/// assert!(made.files.beside.iter().any(|f| f.name == "stem-base_stems.stl"));
/// assert_eq!((made.report.wood.as_str(), report.warnings.len()), ("green", 0));
/// # Ok::<(), burgeon::RobotError>(())
/// ```
pub fn write_robot(
    plant: &Plant,
    format: RobotFormat,
    stem: &str,
    run: &Run<'_>,
    report: &mut Report,
) -> Result<Robot, RobotError> {
    let spec = MechanicsSpec { group: WoodGroup::seen_in(plant), ..MechanicsSpec::default() };
    let mechanism = articulate(plant, &spec, run, report)?;
    if is_wood_guessed(plant, spec.group) {
        let gigapascals = spec.group.tissue().modulus_pa / 1e9;
        base::warn!(
            report,
            "robot-wood-guessed",
            { group = spec.group.word(), gigapascals = gigapascals },
            "nothing in the plant says which wood it has: it is as stiff as any {group} ({gigapascals} GPa); if you know better, multiply stiffness and damping of its joints"
        );
    }
    let meshes = body_meshes(plant, &mechanism, run)?;
    let files = robot_files(&mechanism, &meshes, format, stem)?;
    Ok(Robot { files, report: reported(&mechanism, spec.group) })
}

/// Whether a plant is taken for a hardwood by default: it is not a species that comes with Burgeon, or has no true
/// wood.
fn is_wood_guessed(plant: &Plant, group: WoodGroup) -> bool {
    let name = plant.name.trim();
    let is = |other: &str| other.eq_ignore_ascii_case(name);
    let is_known = || PRESETS.iter().any(|preset| preset.title().is_some_and(is));
    group == WoodGroup::Hardwood && (!is_known() || NO_HARDWOOD.into_iter().any(is))
}

/// Returns the triangles of each body by kind of surface, in the order of the bodies.
fn body_meshes(plant: &Plant, mechanism: &Mechanism, run: &Run<'_>) -> Result<Vec<BodyMesh>, Stopped> {
    let spec = SkinSpec { textures: false, detail: SEEN_DETAIL, ..SkinSpec::default() };
    let (model, layout) = skin::skin_laid_out(plant, &spec, skin::SurfacePictures::default(), None, run)?;
    let labels = triangle_labels(plant, &model, &layout);
    let mut sorted: BTreeMap<(usize, usize), Vec<u32>> = BTreeMap::new();
    for ((row, part), labels) in model.parts.iter().enumerate().zip(&labels) {
        for ((triangle, corners), label) in (0_u32..).zip(&part.mesh.triangles).zip(labels) {
            let body = body_of((plant, mechanism), *label, || middle(&part.mesh, *corners));
            sorted.entry((body, row)).or_default().push(triangle);
        }
    }
    Ok(sorted.into_iter().map(|((body, row), triangles)| taken(&model, row, &triangles, body)).collect())
}

/// Returns the body of a triangle by its axis or organ; that on the ground for neither.
fn body_of(
    (plant, mechanism): (&Plant, &Mechanism),
    [_, axis, organ]: [i32; 3],
    place: impl Fn() -> DVec3,
) -> usize {
    if let Ok(organ) = usize::try_from(organ) {
        return mechanism.body_of_organ(OrganId::new(organ));
    }
    usize::try_from(axis).map_or(0, |axis| mechanism.body_on_axis(plant, AxisId::new(axis), place()))
}

fn middle(mesh: &TriMesh, corners: [u32; 3]) -> DVec3 {
    let corner = |i: u32| DVec3::from_array(mesh.positions[i as usize].map(f64::from));
    corners.into_iter().map(corner).sum::<DVec3>() / 3.0
}

/// Returns some triangles of a part as a mesh of their own, with their mean colour.
fn taken(model: &Model, row: usize, triangles: &[u32], body: usize) -> BodyMesh {
    let Part { name, material, mesh } = &model.parts[row];
    let mut rows: BTreeMap<u32, u32> = BTreeMap::new();
    let mut own = TriMesh::default();
    for &triangle in triangles {
        let corners = mesh.triangles[triangle as usize].map(|corner| {
            *rows.entry(corner).or_insert_with(|| {
                own.positions.push(mesh.positions[corner as usize]);
                // At most as many as the part has.
                u32::try_from(own.positions.len() - 1).unwrap_or(u32::MAX)
            })
        });
        own.triangles.push(corners);
    }
    let base = model.materials.get(material.index()).map_or([0.5; 3], |m| m.base_color);
    let tints = rows.keys().filter_map(|corner| mesh.colors.get(*corner as usize));
    let (mut sum, mut count) = ([0.0_f32; 3], 0.0_f32);
    for tint in tints {
        sum.iter_mut().zip(tint).for_each(|(s, t)| *s += t);
        count += 1.0;
    }
    let tint = if count > 0.0 { sum.map(|s| s / count) } else { [1.0; 3] };
    let color = [0, 1, 2].map(|k| base[k] * tint[k]);
    BodyMesh { body, part: name.clone(), color, mesh: own }
}
