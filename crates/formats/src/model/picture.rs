//! Pixels <-> PNG, and JPEG read.

use std::io::{Cursor, Write};
use std::sync::Arc;

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder, ImageFormat, ImageReader, Limits};
use mesh::Texture;

use crate::error::WriteError;

/// Widest and highest picture that is read.
const MAX_SIDE: u32 = 8_192;
/// Memory for one picture that is read.
const MAX_PICTURE_BYTES: u64 = 512 << 20;

/// Writes RGBA pixels (rows from the top, sRGB, `4 * width * height` bytes) as a PNG.
///
/// Guaranteed: the same pixels give the same bytes.
///
/// # Errors
/// [`WriteError::Texture`] if the sizes disagree or are zero; [`WriteError::Io`] of the sink.
///
/// ```
/// let mut png = Vec::new();
/// formats::write_png(1, 1, &[255, 0, 0, 255], &mut png)?;
/// assert_eq!(formats::read_picture(&png).unwrap().pixels, [255, 0, 0, 255]);
/// # Ok::<(), formats::WriteError>(())
/// ```
pub fn write_png(width: u32, height: u32, pixels: &[u8], out: impl Write) -> Result<(), WriteError> {
    let fault = || WriteError::Texture { width, height, bytes: pixels.len() };
    if width == 0 || height == 0 || pixels.len() as u64 != 4 * u64::from(width) * u64::from(height) {
        return Err(fault());
    }
    let opaque = pixels.chunks_exact(4).all(|p| p[3] == 255);
    let encoder = PngEncoder::new_with_quality(out, CompressionType::Fast, FilterType::Adaptive);
    let written = if opaque {
        let rgb: Vec<u8> = pixels.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
        encoder.write_image(&rgb, width, height, ExtendedColorType::Rgb8)
    } else {
        encoder.write_image(pixels, width, height, ExtendedColorType::Rgba8)
    };
    written.map_err(|e| match e {
        image::ImageError::IoError(e) => WriteError::Io(e),
        other => WriteError::Io(std::io::Error::other(other)),
    })
}

/// Reads a PNG or JPEG within bounds. `None` if it is neither, broken, or too large.
pub fn read_picture(bytes: &[u8]) -> Option<Texture> {
    let format = image::guess_format(bytes).ok()?;
    if !matches!(format, ImageFormat::Png | ImageFormat::Jpeg) {
        return None;
    }
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    let mut limits = Limits::default();
    limits.max_image_width = Some(MAX_SIDE);
    limits.max_image_height = Some(MAX_SIDE);
    limits.max_alloc = Some(MAX_PICTURE_BYTES);
    reader.limits(limits);
    let picture = reader.decode().ok()?.into_rgba8();
    Some(Texture { width: picture.width(), height: picture.height(), pixels: picture.into_raw() })
}

/// Encoded textures, so that writing a model again (or another with the same textures) does not encode them
/// again. Holds what it has encoded until it is dropped.
#[derive(Debug, Default)]
pub struct PngCache {
    entries: Vec<(Arc<Texture>, Arc<[u8]>)>,
}

impl PngCache {
    /// An empty cache.
    pub fn new() -> Self {
        Self::default()
    }

    /// The texture as a PNG.
    ///
    /// # Errors
    /// [`WriteError::Texture`] if its pixels do not fit its size.
    pub fn png(&mut self, texture: &Arc<Texture>) -> Result<Arc<[u8]>, WriteError> {
        if let Some((_, png)) = self.entries.iter().find(|(t, _)| Arc::ptr_eq(t, texture)) {
            return Ok(Arc::clone(png));
        }
        let mut png = Vec::new();
        write_png(texture.width, texture.height, &texture.pixels, &mut png)?;
        let png: Arc<[u8]> = png.into();
        self.entries.push((Arc::clone(texture), Arc::clone(&png)));
        Ok(png)
    }
}

/// Linear 0 to 1 as sRGB 0 to 1 (IEC 61966-2-1).
pub(super) fn srgb(linear: f32) -> f32 {
    let x = f64::from(if linear.is_nan() { 0.0 } else { linear.clamp(0.0, 1.0) });
    narrow(base::srgb_of_linear(x))
}

/// sRGB 0 to 1 as linear 0 to 1.
pub(super) fn linear(srgb: f32) -> f32 {
    let y = f64::from(if srgb.is_nan() { 0.0 } else { srgb.clamp(0.0, 1.0) });
    narrow(base::linear_of_srgb(y))
}

#[expect(clippy::cast_possible_truncation, reason = "colours are f32 by design")]
fn narrow(x: f64) -> f32 {
    x as f32
}
