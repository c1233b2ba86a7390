//! Models of formats other than OBJ and PLY, as users have them, and as nobody should.

mod archive;
mod common;
mod gltf;
mod off;
mod stl;
mod three_mf;
