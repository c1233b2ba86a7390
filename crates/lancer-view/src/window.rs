//! A window of the system, with the application in it.

use crate::app::Remembered;
use crate::preferences::PreferencesFile;
use crate::{App, Options};
use eframe::NativeOptions;
use eframe::egui::ViewportBuilder;

/// Why there is no window.
#[derive(Debug, thiserror::Error)]
pub enum WindowError {
    /// The system has no display, or gives no window.
    #[error("cannot open a window: {0}")]
    NoWindow(String),
}

/// The window's size before the first run, in points.
const SIZE: [f32; 2] = [1280.0, 800.0];

/// The least size at which all panels can be used.
const LEAST_SIZE: [f32; 2] = [760.0, 480.0];

/// Opens the window, and returns when it is closed.
///
/// # Errors
/// There is no display, or no window can be made on it.
pub fn run(options: Options) -> Result<(), WindowError> {
    let remembered = Remembered::load(PreferencesFile::of_user());
    let mut viewport = ViewportBuilder::default()
        .with_title("Lancer")
        .with_app_id("lancer")
        .with_min_inner_size(LEAST_SIZE)
        .with_inner_size(SIZE)
        .with_drag_and_drop(true);
    if let Some(place) = remembered.window() {
        viewport = viewport.with_inner_size(place.size).with_maximized(place.maximized);
        if let Some([x, y]) = place.position {
            viewport = viewport.with_position([x, y]);
        }
    }
    let native = NativeOptions { viewport, ..NativeOptions::default() };
    eframe::run_native(
        "lancer",
        native,
        Box::new(|creation| Ok(Box::new(App::new(&creation.egui_ctx, options, remembered)))),
    )
    .map_err(|error| WindowError::NoWindow(error.to_string()))
}
