//! e against speed over 20 drops of a steel sphere from 5 to 150 cm: whether the band holds the curve, from the times of the
//! impacts on.

use bounce_audio::physics::{Air, FlightLaw, Sphere};
use bounce_audio::random::SplitMix64;
use bounce_audio::report::curve::Bounces;
use bounce_audio::report::{RecordingInfo, Report};
use bounce_audio::{Settings, fit_times};

use super::parallel::each;

/// Batches of drops.
const BATCHES: u64 = 60;
const DROPS: usize = 20;
const IMPACTS: usize = 12;
/// 30 mm of steel.
const BALL: Sphere = Sphere {
    mass_kg: 0.111,
    diameter_m: 0.030,
};
const CONTACT_S: f64 = 5e-5;
const TIME_STD_S: f64 = 1e-5;
const BOUNCE_STD: f64 = 3e-3;
/// Speeds at which the band is looked at.
const PLACES: usize = 21;
/// Share of the range at which it has to hold the curve.
const HELD: std::ops::RangeInclusive<f64> = 0.93..=0.97;

/// e of a viscoelastic sphere.
fn sphere(speed: f64) -> f64 {
    1.0 - 0.08 * speed.powf(0.2)
}

/// The impact times of a drop.
fn times(height_m: f64, rng: &mut SplitMix64) -> Vec<f64> {
    let law = FlightLaw::in_air(9.81, BALL, Air::default()).unwrap();
    let mut speed = law.fall(height_m).unwrap().landing_speed_m_per_s;
    let (mut at_s, mut times) = (1.0, Vec::new());
    for _ in 0..IMPACTS {
        times.push(at_s + TIME_STD_S * rng.normal());
        let hop = law
            .hop(sphere(speed) * rng.factor(BOUNCE_STD) * speed)
            .unwrap();
        at_s += CONTACT_S + hop.time_s;
        speed = hop.landing_speed_m_per_s;
    }
    times
}

/// At how many speeds the band of a batch holds the curve, and its mean half-width.
fn held(seed: u64) -> (usize, f64) {
    let mut rng = SplitMix64::new(seed);
    let share = |i: usize| i as f64 / (DROPS - 1) as f64;
    let drops: Vec<Vec<(f64, f64)>> = (0..DROPS)
        .map(|i| times(0.05 * 30.0_f64.powf(share(i)), &mut rng))
        .map(|times| times.into_iter().map(|t| (t, TIME_STD_S)).collect())
        .collect();
    let settings = Settings::default()
        .mass_kg(BALL.mass_kg)
        .diameter_m(BALL.diameter_m)
        .contact_time_s(CONTACT_S);
    let analysis = fit_times(&drops, &settings).unwrap();
    let recording = RecordingInfo::new(0.0, 10.0, "made");
    let report = Report::new("made".to_owned(), recording, settings, analysis, None);
    let curve = Bounces::of(&report).curve().unwrap();
    let rows = curve.rows();
    let (low, high) = (rows[0].speed_m_per_s, rows[rows.len() - 1].speed_m_per_s);
    let speeds = (0..PLACES).map(|i| low * (high / low).powf(i as f64 / (PLACES - 1) as f64));
    let bands: Vec<(f64, [f64; 2])> = speeds
        .map(|v| (v, curve.at(v).restitution.interval95.unwrap()))
        .collect();
    let inside = |(v, [least, most]): &&(f64, [f64; 2])| (*least..=*most).contains(&sphere(*v));
    let width = bands.iter().map(|(_, [a, b])| 0.5 * (b - a)).sum::<f64>();
    (bands.iter().filter(inside).count(), width / PLACES as f64)
}

pub(crate) fn table() {
    let seeds: Vec<u64> = (0..BATCHES).collect();
    let results = each(&seeds, |seed| held(*seed));
    let inside: usize = results.iter().map(|(inside, _)| inside).sum();
    let share = inside as f64 / (BATCHES as usize * PLACES) as f64;
    let width = results.iter().map(|(_, width)| width).sum::<f64>() / BATCHES as f64;
    println!(
        "{BATCHES} batches of {DROPS} drops: the band holds the curve at {share:.3} of the speeds, ± {width:.4}"
    );
    assert!(HELD.contains(&share), "{share}");
}
