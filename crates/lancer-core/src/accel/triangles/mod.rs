//! The triangles of a mesh under a hierarchy of boxes, and the vector kernels that search it.
//!
//! A kernel computes in `f32` with bounds on its error, so that each of its comparisons says yes, no, or too
//! close to tell. What is too close is decided by the canonical test ([`ShearedRay`], in `f64`), and so is where
//! exactly a ray hits: a picture is the same as if only that test had been used, on every triangle.

mod block;
mod fan;
mod lanes;
mod nearby;
mod packet;
mod ray;
mod single;
#[cfg(test)]
mod tests;
mod walk;

pub(crate) use fan::{Fan, MeshFanScratch, Receiver};
pub(crate) use packet::{Beam, DONE, Lane, NarrowPacket, ReadyRays, Visitor, walk_packet};
pub(crate) use ray::{NarrowRay, Narrowed};
pub(crate) use walk::walk;

use super::Aabb;
use super::bits;
use super::bvh::{BuildError, Bvh, Child, Contents, Quality, WideNode, boxes_around_all, boxes_at};
use super::tally::{Tally, Uncounted};
use crate::cancel::CancelToken;
use crate::geometry::{Bounds, DirectionFan, Ray, RayPacket};
use crate::mesh::Mesh;
use crate::shape::triangle::Nearest;
use crate::shape::{Hit, Hits};
use block::{BLOCK, Block};
use fearless_simd::{Level, dispatch};
use rayon::prelude::*;

/// Calls `visit` with the leaves of a hierarchy within `bounds` that some of the directions `wanted` from a point may
/// meet, and with which; it returns those that are done with. Says whether it could: not where the numbers leave the
/// range of `f32`.
#[expect(clippy::too_many_arguments, reason = "the tree, the fan, and who is told, each by its parts")]
pub(crate) fn visit_fan(
    level: Level,
    nodes: &[WideNode],
    bounds: &Bounds,
    receiver: &Receiver,
    directions: &DirectionFan,
    wanted: u64,
    scratch: &mut Fan,
    tally: &impl Tally,
    mut visit: impl FnMut(Child, u64) -> u64,
) -> bool {
    let fits = receiver.fits(bounds);
    if fits {
        dispatch!(level, simd => {
            fan::leaves(simd, nodes, bounds, receiver, directions, wanted, scratch, tally, &mut visit);
        });
    }
    fits
}

/// Leaves that are filled between two looks at whether the build is cancelled: about a millisecond's. Untuned.
const COARSE: usize = 1 << 12;

/// A mesh's triangles, ready to be searched.
#[derive(Clone, Debug)]
pub(crate) struct TriangleTree {
    /// Depth first. A leaf's first place is that of its first block.
    nodes: Vec<WideNode>,
    blocks: Vec<Block>,
    bounds: Bounds,
    depth: u32,
    level: Level,
}

impl TriangleTree {
    /// Builds the tree, on the threads of the current rayon pool, until it is cancelled.
    ///
    /// # Errors
    /// See [`BuildError`].
    pub(crate) fn build(
        mesh: &Mesh,
        quality: Quality,
        level: Level,
        cancel: &CancelToken,
    ) -> Result<Self, BuildError> {
        let boxes: Vec<Aabb> =
            (0..mesh.triangle_count() as u32).into_par_iter().map(|id| box_of(&mesh.vertices(id))).collect();
        let bvh = Bvh::build_with(&boxes, Contents::Triangles, quality, cancel)?;
        drop(boxes);
        let depth = bvh.depth();
        let (mut nodes, order) = bvh.into_parts();
        let mut leaves: Vec<Child> = Vec::new();
        let mut place = 0;
        for child in nodes.iter_mut().flat_map(|node| &mut node.children) {
            if child.is_leaf() && !child.is_none() {
                leaves.push(*child);
                *child = Child::leaf(place, child.count() as u32);
                place += child.count().div_ceil(BLOCK) as u32;
            }
        }
        let mut blocks = Vec::with_capacity(place as usize);
        for leaves in leaves.chunks(COARSE) {
            if cancel.is_cancelled() {
                return Err(BuildError::Cancelled);
            }
            let ids =
                leaves.iter().flat_map(|leaf| order[leaf.first()..leaf.first() + leaf.count()].chunks(BLOCK));
            blocks.extend(ids.map(|ids| Block::new(ids, |id| mesh.vertices(id))));
        }
        Ok(Self { nodes, blocks, bounds: mesh.bounds(), depth, level })
    }

    /// The boxes `level` steps below the root's: at most `most`.
    pub(crate) fn boxes_at(&self, level: u32, most: usize) -> Vec<Aabb> {
        boxes_at(&self.nodes, Aabb::around(&self.bounds), level, most)
    }

    /// At most `most` boxes, which together hold all triangles.
    pub(crate) fn boxes_around_all(&self, most: usize) -> Vec<Aabb> {
        boxes_around_all(&self.nodes, Aabb::around(&self.bounds), most)
    }

    /// Nodes of the hierarchy.
    pub(crate) fn node_count(&self) -> usize {
        self.nodes.len()
    }

    /// Steps from the root to the node furthest from it.
    pub(crate) fn depth(&self) -> u32 {
        self.depth
    }

