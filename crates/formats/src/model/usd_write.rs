//! Model -> USD as text, and its textures.

use std::collections::BTreeMap;
use std::fmt;
use std::io::Write as _;

use base::{Unit, UpAxis};
use mesh::{AlphaMode, Material, Model, Part, TriMesh};

use super::picture::linear;
use super::{ExportSpec, TextureFiles, check, file_name, share, unit};
use crate::error::WriteError;

/// The files that make up a USD model. The text names its textures: keep the names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UsdFiles {
    /// `STEM.usda`.
    pub usda: Vec<u8>,
    /// Name and bytes of each texture, `STEM-MATERIAL.png`.
    pub textures: Vec<(String, Vec<u8>)>,
}

/// Writes a model as a USD layer in text form (usda) and PNG files; `stem` is their common name without folder and
/// extension.
///
/// Guaranteed: `metersPerUnit`, `upAxis` and `defaultPrim` are always there; names are identifiers, each once among
/// its siblings; a part is one `Mesh` (`Points` without triangles) without subdivision, with normals, `primvars:st`,
/// `primvars:displayColor` and, where the model has them, `primvars:wind` and `primvars:pivot`; a material is one
/// `UsdPreviewSurface` with its normals, occlusion and roughness, cut out at one half where its texture has holes; the same model gives the same bytes.
/// Positions are written to a millionth of the largest, texture coordinates to five places, all else at vertices to four.
/// Not guaranteed: that vertex colours tint textures, for which `UsdPreviewSurface` has no node: they are in
/// `displayColor`, and colour materials without a texture. Kind and translucency are custom data of the material.
///
/// # Errors
/// [`WriteError`] for a model that is not sound.
///
/// ```
/// let files = formats::usd_files(&mesh::Model::default(), "oak", &formats::ExportSpec::default())?;
/// assert!(files.usda.starts_with(b"#usda 1.0"));
/// # Ok::<(), formats::WriteError>(())
/// ```
pub fn usd_files(model: &Model, stem: &str, spec: &ExportSpec) -> Result<UsdFiles, WriteError> {
    check(model)?;
    let stem = file_name(stem, "model");
    let root = identifier(&model.name, "model");
    let mut out = Vec::with_capacity(4096 + 160 * model.vertex_count() + 30 * model.triangle_count());
    let up = match spec.up {
        UpAxis::Y => "Y",
        UpAxis::Z => "Z",
    };
    let metres = match spec.unit {
        Unit::Metre => "1",
        Unit::Centimetre => "0.01",
        Unit::Millimetre => "0.001",
    };
    writeln!(out, "#usda 1.0\n(\n    defaultPrim = \"{root}\"")?;
    writeln!(out, "    doc = \"Burgeon {}\"", env!("CARGO_PKG_VERSION"))?;
    if let Some(offset) = model.offset_m {
        let [x, y, z] = spec.place(offset);
        writeln!(out, "    customLayerData = {{\n        double3 offset = ({x}, {y}, {z})\n    }}")?;
    }
    writeln!(out, "    metersPerUnit = {metres}\n    upAxis = \"{up}\"\n)\n")?;
    writeln!(out, "def Xform \"{root}\" (")?;
    writeln!(out, "    assetInfo = {{\n        string name = {}\n    }}", Quoted(&model.name))?;
    writeln!(out, "    kind = \"component\"\n)\n{{")?;
    let mut taken = Identifiers::default();
    let scope = taken.fresh("materials", "materials");
    let mut textures = TextureFiles::new(&stem);
    let mut among = Identifiers::default();
    let looks: Vec<Look> = (model.materials.iter().enumerate())
        .map(|(i, m)| {
            // A part's tint colours a bare material; one that has no colours shows the base colour.
            let users = || model.parts.iter().filter(|p| p.material.index() == i);
            let tinted = m.texture.is_none() && users().any(|p| !p.mesh.colors.is_empty());
            let file = m.texture.as_ref().map(|t| textures.name(t, &m.name)).transpose()?;
            let path = format!("/{root}/{scope}/{}", among.fresh(&m.name, "material"));
            let mut map = |of: &Option<std::sync::Arc<mesh::Texture>>, what: &str| {
                of.as_ref().map(|t| textures.name(t, &format!("{}-{what}", m.name))).transpose()
            };
            let (normal, orm) = (map(&m.maps.normal, "normal")?, map(&m.maps.orm, "orm")?);
            Ok(Look { path, file, normal, orm, tinted, shown: shown(m) })
        })
        .collect::<Result<_, WriteError>>()?;
    writeln!(out, "    def Scope \"{scope}\"\n    {{")?;
    for (m, look) in model.materials.iter().zip(&looks) {
        material(&mut out, m, look)?;
    }
    writeln!(out, "    }}")?;
    for part in model.parts.iter().filter(|p| !p.mesh.positions.is_empty()) {
        let name = taken.fresh(&part.name, "part");
        let look = &looks[part.material.index()];
        prim(&mut out, part, &name, look, model.material(part).double_sided, spec)?;
    }
    writeln!(out, "}}")?;
    Ok(UsdFiles { usda: out, textures: textures.into_files() })
}

