//! Tachyon 0.99: a fast Whitted ray tracer with ambient occlusion, and without refraction.

use super::scene::{Form, Picture, Thing, as_ball, color, columns, grey};
use super::{Entry, Peer, Place, Reading, SUPERSAMPLED, version_line};
use crate::Failure;
use lancer_core::Rgb;
use lancer_core::geometry::{DVec3, portable};
use lancer_core::mesh::MeshData;
use lancer_core::scene::Material;
use std::fmt::Write;
use std::fs;

pub(super) struct Tachyon;

/// Beyond the rounding of a chain of rotations, and far below a pixel.
const SLACK: f64 = 1e-9;

impl Peer for Tachyon {
    fn name(&self) -> &'static str {
        "tachyon"
    }

    fn hint(&self) -> &'static str {
        "apt-get install tachyon"
    }

    fn differs(&self) -> &'static [&'static str] {
        &[
            SUPERSAMPLED,
            "what is seen through lets light through too: its shadow is grey and Lancer's black",
            "mirrors and ambient light are grey; cubes are 12 triangles each",
            "takes the same directions of ambient occlusion at every point: bands where Lancer has noise",
        ]
    }

    fn version(&self) -> Option<String> {
        version_line("tachyon", &["-version"], "").map(|number| format!("Tachyon {number}"))
    }

    fn unsuited(&self, picture: &Picture) -> Option<&'static str> {
        let bends =
            |material: &Material| material.fresnel || !material.transmit.is_black() && material.ior != 1.0;
        if picture.any_material(bends) {
            return Some("has no refraction");
        }
        let stretched = |thing: &Thing| match thing.form {
            Form::Sphere => as_ball(&thing.world_from_object).is_none(),
            Form::Cylinder { .. } => !is_round(thing),
            _ => false,
        };
        picture.things.iter().any(stretched).then_some("has no stretched spheres and cylinders")
    }

    fn entries(&self, picture: &Picture, place: &Place) -> Result<Vec<Entry>, Failure> {
        let file = place.directory.join("tachyon.dat");
        fs::write(&file, to_dat(picture)?)?;
        let image = place.directory.join("tachyon.tga");
        let settings = &picture.settings;
        let command = [
            "tachyon".to_owned(),
            file.display().to_string(),
            "-o".to_owned(),
            image.display().to_string(),
            "-format".to_owned(),
            "TARGA".to_owned(),
            "-res".to_owned(),
            (settings.width * settings.samples).to_string(),
            (settings.height * settings.samples).to_string(),
            "-aasamples".to_owned(),
            "0".to_owned(),
            "-numthreads".to_owned(),
            place.threads.to_string(),
            "-trans_max_surfaces".to_owned(),
            (settings.depth + 1).to_string(),
        ];
        Ok(vec![Entry::new("tachyon", command, image, Reading::LinearSubpixels)])
    }
}

fn to_dat(picture: &Picture) -> Result<String, Failure> {
    let mut out = String::new();
    let settings = &picture.settings;
    writeln!(out, "BEGIN_SCENE\nRESOLUTION {} {}", settings.width, settings.height)?;
    if settings.ao.samples > 0 {
        // It traces every direction, those below the horizon turned over; Lancer half of its count.
        writeln!(
            out,
            "SHADER_MODE FULL AMBIENT_OCCLUSION AMBIENT_COLOR {} RESCALE_DIRECT 1.0 SAMPLES {} END_SHADER_MODE",
            triple(picture.ambient),
            settings.ao.samples / 2
        )?;
    }
    let [_, up, backward] = picture.camera.frame()?;
    let zoom = 0.5 / portable::tan(0.5 * picture.camera.fov.to_radians());
    writeln!(
        out,
        "CAMERA ZOOM {zoom} ASPECTRATIO 1 ANTIALIASING 0 RAYDEPTH {} CENTER {} VIEWDIR {} UPDIR {} END_CAMERA",
        settings.depth + 1,
        vector(picture.camera.eye),
        vector(-backward),
        vector(up)
    )?;
    writeln!(out, "BACKGROUND {}", triple(picture.background))?;
    for light in &picture.lights {
        // Spread over both numbers, since it ignores light below a threshold before its colour is known.
        let reach = light.position.length_squared();
        writeln!(
            out,
            "LIGHT CENTER {} RAD 0.0001 ATTENUATION CONSTANT 0 LINEAR 0 QUADRATIC {} COLOR {}",
            vector(light.position),
            1.0 / reach,
            triple(light.intensity * (1.0 / (std::f64::consts::PI * reach)))
        )?;
    }
    for (number, material) in picture.materials.iter().enumerate() {
        write_material(&mut out, number, material, picture)?;
    }
    for thing in &picture.things {
        write_thing(&mut out, thing, picture)?;
    }
    writeln!(out, "END_SCENE")?;
    Ok(out)
}

