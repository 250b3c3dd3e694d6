//! Tracks of pictures in an MP4, which are not looked at.
//!
//! symphonia 0.6.1 reads how pictures are coded, and gives up the file where that takes more than 1 kB, as with H.265.

use super::atoms::{atoms, child};

/// The kind of an atom that is passed over.
pub(super) const PASSED_OVER: &[u8; 4] = b"free";

/// Where the kinds of the tracks of pictures stand in an index, to be read as [`PASSED_OVER`]. None in a file of fragments:
/// each fragment names the tracks.
pub(super) fn kinds(index: &[u8]) -> Vec<usize> {
    if child(index, b"mvex").is_some() {
        return Vec::new();
    }
    let tracks = atoms(index).filter(|atom| atom.kind == *b"trak");
    let of_pictures = tracks.filter(|track| is_of_pictures(track.body));
    of_pictures.map(|track| track.at + 4).collect()
}

/// Whether the handler of a track (`mdia/hdlr`) is that of pictures.
fn is_of_pictures(track: &[u8]) -> bool {
    let handler = child(track, b"mdia").and_then(|media| child(media, b"hdlr"));
    handler.and_then(|h| h.get(8..12)) == Some(b"vide")
}

#[cfg(test)]
mod tests {
    use super::super::atoms::atom;
    use super::*;

    fn track(handler: &[u8; 4]) -> Vec<u8> {
        let handler = [&[0; 8][..], handler, &[0; 12]].concat();
        atom(b"trak", &atom(b"mdia", &atom(b"hdlr", &handler)))
    }

    #[test]
    fn only_tracks_of_pictures_are_hidden_and_none_of_a_file_of_fragments() {
        let sound = track(b"soun");
        let index = [sound.clone(), track(b"vide"), atom(b"udta", b"?")].concat();
        let kind = sound.len() + 4;
        assert_eq!(kinds(&index), [kind]);
        assert_eq!(&index[kind..kind + 4], b"trak");
        let fragments = [index, atom(b"mvex", b"")].concat();
        assert!(kinds(&fragments).is_empty() && kinds(&sound).is_empty());
    }

    #[test]
    fn an_index_that_is_cut_or_damaged_anywhere_is_read_without_a_panic() {
        let index = [track(b"vide"), track(b"soun")].concat();
        for at in 0..index.len() {
            kinds(&index[..at]);
            for byte in [0, 1, 0x7F, 0xFF] {
                let mut damaged = index.clone();
                damaged[at] = byte;
                kinds(&damaged);
            }
        }
    }
}
