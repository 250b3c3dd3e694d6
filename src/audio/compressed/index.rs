//! The index of an MP4 (`moov`), looked at before symphonia takes the file apart.
//!
//! symphonia reads edit lists and keeps them to itself. From a file the index is read where it stands, from a pipe only if it
//! comes before the sound, as symphonia itself needs it there.

use std::io::{self, Cursor, Read, Seek, SeekFrom};

use symphonia::core::io::MediaSource;

use super::atoms::Head;
use super::overlaid::Overlaid;
use super::pictures::{self, PASSED_OVER};
use super::source::Source;

/// Bytes of an index at most, and of what a pipe has before it: that of an hour of video takes 2 MiB.
const MOST_BYTES: u64 = 1 << 26;
/// Atoms that are passed at most: an hour in fragments of half a second has 14,400.
pub(super) const MOST_ATOMS: usize = 1 << 20;
/// Bytes of the header of an atom that has a long length.
pub(super) const HEAD_BYTES: u64 = 16;

/// What stands in the index, empty if there is none within reach, and the source at its beginning again.
///
/// # Errors
/// [`io::Error`] if reading fails.
pub(super) fn index(source: Source<'_>) -> io::Result<(Vec<u8>, Source<'_>)> {
    match source {
        Source::Seekable(mut inner) => {
            let (index, from) = sought(&mut inner)?;
            inner.seek(SeekFrom::Start(0))?;
            let kinds = pictures::kinds(&index).into_iter();
            let places: Vec<u64> = kinds.map(|at| from.saturating_add(at as u64)).collect();
            let inner: Box<dyn MediaSource> = if places.is_empty() {
                inner
            } else {
                Box::new(Overlaid::new(inner, places, PASSED_OVER))
            };
            Ok((index, Source::Seekable(inner)))
        }
        Source::Pipe(mut inner) => {
            let (from, mut read) = piped(&mut inner)?;
            let index = read[from..].to_vec();
            for at in pictures::kinds(&index) {
                read[from + at..from + at + 4].copy_from_slice(PASSED_OVER);
            }
            let source = Source::Pipe(Box::new(Cursor::new(read).chain(inner)));
            Ok((index, source))
        }
    }
}

/// The body of the index, past atoms that are not read, and where it begins.
fn sought(source: &mut (impl Read + Seek)) -> io::Result<(Vec<u8>, u64)> {
    let mut at = 0;
    for _ in 0..MOST_ATOMS {
        source.seek(SeekFrom::Start(at))?;
        let mut bytes = Vec::new();
        append(source, HEAD_BYTES, &mut bytes)?;
        let Some(head) = Head::of(&bytes) else { break };
        if head.kind == *b"moov" {
            let body = at.saturating_add(head.bytes as u64);
            source.seek(SeekFrom::Start(body))?;
            let mut index = Vec::new();
            append(source, body_bytes(head), &mut index)?;
            return Ok((index, body));
        }
        match head.length.and_then(|length| at.checked_add(length)) {
            Some(next) => at = next,
            None => break,
        }
    }
    Ok((Vec::new(), at))
}

/// Where the body of the index begins in what was read for it, and goes on to the end of that.
fn piped(source: &mut impl Read) -> io::Result<(usize, Vec<u8>)> {
    let mut read = Vec::new();
    while (read.len() as u64) < MOST_BYTES {
        let at = read.len();
        append(source, 8, &mut read)?;
        if read[at..].starts_with(&[0, 0, 0, 1]) {
            append(source, 8, &mut read)?;
        }
        let Some(head) = Head::of(&read[at..]) else {
            break;
        };
        if matches!(&head.kind, b"mdat" | b"moof") || head.length.is_none() {
            break;
        }
        append(source, body_bytes(head), &mut read)?;
        if head.kind == *b"moov" {
            return Ok((at + head.bytes, read));
        }
    }
    Ok((read.len(), read))
}

/// Bytes of an atom behind its header, as many as are looked at.
fn body_bytes(head: Head) -> u64 {
    head.length.map_or(MOST_BYTES, |length| {
        MOST_BYTES.min(length - head.bytes as u64)
    })
}

/// Adds so many bytes, fewer at the end.
fn append(source: &mut impl Read, count: u64, to: &mut Vec<u8>) -> io::Result<()> {
    source.take(count).read_to_end(to)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::atoms::atom;
    use super::*;

    /// What is found in bytes, as a file and as a pipe; all of them have to come again.
    fn found(bytes: &[u8]) -> [Vec<u8>; 2] {
        let file = Source::seekable(Cursor::new(bytes)).unwrap();
        [file, Source::Pipe(Box::new(bytes))].map(|source| {
            let (index, mut source) = index(source).unwrap();
            let mut again = Vec::new();
            source.read_to_end(&mut again).unwrap();
            assert_eq!(again, bytes);
            index
        })
    }

    #[test]
    fn an_index_before_the_sound_is_found_in_a_file_and_a_pipe() {
        let sound = atom(b"mdat", b"sound");
        let before = [atom(b"ftyp", b"M4A "), atom(b"free", b"")].concat();
        let short = [before.clone(), atom(b"moov", b"index"), sound.clone()].concat();
        assert_eq!(found(&short), [b"index", b"index"]);
        let long = [&b"\0\0\0\x01moov\0\0\0\0\0\0\0\x15index"[..], &sound].concat();
        assert_eq!(found(&[before, long].concat()), [b"index", b"index"]);
    }

    #[test]
    fn an_index_behind_the_sound_is_found_in_a_file_only() {
        let bytes = [atom(b"mdat", b"sound"), atom(b"moov", b"index")].concat();
        assert_eq!(found(&bytes), [&b"index"[..], b""]);
    }

    #[test]
    fn what_is_broken_has_no_index_or_what_is_left_of_it() {
        for bytes in [
            &b""[..],
            b"\0\0",
            b"\0\0\0\x07ftyp",
            b"\0\0\0\x01ftyp\0\0",
            b"\0\0\0\x01ftyp\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF",
            b"\0\0\0\0free\0\0\0\x09moovi",
        ] {
            assert_eq!(found(bytes), [b"", b""], "{bytes:?}");
        }
        assert_eq!(found(b"\xFF\xFF\xFF\xFFmoovind"), [b"ind", b"ind"]);
    }
}
