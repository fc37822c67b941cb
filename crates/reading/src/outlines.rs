//! Trunks and crowns drawn as outlines (product A12).

use base::{Report, ops};
use geom::{bounds, centroid, contains, convex_hull, distance_to_polyline, polyline_length, signed_area};
use glam::DVec2;
use ink::{Source, StrokeClass};
use plant::AxisKind;

use crate::blade::{nearest_on_ring, split_stalks};
use crate::body::{limbs, ribbon};
use crate::branches::{Forest, Line};
use crate::contour::{crown_outline, neck};
use crate::draft::{Draft, MOST_REGIONS, RegionDraft};
use crate::kept::{alike, same_bits};
use crate::rings::{Ring, rings, rings_and_arms};
use crate::thresholds::{SAME_PLACE, STOPPED_SHORT, STRAIGHT, WELL_SHORT};
use crate::{Attachment, Kind, OrganWord, READ_AS, RegionKind};

/// More bodies than this are scribbles: the smaller ones become plain lines (keeps the work linear).
const MOST_BODIES: usize = 100;
/// A body's outline is thinner than this share of its length: a line.
const THIN: f64 = 0.008;
/// The base of an arm is this near to the body.
const ARM: f64 = 0.03;
/// One side of it may end this far off.
const OVERSHOT: f64 = 0.12;
/// The crown of a stroke drawn in one go with sides of a trunk closes where the stroke comes nearer to itself than
/// this share of the gap between its ends.
const SIDE_NEAR: f64 = 0.75;
/// A side of a trunk in such a stroke is straighter than this: its chord over its length.
const SIDE_STRAIGHT: f64 = 0.75;
/// The second side of a trunk is at least this share of the first one long.
const SIDES_ALIKE: f64 = 0.5;
/// A line that ends within this distance of the foot of a crown ends at it: four steps of the pen (*sampled*). A
/// trunk is wider.
const FOOT: f64 = 0.02;
/// A part that hangs below a crown by more than this is its trunk.
const HANGS: f64 = 0.08;
/// The only gap of half a body is wider than this share of the body's height.
const GAP: f64 = 0.1;
/// The top of that gap lies higher than its foot by more than this share of the height.
const LEFT_OFF: f64 = 0.3;
/// The foot of that gap lies in this lowest share of the height.
const AT_FOOT: f64 = 0.08;
/// The top of that gap lies this far to the side of its foot, as a share of the height.
const SLANTS: f64 = 0.04;
/// An axis that runs this deep into a contour, as a share of its size, bears it.
const DEEP: f64 = 0.3;
/// A trunk that goes on into a crown ends below this share of the crown's height above its heart.
const ABOVE_HEART: f64 = 0.25;
/// Such a trunk ends this near to the heart, as a share of the crown's size.
const LED: f64 = 0.35;
/// Least value of that distance.
const LED_LEAST: f64 = 0.05;
/// A crown nearer to the ground than this share of its own height stands on it.
const ON_GROUND: f64 = 0.2;
/// A crown higher above the ground than this share of the height needs a trunk of its own.
const NEEDS_TRUNK: f64 = 0.35;
/// A bush meets the ground with this lowest share of its height.
const MEETS_GROUND: f64 = 0.25;
/// A line belongs to a crown's outline if it begins and ends in the crown and more than this share of it runs outside
/// or along the outline.
const OF_IT: f64 = 0.5;
/// A point nearer to the outline than this lies along it.
const RIM: f64 = 0.025;
/// Shading is a trunk if its height is more than this factor of its width.
const SHADED: f64 = 1.2;
/// A thorn is shorter than this share of the body's height.
const THORN: f64 = 0.3;

