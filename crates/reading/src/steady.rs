//! Removes tremor of the hand: a line that shakes to and fro in short waves is read as the line that was meant.

use glam::DVec2;

/// Spread of the bell by which points are averaged, as a share of the length.
const SPREAD: f64 = 0.022;
/// Shorter lines are not changed: their short waves were meant.
const LEAST: f64 = 0.12;
/// Fewer points show no waves: five waves of four points each, and some more (*geometry*).
const FEWEST_POINTS: usize = 24;
/// Fewest waves of tremor.
const WAVES: usize = 5;
/// Greatest height of a wave of tremor, as a share of the length.
const HIGHEST: f64 = 0.012;
/// Lower waves were smoothed away already.
const LOWEST: f64 = 0.0008;
/// The hand shakes in each of this number of parts of the line.
const PARTS: usize = 3;

/// Returns the line without tremor; `None` if the hand did not shake. Both ends stay where they are.
///
/// `points`: even steps.
pub(crate) fn steady(points: &[DVec2]) -> Option<Vec<DVec2>> {
    let length = geom::polyline_length(points);
    if length < LEAST || points.len() < FEWEST_POINTS {
        return None;
    }
    let smooth = smoothed(points, length);
    let n = points.len();
    let off: Vec<f64> = (0..n)
        .map(|i| {
            let way = smooth[(i + 1).min(n - 1)] - smooth[i.saturating_sub(1)];
            way.normalize_or_zero().perp_dot(points[i] - smooth[i]) / length
        })
        .collect();
    // To and fro, each time by enough to be seen.
    let (mut side, mut turns) = (0.0, Vec::new());
    for (i, &d) in off.iter().enumerate().filter(|(_, d)| d.abs() > LOWEST) {
        if d * side < 0.0 {
            turns.push(i * PARTS / n);
        }
        side = d.signum();
    }
    let everywhere = (0..PARTS).all(|part| turns.iter().filter(|&&t| t == part).count() >= 2);
    let highest = off.iter().fold(0.0_f64, |most, d| most.max(d.abs()));
    (turns.len() >= 2 * WAVES && everywhere && highest < HIGHEST).then_some(smooth)
}

/// Averages each point with its neighbours, weighted by a bell; beyond the ends the line continues as its mirror
/// image.
fn smoothed(points: &[DVec2], length: f64) -> Vec<DVec2> {
    let n = points.len();
    let step = length / (n - 1) as f64;
    let spread = SPREAD * length;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "three spreads are a few dozen steps"
    )]
    let reach = ((3.0 * spread / step) as usize).clamp(1, n - 1);
    let weights: Vec<f64> = (0..=reach)
        .map(|k| {
            let x = k as f64 * step / spread;
            base::ops::exp(-0.5 * x * x)
        })
        .collect();
    let total = weights[0] + 2.0 * weights[1..].iter().sum::<f64>();
    let before = |i: usize, k: usize| if k <= i { points[i - k] } else { 2.0 * points[0] - points[k - i] };
    let after = |i: usize, k: usize| {
        if i + k < n { points[i + k] } else { 2.0 * points[n - 1] - points[2 * (n - 1) - i - k] }
    };
    let mean = |i: usize| {
        let around = (1..=reach).map(|k| (before(i, k) + after(i, k)) * weights[k]);
        (points[i] * weights[0] + around.sum::<DVec2>()) / total
    };
    let mut smooth: Vec<DVec2> = (0..n).map(mean).collect();
    (smooth[0], smooth[n - 1]) = (points[0], points[n - 1]);
    smooth
}

#[cfg(test)]
mod tests {
    use base::{Report, ops};
    use ink::Drawing;

    use super::*;

    /// A stem of 760, bowed, that shakes by `shake` at a wavelength of `wave`, cleaned as any drawing.
    fn stem(shake: f64, wave: f64) -> (Vec<DVec2>, f64) {
        let line = (0..=760).map(|k| {
            let y = f64::from(k);
            let bow = 60.0 * ops::sin(y / 760.0 * ops::PI);
            DVec2::new(bow + shake * ops::sin(ops::TAU * y / wave), y)
        });
        let drawing = Drawing::from_polylines("stem", &[line.collect()]);
        let ink = ink::clean(&drawing, &mut Report::default());
        (ink.strokes[0].points.iter().map(|&p| ink.map.to_drawing(p)).collect(), ink.map.scale)
    }

    /// Returns the greatest tremor apart from both ends, which stay where the pen was.
    fn farthest(points: &[DVec2]) -> f64 {
        let points = points.iter().filter(|p| p.y > 50.0 && p.y < 710.0);
        let meant = |p: &DVec2| 60.0 * ops::sin((p.y / 760.0).clamp(0.0, 1.0) * ops::PI);
        points.map(|p| (p.x - meant(p)).abs()).fold(0.0, f64::max)
    }

    fn as_ink(points: &[DVec2], scale: f64) -> Vec<DVec2> {
        points.iter().map(|p| *p * scale).collect()
    }

    #[test]
    fn a_hand_that_shakes_draws_a_calm_stem() {
        for (shake, wave) in [(4.0, 30.0), (3.0, 22.0), (2.5, 38.0)] {
            let (drawn, scale) = stem(shake, wave);
            let calm = steady(&as_ink(&drawn, scale)).expect("the hand shakes");
            let calm: Vec<DVec2> = calm.into_iter().map(|p| p / scale).collect();
            for (a, b) in [(calm.first(), drawn.first()), (calm.last(), drawn.last())] {
                assert!(a.zip(b).is_some_and(|(a, b)| a.distance(*b) < 1e-9), "{a:?} {b:?}");
            }
            let (before, after) = (farthest(&drawn), farthest(&calm));
            assert!(after < 0.4 * before && after < 1.0, "{shake} at {wave}: {before} left {after}");
        }
    }

    #[test]
    fn what_is_meant_stays() {
        // Calm; a few large waves; the corners of a zigzag.
        let (calm, scale) = stem(0.0, 30.0);
        assert_eq!(steady(&as_ink(&calm, scale)), None);
        let (waves, scale) = stem(25.0, 150.0);
        assert_eq!(steady(&as_ink(&waves, scale)), None);
        let zigzag: Vec<DVec2> = (0..=200)
            .map(|k| {
                DVec2::new(
                    if (k / 10) % 2 == 0 { f64::from(k % 10) } else { f64::from(10 - k % 10) } * 0.01,
                    f64::from(k) * 0.004,
                )
            })
            .collect();
        assert_eq!(steady(&zigzag), None);
        assert_eq!(steady(&[DVec2::ZERO, DVec2::X]), None);
    }
}
