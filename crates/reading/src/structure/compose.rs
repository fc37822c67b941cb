//! Makes ink of the parts that a reader proposes, and maps its reading back to the drawing.

use base::LiteMap;
use glam::DVec2;
use ink::{Classified, Ink, Source, StrokeClass};

use super::chains::Chain;
use super::classes::{Hidden, STRUCTURE, Structure};
use super::readers::{ARRANGEMENT, Proposal};
use super::sheet::Sheet;
use super::tubes::Tube;
use super::vessel::vessel;
use crate::confidence::CONFIDENCE_LIMITS;
use crate::several::Back;
use crate::{Reading, StrokeReading};

/// Several strokes of a drawing as one line.
#[derive(Clone, Debug)]
pub(crate) struct Joined {
    /// Their rows, the one with the largest part first; at least one.
    pub(crate) rows: Vec<usize>,
    pub(crate) line: Vec<DVec2>,
    pub(crate) class: StrokeClass,
}

impl Joined {
    /// Joins both sides of an axis into that axis.
    pub(crate) fn axis(tube: &Tube) -> Self {
        Self { rows: tube.rows(), line: tube.middle.clone(), class: StrokeClass::Axis }
    }

    /// Joins the lines round a blade into its outline.
    pub(crate) fn blade(chain: &Chain) -> Self {
        Self { rows: chain.rows.clone(), line: chain.outline.clone(), class: StrokeClass::Blade }
    }
}

/// Ink that was cut anew from the strokes of a drawing, with its classes.
pub(crate) struct Composed {
    pub(crate) ink: Ink,
    pub(crate) classes: Vec<Classified>,
    pub(crate) structure: Structure,
    /// For each of its strokes the rows of the drawing's strokes that it is made of, the one with the largest part
    /// first.
    made_of: Vec<Vec<usize>>,
}

impl Composed {
    /// Makes the parts of a proposal into strokes of their own.
    pub(crate) fn new(ink: &Ink, proposal: &Proposal) -> Self {
        let made_of: Vec<Vec<usize>> = proposal.parts.iter().map(|p| p.strokes.clone()).collect();
        let own = ink.with_lines(&lines(proposal.parts.iter().map(|p| p.points.clone()), &made_of));
        let to_own = |p| own.map.to_ink(ink.map.to_drawing(p));
        let mut hidden = LiteMap::new();
        for (row, part) in proposal.parts.iter().enumerate() {
            if part.class == StrokeClass::Blade {
                let outline = part.points.iter().map(|&p| to_own(p)).collect();
                hidden.insert(row, Hidden { outline, root: part.root.map(to_own) });
            }
        }
        let classes: Vec<StrokeClass> = proposal.parts.iter().map(|p| p.class).collect();
        let classified = classes
            .iter()
            .map(|&class| said(class, CONFIDENCE_LIMITS.by_arrangement_least, ARRANGEMENT))
            .collect();
        let structure = Structure::from_parts(classes, hidden, proposal.heads.clone());
        Self { ink: own, classes: classified, structure, made_of }
    }

    /// Returns the strokes of a drawing with one line in place of those that were joined; `None` if none were.
    pub(crate) fn with_joined(ink: &Ink, classes: &[Classified], joined: &[Joined]) -> Option<Self> {
        if joined.is_empty() {
            return None;
        }
        let is_joined = |k: &usize| joined.iter().any(|j| j.rows.contains(k));
        let said_of = |k: usize| classes.get(k).copied().unwrap_or_default();
        let kept: Vec<usize> = (0..ink.strokes.len()).filter(|k| !is_joined(k)).collect();
        let mut made_of: Vec<Vec<usize>> = kept.iter().map(|&k| vec![k]).collect();
        made_of.extend(joined.iter().map(|j| j.rows.clone()));
        let points = kept.iter().map(|&k| ink.strokes[k].points.clone());
        let points = points.chain(joined.iter().map(|j| j.line.clone()));
        let own = ink.with_lines(&lines(points, &made_of));
        let mut classified: Vec<Classified> = kept.iter().map(|&k| said_of(k)).collect();
        let by_user = |j: &Joined| Some(said_of(j.rows[0])).filter(|c| c.source == Source::User);
        classified.extend(joined.iter().map(|j| by_user(j).unwrap_or_else(|| said(j.class, 1.0, STRUCTURE))));
        let structure = Structure::new(&Sheet::new(&own), &vessel(&own), &classified);
        Some(Self { ink: own, classes: classified, structure, made_of })
    }

    /// Maps the reading of the parts to a reading of the drawing: in its coordinates, with its strokes.
    pub(crate) fn back(&self, ink: &Ink, parts: Reading) -> Reading {
        let mut reading = Reading::default();
        Back { whole: ink.map, part: self.ink.map }.add(&mut reading, parts);
        let row = |part: u32| self.made_of.get(part as usize)?.first().copied();
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
        reading.strokes = self.strokes(ink, &reading.strokes);
        reading
    }

    /// Returns the organ of each stroke of the drawing: that of the part among whose strokes it comes earliest, the
    /// first of several.
    fn strokes(&self, ink: &Ink, parts: &[StrokeReading]) -> Vec<StrokeReading> {
        let part_of = |row: usize| {
            let place = |part: usize| self.made_of[part].iter().position(|&k| k == row);
            let made = (0..self.made_of.len()).filter_map(|part| Some((place(part)?, part)));
            made.min().map(|(_, part)| part)
        };
        let read = |row: usize, index: u32| {
            let said = part_of(row).and_then(|part| parts.iter().find(|s| s.index as usize == part));
            said.map_or(StrokeReading::left_out(index), |said| StrokeReading { index, ..*said })
        };
        let mut rows: Vec<StrokeReading> =
            ink.strokes.iter().enumerate().map(|(row, s)| read(row, s.index)).collect();
        rows.extend(ink.skipped.iter().copied().map(StrokeReading::left_out));
        base::sort_by_key(&mut rows, |s| s.index);
        rows
    }
}

/// Returns lines, each with the stroke that is its largest part.
fn lines(points: impl Iterator<Item = Vec<DVec2>>, made_of: &[Vec<usize>]) -> Vec<(Vec<DVec2>, usize)> {
    points.zip(made_of).map(|(points, rows)| (points, rows.first().copied().unwrap_or(0))).collect()
}

/// Returns a class that a rule gives to a line.
fn said(class: StrokeClass, score: f64, rule: &'static str) -> Classified {
    let shares = StrokeClass::ALL.map(|c| if c == class { score } else { 0.0 });
    Classified { class, confidence: score, source: Source::Rule(rule), shares, shown: None }
}
