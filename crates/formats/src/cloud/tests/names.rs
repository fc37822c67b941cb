//! Names of columns, and colours in every type.

use super::*;
use mesh::PointClass;

fn read_with_facts(bytes: &[u8], format: CloudFormat) -> (PointCloud, CloudFacts, String) {
    let mut report = Report::default();
    let (cloud, facts) = read_cloud_with_facts(bytes, format, &ExportSpec::default(), &mut report).unwrap();
    (cloud, facts, report.warnings.iter().map(|w| format!("{w}\n")).collect())
}

#[test]
fn a_header_of_a_text_names_the_columns_in_any_order() {
    use CloudFormat::Xyz;
    for text in [
        "x y z r g b\n1 2 3 255 0 7\n4 5 6 1 2 3\n",
        "//X Y Z R G B\n1 2 3 255 0 7\n4 5 6 1 2 3\n",
        "id;z;y;x;b;g;r\nt1;3;2;1;7;0;255\nt2;6;5;4;3;2;1\n",
        "\"point\",\"Easting\",\"Northing\",\"Height\",\"Red\",\"Green\",\"Blue\"\np1,1.0,2.0,3.0,255,0,7\np2,4,5,6,1,2,3\n",
        "X\tY\tZ\tIntensity\tRed\tGreen\tBlue\n1\t2\t3\t-812\t65280\t0\t1792\n4\t5\t6\t9\t256\t512\t768\n",
        "id;x;y;z;r;g;b\n7;1,0;2,0;3,0;255;0;7\n8;4,0;5,0;6,0;1;2;3\n",
        "# x [m], y [m], z [m], Rf, Gf, Bf\n1,2,3,1.0,0.0,0.02745\n4,5,6,0.003922,0.007843,0.011765\n",
    ] {
        let (cloud, facts, _) = read_with_facts(text.as_bytes(), Xyz);
        assert_eq!(cloud.points, [DVec3::new(1.0, 2.0, 3.0), DVec3::new(4.0, 5.0, 6.0)], "{text:?}");
        assert_eq!(cloud.colors, [[255, 0, 7], [1, 2, 3]], "{text:?}");
        assert!(facts.has_colors && facts.columns.len() >= 6, "{facts:?}");
    }
    let (_, _, said) = read_with_facts(b"id x y z nx\n1 1 2 3 0\n", Xyz);
    assert!(said.contains("columns left out: id, nx"), "{said}");
    // A comment is no header, and names that do not fit the rows are none.
    let (cloud, ..) = read_with_facts(b"# points x y z\n1 2 3 4\n", Xyz);
    assert_eq!(cloud.points, [DVec3::new(1.0, 2.0, 3.0)]);
    // PTS: the number of points, then an intensity before the colours.
    let (cloud, _, said) = read_with_facts(b"2\n1 2 3 -812 255 0 7\n4 5 6 2047 1 2 3\n", Xyz);
    assert_eq!(
        (cloud.colors.clone(), said.contains("columns 4 were")),
        (vec![[255, 0, 7], [1, 2, 3]], true),
        "{said}"
    );
    let error = read(b"id x y z\n1 2 3 4\n5 6 seven 8\n", Xyz).unwrap_err();
    assert!(error.contains("line 3") && error.contains("seven"), "{error}");
}

#[test]
fn classes_of_a_text_are_numbers_of_las_or_words() {
    let (cloud, facts, said) =
        read_with_facts(b"x y z classification\n0 0 0 2\n0 0 1 7\n0 0 2 5\n0 0 3 18\n", CloudFormat::Xyz);
    assert_eq!(cloud.classes, [PointClass::Ground, PointClass::Unknown]);
    assert_eq!(cloud.points.len(), 2);
    assert!(said.contains("2 points that are noise by their class"), "{said}");
    let used: Vec<_> = facts.classes.iter().map(|c| (c.class, c.name.as_str(), c.used_as)).collect();
    assert_eq!(used[0], (2, "ground", "ground"));
    assert_eq!(used[2], (7, "low noise", "left out"));
    let (cloud, ..) =
        read_with_facts(b"x,y,z,label\n0,0,0,wood\n0,0,1,Leaf\n0,0,2,terrain\n0,0,3,7\n", CloudFormat::Xyz);
    assert_eq!(cloud.classes, [PointClass::Wood, PointClass::Leaf, PointClass::Ground, PointClass::Unknown]);
    // A number in a column of labels may mean anything.
    let (cloud, ..) = read_with_facts(b"x y z label\n0 0 0 7\n0 0 1 2\n", CloudFormat::Xyz);
    assert_eq!((cloud.points.len(), cloud.classes.len()), (2, 0));
}

#[test]
fn colours_of_a_ply_are_read_in_every_type() {
    for (kind, row) in [
        ("uchar", "255 0 7"),
        ("ushort", "65280 0 1792"),
        ("uint", "255 0 7"),
        ("float", "1 0 0.02745"),
        ("double", "255 0 7"),
    ] {
        let text = format!(
            "ply\nformat ascii 1.0\nelement vertex 1\nproperty double x\nproperty double y\nproperty double z\n\
             property {kind} red\nproperty {kind} green\nproperty {kind} blue\nproperty float scalar_Classification\n\
             end_header\n1 2 3 {row} 2\n"
        );
        let (cloud, ..) = read_with_facts(text.as_bytes(), CloudFormat::Ply);
        assert_eq!((cloud.colors, cloud.classes), (vec![[255, 0, 7]], vec![PointClass::Ground]), "{kind}");
    }
}

