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
/// `primvars:displayColor` and, if the model has them, `primvars:wind` and `primvars:pivot`; a material is one
/// `UsdPreviewSurface` with its normals, occlusion and roughness, and with an opacity threshold of one half if its
/// texture has holes; the same model gives the same bytes. Positions are written to a millionth of the largest,
/// texture coordinates to five places, all else at vertices to four. Not guaranteed: that vertex colours tint
/// textures, for which `UsdPreviewSurface` has no node: they are in `displayColor`, and colour materials without a
/// texture. Kind and translucency are custom data of the material.
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
    head(&mut out, (&root, model), spec)?;
    writeln!(out, "def Xform \"{root}\" (")?;
    writeln!(out, "    assetInfo = {{\n        string name = {}\n    }}", Quoted(&model.name))?;
    writeln!(out, "    kind = \"component\"\n)\n{{")?;
    let mut taken = Identifiers::default();
    let scope = taken.fresh("materials", "materials");
    let mut textures = TextureFiles::new(&stem);
    let looks = looks(&mut out, model, &format!("/{root}/{scope}"), &mut textures)?;
    for part in model.parts.iter().filter(|p| !p.mesh.positions.is_empty()) {
        let name = taken.fresh(&part.name, "part");
        let look = &looks[part.material.index()];
        prim(&mut out, part, &name, (look, model.material(part).double_sided), None, spec)?;
    }
    writeln!(out, "}}")?;
    Ok(UsdFiles { usda: out, textures: textures.into_files() })
}

/// Writes the metadata of a layer.
pub(super) fn head(
    out: &mut Vec<u8>,
    (root, model): (&str, &Model),
    spec: &ExportSpec,
) -> Result<(), WriteError> {
    let up = match spec.up {
        UpAxis::Y => "Y",
        UpAxis::Z => "Z",
    };
    let metres = match spec.unit {
        Unit::Metre => "1",
        Unit::Centimetre => "0.01",
        Unit::Millimetre => "0.001",
        Unit::Foot => "0.3048",
    };
    writeln!(out, "#usda 1.0\n(\n    defaultPrim = \"{root}\"")?;
    writeln!(out, "    doc = \"Burgeon {}\"", env!("CARGO_PKG_VERSION"))?;
    if let Some(offset) = model.offset_m {
        let [x, y, z] = spec.place(offset);
        writeln!(out, "    customLayerData = {{\n        double3 offset = ({x}, {y}, {z})\n    }}")?;
    }
    Ok(writeln!(out, "    metersPerUnit = {metres}\n    upAxis = \"{up}\"\n)\n")?)
}

/// Writes the scope `path` with the materials of a model.
pub(super) fn looks(
    out: &mut Vec<u8>,
    model: &Model,
    path: &str,
    textures: &mut TextureFiles<'_>,
) -> Result<Vec<Look>, WriteError> {
    let mut among = Identifiers::default();
    let looks: Vec<Look> = (model.materials.iter().enumerate())
        .map(|(i, m)| {
            // A part's tint colours a material without a texture; a part without colours shows the base colour.
            let users = || model.parts.iter().filter(|p| p.material.index() == i);
            let tinted = m.texture.is_none() && users().any(|p| !p.mesh.colors.is_empty());
            let file = m.texture.as_ref().map(|t| textures.name(t, &m.name)).transpose()?;
            let path = format!("{path}/{}", among.fresh(&m.name, "material"));
            let mut map = |of: &Option<std::sync::Arc<mesh::Texture>>, what: &str| {
                of.as_ref().map(|t| textures.name(t, &format!("{}-{what}", m.name))).transpose()
            };
            let (normal, orm) = (map(&m.maps.normal, "normal")?, map(&m.maps.orm, "orm")?);
            Ok(Look { path, file, normal, orm, tinted, shown: shown(m) })
        })
        .collect::<Result<_, WriteError>>()?;
    writeln!(out, "    def Scope \"{}\"\n    {{", path.rsplit('/').next().unwrap_or_default())?;
    for (m, look) in model.materials.iter().zip(&looks) {
        material(out, m, look)?;
    }
    writeln!(out, "    }}")?;
    Ok(looks)
}

