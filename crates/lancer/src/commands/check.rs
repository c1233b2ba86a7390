//! `lancer check`: a scene read, validated and compiled, and not rendered.

use crate::args::CheckArgs;
use crate::error::Error;
use crate::source::{Source, read};
use crate::terminal;
use lancer_core::scene::Scene;
use lancer_core::world::{CompileOptions, World, WorldStatistics};
use lancer_io::diagnostics::LoadError;

/// Prints that all is well, with a summary.
///
/// # Errors
/// All that is wrong with the scene.
pub(crate) fn run(args: &CheckArgs) -> Result<(), Error> {
    let source = Source::find(Some(&args.scene))?;
    let loaded = read(&source, &args.files)?;
    loaded.warnings.iter().for_each(terminal::tell_warning);
    let world = validated(&loaded.scene).map_err(|faults| LoadError {
        diagnostics: faults.iter().map(|fault| source.diagnostic(fault)).collect(),
    })?;
    terminal::print(format!("ok: {source}: {}\n", summary(&loaded.scene, &world)))
}

/// What the scene holds once it is compiled, or all that keeps it from being rendered.
fn validated(scene: &Scene) -> Result<WorldStatistics, Vec<String>> {
    let mut faults = Vec::new();
    faults.extend(scene.settings.validate().err().map(|error| error.to_string()));
    faults.extend(scene.camera.frame().err().map(|error| error.to_string()));
    for (name, camera) in &scene.cameras {
        faults.extend(camera.frame().err().map(|error| format!("in camera `{name}`: {error}")));
    }
    match World::compile(scene, &CompileOptions::default()) {
        Ok(world) if faults.is_empty() => Ok(world.statistics()),
        Ok(_) => Err(faults),
        Err(error) => {
            faults.push(error.to_string());
            Err(faults)
        }
    }
}

fn summary(scene: &Scene, world: &WorldStatistics) -> String {
    let counts = [
        (world.objects as u64, "object"),
        (world.instanced_triangles, "triangle"),
        (scene.materials().len() as u64, "material"),
        (scene.lights.len() as u64, "light"),
        (1 + scene.cameras.len() as u64, "camera"),
    ];
    counts.map(|(count, what)| format!("{count} {what}{}", if count == 1 { "" } else { "s" })).join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use lancer_core::camera::Camera;
    use lancer_core::scene::{Node, Shape};

    #[test]
    fn all_faults_are_told_at_once() {
        let mut scene = Scene::new("broken");
        scene.settings.width = 0;
        scene.camera.fov = 0.0;
        scene
            .cameras
            .push(("top".into(), Camera { up: lancer_core::geometry::DVec3::ZERO, ..Camera::default() }));
        let faults = validated(&scene).unwrap_err();
        assert_eq!(faults.len(), 4, "{faults:?}");
        assert!(faults[2].contains("`top`"));
    }

    #[test]
    fn a_summary_counts_in_words() {
        let mut scene = Scene::new("one ball");
        scene.add(Node::shape("ball", Shape::Sphere));
        let world = validated(&scene).unwrap();
        assert_eq!(summary(&scene, &world), "1 object, 0 triangles, 0 materials, 0 lights, 1 camera");
    }
}
