//! From a scene to a world.

use super::check::check_numbers;
use super::geometry::{Geometry, PreparedMesh, TriangleIndex};
use super::{CompileError, Object, ObjectId, ObjectIndex, World};
use crate::accel::bvh::Contents;
use crate::accel::triangles::TriangleTree;
use crate::accel::{Aabb, Accelerator, Bvh, KdSettings, KdTree, Primitives, Quality};
use crate::cancel::CancelToken;
use crate::geometry::{Bounds, Placement, Transform};
use crate::mesh::Mesh;
use crate::scene::{Material, MaterialId, NodeId, Scene, Shape};
use crate::simd::InstructionSet;
use fearless_simd::Level;
use rayon::prelude::*;
use std::collections::HashMap;
use std::sync::Arc;

/// How a world is made ready.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CompileOptions {
    /// Which structure finds hits.
    pub accelerator: Accelerator,
    /// The bounds of the k-d trees; for [`Accelerator::KdTree`].
    pub kd: KdSettings,
    /// How much time a hierarchy of boxes may take to build; for [`Accelerator::Bvh`].
    pub quality: Quality,
    /// Which vector instructions to use; the best ones where there is none, or not these.
    pub instructions: Option<InstructionSet>,
}

impl CompileOptions {
    fn level(&self) -> Level {
        self.instructions.and_then(InstructionSet::level).unwrap_or_else(Level::new)
    }
}

/// How a compilation is helped and stopped.
#[derive(Clone, Debug, Default)]
pub struct CompileControl<'a> {
    /// The world of an earlier state of the scene. Meshes that the scene still holds by the same `Arc` keep their
    /// trees, where the options are the same. It changes nothing in the world but the time that it takes.
    pub previous: Option<&'a World>,
    /// Stops it.
    pub cancel: CancelToken,
}

impl World {
    /// The most objects that a world may hold.
    pub const MAX_OBJECTS: u64 = 1 << 25;

    /// How many objects a scene draws: its shapes, each as often as it is placed. Nothing is compiled.
    ///
    /// # Errors
    /// A node contains itself, or names what is not there.
    pub fn count_objects(scene: &Scene) -> Result<u64, CompileError> {
        let drawn = count_drawn(scene)?;
        Ok(scene.roots().iter().fold(0, |sum, id| drawn[id.index()].saturating_add(sum)))
    }

    /// Compiles a scene. Trees are built on the threads of the current rayon pool.
    ///
    /// Objects without a material, on themselves or above them, get the default one.
    ///
    /// # Errors
    /// The first fault found; see [`CompileError`].
    pub fn compile(scene: &Scene, options: &CompileOptions) -> Result<Self, CompileError> {
        Self::compile_with(scene, options, &CompileControl::default())
    }

    /// As [`World::compile`], from what an earlier world holds already, and until it is cancelled.
    ///
    /// After an edit of a material, a light or a transform, trees over large meshes are not built again:
    ///
    /// ```
    /// # use lancer_core::mesh::{Mesh, MeshData};
    /// # use lancer_core::scene::{Node, Scene};
    /// use lancer_core::world::{CompileControl, CompileOptions, World};
    /// # let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    /// # let triangle = MeshData { positions, indices: vec![[0, 1, 2]], ..MeshData::default() };
    /// # let mut scene = Scene::new("scan");
    /// # scene.add(Node::mesh("scan", Mesh::new(triangle)?));
    /// let options = CompileOptions::default();
    /// let world = World::compile(&scene, &options)?;
    /// scene.ambient *= 0.5;
    /// let control = CompileControl { previous: Some(&world), ..CompileControl::default() };
    /// let dimmed = World::compile_with(&scene, &options, &control)?;
    /// # assert_eq!(dimmed.statistics(), world.statistics());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// The first fault found; see [`CompileError`].
    pub fn compile_with(
        scene: &Scene,
        options: &CompileOptions,
        control: &CompileControl,
    ) -> Result<Self, CompileError> {
        let cancel = &control.cancel;
        check_numbers(scene)?;
        let drawn = count_drawn(scene)?;
        let total = scene.roots().iter().fold(0_u64, |sum, id| sum.saturating_add(drawn[id.index()]));
        if total == 0 {
            return Err(CompileError::NothingToDraw);
        }
        if total > Self::MAX_OBJECTS {
            return Err(CompileError::TooManyObjects { count: total });
        }
        let mut materials = scene.materials().to_vec();
        materials.push(Material::named("default"));
        let mut flat = Flat::default();
        flatten(scene, &drawn, cancel, &mut flat)?;
        let known = control.previous.map(|world| world.prepared_for(options)).unwrap_or_default();
        let meshes = flat
            .meshes
            .into_par_iter()
            .map(|mesh| match known.get(&address(&mesh)) {
                Some(&prepared) => Ok(Arc::clone(prepared)),
                None => {
                    let index = index_triangles(&mesh, options, cancel)?;
                    Ok(Arc::new(PreparedMesh::new(mesh, index)))
                }
            })
            .collect::<Result<Vec<_>, CompileError>>()?;
        let mut world = Self {
            objects: flat.objects,
            meshes,
            materials,
            lights: scene.lights.clone(),
            ambient: scene.ambient,
            background: scene.background,
            bounded: Vec::new(),
            boxes: arrayvec::ArrayVec::new(),
            unbounded: Vec::new(),
            frames: Vec::new(),
            index: ObjectIndex::None,
            bounds: Bounds::EMPTY,
            options: *options,
            level: options.level(),
        };
        world.index_objects(cancel)?;
        world.find_frames();
        Ok(world)
    }

