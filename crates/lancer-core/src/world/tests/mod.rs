//! Compilation, and the promises of what comes out of it.

mod boxes;
mod hidden;
mod recompile;

use super::*;
use crate::accel::Accelerator;

use crate::geometry::{DVec3, RayPacket, Transform, portable};
use crate::mesh::{Mesh, MeshData};
use crate::sampling::{HemisphereLattice, Key};
use crate::scene::{Node, Scene, Shape, Texture};
use crate::simd::InstructionSet;
use crate::testing::{Random, ball, soup};
use std::sync::Arc;

fn compile(scene: &Scene) -> World {
    World::compile(scene, &CompileOptions::default()).unwrap()
}

fn compile_error(scene: &Scene) -> CompileError {
    World::compile(scene, &CompileOptions::default()).unwrap_err()
}

fn by_brute_force(scene: &Scene) -> World {
    World::compile(
        scene,
        &CompileOptions { accelerator: Accelerator::BruteForce, ..CompileOptions::default() },
    )
    .unwrap()
}

fn mesh_scene(data: MeshData, transform: Transform) -> Scene {
    let mut scene = Scene::new("mesh");
    scene.add(Node::mesh("mesh", Mesh::new(data).unwrap()).with_transform(transform));
    scene
}

/// All kinds of shapes under all kinds of transforms.
fn crowd(seed: u32) -> Scene {
    gathered(seed, 60)
}

/// A floor and so many shapes, of which the first comes twice.
fn gathered(seed: u32, count: usize) -> Scene {
    let mut random = Random::new(seed);
    let mut scene = Scene::new("crowd");
    let shared = Arc::new(soup(seed, 60));
    scene.add(Node::shape("floor", Shape::Plane));
    let (even, odd) = (Rgb::BLACK, Rgb::WHITE);
    let chequered = Material { color: Texture::Checker { even, odd, size: 1.0 }, ..Material::default() };
    let materials = [Material::default(), chequered].map(|material| scene.add_material(material));
    for i in 0..count {
        let shape = match random.below(5) {
            0 => Shape::Sphere,
            1 => Shape::Cube,
            2 => Shape::Cylinder { capped: true },
            3 => Shape::Cylinder { capped: false },
            _ => Shape::Mesh(Arc::clone(&shared)),
        };
        let distance = random.between(0.0, 2.0);
        let transform = random.transform(0.2, distance);
        let material = materials[i / 5 % 2];
        scene.add(Node::shape("one", shape).with_transform(transform).with_material(material));
    }
    // Twins: which of two hits at the same t is seen must not depend on the accelerator.
    let twin = scene.nodes()[1].clone();
    scene.add(twin);
    scene
}

#[test]
fn packets_find_what_each_of_their_rays_finds_alone() {
    // Of other worlds, too: what is in it is to make no difference.
    let mut scratch = PacketScratch::default();
    let mut random = Random::new(11);
    let mut hits = [0; 2];
    let few = (1..12).map(|count| gathered(count, count as usize));
    for scene in (0..4).map(crowd).chain(few) {
        for accelerator in Accelerator::ALL {
            let options = CompileOptions { accelerator, ..CompileOptions::default() };
            let world = World::compile(&scene, &options).unwrap();
            for _ in 0..200 {
                let (first, spread) = (random.ray(3.0), [1e-3, 0.03, 0.3, 3.0][random.below(4)]);
                let mut packet = RayPacket::splat(&first);
                for lane in 0..RayPacket::LANES {
                    let direction = first.direction + random.point(spread);
                    let t_max = if random.below(3) == 0 { random.between(0.0, 4.0) } else { f64::INFINITY };
                    packet.set(lane, &Ray { direction, t_max, ..first });
                }
                let wanted = [0xffff, 0x0fff, 0x1020, 0xaaaa][random.below(4)];
                let nearest = world.intersect_packet(&packet, wanted, &mut scratch);
                let occluded =
                    world.occluded_packet(&packet, wanted, &[None; RayPacket::LANES], &mut scratch);
                assert_eq!(occluded & !wanted, 0);
                for lane in 0..RayPacket::LANES {
                    let alone = world.intersect(&packet.ray(lane)).filter(|_| wanted >> lane & 1 == 1);
                    assert_eq!(nearest.at(lane), alone, "{accelerator:?} {:?}", packet.ray(lane));
                    assert_eq!(
                        occluded >> lane & 1 == 1,
                        alone.is_some(),
                        "{accelerator:?} {:?}",
                        packet.ray(lane)
                    );
                    hits[usize::from(alone.is_some())] += 1;
                }
            }
        }
    }
    assert!(hits[0] > 5_000 && hits[1] > 5_000, "{hits:?}");
}

