//! A photograph under the drawing.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use spec::RangeFault;

use crate::SettingFault;

/// Most bytes of a photograph that a document holds: 24 MiB.
pub const MAX_PHOTO_BYTES: usize = 24 << 20;
/// Longest side of a photograph that a document holds, pixels.
const MAX_SIDE: u32 = 4096;

/// A photograph under the drawing, with its place there.
///
/// It is stored as PNG, which every platform decodes to the same pixels.
#[derive(Clone, PartialEq)]
pub struct Photo {
    pub(crate) png: Arc<[u8]>,
    pub(crate) size: (u32, u32),
    /// Its place under the drawing.
    pub place: PhotoPlace,
}

/// Place of a photograph under the drawing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PhotoPlace {
    /// Left edge, in the drawing's unit. Default 0.
    pub x: f64,
    /// Lower edge, in the drawing's unit, y up. Default 0.
    pub y: f64,
    /// Width, in the drawing's unit, above 0; the height follows from the picture. Default 1.
    pub width: f64,
    /// Opacity under the drawing, 0 to 1, default 0.5. Does not affect the plant.
    pub opacity: f64,
    /// Whether organs that were traced over it take its colours. Default true.
    pub paint: bool,
}

impl Default for PhotoPlace {
    fn default() -> Self {
        Self { x: 0.0, y: 0.0, width: 1.0, opacity: 0.5, paint: true }
    }
}

impl std::fmt::Debug for Photo {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { png, size, place } = self;
        write!(f, "Photo {{ {} bytes, {size:?}, {place:?} }}", png.len())
    }
}

/// Reason why a picture was not accepted as a photograph.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PhotoError {
    /// The bytes do not start like a PNG.
    #[error("the photograph is no PNG; save it as PNG")]
    NotPng,
    /// The picture exceeds the bounds.
    #[error("the photograph has more than {MAX_SIDE} pixels a side or 24 MB; make it smaller")]
    TooLarge,
}

/// Returns the pixels across and down, each above 0, in the header of a PNG; `None` for other bytes.
pub(crate) fn png_size(png: &[u8]) -> Option<(u32, u32)> {
    let header = png.get(..24).filter(|h| h.starts_with(b"\x89PNG\r\n\x1a\n") && &h[12..16] == b"IHDR")?;
    let number = |at: usize| u32::from_be_bytes([header[at], header[at + 1], header[at + 2], header[at + 3]]);
    let size = (number(16), number(20));
    (size.0 > 0 && size.1 > 0).then_some(size)
}

impl Photo {
    /// Makes a photograph whose lower left corner is at the origin, one unit wide, half opaque, that gives its colours
    /// to organs.
    ///
    /// Guaranteed: its size is read from the header and bounded. Not guaranteed: that its pixels decode.
    ///
    /// # Errors
    /// [`PhotoError`] if it is not a PNG or is too large.
    ///
    /// ```
    /// assert!(document::Photo::new(b"GIF89a".as_slice().into()).is_err());
    /// ```
    pub fn new(png: Arc<[u8]>) -> Result<Self, PhotoError> {
        let size = png_size(&png).ok_or(PhotoError::NotPng)?;
        if size.0.max(size.1) > MAX_SIDE || png.len() > MAX_PHOTO_BYTES {
            return Err(PhotoError::TooLarge);
        }
        Ok(Self { png, size, place: PhotoPlace::default() })
    }

    /// Returns the picture's bytes.
    pub fn png(&self) -> &Arc<[u8]> {
        &self.png
    }

    /// Returns the pixels across and down, each 1 to 4,096.
    pub fn size(&self) -> (u32, u32) {
        self.size
    }

    /// Returns the height in the drawing's unit.
    pub fn height(&self) -> f64 {
        self.place.width * f64::from(self.size.1) / f64::from(self.size.0)
    }

    /// Whether a point of the drawing lies on the picture.
    pub fn covers(&self, x: f64, y: f64) -> bool {
        let at = self.place;
        (at.x..=at.x + at.width).contains(&x) && (at.y..=at.y + self.height()).contains(&y)
    }

    /// Returns the first setting that is out of its range.
    pub(crate) fn fault(&self) -> Option<SettingFault> {
        let near = |v: f64| v.abs() <= 1e9;
        let PhotoPlace { x, y, width, opacity, .. } = self.place;
        if !(near(x) && near(y) && width > 1e-9 && width <= 1e9) {
            return Some(SettingFault::Photo);
        }
        let (path, least, most) = ("opacity".into(), Some(0.0), Some(1.0));
        let fault = || RangeFault { path, value: opacity, least, most, above: None, unit: "" };
        (!(0.0..=1.0).contains(&opacity)).then(|| SettingFault::Range(fault()))
    }
}

base::coded!(PhotoError {
    Self::NotPng => "photo-not-png" {},
    Self::TooLarge => "photo-too-large" {},
});
