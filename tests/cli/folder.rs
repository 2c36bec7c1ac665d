//! A folder for one test, and the real binary in it.

use std::path::PathBuf;
use std::process::{Command, Output};

/// A folder that goes away with the test.
pub struct Folder(pub PathBuf);

impl Folder {
    /// A new one; `test` is its name.
    pub fn new(test: &str) -> Self {
        let path = std::env::temp_dir().join(format!("tread-{test}-{}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    /// Writes a file in it.
    pub fn write(&self, name: &str, text: &str) -> PathBuf {
        let path = self.0.join(name);
        std::fs::write(&path, text).unwrap();
        path
    }

    /// Runs the command line in it.
    pub fn tread(&self, arguments: &[&str]) -> Output {
        Command::new(env!("CARGO_BIN_EXE_tread"))
            .args(arguments)
            .current_dir(&self.0)
            .output()
            .unwrap()
    }

    /// Standard output of a command that has to do its work.
    pub fn fine(&self, arguments: &[&str]) -> String {
        let output = self.tread(arguments);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}\n{}", stderr(&output));
        String::from_utf8(output.stdout).unwrap()
    }

    /// Standard error of a command that has to refuse.
    pub fn refused(&self, arguments: &[&str]) -> String {
        let output = self.tread(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}\n{}", stderr(&output));
        stderr(&output)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// What a command said.
pub fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}