#[test]
fn surfaces_of_a_packet_are_those_of_its_rays() {
    let mut random = Random::new(13);
    let mut data = ball(12, 24);
    let vertices = data.positions.len();
    // Every tenth is no direction.
    data.normals = (0..vertices)
        .map(|vertex| if vertex % 10 == 0 { [0.0; 3] } else { random.point(1.0).as_vec3().to_array() })
        .collect();
    data.uvs =
        (0..vertices).map(|_| [random.between(-1.0, 2.0) as f32, random.between(0.0, 1.0) as f32]).collect();
    data.colors = (0..vertices).map(|_| [(); 3].map(|()| random.between(0.0, 1.0) as f32)).collect();
    let painted = Arc::new(Mesh::new(data).unwrap());
    let (mut together, mut textured) = (0, 0);
    let mut met = Intersections::default();
    for seed in 0..4 {
        let mut scene = crowd(seed);
        for _ in 0..20 {
            let transform = random.transform(0.3, 1.0);
            scene.add(Node::mesh("painted", Arc::clone(&painted)).with_transform(transform));
        }
        for instructions in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
            let options = CompileOptions { instructions: Some(instructions), ..CompileOptions::default() };
            let world = World::compile(&scene, &options).unwrap();
            for _ in 0..200 {
                let (first, spread) = (random.ray(3.0), [1e-3, 0.03, 0.3][random.below(3)]);
                let mut packet = RayPacket::splat(&first);
                for lane in 0..RayPacket::LANES {
                    let direction = first.direction + random.point(spread);
                    packet.set(lane, &Ray { direction, ..first });
                }
                let found = world.intersect_packet(&packet, 0xfff7, &mut Default::default());
                let hits: [_; RayPacket::LANES] = std::array::from_fn(|lane| found.at(lane));
                met.find(&world, &packet, &found, true);
                for (lane, hit) in hits.iter().enumerate() {
                    let ray = packet.ray(lane);
                    let alone = hit.map(|hit| world.intersection(&ray, &hit));
                    assert_eq!(met.at(&world, lane), alone, "{instructions:?} {ray:?}");
                }
                met.find(&world, &packet, &found, false);
                for (lane, hit) in hits.iter().enumerate() {
                    let Some(hit) = hit else { continue };
                    let (alone, at) =
                        (world.intersection(&packet.ray(lane), hit), met.at(&world, lane).unwrap());
                    textured += u32::from(world.material(at.material).color.wants_uv());
                    let uv = if world.material(at.material).color.wants_uv() { at.uv } else { alone.uv };
                    assert_eq!(Intersection { uv, ..at }, alone);
                }
                let alike =
                    |hit: &Hit| hits.iter().flatten().filter(|other| other.object == hit.object).count();
                together += u32::from(hits.iter().flatten().any(|hit| alike(hit) > 3));
            }
        }
    }
    assert!(together > 1_000 && textured > 1_000, "{together} {textured}");
}

