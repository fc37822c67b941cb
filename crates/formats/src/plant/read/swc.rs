//! SWC -> joints.

use std::collections::BTreeMap;

use glam::DVec3;
use plant::AxisKind;

use super::joints::{Built, Joint, Link, build};
use super::{Fault, Inward, LIMITS, StructureSpec, fault_at, place_of, said_in};
use crate::error::FileFault;
use crate::plant::swc::{FIRST_OWN, TIPS, TYPES};

/// A row of the file.
struct Row {
    id: i64,
    kind: i64,
    at: DVec3,
    radius: Option<f64>,
    parent: i64,
    line: usize,
}

/// Reads the rows of an SWC.
pub(super) fn read(text: &str, spec: &StructureSpec) -> Result<Built, Fault> {
    let mut rows: Vec<Row> = Vec::new();
    let mut said = (None, None);
    // Facts that only the comments of our own files give.
    let (mut is_own, mut tips) = (false, Vec::new());
    for (k, line) in text.lines().enumerate() {
        let line = line.trim();
        if let Some(comment) = line.strip_prefix('#') {
            let comment = comment.trim();
            let (unit, up) = said_in(comment);
            said = (said.0.or(unit), said.1.or(up));
            is_own |= comment == TYPES;
            if let Some(list) = comment.strip_prefix(TIPS) {
                tips.extend(list.split_whitespace().filter_map(|id| id.parse::<i64>().ok()));
            }
        } else if !line.is_empty() {
            rows.push(row(line, k + 1)?);
            if rows.len() > LIMITS.joints {
                let (what, advice) = ("the number of rows", "split the file, or thin its points out");
                return Err((k + 1, FileFault::TooMuch { what, limit: LIMITS.joints as u64, advice }));
            }
        }
    }
    tips.sort_unstable();
    let mut places: BTreeMap<i64, usize> = BTreeMap::new();
    for (k, row) in rows.iter().enumerate() {
        if places.insert(row.id, k).is_some() {
            let what = format!("the number {} is there twice", row.id);
            return Err(fault_at(row.line, what, "each row has a number of its own"));
        }
    }
    let inward = Inward::new(spec, said);
    let mut joints = Vec::with_capacity(rows.len());
    for (k, row) in rows.iter().enumerate() {
        let parent = match row.parent {
            none if none < 0 => None,
            id => Some(*places.get(&id).ok_or_else(|| {
                let advice = "give the number of a row, or -1 for what stands on the ground";
                fault_at(row.line, format!("the row {id}, on which it hangs, is not in the file"), advice)
            })?),
        };
        let goes_on = parent.is_some_and(|p| p + 1 == k && rows[p].kind == row.kind);
        let link = match (is_own, goes_on && tips.binary_search(&row.id).is_err()) {
            (false, _) => Link::Unsaid,
            (true, true) => Link::Follows,
            (true, false) => Link::Branches,
        };
        let kind = if is_own { kind_of(row.kind) } else { AxisKind::Branch };
        let radius = inward.radius(row.radius);
        joints.push(Joint { radius, kind, ..Joint::new(inward.place(row.at), parent, link, row.line) });
    }
    let mut built = build(&joints)?;
    built.tally.unit_said = said.0.is_some();
    Ok(built)
}

fn row(line: &str, number: usize) -> Result<Row, Fault> {
    let cells: Vec<&str> = line.split([' ', '\t', ',']).filter(|c| !c.is_empty()).collect();
    let [id, kind, x, y, z, radius, parent, ..] = cells[..] else {
        let what = format!("the row has {} numbers", cells.len());
        return Err(fault_at(number, what, "a row of an SWC is: id type x y z radius parent"));
    };
    let whole = |text: &str| {
        let parsed = text.parse::<f64>().ok().filter(|x| x.abs() < 9e15 && x.fract() == 0.0);
        #[expect(clippy::cast_possible_truncation, reason = "whole and small enough")]
        parsed.map(|x| x as i64).ok_or_else(|| {
            fault_at(
                number,
                format!("`{text}` is no whole number"),
                "a row of an SWC is: id type x y z radius parent",
            )
        })
    };
    let number_of = |text: &str| text.parse::<f64>().ok();
    let at = place_of([x, y, z].map(number_of)).ok_or_else(|| {
        fault_at(
            number,
            format!("`{x} {y} {z}` is no place"),
            "a row of an SWC is: id type x y z radius parent",
        )
    })?;
    let radius = number_of(radius);
    Ok(Row { id: whole(id)?, kind: whole(kind)?, at, radius, parent: whole(parent)?, line: number })
}

fn kind_of(word: i64) -> AxisKind {
    match word - i64::from(FIRST_OWN) {
        1 => AxisKind::Twig,
        2 => AxisKind::Stem,
        3 => AxisKind::Petiole,
        4 => AxisKind::Root,
        5 => AxisKind::Stub,
        _ => AxisKind::Branch,
    }
}
