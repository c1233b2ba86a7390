//! Files at fault: every one gives errors with places, and none a panic.

use crate::common::{errors, errors_of_bytes, load_bytes, the_error};
use proptest::prelude::*;

/// A sound file around a part at fault; the part's first line is line 3.
fn with(part: &str) -> String {
    format!("format: 1\nobjects: [{{shape: cube}}]\n{part}\n")
}

#[test]
fn an_unknown_key_is_told_with_what_was_meant() {
    let (error, hint) = the_error(&with("materials:\n  red:\n    shinyness: 3"));
    assert_eq!(error, "5:5: unknown key `shinyness`");
    assert_eq!(hint.unwrap(), "did you mean `shininess`?");
}

#[test]
fn a_wrong_type_is_told_with_what_is_legal() {
    for (part, expected) in [
        (
            "camera: {fov: wide}",
            "3:15: fov is the text `wide`, must be a number between 0 and 180, without the ends",
        ),
        ("camera: {fov: 180}", "3:15: fov is 180, must be a number between 0 and 180, without the ends"),
        ("camera: {eye: [1, 2]}", "3:15: eye is a list of 2, must be a list of length 3"),
        ("camera: {eye: [1, 2, 3, 4]}", "3:15: eye is a list of 4, must be a list of length 3"),
        ("camera: {eye: [1, x, 3]}", "3:19: eye[1] is the text `x`, must be a finite number"),
        ("camera: [1]", "3:9: camera is a list, must be a mapping"),
        ("camera:", "3:1: camera is empty, must be a mapping"),
        ("lights: {}", "3:9: lights is a mapping, must be a list"),
        (
            "lights: [{position: [0, 0, 0], intensity: -1}]",
            "3:43: intensity is -1, must be a number, 0 or above",
        ),
        ("lights: [{position: [0, 0, 0]}]", "3:10: `intensity` is missing"),
        ("ambient: red", "3:10: ambient is the text `red`, must be like \"#87ceeb\" or \"#fff\""),
        ("materials: {a: {ior: 0}}", "3:22: ior is 0, must be a number above 0"),
        ("materials: {a: {shininess: -0.5}}", "3:28: shininess is -0.5, must be a number, 0 or above"),
        ("materials: {a: {fresnel: 1}}", "3:26: fresnel is 1, must be true or false"),
        ("materials: {a: {metallic: 2}}", "3:27: metallic is 2, must be a number from 0 to 1"),
        (
            "materials: {a: {color: {checker: {even: 0, odd: 1, size: 0}}}}",
            "3:58: size is 0, must be a number above 0",
        ),
        ("render: {width: 0}", "3:17: width is 0, must be a whole number from 1 to 65535"),
        ("render: {samples: 1.5}", "3:19: samples is 1.5, must be a whole number from 1 to 64"),
        ("render: {ao: {distance: .inf}}", "3:25: distance is .inf, must be a finite number"),
    ] {
        assert_eq!(the_error(&with(part)).0, expected, "{part}");
    }
    assert!(the_error(&with("background: #fff")).0.contains("background is empty, must be a number"));
    let (error, hint) = the_error(&with("name: 1980"));
    assert_eq!(error, "3:7: name is 1980, must be text");
    assert_eq!(hint.unwrap(), "write it in quotes: \"1980\"");
}

