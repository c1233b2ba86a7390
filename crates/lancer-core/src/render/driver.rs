//! Tiles to threads, threads to film.

use super::cover::Cover;
use super::{Control, Tile};
use crate::camera::{Camera, CameraError, Projection};
use crate::color::{Colors, Rgb};
use crate::film::Image;
use crate::geometry::RayPacket;
use crate::integrator::{CameraRays, Line, RayCounts, Scratch, Whitted};
use crate::sampling::subpixel_center;
use crate::scene::{Settings, SettingsError};
use crate::world::{Media, World};
use rayon::prelude::*;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Mutex, OnceLock, PoisonError};

/// A part of the image, in pixels from its top left corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    /// The first column.
    pub x: u32,
    /// The first row.
    pub y: u32,
    /// Columns, at least 1.
    pub width: u32,
    /// Rows, at least 1.
    pub height: u32,
}

impl Region {
    /// Whether it holds a pixel and lies in an image of this size.
    pub fn fits(&self, width: u32, height: u32) -> bool {
        let inside = |start: u32, length: u32, end: u32| {
            length > 0 && start.checked_add(length).is_some_and(|stop| stop <= end)
        };
        inside(self.x, self.width, width) && inside(self.y, self.height, height)
    }
}

/// A finished picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Render {
    /// The image, or the region of it that was asked for.
    pub image: Image,
    /// The rays that it took.
    pub rays: RayCounts,
}

/// Why there is no picture.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RenderError {
    /// A setting is out of its range.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// The camera makes no picture.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// The region is empty or leaves the image.
    #[error("the region {}x{} at {},{} is empty or leaves the image of {width} x {height}", .region.width, .region.height, .region.x, .region.y)]
    Region {
        /// The region.
        region: Region,
        /// Pixels in a row of the image.
        width: u32,
        /// Rows of the image.
        height: u32,
    },
    /// The layers would take too much memory.
    #[error(
        "the layers of the passes would take {} MiB, more than {}; ask for fewer of them, or render the picture by regions",
        .bytes >> 20, super::passes::MAX_LAYER_BYTES >> 20
    )]
    Layers {
        /// What they would take.
        bytes: u64,
    },
    /// It was cancelled.
    #[error("the render was cancelled")]
    Cancelled,
    /// A thread panicked: a bug of this renderer.
    #[error(
        "a bug in the renderer: {message}; render those pixels alone with --region {},{},{},{} to repeat it",
        .region.x, .region.y, .region.width, .region.height
    )]
    Panicked {
        /// The pixels that were painted.
        region: Region,
        /// What the panic said.
        message: String,
    },
}

/// Renders the image of a camera, or a region of it, on the threads of the current rayon pool.
///
/// The bytes of the image are a function of `world`, `camera`, `settings` and `region` alone; a region has the
/// bytes that the whole image has there.
///
/// # Errors
/// See [`RenderError`].
pub fn render(
    world: &World,
    camera: &Camera,
    settings: &Settings,
    region: Option<Region>,
    control: &Control,
) -> Result<Render, RenderError> {
    let frame = Frame::new(camera, settings, region)?;
    let integrator = Whitted::new(world, settings).until(&control.cancel);
    let cover = Cover::new(world, &frame.projection, &frame.region);
    let painter = RadiancePainter { integrator, media: Media::around(world, camera.eye), cover };
    frame.render(control, &painter)
}

/// Renders c_a alone, as grey: how open to the ambient light the surface is that each camera ray meets; 1 where it
/// meets none. Otherwise as [`render`]: the rays, their random numbers and the subpixels are the same.
///
/// # Errors
/// See [`RenderError`].
pub fn render_occlusion(
    world: &World,
    camera: &Camera,
    settings: &Settings,
    region: Option<Region>,
    control: &Control,
) -> Result<Render, RenderError> {
    let frame = Frame::new(camera, settings, region)?;
    let integrator = Whitted::new(world, settings).until(&control.cancel);
    let cover = Cover::new(world, &frame.projection, &frame.region);
    frame.render(control, &OcclusionPainter { integrator, cover })
}

