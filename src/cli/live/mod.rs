//! `bounce-audio listen`: drops told while they are played.

mod recorder;
mod said;
mod samples;
mod saved;

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::{Args, ValueEnum};

use super::Outcome;
use super::known::Known;
use crate::Error;
use crate::analysis::Live;
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
    #[arg(value_name = "-", value_parser = ["-"])]
    input: Option<String>,
    /// Start this command and listen to what it writes: a recording, or bare samples with --raw
    #[arg(long, value_name = "COMMAND", conflicts_with = "input")]
    from: Option<String>,
    /// The input is bare samples, of all channels in turn
    #[arg(long, value_enum, value_name = "FORM")]
    raw: Option<Coding>,
    /// Samples per second of each channel, with --raw
    #[arg(long, value_name = "HZ", default_value_t = 48_000, requires = "raw")]
    rate: u32,
    /// Number of channels, with --raw
    #[arg(long, value_name = "N", default_value_t = 1, requires = "raw", value_parser = clap::value_parser!(u16).range(1..))]
    channels: u16,
    #[command(flatten)]
    known: Known,
    /// Form of the lines
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// Keep the sound of each drop as WAV in this folder, with its impacts as labels
    #[arg(long, value_name = "FOLDER", conflicts_with = "time_scale")]
    save: Option<PathBuf>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    /// For a person: e of each drop, and the mean of all so far
    Text,
    /// For programs: a line of JSON for each drop, with its number; one of which more was heard comes again
    Ndjson,
}

pub(super) fn run(arguments: &Arguments) -> Result<Outcome, Error> {
    let settings = arguments.known.settings();
    settings.check()?;
    let stop = stopped_by_ctrl_c();
    let mut samples = Samples::open(arguments)?;
    let mut live = Live::new(samples.channels(), samples.rate_hz(), &settings)?;
    let mut said = Said::new(arguments.format);
    let mut saved = arguments.save.as_deref().map(Saved::into).transpose()?;
    let mut block = vec![Vec::new(); samples.channels()];
    loop {
        block.iter_mut().for_each(Vec::clear);
        let goes_on = samples.append(&mut block)? && !stop.load(Ordering::Relaxed);
        for told in live.hear(&block)? {
            if let Some(saved) = &mut saved {
                saved.keep(&told, &live, samples.rate_hz())?;
            }
            said.tell(told)?;
        }
        said.level(&block, live.hears());
        if !goes_on {
            break;
        }
    }
    for told in live.finish()? {
        if let Some(saved) = &mut saved {
            saved.keep(&told, &live, samples.rate_hz())?;
        }
        said.tell(told)?;
    }
    samples.end(stop.load(Ordering::Relaxed))?;
    Ok(said.outcome())
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
