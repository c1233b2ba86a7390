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
        let shared = |known: &Option<Compiled>| {
            let known = known.as_ref().filter(|known| known.options == *options)?;
            Some((traces_alike(&known.scene, scene), shared_meshes(scene, &known.scene)))
        };
        let from_opened = shared(&self.opened) > shared(&self.last);
        let nearest = if from_opened { &self.opened } else { &self.last };
        let world = match nearest {
            Some(known) if known.options == *options && traces_alike(&known.scene, scene) => {
                Arc::clone(&known.world)
            }
            _ => {
                let previous = nearest.as_ref().map(|known| known.world.as_ref());
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
}
