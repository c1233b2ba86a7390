//! Many short rays from one point, searched together: the directions of an ambient occlusion estimate.
//!
//! The tree is walked once for all of them, with a bit for each direction that may still matter. What makes this
//! faster than ray by ray is what a point and its horizon tell of a box before any direction is looked at: out of
//! reach, below the tangent plane, or so low above it that only the directions below its highest elevation can
//! meet it. Directions are sorted by elevation, so these are a prefix. On a smooth surface next to nothing is
//! left of the neighbourhood, where a single ray spends most of its steps.
//!
//! Source of the masks: Laine, Karras, "Two methods for fast ray-cast ambient occlusion" (EGSR 2010).

mod pairs;

use super::TriangleTree;
use super::block::{BLOCK, Block, blocks_of};
use super::lanes::{cross, dot, largest, load3, splat3, sub};
use super::ray::{LEAST_COMPONENT, UNDERFLOW, UNIT_ROUNDOFF, in_range, narrowed, size_of};
use super::walk::{STACK, nearest_last};
use crate::accel::bvh::{Child, WIDTH, WideNode};
use crate::accel::tally::Tally;
use crate::geometry::{Bounds, DMat3, DVec3, DirectionFan};
use crate::shape::triangle::widened;
use arrayvec::ArrayVec;
use fearless_simd::prelude::*;
use fearless_simd::{f32x4, f32x8, f32x16, i32x4, i32x8};
use pairs::Pairs;

const FAN: usize = DirectionFan::CAPACITY;

/// Directions tested at once.
const LANES: usize = 16;

/// Where this many directions or fewer are left to a node, each goes on by itself: eight boxes for one ray then do
/// more than sixteen directions for one box, most of them idle.
const ALONE: u32 = 12;

/// Where so many directions or fewer meet a leaf, each is held against its triangles by itself.
const APART: u32 = 4;

/// A point to look around from, in the space of a mesh.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Receiver {
    /// Where the rays start.
    pub(crate) point: DVec3,
    /// Whose product with a direction in this space is that direction's elevation.
    pub(crate) normal: DVec3,
    /// Carries directions into this space, and no unit vector to one longer than 1.
    pub(crate) from_world: DMat3,
    /// How far the rays go, in lengths of their directions in this space.
    pub(crate) reach: f64,
    /// The triangle that the point lies on, which no ray that leaves it can meet.
    pub(crate) own: Option<u32>,
}

impl Receiver {
    /// Whether kernels can work on its rays within `bounds`.
    pub(super) fn fits(&self, bounds: &Bounds) -> bool {
        in_range(bounds, self.point) && self.reach > LEAST_REACH
    }
}

/// The shortest reach that leaves products of it within the range of `f32`.
const LEAST_REACH: f64 = 1e-12;

/// The fan in `f32`, ready for a walk.
#[derive(Clone, Debug)]
pub(crate) struct Fan {
    direction: [[f32; FAN]; 3],
    inverse: [[f32; FAN]; 3],
    /// As those of a [`super::ray::NarrowRay`].
    enter_offset: [[f32; FAN]; 3],
    leave_offset: [[f32; FAN]; 3],
    point: [f32; 3],
    point_rest: [f32; 3],
    /// How far the point may lie from the true one, and all `f64` rounding.
    error: f32,
    normal: [f32; 3],
    reach: f32,
    lowest: f32,
    per_step: f32,
    own: u32,
}

impl Default for Fan {
    fn default() -> Self {
        Self {
            direction: [[0.0; FAN]; 3],
            inverse: [[0.0; FAN]; 3],
            enter_offset: [[0.0; FAN]; 3],
            leave_offset: [[0.0; FAN]; 3],
            point: [0.0; 3],
            point_rest: [0.0; 3],
            error: 0.0,
            normal: [0.0; 3],
            reach: 0.0,
            lowest: 0.0,
            per_step: 0.0,
            own: u32::MAX,
        }
    }
}

