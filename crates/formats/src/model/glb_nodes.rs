//! Levels of one model and shapes for collisions as named nodes of one root -> binary glTF.

use std::io::Write;

use mesh::{Material, Model, TriMesh};

use super::PngCache;
use super::glb_write::{Level, Winds, Writer, check_levels, row};
use super::gltf::{Attributes, Mesh, Node, POINTS, Primitive};
use crate::error::WriteError;

/// Nodes of a file for a program that tells levels and shapes for collisions by their names.
#[derive(Clone, Debug, Default)]
pub struct NamedNodes<'a> {
    /// Name of the root.
    pub name: String,
    /// Levels, the finest first, each with the name of its node.
    pub levels: Vec<(String, &'a Model)>,
    /// Shapes for collisions, each with the name of its node; they have no material.
    pub shapes: Vec<(String, TriMesh)>,
    /// For each level and each of its parts, texture coordinates of set 1 for every vertex; empty for those of set 0.
    pub cells: Vec<Vec<Vec<[f32; 2]>>>,
}

/// Writes a GLB of named nodes: below the root one node for each level, whose mesh has a primitive for each part, and
/// one for each shape. Materials and textures that levels share are written once.
///
/// Wind columns of a mesh are texture coordinates, as importers drop the attributes `_WIND` and `_PIVOT`: set 2 has sway
/// and limb, set 3 flutter and phase, set 4 x and y of the pivot in metres and set 5 its z and 1. Set 1 has
/// [`NamedNodes::cells`], or is set 0 again, because glTF counts sets without gaps.
///
/// # Errors
/// As [`write_glb`](super::write_glb), for any of the models.
///
/// ```
/// let (nodes, mut glb) = (formats::NamedNodes { name: "oak".into(), ..Default::default() }, Vec::new());
/// formats::write_glb_nodes(&nodes, &mut formats::PngCache::new(), &mut glb)?;
/// assert_eq!(&glb[..4], b"glTF");
/// # Ok::<(), formats::WriteError>(())
/// ```
pub fn write_glb_nodes(
    nodes: &NamedNodes<'_>,
    cache: &mut PngCache,
    out: impl Write,
) -> Result<(), WriteError> {
    let levels: Vec<Level<'_>> = nodes.levels.iter().map(|(_, model)| Level::plain(model)).collect();
    check_levels(&levels)?;
    let room = levels.iter().map(|l| 96 * l.model.vertex_count() + 12 * l.model.triangle_count()).sum();
    let mut w = Writer::new(room);
    w.root(&nodes.name);
    let mut known: Vec<&Material> = Vec::new();
    for (level, (name, model)) in nodes.levels.iter().enumerate() {
        let cells = nodes.cells.get(level);
        let rows = model.materials.iter().map(|m| w.material(m, &mut known, cache));
        let rows: Vec<u32> = rows.collect::<Result<_, _>>()?;
        let mut primitives = Vec::with_capacity(model.parts.len());
        for (k, part) in model.parts.iter().enumerate().filter(|(_, p)| !p.mesh.positions.is_empty()) {
            let cells = cells.and_then(|parts| parts.get(k)).map_or(&[][..], Vec::as_slice);
            primitives.push(w.primitive(&part.mesh, cells, Some(rows[part.material.index()]))?);
        }
        w.named(name, primitives)?;
    }
    for (name, shape) in &nodes.shapes {
        let primitive = w.primitive(shape, &[], None)?;
        w.named(name, vec![primitive])?;
    }
    w.finish(out)
}

impl Writer {
    /// Returns the row of a material, which is written once.
    fn material<'a>(
        &mut self,
        material: &'a Material,
        known: &mut Vec<&'a Material>,
        cache: &mut PngCache,
    ) -> Result<u32, WriteError> {
        if let Some(at) = known.iter().position(|m| m.name == material.name && *m == material) {
            return row(at);
        }
        known.push(material);
        let alone = Model { materials: vec![material.clone()], ..Model::default() };
        self.materials(&alone, cache)
    }

    fn primitive(
        &mut self,
        mesh: &TriMesh,
        cells: &[[f32; 2]],
        material: Option<u32>,
    ) -> Result<Primitive, WriteError> {
        let mut attributes = self.attributes(mesh, Winds::None)?;
        if mesh.wind.len() == mesh.positions.len() && mesh.pivots.len() == mesh.positions.len() {
            self.wind_in_sets(mesh, cells, &mut attributes)?;
        }
        let is_cloud = mesh.triangles.is_empty();
        Ok(Primitive {
            targets: Vec::new(),
            attributes,
            indices: if is_cloud { None } else { Some(self.indices(mesh)?) },
            material,
            mode: is_cloud.then_some(POINTS),
            extensions: None,
        })
    }

    /// Adds the columns of the wind as texture coordinates.
    fn wind_in_sets(
        &mut self,
        mesh: &TriMesh,
        cells: &[[f32; 2]],
        attributes: &mut Attributes,
    ) -> Result<(), WriteError> {
        let first = match attributes.uv {
            Some(uv) => uv,
            None => self.column("VEC2", &vec![[0.0; 2]; mesh.positions.len()], false)?,
        };
        let second =
            if cells.len() == mesh.positions.len() { self.column("VEC2", cells, false)? } else { first };
        let finite = |x: f32| if x.is_finite() { x } else { 0.0 };
        let mut set = |pair: &dyn Fn(usize) -> [f32; 2]| {
            let rows: Vec<[f32; 2]> = (0..mesh.positions.len()).map(|k| pair(k).map(finite)).collect();
            self.column("VEC2", &rows, false)
        };
        (attributes.uv, attributes.uv1) = (Some(first), Some(second));
        attributes.uv2 = Some(set(&|k| [mesh.wind[k][0], mesh.wind[k][1]])?);
        attributes.uv3 = Some(set(&|k| [mesh.wind[k][2], mesh.wind[k][3]])?);
        attributes.uv4 = Some(set(&|k| [mesh.pivots[k][0], mesh.pivots[k][1]])?);
        attributes.uv5 = Some(set(&|k| [mesh.pivots[k][2], 1.0])?);
        Ok(())
    }

    /// Adds a node with a mesh below the root; nothing without primitives.
    fn named(&mut self, name: &str, primitives: Vec<Primitive>) -> Result<(), WriteError> {
        if primitives.is_empty() {
            return Ok(());
        }
        let mesh = row(self.root.meshes.len())?;
        self.root.meshes.push(Mesh { name: Some(name.to_owned()), primitives, weights: Vec::new() });
        let at = row(self.root.nodes.len())?;
        self.root.nodes.push(Node { name: Some(name.to_owned()), mesh: Some(mesh), ..Node::default() });
        self.root.nodes[0].children.push(at);
        Ok(())
    }
}
