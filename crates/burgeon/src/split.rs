//! Splits a drawing of several plants into several drawings, each a plant of its own.

use base::{Run, ops};
use document::{
    CommandError, Document, DocumentPlant, Editor, Maker, NewPlant, NewStroke, PlantId, SceneCommand,
};
use glam::DVec3;
use ink::Drawing;
use reading::{PlantReading, Reading};
use sketch::SketchSpec;

use crate::evaluate::{Evaluator, FrontView};
use crate::make::{MakeError, SketchOptions};

/// Name of the step in the history.
const STEP: &str = "split-plant";

/// Reason why a drawing stays one plant.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SplitError {
    /// There is no such plant, or it was not drawn.
    #[error("only a drawing can be split into its plants")]
    NoDrawing,
    /// It shows one plant.
    #[error("\"{name}\" shows one plant: there is nothing to split")]
    OnePlant {
        /// Name of the plant.
        name: String,
    },
    /// Its edits refer to branches of the whole.
    #[error(
        "\"{name}\" has edits by hand, which would be lost: split it before it is edited, or delete the edits"
    )]
    Edited {
        /// Name of the plant.
        name: String,
    },
    /// It cannot be made.
    #[error(transparent)]
    Make(#[from] MakeError),
    /// The document does not accept the parts.
    #[error(transparent)]
    Command(#[from] CommandError),
}

base::coded!(SplitError {
    Self::NoDrawing => "split-no-drawing" {},
    Self::OnePlant { name } => "split-one-plant" { name },
    Self::Edited { name } => "split-edited" { name },
} wraps {
    Self::Make(e) => e, MakeError;
    Self::Command(e) => e, CommandError;
});

/// Replaces a plant of a drawing by the plants in it, each with the strokes that show it: one step of undo, called
/// `split-plant`.
///
/// Guaranteed: every stroke of a plant is in one of them; each keeps its place and its height, from left to right,
/// after the other plants; after an error the document is as it was. Not guaranteed: that a plant by itself is read as
/// it was among the others. The line of a ground that they share belongs to none of them and is left out.
///
/// # Errors
/// [`SplitError`]: it is not a drawing, shows one plant, or has hand edits; or the document has no room.
pub fn split(editor: &mut Editor, plant: PlantId, run: &Run<'_>) -> Result<(), SplitError> {
    let parts = parts(editor.document(), plant, run)?;
    editor.begin_gesture(STEP)?;
    let mut commands = parts.into_iter().map(|p| SceneCommand::Add(Box::new(p)));
    let done = commands
        .try_for_each(|add| editor.run(add))
        .and_then(|()| editor.run(SceneCommand::Remove(vec![plant])));
    if let Err(e) = done {
        editor.cancel_gesture();
        return Err(e.into());
    }
    editor.commit();
    Ok(())
}

fn parts(document: &Document, id: PlantId, run: &Run<'_>) -> Result<Vec<NewPlant>, SplitError> {
    let plant =
        document.plant(id).filter(|p| p.settings().sketch().is_some()).ok_or(SplitError::NoDrawing)?;
    let name = || plant.settings().name.clone();
    if !plant.settings().edits.is_empty() {
        return Err(SplitError::Edited { name: name() });
    }
    let mut options = SketchOptions::from_plant(plant);
    let (reading, front) = looked_at(&plant.drawing(), &options, plant, run)?;
    if reading.plants.len() < 2 {
        return Err(SplitError::OnePlant { name: name() });
    }
    options.spec.height_m = Some(1.0);
    let whole = Whole { plant, options, reading: &reading, front };
    (0..reading.plants.len()).map(|k| whole.part(k, run)).collect()
}

/// Returns the reading of a drawing, and its placement in its plant.
fn looked_at(
    drawing: &Drawing,
    options: &SketchOptions,
    plant: &DocumentPlant,
    run: &Run<'_>,
) -> Result<(Reading, FrontView), MakeError> {
    let mut evaluator = Evaluator::previewing();
    evaluator.update(drawing, options, plant.settings().seed, run)?;
    let none = || MakeError::NoStrokes { name: drawing.name.clone(), strokes: drawing.strokes.len() };
    let front = evaluator.front().ok_or_else(none)?;
    let (reading, ..) = evaluator.take().ok_or_else(none)?;
    Ok((reading, front))
}

/// A drawing of several plants.
struct Whole<'a> {
    plant: &'a DocumentPlant,
    /// Options for a plant of one metre in height.
    options: SketchOptions,
    reading: &'a Reading,
    front: FrontView,
}

