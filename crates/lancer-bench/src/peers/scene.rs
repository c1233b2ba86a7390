//! What all renderers are to draw: one description, from which each peer's module writes its own scene file.
//!
//! In: a scene made by code. Out: a [`Picture`], flat, with the textures made plain, since no two renderers lay
//! textures alike; and Lancer's own file of it, beside the meshes as PLY that other renderers read too.

use crate::Failure;
use lancer_core::Rgb;
use lancer_core::camera::Camera;
use lancer_core::geometry::{DVec3, Transform};
use lancer_core::mesh::{Mesh, MeshData};
use lancer_core::scene::{
    AmbientOcclusion, Light, Material, MaterialId, NodeId, Scene, Settings, Shape, Texture,
};
use serde_json::{Value, json};
use std::collections::HashMap;
use std::fs;
use std::path::Path;
use std::sync::Arc;

/// A scene as every renderer can say it.
pub(super) struct Picture {
    pub(super) name: String,
    pub(super) camera: Camera,
    pub(super) ambient: Rgb,
    pub(super) background: Rgb,
    pub(super) lights: Vec<Light>,
    pub(super) settings: Settings,
    /// All of one colour each.
    pub(super) materials: Vec<Material>,
    /// Each once, however many things show it.
    pub(super) meshes: Vec<Arc<Mesh>>,
    pub(super) things: Vec<Thing>,
}

/// A shape in its place.
pub(super) struct Thing {
    pub(super) form: Form,
    /// Its place in [`Picture::materials`].
    pub(super) material: usize,
    pub(super) world_from_object: Transform,
}

/// A [`Shape`], its mesh by number.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Form {
    Sphere,
    Cube,
    Cylinder {
        capped: bool,
    },
    Plane,
    /// Its place in [`Picture::meshes`].
    Mesh(usize),
}

impl Picture {
    /// Flattens a scene. Checkers become their mean; what wears an image, as a gallery's sky does, is left out.
    pub(super) fn of(scene: &Scene) -> Self {
        let mut materials = scene.materials().to_vec();
        // Of what names none.
        materials.push(Material::default());
        for material in &mut materials {
            if let Texture::Checker { even, odd, .. } = material.color {
                material.color = ((even + odd) * 0.5).into();
            }
        }
        let mut picture = Self {
            name: scene.name.to_lowercase(),
            camera: scene.camera,
            ambient: scene.ambient,
            background: scene.background,
            lights: scene.lights.clone(),
            settings: Settings { ao: AmbientOcclusion::default(), ..scene.settings },
            materials,
            meshes: Vec::new(),
            things: Vec::new(),
        };
        let mut numbers = HashMap::new();
        for &root in scene.roots() {
            picture.add(scene, root, Transform::IDENTITY, None, &mut numbers);
        }
        let none = picture.materials.len() - 1;
        if picture.things.iter().all(|thing| thing.material != none) {
            picture.materials.pop();
        }
        picture
    }

    fn add(
        &mut self,
        scene: &Scene,
        id: NodeId,
        world_from_parent: Transform,
        inherited: Option<MaterialId>,
        numbers: &mut HashMap<*const Mesh, usize>,
    ) {
        let node = scene.node(id);
        let world_from_object = node.transform.then(world_from_parent);
        let material = node.material.or(inherited);
        if let Some(shape) = &node.shape {
            let form = match shape {
                Shape::Sphere => Form::Sphere,
                Shape::Cube => Form::Cube,
                Shape::Cylinder { capped } => Form::Cylinder { capped: *capped },
                Shape::Plane => Form::Plane,
                Shape::Mesh(mesh) => Form::Mesh(*numbers.entry(Arc::as_ptr(mesh)).or_insert_with(|| {
                    self.meshes.push(Arc::clone(mesh));
                    self.meshes.len() - 1
                })),
            };
            let material = material.map_or(self.materials.len() - 1, MaterialId::index);
            if !matches!(self.materials[material].color, Texture::Image { .. }) {
                self.things.push(Thing { form, material, world_from_object });
            }
        }
        for &child in &node.children {
            self.add(scene, child, world_from_object, material, numbers);
        }
    }

