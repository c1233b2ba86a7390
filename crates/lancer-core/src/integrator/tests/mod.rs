//! Radiance where it is known: analytic answers first.

mod cancel;
mod colors;
mod switches;

use super::*;
use crate::color::Rgb;
use crate::geometry::portable::{acos, sin_cos};
use crate::geometry::{DVec3, Ray, Transform};
use crate::sampling::Key;
use crate::scene::{AmbientOcclusion, Material, MaterialId, Node, Scene, Settings, Shape};
use crate::shade::{AmbientTerm, LightTerm, fresnel_reflectance, refract};
use crate::world::{CompileOptions, Intersection, Media, World};
use std::f64::consts::{FRAC_1_PI, PI};

fn world(scene: &Scene) -> World {
    World::compile(scene, &CompileOptions::default()).unwrap()
}

fn settings(depth: u32, samples: u32, distance: f64) -> Settings {
    Settings { depth, ao: AmbientOcclusion { samples, distance }, ..Settings::default() }
}

/// What a ray sees, told to a listener.
fn listen<L: Listener>(world: &World, settings: &Settings, ray: Ray, listener: &mut L) -> (Rgb, RayCounts) {
    let mut counts = RayCounts::default();
    let media = Media::around(world, ray.origin);
    let radiance = Whitted::new(world, settings).radiance(
        ray,
        &media,
        Key::camera(0, 0, 0),
        &mut Scratch::default(),
        &mut counts,
        listener,
    );
    (radiance, counts)
}

fn radiance(world: &World, settings: &Settings, ray: Ray) -> Rgb {
    listen(world, settings, ray, &mut Silent).0
}

fn assert_close(a: f64, b: f64) {
    assert!((a - b).abs() <= 1e-12 * b.abs().max(1.0), "{a} is not {b}");
}

fn assert_same(a: Rgb, b: Rgb) {
    for (a, b) in a.to_array().into_iter().zip(b.to_array()) {
        assert_close(a, b);
    }
}

fn at(x: f64, y: f64, z: f64) -> Transform {
    Transform::translate(DVec3::new(x, y, z))
}

/// Reflects nothing but what is named.
fn dark() -> Material {
    Material { ambient: Rgb::BLACK, diffuse: Rgb::BLACK, ..Material::default() }
}

fn glass(scene: &mut Scene, ior: f64) -> MaterialId {
    scene.add_material(Material { transmit: Rgb::WHITE, ior, ..dark() })
}

/// A plane y = 0 facing up, seen from above at the origin.
fn floor() -> Scene {
    let mut scene = Scene::new("floor");
    scene.ambient = Rgb::WHITE;
    scene.add(Node::shape("floor", Shape::Plane));
    scene
}

const DOWN: Ray = Ray { origin: DVec3::new(0.0, 0.5, 0.0), direction: DVec3::NEG_Y, t_max: f64::INFINITY };

/// The mean of c_a at the origin of a floor over many keys, and its standard error.
fn occlusion(scene: &Scene, samples: u32, distance: f64, estimates: u32) -> (f64, f64) {
    let world = world(scene);
    let hit = world.intersect(&DOWN).unwrap();
    let at = world.intersection(&DOWN, &hit);
    let sampler = AmbientOcclusionSampler::new(&AmbientOcclusion { samples, distance });
    let mut counts = RayCounts::default();
    let (mut sum, mut squares) = (0.0, 0.0);
    for x in 0..estimates {
        let factor = sampler.factor(&world, &at, Key::camera(x, 0, 0), &mut counts);
        sum += factor;
        squares += factor * factor;
    }
    let n = f64::from(estimates);
    let mean = sum / n;
    (mean, ((squares / n - mean * mean).max(0.0) / n).sqrt())
}

fn assert_occlusion(scene: &Scene, distance: f64, expected: f64) {
    for samples in [1, 7, 64] {
        let (mean, error) = occlusion(scene, samples, distance, 4000);
        let off = (mean - expected).abs();
        assert!(off <= 5.0 * error + 1e-9, "N = {samples}: c_a = {mean} +- {error}, expected {expected}");
    }
}

/// Walls of a room: planes that face the origin of the floor.
fn wall(scene: &mut Scene, axis: DVec3, degrees: f64, place: Transform) {
    let turned = Transform::rotate(axis, degrees);
    scene.add(Node::shape("wall", Shape::Plane).with_transform(turned.then(place)));
}

