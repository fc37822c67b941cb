//! How well the model's front view shows what was drawn.
//!
//! `Built + Ink -> distances, as shares of the drawing's diagonal`

use std::collections::{BTreeMap, BTreeSet};

use base::{Run, map_indexed};
use geom::{distance_to_polyline, resample};
use glam::{DVec2, DVec3};
use ink::Ink;
use plant::{AxisId, OrganKind, Shape};
use reading::Reading;

use crate::Built;

/// Most points at which one line is compared: felt-pen strokes hold no more detail.
const SAMPLES: f64 = 64.0;

/// Distances between drawing and front view, in shares of the drawing's diagonal (ink units).
///
/// Only strokes that became axes, petals or leaves laid as drawn are compared, each with what was made of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Fidelity {
    /// Mean distance from a drawn point to the model's lines of its stroke.
    pub reprojection_mean: f64,
    /// 95 % of the drawn points are nearer than this.
    pub reprojection_p95: f64,
    /// Mean distance from a point of the model's lines to its stroke: what the model shows and nobody drew, such as
    /// the line that closes an open outline.
    pub excess_mean: f64,
    /// The 95 % point of that.
    pub excess_p95: f64,
    /// The strokes that were compared, by their index in the drawing.
    pub strokes: Vec<StrokeFidelity>,
}

/// One stroke against what was made of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrokeFidelity {
    /// Its index in the drawing.
    pub index: u32,
    /// Mean distance from the drawn points to the model.
    pub mean: f64,
    /// The largest of them.
    pub max: f64,
}

/// Measures a finished plant against the drawing that it came from.
///
/// `ink` and `reading` are those that `built` was made of. `None` when no stroke became an axis, petal or drawn leaf.
/// Leaves turned by the light prior do not count: they are not meant to lie as drawn. Cost: linear in strokes,
/// about 20 microseconds each.
///
/// ```
/// use base::{Report, Run, Seed};
/// use glam::DVec2;
/// use plant::AxisKind;
/// use ink::{Drawing, clean};
/// use reading::{AxisReading, Reading};
/// use sketch::{SketchSpec, build, fidelity};
/// let ink = clean(&Drawing::from_polylines("stem", &[vec![DVec2::ZERO, DVec2::Y]]), &mut Report::default());
/// let points = ink.strokes[0].points.clone();
/// let stem =
///     AxisReading { points, kind: AxisKind::Stem, bearer: None, half_width: vec![], source: Some(0) };
/// let reading = Reading { axes: vec![stem], ..Reading::default() };
/// let built = build(&reading, &SketchSpec::default(), Seed::new(1), &Run::plain(), &mut Report::default())?;
/// assert!(fidelity(&built, &reading, &ink, &Run::plain()).is_some_and(|f| f.reprojection_p95 < 1e-9));
/// # Ok::<(), base::Cancelled>(())
/// ```
pub fn fidelity(built: &Built, reading: &Reading, ink: &Ink, run: &Run<'_>) -> Option<Fidelity> {
    let lines = front_view(built, reading);
    let compared = map_indexed(run.executor, ink.strokes.len(), |i| {
        let stroke = &ink.strokes[i];
        let lines = lines.get(&stroke.index)?;
        let line = sampled(&stroke.points);
        let own = Pieces::new(lines).distances(&line);
        let stroke_line = Pieces::new(core::slice::from_ref(&line));
        let beyond: Vec<f64> = lines.iter().flat_map(|l| stroke_line.distances(&sampled(l))).collect();
        (!own.is_empty()).then_some((stroke.index, own, beyond))
    });
    let (mut drawn, mut excess) = (Vec::new(), Vec::new());
    let mut strokes = Vec::new();
    for (index, own, beyond) in compared.into_iter().flatten() {
        let max = own.iter().copied().fold(0.0, f64::max);
        strokes.push(StrokeFidelity { index, mean: mean(&own), max });
        drawn.extend(own);
        excess.extend(beyond);
    }
    if strokes.is_empty() {
        return None;
    }
    drawn.sort_by(f64::total_cmp);
    excess.sort_by(f64::total_cmp);
    Some(Fidelity {
        reprojection_mean: mean(&drawn),
        reprojection_p95: p95(&drawn),
        excess_mean: mean(&excess),
        excess_p95: p95(&excess),
        strokes,
    })
}

