//! A person before the window, for the length of a test.

use crate::controls::Controls;
use lancer_xvfb::{Area, Button, Display, Failure, FileDrag, Picture, Program, missing_tools};
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Output};
use tempfile::TempDir;

/// The display, all of which the window takes.
const SIZE: (u16, u16) = (1280, 800);

/// Something of everything, and soon drawn.
pub(crate) const BALLS: &str = "
format: 1
camera: {eye: [0, 2, 8], target: [0, 1, 0], fov: 40}
ambient: 0.2
background: '#87ceeb'
lights: [{position: [4, 6, 4], intensity: 200}]
materials:
  floor: {color: [0.8, 0.7, 0.6]}
  mirror: {diffuse: 0.1, reflect: 0.8}
  glass: {ambient: 0.1, diffuse: 0.1, specular: 0.5, transmit: 0.8, reflect: 0.1}
objects:
  - {shape: plane, material: floor}
  - {shape: sphere, material: mirror, transform: [{translate: [-1.2, 1, 0]}]}
  - {shape: sphere, material: glass, transform: [{translate: [1.2, 1, 0.5]}]}
render: {width: 160, height: 120, depth: 3, ao: {samples: 4}}
";

/// A part of the viewport that no panel, note or mark covers.
pub(crate) const VIEW: Area = Area { x: 330, y: 250, width: 560, height: 300 };

/// More colours than a panel or an empty viewport has.
const COLOURS_OF_A_SCENE: usize = 200;

/// Lets a person sit before a window that was opened with these arguments, in a directory with these files, and
/// checks that the program said nothing to the terminal.
///
/// # Panics
/// Something did not go as it should.
pub(crate) fn sit(
    name: &str,
    arguments: &[&str],
    files: &[(&str, &str)],
    test: impl FnOnce(&mut Sitting<'_>) -> Result<(), Failure>,
) {
    let missing = missing_tools();
    if !missing.is_empty() {
        assert!(!Path::new("/etc/debian_version").exists(), "./setup installs what is missing: {missing:?}");
        // The test harness hides what is printed, and this is to be seen.
        let _ = writeln!(std::io::stderr(), "SKIPPED: the window was not tested, for want of {missing:?}");
        return;
    }
    let directory = tempfile::tempdir().unwrap();
    files.iter().for_each(|(name, text)| fs::write(directory.path().join(name), text).unwrap());
    let display = Display::start(SIZE.0, SIZE.1).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_lancer"));
    let program = Program::start(
        &display,
        command.current_dir(&directory).args(arguments).env_remove("RUST_BACKTRACE"),
    );
    let pictures = Path::new(env!("CARGO_TARGET_TMPDIR")).join("window").join(name);
    // Steps of an earlier run would be taken for this one's.
    let _ = fs::remove_dir_all(&pictures);
    let mut sitting = Sitting { display: &display, program: program.unwrap(), directory, pictures, steps: 0 };
    let result = sitting.begin().and_then(|()| test(&mut sitting));
    assert!(result.is_ok(), "{}", result.unwrap_err());
    assert_eq!(sitting.program.stderr(), "");
}

/// A window, and the person before it.
pub(crate) struct Sitting<'a> {
    display: &'a Display,
    program: Program<'a>,
    directory: TempDir,
    pictures: PathBuf,
    steps: u32,
}