/// Joints that move a mesh.
pub(super) struct Bound<'a> {
    /// Path of its skeleton.
    pub(super) skeleton: &'a str,
    /// Two joints of each vertex with their shares.
    pub(super) holds: &'a [[(u16, f32); 2]],
}

/// Appearance of a material in the file.
pub(super) struct Look {
    path: String,
    /// File of its texture.
    file: Option<String>,
    /// File of its normals.
    normal: Option<String>,
    /// File of its occlusion and roughness.
    orm: Option<String>,
    /// Vertex colours give its colour.
    tinted: bool,
    /// Linear colour for viewers that do not show materials.
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

/// Writes a node that reads a texture's file.
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

/// Writes a node that passes a column of the mesh on.
fn reader(out: &mut Vec<u8>, name: &str, kind: &str, column: &str) -> Result<(), WriteError> {
    writeln!(out, "            def Shader \"{name}\"\n            {{")?;
    writeln!(out, "                uniform token info:id = \"UsdPrimvarReader_{kind}\"")?;
    writeln!(out, "                string inputs:varname = \"{column}\"")?;
    Ok(writeln!(out, "                {kind} outputs:result\n            }}")?)
}

pub(super) fn prim(
    out: &mut Vec<u8>,
    part: &Part,
    name: &str,
    (look, double_sided): (&Look, bool),
    bound: Option<&Bound<'_>>,
    spec: &ExportSpec,
) -> Result<(), WriteError> {
    let mesh = &part.mesh;
    let points: Vec<[f32; 3]> = mesh.positions.iter().map(|&p| spec.point(p)).collect();
    let cloud = mesh.triangles.is_empty();
    let kind = if cloud { "Points" } else { "Mesh" };
    let schemas =
        if bound.is_some() { "\"MaterialBindingAPI\", \"SkelBindingAPI\"" } else { "\"MaterialBindingAPI\"" };
    writeln!(out, "\n    def {kind} \"{name}\" (\n        prepend apiSchemas = [{schemas}]\n    )\n    {{")?;
    if double_sided {
        writeln!(out, "        uniform bool doubleSided = 1")?;
    }
    let (low, high) = points.iter().fold(([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]), |(low, high), p| {
        ([0, 1, 2].map(|k| low[k].min(p[k])), [0, 1, 2].map(|k| high[k].max(p[k])))
    });
    // A point has a width: a three-hundredth of the whole is visible and does not hide its neighbours.
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
        faces(out, &mesh.triangles, bound.is_some())?;
    }
    writeln!(out, "        rel material:binding = <{}>", look.path)?;
    columns(out, mesh, &points, (look, bound.is_some()), spec)?;
    if let Some(bound) = bound {
        holds(out, bound)?;
    }
    if !cloud {
        // Without this every reader would smooth the triangles (Catmull and Clark).
        writeln!(out, "        uniform token subdivisionScheme = \"none\"")?;
    }
    Ok(writeln!(out, "    }}")?)
}

/// Share of the vertices of a mesh with two joints, below which each has the larger of the two alone.
const FEW_SHARED: f64 = 0.01;

/// Writes the joints of each vertex.
fn holds(out: &mut Vec<u8>, bound: &Bound<'_>) -> Result<(), WriteError> {
    // Few vertices of thin wood have a second joint, which would cost each vertex room.
    let second = bound.holds.iter().filter(|h| h[1].1 > 0.0).count();
    let count = if second as f64 > FEW_SHARED * bound.holds.len() as f64 { 2 } else { 1 };
    let one = |hold: &[(u16, f32); 2]| {
        let [a, b] = *hold;
        if count == 2 { [a, b] } else { [(if b.1 > a.1 { b.0 } else { a.0 }, 1.0), b] }
    };
    let each = || bound.holds.iter().flat_map(|hold| one(hold).into_iter().take(count));
    let joints: Vec<String> = each().map(|(joint, _)| joint.to_string()).collect();
    let mut shares = Vec::with_capacity(8 * bound.holds.len());
    for (k, (_, share)) in each().enumerate() {
        if k > 0 {
            shares.push(b',');
        }
        fixed(&mut shares, share, 3)?;
    }
    let each_vertex =
        format!("(\n            elementSize = {count}\n            interpolation = \"vertex\"\n        )");
    writeln!(out, "        matrix4d primvars:skel:geomBindTransform = {}", transform([0.0; 3]))?;
    writeln!(out, "        int[] primvars:skel:jointIndices = [{}] {each_vertex}", joints.join(","))?;
    write!(out, "        float[] primvars:skel:jointWeights = [")?;
    out.extend_from_slice(&shares);
    writeln!(out, "] {each_vertex}")?;
    Ok(writeln!(out, "        rel skel:skeleton = <{}>", bound.skeleton)?)
}

