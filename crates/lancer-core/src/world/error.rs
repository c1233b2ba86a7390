//! What keeps a scene from being compiled.

use super::World;
use crate::accel::{BuildError, bvh};

/// Why a scene cannot be traced. Nodes, materials and lights are told by name, or by number where they have none.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CompileError {
    /// Nothing is drawn.
    #[error("the scene draws nothing")]
    NothingToDraw,
    /// A node is its own descendant.
    #[error("{node} contains itself")]
    Cycle {
        /// The node.
        node: String,
    },
    /// An object's global transform has no inverse.
    #[error("the transform of {node} is singular: it flattens the object or has entries that are not finite")]
    Singular {
        /// The node.
        node: String,
    },
    /// A node names a node or a material that the scene does not have.
    #[error("{node} refers to something that is not in the scene")]
    Dangling {
        /// The node.
        node: String,
    },
    /// Subtrees used many times make too many objects.
    #[error("the scene draws {count} objects, more than {}", World::MAX_OBJECTS)]
    TooManyObjects {
        /// How many, or more.
        count: u64,
    },
    /// A coefficient of a material is out of its range.
    #[error("{property} of {material} {requirement}")]
    Material {
        /// The material.
        material: String,
        /// Which coefficient.
        property: &'static str,
        /// What it must be.
        requirement: &'static str,
    },
    /// A light's position or intensity, the ambient light or the background is out of its range.
    #[error("{what} must be finite and not negative")]
    Light {
        /// Which.
        what: String,
    },
    /// A tree could not be built.
    #[error(transparent)]
    Tree(BuildError),
    /// A hierarchy of boxes could not be built.
    #[error(transparent)]
    Bvh(bvh::BuildError),
    /// It was cancelled.
    #[error("the compilation was cancelled")]
    Cancelled,
}

impl From<BuildError> for CompileError {
    fn from(error: BuildError) -> Self {
        match error {
            BuildError::Cancelled => Self::Cancelled,
            BuildError::TooManyPrimitives { .. } => Self::Tree(error),
        }
    }
}

impl From<bvh::BuildError> for CompileError {
    fn from(error: bvh::BuildError) -> Self {
        match error {
            bvh::BuildError::Cancelled => Self::Cancelled,
            bvh::BuildError::TooManyPrimitives { .. } => Self::Bvh(error),
        }
    }
}
