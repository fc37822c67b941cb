//! Takes flowers apart whose petals the rest of the plant shows to be leaves: similar blades are of one kind.
//!
//! A cluster of roots is a flower (He and Cheng 2021, section 4.1). But so is the end of a pinnate leaf, where the
//! last leaflets begin in one place, and the rosette at the foot of a stem. The rest of the plant distinguishes them:
//! leaflets are like all the others, and a rosette lies where a stem begins.

use base::{LiteMap, ops};
use geom::{closest_on_polyline, distance_to_polyline, polyline_length, signed_area};
use glam::DVec2;

use crate::blade::Sheetlet;
use crate::branches::Line;
use crate::draft::{Draft, FlowerDraft};
use crate::structure::{slenderness, widest_gap};
use crate::thresholds::WELL_SHORT;

/// A drawing of fewer strokes is still growing: the rest of its plant cannot decide yet.
pub(crate) const FEWEST_STROKES: usize = 10;

/// When flowers are leaves.
struct CoherenceLimits {
    /// Blades are alike if neither has more than this many times the area of the other,
    area: f64,
    /// and their slenderness (width over length, 0 to 1) differs by less than this.
    slenderness: f64,
    /// Petals are leaves if at least this many leaves are like them,
    fewest_leaves: usize,
    /// and more than this many times all petals that are like them,
    outnumbered: f64,
    /// unless they stand all round their middle, with no wider angle between two, radians, and nothing like them
    /// touches them.
    ring: f64,
    /// More than this factor of leaves to petals decides, however the petals stand.
    far_outnumbered: f64,
    /// Blades touch if their outlines come nearer to one another than this share of their size.
    touching: f64,
    /// More blades are not compared with one another.
    most_blades: usize,
    /// The middle of a rosette lies within this share of the usual blade of the foot of its stem,
    at_foot: f64,
    /// and the stem rises above it by this factor of the usual blade.
    rises: f64,
    /// The foot of that stem is the lowest point of all lines, but for this share of the height of all,
    lowest: f64,
    /// and the blades of the rosette do not hang: the sine of the mean of their elevations is above this.
    hanging: f64,
    /// A whorl stands on a stem that leads on from it by more than this share of the usual blade,
    leads_on: f64,
    /// passes its middle within this share of that,
    on_line: f64,
    /// to both sides (the cosine of the angle between its ways),
    opposite: f64,
    /// leaves no angle wider than this free, radians,
    whorl_ring: f64,
    /// and there are at least this many whorls: one may be a flower in front of its stem.
    whorls: usize,
    /// Stamens lie within this factor of the usual blade from the centre of their flower,
    stamens: f64,
    /// and there are at least this many.
    fewest_stamens: usize,
    /// At least this many clusters of three blades all round at the ends of lines are trifoliate leaves: few flowers
    /// have three petals.
    trifoliate: usize,
    /// Three blades stand all round with no wider angle between two, radians.
    thirds: f64,
    /// A palmate leaf has at least this many leaflets,
    fewest_leaflets: usize,
    /// leaves a gap of more than this factor of the usual angle between two of them
    palmate_gap: f64,
    /// but less than this angle, radians: a flower from the side leaves half a turn free,
    palmate_open: f64,
    /// where its petiole comes from, within this angle (the cosine).
    palmate_way: f64,
    /// A petiole leads away from its blade by more than this share of the usual blade,
    petiole: f64,
    /// ends on the blade, and begins where the other petioles do, both within this share.
    petiole_near: f64,
    /// At least this many blades have one.
    fewest_petioles: usize,
    /// Blades without a stem are a rosette seen from above if other blades outnumber them by more than this factor.
    rosette: f64,
    /// Points of an outline that are compared with another one.
    places: usize,
}

const LIMITS: CoherenceLimits = CoherenceLimits {
    area: 2.2,
    slenderness: 0.2,
    fewest_leaves: 6,
    outnumbered: 2.0,
    ring: 1.9,
    far_outnumbered: 6.0,
    touching: 0.1,
    most_blades: 400,
    at_foot: 0.5,
    rises: 1.2,
    lowest: 0.12,
    hanging: -0.25,
    leads_on: 0.5,
    on_line: 0.7,
    opposite: -0.7,
    whorl_ring: 3.4,
    whorls: 2,
    stamens: 1.5,
    fewest_stamens: 3,
    trifoliate: 2,
    thirds: 2.9,
    fewest_leaflets: 5,
    palmate_gap: 1.7,
    palmate_open: 2.4,
    palmate_way: 0.7,
    petiole: 0.15,
    petiole_near: 0.1,
    fewest_petioles: 3,
    rosette: 2.0,
    places: 24,
};

