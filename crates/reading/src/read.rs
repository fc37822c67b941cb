//! The order in which a drawing is understood: `Ink + classes -> Reading`.

use std::cell::{OnceCell, RefCell};

use base::{CancelToken, Cancelled, Report, Run};
use ink::{COMMON_GROUND, Classified, Ink, LONE_LINE, Source, StrokeClass};
use plant::AxisKind;

use crate::bare::BareWood;
use crate::confidence::{CONFIDENCE_LIMITS, Evidence};
use crate::draft::Draft;
use crate::glance::Glance;
use crate::no_plant::NO_PLANT_LIMITS;
use crate::rules::GREEN_LEAVES;
use crate::silhouette::{Drawn, Shaping, Silhouette};
use crate::structure::{Composed, Joined, Sheet, Structure};
use crate::thresholds::FEWEST_PETALS;
use crate::{
    BESIDE_THE_PLANT, BladeReading, KeptStrokes, Kind, OrganWord, PlantReading, READ_AS, Reading, Scored,
    StrokeReading, aside, attach, flowers, glance, inertia, kinds, no_plant, outlines, palette, pressed,
    rules, several, silhouette, structure, tangled_length, veins,
};
use geom::{bounds, convex_hull, signed_area};
use glam::DVec2;

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

/// Reads a drawing as [`read`] does, but takes every plant for one kind, whatever it looks like.
pub fn read_as(kind: Option<Kind>, ink: &Ink, classes: &[Classified], report: &mut Report) -> Reading {
    read_again(kind, &[], (ink, classes), &mut KeptStrokes::default(), &Run::plain(), report)
}

/// Reads a drawing as [`read`] does, with some [rules](crate::RULES) switched off by their names: to measure what each
/// is worth.
pub fn read_without(off: &[&str], ink: &Ink, classes: &[Classified], report: &mut Report) -> Reading {
    read_again(None, off, (ink, classes), &mut KeptStrokes::default(), &Run::plain(), report)
}

/// Reads a changing drawing as [`read_as`] and [`read_without`] do, and keeps the results of strokes that do not
/// change.
///
/// Guaranteed: the same reading as with nothing kept. A cancelled run ends soon, with a reading that means nothing.
pub fn read_again(
    kind: Option<Kind>,
    off: &[&str],
    (ink, classes): (&Ink, &[Classified]),
    kept: &mut KeptStrokes,
    run: &Run<'_>,
    report: &mut Report,
) -> Reading {
    let asked = Asked { kind, off, kept: &RefCell::new(core::mem::take(kept)), cancel: run.cancel };
    let other: Vec<Classified> = classes.iter().map(|said| without(off, said)).collect();
    let reading = whole(&asked, ink, &other, report);
    *kept = asked.kept.take();
    kept.forget();
    reading
}

/// Reads a drawing as [`read_again`] does, without its last stroke, which is still being drawn: it changes nothing.
pub fn read_but_last(
    (ink, classes): (&Ink, &[Classified]),
    kept: &mut KeptStrokes,
    run: &Run<'_>,
    report: &mut Report,
) -> Reading {
    let Some(last) = ink.strokes.last() else { return Reading::default() };
    let part = several::part(ink, classes, (0..ink.strokes.len() - 1).collect());
    let mut whole = several::Collected::new(ink, classes);
    whole.add(&part, read_again(None, &[], (&part.ink, &part.classes), kept, run, report));
    let mut reading = whole.finish(report);
    let said = classes.get(ink.strokes.len() - 1).copied().unwrap_or_default();
    let (index, organ) = (last.index, OrganWord::Ignored);
    let (class, confidence, source) = (said.class, said.confidence, said.source);
    if let Err(at) = reading.strokes.binary_search_by_key(&index, |s| s.index) {
        reading.strokes.insert(at, StrokeReading { index, class, organ, confidence, source });
    }
    reading
}

/// Returns the class of a stroke if the rule that decided it is switched off.
fn without(off: &[&str], said: &Classified) -> Classified {
    match said.source {
        // There is no other evidence about the ground of several plants.
        Source::Rule(COMMON_GROUND) if off.contains(&COMMON_GROUND) => Classified::default(),
        Source::Rule(name) if off.contains(&name) => Classified::by_shares(said.shares),
        _ => *said,
    }
}

/// Returns the numbers of a drawing of one plant, for the model of kinds: [`kind_features`](crate::kind_features) of
/// its first reading.
pub fn kind_row(ink: &Ink, classes: &[Classified]) -> Vec<f64> {
    let asked = Asked { kind: None, off: &[], kept: &RefCell::default(), cancel: Run::plain().cancel };
    let first = attempt(&asked, &Proposal::default(), ink, classes, &mut Report::default());
    kinds::kind_features(ink, classes, &first)
}

/// Returns the numbers of a drawing, for the model of drawings that show no plant: one for each of
/// [`no_plant_feature_names`](crate::no_plant_feature_names).
pub fn no_plant_row(ink: &Ink, classes: &[Classified]) -> Vec<f64> {
    no_plant::row(&kind_row(ink, classes), &glance::look(ink), ink.strokes.len(), sureness(ink, classes))
}

/// Options of a reading.
struct Asked<'a> {
    /// The kind that every plant is taken for.
    kind: Option<Kind>,
    /// Rules that are switched off.
    off: &'a [&'a str],
    kept: &'a RefCell<KeptStrokes>,
    cancel: &'a CancelToken,
}

impl Asked<'_> {
    /// Whether the whole may decide the classes of strokes: no class was set by hand, and there are not too many
    /// strokes.
    fn is_free(&self, ink: &Ink, classes: &[Classified]) -> bool {
        let guessed = classes.iter().all(|c| c.source != Source::User);
        guessed && ink.strokes.len() <= MOST_STROKES && !self.off.contains(&READ_AS)
    }

    /// Whether the run was cancelled: anything read from here on means nothing.
    fn is_over(&self) -> bool {
        self.cancel.check().is_err()
    }

    /// Whether pieces that look like no plant are left out next to a plant.
    fn leaves_out(&self, ink: &Ink) -> bool {
        ink.strokes.len() <= MOST_STROKES && !self.off.contains(&BESIDE_THE_PLANT)
    }
}

