//! 3MF.

use crate::archive::zip;
use crate::common::{Files, error_of, load, mutated, mutations, warnings_of};
use lancer_core::Rgb;
use lancer_core::geometry::DVec3;
use lancer_core::scene::Texture;
use lancer_core::world::{CompileOptions, World};
use lancer_io::diagnostics::LoadError;
use lancer_io::limits::Limits;
use lancer_io::model::{Model, UpAxis};
use lancer_io::showcase::scene_of_model;
use proptest::prelude::*;

const CORE: &str = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02";
const MATERIALS: &str = "http://schemas.microsoft.com/3dmanufacturing/material/2015/02";
const PRODUCTION: &str = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06";

/// A right triangle of area 2.
const TRIANGLE: &str = "<mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"2\" y=\"0\" z=\"0\"/>\
     <vertex x=\"0\" y=\"2\" z=\"1\"/></vertices><triangles><triangle v1=\"0\" v2=\"1\" v3=\"2\"/></triangles></mesh>";

fn model_part(attributes: &str, resources: &str, build: &str) -> String {
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model xmlns=\"{CORE}\" xmlns:m=\"{MATERIALS}\" \
         xmlns:p=\"{PRODUCTION}\" {attributes}>\n<resources>\n{resources}\n</resources>\n<build>\n{build}\n</build>\n</model>"
    )
}

fn package(part: &str) -> Vec<u8> {
    zip(&[("3D/3dmodel.model", part.as_bytes())])
}

fn three_mf(attributes: &str, resources: &str, build: &str) -> Result<Model, LoadError> {
    load("a.3mf", package(&model_part(attributes, resources, build)))
}

fn object(id: u32, content: &str) -> String {
    format!("<object id=\"{id}\" name=\"thing {id}\">{content}</object>\n")
}

const ITEM: &str = "<item objectid=\"1\"/>";

#[test]
fn items_place_objects_and_units_become_millimetres() {
    let build = "<item objectid=\"1\"/><item objectid=\"1\" transform=\"0 1 0 -1 0 0 0 0 1 10 0 0\"/>";
    for (attributes, scale) in
        [("", 1.0), ("unit=\"inch\"", 25.4), ("unit=\"micron\"", 0.001), ("unit=\"meter\"", 1000.0)]
    {
        let model = three_mf(attributes, &object(1, TRIANGLE), build).unwrap();
        assert_eq!((model.parts.len(), model.triangle_count(), model.up), (1, 2, UpAxis::Z));
        assert_eq!(model.parts[0].name, "thing 1");
        let bounds = model.bounds();
        // x becomes y, and y becomes -x, moved by 10.
        assert!((bounds.max - DVec3::new(10.0, 2.0, 1.0) * scale).length() < 1e-9 * scale, "{bounds:?}");
        assert!((bounds.min - DVec3::ZERO).length() < 1e-12);
        assert!(model.warnings.is_empty(), "{:?}", model.warnings);
    }
}

#[test]
fn the_showcase_stands_it_up() {
    let scene = scene_of_model(three_mf("", &object(1, TRIANGLE), ITEM).unwrap());
    let world = World::compile(&scene, &CompileOptions::default()).unwrap();
    let placed = scene.node(*scene.roots().last().unwrap()).transform;
    assert_eq!(placed.point(DVec3::Z), DVec3::Y);
    assert_eq!(world.statistics().triangles, 1);
}

#[test]
fn components_share_their_objects() {
    let pair = "<components><component objectid=\"1\"/><component objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 5 0 0\"/></components>";
    let resources = object(1, TRIANGLE)
        + &object(2, pair)
        + &object(3, &pair.replace("objectid=\"1\"", "objectid=\"2\""));
    let model = three_mf("", &resources, "<item objectid=\"3\"/>").unwrap();
    assert_eq!((model.parts.len(), model.triangle_count()), (1, 4));
    assert_eq!(model.bounds().max, DVec3::new(12.0, 2.0, 1.0));
}

