//! Scenes written as files that stand alone.

use crate::common::{drawn, vector};
use lancer_core::Rgb;
use lancer_core::film::{Tone, ToneCurve};
use lancer_core::geometry::Transform;
use lancer_core::mesh::{Mesh, MeshData};
use lancer_core::scene::{ImageTexture, Material, Node, Scene, Shape, Texture, Wrap};
use lancer_io::scene_file::write_whole;
use lancer_io::{LoadOptions, load};
use std::fs;
use std::path::Path;
use std::sync::Arc;
use tempfile::TempDir;

fn written(scene: &Scene, name: &str) -> (TempDir, Scene) {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join(name);
    write_whole(scene, &path).unwrap_or_else(|error| panic!("{error}"));
    (directory, read(&path))
}

fn read(path: &Path) -> Scene {
    load(path, &LoadOptions::default()).unwrap_or_else(|error| panic!("{error}")).scene
}

/// Far from its origin against its size, with normals of all lengths, one of them 0, and colours.
fn odd_mesh() -> Arc<Mesh> {
    let mesh = Mesh::new(MeshData {
        positions: vec![[1000.1, -0.0, 0.3], [1001.7, 0.0, 0.3], [1000.1, 2.0, 1e-30], [5.0, 5.0, 5.0]],
        normals: vec![[0.0, 0.1, 3.0], [0.0; 3], [1.0, 1.0, 1.0], [0.6, 0.8, 0.0]],
        uvs: vec![[0.1, 0.2], [-3.0, 1e20], [0.5, 0.5], [0.0, 0.0]],
        colors: vec![[0.1, 0.2, 0.3], [1.0, 0.0, 1e-30], [0.5, 0.5, 0.5], [0.0, 1.0, 0.7]],
        indices: vec![[2, 0, 1], [0, 1, 1], [0, 2, 1]],
    });
    Arc::new(mesh.unwrap())
}

fn meshes(scene: &Scene) -> Vec<Arc<Mesh>> {
    let mesh = |node: &Node| match &node.shape {
        Some(Shape::Mesh(mesh)) => Some(Arc::clone(mesh)),
        _ => None,
    };
    scene.nodes().iter().filter_map(mesh).collect()
}

fn everything() -> Scene {
    let mut scene = Scene::new("All: of \"it\"");
    scene.camera.eye = vector(0.1, 2.0, 1e-7);
    scene.cameras.push(("top view".into(), scene.camera));
    scene.ambient = Rgb::grey(0.1);
    scene.background = Rgb::new(0.1, 0.2, 0.3);
    scene.add_light(vector(1.0, 2.0, 3.0), Rgb::grey(1.0 / 3.0));
    scene.settings.ao.samples = 3;
    scene.settings.refraction = false;
    scene.tone = Tone { exposure: 0.7, curve: ToneCurve::Filmic };
    let texels = Arc::new(ImageTexture::new(2, 1, vec![[0, 127, 255], [3, 2, 1]]).unwrap());
    let image =
        scene.add_material(Material { color: Arc::clone(&texels).into(), ..Material::named("twice") });
    let checker = Texture::Checker { even: Rgb::WHITE, odd: Rgb::new(0.1, 0.2, 0.3), size: 0.3 };
    let checker = scene.add_material(Material { color: checker, ior: 1.3, ..Material::named("twice") });
    let nameless = scene.add_material(Material { fresnel: true, ..Material::default() });
    let wrapped = |wrap| Texture::Image { image: Arc::clone(&texels), wrap };
    for wrap in [[Wrap::Clamp; 2], [Wrap::Mirror, Wrap::Repeat]] {
        let material = Material { color: wrapped(wrap), ..Material::named("beyond") };
        let material = scene.add_material(material);
        scene.add(Node::shape("wrapped", Shape::Plane).with_material(material));
    }

    let mesh = scene.insert(Node::mesh("Odd/one", odd_mesh()).with_material(image));
    let shared =
        scene.insert(Node::group("shared", [mesh]).with_transform(Transform::scale(vector(1.0, 2.0, 3.0))));
    let turned =
        Transform::rotate(vector(1.0, 2.0, 3.0), 33.0).then(Transform::translate(vector(0.1, 0.2, 0.3)));
    scene.add(Node::group("left", [shared, mesh]).with_transform(turned));
    scene.add(Node { children: vec![shared], ..Node::shape("right", Shape::Cylinder { capped: false }) });
    scene.add(Node { hidden: true, ..Node::shape("gone", Shape::Sphere).with_material(checker) });
    scene.add(Node { children: vec![shared], ..Node::mesh("again", odd_mesh()).with_material(nameless) });
    scene.add(Node::group("empty", []));
    scene
}

