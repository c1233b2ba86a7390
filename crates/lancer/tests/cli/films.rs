//! Pictures that move, and small ones.

use crate::sandbox::{Sandbox, read_png, text};
use image::AnimationDecoder;
use std::io::{Cursor, Read};

const SMALL: &str = "--width 12 --height 8 --samples 1 --ao 0";

/// The scene's cameras are its own and `top`.
fn turn(sandbox: &Sandbox, flags: &str) {
    sandbox.ok(&format!("turntable scene.yaml {SMALL} {flags}"));
}

/// The frames of an APNG.
fn frames(sandbox: &Sandbox, name: &str) -> Vec<Vec<u8>> {
    let decoder = image::codecs::png::PngDecoder::new(Cursor::new(sandbox.read(name))).unwrap();
    let frames = decoder.apng().unwrap().into_frames().collect_frames().unwrap();
    frames
        .into_iter()
        .map(|frame| image::DynamicImage::from(frame.into_buffer()).into_rgb8().into_raw())
        .collect()
}

fn picture(sandbox: &Sandbox, flags: &str) -> Vec<u8> {
    sandbox.ok(&format!("render scene.yaml -o still.png {SMALL} {flags}"));
    read_png(&sandbox.path("still.png")).pixels.concat()
}

#[test]
fn an_orbit_begins_with_the_picture_and_its_frames_are_pictures() {
    let sandbox = Sandbox::new();
    turn(&sandbox, "-o film.png --frames 4");
    turn(&sandbox, "-o frame_%03d.png --frames 4");
    let frames = frames(&sandbox, "film.png");
    assert_eq!(frames.len(), 4);
    assert_eq!(frames[0], picture(&sandbox, ""));
    // A quarter about the y axis through the target.
    let side = "--set camera.eye=[8,2,0] --set camera.target=[0,1,0]";
    assert_eq!(frames[1], picture(&sandbox, side));
    for (index, frame) in frames.iter().enumerate() {
        let numbered = read_png(&sandbox.path(&format!("frame_{:03}.png", index + 1)));
        assert_eq!(numbered.pixels.as_flattened(), frame);
    }
    assert!(!sandbox.path("frame_005.png").exists());
}

#[test]
fn a_path_begins_and_ends_with_its_cameras() {
    let sandbox = Sandbox::new();
    turn(&sandbox, "-o film.png --frames 5 --path main,top");
    let open = frames(&sandbox, "film.png");
    assert_eq!(open[0], picture(&sandbox, ""));
    assert_eq!(open[4], picture(&sandbox, "--camera top"));
    turn(&sandbox, "-o film.png --frames 4 --path main,top,main");
    let closed = frames(&sandbox, "film.png");
    assert_eq!(closed[0], open[0]);
    assert_eq!(closed[2], open[4]);
    assert_ne!(closed[3], closed[0]);
}

#[test]
fn gif_and_webp_have_the_frames_too() {
    let sandbox = Sandbox::new();
    turn(&sandbox, "-o film.gif --frames 3 --fps 10");
    turn(&sandbox, "-o film.webp --frames 3");
    let (gif, webp) = (sandbox.read("film.gif"), sandbox.read("film.webp"));
    assert!(gif.starts_with(b"GIF89a") && gif.windows(11).any(|bytes| bytes == b"NETSCAPE2.0"));
    assert!(webp.starts_with(b"RIFF") && &webp[8..16] == b"WEBPVP8X");
    assert_eq!(webp.windows(4).filter(|bytes| bytes == b"ANMF").count(), 3);
}

#[test]
fn films_do_not_depend_on_the_work() {
    let sandbox = Sandbox::new();
    for name in ["a.png", "a.gif", "a.webp"] {
        let film = |flags: &str| {
            turn(&sandbox, &format!("-o {name} --frames 3 {flags}"));
            sandbox.read(name)
        };
        let once = film("");
        assert!(film("--threads 1 --accel kd-tree --tile-size 3") == once, "{name}");
    }
}

#[test]
fn a_film_is_told_in_json_and_in_words() {
    let sandbox = Sandbox::new();
    let told = sandbox.json(&format!("turntable scene.yaml -o a.gif --frames 3 --fps 12 --json {SMALL}"));
    assert_eq!((&told["frames"], &told["fps"], &told["output"]), (&3.into(), &12.into(), &"a.gif".into()));
    assert_eq!(told["rays"]["primary"], 3 * 12 * 8);
    let said = text(&sandbox.ok(&format!("turntable scene.yaml -o a.gif --frames 3 {SMALL}")).stderr);
    assert!(said.contains("3 pictures of 12 x 8"), "{said}");
}

