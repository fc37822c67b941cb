//! PLY points. The header and its checks are those of the model reader.

use base::Report;

use super::{CloudFormat, Sink, too_many};
use crate::error::{CloudError, FileFault, ModelError, Place};
use crate::model::ply_read::{Element, Input, Row, check_count, header};

fn as_cloud(e: ModelError) -> CloudError {
    CloudError::new(CloudFormat::Ply, e.place, e.fault)
}

pub(super) fn read(bytes: &[u8], sink: &mut Sink, report: &mut Report) -> Result<(), CloudError> {
    let (coding, elements, body) = header(bytes).map_err(as_cloud)?;
    let mut input = Input::new(bytes, body, coding);
    let mut left_out = Vec::new();
    for element in elements.iter().filter(|e| !e.properties.is_empty()) {
        // Nothing after the points is of interest, nor worth an error.
        if !sink.cloud.points.is_empty() || sink.dropped > 0 {
            left_out.push(format!("{} {}", element.count, element.name));
            continue;
        }
        check_count(&input, element).map_err(as_cloud)?;
        if element.name == "vertex" {
            vertices(&mut input, element, sink)?;
        } else {
            left_out.push(format!("{} {}", element.count, element.name));
            let mut row = Row::default();
            (0..element.count).try_for_each(|i| input.row(element, i, &mut row)).map_err(as_cloud)?;
        }
    }
    left_out.retain(|l| !l.starts_with("0 "));
    if left_out.is_empty() && input.rest() > 0 {
        let (rest, rows) = (input.rest(), sink.cloud.points.len() as u64 + sink.dropped);
        report.warn(
            "ply-rest",
            format!("{rest} bytes after the {rows} points that the header announces were not read: is its count right?"),
        );
    }
    if !left_out.is_empty() {
        report.warn("ply-left-out", format!("left out: {}", left_out.join(", ")));
    }
    Ok(())
}

fn vertices(input: &mut Input<'_>, element: &Element, sink: &mut Sink) -> Result<(), CloudError> {
    let find = |names: &[&str]| element.properties.iter().position(|p| names.contains(&p.name.as_str()));
    let all = |columns: [&[&str]; 3]| Some([find(columns[0])?, find(columns[1])?, find(columns[2])?]);
    let Some(position) = all([&["x", "X"], &["y", "Y"], &["z", "Z"]]) else {
        let fault = FileFault::malformed("it has no x, y and z", "export the scan again");
        return Err(CloudError::new(CloudFormat::Ply, Place::Item("element `vertex`".into()), fault));
    };
    let color =
        all([&["red", "diffuse_red", "r"], &["green", "diffuse_green", "g"], &["blue", "diffuse_blue", "b"]])
            .filter(|c| c.iter().all(|&k| element.properties[k].scalar.size() == 1));
    let mut row = Row::default();
    for i in 0..element.count {
        input.row(element, i, &mut row).map_err(as_cloud)?;
        let v = &row.values;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a byte; saturation is wanted"
        )]
        let color = color.map(|c| c.map(|k| v[k] as u8));
        if !sink.push(position.map(|k| v[k]), color) {
            return Err(too_many(CloudFormat::Ply));
        }
    }
    Ok(())
}