#[test]
fn unoccluded_point_has_ambient_factor_one() {
    assert_occlusion(&floor(), 1e9, 1.0);
}

#[test]
fn no_samples_mean_no_occlusion() {
    assert_eq!(occlusion(&floor(), 0, 1.0, 1), (1.0, 0.0));
}

/// An unbounded wall hides half of the cosine-weighted hemisphere, whatever its distance.
#[test]
fn point_beside_an_unbounded_wall_sees_half() {
    let mut scene = floor();
    wall(&mut scene, DVec3::Z, 90.0, at(0.3, 0.0, 0.0));
    assert_occlusion(&scene, f64::INFINITY, 0.5);
}

/// Within reach D the wall at distance a hides the directions with w.x > a / D: by Nusselt's projection a
/// segment of the unit disc, (acos k - k sqrt(1 - k^2)) / pi.
#[test]
fn reach_cuts_a_wall_to_a_segment_of_the_disc() {
    let mut scene = floor();
    wall(&mut scene, DVec3::Z, 90.0, at(0.3, 0.0, 0.0));
    let k = 0.3_f64 / 0.5;
    assert_occlusion(&scene, 0.5, 1.0 - (acos(k) - k * (1.0 - k * k).sqrt()) * FRAC_1_PI);
    assert_occlusion(&scene, 0.299, 1.0);
}

#[test]
fn point_in_a_corner_of_a_room_sees_a_quarter() {
    let mut scene = floor();
    wall(&mut scene, DVec3::Z, 90.0, at(0.3, 0.0, 0.0));
    wall(&mut scene, DVec3::X, 90.0, at(0.0, 0.0, 0.2));
    assert_occlusion(&scene, f64::INFINITY, 0.25);
}

/// A wall of height h at distance a, long enough to be unbounded, hides (1 - a / sqrt(a^2 + h^2)) / 2.
#[test]
fn point_beside_a_wall_of_finite_height_has_its_closed_form() {
    let mut scene = floor();
    let (a, h) = (0.4, 0.3);
    let slab = Transform::scale(DVec3::new(0.5, h, 1e6)).then(at(a + 0.5, 0.0, 0.0));
    scene.add(Node::shape("wall", Shape::Cube).with_transform(slab));
    assert_occlusion(&scene, f64::INFINITY, 0.5 + 0.5 * a / (a * a + h * h).sqrt());
}

/// A ball of radius r whose centre is h above hides (r / h)^2.
#[test]
fn point_under_a_ball_has_its_closed_form() {
    let mut scene = floor();
    let ball = Transform::scale(DVec3::splat(0.6)).then(at(0.0, 1.5, 0.0));
    scene.add(Node::shape("ball", Shape::Sphere).with_transform(ball));
    let eye = Ray { origin: DVec3::new(0.0, 0.5, 0.0), ..DOWN };
    assert!(world(&scene).intersect(&eye).is_some());
    assert_occlusion(&scene, f64::INFINITY, 1.0 - 0.16);
}

#[test]
fn point_under_a_hemisphere_sees_nothing_within_its_reach_and_everything_short_of_it() {
    let mut scene = floor();
    let dome = Transform::scale(DVec3::splat(2.0));
    scene.add(Node::shape("dome", Shape::Sphere).with_transform(dome));
    assert_occlusion(&scene, 2.001, 0.0);
    assert_occlusion(&scene, 1.999, 1.0);
}

#[test]
fn the_lattice_errs_less_than_independent_directions() {
    let mut scene = floor();
    wall(&mut scene, DVec3::Z, 90.0, at(0.3, 0.0, 0.0));
    let (_, error) = occlusion(&scene, 64, f64::INFINITY, 2000);
    let deviation = error * 2000.0_f64.sqrt();
    // One direction has E[x^2] = 16 E[V (n.w)+^2] = 16 / 12 with V = 1/2, so the variance is 4/3 - 1/4.
    let independent = ((4.0 / 3.0 - 0.25) / 64.0_f64).sqrt();
    assert!(deviation < 0.5 * independent, "{deviation} against {independent}");
}