impl Fan {
    /// Makes a fan ready for what lies within `bounds`, in place of what was there.
    #[inline(always)]
    fn prepare(&mut self, receiver: &Receiver, directions: &DirectionFan, bounds: &Bounds) {
        let point = receiver.point;
        let size = size_of(bounds).max(point.abs().max_element());
        let error = size * (1024.0 * f64::EPSILON);
        let narrow = narrowed(point);
        let margin = 24.0 * UNIT_ROUNDOFF * size as f32 + error as f32;
        let columns = receiver.from_world.to_cols_array();
        let [x, y, z] = &directions.components;
        let used = directions.count.next_multiple_of(LANES);
        for axis in 0..3 {
            let (a, b, c) = (columns[axis], columns[3 + axis], columns[6 + axis]);
            for i in 0..used {
                self.direction[axis][i] = (a * x[i] + b * y[i] + c * z[i]) as f32;
            }
            for i in 0..used {
                let component = self.direction[axis][i];
                self.inverse[axis][i] = 1.0 / component.abs().max(LEAST_COMPONENT as f32).copysign(component);
            }
            for i in 0..used {
                let inverse = self.inverse[axis][i];
                let base = -narrow[axis] * inverse;
                let slack = margin * inverse.abs();
                self.enter_offset[axis][i] = base - slack;
                self.leave_offset[axis][i] = base + slack;
            }
        }
        self.point = narrow;
        self.point_rest = narrowed(point - widened(narrow));
        self.error = error as f32;
        self.normal = narrowed(receiver.normal);
        self.reach = (receiver.reach.min(1e3 * size) * (1.0 + 1e-6)) as f32;
        self.lowest = directions.lowest as f32;
        self.per_step = (1.0 / directions.step) as f32;
        self.own = receiver.own.unwrap_or(u32::MAX);
    }
}

/// Memory that fans leave to the next: to fill it anew for each would take some hundredths of their time.
#[derive(Clone, Debug, Default)]
pub(crate) struct MeshFanScratch {
    fan: Fan,
    pairs: Pairs,
}

/// Which of the directions `wanted` meet a triangle of `tree`.
///
/// `decide` is the canonical test of a direction and a triangle, for what is too close to tell.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "the tree, the fan, and who is told, each by its parts")]
pub(super) fn occluded<S: Simd>(
    simd: S,
    tree: &TriangleTree,
    receiver: &Receiver,
    directions: &DirectionFan,
    wanted: u64,
    scratch: &mut MeshFanScratch,
    tally: &impl Tally,
    mut decide: impl FnMut(usize, &[[f32; 3]; 3]) -> bool,
) -> u64 {
    let MeshFanScratch { fan, pairs: few } = scratch;
    fan.prepare(receiver, directions, &tree.bounds);
    few.clear();
    let fan = &*fan;
    let mut open = wanted;
    let mut stack = ArrayVec::<Waiting, STACK>::new();
    stack.push(Waiting { child: Child::inner(0), mask: wanted, distance: 0.0 });
    while let Some(Waiting { child, mask, .. }) = stack.pop() {
        let mask = mask & open;
        if mask == 0 {
            continue;
        }
        if child.is_leaf() && mask.count_ones() <= APART {
            if few.add_leaf(child, mask) {
                open &= !few.test_leaves(simd, tree, fan, 0, tally, &mut decide);
            }
        } else if child.is_leaf() {
            for (block, count) in blocks_of(child) {
                tally.triangles(count);
                open &= !block_of_fan(simd, fan, &tree.blocks[block], count, mask & open, &mut decide);
            }
        } else if mask.count_ones() <= ALONE {
            if few.add(child, mask) {
                open &= !few.follow(simd, tree, fan, tally, &mut decide);
            }
        } else {
            tally.node();
            node_of_fan(simd, fan, &tree.nodes[child.node()], mask, &mut stack);
        }
        if open == 0 {
            return wanted;
        }
    }
    open &= !few.follow(simd, tree, fan, tally, &mut decide);
    wanted & !open
}

