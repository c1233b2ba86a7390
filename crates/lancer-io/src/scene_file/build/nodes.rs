//! Objects and assets.

use super::Builder;
use crate::scene_file::deserialize::Spanned;
use crate::scene_file::model::{DetailedShape, Named, NodeFile, ShapeFile, SimpleShape, Step, transform_of};
use crate::scene_file::syntax::Problem;
use lancer_core::geometry::{Placement, Transform};
use lancer_core::scene::{Node, NodeId, Shape};

use super::use_order::use_order;

impl<'a> Builder<'a> {
    pub(super) fn add_assets(&mut self, assets: &'a Named<Spanned<NodeFile>>) {
        let (order, cycles) = use_order(&assets.0);
        self.problems.extend(cycles);
        // All are known before any is built, so that a `use` within a cycle is not one of an unknown name.
        for (name, _) in &assets.0 {
            self.assets.add(name, None);
        }
        for index in order {
            let variants = self.asset(&assets.0[index].1);
            self.assets.set(index, Some(variants));
        }
    }

    fn asset(&mut self, asset: &Spanned<NodeFile>) -> Variants {
        self.depends_on_material_above = false;
        let node = self.node(asset, false);
        let without_material_above = self.scene.insert(node);
        let with_material_above = if self.depends_on_material_above {
            let node = self.node(asset, true);
            self.scene.insert(node)
        } else {
            without_material_above
        };
        Variants { without_material_above, with_material_above }
    }

    /// The node of an object; `material_above` tells whether it inherits a material.
    pub(super) fn node(&mut self, spanned: &Spanned<NodeFile>, material_above: bool) -> Node {
        self.problems.extend(draws_nothing(spanned));
        let object = &spanned.value;
        let material = object.material.as_ref().and_then(|material| self.material_of(material));
        let has_material = material_above || object.material.is_some();
        let mut node = Node {
            name: object.name.clone(),
            transform: self.transform(object),
            material,
            hidden: object.hidden,
            ..Node::default()
        };
        match &object.shape {
            Some(ShapeFile::Detailed(DetailedShape::Mesh(reference))) => {
                self.depends_on_material_above |= !has_material;
                node.children.extend(self.model(reference, has_material));
            }
            shape => node.shape = shape.as_ref().and_then(simple_shape),
        }
        if let Some(asset) = &object.asset {
            node.children.extend(self.use_asset(asset, has_material));
        }
        for child in object.children.iter().flatten() {
            let child = self.node(child, has_material);
            node.children.push(self.scene.insert(child));
        }
        node
    }

    /// The node of an asset. `None` where it is unknown or at fault, which is told.
    fn use_asset(&mut self, name: &Spanned<String>, has_material: bool) -> Option<NodeId> {
        let variants = match self.assets.find(&name.value, name.place) {
            Ok(variants) => (*variants?)?,
            Err(problem) => {
                self.problems.push(problem);
                return None;
            }
        };
        if has_material {
            return Some(variants.with_material_above);
        }
        self.depends_on_material_above |= variants.without_material_above != variants.with_material_above;
        Some(variants.without_material_above)
    }

    fn transform(&mut self, object: &NodeFile) -> Transform {
        let Some(steps) = &object.transform else { return Transform::IDENTITY };
        let transform = transform_of(&steps.value);
        if is_singular(transform) {
            self.problems.push(singular(object, steps));
        }
        transform
    }
}

/// The nodes of an asset. They differ where a model in it has its own materials, which give way to any that the
/// scene file gives.
#[derive(Clone, Copy)]
pub(super) struct Variants {
    without_material_above: NodeId,
    with_material_above: NodeId,
}

fn simple_shape(shape: &ShapeFile) -> Option<Shape> {
    match shape {
        ShapeFile::Simple(SimpleShape::Sphere) => Some(Shape::Sphere),
        ShapeFile::Simple(SimpleShape::Cube) => Some(Shape::Cube),
        ShapeFile::Simple(SimpleShape::Cylinder) => Some(Shape::Cylinder { capped: true }),
        ShapeFile::Simple(SimpleShape::Plane) => Some(Shape::Plane),
        ShapeFile::Detailed(DetailedShape::Cylinder(cylinder)) => {
            Some(Shape::Cylinder { capped: cylinder.capped })
        }
        ShapeFile::Detailed(DetailedShape::Mesh(_)) => None,
    }
}

fn draws_nothing(object: &Spanned<NodeFile>) -> Option<Problem> {
    let NodeFile { shape, asset, children, .. } = &object.value;
    let is_bare = shape.is_none() && asset.is_none() && children.is_none();
    (is_bare && object.is_whole).then(|| {
        let who = object.value.title();
        Problem::new(object.place, format!("{who} draws nothing, must have `shape`, `use` or `children`"))
    })
}

fn is_singular(transform: Transform) -> bool {
    Placement::new(transform).is_err()
}

/// The problem of a singular transform, at the step that makes it so, if it is one.
fn singular(object: &NodeFile, steps: &Spanned<Vec<Spanned<Step>>>) -> Problem {
    let culprit = steps.value.iter().find(|step| is_singular(step.value.to_transform()));
    let place = culprit.map_or(steps.place, |step| step.place);
    let who = object.title();
    let message = format!("the transform of {who} is singular: it flattens the object, or overflows");
    Problem::new(place, message)
        .with_hint("a factor of 0, or two columns of a matrix along one line, do that")
}
