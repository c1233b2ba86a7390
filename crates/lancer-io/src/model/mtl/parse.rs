//! The statements of a material library.
//!
//! In: its bytes. Out: definitions as written, and warnings. It knows nothing of the renderer's materials.

use crate::diagnostics::Diagnostic;
use crate::model::polygons::UvPlacement;
use crate::model::report::PassedOver;
use crate::model::text::{Cursor, Source, Word, decode};
use lancer_core::Rgb;
use lancer_core::scene::Wrap;

/// A material as its library writes it; `None` for what it leaves out.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Definition {
    pub(super) name: String,
    /// Kd.
    pub(super) diffuse: Option<Rgb>,
    /// Ks.
    pub(super) specular: Option<Rgb>,
    /// Ns.
    pub(super) shininess: Option<f64>,
    /// Ni.
    pub(super) ior: Option<f64>,
    /// d.
    pub(super) dissolve: Option<f64>,
    /// Tr, which is 1 - d.
    pub(super) transparency: Option<f64>,
    /// Tf.
    pub(super) filter: Option<Rgb>,
    pub(super) illum: Option<u32>,
    pub(super) map_kd: Option<Map>,
}

/// An image on a surface.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Map {
    /// Its file, as named.
    pub(super) file: String,
    /// Where it lies.
    pub(super) placement: UvPlacement,
    /// What lies beyond it.
    pub(super) wrap: Wrap,
}

/// What a library may hold that is not drawn.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// A map other than map_Kd, and why it is not drawn.
    Map(&'static str),
    /// Ke.
    Emission,
    /// Options of map_Kd that would change the picture.
    MapOption,
    /// Statements whose values cannot be read.
    Malformed,
    /// Statements before the first `newmtl`.
    Nameless,
}

impl Kind {
    fn message(self, word: &str) -> String {
        match self {
            Self::Map(why) => format!("`{word}` is not drawn: {why}"),
            Self::Emission => format!("`{word}` is not drawn: surfaces do not shine by themselves"),
            Self::MapOption => format!("`{word}` is passed over: the map is used as it is"),
            Self::Malformed => format!("the value of `{word}` cannot be read and is passed over"),
            Self::Nameless => format!("`{word}` stands before the first newmtl and is passed over"),
        }
    }
}

/// All definitions of a library, in order, and what the user should know about it.
pub(super) fn definitions(source: Source) -> (Vec<Definition>, Vec<Diagnostic>) {
    let cursor = Cursor::new(source.bytes, 0);
    let mut parser = Parser { cursor, definitions: Vec::new(), passed_over: PassedOver::new() };
    while let Some(keyword) = parser.cursor.first_word() {
        parser.statement(keyword);
        parser.cursor.skip_line();
    }
    let warnings = parser.passed_over.warnings(source, Kind::message);
    (parser.definitions, warnings)
}

struct Parser<'a> {
    cursor: Cursor<'a>,
    definitions: Vec<Definition>,
    passed_over: PassedOver<'a, Kind>,
}

impl<'a> Parser<'a> {
    fn statement(&mut self, keyword: Word<'a>) {
        let lower = keyword.bytes.to_ascii_lowercase();
        if lower == b"newmtl" {
            let name = decode(self.cursor.rest_of_line().bytes).into_owned();
            self.definitions.push(Definition { name, ..Definition::default() });
            return;
        }
        let Some(mut definition) = self.definitions.pop() else {
            return self.passed_over.add(Kind::Nameless, keyword);
        };
        match self.property(&lower, keyword, &mut definition) {
            Some(()) => {}
            None => self.passed_over.add(Kind::Malformed, keyword),
        }
        self.definitions.push(definition);
    }

    /// One statement of a material; `None` if its value cannot be read. Unknown ones are passed over: every
    /// exporter has its own.
    fn property(&mut self, lower: &[u8], keyword: Word<'a>, definition: &mut Definition) -> Option<()> {
        match lower {
            b"kd" => definition.diffuse = Some(self.color()?),
            b"ks" => definition.specular = Some(self.color()?),
            b"tf" => definition.filter = Some(self.color()?),
            b"ns" => definition.shininess = Some(self.number()?),
            b"ni" => definition.ior = Some(self.number()?),
            b"d" => definition.dissolve = Some(self.dissolve()?),
            b"tr" => definition.transparency = Some(self.number()?),
            b"illum" => definition.illum = Some(self.number()? as u32),
            b"map_kd" => definition.map_kd = Some(self.map()?),
            b"ke" if !self.color()?.is_black() => self.passed_over.add(Kind::Emission, keyword),
            _ => {
                if let Some(why) = why_not_drawn(lower) {
                    self.passed_over.add(Kind::Map(why), keyword);
                }
            }
        }
        Some(())
    }

