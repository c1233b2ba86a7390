//! What a scene is, in 256 bits.

use lancer_core::Rgb;
use lancer_core::camera::Camera;
use lancer_core::geometry::{DVec3, Transform};
use lancer_core::mesh::{Mesh, MeshData};
use lancer_core::scene::{ImageTexture, Light, Material, Node, Scene, Shape, Texture, Wrap};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::HashMap;
use std::fmt;
use std::str::FromStr;
use std::sync::Arc;

/// SHA-256 over everything in a scene that decides what a ray sees, and over the camera that takes the picture.
///
/// That is: every node's transform, material, shape, children and whether it is hidden; the triangles of every mesh;
/// every material with the texels of its textures; lights, ambient light and background; all in the scene's order,
/// which decides sums and ties. Names are left out, and so are the settings and the tone, which a
/// [`Provenance`](super::Provenance) records as they are.
///
/// ```
/// use lancer_core::scene::Scene;
/// use lancer_io::provenance::SceneHash;
/// let mut scene = Scene::new("one name");
/// let hash = SceneHash::of(&scene, &scene.camera);
/// scene.name = "another".into();
/// assert_eq!(SceneHash::of(&scene, &scene.camera), hash);
/// scene.background = lancer_core::Rgb::WHITE;
/// assert_ne!(SceneHash::of(&scene, &scene.camera), hash);
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub struct SceneHash([u8; 32]);

/// What the bytes mean; to be raised whenever that changes, so that old hashes agree with no new ones.
const FORM: &[u8] = b"lancer scene 2";

impl SceneHash {
    /// The hash of a scene as a camera sees it.
    pub fn of(scene: &Scene, camera: &Camera) -> Self {
        let mut bytes = Bytes::of(scene);
        bytes.camera(camera);
        Self(bytes.hash.finalize().into())
    }

    /// The hash for each of many cameras: as [`SceneHash::of`], but the scene is gone through once.
    pub fn of_each(scene: &Scene, cameras: &[Camera]) -> Vec<Self> {
        let scene = Bytes::of(scene);
        let of = |camera| {
            let mut bytes = scene.clone();
            bytes.camera(camera);
            Self(bytes.hash.finalize().into())
        };
        cameras.iter().map(of).collect()
    }
}

/// What is hashed so far. Every list is preceded by its length and every choice by its number, so that no two scenes
/// are the same bytes.
#[derive(Clone)]
struct Bytes {
    hash: Sha256,
    /// The shared parts that are hashed, by where they are, and their places in the order of that.
    meshes: HashMap<*const Mesh, usize>,
    images: HashMap<*const ImageTexture, usize>,
}

impl Bytes {
    /// All of a scene but its cameras.
    fn of(scene: &Scene) -> Self {
        let mut bytes = Self { hash: Sha256::new(), meshes: HashMap::new(), images: HashMap::new() };
        bytes.hash.update(FORM);
        bytes.rgb(scene.ambient);
        bytes.rgb(scene.background);
        bytes.list(&scene.lights, Bytes::light);
        bytes.list(scene.materials(), Bytes::material);
        bytes.list(scene.nodes(), Bytes::node);
        bytes.list(scene.roots(), |bytes, root| bytes.integer(root.index()));
        bytes
    }

    fn integer(&mut self, value: usize) {
        self.hash.update((value as u64).to_le_bytes());
    }

    fn number(&mut self, value: f64) {
        self.hash.update(value.to_bits().to_le_bytes());
    }

    fn vector(&mut self, value: DVec3) {
        value.to_array().into_iter().for_each(|value| self.number(value));
    }

    fn rgb(&mut self, value: Rgb) {
        value.to_array().into_iter().for_each(|value| self.number(value));
    }

    fn list<T>(&mut self, items: &[T], mut item: impl FnMut(&mut Self, &T)) {
        self.integer(items.len());
        items.iter().for_each(|value| item(self, value));
    }

    /// Many small values, a block at a time.
    fn block<T: Copy, const N: usize>(&mut self, items: &[T], bytes_of: impl Fn(T) -> [u8; N]) {
        const ITEMS: usize = 4096;
        self.integer(items.len());
        let mut block = Vec::with_capacity(N * ITEMS);
        for items in items.chunks(ITEMS) {
            block.clear();
            items.iter().for_each(|&item| block.extend_from_slice(&bytes_of(item)));
            self.hash.update(&block);
        }
    }

    fn camera(&mut self, camera: &Camera) {
        let Camera { eye, target, up, fov } = *camera;
        [eye, target, up].into_iter().for_each(|vector| self.vector(vector));
        self.number(fov);
    }