fn write_material(
    out: &mut String,
    number: usize,
    material: &Material,
    picture: &Picture,
) -> Result<(), Failure> {
    let through = grey(material.transmit);
    // With occlusion the ambient light is the scene's, weighted by DIFFUSE.
    let occluded = picture.settings.ao.samples > 0;
    let ambient = if occluded { 0.0 } else { grey(material.ambient * picture.ambient) };
    let n = material.shininess;
    let kind = if grey(material.metallic) > 0.5 { "METAL" } else { "PLASTIC" };
    writeln!(
        out,
        "TEXDEF t{number} AMBIENT {ambient} DIFFUSE {} SPECULAR {} OPACITY {} PHONG {kind} {} PHONG_SIZE {n} COLOR \
         {} TEXFUNC 0",
        grey(material.diffuse),
        grey(material.reflect),
        1.0 - through,
        0.5 * (n + 2.0) * grey(material.specular),
        triple(color(material))
    )?;
    Ok(())
}

fn write_thing(out: &mut String, thing: &Thing, picture: &Picture) -> Result<(), Failure> {
    let texture = thing.material;
    let place = &thing.world_from_object;
    let center = place.translation();
    let [x, y, z] = columns(place);
    match thing.form {
        Form::Sphere => {
            let (center, radius) = as_ball(place).ok_or("a stretched sphere")?;
            writeln!(out, "SPHERE CENTER {} RAD {radius} t{texture}", vector(center))?;
        }
        Form::Plane => {
            writeln!(out, "PLANE CENTER {} NORMAL {} t{texture}", vector(center), vector(z.cross(x)))?;
        }
        Form::Cylinder { capped } => {
            let radius = x.length();
            let ends = [center - y, center + y];
            let [base, apex] = ends.map(vector);
            writeln!(out, "FCYLINDER BASE {base} APEX {apex} RAD {radius} t{texture}")?;
            for (end, outward) in ends.into_iter().zip([-y, y]).filter(|_| capped) {
                let normal = vector(outward.normalize());
                writeln!(
                    out,
                    "RING CENTER {} NORMAL {normal} INNER 0 OUTER {radius} t{texture}",
                    vector(end)
                )?;
            }
        }
        // Its own box has the normals of a cube, whatever its sides.
        Form::Cube => {
            for corners in cube_triangles() {
                write_triangle(out, corners.map(|corner| place.point(corner)), None, texture)?;
            }
        }
        Form::Mesh(number) => write_mesh(out, picture.meshes[number].data(), thing)?,
    }
    Ok(())
}

fn write_mesh(out: &mut String, mesh: &MeshData, thing: &Thing) -> Result<(), Failure> {
    let place = &thing.world_from_object;
    let wide = |v: [f32; 3]| DVec3::from(v.map(f64::from));
    let normals_in_world = place.linear().inverse().transpose();
    for corners in &mesh.indices {
        let points = corners.map(|i| place.point(wide(mesh.positions[i as usize])));
        let normals = (!mesh.normals.is_empty())
            .then(|| corners.map(|i| (normals_in_world * wide(mesh.normals[i as usize])).normalize()));
        write_triangle(out, points, normals, thing.material)?;
    }
    Ok(())
}

fn write_triangle(
    out: &mut String,
    points: [DVec3; 3],
    normals: Option<[DVec3; 3]>,
    texture: usize,
) -> Result<(), Failure> {
    // The turned axis turns what is counterclockwise round.
    let [a, c, b] = points.map(vector);
    match normals.map(|[p, r, q]| [p, q, r].map(vector)) {
        None => writeln!(out, "TRI V0 {a} V1 {b} V2 {c} t{texture}")?,
        Some([p, q, r]) => writeln!(out, "STRI V0 {a} V1 {b} V2 {c} N0 {p} N1 {q} N2 {r} t{texture}")?,
    }
    Ok(())
}

/// Counterclockwise as seen from outside.
fn cube_triangles() -> Vec<[DVec3; 3]> {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let mut triangles = Vec::new();
    for (i, side) in (0..3).flat_map(|i| [1.0, -1.0].map(|side| (i, side))) {
        let (face, u, v) = (axes[i] * side, axes[(i + 1) % 3], axes[(i + 2) % 3]);
        let (u, v) = if side > 0.0 { (u, v) } else { (v, u) };
        triangles.push([face - u - v, face + u - v, face + u + v]);
        triangles.push([face - u - v, face + u + v, face - u + v]);
    }
    triangles
}

/// Whether a cylinder still has round ends at right angles to its axis.
fn is_round(thing: &Thing) -> bool {
    let [x, y, z] = columns(&thing.world_from_object);
    let right_angles = [x.dot(y), y.dot(z), z.dot(x)].iter().all(|dot| dot.abs() < SLACK);
    right_angles && (x.length() - z.length()).abs() < SLACK
}

/// With the third axis turned round: Tachyon's world is left-handed.
fn vector(v: DVec3) -> String {
    format!("{} {} {}", v.x, v.y, -v.z)
}

fn triple(color: Rgb) -> String {
    format!("{} {} {}", color.r, color.g, color.b)
}
