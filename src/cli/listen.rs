//! What `analyze` and `batch` share: how to listen, and one recording to its report.

use std::path::Path;

use clap::Args;

use super::known::{Known, Word, one_of};
use super::quantity::time;
use crate::Error;
use crate::analysis::ALL_CHANNELS;
use crate::audio::{Stream, Track};
use crate::recording::{Channel, Request};
use crate::report::Report;
use crate::timing::Timing;
use crate::workers::Workers;

/// What is known beforehand and how to listen.
#[derive(Debug, Clone, Args)]
pub(super) struct Listening {
    #[command(flatten)]
    pub known: Known,
    /// Which channel to listen to: best (the one in which impacts stand out most) or its number from 1
    #[arg(
        long,
        value_parser = channel,
        default_value = "best",
        value_name = "best|N",
        allow_hyphen_values = true
    )]
    channel: Channel,
    /// Which track of sound to listen to, of a file with several (the first that has sound): its number from 1
    #[arg(long, value_name = "N", value_parser = track, allow_hyphen_values = true)]
    track: Option<Track>,
    /// Listen from here: 2s, 1.5, 2min, 1:30
    #[arg(long, value_parser = time, allow_hyphen_values = true)]
    start: Option<f64>,
    /// Listen up to here
    #[arg(long, value_parser = time, allow_hyphen_values = true)]
    end: Option<f64>,
    /// How impacts are timed, from fastest to most exact
    #[arg(long, default_value = "auto", value_parser = one_of(&TIMINGS))]
    timing: Timing,
}

pub(super) fn channel(text: &str) -> Result<Channel, String> {
    match text.parse() {
        _ if text == "best" => Ok(Channel::Best),
        Ok(number) if number > 0 => Ok(Channel::Number(number)),
        _ => Err("expected best or a number from 1".to_owned()),
    }
}

fn track(text: &str) -> Result<Track, String> {
    match text.parse() {
        Ok(number) if number > 0 => Ok(Track::Number(number)),
        _ => Err("expected a number from 1".to_owned()),
    }
}

const TIMINGS: [Word<Timing>; 4] = [
    (
        "auto",
        Timing::Correlation,
        "The most exact that the recording allows",
    ),
    (
        Timing::Envelope.word(),
        Timing::Envelope,
        "The detector's grid, a quarter of a millisecond",
    ),
    (
        Timing::Fraction.word(),
        Timing::Fraction,
        "A fixed fraction of each impact's rise",
    ),
    (
        Timing::Correlation.word(),
        Timing::Correlation,
        "Correlation with the mean impact",
    ),
];

impl Listening {
    /// The track that is listened to.
    pub(super) fn track(&self) -> Track {
        self.track.unwrap_or_default()
    }

    /// What the library is asked.
    pub(super) fn request(&self) -> Request<'static> {
        let settings = self
            .known
            .settings()
            .start_s(self.start)
            .end_s(self.end)
            .timing(self.timing);
        Request {
            settings,
            channel: self.channel,
            ..Request::default()
        }
    }
}

/// The report of a track of a file.
pub(super) fn listen_to_file(
    path: &Path,
    track: Track,
    request: &Request<'_>,
    workers: Workers,
) -> Result<Report, Error> {
    let stream = Stream::open_file_track(path, track)?;
    let report = request.listen_by(stream, &name(path), workers);
    report.map_err(|e| by_option(e).in_file(path))
}

/// Names the option where the library, whose users have none, names what it sets.
pub(super) fn by_option(error: Error) -> Error {
    match error {
        Error::Argument {
            argument: "channel",
            got,
            expected,
        } => Error::Argument {
            argument: "--channel",
            got,
            expected,
        },
        Error::Argument {
            argument: ALL_CHANNELS,
            got,
            ..
        } => Error::Argument {
            argument: ALL_CHANNELS,
            got,
            expected: "1536000 Hz or less: listen to one of them with --channel, or resample it",
        },
        other => other,
    }
}

/// The name of a file in a document: as it is, but for bytes that are no UTF-8, which are written as `\xFF`.
///
/// A replacement character would give two files one name.
pub(super) fn name(path: &Path) -> String {
    let mut name = String::new();
    for chunk in path.as_os_str().as_encoded_bytes().utf8_chunks() {
        name += chunk.valid();
        for byte in chunk.invalid() {
            name += &format!("\\x{byte:02X}");
        }
    }
    name
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn names_that_are_no_text_stay_apart() {
        use std::ffi::OsStr;
        use std::os::unix::ffi::OsStrExt;
        for (bytes, shown) in [
            (&b"a b,\n.wav"[..], "a b,\n.wav"),
            (b"h\xE9.wav", "h\\xE9.wav"),
            (b"h\xE8.wav", "h\\xE8.wav"),
            ("hé.wav".as_bytes(), "hé.wav"),
        ] {
            assert_eq!(name(Path::new(OsStr::from_bytes(bytes))), shown);
        }
    }
}
