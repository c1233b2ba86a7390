//! What the fuzz targets share: files in memory, read as the program reads them, and what must hold of the outcome.
//!
//! In: the bytes of the file that is fuzzed, and of those that it may refer to. A target fails by a panic, by more
//! memory than [`MOST_MEMORY`], or by more time than the fuzzer allows.

use lancer_core::render::{Control, render};
use lancer_core::scene::{AmbientOcclusion, Scene, Settings, Shape};
use lancer_core::world::{CompileOptions, World};
use lancer_io::diagnostics::LoadError;
use lancer_io::image::{decode_picture, load_texture, provenance_of};
use lancer_io::limits::Limits;
use lancer_io::model::{ModelOptions, load, model_extensions};
use lancer_io::resolver::Resolver;
use lancer_io::scene_file::Override;
use lancer_io::{LoadOptions, is_scene_file, load_with};
use peak_alloc::PeakAlloc;
use std::path::Path;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// What reading one input may take, in bytes beyond what the fuzzer itself holds.
pub const MOST_MEMORY: usize = 64 << 20;

/// The most objects of a scene that is compiled and rendered, times the triangles of the largest: beyond that a run tells
/// little for its time.
const MOST_RENDERED: u64 = 20_000;

/// The separator between the files of one input: a line of its own.
const SEPARATOR: &[u8] = b"\n%%\n";

/// A texture, for the files that refer to one by the name of `t.bmp`: two by two texels of 24 bits.
pub const TEXTURE: &[u8] = &[
    b'B', b'M', 70, 0, 0, 0, 0, 0, 0, 0, 54, 0, 0, 0, 40, 0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, 1, 0, 24, 0, 0, 0,
    0, 0, 16, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 10, 20, 250, 200, 100, 50, 0, 0, 90,
    90, 90, 255, 255, 0, 0, 0,
];

/// Limits so small that whatever is not bounded by them shows.
pub fn limits() -> Limits {
    Limits {
        file_bytes: 4 << 20,
        triangles: 20_000,
        memory: 24 << 20,
        objects: 4_000,
        texture_pixels: 1 << 16,
        syntax_nodes: 20_000,
        ..Limits::default()
    }
}

/// Parts an input at the first separator; the second part is empty where there is none.
pub fn parts(input: &[u8]) -> (&[u8], &[u8]) {
    let at = input.windows(SEPARATOR.len()).position(|window| window == SEPARATOR);
    at.map_or((input, &[]), |at| (&input[..at], &input[at + SEPARATOR.len()..]))
}

/// Reads the first of `files`, which may refer to the others, and holds the outcome against what is promised:
///
/// - no panic, and no more memory than [`MOST_MEMORY`];
/// - a refusal says what is wrong;
/// - a model that is read has triangles, no more than the limit;
/// - a scene that is read compiles, and renders, or is refused by an error.
pub fn read(files: &[(&str, &[u8])], overrides: Vec<Override>) {
    let path = Path::new(files[0].0);
    let resolver = in_memory(files);
    if !is_scene_file(path) {
        assert!(model_extensions().any(|known| path.extension().is_some_and(|found| found == known)));
        within_memory(|| match load(path, &resolver, &ModelOptions::default()) {
            Ok(model) => {
                assert!(!model.parts.is_empty(), "a model without parts");
                assert!(
                    model.parts.iter().all(|part| part.mesh.triangle_count() > 0),
                    "a part without triangles"
                );
                let triangles = model.parts.iter().map(|part| part.mesh.triangle_count()).sum::<usize>();
                assert!(triangles <= limits().triangles, "more triangles than the limit");
                assert!(
                    model.materials.len()
                        >= model
                            .parts
                            .iter()
                            .filter_map(|part| part.material)
                            .max()
                            .map_or(0, |most| most + 1)
                );
            }
            Err(error) => check_refusal(&error),
        });
    }
    let options = LoadOptions { overrides, ..LoadOptions::default() };
    let scene = within_memory(|| match load_with(path, &resolver, &options) {
        Ok(loaded) => {
            loaded.warnings.iter().for_each(|warning| assert!(!warning.message.is_empty()));
            Some(loaded.scene)
        }
        Err(error) => {
            check_refusal(&error);
            None
        }
    });
    if let Some(scene) = scene {
        compile_and_render(scene);
    }
}

