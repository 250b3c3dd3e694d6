//! The recorders that are there, and how each is told to write samples.

use std::path::PathBuf;
use std::process::{Child, Command, Stdio};

use crate::Error;

/// Rate that recorders are asked for, in Hz: all sound cards have it.
pub(super) const RATE_HZ: u32 = 48_000;

/// Recorders in the order in which they are tried, with what makes each write one channel of 16-bit samples.
const RECORDERS: [(&str, &str); 5] = [
    ("pw-record", "--rate 48000 --channels 1 --format s16 -"),
    ("parecord", "--raw --rate=48000 --channels=1 --format=s16le"),
    ("arecord", "-q -t raw -f S16_LE -r 48000 -c 1"),
    ("rec", "-q -t raw -e signed -b 16 -L -r 48000 -c 1 -"),
    ("ffmpeg", FFMPEG),
];

#[cfg(target_os = "macos")]
const FFMPEG: &str = "-v error -f avfoundation -i :default -f s16le -ar 48000 -ac 1 -";
#[cfg(not(target_os = "macos"))]
const FFMPEG: &str = "-v error -f pulse -i default -f s16le -ar 48000 -ac 1 -";

/// Starts the first recorder that is there.
///
/// # Errors
/// [`Error::Refused`] if there is none; [`Error::Io`] if it cannot be started.
pub(super) fn start() -> Result<(Child, String), Error> {
    let there = RECORDERS.iter().find(|(name, _)| is_there(name));
    let Some((name, words)) = there else {
        let names: Vec<&str> = RECORDERS.iter().map(|(name, _)| *name).collect();
        return Err(Error::refused(format!(
            "there is no recorder here: none of {} is found. Install one, or name one with --from 'COMMAND', or pipe \
             samples into bounce-audio listen - --raw s16le --rate 48000",
            names.join(", ")
        )));
    };
    let mut command = Command::new(name);
    command.args(words.split(' '));
    Ok((spawned(&mut command)?, (*name).to_owned()))
}

/// Starts a command of the user's, by the shell.
///
/// # Errors
/// [`Error::Io`] if the shell cannot be started.
pub(super) fn start_command(text: &str) -> Result<Child, Error> {
    let (shell, flag) = if cfg!(windows) {
        ("cmd", "/C")
    } else {
        ("sh", "-c")
    };
    spawned(Command::new(shell).args([flag, text]))
}

fn spawned(command: &mut Command) -> Result<Child, Error> {
    let child = command.stdin(Stdio::null()).stdout(Stdio::piped()).spawn();
    Ok(child?)
}

/// Whether a program is found on the path.
fn is_there(name: &str) -> bool {
    let file = format!("{name}{}", std::env::consts::EXE_SUFFIX);
    let path = std::env::var_os("PATH").unwrap_or_default();
    let mut places = std::env::split_paths(&path).map(|folder: PathBuf| folder.join(&file));
    places.any(|place| place.is_file())
}
