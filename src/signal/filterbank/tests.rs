//! Bands and their energies.

use super::*;

const RATE_HZ: f64 = 48_000.0;

fn tone(hz: f64) -> Vec<f32> {
    #[expect(clippy::cast_possible_truncation, reason = "test signal")]
    (0..48_000)
        .map(|i| (std::f64::consts::TAU * hz * real(i) / RATE_HZ).sin() as f32)
        .collect()
}

fn bank() -> Filterbank {
    Filterbank::new(RATE_HZ, 0.25e-3, 60.0).unwrap()
}

fn mean(band: &Band) -> f64 {
    let middle = &band.energies[500..2500];
    middle.iter().copied().map(f64::from).sum::<f64>() / real(middle.len())
}

#[test]
fn a_tone_lands_in_its_octave_with_its_energy() {
    let bank = bank();
    for (index, hz) in [
        (0, 17_000.0),
        (1, 8_500.0),
        (2, 4_200.0),
        (3, 2_100.0),
        (5, 530.0),
        (7, 132.0),
    ] {
        let bands = bank.split(&tone(hz));
        assert!(hz > bands[index].width_hz && hz < 2.0 * bands[index].width_hz);
        // Decimated bands hold all samples of a slower signal: the mean square of a full-scale sine is a half.
        let own = mean(&bands[index]);
        assert!((own - 0.5).abs() < 0.02, "{hz} Hz: {own}");
        for (other, band) in bands
            .iter()
            .enumerate()
            .filter(|&(other, _)| other != index)
        {
            assert!(mean(band) < 1e-3, "{hz} Hz in band {other}: {}", mean(band));
        }
    }
}

#[test]
fn no_band_is_late() {
    let mut click = vec![0.0; 48_000];
    click[24_000] = 1.0;
    let bank = bank();
    for band in bank.split(&click) {
        let total: f64 = band.energies.iter().copied().map(f64::from).sum();
        let centre: f64 = band
            .energies
            .iter()
            .enumerate()
            .map(|(i, &e)| (real(i) + 0.5) * f64::from(e))
            .sum::<f64>()
            / total;
        let off = (centre * real(bank.hop()) - 24_000.0).abs();
        assert!(
            off < real(bank.hop()),
            "{} Hz: {off} samples",
            band.width_hz
        );
    }
}

#[test]
fn a_rate_without_an_octave_is_refused() {
    assert!(Filterbank::new(200.0, 0.25e-3, 60.0).is_err());
}
