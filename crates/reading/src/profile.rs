//! Flowers in profile: petals that overlap one another at the end of a stem.
//!
//! Their roots are hidden behind the petals in front, so that no cluster of roots shows (He and Cheng 2021, section
//! 4.1). But leaves seldom cover one another at the tip of a stem, and petals of a cup always do.

use glam::DVec2;

use crate::blade::Sheetlet;
use crate::coherence::{has_petioles, stands_along};
use crate::contour::width_at;
use crate::draft::{Draft, FlowerDraft};
use crate::structure::{slenderness, widest_gap};
use crate::thresholds::FEWEST_PETALS;

/// Limits of blades at the end of a stem that are a flower in profile.
struct ProfileLimits {
    /// Petals come this near to the end of their stem, as a share of their size,
    at_tip: f64,
    /// lie beyond it by more than this share,
    beyond: f64,
    /// and leave more than this angle free, radians, where the stem comes from:
    behind: f64,
    /// fewer of them leave more than this, because the leaflets of a leaf of three spread as far as the petals of a
    /// wide cup;
    behind_few: f64,
    few: usize,
    /// They are wider than this share of their length: narrow leaves cover one another at the tips of grasses.
    slenderness: f64,
    /// A stem that leads up ends higher than this share of the height of all blades: lower blades are a tuft of
    /// leaves.
    lowest: f64,
    /// The stem is longer than this share of the largest blade,
    stem: f64,
    /// and ends at nothing else within this distance.
    free: f64,
    /// At least this many of them go on behind others.
    fewest_hidden: usize,
    /// Petals that are farther back touch one in front of them within this share of its size.
    touching: f64,
    /// Such petals lie within this factor of the largest petal's size from the end of the stem.
    reach: f64,
    /// The direction of a stem at its end is that of its last part of this length, ink units.
    heading: f64,
    /// With more blades or lines a drawing is no single flower: nothing is looked for.
    most_blades: usize,
    most_lines: usize,
    /// Points of an outline that are compared with another one.
    places: usize,
}

const LIMITS: ProfileLimits = ProfileLimits {
    at_tip: 0.3,
    beyond: 0.15,
    behind: 3.0,
    behind_few: 4.5,
    few: 4,
    slenderness: 0.33,
    lowest: 0.15,
    stem: 0.5,
    free: 0.02,
    fewest_hidden: 2,
    touching: 0.06,
    reach: 1.1,
    heading: 0.04,
    most_blades: 400,
    most_lines: 400,
    places: 32,
};

/// Limits of an outline that is a bell or a tube: a corolla of united petals in profile.
struct BellLimits {
    /// A bell is open where a leaf narrows to its tip: at the first share of its length it has at least the second
    /// share of its greatest width (an ellipse has 0.6 there),
    mouth: [f64; 2],
    /// and it narrows to its base less than a fan does.
    base: [f64; 2],
    /// Its length is at least this factor of its width.
    long: f64,
    /// At least this many similar outlines are flowers,
    fewest: usize,
    /// if more than this share of all similar outlines has the form.
    share: f64,
    /// Outlines are alike if neither is longer than the other by more than this factor.
    alike: f64,
}

const BELLS: BellLimits =
    BellLimits { mouth: [0.9, 0.75], base: [0.25, 0.4], long: 0.9, fewest: 3, share: 0.6, alike: 1.8 };

/// The end of a stem and the direction in which it ends.
struct Tip {
    at: DVec2,
    way: DVec2,
    /// The line of the draft; `None` for a stem that was drawn as an outline.
    line: Option<usize>,
    /// Length of the stem.
    length: f64,
}

/// Gathers petals in profile that belong to no flower yet; gives each its root. Cost: ends of lines times blades, at
/// most some hundred blades.
pub(crate) fn gather(
    draft: &mut Draft<'_>,
    flowers: &mut Vec<FlowerDraft>,
    roots: &mut [Option<DVec2>],
    taken: &mut [bool],
) {
    if draft.hidden.is_empty()
        || draft.blades.len() > LIMITS.most_blades
        || draft.lines.len() > LIMITS.most_lines
    {
        return;
    }
    for tip in tips(draft) {
        let petals = petals_at(draft, &tip, taken);
        if !is_flower(draft, &tip, &petals) || has_petioles(draft, &petals) {
            continue;
        }
        for &i in &petals {
            taken[i] = true;
            let (root, away) = draft.blades[i].nearest(tip.at);
            let is_apart = away > LIMITS.at_tip * draft.blades[i].size;
            roots[i] = Some(if is_apart { draft.blades[i].claw(root, tip.at) } else { root });
        }
        flowers.push(FlowerDraft { centre: tip.at, petals, ..FlowerDraft::default() });
    }
}

/// Whether blades at the end of a stem are a flower, not leaves.
fn is_flower(draft: &Draft<'_>, tip: &Tip, petals: &[usize]) -> bool {
    let blade = |i: &usize| &draft.blades[*i];
    let hidden = petals.iter().filter(|i| draft.hidden.contains_key(&blade(i).stroke)).count();
    if petals.len() < FEWEST_PETALS || hidden < LIMITS.fewest_hidden {
        return false;
    }
    let gap = widest_gap(petals.iter().map(|i| blade(i).middle - tip.at));
    let behind = if petals.len() > LIMITS.few { LIMITS.behind } else { LIMITS.behind_few };
    let widths = petals.iter().map(|i| slenderness(&blade(i).outline)).collect();
    let largest = petals.iter().map(|i| blade(i).size).fold(0.0, f64::max);
    gap > behind
        && base::median(widths).is_some_and(|s| s > LIMITS.slenderness)
        && tip.length > LIMITS.stem * largest
        && !is_at_ground(draft, tip)
        && !stands_along(draft, tip.at, largest)
        && is_free(draft, tip, largest)
}

