//! What several scenes are made of: transforms under short names, lamps, materials, and meshes turned on a lathe.

use lancer_core::Rgb;
use lancer_core::geometry::{DVec3, Transform, portable};
use lancer_core::mesh::{Mesh, MeshData};
use lancer_core::scene::{Light, Material, Scene, Texture};
use std::f64::consts::{PI, TAU};

/// Moves to a point.
pub(crate) fn at(x: f64, y: f64, z: f64) -> Transform {
    Transform::translate(DVec3::new(x, y, z))
}

/// Scales by the same factor every way.
pub(crate) fn scale(factor: f64) -> Transform {
    Transform::scale(DVec3::splat(factor))
}

/// Stretches by one factor an axis.
pub(crate) fn stretch(x: f64, y: f64, z: f64) -> Transform {
    Transform::scale(DVec3::new(x, y, z))
}

/// Turns about an axis, in degrees.
pub(crate) fn turn(axis: DVec3, degrees: f64) -> Transform {
    Transform::rotate(axis, degrees)
}

/// A box standing on y = 0 instead of reaching from -1 to 1: `stretch` that leaves the foot where it is.
pub(crate) fn standing(half_width: f64, height: f64, half_depth: f64) -> Transform {
    at(0.0, 1.0, 0.0).then(stretch(half_width, 0.5 * height, half_depth))
}

/// A lamp by what it gives rather than by what it is: `irradiance` on a surface at `target` that faces it.
pub(crate) fn lamp(name: &str, position: DVec3, target: DVec3, irradiance: Rgb) -> Light {
    let intensity = irradiance * (PI * position.distance_squared(target));
    Light { name: name.into(), position, intensity }
}

/// Lays the colour of the far floor on the background, so that an endless floor of the colour `floor` has no
/// horizon: far from every lamp only its ambient light is left.
pub(crate) fn melt_horizon(scene: &mut Scene, floor: Rgb) {
    scene.background = scene.ambient * floor;
}

/// Two colours by turns.
pub(crate) fn checker(even: Rgb, odd: Rgb, size: f64) -> Texture {
    Texture::Checker { even, odd, size }
}

/// Chalk, clay, paper: no highlight.
pub(crate) fn matte(name: &str, color: impl Into<Texture>) -> Material {
    Material { color: color.into(), ..Material::named(name) }
}

/// Lacquer: a colour under a small white highlight.
pub(crate) fn lacquer(name: &str, color: impl Into<Texture>) -> Material {
    Material { specular: Rgb::grey(0.02), shininess: 120.0, ..matte(name, color) }
}

/// A mirror that keeps the share `tint` of each channel, and has no colour of its own but its highlight.
pub(crate) fn mirror(name: &str, tint: Rgb) -> Material {
    Material {
        color: tint.into(),
        ambient: Rgb::BLACK,
        diffuse: Rgb::BLACK,
        specular: Rgb::grey(0.01),
        metallic: Rgb::WHITE,
        shininess: 600.0,
        reflect: tint,
        ..Material::named(name)
    }
}

/// A clear dielectric, which mirrors and lets through as Fresnel's equations have it.
pub(crate) fn clear(name: &str, ior: f64, tint: Rgb) -> Material {
    Material {
        color: tint.into(),
        ambient: Rgb::BLACK,
        diffuse: Rgb::BLACK,
        specular: Rgb::grey(0.01),
        shininess: 800.0,
        reflect: Rgb::WHITE,
        transmit: tint,
        ior,
        fresnel: true,
        ..Material::named(name)
    }
}

/// How a lathe leaves its work.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Finish {
    /// Flat facets.
    Cut,
    /// Vertex normals, so that facets look round.
    Polished,
}

