//! Summaries of files, for people.

use base::Warning;
use ink::{Drawing, StrokeMode};
use mesh::Model;
use serde::Serialize;

/// Summary of a model; lengths in metres.
///
/// ```
/// let info = formats::ModelSummary::from_model(&mesh::Model::default(), &[]);
/// assert_eq!((info.triangles, info.size), (0, [0.0; 3]));
/// ```
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ModelSummary {
    /// Name of the whole.
    pub name: String,
    /// Vertices of all parts.
    pub vertices: usize,
    /// Triangles of all parts.
    pub triangles: usize,
    /// Lowest corner of the box around everything, in metres.
    pub min: [f64; 3],
    /// Highest corner.
    pub max: [f64; 3],
    /// Edge lengths of that box.
    pub size: [f64; 3],
    /// Always `m`.
    pub unit: &'static str,
    /// Always `+Y`.
    pub up: &'static str,
    /// The parts.
    pub parts: Vec<PartSummary>,
    /// The materials.
    pub materials: Vec<MaterialSummary>,
    /// Warnings of the reader, and faults of the meshes.
    pub warnings: Vec<String>,
}

/// Summary of a part.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PartSummary {
    /// Its name.
    pub name: String,
    /// Name of its material.
    pub material: String,
    /// Vertices.
    pub vertices: usize,
    /// Triangles.
    pub triangles: usize,
    /// It has texture coordinates.
    pub uvs: bool,
    /// It has colours at its vertices.
    pub colors: bool,
    /// It has columns for wind.
    pub wind: bool,
}

/// Summary of a material.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MaterialSummary {
    /// Its name.
    pub name: String,
    /// Word for its kind.
    pub kind: &'static str,
    /// Width and height of its texture in pixels.
    pub texture: Option<[u32; 2]>,
    /// Visible from both sides.
    pub double_sided: bool,
}

impl ModelSummary {
    /// Returns the summary of a model, with the warnings of its reader.
    pub fn from_model(model: &Model, warnings: &[Warning]) -> Self {
        let b = model.bounds();
        let corner = |v: glam::DVec3| if b.is_empty() { [0.0; 3] } else { v.to_array() };
        let mut warnings: Vec<String> = warnings.iter().map(|w| w.message.clone()).collect();
        let mut degenerate = 0_usize;
        for fault in model.validate() {
            match fault {
                mesh::MeshFault::Degenerate(_) => degenerate += 1,
                // One fault of each sort is enough to send the user to the maker of the file.
                other if warnings.len() < 20 => warnings.push(other.to_string()),
                _ => {}
            }
        }
        if degenerate > 0 {
            warnings.push(format!("{degenerate} triangles use one vertex twice"));
        }
        let part = |p: &mesh::Part| PartSummary {
            name: p.name.clone(),
            material: model.materials.get(p.material.index()).map_or_else(String::new, |m| m.name.clone()),
            vertices: p.mesh.positions.len(),
            triangles: p.mesh.triangles.len(),
            uvs: !p.mesh.uvs.is_empty(),
            colors: !p.mesh.colors.is_empty(),
            wind: !p.mesh.wind.is_empty(),
        };
        let material = |m: &mesh::Material| MaterialSummary {
            name: m.name.clone(),
            kind: m.kind.word(),
            texture: m.texture.as_ref().map(|t| [t.width, t.height]),
            double_sided: m.double_sided,
        };
        Self {
            name: model.name.clone(),
            vertices: model.vertex_count(),
            triangles: model.triangle_count(),
            min: corner(b.min),
            max: corner(b.max),
            size: b.size().to_array(),
            unit: "m",
            up: "+Y",
            parts: model.parts.iter().map(part).collect(),
            materials: model.materials.iter().map(material).collect(),
            warnings,
        }
    }
}

/// Summary of a drawing; lengths in the file's unit, y up.
///
/// ```
/// let d = ink::Drawing::from_polylines("a", &[vec![glam::DVec2::ZERO, glam::DVec2::new(3.0, 4.0)]]);
/// let info = formats::DrawingSummary::from_drawing(&d, &[]);
/// assert_eq!((info.strokes, info.points, info.max), (1, 2, [3.0, 4.0]));
/// ```
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DrawingSummary {
    /// Its name.
    pub name: String,
    /// Strokes.
    pub strokes: usize,
    /// Points of all strokes.
    pub points: usize,
    /// Points that are not finite.
    pub not_finite: usize,
    /// Lowest corner of the box around the finite points.
    pub min: [f64; 2],
    /// Highest corner.
    pub max: [f64; 2],
    /// Strokes in the modes parts, branch contour, leaf contour.
    pub modes: [usize; 3],
    /// Some points have times.
    pub times: bool,
    /// Some points have pressures.
    pub pressures: bool,
    /// Warnings of the reader.
    pub warnings: Vec<String>,
}

impl DrawingSummary {
    /// Returns the summary of a drawing, with the warnings of its reader.
    pub fn from_drawing(drawing: &Drawing, warnings: &[Warning]) -> Self {
        let samples = || drawing.strokes.iter().flat_map(|s| &s.samples);
        let finite = || samples().map(|s| s.at).filter(|p| p.is_finite());
        let none = glam::DVec2::INFINITY;
        let (min, max) = finite().fold((none, -none), |(lo, hi), p| (lo.min(p), hi.max(p)));
        let corner = |v: glam::DVec2| if min.x > max.x { [0.0; 2] } else { v.to_array() };
        let count = |mode| drawing.strokes.iter().filter(|s| s.mode == mode).count();
        Self {
            name: drawing.name.clone(),
            strokes: drawing.strokes.len(),
            points: samples().count(),
            not_finite: samples().count() - finite().count(),
            min: corner(min),
            max: corner(max),
            modes: [StrokeMode::Parts, StrokeMode::BranchContour, StrokeMode::LeafContour].map(count),
            times: samples().any(|s| s.time_ms.is_some()),
            pressures: samples().any(|s| s.pressure.is_some()),
            warnings: warnings.iter().map(|w| w.message.clone()).collect(),
        }
    }
}
