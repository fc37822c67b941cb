//! glTF 2.0, binary or JSON -> Model, with node transforms applied.

use base::Report;
use glam::{DMat3, DMat4, DQuat, DVec3};
use mesh::{MaterialId, Model, Part, TriMesh};

use super::glb_write::INSTANCES;
use super::gltf::{FAN, Material, Node, POINTS, Primitive, Root, STRIP, TRIANGLES};
use super::gltf_bytes::{Bytes, MeshFault, broken, chunks, item, unsupported};
use super::gltf_look::{Pictures, WEBP};
use super::named::Files;
use super::{MAX_ROWS, Names, Resolver, unit};
use crate::ModelFormat;
use crate::error::{FileFault, ModelError, Place};

/// Most bytes of the JSON part.
const MAX_JSON: usize = 256 << 20;
/// Most objects and arrays in it: each costs far more memory than its two bytes.
const MAX_OBJECTS: usize = 2_000_000;
/// Deepest nesting of nodes.
const MAX_DEPTH: usize = 1_000;

/// Extensions that may be required and still leave the shape readable.
const HARMLESS: [&str; 8] = [
    INSTANCES,
    "EXT_meshopt_compression",
    WEBP,
    "KHR_mesh_quantization",
    "KHR_texture_transform",
    "KHR_lights_punctual",
    "KHR_materials_unlit",
    "KHR_materials_",
];

pub(super) fn read(
    bytes: &[u8],
    format: ModelFormat,
    name: &str,
    resolve: Resolver<'_>,
    report: &mut Report,
) -> Result<Model, ModelError> {
    let (json, bin) = chunks(bytes, format)?;
    let file = |fault| ModelError::new(format, Place::File, fault);
    let too_much = |what, limit: usize| {
        file(FileFault::TooMuch { what, limit: limit as u64, advice: "split the model into several files" })
    };
    if json.len() > MAX_JSON {
        return Err(too_much("the JSON part in bytes", MAX_JSON));
    }
    if json.iter().filter(|b| matches!(b, b'{' | b'[')).count() > MAX_OBJECTS {
        return Err(too_much("the number of objects", MAX_OBJECTS));
    }
    // The JSON is parsed as text, like all JSON here: a reader of bytes would add a second copy of the parsing code.
    let json = core::str::from_utf8(json)
        .map_err(|e| file(FileFault::malformed(format!("the JSON part: {e}"), "export the model again")))?;
    let root: Root = serde_json::from_str(json).map_err(|e| {
        let place = Place::Line { line: e.line() as u64, column: Some(e.column() as u64) };
        let fault = if e.is_eof() {
            FileFault::Truncated { inside: "the JSON part".into() }
        } else {
            FileFault::malformed(e.to_string(), "export the model again")
        };
        ModelError::new(format, place, fault)
    })?;
    let at = |(place, fault): MeshFault| ModelError::new(format, place, fault);
    let mut files = Files::new(resolve);
    let bytes = Bytes::load(&root, bin, &mut files).map_err(at)?;
    for extension in &root.extensions_required {
        if !HARMLESS.iter().any(|h| extension == h || (h.ends_with('_') && extension.starts_with(h))) {
            return Err(at(unsupported(Place::File, format!("the extension {extension}"))));
        }
    }
    let materials = Pictures::new(&root, &bytes, files).materials().map_err(at)?;
    let mut reader = Reader {
        root: &root,
        bytes,
        model: Model { name: name.to_owned(), ..Model::default() },
        names: Names::default(),
        rows: 0,
        report,
        default_material: None,
        skipped: 0,
    };
    for (material, lost) in materials {
        if lost {
            base::warn!(
                reader.report,
                "texture-missing",
                { name = material.name },
                "the texture of material `{name}` could not be read and was left out"
            );
        }
        reader.model.materials.push(material);
    }
    reader.scene().map_err(at)?;
    Ok(reader.model)
}

struct Reader<'a> {
    root: &'a Root,
    bytes: Bytes<'a>,
    model: Model,
    names: Names,
    rows: usize,
    report: &'a mut Report,
    default_material: Option<MaterialId>,
    skipped: usize,
}

/// Place of an instance, and the factor of its colour.
type Instance = (DMat4, [f32; 3]);

fn local_matrix(node: &Node) -> DMat4 {
    match node.matrix {
        Some(m) => DMat4::from_cols_array(&m),
        None => DMat4::from_scale_rotation_translation(
            node.scale.map_or(DVec3::ONE, DVec3::from),
            // A quaternion of length zero is no rotation.
            node.rotation
                .map(DQuat::from_array)
                .filter(|q| q.length_squared() > 0.0)
                .map_or(DQuat::IDENTITY, |q| if q.is_normalized() { q } else { q.normalize() }),
            node.translation.map_or(DVec3::ZERO, DVec3::from),
        ),
    }
}

