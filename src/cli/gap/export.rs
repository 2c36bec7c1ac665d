//! `tread gap export`: an FMU with the values that a diagnosis has fitted.

use std::io::{Read, Write};
use std::path::Path;

use crate::cli::fmu::beside_this_program;
use crate::cli::output::{self, Stop};
use crate::error::Fault;
use crate::fmi::package;
use crate::gap::json;
use crate::params::load;

/// The FMU as `tread fmu build` packs it, with the fitted values in its resources.
pub fn run(diagnosis: &Path, fmu: &Path, model: &str) -> Result<(), Stop> {
    let params = json::read_model(diagnosis, model)?;
    let plain = package::pack(&[beside_this_program()?])?;
    let failed = |e: std::io::Error| Fault::file(fmu, &e);
    let broken = |e: zip::result::ZipError| Fault::unusable(fmu, e);
    let mut from = zip::ZipArchive::new(std::io::Cursor::new(plain)).map_err(broken)?;
    let mut to = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    let options = zip::write::SimpleFileOptions::default();
    for at in 0..from.len() {
        let mut entry = from.by_index(at).map_err(broken)?;
        let name = entry.name().map_err(broken)?.to_string();
        let mut bytes = Vec::new();
        entry.read_to_end(&mut bytes).map_err(failed)?;
        if name == "resources/parameters.toml" {
            bytes = load::to_toml(&params).into_bytes();
        }
        to.start_file(name, options).map_err(broken)?;
        to.write_all(&bytes).map_err(failed)?;
    }
    let packed = to.finish().map_err(broken)?.into_inner();
    output::to(Some(fmu), &packed)?;
    eprintln!("packed {}", fmu.display());
    Ok(())
}
