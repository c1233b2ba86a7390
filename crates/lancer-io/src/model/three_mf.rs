//! 3MF, the 3D Manufacturing Format.
//!
//! In: a zip archive with XML in it. Out: the objects that its build plate holds. An object that several items or
//! components use is there once. Lengths become millimetres, whatever unit the file is in: a scene unit is one. Base
//! materials become materials, colours of triangles' corners become colours of the mesh; of the extensions, colour
//! groups and parts in further files (production) are read, and others told.
//!
//! Source: 3MF Consortium, "3D Manufacturing Format, core specification" 1.3, "materials and properties extension" and
//! "production extension".

mod xml;

use self::xml::{Element, Namespace, Reader};
use super::polygons::{Corner, Excess, Meshes, NONE, Polygons};
use super::text::{kept_name, quoted};
use super::tree::{Grown, ModelNode, ModelTree, TreeError};
use super::{Model, ModelOptions, ModelPart, UpAxis, name_of};
use crate::diagnostics::{Diagnostic, LoadError};
use crate::limits::Limits;
use crate::package::Package;
use crate::resolver::Resolver;
use lancer_core::Rgb;
use lancer_core::geometry::{DVec3, Transform};
use lancer_core::scene::Material;
use std::collections::{HashMap, HashSet};
use std::path::Path;
use std::rc::Rc;
use std::sync::Arc;

/// Where the model is in an archive that does not say it.
const USUAL_PART: &str = "3D/3dmodel.model";

/// Reads the 3MF file at `path`.
pub(super) fn load(path: &Path, resolver: &Resolver, options: &ModelOptions) -> Result<Model, LoadError> {
    let bytes = resolver.read(path)?;
    let package = Package::new(path, bytes, resolver.limits);
    let package = package.map_err(|message| LoadError::new(path, message))?;
    let root = root_part(&package)?;
    let mut loader = Loader::new(&package, options);
    let mut items = Vec::new();
    let mut scale = 1.0;
    let mut waiting = vec![Rc::clone(&root)];
    let mut read = HashSet::from([Rc::clone(&root)]);
    while let Some(name) = waiting.pop() {
        let part = loader.read_part(&name)?;
        if name == root {
            (items, scale) = (part.items, part.millimetres);
        }
        for further in part.named {
            if read.insert(Rc::clone(&further)) {
                waiting.push(further);
            }
        }
    }
    loader.finish(path, &root, &items, scale)
}

/// The part that the archive says is its model, or else the usual one.
fn root_part(package: &Package) -> Result<Rc<str>, LoadError> {
    const RELATIONSHIPS: &str = "_rels/.rels";
    const MODEL: &[u8] = b"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";
    let path = package.path_of(RELATIONSHIPS);
    let Ok(bytes) = package.read(&path) else { return Ok(USUAL_PART.into()) };
    let mut reader = Reader::new(&path, &bytes);
    while let Some(element) = reader.next()? {
        let is_relationship = element.is_start() && element.name() == b"Relationship";
        let is_of_model = is_relationship && element.attribute("Type") == Some(MODEL);
        if let Some(target) = element.text("Target").filter(|_| is_of_model) {
            return Ok(part_name(&target));
        }
    }
    Ok(USUAL_PART.into())
}

/// A part's name in the archive, of a path from its root.
fn part_name(path: &str) -> Rc<str> {
    path.trim_start_matches('/').into()
}

/// An object, by the part that it is in and its id there.
type ObjectKey = (Rc<str>, u32);

/// An object that is used somewhere.
struct Use {
    object: ObjectKey,
    transform: Transform,
    /// Where it is used, for what is wrong with it: the part, and the byte in it.
    place: (Rc<str>, usize),
}

/// A part as far as its objects are not in the loader.
struct Part {
    items: Vec<Use>,
    /// Further parts that it names.
    named: Vec<Rc<str>>,
    /// The length of its unit.
    millimetres: f64,
}

