//! Workbooks of spreadsheets (`.xlsx`, ECMA-376) -> tables of text.
//!
//! Reads only what a table needs: the cells of one sheet as they were saved. Among the crates that read workbooks,
//! calamine brings another packer into the whole program (zlib-rs in flate2), which would change the bytes of
//! projects and pictures.

use std::io::{Cursor, Read};

use rawzip::{CompressionMethod, ZipArchive};
use roxmltree::{Document, Node, ParsingOptions};

use super::growth::{date, date_of};
use super::{LeafFileError, MAX_LEAF_BYTES};
use crate::error::{FileFault, Place};

/// Most that is read of a workbook.
struct Limits {
    /// Most files in it.
    files: usize,
    /// Most bytes of each file, unpacked.
    bytes: u64,
    /// Most columns of a sheet: as many as spreadsheets have.
    columns: usize,
    /// Most cells of a sheet.
    cells: usize,
}

const LIMITS: Limits = Limits { files: 1_000, bytes: 256 << 20, columns: 16_384, cells: 4_000_000 };

/// A table of a workbook.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReadSheet {
    /// Its cells, separated by tabs, one line for each row, as [`read_growth`](crate::read_growth) reads them. Dates
    /// are written as 2024-03-05.
    pub text: String,
    /// The name of the sheet.
    pub name: String,
    /// The sheets after it, which were not read.
    pub others: Vec<String>,
}

fn damaged(what: impl Into<String>) -> LeafFileError {
    let fault = FileFault::malformed(what, "save the workbook again, or the sheet as CSV");
    LeafFileError::new(Place::File, fault)
}

fn too_much(what: &'static str, limit: u64) -> LeafFileError {
    let fault = FileFault::TooMuch { what, limit, advice: "save the sheet as CSV" };
    LeafFileError::new(Place::File, fault)
}

/// Reads the first sheet of a workbook, or the one of that name.
///
/// Formulas have the values that were saved with them; cells with errors are empty. Cost: linear.
///
/// # Errors
/// [`LeafFileError`]: the file is not a workbook, has no such sheet, or is too large.
pub fn read_xlsx(input: impl Read, sheet: Option<&str>) -> Result<ReadSheet, LeafFileError> {
    let mut bytes = Vec::new();
    let read = input.take(MAX_LEAF_BYTES + 1).read_to_end(&mut bytes);
    read.map_err(|e| LeafFileError::new(Place::File, FileFault::Io(e)))?;
    if bytes.len() as u64 > MAX_LEAF_BYTES {
        return Err(too_much("the size in bytes", MAX_LEAF_BYTES));
    }
    let book = Book { bytes: &bytes };
    let workbook = book.file("xl/workbook.xml")?.ok_or_else(|| damaged("it is no workbook (.xlsx)"))?;
    let workbook = parsed(&workbook)?;
    let mut sheets: Vec<(String, String)> = Vec::new();
    for node in workbook.descendants().filter(|n| named(n, "sheet")) {
        let id = node.attributes().find(|a| a.name() == "id").map(|a| a.value().to_owned());
        sheets.extend(node.attribute("name").map(str::to_owned).zip(id));
    }
    let row = match sheet {
        None => 0,
        Some(name) => sheets.iter().position(|s| s.0 == name).ok_or_else(|| {
            let names: Vec<&str> = sheets.iter().map(|s| s.0.as_str()).collect();
            damaged(format!("it has no sheet \"{name}\", but {}", names.join(", ")))
        })?,
    };
    let (name, id) = sheets.get(row).cloned().ok_or_else(|| damaged("it has no sheet"))?;
    let relations =
        book.file("xl/_rels/workbook.xml.rels")?.ok_or_else(|| damaged("its list of sheets is gone"))?;
    let relations = parsed(&relations)?;
    let target = relations.descendants().find(|n| n.attribute("Id") == Some(&id));
    let target = target.and_then(|n| n.attribute("Target")).ok_or_else(|| damaged("its sheet is gone"))?;
    let path = target.strip_prefix('/').map_or_else(|| format!("xl/{target}"), str::to_owned);
    let is_1904 = workbook
        .descendants()
        .any(|n| named(&n, "workbookPr") && matches!(n.attribute("date1904"), Some("1" | "true")));
    let content = book.file(&path)?.ok_or_else(|| damaged("its sheet is gone"))?;
    let table = Cells { strings: book.strings()?, dates: book.date_styles()?, is_1904 };
    let text = table.text(&content)?;
    let others = sheets.into_iter().enumerate().filter(|(k, _)| *k != row).map(|(_, s)| s.0);
    Ok(ReadSheet { text, name, others: others.collect() })
}