#[test]
fn colours_of_a_pcd_are_read_packed_and_apart() {
    let head = |fields: &str, size: &str, kind: &str, data: &str| {
        format!("FIELDS x y z {fields}\nSIZE 4 4 4 {size}\nTYPE F F F {kind}\nPOINTS 1\nDATA {data}\n")
            .into_bytes()
    };
    let colors = |bytes: &[u8]| read_with_facts(bytes, CloudFormat::Pcd).0.colors;
    let bits = 0x00_ff_00_07_u32;
    let mut text = head("rgb", "4", "F", "ascii");
    text.extend(format!("1 2 3 {:e}\n", f32::from_bits(bits)).bytes());
    assert_eq!(colors(&text), [[255, 0, 7]]);
    let mut text = head("rgb", "4", "U", "ascii");
    text.extend(format!("1 2 3 {bits}\n").bytes());
    assert_eq!(colors(&text), [[255, 0, 7]]);
    // Opaque red as a float is no number: its bits count all the same.
    for opaque in [bits, bits | 0xff00_0000, 0xff80_0007] {
        let mut binary = head("rgba", "4", "F", "binary");
        binary.extend([1.0_f32, 2.0, 3.0].iter().flat_map(|x| x.to_le_bytes()));
        binary.extend(opaque.to_le_bytes());
        let [_, r, g, b] = opaque.to_be_bytes();
        assert_eq!(colors(&binary), [[r, g, b]], "{opaque:x}");
    }
    let mut apart = head("r g b label", "1 1 1 4", "U U U U", "binary");
    apart.extend([1.0_f32, 2.0, 3.0].iter().flat_map(|x| x.to_le_bytes()));
    apart.extend([255, 0, 7, 9, 0, 0, 0]);
    assert_eq!(colors(&apart), [[255, 0, 7]]);
    let mut shares = head("r g b", "4 4 4", "F F F", "ascii");
    shares.extend(b"1 2 3 1 0 0.02745\n");
    assert_eq!(colors(&shares), [[255, 0, 7]]);
}

#[test]
fn colours_of_an_obj_follow_the_coordinates() {
    let (cloud, ..) = read_with_facts(b"v 1 2 3 1 0 0.02745\nv 4 5 6 0 1 0\n", CloudFormat::Obj);
    assert_eq!(cloud.colors, [[255, 0, 7], [0, 255, 0]]);
    assert!(read_with_facts(b"v 1 2 3 1\n", CloudFormat::Obj).0.colors.is_empty(), "a weight");
    let (cloud, _, said) = read_with_facts(b"v 1 2 3 1 0 0\nv 1 2 3\n", CloudFormat::Obj);
    assert!(cloud.points.len() == 2 && cloud.colors.is_empty() && said.contains("only some"), "{said}");
    // A scan that is black has no colours, and beyond 65535 there are none.
    assert!(read_with_facts(b"v 1 2 3 0 0 0\n", CloudFormat::Obj).0.colors.is_empty());
    let (cloud, _, said) = read_with_facts(b"v 1 2 3 1e6 0 0\n", CloudFormat::Obj);
    assert!(cloud.colors.is_empty() && said.contains("no range of colours"), "{said}");
}

#[test]
fn coarse_single_precision_far_from_the_origin_is_told_with_its_step() {
    let far = |p: [f32; 3]| {
        let mut ply =
            b"ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\nproperty float y\n\
            property float z\nend_header\n"
                .to_vec();
        ply.extend(p.iter().chain(&[0.5, 0.5, 0.5]).flat_map(|x| x.to_le_bytes()));
        read_with_facts(&ply, CloudFormat::Ply)
    };
    let (_, facts, said) = far([432_100.25, 5_612_300.5, 312.0]);
    assert!(said.contains("they stand 500.0 mm apart"), "{said}");
    assert_eq!(facts.step_mm, Some(500.0));
    assert!(!far([12.5, 3.25, 1.0]).2.contains("single precision"));
    let double = read_with_facts(b"432100.123 5612300.456 312.1\n", CloudFormat::Xyz);
    assert_eq!((double.1.step_mm, double.2.contains("single")), (None, false));
}

#[test]
fn strays_are_left_out_and_told() {
    let mut text: String = (0..500).map(|i| format!("{} {} {}\n", i % 7, i / 7 % 7, i / 49)).collect();
    text += "100000 0 0\n";
    let (cloud, facts, said) = read_with_facts(text.as_bytes(), CloudFormat::Xyz);
    assert_eq!((cloud.points.len(), facts.strays, facts.max[0]), (500, 1, 6.0));
    assert!(said.contains("left out: 1 points that lie more than ten times as far out"), "{said}");
}
