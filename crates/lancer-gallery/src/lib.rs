//! The built-in scenes.
//!
//! Each is a file in `scenes/` that implements [`BuiltinScene`], and a line in [`SCENES`]. To add your own, write
//! such a file and such a line; `docs/add-a-scene.md` shows how.

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