/// Cuts sides of trunks off crown strokes: a loose end that runs straight down, or a part that hangs below the crown.
pub(crate) fn trunk_sides(draft: &mut Draft<'_>) {
    // If the trunk has two lines of its own, a part that hangs below is a second round of the crown.
    if draft.trunk || draft.is_cut {
        return;
    }
    let ink = draft.ink;
    for k in draft.strokes_of_class(StrokeClass::Crown).into_iter().take(MOST_REGIONS) {
        let (crown, ends) = split_stalks(&ink.strokes[k].points, SIDE_NEAR);
        let foot = bounds(&crown).map_or(0.0, |b| b.0.y);
        let side = |l: &Vec<DVec2>| {
            let (free, at) = (l[0], l[l.len() - 1]);
            free.y < foot + FOOT
                && at.y - free.y > WELL_SHORT
                && free.distance(at) > SIDE_STRAIGHT * polyline_length(l)
        };
        if !ends.is_empty() && ends.iter().all(side) {
            draft.sides.extend(ends.into_iter().map(|l| (k, l)));
            draft.loops.insert(k, crown);
            continue;
        }
        let points = &ink.strokes[k].points;
        let Some((outline, low)) = crown_outline(points).and_then(|o| bounds(&o).map(|b| (o, b.0.y))) else {
            continue;
        };
        let below: Vec<DVec2> = points.iter().copied().filter(|p| p.y < low - SAME_PLACE).collect();
        if bounds(&below).is_some_and(|(lo, hi)| hi.y - lo.y > HANGS && hi.x - lo.x > FOOT) {
            draft.sides.push((k, below));
            draft.loops.insert(k, outline);
        }
    }
    other_side(draft);
}

/// Finds the second side of a trunk whose first was drawn in a stroke with the crown: a line next to it, about as
/// long.
fn other_side(draft: &mut Draft<'_>) {
    let [(crown, side)] = &draft.sides[..] else { return };
    let (a, b) = (side[0], side[side.len() - 1]);
    let (top, foot) = if a.y > b.y { (a, b) } else { (b, a) };
    let long = top.distance(foot);
    let beside = |&k: &usize| {
        let p = &draft.ink.strokes[k].points;
        let (a, b) = (p[0], p[p.len() - 1]);
        let (own_top, own_foot) = if a.y > b.y { (a, b) } else { (b, a) };
        let own = own_top.distance(own_foot);
        let apart = own_top.distance(top).max(own_foot.distance(foot));
        k != *crown
            && own.min(long) > SIDES_ALIKE * own.max(long)
            && apart < own.max(long)
            && own_top.y - own_foot.y > SIDE_STRAIGHT * polyline_length(p)
    };
    let mut lines = draft.strokes_of_class(StrokeClass::Axis).into_iter().filter(beside);
    if let (Some(k), None) = (lines.next(), lines.next()) {
        draft.class[k] = StrokeClass::TrunkOutline;
    }
}

