//! Textures read, pictures written, and files that stay whole.

use exr::prelude::read_first_rgba_layer_from_file;
use lancer_core::Rgb;
use lancer_core::film::{Image, Tone, to_srgb8};
use lancer_core::geometry::DVec2;
use lancer_core::scene::Wrap;
use lancer_io::image::encode::{write, write_png};
use lancer_io::image::{Encoding, EncodingChoice, ImageFormat, Metadata, decode_picture, load_texture};
use lancer_io::limits::Limits;
use lancer_io::output::write_atomically;
use lancer_io::resolver::Resolver;
use proptest::prelude::*;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;
use tempfile::TempDir;

fn gradient(width: u32, height: u32) -> Image {
    let mut image = Image::black(width, height);
    for y in 0..height {
        for x in 0..width {
            let (u, v) = (x as f32 / width as f32, y as f32 / height as f32);
            image.put(x, y, 1, &[[u, v, 0.5]]);
        }
    }
    image
}

fn load(directory: &Path, name: &str, bytes: &[u8]) -> Result<(u32, u32, Rgb), String> {
    let path = directory.join(name);
    fs::write(&path, bytes).unwrap();
    let resolver = Resolver::for_file(&path, false, Limits::default());
    let image = load_texture(&path, &resolver).map_err(|error| error.to_string())?;
    Ok((image.width(), image.height(), image.color_at(DVec2::new(0.5, 0.5), [Wrap::Repeat; 2])))
}

fn png_of(color: png::ColorType, depth: png::BitDepth, palette: Option<&[u8]>, data: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 1, 1);
    encoder.set_color(color);
    encoder.set_depth(depth);
    if let Some(palette) = palette {
        encoder.set_palette(palette.to_vec());
    }
    encoder.write_header().unwrap().write_image_data(data).unwrap();
    bytes
}

// Textures

#[test]
fn every_kind_of_png_becomes_rgb() {
    use png::{BitDepth, ColorType};
    let directory = TempDir::new().unwrap();
    let red = Rgb::new(1.0, 0.0, 0.0);
    for (bytes, expected) in [
        (png_of(ColorType::Rgb, BitDepth::Eight, None, &[255, 0, 0]), red),
        (png_of(ColorType::Rgba, BitDepth::Eight, None, &[255, 0, 0, 7]), red),
        (png_of(ColorType::Rgb, BitDepth::Sixteen, None, &[255, 255, 0, 0, 0, 0]), red),
        (png_of(ColorType::Indexed, BitDepth::Eight, Some(&[0, 0, 0, 255, 0, 0]), &[1]), red),
        (png_of(ColorType::Grayscale, BitDepth::Eight, None, &[255]), Rgb::WHITE),
        (png_of(ColorType::GrayscaleAlpha, BitDepth::Sixteen, None, &[255, 255, 0, 0]), Rgb::WHITE),
        (png_of(ColorType::Grayscale, BitDepth::One, None, &[0x80]), Rgb::WHITE),
    ] {
        assert_eq!(load(directory.path(), "t.png", &bytes), Ok((1, 1, expected)));
    }
}

#[test]
fn jpeg_is_read_to_within_its_losses() {
    let mut bytes = Vec::new();
    let pixels = [[200_u8, 60, 30]; 16 * 16].concat();
    let encoder = image::codecs::jpeg::JpegEncoder::new_with_quality(&mut bytes, 95);
    image::ImageEncoder::write_image(encoder, &pixels, 16, 16, image::ExtendedColorType::Rgb8).unwrap();
    let (width, height, color) = load(TempDir::new().unwrap().path(), "wood.jpg", &bytes).unwrap();
    assert_eq!((width, height), (16, 16));
    let expected = Rgb::from_srgb_hex(0xc8_3c1e);
    for (found, expected) in color.to_array().into_iter().zip(expected.to_array()) {
        assert!((found - expected).abs() < 0.02, "{found} is not {expected}");
    }
}

#[test]
fn tga_is_known_by_its_name_and_others_by_their_content() {
    let directory = TempDir::new().unwrap();
    let mut tga = vec![0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 1, 0, 24, 0];
    tga.extend([0, 0, 255]);
    assert_eq!(load(directory.path(), "t.TGA", &tga), Ok((1, 1, Rgb::new(1.0, 0.0, 0.0))));
    let white = png_of(png::ColorType::Grayscale, png::BitDepth::Eight, None, &[255]);
    assert_eq!(load(directory.path(), "misnamed.jpg", &white), Ok((1, 1, Rgb::WHITE)));
}

