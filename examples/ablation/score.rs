//! One run over the suite.

use std::collections::hash_map::DefaultHasher;
use std::error::Error;
use std::fs;
use std::hash::{Hash, Hasher};
use std::path::{Path, PathBuf};

use bounce_audio::analysis::{Settings, analyze_clearest};
use bounce_audio::evaluate::reference::Reference;
use bounce_audio::evaluate::rows::{Evaluation, Tier};
use bounce_audio::evaluate::scores::{FileScore, score};
use bounce_audio::evaluate::thresholds::Thresholds;
use bounce_audio::random::SplitMix64;
use bounce_audio::synth::{presets, render};

use super::figures::{COLUMNS, Figures};

/// How often scenes are drawn with replacement.
const DRAWS: usize = 100;

/// Analyzes and scores the recordings of a folder.
pub(crate) fn suite(folder: &Path) -> Result<Figures, Box<dyn Error>> {
    let mut paths: Vec<PathBuf> = fs::read_dir(folder)?
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|e| e == "samples"))
        .collect();
    paths.sort();
    let mut documents = Vec::new();
    let mut files = Vec::new();
    for path in &paths {
        let (document, file) = one(path)?;
        documents.push(document);
        files.push(file);
    }
    let text = include_str!("../../fixtures/suite-thresholds.toml");
    let thresholds = Thresholds::from_toml(text)?;
    let evaluation = evaluation(files.clone());
    let rows = evaluation.rows.iter().chain(&evaluation.scenes);
    let complaints = thresholds.complaints(rows);
    for complaint in &complaints {
        eprintln!("{complaint}");
    }
    Ok(Figures {
        documents,
        missed: complaints.len(),
        cpu_s: cpu_s(),
        all: figures(&evaluation),
        drawn: drawn(&files),
    })
}

fn one(path: &Path) -> Result<(u64, FileScore), Box<dyn Error>> {
    let reference = Reference::from_json(&fs::read_to_string(path.with_extension("json"))?)?;
    let (rate, channels) = samples(&fs::read(path)?);
    let (_, analysis) = analyze_clearest(&channels, rate, &Settings::default())?;
    let mut hasher = DefaultHasher::new();
    format!("{analysis:?}").hash(&mut hasher);
    Ok((hasher.finish(), score(&analysis, &reference, 0.0, 0.0)))
}

/// The rate in Hz and the channels of a file of [`make_suite`].
fn samples(bytes: &[u8]) -> (f64, Vec<Vec<f32>>) {
    let words = bytes.as_chunks::<4>().0;
    let [rate, channels] = [0, 1].map(|i| u32::from_le_bytes(words[i]));
    let all: Vec<f32> = words[2..]
        .iter()
        .map(|word| f32::from_le_bytes(*word))
        .collect();
    let length = all.len() / channels as usize;
    let channels = all.chunks(length).map(<[f32]>::to_vec);
    (f64::from(rate), channels.collect())
}

/// Makes the recordings of all scenes, with their truth, in a folder.
pub(crate) fn make_suite(folder: &Path, seeds: u64) -> Result<(), Box<dyn Error>> {
    fs::create_dir_all(folder)?;
    for name in presets::names().chain(presets::found_names()) {
        for number in 1..=seeds {
            let made = render(&presets::preset(name)?, presets::seed(name, number))?;
            let path = folder.join(format!("{name}-{number}.samples"));
            let truth = serde_json::to_string(&made.truth)?;
            fs::write(path.with_extension("json"), truth)?;
            let mut channels = vec![made.samples];
            channels.extend(made.more_channels);
            let head = [made.truth.sample_rate_hz, channels.len() as u32];
            let mut bytes: Vec<u8> = head.iter().flat_map(|n| n.to_le_bytes()).collect();
            bytes.extend(channels.iter().flatten().flat_map(|x| x.to_le_bytes()));
            fs::write(path, bytes)?;
        }
    }
    Ok(())
}

fn evaluation(files: Vec<FileScore>) -> Evaluation {
    let tier = Tier {
        timing: "correlation".to_owned(),
        model: "auto".to_owned(),
        files,
    };
    Evaluation::of(&[tier], None)
}

fn figures(evaluation: &Evaluation) -> Vec<f64> {
    // What does not exist is infinitely wrong: too much was lost.
    let row = &evaluation.rows[0];
    let figures = COLUMNS
        .iter()
        .map(|column| (column.of)(row).unwrap_or(f64::INFINITY));
    figures.collect()
}

fn drawn(files: &[FileScore]) -> Vec<Vec<f64>> {
    let scenes: Vec<&[FileScore]> = files.chunk_by(|a, b| a.scene == b.scene).collect();
    let mut random = SplitMix64::new(1);
    let draw = |_| {
        let mut some = Vec::new();
        for _ in 0..scenes.len() {
            let at = random.next_u64() % scenes.len() as u64;
            some.extend_from_slice(scenes[at as usize]);
        }
        figures(&evaluation(some))
    };
    (0..DRAWS).map(draw).collect()
}

/// Time of the processor that this process took, where the system tells, in seconds.
fn cpu_s() -> f64 {
    const TICKS_PER_S: f64 = 100.0;
    let text = fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields: Vec<&str> = text.split(' ').collect();
    let ticks = |i: usize| fields.get(i).and_then(|f| f.parse::<f64>().ok());
    (ticks(13).unwrap_or(0.0) + ticks(14).unwrap_or(0.0)) / TICKS_PER_S
}
