//! The scene compiled for tracing: flat arrays, integer ids, accelerators; immutable.
//!
//! Its form, which code outside of this room may rely on:
//!
//! - `objects` holds one entry for each shape that is drawn, in the order of a depth-first walk of the scene's
//!   tree, children in the author's order. An object's place in it is its [`ObjectId`].
//! - An object has its global transform and its inverse, one geometry, one material, and the scene node that it
//!   came from. Groups, names and inheritance are gone: what was inherited is written out.
//! - `geometries` holds each mesh once, with its tree, however many objects share it.
//! - Bounded objects are found through a tree over their boxes; unbounded ones (planes) stand in a list that
//!   every ray goes through.
//! - All transforms are invertible, all numbers finite, all coefficients and intensities not negative.
//!
//! Which of several hits at exactly the same t is reported does not depend on the accelerator: it is that of the
//! lowest object, and there of the lowest primitive.

mod boxes;
mod check;
mod compile;
mod error;
mod fan;
mod geometry;
mod hits;
mod intersection;
mod media;
mod packet;
mod sheaf;
#[cfg(test)]
mod tests;

pub use compile::{CompileControl, CompileOptions};
pub use error::CompileError;
pub use fan::FanScratch;
pub use hits::Hits;
pub(crate) use intersection::Intersections;
pub use intersection::{Face, Intersection};
pub use media::Media;
pub(crate) use media::{Interface, Touching};
pub use packet::PacketScratch;

use crate::accel::bvh::Child;
use crate::accel::triangles::{NarrowRay, Narrowed, walk};
use crate::accel::{Bvh, KdTree, Tally, Uncounted};
use crate::color::Rgb;
use crate::geometry::{Bounds, Placement, Ray};
use crate::scene::{Light, Material, MaterialId, NodeId};
use fearless_simd::{Level, dispatch};
use geometry::{Geometry, PreparedMesh};

use std::sync::Arc;

/// Which object of a world.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ObjectId(u32);

impl ObjectId {
    /// Its place in [`World::objects`].
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A shape in its place.
#[derive(Clone, Debug)]
pub struct Object {
    placement: Placement,
    /// The place in [`World::frames`] of the bounds that its rays are made ready for, if it is a mesh.
    frame: u32,
    geometry: Geometry,
    material: MaterialId,
    node: NodeId,
}

impl Object {
    /// Its global transform.
    pub fn placement(&self) -> &Placement {
        &self.placement
    }

    /// Its material.
    pub fn material(&self) -> MaterialId {
        self.material
    }

    /// The scene's node that it came from.
    pub fn node(&self) -> NodeId {
        self.node
    }
}

/// Where a ray meets the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The ray's parameter there.
    pub t: f64,
    /// What it meets.
    pub object: ObjectId,
    /// Which face or triangle of it.
    pub primitive: u32,
}

/// A scene compiled for tracing.
#[derive(Clone, Debug)]
pub struct World {
    objects: Vec<Object>,
    /// Shared with the worlds that this one was made from, and that are made from it.
    meshes: Vec<Arc<PreparedMesh>>,
    materials: Vec<Material>,
    lights: Vec<Light>,
    ambient: Rgb,
    background: Rgb,
    /// The objects with finite boxes, in the order of the tree's primitives.
    bounded: Vec<ObjectId>,
    /// Their boxes, where packets look at them one by one.
    boxes: arrayvec::ArrayVec<Bounds, { World::FEW_FOR_PACKETS }>,
    unbounded: Vec<ObjectId>,
    /// For meshes of one placement that follow each other, the bounds around them in their space: rays are carried there
    /// and made ready once for all of them.
    frames: Vec<Bounds>,
    index: ObjectIndex,
    bounds: Bounds,
    /// How it was compiled.
    options: CompileOptions,
    /// The vector instructions that its kernels use.
    level: Level,
}

/// What finds the bounded objects, as numbers of their places in `bounded`.
#[derive(Clone, Debug)]
enum ObjectIndex {
    Bvh(Bvh),
    Kd(KdTree),
    None,
}

impl ObjectIndex {
    /// Its nodes, its bytes, and the depth of the deepest node.
    fn size(&self) -> (u64, u64, u32) {
        match self {
            Self::Bvh(tree) => (tree.nodes().len() as u64, tree.bytes() as u64, tree.depth()),
            Self::Kd(tree) => (tree.node_count() as u64, tree.bytes() as u64, tree.depth()),
            Self::None => (0, 0, 0),
        }
    }
}

