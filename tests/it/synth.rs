//! Recordings measured by methods that know nothing of how they were made.

use bounce_audio::synth::recorder::Channel;
use bounce_audio::synth::scene::{Mode, Scene, preset};
use bounce_audio::synth::{Synthetic, render};
use bounce_audio::units::{real, samples_in};

/// A scene without noise in floating point, every impact of which sounds alike but for its loudness.
fn clean(name: &str) -> Scene {
    let mut scene = preset(name).unwrap();
    scene.noise.white_db = f64::NEG_INFINITY;
    scene.echoes.clear();
    scene.recorder.encoding = bounce_audio::synth::recorder::Encoding::Float32;
    scene.drops[0].level_scatter = 0.0;
    scene
}

/// Power at a frequency of the samples from an instant on, under a Hann window: the sum of the definition.
fn power_at(frequency_hz: f64, samples: &[f32], rate: f64) -> f64 {
    let step = std::f64::consts::TAU * frequency_hz / rate;
    let last = samples.len() as f64;
    let sum = samples
        .iter()
        .enumerate()
        .fold((0.0, 0.0), |(c, s), (i, x)| {
            let i = i as f64;
            let window = 0.5 - 0.5 * (std::f64::consts::TAU * i / last).cos();
            let x = window * f64::from(*x);
            (c + x * (step * i).cos(), s + x * (step * i).sin())
        });
    sum.0 * sum.0 + sum.1 * sum.1
}

/// Delay of one impact's sound after another's, in seconds.
fn delay_s(made: &Synthetic, early: usize, late: usize) -> f64 {
    let times = &made.truth.drops[0].impacts_s;
    between_s(made, [&made.samples; 2], [times[early], times[late]])
}

/// Delay of the sound at a time of one channel after that at a time of another, in seconds, from the phase of their cross
/// spectrum: the slope of the phase against frequency, weighted by power, around a whole number of samples.
fn between_s(made: &Synthetic, channels: [&Vec<f32>; 2], at_s: [f64; 2]) -> f64 {
    let rate = f64::from(made.truth.sample_rate_hz);
    let length = 1024;
    // Both pieces begin some samples before the onset, as a listener would cut them.
    let first = samples_in(at_s[0], rate) - 20;
    let second = samples_in(at_s[1] - at_s[0] + real(first) / rate, rate);
    let pieces = [
        &channels[0][first..first + length],
        &channels[1][second..second + length],
    ];
    let (mut weighted, mut weights) = (0.0, 0.0);
    for bin in 1..length / 2 {
        let step = std::f64::consts::TAU * bin as f64 / length as f64;
        let [a, b] = pieces.map(|piece| {
            piece.iter().enumerate().fold((0.0, 0.0), |(c, s), (i, x)| {
                let (x, i) = (f64::from(*x), i as f64);
                (c + x * (step * i).cos(), s - x * (step * i).sin())
            })
        });
        // a times the conjugate of b: its phase is ω·delay.
        let cross = (a.0 * b.0 + a.1 * b.1, a.1 * b.0 - a.0 * b.1);
        let power = cross.0.hypot(cross.1);
        weighted += power * step * cross.1.atan2(cross.0);
        weights += power * step * step;
    }
    (real(second) - real(first) + weighted / weights) / rate
}

#[test]
fn sounds_begin_where_the_truth_says() {
    for name in ["steel", "pingpong", "rubber"] {
        let made = render(&clean(name), 2).unwrap();
        let rate = f64::from(made.truth.sample_rate_hz);
        for (i, onset_s) in made.truth.drops[0].impacts_s.iter().enumerate().take(3) {
            // The first sound after silence: a cubic start, so extrapolated from the first two samples heard.
            let from = samples_in(onset_s - 2e-3, rate);
            let Some(quiet) = made.samples[from..from + 200]
                .iter()
                .position(|&x| x != 0.0)
            else {
                panic!("{name} {i} is silent");
            };
            if i > 0 && made.samples[from] != 0.0 {
                continue; // It still rings of the one before.
            }
            let [a, b] = [0, 1].map(|k| f64::from(made.samples[from + quiet + k].abs()).cbrt());
            let heard = (from + quiet) as f64 - a / (b - a);
            assert!((heard - onset_s * rate).abs() < 0.1, "{name} {i}: {heard}");
        }
    }
}

