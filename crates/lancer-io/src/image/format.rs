//! Which formats images are written in, and what can be chosen of each.
//!
//! In: a name, and what a user chose. Out: an [`Encoding`] that can be written, or why there is none. It knows no
//! pixels.

use std::path::Path;

/// The formats that images are written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageFormat {
    /// PNG: 8 or 16 bits a channel, for display.
    Png,
    /// JPEG: 8 bits a channel, for display, with losses; colour is kept at full resolution (4:4:4).
    Jpeg,
    /// WebP: 8 bits a channel, for display, without losses.
    WebP,
    /// TIFF: 8 or 16 bits a channel, for display, or linear 32-bit floats.
    Tiff,
    /// Radiance HDR: linear, 8 bits a channel and a shared exponent.
    Hdr,
    /// Portable float map: linear 32-bit floats, and nothing else.
    Pfm,
    /// OpenEXR: linear 16- or 32-bit floats.
    Exr,
}

/// A file's name says no format that is written.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("images are written as {}, not as `{name}`", ImageFormat::extensions())]
pub struct UnknownImageFormat {
    /// The name.
    pub name: String,
}

impl ImageFormat {
    /// All of them.
    pub const ALL: [Self; 7] =
        [Self::Png, Self::Jpeg, Self::WebP, Self::Tiff, Self::Hdr, Self::Pfm, Self::Exr];

    /// The extensions that name them; the first is the usual one.
    pub const EXTENSIONS: [&str; 9] = ["png", "jpg", "jpeg", "webp", "tif", "tiff", "hdr", "pfm", "exr"];

    /// The format that a file's extension asks for, in any case.
    ///
    /// # Errors
    /// [`UnknownImageFormat`], which lists what is written.
    pub fn from_path(path: &Path) -> Result<Self, UnknownImageFormat> {
        let extension = path.extension().and_then(|extension| extension.to_str());
        extension
            .and_then(Self::from_name)
            .ok_or_else(|| UnknownImageFormat { name: path.display().to_string() })
    }

    /// The format of a name or an extension, in any case.
    pub fn from_name(name: &str) -> Option<Self> {
        match name.to_ascii_lowercase().as_str() {
            "jpg" => Some(Self::Jpeg),
            "tif" => Some(Self::Tiff),
            name => Self::ALL.into_iter().find(|format| format.name() == name),
        }
    }

    /// Its name, which is its extension too.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Jpeg => "jpeg",
            Self::WebP => "webp",
            Self::Tiff => "tiff",
            Self::Hdr => "hdr",
            Self::Pfm => "pfm",
            Self::Exr => "exr",
        }
    }

    /// Its name as people write it.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Png => "PNG",
            Self::Jpeg => "JPEG",
            Self::WebP => "WebP",
            Self::Tiff => "TIFF",
            Self::Hdr => "Radiance HDR",
            Self::Pfm => "PFM",
            Self::Exr => "OpenEXR",
        }
    }

    /// The bits of a channel that can be chosen, the usual ones first.
    pub const fn bits(self) -> &'static [u8] {
        match self {
            Self::Png => &[8, 16],
            Self::Jpeg | Self::WebP | Self::Hdr => &[8],
            Self::Tiff => &[8, 16, 32],
            Self::Pfm => &[32],
            Self::Exr => &[32, 16],
        }
    }

    /// The compressions that can be chosen, the usual one first.
    pub const fn compressions(self) -> &'static [Compression] {
        match self {
            Self::Exr => &[Compression::Zip, Compression::Piz, Compression::None],
            Self::Tiff => &[Compression::Zip, Compression::None],
            _ => &[],
        }
    }

    /// The longest side of a picture in this format.
    pub const fn max_side(self) -> u32 {
        match self {
            Self::WebP => 16_384,
            _ => 65_535,
        }
    }

    /// All extensions, as in `.png, .jpg or .exr`.
    fn extensions() -> String {
        let names = Self::EXTENSIONS.map(|extension| format!(".{extension}"));
        let (last, rest) = names.split_last().expect("there are formats");
        format!("{} or {last}", rest.join(", "))
    }
}

/// How the pixels are packed, where a format leaves a choice. None of them loses anything.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Compression {
    /// Not at all.
    None,
    /// By deflate: 16 lines at a time in OpenEXR, strips after a horizontal predictor in TIFF.
    Zip,
    /// By wavelets, which take less for grainy pictures; OpenEXR only.
    Piz,
}

impl Compression {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::None, Self::Zip, Self::Piz];

    /// Its name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Zip => "zip",
            Self::Piz => "piz",
        }
    }

    /// The compression of a name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|compression| compression.name() == name)
    }
}

