//! Models of formats other than OBJ and PLY, as users have them, and as nobody should.

mod common;
mod off;
mod stl;