/// What is to be rendered: checked, before anything is allocated.
pub(super) struct Frame {
    pub(super) projection: Projection,
    /// Subpixels along a pixel's side.
    pub(super) samples: u32,
    /// The rows, and the columns, of the subpixels of a block.
    lines: Vec<Line>,
    pub(super) region: Region,
}

impl Frame {
    pub(super) fn new(
        camera: &Camera,
        settings: &Settings,
        region: Option<Region>,
    ) -> Result<Self, RenderError> {
        settings.validate()?;
        let &Settings { width, height, samples, .. } = settings;
        let region = region.unwrap_or(Region { x: 0, y: 0, width, height });
        if !region.fits(width, height) {
            return Err(RenderError::Region { region, width, height });
        }
        let line = |i| Line {
            pixel: i / samples,
            subpixel: i % samples,
            center: subpixel_center(i % samples, samples),
        };
        let lines = (0..BLOCK * samples).map(line).collect();
        Ok(Self { projection: camera.project(width, height)?, samples, lines, region })
    }

    /// Renders what `painter` finds for each camera ray.
    pub(super) fn render(self, control: &Control, painter: &impl Painter) -> Result<Render, RenderError> {
        let film = Mutex::new(Image::black(self.region.width, self.region.height));
        let job = Job { frame: self, painter, control, film, panic: OnceLock::new() };
        // Counts are whole numbers, so their sum does not depend on the order of work.
        let rays = tiles_of(&job.frame.region, control.tile_size.max(1))
            .into_par_iter()
            .map(|area| job.tile(area))
            .try_reduce(RayCounts::default, |mut a, b| {
                a += b;
                Some(a)
            });
        match (rays, job.panic.into_inner()) {
            (_, Some(panic)) => Err(panic),
            (None, None) => Err(RenderError::Cancelled),
            // A poisoned film would mean a panic while a tile was put into it, and there is none.
            (Some(rays), None) => {
                Ok(Render { image: job.film.into_inner().unwrap_or_else(PoisonError::into_inner), rays })
            }
        }
    }
}

/// What finds the colours of camera rays, and may keep more of them than that.
pub(super) trait Painter: Sync {
    /// What a thread needs, and what it keeps, for the tile in hand.
    type Tile;

    /// Before the first ray of a tile.
    fn begin_tile(&self) -> Self::Tile;

    /// Pixels are painted together in squares of so many by so many, at most [`BLOCK`], and so are their subpixels. Of 1,
    /// they come one by one, in reading order.
    const SIDE: u32;

    /// What every camera ray of some pixels of the region yields, where that is known without tracing them. Nothing more is
    /// told of them.
    fn blank(&self, _pixels: &Region) -> Option<Rgb> {
        None
    }

    /// Finds what camera rays yield; something unfinished once the render is cancelled.
    fn trace(&self, rays: &CameraRays, tile: &mut Self::Tile, counts: &mut RayCounts) -> Colors;

    /// All rays of the pixel at a column and a row of the image were traced.
    fn end_pixel(&self, _x: u32, _y: u32, _mean: [f32; 3], _tile: &mut Self::Tile) {}

    /// All pixels of a tile, at its place in the region, are done.
    fn end_tile(&self, _area: &Region, _tile: &Self::Tile) {}
}

/// The side of the square of pixels whose rays fill a packet.
pub(super) const BLOCK: u32 = 4;

/// Paints what camera rays see.
struct RadiancePainter<'w> {
    integrator: Whitted<'w>,
    /// Around the eye.
    media: Media,
    cover: Cover,
}

impl Painter for RadiancePainter<'_> {
    type Tile = Scratch;

    fn begin_tile(&self) -> Scratch {
        Scratch::default()
    }

    const SIDE: u32 = BLOCK;

    fn blank(&self, pixels: &Region) -> Option<Rgb> {
        self.integrator.background().filter(|_| !self.cover.holds(pixels))
    }

    fn trace(&self, rays: &CameraRays, scratch: &mut Scratch, counts: &mut RayCounts) -> Colors {
        self.integrator.radiances(rays, &self.media, scratch, counts)
    }
}