#[test]
fn an_object_at_fault_is_told_with_what_is_legal() {
    let of = |object: &str| the_error(&format!("format: 1\nobjects:\n- {object}\n"));
    for (object, expected) in [
        ("{}", "3:3: this object draws nothing, must have `shape`, `use` or `children`"),
        ("{name: a}", "3:3: `a` draws nothing, must have `shape`, `use` or `children`"),
        ("{shape: spere}", "3:11: shape is `spere`, which is not known"),
        ("{shape: {torus: 1}}", "3:12: shape is `torus`, which is not known"),
        (
            "{shape: {mesh: a, cylinder: {}}}",
            "3:11: shape is a mapping of 2, must be a mapping of one key out of `mesh`, `cylinder`",
        ),
        ("{use: lamp}", "3:9: unknown asset `lamp`"),
        ("{shape: cube, material: red}", "3:27: unknown material `red`"),
        (
            "{shape: cube, transform: [{rotate: {axis: w, angle: 1}}]}",
            "3:45: axis is the text `w`, must be x, y, z or a list of three numbers",
        ),
        (
            "{shape: cube, transform: [{rotate: {axis: [0, 0, 0], angle: 1}}]}",
            "3:45: axis is [0, 0, 0], must be x, y, z or a direction other than [0, 0, 0]",
        ),
        ("{shape: cube, transform: [{turn: 1}]}", "3:30: transform[0] is `turn`, which is not known"),
        (
            "{shape: cube, transform: [scale]}",
            "3:29: transform[0] is the text `scale`, must be a mapping of one key out of `scale`, `rotate`, `translate`, `matrix`",
        ),
    ] {
        assert_eq!(of(object).0, expected, "{object}");
    }
    assert_eq!(of("{shape: spere}").1.unwrap(), "did you mean `sphere`?");
}

#[test]
fn all_errors_come_at_once_in_the_order_of_their_places() {
    let text = "
format: 2
name: [x]
camera: {eye: [0, 0, .nan], fov: 200, roll: 1}
lights:
  - {position: [x, 0, y], intensity: 3}
  - {intensity: none}
materials:
  red: {colour: 1, ior: -1}
  red: {}
objects:
  - {shape: spheer, material: reed}
  - {use: chair, transform: [{scale: 0}, {scale: [1]}]}
  - {children: [{shape: {mesh: gone.obj}}]}
";
    assert_eq!(
        errors(text),
        [
            "2:9: format is 2, must be 1",
            "3:7: name is a list, must be text",
            "4:22: eye[2] is .nan, must be a finite number",
            "4:34: fov is 200, must be a number between 0 and 180, without the ends",
            "4:39: unknown key `roll`",
            "6:17: position[0] is the text `x`, must be a finite number",
            "6:23: position[1] is the text `y`, must be a finite number",
            "7:5: `position` is missing",
            "7:17: intensity is the text `none`, must be a number or a list of three",
            "9:9: unknown key `colour`",
            "9:25: ior is -1, must be a number above 0",
            "10:3: the key `red` is repeated",
            "12:13: shape is `spheer`, which is not known",
            "12:31: unknown material `reed`",
            "13:11: unknown asset `chair`",
            "13:30: the transform of this object is singular: it flattens the object, or overflows",
            "13:50: scale is a list of 1, must be a list of length 3",
            "14:32: cannot open `gone.obj`: no such file or directory",
        ]
    );
}

#[test]
fn what_only_follows_from_another_error_is_not_told() {
    for part in [
        "lights: [{position: [0, x, 0], intensity: 1}]",
        "lights: [{positoin: [0, 0, 0], intensity: 1}]",
        "camera: {eye: [x, 0, 0], target: [0, 0, 5]}",
        "assets: {a: {shape: spheer}, b: {use: a, material: {ior: 1}}}",
        "materials: {a: 5}\nassets: {b: {shape: cube, material: a}}",
        "matrials: {a: {}}\nassets: {b: {shape: cube, material: a}}",
    ] {
        let found = errors(&with(part));
        assert_eq!(found.len(), 1, "{part}: {found:#?}");
    }
}

#[test]
fn no_more_errors_are_told_than_the_limit() {
    let wrong = "- {shape: no}\n".repeat(1000);
    let error = load_bytes(format!("format: 1\nobjects:\n{wrong}").as_bytes(), &[]).unwrap_err();
    assert_eq!(error.diagnostics.len(), 51);
    assert_eq!(error.diagnostics[50].message, "there may be more errors");
}

#[test]
fn the_format_must_be_named() {
    let (error, hint) = the_error("objects: [{shape: cube}]\n");
    assert_eq!(error, "1:1: `format` is missing");
    assert_eq!(hint.unwrap(), "write `format: 1` at the top of the file");
    assert_eq!(the_error("format: x\nobjects: [{shape: cube}]").0, "1:9: format is the text `x`, must be 1");
}

