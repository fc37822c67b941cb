//! Pictures that control where trees may stand.

use base::Run;
use glam::DVec2;

use super::{GroundError, png_gray};

/// A picture that is stretched over the area of a stand: the share of the density at each place, 0 to 1.
///
/// The first row is the northern edge (-Z), the first column the western one (-X).
#[derive(Clone, Debug, PartialEq)]
pub struct Mask {
    columns: usize,
    rows: usize,
    levels: Vec<u8>,
}

impl Mask {
    /// Reads a picture of 8 bits: black keeps trees out, white admits all. Colours are converted to grey.
    ///
    /// # Errors
    /// [`GroundError`]: no such picture, or too large.
    pub fn from_png(bytes: &[u8], run: &Run<'_>) -> Result<Self, GroundError> {
        let gray = png_gray::read(bytes, false, run)?;
        Ok(Self { columns: gray.width, rows: gray.height, levels: gray.bytes })
    }

    /// Exchanges black and white.
    #[must_use]
    pub fn inverted(mut self) -> Self {
        self.levels.iter_mut().for_each(|l| *l = u8::MAX - *l);
        self
    }

    /// Returns the share at a place, given in shares of the area, 0 to 1 each; it is that of the nearest cell.
    pub fn share(&self, at: DVec2) -> f64 {
        let index = |at: f64, count: usize| {
            (base::ops::whole(at * count as f64) as usize).min(count.saturating_sub(1))
        };
        let k = index(at.y, self.rows) * self.columns + index(at.x, self.columns);
        self.levels.get(k).map_or(1.0, |&l| f64::from(l) / f64::from(u8::MAX))
    }

    /// Returns whether cells are square on an area of these sides, to a cell.
    pub fn fits(&self, size_m: DVec2) -> bool {
        let (columns, rows) = (self.columns as f64, self.rows as f64);
        let wanted = columns * size_m.y / size_m.x;
        (wanted - rows).abs() <= 1.0 || (rows * size_m.x / size_m.y - columns).abs() <= 1.0
    }

    /// Returns the numbers of columns and rows.
    pub const fn size(&self) -> [usize; 2] {
        [self.columns, self.rows]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_those_of_pixels() {
        let mut out = Vec::new();
        let mut encoder = png::Encoder::new(&mut out, 2, 2);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder
            .write_header()
            .unwrap()
            .write_image_data(&[0, 0, 0, 255, 255, 255, 51, 51, 51, 0, 0, 255])
            .unwrap();
        let mask = Mask::from_png(&out, &Run::plain()).unwrap();
        let shares =
            [(0.1, 0.1), (0.9, 0.1), (0.1, 1.0), (1.0, 1.0)].map(|(x, y)| mask.share(DVec2::new(x, y)));
        assert_eq!(shares, [0.0, 1.0, 0.2, 1.0 / 3.0]);
        assert_eq!(mask.clone().inverted().share(DVec2::ZERO), 1.0);
        assert!(mask.fits(DVec2::new(100.0, 100.0)) && !mask.fits(DVec2::new(100.0, 1000.0)));
    }
}