/// The form of a blade.
struct Form {
    area: f64,
    slenderness: f64,
}

impl Form {
    fn from_blade(blade: &Sheetlet) -> Self {
        Self { area: signed_area(&blade.outline).abs(), slenderness: slenderness(&blade.outline) }
    }

    fn is_like(&self, other: &Self) -> bool {
        let ratio = self.area / other.area.max(f64::MIN_POSITIVE);
        (1.0 / LIMITS.area..LIMITS.area).contains(&ratio)
            && (self.slenderness - other.slenderness).abs() < LIMITS.slenderness
    }
}

/// Takes flowers apart whose petals are leaves; returns the rows of those blades. Flowers with a disc or stamens
/// stay, and so do those that a reader or the structure knows as a whole. Cost: pairs of blades, at most some hundred
/// blades.
pub(crate) fn dissolve(draft: &Draft<'_>, flowers: &mut Vec<FlowerDraft>, usual: f64) -> Vec<usize> {
    let mut freed = Vec::new();
    let is_sure = |f: &FlowerDraft| f.disc.is_some() || !f.stamens.is_empty() || is_known(draft, f);
    let mut are_leaves: Vec<bool> = flowers
        .iter()
        .map(|f| {
            !is_sure(f)
                && (is_at_foot(draft, f, usual)
                    || is_palmate(draft, f, usual)
                    || has_petioles(draft, &f.petals))
        })
        .collect();
    let rows = |is_one: &dyn Fn(&FlowerDraft) -> bool| -> Vec<usize> {
        (0..flowers.len()).filter(|&k| !is_sure(&flowers[k]) && is_one(&flowers[k])).collect()
    };
    let is_whorl = |f: &FlowerDraft| {
        widest_gap(directions(draft, f)) < LIMITS.whorl_ring && stands_along(draft, f.centre, usual)
    };
    let whorls = rows(&is_whorl);
    if whorls.len() >= LIMITS.whorls {
        whorls.into_iter().for_each(|k| are_leaves[k] = true);
    }
    let is_three = |f: &FlowerDraft| {
        f.petals.len() == 3
            && widest_gap(directions(draft, f)) < LIMITS.thirds
            && !has_stamens(draft, f, usual)
    };
    let threes = rows(&is_three);
    if threes.len() >= LIMITS.trifoliate {
        threes.into_iter().for_each(|k| are_leaves[k] = true);
    }
    let mut row = 0;
    flowers.retain(|f| {
        row += 1;
        if are_leaves[row - 1] {
            freed.extend(f.petals.iter().copied());
        }
        !are_leaves[row - 1]
    });
    if draft.blades.len() > LIMITS.most_blades {
        return freed;
    }
    let forms: Vec<Form> = draft.blades.iter().map(Form::from_blade).collect();
    let mut is_petal = vec![false; forms.len()];
    flowers.iter().flat_map(|f| &f.petals).for_each(|&i| is_petal[i] = true);
    flowers.retain(|f| {
        let are_leaves = !is_sure(f)
            && (are_outnumbered(draft, &forms, &is_petal, f) || is_heart_of_rosette(draft, &is_petal, f));
        if are_leaves {
            freed.extend(f.petals.iter().copied());
        }
        !are_leaves
    });
    freed
}

/// Whether most of the blades stand each on a line of its own, and these lines begin in one place: leaves on
/// petioles. Petals have no petioles.
pub(crate) fn has_petioles(draft: &Draft<'_>, blades: &[usize]) -> bool {
    let Some(usual) = base::median(blades.iter().map(|&i| draft.blades[i].size).collect()) else {
        return false;
    };
    // Each line is the petiole of one blade.
    let mut feet: LiteMap<usize, DVec2> = LiteMap::new();
    for &i in blades {
        let drawn = &draft.ink.strokes[draft.blades[i].stroke].points;
        let mut own = draft.lines.iter().enumerate().filter(|(row, _)| !feet.contains_key(row));
        let petiole = own.find_map(|(row, line)| Some((row, petiole_foot(line, drawn, usual)?)));
        feet.extend(petiole);
    }
    let together =
        |p: &DVec2| feet.values().filter(|foot| foot.distance(*p) < LIMITS.petiole_near * usual).count();
    let stalked = feet.values().map(together).max().unwrap_or(0);
    stalked >= LIMITS.fewest_petioles && 2 * stalked > blades.len()
}