impl Reader<'_> {
    fn scene(&mut self) -> Result<(), MeshFault> {
        let root = self.root;
        let scene = root.scenes.get(root.scene.unwrap_or(0) as usize);
        let mut has_parent = vec![false; root.nodes.len()];
        for &child in root.nodes.iter().flat_map(|n| &n.children) {
            if let Some(flag) = has_parent.get_mut(child as usize) {
                *flag = true;
            }
        }
        // A file without scenes is a library; all nodes without a parent are read.
        let tops: Vec<u32> = match scene {
            Some(scene) => scene.nodes.clone(),
            None => (0_u32..).zip(&has_parent).filter(|(_, h)| !**h).map(|(i, _)| i).collect(),
        };
        let title = match tops.as_slice() {
            [only] => {
                root.nodes.get(*only as usize).and_then(|n| n.name.clone().filter(|_| n.mesh.is_none()))
            }
            _ => None,
        };
        if let Some(name) = title.or_else(|| scene.and_then(|s| s.name.clone())) {
            self.model.name = name;
        }
        let mut visited = vec![false; root.nodes.len()];
        let mut stack: Vec<(u32, DMat4, usize)> =
            tops.iter().rev().map(|&n| (n, DMat4::IDENTITY, 0)).collect();
        while let Some((index, parent, depth)) = stack.pop() {
            let node = root
                .nodes
                .get(index as usize)
                .ok_or_else(|| broken(item("node", index), "it is not there"))?;
            if core::mem::replace(&mut visited[index as usize], true) {
                return Err(broken(item("node", index), "it stands in the scene twice or inside itself"));
            }
            if depth > MAX_DEPTH {
                return Err(broken(item("node", index), "it is nested too deeply"));
            }
            let world = parent * local_matrix(node);
            if let Some(mesh) = node.mesh {
                let places = self.places(node, index)?;
                self.mesh(mesh, node.name.as_deref(), world, places.as_deref())?;
            }
            stack.extend(node.children.iter().rev().map(|&c| (c, world, depth + 1)));
        }
        if self.skipped > 0 {
            base::warn!(
                self.report,
                "gltf-left-out",
                { count = self.skipped },
                "left out: {count} meshes made of lines"
            );
        }
        Ok(())
    }

    /// Returns the places and colours of the instances of a node's mesh (`EXT_mesh_gpu_instancing`); `None` if the
    /// node has none.
    fn places(&self, node: &Node, index: u32) -> Result<Option<Vec<Instance>>, MeshFault> {
        let Some(instances) = node.extensions.as_ref().and_then(|e| e.get(INSTANCES)) else {
            return Ok(None);
        };
        let place = || item("node", index);
        let accessor = |key: &str| -> Result<Option<u32>, MeshFault> {
            let Some(value) = instances.get("attributes").and_then(|a| a.get(key)) else { return Ok(None) };
            let row = value.as_u64().and_then(|v| u32::try_from(v).ok());
            row.map(Some).ok_or_else(|| broken(place(), format!("its {key} is no accessor")))
        };
        let (root, bytes) = (self.root, &self.bytes);
        let column = |key: &str| accessor(key)?.map(|a| bytes.floats::<3>(root, a)).transpose();
        let (at, scale, color) = (column("TRANSLATION")?, column("SCALE")?, column("_COLOR_0")?);
        let turn = accessor("ROTATION")?.map(|a| bytes.floats::<4>(root, a)).transpose()?;
        let counts = [at.as_ref().map(Vec::len), turn.as_ref().map(Vec::len), scale.as_ref().map(Vec::len)];
        let count = counts.into_iter().flatten().next().unwrap_or(0);
        let colored = color.as_ref().map(Vec::len);
        if counts.into_iter().flatten().chain(colored).any(|n| n != count) {
            return Err(broken(place(), "its instances have columns of different lengths"));
        }
        let wide = |v: [f32; 3]| DVec3::from(v.map(f64::from));
        let one = |k: usize| {
            let turn = turn.as_ref().map_or(DQuat::IDENTITY, |t| DQuat::from_array(t[k].map(f64::from)));
            // A quaternion of length zero is no rotation.
            let turn = if turn.length_squared() > 0.0 { turn.normalize() } else { DQuat::IDENTITY };
            let scale = scale.as_ref().map_or(DVec3::ONE, |s| wide(s[k]));
            let at = at.as_ref().map_or(DVec3::ZERO, |t| wide(t[k]));
            let color = color.as_ref().map_or([1.0; 3], |c| c[k]);
            (DMat4::from_scale_rotation_translation(scale, turn, at), color)
        };
        Ok(Some((0..count).map(one).collect()))
    }

    /// Returns the copies of a mesh in these places as one mesh.
    fn copied(&mut self, mesh: &TriMesh, places: &[Instance], place: &Place) -> Result<TriMesh, MeshFault> {
        let each = mesh.positions.len().saturating_add(mesh.triangles.len());
        self.rows = self.rows.saturating_add(each.saturating_mul(places.len()));
        if self.rows > MAX_ROWS {
            let what = "vertices and triangles of all instances";
            let advice = "split the model into several files";
            return Err((place.clone(), FileFault::TooMuch { what, limit: MAX_ROWS as u64, advice }));
        }
        let mut all = TriMesh::default();
        let colored = places.iter().any(|(_, c)| *c != [1.0; 3]);
        for (at, color) in places {
            let mut copy = mesh.clone();
            apply(&mut copy, *at);
            if colored {
                copy.colors.resize(copy.positions.len(), [1.0; 3]);
                copy.colors.iter_mut().for_each(|c| *c = [0, 1, 2].map(|k| c[k] * color[k]));
            }
            all.append(&copy);
        }
        Ok(all)
    }

    fn mesh(
        &mut self,
        index: u32,
        node: Option<&str>,
        world: DMat4,
        places: Option<&[Instance]>,
    ) -> Result<(), MeshFault> {
        let root = self.root;
        let mesh =
            root.meshes.get(index as usize).ok_or_else(|| broken(item("mesh", index), "it is not there"))?;
        for primitive in &mesh.primitives {
            let place = item("mesh", index);
            if primitive.extensions.as_ref().is_some_and(|e| e.get("KHR_draco_mesh_compression").is_some()) {
                return Err(unsupported(place, "compressed geometry (KHR_draco_mesh_compression)"));
            }
            let Some(mut columns) = self.primitive(primitive, &place)? else {
                self.skipped += 1;
                continue;
            };
            if let Some(m) = primitive.material.and_then(|m| root.materials.get(m as usize)) {
                place_texture(&mut columns, m);
            }
            if let Some(places) = places {
                columns = self.copied(&columns, places, &place)?;
            }
            apply(&mut columns, world);
            if columns.pivots.iter().flatten().any(|x| !x.is_finite()) {
                columns.pivots.clear();
            }
            if let Some(i) = columns.positions.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
                return Err(broken(place, format!("vertex {i} is not finite")));
            }
            if columns.normals.is_empty() {
                columns.compute_normals();
            }
            let material = match primitive.material {
                Some(m) if (m as usize) < root.materials.len() => MaterialId::new(m as usize),
                Some(m) => return Err(broken(place, format!("its material {m} is not there"))),
                None => self.default_material(),
            };
            let wanted = node.or(mesh.name.as_deref()).unwrap_or_default();
            let name = self.names.fresh(wanted, "part");
            self.model.parts.push(Part { name, material, mesh: columns });
        }
        Ok(())
    }

    fn default_material(&mut self) -> MaterialId {
        let materials = &mut self.model.materials;
        *self.default_material.get_or_insert_with(|| {
            materials.push(mesh::Material::plain("default", mesh::MaterialKind::Other, [1.0; 3]));
            MaterialId::new(materials.len() - 1)
        })
    }

    /// Returns the columns of a primitive; `None` for lines.
    fn primitive(&mut self, p: &Primitive, place: &Place) -> Result<Option<TriMesh>, MeshFault> {
        let mode = p.mode.unwrap_or(TRIANGLES);
        if !matches!(mode, POINTS | TRIANGLES | STRIP | FAN) {
            return Ok(None);
        }
        let (root, bytes) = (self.root, &self.bytes);
        let Some(position) = p.attributes.position else {
            return Err(broken(place.clone(), "it has no positions"));
        };
        let count = bytes.count(root, position)?;
        let corners = p.indices.map_or(Ok(count), |i| bytes.count(root, i))?;
        self.rows = self.rows.saturating_add(count).saturating_add(corners / 3);
        if self.rows > MAX_ROWS {
            let advice = "split the model into several files";
            let fault = FileFault::TooMuch {
                what: "vertices and triangles of all nodes",
                limit: MAX_ROWS as u64,
                advice,
            };
            return Err((place.clone(), fault));
        }
        let mut mesh = TriMesh { positions: bytes.floats(root, position)?, ..TriMesh::default() };
        if let Some(i) = p.attributes.normal {
            mesh.normals = bytes.floats::<3>(root, i)?.into_iter().map(unit).collect();
        }
        if let Some(i) = p.attributes.uv {
            mesh.uvs = bytes.floats(root, i)?;
        }
        if let Some(i) = p.attributes.color {
            mesh.colors = bytes.floats(root, i)?;
        }
        for (name, length) in
            [("NORMAL", mesh.normals.len()), ("TEXCOORD_0", mesh.uvs.len()), ("COLOR_0", mesh.colors.len())]
        {
            if length != 0 && length != count {
                return Err(broken(place.clone(), format!("{name} has {length} rows for {count} vertices")));
            }
        }
        self.wind(p, count, &mut mesh);
        let bytes = &self.bytes;
        let indices = match p.indices {
            Some(i) => bytes.indices(root, i)?,
            None => (0..u32::try_from(count).unwrap_or(u32::MAX)).collect(),
        };
        if let Some(bad) = indices.iter().find(|&&i| i as usize >= count) {
            return Err(broken(place.clone(), format!("index {bad} is beyond its {count} vertices")));
        }
        mesh.triangles = match mode {
            TRIANGLES => indices.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect(),
            STRIP => {
                let turned = |(i, t): (usize, &[u32])| {
                    if i % 2 == 0 { [t[0], t[1], t[2]] } else { [t[1], t[0], t[2]] }
                };
                indices.windows(3).enumerate().map(turned).collect()
            }
            FAN => indices.windows(2).skip(1).map(|w| [indices[0], w[0], w[1]]).collect(),
            _ => Vec::new(),
        };
        Ok(Some(mesh))
    }

    /// Reads how wind moves the mesh. Other programs may use these names for something else: columns of another form
    /// are left out.
    fn wind(&mut self, p: &Primitive, count: usize, mesh: &mut TriMesh) {
        let (root, bytes) = (self.root, &self.bytes);
        if let Some(i) = p.attributes.wind {
            let sound =
                |w: &Vec<[f32; 4]>| w.len() == count && w.iter().flatten().all(|x| (0.0..=1.0).contains(x));
            mesh.wind = bytes.floats(root, i).ok().filter(sound).unwrap_or_default();
        }
        if let Some(i) = p.attributes.pivot {
            let sound = |w: &Vec<[f32; 3]>| w.len() == count && w.iter().flatten().all(|x| x.is_finite());
            mesh.pivots = bytes.floats(root, i).ok().filter(sound).unwrap_or_default();
        }
        let lost = (p.attributes.wind.is_some() && mesh.wind.is_empty())
            || (p.attributes.pivot.is_some() && mesh.pivots.is_empty());
        if lost && count > 0 {
            let message = "attributes _WIND or _PIVOT are not as Burgeon writes them and were left out";
            self.report.warn("gltf-wind-left-out", message);
        }
    }
}

