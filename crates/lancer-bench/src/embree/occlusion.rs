//! Ambient occlusion on Embree, for the 64 points of a tile, with packets filled in several ways.

use super::ffi::{Aligned, Query, Rays, Scene};
use super::renderer::{Fans, LANES, PIXELS, Picture, Tile, Vector, dot};

/// Cells along each side of the square that [`direction_bin`] lays directions out on.
const SIDE: f32 = 16.0;
/// Cells of the sphere.
const BINS: usize = 256;

/// Which of 256 cells of the sphere a direction lies in; neighbours on the sphere are mostly neighbours in number.
///
/// The sphere is unfolded by an octahedron onto a square, whose cells are numbered along a Z curve.
#[inline(always)]
pub(crate) fn direction_bin([x, y, z]: Vector) -> usize {
    let scale = 1.0 / (x.abs() + y.abs() + z.abs());
    let (mut u, mut v) = (x * scale, y * scale);
    if z < 0.0 {
        (u, v) = ((1.0 - v.abs()).copysign(u), (1.0 - u.abs()).copysign(v));
    }
    let cell = |w: f32| ((0.5 * w + 0.5) * SIDE).clamp(0.0, SIDE - 1.0) as usize;
    let spread = |bits: usize| (bits & 1) | (bits & 2) << 1 | (bits & 4) << 2 | (bits & 8) << 3;
    spread(cell(u)) | spread(cell(v)) << 1
}

/// One ray of a tile, from the point that a pixel sees.
#[derive(Clone, Copy)]
struct Spoke {
    direction: Vector,
    /// n . w, above 0.
    weight: f32,
    pixel: u32,
}

/// Finds c_a for one tile after another, in memory that is used again.
pub(super) struct Tracer<'a> {
    scene: &'a Scene,
    fans: Fans,
    picture: &'a Picture,
    query: Query,
    spokes: Vec<Spoke>,
    sorted: Vec<Spoke>,
}

impl<'a> Tracer<'a> {
    pub(super) fn new(scene: &'a Scene, fans: Fans, picture: &'a Picture) -> Self {
        let query = Query::new(fans == Fans::ByDirectionCoherent);
        Self { scene, fans, picture, query, spokes: Vec::new(), sorted: Vec::new() }
    }

    /// Fills in the openness of the pixels that see something.
    #[inline(always)]
    pub(super) fn tile(&mut self, tile: &mut Tile, shift: &impl Fn(u32, u32) -> Vector) {
        tile.openness = [0.0; PIXELS];
        if self.fans == Fans::SameIndex {
            for first in (0..PIXELS).step_by(LANES) {
                self.same_index(tile, first, shift);
            }
        } else {
            self.spokes.clear();
            for pixel in 0..PIXELS {
                if !tile.seen[pixel] {
                    continue;
                }
                let before = self.spokes.len();
                self.add_spokes(tile, pixel, shift);
                match self.fans {
                    Fans::OnePoint => self.packets_of_one_point(tile, pixel, before),
                    Fans::Single => self.single_rays(tile, pixel, before),
                    _ => {}
                }
            }
            if matches!(self.fans, Fans::ByDirection | Fans::ByDirectionCoherent) {
                self.sort();
                self.packets_of_many_points(tile);
            }
        }
        let scale = 4.0 / self.picture.samples as f32;
        tile.openness.iter_mut().for_each(|openness| *openness *= scale);
    }

    /// The directions above the horizon of a pixel's point.
    #[inline(always)]
    fn add_spokes(&mut self, tile: &Tile, pixel: usize, shift: &impl Fn(u32, u32) -> Vector) {
        let [u, cos, sin] = shift_of(tile, pixel, shift);
        let frame = turned_frame(at(&tile.normal, pixel), cos, sin);
        let step = 2.0 / self.picture.samples as f32;
        for (i, azimuth) in self.picture.azimuths.iter().enumerate() {
            let weight = 1.0 - (i as f32 + u) * step;
            if weight > 0.0 {
                let radius = (1.0 - weight * weight).max(0.0).sqrt();
                let local = [radius * azimuth[0], radius * azimuth[1], weight];
                let direction = [dot(frame[0], local), dot(frame[1], local), dot(frame[2], local)];
                self.spokes.push(Spoke { direction, weight, pixel: pixel as u32 });
            }
        }
    }

