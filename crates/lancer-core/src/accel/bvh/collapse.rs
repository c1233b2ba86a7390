//! From a binary tree to nodes of eight: the choice of least expected cost, found bottom up.
//!
//! `costs[j - 1]` of a node is the least cost of all that is below it where it may take up to j of the places in
//! its parent. One place holds a leaf or a node; more are shared out between the two children.
//!
//! Source: Ylitie, Karras, Laine, "Efficient incoherent ray traversal on GPUs through compressed wide BVHs"
//! (2017), section 3.1.

use super::Bvh;
use super::cost::{NODE_COST, leaf_cost};
use super::grow::{Binary, Grown};
use super::node::{Child, MAX_LEAF, WIDTH, WideNode};
use crate::accel::Aabb;
use arrayvec::ArrayVec;

type Costs = [f32; WIDTH - 1];

/// How a node's places are shared out: three bits for each number of places from 2 to 8, how many of them the
/// child below takes. 0 where one place less does as well. The highest bit is set where one place holds a leaf.
#[derive(Clone, Copy, Debug, Default)]
struct Choice(u32);

impl Choice {
    const LEAF: u32 = 1 << 31;

    fn below(self, places: usize) -> usize {
        (self.0 >> (3 * (places - 2)) & 7) as usize
    }

    fn is_leaf(self) -> bool {
        self.0 & Self::LEAF != 0
    }
}

pub(super) fn collapse(grown: Grown) -> Bvh {
    let Grown { nodes, order } = grown;
    let mut choices = vec![Choice::default(); nodes.len()];
    let bounds = nodes.first().map_or(Aabb { min: [0.0; 3], max: [0.0; 3] }, |root| root.bounds);
    let mut bvh = Bvh { nodes: vec![WideNode::EMPTY], order, bounds, depth: 0 };
    if let Some(root) = nodes.first() {
        choose(&nodes, 0, &mut choices);
        let tree = Binaries { nodes: &nodes, choices: &choices };
        if choices[0].is_leaf() {
            bvh.nodes[0].set(0, &root.bounds, Child::leaf(0, root.count));
        } else {
            bvh.nodes.clear();
            let mut places = 0;
            tree.emit(0, 0, &mut bvh, &mut places);
        }
    }
    bvh
}

fn choose(nodes: &[Binary], index: usize, choices: &mut [Choice]) -> Costs {
    let node = &nodes[index];
    let area = node.bounds.half_area();
    let count = node.count as usize;
    let as_leaf = if count <= MAX_LEAF { area * leaf_cost(count) } else { f32::INFINITY };
    if node.above == 0 {
        choices[index] = Choice(Choice::LEAF);
        return [as_leaf; WIDTH - 1];
    }
    let below = choose(nodes, index + 1, choices);
    let above = choose(nodes, node.above as usize, choices);
    let mut choice = 0;
    let share = |places: usize| {
        let mut best = (below[0] + above[places - 2], 1_u32);
        for k in 2..places {
            let cost = below[k - 1] + above[places - k - 1];
            best = if cost < best.0 { (cost, k as u32) } else { best };
        }
        best
    };
    let (cost, k) = share(WIDTH);
    choice |= k << (3 * (WIDTH - 2));
    let as_node = cost + area * NODE_COST;
    let mut costs = [as_node; WIDTH - 1];
    if as_leaf <= as_node {
        costs[0] = as_leaf;
        choice |= Choice::LEAF;
    }
    for places in 2..WIDTH {
        costs[places - 1] = costs[places - 2];
        let (cost, k) = share(places);
        if cost < costs[places - 1] {
            costs[places - 1] = cost;
            choice |= k << (3 * (places - 2));
        }
    }
    choices[index] = Choice(choice);
    costs
}

struct Binaries<'a> {
    nodes: &'a [Binary],
    choices: &'a [Choice],
}

impl Binaries<'_> {
    /// Appends the nodes at and below an inner node, and their leaves from `place` on.
    fn emit(&self, index: usize, depth: u32, out: &mut Bvh, place: &mut u32) {
        let mut children = ArrayVec::<usize, WIDTH>::new();
        let k = self.choices[index].below(WIDTH);
        self.gather(index + 1, k, &mut children);
        self.gather(self.nodes[index].above as usize, WIDTH - k, &mut children);
        let parent = out.nodes.len();
        out.nodes.push(WideNode::EMPTY);
        out.depth = out.depth.max(depth);
        for (slot, &child) in children.iter().enumerate() {
            let node = &self.nodes[child];
            let what = if self.choices[child].is_leaf() {
                let first = *place;
                *place += node.count;
                Child::leaf(first, node.count)
            } else {
                let next = out.nodes.len() as u32;
                self.emit(child, depth + 1, out, place);
                Child::inner(next)
            };
            out.nodes[parent].set(slot, &node.bounds, what);
        }
    }

    /// The nodes that take up to `places` of their parent's places instead of this one.
    fn gather(&self, index: usize, places: usize, out: &mut ArrayVec<usize, WIDTH>) {
        let mut places = places;
        while places > 1 && self.nodes[index].above != 0 && self.choices[index].below(places) == 0 {
            places -= 1;
        }
        if places == 1 || self.nodes[index].above == 0 {
            return out.push(index);
        }
        let below = self.choices[index].below(places);
        self.gather(index + 1, below, out);
        self.gather(self.nodes[index].above as usize, places - below, out);
    }
}
