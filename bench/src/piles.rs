//! Drawings of very many strokes, most of which lie on one another.

use base::ops;
use burgeon::glam::DVec2;
use burgeon::ink::Drawing;

/// A family of drawings; all have the same number of points in each stroke, whatever the number of strokes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pile {
    /// The same stroke, again and again.
    Equal,
    /// The same stroke, each time shifted by about a pixel.
    Jittered,
    /// Straight lines between random points.
    Crossing,
    /// Short parallel lines.
    Hatching,
    /// Circles of all sizes at random places, most of which cut others.
    Circles,
}

impl Pile {
    /// All families.
    pub const ALL: [Self; 5] = [Self::Equal, Self::Jittered, Self::Crossing, Self::Hatching, Self::Circles];

    /// Returns its name in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Equal => "equal",
            Self::Jittered => "jittered",
            Self::Crossing => "crossing",
            Self::Hatching => "hatching",
            Self::Circles => "circles",
        }
    }

    /// Makes a drawing of `strokes` strokes on a sheet of 1,000 pixels; hatching needs a larger one.
    pub fn drawing(self, strokes: u32) -> Drawing {
        let mut seed = 1_u64;
        let mut random = || {
            seed = seed * 16807 % 2_147_483_647;
            #[expect(clippy::cast_precision_loss, reason = "31 bits")]
            let share = seed as f64 / 2_147_483_647.0;
            share
        };
        let along = f64::from(strokes).sqrt().ceil();
        let lines: Vec<Vec<DVec2>> = (0..strokes)
            .map(|k| {
                let [a, b, c, d] = [(); 4].map(|()| random());
                let wave = |t: f64| DVec2::new(100.0 + 8.0 * ops::sin(13.0 * t), 100.0 + 200.0 * t);
                let row = (f64::from(k) / along).floor();
                let point = |t: f64| match self {
                    Self::Equal => wave(t),
                    Self::Jittered => wave(t) + 2.0 * DVec2::new(a - 0.5, b - 0.5),
                    Self::Crossing => 1000.0 * DVec2::new(a, b).lerp(DVec2::new(c, d), t),
                    Self::Hatching => {
                        10.0 * DVec2::new(f64::from(k) - row * along, row) + DVec2::new(7.0 * t + a, 7.0 * t)
                    }
                    Self::Circles => {
                        let (sin, cos) = ops::sin_cos(ops::TAU * t);
                        1000.0 * DVec2::new(a, b) + (2.0 + 38.0 * c) * DVec2::new(cos, sin)
                    }
                };
                (0..20).map(|i| point(f64::from(i) / 19.0)).collect()
            })
            .collect();
        Drawing::from_polylines(self.name(), &lines)
    }
}
