//! Cameras, lights and render settings.

use super::channels::Channels;
use super::number::{Exposure, FieldOfView, NotNegative, Number, Positive, Whole};
use super::transform::Vector;
use crate::scene_file::deserialize::{Forms, deserialize_by_forms};
use lancer_core::camera::{Camera, CameraError};
use lancer_core::film::{Tone, ToneCurve};
use lancer_core::scene::{AmbientOcclusion, Settings, SettingsError};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde::de::Unexpected;
use std::borrow::Cow;

/// A perspective camera, in the world.
#[derive(Default, Deserialize, JsonSchema)]
#[serde(try_from = "CameraFields")]
#[schemars(with = "CameraFields", rename = "Camera")]
pub(crate) struct CameraFile(pub(crate) Camera);

/// A camera as written, whose fields may not agree with each other.
#[derive(Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
struct CameraFields {
    /// Where it stands; default [0, 0, 5].
    eye: Vector,
    /// What it looks at: the centre of the image; default the origin.
    target: Vector,
    /// The direction that is up in the image; default +Y.
    up: Vector,
    /// The vertical angle of view in degrees; default 40.
    fov: Number<FieldOfView>,
}

impl Default for CameraFields {
    fn default() -> Self {
        let Camera { eye, target, up, fov } = Camera::default();
        Self { eye: Vector(eye), target: Vector(target), up: Vector(up), fov: Number::default_of(fov) }
    }
}

impl TryFrom<CameraFields> for CameraFile {
    type Error = CameraError;

    fn try_from(fields: CameraFields) -> Result<Self, CameraError> {
        let camera =
            Camera { eye: fields.eye.0, target: fields.target.0, up: fields.up.0, fov: fields.fov.get() };
        camera.frame().map(|_| Self(camera))
    }
}

/// A point light; at the distance r it gives `intensity` / (pi r^2).
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Light")]
pub(crate) struct LightFile {
    /// What you call the light.
    #[serde(default)]
    pub(crate) name: String,
    /// Where it is, in the world.
    pub(crate) position: Vector,
    /// L_i: one number for grey, or red, green and blue.
    pub(crate) intensity: Channels<NotNegative>,
}

/// What to render.
#[derive(Default, Deserialize, JsonSchema)]
#[serde(try_from = "RenderFields")]
#[schemars(with = "RenderFields", rename = "Render")]
pub(crate) struct RenderFile {
    pub(crate) settings: Settings,
    pub(crate) tone: Tone,
}

type Side = Whole<1, { Settings::MAX_SIDE as u64 }>;
type Samples = Whole<1, { Settings::MAX_SAMPLES as u64 }>;
type Depth = Whole<0, { Settings::MAX_DEPTH as u64 }>;
type OcclusionSamples = Whole<0, { Settings::MAX_AO_SAMPLES as u64 }>;

/// Settings as written, which together may ask for too much.
#[derive(Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
struct RenderFields {
    /// Pixels in a row; default 800.
    width: Side,
    /// Rows; default 600.
    height: Side,
    /// n: each pixel is the mean of n x n subpixels; default 1.
    samples: Samples,
    /// How many reflections and refractions follow one another; default 5.
    depth: Depth,
    /// Ambient occlusion; default off.
    ao: OcclusionFields,
    /// Whether what stands before a light hides it; default true.
    shadows: bool,
    /// Whether mirror images are seen; default true.
    reflection: bool,
    /// Whether one sees through what transmits; default true.
    refraction: bool,
    /// How much brighter the picture is made, in stops: one doubles it, -1 halves it; default 0.
    exposure: Number<Exposure>,
    /// How what is brighter than a display is shown, in files for displays; default linear, which cuts it.
    tone: ToneFile,
}

/// A tone curve, by its name.
#[derive(Default)]
struct ToneFile(ToneCurve);

impl Forms for ToneFile {
    const FORMS: &'static str = "linear, reinhard, filmic or raw";

    fn from_text<E: serde::de::Error>(text: &str) -> Result<Self, E> {
        ToneCurve::from_name(text)
            .map(Self)
            .ok_or_else(|| E::invalid_value(Unexpected::Str(text), &Self::FORMS))
    }
}

deserialize_by_forms!(ToneFile);

impl JsonSchema for ToneFile {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "Tone".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "string", "enum": ToneCurve::ALL.map(ToneCurve::name) })
    }
}

/// Ambient occlusion.
#[derive(Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(rename = "AmbientOcclusion")]
struct OcclusionFields {
    /// N: directions at each point; default 0, which turns it off.
    samples: OcclusionSamples,
    /// D: how far geometry occludes, in scene units; default 1.
    distance: Number<Positive>,
}

impl Default for RenderFields {
    fn default() -> Self {
        let Settings { width, height, samples, depth, ao: _, shadows, reflection, refraction } =
            Settings::default();
        Self {
            width: Whole::default_of(width),
            height: Whole::default_of(height),
            samples: Whole::default_of(samples),
            depth: Whole::default_of(depth),
            ao: OcclusionFields::default(),
            shadows,
            reflection,
            refraction,
            exposure: Number::default_of(Tone::default().exposure),
            tone: ToneFile::default(),
        }
    }
}

impl Default for OcclusionFields {
    fn default() -> Self {
        let AmbientOcclusion { samples, distance } = AmbientOcclusion::default();
        Self { samples: Whole::default_of(samples), distance: Number::default_of(distance) }
    }
}

impl TryFrom<RenderFields> for RenderFile {
    type Error = SettingsError;

    fn try_from(fields: RenderFields) -> Result<Self, SettingsError> {
        let settings = Settings {
            width: fields.width.get(),
            height: fields.height.get(),
            samples: fields.samples.get(),
            depth: fields.depth.get(),
            ao: AmbientOcclusion { samples: fields.ao.samples.get(), distance: fields.ao.distance.get() },
            shadows: fields.shadows,
            reflection: fields.reflection,
            refraction: fields.refraction,
        };
        let tone = Tone { exposure: fields.exposure.get(), curve: fields.tone.0 };
        settings.validate().map(|()| Self { settings, tone })
    }
}
