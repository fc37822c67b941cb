//! How well a reading explains a drawing.

use base::LiteMap;
use ink::{Ink, StrokeClass};

use super::LIMITS;
use super::sheet::Sheet;
use crate::{OrganWord, Reading};

/// Worth of a stroke that lies in a solid (a fruit, a trunk, a pot) without being its texture: the solid was made over
/// it.
const UNDER_A_SOLID: f64 = 0.3;
/// Worth of a stroke whose organ hangs on nothing, if there is something to hang on.
const FLOATS: f64 = 0.5;
/// Worth of a line that is one side of an axis and became an axis of its own.
const ONE_SIDE: f64 = 0.5;
/// Share of the score that is lost if similar outlines became organs of several kinds.
const UNLIKE: f64 = 0.4;

/// Returns how well a reading explains the ink: 0 (nothing) to 1 (every stroke is a part of its own that is attached,
/// and similar outlines are of one kind). Kinds of plants play no part. `sides`: rows of lines that are two sides of
/// one axis each, and were read as axes of their own. Cost: pairs of outlines.
pub(crate) fn score(ink: &Ink, sheet: &Sheet, reading: &Reading, sides: &[usize]) -> f64 {
    let organs = Organs::new(ink, reading);
    let (mut sum, mut whole) = (0.0, 0.0);
    for (k, stroke) in ink.strokes.iter().enumerate() {
        whole += stroke.length;
        let share = if sides.contains(&k) { ONE_SIDE } else { 1.0 };
        sum += stroke.length * share * organs.worth(sheet, k);
    }
    let explained = if whole > 0.0 { sum / whole } else { 0.0 };
    explained * (1.0 - UNLIKE * organs.disagreement(sheet))
}

/// The organ of each stroke, by rows.
struct Organs {
    organ: Vec<(StrokeClass, OrganWord)>,
    floats: Vec<bool>,
}

impl Organs {
    fn new(ink: &Ink, reading: &Reading) -> Self {
        let rows: LiteMap<u32, usize> = ink.strokes.iter().enumerate().map(|(k, s)| (s.index, k)).collect();
        let mut organ = vec![(StrokeClass::Other, OrganWord::Ignored); ink.strokes.len()];
        for stroke in &reading.strokes {
            if let Some(&row) = rows.get(&stroke.index) {
                organ[row] = (stroke.class, stroke.organ);
            }
        }
        let mut floats = vec![false; ink.strokes.len()];
        if !reading.axes.is_empty() {
            let leaves = reading.leaves.iter().filter(|l| l.bearer.is_none()).filter_map(|l| l.source);
            let flowers = reading.flowers.iter().filter(|f| f.bearer.is_none());
            let petals = flowers.flat_map(|f| &f.petals).filter_map(|p| p.source);
            let fruits = reading.fruits.iter().filter(|f| f.bearer.is_none()).filter_map(|f| f.source);
            for row in leaves.chain(petals).chain(fruits).filter_map(|source| rows.get(&source)) {
                floats[*row] = true;
            }
        }
        Self { organ, floats }
    }

    fn worth(&self, sheet: &Sheet, k: usize) -> f64 {
        let (class, organ) = self.organ[k];
        let holder = sheet.facts[k].holder.map(|j| self.organ[j].1);
        let solid = matches!(holder, Some(OrganWord::Fruit | OrganWord::Trunk | OrganWord::Pot));
        let texture = matches!(class, StrokeClass::Scribble | StrokeClass::Vein);
        match (solid, organ) {
            (true, _) if texture => 1.0,
            (true, _) => UNDER_A_SOLID,
            // Texture of a blade is recognised, though it is left out.
            (false, OrganWord::Ignored) if holder.is_some() && texture => 1.0,
            (false, OrganWord::Ignored) if class == StrokeClass::Ground => 1.0,
            (false, OrganWord::Ignored) => 0.0,
            (false, _) if self.floats[k] => FLOATS,
            (false, _) => 1.0,
        }
    }

    /// Returns the share of repeated outlines that became another kind of organ than most of those that are like them,
    /// 0 to 1.
    fn disagreement(&self, sheet: &Sheet) -> f64 {
        let (mut repeated, mut differ) = (0_usize, 0_usize);
        for k in 0..self.organ.len() {
            let alike = sheet.alike(k);
            if alike.len() < LIMITS.repeated {
                continue;
            }
            repeated += 1;
            let same = alike.iter().filter(|&&j| kind(self.organ[j].1) == kind(self.organ[k].1)).count();
            differ += usize::from(2 * same < alike.len());
        }
        if repeated > 0 { differ as f64 / repeated as f64 } else { 0.0 }
    }
}

/// Returns the kind of an organ: petals and leaves are both blades.
fn kind(organ: OrganWord) -> OrganWord {
    if organ == OrganWord::Petal { OrganWord::Leaf } else { organ }
}
