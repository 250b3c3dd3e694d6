//! `bounce-audio synth`: recordings made from the model, with their truth beside them.

use std::fs::{self, File};
use std::io::{self, Seek, Write};
use std::path::{Path, PathBuf};

use clap::Args;

use super::Outcome;
use super::output::Whole;
use crate::Error;
use crate::audio::{Form, write_wav};
use crate::synth::presets::{self, preset};
use crate::synth::recorder::Encoding;
use crate::synth::scene::Scene;
use crate::synth::{Synthetic, render};
use crate::units::real;

/// Make a recording of a bouncing ball, with its true impact times.
///
/// Beside NAME.wav, NAME.truth.json holds the truth.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  bounce-audio synth --list
  bounce-audio synth --preset pingpong -o pingpong.wav
  bounce-audio synth my-scene.toml --seed 7 -o drop.wav
  bounce-audio synth --suite suite --seeds 3
  bounce-audio synth --suite found --found --seeds 2")]
pub(super) struct Arguments {
    /// A scene as text; those of the presets are in assets/scenes
    #[arg(value_name = "SCENE.toml")]
    scene: Option<PathBuf>,
    /// A scene that comes with the program
    #[arg(long, conflicts_with = "scene")]
    preset: Option<String>,
    /// Seed of the random numbers: the same seed makes the same recording
    #[arg(long, default_value_t = 1, allow_hyphen_values = true)]
    seed: u64,
    /// The WAV file to write; NAME.truth.json is written beside it
    #[arg(short, long, value_name = "OUT.wav")]
    output: Option<PathBuf>,
    /// Say what presets there are
    #[arg(long, conflicts_with_all = ["scene", "preset", "output", "suite"])]
    list: bool,
    /// Make all presets in a folder, each with several seeds
    #[arg(long, value_name = "DIR", conflicts_with_all = ["scene", "preset", "output"])]
    suite: Option<PathBuf>,
    /// How many seeds of each, which differ from scene to scene
    #[arg(
        long,
        default_value_t = 3,
        requires = "suite",
        allow_hyphen_values = true
    )]
    seeds: u64,
    /// Make the scenes of drops that are hard to find instead: odd bounces, few or hundreds, other sounds
    #[arg(long, requires = "suite", conflicts_with_all = ["scene", "preset", "output"])]
    found: bool,
}

pub(super) fn run(arguments: &Arguments) -> Result<Outcome, Error> {
    let output = if arguments.list {
        list()?
    } else if let Some(folder) = &arguments.suite {
        make_suite(folder, arguments)?
    } else {
        make_one(arguments)?
    };
    Ok(Outcome::of(output))
}

fn list() -> Result<String, Error> {
    let mut text = String::new();
    for name in presets::names().chain(presets::found_names()) {
        text += &format!("{name:<16} {}\n", preset(name)?.about);
    }
    Ok(text)
}

fn make_suite(folder: &Path, arguments: &Arguments) -> Result<String, Error> {
    fs::create_dir_all(folder).map_err(|e| Error::from(e).in_file(folder))?;
    let names: Vec<&str> = if arguments.found {
        presets::found_names().collect()
    } else {
        presets::names().collect()
    };
    let mut made = 0;
    for name in &names {
        let scene = preset(name)?;
        for number in 1..=arguments.seeds {
            write(
                &folder.join(format!("{name}-{number}.wav")),
                &render(&scene, presets::seed(name, number))?,
            )?;
            made += 1;
        }
    }
    Ok(format!(
        "{}: {made} recordings of {} scenes\n",
        folder.display(),
        names.len()
    ))
}

fn make_one(arguments: &Arguments) -> Result<String, Error> {
    let path = arguments
        .output
        .as_ref()
        .ok_or_else(|| missing("--output", "a WAV file to write"))?;
    check_ending(path)?;
    let made = render(&scene(arguments)?, arguments.seed)?;
    let truth_path = write(path, &made)?;
    let impacts: usize = made.truth.drops.iter().map(|d| d.impacts_s.len()).sum();
    Ok(format!(
        "{}: {:.1} s, drops: {}, impacts: {impacts}, heard or not\n{}: their true times\n",
        path.display(),
        real(made.samples.len()) / f64::from(made.truth.sample_rate_hz),
        made.truth.drops.len(),
        truth_path.display(),
    ))
}

/// Another ending would have the truth of `NAME.wav` for its own. What cannot be written to anyway says so itself.
fn check_ending(path: &Path) -> Result<(), Error> {
    let ends = path
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("wav"));
    if ends || fs::metadata(path).is_ok_and(|m| !m.is_file()) {
        return Ok(());
    }
    Err(Error::Argument {
        argument: "--output",
        got: format!("'{}'", path.display()),
        expected: "a name that ends in .wav",
    })
}

fn scene(arguments: &Arguments) -> Result<Scene, Error> {
    match (&arguments.scene, &arguments.preset) {
        (Some(path), _) => {
            let text = fs::read_to_string(path).map_err(|e| Error::from(e).in_file(path))?;
            Scene::from_toml(&text).map_err(|e| e.in_file(path))
        }
        (None, Some(name)) => preset(name),
        (None, None) => Err(missing("scene", "a SCENE.toml or --preset NAME")),
    }
}

fn missing(argument: &'static str, expected: &'static str) -> Error {
    Error::Argument {
        argument,
        got: "absent".to_owned(),
        expected,
    }
}

/// Writes a recording and its truth; gives where the truth is.
fn write(path: &Path, made: &Synthetic) -> Result<PathBuf, Error> {
    let truth_path = path.with_extension("truth.json");
    let text = serde_json::to_string_pretty(&made.truth).map_err(io::Error::from)? + "\n";
    if fs::metadata(path).is_ok_and(|m| m.is_file() && m.len() > 0) && !truth_path.exists() {
        let problem = "it is there, without a .truth.json beside it, so it is not one that synth made: choose another \
                       name, or delete it";
        return Err(Error::refused(problem).in_file(path));
    }
    let recording = Whole::fill(path, b"RIFF", |file| write_recording(file, made))?;
    let truth = Whole::fill(&truth_path, b"{", |file| {
        Ok(file.write_all(text.as_bytes())?)
    })?;
    // Interrupted here, a recording may be without truth, but never beside the truth of another.
    truth.clear()?;
    recording.put()?;
    truth.put()?;
    Ok(truth_path)
}

fn write_recording(file: &mut File, made: &Synthetic) -> Result<(), Error> {
    // Asked before anything is written, which could not be taken back.
    if file.stream_position().is_err() {
        let problem = "a recording is written to a file and not to a pipe: its length comes first, and is known last";
        return Err(Error::refused(problem));
    }
    let form = match made.truth.parameters.recorder.encoding {
        Encoding::Float32 => Form::Float32,
        integer => Form::Integer(integer.bits()),
    };
    let more = made.more_channels.iter().map(Vec::as_slice);
    let channels: Vec<&[f32]> = std::iter::once(&*made.samples).chain(more).collect();
    write_wav(file, made.truth.sample_rate_hz, &channels, form)
}
