//! Manual pages from the description of the command line.

use std::io;

use clap::Command;
use clap_mangen::Man;
use clap_mangen::roff::{Roff, roman};

/// The files: a page for the program and one for each of its commands.
///
/// # Errors
/// None but those of memory.
pub(crate) fn pages(mut program: Command) -> io::Result<Vec<(String, Vec<u8>)>> {
    // Only then do commands know the name of the program.
    program.build();
    let of_commands = program.get_subcommands().filter(|c| c.get_name() != "help");
    let all: Vec<Command> = of_commands.chain([&program]).cloned().collect();
    all.into_iter().map(page).collect()
}

fn page(command: Command) -> io::Result<(String, Vec<u8>)> {
    let examples = command.get_after_help().map(ToString::to_string);
    let man = Man::new(command.disable_help_subcommand(true))
        .manual("bounce-audio")
        .date("");
    let mut page = Vec::new();
    man.render_title(&mut page)?;
    man.render_name_section(&mut page)?;
    man.render_synopsis_section(&mut page)?;
    man.render_description_section(&mut page)?;
    man.render_options_section(&mut page)?;
    if man.get_filename() == "bounce-audio.1" {
        man.render_subcommands_section(&mut page)?;
    }
    if let Some(examples) = examples {
        as_it_is(&examples).to_writer(&mut page)?;
    }
    Ok((man.get_filename(), page))
}

/// What stands under `Examples:` in the help, its lines as they are there.
fn as_it_is(help: &str) -> Roff {
    let mut section = Roff::new();
    section.control("SH", ["EXAMPLES"]).control("nf", []);
    let lines = help.lines().skip_while(|line| *line == "Examples:");
    section.text(
        lines
            .flat_map(|line| [roman(line.to_owned()), roman("\n")])
            .collect::<Vec<_>>(),
    );
    section.control("fi", []);
    section
}
