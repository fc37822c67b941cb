//! LAS 1.0 to 1.4, point formats 0 to 10.

use super::{CloudFormat, MAX_POINTS, Sink, too_many};
use crate::error::{CloudError, FileFault, Place};

fn fail(at: usize, what: impl Into<String>) -> CloudError {
    let fault = FileFault::malformed(what, "export the scan again");
    CloudError::new(CloudFormat::Las, Place::Byte(at as u64), fault)
}

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
    if format & 0x80 != 0 {
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
    if count > there {
        let inside = format!("the points: {count} are announced, {there} are there");
        let fault = FileFault::Truncated { inside };
        return Err(CloudError::new(CloudFormat::Las, Place::Byte(bytes.len() as u64), fault));
    }
    if count > MAX_POINTS {
        return Err(too_many(CloudFormat::Las));
    }
    for row in bytes[data_at..].chunks_exact(record).take(count) {
        let at = |k: usize| {
            let raw = [row[4 * k], row[4 * k + 1], row[4 * k + 2], row[4 * k + 3]];
            f64::from(i32::from_le_bytes(raw)) * scale[k] + offset[k]
        };
        if !sink.push([at(0), at(1), at(2)], None) {
            return Err(too_many(CloudFormat::Las));
        }
    }
    Ok(())
}
