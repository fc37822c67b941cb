//! Wavefront OBJ with its material file -> Model.

use base::LiteMap;
use std::sync::Arc;

use base::Report;
use mesh::{AlphaMode, Material, MaterialId, MaterialKind, Model, Part, Texture, TriMesh};

use super::named::{Files, NAMED};
use super::picture::linear;
use super::{MAX_ROWS, Names, Resolver, SideFile, kind_of, read_picture, unit};
use crate::ModelFormat;
use crate::error::{FileFault, ModelError, Place};

/// Position, texture coordinate and normal of a corner; `u32::MAX` for none.
type Corner = [u32; 3];
const NONE: u32 = u32::MAX;

#[derive(Default)]
struct Reader {
    positions: Vec<[f32; 3]>,
    colors: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
    normals: Vec<[f32; 3]>,
    materials: Vec<Material>,
    by_name: LiteMap<String, MaterialId>,
    groups: LiteMap<(String, MaterialId), usize>,
    faces: Vec<(String, MaterialId, Vec<[Corner; 3]>)>,
    object: Option<String>,
    group: Option<String>,
    material: Option<String>,
    current: Option<usize>,
    triangles: usize,
    lines: usize,
    title: Option<String>,
    /// The material files that were read, or that are missing.
    libraries: LiteMap<String, ()>,
    /// Textures by the material file that names them, and their name in it.
    textures: LiteMap<(String, String), Option<Arc<Texture>>>,
    /// Pixels of all textures, in bytes.
    pixels: usize,
}

fn fail(line: usize, what: impl Into<String>, advice: &'static str) -> ModelError {
    ModelError::new(ModelFormat::Obj, Place::line(line), FileFault::malformed(what, advice))
}

pub(super) fn read(
    bytes: &[u8],
    name: &str,
    resolve: Resolver<'_>,
    report: &mut Report,
) -> Result<Model, ModelError> {
    // Names may be in any encoding; everything that the reader needs is ASCII.
    let text = String::from_utf8_lossy(bytes);
    let mut reader = Reader::default();
    let mut files = Files::new(resolve);
    let mut joined = String::new();
    for (i, line) in text.lines().enumerate() {
        if let Some(start) = line.strip_suffix('\\') {
            joined.push_str(start);
            joined.push(' ');
            continue;
        }
        if joined.is_empty() {
            reader.line(line, i + 1, &mut files, report)?;
        } else {
            joined.push_str(line);
            let whole = core::mem::take(&mut joined);
            reader.line(&whole, i + 1, &mut files, report)?;
        }
    }
    if reader.lines > 0 {
        base::warn!(
            report,
            "obj-left-out",
            { count = reader.lines },
            "left out: {count} lines, points or curves"
        );
    }
    if reader.positions.is_empty() {
        return Err(fail(1, "it has no vertices", "is it really an OBJ file?"));
    }
    Ok(reader.model(name))
}

impl Reader {
    fn line(
        &mut self,
        line: &str,
        number: usize,
        files: &mut Files<'_>,
        report: &mut Report,
    ) -> Result<(), ModelError> {
        let (key, rest) = line.trim().split_once(char::is_whitespace).unwrap_or((line.trim(), ""));
        match key {
            "v" => {
                let v: [f32; 6] = floats(rest, 3, number)?;
                if !v.iter().all(|x| x.is_finite()) {
                    return Err(fail(number, "a coordinate is not finite", "export the model again"));
                }
                self.positions.push([v[0], v[1], v[2]]);
                if rest.split_ascii_whitespace().nth(5).is_some() {
                    // White for the earlier vertices, which had no colour.
                    self.colors.resize(self.positions.len() - 1, [1.0; 3]);
                    self.colors.push([v[3], v[4], v[5]].map(linear));
                }
            }
            "vt" => {
                let [u, v, _]: [f32; 3] = floats(rest, 1, number)?;
                self.uvs.push([u, 1.0 - v]);
            }
            "vn" => self.normals.push(unit(floats(rest, 3, number)?)),
            "f" => self.face(rest, number)?,
            "o" => {
                self.object = Some(rest.trim().to_owned());
                self.current = None;
            }
            "g" => {
                self.group = Some(rest.trim().to_owned());
                self.current = None;
            }
            "usemtl" => {
                self.material = Some(rest.trim().to_owned());
                self.current = None;
            }
            "mtllib" => {
                let fail = |fault| ModelError::new(ModelFormat::Obj, Place::line(number), fault);
                self.library(rest.trim(), files, report).map_err(fail)?;
            }
            "#" if self.title.is_none() => {
                self.title = rest.trim().strip_prefix("model ").map(|t| t.trim().to_owned());
            }
            "l" | "p" | "curv" | "curv2" | "surf" => self.lines += 1,
            _ => {}
        }
        Ok(())
    }