impl Sitting<'_> {
    fn begin(&mut self) -> Result<(), Failure> {
        self.program.place_window(self.display.area())?;
        self.see("started").map(drop)
    }

    /// A file in the directory in which the program runs.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.directory.path().join(name)
    }

    /// Runs `lancer` there, which must succeed.
    pub(crate) fn lancer(&self, line: &str) -> Output {
        let mut command = assert_cmd::Command::new(env!("CARGO_BIN_EXE_lancer"));
        command
            .current_dir(&self.directory)
            .args(line.split_whitespace())
            .assert()
            .success()
            .get_output()
            .clone()
    }

    /// Waits until nothing changes any more, keeps a picture of all that is seen under this name, and returns the
    /// [`VIEW`].
    pub(crate) fn see(&mut self, step: &str) -> Result<Picture, Failure> {
        self.program.settle()?;
        self.keep(step)?;
        self.view()
    }

    /// Keeps a picture of all that is seen now under this name.
    pub(crate) fn keep(&mut self, step: &str) -> Result<PathBuf, Failure> {
        self.steps += 1;
        let path = self.pictures.join(format!("{:02}-{}.png", self.steps, step.replace(' ', "-")));
        self.display.picture()?.save(&path)?;
        Ok(path)
    }

    /// What is seen in the [`VIEW`] now.
    pub(crate) fn view(&self) -> Result<Picture, Failure> {
        self.display.picture_of(VIEW)
    }

    /// Waits until the title of the window says this.
    pub(crate) fn wait_for_title(&mut self, title: &str) -> Result<(), Failure> {
        self.program.wait_for(title, |program| Ok((program.title()? == title).then_some(())))
    }

    /// Waits until the view is another one.
    pub(crate) fn wait_for_change(&mut self, before: &Picture) -> Result<(), Failure> {
        let display = self.display;
        let changed = || Ok((display.picture_of(VIEW)? != *before).then_some(()));
        self.program.wait_for("the view to change", |_| changed())
    }

    /// Gives a command, or opens a scene, by its name.
    pub(crate) fn command(&mut self, name: &str) -> Result<(), Failure> {
        self.display.keys(&["ctrl+k"])?;
        self.program.settle()?;
        self.display.text(name)?;
        self.program.settle()?;
        self.display.keys(&["Return"])
    }

    /// Presses keys together, one such chord after another.
    pub(crate) fn keys(&self, chords: &[&str]) -> Result<(), Failure> {
        self.display.keys(chords)
    }

    /// Types a text over what a field holds, and Enter.
    pub(crate) fn enter(&mut self, text: &str) -> Result<(), Failure> {
        self.display.keys(&["ctrl+a"])?;
        self.display.text(text)?;
        self.program.settle()?;
        self.display.keys(&["Return"])
    }

    /// Drags from the middle of the view, and looks again when the picture follows, before letting go.
    pub(crate) fn drag(&mut self, button: Button, by: (i32, i32)) -> Result<(), Failure> {
        let before = self.view()?;
        let (x, y) = VIEW.centre();
        self.display.move_to((x, y))?;
        self.display.press(button)?;
        self.display.move_to((x + by.0 / 2, y + by.1 / 2))?;
        self.wait_for_change(&before)?;
        self.display.move_to((x + by.0, y + by.1))?;
        self.program.settle()?;
        self.display.release(button)
    }

    /// The controls of this window, while it shows a scene of the directory.
    pub(crate) fn controls(&self, scene: &str) -> Result<Controls, Failure> {
        let size = [f32::from(SIZE.0), f32::from(SIZE.1)];
        Controls::of(self.path(scene), size, self.path("controls"))
    }

    /// Clicks.
    pub(crate) fn click(&self, at: (i32, i32)) -> Result<(), Failure> {
        self.display.click(at, Button::Left)
    }

    /// Turns the wheel by one step, over the middle of the view.
    pub(crate) fn wheel(&mut self, step: Button) -> Result<(), Failure> {
        let before = self.view()?;
        self.display.click(VIEW.centre(), step)?;
        self.wait_for_change(&before)
    }

    /// Drags a file of the directory over the window, as from a file manager.
    /// What was copied, in a form such as `image/png`.
    pub(crate) fn clipboard(&self, form: &str) -> Result<Option<Vec<u8>>, Failure> {
        self.display.clipboard(form)
    }

    pub(crate) fn drag_file(&self, name: &str) -> Result<FileDrag, Failure> {
        FileDrag::over(self.display, &self.program, &[&self.path(name)], (600, 400))
    }

    /// Closes the window by the cross in its corner.
    pub(crate) fn close(&self) -> Result<(), Failure> {
        self.program.ask_to_close()
    }

    /// How the program ended by itself.
    pub(crate) fn end(&mut self) -> Result<ExitStatus, Failure> {
        self.program.wait_for_end()
    }
}

impl Drop for Sitting<'_> {
    /// Tells what was to be seen when a test failed.
    #[expect(clippy::print_stderr, reason = "a test that fails has nowhere else to say why")]
    fn drop(&mut self) {
        if std::thread::panicking() {
            match self.keep("failed") {
                Ok(path) => eprintln!("seen last: {}", path.display()),
                Err(error) => eprintln!("nothing was seen at last: {error}"),
            }
            eprintln!("the program said: {:?}", self.program.stderr());
        }
    }
}

/// Whether there is a scene in a view.
pub(crate) fn shows_a_scene(view: &Picture) -> bool {
    view.colours() > COLOURS_OF_A_SCENE
}
