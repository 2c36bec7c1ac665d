//! Packs a stage's shared library into an FMU.
//!
//!     pack BeltSource LIBRARY.so OUT.fmu

use chain_stages::{acoustic_stage::AcousticStage, belt_source::BeltSource, description};
use std::io::Write;
use std::process::ExitCode;
use zip::write::SimpleFileOptions;

const LICENSE: &[u8] = include_bytes!("../../../../../LICENSE-MIT");

fn pack(model: &str, library: &str, out: &str) -> Result<(), Box<dyn std::error::Error>> {
    let xml = match model {
        "BeltSource" => description::xml::<BeltSource>(),
        "AcousticStage" => description::xml::<AcousticStage>(),
        other => return Err(format!("no stage {other}: BeltSource, AcousticStage").into()),
    };
    let mut zip = zip::ZipWriter::new(std::fs::File::create(out)?);
    // The time of 1980 makes the bytes depend on nothing but the content.
    let options = SimpleFileOptions::default()
        .compression_method(zip::CompressionMethod::Deflated)
        .last_modified_time(zip::DateTime::default());
    let files = [
        ("modelDescription.xml".to_string(), xml.into_bytes()),
        (format!("binaries/linux64/{model}.so"), std::fs::read(library)?),
        ("documentation/licenses/license.txt".to_string(), LICENSE.to_vec()),
    ];
    for (name, bytes) in files {
        zip.start_file(name, options)?;
        zip.write_all(&bytes)?;
    }
    zip.finish()?;
    Ok(())
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [model, library, out] = arguments.as_slice() else {
        eprintln!("usage: pack MODEL LIBRARY OUT");
        return ExitCode::from(2);
    };
    match pack(model, library, out) {
        Ok(()) => ExitCode::SUCCESS,
        Err(reason) => {
            eprintln!("pack: {reason}");
            ExitCode::from(2)
        }
    }
}
