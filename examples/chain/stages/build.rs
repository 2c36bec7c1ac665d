//! Keeps every symbol but the interface's own inside the shared libraries, as the block's build does.

use std::{env, fs, path::PathBuf};

const MAP: &str = "{\n  global: fmi2*;\n  local: callback_log; callback_logger_handler; *;\n};\n";

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    if env::var("CARGO_CFG_TARGET_OS").as_deref() != Ok("linux") {
        return;
    }
    let Ok(out) = env::var("OUT_DIR").map(PathBuf::from) else { return };
    let script = out.join("exports.map");
    if fs::write(&script, MAP).is_ok() {
        // Cargo has no kind of its own for examples that are libraries; the packer does not mind.
        println!("cargo:rustc-link-arg=-Wl,--version-script={}", script.display());
    }
}
