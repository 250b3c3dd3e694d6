//! The code of a source file: what the compiler sees, without its text, comments and tests.

/// The source with comments, strings, characters and items under `#[cfg(test)]` replaced by spaces. Its bytes stand where
/// they stood, so places in it are places in the source.
pub(crate) fn code(source: &str) -> String {
    let mut bytes = source.as_bytes().to_vec();
    let mut at = 0;
    while at < bytes.len() {
        let end = end_of_prose(source, at);
        blank(&mut bytes, at, end);
        at = end.max(at + 1);
    }
    blank_tests(&mut bytes);
    // Bytes of characters outside ASCII stand in comments and strings only, or are no name.
    bytes.iter().map(|b| char::from(*b & 0x7f)).collect()
}

fn blank(bytes: &mut [u8], from: usize, to: usize) {
    for byte in &mut bytes[from..to] {
        if *byte != b'\n' {
            *byte = b' ';
        }
    }
}

/// Where the comment, string or character ends that begins at a place; the place itself if none begins there.
fn end_of_prose(source: &str, at: usize) -> usize {
    let bytes = source.as_bytes();
    let rest = &bytes[at..];
    let after = |pattern: &[u8], from: usize| {
        let found = bytes[from..]
            .windows(pattern.len())
            .position(|w| w == pattern);
        found.map_or(bytes.len(), |i| from + i + pattern.len())
    };
    if rest.starts_with(b"//") {
        return after(b"\n", at) - 1;
    }
    if rest.starts_with(b"/*") {
        return after(b"*/", at + 2);
    }
    if rest.starts_with(b"r#\"") {
        return after(b"\"#", at + 3);
    }
    match rest[0] {
        b'"' => end_of_string(bytes, at),
        b'\'' => end_of_character(source, at),
        _ => at,
    }
}

fn end_of_string(bytes: &[u8], at: usize) -> usize {
    let mut end = at + 1;
    while end < bytes.len() && bytes[end] != b'"' {
        end += if bytes[end] == b'\\' { 2 } else { 1 };
    }
    (end + 1).min(bytes.len())
}

/// A quote begins a character if another follows it at once, and a lifetime if not.
fn end_of_character(source: &str, at: usize) -> usize {
    let mut characters = source[at + 1..].char_indices();
    match characters.next() {
        Some((_, '\\')) => {
            let end = source[at + 3..].find('\'');
            end.map_or(at, |i| at + 3 + i + 1)
        }
        Some(_) => match characters.next() {
            Some((i, '\'')) => at + 1 + i + 1,
            _ => at,
        },
        None => at,
    }
}

fn blank_tests(bytes: &mut [u8]) {
    const TEST: &[u8] = b"#[cfg(test)]";
    while let Some(at) = bytes.windows(TEST.len()).position(|w| w == TEST) {
        let end = end_of_item(bytes, at + TEST.len());
        blank(bytes, at, end);
    }
}

/// The end of the item that begins at a place: its semicolon, or the brace that closes its body.
fn end_of_item(bytes: &[u8], from: usize) -> usize {
    let (mut at, mut depth) = (from, 0_i32);
    while at < bytes.len() {
        match bytes[at] {
            b'{' | b'(' | b'[' => depth += 1,
            b'}' | b')' | b']' => depth -= 1,
            _ => {}
        }
        let body_closes = bytes[at] == b'}';
        at += 1;
        if depth == 0 && (body_closes || bytes[at - 1] == b';') {
            break;
        }
    }
    at
}

/// Whether a byte can stand in a name.
pub(crate) fn is_of_name(byte: u8) -> bool {
    byte == b'_' || byte.is_ascii_alphanumeric()
}

/// Places at which a name stands as a whole.
pub(crate) fn places(code: &str, name: &str) -> Vec<usize> {
    let bytes = code.as_bytes();
    let whole = |&at: &usize| {
        let before = at.checked_sub(1).is_none_or(|i| !is_of_name(bytes[i]));
        before && bytes.get(at + name.len()).is_none_or(|b| !is_of_name(*b))
    };
    code.match_indices(name)
        .map(|(at, _)| at)
        .filter(whole)
        .collect()
}

/// The first place from one on, outside of all brackets that open there, at which one of some bytes stands.
pub(crate) fn at_depth_0(code: &str, from: usize, wanted: &[u8]) -> Option<usize> {
    let mut depth = 0_i32;
    for (at, byte) in code.bytes().enumerate().skip(from) {
        if depth == 0 && wanted.contains(&byte) {
            return Some(at);
        }
        match byte {
            b'{' | b'(' | b'[' => depth += 1,
            b'}' | b')' | b']' => depth -= 1,
            _ => {}
        }
        if depth < 0 {
            return None;
        }
    }
    None
}
