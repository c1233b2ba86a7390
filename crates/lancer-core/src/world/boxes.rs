//! The boxes of objects and trees in the world, to be looked at.
//!
//! Shape: a box is its eight corners, in the order of [`Bounds::corners`]; it may be turned and sheared.

use super::geometry::TriangleIndex;
use super::{Object, ObjectId, ObjectIndex, World};
use crate::accel::Aabb;
use crate::accel::bvh::{boxes_around_all, boxes_at};
use crate::geometry::{Bounds, DVec3};

impl World {
    /// A box around an object; unbounded where the object is.
    ///
    /// # Panics
    /// Where `id` is of another world and out of range here, as all that ask for an object.
    pub fn object_bounds(&self, id: ObjectId) -> Bounds {
        let object = self.object(id);
        object.placement.bounds_to_world(object.geometry.bounds(&self.meshes))
    }

    /// The corners of an object's own box, which turns with it; none where it is unbounded.
    pub fn object_corners(&self, id: ObjectId) -> Option<[DVec3; 8]> {
        let object = self.object(id);
        let bounds = object.geometry.bounds(&self.meshes);
        bounds.is_finite().then(|| corners_in_world(object, &bounds))
    }

    /// The boxes at a level of the tree over the objects, the root's being 0: at most `most`. Those of leaves that
    /// end above the level are left out. None where there is no tree.
    pub fn objects_tree_boxes(&self, level: u32, most: usize) -> Vec<[DVec3; 8]> {
        let boxes = match &self.index {
            _ if self.bounded.is_empty() => Vec::new(),
            ObjectIndex::Bvh(tree) => boxes_at(tree.nodes(), tree.bounds(), level, most),
            ObjectIndex::Kd(tree) => tree.cells_at(level, most),
            ObjectIndex::None => Vec::new(),
        };
        boxes.iter().map(|aabb| aabb.to_bounds().corners()).collect()
    }

    /// The same of the tree over the triangles of an object's mesh. None where the object has no mesh.
    pub fn mesh_tree_boxes(&self, id: ObjectId, level: u32, most: usize) -> Vec<[DVec3; 8]> {
        let object = self.object(id);
        let Some(mesh) = object.geometry.mesh_index() else { return Vec::new() };
        let boxes = match &self.meshes[mesh].index {
            TriangleIndex::Bvh(tree) => tree.boxes_at(level, most),
            TriangleIndex::Kd(tree) => tree.cells_at(level, most),
            TriangleIndex::None => Vec::new(),
        };
        boxes.iter().map(|aabb| corners_in_world(object, &aabb.to_bounds())).collect()
    }

    /// At most `most` boxes, which together hold all objects; none where an object has no bounds.
    pub(crate) fn boxes_around_all(&self, most: usize) -> Option<Vec<[DVec3; 8]>> {
        if !self.unbounded.is_empty() {
            return None;
        }
        if self.bounded.len() > most / 2 {
            let boxes = match &self.index {
                ObjectIndex::Bvh(tree) => boxes_around_all(tree.nodes(), tree.bounds(), most),
                ObjectIndex::Kd(_) | ObjectIndex::None => vec![Aabb::around(&self.bounds)],
            };
            return Some(boxes.iter().map(|aabb| aabb.to_bounds().corners()).collect());
        }
        let share = most / self.bounded.len().max(1);
        let mut boxes = Vec::new();
        for &id in &self.bounded {
            let object = self.object(id);
            match object.geometry.triangle_tree(&self.meshes) {
                Some(tree) => {
                    let of_tree = tree.boxes_around_all(share);
                    boxes.extend(of_tree.iter().map(|aabb| corners_in_world(object, &aabb.to_bounds())));
                }
                None => boxes.extend(self.object_corners(id)),
            }
        }
        Some(boxes)
    }
}

/// The corners of a box in an object's space.
fn corners_in_world(object: &Object, bounds: &Bounds) -> [DVec3; 8] {
    bounds.corners().map(|corner| object.placement.point_to_world(corner))
}
