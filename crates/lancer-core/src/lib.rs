//! A recursive (Whitted) ray tracer, as a library.
//!
//! It opens no file and no window, reads no clock, prints nothing and keeps no global state. A picture flows
//! one way through its rooms:
//!
//! 1. [`scene`]: what an author says: a tree of named nodes with transforms, shapes and materials, lights,
//!    cameras.
//! 2. [`world`]: the tree compiled for tracing: flat, immutable, with a tree over each mesh and one over the
//!    objects.
//! 3. [`render`]: tiles of pixels traced by [`integrator`] and lit by [`shade`], into a [`film`].
//!
//! ```
//! use lancer_core::Rgb;
//! use lancer_core::geometry::DVec3;
//! use lancer_core::render::{Control, render};
//! use lancer_core::scene::{Node, Scene, Settings, Shape};
//! use lancer_core::world::{CompileOptions, World};
//!
//! let mut scene = Scene::new("a ball in the sun");
//! scene.background = Rgb::from_srgb_hex(0x87ceeb);
//! scene.add_light(DVec3::new(4.0, 6.0, 4.0), Rgb::grey(200.0));
//! scene.add(Node::shape("ball", Shape::Sphere));
//! scene.settings = Settings { width: 80, height: 60, ..Settings::default() };
//!
//! let world = World::compile(&scene, &CompileOptions::default())?;
//! let picture = render(&world, &scene.camera, &scene.settings, None, &Control::default())?;
//! assert!(picture.image.pixel(40, 30)[0] > 0.1);
//! assert_eq!(picture.rays.primary, 80 * 60);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod accel;
pub mod camera;
pub mod cancel;
pub mod color;
pub mod film;
pub mod geometry;
pub mod integrator;
pub mod mesh;
pub mod render;
pub mod sampling;
pub mod scene;
pub mod shade;
pub mod shape;
pub mod simd;
pub mod world;

pub use color::Rgb;

#[cfg(test)]
mod testing;