/// Properties of triangles, by id.
enum Properties {
    /// Places in the model's materials.
    Materials(Vec<usize>),
    /// Linear.
    Colors(Vec<[f32; 3]>),
    /// Of a kind that is not read.
    Other,
}

/// What is told of a file once.
#[derive(Clone, Copy, PartialEq, Eq)]
enum PassedOver {
    Element,
    Property,
    Support,
}

struct Loader<'a> {
    package: &'a Package,
    limits: Limits,
    options: &'a ModelOptions,
    parts: Vec<ModelPart>,
    materials: Vec<Material>,
    nodes: Vec<ModelNode>,
    node_of: HashMap<ObjectKey, usize>,
    /// For each node the components that are to be its children.
    uses: Vec<(usize, Use)>,
    /// Bytes that the parts, nodes and materials take.
    taken: usize,
    warnings: Vec<Diagnostic>,
    told: Vec<(PassedOver, Vec<u8>)>,
}

impl<'a> Loader<'a> {
    fn new(package: &'a Package, options: &'a ModelOptions) -> Self {
        Self {
            package,
            limits: package.limits(),
            options,
            parts: Vec::new(),
            materials: Vec::new(),
            nodes: Vec::new(),
            node_of: HashMap::new(),
            uses: Vec::new(),
            taken: 0,
            warnings: Vec::new(),
            told: Vec::new(),
        }
    }

    fn read_part(&mut self, name: &Rc<str>) -> Result<Part, LoadError> {
        let path = self.package.path_of(name);
        let bytes = self.package.read(&path).map_err(|message| LoadError::new(&path, message))?;
        let mut reader = Reader::new(&path, &bytes);
        let mut part = Part { items: Vec::new(), named: Vec::new(), millimetres: 1.0 };
        let mut properties = HashMap::new();
        let mut is_model = false;
        while let Some(element) = reader.next()? {
            if !element.is_start() {
                continue;
            }
            match (element.namespace(), element.name()) {
                (Namespace::Core, b"model") => {
                    is_model = true;
                    part.millimetres = unit(&element)?;
                    refuse_unknown_extensions(&element)?;
                }
                (Namespace::Core, b"resources" | b"build" | b"metadata" | b"metadatagroup") => {}
                (Namespace::Core, b"basematerials") => {
                    let id = element.number("id")?;
                    properties.insert(id, self.base_materials(&element, &mut reader)?);
                }
                (Namespace::Materials, b"colorgroup") => {
                    let id = element.number("id")?;
                    properties.insert(id, color_group(&element, &mut reader)?);
                }
                (Namespace::Materials, b"texture2d") => self.pass_over(PassedOver::Element, &element),
                (Namespace::Materials, _) => {
                    self.take(&element)?;
                    if let Some(Ok(id)) = element.attribute("id").map(|_| element.number("id")) {
                        properties.insert(id, Properties::Other);
                    }
                }
                (Namespace::Core, b"object") => {
                    self.object(name, &element, &mut reader, &properties, &mut part)?;
                }
                (Namespace::Core, b"item") => {
                    self.take(&element)?;
                    part.items.push(use_of(name, &element, &mut part.named)?);
                }
                _ => self.pass_over(PassedOver::Element, &element),
            }
        }
        if !is_model {
            return Err(LoadError::new(&path, "holds no `model` of the 3MF core specification"));
        }
        Ok(part)
    }

    /// Counts something small that the model keeps: a material, an object or a use of one.
    fn take(&mut self, element: &Element) -> Result<(), LoadError> {
        const FOR_EACH: usize = 540;
        self.taken += FOR_EACH;
        match Polygons::default().excess(&self.limits, self.taken) {
            Some(excess) => Err(too_much(element, excess)),
            None => Ok(()),
        }
    }