#[test]
fn lit_plane_has_its_known_radiance_in_each_channel() {
    let mut scene = floor();
    scene.ambient = Rgb::new(0.1, 0.2, 0.3);
    let (sin, cos) = sin_cos(PI / 3.0);
    scene.add_light(DVec3::new(0.0, cos, sin) * 4.0, Rgb::new(10.0, 20.0, 30.0));
    let material = scene.add_material(Material {
        color: Rgb::new(0.9, 0.6, 0.3).into(),
        ambient: Rgb::new(0.5, 0.4, 0.3),
        diffuse: Rgb::new(0.2, 0.3, 0.4),
        ..Material::default()
    });
    let id = scene.roots()[0];
    scene.node_mut(id).material = Some(material);
    let expected =
        |l_a: f64, k_a: f64, s: f64, l: f64, k_d: f64| l_a * k_a * s + l / (PI * 16.0) * k_d * s * cos;
    assert_same(
        radiance(&world(&scene), &settings(0, 0, 1.0), DOWN),
        Rgb::new(
            expected(0.1, 0.5, 0.9, 10.0, 0.2),
            expected(0.2, 0.4, 0.6, 20.0, 0.3),
            expected(0.3, 0.3, 0.3, 30.0, 0.4),
        ),
    );
}

#[test]
fn anything_between_a_point_and_a_light_hides_it_and_nothing_else_does() {
    let lit = |blocker: Option<Transform>| {
        let mut scene = floor();
        scene.ambient = Rgb::BLACK;
        scene.add_light(DVec3::new(3.0, 3.0, 0.0), Rgb::WHITE);
        if let Some(transform) = blocker {
            scene.add(Node::shape("blocker", Shape::Sphere).with_transform(transform));
        }
        !radiance(&world(&scene), &settings(0, 0, 1.0), DOWN).is_black()
    };
    let ball = |x: f64, y: f64| Some(Transform::scale(DVec3::splat(0.4)).then(at(x, y, 0.0)));
    assert!(lit(None));
    assert!(!lit(ball(1.5, 1.5)));
    assert!(lit(ball(-1.5, 1.5)), "beside the segment");
    assert!(lit(ball(4.5, 4.5)), "beyond the light");
    assert!(lit(ball(3.0, 2.0)), "below the light, off the segment");
}

#[test]
fn a_mirror_shows_what_lies_along_the_mirror_direction_times_its_coefficient() {
    let mut scene = Scene::new("mirror");
    scene.background = Rgb::new(0.2, 0.4, 0.8);
    let mirror = scene.add_material(Material { reflect: Rgb::new(0.5, 0.25, 1.0), ..dark() });
    scene.add(Node::shape("mirror", Shape::Plane).with_material(mirror));
    let ray = Ray::new(DVec3::new(0.0, 1.0, 0.0), DVec3::new(1.0, -1.0, 0.0).normalize());
    let world = world(&scene);
    assert_same(radiance(&world, &settings(1, 0, 1.0), ray), Rgb::new(0.1, 0.1, 0.8));
    assert_same(radiance(&world, &settings(0, 0, 1.0), ray), Rgb::BLACK);
}

/// Follows the rays of a pixel.
#[derive(Default)]
struct Trace {
    rays: Vec<(RayKind, Ray, Rgb)>,
    spawned: Vec<(f64, f64)>,
    sum: Rgb,
}

impl Trace {
    fn add(&mut self, radiance: Rgb) {
        let &(_, _, throughput) = self.rays.last().unwrap();
        self.sum += radiance * throughput;
    }
}

impl Listener for Trace {
    fn begin_ray(&mut self, id: RayId, kind: RayKind, throughput: Rgb, ray: &Ray) {
        assert_eq!(id.0 as usize, self.rays.len());
        self.rays.push((kind, *ray, throughput));
    }
    fn background(&mut self, radiance: Rgb) {
        self.add(radiance);
    }
    fn surface(&mut self, intersection: &Intersection, _color: Rgb) {
        assert!((intersection.facing_normal().length() - 1.0).abs() < 1e-12);
    }
    fn ambient(&mut self, term: &AmbientTerm) {
        self.add(term.radiance());
    }
    fn light(&mut self, _index: usize, _light: &crate::scene::Light, term: &LightTerm, visible: bool) {
        if visible {
            self.add(term.radiance());
        }
    }
    fn spawn(&mut self, event: &SpawnEvent) {
        self.spawned.push((event.ior_before, event.ior_after));
    }
}

