//! Sixteen rays that go much the same way, searched together.
//!
//! The boxes of a node are first held against the interval of all rays at once, eight boxes in one test; those that
//! some ray may meet are then held against each ray, sixteen in one test. So are triangles.
//!
//! Source: Reshetov, Soupikov, Hurley, "Multi-level ray tracing algorithm" (2005), for the interval; Wald,
//! Boulos, Shirley, "Ray tracing deformable scenes using dynamic bounding volume hierarchies" (2007), for packets.

use super::TriangleTree;
use super::block::{Block, TestRays, TestTriangles, Verdict, blocks_of, place_of};
use super::lanes::{load3, splat3};
use super::nearby::Nearby;
use super::ray::{Clipped, NarrowRay};
use super::single::{self, add_leaf};
use super::walk::{LeafVisitor, STACK, nearest_last, walk_from};
use crate::accel::bits;
use crate::accel::bvh::{Child, WideNode};
use crate::accel::tally::Uncounted;
use crate::geometry::{Bounds, RayPacket};
use crate::shape::Hits;
use crate::shape::triangle::Canonical;
use arrayvec::ArrayVec;
use fearless_simd::prelude::*;
use fearless_simd::{f32x4, f32x8, f32x16, mask32x16};

pub(super) const LANES: usize = RayPacket::LANES;

/// A number for each ray.
pub(crate) type Lane = [f32; LANES];

/// Where this many rays or fewer go one way, they go on one by one: eight boxes for one ray then do more than sixteen
/// rays for one box, most of them idle.
const ALONE: u32 = 2;

/// The end of a ray that wants nothing more.
pub(crate) const DONE: f32 = -1.0;

/// A packet in `f32`; see [`NarrowRay`] for its parts.
#[derive(Clone, Debug, Default)]
pub(crate) struct NarrowPacket {
    origin: [Lane; 3],
    origin_rest: [Lane; 3],
    direction: [Lane; 3],
    inverse: [Lane; 3],
    enter_offset: [Lane; 3],
    leave_offset: [Lane; 3],
    margin: Lane,
    origin_error: Lane,
    pub(crate) end: Lane,
    start: [f64; LANES],
    scale: [f64; LANES],
    /// The rays that can be traced so, a bit for each.
    pub(crate) ready: u32,
    /// The rays that cannot.
    pub(crate) out_of_range: u32,
}

impl NarrowPacket {
    /// Prepares rays for what lies within `bounds`, in place of what the packet held: it is too large to be handed on.
    #[inline(always)]
    pub(crate) fn prepare(&mut self, rays: &RayPacket, bounds: &Bounds) {
        let (mut meets, mut fits) = ([false; LANES], [false; LANES]);
        for lane in 0..LANES {
            let clipped = Clipped::new(&rays.ray(lane), bounds);
            let ray = clipped.narrow();
            (meets[lane], fits[lane]) = (clipped.meets, clipped.fits);
            self.put(lane, &ray);
        }
        (self.ready, self.out_of_range) = (0, 0);
        for lane in 0..LANES {
            self.ready |= u32::from(meets[lane] & fits[lane]) << lane;
            self.out_of_range |= u32::from(!fits[lane]) << lane;
        }
    }

    #[inline(always)]
    fn put(&mut self, lane: usize, ray: &NarrowRay) {
        for axis in 0..3 {
            self.origin[axis][lane] = ray.origin[axis];
            self.origin_rest[axis][lane] = ray.origin_rest[axis];
            self.direction[axis][lane] = ray.direction[axis];
            self.inverse[axis][lane] = ray.inverse[axis];
            self.enter_offset[axis][lane] = ray.enter_offset[axis];
            self.leave_offset[axis][lane] = ray.leave_offset[axis];
        }
        self.margin[lane] = ray.margin;
        self.origin_error[lane] = ray.origin_error;
        self.end[lane] = ray.end;
        self.start[lane] = ray.start;
        self.scale[lane] = ray.scale;
    }