/// Paints c_a.
struct OcclusionPainter<'w> {
    integrator: Whitted<'w>,
    cover: Cover,
}

impl Painter for OcclusionPainter<'_> {
    type Tile = Scratch;

    fn begin_tile(&self) -> Scratch {
        Scratch::default()
    }

    const SIDE: u32 = BLOCK;

    fn blank(&self, pixels: &Region) -> Option<Rgb> {
        (!self.cover.holds(pixels)).then_some(Rgb::WHITE)
    }

    fn trace(&self, rays: &CameraRays, scratch: &mut Scratch, counts: &mut RayCounts) -> Colors {
        let mut found = Colors::default();
        for (lane, occlusion) in self.integrator.occlusions(rays, scratch, counts).into_iter().enumerate() {
            found.put(lane, Rgb::grey(occlusion));
        }
        found
    }
}

/// The tiles of a region in reading order, in coordinates of the region.
fn tiles_of(region: &Region, size: u32) -> Vec<Region> {
    let starts = |length: u32| (0..length).step_by(size as usize);
    let part = |start: u32, length: u32| size.min(length - start);
    starts(region.height)
        .flat_map(|y| starts(region.width).map(move |x| (x, y)))
        .map(|(x, y)| Region { x, y, width: part(x, region.width), height: part(y, region.height) })
        .collect()
}

struct Job<'a, P> {
    frame: Frame,
    painter: &'a P,
    control: &'a Control<'a>,
    film: Mutex<Image>,
    /// The first panic; it stops all threads.
    panic: OnceLock<RenderError>,
}

