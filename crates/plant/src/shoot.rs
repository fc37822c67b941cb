//! Shoots in needles or scales, each as one blade: its veins are the axes, its outline encloses the needles.

use base::ops::{self, sin};
use glam::DVec2;

use crate::{Blade, BladeVein, Needles, Relief};

impl Blade {
    /// Makes a shoot in needles, of length 1, with `shoots` side shoots on each side (0 to 12), each of which has side
    /// shoots of its own if there are many. `width`: factor on the usual reach of the side shoots.
    pub fn shoot(needles: Needles, shoots: u32, width: f64) -> Self {
        let needle = needles.length;
        let shoots = shoots.min(12);
        let mut axes = vec![vec![DVec2::ZERO, DVec2::new(0.0, 0.5), DVec2::Y * (1.0 - 0.9 * needle)]];
        for k in 0..2 * shoots {
            let side = if k % 2 == 0 { 1.0 } else { -1.0 };
            let v = 0.1 + 0.72 * (f64::from(k) + 0.5) / f64::from(2 * shoots);
            let length = width * (0.5 * (1.0 - v) + 0.04) * (0.9 + 0.2 * sin(2.4 * f64::from(k)).abs());
            let axis = bent(DVec2::new(0.0, v), DVec2::Y, side * 0.9, length);
            let (from, way) = (axis[0].lerp(axis[2], 0.5), (axis[2] - axis[0]).normalize_or_zero());
            axes.push(axis.to_vec());
            for n in 0..shoots / 4 {
                let back = if n % 2 == 0 { side } else { -side };
                let share = 0.35 * f64::from(n) / f64::from(shoots / 4);
                axes.push(bent(from.lerp(axis[2], share), way, back * 0.7, 0.4 * length).to_vec());
            }
        }
        // Reach of the needles to the side, by height.
        const BINS: usize = 14;
        let mut wide = [0.012_f64; BINS];
        for axis in &axes {
            let way = (axis[axis.len() - 1] - axis[0]).normalize_or_zero();
            for k in 0..=12 {
                let p = geom::point_at(axis, geom::polyline_length(axis) * f64::from(k) / 12.0)
                    .unwrap_or(axis[0]);
                for turn in [-0.9, -0.4, 0.0, 0.4, 0.9] {
                    let tip = p + base::turn::direction(-turn).rotate(way) * needle;
                    let bin = ops::whole(tip.y.clamp(0.0, 0.999) * BINS as f64) as usize;
                    wide[bin] = wide[bin].max(tip.x.abs());
                }
            }
        }
        let right: Vec<DVec2> = wide
            .iter()
            .zip(0_u32..)
            .map(|(x, k)| DVec2::new(*x, (f64::from(k) + 0.5) / BINS as f64))
            .collect();
        let mut blade = Self::mirrored(&right, Relief { bend_b: 0.08, fold: 0.25, ..Relief::default() });
        blade.veins = axes.split_off(1).into_iter().map(BladeVein::from).collect();
        blade.needles = Some(needles);
        blade
    }
}

/// Returns a side shoot: it leaves the direction `way` by an angle and turns towards it.
fn bent(from: DVec2, way: DVec2, angle: f64, length: f64) -> [DVec2; 3] {
    let turned = |by: f64| base::turn::direction(-by).rotate(way);
    let middle = from + turned(angle) * (0.5 * length);
    [from, middle, middle + turned(0.7 * angle) * (0.5 * length)]
}