/// The surface that `profile` sweeps about the y axis in `steps` equal steps.
///
/// The profile lists (radius, height) with the solid on its left: upward along the outside. Texture coordinates
/// run once around and once along it.
///
/// # Panics
/// Where the profile or the steps make no triangle.
pub(crate) fn lathe(profile: &[[f64; 2]], steps: u32, finish: Finish) -> Mesh {
    let rings = profile.len() as u32;
    let mut data = MeshData::default();
    for step in 0..=steps {
        let turn = f64::from(step) / f64::from(steps);
        // The last step lies exactly on the first: no seam opens between sin(0) and sin(2 pi).
        let (sin, cos) = portable::sin_cos(if step == steps { 0.0 } else { TAU * turn });
        for (ring, &[radius, height]) in profile.iter().enumerate() {
            data.positions.push([radius * sin, height, radius * cos].map(|x| x as f32));
            data.uvs.push([turn as f32, ring as f32 / (rings - 1) as f32]);
            if finish == Finish::Polished {
                let [out, up] = profile_normal(profile, ring);
                data.normals.push([out * sin, up, out * cos].map(|x| x as f32));
            }
        }
    }
    for (step, ring) in (0..steps).flat_map(|step| (0..rings - 1).map(move |ring| (step, ring))) {
        let here = step * rings + ring;
        let next = here + rings;
        // On the axis a quadrilateral is a triangle.
        if profile[ring as usize][0] != 0.0 {
            data.indices.push([here, next, next + 1]);
        }
        if profile[ring as usize + 1][0] != 0.0 {
            data.indices.push([here, next + 1, here + 1]);
        }
    }
    Mesh::new(data).expect("a profile of two points or more and three steps or more make a mesh")
}

/// The outward normal of a profile at one of its points, across the chord of its neighbours; a closed profile's
/// ends are each other's.
fn profile_normal(profile: &[[f64; 2]], ring: usize) -> [f64; 2] {
    let last = profile.len() - 1;
    let closed = profile[0] == profile[last];
    let before = if ring > 0 {
        ring - 1
    } else if closed {
        last - 1
    } else {
        0
    };
    let after = if ring < last {
        ring + 1
    } else if closed {
        1
    } else {
        last
    };
    let along = [profile[after][0] - profile[before][0], profile[after][1] - profile[before][1]];
    [along[1], -along[0]]
}

/// The profile of a ring with a round section, for a polished [`lathe`].
pub(crate) fn ring_profile(radius: f64, thickness: f64, points: u32) -> Vec<[f64; 2]> {
    (0..=points)
        .map(|i| {
            let angle = TAU * f64::from(i % points) / f64::from(points);
            let (sin, cos) = portable::sin_cos(angle);
            [radius + thickness * cos, thickness * sin]
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sixth of the sum of the corners' determinants, by the divergence theorem; positive where facets face
    /// outward.
    fn volume(mesh: &Mesh) -> f64 {
        let triangles = 0..mesh.triangle_count() as u32;
        triangles.map(|i| mesh.corners(i)).map(|[a, b, c]| a.dot(b.cross(c))).sum::<f64>() / 6.0
    }

    #[test]
    fn a_turned_ring_is_closed_faces_outward_and_holds_what_a_torus_holds() {
        let mesh = lathe(&ring_profile(2.0, 0.5, 128), 256, Finish::Polished);
        let torus = 2.0 * PI * PI * 2.0 * 0.5 * 0.5;
        assert!((volume(&mesh) / torus - 1.0).abs() < 1e-3, "{} is not {torus}", volume(&mesh));
    }

    #[test]
    fn vertex_normals_lie_on_the_side_of_the_facets() {
        let mesh = lathe(&ring_profile(2.0, 0.5, 8), 8, Finish::Polished);
        for triangle in 0..mesh.triangle_count() as u32 {
            let [a, b, c] = mesh.corners(triangle);
            let facet = (b - a).cross(c - a);
            let normals = mesh.corner_normals(triangle).unwrap();
            assert!(normals.iter().all(|normal| normal.dot(facet) > 0.0), "triangle {triangle}");
        }
    }

    #[test]
    fn a_lamp_gives_at_its_target_what_it_says() {
        let lamp = lamp("lamp", DVec3::new(0.0, 3.0, 4.0), DVec3::ZERO, Rgb::WHITE);
        let irradiance = lamp.intensity * (1.0 / (PI * 25.0));
        assert!((irradiance.r - 1.0).abs() < 1e-15);
    }
}
