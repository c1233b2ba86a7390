//! glTF's metallic and roughness materials in the renderer's terms.
//!
//! With M the metallic and r the roughness factor, C the base colour, F0 = ((ior - 1) / (ior + 1))^2 the reflectance
//! of a dielectric at normal incidence (0.04 for the default ior of 1.5), T the transmission, a the opacity,
//! alpha = r^2 the width of highlights, and w = max(0, 1 - 2 r)^2 the share of reflection that is sharp:
//!
//! | here | is |
//! |---|---|
//! | S | C: the factor, or the image, times the colours of vertices; an image's factor goes into k_a, k_d, k_s |
//! | k_d | a (1 - T) (1 - M) (1 - F0) + a alpha M |
//! | k_a | a (1 - T) (1 - M) (1 - F0) + a (1 - w) M |
//! | k_s, m | a (1 - alpha) (F0 (1 - M) + C M) / 4, of which the part of M is that of S |
//! | n | 2 / alpha^2 - 2, from 0 to 1e6 |
//! | k_r | a w (F0 (1 - M) + C M); for M = 0 it is a w with `fresnel` |
//! | k_t | a T (1 - M) C + 1 - a; with `fresnel` it is weighted by 1 - F |
//! | ior | KHR_materials_ior; 1 where nothing bends: no T, or a thin surface |
//!
//! k_s: a microfacet surface gives F D G / (4 N.L N.V) N.L times the irradiance, with Blinn's D = (n + 2) / (2 pi)
//! (N.H)^n, and with G = N.L N.V that is F/4 (n + 2)/2 (N.H)^n L_i / (pi r^2) at normal incidence, which is this
//! renderer's highlight with k_s = F/4. n: the exponent whose lobe is as wide as a Beckmann lobe of that alpha (B.
//! Walter et al., "Microfacet models for refraction through rough surfaces", 2007). The wider the lobe, the more of
//! it is given as diffuse light, since highlights here lack N.L and would end in a hard edge; w is a choice too: a
//! mirror image here is sharp, and what a rough surface blurs is taken for the ambient light.
//!
//! A transmissive surface is thin, as the extension says, and bends nothing, unless the material has
//! KHR_materials_volume with a thickness, or says its ior. Where a texture gives M and r, their means are taken; where
//! C is an image, its mean colours k_r and k_t.

use super::document::{self, Document, TextureInfo};
use super::fault::{Fault, Result, Warnings, entry};
use super::textures::Textures;
use crate::model::text::kept_name;
use lancer_core::Rgb;
use lancer_core::geometry::portable;
use lancer_core::scene::{ImageTexture, Material, Texture, Wrap};
use std::sync::Arc;

/// The largest exponent: its highlight is smaller than a pixel, and it keeps (n + 2)/2 harmless.
const MAX_SHININESS: f64 = 1e6;

/// F0 of the default ior.
const DEFAULT_IOR: f64 = 1.5;

/// How texture coordinates become those of the renderer.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct UvMapping {
    /// Which of the primitive's sets.
    pub(super) set: u32,
    /// An affine map by rows, as bits.
    rows: [[u64; 3]; 2],
}

impl UvMapping {
    /// Texture coordinates with v upward.
    pub(super) fn apply(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        let row = |row: [u64; 3]| {
            let [a, b, c] = row.map(f64::from_bits);
            a * u + b * v + c
        };
        [row(self.rows[0]), 1.0 - row(self.rows[1])]
    }
}

/// A material, and where its texture takes its coordinates from.
pub(super) struct Converted {
    pub(super) material: Material,
    pub(super) mapping: Option<UvMapping>,
}

/// An image, and what lies beyond it.
struct Placed {
    image: Arc<ImageTexture>,
    wrap: [Wrap; 2],
}

/// What any of the two models says of a surface.
struct Surface {
    color: Rgb,
    opacity: f64,
    image: Option<Placed>,
    /// M and r.
    metallic: f64,
    roughness: f64,
    /// Reflectance at normal incidence of what is no metal.
    f0: Rgb,
}

