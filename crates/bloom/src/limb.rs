//! Finds the line and the radii of a stem or a leaf's stalk in points, and the points of the blade beyond it.
//!
//! Bands of the path from the base do not depend on the density of the points, so the line does not, either.

use base::Run;
use geom::KdTree;
use glam::{DVec2, DVec3};

use crate::BloomError;
use crate::segment::{ScanOrgan, single_organ};
use crate::ways::SegmentSpec;

/// The line of a stem or a stalk.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Limb {
    /// From the base on, metres; empty for a leaf without a stalk.
    pub line: Vec<DVec3>,
    /// One radius per point of the line, above 0.
    pub radii: Vec<f64>,
    /// Points beyond the line: those of the blade.
    pub beyond: Vec<DVec3>,
}

/// Most bands of equal path length that a limb is cut into.
const BANDS: usize = 40;
/// Mean number of points that a band needs.
const A_BAND: usize = 24;
/// Width, as a share of the blade's usual greatest width, at which a blade begins.
const BLADE: f64 = 0.35;
/// Consecutive bands of that width at which a blade begins.
const RUN: usize = 3;
/// Largest radius, as a multiple of the usual one of its limb.
const WIDEST: f64 = 1.25;
/// Rounds of smoothing of the line.
const SMOOTH: u32 = 4;
/// Sectors of twelve that must contain points of a circle.
const SECTORS: usize = 5;
/// Distance from the circle within which a point counts, in radii.
const ROUND: f64 = 0.35;

/// Finds the line of a stem from its lowest point to its farthest.
///
/// # Errors
/// [`BloomError::TooFew`] below 16 finite points; cancelled.
pub fn stem(points: &[DVec3], run: &Run<'_>) -> Result<Limb, BloomError> {
    let organ = single_organ(points, "stem", &SegmentSpec::default(), run)?;
    let bands = Bands::from_organ(&organ);
    let (line, radii) = bands.line(0..bands.bands.len());
    let (line, radii) = to_ends(line, radii);
    Ok(Limb { line, radii, beyond: Vec::new() })
}

/// Extends a limb by half a band at both ends, as the centres of its bands lie in their middles.
fn to_ends(mut line: Vec<DVec3>, mut radii: Vec<f64>) -> (Vec<DVec3>, Vec<f64>) {
    if let ([a, b, ..], [.., y, z], [thick, .., thin]) = (&line[..], &line[..], &radii[..]) {
        let (foot, tip, ends) = (*a + 0.5 * (*a - *b), *z + 0.5 * (*z - *y), [*thick, *thin]);
        line.insert(0, foot);
        line.push(tip);
        radii.insert(0, ends[0]);
        radii.push(ends[1]);
    }
    (line, radii)
}

/// Finds the stalk of a leaf that sits on its bearer at `base`: the thin part from there on. The rest is its blade.
///
/// # Errors
/// [`BloomError::TooFew`] below 16 finite points; cancelled.
pub fn stalk(points: &[DVec3], base: DVec3, run: &Run<'_>) -> Result<Limb, BloomError> {
    let spec = SegmentSpec { foot: Some(base), ..SegmentSpec::default() };
    let organ = single_organ(points, "leaf", &spec, run)?;
    let bands = Bands::from_organ(&organ);
    let widths: Vec<f64> = bands.bands.iter().map(|b| width(b)).collect();
    let mut sorted = widths.clone();
    base::sort_numbers(&mut sorted);
    let wide = BLADE * sorted[sorted.len() * 9 / 10];
    let begins = widths.windows(RUN).position(|w| w.iter().all(|&w| w >= wide)).unwrap_or(0);
    let beyond = bands.bands[begins..].iter().flatten().copied().collect();
    // One band is the blade's own foot.
    let (line, radii) = if begins < 2 { (Vec::new(), Vec::new()) } else { bands.line(0..begins) };
    Ok(Limb { line, radii, beyond })
}

/// Points by their path length from the base.
struct Bands {
    bands: Vec<Vec<DVec3>>,
}

