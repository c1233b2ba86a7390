//! Pictures on the screen: which part of one is seen, its texture, and what lies under the cursor.

mod image_view;
mod readout;
mod texture;

pub use image_view::ImageView;
pub use readout::{Readout, SurfaceReadout, Taken};
pub use texture::{PictureTexture, color_image};