/// Lines of the model seen from the front, in ink, by the stroke that they were read from.
fn front_view(built: &Built, reading: &Reading) -> BTreeMap<u32, Vec<Vec<DVec2>>> {
    let plant = &built.plant;
    let thick: BTreeSet<u32> =
        reading.axes.iter().filter(|a| !a.half_width.is_empty()).filter_map(|a| a.source).collect();
    let seen = |p: DVec3| built.map.ink_from_plant(p.truncate());
    let mut lines: BTreeMap<u32, Vec<Vec<DVec2>>> = BTreeMap::new();
    for (i, axis) in plant.axes.iter().enumerate() {
        let Some(source) = axis.source else { continue };
        let id = AxisId::new(i);
        let middle: Vec<DVec2> = plant.axis_points(id).iter().map(|&p| seen(p)).collect();
        let of = lines.entry(source).or_default();
        if thick.contains(&source) {
            // Drawn as an outline: its two edges were drawn, not its middle.
            let radii = plant.axis_radii(id);
            let edge = |side: f64| -> Vec<DVec2> {
                middle
                    .iter()
                    .zip(radii)
                    .enumerate()
                    .map(|(k, (&p, r))| {
                        let next = middle[(k + 1).min(middle.len() - 1)];
                        let along = (next - middle[k.saturating_sub(1)]).try_normalize().unwrap_or(DVec2::Y);
                        p + along.perp() * (side * r / built.map.metres_per_ink)
                    })
                    .collect()
            };
            // One line around it: left edge, over the tip, right edge.
            let mut around = edge(1.0);
            around.extend(edge(-1.0).into_iter().rev());
            of.push(around);
        } else {
            of.push(middle);
        }
    }
    for organ in &plant.organs {
        let as_drawn = match organ.kind {
            OrganKind::Petal => true,
            OrganKind::Leaf => organ.frame.normal.z.abs() > 1.0 - 1e-9,
            _ => false,
        };
        let (Some(source), true) = (organ.source, as_drawn) else { continue };
        let Some(Shape::Blade(blade)) = plant.shapes.get(organ.shape.index()) else { continue };
        let surface = blade.surface();
        let mut outline: Vec<DVec2> =
            blade.outline.iter().map(|&p| seen(organ.frame.place(surface.point(p), organ.scale))).collect();
        outline.extend(outline.first().copied());
        lines.entry(source).or_default().push(outline);
    }
    lines
}

/// Lines cut into short pieces with the box of each, so that a point looks at the near ones only.
struct Pieces<'a>(Vec<(DVec2, DVec2, &'a [DVec2])>);

impl<'a> Pieces<'a> {
    fn new(lines: &'a [Vec<DVec2>]) -> Self {
        const SEGMENTS: usize = 8;
        let mut pieces = Vec::new();
        for line in lines {
            for start in (0..line.len().max(2) - 1).step_by(SEGMENTS) {
                let piece = line.get(start..line.len().min(start + SEGMENTS + 1)).unwrap_or_default();
                let low = piece.iter().fold(DVec2::INFINITY, |a, &p| a.min(p));
                let high = piece.iter().fold(DVec2::NEG_INFINITY, |a, &p| a.max(p));
                pieces.push((low, high, piece));
            }
        }
        Self(pieces)
    }

    /// Distances of points along another line; infinite without lines.
    fn distances(&self, points: &[DVec2]) -> Vec<f64> {
        // The piece nearest to one point is tried first for the next: most others then are too far at once.
        let mut guess = 0;
        let distance = |p: &DVec2| {
            let to_piece = |k: usize| distance_to_polyline(self.0[k].2, *p).unwrap_or(f64::INFINITY);
            let mut best = if self.0.is_empty() { f64::INFINITY } else { to_piece(guess) };
            for (k, (low, high, _)) in self.0.iter().enumerate() {
                let outside = (*low - *p).max(*p - *high).max(DVec2::ZERO);
                if outside.length_squared() < best * best {
                    let here = to_piece(k);
                    if here < best {
                        (best, guess) = (here, k);
                    }
                }
            }
            best
        };
        points.iter().map(distance).filter(|d| d.is_finite()).collect()
    }
}

