//! Boxes of objects and of trees.

use super::palette::{Color, Palette};
use super::pen::{Pen, Style};
use lancer_core::geometry::DVec3;
use lancer_core::world::{ObjectId, World};

/// More boxes than these are one mass of lines, and take long.
const MOST_OBJECTS: usize = 500;

/// The same for a level of a tree.
const MOST_CELLS: usize = 4000;

/// The boxes of objects, each turned with its object.
pub(super) fn draw_bounds(pen: &mut Pen, palette: &Palette, world: &World, selected: &[ObjectId]) {
    let known = selected.iter().filter(|id| id.index() < world.objects().len());
    let corners = known.filter_map(|&id| world.object_corners(id)).take(MOST_OBJECTS).collect::<Vec<_>>();
    draw(pen, &corners, palette.selection, palette.casing);
}

/// A level of the trees of the selected meshes; of the tree over the objects where none is selected.
pub(super) fn draw_tree(pen: &mut Pen, palette: &Palette, world: &World, selected: &[ObjectId], level: u32) {
    let mut boxes = Vec::new();
    for &id in selected.iter().filter(|id| id.index() < world.objects().len()) {
        boxes.extend(world.mesh_tree_boxes(id, level, MOST_CELLS - boxes.len()));
    }
    if boxes.is_empty() {
        boxes = world.objects_tree_boxes(level, MOST_CELLS);
    }
    draw(pen, &boxes, palette.tree, palette.casing);
}

fn draw(pen: &mut Pen, boxes: &[[DVec3; 8]], color: Color, casing: Color) {
    let style = Style { color, casing: Some(casing), alpha: 0.85, width: 1.25 };
    pen.draw(style, |strokes| {
        for corners in boxes {
            for [a, b] in EDGES {
                strokes.line(corners[a], corners[b]);
            }
        }
    });
}

/// The edges of a box: the pairs of its corners, in the order of `Bounds::corners`, that differ in one bit.
const EDGES: [[usize; 2]; 12] = [
    [0, 1],
    [2, 3],
    [4, 5],
    [6, 7], // along x
    [0, 2],
    [1, 3],
    [4, 6],
    [5, 7], // along y
    [0, 4],
    [1, 5],
    [2, 6],
    [3, 7], // along z
];
