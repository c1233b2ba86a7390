//! Points, directions, rays, boxes and transforms, and the bounds on their rounding errors.
//!
//! Everything is `f64`: a scene may lie 10,000 units from the origin and still be a thousandth of a unit
//! wide. This room knows nothing of scenes, materials or lights.

mod bounds;
pub mod error;
mod fan;
pub(crate) mod packet;
pub mod portable;
mod ray;
mod transform;

pub use bounds::Bounds;
pub use fan::DirectionFan;
pub use glam::{DAffine3, DMat3, DVec2, DVec3};
pub use packet::{RayPacket, Vectors};
pub use ray::Ray;
pub use transform::{Placement, SingularTransform, Transform};
