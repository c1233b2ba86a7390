//! The built-in scenes.
//!
//! Each is a file in `scenes/` that implements [`BuiltinScene`], and a line in [`SCENES`]. To add your own, write
//! such a file and such a line; `docs/add-a-scene.md` shows how.
//!
//! ```
//! use lancer_core::world::{CompileOptions, World};
//!
//! let scene = lancer_gallery::find("whitted").expect("it is listed").build();
//! let world = World::compile(&scene, &CompileOptions::default())?;
//! assert_eq!(world.lights().len(), scene.lights.len());
//! # Ok::<(), lancer_core::world::CompileError>(())
//! ```

mod parts;
mod scenes;

use lancer_core::scene::Scene;

/// A scene that is made by code.
pub trait BuiltinScene: Sync {
    /// Its name on the command line: lower case, words joined by hyphens.
    fn name(&self) -> &'static str;

    /// What it shows, in one line without a full stop.
    fn summary(&self) -> &'static str;

    /// Makes it. The same scene each time.
    fn build(&self) -> Scene;
}

/// The scene that is rendered where none is named.
pub const DEFAULT: &str = "whitted";

/// All built-in scenes, in the order in which they are listed.
pub const SCENES: &[&dyn BuiltinScene] = &[
    &scenes::whitted::Whitted,
    &scenes::primitives::Primitives,
    &scenes::highlights::Highlights,
    &scenes::shadows::Shadows,
    &scenes::mirrors::Mirrors,
    &scenes::glass::Glass,
    &scenes::occlusion::Occlusion,
    &scenes::supersampling::Supersampling,
    &scenes::teapot::Teapot,
    &scenes::sphereflake::Sphereflake,
    &scenes::mirror_room::MirrorRoom,
    &scenes::ten_thousand::TenThousand,
];

/// The scene of a name.
pub fn find(name: &str) -> Option<&'static dyn BuiltinScene> {
    SCENES.iter().copied().find(|scene| scene.name() == name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use lancer_core::world::{CompileOptions, World};
    use std::collections::BTreeSet;

    #[test]
    fn names_are_lower_case_words_joined_by_hyphens_and_no_two_are_the_same() {
        let names = SCENES.iter().map(|scene| scene.name()).collect::<BTreeSet<_>>();
        assert_eq!(names.len(), SCENES.len());
        for name in names {
            let is_word = |word: &str| {
                !word.is_empty() && word.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit())
            };
            assert!(name.split('-').all(is_word), "{name:?} is no name");
        }
    }

    #[test]
    fn summaries_are_one_line_without_a_full_stop() {
        for scene in SCENES {
            let summary = scene.summary();
            let well_formed = !summary.is_empty() && !summary.contains('\n') && !summary.ends_with('.');
            assert!(well_formed, "{}: {summary:?}", scene.name());
        }
    }

    #[test]
    fn every_scene_is_found_by_its_name_and_nothing_by_another() {
        for scene in SCENES {
            assert_eq!(find(scene.name()).map(BuiltinScene::summary), Some(scene.summary()));
        }
        assert!(find(DEFAULT).is_some());
        assert!(find("no such scene").is_none());
    }

    #[test]
    fn every_scene_is_the_same_each_time_and_can_be_traced_from_all_of_its_cameras() {
        for builtin in SCENES {
            let scene = builtin.build();
            assert!(scene == builtin.build(), "{} changes", builtin.name());
            let traced = World::compile(&scene, &CompileOptions::default());
            assert!(traced.is_ok(), "{}: {:?}", builtin.name(), traced.err());
            assert_eq!(scene.settings.validate(), Ok(()), "{}", builtin.name());
            for (name, camera) in &scene.cameras {
                assert!(camera.frame().is_ok(), "{}: the camera {name:?}", builtin.name());
            }
        }
    }

    /// A group that does nothing but put another node in its place may be nameless: one has ten thousand of them.
    #[test]
    fn everything_that_is_drawn_and_every_root_material_and_camera_has_a_name() {
        for builtin in SCENES {
            let scene = builtin.build();
            let drawn = scene.nodes().iter().filter(|node| node.shape.is_some()).map(|node| &node.name);
            let roots = scene.roots().iter().map(|&root| &scene.node(root).name);
            let materials = scene.materials().iter().map(|material| &material.name);
            let cameras = scene.cameras.iter().map(|(name, _)| name);
            let nameless = drawn.chain(roots).chain(materials).chain(cameras).filter(|name| name.is_empty());
            assert_eq!(nameless.count(), 0, "{}", builtin.name());
        }
    }
}
