//! E57 (ASTM E2807): the scans of a file, each moved to where its scanner stood.

use std::io::Cursor;

use ::e57::{E57Reader, PointCloud, RecordDataType, RecordName, RecordValue};
use base::ops;
use glam::{DQuat, DVec3};
use mesh::PointClass;

use super::sink::{Said, Sink, byte};
use super::{CloudFormat, MAX_POINTS, too_many};
use crate::error::{CloudError, FileFault, Place};

/// Pages, and what each ends with: a checksum.
const PAGE: u64 = 1024;
const CHECKSUM: u64 = 4;
/// Values that one column may be ahead of another: packets hold 65,536 bytes.
const MOST_AHEAD: u64 = 8 * 65_536;
/// Most scans of a file.
const MAX_SCANS: usize = 10_000;

fn fail(place: Place, what: impl Into<String>) -> CloudError {
    CloudError::new(CloudFormat::E57, place, FileFault::malformed(what, "export the scan again"))
}

fn broken(e: &::e57::Error) -> CloudError {
    // The step that failed, then its causes.
    let mut texts = vec![e.to_string()];
    let mut cause = std::error::Error::source(e);
    while let Some(e) = cause {
        texts.push(e.to_string());
        cause = e.source();
    }
    let says = |words: &str| texts.iter().any(|t| t.contains(words));
    if (says("truncated") && !says("checksum")) || says("failed to fill whole buffer") {
        return CloudError::new(
            CloudFormat::E57,
            Place::File,
            FileFault::Truncated { inside: "its pages".into() },
        );
    }
    if says("invalid checksum") {
        return fail(Place::File, "the bytes of a page do not agree with its checksum");
    }
    fail(Place::File, texts.pop().unwrap_or_default())
}

pub(super) fn read(bytes: &[u8], sink: &mut Sink) -> Result<(), CloudError> {
    let mut reader = E57Reader::new(Cursor::new(bytes)).map_err(|e| broken(&e))?;
    let scans = reader.pointclouds();
    if scans.len() > MAX_SCANS {
        return Err(too_many(CloudFormat::E57));
    }
    let announced = scans.iter().fold(0_u64, |sum, scan| sum.saturating_add(scan.records));
    if announced > MAX_POINTS as u64 {
        return Err(too_many(CloudFormat::E57));
    }
    sink.detail = match scans.len() {
        1 => "1 scan".into(),
        n => format!("{n} scans"),
    };
    let system = reader.coordinate_metadata().map(str::trim).filter(|text| !text.is_empty());
    if let Some(text) = system {
        let system = super::las_system::System::from_wkt(text);
        sink.system = Some(system.as_ref().map_or_else(|| base::brief(text), |s| s.name.clone()));
        sink.unit = system.and_then(|s| s.unit);
    }
    // Points of scans without colours are grey if other scans have colours.
    let has_colors = scans.iter().any(|scan| Fields::find(scan).is_some_and(|f| f.color.is_some()));
    for (k, scan) in scans.iter().enumerate().filter(|(_, scan)| scan.records > 0) {
        let place = || Place::Item(format!("scan {}", k + 1));
        let fields = Fields::find(scan).ok_or_else(|| fail(place(), "its points have no place"))?;
        Streams { bytes, scan }.check().map_err(|what| fail(place(), what))?;
        let names = scan.prototype.iter().map(|r| name_of(&r.name));
        let new: Vec<String> = names.filter(|name| !sink.columns.contains(name)).collect();
        sink.columns.extend(new);
        let points = reader.pointcloud_raw(scan).map_err(|e| broken(&e))?;
        for values in points {
            let values = values.map_err(|e| broken(&e))?;
            let color = fields.color(&values).or(has_colors.then_some([128; 3]));
            let said = fields.said(&values, sink);
            let taken = match fields.place(&values) {
                Some(p) => sink.push(fields.pose(p).to_array(), color, said),
                None => sink.push([f64::NAN; 3], None, None),
            };
            if !taken {
                return Err(too_many(CloudFormat::E57));
            }
        }
    }
    Ok(())
}

fn name_of(name: &RecordName) -> String {
    match name {
        RecordName::Unknown { name, .. } => base::quoted(name),
        known => format!("{known:?}"),
    }
}

/// How the values of a point are found.
struct Fields<'a> {
    scan: &'a PointCloud,
    place: [usize; 3],
    /// The place is range, azimuth and elevation.
    is_spherical: bool,
    invalid: Option<usize>,
    color: Option<[Shade; 3]>,
    no_color: Option<usize>,
    class: Option<usize>,
    turn: DQuat,
    shift: DVec3,
}

