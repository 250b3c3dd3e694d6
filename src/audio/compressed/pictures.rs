//! Tracks of pictures in an MP4, which are not looked at.
//!
//! symphonia 0.6.1 reads how pictures are coded, and gives up the file where that takes more than 1 kB, as with H.265.

use super::index::Head;

/// Gives tracks of pictures the name of an atom that is passed over; whether there were any. In a file of fragments they stay:
/// each fragment names the tracks.
pub(super) fn hide(index: &mut [u8]) -> bool {
    if atoms(index).any(|(head, _)| head.kind == *b"mvex") {
        return false;
    }
    let tracks = atoms(index).filter(|(head, _)| head.kind == *b"trak");
    let of_pictures = tracks.filter(|(head, at)| is_of_pictures(body(index, *head, *at)));
    let places: Vec<usize> = of_pictures.map(|(_, at)| at).collect();
    for at in &places {
        index[at + 4..at + 8].copy_from_slice(b"free");
    }
    !places.is_empty()
}

/// Whether the handler of a track (`mdia/hdlr`) is that of pictures.
fn is_of_pictures(track: &[u8]) -> bool {
    let child = |of, kind: &[u8; 4]| {
        let (head, at) = atoms(of).find(|(head, _)| head.kind == *kind)?;
        Some(body(of, head, at))
    };
    let handler = child(track, b"mdia").and_then(|media| child(media, b"hdlr"));
    handler.and_then(|h| h.get(8..12)) == Some(b"vide")
}

/// Atoms that follow each other, with where they begin.
fn atoms(bytes: &[u8]) -> impl Iterator<Item = (Head, usize)> {
    let mut next = 0;
    std::iter::from_fn(move || {
        let at = next;
        let head = Head::of(bytes.get(at..)?)?;
        let length = usize::try_from(head.length?).ok()?;
        next = at.checked_add(length)?;
        (next <= bytes.len()).then_some((head, at))
    })
}

/// The body of an atom that begins somewhere.
fn body(bytes: &[u8], head: Head, at: usize) -> &[u8] {
    let length = head.length.and_then(|length| usize::try_from(length).ok());
    let end = length.map_or(bytes.len(), |length| at + length);
    bytes.get(at + head.bytes..end).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn atom(kind: &[u8; 4], body: &[u8]) -> Vec<u8> {
        let length = u32::try_from(8 + body.len()).unwrap();
        [&length.to_be_bytes(), &kind[..], body].concat()
    }

    fn track(handler: &[u8; 4]) -> Vec<u8> {
        let handler = [&[0; 8][..], handler, &[0; 12]].concat();
        atom(b"trak", &atom(b"mdia", &atom(b"hdlr", &handler)))
    }

    #[test]
    fn only_tracks_of_pictures_are_hidden_and_none_of_a_file_of_fragments() {
        let sound = track(b"soun");
        let mut index = [sound.clone(), track(b"vide"), atom(b"udta", b"?")].concat();
        let before = index.clone();
        assert!(hide(&mut index));
        let changed = sound.len() + 4..sound.len() + 8;
        assert_eq!(&index[changed.clone()], b"free");
        index[changed].copy_from_slice(b"trak");
        assert_eq!(index, before);
        let mut fragments = [before, atom(b"mvex", b"")].concat();
        assert!(!hide(&mut fragments) && !hide(&mut sound.clone()));
    }

    #[test]
    fn an_index_that_is_cut_or_damaged_anywhere_is_read_without_a_panic() {
        let index = [track(b"vide"), track(b"soun")].concat();
        for at in 0..index.len() {
            hide(&mut index.clone()[..at]);
            for byte in [0, 1, 0x7F, 0xFF] {
                let mut damaged = index.clone();
                damaged[at] = byte;
                hide(&mut damaged);
            }
        }
    }
}
