//! `bounce-audio listen`: drops told while they are played.

mod recorder;
mod said;
mod samples;
mod saved;

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::builder::TypedValueParser;
use clap::error::ErrorKind;
use clap::{Arg, Args, Command, ValueEnum};

use super::Outcome;
use super::known::Known;
use super::listen::{by_option, channel, name};
use super::meant::quoted;
use crate::Error;
use crate::analysis::Live;
use crate::recording::Channel;
use said::Said;
use samples::{Coding, Samples};
use saved::Saved;

/// Listen while the ball bounces: each drop is told within a second of its last impact.
///
/// A recorder is started (pw-record, parecord, arecord, rec or ffmpeg, the first that is there), or a command of your own
/// with --from, or a pipe is read. On a terminal a line shows the level. Ctrl-C ends it.
///
/// Exit status: 0 a drop was heard, 1 none was heard, 2 it could not be done.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  bounce-audio listen
  bounce-audio listen --height 30.5cm --save drops
  bounce-audio listen --from 'arecord -q -D hw:1 -t wav -f S16_LE -r 48000'
  some-recorder | bounce-audio listen - --raw s16le --rate 44100
  bounce-audio listen --format ndjson | while read -r drop; do …; done")]
pub(super) struct Arguments {
    /// - for standard input: a recording, or bare samples with --raw. Without it a recorder is started
    #[arg(value_name = "-", value_parser = Pipe)]
    input: Option<String>,
    /// Start this command and listen to what it writes: a recording, or bare samples with --raw
    #[arg(long, value_name = "COMMAND", conflicts_with = "input")]
    from: Option<String>,
    /// The input is bare samples, of all channels in turn
    #[arg(long, value_enum, value_name = "FORM")]
    raw: Option<Coding>,
    /// Samples per second of each channel, with --raw
    #[arg(
        long,
        value_name = "HZ",
        default_value_t = 48_000,
        requires = "raw",
        allow_hyphen_values = true
    )]
    rate: u32,
    /// Number of channels, with --raw
    #[arg(long, value_name = "N", default_value_t = 1, requires = "raw", value_parser = clap::value_parser!(u16).range(1..), allow_hyphen_values = true)]
    channels: u16,
    #[command(flatten)]
    known: Known,
    /// Which channel to listen to: best (the one in which impacts stand out most) or its number from 1
    #[arg(long, value_parser = channel, default_value = "best", value_name = "best|N", allow_hyphen_values = true)]
    channel: Channel,
    /// Form of the lines
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// Keep the sound of each drop as WAV in this folder, with its impacts as labels
    #[arg(long, value_name = "FOLDER", conflicts_with = "time_scale")]
    save: Option<PathBuf>,
}

/// `-` and nothing else: a file was recorded before, and another command is for it.
#[derive(Debug, Clone, Copy)]
struct Pipe;

impl TypedValueParser for Pipe {
    type Value = String;

    fn parse_ref(
        &self,
        command: &Command,
        _: Option<&Arg>,
        value: &OsStr,
    ) -> Result<String, clap::Error> {
        let given = name(Path::new(value));
        if given == "-" {
            return Ok(given);
        }
        let said = format!(
            "listen hears a recorder, which it starts, or a pipe, which is -. To read a file: bounce-audio analyze {}\n",
            quoted(&[given])
        );
        Err(clap::Error::raw(ErrorKind::ValueValidation, said).with_cmd(command))
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    /// For a person: e of each drop, and the mean of all so far
    Text,
    /// For programs: a line of JSON for each drop, with its number; one of which more was heard comes again
    Ndjson,
}

pub(super) fn run(arguments: &Arguments) -> Result<Outcome, Error> {
    arguments.known.settings().check()?;
    let stop = stopped_by_ctrl_c();
    listen_to(Samples::open(arguments)?, arguments, &stop)
}

/// Listens to samples until they end, fail, or are stopped; what was heard until then is told in each case.
fn listen_to(
    mut samples: Samples,
    arguments: &Arguments,
    stop: &AtomicBool,
) -> Result<Outcome, Error> {
    let heard = arguments
        .channel
        .of(samples.channels())
        .map_err(by_option)?;
    let settings = arguments.known.settings();
    let mut live = Live::new(heard.len(), samples.rate_hz(), &settings).map_err(by_option)?;
    let mut said = Said::new(arguments.format, heard.start);
    let saved = arguments.save.as_deref();
    let mut saved = saved
        .map(|folder| Saved::into(folder, samples.rate_hz()))
        .transpose()?;
    let mut block = vec![Vec::new(); samples.channels()];
    let mut failed = None;
    loop {
        block.iter_mut().for_each(Vec::clear);
        let read = samples.append(&mut block);
        let block = &block[heard.clone()];
        let mut told = live.hear(block)?;
        let goes_on = read.as_ref().is_ok_and(|more| *more) && !stop.load(Ordering::Relaxed);
        failed = failed.or(read.err());
        if !goes_on {
            told.extend(live.finish()?);
        }
        if let Some(saved) = &mut saved {
            saved.keep(&told, &live, !goes_on)?;
        }
        for told in told {
            said.tell(told)?;
        }
        if !goes_on {
            break;
        }
        said.level(block, live.hears());
    }
    Ok(said.outcome(samples.end(failed, stop.load(Ordering::Relaxed))))
}

/// What Ctrl-C sets, in place of ending the program: the drops heard so far are told.
fn stopped_by_ctrl_c() -> Arc<AtomicBool> {
    let stop = Arc::new(AtomicBool::new(false));
    let set = Arc::clone(&stop);
    // Where no handler can be set Ctrl-C ends the program as it does everywhere.
    ctrlc::set_handler(move || {
        // The first ends with what was heard; a second one at once, as where nothing comes any more.
        if set.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
    })
    .ok();
    stop
}

#[cfg(test)]
mod tests {
    use std::io::{self, Cursor, Read};

    use clap::Parser;

    use super::*;
    use crate::synth::{presets::preset, render};
    use crate::units::samples_in;

    /// A command line of this command alone.
    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        arguments: Arguments,
    }

    /// A device that is pulled out.
    struct Gone;

    impl Read for Gone {
        fn read(&mut self, _: &mut [u8]) -> io::Result<usize> {
            Err(io::Error::other("device is gone"))
        }
    }

    #[test]
    fn a_device_that_is_pulled_out_loses_no_drop() {
        let made = render(&preset("pingpong").unwrap(), 1).unwrap();
        let last_s = made.truth.drops[0].impacts_s.last().unwrap();
        let rate = f64::from(made.truth.sample_rate_hz);
        // Silence in the other channel, and the end soon after the last impact: before the drop would be told.
        let heard = &made.samples[..samples_in(last_s + 0.1, rate)];
        let frames = heard.iter().flat_map(|x| [0.0_f32, *x]);
        let bytes: Vec<u8> = frames.flat_map(f32::to_le_bytes).collect();
        let rate = made.truth.sample_rate_hz.to_string();
        let words = [
            "-",
            "-",
            "--raw",
            "f32le",
            "--channels",
            "2",
            "--channel",
            "2",
            "--rate",
            &rate,
        ];
        let arguments = Line::parse_from(words).arguments;
        let source = Box::new(Cursor::new(bytes).chain(Gone));
        let samples = Samples::of(source, &arguments).unwrap();
        let outcome = listen_to(samples, &arguments, &AtomicBool::new(false)).unwrap();
        assert_eq!(
            (outcome.note.as_str(), outcome.status),
            (
                "bounce-audio: 1 drop was heard; standard input: device is gone\n",
                2
            )
        );
    }
}
