//! Mitsuba 3: a path tracer, scalar or compiled by LLVM for the processor's vectors.
//!
//! Its script reads Lancer's scene file. Beside Mitsuba's own path tracer, which lets light bounce between matte
//! surfaces, the script has an integrator with Lancer's model, for the compiled variant.

use super::scene::{Form, Picture};
use super::{Entry, LANCER_FILE, Peer, Place, Reading, python, version_line};
use crate::Failure;
use lancer_core::scene::Material;
use std::fs;

pub(super) struct Mitsuba;

/// Label, variant, integrator.
const WAYS: [[&str; 3]; 3] = [
    ["mitsuba scalar path", "scalar_rgb", "path"],
    ["mitsuba llvm path", "llvm_ad_rgb", "path"],
    ["mitsuba llvm whitted", "llvm_ad_rgb", "whitted"],
];

impl Peer for Mitsuba {
    fn name(&self) -> &'static str {
        "mitsuba"
    }

    fn hint(&self) -> &'static str {
        "pip install mitsuba, and for llvm apt-get install libllvm19"
    }

    fn differs(&self) -> &'static [&'static str] {
        &[
            "9 stratified samples a pixel; each follows the reflection or the refraction of glass, not both",
            "path: light bounces between matte surfaces, and the sky lights them in place of the ambient light",
            "whitted: our integrator with Lancer's model in its Python interface, both lights at each sample",
            "llvm: what was compiled in an earlier turn is found again, since Dr.Jit keeps it on disk",
            "the ground ends after 10,000 units; the start of Python is in the whole time",
        ]
    }

    fn version(&self) -> Option<String> {
        let print = "import mitsuba; print('Mitsuba', mitsuba.__version__)";
        version_line(&python(), &["-c", print], "Mitsuba")
    }

    fn unsuited(&self, picture: &Picture) -> Option<&'static str> {
        if picture.settings.ao.samples > 0 {
            return Some("has no ambient occlusion of Lancer's kind");
        }
        unsuited_to_one_ray(picture)
    }

    fn entries(&self, picture: &Picture, place: &Place) -> Result<Vec<Entry>, Failure> {
        picture.write_meshes(&place.directory)?;
        let script = place.directory.join("mitsuba-peer.py");
        fs::write(&script, include_str!("mitsuba.py"))?;
        let entry = |[label, variant, integrator]: [&'static str; 3]| {
            let image = place.directory.join(format!("{}.png", label.replace(' ', "-")));
            let command = [
                python(),
                script.display().to_string(),
                place.directory.join(LANCER_FILE).display().to_string(),
                variant.to_owned(),
                integrator.to_owned(),
                place.threads.to_string(),
                image.display().to_string(),
            ];
            Entry::new(label, command, image, Reading::Finished)
        };
        Ok(WAYS.map(entry).into())
    }
}

/// Why a renderer whose surfaces send one ray on, by chance, and whose glass is physical, cannot draw a picture.
pub(super) fn unsuited_to_one_ray(picture: &Picture) -> Option<&'static str> {
    let forms = picture.things.iter().map(|thing| thing.form);
    if forms.into_iter().any(|form| matches!(form, Form::Cube | Form::Cylinder { .. })) {
        return Some("is given balls, planes and meshes alone");
    }
    let is_mixed = |material: &Material| {
        let smooth = !material.reflect.is_black() || !material.transmit.is_black();
        let plain_glass = !material.transmit.is_black() && !material.fresnel;
        plain_glass || !material.specular.is_black() || smooth && !material.diffuse.is_black()
    };
    picture
        .any_material(is_mixed)
        .then_some("has no surfaces that are glossy, matte and clear in fixed parts")
}
