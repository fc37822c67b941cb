//! Shoots in needles or scales, each as one blade: its veins are their axes, its outline holds their needles.

use base::Digest;
use base::ops::{self, sin};
use glam::DVec2;

use crate::{Blade, Lift, Relief};

/// The needles of a blade that is a whole shoot of them. Lengths are shares of the blade's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Needles {
    /// Of a needle.
    pub length: f64,
    /// Of a needle where it is widest.
    pub width: f64,
    /// From a needle to the next on one side of an axis.
    pub spacing: f64,
    /// Between a needle and its axis, radians.
    pub angle: f64,
}

/// Below this share of the shoot's length needles are scales.
const SCALES: f64 = 0.045;

impl Needles {
    /// Needles of a length over that of the shoot, 0.01 to 0.6; scales if they are short. Scales lie close and overlap,
    /// needles stand off.
    pub fn of_length(length: f64) -> Self {
        let length = if length.is_finite() { length.clamp(0.01, 0.6) } else { 0.1 };
        if length < SCALES {
            return Self { length, width: 0.4 * length, spacing: 0.5 * length, angle: 0.5 };
        }
        let width = (0.075 * length).clamp(0.005, 0.02);
        Self { length, width, spacing: 2.2 * width, angle: 0.95 }
    }

    pub(crate) fn digest(&self, d: &mut Digest) {
        d.add(&self.length).add(&self.width).add(&self.spacing).add(&self.angle);
    }
}

impl Blade {
    /// A shoot in needles, of length 1, with `shoots` side shoots on each side (0 to 12), each of which has some of its own
    /// where they are many. `width`: how much further than usual the side shoots reach.
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
        // How far its needles reach to the side, by height.
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
        blade.veins = axes.split_off(1);
        blade.needles = Some(needles);
        blade
    }

    /// A flat blade of length 1 from its right margin, without root and tip.
    pub fn mirrored(right: &[DVec2], relief: Relief) -> Self {
        let mut outline = vec![DVec2::ZERO];
        outline.extend_from_slice(right);
        outline.push(DVec2::Y);
        outline.extend(right.iter().rev().map(|p| DVec2::new(-p.x, p.y)));
        let midrib = (0..=4).map(|i| DVec2::new(0.0, f64::from(i) / 4.0)).collect();
        Self { outline, midrib, veins: Vec::new(), needles: None, lift: Lift::Flat, relief }
    }
}

/// A side shoot: it leaves `way` by an angle and turns towards it.
fn bent(from: DVec2, way: DVec2, angle: f64, length: f64) -> [DVec2; 3] {
    let turned = |by: f64| base::turn::direction(-by).rotate(way);
    let middle = from + turned(angle) * (0.5 * length);
    [from, middle, middle + turned(0.7 * angle) * (0.5 * length)]
}
