//! A support vector machine as bytes: `Svm -> bytes -> Svm`, for programs that carry one.
//!
//! LIBSVM's text is six times as long and takes longer to read. Little endian: classes and columns (u32), labels
//! (i32), vectors of each class (u32), gamma and rho (f64), then coefficients (f32) and vectors (i16, in [`GRAIN`])
//! column by column, because the numbers of a column are alike and so compress better.

use super::svm::{Svm, SvmError};

/// First bytes of the format.
pub(super) const MAGIC: &[u8] = b"svm2";

/// Numbers of vectors are whole multiples of this, in standard deviations of their feature: half a step is far below
/// what a steady hand repeats, and whole numbers of 16 bits compress to half the size of f32.
pub(super) const GRAIN: f32 = 1.0 / 1024.0;

/// Reads a machine for rows of `columns` numbers.
///
/// # Errors
/// [`SvmError`] where the bytes are not such a machine.
pub(super) fn unpack(mut bytes: &[u8], columns: usize) -> Result<Svm, SvmError> {
    let from = &mut bytes;
    if take(from, MAGIC.len())? != MAGIC {
        return Err(fault("not a packed machine"));
    }
    let &[classes, found] = &numbers(from, 2, u32::from_le_bytes)?[..] else { return Err(cut()) };
    let classes = classes as usize;
    if classes < 2 || found as usize != columns {
        return Err(fault("the features have changed: run `cargo xtask train-strokes`"));
    }
    let labels = numbers(from, classes, i32::from_le_bytes)?;
    let mut starts = vec![0_usize];
    for count in numbers(from, classes, u32::from_le_bytes)? {
        let end = starts.last().and_then(|s| s.checked_add(count as usize));
        starts.push(end.ok_or_else(cut)?);
    }
    let vectors = starts.last().copied().unwrap_or(0);
    let &[gamma] = &numbers(from, 1, f64::from_le_bytes)?[..] else { return Err(cut()) };
    let rho = numbers(from, classes.saturating_mul(classes - 1) / 2, f64::from_le_bytes)?;
    let coefficients =
        numbers(from, vectors.saturating_mul(classes - 1), |b| f64::from(f32::from_le_bytes(b)))?;
    let values =
        numbers(from, vectors.saturating_mul(columns), |b| f32::from(i16::from_le_bytes(b)) * GRAIN)?;
    if !from.is_empty() {
        return Err(fault("more bytes than the machine has"));
    }
    Ok(Svm::new(gamma, labels, rho, starts, &coefficients, &values))
}

fn fault(what: impl Into<String>) -> SvmError {
    SvmError { line: 0, what: what.into() }
}

fn cut() -> SvmError {
    fault("cut off")
}

fn take<'a>(from: &mut &'a [u8], count: usize) -> Result<&'a [u8], SvmError> {
    let (taken, rest) = from.split_at_checked(count).ok_or_else(cut)?;
    *from = rest;
    Ok(taken)
}

/// Reads `count` numbers of `N` bytes each.
fn numbers<T, const N: usize>(
    from: &mut &[u8],
    count: usize,
    read: fn([u8; N]) -> T,
) -> Result<Vec<T>, SvmError> {
    let (numbers, _) = take(from, count.saturating_mul(N))?.as_chunks::<N>();
    Ok(numbers.iter().map(|&bytes| read(bytes)).collect())
}