impl<P: Painter> Job<'_, P> {
    /// Traces a tile into the film. Returns the rays that it took; none where the render was cancelled or a
    /// thread panicked.
    fn tile(&self, area: Region) -> Option<RayCounts> {
        if self.is_stopped() {
            return None;
        }
        let mut counts = RayCounts::default();
        let pixels = match self.blank(&area, &mut counts) {
            Some(mean) => vec![mean; area.width as usize * area.height as usize],
            None => self.paint_tile(&area, &mut counts)?,
        };
        let tile = Tile { x: area.x, y: area.y, width: area.width, height: area.height, pixels };
        let mut film = self.film.lock().unwrap_or_else(PoisonError::into_inner);
        film.put(tile.x, tile.y, tile.width, &tile.pixels);
        drop(film);
        (self.control.on_tile)(&tile, &counts);
        Some(counts)
    }

    /// The mean of each of some pixels of the region, where no ray is needed to know it; these are counted all the same.
    fn blank(&self, area: &Region, counts: &mut RayCounts) -> Option<[f32; 3]> {
        let radiance = self.painter.blank(area)?;
        let subpixels = self.frame.samples * self.frame.samples;
        counts.primary += u64::from(area.width) * u64::from(area.height) * u64::from(subpixels);
        Some(mean((0..subpixels).fold(Rgb::BLACK, |sum, _| sum + radiance), subpixels))
    }

    /// Traces a tile. Returns its pixels; none where the render was cancelled or a thread panicked.
    fn paint_tile(&self, area: &Region, counts: &mut RayCounts) -> Option<Vec<[f32; 3]>> {
        let mut kept = self.painter.begin_tile();
        let mut pixels = vec![[0.0; 3]; area.width as usize * area.height as usize];
        let mut work = Work::default();
        for block in tiles_of(area, P::SIDE) {
            let place = Region { x: area.x + block.x, y: area.y + block.y, ..block };
            // After a panic what is kept and the counts are dropped with the tile.
            let trace = AssertUnwindSafe(|| self.block(&place, &mut work, &mut kept, counts));
            match catch_unwind(trace) {
                Ok(painted) => {
                    painted?;
                    let rows = (block.y..block.y + block.height).map(|y| y as usize);
                    for (y, means) in rows.zip(work.means.chunks(block.width as usize)) {
                        let start = y * area.width as usize + block.x as usize;
                        pixels[start..start + means.len()].copy_from_slice(means);
                    }
                }
                Err(panic) => {
                    let message = panic_message(panic.as_ref()).to_owned();
                    let region = self.in_image(&place);
                    // A second thread's panic is the same news.
                    let _ = self.panic.set(RenderError::Panicked { region, message });
                    return None;
                }
            }
        }
        self.painter.end_tile(area, &kept);
        Some(pixels)
    }

    /// A part of the region, in coordinates of the image.
    fn in_image(&self, place: &Region) -> Region {
        Region { x: place.x + self.frame.region.x, y: place.y + self.frame.region.y, ..*place }
    }

    /// Finds the means of the pixels of a square of the region; none once the render is cancelled.
    fn block(
        &self,
        place: &Region,
        work: &mut Work,
        kept: &mut P::Tile,
        counts: &mut RayCounts,
    ) -> Option<()> {
        if self.is_stopped() {
            return None;
        }
        if let Some(mean) = self.blank(place, counts) {
            work.means.fill(mean);
            return Some(());
        }
        let area = self.in_image(place);
        let Region { x, y, width, height } = area;
        self.trace_block(&area, work, kept, counts)?;
        work.find_means();
        let pixels = (y..y + height).flat_map(|y| (x..x + width).map(move |x| (x, y)));
        for ((x, y), &mean) in pixels.zip(&work.means) {
            self.painter.end_pixel(x, y, mean, kept);
        }
        Some(())
    }

    /// Finds what each subpixel of a square of the image yields; none once the render is cancelled.
    fn trace_block(
        &self,
        area: &Region,
        Work { rays, radiances, .. }: &mut Work,
        kept: &mut P::Tile,
        counts: &mut RayCounts,
    ) -> Option<()> {
        let Frame { projection, samples, lines, .. } = &self.frame;
        let Region { x, y, width, height } = *area;
        radiances.resize((samples * samples) as usize, Colors::default());
        // Rays of neighbouring subpixels go much the same way, so squares of them are traced together.
        for rows in lines[..(height * samples) as usize].chunks(P::SIDE as usize) {
            for columns in lines[..(width * samples) as usize].chunks(P::SIDE as usize) {
                rays.aim(projection, (x, y), *samples, rows, columns);
                let found = self.painter.trace(rays, kept, counts);
                let subpixels = rows.iter().flat_map(|row| columns.iter().map(move |column| (row, column)));
                for (lane, (row, column)) in subpixels.enumerate() {
                    let pixel = (row.pixel * width + column.pixel) as usize;
                    let subpixel = (row.subpixel * samples + column.subpixel) as usize;
                    radiances[subpixel].put(pixel, found.at(lane));
                }
                // Afterwards: what was cancelled on its way is unfinished.
                if self.is_stopped() {
                    return None;
                }
            }
        }
        Some(())
    }

    fn is_stopped(&self) -> bool {
        self.control.cancel.is_cancelled() || self.panic.get().is_some()
    }
}

/// Memory that blocks leave to the next.
#[derive(Default)]
struct Work {
    rays: CameraRays,
    /// By subpixel, then by pixel of a block.
    radiances: Vec<Colors>,
    /// The means of the block in hand, by pixel in reading order.
    means: [[f32; 3]; RayPacket::LANES],
}

impl Work {
    /// Finds the means of the block's pixels, whose subpixels are added in their order.
    fn find_means(&mut self) {
        let mut sums = Colors::default();
        for radiances in &self.radiances {
            for pixel in 0..RayPacket::LANES {
                sums.put(pixel, sums.at(pixel) + radiances.at(pixel));
            }
        }
        for (pixel, found) in self.means.iter_mut().enumerate() {
            *found = mean(sums.at(pixel), self.radiances.len() as u32);
        }
    }
}

/// The mean of so many radiances, by their sum.
fn mean(sum: Rgb, count: u32) -> [f32; 3] {
    (sum * (1.0 / f64::from(count))).to_array().map(|channel| channel as f32)
}

fn panic_message(panic: &(dyn std::any::Any + Send)) -> &str {
    panic
        .downcast_ref::<String>()
        .map(String::as_str)
        .or_else(|| panic.downcast_ref::<&str>().copied())
        .unwrap_or("no message")
}
