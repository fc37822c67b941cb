//! E57, written by another program's library.

use std::io::Cursor;

use super::*;
use ::e57::{E57Writer, Quaternion, Record, RecordDataType, RecordName, RecordValue, Transform, Translation};

const PLACE: [Record; 3] = [Record::CARTESIAN_X_F64, Record::CARTESIAN_Y_F64, Record::CARTESIAN_Z_F64];

/// One scan: its columns, its points, and where its scanner stood.
struct Scan {
    columns: Vec<Record>,
    rows: Vec<Vec<RecordValue>>,
    pose: Option<Transform>,
}

fn file(scans: Vec<Scan>) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let mut writer = E57Writer::new(&mut bytes, "file").unwrap();
    writer.set_coordinate_metadata(Some(r#"PROJCS["ETRS89 / UTM 32N",GEOGCS["x"],UNIT["metre",1]]"#.into()));
    for (k, scan) in scans.into_iter().enumerate() {
        let mut points = writer.add_pointcloud(&format!("scan {k}"), scan.columns).unwrap();
        points.set_transform(scan.pose);
        scan.rows.into_iter().for_each(|row| points.add_point(row).unwrap());
        points.finalize().unwrap();
    }
    writer.finalize().unwrap();
    drop(writer);
    bytes.into_inner()
}

fn doubles(row: [f64; 3]) -> Vec<RecordValue> {
    row.map(RecordValue::Double).to_vec()
}

fn read_with_facts(bytes: &[u8]) -> Result<(PointCloud, CloudFacts), String> {
    let mut report = Report::default();
    read_cloud_with_facts(bytes, CloudFormat::E57, &ExportSpec::default(), &mut report)
        .map_err(|e| e.to_string())
}

/// Seen from two places: the first scanner turned by a quarter about +Z and moved, with colours; the second in angles.
fn two_scans() -> Vec<u8> {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let pose = Transform {
        rotation: Quaternion { w: half, x: 0.0, y: 0.0, z: half },
        translation: Translation { x: 100.0, y: 200.0, z: 10.0 },
    };
    let invalid = Record {
        name: RecordName::CartesianInvalidState,
        data_type: RecordDataType::Integer { min: 0, max: 2 },
    };
    let colored =
        [&PLACE[..], &[Record::COLOR_RED_U8, Record::COLOR_GREEN_U8, Record::COLOR_BLUE_U8, invalid]]
            .concat();
    let row = |p: [f64; 3], rgb: [i64; 3], state: i64| {
        [doubles(p), rgb.map(RecordValue::Integer).to_vec(), vec![RecordValue::Integer(state)]].concat()
    };
    let first = Scan {
        columns: colored,
        rows: vec![
            row([1.0, 2.0, 3.0], [255, 0, 7], 0),
            row([9.0; 3], [1; 3], 2),
            row([0.0, 0.0, 1.0], [1, 2, 3], 0),
        ],
        pose: Some(pose),
    };
    let angles =
        vec![Record::SPHERICAL_RANGE_F64, Record::SPHERICAL_AZIMUTH_F64, Record::SPHERICAL_ELEVATION_F64];
    let rows = vec![doubles([2.0, 0.0, 0.0]), doubles([2.0, std::f64::consts::FRAC_PI_2, 0.0])];
    file(vec![first, Scan { columns: angles, rows, pose: None }])
}

#[test]
fn scans_of_a_file_stand_where_their_scanners_stood() {
    let bytes = two_scans();
    assert_eq!(CloudFormat::sniff(&bytes), Some(CloudFormat::E57));
    let (cloud, facts) = read_with_facts(&bytes).unwrap();
    let want = [[98.0, 201.0, 13.0], [100.0, 200.0, 11.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]];
    assert_eq!(cloud.points.len(), 4, "one was not measured");
    for (got, want) in cloud.points.iter().zip(want) {
        assert!(got.distance(DVec3::from_array(want)) < 1e-12, "{got} {want:?}");
    }
    assert_eq!(cloud.colors, [[255, 0, 7], [1, 2, 3], [128; 3], [128; 3]]);
    assert_eq!((facts.not_finite, facts.detail.as_str()), (1, "2 scans"));
    assert_eq!(facts.coordinate_system.as_deref(), Some("ETRS89 / UTM 32N"));
    assert_eq!(facts.unit.as_deref(), Some("metre"));
    assert!(facts.columns.iter().any(|c| c == "SphericalRange"), "{:?}", facts.columns);
}

#[test]
fn numbers_of_every_type_are_read() {
    let scaled = |name| Record {
        name,
        data_type: RecordDataType::ScaledInteger { min: -5000, max: 5000, scale: 0.001, offset: 1.0 },
    };
    let columns = vec![
        scaled(RecordName::CartesianX),
        Record { name: RecordName::CartesianY, data_type: RecordDataType::F32 },
        // All values are the same: no bit is written for it.
        Record { name: RecordName::CartesianZ, data_type: RecordDataType::Integer { min: 7, max: 7 } },
        Record::COLOR_RED_UNIT_F32,
        Record::COLOR_GREEN_UNIT_F32,
        Record::COLOR_BLUE_UNIT_F32,
    ];
    let row = |x: i64| {
        let color = [1.0, 0.0, 0.02745].map(RecordValue::Single);
        [&[RecordValue::ScaledInteger(x), RecordValue::Single(0.5), RecordValue::Integer(7)][..], &color]
            .concat()
    };
    let rows: Vec<Vec<RecordValue>> = (0..20_000).map(|k| row(k % 10_000 - 5000)).collect();
    let (cloud, _) = read_with_facts(&file(vec![Scan { columns, rows, pose: None }])).unwrap();
    assert_eq!(
        (cloud.points.len(), cloud.points[0], cloud.colors[9]),
        (20_000, DVec3::new(-4.0, 0.5, 7.0), [255, 0, 7])
    );
}

/// The checksum of a page, so that a changed one is read.
fn sealed(mut bytes: Vec<u8>, page: usize) -> Vec<u8> {
    let page = &mut bytes[1024 * page..1024 * (page + 1)];
    let mut crc = u32::MAX;
    for byte in &page[..1020] {
        crc ^= u32::from(*byte);
        for _ in 0..8 {
            crc = if crc & 1 == 1 { crc >> 1 ^ 0x82f6_3b78 } else { crc >> 1 };
        }
    }
    page[1020..].copy_from_slice(&(!crc).to_be_bytes());
    bytes
}

#[test]
fn broken_and_hostile_files_are_refused() {
    let bytes = two_scans();
    assert_eq!(sealed(bytes.clone(), 0), bytes, "the checksum is the one of the format");
    for (bad, want) in [
        (bytes[..bytes.len() - 1024].to_vec(), "cut off"),
        (bytes[..1500].to_vec(), "cut off"),
        (b"ASTM-E57\x01\0".to_vec(), "cut off"),
        ([&bytes[..100], &[9], &bytes[101..]].concat(), "checksum"),
        (file(vec![Scan { columns: PLACE.to_vec(), rows: vec![], pose: None }]), "no point"),
    ] {
        let error = read_with_facts(&bad).unwrap_err();
        assert!(error.contains(want), "{error} should say {want}");
    }
    // What the text announces, where it is as long: more points than there are, than are read, and columns of no bits.
    let swap = |from: &str, to: &str| {
        let at = bytes.windows(from.len()).position(|w| w == from.as_bytes()).unwrap();
        let mut bad = bytes.clone();
        bad[at..at + to.len()].copy_from_slice(to.as_bytes());
        read_with_facts(&sealed(bad, at / 1024)).unwrap_err()
    };
    let error = swap("recordCount=\"3\"", "recordCount=\"9\"");
    assert!(error.contains("9 points are announced, 3 are there"), "{error}");
    let one = |x: i64| Record {
        name: [RecordName::CartesianX, RecordName::CartesianY, RecordName::CartesianZ]
            [usize::try_from(x).unwrap()]
        .clone(),
        data_type: RecordDataType::Integer { min: x, max: x },
    };
    let same = Scan {
        columns: vec![one(0), one(1), one(2)],
        rows: vec![[0, 1, 2].map(RecordValue::Integer).to_vec()],
        pose: None,
    };
    let made = std::panic::catch_unwind(|| file(vec![same]));
    if let Ok(bytes) = made {
        assert!(read_with_facts(&bytes).unwrap_err().contains("one value each"));
    }
    for k in (0..bytes.len()).step_by(7) {
        let mut bad = bytes.clone();
        bad[k] ^= 0x15;
        let _ = read_with_facts(&sealed(bad, k / 1024));
    }
}

#[test]
fn columns_of_different_lengths_are_refused_before_they_are_unpacked() {
    // The packets of a scan are counted: one that gives a column nothing, again and again, holds the others in memory.
    let columns = [&PLACE[..], &[Record::CARTESIAN_INVALID_STATE]].concat();
    let row = || [doubles([1.0, 2.0, 3.0]), vec![RecordValue::Integer(0)]].concat();
    let mut bytes = file(vec![Scan { columns, rows: (0..200_000).map(|_| row()).collect(), pose: None }]);
    assert_eq!(read_with_facts(&bytes).unwrap().0.points.len(), 200_000);
    let text = b"recordCount=\"200000\"";
    let at = bytes.windows(text.len()).position(|w| w == text).unwrap();
    bytes[at..at + text.len()].copy_from_slice(b"recordCount=\"999999\"");
    let error = read_with_facts(&sealed(bytes, at / 1024)).unwrap_err();
    assert!(error.contains("999999 points are announced, 200000 are there"), "{error}");
}
