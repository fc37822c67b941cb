//! The machine as LIBSVM text, as `libsvm-rs` trains it: `rows -> text -> Svm -> bytes`.

use core::fmt::Write as _;

use libsvm_rs::{KernelType, SvmNode, SvmParameterBuilder, SvmProblem, SvmType};

use crate::classify::packed::{GRAIN, MAGIC};
use crate::classify::svm::{LANES, Scale, Svm, SvmError, fault, numbers};

/// C-SVC with a radial kernel, one class against one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RbfLearner {
    /// Cost of an error, above 0.
    pub(super) cost: f64,
    /// Kernel exponent times the number of columns.
    pub(super) gamma: f64,
}

impl RbfLearner {
    /// Returns the model's text for rows that are scaled already.
    ///
    /// # Errors
    /// [`SvmError`] where there are fewer than two classes.
    pub(super) fn learn(&self, rows: &[Vec<f64>], labels: &[i32]) -> Result<String, SvmError> {
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

impl Svm {
    /// Reads LIBSVM's text form of an RBF classifier for rows of `columns` numbers, rounded as it is packed: the
    /// machine that is tested is the one that programs carry.
    ///
    /// # Errors
    /// [`SvmError`] with the line.
    pub(in crate::classify) fn parse(text: &str, columns: usize) -> Result<Self, SvmError> {
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
            #[expect(clippy::cast_possible_truncation, reason = "as packed: f32")]
            svm.coefficients.extend(coefficients.iter().map(|&c| f64::from(c as f32)));
            let row = svm.vectors.len();
            svm.vectors.resize(row + svm.stride, 0.0);
            for word in words {
                let (index, value) = word.split_once(':').ok_or_else(|| fault(line, "not index:value"))?;
                let index: usize = index.parse().map_err(|_e| fault(line, "not an index"))?;
                let value: f32 = value.parse().map_err(|_e| fault(line, "not a number"))?;
                let slot = index.checked_sub(1).filter(|&k| k < columns);
                let slot = slot.ok_or_else(|| fault(line, format!("no column {index}")))?;
                svm.vectors[row + slot] = f32::from(steps(value)) * GRAIN;
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
}

/// Rounds a number of a vector to whole [`GRAIN`]s; scaled features lie within 5.
#[expect(clippy::cast_possible_truncation, reason = "a cast to i16 stops at its ends")]
fn steps(value: f32) -> i16 {
    (value / GRAIN).round() as i16
}

impl Scale {
    /// Computes the scale of these rows.
    pub(super) fn fit(rows: &[Vec<f64>]) -> Self {
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

    /// Returns one line for each column: name, mean, one over the deviation.
    pub(super) fn to_text(&self, names: &[&str]) -> String {
        let mut text = String::new();
        for (name, (mean, scale)) in names.iter().zip(&self.columns) {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{name} {mean:.9} {scale:.9}");
        }
        text
    }
}

/// Writes a machine of `columns` columns; [`unpack`](super::super::packed::unpack) gives it back bit for bit.
///
/// # Errors
/// [`SvmError`] where a count reaches 2^32.
pub(in crate::classify) fn pack(svm: &Svm, columns: usize) -> Result<Vec<u8>, SvmError> {
    let number = |n: usize| u32::try_from(n).map(u32::to_le_bytes).map_err(|e| fault(0, e.to_string()));
    let classes = svm.labels.len();
    let mut bytes = MAGIC.to_vec();
    bytes.extend(number(classes)?);
    bytes.extend(number(columns)?);
    bytes.extend(svm.labels.iter().flat_map(|l| l.to_le_bytes()));
    for pair in svm.starts.windows(2) {
        bytes.extend(number(pair[1] - pair[0])?);
    }
    bytes.extend(svm.gamma.to_le_bytes());
    bytes.extend(svm.rho.iter().flat_map(|r| r.to_le_bytes()));
    for k in 0..classes - 1 {
        let column = svm.coefficients.iter().skip(k).step_by(classes - 1);
        #[expect(clippy::cast_possible_truncation, reason = "they were read as f32")]
        bytes.extend(column.flat_map(|&c| (c as f32).to_le_bytes()));
    }
    for k in 0..columns {
        bytes.extend(svm.vectors.iter().skip(k).step_by(svm.stride).flat_map(|&v| steps(v).to_le_bytes()));
    }
    Ok(bytes)
}
