//! Scans of single leaves, made by other people and by us.

use crate::missing;
use burgeon::formats::{CloudFormat, ExportSpec, read_cloud};
use burgeon::leaf::ScanSpec;
use burgeon::{Report, Run, Unit, make_leaf_from_scan};

#[test]
fn real_scans_are_explained() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data/scans/single_leaves");
    let Ok(files) = std::fs::read_dir(folder) else {
        return missing::skipped(folder);
    };
    for path in files.filter_map(Result::ok).map(|f| f.path()) {
        if path.extension().is_none_or(|e| e != "txt") {
            continue;
        }
        explained(&path);
    }
}

#[test]
fn our_own_scan_is_explained() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/scans/leaf.txt");
    explained(std::path::Path::new(path));
}

/// Checks that a leaf of a scan in millimetres is near all its points.
#[expect(clippy::print_stdout, reason = "figures for whoever looks for them")]
fn explained(path: &std::path::Path) {
    let axes = ExportSpec { unit: Unit::Millimetre, ..ExportSpec::default() };
    let bytes = std::fs::read(path).expect("a file");
    let mut report = Report::default();
    let cloud = read_cloud(bytes.as_slice(), CloudFormat::Xyz, &axes, &mut report).expect("a cloud");
    let spec = ScanSpec::default();
    let (made, _) = make_leaf_from_scan("t", &cloud, &spec, &Run::plain()).expect("a leaf");
    let about = made.item.leaf.expect("what was measured of it");
    let fit = about.fit_error;
    println!("{}: {fit:?} {:?}", path.display(), about.scan);
    assert_eq!((made.model.validate().next(), made.plant.validate().next()), (None, None), "sound");
    assert!(fit.rms_mm < 1.5 && fit.p95_mm < 3.0 && fit.explained > 0.85, "{path:?} {fit:?}");
}
