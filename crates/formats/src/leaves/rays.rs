//! Leaves whose chief veins start together, as CSV: `vein,mark,x,y,z,thickness`.

use std::collections::BTreeMap;
use std::io::{Read, Write};

use base::{Unit, UpAxis};
use glam::DVec3;
use leaf::{ChiefVein, Rays, ThicknessRule};

use super::fields::Fields;
use super::{LeafFileError, MarksAxes};
use crate::error::{FileFault, Place, WriteError};

/// Most lines of marks, and most marks on one, more than anybody digitises.
const MOST: usize = 1000;

/// Contents of a file of chief veins.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadRays {
    /// The leaf's name in the file, or the one given to the reader.
    pub name: String,
    /// The lines of marks in metres, +Y up.
    pub rays: Rays,
    /// Meaning of the thickness, if the file gives it.
    pub thickness: Option<ThicknessRule>,
    /// Unit and up axis that were used: the file's, or those given to the reader.
    pub axes: MarksAxes,
    /// The file gives its unit; if not, that of the reader was used.
    pub is_unit_said: bool,
}

/// Returns whether the text of a leaf starts with the column `vein`: then it is for [`read_rays`], not for
/// [`read_marks`](super::read_marks).
pub fn is_rays(start: &[u8]) -> bool {
    let text = String::from_utf8_lossy(start);
    let mut lines = text.lines().map(|l| l.trim_start_matches('\u{feff}').trim());
    let first = lines.find(|l| !super::is_blank(l) && super::comment_of(l).is_none()).unwrap_or_default();
    first.split([',', ';', '\t']).any(|f| f.trim().eq_ignore_ascii_case("vein"))
}

/// Reads chief veins: one line a mark, in any order.
///
/// Veins count from 1 at the right margin, marks from 1 at the base. A line of marks without thickness is not a vein,
/// but a margin or a notch between lobes. Comments as in [`read_marks`](super::read_marks).
///
/// # Errors
/// [`LeafFileError`] with the line, for missing or repeated marks, veins that are left out, different numbers of
/// marks, cells that are not numbers, and thickness that is not above 0.
pub fn read_rays(input: impl Read, name: &str, axes: MarksAxes) -> Result<ReadRays, LeafFileError> {
    let file = |fault| LeafFileError::new(Place::File, fault);
    let text = super::text(input)?;
    let mut out =
        ReadRays { name: name.into(), rays: Rays::default(), thickness: None, axes, is_unit_said: false };
    let mut axes = axes;
    let mut columns: Option<(Fields, [Option<usize>; 6])> = None;
    let mut marks: BTreeMap<(usize, usize), (DVec3, Option<f64>, usize)> = BTreeMap::new();
    for (k, line) in text.lines().enumerate() {
        let line = line.trim_start_matches('\u{feff}').trim();
        let placed = |fault| LeafFileError::new(Place::line(k + 1), fault);
        if let Some(comment) = super::comment_of(line) {
            out.is_unit_said |= super::marks::says_unit(comment);
            super::marks::setting(comment, &mut axes, &mut out.name, &mut out.thickness).map_err(placed)?;
            continue;
        }
        if super::is_blank(line) {
            continue;
        }
        let Some((fields, columns)) = &columns else {
            let fields = Fields::from_header(line);
            columns = Some((fields, header(&fields.split(line)).map_err(placed)?));
            continue;
        };
        let (key, point, thickness) = mark(columns, fields, line).map_err(placed)?;
        if let Some((_, _, first)) = marks.insert(key, (point, thickness, k + 1)) {
            let what = format!("vein {}, mark {} is given twice, first on line {first}", key.0, key.1);
            return Err(placed(FileFault::malformed(what, "remove one of the two")));
        }
    }
    if columns.is_none() || marks.is_empty() {
        return Err(file(FileFault::Empty));
    }
    out.axes = axes;
    let unit = axes.unit.metres();
    let turned = |p: DVec3| if axes.up == UpAxis::Z { DVec3::new(p.x, p.z, -p.y) * unit } else { p * unit };
    for (&(vein, mark), &(point, thickness, _)) in &marks {
        let rays = &mut out.rays.rays;
        if vein > rays.len() + 1 {
            let what = format!("vein {} is missing", rays.len() + 1);
            return Err(file(FileFault::malformed(what, "number the veins from 1 without gaps")));
        }
        if vein == rays.len() + 1 {
            rays.push(ChiefVein::default());
        }
        let ray = &mut rays[vein - 1];
        if mark != ray.points.len() + 1 {
            let what = format!("vein {vein}: mark {} is missing", ray.points.len() + 1);
            return Err(file(FileFault::malformed(what, "number the marks of a vein from 1 without gaps")));
        }
        ray.points.push(turned(point));
        ray.thickness.push(thickness.map(|t| t * unit));
    }
    Ok(out)
}

