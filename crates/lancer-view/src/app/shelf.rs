//! The renders that are kept side by side.

use super::making::Making;
use crate::Source;
use crate::picture::{ImageView, PictureTexture};
use crate::worker::{Progress, RenderId, Rendered};
use eframe::egui::Context;
use lancer_core::film::{Image, Tone};
use lancer_core::integrator::RayCounts;
use lancer_io::provenance::SceneSource;
use std::time::Duration;

/// A finished render.
pub(crate) struct Kept {
    /// What made it, and the image.
    pub(crate) rendered: Rendered,
    /// The scene's name, and how many of this scene came before.
    pub(crate) title: String,
    /// How it is shown.
    pub(crate) tone: Tone,
    source: SceneSource,
    texture: PictureTexture,
}

impl Kept {
    /// Its texture.
    pub(crate) fn texture(&self) -> &PictureTexture {
        &self.texture
    }

    /// Its size, its settings and the time that it took.
    pub(crate) fn summary(&self) -> String {
        let settings = &self.rendered.request.settings;
        let image = &self.rendered.image;
        let samples = settings.samples;
        let seconds = self.rendered.elapsed.as_secs_f64();
        let mut text = format!("{} × {}, {samples} × {samples}, ", image.width(), image.height());
        if settings.ao.samples > 0 {
            text.push_str(&format!("AO {}, ", settings.ao.samples));
        }
        text + &format!("{seconds:.2} s")
    }

    /// The image, and how it is shown and saved.
    pub(crate) fn picture(&self) -> (&Image, Tone) {
        (&self.rendered.image, self.tone)
    }

    /// How it was made.
    pub(crate) fn making(&self) -> Making {
        let Self { rendered, tone, source, .. } = self;
        Making { source: source.clone(), request: rendered.request.clone(), tone: *tone }
    }
}

/// The render that is being made.
pub(crate) struct Running {
    /// Which.
    pub(crate) id: RenderId,
    /// Its columns and rows.
    pub(crate) size: (u32, u32),
    /// The scene's name.
    pub(crate) title: String,
    /// How it is shown.
    pub(crate) tone: Tone,
    /// Where the scene comes from.
    pub(crate) source: SceneSource,
    /// The part of it that is done, 0 to 1.
    pub(crate) done: f32,
    /// The rays so far.
    pub(crate) rays: RayCounts,
    /// Since it began.
    pub(crate) elapsed: Duration,
    /// What is there of it, on black.
    pub(crate) image: Image,
    /// What is there of it, on the screen.
    pub(crate) texture: Option<PictureTexture>,
}

/// What the middle of the window shows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) enum Showing {
    /// The live picture, in which the mouse moves the camera.
    #[default]
    Live,
    /// The render that is being made.
    Running,
    /// A finished render.
    Kept(usize),
    /// Two finished renders, with a border that can be dragged: on its left the first.
    Compare(usize, usize),
}

/// All renders, and what is seen of them.
pub(crate) struct Shelf {
    /// Oldest first.
    pub(crate) kept: Vec<Kept>,
    /// What is being made.
    pub(crate) running: Option<Running>,
    /// What the middle of the window shows.
    pub(crate) showing: Showing,
    /// Which part of a render is seen; kept from one to the next, so that flipping compares like with like.
    pub(crate) view: ImageView,
    /// Where the border of a comparison is, as a share of the images' width.
    pub(crate) split: f32,
    made: usize,
}

/// Renders kept; older ones give way, since each may hold a whole world.
const MOST_KEPT: usize = 24;

impl Default for Shelf {
    fn default() -> Self {
        Self {
            kept: Vec::new(),
            running: None,
            showing: Showing::Live,
            view: ImageView::default(),
            split: 0.5,
            made: 0,
        }
    }
}

impl Shelf {
    /// Waits for a render that was asked for, and shows it as it grows.
    pub(crate) fn begin(&mut self, id: RenderId, source: &Source, size: (u32, u32), tone: Tone) {
        self.made += 1;
        let title = format!("{} {}", self.made, source.stem());
        self.running = Some(Running {
            id,
            size,
            title,
            tone,
            source: source.record(),
            done: 0.0,
            rays: RayCounts::default(),
            elapsed: Duration::ZERO,
            image: Image::black(size.0, size.1),
            texture: None,
        });
        self.showing = Showing::Running;
        self.view = ImageView::default();
    }

