//! Zip files: written in full, read within bounds.

use base::LiteMap;
use std::io::{Read as _, Write as _};

use rawzip::{CompressionMethod, ZipArchive, ZipArchiveWriter};

/// Most entries of an archive that are examined.
const MAX_ENTRIES: usize = 256;

/// Size in bytes from which an entry is compressed fast: a model as text takes seconds otherwise.
const FAST_FROM: usize = 2 << 20;

/// Reason why a zip file could not be read or written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ArchiveError {
    /// The bytes are not a zip file, or are a damaged one.
    #[error("it is not a whole zip file ({0}); save or copy it again")]
    Zip(#[from] rawzip::Error),
    /// An entry is damaged.
    #[error("its entry \"{name}\" is damaged ({source}); save or copy it again")]
    Entry {
        /// Name of the entry.
        name: String,
        /// The underlying error.
        source: std::io::Error,
    },
    /// The archive exceeds the bounds that keep hostile files harmless.
    #[error("it holds more than {limit} {what}: it was not made by Burgeon")]
    TooMuch {
        /// The limited quantity.
        what: &'static str,
        /// The bound.
        limit: usize,
    },
    /// The entry is compressed with a method that is not supported.
    #[error("its entry \"{name}\" is packed with a method that is not read; use plain deflate")]
    Method {
        /// Name of the entry.
        name: String,
    },
    /// Writing failed.
    #[error("it could not be written: {0}")]
    Io(#[from] std::io::Error),
}

/// Packs files into a zip archive (deflate, no times): the same files give the same bytes on one platform.
///
/// # Errors
/// [`ArchiveError`] if a name is too long for the format.
///
/// ```
/// let zip = document::pack(&[("a.txt".into(), b"hello".to_vec())])?;
/// assert!(zip.starts_with(b"PK"));
/// # Ok::<(), document::ArchiveError>(())
/// ```
pub fn pack(files: &[(String, Vec<u8>)]) -> Result<Vec<u8>, ArchiveError> {
    let mut out = Vec::new();
    let mut archive = ZipArchiveWriter::new(&mut out);
    for (name, bytes) in files {
        let (mut entry, config) =
            archive.new_file(name).compression_method(CompressionMethod::DEFLATE).start()?;
        let large = bytes.len() > FAST_FROM;
        let effort = if large { flate2::Compression::fast() } else { flate2::Compression::default() };
        let encoder = flate2::write::DeflateEncoder::new(&mut entry, effort);
        let mut writer = config.wrap(encoder);
        writer.write_all(bytes)?;
        let (encoder, descriptor) = writer.finish()?;
        encoder.finish()?;
        entry.finish(descriptor)?;
    }
    archive.finish()?;
    Ok(out)
}

/// Unpacks the entries of these names; others are skipped unread. No entry may exceed `limit` bytes.
pub(crate) fn unpack(
    bytes: &[u8],
    names: &[&str],
    limit: usize,
) -> Result<LiteMap<String, Vec<u8>>, ArchiveError> {
    let archive = ZipArchive::from_slice(bytes)?;
    let mut found = LiteMap::new();
    let mut entries = archive.entries();
    let mut count = 0;
    while let Some(entry) = entries.next_entry()? {
        count += 1;
        if count > MAX_ENTRIES {
            return Err(ArchiveError::TooMuch { what: "files", limit: MAX_ENTRIES });
        }
        let Some(name) = names.iter().find(|n| n.as_bytes() == entry.file_path().as_ref()) else { continue };
        let method = entry.compression_method();
        let local = archive.get_entry(entry.wayfinder())?;
        let deflated = method == CompressionMethod::DEFLATE;
        if !deflated && method != CompressionMethod::STORE {
            return Err(ArchiveError::Method { name: (*name).into() });
        }
        let data = local.data();
        let inner: Box<dyn std::io::Read + '_> =
            if deflated { Box::new(flate2::bufread::DeflateDecoder::new(data)) } else { Box::new(data) };
        let mut content = Vec::new();
        // One byte more than allowed distinguishes a file at the limit from one beyond it.
        let bounded = local.verifying_reader(inner).take(limit as u64 + 1);
        let damaged = |source| ArchiveError::Entry { name: (*name).into(), source };
        { bounded }.read_to_end(&mut content).map_err(damaged)?;
        if content.len() > limit {
            return Err(ArchiveError::TooMuch { what: "bytes in one file", limit });
        }
        found.insert((*name).into(), content);
    }
    Ok(found)
}

base::coded!(ArchiveError { why => "archive" { why } });
