//! Where pictures go, and in which format.

use crate::sandbox::{Sandbox, read_exr, read_png, text};
use lancer_io::image::decode_picture;

#[test]
fn without_a_name_the_picture_is_named_after_the_scene() {
    let sandbox = Sandbox::new();
    let small = "--width 8 --height 6 --samples 1 --ao 0";
    sandbox.ok(&format!("render scene.yaml {small}"));
    sandbox.ok(&format!("render {small}"));
    sandbox.ok(&format!("render model.obj {small}"));
    assert_eq!(sandbox.new_files(), ["model.png", "scene.png", "whitted.png"]);
}

#[test]
fn a_scene_elsewhere_leaves_its_picture_here() {
    let sandbox = Sandbox::new();
    std::fs::create_dir(sandbox.path("here")).unwrap();
    sandbox.lancer(["render", "../scene.yaml"]).current_dir(sandbox.path("here")).assert().success();
    assert!(sandbox.path("here/scene.png").exists());
    assert_eq!(sandbox.new_files(), ["here"]);
}

#[test]
fn the_extension_says_the_format() {
    let sandbox = Sandbox::new();
    for name in ["a.png", "b.PNG"] {
        sandbox.ok(&format!("render scene.yaml -o {name}"));
        assert_eq!(read_png(&sandbox.path(name)).width, 24);
    }
    for name in ["a.exr", "b.Exr"] {
        sandbox.ok(&format!("render scene.yaml --output {name}"));
        assert_eq!(read_exr(&sandbox.path(name)).width, 24);
    }
}

#[test]
fn png_is_the_srgb_encoding_of_exr() {
    let sandbox = Sandbox::new();
    let (linear, encoded) = (sandbox.exr(""), sandbox.png(""));
    let encode = |channel: f32| {
        let x = f64::from(channel).clamp(0.0, 1.0);
        let curved = if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * libm::pow(x, 1.0 / 2.4) - 0.055 };
        (curved * 255.0).round() as i32
    };
    for (linear, encoded) in linear.pixels.iter().flatten().zip(encoded.pixels.iter().flatten()) {
        assert!((encode(*linear) - i32::from(*encoded)).abs() <= 1, "{linear} is not {encoded}");
    }
}

#[test]
fn a_hyphen_is_a_png_on_standard_output() {
    let sandbox = Sandbox::new();
    sandbox.png("");
    let run = sandbox.ok("render scene.yaml -o -");
    assert_eq!(run.stdout, sandbox.read("picture.png"));
    assert!(text(&run.stderr).contains("standard output"));
    assert_eq!(sandbox.new_files(), ["picture.png"]);
}

#[test]
fn every_format_shows_the_same_picture() {
    let sandbox = Sandbox::new();
    let (codes, radiance) = (sandbox.png(""), sandbox.exr(""));
    let read = |name: &str| decode_picture(name.as_ref(), &sandbox.read(name), 1 << 20).unwrap();
    for (name, flags, most) in [
        ("a.png", "--bits 16", 0.5 / 255.0),
        ("a.webp", "", 0.0),
        ("a.tif", "", 0.0),
        ("a.tiff", "--bits 16 --compression none", 0.5 / 255.0),
        ("a.jpg", "--quality 100", 8.0 / 255.0),
        ("a.anything", "--format webp", 0.0),
    ] {
        sandbox.ok(&format!("render scene.yaml -o {name} {flags}"));
        let picture = read(name);
        assert!(!picture.is_linear);
        for (found, expected) in picture.values.pixels().iter().flatten().zip(codes.pixels.iter().flatten()) {
            assert!((found - f32::from(*expected) / 255.0).abs() <= most + 1e-6, "{name}: {found}");
        }
    }
    for (name, flags, most) in [
        ("b.exr", "--compression piz", 0.0),
        ("b.exr", "--bits 16", 1.0 / 2048.0),
        ("b.tif", "--bits 32", 0.0),
        ("b.pfm", "", 0.0),
        ("b.hdr", "", 1.0 / 256.0),
    ] {
        sandbox.ok(&format!("render scene.yaml -o {name} {flags}"));
        let picture = read(name);
        assert!(picture.is_linear);
        for (found, expected) in picture.values.pixels().iter().zip(&radiance.pixels) {
            let greatest = expected.iter().copied().fold(0.0, f32::max);
            for (found, expected) in found.iter().zip(expected) {
                assert!((found - expected).abs() <= most * greatest, "{name}: {found} is not {expected}");
            }
        }
    }
}

