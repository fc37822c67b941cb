//! Measures how well the model's front view shows the drawing, in both directions.
//!
//! `Built + Reading + Ink -> distances as shares of the drawing's diagonal, overlap of contours`

mod lines;
mod overlap;
mod shown;

use base::{CancelToken, Cancelled, Run, map_until_cancelled};
use geom::{contains, distance_to_polyline, resample};
use glam::DVec2;
use ink::{Ink, InkStroke};
use reading::{OrganWord, Reading};

use crate::Built;
use lines::Lines;
use overlap::overlap;
use shown::{lies_as_drawn, shown_lines};

/// Distance of the points that are compared, ink units: twice a felt pen's line.
const STEP: f64 = 0.01;
/// Most points that are compared, about.
const MOST: f64 = 100_000.0;
/// Fewest steps along a line, however short it is.
const LEAST: f64 = 8.0;
/// Points that are compared between two checks for cancellation: below a hundredth of a second.
const POINTS_AT_ONCE: usize = 256;
/// Ink this near to a contour is its outline.
const ON: f64 = 0.012;

/// Distances between drawing and front view, in shares of the drawing's diagonal (ink units).
///
/// A contour in which twigs and leaves grow is measured by overlap, everything else by distances. Strokes that were
/// left out and leaves that the light prior turned are not measured: they are not meant to lie as drawn.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Fidelity {
    /// Mean distance from the drawn lines to the model's.
    pub reprojection_mean: Option<f64>,
    /// 95 % of the drawn lines are nearer than this.
    pub reprojection_p95: Option<f64>,
    /// Mean distance from the model's outlines and axes to the ink: parts of the model that nobody drew.
    pub excess_mean: Option<f64>,
    /// 95 % of the model's outlines and axes are nearer than this.
    pub excess_p95: Option<f64>,
    /// The area that contours share with their growth, over the area of either, 0 to 1.
    pub overlap: Option<f64>,
    /// The share of the drawing's ink that was measured, by length, 0 to 1.
    pub compared: f64,
    /// The strokes whose lines were compared, by their index in the drawing.
    pub strokes: Vec<StrokeFidelity>,
}

/// One stroke against the model.
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
/// `ink` and `reading` are those that `built` was made of. A measure without anything to compare is `None`. Distances
/// are exact where lines lie next to one another; where hundreds lie on one another, those of single points are too
/// large by a thousandth of the diagonal at most, by less than a ten-thousandth on average. Cost: n log n in the
/// length of lines, however many lie on one another, and in the leaves that grew; 1 to 3 ms for a drawing of 30
/// strokes.
///
/// # Errors
/// [`Cancelled`] when the run was cancelled.
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
/// let found = fidelity(&built, &reading, &ink, &Run::plain())?;
/// assert!(found.reprojection_p95.is_some_and(|d| d < 1e-9) && found.overlap.is_none());
/// # Ok::<(), base::Cancelled>(())
/// ```
pub fn fidelity(built: &Built, reading: &Reading, ink: &Ink, run: &Run<'_>) -> Result<Fidelity, Cancelled> {
    run.cancel.check()?;
    let shown = shown_lines(built, reading);
    run.cancel.check()?;
    let model = Lines::new(shown.iter().map(|l| &l.points[..]));
    let wanted = Wanted::new(built, reading);
    let strokes: Vec<&InkStroke> =
        ink.strokes.iter().filter(|s| !wanted.left_out.contains_key(&s.index)).collect();
    let total: f64 = ink.strokes.iter().map(|s| s.length).sum();
    let step = STEP.max(total / MOST);
    run.cancel.check()?;
    let measured = map_until_cancelled(run, strokes.len(), |i| {
        let points = sampled(&strokes[i].points, step);
        let weight = strokes[i].length / points.len().max(1) as f64;
        let outside = |p: DVec2| !wanted.contour(strokes[i].index, p);
        let own = distances(&points, outside, &model, run.cancel)?;
        // If nothing is shown, no point has a distance, wherever it lies.
        let in_contours = match shown.is_empty() {
            true => points.iter().filter(|p| !outside(**p)).count(),
            false => points.len() - own.len(),
        };
        Ok::<_, Cancelled>((own, weight, in_contours))
    })?;
    let (mut drawn, mut compared, mut told) = (Weighed::default(), 0.0, Vec::new());
    for (measured, stroke) in measured.into_iter().zip(&strokes) {
        let (own, weight, in_contours) = measured?;
        compared += weight * (own.len() + in_contours) as f64;
        if let Some(max) = own.iter().copied().reduce(f64::max) {
            let mean = own.iter().sum::<f64>() / own.len() as f64;
            told.push(StrokeFidelity { index: stroke.index, mean, max });
        }
        drawn.0.extend(own.into_iter().map(|d| (d, weight)));
    }
    // Ink that was left out is still ink: a model that shows it does not show something that nobody drew.
    let sheet = Lines::new(ink.strokes.iter().map(|s| &s.points[..]));
    let outlines: Vec<&[DVec2]> = shown.iter().filter(|l| l.outline).map(|l| &l.points[..]).collect();
    run.cancel.check()?;
    let beyond = map_until_cancelled(run, outlines.len(), |i| {
        let points = sampled(outlines[i], step);
        let weight = geom::polyline_length(outlines[i]) / points.len().max(1) as f64;
        let free = |p: DVec2| !wanted.contours.iter().any(|c| c.holds(p));
        let found = distances(&points, free, &sheet, run.cancel)?;
        Ok(found.into_iter().map(|d| (d, weight)).collect::<Vec<_>>())
    })?;
    let beyond = beyond.into_iter().collect::<Result<Vec<_>, Cancelled>>()?;
    let mut excess = Weighed(beyond.into_iter().flatten().collect());
    Ok(Fidelity {
        reprojection_mean: drawn.mean(),
        reprojection_p95: drawn.p95(),
        excess_mean: excess.mean(),
        excess_p95: excess.p95(),
        overlap: overlap(built, run)?,
        compared: if total > 0.0 { (compared / total).min(1.0) } else { 0.0 },
        strokes: told,
    })
}

