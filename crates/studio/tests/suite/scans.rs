//! Scans of single leaves made by other people.

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
    let axes = ExportSpec { unit: Unit::Millimetre, ..ExportSpec::default() };
    for path in files.filter_map(Result::ok).map(|f| f.path()) {
        if path.extension().is_none_or(|e| e != "txt") {
            continue;
        }
        let bytes = std::fs::read(&path).unwrap();
        let mut report = Report::default();
        let cloud = read_cloud(bytes.as_slice(), CloudFormat::Xyz, &axes, &mut report).unwrap();
        let spec = ScanSpec::default();
        let (made, _) = make_leaf_from_scan("t", &cloud, &spec, &Run::plain()).unwrap();
        let about = made.item.leaf.unwrap();
        let fit = about.fit_error;
        println!("{}: {fit:?} {:?}", path.display(), about.scan);
        assert_eq!(made.model.validate().next(), None);
        assert_eq!(made.plant.validate().next(), None);
        assert!(fit.rms_mm < 1.5 && fit.p95_mm < 3.0 && fit.explained > 0.85, "{path:?} {fit:?}");
    }
}