/// A plant as its strokes alone give it, and how well each kind explains it.
struct First {
    reading: Reading,
    said: Report,
    shares: kinds::Shares,
    glance: Glance,
    /// The chance that it is no plant.
    no_plant: f64,
}

impl First {
    fn read(asked: &Asked<'_>, ink: &Ink, classes: &[Classified]) -> Self {
        let mut said = Report::default();
        let reading = attempt(asked, &Proposal::default(), ink, classes, &mut said);
        if ink.strokes.len() > MOST_JUDGED || asked.is_over() {
            // The kind that was read, and no other.
            let kinds = vec![Scored { kind: Kind::from_reading(&reading), score: 1.0 }];
            let shares = kinds::Shares { kinds, ..kinds::Shares::default() };
            return Self { reading, said, shares, glance: Glance::default(), no_plant: 0.0 };
        }
        let glance = glance::look(ink);
        let row = kinds::kind_features(ink, classes, &reading);
        let mut shares = kinds::shares(&row, &glance::by_kind(&glance.words));
        if palette::is_herb(ink) {
            shares.without_wood();
        }
        shares.weigh_colours(palette::brights(ink));
        let row = no_plant::row(&row, &glance, ink.strokes.len(), sureness(ink, classes));
        Self { reading, said, shares, glance, no_plant: no_plant::chance(&row) }
    }

    /// Warns if this is no plant, unless the user gave its kind.
    fn warn_if_no_plant(&self, asked: &Asked<'_>, report: &mut Report) {
        let limits = NO_PLANT_LIMITS;
        let is_none = self.no_plant > limits.chance_most || self.shares.no_plant > limits.share_most;
        if asked.kind.is_none() && is_none {
            report.warn(UNLIKE_A_PLANT, "this does not look like a plant; it was read as the nearest plant");
        }
    }

    /// Whether separate pieces are one plant after all, because one kind explains all of it: berries, a pod with its
    /// peas.
    fn is_one(&self) -> bool {
        self.shares.several < FEW_PLANTS && self.shares.kinds.first().is_some_and(|k| k.score > ALONE)
    }
}

fn whole(asked: &Asked<'_>, ink: &Ink, classes: &[Classified], report: &mut Report) -> Reading {
    Reading { pressed: pressed::pressed(ink), ..each(asked, ink, classes, report) }
}

/// Reads every plant of a drawing.
fn each(asked: &Asked<'_>, ink: &Ink, classes: &[Classified], report: &mut Report) -> Reading {
    if !ink.subjects.is_parted() {
        let first = First::read(asked, ink, classes);
        first.warn_if_no_plant(asked, report);
        return one(asked, ink, classes, first, report);
    }
    if asked.is_over() {
        return Reading::default();
    }
    if asked.is_free(ink, classes) && structure::readers::propose(ink).iter().any(|p| p.is_of_pieces) {
        let first = First::read(asked, ink, classes);
        first.warn_if_no_plant(asked, report);
        return one(asked, ink, classes, first, report);
    }
    let parts = several::parts(ink, classes);
    let several = parts.len() > 1;
    let mut firsts: Vec<First> = parts.iter().map(|p| First::read(asked, &p.ink, &p.classes)).collect();
    let mut left = vec![false; parts.len()];
    if several && asked.leaves_out(ink) {
        let pieces: Vec<aside::Piece<'_>> = parts
            .iter()
            .zip(&firsts)
            .map(|(p, f)| aside::Piece::new(&p.rows, &p.classes, &f.shares))
            .collect();
        left = aside::find_left_out(ink, &pieces, |rows| {
            let part = several::part(ink, classes, rows.to_vec());
            First::read(asked, &part.ink, &part.classes).shares.no_plant
        });
    }
    // Some pieces of a thing look like plants, and some pieces of a plant do not: the rest is judged as a whole.
    let stay: Vec<usize> = (0..parts.len()).filter(|&k| !left[k]).collect();
    if let [only] = stay[..] {
        firsts[only].warn_if_no_plant(asked, report);
    } else if several && asked.kind.is_none() && asked.is_free(ink, classes) {
        if left.contains(&true) {
            let mut rows: Vec<usize> = stay.iter().flat_map(|&k| parts[k].rows.iter().copied()).collect();
            rows.sort_unstable();
            let part = several::part(ink, classes, rows);
            First::read(asked, &part.ink, &part.classes).warn_if_no_plant(asked, report);
        } else {
            let first = First::read(asked, ink, classes);
            first.warn_if_no_plant(asked, report);
            if first.is_one() {
                return one(asked, ink, classes, first, report);
            }
        }
    }
    let mut kept = several::Collected::new(ink, classes);
    for ((part, first), left) in parts.iter().zip(firsts.drain(..)).zip(left) {
        if left {
            kept.leave(&part.rows);
        } else {
            kept.add(part, one(asked, &part.ink, &part.classes, first, report));
        }
    }
    kept.finish(report)
}