/// Also towards points that hardly rise above the face, as far as they are said to rise clearly.
#[test]
fn no_segment_is_stopped_by_the_face_that_it_leaves() {
    let mut random = Random::new(12);
    let (mut known, mut grazing) = (0, 0);
    for seed in 0..4 {
        let world = compile(&crowd(seed));
        let mut packets = 0;
        while packets < 300 {
            let ray = random.ray(3.0);
            let Some(hit) = world.intersect(&ray) else { continue };
            packets += 1;
            let at = world.intersection(&ray, &hit);
            let mut segments = RayPacket::splat(&ray);
            let mut left = [None; RayPacket::LANES];
            for (lane, left) in left.iter_mut().enumerate() {
                let height = portable::pow(10.0, random.between(-18.0, 0.0));
                let across = at.geometric_normal.cross(random.point(1.0))
                    * portable::pow(10.0, random.between(-4.0, 1.0));
                let target = at.point + across + at.facing_geometric_normal() * height;
                segments.set(lane, &at.segment_to(target));
                *left = at.face_left_for(target);
                known += u32::from(left.is_some());
                grazing += u32::from(left.is_some() && height < 1e-9 * across.length());
            }
            let occluded = world.occluded_packet(&segments, 0xffff, &left, &mut Default::default());
            for lane in 0..RayPacket::LANES {
                let alone = world.occluded(&segments.ray(lane));
                assert_eq!(occluded >> lane & 1 == 1, alone, "{at:?}, {:?}", segments.ray(lane));
            }
        }
    }
    assert!(known > 10_000 && grazing > 1_000, "{known} {grazing}");
}

#[test]
fn trees_and_brute_force_report_the_same_hit() {
    for seed in 0..10 {
        let scene = crowd(seed);
        let (world, oracle) = (compile(&scene), by_brute_force(&scene));
        let mut random = Random::new(50 + seed);
        for _ in 0..3000 {
            let mut ray = random.ray(3.0);
            if random.below(2) == 0 {
                ray.t_max = random.between(0.0, 2.0);
            }
            let expected = oracle.intersect(&ray);
            assert_eq!(world.intersect(&ray), expected, "{ray:?}");
            assert_eq!(world.occluded(&ray), expected.is_some(), "{ray:?}");
        }
    }
}

/// A million rays in all: 0 misses, at the origin and far away.
#[test]
fn no_ray_escapes_from_a_closed_mesh() {
    for (size, distance) in [(1.0, 0.0), (1e-3, 0.0), (1e3, 0.0), (1.0, 1e4), (1e-3, 1e4), (1e3, 1e4)] {
        let data = ball(24, 48);
        let mesh = Mesh::new(data.clone()).unwrap();
        let mut random = Random::new(3);
        let transform = random.transform(size, distance);
        let world = compile(&mesh_scene(data.clone(), transform));
        let mut from_inside = |to: DVec3| {
            let origin = transform.point(random.point(0.3));
            let ray = Ray::new(origin, transform.point(to) - origin);
            assert!(world.occluded(&ray), "size {size}, distance {distance}: {ray:?}");
        };
        for triangle in 0..mesh.triangle_count() as u32 {
            let [a, b, c] = mesh.corners(triangle);
            from_inside(a);
            from_inside((a + b) * 0.5);
            from_inside(b * 0.25 + c * 0.75);
        }
        let mut directions = Random::new(4);
        for _ in 0..170_000 {
            from_inside(directions.direction());
        }
    }
}

/// A mesh may be far thinner along one axis than it is long, as a drawn floor is: the rounding of a test against it mixes
/// all axes. And a triangle may be as thin as a needle: where it is met is then known far less well than where it lies.
#[test]
fn a_ray_that_leaves_a_thin_triangle_never_meets_it_again() {
    let mut random = Random::new(17);
    let mut left = 0;
    while left < 40_000 {
        let (length, tilt) = (random.between(0.1, 100.0), random.between(0.0, 1e-5));
        let (a, b, c) = (random.point(1.0), random.point(1.0), random.point(1.0));
        let width = portable::pow(10.0, random.between(-6.0, 0.0));
        let corners = [a, b, a.lerp(b, random.between(0.0, 1.0)).lerp(c, width)];
        let flat = |v: DVec3| DVec3::new(v.x * length, v.y * tilt - 0.02, v.z * length).as_vec3().to_array();
        let positions = corners.map(flat).to_vec();
        let indices = vec![[0, 1, 2]];
        let world = by_brute_force(&mesh_scene(
            MeshData { positions: positions.clone(), indices, ..MeshData::default() },
            Transform::IDENTITY,
        ));
        let aside = DVec3::new(1.0, 0.0, 1.0);
        for _ in 0..20 {
            let (u, v) = (random.between(0.0, 1.0), random.between(0.0, 1.0));
            let [a, b, c] = [0, 1, 2].map(|i| DVec3::from(positions[i].map(f64::from)));
            let target = a.lerp(b, u).lerp(c, v);
            let eye = DVec3::Y * random.between(0.1, 50.0) + random.point(100.0) * aside;
            let ray = Ray::new(eye, (target - eye).normalize());
            let Some(hit) = world.intersect(&ray) else { continue };
            let at = world.intersection(&ray, &hit);
            let light = DVec3::Y * random.between(0.1, 500.0) + random.point(1000.0) * aside;
            assert!(!world.occluded(&at.segment_to(light)), "{positions:?} {ray:?} {light}");
            let direction = (light - at.point).normalize();
            assert_eq!(world.intersect(&at.spawn(direction)), None, "{positions:?} {ray:?} {direction}");
            left += 1;
        }
    }
}

