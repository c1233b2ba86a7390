//! Bytes to scenes, and images to bytes.
//!
//! It knows neither traversal nor threads. [`load`] reads whatever a user names; the modules read and write one
//! kind of file each.
//!
//! # Load a scene, render it, write it
//!
//! ```
//! use lancer_core::render::{Control, render};
//! use lancer_core::world::{CompileOptions, World};
//! use lancer_io::image::{ImageFormat, Metadata, encode};
//! use lancer_io::output::write_atomically;
//! use lancer_io::{LoadOptions, load};
//!
//! # let directory = tempfile::tempdir()?;
//! # let scene_path = directory.path().join("ball.yaml");
//! # let picture_path = directory.path().join("ball.png");
//! # std::fs::write(&scene_path, "format: 1\nambient: 1\nobjects: [{shape: sphere}]\nrender: {width: 40, height: 30}")?;
//! // `scene_path` is a scene file or a model; `options` changes values, as `--set` does, and sets limits.
//! let options = LoadOptions { overrides: vec!["render.samples=2".parse()?], ..LoadOptions::default() };
//! let loaded = load(&scene_path, &options)?;
//! assert!(loaded.warnings.is_empty());
//!
//! let scene = loaded.scene;
//! let world = World::compile(&scene, &CompileOptions::default())?;
//! let picture = render(&world, &scene.camera, &scene.settings, None, &Control::default())?;
//!
//! let format = ImageFormat::from_path(&picture_path)?;
//! let (image, tone, metadata) = (&picture.image, scene.tone, Metadata::default());
//! write_atomically(&picture_path, |out| encode::write(format, image, tone, &metadata, out))?;
//! assert!(picture_path.is_file());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Errors
//!
//! A file's faults come all at once, each with its place:
//!
//! ```
//! use lancer_io::{LoadOptions, load};
//!
//! # let directory = tempfile::tempdir()?;
//! # let scene_path = directory.path().join("faulty.yaml");
//! # std::fs::write(&scene_path, "format: 1\nobjects: [{shape: spere}]\nambiance: 1\n")?;
//! let error = load(&scene_path, &LoadOptions::default()).unwrap_err();
//! assert_eq!(error.diagnostics.len(), 2);
//! assert_eq!(error.diagnostics[0].hint.as_deref(), Some("did you mean `sphere`?"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod account;
pub mod compare;
pub mod diagnostics;
pub mod image;
pub mod limits;
mod load;
pub mod model;
pub mod output;
mod package;
pub mod progress;
pub mod provenance;
pub mod resolver;
pub mod scene_file;
pub mod showcase;

pub use load::{LoadOptions, Loaded, SCENE_EXTENSIONS, is_scene_file, load, load_with};