/// Reads trunk outlines into axes with half widths; an outline that is no body becomes a line of the draft.
pub(crate) fn bodies(draft: &mut Draft<'_>) {
    let sides = std::mem::take(&mut draft.sides);
    let ink = draft.ink;
    let mut strokes = draft.strokes_of_class(StrokeClass::TrunkOutline);
    let mut points: Vec<&[DVec2]> = strokes.iter().map(|&k| ink.strokes[k].points.as_slice()).collect();
    strokes.extend(sides.iter().map(|s| s.0));
    points.extend(sides.iter().map(|s| s.1.as_slice()));
    let as_lines = |draft: &mut Draft<'_>, ring: &Ring| {
        for &part in &ring.parts {
            let k = strokes[part];
            draft.organ[k] = OrganWord::Trunk;
            draft.lines.push(Line { points: points[part].to_vec(), source: Some(ink.strokes[k].index) });
        }
    };
    let mut found: Vec<(f64, Ring)> = Vec::new();
    let alone = !draft.class.iter().any(|c| [StrokeClass::Blade, StrokeClass::Crown].contains(c));
    for mut ring in rings_and_arms(&points) {
        if alone {
            plumb(&mut ring);
        }
        // The trunk of a palm may be one line; it is as thick as it would be drawn.
        if draft.kind == Some(Kind::Palm) && ring.parts.len() == 1 {
            let line = points[ring.parts[0]];
            if line[0].distance(line[line.len() - 1]) > STRAIGHT * polyline_length(line) {
                ring = thick(line, ring.parts);
            }
        }
        let area = signed_area(&ring.points).abs();
        let drawn: f64 = ring.drawn().iter().map(|d| polyline_length(d)).sum();
        if area > THIN * drawn * drawn && found.len() < MOST_BODIES {
            found.push((area, ring));
        } else {
            as_lines(draft, &ring);
        }
    }
    // The largest first: arms stand on it.
    base::sort_by(&mut found, |a, b| b.0.total_cmp(&a.0));
    for (i, (_, ring)) in found.iter().enumerate() {
        let base = arm_base(&draft.forest, ring, i > 0);
        let source = ring.parts.first().map(|&p| draft.ink.strokes[strokes[p]].index);
        let at = base.map(|b| b.1);
        let closed = draft.kept.borrow_mut().bodies.get(
            source.unwrap_or(0),
            |(points, gaps, base)| {
                let standing = match (base, at) {
                    (Some(a), Some(b)) => same_bits(*a, b),
                    (a, b) => a.is_none() && b.is_none(),
                };
                standing && *gaps == ring.gaps && alike(points, &ring.points)
            },
            || (ring.points.clone(), ring.gaps.clone(), at),
            || limbs(ring, at),
        );
        if closed.is_empty() {
            as_lines(draft, ring);
            continue;
        }
        draft.open_top |= draft.trunk || draft.is_tree() || closed.first().is_some_and(|l| !l.closed_end);
        let first = draft.forest.add_body(closed, base.map(|b| b.0), source);
        draft.bodies.extend(first.filter(|_| base.is_none()));
        for &part in &ring.parts {
            draft.organ[strokes[part]] = OrganWord::Trunk;
        }
    }
}

/// Turns a line into an outline that is open above, and narrower there.
fn thick(line: &[DVec2], parts: Vec<usize>) -> Ring {
    let up: Vec<DVec2> =
        if line[0].y < line[line.len() - 1].y { line.to_vec() } else { line.iter().rev().copied().collect() };
    let n = up.len();
    let half = |k: usize| (0.05 - 0.02 * k as f64 / n as f64) * up[0].distance(up[n - 1]);
    let points = ribbon(&up, &(0..n).map(half).collect::<Vec<_>>());
    Ring { points, parts, gaps: vec![n - 1] }
}

/// Closes an outline that was left off far above its foot straight down to it: half a body does not slant.
fn plumb(ring: &mut Ring) {
    let Some((lo, hi)) = bounds(&ring.points) else { return };
    let wide = |&g: &usize| {
        let (a, b) = ring.gap(ring.gaps[g]);
        a.distance(b) > GAP * (hi.y - lo.y)
    };
    let [at] = (0..ring.gaps.len()).filter(wide).collect::<Vec<_>>()[..] else { return };
    let gap = ring.gaps[at];
    let (a, b) = ring.gap(gap);
    let (top, foot) = if a.y > b.y { (a, b) } else { (b, a) };
    let high = top.y - foot.y > LEFT_OFF * (hi.y - lo.y) && foot.y < lo.y + AT_FOOT * (hi.y - lo.y);
    let wide = (top.x - foot.x).abs() > SLANTS * (hi.y - lo.y) && (top.x - foot.x).abs() < top.y - foot.y;
    if !(high && wide) {
        return;
    }
    ring.points.insert(gap + 1, DVec2::new(top.x, foot.y));
    // The part that stays open is the foot.
    ring.gaps[at] += usize::from(a.y > b.y);
    ring.gaps[at + 1..].iter_mut().for_each(|g| *g += 1);
}

/// Returns where an arm whose opening lies on a body stands: the bearer, and the middle of the opening.
fn arm_base(forest: &Forest, ring: &Ring, later: bool) -> Option<(Attachment, DVec2)> {
    if !later {
        return None;
    }
    ring.gaps.iter().find_map(|&g| {
        let (a, b) = ring.gap(g);
        let middle = a.midpoint(b);
        let touches = |p| forest.nearest(p, ARM).is_some();
        let (bearer, _) = forest.nearest(middle, ARM + 0.5 * a.distance(b))?;
        let beside = |p| forest.nearest(p, OVERSHOT).is_some();
        ((touches(a) && beside(b)) || (beside(a) && touches(b))).then_some((bearer, middle))
    })
}

