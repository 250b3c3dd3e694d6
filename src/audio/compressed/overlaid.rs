//! A file some bytes of which are read as others.

use std::io::{self, Read, Seek, SeekFrom};

use symphonia::core::io::MediaSource;

/// A source in which four bytes are read as others, in a few places.
pub(super) struct Overlaid<'s> {
    inner: Box<dyn MediaSource + 's>,
    places: Vec<u64>,
    bytes: &'static [u8; 4],
    at: u64,
}

impl<'s> Overlaid<'s> {
    /// The bytes stand in place of those from each of the places on; the source stands at its beginning.
    pub(super) fn new(
        inner: Box<dyn MediaSource + 's>,
        places: Vec<u64>,
        bytes: &'static [u8; 4],
    ) -> Self {
        Self {
            inner,
            places,
            bytes,
            at: 0,
        }
    }
}

impl Read for Overlaid<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let got = self.inner.read(buffer)?;
        for place in &self.places {
            for (at, other) in (*place..).zip(self.bytes) {
                let within = at.checked_sub(self.at);
                let within = within.and_then(|k| usize::try_from(k).ok());
                if let Some(byte) = within.and_then(|k| buffer[..got].get_mut(k)) {
                    *byte = *other;
                }
            }
        }
        self.at += got as u64;
        Ok(got)
    }
}

impl Seek for Overlaid<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.at = self.inner.seek(to)?;
        Ok(self.at)
    }
}

impl MediaSource for Overlaid<'_> {
    fn is_seekable(&self) -> bool {
        self.inner.is_seekable()
    }

    fn byte_len(&self) -> Option<u64> {
        self.inner.byte_len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    #[test]
    fn other_bytes_are_read_where_they_are_laid_however_it_is_read() {
        let inner = Box::new(Cursor::new(b"0123456789ABCDEF"));
        let mut laid = Overlaid::new(inner, vec![2, 9], b"free");
        for (from, count, expected) in [
            (0, 16, &b"01free678freeDEF"[..]),
            (4, 2, b"ee"),
            (5, 5, b"e678f"),
            (12, 9, b"eDEF"),
        ] {
            laid.seek(SeekFrom::Start(from)).unwrap();
            let mut read = Vec::new();
            (&mut laid).take(count).read_to_end(&mut read).unwrap();
            assert_eq!(read, expected);
        }
    }
}
