//! Checks what a compressed scan claims against what its bytes can hold, before any memory is taken for it.

use super::broken_las as fail;
use crate::error::CloudError;
use laz::{LasZipError, LazItem, LazItemType, LazVlr};

/// Limits of what a compressed scan may claim.
struct LazLimits {
    /// Most points for one byte. Scans take a byte or more for each point; a hundred thousand points at one place
    /// come to 140 a byte.
    points_a_byte: usize,
    /// Most parts of a record, such as place, colour and time: no point format has more than 5.
    items: usize,
}

const LIMITS: LazLimits = LazLimits { points_a_byte: 2_000, items: 8 };

/// Says in words of our own why a compressed scan is not unpacked.
pub(super) fn why_packed(error: &LasZipError) -> &'static str {
    match error {
        LasZipError::IoError(e) if e.kind() == std::io::ErrorKind::UnexpectedEof => "the bytes end too early",
        LasZipError::IoError(_) => "the bytes are broken",
        LasZipError::MissingChunkTable => "its table of chunks is missing",
        _ => "it is packed in an unknown way",
    }
}

/// Bytes before the first chunk of points; they hold the position of the chunk table.
const TABLE_PLACE: usize = 8;

/// A compressed scan before it is unpacked.
pub(super) struct Packed<'a> {
    pub(super) bytes: &'a [u8],
    /// Byte at which the compressed points begin.
    pub(super) data_at: usize,
    /// Bytes of a point.
    pub(super) record: usize,
    /// Number of points that the file claims.
    pub(super) count: usize,
    /// The record that describes the compression.
    pub(super) how: &'a [u8],
}

/// Arrangement of the compressed points, as the record of `LASzip` numbers it.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Chunks {
    /// All points one after the other.
    None,
    /// Chunks of points.
    Points,
    /// Chunks of layers, one for each part of a record.
    Layers,
}

