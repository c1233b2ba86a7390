//! A file dialog inside of the window.
//!
//! The system's own dialogs say nothing and do nothing where no desktop portal runs; this one is the same everywhere.
//! [`state`] decides, [`disk`] looks at the disk on a thread of its own, [`view`] draws.

mod disk;
mod state;
mod view;

pub use state::{FilePicker, Place, Purpose};

use crate::Phrase;
use lancer_io::SCENE_EXTENSIONS;
use lancer_io::image::ImageFormat;
use lancer_io::model::model_extensions;

impl Purpose {
    /// The heading of the dialog.
    pub const fn title(self) -> Phrase {
        match self {
            Self::Open => Phrase::new("Open a scene or a model", "Ouvrir une scène ou un modèle"),
            Self::SavePicture => Phrase::new("Save the picture", "Enregistrer l’image"),
            Self::SaveScene => Phrase::new("Save the scene", "Enregistrer la scène"),
        }
    }

    /// What the button that ends it says.
    pub const fn verb(self) -> Phrase {
        match self {
            Self::Open => Phrase::new("Open", "Ouvrir"),
            Self::SavePicture | Self::SaveScene => Phrase::new("Save", "Enregistrer"),
        }
    }

    /// The extensions of the files that it is about; the first is added where one is missing.
    pub fn extensions(self) -> Vec<&'static str> {
        match self {
            Self::Open => SCENE_EXTENSIONS.into_iter().chain(model_extensions()).collect(),
            Self::SavePicture => ImageFormat::EXTENSIONS.to_vec(),
            Self::SaveScene => vec!["yaml", "yml"],
        }
    }

    /// Whether a file is written.
    pub const fn is_save(self) -> bool {
        !matches!(self, Self::Open)
    }
}
