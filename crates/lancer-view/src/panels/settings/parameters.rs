//! The parameters of a picture, each with the term of the formula that it is.

use super::super::fields::Parameter;
use crate::Phrase;

const fn parameter(
    (english, french): (&'static str, &'static str),
    (meaning, sens): (&'static str, &'static str),
) -> Parameter {
    Parameter { name: Phrase::new(english, french), meaning: Phrase::new(meaning, sens) }
}

pub(super) const SCENE: Parameter = parameter(
    ("Scene", "Scène"),
    (
        "A built-in scene, or one of the files opened last",
        "Une scène intégrée, ou l’un des derniers fichiers ouverts",
    ),
);

pub(super) const CAMERA: Parameter = parameter(
    ("Camera", "Caméra"),
    ("Look through one of the scene’s cameras", "Regarder par l’une des caméras de la scène"),
);

pub(super) const WIDTH: Parameter = parameter(
    ("Width", "Largeur"),
    ("Pixels in a row of the render: 1 to 65,535", "Pixels d’une ligne du rendu : de 1 à 65 535"),
);

pub(super) const HEIGHT: Parameter = parameter(
    ("Height", "Hauteur"),
    ("Rows of pixels of the render: 1 to 65,535", "Lignes de pixels du rendu : de 1 à 65 535"),
);

pub(super) const SUBPIXELS: Parameter = parameter(
    ("Subpixels", "Sous-pixels"),
    (
        "n: each pixel is the mean of n x n rays, through the centres of its subpixels. Smooths edges; takes n x n times as long.",
        "n : chaque pixel est la moyenne de n x n rayons, par les centres de ses sous-pixels. Lisse les bords ; prend n x n fois plus de temps.",
    ),
);

pub(super) const EXPOSURE: Parameter = parameter(
    ("Exposure", "Exposition"),
    (
        "In stops: the picture is multiplied by 2 to this power, and then cut to [0, 1].",
        "En diaphragmes : l’image est multipliée par 2 à cette puissance, puis ramenée à [0, 1].",
    ),
);

pub(super) const CURVE: Parameter = parameter(
    ("Tone curve", "Courbe de tons"),
    (
        "What becomes of light brighter than the screen: it is cut, or compressed as by Reinhard or by film. Raw shows linear values as they are, too dark.",
        "Ce que devient la lumière plus vive que l’écran : elle est coupée, ou comprimée à la Reinhard ou comme un film. Brut montre les valeurs linéaires telles quelles, trop sombres.",
    ),
);

pub(super) const DEPTH: Parameter = parameter(
    ("Depth", "Profondeur"),
    (
        "How many reflections and refractions follow one another. At 0, the terms k_r L_r and k_t L_t are left out.",
        "Combien de réflexions et de réfractions se suivent. À 0, les termes k_r L_r et k_t L_t sont omis.",
    ),
);

pub(super) const SHADOWS: Parameter = parameter(
    ("Shadows", "Ombres"),
    (
        "v_i: 0 where something stands between the point and light i, else 1. Off, it is 1 everywhere.",
        "v_i : 0 si quelque chose se trouve entre le point et la lumière i, sinon 1. Sans ombres, 1 partout.",
    ),
);

pub(super) const REFLECTIONS: Parameter = parameter(
    ("Reflections", "Réflexions"),
    (
        "The term k_r L_r: L_r is the light that comes along the mirror direction.",
        "Le terme k_r L_r : L_r est la lumière qui vient de la direction miroir.",
    ),
);

pub(super) const REFRACTIONS: Parameter = parameter(
    ("Refractions", "Réfractions"),
    (
        "The term k_t L_t: L_t is the light that comes through the surface, bent by Snell’s law.",
        "Le terme k_t L_t : L_t est la lumière qui traverse la surface, déviée selon la loi de Snell-Descartes.",
    ),
);

pub(super) const AMBIENT: Parameter = parameter(
    ("Ambient", "Ambiante"),
    (
        "L_a: the light that comes from everywhere. It adds c_a L_a k_a S.",
        "L_a : la lumière qui vient de partout. Elle ajoute c_a L_a k_a S.",
    ),
);

pub(super) const BACKGROUND: Parameter = parameter(
    ("Background", "Arrière-plan"),
    (
        "The light of a ray that meets nothing; it is seen in mirrors and glass too.",
        "La lumière d’un rayon qui ne rencontre rien ; elle se voit aussi dans les miroirs et le verre.",
    ),
);

pub(super) const OCCLUSION: Parameter = parameter(
    ("Compute", "Calculer"),
    (
        "c_a: how much of the surroundings is open, which weighs the ambient light. Off, it is 1.",
        "c_a : la part des alentours qui est dégagée, et qui pondère la lumière ambiante. Sans ce calcul, 1.",
    ),
);

pub(super) const OCCLUSION_SAMPLES: Parameter = parameter(
    ("Samples", "Échantillons"),
    (
        "N: directions that are tried at each point, for c_a = 4/N sum V (n . w)+. More of them, less grain.",
        "N : directions essayées en chaque point, pour c_a = 4/N somme V (n . w)+. Plus il y en a, moins il y a de grain.",
    ),
);

pub(super) const OCCLUSION_DISTANCE: Parameter = parameter(
    ("Distance", "Distance"),
    (
        "D: how far away something may be and still darken the point, in units of the scene.",
        "D : à quelle distance un objet assombrit encore le point, en unités de la scène.",
    ),
);

pub(super) const ACCELERATOR: Parameter = parameter(
    ("Search", "Recherche"),
    (
        "What finds the surface that a ray meets. The picture is the same, byte for byte, with any of them.",
        "Ce qui trouve la surface que rencontre un rayon. L’image est la même, à l’octet près, avec chacune.",
    ),
);

pub(super) const LEAF: Parameter = parameter(
    ("Triangles a leaf", "Par feuille"),
    (
        "A node of the k-d tree with this many triangles or fewer is not divided any further.",
        "Un nœud de l’arbre k-d qui a ce nombre de triangles, ou moins, n’est plus divisé.",
    ),
);

pub(super) const TREE_DEPTH: Parameter = parameter(
    ("Tree depth", "Prof. de l’arbre"),
    (
        "At this depth, no node of the k-d tree is divided any further; the root has depth 0.",
        "À cette profondeur, aucun nœud de l’arbre k-d n’est plus divisé ; la racine a la profondeur 0.",
    ),
);

pub(super) const THREADS: Parameter = parameter(
    ("Threads", "Fils d’exécution"),
    (
        "How many threads render; automatic is one for each core. The picture is the same with any number.",
        "Combien de fils calculent ; automatique : un par cœur. L’image est la même quel qu’en soit le nombre.",
    ),
);
