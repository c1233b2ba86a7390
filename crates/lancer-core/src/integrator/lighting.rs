//! What the lights do at the surfaces that a packet of rays has met.

use crate::accel::bits;
use crate::color::Rgb;
use crate::geometry::RayPacket;
use crate::geometry::error::{segment_from_surface, stands_off};
use crate::geometry::packet::{Vectors, at, put};
use crate::scene::Light;
use crate::shade::{Incidence, diffuse, specular};
use crate::world::{Face, Intersections, Look, World};
use fearless_simd::dispatch;

const LANES: usize = RayPacket::LANES;

/// What each light adds to surfaces.
#[derive(Clone, Debug, Default)]
pub(super) struct Lighting {
    looks: Looks,
    lights: Vec<Reach>,
    incidences: Incidences,
    segments: RayPacket,
}

/// What surfaces are made of, lane by lane as vector instructions want it.
#[derive(Clone, Debug, Default)]
struct Looks {
    color: Vectors,
    /// k_d.
    diffuse: Vectors,
}

/// How far a light reaches.
#[derive(Clone, Debug, Default)]
struct Reach {
    /// What it adds where nothing hides it.
    radiance: Vectors,
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
        looks: &[Option<Look>; LANES],
        mut hidden: impl FnMut(&RayPacket, u32, &[Option<Face>; LANES]) -> u32,
    ) {
        let Self { looks: lanes, lights: reaches, incidences, segments } = self;
        reaches.resize_with(world.lights().len(), Reach::default);
        let mut open = 0;
        for (lane, look) in looks.iter().enumerate() {
            if let Some(look) = look.filter(|look| look.material.is_lit()) {
                put(&mut lanes.color, lane, look.color.to_array().into());
                put(&mut lanes.diffuse, lane, look.material.diffuse.to_array().into());
                open |= 1 << lane;
            }
        }
        for (light, reach) in world.lights().iter().zip(reaches) {
            reach.lit = 0;
            if open == 0_u32 || light.intensity.is_black() {
                continue;
            }
            dispatch!(world.level(), _simd => {
                lanes.lit_by(light, rays, met, reach, incidences, segments);
            });
            let mut left = [None; LANES];
            for lane in bits(open) {
                // Also false for a light in the point itself, whose direction is NaN.
                let faces_the_light = incidences.cosine[lane] > 0.0;
                let Some(Look { material, color }) = looks[lane].filter(|_| faces_the_light) else {
                    continue;
                };
                let irradiance = light.intensity * incidences.falloff[lane];
                let specular = specular(irradiance, material, color, incidences.half_cosine[lane]);
                let radiance = reach.radiance(lane) + specular;
                reach.set(lane, radiance);
                reach.lit |= u32::from(!radiance.is_black()) << lane;
                left[lane] = met.face(lane).filter(|_| incidences.stands_off[lane]);
            }
            reach.lit &= !hidden(segments, reach.lit, &left);
        }
    }

    /// By light: what it adds to a surface, and whether nothing hides it.
    pub(super) fn at(&self, lane: usize) -> impl Iterator<Item = (Rgb, bool)> {
        self.lights.iter().map(move |reach| (reach.radiance(lane), reach.lit >> lane & 1 == 1))
    }
}

impl Reach {
    fn radiance(&self, lane: usize) -> Rgb {
        at(&self.radiance, lane).to_array().into()
    }

    #[inline(always)]
    fn set(&mut self, lane: usize, radiance: Rgb) {
        put(&mut self.radiance, lane, radiance.to_array().into());
    }
}

impl Looks {
    /// How a light stands to surfaces, what of it they reflect in all directions, and the segments to it: by scalar
    /// functions without branches, of which the compiler makes vector code.
    #[inline(always)]
    fn lit_by(
        &self,
        light: &Light,
        rays: &RayPacket,
        met: &Intersections,
        reach: &mut Reach,
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
            let coefficient = at(&self.diffuse, lane).to_array().into();
            let color = at(&self.color, lane).to_array().into();
            reach.set(lane, diffuse(irradiance, coefficient, color, incidence.cosine));
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
            let mut looks = [None; LANES];
            for lane in bits(wanted) {
                let material = &materials[(step + lane) % materials.len()];
                looks[lane] = Some(Look { material, color: Rgb::new(0.9, 0.5, 0.1) });
            }
            lighting.find(&world, &rays, &met, &looks, |_, _, _| 0);
            for lane in bits(wanted) {
                let (at, ray) = (met.at(&world, lane).expect("it goes to the ball"), rays.ray(lane));
                let Some(Look { material, color }) = looks[lane] else { continue };
                let point = ShadingPoint {
                    position: at.point,
                    normal: at.facing_normal(),
                    to_eye: -ray.direction,
                    color,
                    material,
                };
                for (light, (radiance, visible)) in world.lights().iter().zip(lighting.at(lane)) {
                    let term = LightTerm::new(&point, light);
                    assert_eq!(visible, term.is_some());
                    if let Some(term) = term {
                        assert_eq!(radiance, term.radiance());
                        lit += 1;
                    } else {
                        unlit += 1;
                    }
                }
            }
        }
        assert!(lit > 100 && unlit > 100, "{lit} lit, {unlit} not");
    }
}
