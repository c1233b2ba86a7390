//! Overrides written into the text of a file.

use crate::common::load_bytes;
use crate::whole::{EXAMPLE, EXAMPLE_IN_JSON};
use lancer_io::diagnostics::LoadError;
use lancer_io::scene_file::{Override, patch};
use proptest::prelude::*;
use std::path::Path;

fn try_patch(text: &str, edits: &[&str]) -> Result<String, LoadError> {
    let edits = edits.iter().map(|edit| edit.parse().unwrap()).collect::<Vec<Override>>();
    patch(Path::new("dir/scene.yaml"), text, &edits)
}

/// The patched text of a file, after checking that it reads as the file does with the overrides.
fn patched(text: &str, edits: &[&str]) -> String {
    let patched = try_patch(text, edits).unwrap_or_else(|error| panic!("{error}"));
    let scene = |bytes: &[u8], edits: &[&str]| {
        load_bytes(bytes, edits).unwrap_or_else(|error| panic!("{error}\n{patched}")).scene
    };
    assert_eq!(scene(patched.as_bytes(), &[]), scene(text.as_bytes(), edits), "{patched}");
    patched
}

/// Checks that the overrides change `text` where `old` stands, into `new`, and nowhere else.
#[track_caller]
fn changes_only(text: &str, edits: &[&str], replaced: &[(&str, &str)]) {
    let mut expected = text.to_owned();
    for (old, new) in replaced {
        assert_eq!(expected.matches(old).count(), 1, "`{old}` in\n{expected}");
        expected = expected.replacen(old, new, 1);
    }
    assert_eq!(patched(text, edits), expected);
}

const BLOCK: &str = "\
# A scene of my own.
format: 1
name: 'Quoted'   # a name

camera:
  # where I stand
  eye: [0, 2, 8]   # metres
  target:
    - 0
    - 1
    - 0
  fov: 40
ambient: 0.2
lights:
- position: [4, 6, 4]
  intensity: 300    # bright
- {name: lamp, position: [0, 9, 0], intensity: [1, 2, 3]}
materials:
    red glass: {color: '#f00', ior: 1.5}
    wood:
        color:   \"#840\"

        diffuse: .5     # dull
objects:
  - name: ball
    shape: sphere
    material: red glass
    transform:
      - scale: 2
      - translate: [0, 1, 0]
  -   shape: plane
      material: wood
# The end.
";

#[test]
fn a_value_is_replaced_and_all_else_stays() {
    changes_only(BLOCK, &["camera.fov=30"], &[("fov: 40", "fov: 30")]);
    changes_only(BLOCK, &["camera.eye=[1, 2.5, 8]"], &[("[0, 2, 8]   # metres", "[1, 2.5, 8]   # metres")]);
    changes_only(BLOCK, &["camera.target=[0, 2, 1e-7]"], &[("- 1\n    - 0", "- 2\n    - 1e-7")]);
    changes_only(BLOCK, &["name='it''s #1'"], &[("'Quoted'   #", "\"it's #1\"   #")]);
    changes_only(BLOCK, &["materials.wood.color=[1, 0, 0]"], &[("\"#840\"", "[1, 0, 0]")]);
    changes_only(BLOCK, &["materials.wood.diffuse=0.25"], &[(".5     # dull", "0.25     # dull")]);
}

#[test]
fn what_says_the_same_already_stays_as_it_is_written() {
    changes_only(BLOCK, &["materials.wood.diffuse=0.5", "camera.fov=4e1", "name=Quoted"], &[]);
}

#[test]
fn keys_are_added_in_the_style_of_their_neighbours() {
    changes_only(BLOCK, &["camera.up=[0, 0, 1]"], &[("fov: 40\n", "fov: 40\n  up: [0, 0, 1]\n")]);
    changes_only(BLOCK, &["lights.0.name=sun"], &[("300    # bright\n", "300    # bright\n  name: sun\n")]);
    changes_only(BLOCK, &["materials.red glass.reflect=0.5"], &[("ior: 1.5}", "ior: 1.5, reflect: 0.5}")]);
    changes_only(BLOCK, &["materials.wood.ior=2"], &[("# dull\n", "# dull\n        ior: 2\n")]);
    changes_only(
        BLOCK,
        &["objects.1.hidden=true"],
        &[("      material: wood\n", "      material: wood\n      hidden: true\n")],
    );
    changes_only(
        BLOCK,
        &["render.width=5", "render.ao.samples=3"],
        &[("material: wood\n", "material: wood\nrender: {width: 5, ao: {samples: 3}}\n")],
    );
}

#[test]
fn keys_are_added_to_what_is_empty_and_at_the_end_of_a_file() {
    let text = "format: 1\nambient: 1\nmaterials: {}\nobjects: [{shape: cube}]";
    changes_only(text, &["materials.a.ior=2"], &[("{}", "{a: {ior: 2}}")]);
    changes_only(text, &["name=x"], &[("cube}]", "cube}]\nname: x")]);
    let empty = "format: 1\nambient: 1\nobjects:\n- material: # none\n  transform:\n  shape: cube\n";
    changes_only(empty, &["objects.0.material={ior: 2}"], &[("material:", "material: {ior: 2}")]);
    changes_only(empty, &["objects.0.transform=[{scale: 2}]"], &[("transform:", "transform: [{scale: 2}]")]);
    changes_only(text, &["objects.0.hidden=true", "name=x"], &[("cube}]", "cube, hidden: true}]\nname: x")]);
}

