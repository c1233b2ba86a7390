//! What a scene file only refers to: meshes and images, each a file named by what is in it.

use crate::image::encode::write_texture;
use crate::model::write_ply;
use crate::output::{WriteError, write_atomically};
use lancer_core::mesh::Mesh;
use lancer_core::scene::{ImageTexture, Scene, Shape, Texture};
use std::collections::HashMap;
use std::io::{self, Write};
use std::path::Path;
use std::sync::Arc;

/// A mesh or an image, by the reference to it in the scene file.
pub(super) enum Part {
    Mesh { reference: String, mesh: Arc<Mesh> },
    Image { reference: String, image: Arc<ImageTexture> },
}

impl Part {
    pub(super) fn reference(&self) -> &str {
        let (Self::Mesh { reference, .. } | Self::Image { reference, .. }) = self;
        reference
    }

    /// Writes the part into the directory of all parts, unless it is there already.
    pub(super) fn write(&self, directory: &Path) -> Result<(), WriteError> {
        let name = self.reference().rsplit('/').next().unwrap_or_default();
        let path = directory.join(name);
        if is_written(&path, self) {
            return Ok(());
        }
        write_atomically(&path, |out| self.encode(out))
    }

    fn encode(&self, out: impl Write) -> io::Result<()> {
        match self {
            Self::Mesh { mesh, .. } => write_ply(mesh, out),
            Self::Image { image, .. } => write_texture(image, out),
        }
    }
}

/// Whether a file holds just what the part would be written as.
fn is_written(path: &Path, part: &Part) -> bool {
    let mut expected = Vec::new();
    part.encode(&mut expected).is_ok() && std::fs::read(path).is_ok_and(|found| found == expected)
}

/// The parts of a scene, each once.
#[derive(Default)]
pub(super) struct Parts {
    parts: Vec<Part>,
    /// Indices by extension and hash of what is in the file.
    by_content: HashMap<(&'static str, u64), usize>,
    /// Indices by the address of what is shared.
    by_address: HashMap<usize, usize>,
}

impl Parts {
    /// The parts of `scene`, in a folder of that name.
    ///
    /// # Errors
    /// One cannot be encoded.
    pub(super) fn of(scene: &Scene, folder: &str) -> io::Result<Self> {
        let mut parts = Self::default();
        for node in scene.nodes() {
            if let Some(Shape::Mesh(mesh)) = &node.shape {
                let part = |reference| Part::Mesh { reference, mesh: Arc::clone(mesh) };
                parts.add(address(mesh), "ply", part, folder, &node.name)?;
            }
        }
        for material in scene.materials() {
            if let Texture::Image { image, .. } = &material.color {
                let part = |reference| Part::Image { reference, image: Arc::clone(image) };
                parts.add(address(image), "png", part, folder, &material.name)?;
            }
        }
        Ok(parts)
    }

    /// Adds what lies at an address, unless it or its like is there.
    fn add(
        &mut self,
        address: usize,
        extension: &'static str,
        part: impl Fn(String) -> Part,
        folder: &str,
        name: &str,
    ) -> io::Result<()> {
        if self.by_address.contains_key(&address) {
            return Ok(());
        }
        let mut hash = Fnv::default();
        part(String::new()).encode(&mut hash)?;
        let next = self.parts.len();
        let index = *self.by_content.entry((extension, hash.0)).or_insert(next);
        if index == next {
            let name = file_name(name);
            self.parts.push(part(format!("{folder}/{name}-{:016x}.{extension}", hash.0)));
        }
        self.by_address.insert(address, index);
        Ok(())
    }

    pub(super) fn is_empty(&self) -> bool {
        self.parts.is_empty()
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = &Part> {
        self.parts.iter()
    }

    /// The reference of a mesh of the scene.
    pub(super) fn mesh(&self, mesh: &Arc<Mesh>) -> &str {
        self.parts[self.by_address[&address(mesh)]].reference()
    }

    /// The reference of an image of the scene.
    pub(super) fn image(&self, image: &Arc<ImageTexture>) -> &str {
        self.parts[self.by_address[&address(image)]].reference()
    }
}

fn address<T>(shared: &Arc<T>) -> usize {
    Arc::as_ptr(shared).addr()
}

/// A name that every file system takes, of what an author chose.
fn file_name(name: &str) -> String {
    /// Longest part of a name that is kept: file systems take 255 bytes in all.
    const LONGEST: usize = 40;
    let kept = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).take(LONGEST);
    let kept = kept.collect::<String>().to_ascii_lowercase();
    match kept.trim_matches('-') {
        "" => "part".to_owned(),
        trimmed => trimmed.to_owned(),
    }
}

/// A hash that is the same everywhere and for good, of bytes that nobody forges. Source: Fowler, Noll and Vo's 1a.
struct Fnv(u64);

impl Default for Fnv {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Write for Fnv {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        for &byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_files_are_plain() {
        assert_eq!(file_name("Utah Teapot/2"), "utah-teapot-2");
        assert_eq!(file_name("../.."), "part");
        assert_eq!(file_name(&"x".repeat(300)).len(), 40);
    }

    #[test]
    fn the_hash_is_the_published_one() {
        let mut hash = Fnv::default();
        hash.write_all(b"foobar").unwrap();
        assert_eq!(hash.0, 0x8594_4171_f739_67e8);
    }
}
