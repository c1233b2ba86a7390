//! What is seen where, instead of how it looks: the surface behind each pixel.
//!
//! In: a world and a camera. Out: the surface that the picture shows at a point of it, or at the centre of every
//! pixel. It knows no light.

use super::RenderError;
use crate::accel::Uncounted;
use crate::camera::{Camera, CameraError};
use crate::cancel::CancelToken;
use crate::geometry::{DVec2, DVec3, Ray};
use crate::scene::{MaterialId, NodeId, Settings};
use crate::world::{Intersection, ObjectId, World};
use rayon::prelude::*;

/// The surface at a point of the image. Space: the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Feature {
    /// What is seen.
    pub object: ObjectId,
    /// The scene's node that it came from.
    pub node: NodeId,
    /// Its material.
    pub material: MaterialId,
    /// Which face or triangle of it.
    pub primitive: u32,
    /// How far from the eye.
    pub distance: f64,
    /// Where.
    pub point: DVec3,
    /// The unit normal of the surface, on the side of the eye.
    pub geometric_normal: DVec3,
    /// N of the illumination model: the unit normal for shading, on the same side.
    pub shading_normal: DVec3,
    /// Texture coordinates.
    pub uv: DVec2,
}

/// What the picture of `width` by `height` pixels shows at a point of it, in pixels from its top left corner; the
/// point may lie between pixels and outside of the image. None where a ray there meets nothing.
///
/// # Errors
/// See [`CameraError`].
pub fn feature_at(
    world: &World,
    camera: &Camera,
    width: u32,
    height: u32,
    x: f64,
    y: f64,
) -> Result<Option<Feature>, CameraError> {
    let ray = camera.project(width, height)?.ray(x, y);
    Ok(seen(world, &ray).map(|at| Feature {
        object: at.object,
        node: world.object(at.object).node(),
        material: at.material,
        primitive: at.primitive,
        distance: at.t,
        point: at.point,
        geometric_normal: at.facing_geometric_normal(),
        shading_normal: at.facing_normal(),
        uv: at.uv,
    }))
}

/// The surface that a camera ray shows.
pub(super) fn seen(world: &World, ray: &Ray) -> Option<Intersection> {
    let hit = world.intersect(ray)?;
    let mut at = world.intersection(ray, &hit);
    world.see(ray, &mut at, &Uncounted);
    Some(at)
}

/// What is seen at the centre of each pixel. It outlives the world that it was found in.
#[derive(Clone, Debug, PartialEq)]
pub struct Features {
    width: u32,
    height: u32,
    /// Top row first.
    pixels: Vec<Option<Seen>>,
    /// Where each object came from and what it is made of, by its id.
    objects: Vec<(NodeId, MaterialId)>,
}

/// What is kept of a pixel, 24 bytes with its absence. Lengths and directions in the precision of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Seen {
    object: ObjectId,
    distance: f32,
    normal: [f32; 3],
}

/// What is seen at the centre of each pixel of an image. Takes one ray a pixel, on the threads of the current rayon
/// pool.
///
/// # Errors
/// See [`RenderError`].
pub fn render_features(
    world: &World,
    camera: &Camera,
    width: u32,
    height: u32,
    cancel: &CancelToken,
) -> Result<Features, RenderError> {
    Settings { width, height, ..Settings::default() }.validate()?;
    let projection = camera.project(width, height)?;
    let mut pixels = vec![None; width as usize * height as usize];
    pixels.par_chunks_mut(width as usize).enumerate().try_for_each(|(y, row)| {
        for (x, pixel) in row.iter_mut().enumerate() {
            if cancel.is_cancelled() {
                return Err(RenderError::Cancelled);
            }
            let ray = projection.ray(x as f64 + 0.5, y as f64 + 0.5);
            *pixel = seen(world, &ray).map(|at| Seen::new(&at));
        }
        Ok(())
    })?;
    let objects = world.objects().iter().map(|object| (object.node(), object.material())).collect();
    Ok(Features { width, height, pixels, objects })
}

impl Seen {
    fn new(at: &Intersection) -> Self {
        let normal = at.facing_normal().as_vec3().to_array();
        Self { object: at.object, distance: at.t as f32, normal }
    }
}

impl Features {
    /// Pixels in a row.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// How far the surface is from the eye, to the precision of an `f32`; none where nothing is seen.
    ///
    /// # Panics
    /// Where the pixel is outside of the image, as all that ask for one.
    pub fn distance(&self, x: u32, y: u32) -> Option<f64> {
        self.seen(x, y).map(|seen| f64::from(seen.distance))
    }

    /// The object that is seen.
    pub fn object(&self, x: u32, y: u32) -> Option<ObjectId> {
        self.seen(x, y).map(|seen| seen.object)
    }

    /// The scene's node that it came from.
    pub fn node(&self, x: u32, y: u32) -> Option<NodeId> {
        self.object(x, y).map(|object| self.objects[object.index()].0)
    }

    /// Its material.
    pub fn material(&self, x: u32, y: u32) -> Option<MaterialId> {
        self.object(x, y).map(|object| self.objects[object.index()].1)
    }

    /// The unit normal for shading in the world, on the side of the eye, to the precision of an `f32`.
    pub fn normal(&self, x: u32, y: u32) -> Option<DVec3> {
        self.seen(x, y).map(|seen| seen.normal.map(f64::from).into())
    }

    fn seen(&self, x: u32, y: u32) -> Option<&Seen> {
        assert!(x < self.width && y < self.height, "pixel {x},{y} of {} x {}", self.width, self.height);
        self.pixels[y as usize * self.width as usize + x as usize].as_ref()
    }
}