    fn base_materials(&mut self, outer: &Element, reader: &mut Reader) -> Result<Properties, LoadError> {
        let mut places = Vec::new();
        while let Some(element) = reader.next_within(outer)? {
            if element.is_start() && element.name() == b"base" {
                self.take(&element)?;
                let [r, g, b, alpha] = element.color("displaycolor")?;
                let name = kept_name(&element.text("name").unwrap_or_default());
                self.materials.push(plastic(name, Rgb::new(r, g, b), alpha));
                places.push(self.materials.len() - 1);
            }
        }
        Ok(Properties::Materials(places))
    }

    fn object(
        &mut self,
        part_name: &Rc<str>,
        element: &Element,
        reader: &mut Reader,
        properties: &HashMap<u32, Properties>,
        part: &mut Part,
    ) -> Result<(), LoadError> {
        self.take(element)?;
        let id = element.number("id")?;
        let index = self.nodes.len();
        let name = element.text("name").map_or_else(|| format!("object {id}"), |name| kept_name(&name));
        self.nodes.push(ModelNode { name: name.clone(), ..ModelNode::default() });
        if self.node_of.insert((Rc::clone(part_name), id), index).is_some() {
            return Err(element.fault(format!("there are two objects {id}")).into());
        }
        let is_support = element.attribute("type") == Some(b"support");
        if is_support {
            self.pass_over(PassedOver::Support, element);
        }
        let default = Property::of(element, "pid", "pindex")?;
        while let Some(inner) = reader.next_within(element)? {
            if !inner.is_start() {
                continue;
            }
            match (inner.namespace(), inner.name()) {
                (Namespace::Core, b"mesh") => {
                    let polygons = self.mesh(&inner, reader, properties, default)?;
                    if !is_support {
                        self.add_mesh(index, &name, polygons, &reader.path())?;
                    }
                }
                (Namespace::Core, b"component") => {
                    self.take(&inner)?;
                    let component = use_of(part_name, &inner, &mut part.named)?;
                    if !is_support {
                        self.uses.push((index, component));
                    }
                }
                (Namespace::Core, b"components" | b"metadatagroup" | b"metadata") => {}
                _ => self.pass_over(PassedOver::Element, &inner),
            }
        }
        Ok(())
    }

    /// Vertices and triangles. Groups of the polygons: 0 for no material, else its place and one.
    fn mesh(
        &mut self,
        outer: &Element,
        reader: &mut Reader,
        properties: &HashMap<u32, Properties>,
        default: Option<Property>,
    ) -> Result<ColoredPolygons, LoadError> {
        let mut colored = ColoredPolygons::default();
        while let Some(element) = reader.next_within(outer)? {
            if !element.is_start() {
                continue;
            }
            match (element.namespace(), element.name()) {
                (Namespace::Core, b"vertices" | b"triangles") => {}
                (Namespace::Core, b"vertex") => {
                    let [x, y, z] = ["x", "y", "z"].map(|axis| element.coordinate(axis));
                    colored.polygons.positions.push(DVec3::new(x?, y?, z?));
                    colored.colors.push(NO_COLOR);
                }
                (Namespace::Core, b"triangle") => {
                    self.triangle(&element, properties, default, &mut colored)?;
                }
                _ => self.pass_over(PassedOver::Element, &element),
            }
            if let Some(excess) = colored.excess(&self.limits, self.taken) {
                return Err(too_much(&element, excess));
            }
        }
        Ok(colored)
    }

