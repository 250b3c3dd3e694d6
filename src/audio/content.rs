//! What a recording is, by its first bytes. Names of files are not asked: phones and people get them wrong.

use std::ffi::OsStr;
use std::path::Path;

/// As many first bytes as it takes to tell what a recording is.
pub const HEAD_BYTES: usize = 64;

/// What is read, as people call it, with the endings of names that differ from that.
#[cfg(feature = "opus")]
pub const FORMATS: &str = "WAV, FLAC, MP4 (M4A, MOV), AAC, MP3, Ogg (Vorbis, Opus), AIFF, CAF and Matroska (MKV, MKA, WebM)";
/// What is read, as people call it, with the endings of names that differ from that.
#[cfg(not(feature = "opus"))]
pub const FORMATS: &str = "WAV, FLAC, MP4 (M4A, MOV), AAC, MP3, Ogg (Vorbis), AIFF and CAF";

/// Endings of the names of recordings: of those that are read, and of those for which it is told how to convert them.
const ENDINGS: [&str; 29] = [
    "wav", "wave", "m4a", "mp4", "mov", "aac", "mp3", "flac", "ogg", "oga", "opus", "webm", "mka",
    "mkv", "amr", "3gp", "3ga", "wma", "aif", "aiff", "aifc", "caf", "qta", "avi", "w64", "au",
    "wv", "ape", "mp2",
];

/// Whether the name of a file says that it should be a recording.
#[must_use]
pub fn has_ending(path: &Path) -> bool {
    let of = path.extension().and_then(OsStr::to_str);
    of.is_some_and(|of| ENDINGS.iter().any(|ending| ending.eq_ignore_ascii_case(of)))
}

/// Whether a file begins as a recording does, read or refused with a reason.
#[must_use]
pub fn could_be_recording(head: &[u8]) -> bool {
    match Content::of(head) {
        Content::Wav => matches!(head.get(8..12), Some(b"WAVE")),
        // Two bytes or three at the beginning of a file say little: these are known by their names.
        Content::Mp3 | Content::Adts | Content::Tagged => false,
        _ => true,
    }
}

/// What a recording is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Content {
    /// WAV and its kin; also what is nothing known, for the walk over its chunks says what is not a WAV about it.
    Wav,
    /// MPEG-4 and `QuickTime`: AAC, ALAC or PCM in it.
    Mp4,
    /// AAC in frames of its own (ADTS).
    Adts,
    /// MPEG audio.
    Mp3,
    /// A tag (`ID3v2`), with MP3, AAC or FLAC behind it.
    Tagged,
    Flac,
    /// Vorbis or Opus in an Ogg.
    Ogg,
    /// Matroska or `WebM`.
    Matroska,
    Aiff,
    /// A Core Audio file.
    Caf,
    Refused(Refused),
}

/// What is known and not read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Refused {
    name: &'static str,
    ending: &'static str,
}

impl Refused {
    pub(super) const fn new(name: &'static str, ending: &'static str) -> Self {
        Self { name, ending }
    }

    /// What it is, and the command that converts it.
    pub(super) fn sentence(self) -> String {
        format!(
            "it is {}, which is not read; ffmpeg -i IN.{} OUT.wav converts it",
            self.name, self.ending
        )
    }
}

