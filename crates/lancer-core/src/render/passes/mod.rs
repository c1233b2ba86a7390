//! A picture and what it is made of: its terms, its lights, what is seen where and what it cost, each as a layer.
//!
//! In: a world, a camera and a list of [`Pass`]es. Out: the picture that [`render`](super::render) makes, to the
//! bit, and a [`Layer`] for each pass. Layers come from the rays of the picture itself, told by a
//! [`Listener`](crate::integrator::Listener); only what is seen where takes a ray of its own, through the centre
//! of each pixel, since an id or a normal has no mean. It knows no file format.
//!
//! Two sets of layers add up to the picture, exactly; see [`exact`] for what that means and how:
//!
//! - the terms, by what the camera's own ray meets: ambient + diffuse + specular + reflection + transmission +
//!   background;
//! - the sources, by where the light comes from, whatever mirrors and glass it takes on its way: all ambient
//!   light + all background + each light.

mod exact;
mod gather;
mod names;

pub use names::{UnknownPass, light_names, select};

use super::driver::{Frame, Painter};
use super::features::seen;
use super::{Control, Region, Render, RenderError};
use crate::accel::Visits;
use crate::camera::Camera;
use crate::color::{Colors, Rgb};
use crate::geometry::{DVec3, Ray};
use crate::integrator::{CameraRays, RayCounts, Scratch, Whitted};
use crate::sampling::Key;
use crate::scene::Settings;
use crate::world::{Intersection, Media, World};
use gather::{Gather, SOURCES_BEFORE_LIGHTS, TERMS};
use std::sync::{Mutex, PoisonError};

/// What a layer shows, beside the picture itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Pass {
    /// c_a L_a k_a S of the surface that the camera ray meets.
    Ambient,
    /// Its diffuse terms, of all lights.
    Diffuse,
    /// Its specular terms, of all lights.
    Specular,
    /// Its k_r L_r, with all that lies behind.
    Reflection,
    /// Its k_t L_t, with all that lies behind.
    Transmission,
    /// The background where the camera ray meets nothing.
    Background,
    /// All ambient terms, also those that arrive by mirrors and through glass.
    AllAmbient,
    /// All background, also what arrives by mirrors and through glass.
    AllBackground,
    /// What one light gives, also by mirrors and through glass; by its place in [`World::lights`].
    Light(usize),
    /// c_a of the surface that the camera ray meets; 1 where it meets none.
    Occlusion,
    /// How far the surface is from the eye, along the direction of view.
    Depth,
    /// How far it is from the eye.
    Distance,
    /// Where it is, in the world.
    Position,
    /// Its N: the unit normal for shading, in the world, on the side of the eye.
    Normal,
    /// Its unit geometric normal, in the world, on the side of the eye.
    GeometricNormal,
    /// Its texture coordinates.
    Uv,
    /// Which object: 1 and its place in [`World::objects`]; 0 for none.
    ObjectId,
    /// Which material: 1 and its place in the scene's; 0 for none.
    MaterialId,
    /// What the pixel took: rays, nodes of trees that were looked at for them, and triangles that were tested. The last
    /// two are the accelerator's; see [`Tally`](crate::accel::Tally).
    Cost,
}

/// The values of a layer. Shape: `[height * width]`, top row first.
#[derive(Clone, Debug, PartialEq)]
pub enum Samples {
    /// Linear RGB with sRGB primaries.
    Color(Vec<[f32; 3]>),
    /// Vectors of the world; zero where nothing is seen.
    Vector(Vec<[f32; 3]>),
    /// Texture coordinates; zero where nothing is seen.
    Coordinates(Vec<[f32; 2]>),
    /// Lengths in world units; infinite where nothing is seen.
    Length(Vec<f32>),
    /// Numbers about 1.
    Factor(Vec<f32>),
    /// Ids.
    Id(Vec<u32>),
    /// Rays, nodes of trees and triangles: see [`Tally`](crate::accel::Tally).
    Counts(Vec<[u32; 3]>),
}

/// One pass of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// What it shows.
    pub pass: Pass,
    /// Its values.
    pub samples: Samples,
}