/// Formats a matrix that moves to a place.
pub(super) fn transform([x, y, z]: [f64; 3]) -> String {
    format!("( (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), ({x}, {y}, {z}, 1) )")
}

/// Writes the corners of the faces; `is_short`: two triangles that share an edge and follow each other are one face of
/// four corners, which takes a third less room.
fn faces(out: &mut Vec<u8>, triangles: &[[u32; 3]], is_short: bool) -> Result<(), WriteError> {
    let (mut counts, mut corners) = (Vec::with_capacity(triangles.len()), Vec::new());
    let mut rest = triangles;
    while let [first, after @ ..] = rest {
        let four = after.first().filter(|_| is_short).and_then(|next| joined(*first, *next));
        if let Some(four) = four {
            counts.push(4);
            corners.extend(four);
            rest = &after[1..];
        } else {
            counts.push(3);
            corners.extend(*first);
            rest = after;
        }
    }
    for (name, values) in [("faceVertexCounts", &counts), ("faceVertexIndices", &corners)] {
        write!(out, "        int[] {name} = [")?;
        for (i, &value) in values.iter().enumerate() {
            if i > 0 {
                out.push(b',');
            }
            digits(out, u64::from(value), 1);
        }
        writeln!(out, "]")?;
    }
    Ok(())
}

/// Returns the corners of two triangles as one face, if they share an edge.
fn joined(a: [u32; 3], b: [u32; 3]) -> Option<[u32; 4]> {
    for k in 0..3 {
        let [u, v, w] = [a[k], a[(k + 1) % 3], a[(k + 2) % 3]];
        for j in 0..3 {
            if b[j] == v && b[(j + 1) % 3] == u && b[(j + 2) % 3] != w {
                return Some([w, u, b[(j + 2) % 3], v]);
            }
        }
    }
    None
}

fn columns(
    out: &mut Vec<u8>,
    mesh: &TriMesh,
    points: &[[f32; 3]],
    (look, is_short): (&Look, bool),
    spec: &ExportSpec,
) -> Result<(), WriteError> {
    let normals: Vec<[f32; 3]> = mesh.normals.iter().map(|&n| spec.direction(unit(n))).collect();
    let (of_normals, of_points, of_st) = if is_short {
        (Fineness::Places(2), Fineness::SHORT, Fineness::Places(3))
    } else {
        (Fineness::Places(4), Fineness::FINE, Fineness::Places(5))
    };
    column(out, "normal3f[] normals", &normals, of_normals)?;
    column(out, "point3f[] points", points, of_points)?;
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
    column(out, "point3f[] primvars:pivot", &pivots, Fineness::FINE)?;
    // USD's t points up.
    let finite = |x: f32| if x.is_finite() { x } else { 0.0 };
    let st: Vec<[f32; 2]> = mesh.uvs.iter().map(|uv| [finite(uv[0]), 1.0 - finite(uv[1])]).collect();
    column(out, "texCoord2f[] primvars:st", &st, of_st)?;
    column(out, "float4[] primvars:wind", &mesh.wind, Fineness::Places(4))
}

/// Precision of the numbers of a column: with all digits, the text of a large tree is twice as long and takes four
/// times as long to write.
#[derive(Clone, Copy)]
enum Fineness {
    /// This number of decimal places.
    Places(u32),
    /// A share of the largest number.
    Share(f64),
}

