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
    pub(super) fn tile(&mut self, tile: &mut Tile, rotation: &impl Fn(u32, u32) -> [Vector; 3]) {
        tile.openness = [0.0; PIXELS];
        if self.fans == Fans::SameIndex {
            for first in (0..PIXELS).step_by(LANES) {
                self.same_index(tile, first, rotation);
            }
        } else {
            self.spokes.clear();
            for pixel in 0..PIXELS {
                if !tile.seen[pixel] {
                    continue;
                }
                let before = self.spokes.len();
                self.add_spokes(tile, pixel, rotation);
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
        let scale = 4.0 / self.picture.lattice.len() as f32;
        tile.openness.iter_mut().for_each(|openness| *openness *= scale);
    }

    /// The directions above the horizon of a pixel's point.
    #[inline(always)]
    fn add_spokes(&mut self, tile: &Tile, pixel: usize, rotation: &impl Fn(u32, u32) -> [Vector; 3]) {
        let rows = rotation_of(tile, pixel, rotation);
        let normal = at(&tile.normal, pixel);
        for &direction in &self.picture.lattice {
            let direction = [dot(rows[0], direction), dot(rows[1], direction), dot(rows[2], direction)];
            let weight = dot(normal, direction);
            if weight > 0.0 {
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
    fn same_index(&mut self, tile: &mut Tile, first: usize, rotation: &impl Fn(u32, u32) -> [Vector; 3]) {
        let lanes = |from: &[f32; PIXELS]| -> [f32; LANES] { std::array::from_fn(|lane| from[first + lane]) };
        let mut matrix = [[[0.0; LANES]; 3]; 3];
        for lane in (0..LANES).filter(|&lane| tile.seen[first + lane]) {
            let rows = rotation_of(tile, first + lane, rotation);
            for (row, column) in (0..3).flat_map(|row| (0..3).map(move |column| (row, column))) {
                matrix[row][column][lane] = rows[row][column];
            }
        }
        let origin = [0, 1, 2].map(|axis| lanes(&tile.point[axis]));
        let normal = [0, 1, 2].map(|axis| lanes(&tile.normal[axis]));
        let mut sum = [0.0; LANES];
        for lattice in &self.picture.lattice {
            let mut direction = [[0.0; LANES]; 3];
            for (to, rows) in direction.iter_mut().zip(&matrix) {
                for lane in 0..LANES {
                    to[lane] =
                        rows[0][lane] * lattice[0] + rows[1][lane] * lattice[1] + rows[2][lane] * lattice[2];
                }
            }
            let (mut weight, mut valid) = ([0.0; LANES], [0; LANES]);
            for lane in 0..LANES {
                weight[lane] = normal[0][lane] * direction[0][lane]
                    + normal[1][lane] * direction[1][lane]
                    + normal[2][lane] * direction[2][lane];
                // Where nothing is seen the matrix is zero, and so is the weight or it is not a number.
                valid[lane] = if weight[lane] > 0.0 { -1 } else { 0 };
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
fn rotation_of(tile: &Tile, pixel: usize, rotation: &impl Fn(u32, u32) -> [Vector; 3]) -> [Vector; 3] {
    let (x, y) = Tile::offset(pixel);
    rotation((tile.corner.0 + x) as u32, (tile.corner.1 + y) as u32)
}

#[inline(always)]
fn at(vectors: &[[f32; PIXELS]; 3], pixel: usize) -> Vector {
    [vectors[0][pixel], vectors[1][pixel], vectors[2][pixel]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_of_one_bin_are_near_each_other() {
        let lattice = lancer_core::sampling::SphereLattice::new(10_000);
        let mut bins = vec![Vec::new(); BINS];
        for direction in lattice.directions() {
            bins[direction_bin(direction.as_vec3().to_array())].push(*direction);
        }
        assert!(bins.iter().all(|bin| !bin.is_empty()));
        for bin in bins {
            assert!(bin.iter().all(|direction| direction.dot(bin[0]) > 0.8));
        }
    }
}
