//! What a user may choose of how models are read.

/// How a model is read where its file leaves a choice.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ModelOptions {
    /// Up to which angle faces without normals are smoothed, whatever the file says of smoothing; without one, as
    /// the format's users expect.
    pub crease: Option<Crease>,
}

/// The angle between two faces up to which the edge that they share is smooth, and beyond which it is sharp.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Crease(f64);

impl Crease {
    /// No edge is smooth: facets.
    pub const FACETS: Self = Self(0.0);

    /// Every edge is smooth.
    pub const SMOOTH: Self = Self(180.0);

    /// What most models look right with. Below about 30 degrees, coarse scans and cylinders of ten sides get facets;
    /// from 45 on, chamfers melt into the faces beside them.
    pub const DEFAULT: Self = Self(40.0);

    /// A crease angle in degrees, from 0 to 180; `None` for any other number.
    pub fn from_degrees(degrees: f64) -> Option<Self> {
        (0.0..=180.0).contains(&degrees).then_some(Self(degrees))
    }

    /// The angle in degrees.
    pub fn degrees(self) -> f64 {
        self.0
    }
}
