//! What the lights do at the surfaces that a packet of rays has met.

use crate::accel::bits;
use crate::color::{Colors, Rgb};
use crate::geometry::RayPacket;
use crate::geometry::error::{segment_from_surface, stands_off};
use crate::geometry::packet::at;
use crate::scene::{Light, Material};
use crate::shade::{Incidence, diffuse, specular};
use crate::world::{Face, Intersections, World};
use fearless_simd::dispatch;

const LANES: usize = RayPacket::LANES;

/// What each light adds to surfaces.
#[derive(Clone, Debug, Default)]
pub(super) struct Lighting {
    /// k_d.
    diffuse: Colors,
    lights: Vec<Reach>,
    incidences: Incidences,
    segments: RayPacket,
}

/// How far a light reaches.
#[derive(Clone, Debug, Default)]
struct Reach {
    /// What it adds where nothing hides it.
    radiance: Colors,
    /// The surfaces that it adds to, a bit for each.
    lit: u32,
}

/// What is found of a light for all lanes before each is looked at.
#[derive(Clone, Debug, Default)]
struct Incidences {
    falloff: [f64; LANES],
    cosine: [f64; LANES],
    half_cosine: [f64; LANES],
    /// Whether the light stands clearly off the plane that touches the surface.
    stands_off: [bool; LANES],
}

impl Lighting {
    /// Finds what each light adds to the surfaces that rays have met; `hidden` tells which of some segments to a light
    /// meet anything, each of which leaves a face.
    pub(super) fn find(
        &mut self,
        world: &World,
        rays: &RayPacket,
        met: &Intersections,
        materials: &[Option<&Material>; LANES],
        mut hidden: impl FnMut(&RayPacket, u32, &[Option<Face>; LANES]) -> u32,
    ) {
        let Self { diffuse, lights: reaches, incidences, segments } = self;
        reaches.resize_with(world.lights().len(), Reach::default);
        let mut open = 0;
        for (lane, material) in materials.iter().enumerate() {
            if let Some(material) = material.filter(|material| material.is_lit()) {
                diffuse.put(lane, material.diffuse);
                open |= 1 << lane;
            }
        }
        for (light, reach) in world.lights().iter().zip(reaches) {
            reach.lit = 0;
            if open == 0_u32 || light.intensity.is_black() {
                continue;
            }
            dispatch!(world.level(), _simd => {
                reach.find(light, rays, met, diffuse, incidences, segments);
            });
            let mut left = [None; LANES];
            for lane in bits(open) {
                // Also false for a light in the point itself, whose direction is NaN.
                let faces_the_light = incidences.cosine[lane] > 0.0;
                let Some(material) = materials[lane].filter(|_| faces_the_light) else { continue };
                let irradiance = light.intensity * incidences.falloff[lane];
                let half_cosine = incidences.half_cosine[lane];
                let specular = specular(irradiance, material, met.colors.at(lane), half_cosine);
                let radiance = reach.radiance.at(lane) + specular;
                reach.radiance.put(lane, radiance);
                reach.lit |= u32::from(!radiance.is_black()) << lane;
                left[lane] = met.face(lane).filter(|_| incidences.stands_off[lane]);
            }
            reach.lit &= !hidden(segments, reach.lit, &left);
        }
    }

    /// Adds what the lights that nothing hides add to each surface, in their order.
    #[inline(always)]
    pub(super) fn add_to(&self, sums: &mut Colors) {
        for reach in &self.lights {
            for lane in 0..LANES {
                let is_lit = reach.lit >> lane & 1 == 1;
                let radiance = if is_lit { reach.radiance.at(lane) } else { Rgb::BLACK };
                sums.put(lane, sums.at(lane) + radiance);
            }
        }
    }

    /// By light: whether it adds to a surface, and nothing hides it.
    pub(super) fn visible(&self, lane: usize) -> impl Iterator<Item = bool> {
        self.lights.iter().map(move |reach| reach.lit >> lane & 1 == 1)
    }
}