#[test]
fn flights_measured_by_phase_are_those_of_the_truth() {
    for (name, impacts) in [("steel", 12), ("pingpong", 15)] {
        let made = render(&clean(name), 1).unwrap();
        let times = &made.truth.drops[0].impacts_s;
        for late in 1..impacts {
            let measured = delay_s(&made, 0, late);
            let off = (measured - (times[late] - times[0])) * f64::from(made.truth.sample_rate_hz);
            assert!(off.abs() < 0.1, "{name} {late}: {off} samples");
        }
    }
}

#[test]
fn each_channel_hears_a_ball_that_wanders_at_times_of_its_own() {
    let mut scene = clean("steel");
    scene.drops[0].sideways = 0.01;
    let at_m = [Some([0.35, 0.0, 0.1]), Some([-0.3, 0.2, 0.1])];
    scene.recorder.channels = at_m
        .map(|at_m| Channel {
            at_m,
            ..Channel::default()
        })
        .to_vec();
    let made = render(&scene, 1).unwrap();
    let drop = &made.truth.drops[0];
    let mut delays_s = Vec::new();
    for i in 0..12 {
        let onsets_s = [drop.onsets_s[i], drop.more_onsets_s[0][i]];
        let measured = between_s(&made, [&made.samples, &made.more_channels[0]], onsets_s);
        let off = (measured - (onsets_s[1] - onsets_s[0])) * f64::from(scene.sample_rate_hz);
        assert!(off.abs() < 0.1, "{i}: {off} samples");
        delays_s.push(measured);
    }
    let (least, most) = (f64::min, f64::max);
    let range = delays_s.iter().copied().fold(f64::NEG_INFINITY, most)
        - delays_s.iter().copied().fold(f64::INFINITY, least);
    assert!(range > 1e-4, "it wanders by {range} s only");
}

#[test]
fn the_spectrum_of_an_impact_shows_its_modes() {
    let mut scene = clean("steel");
    let modes = [2_100.0, 5_200.0, 9_700.0];
    scene.drops[0].modes = modes
        .map(|frequency_hz| Mode {
            frequency_hz,
            decay_s: 12e-3,
            level: 1.0,
        })
        .to_vec();
    let made = render(&scene, 1).unwrap();
    let rate = f64::from(made.truth.sample_rate_hz);
    let first = samples_in(made.truth.drops[0].impacts_s[0], rate);
    let sound = &made.samples[first..first + 2_048];
    let spectrum: Vec<(f64, f64)> = (100..1_200)
        .map(|k| 10.0 * f64::from(k))
        .map(|hz| (hz, power_at(hz, sound, rate)))
        .collect();
    let mut peaks: Vec<(f64, f64)> = spectrum
        .windows(3)
        .filter(|w| w[1].1 > w[0].1 && w[1].1 > w[2].1)
        .map(|w| w[1])
        .collect();
    peaks.sort_by(|a, b| b.1.total_cmp(&a.1));
    for mode in modes {
        let found = peaks[..3].iter().any(|(hz, _)| (hz - mode).abs() <= 10.0);
        assert!(found, "no peak at {mode} Hz among {:?}", &peaks[..3]);
    }
}

#[test]
fn what_is_said_of_the_paper_is_what_it_says() {
    let made = render(&preset("paper").unwrap(), 1).unwrap();
    let drop = &made.truth.drops[0];
    assert!(
        (drop.contact_time_s - 1.0e-3).abs() < 5e-6,
        "{}",
        drop.contact_time_s
    );
    assert!((drop.restitution_nominal_each[0] - 0.93).abs() < 2e-3);
    // The exact ball with k from 1.0 ms makes more bounces than the 70 that were heard; flights below 1 ms are left out.
    assert!(
        (70..90).contains(&drop.impacts_s.len()),
        "{}",
        drop.impacts_s.len()
    );
}
