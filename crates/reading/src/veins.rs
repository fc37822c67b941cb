//! Finds veins: lines inside a blade. The one from root to tip becomes its midrib.

use geom::{contains, polyline_length};
use glam::DVec2;
use ink::StrokeClass;

use crate::blade::Sheetlet;
use crate::branches::Line;
use crate::draft::Draft;
use crate::near::Boxes;
use crate::rules::{VEINS_IN_BLADES, unsure};
use crate::{OrganWord, VeinReading};

/// Samples of a line that are tested.
const SAMPLES: usize = 24;

/// A line within a blade.
#[derive(Clone, Debug)]
pub(crate) struct VeinLine {
    pub points: Vec<DVec2>,
    /// Row of the stroke that it is, or is a part of.
    pub stroke: usize,
}

/// The veins of each blade.
pub(crate) type Veins = Vec<Vec<VeinLine>>;

/// Least share of its length with which a line that is surely a vein lies in its blade.
const VEIN_INSIDE: f64 = 0.25;
/// Least share of its length with which a line that is surely a stem lies in a blade to be its vein.
const STEM_INSIDE: f64 = 0.9;
/// A line that is a vein with at least this share is one, though no blade was found around it.
const SURE_VEIN: f64 = 0.8;
/// A part that sticks out of a blade by more than this share of the blade's size is its stalk.
const STALK: f64 = 0.1;
/// A midrib runs along more than this share of its blade's length.
const RIB_RUN: f64 = 0.4;
/// A midrib keeps within this share of the blade's length of the line from root to tip.
const RIB_ASIDE: f64 = 0.35;
/// A midrib begins within this share of the blade's length of the root.
const RIB_START: f64 = 0.4;

/// Takes the lines that lie inside blades out of the draft's vein and axis strokes.
///
/// The part of a vein beyond its blade is the blade's stalk.
pub(crate) fn collect(draft: &mut Draft<'_>, off: &[&str]) -> Veins {
    use StrokeClass::{Axis, Vein};
    let boxes = Boxes::new(draft.blades.iter().map(|b| b.outline.as_slice()));
    let rib = |b: &mut Sheetlet| b.rib.take().map(|points| VeinLine { points, stroke: b.stroke });
    let mut veins: Veins = draft.blades.iter_mut().map(|b| rib(b).into_iter().collect()).collect();
    for (class, strokes) in [Vein, Axis].map(|class| (class, draft.strokes_of_class(class))) {
        for k in strokes {
            let ink = draft.ink;
            let points = &ink.strokes[k].points;
            let decides = unsure(draft, k) && !off.contains(&VEINS_IN_BLADES);
            let vein = match draft.said[k].shares {
                // The share of veins among the shares of both kinds of lines.
                s if decides && s[Vein.place()] + s[Axis.place()] > 0.0 => {
                    s[Vein.place()] / (s[Vein.place()] + s[Axis.place()])
                }
                _ => f64::from(u8::from(class == Vein)),
            };
            let host = host(draft, &boxes, points, STEM_INSIDE + (VEIN_INSIDE - STEM_INSIDE) * vein);
            let built = if host.is_some() || vein > SURE_VEIN { Vein } else { Axis };
            if decides && built != class {
                draft.class[k] = built;
                draft.rule[k] = Some(VEINS_IN_BLADES);
            }
            match host {
                Some(blade) => {
                    draft.organ[k] = OrganWord::Vein;
                    let (inner, outer) = part(points, &draft.blades[blade].outline);
                    let source = Some(draft.ink.strokes[k].index);
                    for stalk in outer {
                        if polyline_length(&stalk) > STALK * draft.blades[blade].size {
                            draft.lines.push(Line { points: stalk, source });
                        }
                    }
                    veins[blade].push(VeinLine { points: inner, stroke: k });
                }
                None => draft.line_of(k, OrganWord::Branch),
            }
        }
    }
    veins
}