/// A million rays in all: what leaves a convex mesh outward never meets it.
#[test]
fn a_ray_that_leaves_a_convex_mesh_never_meets_it_again() {
    for size in [1e-3, 1.0, 1e3] {
        for distance in [0.0, 1.0, 1e2, 1e4] {
            let mut random = Random::new(6);
            let transform = random.transform(size, distance);
            let world = compile(&mesh_scene(ball(16, 32), transform));
            for _ in 0..85_000 {
                let origin = transform.point(random.direction() * 3.0);
                let ray = Ray::new(origin, transform.point(random.point(0.8)) - origin);
                let Some(hit) = world.intersect(&ray) else { continue };
                let at = world.intersection(&ray, &hit);
                let mut direction = random.direction();
                let normal = at.geometric_normal;
                if random.below(4) == 0 {
                    direction = (direction - normal * direction.dot(normal)).normalize() + normal * 1e-6;
                }
                let outward = if direction.dot(normal) < 0.0 { -direction } else { direction };
                let left = at.spawn(outward);
                assert!(!world.occluded(&left), "size {size}, distance {distance}: {left:?}");
                assert!(world.occluded(&at.spawn(-normal)), "size {size}, distance {distance}: {at:?}");
            }
        }
    }
}

#[test]
fn normals_of_sheared_and_mirrored_shapes_match_finite_differences() {
    let mut random = Random::new(11);
    let smooth = {
        let mut data = ball(64, 128);
        data.normals.clone_from(&data.positions);
        Shape::Mesh(Arc::new(Mesh::new(data).unwrap()))
    };
    for round in 0..200 {
        let shapes =
            [Shape::Sphere, Shape::Cube, Shape::Cylinder { capped: true }, Shape::Plane, smooth.clone()];
        let shape = shapes[round % 5].clone();
        let flat = matches!(shape, Shape::Mesh(_));
        let distance = random.between(0.0, 5.0);
        let transform = random.transform(1.0, distance);
        let mut scene = Scene::new("one");
        scene.add(Node::shape("it", shape).with_transform(transform));
        let world = compile(&scene);
        let from = transform.point(random.direction().abs() * 4.0);
        let to = transform.point(random.point(0.2));
        let normal = surface_normal(&world, from, to, 1e-5);
        let ray = Ray::new(from, (to - from).normalize());
        let Some(at) = world.intersect(&ray).map(|hit| world.intersection(&ray, &hit)) else { continue };
        assert!(!at.from_inside);
        assert!(at.facing_normal().dot(ray.direction) < 0.0);
        assert!((at.geometric_normal.length() - 1.0).abs() < 1e-12);
        if let Some(normal) = normal {
            let cosine = at.geometric_normal.dot(normal);
            assert!(cosine > 1.0 - 1e-6, "{transform:?}: {normal} is not {}", at.geometric_normal);
        }
        if !flat {
            assert_eq!(at.shading_normal, at.geometric_normal);
        } else {
            assert!(at.shading_normal.dot(at.geometric_normal) > 0.99);
        }
    }
}

