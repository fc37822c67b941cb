//! What a compressed scan claims, against what its bytes can hold: before any memory is taken for it.

use super::broken_las as fail;
use crate::error::CloudError;
use laz::{LazItem, LazItemType, LazVlr};

/// How much a compressed scan may claim.
struct LazLimits {
    /// Points of a byte. Scans take a byte or more for each point; a hundred thousand points at one place come to 140 a byte.
    points_a_byte: usize,
    /// Parts of a record, such as place, colour and time: no point format has more than 5.
    items: usize,
}

const LIMITS: LazLimits = LazLimits { points_a_byte: 2_000, items: 8 };

/// Bytes before the points of chunks, which say where the table of chunks is.
const TABLE_PLACE: usize = 8;

/// A compressed scan before it is unpacked.
pub(super) struct Packed<'a> {
    pub(super) bytes: &'a [u8],
    /// Where the compressed points begin.
    pub(super) data_at: usize,
    /// Bytes of a point.
    pub(super) record: usize,
    /// Points that are claimed.
    pub(super) count: usize,
    /// The record that says how they are packed.
    pub(super) how: &'a [u8],
}

/// How chunks are packed, as the record of `LASzip` numbers it.
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
    /// Where the last chunk ends that is whole: nothing behind it is to be unpacked.
    ///
    /// Guaranteed: what is unpacked of the bytes before takes memory in proportion to them, and does not panic.
    pub(super) fn check(&self, vlr: &LazVlr) -> Result<usize, CloudError> {
        let there = self.bytes.len() - self.data_at;
        if self.count / LIMITS.points_a_byte > there {
            return Err(self.broken(format!("{} points are announced in {there} bytes", self.count)));
        }
        let chunks = match self.how {
            [1, 0, ..] => Chunks::None,
            [2, 0, ..] => Chunks::Points,
            [3, 0, ..] => Chunks::Layers,
            _ => return Err(self.broken("it is packed in an unknown way".into())),
        };
        self.check_items(vlr.items(), chunks)?;
        if chunks == Chunks::None {
            return Ok(self.bytes.len());
        }
        self.check_table(vlr)?;
        match chunks {
            Chunks::Layers => Ok(self.whole_layers(vlr.items())),
            _ => Ok(self.bytes.len()),
        }
    }

    fn broken(&self, what: String) -> CloudError {
        fail(self.data_at, what)
    }

    /// The parts of a record are those that the unpacker fills.
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

    /// The table of chunks has as many as there can be and, where it says how many points each holds, enough of them.
    fn check_table(&self, vlr: &LazVlr) -> Result<(), CloudError> {
        let long = |at: usize| {
            let raw = self.bytes.get(at..at.checked_add(8)?)?;
            i64::from_le_bytes(raw.try_into().ok()?).try_into().ok()
        };
        // Where a program could not go back to write it, its place stands at the end.
        let place = long(self.data_at).filter(|&at: &usize| at > self.data_at);
        let place = place.or_else(|| long(self.bytes.len().checked_sub(8)?).filter(|&at| at > self.data_at));
        let number = place.and_then(|at| {
            let raw = self.bytes.get(at.checked_add(4)?..at.checked_add(8)?)?;
            Some(u32::from_le_bytes(raw.try_into().ok()?) as usize)
        });
        // Each begins with a whole record.
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
            .map_err(|e| self.broken(format!("its table of chunks: {e}")))?;
        let held = table.into_iter().fold(0_u64, |sum, chunk| sum.saturating_add(chunk.point_count));
        if held < self.count as u64 {
            return Err(self.broken(format!("{} points are announced, {held} are in its chunks", self.count)));
        }
        Ok(())
    }

    /// Goes from chunk to chunk by the sizes of their layers.
    fn whole_layers(&self, items: &[LazItem]) -> usize {
        let layers: usize = items.iter().map(|item| layers_of(item.item_type())).sum();
        let sizes_at = self.record + 4;
        let head = sizes_at + 4 * layers;
        let mut at = (self.data_at + TABLE_PLACE).min(self.bytes.len());
        while let Some(chunk) = self.bytes[at..].get(..head) {
            let sizes = chunk[sizes_at..].chunks_exact(4);
            let sum: u64 = sizes.map(|s| u64::from(u32::from_le_bytes([s[0], s[1], s[2], s[3]]))).sum();
            match usize::try_from(sum).ok().and_then(|sum| sum.checked_add(head)) {
                Some(length) if length <= self.bytes.len() - at => at += length,
                _ => break,
            }
        }
        at
    }
}

/// Bytes that a part of a record has, whatever the file says.
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

/// Layers in which a part of a record lies.
fn layers_of(kind: LazItemType) -> usize {
    match kind {
        LazItemType::Point14 => 9,
        LazItemType::RGBNIR14 => 2,
        LazItemType::Byte14(size) => usize::from(size),
        _ => 1,
    }
}
