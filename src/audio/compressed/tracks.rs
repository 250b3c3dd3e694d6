//! Which track of several is listened to.

use std::collections::VecDeque;

use symphonia::core::audio::Channels;
use symphonia::core::codecs::CodecParameters;
use symphonia::core::codecs::audio::{AudioCodecParameters, CODEC_ID_NULL_AUDIO};
use symphonia::core::formats::FormatReader;
use symphonia::core::packet::Packet;

use super::Next;
use super::codec::{self, Decoder};
use super::guard::guarded;
use super::indexed::Read;
use super::names::Names;
use crate::Error;
use crate::audio::content::Refused;
use crate::audio::{Track, unreadable};

/// Packets of each track that are decoded, at most, before one that has sound later than others is passed over: a microphone
/// may begin with silence. Of AAC they last 2 s.
const PROBED: usize = 100;
/// Bytes of packets that are held at most while all tracks are silent: an hour of silent AAC.
const MOST_BYTES: usize = 1 << 24;

/// The track that is listened to.
pub(super) struct Chosen {
    pub id: u32,
    pub decoder: Decoder,
    /// All tracks and which was taken, if there was a choice that nobody made.
    pub note: Option<String>,
    pub ahead: Ahead,
}

/// What was read of a track before it was chosen.
#[derive(Default)]
pub(super) struct Ahead {
    pub packets: VecDeque<Packet>,
    /// How the container ended behind them, if it did.
    pub end: Option<Next>,
}

/// A track of sound.
struct Candidate {
    id: u32,
    params: AudioCodecParameters,
    /// Its language, where its container says it where others do.
    language: Option<String>,
    /// What decodes it, as long as that works.
    decoder: Result<Decoder, Error>,
    /// Packets that were decoded to hear whether there is sound.
    probed: usize,
    sounds: bool,
}

/// The track that is wanted: without a number the first that can be read and has sound, or the first that can be read if
/// none has.
///
/// # Errors
/// [`Error::Recording`] if there is none, for the reason of the first whose codec is known, or none with this number;
/// [`Error::Io`] if reading fails.
pub(super) fn choose(
    reader: &mut dyn FormatReader,
    ending: &'static str,
    names: &Names,
    wanted: Track,
    read: Read,
) -> Result<Chosen, Error> {
    let mut all = candidates(reader, ending);
    let mut ahead = Ahead::default();
    let index = match wanted {
        Track::Number(number) if (1..=all.len()).contains(&number) => number - 1,
        Track::Number(number) if !all.is_empty() => return Err(not_there(number, &all, names)),
        _ => {
            if all.iter().filter(|track| track.decoder.is_ok()).count() > 1 {
                ahead = probe(reader, read, &mut all)?;
            }
            let sounding = all.iter().position(|track| track.sounds);
            let readable = || all.iter().position(|track| track.decoder.is_ok());
            sounding.or_else(readable).unwrap_or(0)
        }
    };
    let is_choice = wanted == Track::WithSound && all.len() > 1;
    let note = is_choice.then(|| {
        let (count, listed) = (all.len(), list(&all, names));
        format!(
            "it has {count} tracks of sound, of which number {} was read: {listed}",
            index + 1
        )
    });
    if all.iter().all(|track| track.decoder.is_err()) {
        return Err(unread(all, ending));
    }
    let track = all.swap_remove(index);
    track.decoder?;
    ahead.packets.retain(|packet| packet.track_id == track.id);
    Ok(Chosen {
        id: track.id,
        // That of the probe has begun.
        decoder: Decoder::new(&track.params, ending)?,
        note,
        ahead,
    })
}

/// All tracks of sound, in their order.
fn candidates(reader: &dyn FormatReader, ending: &'static str) -> Vec<Candidate> {
    let each = reader.tracks().iter();
    let of = each.filter_map(|track| match &track.codec_params {
        Some(CodecParameters::Audio(params)) => Some(Candidate {
            id: track.id,
            params: params.clone(),
            language: track.language.clone().filter(|word| word != "und"),
            decoder: Decoder::new(params, ending),
            probed: 0,
            sounds: false,
        }),
        _ => None,
    });
    of.collect()
}

