use super::*;
use base::{Unit, UpAxis};
use glam::DVec3;
use proptest::prelude::*;

#[cfg(feature = "laz")]
mod copc;
#[cfg(feature = "e57")]
mod e57;
mod las;
mod names;

fn read(bytes: &[u8], format: CloudFormat) -> Result<PointCloud, String> {
    let mut report = Report::default();
    read_cloud(bytes, format, &ExportSpec::default(), &mut report).map_err(|e| e.to_string())
}

fn points(bytes: &[u8], format: CloudFormat) -> Vec<[f64; 3]> {
    read(bytes, format).unwrap().points.into_iter().map(DVec3::into).collect()
}

const TWO: [[f64; 3]; 2] = [[1.0, 2.0, 3.0], [-0.5, 0.25, 1e3]];

#[expect(clippy::cast_possible_truncation, reason = "small numbers")]
fn narrow(x: f64) -> f32 {
    x as f32
}

fn las(minor: u8, scale: f64, offset: f64, count: u32, rows: &[[i32; 3]]) -> Vec<u8> {
    let mut b = vec![0_u8; 227];
    b[..4].copy_from_slice(b"LASF");
    b[24] = 1;
    b[25] = minor;
    b[94..96].copy_from_slice(&227_u16.to_le_bytes());
    b[96..100].copy_from_slice(&227_u32.to_le_bytes());
    b[105..107].copy_from_slice(&20_u16.to_le_bytes());
    b[107..111].copy_from_slice(&count.to_le_bytes());
    for k in 0..3 {
        b[131 + 8 * k..139 + 8 * k].copy_from_slice(&scale.to_le_bytes());
        b[155 + 8 * k..163 + 8 * k].copy_from_slice(&offset.to_le_bytes());
    }
    for row in rows {
        row.iter().for_each(|x| b.extend_from_slice(&x.to_le_bytes()));
        b.extend_from_slice(&[0; 8]);
    }
    b
}

#[test]
fn decimal_commas_are_read_where_something_else_separates() {
    use CloudFormat::Xyz;
    let want = [[1.5, 2.3, 4.4], [-0.25, 1e3, 3.0]];
    for text in [
        "1,5 2,3 4,4\n-0,25 1000 3\n",
        "x;y;z\n1,5;2,3;4,4\n-0,25;1e3;3\n",
        "1,5\t2,3\t4,4\n-0,25\t1000,0\t3,0\n",
        "1,5; 2,3; 4,4\r\n-0,25; 1,0e3; 3\r\n",
        "1.5, 2.3, 4.4\n-0.25, 1000, 3\n",
        "1.5 , 2.3,4.4,big tree\n-0.25,1000,3,old tree\n",
        "2\n1.5;2.3;4.4\n-0.25;1000;3\n",
    ] {
        assert_eq!(points(text.as_bytes(), Xyz), want, "{text:?}");
    }
    let colored = read(b"1,5 2 3 255 0 9\n2,5 2 3 255 0 9\n", Xyz).unwrap();
    assert_eq!((colored.points[0].x, colored.colors[0]), (1.5, [255, 0, 9]));
    for text in [
        "1,2 3,4\n",
        "1,2 3\n",
        "1,2,3 4,5,6\n",
        "1.5,2.5;3\n",
        "432,100.25 5,612,300.10 312.0\n",
        "1 2 3\n1,5,2 3\n",
        "1,5 2 3\n1,2,3\n",
        "1,2,3\n1,5 2 3\n",
    ] {
        let error = read(text.as_bytes(), Xyz).unwrap_err();
        assert!(error.contains("decimal commas") && error.contains("line"), "{text:?}: {error}");
    }
    let mut report = Report::default();
    let whole = b"1,5,2,3,4,4\n2,5,2,3,4,4\n";
    read_cloud(&whole[..], Xyz, &ExportSpec::default(), &mut report).unwrap();
    assert!(report.warnings.iter().any(|w| w.to_string().contains("decimal commas")), "{report:?}");
}

