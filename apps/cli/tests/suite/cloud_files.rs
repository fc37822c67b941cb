//! Files of clouds: what `info` says of them, their classes, and their coordinates.
#![expect(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests")]

use std::fs;

use serde_json::Value;

use crate::tools::{bad, folder, good};

/// A trunk of 4 m on a plane of 4 m, 1 cm apart: x, y, z (up) and the class of LAS.
fn trunk(by: [f64; 3]) -> Vec<([f64; 3], u8)> {
    let mut out = vec![];
    for i in 0..160 {
        for j in 0..160 {
            out.push(([f64::from(i) * 0.025 - 2.0, f64::from(j) * 0.025 - 2.0, 0.0], 2));
        }
    }
    for k in 0..400 {
        for a in 0..60 {
            let angle = f64::from(a) / 60.0 * std::f64::consts::TAU;
            out.push(([0.12 * angle.cos(), 0.12 * angle.sin(), f64::from(k) * 0.01], 1));
        }
    }
    // Noise below the ground and far above it.
    out.push(([0.5, 0.5, -3.0], 7));
    out.push(([0.5, 0.5, 30.0], 18));
    out.into_iter().map(|(p, class)| ([p[0] + by[0], p[1] + by[1], p[2] + by[2]], class)).collect()
}

fn las(points: &[([f64; 3], u8)], offset: [f64; 3], system: &str) -> Vec<u8> {
    let mut b = vec![0_u8; 375];
    b[..4].copy_from_slice(b"LASF");
    (b[24], b[25], b[104]) = (1, 4, 6);
    b[94..96].copy_from_slice(&375_u16.to_le_bytes());
    b[105..107].copy_from_slice(&30_u16.to_le_bytes());
    b[247..255].copy_from_slice(&(points.len() as u64).to_le_bytes());
    for (k, offset) in offset.into_iter().enumerate() {
        b[131 + 8 * k..139 + 8 * k].copy_from_slice(&0.001_f64.to_le_bytes());
        b[155 + 8 * k..163 + 8 * k].copy_from_slice(&offset.to_le_bytes());
    }
    b.extend([0, 0]);
    b.extend(b"LASF_Projection\0");
    b.extend(2112_u16.to_le_bytes());
    b.extend(u16::try_from(system.len()).unwrap().to_le_bytes());
    b.extend([0; 32]);
    b.extend(system.bytes());
    let data_at = u32::try_from(b.len()).unwrap();
    b[96..100].copy_from_slice(&data_at.to_le_bytes());
    b[100] = 1;
    for (p, class) in points {
        let from = b.len();
        for k in 0..3 {
            #[expect(clippy::cast_possible_truncation, reason = "small")]
            let steps = ((p[k] - offset[k]) / 0.001).round() as i32;
            b.extend(steps.to_le_bytes());
        }
        b.resize(from + 30, 0);
        b[from + 16] = *class;
    }
    b
}

const METRES: &str =
    r#"PROJCS["ETRS89 / UTM zone 32N",GEOGCS["ETRS89",UNIT["degree",0.0174]],UNIT["metre",1]]"#;
const FEET: &str =
    r#"PROJCS["NAD83 / Oregon North (ft)",GEOGCS["NAD83",UNIT["degree",0.0174]],UNIT["foot",0.3048]]"#;
const FAR: [f64; 3] = [432_100.0, 5_612_300.0, 312.0];