/// Why none can be read. A codec that has a name gives the better reason.
fn unread(all: Vec<Candidate>, ending: &'static str) -> Error {
    let is_nameless = |track: &Candidate| track.params.codec == CODEC_ID_NULL_AUDIO;
    let why = all.into_iter().min_by_key(is_nameless);
    why.and_then(|track| track.decoder.err())
        .unwrap_or_else(|| {
            let name = "without sound of a kind that is known (it may hold AMR, or no sound)";
            unreadable(Refused::new(name, ending).sentence())
        })
}

fn not_there(number: usize, all: &[Candidate], names: &Names) -> Error {
    let listed = list(all, names);
    unreadable(match all.len() {
        1 => format!("it has one track of sound, and no number {number}: {listed}"),
        count => format!("it has {count} tracks of sound, and no number {number}: {listed}"),
    })
}

/// The tracks, as `1 (AAC, eng, 48000 Hz, 2 channels, silent), 2 (…)`.
fn list(all: &[Candidate], names: &Names) -> String {
    let each = all.iter().zip(1..);
    let each =
        each.map(|(track, number)| format!("{number} ({})", track.words(names.words(track.id))));
    each.collect::<Vec<String>>().join(", ")
}

impl Candidate {
    fn words(&self, names: &[String]) -> String {
        let mut words = vec![codec::name(self.params.codec).to_owned()];
        words.extend(names.iter().chain(&self.language).cloned());
        words.extend(self.params.sample_rate.map(|hz| format!("{hz} Hz")));
        let channels = self.params.channels.as_ref().map(Channels::count);
        words.extend(channels.map(|count| match count {
            1 => "1 channel".to_owned(),
            count => format!("{count} channels"),
        }));
        if self.decoder.is_err() {
            words.push("not read".to_owned());
        } else if self.probed > 0 {
            words.push(if self.sounds { "has sound" } else { "silent" }.to_owned());
        }
        words.join(", ")
    }

    /// Hears whether a packet has sound. What makes its decoder panic is not read: that must not be asked again.
    fn hear(&mut self, packet: &Packet) {
        let Ok(decoder) = &mut self.decoder else {
            return;
        };
        self.probed += 1;
        match guarded(|| has_sound(decoder, packet)) {
            Some(sounds) => self.sounds |= sounds,
            None => self.decoder = Err(unreadable("its sound is damaged beyond what can be read")),
        }
    }
}

/// Reads ahead until it is known which tracks have sound.
fn probe(reader: &mut dyn FormatReader, read: Read, all: &mut [Candidate]) -> Result<Ahead, Error> {
    let mut ahead = Ahead::default();
    let mut bytes = 0;
    while bytes < MOST_BYTES && !is_settled(all) {
        let packet = match guarded(|| read(reader)).unwrap_or(Ok(Err(Next::Cut)))? {
            Ok(packet) => packet,
            Err(end) => {
                ahead.end = Some(end);
                break;
            }
        };
        if let Some(track) = all.iter_mut().find(|track| track.id == packet.track_id) {
            track.hear(&packet);
            bytes += packet.data.len();
            ahead.packets.push_back(packet);
        }
    }
    Ok(ahead)
}

/// Whether each track was heard, or one and others for long enough.
fn is_settled(all: &[Candidate]) -> bool {
    let mut readable = all.iter().filter(|track| track.decoder.is_ok());
    let is_long = readable.clone().any(|track| track.probed >= PROBED);
    readable.clone().all(|track| track.sounds) || is_long && readable.any(|track| track.sounds)
}

/// Whether a sample of a packet is not 0.
fn has_sound(decoder: &mut Decoder, packet: &Packet) -> bool {
    let decoded = decoder.decode(packet);
    decoded.is_some_and(|decoded| decoded.planes.iter().flatten().any(|x| *x != 0.0))
}
