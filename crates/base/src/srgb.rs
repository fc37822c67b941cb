//! The transfer curve of sRGB (IEC 61966-2-1).

use std::sync::OnceLock;

use crate::ops;

/// Returns the linear light, 0 to 1, of an sRGB value from 0 to 1.
///
/// ```
/// assert_eq!((base::linear_of_srgb(0.0), base::linear_of_srgb(1.0)), (0.0, 1.0));
/// assert!((base::srgb_of_linear(base::linear_of_srgb(0.3)) - 0.3).abs() < 1e-6);
/// ```
pub fn linear_of_srgb(srgb: f64) -> f64 {
    if srgb <= 0.040_45 { srgb / 12.92 } else { ops::powf((srgb + 0.055) / 1.055, 2.4) }
}

/// Returns the sRGB value, 0 to 1, of linear light from 0 to 1.
pub fn srgb_of_linear(light: f64) -> f64 {
    if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * ops::powf(light, 1.0 / 2.4) - 0.055 }
}

/// Returns the linear light of an sRGB byte: [`linear_of_srgb`] from a table of 256 entries.
#[inline]
pub fn light_of_byte(byte: u8) -> f64 {
    static TABLE: OnceLock<[f64; 256]> = OnceLock::new();
    let of = |b: usize| linear_of_srgb(b as f64 / 255.0);
    TABLE.get_or_init(|| core::array::from_fn(of))[usize::from(byte)]
}

/// Returns the linear colour of sRGB bytes, as materials have it.
#[expect(clippy::cast_possible_truncation, reason = "colours are f32 in materials")]
pub fn linear_color(bytes: [u8; 3]) -> [f32; 3] {
    bytes.map(|byte| light_of_byte(byte) as f32)
}

/// Returns the sRGB byte nearest to a linear light; values beyond 0 and 1 are clamped, NaN becomes 0.
///
/// ```
/// assert!((0..=255).all(|b| base::byte_of_light(base::light_of_byte(b)) == b));
/// assert_eq!([-1.0, 2.0, f64::NAN].map(base::byte_of_light), [0, 255, 0]);
/// ```
pub fn byte_of_light(light: f64) -> u8 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to a byte's range")]
    let byte = (srgb_of_linear(light.clamp(0.0, 1.0)) * 255.0 + 0.5) as u8;
    byte
}
