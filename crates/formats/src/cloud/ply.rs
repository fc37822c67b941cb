//! Points of PLY files. The header and its checks are those of the model reader.

use base::Report;

use super::columns::{Columns, said};
use super::sink::{Coding, Sink};
use super::{CloudFormat, too_many};
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
        if sink.seen() > 0 {
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
        let (rest, rows) = (input.rest(), sink.seen());
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
    let names = || element.properties.iter().map(|p| p.name.as_str());
    let Some(columns) = Columns::named(names()) else {
        let fault = FileFault::malformed("it has no x, y and z", "export the scan again");
        return Err(CloudError::new(CloudFormat::Ply, Place::Item("element `vertex`".into()), fault));
    };
    sink.columns = names().map(String::from).collect();
    let scalar = |k: usize| element.properties[k].scalar;
    let has_bytes = columns.color.is_some_and(|c| c.iter().all(|&k| scalar(k).size() == 1));
    sink.has_whole_colors = columns.color.is_some_and(|c| !c.iter().any(|&k| scalar(k).is_float()));
    let mut row = Row::default();
    for i in 0..element.count {
        input.row(element, i, &mut row).map_err(as_cloud)?;
        let v = &row.values;
        let place = columns.place.map(|k| v[k]);
        let said = columns.class.and_then(|c| said(c, v[c.at], sink));
        let color = columns.color.map(|c| c.map(|k| v[k]));
        let taken = match color {
            Some(color) if !has_bytes => sink.push_raw(place, color, said),
            color => sink.push(place, color.map(|c| Coding::Byte.bytes(c)), said),
        };
        if !taken {
            return Err(too_many(CloudFormat::Ply));
        }
    }
    Ok(())
}
