//! Where the controls of the window are: in the same interface at the same size, laid out without a display.

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use lancer_view::{App, Language, Options, Preferences, PreferencesFile, Remembered, Source};
use lancer_xvfb::{Failure, wait_for};
use std::path::PathBuf;

/// The interface, asked for places.
pub(crate) struct Controls {
    layout: Harness<'static, Option<App>>,
}

impl Controls {
    /// Of a window in English of this size in points, which shows a scene file.
    ///
    /// # Errors
    /// Preferences cannot be written into `directory`.
    pub(crate) fn of(scene: PathBuf, size: [f32; 2], directory: PathBuf) -> Result<Self, Failure> {
        let mut file = PreferencesFile::in_directory(&directory);
        file.load();
        file.save(&Preferences { language: Some(Language::English), ..Preferences::default() })?;
        let layout = Harness::builder().with_size(size).build_ui_state(
            move |ui, app: &mut Option<App>| {
                let app = app.get_or_insert_with(|| {
                    let options = Options { source: Source::File(scene.clone()), load: Default::default() };
                    let remembered = Remembered::load(PreferencesFile::in_directory(&directory));
                    App::new(ui.ctx(), options, remembered)
                });
                app.frame(ui);
            },
            None,
        );
        Ok(Self { layout })
    }

    /// The middle of the control of this name, once it is there.
    ///
    /// # Errors
    /// It never is.
    pub(crate) fn place(&mut self, name: &str) -> Result<(i32, i32), Failure> {
        wait_for(name, || {
            self.layout.run_steps(2);
            let centre = self.layout.query_by_label(name).map(|control| control.rect().center());
            Ok(centre.map(|centre| (centre.x as i32, centre.y as i32)))
        })
    }
}