/// Whether the end of a stem that leads up lies where the plant begins.
fn is_at_ground(draft: &Draft<'_>, tip: &Tip) -> bool {
    let heights = || draft.blades.iter().flat_map(|b| &b.outline).map(|p| p.y);
    let (low, high) = heights().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), y| (l.min(y), h.max(y)));
    tip.way.y > 0.0 && tip.at.y < low + LIMITS.lowest * (high - low)
}

/// Whether no other stem ends or passes at the end of this one.
fn is_free(draft: &Draft<'_>, tip: &Tip, largest: f64) -> bool {
    let others = draft.lines.iter().enumerate().filter(|(row, _)| Some(*row) != tip.line);
    let mut stems = others.filter(|(_, l)| geom::polyline_length(&l.points) > LIMITS.stem * largest);
    !stems.any(|(_, l)| geom::distance_to_polyline(&l.points, tip.at).is_some_and(|d| d < LIMITS.free))
}

/// Returns both ends of all lines, and the tops of outlined stems: the blades beyond an end show whether it bears a
/// flower.
fn tips(draft: &Draft<'_>) -> Vec<Tip> {
    let tip = |points: &[DVec2], line: Option<usize>, is_last: bool| {
        let length = geom::polyline_length(points);
        let (at, before) = if is_last {
            (points[points.len() - 1], geom::point_at(points, (length - LIMITS.heading).max(0.0))?)
        } else {
            (points[0], geom::point_at(points, LIMITS.heading.min(length))?)
        };
        Some(Tip { at, way: (at - before).try_normalize()?, line, length })
    };
    let lines = draft.lines.iter().enumerate();
    let of_lines = lines.flat_map(|(row, l)| [true, false].map(|is_last| tip(&l.points, Some(row), is_last)));
    let of_bodies = draft.bodies.iter().map(|&row| tip(&draft.forest.axes[row].points, None, true));
    of_lines.chain(of_bodies).flatten().collect()
}

/// Returns free blades at the end of a stem and beyond it, and those behind them.
fn petals_at(draft: &Draft<'_>, tip: &Tip, taken: &[bool]) -> Vec<usize> {
    let is_beyond = |b: &Sheetlet| (b.middle - tip.at).dot(tip.way) > LIMITS.beyond * b.size;
    let mut petals: Vec<usize> = (0..draft.blades.len())
        .filter(|&i| {
            let blade = &draft.blades[i];
            !taken[i] && is_beyond(blade) && blade.nearest(tip.at).1 < LIMITS.at_tip * blade.size
        })
        .collect();
    let largest = petals.iter().map(|&i| draft.blades[i].size).fold(0.0, f64::max);
    let mut k = 0;
    while let Some(&front) = petals.get(k) {
        k += 1;
        for (i, blade) in draft.blades.iter().enumerate() {
            let is_near = blade.middle.distance(tip.at) < LIMITS.reach * largest;
            let is_hidden = draft.hidden.contains_key(&blade.stroke);
            if !taken[i]
                && is_hidden
                && is_near
                && is_beyond(blade)
                && !petals.contains(&i)
                && blade.touches(
                    &draft.blades[front],
                    LIMITS.touching * draft.blades[front].size,
                    LIMITS.places,
                )
            {
                petals.push(i);
            }
        }
    }
    petals
}

/// Makes a flower of each outline that is a bell, if several are alike. `roots`: where blades are attached.
pub(crate) fn bells(draft: &Draft<'_>, flowers: &mut Vec<FlowerDraft>, roots: &[DVec2], taken: &[bool]) {
    if draft.blades.len() > LIMITS.most_blades {
        return;
    }
    let is_petal = |i: usize| flowers.iter().any(|f| f.petals.contains(&i));
    let free: Vec<usize> = (0..draft.blades.len()).filter(|&i| !taken[i] && !is_petal(i)).collect();
    let is_bell: Vec<bool> = free.iter().map(|&i| is_bell(&draft.blades[i], roots[i])).collect();
    let mut found = Vec::new();
    for (k, &i) in free.iter().enumerate().filter(|(k, _)| is_bell[*k]) {
        let size = draft.blades[i].size;
        let is_alike = |j: &&usize| {
            let ratio = draft.blades[**j].size / size;
            (1.0 / BELLS.alike..BELLS.alike).contains(&ratio)
        };
        let alike = free.iter().filter(is_alike).count();
        let bells = free.iter().zip(&is_bell).filter(|(j, bell)| **bell && is_alike(j)).count();
        #[expect(clippy::cast_precision_loss, reason = "blades")]
        let is_usual = bells as f64 >= BELLS.share * alike as f64;
        if bells >= BELLS.fewest && is_usual {
            found.push(free[k]);
        }
    }
    for i in found {
        flowers.push(FlowerDraft { centre: roots[i], petals: vec![i], ..FlowerDraft::default() });
    }
}

/// Whether a blade is wide at the end that is far from its root, and not narrow at the other.
fn is_bell(blade: &Sheetlet, root: DVec2) -> bool {
    let Some(along) = (blade.middle - root).try_normalize() else { return false };
    let across = along.perp();
    let local: Vec<DVec2> =
        blade.outline.iter().map(|&p| DVec2::new((p - root).dot(across), (p - root).dot(along))).collect();
    let Some((low, high)) = geom::bounds(&local) else { return false };
    let (long, wide) = (high.y - low.y, high.x - low.x);
    let width = |share: f64| width_at(&local, low.y + share * long);
    long > BELLS.long * wide
        && width(BELLS.mouth[0]) > BELLS.mouth[1] * wide
        && width(BELLS.base[0]) > BELLS.base[1] * wide
}