#[test]
fn a_ray_bends_twice_in_a_glass_ball_by_snells_law() {
    let mut scene = Scene::new("ball");
    let glass = glass(&mut scene, 1.5);
    scene.add(Node::shape("ball", Shape::Sphere).with_material(glass));
    let offset = 0.6;
    let ray = Ray::new(DVec3::new(offset, 0.0, 3.0), DVec3::NEG_Z);
    let mut trace = Trace::default();
    listen(&world(&scene), &settings(5, 0, 1.0), ray, &mut trace);

    assert_eq!(trace.spawned, [(1.0, 1.5), (1.5, 1.0)]);
    let (inside, outside) = (trace.rays[1].1.direction, trace.rays[2].1.direction);
    // sin of the angle of incidence is the offset; inside it is offset / 1.5, and the path is symmetric, so the
    // ray turns by twice the difference of the two angles.
    let turn = |sin: f64| std::f64::consts::FRAC_PI_2 - acos(sin);
    assert_close(acos(inside.dot(DVec3::NEG_Z)), turn(offset) - turn(offset / 1.5));
    assert_close(acos(outside.dot(DVec3::NEG_Z)), 2.0 * (turn(offset) - turn(offset / 1.5)));
    assert!(outside.x < 0.0, "toward the axis");
}

#[test]
fn a_ray_in_a_glass_cube_is_reflected_totally_beyond_the_critical_angle() {
    let mut scene = Scene::new("cube");
    scene.background = Rgb::WHITE;
    let glass = glass(&mut scene, 1.5);
    scene.add(Node::shape("cube", Shape::Cube).with_material(glass));
    // From inside, 60 degrees from the normal of the top face; the critical angle is 41.8.
    let (sin, cos) = sin_cos(PI / 3.0);
    let ray = Ray::new(DVec3::new(0.0, 0.9, 0.0), DVec3::new(0.0, cos, sin));
    let mut trace = Trace::default();
    listen(&world(&scene), &settings(1, 0, 1.0), ray, &mut trace);
    assert_eq!(trace.spawned, [(1.5, 1.0)]);
    assert_eq!(trace.rays[1].0, RayKind::TotalInternalReflection);
    assert_eq!(trace.rays[1].1.direction, DVec3::new(0.0, -cos, sin));
}

#[test]
fn a_camera_inside_glass_starts_with_its_index() {
    let mut scene = Scene::new("inside");
    let glass = glass(&mut scene, 1.5);
    scene.add(Node::shape("ball", Shape::Sphere).with_material(glass));
    let mut trace = Trace::default();
    listen(&world(&scene), &settings(3, 0, 1.0), Ray::new(DVec3::X * 0.1, DVec3::Z), &mut trace);
    assert_eq!(trace.spawned, [(1.5, 1.0)]);
}

#[test]
fn nested_and_overlapping_dielectrics_take_the_index_of_what_was_entered_last() {
    let mut scene = Scene::new("nested");
    let (outer, inner) = (glass(&mut scene, 1.5), glass(&mut scene, 1.33));
    scene.add(Node::shape("outer", Shape::Sphere).with_material(outer));
    scene.add(
        Node::shape("inner", Shape::Sphere)
            .with_material(inner)
            .with_transform(Transform::scale(DVec3::splat(0.5))),
    );
    let through = Ray::new(DVec3::Z * 3.0, DVec3::NEG_Z);
    let mut trace = Trace::default();
    listen(&world(&scene), &settings(9, 0, 1.0), through, &mut trace);
    assert_eq!(trace.spawned, [(1.0, 1.5), (1.5, 1.33), (1.33, 1.5), (1.5, 1.0)]);

    let mut scene = Scene::new("overlapping");
    let (first, second) = (glass(&mut scene, 1.5), glass(&mut scene, 1.33));
    scene.add(Node::shape("first", Shape::Sphere).with_material(first));
    scene.add(Node::shape("second", Shape::Sphere).with_material(second).with_transform(at(0.0, 0.0, -1.0)));
    let mut trace = Trace::default();
    listen(&world(&scene), &settings(9, 0, 1.0), through, &mut trace);
    assert_eq!(trace.spawned, [(1.0, 1.5), (1.5, 1.33), (1.33, 1.33), (1.33, 1.0)]);
}

