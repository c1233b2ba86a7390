//! What the documents say of the command line is so. Their other claims are tested in `tests/docs`.

use crate::args::Args;
use clap::{CommandFactory, Parser};
use std::fs;
use std::path::{Path, PathBuf};

/// The chapters on the command line, in each language.
const CHAPTERS: [&str; 2] = ["docs/command-line.md", "docs/fr/command-line.md"];

/// Flags of clap itself, which every command has.
const OF_EVERY_COMMAND: [&str; 2] = ["help", "version"];

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The README and the guide, with their paths.
fn documents() -> Vec<(PathBuf, String)> {
    let mut directories = vec![repository().join("docs")];
    let mut found = vec![repository().join("README.md")];
    while let Some(directory) = directories.pop() {
        for entry in fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().path()) {
            match entry.extension() {
                _ if entry.is_dir() => directories.push(entry),
                Some(extension) if extension == "md" => found.push(entry),
                _ => {}
            }
        }
    }
    found.into_iter().map(|path| (path.clone(), fs::read_to_string(path).unwrap())).collect()
}

/// The command lines in a document's blocks of `sh` and `console`: what follows `lancer`, or `cargo run` of it.
fn command_lines(text: &str) -> Vec<Vec<String>> {
    let mut lines = Vec::new();
    let mut language = None;
    for line in text.lines() {
        match (line.strip_prefix("```"), language) {
            (Some(opened), None) => language = Some(opened),
            (Some(_), Some(_)) => language = None,
            (None, Some("sh")) => lines.push(line),
            (None, Some("console")) => lines.extend(line.strip_prefix("$ ")),
            _ => {}
        }
    }
    lines.into_iter().flat_map(commands_of_line).collect()
}

fn commands_of_line(line: &str) -> Vec<Vec<String>> {
    let words = shlex::split(line).unwrap_or_else(|| panic!("unclosed quotes: {line}"));
    let commands = words.split(|word| ["&&", "|", ";"].contains(&word.as_str()));
    let arguments = commands.filter_map(|command| {
        let command = command.split(|word| word == ">").next()?;
        let past_variables = command.iter().position(|word| !word.contains('='))?;
        let command = &command[past_variables..];
        let cargo_run = ["cargo", "run", "--release"];
        if command.first()? == "lancer" {
            Some(command[1..].to_vec())
        } else if command.len() >= 3
            && command[..3] == cargo_run
            && command.get(3).is_none_or(|word| word == "--")
        {
            Some(command.get(4..).unwrap_or_default().to_vec())
        } else {
            None
        }
    });
    arguments.collect()
}

#[test]
fn every_command_line_in_the_documents_is_understood() {
    let mut checked = 0;
    for (path, text) in documents() {
        for arguments in command_lines(&text) {
            checked += 1;
            let parsed = Args::try_parse_from(["lancer".to_owned()].iter().chain(&arguments));
            let wrong = parsed.err().filter(clap::Error::use_stderr);
            assert!(wrong.is_none(), "{}: {arguments:?}: {}", path.display(), wrong.unwrap());
        }
    }
    assert!(checked > 40, "only {checked} command lines were found");
}

#[test]
fn the_chapters_name_every_flag_of_every_command_in_its_section() {
    let program = Args::command();
    for chapter in CHAPTERS {
        let text = fs::read_to_string(repository().join(chapter)).unwrap();
        let sections = text.split("\n## ").skip(1).map(|section| section.split_once('\n').unwrap());
        let sections = sections.collect::<Vec<_>>();
        for command in program.get_subcommands() {
            let title = format!("lancer {}", command.get_name());
            let section = sections.iter().find(|(heading, _)| heading.split(", ").any(|part| part == title));
            let (_, section) = section.unwrap_or_else(|| panic!("{chapter} has no section `{title}`"));
            let flags = command.get_arguments().filter_map(clap::Arg::get_long);
            for flag in flags.filter(|flag| !OF_EVERY_COMMAND.contains(flag)) {
                assert!(has_flag(section, flag), "{chapter} does not name --{flag} of `{title}`");
            }
        }
    }
}

#[test]
fn the_chapters_name_no_flag_that_there_is_not() {
    let program = Args::command();
    let commands = || program.get_subcommands().chain([&program]);
    let is_known = |flag: &str| {
        OF_EVERY_COMMAND.contains(&flag)
            || commands().flat_map(clap::Command::get_arguments).any(|known| known.get_long() == Some(flag))
    };
    for chapter in CHAPTERS {
        let text = fs::read_to_string(repository().join(chapter)).unwrap();
        for flag in flags(&text) {
            assert!(is_known(flag), "{chapter} names --{flag}, which there is not");
        }
    }
}

/// The flags that a text names, without their hyphens.
fn flags(text: &str) -> impl Iterator<Item = &str> {
    let starts = text.match_indices("--").map(|(at, _)| at).filter(|&at| {
        text[..at].chars().next_back().is_none_or(|before| before == '`' || before == ' ' || before == '\n')
    });
    let names = starts.map(|at| {
        let name = &text[at + 2..];
        name.split(|c: char| !(c.is_ascii_lowercase() || c == '-')).next().unwrap_or("")
    });
    names.filter(|name| !name.is_empty() && !name.starts_with('-'))
}

fn has_flag(text: &str, flag: &str) -> bool {
    flags(text).any(|named| named == flag)
}
