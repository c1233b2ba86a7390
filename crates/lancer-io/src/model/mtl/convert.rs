//! MTL materials in the renderer's terms.
//!
//! | MTL | here |
//! |---|---|
//! | Kd | S, with k_d = k_a = d |
//! | map_Kd | S is the image, with k_d = k_a = d Kd; a black or absent Kd counts as white |
//! | -s, -o of map_Kd | the texture coordinates of the mesh, times the scale, plus the offset |
//! | -clamp on of map_Kd | beyond the image, its outermost pixels |
//! | Ka | nothing: most files have 0 or 1 whatever the material, so the ambient light follows S |
//! | Ks, Ns | k_s = 2 Ks / (Ns + 2), n = Ns, m = 0; no highlight under illum 0 and 1, or for Ns < 1 |
//! | d, Tr | opacity: d, or else 1 - Tr, or else 1 |
//! | illum 3 to 8 | k_r = Ks |
//! | illum 4, 6, 7, 9 | k_t = (1 - d) Tf, with ior = Ni |
//! | illum 6, 7 with d = 1 and Tf given | k_t = (1 - Ks) Tf, which is the manual's formula |
//! | other illum with d < 1 | k_t = 1 - d, with ior = 1: seen through without bending |
//! | illum 5, 7 | `fresnel`, unless Ni is 1, where nothing would be reflected |
//!
//! Ks needs the factor because the renderer's highlight is normalised, (n + 2)/2 k_s (N.H)^n, and MTL's is
//! not: Ks (N.H)^Ns. With it the highlights' peaks are equal; without it, Ks 1 and Ns 100 would be 51 times
//! too bright. Ns below 1 is what exporters write for no highlight at all (a quarter of the materials that we
//! tried); as a lobe it would whiten the whole surface. Colours and coefficients are clamped to [0, 1].

use super::parse::Definition;
use lancer_core::Rgb;
use lancer_core::scene::{Material, Texture};

/// The illumination models of MTL that differ here, by what they turn on.
struct Illumination {
    highlight: bool,
    mirror: bool,
    glass: bool,
    /// Light passes even where d is 1.
    refraction: bool,
    fresnel: bool,
}

impl Illumination {
    fn of(illum: Option<u32>) -> Self {
        let illum = illum.unwrap_or(2);
        Self {
            highlight: illum >= 2,
            mirror: matches!(illum, 3..=8),
            glass: matches!(illum, 4 | 6 | 7 | 9),
            refraction: matches!(illum, 6 | 7),
            fresnel: matches!(illum, 5 | 7),
        }
    }
}

/// The material that a definition and its map_Kd mean; `None` where it has none, or its image cannot be had.
pub(super) fn material(definition: &Definition, map_kd: Option<Texture>) -> Material {
    let illumination = Illumination::of(definition.illum);
    let opacity = opacity(definition);
    let kd = clamped(definition.diffuse.unwrap_or(DEFAULT_DIFFUSE));
    let ks = clamped(definition.specular.unwrap_or(Rgb::BLACK));
    let (color, tint) = match map_kd {
        Some(texture) => (texture, tint_of_image(definition)),
        // The image was to give the colour, and it is missing: black would hide the part.
        None if definition.map_kd.is_some() && kd.is_black() => (DEFAULT_DIFFUSE.into(), Rgb::WHITE),
        None => (kd.into(), Rgb::WHITE),
    };
    let shininess = definition.shininess.unwrap_or(Material::default().shininess).clamp(0.0, MAX_SHININESS);
    let highlight = illumination.highlight && shininess >= 1.0;
    let reflect = if illumination.mirror { ks } else { Rgb::BLACK };
    let transmit = transmit(definition, &illumination, opacity, reflect);
    let ior = ior(definition, &illumination, opacity);
    Material {
        name: definition.name.clone(),
        color,
        ambient: tint * opacity,
        diffuse: tint * opacity,
        specular: if highlight { ks * (2.0 / (shininess + 2.0)) } else { Rgb::BLACK },
        metallic: Rgb::BLACK,
        shininess,
        reflect,
        transmit,
        ior,
        fresnel: illumination.fresnel && ior != 1.0,
    }
}

/// Kd of a material that gives none: a light grey.
const DEFAULT_DIFFUSE: Rgb = Rgb::grey(0.8);

/// The largest exponent: its highlight is smaller than a pixel, and it keeps (n + 2)/2 harmless.
const MAX_SHININESS: f64 = 1e6;

