//! Worlds from earlier worlds, and compilations that are cancelled.

use super::*;
use crate::accel::{KdSettings, Quality};
use crate::cancel::CancelToken;

fn from(previous: &World, scene: &Scene, options: &CompileOptions) -> World {
    let control = CompileControl { previous: Some(previous), ..CompileControl::default() };
    World::compile_with(scene, options, &control).unwrap()
}

/// Some of every edit: a material, a light, transforms, a mesh that comes, one that goes, and a hidden node.
fn edit(scene: &mut Scene, random: &mut Random) {
    let red = scene.add_material(Material { color: Rgb::new(1.0, 0.0, 0.0).into(), ..Material::default() });
    scene.add_light(random.point(3.0), Rgb::WHITE);
    scene.add(Node::mesh("new", soup(5, 40)).with_material(red));
    let roots = scene.roots().to_vec();
    scene.node_mut(roots[1]).shape = Some(Shape::Cube);
    scene.node_mut(roots[2]).transform = random.transform(0.5, 1.0);
    scene.node_mut(roots[3]).material = Some(red);
    scene.node_mut(roots[4]).hidden = true;
}

#[test]
fn a_world_from_an_earlier_one_answers_as_one_from_nothing() {
    for accelerator in Accelerator::ALL {
        let options = CompileOptions { accelerator, ..CompileOptions::default() };
        let mut random = Random::new(31);
        let mut scene = gathering(&mut random);
        let before = World::compile(&scene, &options).unwrap();
        edit(&mut scene, &mut random);
        let (world, oracle) = (from(&before, &scene, &options), World::compile(&scene, &options).unwrap());
        assert_eq!(world.statistics(), oracle.statistics());
        assert_eq!((world.bounds(), world.lights()), (oracle.bounds(), oracle.lights()));
        for _ in 0..3000 {
            let ray = random.ray(3.0);
            let hit = oracle.intersect(&ray);
            assert_eq!(world.intersect(&ray), hit, "{ray:?}");
            let Some(hit) = hit else { continue };
            let at = oracle.intersection(&ray, &hit);
            assert_eq!(world.intersection(&ray, &hit), at, "{ray:?}");
            assert_eq!(world.material(at.material), oracle.material(at.material));
        }
    }
}

/// Which meshes of a world have the very tree that another has.
fn shared(world: &World, previous: &World) -> Vec<bool> {
    let is_in = |mesh: &Arc<PreparedMesh>| previous.meshes.iter().any(|other| Arc::ptr_eq(mesh, other));
    world.meshes.iter().map(is_in).collect()
}

#[test]
fn trees_are_shared_over_meshes_that_are_the_same_and_no_others() {
    let mut scene = Scene::new("two");
    let mesh = Arc::new(soup(1, 50));
    scene.add(Node::mesh("kept", Arc::clone(&mesh)));
    let other = scene.add(Node::mesh("replaced", Arc::clone(&mesh).as_ref().clone()));
    let options = CompileOptions::default();
    let before = World::compile(&scene, &options).unwrap();
    assert_eq!(shared(&from(&before, &scene, &options), &before), [true, true]);
    // Equal triangles at another place in memory are another mesh.
    scene.node_mut(other).shape = Some(Shape::Mesh(Arc::new(mesh.as_ref().clone())));
    assert_eq!(shared(&from(&before, &scene, &options), &before), [true, false]);
}

#[test]
fn trees_are_built_anew_where_an_option_differs() {
    let mut scene = Scene::new("one");
    scene.add(Node::mesh("mesh", soup(1, 50)));
    let options = CompileOptions::default();
    let before = World::compile(&scene, &options).unwrap();
    for other in [
        CompileOptions { accelerator: Accelerator::KdTree, ..options },
        CompileOptions { kd: KdSettings { leaf: Some(9), depth: None }, ..options },
        CompileOptions { quality: Quality::Fast, ..options },
        CompileOptions { instructions: Some(InstructionSet::ALL[0]), ..options },
    ] {
        let after = from(&before, &scene, &other);
        assert_eq!(shared(&after, &before), [false], "{other:?}");
        assert_eq!(after.statistics(), World::compile(&scene, &other).unwrap().statistics());
    }
}

#[test]
fn a_cancelled_compilation_says_so_and_makes_no_world() {
    let cancel = CancelToken::default();
    cancel.cancel();
    let control = CompileControl { cancel, ..CompileControl::default() };
    for accelerator in Accelerator::ALL {
        let options = CompileOptions { accelerator, ..CompileOptions::default() };
        for scene in [crowd(1), mesh_scene(ball(64, 64), Transform::IDENTITY)] {
            let result = World::compile_with(&scene, &options, &control);
            assert_eq!(result.map(drop), Err(CompileError::Cancelled), "{accelerator:?}");
        }
    }
}
