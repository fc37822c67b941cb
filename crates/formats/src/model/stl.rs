//! Stereolithography: bare triangles. Binary is written; binary and text are read.

use std::collections::BTreeMap;
use std::io::Write;

use base::Report;
use glam::Vec3;
use mesh::{Material, MaterialId, MaterialKind, Model, Part, TriMesh};

use super::{ExportSpec, MAX_ROWS, check};
use crate::ModelFormat;
use crate::error::{FileFault, ModelError, Place, WriteError};

const HEADER: usize = 80;
const FACET: usize = 50;

/// Writes all triangles of a model as a binary STL; names, materials and normals of vertices are lost.
///
/// # Errors
/// [`WriteError`] for a model that is not sound, beyond four billion triangles, or of the sink.
///
/// ```
/// let mut stl = Vec::new();
/// formats::write_stl(&mesh::Model::default(), &formats::ExportSpec::default(), &mut stl)?;
/// assert_eq!(stl.len(), 84);
/// # Ok::<(), formats::WriteError>(())
/// ```
pub fn write_stl(model: &Model, spec: &ExportSpec, mut out: impl Write) -> Result<(), WriteError> {
    check(model)?;
    if model.triangle_count() == 0 && model.vertex_count() > 0 {
        return Err(WriteError::NoTriangles);
    }
    // The text must not begin with `solid`, which marks the text form.
    let text = format!("Burgeon {}; {}, +{:?} up", env!("CARGO_PKG_VERSION"), spec.unit.plural(), spec.up);
    let mut header = [b' '; HEADER];
    header.iter_mut().zip(text.bytes()).for_each(|(h, b)| *h = b);
    let count = u32::try_from(model.triangle_count())
        .ok()
        .ok_or(WriteError::TooLarge { what: "the number of triangles", format: "STL" })?;
    let mut bytes = Vec::with_capacity(HEADER + 4 + FACET * count as usize);
    bytes.extend_from_slice(&header);
    bytes.extend_from_slice(&count.to_le_bytes());
    for mesh in model.parts.iter().map(|p| &p.mesh) {
        for t in &mesh.triangles {
            let [a, b, c] = t.map(|i| Vec3::from(spec.point(mesh.positions[i as usize])));
            let normal = (b - a).cross(c - a).normalize_or_zero();
            for v in [normal, a, b, c] {
                v.to_array().iter().for_each(|x| bytes.extend_from_slice(&x.to_le_bytes()));
            }
            bytes.extend_from_slice(&[0, 0]);
        }
    }
    out.write_all(&bytes)?;
    Ok(())
}

pub(super) fn read(bytes: &[u8], name: &str, report: &mut Report) -> Result<Model, ModelError> {
    let word = bytes.get(HEADER..HEADER + 4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]));
    let whole = word.is_some_and(|n| bytes.len() as u64 == 84 + FACET as u64 * u64::from(n));
    // Some programs begin binary files with `solid`, too: the length decides.
    let text = !whole && bytes.trim_ascii_start().starts_with(b"solid");
    let corners = if text { read_text(bytes)? } else { read_binary(bytes, word, report)? };
    if corners.len() / 3 > MAX_ROWS {
        let advice = "split the model into several files";
        let fault = FileFault::TooMuch { what: "the number of triangles", limit: MAX_ROWS as u64, advice };
        return Err(ModelError::new(ModelFormat::Stl, Place::File, fault));
    }
    let mesh = weld(&corners);
    let material = Material::plain("default", MaterialKind::Other, [0.8; 3]);
    let part_name = if name.is_empty() { "part" } else { name };
    Ok(Model {
        name: name.to_owned(),
        parts: vec![Part { name: part_name.to_owned(), material: MaterialId::new(0), mesh }],
        materials: vec![material],
        offset_m: None,
    })
}

fn read_binary(bytes: &[u8], count: Option<u32>, report: &mut Report) -> Result<Vec<[f32; 3]>, ModelError> {
    let fail = |place, fault| ModelError::new(ModelFormat::Stl, place, fault);
    let Some(count) = count else {
        return Err(fail(Place::File, FileFault::Truncated { inside: "the header of 84 bytes".into() }));
    };
    let body = &bytes[HEADER + 4..];
    let there = body.len() / FACET;
    if there < count as usize {
        let inside = format!("triangle {there} of {count}");
        return Err(fail(Place::Byte(bytes.len() as u64), FileFault::Truncated { inside }));
    }
    if body.len() > FACET * count as usize {
        report.warn("stl-tail", "there are bytes after the last triangle; they were not looked at");
    }
    let mut corners = Vec::with_capacity(3 * count as usize);
    for (i, facet) in body.chunks_exact(FACET).take(count as usize).enumerate() {
        for v in facet[12..48].chunks_exact(12) {
            let x = |k: usize| f32::from_le_bytes([v[k], v[k + 1], v[k + 2], v[k + 3]]);
            let p = [x(0), x(4), x(8)];
            if !p.iter().all(|x| x.is_finite()) {
                let fault = FileFault::malformed("a coordinate is not finite", "export the model again");
                return Err(fail(Place::Item(format!("triangle {i}")), fault));
            }
            corners.push(p);
        }
    }
    Ok(corners)
}

fn read_text(bytes: &[u8]) -> Result<Vec<[f32; 3]>, ModelError> {
    let text = String::from_utf8_lossy(bytes);
    let mut corners = Vec::new();
    let mut finished = false;
    for (i, line) in text.lines().enumerate() {
        let line = line.trim();
        finished |= line.starts_with("endsolid");
        let Some(rest) = line.strip_prefix("vertex") else { continue };
        let mut p = [f32::NAN; 3];
        let mut words = rest.split_ascii_whitespace();
        p.iter_mut().for_each(|x| *x = words.next().and_then(|w| w.parse().ok()).unwrap_or(f32::NAN));
        if !p.iter().all(|x| x.is_finite()) {
            let fault =
                FileFault::malformed("a vertex is not three finite numbers", "export the model again");
            return Err(ModelError::new(ModelFormat::Stl, Place::line(i + 1), fault));
        }
        corners.push(p);
    }
    if !finished || corners.len() % 3 != 0 {
        let fault = FileFault::Truncated { inside: format!("triangle {}", corners.len() / 3) };
        return Err(ModelError::new(ModelFormat::Stl, Place::File, fault));
    }
    Ok(corners)
}

/// Merges all corners at exactly the same place into one vertex, in the order of their first use.
fn weld(corners: &[[f32; 3]]) -> TriMesh {
    let mut mesh = TriMesh::default();
    let mut known: BTreeMap<[u32; 3], u32> = BTreeMap::new();
    let mut index = |p: [f32; 3]| {
        // -0 and 0 are the same place.
        let key = p.map(|x| (x + 0.0).to_bits());
        *known.entry(key).or_insert_with(|| {
            mesh.positions.push(p);
            #[expect(clippy::cast_possible_truncation, reason = "MAX_ROWS is far below u32")]
            let row = (mesh.positions.len() - 1) as u32;
            row
        })
    };
    let triangles = corners.chunks_exact(3).map(|t| [index(t[0]), index(t[1]), index(t[2])]).collect();
    mesh.triangles = triangles;
    mesh
}
