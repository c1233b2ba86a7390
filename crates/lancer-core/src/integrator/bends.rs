//! Where rays go on to from the surfaces that a packet of them has met.

use crate::geometry::packet::at;
use crate::geometry::{DVec3, Ray, RayPacket};
use crate::shade::{fresnel_reflectance, reflect, refracted};
use crate::world::Intersections;
use fearless_simd::{Level, dispatch};

const LANES: usize = RayPacket::LANES;

/// The mirrored and the refracted ray at each surface.
#[derive(Clone, Debug, Default)]
pub(super) struct Bends {
    mirrored: RayPacket,
    /// Their directions are NaN at total internal reflection.
    refracted: RayPacket,
    reflectance: [f64; LANES],
}

/// The indices of refraction on both sides of each surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Indices {
    pub(super) before: [f64; LANES],
    pub(super) after: [f64; LANES],
}

impl Bends {
    /// Finds the mirrored rays, in place of those that were there. By scalar functions without branches, of which the
    /// compiler makes vector code, as is what follows.
    pub(super) fn mirror(&mut self, level: Level, rays: &RayPacket, met: &Intersections) {
        dispatch!(level, _simd => for lane in 0..LANES {
            let direction = at(&rays.direction, lane);
            let (normal, geometric_normal) = (met.facing_normal(lane), met.facing_geometric_normal(lane));
            let mirrored = mirror_direction(direction, normal, geometric_normal);
            self.mirrored.set(lane, &met.spawn(lane, mirrored));
        });
    }

    /// Finds the refracted rays and the reflectances.
    pub(super) fn refract(&mut self, level: Level, rays: &RayPacket, met: &Intersections, ior: &Indices) {
        dispatch!(level, _simd => for lane in 0..LANES {
            let direction = at(&rays.direction, lane);
            let (before, after) = (ior.before[lane], ior.after[lane]);
            let (normal, geometric_normal) = (met.facing_normal(lane), met.facing_geometric_normal(lane));
            let refracted = refracted_direction(direction, normal, geometric_normal, before, after);
            self.refracted.set(lane, &met.spawn(lane, refracted));
            self.reflectance[lane] = fresnel_reflectance(-direction.dot(normal), before, after);
        });
    }

    /// The ray that a surface mirrors.
    pub(super) fn mirrored(&self, lane: usize) -> Ray {
        self.mirrored.ray(lane)
    }

    /// The ray that it lets through, bent; none where it reflects totally.
    pub(super) fn refracted(&self, lane: usize) -> Option<Ray> {
        let ray = self.refracted.ray(lane);
        (!ray.direction.x.is_nan()).then_some(ray)
    }

    /// The Fresnel reflectance.
    pub(super) fn reflectance(&self, lane: usize) -> f64 {
        self.reflectance[lane]
    }
}

/// The mirror direction about N. Where an interpolated N would send the ray into the surface, the geometric
/// normal takes its place.
#[inline(always)]
fn mirror_direction(direction: DVec3, normal: DVec3, geometric_normal: DVec3) -> DVec3 {
    let mirrored = reflect(direction, normal);
    if mirrored.dot(geometric_normal) > 0.0 { mirrored } else { reflect(direction, geometric_normal) }
}

/// The refracted direction about N, NaN where there is none. Where an interpolated N would send the ray back out, the
/// geometric normal takes its place.
#[inline(always)]
fn refracted_direction(
    direction: DVec3,
    normal: DVec3,
    geometric_normal: DVec3,
    ior_before: f64,
    ior_after: f64,
) -> DVec3 {
    let about_n = refracted(direction, normal, ior_before, ior_after);
    let about_face = refracted(direction, geometric_normal, ior_before, ior_after);
    if about_n.dot(geometric_normal) >= 0.0 { about_face } else { about_n }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Node, Scene, Shape};
    use crate::shade::refract;
    use crate::simd::InstructionSet;
    use crate::testing::{Random, ball};
    use crate::world::{CompileOptions, World};
    use std::sync::Arc;

    /// A mesh whose normals lie about, so that N often leads a ray to the wrong side, and a ball.
    fn scene(random: &mut Random) -> Scene {
        let mut data = ball(8, 16);
        data.normals =
            data.positions.iter().map(|_| random.point(1.0).as_vec3().normalize().to_array()).collect();
        let mut scene = Scene::new("bends");
        scene.add(Node::mesh("mesh", Arc::new(crate::mesh::Mesh::new(data).unwrap())));
        scene.add(Node::shape("ball", Shape::Sphere));
        scene
    }

    #[test]
    fn rays_go_on_as_reflect_and_refract_say_on_the_side_that_they_should() {
        let mut random = Random::new(31);
        let scene = scene(&mut random);
        let (mut about_faces, mut totally, mut bent) = (0, 0, 0);
        for instructions in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
            let options = CompileOptions { instructions: Some(instructions), ..CompileOptions::default() };
            let world = World::compile(&scene, &options).unwrap();
            let (mut bends, mut met) = (Bends::default(), Intersections::default());
            for _ in 0..300 {
                let first = random.ray(2.0);
                let mut rays = RayPacket::splat(&first);
                let mut ior = Indices { before: [1.0; LANES], after: [1.0; LANES] };
                for lane in 0..LANES {
                    let direction = (first.direction + random.point(0.2)).normalize();
                    rays.set(lane, &Ray { direction, ..first });
                    (ior.before[lane], ior.after[lane]) =
                        [(1.0, 1.5), (1.5, 1.0), (1.3, 1.3)][random.below(3)];
                }
                let hits = world.intersect_packet(&rays, 0xffff, &mut Default::default());
                met.find(&world, &rays, &hits, false);
                bends.mirror(world.level(), &rays, &met);
                bends.refract(world.level(), &rays, &met, &ior);
                for lane in 0..LANES {
                    let Some(at) = met.at(&world, lane) else { continue };
                    let direction = rays.ray(lane).direction;
                    let (normal, facing) = (at.facing_normal(), at.facing_geometric_normal());
                    let mut mirrored = reflect(direction, normal);
                    if mirrored.dot(facing) <= 0.0 {
                        mirrored = reflect(direction, facing);
                        about_faces += 1;
                    }
                    assert_eq!(bends.mirrored(lane), at.spawn(mirrored));
                    let (before, after) = (ior.before[lane], ior.after[lane]);
                    let mut refracted = refract(direction, normal, before, after);
                    if refracted.is_some_and(|refracted| refracted.dot(facing) >= 0.0) {
                        refracted = refract(direction, facing, before, after);
                    }
                    totally += u32::from(refracted.is_none());
                    bent += u32::from(refracted.is_some());
                    assert_eq!(bends.refracted(lane), refracted.map(|direction| at.spawn(direction)));
                    let reflectance = fresnel_reflectance(-direction.dot(normal), before, after);
                    assert_eq!(bends.reflectance(lane), reflectance);
                }
            }
        }
        assert!(about_faces > 100 && totally > 100 && bent > 1_000, "{about_faces} {totally} {bent}");
    }
}