#[test]
fn webp_and_tiff_are_textures_and_floats_are_none() {
    let directory = TempDir::new().unwrap();
    let image = Image::black(3, 2).map(|_| [1.0, 0.0, 0.0]);
    let written = |encoding: Encoding| {
        let mut bytes = Vec::new();
        write(encoding, &image, Tone::default(), &Metadata::default(), &mut bytes).unwrap();
        bytes
    };
    let tiff = |bits| {
        let choice = EncodingChoice { bits: Some(bits), ..EncodingChoice::default() };
        written(Encoding::new(ImageFormat::Tiff, choice).unwrap())
    };
    for bytes in [written(ImageFormat::WebP.into()), tiff(8), tiff(16)] {
        assert_eq!(load(directory.path(), "t", &bytes), Ok((3, 2, Rgb::new(1.0, 0.0, 0.0))));
    }
    let error = load(directory.path(), "t.tif", &tiff(32)).unwrap_err();
    assert!(error.contains("t.tif: ") && error.contains("8 or 16 bits"), "{error}");
    for radiance in [ImageFormat::Hdr, ImageFormat::Exr, ImageFormat::Pfm] {
        assert!(load(directory.path(), "t", &written(radiance.into())).is_err(), "{radiance:?}");
    }
}

#[test]
fn errors_of_textures_name_the_file() {
    let directory = TempDir::new().unwrap();
    let whole = png_of(png::ColorType::Grayscale, png::BitDepth::Eight, None, &[255]);
    for (bytes, reason) in [
        (&b"GIF89a"[..], "PNG, JPEG, WebP, TIFF, BMP, TGA"),
        (b"", "not an image"),
        (b"plain text", "not an image"),
        (&whole[..40], "broken"),
    ] {
        let error = load(directory.path(), "t.png", bytes).unwrap_err();
        assert!(error.contains("t.png: ") && error.contains(reason), "{error}");
    }
}

/// The header of a PNG of any size, with nothing behind.
fn png_header(width: u32, height: u32) -> Vec<u8> {
    let mut header = b"IHDR".to_vec();
    header.extend(width.to_be_bytes());
    header.extend(height.to_be_bytes());
    header.extend([8, 6, 0, 0, 0]);
    let mut bytes = b"\x89PNG\r\n\x1a\n\0\0\0\x0d".to_vec();
    bytes.extend(&header);
    bytes.extend(crc32(&header).to_be_bytes());
    bytes.extend(b"\0\0\0\0IDAT\x35\xaf\x06\x1e\0\0\0\0IEND\xae\x42\x60\x82");
    bytes
}

fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |crc: u32, &byte| {
        (0..8).fold(
            crc ^ u32::from(byte),
            |crc, _| if crc & 1 == 1 { crc >> 1 ^ 0xedb8_8320 } else { crc >> 1 },
        )
    })
}

#[test]
fn bombs_are_refused_by_their_headers() {
    let directory = TempDir::new().unwrap();
    let error = load(directory.path(), "bomb.png", &png_header(100_000, 100_000)).unwrap_err();
    assert!(error.contains("100000 x 100000 pixels are more than"), "{error}");
    assert!(load(directory.path(), "bomb.png", &png_header(u32::MAX, u32::MAX)).is_err());
    let tga = [0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 255, 255, 255, 255, 32, 0];
    assert!(load(directory.path(), "bomb.tga", &tga).unwrap_err().contains("65535 x 65535"));
}

/// A JPEG of a kind that its decoder does not stand: it panics where colours have more samples than light, and the first
/// scan holds one channel.
fn jpeg_that_panics() -> Vec<u8> {
    let table = |kind: u8| [&[0xff, 0xc4, 0, 20, kind, 1], &[0; 16][..]].concat();
    let frame = [0xff, 0xc0, 0, 17, 8, 0, 8, 0, 33, 3, 1, 0x11, 0, 2, 0x21, 0, 3, 0x11, 0];
    let scan = [0xff, 0xda, 0, 8, 1, 1, 0, 0, 63, 0];
    let quantization = [&[0xff, 0xdb, 0, 67, 0], &[1; 64][..]].concat();
    [&[0xff, 0xd8][..], &quantization, &frame, &table(0), &table(16), &scan, &[0; 64], &[0xff, 0xd9]].concat()
}

