//! The classes of strokes by their structure.

use base::LiteMap;
use glam::DVec2;
use ink::{Classified, Source, StrokeClass};

use super::LIMITS;
use super::hidden::hidden_root;
use super::readers::widest_gap;
use super::sheet::{Facts, Form, Outline, Sheet};

/// The rule that the class of a stroke follows from the things that it encloses, that cover it and that hold it.
pub(crate) const STRUCTURE: &str = "structure";

/// An outline that goes on behind others.
#[derive(Clone, Debug)]
pub(crate) struct Hidden {
    pub(crate) outline: Vec<DVec2>,
    /// Its attachment, in the hidden part.
    pub(crate) root: Option<DVec2>,
}

/// The structure of a drawing.
#[derive(Clone, Debug)]
pub(crate) struct Structure {
    /// The class of each stroke, if the structure gives one.
    classes: Vec<Option<StrokeClass>>,
    /// Completed outlines, by rows.
    hidden: LiteMap<usize, Hidden>,
    /// Petals of one flower, by rows.
    heads: Vec<Vec<usize>>,
    /// Rows of blades with the venation of a leaf.
    leaves: Vec<usize>,
}

impl Structure {
    /// Finds the structure from the facts, with the rows of a pot; `classes`: those of the user or the classifier. The
    /// user's classes stay, and the classifier's if no fact contradicts them.
    pub(crate) fn new(sheet: &Sheet, pot: &[usize], classes: &[Classified]) -> Self {
        let said = |k: usize| classes.get(k).copied().unwrap_or_default();
        let by_user = |k: usize| said(k).source == Source::User;
        let mut together = LiteMap::new();
        let mut found = |k: usize| if by_user(k) { None } else { class_of((sheet, &mut together), k, said) };
        let mut classes: Vec<Option<StrokeClass>> = (0..sheet.facts.len()).map(&mut found).collect();
        // A head makes its blades petals of one flower and its middle a disc; the user's classes may contradict that.
        let agrees = |head: &Vec<usize>| {
            head.iter().enumerate().all(|(place, &k)| {
                let class = if place == 0 { StrokeClass::Disc } else { StrokeClass::Blade };
                !by_user(k) || said(k).class == class
            })
        };
        let heads: Vec<Vec<usize>> = heads(sheet).into_iter().filter(agrees).collect();
        for &k in pot.iter().filter(|&&k| !by_user(k)) {
            classes[k] = Some(StrokeClass::Pot);
        }
        for head in &heads {
            head.iter().for_each(|&k| classes[k] = Some(StrokeClass::Blade));
            classes[head[0]] = Some(StrokeClass::Disc);
        }
        let mut hidden = LiteMap::new();
        for (k, facts) in sheet.facts.iter().enumerate() {
            if facts.form == Form::Bay
                && classes[k].unwrap_or(said(k).class) == StrokeClass::Blade
                && let Some(Outline { points, .. }) = &facts.outline
            {
                hidden.insert(k, Hidden { outline: points.clone(), root: hidden_root(points) });
            }
        }
        let in_head = |k: usize| heads.iter().any(|head| head.contains(&k));
        let leaves = (0..sheet.facts.len()).filter(|&k| sheet.facts[k].is_veined && !in_head(k)).collect();
        Self { classes, hidden, heads, leaves }
    }

    /// Takes over a reader's results for the strokes that it made of the drawing: the class of each, and the
    /// attachment of blades.
    pub(crate) fn from_parts(
        classes: Vec<StrokeClass>,
        hidden: LiteMap<usize, Hidden>,
        heads: Vec<Vec<usize>>,
    ) -> Self {
        Self { classes: classes.into_iter().map(Some).collect(), hidden, heads, leaves: Vec::new() }
    }

    /// Returns the class of each stroke, if the structure gives one.
    pub(crate) fn classes(&self) -> &[Option<StrokeClass>] {
        &self.classes
    }

