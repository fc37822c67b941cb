//! bytes -> [`plant::Plant`]: the structure of plants that other programs or people measured.
//!
//! `SWC, MTG -> joints | QSM, OPF -> cylinders -> joints -> plants`

mod cylinders;
mod joints;
mod mtg;
mod opf;
mod organs;
mod qsm;
mod swc;

use std::io::Read;

use base::{Report, UpAxis};
use glam::DVec3;
use plant::Plant;

use crate::StructureFormat;
use crate::drawing::text_of;
use crate::error::{FileFault, Place, Placed};
use crate::foreign::Foreign;
use joints::Built;

/// Settings for reading the structure of plants, where the file does not give them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StructureSpec {
    /// The axis that points up; none: as the file says, or +Z, as in the programs that write such files.
    pub up: Option<UpAxis>,
    /// Metres per unit of length, above 0; none: as the file says, or 1.
    pub metres: Option<f64>,
    /// Metres per unit of radii and diameters, above 0; none: as lengths.
    pub thickness_metres: Option<f64>,
}

/// The plants of a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReadStructure {
    /// At least one, each sound and with an axis; they stand where the file has them.
    pub plants: Vec<Plant>,
    /// Counts of the file's entries.
    pub tally: StructureTally,
}

/// Counts of the entries of a file: rows of a table, vertices of an MTG, elements of an OPF.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StructureTally {
    /// Number of entries.
    pub entries: u64,
    /// Number of entries that are part of a plant.
    pub used: u64,
    /// Number of places without a radius in the file: it follows from their neighbours.
    pub radii_missing: u64,
    /// The file gives its unit of length.
    pub unit_said: bool,
}

/// Error of reading the structure of a plant.
#[derive(Debug, thiserror::Error)]
#[error("{}{place}: {fault}", format.name())]
pub struct StructureError {
    /// The format that the reader expected.
    pub format: StructureFormat,
    /// Where.
    pub place: Place,
    /// The fault, and what to do.
    pub fault: FileFault,
}