/// How a material is written.
struct Look {
    path: String,
    /// Its texture's file.
    file: Option<String>,
    /// Those of its relief, and of occlusion and roughness.
    normal: Option<String>,
    orm: Option<String>,
    /// Vertex colours are its colour.
    tinted: bool,
    /// Linear colour that stands for it where materials are not shown.
    shown: [f32; 3],
}

fn material(out: &mut Vec<u8>, m: &Material, look: &Look) -> Result<(), WriteError> {
    let (path, name) = (&look.path, look.path.rsplit('/').next().unwrap_or_default());
    let [r, g, b] = m.base_color.map(share);
    let cut = m.alpha == AlphaMode::Mask && look.file.is_some();
    writeln!(out, "        def Material \"{name}\" (\n            customData = {{")?;
    writeln!(out, "                string kind = \"{}\"", m.kind.word())?;
    writeln!(out, "                float translucency = {}", share(m.translucency))?;
    writeln!(out, "            }}\n        )\n        {{")?;
    writeln!(out, "            token outputs:surface.connect = <{path}/surface.outputs:surface>\n")?;
    writeln!(out, "            def Shader \"surface\"\n            {{")?;
    writeln!(out, "                uniform token info:id = \"UsdPreviewSurface\"")?;
    match (&look.file, look.tinted) {
        (Some(_), _) => {
            writeln!(
                out,
                "                color3f inputs:diffuseColor.connect = <{path}/texture.outputs:rgb>"
            )?;
        }
        (None, true) => {
            writeln!(
                out,
                "                color3f inputs:diffuseColor.connect = <{path}/tint.outputs:result>"
            )?;
        }
        (None, false) => writeln!(out, "                color3f inputs:diffuseColor = ({r}, {g}, {b})")?,
    }
    writeln!(out, "                float inputs:metallic = 0")?;
    if cut {
        writeln!(out, "                float inputs:opacity.connect = <{path}/texture.outputs:a>")?;
        writeln!(out, "                float inputs:opacityThreshold = 0.5")?;
    }
    if look.normal.is_some() {
        writeln!(out, "                normal3f inputs:normal.connect = <{path}/normal.outputs:rgb>")?;
    }
    if look.orm.is_some() {
        writeln!(out, "                float inputs:occlusion.connect = <{path}/orm.outputs:r>")?;
        writeln!(out, "                float inputs:roughness.connect = <{path}/orm.outputs:g>")?;
    } else {
        writeln!(out, "                float inputs:roughness = {}", share(m.roughness))?;
    }
    writeln!(out, "                token outputs:surface\n            }}")?;
    if let Some(file) = &look.normal {
        let numbers = "                float4 inputs:bias = (-1, -1, -1, 0)\n                float4 inputs:scale = (2, 2, 2, 1)";
        picture(out, (path, "normal", file), (numbers, "raw"), &["float3 outputs:rgb"])?;
    }
    if let Some(file) = &look.orm {
        let numbers = format!("                float4 inputs:scale = (1, {}, 1, 1)", share(m.roughness));
        picture(out, (path, "orm", file), (&numbers, "raw"), &["float outputs:g", "float outputs:r"])?;
    }
    if let Some(file) = &look.file {
        let numbers = format!("                float4 inputs:scale = ({r}, {g}, {b}, 1)");
        let outputs = ["float outputs:a", "float3 outputs:rgb"];
        picture(
            out,
            (path, "texture", file),
            (&numbers, "sRGB"),
            if cut { &outputs } else { &outputs[1..] },
        )?;
    }
    if look.file.is_some() || look.normal.is_some() || look.orm.is_some() {
        writeln!(out)?;
        reader(out, "place", "float2", "st")?;
    } else if look.tinted {
        writeln!(out)?;
        reader(out, "tint", "float3", "displayColor")?;
    }
    Ok(writeln!(out, "        }}\n")?)
}

