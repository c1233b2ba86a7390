//! How the parts of a model are arranged.
//!
//! In: nodes as a loader found them. Out: a tree that is known to end and to draw something, of which the
//! loaders, the showcase and scenes ask the size and the box. Nothing here recurses, since a file may nest its
//! nodes as deep as it is long.

use super::ModelPart;
use lancer_core::geometry::{Bounds, DVec3, Placement, Transform};
use lancer_core::mesh::Mesh;
use lancer_core::scene::{Node, NodeId, Scene};
use lancer_core::world::World;

/// A node of a model: a transform over parts and over further nodes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ModelNode {
    /// What the file calls it; may be empty.
    pub name: String,
    /// From this node's space to its parent's.
    pub transform: Transform,
    /// Places in [`Model::parts`](super::Model::parts).
    pub parts: Vec<usize>,
    /// Places in [`ModelTree::nodes`]. A node may be the child of several others.
    pub children: Vec<usize>,
}

/// The nodes of a model. None contains itself, each draws something, and no transform is singular.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelTree {
    nodes: Vec<ModelNode>,
    roots: Vec<usize>,
    /// The nodes in an order in which children come before their parents.
    upward: Vec<usize>,
}

/// Why nodes are no tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub(super) enum TreeError {
    #[error("node {0} contains itself")]
    Cycle(usize),
    #[error("its nodes are drawn more than {} times in all", World::MAX_OBJECTS)]
    TooLarge,
    #[error("its parts are drawn {count} times in all, more than {most}")]
    TooMany { count: u64, most: u64 },
}

impl TreeError {
    /// What the user can do.
    pub(super) fn hint(self) -> Option<&'static str> {
        matches!(self, Self::TooMany { .. }).then_some("--limit objects=N allows more")
    }
}

/// Nodes made into a tree.
pub(super) struct Grown {
    /// `None` where nothing is drawn.
    pub(super) tree: Option<ModelTree>,
    /// Nodes that were left out with all below them since their transform is singular.
    pub(super) singular: Vec<usize>,
}

/// How many vertices [`bounds_of_parts`] looks at, in about a quarter of a second, before it takes the boxes of
/// meshes for the meshes.
const MOST_VERTICES_BOUNDED: usize = 1 << 26;

impl ModelTree {
    /// The tree below `roots`, without what draws nothing; it may draw `most` parts.
    ///
    /// # Errors
    /// See [`TreeError`].
    ///
    /// # Panics
    /// Where a place is out of range.
    pub(super) fn grow(mut nodes: Vec<ModelNode>, roots: Vec<usize>, most: u64) -> Result<Grown, TreeError> {
        let upward = upward_order(&nodes, &roots)?;
        let mut singular = Vec::new();
        let mut visits = vec![0_u64; nodes.len()];
        for &index in &upward {
            if Placement::new(nodes[index].transform).is_err() {
                singular.push(index);
                continue;
            }
            let draws = |&child: &usize| visits[child] > 0;
            nodes[index].children.retain(draws);
            let ModelNode { parts, children, .. } = &nodes[index];
            let below = children.iter().fold(0_u64, |sum, &child| sum.saturating_add(visits[child]));
            let own = parts.len() as u64;
            visits[index] = if own > 0 || below > 0 { below.saturating_add(own + 1) } else { 0 };
        }
        let draws = |index: &usize| visits[*index] > 0;
        let total = roots.iter().fold(0_u64, |sum, &root| sum.saturating_add(visits[root]));
        if total > World::MAX_OBJECTS {
            return Err(TreeError::TooLarge);
        }
        let roots = roots.into_iter().filter(draws).collect::<Vec<_>>();
        let tree = (!roots.is_empty()).then(|| Self::of_used(nodes, &roots, &visits, &upward));
        let count = tree.as_ref().map_or(0, |tree| tree.count(|_| 1));
        if count > most {
            return Err(TreeError::TooMany { count, most });
        }
        Ok(Grown { tree, singular })
    }

    /// The tree of the nodes with visits, which are numbered anew.
    fn of_used(nodes: Vec<ModelNode>, roots: &[usize], visits: &[u64], upward: &[usize]) -> Self {
        let reached = upward.iter().copied().filter(|&index| visits[index] > 0).collect::<Vec<_>>();
        let mut is_reached = vec![false; nodes.len()];
        reached.iter().for_each(|&index| is_reached[index] = true);
        let mut place = vec![usize::MAX; nodes.len()];
        let kept = (0..nodes.len()).filter(|&index| is_reached[index]);
        kept.enumerate().for_each(|(new, old)| place[old] = new);
        let moved = |indices: &[usize]| indices.iter().map(|&index| place[index]).collect::<Vec<_>>();
        let kept = nodes.into_iter().zip(&is_reached).filter(|(_, reached)| **reached);
        let kept = kept.map(|(node, _)| ModelNode { children: moved(&node.children), ..node });
        Self { nodes: kept.collect(), roots: moved(roots), upward: moved(&reached) }
    }