/// Where two dielectrics touch, the ray passes from one into the other, with no film of air between them.
#[test]
fn touching_dielectrics_share_one_interface() {
    let mut scene = Scene::new("touching");
    let (glass, water) = (glass(&mut scene, 1.5), glass(&mut scene, 1.33));
    // Off the grid, so that the faces coincide only up to rounding.
    let place = Transform::rotate(DVec3::new(1.0, 2.0, 3.0), 37.0).then(at(0.1, 0.2, 0.3));
    let lower = at(0.0, -1.0, 0.0).then(place);
    scene.add(Node::shape("water", Shape::Cube).with_material(water).with_transform(lower));
    scene.add(
        Node::shape("glass", Shape::Cube).with_material(glass).with_transform(at(0.0, 1.0, 0.0).then(place)),
    );
    let world = world(&scene);
    // 50 degrees in glass is beyond the critical angle to air, and below that to water.
    let (sin, cos) = sin_cos(50_f64.to_radians());
    let mut random = crate::testing::Random::new(1);
    for _ in 0..1000 {
        let offset = DVec3::new(random.between(-0.5, 0.5), 0.3, random.between(-0.5, -0.4));
        let direction = place.vector(DVec3::new(0.0, -cos, sin));
        let mut trace = Trace::default();
        listen(&world, &settings(1, 0, 1.0), Ray::new(place.point(offset), direction), &mut trace);
        assert_eq!(trace.spawned, [(1.5, 1.33)]);
        let normal = place.vector(DVec3::Y);
        let expected = refract(direction, normal, 1.5, 1.33).unwrap();
        assert!((trace.rays[1].1.direction - expected).length() < 1e-12);
    }
}

#[test]
fn an_opaque_surface_that_touches_glass_is_seen_through_it() {
    let mut scene = Scene::new("on a table");
    scene.ambient = Rgb::WHITE;
    let place = Transform::rotate(DVec3::new(3.0, 1.0, 2.0), 71.0).then(at(0.1, 0.7, 0.3));
    let glass = glass(&mut scene, 1.5);
    let red = scene.add_material(Material { color: Rgb::new(1.0, 0.0, 0.0).into(), ..Material::default() });
    let upper =
        Node::shape("glass", Shape::Cube).with_material(glass).with_transform(at(0.0, 1.0, 0.0).then(place));
    let lower =
        Node::shape("block", Shape::Cube).with_material(red).with_transform(at(0.0, -1.0, 0.0).then(place));
    scene.add(upper);
    scene.add(lower);
    let world = world(&scene);
    let mut random = crate::testing::Random::new(2);
    for _ in 0..1000 {
        let from = place.point(DVec3::new(random.between(-0.3, 0.3), 5.0, random.between(-0.3, 0.3)));
        let to = place.point(DVec3::new(random.between(-0.5, 0.5), 0.0, random.between(-0.5, 0.5)));
        let seen = radiance(&world, &settings(3, 0, 1.0), Ray::new(from, (to - from).normalize()));
        assert_same(seen, Rgb::new(1.0, 0.0, 0.0));
    }
}

#[test]
fn fresnel_weights_divide_the_light_where_the_material_asks() {
    let mut scene = Scene::new("fresnel");
    scene.background = Rgb::WHITE;
    let glass =
        scene.add_material(Material { reflect: Rgb::WHITE, transmit: Rgb::WHITE, fresnel: true, ..dark() });
    scene.add(Node::shape("water", Shape::Plane).with_material(glass));
    let (sin, cos) = sin_cos(1.0);
    let ray = Ray::new(DVec3::Y, DVec3::new(sin, -cos, 0.0));
    struct Weights(Vec<Rgb>);
    impl Listener for Weights {
        fn spawn(&mut self, event: &SpawnEvent) {
            self.0.push(event.coefficient);
        }
    }
    let mut weights = Weights(Vec::new());
    let (seen, _) = listen(&world(&scene), &settings(1, 0, 1.0), ray, &mut weights);
    let reflectance = fresnel_reflectance(cos, 1.0, 1.5);
    assert_same(weights.0[0], Rgb::grey(reflectance));
    assert_same(weights.0[1], Rgb::grey(1.0 - reflectance));
    assert_same(seen, Rgb::WHITE);
}

/// Two parallel mirrors with coefficient k and an emitter's worth of ambient light on each.
fn facing_mirrors(reflect: f64) -> Scene {
    let mut scene = floor();
    let mirror = scene.add_material(Material {
        reflect: Rgb::grey(reflect),
        diffuse: Rgb::BLACK,
        ..Material::default()
    });
    let id = scene.roots()[0];
    scene.node_mut(id).material = Some(mirror);
    let ceiling = Transform::rotate(DVec3::X, 180.0).then(at(0.0, 1.0, 0.0));
    scene.add(Node::shape("ceiling", Shape::Plane).with_material(mirror).with_transform(ceiling));
    scene
}