    /// One of the rays, up to `end`.
    #[inline(always)]
    fn ray(&self, lane: usize, end: f32) -> NarrowRay {
        let of = |v: &[Lane; 3]| [v[0][lane], v[1][lane], v[2][lane]];
        NarrowRay {
            origin: of(&self.origin),
            origin_rest: of(&self.origin_rest),
            direction: of(&self.direction),
            inverse: of(&self.inverse),
            enter_offset: of(&self.enter_offset),
            leave_offset: of(&self.leave_offset),
            margin: self.margin[lane],
            origin_error: self.origin_error[lane],
            end,
            start: self.start[lane],
            scale: self.scale[lane],
        }
    }

    /// What a test wants to know of one of the rays.
    #[inline(always)]
    fn test_ray<S: Simd>(&self, simd: S, lane: usize) -> TestRays<f32x4<S>> {
        let of = |v: &[Lane; 3]| [v[0][lane], v[1][lane], v[2][lane]];
        TestRays {
            origin: splat3(simd, of(&self.origin)),
            origin_rest: splat3(simd, of(&self.origin_rest)),
            direction: splat3(simd, of(&self.direction)),
            origin_error: f32x4::splat(simd, self.origin_error[lane]),
        }
    }

    /// The parameter of a t of a ray; see [`NarrowRay::up_to`].
    #[inline(always)]
    pub(crate) fn up_to(&self, lane: usize, t: f64) -> f32 {
        self.ray(lane, self.end[lane]).up_to(t)
    }

    /// The ends of the rays of a group; the others are done with.
    #[inline(always)]
    pub(crate) fn ends_of<S: Simd>(&self, simd: S, group: u32) -> Lane {
        let ends = f32x16::load_array_ref(simd, &self.end);
        mask(simd, group).select(ends, f32x16::splat(simd, DONE)).into()
    }

    /// Takes from `open` a group of rays whose directions have the same signs: which, and which axes they go down.
    #[inline(always)]
    pub(crate) fn octant<S: Simd>(&self, simd: S, open: &mut u32) -> Option<(u32, [bool; 3])> {
        if *open == 0 {
            return None;
        }
        let first = open.trailing_zeros();
        let mut group = *open;
        let mut backward = [false; 3];
        for (backward, inverse) in backward.iter_mut().zip(&self.inverse) {
            let down = f32x16::load_array_ref(simd, inverse).simd_lt(f32x16::splat(simd, 0.0)).to_bitmask();
            *backward = down >> first & 1 == 1;
            group &= if *backward { down as u32 } else { !down as u32 };
        }
        *open &= !group;
        Some((group, backward))
    }
}

/// Rays in the space of some meshes, ready for their triangles.
#[derive(Clone, Debug, Default)]
pub(crate) struct ReadyRays {
    pub(crate) rays: RayPacket,
    narrow: NarrowPacket,
}

impl ReadyRays {
    /// Makes `rays` ready for what lies within `bounds`.
    #[inline(always)]
    pub(crate) fn prepare(&mut self, bounds: &Bounds) {
        self.narrow.prepare(&self.rays, bounds);
    }

    /// Lets hits count up to other `t_max`, none greater than it was.
    #[inline(always)]
    pub(crate) fn shorten(&mut self, t_max: &[f64; LANES]) {
        self.rays.t_max = *t_max;
        for (lane, &t_max) in t_max.iter().enumerate() {
            self.narrow.end[lane] = self.narrow.up_to(lane, t_max);
        }
    }
}

/// All rays of a group at once: the intervals of their origins and inverses.
pub(crate) struct Beam {
    /// By axis: 1 or -1, the sign of the directions.
    sign: [f32; 3],
    /// What is added to a plane's coordinate times `sign`: for the planes that the rays enter by, and leave by.
    enter_offset: [f32; 3],
    leave_offset: [f32; 3],
    /// The least and the greatest 1 / direction, in size.
    least: [f32; 3],
    most: [f32; 3],
}