#[test]
fn what_a_decoder_does_not_stand_is_a_broken_image() {
    let directory = TempDir::new().unwrap();
    let error = load(directory.path(), "t.jpg", &jpeg_that_panics()).unwrap_err();
    assert!(error.ends_with("t.jpg: is a broken image: its decoder cannot go on with it"), "{error}");
    let picture = decode_picture("t.jpg".as_ref(), &jpeg_that_panics(), 1 << 20).unwrap_err().to_string();
    assert_eq!(picture, "t.jpg: is a broken image: its decoder cannot go on with it");
}

#[test]
fn a_tiff_whose_fields_are_longer_than_it_is_refused() {
    let directory = TempDir::new().unwrap();
    let mut tiff = b"II\x2a\0\x08\0\0\0\x01\0\0\x01\x01\0".to_vec();
    tiff.extend(8_000_000_u32.to_le_bytes());
    tiff.extend([8, 0, 0, 0, 0, 0, 0, 0]);
    let error = load(directory.path(), "t.tif", &tiff).unwrap_err();
    assert!(
        error.ends_with("t.tif: is a broken image: a field of its directory is longer than the file"),
        "{error}"
    );
}

fn black_png(width: u32, height: u32) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    let pixels = vec![0; 3 * width as usize * height as usize];
    encoder.write_header().unwrap().write_image_data(&pixels).unwrap();
    bytes
}

#[test]
fn a_file_is_one_texture_by_all_of_its_names() {
    let directory = TempDir::new().unwrap();
    let below = directory.path().join("below");
    fs::create_dir(&below).unwrap();
    fs::write(directory.path().join("a.png"), black_png(2, 3)).unwrap();
    let resolver = Resolver::for_file(&directory.path().join("scene.yaml"), false, Limits::default());
    let named = |path: PathBuf| load_texture(&path, &resolver.clone()).unwrap();
    let (plain, around) = (named(directory.path().join("a.png")), named(below.join("../a.png")));
    assert!(Arc::ptr_eq(&plain, &around));
}

#[test]
fn textures_of_a_scene_are_bounded_together() {
    let directory = TempDir::new().unwrap();
    let flat = black_png(1000, 1000);
    for name in ["a.png", "b.png"] {
        fs::write(directory.path().join(name), &flat).unwrap();
    }
    let loaded = |texture_pixels: u64| {
        let limits = Limits { texture_pixels, ..Limits::default() };
        let resolver = Resolver::for_file(&directory.path().join("scene.yaml"), false, limits);
        ["a.png", "b.png"].map(|name| {
            load_texture(&directory.path().join(name), &resolver).map_err(|error| error.to_string())
        })
    };
    assert!(loaded(2_000_000).iter().all(Result::is_ok));
    let [first, second] = loaded(1_999_999);
    assert!(first.is_ok());
    let error = second.unwrap_err();
    let told = "b.png: 1000 x 1000 pixels: with the other textures 6000000 bytes are needed, more than 5999997, the most for files of ";
    assert!(error.contains(told), "{error}");
    assert!(error.ends_with("hint: --limit texture-pixels=N allows more"), "{error}");
}

proptest! {
    #[test]
    fn any_bytes_are_a_texture_or_an_error(
        bytes in prop::collection::vec(any::<u8>(), 0..300),
        magic in prop::sample::select(vec![&b"\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR"[..], b"\xff\xd8\xff\xe0", b"BM", b""]),
    ) {
        let directory = TempDir::new().unwrap();
        let bytes = [magic, &bytes].concat();
        for name in ["t.png", "t.tga"] {
            let _ = load(directory.path(), name, &bytes);
        }
    }
}

// Pictures

#[test]
fn png_holds_the_image_in_srgb_and_says_who_wrote_it() {
    let image = gradient(37, 11);
    let mut bytes = Vec::new();
    write_png(&image, &Metadata::default(), &mut bytes).unwrap();
    let mut reader = png::Decoder::new(io::Cursor::new(&bytes)).read_info().unwrap();
    let info = reader.info();
    assert_eq!(info.srgb, Some(png::SrgbRenderingIntent::Perceptual));
    let text = &info.uncompressed_latin1_text[0];
    assert_eq!((text.keyword.as_str(), text.text.starts_with("Lancer ")), ("Software", true));
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    assert_eq!(pixels, to_srgb8(&image).as_flattened());
}

