//! POV-Ray 3.7: a Whitted ray tracer that can say all of a [`Picture`] but ambient occlusion.

use super::scene::{Form, Picture, Thing, as_ball, color, columns};
use super::{Entry, Peer, Place, Reading, SUPERSAMPLED, version_line};
use crate::Failure;
use lancer_core::Rgb;
use lancer_core::geometry::{DVec3, portable};
use lancer_core::mesh::MeshData;
use lancer_core::scene::Material;
use std::fmt::Write;
use std::fs;

pub(super) struct PovRay;

impl Peer for PovRay {
    fn name(&self) -> &'static str {
        "povray"
    }

    fn hint(&self) -> &'static str {
        "apt-get install povray"
    }

    fn differs(&self) -> &'static [&'static str] {
        &[
            SUPERSAMPLED,
            "leaves out what would weigh less than 1/255, its default (adc_bailout), which spares it rays",
            "a glass thing is two: what is seen, and an opaque one that only casts the shadow",
        ]
    }

    fn version(&self) -> Option<String> {
        version_line("povray", &["--version"], "POV-Ray")
    }

    fn unsuited(&self, picture: &Picture) -> Option<&'static str> {
        (picture.settings.ao.samples > 0).then_some("has no ambient occlusion")
    }

    fn entries(&self, picture: &Picture, place: &Place) -> Result<Vec<Entry>, Failure> {
        let file = place.directory.join("povray.pov");
        fs::write(&file, to_pov(picture)?)?;
        let image = place.directory.join("povray.tga");
        let settings = &picture.settings;
        let command = [
            "povray".to_owned(),
            format!("+I{}", file.display()),
            format!("+O{}", image.display()),
            // Targa without compression, as Tachyon's.
            "+FT".to_owned(),
            "File_Gamma=sRGB".to_owned(),
            format!("+W{}", settings.width * settings.samples),
            format!("+H{}", settings.height * settings.samples),
            format!("+WT{}", place.threads),
            "-A".to_owned(),
            "-D".to_owned(),
            "-GA".to_owned(),
            // The best quality, which is the default.
            "+Q9".to_owned(),
        ];
        Ok(vec![Entry::new("povray", command, image, Reading::Subpixels)])
    }
}

fn to_pov(picture: &Picture) -> Result<String, Failure> {
    let mut out = String::new();
    // Level 0 is the eye's own ray.
    let levels = picture.settings.depth.min(255) + 1;
    writeln!(out, "#version 3.7;")?;
    writeln!(
        out,
        "global_settings {{ assumed_gamma 1.0 max_trace_level {levels} ambient_light rgb {} }}",
        triple(picture.ambient)
    )?;
    writeln!(out, "background {{ rgb {} }}", triple(picture.background))?;
    write_camera(&mut out, picture)?;
    for light in &picture.lights {
        /// POV-Ray's light fades as 2 / (1 + (r / d)^2); this d is small enough for 2 d^2 / r^2.
        const FADE: f64 = 1e-3;
        let strength = light.intensity * (1.0 / (std::f64::consts::PI * 2.0 * FADE * FADE));
        writeln!(
            out,
            "light_source {{ {} color rgb {} fade_distance {FADE} fade_power 2 }}",
            vector(light.position),
            triple(strength)
        )?;
    }
    for (number, material) in picture.materials.iter().enumerate() {
        write_material(&mut out, number, material)?;
    }
    for (number, mesh) in picture.meshes.iter().enumerate() {
        write_mesh(&mut out, number, mesh.data())?;
    }
    for thing in &picture.things {
        let shape = shape(thing)?;
        let number = thing.material;
        if picture.materials[number].transmit.is_black() {
            writeln!(out, "{shape} texture {{ T{number} }} }}")?;
        } else {
            writeln!(out, "{shape} texture {{ T{number} }} interior {{ I{number} }} hollow no_shadow }}")?;
            writeln!(out, "{shape} pigment {{ rgb 0 }} no_image no_reflection }}")?;
        }
    }
    Ok(out)
}

