//! Mouse and keyboard, moved by xdotool.

use crate::{Display, Failure};
use std::process::{Command, Stdio};
use x11rb::connection::Connection;
use x11rb::protocol::xproto::ConnectionExt;

/// What can be pressed on the mouse, as X counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Button {
    /// Under the first finger of a right hand.
    Left = 1,
    /// The wheel, pressed.
    Middle = 2,
    /// Under the second finger.
    Right = 3,
    /// A step of the wheel, away from the person.
    WheelUp = 4,
    /// A step of the wheel, towards the person.
    WheelDown = 5,
}

impl Display {
    /// Presses and releases keys together, as in `ctrl+k`, one such chord after another.
    ///
    /// # Errors
    /// xdotool fails.
    pub fn keys(&self, chords: &[&str]) -> Result<(), Failure> {
        self.xdotool(&[&["key"], chords].concat())
    }

    /// Types a text, of plain letters.
    ///
    /// # Errors
    /// xdotool fails.
    pub fn text(&self, text: &str) -> Result<(), Failure> {
        self.xdotool(&["type", "--delay", "5", "--", text])
    }

    /// Moves the pointer to a pixel.
    ///
    /// # Errors
    /// xdotool fails.
    pub fn move_to(&self, (x, y): (i32, i32)) -> Result<(), Failure> {
        self.xdotool(&["mousemove", &x.to_string(), &y.to_string()])
    }

    /// Presses a button.
    ///
    /// # Errors
    /// xdotool fails.
    pub fn press(&self, button: Button) -> Result<(), Failure> {
        self.xdotool(&["mousedown", &(button as u8).to_string()])
    }

    /// Lets a button go.
    ///
    /// # Errors
    /// xdotool fails.
    pub fn release(&self, button: Button) -> Result<(), Failure> {
        self.xdotool(&["mouseup", &(button as u8).to_string()])
    }

    /// Presses a button and lets it go, at a pixel.
    ///
    /// # Errors
    /// xdotool fails.
    pub fn click(&self, at: (i32, i32), button: Button) -> Result<(), Failure> {
        self.move_to(at)?;
        self.xdotool(&["click", &(button as u8).to_string()])
    }

    /// Moves the pointer to a pixel without another program in between: for what measures time.
    ///
    /// # Errors
    /// The server is gone.
    pub fn warp_to(&self, (x, y): (i32, i32)) -> Result<(), Failure> {
        let (x, y) = (i16::try_from(x)?, i16::try_from(y)?);
        self.connection().warp_pointer(x11rb::NONE, self.root(), 0, 0, 0, 0, x, y)?;
        Ok(self.connection().flush()?)
    }

    fn xdotool(&self, arguments: &[&str]) -> Result<(), Failure> {
        let run = Command::new("xdotool")
            .args(arguments)
            .env("DISPLAY", self.name())
            .stdin(Stdio::null())
            .output()
            .map_err(|error| format!("xdotool does not start: {error}"))?;
        match run.status.success() {
            true => Ok(()),
            false => Err(format!("xdotool {arguments:?}: {}", String::from_utf8_lossy(&run.stderr)).into()),
        }
    }
}