#[test]
fn exr_holds_every_float_exactly() {
    let mut image = gradient(19, 33);
    image.put(3, 4, 1, &[[1e30, -7.25, f32::MIN_POSITIVE]]);
    let directory = TempDir::new().unwrap();
    let path = directory.path().join("image.exr");
    write_atomically(&path, |out| {
        write(ImageFormat::Exr, &image, Tone::default(), &Metadata::default(), out)
    })
    .unwrap();
    let read = read_first_rgba_layer_from_file(
        &path,
        |size, _| Image::black(size.x() as u32, size.y() as u32),
        |image, at, (r, g, b, _): (f32, f32, f32, f32)| {
            image.put(at.x() as u32, at.y() as u32, 1, &[[r, g, b]]);
        },
    )
    .unwrap();
    assert_eq!(read.layer_data.channel_data.pixels, image);
}

#[test]
fn the_same_image_gives_the_same_bytes() {
    let image = gradient(64, 64);
    for format in ImageFormat::ALL {
        let bytes = || {
            let mut bytes = Vec::new();
            write(format, &image, Tone::default(), &Metadata::default(), &mut bytes).unwrap();
            bytes
        };
        assert_eq!(bytes(), bytes());
    }
}

#[test]
fn an_image_without_pixels_is_an_error() {
    let image = Image::black(0, 7);
    assert!(write_png(&image, &Metadata::default(), io::sink()).is_err());
    for format in ImageFormat::ALL {
        assert!(write(format, &image, Tone::default(), &Metadata::default(), io::sink()).is_err());
    }
}

#[test]
fn formats_are_chosen_by_extension_in_any_case() {
    assert_eq!(ImageFormat::from_path(Path::new("a/b.PNG")), Ok(ImageFormat::Png));
    assert_eq!(ImageFormat::from_path(Path::new("b.exr")), Ok(ImageFormat::Exr));
    assert_eq!(ImageFormat::from_path(Path::new("b.Jpg")), Ok(ImageFormat::Jpeg));
    assert_eq!(ImageFormat::from_path(Path::new("b.tif")), Ok(ImageFormat::Tiff));
    for format in ImageFormat::ALL {
        assert_eq!(ImageFormat::from_name(format.name()), Some(format));
        assert!(ImageFormat::EXTENSIONS.contains(&format.name()));
    }
    assert!(ImageFormat::EXTENSIONS.iter().all(|extension| ImageFormat::from_name(extension).is_some()));
    for other in ["b.gif", "png", "b"] {
        let error = ImageFormat::from_path(Path::new(other)).unwrap_err().to_string();
        assert!(
            error.contains(".png, .jpg") && error.contains("or .exr") && error.contains(other),
            "{error}"
        );
    }
}

// Files that are whole or absent

fn names_in(directory: &Path) -> Vec<String> {
    let mut names = fs::read_dir(directory)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect::<Vec<_>>();
    names.sort();
    names
}

fn disk_full(out: &mut dyn Write) -> io::Result<()> {
    out.write_all(&[b'x'; 100_000])?;
    Err(io::Error::from(io::ErrorKind::StorageFull))
}

#[test]
fn a_failing_writer_leaves_the_old_file_and_nothing_else() {
    let directory = TempDir::new().unwrap();
    let path = directory.path().join("out.png");
    assert!(write_atomically(&path, disk_full).is_err());
    assert!(names_in(directory.path()).is_empty());

    write_atomically(&path, |out| out.write_all(b"old")).unwrap();
    let error = write_atomically(&path, disk_full).unwrap_err().to_string();
    assert!(error.contains("out.png: cannot be written: "), "{error}");
    assert_eq!(fs::read(&path).unwrap(), b"old");
    assert_eq!(names_in(directory.path()), ["out.png"]);
}

#[test]
fn a_panicking_writer_leaves_the_old_file_and_nothing_else() {
    let directory = TempDir::new().unwrap();
    let path = directory.path().join("out");
    fs::write(&path, "old").unwrap();
    let panicked = std::panic::catch_unwind(|| {
        let _ = write_atomically(&path, |out| {
            out.write_all(b"half")?;
            panic!("as a worker may")
        });
    });
    assert!(panicked.is_err());
    assert_eq!(fs::read(&path).unwrap(), b"old");
    assert_eq!(names_in(directory.path()), ["out"]);
}

