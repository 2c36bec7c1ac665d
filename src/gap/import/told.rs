//! What an import did to every channel.

use serde::Serialize;
use std::fmt::Write;

/// What was done to a channel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChannelTold {
    /// Name in the campaign.
    pub channel: &'static str,
    /// Column of the logger's file.
    pub from: String,
    /// SI value of one count.
    pub scale: f64,
    /// The logger's rate \[Hz\].
    pub rate: f64,
    /// Instant of the file's time that became 0 \[s\].
    pub shift: f64,
    /// Samples taken as they are; if not, values of a cubic spline through them.
    pub copied: bool,
    /// Largest distance of a row from a sample \[s\].
    pub distance: f64,
    /// What the rows do not hold, rms over the record's rms about its mean.
    pub lost: f64,
    /// Rows written.
    pub rows: usize,
}

/// What was done to a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RunTold {
    /// File of the campaign.
    pub file: String,
    /// File of the logger.
    pub from: String,
    /// Was the file read as Latin-1?
    pub latin_1: bool,
    /// First row that the record covers; 0 is the start.
    pub first_row: usize,
    /// Duration \[s\], and whether it is the record's because the plan gives none.
    pub duration: (f64, bool),
    /// Columns that no channel uses.
    pub unused: Vec<String>,
    /// Channels.
    pub channels: Vec<ChannelTold>,
}

/// What was done to a campaign.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Imported {
    /// Rate of the campaign \[Hz\].
    pub rate: f64,
    /// Runs.
    pub runs: Vec<RunTold>,
}

impl Imported {
    /// As JSON.
    pub fn json(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }

    /// As a table for people.
    pub fn table(&self) -> String {
        let mut out = String::new();
        for run in &self.runs {
            let _ = writeln!(out, "{}  from {}", run.file, run.from);
            for c in &run.channels {
                let what = if c.copied {
                    format!("samples copied, at most {:.3} µs from their rows", 1e6 * c.distance)
                } else {
                    let lost = 100.0 * c.lost;
                    format!(
                        "resampled to {} Hz by cubic spline, {lost:.3} % of rms lost",
                        self.rate
                    )
                };
                let _ = writeln!(
                    out,
                    "  {:<20} {} x {}, {:.6} Hz, {} s became 0: {what}",
                    c.channel, c.from, c.scale, c.rate, c.shift
                );
            }
            let mut note = |text: String| _ = writeln!(out, "  note: {text}");
            if run.latin_1 {
                note("read as Latin-1: it is no UTF-8".into());
            }
            if run.first_row > 0 {
                note(format!("begins {} rows after the start", run.first_row));
            }
            if run.duration.1 {
                note(format!("duration_s = {}, as far as all channels go", run.duration.0));
            }
            if !run.unused.is_empty() {
                note(format!("columns that no channel uses: {}", run.unused.join(", ")));
            }
        }
        out
    }
}