/// The normal of the surface seen from `from`, by three neighbouring rays; none near an edge.
fn surface_normal(world: &World, from: DVec3, to: DVec3, step: f64) -> Option<DVec3> {
    let direction = (to - from).normalize();
    let (u, v) = direction.any_orthonormal_pair();
    let hit = |offset: DVec3| {
        let ray = Ray::new(from, (direction + offset * step).normalize());
        let hit = world.intersect(&ray)?;
        Some((ray.at(hit.t), hit.primitive))
    };
    let (a, b, c) = (hit(DVec3::ZERO)?, hit(u)?, hit(v)?);
    if a.1 != b.1 || a.1 != c.1 {
        return None;
    }
    let normal = (b.0 - a.0).cross(c.0 - a.0).normalize();
    Some(if normal.dot(direction) > 0.0 { -normal } else { normal })
}

#[test]
fn a_ray_from_inside_is_told_so_even_in_a_mirrored_shape() {
    for mirror in [1.0, -1.0] {
        let mut scene = Scene::new("one");
        let transform = Transform::scale(DVec3::new(mirror, 2.0, 1.0));
        scene.add(Node::shape("ball", Shape::Sphere).with_transform(transform));
        let mesh = Node::mesh("mesh", Mesh::new(ball(8, 16)).unwrap());
        scene.add(mesh.with_transform(transform.then(Transform::translate(DVec3::X * 5.0))));
        let world = compile(&scene);
        for center in [DVec3::ZERO, DVec3::X * 5.0] {
            let out = Ray::new(center, DVec3::new(0.1, 0.2, 1.0));
            assert!(world.intersection(&out, &world.intersect(&out).unwrap()).from_inside);
            let back = Ray::new(center + DVec3::Z * 3.0, DVec3::new(0.01, 0.02, -1.0));
            assert!(!world.intersection(&back, &world.intersect(&back).unwrap()).from_inside);
        }
    }
}

#[test]
fn instances_share_one_mesh_and_one_tree() {
    let mut scene = Scene::new("instances");
    let leaf = scene.insert(Node::mesh("leaf", soup(1, 100)));
    let branch = scene.insert(Node::group("branch", [leaf, leaf, leaf]));
    for i in 0..10 {
        let place = Transform::translate(DVec3::X * f64::from(i));
        scene.add(Node::group("tree", [branch]).with_transform(place));
    }
    let statistics = compile(&scene).statistics();
    assert_eq!((statistics.objects, statistics.meshes), (30, 1));
    assert_eq!((statistics.triangles, statistics.instanced_triangles), (100, 3000));
}

#[test]
fn materials_are_inherited_from_the_nearest_ancestor() {
    let mut scene = Scene::new("inheritance");
    let red = scene.add_material(Material::named("red"));
    let blue = scene.add_material(Material::named("blue"));
    let plain = scene.insert(Node::shape("plain", Shape::Sphere));
    let own = scene.insert(Node::shape("own", Shape::Sphere).with_material(blue));
    scene.add(Node::group("group", [plain, own]).with_material(red));
    scene.add(Node::shape("bare", Shape::Sphere));
    let world = compile(&scene);
    let names = world.objects().iter().map(|object| world.material(object.material()).name.as_str());
    assert_eq!(names.collect::<Vec<_>>(), ["red", "blue", "default"]);
}

#[test]
fn transforms_apply_from_the_leaf_to_the_root() {
    let mut scene = Scene::new("nested");
    let ball =
        scene.insert(Node::shape("ball", Shape::Sphere).with_transform(Transform::translate(DVec3::X * 2.0)));
    scene.add(Node::group("turned", [ball]).with_transform(Transform::rotate(DVec3::Z, 90.0)));
    let world = compile(&scene);
    let down = Ray::new(DVec3::Y * 9.0, DVec3::NEG_Y);
    assert_eq!(world.intersect(&down).unwrap().t, 6.0);
}

#[test]
fn a_tree_of_any_depth_compiles() {
    let mut scene = Scene::new("deep");
    let mut child = scene.insert(Node::shape("ball", Shape::Sphere));
    for _ in 0..100_000 {
        child = scene.insert(Node { children: vec![child], ..Node::default() });
    }
    scene.add(Node::group("top", [child]));
    assert_eq!(compile(&scene).objects().len(), 1);
}

