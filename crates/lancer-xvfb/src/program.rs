//! A program on a display: its window, whether it rests, and its end.

use crate::{Area, Display, Failure, wait_for};
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::Duration;
use tempfile::TempDir;
use x11rb::connection::Connection;
use x11rb::protocol::xproto::{
    ClientMessageEvent, ConfigureWindowAux, ConnectionExt, EventMask, InputFocus, MapState, Window,
};

/// A running program with a home of its own. It is killed when this value is dropped.
pub struct Program<'a> {
    display: &'a Display,
    child: Child,
    home: TempDir,
}

/// The cursor of a text field, in the largest letters.
const PIXELS_OF_A_CURSOR: usize = 100;

/// Looks that must all find a program at rest: a pause between two steps of its work is shorter than all of them.
/// With many more, the blinking of a cursor would be met by one of them, again and again.
const QUIET_LOOKS: u32 = 8;

/// The time between them. With [`QUIET_LOOKS`] it is longer than what a window waits before it takes a pointer as
/// resting.
const BETWEEN_LOOKS: Duration = Duration::from_millis(50);

impl<'a> Program<'a> {
    /// Starts a program on a display: in software, in English, without a session of the desktop, and with a new
    /// home. Variables that `command` sets stay as it sets them.
    ///
    /// # Errors
    /// It does not start.
    pub fn start(display: &'a Display, command: &mut Command) -> Result<Self, Failure> {
        let home = tempfile::tempdir()?;
        let own = command.get_envs().map(|(key, _)| key.to_owned()).collect::<Vec<_>>();
        let place = |name: &str| home.path().join(name).into_os_string();
        let variables = [
            ("DISPLAY", display.name().into()),
            ("HOME", home.path().into()),
            ("XDG_CACHE_HOME", place("cache")),
            ("XDG_CONFIG_HOME", place("config")),
            ("XDG_DATA_HOME", place("data")),
            ("XDG_RUNTIME_DIR", place("run")),
            ("XDG_STATE_HOME", place("state")),
            ("LANCER_CONFIG_DIR", place("lancer")),
            ("DBUS_SESSION_BUS_ADDRESS", "disabled:".into()),
            ("LANG", "en_GB.UTF-8".into()),
            ("LIBGL_ALWAYS_SOFTWARE", "1".into()),
        ];
        command.envs(variables.into_iter().filter(|(key, _)| !own.iter().any(|set| set == key)));
        for alien in ["LANGUAGE", "LC_ALL", "LC_MESSAGES", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
            command.env_remove(alien);
        }
        let child = command
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(File::create(home.path().join(STDERR))?)
            .spawn()
            .map_err(|error| format!("{} does not start: {error}", command.get_program().display()))?;
        Ok(Self { display, child, home })
    }

    /// The directory that the program takes for its user's.
    pub fn home(&self) -> &Path {
        self.home.path()
    }

    /// What it said on standard error.
    pub fn stderr(&self) -> String {
        let bytes = fs::read(self.home.path().join(STDERR)).unwrap_or_default();
        String::from_utf8_lossy(&bytes).into_owned()
    }

    /// Waits for its window, puts it into an area of the display as a window manager would, and gives it the
    /// keyboard.
    ///
    /// # Errors
    /// None comes; perhaps the program has ended.
    pub fn place_window(&mut self, area: Area) -> Result<(), Failure> {
        let window = self.wait_for("a window", Self::window)?;
        let Area { x, y, width, height } = area;
        let place = ConfigureWindowAux::new()
            .x(i32::from(x))
            .y(i32::from(y))
            .width(u32::from(width))
            .height(u32::from(height));
        let connection = self.display.connection();
        connection.configure_window(window, &place)?;
        connection.set_input_focus(InputFocus::PARENT, window, x11rb::CURRENT_TIME)?;
        Ok(connection.flush()?)
    }

    /// The title of its window; empty before there is one.
    ///
    /// # Errors
    /// The server is gone.
    pub fn title(&self) -> Result<String, Failure> {
        let Some(window) = self.window()? else { return Ok(String::new()) };
        let connection = self.display.connection();
        let [name, text] =
            ["_NET_WM_NAME", "UTF8_STRING"].map(|atom| connection.intern_atom(false, atom.as_bytes()));
        let (name, text) = (name?.reply()?.atom, text?.reply()?.atom);
        let title = connection.get_property(false, window, name, text, 0, u32::MAX)?.reply()?;
        Ok(String::from_utf8(title.value)?)
    }

    /// Asks its window to close, as the cross in its corner does.
    ///
    /// # Errors
    /// There is no window.
    pub fn ask_to_close(&self) -> Result<(), Failure> {
        let window = self.window()?.ok_or("there is no window to close")?;
        let connection = self.display.connection();
        let [protocols, delete] =
            ["WM_PROTOCOLS", "WM_DELETE_WINDOW"].map(|atom| connection.intern_atom(false, atom.as_bytes()));
        let (protocols, delete) = (protocols?.reply()?.atom, delete?.reply()?.atom);
        let please = ClientMessageEvent::new(32, window, protocols, [delete, x11rb::CURRENT_TIME, 0, 0, 0]);
        connection.send_event(false, window, EventMask::NO_EVENT, please)?;
        Ok(connection.flush()?)
    }

