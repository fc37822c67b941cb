//! LAS 1.0 to 1.4, point formats 0 to 10, with their colours; compressed (LAZ) with the feature `laz`.

#[cfg(feature = "laz")]
use super::laz_limits::Packed;
use super::{CloudFormat, MAX_POINTS, Sink, broken_las as fail, too_many};
use crate::error::{CloudError, FileFault, Place};

struct Bytes<'a>(&'a [u8]);

impl Bytes<'_> {
    fn get<const N: usize>(&self, at: usize) -> Result<[u8; N], CloudError> {
        let mut out = [0; N];
        let raw = self.0.get(at..at.saturating_add(N)).ok_or_else(|| {
            let fault = FileFault::Truncated { inside: "the header".into() };
            CloudError::new(CloudFormat::Las, Place::Byte(self.0.len() as u64), fault)
        })?;
        out.copy_from_slice(raw);
        Ok(out)
    }

    fn u16(&self, at: usize) -> Result<usize, CloudError> {
        Ok(usize::from(u16::from_le_bytes(self.get(at)?)))
    }

    fn u32(&self, at: usize) -> Result<usize, CloudError> {
        Ok(u32::from_le_bytes(self.get(at)?) as usize)
    }

    fn f64(&self, at: usize) -> Result<f64, CloudError> {
        Ok(f64::from_le_bytes(self.get(at)?))
    }
}

pub(super) fn read(bytes: &[u8], sink: &mut Sink) -> Result<(), CloudError> {
    let b = Bytes(bytes);
    if b.get::<4>(0)? != *b"LASF" {
        return Err(fail(0, "it does not begin with `LASF`"));
    }
    let [minor] = b.get::<1>(25)?;
    let header_size = b.u16(94)?;
    let data_at = b.u32(96)?;
    let [format] = b.get::<1>(104)?;
    // The two highest bits say that it is compressed.
    let (packed, format) = (format & 0xc0 != 0, format & 0x3f);
    if packed && !cfg!(feature = "laz") {
        let fault = FileFault::unsupported("compressed LAS (LAZ)", "unpack it first, for example with PDAL");
        return Err(CloudError::new(CloudFormat::Las, Place::Byte(104), fault));
    }
    let least = match format {
        0 => 20,
        1 => 28,
        2 => 26,
        3 => 34,
        4 => 57,
        5 => 63,
        6 => 30,
        7 => 36,
        8 => 38,
        9 => 59,
        10 => 67,
        other => return Err(fail(104, format!("point format {other} is unknown"))),
    };
    let record = b.u16(105)?;
    if record < least {
        return Err(fail(
            105,
            format!("a record of {record} bytes is shorter than point format {format} needs"),
        ));
    }
    let mut count = b.u32(107)?;
    if minor >= 4 && header_size >= 375 {
        let long = u64::from_le_bytes(b.get(247)?);
        count = usize::try_from(long).unwrap_or(usize::MAX).max(count);
    }
    let mut scale = [0.0; 3];
    let mut offset = [0.0; 3];
    for k in 0..3 {
        scale[k] = b.f64(131 + 8 * k)?;
        offset[k] = b.f64(155 + 8 * k)?;
        let sound = scale[k].is_finite() && scale[k] != 0.0 && scale[k].abs() < 1e6;
        if !sound {
            return Err(fail(131 + 8 * k, format!("the scale {} of a coordinate is no use", scale[k])));
        }
        let sound = offset[k].abs() <= 1e12;
        if !sound {
            return Err(fail(155 + 8 * k, format!("the offset {:e} of a coordinate is absurd", offset[k])));
        }
    }
    if data_at < 227.min(header_size) || data_at > bytes.len() {
        return Err(fail(96, format!("the points begin at byte {data_at} of {}", bytes.len())));
    }
    let there = (bytes.len() - data_at) / record;
    if !packed && count > there {
        let inside = format!("the points: {count} are announced, {there} are there");
        let fault = FileFault::Truncated { inside };
        return Err(CloudError::new(CloudFormat::Las, Place::Byte(bytes.len() as u64), fault));
    }
    if count > MAX_POINTS {
        return Err(too_many(CloudFormat::Las));
    }
    let colours = match format {
        2 => Some(20),
        3 | 5 => Some(28),
        7 | 8 | 10 => Some(30),
        _ => None,
    };
    let mut rows = Rows {
        scale,
        offset,
        colours,
        #[cfg(feature = "laz")]
        record,
        low: Some(vec![]),
    };
    if packed {
        #[cfg(feature = "laz")]
        unpack(bytes, (data_at, header_size, b.u32(100)?), count, &mut rows, sink)?;
    } else {
        for row in bytes[data_at..].chunks_exact(record).take(count) {
            rows.take(row, sink)?;
        }
    }
    if let Some(low) = rows.low {
        // Two bytes a colour, of which some programs write the lower one only; or nothing.
        sink.cloud.colors = if low.iter().all(|c| *c == [0; 3]) { vec![] } else { low };
    }
    Ok(())
}