/// Reads crown contours into regions; a trunk that was drawn in the same stroke is cut off and read as a body.
pub(crate) fn crowns(draft: &mut Draft<'_>, report: &mut Report) {
    let mut strokes = draft.strokes_of_class(StrokeClass::Crown);
    let loops = std::mem::take(&mut draft.loops);
    let united = std::mem::take(&mut draft.united);
    let around = united.iter().filter_map(|&k| crown_outline(&draft.ink.strokes[k].points));
    if let Some(outline) = union(&around.collect::<Vec<_>>()) {
        strokes.retain(|k| !united.contains(k));
        united.iter().for_each(|&k| draft.organ[k] = OrganWord::LeafContour);
        draft.add_region(outline, RegionKind::Crown, united[0]);
    }
    let points: Vec<&[DVec2]> = strokes
        .iter()
        .map(|k| loops.get(k).map_or(draft.ink.strokes[*k].points.as_slice(), Vec::as_slice))
        .collect();
    let mut left_out = 0;
    let is_tree = draft.is_tree() && draft.bodies.is_empty();
    for ring in rings(&points) {
        let Some(mut outline) = crown_outline(&ring.points) else {
            for &part in &ring.parts {
                draft.line_of(strokes[part], OrganWord::Branch);
            }
            continue;
        };
        let stroke = ring.parts.first().map_or(0, |&p| strokes[p]);
        if draft.bodies.len() < MOST_BODIES
            && draft.kind != Some(Kind::Bush)
            && !draft.is_cut
            && let Some((trunk, crown)) = neck(&outline, is_tree)
        {
            let source = Some(draft.ink.strokes[stroke].index);
            let bottom = Ring { gaps: Vec::new(), parts: Vec::new(), points: trunk };
            draft.open_top = true;
            // Below the neck there is nothing but the trunk: corners of a foot that flares are no limbs.
            let mut trunk = limbs(&bottom, None);
            trunk.truncate(1);
            let row = draft.forest.add_body(trunk, None, source);
            draft.bodies.extend(row);
            outline = crown;
        }
        if draft.regions.len() >= MOST_REGIONS {
            left_out += ring.parts.len();
            continue;
        }
        for &part in &ring.parts {
            draft.organ[strokes[part]] = OrganWord::LeafContour;
        }
        draft.add_region(outline, RegionKind::Crown, stroke);
    }
    if left_out > 0 {
        base::warn!(
            report,
            "crowns-skipped",
            { count = left_out, most = MOST_REGIONS },
            "{count} of the drawing's crown outlines were left out: {most} are read"
        );
    }
}

/// Gives lines that leave a crown and come back, or run along its outline, to that crown: they are no branches,
/// unless the user marked them as such.
pub(crate) fn lobes(draft: &mut Draft<'_>) {
    let lines = std::mem::take(&mut draft.lines);
    let mut regions = std::mem::take(&mut draft.regions);
    for line in lines {
        let points = &line.points;
        let stroke = line.source.and_then(|i| draft.ink.strokes.binary_search_by_key(&i, |s| s.index).ok());
        let stroke = stroke.filter(|k| draft.said[*k].source != Source::User && !draft.legs.contains_key(k));
        let crown = stroke.and_then(|k| Some((regions.iter_mut().find(|r| is_lobe(points, r))?, k)));
        let Some((crown, k)) = crown else {
            draft.lines.push(line);
            continue;
        };
        (draft.class[k], draft.rule[k]) = (StrokeClass::Crown, Some(READ_AS));
        draft.organ[k] = OrganWord::LeafContour;
        let whole = crown_outline(points).and_then(|lobe| union(&[crown.outline.clone(), lobe]));
        if let Some((outline, bounds)) = whole.and_then(|o| bounds(&o).map(|b| (o, b))) {
            (crown.outline, crown.bounds) = (outline, bounds);
        }
    }
    draft.regions = regions;
}

