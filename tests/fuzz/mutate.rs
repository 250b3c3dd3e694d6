//! Valid things made invalid, and bytes that never were.

use bounce_audio::random::SplitMix64;

use super::choose::{below, one_of};

/// Lengths and counts that readers stumble over.
const EDGES: [u32; 12] = [
    0,
    1,
    2,
    0x7F,
    0xFF,
    0x7FFF,
    0x8000,
    0xFFFF,
    0x7FFF_FFFF,
    0x8000_0000,
    0xFFFF_FFFE,
    0xFFFF_FFFF,
];
/// Headers are so long: half of all changes are made there.
const HEADER: usize = 64;

fn noise(random: &mut SplitMix64, length: usize) -> Vec<u8> {
    (0..length)
        .map(|_| random.next_u64().to_le_bytes()[0])
        .collect()
}

/// Something valid with a few changes; now and then nothing but noise. `words` are put in as they are.
pub(crate) fn mutated(random: &mut SplitMix64, valid: &[Vec<u8>], words: &[&str]) -> Vec<u8> {
    if random.next_u64().is_multiple_of(32) {
        let length = below(random, 300);
        return noise(random, length);
    }
    let mut bytes = one_of(random, valid).clone();
    for _ in 0..=below(random, 6) {
        change(random, &mut bytes, valid, words);
    }
    bytes
}

fn change(random: &mut SplitMix64, bytes: &mut Vec<u8>, valid: &[Vec<u8>], words: &[&str]) {
    let reach = match random.next_u64() % 2 {
        0 => bytes.len(),
        _ => bytes.len().min(HEADER),
    };
    let at = below(random, reach + 1);
    let to = at + below(random, (bytes.len() - at).min(4 * HEADER) + 1);
    match random.next_u64() % 9 {
        0 => overwrite(bytes, at, &[random.next_u64().to_le_bytes()[0]]),
        1 => {
            let bit = 1 << below(random, 8);
            let turned = bytes.get(at).map_or(0, |b| b ^ bit);
            overwrite(bytes, at, &[turned]);
        }
        // A length field or a rate.
        2 => {
            let near = u32::try_from(bytes.len()).unwrap_or(0) + 1;
            let edge = match random.next_u64() % 4 {
                0 => near.wrapping_sub(below(random, HEADER).try_into().unwrap_or(0)),
                _ => *one_of(random, &EDGES),
            };
            overwrite(bytes, at / 2 * 2, &edge.to_le_bytes());
        }
        3 => {
            let edge = one_of(random, &EDGES).to_le_bytes();
            overwrite(bytes, at / 2 * 2, &edge[..2]);
        }
        4 => bytes.truncate(at),
        5 => drop(bytes.drain(at..to)),
        6 => {
            let copy = bytes[at..to].to_vec();
            bytes.splice(at..at, copy);
        }
        7 => {
            let other = one_of(random, valid);
            let from = below(random, other.len());
            bytes.truncate(at);
            bytes.extend_from_slice(&other[from..]);
        }
        _ => {
            let length = below(random, 9);
            let inserted = match words {
                [] => noise(random, length),
                words => one_of(random, words).as_bytes().to_vec(),
            };
            bytes.splice(at..at, inserted);
        }
    }
}

fn overwrite(bytes: &mut [u8], at: usize, with: &[u8]) {
    for (byte, new) in bytes.iter_mut().skip(at).zip(with) {
        *byte = *new;
    }
}
