//! How a picture was made, written into the picture so that it can be made again.
//!
//! In: a scene and what was asked of it. Out: a [`Provenance`], and its text: JSON on one line of ASCII, which every
//! format can carry that carries metadata. It names files without their directories, and no user, machine or time.
//!
//! What decides the pixels of a picture is recorded in two ways. Settings, tone, region, overrides and encoding
//! are recorded as they are. The scene is recorded by its name and by its [`SceneHash`]: over all of its geometry,
//! materials, textures and lights and over the camera, overrides applied. Two pictures with the same hash, record and
//! version have the same bytes.

mod hash;

pub use hash::SceneHash;

use crate::image::{Compression, Encoding, EncodingChoice, ImageFormat, Metadata, Window};
use crate::scene_file::Override;
use lancer_core::camera::Camera;
use lancer_core::film::{Tone, ToneCurve};
use lancer_core::geometry::DVec3;
use lancer_core::scene::{AmbientOcclusion, Settings};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::ser::Formatter;
use std::io;

/// Where a scene comes from.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SceneSource {
    /// A built-in scene, by its name.
    Builtin(String),
    /// A scene file or a model, by its name without its directory.
    File(String),
}

/// How a picture was made.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    /// The version of the program.
    pub lancer: String,
    /// Where the scene comes from.
    pub scene: SceneSource,
    /// What the scene calls itself; may be empty.
    pub name: String,
    /// What the scene was.
    pub hash: SceneHash,
    /// The named camera that took the picture; none for the main one.
    pub camera: Option<String>,
    /// The part of the picture that there is: x, y, width and height.
    pub region: Option<[u32; 4]>,
    /// What was rendered.
    #[serde(with = "SettingsRecord")]
    pub render: Settings,
    /// How radiance became pixels.
    #[serde(with = "ToneRecord")]
    pub tone: Tone,
    /// The overrides of what the scene says, as in `camera.fov=60`.
    pub set: Vec<String>,
    /// The paths of overrides that are not in `set`, since they name files by where they are.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub unrecorded: Vec<String>,
    /// How the pixels became a file.
    #[serde(with = "EncodingRecord")]
    pub encoding: Encoding,
    /// Pixels to the inch in print.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dpi: Option<u16>,
    /// The passes whose layers lie beside the picture, by their names.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub passes: Vec<String>,
    /// The pass whose layer lies in the picture's place, by its name.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pass: Option<String>,
}

