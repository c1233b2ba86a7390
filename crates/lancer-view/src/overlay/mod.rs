//! What is drawn over the picture: grid, axes, lights, boxes, the selection's outline, the point of interest.
//!
//! In comes what is seen at each pixel, in any resolution; out goes a picture of lines to lay over the rendered one.
//! Lines behind surfaces are faint, so that both what is where and what is before it can be read. The room knows no
//! window: lines are drawn by plain code, the same on every machine.

mod boxes;
mod canvas;
mod grid;
mod lens;
mod lights;
mod outline;
mod palette;
mod pen;
mod surfaces;
#[cfg(test)]
mod tests;

use canvas::Canvas;
use grid::Grid;
use lancer_core::camera::Camera;
use lancer_core::geometry::{DVec2, DVec3};
use lancer_core::render::Features;
use lancer_core::world::{ObjectId, World};
use lens::Lens;
use palette::Palette;
use pen::{Pen, Style};
use serde::{Deserialize, Serialize};
use surfaces::Surfaces;

/// Which overlays are shown. What is selected is outlined in any case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct OverlayOptions {
    /// The plane y = 0 in squares, a power of ten wide, as fits the distance one looks from.
    pub grid: bool,
    /// X, Y and Z through the origin.
    pub axes: bool,
    /// A mark at each light.
    pub lights: bool,
    /// A box around each selected object.
    pub bounds: bool,
    /// The boxes of this level of the selected meshes' trees, or of the tree over the objects.
    pub tree_level: Option<u32>,
    /// A cross at the point of interest.
    pub interest: bool,
}

impl Default for OverlayOptions {
    fn default() -> Self {
        Self { grid: false, axes: false, lights: false, bounds: false, tree_level: None, interest: true }
    }
}

/// All that the overlays follow from.
#[derive(Clone, Copy, Debug)]
pub struct OverlayInput<'a> {
    /// The scene.
    pub world: &'a World,
    /// What the camera sees of it, in any resolution.
    pub features: &'a Features,
    /// Through which it is seen.
    pub camera: &'a Camera,
    /// Pixels in a row of the viewport.
    pub width: u32,
    /// Rows of the viewport.
    pub height: u32,
    /// What to show.
    pub options: &'a OverlayOptions,
    /// The selected objects.
    pub selected: &'a [ObjectId],
    /// The selected light, by its place in the world's list.
    pub selected_light: Option<usize>,
    /// The point of interest.
    pub interest: DVec3,
    /// How many pixels a point of the screen has: 1, or 2 on a fine one.
    pub pixels_per_point: f32,
    /// Bright lines on dark casings, as a dark picture needs them; else the other way about, for a bright picture.
    pub dark: bool,
}

/// Colours to lay over a picture. Shape: `pixels: [height * width]`, top row first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OverlayImage {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Red, green and blue in sRGB, multiplied by alpha as they are, and alpha.
    pub pixels: Vec<[u8; 4]>,
}

/// Draws the overlays. Through a camera that is not valid, nothing is seen.
pub fn draw(input: &OverlayInput) -> OverlayImage {
    let OverlayInput { world, features, camera, width, height, options, selected, .. } = *input;
    let canvas = Canvas::new(width, height);
    let lens = Lens::new(camera, width, height);
    let surfaces = Surfaces::new(features, camera, width, height);
    let (Ok(lens), Ok(surfaces)) = (lens, surfaces) else { return canvas.into_image() };
    let points_are_sensible = (0.25..=16.0).contains(&input.pixels_per_point);
    let scale = if points_are_sensible { f64::from(input.pixels_per_point) } else { 1.0 };
    let mut pen = Pen { canvas, lens, surfaces, scale };
    let palette = Palette::of_theme(input.dark);

    if options.grid
        && let Some(grid) = Grid::for_view(camera.eye, input.interest)
    {
        grid.draw(&mut pen, palette);
    }
    if options.axes {
        grid::draw_axes(&mut pen, palette);
    }
    if let Some(level) = options.tree_level {
        boxes::draw_tree(&mut pen, palette, world, selected, level);
    }
    if options.bounds {
        boxes::draw_bounds(&mut pen, palette, world, selected);
    }
    if options.lights {
        lights::draw(&mut pen, palette, world.lights(), input.selected_light);
    }
    if !selected.is_empty() {
        outline::draw(&mut pen, palette, world, features, selected);
    }
    if options.interest {
        draw_interest(&mut pen, palette, input.interest);
    }
    pen.canvas.into_image()
}

/// From where to where the arms of the cross at the point of interest reach, in points.
const ARMS: [f64; 2] = [3.0, 8.0];

fn draw_interest(pen: &mut Pen, palette: &Palette, interest: DVec3) {
    let style = Style { color: palette.interest, casing: Some(palette.casing), alpha: 0.9, width: 1.5 };
    pen.draw(style, |strokes| {
        for arm in [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y] {
            strokes.mark(interest, ARMS.map(|reach| arm * reach));
        }
    });
}