#[test]
fn base_materials_and_color_groups_are_read() {
    let triangles = "<triangle v1=\"0\" v2=\"1\" v3=\"2\" pid=\"5\" p1=\"1\"/>\
        <triangle v1=\"0\" v2=\"1\" v3=\"2\" pid=\"6\" p1=\"0\" p2=\"1\" p3=\"0\"/>\
        <triangle v1=\"0\" v2=\"1\" v3=\"2\"/><triangle v1=\"0\" v2=\"1\" v3=\"2\" pid=\"9\" p1=\"0\"/>";
    let mesh = TRIANGLE.replace("<triangle v1=\"0\" v2=\"1\" v3=\"2\"/>", triangles);
    let resources = format!(
        "<basematerials id=\"5\"><base name=\"white\" displaycolor=\"#FFFFFF\"/>\
         <base name=\"glass\" displaycolor=\"#ff000080\"/></basematerials>\
         <m:colorgroup id=\"6\"><m:color color=\"#00ff00\"/><m:color color=\"#0000FFff\"/></m:colorgroup>\
         <object id=\"1\" pid=\"5\" pindex=\"0\">{mesh}</object>"
    );
    let model = three_mf("", &resources, ITEM).unwrap();
    let glass = &model.materials[1];
    assert_eq!((glass.name.as_str(), &glass.color), ("glass", &Texture::Solid(Rgb::new(1.0, 0.0, 0.0))));
    assert!((glass.transmit.g - 127.0 / 255.0).abs() < 1e-12 && glass.ior == 1.0);
    let by_name = |name: &str| model.parts.iter().find(|part| part.name == name).unwrap();
    assert_eq!(by_name("white").mesh.triangle_count(), 1);
    assert_eq!(by_name("glass").mesh.triangle_count(), 1);
    let colored = by_name("object 1").mesh.data();
    assert!(colored.colors.contains(&[0.0, 1.0, 0.0]) && colored.colors.contains(&[0.0, 0.0, 1.0]));
    let [warning] = &warnings_of(&model)[..] else { panic!("{:?}", model.warnings) };
    assert!(warning.ends_with(": its property is not read or not there; the default is drawn"), "{warning}");
}

#[test]
fn objects_may_be_in_further_parts() {
    let root = model_part(
        "requiredextensions=\"p\"",
        "<object id=\"1\"><components><component p:path=\"/3D/Objects/b.model\" objectid=\"7\"/></components></object>",
        ITEM,
    );
    let further = model_part("", &object(7, TRIANGLE), "");
    let relationships = "<Relationships><Relationship Target=\"/3D/root.model\" Id=\"r\" \
        Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>";
    let files = [
        ("_rels/.rels", relationships.as_bytes()),
        ("3D/root.model", root.as_bytes()),
        ("3D/Objects/b.model", further.as_bytes()),
    ];
    assert_eq!(load("a.3mf", zip(&files)).unwrap().triangle_count(), 1);
    let error = error_of(load("a.3mf", zip(&files[..2])));
    assert_eq!(error, "a.3mf/3D/Objects/b.model: cannot be read: no such file in the archive");
    let outside = root.replace("/3D/Objects/b.model", "/../../secret.model");
    let error = error_of(load("a.3mf", zip(&[("3D/3dmodel.model", outside.as_bytes())])));
    assert!(error.ends_with("cannot be read: no such file in the archive"), "{error}");
}

#[test]
fn extensions_that_are_required_and_not_read_are_refused_by_name() {
    let attributes = "xmlns:b=\"http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02\" requiredextensions=\"m b\"";
    let error = error_of(three_mf(attributes, &object(1, TRIANGLE), ITEM));
    assert!(
        error.ends_with("the file requires the extension `http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02`, which is not read"),
        "{error}"
    );
    let optional = attributes.replace("requiredextensions=\"m b\"", "");
    let lattice = object(1, &TRIANGLE.replace("</mesh>", "<b:beamlattice/></mesh>"));
    let model = three_mf(&optional, &lattice, ITEM).unwrap();
    assert!(warnings_of(&model)[0].ends_with(": `b:beamlattice` is passed over"), "{:?}", model.warnings);
}

