//! Files without faults read into exactly the scene that they say.

use crate::common::{Shelf, drawn, load_with, scene, the_error, vector, warnings, wood};
use lancer_core::Rgb;
use lancer_core::camera::Camera;
use lancer_core::geometry::Transform;
use lancer_core::scene::{AmbientOcclusion, Light, Material, Node, Scene, Settings, Shape, Texture, Wrap};

/// The example of the format's description.
pub(crate) const EXAMPLE: &str = r##"
format: 1
name: Whitted 1980
camera: {eye: [0, 2, 8], target: [0, 1, 0], up: [0, 1, 0], fov: 40}
cameras: {top: {eye: [0, 9, 0], target: [0, 0, 0], up: [0, 0, -1], fov: 40}}    # optional, named
ambient: [0.2, 0.2, 0.2]            # L_a
background: "#87ceeb"               # default black
lights:
  - {position: [4, 6, 4], intensity: [300, 300, 300]}      # L_i; one number means grey
materials:
  glass: {color: [1, 1, 1], ambient: 0.1, diffuse: 0.1, specular: 0.5, metallic: 0,
          shininess: 200, reflect: 0.1, transmit: 0.8, ior: 1.5}
assets:                             # subtrees that are not drawn by themselves, to be used many times
  lamp: {children: [{shape: sphere, material: glass}]}
objects:
  - name: ball
    shape: sphere
    material: glass
    transform:                      # applied to the object in the order written
      - scale: [1, 2, 1]            # or one number
      - rotate: {axis: y, angle: 30}
      - translate: [0, 1, 0]
  - name: group
    transform: [{matrix: [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]}]      # row-major, column vectors
    children: [{use: lamp}, {shape: plane, material: {color: "#808080", diffuse: 0.9}}]
render: {width: 800, height: 600, samples: 2, depth: 5, ao: {samples: 64, distance: 1}}
"##;

