//! Checked access to the bytes behind a glTF document. Everything here may be hostile.

use std::sync::Arc;

use base::LiteMap;

use super::glb_pack::COMPRESSION;
use super::gltf::{Accessor, FLOAT, I8, I16, Root, U8, U16, U32, View};
use super::meshopt::{decode_attributes, decode_triangles};
use super::meshopt_filter::Filter;
use super::named::Files;
use crate::ModelFormat;
use crate::error::{FileFault, ModelError, Place};

pub(super) type MeshFault = (Place, FileFault);

const EXPORT_AGAIN: &str = "export the model again, uncompressed, as .glb";

pub(super) fn item(kind: &str, index: impl core::fmt::Display) -> Place {
    Place::Item(format!("{kind} {index}"))
}

pub(super) fn broken(place: Place, what: impl Into<String>) -> MeshFault {
    (place, FileFault::malformed(what, EXPORT_AGAIN))
}

pub(super) fn unsupported(place: Place, what: impl Into<String>) -> MeshFault {
    (place, FileFault::unsupported(what, EXPORT_AGAIN))
}

/// Returns the JSON text and the binary chunk.
pub(super) fn chunks(bytes: &[u8], format: ModelFormat) -> Result<(&[u8], Option<&[u8]>), ModelError> {
    if !bytes.starts_with(b"glTF") {
        if bytes.trim_ascii_start().starts_with(b"{") || format == ModelFormat::Gltf {
            return Ok((bytes, None));
        }
        let fault = FileFault::malformed("it does not begin with `glTF`", "is it really a GLB file?");
        return Err(ModelError::new(format, Place::Byte(0), fault));
    }
    let cut = |at: usize, inside: &str| {
        ModelError::new(format, Place::Byte(at as u64), FileFault::Truncated { inside: inside.to_owned() })
    };
    let word = |at: usize| {
        let b = bytes.get(at..at + 4)?;
        Some(u32::from_le_bytes([b[0], b[1], b[2], b[3]]))
    };
    match word(4) {
        Some(2) => {}
        Some(version) => {
            let fault = FileFault::unsupported(format!("GLB version {version}"), "export it as glTF 2.0");
            return Err(ModelError::new(format, Place::Byte(4), fault));
        }
        None => return Err(cut(4, "the header")),
    }
    let (mut json, mut bin) = (None, None);
    let mut at = 12;
    // The specification has two chunks; further ones are skipped.
    while at + 8 <= bytes.len() && bin.is_none() {
        let (Some(length), Some(kind)) = (word(at), word(at + 4)) else { break };
        let end = (at + 8).saturating_add(length as usize);
        let Some(chunk) = bytes.get(at + 8..end) else { return Err(cut(at, "the chunk that begins here")) };
        match &kind.to_le_bytes() {
            b"JSON" if json.is_none() => json = Some(chunk),
            b"BIN\0" => bin = Some(chunk),
            _ => {}
        }
        at = end;
    }
    json.map(|json| (json, bin)).ok_or_else(|| cut(12, "the JSON chunk"))
}

/// Contents of a buffer.
#[derive(Debug)]
enum Held<'a> {
    /// A part of the document itself.
    Inside(&'a [u8]),
    /// The data of a file or a URI; buffers that name one file share it.
    Own(Arc<Vec<u8>>),
}

impl core::ops::Deref for Held<'_> {
    type Target = [u8];

    fn deref(&self) -> &[u8] {
        match self {
            Self::Inside(bytes) => bytes,
            Self::Own(bytes) => bytes,
        }
    }
}

/// The buffers of a document.
#[derive(Debug)]
pub(super) struct Bytes<'a> {
    buffers: Vec<Held<'a>>,
    /// Contents of each compressed view; none for the others.
    unpacked: Vec<Option<Vec<u8>>>,
}

/// Most bytes of all compressed views together.
const MAX_UNPACKED: u64 = 1 << 30;

