//! What passes are called.

use super::Pass;
use crate::scene::Light;
use std::collections::{HashMap, HashSet};

/// The passes of every scene, by name.
const NAMED: [(&str, Pass); 18] = [
    ("ambient", Pass::Ambient),
    ("diffuse", Pass::Diffuse),
    ("specular", Pass::Specular),
    ("reflection", Pass::Reflection),
    ("transmission", Pass::Transmission),
    ("background", Pass::Background),
    ("all_ambient", Pass::AllAmbient),
    ("all_background", Pass::AllBackground),
    ("ao", Pass::Occlusion),
    ("depth", Pass::Depth),
    ("distance", Pass::Distance),
    ("position", Pass::Position),
    ("normal", Pass::Normal),
    ("geometric_normal", Pass::GeometricNormal),
    ("uv", Pass::Uv),
    ("object_id", Pass::ObjectId),
    ("material_id", Pass::MaterialId),
    ("cost", Pass::Cost),
];

/// The picture itself, which is always made.
const BEAUTY: &str = "beauty";
/// All passes.
const ALL: &str = "all";
/// The terms that add up to the picture.
const TERMS: &str = "terms";
/// The sources that add up to the picture.
const LIGHTS: &str = "lights";
/// Before the name of a light.
const LIGHT: &str = "light.";

/// The most bytes of a light's name in that of its pass; formats allow 255 for a name and what stands around it.
const LONGEST: usize = 200;

/// A word that names no pass.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no pass `{word}`")]
pub struct UnknownPass {
    /// The word.
    pub word: String,
    /// The words that do, as a list for people.
    pub known: String,
}

/// The passes that words mean: names of passes, or `all`, `terms` and `lights` for several.
///
/// # Errors
/// The first word that means none.
pub fn select<'a>(
    words: impl IntoIterator<Item = &'a str>,
    lights: &[Light],
) -> Result<Vec<Pass>, UnknownPass> {
    let names = light_names(lights);
    let every_light = || (0..lights.len()).map(Pass::Light);
    let mut passes = Vec::new();
    for word in words {
        match word {
            BEAUTY => {}
            ALL => passes.extend(NAMED.iter().map(|&(_, pass)| pass).chain(every_light())),
            TERMS => passes.extend(NAMED.iter().map(|&(_, pass)| pass).filter(|pass| pass.term().is_some())),
            LIGHTS => passes.extend([Pass::AllAmbient, Pass::AllBackground].into_iter().chain(every_light())),
            word => passes.push(named(word, &names).ok_or_else(|| unknown(word, &names))?),
        }
    }
    passes.sort_unstable();
    passes.dedup();
    Ok(passes)
}

fn named(word: &str, lights: &[String]) -> Option<Pass> {
    let fixed = NAMED.iter().find(|(name, _)| *name == word).map(|&(_, pass)| pass);
    fixed.or_else(|| {
        let light = word.strip_prefix(LIGHT)?;
        lights.iter().position(|name| name == light).map(Pass::Light)
    })
}

fn unknown(word: &str, lights: &[String]) -> UnknownPass {
    /// More lights than this would bury the rest.
    const SHOWN: usize = 12;
    let fixed = [ALL, TERMS, LIGHTS, BEAUTY].into_iter().chain(NAMED.iter().map(|(name, _)| *name));
    let mut known = fixed.map(str::to_owned).collect::<Vec<_>>();
    known.extend(lights.iter().take(SHOWN).map(|name| format!("{LIGHT}{name}")));
    if lights.len() > SHOWN {
        known.push(format!("and {} more lights", lights.len() - SHOWN));
    }
    UnknownPass { word: word.to_owned(), known: known.join(", ") }
}

impl Pass {
    /// Its name, where `lights` are those of [`light_names`].
    ///
    /// # Panics
    /// Where it is of a light that is not among them.
    pub fn name(self, lights: &[String]) -> String {
        match self {
            Self::Light(light) => format!("{LIGHT}{}", lights[light]),
            pass => {
                let named = NAMED.iter().find(|&&(_, other)| other == pass);
                named.map(|(name, _)| (*name).to_owned()).expect("all passes but those of lights have names")
            }
        }
    }
}

/// What lights are called in the names of passes: no two alike, and of letters, digits, `-` and `_` alone, since a
/// dot parts layers and other signs trouble programs. A light without a name has its place, counted from 0.
pub fn light_names(lights: &[Light]) -> Vec<String> {
    let mut taken = HashSet::new();
    // The copies of a name that were handed out.
    let mut copies = HashMap::<String, u64>::new();
    let mut free_name = |name: String| {
        let mut free = name.clone();
        while !taken.insert(free.clone()) {
            let copy = copies.entry(name.clone()).or_insert(1);
            *copy += 1;
            free = format!("{name}_{copy}");
        }
        free
    };
    let plain = |c: char| if c.is_ascii_alphanumeric() || c == '-' { c } else { '_' };
    let name_of = |(index, light): (usize, &Light)| match light.name.as_str() {
        "" => index.to_string(),
        name => name.chars().take(LONGEST).map(plain).collect(),
    };
    lights.iter().enumerate().map(name_of).map(&mut free_name).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::Rgb;
    use crate::geometry::DVec3;

    fn lights(names: &[&str]) -> Vec<Light> {
        let light =
            |name: &&str| Light { name: (*name).into(), position: DVec3::ZERO, intensity: Rgb::WHITE };
        names.iter().map(light).collect()
    }

    #[test]
    fn lights_are_told_apart_by_plain_names() {
        let names = light_names(&lights(&["key", "", "clé.2", "key", "3", "", "key_2"]));
        assert_eq!(names, ["key", "1", "cl__2", "key_2", "3", "5", "key_2_2"]);
    }

    #[test]
    fn words_mean_passes_each_once_and_in_their_order() {
        let lights = lights(&["key", "fill"]);
        let all = select(["all"], &lights).unwrap();
        assert_eq!(all.len(), NAMED.len() + 2);
        assert_eq!(select(["depth", "all", "terms", "lights", "beauty"], &lights).unwrap(), all);
        assert_eq!(select(["cost", "ambient"], &lights).unwrap(), [Pass::Ambient, Pass::Cost]);
        let sources = [Pass::AllAmbient, Pass::AllBackground, Pass::Light(0), Pass::Light(1)];
        assert_eq!(select(["lights"], &lights).unwrap(), sources);
        assert_eq!(select(["light.fill"], &lights).unwrap(), [Pass::Light(1)]);
        assert_eq!(select(["terms"], &lights).unwrap().len(), 6);
        assert_eq!(select(["beauty"], &lights).unwrap(), []);
    }

    #[test]
    fn names_and_words_agree() {
        let lights = lights(&["key", ""]);
        let names = light_names(&lights);
        for pass in select(["all"], &lights).unwrap() {
            assert_eq!(select([pass.name(&names).as_str()], &lights).unwrap(), [pass]);
        }
    }

    #[test]
    fn a_word_that_means_nothing_is_told_with_those_that_do() {
        let error = select(["depth", "light.rim"], &lights(&["key"])).unwrap_err();
        assert_eq!(error.to_string(), "there is no pass `light.rim`");
        assert!(error.known.contains("light.key") && error.known.contains("terms"), "{}", error.known);
    }
}
