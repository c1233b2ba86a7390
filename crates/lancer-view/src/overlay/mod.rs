//! What is drawn over the picture.

use serde::{Deserialize, Serialize};

/// What is drawn over the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct OverlayOptions {
    /// The plane y = 0, in squares.
    pub grid: bool,
    /// The three axes through the origin.
    pub axes: bool,
    /// Where the lights are.
    pub lights: bool,
    /// Boxes around what is selected.
    pub bounds: bool,
    /// The boxes of one level of the trees.
    pub tree_level: Option<u32>,
    /// The point of interest.
    pub interest: bool,
}

impl Default for OverlayOptions {
    fn default() -> Self {
        Self { grid: false, axes: false, lights: false, bounds: false, tree_level: None, interest: true }
    }
}

/// Colours to lay over a picture. Shape: `pixels: [height * width]`, top row first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OverlayImage {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// sRGB and how much it covers, the colours already multiplied by it.
    pub pixels: Vec<[u8; 4]>,
}