#[test]
fn the_old_file_is_there_until_the_new_one_is_whole() {
    let directory = TempDir::new().unwrap();
    let path = directory.path().join("out");
    fs::write(&path, "old").unwrap();
    write_atomically(&path, |out| {
        out.write_all(&[b'n'; 1 << 20])?;
        out.flush()?;
        assert_eq!(fs::read(&path)?, b"old");
        Ok(())
    })
    .unwrap();
    assert_eq!(fs::read(&path).unwrap(), [b'n'; 1 << 20]);
}

#[test]
fn a_missing_directory_and_a_directory_are_told() {
    let directory = TempDir::new().unwrap();
    let missing = write_atomically(&directory.path().join("no/out.png"), |_| Ok(())).unwrap_err().to_string();
    assert!(missing.contains("there is no directory"), "{missing}");
    let taken = write_atomically(directory.path(), |_| Ok(())).unwrap_err().to_string();
    assert!(taken.contains("it is a directory"), "{taken}");
}

#[cfg(unix)]
mod unix {
    use super::*;
    use std::os::unix::fs::{PermissionsExt, symlink};

    fn mode(path: &Path) -> u32 {
        fs::metadata(path).unwrap().permissions().mode() & 0o777
    }

    #[test]
    fn permissions_are_those_of_a_new_file_or_of_the_old_one() {
        let directory = TempDir::new().unwrap();
        let (ours, plain) = (directory.path().join("ours"), directory.path().join("plain"));
        fs::write(&plain, "").unwrap();
        write_atomically(&ours, |_| Ok(())).unwrap();
        assert_eq!(mode(&ours), mode(&plain));

        fs::set_permissions(&ours, fs::Permissions::from_mode(0o640)).unwrap();
        write_atomically(&ours, |_| Ok(())).unwrap();
        assert_eq!(mode(&ours), 0o640);

        fs::set_permissions(&ours, fs::Permissions::from_mode(0o444)).unwrap();
        assert!(write_atomically(&ours, |_| Ok(())).unwrap_err().to_string().contains("read-only"));
    }

    #[test]
    fn links_keep_pointing_at_what_is_written() {
        let directory = TempDir::new().unwrap();
        let at = |name: &str| directory.path().join(name);
        fs::create_dir(at("real")).unwrap();
        symlink("real/file", at("link")).unwrap();
        symlink("link", at("second")).unwrap();
        symlink("circle", at("circle")).unwrap();
        for content in ["first", "again"] {
            write_atomically(&at("second"), |out| out.write_all(content.as_bytes())).unwrap();
            assert!(at("link").is_symlink() && at("second").is_symlink());
            assert_eq!(fs::read_to_string(at("real/file")).unwrap(), content);
        }
        assert!(write_atomically(&at("circle"), |_| Ok(())).is_err());
    }

    #[test]
    fn devices_are_written_directly() {
        write_atomically(Path::new("/dev/null"), |out| out.write_all(b"gone")).unwrap();
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
    }

    /// Kills a process that writes one file again and again, at many moments.
    #[test]
    fn a_killed_writer_leaves_one_of_the_whole_files() {
        const ROLE: &str = "LANCER_TEST_WRITES_UNTIL_KILLED";
        if let Some(path) = std::env::var_os(ROLE) {
            for byte in (b'a'..=b'z').cycle() {
                write_atomically(Path::new(&path), |out| out.write_all(&[byte; 300_000])).unwrap();
            }
        }
        let directory = TempDir::new().unwrap();
        let path = directory.path().join("out");
        fs::write(&path, [b'0'; 300_000]).unwrap();
        for round in 0..20_u64 {
            let mut writer = std::process::Command::new(std::env::current_exe().unwrap())
                .args(["--exact", "unix::a_killed_writer_leaves_one_of_the_whole_files"])
                .env(ROLE, &path)
                .stdout(std::process::Stdio::null())
                .spawn()
                .unwrap();
            std::thread::sleep(Duration::from_micros(5_000 + 1_733 * round));
            writer.kill().unwrap();
            writer.wait().unwrap();
            let found = fs::read(&path).unwrap();
            assert_eq!(found.len(), 300_000);
            assert!(found.iter().all(|&byte| byte == found[0]));
        }
    }
}