    fn face(&mut self, rest: &str, number: usize) -> Result<(), ModelError> {
        let mut corners: Vec<Corner> = Vec::with_capacity(4);
        for word in rest.split_ascii_whitespace() {
            let mut parts = word.split('/');
            let mut corner = [NONE; 3];
            let lengths = [self.positions.len(), self.uvs.len(), self.normals.len()];
            for (slot, (length, what)) in
                corner.iter_mut().zip(lengths.into_iter().zip(["vertex", "vt", "vn"]))
            {
                let Some(text) = parts.next().filter(|t| !t.is_empty()) else { continue };
                *slot = index(text, length).ok_or_else(|| {
                    let text = base::quoted(text);
                    fail(
                        number,
                        format!("there is no {what} {text:?} above this face"),
                        "export the model again",
                    )
                })?;
            }
            if corner[0] == NONE {
                return Err(fail(number, "a corner of a face has no vertex", "export the model again"));
            }
            corners.push(corner);
        }
        let Some((&first, others)) = corners.split_first().filter(|(_, o)| o.len() >= 2) else {
            return Err(fail(number, "a face has fewer than three corners", "export the model again"));
        };
        self.triangles += others.len() - 1;
        if self.triangles > MAX_ROWS {
            let advice = "split the model into several files";
            let fault =
                FileFault::TooMuch { what: "the number of triangles", limit: MAX_ROWS as u64, advice };
            return Err(ModelError::new(ModelFormat::Obj, Place::line(number), fault));
        }
        let row = match self.current {
            Some(row) => row,
            None => self.row(),
        };
        self.faces[row].2.extend(others.windows(2).map(|w| [first, w[0], w[1]]));
        Ok(())
    }

    /// Returns the part to which faces belong now.
    fn row(&mut self) -> usize {
        let wanted = self.material.clone().unwrap_or_default();
        let material = match self.by_name.get(&wanted) {
            Some(&id) => id,
            None => {
                let id = MaterialId::new(self.materials.len());
                let name = if wanted.is_empty() { "default" } else { wanted.as_str() };
                self.materials.push(Material::plain(name, kind_of(name), [0.8; 3]));
                self.by_name.insert(wanted, id);
                id
            }
        };
        let name = self.object.clone().or_else(|| self.group.clone()).unwrap_or_default();
        let faces = &mut self.faces;
        let row = *self.groups.entry((name.clone(), material)).or_insert_with(|| {
            faces.push((name, material, Vec::new()));
            faces.len() - 1
        });
        self.current = Some(row);
        row
    }

    /// Reads a material file, the first time that it is named.
    fn library(&mut self, name: &str, files: &mut Files<'_>, report: &mut Report) -> Result<(), FileFault> {
        if self.libraries.insert(name.to_owned(), ()).is_some() {
            return Ok(());
        }
        let Some(bytes) = files.get(SideFile { name, by: None })? else {
            base::warn!(
                report,
                "obj-material-file",
                { file = name },
                "the material file {file:?} was not found: materials are plain"
            );
            return Ok(());
        };
        let text = String::from_utf8_lossy(&bytes);
        let mut material: Option<Material> = None;
        for line in text.lines() {
            let (key, rest) = line.trim().split_once(char::is_whitespace).unwrap_or((line.trim(), ""));
            let rest = rest.trim();
            if key == "newmtl" {
                self.add(material.take());
                material = Some(Material::plain(rest, MaterialKind::Other, [0.8; 3]));
                continue;
            }
            let Some(m) = &mut material else { continue };
            let number = |default: f32| rest.parse::<f32>().ok().filter(|x| x.is_finite()).unwrap_or(default);
            match key {
                "Kd" => {
                    if let Ok(rgb) = floats::<3>(rest, 3, 0) {
                        m.base_color = rgb.map(|x| x.clamp(0.0, 1.0));
                    }
                }
                "Pr" => m.roughness = number(m.roughness).clamp(0.0, 1.0),
                "#" => own_words(rest, m),
                "map_Kd" => {
                    let file =
                        if rest.starts_with('-') { rest.rsplit(' ').next().unwrap_or(rest) } else { rest };
                    m.texture = self.texture(file, name, files)?;
                    if m.texture.is_none() {
                        base::warn!(
                            report,
                            "texture-missing",
                            { name = file },
                            "the texture {name:?} could not be read and was left out"
                        );
                    }
                }
                "map_d" => m.alpha = AlphaMode::Mask,
                _ => {}
            }
        }
        self.add(material);
        Ok(())
    }

    /// Returns the texture that a material file names; none if it cannot be read.
    fn texture(
        &mut self,
        name: &str,
        library: &str,
        files: &mut Files<'_>,
    ) -> Result<Option<Arc<Texture>>, FileFault> {
        let key = (library.to_owned(), name.to_owned());
        if let Some(known) = self.textures.get(&key) {
            return Ok(known.clone());
        }
        let mut bytes = files.get(SideFile { name, by: Some(library) })?;
        // Some programs write the path relative to the model.
        if bytes.is_none() && library.contains(['/', '\\']) {
            bytes = files.get(SideFile { name, by: None })?;
        }
        let bytes = bytes.filter(|_| self.pixels < NAMED.pixels);
        let picture = bytes.and_then(|b| read_picture(&b)).map(Arc::new);
        self.pixels = self.pixels.saturating_add(picture.as_ref().map_or(0, |p| p.pixels.len()));
        self.textures.insert(key, picture.clone());
        Ok(picture)
    }