    /// The nodes.
    pub fn nodes(&self) -> &[ModelNode] {
        &self.nodes
    }

    /// The nodes at the top, in drawing order.
    pub fn roots(&self) -> &[usize] {
        &self.roots
    }

    /// The sum of a part's number over all times that a part is drawn.
    pub(super) fn count(&self, of_part: impl Fn(usize) -> u64) -> u64 {
        let mut sums = vec![0_u64; self.nodes.len()];
        for &index in &self.upward {
            let ModelNode { parts, children, .. } = &self.nodes[index];
            let own = parts.iter().map(|&part| of_part(part));
            let below = children.iter().map(|&child| sums[child]);
            sums[index] = own.chain(below).fold(0, u64::saturating_add);
        }
        self.roots.iter().fold(0, |sum, &root| sum.saturating_add(sums[root]))
    }

    /// The transforms from the nodes to the space outside of the tree, and the nodes, each as often as it is drawn.
    pub(super) fn placed(&self, outside: Transform) -> impl Iterator<Item = (Transform, &ModelNode)> {
        let mut waiting = self.roots.iter().rev().map(|&root| (root, outside)).collect::<Vec<_>>();
        std::iter::from_fn(move || {
            let (index, parent) = waiting.pop()?;
            let node = &self.nodes[index];
            let place = node.transform.then(parent);
            waiting.extend(node.children.iter().rev().map(|&child| (child, place)));
            Some((place, node))
        })
    }

    /// The box around all that is drawn.
    pub(super) fn bounds(&self, parts: &[ModelPart], outside: Transform) -> Bounds {
        let meshes = self
            .placed(outside)
            .flat_map(|(place, node)| node.parts.iter().map(move |&part| (&*parts[part].mesh, place)));
        bounds_of_parts(meshes)
    }

    /// Puts the nodes into a scene, of which a node of one part takes its shape and others hold parts as children.
    ///
    /// Returns the roots. What is drawn many times is one node, the child of many.
    pub(super) fn insert_into(self, scene: &mut Scene, parts: &[Node]) -> Vec<NodeId> {
        let mut id_of_part = vec![None; parts.len()];
        let mut id_of_node = vec![None; self.nodes.len()];
        let mut nodes = self.nodes.into_iter().map(Some).collect::<Vec<_>>();
        for &index in &self.upward {
            let ModelNode { name, transform, parts: used, children } =
                nodes[index].take().expect("the order names each node once");
            let below = children.iter().map(|&child| id_of_node[child].expect("children come first"));
            let node = match used[..] {
                // A material here would be inherited by what is below.
                [part] if children.is_empty() => Node { name, ..parts[part].clone() },
                _ => {
                    let own = used.iter().map(|&part| {
                        *id_of_part[part].get_or_insert_with(|| scene.insert(parts[part].clone()))
                    });
                    let own = own.collect::<Vec<_>>();
                    Node::group(name, own.into_iter().chain(below))
                }
            };
            id_of_node[index] = Some(scene.insert(node.with_transform(transform)));
        }
        self.roots.iter().map(|&root| id_of_node[root].expect("all nodes are inserted")).collect()
    }
}

/// The nodes below `roots` in an order in which children come before their parents.
fn upward_order(nodes: &[ModelNode], roots: &[usize]) -> Result<Vec<usize>, TreeError> {
    #[derive(Clone, Copy, PartialEq)]
    enum State {
        Unseen,
        Open,
        Done,
    }
    let mut states = vec![State::Unseen; nodes.len()];
    let mut order = Vec::new();
    for &root in roots {
        if states[root] != State::Unseen {
            continue;
        }
        // Each entry: a node and how many of its children have been looked at.
        let mut path = vec![(root, 0)];
        states[root] = State::Open;
        while let Some((index, next)) = path.last_mut() {
            let Some(&child) = nodes[*index].children.get(*next) else {
                states[*index] = State::Done;
                order.push(*index);
                path.pop();
                continue;
            };
            *next += 1;
            match states[child] {
                State::Unseen => {
                    states[child] = State::Open;
                    path.push((child, 0));
                }
                State::Open => return Err(TreeError::Cycle(child)),
                State::Done => {}
            }
        }
    }
    Ok(order)
}