impl<'a> Bytes<'a> {
    pub(super) fn load(root: &Root, bin: Option<&'a [u8]>, files: &mut Files<'_>) -> Result<Self, MeshFault> {
        let mut buffers = Vec::with_capacity(root.buffers.len());
        let mut read: LiteMap<&str, Arc<Vec<u8>>> = LiteMap::new();
        for (i, buffer) in root.buffers.iter().enumerate() {
            // A fallback buffer, for readers without the extension, holds nothing that its compressed views need.
            let marked =
                buffer.extensions.as_ref().and_then(|e| e.get(COMPRESSION)?.get("fallback")?.as_bool());
            if marked == Some(true) && buffer.uri.is_none() {
                buffers.push(Held::Inside(&[]));
                continue;
            }
            let data = match (&buffer.uri, bin) {
                (None, Some(bin)) if i == 0 => Held::Inside(bin),
                (None, _) => return Err(broken(item("buffer", i), "it has no data")),
                (Some(uri), _) => Held::Own(match read.get(uri.as_str()) {
                    Some(known) => Arc::clone(known),
                    None => {
                        let place = item("buffer", i);
                        let new =
                            Arc::new(load_uri(uri, files, &place)?.ok_or_else(|| not_found(uri, &place))?);
                        read.insert(uri, Arc::clone(&new));
                        new
                    }
                }),
            };
            if (data.len() as u64) < buffer.byte_length {
                let inside = format!("{} of {} bytes", data.len(), buffer.byte_length);
                return Err((item("buffer", i), FileFault::Truncated { inside }));
            }
            buffers.push(data);
        }
        let mut bytes = Self { buffers, unpacked: Vec::new() };
        let mut room = MAX_UNPACKED;
        let views = root.buffer_views.iter().enumerate();
        bytes.unpacked =
            views.map(|(i, view)| bytes.unpack(i, view, &mut room)).collect::<Result<_, MeshFault>>()?;
        Ok(bytes)
    }

    /// Returns the contents of a compressed view; none for a view that is not compressed.
    fn unpack(&self, index: usize, view: &View, room: &mut u64) -> Result<Option<Vec<u8>>, MeshFault> {
        let Some(packed) = view.extensions.as_ref().and_then(|e| e.get(COMPRESSION)) else { return Ok(None) };
        let place = || item("bufferView", index);
        let number = |key: &str| packed.get(key).map_or(Some(0), serde_json::Value::as_u64);
        let of = |key: &str| number(key).and_then(|n| usize::try_from(n).ok());
        let word =
            |key: &str, default: &str| packed.get(key).and_then(|v| v.as_str()).unwrap_or(default).to_owned();
        let (mode, filter) = (word("mode", ""), word("filter", "NONE"));
        let sizes = (of("buffer"), of("byteOffset"), of("byteLength"), of("byteStride"), of("count"));
        let (Some(buffer), Some(from), Some(length), Some(stride), Some(count)) = sizes else {
            return Err(broken(place(), "its compression has odd numbers"));
        };
        let stream = self.buffers.get(buffer).and_then(|b| b.get(from..from.checked_add(length)?));
        let stream = stream.ok_or_else(|| broken(place(), "its stream reaches beyond its buffer"))?;
        let whole = (count as u64).checked_mul(stride as u64).filter(|&whole| whole <= *room);
        *room -= whole.ok_or_else(|| broken(place(), "it would hold too much"))?;
        let known = Filter::from_word(&filter);
        if filter != "NONE" && (known.is_none() || mode != "ATTRIBUTES") {
            return Err(unsupported(
                place(),
                format!("the filter {} of compressed data", base::quoted(&filter)),
            ));
        }
        let held = match (mode.as_str(), stride) {
            ("ATTRIBUTES", _) => decode_attributes(stream, count, stride).and_then(|mut all| {
                known.map_or(Some(()), |filter| filter.decode(&mut all, stride))?;
                Some(all)
            }),
            ("TRIANGLES", 2 | 4) => decode_triangles(stream, count)
                .map(|all| all.iter().flat_map(|i| i.to_le_bytes().into_iter().take(stride)).collect()),
            _ => {
                return Err(unsupported(place(), format!("compressed data of mode {}", base::quoted(&mode))));
            }
        };
        held.map(Some).ok_or_else(|| broken(place(), "its compressed data is broken"))
    }

