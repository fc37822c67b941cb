//! The curve of sRGB (IEC 61966-2-1).

use crate::ops;

/// A share of light, 0 to 1, of an sRGB value from 0 to 1.
///
/// ```
/// assert_eq!((base::linear_of_srgb(0.0), base::linear_of_srgb(1.0)), (0.0, 1.0));
/// assert!((base::srgb_of_linear(base::linear_of_srgb(0.3)) - 0.3).abs() < 1e-6);
/// ```
pub fn linear_of_srgb(srgb: f64) -> f64 {
    if srgb <= 0.040_45 { srgb / 12.92 } else { ops::powf((srgb + 0.055) / 1.055, 2.4) }
}

/// The sRGB value, 0 to 1, of a share of light from 0 to 1.
pub fn srgb_of_linear(light: f64) -> f64 {
    if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * ops::powf(light, 1.0 / 2.4) - 0.055 }
}