#[test]
fn info_describes_every_kind_of_cloud() {
    let at = folder("info-clouds");
    let far = trunk(FAR);
    fs::write(at.join("map.las"), las(&far, FAR, METRES)).unwrap();
    let told = good(&at, &["info", "map.las"]);
    for part in [
        "49,600 points (LAS 1.4, point format 6)",
        "in metre, by its coordinate system",
        "from (432098.000, 5612298.000, 312.000)",
        "class 2 (ground): 25,600 points: ground",
        "class 7 (low noise): 1 point: left out",
        "coordinate system: ETRS89 / UTM zone 32N",
        "coordinates in steps of 1 mm",
        "left out: 2 points that are noise by their class",
    ] {
        assert!(told.contains(part), "{part} is not in {told}");
    }
    let json: Value = serde_json::from_str(&good(&at, &["info", "map.las", "--json"])).unwrap();
    assert_eq!((json["format"].as_str(), json["cloud"]["points"].as_u64()), (Some("las"), Some(49_600)));
    assert_eq!(json["cloud"]["classes"][1]["used_as"], "ground");
    let text = |rows: &str| format!("id;x;y;z;r;g;b;label\n{rows}");
    fs::write(at.join("a.csv"), text("1;0,5;0;0;255;0;0;wood\n2;1,5;2;3;0;0;9;leaf\n")).unwrap();
    let told = good(&at, &["info", "a.csv"]);
    assert!(
        told.contains("2 points") && told.contains("1 x 2 x 3") && told.contains("columns left out: id"),
        "{told}"
    );
    assert!(told.contains("in m by its size, a guess; --unit says it"), "{told}");
    fs::write(at.join("a.obj"), "v 0 0 0 1 0 0\nv 1 2 3 0 1 0\n").unwrap();
    assert!(good(&at, &["info", "a.obj"]).contains("columns: x, y, z, red, green, blue"));
    fs::write(at.join("a.obj"), "v 0 0 0\nv 1 2 3\nv 2 0 0\nf 1 2 3\n").unwrap();
    assert!(good(&at, &["info", "a.obj"]).contains("1 triangle"), "a mesh is a model");
    fs::write(at.join("b.e57"), b"ASTM-E57\x01\0\0\0").unwrap();
    assert!(bad(&at, &["info", "b.e57"]).contains("cut off"));
}

#[test]
fn a_tree_keeps_the_coordinates_of_its_map_and_takes_its_classes() {
    let at = folder("map-tree");
    fs::write(at.join("map.las"), las(&trunk(FAR), FAR, METRES)).unwrap();
    let told = good(&at, &["scan", "map.las", "-o", "tree.glb", "--json"]);
    let json: Value = serde_json::from_str(&told).unwrap();
    assert_eq!(json["input"]["coordinate_system"], "ETRS89 / UTM zone 32N");
    for k in 0..3 {
        let foot = json["scan"]["foot_m"][k].as_f64().unwrap();
        assert!((foot - FAR[k]).abs() < 0.2, "{foot}");
    }
    let warnings = json["items"][0]["warnings"].to_string();
    assert!(
        warnings.contains("25600 points of ground") && warnings.contains("2 points that are noise"),
        "{warnings}"
    );
    assert!(json["items"][0]["plant"]["dbh_m"].as_f64().is_some_and(|d| (d - 0.24).abs() < 0.01));
}

#[test]
fn feet_are_told_and_read_as_feet_where_they_are_asked_for() {
    let at = folder("feet-tree");
    let feet: Vec<_> = trunk([0.0; 3]).into_iter().map(|(p, c)| (p.map(|x| x / 0.3048), c)).collect();
    fs::write(at.join("ft.las"), las(&feet, [0.0; 3], FEET)).unwrap();
    let dbh = |args: &[&str]| {
        let told = good(&at, &[&["scan", "ft.las", "-o", "tree.glb", "--json"], args].concat());
        let json: Value = serde_json::from_str(&told).unwrap();
        (json["items"][0]["plant"]["dbh_m"].as_f64().unwrap(), json["items"][0]["warnings"].to_string())
    };
    let (wrong, told) = dbh(&[]);
    assert!(told.contains("(foot)") && told.contains("give ft as its unit") && wrong > 0.7, "{wrong} {told}");
    let (right, told) = dbh(&["--unit", "ft"]);
    assert!((right - 0.24).abs() < 0.01 && !told.contains("--unit ft"), "{right} {told}");
}