#[test]
fn lists_grow_in_their_own_style() {
    let light = "{position: [1, 1, 1], intensity: 5}";
    let edit = format!(
        "lights=[{{position: [4, 6, 4], intensity: 300}}, {{name: lamp, position: [0, 9, 0], intensity: [1, 2, 3]}}, {light}]"
    );
    let lamp = "intensity: [1, 2, 3]}\n";
    changes_only(BLOCK, &[&edit], &[(lamp, &format!("{lamp}- {light}\n"))]);
    let flow = "format: 1\nlights: [{position: [0, 0, 0], intensity: 1}]\nobjects: [{shape: cube}]\n";
    let edit = format!("lights=[{{position: [0, 0, 0], intensity: 1}}, {light}]");
    changes_only(flow, &[&edit], &[("intensity: 1}", &format!("intensity: 1}}, {light}"))]);
}

#[test]
fn a_block_that_becomes_something_else_leaves_no_line_behind() {
    changes_only(
        BLOCK,
        &["camera={eye: [1, 2, 3]}"],
        &[(
            "camera:\n  # where I stand\n  eye: [0, 2, 8]   # metres\n  target:\n    - 0\n    - 1\n    - 0\n  fov: 40\n",
            "camera: {eye: [1, 2, 3]}\n  # where I stand\n",
        )],
    );
    changes_only(
        BLOCK,
        &["objects.0.transform=[{scale: 3}]"],
        &[("transform:\n      - scale: 2\n      - translate: [0, 1, 0]\n", "transform: [{scale: 3}]\n")],
    );
    changes_only(
        BLOCK,
        &["lights=[]"],
        &[(
            "lights:\n- position: [4, 6, 4]\n  intensity: 300    # bright\n- {name: lamp, position: [0, 9, 0], intensity: [1, 2, 3]}\n",
            "lights: []\n",
        )],
    );
}

#[test]
fn an_alias_of_what_changes_is_written_out() {
    let text = "\
format: 1
ambient: &dim 0.2
background: *dim
materials:
  a: &a {diffuse: &half 0.5, reflect: *half}
  b: *a
objects: [{shape: cube, material: a}, {shape: cube, material: b}]
";
    changes_only(text, &["ambient=0.3"], &[("&dim 0.2", "0.3"), ("*dim", "0.2")]);
    changes_only(text, &["background=0.3"], &[("*dim", "0.3")]);
    changes_only(text, &["materials.b.reflect=1"], &[("*a", "{diffuse: 0.5, reflect: 1}")]);
    changes_only(text, &["materials.a.reflect=1"], &[("*half", "1"), ("*a", "{diffuse: 0.5, reflect: 0.5}")]);
    changes_only(
        text,
        &["materials.a.diffuse=1"],
        &[("&half 0.5", "1"), ("*half", "0.5"), ("*a", "{diffuse: 0.5, reflect: 0.5}")],
    );
}

#[test]
fn json_stays_json() {
    let is_json = |text: &str| serde_json::from_str::<serde_json::Value>(text).is_ok();
    let edits =
        ["camera.fov=30.5", "name=new \"name\"", "render.exposure=-1", "materials.glass.color=#102030"];
    assert!(is_json(&patched(EXAMPLE_IN_JSON, &edits)));

    let pretty = "{\n\t\"format\": 1,\n\t\"name\": \"\\ud83d\\ude00\",\n\t\"ambient\": 0.5,\n\t\"objects\": [\n\t\t{\"shape\": \"cube\"}\n\t]\n}\n";
    changes_only(
        pretty,
        &["ambient=1", "render.width=5", "objects.0.hidden=true"],
        &[
            ("0.5", "1"),
            ("\"cube\"}", "\"cube\", \"hidden\": true}"),
            ("\t]\n}", "\t],\n\t\"render\": {\"width\": 5}\n}"),
        ],
    );
}

#[test]
fn flow_over_several_lines_keeps_its_commas_and_comments() {
    let text = "\
format: 1
ambient: 1
camera: {
  eye: [0, 0, 5], # here
  fov: 40 # wide
}
cameras: {a: {fov: 1},
          b: {fov: 2,}, }
objects: [
  {shape: cube},
  # and
  {shape: plane}, # below
]
";
    changes_only(text, &["camera.up=[0, 1, 0]"], &[("40 # wide", "40, # wide\n  up: [0, 1, 0]")]);
    changes_only(text, &["cameras.b.eye=[1, 2, 3]"], &[("{fov: 2,}", "{fov: 2, eye: [1, 2, 3]}")]);
    changes_only(text, &["cameras.c={}"], &[("2,}, }", "2,}, c: {} }")]);
}

