//! Drawings as flowers that open, and files as forms of petals.

use std::path::Path;

use burgeon::bloom::PetalForm;
use burgeon::formats::{DrawingFormat, read_drawings};
use burgeon::ink::Drawing;
use burgeon::plant::{OrganKind, Shape};
use burgeon::{Seed, SketchOptions};

use crate::failure::{Failure, Outcome};
use crate::files::{self, Kind};
use crate::machine::Machine;

pub(crate) fn is_drawing(path: &Path) -> bool {
    files::extension(path)
        .is_some_and(|e| e.eq_ignore_ascii_case("burgeon") || DrawingFormat::from_extension(e).is_some())
}

/// Reads the only drawing of a file, and the options of its project.
pub(crate) fn drawing(path: &Path) -> Outcome<(Drawing, SketchOptions)> {
    let (input, kind) = files::open(path)?;
    match kind {
        Kind::Drawing(format) => {
            let mut all = read_drawings(input, format, &files::stem(path));
            let first = all.next().ok_or_else(|| Failure::bad_file(path, "holds no drawing"))?;
            Ok((first.map_err(|e| Failure::bad_file(path, e))?.drawing, SketchOptions::default()))
        }
        Kind::Project => {
            let document = files::read_project(path, input)?;
            let (read, plant) = files::drawing_of(path, &document)?;
            Ok((read.drawing, SketchOptions::from_plant(plant)))
        }
        Kind::Model(_) => Err(Failure::bad_file(path, "is a model, not a drawing")),
        Kind::Structure(_) => Err(Failure::bad_file(path, "is the structure of a plant, not a drawing")),
    }
}

/// Returns the form of a petal: marks, a model, or the first petal (or else leaf) of a drawing.
pub(crate) fn petal_form(path: &Path, seed: u64, machine: &Machine) -> Outcome<(PetalForm, f64)> {
    let outline =
        if is_drawing(path) && !files::extension(path).is_some_and(|e| e.eq_ignore_ascii_case("json")) {
            let (drawing, options) = drawing(path)?;
            let made = burgeon::make_from_sketch(&drawing, &options, Seed::new(seed), &machine.run());
            let made = made.map_err(|e| Failure::bad_file(path, e))?;
            let blade = |wanted: OrganKind| {
                made.plant.organs.iter().filter(|o| o.kind == wanted).find_map(|o| {
                    match made.plant.shapes.get(o.shape.index())? {
                        Shape::Blade(b) => Some(b.outline.clone()),
                        _ => None,
                    }
                })
            };
            blade(OrganKind::Petal).or_else(|| blade(OrganKind::Leaf)).ok_or_else(|| {
                Failure::bad_file(
                    path,
                    "holds no petal and no leaf; draw one closed outline from its root around to its root",
                )
            })?
        } else {
            crate::leaf_data::template_of(path, seed, machine)?.scaled(1.0).outline
        };
    PetalForm::from_outline(&outline)
        .ok_or_else(|| Failure::bad_file(path, "has no form of a petal: it has no width"))
}
