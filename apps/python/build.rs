//! Links without Python's own symbols: the interpreter that loads the library provides them.

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    if std::env::var("CARGO_CFG_TARGET_OS").is_ok_and(|os| os == "macos") {
        for word in ["-undefined", "dynamic_lookup"] {
            println!("cargo:rustc-cdylib-link-arg={word}");
        }
    }
}
