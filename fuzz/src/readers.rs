//! Any bytes as a file of one format: the result is sound and can be written, or there is an error with a message.

use burgeon::Report;
use burgeon::bloom::{self, GrowthLaw, Quantity};
use burgeon::document;
use burgeon::formats::{
    CloudFormat, DrawingFormat, DrawingSummary, ExportSpec, GrowthSpec, MarksAxes, ModelFormat, ReadMarks,
    SideFile, StructureFormat, StructureSpec, is_rays, read_cloud, read_drawings, read_growth, read_marks,
    read_model, read_rays, read_structure, read_vein_graph, read_xlsx, write_cloud_ply, write_drawing,
    write_glb,
};
use burgeon::mesh::MeshFault;

use super::refused;

pub fn svg(bytes: &[u8]) -> bool {
    read_any_drawings(bytes, DrawingFormat::Svg)
}

pub fn inkml(bytes: &[u8]) -> bool {
    read_any_drawings(bytes, DrawingFormat::InkMl)
}

pub fn ndjson(bytes: &[u8]) -> bool {
    read_any_drawings(bytes, DrawingFormat::Ndjson)
}

pub fn json(bytes: &[u8]) -> bool {
    read_any_drawings(bytes, DrawingFormat::Json)
}

fn read_any_drawings(bytes: &[u8], format: DrawingFormat) -> bool {
    let mut any = false;
    for read in read_drawings(bytes, format, "fuzz") {
        match read {
            Ok(read) => {
                let info = DrawingSummary::from_drawing(&read.drawing, &read.warnings);
                assert!(info.strokes > 0, "a drawing without strokes is an error");
                write_drawing(&read.drawing, std::io::sink()).expect("writes what it read");
                any = true;
            }
            Err(e) => any |= refused(&e),
        }
    }
    any
}

pub fn glb(bytes: &[u8]) -> bool {
    read_any_model(bytes, ModelFormat::Glb)
}

pub fn obj(bytes: &[u8]) -> bool {
    read_any_model(bytes, ModelFormat::Obj)
}

pub fn ply(bytes: &[u8]) -> bool {
    read_any_model(bytes, ModelFormat::Ply)
}

pub fn stl(bytes: &[u8]) -> bool {
    read_any_model(bytes, ModelFormat::Stl)
}

fn read_any_model(bytes: &[u8], format: ModelFormat) -> bool {
    // Every file that a model refers to consists of the same bytes.
    let resolve = |_: SideFile<'_>| Ok(bytes.to_vec());
    match read_model(bytes, format, "fuzz", &ExportSpec::default(), &resolve, &mut Report::default()) {
        Ok(model) => {
            let bad = model.validate().find(|f| !matches!(f, MeshFault::Degenerate(_)));
            assert_eq!(bad, None, "what was read is sound");
            write_glb(&model, std::io::sink()).expect("writes what it read");
            true
        }
        Err(e) => refused(&e),
    }
}

/// Reads a scan of the format that the first byte names.
pub fn cloud(bytes: &[u8]) -> bool {
    let Some((first, rest)) = bytes.split_first() else { return false };
    read_any_cloud(rest, CloudFormat::ALL[usize::from(*first) % CloudFormat::ALL.len()])
}

pub fn las(bytes: &[u8]) -> bool {
    read_any_cloud(bytes, CloudFormat::Las)
}

fn read_any_cloud(bytes: &[u8], format: CloudFormat) -> bool {
    match read_cloud(bytes, format, &ExportSpec::default(), &mut Report::default()) {
        Ok(cloud) => {
            assert!(cloud.is_sound() && !cloud.points.is_empty(), "what was read is sound");
            write_cloud_ply(&cloud, &ExportSpec::default(), std::io::sink()).expect("writes what it read");
            true
        }
        Err(e) => refused(&e),
    }
}

/// Reads the structure of plants in each of its formats: the result is sound and can be measured.
pub fn structure(bytes: &[u8]) -> bool {
    let mut any = false;
    for format in StructureFormat::ALL {
        match read_structure(bytes, format, "fuzz", &StructureSpec::default(), &mut Report::default()) {
            Ok(read) => {
                for plant in &read.plants {
                    assert_eq!(plant.validate().next(), None, "what was read is sound");
                    assert!(plant.measure().height_m.is_finite(), "it can be measured");
                }
                any = true;
            }
            Err(e) => {
                refused(&e);
            }
        }
    }
    any
}

/// Reads a workbook of a spreadsheet, and the growth table in it.
pub fn sheet(bytes: &[u8]) -> bool {
    match read_xlsx(bytes, None) {
        Ok(read) => {
            if let Err(e) = read_growth(read.text.as_bytes(), &GrowthSpec::default()) {
                refused(&e);
            }
            true
        }
        Err(e) => refused(&e),
    }
}

/// Reads marks or chief veins of a leaf, and a growth table.
pub fn marks(bytes: &[u8]) -> bool {
    let any = match read_growth(bytes, &GrowthSpec::default()) {
        Ok(read) => {
            let finite = read.rows.iter().all(|r| r.day.is_finite() && r.size >= 0.0 && r.size.is_finite());
            assert!(finite, "days and sizes are numbers");
            true
        }
        Err(e) => refused(&e),
    };
    let leaf = if is_rays(bytes) {
        read_rays(bytes, "fuzz", MarksAxes::default()).is_ok_and(|read| read.rays.validate().next().is_none())
    } else {
        let complete = |read: ReadMarks| read.marks.complete(&mut Report::default()).is_ok();
        read_marks(bytes, "fuzz", MarksAxes::default()).is_ok_and(complete)
    };
    any || leaf
}

/// Reads a vein graph: marks or chief veins that make a leaf.
pub fn vein_graph(bytes: &[u8]) -> bool {
    let mut report = Report::default();
    let Ok(read) = read_vein_graph(bytes) else { return false };
    if let Ok(marks) = read.graph.marks(&mut report) {
        let _ = marks.complete(&mut report);
    }
    if let Ok(Some(rays)) = read.graph.rays(&mut report) {
        let _ = rays.validate().next();
    }
    true
}

/// Reads a project: a sound document that survives being saved.
pub fn project(bytes: &[u8]) -> bool {
    match document::read_project(bytes) {
        Ok(document) => {
            assert_eq!(document.validate().next(), None, "a document that was read is sound");
            let again = document::write_project(&document, "fuzz").expect("writes what it read");
            let same = document::read_project(&again).expect("reads what it wrote") == document;
            assert!(same, "a project is the same after it was written");
            true
        }
        Err(e) => refused(&e),
    }
}

/// Reads a growth law: one that passes its checks has finite values and a finite pace, and is plotted.
pub fn law(bytes: &[u8]) -> bool {
    let Ok(law) = serde_json::from_slice::<GrowthLaw>(bytes) else { return false };
    if law.validate().next().is_some() {
        return false;
    }
    for day in [0.0, 0.3 * law.span_days, law.span_days] {
        let pace = law.progress("petal", Quantity::Size, 0.5, 0.0, law.span_days, day);
        assert!(pace.is_finite(), "day {day}: {pace}");
    }
    assert!(bloom::plot_svg(&law).contains("</svg>"), "a whole plot");
    true
}
