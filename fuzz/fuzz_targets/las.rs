//! Any bytes as LAS: a sound cloud or an error.
#![no_main]

use formats::{CloudFormat, ExportSpec, read_cloud, write_cloud_ply};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let mut report = base::Report::default();
    if let Ok(cloud) = read_cloud(bytes, CloudFormat::Las, &ExportSpec::default(), &mut report) {
        assert!(cloud.is_sound() && !cloud.points.is_empty(), "what was read is sound");
        write_cloud_ply(&cloud, &ExportSpec::default(), std::io::sink()).expect("writes what it read");
    }
});