fn parsed(text: &str) -> Result<Document<'_>, LeafFileError> {
    let options = ParsingOptions { allow_dtd: false, ..ParsingOptions::default() };
    Document::parse_with_options(text, options)
        .map_err(|e| damaged(format!("a file in it is no sound XML: {e}")))
}

/// Returns whether an element has this name, whatever its prefix.
fn named(node: &Node<'_, '_>, name: &str) -> bool {
    node.is_element() && node.tag_name().name() == name
}

/// Returns all text below an element, except the text that shows how letters are pronounced.
fn text_below(node: Node<'_, '_>) -> String {
    let texts = node.descendants().filter(|n| named(n, "t") && !n.ancestors().any(|a| named(&a, "rPh")));
    texts.filter_map(|n| n.text()).collect()
}

/// The files of a workbook.
struct Book<'a> {
    bytes: &'a [u8],
}

impl Book<'_> {
    /// Returns a file as text; none if the workbook lacks it.
    fn file(&self, name: &str) -> Result<Option<String>, LeafFileError> {
        let broken = |e: rawzip::Error| damaged(format!("it is no whole workbook (.xlsx): {e}"));
        let archive = ZipArchive::from_slice(self.bytes).map_err(broken)?;
        let mut entries = archive.entries();
        let mut count = 0;
        while let Some(entry) = entries.next_entry().map_err(broken)? {
            count += 1;
            if count > LIMITS.files {
                return Err(too_much("the number of files in it", LIMITS.files as u64));
            }
            if entry.file_path().as_ref() != name.as_bytes() {
                continue;
            }
            let method = entry.compression_method();
            let local = archive.get_entry(entry.wayfinder()).map_err(broken)?;
            let data = Cursor::new(local.data());
            let inner: Box<dyn Read + '_> = match method {
                CompressionMethod::DEFLATE => Box::new(flate2::bufread::DeflateDecoder::new(data)),
                CompressionMethod::STORE => Box::new(data),
                _ => return Err(damaged(format!("`{name}` in it is packed in a way that is not read"))),
            };
            let mut content = Vec::new();
            let read = local.verifying_reader(inner).take(LIMITS.bytes + 1).read_to_end(&mut content);
            read.map_err(|e| damaged(format!("`{name}` in it is damaged: {e}")))?;
            if content.len() as u64 > LIMITS.bytes {
                return Err(too_much("the size of its sheet in bytes", LIMITS.bytes));
            }
            let text = crate::drawing::text_of(content).map_err(|e| LeafFileError::new(Place::File, e))?;
            return Ok(Some(text));
        }
        Ok(None)
    }

    /// Returns the texts to which cells refer by number.
    fn strings(&self) -> Result<Vec<String>, LeafFileError> {
        let Some(text) = self.file("xl/sharedStrings.xml")? else { return Ok(Vec::new()) };
        let document = parsed(&text)?;
        Ok(document.descendants().filter(|n| named(n, "si")).map(text_below).collect())
    }

    /// Returns for each style of a cell whether it shows a number as a date.
    fn date_styles(&self) -> Result<Vec<bool>, LeafFileError> {
        let Some(text) = self.file("xl/styles.xml")? else { return Ok(Vec::new()) };
        let document = parsed(&text)?;
        let own: Vec<(&str, bool)> = document
            .descendants()
            .filter(|n| named(n, "numFmt"))
            .filter_map(|n| Some((n.attribute("numFmtId")?, is_date(n.attribute("formatCode")?))))
            .collect();
        let formats = document.descendants().find(|n| named(n, "cellXfs"));
        let formats = formats.into_iter().flat_map(|n| n.children()).filter(|n| named(n, "xf"));
        let is_date = |id: &str| {
            let known = id.parse().is_ok_and(|n: u32| matches!(n, 14..=17 | 22 | 27..=36 | 50..=58));
            own.iter().find(|o| o.0 == id).map_or(known, |o| o.1)
        };
        Ok(formats.map(|n| n.attribute("numFmtId").is_some_and(is_date)).collect())
    }
}

/// Returns whether a format shows days, months or years: outside of quotes and brackets.
fn is_date(format: &str) -> bool {
    let (mut quoted, mut bracketed, mut escaped) = (false, false, false);
    format.chars().any(|c| {
        let skip = escaped;
        escaped = c == '\\' && !skip;
        match c {
            _ if skip => {}
            '"' => quoted = !quoted,
            '[' => bracketed = true,
            ']' => bracketed = false,
            'd' | 'y' | 'D' | 'Y' => return !quoted && !bracketed,
            _ => {}
        }
        false
    })
}

