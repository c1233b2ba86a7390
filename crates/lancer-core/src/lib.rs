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
//! # Build a scene and render it
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
//!
//! `lancer-io` reads scenes and models from files, and writes pictures to them.
//!
//! # Trace a single ray
//!
//! [`World::intersect`] finds what a ray meets first, [`World::intersection`] all about that point, and
//! [`World::occluded`] whether anything is in the way. [`Whitted::radiance`] goes on through mirrors and glass, and
//! tells a [`Listener`] every term on the way.
//!
//! ```
//! use lancer_core::geometry::{DVec3, Ray};
//! use lancer_core::scene::{Node, Scene, Shape};
//! use lancer_core::world::{CompileOptions, World};
//!
//! let mut scene = Scene::new("a ball");
//! scene.add(Node::shape("ball", Shape::Sphere));
//! let world = World::compile(&scene, &CompileOptions::default())?;
//!
//! let ray = Ray::new(DVec3::new(0.0, 0.0, 5.0), DVec3::NEG_Z);
//! let hit = world.intersect(&ray).expect("the ball is in the way");
//! let at = world.intersection(&ray, &hit);
//! assert_eq!((hit.t, at.point, at.geometric_normal), (4.0, DVec3::Z, DVec3::Z));
//! assert!(!world.occluded(&at.spawn(DVec3::new(0.0, 1.0, 0.1))));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Ask a k-d tree
//!
//! A [`KdTree`] serves anything that has boxes. It hands out what a ray may meet, near before far, and leaves
//! to the caller what is hit.
//!
//! ```
//! use lancer_core::accel::{Aabb, KdSettings, KdTree, Primitives};
//! use lancer_core::geometry::{DVec3, Ray};
//!
//! /// Unit cubes in a row, at x = 0, 2, 4, ...
//! struct Row(u32);
//!
//! impl Primitives for Row {
//!     fn count(&self) -> usize {
//!         self.0 as usize
//!     }
//!     fn bounds(&self, cube: u32) -> Aabb {
//!         let x = 2.0 * cube as f32;
//!         Aabb { min: [x, 0.0, 0.0], max: [x + 1.0, 1.0, 1.0] }
//!     }
//! }
//!
//! let tree = KdTree::build(&Row(100), KdSettings { leaf: Some(1), depth: None })?;
//! assert_eq!(tree.validate(100), Ok(()));
//!
//! // Up through the cube number 7: the only one that the tree offers.
//! let ray = Ray::new(DVec3::new(14.5, -3.0, 0.5), DVec3::Y);
//! let mut candidates = Vec::new();
//! tree.visit_leaves(&ray, |leaf| {
//!     candidates.extend_from_slice(leaf);
//!     ray.t_max
//! });
//! assert_eq!(candidates, [7]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! More, as whole programs, is in this crate's `examples` and in the guide's chapter on the library.
//!
//! [`World::intersect`]: world::World::intersect
//! [`World::intersection`]: world::World::intersection
//! [`World::occluded`]: world::World::occluded
//! [`Whitted::radiance`]: integrator::Whitted::radiance
//! [`Listener`]: integrator::Listener
//! [`KdTree`]: accel::KdTree

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