/// The indices of refraction that MTL allows.
const LEGAL_IOR: std::ops::RangeInclusive<f64> = 0.001..=10.0;

fn opacity(definition: &Definition) -> f64 {
    let transparency = definition.transparency.unwrap_or(0.0);
    definition.dissolve.unwrap_or(1.0 - transparency).clamp(0.0, 1.0)
}

fn tint_of_image(definition: &Definition) -> Rgb {
    let tint = clamped(definition.diffuse.unwrap_or(Rgb::WHITE));
    if tint.is_black() { Rgb::WHITE } else { tint }
}

fn transmit(definition: &Definition, illumination: &Illumination, opacity: f64, reflect: Rgb) -> Rgb {
    if !illumination.glass {
        return Rgb::grey(1.0 - opacity);
    }
    let filter = clamped(definition.filter.unwrap_or(Rgb::WHITE));
    if opacity == 1.0 && illumination.refraction && definition.filter.is_some() {
        reflect.map(|reflected| 1.0 - reflected) * filter
    } else {
        filter * (1.0 - opacity)
    }
}

fn ior(definition: &Definition, illumination: &Illumination, opacity: f64) -> f64 {
    if opacity < 1.0 && !illumination.glass {
        return 1.0;
    }
    match definition.ior {
        Some(ior) if LEGAL_IOR.contains(&ior) => ior,
        Some(_) => 1.0,
        None => Material::default().ior,
    }
}

fn clamped(color: Rgb) -> Rgb {
    color.map(|channel| channel.clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use lancer_core::scene::ImageTexture;
    use std::sync::Arc;

    fn definition(illum: u32) -> Definition {
        let specular = Some(Rgb::grey(0.5));
        Definition { diffuse: Some(Rgb::grey(0.4)), specular, illum: Some(illum), ..Definition::default() }
    }

    #[test]
    fn peak_of_the_highlight_is_ks() {
        let shiny = material(&Definition { shininess: Some(98.0), ..definition(2) }, None);
        let peak = shiny.specular.r * (shiny.shininess + 2.0) / 2.0;
        assert!((peak - 0.5).abs() < 1e-15);
    }

    #[test]
    fn a_lobe_over_the_whole_surface_is_no_highlight() {
        let matt = material(&Definition { shininess: Some(0.0), ..definition(2) }, None);
        assert!(matt.specular.is_black());
        assert!(material(&definition(1), None).specular.is_black());
    }

    #[test]
    fn dissolved_materials_are_seen_through_straight() {
        let curtain = Definition { dissolve: Some(0.25), ior: Some(1.5), ..definition(2) };
        let curtain = material(&curtain, None);
        assert_eq!(curtain.diffuse, Rgb::grey(0.25));
        assert_eq!((curtain.transmit, curtain.ior), (Rgb::grey(0.75), 1.0));
        assert!(curtain.reflect.is_black());
    }

    #[test]
    fn glass_refracts_and_dissolve_wins_over_tr() {
        let glass = Definition {
            dissolve: Some(0.1),
            transparency: Some(0.1),
            ior: Some(1.4),
            filter: Some(Rgb::new(1.0, 0.5, 0.0)),
            ..definition(7)
        };
        let glass = material(&glass, None);
        assert_eq!((glass.transmit, glass.ior), (Rgb::new(0.9, 0.45, 0.0), 1.4));
        assert_eq!(glass.reflect, Rgb::grey(0.5));
        assert!(glass.fresnel);
    }

    #[test]
    fn refraction_without_dissolve_follows_the_manual() {
        let glass = Definition { filter: Some(Rgb::WHITE), ..definition(6) };
        assert_eq!(material(&glass, None).transmit, Rgb::grey(0.5));
        assert!(material(&definition(6), None).transmit.is_black());
    }

    #[test]
    fn an_image_is_tinted_by_kd_unless_that_is_black() {
        let image = Texture::from(Arc::new(ImageTexture::new(1, 1, vec![[9; 3]]).unwrap()));
        let tinted = material(&definition(1), Some(image.clone()));
        assert_eq!(tinted.diffuse, Rgb::grey(0.4));
        let black = Definition { diffuse: Some(Rgb::BLACK), ..Definition::default() };
        assert_eq!(material(&black, Some(image)).diffuse, Rgb::WHITE);
    }

    #[test]
    fn illegal_indices_bend_nothing() {
        let odd = |ior| material(&Definition { ior: Some(ior), ..definition(6) }, None).ior;
        assert_eq!([odd(0.0), odd(-1.0), odd(1e9)], [1.0; 3]);
    }
}