struct Cells {
    strings: Vec<String>,
    dates: Vec<bool>,
    is_1904: bool,
}

impl Cells {
    fn text(&self, sheet: &str) -> Result<String, LeafFileError> {
        let document = parsed(sheet)?;
        let (mut out, mut count) = (String::new(), 0);
        for row in document.descendants().filter(|n| named(n, "row")) {
            let mut at = 0;
            for cell in row.children().filter(|n| named(n, "c")) {
                count += 1;
                if count > LIMITS.cells {
                    return Err(too_much("the number of cells", LIMITS.cells as u64));
                }
                let column = cell.attribute("r").and_then(column).unwrap_or(at);
                if column >= LIMITS.columns {
                    return Err(damaged("a cell stands beyond the last column"));
                }
                for _ in at..column {
                    out.push('\t');
                }
                at = at.max(column);
                let value = self.value(cell);
                out.extend(value.chars().map(|c| if c.is_control() { ' ' } else { c }));
            }
            out.push('\n');
        }
        Ok(out)
    }

    fn value(&self, cell: Node<'_, '_>) -> String {
        let own = cell.children().find(|n| named(n, "v")).and_then(|n| n.text()).unwrap_or("").trim();
        match cell.attribute("t") {
            Some("s") => {
                own.parse().ok().and_then(|k: usize| self.strings.get(k)).cloned().unwrap_or_default()
            }
            Some("inlineStr") => text_below(cell),
            Some("e") => String::new(),
            Some("str" | "b" | "d") => own.to_owned(),
            _ => {
                let style = cell.attribute("s").and_then(|s| s.parse::<usize>().ok());
                let is_date = style.and_then(|s| self.dates.get(s)).copied().unwrap_or(false);
                let day = own.parse::<f64>().ok().filter(|d| is_date && (1.0..3e6).contains(d));
                day.map_or_else(|| own.to_owned(), |d| self.date(d))
            }
        }
    }

    /// Returns a date that is counted from the last days of 1899, or from 1904.
    fn date(&self, serial: f64) -> String {
        let first = if self.is_1904 { "1904-01-01" } else { "1899-12-30" };
        date_of(date(first).unwrap_or(0.0) + serial.floor())
    }
}

/// Returns the column of a reference such as `AB12`, from 0.
fn column(reference: &str) -> Option<usize> {
    let letters = reference.bytes().take_while(u8::is_ascii_alphabetic).take(4);
    let number = letters.fold(0, |n, c| 26 * n + usize::from(c.to_ascii_uppercase() - b'A') + 1);
    number.checked_sub(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEIGHTS: &[u8] = include_bytes!("../../../../fixtures/tables/heights.xlsx");

    #[test]
    fn a_workbook_is_a_table_of_its_cells() {
        let read = read_xlsx(HEIGHTS, None).unwrap();
        assert_eq!((read.name.as_str(), read.others.as_slice()), ("Heights", &["Notes".to_owned()][..]));
        let lines: Vec<&str> = read.text.lines().collect();
        assert_eq!(lines[0], "Date\tPlant\tHeight (cm)\t\tTreatment");
        assert_eq!(lines[2], "2024-02-28\ta\t10\t\twet");
        let growth = crate::read_growth(read.text.as_bytes(), &crate::GrowthSpec::default()).unwrap();
        assert_eq!(
            growth.rows.iter().map(|r| r.day).collect::<Vec<_>>(),
            [0.0, 2.0, 7.0],
            "2024 is a leap year"
        );
        assert!((growth.rows[1].size - 0.125).abs() < 1e-15);
        assert_eq!(read_xlsx(HEIGHTS, Some("Notes")).unwrap().text, "");
        let gone = read_xlsx(HEIGHTS, Some("Leaves")).unwrap_err().to_string();
        assert!(gone.contains("Heights, Notes"), "{gone}");
    }

    #[test]
    fn what_is_no_workbook_is_refused() {
        for bytes in [&b""[..], b"PK", b"day,size\n", &HEIGHTS[..900]] {
            assert!(read_xlsx(bytes, None).is_err());
        }
    }

    #[test]
    fn formats_of_dates_are_told_from_others() {
        for (format, wanted) in [
            ("yyyy\\-mm\\-dd", true),
            ("d. mmm", true),
            ("0.00", false),
            ("[Red]0.0", false),
            ("0 \"days\"", false),
            ("h:mm", false),
        ] {
            assert_eq!(is_date(format), wanted, "{format}");
        }
        assert_eq!([column("A1"), column("AB12"), column("1")], [Some(0), Some(27), None]);
    }
}