    fn light(&mut self, light: &Light) {
        let Light { name: _, position, intensity } = light;
        self.vector(*position);
        self.rgb(*intensity);
    }

    fn material(&mut self, material: &Material) {
        let Material {
            name: _,
            color,
            ambient,
            diffuse,
            specular,
            metallic,
            shininess,
            reflect,
            transmit,
            ior,
            fresnel,
        } = material;
        self.texture(color);
        for coefficient in [ambient, diffuse, specular, metallic, reflect, transmit] {
            self.rgb(*coefficient);
        }
        self.number(*shininess);
        self.number(*ior);
        self.integer(usize::from(*fresnel));
    }

    fn texture(&mut self, texture: &Texture) {
        match texture {
            Texture::Solid(color) => {
                self.integer(0);
                self.rgb(*color);
            }
            Texture::Checker { even, odd, size } => {
                self.integer(1);
                self.rgb(*even);
                self.rgb(*odd);
                self.number(*size);
            }
            Texture::Image { image, wrap } => {
                self.integer(2);
                self.image(image);
                for wrap in wrap {
                    self.integer(match wrap {
                        Wrap::Repeat => 0,
                        Wrap::Clamp => 1,
                        Wrap::Mirror => 2,
                    });
                }
            }
        }
    }

    fn image(&mut self, image: &Arc<ImageTexture>) {
        let next = self.images.len();
        let place = *self.images.entry(Arc::as_ptr(image)).or_insert(next);
        self.integer(place);
        if place == next {
            self.integer(image.width() as usize);
            self.integer(image.height() as usize);
            self.block(image.texels(), |texel| texel);
        }
    }

    fn node(&mut self, node: &Node) {
        let Node { name: _, transform, material, shape, children, hidden } = node;
        self.transform(*transform);
        self.integer(material.map_or(0, |material| 1 + material.index()));
        match shape {
            None => self.integer(0),
            Some(Shape::Sphere) => self.integer(1),
            Some(Shape::Cube) => self.integer(2),
            Some(Shape::Cylinder { capped }) => self.integer(3 + usize::from(*capped)),
            Some(Shape::Plane) => self.integer(5),
            Some(Shape::Mesh(mesh)) => {
                self.integer(6);
                self.mesh(mesh);
            }
        }
        self.list(children, |bytes, child| bytes.integer(child.index()));
        self.integer(usize::from(*hidden));
    }

    fn transform(&mut self, transform: Transform) {
        let linear = transform.linear();
        [linear.x_axis, linear.y_axis, linear.z_axis, transform.translation()]
            .into_iter()
            .for_each(|column| self.vector(column));
    }

    fn mesh(&mut self, mesh: &Arc<Mesh>) {
        let next = self.meshes.len();
        let place = *self.meshes.entry(Arc::as_ptr(mesh)).or_insert(next);
        self.integer(place);
        if place == next {
            let MeshData { positions, normals, uvs, colors, indices } = mesh.data();
            self.block(positions.as_flattened(), f32::to_le_bytes);
            self.block(normals.as_flattened(), f32::to_le_bytes);
            self.block(uvs.as_flattened(), f32::to_le_bytes);
            self.block(colors.as_flattened(), f32::to_le_bytes);
            self.block(indices.as_flattened(), u32::to_le_bytes);
        }
    }
}

impl fmt::Display for SceneHash {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(PREFIX)?;
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

impl fmt::Debug for SceneHash {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

const PREFIX: &str = "sha256:";

/// A text is no hash.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a hash is written sha256: and 64 hexadecimal digits")]
pub struct HashError;

impl FromStr for SceneHash {
    type Err = HashError;

    fn from_str(text: &str) -> Result<Self, HashError> {
        let digits = text.strip_prefix(PREFIX).ok_or(HashError)?.as_bytes();
        let mut hash = [0; 32];
        if digits.len() != 2 * hash.len() {
            return Err(HashError);
        }
        let digit = |digit: u8| char::from(digit).to_digit(16).map(|digit| digit as u8).ok_or(HashError);
        for (byte, pair) in hash.iter_mut().zip(digits.chunks_exact(2)) {
            *byte = digit(pair[0])? << 4 | digit(pair[1])?;
        }
        Ok(Self(hash))
    }
}

impl From<SceneHash> for String {
    fn from(hash: SceneHash) -> Self {
        hash.to_string()
    }
}

impl TryFrom<String> for SceneHash {
    type Error = HashError;

