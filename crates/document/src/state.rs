//! The document: strokes with their corrections, and settings.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use base::Seed;
use glam::DVec2;
use sketch::{Drawing, SketchSpec, Stroke, StrokeClass};
use skin::SkinSpec;

use crate::Photo;

/// Names one stroke for as long as the document lives, whatever is drawn or erased around it. Never reused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct StrokeId(pub u32);

/// One stroke of the document.
#[derive(Clone, Debug, PartialEq)]
pub struct DocumentStroke {
    /// Its name.
    pub id: StrokeId,
    /// What the pen left; finite points, shared with the undo history.
    pub stroke: Arc<Stroke>,
    /// The class that the person set; `None` leaves it to the classifier.
    pub class: Option<StrokeClass>,
}

/// Everything but the strokes.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Name of the plant, for files and reports. At most 200 characters.
    pub name: String,
    /// What all chance follows from. Default 1.
    pub seed: Seed,
    /// How the drawing is understood and given depth.
    pub sketch: SketchSpec,
    /// How the plant is meshed and coloured. Its `seed` is not saved: it always follows [`Settings::seed`].
    pub skin: SkinSpec,
    /// What lies under the drawing.
    pub photo: Option<Photo>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            name: "plant".into(),
            seed: Seed::default(),
            sketch: SketchSpec::default(),
            skin: SkinSpec::default(),
            photo: None,
        }
    }
}

/// What a person made: strokes in the order in which they were drawn, and settings.
///
/// ```
/// use document::{Command, Editor, NewStroke};
/// use glam::DVec2;
/// let mut editor = Editor::default();
/// editor.run(Command::AddStrokes(vec![NewStroke::line(&[DVec2::ZERO, DVec2::Y])]))?;
/// assert_eq!(editor.document().drawing().strokes.len(), 1);
/// # Ok::<(), document::CommandError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Document {
    pub(crate) strokes: Vec<DocumentStroke>,
    pub(crate) settings: Settings,
    /// The number of the next stroke: above every id ever given in this document.
    pub(crate) next_id: u32,
}

/// Something that is wrong with a document.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum DocumentFault {
    /// Two strokes have one name.
    #[error("two strokes have the number {}", .0.0)]
    SameId(StrokeId),
    /// A stroke's number was not given by this document yet.
    #[error("stroke {} has a number that is not given yet", .0.0)]
    FutureId(StrokeId),
    /// A point is NaN or infinite, or there is no point.
    #[error("stroke {} has no point or one that is not finite", .0.0)]
    NotFinite(StrokeId),
    /// The name is too long.
    #[error("the name is longer than {NAME_LENGTH} characters")]
    Name,
    /// A setting is out of its range.
    #[error("{0}")]
    Setting(String),
}

/// Longest name of a plant, in characters.
pub(crate) const NAME_LENGTH: usize = 200;

impl Document {
    /// A document of a drawing as it was read: points that are not finite are left out, strokes without a point too.
    pub fn from_drawing(drawing: &Drawing) -> Self {
        let mut document = Self::default();
        document.settings.name = shortened(&drawing.name);
        for stroke in &drawing.strokes {
            if let Some(stroke) = sound(stroke.clone()) {
                let id = document.give_id();
                document.strokes.push(DocumentStroke { id, stroke: Arc::new(stroke), class: None });
            }
        }
        document
    }

    /// The strokes in the order in which they were drawn.
    pub fn strokes(&self) -> &[DocumentStroke] {
        &self.strokes
    }

    /// Everything but the strokes.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// The strokes as the sketch maker takes them; row `i` is `strokes()[i]`. Cost: a copy of every point.
    pub fn drawing(&self) -> Drawing {
        let strokes = self.strokes.iter().map(|s| Stroke::clone(&s.stroke)).collect();
        Drawing { name: self.settings.name.clone(), strokes }
    }

    /// Classes that the person set, by row of [`Document::drawing`].
    pub fn classes(&self) -> BTreeMap<u32, StrokeClass> {
        (0..).zip(&self.strokes).filter_map(|(row, s)| Some((row, s.class?))).collect()
    }