/// Calls `visit` with the leaves of a hierarchy that some of the directions `wanted` may meet, and with which; it
/// returns those that are done with.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "the tree, the fan, and who is told, each by its parts")]
pub(super) fn leaves<S: Simd>(
    simd: S,
    nodes: &[WideNode],
    bounds: &Bounds,
    receiver: &Receiver,
    directions: &DirectionFan,
    wanted: u64,
    fan: &mut Fan,
    tally: &impl Tally,
    visit: &mut impl FnMut(Child, u64) -> u64,
) {
    fan.prepare(receiver, directions, bounds);
    let fan = &*fan;
    let mut open = wanted;
    let mut stack = ArrayVec::<Waiting, STACK>::new();
    stack.push(Waiting { child: Child::inner(0), mask: wanted, distance: 0.0 });
    while let Some(Waiting { child, mask, .. }) = stack.pop() {
        let mask = mask & open;
        if mask == 0 {
            continue;
        }
        if child.is_leaf() {
            open &= !visit(child, mask);
        } else {
            tally.node();
            node_of_fan(simd, fan, &nodes[child.node()], mask, &mut stack);
        }
    }
}

/// What some directions may meet.
struct Waiting {
    child: Child,
    mask: u64,
    /// The square of its box's from the point. What is near hides what is far: on rough surfaces the order saves a
    /// third of the time.
    distance: f32,
}

/// Adds the children of a node that some directions may meet.
#[inline(always)]
fn node_of_fan<S: Simd>(
    simd: S,
    fan: &Fan,
    node: &WideNode,
    mask: u64,
    stack: &mut ArrayVec<Waiting, STACK>,
) {
    let splat = |x: f32| f32x8::splat(simd, x);
    let zero = splat(0.0);
    let point: [f32x8<S>; 3] = splat3(simd, fan.point);
    let below: [f32x8<S>; 3] = splat3(simd, fan.rest(fan.error));
    let above: [f32x8<S>; 3] = splat3(simd, fan.rest(-fan.error));
    let min: [f32x8<S>; 3] = load3(simd, &node.min);
    let max: [f32x8<S>; 3] = load3(simd, &node.max);
    // The boxes as seen from the point, enlarged by its error.
    let mut low = sub(sub(min, point), below);
    let mut high = sub(sub(max, point), above);
    let spread = low[0]
        .abs()
        .max(low[1].abs())
        .max(low[2].abs())
        .max(high[0].abs())
        .max(high[1].abs())
        .max(high[2].abs());
    // Enlarged by all rounding of this and of the slab test below, which is relative to their distance.
    let slack = spread * (8.0 * UNIT_ROUNDOFF);
    low = [low[0] - slack, low[1] - slack, low[2] - slack];
    high = [high[0] + slack, high[1] + slack, high[2] + slack];
    let outside =
        [low[0].max(-high[0]).max(zero), low[1].max(-high[1]).max(zero), low[2].max(-high[2]).max(zero)];
    let squared = dot(outside, outside);
    let top = |axis: usize| if fan.normal[axis] < 0.0 { low[axis] } else { high[axis] };
    let normal: [f32x8<S>; 3] = splat3(simd, fan.normal);
    let height = dot(normal, [top(0), top(1), top(2)]) + slack * 2.0;
    let near = squared.simd_le(splat(fan.reach * fan.reach * (1.0 + 1e-5)));
    let mut met = (near & height.simd_gt(zero)).to_bitmask() as u32;
    if met == 0 {
        return;
    }
    let elevation = height / squared.sqrt();
    // A box around the point concerns every direction.
    let around = squared.simd_le(zero);
    let elevation = around.select(splat(2.0), elevation);
    let counts = (elevation * (1.0 + 1e-5) - fan.lowest) * fan.per_step + 1.01;
    let counts: [i32; WIDTH] = counts.min(splat(FAN as f32)).max(zero).to_int::<i32x8<S>>().into();
    let around = around.to_bitmask() as u32;
    let distance: [f32; WIDTH] = squared.into();
    let waiting = stack.len();
    let low: [[f32; WIDTH]; 3] = [low[0].into(), low[1].into(), low[2].into()];
    let high: [[f32; WIDTH]; 3] = [high[0].into(), high[1].into(), high[2].into()];
    while met != 0 {
        let child = met.trailing_zeros() as usize;
        met &= met - 1;
        let mut candidates = mask & prefix(counts[child]);
        if around >> child & 1 == 0 {
            let corner = |side: &[[f32; WIDTH]; 3]| [side[0][child], side[1][child], side[2][child]];
            candidates = slab(simd, fan, corner(&low), corner(&high), candidates);
        }
        if candidates != 0 {
            let distance = distance[child];
            stack.push(Waiting { child: node.children[child], mask: candidates, distance });
            nearest_last(&mut stack[waiting..], |child| child.distance);
        }
    }
}

