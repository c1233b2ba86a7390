//! The world that is traced, compiled only when it must be.

use super::alike::{shared_meshes, traces_alike};
use lancer_core::render::CancelToken;
use lancer_core::scene::Scene;
use lancer_core::world::{CompileControl, CompileError, CompileOptions, World};
use std::sync::Arc;

/// A scene with its world. As long as the scene is held here, nobody edits it in place.
pub(super) struct Compiled {
    pub(super) scene: Arc<Scene>,
    pub(super) options: CompileOptions,
    pub(super) world: Arc<World>,
}

/// The world that was asked for last, and one that is likely to be asked for next.
#[derive(Default)]
pub(super) struct Worlds {
    last: Option<Compiled>,
    opened: Option<Compiled>,
}

impl Worlds {
    /// Takes in a scene that was opened, until it is asked for.
    pub(super) fn expect(&mut self, opened: Compiled) {
        self.opened = Some(opened);
    }

    /// The world of a scene. A world that is known is used again where its scene traces alike; else the one that
    /// shares most meshes lends its trees.
    ///
    /// # Errors
    /// See [`CompileError`].
    pub(super) fn world(
        &mut self,
        scene: &Arc<Scene>,
        options: &CompileOptions,
        cancel: &CancelToken,
    ) -> Result<Arc<World>, CompileError> {
        let (nearest, from_opened) = self.nearest(scene, options);
        let world = match nearest {
            Some(known) if traces_alike(&known.scene, scene) => Arc::clone(&known.world),
            _ => {
                let previous = nearest.map(|known| known.world.as_ref());
                let control = CompileControl { previous, cancel: cancel.clone() };
                Arc::new(World::compile_with(scene, options, &control)?)
            }
        };
        if from_opened {
            self.opened = None;
        }
        self.last = Some(Compiled { scene: Arc::clone(scene), options: *options, world: Arc::clone(&world) });
        Ok(world)
    }

    /// The world of these options that is of most use for a scene, and whether it is the one that was opened.
    fn nearest(&self, scene: &Arc<Scene>, options: &CompileOptions) -> (Option<&Compiled>, bool) {
        let usable = |known: &&Compiled| known.options == *options;
        let last = self.last.as_ref().filter(usable);
        let opened = self.opened.as_ref().filter(usable);
        let use_of =
            |known: &Compiled| (traces_alike(&known.scene, scene), shared_meshes(scene, &known.scene));
        let of_no_use = (false, 0);
        let from_opened = opened.map_or(of_no_use, use_of) > last.map_or(of_no_use, use_of);
        (if from_opened { opened } else { last }, from_opened)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::worker::tests::scene;
    use lancer_core::Rgb;
    use lancer_core::accel::Accelerator;
    use lancer_core::mesh::{Mesh, MeshData};
    use lancer_core::scene::Node;

    fn world(worlds: &mut Worlds, scene: &Scene, options: &CompileOptions) -> Arc<World> {
        worlds.world(&Arc::new(scene.clone()), options, &CancelToken::default()).unwrap()
    }

    #[test]
    fn a_scene_that_traces_alike_is_not_compiled_again() {
        let (mut worlds, options) = (Worlds::default(), CompileOptions::default());
        let mut scene = scene();
        let first = world(&mut worlds, &scene, &options);
        scene.name = "another".into();
        scene.tone.exposure = 1.0;
        scene.camera.fov = 20.0;
        scene.settings.depth = 1;
        scene.materials_mut()[0].name = "another".into();
        assert!(Arc::ptr_eq(&first, &world(&mut worlds, &scene, &options)));
        scene.materials_mut()[0].diffuse = Rgb::grey(0.1);
        assert!(!Arc::ptr_eq(&first, &world(&mut worlds, &scene, &options)));
    }

    #[test]
    fn other_options_make_another_world() {
        let mut worlds = Worlds::default();
        let options = CompileOptions::default();
        let kd = CompileOptions { accelerator: Accelerator::KdTree, ..options };
        let first = world(&mut worlds, &scene(), &options);
        assert!(!Arc::ptr_eq(&first, &world(&mut worlds, &scene(), &kd)));
    }

    /// A scene with a mesh of its own.
    fn scan() -> Scene {
        let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let data = MeshData { positions, indices: vec![[0, 1, 2]], ..MeshData::default() };
        let mut scene = scene();
        scene.add(Node::mesh("scan", Mesh::new(data).unwrap()));
        scene
    }

    #[test]
    fn an_edited_scene_takes_its_trees_from_the_world_that_has_its_meshes() {
        let (mut worlds, options) = (Worlds::default(), CompileOptions::default());
        let (old, new) = (scan(), scan());
        let opened = Arc::new(World::compile(&new, &options).unwrap());
        worlds.expect(Compiled { scene: Arc::new(new.clone()), options, world: Arc::clone(&opened) });
        let shown = world(&mut worlds, &old, &options);
        for (mut scene, lender) in [(old, shown), (new, opened)] {
            scene.materials_mut()[0].diffuse = Rgb::grey(0.1);
            let (nearest, _) = worlds.nearest(&Arc::new(scene), &options);
            assert!(nearest.is_some_and(|nearest| Arc::ptr_eq(&nearest.world, &lender)));
        }
    }

    #[test]
    fn a_scene_that_was_opened_is_taken_up_when_it_is_asked_for_and_kept_until_then() {
        let (mut worlds, options) = (Worlds::default(), CompileOptions::default());
        let old = scene();
        let shown = world(&mut worlds, &old, &options);
        let mut new = scene();
        new.lights.clear();
        let opened = Arc::new(World::compile(&new, &options).unwrap());
        worlds.expect(Compiled { scene: Arc::new(new.clone()), options, world: Arc::clone(&opened) });
        assert!(Arc::ptr_eq(&shown, &world(&mut worlds, &old, &options)));
        assert!(Arc::ptr_eq(&opened, &world(&mut worlds, &new, &options)));
    }
}