    /// The meshes that a world with these options may share, by where they are: while this world holds them no
    /// other can be there.
    fn prepared_for(&self, options: &CompileOptions) -> HashMap<usize, &Arc<PreparedMesh>> {
        let meshes = if self.options == *options { &self.meshes[..] } else { &[] };
        meshes.iter().map(|prepared| (address(&prepared.mesh), prepared)).collect()
    }

    /// Finds the frames of meshes.
    fn find_frames(&mut self) {
        let meshes = &self.meshes;
        let bounds_of = |object: &Object| object.geometry.mesh_index().map(|mesh| meshes[mesh].mesh.bounds());
        for alike in self.objects.chunk_by_mut(|a, b| a.placement == b.placement) {
            let around = alike.iter().filter_map(bounds_of).fold(Bounds::EMPTY, Bounds::union);
            let size = |bounds: &Bounds| bounds.magnitude().max_element();
            let shared = self.frames.len() as u32;
            self.frames.push(around);
            for object in alike {
                object.frame = shared;
                // The precision of rays made ready for all would be too little for what is much smaller.
                if let Some(bounds) =
                    bounds_of(object).filter(|own| size(own) * ALIKE_IN_SIZE < size(&around))
                {
                    object.frame = self.frames.len() as u32;
                    self.frames.push(bounds);
                }
            }
        }
    }

    /// Sorts objects into bounded and unbounded ones and builds the tree over the former.
    fn index_objects(&mut self, cancel: &CancelToken) -> Result<(), CompileError> {
        let options = self.options;
        let mut boxes = Vec::new();
        for (index, object) in self.objects.iter().enumerate() {
            if cancel.is_cancelled() {
                return Err(CompileError::Cancelled);
            }
            let id = ObjectId(index as u32);
            let bounds = object.placement.bounds_to_world(object.geometry.bounds(&self.meshes));
            let closest = object.geometry.bounds_in_world(&object.placement, &self.meshes);
            let aabb = Aabb::around(&closest);
            if bounds.is_finite() && aabb.min.iter().chain(&aabb.max).all(|x| x.is_finite()) {
                self.bounds = self.bounds.union(bounds);
                self.bounded.push(id);
                // Of no use where there are more.
                let _ = self.boxes.try_push(closest);
                boxes.push(aabb);
            } else {
                self.unbounded.push(id);
            }
        }
        self.index = match options.accelerator {
            Accelerator::Bvh => {
                ObjectIndex::Bvh(Bvh::build_with(&boxes, Contents::Objects, options.quality, cancel)?)
            }
            Accelerator::KdTree => {
                ObjectIndex::Kd(KdTree::build_with(&ObjectBoxes(boxes), options.kd, cancel)?)
            }
            Accelerator::BruteForce => ObjectIndex::None,
        };
        Ok(())
    }
}

/// Of meshes that share a frame, none is smaller than the greatest by more. `f32` then tells places on it apart by a part
/// in 2^18 of its size, far finer than the boxes of its triangles. Untuned.
const ALIKE_IN_SIZE: f64 = 64.0;

fn index_triangles(
    mesh: &Mesh,
    options: &CompileOptions,
    cancel: &CancelToken,
) -> Result<TriangleIndex, CompileError> {
    Ok(match options.accelerator {
        Accelerator::Bvh => {
            TriangleIndex::Bvh(TriangleTree::build(mesh, options.quality, options.level(), cancel)?)
        }
        Accelerator::KdTree => TriangleIndex::Kd(KdTree::build_with(mesh, options.kd, cancel)?),
        Accelerator::BruteForce => TriangleIndex::None,
    })
}