    /// Returns completed outlines of blades, by rows.
    pub(crate) const fn hidden(&self) -> &LiteMap<usize, Hidden> {
        &self.hidden
    }

    /// Returns rows of blades that are leaves by their venation.
    pub(crate) fn leaves(&self) -> &[usize] {
        &self.leaves
    }

    /// Returns rows of the petals of each flower that is known as a whole.
    pub(crate) fn heads(&self) -> &[Vec<usize>] {
        &self.heads
    }

    /// Whether it differs from the classifier's classes or completes an outline.
    pub(crate) fn differs(&self, classes: &[Classified]) -> bool {
        !self.hidden.is_empty()
            || self.classes.iter().zip(classes).any(|(own, said)| own.is_some_and(|own| own != said.class))
    }
}

/// Finds flower heads: rows of a disc, and of the rays all round it. A disc is an outline that touches many similar
/// outlines; rays of a second row touch those of the first.
fn heads(sheet: &Sheet) -> Vec<Vec<usize>> {
    let outline = |k: usize| sheet.facts[k].outline.as_ref();
    let touches = |a: usize, b: usize| outline(a).zip(outline(b)).is_some_and(|(a, b)| a.touches(b));
    let mut found: Vec<Vec<usize>> = Vec::new();
    for disc in (0..sheet.facts.len()).filter(|&k| sheet.facts[k].form == Form::Ring) {
        let is_free = |k: usize| k != disc && sheet.facts[k].holder != Some(disc) && outline(k).is_some();
        let mut rays: Vec<usize> =
            (0..sheet.facts.len()).filter(|&k| is_free(k) && touches(k, disc)).collect();
        let Some(model) = rays.iter().copied().max_by_key(|&k| alike_among(sheet, k, &rays)) else {
            continue;
        };
        let alike = sheet.alike(model);
        rays.retain(|k| alike.contains(k));
        let Some(centre) = outline(disc).map(|o| geom::centroid(&o.points)) else { continue };
        let ways = rays.iter().filter_map(|&k| outline(k)).map(|o| geom::centroid(&o.points) - centre);
        if rays.len() < LIMITS.rays || widest_gap(ways) > LIMITS.ray_gap {
            continue;
        }
        let second: Vec<usize> = alike
            .iter()
            .copied()
            .filter(|&k| is_free(k) && !rays.contains(&k) && rays.iter().any(|&r| touches(k, r)))
            .collect();
        rays.extend(second);
        let slivers: Vec<usize> =
            (0..sheet.facts.len()).filter(|&k| is_free(k) && is_sliver(sheet, k, &rays)).collect();
        rays.extend(slivers);
        if !found.iter().flatten().any(|k| rays.contains(k) || *k == disc) {
            found.push(core::iter::once(disc).chain(rays).collect());
        }
    }
    found
}

/// Whether an outline is the visible part of a ray behind others: it touches one, is no larger than the largest, and
/// its middle lies among them.
fn is_sliver(sheet: &Sheet, k: usize, rays: &[usize]) -> bool {
    let outline = |k: usize| sheet.facts[k].outline.as_ref();
    let Some(own) = outline(k).filter(|_| !rays.contains(&k)) else { return false };
    let others = || rays.iter().filter_map(|&r| outline(r));
    let largest = others().map(|o| o.area).fold(0.0, f64::max);
    own.area <= largest && others().any(|o| own.touches(o)) && lies_among(own, others())
}

/// Whether the middle of an outline lies within the hull of others.
fn lies_among<'a>(own: &Outline, others: impl Iterator<Item = &'a Outline>) -> bool {
    let points: Vec<DVec2> = others.flat_map(|o| o.points.iter().copied()).collect();
    geom::contains(&geom::convex_hull(&points), geom::centroid(&own.points))
}

/// Counts the outlines among some that are like a given one.
fn alike_among(sheet: &Sheet, k: usize, among: &[usize]) -> usize {
    sheet.alike(k).iter().filter(|j| among.contains(j)).count()
}