impl Beam {
    #[inline(always)]
    fn new<S: Simd>(simd: S, packet: &NarrowPacket, group: u32, backward: [bool; 3]) -> Self {
        let mut beam = Self {
            sign: [1.0; 3],
            enter_offset: [0.0; 3],
            leave_offset: [0.0; 3],
            least: [0.0; 3],
            most: [0.0; 3],
        };
        // A ray's margin holds for its own slab test; half of it more, for those of the beam.
        let margin = 1.5 * of_group(simd, &packet.margin, group).reduce_max();
        for (axis, backward) in backward.into_iter().enumerate() {
            let sign = if backward { -1.0 } else { 1.0 };
            let origin = of_group(simd, &packet.origin[axis], group) * sign;
            let inverse = of_group(simd, &packet.inverse[axis], group) * sign;
            beam.sign[axis] = sign;
            beam.enter_offset[axis] = -(origin.reduce_max() + margin);
            beam.leave_offset[axis] = margin - origin.reduce_min();
            beam.least[axis] = inverse.reduce_min();
            beam.most[axis] = inverse.reduce_max();
        }
        beam
    }
}

/// The values of a group's rays; those of the others are like one of them.
#[inline(always)]
fn of_group<S: Simd>(simd: S, values: &Lane, group: u32) -> f32x16<S> {
    let first = f32x16::splat(simd, values[group.trailing_zeros() as usize]);
    mask(simd, group).select(f32x16::load_array_ref(simd, values), first)
}

/// The lanes whose bits are set.
#[inline(always)]
pub(super) fn mask<S: Simd>(simd: S, lanes: u32) -> mask32x16<S> {
    mask32x16::from_bitmask(simd, lanes.into())
}

/// Who is shown what rays meet. A trait and not a closure, since vector code must be inlined.
pub(crate) trait Visitor {
    /// Where this many rays or fewer meet a child that is no leaf, they are to go on from there one by one.
    const ALONE: u32;

    /// Some rays meet a leaf; or a few meet any child. May lower their ends; a ray whose end is [`DONE`] is not asked
    /// for again.
    fn visit(&mut self, child: Child, lanes: u32, beam: &Beam, end: &mut Lane);
}

/// A box to look into: a child of a node, by its place there.
#[derive(Clone, Copy)]
struct Waiting {
    child: Child,
    node: u32,
    place: u32,
    /// No ray enters it sooner.
    enter: f32,
}

/// Shows a visitor what the rays of a group meet.
#[inline(always)]
pub(crate) fn walk_packet<S: Simd, V: Visitor>(
    simd: S,
    nodes: &[WideNode],
    packet: &NarrowPacket,
    group: u32,
    backward: [bool; 3],
    end: &mut Lane,
    visitor: &mut V,
) {
    let beam = &Beam::new(simd, packet, group, backward);
    let mut stack = ArrayVec::<Waiting, STACK>::new();
    let mut furthest = furthest(simd, end);
    let mut node = 0;
    loop {
        let waiting = stack.len();
        let (enter, mut met) = beam_meets(simd, &nodes[node], beam, furthest);
        while met != 0 {
            let place = met.trailing_zeros();
            met &= met - 1;
            let child = nodes[node].children[place as usize];
            stack.push(Waiting { child, node: node as u32, place, enter: enter[place as usize] });
            nearest_last(&mut stack[waiting..], |child| child.enter);
        }
        loop {
            let Some(next) = stack.pop() else { return };
            if next.enter > furthest {
                continue;
            }
            let lanes = group
                & rays_that_meet(
                    simd,
                    packet,
                    &nodes[next.node as usize],
                    next.place as usize,
                    backward,
                    end,
                );
            if lanes == 0 {
                continue;
            }
            if next.child.is_leaf() || lanes.count_ones() <= V::ALONE {
                visitor.visit(next.child, lanes, beam, end);
                furthest = self::furthest(simd, end);
                if furthest < 0.0 {
                    return;
                }
            } else {
                node = next.child.node();
                break;
            }
        }
    }
}