    /// Whether any material that is worn has the property.
    pub(super) fn any_material(&self, has: impl Fn(&Material) -> bool) -> bool {
        self.things.iter().any(|thing| has(&self.materials[thing.material]))
    }

    /// Writes the meshes as `mesh-0.ply` and so on.
    pub(super) fn write_meshes(&self, directory: &Path) -> Result<(), Failure> {
        for (number, mesh) in self.meshes.iter().enumerate() {
            fs::write(directory.join(mesh_file(number)), to_ply(mesh.data()))?;
        }
        Ok(())
    }

    /// Lancer's own scene file, in the JSON that YAML contains.
    pub(super) fn to_lancer(&self) -> Value {
        let materials = self.materials.iter().enumerate().map(|(number, material)| {
            let value = json!({
                "color": rgb(color(material)),
                "ambient": rgb(material.ambient),
                "diffuse": rgb(material.diffuse),
                "specular": rgb(material.specular),
                "metallic": rgb(material.metallic),
                "shininess": material.shininess,
                "reflect": rgb(material.reflect),
                "transmit": rgb(material.transmit),
                "ior": material.ior,
                "fresnel": material.fresnel,
            });
            (material_name(number), value)
        });
        let lights = self.lights.iter();
        let lights = lights
            .map(|light| json!({"position": xyz(light.position), "intensity": rgb(light.intensity)}))
            .collect::<Vec<_>>();
        let objects = self.things.iter().map(|thing| {
            let shape = match thing.form {
                Form::Sphere => json!("sphere"),
                Form::Cube => json!("cube"),
                Form::Cylinder { capped } => json!({"cylinder": {"capped": capped}}),
                Form::Plane => json!("plane"),
                // The others draw facets where there are no normals.
                Form::Mesh(mesh) => json!({"mesh": {"file": mesh_file(mesh), "crease": 0}}),
            };
            json!({
                "shape": shape,
                "material": material_name(thing.material),
                "transform": transform_list(&thing.world_from_object),
            })
        });
        json!({
            "format": 1,
            "name": self.name,
            "camera": {
                "eye": xyz(self.camera.eye),
                "target": xyz(self.camera.target),
                "up": xyz(self.camera.up),
                "fov": self.camera.fov,
            },
            "ambient": rgb(self.ambient),
            "background": rgb(self.background),
            "lights": lights,
            "materials": materials.collect::<serde_json::Map<_, _>>(),
            "objects": objects.collect::<Vec<_>>(),
            "render": {
                "width": self.settings.width,
                "height": self.settings.height,
                "samples": self.settings.samples,
                "depth": self.settings.depth,
                "ao": {"samples": self.settings.ao.samples, "distance": self.settings.ao.distance},
            },
        })
    }
}

/// As an author would write it: a scale and a place where there is no more to it.
fn transform_list(world_from_object: &Transform) -> Value {
    if let Some((factor, place)) = scale_and_place(world_from_object) {
        return json!([{"scale": factor}, {"translate": xyz(place)}]);
    }
    let [x, y, z] = columns(world_from_object).map(|column| column.to_array());
    let place = world_from_object.translation().to_array();
    let rows = (0..3).flat_map(|row| [x[row], y[row], z[row], place[row]]);
    json!([{"matrix": rows.chain([0.0, 0.0, 0.0, 1.0]).collect::<Vec<_>>()}])
}

/// Where the object's axes go.
pub(super) fn columns(transform: &Transform) -> [DVec3; 3] {
    [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| transform.vector(axis))
}

/// The transform as a scale by one factor and a translation, if it is no more than that.
fn scale_and_place(transform: &Transform) -> Option<(f64, DVec3)> {
    let [x, y, z] = columns(transform);
    let is_plain = x == DVec3::X * x.x && y == DVec3::Y * x.x && z == DVec3::Z * x.x && x.x > 0.0;
    is_plain.then(|| (x.x, transform.translation()))
}

