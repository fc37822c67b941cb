//! bytes -> [`mesh::PointCloud`]: scans as PLY, XYZ or TXT, PCD, LAS, OBJ and E57.
//!
//! Each reader gives points, colours and classes to a `Sink`; names of columns are understood in one place, `columns`. What a file
//! says of itself, and what is odd in its numbers, is in `CloudFacts`.

mod columns;
#[cfg(feature = "laz")]
mod copc;
#[cfg(feature = "e57")]
mod e57;
mod facts;
mod las;
mod las_parts;
mod las_system;
#[cfg(feature = "laz")]
mod laz_limits;
mod pcd;
mod ply;
mod sink;
mod strays;
mod text;

use std::io::{Read, Write};

use base::Report;
use mesh::PointCloud;

use crate::error::{CloudError, FileFault, Place, WriteError};
use crate::foreign::Foreign;
use crate::{CloudFormat, ExportSpec};
pub use facts::{ClassCount, CloudFacts};
use sink::Sink;

impl CloudFormat {
    /// Returns the format of a file that starts with these bytes (4,096 of them are plenty), if they can be a scan.
    ///
    /// ```
    /// use formats::CloudFormat;
    /// assert_eq!(CloudFormat::sniff(b"x;y;z\n1,5;2;3\n"), Some(CloudFormat::Xyz));
    /// assert_eq!(CloudFormat::sniff(b"VERSION 0.7\nFIELDS x y z\n"), Some(CloudFormat::Pcd));
    /// ```
    pub fn sniff(start: &[u8]) -> Option<Self> {
        if start.starts_with(b"LASF") {
            return Some(Self::Las);
        }
        if start.starts_with(b"ASTM-E57") {
            return Some(Self::E57);
        }
        if start.starts_with(b"ply\n") || start.starts_with(b"ply\r") {
            return Some(Self::Ply);
        }
        let lines = start.split(|&b| b == b'\n').map(<[u8]>::trim_ascii);
        let first = lines
            .filter(|l| !l.is_empty() && !l.starts_with(b"#"))
            .find_map(|l| l.split(|&b| b == b' ').next());
        match first {
            Some(b"VERSION" | b"FIELDS") => Some(Self::Pcd),
            Some(b"v" | b"vn" | b"mtllib" | b"o" | b"g") => Some(Self::Obj),
            _ => text::starts(start).then_some(Self::Xyz),
        }
    }
}

/// Largest scan that is read: 1 GiB.
pub const MAX_CLOUD_BYTES: u64 = 1 << 30;
/// Most points of a scan: 32 million.
pub(crate) const MAX_POINTS: usize = 32 << 20;

/// Greatest distance of a point from the origin, in units of its file: more than anything measured on Earth, in any
/// unit. Single precision can hold it and its square.
const FARTHEST: f64 = 1e15;

/// Reads a scan.
///
/// `spec` gives the unit and up axis of the file; the cloud comes back in metres, +Y up. Points that are not finite,
/// or beyond 1e15 units, are left out and reported, as is everything else that was not read. Guaranteed:
/// [`PointCloud::is_sound`], at least one point. Cost: linear; 5 million points take well under a second from a
/// binary PLY, a few seconds from a text.
///
/// # Errors
/// [`CloudError`] with the place in the file and what to do.
pub fn read_cloud(
    input: impl Read,
    format: CloudFormat,
    spec: &ExportSpec,
    report: &mut Report,
) -> Result<PointCloud, CloudError> {
    read_cloud_with_facts(input, format, spec, report).map(|(cloud, _)| cloud)
}

