//! One scene a file.

pub mod glass;
pub mod highlights;
pub mod mirrors;
pub mod occlusion;
pub mod primitives;
pub mod shadows;
pub mod supersampling;