#[test]
fn a_turning_model_stays_in_the_picture() {
    let sandbox = Sandbox::new();
    // A long bar, which a camera that frames its front would lose at the sides.
    let bar = "v 0 0 0\nv 9 0 0\nv 9 1 0\nv 0 1 0\nf 1 2 3 4\n";
    sandbox.write("bar.obj", bar);
    sandbox
        .ok("turntable bar.obj -o a%d.png --frames 6 --width 40 --height 30 --samples 1 --ao 0 --no-shadows");
    for index in 1..=6 {
        let picture = read_png(&sandbox.path(&format!("a{index}.png")));
        // The first column and the last show ground and sky alone, row by row the same.
        let column = |x: usize| (0..30).map(|y| picture.pixels[y * 40 + x][2]).collect::<Vec<_>>();
        let differ = column(0).iter().zip(&column(39)).any(|(a, b)| a.abs_diff(*b) > 40);
        assert!(!differ, "picture {index}");
    }
}

#[test]
fn films_that_cannot_be_are_refused_before_anything_is_rendered() {
    let sandbox = Sandbox::new();
    assert!(sandbox.fails(2, "turntable scene.yaml -o film.avi").contains("%04d"));
    assert!(sandbox.fails(2, "turntable scene.yaml -o film_%04d.avi").contains("film_%04d.avi"));
    assert!(sandbox.fails(2, "turntable scene.yaml -o a.gif --path main").contains("two cameras"));
    assert!(sandbox.fails(2, "turntable scene.yaml -o a.gif --path main,front").contains("top"));
    assert!(sandbox.fails(2, "turntable scene.yaml -o a.gif --fps 60").contains("50"));
    sandbox.fails(2, "turntable scene.yaml -o a.gif --path main,top --camera top");
    sandbox.fails(2, "turntable scene.yaml -o a.gif --frames 0");
    sandbox.fails(2, "turntable scene.yaml");
    sandbox.fails(4, "turntable scene.yaml -o nowhere/a_%d.png");
    sandbox.fails(4, "turntable scene.yaml -o nowhere/a.gif");
    sandbox.write("through.yaml", "format: 1\ncamera: {eye: [0, 0, 5]}\ncameras: {back: {eye: [0, 0, -5]}}\nambient: 1\nobjects: [{shape: sphere}]\n");
    let through = sandbox.fails(2, "turntable through.yaml -o a.gif --frames 3 --path main,back");
    assert!(through.contains("picture 2 of 3"), "{through}");
    assert_eq!(sandbox.new_files(), ["through.yaml"]);
}

#[cfg(unix)]
mod video {
    use super::*;
    use std::os::unix::fs::PermissionsExt;

    /// Runs with nothing on the path but what `script` says that ffmpeg does.
    fn with_ffmpeg(script: Option<&str>, code: i32) -> (Sandbox, String) {
        let sandbox = Sandbox::new();
        std::fs::create_dir(sandbox.path("bin")).unwrap();
        if let Some(script) = script {
            sandbox.write("bin/ffmpeg", format!("#!/bin/sh\n{script}\n"));
            std::fs::set_permissions(sandbox.path("bin/ffmpeg"), PermissionsExt::from_mode(0o755)).unwrap();
        }
        sandbox.write("film.mp4", "old");
        let line = format!("turntable scene.yaml -o film.mp4 --frames 3 {SMALL}");
        let output =
            sandbox.lancer(line.split_whitespace()).env("PATH", sandbox.path("bin")).output().unwrap();
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{said}");
        assert_eq!(sandbox.new_files(), ["bin", "film.mp4"], "{said}");
        (sandbox, said)
    }

    /// What is asked for the version first, then makes its last argument.
    const COUNTS: &str =
        "[ \"$1\" = -version ] && exit 0\nfor last; do :; done\n/usr/bin/env wc -c > \"$last\"";

    #[test]
    fn ffmpeg_is_given_every_pixel_of_every_frame() {
        let script = COUNTS.replace("/usr/bin/env wc", "PATH=/usr/bin:/bin wc");
        let (sandbox, _) = with_ffmpeg(Some(&script), 0);
        assert_eq!(text(&sandbox.read("film.mp4")).trim(), (3 * 12 * 8 * 3).to_string());
    }

