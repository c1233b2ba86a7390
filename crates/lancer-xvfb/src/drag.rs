//! A file manager, as far as a window can tell: files dragged over it and dropped.
//!
//! Source: the XDND protocol, version 5, <https://www.freedesktop.org/wiki/Specifications/XDND/>.

use crate::program::Program;
use crate::{Display, Failure, wait_for};
use std::os::unix::ffi::OsStrExt;
use std::path::Path;
use x11rb::connection::Connection;
use x11rb::protocol::Event;
use x11rb::protocol::xproto::{
    Atom, ClientMessageEvent, ConnectionExt, CreateWindowAux, EventMask, PropMode, SELECTION_NOTIFY_EVENT,
    SelectionNotifyEvent, SelectionRequestEvent, Window, WindowClass,
};
use x11rb::rust_connection::RustConnection;
use x11rb::wrapper::ConnectionExt as _;

x11rb::atom_manager! {
    Atoms: AtomsCookie {
        XdndActionCopy,
        XdndDrop,
        XdndEnter,
        XdndFinished,
        XdndPosition,
        XdndSelection,
        XdndStatus,
        UriList: b"text/uri-list",
    }
}

/// Version 5, in the upper byte of its word.
const VERSION: u32 = 5 << 24;

/// Files that hang over a window, held by the mouse.
pub struct FileDrag {
    connection: RustConnection,
    atoms: Atoms,
    source: Window,
    target: Window,
    uris: Vec<u8>,
}

impl FileDrag {
    /// Takes hold of files and drags them over a program's window, to a pixel of the display. Returns when the
    /// window knows which files they are.
    ///
    /// # Errors
    /// The program has no window, or takes no files.
    pub fn over(
        display: &Display,
        program: &Program<'_>,
        files: &[&Path],
        at: (u16, u16),
    ) -> Result<Self, Failure> {
        let target = program.window()?.ok_or("there is no window to drag over")?;
        let (connection, _) = RustConnection::connect(Some(display.name()))?;
        let atoms = Atoms::new(&connection)?.reply()?;
        let source = connection.generate_id()?;
        let (depth, visual, border) = (x11rb::COPY_DEPTH_FROM_PARENT, x11rb::COPY_FROM_PARENT, 0);
        let class = WindowClass::INPUT_OUTPUT;
        let plain = CreateWindowAux::new();
        connection.create_window(depth, source, display.root(), 0, 0, 1, 1, border, class, visual, &plain)?;
        connection.set_selection_owner(source, atoms.XdndSelection, x11rb::CURRENT_TIME)?;
        let uris = files.iter().flat_map(|file| uri(file)).collect();

        let drag = Self { connection, atoms, source, target, uris };
        let place = u32::from(at.0) << 16 | u32::from(at.1);
        drag.say(atoms.XdndEnter, [source, VERSION, atoms.UriList, 0, 0])?;
        drag.say(atoms.XdndPosition, [source, 0, place, x11rb::CURRENT_TIME, atoms.XdndActionCopy])?;
        drag.hand_over()?;
        Ok(drag)
    }

    /// Lets the files go. Returns when the window has taken them.
    ///
    /// # Errors
    /// It does not take them.
    pub fn release(self) -> Result<(), Failure> {
        self.say(self.atoms.XdndDrop, [self.source, 0, x11rb::CURRENT_TIME, 0, 0])?;
        wait_for("the window to take the files", || match self.connection.poll_for_event()? {
            Some(Event::ClientMessage(message)) if message.type_ == self.atoms.XdndFinished => {
                let accepted = message.data.as_data32()[1] & 1 == 1;
                if accepted { Ok(Some(())) } else { Err("the window refused the files".into()) }
            }
            _ => Ok(None),
        })
    }

    /// Answers the window until it accepts the files and has their names.
    fn hand_over(&self) -> Result<(), Failure> {
        let (mut accepted, mut told) = (false, false);
        wait_for("the window to ask for the files", || {
            match self.connection.poll_for_event()? {
                Some(Event::ClientMessage(message)) if message.type_ == self.atoms.XdndStatus => {
                    accepted = message.data.as_data32()[1] & 1 == 1;
                }
                Some(Event::SelectionRequest(request)) => {
                    self.answer(&request)?;
                    told = true;
                }
                _ => (),
            }
            Ok((accepted && told).then_some(()))
        })
    }

    fn answer(&self, request: &SelectionRequestEvent) -> Result<(), Failure> {
        let SelectionRequestEvent { requestor, selection, target, property, time, .. } = *request;
        self.connection.change_property8(PropMode::REPLACE, requestor, property, target, &self.uris)?;
        let done = SelectionNotifyEvent {
            response_type: SELECTION_NOTIFY_EVENT,
            sequence: 0,
            time,
            requestor,
            selection,
            target,
            property,
        };
        self.connection.send_event(false, requestor, EventMask::NO_EVENT, done)?;
        Ok(self.connection.flush()?)
    }

    fn say(&self, message: Atom, data: [u32; 5]) -> Result<(), Failure> {
        let event = ClientMessageEvent::new(32, self.target, message, data);
        self.connection.send_event(false, self.target, EventMask::NO_EVENT, event)?;
        Ok(self.connection.flush()?)
    }
}

/// A line of a list of URIs.
fn uri(file: &Path) -> Vec<u8> {
    let mut line = b"file://".to_vec();
    for &byte in file.as_os_str().as_bytes() {
        match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'/' | b'.' | b'_' | b'~' | b'-' => line.push(byte),
            _ => line.extend(format!("%{byte:02X}").bytes()),
        }
    }
    line.extend(b"\r\n");
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_uri_escapes_what_is_not_plain() {
        let line = uri(Path::new("/home/zoé/my scene%1.yaml"));
        assert_eq!(line, b"file:///home/zo%C3%A9/my%20scene%251.yaml\r\n");
    }
}
