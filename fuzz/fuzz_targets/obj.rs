//! Any bytes as obj: a sound model or an error.
#![no_main]

use formats::{ExportSpec, ModelFormat, read_model, write_glb};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let mut report = base::Report::default();
    // Whatever an OBJ refers to is the same bytes again.
    let resolve = |_: formats::SideFile<'_>| Ok(bytes.to_vec());
    let read = read_model(bytes, ModelFormat::Obj, "fuzz", &ExportSpec::default(), &resolve, &mut report);
    if let Ok(model) = read {
        let bad = model.validate().find(|f| !matches!(f, mesh::MeshFault::Degenerate(_)));
        assert_eq!(bad, None, "what was read is sound");
        write_glb(&model, std::io::sink()).expect("writes what it read");
    }
});
