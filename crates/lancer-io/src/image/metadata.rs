//! What a file says about its picture beside the pixels.

/// What a file says about itself. A format leaves out what it has no place for; PFM has none at all.
///
/// `docs/images.md` says where each format holds what.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Metadata {
    /// The program that made it.
    pub software: String,
    /// What the picture shows: the scene's name; may be empty.
    pub title: String,
    /// How the picture was made, in ASCII on one line: see [`Provenance`](crate::provenance::Provenance).
    pub provenance: Option<String>,
    /// Pixels to the inch in print.
    pub dpi: Option<u16>,
}

impl Default for Metadata {
    fn default() -> Self {
        Self {
            software: concat!("Lancer ", env!("CARGO_PKG_VERSION")).to_owned(),
            title: String::new(),
            provenance: None,
            dpi: None,
        }
    }
}

impl Metadata {
    /// Pixels to the metre, as PNG counts them.
    pub(super) fn pixels_per_metre(&self) -> Option<u32> {
        // An inch is 0.0254 m.
        self.dpi.map(|dpi| (f64::from(dpi) / 0.0254).round() as u32)
    }
}
