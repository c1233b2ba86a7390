//! Rust in the documents: it stands, word for word, in a file that is compiled.

use crate::pages::{all, files_below, repository};
use std::fs;
use std::path::PathBuf;

#[test]
fn every_block_of_rust_stands_in_an_example_or_a_test() {
    let compiled = sources().iter().map(|path| fs::read_to_string(path).unwrap()).collect::<Vec<_>>();
    let pages = all();
    let blocks = pages.iter().flat_map(|page| &page.blocks).filter(|block| block.language == "rust");
    let mut checked = 0;
    for block in blocks {
        checked += 1;
        let is_compiled = compiled.iter().any(|source| contains_lines(source, &block.text));
        assert!(is_compiled, "{}: no example or test holds this code:\n{}", block.place, block.text);
    }
    assert!(checked >= 4, "only {checked} blocks of Rust were found");
}

/// The examples and the tests of all crates.
fn sources() -> Vec<PathBuf> {
    let crates = repository().join("crates");
    let is_compiled = |path: &PathBuf| {
        let mut parts = path.strip_prefix(&crates).unwrap().iter().skip(1);
        parts.next().is_some_and(|part| part == "examples" || part == "tests")
    };
    files_below(&crates, "rs").into_iter().filter(is_compiled).collect()
}

/// Whether the lines of `part` follow one another in `whole`, perhaps all indented further.
fn contains_lines(whole: &str, part: &str) -> bool {
    let (whole, part): (Vec<_>, Vec<_>) = (whole.lines().collect(), part.lines().collect());
    let indented = |line: &str, indent: &str, by: &str| {
        (line.is_empty() && by.is_empty()) || line.strip_prefix(indent) == Some(by)
    };
    whole.windows(part.len()).any(|window| {
        let Some(indent) = window[0].strip_suffix(part[0]) else { return false };
        indent.trim().is_empty() && window.iter().zip(&part).all(|(line, by)| indented(line, indent, by))
    })
}

#[test]
fn lines_are_found_where_they_follow_one_another() {
    let whole = "fn main() {\n    let a = 1;\n\n    if a > 0 {\n        run();\n    }\n}\n";
    assert!(contains_lines(whole, "let a = 1;\n\nif a > 0 {\n    run();\n}"));
    assert!(contains_lines(whole, whole));
    for wrong in
        ["let a = 2;", "let a = 1;\nif a > 0 {", "if a > 0 {\nrun();", "a = 1;", "fn main() {\nlet a = 1;"]
    {
        assert!(!contains_lines(whole, wrong), "{wrong}");
    }
}
