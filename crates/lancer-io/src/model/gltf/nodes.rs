//! The node graph: who is below whom, and where everything stands.
//!
//! A node has one parent or none, and no node is above itself; a document that says otherwise is refused. Nothing
//! recurses, since a chain of nodes may be as long as the file.

use super::document::{Document, Node};
use super::fault::{Fault, Result, entry};
use lancer_core::geometry::{DVec3, Transform};

/// A document's nodes, checked.
pub(super) struct Graph {
    /// The nodes at the top of the scene that is drawn.
    pub(super) roots: Vec<usize>,
    /// For each node its own transform.
    pub(super) transforms: Vec<Transform>,
}

impl Graph {
    /// Checks all nodes of a document.
    pub(super) fn new(document: &Document) -> Result<Self> {
        let nodes = &document.nodes;
        let mut parent = vec![None; nodes.len()];
        for (index, node) in nodes.iter().enumerate() {
            for (place, &child) in node.children.iter().enumerate() {
                let at = || format!("/nodes/{index}/children/{place}");
                if child >= nodes.len() {
                    entry(nodes, "nodes", child, at())?;
                }
                if let Some(first) = parent[child].replace(index) {
                    let message = format!("node {child} is a child of node {first} already");
                    return Err(Fault::new(at(), message));
                }
            }
        }
        let tops = (0..nodes.len()).filter(|&index| parent[index].is_none()).collect::<Vec<_>>();
        refuse_cycles(nodes, &tops)?;
        let transforms = nodes.iter().enumerate().map(|(index, node)| transform_of(node, index));
        let transforms = transforms.collect::<Result<_>>()?;
        Ok(Self { roots: roots(document, &parent, tops)?, transforms })
    }

    /// The nodes below the roots with their transforms to the scene, parents before their children.
    pub(super) fn placed<'a>(&'a self, nodes: &'a [Node]) -> impl Iterator<Item = (usize, Transform)> + 'a {
        let outside = Transform::IDENTITY;
        let mut waiting = self.roots.iter().rev().map(|&root| (root, outside)).collect::<Vec<_>>();
        std::iter::from_fn(move || {
            let (index, parent) = waiting.pop()?;
            let place = self.transforms[index].then(parent);
            waiting.extend(nodes[index].children.iter().rev().map(|&child| (child, place)));
            Some((index, place))
        })
    }
}

/// Every node must be below one without a parent: one that is not is below itself.
fn refuse_cycles(nodes: &[Node], tops: &[usize]) -> Result<()> {
    let mut reached = vec![false; nodes.len()];
    let mut waiting = tops.to_vec();
    while let Some(index) = waiting.pop() {
        reached[index] = true;
        waiting.extend(nodes[index].children.iter().copied());
    }
    match reached.iter().position(|reached| !reached) {
        Some(index) => Err(Fault::new(format!("/nodes/{index}/children"), "the node is below itself")),
        None => Ok(()),
    }
}

/// The roots of the scene to draw: the default one, or else the first, or else all nodes without a parent.
fn roots(document: &Document, parent: &[Option<usize>], tops: Vec<usize>) -> Result<Vec<usize>> {
    if document.scenes.is_empty() && document.scene.is_none() {
        return Ok(tops);
    }
    let scene = document.scene.unwrap_or(0);
    let roots = &entry(&document.scenes, "scenes", scene, "/scene")?.nodes;
    let mut seen = vec![false; parent.len()];
    for (place, &root) in roots.iter().enumerate() {
        let at = format!("/scenes/{scene}/nodes/{place}");
        if let Some(above) = *entry(parent, "nodes", root, &at)? {
            return Err(Fault::new(at, format!("node {root} is no root: it is a child of node {above}")));
        }
        if std::mem::replace(&mut seen[root], true) {
            return Err(Fault::new(at, format!("node {root} is in the list twice")));
        }
    }
    Ok(roots.clone())
}

/// A node's own transform: its matrix, or scale, then rotation, then translation.
fn transform_of(node: &Node, index: usize) -> Result<Transform> {
    if let Some(matrix) = &node.matrix {
        let [x, y, z, t] = [0, 4, 8, 12].map(|first| DVec3::from_slice(&matrix[first..first + 3]));
        if [matrix[3], matrix[7], matrix[11], matrix[15]] != [0.0, 0.0, 0.0, 1.0] {
            let message = "its last row is not 0, 0, 0, 1, so it is no affine transform";
            return Err(Fault::new(format!("/nodes/{index}/matrix"), message));
        }
        return Ok(Transform::from_columns(x, y, z, t));
    }
    let scale = node.scale.as_ref().map_or(DVec3::ONE, |scale| DVec3::from_array(**scale));
    let translation = node.translation.as_ref().map_or(DVec3::ZERO, |offset| DVec3::from_array(**offset));
    let [x, y, z] = match &node.rotation {
        Some(rotation) => axes_of(**rotation).ok_or_else(|| {
            Fault::new(format!("/nodes/{index}/rotation"), "is no quaternion of a rotation")
        })?,
        None => DVec3::AXES,
    };
    Ok(Transform::from_columns(x * scale.x, y * scale.y, z * scale.z, translation))
}

/// The images of the axes under the rotation of a quaternion (x, y, z, w), which need not be of unit length.
fn axes_of(quaternion: [f64; 4]) -> Option<[DVec3; 3]> {
    let largest = quaternion.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    if largest == 0.0 || !largest.is_finite() {
        return None;
    }
    let [x, y, z, w] = quaternion.map(|q| q / largest);
    let s = 2.0 / (x * x + y * y + z * z + w * w);
    Some([
        DVec3::new(1.0 - s * (y * y + z * z), s * (x * y + z * w), s * (x * z - y * w)),
        DVec3::new(s * (x * y - z * w), 1.0 - s * (x * x + z * z), s * (y * z + x * w)),
        DVec3::new(s * (x * z + y * w), s * (y * z - x * w), 1.0 - s * (x * x + y * y)),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quaternions_turn_as_the_specification_says() {
        let half = 0.5_f64.sqrt();
        let [x, y, z] = axes_of([0.0, half, 0.0, half]).unwrap();
        assert!((x - DVec3::NEG_Z).length() < 1e-15 && (z - DVec3::X).length() < 1e-15);
        assert_eq!(y, DVec3::Y);
        assert_eq!(axes_of([0.0, 0.0, 0.0, 7.0]).unwrap(), DVec3::AXES);
        assert!(axes_of([0.0; 4]).is_none());
    }
}
