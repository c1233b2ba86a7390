//! What a program has put on the clipboard, as another program that pastes it gets it.
//!
//! Source: the Inter-Client Communication Conventions Manual, section 2, of which data in one piece.

use crate::{Display, Failure, wait_for};
use x11rb::connection::Connection;
use x11rb::protocol::Event;
use x11rb::protocol::xproto::{AtomEnum, ConnectionExt, CreateWindowAux, WindowClass};
use x11rb::rust_connection::RustConnection;

x11rb::atom_manager! {
    Atoms: AtomsCookie {
        CLIPBOARD,
        INCR,
        PASTED,
    }
}

impl Display {
    /// What is on the clipboard, in a form such as `image/png`; none where nothing is, or not in this form.
    ///
    /// # Errors
    /// The server is gone, its owner does not answer, or it sends in pieces, which is for more than some 200 kB.
    pub fn clipboard(&self, form: &str) -> Result<Option<Vec<u8>>, Failure> {
        let (connection, _) = RustConnection::connect(Some(self.name()))?;
        let atoms = Atoms::new(&connection)?.reply()?;
        let form = connection.intern_atom(false, form.as_bytes())?.reply()?.atom;
        let reader = connection.generate_id()?;
        let (depth, visual, border) = (x11rb::COPY_DEPTH_FROM_PARENT, x11rb::COPY_FROM_PARENT, 0);
        let class = WindowClass::INPUT_OUTPUT;
        let plain = CreateWindowAux::new();
        connection.create_window(depth, reader, self.root(), 0, 0, 1, 1, border, class, visual, &plain)?;
        connection.convert_selection(reader, atoms.CLIPBOARD, form, atoms.PASTED, x11rb::CURRENT_TIME)?;
        connection.flush()?;
        let property = wait_for("the owner of the clipboard", || match connection.poll_for_event()? {
            Some(Event::SelectionNotify(answer)) => Ok(Some(answer.property)),
            _ => Ok(None),
        })?;
        if property == x11rb::NONE {
            return Ok(None);
        }
        let pasted =
            connection.get_property(true, reader, property, AtomEnum::ANY, 0, u32::MAX / 4)?.reply()?;
        if pasted.type_ == atoms.INCR {
            return Err("what is on the clipboard is sent in pieces".into());
        }
        Ok(Some(pasted.value))
    }
}
