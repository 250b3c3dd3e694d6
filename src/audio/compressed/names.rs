//! What the index of an MP4 calls its tracks: their language (`mdia/mdhd`) and name (`udta/name`), for people to choose by.

use super::atoms::{atoms, behind_dates, child, dates_end};

/// Characters of a name that are told at most.
const MOST_CHARS: usize = 40;

/// The words for each track that has some.
#[derive(Debug, Default)]
pub(super) struct Names(Vec<(u32, Vec<String>)>);

impl Names {
    /// Those in an index.
    pub(super) fn of(index: &[u8]) -> Self {
        let tracks = atoms(index).filter(|atom| atom.kind == *b"trak");
        let named = tracks.filter_map(|track| {
            let number = behind_dates(child(track.body, b"tkhd")?)?;
            let words = [name(track.body), language(track.body)];
            Some((number, words.into_iter().flatten().collect()))
        });
        Self(named.collect())
    }

    /// The words for a track.
    pub(super) fn words(&self, track: u32) -> &[String] {
        let of = self.0.iter().find(|(number, _)| *number == track);
        of.map_or(&[], |(_, words)| words)
    }
}

/// The name that a person gave to a track. It is shown on terminals: what could steer them is left out.
fn name(track: &[u8]) -> Option<String> {
    let bytes = child(child(track, b"udta")?, b"name")?;
    let text = String::from_utf8_lossy(bytes);
    let shown = text.chars().filter(|c| !c.is_control()).take(MOST_CHARS);
    let name = shown.collect::<String>().trim().to_owned();
    (!name.is_empty()).then_some(name)
}

/// The language of a track: three letters of five bits each (ISO 639-2); none where it is not determined, or an old number.
fn language(track: &[u8]) -> Option<String> {
    let header = child(child(track, b"mdia")?, b"mdhd")?;
    // Units per second, and the length, which is twice as long where the dates are.
    let length_bytes = if header[0] == 0 { 4 } else { 8 };
    let code = header.get(dates_end(header)? + 4 + length_bytes..)?;
    let code = u16::from_be_bytes(*code.first_chunk()?);
    let letters = [10, 5, 0].map(|shift| (code >> shift & 31) as u8 + b'`');
    let is_word = letters.iter().all(u8::is_ascii_lowercase) && letters != *b"und";
    is_word.then(|| letters.map(char::from).iter().collect())
}

#[cfg(test)]
mod tests {
    use super::super::atoms::atom;
    use super::*;

    fn track(version: u8, number: u32, code: u16, name: &[u8]) -> Vec<u8> {
        let dates = vec![7; if version == 0 { 8 } else { 16 }];
        let length = vec![9; if version == 0 { 4 } else { 8 }];
        let head = [&[version, 0, 0, 0][..], &dates].concat();
        let number = number.to_be_bytes();
        let media = [&head[..], &[0; 4], &length, &code.to_be_bytes(), &[0; 2]].concat();
        let parts = [
            atom(b"tkhd", &[&head[..], &number].concat()),
            atom(b"mdia", &atom(b"mdhd", &media)),
            atom(b"udta", &atom(b"name", name)),
        ];
        atom(b"trak", &parts.concat())
    }

    /// As it is packed: each letter as its place in the alphabet.
    fn packed(letters: [u8; 3]) -> u16 {
        letters
            .iter()
            .fold(0, |sum, l| sum << 5 | u16::from(l - b'`'))
    }

    #[test]
    fn a_track_is_called_by_its_name_and_language() {
        let index = [
            track(0, 1, packed(*b"eng"), b"Lapel"),
            track(1, 2, packed(*b"deu"), b""),
            track(0, 3, packed(*b"und"), b"a\x1b[31m red\n"),
            track(0, 4, 0, b" "),
        ]
        .concat();
        let names = Names::of(&index);
        assert_eq!(names.words(1), ["Lapel", "eng"]);
        assert_eq!(names.words(2), ["deu"]);
        assert_eq!(names.words(3), ["a[31m red"]);
        assert!(names.words(4).is_empty() && names.words(5).is_empty());
        for at in 0..index.len() {
            Names::of(&index[..at]);
            let mut damaged = index.clone();
            damaged[at] = 0xFF;
            Names::of(&damaged);
        }
    }
}
