//! Links and pictures.

use crate::pages::{all, files_below, repository};
use std::collections::BTreeSet;
use std::path::{Component, Path, PathBuf};

#[test]
fn every_link_and_picture_leads_somewhere() {
    let pages = all();
    let mut checked = 0;
    let mut broken = Vec::new();
    for page in &pages {
        for link in page.links.iter().filter(|link| is_relative(&link.target)) {
            checked += 1;
            let (file, anchor) = link.target.split_once('#').unwrap_or((&link.target, ""));
            let to = if file.is_empty() { page.path.clone() } else { beside(&page.path, file) };
            if !repository().join(&to).exists() {
                broken.push(format!("{}: there is no `{}`", link.place, to.display()));
            } else if !anchor.is_empty() {
                let target = pages.iter().find(|other| other.path == to);
                if !target.is_some_and(|target| target.anchors.iter().any(|known| known == anchor)) {
                    broken.push(format!("{}: `{}` has no heading `#{anchor}`", link.place, to.display()));
                }
            }
        }
    }
    assert!(checked > 100, "only {checked} links were found");
    assert!(broken.is_empty(), "\n{}", broken.join("\n"));
}

/// In the book `.md` becomes `.html`, also where a link leaves the book; and it has no pages of its own for directories.
#[test]
fn links_hold_in_the_book_as_they_do_in_the_repository() {
    let docs = Path::new("docs");
    let mut broken = Vec::new();
    for page in all().iter().filter(|page| page.path.starts_with(docs)) {
        for link in page.links.iter().filter(|link| is_relative(&link.target)) {
            let file = link.target.split('#').next().unwrap();
            let to = beside(&page.path, file);
            let is_page = Path::new(file).extension().is_some_and(|extension| extension == "md");
            if is_page && !to.starts_with(docs) {
                broken.push(format!("{}: link to its directory in place of `{file}`", link.place));
            }
            if !file.is_empty() && to.starts_with(docs) && repository().join(&to).is_dir() {
                broken.push(format!("{}: link to a page in place of the directory `{file}`", link.place));
            }
        }
    }
    assert!(broken.is_empty(), "\n{}", broken.join("\n"));
}

#[test]
fn every_chapter_stands_in_the_table_of_contents() {
    let pages = all();
    let summary = pages.iter().find(|page| page.path == Path::new("docs/SUMMARY.md")).unwrap();
    let listed =
        summary.links.iter().map(|link| beside(&summary.path, &link.target)).collect::<BTreeSet<_>>();
    let chapters = pages.iter().map(|page| page.path.clone()).filter(|path| path.starts_with("docs"));
    let missing = chapters.filter(|path| path != &summary.path && !listed.contains(path));
    assert_eq!(missing.collect::<Vec<_>>(), Vec::<PathBuf>::new());
}

#[test]
fn every_picture_is_shown_somewhere() {
    let pages = all();
    let links = pages.iter().flat_map(|page| page.links.iter().map(|link| beside(&page.path, &link.target)));
    let shown = links.collect::<BTreeSet<_>>();
    let root = repository();
    for extension in ["png", "svg"] {
        for picture in files_below(&root.join("docs/images"), extension) {
            let picture = picture.strip_prefix(&root).unwrap();
            assert!(shown.contains(picture), "no document shows {}", picture.display());
        }
    }
}

fn is_relative(target: &str) -> bool {
    !target.contains("://") && !target.starts_with("mailto:")
}

/// The path that `link`, written in the file `from`, leads to, from the root of the repository.
fn beside(from: &Path, link: &str) -> PathBuf {
    let mut path = from.parent().unwrap().to_owned();
    for part in Path::new(link).components() {
        match part {
            Component::ParentDir => assert!(path.pop(), "{}: `{link}` leaves the repository", from.display()),
            Component::CurDir => {}
            part => path.push(part),
        }
    }
    path
}