/// The box around the images of meshes: of their vertices, or of their boxes from where those become too many.
pub(super) fn bounds_of_parts<'a>(meshes: impl Iterator<Item = (&'a Mesh, Transform)>) -> Bounds {
    let mut left = MOST_VERTICES_BOUNDED;
    let mut around = Bounds::EMPTY;
    for (mesh, transform) in meshes {
        let vertices = 3 * mesh.triangle_count();
        let is_axis_aligned = transform.linear() == Transform::IDENTITY.linear();
        let image = if is_axis_aligned || vertices > left {
            Bounds::of_points(mesh.bounds().corners().map(|corner| transform.point(corner)))
        } else {
            left -= vertices;
            let indices = mesh.data().indices.iter().flatten();
            let position = |&index: &u32| mesh.data().positions[index as usize].map(f64::from);
            Bounds::of_points(indices.map(|index| transform.point(DVec3::from_array(position(index)))))
        };
        around = around.union(image);
    }
    around
}

#[cfg(test)]
mod tests {
    use super::*;

    const MANY: u64 = u64::MAX;

    fn node(children: &[usize], parts: &[usize]) -> ModelNode {
        ModelNode { children: children.to_vec(), parts: parts.to_vec(), ..ModelNode::default() }
    }

    fn grown(nodes: Vec<ModelNode>, roots: &[usize]) -> ModelTree {
        ModelTree::grow(nodes, roots.to_vec(), MANY).unwrap().tree.unwrap()
    }

    #[test]
    fn shared_nodes_count_as_often_as_they_are_drawn() {
        let tree = grown(vec![node(&[1, 1], &[]), node(&[2, 2, 2], &[0]), node(&[], &[0, 0])], &[0]);
        assert_eq!(tree.count(|_| 1), 2 * (1 + 3 * 2));
        assert_eq!(tree.placed(Transform::IDENTITY).map(|(_, node)| node.parts.len()).sum::<usize>(), 14);
    }

    #[test]
    fn nodes_that_draw_nothing_are_left_out() {
        let tree = grown(vec![node(&[2], &[]), node(&[], &[0]), node(&[], &[]), node(&[1, 2], &[])], &[0, 3]);
        assert_eq!(tree.nodes(), [node(&[], &[0]), node(&[0], &[])]);
        assert_eq!(tree.roots(), [1]);
    }

    #[test]
    fn cycles_are_told_and_no_depth_overflows() {
        let cycle = vec![node(&[1], &[0]), node(&[2], &[]), node(&[1], &[])];
        assert_eq!(ModelTree::grow(cycle, vec![0], MANY).err(), Some(TreeError::Cycle(1)));
        let deep = 200_000;
        let mut chain = (1..deep).map(|next| node(&[next], &[])).collect::<Vec<_>>();
        chain.push(node(&[], &[0]));
        let tree = grown(chain, &[0]);
        assert_eq!(tree.count(|_| 1), 1);
        assert_eq!(tree.placed(Transform::IDENTITY).count(), deep);
        let mut scene = Scene::new("deep");
        assert_eq!(tree.insert_into(&mut scene, &[Node::default()]).len(), 1);
    }

    #[test]
    fn nodes_that_double_forty_times_are_refused() {
        let mut nodes = (1..41).map(|next| node(&[next, next], &[])).collect::<Vec<_>>();
        nodes.push(node(&[], &[0]));
        assert_eq!(ModelTree::grow(nodes, vec![0], MANY).err(), Some(TreeError::TooLarge));
    }

    #[test]
    fn more_parts_than_are_allowed_are_refused() {
        let nodes = || vec![node(&[1, 1, 1], &[0]), node(&[], &[0, 1])];
        assert!(ModelTree::grow(nodes(), vec![0], 7).is_ok());
        assert_eq!(
            ModelTree::grow(nodes(), vec![0], 6).err(),
            Some(TreeError::TooMany { count: 7, most: 6 })
        );
    }

    #[test]
    fn nodes_that_double_a_hundred_times_and_draw_something_are_refused() {
        let mut nodes = (1..101).map(|next| node(&[next, next], &[0])).collect::<Vec<_>>();
        nodes.push(node(&[], &[0]));
        assert_eq!(ModelTree::grow(nodes, vec![0], MANY).err(), Some(TreeError::TooLarge));
    }

    #[test]
    fn flattened_nodes_are_left_out_and_told() {
        let flat = ModelNode { transform: Transform::scale(DVec3::new(1.0, 0.0, 1.0)), ..node(&[], &[0]) };
        let grown = ModelTree::grow(vec![node(&[1], &[0]), flat], vec![0], MANY).unwrap();
        assert_eq!(grown.singular, [1]);
        assert_eq!(grown.tree.unwrap().count(|_| 1), 1);
    }
}