/// A finished picture and its layers.
#[derive(Clone, Debug, PartialEq)]
pub struct PassRender {
    /// The picture as [`render`](super::render) makes it. Its rays do not count those through the centres of pixels.
    pub render: Render,
    /// The passes that were asked for, each once, in the order of [`Pass`].
    pub layers: Vec<Layer>,
}

/// The most memory of all layers together. More would be allocated at once, before it is known whether it is there.
pub const MAX_LAYER_BYTES: u64 = 4 << 30;

/// Renders a picture, or a region of it, with passes.
///
/// Layers that are colours are times `scale`, and add up to the picture times `scale` as
/// [`Tone::expose`](crate::film::Tone::expose) rounds it. What is in a layer does not depend on which others are
/// asked for, nor on threads and tiles.
///
/// # Errors
/// See [`RenderError`].
pub fn render_passes(
    world: &World,
    camera: &Camera,
    settings: &Settings,
    region: Option<Region>,
    passes: &[Pass],
    scale: f32,
    control: &Control,
) -> Result<PassRender, RenderError> {
    let frame = Frame::new(camera, settings, region)?;
    let mut passes = passes.to_vec();
    passes.sort_unstable();
    passes.dedup();
    let pixels = frame.region.width as usize * frame.region.height as usize;
    let bytes = passes.iter().map(|&pass| Samples::bytes_per_pixel(pass)).sum::<u64>() * pixels as u64;
    if bytes > MAX_LAYER_BYTES {
        return Err(RenderError::Layers { bytes });
    }
    let [_, _, backward] = camera.frame()?;
    let blank = |&pass: &Pass| Layer { pass, samples: Samples::blank(pass, pixels) };
    let painter = PassPainter {
        world,
        integrator: Whitted::new(world, settings).until(&control.cancel),
        media: Media::around(world, camera.eye),
        projection: frame.projection,
        forward: -backward,
        mean: 1.0 / f64::from(frame.samples * frame.samples),
        scale,
        wants: Wants::new(&passes, world.lights().len()),
        width: frame.region.width,
        layers: Mutex::new(passes.iter().map(blank).collect()),
        passes,
    };
    let render = frame.render(control, &painter)?;
    let layers = painter.layers.into_inner().unwrap_or_else(PoisonError::into_inner);
    Ok(PassRender { render, layers })
}

/// Which work the passes need.
struct Wants {
    terms: bool,
    /// The sources to keep apart; 0 where none is wanted.
    sources: usize,
    occlusion: bool,
    features: bool,
    cost: bool,
}

impl Wants {
    fn new(passes: &[Pass], lights: usize) -> Self {
        let any = |of: fn(Pass) -> bool| passes.iter().any(|&pass| of(pass));
        let sources = any(|pass| pass.source().is_some());
        Self {
            terms: any(|pass| pass.term().is_some()),
            sources: if sources { SOURCES_BEFORE_LIGHTS + lights } else { 0 },
            occlusion: any(|pass| pass == Pass::Occlusion),
            features: any(Pass::is_feature),
            cost: any(|pass| pass == Pass::Cost),
        }
    }
}

impl Pass {
    /// Its place among the terms that add up to the picture.
    fn term(self) -> Option<usize> {
        match self {
            Self::Ambient => Some(gather::AMBIENT),
            Self::Diffuse => Some(gather::DIFFUSE),
            Self::Specular => Some(gather::SPECULAR),
            Self::Reflection => Some(gather::REFLECTION),
            Self::Transmission => Some(gather::TRANSMISSION),
            Self::Background => Some(gather::BACKGROUND),
            _ => None,
        }
    }

    /// Its place among the sources that add up to the picture.
    fn source(self) -> Option<usize> {
        match self {
            Self::AllAmbient => Some(gather::ALL_AMBIENT),
            Self::AllBackground => Some(gather::ALL_BACKGROUND),
            Self::Light(light) => Some(SOURCES_BEFORE_LIGHTS + light),
            _ => None,
        }
    }

    /// Whether it tells of the surface at the pixel's centre.
    fn is_feature(self) -> bool {
        use Pass::{Depth, Distance, GeometricNormal, MaterialId, Normal, ObjectId, Position, Uv};
        matches!(self, Depth | Distance | Position | Normal | GeometricNormal | Uv | ObjectId | MaterialId)
    }
}

