//! Which pixels can show anything but the background.
//!
//! A picture of a model is half background. What boxes of the trees cover is found once for a picture, and where no box
//! is, no ray need be traced.

use super::Region;
use super::driver::BLOCK;
use crate::camera::Projection;
use crate::geometry::DVec3;
use crate::world::World;

/// A grid over a region of an image, of squares of [`BLOCK`] pixels by as many, that boxes around what is in the world
/// cover, or not.
#[derive(Clone, Debug)]
pub(super) struct Cover {
    columns: usize,
    rows: usize,
    /// Row by row.
    covered: Vec<bool>,
}

/// Boxes to look at: more would leave fewer squares covered in vain, but take longer; these take a fifth of a
/// millisecond.
const BOXES: usize = 1024;

/// What rounding may move a box or a ray in the image, in pixels, is far less than this.
const MARGIN: f64 = 0.01;

impl Cover {
    pub(super) fn new(world: &World, projection: &Projection, region: &Region) -> Self {
        let [columns, rows] = [region.width, region.height].map(|length| length.div_ceil(BLOCK) as usize);
        let mut cover = Self { columns, rows, covered: vec![false; columns * rows] };
        if cover.add_all(world, projection, region).is_none() {
            cover.covered.fill(true);
        }
        cover
    }

    /// Whether anything may be seen in some pixels of the region.
    pub(super) fn holds(&self, pixels: &Region) -> bool {
        let squares =
            |start: u32, length: u32| (start / BLOCK) as usize..(start + length).div_ceil(BLOCK) as usize;
        squares(pixels.y, pixels.height).any(|row| {
            squares(pixels.x, pixels.width).any(|column| self.covered[row * self.columns + column])
        })
    }

    /// None where something has no bounds, or not all before the eye.
    fn add_all(&mut self, world: &World, projection: &Projection, region: &Region) -> Option<()> {
        for corners in world.boxes_around_all(BOXES)? {
            let [x, y] = extent_of(projection, &corners)?;
            let squares = |[from, to]: [f64; 2], start: u32, count: usize| {
                let square = |at: f64| ((at - f64::from(start)) / f64::from(BLOCK)).floor();
                // Saturating: what lies before the first square ends at 0, what lies after the last begins at its end.
                (square(from - MARGIN) as usize).min(count)..((square(to + MARGIN) + 1.0) as usize).min(count)
            };
            let columns = squares(x, region.x, self.columns);
            for row in squares(y, region.y, self.rows) {
                self.covered[row * self.columns..][columns.clone()].fill(true);
            }
        }
        Some(())
    }
}

