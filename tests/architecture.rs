//! ARCHITECTURE.md is true: its paths exist, imports run downwards, files stay small.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Most lines of a source file, its tests not counted.
const MOST_LINES: usize = 300;

/// Files that are longer, with the length that they may have; the aim is to split them.
const LONGER: &[(&str, usize)] = &[];

/// Most lines of a function.
const MOST_LINES_OF_FUNCTION: usize = 55;

/// Functions that are longer, by file and name, with the length that they may have; the aim is to split them.
const LONGER_FUNCTIONS: &[(&str, &str, usize)] = &[("src/dynamics/equilibrium.rs", "settle", 56)];

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn architecture() -> String {
    std::fs::read_to_string(root().join("ARCHITECTURE.md")).unwrap()
}

/// All Rust files below `folder`.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// A file without its unit tests.
fn code(path: &Path) -> String {
    let text = std::fs::read_to_string(path).unwrap();
    if path.file_name().is_some_and(|n| n == "tests.rs") {
        return String::new();
    }
    text.split("#[cfg(test)]\nmod tests").next().unwrap_or("").to_string()
}

/// Ranks of the modules, from the table in ARCHITECTURE.md.
fn ranks() -> BTreeMap<String, u32> {
    architecture()
        .lines()
        .filter_map(|line| {
            let mut cells = line.split('|').map(str::trim).skip(1);
            let rank = cells.next()?.parse().ok()?;
            let module = cells.next()?.trim_matches('`').strip_prefix("src/")?;
            Some((module.trim_end_matches(".rs").to_string(), rank))
        })
        .collect()
}

/// Module to which a source file belongs: `src/params/table.rs` → `params`.
fn module(path: &Path) -> String {
    let inside = path.strip_prefix(root().join("src")).unwrap();
    let first = inside.components().next().unwrap().as_os_str().to_string_lossy().into_owned();
    first.trim_end_matches(".rs").to_string()
}

/// Modules named in `use crate::…` lines, braces included.
fn imports(code: &str) -> Vec<String> {
    let mut found = Vec::new();
    for line in code.lines().map(str::trim) {
        let Some(rest) = line.trim_start_matches("pub ").strip_prefix("use crate::") else {
            continue;
        };
        let names = rest.trim_start_matches('{').split(',');
        let whole = rest.starts_with('{');
        for name in names.take(if whole { usize::MAX } else { 1 }) {
            let first = name.trim().split([':', ';', '}', ' ']).next().unwrap_or("");
            if !first.is_empty() {
                found.push(first.to_string());
            }
        }
    }
    found
}

/// Name of the function whose head begins in this line.
fn function_name(line: &str) -> Option<&str> {
    let mut words = line.split(['(', '<', ' ']).filter(|word| !word.is_empty());
    let modifier = |word: &&str| {
        ["pub", "crate)", "super)", "const", "unsafe", "extern", "\"C\""].contains(word)
    };
    words.by_ref().find(|word| !modifier(word)).filter(|word| *word == "fn")?;
    words.next()
}

/// Name and number of lines of every function, from its head to the brace that closes it.
fn functions(code: &str) -> Vec<(&str, usize)> {
    let lines: Vec<&str> = code.lines().collect();
    let mut found = Vec::new();
    for (at, line) in lines.iter().enumerate() {
        let Some(name) = function_name(line) else { continue };
        // The style of rustfmt: head, end of the arguments and closing brace are indented alike.
        let indent = &line[..line.len() - line.trim_start().len()];
        let alike =
            |other: &str| other.strip_prefix(indent).is_some_and(|rest| !rest.starts_with(' '));
        let end = lines[at..].iter().position(|other| alike(other) && other.ends_with(['}', ';']));
        found.extend(end.map(|end| (name, end + 1)));
    }
    found
}

#[test]
fn every_path_that_the_architecture_names_exists() {
    let text = architecture();
    let paths = text.split('`').filter(|word| {
        ["src/", "tests/", "examples/", "demo/"].iter().any(|folder| word.starts_with(folder))
    });
    for path in paths {
        assert!(root().join(path).exists(), "ARCHITECTURE.md names {path}, which does not exist");
    }
}

#[test]
fn imports_run_downwards_only() {
    let ranks = ranks();
    assert!(ranks.len() > 10, "the table of ARCHITECTURE.md could not be read: {ranks:?}");
    let mut wrong = Vec::new();
    for path in sources(&root().join("src")) {
        let from = module(&path);
        if ["lib", "main"].contains(&from.as_str()) {
            continue;
        }
        let Some(rank) = ranks.get(&from) else {
            wrong.push(format!("{from} is not in the table of ARCHITECTURE.md: add it"));
            continue;
        };
        for to in imports(&code(&path)) {
            // A type re-exported at the top (Params, Fault) belongs to a low module.
            let Some(other) = ranks.get(&to) else { continue };
            // Effects are a branch of the parameters: the two know each other.
            if other > rank || (other == rank && from != to && *rank != 1) {
                wrong.push(format!("{}: {from} uses {to}", path.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "imports against the direction:\n{}", wrong.join("\n"));
}

#[test]
fn files_stay_small_and_code_does_not_unwrap() {
    let mut wrong = Vec::new();
    for path in sources(&root().join("src")) {
        let code = code(&path);
        let name = path.strip_prefix(root()).unwrap().display();
        let longer = LONGER.iter().find(|(file, _)| name.to_string() == *file);
        let most = longer.map_or(MOST_LINES, |(_, lines)| *lines);
        if code.lines().count() > most {
            wrong.push(format!("{name}: more than {most} lines"));
        }
        let statements = code.lines().enumerate().filter(|(_, l)| !l.trim().starts_with("//"));
        for (number, line) in statements {
            if line.contains(".unwrap()") {
                wrong.push(format!("{name}:{}: unwrap outside of a test", number + 1));
            }
            if line.contains("unsafe ") && module(&path) != "fmi" && !line.contains("unsafe_code") {
                wrong.push(format!("{name}:{}: unsafe outside of src/fmi", number + 1));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn functions_fit_on_a_screen() {
    let (mut wrong, mut seen) = (Vec::new(), 0);
    for path in sources(&root().join("src")) {
        let file = path.strip_prefix(root()).unwrap().display().to_string();
        for (name, lines) in functions(&code(&path)) {
            seen += 1;
            let longer = LONGER_FUNCTIONS.iter().find(|(f, n, _)| *f == file && *n == name);
            let most = longer.map_or(MOST_LINES_OF_FUNCTION, |(_, _, lines)| *lines);
            if lines > most {
                wrong.push(format!("{file}: {name} has {lines} lines, more than {most}"));
            }
        }
    }
    assert!(seen > 1000, "only {seen} functions of src could be read");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
