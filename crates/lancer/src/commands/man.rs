//! `lancer man`: the manual page, of the program and all of its subcommands in one.

use crate::args::Args;
use crate::error::Error;
use crate::terminal;
use clap::{Command, CommandFactory};
use clap_mangen::Man;
use std::io;

/// Prints the page, as roff.
///
/// # Errors
/// Standard output cannot be written.
pub(crate) fn run() -> Result<(), Error> {
    let page = page().expect("memory can be written");
    terminal::print(page)
}

fn page() -> io::Result<Vec<u8>> {
    let mut program = Args::command().disable_help_subcommand(true);
    program.build();
    let mut page = Vec::new();
    let man = Man::new(program.clone());
    man.render_title(&mut page)?;
    man.render_name_section(&mut page)?;
    man.render_synopsis_section(&mut page)?;
    man.render_description_section(&mut page)?;
    man.render_options_section(&mut page)?;
    for command in program.get_subcommands() {
        subcommand(command, &mut page)?;
    }
    man.render_extra_section(&mut page)?;
    man.render_version_section(&mut page)?;
    Ok(page)
}

/// A subcommand as a section of the program's page: its own sections become parts of it.
fn subcommand(command: &Command, page: &mut Vec<u8>) -> io::Result<()> {
    let man = Man::new(command.clone());
    let mut sections = Vec::new();
    man.render_synopsis_section(&mut sections)?;
    man.render_description_section(&mut sections)?;
    man.render_options_section(&mut sections)?;
    let sections = String::from_utf8_lossy(&sections).replace("\n.SH ", "\n.SS ");
    let heading = command.get_name().to_uppercase();
    page.extend_from_slice(format!(".SH \"LANCER {heading}\"\n{sections}").as_bytes());
    Ok(())
}
