//! A node of the tree.

use super::MaterialId;
use crate::geometry::Transform;
use crate::mesh::Mesh;
use std::sync::Arc;

/// Which node of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct NodeId(pub(super) u32);

impl NodeId {
    /// Its place in [`Scene::nodes`](super::Scene::nodes).
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// Something to see, in its canonical space.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// x^2 + y^2 + z^2 = 1.
    Sphere,
    /// The surface of [-1, 1]^3.
    Cube,
    /// x^2 + z^2 = 1 for -1 <= y <= 1.
    Cylinder {
        /// Whether two discs close it.
        capped: bool,
    },
    /// y = 0, unbounded, with the normal +Y.
    Plane,
    /// Triangles. Nodes that share the `Arc` share the triangles and their k-d tree.
    Mesh(Arc<Mesh>),
}

/// A node: a transform over a shape, over children, or over both.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Node {
    /// What the author calls it; may be empty.
    pub name: String,
    /// From this node's space to its parent's.
    pub transform: Transform,
    /// The material of this node, and of all below it that name none.
    pub material: Option<MaterialId>,
    /// What is drawn here.
    pub shape: Option<Shape>,
    /// What is drawn below, in this node's space.
    pub children: Vec<NodeId>,
    /// Whether neither its shape nor anything below is drawn.
    pub hidden: bool,
}

impl Node {
    /// A node that draws a shape where the shape's own space puts it, with its parent's material.
    /// [`Node::with_transform`] and [`Node::with_material`] say otherwise.
    pub fn shape(name: impl Into<String>, shape: Shape) -> Self {
        Self { name: name.into(), shape: Some(shape), ..Self::default() }
    }

    /// A node that draws a mesh. Give several nodes the same `Arc` to store and index the mesh once.
    pub fn mesh(name: impl Into<String>, mesh: impl Into<Arc<Mesh>>) -> Self {
        Self::shape(name, Shape::Mesh(mesh.into()))
    }

    /// A node that draws other nodes, in the space of this one. A child may have other parents as well.
    pub fn group(name: impl Into<String>, children: impl IntoIterator<Item = NodeId>) -> Self {
        Self { name: name.into(), children: children.into_iter().collect(), ..Self::default() }
    }

    /// The node with this material, which all below it take that name none of their own.
    #[must_use]
    pub fn with_material(mut self, material: MaterialId) -> Self {
        self.material = Some(material);
        self
    }

    /// The node under this transform, from its space to its parent's, in place of an earlier one.
    #[must_use]
    pub fn with_transform(mut self, transform: Transform) -> Self {
        self.transform = transform;
        self
    }
}
