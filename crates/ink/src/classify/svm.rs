//! A support vector machine that gives the same bits everywhere.
//!
//! It is our own because LIBSVM's ports call `std`'s `exp`, which differs between native and WASM.

use base::ops;

/// Reason why a model's text cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line} of the model: {what}")]
pub struct SvmError {
    /// Line, counted from 1; 0 for the text as a whole.
    pub line: usize,
    /// The fault in words.
    pub what: String,
}

pub(super) fn fault(line: usize, what: impl Into<String>) -> SvmError {
    SvmError { line, what: what.into() }
}

/// A trained machine.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Svm {
    pub(super) gamma: f64,
    /// The classes' numbers, in the model's order.
    pub(super) labels: Vec<i32>,
    pub(super) rho: Vec<f64>,
    /// First support vector of each class, and one past the last.
    pub(super) starts: Vec<usize>,
    /// `coefficients[v * (classes - 1) + k]`.
    pub(super) coefficients: Vec<f64>,
    /// `vectors[v * stride + k]`; single precision, for half the time: a distance is then right to 1e-5.
    pub(super) vectors: Vec<f32>,
    /// Columns, rounded up to whole [`LANES`] with zeros.
    pub(super) stride: usize,
    /// Squared lengths of the vectors.
    pub(super) squares: Vec<f32>,
}

/// Number of parallel sums, which the processor adds at once.
pub(super) const LANES: usize = 8;

impl Svm {
    /// Makes a machine of numbers as they are packed: coefficients and vectors column by column, `starts` with the end
    /// of the last.
    pub(super) fn new(
        gamma: f64,
        labels: Vec<i32>,
        rho: Vec<f64>,
        starts: Vec<usize>,
        coefficients: &[f64],
        values: &[f32],
    ) -> Self {
        let count = starts.last().copied().unwrap_or(0).max(1);
        let (others, stride) = (labels.len() - 1, (values.len() / count).next_multiple_of(LANES));
        let mut svm = Self {
            gamma,
            labels,
            rho,
            starts,
            coefficients: vec![0.0; coefficients.len()],
            vectors: vec![0.0; count * stride],
            stride,
            squares: Vec::new(),
        };
        for (k, column) in coefficients.chunks_exact(count).enumerate() {
            for (row, &c) in svm.coefficients.chunks_exact_mut(others).zip(column) {
                row[k] = c;
            }
        }
        for (k, column) in values.chunks_exact(count).enumerate() {
            for (row, &v) in svm.vectors.chunks_exact_mut(stride).zip(column) {
                row[k] = v;
            }
        }
        svm.square();
        svm
    }

    pub(super) fn square(&mut self) {
        self.squares = self.vectors.chunks_exact(self.stride.max(1)).map(|v| dot(v, v)).collect();
    }

    /// Returns the confidence of each class, in the order of `labels`: positive, summing to 1.
    ///
    /// Each pair's decision value d becomes a probability 1 / (1 + e^(-2 d)); a class's share is
    /// 1 / (sum over the others of 1 / p - (classes - 2)) (Price, Knerr, Personnaz and Dreyfus 1995), normalised.
    pub(super) fn shares(&self, row: &[f64]) -> Vec<f64> {
        #[expect(clippy::cast_possible_truncation, reason = "scaled features lie within 5 deviations")]
        let mut row: Vec<f32> = row.iter().map(|&x| x as f32).collect();
        row.resize(self.stride, 0.0);
        // |v - r|^2 = |v|^2 + |r|^2 - 2 v.r: one product for each element instead of two more operations.
        let square = dot(&row, &row);
        let distances: Vec<f64> = (self.vectors.chunks_exact(self.stride.max(1)).zip(&self.squares))
            .map(|(v, own)| f64::from((own + square - 2.0 * dot(v, &row)).max(0.0)))
            .collect();
        let mut kernel = vec![0.0; distances.len()];
        ops::exps(-self.gamma, &distances, &mut kernel);
        let n = self.labels.len();
        // For each class, the weighted kernels of its own vectors against each other class.
        let mut halves = vec![0.0; n * (n - 1)];
        for class in 0..n {
            let row = &mut halves[class * (n - 1)..(class + 1) * (n - 1)];
            let own = self.starts[class]..self.starts[class + 1];
            for (weights, k) in
                self.coefficients.chunks_exact(n - 1).zip(&kernel).take(own.end).skip(own.start)
            {
                for (sum, c) in row.iter_mut().zip(weights) {
                    *sum += c * k;
                }
            }
        }
        let mut doubt = vec![0.0; n];
        let mut pair = 0;
        for i in 0..n {
            for j in i + 1..n {
                let d = halves[i * (n - 1) + j - 1] + halves[j * (n - 1) + i] - self.rho[pair];
                let e = ops::exp(-2.0 * d.clamp(-8.0, 8.0));
                // 1 / p is 1 + e for i, and 1 + 1 / e for j.
                doubt[i] += 1.0 + e;
                doubt[j] += 1.0 + 1.0 / e;
                pair += 1;
            }
        }
        let shares: Vec<f64> = doubt.iter().map(|d| 1.0 / (d - (n as f64 - 2.0)).max(1e-9)).collect();
        let sum: f64 = shares.iter().sum();
        shares.into_iter().map(|s| s / sum).collect()
    }
}

/// Returns the dot product of slices of whole lanes.
fn dot(a: &[f32], b: &[f32]) -> f32 {
    let mut sums = [0.0; LANES];
    for (x, y) in a.chunks_exact(LANES).zip(b.chunks_exact(LANES)) {
        for k in 0..LANES {
            sums[k] += x[k] * y[k];
        }
    }
    sums.iter().sum()
}

pub(super) fn numbers<'a, T: core::str::FromStr>(
    line: usize,
    words: impl Iterator<Item = &'a str>,
) -> Result<Vec<T>, SvmError> {
    words.map(|w| w.parse().map_err(|_e| fault(line, format!("{w} is not a number")))).collect()
}

/// Mean and deviation of each column, so that every feature weighs the same.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Scale {
    /// Mean and one over the deviation.
    pub(super) columns: Vec<(f64, f64)>,
}

impl Scale {
    /// Scales a row and limits it to 5 deviations, so that no single feature of an odd drawing decides alone.
    pub(super) fn apply(&self, row: &[f64]) -> Vec<f64> {
        self.columns
            .iter()
            .zip(row)
            .map(|(&(mean, scale), x)| ((x - mean) * scale).clamp(-5.0, 5.0))
            .collect()
    }

    /// Reads one line a column (name, mean, one over the deviation); the names must be these, in this order.
    pub(super) fn parse(text: &str, names: &[&str]) -> Result<Self, SvmError> {
        let mut columns = Vec::new();
        for (k, content) in text.lines().enumerate() {
            let line = k + 1;
            let mut words = content.split_whitespace();
            if words.next() != names.get(k).copied() {
                return Err(fault(line, "the features have changed: run `cargo xtask train-strokes`"));
            }
            match numbers::<f64>(line, words)?[..] {
                [mean, scale] => columns.push((mean, scale)),
                _ => return Err(fault(line, "not `name mean scale`")),
            }
        }
        if columns.len() == names.len() {
            Ok(Self { columns })
        } else {
            Err(fault(0, "a feature is missing"))
        }
    }
}