/// A channel of a colour and the range of its numbers.
#[derive(Clone, Copy)]
struct Shade {
    at: usize,
    low: f64,
    high: f64,
}

impl<'a> Fields<'a> {
    fn find(scan: &'a PointCloud) -> Option<Self> {
        let find = |name: &RecordName| scan.prototype.iter().position(|r| r.name == *name);
        let all = |names: [RecordName; 3]| {
            let [a, b, c] = names.map(|name| find(&name));
            Some([a?, b?, c?])
        };
        let cartesian = all([RecordName::CartesianX, RecordName::CartesianY, RecordName::CartesianZ]);
        let spherical = || {
            all([RecordName::SphericalRange, RecordName::SphericalAzimuth, RecordName::SphericalElevation])
        };
        let (place, is_spherical) = match cartesian {
            Some(place) => (place, false),
            None => (spherical()?, true),
        };
        let invalid =
            if is_spherical { RecordName::SphericalInvalidState } else { RecordName::CartesianInvalidState };
        let color = all([RecordName::ColorRed, RecordName::ColorGreen, RecordName::ColorBlue]);
        let class = |r: &::e57::Record| matches!(&r.name, RecordName::Unknown { name, .. } if name.eq_ignore_ascii_case("classification"));
        let (turn, shift) = scan.transform.as_ref().map_or((DQuat::IDENTITY, DVec3::ZERO), |t| {
            let (q, s) = (&t.rotation, &t.translation);
            let turn = DQuat::from_xyzw(q.x, q.y, q.z, q.w);
            let is_turn = turn.is_finite() && turn.length_squared() > 0.0;
            (if is_turn { turn.normalize() } else { DQuat::IDENTITY }, DVec3::new(s.x, s.y, s.z))
        });
        Some(Self {
            scan,
            place,
            is_spherical,
            invalid: find(&invalid),
            color: color.map(|c| Shade::from_scan(scan, c)),
            no_color: find(&RecordName::IsColorInvalid),
            class: scan.prototype.iter().position(class),
            turn,
            shift,
        })
    }

    fn number(&self, values: &[RecordValue], at: usize) -> f64 {
        let kind = self.scan.prototype.get(at).map(|r| &r.data_type);
        values.get(at).zip(kind).and_then(|(v, kind)| v.to_f64(kind).ok()).unwrap_or(f64::NAN)
    }

    /// Where a point lies before the pose, if that was measured.
    fn place(&self, values: &[RecordValue]) -> Option<DVec3> {
        if self.invalid.is_some_and(|at| self.number(values, at) != 0.0) {
            return None;
        }
        let [a, b, c] = self.place.map(|at| self.number(values, at));
        if !self.is_spherical {
            return Some(DVec3::new(a, b, c));
        }
        let ((sin, cos), (up, level)) = (ops::sin_cos(b), ops::sin_cos(c));
        Some(DVec3::new(a * level * cos, a * level * sin, a * up))
    }

    fn pose(&self, p: DVec3) -> DVec3 {
        self.turn * p + self.shift
    }

    fn color(&self, values: &[RecordValue]) -> Option<[u8; 3]> {
        let shades = self.color.filter(|_| self.no_color.is_none_or(|at| self.number(values, at) == 0.0))?;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturation is wanted")]
        let byte = |s: Shade| (255.0 * (self.number(values, s.at) - s.low) / (s.high - s.low)).round() as u8;
        Some(shades.map(byte))
    }

    fn said(&self, values: &[RecordValue], sink: &mut Sink) -> Option<Said> {
        let class = byte(self.number(values, self.class?));
        Some(class.map_or(Said::Class(PointClass::Unknown), |class| sink.numbered(class)))
    }
}