    /// Returns the bytes of a buffer view, and its stride.
    pub(super) fn view(&self, root: &Root, index: u32) -> Result<(&[u8], Option<u64>), MeshFault> {
        let place = || item("bufferView", index);
        let view = root.buffer_views.get(index as usize).ok_or_else(|| broken(place(), "it is not there"))?;
        if let Some(Some(held)) = self.unpacked.get(index as usize) {
            return Ok((held, view.byte_stride));
        }
        let buffer = self
            .buffers
            .get(view.buffer as usize)
            .ok_or_else(|| broken(place(), "its buffer is not there"))?;
        let range = usize::try_from(view.byte_offset)
            .ok()
            .zip(usize::try_from(view.byte_length).ok())
            .and_then(|(from, length)| buffer.get(from..from.checked_add(length)?));
        Ok((range.ok_or_else(|| broken(place(), "it reaches beyond its buffer"))?, view.byte_stride))
    }

    fn accessor<'r>(&self, root: &'r Root, index: u32) -> Result<&'r Accessor, MeshFault> {
        root.accessors.get(index as usize).ok_or_else(|| broken(item("accessor", index), "it is not there"))
    }

    /// Returns the number of rows of an accessor, before anything is read.
    pub(super) fn count(&self, root: &Root, index: u32) -> Result<usize, MeshFault> {
        usize::try_from(self.accessor(root, index)?.count)
            .map_err(|e| broken(item("accessor", index), format!("its count is absurd: {e}")))
    }

    /// Calls `each` with the raw bytes of every row.
    fn rows(
        &self,
        root: &Root,
        index: u32,
        components: usize,
        mut each: impl FnMut(&[u8]),
    ) -> Result<(), MeshFault> {
        let accessor = self.accessor(root, index)?;
        let place = || item("accessor", index);
        if accessor.sparse.is_some() {
            return Err(unsupported(place(), "a sparse accessor"));
        }
        let Some(view) = accessor.buffer_view else {
            return Err(unsupported(place(), "an accessor without data"));
        };
        let size = components
            * match accessor.component_type {
                U8 | I8 => 1,
                U16 | I16 => 2,
                U32 | FLOAT => 4,
                other => return Err(broken(place(), format!("component type {other} does not exist"))),
            };
        let (bytes, stride) = self.view(root, view)?;
        let stride = stride.map_or(Some(size), |s| usize::try_from(s).ok()).filter(|&s| s >= size);
        let stride = stride.ok_or_else(|| broken(place(), "its stride is smaller than its elements"))?;
        let count = self.count(root, index)?;
        let data = usize::try_from(accessor.byte_offset).ok().and_then(|from| bytes.get(from..));
        let needed = count.checked_sub(1).map_or(Some(0), |n| n.checked_mul(stride)?.checked_add(size));
        match (data, needed) {
            (Some(data), Some(needed)) if needed <= data.len() => {
                (0..count).for_each(|i| each(&data[i * stride..i * stride + size]));
                Ok(())
            }
            _ => Err(broken(place(), "it reaches beyond its buffer view")),
        }
    }

    /// Returns an accessor as rows of `N` floats; integers are scaled if the accessor says `normalized`. A `VEC4` may
    /// be read as three: its alpha is dropped.
    pub(super) fn floats<const N: usize>(&self, root: &Root, index: u32) -> Result<Vec<[f32; N]>, MeshFault> {
        let accessor = self.accessor(root, index)?;
        let components =
            components(&accessor.shape).filter(|&c| c == N || (c == 4 && N == 3)).ok_or_else(|| {
                broken(item("accessor", index), format!("{:?} is not its type", accessor.shape))
            })?;
        let (kind, scaled) = (accessor.component_type, accessor.normalized);
        let mut out = Vec::new();
        self.rows(root, index, components, |row| {
            let mut values = [0.0_f32; N];
            let size = row.len() / components;
            for (value, raw) in values.iter_mut().zip(row.chunks_exact(size)) {
                *value = number(raw, kind, scaled);
            }
            out.push(values);
        })?;
        Ok(out)
    }

    /// Returns an accessor as indices.
    pub(super) fn indices(&self, root: &Root, index: u32) -> Result<Vec<u32>, MeshFault> {
        let accessor = self.accessor(root, index)?;
        if accessor.shape != "SCALAR" || !matches!(accessor.component_type, U8 | U16 | U32) {
            return Err(broken(item("accessor", index), "it holds no indices"));
        }
        let mut out = Vec::new();
        self.rows(root, index, 1, |raw| {
            out.push(match *raw {
                [a] => u32::from(a),
                [a, b] => u32::from(u16::from_le_bytes([a, b])),
                [a, b, c, d] => u32::from_le_bytes([a, b, c, d]),
                _ => 0,
            });
        })?;
        Ok(out)
    }
}

