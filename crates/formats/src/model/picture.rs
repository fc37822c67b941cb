//! Pixels <-> PNG, and JPEG read.

use std::io::{Cursor, Write};
use std::sync::Arc;

use mesh::Texture;
use png::{BitDepth, ColorType, Compression, Filter, Limits, Transformations};
use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

use crate::error::WriteError;

/// Greatest width and height of a picture that is read, in pixels.
const MAX_SIDE: u32 = 8_192;
/// Most memory for one picture that is read, in bytes.
const MAX_PICTURE_BYTES: usize = 512 << 20;

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
    if !fits(width, height, pixels) {
        return Err(fault());
    }
    let rgb: Vec<u8>;
    let (color, bytes) = if pixels.chunks_exact(4).all(|p| p[3] == 255) {
        rgb = pixels.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
        (ColorType::Rgb, rgb.as_slice())
    } else {
        (ColorType::Rgba, pixels)
    };
    let mut encoder = png::Encoder::new(out, width, height);
    encoder.set_color(color);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Fast);
    encoder.set_filter(Filter::Adaptive);
    let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(bytes));
    written.map_err(|e| WriteError::Io(e.into()))
}

/// Returns whether there are four bytes for each pixel.
fn fits(width: u32, height: u32, pixels: &[u8]) -> bool {
    width > 0 && height > 0 && pixels.len() as u64 == 4 * u64::from(width) * u64::from(height)
}

/// Reads a PNG or JPEG within bounds. `None` if it is neither, broken, or too large.
///
/// A PNG with 16 bits gives its upper eight.
pub fn read_picture(bytes: &[u8]) -> Option<Texture> {
    if bytes.starts_with(b"\x89PNG\r\n\x1a\n") { read_png(bytes) } else { read_jpeg(bytes) }
}