#[test]
fn a_repeated_key_is_an_error() {
    let (error, hint) = the_error(&with("name: a\nname: b"));
    assert_eq!(error, "4:1: the key `name` is repeated");
    assert_eq!(hint.unwrap(), "it stands first on line 3");
}

#[test]
fn a_cycle_of_assets_is_named() {
    let (error, _) = the_error(&with("assets:\n  a: {use: b}\n  b: {children: [{use: c}]}\n  c: {use: a}"));
    assert_eq!(error, "6:12: an asset cannot hold itself: `a` uses `b` uses `c` uses `a`");
    let (error, _) = the_error(&with("assets:\n  a: {use: a}"));
    assert_eq!(error, "4:12: an asset cannot hold itself: `a` uses `a`");
}

#[test]
fn a_singular_transform_names_the_object_and_stands_at_the_step() {
    let text = "format: 1\nobjects:\n- name: flat\n  shape: cube\n  transform:\n  - translate: [1, 0, 0]\n  - scale: [1, 0, 1]\n";
    let (error, _) = the_error(text);
    assert_eq!(error, "7:5: the transform of `flat` is singular: it flattens the object, or overflows");
    let matrix = "{matrix: [1,1,0,0, 1,1,0,0, 0,0,1,0, 0,0,0,1]}";
    let (error, _) = the_error(&format!("format: 1\nobjects: [{{shape: cube, transform: [{matrix}]}}]\n"));
    assert!(
        error.ends_with("the transform of this object is singular: it flattens the object, or overflows")
    );
    let (error, _) = the_error(
        "format: 1\nobjects: [{shape: cube, transform: [{matrix: [1,0,0,0, 0,1,0,0, 0,0,1,0, 5,0,0,1]}]}]\n",
    );
    assert!(error.contains("the last four numbers of the matrix must be 0, 0, 0, 1"), "{error}");
}

#[test]
fn cameras_and_images_that_make_no_picture_are_refused() {
    let (error, _) = the_error(&with("camera: {eye: [0, 0, 5], target: [0, 0, 5]}"));
    assert_eq!(error, "3:9: the camera's eye and target are the same point, so it looks nowhere");
    let (error, _) = the_error(&with("render: {width: 32000, height: 32000}"));
    assert_eq!(error, "3:9: 32000 x 32000 is more than 268435456 pixels");
    let (error, _) = the_error(&with("render: {width: 1000000000}"));
    assert_eq!(error, "3:17: width is 1000000000, must be a whole number from 1 to 65535");
}

#[test]
fn nothing_to_draw_is_an_error() {
    assert_eq!(the_error("format: 1\n").0, "1:1: there is nothing to draw");
    assert_eq!(the_error("format: 1\nobjects: []\n").0, "2:10: there is nothing to draw");
    assert_eq!(the_error("format: 1\nobjects: [{children: []}]\n").0, "2:10: there is nothing to draw");
}