impl Bands {
    fn from_organ(organ: &ScanOrgan) -> Self {
        let count = (organ.points.len() / A_BAND).clamp(4, BANDS);
        let regions = organ.regions(count).into_iter();
        let of = |rows: Vec<usize>| rows.into_iter().map(|i| organ.points[i]).collect::<Vec<DVec3>>();
        Self { bands: regions.map(of).filter(|b| !b.is_empty()).collect() }
    }

    /// Returns centres and radii of bands, as circles across the line of their means.
    fn line(&self, rows: core::ops::Range<usize>) -> (Vec<DVec3>, Vec<f64>) {
        let bands = &self.bands[rows];
        let means: Vec<DVec3> = bands.iter().map(|b| mean(b)).collect();
        let rings = bands.iter().enumerate().map(|(k, band)| {
            let ahead = means[(k + 1).min(means.len() - 1)] - means[k.saturating_sub(1)];
            ring(band, means[k], ahead.try_normalize().unwrap_or(DVec3::Y))
        });
        let (centres, radii): (Vec<DVec3>, Vec<f64>) = rings.unzip();
        let mut sorted = radii.clone();
        base::sort_numbers(&mut sorted);
        // At forks of leaves, and at the start of a blade, a band is wider than its limb.
        let most = (WIDEST * sorted[sorted.len() / 2]).max(1e-6);
        let median = |k: usize| {
            let mut near = radii[k.saturating_sub(3)..(k + 4).min(radii.len())].to_vec();
            base::sort_numbers(&mut near);
            near[near.len() / 2].clamp(1e-6, most)
        };
        let even = (0..radii.len()).map(median).collect();
        // A circle of one band varies more than a stem bends.
        let mut line = centres;
        for _ in 0..SMOOTH {
            let old = line.clone();
            for k in 1..old.len().saturating_sub(1) {
                line[k] = 0.25 * (old[k - 1] + old[k + 1]) + 0.5 * old[k];
            }
        }
        (line, even)
    }
}

fn mean(points: &[DVec3]) -> DVec3 {
    points.iter().sum::<DVec3>() / points.len().max(1) as f64
}

/// Returns the width of a band, as the standard deviation of its points across their path.
fn width(band: &[DVec3]) -> f64 {
    // The longest direction of a band of a blade is across it, that of a band of a stalk may be along it: a band of a
    // stalk is a short tube, whose three deviations are alike.
    geom::pca3(band).map_or(0.0, |(_, _, v)| v[0].sqrt())
}

/// Fits the circle of a band across `axis` (Kasa 1976); if its points do not surround it, their mean and their spread.
fn ring(band: &[DVec3], mean: DVec3, axis: DVec3) -> (DVec3, f64) {
    let (x, y) = axis.any_orthonormal_pair();
    let flat: Vec<DVec2> = band.iter().map(|&p| DVec2::new((p - mean).dot(x), (p - mean).dot(y))).collect();
    let n = flat.len() as f64;
    let spread = (flat.iter().map(|p| p.length_squared()).sum::<f64>() / n).sqrt();
    let (mut xx, mut xy, mut yy, mut xz, mut yz) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for p in &flat {
        let z = p.length_squared();
        (xx, xy, yy) = (xx + p.x * p.x, xy + p.x * p.y, yy + p.y * p.y);
        (xz, yz) = (xz + p.x * z, yz + p.y * z);
    }
    let det = xx * yy - xy * xy;
    if det > 1e-6 * xx * yy {
        let centre = 0.5 * DVec2::new(xz * yy - yz * xy, yz * xx - xz * xy) / det;
        let radius = (centre.length_squared() + spread * spread).sqrt();
        let off: f64 = flat
            .iter()
            .map(|p| {
                let d = p.distance(centre) - radius;
                d * d
            })
            .sum();
        let mut sectors = [false; 12];
        for p in &flat {
            let turn = base::ops::atan2(p.y - centre.y, p.x - centre.x) / base::ops::TAU + 0.5;
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 12")]
            let k = ((turn * 12.0) as usize).min(11);
            sectors[k] = true;
        }
        let round = sectors.iter().filter(|s| **s).count() >= SECTORS;
        if round && (off / n).sqrt() < ROUND * radius && radius < 3.0 * spread {
            return (mean + x * centre.x + y * centre.y, radius);
        }
    }
    (mean, spread)
}