#[test]
fn faults_of_a_scene_are_named() {
    assert_eq!(compile_error(&Scene::new("empty")), CompileError::NothingToDraw);

    let mut scene = Scene::new("cycle");
    let a = scene.add(Node::group("a", []));
    let b = scene.add_child(a, Node::group("b", [a]));
    assert_eq!(compile_error(&scene), CompileError::Cycle { node: "`a`".into() });
    scene.node_mut(b).children = vec![b];
    assert_eq!(compile_error(&scene), CompileError::Cycle { node: "`b`".into() });

    let mut scene = Scene::new("singular");
    let flat = Transform::scale(DVec3::new(1.0, 0.0, 1.0));
    scene.add(Node::shape("flat", Shape::Sphere).with_transform(flat));
    assert_eq!(compile_error(&scene), CompileError::Singular { node: "`flat`".into() });
    let mut scene = Scene::new("not finite");
    scene.add(Node::shape("lost", Shape::Sphere).with_transform(Transform::translate(DVec3::NAN)));
    assert_eq!(compile_error(&scene), CompileError::Singular { node: "`lost`".into() });

    let mut scene = Scene::new("too many");
    let mut node = scene.insert(Node::shape("ball", Shape::Sphere));
    for _ in 0..60 {
        node = scene.insert(Node::group("twice", [node, node]));
    }
    scene.add(Node::group("top", [node]));
    assert_eq!(compile_error(&scene), CompileError::TooManyObjects { count: 1 << 60 });

    let mut scene = crowd(1);
    scene.add_light(DVec3::ZERO, Rgb::grey(f64::NAN));
    assert_eq!(compile_error(&scene), CompileError::Light { what: "light 0".into() });

    let wrong: [(Material, &str); 4] = [
        (Material { ior: 0.0, ..Material::named("m") }, "ior"),
        (Material { shininess: -1.0, ..Material::named("m") }, "shininess"),
        (Material { reflect: Rgb::grey(-0.1), ..Material::named("m") }, "reflect"),
        (Material { color: Texture::Solid(Rgb::grey(f64::INFINITY)), ..Material::named("m") }, "color"),
    ];
    for (material, name) in wrong {
        let mut scene = crowd(1);
        scene.add_material(material);
        let CompileError::Material { material, property, .. } = compile_error(&scene) else {
            panic!("{name} was not refused");
        };
        assert_eq!((material.as_str(), property), ("material `m`", name));
    }
}

#[test]
fn scales_that_are_tiny_but_regular_are_legal() {
    let mut scene = Scene::new("tiny");
    scene.add(Node::shape("mote", Shape::Sphere).with_transform(Transform::scale(DVec3::splat(1e-120))));
    let world = compile(&scene);
    assert!(world.occluded(&Ray::new(DVec3::Z, DVec3::NEG_Z)));
}

#[test]
fn ten_thousand_objects_cost_little_more_than_one() {
    let mut scene = Scene::new("field");
    let leaf = scene.insert(Node::mesh("leaf", soup(1, 50)));
    for (x, z) in (0..100).flat_map(|x| (0..100).map(move |z| (x, z))) {
        let place = Transform::translate(DVec3::new(3.0 * f64::from(x), 0.0, 3.0 * f64::from(z)));
        scene.add(Node::group("it", [leaf]).with_transform(place));
    }
    let world = compile(&scene);
    let mut random = Random::new(12);
    let (mut visits, rays) = (0, 2000);
    for _ in 0..rays {
        let to = DVec3::new(random.between(0.0, 300.0), 0.0, random.between(0.0, 300.0));
        let ray = Ray::new(to + DVec3::Y * 20.0, DVec3::NEG_Y + random.point(0.3));
        world.visit_objects(&ray, &Uncounted, |_, _| {
            visits += 1;
            ray.t_max
        });
    }
    assert!(visits < 10 * rays, "{} objects a ray", f64::from(visits) / f64::from(rays));
}

