//! Which scenes trace alike.

use lancer_core::scene::{Material, Node, Scene, Shape, Texture};
use std::sync::Arc;

/// Whether two scenes compile to the same world: all but names, tone, settings and cameras is equal. Meshes and
/// images count as equal only if they are shared, since to compare their contents takes as long as a frame.
pub(super) fn traces_alike(a: &Arc<Scene>, b: &Arc<Scene>) -> bool {
    Arc::ptr_eq(a, b)
        || a.ambient == b.ambient
            && a.background == b.background
            && a.roots() == b.roots()
            && all_alike(&a.lights, &b.lights, |a, b| a.position == b.position && a.intensity == b.intensity)
            && all_alike(a.materials(), b.materials(), same_material)
            && all_alike(a.nodes(), b.nodes(), same_node)
}

/// How many nodes of a scene draw a mesh that another scene shares.
pub(super) fn shared_meshes(a: &Scene, b: &Scene) -> usize {
    let meshes = |scene: &Scene| {
        scene
            .nodes()
            .iter()
            .filter_map(|node| match &node.shape {
                Some(Shape::Mesh(mesh)) => Some(Arc::as_ptr(mesh)),
                _ => None,
            })
            .collect::<Vec<_>>()
    };
    let theirs = meshes(b).into_iter().collect::<std::collections::HashSet<_>>();
    meshes(a).iter().filter(|mesh| theirs.contains(*mesh)).count()
}

fn all_alike<T>(a: &[T], b: &[T], alike: impl Fn(&T, &T) -> bool) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| alike(a, b))
}

fn same_node(a: &Node, b: &Node) -> bool {
    let same_shape = match (&a.shape, &b.shape) {
        (Some(Shape::Mesh(a)), Some(Shape::Mesh(b))) => Arc::ptr_eq(a, b),
        (Some(Shape::Mesh(_)), _) | (_, Some(Shape::Mesh(_))) => false,
        (a, b) => a == b,
    };
    same_shape
        && a.transform == b.transform
        && a.material == b.material
        && a.children == b.children
        && a.hidden == b.hidden
}

fn same_material(a: &Material, b: &Material) -> bool {
    let same_color = match (&a.color, &b.color) {
        (Texture::Image { image: a, wrap: wrap_a }, Texture::Image { image: b, wrap: wrap_b }) => {
            Arc::ptr_eq(a, b) && wrap_a == wrap_b
        }
        (Texture::Image { .. }, _) | (_, Texture::Image { .. }) => false,
        (a, b) => a == b,
    };
    let rest = |m: &Material| {
        (m.ambient, m.diffuse, m.specular, m.metallic, m.shininess, m.reflect, m.transmit, m.ior, m.fresnel)
    };
    same_color && rest(a) == rest(b)
}