/// What a world holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WorldStatistics {
    /// Shapes drawn.
    pub objects: usize,
    /// Meshes, each counted once.
    pub meshes: usize,
    /// Triangles, each mesh counted once.
    pub triangles: u64,
    /// Triangles that are drawn: each mesh as often as it is used.
    pub instanced_triangles: u64,
    /// Nodes of all trees.
    pub tree_nodes: u64,
    /// Bytes of all trees.
    pub tree_bytes: u64,
    /// Bytes of all meshes.
    pub mesh_bytes: u64,
    /// The depth of the deepest tree.
    pub tree_depth: u32,
}

impl World {
    /// All objects, in the order of their ids.
    pub fn objects(&self) -> &[Object] {
        &self.objects
    }

    /// The ids of all objects, in their order.
    pub fn object_ids(&self) -> impl Iterator<Item = ObjectId> + use<> {
        (0..self.objects.len() as u32).map(ObjectId)
    }

    /// An object.
    ///
    /// # Panics
    /// Where `id` is of another world and out of range here.
    pub fn object(&self, id: ObjectId) -> &Object {
        &self.objects[id.index()]
    }

    /// A material.
    ///
    /// # Panics
    /// Where `id` is of another world and out of range here.
    pub fn material(&self, id: MaterialId) -> &Material {
        &self.materials[id.index()]
    }

    /// The vector instructions that kernels are to use.
    pub(crate) fn level(&self) -> Level {
        self.level
    }

    /// The lights, in the order in which they are summed.
    pub fn lights(&self) -> &[Light] {
        &self.lights
    }

    /// L_a: the ambient light.
    pub fn ambient(&self) -> Rgb {
        self.ambient
    }

    /// The radiance of a ray that meets nothing.
    pub fn background(&self) -> Rgb {
        self.background
    }

    /// The box around all bounded objects; empty where there is none.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// What it holds, counted anew at each call, in time linear in its objects.
    pub fn statistics(&self) -> WorldStatistics {
        let sizes = || self.meshes.iter().map(|mesh| mesh.index.size()).chain([self.index.size()]);
        let triangles = |mesh: &Arc<PreparedMesh>| mesh.mesh.triangle_count() as u64;
        WorldStatistics {
            objects: self.objects.len(),
            meshes: self.meshes.len(),
            triangles: self.meshes.iter().map(triangles).sum(),
            instanced_triangles: self
                .objects
                .iter()
                .filter_map(|object| object.geometry.mesh_index())
                .map(|mesh| triangles(&self.meshes[mesh]))
                .sum(),
            tree_nodes: sizes().map(|(nodes, _, _)| nodes).sum(),
            tree_bytes: sizes().map(|(_, bytes, _)| bytes).sum(),
            mesh_bytes: self.meshes.iter().map(|mesh| mesh.mesh.bytes() as u64).sum(),
            tree_depth: sizes().map(|(_, _, depth)| depth).max().unwrap_or(0),
        }
    }

    /// The nearest hit with t in (0, `ray.t_max`); a hit exactly at an end may or may not be reported.
    pub fn intersect(&self, ray: &Ray) -> Option<Hit> {
        self.intersect_tallied(ray, &Uncounted)
    }

    /// As [`World::intersect`], and tells what it looks at.
    pub(crate) fn intersect_tallied(&self, ray: &Ray, tally: &impl Tally) -> Option<Hit> {
        let mut best: Option<Hit> = None;
        self.visit_objects(ray, tally, |id, object| {
            // A hit at the same t is looked at too: the lower object is to win.
            let t_max = best.map_or(ray.t_max, |hit| hit.t.next_up());
            let local_ray = Ray { t_max, ..object.placement.ray_to_object(ray) };
            if let Some(local) = object.geometry.intersect(&local_ray, &self.meshes, tally) {
                let hit = Hit { t: local.t, object: id, primitive: local.primitive };
                let nearer = best.is_none_or(|best| (hit.t, hit.object) < (best.t, best.object));
                if nearer {
                    best = Some(hit);
                }
            }
            best.map_or(ray.t_max, |hit| hit.t)
        });
        best
    }

