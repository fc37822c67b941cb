//! Counts the blades in a cloud: one leaf, or several that each sit on a neck of their own.

use base::{Cancelled, Run, Seed};
use glam::DVec3;

use crate::clean::{CleanSpec, clean};
use crate::segment::{ScanOrgan, organs};
use crate::thin::thin;
use crate::ways::SegmentSpec;

/// Points that are examined: a leaf of a hundredth of the plant still has some hundreds of them.
const SAMPLE: usize = 20_000;
/// Least and greatest number of bands of an organ from base to tip.
const BANDS: [usize; 2] = [6, 24];
/// Mean number of points that a band needs to show its width.
const A_BAND: usize = 20;
/// Widest neck as a share of the blade's width: lobes begin at full width, leaflets and seed leaves do not. The second
/// share is the limit for the other necks once a blade has parted on such a neck.
const NECK: [f64; 2] = [0.4, 0.7];
/// Least width of a blade as a share of the width of the widest.
const AS_WIDE: f64 = 0.35;
/// Least number of points of a blade as a share of all points.
const POINTS: f64 = 0.08;

/// Counts the blades in a cloud, each on a neck of its own: leaves of a plant, leaflets, leaves that touch. Lobes of
/// one blade are one blade; a cloud that does not part, or is too small to decide, counts as one.
///
/// Any axis may point up: paths start from the ends of the cloud along each axis, and most of them must agree that it
/// parts.
/// Cost: n log n.
///
/// # Errors
/// [`Cancelled`].
pub fn blades(points: &[DVec3], run: &Run<'_>) -> Result<usize, Cancelled> {
    let few: Vec<DVec3> = thin(points, SAMPLE).into_iter().map(|i| points[i as usize]).collect();
    let spec = CleanSpec { plane: false, ..CleanSpec::default() };
    let cleaned = clean(&few, &spec, Seed::new(1), run)?;
    let kept: Vec<DVec3> = cleaned.kept.into_iter().map(|i| few[i]).collect();
    let axes = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
    let mut counts: Vec<usize> = axes
        .iter()
        .filter_map(|up| kept.iter().copied().min_by(|a, b| a.dot(*up).total_cmp(&b.dot(*up))))
        .map(|foot| from(&kept, foot, run))
        .collect::<Result<_, Cancelled>>()?;
    counts.sort_unstable();
    Ok(counts.get(counts.len() / 2).copied().unwrap_or(1))
}

/// Counts the blades along the paths from one place.
fn from(points: &[DVec3], foot: DVec3, run: &Run<'_>) -> Result<usize, Cancelled> {
    let spec = SegmentSpec { foot: Some(foot), ..SegmentSpec::default() };
    let found = organs(points, &spec, run);
    run.cancel.check()?;
    let Some(found) = found.ok().filter(|found| found.len() > 1) else { return Ok(1) };
    let forms: Vec<Form> = found.iter().map(|o| Form::measure(o, points.len())).collect();
    let widest = forms.iter().map(|f| f.width).fold(0.0, f64::max);
    let is_blade = |f: &&Form| f.neck <= NECK[1] && f.width >= AS_WIDE * widest && f.share >= POINTS;
    let found: Vec<&Form> = forms.iter().filter(is_blade).collect();
    Ok(if found.iter().any(|f| f.neck <= NECK[0]) { found.len() } else { 1 })
}

/// Widths of an organ.
struct Form {
    /// Typical greatest width.
    width: f64,
    /// Width of the neck, as a share of that.
    neck: f64,
    /// Share of all points.
    share: f64,
}

impl Form {
    fn measure(organ: &ScanOrgan, all: usize) -> Self {
        let widths: Vec<f64> = organ
            .regions((organ.points.len() / A_BAND).clamp(BANDS[0], BANDS[1]))
            .iter()
            .filter(|rows| 2 * rows.len() >= A_BAND)
            .filter_map(|rows| {
                let band: Vec<DVec3> = rows.iter().map(|&i| organ.points[i]).collect();
                geom::pca3(&band).map(|(_, _, v)| v[0].max(0.0).sqrt())
            })
            .collect();
        let share = organ.points.len() as f64 / all.max(1) as f64;
        let mut sorted = widths.clone();
        base::sort_numbers(&mut sorted);
        let Some(&width) = sorted.get(sorted.len() * 9 / 10) else {
            return Self { width: 0.0, neck: 1.0, share };
        };
        let least = |part: &[f64]| part.iter().copied().fold(f64::INFINITY, f64::min);
        let quarter = widths.len().div_ceil(4);
        // The paths may start from a leaf, too: it parts from the others at its end.
        let neck = match organ.name == "stem" {
            true => least(&widths[widths.len() - quarter..]),
            false => least(&widths[..quarter]),
        };
        Self { width, neck: neck / width.max(1e-300), share }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::{Draw, ops};

    /// Makes a leaf of 60 mm on a stalk of 30 mm, turned about +Y; `lobes` cut it to `depth` of its width.
    fn leaf(turn: f64, depth: f64, count: usize, seed: u64) -> Vec<DVec3> {
        let mut s = Seed::new(seed).stream(Draw::Test);
        let (sin, cos) = ops::sin_cos(turn);
        let mut out = Vec::new();
        while out.len() < count {
            let (x, y) = (s.range(-0.03, 0.03), s.range(0.0, 0.09));
            let v = (y - 0.03) / 0.06;
            let half = if v < 0.0 {
                0.001
            } else {
                // Two notches a side.
                0.02 * ops::sin(ops::PI * v).max(0.0).sqrt()
                    * (1.0 - depth * ops::sin(3.0 * ops::PI * v).abs())
            };
            if x.abs() < half {
                out.push(DVec3::new(y * cos - x * sin, 0.02 + 0.3 * y, y * sin + x * cos));
            }
        }
        out
    }

    fn stem(count: usize) -> Vec<DVec3> {
        let mut s = Seed::new(5).stream(Draw::Test);
        let at = |a: f64, y: f64| DVec3::new(0.0012 * ops::cos(a), y, 0.0012 * ops::sin(a));
        (0..count).map(|_| at(s.range(0.0, ops::TAU), s.range(-0.03, 0.02))).collect()
    }

    fn seen(points: &[DVec3]) -> usize {
        blades(points, &Run::plain()).expect("not cancelled")
    }

    #[test]
    fn leaves_on_necks_are_counted_and_lobes_are_not() {
        for depth in [0.0, 0.3, 0.6] {
            for count in [6000, 3000, 1500] {
                assert_eq!(seen(&leaf(0.3, depth, count, 1)), 1, "{depth} {count}");
            }
        }
        for leaves in [2_usize, 3, 4] {
            let mut plant = stem(1500);
            for k in 0..leaves {
                plant.extend(leaf(ops::TAU * k as f64 / leaves as f64, 0.0, 4000, k as u64));
            }
            assert_eq!(seen(&plant), leaves);
            // With any axis up.
            let lying: Vec<DVec3> = plant.iter().map(|p| DVec3::new(p.y, p.z, p.x)).collect();
            assert!(seen(&lying) > 1, "{leaves}");
            let few: Vec<DVec3> = plant.iter().copied().step_by(4).collect();
            assert_eq!(seen(&few), leaves, "a quarter of the points");
        }
        assert_eq!(seen(&[]), 1);
        assert_eq!(seen(&[DVec3::ONE; 500]), 1);
        assert_eq!(seen(&[DVec3::NAN; 500]), 1);
    }
}
