//! The order in which a drawing is understood: `Ink + classes -> Reading`.

use base::Report;
use ink::{Classified, Ink, Source};

use crate::draft::Draft;
use crate::{Reading, attach, flowers, outlines, rules, several, veins};

/// Understands a drawing.
///
/// `classes`: one for each ink stroke, in their order; strokes without one count as `other`. Guaranteed:
/// [`Reading::validate`] finds no fault, whatever the strokes and classes; every stroke of the drawing has its
/// row in `strokes`; a drawing with a usable stroke gives at least one axis, organ or region (with a warning
/// where that is a guess). Cost: about linear in strokes.
///
/// ```
/// use glam::DVec2;
/// use ink::{Classified, Drawing, StrokeClass};
/// let mut report = base::Report::default();
/// let drawing = Drawing::from_polylines("stem", &[vec![DVec2::Y, DVec2::ZERO]]);
/// let ink = ink::clean(&drawing, &mut report);
/// let stem = Classified::by_user(StrokeClass::Axis);
/// let reading = reading::read(&ink, &[stem], &mut report);
/// assert_eq!(reading.axes[0].points[0], DVec2::ZERO);
/// assert_eq!(reading.validate().count(), 0);
/// ```
pub fn read(ink: &Ink, classes: &[Classified], report: &mut Report) -> Reading {
    read_without(&[], ink, classes, report)
}

/// As [`read`], with some [rules](crate::RULES) switched off by their names: for measuring what each is worth.
pub fn read_without(off: &[&str], ink: &Ink, classes: &[Classified], report: &mut Report) -> Reading {
    if ink.is_several() {
        several::read_each(off, ink, classes, report)
    } else {
        one(off, ink, classes, report)
    }
}

/// Understands one plant.
pub(crate) fn one(off: &[&str], ink: &Ink, classes: &[Classified], report: &mut Report) -> Reading {
    let mut draft = Draft::new(ink, classes);
    for (k, said) in draft.said.iter_mut().enumerate() {
        if matches!(said.source, Source::Rule(name) if off.contains(&name)) {
            *said = Classified::by_shares(said.shares);
            draft.class[k] = said.class;
        }
    }
    rules::apply(&mut draft, off);
    draft.contours();
    draft.find_soil();
    outlines::trunk_sides(&mut draft);
    outlines::bodies(&mut draft);
    outlines::crowns(&mut draft, report);
    draft.blades();
    let discs = flowers::discs(&draft);
    flowers::corollas(&mut draft, &discs);
    outlines::scribbled_trunk(&mut draft);
    draft.scribbled_crowns(report);
    let veins = veins::collect(&mut draft);
    draft.trim_at_pots();
    draft.last_resort(&discs, report);
    let thorns = outlines::thorns(&mut draft);
    attach::fronds(&mut draft);
    attach::grass_blades(&mut draft);
    let (discs, nuts) = attach::part_discs(&draft, discs);
    let bearers = flowers::Bearers::new(&draft);
    let (mut flowers, roots) = flowers::gather(&mut draft, &discs, &bearers);
    attach::stamens(&mut draft, &mut flowers, &roots);
    let mut fruits = draft.fruits(&nuts);
    let hints = draft.hints(&flowers.iter().map(|f| f.centre).collect::<Vec<_>>());
    let lines = std::mem::take(&mut draft.lines);
    draft.forest.grow(lines, &hints);
    attach::roots(&mut draft);
    let region_bearers = outlines::bear_regions(&mut draft);
    let (flowers, leaves) = attach::organs(&mut draft, flowers, &roots, veins, &hints.soil);
    attach::fruits(&mut draft, &mut fruits);
    draft.finish(region_bearers, flowers, leaves, fruits, thorns)
}
