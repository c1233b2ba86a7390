//! What lies under the cursor: the pixel's value and the surface that its middle shows.

use lancer_core::camera::Camera;
use lancer_core::film::Image;
use lancer_core::geometry::DVec2;
use lancer_core::render::{Feature, feature_at};
use lancer_core::scene::Scene;
use lancer_core::world::World;

/// A pixel and what it shows.
#[derive(Clone, Debug)]
pub struct Readout {
    /// The pixel's column.
    pub x: u32,
    /// The pixel's row.
    pub y: u32,
    /// Its linear value, before any exposure; none while it is not known.
    pub value: Option<[f32; 3]>,
    /// The surface in its middle; none where nothing is.
    pub surface: Option<SurfaceReadout>,
}

/// A surface under the cursor.
#[derive(Clone, Debug)]
pub struct SurfaceReadout {
    /// Its geometry.
    pub feature: Feature,
    /// What the scene calls the object, and the material; may be empty.
    pub object: String,
    /// See `object`.
    pub material: String,
    /// How far it is along the viewing axis.
    pub depth: f64,
}

/// What a picture was made of.
#[derive(Clone, Copy)]
pub struct Taken<'a> {
    /// The scene, for names.
    pub scene: &'a Scene,
    /// The world that was rendered.
    pub world: &'a World,
    /// From where.
    pub camera: &'a Camera,
    /// The picture's columns and rows.
    pub size: (u32, u32),
    /// The pixels, if all of them are there.
    pub image: Option<&'a Image>,
}

impl Readout {
    /// What is at an image position; none beside the image.
    pub fn at(position: DVec2, taken: &Taken) -> Option<Self> {
        let (width, height) = taken.size;
        let pixel = position.floor();
        let inside =
            pixel.cmpge(DVec2::ZERO).all() && pixel.x < f64::from(width) && pixel.y < f64::from(height);
        if !inside {
            return None;
        }
        let (x, y) = (pixel.x as u32, pixel.y as u32);
        let middle = pixel + DVec2::splat(0.5);
        let feature = feature_at(taken.world, taken.camera, width, height, middle.x, middle.y).ok().flatten();
        let value = taken.image.map(|image| image.pixel(x, y));
        Some(Self { x, y, value, surface: feature.map(|feature| SurfaceReadout::new(feature, taken)) })
    }
}

impl SurfaceReadout {
    fn new(feature: Feature, taken: &Taken) -> Self {
        let backward =
            taken.camera.frame().map_or(lancer_core::geometry::DVec3::Z, |[_, _, backward]| backward);
        let scene = taken.scene;
        let object =
            scene.nodes().get(feature.node.index()).map_or_else(String::new, |node| node.name.clone());
        // Objects that name no material have the default one, which the scene does not hold.
        let material = scene
            .materials()
            .get(feature.material.index())
            .map_or_else(String::new, |material| material.name.clone());
        let depth = (taken.camera.eye - feature.point).dot(backward);
        Self { feature, object, material, depth }
    }
}
