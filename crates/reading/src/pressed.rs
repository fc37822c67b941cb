//! How boldly each line was drawn: by the pen's pressure, and where that is not known, by its speed.

use base::ops;
use ink::Ink;

use crate::thresholds::STRAIGHT;

/// Pressures that differ by less than this share come from a pen that measures none.
const ALIKE: f64 = 0.1;
/// The lightest and the boldest line relative to the usual one, by pressure.
const PRESSED: (f64, f64) = (0.5, 2.0);
/// The lightest and the boldest line relative to the usual one, by speed.
const SLOW: (f64, f64) = (0.8, 1.25);
/// A line drawn 16 times as fast as usual is half as thick.
const BY_SPEED: f64 = 0.25;

/// Returns the indices of the strokes that were drawn more boldly or more lightly than usual, and by what factor.
/// Nothing if the drawing has no pressure and no speed.
pub(crate) fn pressed(ink: &Ink) -> Vec<(u32, f64)> {
    let pressures = ink.strokes.iter().filter_map(|s| Some((s.index, s.pressure.filter(|&p| p > 0.0)?)));
    let pressures: Vec<(u32, f64)> = pressures.collect();
    if let Some(usual) = usual(&pressures) {
        return pressures.iter().map(|&(k, p)| (k, (p / usual).clamp(PRESSED.0, PRESSED.1))).collect();
    }
    let speeds = ink.strokes.iter().filter_map(|s| {
        let times = s.times_ms.as_ref()?;
        let took = times.last()? - times.first()?;
        let line = s.points.first()?.distance(*s.points.last()?) > STRAIGHT * s.length;
        (line && took > 1.0).then(|| (s.index, s.length / took))
    });
    let speeds: Vec<(u32, f64)> = speeds.collect();
    let Some(usual) = usual(&speeds) else { return Vec::new() };
    let bold = |v: f64| ops::powf(usual / v, BY_SPEED).clamp(SLOW.0, SLOW.1);
    speeds.iter().map(|&(k, v)| (k, bold(v))).collect()
}

/// Returns the median, if the values differ at all.
fn usual(values: &[(u32, f64)]) -> Option<f64> {
    let mut sorted: Vec<f64> = values.iter().map(|v| v.1).collect();
    base::sort_numbers(&mut sorted);
    let (least, most) = (sorted.first()?, sorted.last()?);
    (*most > (1.0 + ALIKE) * least).then(|| sorted[sorted.len() / 2])
}

#[cfg(test)]
mod tests {
    use base::Report;
    use glam::DVec2;
    use ink::{Drawing, InkSample, Stroke};

    use super::*;

    /// Upright lines, each with a pressure and a total time.
    fn lines(of: &[(Option<f64>, Option<f64>)]) -> Vec<(u32, f64)> {
        let stroke = |(k, &(pressure, took)): (usize, &(Option<f64>, Option<f64>))| Stroke {
            samples: (0..=10)
                .map(|i| InkSample {
                    at: DVec2::new(k as f64, f64::from(i)),
                    time_ms: took.map(|t| t * f64::from(i) / 10.0),
                    pressure,
                })
                .collect(),
            ..Stroke::default()
        };
        let strokes = of.iter().enumerate().map(stroke).collect();
        pressed(&ink::clean(&Drawing { strokes, ..Drawing::default() }, &mut Report::default()))
    }

    #[test]
    fn pressure_counts_and_else_speed() {
        let found = lines(&[(Some(0.2), None), (Some(0.4), None), (Some(0.8), None)]);
        assert_eq!(found, [(0, 0.5), (1, 1.0), (2, 2.0)]);
        // A mouse always has the same pressure: then slow lines are bold.
        let found = lines(&[(Some(0.5), Some(900.0)), (Some(0.5), Some(300.0)), (Some(0.5), Some(100.0))]);
        assert!(found[0].1 > 1.0 && found[1].1 == 1.0 && found[2].1 < 1.0, "{found:?}");
        assert_eq!(lines(&[(None, None), (None, None)]), []);
        assert_eq!(lines(&[(Some(0.5), None)]), []);
    }
}