/// How a record is read.
struct Rows {
    scale: [f64; 3],
    offset: [f64; 3],
    /// Where colours stand in a record.
    colours: Option<usize>,
    #[cfg(feature = "laz")]
    record: usize,
    /// The lower bytes of colours, as long as no upper one is above 0.
    low: Option<Vec<[u8; 3]>>,
}

impl Rows {
    fn take(&mut self, row: &[u8], sink: &mut Sink) -> Result<(), CloudError> {
        let at = |k: usize| {
            let raw = [row[4 * k], row[4 * k + 1], row[4 * k + 2], row[4 * k + 3]];
            f64::from(i32::from_le_bytes(raw)) * self.scale[k] + self.offset[k]
        };
        let place = [at(0), at(1), at(2)];
        let colour = self.colours.map(|c| [0, 2, 4].map(|k| row[c + k + 1]));
        if let (Some(c), Some(low)) = (self.colours, &mut self.low) {
            if colour == Some([0; 3]) {
                low.push([0, 2, 4].map(|k| row[c + k]));
            } else {
                self.low = None;
            }
        }
        if sink.push(place, colour) { Ok(()) } else { Err(too_many(CloudFormat::Las)) }
    }
}

/// Unpacks compressed points, one record at a time.
#[cfg(feature = "laz")]
fn unpack(
    bytes: &[u8],
    (data_at, mut at, records): (usize, usize, usize),
    count: usize,
    rows: &mut Rows,
    sink: &mut Sink,
) -> Result<(), CloudError> {
    let broken = |what: String| fail(data_at, what);
    let mut how = None;
    // Records before the points: one of them says how they are packed.
    for _ in 0..records {
        let b = Bytes(bytes);
        let user: [u8; 16] = b.get(at + 2)?;
        let (id, length) = (b.u16(at + 18)?, b.u16(at + 20)?);
        let data = bytes.get(at + 54..(at + 54).saturating_add(length));
        if user.starts_with(b"laszip encoded") && id == 22204 {
            how = Some(data.ok_or_else(|| fail(at, "the record of LASzip is cut off"))?);
        }
        at += 54 + length;
    }
    let how = how.ok_or_else(|| broken("it is compressed (LAZ), but no record says how".into()))?;
    let vlr = laz::LazVlr::read_from(how).map_err(|e| broken(e.to_string()))?;
    let packed = Packed { bytes, data_at, record: rows.record, count, how };
    let end = packed.check(&vlr)?;
    let mut source = std::io::Cursor::new(bytes);
    source.set_position(data_at as u64);
    let mut unpacker = laz::LasZipDecompressor::new(source, vlr).map_err(|e| broken(e.to_string()))?;
    // What claims more than is there is not begun: its memory would be taken before its bytes are read.
    let begins = unpacker.get().position();
    *unpacker.get_mut() = std::io::Cursor::new(&bytes[..end]);
    unpacker.get_mut().set_position(begins);
    let mut row = vec![0; rows.record];
    for k in 0..count {
        unpacker
            .decompress_one(&mut row)
            .map_err(|e| broken(format!("point {k} cannot be unpacked: {e}")))?;
        rows.take(&row, sink)?;
    }
    Ok(())
}