    /// Orders the spokes by where they go.
    #[inline(always)]
    fn sort(&mut self) {
        let mut starts = [0_u32; BINS + 1];
        for spoke in &self.spokes {
            starts[direction_bin(spoke.direction) + 1] += 1;
        }
        for bin in 0..BINS {
            starts[bin + 1] += starts[bin];
        }
        let nothing = Spoke { direction: [0.0; 3], weight: 0.0, pixel: 0 };
        self.sorted.resize(self.spokes.len(), nothing);
        for spoke in &self.spokes {
            let start = &mut starts[direction_bin(spoke.direction)];
            self.sorted[*start as usize] = *spoke;
            *start += 1;
        }
    }

    #[inline(always)]
    fn packets_of_many_points(&mut self, tile: &mut Tile) {
        for chunk in self.sorted.chunks(LANES) {
            let (mut origin, mut direction) = ([[0.0; LANES]; 3], [[1.0; LANES]; 3]);
            let mut valid = [0; LANES];
            for (lane, spoke) in chunk.iter().enumerate() {
                for axis in 0..3 {
                    origin[axis][lane] = tile.point[axis][spoke.pixel as usize];
                    direction[axis][lane] = spoke.direction[axis];
                }
                valid[lane] = -1;
            }
            let mut rays = Aligned(Rays::new(origin, direction, [self.picture.reach; LANES]));
            self.scene.occluded(&Aligned(valid), &mut rays, &mut self.query);
            for (lane, spoke) in chunk.iter().enumerate() {
                if rays.0.t_far[lane] >= 0.0 {
                    tile.openness[spoke.pixel as usize] += spoke.weight;
                }
            }
        }
    }

    /// Spokes from the `first` on, all of one pixel.
    #[inline(always)]
    fn packets_of_one_point(&mut self, tile: &mut Tile, pixel: usize, first: usize) {
        let origin = at(&tile.point, pixel).map(|coordinate| [coordinate; LANES]);
        let mut sum = 0.0;
        for chunk in self.spokes[first..].chunks(LANES) {
            let mut direction = [[1.0; LANES]; 3];
            let mut valid = [0; LANES];
            for (lane, spoke) in chunk.iter().enumerate() {
                for (to, coordinate) in direction.iter_mut().zip(spoke.direction) {
                    to[lane] = coordinate;
                }
                valid[lane] = -1;
            }
            let mut rays = Aligned(Rays::new(origin, direction, [self.picture.reach; LANES]));
            self.scene.occluded(&Aligned(valid), &mut rays, &mut self.query);
            for (lane, spoke) in chunk.iter().enumerate() {
                sum += if rays.0.t_far[lane] >= 0.0 { spoke.weight } else { 0.0 };
            }
        }
        tile.openness[pixel] = sum;
    }

    #[inline(always)]
    fn single_rays(&mut self, tile: &mut Tile, pixel: usize, first: usize) {
        let origin = at(&tile.point, pixel).map(|coordinate| [coordinate]);
        for spoke in &self.spokes[first..] {
            let direction = spoke.direction.map(|coordinate| [coordinate]);
            let mut rays = Aligned(Rays::new(origin, direction, [self.picture.reach]));
            self.scene.occluded(&Aligned([-1]), &mut rays, &mut self.query);
            if rays.0.t_far[0] >= 0.0 {
                tile.openness[pixel] += spoke.weight;
            }
        }
    }

