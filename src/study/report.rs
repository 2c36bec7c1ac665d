//! What a study leaves: files, pictures, and a verdict per statement of the paper.

use crate::page::{self, escape};
use serde_json::{json, Value};

/// A statement of the paper and what our model says to it.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// The statement.
    pub statement: String,
    /// Does our model agree?
    pub holds: bool,
    /// The number that says so.
    pub number: String,
}

impl Verdict {
    /// A verdict.
    pub fn new(statement: impl Into<String>, holds: bool, number: impl Into<String>) -> Self {
        Self { statement: statement.into(), holds, number: number.into() }
    }

    /// As one line: `amplitude falls with E: yes, -62 %`.
    pub fn line(&self) -> String {
        let answer = if self.holds { "yes" } else { "no" };
        format!("{}: {answer}, {}", self.statement, self.number)
    }
}

/// All that one study leaves.
#[derive(Clone, Debug)]
pub struct Study {
    /// Name as the command line takes it, e.g. `fig-5`.
    pub name: &'static str,
    /// What it shows.
    pub title: &'static str,
    /// What to know when reading it.
    pub notes: String,
    /// Tables: file name and CSV, or text as people read it.
    pub tables: Vec<(String, String)>,
    /// Pictures: file name and SVG.
    pub pictures: Vec<(String, String)>,
    /// Verdicts.
    pub verdicts: Vec<Verdict>,
}

impl Study {
    /// What the study says, for programs; tables and pictures by the names of their files.
    pub fn document(&self) -> Value {
        let names = |files: &[(String, String)]| -> Vec<String> {
            files.iter().map(|(name, _)| name.clone()).collect()
        };
        let verdicts: Vec<Value> = self
            .verdicts
            .iter()
            .map(|v| json!({"statement": v.statement, "holds": v.holds, "number": v.number}))
            .collect();
        json!({
            "study": self.name,
            "title": self.title,
            "notes": self.notes,
            "files": names(&self.tables).into_iter().chain(names(&self.pictures)).collect::<Vec<_>>(),
            "verdicts": verdicts,
        })
    }
}

/// CSV from a header and rows of numbers.
pub fn csv(header: &str, rows: impl IntoIterator<Item = Vec<f64>>) -> String {
    let mut out = format!("{header}\n");
    for row in rows {
        let cells: Vec<String> = row.iter().map(|x| format!("{x}")).collect();
        out.push_str(&cells.join(","));
        out.push('\n');
    }
    out
}

/// Relative change in per cent with its sign.
pub fn change(from: f64, to: f64) -> String {
    format!("{:+.0} %", 100.0 * (to / from - 1.0))
}

/// All studies as one page without anything outside of it.
pub fn html(studies: &[Study], compound: &str) -> String {
    let mut out = page::head("Influences on the vibration frequencies of tire tread blocks");
    out.push_str(
        "<p>Kröger and Moldenhauer, ISMA 2010, repeated on this model. Dots are the paper's numbers.</p>\n",
    );
    let all: Vec<&Verdict> = studies.iter().flat_map(|s| &s.verdicts).collect();
    let held = all.iter().filter(|v| v.holds).count();
    out.push_str(&format!(
        "<p>{held} of {} statements of the paper hold on this model with this compound.</p>\n",
        all.len()
    ));
    out.extend(studies.iter().map(section));
    out.push_str(&format!(
        "<h2>Compound</h2><details><summary>all parameters</summary><pre>{}</pre></details>\n",
        escape(compound)
    ));
    out.push_str(page::TAIL);
    out
}

/// One study: notes, statements, pictures, tables.
fn section(study: &Study) -> String {
    let mut out = format!(
        "<h2 id=\"{0}\">{0}: {1}</h2>\n<pre class=\"notes\">{2}</pre>\n",
        study.name,
        escape(study.title),
        escape(&study.notes)
    );
    if !study.verdicts.is_empty() {
        out.push_str(&page::wide("Statements", &statements(&study.verdicts)));
    }
    for (name, svg) in &study.pictures {
        let picture = page::picture(svg, &format!("{}: {}", study.title, name));
        out.push_str(&format!("<figure>{}</figure>\n", page::wide(name, &picture)));
    }
    out.extend(study.tables.iter().map(|(name, text)| table(name, text)));
    out
}

/// What the model says to the paper's statements, as an HTML table.
fn statements(verdicts: &[Verdict]) -> String {
    let head = page::columns(&["statement of the paper", "holds", "number"]);
    let row = |v: &Verdict| {
        let answer = if v.holds { "yes" } else { "no" };
        format!(
            "<tr><td>{}</td><td class=\"{answer}\">{answer}</td><td class=\"words\">{}</td></tr>\n",
            escape(&v.statement),
            escape(&v.number)
        )
    };
    let rows: String = verdicts.iter().map(row).collect();
    format!("<table>{head}{rows}</table>")
}

/// A table's file: text as it is, a short CSV as an HTML table, a long one by its name only.
fn table(name: &str, text: &str) -> String {
    if name.ends_with(".txt") {
        page::wide(name, &format!("<pre>{}</pre>", escape(text)))
    } else if text.lines().count() <= 40 {
        let grid = page::wide(name, &grid(text));
        format!("<details open><summary>{name}</summary>{grid}</details>\n")
    } else {
        format!("<p>Data: <code>{name}</code></p>\n")
    }
}

/// A number with the four digits that people read; other text as it is. The CSV beside the page has all digits.
fn readable(cell: &str) -> String {
    match cell.parse::<f64>() {
        Ok(x) if x == 0.0 || (1e-3..1e6).contains(&x.abs()) => {
            let digits = if x == 0.0 { 0 } else { (3 - x.abs().log10().floor() as i32).max(0) };
            let text = format!("{x:.*}", digits as usize);
            if text.contains('.') {
                text.trim_end_matches('0').trim_end_matches('.').to_string()
            } else {
                text
            }
        }
        Ok(x) => format!("{x:.3e}"),
        Err(_) => cell.to_string(),
    }
}

/// A CSV as an HTML table.
fn grid(csv: &str) -> String {
    let row = |line: &str| {
        let cells: String =
            line.split(',').map(|cell| format!("<td>{}</td>", escape(&readable(cell)))).collect();
        format!("<tr>{cells}</tr>\n")
    };
    let mut lines = csv.lines();
    let head = lines
        .next()
        .map_or_else(String::new, |line| page::columns(&line.split(',').collect::<Vec<_>>()));
    let body: String = lines.map(row).collect();
    format!("<table>{head}{body}</table>")
}

#[cfg(test)]
mod tests {
    use super::readable;

    #[test]
    fn numbers_of_tables_have_four_digits() {
        let told =
            ["0.0005925", "0.0016079187", "2633.0227", "250000", "0", "0.05", "-1.25", "lost"];
        let read = ["5.925e-4", "0.001608", "2633", "250000", "0", "0.05", "-1.25", "lost"];
        assert_eq!(told.map(readable), read);
    }
}