#[test]
fn first_bytes_tell_the_format() {
    use CloudFormat::{Las, Obj, Pcd, Ply, Xyz};
    for (start, want) in [
        (&b"1 2 3\n"[..], Some(Xyz)),
        (b"# c\n//h\nx;y;z\n1,5;2,3;4,4\n", Some(Xyz)),
        (b"2\n1,2,3\n", Some(Xyz)),
        (b"# .PCD v0.7\nVERSION 0.7\n", Some(Pcd)),
        (b"# made\no leaf\nv 1 2 3\n", Some(Obj)),
        (b"ply\nformat ascii 1.0\n", Some(Ply)),
        (b"LASF\0\0", Some(Las)),
        (b"glTF\x02\0\0\0", None),
        (b"<svg>1 2 3</svg>", None),
        (b"1 2 3\n\0", None),
        (b"1 2\n3 4\n", None),
        (b"", None),
    ] {
        assert_eq!(CloudFormat::sniff(start), want, "{:?}", String::from_utf8_lossy(start));
    }
    let signed = b"# burgeon 1\n# metres\n\nmtllib a.mtl\nv 0 0 0\n";
    assert_eq!(crate::ModelFormat::sniff(signed), Some(crate::ModelFormat::Obj));
}

#[test]
fn points_beyond_single_precision_are_left_out() {
    let text = b"1 2 3\n0 1e90 0\n-1e39 0 0\n1e14 0 0\n";
    assert_eq!(points(text, CloudFormat::Xyz), [[1.0, 2.0, 3.0], [1e14, 0.0, 0.0]]);
}

#[test]
fn every_format_gives_the_same_two_points() {
    use CloudFormat::{Las, Obj, Pcd, Ply, Xyz};
    assert_eq!(points(b"1 2 3\n-0.5 0.25 1e3\n", Xyz), TWO);
    assert_eq!(points(b"# c\nx,y,z,i\n1,2,3,9\r\n-0.5,0.25,1000,8\r\n", Xyz), TWO);
    assert_eq!(points(b"2\n1;2;3\n-0.5;0.25;1000", Xyz), TWO);
    assert_eq!(points(b"o a\nv 1 2 3\nvn 0 0 1\nv -0.5 0.25 1000\nf 1 2 1\n", Obj), TWO);
    let ply =
        b"ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n\
        element face 1\nproperty list uchar int vertex_indices\nend_header\n1 2 3\n-0.5 0.25 1000\n3 0 1 0\n";
    assert_eq!(points(ply, Ply), TWO);
    let head = "VERSION .7\nFIELDS i x y z\nSIZE 2 4 4 8\nTYPE U F F F\nCOUNT 1 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA ";
    assert_eq!(points(format!("{head}ascii\n7 1 2 3\n8 -0.5 0.25 1000\n").as_bytes(), Pcd), TWO);
    let mut pcd = format!("{head}binary\n").into_bytes();
    for p in TWO {
        pcd.extend_from_slice(&7_u16.to_le_bytes());
        pcd.extend_from_slice(&narrow(p[0]).to_le_bytes());
        pcd.extend_from_slice(&narrow(p[1]).to_le_bytes());
        pcd.extend_from_slice(&p[2].to_le_bytes());
    }
    assert_eq!(points(&pcd, Pcd), TWO);
    let mut plain = Vec::new();
    TWO.iter().for_each(|_| plain.extend_from_slice(&7_u16.to_le_bytes()));
    TWO.iter().for_each(|p| plain.extend_from_slice(&narrow(p[0]).to_le_bytes()));
    TWO.iter().for_each(|p| plain.extend_from_slice(&narrow(p[1]).to_le_bytes()));
    TWO.iter().for_each(|p| plain.extend_from_slice(&p[2].to_le_bytes()));
    // One literal of 2 bytes, a copy of them (length 2 + 0 is 3 at least in LZF, so literals only here).
    let mut packed = Vec::new();
    plain.chunks(32).for_each(|c| {
        packed.push(u8::try_from(c.len() - 1).unwrap());
        packed.extend_from_slice(c);
    });
    let mut pcd = format!("{head}binary_compressed\n").into_bytes();
    pcd.extend_from_slice(&u32::try_from(packed.len()).unwrap().to_le_bytes());
    pcd.extend_from_slice(&u32::try_from(plain.len()).unwrap().to_le_bytes());
    pcd.extend_from_slice(&packed);
    assert_eq!(points(&pcd, Pcd), TWO);
    assert_eq!(points(&las(2, 0.25, 1.0, 2, &[[0, 4, 8], [-6, -3, 3996]]), Las), TWO);
}

