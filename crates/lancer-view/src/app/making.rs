//! How a render was made, for the file that it is saved into.

use crate::worker::RenderRequest;
use lancer_core::film::Tone;
use lancer_io::image::{Encoding, Metadata};
use lancer_io::provenance::{Provenance, SceneHash, SceneSource, camera_overrides};

/// How a render was made.
pub(crate) struct Making {
    /// Where the scene comes from.
    pub(crate) source: SceneSource,
    /// What was asked for.
    pub(crate) request: RenderRequest,
    /// How it is shown.
    pub(crate) tone: Tone,
}

impl Making {
    /// What a file in that encoding says of it. A view that is not the scene's camera is recorded as overrides of it;
    /// other changes that were not saved show in the scene's hash alone.
    pub(crate) fn metadata(&self, encoding: Encoding) -> Metadata {
        let RenderRequest { scene, camera, settings, .. } = &self.request;
        let record = Provenance {
            lancer: Provenance::VERSION.to_owned(),
            scene: self.source.clone(),
            name: scene.name.clone(),
            hash: SceneHash::of(scene, camera),
            camera: None,
            region: None,
            render: *settings,
            tone: self.tone,
            set: if *camera == scene.camera { Vec::new() } else { camera_overrides(camera) },
            unrecorded: Vec::new(),
            encoding,
            dpi: None,
            passes: Vec::new(),
            pass: None,
        };
        record.metadata()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lancer_core::camera::Camera;
    use lancer_core::geometry::DVec3;
    use lancer_io::scene_file::apply_overrides;

    #[test]
    fn a_view_comes_back_from_its_overrides_bit_for_bit() {
        let mut scene = lancer_gallery::find("whitted").unwrap().build();
        let view = Camera {
            eye: DVec3::new(0.1 + 0.2, -1e-9, 1e5 / 3.0),
            target: DVec3::new(1.0 / 3.0, 2.0, -0.7),
            fov: 33.3,
            ..scene.camera
        };
        let overrides = camera_overrides(&view).iter().map(|text| text.parse().unwrap()).collect::<Vec<_>>();
        apply_overrides(&mut scene, &overrides).unwrap();
        assert_eq!(scene.camera, view);
    }
}
