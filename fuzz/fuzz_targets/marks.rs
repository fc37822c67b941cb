//! Any bytes as marks or chief veins of a leaf, and as a growth table: sound, or an error.
#![no_main]

use formats::{MarksAxes, is_rays, read_growth, read_marks, read_rays};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Ok(read) = read_growth(bytes, base::Unit::Metre) {
        assert!(read.rows.iter().all(|r| r.day.is_finite() && r.size >= 0.0 && r.size.is_finite()));
    }
    if is_rays(bytes) {
        if let Ok(read) = read_rays(bytes, "fuzz", MarksAxes::default()) {
            let _ = read.rays.validate().next();
        }
    } else if let Ok(read) = read_marks(bytes, "fuzz", MarksAxes::default()) {
        let _ = read.marks.complete(&mut base::Report::default());
    }
});
