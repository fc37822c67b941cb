//! The model as one list of sound triangles.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use mesh::{AlphaMode, Bounds, MaterialKind, Model, TriMesh};

use crate::texture::Pyramid;

pub(crate) struct Vertex {
    pub(crate) at: DVec3,
    pub(crate) normal: DVec3,
    pub(crate) uv: DVec2,
    pub(crate) color: DVec3,
}

pub(crate) struct Surface {
    pub(crate) color: DVec3,
    pub(crate) roughness: f64,
    pub(crate) translucency: f64,
    /// Colour of transmitted light, relative to `color`.
    pub(crate) through: DVec3,
    pub(crate) texture: Option<Arc<Pyramid>>,
    /// Normals in tangent space, each component -1 to 1 stored as 0 to 1.
    pub(crate) normals: Option<Arc<Pyramid>>,
    /// Occlusion, and the factor on the roughness.
    pub(crate) orm: Option<Arc<Pyramid>>,
    /// Factor on the translucency, in alpha.
    pub(crate) thin: Option<Arc<Pyramid>>,
    pub(crate) mask: bool,
}

pub(crate) struct Triangle {
    pub(crate) corners: [u32; 3],
    pub(crate) surface: u32,
}

/// Share of a plant's height that may be in the ground and hidden by it: tips of leaves and roots that sink into the
/// ground, but no taproot. As on the Studio's stage.
const IN_THE_GROUND: f64 = 0.06;

pub(crate) struct Scene {
    pub(crate) vertices: Vec<Vertex>,
    pub(crate) triangles: Vec<Triangle>,
    pub(crate) surfaces: Vec<Surface>,
    pub(crate) bounds: Bounds,
    /// Height of the ground. It hides everything below it from viewers above.
    pub(crate) ground: f64,
    /// Part and row in it of each triangle, if requested.
    pub(crate) places: Option<Vec<[u32; 2]>>,
}

fn vec3(v: [f32; 3]) -> DVec3 {
    DVec3::new(f64::from(v[0]), f64::from(v[1]), f64::from(v[2]))
}

impl Scene {
    pub(crate) fn new(model: &Model) -> Self {
        Self::from_model(model, None)
    }

    /// Makes the scene with the part and the row of each triangle.
    pub(crate) fn placed(model: &Model) -> Self {
        Self::from_model(model, Some(Vec::with_capacity(model.triangle_count())))
    }

    fn from_model(model: &Model, places: Option<Vec<[u32; 2]>>) -> Self {
        let mut scene = Self {
            vertices: Vec::with_capacity(model.vertex_count()),
            triangles: Vec::with_capacity(model.triangle_count()),
            surfaces: surfaces(model),
            bounds: Bounds::EMPTY,
            ground: 0.0,
            places,
        };
        for (row, part) in (0_u32..).zip(&model.parts) {
            if part.material.index() < scene.surfaces.len() {
                scene.add(&part.mesh, part.material.raw(), row);
            }
        }
        if !scene.bounds.is_empty() {
            // Plants stand on y = 0 even if a leaf hangs a little lower; other models stand on their lowest point.
            let (low, height) = (scene.bounds.min.y, scene.bounds.size().y);
            scene.ground = if low.abs() <= IN_THE_GROUND * height { 0.0 } else { low };
        }
        scene
    }

    fn add(&mut self, mesh: &TriMesh, surface: u32, part: u32) {
        let Ok(first) = u32::try_from(self.vertices.len()) else { return };
        let count = mesh.positions.len();
        if u32::try_from(self.vertices.len() + count).is_err() {
            return;
        }
        let sound = |t: &[u32; 3]| {
            t.iter().all(|&i| mesh.positions.get(i as usize).is_some_and(|p| p.iter().all(|x| x.is_finite())))
        };
        let normals = normals(mesh, &sound);
        let uvs = mesh.uvs.len() == count;
        let colors = mesh.colors.len() == count;
        self.vertices.extend(mesh.positions.iter().zip(&normals).enumerate().map(|(i, (&p, &normal))| {
            let uv = if uvs { mesh.uvs[i] } else { [0.0; 2] };
            let color = if colors { vec3(mesh.colors[i]) } else { DVec3::ONE };
            Vertex {
                at: vec3(p),
                normal,
                uv: DVec2::new(f64::from(uv[0]), f64::from(uv[1])),
                color: if color.is_finite() {
                    color.clamp(DVec3::ZERO, DVec3::splat(4.0))
                } else {
                    DVec3::ONE
                },
            }
        }));
        for (row, t) in (0_u32..).zip(&mesh.triangles).filter(|(_, t)| sound(t)) {
            t.iter().for_each(|&i| self.bounds.include(vec3(mesh.positions[i as usize])));
            if let Some(places) = &mut self.places {
                places.push([part, row]);
            }
            self.triangles.push(Triangle { corners: t.map(|i| i + first), surface });
        }
    }