    fn number(&mut self) -> Option<f64> {
        self.cursor.word()?.number()
    }

    /// `d 0.5`, or `d -halo 0.5`, whose fading toward the edges is left out.
    fn dissolve(&mut self) -> Option<f64> {
        let first = self.cursor.word()?;
        if first.bytes == b"-halo" { self.number() } else { first.number() }
    }

    /// `r g b`, or `r` alone for a grey. The forms `spectral` and `xyz` are not read.
    fn color(&mut self) -> Option<Rgb> {
        let r = self.number()?;
        let Some(g) = self.cursor.word() else {
            return Some(Rgb::grey(r));
        };
        Some(Rgb::new(r, g.number()?, self.number()?))
    }

    /// A map statement: options, then the file's name.
    fn map(&mut self) -> Option<Map> {
        let (mut placement, mut wrap) = (UvPlacement::IDENTITY, Wrap::Repeat);
        loop {
            let before = self.cursor.clone();
            let option = self.cursor.word()?;
            match (option.bytes, values_of_option(option.bytes)) {
                (b"-s", _) => placement.scale = self.up_to_3_numbers(1.0),
                (b"-o", _) => placement.offset = self.up_to_3_numbers(0.0),
                (_, Some(OptionValues::UpTo3Numbers)) => {
                    self.up_to_3_numbers(0.0);
                    self.passed_over.add(Kind::MapOption, option);
                }
                (_, Some(OptionValues::Words(count))) => {
                    let first = self.cursor.word();
                    (1..count).for_each(|_| {
                        self.cursor.word();
                    });
                    match option.bytes {
                        b"-clamp" if first.is_some_and(|word| word.bytes == b"on") => wrap = Wrap::Clamp,
                        b"-clamp" => wrap = Wrap::Repeat,
                        b"-mm" => self.passed_over.add(Kind::MapOption, option),
                        // The others choose a filter or a channel.
                        _ => {}
                    }
                }
                (_, None) => {
                    self.cursor = before;
                    break;
                }
            }
        }
        let file = decode(self.cursor.rest_of_line().bytes).trim_matches('"').to_owned();
        (!file.is_empty()).then_some(Map { file, placement, wrap })
    }

    /// The first two of at most three numbers; the third is for solid textures. Those that are absent are `missing`.
    fn up_to_3_numbers(&mut self, missing: f64) -> [f64; 2] {
        let mut numbers = [missing; 3];
        for number in &mut numbers {
            let before = self.cursor.clone();
            let Some(found) = self.number() else {
                self.cursor = before;
                break;
            };
            *number = found;
        }
        [numbers[0], numbers[1]]
    }
}

/// What follows an option of a map.
#[derive(Clone, Copy)]
enum OptionValues {
    Words(usize),
    UpTo3Numbers,
}

fn values_of_option(word: &[u8]) -> Option<OptionValues> {
    match word {
        b"-o" | b"-s" | b"-t" => Some(OptionValues::UpTo3Numbers),
        b"-mm" => Some(OptionValues::Words(2)),
        b"-blendu" | b"-blendv" | b"-cc" | b"-clamp" | b"-texres" | b"-boost" | b"-bm" | b"-imfchan"
        | b"-type" => Some(OptionValues::Words(1)),
        _ => None,
    }
}