/// Returns where a line begins that ends on the outline of a blade and leads away from it, if it does. `usual`: the
/// size of blades.
fn petiole_foot(line: &Line, drawn: &[DVec2], usual: f64) -> Option<DVec2> {
    let off = |p: DVec2| distance_to_polyline(drawn, p).unwrap_or(f64::INFINITY);
    let (a, b) = (line.points[0], line.points[line.points.len() - 1]);
    let (foot, end) = if off(a) < off(b) { (b, a) } else { (a, b) };
    let is_petiole = off(end) < LIMITS.petiole_near * usual && off(foot) > LIMITS.petiole * usual;
    is_petiole.then_some(foot)
}

/// Whether lines shorter than a blade begin near the middle: stamens, which leaves have not.
fn has_stamens(draft: &Draft<'_>, flower: &FlowerDraft, usual: f64) -> bool {
    let is_stamen = |line: &&Line| {
        let ends = [line.points[0], line.points[line.points.len() - 1]];
        ends.iter().all(|p| p.distance(flower.centre) < LIMITS.stamens * usual)
            && polyline_length(&line.points) < usual
    };
    draft.lines.iter().filter(is_stamen).count() >= LIMITS.fewest_stamens
}

/// Whether the blades stand in a pot without any stem: a house plant whose leaves come from one place.
pub(crate) fn is_tuft_in_pot(draft: &Draft<'_>, flower: &FlowerDraft) -> bool {
    let is_sure = flower.disc.is_some() || is_known(draft, flower);
    !is_sure && draft.lines.is_empty() && draft.class.contains(&ink::StrokeClass::Pot)
}

fn is_known(draft: &Draft<'_>, flower: &FlowerDraft) -> bool {
    flower.petals.iter().any(|&i| draft.heads.iter().any(|h| h.contains(&draft.blades[i].stroke)))
}

/// Whether the blades stand round the foot of a stem that leads up from them, where the plant begins.
fn is_at_foot(draft: &Draft<'_>, flower: &FlowerDraft, usual: f64) -> bool {
    // Leaves at the foot are larger than florets.
    let own = base::median(flower.petals.iter().map(|&i| draft.blades[i].size).collect());
    let usual = usual.max(own.unwrap_or(usual));
    let points = || draft.lines.iter().flat_map(|l| &l.points).map(|p| p.y);
    let (low, high) = points().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), y| (l.min(y), h.max(y)));
    let (Some(sum), count) = (directions(draft, flower).reduce(|a, b| a + b), flower.petals.len()) else {
        return false;
    };
    #[expect(clippy::cast_precision_loss, reason = "petals")]
    let elevation = sum.y / count as f64;
    elevation > LIMITS.hanging
        && draft.lines.iter().any(|line| {
            let (a, b) = (line.points[0], line.points[line.points.len() - 1]);
            let (foot, top) = if a.y < b.y { (a, b) } else { (b, a) };
            foot.distance(flower.centre) < LIMITS.at_foot * usual
                && top.y - flower.centre.y > LIMITS.rises * usual
                && foot.y < low + LIMITS.lowest * (high - low)
        })
}

fn directions<'a>(draft: &'a Draft<'_>, flower: &'a FlowerDraft) -> impl Iterator<Item = DVec2> + 'a {
    flower.petals.iter().map(|&i| (draft.blades[i].middle - flower.centre).normalize_or_zero())
}

/// Whether a stem leads on to both sides of the blades: in one line, or in two that the blades interrupt.
pub(crate) fn stands_along(draft: &Draft<'_>, centre: DVec2, usual: f64) -> bool {
    let mut ways: Vec<DVec2> = Vec::new();
    for line in &draft.lines {
        let Some(place) = closest_on_polyline(&line.points, centre) else { continue };
        if place.point.distance(centre) > LIMITS.on_line * usual {
            continue;
        }
        let ends = [line.points[0], line.points[line.points.len() - 1]];
        let leads_on = ends.into_iter().filter(|p| p.distance(place.point) > LIMITS.leads_on * usual);
        ways.extend(leads_on.map(|p| (p - centre).normalize_or_zero()));
    }
    ways.iter().any(|a| ways.iter().any(|b| a.dot(*b) < LIMITS.opposite))
}