fn write_camera(out: &mut String, picture: &Picture) -> Result<(), Failure> {
    let [right, up, backward] = picture.camera.frame()?;
    let height = 2.0 * portable::tan(0.5 * picture.camera.fov.to_radians());
    let aspect = f64::from(picture.settings.width) / f64::from(picture.settings.height);
    // Vectors rather than look_at: they carry a right-handed world into POV-Ray's left-handed one.
    writeln!(
        out,
        "camera {{ perspective location {} direction {} up {} right {} }}",
        vector(picture.camera.eye),
        vector(-backward),
        vector(up * height),
        vector(right * (height * aspect))
    )?;
    Ok(())
}

fn write_material(out: &mut String, number: usize, material: &Material) -> Result<(), Failure> {
    let sees_through = !material.transmit.is_black();
    let pigment = if sees_through {
        let [r, g, b] = material.transmit.to_array();
        format!("rgbf <{r}, {g}, {b}, 1>")
    } else {
        format!("rgb {}", triple(color(material)))
    };
    let n = material.shininess;
    let highlight = 0.5 * (n + 2.0) * super::scene::grey(material.specular);
    let metallic = super::scene::grey(material.metallic);
    let reflection = if material.fresnel {
        format!("reflection {{ rgb 0, rgb {} fresnel on }} conserve_energy", triple(material.reflect))
    } else {
        format!("reflection {{ rgb {} }}", triple(material.reflect))
    };
    let reflection = if material.reflect.is_black() { String::new() } else { reflection };
    let specular = if highlight > 0.0 {
        format!("specular {highlight} roughness {} metallic {metallic}", 1.0 / n)
    } else {
        String::new()
    };
    writeln!(
        out,
        "#declare T{number} = texture {{ pigment {{ {pigment} }} finish {{ ambient rgb {} diffuse {} {specular} \
         {reflection} }} }}",
        triple(if sees_through { Rgb::BLACK } else { material.ambient }),
        if sees_through { 0.0 } else { super::scene::grey(material.diffuse) },
    )?;
    writeln!(out, "#declare I{number} = interior {{ ior {} }}", material.ior)?;
    Ok(())
}

fn write_mesh(out: &mut String, number: usize, mesh: &MeshData) -> Result<(), Failure> {
    writeln!(out, "#declare M{number} = mesh2 {{")?;
    let lists = [("vertex_vectors", &mesh.positions), ("normal_vectors", &mesh.normals)];
    for (name, vectors) in lists.into_iter().filter(|(_, vectors)| !vectors.is_empty()) {
        write!(out, "{name} {{ {}", vectors.len())?;
        for [x, y, z] in vectors {
            write!(out, ",<{x},{y},{z}>")?;
        }
        writeln!(out, "}}")?;
    }
    write!(out, "face_indices {{ {}", mesh.indices.len())?;
    for [a, b, c] in &mesh.indices {
        write!(out, ",<{a},{b},{c}>")?;
    }
    writeln!(out, "}} }}")?;
    Ok(())
}

/// The shape in its place, its brace left open.
fn shape(thing: &Thing) -> Result<String, Failure> {
    if let (Form::Sphere, Some((center, radius))) = (thing.form, as_ball(&thing.world_from_object)) {
        return Ok(format!("sphere {{ {}, {radius}", vector(center)));
    }
    let shape = match thing.form {
        Form::Sphere => "sphere { <0,0,0>, 1".to_owned(),
        Form::Cube => "box { <-1,-1,-1>, <1,1,1>".to_owned(),
        Form::Cylinder { capped } => {
            format!("cylinder {{ <0,-1,0>, <0,1,0>, 1 {}", if capped { "" } else { "open" })
        }
        Form::Plane => "plane { <0,1,0>, 0".to_owned(),
        Form::Mesh(number) => format!("object {{ M{number}"),
    };
    let [x, y, z] = columns(&thing.world_from_object);
    let place = thing.world_from_object.translation();
    let numbers = [x, y, z, place].map(|v| format!("{},{},{}", v.x, v.y, v.z)).join(",");
    let is_placed = thing.world_from_object != lancer_core::geometry::Transform::IDENTITY;
    Ok(if is_placed { format!("{shape} matrix <{numbers}>") } else { shape })
}

fn vector(v: DVec3) -> String {
    format!("<{},{},{}>", v.x, v.y, v.z)
}

fn triple(color: Rgb) -> String {
    format!("<{},{},{}>", color.r, color.g, color.b)
}
