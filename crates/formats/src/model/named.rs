//! Files that a model names: requested once each, and within limits.

use super::{NoFile, Resolver, SideFile};
use crate::error::FileFault;

/// Limits of the files that one model may name.
pub(super) struct NamedLimits {
    /// Most files: buffers, pictures, files of materials, textures. Large scenes have hundreds.
    files: usize,
    /// Most bytes of all of them together, as for a model that contains them. A file with several names counts
    /// several times.
    bytes: u64,
    /// Most pixels of all textures together, in bytes; those beyond are left out.
    pub(super) pixels: usize,
}

pub(super) const NAMED: NamedLimits =
    NamedLimits { files: 4096, bytes: super::MAX_MODEL_BYTES, pixels: 1 << 30 };

/// The files of one model.
pub(super) struct Files<'a> {
    resolve: Resolver<'a>,
    asked: usize,
    bytes: u64,
}

impl<'a> Files<'a> {
    pub(super) fn new(resolve: Resolver<'a>) -> Self {
        Self { resolve, asked: 0, bytes: 0 }
    }

    /// Returns the content of a file; none if there is none.
    pub(super) fn get(&mut self, file: SideFile<'_>) -> Result<Option<Vec<u8>>, FileFault> {
        self.asked += 1;
        if self.asked > NAMED.files {
            let what = "the number of files that it names";
            let advice = "save everything in one .glb, or name fewer";
            return Err(FileFault::TooMuch { what, limit: NAMED.files as u64, advice });
        }
        let bytes = match (self.resolve)(file) {
            Ok(bytes) => bytes,
            Err(NoFile::Missing) => return Ok(None),
            Err(NoFile::Refused(why)) => return Err(FileFault::Refused { why }),
        };
        self.bytes += bytes.len() as u64;
        if self.bytes > NAMED.bytes {
            let what = "the size of the files that it names, in bytes";
            let advice = "split the model into several files";
            return Err(FileFault::TooMuch { what, limit: NAMED.bytes, advice });
        }
        Ok(Some(bytes))
    }

    /// Returns the content of the file that a URI names: first literally, as many programs write names, or else
    /// decoded, as glTF says.
    pub(super) fn get_uri(&mut self, uri: &str) -> Result<Option<Vec<u8>>, FileFault> {
        let found = self.get(SideFile { name: uri, by: None })?;
        match (found, decode_uri(uri)) {
            (None, Some(name)) => self.get(SideFile { name: &name, by: None }),
            (found, _) => Ok(found),
        }
    }
}

/// Decodes `%20` and the like in a relative URI; none if it has none, or if they do not decode to text.
///
/// ```
/// assert_eq!(formats::decode_uri("old%20oak.bin").as_deref(), Some("old oak.bin"));
/// assert_eq!(formats::decode_uri("100%.bin"), None);
/// ```
pub fn decode_uri(uri: &str) -> Option<String> {
    let mut out = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        let digits = after.get(..2).filter(|_| first == b'%');
        let code = digits.filter(|d| d.iter().all(u8::is_ascii_hexdigit));
        let code = code.and_then(|d| u8::from_str_radix(core::str::from_utf8(d).ok()?, 16).ok());
        match code {
            Some(byte) => {
                out.push(byte);
                rest = &after[2..];
            }
            None => {
                out.push(first);
                rest = after;
            }
        }
    }
    (out != uri.as_bytes()).then(|| String::from_utf8(out).ok()).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uris_are_decoded_once_and_whole() {
        let cases = [
            ("a.bin", None),
            ("%61.bin", Some("a.bin")),
            ("%2e%2E%2Fa", Some("../a")),
            ("%252e", Some("%2e")),
            ("%e8%8A%b1.png", Some("花.png")),
            ("%ff", None),
            ("%", None),
            ("%4", None),
            ("%+1", None),
        ];
        for (uri, want) in cases {
            assert_eq!(decode_uri(uri).as_deref(), want, "{uri}");
        }
    }

    #[test]
    fn a_name_is_looked_for_by_its_letters_first() {
        let there = |file: SideFile<'_>| match file.name {
            "a%20b" | "c d" => Ok(file.name.as_bytes().to_vec()),
            "no" => Err(NoFile::Refused("never".into())),
            _ => Err(NoFile::Missing),
        };
        let mut files = Files::new(&there);
        assert_eq!(files.get_uri("a%20b").expect("there").as_deref(), Some(&b"a%20b"[..]));
        assert_eq!(files.get_uri("c%20d").expect("there").as_deref(), Some(&b"c d"[..]));
        assert_eq!(files.get_uri("x%20y").expect("not refused"), None);
        assert!(matches!(files.get_uri("n%6f"), Err(FileFault::Refused { why }) if why == "never"));
    }
}
