//! From a binary tree to nodes of eight: the choice of least expected cost, found while the tree grew.
//!
//! Source: Ylitie, Karras, Laine, "Efficient incoherent ray traversal on GPUs through compressed wide BVHs"
//! (2017), section 3.1.

use super::binary::Binary;
use super::grow::Grown;
use super::node::{Child, WIDTH, WideNode};
use super::{Bvh, Contents};
use crate::accel::Aabb;
use arrayvec::ArrayVec;
use rayon::prelude::*;

pub(super) fn collapse(grown: Grown, contents: Contents) -> Bvh {
    let Grown { pieces, order } = grown;
    if pieces.is_empty() {
        let bounds = Aabb { min: [0.0; 3], max: [0.0; 3] };
        return Bvh { nodes: vec![WideNode::EMPTY], order, bounds, depth: 0, contents };
    }
    let forest = Forest { pieces: &pieces };
    let root = forest.resolve(Place { piece: 0, node: 0 });
    let Binary { bounds, choice, .. } = *forest.node(root);
    let mut wide = Wide::default();
    if choice.is_leaf() {
        wide.nodes.push(WideNode::EMPTY);
        wide.nodes[0].set(0, &bounds, Child::leaf(0, choice.count()));
    } else if root.piece == 0 {
        let mut stumps = Vec::new();
        forest.emit_crown(root, 0, &mut wide, &mut stumps);
        let subtrees = stumps.par_iter().map(|stump| forest.emit_subtree(stump)).collect::<Vec<_>>();
        wide.append(&stumps, &subtrees);
    } else {
        forest.emit(root, 0, &mut wide);
    }
    Bvh { nodes: wide.nodes, order, bounds, depth: wide.depth, contents }
}

/// A node of a piece.
#[derive(Clone, Copy, Debug)]
struct Place {
    piece: u32,
    node: u32,
}

/// A child in the crown whose subtree is made on its own.
struct Stump {
    place: Place,
    depth: u32,
    /// Where it goes.
    parent: usize,
    slot: usize,
}

/// Nodes and places in the order, both counted from 0.
#[derive(Default)]
struct Wide {
    nodes: Vec<WideNode>,
    /// Primitives in the leaves.
    primitives: u32,
    depth: u32,
}

impl Wide {
    fn push(&mut self, depth: u32) -> usize {
        self.nodes.push(WideNode::EMPTY);
        self.depth = self.depth.max(depth);
        self.nodes.len() - 1
    }

    fn push_leaf(&mut self, count: u32) -> Child {
        let first = self.primitives;
        self.primitives += count;
        Child::leaf(first, count)
    }

    /// Puts subtrees in the places of their stumps.
    fn append(&mut self, stumps: &[Stump], subtrees: &[Self]) {
        let crown = self.nodes.len();
        let total = crown + subtrees.iter().map(|subtree| subtree.nodes.len()).sum::<usize>();
        self.nodes.resize(total, WideNode::EMPTY);
        let (crown_nodes, mut rest) = self.nodes.split_at_mut(crown);
        let mut next = crown as u32;
        let mut copies = Vec::with_capacity(subtrees.len());
        for (stump, subtree) in stumps.iter().zip(subtrees) {
            let (out, others) = rest.split_at_mut(subtree.nodes.len());
            rest = others;
            crown_nodes[stump.parent].children[stump.slot] = match subtree.nodes.first() {
                Some(_) => Child::inner(next),
                None => Child::leaf(self.primitives, subtree.primitives),
            };
            copies.push((out, &subtree.nodes, next, self.primitives));
            next += subtree.nodes.len() as u32;
            self.primitives += subtree.primitives;
            self.depth = self.depth.max(subtree.depth);
        }
        copies.into_par_iter().for_each(|(out, nodes, first, primitives)| {
            for (out, node) in out.iter_mut().zip(nodes) {
                let children = node.children.map(|child| child.shifted(first, primitives));
                *out = WideNode { children, ..*node };
            }
        });
    }
}

struct Forest<'a> {
    pieces: &'a [Vec<Binary>],
}

impl Forest<'_> {
    #[inline]
    fn node(&self, place: Place) -> &Binary {
        &self.pieces[place.piece as usize][place.node as usize]
    }

    /// The node that a node stands for.
    #[inline]
    fn resolve(&self, place: Place) -> Place {
        let node = self.node(place);
        if node.choice.is_link() { Place { piece: node.above, node: 0 } } else { place }
    }

    /// The nodes at and below an inner node of a piece.
    fn emit(&self, place: Place, depth: u32, out: &mut Wide) -> Child {
        let parent = out.push(depth);
        for (slot, child) in self.children(place).into_iter().enumerate() {
            let node = self.node(child);
            let what = if node.choice.is_leaf() {
                out.push_leaf(node.choice.count())
            } else {
                self.emit(child, depth + 1, out)
            };
            out.nodes[parent].set(slot, &node.bounds, what);
        }
        Child::inner(parent as u32)
    }

    /// The nodes of the crown alone. All other children become stumps, in the order of their primitives.
    fn emit_crown(&self, place: Place, depth: u32, out: &mut Wide, stumps: &mut Vec<Stump>) -> Child {
        let parent = out.push(depth);
        for (slot, child) in self.children(place).into_iter().enumerate() {
            let node = self.node(child);
            let what = if child.piece == 0 && !node.choice.is_leaf() {
                self.emit_crown(child, depth + 1, out, stumps)
            } else {
                stumps.push(Stump { place: child, depth: depth + 1, parent, slot });
                Child::NONE
            };
            out.nodes[parent].set(slot, &node.bounds, what);
        }
        Child::inner(parent as u32)
    }

    /// What replaces a stump; no nodes where that is a leaf.
    fn emit_subtree(&self, stump: &Stump) -> Wide {
        let mut out = Wide::default();
        let choice = self.node(stump.place).choice;
        if choice.is_leaf() {
            out.push_leaf(choice.count());
        } else {
            self.emit(stump.place, stump.depth, &mut out);
        }
        out
    }

    /// The children of the wide node that an inner node becomes.
    fn children(&self, place: Place) -> ArrayVec<Place, WIDTH> {
        let mut children = ArrayVec::new();
        self.share(place, WIDTH, &mut children);
        children
    }

    /// Shares places out between the two children of an inner node.
    fn share(&self, place: Place, places: usize, out: &mut ArrayVec<Place, WIDTH>) {
        let node = self.node(place);
        let below = node.choice.below(places);
        self.gather(Place { node: place.node + 1, ..place }, below, out);
        self.gather(Place { node: node.above, ..place }, places - below, out);
    }

    /// The nodes that make the best use of up to `places` places.
    fn gather(&self, place: Place, places: usize, out: &mut ArrayVec<Place, WIDTH>) {
        let place = self.resolve(place);
        let choice = self.node(place).choice;
        match (2..=places).rev().find(|&places| choice.below(places) > 0) {
            Some(places) => self.share(place, places, out),
            None => out.push(place),
        }
    }
}