/// Returns points of format 0 or 6 as another program, laz-rs, compresses them; and where their compressed bytes
/// begin.
#[cfg(feature = "laz")]
fn packed(format: u8, places: &[[i32; 3]], variable: bool) -> (Vec<u8>, Vec<u8>, usize) {
    use std::io::Cursor;

    let mut plain = las(2, 0.25, 1.0, u32::try_from(places.len()).unwrap(), places);
    if format == 6 {
        let (head, count) = (usize::from(plain[94]) + 256 * usize::from(plain[95]), places.len());
        plain.truncate(head);
        plain[104..107].copy_from_slice(&[6, 30, 0]);
        for p in places {
            plain.extend(p.iter().flat_map(|x| x.to_le_bytes()));
            plain.extend_from_slice(&[0; 18]);
        }
        assert_eq!(plain.len(), head + 30 * count);
    }
    let at = |k: usize| u32::from_le_bytes([plain[k], plain[k + 1], plain[k + 2], plain[k + 3]]) as usize;
    let (head, data_at) = (usize::from(plain[94]) + 256 * usize::from(plain[95]), at(96));
    let record = usize::from(plain[105]) + 256 * usize::from(plain[106]);
    let items = laz::LazItemRecordBuilder::default_for_point_format_id(plain[104], 0).unwrap();
    let mut vlr = laz::LazVlr::from_laz_items(items.clone());
    if variable {
        vlr = laz::LazVlrBuilder::new(items).with_variable_chunk_size().build();
    }
    assert_eq!(usize::try_from(vlr.items_size()).unwrap(), record);
    let mut said = Vec::new();
    vlr.write_to(&mut said).unwrap();
    let mut file = plain[..head].to_vec();
    let mut name = [0; 16];
    name[..14].copy_from_slice(b"laszip encoded");
    file.extend_from_slice(&[0, 0]);
    file.extend_from_slice(&name);
    file.extend_from_slice(&22204_u16.to_le_bytes());
    file.extend_from_slice(&u16::try_from(said.len()).unwrap().to_le_bytes());
    file.extend_from_slice(&[0; 32]);
    file.extend_from_slice(&said);
    let start = u32::try_from(file.len()).unwrap();
    file[96..100].copy_from_slice(&start.to_le_bytes());
    file[100..104].copy_from_slice(&1_u32.to_le_bytes());
    file[104] |= 0x80;
    let mut cursor = Cursor::new(file);
    cursor.set_position(u64::from(start));
    let mut packer = laz::LasZipCompressor::new(&mut cursor, vlr).unwrap();
    for some in plain[data_at..].chunks(record * 700) {
        packer.compress_many(some).unwrap();
        if variable {
            packer.finish_current_chunk().unwrap();
        }
    }
    packer.done().unwrap();
    drop(packer);
    (plain, cursor.into_inner(), start as usize)
}