/// A drawing is one plant only if the share of several plants is below this when it is read as one.
const FEW_PLANTS: f64 = 0.1;
/// A drawing is one plant only if the likeliest kind has more than this share.
const ALONE: f64 = 0.6;
/// Another kind is tried if its share is above this.
const SURE: f64 = 0.3;
/// Another kind is tried if its share is more than this factor of that of the kind first read.
const BETTER: f64 = 2.0;
/// Strokes of which the classifier is more sure than this support the kind first read.
const CLEAR: f64 = 0.55;
/// Factor by which another kind must then be likelier.
const MUCH_BETTER: f64 = 5.0;
/// A kind with a larger share than this is likelier than all others together (*geometry*).
const LIKELY: f64 = 0.5;
/// Least share of a likely kind in a drawing of many strokes: kinds were not learnt from such drawings.
const SURELY: f64 = 0.9;
/// The code of the warning that a drawing shows no plant.
pub const UNLIKE_A_PLANT: &str = "unlike-a-plant";
/// Weight of the kind first read in the reported scores, relative to the model's share: it was built.
const BUILT: f64 = 6.0;
/// A drawing of more strokes is read once: nobody draws one plant with so many and means another kind.
const MOST_STROKES: usize = 200;
/// A drawing of more strokes is not compared with other kinds at all: the numbers of the whole would take two fifths of
/// the time of each stroke that is added, and the model learnt from none so large.
const MOST_JUDGED: usize = 1000;
/// A blade on wood that is larger than this share of the drawing's diagonal is a crown: that is most of a tree
/// (*geometry*).
const CROWN_BLADE: f64 = 0.35;
/// A tree whose crowns are less than this share of the hull is read again; the new reading is kept if its crowns are
/// more than this share.
const POOR_CROWN: f64 = 0.25;
/// The crowns of the new reading must also be more than this factor of the first ones: bare trees have none.
const MORE_CROWN: f64 = 2.0;
/// A tree is read by its silhouette if the reading of its strokes covers less of trunk or crown than this: nearly all
/// trees by hand whose trunks or crowns came apart cover less, few whole ones do (*drawings*).
const FITS: f64 = 0.8;
/// A tree with at least this many leaves or flowers was drawn leaf by leaf.
const LEAFY: usize = 8;
/// Fewest fronds of a palm if the whole is known to be one.
const FEWEST_FRONDS: usize = 2;
/// A painted picture of which more than this share contradicts the reading by its colours is read by these
/// (*drawings*).
const CONTRADICTED: f64 = 0.2;
/// A tree, palm or cactus that is more certain than this keeps its kind, whatever its colours (*drawings*).
const SURE_OF_FORM: f64 = 0.6;
/// A reading by colours contradicts less than this share of the picture that another reading does.
const HALF_CONTRADICTED: f64 = 0.5;
/// Most readings that are reported.
const TOLD: usize = 3;

/// Reads one plant: chooses the interpretation that explains the whole drawing best.
fn one(asked: &Asked<'_>, ink: &Ink, classes: &[Classified], first: First, report: &mut Report) -> Reading {
    if asked.is_over() {
        return Reading::default();
    }
    let First { mut reading, mut said, shares, glance, .. } = first;
    let mut kind = Kind::from_reading(&reading);
    // The interpretation of the whole that replaces that of the strokes, if any.
    let mut taken = None;
    let (mut scores, no_plant) = (shares.kinds, shares.no_plant);
    let built = kind;
    // The model learnt from no drawing with roots.
    let (rooted, free) = (is_rooted(&reading), asked.is_free(ink, classes));
    let other = kind_to_try((ink, classes), (&reading, built), &scores, free);
    if let Some(wanted) = asked.kind {
        kind = wanted;
        (reading, said) = taken_for(asked, wanted, ink, classes);
    } else if let Some(other) = other.filter(|_| !rooted && free) {
        let (tried, again) = taken_for(asked, other.kind, ink, classes);
        // Only a kind that can be built explains the drawing.
        let better = !other.kind.is_like(built)
            || other.kind.is_like(Kind::Fruit)
            || built == Kind::Palm && is_whole_palm(&reading, &tried)
            || is_whole_tree(ink, &reading, &tried);
        if better && is_built(other.kind, &tried) {
            (reading, said, kind, taken) = (tried, again, other.kind, Some(other.kind));
        }
    }
    if taken.is_none()
        && asked.kind.is_none()
        && kind.is_like(Kind::Tree)
        && free
        && let Some(tree) = by_silhouette(asked, ink, classes, &reading)
    {
        (reading, said) = (tree, Report::default());
    }
    if asked.is_over() {
        return Reading::default();
    }
    let facts = SheetOnce { ink, sheet: OnceCell::new() };
    let (mut structure, mut is_structural, mut is_cut) = (None, false, false);
    if asked.kind.is_none()
        && let Some(found) = by_structure(asked, (&facts, classes), &reading, |k| share_of(&scores, k))
    {
        if let Some((tried, again, likely)) = as_likely(asked, (&facts, classes), &found.reading, &scores) {
            (reading, said, kind, taken) = (tried, again, likely, Some(likely));
        } else {
            kind = Kind::from_reading(&found.reading);
            (reading, said, taken) = (found.reading, found.said, None);
            (structure, is_structural, is_cut) = (found.says.clone(), true, found.says.is_none());
        }
    }
    if asked.is_over() {
        return Reading::default();
    }
    let (mut sure, mut called) = (None, None);
    if let Some((composed, proposal, score)) = by_readers(asked, (ink, classes), &scores)
        && is_preferred(&facts, (&composed, &proposal), (&reading, kind))
    {
        (reading, said, kind, sure) = (composed, Report::default(), proposal.kind, Some(score));
        called = proposal.word;
    }
    if asked.kind.is_none() && sure.is_none() && !is_cut {
        let how = Proposal { kind: taken, structure, is_cut: false };
        if let Some((tried, again, was)) = as_shown(asked, (ink, classes), (&reading, kind), &how, &scores) {
            (reading, said, kind) = (tried, again, was);
        }
    }
    match sure {
        Some(score) => decide_for(&mut scores, kind, score),
        None => scores.iter_mut().filter(|s| s.kind.is_like(built)).for_each(|s| s.score *= BUILT),
    }
    report.warnings.append(&mut said.warnings);
    if asked.kind.is_none() && sure.is_none() {
        kind = told_apart(kind, &scores);
    }
    let is_of_masses = replace(by_masses(asked, (ink, classes), &reading, report), (&mut reading, &mut kind));
    let total = scores.iter().map(|s| s.score).sum::<f64>().max(f64::MIN_POSITIVE);
    let share = |kind: Kind| share_of(&scores, kind) / total;
    let certainty = if sure.is_some() { 1.0 } else { share(kind) };
    let colours = by_colours(asked, (ink, classes), (&reading, kind), certainty);
    let is_of_colours = replace(colours, (&mut reading, &mut kind));
    // If a reader knows several bodies, they are not a single one.
    as_body(ink, kind, free && called.is_none() && !is_of_colours, &mut reading);
    let evidence = Evidence {
        share: share(kind),
        undecided: glance::entropy(&glance.words),
        no_plant,
        strokes: ink.strokes.len(),
        by_structure: is_structural,
        by_arrangement: sure.is_some(),
        is_tangle: tangled_length(&reading) > 0.0,
        by_masses: is_of_masses,
        by_colours: is_of_colours,
        is_wood: matches!(kind, Kind::Tree | Kind::Conifer | Kind::Palm | Kind::Bush),
        explained: explained(&facts, &reading),
    };
    let readings = readings(kind, &evidence, &scores);
    let word = called.or_else(|| glance::word(kind, &glance.words));
    reading.plants = vec![described(ink, kind, (evidence, readings), word)];
    reading
}