    fn triangle(
        &mut self,
        element: &Element,
        properties: &HashMap<u32, Properties>,
        default: Option<Property>,
        colored: &mut ColoredPolygons,
    ) -> Result<(), LoadError> {
        let vertices = colored.vertices();
        let mut corners = [0; 3];
        for (corner, attribute) in corners.iter_mut().zip(["v1", "v2", "v3"]) {
            let index: u32 = element.number(attribute)?;
            if index as usize >= vertices {
                let message = format!("vertex {index} is used, but there are only {vertices}, from 0");
                return Err(element.fault(message).into());
            }
            *corner = index;
        }
        let property = Property::of(element, "pid", "p1")?.or(default.map(|default| {
            // A triangle may choose another entry of the object's group.
            let own = element.attribute("p1").and_then(|_| element.number("p1").ok());
            Property { entry: own.unwrap_or(default.entry), ..default }
        }));
        let mut group = 0;
        if let Some(Property { id, entry }) = property {
            match properties.get(&id) {
                Some(Properties::Materials(places)) => match places.get(entry as usize) {
                    Some(place) => group = *place as u32 + 1,
                    None => self.pass_over(PassedOver::Property, element),
                },
                Some(Properties::Colors(colors)) => {
                    let entry_of = |attribute: &str| -> Result<u32, LoadError> {
                        match element.attribute(attribute) {
                            Some(_) => element.number(attribute),
                            None => Ok(entry),
                        }
                    };
                    let entries = [entry, entry_of("p2")?, entry_of("p3")?];
                    let found = entries.map(|entry| colors.get(entry as usize).copied());
                    if found.iter().any(Option::is_none) {
                        self.pass_over(PassedOver::Property, element);
                    }
                    for (corner, color) in corners.iter_mut().zip(found) {
                        *corner = color.map_or(*corner, |color| colored.position_of(*corner, color));
                    }
                }
                Some(Properties::Other) | None => self.pass_over(PassedOver::Property, element),
            }
        }
        let first = colored.polygons.corners.len();
        let corner = |position| Corner { position, uv: NONE, normal: NONE };
        colored.polygons.corners.extend(corners.map(corner));
        colored.polygons.end_face(first, group);
        Ok(())
    }

    fn add_mesh(
        &mut self,
        node: usize,
        name: &str,
        colored: ColoredPolygons,
        path: &Path,
    ) -> Result<(), LoadError> {
        let mut polygons = colored.into_polygons();
        if polygons.triangles() == 0 {
            return Ok(());
        }
        // What is left of the limits is for the objects that follow.
        const FOR_A_TRIANGLE: usize = 100;
        self.taken += polygons.triangles() * FOR_A_TRIANGLE;
        self.limits.triangles -= polygons.triangles();
        if self.options.crease.is_some() {
            polygons.smooth(self.options.crease);
        }
        let made =
            polygons.into_meshes().map_err(|error| LoadError::new(path, format!("`{name}`: {error}")))?;
        let Meshes { meshes, origin } = made;
        let first = self.parts.len();
        for (group, mesh) in meshes {
            let material = (group as usize).checked_sub(1);
            let of_material = material.map(|place| self.materials[place].name.clone());
            let name = of_material.filter(|name| !name.is_empty()).unwrap_or_else(|| name.to_owned());
            self.parts.push(ModelPart { name, mesh: Arc::new(mesh), material });
        }
        let parts = (first..self.parts.len()).collect();
        if origin == DVec3::ZERO {
            self.nodes[node].parts = parts;
        } else {
            let transform = Transform::translate(origin);
            self.nodes.push(ModelNode { transform, parts, ..ModelNode::default() });
            let moved = self.nodes.len() - 1;
            self.nodes[node].children.push(moved);
        }
        Ok(())
    }

    fn pass_over(&mut self, kind: PassedOver, element: &Element) {
        /// The most warnings of a file; names are the file's own.
        const MOST_TOLD: usize = 50;
        let name = if kind == PassedOver::Element { element.full_name().to_vec() } else { Vec::new() };
        let key = (kind, name);
        if self.told.len() >= MOST_TOLD || self.told.contains(&key) {
            return;
        }
        let message = match kind {
            PassedOver::Element => format!("`{}` is passed over", quoted(&key.1)),
            PassedOver::Property => "its property is not read or not there; the default is drawn".to_owned(),
            PassedOver::Support => "objects that are supports are not drawn".to_owned(),
        };
        self.told.push(key);
        self.warnings.push(element.fault(message));
    }

