//! Cycles: Blender's path tracer, from the package `bpy`.

use super::mitsuba::unsuited_to_one_ray;
use super::scene::Picture;
use super::{Entry, LANCER_FILE, Peer, Place, Reading, python, version_line};
use crate::Failure;
use std::fs;

pub(super) struct Cycles;

impl Peer for Cycles {
    fn name(&self) -> &'static str {
        "cycles"
    }

    fn hint(&self) -> &'static str {
        "pip install bpy"
    }

    fn differs(&self) -> &'static [&'static str] {
        &[
            "9 samples a pixel; each follows the reflection or the refraction of glass, and picks one light",
            "no diffuse bounces, no denoising; the ambient light is a glow of the surfaces; balls are meshes",
            "the ground ends after 10,000 units; the start of Python and of Blender is in the whole time",
        ]
    }

    fn version(&self) -> Option<String> {
        let print = "import bpy; print('Blender', bpy.app.version_string)";
        version_line(&python(), &["-c", print], "Blender")
    }

    fn unsuited(&self, picture: &Picture) -> Option<&'static str> {
        if picture.settings.ao.samples > 0 {
            return Some("has no ambient occlusion of Lancer's kind");
        }
        unsuited_to_one_ray(picture)
    }

    fn entries(&self, picture: &Picture, place: &Place) -> Result<Vec<Entry>, Failure> {
        picture.write_meshes(&place.directory)?;
        let script = place.directory.join("cycles-peer.py");
        fs::write(&script, include_str!("cycles.py"))?;
        let image = place.directory.join("cycles.png");
        let command = [
            python(),
            script.display().to_string(),
            place.directory.join(LANCER_FILE).display().to_string(),
            place.threads.to_string(),
            image.display().to_string(),
        ];
        Ok(vec![Entry::new("cycles", command, image, Reading::Finished)])
    }
}
