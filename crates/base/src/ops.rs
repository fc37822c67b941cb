//! Transcendental functions with the same bits on native and WASM.
//!
//! `std`'s `sin`, `exp`, `powf`, `atan2` and `ln` call the platform's libm and differ between native and
//! wasm32 in 3 to 24 % of calls. These call the `libm` crate everywhere, at about the same speed. Square
//! roots, rounding and the four operations are exact by IEEE 754 and may be used from `std`.
//!
//! ```
//! assert_eq!(base::ops::sin(0.0), 0.0);
//! let (s, c) = base::ops::sin_cos(1.0);
//! assert!((s * s + c * c - 1.0).abs() < 1e-15);
//! ```

/// The ratio of a circle's circumference to its diameter.
pub use core::f64::consts::{FRAC_PI_2, PI, TAU};

pub use crate::exps::exps;

macro_rules! forward {
    ($($(#[$doc:meta])* $name:ident($($arg:ident),+) = $to:path;)+) => {
        $($(#[$doc])* #[inline] pub fn $name($($arg: f64),+) -> f64 { $to($($arg),+) })+
    };
}

forward! {
    /// Sine of an angle in radians.
    sin(x) = libm::sin;
    /// Cosine of an angle in radians.
    cos(x) = libm::cos;
    /// Tangent of an angle in radians.
    tan(x) = libm::tan;
    /// Inverse sine, in \[-pi/2, pi/2\]; NaN outside \[-1, 1\].
    asin(x) = libm::asin;
    /// Inverse cosine, in \[0, pi\]; NaN outside \[-1, 1\] (see [`acos_clamped`]).
    acos(x) = libm::acos;
    /// Inverse tangent, in (-pi/2, pi/2).
    atan(x) = libm::atan;
    /// Angle of the vector `(x, y)`, in (-pi, pi].
    atan2(y, x) = libm::atan2;
    /// Natural exponential.
    exp(x) = libm::exp;
    /// Natural logarithm.
    ln(x) = libm::log;
    /// `x` to the power `y`.
    powf(x, y) = libm::pow;
    /// Cube root.
    cbrt(x) = libm::cbrt;
    /// Hyperbolic tangent.
    tanh(x) = libm::tanh;
    /// Length of `(x, y)` without overflow.
    hypot(x, y) = libm::hypot;
}

/// Returns the sine and cosine of an angle in radians.
#[inline]
pub fn sin_cos(x: f64) -> (f64, f64) {
    libm::sincos(x)
}

/// Returns the inverse cosine of `x` clamped to \[-1, 1\]: the angle of two unit vectors from their dot product.
#[inline]
pub fn acos_clamped(x: f64) -> f64 {
    libm::acos(x.clamp(-1.0, 1.0))
}

/// Rounds down a float that is known to be a small count; values below 0 become 0.
#[inline]
pub fn whole(x: f64) -> u32 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to u32's range")]
    let n = x.clamp(0.0, 4e9) as u32;
    n
}

/// Interpolates linearly: `a` at `t = 0`, `b` at `t = 1`.
#[inline]
pub fn lerp(a: f64, b: f64, t: f64) -> f64 {
    a + (b - a) * t
}

/// Computes a Hermite step: 0 up to `lo`, 1 from `hi`, smooth between. `lo < hi`.
#[inline]
pub fn smoothstep(lo: f64, hi: f64, x: f64) -> f64 {
    let t = ((x - lo) / (hi - lo)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
