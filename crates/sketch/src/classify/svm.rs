//! A support vector machine as LIBSVM text: training by `libsvm-rs`, deciding by our own few lines.
//!
//! The decision is ours because `libsvm-rs` calls `std`'s `exp`, which differs between native and WASM.

use core::fmt::Write as _;

use base::ops;
use libsvm_rs::{KernelType, SvmNode, SvmParameterBuilder, SvmProblem, SvmType};

/// Why a model's text cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line} of the model: {what}")]
pub struct ModelError {
    /// Counted from 1; 0 where the text as a whole is meant.
    pub line: usize,
    /// What is wrong with it.
    pub what: String,
}

fn fault(line: usize, what: impl Into<String>) -> ModelError {
    ModelError { line, what: what.into() }
}

/// Something that learns classes from rows of numbers and writes down what it learnt.
pub(super) trait Learner {
    /// The model's text, from rows that are scaled already.
    fn learn(&self, rows: &[Vec<f64>], labels: &[i32]) -> Result<String, ModelError>;
}

/// C-SVC with a radial kernel, one class against one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RbfLearner {
    /// Cost of an error, above 0.
    pub(super) cost: f64,
    /// Kernel exponent times the number of columns.
    pub(super) gamma: f64,
}

impl Learner for RbfLearner {
    fn learn(&self, rows: &[Vec<f64>], labels: &[i32]) -> Result<String, ModelError> {
        libsvm_rs::set_quiet(true);
        let columns = rows.iter().map(Vec::len).max().unwrap_or(0).max(1);
        let parameter = SvmParameterBuilder::new()
            .svm_type(SvmType::CSvc)
            .kernel_type(KernelType::Rbf)
            .gamma(self.gamma / columns as f64)
            .c(self.cost)
            .build()
            .map_err(|e| fault(0, e.to_string()))?;
        let node =
            |(k, &value): (usize, &f64)| i32::try_from(k + 1).ok().map(|index| SvmNode { index, value });
        let problem = SvmProblem {
            labels: labels.iter().map(|&l| f64::from(l)).collect(),
            instances: rows.iter().map(|r| r.iter().enumerate().filter_map(node).collect()).collect(),
        };
        libsvm_rs::check_parameter(&problem, &parameter).map_err(|e| fault(0, e.to_string()))?;
        let mut bytes = Vec::new();
        libsvm_rs::io::save_model_to_writer(&mut bytes, &libsvm_rs::train::svm_train(&problem, &parameter))
            .map_err(|e| fault(0, e.to_string()))?;
        String::from_utf8(bytes).map_err(|e| fault(0, e.to_string()))
    }
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
    squares: Vec<f32>,
}

/// Sums side by side, which the processor adds at once.
const LANES: usize = 8;

impl Svm {
    /// Of numbers as they are packed: coefficients and vectors column by column, `starts` with the end of the last.
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

    fn square(&mut self) {
        self.squares = self.vectors.chunks_exact(self.stride.max(1)).map(|v| dot(v, v)).collect();
    }

    /// Reads LIBSVM's text form of an RBF classifier for rows of `columns` numbers.
    ///
    /// # Errors
    /// [`ModelError`] with the line.
    pub(super) fn parse(text: &str, columns: usize) -> Result<Self, ModelError> {
        let (mut gamma, mut rho, mut labels, mut counts) = (None, Vec::<f64>::new(), Vec::new(), Vec::new());
        let mut lines = text.lines().enumerate().map(|(k, l)| (k + 1, l));
        for (line, content) in lines.by_ref() {
            let mut words = content.split_whitespace();
            match words.next() {
                Some("gamma") => gamma = numbers::<f64>(line, words)?.first().copied(),
                Some("rho") => rho = numbers(line, words)?,
                Some("label") => labels = numbers::<i32>(line, words)?,
                Some("nr_sv") => counts = numbers::<usize>(line, words)?,
                Some("svm_type") if words.next() != Some("c_svc") => return Err(fault(line, "not c_svc")),
                Some("kernel_type") if words.next() != Some("rbf") => return Err(fault(line, "not rbf")),
                Some("SV") => break,
                _ => {}
            }
        }
        let gamma: f64 = gamma.ok_or_else(|| fault(0, "no gamma"))?;
        let classes = labels.len();
        if classes < 2 || counts.len() != classes || rho.len() != classes * (classes - 1) / 2 {
            return Err(fault(0, "label, nr_sv and rho do not fit together"));
        }
        let mut svm = Self {
            gamma,
            labels,
            rho,
            starts: vec![0],
            coefficients: Vec::new(),
            vectors: Vec::new(),
            stride: columns.next_multiple_of(LANES),
            squares: Vec::new(),
        };
        for (line, content) in lines {
            let mut words = content.split_whitespace();
            let coefficients: Vec<f64> = numbers(line, words.by_ref().take(classes - 1))?;
            if coefficients.len() < classes - 1 {
                return Err(fault(line, "too few coefficients"));
            }
            svm.coefficients.extend(coefficients);
            let row = svm.vectors.len();
            svm.vectors.resize(row + svm.stride, 0.0);
            for word in words {
                let (index, value) = word.split_once(':').ok_or_else(|| fault(line, "not index:value"))?;
                let index: usize = index.parse().map_err(|_e| fault(line, "not an index"))?;
                let value: f32 = value.parse().map_err(|_e| fault(line, "not a number"))?;
                let slot = index.checked_sub(1).filter(|&k| k < columns);
                let slot = slot.ok_or_else(|| fault(line, format!("no column {index}")))?;
                svm.vectors[row + slot] = value;
            }
        }
        let mut end = 0;
        for &count in &counts {
            end += count;
            svm.starts.push(end);
        }
        if end * svm.stride != svm.vectors.len() {
            return Err(fault(0, "nr_sv does not fit the number of vectors"));
        }
        svm.square();
        Ok(svm)
    }

