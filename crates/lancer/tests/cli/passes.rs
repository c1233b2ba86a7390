//! Layers beside the picture.

use crate::sandbox::Sandbox;
use exr::prelude::*;
use std::collections::BTreeMap;
use std::path::Path;

/// Two lights, one of them with a name.
const LIGHTS: &str = "--set lights.0.name=key";

/// The channels of the one part of a file, by name.
fn channels(path: &Path) -> BTreeMap<String, Vec<f32>> {
    let image = read_first_flat_layer_from_file(path).unwrap();
    let channels = image.layer_data.channel_data.list;
    channels
        .iter()
        .map(|channel| (channel.name.to_string(), channel.sample_data.values_as_f32().collect()))
        .collect()
}

fn sum(channels: &BTreeMap<String, Vec<f32>>, layers: &[&str], channel: &str) -> Vec<f32> {
    let mut sum = vec![0.0_f32; channels["R"].len()];
    for layer in layers {
        let part = &channels[&format!("{layer}.{channel}")];
        sum.iter_mut().zip(part).for_each(|(sum, part)| *sum += part);
    }
    sum
}

#[test]
fn all_passes_are_in_one_file_and_add_up_to_the_picture() {
    let sandbox = Sandbox::new();
    for flags in ["", "--exposure 0.6 --samples 2 --ao 4"] {
        let plain = sandbox.exr(flags);
        sandbox.ok(&format!("render scene.yaml -o passes.exr --passes all {LIGHTS} {flags}"));
        let found = channels(&sandbox.path("passes.exr"));
        for (place, channel) in ["R", "G", "B"].into_iter().enumerate() {
            let beauty = plain.pixels.iter().map(|pixel| pixel[place]).collect::<Vec<_>>();
            assert_eq!(found[channel], beauty);
            let terms = ["ambient", "diffuse", "specular", "reflection", "transmission", "background"];
            assert_eq!(sum(&found, &terms, channel), beauty);
            assert_eq!(sum(&found, &["light.key", "all_background", "all_ambient"], channel), beauty);
        }
        let others =
            ["Z", "distance.Z", "P.X", "N.Y", "Ng.Z", "uv.U", "uv.V", "ao.Y", "object_id.X", "material_id.X"];
        for name in others.into_iter().chain(["cost.rays", "cost.nodes", "cost.triangles"]) {
            assert_eq!(found[name].len(), 24 * 16, "{name}");
        }
    }
}

#[test]
fn ids_and_counts_are_whole_numbers() {
    let sandbox = Sandbox::new();
    sandbox.ok("render scene.yaml -o passes.exr --passes object_id,material_id,cost");
    let image = read_first_flat_layer_from_file(sandbox.path("passes.exr")).unwrap();
    let whole =
        image.layer_data.channel_data.list.iter().filter(|channel| channel.name.to_string().contains('.'));
    assert!(
        whole.clone().count() == 5
            && whole.clone().all(|channel| matches!(channel.sample_data, FlatSamples::U32(_)))
    );
}

#[test]
fn json_tells_the_layers_and_what_the_ids_mean() {
    let sandbox = Sandbox::new();
    let told = sandbox.json("render scene.yaml -o a.exr --passes depth,material_id,object_id,light.0 --json");
    let names = told["passes"]["layers"].as_array().unwrap().iter().map(|layer| layer["name"].clone());
    assert_eq!(names.collect::<Vec<_>>(), ["light.0", "depth", "object_id", "material_id"]);
    assert_eq!(told["passes"]["layers"][1]["channels"][0], "Z");
    assert_eq!(told["passes"]["objects"].as_array().unwrap().len(), 3);
    let materials = told["passes"]["materials"].as_array().unwrap();
    assert!(materials.iter().any(|name| name == "glass"), "{materials:?}");
    assert!(sandbox.json("render scene.yaml -o a.exr --json").get("passes").is_none());
}

#[test]
fn separate_passes_are_the_layers_of_one_file() {
    let sandbox = Sandbox::new();
    sandbox.ok("render scene.yaml -o all.exr --passes ambient,depth,uv");
    sandbox.ok("render scene.yaml -o one.exr --passes ambient,depth,uv --separate-passes");
    assert_eq!(sandbox.new_files(), ["all.exr", "one.ambient.exr", "one.depth.exr", "one.exr", "one.uv.exr"]);
    let all = channels(&sandbox.path("all.exr"));
    let one = |name: &str| channels(&sandbox.path(name));
    assert_eq!(one("one.exr").into_keys().collect::<Vec<_>>(), ["B", "G", "R"]);
    assert_eq!(one("one.exr")["G"], all["G"]);
    assert_eq!(one("one.ambient.exr")["G"], all["ambient.G"]);
    assert_eq!(one("one.depth.exr")["Z"], all["Z"]);
    assert_eq!(one("one.uv.exr")["V"], all["uv.V"]);
}

#[test]
fn a_region_has_the_layers_of_the_whole_and_bytes_do_not_depend_on_the_work() {
    let sandbox = Sandbox::new();
    let render = |flags: &str| {
        sandbox
            .ok(&format!("render scene.yaml -o a.exr --passes terms,lights,ao,depth,normal --ao 4 {flags}"));
        sandbox.read("a.exr")
    };
    let whole = render("");
    for flags in ["--threads 1", "--tile-size 5", "--accel kd-tree", "--accel brute-force"] {
        assert!(render(flags) == whole, "{flags}");
    }
    let all = channels(&sandbox.path("a.exr"));
    render("--region 5,3,9,7");
    for (name, part) in channels(&sandbox.path("a.exr")) {
        let rows = (3..10).flat_map(|y| all[&name][y * 24 + 5..y * 24 + 14].to_vec());
        assert!(rows.eq(part), "{name}");
    }
}

#[test]
fn passes_that_cannot_be_are_refused_before_anything_is_rendered() {
    let sandbox = Sandbox::new();
    assert!(sandbox.fails(2, "render scene.yaml --passes all").contains("OpenEXR"));
    assert!(sandbox.fails(2, "render scene.yaml -o a.png --passes all").contains(".exr"));
    let unknown = sandbox.fails(2, "render scene.yaml -o a.exr --passes depth,albedo");
    assert!(
        unknown.contains("albedo") && unknown.contains("light.0") && unknown.contains("geometric_normal")
    );
    sandbox.fails(2, "render scene.yaml -o a.exr --separate-passes");
    assert!(sandbox.fails(2, "render scene.yaml -o a.exr --passes all --bits 16").contains("32"));
    let large = sandbox.fails(2, "render scene.yaml -o a.exr --passes all --width 16000 --height 16000");
    assert!(large.contains("MiB"), "{large}");
    std::fs::create_dir(sandbox.path("a.depth.exr")).unwrap();
    sandbox.fails(4, "render scene.yaml -o a.exr --passes depth --separate-passes");
    assert_eq!(sandbox.new_files(), ["a.depth.exr"]);
}
