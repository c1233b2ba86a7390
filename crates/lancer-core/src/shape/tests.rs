//! The promises of all canonical shapes, and what each is.

use super::*;
use crate::geometry::error::leave_surface;
use crate::geometry::{Placement, Ray};
use crate::testing::Random;

type Intersect = fn(&Ray) -> Option<Hit>;
type Surface = fn(&Ray, &Hit) -> SurfacePoint;

/// Negative inside of a shape, zero on its surface.
type Implicit = fn(DVec3) -> f64;

/// The closed shapes.
fn closed() -> [(&'static str, Intersect, Surface, Implicit); 3] {
    fn capped(ray: &Ray) -> Option<Hit> {
        cylinder::intersect(ray, true)
    }
    [
        ("sphere", sphere::intersect, sphere::surface, |p| p.length() - 1.0),
        ("cube", cube::intersect, cube::surface, |p| p.abs().max_element() - 1.0),
        ("cylinder", capped, cylinder::surface, |p| p.x.hypot(p.z).max(p.y.abs()) - 1.0),
    ]
}

#[test]
fn a_hit_lies_on_the_surface_and_its_normal_faces_out() {
    let mut random = Random::new(1);
    for (name, intersect, surface, inside) in closed() {
        for _ in 0..20_000 {
            let ray = random.ray(3.0);
            let Some(hit) = intersect(&ray) else { continue };
            let at = surface(&ray, &hit);
            assert!(inside(at.point).abs() < 1e-14, "{name}: {ray:?} hits {}", at.point);
            assert!((at.point - ray.at(hit.t)).length() < 1e-13, "{name}: {ray:?}");
            let step = at.geometric_normal.normalize() * 1e-6;
            assert!(inside(at.point + step) > 0.0 && inside(at.point - step) < 0.0, "{name}: {ray:?}");
            let from_inside = at.geometric_normal.dot(ray.direction) > 0.0;
            assert_eq!(from_inside, inside(ray.origin) < 0.0, "{name}: {ray:?}");
            assert!((0.0..=1.0).contains(&at.uv.x) && (0.0..=1.0).contains(&at.uv.y), "{name}: {}", at.uv);
        }
    }
}

#[test]
fn every_ray_from_inside_leaves_and_no_ray_that_turns_away_comes_back() {
    let mut random = Random::new(2);
    for (name, intersect, _, inside) in closed() {
        for _ in 0..20_000 {
            let ray = random.ray(1.2);
            if inside(ray.origin) < 0.0 {
                assert!(intersect(&ray).is_some(), "{name}: {ray:?}");
            }
            let outward = Ray::new(ray.origin.normalize() * 2.0, ray.origin);
            assert!(intersect(&outward).is_none(), "{name}: {outward:?}");
        }
    }
}

#[test]
fn rays_through_the_rims_and_corners_of_closed_shapes_do_not_pass() {
    let mut random = Random::new(3);
    for _ in 0..20_000 {
        let (a, b) = (random.between(-1.0, 1.0), [-1.0, 1.0][random.below(2)]);
        let edge = [DVec3::new(a, b, 1.0), DVec3::new(1.0, a, b), DVec3::new(b, 1.0, a)][random.below(3)];
        let origin = random.point(0.9);
        assert!(cube::occluded(&Ray::new(origin, edge - origin)), "{origin} to {edge}");
        let around = random.direction().with_y(0.0).normalize();
        let rim = around.with_y(b);
        let origin = random.point(0.6);
        assert!(cylinder::occluded(&Ray::new(origin, rim - origin), true), "{origin} to {rim}");
    }
}

#[test]
fn a_hit_beyond_t_max_or_behind_the_origin_is_none() {
    let toward = |t_max: f64| Ray { t_max, ..Ray::new(DVec3::Z * 3.0, DVec3::NEG_Z) };
    for (name, intersect, _, _) in closed() {
        assert!(intersect(&toward(1.9)).is_none(), "{name}");
        assert_eq!(intersect(&toward(2.1)).map(|hit| hit.t), Some(2.0), "{name}");
        assert!(intersect(&Ray::new(DVec3::Z * 3.0, DVec3::Z)).is_none(), "{name}");
    }
}

#[test]
fn t_does_not_change_with_the_length_of_the_direction() {
    let mut random = Random::new(4);
    for (name, intersect, _, _) in closed() {
        for _ in 0..1000 {
            let ray = random.ray(3.0);
            let longer = Ray { direction: ray.direction * 4.0, ..ray };
            let (a, b) = (intersect(&ray).map(|hit| hit.t), intersect(&longer).map(|hit| hit.t * 4.0));
            assert_eq!(a, b, "{name}: {ray:?}");
        }
    }
}

#[test]
fn an_open_cylinder_is_seen_into() {
    let down = Ray::new(DVec3::Y * 3.0, DVec3::NEG_Y);
    assert!(cylinder::occluded(&down, true));
    assert!(!cylinder::occluded(&down, false));
    let slanted = Ray::new(DVec3::new(0.0, 2.0, 0.0), DVec3::new(1.0, -1.5, 0.0));
    let hit = cylinder::intersect(&slanted, false).unwrap();
    assert_eq!(slanted.at(hit.t), DVec3::new(1.0, 0.5, 0.0));
}

#[test]
fn texture_coordinates_follow_the_documented_directions() {
    let at = |surface: Surface, intersect: Intersect, from: DVec3| {
        let ray = Ray::new(from, -from);
        surface(&ray, &intersect(&ray).unwrap()).uv
    };
    let close = |a: DVec2, b: DVec2| assert!((a - b).length() < 1e-12, "{a} is not {b}");
    close(at(sphere::surface, sphere::intersect, DVec3::Z * 2.0), DVec2::new(0.0, 0.5));
    close(at(sphere::surface, sphere::intersect, DVec3::X * 2.0), DVec2::new(0.25, 0.5));
    close(at(cube::surface, cube::intersect, DVec3::new(0.5, 0.0, 2.0)), DVec2::new(0.625, 0.5));
    close(at(cube::surface, cube::intersect, DVec3::new(2.0, 0.0, 0.5)), DVec2::new(0.375, 0.5));
    let above = Ray::new(DVec3::new(3.0, 1.0, -2.0), DVec3::NEG_Y);
    close(plane::surface(&above, &plane::intersect(&above).unwrap()).uv, DVec2::new(3.0, 2.0));
}

/// 0 self-hits, at any size and distance.
#[test]
fn a_ray_that_leaves_a_convex_shape_never_meets_it_again() {
    let mut random = Random::new(5);
    for size in [1e-3, 1.0, 1e3] {
        for distance in [0.0, 1.0, 1e2, 1e4] {
            for (name, intersect, surface, _) in closed() {
                let placement = Placement::new(random.transform(size, distance)).unwrap();
                for _ in 0..2000 {
                    spawn_once(name, &placement, intersect, surface, &mut random);
                }
            }
        }
    }
}

fn spawn_once(
    name: &str,
    placement: &Placement,
    intersect: Intersect,
    surface: Surface,
    random: &mut Random,
) {
    let from = placement.point_to_world(random.direction() * 4.0);
    let to = placement.point_to_world(random.point(0.7));
    let ray = Ray::new(from, (to - from).normalize());
    let local_ray = placement.ray_to_object(&ray);
    let Some(hit) = intersect(&local_ray) else { return };
    let at = surface(&local_ray, &hit);
    let normal = placement.normal_to_world(at.geometric_normal);
    let point = placement.point_to_world(at.point);
    let error = placement.error_in_world(at.point, at.point_error);
    let mut direction = random.direction();
    if random.below(4) == 0 {
        // Grazing.
        direction = (direction - normal * direction.dot(normal)).normalize() + normal * 1e-7;
    }
    let outward = if direction.dot(normal) < 0.0 { -direction } else { direction };
    let start = leave_surface(point, error, normal, outward);
    let left = placement.ray_to_object(&Ray::new(start, outward));
    assert!(intersect(&left).is_none(), "{name}: {placement:?} {left:?}");
    // The way in meets the far side, and not the near one at once.
    let inward = -outward;
    let start = leave_surface(point, error, normal, inward);
    let entered = placement.ray_to_object(&Ray::new(start, inward));
    if let Some(hit) = intersect(&entered) {
        // Near an edge, or grazing, the way through is short; a self-hit would be shorter by far.
        let chord = (entered.direction * hit.t).length();
        assert!(chord > 1e-9, "{name}: a chord of {chord}");
    }
}
