//! One recording: read once if it fits, and asked as often as a setting or an impact is changed.

use std::path::Path;

use bounce_audio::audio::{Recording, Stream};
use bounce_audio::picture::sheet::sheets;
use bounce_audio::picture::sound::Sound;
use bounce_audio::picture::to_svg;
use bounce_audio::recording::Request;
use bounce_audio::report::labels::{self, Form};
use bounce_audio::report::rule::RuleReport;
use bounce_audio::report::text::{Detail, to_text};
use bounce_audio::report::{csv, json};
use bounce_audio::{Error, Report};
use js_sys::Function;
use wasm_bindgen::JsError;
use wasm_bindgen::prelude::wasm_bindgen;

use crate::asked::Asked;
use crate::peaks::Peaks;
use crate::slices::File;
use crate::told;

/// Most samples that are held, 64 MB of them: three minutes of stereo at 48 kHz. What is longer is read again each time.
const MOST_HELD: usize = 16_000_000;
/// Standard error of an impact that a person set, as of the command.
const BY_HAND_S: f64 = 1e-3;
/// Most sheets that are drawn.
const MOST_SHEETS: usize = 20;

/// A recording of the page.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Recorded {
    name: String,
    file: File,
    held: Option<Recording>,
    answer: Option<Answer>,
}

/// What was found last, and what its pictures need of the sound.
#[derive(Debug)]
struct Answer {
    report: Report,
    sounds: Vec<Sound>,
    peaks: Peaks,
}

#[wasm_bindgen]
impl Recorded {
    /// Opens a file of this name and size, of which `read(from, to)` gives bytes.
    ///
    /// # Errors
    /// If it is no recording that can be read.
    #[wasm_bindgen(constructor)]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the browser counts bytes as a number"
    )]
    pub fn new(name: String, size: f64, read: Function) -> Result<Self, JsError> {
        let file = File::new(size as u64, read);
        let stream = Stream::open_seekable(file.slices()).map_err(told)?;
        let held = stream.into_recording_within(MOST_HELD).map_err(told)?;
        Ok(Self {
            name,
            file,
            held,
            answer: None,
        })
    }

    /// Listens as is asked; gives the document of `analyze --format json`.
    ///
    /// # Errors
    /// If a setting is out of range, or there is no such channel or rule.
    pub fn analyze(&mut self, asked: &str) -> Result<String, JsError> {
        let request = Asked::read(asked)?.request()?;
        self.answered(&request)
    }

    /// Fits the impacts of these labels of Audacity and nothing else, as `analyze --impacts` does.
    ///
    /// # Errors
    /// As for [`analyze`](Self::analyze), or if the labels are not those of a drop.
    pub fn fit(&mut self, marked: &str, asked: &str) -> Result<String, JsError> {
        let mut request = Asked::read(asked)?.request()?;
        let read = labels::read(marked.as_bytes(), Form::Audacity);
        let drops = read.and_then(|labels| labels::drops(&labels, Form::Audacity, BY_HAND_S));
        request.labels = Some((Path::new("labels"), drops.map_err(told)?));
        self.answered(&request)
    }

    /// What the rule that was asked for says of each drop, a line for each thing.
    ///
    /// # Errors
    /// If nothing was asked yet.
    pub fn verdicts(&self) -> Result<Vec<String>, JsError> {
        let report = &self.answer()?.report;
        let of_drop = |rule: &RuleReport, i| rule.in_words(i).join("\n");
        let rule = report.rule.iter();
        Ok(rule
            .flat_map(|rule| (0..rule.drops.len()).map(move |i| of_drop(rule, i)))
            .collect())
    }

    /// The pictures of `analyze --plot`, as SVG: one for each drop, or one that shows why there is none.
    ///
    /// # Errors
    /// If one cannot be drawn.
    pub fn sheets(&self) -> Result<Vec<String>, JsError> {
        let answer = self.answer()?;
        let figures = sheets(&answer.report, &answer.sounds);
        let drawn = figures.iter().take(MOST_SHEETS).map(to_svg);
        drawn.collect::<Result<_, Error>>().map_err(told)
    }

    /// One row for each impact.
    ///
    /// # Errors
    /// If nothing was asked yet.
    pub fn csv(&self) -> Result<String, JsError> {
        Ok(csv::to_csv(&self.answer()?.report))
    }

    /// What the command prints.
    ///
    /// # Errors
    /// If nothing was asked yet.
    pub fn text(&self) -> Result<String, JsError> {
        Ok(to_text(&self.answer()?.report, Detail::Usual))
    }

    /// The impacts as a label track of Audacity.
    ///
    /// # Errors
    /// If nothing was asked yet.
    pub fn labels(&self) -> Result<String, JsError> {
        let report = &self.answer()?.report;
        let duration_s = report.recording.duration_s;
        let impacts = report.to_be_labelled();
        Ok(labels::to_labels(&impacts, duration_s, Form::Audacity))
    }

    /// The greatest size of the samples in each cell of the channel that was listened to.
    ///
    /// # Errors
    /// If nothing was asked yet.
    pub fn peaks(&self) -> Result<Vec<f32>, JsError> {
        Ok(self.answer()?.peaks.values.clone())
    }

    /// Length of a cell in seconds.
    ///
    /// # Errors
    /// If nothing was asked yet.
    pub fn cell_s(&self) -> Result<f64, JsError> {
        let answer = self.answer()?;
        Ok(answer.peaks.cell_s(answer.report.recording.sample_rate_hz))
    }
}

impl Recorded {
    /// The recording from its start.
    fn stream(&self) -> Result<Stream<'_>, JsError> {
        match &self.held {
            Some(recording) => Ok(Stream::again(recording)),
            None => Stream::open_seekable(self.file.slices()).map_err(told),
        }
    }

    fn answer(&self) -> Result<&Answer, JsError> {
        let none = || JsError::new("nothing was asked of this recording yet");
        self.answer.as_ref().ok_or_else(none)
    }

    /// Answers a request, and keeps the report with what its pictures need; gives its document.
    fn answered(&mut self, request: &Request<'_>) -> Result<String, JsError> {
        let report = request.listen(self.stream()?, &self.name).map_err(told)?;
        let document = json::to_json(&report)?;
        self.answer = Some(self.heard(report)?);
        Ok(document)
    }

    /// A report with what its pictures need of the sound.
    fn heard(&self, report: Report) -> Result<Answer, JsError> {
        let first = report.drops.first();
        let channel = first.map_or(report.recording.channel, |drop| drop.channel) - 1;
        let mut sounds = Sound::of(&report);
        let mut peaks = Peaks::new(report.recording.sample_rate_hz);
        let mut stream = self.stream()?;
        let mut blocks = vec![Vec::new(); stream.channels()];
        let (all, mut at) = (0..blocks.len(), 0);
        while stream.append(&all, &mut blocks).map_err(told)? {
            for sound in &mut sounds {
                sound.hear(at, &blocks[sound.channel - 1]);
            }
            peaks.hear(&blocks[channel]);
            at += blocks[channel].len();
            blocks.iter_mut().for_each(Vec::clear);
        }
        Ok(Answer {
            report,
            sounds,
            peaks,
        })
    }
}