    /// Puts the objects together.
    fn finish(mut self, path: &Path, root: &str, items: &[Use], scale: f64) -> Result<Model, LoadError> {
        for (node, component) in std::mem::take(&mut self.uses) {
            let child = self.add_use(&component)?;
            self.nodes[node].children.push(child);
        }
        let children = items.iter().map(|item| self.add_use(item)).collect::<Result<Vec<_>, _>>()?;
        let transform = Transform::scale(DVec3::splat(scale));
        self.nodes.push(ModelNode { transform, children, ..ModelNode::default() });
        let top = self.nodes.len() - 1;
        let root = self.package.path_of(root);
        let grown = ModelTree::grow(self.nodes, vec![top], self.limits.objects).map_err(|error| {
            let message = match error {
                TreeError::Cycle(_) => "an object is a component of itself".to_owned(),
                TreeError::TooLarge | TreeError::TooMany { .. } => error.to_string(),
            };
            let diagnostic = Diagnostic::new(&root, message);
            LoadError::from(match error.hint() {
                Some(hint) => diagnostic.with_hint(hint),
                None => diagnostic,
            })
        })?;
        let Grown { tree: Some(tree), singular } = grown else {
            return Err(LoadError::new(&root, "its build holds nothing to draw"));
        };
        if !singular.is_empty() {
            let message = format!(
                "{} items or components are not drawn: their transforms flatten them",
                singular.len()
            );
            self.warnings.push(Diagnostic::new(&root, message));
        }
        Ok(Model {
            name: name_of(path),
            parts: self.parts,
            materials: self.materials,
            tree: Some(tree),
            up: UpAxis::Z,
            warnings: self.warnings,
            ..Model::default()
        })
    }

    /// What is wrong at a place, in words that only a reader of the part has: parts are not kept.
    fn fault_at(&self, (part, offset): &(Rc<str>, usize), message: String) -> LoadError {
        let path = self.package.path_of(part);
        match self.package.read(&path) {
            Ok(bytes) => Reader::new(&path, &bytes).fault_at(*offset, message).into(),
            Err(_) => LoadError::new(&path, message),
        }
    }

    /// Adds a node for a use of an object.
    fn add_use(&mut self, used: &Use) -> Result<usize, LoadError> {
        let Some(&object) = self.node_of.get(&used.object) else {
            let (part, id) = &used.object;
            let message = format!("there is no object {id} in `{}`", quoted(part.as_bytes()));
            return Err(self.fault_at(&used.place, message));
        };
        self.nodes.push(ModelNode {
            transform: used.transform,
            children: vec![object],
            ..ModelNode::default()
        });
        Ok(self.nodes.len() - 1)
    }
}

/// The length of a unit in millimetres.
fn unit(element: &Element) -> Result<f64, LoadError> {
    Ok(match element.attribute("unit") {
        None | Some(b"millimeter") => 1.0,
        Some(b"micron") => 0.001,
        Some(b"centimeter") => 10.0,
        Some(b"inch") => 25.4,
        Some(b"foot") => 304.8,
        Some(b"meter") => 1000.0,
        Some(other) => {
            let message = format!("unit is `{}`, which 3MF files do not know", quoted(other));
            return Err(element.fault(message).into());
        }
    })
}

/// Refuses what must not be passed over.
fn refuse_unknown_extensions(element: &Element) -> Result<(), LoadError> {
    let required = element.text("requiredextensions").unwrap_or_default();
    for prefix in required.split_whitespace() {
        if element.namespace_of(prefix.as_bytes()) == Namespace::Other {
            let uri = element.uri_of(prefix.as_bytes()).unwrap_or_else(|| prefix.to_owned());
            let uri = quoted(uri.as_bytes());
            let message = format!("the file requires the extension `{uri}`, which is not read");
            return Err(element.fault(message).into());
        }
    }
    Ok(())
}

