//! What there is to open, as told to a person.

use crate::{Phrase, Source};
use lancer_gallery::{BuiltinScene, SCENES};
use std::path::Path;

/// A heading over the built-in scenes.
pub(super) const BUILTIN: Phrase = Phrase::new("Built-in scenes", "Scènes intégrées");

/// A heading over the files opened last.
pub(super) const RECENT: Phrase = Phrase::new("Recent files", "Fichiers récents");

/// The built-in scenes.
pub(super) fn builtin_scenes() -> impl Iterator<Item = &'static dyn BuiltinScene> {
    SCENES.iter().copied()
}

/// What a source is, in a line.
pub(super) fn about(source: &Source) -> Phrase {
    match source {
        Source::Builtin(scene) => summary(*scene),
        Source::File(_) => Phrase::new("A file", "Un fichier"),
    }
}

/// What a built-in scene shows.
pub(super) fn summary(scene: &dyn BuiltinScene) -> Phrase {
    let french = match scene.name() {
        "whitted" => {
            "Une boule de verre creuse devant une boule miroir sur un damier, d’après l’image de Whitted (1980)"
        }
        "primitives" => "Toutes les formes, étirées, cisaillées, en miroir et imbriquées",
        "highlights" => "La brillance croît vers la droite, du plastique devant au métal derrière",
        "shadows" => {
            "Les ombres nettes de trois lumières colorées se croisent sous une colonnade et un treillis"
        }
        "mirrors" => "Deux miroirs face à face et leur couloir de reflets, une boule et un bol miroirs",
        "glass" => "Un verre d’eau, une boule, un bloc à bulles et un prisme à réflexion totale",
        "occlusion" => {
            "De l’argile blanche sans lampe : un escalier tournant, un treillis et des boules dans des coins"
        }
        "supersampling" => {
            "Une roue aux rayons fins sur des carreaux jusqu’à l’horizon : à calculer avec 1 échantillon, puis avec 4"
        }
        "teapot" => "La théière de Newell, faite de ses carreaux de Bézier, vernissée, sur une table polie",
        "sphereflake" => {
            "Le flocon de Haines : 66 430 boules miroirs, chaque niveau étant un sous-arbre partagé"
        }
        "mirror-room" => "Une pièce éclairée entre deux miroirs, avec du verre sur la table",
        "ten-thousand" => {
            "Une vallée d’automne de dix mille arbres de quatre sortes, en sous-arbres partagés"
        }
        _ => scene.summary(),
    };
    Phrase::new(scene.summary(), french)
}

/// A path that is short enough to read: with `~` for the home directory.
pub(super) fn short_path(path: &Path) -> String {
    let home = directories::UserDirs::new().map(|dirs| dirs.home_dir().to_owned());
    match home.as_deref().and_then(|home| path.strip_prefix(home).ok()) {
        Some(rest) => Path::new("~").join(rest).display().to_string(),
        None => path.display().to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Language;

    #[test]
    fn every_built_in_scene_has_a_summary_in_each_language() {
        for scene in builtin_scenes() {
            let summary = summary(scene);
            assert_eq!(Language::English.say(summary), scene.summary());
            assert_ne!(Language::French.say(summary), scene.summary(), "{}", scene.name());
        }
    }
}