impl Packed<'_> {
    /// Returns the end of the last whole chunk: nothing behind it is to be unpacked.
    ///
    /// Guaranteed: unpacking the bytes before that end takes memory in proportion to them, and does not panic.
    pub(super) fn check(&self, vlr: &LazVlr) -> Result<usize, CloudError> {
        let chunks = self.check_kind(vlr)?;
        let there = self.bytes.len() - self.data_at;
        if self.count / LIMITS.points_a_byte > there {
            return Err(self.broken(format!("{} points are announced in {there} bytes", self.count)));
        }
        if chunks == Chunks::None {
            return Ok(self.bytes.len());
        }
        self.check_table(vlr)?;
        match chunks {
            Chunks::Layers => Ok(self.whole_layers(vlr.items())),
            _ => Ok(self.bytes.len()),
        }
    }

    /// An error unless a cell of an octree is a whole chunk of layers that may hold so many points.
    pub(super) fn check_cell(&self, vlr: &LazVlr, points: usize) -> Result<(), CloudError> {
        let is_layered = self.check_kind(vlr)? == Chunks::Layers;
        let is_whole = self.chunk_length(self.data_at, vlr.items()) == Some(self.bytes.len() - self.data_at);
        if is_layered && is_whole && points / LIMITS.points_a_byte <= self.bytes.len() - self.data_at {
            return Ok(());
        }
        Err(self.broken("a cell of its octree (COPC) does not hold what it announces".into()))
    }

    /// How it is packed, if its records are sound.
    fn check_kind(&self, vlr: &LazVlr) -> Result<Chunks, CloudError> {
        let chunks = match self.how {
            [1, 0, ..] => Chunks::None,
            [2, 0, ..] => Chunks::Points,
            [3, 0, ..] => Chunks::Layers,
            _ => return Err(self.broken("it is packed in an unknown way".into())),
        };
        self.check_items(vlr.items(), chunks)?;
        Ok(chunks)
    }

    fn broken(&self, what: String) -> CloudError {
        fail(self.data_at, what)
    }

    /// Checks that the parts of a record are those that the unpacker fills.
    fn check_items(&self, items: &[LazItem], chunks: Chunks) -> Result<(), CloudError> {
        let layered = |item: &LazItem| item.version() >= 3;
        let sound = |item: &LazItem| {
            size_of(item.item_type()) == item.size() && layered(item) == (chunks == Chunks::Layers)
        };
        if items.is_empty() || items.len() > LIMITS.items || !items.iter().all(sound) {
            return Err(self.broken("its record of LASzip has odd parts".into()));
        }
        let size: usize = items.iter().map(|item| usize::from(item.size())).sum();
        if size == self.record {
            return Ok(());
        }
        Err(self.broken(format!("its records have {} bytes and {size} packed ones", self.record)))
    }

    /// Checks that the chunk table lists no more chunks than there is room for and, if it gives the number of points
    /// of each, that they add up to the number claimed.
    fn check_table(&self, vlr: &LazVlr) -> Result<(), CloudError> {
        let long = |at: usize| {
            let raw = self.bytes.get(at..at.checked_add(8)?)?;
            i64::from_le_bytes(raw.try_into().ok()?).try_into().ok()
        };
        // A program that could not go back to write the table's position puts it at the end of the file.
        let place = long(self.data_at).filter(|&at: &usize| at > self.data_at);
        let place = place.or_else(|| long(self.bytes.len().checked_sub(8)?).filter(|&at| at > self.data_at));
        let number = place.and_then(|at| {
            let raw = self.bytes.get(at.checked_add(4)?..at.checked_add(8)?)?;
            Some(u32::from_le_bytes(raw.try_into().ok()?) as usize)
        });
        // Each chunk begins with a whole record.
        let most = (self.bytes.len() - self.data_at) / self.record + 1;
        if let Some(number) = number.filter(|&n| n > most) {
            return Err(self.broken(format!("{number} chunks are announced where {most} have room")));
        }
        if !vlr.uses_variable_size_chunks() {
            return Ok(());
        }
        let mut source = std::io::Cursor::new(self.bytes);
        source.set_position(self.data_at as u64);
        let table = laz::laszip::ChunkTable::read_from(source, vlr)
            .map_err(|e| self.broken(format!("its table of chunks: {}", why_packed(&e))))?;
        let held = table.into_iter().fold(0_u64, |sum, chunk| sum.saturating_add(chunk.point_count));
        if held < self.count as u64 {
            return Err(self.broken(format!("{} points are announced, {held} are in its chunks", self.count)));
        }
        Ok(())
    }

    /// Returns the end of the last whole chunk, found by the sizes of the layers of each.
    fn whole_layers(&self, items: &[LazItem]) -> usize {
        let mut at = (self.data_at + TABLE_PLACE).min(self.bytes.len());
        while let Some(length) = self.chunk_length(at, items) {
            at += length;
        }
        at
    }

    /// Bytes of the chunk of layers that begins there, if it is whole.
    fn chunk_length(&self, at: usize, items: &[LazItem]) -> Option<usize> {
        let layers: usize = items.iter().map(|item| layers_of(item.item_type())).sum();
        let sizes_at = self.record + 4;
        let head = sizes_at + 4 * layers;
        let chunk = self.bytes[at..].get(..head)?;
        let sizes = chunk[sizes_at..].chunks_exact(4);
        let sum: u64 = sizes.map(|s| u64::from(u32::from_le_bytes([s[0], s[1], s[2], s[3]]))).sum();
        let length = usize::try_from(sum).ok()?.checked_add(head)?;
        (length <= self.bytes.len() - at).then_some(length)
    }
}

/// Returns the bytes that a part of a record has, whatever the file says.
const fn size_of(kind: LazItemType) -> u16 {
    match kind {
        LazItemType::Byte(size) | LazItemType::Byte14(size) => size,
        LazItemType::Point10 => 20,
        LazItemType::GpsTime | LazItemType::RGBNIR14 => 8,
        LazItemType::RGB12 | LazItemType::RGB14 => 6,
        LazItemType::WavePacket13 | LazItemType::WavePacket14 => 29,
        LazItemType::Point14 => 30,
    }
}

/// Returns the number of layers that hold a part of a record.
fn layers_of(kind: LazItemType) -> usize {
    match kind {
        LazItemType::Point14 => 9,
        LazItemType::RGBNIR14 => 2,
        LazItemType::Byte14(size) => usize::from(size),
        _ => 1,
    }
}