/// Converts a material of the document.
pub(super) fn convert(
    document: &Document,
    textures: &mut Textures,
    index: usize,
    warnings: &mut Warnings,
) -> Result<Converted> {
    let at = format!("/materials/{index}");
    let written = &document.materials[index];
    let ior = ior(written, &at)?;
    let mut mapping = None;
    let mut surface = match &written.extensions.specular_glossiness {
        Some(old) => {
            let at = format!("{at}/extensions/KHR_materials_pbrSpecularGlossiness");
            if old.specular_glossiness_texture.is_some() {
                warnings.add(&at, "its specularGlossinessTexture is not used");
            }
            let [r, g, b, opacity] = old.diffuse_factor.unwrap_or([1.0; 4]);
            let image = image_of(
                old.diffuse_texture.as_ref(),
                &at,
                "diffuseTexture",
                document,
                textures,
                warnings,
                &mut mapping,
            )?;
            Surface {
                color: Rgb::new(r, g, b),
                opacity,
                image,
                metallic: 0.0,
                roughness: 1.0 - old.glossiness_factor.unwrap_or(1.0).clamp(0.0, 1.0),
                f0: clamped(Rgb::from(old.specular_factor.unwrap_or([1.0; 3]))),
            }
        }
        None => {
            let at = format!("{at}/pbrMetallicRoughness");
            let pbr = &written.pbr_metallic_roughness;
            let [r, g, b, opacity] = pbr.base_color_factor.unwrap_or([1.0; 4]);
            let image = image_of(
                pbr.base_color_texture.as_ref(),
                &at,
                "baseColorTexture",
                document,
                textures,
                warnings,
                &mut mapping,
            )?;
            let mut surface = Surface {
                color: Rgb::new(r, g, b),
                opacity,
                image,
                metallic: pbr.metallic_factor.unwrap_or(1.0).clamp(0.0, 1.0),
                roughness: pbr.roughness_factor.unwrap_or(1.0).clamp(0.0, 1.0),
                f0: Rgb::grey(reflectance(ior)),
            };
            if let Some(info) = &pbr.metallic_roughness_texture {
                let at = format!("{at}/metallicRoughnessTexture");
                warnings.add(&at, "its mean metallic and roughness are used for the whole surface");
                if let Some(image) = textures.load(info.index, &at, warnings)? {
                    let [_, roughness, metallic] = mean_of_bytes(&image);
                    surface.metallic *= metallic;
                    surface.roughness *= roughness;
                }
            }
            surface
        }
    };
    surface.color = clamped(surface.color);
    surface.opacity = opacity(written, &surface, &at, warnings);
    warn_of_the_rest(written, &at, warnings);
    let name = written.name.as_deref().map(kept_name).unwrap_or_else(|| format!("material {index}"));
    Ok(Converted { material: material(name, written, &surface, ior), mapping })
}

/// The index of refraction that a material says.
fn ior(written: &document::Material, at: &str) -> Result<f64> {
    let ior = written.extensions.ior.as_ref().and_then(|extension| extension.ior).unwrap_or(DEFAULT_IOR);
    // 0 stands for a surface that reflects everything.
    if ior != 0.0 && !(1.0..=100.0).contains(&ior) {
        return Err(Fault::new(
            format!("{at}/extensions/KHR_materials_ior/ior"),
            format!("is {ior}, must be 1 or more"),
        ));
    }
    Ok(ior)
}

fn reflectance(ior: f64) -> f64 {
    let amplitude = (ior - 1.0) / (ior + 1.0);
    amplitude * amplitude
}

