//! `targets::TARGETS` names its function, which says what it does.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    targets::run("sheet", bytes);
});
