//! The map of a plot: its trees seen from above, each in a colour of its own, with its number.

use burgeon::render::Picture;
use burgeon::scan::Plot;

use crate::lettering::{put_dot, write_text};

/// Longer side of the map, pixels.
const LONG: f64 = 1200.0;
/// Margin of the map, pixels.
const MARGIN: f64 = 20.0;
/// Colours of neighbours, distinguishable for people who confuse red and green, too (Okabe and Ito 2008, lightened).
const COLOURS: [[u8; 3]; 7] = [
    [120, 190, 235],
    [240, 190, 90],
    [90, 190, 160],
    [235, 225, 110],
    [110, 160, 210],
    [230, 150, 100],
    [215, 165, 195],
];
/// Colour of points that belong to no tree.
const OTHER: [u8; 3] = [205, 205, 205];
/// Colour of digits and of the marks of stems.
const DARK: [u8; 3] = [40, 40, 40];

/// Side of a dot of a digit, pixels.
const DOT: i64 = 3;

struct Map {
    picture: Picture,
    low: [f64; 2],
    scale: f64,
}

impl Map {
    /// Returns the pixel of a place: x to the right, and +Z of the plot (which is -Y of a scan with +Z up) downwards,
    /// because a map has north at its top.
    fn pixel(&self, [x, z]: [f64; 2]) -> [i64; 2] {
        #[expect(clippy::cast_possible_truncation, reason = "a picture of some thousand pixels")]
        let at = |v: f64, low: f64| ((v - low) * self.scale + MARGIN) as i64;
        [at(x, self.low[0]), at(z, self.low[1])]
    }

    fn dot(&mut self, at: [i64; 2], colour: [u8; 3]) {
        put_dot(&mut self.picture, at, colour);
    }

    fn number(&mut self, corner: [i64; 2], number: usize) {
        write_text(&mut self.picture, corner, &number.to_string(), (DOT, DARK));
    }
}

/// Draws the map of a plot.
pub(crate) fn map_of(plot: &Plot) -> Picture {
    let none = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    let (low, high) = plot
        .owned()
        .fold(none, |(a, b), (p, _)| ([a[0].min(p.x), a[1].min(p.z)], [b[0].max(p.x), b[1].max(p.z)]));
    let size = [0, 1].map(|k| (high[k] - low[k]).max(1e-3));
    let scale = LONG / size[0].max(size[1]);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 1240")]
    let [width, height] = size.map(|s| (s * scale + 2.0 * MARGIN).max(1.0) as u32);
    let mut map = Map { picture: Picture::filled(width, height, [255; 4]), low, scale };
    // Trees over all other points.
    for is_tree in [false, true] {
        for (p, owner) in plot.owned().filter(|(_, owner)| owner.is_some() == is_tree) {
            let colour = owner.map_or(OTHER, |o| COLOURS[o % COLOURS.len()]);
            let at = map.pixel([p.x, p.z]);
            map.dot(at, colour);
        }
    }
    for (k, tree) in plot.trees.iter().enumerate() {
        let [x, y] = map.pixel(tree.place);
        #[expect(clippy::cast_possible_truncation, reason = "some pixels")]
        let r = (tree.radius_m * scale).max(3.0) as i64;
        for dy in -r..=r {
            for dx in (-r..=r).filter(|dx| dx * dx + dy * dy <= r * r) {
                map.dot([x + dx, y + dy], DARK);
            }
        }
        map.number([x + r + 3, y - 2 * DOT], k + 1);
    }
    map.picture
}
