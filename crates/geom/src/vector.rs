//! Common interface of 2-D and 3-D points, and the definition of usable points.

use core::ops::{Add, Mul, Sub};
use glam::{DVec2, DVec3};

// Largest coordinate, 1e100: squares (1e200) and sums of many squares stay far below f64's 1.8e308.
const LIMIT: f64 = 1e100;

/// A point or vector of two or three coordinates.
pub(crate) trait Vector:
    Copy + PartialEq + Add<Output = Self> + Sub<Output = Self> + Mul<f64, Output = Self>
{
    fn dot(self, other: Self) -> f64;
    /// Whether every coordinate is finite and at most 1e100.
    fn usable(self) -> bool;
    fn length(self) -> f64 {
        self.dot(self).sqrt()
    }
    fn distance(self, other: Self) -> f64 {
        (self - other).length()
    }
    /// Returns the direction, or `None` for a vector without length.
    fn direction(self) -> Option<Self> {
        let length = self.length();
        (length > 0.0 && length.is_finite()).then(|| self * (1.0 / length)).filter(|d| d.usable())
    }
}

impl Vector for DVec2 {
    fn dot(self, other: Self) -> f64 {
        self.x * other.x + self.y * other.y
    }
    fn usable(self) -> bool {
        self.x.abs() <= LIMIT && self.y.abs() <= LIMIT
    }
}

impl Vector for DVec3 {
    fn dot(self, other: Self) -> f64 {
        self.x * other.x + self.y * other.y + self.z * other.z
    }
    fn usable(self) -> bool {
        self.x.abs() <= LIMIT && self.y.abs() <= LIMIT && self.z.abs() <= LIMIT
    }
}

/// Returns the usable points, each different from the one before.
pub(crate) fn distinct<V: Vector>(points: &[V]) -> Vec<V> {
    let mut out: Vec<V> = Vec::with_capacity(points.len());
    for &p in points.iter().filter(|p| p.usable()) {
        if out.last().is_none_or(|&q| q.distance(p) > 0.0) {
            out.push(p);
        }
    }
    out
}

/// As [`distinct`], for a closed line: the last point does not repeat the first either.
pub(crate) fn distinct_closed<V: Vector>(points: &[V]) -> Vec<V> {
    let mut out = distinct(points);
    while out.len() > 1 && out[0].distance(out[out.len() - 1]) <= 0.0 {
        out.pop();
    }
    out
}

/// Rounds a non-negative number down to an index of at most `max`; NaN gives 0.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped before the cast")]
pub(crate) fn to_index(x: f64, max: usize) -> usize {
    if x >= max as f64 { max } else { x.max(0.0) as usize }
}