#[test]
fn line_ends_and_marks_of_byte_order_stay() {
    let text = format!("\u{feff}{}", BLOCK.replace('\n', "\r\n").replace("A scene", "Une scène"));
    changes_only(&text, &["camera.fov=30"], &[("fov: 40", "fov: 30")]);
    changes_only(&text, &["camera.up=[0, 0, 1]"], &[("fov: 40\r\n", "fov: 40\r\n  up: [0, 0, 1]\r\n")]);
}

#[test]
fn text_in_blocks_gives_way_to_one_line() {
    let text = "format: 1\nname: |\n  a\n  b\n\nambient: >-\n  0.5\nobjects: [{shape: cube}]\n";
    assert!(try_patch(text, &[]).is_err(), "ambient is text there");
    let text = text.replace(">-\n  0.5", "1");
    changes_only(&text, &["name=c"], &[("|\n  a\n  b", "c")]);
    changes_only(&text, &["ambient=2"], &[("ambient: 1", "ambient: 2")]);
}

#[test]
fn what_is_wrong_is_told_and_nothing_is_given_out() {
    let message = |edits: &[&str]| try_patch(BLOCK, edits).unwrap_err().to_string();
    assert!(message(&["camera.fov=180"]).starts_with("--set camera.fov=180: "));
    assert!(message(&["lights.7.intensity=1"]).contains("no `7`"));
    assert!(message(&["camera.fow=1"]).contains("did you mean `fov`?"));
    assert!(try_patch("format: 1\nobjects: [", &[]).unwrap_err().to_string().contains("dir/scene.yaml:"));
    let keeps_blank_lines = "format: 1\nambient: 1\nobjects: [{shape: cube}]\nname: |+\n  x\n\n\n";
    let error = try_patch(keeps_blank_lines, &["ambient=2", "background=1"]).unwrap_err();
    assert!(error.diagnostics[0].hint.as_ref().unwrap().contains("by hand"), "{error}");
}

/// Files in many styles, all with the names that the overrides below speak of.
const FILES: [&str; 6] = [
    EXAMPLE,
    EXAMPLE_IN_JSON,
    "format: 1\nambient: &a 0.2\nbackground: *a\nlights: [{position: [0, 0, 0], intensity: *a}]\nmaterials: {glass: {}}\nobjects: [{shape: cube, material: glass}]\nassets: {lamp: {shape: cube}}",
    "{format: 1, lights: [{position: [1, 2, 3], intensity: 5,},], materials: {glass: {ior: 1}}, objects: [{shape: cube, material}], render: {}}",
    "%YAML 1.2\n---\nformat: 1\nlights:\n- position:\n  - 1\n  - 2\n  - 3\n  intensity: 1 # é\nmaterials:\n  glass: &g\n    ior: 1\n  other: *g\nobjects:\n- shape: cube\n  children: &c\n  - shape: sphere\n- shape: plane\n  children: *c\n  material:\n...\n",
    "format: 1\r\nlights:\r\n  -\r\n    position: [0, 0, 1]\r\n    intensity: 2\r\nmaterials: !!map\r\n  glass: !!map {ior: !!float 1}\r\nobjects: &all\r\n  - !!map\r\n    shape: cube\r\nrender: &r {width: 4}\r\n",
];

const OVERRIDES: [&str; 22] = [
    "name=plain words",
    "name='it''s: #1'",
    "ambient=0.25",
    "ambient=[1, 2, 3]",
    "background=#102030",
    "camera.fov=12.5",
    "camera={eye: [1, 2, 3], target: [0, 0, 0]}",
    "cameras.side.eye=[3, 0, 0]",
    "lights.0.intensity=1e-7",
    "lights.0.position=[-1, 0.1, 2]",
    "lights=[]",
    "lights=[{position: [1, 2, 3], intensity: 1}, {position: [1, 2, 3], intensity: 2}]",
    "materials.glass.ior=2.5",
    "materials.glass.color={checker: {even: 0, odd: 1}}",
    "materials.glass={reflect: 1}",
    "materials.a new one={}",
    "objects.0.hidden=true",
    "objects.0.transform=[{scale: 3}, {translate: [1, 2, 3]}]",
    "objects.0.name=first",
    "objects.0.material=~",
    "render.exposure=-0.5",
    "render.ao.samples=7",
];

proptest! {
    #[test]
    fn a_patched_text_reads_as_the_text_with_the_overrides(
        file in 0..FILES.len(),
        edits in prop::collection::vec(0..OVERRIDES.len(), 0..6),
    ) {
        let edits = edits.into_iter().map(|index| OVERRIDES[index]).collect::<Vec<_>>();
        // A list may have become too short for the next override.
        prop_assume!(load_bytes(FILES[file].as_bytes(), &edits).is_ok());
        patched(FILES[file], &edits);
    }
}

#[test]
fn each_override_finds_its_place_in_each_file() {
    for file in FILES {
        for edit in OVERRIDES {
            patched(file, &[edit]);
        }
    }
}