/// Returns the distances to some lines of those points that count.
fn distances(
    points: &[DVec2],
    counts: impl Fn(DVec2) -> bool,
    lines: &Lines,
    cancel: &CancelToken,
) -> Result<Vec<f64>, Cancelled> {
    let mut found = Vec::with_capacity(points.len());
    for some in points.chunks(POINTS_AT_ONCE) {
        cancel.check()?;
        found.extend(some.iter().filter(|p| counts(**p)).filter_map(|&p| lines.distance(p)));
    }
    Ok(found)
}

/// The parts of the ink that are compared, and how.
struct Wanted {
    /// Strokes that are not measured.
    left_out: base::Set<u32>,
    /// Strokes that are, or have, a contour.
    filled: base::Set<u32>,
    /// The contours that were filled.
    contours: Vec<Contour>,
}

impl Wanted {
    fn new(built: &Built, reading: &Reading) -> Self {
        let turned = built.plant.organs.iter().filter(|o| !lies_as_drawn(o)).filter_map(|o| o.source);
        let ignored =
            reading.strokes.iter().filter(|s| matches!(s.organ, OrganWord::Ignored | OrganWord::Pot));
        let ignored = ignored.map(|s| s.index);
        let contour = |o| matches!(o, OrganWord::LeafContour | OrganWord::TwigContour);
        let filled = reading.strokes.iter().filter(|s| contour(s.organ)).map(|s| s.index);
        let outline = |g: &crate::GrownContour| {
            Contour::new(g.outline.iter().map(|&p| built.map.ink_from_plant(p)).collect())
        };
        Self {
            left_out: base::set_of(turned.chain(ignored)),
            filled: base::set_of(filled.chain(reading.regions.iter().filter_map(|r| r.source))),
            contours: built.grown.iter().map(outline).collect(),
        }
    }

    /// Whether a point of a stroke is part of a contour, which is measured by overlap.
    fn contour(&self, stroke: u32, p: DVec2) -> bool {
        self.filled.contains_key(&stroke) && self.contours.iter().any(|c| c.holds(p) || c.runs_through(p))
    }
}

/// A contour that was filled, in ink.
struct Contour {
    outline: Vec<DVec2>,
    low: DVec2,
    high: DVec2,
}

impl Contour {
    fn new(outline: Vec<DVec2>) -> Self {
        let (low, high) = geom::bounds(&outline).unwrap_or((DVec2::INFINITY, DVec2::NEG_INFINITY));
        Self { outline, low, high }
    }

    /// Whether a point is in the box around it, or this near to that.
    fn is_about(&self, p: DVec2, near: f64) -> bool {
        p.cmpge(self.low - near).all() && p.cmple(self.high + near).all()
    }

