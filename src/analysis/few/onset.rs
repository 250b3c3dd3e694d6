//! How exactly the onset of a sound is known where two or three sounds are all there is: nothing else tells how far they scatter.

use super::super::stretch::Stretch;
use crate::impact::Impact;
use crate::units::real;

/// Standard error of an onset in seconds, by the peak of its sound over the noise before it in dB, from the first on that it
/// reaches. Measured on 332 made drops of two impacts (`found -- rebound`): the flight between them was off by 0.1 ms where both
/// reach 25 dB, by 0.3 ms above 15 dB, by 2.1 ms below (the share of 68 %), whatever correlation claims.
const STD_S: [(f64, f64); 3] = [(25.0, 7e-5), (15.0, 2.5e-4), (f64::NEG_INFINITY, 2.1e-3)];
/// The peak is sought within this time after an onset, in seconds …
const SOUND_S: f64 = 4e-3;
/// … and the noise in this stretch before it.
const BEFORE_S: (f64, f64) = (30e-3, 4e-3);

/// The impact with the error of its onset beside that which its timing claims.
pub(super) fn doubted(stretch: &Stretch<'_>, impact: Impact) -> Impact {
    let over_noise_db = over_noise_db(stretch, impact.time_s);
    let reached = STD_S.iter().find(|(db, _)| over_noise_db >= *db);
    Impact {
        std_s: impact.std_s.hypot(reached.map_or(0.0, |(_, std)| *std)),
        ..impact
    }
}

/// Peak over the root mean square before; infinite over silence.
fn over_noise_db(stretch: &Stretch<'_>, time_s: f64) -> f64 {
    let sound = stretch.sound.between(time_s, time_s + SOUND_S);
    let before = stretch
        .sound
        .between(time_s - BEFORE_S.0, time_s - BEFORE_S.1);
    let peak = sound.iter().map(|x| f64::from(x.abs())).fold(0.0, f64::max);
    let square: f64 = before.iter().map(|x| f64::from(*x).powi(2)).sum();
    let rms = (square / real(before.len().max(1))).sqrt();
    20.0 * (peak / rms).log10()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::signal::sound::Sound;

    #[test]
    fn the_less_a_sound_stands_out_the_less_exactly_it_begins() {
        let with_peak = |peak: f32| {
            // Noise of 0.01, and a click at 0.1 s.
            let mut samples: Vec<f32> = (0..2_000)
                .map(|i| if i % 2 == 0 { 0.01 } else { -0.01 })
                .collect();
            samples[1_005] = peak;
            let stretch = Stretch {
                sound: Sound::from_start(&samples, 1e4),
                listened_from_s: 0.0,
            };
            doubted(&stretch, Impact::heard(0.1, 1e-6)).std_s
        };
        for (peak, std) in [(0.5, 7e-5), (0.1, 2.5e-4), (0.03, 2.1e-3)] {
            assert!(
                (with_peak(peak) / std - 1.0).abs() < 1e-3,
                "{peak}: {}",
                with_peak(peak)
            );
        }
    }
}