/// Replaces a reading and its kind by others, if there are any; returns whether there were.
fn replace(found: Option<(Reading, Kind)>, (reading, kind): (&mut Reading, &mut Kind)) -> bool {
    let is_found = found.is_some();
    if let Some((other, again)) = found {
        (*reading, *kind) = (other, again);
    }
    is_found
}

/// Returns the plant as it was shown before the last stroke, unless another reading is clear now. `how`: the way in which
/// that reading was made.
fn as_shown(
    asked: &Asked<'_>,
    (ink, classes): (&Ink, &[Classified]),
    (reading, kind): (&Reading, Kind),
    how: &Proposal,
    scores: &[Scored],
) -> Option<(Reading, Report, Kind)> {
    let shown = inertia::as_shown(ink, classes, reading)?;
    let mut said = Report::default();
    let mut tried = attempt(asked, how, ink, &shown, &mut said);
    let was = Kind::from_reading(&tried);
    let before = || {
        let rows = (0..ink.strokes.len().saturating_sub(1)).collect();
        let part = several::part(ink, classes, rows);
        First::read(asked, &part.ink, &part.classes).shares.kinds
    };
    if inertia::is_clear(ink, classes, (reading, kind), was, scores, before) {
        return None;
    }
    inertia::tell(&mut tried, ink, classes);
    Some((tried, said, was))
}

/// Returns how much of a drawing of many organs a reading explains: 0 to 1. It is 1 for a drawing of few strokes, or
/// of more than are examined.
fn explained(facts: &SheetOnce<'_>, reading: &Reading) -> f64 {
    let limits = structure::LIMITS;
    let is_of_many = (limits.many_strokes..=limits.most_strokes).contains(&facts.ink.strokes.len());
    if is_of_many { structure::score(facts.ink, facts.sheet(), reading, &[]) } else { 1.0 }
}

/// The facts of a drawing's strokes, found when they are first asked for.
struct SheetOnce<'a> {
    ink: &'a Ink,
    sheet: OnceCell<Sheet>,
}

impl SheetOnce<'_> {
    fn sheet(&self) -> &Sheet {
        self.sheet.get_or_init(|| Sheet::new(self.ink))
    }
}

/// Returns how likely a kind is, together with all that are built alike.
fn share_of(scores: &[Scored], kind: Kind) -> f64 {
    scores.iter().filter(|s| s.kind.is_like(kind)).map(|s| s.score).sum()
}

/// Returns the kind that explains a drawing clearly better than the kind that was built, or the same kind if not all
/// of it was built: its crown was taken for a blade, or most of it for something else, or the leaves on a fruit for
/// petals.
fn kind_to_try(
    (ink, classes): (&Ink, &[Classified]),
    (reading, built): (&Reading, Kind),
    scores: &[Scored],
    free: bool,
) -> Option<Scored> {
    // Petals round a middle were no coincidence either.
    let clear = sureness(ink, classes) > CLEAR || built.is_like(Kind::Flower);
    let better = if clear { MUCH_BETTER } else { BETTER };
    let likelier = |s: &&Scored| {
        let own = share_of(scores, s.kind);
        !s.kind.is_like(built) && own > SURE && own > better * share_of(scores, built)
    };
    let is_half = || {
        built.is_like(Kind::Tree)
            && (bears_a_crown_as_blade(reading) || crown_share(ink, reading) < POOR_CROWN)
            || built == Kind::Palm && bare_lines(reading) > 0
            || built.is_like(Kind::Fruit) && !reading.flowers.is_empty()
    };
    let half = free && is_half();
    let same = |s: &&Scored| half && s.kind.is_like(built) && share_of(scores, built) > SURE;
    scores.iter().find(likelier).or_else(|| scores.iter().find(same)).copied()
}

/// Makes a vegetable one body, if no class was set by hand; a kind without wood gets none.
fn as_body(ink: &Ink, kind: Kind, free: bool, reading: &mut Reading) {
    if kind == Kind::Vegetable && free {
        silhouette::one_body(ink, reading);
    }
    if matches!(kind, Kind::Cactus | Kind::Fruit | Kind::Vegetable) {
        soften(reading);
    }
}

/// Describes one plant.
fn described(
    ink: &Ink,
    kind: Kind,
    (evidence, readings): (Evidence, Vec<Scored>),
    word: Option<&'static str>,
) -> PlantReading {
    let strokes = ink.strokes.iter().map(|s| s.index).collect();
    let ends = ink.strokes.iter().flat_map(|s| &s.points).map(|p| p.y);
    let (low, high) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), y| (l.min(y), h.max(y)));
    PlantReading { strokes, height: (high - low).max(0.0), kind, word, evidence, readings }
}