/// Whether a line begins and ends in a crown, and runs outside of it or along its outline.
fn is_lobe(points: &[DVec2], region: &RegionDraft) -> bool {
    let (lo, hi) = (region.bounds.0 - RIM, region.bounds.1 + RIM);
    let ring = &region.outline;
    let at_rim = |p: DVec2| nearest_on_ring(ring, p).1 < RIM;
    // Most lines of a large drawing are nowhere near.
    let meets = |p: DVec2| p.cmpge(lo).all() && p.cmple(hi).all() && (contains(ring, p) || at_rim(p));
    region.kind == RegionKind::Crown
        && meets(points[0])
        && meets(points[points.len() - 1])
        && points.iter().filter(|p| !contains(ring, **p) || at_rim(**p)).count() as f64
            > OF_IT * points.len() as f64
}

/// Returns the outline around several overlapping rings, as it is seen from their middle.
fn union(rings: &[Vec<DVec2>]) -> Option<Vec<DVec2>> {
    const RAYS: u32 = 180;
    let centre = centroid(&convex_hull(&rings.concat()));
    if rings.len() < 2 {
        return None;
    }
    let outline: Vec<DVec2> = (0..RAYS)
        .filter_map(|i| {
            let (s, c) = ops::sin_cos(ops::TAU * f64::from(i) / f64::from(RAYS));
            let way = DVec2::new(c, s);
            let hits = rings.iter().flat_map(|ring| {
                ring.iter().enumerate().filter_map(|(k, &a)| {
                    let (a, b) = (a - centre, ring[(k + 1) % ring.len()] - centre);
                    let (u, v) = (way.perp_dot(a), way.perp_dot(b));
                    ((u > 0.0) != (v > 0.0)).then(|| way.dot(a.lerp(b, u / (u - v))))
                })
            });
            let far = hits.fold(0.0, f64::max);
            (far > 0.0).then(|| centre + way * far)
        })
        .collect();
    geom::simple_outline(&outline)
}

/// Finds, leads or adds the axes that run into each region; returns one list of rows for each region.
pub(crate) fn bear_regions(draft: &mut Draft<'_>) -> Vec<Vec<usize>> {
    let regions = std::mem::take(&mut draft.regions);
    let drawn = draft.forest.axes.len();
    let tops: Vec<DVec2> = draft.forest.axes.iter().filter_map(|a| a.points.last().copied()).collect();
    let mut index = crate::near::Near::new(0.05);
    for (row, axis) in draft.forest.axes.iter().enumerate() {
        index.add_line(row, &axis.points);
    }
    let floor = draft.floor();
    let mut all = Vec::new();
    for region in &regions {
        let mut rows = inside_rows(draft, region, &index, drawn);
        let deep = rows.iter().any(|&r| depth_inside(&draft.forest, r, region) > DEEP);
        if region.kind == RegionKind::Crown && !deep {
            let led = lead_into(draft, region, &tops, floor);
            rows.extend(led.into_iter().filter(|r| !rows.contains(r)).collect::<Vec<_>>());
        } else if rows.is_empty() {
            rows = lead_into(draft, region, &tops, floor);
        }
        rows.sort_unstable();
        all.push(rows);
    }
    draft.regions = regions;
    all
}

/// Returns the rows with a part inside the region, from the index.
fn inside_rows(
    draft: &Draft<'_>,
    region: &RegionDraft,
    index: &crate::near::Near,
    drawn: usize,
) -> Vec<usize> {
    let (lo, hi) = region.bounds;
    let mut rows: Vec<usize> = Vec::new();
    index.visit(lo.midpoint(hi), 0.5 * lo.distance(hi) + 0.01, |e, _| {
        if e.owner < drawn && !rows.contains(&e.owner) && contains(&region.outline, e.point) {
            rows.push(e.owner);
        }
    });
    rows.retain(|&r| draft.forest.axes[r].kind != AxisKind::Root);
    rows
}

/// Returns the length of an axis inside a region, as a share of the region's size.
fn depth_inside(forest: &Forest, row: usize, region: &RegionDraft) -> f64 {
    let (lo, hi) = region.bounds;
    let inside: f64 = forest.axes[row]
        .points
        .windows(2)
        .filter(|w| contains(&region.outline, w[0].midpoint(w[1])))
        .map(|w| w[0].distance(w[1]))
        .sum();
    inside / (hi - lo).max_element().max(1e-9)
}