#[test]
fn faults_are_told_with_their_places() {
    let vertex = "<vertex x=\"2\" y=\"0\" z=\"0\"/>";
    for (content, expected) in [
        (TRIANGLE.replace("v3=\"2\"", "v3=\"3\""), ": vertex 3 is used, but there are only 3, from 0"),
        (TRIANGLE.replace("v3=\"2\"", "v3=\"-1\""), ": v3 is `-1`, must be a whole number"),
        (TRIANGLE.replace("v3=\"2\"", "v3=\"4294967296\""), ": v3 is `4294967296`, must be a whole number"),
        (TRIANGLE.replace(" v3=\"2\"", ""), ": `triangle` lacks `v3`"),
        (TRIANGLE.replace(vertex, &vertex.replace('2', "nan")), ": x is `nan`, must be a finite number"),
        (TRIANGLE.replace(vertex, &vertex.replace('2', "1e39")), ": x is `1e39`, must be a finite number"),
        (TRIANGLE.replace("</mesh>", ""), ""),
        (
            "<components><component objectid=\"9\"/></components>".into(),
            ": there is no object 9 in `3D/3dmodel.model`",
        ),
        (
            "<components><component objectid=\"9\" transform=\"1 2 3\"/></components>".into(),
            ": transform is `1 2 3`, must be twelve finite numbers",
        ),
    ] {
        let error = error_of(three_mf("", &object(1, &content), ITEM));
        assert!(error.starts_with("a.3mf/3D/3dmodel.model:4:") && error.ends_with(expected), "{error}");
    }
    let own = "<components><component objectid=\"1\"/></components>";
    assert_eq!(
        error_of(three_mf("", &object(1, own), ITEM)),
        "a.3mf/3D/3dmodel.model: an object is a component of itself"
    );
    assert_eq!(
        error_of(three_mf("", &object(1, ""), ITEM)),
        "a.3mf/3D/3dmodel.model: its build holds nothing to draw"
    );
    assert_eq!(
        error_of(three_mf("", "", ITEM)),
        "a.3mf/3D/3dmodel.model:7:1: there is no object 1 in `3D/3dmodel.model`"
    );
    assert_eq!(
        error_of(three_mf("unit=\"ell\"", "", "")),
        "a.3mf/3D/3dmodel.model:2:1: unit is `ell`, which 3MF files do not know"
    );
    assert_eq!(
        error_of(load("a.3mf", package("<html/>"))),
        "a.3mf/3D/3dmodel.model: holds no `model` of the 3MF core specification"
    );
    assert_eq!(
        error_of(load("a.3mf", zip(&[]))),
        "a.3mf/3D/3dmodel.model: cannot be read: no such file in the archive"
    );
}

#[test]
fn components_that_double_forty_times_are_refused() {
    let pair = |id: u32| {
        format!("<components><component objectid=\"{id}\"/><component objectid=\"{id}\"/></components>")
    };
    let doubling = (2..42).map(|id| object(id, &pair(id - 1))).collect::<String>();
    let error = error_of(three_mf("", &(object(1, TRIANGLE) + &doubling), "<item objectid=\"41\"/>"));
    assert!(error.contains("its nodes are drawn more than"), "{error}");
}

#[test]
fn small_files_do_not_fill_the_memory() {
    let limits = Limits { memory: 1 << 20, ..Limits::default() };
    let within = |resources: &str, build: &str| {
        let files = Files::new().with("a.3mf", package(&model_part("", resources, build)));
        files.load_within("a.3mf", limits)
    };
    let triangle = object(1, TRIANGLE);
    assert!(within(&triangle, ITEM).is_ok());
    let base = format!(
        "<basematerials id=\"9\">{}</basematerials>",
        "<base displaycolor=\"#FFFFFF\"/>".repeat(2000)
    );
    let objects = (2..2002).map(|id| format!("<object id=\"{id}\"/>")).collect::<String>();
    let vertices = TRIANGLE.replace(
        "<triangles>",
        &("<triangles>".to_owned() + &"<triangle v1=\"0\" v2=\"1\" v3=\"2\"/>".repeat(10_000)),
    );
    for (resources, build) in [
        (base + &triangle, ITEM.to_owned()),
        (objects + &triangle, ITEM.to_owned()),
        (triangle, ITEM.repeat(2000)),
        (object(1, &vertices), ITEM.to_owned()),
    ] {
        let error = error_of(within(&resources, &build));
        assert!(error.ends_with("from here on more than 1048576 bytes of memory are needed"), "{error}");
    }
}