#[inline(always)]
fn furthest<S: Simd>(simd: S, end: &Lane) -> f32 {
    f32x16::load_array_ref(simd, end).reduce_max()
}

/// Where the rays enter each box at the soonest, and which boxes some of them may meet.
#[inline(always)]
fn beam_meets<S: Simd>(simd: S, node: &WideNode, beam: &Beam, furthest: f32) -> ([f32; 8], u32) {
    let splat = |x: f32| f32x8::splat(simd, x);
    let mut enter = splat(0.0);
    let mut leave = splat(furthest);
    for axis in 0..3 {
        let (near, far) = match beam.sign[axis] < 0.0 {
            true => (&node.max[axis], &node.min[axis]),
            false => (&node.min[axis], &node.max[axis]),
        };
        let sign = splat(beam.sign[axis]);
        let near = f32x8::load_array_ref(simd, near).mul_add(sign, splat(beam.enter_offset[axis]));
        let far = f32x8::load_array_ref(simd, far).mul_add(sign, splat(beam.leave_offset[axis]));
        let (least, most) = (splat(beam.least[axis]), splat(beam.most[axis]));
        enter = enter.max((near * least).min(near * most));
        leave = leave.min((far * least).max(far * most));
    }
    (enter.into(), enter.simd_le(leave).to_bitmask() as u32)
}

/// Which triangles of a block have boxes that some of the rays may meet, at any distance.
#[inline(always)]
fn beam_meets_triangles<S: Simd>(simd: S, block: &Block, beam: &Beam, count: usize) -> u32 {
    let splat = |x: f32| f32x4::splat(simd, x);
    let mut enter = splat(0.0);
    let mut leave = splat(f32::INFINITY);
    for axis in 0..3 {
        let sign = splat(beam.sign[axis]);
        let corner = |corner: usize| f32x4::load_array_ref(simd, &block.corners[corner][axis]) * sign;
        let (a, b, c) = (corner(0), corner(1), corner(2));
        let near = a.min(b).min(c) + splat(beam.enter_offset[axis]);
        let far = a.max(b).max(c) + splat(beam.leave_offset[axis]);
        let (least, most) = (splat(beam.least[axis]), splat(beam.most[axis]));
        enter = enter.max((near * least).min(near * most));
        leave = leave.min((far * least).max(far * most));
    }
    enter.simd_le(leave).to_bitmask() as u32 & ((1 << count) - 1)
}

/// Which rays meet a box.
#[inline(always)]
fn rays_that_meet<S: Simd>(
    simd: S,
    packet: &NarrowPacket,
    node: &WideNode,
    place: usize,
    backward: [bool; 3],
    end: &Lane,
) -> u32 {
    let mut enter = f32x16::splat(simd, 0.0);
    let mut leave = f32x16::load_array_ref(simd, end);
    for (axis, backward) in backward.into_iter().enumerate() {
        let (near, far) = match backward {
            true => (node.max[axis][place], node.min[axis][place]),
            false => (node.min[axis][place], node.max[axis][place]),
        };
        let inverse = f32x16::load_array_ref(simd, &packet.inverse[axis]);
        let enter_offset = f32x16::load_array_ref(simd, &packet.enter_offset[axis]);
        let leave_offset = f32x16::load_array_ref(simd, &packet.leave_offset[axis]);
        enter = enter.max(f32x16::splat(simd, near).mul_add(inverse, enter_offset));
        leave = leave.min(f32x16::splat(simd, far).mul_add(inverse, leave_offset));
    }
    enter.simd_le(leave).to_bitmask() as u32
}

