//! The book is true: links lead somewhere, tutorials run, equations cited by the code exist.
#![cfg(feature = "cli")]

mod drift;

use std::path::{Path, PathBuf};
use std::process::Command;

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn files(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files(&path, extension));
        } else if path.extension().is_some_and(|e| e == extension) {
            found.push(path);
        }
    }
    found.sort();
    found
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap()
}

fn tread(folder: &Path, arguments: &[&str]) -> std::process::Output {
    Command::new(env!("CARGO_BIN_EXE_tread")).args(arguments).current_dir(folder).output().unwrap()
}

/// A folder of this test's own with the reference pages in it.
fn reference_pages(test: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("tread-docs-{test}-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    assert!(tread(&folder, &["reference", "reference"]).status.success());
    folder
}

/// The anchors that a page's headings make, as mdbook and code hosts write them: letters and digits in
/// lower case, blanks as hyphens, the rest dropped.
fn anchors(page: &Path) -> Vec<String> {
    let text = read(page);
    let headings = text.lines().filter(|l| l.starts_with('#'));
    let slug = |heading: &str| -> String {
        let name = heading.trim_start_matches('#').trim().to_lowercase();
        let kept = name.chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
        kept.map(|c| if c == ' ' { '-' } else { c }).collect()
    };
    headings.map(slug).collect()
}

#[test]
fn every_link_of_the_book_and_the_readme_leads_somewhere() {
    let pages = reference_pages("links");
    let book = root().join("docs/src");
    let mut documents = files(&book, "md");
    documents.extend(
        ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "ARCHITECTURE.md"].map(|f| root().join(f)),
    );
    let mut broken = Vec::new();
    for document in documents.iter().filter(|d| !d.starts_with(book.join("reference"))) {
        let text = read(document);
        for link in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let (target, anchor) = link.split_once('#').unwrap_or((link, ""));
            if target.contains("://") {
                continue;
            }
            let made = target
                .rsplit_once("reference/")
                .map(|(_, page)| pages.join("reference").join(page));
            let path = match target {
                "" => document.clone(),
                _ => made.unwrap_or_else(|| document.parent().unwrap().join(target)),
            };
            if !path.exists() || !anchor.is_empty() && !anchors(&path).contains(&anchor.into()) {
                broken.push(format!("{}: {link}", document.display()));
            }
        }
    }
    std::fs::remove_dir_all(pages).unwrap();
    assert!(broken.is_empty(), "broken links:\n{}", broken.join("\n"));
}

#[test]
fn every_page_of_the_book_is_in_its_table_of_contents() {
    let book = root().join("docs/src");
    let contents = read(&book.join("SUMMARY.md"));
    let pages = files(&book, "md");
    let pages = pages.iter().map(|p| p.strip_prefix(&book).unwrap().display().to_string());
    let lost: Vec<String> =
        pages.filter(|p| p != "SUMMARY.md" && !contents.contains(&format!("]({p})"))).collect();
    assert!(lost.is_empty(), "not in docs/src/SUMMARY.md: {lost:?}");
}

#[test]
fn the_shell_parts_of_the_tutorials_and_of_how_to_run() {
    for page in [
        "tutorials/slide",
        "tutorials/roll",
        "tutorials/wear",
        "tutorials/sweep",
        "tutorials/gap",
        "how-to",
    ] {
        let name = page.rsplit('/').next().unwrap();
        let text = read(&root().join(format!("docs/src/{page}.md")));
        let script: String =
            text.split("```sh\n").skip(1).filter_map(|part| part.split("```").next()).collect();
        let folder =
            std::env::temp_dir().join(format!("tread-tutorial-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let binary = Path::new(env!("CARGO_BIN_EXE_tread")).parent().unwrap();
        let path = format!("{}:{}", binary.display(), std::env::var("PATH").unwrap_or_default());
        let output = Command::new("bash")
            .args(["-euo", "pipefail", "-c", &script])
            .current_dir(&folder)
            .env("PATH", path)
            .output()
            .unwrap();
        let talk = String::from_utf8_lossy(&output.stderr).into_owned();
        std::fs::remove_dir_all(folder).unwrap();
        assert!(output.status.success(), "{name}:\n{script}\n{talk}");
    }
}

#[test]
fn every_equation_that_the_code_cites_is_in_the_theory() {
    let theory = read(&root().join("docs/src/theory.md"));
    let mut missing = Vec::new();
    for path in files(&root().join("src"), "rs") {
        let text = read(&path);
        for cited in text.split("theory eq").skip(1) {
            let end = cited.find(')').unwrap_or(0);
            let numbers = cited[..end].split(|c: char| !c.is_ascii_digit() && c != '.');
            for number in numbers.map(|n| n.trim_matches('.')).filter(|n| n.contains('.')) {
                if !theory.contains(&format!("({number})")) {
                    missing.push(format!("{}: eq. {number}", path.display()));
                }
            }
        }
    }
    assert!(missing.is_empty(), "not in docs/src/theory.md:\n{}", missing.join("\n"));
}

#[test]
fn every_effect_cites_its_equation() {
    let silent: Vec<String> = files(&root().join("src/effects"), "rs")
        .into_iter()
        .filter(|path| !["mod.rs", "fit.rs"].iter().any(|name| path.ends_with(name)))
        .filter(|path| !read(path).contains("theory eq"))
        .map(|path| path.display().to_string())
        .collect();
    assert!(silent.is_empty(), "without an equation of docs/src/theory.md: {silent:?}");
}
