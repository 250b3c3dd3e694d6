//! Counts as numbers, spans in seconds as counts of samples; [`Quantity`] reads what a person writes with a unit.
//!
//! Times of a recording become samples of a stretch in [`Sound`](crate::signal::sound::Sound).

mod quantity;

pub use quantity::Quantity;

/// A count as a real number.
///
/// Counts here are samples, impacts and files: far below 2⁵³, so nothing is rounded.
#[expect(clippy::cast_precision_loss, reason = "counts stay far below 2^53")]
#[must_use]
pub const fn real(count: usize) -> f64 {
    count as f64
}

/// The single-precision number nearest to a double: 24 bits are enough for energies, evidence and matches.
#[expect(clippy::cast_possible_truncation, reason = "as is said above")]
#[must_use]
pub const fn narrow(x: f64) -> f32 {
    x as f32
}

/// The whole number nearest to a real one, halves away from zero: below 0 it is 0, beyond what a count holds the greatest
/// count, and 0 for NaN.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "`as` saturates, as is said above"
)]
#[must_use]
pub fn whole(x: f64) -> usize {
    x.round() as usize
}

/// Number of whole samples in a span, rounded to nearest; a negative span or NaN is empty.
#[must_use]
pub fn samples_in(span_s: f64, sample_rate_hz: f64) -> usize {
    whole(span_s * sample_rate_hz)
}

/// The frame of a stream that is nearest to a time in seconds from its start; 0 for earlier times and NaN.
///
/// Frames of a stream are counted in 64 bits: 32 end after a day at 48 kHz, and a length in memory may have no more.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "`as` saturates, as is said above"
)]
#[must_use]
pub fn frame_at(time_s: f64, sample_rate_hz: f64) -> u64 {
    (time_s * sample_rate_hz).round() as u64
}

/// The time of a frame of a stream, in seconds from its start.
#[expect(clippy::cast_precision_loss, reason = "counts stay far below 2^53")]
#[must_use]
pub const fn frame_time_s(frame: u64, sample_rate_hz: f64) -> f64 {
    frame as f64 / sample_rate_hz
}

/// The frames of a stream that stand in a buffer of this length.
#[must_use]
pub const fn frames(length: usize) -> u64 {
    length as u64
}

/// The length of a buffer for frames of a stream; the greatest there is, where it would be longer.
#[must_use]
pub fn length(frames: u64) -> usize {
    usize::try_from(frames).unwrap_or(usize::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_numbers_are_the_nearest_and_end_where_counts_do() {
        for (x, count) in [
            (2.4, 2),
            (2.5, 3),
            (-0.4, 0),
            (-7.0, 0),
            (f64::NAN, 0),
            (1e30, usize::MAX),
        ] {
            assert_eq!(whole(x), count, "{x}");
        }
    }

    #[test]
    fn frames_of_a_stream_are_counted_beyond_32_bits() {
        let day_s = 86_400.0 * 1.25;
        assert_eq!(frame_at(day_s, 48_000.0), 5_184_000_000);
        assert_eq!(frame_time_s(5_184_000_000, 48_000.0), day_s);
        assert_eq!(
            (frame_at(-1.0, 48_000.0), frame_at(1e30, 48_000.0)),
            (0, u64::MAX)
        );
        assert_eq!(length(frames(7)), 7);
    }
}
