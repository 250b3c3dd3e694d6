//! Which reader takes a container apart.

use std::io::Read;

use super::source::Source;
use super::{Opened, frames, indexed, pages};
use crate::Error;
use crate::audio::Track;
use crate::audio::content::{Content, HEAD_BYTES};
use crate::audio::wav::fill;

/// Goes to what is in a container, past the tags before it.
pub(super) fn open(
    content: Content,
    source: Source<'_>,
    wanted: Track,
) -> Result<Opened<'_>, Error> {
    match content {
        Content::Mp4 => indexed::mp4(source, wanted),
        Content::Matroska => indexed::matroska(source, wanted),
        Content::Flac => indexed::flac(source),
        Content::Aiff => indexed::aiff(source),
        Content::Caf => indexed::caf(source),
        Content::Ogg => pages::ogg(source),
        Content::Adts => frames::adts(source),
        Content::Tagged => behind_tag(source),
        // A WAV or what is refused does not come here.
        Content::Mp3 | Content::Wav | Content::Refused(_) => frames::mp3(source),
    }
}

/// Skips an `ID3v2` tag, pictures and all; another may follow.
fn behind_tag(mut source: Source<'_>) -> Result<Opened<'_>, Error> {
    loop {
        let mut head = [0; 10];
        fill(&mut source, &mut head)?;
        // Seven bits of each byte count.
        let length = head[6..]
            .iter()
            .fold(0, |sum, byte| sum << 7 | u64::from(byte & 0x7F));
        let footer = if head[5] & 0x10 == 0 { 0 } else { 10 };
        std::io::copy(
            &mut (&mut source).take(length + footer),
            &mut std::io::sink(),
        )?;
        let mut next = vec![0; HEAD_BYTES];
        let got = fill(&mut source, &mut next)?;
        next.truncate(got);
        let content = Content::of(&next);
        source = Source::Pipe(Box::new(std::io::Cursor::new(next).chain(source)));
        match content {
            Content::Tagged => {}
            Content::Flac | Content::Adts => return open(content, source, Track::WithSound),
            // Padding may follow the tag, which the search for the first frame passes.
            _ => return frames::mp3(source),
        }
    }
}