/// The bits below `count`, from 0 to 64.
#[inline(always)]
fn prefix(count: i32) -> u64 {
    if count == 0 { 0 } else { u64::MAX >> (FAN as i32 - count) }
}

/// Which of the directions meet a box, given as seen from the point.
#[inline(always)]
fn slab<S: Simd>(simd: S, fan: &Fan, low: [f32; 3], high: [f32; 3], candidates: u64) -> u64 {
    let splat = |x: f32| f32x16::splat(simd, x);
    let mut met = 0;
    let mut group = 0;
    while candidates >> (group * LANES) != 0 {
        let bits = candidates >> (group * LANES) & 0xffff;
        if bits != 0 {
            let inverse: [f32x16<S>; 3] = group3(simd, &fan.inverse, group);
            let (a, b) = (inverse[0] * low[0], inverse[0] * high[0]);
            let (c, d) = (inverse[1] * low[1], inverse[1] * high[1]);
            let (e, f) = (inverse[2] * low[2], inverse[2] * high[2]);
            let enter = a.min(b).max(c.min(d)).max(e.min(f).max(splat(0.0)));
            let leave = a.max(b).min(c.max(d)).min(e.max(f).min(splat(fan.reach)));
            met |= (enter.simd_le(leave).to_bitmask() & bits) << (group * LANES);
        }
        group += 1;
        if group == FAN / LANES {
            break;
        }
    }
    met
}

/// Which of the directions meet a triangle of a block.
#[inline(always)]
fn block_of_fan<S: Simd>(
    simd: S,
    fan: &Fan,
    block: &Block,
    count: usize,
    mask: u64,
    decide: &mut impl FnMut(usize, &[[f32; 3]; 3]) -> bool,
) -> u64 {
    let splat = |x: f32| f32x4::splat(simd, x);
    let zero = splat(0.0);
    let point: [f32x4<S>; 3] = splat3(simd, fan.point);
    let rest: [f32x4<S>; 3] = splat3(simd, fan.point_rest);
    let normal: [f32x4<S>; 3] = splat3(simd, fan.normal);
    let a = sub(sub(load3(simd, &block.corners[0]), point), rest);
    let b = sub(sub(load3(simd, &block.corners[1]), point), rest);
    let c = sub(sub(load3(simd, &block.corners[2]), point), rest);
    let size = largest(a).max(largest(b)).max(largest(c));
    let slack = size * (16.0 * UNIT_ROUNDOFF) + fan.error * 2.0;
    let (ha, hb, hc) = (dot(normal, a), dot(normal, b), dot(normal, c));
    let above = (ha.max(hb).max(hc) + slack).simd_gt(zero).to_bitmask() as u32;
    let mut triangles = above & ((1 << count) - 1);
    if triangles == 0 {
        return 0;
    }
    // The planes through the point and an edge: a direction passes the triangle inside of all three, or outside.
    let (ab, bc, ca) = (cross(a, b), cross(b, c), cross(c, a));
    // Where few directions are left, they are tested sooner than the bound that would rule them out is known.
    let counts: [i32; BLOCK] = if mask >> LANES == 0 {
        [FAN as i32; BLOCK]
    } else {
        let elevation = highest(simd, fan, [a, b, c], [ha, hb, hc], [ab, bc, ca]);
        let counts = (elevation * (1.0 + 1e-5) - fan.lowest) * fan.per_step + 1.01;
        counts.min(splat(FAN as f32)).max(zero).to_int::<i32x4<S>>().into()
    };
    let error = size * (size * (64.0 * UNIT_ROUNDOFF) + fan.error * 16.0) + UNDERFLOW;
    let volume = dot(a, bc);
    let volume_error = size * error * 2.0 + UNDERFLOW;
    let edges: [[[f32; BLOCK]; 3]; 3] = [
        [ab[0].into(), ab[1].into(), ab[2].into()],
        [bc[0].into(), bc[1].into(), bc[2].into()],
        [ca[0].into(), ca[1].into(), ca[2].into()],
    ];
    let mut hit = 0;
    while triangles != 0 {
        let lane = triangles.trailing_zeros() as usize;
        triangles &= triangles - 1;
        if block.ids[lane] == fan.own {
            continue;
        }
        let candidates = mask & !hit & prefix(counts[lane]);
        let edge = |i: usize| [edges[i][0][lane], edges[i][1][lane], edges[i][2][lane]];
        let cone = Cone {
            edges: [edge(0), edge(1), edge(2)],
            error: error[lane],
            volume: volume[lane],
            volume_error: volume_error[lane],
        };
        let (sure, mut unsure) = cone.test(simd, fan, candidates);
        hit |= sure;
        while unsure != 0 {
            let i = unsure.trailing_zeros() as usize;
            unsure &= unsure - 1;
            if decide(i, &block.triangle(lane)) {
                hit |= 1 << i;
            }
        }
    }
    hit
}

