//! The journal: a line per point that is done, from which a stopped sweep goes on.
//!
//! Its first line names the plan. Lines are appended whole and at once; a kill can only tear the last
//! one, which is then cut off and its point run again.

use std::fs::{File, OpenOptions};
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use serde_json::{json, Value};

use super::measures::COLUMNS;
use super::plan::Plan;
use crate::error::{Fault, Problem};

/// What became of a point.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// Number of the point, from 0.
    pub point: usize,
    /// Its measures, or why there are none.
    pub outcome: Result<[f64; COLUMNS.len()], String>,
}

impl Record {
    /// The line of the journal, with its end.
    pub fn line(&self) -> String {
        let value = match &self.outcome {
            Ok(measures) => json!({ "point": self.point, "measures": measures.to_vec() }),
            Err(reason) => json!({ "point": self.point, "reason": reason }),
        };
        format!("{value}\n")
    }

    /// Reads a line; `None` for a torn one. A measure that is not finite stands there as null.
    fn parse(line: &str) -> Option<Self> {
        let value: Value = serde_json::from_str(line).ok()?;
        let point = usize::try_from(value.get("point")?.as_u64()?).ok()?;
        let outcome = if let Some(reason) = value.get("reason") {
            Err(reason.as_str()?.to_string())
        } else {
            let measures = value.get("measures")?.as_array()?;
            let numbers: Vec<f64> =
                measures.iter().map(|m| m.as_f64().unwrap_or(f64::NAN)).collect();
            Ok(numbers.try_into().ok()?)
        };
        Some(Self { point, outcome })
    }
}

/// An open journal.
#[derive(Debug)]
pub struct Journal {
    file: File,
    path: PathBuf,
}

/// First line of a plan's journal, with its end.
pub fn header(plan: &Plan) -> String {
    let value = json!({
        "sweep": plan.fingerprint(),
        "points": plan.points.len(),
        "version": concat!(env!("CARGO_PKG_VERSION"), " ", env!("TREAD_REVISION")),
    });
    format!("{value}\n")
}

impl Journal {
    /// Opens the journal of `plan`: a new one, or with `resume` also one that is there, with the points
    /// in it.
    ///
    /// # Errors
    /// [`Fault::File`]; a journal that is there without `resume`, or of another plan or version.
    pub fn open(path: &Path, plan: &Plan, resume: bool) -> Result<(Self, Vec<Record>), Fault> {
        let failed = |e: std::io::Error| Fault::file(path, &e);
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(failed)?;
        }
        let mut file = OpenOptions::new()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(path)
            .map_err(failed)?;
        let bytes = std::fs::read(path).map_err(failed)?;
        if !bytes.is_empty() && !resume {
            return Err(Fault::one(Problem::new(
                "journal",
                path.display().to_string(),
                "none where a sweep starts",
                "--resume goes on with it; or name another --out",
            )));
        }
        let (whole, records) = read(&bytes, plan, path)?;
        file.set_len(whole as u64).map_err(failed)?;
        file.seek(SeekFrom::End(0)).map_err(failed)?;
        let mut journal = Self { file, path: path.to_path_buf() };
        if whole == 0 {
            journal.append(&header(plan))?;
        }
        Ok((journal, records))
    }

    /// Appends a line in one write.
    ///
    /// # Errors
    /// [`Fault::File`].
    pub fn append(&mut self, line: &str) -> Result<(), Fault> {
        self.file.write_all(line.as_bytes()).map_err(|e| Fault::file(&self.path, &e))
    }
}

/// Length of the whole lines and the records in them; of a point that is there twice the first.
fn read(bytes: &[u8], plan: &Plan, path: &Path) -> Result<(usize, Vec<Record>), Fault> {
    let mut lines = bytes.split_inclusive(|b| *b == b'\n').filter(|line| line.ends_with(b"\n"));
    let Some(first) = lines.next() else { return Ok((0, Vec::new())) };
    let expected = header(plan);
    if first != expected.as_bytes() {
        return Err(Fault::one(Problem::new(
            format!("{}", path.display()),
            String::from_utf8_lossy(first).trim(),
            format!("the journal of this plan by this version: {}", expected.trim()),
            "name another --out, or take plan and version of that sweep",
        )));
    }
    let mut whole = first.len();
    let mut seen = vec![false; plan.points.len()];
    let mut records = Vec::new();
    for line in lines {
        let record = std::str::from_utf8(line).ok().and_then(Record::parse);
        let Some(record) = record.filter(|r| r.point < seen.len()) else { break };
        whole += line.len();
        if !std::mem::replace(&mut seen[record.point], true) {
            records.push(record);
        }
    }
    Ok((whole, records))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_gives_back_every_bit() {
        // Numbers whose shortest decimal form is easy to read wrongly by one unit in the last place.
        let hard = [1.0 / 3.0, 5e-324, 1.797_693_134_862_315_7e308, 0.1 + 0.2, -0.0];
        let mut measures = [9.87654321e-7; COLUMNS.len()];
        measures[..5].copy_from_slice(&hard);
        let record = Record { point: 3, outcome: Ok(measures) };
        let back = Record::parse(&record.line()).unwrap().outcome.unwrap();
        assert_eq!(back.map(f64::to_bits), measures.map(f64::to_bits));
    }

    #[test]
    fn a_torn_line_is_no_record() {
        let record = Record { point: 7, outcome: Err("no convergence".to_string()) };
        let line = record.line();
        assert_eq!(Record::parse(&line), Some(record));
        assert_eq!(Record::parse(&line[..line.len() - 3]), None);
    }
}
