//! The limit of speed: how fast a file can be read at all.

use std::fs::File;
use std::io::Read;
use std::path::Path;
use std::time::Instant;

use crate::Error;
use crate::statistics::median;

/// How often the file is read; the median counts.
const REPEATS: usize = 9;
/// Bytes read at once.
const BLOCK: usize = 1 << 16;

/// Seconds that reading a file in blocks and summing squares takes: the fastest of several loops, the median of nine
/// goes, after one that warms the cache.
///
/// Bytes are taken as 16-bit numbers whatever they are: it is the time of a byte that counts.
///
/// # Errors
/// [`Error::InFile`] if it cannot be read.
pub(super) fn read_and_sum_s(path: &Path) -> Result<f64, Error> {
    let loops: [fn(&[u8]) -> u64; 3] = [in_order, in_lanes::<8>, in_lanes::<32>];
    let mut fastest = f64::INFINITY;
    for sum in loops {
        let mut times = Vec::with_capacity(REPEATS);
        for _ in 0..=REPEATS {
            times.push(once_s(path, sum).map_err(|e| e.in_file(path))?);
        }
        // The first go only warms the cache.
        let warm = median(times.into_iter().skip(1));
        fastest = fastest.min(warm.unwrap_or(f64::INFINITY));
    }
    Ok(fastest)
}

fn once_s(path: &Path, sum: fn(&[u8]) -> u64) -> Result<f64, Error> {
    let start = Instant::now();
    let mut file = File::open(path)?;
    let mut block = vec![0; BLOCK];
    let mut total = 0_u64;
    loop {
        let count = file.read(&mut block)?;
        if count == 0 {
            break;
        }
        total = total.wrapping_add(sum(&block[..count]));
    }
    // Without a use of the sum the compiler would leave the loop out.
    std::hint::black_box(total);
    Ok(start.elapsed().as_secs_f64())
}

fn square(pair: &[u8]) -> u64 {
    let x = pair
        .iter()
        .rev()
        .fold(0_u16, |x, byte| (x << 8) | u16::from(*byte));
    u64::from(x.cast_signed().unsigned_abs()).pow(2)
}

fn in_order(block: &[u8]) -> u64 {
    block.chunks_exact(2).map(square).sum()
}

/// Several sums side by side, which the compiler can compute at once.
fn in_lanes<const LANES: usize>(block: &[u8]) -> u64 {
    let mut sums = [0_u64; LANES];
    for piece in block.chunks_exact(2 * LANES) {
        for (sum, pair) in sums.iter_mut().zip(piece.chunks_exact(2)) {
            *sum += square(pair);
        }
    }
    sums.iter().sum()
}