    /// Takes news of the running render.
    pub(crate) fn progress(&mut self, ctx: &Context, id: RenderId, progress: Progress) {
        let Some(running) = self.running.as_mut().filter(|running| running.id == id) else { return };
        let Progress { done, rays, elapsed, tiles } = progress;
        for tile in tiles {
            running.image.put(tile.x, tile.y, tile.width, &tile.pixels);
        }
        (running.done, running.rays, running.elapsed) = (done, rays, elapsed);
        let previous = running.texture.take();
        running.texture = Some(PictureTexture::new(ctx, &running.image, running.tone, false, previous));
    }

    /// Keeps a finished render.
    pub(crate) fn finish(&mut self, ctx: &Context, rendered: Rendered) {
        let Some(running) = self.running.take_if(|running| running.id == rendered.id) else { return };
        let Running { title, tone, source, texture, .. } = running;
        let texture = PictureTexture::new(ctx, &rendered.image, tone, false, texture);
        if self.kept.len() == MOST_KEPT {
            self.remove(0);
        }
        self.kept.push(Kept { rendered, title, tone, source, texture });
        if self.showing == Showing::Running {
            self.showing = Showing::Kept(self.kept.len() - 1);
        }
    }

    /// Forgets the running render, which was cancelled or failed.
    pub(crate) fn abandon(&mut self, id: RenderId) {
        if self.running.take_if(|running| running.id == id).is_some() && self.showing == Showing::Running {
            self.showing = Showing::Live;
        }
    }

    /// Forgets a finished render.
    pub(crate) fn remove(&mut self, index: usize) {
        if index >= self.kept.len() {
            return;
        }
        self.kept.remove(index);
        let moved = |shown: usize| if shown > index { shown - 1 } else { shown };
        self.showing = match self.showing {
            Showing::Kept(shown) if shown == index => Showing::Live,
            Showing::Compare(a, b) if a == index || b == index => Showing::Live,
            Showing::Kept(shown) => Showing::Kept(moved(shown)),
            Showing::Compare(a, b) => Showing::Compare(moved(a), moved(b)),
            other => other,
        };
    }

    /// The finished render that is shown; of two, the first.
    pub(crate) fn shown(&self) -> Option<&Kept> {
        match self.showing {
            Showing::Kept(index) | Showing::Compare(index, _) => self.kept.get(index),
            Showing::Live | Showing::Running => None,
        }
    }

    /// Columns and rows of what is shown in place of the live picture.
    pub(crate) fn shown_size(&self) -> Option<(u32, u32)> {
        match self.showing {
            Showing::Live => None,
            Showing::Running => self.running.as_ref().map(|running| running.size),
            Showing::Kept(_) | Showing::Compare(..) => {
                self.shown().map(|kept| (kept.rendered.image.width(), kept.rendered.image.height()))
            }
        }
    }

    /// Shows the next finished render, or with `back` the one before; around the ends.
    pub(crate) fn step(&mut self, back: bool) {
        let count = self.kept.len();
        if count == 0 {
            return;
        }
        let next = |index: usize| if back { (index + count - 1) % count } else { (index + 1) % count };
        self.showing = match self.showing {
            Showing::Kept(index) => Showing::Kept(next(index)),
            Showing::Compare(a, b) => Showing::Compare(a, next(b)),
            Showing::Live | Showing::Running => Showing::Kept(if back { count - 1 } else { 0 }),
        };
    }

    /// Compares the shown render with the one before it, or goes back to one.
    pub(crate) fn toggle_compare(&mut self) {
        let last = self.kept.len().saturating_sub(1);
        self.showing = match self.showing {
            Showing::Compare(_, b) => Showing::Kept(b),
            _ if self.kept.len() < 2 => return,
            Showing::Kept(0) => Showing::Compare(0, 1),
            Showing::Kept(index) => Showing::Compare(index - 1, index),
            Showing::Live | Showing::Running => Showing::Compare(last - 1, last),
        };
        self.split = 0.5;
    }
}
