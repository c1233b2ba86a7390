//! Each term against the formula worked out by hand.

use super::*;
use crate::geometry::portable::{pow, sin_cos};
use crate::scene::Light;
use std::f64::consts::PI;

fn assert_close(a: f64, b: f64) {
    assert!((a - b).abs() <= 1e-14 * b.abs().max(1.0), "{a} is not {b}");
}

fn assert_same(a: Rgb, b: Rgb) {
    for (a, b) in a.to_array().into_iter().zip(b.to_array()) {
        assert_close(a, b);
    }
}

fn light(position: DVec3) -> Light {
    Light { name: String::new(), position, intensity: Rgb::new(100.0, 200.0, 300.0) }
}

fn point(material: &Material, to_eye: DVec3) -> ShadingPoint<'_> {
    let color = Rgb::new(0.9, 0.5, 0.1);
    ShadingPoint { position: DVec3::ZERO, normal: DVec3::Y, to_eye, color, material }
}

/// S of [`point`].
const COLOR: Rgb = Rgb::new(0.9, 0.5, 0.1);

#[test]
fn diffuse_term_is_the_light_over_pi_r_squared_times_the_cosine() {
    let material = Material { diffuse: Rgb::new(0.2, 0.4, 0.6), ..Material::default() };
    let (sin, cos) = sin_cos(PI / 3.0);
    let term = LightTerm::new(&point(&material, DVec3::Y), &light(DVec3::new(sin, cos, 0.0) * 5.0)).unwrap();
    assert_close(term.distance, 5.0);
    assert_close(term.cosine, 0.5);
    let over = 0.5 / (PI * 25.0);
    let expected = Rgb::new(100.0 * 0.2 * 0.9, 200.0 * 0.4 * 0.5, 300.0 * 0.6 * 0.1) * over;
    assert_same(term.diffuse, expected);
    assert_same(term.specular, Rgb::BLACK);
}

#[test]
fn specular_term_is_normalised_and_takes_the_surface_color_as_far_as_it_is_metallic() {
    let (sin, cos) = sin_cos(0.3);
    let to_eye = DVec3::new(-sin, cos, 0.0);
    for metallic in [0.0, 0.25, 1.0] {
        let material = Material {
            diffuse: Rgb::BLACK,
            specular: Rgb::new(0.3, 0.2, 0.1),
            metallic: metallic.into(),
            shininess: 20.0,
            ..Material::default()
        };
        let (sin, cos) = sin_cos(0.7);
        let term =
            LightTerm::new(&point(&material, to_eye), &light(DVec3::new(sin, cos, 0.0) * 2.0)).unwrap();
        // The half vector lies half way between -0.3 and 0.7.
        let (_, half_cosine) = sin_cos(0.2);
        assert_close(term.half_cosine, half_cosine);
        let lobe = 11.0 * pow(half_cosine, 20.0) / (PI * 4.0);
        let tint = COLOR.map(|s| metallic * s + 1.0 - metallic);
        assert_same(term.specular, Rgb::new(100.0 * 0.3, 200.0 * 0.2, 300.0 * 0.1) * tint * lobe);
        assert_same(term.diffuse, Rgb::BLACK);
    }
}

#[test]
fn specular_normalisation_is_half_of_n_plus_two() {
    assert_eq!(specular_normalization(0.0), 1.0);
    assert_eq!(specular_normalization(98.0), 50.0);
}

/// The model's own property, which the report works out: 4 (n + 2^(-n/2)) / (n + 4) of the light, for light along the normal.
#[test]
fn a_highlight_reflects_up_to_four_times_its_coefficient() {
    for shininess in [0.0, 1.0, 8.0, 32.0, 200.0] {
        let material =
            Material { diffuse: Rgb::BLACK, specular: Rgb::WHITE, shininess, ..Material::default() };
        let lamp = Light { intensity: Rgb::WHITE, ..light(DVec3::Y) };
        // The flux that leaves over the one that arrives, which is the intensity; rings of equal angle.
        let rings = 2000;
        let width = 0.5 * PI / f64::from(rings);
        let reflected: f64 = (0..rings)
            .map(|ring| {
                let (sin, cos) = sin_cos((f64::from(ring) + 0.5) * width);
                let term = LightTerm::new(&point(&material, DVec3::new(sin, cos, 0.0)), &lamp);
                term.map_or(0.0, |term| term.specular.to_array()[0] * cos * 2.0 * PI * sin * width)
            })
            .sum();
        let expected = 4.0 * (shininess + pow(0.5, 0.5 * shininess)) / (shininess + 4.0);
        assert!(
            (reflected - expected).abs() < 1e-5 * expected,
            "n = {shininess}: {reflected} is not {expected}"
        );
    }
}