/// The centre and the radius of what a transform makes of the unit ball, if that is a ball.
pub(super) fn as_ball(transform: &Transform) -> Option<(DVec3, f64)> {
    /// Beyond the rounding of a chain of rotations, and far below a pixel.
    const SLACK: f64 = 1e-9;
    let [x, y, z] = columns(transform);
    let radius = x.length();
    let slack = SLACK * radius * radius;
    let right_angles = [x.dot(y), y.dot(z), z.dot(x)].iter().all(|dot| dot.abs() < slack);
    let same_lengths = [y, z].iter().all(|axis| (axis.length_squared() - radius * radius).abs() < slack);
    (right_angles && same_lengths).then(|| (transform.translation(), radius))
}

/// The one colour of a material of a [`Picture`].
pub(super) fn color(material: &Material) -> Rgb {
    match material.color {
        Texture::Solid(color) => color,
        // `Picture::of` made the others plain or dropped what wears them.
        _ => Rgb::WHITE,
    }
}

/// The mean of a colour's channels, for the renderers that know but one number.
pub(super) fn grey(color: Rgb) -> f64 {
    (color.r + color.g + color.b) / 3.0
}

pub(super) fn mesh_file(number: usize) -> String {
    format!("mesh-{number}.ply")
}

fn material_name(number: usize) -> String {
    format!("material-{number}")
}

pub(super) fn rgb(color: Rgb) -> Value {
    json!(color.to_array())
}

pub(super) fn xyz(vector: DVec3) -> Value {
    json!(vector.to_array())
}

/// Binary PLY: positions, normals where there are any, and triangles.
fn to_ply(data: &MeshData) -> Vec<u8> {
    let normals = if data.normals.is_empty() {
        ""
    } else {
        "property float nx\nproperty float ny\nproperty float nz\n"
    };
    let mut bytes = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty \
         float z\n{normals}element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        data.positions.len(),
        data.indices.len()
    )
    .into_bytes();
    for (i, position) in data.positions.iter().enumerate() {
        let normal = data.normals.get(i).into_iter().flatten();
        bytes.extend(position.iter().chain(normal).flat_map(|x| x.to_le_bytes()));
    }
    for triangle in &data.indices {
        bytes.push(3);
        bytes.extend(triangle.iter().flat_map(|i| i.to_le_bytes()));
    }
    bytes
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::matched::whitted;
    use super::*;

    pub(in super::super) fn octahedron() -> MeshData {
        MeshData {
            positions: vec![
                [1.0, 0.0, 0.0],
                [-1.0, 0.0, 0.0],
                [0.0, 1.0, 0.0],
                [0.0, -1.0, 0.0],
                [0.0, 0.0, 1.0],
                [0.0, 0.0, -1.0],
            ],
            indices: vec![
                [0, 2, 4],
                [2, 1, 4],
                [1, 3, 4],
                [3, 0, 4],
                [2, 0, 5],
                [1, 2, 5],
                [3, 1, 5],
                [0, 3, 5],
            ],
            ..MeshData::default()
        }
    }

    #[test]
    fn what_lancer_reads_back_is_the_picture_that_was_written() {
        let scene = whitted(&Arc::new(Mesh::new(octahedron()).unwrap()));
        let picture = Picture::of(&scene);
        let directory = std::env::temp_dir().join(format!("lancer-peers-{}", std::process::id()));
        fs::create_dir_all(&directory).unwrap();
        picture.write_meshes(&directory).unwrap();
        let file = directory.join("scene.json");
        fs::write(&file, picture.to_lancer().to_string()).unwrap();
        let read = lancer_io::load(&file, &lancer_io::LoadOptions::default()).unwrap().scene;
        fs::remove_dir_all(&directory).unwrap();
        assert_eq!(read.camera, scene.camera);
        assert_eq!(read.settings, scene.settings);
        assert_eq!(read.roots().len(), 4);
        let glass = read.materials().iter().find(|material| material.fresnel).unwrap();
        assert_eq!(glass.transmit, Rgb::WHITE);
    }

    #[test]
    fn a_turned_ball_is_a_ball_and_a_stretched_one_is_none() {
        let turned = Transform::scale(DVec3::splat(2.0)).then(Transform::rotate(DVec3::ONE, 33.0));
        assert!(as_ball(&turned).is_some_and(|(_, radius)| (radius - 2.0).abs() < 1e-12));
        assert!(as_ball(&Transform::scale(DVec3::new(1.0, 2.0, 1.0))).is_none());
    }
}