impl Samples {
    /// The kind of values that a pass has, without any yet.
    pub fn empty(pass: Pass) -> Self {
        match pass {
            Pass::Position | Pass::Normal | Pass::GeometricNormal => Self::Vector(Vec::new()),
            Pass::Uv => Self::Coordinates(Vec::new()),
            Pass::Depth | Pass::Distance => Self::Length(Vec::new()),
            Pass::Occlusion => Self::Factor(Vec::new()),
            Pass::ObjectId | Pass::MaterialId => Self::Id(Vec::new()),
            Pass::Cost => Self::Counts(Vec::new()),
            _ => Self::Color(Vec::new()),
        }
    }

    /// As many zeros as there are pixels.
    fn blank(pass: Pass, pixels: usize) -> Self {
        let mut samples = Self::empty(pass);
        match &mut samples {
            Self::Color(values) | Self::Vector(values) => values.resize(pixels, [0.0; 3]),
            Self::Coordinates(values) => values.resize(pixels, [0.0; 2]),
            Self::Length(values) | Self::Factor(values) => values.resize(pixels, 0.0),
            Self::Id(values) => values.resize(pixels, 0),
            Self::Counts(values) => values.resize(pixels, [0; 3]),
        }
        samples
    }

    fn bytes_per_pixel(pass: Pass) -> u64 {
        let bytes = match Self::empty(pass) {
            Self::Color(_) | Self::Vector(_) => size_of::<[f32; 3]>(),
            Self::Coordinates(_) => size_of::<[f32; 2]>(),
            Self::Length(_) | Self::Factor(_) => size_of::<f32>(),
            Self::Id(_) => size_of::<u32>(),
            Self::Counts(_) => size_of::<[u32; 3]>(),
        };
        bytes as u64
    }

    /// Puts a tile in place in an image of `width` columns.
    fn put(&mut self, tile: &Self, area: &Region, width: u32) {
        match (self, tile) {
            (Self::Color(all), Self::Color(part)) | (Self::Vector(all), Self::Vector(part)) => {
                put_rows(all, part, area, width);
            }
            (Self::Coordinates(all), Self::Coordinates(part)) => put_rows(all, part, area, width),
            (Self::Length(all), Self::Length(part)) | (Self::Factor(all), Self::Factor(part)) => {
                put_rows(all, part, area, width);
            }
            (Self::Id(all), Self::Id(part)) => put_rows(all, part, area, width),
            (Self::Counts(all), Self::Counts(part)) => put_rows(all, part, area, width),
            _ => unreachable!("a tile's layers are made as the picture's"),
        }
    }
}

fn put_rows<T: Copy>(all: &mut [T], part: &[T], area: &Region, width: u32) {
    for (row, values) in part.chunks_exact(area.width as usize).enumerate() {
        let start = (area.y as usize + row) * width as usize + area.x as usize;
        all[start..start + values.len()].copy_from_slice(values);
    }
}

/// Makes the layers beside the picture.
struct PassPainter<'w> {
    world: &'w World,
    integrator: Whitted<'w>,
    media: Media,
    projection: crate::camera::Projection,
    /// The direction of view, of length 1.
    forward: DVec3,
    /// What the sum of a pixel's subpixels is multiplied by.
    mean: f64,
    scale: f32,
    wants: Wants,
    passes: Vec<Pass>,
    /// Columns of the region.
    width: u32,
    layers: Mutex<Vec<Layer>>,
}

/// A tile on its way: the pixel in hand, and the layers of those before.
struct PassTile {
    scratch: Scratch,
    gather: Gather,
    /// The sum of c_a over the pixel's subpixels.
    occlusion: f64,
    /// The rays of the pixel.
    rays: u64,
    /// What they looked at.
    visits: Visits,
    shares: exact::Shares,
    layers: Vec<Layer>,
}