#[cfg(feature = "laz")]
#[test]
fn compressed_las_gives_the_same_points() {
    let places: Vec<[i32; 3]> = (0..3000).map(|i| [7 * i, i * i % 977, -3 * i]).collect();
    for (format, variable) in [(0, false), (0, true), (6, false), (6, true)] {
        let (plain, file, _) = packed(format, &places, variable);
        assert!(file.len() < plain.len() / 2, "{} {}", file.len(), plain.len());
        assert_eq!(points(&file, CloudFormat::Las), points(&plain, CloudFormat::Las), "{format} {variable}");
        // Cut off and broken: an error, never a panic.
        for cut in (0..file.len()).step_by(97) {
            let _ =
                read_cloud(&file[..cut], CloudFormat::Las, &ExportSpec::default(), &mut Report::default());
        }
        for k in (0..file.len()).step_by(53).chain(0..700.min(file.len())) {
            let mut bad = file.clone();
            bad[k] ^= 0x5a;
            let _ = read_cloud(&bad[..], CloudFormat::Las, &ExportSpec::default(), &mut Report::default());
        }
    }
}

/// The file has more points for each byte than any scan: all of them lie at one place.
#[cfg(feature = "laz")]
#[test]
fn points_of_one_place_are_read_and_claims_beyond_them_are_not() {
    let claim = |file: &[u8], count: u32| {
        let mut file = file.to_vec();
        file[107..111].copy_from_slice(&count.to_le_bytes());
        read_cloud(&file[..], CloudFormat::Las, &ExportSpec::default(), &mut Report::default())
            .map(|c| c.points.len())
            .map_err(|e| e.to_string())
    };
    for format in [0, 6] {
        let (_, file, start) = packed(format, &vec![[1, 2, 3]; 100_000], false);
        let there = file.len() - start;
        assert_eq!(claim(&file, 100_000), Ok(100_000), "{there} bytes");
        println!("format {format}: 100,000 points of one place in {there} bytes");
        let line = claim(&file, u32::try_from(2_000 * (there + 1)).unwrap()).unwrap_err();
        assert!(line.contains("points are announced in"), "{line}");
    }
}

#[cfg(feature = "laz")]
#[test]
fn chunks_layers_and_parts_that_are_not_there_are_refused_before_they_are_unpacked() {
    let places: Vec<[i32; 3]> = (0..3000).map(|i| [7 * i, i * i % 977, -3 * i]).collect();
    let fails = |file: &[u8], part: &str| {
        let read = read_cloud(file, CloudFormat::Las, &ExportSpec::default(), &mut Report::default());
        let line = read.map(|c| c.points.len()).unwrap_err().to_string();
        assert!(line.contains(part), "{line}");
    };
    for variable in [false, true] {
        let (_, file, start) = packed(6, &places, variable);
        let put = |at: usize, word: u32| {
            let mut bad = file.clone();
            bad[at..at + 4].copy_from_slice(&word.to_le_bytes());
            bad
        };
        // Each of the nine layers of the first chunk in turn claims 4 GB.
        for layer in 0..9 {
            fails(&put(start + 8 + 30 + 4 + 4 * layer, 0xffff_fff0), "point 0 cannot be unpacked");
        }
        let table = usize::try_from(u64::from_le_bytes(file[start..start + 8].try_into().unwrap())).unwrap();
        fails(&put(table + 4, 0x1000_0000), "268435456 chunks are announced");
        if variable {
            fails(&put(107, 3001), "3001 points are announced, 3000 are in its chunks");
        }
    }
    // Parts of the record, which stands before the points: 34 bytes, then type, size and version of each.
    let (_, file, start) = packed(0, &places, false);
    let items = start - 6;
    for (at, byte) in [(items + 2, 21), (items, 99), (items + 4, 9), (items - 2, 0), (items - 34, 3)] {
        let mut bad = file.clone();
        bad[at] = byte;
        fails(&bad, "");
    }
}

#[test]
fn lzf_copies_repeat() {
    // "ab", then 6 bytes copied from 2 back: length code 4 (= 6 - 2).
    let header = "FIELDS x y z\nSIZE 1 1 1\nTYPE U U U\nCOUNT 1 1 1\nPOINTS 3\nDATA binary_compressed\n";
    let data = [1, b'a', b'b', 4 << 5, 1, 0, b'c'];
    let mut pcd = header.as_bytes().to_vec();
    pcd.extend_from_slice(&7_u32.to_le_bytes());
    pcd.extend_from_slice(&9_u32.to_le_bytes());
    pcd.extend_from_slice(&data);
    let got = points(&pcd, CloudFormat::Pcd);
    assert_eq!(got, [[97.0, 98.0, 97.0], [98.0, 97.0, 98.0], [97.0, 98.0, 99.0]]);
}

