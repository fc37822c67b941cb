//! COPC: read as LAZ, and level by level where it is too large.

use super::super::copc::Copc;
use super::super::las_parts::{Bytes, Rows, records};
use super::super::sink::Sink;
use super::*;

/// Bytes of the record that says where an octree is.
const INFO: usize = 54 + 160;

/// Level, place, size and points of a cell, or of a page (-1 points).
type Cell = (i32, u64, i32, i32);

fn entries(cells: &[Cell]) -> Vec<u8> {
    let entry = |&(level, at, size, points): &Cell| {
        let mut raw: Vec<u8> = [level, 0, 0, 0].iter().flat_map(|x| x.to_le_bytes()).collect();
        raw.extend(at.to_le_bytes());
        raw.extend([size, points].iter().flat_map(|x| x.to_le_bytes()));
        raw
    };
    cells.iter().flat_map(entry).collect()
}

/// A file of 3000 points of format 6 as LAS and as COPC: chunks of 700 are cells of an octree of three levels, the finest of which
/// is on a page of its own.
fn octree() -> (Vec<u8>, Vec<u8>) {
    let places: Vec<[i32; 3]> = (0..3000).map(|i| [7 * i, i * i % 977, -3 * i]).collect();
    let (plain, mut file, start) = packed(6, &places, true);
    let mut info = vec![0; 54];
    info[2..6].copy_from_slice(b"copc");
    (info[18], info[20]) = (1, 160);
    info.extend([0; 160]);
    file.splice(227..227, info);
    let start = start + INFO;
    file[96..100].copy_from_slice(&u32::try_from(start).unwrap().to_le_bytes());
    file[100] = 2;
    let table = u64::from_le_bytes(file[start..start + 8].try_into().unwrap()) + INFO as u64;
    file[start..start + 8].copy_from_slice(&table.to_le_bytes());
    let (mut cells, mut at): (Vec<Cell>, usize) = (vec![], start + 8);
    for (level, points) in [(0, 700), (1, 700), (1, 700), (2, 700), (2, 200)] {
        // A record, the number of its points, the sizes of nine layers, the layers.
        let layer = |k: usize| u32::from_le_bytes(file[at + 34 + 4 * k..at + 38 + 4 * k].try_into().unwrap());
        let size = (0..9).map(layer).sum::<u32>() as usize + 34 + 36;
        cells.push((level, at as u64, i32::try_from(size).unwrap(), points));
        at += size;
    }
    let second = entries(&cells[3..]);
    let page = (2, file.len() as u64, i32::try_from(second.len()).unwrap(), -1);
    file.extend(&second);
    let first = entries(&[&cells[..3], &[page]].concat());
    let from = 227 + 54;
    let first_at = file.len() as u64;
    file[from + 40..from + 48].copy_from_slice(&first_at.to_le_bytes());
    file[from + 48..from + 56].copy_from_slice(&(first.len() as u64).to_le_bytes());
    file.extend(&first);
    (plain, file)
}

/// Reads levels of the octree of at most so many points.
fn levels(file: &[u8], most: usize) -> Result<(Vec<[f64; 3]>, String), String> {
    let all = records(Bytes(file), 2, 227).map_err(|e| e.to_string())?;
    let copc = Copc::find(file, &all, 30).ok_or("no octree")?;
    let rows = Rows { scale: [0.25; 3], offset: [1.0; 3], colours: None, is_long: true };
    let (mut sink, mut report) = (Sink::default(), Report::default());
    copc.read(&rows, most, &mut sink, &mut report).map_err(|e| e.to_string())?;
    let told = report.warnings.iter().map(ToString::to_string).collect();
    Ok((sink.cloud.points.into_iter().map(DVec3::into).collect(), told))
}

#[test]
fn an_octree_is_read_whole_and_its_coarse_levels_where_it_is_too_large() {
    let (plain, file) = octree();
    let want = points(&plain, CloudFormat::Las);
    assert_eq!(points(&file, CloudFormat::Las), want, "as any compressed file");
    assert_eq!(levels(&file, 3000).unwrap(), (want.clone(), String::new()));
    let (coarse, told) = levels(&file, 2999).unwrap();
    assert_eq!(coarse, want[..2100]);
    assert!(told.contains("of 3 levels of its octree (COPC) 2 were read, 2100 of 3000 points"), "{told}");
    assert_eq!(levels(&file, 700).unwrap().0, want[..700]);
    assert!(levels(&file, 699).unwrap_err().contains("limit"), "not even the coarsest");
}

#[test]
fn broken_octrees_are_refused() {
    let (_, file) = octree();
    let first = file.len() - 4 * 32;
    let put = |at: usize, word: u32| {
        let mut bad = file.clone();
        bad[at..at + 4].copy_from_slice(&word.to_le_bytes());
        levels(&bad, 3000).unwrap_err()
    };
    assert!(put(first, 99).contains("level 99"));
    assert!(put(first + 16, 0xffff_fff0).contains("beyond the end"));
    assert!(put(first + 24, 0xffff_fff0).contains("no size"));
    assert!(put(first + 24, 40).contains("does not hold what it announces"));
    assert!(put(first + 28, 0x7fff_0000).contains("limit"), "more points than are read");
    // A page that names itself, and one that is not there.
    let own = u32::try_from(first).unwrap();
    assert!(put(first + 3 * 32 + 16, own).contains("a cell twice"));
    let mut endless = file.clone();
    endless[first + 3 * 32 + 16..first + 3 * 32 + 20].copy_from_slice(&own.to_le_bytes());
    endless[first + 3 * 32 + 24] = 128;
    assert!(levels(&endless, 3000).unwrap_err().contains("no end"));
    assert!(put(227 + 54 + 40, 0x7fff_ffff).contains("beyond the end"));
    for k in (0..file.len()).step_by(41).chain(first..file.len()) {
        let mut bad = file.clone();
        bad[k] ^= 0x5a;
        let _ = levels(&bad, 3000);
    }
}
