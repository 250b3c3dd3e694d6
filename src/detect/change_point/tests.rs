//! The evidence against its definition, hop by hop.

use super::*;

#[test]
fn the_beginning_of_a_sound_is_found_in_every_band() {
    let rate = 44_100.0;
    for hz in [150.0, 600.0, 5_000.0] {
        let mut rng = crate::random::SplitMix64::new(6);
        let samples: Vec<f32> = (0..44_100)
            .map(|i| {
                let t = (real(i) - 22_050.0) / rate;
                let ring = if t > 0.0 {
                    (-t / 5e-3).exp() * (std::f64::consts::TAU * hz * t).sin()
                } else {
                    0.0
                };
                narrow(0.5 * ring + 1e-4 * rng.normal())
            })
            .collect();
        let bank = Filterbank::new(rate, 0.25e-3, 60.0).unwrap();
        let evidence = Evidence::of(&bank, &samples);
        let total = &evidence.total;
        let top = (0..total.len())
            .max_by(|&a, &b| total[a].total_cmp(&total[b]))
            .unwrap();
        let off_s = evidence.begin(top) * bank.hop_s() - 0.5;
        // A quarter of a period passes before a slow tone is loud.
        assert!(off_s.abs() < 0.4e-3 + 0.25 / hz, "{hz} Hz: {off_s} s");
    }
}

/// The evidence of noise whose level goes up and down.
fn of_noise() -> (Filterbank, Evidence) {
    let mut rng = crate::random::SplitMix64::new(8);
    let level = |i: usize| {
        if (i / 900).is_multiple_of(2) {
            0.01
        } else {
            0.1
        }
    };
    let samples: Vec<f32> = (0..8_000)
        .map(|i| narrow(level(i) * rng.normal()))
        .collect();
    let bank = Filterbank::new(8_000.0, 0.5e-3, 100.0).unwrap();
    let evidence = Evidence::of(&bank, &samples);
    (bank, evidence)
}

#[test]
fn evidence_is_the_likelihood_ratio_of_both_levels_summed_anew_at_each_hop() {
    let (bank, evidence) = of_noise();
    for rise in &evidence.bands {
        let (rate, energies) = (2.0 * rise.band.width_hz, &rise.band.energies);
        let hops = |least_s: f64, values: f64| {
            crate::units::whole(least_s.max(values / rate) / bank.hop_s()).max(2)
        };
        let (after, before) = (hops(AFTER_S, VALUES_AFTER), hops(BEFORE_S, VALUES_BEFORE));
        for k in before..energies.len() - after {
            let at = |i: usize| f64::from(energies[i]);
            let ahead: f64 = (0..after).map(|j| real(after - j) * at(k + j)).sum();
            let weights: f64 = (1..=after).map(real).sum();
            let behind: f64 = (k - before..k).map(at).sum();
            let floor = f64::from(rise.floor);
            let (new, old) = (ahead / weights + floor, behind / real(before) + floor);
            let values = |hops: f64| rate * bank.hop_s() * hops;
            let (a, b) = (values(0.75 * real(after)), values(real(before)));
            let pooled = (a * new + b * old) / (a + b);
            let nats = 0.5 * ((a + b) * pooled.ln() - a * new.ln() - b * old.ln());
            let slow = if new > old { nats } else { 0.0 };
            let fast = f64::from(rise.own[k]);
            assert!(
                (fast - slow).abs() < 1e-3 * (1.0 + slow),
                "hop {k}: {fast}, {slow}"
            );
        }
    }
}

#[test]
fn a_change_is_as_likely_as_both_sides_summed_anew_say() {
    let (_, evidence) = of_noise();
    let (from, to, weight) = (400, 480, 0.7);
    for rise in &evidence.bands {
        let energies = &rise.band.energies[from..to];
        let mut fast = vec![0.0; to - from];
        rise.add_change_likelihood(from, to, weight, &mut fast);
        let loudest = energies.iter().copied().fold(0.0, f32::max);
        let unit = f64::from(rise.floor.max(LEAKAGE * loudest));
        let side = |side: &[f32]| {
            let sum: f64 = side.iter().copied().map(f64::from).sum();
            real(side.len()) * (1.0 + sum / unit / real(side.len())).ln()
        };
        for k in 1..energies.len() {
            let slow = -weight * (side(&energies[..k]) + side(&energies[k..]));
            assert!(
                (fast[k] - slow).abs() < 1e-3 * slow.abs(),
                "hop {k}: {} {slow}",
                fast[k]
            );
        }
    }
}
