//! Classes, deleted points and coordinate systems of LAS.

use super::*;
use mesh::PointClass;

/// A point: place, class, and whether it is deleted.
type Point = ([i32; 3], u8, bool);

/// A file of point format 0 (LAS 1.2) or 6 (LAS 1.4), steps of a millimetre, with records before its points.
fn file(format: u8, points: &[Point], records: &[(&str, u16, Vec<u8>)]) -> Vec<u8> {
    let (minor, head, record) = if format == 6 { (4, 375_u16, 30_u16) } else { (2, 227, 20) };
    let mut b = vec![0_u8; usize::from(head)];
    b[..4].copy_from_slice(b"LASF");
    (b[24], b[25], b[104]) = (1, minor, format);
    b[94..96].copy_from_slice(&head.to_le_bytes());
    b[105..107].copy_from_slice(&record.to_le_bytes());
    let count = u32::try_from(points.len()).unwrap();
    if format == 6 {
        b[247..255].copy_from_slice(&u64::from(count).to_le_bytes());
    } else {
        b[107..111].copy_from_slice(&count.to_le_bytes());
    }
    for k in 0..3 {
        b[131 + 8 * k..139 + 8 * k].copy_from_slice(&0.001_f64.to_le_bytes());
    }
    for (user, id, data) in records {
        let mut name = [0; 16];
        name[..user.len()].copy_from_slice(user.as_bytes());
        b.extend([0, 0]);
        b.extend(name);
        b.extend(id.to_le_bytes());
        b.extend(u16::try_from(data.len()).unwrap().to_le_bytes());
        b.extend([0; 32]);
        b.extend(data);
    }
    let data_at = u32::try_from(b.len()).unwrap();
    b[96..100].copy_from_slice(&data_at.to_le_bytes());
    b[100..104].copy_from_slice(&u32::try_from(records.len()).unwrap().to_le_bytes());
    for (place, class, is_deleted) in points {
        let from = b.len();
        b.extend(place.iter().flat_map(|x| x.to_le_bytes()));
        b.resize(from + usize::from(record), 0);
        if format == 6 {
            (b[from + 15], b[from + 16]) = (if *is_deleted { 0b100 } else { 0 }, *class);
        } else {
            b[from + 15] = class | if *is_deleted { 0x80 } else { 0 };
        }
    }
    b
}

fn read_with_facts(bytes: &[u8], spec: &ExportSpec) -> (PointCloud, CloudFacts, String) {
    let mut report = Report::default();
    let (cloud, facts) = read_cloud_with_facts(bytes, CloudFormat::Las, spec, &mut report).unwrap();
    (cloud, facts, report.warnings.iter().map(|w| format!("{w}\n")).collect())
}

#[test]
fn noise_and_deleted_points_are_left_out_and_ground_is_known() {
    for format in [0, 6] {
        let points = [
            ([1000, 2000, 3000], 2, false),
            ([0, 0, 1000], 5, false),
            ([0, 0, 2000], 7, false),
            ([0, 0, 3000], 1, true),
        ];
        let (cloud, facts, said) = read_with_facts(&file(format, &points, &[]), &ExportSpec::default());
        assert_eq!(cloud.classes, [PointClass::Ground, PointClass::Unknown], "{format}");
        assert_eq!((cloud.points.len(), facts.noise, facts.deleted), (2, 1, 1));
        assert!(
            said.contains("1 points that are noise") && said.contains("1 points that the file has deleted"),
            "{said}"
        );
        assert_eq!(facts.step_mm, Some(1.0));
    }
    let all = file(0, &[([0; 3], 7, false)], &[]);
    let error = read(&all, CloudFormat::Las).unwrap_err();
    assert!(error.contains("noise"), "{error}");
}

#[test]
fn a_table_of_classes_says_which_are_wood_and_leaf() {
    let row = |class: u8, name: &str| {
        let mut row = [0; 16];
        row[0] = class;
        row[1..=name.len()].copy_from_slice(name.as_bytes());
        row
    };
    let table = [row(64, "Wood"), row(65, "Leaves"), row(66, "outliers")].concat();
    let points = [([0, 0, 0], 64, false), ([0, 0, 1000], 65, false), ([0, 0, 2000], 66, false)];
    let (cloud, facts, _) =
        read_with_facts(&file(6, &points, &[("LASF_Spec", 0, table)]), &ExportSpec::default());
    assert_eq!(cloud.classes, [PointClass::Wood, PointClass::Leaf]);
    let names: Vec<_> = facts.classes.iter().map(|c| (c.name.as_str(), c.used_as)).collect();
    assert_eq!(names, [("Wood", "wood"), ("Leaves", "leaf"), ("outliers", "left out")]);
}

#[test]
fn the_coordinate_system_and_its_unit_are_told() {
    let points = [([1000, 2000, 3000], 1, false), ([4000, 2000, 3000], 1, false)];
    let feet =
        br#"PROJCS["NAD83 / Oregon North (ft)",GEOGCS["NAD83",UNIT["degree",0.0174]],UNIT["foot",0.3048]]"#;
    let feet = file(6, &points, &[("LASF_Projection", 2112, feet.to_vec())]);
    let (_, facts, said) = read_with_facts(&feet, &ExportSpec::default());
    assert_eq!(facts.coordinate_system.as_deref(), Some("NAD83 / Oregon North (ft)"));
    assert!(said.contains("(foot)") && said.contains("give ft as its unit"), "{said}");
    let asked = ExportSpec { unit: Unit::Foot, ..ExportSpec::default() };
    let (cloud, facts, said) = read_with_facts(&feet, &asked);
    assert!((cloud.points[1].x - 4.0 * 0.3048).abs() < 1e-12 && said.is_empty(), "{said}");
    assert!((facts.step_mm.unwrap() - 0.3048).abs() < 1e-12 && (facts.max[0] - 4.0).abs() < 1e-12, "in feet");
    let keys: Vec<u8> =
        [1_u16, 1, 0, 2, 1024, 0, 1, 1, 3072, 0, 1, 25832].iter().flat_map(|w| w.to_le_bytes()).collect();
    let (_, facts, said) =
        read_with_facts(&file(0, &points, &[("LASF_Projection", 34735, keys)]), &ExportSpec::default());
    assert_eq!((facts.coordinate_system.as_deref(), said.as_str()), (Some("EPSG:25832"), ""));
    let degrees = br#"GEOGCS["WGS 84",DATUM["WGS_1984"],UNIT["degree",0.0174532925199433]]"#;
    let error = read(&file(6, &points, &[("LASF_Projection", 2112, degrees.to_vec())]), CloudFormat::Las)
        .unwrap_err();
    assert!(error.contains("degrees (WGS 84)") && error.contains("metres first"), "{error}");
}