impl Reach {
    /// How a light stands to surfaces, what of it they reflect in all directions, and the segments to it: by scalar
    /// functions without branches, of which the compiler makes vector code.
    #[inline(always)]
    fn find(
        &mut self,
        light: &Light,
        rays: &RayPacket,
        met: &Intersections,
        coefficients: &Colors,
        incidences: &mut Incidences,
        segments: &mut RayPacket,
    ) {
        let target = light.position;
        for lane in 0..LANES {
            let (point, error) = (at(&met.surfaces.point, lane), at(&met.surfaces.point_error, lane));
            let geometric_normal = at(&met.surfaces.geometric_normal, lane);
            let to_eye = -at(&rays.direction, lane);
            let incidence = Incidence::new(point, met.facing_normal(lane), to_eye, target);
            incidences.falloff[lane] = incidence.falloff;
            incidences.cosine[lane] = incidence.cosine;
            incidences.half_cosine[lane] = incidence.half_cosine;
            let irradiance = light.intensity * incidence.falloff;
            let (coefficient, color) = (coefficients.at(lane), met.colors.at(lane));
            self.radiance.put(lane, diffuse(irradiance, coefficient, color, incidence.cosine));
            segments.set(lane, &segment_from_surface(point, error, geometric_normal, target));
            incidences.stands_off[lane] = stands_off(point, error, geometric_normal, target);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{DVec3, Ray, portable};
    use crate::scene::{Material, Node, Scene, Shape};
    use crate::shade::{LightTerm, ShadingPoint};

    #[test]
    fn what_lights_add_is_the_radiance_of_their_terms_bit_for_bit() {
        let shiny = Material { specular: Rgb::new(0.3, 0.2, 0.1), shininess: 17.0, ..Material::default() };
        let materials = [
            Material::default(),
            Material { metallic: Rgb::grey(0.7), ..shiny.clone() },
            Material { diffuse: Rgb::BLACK, shininess: 2.5, ..shiny },
            Material { diffuse: Rgb::BLACK, ..Material::default() },
        ];
        let mut scene = Scene::new("ball");
        scene.add(Node::shape("ball", Shape::Sphere));
        for (position, intensity) in [
            (DVec3::new(2.0, 3.0, 4.0), Rgb::new(50.0, 60.0, 70.0)),
            (DVec3::new(-4.0, 0.1, 0.0), Rgb::new(0.0, 9.0, 0.0)),
            (DVec3::new(0.0, 1.0, 2.0), Rgb::BLACK),
            (DVec3::new(0.0, 0.0, 1.0), Rgb::WHITE),
        ] {
            scene.add_light(position, intensity);
        }
        let world = World::compile(&scene, &Default::default()).unwrap();
        let mut lighting = Lighting::default();
        let mut met = Intersections::default();
        let (mut lit, mut unlit) = (0, 0);
        for step in 0..40 {
            let mut rays = RayPacket::default();
            let wanted = 0xffff >> (step % LANES);
            for lane in bits(wanted) {
                let (sin, cos) = portable::sin_cos((step * 7 + lane) as f64);
                let origin = DVec3::new(3.0 * sin, 0.3 * cos, 3.0 * cos);
                rays.set(lane, &Ray::new(origin, DVec3::new(-sin, 0.1, -cos).normalize()));
            }
            met.find(&world, &rays, &world.intersect_packet(&rays, wanted, &mut Default::default()), true);
            let color = Rgb::new(0.9, 0.5, 0.1);
            met.colors = Colors::splat(color);
            let mut looks = [None; LANES];
            for lane in bits(wanted) {
                looks[lane] = Some(&materials[(step + lane) % materials.len()]);
            }
            lighting.find(&world, &rays, &met, &looks, |_, _, _| 0);
            let mut sums = Colors::default();
            lighting.add_to(&mut sums);
            for lane in bits(wanted) {
                let (at, ray) = (met.at(&world, lane).expect("it goes to the ball"), rays.ray(lane));
                let Some(material) = looks[lane] else { continue };
                let point = ShadingPoint {
                    position: at.point,
                    normal: at.facing_normal(),
                    to_eye: -ray.direction,
                    color,
                    material,
                };
                let mut sum = Rgb::BLACK;
                for (light, visible) in world.lights().iter().zip(lighting.visible(lane)) {
                    let term = LightTerm::new(&point, light);
                    assert_eq!(visible, term.is_some());
                    if let Some(term) = term {
                        sum += term.radiance();
                        lit += 1;
                    } else {
                        unlit += 1;
                    }
                }
                assert_eq!(sums.at(lane), sum);
            }
        }
        assert!(lit > 100 && unlit > 100, "{lit} lit, {unlit} not");
    }
}