/// Leads an axis into a region that none runs deep into: goes on with the trunk, sends a branch, or adds stems.
fn lead_into(draft: &mut Draft<'_>, region: &RegionDraft, tops: &[DVec2], floor: f64) -> Vec<usize> {
    let (lo, hi) = region.bounds;
    let size = (hi - lo).max_element();
    let goal = region.heart();
    // A trunk that ends in the crown or just below it goes on into it.
    let near = |p: DVec2| {
        if contains(&region.outline, p) { 0.0 } else { nearest_on_ring(&region.outline, p).1 }
    };
    let end = tops
        .iter()
        .enumerate()
        .filter(|&(r, _)| draft.forest.axes[r].kind != AxisKind::Root && !draft.led.contains(&r))
        .filter(|(_, p)| p.y < goal.y + ABOVE_HEART * (hi.y - lo.y))
        .map(|(r, p)| (near(*p) - 0.5 * draft.forest.half_width(r, f64::INFINITY), r))
        .filter(|(d, _)| *d < (LED * size).max(LED_LEAST))
        .min_by(|a, b| {
            let long = |r: usize| draft.forest.length(r);
            a.0.max(FOOT).total_cmp(&b.0.max(FOOT)).then(long(b.1).total_cmp(&long(a.1)))
        });
    if let Some((_, row)) = end {
        let tip = tops[row];
        let axis = &draft.forest.axes[row].points;
        let back = axis[axis.len().saturating_sub(6)];
        let ahead = (tip - back).normalize_or(DVec2::Y);
        let way = tip.distance(goal);
        let bend = tip + ahead * (0.4 * way);
        let more: Vec<DVec2> = (1..=8)
            .map(|i| f64::from(i) / 8.0)
            .map(|t| tip.lerp(bend, t).lerp(bend.lerp(goal, t), t))
            .collect();
        let width = 0.25 * draft.forest.half_width(row, f64::INFINITY);
        if way > FOOT {
            draft.forest.extend(row, &more, width);
        }
        draft.led.push(row);
        return vec![row];
    }
    let on_ground = region.kind == RegionKind::Crown && lo.y < floor + ON_GROUND * (hi.y - lo.y);
    if !on_ground
        && let Some((bearer, gap)) = draft.forest.nearest(goal, 0.6 * size + 0.1)
        && gap > 0.0
    {
        let foot = geom::point_at(&draft.forest.axes[bearer.axis].points, bearer.at).unwrap_or(goal);
        // The branch leaves a little lower than the nearest place: branches rise.
        let lower = Attachment { axis: bearer.axis, at: (bearer.at - 0.3 * foot.distance(goal)).max(0.0) };
        let from = geom::point_at(&draft.forest.axes[bearer.axis].points, lower.at).unwrap_or(foot);
        let line: Vec<DVec2> = (0..=12).map(|i| from.lerp(goal, f64::from(i) / 12.0)).collect();
        return draft.forest.push(line, Vec::new(), Some(lower), region.source).into_iter().collect();
    }
    stems_below(draft, region, floor)
}

