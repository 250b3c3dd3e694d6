//! Samples as they come: from a recorder, a command or standard input.

use std::io::{self, ErrorKind, Read};
use std::process::Child;

use clap::ValueEnum;

use super::Arguments;
use super::recorder;
use crate::Error;
use crate::audio::Stream;

/// Bytes that are read at once: a fortieth of a second of 16-bit samples at 48 kHz.
const BLOCK_BYTES: usize = 2_400;

/// How a bare sample is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Coding {
    /// Integers of 16 bits, the low byte first
    #[value(name = "s16le")]
    S16le,
    /// Floating point of 32 bits, full scale ±1
    #[value(name = "f32le")]
    F32le,
}

impl Coding {
    const fn bytes(self) -> usize {
        match self {
            Self::S16le => 2,
            Self::F32le => 4,
        }
    }

    fn sample(self, bytes: &[u8]) -> f32 {
        match (self, bytes) {
            (Self::S16le, &[a, b]) => f32::from(i16::from_le_bytes([a, b])) / 32_768.0,
            (Self::F32le, &[a, b, c, d]) => {
                let value = f32::from_le_bytes([a, b, c, d]);
                if value.is_finite() { value } else { 0.0 }
            }
            _ => 0.0,
        }
    }
}

/// Bare samples of a number of channels in turn.
struct Raw {
    source: Box<dyn Read>,
    coding: Coding,
    rate_hz: u32,
    channels: usize,
    /// Bytes of a frame that is not whole yet.
    rest: Vec<u8>,
}

impl Raw {
    fn append(&mut self, block: &mut [Vec<f32>]) -> Result<bool, Error> {
        let before = self.rest.len();
        self.rest.resize(before + BLOCK_BYTES, 0);
        let got = match self.source.read(&mut self.rest[before..]) {
            // Ctrl-C: whoever asks for more sees that.
            Err(e) if e.kind() == ErrorKind::Interrupted => {
                self.rest.truncate(before);
                return Ok(true);
            }
            result => result?,
        };
        self.rest.truncate(before + got);
        let frame = self.coding.bytes() * self.channels;
        let whole = self.rest.len() / frame * frame;
        for bytes in self.rest[..whole].chunks_exact(frame) {
            for (channel, sample) in block
                .iter_mut()
                .zip(bytes.chunks_exact(self.coding.bytes()))
            {
                channel.push(self.coding.sample(sample));
            }
        }
        self.rest.drain(..whole);
        Ok(got > 0)
    }
}

enum Form {
    Raw(Raw),
    Recording(Box<Stream<'static>>),
}

/// Samples as they come.
pub(super) struct Samples {
    form: Form,
    /// Where they come from.
    name: String,
    /// What writes them.
    child: Option<Child>,
}

impl Samples {
    /// Opens what the arguments name, or starts a recorder.
    ///
    /// # Errors
    /// [`Error::Refused`] if there is no recorder; [`Error::Io`], [`Error::Wav`] or [`Error::Recording`] if what comes is no
    /// recording.
    pub(super) fn open(arguments: &Arguments) -> Result<Self, Error> {
        if arguments.input.is_some() {
            return Self::of(Box::new(io::stdin()), arguments);
        }
        let (mut child, name, raw) = if let Some(command) = &arguments.from {
            let child = recorder::start_command(command)?;
            (child, format!("the command {command}"), arguments.raw)
        } else {
            let (child, name) = recorder::start()?;
            (child, name, Some(Coding::S16le))
        };
        let Some(output) = child.stdout.take() else {
            return Err(Error::refused(format!("{name} has no output")));
        };
        match form(Box::new(output), raw, arguments) {
            Ok(form) => Ok(Self {
                form,
                name,
                child: Some(child),
            }),
            Err(e) => {
                // One that failed by itself has said why.
                child.kill().ok();
                child.wait()?;
                Err(e.in_file(name))
            }
        }
    }

    /// What comes on standard input.
    pub(super) fn of(
        input: Box<dyn Read + Send + Sync>,
        arguments: &Arguments,
    ) -> Result<Self, Error> {
        let name = "standard input".to_owned();
        match form(input, arguments.raw, arguments) {
            Ok(form) => Ok(Self {
                form,
                name,
                child: None,
            }),
            Err(e) => Err(e.in_file(name)),
        }
    }

    pub(super) fn channels(&self) -> usize {
        match &self.form {
            Form::Raw(raw) => raw.channels,
            Form::Recording(stream) => stream.channels(),
        }
    }

    pub(super) fn rate_hz(&self) -> f64 {
        f64::from(match &self.form {
            Form::Raw(raw) => raw.rate_hz,
            Form::Recording(stream) => stream.sample_rate_hz(),
        })
    }

    /// Adds the next samples to those of each channel; false at the end.
    ///
    /// # Errors
    /// [`Error::Io`] if reading fails.
    pub(super) fn append(&mut self, block: &mut [Vec<f32>]) -> Result<bool, Error> {
        match &mut self.form {
            Form::Raw(raw) => raw.append(block),
            Form::Recording(stream) => {
                let all = 0..stream.channels();
                stream.append(&all, block)
            }
        }
    }

    /// Ends what writes the samples, and gives what is to be said of them.
    ///
    /// # Errors
    /// What reading failed with, if it did; [`Error::Refused`] if what writes ended by itself and says that it failed;
    /// [`Error::Wav`] if there was no audio.
    pub(super) fn end(self, failed: Option<Error>, stopped: bool) -> Result<Vec<String>, Error> {
        let Self { form, name, child } = self;
        if let Some(mut child) = child {
            ended(&mut child, &name, stopped || failed.is_some())?;
        }
        let ending = match (form, failed) {
            (_, Some(failed)) => Err(failed),
            (Form::Recording(stream), None) if !stopped => stream.finish().map(Some),
            _ => Ok(None),
        };
        let ending = ending.map_err(|e| e.in_file(&name))?;
        let said = ending.map(|ending| ending.warnings.into_iter().chain(ending.tracks));
        let said = said.into_iter().flatten();
        Ok(said.map(|warning| format!("{name}: {warning}")).collect())
    }
}

/// What comes from a source, whose samples are bare or not.
fn form(
    source: Box<dyn Read + Send + Sync>,
    raw: Option<Coding>,
    arguments: &Arguments,
) -> Result<Form, Error> {
    Ok(match raw {
        Some(coding) => Form::Raw(Raw {
            source,
            coding,
            rate_hz: if arguments.raw.is_some() {
                arguments.rate
            } else {
                recorder::RATE_HZ
            },
            channels: usize::from(arguments.channels),
            rest: Vec::new(),
        }),
        None => Form::Recording(Box::new(Stream::open(source)?)),
    })
}

/// Waits for a recorder that has closed its output, or ends it; a failure of its own is told.
fn ended(child: &mut Child, name: &str, stopped: bool) -> Result<(), Error> {
    if stopped {
        child.kill().ok();
    }
    let status = child.wait()?;
    if stopped || status.success() {
        return Ok(());
    }
    Err(Error::refused(format!(
        "{name} ended with {status}: what it wrote itself says why; no more is heard"
    )))
}
