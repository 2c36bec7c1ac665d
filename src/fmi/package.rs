//! Packs the FMU: a zip file whose bytes depend on nothing but what goes in.

use super::{documentation, model_description, reference, settings, MODEL_IDENTIFIER};
use crate::error::{Fault, Problem};
use crate::params::{load, Params};
use std::io::{Cursor, Write};
use std::path::{Path, PathBuf};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

/// Platforms of FMI 2.0 and how their libraries end.
pub const PLATFORMS: &[(&str, &str)] =
    &[("linux64", "so"), ("win64", "dll"), ("darwin64", "dylib")];

/// A library for one platform.
#[derive(Clone, Debug, PartialEq)]
pub struct Library {
    /// Name of the platform in FMI 2.0, e.g. `linux64`.
    pub platform: String,
    /// The shared library.
    pub file: PathBuf,
}

/// Packs `libraries` with everything else that belongs into the FMU and returns its bytes.
///
/// # Errors
/// [`Fault::Invalid`] for an unknown platform, [`Fault::File`] for a library that cannot be read.
pub fn pack(libraries: &[Library]) -> Result<Vec<u8>, Fault> {
    let mut files = vec![
        ("modelDescription.xml".to_string(), model_description::xml().into_bytes()),
        ("model.png".to_string(), include_bytes!("../../packaging/model.png").to_vec()),
    ];
    for library in libraries {
        files.push(binary(library)?);
    }
    let mut text = |path: &str, text: &str| files.push((path.to_string(), text.into()));
    text("documentation/index.html", &documentation::html());
    text("documentation/licenses/license.txt", LICENSE);
    text("documentation/externalDependencies.txt", DEPENDENCIES);
    let (inputs, outputs) = reference::run()?;
    text("extra/org.tread-block.reference/inputs.csv", &inputs);
    text("extra/org.tread-block.reference/outputs.csv", &outputs);
    let parameters = load::to_toml(&Params::default());
    text(&format!("resources/{}", settings::RESOURCE_FILE), &parameters);
    zipped(&files)
}

const LICENSE: &str = concat!(
    "This FMU is licensed under either of Apache-2.0 or MIT, at your option.\n\n",
    include_str!("../../LICENSE-MIT")
);

const DEPENDENCIES: &str = "\
linux64: the C library (libc, libm, libpthread, libdl) of version 2.17 or newer, nothing else.
win64: Windows 7 or newer, nothing else.
";

fn binary(library: &Library) -> Result<(String, Vec<u8>), Fault> {
    let Some((platform, ending)) = PLATFORMS.iter().find(|(name, _)| *name == library.platform)
    else {
        let names: Vec<_> = PLATFORMS.iter().map(|(name, _)| *name).collect();
        return Err(Fault::one(Problem::new(
            "platform",
            &library.platform,
            names.join(", "),
            "write for example linux64=target/release/libtread_block.so",
        )));
    };
    let bytes = std::fs::read(&library.file).map_err(|e| Fault::file(&library.file, &e))?;
    Ok((format!("binaries/{platform}/{MODEL_IDENTIFIER}.{ending}"), bytes))
}

/// The files as a zip, the same bytes whenever it is made.
fn zipped(files: &[(String, Vec<u8>)]) -> Result<Vec<u8>, Fault> {
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .last_modified_time(DateTime::default())
        .unix_permissions(0o644);
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    let failed = |e: &dyn std::fmt::Display| Fault::unusable(format!("{MODEL_IDENTIFIER}.fmu"), e);
    for (path, bytes) in files {
        zip.start_file(path.as_str(), options).map_err(|e| failed(&e))?;
        zip.write_all(bytes).map_err(|e| failed(&e))?;
    }
    zip.finish().map(Cursor::into_inner).map_err(|e| failed(&e))
}

/// What is wrong with the FMU at `path`, as seen from this version of the model.
///
/// # Errors
/// [`Fault::File`] where it cannot be read as a zip file.
pub fn problems(path: &Path) -> Result<Vec<Problem>, Fault> {
    let bytes = std::fs::read(path).map_err(|e| Fault::file(path, &e))?;
    let mut archive = zip::ZipArchive::new(Cursor::new(bytes)).map_err(|e| fault(path, &e))?;
    let names: Vec<String> =
        archive.file_names().filter_map(Result::ok).map(|name| name.into_owned()).collect();
    let mut found = Vec::new();
    let mut complain = |what: &str, value: &str, allowed: &str, remedy: &str| {
        found.push(Problem::new(what, value, allowed, remedy));
    };
    let mut description = String::new();
    match archive.by_name("modelDescription.xml") {
        Ok(mut file) => {
            std::io::Read::read_to_string(&mut file, &mut description)
                .map_err(|e| fault(path, &e))?;
            if description != model_description::xml() {
                complain(
                    "modelDescription.xml",
                    "another text",
                    "the description of this version",
                    "build the FMU and `tread` from one revision: `make fmu`",
                );
            }
        }
        Err(_) => complain("modelDescription.xml", "missing", "present", "build anew: `make fmu`"),
    }
    if !names.iter().any(|name| name.starts_with("binaries/")) {
        complain("binaries/", "empty", "a library for each platform", "run `make fmu`");
    }
    for (platform, ending) in PLATFORMS {
        let folder = format!("binaries/{platform}/");
        let library = format!("{folder}{MODEL_IDENTIFIER}.{ending}");
        if names.iter().any(|name| name.starts_with(&folder)) && !names.contains(&library) {
            complain(&folder, "no library of the model", &library, "run `make fmu`");
        }
    }
    for name in names.iter().filter(|name| name.contains('\\') || !name.is_ascii()) {
        complain("name in the zip file", name, "ASCII with forward slashes", "run `make fmu`");
    }
    Ok(found)
}

fn fault(path: &Path, error: &dyn std::fmt::Display) -> Fault {
    Fault::unusable(path, format!("{error}; name an FMU: `make fmu` builds one"))
}