fn material(name: String, written: &document::Material, surface: &Surface, ior: f64) -> Material {
    let Surface { color, opacity, ref image, metallic, roughness, f0 } = *surface;
    let extensions = &written.extensions;
    let transmission =
        extensions.transmission.as_ref().map_or(0.0, |t| t.transmission_factor.clamp(0.0, 1.0));
    let transmission = transmission * (1.0 - metallic);
    // An image's factor cannot be in S.
    let (texture, tint, mean) = match image {
        Some(Placed { image, wrap }) => {
            let texture = Texture::Image { image: Arc::clone(image), wrap: *wrap };
            (texture, color, color * mean_color(image))
        }
        None => (color.into(), Rgb::WHITE, color),
    };
    if extensions.unlit.is_some() {
        let tint = tint * opacity;
        let transmit = Rgb::grey(1.0 - opacity);
        return Material {
            name,
            color: texture,
            ambient: tint,
            diffuse: tint,
            transmit,
            ior: 1.0,
            ..Material::default()
        };
    }
    let alpha = roughness * roughness;
    let sharp = (1.0 - 2.0 * roughness).max(0.0);
    let sharp = sharp * sharp;
    let matt = f0.map(|f0| (1.0 - f0) * (1.0 - metallic) * (1.0 - transmission)) * tint;
    let from_metal = tint * metallic;
    let from_rest = f0 * (1.0 - metallic);
    let highlight = from_rest + from_metal;
    let share = |metal: f64, all: f64| if all > 0.0 { metal / all } else { 0.0 };
    let is_dielectric = metallic == 0.0 && extensions.specular_glossiness.is_none() && ior > 1.0;
    let bends =
        extensions.ior.is_some() || extensions.volume.as_ref().is_some_and(|v| v.thickness_factor > 0.0);
    let is_glass = transmission > 0.0 && bends && ior > 1.0;
    // Without bending there is no Fresnel reflectance: it follows from the ior.
    let fresnel = is_dielectric && (is_glass || transmission == 0.0 && opacity == 1.0) && sharp > 0.0;
    let reflect = if fresnel { Rgb::WHITE } else { from_rest + mean * metallic };
    Material {
        name,
        color: texture,
        ambient: (matt + from_metal * (1.0 - sharp)) * opacity,
        diffuse: (matt + from_metal * alpha) * opacity,
        specular: highlight * ((1.0 - alpha) * 0.25 * opacity),
        metallic: Rgb::new(
            share(from_metal.r, highlight.r),
            share(from_metal.g, highlight.g),
            share(from_metal.b, highlight.b),
        ),
        shininess: (2.0 / (alpha * alpha) - 2.0).clamp(0.0, MAX_SHININESS),
        reflect: reflect * (sharp * opacity),
        transmit: mean * (transmission * opacity) + Rgb::grey(1.0 - opacity),
        ior: if is_glass || fresnel {
            ior
        } else if transmission > 0.0 || opacity < 1.0 {
            1.0
        } else {
            DEFAULT_IOR
        },
        fresnel,
    }
}

/// The share of the surface that is there.
fn opacity(written: &document::Material, surface: &Surface, at: &str, warnings: &mut Warnings) -> f64 {
    let mode = written.alpha_mode.as_deref().unwrap_or("OPAQUE");
    if mode != "OPAQUE" && surface.image.is_some() {
        warnings.add(at, "the alpha of its texture is not used");
    }
    match mode {
        "BLEND" => surface.opacity.clamp(0.0, 1.0),
        "MASK" if surface.opacity < written.alpha_cutoff.unwrap_or(0.5) => 0.0,
        _ => 1.0,
    }
}

/// Warns of what has no meaning here.
fn warn_of_the_rest(written: &document::Material, at: &str, warnings: &mut Warnings) {
    if written.emissive_factor != [0.0; 3] {
        warnings.add(at, "its emission is not drawn");
    }
    if written.normal_texture.is_some() {
        warnings.add(at, "its normalTexture is not used");
    }
    if written.occlusion_texture.is_some() {
        warnings.add(at, "its occlusionTexture is not used");
    }
    if written.extensions.unlit.is_some() {
        warnings.add(at, "KHR_materials_unlit is drawn as a matt surface");
    }
    if written.extensions.transmission.as_ref().is_some_and(|t| t.transmission_texture.is_some()) {
        warnings.add(at, "its transmissionTexture is not used");
    }
}

