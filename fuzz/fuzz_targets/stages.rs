//! The function of this target is in `targets::TARGETS`, with its description.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    targets::run("stages", bytes);
});