    /// Waits until the program has ended by itself.
    ///
    /// # Errors
    /// It does not end.
    pub fn wait_for_end(&mut self) -> Result<ExitStatus, Failure> {
        let child = &mut self.child;
        wait_for("the program's end", || Ok(child.try_wait()?))
    }

    /// Waits for something, as long as the program runs.
    ///
    /// # Errors
    /// It does not come, or the program has ended.
    pub fn wait_for<T>(
        &mut self,
        what: &str,
        look: impl Fn(&Self) -> Result<Option<T>, Failure>,
    ) -> Result<T, Failure> {
        wait_for(what, || match self.child.try_wait()? {
            None => look(self),
            Some(status) => Err(format!("waiting for {what}, the program ended: {status}").into()),
        })
    }

    /// Waits until the program rests: all of its threads sleep, and the picture stays, but for the cursor of a text
    /// field, which blinks.
    ///
    /// A program that works, or wants to and must wait for a processor, is not at rest; so this is true however
    /// slow the machine is.
    ///
    /// # Errors
    /// It never rests, or it has ended.
    pub fn settle(&mut self) -> Result<(), Failure> {
        let mut before = self.display.picture()?;
        let mut quiet_looks = 0;
        wait_for("the program to rest", || {
            std::thread::sleep(BETWEEN_LOOKS);
            if let Some(status) = self.child.try_wait()? {
                return Err(format!("waiting for it to rest, the program ended: {status}").into());
            }
            let sleeps = self.is_asleep()?;
            let now = self.display.picture()?;
            let is_quiet = sleeps && now.different_pixels(&before) <= PIXELS_OF_A_CURSOR;
            quiet_looks = if is_quiet { quiet_looks + 1 } else { 0 };
            before = now;
            Ok((quiet_looks >= QUIET_LOOKS).then_some(()))
        })
    }

    /// Processor time that all of its threads have used so far, in seconds, to a hundredth.
    ///
    /// # Errors
    /// It has ended.
    pub fn processor_seconds(&self) -> Result<f64, Failure> {
        Ok(processor_ticks(self.child.id())? as f64 / TICKS_PER_SECOND)
    }

    /// Whether all of its threads sleep at this moment.
    ///
    /// # Errors
    /// It has ended.
    pub fn is_asleep(&self) -> Result<bool, Failure> {
        all_threads_sleep(self.child.id())
    }

    /// The largest of the display's windows that can be seen, if there is one.
    pub(crate) fn window(&self) -> Result<Option<Window>, Failure> {
        largest_window(self.display)
    }
}

impl Drop for Program<'_> {
    fn drop(&mut self) {
        // One that has ended by itself is fine.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

const STDERR: &str = "stderr";

/// What Linux counts processor time in, on all of its machines.
const TICKS_PER_SECOND: f64 = 100.0;

/// User and system time.
fn processor_ticks(pid: u32) -> Result<u64, Failure> {
    let fields = stat(format!("/proc/{pid}/stat").into())?;
    // Fields 14 and 15 of the manual page, which counts from 1 and has two before the state.
    let ticks = |field: usize| fields.get(field - 3).and_then(|ticks| ticks.parse::<u64>().ok());
    Ok(ticks(14)
        .zip(ticks(15))
        .map(|(user, system)| user + system)
        .ok_or("/proc/PID/stat has another form")?)
}

fn all_threads_sleep(pid: u32) -> Result<bool, Failure> {
    for thread in fs::read_dir(format!("/proc/{pid}/task"))? {
        // A thread may end meanwhile.
        let Ok(fields) = stat(thread?.path().join("stat")) else { continue };
        if fields.first().is_some_and(|state| state != "S" && state != "I") {
            return Ok(false);
        }
    }
    Ok(true)
}

/// The fields after the name of the program, which may hold blanks.
fn stat(path: PathBuf) -> Result<Vec<String>, Failure> {
    let text = fs::read_to_string(path)?;
    let (_, fields) = text.rsplit_once(')').ok_or("/proc/PID/stat has no name")?;
    Ok(fields.split_whitespace().map(str::to_owned).collect())
}

fn largest_window(display: &Display) -> Result<Option<Window>, Failure> {
    let connection = display.connection();
    let mut largest = None;
    for window in connection.query_tree(display.root())?.reply()?.children {
        // A window may be gone by now.
        let Ok(attributes) = connection.get_window_attributes(window)?.reply() else { continue };
        let Ok(size) = connection.get_geometry(window)?.reply() else { continue };
        if attributes.map_state == MapState::VIEWABLE {
            largest = largest.max(Some((u32::from(size.width) * u32::from(size.height), window)));
        }
    }
    Ok(largest.map(|(_, window)| window))
}