/// Whether a reading is of the kind that it was taken for: it has the parts that the kind needs, and no others. Wood is
/// a tree, bare or with a crown down to the ground, two fronds on a trunk are a palm, a body without leaves is a
/// cactus, even in a pot, and blades that nothing bears are grass.
fn is_built(kind: Kind, reading: &Reading) -> bool {
    let no_flower = reading.flowers.is_empty() && reading.fruits.is_empty();
    let bare = reading.regions.is_empty();
    let needed = match kind {
        Kind::Tree | Kind::Conifer => reading.woody,
        Kind::Palm => bare && reading.woody && reading.leaves.len() >= FEWEST_FRONDS,
        Kind::Cactus => {
            bare && reading.leaves.is_empty() && reading.axes.iter().any(|a| !a.half_width.is_empty())
        }
        Kind::Grass => bare && reading.axes.is_empty() && reading.leaves.len() >= FEWEST_PETALS,
        _ => false,
    };
    kind.is_like(Kind::from_reading(reading)) || (no_flower && needed)
}

/// Whether a reading has roots under a ground: they belong to the plant that stands on it. Without a ground they are
/// lines that lead down, which each kind reads differently.
fn is_rooted(reading: &Reading) -> bool {
    reading.axes.iter().any(|a| a.kind == AxisKind::Root)
        && reading.strokes.iter().any(|s| s.class == StrokeClass::Ground)
}

/// Whether a tree has a leaf or petal of the size of a crown, or of a trunk.
fn bears_a_crown_as_blade(reading: &Reading) -> bool {
    let petals = reading.flowers.iter().flat_map(|f| &f.petals);
    let large = |b: &BladeReading| bounds(&b.outline).is_some_and(|(lo, hi)| lo.distance(hi) > CROWN_BLADE);
    petals.chain(&reading.leaves).any(large)
}

/// Returns the share of a drawing's hull that its crowns cover.
fn crown_share(ink: &Ink, reading: &Reading) -> f64 {
    // The hulls of the strokes: fewer points.
    let all: Vec<DVec2> = ink.strokes.iter().flat_map(|s| s.hull().iter().copied()).collect();
    let crowns: f64 = reading.regions.iter().map(|r| signed_area(&r.outline)).sum();
    crowns / signed_area(&convex_hull(&all)).max(f64::MIN_POSITIVE)
}

/// Whether a tree that was read again is a better tree: it has no blade as large as a crown, and much more crown if it
/// had little.
fn is_whole_tree(ink: &Ink, first: &Reading, again: &Reading) -> bool {
    let more = || {
        let share = crown_share(ink, again);
        share > POOR_CROWN && share > MORE_CROWN * crown_share(ink, first)
    };
    !bears_a_crown_as_blade(again) && (bears_a_crown_as_blade(first) || more())
}

/// Counts the lines of a reading that are wood without an outline.
fn bare_lines(reading: &Reading) -> usize {
    reading.axes.iter().filter(|a| a.half_width.is_empty()).count()
}

/// Whether a palm that was read again is a better palm: fewer of its fronds are bare wood, and none are lost.
fn is_whole_palm(first: &Reading, again: &Reading) -> bool {
    bare_lines(again) < bare_lines(first) && again.leaves.len() >= first.leaves.len()
}

/// Removes the wood of cacti, fruits and vegetables, however much they branch.
fn soften(reading: &mut Reading) {
    reading.woody = false;
    let wood = reading.axes.iter_mut().filter(|a| a.kind == AxisKind::Branch);
    wood.for_each(|a| a.kind = AxisKind::Stem);
}

/// Chooses between a fruit and a root, which are built alike, by the model's shares.
fn told_apart(kind: Kind, scores: &[Scored]) -> Kind {
    let body = scores.iter().find(|s| s.kind.is_like(Kind::Fruit));
    body.filter(|_| kind.is_like(Kind::Fruit)).map_or(kind, |s| s.kind)
}

/// Returns how sure the classifier is of the strokes of a drawing, the mean over their length: 0 to 1.
fn sureness(ink: &Ink, classes: &[Classified]) -> f64 {
    let rows = ink.strokes.iter().zip(classes);
    let (sum, length) =
        rows.fold((0.0, 0.0), |(sum, length), (s, c)| (sum + s.length * c.confidence, length + s.length));
    if length > 0.0 { sum / length } else { 0.0 }
}

/// Returns the kind of a plant and how likely it is right, and the best of the others; one of each group that is built
/// alike. The others share the rest in proportion; a kind that could not be built, or is not the one the user asked
/// for, explains the drawing no better than the kind that was built.
fn readings(kind: Kind, evidence: &Evidence, scores: &[Scored]) -> Vec<Scored> {
    let total: f64 = scores.iter().map(|s| s.score).sum::<f64>().max(f64::MIN_POSITIVE);
    let group = |k: Kind| share_of(scores, k) / total;
    // The model compares no kinds in a drawing of so many strokes.
    let is_weighed = scores.len() > 1;
    let own = if is_weighed || evidence.by_masses {
        evidence.confidence()
    } else {
        CONFIDENCE_LIMITS.not_weighed.min(evidence.share)
    };
    let left = (1.0 - own) / (1.0 - evidence.share).max(f64::MIN_POSITIVE);
    let mut found: Vec<Scored> = vec![Scored { kind, score: own }];
    for s in scores {
        if !found.iter().any(|f| f.kind.is_like(s.kind)) {
            found.push(Scored { kind: s.kind, score: (group(s.kind) * left).min(own) });
        }
    }
    base::sort_by(&mut found[1..], |a, b| b.score.total_cmp(&a.score).then(a.kind.cmp(&b.kind)));
    found.truncate(TOLD);
    found
}

/// Whether a plant of this kind has leaves where another may have petals.
const fn bears_no_flower(kind: Kind) -> bool {
    matches!(kind, Kind::Grass | Kind::Stem | Kind::Palm | Kind::Leaf | Kind::Fruit | Kind::Vegetable)
}