/// Returns points of triangles, at most `step` metres apart, at which a surface is compared.
pub fn surface_places(triangles: impl Iterator<Item = [DVec3; 3]>, step: f64) -> Vec<DVec3> {
    triangles.flat_map(|t| spread(t, step)).collect()
}

/// Returns points of a triangle at most `step` apart.
fn spread([a, b, c]: [DVec3; 3], step: f64) -> Vec<DVec3> {
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped before the cast")]
    let parts = (longest / step).ceil().clamp(1.0, 200.0) as usize;
    let at =
        |i: usize, j: usize| a + (b - a) * (i as f64 / parts as f64) + (c - a) * (j as f64 / parts as f64);
    (0..=parts).flat_map(|i| (0..=parts - i).map(move |j| at(i, j))).collect()
}

/// Returns the point of `of` that is nearest to any of `to`: the joint of a leaf on its stem.
pub fn joint(of: &[DVec3], to: &[DVec3]) -> Option<DVec3> {
    let tree = KdTree::new(to);
    let gap = |p: &DVec3| Some((tree.nearest(*p, f64::INFINITY).map(|k| to[k].distance(*p))?, *p));
    of.iter().filter_map(gap).min_by(|a, b| a.0.total_cmp(&b.0)).map(|g| g.1)
}

#[cfg(test)]
mod tests {
    use base::{Draw, Seed, ops};

    use super::*;

    /// Makes a stalk of 20 mm, 1 mm thick, and a blade of 40 by 16 mm, `n` points in all.
    fn leaf(n: usize) -> Vec<DVec3> {
        let mut s = Seed::new(3).stream(Draw::Test);
        let of = |k: usize| {
            let (u, v) = (s.uniform(), s.uniform());
            if k.is_multiple_of(5) {
                let (sin, cos) = ops::sin_cos(ops::TAU * u);
                DVec3::new(0.0005 * cos, 0.020 * v, 0.0005 * sin)
            } else {
                let half = 0.008 * ops::sin(ops::PI * v);
                DVec3::new((2.0 * u - 1.0) * half, 0.020 + 0.040 * v, 0.0)
            }
        };
        (0..n).map(of).collect()
    }

    #[test]
    fn stalk_and_blade_part_at_the_same_place_at_every_density() {
        for n in [16_000, 4_000, 1_000] {
            let limb = stalk(&leaf(n), DVec3::ZERO, &Run::plain()).expect("points");
            let end = limb.line.last().expect("a stalk").y;
            assert!((0.016..0.028).contains(&end), "{n} points: the stalk ends at {end}");
            let radius = limb.radii[limb.radii.len() / 2];
            assert!((0.0004..0.0006).contains(&radius), "{n} points: radius {radius}");
            let first = limb.beyond.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
            assert!((0.017..0.029).contains(&first), "{n} points: the blade begins at {first}");
        }
    }

    #[test]
    fn a_stem_has_its_radius_and_a_leaf_without_stalk_none() {
        let mut s = Seed::new(5).stream(Draw::Test);
        let tube = (0..3000).map(|_| {
            let (sin, cos) = ops::sin_cos(ops::TAU * s.uniform());
            DVec3::new(0.002 * cos, 0.1 * s.uniform(), 0.002 * sin)
        });
        let limb = stem(&tube.collect::<Vec<_>>(), &Run::plain()).expect("points");
        assert!(limb.radii.iter().all(|r| (r - 0.002).abs() < 1e-4), "{:?}", limb.radii);
        assert!((geom::polyline_length3(&limb.line) - 0.1).abs() < 0.005);
        let blade: Vec<DVec3> = leaf(4000).into_iter().filter(|p| p.y > 0.022).collect();
        assert!(stalk(&blade, DVec3::Y * 0.022, &Run::plain()).expect("points").line.len() < 6);
        assert!(matches!(stem(&[DVec3::ZERO; 3], &Run::plain()), Err(BloomError::TooFew { is: 3, .. })));
    }
}