#[test]
fn tone_is_for_displays_and_leaves_radiance_alone() {
    let sandbox = Sandbox::new();
    let (plain, radiance) = (sandbox.png(""), sandbox.exr(""));
    let mut seen = vec![plain];
    for curve in ["reinhard", "filmic", "raw"] {
        let picture = sandbox.png(&format!("--tone {curve}"));
        assert!(!seen.contains(&picture), "{curve}");
        assert_eq!(picture, sandbox.png(&format!("--set render.tone={curve}")), "{curve}");
        assert_eq!(sandbox.exr(&format!("--tone {curve}")), radiance, "{curve}");
        seen.push(picture);
    }
    assert_eq!(sandbox.png("--set render.tone=raw --tone linear"), seen[0]);
    for (raw, linear) in seen[3].pixels.iter().flatten().zip(radiance.pixels.iter().flatten()) {
        assert_eq!(f32::from(*raw), (linear.clamp(0.0, 1.0) * 255.0).round());
    }
}

#[test]
fn standard_output_takes_every_format() {
    let sandbox = Sandbox::new();
    for format in ["png", "jpeg", "webp", "tiff", "hdr", "pfm", "exr"] {
        sandbox.ok(&format!("render scene.yaml -o picture.{format}"));
        let run = sandbox.ok(&format!("render scene.yaml -o - --format {format}"));
        assert!(run.stdout == sandbox.read(&format!("picture.{format}")), "{format}");
    }
}

#[test]
fn what_a_format_has_not_is_wrong_usage_before_anything_is_rendered() {
    let sandbox = Sandbox::new();
    for (flags, reason) in [
        ("-o a.jpg --bits 16", "JPEG has 8 bits a channel, not 16"),
        ("-o a.exr --bits 8", "32 or 16"),
        ("-o a.png --quality 90", "PNG has no quality"),
        ("-o a.jpg --quality 0", "must be 1 to 100"),
        ("-o a.tif --compression piz", "choose zip or none"),
        ("-o a.hdr --compression zip", "nothing to choose"),
        ("-o a.webp --width 16385 --height 1", "16384 pixels a side"),
        ("-o a.gif", ".png, .jpg"),
        ("--format exr", "--output"),
        ("-o a.png --dpi 0", "--dpi"),
        ("-o a.png --tone purple", "reinhard"),
    ] {
        let told = sandbox.fails(2, &format!("render scene.yaml {flags}"));
        assert!(told.contains(reason), "{flags}: {told}");
    }
    assert_eq!(sandbox.new_files(), [""; 0]);
}

#[test]
fn an_old_picture_is_replaced() {
    let sandbox = Sandbox::new();
    sandbox.write("picture.png", vec![7; 1 << 20]);
    assert_eq!(sandbox.png("").width, 24);
    assert_eq!(sandbox.new_files(), ["picture.png"]);
}

#[test]
fn only_pictures_by_lancer_are_replaced_unasked() {
    let sandbox = Sandbox::new();
    sandbox.write("scene.png", "a texture, say");
    assert!(sandbox.fails(4, "render scene.yaml").contains("--output"));
    assert_eq!(sandbox.read("scene.png"), b"a texture, say");
    sandbox.ok("render scene.yaml --output scene.png");
    sandbox.ok("render scene.yaml --width 9");
    assert_eq!(read_png(&sandbox.path("scene.png")).width, 9);
}

#[cfg(unix)]
#[test]
fn a_symbolic_link_goes_on_pointing_at_the_picture() {
    let sandbox = Sandbox::new();
    std::fs::create_dir(sandbox.path("pictures")).unwrap();
    std::os::unix::fs::symlink("pictures/real.png", sandbox.path("link.png")).unwrap();
    sandbox.ok("render scene.yaml -o link.png");
    assert!(sandbox.path("link.png").is_symlink());
    assert_eq!(read_png(&sandbox.path("pictures/real.png")).width, 24);
}

#[cfg(unix)]
#[test]
fn names_need_not_be_unicode() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let sandbox = Sandbox::new();
    let odd = |extension: &str| {
        let mut name = vec![b'a', 0xff];
        name.extend_from_slice(extension.as_bytes());
        OsStr::from_bytes(&name).to_owned()
    };
    std::fs::copy(sandbox.path("scene.yaml"), sandbox.path("").join(odd(".yaml"))).unwrap();
    sandbox.lancer([OsStr::new("render"), &odd(".yaml")]).arg("--json").assert().success();
    assert!(sandbox.path("").join(odd(".png")).exists());
}
