//! USD in one file: a layer and its textures in a zip that is read in place.
//!
//! Our own writer, because readers of USD demand what streaming writers of zips cannot give: nothing compressed,
//! sizes before the data, each file at a multiple of 64 bytes.

use std::io::Write;

use super::usd_write::UsdFiles;
use crate::error::WriteError;

/// Alignment of the data of each file, in bytes.
const ALIGNED: usize = 64;
/// Date of every entry, so that the same model gives the same bytes: 1 January 1980.
const DATE: u16 = 0x21;
/// Id of the extra field that pads up to the data.
const FILLING: u16 = 0x1986;

/// A file of the zip.
struct Entry<'a> {
    name: &'a str,
    data: &'a [u8],
    crc: u32,
    /// Offset of its local header, in bytes.
    at: u32,
}

impl Entry<'_> {
    /// Returns the fields that both headers share, from the required version to the length of the name.
    fn facts(&self) -> Option<Vec<u8>> {
        let size = u32::try_from(self.data.len()).ok()?;
        let ascii = self.name.is_ascii();
        let mut out = Vec::with_capacity(24);
        // Version 1.0; names beyond ASCII are UTF-8; stored.
        for x in [10, if ascii { 0 } else { 1 << 11 }, 0, 0, DATE] {
            out.extend(u16::to_le_bytes(x));
        }
        for x in [self.crc, size, size] {
            out.extend(x.to_le_bytes());
        }
        out.extend(u16::try_from(self.name.len()).ok()?.to_le_bytes());
        Some(out)
    }
}

/// Writes a USD layer and its textures as one USDZ file: a zip without compression, in which the data of every file
/// starts at a multiple of 64 bytes. `stem` names the layer, which comes first.
///
/// # Errors
/// [`WriteError`] of the sink, or for more than 4 GiB, which no such file holds.
pub(crate) fn write_usdz(files: &UsdFiles, stem: &str, mut out: impl Write) -> Result<(), WriteError> {
    let layer = format!("{stem}.usda");
    let all = std::iter::once((layer.as_str(), &files.usda))
        .chain(files.textures.iter().map(|(name, bytes)| (name.as_str(), bytes)));
    let large = || std::io::Error::new(std::io::ErrorKind::FileTooLarge, "a USDZ file holds less than 4 GiB");
    let (mut at, mut entries) = (0_usize, Vec::new());
    for (name, data) in all {
        let start = u32::try_from(at).map_err(|_e| large())?;
        let entry = Entry { name, data, crc: rawzip::crc32(data), at: start };
        let facts = entry.facts().ok_or_else(large)?;
        // An extra field has a header of 4 bytes, so it takes at least those.
        let header = 4 + facts.len() + 2 + name.len();
        let filling = (at + header + 4).next_multiple_of(ALIGNED) - (at + header);
        #[expect(clippy::cast_possible_truncation, reason = "less than 68")]
        let filling = filling as u16;
        out.write_all(b"PK\x03\x04")?;
        out.write_all(&facts)?;
        out.write_all(&filling.to_le_bytes())?;
        out.write_all(name.as_bytes())?;
        out.write_all(&FILLING.to_le_bytes())?;
        out.write_all(&(filling - 4).to_le_bytes())?;
        out.write_all(&[0; ALIGNED][..usize::from(filling - 4)])?;
        out.write_all(data)?;
        at += header + usize::from(filling) + data.len();
        entries.push(entry);
    }
    let directory = u32::try_from(at).map_err(|_e| large())?;
    let mut list = Vec::new();
    for entry in &entries {
        list.extend(b"PK\x01\x02");
        list.extend(10_u16.to_le_bytes());
        list.extend(entry.facts().ok_or_else(large)?);
        // No extra field, comment, second disk or attributes.
        list.extend([0; 12]);
        list.extend(entry.at.to_le_bytes());
        list.extend(entry.name.as_bytes());
    }
    let count = u16::try_from(entries.len()).map_err(|_e| large())?;
    let length = u32::try_from(list.len()).map_err(|_e| large())?;
    out.write_all(&list)?;
    out.write_all(b"PK\x05\x06\0\0\0\0")?;
    out.write_all(&count.to_le_bytes())?;
    out.write_all(&count.to_le_bytes())?;
    out.write_all(&length.to_le_bytes())?;
    out.write_all(&directory.to_le_bytes())?;
    Ok(out.write_all(&[0; 2])?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_file_lies_at_a_multiple_of_64_bytes() {
        for stem in ["oak", "\u{6a61}\u{6811}", &"a".repeat(200)] {
            let textures =
                (0..40_usize).map(|n| (format!("{stem}-{}.png", "b".repeat(n)), vec![7; 3 * n + 1]));
            let files = UsdFiles { usda: b"#usda 1.0\n".to_vec(), textures: textures.collect() };
            let mut zip = Vec::new();
            write_usdz(&files, stem, &mut zip).unwrap();
            let number = |at: usize| u32::from_le_bytes(zip[at..at + 4].try_into().unwrap()) as usize;
            let short = |at: usize| usize::from(u16::from_le_bytes(zip[at..at + 2].try_into().unwrap()));
            let mut at = 0;
            let all =
                std::iter::once((format!("{stem}.usda"), files.usda.clone())).chain(files.textures.clone());
            for (name, data) in all {
                assert_eq!(&zip[at..at + 4], b"PK\x03\x04");
                let (named, extra, size) = (short(at + 26), short(at + 28), number(at + 22));
                assert_eq!(&zip[at + 30..at + 30 + named], name.as_bytes());
                let start = at + 30 + named + extra;
                assert_eq!((start % 64, &zip[start..start + size]), (0, &data[..]));
                at = start + size;
            }
            let end = zip.len() - 22;
            assert_eq!((number(end + 16), short(end + 10)), (at, 41));
            assert_eq!(at + number(end + 12), end, "the directory is as long as it says");
        }
    }
}
