//! S, k_a, k_d, k_s, m, n, k_r, k_t and what else a material says.

use super::controls::Split;
use super::{Parameter, Rows, View};
use crate::{Edit, Phrase};
use eframe::egui::Ui;
use lancer_core::Rgb;
use lancer_core::scene::{Material, MaterialId, Texture};

/// Draws the material, and says what is changed about it. Its name is left out below that of a node.
pub(super) fn show(view: &mut View, ui: &mut Ui, id: MaterialId, split: &mut Split, with_name: bool) {
    let scene = view.document.scene();
    let (Some(material), Some(saved)) =
        (scene.materials().get(id.index()), view.document.saved().materials().get(id.index()))
    else {
        return;
    };
    let mut edited = material.clone();
    let rows = &mut Rows { ui, language: view.language };
    if with_name {
        rows.text(&NAME, &mut edited.name, saved.name.clone());
    }
    color(rows, &mut edited.color, &saved.color);
    for (parameter, field) in COEFFICIENTS {
        let own = *field(&mut saved.clone());
        rows.coefficient(parameter, field(&mut edited), own, SPEED, split);
    }
    rows.number(&SHININESS, &mut edited.shininess, saved.shininess, 0.0..=MAX_SHININESS, 0.5);
    rows.number(&IOR, &mut edited.ior, saved.ior, MIN_IOR..=MAX_IOR, SPEED);
    rows.switch(&FRESNEL, &mut edited.fresnel, saved.fresnel);
    if edited != *material {
        view.edit(Edit::Material(id, Box::new(edited)));
    }
}

/// S: of one colour, of two, or an image, which is not edited here.
fn color(rows: &mut Rows, texture: &mut Texture, saved: &Texture) {
    match texture {
        Texture::Solid(color) => {
            let own = if let Texture::Solid(own) = saved { *own } else { *color };
            rows.color(&COLOR, color, own);
        }
        Texture::Checker { even, odd, size } => {
            let own = match saved {
                Texture::Checker { even, odd, size } => (*even, *odd, *size),
                _ => (*even, *odd, *size),
            };
            rows.color(&EVEN, even, own.0);
            rows.color(&ODD, odd, own.1);
            rows.number(&SIZE, size, own.2, 1e-6..=1e6, SPEED);
        }
        Texture::Image { image, .. } => {
            let phrase = Phrase::new("S colour: an image,", "S couleur : une image,");
            rows.ui.label(format!("{} {} x {}", rows.language.say(phrase), image.width(), image.height()));
        }
    }
}

type Field = fn(&mut Material) -> &mut Rgb;

const COEFFICIENTS: [(&Parameter, Field); 6] = [
    (&AMBIENT, |material| &mut material.ambient),
    (&DIFFUSE, |material| &mut material.diffuse),
    (&SPECULAR, |material| &mut material.specular),
    (&METALLIC, |material| &mut material.metallic),
    (&REFLECT, |material| &mut material.reflect),
    (&TRANSMIT, |material| &mut material.transmit),
];

/// How fast a coefficient, most of which lie in [0, 1], changes by dragging.
const SPEED: f64 = 0.005;

/// The smallest highlight that can be set; beyond, it falls between the pixels.
const MAX_SHININESS: f64 = 1e6;

/// No matter bends light more than about 4; below 1 is what is left for a bubble in glass.
const MIN_IOR: f64 = 0.01;
const MAX_IOR: f64 = 10.0;

const fn parameter(
    (english, french): (&'static str, &'static str),
    (meaning, sens): (&'static str, &'static str),
) -> Parameter {
    Parameter { name: Phrase::new(english, french), meaning: Phrase::new(meaning, sens) }
}

const NAME: Parameter =
    parameter(("Name", "Nom"), ("What the material is called", "Comment s’appelle le matériau"));

