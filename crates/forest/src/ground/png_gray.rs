//! PNG -> grey levels.

use std::io::Cursor;

use base::{Counted, Run};
use png::{BitDepth, ColorType, Limits, Transformations};

use super::GroundError;

/// Grey levels, rows from the top.
pub(super) struct Gray {
    pub(super) width: usize,
    pub(super) height: usize,
    /// Two bytes for each pixel, the high one first, if the picture has 16 bits; else one.
    pub(super) bytes: Vec<u8>,
    pub(super) is_deep: bool,
}

/// Reads a picture whose size the budget allows. `is_deep` demands 16 bits of grey and refuses anything else;
/// otherwise any picture is converted to 8 bits of grey.
pub(super) fn read(bytes: &[u8], is_deep: bool, run: &Run<'_>) -> Result<Gray, GroundError> {
    let what = if is_deep { "height map" } else { "mask" };
    let fault = |e: png::DecodingError| GroundError::Unreadable(what, base::brief(&e.to_string()));
    let most = usize::try_from(run.budget.bytes()).unwrap_or(usize::MAX);
    let mut decoder = png::Decoder::new_with_limits(Cursor::new(bytes), Limits { bytes: most });
    let wanted = if is_deep { Transformations::IDENTITY } else { Transformations::normalize_to_color8() };
    decoder.set_transformations(wanted);
    let mut reader = decoder.read_info().map_err(fault)?;
    let (width, height) = reader.info().size();
    run.budget.check(
        Counted::Cells,
        u64::from(width) * u64::from(height),
        "take larger cells, or a cut-out",
    )?;
    let (color, depth) = (reader.info().color_type, reader.info().bit_depth);
    if is_deep && (color, depth) != (ColorType::Grayscale, BitDepth::Sixteen) {
        let grey = if color == ColorType::Grayscale { "of grey" } else { "of colour" };
        return Err(GroundError::Depth(format!("{} bits {grey}", depth as u8)));
    }
    let size = reader.output_buffer_size().filter(|size| *size <= most);
    let mut read = vec![0; size.ok_or_else(|| GroundError::Unreadable(what, "it is too large".into()))?];
    let info = reader.next_frame(&mut read).map_err(fault)?;
    read.truncate(info.buffer_size());
    let samples = if is_deep { 1 } else { info.color_type.samples() };
    if samples > 1 {
        // Alpha is not grey: transparent pixels count with their colour.
        let colors: u8 = if samples >= 3 { 3 } else { 1 };
        let grey = |p: &[u8]| {
            p[..usize::from(colors)].iter().map(|&v| u32::from(v)).sum::<u32>() / u32::from(colors)
        };
        read = read.chunks_exact(samples).map(|p| u8::try_from(grey(p)).unwrap_or(u8::MAX)).collect();
    }
    Ok(Gray { width: width as usize, height: height as usize, bytes: read, is_deep })
}

impl Gray {
    /// Returns the level of a pixel.
    pub(super) fn level(&self, k: usize) -> u16 {
        if self.is_deep {
            u16::from_be_bytes([self.bytes[2 * k], self.bytes[2 * k + 1]])
        } else {
            u16::from(self.bytes[k])
        }
    }
}