    fn holds(&self, p: DVec2) -> bool {
        self.is_about(p, 0.0) && contains(&self.outline, p)
    }

    /// Whether a point is on its line, which is closed.
    fn runs_through(&self, p: DVec2) -> bool {
        if !self.is_about(p, ON) {
            return false;
        }
        let (first, last) = (self.outline.first().copied(), self.outline.last().copied());
        let seam = first.zip(last).and_then(|(a, b)| distance_to_polyline(&[a, b], p));
        seam.into_iter().chain(distance_to_polyline(&self.outline, p)).any(|d| d < ON)
    }
}

fn sampled(line: &[DVec2], step: f64) -> Vec<DVec2> {
    resample(line, step.min(geom::polyline_length(line) / LEAST).max(1e-9))
}

/// Distances, each with the length for which it stands.
#[derive(Debug, Default)]
struct Weighed(Vec<(f64, f64)>);

impl Weighed {
    fn weight(&self) -> f64 {
        self.0.iter().map(|d| d.1).sum()
    }

    fn mean(&self) -> Option<f64> {
        let weight = self.weight();
        (weight > 0.0).then(|| self.0.iter().map(|(d, w)| d * w).sum::<f64>() / weight)
    }

    /// Returns the smallest distance that 95 % of the length do not exceed.
    fn p95(&mut self) -> Option<f64> {
        let wanted = 0.95 * self.weight();
        base::sort_by(&mut self.0, |a, b| a.0.total_cmp(&b.0));
        let mut sum = 0.0;
        let found = self.0.iter().find(|(_, w)| {
            sum += w;
            sum >= wanted
        });
        found.or(self.0.last()).map(|d| d.0)
    }
}

#[cfg(test)]
mod tests {
    use base::{Report, Seed};
    use plant::AxisKind;

