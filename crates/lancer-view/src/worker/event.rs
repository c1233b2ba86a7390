//! What the worker tells.

use super::{RenderId, RenderRequest};
use crate::Source;
use lancer_core::camera::Camera;
use lancer_core::film::Image;
use lancer_core::integrator::RayCounts;
use lancer_core::render::{Feature, Features, Tile, feature_at};
use lancer_core::world::World;
use lancer_io::diagnostics::LoadError;
use lancer_io::{LoadOptions, Loaded};
use std::sync::Arc;
use std::time::Duration;

/// News from the worker, in the order in which it came.
#[derive(Debug)]
pub enum Event {
    /// A scene is being opened, and how far that is.
    Opening {
        /// Which.
        source: Source,
        /// What is done with it.
        stage: OpenStage,
    },
    /// A scene is ready to be shown.
    Opened(Box<Opened>),
    /// A scene cannot be shown. What was shown stays.
    OpenFailed {
        /// Which.
        source: Source,
        /// All that is wrong with it.
        error: LoadError,
    },
    /// A scene is no longer being opened, because [`Worker::cancel_open`](super::Worker::cancel_open) asked so.
    OpenCancelled {
        /// Which.
        source: Source,
    },
    /// A better or newer image for the viewport. Only the newest waits to be taken.
    Frame(Box<Frame>),
    /// The viewport cannot show what was asked for; it waits for another request.
    ViewFailed {
        /// Why, for a person to read.
        message: String,
    },
    /// A render has begun.
    RenderStarted(RenderId),
    /// A render has come further. What waits to be taken is joined into one.
    RenderProgress(RenderId, Progress),
    /// A render is done.
    RenderDone(Box<Rendered>),
    /// A render has ended without a picture.
    RenderFailed {
        /// Which.
        id: RenderId,
        /// Why.
        error: RenderFault,
    },
}

/// How far the opening of a scene is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OpenStage {
    /// Its files are read, or its code runs.
    Reading,
    /// Its trees are built.
    Building,
}

/// A scene that was opened.
#[derive(Debug)]
pub struct Opened {
    /// Where it comes from.
    pub source: Source,
    /// How it was read, to read it again.
    pub options: LoadOptions,
    /// The scene, and what is odd about it.
    pub loaded: Loaded,
    /// The scene compiled as the view compiles. The first view of the scene takes its trees from here.
    pub world: Arc<World>,
    /// How long it took to read and build.
    pub seconds: f64,
}

/// An image for the viewport.
#[derive(Clone, Debug)]
pub struct Frame {
    /// The image, linear; smaller than the viewport in all passes but the last.
    pub image: Image,
    /// What its pixels show; of the image's size or larger.
    pub features: Arc<Features>,
    /// What was traced.
    pub world: Arc<World>,
    /// From where.
    pub camera: Camera,
    /// The revision that was asked for.
    pub revision: u64,
    /// Pixels in a row of the viewport that was asked for.
    pub width: u32,
    /// Rows of the viewport that was asked for.
    pub height: u32,
    /// Which pass, from 0.
    pub pass: u32,
    /// How many passes there are likely to be.
    pub passes: u32,
    /// Whether the image is the one at full settings, after which nothing more comes.
    pub is_final: bool,
    /// The part of the last pass that is done, 0 to 1.
    pub tiles_done: f32,
    /// The rays that this pass took so far.
    pub rays: RayCounts,
    /// How long this pass took so far.
    pub seconds: f64,
}

/// How far a render is.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress {
    /// The part of the pixels that is done, 0 to 1.
    pub done: f32,
    /// The rays so far.
    pub rays: RayCounts,
    /// Since tracing began.
    pub elapsed: Duration,
    /// What was finished since the progress that was told before: [`Image::put`] it into an image of the
    /// render's size. So a large film is never copied as a whole.
    pub tiles: Vec<Tile>,
}

/// A finished render.
#[derive(Debug)]
pub struct Rendered {
    /// Which.
    pub id: RenderId,
    /// What was asked for.
    pub request: RenderRequest,
    /// The picture, linear.
    pub image: Image,
    /// What was traced.
    pub world: Arc<World>,
    /// The rays that it took.
    pub rays: RayCounts,
    /// How long tracing took.
    pub elapsed: Duration,
}

impl Rendered {
    /// What the picture shows in the middle of a pixel: traced when asked for, since keeping it for all pixels
    /// would take several times the memory of the picture.
    pub fn feature_at(&self, x: u32, y: u32) -> Option<Feature> {
        let (width, height) = (self.image.width(), self.image.height());
        let (x, y) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
        // A camera that made the picture is a good one.
        feature_at(&self.world, &self.request.camera, width, height, x, y).ok().flatten()
    }
}

/// Why a render ended without a picture.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RenderFault {
    /// It was cancelled, or another took its place.
    #[error("the render was cancelled")]
    Cancelled,
    /// Something is wrong with the scene, the camera or the settings, or a bug.
    #[error("{0}")]
    Message(String),
}
