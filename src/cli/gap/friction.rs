//! `tread gap friction`: friction records without block dynamics.

use std::path::PathBuf;

use crate::cli::output::{self, Done, Stop};
use crate::gap::friction::{record, told, verdict};

/// Every record on its own; one that cannot be used is told and does not stop the others.
pub fn run(records: &[PathBuf], json: bool) -> Result<Done, Stop> {
    let (mut text, mut all, mut done) = (String::new(), Vec::new(), Done::Fine);
    for path in records {
        match record::read(path) {
            Ok(record) => {
                let verdict = verdict::explain(&record);
                text.push_str(&told::table(&record, &verdict));
                all.push(told::document(&record, &verdict));
            }
            Err(fault) => {
                eprintln!("{fault}");
                done = Done::Code(2);
            }
        }
    }
    if json {
        output::json_to_stdout(&all.into())?;
    } else {
        output::to_stdout(text.as_bytes())?;
    }
    Ok(done)
}
