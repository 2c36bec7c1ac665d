//! Keeps every symbol but the interface's own inside the shared libraries, as the block's build does.

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    if std::env::var("CARGO_CFG_TARGET_OS").as_deref() == Ok("linux") {
        // Cargo has no kind of its own for examples that are libraries; the packer does not mind.
        println!("cargo:rustc-link-arg=-Wl,--exclude-libs,ALL");
    }
}