/// Returns the blade that holds at least `share` of a line; the smallest of several.
fn host(draft: &Draft<'_>, boxes: &Boxes, points: &[DVec2], share: f64) -> Option<usize> {
    let stride = (points.len() / SAMPLES).max(1);
    let mut hits: Vec<(usize, usize)> = Vec::new();
    let mut samples = 0;
    for &p in points.iter().step_by(stride) {
        samples += 1;
        for b in boxes.around(p) {
            if contains(&draft.blades[b].outline, p) {
                match hits.iter_mut().find(|h| h.0 == b) {
                    Some(h) => h.1 += 1,
                    None => hits.push((b, 1)),
                }
            }
        }
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most a few dozen")]
    let enough = (share * f64::from(samples)).ceil() as usize;
    hits.into_iter()
        .filter(|h| h.1 >= enough)
        .min_by(|a, b| draft.blades[a.0].size.total_cmp(&draft.blades[b.0].size).then(a.0.cmp(&b.0)))
        .map(|h| h.0)
}

/// Cuts a vein at its blade's outline: the part inside, and loose ends from the free end to the blade.
fn part(points: &[DVec2], outline: &[DVec2]) -> (Vec<DVec2>, Vec<Vec<DVec2>>) {
    let inside = |p: &DVec2| contains(outline, *p);
    let (Some(first), Some(last)) = (points.iter().position(inside), points.iter().rposition(inside)) else {
        return (points.to_vec(), Vec::new());
    };
    if last <= first {
        return (points.to_vec(), Vec::new());
    }
    let head = points[..=first].to_vec();
    let tail: Vec<DVec2> = points[last..].iter().rev().copied().collect();
    (points[first..=last].to_vec(), [head, tail].into_iter().filter(|l| l.len() > 1).collect())
}

/// Chooses the midrib among a blade's veins, root first: it leads from near the root towards the tip. The rest are
/// side veins.
pub(crate) fn choose_midrib(
    veins: Vec<VeinReading>,
    root: DVec2,
    tip: DVec2,
) -> (Option<Vec<DVec2>>, Vec<VeinReading>) {
    let reach = root.distance(tip).max(1e-9);
    let along = (tip - root) / reach;
    let score = |v: &VeinReading| {
        let v = &v.points;
        let (Some(&a), Some(&b)) = (v.first(), v.last()) else { return 0.0 };
        let run = (b - a).dot(along).abs() / reach;
        let aside = v.iter().map(|p| (*p - root).perp_dot(along).abs()).fold(0.0, f64::max) / reach;
        let start = (a - root).dot(along).min((b - root).dot(along)) / reach;
        if run > RIB_RUN && aside < RIB_ASIDE && start < RIB_START { run - 0.5 * aside } else { 0.0 }
    };
    let best =
        (0..veins.len()).max_by(|&a, &b| score(&veins[a]).total_cmp(&score(&veins[b])).then(b.cmp(&a)));
    let Some(best) = best.filter(|&b| score(&veins[b]) > 0.0) else { return (None, veins) };
    let mut rest = veins;
    let mut rib = rest.remove(best).points;
    let away = |p: Option<&DVec2>| p.map_or(0.0, |p| (*p - root).dot(along));
    if away(rib.first()) > away(rib.last()) {
        rib.reverse();
    }
    (Some(rib), rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_vein_along_the_leaf_is_its_midrib() {
        let p = |x: f64, y: f64| DVec2::new(x, y);
        let vein = |source, points| VeinReading { points, source: Some(source) };
        let side = vein(0, vec![p(0.5, 0.4), p(0.6, 0.5)]);
        let middle = vec![p(0.5, 0.8), p(0.5, 0.5), p(0.5, 0.15)];
        let drawn = vec![side.clone(), vein(1, middle.clone())];
        let (rib, rest) = choose_midrib(drawn, p(0.5, 0.1), p(0.5, 0.9));
        assert_eq!(rib, Some(middle.into_iter().rev().collect()));
        assert_eq!(rest, [side]);
    }

    #[test]
    fn what_sticks_out_of_the_leaf_is_its_stalk() {
        let p = |x: f64, y: f64| DVec2::new(x, y);
        let square = [p(0.0, 0.0), p(1.0, 0.0), p(1.0, 1.0), p(0.0, 1.0)];
        let line: Vec<DVec2> = (0..15).map(|i| p(0.5, f64::from(i) * 0.1 - 0.55)).collect();
        let (inner, outer) = part(&line, &square);
        assert!(inner.iter().all(|q| q.y > 0.0) && outer.len() == 1, "{outer:?}");
        assert_eq!(outer[0][0], line[0]);
    }
}
