//! `bounce-audio completions`: what a shell needs to complete commands and options.

use clap::{Args, CommandFactory};
use clap_complete::{Shell, generate};

use super::Outcome;
use crate::Error;

/// Print what a shell needs to complete commands and options.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  bounce-audio completions bash > ~/.local/share/bash-completion/completions/bounce-audio
  bounce-audio completions zsh > ~/.zfunc/_bounce-audio     (a folder in $fpath)
  bounce-audio completions fish > ~/.config/fish/completions/bounce-audio.fish
  bounce-audio completions powershell >> $PROFILE")]
pub(super) struct Arguments {
    /// The shell
    shell: Shell,
}

pub(super) fn run(arguments: &Arguments) -> Result<Outcome, Error> {
    let mut command = super::Arguments::command();
    let mut script = Vec::new();
    generate(arguments.shell, &mut command, "bounce-audio", &mut script);
    let output = String::from_utf8(script).map_err(std::io::Error::other)?;
    Ok(Outcome::of(output))
}