impl Shade {
    /// The ranges that the scan gives, or else those of the type: 0 to 255 for bytes.
    fn from_scan(scan: &PointCloud, at: [usize; 3]) -> [Self; 3] {
        let kind = |k: usize| &scan.prototype[k].data_type;
        let number = |v: &Option<RecordValue>, k: usize| v.as_ref().and_then(|v| v.to_f64(kind(k)).ok());
        let limits = scan.color_limits.as_ref();
        let said = limits
            .map(|l| [(&l.red_min, &l.red_max), (&l.green_min, &l.green_max), (&l.blue_min, &l.blue_max)]);
        [0, 1, 2].map(|c| {
            let k = at[c];
            let [low, high] = match said {
                Some(said) => [number(said[c].0, k), number(said[c].1, k)],
                None => [None; 2],
            };
            let own = match *kind(k) {
                RecordDataType::Single { min, max } => [min.map(f64::from), max.map(f64::from)],
                RecordDataType::Double { min, max } => [min, max],
                RecordDataType::Integer { min, max } => [min, max].map(|x| Some(x as f64)),
                RecordDataType::ScaledInteger { min, max, scale, offset } => {
                    [min, max].map(|x| Some(x as f64 * scale + offset))
                }
            };
            let (low, high) = (low.or(own[0]).unwrap_or(0.0), high.or(own[1]).unwrap_or(255.0));
            Self { at: k, low, high: if high > low { high } else { low + 255.0 } }
        })
    }
}

/// The packets of a scan, looked at before they are unpacked.
///
/// The unpacker keeps values of a column until there are some of all others: a file whose columns are of different lengths would
/// take memory for each bit. So packets are counted first.
struct Streams<'a> {
    bytes: &'a [u8],
    scan: &'a PointCloud,
}

impl Streams<'_> {
    /// Checks that the packets hold the announced points, in columns of equal lengths.
    fn check(&self) -> Result<(), String> {
        let bits: Vec<u64> = self.scan.prototype.iter().map(|r| bits_of(&r.data_type)).collect();
        if bits.iter().all(|&b| b == 0) {
            return Err("its columns hold one value each".into());
        }
        let section = logical(self.scan.file_offset);
        let long = |at: u64| {
            let mut word = [0; 8];
            self.take(section + at, &mut word).map(|()| u64::from_le_bytes(word))
        };
        let (end, mut at) = (section.saturating_add(long(8)?), logical(long(16)?));
        let mut streams = vec![0_u64; bits.len()];
        let items = |streams: &[u64]| {
            let counts = streams.iter().zip(&bits).filter(|(_, bits)| **bits > 0);
            counts.map(|(bytes, bits)| 8 * bytes / bits).collect::<Vec<u64>>()
        };
        loop {
            let counts = items(&streams);
            let (least, most) = (counts.iter().min().copied(), counts.iter().max().copied());
            let (least, most) = (least.unwrap_or(0), most.unwrap_or(0));
            if most - least > MOST_AHEAD {
                return Err("its columns have different lengths".into());
            }
            if least >= self.scan.records {
                return Ok(());
            }
            let too_few = || format!("{} points are announced, {least} are there", self.scan.records);
            let mut packet = [0; 6];
            self.take(at, &mut packet).map_err(|_end| too_few())?;
            let length = u64::from(u16::from_le_bytes([packet[2], packet[3]])) + 1;
            if packet[0] == 1 {
                let count = usize::from(u16::from_le_bytes([packet[4], packet[5]]));
                if count != streams.len() && at >= end {
                    return Err(too_few());
                }
                if count != streams.len() {
                    return Err("a packet has other columns than the scan".into());
                }
                for (k, bytes) in streams.iter_mut().enumerate() {
                    let mut size = [0; 2];
                    self.take(at + 6 + 2 * k as u64, &mut size)?;
                    *bytes += u64::from(u16::from_le_bytes(size));
                }
            }
            at += length.next_multiple_of(4);
        }
    }

    /// Copies bytes from a place that does not count checksums.
    fn take(&self, at: u64, to: &mut [u8]) -> Result<(), String> {
        if at > self.bytes.len() as u64 {
            return Err("its points are cut off".into());
        }
        for (byte, at) in to.iter_mut().zip(at..) {
            let physical = at / (PAGE - CHECKSUM) * PAGE + at % (PAGE - CHECKSUM);
            let place = usize::try_from(physical).ok();
            *byte = *place.and_then(|p| self.bytes.get(p)).ok_or("its points are cut off")?;
        }
        Ok(())
    }
}

/// A place in the file without the checksums before it.
const fn logical(physical: u64) -> u64 {
    physical - physical / PAGE * CHECKSUM
}

/// Bits of a value.
fn bits_of(kind: &RecordDataType) -> u64 {
    match kind {
        RecordDataType::Single { .. } => 32,
        RecordDataType::Double { .. } => 64,
        RecordDataType::ScaledInteger { min, max, .. } | RecordDataType::Integer { min, max } => {
            let range = i128::from(*max) - i128::from(*min);
            if range > 0 { u64::from(range.ilog2()) + 1 } else { 0 }
        }
    }
}
