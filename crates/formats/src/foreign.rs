//! Files of other programs that are not a drawing, model, scan or table: what they are and what to do with them.

use core::fmt;

/// A kind of file that Burgeon does not read, or reads only elsewhere, recognised by its first bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Foreign {
    /// A picture of pixels: the name of its format.
    Picture(&'static str),
    /// A document of Krita.
    Krita,
    /// A document of Procreate.
    Procreate,
    /// A document of Photoshop.
    Photoshop,
    /// A page to print, or a document of Illustrator.
    Pdf,
    /// A laser scan in E57.
    E57,
    /// A project of our own, where another file is expected.
    Project,
    /// A drawing of Excalidraw, where no drawing is expected.
    Excalidraw,
    /// A drawing of tldraw, where no drawing is expected.
    Tldraw,
    /// An archive.
    Zip,
    /// One compressed file.
    Gzip,
}

/// Number of bytes from the start of a file that are examined.
const LOOKED_AT: usize = 4096;

/// Byte at which the name of the first file of a ZIP archive begins.
const ZIP_NAME: usize = 30;

impl Foreign {
    /// Recognises the file by its first bytes, unless it is read as a drawing, a model or a scan. Call this only
    /// where neither a project nor a compressed file is expected. The first 4096 bytes are enough.
    ///
    /// ```
    /// use formats::Foreign;
    /// assert_eq!(Foreign::sniff(b"%PDF-1.7"), Some(Foreign::Pdf));
    /// assert_eq!(Foreign::sniff(b"<svg/>"), None);
    /// ```
    pub fn sniff(start: &[u8]) -> Option<Self> {
        const MARKS: [(&[u8], Foreign); 12] = [
            (b"\x89PNG\r", Foreign::Picture("PNG")),
            (b"\xff\xd8\xff", Foreign::Picture("JPEG")),
            (b"GIF87a", Foreign::Picture("GIF")),
            (b"GIF89a", Foreign::Picture("GIF")),
            (b"II*\0", Foreign::Picture("TIFF")),
            (b"MM\0*", Foreign::Picture("TIFF")),
            (b"8BPS", Foreign::Photoshop),
            (b"%PDF-", Foreign::Pdf),
            (b"ASTM-E57", Foreign::E57),
            (b"\x1f\x8b", Foreign::Gzip),
            (b"PK\x03\x04", Foreign::Zip),
            (b"PK\x05\x06", Foreign::Zip),
        ];
        let start = &start[..start.len().min(LOOKED_AT)];
        let kind = MARKS.iter().find(|(mark, _)| start.starts_with(mark)).map(|(_, kind)| *kind);
        match kind {
            Some(Self::Zip) => Some(in_zip(start)),
            Some(kind) => Some(kind),
            None if start.starts_with(b"RIFF") && start.get(8..12) == Some(b"WEBP") => {
                Some(Self::Picture("WebP"))
            }
            None if [&b"ftypheic"[..], b"ftypheix", b"ftypmif1"].contains(&start.get(4..12)?) => {
                Some(Self::Picture("HEIC"))
            }
            None => None,
        }
    }

    /// Does the same as [`sniff`](Self::sniff) where no drawing is expected, and recognises drawings of other
    /// programs, too.
    ///
    /// ```
    /// use formats::Foreign;
    /// let start = br#"{ "type": "excalidraw", "version": 2 }"#;
    /// assert_eq!(Foreign::sniff_no_drawing(start), Some(Foreign::Excalidraw));
    /// ```
    pub fn sniff_no_drawing(start: &[u8]) -> Option<Self> {
        let head = &start[..start.len().min(LOOKED_AT)];
        let compact: Vec<u8> = head.iter().copied().filter(|b| !b.is_ascii_whitespace()).collect();
        if compact.starts_with(b"{") && holds(&compact, b"\"type\":\"excalidraw\"") {
            return Some(Self::Excalidraw);
        }
        if compact.starts_with(b"{") && holds(&compact, b"\"tldrawFileFormatVersion\"") {
            return Some(Self::Tldraw);
        }
        Self::sniff(start)
    }
}

/// Returns the program that an archive belongs to.
fn in_zip(start: &[u8]) -> Foreign {
    let first = start.get(ZIP_NAME..).unwrap_or_default();
    if holds(start, b"application/x-krita") {
        Foreign::Krita
    } else if [&b"Document.archive"[..], b"QuickLook/Thumbnail.png"].iter().any(|name| holds(start, name)) {
        Foreign::Procreate
    } else if holds(start, b"image/openraster") {
        Foreign::Picture("OpenRaster")
    } else if first.starts_with(b"manifest.json") {
        Foreign::Project
    } else {
        Foreign::Zip
    }
}