base::coded!(StructureError {} wraps { Self { place, fault, .. } => &Placed { place, fault }, Placed<'_> });

/// Most that is read of a file.
struct Limits {
    /// Most bytes of the file.
    bytes: u64,
    /// Most nodes of all plants.
    joints: usize,
    /// Most axes without a bearer.
    roots: usize,
    /// Greatest distance from the origin, in units of the file: more than anything measured on Earth, in any unit.
    farthest: f64,
}

const LIMITS: Limits = Limits { bytes: 512 << 20, joints: 2_000_000, roots: 1_000, farthest: 1e12 };

/// A fault and its line, from 1; 0 for the file as a whole.
type Fault = (usize, FileFault);

fn fault_at(line: usize, what: impl Into<String>, advice: &'static str) -> Fault {
    (line, FileFault::malformed(what, advice))
}

/// Conversion from the file to metres with +Y up.
#[derive(Clone, Copy, Debug)]
struct Inward {
    up: UpAxis,
    metres: f64,
    thickness: f64,
}

impl Inward {
    /// Combines the settings with `said`: the file's own unit in metres and up axis.
    fn new(spec: &StructureSpec, said: (Option<f64>, Option<UpAxis>)) -> Self {
        let metres = spec.metres.or(said.0).unwrap_or(1.0);
        let up = spec.up.or(said.1).unwrap_or(UpAxis::Z);
        Self { up, metres, thickness: spec.thickness_metres.unwrap_or(metres) }
    }

    fn place(&self, p: DVec3) -> DVec3 {
        self.turn(p) * self.metres
    }

    fn turn(&self, v: DVec3) -> DVec3 {
        match self.up {
            UpAxis::Y => v,
            UpAxis::Z => DVec3::new(v.x, v.z, -v.y),
        }
    }

    /// Converts a radius; not a number if there is no valid one.
    fn radius(&self, r: Option<f64>) -> f64 {
        r.filter(|r| *r >= 0.0 && *r < LIMITS.farthest).map_or(f64::NAN, |r| r * self.thickness)
    }
}

/// Reads the unit and up axis from our own comments: `lengths in metres` and `Z up`.
fn said_in(comment: &str) -> (Option<f64>, Option<UpAxis>) {
    let low = comment.to_ascii_lowercase();
    let Some((_, rest)) = low.split_once("lengths in ") else { return (None, None) };
    let unit = base::Unit::ALL.into_iter().find(|u| rest.starts_with(u.plural())).map(base::Unit::metres);
    let up = match () {
        () if rest.contains("z up") => Some(UpAxis::Z),
        () if rest.contains("y up") => Some(UpAxis::Y),
        () => None,
    };
    (unit, up)
}

/// Reads the structure of plants: axes with radii, and organs if the file has them.
///
/// - **SWC**: rows of `id type x y z radius parent`. At a fork, the axis continues with the thickest branch, or with
///   the one that reaches farthest; files of our own continue with the original one.
/// - **QSM**: a table of cylinders with a head (`TreeQSM`, rTwig, `SimpleForest`, ours) or without (the text of
///   `TreeQSM`). Nodes get the radii with which each axis keeps its volume.
/// - **MTG** (Godin and Caraglio 1998): every vertex with a position (`XX`, `YY`, `ZZ`) is a node. Organs of our own
///   files get plain shapes of their length and area; chains of three points of digitised leaflets become leaves.
/// - **OPF**: internodes and organs by their matrices; organs get plain shapes of their length and area.
///
/// Guaranteed: [`Plant::validate`] finds nothing; the plants of our own files have the topology, lengths and radii
/// that were written, to the printed digits (a QSM has neither roots nor stalks, an SWC no radii at the bases of
/// borne axes). Not guaranteed: the outlines of organs, which only meshes have. Stems whose feet are near each other
/// are one plant. Cost: n log n.
///
/// # Errors
/// [`StructureError`] with the line: no axis, parents that are missing or form a circle, places that are not numbers,
/// too many entries.
///
/// ```
/// use formats::{StructureFormat, StructureSpec, read_structure};
/// let file = "1 5 0 0 0 0.1 -1\n2 5 0 0 2 0.05 1\n3 5 1 0 3 0.02 2\n";
/// let mut report = base::Report::default();
/// let spec = StructureSpec::default();
/// let read = read_structure(file.as_bytes(), StructureFormat::Swc, "tree", &spec, &mut report)?;
/// assert_eq!((read.plants.len(), read.plants[0].measure().height_m), (1, 3.0));
/// # Ok::<(), formats::StructureError>(())
/// ```
pub fn read_structure(
    input: impl Read,
    format: StructureFormat,
    name: &str,
    spec: &StructureSpec,
    report: &mut Report,
) -> Result<ReadStructure, StructureError> {
    let failed = |(line, fault): Fault| {
        let place = if line > 0 { Place::line(line) } else { Place::File };
        StructureError { format, place, fault }
    };
    let text = text(input).map_err(|fault| failed((0, fault)))?;
    let built = match format {
        StructureFormat::Swc => swc::read(&text, spec),
        StructureFormat::Qsm => qsm::read(&text, spec, report),
        StructureFormat::Mtg => mtg::read(&text, spec, report),
        StructureFormat::Opf => opf::read(&text, spec, report),
    };
    let Built { mut plants, tally, .. } = built.map_err(failed)?;
    if plants.is_empty() {
        return Err(failed(fault_at(0, "no axis is in it: nothing has two places", "is it the right file?")));
    }
    let many = plants.len() > 1;
    for (k, plant) in plants.iter_mut().enumerate() {
        plant.name = if many { format!("{name} {}", k + 1) } else { name.to_owned() };
        debug_assert_eq!(plant.validate().next(), None, "a plant that was read");
    }
    if tally.radii_missing > 0 {
        let missing = tally.radii_missing;
        base::warn!(
            report,
            "radii-missing",
            { missing = missing },
            "{missing} places have no radius in the file: it follows from those around them"
        );
    }
    Ok(ReadStructure { plants, tally })
}

impl StructureFormat {
    /// Returns the format of a file that starts with these bytes (4,096 of them are plenty), if they show it: an SWC
    /// need not.
    ///
    /// ```
    /// use formats::StructureFormat;
    /// assert_eq!(StructureFormat::sniff(b"CODE:\tFORM-A\n"), Some(StructureFormat::Mtg));
    /// assert_eq!(StructureFormat::sniff(b"radius,length,start.x,parent\n"), Some(StructureFormat::Qsm));
    /// assert_eq!(StructureFormat::sniff(b"x,y,z\n"), None);
    /// ```
    pub fn sniff(start: &[u8]) -> Option<Self> {
        let head = String::from_utf8_lossy(start);
        let text = head.trim_start_matches('\u{feff}').trim_start();
        if text.starts_with('<') {
            return text.contains("<opf").then_some(Self::Opf);
        }
        if text.starts_with("# SWC") {
            return Some(Self::Swc);
        }
        let mut lines = text.lines().map(str::trim).filter(|l| !l.is_empty() && !l.starts_with('#'));
        let first = lines.next()?;
        let is_code = first.split_once(':').is_some_and(|(key, form)| {
            key.trim().eq_ignore_ascii_case("CODE")
                && form.trim_start().to_ascii_uppercase().starts_with("FORM-")
        });
        if is_code {
            return Some(Self::Mtg);
        }
        qsm::is_head(first).then_some(Self::Qsm)
    }
}

/// Reads a whole file as text.
fn text(input: impl Read) -> Result<String, FileFault> {
    let mut bytes = Vec::new();
    input.take(LIMITS.bytes + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > LIMITS.bytes {
        let (what, advice) = ("the size in bytes", "split it into a file for each plant");
        return Err(FileFault::TooMuch { what, limit: LIMITS.bytes, advice });
    }
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return Err(FileFault::Empty);
    }
    FileFault::if_foreign(Foreign::sniff_no_drawing(&bytes))?;
    // Old structure files are in Latin-1 and do not say so.
    if std::str::from_utf8(&bytes).is_err()
        && !bytes.starts_with(&[0xff, 0xfe])
        && !bytes.starts_with(&[0xfe, 0xff])
    {
        return Ok(bytes.into_iter().map(char::from).collect());
    }
    text_of(bytes)
}

/// Returns a place from three numbers, if they are valid.
fn place_of(numbers: [Option<f64>; 3]) -> Option<DVec3> {
    let [Some(x), Some(y), Some(z)] = numbers else { return None };
    let p = DVec3::new(x, y, z);
    (p.is_finite() && p.abs().max_element() < LIMITS.farthest).then_some(p)
}