/// Reads one plant as a kind; reads a tree that came apart by its silhouette, if no class was set by hand.
fn taken_for(asked: &Asked<'_>, kind: Kind, ink: &Ink, classes: &[Classified]) -> (Reading, Report) {
    let mut report = Report::default();
    let proposal = Proposal { kind: Some(kind), ..Proposal::default() };
    let reading = attempt(asked, &proposal, ink, classes, &mut report);
    if kind.is_like(Kind::Tree)
        && asked.is_free(ink, classes)
        && let Some(tree) = by_silhouette(asked, ink, classes, &reading)
    {
        return (tree, Report::default());
    }
    (reading, report)
}

/// Reads a tree by its silhouette if the reading of its strokes does not cover that. A tree drawn leaf by leaf would
/// lose its leaves.
fn by_silhouette(asked: &Asked<'_>, ink: &Ink, classes: &[Classified], reading: &Reading) -> Option<Reading> {
    let organs = reading.leaves.len() + reading.flowers.len();
    if organs >= LEAFY {
        return None;
    }
    let shaping = Shaping::find(ink, reading)?;
    let drawn = Drawn::new(&shaping.lines);
    let mut draft = Draft::new(ink, classes, asked.kept);
    draft.kind = Some(Kind::Tree);
    if let Some(silhouette) = Silhouette::find(&drawn) {
        (silhouette.fit(reading) < FITS).then(|| silhouette.read(&shaping, &mut draft))?;
    } else {
        let bare = reading.regions.is_empty().then(|| BareWood::find(&drawn, reading)).flatten()?;
        (bare.fit(reading) < FITS).then(|| bare.read(&shaping, &mut draft))?;
    }
    outlines::lobes(&mut draft);
    let mut fruits = draft.fruits(&[]);
    let hints = draft.hints(&[]);
    let lines = std::mem::take(&mut draft.lines);
    draft.forest.grow(lines, &hints);
    attach::roots(&mut draft);
    let bearers = outlines::bear_regions(&mut draft);
    attach::fruits(&mut draft, &mut fruits);
    Some(draft.finish(bearers, vec![], vec![], fruits, vec![]))
}

/// A reading by structure.
struct Structural {
    reading: Reading,
    said: Report,
    /// The structure of the drawing's own strokes; `None` if some were cut anew.
    says: Option<Structure>,
}

