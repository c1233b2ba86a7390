//! Boxes to look at.

use super::*;
use crate::accel::Aabb;

fn bounds_of(corners: &[DVec3; 8]) -> Bounds {
    Bounds::of_points(corners.iter().copied())
}

fn contains(outer: &Bounds, inner: &Bounds) -> bool {
    inner.min.cmpge(outer.min).all() && inner.max.cmple(outer.max).all()
}

/// A large mesh, moved but neither turned nor scaled, so that its boxes keep their coordinates.
fn scan(accelerator: Accelerator) -> World {
    let scene = mesh_scene(ball(40, 80), Transform::translate(DVec3::new(4.0, 8.0, 16.0)));
    World::compile(&scene, &CompileOptions { accelerator, ..CompileOptions::default() }).unwrap()
}

const TREES: [Accelerator; 2] = [Accelerator::Bvh, Accelerator::KdTree];

#[test]
fn the_box_of_an_object_turns_with_it_and_lies_in_its_bounds() {
    let mut random = Random::new(41);
    for shape in [Shape::Sphere, Shape::Cube, Shape::Cylinder { capped: true }] {
        let transform = random.transform(1.0, 5.0);
        let mut scene = Scene::new("one");
        scene.add(Node::shape("it", shape).with_transform(transform));
        let world = compile(&scene);
        let corners = world.object_corners(ObjectId(0)).unwrap();
        for (found, canonical) in corners.iter().zip(Bounds::new(-DVec3::ONE, DVec3::ONE).corners()) {
            assert!((*found - transform.point(canonical)).length() < 1e-12);
        }
        assert!(contains(&world.object_bounds(ObjectId(0)), &bounds_of(&corners)));
        assert_eq!(world.object_bounds(ObjectId(0)), world.bounds());
    }
}

#[test]
fn a_plane_has_no_box() {
    let mut scene = Scene::new("plane");
    scene.add(Node::shape("plane", Shape::Plane));
    for accelerator in Accelerator::ALL {
        let options = CompileOptions { accelerator, ..CompileOptions::default() };
        let world = World::compile(&scene, &options).unwrap();
        assert_eq!(world.object_corners(ObjectId(0)), None);
        assert_eq!(world.object_bounds(ObjectId(0)), Bounds::UNBOUNDED);
        assert!(
            world.objects_tree_boxes(0, 9).is_empty() && world.mesh_tree_boxes(ObjectId(0), 0, 9).is_empty()
        );
    }
}

#[test]
fn level_0_is_the_box_of_all() {
    for accelerator in TREES {
        let world = scan(accelerator);
        let corners = world.object_corners(ObjectId(0)).unwrap();
        assert_eq!(world.mesh_tree_boxes(ObjectId(0), 0, 9), [corners]);
        let all = Aabb::around(&world.bounds()).to_bounds().corners();
        assert_eq!(world.objects_tree_boxes(0, 9), [all]);
    }
}

#[test]
fn every_box_lies_in_one_of_the_level_above() {
    for accelerator in TREES {
        let world = scan(accelerator);
        let mut above = world.mesh_tree_boxes(ObjectId(0), 0, usize::MAX);
        let mut levels = 0;
        while !above.is_empty() {
            let level = world.mesh_tree_boxes(ObjectId(0), levels + 1, usize::MAX);
            for corners in &level {
                let inner = bounds_of(corners);
                assert!(above.iter().any(|outer| contains(&bounds_of(outer), &inner)), "level {levels}");
            }
            above = level;
            levels += 1;
        }
        // The leaves of a hierarchy of boxes are boxes too, one step below the deepest node.
        let depth = world.meshes[0].index.size().2;
        assert_eq!(levels, if accelerator == Accelerator::Bvh { depth + 2 } else { depth + 1 });
    }
}

#[test]
fn cells_fill_the_one_above_and_boxes_hold_every_triangle() {
    let triangles = Mesh::new(ball(40, 80)).unwrap();
    let offset = DVec3::new(4.0, 8.0, 16.0);
    for accelerator in TREES {
        let world = scan(accelerator);
        for level in 0..3 {
            let boxes = world.mesh_tree_boxes(ObjectId(0), level, usize::MAX);
            let boxes = boxes.iter().map(bounds_of).collect::<Vec<_>>();
            for triangle in 0..triangles.triangle_count() as u32 {
                let center = offset + triangles.corners(triangle).iter().sum::<DVec3>() / 3.0;
                let held = |bounds: &Bounds| contains(bounds, &Bounds::new(center, center));
                assert!(boxes.iter().any(held), "{accelerator:?}, level {level}");
            }
            let volume = boxes.iter().map(|bounds| bounds.extent().element_product()).sum::<f64>();
            let whole = world.bounds().extent().element_product();
            if accelerator == Accelerator::KdTree {
                assert!((volume / whole - 1.0).abs() < 1e-6, "level {level}");
            }
        }
    }
}

#[test]
fn no_more_boxes_come_than_were_asked_for() {
    for accelerator in TREES {
        let world = scan(accelerator);
        let all = world.mesh_tree_boxes(ObjectId(0), 3, usize::MAX);
        for most in [0, 1, 5, all.len()] {
            assert_eq!(world.mesh_tree_boxes(ObjectId(0), 3, most), all[..most]);
        }
        assert!(world.mesh_tree_boxes(ObjectId(0), u32::MAX, usize::MAX).is_empty());
    }
}

#[test]
fn brute_force_has_objects_with_boxes_and_no_tree() {
    let world = scan(Accelerator::BruteForce);
    assert!(world.object_corners(ObjectId(0)).is_some());
    assert!(world.objects_tree_boxes(0, 9).is_empty() && world.mesh_tree_boxes(ObjectId(0), 0, 9).is_empty());
}
