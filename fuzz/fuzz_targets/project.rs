//! Any bytes as a project: a sound document that survives being saved, or an error.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Ok(document) = document::read_project(bytes) {
        assert_eq!(document.validate().count(), 0, "a document that was read is sound");
        let again = document::write_project(&document, "fuzz").expect("writes what it read");
        assert_eq!(document::read_project(&again).expect("reads what it wrote"), document);
    }
});