    fn add(&mut self, material: Option<Material>) {
        let Some(mut m) = material else { return };
        if m.kind == MaterialKind::Other {
            m.kind = kind_of(&m.name);
        }
        let id = MaterialId::new(self.materials.len());
        self.by_name.entry(m.name.clone()).or_insert_with(|| {
            self.materials.push(m);
            id
        });
    }

    fn model(self, name: &str) -> Model {
        let mut names = Names::default();
        let title = self.title.clone().filter(|t| !t.is_empty()).unwrap_or_else(|| name.to_owned());
        let mut model = Model { name: title, ..Model::default() };
        for (wanted, material, faces) in &self.faces {
            let part = Part {
                name: names.fresh(wanted, if name.is_empty() { "part" } else { name }),
                material: *material,
                mesh: self.mesh(faces),
            };
            model.parts.push(part);
        }
        model.materials = self.materials;
        if model.parts.is_empty() {
            // Vertices without faces: a point cloud.
            if model.materials.is_empty() {
                model.materials.push(Material::plain("default", MaterialKind::Other, [0.8; 3]));
            }
            let mesh = TriMesh { positions: self.positions, ..TriMesh::default() };
            model.parts.push(Part { name: names.fresh(name, "points"), material: MaterialId::new(0), mesh });
        }
        model
    }

    /// Returns the mesh of distinct corners in the order of their numbers, which is the order of our own files.
    fn mesh(&self, faces: &[[Corner; 3]]) -> TriMesh {
        let mut corners: Vec<Corner> = faces.iter().flatten().copied().collect();
        base::sort_by_key(&mut corners, |&corner| corner);
        corners.dedup();
        let mut mesh = TriMesh {
            positions: corners.iter().map(|c| self.positions[c[0] as usize]).collect(),
            ..TriMesh::default()
        };
        if corners.iter().all(|c| c[1] != NONE) {
            mesh.uvs = corners.iter().map(|c| self.uvs[c[1] as usize]).collect();
        }
        if corners.iter().all(|c| c[2] != NONE) {
            mesh.normals = corners.iter().map(|c| self.normals[c[2] as usize]).collect();
        }
        let color = |c: &Corner| self.colors.get(c[0] as usize).copied();
        if corners.iter().any(|c| color(c).is_some_and(|c| c != [1.0; 3])) {
            mesh.colors = corners.iter().map(|c| color(c).unwrap_or([1.0; 3])).collect();
        }
        #[expect(clippy::cast_possible_truncation, reason = "MAX_ROWS is far below u32")]
        let place = |c: &Corner| corners.binary_search(c).unwrap_or_default() as u32;
        mesh.triangles = faces.iter().map(|f| [place(&f[0]), place(&f[1]), place(&f[2])]).collect();
        mesh
    }
}

/// Reads `# burgeon kind=leaf translucency=0.25 double-sided`.
fn own_words(comment: &str, m: &mut Material) {
    let Some(words) = comment.strip_prefix("burgeon ") else { return };
    for word in words.split_ascii_whitespace() {
        match word.split_once('=') {
            Some(("kind", kind)) => m.kind = kind_of(kind),
            Some(("translucency", t)) => {
                m.translucency =
                    t.parse::<f32>().ok().filter(|t| t.is_finite()).unwrap_or(0.0).clamp(0.0, 1.0);
            }
            None if word == "double-sided" => m.double_sided = true,
            _ => {}
        }
    }
}

/// Converts a 1-based index, or a negative one that counts from the end, to a row.
fn index(text: &str, length: usize) -> Option<u32> {
    let n: i64 = text.parse().ok()?;
    let row = if n < 0 { i64::try_from(length).ok()?.checked_add(n)? } else { n.checked_sub(1)? };
    let row = usize::try_from(row).ok().filter(|&r| r < length)?;
    u32::try_from(row).ok()
}

/// Parses up to `N` numbers, of which the first `least` must be there; the rest are zero.
fn floats<const N: usize>(text: &str, least: usize, line: usize) -> Result<[f32; N], ModelError> {
    let mut out = [0.0; N];
    let mut words = text.split_ascii_whitespace();
    for (i, value) in out.iter_mut().enumerate() {
        match words.next().map(str::parse::<f32>) {
            Some(Ok(x)) => *value = x,
            None if i >= least => break,
            // A fourth number may be a weight, a colour or a comment.
            Some(Err(_)) if i >= least => break,
            _ => {
                let what = format!("{least} numbers were expected in {:?}", base::quoted(text));
                return Err(fail(line, what, "export the model again"));
            }
        }
    }
    Ok(out)
}