/// The image of a texture, and into `mapping` where its coordinates come from.
fn image_of(
    info: Option<&TextureInfo>,
    at: &str,
    name: &str,
    document: &Document,
    textures: &mut Textures,
    warnings: &mut Warnings,
    mapping: &mut Option<UvMapping>,
) -> Result<Option<Placed>> {
    let Some(info) = info else { return Ok(None) };
    let at = format!("{at}/{name}");
    let Some(image) = textures.load(info.index, &at, warnings)? else { return Ok(None) };
    *mapping = Some(mapping_of(info, &at)?);
    Ok(Some(Placed { image, wrap: wrap_of(info.index, document)? }))
}

/// Source: the README of KHR_texture_transform; u grows to the right and v downward.
fn mapping_of(info: &TextureInfo, at: &str) -> Result<UvMapping> {
    let transform = info.extensions.transform.as_ref();
    let [dx, dy] = transform.and_then(|t| t.offset).unwrap_or_default();
    let [sx, sy] = transform.and_then(|t| t.scale).unwrap_or([1.0; 2]);
    let (sin, cos) = portable::sin_cos(transform.and_then(|t| t.rotation).unwrap_or_default());
    let rows = [[cos * sx, sin * sy, dx], [-sin * sx, cos * sy, dy]];
    if !rows.as_flattened().iter().all(|x| x.abs() <= 1e9) {
        return Err(Fault::new(at, "its KHR_texture_transform is out of all range"));
    }
    Ok(UvMapping {
        set: transform.and_then(|t| t.tex_coord).unwrap_or(info.tex_coord),
        rows: rows.map(|row| row.map(f64::to_bits)),
    })
}

/// What lies beyond the image of a texture, along u and v: as in OpenGL, whose codes its sampler writes.
fn wrap_of(texture: usize, document: &Document) -> Result<[Wrap; 2]> {
    let Some(sampler) = document.textures.get(texture).and_then(|texture| texture.sampler) else {
        return Ok([Wrap::Repeat; 2]);
    };
    let sampler = entry(&document.samplers, "samplers", sampler, format!("/textures/{texture}/sampler"))?;
    let wrap = |code: Option<u32>| match code {
        Some(33071) => Wrap::Clamp,
        Some(33648) => Wrap::Mirror,
        _ => Wrap::Repeat,
    };
    Ok([wrap(sampler.wrap_s), wrap(sampler.wrap_t)])
}

/// The mean of an image's bytes, as fractions.
fn mean_of_bytes(image: &ImageTexture) -> [f64; 3] {
    let mut sums = [0_u64; 3];
    for texel in image.texels() {
        sums.iter_mut().zip(texel).for_each(|(sum, &byte)| *sum += u64::from(byte));
    }
    sums.map(|sum| sum as f64 / (255.0 * image.texels().len() as f64))
}

/// The mean colour of an image, linear.
fn mean_color(image: &ImageTexture) -> Rgb {
    let mut counts = [[0_u64; 256]; 3];
    for texel in image.texels() {
        counts.iter_mut().zip(texel).for_each(|(counts, &byte)| counts[usize::from(byte)] += 1);
    }
    let mean = |counts: &[u64; 256]| {
        let linear = |code: usize| lancer_core::color::srgb_to_linear(code as f64 / 255.0);
        let sum = counts.iter().enumerate().map(|(code, &count)| linear(code) * count as f64).sum::<f64>();
        sum / image.texels().len() as f64
    };
    Rgb::new(mean(&counts[0]), mean(&counts[1]), mean(&counts[2]))
}

fn clamped(color: Rgb) -> Rgb {
    color.map(|channel| channel.clamp(0.0, 1.0))
}
