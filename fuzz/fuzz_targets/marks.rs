//! Any bytes as marks of a leaf: complete marks or an error.
#![no_main]

use formats::{MarksAxes, read_marks};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Ok(read) = read_marks(bytes, "fuzz", MarksAxes::default()) {
        let _ = read.marks.complete(&mut base::Report::default());
    }
});
