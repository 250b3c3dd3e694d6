//! SHA-256 of a file (FIPS 180-4), so that a report says of which bytes it is.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Bytes read at once: whole blocks of the hash.
const READ: usize = 1 << 16;
/// Bytes of a block.
const BLOCK: usize = 64;
/// Where the length stands in the last block.
const LENGTH_AT: usize = 56;

/// The hash of a file in hexadecimal digits.
///
/// # Errors
/// If it cannot be read.
pub(super) fn of_file(path: &Path) -> io::Result<String> {
    of(File::open(path)?)
}

fn of(mut source: impl Read) -> io::Result<String> {
    let (constants, mut state) = (round_constants(), initial_state());
    let (mut bytes, mut length) = (Vec::new(), 0_u64);
    let mut piece = vec![0; READ];
    loop {
        let read = match source.read(&mut piece) {
            Err(e) if e.kind() == io::ErrorKind::Interrupted => continue,
            read => read?,
        };
        if read == 0 {
            break;
        }
        length += 8 * read as u64;
        bytes.extend_from_slice(&piece[..read]);
        let whole = bytes.len() / BLOCK * BLOCK;
        bytes[..whole]
            .chunks_exact(BLOCK)
            .for_each(|block| mix(&mut state, block, &constants));
        bytes.drain(..whole);
    }
    bytes.push(0x80);
    while bytes.len() % BLOCK != LENGTH_AT {
        bytes.push(0);
    }
    bytes.extend_from_slice(&length.to_be_bytes());
    bytes
        .chunks_exact(BLOCK)
        .for_each(|block| mix(&mut state, block, &constants));
    Ok(state.iter().map(|word| format!("{word:08x}")).collect())
}

/// The first 32 bits of the fraction of a root of a number: the square root for a power of 2, the cube root for 3.
///
/// # Formula
/// The greatest whole r with `r^power ≤ p·2^(32·power)`, modulo 2³².
fn root_fraction(p: u128, power: u32) -> u32 {
    let target = p << (32 * power);
    let (mut low, mut high) = (0_u128, 1_u128 << 36);
    while high - low > 1 {
        let middle = u128::midpoint(low, high);
        if middle.pow(power) <= target {
            low = middle;
        } else {
            high = middle;
        }
    }
    let bytes = low.to_be_bytes();
    u32::from_be_bytes([bytes[12], bytes[13], bytes[14], bytes[15]])
}

fn primes() -> impl Iterator<Item = u128> {
    (2_u128..).filter(|n| (2..*n).take_while(|d| d * d <= *n).all(|d| n % d != 0))
}

/// Of the cube roots of the first 64 primes.
fn round_constants() -> Vec<u32> {
    primes().take(64).map(|p| root_fraction(p, 3)).collect()
}

/// Of the square roots of the first eight primes.
fn initial_state() -> Vec<u32> {
    primes().take(8).map(|p| root_fraction(p, 2)).collect()
}

/// One block into the state.
fn mix(state: &mut [u32], block: &[u8], constants: &[u32]) {
    let mut words: Vec<u32> = block
        .chunks_exact(4)
        .map(|four| {
            four.iter()
                .fold(0, |word, byte| (word << 8) | u32::from(*byte))
        })
        .collect();
    for t in 16..64 {
        let (w15, w2) = (words[t - 15], words[t - 2]);
        let small0 = w15.rotate_right(7) ^ w15.rotate_right(18) ^ (w15 >> 3);
        let small1 = w2.rotate_right(17) ^ w2.rotate_right(19) ^ (w2 >> 10);
        words.push(sum(&[small1, words[t - 7], small0, words[t - 16]]));
    }
    let mut v = state.to_vec();
    for (word, constant) in words.iter().zip(constants) {
        let (a, e) = (v[0], v[4]);
        let big1 = e.rotate_right(6) ^ e.rotate_right(11) ^ e.rotate_right(25);
        let choice = (e & v[5]) ^ (!e & v[6]);
        let first = sum(&[v[7], big1, choice, *constant, *word]);
        let big0 = a.rotate_right(2) ^ a.rotate_right(13) ^ a.rotate_right(22);
        let majority = (a & v[1]) ^ (a & v[2]) ^ (v[1] & v[2]);
        v.rotate_right(1);
        v[0] = sum(&[first, big0, majority]);
        v[4] = v[4].wrapping_add(first);
    }
    for (old, new) in state.iter_mut().zip(&v) {
        *old = old.wrapping_add(*new);
    }
}

fn sum(terms: &[u32]) -> u32 {
    terms
        .iter()
        .fold(0, |total, term| total.wrapping_add(*term))
}

#[cfg(test)]
mod tests {
    use super::of;

    #[test]
    fn hashes_are_those_of_the_standard() {
        let million = vec![b'a'; 1_000_000];
        for (bytes, hash) in [
            (
                &b""[..],
                "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855",
            ),
            (
                b"abc",
                "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad",
            ),
            (
                b"abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq",
                "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1",
            ),
            (
                &million,
                "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0",
            ),
        ] {
            assert_eq!(of(bytes).unwrap(), hash);
        }
    }
}
