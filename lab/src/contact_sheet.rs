//! A page of drawings, each next to its reading, or next to the picture of its plant.

use std::path::{Path, PathBuf};

use base::ops;
use glam::DVec2;
use ink::Drawing;
use reading::Reading;

use crate::pixels;
use xtask::shell::Outcome;

/// Side of one picture, pixels.
const SIDE: usize = 240;
/// Pairs of pictures in a row.
const COLUMNS: usize = 4;
/// Width of the coloured frame.
const EDGE: usize = 3;

/// Quality of a reading, shown as the colour round the drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Frame {
    Right,
    Acceptable,
    Wrong,
}

impl Frame {
    const fn color(self) -> [u8; 3] {
        match self {
            Self::Right => [70, 170, 90],
            Self::Acceptable => [230, 180, 40],
            Self::Wrong => [210, 60, 60],
        }
    }
}

/// A drawing, and the picture of its plant.
#[derive(Debug)]
pub(crate) struct Cell<'a> {
    pub(crate) drawing: &'a Drawing,
    pub(crate) reading: &'a Reading,
    /// Picture of the plant; if there is none, the reading is shown.
    pub(crate) picture: Option<PathBuf>,
    pub(crate) frame: Frame,
}

/// Writes the page. A missing picture stays grey.
#[expect(clippy::cast_possible_truncation, reason = "a colour")]
pub(crate) fn write(cells: &[Cell<'_>], to: &Path) -> Outcome {
    let rows = cells.len().div_ceil(COLUMNS).max(1);
    let (width, height) = (2 * COLUMNS * SIDE, rows * SIDE);
    let mut page = vec![[128_u8; 3]; width * height];
    for (k, cell) in cells.iter().enumerate() {
        let (x, y) = ((k % COLUMNS) * 2 * SIDE, k / COLUMNS * SIDE);
        let mut put = |px: usize, py: usize, color: [u8; 3]| page[(y + py) * width + x + px] = color;
        for (i, color) in sketch(cell.drawing, cell.frame).into_iter().enumerate() {
            put(i % SIDE, i / SIDE, color);
        }
        if cell.picture.is_none() {
            for (i, color) in read(cell.reading).into_iter().enumerate() {
                put(SIDE + i % SIDE, i / SIDE, color);
            }
        }
        if let Some(Ok(picture)) = cell.picture.as_deref().map(pixels::rgba) {
            for py in 0..SIDE.min(picture.height) {
                for px in 0..SIDE.min(picture.width) {
                    let [r, g, b, a] = picture.rgba[py * picture.width + px];
                    let over =
                        |c: u8| ((u16::from(c) * u16::from(a) + 240 * (255 - u16::from(a))) / 255) as u8;
                    put(SIDE + px, py, [over(r), over(g), over(b)]);
                }
            }
        }
    }
    pixels::write_rgb(&page, width, height, to)
}

/// Draws the lines of a drawing, framed: strokes go from dark blue to orange in the order in which they were drawn.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "places on a page, and colours")]
fn sketch(drawing: &Drawing, frame: Frame) -> Vec<[u8; 3]> {
    let count = drawing.strokes.len().max(2) - 1;
    let lines = drawing.strokes.iter().enumerate().map(|(k, stroke)| {
        let t = k as f64 / count as f64;
        let mix = |a: f64, b: f64| (a + (b - a) * t) as u8;
        let points = stroke.samples.iter().map(|p| p.at).filter(|p| p.is_finite()).collect();
        (points, [mix(20.0, 235.0), mix(40.0, 120.0), mix(150.0, 20.0)], 1)
    });
    let mut page = plot(&lines.collect::<Vec<_>>());
    for (i, pixel) in page.iter_mut().enumerate() {
        let (x, y) = (i % SIDE, i / SIDE);
        if x.min(y) < EDGE || x.max(y) >= SIDE - EDGE {
            *pixel = frame.color();
        }
    }
    page
}

/// Draws the reading: wood brown, leaves green, crowns light green, petals pink, discs yellow, fruits red, thorns grey.
fn read(reading: &Reading) -> Vec<[u8; 3]> {
    let mut lines: Vec<(Vec<DVec2>, [u8; 3], usize)> = Vec::new();
    let shut = |outline: &[DVec2]| -> Vec<DVec2> { outline.iter().chain(outline.first()).copied().collect() };
    for axis in &reading.axes {
        let color = if axis.bearer.is_none() { [90, 50, 20] } else { [150, 100, 60] };
        lines.push((axis.points.clone(), color, 2));
        for side in [-1.0, 1.0] {
            let n = axis.points.len();
            let edge = axis.points.iter().zip(&axis.half_width).enumerate().map(|(i, (&p, w))| {
                let along = axis.points[(i + 1).min(n - 1)] - axis.points[i.saturating_sub(1)];
                p + along.perp().normalize_or_zero() * (side * w)
            });
            lines.push((edge.collect(), [120, 80, 40], 1));
        }
    }
    lines.extend(reading.regions.iter().map(|r| (shut(&r.outline), [120, 220, 110], 3)));
    lines.extend(reading.leaves.iter().map(|l| (shut(&l.outline), [20, 130, 40], 1)));
    for flower in &reading.flowers {
        lines.extend(flower.petals.iter().map(|p| (shut(&p.outline), [230, 90, 180], 1)));
        if let Some(disc) = &flower.disc {
            let ring = (0..=24).map(|k| ops::sin_cos(ops::TAU * f64::from(k) / 24.0));
            lines.push((
                ring.map(|(s, c)| disc.centre + DVec2::new(c, s) * disc.radius).collect(),
                [230, 190, 0],
                2,
            ));
        }
    }
    lines.extend(reading.fruits.iter().map(|f| (shut(&f.outline), [220, 20, 20], 2)));
    lines.extend(reading.thorns.iter().map(|t| (t.0.clone(), [120, 120, 120], 1)));
    plot(&lines)
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "places on a page, and colours")]
fn plot(lines: &[(Vec<DVec2>, [u8; 3], usize)]) -> Vec<[u8; 3]> {
    let mut page = vec![[255_u8; 3]; SIDE * SIDE];
    let points = lines.iter().flat_map(|l| &l.0);
    let (lo, hi) = points.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), &p| (lo.min(p), hi.max(p)));
    let room = (SIDE - 24) as f64;
    let scale = room / (hi - lo).max_element().max(1e-9);
    let at = |p: DVec2| {
        let q = (p - lo.midpoint(hi)) * scale;
        (0.5 * SIDE as f64 + q.x, 0.5 * SIDE as f64 - q.y)
    };
    for (points, color, thick) in lines {
        for w in points.windows(2) {
            let (a, b) = (at(w[0]), at(w[1]));
            let steps = ((b.0 - a.0).abs().max((b.1 - a.1).abs()) * 2.0) as usize + 1;
            for i in 0..=steps {
                let t = i as f64 / steps as f64;
                let (x, y) = (a.0 + (b.0 - a.0) * t, a.1 + (b.1 - a.1) * t);
                for dx in 0..=*thick {
                    for dy in 0..=*thick {
                        let (x, y) = (x as usize + dx, y as usize + dy);
                        if x < SIDE && y < SIDE {
                            page[y * SIDE + x] = *color;
                        }
                    }
                }
            }
        }
    }
    page
}
