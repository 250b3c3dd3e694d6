//! A file some bytes of which are read as others.

use std::io::{self, Read, Seek, SeekFrom};

use symphonia::core::io::MediaSource;

/// A source with other bytes in place of some of its own.
pub(super) struct Overlaid<'s> {
    inner: Box<dyn MediaSource + 's>,
    from: u64,
    bytes: Vec<u8>,
    at: u64,
}

impl<'s> Overlaid<'s> {
    /// The bytes stand in place of as many from a position on; the source stands at its beginning.
    pub(super) fn new(inner: Box<dyn MediaSource + 's>, from: u64, bytes: Vec<u8>) -> Self {
        Self {
            inner,
            from,
            bytes,
            at: 0,
        }
    }
}

impl Read for Overlaid<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let got = self.inner.read(buffer)?;
        for (k, byte) in buffer[..got].iter_mut().enumerate() {
            let within = (self.at + k as u64).checked_sub(self.from);
            let within = within.and_then(|k| usize::try_from(k).ok());
            if let Some(other) = within.and_then(|k| self.bytes.get(k)) {
                *byte = *other;
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
        let mut laid = Overlaid::new(Box::new(Cursor::new(b"0123456789")), 3, b"abc".to_vec());
        for (from, count, expected) in [
            (0, 10, &b"012abc6789"[..]),
            (4, 2, b"bc"),
            (5, 3, b"c67"),
            (9, 4, b"9"),
        ] {
            laid.seek(SeekFrom::Start(from)).unwrap();
            let mut read = Vec::new();
            (&mut laid).take(count).read_to_end(&mut read).unwrap();
            assert_eq!(read, expected);
        }
    }
}