#[test]
fn media_around_a_point_are_the_objects_that_it_is_inside_of() {
    let mut scene = Scene::new("nested");
    let glass = scene.add_material(Material { transmit: Rgb::WHITE, ior: 1.5, ..Material::default() });
    let water = scene.add_material(Material { transmit: Rgb::WHITE, ior: 1.33, ..Material::default() });
    let big = Transform::scale(DVec3::splat(3.0));
    scene.add(Node::shape("outer", Shape::Sphere).with_material(glass).with_transform(big));
    scene.add(Node::shape("inner", Shape::Cube).with_material(water));
    scene.add(Node::shape("opaque", Shape::Cube).with_transform(big.then(big)));
    let world = compile(&scene);
    assert_eq!(Media::around(&world, DVec3::ZERO).ior(&world), 1.33);
    assert_eq!(Media::around(&world, DVec3::X * 2.0).ior(&world), 1.5);
    assert_eq!(Media::around(&world, DVec3::X * 4.0).ior(&world), 1.0);
}

/// Meshes with and without normals, shapes, instances, planes; stretched, mirrored and far away.
fn gathering(random: &mut Random) -> Scene {
    let mut scene = Scene::new("crowd");
    scene.add(Node::shape("floor", Shape::Plane).with_transform(Transform::translate(DVec3::Y * -1.2)));
    let mut smooth = ball(8, 12);
    smooth.normals = smooth.positions.clone();
    let meshes = [Mesh::new(smooth).unwrap(), Mesh::new(ball(6, 9)).unwrap(), soup(11, 60)].map(Arc::new);
    for (i, mesh) in meshes.iter().cycle().take(6).enumerate() {
        let transform = match i {
            0 => Transform::IDENTITY,
            1 => Transform::scale(DVec3::splat(0.5)).then(Transform::translate(random.point(1.0))),
            _ => random.transform(0.5, 1.0),
        };
        scene.add(Node::shape("mesh", Shape::Mesh(Arc::clone(mesh))).with_transform(transform));
    }
    for shape in [Shape::Sphere, Shape::Cube, Shape::Cylinder { capped: true }] {
        scene.add(Node::shape("shape", shape).with_transform(random.transform(0.3, 1.5)));
    }
    scene
}

#[test]
fn a_fan_is_occluded_where_its_rays_are() {
    let mut scratch = FanScratch::default();
    let mut random = Random::new(21);
    let (mut open, mut shut) = (0, 0);
    for round in 0..6 {
        let scene = gathering(&mut random);
        let compile = |accelerator, instructions| {
            let options = CompileOptions { accelerator, instructions, ..CompileOptions::default() };
            World::compile(&scene, &options).unwrap()
        };
        let oracle = compile(Accelerator::BruteForce, None);
        let sets = InstructionSet::ALL.into_iter().filter(|set| set.is_available());
        let mut worlds: Vec<_> = sets.map(|set| compile(Accelerator::Bvh, Some(set))).collect();
        worlds.push(compile(Accelerator::KdTree, None));
        let lattice = HemisphereLattice::new(90);
        for point in 0..60 {
            let ray = Ray::new(random.point(3.0), random.direction());
            let Some(hit) = oracle.intersect(&ray) else { continue };
            let at = oracle.intersection(&ray, &hit);
            let reach = [0.01, 0.3, 2.0, f64::INFINITY][random.below(4)];
            let mut stream = Key::camera(point, round, 0).stream();
            for fan in lattice.around(at.facing_normal(), &mut stream) {
                let expected = (0..fan.count).fold(0_u64, |bits, i| {
                    let ray = Ray { t_max: reach, ..at.spawn(fan.direction(i)) };
                    bits | u64::from(oracle.occluded(&ray)) << i
                });
                for world in &worlds {
                    assert_eq!(
                        world.occluded_fan(&at, &fan, reach, &mut scratch),
                        expected,
                        "{ray:?} {reach}"
                    );
                }
                open += fan.count as u32 - expected.count_ones();
                shut += expected.count_ones();
            }
        }
    }
    assert!(open > 1000 && shut > 1000, "{open} open, {shut} shut");
}
