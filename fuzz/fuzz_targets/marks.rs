//! Any bytes as marks or chief veins of a leaf: a sound leaf or an error.
#![no_main]

use formats::{MarksAxes, is_rays, read_marks, read_rays};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if is_rays(bytes) {
        if let Ok(read) = read_rays(bytes, "fuzz", MarksAxes::default()) {
            let _ = read.rays.validate().next();
        }
    } else if let Ok(read) = read_marks(bytes, "fuzz", MarksAxes::default()) {
        let _ = read.marks.complete(&mut base::Report::default());
    }
});