/// A node that reads a texture's file.
fn picture(
    out: &mut Vec<u8>,
    (path, name, file): (&str, &str, &str),
    (numbers, space): (&str, &str),
    outputs: &[&str],
) -> Result<(), WriteError> {
    writeln!(out, "\n            def Shader \"{name}\"\n            {{")?;
    writeln!(out, "                uniform token info:id = \"UsdUVTexture\"")?;
    writeln!(out, "                asset inputs:file = @./{file}@")?;
    writeln!(out, "{numbers}")?;
    writeln!(out, "                token inputs:sourceColorSpace = \"{space}\"")?;
    writeln!(out, "                float2 inputs:st.connect = <{path}/place.outputs:result>")?;
    writeln!(out, "                token inputs:wrapS = \"repeat\"")?;
    writeln!(out, "                token inputs:wrapT = \"repeat\"")?;
    for output in outputs {
        writeln!(out, "                {output}")?;
    }
    Ok(writeln!(out, "            }}")?)
}

/// A node that hands a column of the mesh on.
fn reader(out: &mut Vec<u8>, name: &str, kind: &str, column: &str) -> Result<(), WriteError> {
    writeln!(out, "            def Shader \"{name}\"\n            {{")?;
    writeln!(out, "                uniform token info:id = \"UsdPrimvarReader_{kind}\"")?;
    writeln!(out, "                string inputs:varname = \"{column}\"")?;
    Ok(writeln!(out, "                {kind} outputs:result\n            }}")?)
}

fn prim(
    out: &mut Vec<u8>,
    part: &Part,
    name: &str,
    look: &Look,
    double_sided: bool,
    spec: &ExportSpec,
) -> Result<(), WriteError> {
    let mesh = &part.mesh;
    let points: Vec<[f32; 3]> = mesh.positions.iter().map(|&p| spec.point(p)).collect();
    let cloud = mesh.triangles.is_empty();
    let kind = if cloud { "Points" } else { "Mesh" };
    writeln!(
        out,
        "\n    def {kind} \"{name}\" (\n        prepend apiSchemas = [\"MaterialBindingAPI\"]\n    )\n    {{"
    )?;
    if double_sided {
        writeln!(out, "        uniform bool doubleSided = 1")?;
    }
    let (low, high) = points.iter().fold(([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]), |(low, high), p| {
        ([0, 1, 2].map(|k| low[k].min(p[k])), [0, 1, 2].map(|k| high[k].max(p[k])))
    });
    // A point has a width: a three-hundredth of the whole shows without hiding its neighbours.
    let width = if cloud { (0..3).map(|k| high[k] - low[k]).fold(0.0, f32::max) / 300.0 } else { 0.0 };
    write!(out, "        float3[] extent = [")?;
    row(out, &low.map(|x| x - 0.5 * width))?;
    write!(out, ", ")?;
    row(out, &high.map(|x| x + 0.5 * width))?;
    writeln!(out, "]")?;
    if cloud {
        writeln!(
            out,
            "        float[] widths = [{width}] (\n            interpolation = \"constant\"\n        )"
        )?;
    } else {
        write!(out, "        int[] faceVertexCounts = [")?;
        for i in 0..mesh.triangles.len() {
            out.extend_from_slice(if i == 0 { b"3" } else { b",3" });
        }
        write!(out, "]\n        int[] faceVertexIndices = [")?;
        for (i, &corner) in mesh.triangles.iter().flatten().enumerate() {
            if i > 0 {
                out.push(b',');
            }
            digits(out, u64::from(corner), 1);
        }
        writeln!(out, "]")?;
    }
    writeln!(out, "        rel material:binding = <{}>", look.path)?;
    columns(out, mesh, &points, look, spec)?;
    if !cloud {
        // Without this every reader would smooth the triangles (Catmull and Clark).
        writeln!(out, "        uniform token subdivisionScheme = \"none\"")?;
    }
    Ok(writeln!(out, "    }}")?)
}

