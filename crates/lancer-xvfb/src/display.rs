//! The X server, and the connection through which it is looked at.

use crate::{Area, Failure, Picture};
use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use x11rb::connection::Connection;
use x11rb::protocol::xproto::{ConnectionExt, ImageFormat, ImageOrder, Window};
use x11rb::rust_connection::RustConnection;

/// A display that nobody sees. It ends when this value is dropped, and by itself when its last client is gone.
pub struct Display {
    server: Child,
    name: String,
    connection: RustConnection,
    root: Window,
    width: u16,
    height: u16,
}

/// The programs that a display needs and this machine does not have.
pub fn missing_tools() -> Vec<&'static str> {
    let runs = |tool: &str| {
        let run = Command::new(tool).arg("-help").stdout(Stdio::null()).stderr(Stdio::null()).status();
        run.is_ok()
    };
    ["Xvfb", "xdotool"].into_iter().filter(|tool| !runs(tool)).collect()
}

impl Display {
    /// Starts a server with one screen of this size in pixels, under a name that is free.
    ///
    /// # Errors
    /// There is no Xvfb, or it does not start.
    pub fn start(width: u16, height: u16) -> Result<Self, Failure> {
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-nolisten", "tcp", "-terminate"])
            .args(["-screen", "0", &format!("{width}x{height}x24")])
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .map_err(|error| format!("Xvfb does not start: {error}"))?;
        match connect(&mut server) {
            Ok((name, connection, root)) => Ok(Self { server, name, connection, root, width, height }),
            Err(error) => {
                end(&mut server);
                Err(error)
            }
        }
    }

    /// What programs find in `DISPLAY`.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Width and height in pixels.
    pub fn size(&self) -> (u16, u16) {
        (self.width, self.height)
    }

    /// All of it.
    pub fn area(&self) -> Area {
        Area { x: 0, y: 0, width: self.width, height: self.height }
    }

    /// What is seen on it.
    ///
    /// # Errors
    /// The server is gone.
    pub fn picture(&self) -> Result<Picture, Failure> {
        self.picture_of(self.area())
    }

    /// What is seen on a part of it, which must lie inside.
    ///
    /// # Errors
    /// The server is gone, or the part lies outside.
    pub fn picture_of(&self, area: Area) -> Result<Picture, Failure> {
        let Area { x, y, width, height } = area;
        let (x, y) = (i16::try_from(x)?, i16::try_from(y)?);
        let all_planes = !0;
        let image =
            self.connection.get_image(ImageFormat::Z_PIXMAP, self.root, x, y, width, height, all_planes)?;
        let data = image.reply()?.data;
        let blue_first = self.connection.setup().image_byte_order == ImageOrder::LSB_FIRST;
        Ok(Picture::from_words(width, height, &data, blue_first))
    }

    pub(crate) fn connection(&self) -> &RustConnection {
        &self.connection
    }

    pub(crate) fn root(&self) -> Window {
        self.root
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        end(&mut self.server);
    }
}

fn connect(server: &mut Child) -> Result<(String, RustConnection, Window), Failure> {
    let stdout = server.stdout.take().ok_or("Xvfb has no standard output")?;
    let mut number = String::new();
    BufReader::new(stdout).read_line(&mut number)?;
    let number = number.trim().parse::<u32>().map_err(|_| "Xvfb ended before it had a display")?;
    let name = format!(":{number}");
    let (connection, screen) = RustConnection::connect(Some(&name))?;
    let root = connection.setup().roots[screen].root;
    Ok((name, connection, root))
}

/// Ends a child now; one that has ended by itself is fine.
fn end(child: &mut Child) {
    let _ = child.kill();
    let _ = child.wait();
}

#[cfg(test)]
mod tests {
    use super::*;
    use x11rb::protocol::xproto::{CreateWindowAux, WindowClass};
    use x11rb::wrapper::ConnectionExt as _;

    #[test]
    fn a_painted_window_is_in_the_picture_and_nothing_else() {
        let display = Display::start(64, 48).unwrap();
        let connection = &display.connection;
        let window = connection.generate_id().unwrap();
        let orange = CreateWindowAux::new().background_pixel(0xff_80_10);
        let (depth, visual, border) = (x11rb::COPY_DEPTH_FROM_PARENT, x11rb::COPY_FROM_PARENT, 0);
        connection
            .create_window(
                depth,
                window,
                display.root,
                10,
                20,
                5,
                6,
                border,
                WindowClass::INPUT_OUTPUT,
                visual,
                &orange,
            )
            .unwrap();
        connection.map_window(window).unwrap();
        connection.sync().unwrap();

        let picture = display.picture().unwrap();
        for y in 0..48 {
            for x in 0..64 {
                let inside = (10..15).contains(&x) && (20..26).contains(&y);
                assert_eq!(picture.pixel(x, y), if inside { [255, 128, 16] } else { [0; 3] }, "{x}, {y}");
            }
        }
        let part = display.picture_of(Area { x: 10, y: 20, width: 5, height: 6 }).unwrap();
        assert_eq!(part.colours(), 1);
    }
}