fn header(fields: &[&str]) -> Result<[Option<usize>; 6], FileFault> {
    let names = ["vein", "mark", "x", "y", "z", "thickness"];
    let place = |name: &str| fields.iter().position(|f| f.eq_ignore_ascii_case(name));
    let columns = names.map(place);
    match (0..5).find(|&k| columns[k].is_none()) {
        Some(k) => Err(FileFault::malformed(
            format!("the first line has no column `{}`", names[k]),
            "start with the line vein,mark,x,y,z,thickness",
        )),
        None => Ok(columns),
    }
}

type Mark = ((usize, usize), DVec3, Option<f64>);

fn mark(columns: &[Option<usize>; 6], format: &Fields, text: &str) -> Result<Mark, FileFault> {
    let fields = format.row(text)?;
    let field = |k: usize| columns[k].and_then(|c| fields.get(c)).copied().unwrap_or_default();
    let count = |k: usize, what: &str| match field(k).parse::<usize>() {
        Ok(n) if (1..=MOST).contains(&n) => Ok(n),
        _ => Err(FileFault::malformed(
            format!("`{}` is no number of a {what}", field(k)),
            "veins count from 1 at the right margin, marks from 1 at the base",
        )),
    };
    let number = |k: usize, what: &str| match format.number(field(k)) {
        Some(x) => Ok(x),
        None => Err(FileFault::malformed(
            format!("{what} `{}` is no finite number", field(k)),
            "write numbers like 12.5; a mark needs x, y and z",
        )),
    };
    let key = (count(0, "vein")?, count(1, "mark")?);
    let point = DVec3::new(number(2, "x")?, number(3, "y")?, number(4, "z")?);
    let thickness = if field(5).is_empty() { None } else { Some(number(5, "the thickness")?) };
    match thickness {
        Some(t) if t <= 0.0 => Err(FileFault::malformed(
            format!("the thickness is {t}, but must be above 0"),
            "leave it empty if it was not measured",
        )),
        _ => Ok((key, point, thickness)),
    }
}

/// Writes chief veins as CSV in millimetres, +Z up, to a thousandth.
///
/// # Errors
/// [`WriteError::Io`].
pub fn write_rays(rays: &Rays, name: &str, mut out: impl Write) -> Result<(), WriteError> {
    let name: String = name.chars().filter(|c| !c.is_control()).collect();
    writeln!(out, "# burgeon leaf veins\n# name: {name}\n# unit: mm\n# up: z\n# thickness: diameter")?;
    writeln!(
        out,
        "# Veins from the right margin to the left, marks from the base outwards, as many on each."
    )?;
    writeln!(out, "# A line of marks without thickness is a margin or a notch between lobes.")?;
    writeln!(out, "vein,mark,x,y,z,thickness")?;
    let mm = 1.0 / Unit::Millimetre.metres();
    for (i, ray) in rays.rays.iter().enumerate() {
        for (m, p) in ray.points.iter().enumerate() {
            let thick = ray.thickness.get(m).copied().flatten();
            let thick = thick.map_or_else(String::new, |t| format!("{:.4}", t * mm));
            let (x, y, z) = (p.x * mm, -p.z * mm, p.y * mm);
            writeln!(out, "{},{},{x:.3},{y:.3},{z:.3},{thick}", i + 1, m + 1)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use leaf::PalmateSpec;

    use super::*;

    fn read(text: &str) -> Result<ReadRays, LeafFileError> {
        read_rays(text.as_bytes(), "test", MarksAxes::default())
    }

    #[test]
    fn veins_come_back_as_they_were_written() {
        let rays = Rays::palmate(&PalmateSpec::default());
        let mut bytes = Vec::new();
        write_rays(&rays, "maple", &mut bytes).unwrap();
        assert!(is_rays(&bytes) && !is_rays(b"# note\nrow,mark,x,y,z\n"));
        let back = read_rays(&bytes[..], "test", MarksAxes::default()).unwrap();
        assert_eq!((back.name.as_str(), back.thickness), ("maple", Some(ThicknessRule::Diameter)));
        for (a, b) in back.rays.rays.iter().zip(&rays.rays) {
            assert!(a.points.iter().zip(&b.points).all(|(p, q)| p.distance(*q) < 2e-6));
            assert_eq!(a.is_vein(), b.is_vein());
        }
        assert_eq!(back.rays.rays.len(), rays.rays.len());
    }

    #[test]
    fn faults_name_line_vein_and_mark() {
        let fault = |body: &str| read(&format!("vein,mark,x,y,z,thickness\n{body}")).unwrap_err().to_string();
        for (body, words) in [
            ("1,1,0,0,0,1\n1,1,0,1,0,1\n", "given twice, first on line 2"),
            ("1,1,0,0,0,1\n1,3,0,1,0,1\n", "vein 1: mark 2 is missing"),
            ("1,1,0,0,0,1\n3,1,0,1,0,1\n", "vein 2 is missing"),
            ("1,1,0,0,nan,1\n", "z `nan` is no finite number"),
            ("1,1,0,0,0,-2\n", "must be above 0"),
            ("99999999,1,0,0,0,\n", "no number of a vein"),
        ] {
            assert!(fault(body).contains(words), "{}", fault(body));
        }
        assert!(read("vein,mark,x,y\n").unwrap_err().to_string().contains("no column `z`"));
    }
}
