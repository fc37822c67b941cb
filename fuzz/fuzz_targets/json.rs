//! Any bytes as json: drawings or errors.
#![no_main]

use formats::{DrawingFormat, DrawingSummary, read_drawings, write_drawing};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    for read in read_drawings(bytes, DrawingFormat::Json, "fuzz").flatten() {
        let info = DrawingSummary::of(&read.drawing, &read.warnings);
        assert!(info.strokes > 0, "a drawing without strokes is an error");
        write_drawing(&read.drawing, std::io::sink()).expect("writes what it read");
    }
});