/// Tests the rays `lanes` against a triangle, for hits with `s` in (0, `end`).
#[inline(always)]
fn test<S: Simd>(
    simd: S,
    packet: &NarrowPacket,
    triangle: &TestTriangles<f32x16<S>>,
    lanes: u32,
    end: &Lane,
) -> Verdict<f32x16<S>> {
    let rays = TestRays {
        origin: load3(simd, &packet.origin),
        origin_rest: load3(simd, &packet.origin_rest),
        direction: load3(simd, &packet.direction),
        origin_error: f32x16::load_array_ref(simd, &packet.origin_error),
    };
    rays.test(simd, triangle, lanes, f32x16::load_array_ref(simd, end))
}

/// The nearest hits of the rays `wanted`, and which rays are left to be searched one by one.
#[inline(always)]
pub(super) fn intersect<S: Simd>(simd: S, tree: &TriangleTree, rays: &ReadyRays, wanted: u32) -> (Hits, u32) {
    let ReadyRays { rays, narrow: packet } = rays;
    let (mut open, mut left_over) = (packet.ready & wanted, packet.out_of_range & wanted);
    let mut search = NearestSearch { simd, tree, packet, nearby: Nearby::new() };
    let mut ends = packet.end;
    let mut searched = 0;
    while let Some((group, backward)) = packet.octant(simd, &mut open) {
        if group.count_ones() <= ALONE {
            left_over |= group;
            continue;
        }
        let mut end = packet.ends_of(simd, group);
        walk_packet(simd, &tree.nodes, packet, group, backward, &mut end, &mut search);
        searched |= group;
        for lane in bits(group) {
            ends[lane] = end[lane];
        }
    }
    left_over |= search.nearby.left_over;
    (search.nearby.settle(simd, tree, rays, &ends, searched & !left_over), left_over)
}

/// A search for nearest hits on its way.
struct NearestSearch<'a, S: Simd> {
    simd: S,
    tree: &'a TriangleTree,
    packet: &'a NarrowPacket,
    nearby: Nearby,
}

impl<S: Simd> Visitor for NearestSearch<'_, S> {
    const ALONE: u32 = ALONE;

    #[inline(always)]
    fn visit(&mut self, child: Child, lanes: u32, beam: &Beam, end: &mut Lane) {
        if few(child, lanes) {
            for lane in bits(lanes) {
                self.go_alone(child, lane, &mut end[lane]);
            }
            return;
        }
        for (block, count) in blocks_of(child) {
            let met = beam_meets_triangles(self.simd, &self.tree.blocks[block], beam, count);
            if met == 0 {
                continue;
            }
            let triangles = self.tree.blocks[block].triangles(self.simd);
            for triangle in bits(met) {
                let ready = triangles.splat(self.simd, triangle);
                let verdict = test(self.simd, self.packet, &ready, lanes, end);
                if verdict.maybe != 0 {
                    self.nearby.add(self.simd, place_of(block, triangle), &verdict, end);
                }
            }
        }
    }
}

impl<S: Simd> NearestSearch<'_, S> {
    #[inline(always)]
    fn go_alone(&mut self, child: Child, lane: usize, end: &mut f32) {
        let Self { simd, tree, packet, .. } = *self;
        let block_ray = packet.test_ray(simd, lane);
        // A leaf, as most are, wants no more of the ray.
        if child.is_leaf() {
            Alone { search: self, block_ray, lane, end }.leaf(child);
        } else {
            let ray = packet.ray(lane, *end);
            let mut visitor = Alone { search: self, block_ray, lane, end };
            walk_from(simd, &tree.nodes, child, &ray, &Uncounted, &mut visitor);
        }
    }
}

/// One ray that goes on by itself.
struct Alone<'a, 't, S: Simd> {
    search: &'a mut NearestSearch<'t, S>,
    block_ray: TestRays<f32x4<S>>,
    lane: usize,
    end: &'a mut f32,
}

