//! The live picture: what the viewport asks of the worker, and what it shows of the answers.

use super::Selection;
use super::perform::objects_of;
use crate::document::Document;
use crate::navigation::Navigator;
use crate::overlay::{self, OverlayInput, OverlayOptions};
use crate::picture::PictureTexture;
use crate::worker::{Channel, Frame, ViewRequest, Worker};
use eframe::egui::{ColorImage, Context, TextureHandle, TextureOptions};
use lancer_core::film::{Image, Tone};
use lancer_core::geometry::DVec3;
use lancer_core::scene::{Scene, Settings};
use lancer_core::world::CompileOptions;
use std::sync::Arc;

/// The live picture.
pub(crate) struct Live {
    /// What of the scene is shown.
    pub(crate) channel: Channel,
    /// Columns and rows of the picture, in physical pixels; zero before the first layout.
    pub(crate) size: (u32, u32),
    /// Until when, in the window's time, wheels and keys that have no release count as motion.
    moving_until: f64,
    asked: Option<ViewRequest>,
    shown: Option<Shown>,
    overlay: Option<DrawnOverlay>,
}

/// The newest frame.
struct Shown {
    frame: Frame,
    serial: u64,
    tone: Tone,
    /// The mean of its linear values, as they are shown.
    brightness: f32,
    texture: PictureTexture,
}

/// The overlay that was drawn last, and of what.
struct DrawnOverlay {
    of: OverlayKey,
    texture: TextureHandle,
}

/// What decides an overlay, beside the frame that its number stands for.
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct OverlayKey {
    pub(crate) options: OverlayOptions,
    pub(crate) selection: Selection,
    pub(crate) interest: DVec3,
    pub(crate) dark: bool,
    pub(crate) pixels_per_point: f32,
    pub(crate) frame: u64,
}

/// Directions at each point where only the ambient occlusion is to be seen and the scene asks for none.
const OCCLUSION_SAMPLES: u32 = 64;

/// Seconds after the last turn of a wheel until the picture may be refined: about the pause between two turns.
const WHEEL_PAUSE: f64 = 0.2;

/// Linear brightness below which a picture counts as dark: sRGB's middle, about.
const DARK: f32 = 0.2;

impl Default for Live {
    fn default() -> Self {
        Self {
            channel: Channel::Picture,
            size: (0, 0),
            moving_until: 0.0,
            asked: None,
            shown: None,
            overlay: None,
        }
    }
}

impl Live {
    /// Forgets the scene that was shown; its last picture stays until there is another.
    pub(crate) fn forget_request(&mut self) {
        self.asked = None;
    }

    /// The newest frame.
    pub(crate) fn frame(&self) -> Option<&Frame> {
        self.shown.as_ref().map(|shown| &shown.frame)
    }

    /// The newest frame's texture.
    pub(crate) fn texture(&self) -> Option<&PictureTexture> {
        self.shown.as_ref().map(|shown| &shown.texture)
    }

    /// Whether the picture shown is the one that was asked for last, to its full settings.
    pub(crate) fn is_final(&self) -> bool {
        self.asked.as_ref().is_some_and(|asked| !asked.moving)
            && self.frame().is_some_and(|frame| frame.is_final && self.fits(frame))
    }

    fn fits(&self, frame: &Frame) -> bool {
        self.asked.as_ref().is_some_and(|asked| {
            frame.revision == asked.revision
                && frame.camera == asked.camera
                && (frame.width, frame.height) == (asked.settings.width, asked.settings.height)
        })
    }

    /// Counts as moving for as long as wheels and keys usually pause.
    pub(crate) fn nudged(&mut self, ctx: &Context) {
        self.moving_until = ctx.input(|input| input.time) + WHEEL_PAUSE;
    }

    /// Asks the worker for the picture of this moment, unless it was the last that was asked for.
    pub(crate) fn ask(
        &mut self,
        ctx: &Context,
        worker: &Worker,
        document: &Document,
        navigator: &Navigator,
        options: CompileOptions,
        threads: usize,
    ) {
        let (width, height) = self.size;
        if width == 0 || height == 0 {
            return;
        }
        let rest = self.moving_until - ctx.input(|input| input.time);
        if rest > 0.0 {
            ctx.request_repaint_after_secs(rest as f32);
        }
        let scene = document.scene();
        let mut settings = Settings { width, height, ..scene.settings };
        if self.channel == Channel::Occlusion && settings.ao.samples == 0 {
            settings.ao.samples = OCCLUSION_SAMPLES;
        }
        let request = ViewRequest {
            scene: Arc::clone(scene),
            revision: document.revision(),
            options,
            threads,
            camera: navigator.camera(),
            settings,
            channel: self.channel,
            moving: navigator.is_active() || rest > 0.0,
        };
        let same = self.asked.as_ref().is_some_and(|asked| is_same(asked, &request));
        if !same {
            worker.view(request.clone());
            self.asked = Some(request);
        }
    }

