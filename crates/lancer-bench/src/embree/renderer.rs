//! The best renderer that we can write on Embree for Lancer's local illumination: what a frame of Lancer is measured
//! against.
//!
//! Tiles of 8 x 8 pixels, each of four packets of 4 x 4. Packets of primary and shadow rays go across pixels; the
//! directions of ambient occlusion are put into packets in several ways, of which the fastest counts. All shading is
//! in `f32`, sixteen lanes at a time.

#![expect(clippy::needless_range_loop, reason = "lanes run through several arrays at once")]

use super::ffi::{self, Aligned, Query, RayHits, Rays, Scene, Vectorised};
use super::occlusion;
use rayon::prelude::*;

/// Pixels of a packet.
pub(super) const LANES: usize = 16;
/// Packets of a tile.
const BLOCKS: usize = 4;
/// Pixels of a tile.
pub(super) const PIXELS: usize = BLOCKS * LANES;
/// Pixels along a tile's side.
const SIDE: usize = 8;

type Lanes = [f32; LANES];
pub(super) type Vector = [f32; 3];

/// Everything that the picture depends on, beside the scene.
pub(crate) struct Picture {
    /// A multiple of 8, as is the height.
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) eye: Vector,
    /// From the eye to the top left corner of the image plane, and from one pixel to its neighbours.
    pub(crate) top_left: Vector,
    pub(crate) right: Vector,
    pub(crate) down: Vector,
    pub(crate) background: Vector,
    /// L_a k_a S.
    pub(crate) ambient: Vector,
    /// Position, and L_i k_d S / pi.
    pub(crate) lights: Vec<(Vector, Vector)>,
    /// The inverse transpose of each object's matrix, row by row; none where there is one object in its own space.
    pub(crate) normal_matrices: Vec<[Vector; 3]>,
    /// How far rays start off a surface.
    pub(crate) off_surface: f32,
    /// N: directions on the whole sphere; 0 without ambient occlusion.
    pub(crate) samples: u32,
    /// The cosine and the sine of each direction's azimuth, from the highest down.
    pub(crate) azimuths: Vec<[f32; 2]>,
    pub(crate) reach: f32,
}

/// How primary and shadow rays are traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Beams {
    Single,
    Packets,
    CoherentPackets,
}

impl Beams {
    pub(crate) const ALL: [Self; 3] = [Self::Single, Self::Packets, Self::CoherentPackets];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Single => "single rays",
            Self::Packets => "packets of 16",
            Self::CoherentPackets => "coherent packets of 16",
        }
    }
}

/// How the rays of ambient occlusion are traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fans {
    Single,
    /// Sixteen directions of one point.
    OnePoint,
    /// One direction of the lattice for sixteen points.
    SameIndex,
    /// All directions of 64 points, sorted by where they go.
    ByDirection,
    /// The same, told to be coherent.
    ByDirectionCoherent,
}

impl Fans {
    pub(crate) const ALL: [Self; 5] =
        [Self::Single, Self::OnePoint, Self::SameIndex, Self::ByDirection, Self::ByDirectionCoherent];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Single => "single rays",
            Self::OnePoint => "16 of one point",
            Self::SameIndex => "16 across 4x4 pixels",
            Self::ByDirection => "16 by direction in 8x8 pixels",
            Self::ByDirectionCoherent => "16 by direction in 8x8 pixels, coherent",
        }
    }
}

/// How a frame is rendered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Style {
    pub(crate) beams: Beams,
    pub(crate) fans: Fans,
}

/// Renders on the threads of the current pool. `shift` gives how the lattice is shifted at a
/// pixel.
pub(crate) fn render(
    picture: &Picture,
    scene: &Scene,
    style: Style,
    shift: &(impl Fn(u32, u32) -> Vector + Sync),
) -> Vec<Vector> {
    let mut image = vec![[0.0; 3]; picture.width * picture.height];
    let strips = image.par_chunks_mut(SIDE * picture.width).enumerate();
    strips.for_each(|(strip, rows)| ffi::vectorised(Strip { picture, scene, style, shift, strip, rows }));
    image
}

/// Eight rows of the image.
struct Strip<'a, R> {
    picture: &'a Picture,
    scene: &'a Scene,
    style: Style,
    shift: &'a R,
    strip: usize,
    rows: &'a mut [Vector],
}