fn columns(
    out: &mut Vec<u8>,
    mesh: &TriMesh,
    points: &[[f32; 3]],
    look: &Look,
    spec: &ExportSpec,
) -> Result<(), WriteError> {
    let normals: Vec<[f32; 3]> = mesh.normals.iter().map(|&n| spec.direction(unit(n))).collect();
    column(out, "normal3f[] normals", &normals, Fineness::Places(4))?;
    column(out, "point3f[] points", points, Fineness::Share)?;
    let product = |c: &[f32; 3]| [0, 1, 2].map(|k| share(c[k]) * look.shown[k]);
    if mesh.colors.is_empty() {
        write!(out, "        color3f[] primvars:displayColor = [")?;
        row(out, &look.shown)?;
        writeln!(out, "] (\n            interpolation = \"constant\"\n        )")?;
    } else {
        let colors: Vec<[f32; 3]> = mesh.colors.iter().map(product).collect();
        column(out, "color3f[] primvars:displayColor", &colors, Fineness::Places(4))?;
    }
    let pivots: Vec<[f32; 3]> = mesh.pivots.iter().map(|&p| spec.point(p)).collect();
    column(out, "point3f[] primvars:pivot", &pivots, Fineness::Share)?;
    // USD's t points up.
    let finite = |x: f32| if x.is_finite() { x } else { 0.0 };
    let st: Vec<[f32; 2]> = mesh.uvs.iter().map(|uv| [finite(uv[0]), 1.0 - finite(uv[1])]).collect();
    column(out, "texCoord2f[] primvars:st", &st, Fineness::Places(5))?;
    column(out, "float4[] primvars:wind", &mesh.wind, Fineness::Places(4))
}

/// How finely the numbers of a column are written: text of all digits of a large tree is twice as long and takes four
/// times as long.
#[derive(Clone, Copy)]
enum Fineness {
    /// So many places after the point.
    Places(u32),
    /// To a millionth of the largest of them: a hundredth of a millimetre in a tree of 20 m.
    Share,
}

impl Fineness {
    fn places<const N: usize>(self, rows: &[[f32; N]]) -> u32 {
        match self {
            Self::Places(places) => places,
            Self::Share => {
                let largest = rows.iter().flatten().fold(0.0_f64, |m, x| m.max(f64::from(x.abs())));
                let (mut places, mut step) = (0, 1.0);
                while step > 1e-6 * largest && places < 12 {
                    places += 1;
                    step *= 0.1;
                }
                places
            }
        }
    }
}

/// A value at each vertex; nothing where there is none.
fn column<const N: usize>(
    out: &mut Vec<u8>,
    what: &str,
    rows: &[[f32; N]],
    fineness: Fineness,
) -> Result<(), WriteError> {
    if rows.is_empty() {
        return Ok(());
    }
    let places = fineness.places(rows);
    write!(out, "        {what} = [")?;
    for (i, r) in rows.iter().enumerate() {
        out.extend_from_slice(if i > 0 { b",(" } else { b"(" });
        for (k, &x) in r.iter().enumerate() {
            if k > 0 {
                out.push(b',');
            }
            fixed(out, x, places)?;
        }
        out.push(b')');
    }
    let vertex = " (\n            interpolation = \"vertex\"\n        )";
    // Points are at vertices by their nature.
    Ok(writeln!(out, "]{}", if what.ends_with("points") { "" } else { vertex })?)
}

