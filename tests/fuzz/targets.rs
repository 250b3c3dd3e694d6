//! What is fuzzed: how an input is read, and what has to hold of the result.

use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};

use bounce_audio::Error;
use bounce_audio::ModelChoice;
use bounce_audio::Timing;
use bounce_audio::audio::{self, Stream};
use bounce_audio::random::SplitMix64;
use bounce_audio::report::labels::{Form, drops, read};
use bounce_audio::report::{RecordingInfo, Report, csv, json, text};
use bounce_audio::synth::presets::preset;
use bounce_audio::synth::render;
use bounce_audio::synth::scene::Scene;
use bounce_audio::units::{Quantity, real};
use bounce_audio::{Listener, Settings};

use super::choose::one_of;

/// Something that reads what others wrote.
pub(crate) struct Target {
    /// Its name.
    pub(crate) name: &'static str,
    /// Valid input, to be mutated.
    pub(crate) valid: fn() -> Vec<Vec<u8>>,
    /// Words that are put into it.
    pub(crate) words: &'static [&'static str],
    /// Reads an input and checks what came of it; random numbers make what else it needs.
    pub(crate) run: fn(&[u8], &mut SplitMix64),
}

/// All of them.
pub(crate) fn all() -> [Target; 6] {
    [walk(), compressed(), units(), labels(), scene(), analyze()]
}

/// The walk over the chunks and all decoders.
pub(crate) fn walk() -> Target {
    Target {
        name: "walk",
        valid: variants,
        words: &["data", "fmt ", "LIST", "ds64", "RF64", "RIFF", "WAVE"],
        run: |input, _| {
            let Ok(recording) = audio::read(input) else {
                return;
            };
            let samples: usize = recording.channels.iter().map(Vec::len).sum();
            assert!(samples > 0 && samples <= input.len());
            let all = recording.channels.iter().flatten();
            assert!(all.copied().all(f32::is_finite));
        },
    }
}

/// Containers and decoders of compressed sound, as a file and as a pipe.
pub(crate) fn compressed() -> Target {
    Target {
        name: "compressed",
        valid: compressed_files,
        words: &[
            "OggS",
            "ftyp",
            "moov",
            "mdat",
            "stts",
            "stsz",
            "fLaC",
            "ID3",
            "\u{1}vorbis",
            "Xing",
            "VBRI",
            "moof",
        ],
        run: |input, random| {
            let stream = if random.next_u64().is_multiple_of(2) {
                Stream::open_seekable(Cursor::new(input))
            } else {
                Stream::open(input)
            };
            let Ok(mut stream) = stream else {
                return;
            };
            let all = 0..stream.channels();
            let mut block = vec![Vec::new(); all.len()];
            let mut frames = 0;
            while stream.append(&all, &mut block).unwrap() {
                assert!(block.iter().all(|channel| channel.len() == block[0].len()));
                assert!(block.iter().flatten().all(|x| x.is_finite()));
                frames += block[0].len();
                block.iter_mut().for_each(Vec::clear);
            }
            let rate = f64::from(stream.sample_rate_hz());
            let Ok(ending) = stream.finish() else {
                return;
            };
            assert!(
                (ending.duration_s - real(frames) / rate).abs() < 1e-6,
                "{frames} {ending:?}"
            );
        },
    }
}

/// Numbers with units.
pub(crate) fn units() -> Target {
    Target {
        name: "units",
        valid: || {
            [
                "30.5cm", "12in", "0.3 m", "2.5g", "1e-3kg", "250µs", "2min", "9.81m/s2",
            ]
            .map(|text| text.as_bytes().to_vec())
            .to_vec()
        },
        words: &[
            "e400", "-", "nan", "inf", "µ", "m/s²", " ", ".", "1e308", "km", "\u{2028}",
        ],
        run: |input, random| {
            let quantities = [
                Quantity::Length,
                Quantity::Mass,
                Quantity::Time,
                Quantity::Acceleration,
            ];
            let text = String::from_utf8_lossy(input);
            match one_of(random, &quantities).parse("it", &text) {
                Ok(value) => assert!(value.is_finite()),
                Err(error) => assert!(error.to_string().starts_with("it is '")),
            }
        },
    }
}