impl Whole<'_> {
    /// Makes the plant of one part of the reading.
    fn part(&self, part: usize, run: &Run<'_>) -> Result<NewPlant, SplitError> {
        let strokes = self.strokes(part);
        let mut settings = self.plant.settings().clone();
        settings.name = format!("{} {}", settings.name, part + 1);
        let drawing = Drawing {
            name: settings.name.clone(),
            strokes: strokes.iter().map(|s| s.stroke.clone()).collect(),
            layers: Vec::new(),
        };
        let classes = base::map_of((0..).zip(&strokes).filter_map(|(row, s)| Some((row, s.class?))));
        let (_, front) =
            looked_at(&drawing, &SketchOptions { classes, ..self.options.clone() }, self.plant, run)?;
        // Size of one metre of it in the whole.
        let height = self.front.metres_per_unit / front.metres_per_unit;
        let at = (front.origin - self.front.origin) * self.front.metres_per_unit;
        let place = &mut settings.placement;
        let (sin, cos) = ops::sin_cos(place.yaw_deg.to_radians());
        place.position += DVec3::new(at.x * cos, at.y, -at.x * sin) * place.scale;
        if let Maker::Sketch(sketch) = &mut settings.maker {
            let heights = spec::range::<SketchSpec>("height_m");
            debug_assert!(heights.is_some(), "the schema says how high a sketch may be");
            sketch.sketch.height_m = Some(heights.map_or(height, |[least, most]| height.clamp(least, most)));
            sketch.sketch.flipped_flowers = self.flipped(part, &sketch.sketch.flipped_flowers);
        }
        Ok(NewPlant { settings, strokes })
    }

    /// Returns the strokes of a part in the order in which they were drawn.
    fn strokes(&self, part: usize) -> Vec<NewStroke> {
        let own = &self.reading.plants[part].strokes;
        (0..)
            .zip(self.plant.strokes())
            .filter(|(row, _)| own.contains(row))
            .map(|(_, s)| NewStroke::from_stroke(s))
            .collect()
    }

    /// Returns the flowers of a part that face away, by their numbers within it.
    fn flipped(&self, part: usize, flipped: &[u32]) -> Vec<u32> {
        let of = |plant: &PlantReading, flower: usize| {
            let strokes = self.reading.flowers[flower].petals.iter().filter_map(|p| p.source);
            strokes.into_iter().any(|s| plant.strokes.contains(&s))
        };
        let plant = &self.reading.plants[part];
        let own = (0..self.reading.flowers.len()).filter(|&f| of(plant, f));
        (0..).zip(own).filter(|(_, f)| flipped.iter().any(|&g| g as usize == *f)).map(|(k, _)| k).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SceneEvaluator;
    use document::{Placement, PlantCommand, SketchCommand};
    use formats::{DrawingFormat, read_drawings};
    use glam::DVec2;
    use mesh::Bounds;

    /// Draws fixtures next to one another, each of the given height, and the line of the ground under them.
    fn row(of: &[(&str, f64)]) -> Drawing {
        let mut all = Drawing { name: "row".into(), ..Drawing::default() };
        let mut x = 0.0;
        for (name, height) in of {
            let path = format!("{}/../../fixtures/sketches/{name}.svg", env!("CARGO_MANIFEST_DIR"));
            let file = std::io::BufReader::new(std::fs::File::open(path).unwrap());
            let mut read = read_drawings(file, DrawingFormat::Svg, name).next().unwrap().unwrap().drawing;
            let points = || read.strokes.iter().flat_map(|s| s.samples.iter().map(|p| p.at));
            let low = points().fold(DVec2::INFINITY, DVec2::min);
            let high = points().fold(DVec2::NEG_INFINITY, DVec2::max);
            let scale = height / (high.y - low.y);
            for sample in read.strokes.iter_mut().flat_map(|s| &mut s.samples) {
                sample.at = (sample.at - low) * scale + DVec2::new(x, 0.0);
            }
            x += (high.x - low.x) * scale + 120.0;
            all.strokes.append(&mut read.strokes);
        }
        let ground: Vec<DVec2> =
            (0..=40).map(|k| DVec2::new(f64::from(k) / 40.0 * x, -3.0 + 2.0 * f64::from(k % 3))).collect();
        all.strokes.append(&mut Drawing::from_polylines("ground", &[ground]).strokes);
        all
    }

    /// Returns the box around plants of a scene that are only moved.
    fn bounds(document: &Document, plants: &[PlantId]) -> Bounds {
        let mut scene = SceneEvaluator::default();
        let mut all = Bounds::EMPTY;
        for &id in plants {
            scene.update(id, document, &Run::plain()).unwrap();
            let Placement { position, yaw_deg, scale } = document.plant(id).unwrap().settings().placement;
            assert_eq!((yaw_deg, scale), (0.0, 1.0));
            let own = scene.get(id).unwrap().model.bounds();
            all.include(own.min + position);
            all.include(own.max + position);
        }
        all
    }

    #[test]
    fn each_plant_stands_where_it_stood_and_is_as_tall() {
        for of in [
            &[("gallery/tulip", 400.0), ("gallery/lily", 300.0)][..],
            &[("gallery/poplar", 700.0), ("table1/a", 200.0), ("gallery/oak", 500.0)],
        ] {
            let document = Document::from_drawing(&row(of));
            let whole = document.plants()[0].id();
            let mut editor = Editor::new(document.clone());
            split(&mut editor, whole, &Run::plain()).unwrap();
            let after = editor.document();
            let ids: Vec<PlantId> = after.plants().iter().map(DocumentPlant::id).collect();
            assert_eq!(ids.len(), of.len());
            let strokes = |d: &Document| d.plants().iter().map(|p| p.strokes().len()).sum::<usize>();
            assert_eq!(strokes(after) + 1, strokes(&document), "all but the ground");
            let (before, now) = (bounds(&document, &[whole]), bounds(after, &ids));
            let near = 0.05 * (before.max.y - before.min.y);
            let [low, high] = [now.min - before.min, now.max - before.max].map(|d| d.truncate().abs());
            assert!(low.max(high).max_element() < near, "{before:?} was, {now:?} is");
            let place = |id: &PlantId| after.plant(*id).unwrap().settings().placement.position.x;
            assert!(ids.is_sorted_by(|a, b| place(a) < place(b)), "from left to right");
            assert_eq!(editor.undo(), Some("split-plant"));
            assert_eq!(editor.document().plants(), document.plants());
        }
    }

    #[test]
    fn what_cannot_be_split_stays_as_it_is() {
        let mut drawing = row(&[("gallery/tulip", 400.0)]);
        drawing.strokes.pop();
        let one = Document::from_drawing(&drawing);
        let id = one.plants()[0].id();
        let mut editor = Editor::new(one);
        let why = split(&mut editor, id, &Run::plain());
        assert!(matches!(why, Err(SplitError::OnePlant { name }) if name == "row"));
        editor.run(SketchCommand::Clear.for_plant(id)).unwrap();
        assert!(matches!(split(&mut editor, id, &Run::plain()), Err(SplitError::Make(_))));
        editor.run(SceneCommand::Remove(vec![id])).unwrap();
        assert!(matches!(split(&mut editor, id, &Run::plain()), Err(SplitError::NoDrawing)));

        let two = Document::from_drawing(&row(&[("gallery/tulip", 400.0), ("gallery/lily", 300.0)]));
        let mut editor = Editor::new(two);
        let turn = shape::Turn { about: DVec3::Z, degrees: 25.0 };
        let edit = shape::HandEdit::Rotate { axis: shape::AxisKey::Path(vec![0]), turn };
        let id = editor.document().plants()[0].id();
        editor.run(document::ShapeCommand::Add(edit.into()).for_plant(id)).unwrap();
        assert!(matches!(split(&mut editor, id, &Run::plain()), Err(SplitError::Edited { .. })));
        assert_eq!(editor.document().plants().len(), 1);
    }

    #[test]
    fn a_turned_and_larger_plant_is_split_where_it_stands() {
        let document = Document::from_drawing(&row(&[("gallery/tulip", 400.0), ("gallery/lily", 300.0)]));
        let id = document.plants()[0].id();
        let mut plain = Editor::new(document);
        let mut turned = plain.clone();
        let position = DVec3::new(1.0, 0.0, 2.0);
        let placement = Placement { position, yaw_deg: 90.0, scale: 2.0 };
        turned.run(PlantCommand::Place(placement).for_plant(id)).unwrap();
        for editor in [&mut plain, &mut turned] {
            split(editor, id, &Run::plain()).unwrap();
        }
        for (p, q) in plain.document().plants().iter().zip(turned.document().plants()) {
            let (p, q) = (p.settings().placement.position, q.settings().placement.position);
            // A quarter turn about +Y takes +X to -Z.
            assert!((q - (position + 2.0 * DVec3::new(0.0, p.y, -p.x))).length() < 1e-9);
        }
    }
}