/// A number with at most so many places after the point (12 at most), without zeros at the end.
fn fixed(out: &mut Vec<u8>, x: f32, places: u32) -> Result<(), WriteError> {
    let whole = 10_u64.pow(places);
    #[expect(clippy::cast_precision_loss, reason = "a power of ten below 2^53")]
    let scaled = (f64::from(x) * whole as f64).round();
    if scaled.abs() > 9e15 || !scaled.is_finite() {
        return Ok(write!(out, "{x}")?);
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a whole number below 2^53")]
    let magnitude = scaled.abs() as u64;
    if magnitude == 0 {
        out.push(b'0');
        return Ok(());
    }
    if scaled < 0.0 {
        out.push(b'-');
    }
    let (above, mut below, mut width) = (magnitude / whole, magnitude % whole, places);
    digits(out, above, 1);
    if below > 0 {
        while below.is_multiple_of(10) {
            below /= 10;
            width -= 1;
        }
        out.push(b'.');
        digits(out, below, width as usize);
    }
    Ok(())
}

/// A whole number with at least so many digits (20 at most).
fn digits(out: &mut Vec<u8>, mut n: u64, least: usize) {
    let mut text = [b'0'; 20];
    let mut at = text.len();
    while n > 0 {
        at -= 1;
        let digit = (n % 10) as u8;
        text[at] = b'0' + digit;
        n /= 10;
    }
    out.extend_from_slice(&text[at.min(text.len() - least)..]);
}

fn row<const N: usize>(out: &mut Vec<u8>, values: &[f32; N]) -> Result<(), WriteError> {
    for (k, x) in values.iter().enumerate() {
        write!(out, "{}{x}", if k == 0 { "(" } else { ", " })?;
    }
    Ok(write!(out, ")")?)
}

/// The mean colour of a material, linear: what a viewer without materials should show.
fn shown(m: &Material) -> [f32; 3] {
    let base = m.base_color.map(share);
    let Some(texture) = &m.texture else { return base };
    // Some 4096 pixels tell as much as all of them.
    let step = (texture.pixels.len() / 4 / 4096).max(1);
    let (mut sum, mut weight) = ([0.0_f64; 3], 0.0_f64);
    for p in texture.pixels.chunks_exact(4).step_by(step).filter(|p| p[3] > 127) {
        for k in 0..3 {
            sum[k] += f64::from(linear(f32::from(p[k]) / 255.0));
        }
        weight += 1.0;
    }
    #[expect(clippy::cast_possible_truncation, reason = "a colour")]
    let mean = |k: usize| if weight > 0.0 { (sum[k] / weight) as f32 } else { 1.0 };
    [0, 1, 2].map(|k| base[k] * mean(k))
}

/// Identifiers that are each used once.
#[derive(Default)]
struct Identifiers(BTreeMap<String, usize>);

impl Identifiers {
    fn fresh(&mut self, wanted: &str, otherwise: &str) -> String {
        let wanted = identifier(wanted, otherwise);
        let numbered = (2_usize..).map(|n| format!("{wanted}_{n}"));
        let name = core::iter::once(wanted.clone()).chain(numbered).find(|n| !self.0.contains_key(n));
        let name = name.unwrap_or(wanted);
        self.0.insert(name.clone(), 1);
        name
    }
}

/// A name of ASCII letters, digits and underscores that does not begin with a digit: what every reader of USD takes.
fn identifier(name: &str, otherwise: &str) -> String {
    let keep = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    let name: String = name.trim().chars().map(keep).take(100).collect();
    if name.chars().all(|c| c == '_') {
        otherwise.to_owned()
    } else if name.starts_with(|c: char| c.is_ascii_digit()) {
        format!("_{name}")
    } else {
        name
    }
}

/// Text between quotes.
struct Quoted<'a>(&'a str);

impl fmt::Display for Quoted<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("\"")?;
        for c in self.0.chars() {
            match c {
                '"' | '\\' => write!(f, "\\{c}")?,
                c if c.is_control() => f.write_str(" ")?,
                c => write!(f, "{c}")?,
            }
        }
        f.write_str("\"")
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;

    #[test]
    fn names_become_identifiers_that_differ() {
        let mut names = Identifiers::default();
        let got = ["leaf-2", "leaf 2", "2 leaves", "\u{82b1}", "", "leaf_2"].map(|n| names.fresh(n, "part"));
        assert_eq!(got, ["leaf_2", "leaf_2_2", "_2_leaves", "part", "part_2", "leaf_2_3"]);
        assert_eq!(Quoted("a \"b\" \\ c\nd").to_string(), "\"a \\\"b\\\" \\\\ c d\"");
    }

    #[test]
    fn numbers_have_the_places_that_they_need() {
        let text = |x: f32, places: u32| {
            let mut out = Vec::new();
            fixed(&mut out, x, places).unwrap();
            String::from_utf8(out).unwrap()
        };
        let got = [0.0, -0.0, 1.0, -1.5, 0.25, -0.00004, 0.00006, 12.3456, 1e9, 100.0].map(|x| text(x, 4));
        assert_eq!(got, ["0", "0", "1", "-1.5", "0.25", "0", "0.0001", "12.3456", "1000000000", "100"]);
        assert_eq!(text(0.050_002, 5), "0.05", "zeros within stay");
        assert_eq!(text(0.003, 6), "0.003");
        assert_eq!(text(3e20, 4), "300000000000000000000");
        assert_eq!([Fineness::Share.places(&[[20.0_f32]]), Fineness::Share.places(&[[0.05_f32]])], [5, 8]);
        let mut out = Vec::new();
        [0, 7, 10, u64::MAX].iter().for_each(|&n| digits(&mut out, n, 1));
        assert_eq!(out, b"071018446744073709551615");
    }

    #[test]
    fn colour_without_materials_is_the_mean_of_what_is_seen() {
        let pixels = [[255, 255, 255, 255], [0, 0, 0, 255], [9, 9, 9, 0], [9, 9, 9, 0]].concat();
        let texture = Some(Arc::new(mesh::Texture { width: 2, height: 2, pixels }));
        let m = Material { texture, ..Material::plain("leaf", mesh::MaterialKind::Leaf, [1.0, 0.5, 0.0]) };
        assert_eq!(shown(&m), [0.5, 0.25, 0.0]);
    }
}