/// A bound on the elevation of any point of each triangle: that of its highest corner, or of the highest point of
/// an edge, which may stand above both of its ends as seen on the sphere of directions.
#[inline(always)]
fn highest<S: Simd>(
    simd: S,
    fan: &Fan,
    [a, b, c]: [[f32x4<S>; 3]; 3],
    [ha, hb, hc]: [f32x4<S>; 3],
    [ab, bc, ca]: [[f32x4<S>; 3]; 3],
) -> f32x4<S> {
    let splat = |x: f32| f32x4::splat(simd, x);
    let zero = splat(0.0);
    let normal: [f32x4<S>; 3] = splat3(simd, fan.normal);
    let (aa, bb, cc) = (dot(a, a), dot(b, b), dot(c, c));
    let top = dot(normal, normal);
    let squared = of_corner(simd, ha, aa)
        .max(of_corner(simd, hb, bb))
        .max(of_corner(simd, hc, cc))
        .max(of_edge(simd, top, dot(ab, normal), dot(ab, ab), dot(a, b), [ha, hb, aa, bb]))
        .max(of_edge(simd, top, dot(bc, normal), dot(bc, bc), dot(b, c), [hb, hc, bb, cc]))
        .max(of_edge(simd, top, dot(ca, normal), dot(ca, ca), dot(c, a), [hc, ha, cc, aa]));
    let (u, v, w) = (dot(ab, normal), dot(bc, normal), dot(ca, normal));
    let (least, most) = (u.min(v).min(w), u.max(v).max(w));
    let overhead = least.simd_ge(zero) | most.simd_le(zero);
    // A corner so near that its direction is not known, or a plane that is none.
    let blurred = aa.min(bb).min(cc).simd_le(splat(fan.error * fan.error * 1e9));
    let known = squared.simd_ge(zero) & squared.simd_lt(splat(UNKNOWN));
    let elevation = (squared + 4e-6).sqrt() + 1e-4;
    ((overhead | blurred) | !known).select(splat(2.0), elevation)
}

/// The square of an elevation of which nothing is known: above any that there is.
const UNKNOWN: f32 = 4.0;

/// The square of the elevation of a corner, from its height and the square of its distance.
#[inline(always)]
fn of_corner<S: Simd>(simd: S, height: f32x4<S>, square: f32x4<S>) -> f32x4<S> {
    let height = height.max(f32x4::splat(simd, 0.0));
    height * height / square
}

