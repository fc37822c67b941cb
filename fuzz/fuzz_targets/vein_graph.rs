//! Any bytes as a vein graph: marks or chief veins that make a leaf, or an error.
#![no_main]

use formats::read_vein_graph;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let mut report = base::Report::default();
    let Ok(read) = read_vein_graph(bytes) else { return };
    if let Ok(marks) = read.graph.marks(&mut report) {
        let _ = marks.complete(&mut report);
    }
    if let Ok(Some(rays)) = read.graph.rays(&mut report) {
        let _ = rays.validate().next();
    }
});
