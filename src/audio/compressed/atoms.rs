//! Atoms: what an MP4 is made of, each a length, a kind and a body, which may hold atoms again.

/// The header of an atom.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Head {
    pub kind: [u8; 4],
    /// Bytes of this header.
    pub bytes: usize,
    /// Bytes of the atom with its header; none if it goes to the end.
    pub length: Option<u64>,
}

impl Head {
    /// The header that bytes begin with; none if they are too few or contradict themselves.
    pub(super) fn of(bytes: &[u8]) -> Option<Self> {
        let short = u32_at(bytes, 0)?;
        let kind = *bytes.get(4..)?.first_chunk()?;
        let (bytes, length) = match short {
            0 => (8, None),
            1 => (16, Some(u64_at(bytes, 8)?)),
            short => (8, Some(u64::from(short))),
        };
        let is_whole = length.is_none_or(|length| length >= bytes as u64);
        is_whole.then_some(Self {
            kind,
            bytes,
            length,
        })
    }
}

/// An atom in memory.
#[derive(Debug, Clone, Copy)]
pub(super) struct Atom<'b> {
    pub kind: [u8; 4],
    /// Where it begins among those it stands with.
    pub at: usize,
    pub body: &'b [u8],
}

/// Atoms that follow each other, up to the first that is broken.
pub(super) struct Atoms<'b> {
    bytes: &'b [u8],
    next: usize,
}

/// The atoms that bytes consist of.
pub(super) const fn atoms(bytes: &[u8]) -> Atoms<'_> {
    Atoms { bytes, next: 0 }
}

impl<'b> Iterator for Atoms<'b> {
    type Item = Atom<'b>;

    fn next(&mut self) -> Option<Self::Item> {
        let at = self.next;
        let rest = self.bytes.get(at..)?;
        let head = Head::of(rest)?;
        let length = match head.length {
            Some(length) => usize::try_from(length).ok()?,
            None => rest.len(),
        };
        let body = rest.get(head.bytes..length)?;
        self.next = at + length;
        Some(Atom {
            kind: head.kind,
            at,
            body,
        })
    }
}

/// The body of the first atom of a kind in the body of another.
pub(super) fn child<'b>(body: &'b [u8], kind: &[u8; 4]) -> Option<&'b [u8]> {
    let of_kind = atoms(body).find(|atom| atom.kind == *kind);
    of_kind.map(|atom| atom.body)
}

/// The number behind the two dates of an atom: units per second (`mvhd`, `mdhd`) or that of the track (`tkhd`).
pub(super) fn behind_dates(body: &[u8]) -> Option<u32> {
    u32_at(body, dates_end(body)?)
}

/// Where the two dates of an atom end, whose length depends on its version.
pub(super) fn dates_end(body: &[u8]) -> Option<usize> {
    match body.first()? {
        0 => Some(12),
        1 => Some(20),
        _ => None,
    }
}

/// Four bytes as a number.
pub(super) fn u32_at(bytes: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_be_bytes(*bytes.get(at..)?.first_chunk()?))
}

/// Eight bytes as a number.
pub(super) fn u64_at(bytes: &[u8], at: usize) -> Option<u64> {
    Some(u64::from_be_bytes(*bytes.get(at..)?.first_chunk()?))
}

/// An atom of a kind with a body, for tests.
#[cfg(test)]
pub(super) fn atom(kind: &[u8; 4], body: &[u8]) -> Vec<u8> {
    let length = u32::try_from(8 + body.len()).unwrap();
    [&length.to_be_bytes(), &kind[..], body].concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn atoms_are_walked_up_to_the_first_that_is_broken() {
        let long = [&b"\0\0\0\x01long"[..], &18_u64.to_be_bytes(), b"ab"].concat();
        let open = b"\0\0\0\0openrest";
        let bytes = [&atom(b"free", b"")[..], &long, open].concat();
        let walk = |bytes| -> Vec<([u8; 4], usize, Vec<u8>)> {
            let each = atoms(bytes).map(|a| (a.kind, a.at, a.body.to_vec()));
            each.collect()
        };
        let all = walk(&bytes);
        let expected: [([u8; 4], usize, &[u8]); 3] = [
            (*b"free", 0, b""),
            (*b"long", 8, b"ab"),
            (*b"open", 26, b"rest"),
        ];
        assert_eq!(all.len(), 3);
        for ((kind, at, body), (its_kind, its_at, its_body)) in all.iter().zip(expected) {
            assert_eq!((*kind, *at, &body[..]), (its_kind, its_at, its_body));
        }
        assert_eq!(walk(&bytes[..25]), all[..1]);
        // A length that is less than that of the header.
        assert!(walk(b"\0\0\0\x07free").is_empty());
        assert_eq!(child(&bytes, b"long"), Some(&b"ab"[..]));
        assert_eq!(child(&bytes, b"none"), None);
    }
}
