//! EXR pictures of 16-bit floats, without compression: tables that a shader looks up.

use std::io::Write;

use crate::error::WriteError;

/// First bytes of the format, and its version 2: one part of scan lines.
const MAGIC: [u8; 8] = [0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0];
/// Type of pixels: half.
const HALF: i32 = 1;

/// Writes a picture as EXR with the channels R, G, B and A of 16 bits each, row by row from the top; `pixels` are the
/// bits of each number ([`half_bits`]).
///
/// Guaranteed: the same pixels give the same bytes, and every bit of a number is kept.
///
/// # Errors
/// [`WriteError::Texture`] if the sizes disagree or are zero; [`WriteError::Io`] of the sink.
///
/// ```
/// let mut exr = Vec::new();
/// formats::write_exr(1, 1, &[[formats::half_bits(1.0), 0, 0, 0x3c00]], &mut exr)?;
/// assert_eq!((&exr[..4], &exr[exr.len() - 2..]), (&[0x76, 0x2f, 0x31, 0x01][..], &[0x00, 0x3c][..]));
/// # Ok::<(), formats::WriteError>(())
/// ```
pub fn write_exr(
    width: u32,
    height: u32,
    pixels: &[[u16; 4]],
    mut out: impl Write,
) -> Result<(), WriteError> {
    let fault = || WriteError::Texture { width, height, bytes: 8 * pixels.len() };
    let sides = i32::try_from(width).ok().zip(i32::try_from(height).ok()).filter(|(w, h)| *w > 0 && *h > 0);
    let Some((columns, rows)) = sides else { return Err(fault()) };
    if pixels.len() as u64 != u64::from(width) * u64::from(height) {
        return Err(fault());
    }
    let mut bytes = header(columns, rows);
    let line = 8 + 8 * pixels.len() / height as usize;
    let first = bytes.len() + 8 * height as usize;
    for row in 0..height as usize {
        bytes.extend_from_slice(&((first + row * line) as u64).to_le_bytes());
    }
    for (row, line) in (0..rows).zip(pixels.chunks_exact(width as usize)) {
        bytes.extend_from_slice(&row.to_le_bytes());
        bytes.extend_from_slice(&(8 * columns).to_le_bytes());
        // Channels lie in the order of their names: A, B, G, R.
        for channel in [3, 2, 1, 0] {
            line.iter().for_each(|pixel| bytes.extend_from_slice(&pixel[channel].to_le_bytes()));
        }
    }
    Ok(out.write_all(&bytes)?)
}

/// Returns everything before the table of offsets.
fn header(columns: i32, rows: i32) -> Vec<u8> {
    let mut channels = Vec::new();
    for name in ["A", "B", "G", "R"] {
        channels.extend_from_slice(name.as_bytes());
        channels.push(0);
        // Half, not perceptual, a sample in each pixel of both directions.
        [HALF, 0, 1, 1].iter().for_each(|x| channels.extend_from_slice(&x.to_le_bytes()));
    }
    channels.push(0);
    let window: Vec<u8> = [0, 0, columns - 1, rows - 1].iter().flat_map(|x| x.to_le_bytes()).collect();
    let one = 1.0_f32.to_le_bytes();
    let attributes: [(&str, &str, &[u8]); 8] = [
        ("channels", "chlist", &channels),
        ("compression", "compression", &[0]),
        ("dataWindow", "box2i", &window),
        ("displayWindow", "box2i", &window),
        ("lineOrder", "lineOrder", &[0]),
        ("pixelAspectRatio", "float", &one),
        ("screenWindowCenter", "v2f", &[0; 8]),
        ("screenWindowWidth", "float", &one),
    ];
    let mut bytes = MAGIC.to_vec();
    for (name, of, value) in attributes {
        for text in [name, of] {
            bytes.extend_from_slice(text.as_bytes());
            bytes.push(0);
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_possible_wrap, reason = "73 bytes at most")]
        bytes.extend_from_slice(&(value.len() as i32).to_le_bytes());
        bytes.extend_from_slice(value);
    }
    bytes.push(0);
    bytes
}

/// Returns the bits of the 16-bit float nearest to a number, of two at equal distances the even one; what is beyond them is
/// the greatest of its sign, and what is not a number 0.
///
/// ```
/// assert_eq!([0.0, 1.0, -2.0, 65504.0, 1e9].map(formats::half_bits), [0, 0x3c00, 0xc000, 0x7bff, 0x7bff]);
/// assert_eq!([6.0e-8, 2.9e-8, 1.0 / 3.0].map(formats::half_bits), [1, 0, 0x3555]);
/// ```
pub fn half_bits(x: f32) -> u16 {
    const GREATEST: f32 = 65_504.0;
    /// Bits of 2^-14, below which steps are 2^-24.
    const NORMAL: u32 = 0x3880_0000;
    /// Difference of the biases of both exponents, at its place.
    const BIAS: u32 = (127 - 15) << 23;
    if x.is_nan() {
        return 0;
    }
    let bits = x.clamp(-GREATEST, GREATEST).to_bits();
    let (sign, size) = (bits >> 16 & 0x8000, bits & 0x7fff_ffff);
    let half = if size < NORMAL {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 1024 steps")]
        let steps = (f32::from_bits(size) * 16_777_216.0).round_ties_even() as u32;
        steps
    } else {
        (size + 0xfff + (size >> 13 & 1) - BIAS) >> 13
    };
    #[expect(clippy::cast_possible_truncation, reason = "16 bits")]
    let bits = (sign | half) as u16;
    bits
}