    /// Shows a frame.
    pub(crate) fn show(&mut self, ctx: &Context, frame: Frame, tone: Tone) {
        let (previous, serial) = match self.shown.take() {
            Some(shown) => (Some(shown.texture), shown.serial + 1),
            None => (None, 0),
        };
        let tone = self.tone_of(tone);
        let brightness = brightness(&frame.image, tone);
        let texture = PictureTexture::new(ctx, &frame.image, tone, true, previous);
        self.shown = Some(Shown { frame, serial, tone, brightness, texture });
    }

    /// Shows the frame in another tone, which asks nothing of the worker.
    pub(crate) fn expose(&mut self, ctx: &Context, tone: Tone) {
        let tone = self.tone_of(tone);
        if let Some(shown) = self.shown.take_if(|shown| shown.tone != tone) {
            let brightness = brightness(&shown.frame.image, tone);
            let texture = PictureTexture::new(ctx, &shown.frame.image, tone, true, Some(shown.texture));
            self.shown = Some(Shown { tone, brightness, texture, ..shown });
        }
    }

    /// Whether bright lines show better on the picture than dark ones.
    pub(crate) fn is_dark(&self) -> bool {
        self.shown.as_ref().is_none_or(|shown| shown.brightness < DARK)
    }

    /// Tone is for radiance: depths and normals are shown as they are.
    pub(crate) fn tone_of(&self, tone: Tone) -> Tone {
        if self.channel == Channel::Picture { tone } else { Tone::default() }
    }

    /// The overlay of the newest frame; drawn again only where something in it changed.
    pub(crate) fn overlay(
        &mut self,
        ctx: &Context,
        scene: &Scene,
        key: OverlayKey,
    ) -> Option<&TextureHandle> {
        let shown = self.shown.as_ref()?;
        let key = OverlayKey { frame: shown.serial, ..key };
        if self.overlay.as_ref().is_none_or(|drawn| drawn.of != key) {
            let frame = &shown.frame;
            let image = overlay::draw(&OverlayInput {
                world: &frame.world,
                features: &frame.features,
                camera: &frame.camera,
                width: frame.width,
                height: frame.height,
                options: &key.options,
                selected: &objects_of(scene, key.selection, &frame.world),
                selected_light: match key.selection {
                    Selection::Light(index) => Some(index),
                    _ => None,
                },
                interest: key.interest,
                pixels_per_point: key.pixels_per_point,
                dark: key.dark,
            });
            let size = [image.width as usize, image.height as usize];
            let pixels = ColorImage::from_rgba_premultiplied(size, image.pixels.as_flattened());
            let texture = match self.overlay.take() {
                Some(DrawnOverlay { mut texture, .. }) => {
                    texture.set(pixels, TextureOptions::LINEAR);
                    texture
                }
                None => ctx.load_texture("overlay", pixels, TextureOptions::LINEAR),
            };
            self.overlay = Some(DrawnOverlay { of: key, texture });
        }
        self.overlay.as_ref().map(|drawn| &drawn.texture)
    }
}

/// The mean light that a screen gives off for some of an image's pixels.
fn brightness(image: &Image, tone: Tone) -> f32 {
    let some = image.pixels().iter().step_by(image.pixels().len().div_ceil(4096));
    let value = |&pixel: &[f32; 3]| tone.light(pixel).iter().sum::<f32>() / 3.0;
    let count = some.len() as f32;
    some.map(value).sum::<f32>() / count
}

fn is_same(a: &ViewRequest, b: &ViewRequest) -> bool {
    Arc::ptr_eq(&a.scene, &b.scene)
        && (a.revision, a.options, a.threads, a.camera, a.settings, a.channel, a.moving)
            == (b.revision, b.options, b.threads, b.camera, b.settings, b.channel, b.moving)
}
