//! The numbers that an author gave, before anything is made of them.

use super::CompileError;
use crate::color::Rgb;
use crate::scene::{Light, Material, Scene, Texture};

/// Checks every number that an author gave, so that tracing need not.
pub(super) fn check_numbers(scene: &Scene) -> Result<(), CompileError> {
    let light = |what: String, ok: bool| if ok { Ok(()) } else { Err(CompileError::Light { what }) };
    light("the ambient light".into(), is_intensity(scene.ambient))?;
    light("the background".into(), is_intensity(scene.background))?;
    for (index, Light { name, position, intensity }) in scene.lights.iter().enumerate() {
        let ok = position.is_finite() && is_intensity(*intensity);
        let label = if name.is_empty() { format!("light {index}") } else { format!("light `{name}`") };
        light(label, ok)?;
    }
    scene.materials().iter().enumerate().try_for_each(|(index, material)| check_material(index, material))
}

fn check_material(index: usize, material: &Material) -> Result<(), CompileError> {
    let not_negative = "must be finite and not negative";
    let colors = match &material.color {
        Texture::Solid(color) => vec![*color],
        Texture::Checker { even, odd, .. } => vec![*even, *odd],
        Texture::Image { .. } => Vec::new(),
    };
    let checker_size = match material.color {
        Texture::Checker { size, .. } => size,
        _ => 1.0,
    };
    let checks = [
        ("color", not_negative, colors.into_iter().all(is_intensity)),
        ("the checker's size", "must be finite and above 0", checker_size.is_finite() && checker_size > 0.0),
        ("ambient", not_negative, is_intensity(material.ambient)),
        ("diffuse", not_negative, is_intensity(material.diffuse)),
        ("specular", not_negative, is_intensity(material.specular)),
        ("metallic", not_negative, is_intensity(material.metallic)),
        ("shininess", not_negative, is_intensity(material.shininess.into())),
        ("reflect", not_negative, is_intensity(material.reflect)),
        ("transmit", not_negative, is_intensity(material.transmit)),
        ("ior", "must be finite and above 0", material.ior.is_finite() && material.ior > 0.0),
    ];
    match checks.into_iter().find(|(_, _, ok)| !ok) {
        None => Ok(()),
        Some((property, requirement, _)) => {
            let name = &material.name;
            let material =
                if name.is_empty() { format!("material {index}") } else { format!("material `{name}`") };
            Err(CompileError::Material { material, property, requirement })
        }
    }
}

fn is_intensity(color: Rgb) -> bool {
    color.to_array().iter().all(|channel| channel.is_finite() && *channel >= 0.0)
}
