//! PLY, text or binary -> Model. Our own reader, because headers may lie: it neither reserves nor loops before it
//! knows that the bytes exist.

use base::Report;
use mesh::{Material, MaterialId, MaterialKind, Model, Part, TriMesh};

use super::picture::linear;
use super::{MAX_ROWS, unit};
use crate::ModelFormat;
use crate::error::{FileFault, ModelError, Place};

/// Most lines of a header; real ones have a few dozen.
const MAX_HEADER_LINES: usize = 1_000;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn parse(word: &str) -> Option<Self> {
        Some(match word {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    pub(crate) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    pub(crate) fn is_float(self) -> bool {
        matches!(self, Self::F32 | Self::F64)
    }
}

#[derive(Debug)]
pub(crate) struct Property {
    pub(crate) name: String,
    /// Type of a list's length.
    list: Option<Scalar>,
    pub(crate) scalar: Scalar,
}

#[derive(Debug)]
pub(crate) struct Element {
    pub(crate) name: String,
    pub(crate) count: usize,
    pub(crate) properties: Vec<Property>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Coding {
    Text,
    Little,
    Big,
}

fn fail(place: Place, what: impl Into<String>) -> ModelError {
    let fault = FileFault::malformed(what, "export the model again");
    ModelError::new(ModelFormat::Ply, place, fault)
}

pub(super) fn read(bytes: &[u8], name: &str, report: &mut Report) -> Result<Model, ModelError> {
    let (coding, elements, body) = header(bytes)?;
    let mut input = Input::new(bytes, body, coding);
    let mut mesh = TriMesh::default();
    let mut left_out = Vec::new();
    for element in &elements {
        if element.properties.is_empty() {
            continue;
        }
        check_count(&input, element)?;
        match element.name.as_str() {
            "vertex" => vertices(&mut input, element, &mut mesh)?,
            "face" => faces(&mut input, element, &mut mesh)?,
            other => {
                left_out.push(other.to_owned());
                let mut row = Row::default();
                (0..element.count).try_for_each(|i| input.row(element, i, &mut row))?;
            }
        }
    }
    if !left_out.is_empty() {
        base::warn!(
            report,
            "ply-left-out",
            { elements = left_out.join(", ") },
            "left out: elements {elements}"
        );
    }
    if mesh.positions.is_empty() {
        return Err(fail(Place::File, "it has no vertices with x, y and z"));
    }
    let n = mesh.positions.len();
    if let Some(t) = mesh.triangles.iter().position(|t| t.iter().any(|&i| i as usize >= n)) {
        return Err(fail(
            Place::Item(format!("triangle {t}")),
            format!("it names a vertex beyond the {n} there are"),
        ));
    }
    let part = if name.is_empty() { "part" } else { name };
    Ok(Model {
        name: name.to_owned(),
        parts: vec![Part { name: part.to_owned(), material: MaterialId::new(0), mesh }],
        materials: vec![Material::plain("default", MaterialKind::Other, [1.0; 3])],
        offset_m: None,
    })
}

/// Refuses a count that the bytes after it cannot hold, or that is beyond the bound.
pub(crate) fn check_count(input: &Input<'_>, element: &Element) -> Result<(), ModelError> {
    let (bytes, coding) = (input.bytes, input.coding);
    // The fewest bytes of a row: a false count is refused before memory is taken for it.
    let least: usize = match coding {
        Coding::Text => element.properties.len(),
        _ => element.properties.iter().map(|p| p.list.unwrap_or(p.scalar).size()).sum(),
    };
    let there = (bytes.len() - input.at.min(bytes.len())) / least.max(1);
    if element.count > there + 1 {
        let inside = format!(
            "element `{}`: {} rows are announced, at most {there} are there",
            element.name, element.count
        );
        return Err(ModelError::new(
            ModelFormat::Ply,
            Place::Byte(input.at as u64),
            FileFault::Truncated { inside },
        ));
    }
    if element.count > MAX_ROWS {
        let fault = FileFault::TooMuch {
            what: "the number of rows",
            limit: MAX_ROWS as u64,
            advice: "split the model into several files",
        };
        return Err(ModelError::new(ModelFormat::Ply, Place::Item(element.name.clone()), fault));
    }
    Ok(())
}

pub(crate) fn header(bytes: &[u8]) -> Result<(Coding, Vec<Element>, usize), ModelError> {
    let mut at = 0;
    let mut elements: Vec<Element> = Vec::new();
    let mut coding = None;
    for number in 1..=MAX_HEADER_LINES {
        let Some(length) = bytes.get(at..).and_then(|b| b.iter().position(|&b| b == b'\n')) else {
            let fault = FileFault::Truncated { inside: "the header".into() };
            return Err(ModelError::new(ModelFormat::Ply, Place::line(number), fault));
        };
        let line = String::from_utf8_lossy(&bytes[at..at + length]);
        at += length + 1;
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        let bad = |what: &str| fail(Place::line(number), what.to_owned());
        match words.as_slice() {
            ["ply"] if number == 1 => {}
            _ if number == 1 => return Err(bad("it does not begin with `ply`")),
            ["format", "ascii", _] => coding = Some(Coding::Text),
            ["format", "binary_little_endian", _] => coding = Some(Coding::Little),
            ["format", "binary_big_endian", _] => coding = Some(Coding::Big),
            ["element", name, count] => {
                let count = count.parse().ok().ok_or_else(|| bad("the number of rows is broken"))?;
                elements.push(Element { name: (*name).to_owned(), count, properties: Vec::new() });
            }
            ["property", rest @ ..] => {
                let property = match rest {
                    ["list", length, scalar, name] => Scalar::parse(length)
                        .filter(|l| !l.is_float())
                        .zip(Scalar::parse(scalar))
                        .map(|(l, scalar)| Property { name: (*name).to_owned(), list: Some(l), scalar }),
                    [scalar, name] => Scalar::parse(scalar).map(|scalar| Property {
                        name: (*name).to_owned(),
                        list: None,
                        scalar,
                    }),
                    _ => None,
                };
                let property = property.ok_or_else(|| bad("the type of a property is unknown"))?;
                let element = elements.last_mut().ok_or_else(|| bad("a property before any element"))?;
                element.properties.push(property);
            }
            ["end_header"] => {
                let coding = coding.ok_or_else(|| bad("the header names no format"))?;
                return Ok((coding, elements, at));
            }
            [] | ["comment" | "obj_info", ..] => {}
            _ => return Err(bad("a line of the header is not understood")),
        }
    }
    Err(fail(Place::line(MAX_HEADER_LINES), "the header does not end"))
}

/// One row: scalars in the order of the properties (0 for lists), and the list that is wanted.
#[derive(Debug, Default)]
pub(crate) struct Row {
    pub(crate) values: Vec<f64>,
    list: Vec<f64>,
    /// Index of the property whose list is kept.
    wanted: Option<usize>,
}

pub(crate) struct Input<'a> {
    bytes: &'a [u8],
    at: usize,
    coding: Coding,
}

impl<'a> Input<'a> {
    pub(crate) fn new(bytes: &'a [u8], at: usize, coding: Coding) -> Self {
        Self { bytes, at, coding }
    }

    /// Returns the number of unread bytes, without white space at the end.
    pub(crate) fn rest(&self) -> usize {
        self.bytes.get(self.at..).map_or(0, |rest| rest.trim_ascii_end().len())
    }

    pub(crate) fn row(&mut self, element: &Element, index: usize, row: &mut Row) -> Result<(), ModelError> {
        row.values.clear();
        for (k, property) in element.properties.iter().enumerate() {
            let cut = || {
                let inside = format!("row {index} of element `{}`", element.name);
                ModelError::new(
                    ModelFormat::Ply,
                    Place::Byte(self.bytes.len() as u64),
                    FileFault::Truncated { inside },
                )
            };
            let Some(length) = property.list else {
                let value = self.scalar(property.scalar).map_err(|c| c.unwrap_or_else(cut))?;
                row.values.push(value);
                continue;
            };
            let n = self.scalar(length).map_err(|c| c.unwrap_or_else(cut))?;
            row.values.push(0.0);
            let keep = row.wanted == Some(k);
            if keep {
                row.list.clear();
            }
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "an integer type, not negative"
            )]
            let n = n.max(0.0) as u64;
            for _ in 0..n {
                let value = self.scalar(property.scalar).map_err(|c| c.unwrap_or_else(cut))?;
                if keep {
                    row.list.push(value);
                }
            }
        }
        Ok(())
    }

    /// Reads the next value; `Err(None)` at the end of the file.
    fn scalar(&mut self, kind: Scalar) -> Result<f64, Option<ModelError>> {
        if self.coding == Coding::Text {
            let rest = self.bytes.get(self.at..).ok_or(None)?;
            let start = rest.iter().position(|b| !b.is_ascii_whitespace()).ok_or(None)?;
            let word = &rest[start..];
            let word = &word[..word.iter().position(u8::is_ascii_whitespace).unwrap_or(word.len())];
            let at = self.at + start;
            self.at = at + word.len();
            let number = core::str::from_utf8(word).ok().and_then(|w| w.parse().ok());
            return number.ok_or_else(|| {
                let word = base::quoted(&String::from_utf8_lossy(word));
                Some(fail(Place::Byte(at as u64), format!("{word:?} is no number")))
            });
        }
        let raw = self.bytes.get(self.at..self.at + kind.size()).ok_or(None)?;
        self.at += kind.size();
        let mut b = [0_u8; 8];
        b.iter_mut().zip(raw).for_each(|(b, r)| *b = *r);
        if self.coding == Coding::Big {
            b[..kind.size()].reverse();
        }
        let four = [b[0], b[1], b[2], b[3]];
        Ok(match kind {
            Scalar::I8 => f64::from(i8::from_le_bytes([b[0]])),
            Scalar::U8 => f64::from(b[0]),
            Scalar::I16 => f64::from(i16::from_le_bytes([b[0], b[1]])),
            Scalar::U16 => f64::from(u16::from_le_bytes([b[0], b[1]])),
            Scalar::I32 => f64::from(i32::from_le_bytes(four)),
            Scalar::U32 => f64::from(u32::from_le_bytes(four)),
            Scalar::F32 => f64::from(f32::from_le_bytes(four)),
            Scalar::F64 => f64::from_le_bytes(b),
        })
    }
}