/// [`read_cloud`] with what the file says of itself.
///
/// # Errors
/// [`CloudError`] with the place in the file and what to do.
pub fn read_cloud_with_facts(
    input: impl Read,
    format: CloudFormat,
    spec: &ExportSpec,
    report: &mut Report,
) -> Result<(PointCloud, CloudFacts), CloudError> {
    let file = |fault| CloudError::new(format, Place::File, fault);
    let mut bytes = Vec::new();
    input.take(MAX_CLOUD_BYTES + 1).read_to_end(&mut bytes).map_err(|e| file(FileFault::Io(e)))?;
    if bytes.len() as u64 > MAX_CLOUD_BYTES {
        return Err(file(FileFault::TooMuch {
            what: "the size in bytes",
            limit: MAX_CLOUD_BYTES,
            advice: "thin the scan out or split it into several files",
        }));
    }
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return Err(file(FileFault::Empty));
    }
    if format != CloudFormat::E57 || !cfg!(feature = "e57") {
        FileFault::if_foreign(Foreign::sniff_no_drawing(&bytes)).map_err(file)?;
    }
    let mut sink = Sink::default();
    match format {
        CloudFormat::Ply => ply::read(&bytes, &mut sink, report)?,
        CloudFormat::Xyz => text::read(&bytes, &mut sink, report)?,
        CloudFormat::Pcd => pcd::read(&bytes, &mut sink)?,
        CloudFormat::Las => las::read(&bytes, &mut sink, report)?,
        CloudFormat::Obj => text::read_obj(&bytes, &mut sink, report)?,
        #[cfg(feature = "e57")]
        CloudFormat::E57 => e57::read(&bytes, &mut sink)?,
        #[cfg(not(feature = "e57"))]
        CloudFormat::E57 => {
            let advice =
                "read it by the command, or save it as LAS, PLY or XYZ, for example with CloudCompare";
            return Err(file(FileFault::unsupported("a laser scan in E57", advice)));
        }
    }
    drop(bytes);
    sink.finish(report);
    if sink.cloud.points.is_empty() {
        let what = if sink.noise + sink.deleted > 0 {
            "all of its points are noise, by their classes, or deleted"
        } else if sink.dropped > 0 {
            "none of its points is finite and of a sensible size"
        } else {
            "there is no point in it"
        };
        return Err(file(FileFault::malformed(what, "export the scan again")));
    }
    let strays = strays::leave_out(&mut sink.cloud);
    let facts = CloudFacts::collect(&sink, strays, spec, report);
    let mut cloud = sink.cloud;
    if !spec.is_default() {
        cloud.points.iter_mut().for_each(|p| *p = spec.inward(*p));
    }
    Ok((cloud, facts))
}

/// Writes a scan as binary PLY: double coordinates, and colours where there are some.
///
/// # Errors
/// [`WriteError`] of the sink.
pub fn write_cloud_ply(cloud: &PointCloud, spec: &ExportSpec, mut out: impl Write) -> Result<(), WriteError> {
    let colors = cloud.colors.len() == cloud.points.len() && !cloud.colors.is_empty();
    write!(
        out,
        "ply\nformat binary_little_endian 1.0\ncomment unit {}\n{}element vertex {}\nproperty double x\n\
         property double y\nproperty double z\n",
        spec.unit.plural(),
        spec.offset_line(cloud.offset_m, "comment"),
        cloud.points.len()
    )?;
    if colors {
        out.write_all(b"property uchar red\nproperty uchar green\nproperty uchar blue\n")?;
    }
    out.write_all(b"end_header\n")?;
    for (i, p) in cloud.points.iter().enumerate() {
        for x in spec.place(*p) {
            out.write_all(&x.to_le_bytes())?;
        }
        if colors {
            out.write_all(&cloud.colors[i])?;
        }
    }
    Ok(())
}

fn too_many(format: CloudFormat) -> CloudError {
    let fault = FileFault::TooMuch {
        what: "the number of points",
        limit: MAX_POINTS as u64,
        advice: "thin the scan out or split it into several files",
    };
    CloudError::new(format, Place::File, fault)
}

/// Returns the error for a fault at a byte of an LAS file.
fn broken_las(at: usize, what: impl Into<String>) -> CloudError {
    let fault = FileFault::malformed(what, "export the scan again");
    CloudError::new(CloudFormat::Las, Place::Byte(at as u64), fault)
}

#[cfg(test)]
mod tests;
