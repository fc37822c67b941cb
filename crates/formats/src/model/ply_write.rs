//! Model -> binary PLY: one mesh with normals, texture coordinates and colours at its vertices.

use std::io::Write;

use mesh::{Material, Model};

use super::picture::{linear, srgb};
use super::{ExportSpec, check, unit};
use crate::error::WriteError;

/// Writes all parts of a model as one binary little-endian PLY.
///
/// Each vertex has a position, a normal, texture coordinates (`s`, `t`, t up) and an sRGB colour: base colour
/// times vertex colour times the texture there, so that the mesh looks right without its textures. Names and
/// materials are lost.
///
/// # Errors
/// [`WriteError`] for a model that is not sound, beyond four billion vertices, or of the sink.
///
/// ```
/// let mut ply = Vec::new();
/// formats::write_ply(&mesh::Model::default(), &formats::ExportSpec::default(), &mut ply)?;
/// assert!(ply.starts_with(b"ply\nformat binary_little_endian 1.0\n"));
/// # Ok::<(), formats::WriteError>(())
/// ```
pub fn write_ply(model: &Model, spec: &ExportSpec, mut out: impl Write) -> Result<(), WriteError> {
    check(model)?;
    let (vertices, triangles) = (model.vertex_count(), model.triangle_count());
    if u32::try_from(vertices).is_err() {
        return Err(WriteError::TooLarge { what: "the number of vertices", format: "PLY" });
    }
    write!(
        out,
        "ply\nformat binary_little_endian 1.0\ncomment Burgeon {}; {}, +{:?} up\n{}element vertex {vertices}\n",
        env!("CARGO_PKG_VERSION"),
        spec.unit.plural(),
        spec.up,
        spec.offset_line(model.offset_m, "comment")
    )?;
    for name in ["x", "y", "z", "nx", "ny", "nz", "s", "t"] {
        writeln!(out, "property float {name}")?;
    }
    write!(
        out,
        "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face {triangles}\n\
         property list uchar uint vertex_indices\nend_header\n"
    )?;
    let mut bytes = Vec::with_capacity(35 * vertices + 13 * triangles);
    for part in &model.parts {
        let (mesh, material) = (&part.mesh, model.material(part));
        for (i, &p) in mesh.positions.iter().enumerate() {
            let normal = spec.direction(mesh.normals.get(i).map_or([0.0, 1.0, 0.0], |&n| unit(n)));
            let uv = mesh.uvs.get(i).map_or([0.0; 2], |uv| uv.map(|x| if x.is_finite() { x } else { 0.0 }));
            let floats = spec.point(p).into_iter().chain(normal).chain([uv[0], 1.0 - uv[1]]);
            floats.for_each(|x| bytes.extend_from_slice(&x.to_le_bytes()));
            let tint = mesh.colors.get(i).copied().unwrap_or([1.0; 3]);
            bytes.extend_from_slice(&color(material, mesh.uvs.get(i).map(|_| uv), tint));
        }
    }
    let mut base = 0_u32;
    for mesh in model.parts.iter().map(|p| &p.mesh) {
        for t in &mesh.triangles {
            bytes.push(3);
            t.iter().for_each(|i| bytes.extend_from_slice(&(base + i).to_le_bytes()));
        }
        #[expect(clippy::cast_possible_truncation, reason = "the sum of all was checked above")]
        let n = mesh.positions.len() as u32;
        base += n;
    }
    out.write_all(&bytes)?;
    Ok(())
}

/// Returns the visible colour of a vertex, as sRGB bytes.
fn color(material: &Material, uv: Option<[f32; 2]>, tint: [f32; 3]) -> [u8; 3] {
    let mut rgb = [0, 1, 2].map(|k| material.base_color[k] * tint[k]);
    if let (Some(texture), Some(uv)) = (&material.texture, uv)
        && texture.width > 0
        && texture.height > 0
    {
        // Repeated beyond 0 to 1, as by glTF's default sampler.
        let at = |x: f32, size: u32| {
            let x = x - x.floor();
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                clippy::cast_precision_loss,
                reason = "x is between 0 and 1, and pictures are far smaller than 2^24"
            )]
            let i = (x * size as f32) as u32;
            i.min(size - 1) as usize
        };
        let pixel = at(uv[1], texture.height) * texture.width as usize + at(uv[0], texture.width);
        if let Some(texel) = texture.pixels.get(4 * pixel..4 * pixel + 3) {
            rgb.iter_mut().zip(texel).for_each(|(c, &t)| *c *= linear(f32::from(t) / 255.0));
        }
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "srgb is between 0 and 1")]
    let byte = |x: f32| (srgb(x) * 255.0).round() as u8;
    rgb.map(byte)
}