/// The object that a component or an item uses, and where it puts it.
fn use_of(part: &Rc<str>, element: &Element, named: &mut Vec<Rc<str>>) -> Result<Use, LoadError> {
    let id = element.number("objectid")?;
    let place = (Rc::clone(part), element.offset());
    let part = match element.text_of(Namespace::Production, "path") {
        Some(path) => {
            let name = part_name(&path);
            named.push(Rc::clone(&name));
            name
        }
        None => Rc::clone(part),
    };
    let transform = match element.attribute("transform") {
        Some(_) => {
            let [x, y, z, t] = element.columns("transform")?;
            Transform::from_columns(x, y, z, t)
        }
        None => Transform::IDENTITY,
    };
    Ok(Use { object: (part, id), transform, place })
}

/// The error that there is too much from an element on.
fn too_much(element: &Element, excess: Excess) -> LoadError {
    element.fault(format!("from here on {excess}")).with_hint(excess.hint()).into()
}

fn color_group(outer: &Element, reader: &mut Reader) -> Result<Properties, LoadError> {
    let mut colors = Vec::new();
    while let Some(element) = reader.next_within(outer)? {
        if element.is_start() && element.name() == b"color" {
            let [r, g, b, _] = element.color("color")?;
            colors.push([r as f32, g as f32, b as f32]);
        }
    }
    Ok(Properties::Colors(colors))
}

/// What printed things look like: a colour with a small highlight. Transparent ones let light pass straight.
fn plastic(name: String, color: Rgb, alpha: f64) -> Material {
    Material {
        name,
        color: color.into(),
        ambient: Rgb::grey(alpha),
        diffuse: Rgb::grey(alpha),
        specular: Rgb::grey(0.006),
        shininess: 40.0,
        transmit: Rgb::grey(1.0 - alpha),
        ior: if alpha < 1.0 { 1.0 } else { Material::default().ior },
        ..Material::default()
    }
}

/// An entry of a group of properties.
#[derive(Clone, Copy)]
struct Property {
    id: u32,
    entry: u32,
}

impl Property {
    fn of(element: &Element, id: &str, entry: &str) -> Result<Option<Self>, LoadError> {
        if element.attribute(id).is_none() {
            return Ok(None);
        }
        let entry = if element.attribute(entry).is_some() { element.number(entry)? } else { 0 };
        Ok(Some(Self { id: element.number(id)?, entry }))
    }
}

/// The colour of what has none.
const NO_COLOR: [f32; 3] = [1.0; 3];

/// Polygons whose corners may have colours: a position with a colour is another position.
#[derive(Default)]
struct ColoredPolygons {
    polygons: Polygons,
    /// For each position.
    colors: Vec<[f32; 3]>,
    position_of: HashMap<(u32, [u32; 3]), u32>,
    has_colors: bool,
}

impl ColoredPolygons {
    /// What there is too much of, where so many bytes are held beside the polygons.
    fn excess(&self, limits: &Limits, beside: usize) -> Option<Excess> {
        const FOR_A_COLORED_POSITION: usize = 40;
        let colors = size_of_val(&self.colors[..]) + self.position_of.len() * FOR_A_COLORED_POSITION;
        self.polygons.excess(limits, beside + colors)
    }

    /// The number of vertices that the file gives.
    fn vertices(&self) -> usize {
        self.polygons.positions.len() - self.position_of.len()
    }

    /// The position of a vertex with a colour.
    fn position_of(&mut self, vertex: u32, color: [f32; 3]) -> u32 {
        self.has_colors = true;
        let positions = &mut self.polygons.positions;
        *self.position_of.entry((vertex, color.map(f32::to_bits))).or_insert_with(|| {
            positions.push(positions[vertex as usize]);
            self.colors.push(color);
            positions.len() as u32 - 1
        })
    }

    fn into_polygons(mut self) -> Polygons {
        if self.has_colors {
            self.polygons.colors = self.colors;
        }
        self.polygons
    }
}