    fn try_from(text: String) -> Result<Self, HashError> {
        text.parse()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle(x: f32) -> Arc<Mesh> {
        let positions = vec![[x, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        Arc::new(Mesh::new(MeshData { positions, indices: vec![[0, 1, 2]], ..MeshData::default() }).unwrap())
    }

    fn texture(green: u8) -> Texture {
        Arc::new(ImageTexture::new(1, 1, vec![[0, green, 0]]).unwrap()).into()
    }

    fn scene() -> Scene {
        let mut scene = Scene::new("a scene");
        let paint = scene.add_material(Material { color: texture(7), ..Material::named("paint") });
        scene.add(Node::shape("ball", Shape::Sphere).with_material(paint));
        let leaf = scene.insert(Node::mesh("leaf", triangle(0.0)));
        scene.add(Node::group("tree", [leaf]));
        scene.add_light(DVec3::Y, Rgb::WHITE);
        scene
    }

    fn hash(scene: &Scene) -> SceneHash {
        SceneHash::of(scene, &scene.camera)
    }

    #[test]
    fn the_same_scene_made_twice_has_one_hash() {
        assert_eq!(hash(&scene()), hash(&scene()));
    }

    #[test]
    fn everything_that_decides_a_pixel_changes_the_hash() {
        let edits: [fn(&mut Scene); 19] = [
            |scene| scene.camera.eye.x += 1.0,
            |scene| scene.camera.fov += 1.0,
            |scene| scene.ambient = Rgb::WHITE,
            |scene| scene.background = Rgb::WHITE,
            |scene| scene.lights[0].position.x = 1.0,
            |scene| scene.lights[0].intensity.g = 2.0,
            |scene| scene.lights.clear(),
            |scene| scene.materials_mut()[0].color = texture(8),
            |scene| {
                if let Texture::Image { wrap, .. } = &mut scene.materials_mut()[0].color {
                    wrap[1] = Wrap::Clamp;
                }
            },
            |scene| scene.materials_mut()[0].color = Texture::Solid(Rgb::BLACK),
            |scene| scene.materials_mut()[0].ior = 2.0,
            |scene| scene.materials_mut()[0].shininess = 2.0,
            |scene| scene.materials_mut()[0].fresnel = true,
            |scene| scene.materials_mut()[0].metallic.b = 0.5,
            |scene| scene.node_mut(scene.roots()[0]).hidden = true,
            |scene| scene.node_mut(scene.roots()[0]).material = None,
            |scene| scene.node_mut(scene.roots()[0]).transform = Transform::translate(DVec3::X),
            |scene| scene.node_mut(scene.roots()[0]).shape = Some(Shape::Mesh(triangle(0.5))),
            |scene| scene.node_mut(scene.roots()[1]).children.clear(),
        ];
        let mut hashes = vec![hash(&scene())];
        for edit in edits {
            let mut edited = scene();
            edit(&mut edited);
            hashes.push(hash(&edited));
        }
        for (index, hash) in hashes.iter().enumerate() {
            assert!(!hashes[..index].contains(hash), "edit {index} makes no difference");
        }
    }

    #[test]
    fn many_cameras_have_the_hashes_that_each_has_alone() {
        let scene = scene();
        let cameras = [scene.camera, scene.camera.orbited(DVec3::Y, 30.0)];
        assert_eq!(
            SceneHash::of_each(&scene, &cameras),
            cameras.map(|camera| SceneHash::of(&scene, &camera))
        );
    }

    #[test]
    fn names_settings_and_tone_do_not_change_it() {
        let mut renamed = scene();
        renamed.name = "another".into();
        renamed.lights[0].name = "sun".into();
        renamed.materials_mut()[0].name = "varnish".into();
        renamed.node_mut(renamed.roots()[0]).name = "orb".into();
        renamed.settings.samples = 4;
        renamed.tone.exposure = 1.0;
        assert_eq!(hash(&renamed), hash(&scene()));
    }

    #[test]
    fn a_shared_mesh_is_hashed_once() {
        let mut scene = Scene::new("many");
        let positions = vec![[0.5; 3]; 100_000];
        let indices = vec![[0, 1, 2]; 100_000];
        let mesh = Arc::new(Mesh::new(MeshData { positions, indices, ..MeshData::default() }).unwrap());
        for i in 0..10_000 {
            scene.add(Node::mesh(format!("{i}"), Arc::clone(&mesh)));
        }
        // At 2.4 MB each time, this would take minutes.
        assert_eq!(hash(&scene), hash(&scene.clone()));
    }

    #[test]
    fn the_text_of_a_hash_is_read_back_and_others_are_not() {
        let hash = hash(&scene());
        assert_eq!(hash.to_string().parse(), Ok(hash));
        for wrong in ["", "sha256:", "sha256:00", &hash.to_string()[1..], &format!("{hash}0")] {
            assert_eq!(wrong.parse::<SceneHash>(), Err(HashError), "{wrong}");
        }
    }
}
