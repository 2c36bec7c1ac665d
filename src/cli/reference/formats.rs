//! Pages on the formats of campaigns and diagnoses, from what reads and writes them: the documented fields
//! of the reader, its lists of names, the schema that tests hold every diagnosis against.

use std::fmt::Write;

use super::escape;
use crate::gap::campaign::CHANNELS;
use crate::gap::simulate::DATASHEET;

/// The reader of campaign files: its documented fields are the format.
const READER: &str = include_str!("../../gap/campaign/plan.rs");
/// The campaign after which `tread gap make-suite` makes its own.
const EXAMPLE: &str = include_str!("../../gap/suite/campaign_template.toml");
const SCHEMA: &str = include_str!("../../../docs/diagnosis.schema.json");

/// A field of a structure, or a variant of an enumeration, as its source documents it.
struct Item {
    name: String,
    doc: String,
    needed: bool,
}

/// The documented items of `what`, e.g. `struct Rig`.
fn items(what: &str) -> Vec<Item> {
    let body = READER.split(&format!("pub {what} {{\n")).nth(1).unwrap_or("");
    let body = body.split("\n}").next().unwrap_or("");
    let (mut out, mut doc, mut default) = (Vec::new(), String::new(), false);
    for line in body.lines().map(str::trim) {
        if let Some(text) = line.strip_prefix("/// ") {
            doc = format!("{doc} {text}");
        } else if line.starts_with("#[serde(default") {
            default = true;
        } else {
            let name = line.trim_start_matches("pub ").trim_end_matches(',');
            let (name, kind) = name.split_once(':').unwrap_or((name, ""));
            let doc = std::mem::take(&mut doc).trim().replace("\\[", "[").replace("\\]", "]");
            let needed = !std::mem::take(&mut default) && !kind.contains("Option<");
            out.push(Item { name: name.to_string(), doc, needed });
        }
    }
    out
}

/// `SpeedRamp` as files write it: `speed_ramp`.
fn snake(name: &str) -> String {
    let mut out = String::new();
    for letter in name.chars() {
        if letter.is_uppercase() && !out.is_empty() {
            out.push('_');
        }
        out.extend(letter.to_lowercase());
    }
    out
}

fn table(page: &mut String, structure: &str) {
    page.push_str("| key | | meaning |\n|---|---|---|\n");
    for item in items(&format!("struct {structure}")) {
        let needed = if item.needed { "needed" } else { "" };
        let _ = writeln!(page, "| `{}` | {needed} | {} |", item.name, escape(&item.doc));
    }
}

/// The page on campaign files.
pub fn campaigns() -> String {
    let mut page = String::from(
        "# Campaign files\n\nA campaign is a folder with `campaign.toml` and a CSV per run, or its zip \
         (`tread gap pack`). `tread gap import` makes one of a laboratory's files, `tread check` tells its \
         problems. Units stand in the names.\n\nTop: `format = \"tread-block-campaign/1\"` and `id`, the \
         campaign's name.\n",
    );
    for (name, structure) in [("[block]", "BlockSize"), ("[rig]", "Rig")] {
        let _ = write!(page, "\n## {name}\n\n");
        table(&mut page, structure);
    }
    page.push_str(
        "\n## [channels]\n\n`sampling_rate_hz`, and a table with `noise_std` (standard deviation of its \
         noise, in the unit of its name) for each channel that was measured; the runs have columns of \
         these names beside `time_s`.\n\n| channel | meaning |\n|---|---|\n",
    );
    let example: toml::Table = EXAMPLE.parse().unwrap_or_default();
    for channel in CHANNELS {
        let meaning =
            example.get("channels").and_then(|c| c.get(channel)?.get("meaning")?.as_str());
        let _ = writeln!(page, "| `{channel}` | {} |", escape(meaning.unwrap_or("")));
    }
    page.push_str(
        "\n## [nominal]\n\nThe compound's datasheet: `{ value, relative_std }`, median and relative \
         standard deviation.\n\n| key | [parameter](parameters.md) |\n|---|---|\n",
    );
    for (key, parameter) in DATASHEET {
        let _ = writeln!(page, "| `{key}` | `{parameter}` |");
    }
    page.push_str("\n## [[runs]]\n\n");
    table(&mut page, "RunSpec");
    page.push_str("\n| kind | meaning |\n|---|---|\n");
    for item in items("enum RunKind") {
        let _ = writeln!(page, "| `{}` | {} |", snake(&item.name), escape(&item.doc));
    }
    let start: Vec<&str> = EXAMPLE.split("\n[[runs]]").take(3).collect();
    let _ = write!(page, "\n## Example\n\n```toml\n{}\n```\n", start.join("\n[[runs]]").trim_end());
    page
}

