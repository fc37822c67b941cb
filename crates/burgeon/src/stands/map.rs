//! A plan of a stand as a picture.

use forest::Stand;
use glam::DVec3;
use mesh::Texture;

/// Colours of species, sRGB, in their order and again from the start (Okabe and Ito 2008, and darker versions of
/// these).
pub const SPECIES_COLOURS: [[u8; 3]; 12] = [
    [0, 158, 115],
    [230, 159, 0],
    [86, 180, 233],
    [213, 94, 0],
    [0, 114, 178],
    [204, 121, 167],
    [120, 140, 20],
    [0, 90, 65],
    [140, 90, 0],
    [40, 100, 130],
    [130, 60, 0],
    [120, 70, 100],
];
const PAPER: [u8; 3] = [250, 249, 244];
/// Share of the picture that is left free at each edge.
const EDGE: f64 = 0.03;
/// Least radius of a crown, pixels.
const LEAST: f64 = 0.6;

/// Draws crowns from above, north up, the tallest over the others, coloured by species: a square of `size` pixels.
///
/// Cost: linear in the pixels of crowns.
pub fn stand_map(stand: &Stand, size: u32) -> Texture {
    let size = size.clamp(16, 8192);
    let mut pixels: Vec<u8> =
        PAPER.iter().copied().chain([255]).collect::<Vec<u8>>().repeat((size * size) as usize);
    let reach = |t: &forest::Tree| (t.foot_m + t.crown_offset_m, 0.5 * t.crown_width_m);
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for (at, radius) in stand.trees.iter().map(reach) {
        low = low.min(at - DVec3::splat(radius));
        high = high.max(at + DVec3::splat(radius));
    }
    let span = (high.x - low.x).max(high.z - low.z).max(1e-6);
    let scale = f64::from(size) * (1.0 - 2.0 * EDGE) / span;
    let centre = (low + high) * 0.5;
    let mut rows: Vec<u32> = (0..).zip(&stand.trees).map(|(row, _)| row).collect();
    let height = |row: &u32| stand.trees[*row as usize].height_m;
    base::sort_by(&mut rows, |a, b| height(a).total_cmp(&height(b)).then(a.cmp(b)));
    let half = 0.5 * f64::from(size);
    for row in rows {
        let tree = &stand.trees[row as usize];
        let (at, radius) = reach(tree);
        let (x, y) = (half + (at.x - centre.x) * scale, half + (at.z - centre.z) * scale);
        let colour = SPECIES_COLOURS[usize::from(tree.species) % SPECIES_COLOURS.len()];
        disc(&mut pixels, size, (x, y, (radius * scale).max(LEAST)), colour);
    }
    Texture { width: size, height: size, pixels }
}

/// Draws a disc with a darker edge.
fn disc(pixels: &mut [u8], size: u32, (x, y, radius): (f64, f64, f64), colour: [u8; 3]) {
    let last = f64::from(size - 1);
    let range = |c: f64| {
        let end = |v: f64| base::ops::whole(v.clamp(0.0, last));
        end((c - radius).floor())..=end((c + radius).ceil())
    };
    for row in range(y) {
        for column in range(x) {
            let (dx, dy) = (f64::from(column) + 0.5 - x, f64::from(row) + 0.5 - y);
            let far = (dx * dx + dy * dy).sqrt();
            if far > radius {
                continue;
            }
            let at = 4 * (row as usize * size as usize + column as usize);
            let dark = if radius > 3.0 && far > radius - 1.2 { 3 } else { 4 };
            for (to, from) in pixels[at..at + 3].iter_mut().zip(colour) {
                *to = u8::try_from(u32::from(from) * dark / 4).unwrap_or(from);
            }
        }
    }
}
