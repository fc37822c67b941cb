//! The parts of an LAS file: numbers at their places, the records before and after the points, and the points.

#[cfg(feature = "laz")]
use super::broken_las as fail;
use super::sink::{Said, Sink};
use super::{CloudFormat, too_many};
use crate::error::{CloudError, FileFault, Place};

/// The bytes of a file, read where the file says.
#[derive(Clone, Copy)]
pub(super) struct Bytes<'a>(pub(super) &'a [u8]);

impl Bytes<'_> {
    pub(super) fn get<const N: usize>(&self, at: usize) -> Result<[u8; N], CloudError> {
        let mut out = [0; N];
        let raw = self.0.get(at..at.saturating_add(N)).ok_or_else(|| {
            let fault = FileFault::Truncated { inside: "the header".into() };
            CloudError::new(CloudFormat::Las, Place::Byte(self.0.len() as u64), fault)
        })?;
        out.copy_from_slice(raw);
        Ok(out)
    }

    pub(super) fn u16(&self, at: usize) -> Result<usize, CloudError> {
        Ok(usize::from(u16::from_le_bytes(self.get(at)?)))
    }

    pub(super) fn u32(&self, at: usize) -> Result<usize, CloudError> {
        Ok(u32::from_le_bytes(self.get(at)?) as usize)
    }

    pub(super) fn f64(&self, at: usize) -> Result<f64, CloudError> {
        Ok(f64::from_le_bytes(self.get(at)?))
    }
}

/// A record before or after the points, which says something of all of them.
#[derive(Clone, Copy)]
pub(super) struct Record<'a> {
    user: &'a [u8],
    id: usize,
    pub(super) data: &'a [u8],
}

impl Record<'_> {
    pub(super) fn is(&self, user: &str, id: usize) -> bool {
        self.user.split(|&b| b == 0).next() == Some(user.as_bytes()) && self.id == id
    }
}

/// Bytes ahead of the data of a record that stands before the points.
const SHORT_HEAD: usize = 54;
/// Bytes ahead of the data of a record that stands after the points.
const LONG_HEAD: usize = 60;

/// Returns the records of a file that are whole. Those after the points have a longer length.
pub(super) fn records(b: Bytes<'_>, minor: u8, header_size: usize) -> Result<Vec<Record<'_>>, CloudError> {
    let mut out = Vec::new();
    let mut take = |mut at: usize, count: usize, head: usize| {
        for _ in 0..count {
            let Some(raw) = b.0.get(at..at.saturating_add(head)) else { break };
            let mut long = [0; 8];
            let width = if head == LONG_HEAD { 8 } else { 2 };
            long[..width].copy_from_slice(&raw[20..20 + width]);
            let length = u64::from_le_bytes(long);
            let length = usize::try_from(length).unwrap_or(usize::MAX);
            let from = at + head;
            let Some(data) = b.0.get(from..from.saturating_add(length)) else { break };
            out.push(Record {
                user: &raw[2..18],
                id: usize::from(u16::from_le_bytes([raw[18], raw[19]])),
                data,
            });
            at = from + length;
        }
    };
    take(header_size, b.u32(100)?, SHORT_HEAD);
    if minor >= 4 && header_size >= 375 {
        let at = usize::try_from(u64::from_le_bytes(b.get(235)?)).unwrap_or(usize::MAX);
        take(at, b.u32(243)?, LONG_HEAD);
    }
    Ok(out)
}

/// The layout of the points.
pub(super) struct Rows {
    pub(super) scale: [f64; 3],
    pub(super) offset: [f64; 3],
    /// Where colours stand in a record.
    pub(super) colours: Option<usize>,
    /// It is one of point format 6 or above.
    pub(super) is_long: bool,
}

impl Rows {
    pub(super) fn take(&self, row: &[u8], sink: &mut Sink) -> Result<(), CloudError> {
        let (class, is_deleted) = if self.is_long {
            (row[16], row[15] & 0b100 != 0)
        } else {
            (row[15] & 0x1f, row[15] & 0x80 != 0)
        };
        if is_deleted {
            sink.deleted += 1;
            return Ok(());
        }
        let at = |k: usize| {
            let raw = [row[4 * k], row[4 * k + 1], row[4 * k + 2], row[4 * k + 3]];
            f64::from(i32::from_le_bytes(raw)) * self.scale[k] + self.offset[k]
        };
        let place = [at(0), at(1), at(2)];
        let said: Option<Said> = Some(sink.numbered(class));
        let taken = match self.colours {
            // Two bytes a colour, of which some programs write the lower one only; or nothing.
            Some(c) => {
                let color = [0, 2, 4].map(|k| f64::from(u16::from_le_bytes([row[c + k], row[c + k + 1]])));
                sink.push_raw(place, color, said)
            }
            None => sink.push(place, None, said),
        };
        if taken { Ok(()) } else { Err(too_many(CloudFormat::Las)) }
    }
}

/// Returns the record that says how points are packed.
#[cfg(feature = "laz")]
pub(super) fn packing<'a>(records: &[Record<'a>], data_at: usize) -> Result<&'a [u8], CloudError> {
    let how = records.iter().find(|r| r.is("laszip encoded", 22204));
    how.map(|r| r.data).ok_or_else(|| fail(data_at, "it is compressed (LAZ), but no record says how"))
}