const COLOR: Parameter = parameter(
    ("S colour", "S couleur"),
    (
        "S: the colour of the surface. It tints the ambient and the diffuse term, and highlights as far as m says. The button shows it in sRGB, the numbers are linear.",
        "S : la couleur de la surface. Elle teinte les termes ambiant et diffus, et les reflets autant que m le dit. Le bouton la montre en sRGB, les nombres sont linéaires.",
    ),
);

const EVEN: Parameter = parameter(
    ("S even squares", "S cases paires"),
    ("S: the colour of the square at the origin", "S : la couleur de la case à l’origine"),
);

const ODD: Parameter = parameter(
    ("S odd squares", "S cases impaires"),
    ("S: the colour of its neighbours", "S : la couleur des cases voisines"),
);

const SIZE: Parameter = parameter(
    ("Square size", "Taille des cases"),
    ("The edge of a square, in texture coordinates", "Le côté d’une case, en coordonnées de texture"),
);

const AMBIENT: Parameter = parameter(
    ("k_a ambient", "k_a ambiant"),
    (
        "k_a: how much of the ambient light is reflected, in the term c_a L_a k_a S.",
        "k_a : la part de la lumière ambiante qui est réfléchie, dans le terme c_a L_a k_a S.",
    ),
);

const DIFFUSE: Parameter = parameter(
    ("k_d diffuse", "k_d diffus"),
    (
        "k_d: how much of a light is reflected in all directions, in the term v_i L_i / (pi r²) k_d S (N·L).",
        "k_d : la part d’une lumière réfléchie dans toutes les directions, dans le terme v_i L_i / (pi r²) k_d S (N·L).",
    ),
);

const SPECULAR: Parameter = parameter(
    ("k_s specular", "k_s spéculaire"),
    (
        "k_s: how much of a light is reflected as a highlight, in the term v_i L_i / (pi r²) c_s k_s (m S + (1 - m)) (N·H)^n.",
        "k_s : la part d’une lumière réfléchie en reflet brillant, dans le terme v_i L_i / (pi r²) c_s k_s (m S + (1 - m)) (N·H)^n.",
    ),
);

const METALLIC: Parameter = parameter(
    ("m metallic", "m métallique"),
    (
        "m: how far highlights take the surface’s colour, m S + (1 - m). 0 is plastic, 1 is metal.",
        "m : à quel point les reflets prennent la couleur de la surface, m S + (1 - m). 0 : plastique, 1 : métal.",
    ),
);

const SHININESS: Parameter = parameter(
    ("n shininess", "n brillance"),
    (
        "n: the exponent of highlights, (N·H)^n. The larger, the smaller they are.",
        "n : l’exposant des reflets brillants, (N·H)^n. Plus il est grand, plus ils sont petits.",
    ),
);

const REFLECT: Parameter = parameter(
    ("k_r mirror", "k_r miroir"),
    (
        "k_r: how much of the mirror image is seen, in the term k_r L_r.",
        "k_r : la part de l’image en miroir qui est vue, dans le terme k_r L_r.",
    ),
);

const TRANSMIT: Parameter = parameter(
    ("k_t glass", "k_t verre"),
    (
        "k_t: how much of what lies behind is seen, refracted, in the term k_t L_t.",
        "k_t : la part de ce qui est derrière qui est vue, réfractée, dans le terme k_t L_t.",
    ),
);

const IOR: Parameter = parameter(
    ("Refractive index", "Indice optique"),
    (
        "How strongly light is bent as it enters: air 1, water 1.33, glass 1.5, diamond 2.42. Only seen where k_t or Fresnel is on.",
        "À quel point la lumière est déviée en entrant : air 1, eau 1,33, verre 1,5, diamant 2,42. Ne se voit qu’avec k_t ou Fresnel.",
    ),
);

const FRESNEL: Parameter = parameter(
    ("Fresnel", "Fresnel"),
    (
        "Weighs k_r by the Fresnel reflectance and k_t by what is left of it: glass and water mirror more at grazing angles.",
        "Pondère k_r par la réflectance de Fresnel et k_t par ce qui en reste : le verre et l’eau reflètent plus sous un angle rasant.",
    ),
);
