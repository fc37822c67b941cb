//! Points -> models: an organ's motion at a day, a scan.

use core::ops::Range;

use glam::DVec3;
use mesh::{Material, MaterialId, MaterialKind, Model, Part, PointCloud, TriMesh};

/// Returns the model of the `points` of a day: one part for each organ, of the rows that `organs` gives.
///
/// With `faces`, a mesh of as many vertices keeps its triangles, texture coordinates and colours; without, parts are
/// clouds of points.
pub fn motion_model(
    name: &str,
    faces: Option<&TriMesh>,
    organs: &[(String, Range<usize>)],
    points: &[DVec3],
) -> Model {
    let mut model = Model { name: name.to_owned(), ..Model::default() };
    for (organ, rows) in organs {
        let mut mesh = TriMesh::default();
        for p in points.get(rows.clone()).unwrap_or_default() {
            mesh.push(*p);
        }
        let leafy = organ != "stem";
        if let Some(first) = faces.filter(|m| m.positions.len() == mesh.positions.len()) {
            mesh.triangles.clone_from(&first.triangles);
            mesh.uvs.clone_from(&first.uvs);
            mesh.colors.clone_from(&first.colors);
            mesh.compute_normals();
        }
        let material = model.materials.len();
        let kind = if leafy { MaterialKind::Leaf } else { MaterialKind::Stem };
        let color = if leafy { [0.13, 0.33, 0.06] } else { [0.25, 0.38, 0.12] };
        let mut look = Material::plain(format!("{}-{}", kind.word(), material + 1), kind, color);
        look.double_sided = true;
        model.materials.push(look);
        model.parts.push(Part { name: organ.clone(), material: MaterialId::new(material), mesh });
    }
    model
}

/// Gives the parts of [`motion_model`] the colours of their points, sRGB bytes, one list for each part; a part whose
/// list has another length is unchanged.
pub fn colour_points(model: &mut Model, colors: &[Vec<[u8; 3]>]) {
    for (part, colors) in model.parts.iter_mut().zip(colors) {
        if colors.is_empty() || colors.len() != part.mesh.positions.len() {
            continue;
        }
        part.mesh.colors = colors.iter().map(|c| base::linear_color(*c)).collect();
        if let Some(look) = model.materials.get_mut(part.material.index()) {
            look.base_color = [1.0; 3];
        }
    }
}

/// Returns a scan as a model of points without triangles, with their colours.
pub fn cloud_model(name: &str, cloud: &PointCloud) -> Model {
    let mut mesh = TriMesh::default();
    for p in &cloud.points {
        mesh.push(*p);
    }
    mesh.colors = cloud.colors.iter().map(|c| base::linear_color(*c)).collect();
    let look =
        Material::plain("points", MaterialKind::Other, [if cloud.colors.is_empty() { 0.5 } else { 1.0 }; 3]);
    Model {
        name: name.to_owned(),
        parts: vec![Part { name: "points".into(), material: MaterialId::new(0), mesh }],
        materials: vec![look],
        offset_m: cloud.offset_m,
    }
}