#[test]
fn units_axes_and_colours() {
    let mut report = Report::default();
    let spec = ExportSpec { up: UpAxis::Z, unit: Unit::Millimetre };
    let c = read_cloud(&b"1000 2000 3000 255 0 7\n0 0 0 1 2 3\n"[..], CloudFormat::Xyz, &spec, &mut report)
        .unwrap();
    assert!((c.points[0] - DVec3::new(1.0, 3.0, -2.0)).length() < 1e-12, "{:?}", c.points);
    assert_eq!(c.colors, [[255, 0, 7], [1, 2, 3]]);
    let mut ply = Vec::new();
    write_cloud_ply(&c, &spec, &mut ply).unwrap();
    let back = read_cloud(&ply[..], CloudFormat::Ply, &spec, &mut report).unwrap();
    assert!(back.points.iter().zip(&c.points).all(|(a, b)| (*a - *b).length() < 1e-12));
    assert_eq!(back.colors, c.colors);
}

#[test]
fn hostile_and_broken_files_are_refused_with_place_and_advice() {
    use CloudFormat::{Las, Obj, Pcd, Ply, Xyz};
    let pcd = |points: &str, data: &str| {
        format!("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nPOINTS {points}\nDATA {data}\n")
            .into_bytes()
    };
    let huge = "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\n\
        property float z\nend_header\n";
    let mut zip_bomb = pcd("33000000", "binary_compressed");
    zip_bomb.extend_from_slice(&4_u32.to_le_bytes());
    zip_bomb.extend_from_slice(&396_000_000_u32.to_le_bytes());
    zip_bomb.extend_from_slice(&[0; 4]);
    let mut laz = las(2, 0.1, 0.0, 0, &[]);
    laz[104] = 0x80;
    let cases: Vec<(Vec<u8>, CloudFormat, &str)> = vec![
        (b" \n\n".to_vec(), Xyz, "empty"),
        (b"1 2\n".to_vec(), Xyz, "line 1"),
        (b"1 2 3\n1 2 x\n".to_vec(), Xyz, "line 2"),
        (b"1 2 3\n1 2 3 4\n".to_vec(), Xyz, "4 columns"),
        (b"\0\x01\x02\x03".to_vec(), Xyz, "not text"),
        (b"nan nan nan\n".to_vec(), Xyz, "finite"),
        (b"v 1 2\n".to_vec(), Obj, "line 1"),
        (b"f 1 2 3\n".to_vec(), Obj, "no point"),
        (huge.as_bytes().to_vec(), Ply, "4000000000 rows are announced"),
        (b"ply\n".to_vec(), Ply, "header"),
        (pcd("4000000000", "binary"), Pcd, "limit"),
        (pcd("9", "binary"), Pcd, "9 are announced"),
        (pcd("9", "ascii"), Pcd, "9 are announced"),
        (pcd("-1", "ascii"), Pcd, "POINTS is broken"),
        (zip_bomb, Pcd, "cannot unpack"),
        (b"FIELDS a b\nSIZE 4 4\nTYPE F F\nPOINTS 1\nDATA ascii\n1 2\n".to_vec(), Pcd, "no x, y and z"),
        (las(2, 0.0, 0.0, 1, &[[0; 3]]), Las, "scale"),
        (las(2, 0.1, 1e300, 1, &[[0; 3]]), Las, "absurd"),
        (las(2, 0.1, f64::NAN, 1, &[[0; 3]]), Las, "absurd"),
        (las(2, 0.1, 0.0, 4_000_000_000, &[[0; 3]]), Las, "announced"),
        (laz, Las, "LAZ"),
        (b"LASF".to_vec(), Las, "header"),
    ];
    for (bytes, format, want) in cases {
        let e = read(&bytes, format).unwrap_err();
        assert!(e.contains(want), "{format:?}: {e:?} should say {want:?}");
    }
}