/// Why a map other than map_Kd is not drawn; `None` for what is no map.
fn why_not_drawn(lower: &[u8]) -> Option<&'static str> {
    Some(match lower {
        b"map_ka" => "the ambient light follows map_Kd",
        b"map_ks" | b"map_ns" | b"map_pr" | b"map_pm" | b"map_ps" => {
            "of a material, only the colour may change over a surface"
        }
        b"map_d" | b"map_tr" => "a material is as opaque in one place as in another",
        b"bump" | b"map_bump" | b"norm" | b"map_kn" | b"disp" | b"map_disp" => "relief is the mesh's alone",
        b"refl" | b"map_refl" => "a mirror shows the scene",
        b"map_ke" => "surfaces do not shine by themselves",
        _ if lower.starts_with(b"map_") || lower == b"decal" => "the only map that is, is map_Kd",
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn parse(text: &str) -> (Vec<Definition>, Vec<Diagnostic>) {
        definitions(Source { path: Path::new("f.mtl"), bytes: text.as_bytes() })
    }

    fn placed_map_of(statement: &str) -> Option<Map> {
        parse(&format!("newmtl m\n{statement}\n")).0.remove(0).map_kd
    }

    fn map_of(statement: &str) -> Option<String> {
        placed_map_of(statement).map(|map| map.file)
    }

    #[test]
    fn statements_fill_the_last_definition() {
        let (found, warnings) = parse(
            "newmtl a b\r\nKd 0.1 .2 0.3\nNs 10\n\tillum 2\nnewmtl c\nKd 0.5\nKs 1 1 1\nd 0.5\nNi 1.3\nTf 1 0 0\n",
        );
        assert_eq!(found.len(), 2);
        assert_eq!(found[0].name, "a b");
        assert_eq!(found[0].diffuse, Some(Rgb::new(0.1, 0.2, 0.3)));
        assert_eq!((found[0].shininess, found[0].illum), (Some(10.0), Some(2)));
        assert_eq!(found[1].diffuse, Some(Rgb::grey(0.5)));
        assert_eq!((found[1].dissolve, found[1].ior), (Some(0.5), Some(1.3)));
        assert!(warnings.is_empty());
    }

    #[test]
    fn map_names_keep_blanks_and_lose_options() {
        assert_eq!(map_of("map_Kd wood.png").as_deref(), Some("wood.png"));
        assert_eq!(map_of("map_Kd -s 1 2 -o 0.5 my wood.png ").as_deref(), Some("my wood.png"));
        assert_eq!(map_of("map_kd -clamp on -mm 0 1 a\\b.png").as_deref(), Some("a\\b.png"));
        assert_eq!(map_of("map_Kd -s 1 1 1 2.png").as_deref(), Some("2.png"));
        assert_eq!(map_of("map_Kd"), None);
    }

    #[test]
    fn options_scale_and_move_the_map() {
        let placement = |statement| placed_map_of(statement).unwrap().placement;
        let placed = placement("map_Kd -s 2 3 1 -o 0.5 -0.25 0 -blendu off a.png");
        assert_eq!(placed, UvPlacement { scale: [2.0, 3.0], offset: [0.5, -0.25] });
        assert_eq!(placed.apply([0.25, 1.0]), [1.0, 2.75]);
        // What is left out is 1 for -s and 0 for -o.
        let placed = placement("map_Kd -o 0.5 -s 2 a.png");
        assert_eq!(placed, UvPlacement { scale: [2.0, 1.0], offset: [0.5, 0.0] });
        assert_eq!(placement("map_Kd a.png"), UvPlacement::IDENTITY);
    }

    #[test]
    fn clamping_is_off_unless_it_is_said_to_be_on() {
        let wrap = |statement| placed_map_of(statement).unwrap().wrap;
        assert_eq!(wrap("map_Kd -clamp on a.png"), Wrap::Clamp);
        assert_eq!(wrap("map_Kd -s 2 2 -clamp on -o 1 a.png"), Wrap::Clamp);
        assert_eq!(wrap("map_Kd -clamp off a.png"), Wrap::Repeat);
        assert_eq!(wrap("map_Kd a.png"), Wrap::Repeat);
    }

    #[test]
    fn what_is_not_drawn_is_told_once_a_kind() {
        let (_, warnings) = parse(
            "Kd 1 1 1\nnewmtl a\nKd nan 0 0\nKe 1 1 1\nKe 0 0 0\nmap_Bump b.png\nbump b.png\nmap_Kd -t 1 a.png\n\
             map_Kd -clamp on -mm 0 1 a.png\nmap_d d.png\n",
        );
        let lines = warnings.iter().map(|warning| warning.location.unwrap().line).collect::<Vec<_>>();
        assert_eq!(lines, [1, 3, 4, 6, 8, 10]);
        assert!(
            warnings[3].message.contains("`map_Bump` is not drawn")
                && warnings[3].message.ends_with("(and 1 more)")
        );
    }
}