#[test]
fn a_written_scene_reads_back_as_what_it_was() {
    for name in ["all.yaml", "all.json"] {
        let scene = everything();
        let (_directory, found) = written(&scene, name);
        assert_eq!((&found.name, found.camera, &found.cameras), (&scene.name, scene.camera, &scene.cameras));
        assert_eq!((found.ambient, found.background), (scene.ambient, scene.background));
        assert_eq!((&found.lights, found.settings, found.tone), (&scene.lights, scene.settings, scene.tone));

        let places = |scene: &Scene| drawn(scene).into_iter().map(|(_, place, _)| place).collect::<Vec<_>>();
        assert_eq!(places(&found), places(&scene));
        let hidden = |scene: &Scene| scene.nodes().iter().filter(|node| node.hidden).count();
        assert_eq!(hidden(&found), 1);
        for mesh in meshes(&found) {
            assert_eq!(mesh, odd_mesh());
        }
        let names = found.materials().iter().map(|material| material.name.as_str()).collect::<Vec<_>>();
        assert_eq!(names, ["twice", "twice 2", "material", "beyond", "beyond 2"]);
        for (found, expected) in found.materials().iter().zip(scene.materials()) {
            assert_eq!(*found, Material { name: found.name.clone(), ..expected.clone() });
        }
    }
}

#[test]
fn equal_meshes_are_one_file_and_a_second_writing_changes_nothing() {
    let scene = everything();
    let (directory, _) = written(&scene, "all.yaml");
    let listed = || {
        let entries = fs::read_dir(directory.path().join("all-files")).unwrap();
        let mut names =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect::<Vec<_>>();
        names.sort();
        names
    };
    let first = listed();
    assert_eq!(first.len(), 2, "{first:?}");
    assert!(first[0].starts_with("odd-one-") && first[1].starts_with("twice-"), "{first:?}");
    write_whole(&scene, &directory.path().join("all.yaml")).unwrap();
    assert_eq!(listed(), first);
}

#[test]
fn a_scene_of_shapes_alone_is_one_file_that_a_person_can_read() {
    let mut scene = Scene::new("balls");
    scene.ambient = Rgb::grey(0.2);
    let red =
        scene.add_material(Material { color: Rgb::new(1.0, 0.0, 0.0).into(), ..Material::named("red") });
    let lifted = Transform::translate(vector(0.0, 1.0, 0.0));
    scene.add(Node::shape("ball", Shape::Sphere).with_material(red).with_transform(lifted));
    scene.add(Node::shape("", Shape::Plane));
    let (directory, _) = written(&scene, "balls.yaml");
    assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 1);
    let text = fs::read_to_string(directory.path().join("balls.yaml")).unwrap();
    let expected = "\
format: 1
name: balls
camera: {eye: [0, 0, 5], target: [0, 0, 0], up: [0, 1, 0], fov: 40}
ambient: 0.2
background: 0
render:
  width: 800
  height: 600
  samples: 1
  depth: 5
  shadows: true
  reflection: true
  refraction: true
  exposure: 0
  tone: linear
  ao: {samples: 0, distance: 1}
materials:
  red:
    color: [1, 0, 0]
    ambient: 1
    diffuse: 1
    specular: 0
    metallic: 0
    shininess: 32
    reflect: 0
    transmit: 0
    ior: 1.5
    fresnel: false
objects:
  - {name: ball, shape: sphere, material: red, transform: [{translate: [0, 1, 0]}]}
  - {shape: plane}
";
    assert_eq!(text, expected);
}

#[test]
fn a_chain_deeper_than_a_file_may_be_nested_is_written() {
    let mut scene = Scene::new("deep");
    scene.ambient = Rgb::WHITE;
    let step = Transform::translate(vector(0.5, 0.0, 0.0));
    let mut child = scene.insert(Node::shape("leaf", Shape::Sphere));
    for _ in 0..1000 {
        child = scene.insert(Node::group("", [child]).with_transform(step));
    }
    scene.add(Node::group("top", [child]));
    let (_directory, found) = written(&scene, "deep.yaml");
    assert_eq!(drawn(&found)[0].1, Transform::translate(vector(500.0, 0.0, 0.0)));
}

#[test]
fn what_could_not_be_read_is_not_written() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("scene.yaml");
    fs::write(&path, "as it was").unwrap();
    let fault = |scene: &Scene| write_whole(scene, &path).unwrap_err().to_string();

    let mut scene = Scene::new("empty");
    assert!(fault(&scene).contains("nothing to draw"), "{}", fault(&scene));
    scene.add(Node::mesh("", odd_mesh()).with_transform(Transform::scale(vector(1.0, 0.0, 1.0))));
    assert!(fault(&scene).contains("singular"), "{}", fault(&scene));
    let looped = scene.insert(Node::default());
    scene.node_mut(looped).children.push(looped);
    scene.add(Node::group("", [looped]));
    assert!(fault(&scene).contains("hold itself"), "{}", fault(&scene));

    let nowhere = directory.path().join("no/scene.yaml");
    assert!(write_whole(&everything(), &nowhere).unwrap_err().to_string().contains("cannot be written"));
    assert_eq!(fs::read_to_string(&path).unwrap(), "as it was");
    assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 1);
}