/// Labels of all tools, and the impacts that they stand for.
pub(crate) fn labels() -> Target {
    Target {
        name: "labels",
        valid: || {
            [
                "0.5\t0.5\t1 heard -3.4 dB at 0.5 ±1.3e-8 s\n0.9\t0.9\t2:2 heard\n\\\t20\t40\n",
                "0.5,1:1 heard\n0.9,inferred\n1.2,\"a, b\"\n",
                "File type = \"ooTextFile\"\nObject class = \"TextGrid\"\n\n0\n2\n<exists>\n1\n\"TextTier\"\n\"impacts\"\n0\n2\n1\n0.5\n\"1:1 heard\"\n",
            ]
            .map(|text| text.as_bytes().to_vec())
            .to_vec()
        },
        words: &[
            "\t",
            ",",
            "\"",
            "±",
            "at ",
            "inferred",
            "2:",
            "1e300",
            "nan",
            "-",
            "\n",
            "points: size = 9999999999",
        ],
        run: |input, random| {
            let form = *one_of(random, &[Form::Audacity, Form::Instants, Form::TextGrid]);
            let Ok(labels) = read(input, form) else {
                return;
            };
            if let Ok(drops) = drops(&labels, form, 1e-3) {
                let marked = drops.iter().map(Vec::len).sum::<usize>();
                assert!(marked <= labels.len());
            }
        },
    }
}

/// The longest scene that is rendered, in samples.
const MOST_RENDERED: f64 = 20_000.0;

/// Scenes as text, and short ones rendered.
pub(crate) fn scene() -> Target {
    Target {
        name: "scene",
        valid: scenes,
        words: &[
            "1e300",
            "-1",
            "nan",
            "inf",
            "[[drops]]\n",
            "[noise]\n",
            "= ",
            "0",
            "1e-300",
            "99999999999",
            "\"",
            "#",
            "\n",
        ],
        run: |input, random| {
            let Ok(scene) = Scene::from_toml(&String::from_utf8_lossy(input)) else {
                return;
            };
            if scene.duration_s * f64::from(scene.sample_rate_hz) > MOST_RENDERED {
                return;
            }
            if let Ok(made) = render(&scene, random.next_u64()) {
                assert!(made.samples.iter().all(|x| x.is_finite()));
            }
        },
    }
}

/// The whole way from a file to its documents.
pub(crate) fn analyze() -> Target {
    Target {
        name: "analyze",
        valid: recordings,
        words: &[],
        run: |input, random| {
            let settings = settings(random);
            if let Ok(report) = listen(input, &settings) {
                check(&report);
            }
        },
    }
}

/// A folder of this package, or beside the one that `cargo fuzz` builds.
fn folder(name: &str) -> PathBuf {
    let above = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors();
    let mut named = above.map(|folder| folder.join(name));
    named.find(|folder| folder.is_dir()).unwrap()
}

fn compressed_files() -> Vec<Vec<u8>> {
    let files = fs::read_dir(folder("fixtures").join("compressed"))
        .unwrap()
        .map(|f| f.unwrap().path());
    let no_text = |f: &PathBuf| {
        !matches!(
            f.extension().and_then(|e| e.to_str()),
            Some("md" | "toml" | "sh")
        )
    };
    let mut files: Vec<_> = files.filter(no_text).collect();
    files.sort();
    files
        .into_iter()
        .map(|file| fs::read(file).unwrap())
        .collect()
}

fn variants() -> Vec<Vec<u8>> {
    let files = fs::read_dir(folder("fixtures").join("wav-variants"))
        .unwrap()
        .map(|f| f.unwrap().path());
    let mut files: Vec<_> = files
        .filter(|f| f.extension().is_some_and(|e| e == "wav"))
        .collect();
    files.sort();
    // Most of a file are samples of one sine: a few of them are as good.
    let few = files.into_iter().map(|file| {
        let mut bytes = fs::read(file).unwrap();
        bytes.truncate(1_500);
        bytes
    });
    few.collect()
}

/// The presets, and each again so short that it is rendered.
fn scenes() -> Vec<Vec<u8>> {
    let names = bounce_audio::synth::presets::names();
    let folder = folder("assets/scenes");
    let texts = names.map(|name| fs::read_to_string(folder.join(format!("{name}.toml"))).unwrap());
    let all = texts.flat_map(|text| {
        let short = text.lines().map(|line| match line.split(' ').next() {
            Some("duration_s") => "duration_s = 0.2",
            Some("sample_rate_hz") => "sample_rate_hz = 44100",
            Some("first_impact_s") => "first_impact_s = 0.05",
            _ => line,
        });
        let short = short.collect::<Vec<_>>().join("\n");
        [text.into_bytes(), short.into_bytes()]
    });
    all.collect()
}