#[test]
fn facing_mirrors_add_up_to_the_geometric_series_of_their_depth() {
    for depth in [0, 1, 5, 20] {
        let seen = radiance(&world(&facing_mirrors(0.5)), &settings(depth, 0, 1.0), DOWN);
        let series = (0..=depth).map(|bounce| 0.5 * pow2(bounce)).sum::<f64>() * 2.0;
        assert_same(seen, Rgb::grey(series));
    }
}

/// 2 to the power -n.
fn pow2(n: u32) -> f64 {
    (0..n).fold(1.0, |x, _| 0.5 * x)
}

#[test]
fn ten_thousand_reflections_need_no_stack_and_no_more_rays_than_the_depth() {
    let world = world(&facing_mirrors(1.0));
    std::thread::Builder::new()
        .stack_size(128 << 10)
        .spawn(move || {
            let (seen, counts) = listen(&world, &settings(10_000, 0, 1.0), DOWN, &mut Silent);
            assert_same(seen, Rgb::grey(10_001.0));
            assert_eq!((counts.reflection, counts.truncated), (10_000, 0));
        })
        .unwrap()
        .join()
        .unwrap();
}

#[test]
fn a_tree_that_doubles_at_every_level_is_cut_and_counted() {
    let mut scene = Scene::new("runaway");
    scene.background = Rgb::WHITE;
    let glass = scene.add_material(Material { reflect: Rgb::WHITE, transmit: Rgb::WHITE, ..dark() });
    for scale in [1.0, 2.0, 3.0] {
        let transform = Transform::scale(DVec3::splat(scale));
        scene.add(Node::shape("shell", Shape::Sphere).with_material(glass).with_transform(transform));
    }
    let ray = Ray::new(DVec3::new(0.2, 0.3, 9.0), DVec3::NEG_Z);
    let (seen, counts) = listen(&world(&scene), &settings(10_000, 0, 1.0), ray, &mut Silent);
    assert!(seen.is_finite());
    assert_eq!(counts.truncated, 1);
    assert_eq!(counts.total(), u64::from(Whitted::MAX_RAYS));
}

#[test]
fn the_terms_that_a_listener_is_told_add_up_to_the_radiance() {
    let mut scene = floor();
    scene.background = Rgb::new(0.1, 0.2, 0.3);
    scene.add_light(DVec3::new(2.0, 5.0, 1.0), Rgb::grey(90.0));
    scene.add_light(DVec3::new(-2.0, 3.0, 1.0), Rgb::grey(40.0));
    let shiny = scene.add_material(Material {
        reflect: Rgb::new(0.3, 0.2, 0.1),
        transmit: Rgb::new(0.4, 0.5, 0.6),
        specular: Rgb::grey(0.1),
        fresnel: true,
        ..Material::default()
    });
    scene.add(Node::shape("ball", Shape::Sphere).with_material(shiny).with_transform(at(0.0, 1.0, 0.0)));
    let world = world(&scene);
    let mut random = crate::testing::Random::new(3);
    for _ in 0..200 {
        let from = DVec3::new(0.0, 2.0, 6.0);
        let ray = Ray::new(from, (random.point(1.5) - from).normalize());
        let mut trace = Trace::default();
        let (heard, counts) = listen(&world, &settings(6, 16, 2.0), ray, &mut trace);
        assert_same(trace.sum, heard);
        assert_eq!(heard, radiance(&world, &settings(6, 16, 2.0), ray), "listening changes nothing");
        assert_eq!(trace.rays.len() as u64, counts.primary + counts.reflection + counts.refraction);
    }
}

#[test]
fn a_radiance_that_no_pixel_can_hold_is_replaced_and_counted() {
    // Infinite even in f64, and finite there but not in the f32 of a pixel.
    for (height, intensity) in [(1e-150, 1e300), (1.0, 1e100)] {
        let mut scene = floor();
        scene.ambient = Rgb::BLACK;
        scene.add_light(DVec3::Y * height, Rgb::grey(intensity));
        let (seen, counts) = listen(&world(&scene), &settings(0, 0, 1.0), DOWN, &mut Silent);
        assert_eq!(seen, Rgb::BLACK);
        assert_eq!(counts.replaced, 1);
    }
}