    /// Bytes held.
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&self.nodes[..]) + size_of_val(&self.blocks[..])
    }

    /// The nearest hit; of several at the same t, the lowest triangle's.
    pub(crate) fn intersect(&self, ray: &Ray, tally: &impl Tally) -> Option<Hit> {
        dispatch!(self.level, simd => match NarrowRay::prepare(ray, &self.bounds) {
            Narrowed::Misses => None,
            Narrowed::Ready(narrow) => single::intersect(simd, self, ray, &narrow, tally),
            Narrowed::OutOfRange => self.intersect_wide(ray, tally),
        })
    }

    /// Whether anything is hit.
    pub(crate) fn occluded(&self, ray: &Ray, tally: &impl Tally) -> bool {
        dispatch!(self.level, simd => match NarrowRay::prepare(ray, &self.bounds) {
            Narrowed::Misses => false,
            Narrowed::Ready(narrow) => {
                single::occluded(simd, self, Child::inner(0), ray, &narrow, None, tally)
            }
            Narrowed::OutOfRange => self.intersect_wide(ray, tally).is_some(),
        })
    }

    /// The nearest hits of the rays `wanted` of a packet, and of no others, each as [`TriangleTree::intersect`] would find
    /// it. They have been made ready for bounds that hold those of the tree.
    pub(crate) fn intersect_packet(&self, rays: &ReadyRays, wanted: u32) -> Hits {
        let (mut hits, left_over) =
            dispatch!(self.level, simd => packet::intersect(simd, self, rays, wanted));
        for lane in bits(left_over) {
            hits.put_found(lane, self.intersect(&rays.rays.ray(lane), &Uncounted));
        }
        hits
    }

    /// Which of the rays `wanted` of a packet hit anything; `own` are triangles that they cannot hit.
    pub(crate) fn occluded_packet(
        &self,
        rays: &ReadyRays,
        wanted: u32,
        own: &[Option<u32>; RayPacket::LANES],
    ) -> u32 {
        let (mut occluded, left_over) =
            dispatch!(self.level, simd => packet::occluded(simd, self, rays, wanted, own));
        for lane in bits(left_over) {
            occluded |= u32::from(self.occluded(&rays.rays.ray(lane), &Uncounted)) << lane;
        }
        occluded
    }

    /// Which of the directions `wanted` from a point meet a triangle; none where the numbers leave the range of
    /// `f32`. `decide` is the canonical test of a direction and a triangle.
    pub(crate) fn occluded_fan(
        &self,
        receiver: &Receiver,
        directions: &DirectionFan,
        wanted: u64,
        scratch: &mut MeshFanScratch,
        tally: &impl Tally,
        mut decide: impl FnMut(usize, &[[f32; 3]; 3]) -> bool,
    ) -> Option<u64> {
        receiver.fits(&self.bounds).then(|| {
            dispatch!(self.level, simd => {
                fan::occluded(simd, self, receiver, directions, wanted, scratch, tally, &mut decide)
            })
        })
    }

    /// The nearest hit, in `f64` throughout: for the rare ray whose numbers leave the range of `f32`.
    fn intersect_wide(&self, ray: &Ray, tally: &impl Tally) -> Option<Hit> {
        let mut nearest = Nearest::new(ray);
        let mut stack = vec![0];
        while let Some(index) = stack.pop() {
            tally.node();
            let node = &self.nodes[index];
            for place in 0..node.children.len() {
                let child = node.child(place);
                if child.is_none() || !may_meet(ray, &node.bounds(place), nearest.t()) {
                    continue;
                }
                if child.is_leaf() {
                    tally.triangles(child.count());
                    for (id, triangle) in self.leaf(child) {
                        nearest.consider(id, &triangle);
                    }
                } else {
                    stack.push(child.node());
                }
            }
        }
        nearest.found()
    }

    /// The triangle at a place in the blocks, counted over all of them, and its id.
    fn triangle_at(&self, place: u32) -> (u32, [[f32; 3]; 3]) {
        let (block, triangle) = (&self.blocks[place as usize / BLOCK], place as usize % BLOCK);
        (block.ids[triangle], block.triangle(triangle))
    }

    /// The triangles of a leaf.
    fn leaf(&self, leaf: Child) -> impl Iterator<Item = (u32, [[f32; 3]; 3])> {
        (0..leaf.count()).map(move |i| self.triangle_at(block::place_of(leaf.first(), i)))
    }
}

fn box_of([a, b, c]: &[[f32; 3]; 3]) -> Aabb {
    Aabb {
        min: std::array::from_fn(|axis| a[axis].min(b[axis]).min(c[axis])),
        max: std::array::from_fn(|axis| a[axis].max(b[axis]).max(c[axis])),
    }
}

/// Whether a ray may meet a box before `t_max`; never false where it does.
fn may_meet(ray: &Ray, aabb: &Aabb, t_max: f64) -> bool {
    let bounds = aabb.to_bounds();
    let slack = (ray.origin.abs() + bounds.magnitude()) * (64.0 * f64::EPSILON);
    let (mut enter, mut leave) = (0.0_f64, t_max);
    for axis in 0..3 {
        let (o, d) = (ray.origin[axis], ray.direction[axis]);
        let (low, high) = (bounds.min[axis] - slack[axis] - o, bounds.max[axis] + slack[axis] - o);
        if d == 0.0 {
            if low > 0.0 || high < 0.0 {
                return false;
            }
        } else {
            // An overflow makes an infinity, which keeps the box or its bound.
            let (near, far) = if d > 0.0 { (low / d, high / d) } else { (high / d, low / d) };
            enter = enter.max(near);
            leave = leave.min(far);
        }
    }
    enter <= leave * (1.0 + 8.0 * f64::EPSILON)
}
