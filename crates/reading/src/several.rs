//! Drawings of several plants: each is read separately, and put back where it was drawn.

use base::Report;
use glam::DVec2;
use ink::{Classified, DRAWN_AGAIN, Ink, InkMap, Source, StrokeClass};

use crate::{Attachment, BladeReading, OrganWord, Reading, StrokeReading, aside};

/// One piece of a drawing, as if it were the whole.
pub(crate) struct Part {
    /// Rows of its strokes in the whole drawing.
    pub(crate) rows: Vec<usize>,
    pub(crate) ink: Ink,
    pub(crate) classes: Vec<Classified>,
}

/// Returns some strokes of a drawing as a part.
pub(crate) fn part(ink: &Ink, classes: &[Classified], rows: Vec<usize>) -> Part {
    let own = rows.iter().map(|&row| classes.get(row).copied().unwrap_or_default()).collect();
    Part { ink: ink.part(&rows), classes: own, rows }
}

/// Returns the pieces of a drawing, from left to right; strokes that the user marks as something other than ground
/// belong to the first.
pub(crate) fn parts(ink: &Ink, classes: &[Classified]) -> Vec<Part> {
    let is_ground = |row: usize| classes.get(row).is_some_and(|c| c.class == StrokeClass::Ground);
    let other = ink.subjects.ground.iter().copied().filter(|&row| !is_ground(row));
    let mut other: Vec<usize> = other.collect();
    let own = ink.subjects.plants.iter().map(|rows| {
        let mut rows = rows.clone();
        rows.extend(
            again(ink, classes, true)
                .filter(|a| rows.binary_search(&a.1).is_ok())
                .map(|a| a.0)
                .collect::<Vec<_>>(),
        );
        rows.append(&mut other);
        rows.sort_unstable();
        part(ink, classes, rows)
    });
    own.collect()
}

/// Finds lines that were drawn again: those whose class the user gave, which are read, or the others.
fn again(ink: &Ink, classes: &[Classified], named: bool) -> impl Iterator<Item = (usize, usize)> {
    let by_user = |row: usize| classes.get(row).is_some_and(|c| c.source == Source::User);
    ink.subjects.again.iter().copied().filter(move |a| by_user(a.0) == named)
}

/// Collects the readings of a drawing's pieces.
pub(crate) struct Collected<'a> {
    ink: &'a Ink,
    classes: &'a [Classified],
    all: Reading,
    left: Vec<usize>,
}

impl<'a> Collected<'a> {
    pub(crate) fn new(ink: &'a Ink, classes: &'a [Classified]) -> Self {
        Self { ink, classes, all: Reading::default(), left: Vec::new() }
    }

    pub(crate) fn add(&mut self, part: &Part, reading: Reading) {
        let back = Back { whole: self.ink.map, part: part.ink.map };
        back.add(&mut self.all, reading);
    }

    /// Marks strokes that belong to no plant.
    pub(crate) fn leave(&mut self, rows: &[usize]) {
        self.left.extend(rows);
    }

    /// Returns the whole reading, with the ground and with the strokes left out.
    pub(crate) fn finish(mut self, report: &mut Report) -> Reading {
        let (ink, all) = (self.ink, &mut self.all);
        if !self.left.is_empty() {
            all.strokes.extend(aside::tell(ink, self.classes, &self.left, report));
        }
        let class = |row: usize| self.classes.get(row).copied().unwrap_or_default();
        let ground = ink.subjects.ground.iter().filter(|&&row| class(row).class == StrokeClass::Ground);
        let ground = ground.filter_map(|&row| {
            let said = class(row);
            Some(StrokeReading {
                index: ink.strokes.get(row)?.index,
                class: said.class,
                organ: OrganWord::Ignored,
                confidence: said.confidence,
                source: said.source,
            })
        });
        all.strokes.extend(ground);
        for (row, first) in again(ink, self.classes, false) {
            let (Some(own), Some(first)) = (ink.strokes.get(row), ink.strokes.get(first)) else { continue };
            let Some(said) = all.strokes.iter().find(|s| s.index == first.index).copied() else { continue };
            all.strokes.push(StrokeReading { index: own.index, source: Source::Rule(DRAWN_AGAIN), ..said });
            if let Some(plant) = all.plants.iter_mut().find(|p| p.strokes.binary_search(&first.index).is_ok())
                && let Err(at) = plant.strokes.binary_search(&own.index)
            {
                plant.strokes.insert(at, own.index);
            }
        }
        all.strokes.extend(ink.skipped.iter().copied().map(StrokeReading::left_out));
        base::sort_by_key(&mut all.strokes, |s| s.index);
        self.all
    }
}

/// Maps the ink of one plant back to that of the whole drawing.
pub(crate) struct Back {
    pub(crate) whole: InkMap,
    pub(crate) part: InkMap,
}

impl Back {
    fn point(&self, p: DVec2) -> DVec2 {
        self.whole.to_ink(self.part.to_drawing(p))
    }

    fn scale(&self) -> f64 {
        self.whole.scale / self.part.scale
    }

    fn line(&self, points: &mut [DVec2]) {
        points.iter_mut().for_each(|p| *p = self.point(*p));
    }

    fn bearer(&self, bearer: &mut Option<Attachment>, first: usize) {
        if let Some(b) = bearer {
            *b = Attachment { axis: b.axis + first, at: b.at * self.scale() };
        }
    }

    fn blade(&self, blade: &mut BladeReading, first: usize) {
        self.line(&mut blade.outline);
        self.line(&mut blade.midrib);
        blade.veins.iter_mut().for_each(|v| self.line(&mut v.points));
        (blade.root, blade.tip) = (self.point(blade.root), self.point(blade.tip));
        self.bearer(&mut blade.bearer, first);
    }

    /// Adds one plant's reading to the whole one.
    pub(crate) fn add(&self, all: &mut Reading, mut one: Reading) {
        let first = all.axes.len();
        for axis in &mut one.axes {
            self.line(&mut axis.points);
            axis.half_width.iter_mut().for_each(|w| *w *= self.scale());
            self.bearer(&mut axis.bearer, first);
        }
        for flower in &mut one.flowers {
            flower.centre = self.point(flower.centre);
            flower.petals.iter_mut().for_each(|p| self.blade(p, first));
            flower.stamens.iter_mut().for_each(|s| self.line(s));
            if let Some(disc) = &mut flower.disc {
                (disc.centre, disc.radius) = (self.point(disc.centre), disc.radius * self.scale());
            }
            self.bearer(&mut flower.bearer, first);
        }
        one.leaves.iter_mut().for_each(|l| self.blade(l, first));
        for region in &mut one.regions {
            self.line(&mut region.outline);
            region.bearers.iter_mut().for_each(|b| *b += first);
        }
        for fruit in &mut one.fruits {
            self.line(&mut fruit.outline);
            self.bearer(&mut fruit.bearer, first);
        }
        one.pots.iter_mut().flat_map(|p| &mut p.lines).for_each(|l| self.line(l));
        for (points, bearer, _) in &mut one.thorns {
            self.line(points);
            self.bearer(bearer, first);
        }
        one.plants.iter_mut().for_each(|p| p.height *= self.scale());
        all.strokes.append(&mut one.strokes);
        all.axes.append(&mut one.axes);
        all.flowers.append(&mut one.flowers);
        all.leaves.append(&mut one.leaves);
        all.regions.append(&mut one.regions);
        all.fruits.append(&mut one.fruits);
        all.pots.append(&mut one.pots);
        all.thorns.append(&mut one.thorns);
        all.plants.append(&mut one.plants);
        all.woody |= one.woody;
    }
}
