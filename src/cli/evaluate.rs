//! `bounce-audio evaluate`: how well and how fast the analyzer does on recordings with known truth.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::{Args, ValueEnum};

use super::picture::Target;
use super::{Outcome, limit, output};
use crate::Error;
use crate::analysis::{Settings, analyze_clearest};
use crate::audio;
use crate::evaluate::picture;
use crate::evaluate::reference::Reference;
use crate::evaluate::rows::{Evaluation, Row, Tier};
use crate::evaluate::scores::{FileScore, score};
use crate::evaluate::text::to_text;
use crate::evaluate::thresholds::Thresholds;
use crate::fit::model_selection::Choice;
use crate::timing::Timing;
use crate::units::real;

/// Measure the analyzer on recordings with known truth.
///
/// Error and speed of every way of timing and every model.
///
/// Each WAV needs a .truth.json of synth beside it, or an Audacity label track NAME.txt with every impact that can be
/// heard. Exit status: 0 done, 1 a threshold of --check is missed, 2 it could not be done.
#[derive(Debug, Args)]
#[command(after_help = "Example:
  bounce-audio synth --suite suite && bounce-audio evaluate suite")]
pub(super) struct Arguments {
    /// A folder of recordings
    folder: PathBuf,
    /// Form of the result
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// Draw error against speed into this picture
    #[arg(long, value_name = "OUT.svg|png")]
    plot: Option<PathBuf>,
    /// Compare what timing by correlation reaches with these thresholds
    #[arg(long, value_name = "THRESHOLDS.toml")]
    check: Option<PathBuf>,
    /// Make these thresholds stricter where more is reached; never less strict
    #[arg(long, value_name = "THRESHOLDS.toml", conflicts_with = "check")]
    tighten: Option<PathBuf>,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Format {
    Text,
    Json,
}

/// Every way of timing, from fastest to most exact, with the model that the recording supports; then every model of the
/// intervals with the most exact times.
const WAYS: [Way; 7] = [
    ("envelope", Timing::Envelope, "auto", Choice::Auto),
    ("fraction", Timing::Fraction, "auto", Choice::Auto),
    HELD,
    (
        "correlation",
        Timing::Correlation,
        "constant",
        Choice::Constant,
    ),
    (
        "correlation",
        Timing::Correlation,
        "contact",
        Choice::Contact,
    ),
    ("correlation", Timing::Correlation, "drag", Choice::Drag),
    ("correlation", Timing::Correlation, "speed", Choice::Speed),
];
/// The way that thresholds hold: what a user gets who asks for nothing else.
const HELD: Way = ("correlation", Timing::Correlation, "auto", Choice::Auto);

/// Timing and model, with their names.
type Way = (&'static str, Timing, &'static str, Choice);

pub(super) fn run(arguments: &Arguments) -> Result<Outcome, Error> {
    let target = arguments.plot.as_deref().map(Target::new).transpose()?;
    let files = recordings(&arguments.folder)?;
    let mut tiers = WAYS.map(|(timing, _, model, _)| Tier {
        timing: timing.to_owned(),
        model: model.to_owned(),
        files: Vec::new(),
    });
    let (mut audio_s, mut limit_s) = (0.0, 0.0);
    for (path, reference) in &files {
        // This also brings the file into the cache, so that every tier finds it warm.
        limit_s += limit::read_and_sum_s(path)?;
        for (tier, (_, timing, _, model)) in tiers.iter_mut().zip(WAYS) {
            let score = listen(path, reference, timing, model).map_err(|e| e.in_file(path))?;
            tier.files.push(score);
        }
        audio_s += tiers[0].files.last().map_or(0.0, |f| f.audio_s);
    }
    let evaluation = Evaluation::of(&tiers, (limit_s > 0.0).then(|| audio_s / limit_s));
    let mut output = match arguments.format {
        Format::Text => to_text(&evaluation),
        Format::Json => evaluation.to_json().map_err(std::io::Error::from)?,
    };
    if let Some(target) = target {
        target.draw(&picture::figure(&evaluation))?;
    }
    let complaints = hold(arguments, &evaluation)?;
    if matches!(arguments.format, Format::Text) {
        output.extend(complaints.iter().map(|c| format!("missed: {c}\n")));
    }
    Ok(Outcome {
        status: u8::from(!complaints.is_empty()),
        ..Outcome::of(output)
    })
}

/// Recordings with truth, by name.
fn recordings(folder: &Path) -> Result<Vec<(PathBuf, Reference)>, Error> {
    let in_folder = |e: std::io::Error| Error::from(e).in_file(folder);
    let mut paths = Vec::new();
    for entry in fs::read_dir(folder).map_err(in_folder)? {
        let path = entry.map_err(in_folder)?.path();
        if audio::has_ending(&path) {
            paths.push(path);
        }
    }
    paths.sort();
    let mut found = Vec::new();
    for path in paths {
        if let Some(reference) = reference(&path)? {
            found.push((path, reference));
        }
    }
    if found.is_empty() {
        let problem = Error::Argument {
            argument: "folder",
            got: "without recordings that have a truth".to_owned(),
            expected: "NAME.wav with NAME.truth.json or NAME.txt",
        };
        return Err(problem.in_file(folder));
    }
    Ok(found)
}

fn reference(path: &Path) -> Result<Option<Reference>, Error> {
    let (truth, labels) = (
        path.with_extension("truth.json"),
        path.with_extension("txt"),
    );
    let text = |path: &Path| fs::read_to_string(path).map_err(|e| Error::from(e).in_file(path));
    if truth.is_file() {
        let reference = Reference::from_json(&text(&truth)?);
        return reference.map(Some).map_err(|e| e.in_file(&truth));
    }
    if !labels.is_file() {
        return Ok(None);
    }
    let mut reference = Reference::from_labels(&text(&labels)?).map_err(|e| e.in_file(&labels))?;
    let stem = path.file_stem().unwrap_or_default();
    reference.scene = stem.to_string_lossy().into_owned();
    Ok(Some(reference))
}

fn listen(
    path: &Path,
    reference: &Reference,
    timing: Timing,
    model: Choice,
) -> Result<FileScore, Error> {
    let settings = Settings {
        timing,
        model,
        ..Settings::default()
    };
    let start = Instant::now();
    let recording = audio::read_file(path)?;
    let rate = f64::from(recording.sample_rate_hz);
    let (_, analysis) = analyze_clearest(&recording.channels, rate, &settings)?;
    let elapsed_s = start.elapsed().as_secs_f64();
    let audio_s = real(recording.channels.first().map_or(0, Vec::len)) / rate;
    Ok(score(&analysis, reference, audio_s, elapsed_s))
}

/// What falls short of the thresholds to check; or makes them stricter.
fn hold(arguments: &Arguments, evaluation: &Evaluation) -> Result<Vec<String>, Error> {
    let (timing, _, model, _) = HELD;
    let held = || {
        let rows = evaluation.rows.iter().chain(&evaluation.scenes);
        rows.filter(|r: &&Row| r.timing == timing && r.model == model)
    };
    let read = |path: &PathBuf| -> Result<Thresholds, Error> {
        let text = fs::read_to_string(path).map_err(|e| Error::from(e).in_file(path))?;
        Thresholds::from_toml(&text).map_err(|e| e.in_file(path))
    };
    if let Some(path) = &arguments.tighten {
        let old = if path.is_file() {
            read(path)?
        } else {
            Thresholds::default()
        };
        // What is there was read as thresholds, so it begins as it may.
        output::write(path, b"", old.tightened(held()).as_bytes())?;
    }
    match &arguments.check {
        Some(path) => Ok(read(path)?.complaints(held())),
        None => Ok(Vec::new()),
    }
}
