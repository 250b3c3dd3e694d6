//! `bounce-audio synth`: a recording made from the model, with its truth beside it.

use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use clap::Args;

use super::Outcome;
use crate::Error;
use crate::synth::{Synthetic, render, scene};

/// Make a recording of a bouncing ball from the model, and a .truth.json with its true impact times.
#[derive(Debug, Args)]
#[command(after_help = "Example:
  bounce-audio synth --preset pingpong -o pingpong.wav")]
pub(super) struct Arguments {
    /// What to make: steel, pingpong, rubber, dead; or without a ball: silence, noise, tone, babble
    #[arg(long)]
    preset: String,
    /// Seed of the random numbers: the same seed makes the same recording
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// The WAV file to write; NAME.truth.json is written beside it
    #[arg(short, long, value_name = "OUT.wav")]
    output: PathBuf,
}

pub(super) fn run(arguments: &Arguments) -> Result<Outcome, Error> {
    let made = render(&scene::preset(&arguments.preset)?, arguments.seed)?;
    let truth_path = arguments.output.with_extension("truth.json");
    write_wav(&arguments.output, &made).map_err(|e| e.in_file(&arguments.output))?;
    let truth = serde_json::to_string_pretty(&made.truth).map_err(io::Error::from)? + "\n";
    fs::write(&truth_path, truth).map_err(|e| Error::from(e).in_file(&truth_path))?;
    let impacts: usize = made.truth.drops.iter().map(|d| d.impacts_s.len()).sum();
    let output = format!(
        "{}: {:.1} s, drops: {}, impacts: {impacts}\n{}: their true times\n",
        arguments.output.display(),
        crate::units::real(made.samples.len()) / f64::from(made.truth.sample_rate_hz),
        made.truth.drops.len(),
        truth_path.display(),
    );
    Ok(Outcome { output, status: 0 })
}

fn write_wav(path: &Path, made: &Synthetic) -> Result<(), Error> {
    let spec = hound::WavSpec {
        channels: 1,
        sample_rate: made.truth.sample_rate_hz,
        bits_per_sample: 16,
        sample_format: hound::SampleFormat::Int,
    };
    let mut writer = hound::WavWriter::create(path, spec).map_err(from_hound)?;
    for &x in &made.samples {
        #[expect(clippy::cast_possible_truncation, reason = "samples lie in ±1")]
        writer
            .write_sample((f64::from(x) * 32_767.0).round() as i16)
            .map_err(from_hound)?;
    }
    writer.finalize().map_err(from_hound)
}

fn from_hound(error: hound::Error) -> Error {
    match error {
        hound::Error::IoError(e) => e.into(),
        other => io::Error::new(ErrorKind::InvalidData, other.to_string()).into(),
    }
}