/// Moves texture coordinates by the transform of the material's colour texture (`KHR_texture_transform`, without its
/// rotation).
fn place_texture(mesh: &mut TriMesh, material: &Material) {
    let info = material.pbr_metallic_roughness.base_color_texture.as_ref();
    let Some(transform) =
        info.and_then(|i| i.extensions.as_ref()).and_then(|e| e.get("KHR_texture_transform"))
    else {
        return;
    };
    #[expect(clippy::cast_possible_truncation, reason = "texture coordinates are f32 by design")]
    let pair = |key: &str, default: f32| {
        let at = |k: usize| transform.get(key).and_then(|v| v.get(k)?.as_f64()).map_or(default, |x| x as f32);
        [at(0), at(1)]
    };
    let (offset, scale) = (pair("offset", 0.0), pair("scale", 1.0));
    mesh.uvs.iter_mut().for_each(|uv| *uv = [0, 1].map(|k| offset[k] + scale[k] * uv[k]));
}

/// Places a mesh in the world; a mirrored one is reversed so that its triangles face outside again.
fn apply(mesh: &mut TriMesh, world: DMat4) {
    if world == DMat4::IDENTITY {
        return;
    }
    let wide = |p: [f32; 3]| DVec3::from(p.map(f64::from));
    #[expect(clippy::cast_possible_truncation, reason = "meshes are f32 by design")]
    let narrow = |p: DVec3| p.to_array().map(|x| x as f32);
    let linear = DMat3::from_mat4(world);
    let determinant = linear.determinant();
    let points = mesh.positions.iter_mut().chain(&mut mesh.pivots);
    points.for_each(|p| *p = narrow(world.transform_point3(wide(*p))));
    if determinant != 0.0 {
        // Cofactors: the inverse transpose without its division, so that tiny scales stay exact.
        let (x, y, z) = (linear.x_axis, linear.y_axis, linear.z_axis);
        let cofactors = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y)) * determinant.signum();
        for n in &mut mesh.normals {
            *n = unit(narrow((cofactors * wide(*n)).normalize_or_zero()));
        }
    }
    if determinant < 0.0 {
        mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    }
}