/// What a user chose of an encoding; `None` leaves it to the format.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EncodingChoice {
    /// Bits a channel.
    pub bits: Option<u8>,
    /// How pixels are packed.
    pub compression: Option<Compression>,
    /// The quality of a JPEG, 1 to 100.
    pub quality: Option<u8>,
}

/// A format cannot be written as was chosen.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EncodingError {
    /// It has no channels of so many bits.
    #[error("{} has {} bits a channel, not {bits}", format.title(), any_of(format.bits()))]
    Bits {
        /// The format.
        format: ImageFormat,
        /// What was chosen.
        bits: u8,
    },
    /// It is not packed so.
    #[error("{} has no compression `{}`{}", format.title(), compression.name(), compression_hint(*format))]
    Compression {
        /// The format.
        format: ImageFormat,
        /// What was chosen.
        compression: Compression,
    },
    /// It has no losses to choose, or the number is no quality.
    #[error("{}", quality_message(*format, *quality))]
    Quality {
        /// The format.
        format: ImageFormat,
        /// What was chosen.
        quality: u8,
    },
    /// It has no such long sides.
    #[error("{} x {} is more than {} can hold: {} pixels a side", width, height, format.title(), format.max_side())]
    Size {
        /// The format.
        format: ImageFormat,
        /// Pixels in a row.
        width: u32,
        /// Rows.
        height: u32,
    },
}

fn any_of(choices: &[u8]) -> String {
    choices.iter().map(ToString::to_string).collect::<Vec<_>>().join(" or ")
}

fn compression_hint(format: ImageFormat) -> String {
    match format.compressions() {
        [] => ": there is nothing to choose".into(),
        some => format!(": choose {}", some.iter().map(|c| c.name()).collect::<Vec<_>>().join(" or ")),
    }
}

fn quality_message(format: ImageFormat, quality: u8) -> String {
    match format {
        ImageFormat::Jpeg => format!("the quality is {quality}, must be 1 to 100"),
        format => format!("{} has no quality to choose: it loses nothing to compression", format.title()),
    }
}

/// A format and all that is chosen of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Encoding {
    format: ImageFormat,
    bits: u8,
    compression: Option<Compression>,
    quality: Option<u8>,
}

impl From<ImageFormat> for Encoding {
    /// The format as it usually is.
    fn from(format: ImageFormat) -> Self {
        Self {
            format,
            bits: format.bits()[0],
            compression: format.compressions().first().copied(),
            quality: (format == ImageFormat::Jpeg).then_some(Self::USUAL_QUALITY),
        }
    }
}

impl Encoding {
    /// The quality of a JPEG for which none is chosen: no loss shows, in about a tenth of a PNG. Untuned.
    pub const USUAL_QUALITY: u8 = 92;

    /// A format with what was chosen of it.
    ///
    /// # Errors
    /// The format does not have it.
    pub fn new(format: ImageFormat, choice: EncodingChoice) -> Result<Self, EncodingError> {
        let usual = Self::from(format);
        if let Some(bits) = choice.bits.filter(|bits| !format.bits().contains(bits)) {
            return Err(EncodingError::Bits { format, bits });
        }
        if let Some(compression) = choice.compression.filter(|chosen| !format.compressions().contains(chosen))
        {
            return Err(EncodingError::Compression { format, compression });
        }
        let has_quality = format == ImageFormat::Jpeg;
        if let Some(quality) = choice.quality.filter(|chosen| !(has_quality && (1..=100).contains(chosen))) {
            return Err(EncodingError::Quality { format, quality });
        }
        Ok(Self {
            format,
            bits: choice.bits.unwrap_or(usual.bits),
            compression: choice.compression.or(usual.compression),
            quality: choice.quality.or(usual.quality),
        })
    }

    /// The format.
    pub fn format(self) -> ImageFormat {
        self.format
    }

    /// Bits a channel.
    pub fn bits(self) -> u8 {
        self.bits
    }

    /// How pixels are packed; `None` where the format leaves no choice.
    pub fn compression(self) -> Option<Compression> {
        self.compression
    }

    /// The quality of a JPEG.
    pub fn quality(self) -> Option<u8> {
        self.quality
    }

    /// Whether the file holds radiance, linear and unclamped, to which no tone curve is applied.
    pub fn is_linear(self) -> bool {
        match self.format {
            ImageFormat::Hdr | ImageFormat::Pfm | ImageFormat::Exr => true,
            ImageFormat::Tiff => self.bits == 32,
            ImageFormat::Png | ImageFormat::Jpeg | ImageFormat::WebP => false,
        }
    }

    /// Whether a picture of this size can be written so.
    ///
    /// # Errors
    /// [`EncodingError::Size`].
    pub fn check_size(self, width: u32, height: u32) -> Result<(), EncodingError> {
        if width.max(height) > self.format.max_side() {
            return Err(EncodingError::Size { format: self.format, width, height });
        }
        Ok(())
    }
}