    /// One direction of the lattice after another, for the sixteen pixels from the `first` on.
    #[inline(always)]
    fn same_index(&mut self, tile: &mut Tile, first: usize, shift: &impl Fn(u32, u32) -> Vector) {
        let lanes = |from: &[f32; PIXELS]| -> [f32; LANES] { std::array::from_fn(|lane| from[first + lane]) };
        let mut frames = [[[0.0; LANES]; 3]; 3];
        let mut shifts = [f32::INFINITY; LANES];
        for lane in (0..LANES).filter(|&lane| tile.seen[first + lane]) {
            let [u, cos, sin] = shift_of(tile, first + lane, shift);
            let frame = turned_frame(at(&tile.normal, first + lane), cos, sin);
            shifts[lane] = u;
            for (row, column) in (0..3).flat_map(|row| (0..3).map(move |column| (row, column))) {
                frames[row][column][lane] = frame[row][column];
            }
        }
        let origin = [0, 1, 2].map(|axis| lanes(&tile.point[axis]));
        let step = 2.0 / self.picture.samples as f32;
        let mut sum = [0.0; LANES];
        for (i, azimuth) in self.picture.azimuths.iter().enumerate() {
            let mut direction = [[0.0; LANES]; 3];
            // Where nothing is seen the shift is infinite, and so no weight is above 0.
            let (mut weight, mut radius, mut valid) = ([0.0; LANES], [0.0; LANES], [0; LANES]);
            for lane in 0..LANES {
                weight[lane] = 1.0 - (i as f32 + shifts[lane]) * step;
                radius[lane] = (1.0 - weight[lane] * weight[lane]).max(0.0).sqrt();
                valid[lane] = if weight[lane] > 0.0 { -1 } else { 0 };
            }
            for (to, rows) in direction.iter_mut().zip(&frames) {
                for lane in 0..LANES {
                    to[lane] = (rows[0][lane] * azimuth[0] + rows[1][lane] * azimuth[1]) * radius[lane]
                        + rows[2][lane] * weight[lane];
                }
            }
            if valid == [0; LANES] {
                continue;
            }
            let mut rays = Aligned(Rays::new(origin, direction, [self.picture.reach; LANES]));
            self.scene.occluded(&Aligned(valid), &mut rays, &mut self.query);
            for lane in 0..LANES {
                let open = valid[lane] != 0 && rays.0.t_far[lane] >= 0.0;
                sum[lane] += if open { weight[lane] } else { 0.0 };
            }
        }
        tile.openness[first..first + LANES].copy_from_slice(&sum);
    }
}

#[inline(always)]
fn shift_of(tile: &Tile, pixel: usize, shift: &impl Fn(u32, u32) -> Vector) -> Vector {
    let (x, y) = Tile::offset(pixel);
    shift((tile.corner.0 + x) as u32, (tile.corner.1 + y) as u32)
}

/// The rows of the matrix that carries a direction about +Z to one about the normal, turned by an angle.
///
/// Source of the frame: Duff and others, "Building an Orthonormal Basis, Revisited" (JCGT 6(1), 2017).
#[inline(always)]
fn turned_frame([x, y, z]: Vector, cos: f32, sin: f32) -> [Vector; 3] {
    let sign = 1.0_f32.copysign(z);
    let a = -1.0 / (sign + z);
    let b = x * y * a;
    let tangent = [1.0 + sign * x * x * a, sign * b, -sign * x];
    let bitangent = [b, sign + y * y * a, -y];
    let normal = [x, y, z];
    std::array::from_fn(|row| {
        [tangent[row] * cos + bitangent[row] * sin, bitangent[row] * cos - tangent[row] * sin, normal[row]]
    })
}

#[inline(always)]
fn at(vectors: &[[f32; PIXELS]; 3], pixel: usize) -> Vector {
    [vectors[0][pixel], vectors[1][pixel], vectors[2][pixel]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use lancer_core::geometry::DVec3;
    use lancer_core::sampling::Key;

    #[test]
    fn directions_of_one_bin_are_near_each_other() {
        let lattice = lancer_core::sampling::HemisphereLattice::new(20_000);
        let mut bins = vec![Vec::new(); BINS];
        for normal in [DVec3::Z, DVec3::NEG_Z] {
            for fan in lattice.around(normal, &mut Key::camera(0, 0, 0).stream()) {
                for direction in (0..fan.count).map(|i| fan.direction(i)) {
                    bins[direction_bin(direction.as_vec3().to_array())].push(direction);
                }
            }
        }
        assert!(bins.iter().all(|bin| !bin.is_empty()));
        for bin in bins {
            assert!(bin.iter().all(|direction| direction.dot(bin[0]) > 0.8));
        }
    }
}
