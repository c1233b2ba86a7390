//! Boxes of objects and of trees.

use super::palette::Palette;
use super::pen::{Pen, Style};
use lancer_core::geometry::DVec3;
use lancer_core::world::{ObjectId, World};

/// More boxes than these are one mass of lines, and take long.
const MOST_OBJECTS: usize = 500;

/// The same for a level of a tree.
const MOST_CELLS: usize = 2000;

/// As many can be told apart line by line.
const FEW_CELLS: usize = 100;

/// The boxes of objects, each turned with its object.
pub(super) fn draw_bounds(pen: &mut Pen, palette: &Palette, world: &World, selected: &[ObjectId]) {
    let known = selected.iter().filter(|id| id.index() < world.objects().len());
    let corners = known.filter_map(|&id| world.object_corners(id)).take(MOST_OBJECTS).collect::<Vec<_>>();
    let style = Style { color: palette.selection, casing: Some(palette.casing), ..STYLE };
    draw(pen, &corners, style);
}

/// A level of the trees of the selected meshes; of the tree over the objects where none is selected. Where that has too
/// many boxes, the deepest level above that has not.
pub(super) fn draw_tree(pen: &mut Pen, palette: &Palette, world: &World, selected: &[ObjectId], level: u32) {
    let boxes_at = |level| {
        let known = selected.iter().filter(|id| id.index() < world.objects().len());
        let of_meshes = known.flat_map(|&id| world.mesh_tree_boxes(id, level, MOST_CELLS + 1));
        let boxes = of_meshes.take(MOST_CELLS + 1).collect::<Vec<_>>();
        if boxes.is_empty() { world.objects_tree_boxes(level, MOST_CELLS + 1) } else { boxes }
    };
    let mut level = level;
    let mut boxes = boxes_at(level);
    while boxes.len() > MOST_CELLS && level > 0 {
        level -= 1;
        boxes = boxes_at(level);
    }
    // The casings of many lines would hide the picture.
    let casing = (boxes.len() <= FEW_CELLS).then_some(palette.casing);
    let alpha = if casing.is_some() { STYLE.alpha } else { 0.6 };
    draw(pen, &boxes, Style { color: palette.tree, casing, alpha, ..STYLE });
}

/// But for its colours.
const STYLE: Style = Style { color: [0; 3], casing: None, alpha: 0.9, width: 1.25 };

fn draw(pen: &mut Pen, boxes: &[[DVec3; 8]], style: Style) {
    pen.draw(style, |strokes| {
        for corners in boxes {
            // An edge joins two corners whose places, in the order of `Bounds::corners`, differ in one bit.
            for (corner, axis) in (0..8).flat_map(|corner| [1, 2, 4].map(|axis| (corner, axis))) {
                if corner & axis == 0 {
                    strokes.line(corners[corner], corners[corner | axis]);
                }
            }
        }
    });
}