/// The square of the elevation of the highest point of the great circle through an edge, where that lies between
/// its ends; else 0. `top` is the square of the normal, `along` its product with the circle's axis, whose square is
/// `axis`; of the ends x and y, `xy` is the product, then come both heights and both squares.
#[inline(always)]
fn of_edge<S: Simd>(
    simd: S,
    top: f32x4<S>,
    along: f32x4<S>,
    axis: f32x4<S>,
    xy: f32x4<S>,
    [hx, hy, xx, yy]: [f32x4<S>; 4],
) -> f32x4<S> {
    // The elevation rises from both ends.
    let between = (hy * xx).simd_gt(hx * xy) & (hx * yy).simd_gt(hy * xy);
    let height = between.select(top - along * along / axis, f32x4::splat(simd, 0.0));
    // An axis too short to be told from underflow says nothing.
    axis.simd_gt(f32x4::splat(simd, 1e-30)).select(height, f32x4::splat(simd, UNKNOWN))
}

/// A triangle as seen from the point.
struct Cone {
    edges: [[f32; 3]; 3],
    error: f32,
    /// Six times the volume between the point and the triangle, and its error.
    volume: f32,
    volume_error: f32,
}

impl Cone {
    /// The directions that meet the triangle for sure, and those for which it is too close to tell.
    #[inline(always)]
    fn test<S: Simd>(&self, simd: S, fan: &Fan, candidates: u64) -> (u64, u64) {
        let splat = |x: f32| f32x16::splat(simd, x);
        let (mut sure, mut unsure) = (0, 0);
        let mut group = 0;
        while candidates >> (group * LANES) != 0 {
            let bits = candidates >> (group * LANES) & 0xffff;
            if bits != 0 {
                let direction: [f32x16<S>; 3] = group3(simd, &fan.direction, group);
                let u = dot(direction, splat3(simd, self.edges[0]));
                let v = dot(direction, splat3(simd, self.edges[1]));
                let w = dot(direction, splat3(simd, self.edges[2]));
                let (least, most) = (u.min(v).min(w), u.max(v).max(w));
                let inside = least.simd_ge(splat(-self.error)) | most.simd_le(splat(self.error));
                let maybe = inside.to_bitmask() & bits;
                if maybe != 0 {
                    let determinant = u + v + w;
                    let size = determinant.abs();
                    let negative = determinant.simd_lt(splat(0.0));
                    let volume = negative.select(splat(-self.volume), splat(self.volume));
                    let limit = size * fan.reach;
                    let slack =
                        limit * (8.0 * UNIT_ROUNDOFF) + (self.error * 4.0 * fan.reach + self.volume_error);
                    let ahead = volume.simd_ge(splat(-self.volume_error)) & (limit - volume).simd_ge(-slack);
                    let vanishing = size.simd_le(splat(self.error * 4.0));
                    let maybe = maybe & (ahead | vanishing).to_bitmask();
                    let clear = least.simd_gt(splat(self.error)) | most.simd_lt(splat(-self.error));
                    // The reach is rounded up, by less than a part in 10^5.
                    let short = (limit * (1.0 - 1e-5) - volume).simd_gt(slack);
                    let certain = clear & volume.simd_gt(splat(self.volume_error)) & short & !vanishing;
                    let certain = certain.to_bitmask() & maybe;
                    sure |= certain << (group * LANES);
                    unsure |= (maybe & !certain) << (group * LANES);
                }
            }
            group += 1;
            if group == FAN / LANES {
                break;
            }
        }
        (sure, unsure)
    }
}

impl Fan {
    /// The remainder of the point, moved by `offset` on each axis.
    #[inline(always)]
    fn rest(&self, offset: f32) -> [f32; 3] {
        [self.point_rest[0] + offset, self.point_rest[1] + offset, self.point_rest[2] + offset]
    }
}

#[inline(always)]
fn group3<S: Simd>(simd: S, v: &[[f32; FAN]; 3], group: usize) -> [f32x16<S>; 3] {
    let of = |axis: usize| f32x16::from_slice(simd, &v[axis][group * LANES..(group + 1) * LANES]);
    [of(0), of(1), of(2)]
}
