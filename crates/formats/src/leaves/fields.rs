//! Fields of a line of CSV, whatever separates them, and numbers with either decimal sign.

use crate::error::FileFault;

/// Separator of the fields of a file, as its first line shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Fields {
    separator: char,
    count: usize,
}

impl Fields {
    /// Chooses semicolons if there is one, else tabs, else commas.
    pub(super) fn from_header(header: &str) -> Self {
        let separator = [';', '\t'].into_iter().find(|&s| header.contains(s)).unwrap_or(',');
        Self { separator, count: header.split(separator).count() }
    }

    pub(super) fn split<'a>(&self, line: &'a str) -> Vec<&'a str> {
        line.split(self.separator).map(str::trim).collect()
    }

    /// Applies [`split`](Self::split) to a line of data.
    ///
    /// # Errors
    /// The line has more fields than the first line has names, for example because of commas that are decimal signs.
    pub(super) fn row<'a>(&self, line: &'a str) -> Result<Vec<&'a str>, FileFault> {
        let fields = self.split(line);
        let used = fields.iter().rposition(|f| !f.is_empty()).map_or(0, |k| k + 1);
        if used > self.count {
            let what = format!("the line has {used} fields, the first line of names {}", self.count);
            let advice = match self.separator {
                ',' => "where commas are decimal signs, separate the fields by semicolons",
                _ => "give every line the fields of the first",
            };
            return Err(FileFault::malformed(what, advice));
        }
        Ok(fields)
    }

    /// Parses a number; it may have a decimal comma if commas do not separate fields.
    pub(super) fn number(&self, text: &str) -> Option<f64> {
        let parsed = match self.separator {
            ',' => text.parse(),
            _ if text.contains('.') => text.parse(),
            _ => text.replacen(',', ".", 1).parse(),
        };
        parsed.ok().filter(|x: &f64| x.abs() < 1e9)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_line_says_what_separates() {
        let fields = Fields::from_header("row;mark;x");
        assert_eq!(fields.row("1; 2 ;3,5").unwrap(), ["1", "2", "3,5"]);
        assert_eq!((fields.number("3,5"), fields.number("-3.5")), (Some(3.5), Some(-3.5)));
        assert_eq!(
            (fields.number("1,000.5"), fields.number("1,2,3"), fields.number("1e99")),
            (None, None, None)
        );
        let fields = Fields::from_header("row,mark,x");
        assert_eq!(fields.number("3,5"), None);
        assert_eq!(fields.row("1,2,3,,").unwrap().len(), 5, "empty fields at the end are none");
        let fault = fields.row("1,2,3,5").unwrap_err().to_string();
        assert!(fault.contains("4 fields") && fault.contains("semicolons"), "{fault}");
    }
}
