//! Paints a flat leaf with a texture coloured by the distance from the veins.

use base::{Draw, Executor, Seed, map_indexed, ops::smoothstep};
use geom::KdTree2;
use glam::{DVec2, DVec3};
use mesh::Texture;
use plant::FlatLeaf;

/// Colours of a leaf, sRGB.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LeafColours {
    /// Colour between the veins.
    pub blade: [u8; 3],
    /// Colour on the veins.
    pub vein: [u8; 3],
    /// Colour along the margin.
    pub margin: [u8; 3],
}

impl Default for LeafColours {
    /// Returns the colours of a tobacco leaf in full growth.
    fn default() -> Self {
        Self { blade: [72, 118, 42], vein: [176, 190, 116], margin: [112, 138, 62] }
    }
}

impl LeafColours {
    /// Returns the colours of a wilted leaf: `wilt` 0 unchanged, 1 dry.
    #[must_use]
    pub fn wilted(self, wilt: f64) -> Self {
        let part = if wilt.is_nan() { 0.0 } else { 0.75 * wilt.clamp(0.0, 1.0) };
        let to = |from: [u8; 3], dry: [u8; 3]| mix(colour(from), colour(dry), part);
        Self {
            blade: bytes(to(self.blade, [150, 130, 62])),
            vein: bytes(to(self.vein, [196, 176, 120])),
            margin: bytes(to(self.margin, [142, 106, 58])),
        }
    }
}

/// The veins of a flat leaf as points with a reach, within which their colour spreads.
struct Veins {
    grid: KdTree2,
    places: Vec<DVec2>,
    reach: Vec<f64>,
    widest: f64,
}

/// Paints a texture over the box around the flat leaf, `height` pixels high (16 to 4096), tip at the top.
///
/// Colour changes from that of the veins to that of the blade with the distance from the nearest midrib or side vein; a
/// net of small veins and an uneven green between come from `seed`. The same bits for any executor. Cost: linear in
/// pixels.
///
/// ```
/// # use skin::{LeafColours, vein_texture};
/// let none = vein_texture(&plant::FlatLeaf::default(), &LeafColours::default(), 64, base::Seed::new(1), &base::Serial);
/// assert_eq!(none.pixels.len(), 4 * (none.width * none.height) as usize);
/// ```
pub fn vein_texture(
    flat: &FlatLeaf,
    colours: &LeafColours,
    height: u32,
    seed: Seed,
    executor: &dyn Executor,
) -> Texture {
    let height = height.clamp(16, 4096);
    let (min, size) = flat.extent();
    let wide = if size.x > 0.0 && size.y > 0.0 { f64::from(height) * size.x / size.y } else { 1.0 };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped before the cast")]
    let width = wide.round().clamp(16.0, 4096.0) as u32;
    let length = size.y.max(f64::MIN_POSITIVE);
    let veins = veins(flat, length);
    let margin_line = dense(&flat.outline(), true, 0.004 * length);
    let edge = KdTree2::new(&margin_line);
    // 90 cells along a leaf: as coarse as the third order of veins on a tobacco leaf.
    let net = Net::new(seed, size / length, 90.0);
    let pixel = size / DVec2::new(f64::from(width), f64::from(height));
    let rows = map_indexed(executor, height as usize, |y| {
        let mut row = Vec::with_capacity(4 * width as usize);
        for x in 0..width {
            let at = DVec2::new(f64::from(x) + 0.5, f64::from(height) - y as f64 - 0.5);
            let p = min + at * pixel;
            let near = veins.shade(p);
            let (cell, uneven) = net.wall_at((p - min) / length);
            let margin = edge
                .nearest(p, 0.03 * length)
                .map_or(1.0, |k| smoothstep(0.0, 0.03, margin_line[k].distance(p) / length));
            let blade = colour(colours.blade) * (0.9 + 0.2 * uneven);
            let base = mix(colour(colours.margin), blade, 0.35 + 0.65 * margin);
            let net = mix(base, colour(colours.vein), 0.22 * cell);
            let [r, g, b] = bytes(mix(net, colour(colours.vein), near));
            row.extend([r, g, b, 255]);
        }
        row
    });
    Texture { width, height, pixels: rows.concat() }
}

fn veins(flat: &FlatLeaf, length: f64) -> Veins {
    let mut places = Vec::new();
    let mut reach = Vec::new();
    let mut put = |line: &[DVec2], from: f64, to: f64| {
        let line = dense(line, false, 0.004 * length);
        let last = line.len().saturating_sub(1).max(1) as f64;
        for (k, p) in line.into_iter().enumerate() {
            places.push(p);
            reach.push(length * base::ops::lerp(from, to, k as f64 / last));
        }
    };
    put(&flat.midrib(), 0.016, 0.006);
    for vein in flat.side_veins() {
        put(&vein, 0.009, 0.003);
    }
    let widest = 0.016 * length;
    Veins { grid: KdTree2::new(&places), places, reach, widest }
}

impl Veins {
    /// Returns 1 on a vein, 0 away from all.
    fn shade(&self, p: DVec2) -> f64 {
        let mut near = Vec::new();
        self.grid.within(p, self.widest, &mut near);
        // Rings of equal shade: the farthest reach of all samples whose reach covers the point.
        near.iter().map(|&k| self.covers(k, p)).fold(0.0, f64::max)
    }

    fn covers(&self, k: usize, p: DVec2) -> f64 {
        let d = self.places[k].distance(p);
        1.0 - smoothstep(0.15, 1.0, d / self.reach[k])
    }
}

