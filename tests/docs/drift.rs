//! What is written by hand keeps up with the code: commands, options, make's goals, pictures, effects, fields.

use std::path::{Path, PathBuf};

use serde_json::Value;

use super::{files, read, reference_pages, root};

/// Pages that people read: the book but its generated part, and the texts at the top.
fn pages() -> Vec<PathBuf> {
    let book = root().join("docs/src");
    let mut pages = files(&book, "md");
    pages.retain(|page| !page.starts_with(book.join("reference")));
    pages.extend(["README.md", "CONTRIBUTING.md", "ARCHITECTURE.md"].map(|f| root().join(f)));
    pages
}

/// Commands of `program` on a page: in blocks of code, with `$` or without, and in backticks.
fn commands(text: &str, program: &str) -> Vec<String> {
    let text = text.replace("\\\n", " ");
    let lines = text.lines().map(|l| l.trim_start().trim_start_matches("$ ").to_string());
    let quoted = text.split('`').skip(1).step_by(2).map(|q| q.replace('\n', " "));
    let start = format!("{program} ");
    let found = lines.chain(quoted).filter(|l| l.starts_with(&start));
    found.map(|l| l.split(['#', '|', '`', '>']).next().unwrap_or("").trim().to_string()).collect()
}

#[test]
fn every_command_and_option_that_a_page_shows_exists() {
    let folder = reference_pages("commands");
    let help = read(&folder.join("reference/command-line.md"));
    std::fs::remove_dir_all(folder).unwrap();
    let (mut unknown, mut seen) = (Vec::new(), 0);
    for page in pages() {
        for command in commands(&read(&page), "tread") {
            let words: Vec<&str> = command.split_whitespace().collect();
            // `tread gap diagnose` before `tread gap`: the longest that has a heading.
            let named = (1..=words.len().min(3)).rev().map(|n| words[..n].join(" "));
            let section = named.filter_map(|name| {
                help.split(&format!("\n## {name}\n")).nth(1)?.split("\n## ").next()
            });
            let Some(section) = section.into_iter().next() else { continue };
            let is_command = words.len() > 1 && help.contains(&format!("## tread {}\n", words[1]));
            let general = words.len() > 1 && words[1].starts_with('-');
            if !is_command && !general {
                unknown.push(format!("{}: {command}", page.display()));
            }
            for word in words.iter().filter(|w| w.starts_with("--")) {
                let option =
                    word.split('=').next().unwrap_or(word).trim_end_matches([',', '.', ')']);
                seen += 1;
                if !section.contains(option) {
                    unknown.push(format!("{}: {option} in {command}", page.display()));
                }
            }
        }
    }
    assert!(unknown.is_empty(), "not in the command line:\n{}", unknown.join("\n"));
    assert!(seen > 30, "only {seen} options found: is the search still right?");
}

#[test]
fn every_goal_of_make_that_a_page_names_exists_and_has_its_line_of_help() {
    let makefile = read(&root().join("Makefile"));
    let has = |goal: &str| makefile.lines().any(|l| l.starts_with(&format!("{goal}: ##")));
    let mut unknown = Vec::new();
    for page in pages() {
        for command in commands(&read(&page), "make") {
            let goal = command.split_whitespace().nth(1).unwrap_or("");
            if !has(goal.trim_end_matches([',', '.', ';'])) {
                unknown.push(format!("{}: {command}", page.display()));
            }
        }
    }
    assert!(unknown.is_empty(), "not in the Makefile:\n{}", unknown.join("\n"));
}

#[test]
fn every_picture_is_made_by_docs_pictures_sh_and_shown_on_a_page() {
    let script = read(&root().join("docs/pictures.sh"));
    let shown: String = pages().iter().map(|page| read(page)).collect();
    let images = std::fs::read_dir(root().join("docs/src/images")).unwrap();
    for image in images.map(|entry| entry.unwrap().file_name().into_string().unwrap()) {
        assert!(script.contains(&image), "docs/pictures.sh does not make {image}");
        assert!(shown.contains(&format!("images/{image})")), "no page shows {image}");
    }
}

#[test]
fn the_page_on_effects_names_every_effect_its_forms_and_what_a_fit_varies() {
    let page = read(&root().join("docs/src/effects.md"));
    for spec in tread_block::effects::fit_specs() {
        let row = page.lines().find(|l| l.starts_with(&format!("| `{}` |", spec.effect)));
        let row = row.unwrap_or_else(|| panic!("{} has no row", spec.effect));
        assert!(row.contains(&format!("| {} |", spec.module.name())), "{row}");
        for form in spec.forms.iter().filter(|form| !form.name.is_empty()) {
            assert!(row.contains(&format!("`{}`", form.name)), "{}: {row}", form.name);
        }
        let severity = spec.forms[0].params[0].name.rsplit('.').next().unwrap();
        assert!(row.contains(severity), "{severity}: {row}");
    }
}

/// Every field of a diagnosis that the schema does not know.
fn unknown(schema: &Value, value: &Value, at: &str, found: &mut Vec<String>) {
    match value {
        Value::Object(fields) => {
            // A table without listed fields, such as `models`, is free.
            let Some(known) = schema["properties"].as_object() else { return };
            for (name, inner) in fields {
                match known.get(name) {
                    Some(schema) => unknown(schema, inner, &format!("{at}.{name}"), found),
                    None => found.push(format!("{at}.{name}")),
                }
            }
        }
        Value::Array(items) => {
            items
                .iter()
                .for_each(|item| unknown(&schema["items"], item, &format!("{at}[]"), found));
        }
        _ => {}
    }
}

#[test]
fn the_schema_knows_every_field_of_the_committed_diagnoses() {
    let parse = |path: &Path| serde_json::from_str::<Value>(&read(path)).unwrap();
    let schema = parse(&root().join("docs/diagnosis.schema.json"));
    let answers = files(&root().join("tests/data/sealed-a-answers"), "json");
    assert!(!answers.is_empty());
    for path in answers {
        let mut found = Vec::new();
        unknown(&schema, &parse(&path), "", &mut found);
        assert!(found.is_empty(), "{}: {found:?}", path.display());
    }
}