#[test]
fn what_is_no_scene_at_all_is_told_as_such() {
    assert_eq!(the_error("").0, "1:1: the file is empty");
    assert_eq!(the_error("# nothing\n").0, "1:1: the file is empty");
    assert_eq!(the_error("hello").0, "1:1: the file is the text `hello`, must be a mapping");
    assert_eq!(the_error("[1, 2]").0, "1:1: the file is a list, must be a mapping");
    assert_eq!(the_error("a: 1\n---\nb: 2\n").0, "2:1: a second document begins here, must be one");
    assert_eq!(errors_of_bytes(b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR"), ["1:1: the byte 0x89 is not UTF-8 text"]);
    assert_eq!(errors_of_bytes(b"format: 1\nname: \xe9\n"), ["2:7: the byte 0xe9 is not UTF-8 text"]);
    assert_eq!(errors("format: 1\nname: \"a\0b\"\n").len(), 1);
    assert_eq!(errors("format: 1\nname: \"open\n").len(), 1);
    assert_eq!(the_error("a:\n\t- 1\n").1.unwrap(), "indent with spaces");
}

#[test]
fn files_made_to_hurt_are_refused() {
    let bomb = (1..40).map(|i| format!("a{i}: &a{i} [*a{0}, *a{0}]\n", i - 1)).collect::<String>();
    let many_errors =
        format!("format: 1\nlights:\n{}", "- {position: [0, 0, x], intensity: 1}\n".repeat(50_000));
    let many_repeats = format!("format: 1\n{}", "name: a\n".repeat(100_000));
    let many_names = (0..20_000).map(|i| format!("  material{i}: {{}}\n")).collect::<String>();
    let many_unknown =
        (0..20_000).map(|i| format!("- {{shape: cube, material: metarial{i}}}\n")).collect::<String>();
    for text in [
        format!("format: 1\nmaterials:\n{many_names}objects:\n{many_unknown}"),
        format!("a0: &a0 1\n{bomb}"),
        "[".repeat(100_000),
        "{a: ".repeat(100_000),
        "- ".repeat(100_000),
        "x".repeat(10_000_000),
        format!("format: 1\nobjects: [{}{{shape: no}}]", "{shape: cube}, ".repeat(50_000)),
        many_errors,
        many_repeats,
    ] {
        let found = load_bytes(text.as_bytes(), &[]).unwrap_err();
        assert!(found.diagnostics.len() <= 51);
        assert!(found.diagnostics[0].location.is_some());
        assert!(found.to_string().len() < 30_000);
    }
}

#[test]
fn warnings_are_bounded_too() {
    let unused = (0..50_000).map(|i| format!("  m{i}: {{}}\n")).collect::<String>();
    let text = format!("format: 1\nambient: 1\nobjects: [{{shape: cube}}]\nmaterials:\n{unused}");
    let warnings = load_bytes(text.as_bytes(), &[]).unwrap().warnings;
    assert_eq!(warnings.len(), 51);
    assert_eq!(warnings[50].message, "49950 more warnings are not shown");
}

#[test]
fn nesting_up_to_the_limit_is_read() {
    // The file and `objects` are two levels, each object with children two, and the cube is one: 199.
    let levels = 98;
    let text = format!(
        "format: 1\nambient: 1\nobjects: [{}{{shape: cube}}{}]\n",
        "{children: [".repeat(levels),
        "]}".repeat(levels)
    );
    assert!(load_bytes(text.as_bytes(), &[]).is_ok());
}

/// Pieces that reach far into the reader.
fn piece() -> impl Strategy<Value = String> {
    let words = [
        "format: 1\n",
        "objects:\n",
        "- ",
        "  ",
        "shape: ",
        "cube\n",
        "material: ",
        "transform: ",
        "scale: ",
        "matrix",
        "rotate: {axis: x, angle: 1}",
        "[",
        "]",
        "{",
        "}",
        ", ",
        ": ",
        "\n",
        "\t",
        "&a ",
        "*a",
        "!!str ",
        "!x",
        "\"",
        "'",
        "|\n",
        ">-\n",
        "? ",
        "---\n",
        "...\n",
        "#",
        "%YAML 1.2\n",
        "use: ",
        "assets:\n",
        "children:\n",
        "1e999",
        ".nan",
        "-0",
        "0x",
        "\u{feff}",
        "\r",
        "\\ud83d\\ude00",
        "é",
        "\0",
        "null",
        "~",
        "lights:\n",
        "camera: ",
        "render: ",
    ];
    proptest::sample::select(words.map(str::to_owned).to_vec())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn arbitrary_bytes_never_panic(bytes in proptest::collection::vec(any::<u8>(), 0..200)) {
        let _ = load_bytes(&bytes, &[]);
    }

    #[test]
    fn arbitrary_pieces_never_panic_and_every_error_tells_something(
        pieces in proptest::collection::vec(piece(), 0..60)
    ) {
        if let Err(error) = load_bytes(pieces.concat().as_bytes(), &[]) {
            prop_assert!(!error.diagnostics.is_empty());
            prop_assert!(!error.to_string().is_empty());
        }
    }

    #[test]
    fn a_sound_file_with_a_byte_changed_never_panics(at in 0..crate::whole::EXAMPLE.len(), byte in any::<u8>()) {
        let mut bytes = crate::whole::EXAMPLE.as_bytes().to_vec();
        bytes[at] = byte;
        let _ = load_bytes(&bytes, &[]);
    }
}