#[test]
fn points_that_are_no_numbers_are_left_out_and_told() {
    let mut report = Report::default();
    let c = read_cloud(
        &b"1 2 3\nnan 0 0\n1 inf 0\n4 5 6\n"[..],
        CloudFormat::Xyz,
        &ExportSpec::default(),
        &mut report,
    );
    assert_eq!(c.unwrap().points.len(), 2);
    assert!(report.warnings.iter().any(|w| w.message.contains("2 points")), "{report:?}");
}

proptest! {
    #[test]
    fn any_bytes_are_points_or_an_error(
        bytes in prop::collection::vec(any::<u8>(), 0..300),
        lines in prop::collection::vec("[-0-9a-z .,;e]{0,20}", 0..12),
        which in 0..CloudFormat::ALL.len(),
        cut in 0..400_usize,
    ) {
        let format = CloudFormat::ALL[which];
        let head: &[u8] = match format {
            CloudFormat::Ply => b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nend_header\n",
            CloudFormat::Pcd => b"FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 2\nDATA binary\n",
            _ => b"",
        };
        let mut all = if format == CloudFormat::Las { las(4, 0.1, 0.0, 2, &[[1; 3]; 2]) } else { head.to_vec() };
        for (k, b) in bytes.iter().enumerate() {
            let n = all.len();
            if n > 0 && k % 3 == 0 {
                all[(k * 37 + usize::from(*b)) % n] = *b;
            } else {
                all.push(*b);
            }
        }
        all.truncate(cut.max(1) * 2);
        for input in [all, lines.join("\n").into_bytes()] {
            if let Ok(cloud) = read(&input, format) {
                prop_assert!(cloud.is_sound() && !cloud.points.is_empty());
            }
        }
    }
}

#[test]
fn colours_after_normals_are_read_and_what_is_no_normal_or_colour_is_not() {
    use CloudFormat::Xyz;
    for (row, want, left_out) in [
        ("1 2 3 0 0.6 0.8 0.176471 0.247059 1.0 1", Some([45, 63, 255]), "4 to 6 and 10"),
        ("1 2 3 0 0.6 0.8 0.176471 0.247059 1.0 0.498039", Some([117, 136, 255]), "4 to 6 and 10"),
        ("1,2,3,0,0.6,0.8,255,0,9", Some([255, 0, 9]), "4 to 6"),
        ("1 2 3 0 0.6 0.8 7 8 9 1 2 3", Some([7, 8, 9]), "4 to 6 and 10 to 12"),
        // No unit vector, no share of 255, out of range, not a number, columns missing.
        ("1 2 3 0 0.6 0.9 255 0 9", None, "4 to 9"),
        ("1 2 3 0 0.6 0.8 0.1 0.2 0.3", None, "4 to 9"),
        ("1 2 3 0 0.6 0.8 256 0 9", None, "4 to 9"),
        ("1 2 3 0 0.6 0.8 nan 0 9", None, "4 to 9"),
        ("1 2 3 0 0.6 0.8", None, "4 to 6"),
        ("1 2 3 0 0.6 0.8 1 1", None, "4 to 8"),
    ] {
        let mut report = Report::default();
        let cloud = read_cloud(row.as_bytes(), Xyz, &ExportSpec::default(), &mut report).unwrap();
        assert_eq!(cloud.colors.first().copied(), want, "{row}");
        assert!(
            report.warnings[0].to_string().contains(&format!("columns {left_out} were")),
            "{row}: {report:?}"
        );
    }
    // Later rows beyond the range have its ends.
    let later = read(b"1 2 3 0 0 1 1 0 0.2\n1 2 3 0 0 0 7 -1 nan\n", Xyz).unwrap();
    assert_eq!(later.colors, [[255, 0, 51], [255, 0, 0]]);
}
