//! Model files as users have them, and as nobody should.

mod any_format;
mod archive;
mod common;
mod gltf;
mod mtl;
mod obj;
mod off;
mod ply;
mod smoothness;
mod stl;
mod three_mf;