/// From where to where a box, told by its corners, extends in the image, by axis; none where it is not all before the eye,
/// or so near to its plane that the numbers overflow.
fn extent_of(projection: &Projection, corners: &[DVec3; 8]) -> Option<[[f64; 2]; 2]> {
    let mut extent = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    for corner in corners {
        let (x, y, _) = projection.pixel_of(*corner).filter(|(x, y, _)| x.is_finite() && y.is_finite())?;
        for ([low, high], at) in extent.iter_mut().zip([x, y]) {
            (*low, *high) = (low.min(at), high.max(at));
        }
    }
    Some(extent)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accel::Accelerator;
    use crate::camera::Camera;
    use crate::geometry::{DVec3, Transform, portable};
    use crate::mesh::Mesh;
    use crate::scene::{Node, Scene, Shape};
    use crate::testing::{Random, ball};
    use crate::world::CompileOptions;
    use std::sync::Arc;

    const SIZE: [u32; 2] = [73, 50];
    const REGION: Region = Region { x: 6, y: 3, width: 61, height: 45 };

    /// The pixels of the region in whose middles something is met, and those that are not covered.
    fn met_and_uncovered(world: &World, camera: &Camera) -> (usize, usize) {
        let projection = camera.project(SIZE[0], SIZE[1]).unwrap();
        let cover = Cover::new(world, &projection, &REGION);
        let (mut met, mut uncovered) = (0, 0);
        for (x, y) in (0..REGION.height).flat_map(|y| (0..REGION.width).map(move |x| (x, y))) {
            let ray = projection.ray(f64::from(REGION.x + x) + 0.5, f64::from(REGION.y + y) + 0.5);
            let is_covered = cover.holds(&Region { x, y, width: 1, height: 1 });
            let is_met = world.intersect(&ray).is_some();
            assert!(is_covered || !is_met, "({x}, {y})");
            met += usize::from(is_met);
            uncovered += usize::from(!is_covered);
        }
        (met, uncovered)
    }

    #[test]
    fn whatever_is_met_is_covered_and_most_of_the_rest_is_not() {
        let mesh = Arc::new(Mesh::new(ball(24, 32)).unwrap());
        let shapes = [Shape::Sphere, Shape::Cube, Shape::Cylinder { capped: true }, Shape::Mesh(mesh)];
        let pixels = (REGION.width * REGION.height) as usize;
        let (mut all_met, mut all_uncovered) = (0, 0);
        for (round, accelerator) in Accelerator::ALL.into_iter().cycle().take(30).enumerate() {
            let mut random = Random::new(round as u32);
            let mut scene = Scene::new("few");
            for _ in 0..1 + random.below(4) {
                let transform = random.transform(0.3, 2.0);
                let shape = shapes[random.below(shapes.len())].clone();
                scene.add(Node::shape("one", shape).with_transform(transform));
            }
            let options = CompileOptions { accelerator, ..CompileOptions::default() };
            let world = World::compile(&scene, &options).unwrap();
            let camera = Camera { eye: random.direction() * random.between(4.0, 20.0), ..Camera::default() };
            let (met, uncovered) = met_and_uncovered(&world, &camera);
            all_met += met;
            all_uncovered += uncovered;
        }
        let unmet = 30 * pixels - all_met;
        assert!(
            all_met > 1000 && all_uncovered > unmet / 2,
            "{all_met} met, {all_uncovered} of {unmet} not covered"
        );
    }

    #[test]
    fn thousands_of_objects_and_a_detailed_mesh_leave_little_covered_in_vain() {
        let mesh = Arc::new(Mesh::new(ball(200, 300)).unwrap());
        let mut fine = Scene::new("fine");
        fine.add(Node::mesh("ball", mesh));
        let mut many = Scene::new("many");
        let mut random = Random::new(5);
        for _ in 0..3000 {
            let place = Transform::scale(DVec3::splat(0.01)).then(Transform::translate(random.direction()));
            many.add(Node::shape("one", Shape::Sphere).with_transform(place));
        }
        for scene in [fine, many] {
            let world = World::compile(&scene, &CompileOptions::default()).unwrap();
            let camera = Camera { fov: 60.0, ..Camera::default() };
            let (_, uncovered) = met_and_uncovered(&world, &camera);
            // The ball's disc, of which the radius is this, and the half diagonal of a square and of a box around it.
            let radius = 0.5 * f64::from(SIZE[1]) / portable::tan(30_f64.to_radians()) / 24_f64.sqrt();
            let most = std::f64::consts::PI * (radius + 6.0) * (radius + 6.0);
            let pixels = f64::from(REGION.width * REGION.height);
            assert!(uncovered as f64 > pixels - most, "{uncovered} of {pixels}, {most}");
        }
    }

    #[test]
    fn everything_is_covered_by_a_plane_or_from_within_and_nothing_by_nothing() {
        let pixels = (REGION.width * REGION.height) as usize;
        let within = Camera { eye: DVec3::new(0.1, 0.2, 0.3), ..Camera::default() };
        let far = Camera { eye: DVec3::Z * 500.0, ..Camera::default() };
        let away = Camera { target: DVec3::Z * 900.0, ..far };
        let aside = Camera { target: DVec3::new(500.0, 0.0, 0.0), ..far };
        for (shape, camera, expected) in [
            (Shape::Plane, far, 0),
            (Shape::Cube, within, 0),
            (Shape::Cube, away, 0),
            (Shape::Cube, aside, pixels),
        ] {
            let mut scene = Scene::new("one");
            scene.add(Node::shape("one", shape));
            let world = World::compile(&scene, &CompileOptions::default()).unwrap();
            assert_eq!(met_and_uncovered(&world, &camera).1, expected);
        }
    }
}
