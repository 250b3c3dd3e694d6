//! Pictures into files: SVG or PNG by the ending of the name.

use std::ffi::OsString;
use std::ops::Range;
use std::path::{Path, PathBuf};

use super::output;
use crate::Error;
use crate::audio::{Stream, Track};
use crate::picture::sheet::sheets;
use crate::picture::sound::Sound;
use crate::plot::{self, Figure};
use crate::report::Report;

/// How a picture is stored.
#[derive(Debug, Clone, Copy)]
enum Form {
    Svg,
    Png,
}

/// Where a picture goes.
#[derive(Debug, Clone)]
pub(super) struct Target {
    path: PathBuf,
    form: Form,
}

/// Most sheets that are drawn for one recording.
const MOST_SHEETS: usize = 100;

impl Target {
    /// # Errors
    /// [`Error::Argument`] unless the name ends in `.svg` or `.png`.
    pub(super) fn new(path: &Path) -> Result<Self, Error> {
        let ending = path.extension().and_then(|e| e.to_str());
        let form = match ending.map(str::to_ascii_lowercase).as_deref() {
            Some("svg") => Form::Svg,
            Some("png") => Form::Png,
            _ => {
                return Err(Error::Argument {
                    argument: "--plot",
                    got: format!("'{}'", path.display()),
                    expected: "a name that ends in .svg or .png",
                });
            }
        };
        Ok(Self {
            path: path.to_path_buf(),
            form,
        })
    }

    /// Draws a picture into its file, which is whole or not there.
    pub(super) fn draw(&self, figure: &Figure) -> Result<(), Error> {
        let (alike, bytes) = match self.form {
            Form::Svg => (&b"<svg"[..], plot::to_svg(figure).map(String::into_bytes)),
            Form::Png => (&b"\x89PNG"[..], plot::to_png(figure)),
        };
        let bytes = bytes.map_err(|e| e.in_file(&self.path))?;
        output::write(&self.path, alike, &bytes)
    }

    /// The target of one picture of several: `OUT-2.svg`.
    fn numbered(&self, number: usize) -> Self {
        let mut name = OsString::from(self.path.file_stem().unwrap_or_default());
        name.push(format!("-{number}."));
        name.push(self.path.extension().unwrap_or_default());
        Self {
            path: self.path.with_file_name(name),
            form: self.form,
        }
    }
}

/// Whether the recording can be read a second time, for its picture.
pub(super) fn check_readable_twice(recording: &Path) -> Result<(), Error> {
    // What is not there, or is a folder, is told by whoever opens it.
    let once = recording == Path::new("-")
        || std::fs::metadata(recording).is_ok_and(|m| !m.is_file() && !m.is_dir());
    if once {
        return Err(Error::Argument {
            argument: "--plot or --report",
            got: "for a pipe".to_owned(),
            expected: "a file: it is read a second time for its picture, so store it first",
        });
    }
    Ok(())
}

/// Draws the sheets of a report on the recording in a file: into the target, or, of several drops, each into its own.
pub(super) fn draw_sheets(
    target: &Target,
    file: &Path,
    track: Track,
    report: &Report,
) -> Result<(), Error> {
    draw_all(target, &figures(file, track, report)?)
}

/// One picture into the target, several each into its own.
pub(super) fn draw_all(target: &Target, figures: &[Figure]) -> Result<(), Error> {
    match figures {
        [only] => target.draw(only),
        several => (1..)
            .zip(several)
            .try_for_each(|(number, figure)| target.numbered(number).draw(figure)),
    }
}

/// The sheets of a report on a track of a file.
pub(super) fn figures(file: &Path, track: Track, report: &Report) -> Result<Vec<Figure>, Error> {
    let drops = report.drops.len();
    if drops > MOST_SHEETS {
        return Err(Error::Argument {
            argument: "--plot",
            got: format!("for {drops} drops"),
            expected: "100 drops at most: choose a part with --start and --end",
        });
    }
    let sounds = hear(file, track, report).map_err(|e| e.in_file(file))?;
    Ok(sheets(report, &sounds))
}

/// Reads the recording again, for what its pictures need.
fn hear(file: &Path, track: Track, report: &Report) -> Result<Vec<Sound>, Error> {
    let mut sounds = Sound::of(report);
    let numbers = || sounds.iter().map(|s| s.channel - 1);
    let channels: Range<usize> =
        numbers().min().unwrap_or(0)..numbers().max().map_or(0, |last| last + 1);
    let end_s = sounds.iter().map(Sound::end_s).fold(0.0, f64::max);
    let mut stream = Stream::open_file_track(file, track)?;
    let rate = f64::from(stream.sample_rate_hz()) * report.settings.time_scale;
    let end = crate::units::samples_in(end_s, rate);
    let mut blocks = vec![Vec::new(); channels.len()];
    let mut first = 0;
    while first < end && stream.append(&channels, &mut blocks)? {
        for sound in &mut sounds {
            sound.hear(first, &blocks[sound.channel - 1 - channels.start]);
        }
        first += blocks.first().map_or(0, Vec::len);
        blocks.iter_mut().for_each(Vec::clear);
    }
    Ok(sounds)
}
