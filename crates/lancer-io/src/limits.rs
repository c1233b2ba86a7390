//! How much a file may ask for.

/// The bounds that keep a hostile file from taking the machine. Each is checked before anything is allocated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// The longest file that is read, in bytes.
    pub file_bytes: u64,
    /// The most triangles of one model.
    pub triangles: usize,
    /// The most pixels of one texture.
    pub texture_pixels: u64,
    /// The most nodes of a scene file's syntax tree, aliases expanded.
    pub syntax_nodes: usize,
    /// The deepest nesting of a scene file.
    pub nesting: usize,
    /// The most errors told of one file; beyond it the rest are only counted.
    pub errors: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            file_bytes: 8 << 30,
            triangles: 200_000_000,
            texture_pixels: 1 << 26,
            syntax_nodes: 4_000_000,
            nesting: 200,
            errors: 50,
        }
    }
}