    #[test]
    fn without_ffmpeg_the_remedy_is_told_and_the_old_file_stays() {
        let (sandbox, said) = with_ffmpeg(None, 4);
        assert!(said.contains("install") && said.contains(".gif"), "{said}");
        assert_eq!(sandbox.read("film.mp4"), b"old");
    }

    #[test]
    fn what_ffmpeg_says_when_it_fails_is_told_and_the_old_file_stays() {
        let fails = "[ \"$1\" = -version ] && exit 0\necho Unknown encoder libx264 >&2\nexit 1";
        let (sandbox, said) = with_ffmpeg(Some(fails), 4);
        assert!(said.contains("encoder libx264"), "{said}");
        assert_eq!(sandbox.read("film.mp4"), b"old");
    }
}

#[test]
fn a_thumbnail_of_a_model_is_cut_out_and_square() {
    let sandbox = Sandbox::new();
    sandbox.ok("thumbnail model.obj -o thumb --size 48");
    let read = image::load_from_memory_with_format(&sandbox.read("thumb"), image::ImageFormat::Png).unwrap();
    let pixels = read.into_rgba8();
    assert_eq!(pixels.dimensions(), (48, 48));
    assert_eq!(pixels.get_pixel(0, 0).0, [0; 4]);
    assert_eq!(pixels.get_pixel(24, 24).0[3], 255);
    let partly = pixels.pixels().filter(|pixel| (1..255).contains(&pixel.0[3])).count();
    assert!(partly > 10, "edges are smooth");
    let bytes = sandbox.read("thumb");
    sandbox.ok("thumbnail model.obj -o thumb -s 48");
    assert!(sandbox.read("thumb") == bytes, "the same bytes each time");
}

#[test]
fn a_thumbnail_of_a_scene_has_its_shape_and_its_background() {
    let sandbox = Sandbox::new();
    sandbox.ok("thumbnail scene.yaml -o thumb.png --size 36");
    let thumbnail = read_png(&sandbox.path("thumb.png"));
    assert_eq!((thumbnail.width, thumbnail.height), (36, 24));
    assert_eq!(thumbnail.pixels[0], [0x87, 0xce, 0xeb]);
    sandbox.ok("thumbnail glass -o thumb.png");
    assert_eq!(read_png(&sandbox.path("thumb.png")).width, 256);
}

/// File managers make the file, and some read it through the descriptor by which they did.
#[test]
fn an_empty_file_is_filled_with_the_thumbnail_in_place() {
    let sandbox = Sandbox::new();
    sandbox.ok("thumbnail model.obj -o another.png --size 24");
    sandbox.write("thumb.png", "");
    let mut held = std::fs::File::open(sandbox.path("thumb.png")).unwrap();
    sandbox.ok("thumbnail model.obj -o thumb.png --size 24");
    let mut found = Vec::new();
    held.read_to_end(&mut found).unwrap();
    assert!(found == sandbox.read("another.png"));
    assert_eq!(sandbox.new_files(), ["another.png", "thumb.png"]);
}

#[test]
fn a_thumbnail_that_cannot_be_leaves_no_file() {
    let sandbox = Sandbox::new();
    sandbox.write("broken.obj", "f 1 2 3\n");
    sandbox.fails(3, "thumbnail broken.obj -o a.png");
    sandbox.fails(3, "thumbnail nothing.obj -o a.png");
    sandbox.fails(2, "thumbnail model.obj -o a.png --size 0");
    sandbox.fails(4, "thumbnail model.obj -o nowhere/a.png");
    assert_eq!(sandbox.new_files(), ["broken.obj"]);
}

/// The entry names flags that there are, and formats that are read.
#[test]
fn the_thumbnailer_entry_is_true() {
    let entry = include_str!("../../../../packaging/lancer.thumbnailer");
    let line = |key: &str| entry.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix('=')).unwrap();
    let sandbox = Sandbox::new();
    let command = line("Exec").replace("%i", "model.obj").replace("%o", "a.png").replace("%s", "32");
    sandbox.ok(command.strip_prefix("lancer ").unwrap());
    assert_eq!(image::image_dimensions(sandbox.path("a.png")).unwrap(), (32, 32));
    assert!(line("MimeType").contains("model/obj;"));
}
