//! LAS 1.0 to 1.4, point formats 0 to 10, with their colours and classes; compressed (LAZ, COPC) with the feature `laz`.

use base::Report;

#[cfg(feature = "laz")]
use super::copc::Copc;
#[cfg(feature = "laz")]
use super::las_parts::packing;
use super::las_parts::{Bytes, Record, Rows, records};
use super::las_system::System;
#[cfg(feature = "laz")]
use super::laz_limits::{Packed, why_packed};
use super::sink::Sink;
use super::{CloudFormat, MAX_POINTS, broken_las as fail, too_many};
use crate::error::{CloudError, FileFault, Place};

pub(super) fn read(bytes: &[u8], sink: &mut Sink, report: &mut Report) -> Result<(), CloudError> {
    let b = Bytes(bytes);
    if b.get::<4>(0)? != *b"LASF" {
        return Err(fail(0, "it does not begin with `LASF`"));
    }
    let [minor] = b.get::<1>(25)?;
    let header_size = b.u16(94)?;
    let data_at = b.u32(96)?;
    let [format] = b.get::<1>(104)?;
    // The two highest bits of the format say that the points are compressed.
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
    let (scale, offset) = steps(b)?;
    if data_at < 227.min(header_size) || data_at > bytes.len() {
        return Err(fail(96, format!("the points begin at byte {data_at} of {}", bytes.len())));
    }
    let there = (bytes.len() - data_at) / record;
    if !packed && count > there {
        let inside = format!("the points: {count} are announced, {there} are there");
        let fault = FileFault::Truncated { inside };
        return Err(CloudError::new(CloudFormat::Las, Place::Byte(bytes.len() as u64), fault));
    }
    let records = records(b, minor, header_size)?;
    describe(&records, (minor, format, packed), sink)?;
    sink.step = Some(scale.iter().fold(0.0, |most: f64, s| most.max(s.abs())));
    let colours = match format {
        2 => Some(20),
        3 | 5 => Some(28),
        7 | 8 | 10 => Some(30),
        _ => None,
    };
    sink.has_whole_colors = true;
    if colours.is_some() {
        sink.columns.extend(["red", "green", "blue"].map(String::from));
    }
    let rows = Rows { scale, offset, colours, is_long: format >= 6 };
    #[cfg(feature = "laz")]
    let octree = Copc::find(bytes, &records, record).filter(|_| packed && count > MAX_POINTS);
    #[cfg(feature = "laz")]
    if let Some(copc) = octree {
        return copc.read(&rows, MAX_POINTS, sink, report);
    }
    #[cfg(not(feature = "laz"))]
    let _ = report;
    if count > MAX_POINTS {
        return Err(too_many(CloudFormat::Las));
    }
    if packed {
        #[cfg(feature = "laz")]
        unpack(bytes, (data_at, record), &records, count, &rows, sink)?;
    } else {
        for row in bytes[data_at..].chunks_exact(record).take(count) {
            rows.take(row, sink)?;
        }
    }
    Ok(())
}

/// Scale and offset of the coordinates.
fn steps(b: Bytes<'_>) -> Result<([f64; 3], [f64; 3]), CloudError> {
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
    Ok((scale, offset))
}

/// Takes from the records the kind of the file, its coordinate system and the names of its classes.
fn describe(
    records: &[Record<'_>],
    (minor, format, packed): (u8, u8, bool),
    sink: &mut Sink,
) -> Result<(), CloudError> {
    let packed = if packed { ", compressed (LAZ)" } else { "" };
    sink.detail = format!("LAS 1.{minor}, point format {format}{packed}");
    sink.columns = ["x", "y", "z", "intensity", "classification"].map(String::from).to_vec();
    if let Some(system) = System::from_records(records) {
        if system.is_in_degrees {
            let what = format!("coordinates in degrees ({})", system.name);
            let fault = FileFault::unsupported(
                what,
                "bring it into a coordinate system in metres first, for example with PDAL (filters.reprojection)",
            );
            return Err(CloudError::new(CloudFormat::Las, Place::File, fault));
        }
        (sink.system, sink.unit) = (Some(system.name), system.unit);
    }
    for table in records.iter().filter(|r| r.is("LASF_Spec", 0)) {
        for row in table.data.chunks_exact(16) {
            let name = row[1..].split(|&b| b == 0).next().unwrap_or_default();
            let name = String::from_utf8_lossy(name).trim().to_owned();
            if !name.is_empty() {
                sink.names.insert(row[0], name);
            }
        }
    }
    Ok(())
}

/// Unpacks compressed points, one record at a time.
#[cfg(feature = "laz")]
fn unpack(
    bytes: &[u8],
    (data_at, record): (usize, usize),
    records: &[Record<'_>],
    count: usize,
    rows: &Rows,
    sink: &mut Sink,
) -> Result<(), CloudError> {
    let broken = |what: String| fail(data_at, what);
    let how = packing(records, data_at)?;
    let vlr = laz::LazVlr::read_from(how).map_err(|e| broken(why_packed(&e).into()))?;
    let packed = Packed { bytes, data_at, record, count, how };
    let end = packed.check(&vlr)?;
    let mut source = std::io::Cursor::new(bytes);
    source.set_position(data_at as u64);
    let mut unpacker =
        laz::LasZipDecompressor::new(source, vlr).map_err(|e| broken(why_packed(&e).into()))?;
    // Decoding does not start if the file claims more than it holds: memory is taken before the bytes are read.
    let begins = unpacker.get().position();
    *unpacker.get_mut() = std::io::Cursor::new(&bytes[..end]);
    unpacker.get_mut().set_position(begins);
    let mut row = vec![0; record];
    for k in 0..count {
        unpacker
            .decompress_one(&mut row)
            .map_err(|e| broken(format!("point {k} cannot be unpacked: {}", why_packed(&e.into()))))?;
        rows.take(&row, sink)?;
    }
    Ok(())
}