impl<S: Simd> LeafVisitor for Alone<'_, '_, S> {
    #[inline(always)]
    fn leaf(&mut self, leaf: Child) -> f32 {
        let NearestSearch { simd, tree, .. } = *self.search;
        add_leaf(simd, tree, &self.block_ray, leaf, self.end, |candidate, latest, end| {
            self.search.nearby.add_to(self.lane, candidate, latest, end);
        });
        *self.end
    }
}

/// Which of the rays `wanted` meet anything, and which are left to be searched one by one.
#[inline(always)]
pub(super) fn occluded<S: Simd>(
    simd: S,
    tree: &TriangleTree,
    rays: &ReadyRays,
    wanted: u32,
    own: &[Option<u32>; LANES],
) -> (u32, u32) {
    let ReadyRays { rays, narrow: packet } = rays;
    let (mut open, mut left_over) = (packet.ready & wanted, packet.out_of_range & wanted);
    let mut search = OcclusionSearch { simd, tree, packet, rays, own, occluded: 0 };
    while let Some((group, backward)) = packet.octant(simd, &mut open) {
        if group.count_ones() <= ALONE {
            left_over |= group;
            continue;
        }
        let mut end = packet.ends_of(simd, group);
        walk_packet(simd, &tree.nodes, packet, group, backward, &mut end, &mut search);
    }
    (search.occluded, left_over)
}

/// A search for any hits on its way.
struct OcclusionSearch<'a, S> {
    simd: S,
    tree: &'a TriangleTree,
    packet: &'a NarrowPacket,
    rays: &'a RayPacket,
    /// Triangles that the rays cannot meet.
    own: &'a [Option<u32>; LANES],
    occluded: u32,
}

impl<S: Simd> Visitor for OcclusionSearch<'_, S> {
    const ALONE: u32 = ALONE;

    #[inline(always)]
    fn visit(&mut self, child: Child, lanes: u32, beam: &Beam, end: &mut Lane) {
        let mut occluded = 0;
        if few(child, lanes) {
            for lane in bits(lanes) {
                let (ray, own) = (self.rays.ray(lane), self.own[lane]);
                let hit = if child.is_leaf() {
                    let block_ray = self.packet.test_ray(self.simd, lane);
                    let canonical = &mut Canonical::new(&ray);
                    single::leaf_occludes(
                        self.simd, self.tree, child, &block_ray, end[lane], own, canonical, &Uncounted,
                    )
                } else {
                    let narrow = self.packet.ray(lane, end[lane]);
                    single::occluded(self.simd, self.tree, child, &ray, &narrow, own, &Uncounted)
                };
                occluded |= u32::from(hit) << lane;
            }
        } else {
            for (block, count) in blocks_of(child) {
                let block = &self.tree.blocks[block];
                let met = beam_meets_triangles(self.simd, block, beam, count);
                if met == 0 {
                    continue;
                }
                let triangles = block.triangles(self.simd);
                for triangle in bits(met) {
                    let ready = triangles.splat(self.simd, triangle);
                    let verdict = test(self.simd, self.packet, &ready, lanes & !occluded, end);
                    occluded |= verdict.sure;
                    for lane in bits(verdict.maybe & !verdict.sure) {
                        if self.own[lane] == Some(block.ids[triangle]) {
                            continue;
                        }
                        let meets = Canonical::new(&self.rays.ray(lane)).hits(&block.triangle(triangle));
                        occluded |= u32::from(meets) << lane;
                    }
                }
            }
        }
        self.occluded |= occluded;
        for lane in bits(occluded) {
            end[lane] = DONE;
        }
    }
}

/// Whether so many rays go on one by one: a leaf of more triangles than rays is sooner tested a ray at a time.
#[inline(always)]
fn few(child: Child, lanes: u32) -> bool {
    !child.is_leaf() || (lanes.count_ones() as usize) < child.count()
}
