//! What decodes a packet, and what it is called.

use symphonia::core::codecs::audio::well_known::{
    CODEC_ID_AAC, CODEC_ID_AC3, CODEC_ID_AC4, CODEC_ID_ALAC, CODEC_ID_EAC3, CODEC_ID_FLAC,
    CODEC_ID_MP3, CODEC_ID_OPUS, CODEC_ID_PCM_ALAW, CODEC_ID_PCM_MULAW, CODEC_ID_VORBIS,
};
use symphonia::core::codecs::audio::{
    AudioCodecId, AudioCodecParameters, AudioDecoder, AudioDecoderOptions,
};
use symphonia::core::codecs::registry::RegisterableAudioDecoder;
use symphonia::core::errors;
use symphonia::core::packet::Packet;
use symphonia::default::codecs::{
    AacDecoder, AlacDecoder, FlacDecoder, MpaDecoder, PcmDecoder, VorbisDecoder,
};

use super::opus::{self, Opus};
use crate::Error;
use crate::audio::content::Refused;
use crate::audio::unreadable;

/// A decoder of the seven that there are.
pub(super) struct Decoder {
    inner: Inner,
    name: &'static str,
    pub is_lossy: bool,
    bits: Option<u32>,
}

enum Inner {
    Symphonia(Box<dyn AudioDecoder>),
    Opus(Box<Opus>),
}

/// The sound of a packet.
pub(super) struct Decoded {
    pub sample_rate_hz: u32,
    /// The samples of each channel.
    pub planes: Vec<Vec<f32>>,
}

impl Decoder {
    /// The decoder for what a container says of its sound; files of this kind end so.
    ///
    /// # Errors
    /// [`Error::Recording`] with the command that converts it, if there is none.
    pub(super) fn new(params: &AudioCodecParameters, ending: &'static str) -> Result<Self, Error> {
        // The first packet of a Vorbis readies the next and gives nothing; what an encoder added is left out later (`stream`).
        let options = AudioDecoderOptions::default().gapless(true);
        let name = name(params.codec);
        let made = match params.codec {
            CODEC_ID_AAC => AacDecoder::try_new(params, &options).map(boxed),
            CODEC_ID_ALAC => AlacDecoder::try_new(params, &options).map(boxed),
            CODEC_ID_FLAC => FlacDecoder::try_new(params, &options).map(boxed),
            CODEC_ID_MP3 => MpaDecoder::try_new(params, &options).map(boxed),
            CODEC_ID_VORBIS => VorbisDecoder::try_new(params, &options).map(boxed),
            other if is_pcm(other) => {
                // A header may claim 4 billion frames a packet; without the claim the decoder grows by what comes.
                let mut params = params.clone();
                params.max_frames_per_packet = None;
                PcmDecoder::try_new(&params, &options).map(boxed)
            }
            CODEC_ID_OPUS => {
                let head = params.extra_data.as_deref().unwrap_or_default();
                return Ok(Self {
                    inner: Inner::Opus(Box::new(Opus::new(head, ending)?)),
                    name,
                    is_lossy: true,
                    bits: None,
                });
            }
            other => {
                let what = "neither AAC, ALAC, MP3, FLAC, Vorbis, Opus nor PCM (AMR perhaps)";
                let name = unread(other).unwrap_or(what);
                return Err(unreadable(Refused::new(name, ending).sentence()));
            }
        };
        let is_lossy = matches!(
            params.codec,
            CODEC_ID_AAC | CODEC_ID_MP3 | CODEC_ID_VORBIS | CODEC_ID_PCM_ALAW | CODEC_ID_PCM_MULAW
        );
        let inner = made.map_err(|e| refused(&e, name, ending))?;
        let bits = match params.codec {
            // In the sixth byte of what it says of itself.
            CODEC_ID_ALAC => params
                .extra_data
                .as_ref()
                .and_then(|d| Some(u32::from(*d.get(5)?))),
            CODEC_ID_FLAC => inner.codec_params().bits_per_sample,
            codec if is_pcm(codec) => inner.codec_params().bits_per_sample,
            _ => None,
        };
        Ok(Self {
            inner: Inner::Symphonia(inner),
            name,
            is_lossy,
            bits,
        })
    }

    /// The sound of a packet; none if it is damaged.
    pub(super) fn decode(&mut self, packet: &Packet) -> Option<Decoded> {
        match &mut self.inner {
            Inner::Symphonia(decoder) => {
                let decoded = decoder.decode(packet).ok()?;
                let mut planes = Vec::new();
                decoded.copy_to_vecs_planar(&mut planes);
                Some(Decoded {
                    sample_rate_hz: decoded.spec().rate(),
                    planes,
                })
            }
            Inner::Opus(decoder) => Some(Decoded {
                sample_rate_hz: opus::RATE_HZ,
                planes: decoder.decode(&packet.data)?,
            }),
        }
    }

    /// Forgets what came before.
    pub(super) fn reset(&mut self) {
        match &mut self.inner {
            Inner::Symphonia(decoder) => decoder.reset(),
            Inner::Opus(decoder) => decoder.reset(),
        }
    }

    /// The storage in words, such as `16-bit FLAC` or `AAC`.
    pub(super) fn encoding(&self) -> String {
        match self.bits {
            Some(bits) => format!("{bits}-bit {}", self.name),
            None => self.name.to_owned(),
        }
    }
}

/// What is known and not read.
fn unread(codec: AudioCodecId) -> Option<&'static str> {
    match codec {
        CODEC_ID_AC3 => Some("AC-3"),
        CODEC_ID_EAC3 => Some("Enhanced AC-3"),
        CODEC_ID_AC4 => Some("AC-4"),
        _ => None,
    }
}

/// What a codec is called, read or not.
pub(super) fn name(codec: AudioCodecId) -> &'static str {
    match codec {
        CODEC_ID_AAC => "AAC",
        CODEC_ID_ALAC => "ALAC",
        CODEC_ID_FLAC => "FLAC",
        CODEC_ID_MP3 => "MP3",
        CODEC_ID_VORBIS => "Vorbis",
        CODEC_ID_OPUS => "Opus",
        other if is_pcm(other) => "PCM",
        other => unread(other).unwrap_or("of an unknown kind"),
    }
}

/// Whether samples stand as they are.
fn is_pcm(codec: AudioCodecId) -> bool {
    PcmDecoder::supported_codecs()
        .iter()
        .any(|of| of.id == codec)
}

fn boxed(decoder: impl AudioDecoder + 'static) -> Box<dyn AudioDecoder> {
    Box::new(decoder)
}

/// AAC that is not read.
pub(super) fn other_aac(ending: &'static str) -> Error {
    refused_kind("AAC", "LC with 1 or 2 channels", ending)
}

/// A codec of another kind than what is read of it.
pub(super) fn refused_kind(name: &str, read: &str, ending: &str) -> Error {
    unreadable(format!(
        "it is {name} of another kind than {read}, which is not read; ffmpeg -i IN.{ending} OUT.wav converts it"
    ))
}

/// A kind of a codec that is not read, such as AAC with a second band (HE) or with more than two channels; or its
/// header is broken.
fn refused(error: &errors::Error, name: &str, ending: &'static str) -> Error {
    match error {
        errors::Error::Unsupported(_) if name == "AAC" => other_aac(ending),
        errors::Error::Unsupported(what) => unreadable(format!(
            "its {name} is of a kind that is not read ({what}); ffmpeg -i IN.{ending} OUT.wav may convert it"
        )),
        _ => unreadable(format!("the header of its {name} is damaged")),
    }
}