/// A text says nothing of how a picture was made.
#[derive(Debug, thiserror::Error)]
#[error("its record of how it was made cannot be read: {0}")]
pub struct ProvenanceError(#[from] serde_json::Error);

impl Provenance {
    /// The version of this program.
    pub const VERSION: &str = env!("CARGO_PKG_VERSION");

    /// The record as JSON on one line of ASCII.
    pub fn to_text(&self) -> String {
        let mut bytes = Vec::new();
        let mut serializer = serde_json::Serializer::with_formatter(&mut bytes, Ascii);
        self.serialize(&mut serializer).expect("a record has only text for keys, and memory can be written");
        bytes.into_iter().map(char::from).collect()
    }

    /// What a file says beside its pixels, of which this record is the larger part.
    pub fn metadata(&self) -> Metadata {
        Metadata {
            software: format!("Lancer {}", self.lancer),
            title: self.name.clone(),
            provenance: Some(self.to_text()),
            dpi: self.dpi,
            window: self.region.map(|[x, y, ..]| {
                let Settings { width, height, .. } = self.render;
                Window { x, y, width, height }
            }),
        }
    }

    /// The record of a text.
    ///
    /// # Errors
    /// The text is none of [`Provenance::to_text`]; numbers may be any, and are to be checked.
    pub fn from_text(text: &str) -> Result<Self, ProvenanceError> {
        Ok(serde_json::from_str(text)?)
    }
}

/// The overrides that can be recorded, and the paths of those that cannot: a value that may name a directory would
/// tell where its user keeps things.
pub fn record_overrides(overrides: &[Override]) -> (Vec<String>, Vec<String>) {
    let texts = overrides.iter().map(|edit| edit.to_string().trim_start_matches("--set ").to_owned());
    let (unrecorded, set) = texts.partition::<Vec<_>, _>(|text| names_a_place(text));
    let path_of = |text: String| text.split('=').next().unwrap_or_default().to_owned();
    (set, unrecorded.into_iter().map(path_of).collect())
}

/// A camera as overrides of the scene's own, every bit of it.
pub fn camera_overrides(camera: &Camera) -> Vec<String> {
    let vector = |DVec3 { x, y, z }: DVec3| format!("[{x}, {y}, {z}]");
    let Camera { eye, target, up, fov } = *camera;
    vec![
        format!("camera.eye={}", vector(eye)),
        format!("camera.target={}", vector(target)),
        format!("camera.up={}", vector(up)),
        format!("camera.fov={fov}"),
    ]
}

/// Whether a text may hold an absolute path, or one of a home.
fn names_a_place(text: &str) -> bool {
    let is_start = |before: Option<char>| before.is_none_or(|c| !c.is_alphanumeric() && !"._-)".contains(c));
    let mut before = None;
    text.chars().any(|c| {
        let found = c == '\\' || ((c == '/' || c == '~') && is_start(before));
        before = Some(c);
        found
    })
}

/// JSON without letters beyond ASCII.
struct Ascii;

impl Formatter for Ascii {
    fn write_string_fragment<W: ?Sized + io::Write>(
        &mut self,
        writer: &mut W,
        fragment: &str,
    ) -> io::Result<()> {
        fragment.chars().try_for_each(|c| {
            if c.is_ascii() && !c.is_ascii_control() {
                return writer.write_all(&[c as u8]);
            }
            c.encode_utf16(&mut [0; 2]).iter().try_for_each(|unit| write!(writer, "\\u{unit:04x}"))
        })
    }
}

/// [`Settings`] as they are written.
#[derive(Serialize, Deserialize)]
struct SettingsRecord {
    width: u32,
    height: u32,
    samples: u32,
    depth: u32,
    ao: u32,
    /// As text: JSON has no infinity.
    ao_distance: String,
    shadows: bool,
    reflection: bool,
    refraction: bool,
}

impl SettingsRecord {
    fn serialize<S: Serializer>(settings: &Settings, serializer: S) -> Result<S::Ok, S::Error> {
        let Settings { width, height, samples, depth, ao, shadows, reflection, refraction } = *settings;
        let AmbientOcclusion { samples: ao, distance } = ao;
        let ao_distance = distance.to_string();
        let record = Self { width, height, samples, depth, ao, ao_distance, shadows, reflection, refraction };
        Serialize::serialize(&record, serializer)
    }

    fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Settings, D::Error> {
        let Self { width, height, samples, depth, ao, ao_distance, shadows, reflection, refraction } =
            Deserialize::deserialize(deserializer)?;
        let ao = AmbientOcclusion { samples: ao, distance: number(&ao_distance)? };
        Ok(Settings { width, height, samples, depth, ao, shadows, reflection, refraction })
    }
}

fn number<E: serde::de::Error>(text: &str) -> Result<f64, E> {
    text.parse().map_err(|_| E::custom(format!("`{text}` is no number")))
}

/// [`Tone`] as it is written.
#[derive(Serialize, Deserialize)]
struct ToneRecord {
    exposure: f64,
    curve: String,
}

impl ToneRecord {
    fn serialize<S: Serializer>(tone: &Tone, serializer: S) -> Result<S::Ok, S::Error> {
        let record = Self { exposure: tone.exposure, curve: tone.curve.name().to_owned() };
        Serialize::serialize(&record, serializer)
    }

    fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Tone, D::Error> {
        let Self { exposure, curve } = Deserialize::deserialize(deserializer)?;
        let unknown = || serde::de::Error::custom(format!("there is no tone curve `{curve}`"));
        if exposure.abs() > Tone::MAX_EXPOSURE {
            return Err(serde::de::Error::custom(format!("{exposure} is no exposure")));
        }
        Ok(Tone { exposure, curve: ToneCurve::from_name(&curve).ok_or_else(unknown)? })
    }
}

/// [`Encoding`] as it is written.
#[derive(Serialize, Deserialize)]
struct EncodingRecord {
    format: String,
    bits: u8,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    compression: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    quality: Option<u8>,
}

impl EncodingRecord {
    fn serialize<S: Serializer>(encoding: &Encoding, serializer: S) -> Result<S::Ok, S::Error> {
        let record = Self {
            format: encoding.format().name().to_owned(),
            bits: encoding.bits(),
            compression: encoding.compression().map(|compression| compression.name().to_owned()),
            quality: encoding.quality(),
        };
        Serialize::serialize(&record, serializer)
    }

    fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Encoding, D::Error> {
        let Self { format, bits, compression, quality } = Deserialize::deserialize(deserializer)?;
        let unknown = |what: &str| serde::de::Error::custom(format!("`{what}` is unknown"));
        let compression = match compression {
            None => None,
            Some(name) => Some(Compression::from_name(&name).ok_or_else(|| unknown(&name))?),
        };
        let format = ImageFormat::from_name(&format).ok_or_else(|| unknown(&format))?;
        let choice = EncodingChoice { bits: Some(bits), compression, quality };
        Encoding::new(format, choice).map_err(serde::de::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lancer_core::scene::Scene;

    fn record() -> Provenance {
        Provenance {
            lancer: "0.1.0".into(),
            scene: SceneSource::File("Bâtiment \"é\" \u{1f600}\n.yaml".into()),
            name: "été".into(),
            hash: SceneHash::of(&Scene::new("a"), &Camera::default()),
            camera: Some("top".into()),
            region: Some([1, 2, 3, 4]),
            render: Settings {
                ao: AmbientOcclusion { samples: 16, distance: f64::INFINITY },
                shadows: false,
                ..Settings::default()
            },
            tone: Tone { exposure: 0.1 + 0.2, curve: ToneCurve::Filmic },
            set: vec!["camera.fov=60".into()],
            unrecorded: Vec::new(),
            encoding: Encoding::from(ImageFormat::Exr),
            dpi: Some(300),
            passes: vec!["ambient".into(), "light.key".into()],
            pass: None,
        }
    }

    #[test]
    fn a_record_is_read_as_it_was_written() {
        let record = record();
        let text = record.to_text();
        assert_eq!(Provenance::from_text(&text).unwrap(), record);
    }

    #[test]
    fn the_text_is_one_line_of_ascii() {
        assert!(record().to_text().bytes().all(|byte| matches!(byte, b' '..=b'~')));
    }

    #[test]
    fn what_is_no_record_is_told_and_numbers_out_of_range_are_refused() {
        let text = record().to_text();
        for (old, new) in [("exr", "gif"), ("filmic", "cartoon"), ("sha256:", "md5:"), ("\"inf\"", "\"far\"")]
        {
            assert!(text.contains(old), "{old}");
            assert!(Provenance::from_text(&text.replace(old, new)).is_err(), "{new}");
        }
        for wrong in ["", "{}", "[]", "null", &text[1..]] {
            assert!(Provenance::from_text(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn overrides_that_name_a_place_are_not_recorded() {
        let edit = |text: &str| text.parse::<Override>().unwrap();
        let kept = ["camera.fov=60", "render.tone=raw", "materials.a/b.ior=2", "assets.a=sub/b.obj"];
        let left_out = [
            "assets.a=/home/somebody/b.obj",
            "assets.a=~/b.obj",
            "objects.0.shape={mesh: \"/home/some body/b.obj\"}",
            "assets.a=C:\\b.obj",
            "assets.a=file:///b.obj",
        ];
        let overrides = kept.iter().chain(&left_out).map(|text| edit(text)).collect::<Vec<_>>();
        let (set, unrecorded) = record_overrides(&overrides);
        assert_eq!(set, kept);
        assert_eq!(unrecorded, ["assets.a", "assets.a", "objects.0.shape", "assets.a", "assets.a"]);
    }
}
