//! Randomness is a value: a key names a short stream, so editing one branch never reshuffles another.

use rand_core::{RngCore, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::ops;

/// Purpose of a stream of random numbers. The numbers are part of the file format: never reuse or renumber.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u64)]
#[non_exhaustive]
pub enum Draw {
    /// Rotation of a branch out of the drawing plane.
    BranchDepth = 1,
    /// Deviation of a leaf's azimuth and inclination.
    LeafAngle = 2,
    /// Bending of a blade.
    Curl = 3,
    /// Position of a twig along its bearer.
    TwigPlace = 4,
    /// Template that a filled leaf copies.
    Template = 5,
    /// Size variation.
    Size = 6,
    /// Colour variation of an organ.
    Tint = 7,
    /// Depth of twigs and leaves inside a crown.
    CrownDepth = 8,
    /// Phyllotaxis offset.
    Phyllotaxis = 9,
    /// Procedural texture.
    Texture = 10,
    /// Samples of a renderer.
    Sampling = 11,
    /// Attraction points of a volume.
    Attractors = 12,
    /// Folds of the training set.
    Folds = 13,
    /// Anything that a test needs.
    Test = 14,
    /// Phase of a branch or organ in the wind.
    Wind = 15,
    /// Position, rotation and size of copies of a plant.
    Scatter = 16,
    /// Difference of a tree from others of its kind.
    Habit = 17,
    /// Time at which a leaf turns and falls in autumn.
    Season = 18,
    /// Positions of the trees of a stand and of their seedlings, their vigour and their mortality.
    Stand = 19,
}

/// A 64-bit seed from which independent streams and child seeds are derived.
///
/// Guaranteed: the same seed and keys give the same numbers on every platform and in every later version.
/// Not guaranteed: cryptographic quality.
///
/// ```
/// use base::{Draw, Seed};
/// let leaf = Seed::new(1).child(7);
/// let a = leaf.stream(Draw::Curl).uniform();
/// assert_eq!(a, leaf.stream(Draw::Curl).uniform());
/// assert_ne!(a, leaf.stream(Draw::Size).uniform());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Seed(u64);

impl Seed {
    /// Makes a seed of the number that the user gave.
    pub const fn new(number: u64) -> Self {
        Self(number)
    }

    /// Returns the number as it is saved.
    pub const fn number(self) -> u64 {
        self.0
    }

    /// Returns the seed of a part, named by a key that is stable under edits (bearer's key, birth rank).
    #[must_use]
    pub const fn child(self, key: u64) -> Self {
        Self(mix(self.0 ^ mix(key.wrapping_add(0x9e37_79b9_7f4a_7c15))))
    }

    /// Starts a fresh stream for one purpose.
    pub fn stream(self, draw: Draw) -> Stream {
        Stream { rng: Pcg64Mcg::seed_from_u64(self.child(draw as u64).0) }
    }
}

impl Default for Seed {
    fn default() -> Self {
        Self(1)
    }
}

// SplitMix64's finaliser (Steele, Lea and Flood 2014).
const fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// A short stream of random numbers. The distributions are our own: they are part of the file format.
#[derive(Clone, Debug)]
pub struct Stream {
    rng: Pcg64Mcg,
}

impl Stream {
    /// Draws uniformly from \[0, 1), with 53 bits.
    pub fn uniform(&mut self) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "53 bits fit")]
        let x = (self.rng.next_u64() >> 11) as f64;
        x * (1.0 / 9_007_199_254_740_992.0)
    }

    /// Draws uniformly from \[lo, hi).
    pub fn range(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.uniform()
    }

    /// Draws uniformly from `0..n`; 0 for `n = 0`.
    pub fn below(&mut self, n: usize) -> usize {
        #[expect(clippy::cast_possible_truncation, reason = "the product's high half is below n")]
        let x = ((u128::from(self.rng.next_u64()) * n as u128) >> 64) as usize;
        x
    }

    /// Draws from the normal distribution with mean 0 and standard deviation 1 (Box and Muller, one of the pair).
    pub fn normal(&mut self) -> f64 {
        let u = 1.0 - self.uniform();
        let v = self.uniform();
        (-2.0 * ops::ln(u)).sqrt() * ops::cos(ops::TAU * v)
    }

    /// Draws two independent values as [`normal`](Self::normal) does, in little more than the time of one.
    pub fn normals(&mut self) -> [f64; 2] {
        let u = 1.0 - self.uniform();
        let (sin, cos) = ops::sin_cos(ops::TAU * self.uniform());
        let far = (-2.0 * ops::ln(u)).sqrt();
        [far * cos, far * sin]
    }

    /// Returns true with probability `p`.
    pub fn chance(&mut self, p: f64) -> bool {
        self.uniform() < p
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_are_part_of_the_file_format() {
        let mut s = Seed::new(1).child(42).stream(Draw::Curl);
        let got: Vec<u64> = (0..3).map(|_| s.uniform().to_bits()).collect();
        assert_eq!(got, STREAM_OF_SEED_1_KEY_42_CURL, "a change here breaks every saved document");
    }
    const STREAM_OF_SEED_1_KEY_42_CURL: [u64; 3] =
        [4602489801792545172, 4601685374403273954, 4603323339654154011];

    #[test]
    fn uniform_and_normal_have_their_moments() {
        let mut s = Seed::new(5).stream(Draw::Test);
        let n = 20_000;
        let (mut mu, mut mn, mut vn) = (0.0, 0.0, 0.0);
        for _ in 0..n {
            mu += s.uniform();
            let z = s.normal();
            mn += z;
            vn += z * z;
        }
        let n = f64::from(n);
        assert!(
            (mu / n - 0.5).abs() < 0.01 && (mn / n).abs() < 0.03 && (vn / n - 1.0).abs() < 0.05,
            "{mu} {mn} {vn}"
        );
    }

    #[test]
    fn below_covers_its_range_and_survives_zero() {
        let mut s = Seed::new(9).stream(Draw::Test);
        let mut seen = [false; 7];
        (0..500).for_each(|_| seen[s.below(7)] = true);
        assert!(seen.iter().all(|&b| b), "{seen:?}");
        assert_eq!(s.below(0), 0);
    }
}
