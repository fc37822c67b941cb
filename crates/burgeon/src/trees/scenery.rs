//! Obstacles of a tree, for its picture.
//!
//! `Obstacles + Model -> Model with one more part`

use base::ops;
use glam::DVec3;
use growth::Obstacle;
use mesh::{Material, MaterialId, MaterialKind, Model, Part, TriMesh};

// Number of corners around balls and cylinders.
const AROUND: u32 = 32;

/// Adds the obstacles of a spec to a model that is to be drawn, as one plain grey part with flat faces.
///
/// Planes have no end and are left out; so are triangles of a mesh that refer to missing vertices.
///
/// ```
/// use burgeon::{growth::Obstacle, mesh::Model, show_obstacles};
/// let wall = Obstacle::Box { min: glam::DVec3::ZERO, max: glam::DVec3::new(4.0, 3.0, 0.2) };
/// let mut model = Model::default();
/// show_obstacles(&mut model, &[wall]);
/// assert_eq!((model.parts[0].mesh.triangles.len(), model.validate().count()), (12, 0));
/// ```
pub fn show_obstacles(model: &mut Model, obstacles: &[Obstacle]) {
    let mut mesh = TriMesh::default();
    for obstacle in obstacles {
        for corners in faces(obstacle) {
            let [a, b, c] = corners;
            let Some(normal) = (b - a).cross(c - a).try_normalize() else { continue };
            let face = corners.map(|p| mesh.push(p));
            mesh.triangles.push(face);
            #[expect(
                clippy::cast_possible_truncation,
                reason = "f64 in the model, f32 in the mesh, by design"
            )]
            let normal = [normal.x as f32, normal.y as f32, normal.z as f32];
            mesh.normals.extend([normal; 3]);
        }
    }
    if mesh.triangles.is_empty() {
        return;
    }
    let mut grey = Material::plain("obstacle", MaterialKind::Other, [0.42, 0.40, 0.37]);
    // Faces of a mesh may point inwards.
    grey.double_sided = true;
    model.materials.push(grey);
    let material = MaterialId::new(model.materials.len() - 1);
    model.parts.push(Part { name: "obstacles".into(), material, mesh });
}

/// Returns the triangles of an obstacle.
fn faces(obstacle: &Obstacle) -> Vec<[DVec3; 3]> {
    match obstacle {
        Obstacle::Box { min, max } => {
            let corner = |i: usize| {
                let side = |bit: usize, low: f64, high: f64| if i & bit == 0 { low } else { high };
                DVec3::new(side(1, min.x, max.x), side(2, min.y, max.y), side(4, min.z, max.z))
            };
            let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
            sides.iter().flat_map(|s| quad(s.map(corner))).collect()
        }
        Obstacle::Sphere { centre, radius_m } => {
            let rows = AROUND / 2;
            let rim = |k: u32| {
                let (sin, cos) = ops::sin_cos(ops::PI * f64::from(k) / f64::from(rows));
                (radius_m * sin, -radius_m * cos)
            };
            turned(*centre, &(0..=rows).map(rim).collect::<Vec<_>>())
        }
        Obstacle::Cylinder { base, radius_m, height_m } => {
            turned(*base, &[(0.0, 0.0), (*radius_m, 0.0), (*radius_m, *height_m), (0.0, *height_m)])
        }
        Obstacle::Mesh { vertices, triangles } => {
            let at = |i: u32| vertices.get(i as usize).copied().filter(|p| p.is_finite());
            triangles.iter().filter_map(|&[a, b, c]| Some([at(a)?, at(b)?, at(c)?])).collect()
        }
        _ => Vec::new(),
    }
}

/// Returns two triangles with the orientation of their corners.
fn quad([a, b, c, d]: [DVec3; 4]) -> [[DVec3; 3]; 2] {
    [[a, b, c], [a, c, d]]
}

/// Rotates a line of (radius, height) about the vertical.
fn turned(base: DVec3, line: &[(f64, f64)]) -> Vec<[DVec3; 3]> {
    let at = |(radius, height): (f64, f64), j: u32| {
        let (sin, cos) = ops::sin_cos(ops::TAU * f64::from(j) / f64::from(AROUND));
        base + DVec3::new(radius * cos, height, radius * sin)
    };
    let steps = line.windows(2).flat_map(|w| (0..AROUND).map(move |j| (w[0], w[1], j)));
    steps
        .flat_map(|(low, high, j)| quad([at(low, j), at(high, j), at(high, j + 1), at(low, j + 1)]))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_solid_shows_all_its_sides() {
        let volume = |obstacle: Obstacle| {
            let mut model = Model::default();
            show_obstacles(&mut model, &[obstacle]);
            assert_eq!(model.validate().next(), None);
            let mesh = &model.parts[0].mesh;
            let corners = |t: &[u32; 3]| t.map(|i| mesh.position(i));
            mesh.triangles.iter().map(corners).map(|[a, b, c]| a.dot(b.cross(c))).sum::<f64>() / 6.0
        };
        let near = |got: f64, want: f64| assert!((got / want - 1.0).abs() < 0.02, "{got} for {want}");
        let (a, b) = (DVec3::new(1.0, -2.0, 3.0), DVec3::new(2.0, 0.5, 7.0));
        near(volume(Obstacle::Box { min: a, max: b }), 10.0);
        near(volume(Obstacle::Sphere { centre: a, radius_m: 2.0 }), 4.0 / 3.0 * ops::PI * 8.0);
        near(volume(Obstacle::Cylinder { base: a, radius_m: 2.0, height_m: 3.0 }), 12.0 * ops::PI);
    }

    #[test]
    fn nothing_to_see_adds_nothing() {
        let mut model = Model::default();
        let bent = Obstacle::Mesh { vertices: vec![DVec3::ZERO; 3], triangles: vec![[0, 1, 2], [0, 1, 9]] };
        let wall = Obstacle::Plane { point: DVec3::ZERO, normal: DVec3::X };
        show_obstacles(&mut model, &[bent, wall]);
        assert!(model.parts.is_empty() && model.materials.is_empty());
    }
}