#[test]
fn components_that_draw_more_objects_than_allowed_are_refused() {
    let pair = |id: u32| {
        format!("<components><component objectid=\"{id}\"/><component objectid=\"{id}\"/></components>")
    };
    let doubling = (2..23).map(|id| object(id, &pair(id - 1))).collect::<String>();
    let error =
        three_mf("", &(object(1, TRIANGLE) + &doubling), "<item objectid=\"22\"/>").unwrap_err().to_string();
    assert!(error.contains("its parts are drawn 2097152 times in all, more than 1048576"), "{error}");
    assert!(error.contains("--limit objects=N allows more"), "{error}");
}

#[test]
fn entities_do_not_grow() {
    let part = model_part("", &object(1, TRIANGLE), ITEM).replace(
        "<model",
        "<!DOCTYPE x [<!ENTITY a \"aaaaaaaaaa\"><!ENTITY b \"&a;&a;&a;&a;&a;&a;&a;&a;\">]><model",
    );
    let named = part.replace("thing 1", "&b;");
    assert_eq!(load("a.3mf", package(&named)).unwrap().triangle_count(), 1);
}

#[test]
fn more_triangles_than_allowed_are_refused() {
    let limits = Limits { triangles: 0, ..Limits::default() };
    let files = Files::new().with("a.3mf", package(&model_part("", &object(1, TRIANGLE), ITEM)));
    let error = error_of(files.load_within("a.3mf", limits));
    assert!(error.ends_with("from here on there are more than 0 triangles"), "{error}");
}

proptest! {
    #[test]
    fn no_change_of_bytes_makes_it_panic(mutations in mutations(), cut: bool, in_part: bool) {
        let part = model_part("unit=\"inch\"", &object(1, TRIANGLE), ITEM);
        let bytes = if in_part {
            let changed = mutated(part.as_bytes(), &mutations, cut);
            zip(&[("3D/3dmodel.model", &changed)])
        } else {
            mutated(&package(&part), &mutations, cut)
        };
        if let Ok(model) = load("a.3mf", bytes) {
            prop_assert!(model.triangle_count() > 0);
        }
    }
}

#[test]
fn a_hundred_thousand_items_on_one_line_of_a_part_with_a_long_name_take_no_memory_each() {
    let name = "n".repeat(60_000);
    let relationships = format!(
        "<Relationships><Relationship Target=\"/{name}\" Id=\"r\" \
         Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>"
    );
    let count = 100_000;
    let part = model_part("", &object(1, TRIANGLE), &ITEM.repeat(count));
    let files = [("_rels/.rels", relationships.as_bytes()), (&name, part.as_bytes())];
    assert_eq!(load("a.3mf", zip(&files)).unwrap().triangle_count(), count as u64);
    // A fault at the last is still told with its place.
    let faulty = model_part("", &object(1, TRIANGLE), &(ITEM.repeat(count) + "<item objectid=\"2\"/>"));
    let error = error_of(load("a.3mf", zip(&[("3D/3dmodel.model", faulty.as_bytes())])));
    let column = ITEM.len() * count + 1;
    let place = format!(":{column}: there is no object 2 in `3D/3dmodel.model`");
    assert!(error.ends_with(&place), "{error}");
}

#[test]
fn long_names_are_cut_off() {
    let named = object(1, TRIANGLE).replace("thing 1", &"é".repeat(300));
    assert_eq!(three_mf("", &named, ITEM).unwrap().parts[0].name, "é".repeat(255));
}

#[test]
fn many_small_bombs_are_one() {
    let padding = " ".repeat(10 << 20);
    let component =
        "<object id=\"1\"><components><component p:path=\"/b.model\" objectid=\"1\"/></components></object>";
    let root = model_part("", component, ITEM) + &padding;
    let further = model_part("", &object(1, TRIANGLE), "") + &padding;
    let whole = zip(&[("3D/3dmodel.model", root.trim_end().as_bytes()), ("b.model", further.as_bytes())]);
    assert_eq!(load("a.3mf", whole).unwrap().triangle_count(), 1);
    let bomb = zip(&[("3D/3dmodel.model", root.as_bytes()), ("b.model", further.as_bytes())]);
    let error = error_of(load("a.3mf", bomb));
    assert!(
        error.contains("b.model: unpacks, with the files before it, to more than 16777216 bytes"),
        "{error}"
    );
}