/// The boxes of the bounded objects, for a tree.
struct ObjectBoxes(Vec<Aabb>);

impl Primitives for ObjectBoxes {
    fn count(&self) -> usize {
        self.0.len()
    }

    fn bounds(&self, primitive: u32) -> Aabb {
        self.0[primitive as usize]
    }
}

/// How many shapes each node draws, itself included; none where it is hidden. Finds cycles and dangling references on the way.
///
/// Trees may be any number of levels deep, so the walk keeps its own stack.
fn count_drawn(scene: &Scene) -> Result<Vec<u64>, CompileError> {
    #[derive(Clone, Copy, PartialEq)]
    enum State {
        New,
        Open,
        Done,
    }
    let nodes = scene.nodes();
    let mut state = vec![State::New; nodes.len()];
    let mut drawn = vec![0_u64; nodes.len()];
    let mut stack = scene.roots().to_vec();
    while let Some(&id) = stack.last() {
        let index = id.index();
        let node = scene.node(id);
        match state[index] {
            State::New => {
                state[index] = State::Open;
                let dangling = node.children.iter().any(|child| child.index() >= nodes.len())
                    || node.material.is_some_and(|material| material.index() >= scene.materials().len());
                if dangling {
                    return Err(CompileError::Dangling { node: name_of(scene, id) });
                }
                for &child in &node.children {
                    match state[child.index()] {
                        State::New => stack.push(child),
                        State::Open => return Err(CompileError::Cycle { node: name_of(scene, child) }),
                        State::Done => {}
                    }
                }
            }
            State::Open => {
                state[index] = State::Done;
                let own = u64::from(node.shape.is_some());
                let all =
                    node.children.iter().fold(own, |sum, child| sum.saturating_add(drawn[child.index()]));
                drawn[index] = if node.hidden { 0 } else { all };
                stack.pop();
            }
            State::Done => {
                stack.pop();
            }
        }
    }
    Ok(drawn)
}

#[derive(Default)]
struct Flat {
    objects: Vec<Object>,
    meshes: Vec<Arc<Mesh>>,
    mesh_indices: HashMap<usize, u32>,
}

impl Flat {
    fn geometry(&mut self, shape: &Shape) -> Geometry {
        match shape {
            Shape::Sphere => Geometry::Sphere,
            Shape::Cube => Geometry::Cube,
            Shape::Cylinder { capped } => Geometry::Cylinder { capped: *capped },
            Shape::Plane => Geometry::Plane,
            Shape::Mesh(mesh) => {
                Geometry::Mesh(*self.mesh_indices.entry(address(mesh)).or_insert_with(|| {
                    self.meshes.push(Arc::clone(mesh));
                    (self.meshes.len() - 1) as u32
                }))
            }
        }
    }
}

/// What tells a mesh from all others, as long as it lives.
fn address(mesh: &Arc<Mesh>) -> usize {
    Arc::as_ptr(mesh).addr()
}

/// Walks the tree from its roots and writes out every shape that is drawn.
fn flatten(scene: &Scene, drawn: &[u64], cancel: &CancelToken, out: &mut Flat) -> Result<(), CompileError> {
    let default_material = MaterialId::from_index(scene.materials().len());
    let mut stack: Vec<(NodeId, Transform, MaterialId)> =
        scene.roots().iter().rev().map(|&id| (id, Transform::IDENTITY, default_material)).collect();
    while let Some((id, world_from_parent, inherited)) = stack.pop() {
        if cancel.is_cancelled() {
            return Err(CompileError::Cancelled);
        }
        if drawn[id.index()] == 0 {
            continue;
        }
        let node = scene.node(id);
        let world_from_node = node.transform.then(world_from_parent);
        let material = node.material.unwrap_or(inherited);
        if let Some(shape) = &node.shape {
            let placement = Placement::new(world_from_node)
                .map_err(|_| CompileError::Singular { node: name_of(scene, id) })?;
            let geometry = out.geometry(shape);
            out.objects.push(Object { placement, frame: 0, geometry, material, node: id });
        }
        stack.extend(node.children.iter().rev().map(|&child| (child, world_from_node, material)));
    }
    Ok(())
}

fn name_of(scene: &Scene, id: NodeId) -> String {
    let name = &scene.node(id).name;
    if name.is_empty() { format!("node {}", id.index()) } else { format!("`{name}`") }
}
