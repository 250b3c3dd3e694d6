//! Edit lists of an MP4: where in the stream of a track its presentation begins.
//!
//! What an encoder put before the first sample (of AAC 1024 samples and more), and a beginning that was cut off without its
//! bytes being taken away, stand in the stream and are hidden by the edit list of the track (`moov/trak/edts/elst`,
//! ISO/IEC 14496-12, 8.6.6). Its first entry that is not empty says from where the stream is presented, in units of the
//! track (`mdhd`), and empty ones before it how much later that is, in units of the movie (`mvhd`).

use super::atoms::{Atom, atoms, behind_dates, child, u32_at, u64_at};
use super::start::{Span, Start};

/// Where each track begins that has an edit list which can be followed.
#[derive(Debug, Default)]
pub(super) struct Edits(Vec<(u32, Start)>);

impl Edits {
    /// The edit lists in an index; what is broken is left out.
    pub(super) fn of(index: &[u8]) -> Self {
        let movie = child(index, b"mvhd").and_then(behind_dates);
        let tracks = atoms(index).filter(|atom| atom.kind == *b"trak");
        let starts = tracks.filter_map(|Atom { body, .. }| start(body, movie?));
        Self(starts.collect())
    }

    /// Where a track begins; at its first sample if nothing else is known.
    pub(super) fn start(&self, track: u32) -> Start {
        let of = self.0.iter().find(|(number, _)| *number == track);
        of.map_or_else(Start::default, |(_, start)| *start)
    }
}

/// The number of a track and where it begins, of a movie with so many units per second.
fn start(track: &[u8], movie_units_per_s: u32) -> Option<(u32, Start)> {
    let number = behind_dates(child(track, b"tkhd")?)?;
    let units_per_s = behind_dates(child(child(track, b"mdia")?, b"mdhd")?)?;
    let (empty, from) = beginning(child(child(track, b"edts")?, b"elst")?)?;
    let start = Start {
        later: Span::new(empty, movie_units_per_s)?,
        hidden: Span::new(from, units_per_s)?,
    };
    Some((number, start))
}

/// How long the empty entries at the head of an edit list last, and from where the first other is presented.
///
/// None if the list is cut, if an entry is presented faster or slower than it was recorded, or if nothing is presented.
fn beginning(list: &[u8]) -> Option<(u64, u64)> {
    let is_long = match list.first()? {
        0 => false,
        1 => true,
        _ => return None,
    };
    let entries = list
        .get(8..)?
        .chunks_exact(if is_long { 20 } else { 12 })
        .take(usize::try_from(u32_at(list, 4)?).ok()?);
    let mut empty = 0_u64;
    for entry in entries {
        let (lasts, from, rate) = if is_long {
            let from = u64_at(entry, 8)?.cast_signed();
            (u64_at(entry, 0)?, from, u32_at(entry, 16)?)
        } else {
            let from = i64::from(u32_at(entry, 4)?.cast_signed());
            (u64::from(u32_at(entry, 0)?), from, u32_at(entry, 8)?)
        };
        match (from, rate) {
            (-1, _) => empty = empty.checked_add(lasts)?,
            (from, RATE) => return Some((empty, u64::try_from(from).ok()?)),
            _ => return None,
        }
    }
    None
}

/// The rate of an entry that is presented as it was recorded: one, with 16 binary places.
const RATE: u32 = 1 << 16;

#[cfg(test)]
mod tests {
    use super::super::atoms::atom;
    use super::*;

    /// An atom with two dates before a number, of either version.
    fn dated(kind: &[u8; 4], version: u8, number: u32) -> Vec<u8> {
        let dates = vec![7; if version == 0 { 8 } else { 16 }];
        let body = [
            &[version, 0, 0, 0],
            &dates[..],
            &number.to_be_bytes(),
            &[0; 8],
        ];
        atom(kind, &body.concat())
    }

    fn short(entries: &[(u32, i32, u32)]) -> Vec<u8> {
        let mut list = vec![0; 4];
        list.extend(u32::try_from(entries.len()).unwrap().to_be_bytes());
        for (lasts, from, rate) in entries {
            list.extend([lasts.to_be_bytes(), from.to_be_bytes(), rate.to_be_bytes()].concat());
        }
        list
    }

    fn long(lasts: u64, from: i64) -> Vec<u8> {
        let entry = [lasts.to_be_bytes(), from.to_be_bytes()].concat();
        [&[1, 0, 0, 0, 0, 0, 0, 1], &entry[..], &RATE.to_be_bytes()].concat()
    }

    fn track(version: u8, number: u32, units_per_s: u32, list: &[u8]) -> Vec<u8> {
        let parts = [
            dated(b"tkhd", version, number),
            atom(b"edts", &atom(b"elst", list)),
            atom(b"mdia", &dated(b"mdhd", version, units_per_s)),
        ];
        atom(b"trak", &parts.concat())
    }

    fn start(later: u64, hidden: u64) -> Start {
        Start {
            later: Span::new(later, 600).unwrap(),
            hidden: Span::new(hidden, 44_100).unwrap(),
        }
    }

    #[test]
    fn each_track_begins_where_its_own_list_says() {
        let index = [
            dated(b"mvhd", 0, 600),
            track(0, 1, 44_100, &short(&[(900, 1_826, RATE)])),
            atom(b"udta", b"?"),
            track(1, 2, 44_100, &long(900, 5_000_000_000)),
            track(
                0,
                3,
                44_100,
                &short(&[(30, -1, RATE), (900, 0, RATE), (9, 7, RATE)]),
            ),
        ]
        .concat();
        let edits = Edits::of(&index);
        assert_eq!(edits.start(1), start(0, 1_826));
        assert_eq!(edits.start(2), start(0, 5_000_000_000));
        assert_eq!(edits.start(3), start(30, 0));
        assert_eq!(edits.start(4), Start::default());
    }

    #[test]
    fn a_list_that_cannot_be_followed_is_none() {
        let cut = short(&[(900, 1_826, RATE)]);
        for list in [
            short(&[]),
            short(&[(900, 1_826, 2 * RATE)]),
            short(&[(900, 1_826, 0)]),
            short(&[(900, -2, RATE)]),
            short(&[(900, -1, RATE)]),
            long(900, i64::MIN),
            [&[2], &cut[1..]].concat(),
            cut[..cut.len() - 1].to_vec(),
            cut[..6].to_vec(),
            Vec::new(),
        ] {
            assert_eq!(beginning(&list), None, "{list:?}");
        }
        // A count that is too large does not hide the entries that are there.
        let many = [&[0, 0, 0, 0, 0xFF, 0xFF, 0xFF, 0xFF], &cut[8..]].concat();
        assert_eq!(beginning(&many), Some((0, 1_826)));
    }

    #[test]
    fn an_index_that_is_cut_or_damaged_anywhere_is_read_without_a_panic() {
        let index = [
            dated(b"mvhd", 0, 600),
            track(1, 1, 44_100, &long(900, 1_826)),
        ]
        .concat();
        for at in 0..index.len() {
            assert_eq!(Edits::of(&index[..at]).start(1), Start::default());
            for byte in [0, 1, 0x7F, 0xFF] {
                let mut damaged = index.clone();
                damaged[at] = byte;
                Edits::of(&damaged).start(1).hidden.frames(48_000);
            }
        }
        let no_units = [dated(b"mvhd", 0, 600), track(0, 1, 0, &long(900, 1_826))].concat();
        assert_eq!(Edits::of(&no_units).start(1), Start::default());
    }
}