/// Whether the blades leave a gap in the direction of a line that ends at their middle and begins at another line.
fn is_palmate(draft: &Draft<'_>, flower: &FlowerDraft, usual: f64) -> bool {
    if flower.petals.len() < LIMITS.fewest_leaflets {
        return false;
    }
    let mut angles: Vec<f64> = directions(draft, flower).map(|d| ops::atan2(d.y, d.x)).collect();
    base::sort_numbers(&mut angles);
    let turned = angles.iter().skip(1).copied().chain(angles.first().map(|a| a + ops::TAU));
    let gaps: Vec<(f64, f64)> = angles.iter().zip(turned).map(|(a, b)| (b - a, 0.5 * (a + b))).collect();
    let (Some(&(widest, way)), Some(median)) =
        (gaps.iter().max_by(|a, b| a.0.total_cmp(&b.0)), base::median(gaps.iter().map(|g| g.0).collect()))
    else {
        return false;
    };
    let way = DVec2::new(ops::cos(way), ops::sin(way));
    let leads_here = |row: usize| {
        let points = &draft.lines[row].points;
        let (a, b) = (points[0], points[points.len() - 1]);
        let (near, far) = if a.distance(flower.centre) < b.distance(flower.centre) { (a, b) } else { (b, a) };
        let is_borne = (0..draft.lines.len()).filter(|&other| other != row).any(|other| {
            distance_to_polyline(&draft.lines[other].points, far).is_some_and(|d| d < WELL_SHORT)
        });
        near.distance(flower.centre) < LIMITS.at_foot * usual
            && (far - flower.centre).normalize_or_zero().dot(way) > LIMITS.palmate_way
            && is_borne
    };
    let is_fan = widest > LIMITS.palmate_gap * median && widest < LIMITS.palmate_open;
    is_fan && (0..draft.lines.len()).any(leads_here)
}

/// Whether most blades that are like these petals are leaves, and nothing else suggests that these are a flower.
fn are_outnumbered(draft: &Draft<'_>, forms: &[Form], is_petal: &[bool], flower: &FlowerDraft) -> bool {
    let Some(model) = median_petal(forms, flower) else { return false };
    let alike: Vec<usize> = (0..forms.len()).filter(|&i| forms[model].is_like(&forms[i])).collect();
    let petals = alike.iter().filter(|&&i| is_petal[i]).count();
    let leaves = alike.len() - petals;
    #[expect(clippy::cast_precision_loss, reason = "blades")]
    let are_more = |times: f64| leaves >= LIMITS.fewest_leaves && leaves as f64 > times * petals as f64;
    let is_open = || widest_gap(directions(draft, flower)) > LIMITS.ring;
    let is_surrounded = || {
        let touched = |&&i: &&usize| {
            !is_petal[i] && flower.petals.iter().any(|&p| touch(&draft.blades[i], &draft.blades[p]))
        };
        alike.iter().filter(touched).count() >= flower.petals.len()
    };
    are_more(LIMITS.outnumbered) && (are_more(LIMITS.far_outnumbered) || is_open() || is_surrounded())
}

/// Whether there is no stem, and many more blades stand all round: the youngest leaves in the middle are leaves as
/// well.
fn is_heart_of_rosette(draft: &Draft<'_>, is_petal: &[bool], flower: &FlowerDraft) -> bool {
    let others = || draft.blades.iter().zip(is_petal).filter(|(_, is_petal)| !**is_petal).map(|(b, _)| b);
    let count = others().count();
    #[expect(clippy::cast_precision_loss, reason = "blades")]
    let are_many =
        count >= LIMITS.fewest_leaves && count as f64 > LIMITS.rosette * flower.petals.len() as f64;
    draft.lines.is_empty()
        && are_many
        && widest_gap(others().map(|b| (b.middle - flower.centre).normalize_or_zero())) < LIMITS.ring
}

/// Returns the petal of the median area.
fn median_petal(forms: &[Form], flower: &FlowerDraft) -> Option<usize> {
    let mut petals = flower.petals.clone();
    base::sort_by(&mut petals, |&a, &b| forms[a].area.total_cmp(&forms[b].area).then(a.cmp(&b)));
    petals.get(petals.len() / 2).copied()
}

fn touch(a: &Sheetlet, b: &Sheetlet) -> bool {
    a.touches(b, LIMITS.touching * a.size.min(b.size), LIMITS.places)
}
