//! From the parts that a reader proposes to ink of their own, and from what was read of that back to the drawing.

use base::LiteMap;
use ink::{Classified, Ink, Source, StrokeClass};

use super::classes::{Hidden, Structure};
use super::readers::{ARRANGEMENT, Proposal};
use crate::several::Back;
use crate::{OrganWord, Reading, StrokeReading};

/// The parts of a proposal as strokes of their own.
pub(crate) struct Composed {
    pub(crate) ink: Ink,
    pub(crate) classes: Vec<Classified>,
    pub(crate) structure: Structure,
}

impl Composed {
    /// `score`: how sure the proposal is, 0 to 1.
    pub(crate) fn new(ink: &Ink, proposal: &Proposal, score: f64) -> Self {
        let main = |strokes: &[usize]| strokes.first().copied().unwrap_or(0);
        let lines: Vec<_> = proposal.parts.iter().map(|p| (p.points.clone(), main(&p.strokes))).collect();
        let own = ink.with_lines(&lines);
        let to_own = |p| own.map.to_ink(ink.map.to_drawing(p));
        let mut hidden = LiteMap::new();
        for (row, part) in proposal.parts.iter().enumerate() {
            if part.class == StrokeClass::Blade {
                let outline = part.points.iter().map(|&p| to_own(p)).collect();
                hidden.insert(row, Hidden { outline, root: part.root.map(to_own) });
            }
        }
        let classes: Vec<StrokeClass> = proposal.parts.iter().map(|p| p.class).collect();
        let said = |&class: &StrokeClass| {
            let shares = StrokeClass::ALL.map(|c| if c == class { score } else { 0.0 });
            let source = Source::Rule(ARRANGEMENT);
            Classified { class, confidence: score, source, shares, shown: None }
        };
        Self {
            classes: classes.iter().map(said).collect(),
            structure: Structure::of_parts(classes, hidden, proposal.heads.clone()),
            ink: own,
        }
    }

    /// What was read of the parts, as a reading of the drawing: in its coordinates, with its strokes.
    pub(crate) fn back(&self, ink: &Ink, proposal: &Proposal, parts: Reading) -> Reading {
        let mut reading = Reading::default();
        Back { whole: ink.map, part: self.ink.map }.add(&mut reading, parts);
        let row = |part: u32| proposal.parts.get(part as usize)?.strokes.first().copied();
        let index = |source: &mut Option<u32>| {
            *source = source.and_then(row).and_then(|k| ink.strokes.get(k)).map(|s| s.index);
        };
        let blades = reading.flowers.iter_mut().flat_map(|f| &mut f.petals).chain(&mut reading.leaves);
        for blade in blades {
            index(&mut blade.source);
            blade.veins.iter_mut().for_each(|v| index(&mut v.source));
        }
        reading.axes.iter_mut().for_each(|a| index(&mut a.source));
        reading.flowers.iter_mut().filter_map(|f| f.disc.as_mut()).for_each(|d| index(&mut d.source));
        reading.regions.iter_mut().for_each(|r| index(&mut r.source));
        reading.fruits.iter_mut().for_each(|f| index(&mut f.source));
        reading.pots.iter_mut().for_each(|p| index(&mut p.source));
        reading.thorns.iter_mut().for_each(|t| index(&mut t.2));
        reading.strokes = strokes(ink, proposal, &reading.strokes);
        reading
    }
}

/// What became of each stroke of the drawing: what became of the first part that is made of it, those of which it is most first.
fn strokes(ink: &Ink, proposal: &Proposal, parts: &[StrokeReading]) -> Vec<StrokeReading> {
    let part_of = |row: usize| {
        let place = |part: usize| proposal.parts[part].strokes.iter().position(|&k| k == row);
        let made = (0..proposal.parts.len()).filter_map(|part| Some((place(part)?, part)));
        made.min().map(|(_, part)| part)
    };
    let read = |row: usize, index: u32| {
        let said = part_of(row).and_then(|part| parts.iter().find(|s| s.index as usize == part));
        let left_out = StrokeReading {
            index,
            class: StrokeClass::Other,
            organ: OrganWord::Ignored,
            confidence: 0.0,
            source: Source::Classifier,
        };
        said.map_or(left_out, |said| StrokeReading { index, ..*said })
    };
    let mut rows: Vec<StrokeReading> =
        ink.strokes.iter().enumerate().map(|(row, s)| read(row, s.index)).collect();
    rows.extend(ink.skipped.iter().map(|&index| read(usize::MAX, index)));
    base::sort_by_key(&mut rows, |s| s.index);
    rows
}