/// Reads a plant by the structure of its strokes, if that explains the drawing clearly better than another reading
/// does. `likely`: the share of a kind.
fn by_structure(
    asked: &Asked<'_>,
    (facts, classes): (&SheetOnce<'_>, &[Classified]),
    reading: &Reading,
    likely: impl Fn(Kind) -> f64,
) -> Option<Structural> {
    let ink = facts.ink;
    let count = ink.strokes.len();
    if !(structure::LIMITS.fewest_strokes..=structure::LIMITS.most_strokes).contains(&count)
        || asked.off.contains(&READ_AS)
    {
        return None;
    }
    let sheet = facts.sheet();
    if !sheet.is_careful() {
        return None;
    }
    // The user gave the classes of strokes: none is taken for the side of something else.
    let by_user = classes.iter().any(|c| c.source == Source::User);
    let mut tubes = if by_user { Vec::new() } else { structure::tubes(ink, sheet) };
    let pot = structure::vessel(ink);
    tubes.retain(|t| !pot.iter().any(|&k| t.has(k)));
    // Both sides of a trunk are read as its outline, together with its limbs.
    let is_trunk = |k: usize| {
        classes.get(k).is_some_and(|c| {
            c.class == StrokeClass::TrunkOutline && c.confidence > structure::LIMITS.believed
        })
    };
    let is_wide = |t: &structure::Tube| t.width > structure::LIMITS.trunk;
    if tubes.iter().any(|t| is_wide(t) && t.sides.iter().all(|&k| is_trunk(k))) {
        tubes.clear();
    }
    let may_be_side = |k: usize| {
        !pot.contains(&k)
            && classes.get(k).is_none_or(|c| c.source != Source::User || c.class == StrokeClass::Blade)
    };
    let is_of_many = count >= structure::LIMITS.many_strokes;
    let chains = if is_of_many { structure::chains(ink, sheet, may_be_side) } else { Vec::new() };
    tubes.retain(|t| !chains.iter().flat_map(|c| &c.rows).any(|&k| t.has(k)));
    let joined: Vec<Joined> =
        chains.iter().map(Joined::blade).chain(tubes.iter().map(Joined::axis)).collect();
    let mut report = Report::default();
    let (tried, says) = if let Some(cut) = Composed::with_joined(ink, classes, &joined) {
        let kept = RefCell::default();
        let own = Asked { kind: None, kept: &kept, ..*asked };
        let proposal = Proposal { structure: Some(cut.structure.clone()), ..Proposal::default() };
        let parts = attempt(&own, &proposal, &cut.ink, &cut.classes, &mut report);
        (cut.back(ink, parts), None)
    } else {
        let says = Structure::new(sheet, &pot, classes);
        if !says.differs(classes) {
            return None;
        }
        let proposal = Proposal { structure: Some(says.clone()), ..Proposal::default() };
        (attempt(asked, &proposal, ink, classes, &mut report), Some(says))
    };
    // If the user gave the classes of strokes, kinds learnt from doodles do not count against them.
    let weight = if by_user { 0.0 } else { structure::LIMITS.weight_of_kind };
    let score = |r: &Reading, sides: &[usize]| {
        structure::score(ink, sheet, r, sides) + weight * likely(Kind::from_reading(r))
    };
    let sides: Vec<usize> = tubes.iter().flat_map(structure::Tube::rows).collect();
    // Classes that the user set are the same in both readings: then hidden outlines alone may decide. A class that was
    // shown changes only on clear evidence.
    let is_new = classes.iter().all(|c| c.shown.is_none());
    // A solid with so many strokes inside is a hasty reading of a drawing of many organs.
    let is_solid_of_many =
        is_new && count >= structure::LIMITS.many_strokes && Kind::from_reading(reading).is_like(Kind::Fruit);
    // If both readings of many strokes are of one kind, the structure is better evidence.
    let is_same_of_many = is_new
        && count >= structure::LIMITS.no_doodle
        && Kind::from_reading(&tried).is_like(Kind::from_reading(reading));
    let margin = if is_solid_of_many {
        -structure::LIMITS.solid_of_many
    } else if by_user || is_same_of_many {
        0.0
    } else {
        structure::LIMITS.clearly_better
    };
    let is_better = score(&tried, &[]) >= score(reading, &sides) + margin;
    is_better.then_some(Structural { reading: tried, said: report, says })
}

/// Reads the plant as the kind that is likelier than all others together, if that explains as much as the reading by
/// structure.
fn as_likely(
    asked: &Asked<'_>,
    (facts, classes): (&SheetOnce<'_>, &[Classified]),
    structural: &Reading,
    scores: &[Scored],
) -> Option<(Reading, Report, Kind)> {
    let ink = facts.ink;
    let likely = scores.iter().map(|s| s.kind).find(|&k| share_of(scores, k) > LIKELY)?;
    let is_sure = likely == Kind::Palm || share_of(scores, likely) > SURELY;
    // One solid explains little of the strokes inside it, whatever its score.
    let is_shown = classes.iter().any(|c| c.shown.is_some());
    if is_shown
        || ink.strokes.len() >= structure::LIMITS.no_doodle && !is_sure
        || likely.is_like(Kind::Fruit)
        || likely.is_like(Kind::from_reading(structural))
        || !asked.is_free(ink, classes)
    {
        return None;
    }
    let (tried, said) = taken_for(asked, likely, ink, classes);
    let score = |r: &Reading| structure::score(ink, facts.sheet(), r, &[]);
    // Crowns that became leaves explain as much, but less well.
    let keeps_crowns = structural.regions.is_empty() || !tried.regions.is_empty();
    // The fronds of a palm lie as petals do, and a kind that is surely meant may explain a little less.
    let slack = match likely {
        Kind::Palm => structure::LIMITS.palm,
        _ if is_sure => structure::LIMITS.clearly_better,
        _ => 0.0,
    };
    let is_as_good = is_built(likely, &tried) && keeps_crowns && score(&tried) + slack >= score(structural);
    is_as_good.then_some((tried, said, likely))
}

/// Returns a plant that one of the readers finds in the drawing's faces and lines, its proposal, and how sure that is;
/// only of the requested kind, if there is one.
///
/// `scores`: how likely each kind is otherwise. A proposal is accepted if it is likelier than the likeliest of the
/// others (Bayes): the share of its kind times the likelihood of the arrangement.
fn by_readers(
    asked: &Asked<'_>,
    (ink, classes): (&Ink, &[Classified]),
    scores: &[Scored],
) -> Option<(Reading, structure::readers::Proposal, f64)> {
    // A line that is the only one of its piece may be the side of something that the pieces make together.
    let is_sure = |c: &Classified| c.is_sure() && c.source != Source::Rule(LONE_LINE);
    if !asked.is_free(ink, classes) || classes.iter().any(is_sure) {
        return None;
    }
    let share = |kind: Kind| share_of(scores, kind);
    let best_other =
        |kind: Kind| scores.iter().filter(|s| !s.kind.is_like(kind)).map(|s| s.score).fold(0.0, f64::max);
    let odds = |p: &structure::readers::Proposal| {
        p.likelihood * share(p.kind) / best_other(p.kind).max(f64::MIN_POSITIVE)
    };
    let chosen = structure::readers::propose(ink)
        .into_iter()
        .filter(|p| asked.kind.map_or(odds(p) > 1.0, |asked| asked == p.kind));
    let mut proposal = chosen.max_by(|a, b| odds(a).total_cmp(&odds(b)))?;
    let score = odds(&proposal) / (1.0 + odds(&proposal));
    let reading = composed(asked, ink, &proposal);
    // A fruit and a root are built alike: unless its word says which it is, the shares decide.
    if proposal.word.is_none() {
        proposal.kind = told_apart(proposal.kind, scores);
    }
    inertia::agrees(ink, classes, &reading).then_some((reading, proposal, score))
}

/// Returns the plant that the masses of a hatched drawing are, and its kind, if its reading is a tangle or was not
/// compared with others, and no class or kind was set by hand.
fn by_masses(
    asked: &Asked<'_>,
    (ink, classes): (&Ink, &[Classified]),
    reading: &Reading,
    report: &mut Report,
) -> Option<(Reading, Kind)> {
    let is_hatched = ink.strokes.len() > MOST_JUDGED || tangled_length(reading) > 0.0;
    if !is_hatched
        || asked.kind.is_some()
        || asked.off.contains(&READ_AS)
        || classes.iter().any(|c| c.source == Source::User)
    {
        return None;
    }
    let proposal = structure::masses::propose(ink)?;
    report.warn(
        "read-by-masses",
        "most lines are shading: only the areas that they cover were read; if the plant is wrong, draw the outline \
         of each organ with one line",
    );
    Some((composed(asked, ink, &proposal), proposal.kind))
}

/// Returns the plant that the colours of a painted picture are, and its kind, if another reading contradicts them more,
/// and no class or kind was set by hand. `certainty`: of the kind of the other
/// reading, 0 to 1.
fn by_colours(
    asked: &Asked<'_>,
    (ink, classes): (&Ink, &[Classified]),
    (other, kind): (&Reading, Kind),
    certainty: f64,
) -> Option<(Reading, Kind)> {
    // Trees and cacti are drawn in any colour: their form says more.
    let is_sure =
        certainty > SURE_OF_FORM && matches!(kind, Kind::Tree | Kind::Conifer | Kind::Palm | Kind::Cactus);
    if asked.kind.is_some() || !asked.is_free(ink, classes) || is_sure {
        return None;
    }
    let colours = structure::painted::Colours::new(ink)?;
    let found = colours.contradicted(other, kind);
    if found <= CONTRADICTED {
        return None;
    }
    let proposal = structure::painted::propose(ink)?;
    let reading = composed(asked, ink, &proposal);
    let own = colours.contradicted(&reading, proposal.kind);
    let keeps_pot = !reading.pots.is_empty() || other.pots.is_empty() || other.leaves.is_empty();
    (keeps_pot && own < HALF_CONTRADICTED * found).then_some((reading, proposal.kind))
}

/// Makes the reading of a proposal.
fn composed(asked: &Asked<'_>, ink: &Ink, proposal: &structure::readers::Proposal) -> Reading {
    let composed = Composed::new(ink, proposal);
    let kept = RefCell::default();
    let own = Asked { kind: Some(proposal.kind), kept: &kept, ..*asked };
    let how =
        Proposal { kind: Some(proposal.kind), structure: Some(composed.structure.clone()), is_cut: true };
    let parts = attempt(&own, &how, &composed.ink, &composed.classes, &mut Report::default());
    composed.back(ink, parts)
}

/// Whether a reading explains the ink clearly better than another one of the same kind.
fn explains_better(facts: &SheetOnce<'_>, own: &Reading, other: &Reading) -> bool {
    let score = |r: &Reading| structure::score(facts.ink, facts.sheet(), r, &[]);
    score(own) > score(other) + structure::LIMITS.clearly_better
}

/// Whether a reader's proposal says more than another reading does: another kind, one thing of its kind, more leaves
/// of a plant without flowers, flowers instead of a crown, or more of the ink.
fn is_preferred(
    facts: &SheetOnce<'_>,
    (composed, proposal): (&Reading, &structure::readers::Proposal),
    (other, kind): (&Reading, Kind),
) -> bool {
    proposal.kind != kind
        || proposal.word.is_some()
        || bears_no_flower(kind) && has_more_leaves(composed, other)
        || has_flower_for_crown(composed, other)
        || explains_better(facts, composed, other)
}

/// Whether a reading has flowers where another one has a crown.
fn has_flower_for_crown(own: &Reading, other: &Reading) -> bool {
    own.regions.is_empty() && !own.flowers.is_empty() && other.flowers.is_empty() && !other.regions.is_empty()
}

/// Whether a reading has more leaves than another one that has no flower.
fn has_more_leaves(own: &Reading, other: &Reading) -> bool {
    own.leaves.len() > other.leaves.len() && other.flowers.is_empty()
}

/// Gives a kind the score of its reader; the others share the rest.
fn decide_for(scores: &mut [Scored], kind: Kind, score: f64) {
    let rest: f64 = scores.iter().filter(|s| s.kind != kind).map(|s| s.score).sum();
    for s in scores {
        s.score = if s.kind == kind { score } else { s.score / rest.max(f64::MIN_POSITIVE) * (1.0 - score) };
    }
}

/// How one reading of a plant is made: for a kind, by structure, or by the strokes alone.
#[derive(Clone, Debug, Default)]
struct Proposal {
    kind: Option<Kind>,
    structure: Option<Structure>,
    /// The strokes are already parts that a reader cut.
    is_cut: bool,
}

/// Makes one reading of one plant; an empty one if it was cancelled.
fn attempt(
    asked: &Asked<'_>,
    proposal: &Proposal,
    ink: &Ink,
    classes: &[Classified],
    report: &mut Report,
) -> Reading {
    understood(asked, proposal, (ink, classes), report).unwrap_or_default()
}

fn understood(
    asked: &Asked<'_>,
    proposal: &Proposal,
    (ink, classes): (&Ink, &[Classified]),
    report: &mut Report,
) -> Result<Reading, Cancelled> {
    let is_wanted = || asked.cancel.check();
    is_wanted()?;
    let off = asked.off;
    let mut draft = Draft::new(ink, classes, asked.kept);
    if let Some(kind) = proposal.kind {
        draft.kind = Some(kind);
        rules::take_for(&mut draft, kind);
    }
    if let Some(structure) = &proposal.structure {
        draft.settle(structure);
    }
    draft.is_cut = proposal.is_cut;
    rules::apply(&mut draft, off);
    draft.contours();
    draft.find_soil();
    outlines::trunk_sides(&mut draft);
    outlines::bodies(&mut draft);
    outlines::crowns(&mut draft, report);
    is_wanted()?;
    draft.blades();
    is_wanted()?;
    if !off.contains(&GREEN_LEAVES) {
        draft.green_leaves();
    }
    draft.veined_leaves();
    let discs = flowers::discs(&draft);
    flowers::corollas(&mut draft, &discs);
    if draft.kind.is_some_and(bears_no_flower) {
        draft.blades.iter_mut().for_each(|b| b.leaf = true);
    }
    outlines::scribbled_trunk(&mut draft);
    draft.scribbled_crowns(report);
    let mut veins = veins::collect(&mut draft, off);
    draft.trim_at_pots();
    draft.last_resort(&discs, report);
    let thorns = outlines::thorns(&mut draft);
    attach::fronds(&mut draft);
    attach::rays(&mut draft, &discs);
    attach::grass_blades(&mut draft);
    let (discs, nuts) = attach::part_discs(&draft, discs);
    let bearers = flowers::Bearers::new(&draft);
    is_wanted()?;
    let (mut flowers, roots) = flowers::gather(&mut draft, &discs, &bearers);
    is_wanted()?;
    attach::stamens(&mut draft, &mut flowers, &roots, &mut veins);
    outlines::lobes(&mut draft);
    let mut fruits = draft.fruits(&nuts);
    let hints = draft.hints(&flowers.iter().map(|f| f.centre).collect::<Vec<_>>());
    let lines = std::mem::take(&mut draft.lines);
    draft.forest.grow(lines, &hints);
    is_wanted()?;
    attach::roots(&mut draft);
    let region_bearers = outlines::bear_regions(&mut draft);
    let (flowers, leaves) = attach::organs(&mut draft, flowers, &roots, veins, &hints.soil);
    is_wanted()?;
    attach::fruits(&mut draft, &mut fruits);
    Ok(draft.finish(region_bearers, flowers, leaves, fruits, thorns))
}