/// Adds stems to a crown without a trunk: a trunk if it is above the ground, several stems if it is on the ground (a
/// bush).
fn stems_below(draft: &mut Draft<'_>, region: &RegionDraft, floor: f64) -> Vec<usize> {
    let (lo, hi) = region.bounds;
    let (width, height) = (hi.x - lo.x, hi.y - lo.y);
    let heart = region.heart();
    let mut rows = Vec::new();
    if lo.y > floor + NEEDS_TRUNK * height {
        let line: Vec<DVec2> =
            (0..=24).map(|i| DVec2::new(heart.x, floor).lerp(heart, f64::from(i) / 24.0)).collect();
        rows.extend(draft.forest.push(line, Vec::new(), None, None));
    } else {
        // The stems stand where the crown meets the ground.
        let foot: Vec<f64> =
            region.outline.iter().filter(|p| p.y < lo.y + MEETS_GROUND * height).map(|p| p.x).collect();
        let (left, right) = foot.iter().fold((hi.x, lo.x), |(l, r), x| (l.min(*x), r.max(*x)));
        let (middle, spread) = (0.5 * (left + right), (0.4 * (right - left)).min(0.12 * width));
        let stems = if width > 2.0 * height { 5 } else { 3 };
        for i in 0..stems {
            let side = f64::from(i) / f64::from(stems - 1) * 2.0 - 1.0;
            let base = DVec2::new(middle + side * spread, lo.y);
            let tip = DVec2::new(heart.x + 0.3 * side * width, lo.y + height * (0.72 - 0.2 * side.abs()));
            let bend = DVec2::new(base.x + 0.04 * side * width, lo.y + 0.45 * height);
            let line: Vec<DVec2> = (0..=16)
                .map(|k| f64::from(k) / 16.0)
                .map(|t| base.lerp(bend, t).lerp(bend.lerp(tip, t), t))
                .collect();
            rows.extend(draft.forest.push(line, Vec::new(), None, None));
        }
    }
    rows
}

/// Turns shading below a crown without a trunk into its trunk.
pub(crate) fn scribbled_trunk(draft: &mut Draft<'_>) {
    if !draft.bodies.is_empty()
        || draft.regions.is_empty()
        || !draft.strokes_of_class(StrokeClass::Axis).is_empty()
    {
        return;
    }
    let found = draft.strokes_of_class(StrokeClass::Scribble).into_iter().find_map(|k| {
        let hull = draft.ink.strokes[k].hull();
        let (lo, hi) = bounds(hull)?;
        let middle = centroid(hull);
        let below = draft
            .regions
            .iter()
            .any(|r| middle.y < r.heart().y && hi.y > r.bounds.0.y - LED_LEAST && r.bounds.0.y > lo.y);
        (below && hi.y - lo.y > SHADED * (hi.x - lo.x)).then_some((k, hull))
    });
    if let Some((k, hull)) = found {
        let source = Some(draft.ink.strokes[k].index);
        let ring = Ring { points: hull.to_vec(), ..Ring::default() };
        let row = draft.forest.add_body(limbs(&ring, None), None, source);
        draft.open_top |= row.is_some();
        draft.bodies.extend(row);
        draft.organ[k] = OrganWord::Trunk;
    }
}

/// Takes short lines on the outline of a cactus for its thorns: root and tip, with their bearers.
pub(crate) fn thorns(draft: &mut Draft<'_>) -> Vec<(Vec<DVec2>, Option<Attachment>, Option<u32>)> {
    if draft.bodies.is_empty() || !draft.regions.is_empty() || draft.open_top || draft.is_tree() {
        return Vec::new();
    }
    let height: f64 = draft.bodies.iter().map(|&r| draft.forest.length(r)).fold(0.0, f64::max);
    let mut thorns = Vec::new();
    for line in std::mem::take(&mut draft.lines) {
        let length = polyline_length(&line.points);
        let (a, b) = (line.points[0], line.points[line.points.len() - 1]);
        let touch = |p| draft.forest.nearest(p, STOPPED_SHORT);
        let (at, bt) = (touch(a), touch(b));
        let nearer_a = at.map_or(f64::INFINITY, |x| x.1) <= bt.map_or(f64::INFINITY, |x| x.1);
        let bearer = if nearer_a { at } else { bt }.map(|x| x.0);
        if let (true, Some(bearer)) = (length < THORN * height, bearer) {
            let mut points = line.points;
            // Both ends on the body: the one farther from its middle line is the tip.
            let from_middle =
                |p: DVec2| distance_to_polyline(&draft.forest.axes[bearer.axis].points, p).unwrap_or(0.0);
            if from_middle(a) > from_middle(b) {
                points.reverse();
            }
            draft.set_organ(line.source, OrganWord::Thorn);
            thorns.push((points, Some(bearer), line.source));
        } else {
            draft.lines.push(Line { ..line });
        }
    }
    thorns
}