impl Content {
    pub(super) fn of(head: &[u8]) -> Self {
        let refused = |name, ending| Self::Refused(Refused::new(name, ending));
        match head {
            [b'f', b'L', b'a', b'C', ..] => Self::Flac,
            [b'O', b'g', b'g', b'S', ..] => ogg(head),
            [_, _, _, _, b'f', b't', b'y', b'p', ..] => Self::Mp4,
            [b'I', b'D', b'3', ..] => Self::Tagged,
            [b'#', b'!', b'A', b'M', b'R', ..] => refused("AMR", "amr"),
            [0x1A, 0x45, 0xDF, 0xA3, ..] => Self::Matroska,
            [0x30, 0x26, 0xB2, 0x75, ..] => refused("Windows Media", "wma"),
            [b'F', b'O', b'R', b'M', _, _, _, _, b'A', b'I', b'F', ..] => Self::Aiff,
            [b'c', b'a', b'f', b'f', ..] => Self::Caf,
            [
                b'R',
                b'I',
                b'F',
                b'F',
                _,
                _,
                _,
                _,
                b'A',
                b'V',
                b'I',
                b' ',
                ..,
            ] => refused("AVI", "avi"),
            // The other forms of RIFF are in capitals.
            [b'r', b'i', b'f', b'f', ..] => refused("Wave64", "w64"),
            [b'.', b's', b'n', b'd', ..] => refused("a Sun audio file", "au"),
            [b'w', b'v', b'p', b'k', ..] => refused("WavPack", "wv"),
            [b'M', b'A', b'C', b' ', ..] => refused("Monkey's Audio", "ape"),
            // An MP4 of QuickTime may begin without the atom that says so.
            [_, _, _, _, b'm', b'o', b'o', b'v', ..] => {
                refused("QuickTime without its type", "mov")
            }
            [0xFF, second, ..] if second & 0xF6 == 0xF0 => Self::Adts,
            [0xFF, second, ..] if second & 0xE6 == 0xE2 => Self::Mp3,
            [0xFF, 0xFC | 0xFD | 0xF4 | 0xF5, ..] => refused("MPEG audio of layer II", "mp2"),
            _ => Self::Wav,
        }
    }
}

/// The codec of the first stream in an Ogg: its first page holds nothing else.
fn ogg(head: &[u8]) -> Content {
    let refused = |name, ending| Content::Refused(Refused::new(name, ending));
    match head.get(28..).unwrap_or_default() {
        [1, b'v', b'o', b'r', b'b', b'i', b's', ..] | [b'O', b'p', b'u', b's', ..] => Content::Ogg,
        [b'S', b'p', b'e', b'e', b'x', ..] => refused("Speex", "ogg"),
        [0x7F, b'F', b'L', b'A', b'C', ..] => refused("FLAC in an Ogg", "ogg"),
        _ => refused("an Ogg without Vorbis or Opus", "ogg"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn content_is_told_by_the_first_bytes() {
        for (head, content) in [
            (&b"RIFF\0\0\0\0WAVE"[..], Content::Wav),
            (b"", Content::Wav),
            (b"notes", Content::Wav),
            (b"fLaC\0", Content::Flac),
            (b"\0\0\0\x20ftypM4A ", Content::Mp4),
            (b"ID3\x04", Content::Tagged),
            (b"\xFF\xF1\x50\x80", Content::Adts),
            (b"\xFF\xF9\x50\x80", Content::Adts),
            (b"\xFF\xFB\x90\x64", Content::Mp3),
            (b"\xFF\xE3\x18\xC4", Content::Mp3),
            (b"FORM\0\0\0\0AIFC", Content::Aiff),
            (b"caff\0\x01", Content::Caf),
            (b"\x1A\x45\xDF\xA3", Content::Matroska),
            (
                b"OggS\0\x02\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x01\x13OpusHead",
                Content::Ogg,
            ),
        ] {
            assert_eq!(Content::of(head), content, "{head:?}");
        }
        for head in [
            &b"#!AMR\n"[..],
            b"#!AMR-WB\n",
            b"RIFF\0\0\0\0AVI LIST",
            b"riff\x2E\x91\xCF\x11",
            b"OggS",
            b"\xFF\xFD\x90\x64",
            b".snd\0\0\0\x18",
            b"wvpk",
            b"MAC \x96\x0F",
            b"\x30\x26\xB2\x75",
            b"\0\0\0\x08moov",
        ] {
            let Content::Refused(what) = Content::of(head) else {
                panic!("{head:?}");
            };
            // Files of such a name are offered the command that was meant, and are found in a folder.
            assert!(has_ending(&Path::new("drop").with_extension(what.ending)));
            assert!(could_be_recording(head) || head[0] == 0xFF);
        }
    }
}
