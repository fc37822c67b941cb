//! Formats recognised by the first bytes of a file.

use crate::{DrawingFormat, ModelFormat};

impl DrawingFormat {
    /// Returns the format that the first bytes of a file look like.
    ///
    /// ```
    /// use formats::DrawingFormat;
    /// assert_eq!(DrawingFormat::sniff(b"<?xml version='1.0'?><svg/>"), Some(DrawingFormat::Svg));
    /// assert_eq!(DrawingFormat::sniff(br#"{"word":"leaf","drawing":[]}"#), Some(DrawingFormat::Ndjson));
    /// ```
    pub fn sniff(start: &[u8]) -> Option<Self> {
        let head = &start[..start.len().min(4096)];
        let has = |word: &str| head.windows(word.len()).any(|w| w == word.as_bytes());
        let first = head.iter().find(|b| !b.is_ascii_whitespace() && !matches!(b, 0xef | 0xbb | 0xbf))?;
        match first {
            b'<' if has("<svg") || has(":svg") => Some(Self::Svg),
            b'<' if has("<ink") || has(":ink") => Some(Self::InkMl),
            // Of all drawings only SVG comes as a packed file.
            0x1f if head.starts_with(&[0x1f, 0x8b]) => Some(Self::Svg),
            b'{' if has("\"excalidraw\"") || has("\"excalidraw/clipboard\"") => Some(Self::Excalidraw),
            b'{' if has("\"tldrawFileFormatVersion\"") => Some(Self::Tldraw),
            b'{' if has("\"burgeon\"") => Some(Self::Json),
            b'{' if has("\"drawing\"") || has("\"key_id\"") => Some(Self::Ndjson),
            b'{' if has("\"strokes\"") => Some(Self::Json),
            _ => None,
        }
    }
}

impl ModelFormat {
    /// Returns the format that the first bytes of a file look like. A binary STL has no mark and is not recognised.
    pub fn sniff(start: &[u8]) -> Option<Self> {
        let text = start.trim_ascii_start();
        // Exporters of OBJ name themselves in comments.
        let mut lines = start.split(|&b| b == b'\n').map(<[u8]>::trim_ascii_start);
        let first = lines.find(|l| !l.is_empty() && !l.starts_with(b"#")).unwrap_or_default();
        if start.starts_with(b"glTF") {
            Some(Self::Glb)
        } else if start.starts_with(b"#usda ") {
            Some(Self::Usda)
        } else if start.starts_with(b"ply\n") || start.starts_with(b"ply\r") {
            Some(Self::Ply)
        } else if text.starts_with(b"solid ") {
            Some(Self::Stl)
        } else if text.starts_with(b"{") && start.windows(7).any(|w| w == b"\"asset\"") {
            Some(Self::Gltf)
        } else if [&b"v "[..], b"vn ", b"mtllib ", b"o ", b"g "].iter().any(|w| first.starts_with(w)) {
            Some(Self::Obj)
        } else {
            None
        }
    }
}
