//! Lines of numbers, and the vertices of an OBJ.

use base::Report;

use super::{CloudFormat, Sink, too_many};
use crate::error::{CloudError, FileFault, Place};

fn is_separator(b: u8) -> bool {
    b.is_ascii_whitespace() || b == b',' || b == b';'
}

fn number(word: &[u8]) -> Option<f64> {
    core::str::from_utf8(word).ok()?.parse().ok()
}

fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(|&b| is_separator(b)).filter(|w| !w.is_empty())
}

/// Three or more columns: x y z, then what the first row shows: normals (unit length) or colours (whole numbers
/// to 255). Anything else is left out.
pub(super) fn read(bytes: &[u8], sink: &mut Sink, report: &mut Report) -> Result<(), CloudError> {
    let fail = |number: usize, what: String| {
        let advice = "give one point a line: x y z, separated by spaces or commas";
        CloudError::new(CloudFormat::Xyz, Place::line(number), FileFault::malformed(what, advice))
    };
    if bytes.iter().take(4096).any(|&b| b == 0) {
        return Err(fail(1, "it is not text".into()));
    }
    let mut columns: Option<usize> = None;
    let mut colors = false;
    for (index, line) in bytes.split(|&b| b == b'\n').enumerate() {
        let line = line.trim_ascii();
        if line.is_empty() || line.starts_with(b"#") || line.starts_with(b"//") {
            continue;
        }
        let mut row = [0.0; 6];
        let mut count = 0;
        let mut broken = None;
        for (k, word) in words(line).enumerate() {
            count = k + 1;
            match number(word) {
                Some(x) if k < 6 => row[k] = x,
                Some(_) => {}
                None if k < 3 => broken = broken.or(Some(word)),
                None => {}
            }
        }
        if columns.is_none() && broken.is_some() && index < 5 {
            report.warn("scan-header", format!("line {} is taken for a header", index + 1));
            continue;
        }
        // A line with the number of points alone is the header of a PTS file.
        if columns.is_none() && count == 1 && broken.is_none() {
            continue;
        }
        if let Some(word) = broken {
            let word = base::quoted(&String::from_utf8_lossy(word));
            return Err(fail(index + 1, format!("{word:?} is no number")));
        }
        if count < 3 {
            return Err(fail(index + 1, format!("there are {count} numbers, at least 3 are needed")));
        }
        if columns.is_none() {
            columns = Some(count);
            let byte = |x: &f64| (0.0..=255.0).contains(x) && x.fract() <= 0.0;
            colors = count == 6 && row[3..].iter().all(byte) && row[3..].iter().any(|x| *x > 1.0);
            if count > 3 && !colors {
                report.warn("scan-columns", format!("columns 4 to {count} were left out"));
            }
        } else if columns != Some(count) {
            let wanted = columns.unwrap_or(3);
            return Err(fail(
                index + 1,
                format!("there are {count} columns, the lines before have {wanted}"),
            ));
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturation is wanted")]
        let color = colors.then(|| [row[3] as u8, row[4] as u8, row[5] as u8]);
        if !sink.push([row[0], row[1], row[2]], color) {
            return Err(too_many(CloudFormat::Xyz));
        }
    }
    Ok(())
}

/// The `v` lines of an OBJ.
pub(super) fn read_obj(bytes: &[u8], sink: &mut Sink) -> Result<(), CloudError> {
    for (index, line) in bytes.split(|&b| b == b'\n').enumerate() {
        let mut words = words(line);
        if words.next() != Some(b"v") {
            continue;
        }
        let mut p = [0.0; 3];
        for x in &mut p {
            *x = words.next().and_then(number).ok_or_else(|| {
                let fault = FileFault::malformed("a vertex without three numbers", "export the scan again");
                CloudError::new(CloudFormat::Obj, Place::line(index + 1), fault)
            })?;
        }
        if !sink.push(p, None) {
            return Err(too_many(CloudFormat::Obj));
        }
    }
    Ok(())
}
