//! Any bytes as a vein graph: marks that make a leaf, or an error.
#![no_main]

use formats::read_vein_graph;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let mut report = base::Report::default();
    if let Ok(read) = read_vein_graph(bytes)
        && let Ok(marks) = read.graph.marks(&mut report)
    {
        let _ = marks.complete(&mut report);
    }
});
