//! Scans of real plants are read whole. Skips where the data is absent.

use crate::missing;
use base::Report;
use formats::{CloudFormat, ExportSpec, read_cloud};

#[test]
fn the_real_scans_are_read() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/scans");
    if !folder.is_dir() {
        return missing::skipped(folder.display());
    }
    for (name, want) in [
        ("tomato_series/03-05.xyz", 24_795),
        ("tomato_series/03-06.xyz", 50_000),
        ("tomato_series/03-10.ply", 261_379),
        ("single_leaves/soybean_11_20190508T043118_pot1_1.txt", 3_290),
        ("single_leaves/sugarbeet_f00012_20170829T010129_pot1_1.txt", 2_266),
    ] {
        let path = folder.join(name);
        let format = CloudFormat::from_extension(path.extension().unwrap().to_str().unwrap()).unwrap();
        let bytes = std::fs::read(path).unwrap();
        let cloud = read_cloud(&bytes[..], format, &ExportSpec::default(), &mut Report::default()).unwrap();
        assert_eq!(cloud.points.len(), want, "{name}");
    }
}

#[test]
fn scans_of_our_own_are_read_whole_with_their_colours() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/scans");
    let mut clouds = Vec::new();
    for (name, format) in [("leaf.txt", CloudFormat::Xyz), ("leaf.ply", CloudFormat::Ply)] {
        let bytes = std::fs::read(folder.join(name)).unwrap();
        let cloud = read_cloud(&bytes[..], format, &ExportSpec::default(), &mut Report::default()).unwrap();
        assert_eq!((cloud.points.len(), cloud.colors.len()), (2064, 2064), "{name}");
        clouds.push(cloud);
    }
    // Both hold the same leaf, to the digits that each gives and the float of one of them.
    for (a, b) in clouds[0].points.iter().zip(&clouds[1].points) {
        assert!(a.distance(*b) < 1e-4, "{a} {b}");
    }
    assert_eq!(clouds[0].colors, clouds[1].colors);
}