impl Painter for PassPainter<'_> {
    type Tile = PassTile;

    fn begin_tile(&self) -> PassTile {
        let empty = |&pass: &Pass| Layer { pass, samples: Samples::empty(pass) };
        PassTile {
            scratch: Scratch::default(),
            gather: Gather::new(self.wants.sources),
            occlusion: 0.0,
            rays: 0,
            visits: Visits::default(),
            shares: exact::Shares::default(),
            layers: self.passes.iter().map(empty).collect(),
        }
    }

    /// One pixel at a time: what is gathered is its own.
    const SIDE: u32 = 1;

    fn trace(&self, rays: &CameraRays, tile: &mut PassTile, counts: &mut RayCounts) -> Colors {
        let mut found = Colors::default();
        for (lane, (ray, key)) in rays.iter().enumerate() {
            found.put(lane, self.trace_one(ray, key, tile, counts));
        }
        found
    }

    fn end_pixel(&self, x: u32, y: u32, mean: [f32; 3], tile: &mut PassTile) {
        let PassTile { gather, shares, layers, .. } = tile;
        let whole = mean.map(|channel| channel * self.scale);
        let factor = self.mean * f64::from(self.scale);
        let mut terms = [[0.0; 3]; TERMS];
        if self.wants.terms {
            terms.copy_from_slice(shares.of(whole, gather.terms(), factor));
        }
        let sources = shares.of(whole, gather.sources(), factor);
        let center = self.projection.ray(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let surface = if self.wants.features { seen(self.world, &center) } else { None };
        for Layer { pass, samples } in layers {
            match samples {
                Samples::Color(values) => values.push(match (pass.term(), pass.source()) {
                    (Some(term), _) => terms[term],
                    (None, Some(source)) => sources[source],
                    (None, None) => unreachable!("a colour is a term or a source"),
                }),
                Samples::Length(values) => {
                    let along = if *pass == Pass::Depth { center.direction.dot(self.forward) } else { 1.0 };
                    values.push(surface.map_or(f32::INFINITY, |at| (at.t * along) as f32));
                }
                Samples::Factor(values) => values.push((tile.occlusion * self.mean) as f32),
                Samples::Vector(values) => {
                    values.push(surface.map_or(DVec3::ZERO, |at| vector(*pass, &at)).as_vec3().to_array());
                }
                Samples::Coordinates(values) => {
                    values.push(surface.map_or([0.0; 2], |at| at.uv.as_vec2().to_array()));
                }
                Samples::Id(values) => values.push(surface.map_or(0, |at| id(*pass, &at))),
                Samples::Counts(values) => {
                    let counts = [tile.rays, tile.visits.nodes(), tile.visits.triangles()];
                    values.push(counts.map(|count| u32::try_from(count).unwrap_or(u32::MAX)));
                }
            }
        }
        tile.gather.clear();
        tile.occlusion = 0.0;
        tile.rays = 0;
        tile.visits = Visits::default();
    }

    fn end_tile(&self, area: &Region, tile: &PassTile) {
        let mut layers = self.layers.lock().unwrap_or_else(PoisonError::into_inner);
        for (layer, part) in layers.iter_mut().zip(&tile.layers) {
            layer.samples.put(&part.samples, area, self.width);
        }
    }
}

impl PassPainter<'_> {
    fn trace_one(&self, ray: Ray, key: Key, tile: &mut PassTile, counts: &mut RayCounts) -> Rgb {
        let before = *counts;
        tile.gather.begin();
        let PassTile { scratch, gather, visits, .. } = tile;
        let radiance = if self.wants.cost {
            self.integrator.radiance_tallied(ray, &self.media, key, scratch, counts, gather, visits)
        } else {
            self.integrator.radiance(ray, &self.media, key, scratch, counts, gather)
        };
        tile.gather.end(counts.replaced > before.replaced);
        tile.rays += counts.total() - before.total();
        if self.wants.occlusion {
            tile.occlusion += match (tile.gather.occlusion(), tile.gather.seen()) {
                (Some(factor), _) => factor,
                // The ambient term was zero whatever c_a is, and did not ask for it.
                (None, Some(at)) => self.integrator.occlusion_at(at, key, counts),
                (None, None) => 1.0,
            };
        }
        radiance
    }
}

fn vector(pass: Pass, at: &Intersection) -> DVec3 {
    match pass {
        Pass::Position => at.point,
        Pass::Normal => at.facing_normal(),
        _ => at.facing_geometric_normal(),
    }
}

fn id(pass: Pass, at: &Intersection) -> u32 {
    let place = if pass == Pass::ObjectId { at.object.index() } else { at.material.index() };
    u32::try_from(place + 1).unwrap_or(u32::MAX)
}
