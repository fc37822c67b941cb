//! Pixels.

/// A picture: rows from the top, 4 bytes a pixel (RGBA, sRGB, alpha not multiplied in).
/// `pixels.len() == 4 * width * height`.
///
/// ```
/// let p = render::Picture::filled(2, 1, [255, 0, 0, 255]);
/// assert_eq!(p.pixel(1, 0), Some([255, 0, 0, 255]));
/// assert_eq!(p.pixel(2, 0), None);
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// RGBA bytes.
    pub pixels: Vec<u8>,
}

impl Picture {
    /// Makes a picture of one colour.
    pub fn filled(width: u32, height: u32, rgba: [u8; 4]) -> Self {
        Self { width, height, pixels: rgba.repeat(width as usize * height as usize) }
    }

    /// Returns the RGBA bytes of a pixel; `None` outside.
    pub fn pixel(&self, x: u32, y: u32) -> Option<[u8; 4]> {
        if x >= self.width || y >= self.height {
            return None;
        }
        let at = 4 * (y as usize * self.width as usize + x as usize);
        self.pixels.get(at..at + 4).and_then(|p| p.try_into().ok())
    }

    /// Copies `other` with its upper left corner at (`x`, `y`); parts outside are left out.
    pub fn paste(&mut self, other: &Self, x: u32, y: u32) {
        let columns = other.width.min(self.width.saturating_sub(x)) as usize;
        for row in 0..other.height.min(self.height.saturating_sub(y)) {
            let from = 4 * (row as usize * other.width as usize);
            let to = 4 * ((y + row) as usize * self.width as usize + x as usize);
            let bytes = other.pixels.get(from..from + 4 * columns);
            if let (Some(bytes), Some(place)) = (bytes, self.pixels.get_mut(to..to + 4 * columns)) {
                place.copy_from_slice(bytes);
            }
        }
    }

    // Extends the picture right and down by repeating the edge, so that a sheet has the requested size.
    pub(crate) fn resized_canvas(self, width: u32, height: u32) -> Self {
        if (self.width, self.height) == (width, height) || self.width == 0 || self.height == 0 {
            return self;
        }
        let mut out = Self::filled(width, height, [0; 4]);
        for y in 0..height {
            for x in 0..width {
                let rgba = self.pixel(x.min(self.width - 1), y.min(self.height - 1)).unwrap_or([0; 4]);
                let at = 4 * (y as usize * width as usize + x as usize);
                if let Some(place) = out.pixels.get_mut(at..at + 4) {
                    place.copy_from_slice(&rgba);
                }
            }
        }
        out
    }
}

/// Arranges pictures in rows of `columns` (0 counts as 1), in reading order, each in a cell of the largest width and
/// height; empty cells are transparent. No pictures give a picture of no pixels.
///
/// ```
/// let cell = render::Picture::filled(2, 3, [9; 4]);
/// let sheet = render::contact_sheet(&[cell.clone(), cell.clone(), cell], 2);
/// assert_eq!((sheet.width, sheet.height), (4, 6));
/// ```
pub fn contact_sheet(pictures: &[Picture], columns: u32) -> Picture {
    let count = u32::try_from(pictures.len()).unwrap_or(u32::MAX);
    let columns = columns.clamp(1, count.max(1));
    let cell_w = pictures.iter().map(|p| p.width).max().unwrap_or(0);
    let cell_h = pictures.iter().map(|p| p.height).max().unwrap_or(0);
    let mut sheet = Picture::filled(cell_w * columns.min(count), cell_h * count.div_ceil(columns), [0; 4]);
    for (k, picture) in (0_u32..).zip(pictures) {
        sheet.paste(picture, (k % columns) * cell_w, (k / columns) * cell_h);
    }
    sheet
}
