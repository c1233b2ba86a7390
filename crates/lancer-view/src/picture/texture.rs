//! An image as textures: tone applied, cut to what the graphics driver takes.

use eframe::egui::{
    Color32, ColorImage, Context, ImageData, Pos2, Rect, TextureHandle, TextureOptions, Ui, pos2, vec2,
};
use lancer_core::film::{Image, Tone};
use std::sync::Arc;

/// Texels along the side of one texture; every driver takes this much.
const SIDE: u32 = 2048;

/// An image on the screen.
pub struct PictureTexture {
    width: u32,
    height: u32,
    parts: Vec<Part>,
}

/// A part of the image, no larger than a texture may be.
struct Part {
    x: u32,
    y: u32,
    texture: TextureHandle,
}

impl PictureTexture {
    /// Textures of an image; those of `previous` are used again where they fit.
    ///
    /// `smooth` blends between pixels that are shown larger than they are; without, they are squares.
    pub fn new(ctx: &Context, image: &Image, tone: Tone, smooth: bool, previous: Option<Self>) -> Self {
        let magnified = if smooth { TextureOptions::LINEAR } else { TextureOptions::NEAREST };
        let options = TextureOptions { minification: TextureOptions::LINEAR.minification, ..magnified };
        let whole = Arc::new(color_image(image, tone));
        let (width, height) = (image.width(), image.height());
        let mut old = previous.map_or_else(Vec::new, |previous| previous.parts).into_iter();
        let mut parts = Vec::new();
        for y in (0..height).step_by(SIDE as usize) {
            for x in (0..width).step_by(SIDE as usize) {
                let (w, h) = (SIDE.min(width - x), SIDE.min(height - y));
                let part = if (w, h) == (width, height) {
                    Arc::clone(&whole)
                } else {
                    Arc::new(whole.region_by_pixels([x as usize, y as usize], [w as usize, h as usize]))
                };
                let part = ImageData::Color(part);
                let texture = match old.next() {
                    Some(Part { mut texture, .. }) => {
                        texture.set(part, options);
                        texture
                    }
                    None => ctx.load_texture("picture", part, options),
                };
                parts.push(Part { x, y, texture });
            }
        }
        Self { width, height, parts }
    }

    /// Paints the whole image into a rectangle.
    pub fn paint(&self, ui: &Ui, rect: Rect) {
        let scale = rect.size() / vec2(self.width as f32, self.height as f32);
        let uv = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
        for Part { x, y, texture } in &self.parts {
            let [w, h] = texture.size();
            let min = rect.min + vec2(*x as f32, *y as f32) * scale;
            let part = Rect::from_min_size(min, vec2(w as f32, h as f32) * scale);
            ui.painter().image(texture.id(), part, uv, Color32::WHITE);
        }
    }
}

/// A linear image as egui takes one: with its tone, opaque.
pub fn color_image(image: &Image, tone: Tone) -> ColorImage {
    let size = [image.width() as usize, image.height() as usize];
    ColorImage::from_rgb(size, tone.to_codes8(image).as_flattened())
}