fn components(shape: &str) -> Option<usize> {
    match shape {
        "SCALAR" => Some(1),
        "VEC2" => Some(2),
        "VEC3" => Some(3),
        "VEC4" => Some(4),
        _ => None,
    }
}

fn number(raw: &[u8], kind: u32, scaled: bool) -> f32 {
    let (value, most) = match (kind, raw) {
        (FLOAT, &[a, b, c, d]) => return f32::from_le_bytes([a, b, c, d]),
        (U8, &[a]) => (f32::from(a), 255.0),
        (I8, &[a]) => (f32::from(i8::from_le_bytes([a])), 127.0),
        (U16, &[a, b]) => (f32::from(u16::from_le_bytes([a, b])), 65_535.0),
        (I16, &[a, b]) => (f32::from(i16::from_le_bytes([a, b])), 32_767.0),
        #[expect(clippy::cast_precision_loss, reason = "an integer position beyond 2^24 is rounded")]
        (U32, &[a, b, c, d]) => (u32::from_le_bytes([a, b, c, d]) as f32, 4_294_967_295.0),
        _ => (0.0, 1.0),
    };
    if scaled { (value / most).max(-1.0) } else { value }
}

/// Returns the bytes of a `data:` URI or of a file; none if the file is missing.
pub(super) fn load_uri(
    uri: &str,
    files: &mut Files<'_>,
    place: &Place,
) -> Result<Option<Vec<u8>>, MeshFault> {
    if let Some(rest) = uri.strip_prefix("data:") {
        let data = rest.split_once(";base64,").and_then(|(_, data)| base64(data));
        return data.map(Some).ok_or_else(|| broken(place.clone(), "its data URI is not base64"));
    }
    files.get_uri(uri).map_err(|fault| (place.clone(), fault))
}

fn not_found(uri: &str, place: &Place) -> MeshFault {
    let what = format!("the file {:?} that it refers to was not found", base::quoted(uri));
    (place.clone(), FileFault::malformed(what, "put it beside the model, or save everything in one .glb"))
}

fn base64(text: &str) -> Option<Vec<u8>> {
    let mut out = Vec::with_capacity(text.len() / 4 * 3 + 3);
    let (mut bits, mut held) = (0_u32, 0_u32);
    for b in text.bytes() {
        let value = match b {
            b'A'..=b'Z' => b - b'A',
            b'a'..=b'z' => b - b'a' + 26,
            b'0'..=b'9' => b - b'0' + 52,
            b'+' | b'-' => 62,
            b'/' | b'_' => 63,
            b'=' => break,
            b if b.is_ascii_whitespace() => continue,
            _ => return None,
        };
        bits = (bits << 6) | u32::from(value);
        held += 6;
        if held >= 8 {
            held -= 8;
            out.push(((bits >> held) & 0xff) as u8);
        }
    }
    Some(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_decodes() {
        assert_eq!(base64("aGVsbG8gbGVhZg==").as_deref(), Some(&b"hello leaf"[..]));
        assert_eq!(base64("aGVsbG8\nhIQ").as_deref(), Some(&b"hello!!"[..]));
        assert_eq!(base64("a*b"), None);
    }
}