impl Fineness {
    /// A hundredth of a millimetre in a tree of 10 m.
    const FINE: Self = Self::Share(1e-6);
    /// A tenth of a millimetre in a tree of 10 m.
    const SHORT: Self = Self::Share(1e-5);

    fn places<const N: usize>(self, rows: &[[f32; N]]) -> u32 {
        match self {
            Self::Places(places) => places,
            Self::Share(share) => {
                let largest = rows.iter().flatten().fold(0.0_f64, |m, x| m.max(f64::from(x.abs())));
                let (mut places, mut step) = (0, 1.0);
                while step > share * largest && places < 12 {
                    places += 1;
                    step *= 0.1;
                }
                places
            }
        }
    }
}

/// Writes a value for each vertex; nothing if there are none.
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
    // Points are per vertex by definition.
    Ok(writeln!(out, "]{}", if what.ends_with("points") { "" } else { vertex })?)
}

/// Writes a number with at most `places` decimal places (12 at most), without zeros at the end.
pub(super) fn fixed(out: &mut Vec<u8>, x: f32, places: u32) -> Result<(), WriteError> {
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

/// Writes a whole number with at least `least` digits (20 at most).
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

/// Returns the mean colour of a material, linear, for viewers without materials.
fn shown(m: &Material) -> [f32; 3] {
    let base = m.base_color.map(share);
    let Some(texture) = &m.texture else { return base };
    // Some 4096 pixels are enough for a mean.
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

/// Makes identifiers distinct.
#[derive(Default)]
pub(crate) struct Identifiers(BTreeMap<String, usize>);

impl Identifiers {
    pub(crate) fn fresh(&mut self, wanted: &str, otherwise: &str) -> String {
        let wanted = identifier(wanted, otherwise);
        let numbered = (2_usize..).map(|n| format!("{wanted}_{n}"));
        let name = core::iter::once(wanted.clone()).chain(numbered).find(|n| !self.0.contains_key(n));
        let name = name.unwrap_or(wanted);
        self.0.insert(name.clone(), 1);
        name
    }
}

/// Returns a name of ASCII letters, digits and underscores that does not begin with a digit: every reader of USD
/// accepts it.
pub(crate) fn identifier(name: &str, otherwise: &str) -> String {
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
pub(crate) struct Quoted<'a>(pub(crate) &'a str);

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
        assert_eq!([Fineness::FINE.places(&[[20.0_f32]]), Fineness::FINE.places(&[[0.05_f32]])], [5, 8]);
        let mut out = Vec::new();
        [0, 7, 10, u64::MAX].iter().for_each(|&n| digits(&mut out, n, 1));
        assert_eq!(out, b"071018446744073709551615");
    }

    #[test]
    fn triangles_that_share_an_edge_are_one_face() {
        assert_eq!(joined([0, 1, 2], [0, 2, 3]), Some([1, 2, 3, 0]));
        assert_eq!(joined([0, 1, 2], [2, 1, 3]), Some([0, 1, 3, 2]));
        assert_eq!(joined([0, 1, 2], [1, 2, 3]), None, "it faces the other way");
        let mut out = Vec::new();
        faces(&mut out, &[[0, 1, 2], [0, 2, 3], [4, 5, 6]], true).unwrap();
        let text = String::from_utf8(out).unwrap();
        assert!(text.contains("[4,3]") && text.contains("[1,2,3,0,4,5,6]"), "{text}");
    }

    #[test]
    fn colour_without_materials_is_the_mean_of_what_is_seen() {
        let pixels = [[255, 255, 255, 255], [0, 0, 0, 255], [9, 9, 9, 0], [9, 9, 9, 0]].concat();
        let texture = Some(Arc::new(mesh::Texture { width: 2, height: 2, pixels }));
        let m = Material { texture, ..Material::plain("leaf", mesh::MaterialKind::Leaf, [1.0, 0.5, 0.0]) };
        assert_eq!(shown(&m), [0.5, 0.25, 0.0]);
    }
}