fn sampled(line: &[DVec2]) -> Vec<DVec2> {
    let length = geom::polyline_length(line);
    resample(line, (length / SAMPLES).max(1e-9))
}

#[expect(clippy::cast_precision_loss, reason = "counts")]
fn mean(values: &[f64]) -> f64 {
    if values.is_empty() { 0.0 } else { values.iter().sum::<f64>() / values.len() as f64 }
}

/// Of sorted values.
fn p95(values: &[f64]) -> f64 {
    values.get((values.len().saturating_sub(1) * 95).div_ceil(100)).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use base::{Report, Seed};
    use plant::AxisKind;

    use super::*;
    use crate::{LeafDepth, SketchSpec, build};
    use ink::{Drawing, clean};
    use reading::{AxisReading, BladeReading};

    fn stem_and_leaf(shift: f64) -> (Reading, Ink) {
        let p = DVec2::new;
        let stem: Vec<DVec2> = (0..=20).map(|i| p(0.4, 0.04 * f64::from(i))).collect();
        let leaf = vec![p(0.4, 0.4), p(0.6, 0.42), p(0.7, 0.55), p(0.5, 0.5), p(0.4, 0.4)];
        let ink = clean(&Drawing::from_polylines("", &[stem, leaf]), &mut Report::default());
        let line = |i: usize| ink.strokes[i].points.clone();
        let moved = line(0).iter().map(|&q| q + p(shift, 0.0)).collect();
        let axis = AxisReading {
            points: moved,
            kind: AxisKind::Stem,
            bearer: None,
            half_width: vec![],
            source: Some(0),
        };
        let mut outline = line(1);
        outline.pop();
        let (root, tip) = (outline[0], outline[outline.len() / 2]);
        let leaf = BladeReading {
            midrib: vec![root, tip],
            outline,
            root,
            tip,
            veins: vec![],
            bearer: None,
            whorl: 0,
            source: Some(1),
            color: None,
        };
        (Reading { axes: vec![axis], leaves: vec![leaf], ..Reading::default() }, ink)
    }

    fn measured(shift: f64, leaf_depth: LeafDepth) -> Fidelity {
        let (reading, ink) = stem_and_leaf(shift);
        let spec = SketchSpec { leaf_depth, ..SketchSpec::default() };
        let built = build(&reading, &spec, Seed::new(1), &Run::plain(), &mut Report::default());
        fidelity(&built.expect("not cancelled"), &reading, &ink, &Run::plain()).expect("two strokes")
    }

    #[test]
    fn a_faithful_model_has_no_error_and_a_shifted_axis_its_shift() {
        let good = measured(0.0, LeafDepth::Drawn);
        assert!(good.reprojection_p95 < 1e-9 && good.excess_mean < 1e-3, "{good:?}");
        let bad = measured(0.05, LeafDepth::Drawn);
        assert!((bad.strokes[0].mean - 0.05).abs() < 1e-6, "{bad:?}");
        assert!(bad.reprojection_p95 > 0.049 && bad.reprojection_mean < 0.05);
    }

    #[test]
    fn leaves_turned_to_the_light_are_not_compared() {
        let got = measured(0.0, LeafDepth::Signed);
        assert_eq!(got.strokes.iter().map(|s| s.index).collect::<Vec<_>>(), [0]);
    }

    #[test]
    fn nothing_drawn_nothing_measured() {
        let (reading, ink) = stem_and_leaf(0.0);
        let reading = Reading { axes: vec![], leaves: vec![], ..reading };
        let run = Run::plain();
        let built = build(&reading, &SketchSpec::default(), Seed::new(1), &run, &mut Report::default());
        assert_eq!(fidelity(&built.expect("not cancelled"), &reading, &ink, &run), None);
    }
}
