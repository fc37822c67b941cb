//! Columns of instances, compressed.

use super::meshopt::encode_attributes;
use super::meshopt_filter::{EXPONENTIAL, QUATERNION, exponential, power_within, quaternion};

/// Rows as `EXT_meshopt_compression` stores them.
#[derive(Debug)]
pub(crate) struct CompressedColumn {
    /// The bytes.
    pub(crate) stream: Vec<u8>,
    /// Bytes of a row after decompression.
    pub(crate) stride: usize,
    /// The filter of the rows, by its name in the extension.
    pub(crate) filter: Option<&'static str>,
}

/// Compresses rows of `width` floats, to half of `step`, which is above 0.
pub(crate) fn compressed_floats(numbers: &[f64], width: usize, step: f64) -> CompressedColumn {
    let power = power_within(step);
    let bytes: Vec<u8> = numbers.iter().flat_map(|&x| exponential(x, power)).collect();
    let stride = 4 * width;
    CompressedColumn { stream: encode_attributes(&bytes, stride), stride, filter: Some(EXPONENTIAL) }
}

/// Compresses rotations, to two thirds of a degree.
pub(crate) fn compressed_turns(turns: &[[f64; 4]]) -> CompressedColumn {
    let bytes: Vec<u8> = turns.iter().flat_map(|&q| quaternion(q)).collect();
    CompressedColumn { stream: encode_attributes(&bytes, 8), stride: 8, filter: Some(QUATERNION) }
}