/// The page on `diagnosis.json`.
pub fn diagnosis() -> String {
    let mut page = String::from(
        "# Diagnosis\n\nWhat `tread gap diagnose` writes as `diagnosis.json`, from its \
         [JSON schema](https://json-schema.org) in `docs/diagnosis.schema.json`. `[]` stands for each \
         item of a list.\n\n| field | type | meaning |\n|---|---|---|\n",
    );
    let schema: serde_json::Value = serde_json::from_str(SCHEMA).unwrap_or_default();
    rows(&schema, "", &mut page);
    page
}

/// A row for each property of an object, and those of what is in it.
fn rows(schema: &serde_json::Value, above: &str, page: &mut String) {
    for (name, inner) in schema["properties"].as_object().into_iter().flatten() {
        let name = format!("{above}{name}");
        let doc = inner["description"].as_str().unwrap_or("");
        let _ = writeln!(page, "| `{name}` | {} | {} |", kind(inner), escape(doc));
        rows(inner, &format!("{name}."), page);
        rows(&inner["items"], &format!("{name}[]."), page);
    }
}

fn kind(schema: &serde_json::Value) -> String {
    if let Some(choices) = schema["enum"].as_array() {
        let names: Vec<String> = choices.iter().map(|c| format!("`{c}`")).collect();
        return names.join(", ").replace('"', "");
    }
    if let Some(constant) = schema["const"].as_str() {
        return format!("`{constant}`");
    }
    match &schema["type"] {
        serde_json::Value::Array(types) => {
            types.iter().filter_map(|t| t.as_str()).collect::<Vec<_>>().join(" or ")
        }
        one => one.as_str().unwrap_or("").replace("array", "list").replace("object", "table"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gap::campaign::parse_plan;

    #[test]
    fn the_campaign_page_has_every_key_of_its_example_and_says_which_are_needed() {
        let (page, example) = (campaigns(), EXAMPLE.parse::<toml::Table>().unwrap());
        for table in ["block", "rig", "nominal"] {
            for key in example[table].as_table().unwrap().keys() {
                assert!(page.contains(&format!("| `{key}` |")), "{table}.{key}");
            }
        }
        // What the reader does without a needed key is told here by the reader itself.
        for (structure, table) in [("BlockSize", "block"), ("Rig", "rig")] {
            for item in items(&format!("struct {structure}")) {
                let mut less = example.clone();
                less[table].as_table_mut().unwrap().remove(&item.name);
                let refused = parse_plan(&less.to_string(), "campaign.toml").is_err();
                assert_eq!(refused, item.needed, "{table}.{}", item.name);
            }
        }
        for item in items("struct RunSpec") {
            let mut less = example.clone();
            let runs = less["runs"].as_array_mut().unwrap();
            // The third run is a plain sliding one, which needs what every run needs.
            runs[2].as_table_mut().unwrap().remove(&item.name);
            let text = parse_plan(&less.to_string(), "campaign.toml");
            let missing = text.is_err_and(|e| e.to_string().contains("missing field"));
            assert_eq!(missing, item.needed, "runs.{}", item.name);
        }
        assert!(page.contains("| `speed_ramp` | Road speed that changes linearly. |"));
    }

    #[test]
    fn the_diagnosis_page_has_the_fields_of_the_schema_with_a_meaning_each() {
        let page = diagnosis();
        for row in page.lines().filter(|l| l.starts_with("| `")) {
            assert!(row.split('|').all(|cell| cell != "  "), "{row}");
        }
        assert!(page.contains("| `hypotheses[].parameters[].std` | number |"));
    }
}
