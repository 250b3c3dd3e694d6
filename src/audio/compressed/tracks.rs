//! Which track of several is listened to.

use symphonia::core::codecs::CodecParameters;
use symphonia::core::codecs::audio::{AudioCodecParameters, CODEC_ID_NULL_AUDIO};
use symphonia::core::formats::FormatReader;
use symphonia::core::packet::Packet;

use super::codec::Decoder;
use crate::Error;
use crate::audio::content::Refused;
use crate::audio::unreadable;

/// Packets of each track that are decoded, at most, before one that has sound later than others is passed over: a microphone
/// may begin with silence. Of AAC they last 2 s.
const PROBED: usize = 100;

/// The track that is listened to.
pub(super) struct Track {
    pub id: u32,
    pub decoder: Decoder,
    /// What is to be said of the choice, if there was one.
    pub note: Option<String>,
    /// Whether the container was read for it, and has to be opened anew.
    pub probed: bool,
}

/// The first track that can be read and has sound, where the container can be read twice, and otherwise the first that can
/// be read.
///
/// # Errors
/// [`Error::Recording`] if there is none, for the reason of the first whose codec is known.
pub(super) fn choose(
    reader: &mut dyn FormatReader,
    ending: &'static str,
    is_pipe: bool,
) -> Result<Track, Error> {
    let all = of_sound(reader);
    let mut readable = Vec::new();
    let mut reasons = Vec::new();
    for (id, params) in &all {
        match Decoder::new(params, ending) {
            Ok(decoder) => readable.push((*id, decoder)),
            // A codec that has a name gives the better reason.
            Err(e) => reasons.push((params.codec == CODEC_ID_NULL_AUDIO, e)),
        }
    }
    let probed = readable.len() > 1 && !is_pipe;
    let sounding = if probed {
        sounding(reader, &mut readable)
    } else {
        0
    };
    let Some((id, _)) = readable.get(sounding) else {
        let why = reasons.into_iter().min_by_key(|(nameless, _)| *nameless);
        return Err(why.map_or_else(
            || {
                let name = "without sound of a kind that is known (it may hold AMR, or no sound)";
                unreadable(Refused::new(name, ending).sentence())
            },
            |(_, e)| e,
        ));
    };
    let number = all.iter().position(|(of, _)| of == id).unwrap_or(0) + 1;
    let count = all.len();
    let note =
        (count > 1).then(|| format!("it has {count} tracks of sound: number {number} was read"));
    let (id, decoder) = readable.swap_remove(sounding);
    Ok(Track {
        id,
        decoder,
        note,
        probed,
    })
}

/// All tracks of sound, in their order.
fn of_sound(reader: &dyn FormatReader) -> Vec<(u32, AudioCodecParameters)> {
    let each = reader.tracks().iter();
    let of = each.filter_map(|track| match &track.codec_params {
        Some(CodecParameters::Audio(params)) => Some((track.id, params.clone())),
        _ => None,
    });
    of.collect()
}

/// The first of some tracks that has sound; the first of all where none has.
fn sounding(reader: &mut dyn FormatReader, tracks: &mut [(u32, Decoder)]) -> usize {
    let mut probed = vec![0; tracks.len()];
    let mut sounds = vec![false; tracks.len()];
    while let Ok(Some(packet)) = reader.next_packet() {
        let Some(k) = tracks.iter().position(|(id, _)| *id == packet.track_id) else {
            continue;
        };
        probed[k] += 1;
        sounds[k] = sounds[k] || has_sound(&mut tracks[k].1, &packet);
        let enough = probed.iter().any(|n| *n >= PROBED) && sounds.contains(&true);
        if sounds[0] || enough {
            break;
        }
    }
    for (_, decoder) in tracks {
        decoder.inner.reset();
    }
    sounds.iter().position(|sounds| *sounds).unwrap_or(0)
}

/// Whether a sample of a packet is not 0.
fn has_sound(decoder: &mut Decoder, packet: &Packet) -> bool {
    decoder.inner.decode(packet).is_ok_and(|decoded| {
        let mut planes: Vec<Vec<f32>> = Vec::new();
        decoded.copy_to_vecs_planar(&mut planes);
        planes.iter().flatten().any(|x| *x != 0.0)
    })
}