/// The same as a program might write it: another order, no spaces, escapes.
pub(crate) const EXAMPLE_IN_JSON: &str = r##"{"render":{"ao":{"distance":1.0,"samples":64},"depth":5,"height":600,
"samples":2.0,"width":800},"objects":[{"material":"glass","name":"ball","shape":"sphere","transform":[
{"scale":[1,2,1]},{"rotate":{"angle":30.0,"axis":[0,1,0]}},{"translate":[0,1e0,0]}]},{"children":[{"use":"lamp",
"name":""},{"material":{"color":"\u0023808080","diffuse":[0.9,0.9,0.9]},"shape":"plane","use":null}],"name":"group",
"transform":[{"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}]}],"name":"Whitted 1980","materials":{"glass":{"ior":1.5,
"transmit":0.8,"reflect":0.1,"shininess":200,"metallic":0,"specular":0.5,"diffuse":0.1,"ambient":0.1,
"color":"#fff"}},"lights":[{"intensity":300,"position":[4,6,4]}],"format":1,"cameras":{"top":{"eye":[0,9,0],
"target":[0,0,0],"up":[0,0,-1]}},"camera":{"eye":[0,2,8],"target":[0,1,0]},"background":"#87ceeb","assets":{
	"lamp":{"children":[{"material":"glass","shape":"sphere"}]}},"ambient":0.2}"##;

fn expected() -> Scene {
    let mut scene = Scene::new("Whitted 1980");
    scene.camera = Camera { eye: vector(0.0, 2.0, 8.0), target: vector(0.0, 1.0, 0.0), ..Camera::default() };
    let top = Camera { eye: vector(0.0, 9.0, 0.0), up: vector(0.0, 0.0, -1.0), ..Camera::default() };
    scene.cameras = vec![("top".into(), top)];
    scene.ambient = Rgb::grey(0.2);
    scene.background = Rgb::from_srgb_hex(0x87ceeb);
    scene.lights =
        vec![Light { name: String::new(), position: vector(4.0, 6.0, 4.0), intensity: Rgb::grey(300.0) }];
    scene.settings = Settings {
        width: 800,
        height: 600,
        samples: 2,
        depth: 5,
        ao: AmbientOcclusion { samples: 64, distance: 1.0 },
        ..Settings::default()
    };
    let glass = scene.add_material(Material {
        ambient: Rgb::grey(0.1),
        diffuse: Rgb::grey(0.1),
        specular: Rgb::grey(0.5),
        shininess: 200.0,
        reflect: Rgb::grey(0.1),
        transmit: Rgb::grey(0.8),
        ..Material::named("glass")
    });
    let bulb = scene.insert(Node::shape("", Shape::Sphere).with_material(glass));
    let lamp = scene.insert(Node::group("", [bulb]));
    let transform = Transform::scale(vector(1.0, 2.0, 1.0))
        .then(Transform::rotate(vector(0.0, 1.0, 0.0), 30.0))
        .then(Transform::translate(vector(0.0, 1.0, 0.0)));
    scene.add(Node::shape("ball", Shape::Sphere).with_material(glass).with_transform(transform));
    let user = scene.insert(Node::group("", [lamp]));
    let grey = scene.add_material(Material {
        color: Rgb::from_srgb_hex(0x808080).into(),
        diffuse: Rgb::grey(0.9),
        ..Material::default()
    });
    let ground = scene.insert(Node::shape("", Shape::Plane).with_material(grey));
    scene.add(Node::group("group", [user, ground]));
    scene
}

#[test]
fn the_example_is_read_as_described_in_yaml_and_in_json() {
    assert_eq!(scene(EXAMPLE), expected());
    assert_eq!(scene(EXAMPLE_IN_JSON), expected());
    assert_eq!(warnings(EXAMPLE), [""; 0]);
}

#[test]
fn what_is_left_out_has_the_defaults_of_the_description() {
    let scene = scene("format: 1\nobjects: [{shape: cube, material: {}}]\n");
    assert_eq!(scene.materials(), [Material::default()]);
    assert_eq!(scene.settings, Settings::default());
    assert_eq!(scene.camera, Camera::default());
    assert_eq!(scene.background, Rgb::BLACK);
    assert_eq!((scene.name.as_str(), scene.lights.len(), scene.cameras.len()), ("", 0, 0));
}

#[test]
fn every_form_of_shape_transform_and_color_is_read() {
    let text = r##"
format: 1
ambient: 1
materials:
  a: {color: 0.5, ambient: [1, 2, 3], fresnel: true}
  b: {color: {image: wood.png}}
  c: {color: {checker: {even: "#fff", odd: 0}}}
  d: {color: {checker: {even: 1, odd: [0, 0, 0], size: 0.5}}}
objects:
  - {shape: cylinder, material: a}
  - {shape: {cylinder: {capped: false}}, material: b, transform: [{scale: 2}]}
  - {shape: {cylinder: {}}, material: c, transform: [{rotate: {axis: [0, 0, 1e-200], angle: 90}}]}
  - {shape: cube, material: d, children: [{shape: plane}], transform: [{matrix: [0,0,2,1, 0,1,0,2, 1,0,0,3, 0,0,0,1]}]}
"##;
    let mut shelf = Shelf::default();
    let scene = load_with(text.as_bytes(), &[], &mut shelf).unwrap().scene;
    let shapes =
        scene.roots().iter().map(|&root| scene.node(root).shape.clone().unwrap()).collect::<Vec<_>>();
    let cylinder = |capped| Shape::Cylinder { capped };
    assert_eq!(shapes, [cylinder(true), cylinder(false), cylinder(true), Shape::Cube]);

    let colors = scene.materials().iter().map(|material| material.color.clone()).collect::<Vec<_>>();
    let checker = |size| Texture::Checker { even: Rgb::WHITE, odd: Rgb::BLACK, size };
    assert_eq!(colors, [Texture::Solid(Rgb::grey(0.5)), Texture::from(wood()), checker(1.0), checker(0.5)]);
    assert_eq!(shelf.textures_read, 1);
    assert_eq!(scene.materials()[0].ambient, Rgb::new(1.0, 2.0, 3.0));
    assert!(scene.materials()[0].fresnel);

    let point = |root: usize| scene.node(scene.roots()[root]).transform.point(vector(1.0, 2.0, 3.0));
    assert_eq!(point(1), vector(2.0, 4.0, 6.0));
    assert_eq!(point(2), vector(-2.0, 1.0, 3.0));
    assert_eq!(point(3), vector(7.0, 4.0, 4.0));
}

#[test]
fn what_lies_beyond_an_image_is_read_for_both_axes_or_for_each() {
    let wrap_of = |image: &str| {
        let text = format!(
            "format: 1\nambient: 1\nobjects: [{{shape: cube, material: {{color: {{image: {image}}}}}}}]\n"
        );
        let scene = load_with(text.as_bytes(), &[], &mut Shelf::default()).unwrap().scene;
        let Texture::Image { wrap, .. } = scene.materials()[0].color else { panic!("{image}") };
        wrap
    };
    assert_eq!(wrap_of("wood.png"), [Wrap::Repeat; 2]);
    assert_eq!(wrap_of("{file: wood.png}"), [Wrap::Repeat; 2]);
    assert_eq!(wrap_of("{file: wood.png, wrap: clamp}"), [Wrap::Clamp; 2]);
    assert_eq!(wrap_of("{file: wood.png, wrap: [repeat, mirror]}"), [Wrap::Repeat, Wrap::Mirror]);
    let (error, _) = the_error(
        "format: 1\nobjects: [{shape: cube, material: {color: {image: {file: wood.png, wrap: [clamp, once]}}}}]\n",
    );
    assert_eq!(error, "2:82: wrap[1] is the text `once`, must be repeat, clamp or mirror");
}

#[test]
fn an_asset_is_one_node_however_often_it_is_used() {
    let text = "
format: 1
ambient: 1
assets:
  row: {children: [{use: brick}, {use: brick, transform: [{translate: [2, 0, 0]}]}]}
  brick: {name: brick, shape: cube}
objects:
  - {use: row}
  - {use: row, transform: [{translate: [0, 2, 0]}]}
";
    let scene = scene(text);
    let bricks = drawn(&scene);
    let places =
        bricks.iter().map(|(_, transform, _)| transform.translation().to_array()).collect::<Vec<_>>();
    assert_eq!(places, [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [2.0, 2.0, 0.0]]);
    assert_eq!(scene.nodes().iter().filter(|node| node.name == "brick").count(), 1);
}

#[test]
fn json_may_escape_what_lies_beyond_the_basic_plane() {
    let text =
        r#"{"format": 1, "name": "\ud83d\ude00 \u00e9\/\"", "ambient": 1, "objects": [{"shape": "cube"}]}"#;
    assert_eq!(scene(text).name, "\u{1f600} \u{e9}/\"");
}

#[test]
fn oddities_are_warned_of() {
    let text = "
format: 1
materials: {red: {}, green: {}}
assets: {lamp: {shape: sphere}, table: {use: lamp, material: red}}
objects: [{shape: cube}]
";
    assert_eq!(
        warnings(text),
        [
            "the material `green` is never used",
            "the asset `table` is never used",
            "there is no light: neither `lights` nor `ambient`",
        ]
    );
}

#[test]
fn a_chain_of_a_hundred_thousand_assets_is_no_recursion() {
    let links = (0..100_000).map(|i| format!("  a{i}: {{use: a{}}}\n", i + 1)).collect::<String>();
    let text = format!("format: 1\nassets:\n{links}  a100000: {{shape: cube}}\nobjects: [{{use: a0}}]\n");
    assert_eq!(scene(&text).nodes().len(), 100_002);
}