impl<R: Fn(u32, u32) -> Vector + Sync> Vectorised for Strip<'_, R> {
    #[inline(always)]
    fn run(self) {
        let Self { picture, scene, style, shift, strip, rows } = self;
        let mut beam = Query::new(style.beams == Beams::CoherentPackets);
        let mut fan = occlusion::Tracer::new(scene, style.fans, picture);
        let mut tile = Tile::new();
        for left in (0..picture.width).step_by(SIDE) {
            tile.reset((left, SIDE * strip));
            for block in 0..BLOCKS {
                tile.see(picture, scene, style.beams, &mut beam, block);
                for light in &picture.lights {
                    tile.light(scene, style.beams, &mut beam, block, light);
                }
            }
            if !picture.azimuths.is_empty() {
                fan.tile(&mut tile, shift);
            }
            tile.finish(picture, left, rows);
        }
    }
}

/// What is known of the points that the pixels of a tile see.
pub(super) struct Tile {
    /// Pixels of the image from its top left corner.
    pub(super) corner: (usize, usize),
    /// Points on their surfaces.
    surface: [[f32; PIXELS]; 3],
    /// The same points off them.
    pub(super) point: [[f32; PIXELS]; 3],
    /// Toward the eye.
    pub(super) normal: [[f32; PIXELS]; 3],
    pub(super) seen: [bool; PIXELS],
    /// c_a.
    pub(super) openness: [f32; PIXELS],
    radiance: [[f32; PIXELS]; 3],
}

impl Tile {
    fn new() -> Self {
        Self {
            corner: (0, 0),
            surface: [[0.0; PIXELS]; 3],
            point: [[0.0; PIXELS]; 3],
            normal: [[0.0; PIXELS]; 3],
            seen: [false; PIXELS],
            openness: [1.0; PIXELS],
            radiance: [[0.0; PIXELS]; 3],
        }
    }

    fn reset(&mut self, corner: (usize, usize)) {
        self.corner = corner;
        self.openness = [1.0; PIXELS];
        self.radiance = [[0.0; PIXELS]; 3];
    }

    /// Where a pixel of the tile lies in it: blocks of 4 x 4, row by row.
    #[inline(always)]
    pub(super) fn offset(pixel: usize) -> (usize, usize) {
        let (block, lane) = (pixel / LANES, pixel % LANES);
        (4 * (block % 2) + lane % 4, 4 * (block / 2) + lane / 4)
    }

    /// Traces the primary rays of a block.
    #[inline(always)]
    fn see(&mut self, picture: &Picture, scene: &Scene, beams: Beams, query: &mut Query, block: usize) {
        let mut direction = [[0.0; LANES]; 3];
        for lane in 0..LANES {
            let (x, y) = Self::offset(block * LANES + lane);
            let (x, y) = ((self.corner.0 + x) as f32 + 0.5, (self.corner.1 + y) as f32 + 0.5);
            for axis in 0..3 {
                direction[axis][lane] =
                    picture.top_left[axis] + picture.right[axis] * x + picture.down[axis] * y;
            }
        }
        normalize(&mut direction);
        let origin = picture.eye.map(|coordinate| [coordinate; LANES]);
        let found = intersect(scene, beams, origin, direction, query);
        let mut normal = found.hits.normal;
        if !picture.normal_matrices.is_empty() {
            for lane in (0..LANES).filter(|&lane| found.hits.geometry[lane] != ffi::NONE) {
                let rows = picture.normal_matrices[scene.object(&found.hits, lane) as usize];
                let old = normal.map(|axis| axis[lane]);
                for axis in 0..3 {
                    normal[axis][lane] = dot(rows[axis], old);
                }
            }
        }
        normalize(&mut normal);
        let first = block * LANES;
        for lane in 0..LANES {
            let along = normal[0][lane] * direction[0][lane]
                + normal[1][lane] * direction[1][lane]
                + normal[2][lane] * direction[2][lane];
            let side = if along > 0.0 { -1.0 } else { 1.0 };
            for axis in 0..3 {
                let facing = side * normal[axis][lane];
                let surface = picture.eye[axis] + found.rays.t_far[lane] * direction[axis][lane];
                self.normal[axis][first + lane] = facing;
                self.surface[axis][first + lane] = surface;
                self.point[axis][first + lane] = surface + facing * picture.off_surface;
            }
            self.seen[first + lane] = found.hits.geometry[lane] != ffi::NONE;
        }
    }

