//! Campaigns in one file each: a zip whose CSV files are kept as columns of whole numbers.
//!
//! A column is one line: its name, its number of decimals `d`, `v` or `c`, and numbers; values times 10^d
//! (`v`) or their changes from row to row (`c`, the first from 0), whichever is shorter. Nothing is
//! lost: the numbers of the CSV come back digit by digit, but for trailing zeros.

use crate::error::Fault;
use std::collections::BTreeMap;
use std::io::{Cursor, Read, Write};
use std::path::{Path, PathBuf};

/// Most decimals that a column may have.
const MOST_DECIMALS: usize = 12;
/// Ending of a packed CSV within the zip.
const COLUMNS: &str = ".columns";

/// Where a campaign's files are.
#[derive(Clone, Debug)]
pub enum Source {
    /// A folder.
    Folder(PathBuf),
    /// A zip, unpacked.
    Packed(BTreeMap<String, Vec<u8>>),
}

impl Source {
    /// A folder, or a zip made by [`pack`].
    ///
    /// # Errors
    /// A zip that cannot be read.
    pub fn open(path: &Path) -> Result<Self, Fault> {
        if path.is_file() {
            let bytes = std::fs::read(path).map_err(|e| Fault::file(path, &e))?;
            let files = unpack(&bytes).map_err(|reason| Fault::unusable(path, reason))?;
            return Ok(Self::Packed(files));
        }
        Ok(Self::Folder(path.to_path_buf()))
    }

    /// The bytes of a file of the campaign.
    ///
    /// # Errors
    /// What the system says, or that there is no such file.
    pub fn bytes(&self, file: &str) -> Result<Vec<u8>, String> {
        match self {
            Self::Folder(folder) => std::fs::read(folder.join(file)).map_err(|e| e.to_string()),
            Self::Packed(files) => {
                files.get(file).cloned().ok_or_else(|| "is not in the packed campaign".to_string())
            }
        }
    }
}

/// Packs the files `names` of a campaign's folder.
///
/// # Errors
/// Files that cannot be read, or cells that are no decimal numbers.
pub fn pack(folder: &Path, names: &[String]) -> Result<Vec<u8>, Fault> {
    let mut zip = zip::ZipWriter::new(Cursor::new(Vec::new()));
    let options = zip::write::SimpleFileOptions::default()
        .compression_level(Some(9))
        .last_modified_time(zip::DateTime::default());
    for name in names {
        let path = folder.join(name);
        let text = std::fs::read_to_string(&path).map_err(|e| Fault::file(&path, &e))?;
        let (name, text) = match name.strip_suffix(".csv") {
            Some(stem) => {
                let columns = to_columns(&text).ok_or_else(|| {
                    Fault::unusable(&path, "holds cells that are no plain numbers")
                })?;
                (format!("{stem}{COLUMNS}"), columns)
            }
            None => (name.clone(), text),
        };
        zip.start_file(name, options).map_err(|e| Fault::unusable(&path, e))?;
        zip.write_all(text.as_bytes()).map_err(|e| Fault::file(&path, &e))?;
    }
    Ok(zip.finish().map_err(|e| Fault::unusable(folder, e))?.into_inner())
}

fn unpack(bytes: &[u8]) -> Result<BTreeMap<String, Vec<u8>>, String> {
    let mut zip = zip::ZipArchive::new(Cursor::new(bytes)).map_err(|e| e.to_string())?;
    let mut out = BTreeMap::new();
    for at in 0..zip.len() {
        let mut entry = zip.by_index(at).map_err(|e| e.to_string())?;
        let name = entry.name().map_err(|e| e.to_string())?.to_string();
        let mut text = String::new();
        entry.read_to_string(&mut text).map_err(|e| e.to_string())?;
        match name.strip_suffix(COLUMNS) {
            Some(stem) => {
                let csv = from_columns(&text).ok_or_else(|| format!("{name} is damaged"))?;
                out.insert(format!("{stem}.csv"), csv.into_bytes());
            }
            None => _ = out.insert(name, text.into_bytes()),
        }
    }
    Ok(out)
}

