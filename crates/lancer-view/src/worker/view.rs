//! The viewport's picture, pass by pass.

use super::cost::Cost;
use super::desk::Desk;
use super::film::Film;
use super::outbox::Outbox;
use super::passes::{self, Pass};
use super::scale::stretched;
use super::{Channel, Event, Frame, ViewRequest, channel};
use lancer_core::camera::Camera;
use lancer_core::film::Image;
use lancer_core::integrator::RayCounts;
use lancer_core::render::{CancelToken, Control, Features, RenderError, render_features};
use lancer_core::world::World;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

/// A request that is shown, and whom to tell.
pub(super) struct Showing<'a> {
    pub(super) request: &'a ViewRequest,
    pub(super) world: &'a Arc<World>,
    pub(super) cancel: &'a CancelToken,
    pub(super) desk: &'a Desk,
    pub(super) outbox: &'a Outbox,
}

/// What is known from earlier images.
#[derive(Default)]
pub(super) struct View {
    costs: Costs,
    last_moving: Option<Pass>,
    shown: Option<Shown>,
    features: Option<(Arc<World>, Camera, Arc<Features>)>,
}

/// What images cost, by what they show.
#[derive(Default)]
struct Costs {
    picture: Cost,
    occlusion: Cost,
    features: Cost,
}

impl Costs {
    fn of(&mut self, channel: Channel) -> &mut Cost {
        match channel {
            Channel::Picture => &mut self.picture,
            Channel::Occlusion => &mut self.occlusion,
            Channel::Depth | Channel::Normals | Channel::Objects => &mut self.features,
        }
    }
}

/// The last image.
struct Shown {
    request: ViewRequest,
    pass: Pass,
    frame: Frame,
}

impl View {
    /// Forgets what images cost: another scene comes.
    pub(super) fn forget_costs(&mut self) {
        self.costs = Costs::default();
    }

    /// Shows what is asked for, on the threads of the current rayon pool. Returns the last frame of it; those
    /// before are told.
    ///
    /// # Errors
    /// See [`RenderError`].
    pub(super) fn show(&mut self, showing: &Showing) -> Result<Frame, RenderError> {
        let request = showing.request;
        let shown = self.shown.as_ref().filter(|shown| shown.request.same_picture(request));
        if let Some(shown) = shown.filter(|shown| shown.pass.is_final || request.moving) {
            return Ok(Frame { revision: request.revision, ..shown.frame.clone() });
        }
        let mut divisor = shown.map(|shown| shown.pass.divisor);
        if request.moving {
            let cost = self.costs.of(request.channel);
            let pass = passes::moving(&request.settings, cost, self.last_moving.as_ref());
            self.last_moving = Some(pass);
            return self.pass(showing, pass, (0, 1));
        }
        for number in 0.. {
            let plan = passes::resting(&request.settings, self.costs.of(request.channel), divisor);
            let pass = plan[0];
            let frame = self.pass(showing, pass, (number, number + plan.len() as u32))?;
            if pass.is_final {
                return Ok(frame);
            }
            divisor = Some(pass.divisor);
            showing.outbox.push(Event::Frame(Box::new(frame)));
        }
        unreachable!("each pass is finer than the one before, down to the last")
    }

    /// Makes one image.
    fn pass(&mut self, showing: &Showing, pass: Pass, number: (u32, u32)) -> Result<Frame, RenderError> {
        let &Showing { request, world, cancel, .. } = showing;
        let start = Instant::now();
        let features = self.features(showing, &pass)?;
        let frame = |image: Image, part: f32, rays: RayCounts| Frame {
            image,
            features: Arc::clone(&features),
            world: Arc::clone(world),
            camera: request.camera,
            revision: showing.desk.revision(request),
            width: request.settings.width,
            height: request.settings.height,
            pass: number.0,
            passes: number.1,
            is_final: false,
            tiles_done: part,
            rays,
            seconds: start.elapsed().as_secs_f64(),
        };
        let done = if channel::shows_features(request.channel) {
            channel::show(request.channel, &features)
        } else {
            let film = pass.is_final.then(|| Mutex::new(Film::over(self.base(&pass))));
            let on_tile = |tile: &_, rays: &_| {
                let Some(film) = &film else { return };
                let mut film = film.lock().unwrap_or_else(PoisonError::into_inner);
                if let Some(image) = film.put(tile, rays) {
                    let (part, rays) = (film.count.part(), film.count.rays);
                    drop(film);
                    if !cancel.is_cancelled() {
                        showing.outbox.push(Event::Frame(Box::new(frame(image, part, rays))));
                    }
                }
            };
            let control = Control { cancel: cancel.clone(), on_tile: &on_tile, ..Control::default() };
            channel::trace(request.channel, world, &request.camera, &pass.settings, &control)?
        };
        let frame = Frame { is_final: pass.is_final, ..frame(done.image, 1.0, done.rays) };
        self.costs.of(request.channel).learn(&pass.settings, &done.rays, frame.seconds);
        self.shown = Some(Shown { request: request.clone(), pass, frame: frame.clone() });
        Ok(frame)
    }

    /// What the pixels of a pass show: known, where the same was seen at that size.
    fn features(&mut self, showing: &Showing, pass: &Pass) -> Result<Arc<Features>, RenderError> {
        let &Showing { request, world, cancel, .. } = showing;
        let (width, height) = (pass.settings.width, pass.settings.height);
        if let Some((of, camera, known)) = &self.features
            && Arc::ptr_eq(of, world)
            && *camera == request.camera
            && (known.width(), known.height()) == (width, height)
        {
            return Ok(Arc::clone(known));
        }
        let features = Arc::new(render_features(world, &request.camera, width, height, cancel)?);
        self.features = Some((Arc::clone(world), request.camera, Arc::clone(&features)));
        Ok(features)
    }

    /// What is shown until a pass has its pixels: the last image, which is the pass before where there was one.
    fn base(&self, pass: &Pass) -> Image {
        let (width, height) = (pass.settings.width, pass.settings.height);
        match &self.shown {
            Some(shown) => stretched(&shown.frame.image, width, height),
            None => Image::black(width, height),
        }
    }
}
