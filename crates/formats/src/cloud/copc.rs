//! Cloud Optimized Point Clouds: LAZ whose chunks are the cells of an octree, coarse ones first.
//!
//! Such a file is read as any LAZ is. Only where it has more points than are read do its cells count: then the finest levels
//! are left out, and what is left is an even thinning of the whole.

use std::io::Cursor;

use base::Report;
use laz::LazVlr;
use laz::record::{LayeredPointRecordDecompressor, RecordDecompressor};

use super::las_parts::{Bytes, Record, Rows, packing};
use super::laz_limits::{Packed, why_packed};
use super::sink::Sink;
use super::{CloudFormat, broken_las as fail, too_many};
use crate::error::CloudError;

/// Bytes of the record that says where the octree is, and of an entry of it.
const INFO: usize = 160;
const ENTRY: usize = 32;
/// Most levels of an octree, and most entries that are looked at.
const MAX_LEVEL: i32 = 31;
const MAX_ENTRIES: usize = 4 << 20;

/// A cell of the octree that holds points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Cell {
    level: i32,
    at: usize,
    size: usize,
    points: usize,
}

/// A file with an octree.
pub(super) struct Copc<'a> {
    bytes: &'a [u8],
    how: &'a [u8],
    /// Bytes of a point.
    record: usize,
    /// Where the octree's first page is, and its bytes.
    root: (u64, u64),
}

impl<'a> Copc<'a> {
    /// The octree of a file that has one.
    pub(super) fn find(bytes: &'a [u8], records: &[Record<'a>], record: usize) -> Option<Self> {
        let info = records.iter().find(|r| r.is("copc", 1) && r.data.len() >= INFO)?;
        let long = |at: usize| Bytes(info.data).get(at).map(u64::from_le_bytes).ok();
        let how = packing(records, 0).ok()?;
        Some(Self { bytes, how, record, root: (long(40)?, long(48)?) })
    }

    /// All cells with points, coarse ones first.
    fn cells(&self) -> Result<Vec<Cell>, CloudError> {
        let broken = |what: &str| fail(0, format!("its octree (COPC) {what}"));
        let range = |(at, size): (u64, u64)| {
            let at = usize::try_from(at).ok()?;
            let end = at.checked_add(usize::try_from(size).ok()?)?;
            (end <= self.bytes.len()).then_some(at..end)
        };
        let (mut cells, mut pages, mut seen) = (Vec::new(), vec![self.root], 0);
        while let Some(page) = pages.pop() {
            let page = range(page).ok_or_else(|| broken("lies beyond the end of the file"))?;
            for entry in self.bytes[page].chunks_exact(ENTRY) {
                seen += 1;
                // A page may name itself.
                if seen > MAX_ENTRIES.min(self.bytes.len() / ENTRY) {
                    return Err(broken("has no end"));
                }
                let entry = Bytes(entry);
                let whole = |at: usize| entry.get(at).map(i32::from_le_bytes);
                let (level, size, points) = (whole(0)?, whole(24)?, whole(28)?);
                let at = u64::from_le_bytes(entry.get(16)?);
                if !(0..=MAX_LEVEL).contains(&level) {
                    return Err(broken(&format!("has a level {level}")));
                }
                let size = u64::try_from(size).map_err(|_negative| broken("has a cell of no size"))?;
                match usize::try_from(points) {
                    Err(_negative) => pages.push((at, size)),
                    Ok(0) => {}
                    Ok(points) => {
                        let place =
                            range((at, size)).ok_or_else(|| broken("lies beyond the end of the file"))?;
                        cells.push(Cell { level, at: place.start, size: place.len(), points });
                    }
                }
            }
        }
        cells.sort_unstable_by_key(|c| (c.level, c.at));
        if cells.windows(2).any(|two| two[0].at == two[1].at) {
            return Err(broken("has a cell twice"));
        }
        Ok(cells)
    }

    /// Reads as many levels as hold no more than `most` points.
    pub(super) fn read(
        &self,
        rows: &Rows,
        most: usize,
        sink: &mut Sink,
        report: &mut Report,
    ) -> Result<(), CloudError> {
        let cells = self.cells()?;
        let vlr = LazVlr::read_from(self.how).map_err(|e| fail(0, why_packed(&e)))?;
        let levels = cells.last().map_or(0, |c| c.level) + 1;
        let points_to = |level: i32| -> usize {
            let within = cells.iter().filter(|c| c.level <= level);
            within.fold(0, |sum, c| sum.saturating_add(c.points))
        };
        let finest = (0..levels).rev().find(|&level| points_to(level) <= most);
        let finest = finest.ok_or_else(|| too_many(CloudFormat::Las))?;
        let mut row = vec![0; self.record];
        for cell in cells.iter().filter(|c| c.level <= finest) {
            self.unpack(cell, &vlr, &mut row, |row| rows.take(row, sink))?;
        }
        if finest + 1 < levels {
            report.warn(
                "scan-levels",
                format!(
                    "of {levels} levels of its octree (COPC) {} were read, {} of {} points: more than {most} are not; to have \
                     all of a part, cut it out first",
                    finest + 1,
                    points_to(finest),
                    points_to(levels)
                ),
            );
        }
        Ok(())
    }

    fn unpack(
        &self,
        cell: &Cell,
        vlr: &LazVlr,
        row: &mut [u8],
        mut take: impl FnMut(&[u8]) -> Result<(), CloudError>,
    ) -> Result<(), CloudError> {
        let end = cell.at + cell.size;
        let broken = |what: String| fail(cell.at, what);
        let (bytes, record, how) = (&self.bytes[..end], self.record, self.how);
        Packed { bytes, data_at: cell.at, record, count: cell.points, how }.check_cell(vlr, cell.points)?;
        let mut unpacker = LayeredPointRecordDecompressor::new(Cursor::new(&bytes[cell.at..]));
        unpacker.set_fields_from(vlr.items()).map_err(|e| broken(why_packed(&e).into()))?;
        for k in 0..cell.points {
            unpacker
                .decompress_next(row)
                .map_err(|e| broken(format!("point {k} of a cell: {}", why_packed(&e.into()))))?;
            take(row)?;
        }
        Ok(())
    }
}