/// Columns of whole numbers from the text of a CSV.
fn to_columns(csv: &str) -> Option<String> {
    let mut lines = csv.lines().filter(|l| !l.trim().is_empty());
    let header: Vec<&str> = lines.next()?.split(',').map(str::trim).collect();
    let rows: Vec<Vec<&str>> = lines.map(|l| l.split(',').map(str::trim).collect()).collect();
    let mut out = String::new();
    for (at, name) in header.iter().enumerate() {
        let cells: Option<Vec<&str>> = rows.iter().map(|r| r.get(at).copied()).collect();
        let cells = cells?;
        let decimals = |c: &str| c.split_once('.').map_or(0, |(_, d)| d.len());
        let most = cells.iter().map(|c| decimals(c)).max().unwrap_or(0);
        if most > MOST_DECIMALS {
            return None;
        }
        let values: Option<Vec<i64>> = cells.iter().map(|c| whole(c, most)).collect();
        let values = values?;
        let mut last = 0;
        let changes: Vec<i64> = values
            .iter()
            .map(|v| {
                let change = v - last;
                last = *v;
                change
            })
            .collect();
        let line = |n: &[i64]| n.iter().map(i64::to_string).collect::<Vec<_>>().join(" ");
        let (values, changes) = (line(&values), line(&changes));
        let (kind, numbers) =
            if changes.len() < values.len() { ('c', changes) } else { ('v', values) };
        out.push_str(&format!("{name} {most} {kind} {numbers}\n"));
    }
    Some(out)
}

/// A plain decimal number times 10^`decimals`.
fn whole(cell: &str, decimals: usize) -> Option<i64> {
    let (sign, digits) = match cell.strip_prefix('-') {
        Some(rest) => (-1, rest),
        None => (1, cell),
    };
    let (before, after) = digits.split_once('.').unwrap_or((digits, ""));
    let zeros = "0".repeat(decimals.checked_sub(after.len())?);
    format!("{before}{after}{zeros}").parse::<i64>().ok().map(|n| sign * n)
}

/// The text of a CSV from its columns.
fn from_columns(text: &str) -> Option<String> {
    let mut columns: Vec<(String, Vec<String>)> = Vec::new();
    for line in text.lines() {
        let mut words = line.split(' ');
        let name = words.next()?.to_string();
        let decimals: usize = words.next()?.parse().ok().filter(|d| *d <= MOST_DECIMALS)?;
        let changes = words.next()? == "c";
        let mut last = 0_i64;
        let mut cells = Vec::new();
        for word in words {
            let number: i64 = word.parse().ok()?;
            last = if changes { last.checked_add(number)? } else { number };
            cells.push(plain(last, decimals));
        }
        columns.push((name, cells));
    }
    let rows = columns.first()?.1.len();
    if columns.iter().any(|c| c.1.len() != rows) {
        return None;
    }
    let names: Vec<&str> = columns.iter().map(|c| c.0.as_str()).collect();
    let mut out = names.join(",") + "\n";
    for row in 0..rows {
        let cells: Vec<&str> = columns.iter().map(|c| c.1[row].as_str()).collect();
        out.push_str(&cells.join(","));
        out.push('\n');
    }
    Some(out)
}

/// A whole number over 10^`decimals` as a plain decimal number without trailing zeros.
fn plain(number: i64, decimals: usize) -> String {
    let sign = if number < 0 { "-" } else { "" };
    let digits = format!("{:0>width$}", number.unsigned_abs(), width = decimals + 1);
    let (before, after) = digits.split_at(digits.len() - decimals);
    let after = after.trim_end_matches('0');
    if after.is_empty() {
        format!("{sign}{before}")
    } else {
        format!("{sign}{before}.{after}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packing_loses_no_digit() {
        let csv =
            "time_s,force_n,x_m\n0.0000001,-0.106,-0.000019729\n0.00004,56,0\n0.00008,1.25,3\n";
        assert_eq!(from_columns(&to_columns(csv).unwrap()).unwrap(), csv);
    }

    #[test]
    fn what_is_no_plain_number_is_refused() {
        assert!(to_columns("a\nnan\n").is_none());
        assert!(to_columns("a,b\n1\n").is_none());
    }
}