/// Lets panics pass that happen in the decoder of JPEG: its authors know of several, and the reader makes errors of them.
/// The fuzzer's own hook ends the process at once.
pub fn allow_panics_of_jpeg() {
    let hook = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        if !panic.location().is_some_and(|place| place.file().contains("/zune-jpeg-")) {
            hook(panic);
        }
    }));
}

/// Decodes a picture as it is compared and verified, and holds the outcome against what is promised.
pub fn read_picture(bytes: &[u8]) {
    within_memory(|| {
        match decode_picture("picture".as_ref(), bytes, limits().texture_pixels) {
            Ok(picture) => {
                let pixels = u64::from(picture.values.width()) * u64::from(picture.values.height());
                assert!(pixels <= limits().texture_pixels);
            }
            Err(error) => check_refusal(&error),
        }
        assert!(provenance_of(bytes).is_none_or(|text| text.len() <= bytes.len()));
    });
}

/// Decodes a texture, and holds the outcome against what is promised.
pub fn read_texture(name: &str, bytes: &[u8]) {
    let resolver = in_memory(&[(name, bytes)]);
    within_memory(|| match load_texture(name.as_ref(), &resolver) {
        Ok(texture) => {
            let pixels = u64::from(texture.width()) * u64::from(texture.height());
            assert!(pixels > 0 && pixels <= limits().texture_pixels);
            assert_eq!(texture.texels().len() as u64, pixels);
        }
        Err(error) => check_refusal(&error),
    });
}

fn in_memory(files: &[(&str, &[u8])]) -> Resolver {
    Resolver::in_memory(files.iter().map(|&(path, bytes)| (path.into(), bytes.to_vec())), limits())
}

fn check_refusal(error: &LoadError) {
    assert!(!error.diagnostics.is_empty(), "a refusal without a reason");
    assert!(error.diagnostics.len() <= limits().errors + 1, "more errors than the limit");
    for diagnostic in &error.diagnostics {
        assert!(!diagnostic.message.is_empty(), "an empty message");
    }
    assert!(!error.to_string().is_empty());
}

/// Fails where `action` holds more than [`MOST_MEMORY`] at once.
fn within_memory<T>(action: impl FnOnce() -> T) -> T {
    let before = MEMORY.current_usage();
    MEMORY.reset_peak_usage();
    let outcome = action();
    let used = MEMORY.peak_usage().saturating_sub(before);
    assert!(used <= MOST_MEMORY, "reading held {used} bytes");
    outcome
}

fn compile_and_render(mut scene: Scene) {
    let Ok(drawn) = World::count_objects(&scene) else { return };
    assert!(drawn <= limits().objects, "more objects than the limit");
    let largest = scene.nodes().iter().map(|node| match &node.shape {
        Some(Shape::Mesh(mesh)) => mesh.triangle_count() as u64,
        _ => 1,
    });
    if drawn * largest.max().unwrap_or(0) > MOST_RENDERED {
        return;
    }
    scene.settings = Settings {
        width: 6,
        height: 4,
        samples: 1,
        depth: 2,
        ao: AmbientOcclusion { samples: 1, ..scene.settings.ao },
        ..scene.settings
    };
    let Ok(world) = World::compile(&scene, &CompileOptions::default()) else { return };
    if let Ok(picture) = render(&world, &scene.camera, &scene.settings, None, &Control::default()) {
        assert_eq!((picture.image.width(), picture.image.height()), (6, 4));
    }
}
