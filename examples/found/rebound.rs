//! One rebound: balls of e 0.3 to 0.9 that are caught after two impacts, in 20 to 60 dB of quiet.

use bounce_audio::random::SplitMix64;
use bounce_audio::synth::render;
use bounce_audio::synth::scene::BounceScene;
use bounce_audio::{Settings, analyze};

use super::parallel::each;
use super::trial::Ball;

/// Seeds of the recordings: others than those that the errors of onsets were measured on.
const SEEDS: std::ops::Range<u64> = 5_000..5_400;
/// Height of release in metres, and the error with which it is measured.
const HEIGHT_M: f64 = 1.0;
const HEIGHT_STD_M: f64 = 1e-3;
/// Share of the recordings of which the 95 % intervals have to hold the truth. They hold more: these balls displace no air, of which a
/// ball that nobody described may displace some, and their contacts are known better than within 5 %.
const HELD: f64 = 0.93;

/// A recording to make.
#[derive(Debug, Clone, Copy)]
struct Job {
    seed: u64,
    restitution: f64,
    contact_s: f64,
    signal_to_noise_db: f64,
    height_off_m: f64,
}

impl Job {
    fn drawn(seed: u64) -> Self {
        let mut rng = SplitMix64::new(seed);
        let mut between = |low: f64, high: f64| low + (high - low) * rng.uniform();
        Self {
            seed,
            restitution: between(0.3, 0.9),
            contact_s: between(1e-3, 5e-3),
            signal_to_noise_db: between(20.0, 60.0),
            height_off_m: HEIGHT_STD_M * SplitMix64::new(seed + 1_000_000).normal(),
        }
    }
}

/// Whether the intervals held e and the rebound, and how far e was off in its standard errors; none where no drop was found.
type Result = Option<(bool, bool, f64)>;

fn trial(job: &Job, contact_known: bool) -> Result {
    let ball = Ball::new("tennis", job.restitution, HEIGHT_M);
    let mut scene = ball.scene(Some(2));
    let drop = &mut scene.drops[0];
    drop.height_spread = 0.0;
    drop.bounce = BounceScene::Constant {
        restitution: job.restitution,
        contact_time_s: job.contact_s,
    };
    scene.noise.white_db = scene.peak_db - job.signal_to_noise_db;
    let made = render(&scene, job.seed).unwrap();
    let settings = Settings::default()
        .height_m(HEIGHT_M + job.height_off_m)
        .height_std_m(HEIGHT_STD_M)
        .contact_time_s(contact_known.then_some(job.contact_s));
    let rate = f64::from(made.truth.sample_rate_hz);
    let analysis = analyze(&made.samples, rate, &settings).unwrap();
    let [drop] = analysis.drops.as_slice() else {
        return None;
    };
    let rebound = drop.first_rebound.as_ref()?;
    let e = made.truth.drops[0].restitution_each[0];
    let holds = |interval: Option<[f64; 2]>, truth: f64| {
        interval.is_some_and(|[low, high]| (low..=high).contains(&truth))
    };
    let off = (rebound.restitution.value - e) / rebound.restitution.std_error?;
    Some((
        holds(rebound.restitution.interval95, e),
        holds(rebound.height_m.interval95, e * e * HEIGHT_M),
        off,
    ))
}

pub(crate) fn table() {
    let jobs: Vec<Job> = SEEDS.map(Job::drawn).collect();
    println!("| contact | e | found | e held | rebound held | e off, in standard errors |");
    println!("|---|---|---|---|---|---|");
    for contact_known in [false, true] {
        let results = each(&jobs, |job| trial(job, contact_known));
        let of = |low: f64, high: f64| {
            let chosen = jobs.iter().zip(&results);
            let chosen = chosen.filter(|(job, _)| (low..high).contains(&job.restitution));
            chosen.map(|(_, result)| *result).collect::<Vec<Result>>()
        };
        for (low, high) in [(0.3, 0.5), (0.5, 0.7), (0.7, 0.9)] {
            row(contact_known, &format!("{low} to {high}"), &of(low, high));
        }
        for (low, high) in [(20.0, 30.0), (30.0, 40.0), (40.0, 50.0), (50.0, 60.0)] {
            let chosen = jobs.iter().zip(&results);
            let chosen = chosen.filter(|(job, _)| (low..high).contains(&job.signal_to_noise_db));
            let chosen: Vec<Result> = chosen.map(|(_, result)| *result).collect();
            row(contact_known, &format!("{low} to {high} dB"), &chosen);
        }
        let (e, rebound) = row(contact_known, "all", &results);
        assert!(e >= HELD && rebound >= HELD, "{e} {rebound}");
    }
}

fn row(contact_known: bool, name: &str, results: &[Result]) -> (f64, f64) {
    let found: Vec<&(bool, bool, f64)> = results.iter().flatten().collect();
    let share = |held: &dyn Fn(&(bool, bool, f64)) -> bool| {
        found.iter().filter(|r| held(r)).count() as f64 / found.len() as f64
    };
    let (e, rebound) = (share(&|r| r.0), share(&|r| r.1));
    let square: f64 = found.iter().map(|r| r.2 * r.2).sum::<f64>() / found.len() as f64;
    let contact = if contact_known { "known" } else { "unknown" };
    println!(
        "| {contact} | {name} | {} of {} | {e:.3} | {rebound:.3} | {:.2} |",
        found.len(),
        results.len(),
        square.sqrt()
    );
    (e, rebound)
}