fn read_png(bytes: &[u8]) -> Option<Texture> {
    let mut decoder = png::Decoder::new_with_limits(Cursor::new(bytes), Limits { bytes: MAX_PICTURE_BYTES });
    decoder.set_transformations(Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().ok()?;
    let (width, height) = reader.info().size();
    if width.max(height) > MAX_SIDE {
        return None;
    }
    let mut read = vec![0; reader.output_buffer_size().filter(|&size| size <= MAX_PICTURE_BYTES)?];
    let color = reader.next_frame(&mut read).ok()?.color_type;
    let pixels = match color {
        ColorType::Grayscale => read.iter().flat_map(|&l| [l, l, l, 255]).collect(),
        ColorType::GrayscaleAlpha => read.chunks_exact(2).flat_map(|p| [p[0], p[0], p[0], p[1]]).collect(),
        ColorType::Rgb => opaque(&read),
        ColorType::Rgba => read,
        ColorType::Indexed => return None,
    };
    Some(Texture { width, height, pixels })
}

fn read_jpeg(bytes: &[u8]) -> Option<Texture> {
    let side = MAX_SIDE as usize;
    let options = DecoderOptions::default().set_strict_mode(false).set_max_width(side).set_max_height(side);
    let options = options.jpeg_set_out_colorspace(ColorSpace::RGB);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    let pixels = opaque(&decoder.decode().ok()?);
    let (width, height) = decoder.dimensions()?;
    let sized = width.checked_mul(height)?.checked_mul(4) == Some(pixels.len());
    sized.then_some(Texture {
        width: u32::try_from(width).ok()?,
        height: u32::try_from(height).ok()?,
        pixels,
    })
}

/// Media type of the images of [`webp`].
pub(super) const WEBP_TYPE: &str = "image/webp";

/// Encodes the texture as WebP without loss; `None` if it is too large for the format or not sound.
#[cfg(feature = "webp")]
pub(super) fn webp(texture: &Texture) -> Option<Vec<u8>> {
    let Texture { width, height, pixels } = texture;
    // The format ends at this size, and its encoder panics at pixels that do not fit the size.
    if !fits(*width, *height, pixels) || width.max(height) > &16_384 {
        return None;
    }
    let mut bytes = Vec::new();
    image_webp::WebPEncoder::new(&mut bytes)
        .encode(pixels, *width, *height, image_webp::ColorType::Rgba8)
        .ok()?;
    Some(bytes)
}

#[cfg(not(feature = "webp"))]
pub(super) fn webp(_texture: &Texture) -> Option<Vec<u8>> {
    None
}

/// Reads a still WebP within bounds. `None` if it is not one, is broken or too large, and without the feature `webp`.
#[cfg(feature = "webp")]
pub(super) fn read_webp(bytes: &[u8]) -> Option<Texture> {
    let mut decoder = image_webp::WebPDecoder::new(Cursor::new(bytes)).ok()?;
    decoder.set_memory_limit(MAX_PICTURE_BYTES);
    let (width, height) = decoder.dimensions();
    if width.max(height) > MAX_SIDE || decoder.is_animated() {
        return None;
    }
    let mut read = vec![0; decoder.output_buffer_size().filter(|&size| size <= MAX_PICTURE_BYTES)?];
    decoder.read_image(&mut read).ok()?;
    let pixels = if decoder.has_alpha() { read } else { opaque(&read) };
    Some(Texture { width, height, pixels })
}

#[cfg(not(feature = "webp"))]
pub(super) fn read_webp(_bytes: &[u8]) -> Option<Texture> {
    None
}

/// Converts RGB to RGBA.
fn opaque(rgb: &[u8]) -> Vec<u8> {
    rgb.chunks_exact(3).flat_map(|p| [p[0], p[1], p[2], 255]).collect()
}

/// Encoded textures, so that writing a model again (or another with the same textures) does not encode them again.
/// Holds its textures until it is dropped.
#[derive(Debug, Default)]
pub struct PngCache {
    entries: Vec<(Arc<Texture>, Arc<[u8]>)>,
}

impl PngCache {
    /// Returns an empty cache.
    pub fn new() -> Self {
        Self::default()
    }

    /// Returns the texture as a PNG.
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

/// Converts linear 0 to 1 to sRGB 0 to 1 (IEC 61966-2-1).
pub(super) fn srgb(linear: f32) -> f32 {
    let x = f64::from(if linear.is_nan() { 0.0 } else { linear.clamp(0.0, 1.0) });
    narrow(base::srgb_of_linear(x))
}

/// Converts sRGB 0 to 1 to linear 0 to 1.
pub(super) fn linear(srgb: f32) -> f32 {
    let y = f64::from(if srgb.is_nan() { 0.0 } else { srgb.clamp(0.0, 1.0) });
    narrow(base::linear_of_srgb(y))
}

#[expect(clippy::cast_possible_truncation, reason = "colours are f32 by design")]
fn narrow(x: f64) -> f32 {
    x as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn png(color: ColorType, depth: BitDepth, palette: Option<&[u8]>, bytes: &[u8]) -> Texture {
        let mut out = Vec::new();
        let mut encoder = png::Encoder::new(&mut out, 2, 1);
        encoder.set_color(color);
        encoder.set_depth(depth);
        if let Some(palette) = palette {
            encoder.set_palette(palette);
        }
        encoder.write_header().unwrap().write_image_data(bytes).unwrap();
        read_picture(&out).unwrap()
    }

    #[test]
    fn every_kind_of_png_is_read() {
        use BitDepth::{Eight, One, Sixteen};
        let of = |color, depth, bytes: &[u8]| png(color, depth, None, bytes).pixels;
        assert_eq!(of(ColorType::Grayscale, Eight, &[7, 9]), [7, 7, 7, 255, 9, 9, 9, 255]);
        assert_eq!(of(ColorType::Grayscale, One, &[0b0100_0000]), [0, 0, 0, 255, 255, 255, 255, 255]);
        assert_eq!(of(ColorType::GrayscaleAlpha, Eight, &[7, 1, 9, 2]), [7, 7, 7, 1, 9, 9, 9, 2]);
        assert_eq!(of(ColorType::Rgb, Eight, &[1, 2, 3, 4, 5, 6]), [1, 2, 3, 255, 4, 5, 6, 255]);
        assert_eq!(of(ColorType::Grayscale, Sixteen, &[7, 200, 9, 0]), [7, 7, 7, 255, 9, 9, 9, 255]);
        let indexed = png(ColorType::Indexed, One, Some(&[1, 2, 3, 4, 5, 6]), &[0b0100_0000]);
        assert_eq!((indexed.width, indexed.height), (2, 1));
        assert_eq!(indexed.pixels, [1, 2, 3, 255, 4, 5, 6, 255]);
    }

    #[cfg(feature = "webp")]
    #[test]
    fn webp_comes_back_as_it_was_and_broken_ones_are_none() {
        let pixels: Vec<u8> = (0..40 * 23 * 4_u32).map(|i| (i * i / 7 % 251) as u8).collect();
        let texture = Texture { width: 40, height: 23, pixels };
        let bytes = webp(&texture).expect("it fits");
        assert_eq!(bytes, webp(&texture).expect("it fits"), "the same bytes");
        assert_eq!(read_webp(&bytes), Some(texture.clone()));
        for end in 0..bytes.len() {
            assert!(read_webp(&bytes[..end]).is_none_or(|p| p.pixels.len() == 4 * 40 * 23));
        }
        for (at, bit) in (0..bytes.len()).zip([1, 16, 128].into_iter().cycle()) {
            let mut odd = bytes.clone();
            odd[at] ^= bit;
            assert!(read_webp(&odd).is_none_or(|p| p.pixels.len() == 4 * (p.width * p.height) as usize));
        }
        assert_eq!(webp(&Texture { width: 0, height: 0, pixels: Vec::new() }), None);
        assert_eq!(webp(&Texture { width: 2, height: 2, pixels: vec![0; 15] }), None, "not sound");
        assert_eq!(webp(&Texture { width: 20_000, height: 1, pixels: vec![0; 80_000] }), None, "too wide");
    }

    #[test]
    fn every_kind_of_jpeg_is_read() {
        let near = |p: &[u8], want: [u8; 3]| {
            p[3] == 255 && p.iter().zip(want).all(|(&have, want)| have.abs_diff(want) <= 3)
        };
        let (red, green) = ([200, 40, 40], [30, 160, 60]);
        let (dark, light) = ([88; 3], [110; 3]);
        for (bytes, left, right) in [
            (include_bytes!("../../tests/pictures/halves.jpg").as_slice(), red, green),
            (include_bytes!("../../tests/pictures/halves-progressive.jpg"), red, green),
            (include_bytes!("../../tests/pictures/halves-cmyk.jpg"), red, green),
            (include_bytes!("../../tests/pictures/halves-grey.jpg"), dark, light),
        ] {
            let picture = read_picture(bytes).unwrap();
            assert_eq!((picture.width, picture.height, picture.pixels.len()), (16, 16, 1024));
            let pixel = |x: usize, y: usize| &picture.pixels[4 * (16 * y + x)..][..4];
            assert!(near(pixel(2, 2), left), "{:?} is not {left:?}", pixel(2, 2));
            assert!(near(pixel(13, 8), right), "{:?} is not {right:?}", pixel(13, 8));
            // A truncated file gives none, or a picture of that size; never a panic.
            for end in 0..bytes.len() {
                assert!(read_picture(&bytes[..end]).is_none_or(|p| p.pixels.len() == 1024));
            }
        }
    }
}