    /// The row of a stroke.
    pub fn row(&self, id: StrokeId) -> Option<usize> {
        self.strokes.iter().position(|s| s.id == id)
    }

    /// A smaller document that looks the same: points on a grid of at most 1/10,000 of the drawing's diagonal, without
    /// their times; without the photograph. For links, not for files.
    pub fn compact(&self) -> Self {
        let mut document = self.clone();
        document.settings.photo = None;
        let points = || self.strokes.iter().flat_map(|s| s.stroke.samples.iter().map(|p| p.at));
        let (low, high) = points().fold((DVec2::MAX, DVec2::MIN), |(a, b), p| (a.min(p), b.max(p)));
        let size = (high - low).length();
        // A power of ten has few digits as text.
        let mut step = 1.0;
        while size > 0.0 && size.is_finite() && step * 10_000.0 > size && step > 1e-12 {
            step *= 0.1;
        }
        let per_step = (1.0 / step).round();
        let on_grid = |x: f64| (x * per_step).round() / per_step;
        for s in &mut document.strokes {
            let mut stroke = Stroke::clone(&s.stroke);
            for p in &mut stroke.samples {
                p.at = DVec2::new(on_grid(p.at.x), on_grid(p.at.y));
                p.time_ms = None;
                p.pressure = p.pressure.map(|x| (x * 100.0).round() / 100.0);
            }
            stroke.samples.dedup_by(|b, a| a.at == b.at);
            s.stroke = Arc::new(stroke);
        }
        document
    }

    pub(crate) fn give_id(&mut self) -> StrokeId {
        let id = StrokeId(self.next_id);
        self.next_id = self.next_id.saturating_add(1);
        id
    }

    /// Everything that is wrong; nothing, after any sequence of commands. Cost: linear in points.
    pub fn validate(&self) -> impl Iterator<Item = DocumentFault> + '_ {
        let mut seen = BTreeSet::new();
        let strokes = self.strokes.iter().flat_map(move |s| {
            let same = (!seen.insert(s.id)).then_some(DocumentFault::SameId(s.id));
            let future = (s.id.0 >= self.next_id).then_some(DocumentFault::FutureId(s.id));
            let finite = !s.stroke.samples.is_empty() && s.stroke.samples.iter().all(|p| p.at.is_finite());
            let odd = (!finite).then_some(DocumentFault::NotFinite(s.id));
            [same, future, odd].into_iter().flatten()
        });
        let name = (self.settings.name.chars().count() > NAME_LENGTH).then_some(DocumentFault::Name);
        let setting = range_fault(&self.settings).map(DocumentFault::Setting);
        strokes.chain(name).chain(setting)
    }
}

/// A name cut to its greatest length, without line breaks.
pub(crate) fn shortened(name: &str) -> String {
    name.chars().map(|c| if c.is_control() { ' ' } else { c }).take(NAME_LENGTH).collect()
}

/// The stroke with finite points only; `None` if there is none. Unknown times and pressures stay unknown.
pub(crate) fn sound(mut stroke: Stroke) -> Option<Stroke> {
    stroke.samples.retain(|p| p.at.is_finite());
    for p in &mut stroke.samples {
        p.time_ms = p.time_ms.filter(|t| t.is_finite());
        p.pressure = p.pressure.filter(|t| t.is_finite());
    }
    (!stroke.samples.is_empty()).then_some(stroke)
}

/// The first setting that is out of its range, as a sentence with what to do; `None` if all are sound.
pub fn range_fault(settings: &Settings) -> Option<String> {
    let Settings { sketch, skin, .. } = settings;
    if let Some(fault) = sketch.validate().next() {
        return Some(fault.to_string());
    }
    let rows = [
        ("detail", skin.detail, 0.1, 8.0),
        ("sides", f64::from(skin.sides), 3.0, 24.0),
        ("variation", skin.variation, 0.0, 1.0),
    ];
    if let Some(fault) = settings.photo.as_ref().and_then(Photo::fault) {
        return Some(fault);
    }
    let odd = rows.into_iter().find(|&(_, value, low, high)| !(low..=high).contains(&value));
    odd.map(|(name, value, low, high)| format!("{name} is {value}, but must be from {low} to {high}"))
}
