//! Materials and their textures.

use super::{data_uri, gltf, square, with};
use crate::common::{Files, error_of, warnings_of};
use lancer_core::Rgb;
use lancer_core::scene::{Texture, Wrap};
use serde_json::{Value, json};
use std::f64::consts::FRAC_PI_2;

/// The material of the square, as the scene gets it.
#[allow(clippy::needless_pass_by_value, reason = "callers make the value in place")]
fn material(written: Value) -> lancer_core::scene::Material {
    let document = with(square(), "/materials", json!([written]));
    let document = with(document, "/meshes/0/primitives/0/material", json!(0));
    gltf(&document).unwrap().materials.remove(0)
}

fn red_png() -> Vec<u8> {
    let mut bytes = Vec::new();
    let image = lancer_core::scene::ImageTexture::new(2, 1, vec![[255, 0, 0], [255, 255, 0]]).unwrap();
    lancer_io::image::encode::write_texture(&image, &mut bytes).unwrap();
    bytes
}

#[test]
fn plastic_has_a_lambertian_surface_and_a_highlight_of_a_quarter_of_its_reflectance() {
    let written = json!({"name": "p", "pbrMetallicRoughness":
        {"baseColorFactor": [0.5, 0.25, 0.125, 1], "metallicFactor": 0, "roughnessFactor": 0.5}});
    let plastic = material(written);
    assert_eq!(
        (plastic.name.as_str(), plastic.color.clone()),
        ("p", Texture::Solid(Rgb::new(0.5, 0.25, 0.125)))
    );
    assert!((plastic.diffuse.r - 0.96).abs() < 1e-15 && plastic.ambient == plastic.diffuse);
    // alpha = 0.25, of which the highlight has what is not wide.
    assert!((plastic.specular.g - 0.75 * 0.04 / 4.0).abs() < 1e-15);
    assert_eq!((plastic.metallic, plastic.shininess), (Rgb::BLACK, 2.0 / 0.0625 - 2.0));
    assert!(plastic.reflect.is_black() && plastic.transmit.is_black());
    let shiny = material(json!({"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0}}));
    assert!(shiny.fresnel && shiny.reflect == Rgb::WHITE && shiny.ior == 1.5);
}

#[test]
fn metal_reflects_in_its_color() {
    let color = [0.9, 0.6, 0.3, 1.0];
    let gold = material(json!({"pbrMetallicRoughness": {"baseColorFactor": color, "roughnessFactor": 0}}));
    assert!(gold.diffuse.is_black() && gold.ambient.is_black());
    assert_eq!((gold.metallic, gold.specular), (Rgb::WHITE, Rgb::grey(0.25)));
    assert_eq!((gold.reflect, gold.fresnel), (Rgb::new(0.9, 0.6, 0.3), false));
    assert_eq!(gold.shininess, 1e6);
    // The default: as rough as can be.
    let rough = material(json!({"pbrMetallicRoughness": {"baseColorFactor": color}}));
    assert_eq!((rough.diffuse, rough.ambient), (Rgb::WHITE, Rgb::WHITE));
    assert!(rough.specular.is_black() && rough.reflect.is_black());
    // Half a metal: F0 (1 - M) + C M, and the part of it that is S.
    let half = material(json!({"pbrMetallicRoughness": {"metallicFactor": 0.5, "roughnessFactor": 0}}));
    assert!((half.specular.r - (0.02 + 0.5) / 4.0).abs() < 1e-15);
    assert!((half.metallic.r - 0.5 / 0.52).abs() < 1e-15);
}

#[test]
fn transmission_is_thin_unless_the_material_says_its_ior_or_a_thickness() {
    let glass = |extensions: Value| {
        material(json!({"extensions": extensions,
            "pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0, 1], "metallicFactor": 0, "roughnessFactor": 0}}))
    };
    let thin = glass(json!({"KHR_materials_transmission": {"transmissionFactor": 0.5}}));
    assert_eq!((thin.transmit, thin.ior, thin.fresnel), (Rgb::new(0.5, 0.25, 0.0), 1.0, false));
    assert!((thin.diffuse.r - 0.48).abs() < 1e-15 && (thin.reflect.r - 0.04).abs() < 1e-15);
    for (extension, value, ior) in [
        ("KHR_materials_ior", json!({"ior": 1.33}), 1.33),
        ("KHR_materials_volume", json!({"thicknessFactor": 0.1}), 1.5),
    ] {
        let mut extensions = json!({"KHR_materials_transmission": {"transmissionFactor": 1}});
        extensions[extension] = value;
        let thick = glass(extensions);
        assert_eq!((thick.ior, thick.fresnel, thick.reflect), (ior, true, Rgb::WHITE), "{extension}");
        assert!(thick.diffuse.is_black());
    }
}

#[test]
fn blended_materials_are_seen_through_straight() {
    let written = |mode: &str| {
        json!({"alphaMode": mode, "pbrMetallicRoughness":
        {"baseColorFactor": [1, 1, 1, 0.25], "metallicFactor": 0}})
    };
    let blend = material(written("BLEND"));
    assert_eq!((blend.transmit, blend.ior), (Rgb::grey(0.75), 1.0));
    assert!((blend.diffuse.r - 0.24).abs() < 1e-15);
    assert!(material(written("OPAQUE")).transmit.is_black());
    assert_eq!(material(written("MASK")).transmit, Rgb::WHITE);
}

#[test]
fn textures_come_from_uris_views_and_files_and_are_transformed() {
    let png = red_png();
    let info = json!({"index": 0, "extensions": {"KHR_texture_transform": {
        "offset": [0.5, 0.25], "rotation": FRAC_PI_2, "scale": [2, 4]}}});
    let textured = with(
        square(),
        "/materials",
        json!([{"pbrMetallicRoughness":
        {"baseColorTexture": info, "baseColorFactor": [0.5, 1, 1, 1], "metallicFactor": 0, "roughnessFactor": 1}}]),
    );
    let textured = with(textured, "/meshes/0/primitives/0/material", json!(0));
    let textured = with(textured, "/textures", json!([{"source": 0}]));
    let textured = with(textured, "/extensionsUsed", json!(["KHR_texture_transform"]));
    let in_uri = with(textured.clone(), "/images", json!([{"uri": data_uri(&png)}]));
    let in_view = with(textured.clone(), "/images", json!([{"bufferView": 3, "mimeType": "image/png"}]));
    let in_view = with(in_view, "/buffers/", json!({"uri": data_uri(&png), "byteLength": png.len()}));
    let in_view = with(in_view, "/bufferViews/", json!({"buffer": 1, "byteLength": png.len()}));
    let in_file = with(textured, "/images", json!([{"uri": "im%61ge.png"}]));
    let files = Files::new().with("image.png", &png).with("a.gltf", in_file.to_string());
    for model in [gltf(&in_uri), gltf(&in_view), files.load("a.gltf")] {
        let model = model.unwrap();
        assert!(model.warnings.is_empty(), "{:?}", model.warnings);
        let Texture::Image { image, .. } = &model.materials[0].color else { panic!() };
        assert_eq!(image.texels(), [[255, 0, 0], [255, 255, 0]]);
        assert!((model.materials[0].diffuse.r - 0.48).abs() < 1e-15);
        // (0, 1) is scaled to (0, 4), turned to (4, 0), moved to (4.5, 0.25); v is then counted upward.
        let [u, v] = model.parts[0].mesh.data().uvs[0];
        assert!((u - 4.5).abs() < 1e-6 && (v - 0.75).abs() < 1e-6, "{u} {v}");
    }
}

#[test]
fn samplers_say_what_lies_beyond_an_image_along_each_axis() {
    let base = json!([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]);
    let textured = with(square(), "/materials", base);
    let textured = with(textured, "/meshes/0/primitives/0/material", json!(0));
    let textured = with(textured, "/textures", json!([{"source": 0, "sampler": 0}]));
    let textured = with(textured, "/images", json!([{"uri": data_uri(&red_png())}]));
    for (sampler, expected) in [
        (json!({}), [Wrap::Repeat, Wrap::Repeat]),
        (json!({"wrapS": 33071, "wrapT": 33648}), [Wrap::Clamp, Wrap::Mirror]),
        (json!({"wrapS": 10497, "wrapT": 33071}), [Wrap::Repeat, Wrap::Clamp]),
    ] {
        let model = gltf(&with(textured.clone(), "/samplers", json!([sampler]))).unwrap();
        assert!(model.warnings.is_empty(), "{:?}", model.warnings);
        let Texture::Image { wrap, .. } = model.materials[0].color else { panic!() };
        assert_eq!(wrap, expected);
    }
    let error = error_of(gltf(&textured));
    assert_eq!(error, "a.gltf: /textures/0/sampler: is 0, but there are no samplers");
}

#[test]
fn what_a_texture_lacks_is_told_and_the_factor_stays() {
    let textured = with(
        square(),
        "/materials",
        json!([{"pbrMetallicRoughness":
        {"baseColorTexture": {"index": 0}, "baseColorFactor": [0.5, 1, 1, 1]}}]),
    );
    let textured = with(textured, "/meshes/0/primitives/0/material", json!(0));
    let textured = with(textured, "/textures", json!([{"source": 0}]));
    for (image, expected) in [
        (
            json!({"uri": "gone.png"}),
            "/images/0/uri: cannot open `gone.png`: no such file or directory; the texture is left out",
        ),
        (json!({"uri": "../../secret.png"}), "/images/0/uri: "),
        (
            json!({"uri": "file:///etc/passwd"}),
            "/images/0/uri: `file:` URIs are not opened; the texture is left out",
        ),
        (
            json!({"uri": "https://example.org/a.png"}),
            "/images/0/uri: `https:` URIs are not opened; the texture is left out",
        ),
        (
            json!({"uri": "data:image/png;base64,AAAA"}),
            "/images/0: is not an image of a format that is read (textures are read from PNG, JPEG, WebP, TIFF, BMP, TGA); \
             the texture is left out",
        ),
        (json!({"uri": "data:image/png;base64,??"}), "/images/0/uri: is no base64: "),
        (
            json!({"bufferView": 9}),
            "/images/0/bufferView: is 9, but there are only 3 bufferViews; the texture is left out",
        ),
        (json!({}), "/images/0: has neither a uri nor a bufferView; the texture is left out"),
    ] {
        let model = gltf(&with(textured.clone(), "/images", json!([image]))).unwrap();
        let [warning] = &warnings_of(&model)[..] else { panic!("{:?}", model.warnings) };
        assert!(warning.starts_with(&format!("a.gltf: {expected}")), "{warning}");
        assert_eq!(model.materials[0].color, Texture::Solid(Rgb::new(0.5, 1.0, 1.0)));
    }
}
