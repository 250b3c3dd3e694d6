//! From a recording to its report.

use std::ops::Range;
use std::path::Path;

use crate::Error;
use crate::analysis::{Listener, Question, Settings, analyze_labelled, fit_times, predict};
use crate::audio::{Ending, Stream};
use crate::report::labels::Marked;
use crate::report::rule::RuleReport;
use crate::report::times::Typed;
use crate::report::{Analysis, RecordingInfo, Report, Warning, WarningCode};
use crate::rules::{Rule, judge};
use crate::workers::Workers;

/// Which channel is listened to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Channel {
    /// The one in which impacts stand out most.
    #[default]
    Best,
    /// The one with this number, from 1.
    Number(usize),
}

impl Channel {
    /// The indices of the channels that are listened to, of this many.
    pub(crate) fn of(self, channels: usize) -> Result<Range<usize>, Error> {
        match self {
            Self::Best => Ok(0..channels),
            Self::Number(number) if (1..=channels).contains(&number) => Ok(number - 1..number),
            Self::Number(number) => Err(Error::Argument {
                argument: "channel",
                got: format!("{number} of a recording with {channels}"),
                expected: "best or the number of a channel, from 1",
            }),
        }
    }
}

/// What is asked of a recording, where it is more than [`listen`] asks.
#[derive(Debug, Default)]
pub struct Request<'a> {
    /// How to listen.
    pub settings: Settings,
    /// To what.
    pub channel: Channel,
    /// A file of labels and the impacts of each drop in it, as [`labels::drops`](crate::report::labels::drops) gives them:
    /// exactly those are fitted, and where listening starts and ends has no meaning.
    pub labels: Option<(&'a Path, Vec<Vec<Marked>>)>,
    /// The rule to judge by.
    pub rule: Option<Rule>,
    /// What to predict.
    pub question: Option<Question>,
}

/// Listens to a stream to its end.
///
/// ```no_run
/// use std::path::Path;
/// use bounce_audio::{Settings, audio::Stream, recording::{Channel, listen}};
///
/// let stream = Stream::open_file(Path::new("drop.wav"))?;
/// let report = listen(stream, "drop.wav", Channel::Best, &Settings::default().height_m(0.305))?;
/// println!("{} drops", report.drops.len());
/// # Ok::<(), bounce_audio::Error>(())
/// ```
///
/// # Errors
/// [`Error::Argument`] for a setting out of range or a channel that is not there, [`Error::Wav`] if there is no audio,
/// [`Error::Io`] if reading fails.
pub fn listen(
    stream: Stream<'_>,
    name: &str,
    channel: Channel,
    settings: &Settings,
) -> Result<Report, Error> {
    let request = Request {
        settings: settings.clone(),
        channel,
        ..Request::default()
    };
    request.listen(stream, name)
}