/// Returns the class of one stroke, if its structure gives one.
fn class_of(
    (sheet, together): (&Sheet, &mut ClassesOfAlike),
    k: usize,
    said: impl Fn(usize) -> Classified,
) -> Option<StrokeClass> {
    let facts = &sheet.facts[k];
    match (facts.form, facts.holder) {
        (Form::Ring | Form::Bay, _) => class_of_outline((sheet, together), k, said),
        (Form::Line, Some(holder)) => Some(mark_in(&sheet.facts[holder])),
        (Form::Line, None) => class_of_line(said(k)),
    }
}

/// Returns the class of a mark in an outline: one of many is texture, one of few or of a venation is a vein.
fn mark_in(holder: &Facts) -> StrokeClass {
    if holder.marks > LIMITS.texture && !holder.is_veined { StrokeClass::Scribble } else { StrokeClass::Vein }
}

/// Returns the class of a line that lies in no outline: it is no blade, disc or fruit, and a pot, trunk or crown only
/// if the classifier is sure.
fn class_of_line(said: Classified) -> Option<StrokeClass> {
    let is_line = match said.class {
        StrokeClass::Axis | StrokeClass::Ground => true,
        StrokeClass::TrunkOutline | StrokeClass::Crown | StrokeClass::Pot => {
            said.confidence > LIMITS.believed
        }
        _ => false,
    };
    (!is_line).then_some(StrokeClass::Axis)
}

/// The class of each set of similar outlines, by their rows: hundreds of equal outlines are one set, which is looked at
/// once.
type ClassesOfAlike = LiteMap<Vec<usize>, StrokeClass>;

fn class_of_outline(
    (sheet, together): (&Sheet, &mut ClassesOfAlike),
    k: usize,
    said: impl Fn(usize) -> Classified,
) -> Option<StrokeClass> {
    let facts = &sheet.facts[k];
    let alike = sheet.alike(k);
    if let Some(holder) = facts.holder {
        let beside = alike.iter().filter(|&&j| sheet.facts[j].holder == Some(holder)).count();
        if beside > LIMITS.repeated && sheet.facts[holder].marks >= LIMITS.texture {
            return Some(StrokeClass::Scribble);
        }
    }
    let crowns = alike.iter().filter(|&&j| said(j).class == StrokeClass::Crown).count();
    if 2 * crowns > alike.len() && !facts.has_midrib {
        return None;
    }
    if alike.len() >= LIMITS.repeated {
        if let Some(&class) = together.get(&alike) {
            return Some(class);
        }
        let is_disc = are_discs(sheet, &alike);
        let class = if is_disc { StrokeClass::Disc } else { class_of_repeated(sheet, &alike) };
        together.insert(alike, class);
        return Some(class);
    }
    let is_body = matches!(
        said(k).class,
        StrokeClass::Crown
            | StrokeClass::Pot
            | StrokeClass::Disc
            | StrokeClass::Fruit
            | StrokeClass::Corolla
            | StrokeClass::TrunkOutline
    );
    if is_body && facts.form == Form::Ring && said(k).confidence > LIMITS.believed {
        return None;
    }
    let round = facts.outline.as_ref().is_some_and(|o| o.roundness > LIMITS.round);
    let textured = facts.is_textured && round;
    Some(if textured { StrokeClass::Fruit } else { StrokeClass::Blade })
}

/// Whether most of some similar round outlines lie each where three larger outlines meet, and none touches another of
/// them: discs of flowers along a stem. Berries touch one another, or hang.
fn are_discs(sheet: &Sheet, alike: &[usize]) -> bool {
    let outline = |k: usize| sheet.facts[k].outline.as_ref();
    let unlike = unlike(sheet, alike);
    let is_disc = |&&k: &&usize| {
        let Some(own) = outline(k).filter(|o| o.roundness > LIMITS.round) else { return false };
        let larger =
            |j: usize| outline(j).is_some_and(|o| o.area > LIMITS.petal * own.area && own.touches(o));
        let around = unlike.iter().filter(|&&j| larger(j)).count();
        around >= LIMITS.petals_about
            && !alike.iter().any(|&j| j != k && outline(j).is_some_and(|o| own.touches(o)))
    };
    2 * alike.iter().filter(is_disc).count() > alike.len()
}

