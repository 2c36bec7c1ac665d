//! Keeps every symbol but the interface's own inside the shared library, and notes the version.

use std::{env, fs, process::Command};

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    hide_strangers();
    println!("cargo:rustc-env=TREAD_REVISION={}", revision());
}

/// `fmi-sys` brings a `callback_log` that would stand beside the `fmi2*` functions in every FMU.
///
/// The compiler's own version script exports every C symbol of every crate. A second script is refused by
/// GNU's linker, while all linkers but zig's know this (`packaging/zigcc.sh` translates it).
fn hide_strangers() {
    if env::var("CARGO_CFG_TARGET_OS").as_deref() == Ok("linux") {
        println!("cargo:rustc-cdylib-link-arg=-Wl,--exclude-libs,ALL");
    }
}

/// `git describe`, where there is git; it is only told, never needed.
fn revision() -> String {
    let head = Command::new("git").args(["rev-parse", "--git-path", "HEAD"]).output();
    if let Some(path) = head.ok().and_then(|out| String::from_utf8(out.stdout).ok()) {
        if fs::metadata(path.trim()).is_ok() {
            println!("cargo:rerun-if-changed={}", path.trim());
        }
    }
    let output = Command::new("git").args(["describe", "--always", "--dirty", "--tags"]).output();
    match output {
        Ok(done) if done.status.success() => String::from_utf8_lossy(&done.stdout).trim().into(),
        _ => {
            println!("cargo:warning=no git: the revision is not noted in this build");
            "unknown".into()
        }
    }
}