    /// Adds the term of a light to a block.
    #[inline(always)]
    fn light(
        &mut self,
        scene: &Scene,
        beams: Beams,
        query: &mut Query,
        block: usize,
        (position, intensity): &(Vector, Vector),
    ) {
        let first = block * LANES;
        let mut origin = [[0.0; LANES]; 3];
        let mut direction = [[0.0; LANES]; 3];
        for axis in 0..3 {
            for lane in 0..LANES {
                origin[axis][lane] = self.point[axis][first + lane];
                direction[axis][lane] = position[axis] - self.surface[axis][first + lane];
            }
        }
        let mut strength = [0.0; LANES];
        let mut valid = [0; LANES];
        for lane in 0..LANES {
            let to_light = [direction[0][lane], direction[1][lane], direction[2][lane]];
            let normal = [0, 1, 2].map(|axis| self.normal[axis][first + lane]);
            let (along, square) = (dot(normal, to_light), dot(to_light, to_light));
            // (N.L) / r^2
            strength[lane] = along / (square * square.sqrt());
            valid[lane] = if self.seen[first + lane] && along > 0.0 { -1 } else { 0 };
        }
        if valid == [0; LANES] {
            return;
        }
        let blocked = occluded(scene, beams, origin, direction, [1.0; LANES], &valid, query);
        for lane in 0..LANES {
            let visible = valid[lane] != 0 && blocked[lane] >= 0.0;
            let strength = if visible { strength[lane] } else { 0.0 };
            for channel in 0..3 {
                self.radiance[channel][first + lane] += intensity[channel] * strength;
            }
        }
    }

    /// Adds the ambient term and puts the tile into its rows.
    #[inline(always)]
    fn finish(&self, picture: &Picture, left: usize, rows: &mut [Vector]) {
        for pixel in 0..PIXELS {
            let (x, y) = Self::offset(pixel);
            rows[y * picture.width + left + x] = std::array::from_fn(|channel| match self.seen[pixel] {
                true => self.radiance[channel][pixel] + picture.ambient[channel] * self.openness[pixel],
                false => picture.background[channel],
            });
        }
    }
}

#[inline(always)]
fn intersect(
    scene: &Scene,
    beams: Beams,
    origin: [Lanes; 3],
    direction: [Lanes; 3],
    query: &mut Query,
) -> RayHits<LANES> {
    let mut found = Aligned(RayHits::new(Rays::new(origin, direction, [f32::INFINITY; LANES])));
    if beams != Beams::Single {
        scene.intersect(&Aligned([-1; LANES]), &mut found, query);
        return found.0;
    }
    for lane in 0..LANES {
        let one = |vector: &[Lanes; 3]| [[vector[0][lane]], [vector[1][lane]], [vector[2][lane]]];
        let mut single = Aligned(RayHits::new(Rays::new(one(&origin), one(&direction), [f32::INFINITY])));
        scene.intersect(&Aligned([-1]), &mut single, query);
        found.0.rays.t_far[lane] = single.0.rays.t_far[0];
        (0..3).for_each(|axis| found.0.hits.normal[axis][lane] = single.0.hits.normal[axis][0]);
        found.0.hits.geometry[lane] = single.0.hits.geometry[0];
        found.0.hits.instance[lane] = single.0.hits.instance[0];
        found.0.hits.instance_primitive[lane] = single.0.hits.instance_primitive[0];
    }
    found.0
}

/// The rays' ends, below 0 where something is in the way.
#[inline(always)]
fn occluded(
    scene: &Scene,
    beams: Beams,
    origin: [Lanes; 3],
    direction: [Lanes; 3],
    t_far: Lanes,
    valid: &[i32; LANES],
    query: &mut Query,
) -> Lanes {
    let mut rays = Aligned(Rays::new(origin, direction, t_far));
    if beams != Beams::Single {
        scene.occluded(&Aligned(*valid), &mut rays, query);
        return rays.0.t_far;
    }
    for lane in (0..LANES).filter(|&lane| valid[lane] != 0) {
        let one = |vector: &[Lanes; 3]| [[vector[0][lane]], [vector[1][lane]], [vector[2][lane]]];
        let mut single = Aligned(Rays::new(one(&origin), one(&direction), [t_far[lane]]));
        scene.occluded(&Aligned([-1]), &mut single, query);
        rays.0.t_far[lane] = single.0.t_far[0];
    }
    rays.0.t_far
}

#[inline(always)]
fn normalize(vectors: &mut [Lanes; 3]) {
    for lane in 0..LANES {
        let [x, y, z] = [vectors[0][lane], vectors[1][lane], vectors[2][lane]];
        let scale = 1.0 / (x * x + y * y + z * z).sqrt();
        vectors[0][lane] = x * scale;
        vectors[1][lane] = y * scale;
        vectors[2][lane] = z * scale;
    }
}

#[inline(always)]
pub(super) fn dot(a: Vector, b: Vector) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
