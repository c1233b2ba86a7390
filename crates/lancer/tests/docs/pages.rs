//! The documents, taken apart.

use pulldown_cmark::{CodeBlockKind, Event, LinkType, Options, Parser, Tag, TagEnd};
use std::fs;
use std::path::{Path, PathBuf};

/// A Markdown file.
pub(crate) struct Page {
    /// Its path from the root of the repository.
    pub(crate) path: PathBuf,
    pub(crate) blocks: Vec<Block>,
    pub(crate) links: Vec<Link>,
    /// What can stand after `#` in a link to it.
    pub(crate) anchors: Vec<String>,
}

/// A block of code.
pub(crate) struct Block {
    /// Where it stands: `docs/start.md:12`.
    pub(crate) place: String,
    pub(crate) language: String,
    pub(crate) text: String,
}

/// A link or a picture.
pub(crate) struct Link {
    /// Where it stands.
    pub(crate) place: String,
    /// Where it leads, as written.
    pub(crate) target: String,
}

/// The root of the repository.
pub(crate) fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().unwrap()
}

/// All documents: those beside the README, the guide, and those of the crates.
pub(crate) fn all() -> Vec<Page> {
    let root = repository();
    let mut files = files_below(&root.join("docs"), "md");
    files.extend(files_in(&root).into_iter().filter(|path| has_extension(path, "md")));
    for room in files_in(&root.join("crates")) {
        files.extend(files_in(&room).into_iter().filter(|path| has_extension(path, "md")));
    }
    files.sort();
    files.iter().map(|file| Page::read(file.strip_prefix(&root).unwrap())).collect()
}

/// The files with an extension in a directory and below.
pub(crate) fn files_below(directory: &Path, extension: &str) -> Vec<PathBuf> {
    let (directories, files): (Vec<_>, Vec<_>) =
        files_in(directory).into_iter().partition(|path| path.is_dir());
    let here = files.into_iter().filter(|path| has_extension(path, extension));
    here.chain(directories.iter().flat_map(|directory| files_below(directory, extension))).collect()
}

fn files_in(directory: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(directory).unwrap_or_else(|error| panic!("{}: {error}", directory.display()));
    entries.map(|entry| entry.unwrap().path()).collect()
}

fn has_extension(path: &Path, extension: &str) -> bool {
    path.extension().is_some_and(|found| found == extension)
}

impl Page {
    fn read(path: &Path) -> Self {
        let text = fs::read_to_string(repository().join(path)).unwrap();
        let mut page = Self { path: path.to_owned(), blocks: vec![], links: vec![], anchors: vec![] };
        let place =
            |offset: usize| format!("{}:{}", path.display(), text[..offset].matches('\n').count() + 1);
        let mut heading = None;
        let mut in_block = false;
        for (event, range) in Parser::new_ext(&text, Options::ENABLE_TABLES).into_offset_iter() {
            match event {
                Event::Start(Tag::CodeBlock(CodeBlockKind::Fenced(language))) => {
                    let (place, language) = (place(range.start), language.to_string());
                    page.blocks.push(Block { place, language, text: String::new() });
                    in_block = true;
                }
                Event::End(TagEnd::CodeBlock) => in_block = false,
                Event::Text(part) if in_block => {
                    page.blocks.last_mut().unwrap().text.push_str(&part);
                }
                // Of `<https://...>` nothing can be wrong here.
                Event::Start(Tag::Link { link_type, dest_url, .. }) if link_type != LinkType::Autolink => {
                    page.links.push(Link { place: place(range.start), target: dest_url.to_string() });
                }
                Event::Start(Tag::Image { dest_url, .. }) => {
                    page.links.push(Link { place: place(range.start), target: dest_url.to_string() });
                }
                Event::Start(Tag::Heading { .. }) => heading = Some(String::new()),
                Event::Text(part) | Event::Code(part) if heading.is_some() => {
                    heading.as_mut().unwrap().push_str(&part);
                }
                Event::End(TagEnd::Heading(_)) => page.anchor(&heading.take().unwrap()),
                _ => {}
            }
        }
        page
    }

    /// A heading as GitHub and mdBook name it: a second one of the same words gets a number.
    fn anchor(&mut self, heading: &str) {
        let kept = |c: &char| c.is_alphanumeric() || matches!(c, '-' | '_' | ' ');
        let slug = heading.trim().to_lowercase().chars().filter(kept).collect::<String>().replace(' ', "-");
        let same = |anchor: &&String| {
            let number = anchor.strip_prefix(&slug).map(|rest| rest.strip_prefix('-').unwrap_or(rest));
            number.is_some_and(|number| number.is_empty() || number.parse::<u32>().is_ok())
        };
        match self.anchors.iter().filter(same).count() {
            0 => self.anchors.push(slug),
            earlier => self.anchors.push(format!("{slug}-{earlier}")),
        }
    }
}