    pub(crate) fn corners(&self, t: &Triangle) -> [&Vertex; 3] {
        t.corners.map(|i| &self.vertices[i as usize])
    }

    /// Returns half the diagonal of the bounds.
    pub(crate) fn radius(&self) -> f64 {
        self.bounds.size().length() * 0.5
    }

    /// Returns the positions that are part of a triangle.
    pub(crate) fn points(&self) -> Vec<DVec3> {
        let mut used = vec![false; self.vertices.len()];
        self.triangles.iter().flat_map(|t| t.corners).for_each(|i| used[i as usize] = true);
        self.vertices.iter().zip(used).filter(|&(_, used)| used).map(|(v, _)| v.at).collect()
    }
}

// Returns the mesh's unit normals where they are sound, otherwise those of the surrounding triangles.
fn normals(mesh: &TriMesh, sound: &dyn Fn(&[u32; 3]) -> bool) -> Vec<DVec3> {
    let given = mesh.normals.len() == mesh.positions.len();
    let mut out: Vec<Option<DVec3>> = if given {
        mesh.normals
            .iter()
            .map(|&n| vec3(n))
            .map(|n| n.is_finite().then(|| n.try_normalize()).flatten())
            .collect()
    } else {
        vec![None; mesh.positions.len()]
    };
    if out.iter().any(Option::is_none) {
        let mut sums = vec![DVec3::ZERO; mesh.positions.len()];
        for t in mesh.triangles.iter().filter(|t| sound(t)) {
            let [a, b, c] = t.map(|i| vec3(mesh.positions[i as usize]));
            let n = (b - a).cross(c - a);
            t.iter().for_each(|&i| sums[i as usize] += n);
        }
        for (normal, sum) in out.iter_mut().zip(sums) {
            *normal = normal.or_else(|| sum.try_normalize());
        }
    }
    out.into_iter().map(|n| n.unwrap_or(DVec3::Y)).collect()
}

fn surfaces(model: &Model) -> Vec<Surface> {
    // Parts often share one texture: each is prepared once.
    let mut ready: Vec<(*const mesh::Texture, Option<Arc<Pyramid>>)> = Vec::new();
    let mut prepared = |texture: Option<&Arc<mesh::Texture>>, of: fn(&mesh::Texture) -> Option<Pyramid>| {
        let texture = texture?;
        let key = Arc::as_ptr(texture);
        if let Some((_, found)) = ready.iter().find(|(k, _)| *k == key) {
            return found.clone();
        }
        let pyramid = of(texture).map(Arc::new);
        ready.push((key, pyramid.clone()));
        pyramid
    };
    let unit = |x: f32, default: f64| if x.is_finite() { f64::from(x).clamp(0.0, 1.0) } else { default };
    model
        .materials
        .iter()
        .map(|m| {
            let texture = prepared(m.texture.as_ref(), Pyramid::new);
            Surface {
                color: DVec3::from_array(m.base_color.map(|c| unit(c, 0.5))),
                roughness: unit(m.roughness, 0.9).max(0.08),
                translucency: unit(m.translucency, 0.0),
                // Leaves transmit more yellow-green than they reflect.
                through: if m.kind == MaterialKind::Leaf {
                    DVec3::new(1.35, 1.25, 0.7)
                } else {
                    DVec3::splat(1.2)
                },
                normals: prepared(m.maps.normal.as_ref(), Pyramid::from_numbers),
                orm: prepared(m.maps.orm.as_ref(), Pyramid::from_numbers),
                thin: prepared(m.maps.through.as_ref(), Pyramid::from_numbers),
                mask: m.alpha == AlphaMode::Mask && texture.is_some(),
                texture,
            }
        })
        .collect()
}