    /// How sure each class is, in the order of `labels`: positive, summing to 1.
    ///
    /// Each pair's decision value d becomes a probability 1 / (1 + e^(-2 d)); a class's share is
    /// 1 / (sum over the others of 1 / p - (classes - 2)) (Price, Knerr, Personnaz and Dreyfus 1995), normalised.
    pub(super) fn shares(&self, row: &[f64]) -> Vec<f64> {
        #[expect(clippy::cast_possible_truncation, reason = "scaled features lie within 5 deviations")]
        let mut row: Vec<f32> = row.iter().map(|&x| x as f32).collect();
        row.resize(self.stride, 0.0);
        // |v - r|^2 = |v|^2 + |r|^2 - 2 v.r: one product an element instead of two operations more.
        let square = dot(&row, &row);
        let distances: Vec<f64> = (self.vectors.chunks_exact(self.stride.max(1)).zip(&self.squares))
            .map(|(v, own)| f64::from((own + square - 2.0 * dot(v, &row)).max(0.0)))
            .collect();
        let mut kernel = vec![0.0; distances.len()];
        ops::exps(-self.gamma, &distances, &mut kernel);
        let n = self.labels.len();
        // For each class the weighed kernels of its own vectors against each other class.
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

/// Of slices of whole lanes.
fn dot(a: &[f32], b: &[f32]) -> f32 {
    let mut sums = [0.0; LANES];
    for (x, y) in a.chunks_exact(LANES).zip(b.chunks_exact(LANES)) {
        for k in 0..LANES {
            sums[k] += x[k] * y[k];
        }
    }
    sums.iter().sum()
}

fn numbers<'a, T: core::str::FromStr>(
    line: usize,
    words: impl Iterator<Item = &'a str>,
) -> Result<Vec<T>, ModelError> {
    words.map(|w| w.parse().map_err(|_e| fault(line, format!("{w} is not a number")))).collect()
}

/// Mean and deviation of each column, so that every feature weighs the same.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Scale {
    /// Mean and one over the deviation.
    pub(super) columns: Vec<(f64, f64)>,
}

impl Scale {
    /// Of these rows.
    pub(super) fn of(rows: &[Vec<f64>]) -> Self {
        let n = rows.len().max(1) as f64;
        let width = rows.first().map_or(0, Vec::len);
        let column = |k: usize| {
            let values = || rows.iter().filter_map(move |r| r.get(k));
            let mean = values().sum::<f64>() / n;
            let variance = values().map(|x| (x - mean) * (x - mean)).sum::<f64>() / n;
            (mean, if variance > 1e-12 { 1.0 / variance.sqrt() } else { 0.0 })
        };
        Self { columns: (0..width).map(column).collect() }
    }

    /// A row, scaled; cut at 5 deviations so that no single feature of an odd drawing decides alone.
    pub(super) fn apply(&self, row: &[f64]) -> Vec<f64> {
        self.columns
            .iter()
            .zip(row)
            .map(|(&(mean, scale), x)| ((x - mean) * scale).clamp(-5.0, 5.0))
            .collect()
    }

    /// One line a column: name, mean, one over the deviation.
    pub(super) fn to_text(&self, names: &[&str]) -> String {
        let mut text = String::new();
        for (name, (mean, scale)) in names.iter().zip(&self.columns) {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{name} {mean:.9} {scale:.9}");
        }
        text
    }

    /// Reads what [`to_text`](Self::to_text) wrote; the names must be these, in this order.
    pub(super) fn parse(text: &str, names: &[&str]) -> Result<Self, ModelError> {
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
