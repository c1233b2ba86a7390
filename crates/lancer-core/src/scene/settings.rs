//! What to render: the numbers that an author chooses and a user overrides.

/// Ambient occlusion: N and D of the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AmbientOcclusion {
    /// N: directions on the whole sphere, for each point that is shaded; 0 turns it off.
    pub samples: u32,
    /// D: how far geometry occludes, in world units.
    pub distance: f64,
}

impl Default for AmbientOcclusion {
    fn default() -> Self {
        Self { samples: 0, distance: 1.0 }
    }
}

/// The settings that decide what every pixel equals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// n: each pixel is the mean of n x n subpixels.
    pub samples: u32,
    /// How many reflections and refractions follow one another; 0 is local illumination alone.
    pub depth: u32,
    /// Ambient occlusion.
    pub ao: AmbientOcclusion,
    /// Whether what stands before a light hides it; without, v_i is 1.
    pub shadows: bool,
    /// Whether L_r is traced; without, it is 0.
    pub reflection: bool,
    /// Whether L_t is traced; without, it is 0.
    pub refraction: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            width: 800,
            height: 600,
            samples: 1,
            depth: 5,
            ao: AmbientOcclusion::default(),
            shadows: true,
            reflection: true,
            refraction: true,
        }
    }
}

/// A setting outside of its range.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SettingsError {
    /// A side of the image is 0 or too long.
    #[error("the {side} is {found}, must be 1 to {}", Settings::MAX_SIDE)]
    Side {
        /// `width` or `height`.
        side: &'static str,
        /// The value found.
        found: u32,
    },
    /// The image has too many pixels.
    #[error("{width} x {height} is more than {} pixels", Settings::MAX_PIXELS)]
    Pixels {
        /// Pixels in a row.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// `samples` is 0 or too large.
    #[error("samples is {found}, must be 1 to {}", Settings::MAX_SAMPLES)]
    Samples {
        /// The value found.
        found: u32,
    },
    /// `depth` is too large.
    #[error("depth is {found}, must be 0 to {}", Settings::MAX_DEPTH)]
    Depth {
        /// The value found.
        found: u32,
    },
    /// `ao.samples` is too large.
    #[error("ao.samples is {found}, must be 0 to {}", Settings::MAX_AO_SAMPLES)]
    AoSamples {
        /// The value found.
        found: u32,
    },
    /// `ao.distance` is not above 0.
    #[error("ao.distance is {found}, must be above 0")]
    AoDistance {
        /// The value found.
        found: f64,
    },
}

impl Settings {
    /// The longest side of an image.
    pub const MAX_SIDE: u32 = 65_535;
    /// The most pixels of an image: 3 GiB of film at 12 bytes each.
    pub const MAX_PIXELS: u64 = 1 << 28;
    /// The most subpixels along a pixel's side.
    pub const MAX_SAMPLES: u32 = 64;
    /// The deepest recursion.
    pub const MAX_DEPTH: u32 = 100_000;
    /// The most directions of ambient occlusion at a point.
    pub const MAX_AO_SAMPLES: u32 = 1 << 16;

    /// Checks every range, before anything is allocated.
    ///
    /// # Errors
    /// The first setting that is out of its range.
    pub fn validate(&self) -> Result<(), SettingsError> {
        for (side, found) in [("width", self.width), ("height", self.height)] {
            if !(1..=Self::MAX_SIDE).contains(&found) {
                return Err(SettingsError::Side { side, found });
            }
        }
        if u64::from(self.width) * u64::from(self.height) > Self::MAX_PIXELS {
            return Err(SettingsError::Pixels { width: self.width, height: self.height });
        }
        if !(1..=Self::MAX_SAMPLES).contains(&self.samples) {
            return Err(SettingsError::Samples { found: self.samples });
        }
        if self.depth > Self::MAX_DEPTH {
            return Err(SettingsError::Depth { found: self.depth });
        }
        if self.ao.samples > Self::MAX_AO_SAMPLES {
            return Err(SettingsError::AoSamples { found: self.ao.samples });
        }
        if self.ao.distance.is_nan() || self.ao.distance <= 0.0 {
            return Err(SettingsError::AoDistance { found: self.ao.distance });
        }
        Ok(())
    }
}