#[expect(clippy::cast_possible_truncation, reason = "meshes are f32 by design")]
fn narrow(x: f64) -> f32 {
    x as f32
}

fn vertices(input: &mut Input<'_>, element: &Element, mesh: &mut TriMesh) -> Result<(), ModelError> {
    let find = |names: &[&str]| element.properties.iter().position(|p| names.contains(&p.name.as_str()));
    let all = |columns: [&[&str]; 3]| Some([find(columns[0])?, find(columns[1])?, find(columns[2])?]);
    let Some(position) = all([&["x"], &["y"], &["z"]]) else {
        return Err(fail(Place::Item("element `vertex`".into()), "it has no x, y and z"));
    };
    let normal = all([&["nx"], &["ny"], &["nz"]]);
    let uv = find(&["s", "u", "texture_u"]).zip(find(&["t", "v", "texture_v"]));
    let color =
        all([&["red", "diffuse_red", "r"], &["green", "diffuse_green", "g"], &["blue", "diffuse_blue", "b"]]);
    // Bytes are 0 to 255, sixteen bits 0 to 65535, floats 0 to 1.
    let most = color.map_or(1.0, |c| match element.properties[c[0]].scalar.size() {
        _ if element.properties[c[0]].scalar.is_float() => 1.0,
        2 => 65_535.0,
        _ => 255.0,
    });
    let mut row = Row::default();
    for i in 0..element.count {
        input.row(element, i, &mut row)?;
        let v = &row.values;
        let p = position.map(|k| narrow(v[k]));
        if !p.iter().all(|x| x.is_finite()) {
            return Err(fail(Place::Item(format!("vertex {i}")), "a coordinate is not finite"));
        }
        mesh.positions.push(p);
        if let Some(n) = normal {
            mesh.normals.push(unit(n.map(|k| narrow(v[k]))));
        }
        if let Some((s, t)) = uv {
            mesh.uvs.push([narrow(v[s]), 1.0 - narrow(v[t])]);
        }
        if let Some(c) = color {
            mesh.colors.push(c.map(|k| linear(narrow(v[k] / most))));
        }
    }
    Ok(())
}

fn faces(input: &mut Input<'_>, element: &Element, mesh: &mut TriMesh) -> Result<(), ModelError> {
    let names = ["vertex_indices", "vertex_index"];
    let wanted = element.properties.iter().position(|p| p.list.is_some() && names.contains(&p.name.as_str()));
    let mut row = Row { wanted, ..Row::default() };
    for i in 0..element.count {
        input.row(element, i, &mut row)?;
        let whole = |x: f64| {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "checked in the condition"
            )]
            let index = (x >= 0.0 && x < f64::from(u32::MAX)).then_some(x as u32);
            index
        };
        let corners: Option<Vec<u32>> = row.list.iter().map(|&x| whole(x)).collect();
        let Some(corners) = corners else {
            return Err(fail(Place::Item(format!("face {i}")), "it names a vertex below zero"));
        };
        // A face with fewer than three corners has no area.
        if let Some((&first, others)) = corners.split_first() {
            mesh.triangles.extend(others.windows(2).map(|w| [first, w[0], w[1]]));
        }
        if mesh.triangles.len() > MAX_ROWS {
            return Err(fail(Place::Item(format!("face {i}")), "there are more triangles than are read"));
        }
    }
    Ok(())
}
