//! Names the shared library for the dynamic linker.

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    if std::env::var("CARGO_CFG_TARGET_OS").as_deref() == Ok("linux") {
        // Until version 1 the interface may change: the 0 says so.
        println!("cargo:rustc-cdylib-link-arg=-Wl,-soname,libgnomon.so.0");
    }
}