/// Returns the rows of all strokes but some; `alike` rises.
fn unlike(sheet: &Sheet, alike: &[usize]) -> Vec<usize> {
    (0..sheet.facts.len()).filter(|j| alike.binary_search(j).is_err()).collect()
}

/// Whether some outlines are seen whole, and most touch none that is unlike them: petals lie before and behind others.
fn stand_alone(sheet: &Sheet, alike: &[usize]) -> bool {
    let unlike = unlike(sheet, alike);
    let is_whole = |k: &&usize| sheet.facts[**k].form == Form::Ring;
    let is_free = |k: &&usize| {
        let Some(own) = &sheet.facts[**k].outline else { return false };
        let others = unlike.iter().map(|&j| &sheet.facts[j]).filter(|f| f.holder != Some(**k));
        !others.filter_map(|f| f.outline.as_ref()).any(|o| own.touches(o))
    };
    let (whole, free) = (alike.iter().filter(is_whole).count(), alike.iter().filter(is_free).count());
    3 * whole >= alike.len() && 2 * free > alike.len()
}

/// Whether most outlines stand round an empty middle together with those that they touch, as petals do; fruits of a
/// bunch fill the middle.
fn stand_in_rings(sheet: &Sheet, alike: &[usize]) -> bool {
    let outlines: Vec<&Outline> = alike.iter().filter_map(|&j| sheet.facts[j].outline.as_ref()).collect();
    let middles: Vec<DVec2> = outlines.iter().map(|o| geom::centroid(&o.points)).collect();
    let mut group: Vec<usize> = (0..outlines.len()).collect();
    for a in 0..outlines.len() {
        for b in a + 1..outlines.len() {
            if group[a] != group[b] && outlines[a].touches(outlines[b]) {
                let (keep, give) = (group[a], group[b]);
                group.iter_mut().filter(|g| **g == give).for_each(|g| *g = keep);
            }
        }
    }
    let in_ring = |k: &usize| {
        let members: Vec<DVec2> =
            (0..group.len()).filter(|&j| group[j] == group[*k]).map(|j| middles[j]).collect();
        #[expect(clippy::cast_precision_loss, reason = "outlines")]
        let count = members.len() as f64;
        let centre = members.iter().sum::<DVec2>() / count;
        let mean = members.iter().map(|m| m.distance(centre)).sum::<f64>() / count;
        let nearest = members.iter().map(|m| m.distance(centre)).fold(f64::INFINITY, f64::min);
        members.len() >= LIMITS.repeated && nearest > LIMITS.empty_middle * mean
    };
    2 * (0..group.len()).filter(in_ring).count() > group.len()
}

/// Returns the class of similar outlines: round ones that are small, or stand in no ring, are fruits or florets,
/// others blades.
fn class_of_repeated(sheet: &Sheet, alike: &[usize]) -> StrokeClass {
    let outlines = || alike.iter().filter_map(|&j| sheet.facts[j].outline.as_ref());
    let middle =
        |measure: fn(&Outline) -> f64| base::median(outlines().map(measure).collect()).unwrap_or(0.0);
    let (roundness, slenderness) = (middle(|o| o.roundness), middle(|o| o.slenderness));
    let is_small =
        roundness > LIMITS.round && slenderness > LIMITS.plump && middle(|o| o.area) < LIMITS.small_area;
    let is_circle = roundness > LIMITS.circular && slenderness > LIMITS.as_wide_as_long;
    let is_round = is_small || (is_circle && stand_alone(sheet, alike) && !stand_in_rings(sheet, alike));
    if is_round { StrokeClass::Fruit } else { StrokeClass::Blade }
}