fn holds(bytes: &[u8], word: &[u8]) -> bool {
    bytes.windows(word.len()).any(|w| w == word)
}

impl fmt::Display for Foreign {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Picture(kind) => write!(
                f,
                "the file is a picture ({kind}), which has no lines; trace it: on the sheet of the Studio, with the picture \
                 under it, or as SVG in a drawing program"
            ),
            Self::Krita => f.write_str(
                "the file is a Krita document; export its vector layer as SVG, or a picture of it and trace that on the \
                 sheet of the Studio",
            ),
            Self::Procreate => f.write_str(
                "the file is a Procreate document, which has pixels and no lines; share it as PNG and trace that on the \
                 sheet of the Studio, or as SVG in a drawing program",
            ),
            Self::Photoshop => f.write_str(
                "the file is a Photoshop document; export it as PNG and trace that on the sheet of the Studio, or as SVG",
            ),
            Self::Pdf => f.write_str(
                "the file is a PDF document; save it as SVG in the program that drew it, or open it in one that can \
                 (Inkscape) and save it as SVG there",
            ),
            Self::E57 => f.write_str(
                "the file is a laser scan in E57, and another kind of file is expected here; give it to `burgeon scan`, by a \
                 name that ends with .e57",
            ),
            Self::Project => f.write_str(
                "the file is a project of Burgeon (.burgeon), and another kind of file is expected here; open it in the \
                 Studio",
            ),
            Self::Excalidraw => f.write_str(
                "the file is a drawing of Excalidraw, and another kind of file is expected here; give it where a drawing \
                 is wanted",
            ),
            Self::Tldraw => f.write_str(
                "the file is a drawing of tldraw, and another kind of file is expected here; give it where a drawing is \
                 wanted",
            ),
            Self::Zip => f.write_str("the file is a ZIP archive; unpack it and give the file that is in it"),
            Self::Gzip => {
                f.write_str("the file is compressed with gzip; unpack it and give the file that is in it")
            }
        }
    }
}

base::coded!(Foreign {
    Self::Picture(kind) => "foreign-picture" { kind },
    Self::Krita => "foreign-krita" {},
    Self::Procreate => "foreign-procreate" {},
    Self::Photoshop => "foreign-photoshop" {},
    Self::Pdf => "foreign-pdf" {},
    Self::E57 => "foreign-e57" {},
    Self::Project => "foreign-project" {},
    Self::Excalidraw => "foreign-excalidraw" {},
    Self::Tldraw => "foreign-tldraw" {},
    Self::Zip => "foreign-zip" {},
    Self::Gzip => "foreign-gzip" {},
});

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the start of an archive whose first file has this name and these bytes.
    fn archive(name: &str, bytes: &[u8]) -> Vec<u8> {
        let mut out = b"PK\x03\x04".to_vec();
        out.resize(ZIP_NAME, 0);
        out.extend_from_slice(name.as_bytes());
        out.extend_from_slice(bytes);
        out
    }

    #[test]
    fn files_of_other_programs_are_named() {
        for (start, kind) in [
            (archive("mimetype", b"application/x-krita"), Foreign::Krita),
            (archive("Document.archive", b"bplist00"), Foreign::Procreate),
            (archive("mimetype", b"image/openraster"), Foreign::Picture("OpenRaster")),
            (archive("manifest.json", b"{}"), Foreign::Project),
            (archive("word/document.xml", b""), Foreign::Zip),
            (b"\x1f\x8b\x08\0".to_vec(), Foreign::Gzip),
            (b"RIFF\0\0\0\0WEBPVP8 ".to_vec(), Foreign::Picture("WebP")),
            (b"\0\0\0\x18ftypheic".to_vec(), Foreign::Picture("HEIC")),
            (b"\xff\xd8\xff\xe0".to_vec(), Foreign::Picture("JPEG")),
            (b"ASTM-E57\x01\0".to_vec(), Foreign::E57),
            (b"8BPS\0\x01".to_vec(), Foreign::Photoshop),
        ] {
            assert_eq!(Foreign::sniff(&start), Some(kind));
            assert_eq!(Foreign::sniff_no_drawing(&start), Some(kind));
        }
        let drawing = br#"{"tldrawFileFormatVersion": 1}"#;
        assert_eq!(
            (Foreign::sniff(drawing), Foreign::sniff_no_drawing(drawing)),
            (None, Some(Foreign::Tldraw))
        );
        for own in
            [&b""[..], b"PK", b"glTF\x02\0\0\0", b"LASF", b"ply\n", b"v 0 0 0\n", b"<svg/>", b"1 2 3\n"]
        {
            assert_eq!(Foreign::sniff_no_drawing(own), None);
        }
    }
}