/// Returns the line with points at most `step` apart.
fn dense(line: &[DVec2], closed: bool, step: f64) -> Vec<DVec2> {
    let mut out = Vec::new();
    let ends = line.iter().skip(1).chain(line.first().filter(|_| closed));
    for (&a, &b) in line.iter().zip(ends) {
        let parts = if step > 0.0 { (a.distance(b) / step).ceil().clamp(1.0, 1000.0) } else { 1.0 };
        let mut k = 0.0;
        while k < parts {
            out.push(a.lerp(b, k / parts));
            k += 1.0;
        }
    }
    out.extend(line.last().filter(|_| !closed));
    out
}

/// A net of small cells (Worley 1996): walls between the cells of scattered points.
struct Net {
    columns: usize,
    rows: usize,
    points: Vec<DVec2>,
    shades: Vec<f64>,
    cells: f64,
}

impl Net {
    /// Makes a net over `size` (in lengths of the leaf) with `cells` cells per length.
    fn new(seed: Seed, size: DVec2, cells: f64) -> Self {
        let count = |x: f64| index_below((x * cells).ceil(), 400) + 3;
        let (columns, rows) = (count(size.x), count(size.y));
        let mut stream = seed.stream(Draw::Texture);
        let mut points = Vec::with_capacity(columns * rows);
        let mut shades = Vec::with_capacity(columns * rows);
        for k in 0..columns * rows {
            let corner = DVec2::new((k % columns) as f64, (k / columns) as f64);
            points.push(corner + DVec2::new(stream.uniform(), stream.uniform()));
            shades.push(stream.uniform());
        }
        Self { columns, rows, points, shades, cells }
    }

    /// Returns the strength of a wall at a place (in lengths), and the shade of its cell.
    fn wall_at(&self, p: DVec2) -> (f64, f64) {
        let q = p * self.cells + DVec2::ONE;
        let (i, j) = (index_below(q.x, self.columns - 1), index_below(q.y, self.rows - 1));
        let (mut first, mut second, mut shade) = (f64::INFINITY, f64::INFINITY, 0.5);
        for y in j.saturating_sub(1)..=(j + 1).min(self.rows - 1) {
            for x in i.saturating_sub(1)..=(i + 1).min(self.columns - 1) {
                let k = y * self.columns + x;
                let d = self.points[k].distance(q);
                if d < first {
                    (second, first, shade) = (first, d, self.shades[k]);
                } else {
                    second = second.min(d);
                }
            }
        }
        (1.0 - smoothstep(0.0, 0.16, second - first), shade)
    }
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped before the cast")]
fn index_below(x: f64, max: usize) -> usize {
    if x >= max as f64 { max } else { x.max(0.0) as usize }
}

fn colour(c: [u8; 3]) -> DVec3 {
    DVec3::new(f64::from(c[0]), f64::from(c[1]), f64::from(c[2]))
}

fn mix(a: DVec3, b: DVec3, t: f64) -> DVec3 {
    a + (b - a) * t
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped before the cast")]
fn bytes(c: DVec3) -> [u8; 3] {
    c.to_array().map(|x| x.round().clamp(0.0, 255.0) as u8)
}

#[cfg(test)]
mod tests {
    use base::Serial;
    use geom::SplineSurface;
    use plant::{Chart, SplineBlade, Venation};

    use super::*;

    #[test]
    fn veins_are_paler_than_the_blade_between() {
        // Six rows of seven marks on a lens, side veins slanting upwards, and the tip.
        let mark = |i: usize, j: usize| {
            let (t, s) = (i as f64 / 6.0, (j as f64 - 3.0) / 3.0);
            let half = 0.02 * base::ops::sin(base::ops::PI * (0.15 + 0.85 * t)).max(0.0);
            DVec3::new(s * half, 0.1 * (t + 0.1 * s.abs() * (1.0 - t)), 0.0)
        };
        let grid: Vec<DVec3> = (0..7).flat_map(|i| (0..7).map(move |j| mark(i, j))).collect();
        let surface = SplineSurface::interpolate(&grid, 7).unwrap();
        let middle = surface.columns_at()[3];
        let blade = SplineBlade {
            surface,
            middle,
            veins: Venation::default(),
            rim: Vec::new(),
            chart: Chart::Unrolled,
            form: 0,
        };
        let flat = blade.flat(5);
        let colours = LeafColours::default();
        let t = vein_texture(&flat, &colours, 256, Seed::new(3), &Serial);
        let (min, size) = flat.extent();
        let at = |p: DVec2| {
            let q = (p - min) / size;
            let x = index_below(q.x * f64::from(t.width), t.width as usize - 1);
            let y = index_below((1.0 - q.y) * f64::from(t.height), t.height as usize - 1);
            i32::from(t.pixels[4 * (y * t.width as usize + x)])
        };
        let midrib = at(DVec2::new(0.0, 0.43));
        let (a, b) = (&flat.side_veins()[5], &flat.side_veins()[7]);
        let (vein, between) = (at(a[7]), at((a[7] + b[7]) * 0.5));
        assert!(midrib > between + 60 && vein > between + 50, "{midrib} {vein} {between}");
        assert_eq!(t, vein_texture(&flat, &colours, 256, Seed::new(3), &Serial));
    }

    #[test]
    fn wilted_colours_turn_brown() {
        let [r, g, _] = LeafColours::default().wilted(1.0).blade;
        assert!(r > g, "{r} {g}");
        assert_eq!(LeafColours::default().wilted(0.0), LeafColours::default());
    }
}
