//! How much a file may ask for.

use std::str::FromStr;

/// The bounds that keep a hostile file from taking the machine. Each is checked before anything is allocated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// The longest file that is read, in bytes.
    pub file_bytes: u64,
    /// The most triangles of one model.
    pub triangles: usize,
    /// The most bytes that one model may take while it is read: its triangles with all that is needed to make them, its
    /// nodes and materials. About 150 to 200 a triangle are usual. A packed file is granted less: 256 MiB, or what is
    /// worth its size.
    pub memory: u64,
    /// The most objects that a scene draws, each counted as often as it is drawn: a small file may place one a billion
    /// times. A world takes about 300 bytes for each.
    pub objects: u64,
    /// The most pixels of one texture. All textures of a scene may hold as many together, or more where their files are
    /// large: 24 for each byte.
    pub texture_pixels: u64,
    /// The most nodes of a scene file's syntax tree, aliases expanded.
    pub syntax_nodes: usize,
    /// The deepest nesting of a scene file.
    pub nesting: usize,
    /// The most errors told of one file; beyond it the rest are only counted.
    pub errors: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            file_bytes: 8 << 30,
            triangles: 200_000_000,
            memory: 16 << 30,
            objects: 1 << 20,
            texture_pixels: 1 << 26,
            syntax_nodes: 4_000_000,
            nesting: 200,
            errors: 50,
        }
    }
}

/// A limit that users may change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Name {
    FileBytes,
    Triangles,
    Memory,
    Objects,
    TexturePixels,
    Errors,
}

impl Name {
    const ALL: [Self; 6] =
        [Self::FileBytes, Self::Triangles, Self::Memory, Self::Objects, Self::TexturePixels, Self::Errors];

    fn as_str(self) -> &'static str {
        match self {
            Self::FileBytes => "file-bytes",
            Self::Triangles => "triangles",
            Self::Memory => "memory",
            Self::Objects => "objects",
            Self::TexturePixels => "texture-pixels",
            Self::Errors => "errors",
        }
    }

    fn meaning(self) -> &'static str {
        match self {
            Self::FileBytes => "bytes of a file",
            Self::Triangles => "triangles of a model",
            Self::Memory => "bytes of memory to read a model in",
            Self::Objects => "objects that a scene draws",
            Self::TexturePixels => "pixels of a texture",
            Self::Errors => "errors told of a file",
        }
    }
}

/// A new value of one limit, written `triangles=500M`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LimitChange {
    name: Name,
    value: u64,
}

/// Why a text is no [`LimitChange`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LimitChangeError {
    /// There is no `=`.
    #[error("must be a name and a number, as in triangles=500M")]
    Form,
    /// There is no such limit, or none that may be changed.
    #[error("there is no limit `{0}`; those that may be changed are {all}", all = Name::ALL.map(Name::as_str).join(", "))]
    Name(String),
    /// The number is none.
    #[error("`{0}` is not a whole number, perhaps with k, M or G after it")]
    Number(String),
}

impl FromStr for LimitChange {
    type Err = LimitChangeError;

    fn from_str(text: &str) -> Result<Self, LimitChangeError> {
        let (name, number) = text.split_once('=').ok_or(LimitChangeError::Form)?;
        let known = Name::ALL.into_iter().find(|known| known.as_str() == name);
        let name = known.ok_or_else(|| LimitChangeError::Name(name.to_owned()))?;
        let value = whole_number(number).ok_or_else(|| LimitChangeError::Number(number.to_owned()))?;
        Ok(Self { name, value })
    }
}

/// A whole number, perhaps of thousands, millions or billions.
fn whole_number(text: &str) -> Option<u64> {
    let (digits, unit) = match text.chars().next_back()? {
        'k' => (&text[..text.len() - 1], 1_000),
        'M' => (&text[..text.len() - 1], 1_000_000),
        'G' => (&text[..text.len() - 1], 1_000_000_000),
        _ => (text, 1),
    };
    let is_plain = digits.bytes().all(|byte| byte.is_ascii_digit());
    digits.parse::<u64>().ok().filter(|_| is_plain)?.checked_mul(unit)
}

/// How many times its size a packed file may unpack to. Text compresses to a tenth, and very regular text to a
/// fiftieth; the method itself reaches 1032, which only bombs come near.
pub(crate) const MOST_UNPACKED: u64 = 100;

/// What any file may unpack to, in bytes: small ones may be as regular as they like.
pub(crate) const SMALL_UNPACKED: u64 = 16 << 20;

/// How many times its size a packed model may take in memory. Below 200, a plain grid of triangles, of which one takes
/// a byte, would be refused; the text of a bomb may be worth ten times its own size.
const MOST_OF_PACKED: u64 = 200;

/// What any packed model may take in memory, in bytes: about two million triangles.
const SMALL_OF_PACKED: u64 = 256 << 20;

impl Limits {
    /// The limits for what is packed in so many bytes: a small file has no right to a large model.
    pub(crate) fn of_packed(self, packed: u64) -> Self {
        let most = |times: u64, at_least: u64| packed.saturating_mul(times).max(at_least);
        Self {
            file_bytes: self.file_bytes.min(most(MOST_UNPACKED, SMALL_UNPACKED)),
            memory: self.memory.min(most(MOST_OF_PACKED, SMALL_OF_PACKED)),
            ..self
        }
    }

    /// Changes one limit.
    pub fn change(&mut self, LimitChange { name, value }: LimitChange) {
        let size = usize::try_from(value).unwrap_or(usize::MAX);
        match name {
            Name::FileBytes => self.file_bytes = value,
            Name::Triangles => self.triangles = size,
            Name::Memory => self.memory = value,
            Name::Objects => self.objects = value,
            Name::TexturePixels => self.texture_pixels = value,
            Name::Errors => self.errors = size,
        }
    }

    /// The limits that may be changed by [`LimitChange`]: name, value and meaning.
    pub fn listed(&self) -> [(&'static str, u64, &'static str); 6] {
        Name::ALL.map(|name| {
            let value = match name {
                Name::FileBytes => self.file_bytes,
                Name::Triangles => self.triangles as u64,
                Name::Memory => self.memory,
                Name::Objects => self.objects,
                Name::TexturePixels => self.texture_pixels,
                Name::Errors => self.errors as u64,
            };
            (name.as_str(), value, name.meaning())
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_limit_that_is_listed_can_be_changed() {
        let mut limits = Limits::default();
        for (name, _, _) in Limits::default().listed() {
            limits.change(format!("{name}=12k").parse().unwrap());
        }
        assert!(limits.listed().iter().all(|&(_, value, _)| value == 12_000));
    }

    #[test]
    fn what_is_no_change_says_why() {
        let told = |text: &str| text.parse::<LimitChange>().unwrap_err().to_string();
        assert_eq!(told("triangles"), "must be a name and a number, as in triangles=500M");
        assert!(
            told("triangle=3").starts_with("there is no limit `triangle`; those that may be changed are ")
        );
        for junk in ["", "-1", "+1", "1.5", "1e9", "k", "2 G", "99999999999999999999", "99999999999999G"] {
            assert!(told(&format!("memory={junk}")).contains("is not a whole number"), "{junk}");
        }
        assert_eq!("memory=2G".parse(), Ok(LimitChange { name: Name::Memory, value: 2_000_000_000 }));
    }
}
