//! What has been read for one scene: its textures, each decoded once, and sums, by which many small files are bounded
//! together.

use lancer_core::scene::ImageTexture;
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// How many pixels textures may hold for each byte of the scene's files, all together. A photograph's byte stands for up to
/// ten pixels, a flat image's for hundreds, as a bomb's does. Untuned.
const PIXELS_PER_BYTE: u64 = 24;

/// Bytes of a pixel as it is held.
const BYTES_PER_PIXEL: u64 = 3;

/// Shared by a resolver and its copies.
#[derive(Debug, Default)]
pub(crate) struct Account(Mutex<Books>);

#[derive(Debug, Default)]
struct Books {
    /// Files that were read, each counted once whatever it was called.
    files: HashSet<PathBuf>,
    /// Their bytes.
    read: u64,
    /// Bytes that textures hold.
    held: u64,
    /// Textures by their files.
    textures: HashMap<PathBuf, Arc<ImageTexture>>,
}

impl Account {
    /// Counts a file that was read.
    pub(crate) fn read(&self, file: PathBuf, bytes: u64) {
        let mut books = self.books();
        if books.files.insert(file) {
            books.read = books.read.saturating_add(bytes);
        }
    }

    /// Counts bytes that a texture holds.
    pub(crate) fn hold(&self, bytes: u64) {
        let mut books = self.books();
        books.held = books.held.saturating_add(bytes);
    }

    /// The texture of a file, if it was kept.
    pub(crate) fn texture(&self, file: &Path) -> Option<Arc<ImageTexture>> {
        self.books().textures.get(file).cloned()
    }

    /// Keeps the texture of a file for the next who wants it.
    pub(crate) fn keep(&self, file: PathBuf, texture: &Arc<ImageTexture>) {
        self.books().textures.insert(file, Arc::clone(texture));
    }

    /// What is wrong with decoding `bytes` more of textures, of which one may have `most_pixels`.
    pub(crate) fn excess(&self, bytes: u64, most_pixels: u64) -> Option<String> {
        let Books { read, held, .. } = *self.books();
        let pixels = most_pixels.max(read.saturating_mul(PIXELS_PER_BYTE));
        let most = pixels.saturating_mul(BYTES_PER_PIXEL);
        let needed = held.saturating_add(bytes);
        (needed > most).then(|| {
            format!("with the other textures {needed} bytes are needed, more than {most}, the most for files of {read} bytes")
        })
    }

    fn books(&self) -> MutexGuard<'_, Books> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn textures_may_hold_as_much_as_one_or_as_their_files_are_worth() {
        let account = Account::default();
        assert_eq!(account.excess(300, 100), None);
        assert!(account.excess(301, 100).is_some());
        account.hold(200);
        assert!(account.excess(101, 100).is_some());
        account.read("a.png".into(), 30);
        account.read("a.png".into(), 30);
        assert_eq!(account.excess(30 * 24 * 3 - 200, 100), None);
        assert!(account.excess(30 * 24 * 3 - 199, 100).is_some());
    }
}