impl Request<'_> {
    /// The report of a stream, which is read to its end.
    ///
    /// # Errors
    /// As for [`listen`]; [`Error::Line`] within [`Error::InFile`] for a labelled impact after the end and for a drop of which
    /// fewer than two impacts were heard.
    pub fn listen(&self, stream: Stream<'_>, name: &str) -> Result<Report, Error> {
        self.listen_by(stream, name, Workers::default())
    }

    /// As [`listen`](Self::listen), with the work done by these.
    pub(crate) fn listen_by(
        &self,
        stream: Stream<'_>,
        name: &str,
        workers: Workers,
    ) -> Result<Report, Error> {
        let settings = self.settings();
        let channels = stream.channels();
        let heard = self.channel.of(channels)?;
        let sample_rate_hz = f64::from(stream.sample_rate_hz()) * settings.time_scale;
        let (encoding, lossy) = (stream.encoding(), stream.is_lossy());
        let (channel, analysis, ending) = match &self.labels {
            None => search(stream, &heard, &settings, workers)?,
            Some((path, drops)) => fit(stream, &heard, &settings, drops, path)?,
        };
        let repairs = ending.warnings.into_iter();
        let repairs = repairs.map(|message| Warning::new(WarningCode::Repaired, message));
        let tracks = ending.tracks.into_iter();
        let tracks = tracks.map(|message| Warning::new(WarningCode::SeveralTracks, message));
        let of_reading = repairs
            .chain(tracks)
            .chain(lossy.then(|| of_lossy(&encoding)));
        let duration_s = ending.duration_s / settings.time_scale;
        let recording = RecordingInfo::new(sample_rate_hz, duration_s, encoding)
            .with_channel(channel + 1, channels);
        let mut analysis = Analysis {
            warnings: analysis.warnings.into_iter().chain(of_reading).collect(),
            ..analysis
        };
        self.predicted(&mut analysis, &settings);
        let rule = self.judged(&analysis, &settings)?;
        Ok(Report::new(
            name.to_owned(),
            recording,
            settings,
            analysis,
            rule,
        ))
    }

    /// The report of times that were typed in, each with this standard error.
    pub(crate) fn fit(&self, typed: &Typed, std_s: f64, name: &str) -> Result<Report, Error> {
        let settings = self.settings();
        let with_errors = |times: &Vec<f64>| times.iter().map(|&t| (t, std_s)).collect();
        let drops: Vec<Vec<(f64, f64)>> = typed.drops_s.iter().map(with_errors).collect();
        let mut analysis = fit_times(&drops, &settings)?;
        analysis.warnings.extend(typed.names());
        self.predicted(&mut analysis, &settings);
        let last = typed.drops_s.iter().filter_map(|times| times.last());
        let duration_s = last.copied().fold(0.0, f64::max) / settings.time_scale;
        let recording = RecordingInfo::new(0.0, duration_s, typed.in_words());
        let rule = self.judged(&analysis, &settings)?;
        Ok(Report::new(
            name.to_owned(),
            recording,
            settings,
            analysis,
            rule,
        ))
    }

    fn predicted(&self, analysis: &mut Analysis, settings: &Settings) {
        if let Some(question) = &self.question {
            for drop in &mut analysis.drops {
                drop.prediction = predict(drop, settings, question);
            }
        }
    }

    fn judged(
        &self,
        analysis: &Analysis,
        settings: &Settings,
    ) -> Result<Option<RuleReport>, Error> {
        let judged = self.rule.map(|rule| {
            let ball = rule.ball(settings.mass_kg, settings.diameter_m);
            judge(&rule, &analysis.drops, ball, settings.gravity_m_per_s2)
        });
        judged.transpose()
    }

    /// The settings, with what the rule says of the ball where they do not.
    fn settings(&self) -> Settings {
        let mut settings = self.settings.clone();
        if let Some(rule) = &self.rule {
            let ball = rule.ball(settings.mass_kg, settings.diameter_m);
            settings.mass_kg = Some(ball.mass_kg);
            settings.diameter_m = Some(ball.diameter_m);
        }
        settings
    }
}

/// The drops of a stream, the index of the channel that most were heard on, and how the stream ended.
type Heard = (usize, Analysis, Ending);

fn search(
    mut stream: Stream<'_>,
    heard: &Range<usize>,
    settings: &Settings,
    workers: Workers,
) -> Result<Heard, Error> {
    let rate = f64::from(stream.sample_rate_hz());
    let listener = Listener::to_channels(heard.clone(), rate, settings)?;
    let mut listener = listener.with_workers(workers);
    while listener.push_with(|room| stream.append(heard, room))?? {}
    // A file without audio is no WAV to listen to: that comes before what was not found in it.
    let ending = stream.finish()?;
    let (channel, analysis) = listener.finish()?;
    Ok((channel, analysis, ending))
}

fn fit(
    mut stream: Stream<'_>,
    heard: &Range<usize>,
    settings: &Settings,
    drops: &[Vec<Marked>],
    labels: &Path,
) -> Result<Heard, Error> {
    let rate = f64::from(stream.sample_rate_hz());
    let mut samples = vec![Vec::new(); heard.len()];
    while stream.append(heard, &mut samples)? {}
    let ending = stream.finish()?;
    let fitted = analyze_labelled(&samples, heard.start, rate, drops, settings);
    let (channel, analysis) = fitted.map_err(|e| e.in_file(labels))?;
    Ok((channel, analysis, ending))
}

/// What compression costs; `docs/compressed.md` has the figures.
fn of_lossy(encoding: &str) -> Warning {
    let message = format!(
        "the recording is compressed with loss ({encoding}), which may move an impact by 0.01 ms, by 2 ms where there is \
         noise, and swallow faint ones: e may be off by more than its error says. Record WAV, FLAC or ALAC"
    );
    Warning::new(WarningCode::Lossy, message)
}
