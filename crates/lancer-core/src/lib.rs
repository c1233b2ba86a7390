//! A recursive (Whitted) ray tracer, as a library.
//!
//! It opens no file and no window, reads no clock, prints nothing and keeps no global state. A picture flows
//! one way through its rooms:
//!
//! 1. [`scene`]: what an author says: a tree of named nodes with transforms, shapes and materials, lights,
//!    cameras.
//! 2. [`world`]: the tree compiled for tracing: flat, immutable, with a k-d tree over each mesh and one over
//!    the objects.
//! 3. [`render`]: tiles of pixels traced by [`integrator`] and lit by [`shade`], into a [`film`].

pub mod accel;
pub mod camera;
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
pub mod world;

pub use color::Rgb;

#[cfg(test)]
mod testing;