/// Short recordings of drops: clicks, a steel ball, both on two channels, floats.
fn recordings() -> Vec<Vec<u8>> {
    let mut clicks = vec![0.0_f32; 16_000];
    let (mut at_s, mut flight_s) = (0.1, 0.4);
    while flight_s > 0.01 {
        let at = bounce_audio::units::samples_in(at_s, 8_000.0);
        clicks[at..at + 4].copy_from_slice(&[0.5, -0.3, 0.2, -0.1]);
        at_s += flight_s;
        flight_s *= 0.78;
    }
    let steel = render(&preset("steel").unwrap(), 1).unwrap().samples;
    let steel = &steel[25_000..25_000 + 60_000];
    let slow: Vec<f32> = steel.iter().step_by(4).copied().collect();
    let both: Vec<f32> = clicks
        .iter()
        .zip(&slow)
        .flat_map(|(a, b)| [*a, *b])
        .collect();
    vec![
        pcm16(1, 8_000, &clicks),
        pcm16(1, 44_100, steel),
        pcm16(2, 11_025, &both),
        pcm16(1, 11_025, &slow),
    ]
}

fn pcm16(channels: u16, sample_rate: u32, samples: &[f32]) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    let spec = hound::WavSpec {
        channels,
        sample_rate,
        bits_per_sample: 16,
        sample_format: hound::SampleFormat::Int,
    };
    let mut writer = hound::WavWriter::new(&mut file, spec).unwrap();
    for x in samples {
        #[expect(clippy::cast_possible_truncation, reason = "`as` saturates")]
        writer.write_sample((x * 32_767.0) as i16).unwrap();
    }
    writer.finalize().unwrap();
    file.into_inner()
}

/// Settings that mostly are in range.
fn settings(random: &mut SplitMix64) -> Settings {
    let mut maybe = |low: f64, high: f64| {
        let value = low * (high / low).powf(random.uniform());
        (random.uniform() < 0.3).then_some(value)
    };
    let settings = Settings::default()
        .height_m(maybe(1e-6, 1e4))
        .mass_kg(maybe(1e-9, 1e6))
        .diameter_m(maybe(1e-6, 1e3))
        .contact_time_s(maybe(1e-9, 1.0))
        .start_s(maybe(1e-6, 2.0))
        .end_s(maybe(1e-3, 10.0))
        .gravity_m_per_s2(maybe(1e-3, 1e6).unwrap_or(9.81))
        .height_std_m(maybe(1e-9, 1e4).unwrap_or(0.0));
    let timings = [Timing::Envelope, Timing::Fraction, Timing::Correlation];
    let timing = *one_of(random, &timings);
    let models = [
        ModelChoice::Auto,
        ModelChoice::Constant,
        ModelChoice::Contact,
        ModelChoice::Linear,
        ModelChoice::Drag,
        ModelChoice::Speed,
        ModelChoice::Viscoelastic,
    ];
    settings.timing(timing).model(*one_of(random, &models))
}

fn listen(input: &[u8], settings: &Settings) -> Result<Report, Error> {
    let mut stream = Stream::open(input)?;
    let encoding = stream.encoding();
    let all = 0..stream.channels();
    let sample_rate_hz = f64::from(stream.sample_rate_hz());
    let mut listener = Listener::new(all.len(), sample_rate_hz, settings)?;
    while listener.push_with(|room| stream.append(&all, room))?? {}
    let ending = stream.finish()?;
    let (channel, analysis) = listener.finish()?;
    let recording = RecordingInfo::new(sample_rate_hz, ending.duration_s, encoding)
        .with_channel(channel + 1, all.len());
    Ok(Report::new(
        "it".to_owned(),
        recording,
        settings.clone(),
        analysis,
        None,
    ))
}

/// All forms can be written, times are in order and in the recording, and what is given is a number.
fn check(report: &Report) {
    assert!(!text::to_text(report, text::Detail::Everything).contains("NaN"));
    assert!(!csv::to_csv(report).contains("NaN"));
    assert!(json::to_json(report).is_ok());
    for drop in &report.drops {
        let times: Vec<f64> = drop.impacts.iter().map(|i| i.time_s).collect();
        assert!(times.is_sorted_by(|a, b| a < b), "{times:?}");
        let within = -0.1..=report.recording.duration_s + 0.1;
        assert!(times.iter().all(|t| within.contains(t)), "{times:?}");
        assert!(drop.bounces > 0 && real(drop.bounces) <= real(times.len()));
        if let Some(restitution) = &drop.restitution {
            let estimate = &restitution.estimate;
            assert!(
                estimate.value.is_finite() && estimate.std_error.is_none_or(|s| s >= 0.0),
                "{estimate:?}"
            );
        }
    }
}
