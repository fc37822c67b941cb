//! A fingerprint of a result that does not depend on the machine.

use core::fmt;

use glam::{DVec2, DVec3};
use sha2::{Digest as _, Sha256};

/// SHA-256 over a canonical byte form: little-endian, `-0.0` as `0.0`, every NaN alike, lengths before items.
///
/// ```
/// use base::{Digest, Digestible};
/// let hex = |x: &[f64]| { let mut d = Digest::new(); x.digest(&mut d); d.hex() };
/// assert_eq!(hex(&[0.0, 1.0]), hex(&[-0.0, 1.0]));
/// assert_ne!(hex(&[0.0, 1.0]), hex(&[1.0, 0.0]));
/// ```
#[derive(Clone, Default)]
pub struct Digest(Sha256);

impl fmt::Debug for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Digest({})", self.clone().hex())
    }
}

impl Digest {
    /// Creates an empty digest.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds anything digestible to the digest.
    pub fn add<T: Digestible + ?Sized>(&mut self, value: &T) -> &mut Self {
        value.digest(self);
        self
    }

    /// Adds raw bytes to the digest, without their length.
    pub fn bytes(&mut self, bytes: &[u8]) -> &mut Self {
        self.0.update(bytes);
        self
    }

    /// Returns the first 16 bytes as 32 hexadecimal digits.
    pub fn hex(self) -> String {
        use core::fmt::Write as _;
        self.0.finalize()[..16].iter().fold(String::with_capacity(32), |mut s, b| {
            let _ = write!(s, "{b:02x}");
            s
        })
    }
}

/// A value with a canonical byte form.
pub trait Digestible {
    /// Adds the value's canonical form to `d`.
    fn digest(&self, d: &mut Digest);
}

macro_rules! digest_ints {
    ($($t:ty),+) => { $(impl Digestible for $t {
        fn digest(&self, d: &mut Digest) { d.bytes(&self.to_le_bytes()); }
    })+ };
}
digest_ints!(u8, u16, u32, u64, i32, i64);

impl Digestible for f64 {
    fn digest(&self, d: &mut Digest) {
        let canonical = if self.is_nan() { Self::NAN } else { *self + 0.0 };
        d.bytes(&canonical.to_bits().to_le_bytes());
    }
}

impl Digestible for f32 {
    fn digest(&self, d: &mut Digest) {
        let canonical = if self.is_nan() { Self::NAN } else { *self + 0.0 };
        d.bytes(&canonical.to_bits().to_le_bytes());
    }
}

impl Digestible for bool {
    fn digest(&self, d: &mut Digest) {
        u8::from(*self).digest(d);
    }
}

impl Digestible for str {
    fn digest(&self, d: &mut Digest) {
        (self.len() as u64).digest(d);
        d.bytes(self.as_bytes());
    }
}

impl Digestible for DVec2 {
    fn digest(&self, d: &mut Digest) {
        d.add(&self.x).add(&self.y);
    }
}

impl Digestible for DVec3 {
    fn digest(&self, d: &mut Digest) {
        d.add(&self.x).add(&self.y).add(&self.z);
    }
}

impl<T: Digestible> Digestible for [T] {
    fn digest(&self, d: &mut Digest) {
        (self.len() as u64).digest(d);
        self.iter().for_each(|x| x.digest(d));
    }
}

impl<T: Digestible> Digestible for Vec<T> {
    fn digest(&self, d: &mut Digest) {
        self.as_slice().digest(d);
    }
}

impl<T: Digestible, const N: usize> Digestible for [T; N] {
    fn digest(&self, d: &mut Digest) {
        self.iter().for_each(|x| x.digest(d));
    }
}

impl<T: Digestible> Digestible for Option<T> {
    fn digest(&self, d: &mut Digest) {
        match self {
            None => 0_u8.digest(d),
            Some(x) => {
                1_u8.digest(d);
                x.digest(d);
            }
        }
    }
}