    use super::*;
    use crate::{LeafDepth, SketchSpec, build};
    use ink::{Drawing, clean};
    use reading::{AxisReading, BladeReading, RegionKind, RegionReading};

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
            front: None,
            source: Some(1),
            color: None,
        };
        (Reading { axes: vec![axis], leaves: vec![leaf], ..Reading::default() }, ink)
    }

    fn measured(shift: f64, leaf_depth: LeafDepth) -> Fidelity {
        let (reading, ink) = stem_and_leaf(shift);
        let spec = SketchSpec { leaf_depth, ..SketchSpec::default() };
        let built = build(&reading, &spec, Seed::new(1), &Run::plain(), &mut Report::default());
        fidelity(&built.expect("not cancelled"), &reading, &ink, &Run::plain()).expect("not cancelled")
    }

    #[test]
    fn a_faithful_model_has_no_error_and_a_shifted_axis_its_shift() {
        let good = measured(0.0, LeafDepth::Drawn);
        assert!(good.reprojection_p95.is_some_and(|d| d < 1e-9), "{good:?}");
        assert!(good.excess_mean.is_some_and(|d| d < 1e-3) && good.compared > 0.999, "{good:?}");
        assert_eq!(good.overlap, None);
        let bad = measured(0.05, LeafDepth::Drawn);
        // The stem's own line is 0.05 away; near the leaf, the model's other lines may be nearer.
        assert!(bad.strokes[0].mean > 0.04 && bad.strokes[0].max < 0.051, "{bad:?}");
        assert!(bad.reprojection_p95.is_some_and(|d| d > 0.049) && bad.excess_p95.is_some_and(|d| d > 0.049));
    }

    #[test]
    fn leaves_turned_to_the_light_are_not_compared() {
        let got = measured(0.0, LeafDepth::Signed);
        assert_eq!(got.strokes.iter().map(|s| s.index).collect::<Vec<_>>(), [0]);
        assert!(got.compared < 0.9, "{got:?}");
    }

    #[test]
    fn ink_is_compared_with_all_that_the_model_shows() {
        // The leaf was drawn in two strokes, only one of which the reading names.
        let (mut reading, whole) = stem_and_leaf(0.0);
        let leaf = &whole.strokes[1].points;
        let half = leaf.len() / 2;
        let pieces = [whole.strokes[0].points.clone(), leaf[..=half].to_vec(), leaf[half..].to_vec()];
        let ink = clean(&Drawing::from_polylines("", &pieces), &mut Report::default());
        reading.leaves[0].source = Some(1);
        let run = Run::plain();
        let built = build(&reading, &SketchSpec::default(), Seed::new(1), &run, &mut Report::default());
        let got = fidelity(&built.expect("not cancelled"), &reading, &ink, &run).expect("not cancelled");
        assert_eq!(got.strokes.len(), 3);
        assert!(got.strokes.iter().all(|s| s.mean < 2e-3), "{got:?}");
        // A leaf that nobody drew is excess, however well the ink is met.
        let ink = clean(&Drawing::from_polylines("", &pieces[..1]), &mut Report::default());
        reading.leaves[0].outline.iter_mut().for_each(|p| *p += DVec2::new(0.1, 0.0));
        let built = build(&reading, &SketchSpec::default(), Seed::new(1), &run, &mut Report::default());
        let got = fidelity(&built.expect("not cancelled"), &reading, &ink, &run).expect("not cancelled");
        assert!(got.excess_p95.is_some_and(|d| d > 0.1), "{got:?}");
    }

    #[test]
    fn a_crown_is_measured_by_its_overlap() {
        let (reading, ink) = crown(0.0);
        let run = Run::plain();
        let built = |reading: &Reading| {
            build(reading, &SketchSpec::default(), Seed::new(1), &run, &mut Report::default())
                .expect("not cancelled")
        };
        let made = built(&reading);
        let good = fidelity(&made, &reading, &ink, &run).expect("not cancelled");
        assert!(good.overlap.is_some_and(|o| o > 0.8 && o <= 1.0), "{good:?}");
        assert!(good.compared > 0.99 && good.strokes.iter().all(|s| s.index == 0), "{good:?}");
        // The growth to the right of the trunk is on its left: half of the crown is empty.
        let mut half = made.clone();
        let organs = half.grown[0].organs.clone();
        half.plant.organs[organs].iter_mut().for_each(|o| o.frame.origin.x = -o.frame.origin.x.abs());
        half.grown[0].axes = 0..0;
        let bad = fidelity(&half, &reading, &ink, &run).expect("not cancelled");
        let (good, bad) = (good.overlap.expect("a crown"), bad.overlap.expect("a crown"));
        assert!(bad < 0.7 * good && bad > 0.3 * good, "{good} {bad}");
    }

    /// A trunk in a round crown.
    fn crown(shift: f64) -> (Reading, Ink) {
        let p = DVec2::new;
        let trunk: Vec<DVec2> = (0..=20).map(|i| p(0.4 + shift, 0.03 * f64::from(i))).collect();
        let ring: Vec<DVec2> = (0..=60)
            .map(|i| {
                let (s, c) = base::ops::sin_cos(base::ops::TAU * f64::from(i) / 60.0);
                p(0.4 + 0.28 * c, 0.6 + 0.24 * s)
            })
            .collect();
        let ink = clean(&Drawing::from_polylines("", &[trunk, ring]), &mut Report::default());
        let axis = AxisReading {
            points: ink.strokes[0].points.clone(),
            kind: AxisKind::Branch,
            bearer: None,
            half_width: vec![],
            source: Some(0),
        };
        let mut outline = ink.strokes[1].points.clone();
        outline.pop();
        let region = RegionReading {
            outline,
            kind: RegionKind::Crown,
            bearers: vec![0],
            source: Some(1),
            color: None,
        };
        (Reading { axes: vec![axis], regions: vec![region], woody: true, ..Reading::default() }, ink)
    }

    #[test]
    fn nothing_drawn_nothing_measured() {
        let (reading, ink) = stem_and_leaf(0.0);
        let reading = Reading { axes: vec![], leaves: vec![], ..reading };
        let run = Run::plain();
        let built = build(&reading, &SketchSpec::default(), Seed::new(1), &run, &mut Report::default());
        let got = fidelity(&built.expect("not cancelled"), &reading, &ink, &run).expect("not cancelled");
        assert_eq!(got, Fidelity::default());
    }

    #[test]
    fn what_is_stopped_measures_nothing() {
        let (reading, ink) = stem_and_leaf(0.0);
        let run = Run::plain();
        let built = build(&reading, &SketchSpec::default(), Seed::new(1), &run, &mut Report::default());
        let cancel = CancelToken::new();
        cancel.cancel();
        let stopped = Run { cancel: &cancel, ..run };
        let got = fidelity(&built.expect("not cancelled"), &reading, &ink, &stopped);
        assert_eq!(got, Err(Cancelled));
    }
}