#[test]
fn a_light_behind_the_surface_or_in_the_point_adds_nothing() {
    let material = Material { specular: Rgb::WHITE, ..Material::default() };
    let point = point(&material, DVec3::Y);
    assert_eq!(LightTerm::new(&point, &light(DVec3::new(1.0, -0.1, 0.0))), None);
    assert_eq!(LightTerm::new(&point, &light(DVec3::X)), None);
    assert_eq!(LightTerm::new(&point, &light(DVec3::ZERO)), None);
}

#[test]
fn ambient_term_is_the_product_of_its_factors() {
    let term = AmbientTerm {
        occlusion: 0.5,
        light: Rgb::new(0.1, 0.2, 0.3),
        coefficient: Rgb::new(1.0, 0.5, 0.25),
        color: COLOR,
    };
    assert_same(term.radiance(), Rgb::new(0.1 * 0.9 * 0.5, 0.2 * 0.5 * 0.5 * 0.5, 0.3 * 0.25 * 0.1 * 0.5));
}

#[test]
fn refraction_follows_snells_law() {
    for (before, after) in [(1.0, 1.5), (1.5, 1.0), (1.33, 2.4), (2.4, 1.33)] {
        for step in 0..100 {
            let (sin, cos) = sin_cos(0.5 * PI * f64::from(step) / 100.0);
            let direction = DVec3::new(sin, -cos, 0.0);
            match refract(direction, DVec3::Y, before, after) {
                Some(refracted) => {
                    assert_close(refracted.length(), 1.0);
                    assert_close(before * sin, after * refracted.x);
                    assert!(refracted.y < 0.0 && refracted.z == 0.0);
                }
                None => assert!(before * sin > after, "total reflection below the critical angle"),
            }
        }
    }
}

#[test]
fn total_internal_reflection_begins_at_the_critical_angle() {
    let critical = 1.0 / 1.5_f64;
    let at = |sin: f64| DVec3::new(sin, -(1.0 - sin * sin).sqrt(), 0.0);
    assert!(refract(at(critical - 1e-9), DVec3::Y, 1.5, 1.0).is_some());
    assert!(refract(at(critical + 1e-9), DVec3::Y, 1.5, 1.0).is_none());
}

#[test]
fn equal_indices_do_not_bend_by_a_single_bit() {
    let direction = DVec3::new(0.3, -0.7, 0.2).normalize();
    assert_eq!(refract(direction, DVec3::Y, 1.37, 1.37), Some(direction));
}

#[test]
fn mirror_direction_keeps_its_length_and_turns_its_normal_part() {
    let direction = DVec3::new(0.6, -0.8, 0.0);
    assert_eq!(reflect(direction, DVec3::Y), DVec3::new(0.6, 0.8, 0.0));
    assert_eq!(reflect(direction, DVec3::NEG_Y), DVec3::new(0.6, 0.8, 0.0));
}

#[test]
fn fresnel_reflectance_has_its_known_values() {
    // Normal incidence: ((n - 1) / (n + 1))^2.
    assert_close(fresnel_reflectance(1.0, 1.0, 1.5), 0.04);
    assert_close(fresnel_reflectance(1.0, 1.5, 1.0), 0.04);
    assert_close(fresnel_reflectance(0.0, 1.0, 1.5), 1.0);
    assert_close(fresnel_reflectance(0.5, 1.3, 1.3), 0.0);
    assert_eq!(fresnel_reflectance(0.1, 1.5, 1.0), 1.0);
    // At Brewster's angle, tan = 1.5, only the part across is reflected: half of ((n^2 - 1) / (n^2 + 1))^2.
    let brewster = 1.0 / (1.0 + 1.5 * 1.5_f64).sqrt();
    assert_close(fresnel_reflectance(brewster, 1.0, 1.5), 0.5 * (1.25 / 3.25) * (1.25 / 3.25));
}
