//! Drawings of several plants: each is read by itself, and put back where it was drawn.

use glam::DVec2;
use ink::{Classified, Ink, InkMap, Source, StrokeClass};

use crate::{Attachment, BladeReading, OrganWord, Reading, StrokeReading};

/// Reads every plant of a drawing, from left to right.
pub(crate) fn read_each(
    ink: &Ink,
    classes: &[Classified],
    mut one: impl FnMut(&Ink, &[Classified]) -> Reading,
) -> Reading {
    let mut all = Reading::default();
    let class = |row: usize| classes.get(row).copied().unwrap_or_default();
    // What the user says is no ground belongs to the plant that it was drawn with.
    let (ground, other): (Vec<usize>, Vec<usize>) =
        ink.subjects.ground.iter().partition(|&&row| class(row).class == StrokeClass::Ground);
    for (k, rows) in ink.subjects.plants.iter().enumerate() {
        let mut rows = rows.clone();
        if k == 0 {
            rows.extend(&other);
            rows.sort_unstable();
        }
        let part = ink.part(&rows);
        let own: Vec<Classified> = rows.iter().map(|&row| class(row)).collect();
        let reading = one(&part, &own);
        let back = Back { whole: ink.map, part: part.map };
        back.add(&mut all, reading);
    }
    for row in ground {
        let Some(s) = ink.strokes.get(row) else { continue };
        let said = class(row);
        all.strokes.push(StrokeReading {
            index: s.index,
            class: said.class,
            organ: OrganWord::Ignored,
            confidence: said.confidence,
            source: said.source,
        });
    }
    all.strokes.extend(ink.skipped.iter().map(|&index| StrokeReading {
        index,
        class: StrokeClass::Other,
        organ: OrganWord::Ignored,
        confidence: 0.0,
        source: Source::Classifier,
    }));
    base::sort_by_key(&mut all.strokes, |s| s.index);
    all
}

/// From the ink of one plant to that of the whole drawing.
struct Back {
    whole: InkMap,
    part: InkMap,
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
        blade.veins.iter_mut().for_each(|v| self.line(v));
        (blade.root, blade.tip) = (self.point(blade.root), self.point(blade.tip));
        self.bearer(&mut blade.bearer, first);
    }

    /// Adds one plant's reading to that of all.
    fn add(&self, all: &mut Reading, mut one: Reading) {
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
        all.thorns.append(&mut one.thorns);
        all.plants.append(&mut one.plants);
        all.woody |= one.woody;
    }
}