    /// Whether the ray meets anything with t in (0, `ray.t_max`).
    pub fn occluded(&self, ray: &Ray) -> bool {
        self.occluded_tallied(ray, &Uncounted)
    }

    /// As [`World::occluded`], and tells what it looks at.
    pub(crate) fn occluded_tallied(&self, ray: &Ray, tally: &impl Tally) -> bool {
        let mut found = false;
        self.visit_objects(ray, tally, |_, object| {
            let local_ray = object.placement.ray_to_object(ray);
            found = object.geometry.occluded(&local_ray, &self.meshes, tally);
            if found { f64::NEG_INFINITY } else { ray.t_max }
        });
        found
    }

    /// Everything about a hit of `ray`.
    ///
    /// # Panics
    /// Where `hit` is of another world and out of range here.
    pub fn intersection(&self, ray: &Ray, hit: &Hit) -> Intersection {
        Intersection::new(self, ray, hit)
    }

    /// Calls `visit` with the objects that the ray may meet, each once, roughly near before far. `visit` returns
    /// the t up to which hits still count, or `f64::NEG_INFINITY` to end.
    fn visit_objects(&self, ray: &Ray, tally: &impl Tally, mut visit: impl FnMut(ObjectId, &Object) -> f64) {
        let mut t_max = ray.t_max;
        for &id in &self.unbounded {
            t_max = visit(id, self.object(id));
            if t_max == f64::NEG_INFINITY {
                return;
            }
        }
        let ray = Ray { t_max, ..*ray };
        match &self.index {
            // A few objects are looked at one by one: each looks at its own bounds first.
            _ if self.bounded.len() <= Self::FEW => self.visit_all_bounded(visit),
            ObjectIndex::Bvh(tree) => match NarrowRay::prepare(&ray, &self.bounds) {
                Narrowed::Misses => {}
                Narrowed::Ready(narrow) => {
                    let mut visit_leaf = |leaf: Child| {
                        for &candidate in &tree.order()[leaf.first()..leaf.first() + leaf.count()] {
                            let id = self.bounded[candidate as usize];
                            t_max = visit(id, self.object(id));
                            if t_max == f64::NEG_INFINITY {
                                return -1.0;
                            }
                        }
                        narrow.up_to(t_max)
                    };
                    dispatch!(self.level, simd => {
                        walk(simd, tree.nodes(), &narrow, tally, &mut visit_leaf);
                    });
                }
                Narrowed::OutOfRange => self.visit_all_bounded(visit),
            },
            ObjectIndex::Kd(tree) => {
                let mut visited = Mailbox::default();
                tree.visit_steps_and_leaves(
                    &ray,
                    || tally.node(),
                    |candidates| {
                        for &candidate in candidates {
                            if visited.first_time(candidate) {
                                let id = self.bounded[candidate as usize];
                                t_max = visit(id, self.object(id));
                                if t_max == f64::NEG_INFINITY {
                                    break;
                                }
                            }
                        }
                        t_max
                    },
                );
            }
            ObjectIndex::None => self.visit_all_bounded(visit),
        }
    }

    /// As many objects as are worth no tree. Untuned.
    const FEW: usize = 3;

    /// The same for packets, which are held against a box in less time than they are made ready for a tree.
    const FEW_FOR_PACKETS: usize = 8;

    fn visit_all_bounded(&self, mut visit: impl FnMut(ObjectId, &Object) -> f64) {
        for &id in &self.bounded {
            if visit(id, self.object(id)) == f64::NEG_INFINITY {
                return;
            }
        }
    }
}

/// Remembers which objects a ray was tested against, as well as a few words can: an object that spans several
/// leaves may hold a whole mesh, and is worth testing only once. Forgetting one costs time and nothing else.
struct Mailbox([u32; Self::SLOTS]);

impl Mailbox {
    /// Objects remembered. Untuned; as long as the objects around one ray seldom share a slot.
    const SLOTS: usize = 8;

    fn first_time(&mut self, object: u32) -> bool {
        let slot = &mut self.0[object as usize % Self::SLOTS];
        let first = *slot != object;
        *slot = object;
        first
    }
}

impl Default for Mailbox {
    fn default() -> Self {
        Self([u32::MAX; Self::SLOTS])
    }
}
