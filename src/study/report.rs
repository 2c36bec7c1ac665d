//! What a study leaves: files, pictures, and a verdict per statement of the paper.

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
    /// Tables: file name and CSV.
    pub tables: Vec<(String, String)>,
    /// Pictures: file name and SVG.
    pub pictures: Vec<(String, String)>,
    /// Verdicts.
    pub verdicts: Vec<Verdict>,
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
    let mut out = String::from(HEAD);
    let all: Vec<&Verdict> = studies.iter().flat_map(|s| &s.verdicts).collect();
    let held = all.iter().filter(|v| v.holds).count();
    out.push_str(&format!(
        "<p>{held} of {} statements of the paper hold on this model with this compound.</p>\n",
        all.len()
    ));
    for study in studies {
        out.push_str(&format!(
            "<h2 id=\"{0}\">{0}: {1}</h2>\n<pre class=\"notes\">{2}</pre>\n",
            study.name,
            escape(study.title),
            escape(&study.notes)
        ));
        if !study.verdicts.is_empty() {
            out.push_str(
                "<table><tr><th>statement of the paper</th><th>holds</th><th>number</th></tr>\n",
            );
            for v in &study.verdicts {
                let (class, word) = if v.holds { ("yes", "yes") } else { ("no", "no") };
                out.push_str(&format!(
                    "<tr><td>{}</td><td class=\"{class}\">{word}</td><td>{}</td></tr>\n",
                    escape(&v.statement),
                    escape(&v.number)
                ));
            }
            out.push_str("</table>\n");
        }
        for (_, svg) in &study.pictures {
            out.push_str(&format!("<figure>{svg}</figure>\n"));
        }
        for (name, text) in &study.tables {
            if text.lines().count() <= 40 {
                out.push_str(&format!(
                    "<details open><summary>{name}</summary>{}</details>\n",
                    grid(text)
                ));
            } else {
                out.push_str(&format!("<p>Data: <code>{name}</code></p>\n"));
            }
        }
    }
    out.push_str(&format!(
        "<h2>Compound</h2><details><summary>all parameters</summary><pre>{}</pre></details>\n</body></html>\n",
        escape(compound)
    ));
    out
}

/// A CSV as an HTML table.
fn grid(csv: &str) -> String {
    let row = |line: &str, tag: &str| {
        let cells: String =
            line.split(',').map(|cell| format!("<{tag}>{}</{tag}>", escape(cell))).collect();
        format!("<tr>{cells}</tr>\n")
    };
    let mut lines = csv.lines();
    let head = lines.next().map_or_else(String::new, |line| row(line, "th"));
    let body: String = lines.map(|line| row(line, "td")).collect();
    format!("<table>{head}{body}</table>")
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

const HEAD: &str = "<!doctype html>
<html lang=\"en\"><head><meta charset=\"utf-8\"><title>The paper's studies</title>
<style>
body { font: 15px/1.5 sans-serif; max-width: 1280px; margin: 2em auto; padding: 0 1em; color: #222 }
table { border-collapse: collapse; margin: 0.6em 0 } td, th { border: 1px solid #ccc; padding: 2px 8px }
.yes { background: #d8f0e0 } .no { background: #f8d8d0 } figure { margin: 1em 0 }
pre.notes { font: inherit; white-space: pre-wrap } figure svg { max-width: 100%; height: auto } pre { font-size: 12px }
</style></head><body>
<h1>Influences on the vibration frequencies of tire tread blocks</h1>
<p>Kröger and Moldenhauer, ISMA 2010, repeated on this model. Dots are the paper's numbers.</p>
";
