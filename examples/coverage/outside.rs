//! Coverage on balls whose laws the fit does not contain: errors of the times, scatter and number of impacts vary inside.

use bounce_audio::fit::model_selection::{Choice, Inputs, select};
use bounce_audio::impact::Impact;
use bounce_audio::physics::FlightLaw;
use bounce_audio::random::SplitMix64;
use bounce_audio::units::real;

use crate::GRAVITY;
use crate::laws::{Ball, INSIDE, Law, OUTSIDE};

/// Flights are longer than this, than twenty errors of a time, and than three contacts.
const SHORTEST_S: f64 = 0.02;
const SHORTEST_STDS: f64 = 20.0;
const SHORTEST_CONTACTS: f64 = 3.0;

/// A drop as heard, with the ball that made it.
struct Drop {
    ball: Ball,
    impacts: Vec<Impact>,
}

impl Drop {
    /// Six to 25 impacts, errors of 1 to 300 µs, scatter of none for a fifth and up to 1 % for the others; none where the ball
    /// comes to rest before six.
    fn of(law: Law, rng: &mut SplitMix64) -> Option<Self> {
        let ball = Ball::of(law, rng);
        let wanted = 6.0 + 20.0 * rng.uniform();
        let std_s = 1e-6 * 300_f64.powf(rng.uniform());
        let bounce_std = (0.0125 * rng.uniform() - 0.0025).max(0.0);
        let flight = FlightLaw::with_drag(GRAVITY, ball.drag_per_s2).ok()?;
        let (mut speed, mut at_s, mut times) = (2.0 + 2.0 * rng.uniform(), 0.0, Vec::new());
        while real(times.len()) < wanted.floor() {
            let (ln_e, contact_s) = ball.impact(speed);
            times.push(at_s);
            let scatter = bounce_std * ball.scatter(times.len(), rng);
            let hop = flight.hop(speed * (ln_e + scatter).min(-1e-4).exp()).ok()?;
            let shortest_s = SHORTEST_S
                .max(SHORTEST_STDS * std_s)
                .max(SHORTEST_CONTACTS * contact_s);
            if hop.time_s < shortest_s {
                break;
            }
            at_s += contact_s + hop.time_s;
            speed = hop.landing_speed_m_per_s;
        }
        let heard = |time_s: f64| Impact::heard(time_s + std_s * rng.normal(), std_s);
        let impacts: Vec<Impact> = times.into_iter().map(heard).collect();
        (impacts.len() >= 6).then_some(Self { ball, impacts })
    }
}

/// What came of the drops of a law.
#[derive(Debug, Default, Clone)]
struct Tally {
    drops: usize,
    held: usize,
    past_one: usize,
    /// `|ln ê − ln e|/σ`.
    off: Vec<f64>,
    half_widths: Vec<f64>,
}

impl Tally {
    fn of(law: Law, drops: usize) -> Self {
        let mut rng = SplitMix64::new(law as u64);
        let mut tally = Self::default();
        while tally.drops < drops {
            let Some(drop) = Drop::of(law, &mut rng) else {
                continue;
            };
            tally.drops += 1;
            tally.add(&drop);
        }
        tally
    }

    fn add(&mut self, drop: &Drop) {
        let selected = select(&drop.impacts, &[], &Inputs::default(), Choice::Auto);
        let Some(selection) = selected else { return };
        let fitted = selection.fit.ln_restitution;
        let (Some(std), Some([low, high])) = (fitted.std, fitted.interval95) else {
            return;
        };
        let at_speed = 0.5 * GRAVITY * selection.fit.mean_speed_s;
        let (truth, _) = drop.ball.impact(at_speed);
        self.held += usize::from(low <= truth && truth <= high);
        self.past_one += usize::from(high > 0.0);
        self.off.push((fitted.value - truth).abs() / std);
        self.half_widths.push(0.5 * (high.exp() - low.exp()));
    }

    fn with(mut self, other: &Self) -> Self {
        self.drops += other.drops;
        self.held += other.held;
        self.past_one += other.past_one;
        self.off.extend(&other.off);
        self.half_widths.extend(&other.half_widths);
        self
    }

    fn line(&self, name: &str) -> String {
        let held = real(self.held) / real(self.drops.max(1));
        let (middle, most) = (quantile(&self.off, 0.5), quantile(&self.off, 0.9));
        let half_width = quantile(&self.half_widths, 0.5);
        format!(
            "| {name} | {} | {held:.3} | {middle:.2} | {most:.2} | {half_width:.1e} | {} |",
            self.drops, self.past_one
        )
    }
}

fn quantile(values: &[f64], share: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let at = bounce_audio::units::whole(share * real(sorted.len().saturating_sub(1)));
    sorted.get(at).copied().unwrap_or(f64::NAN)
}

/// The table of all laws, those that the fit contains first.
pub(crate) fn print(drops: usize) {
    println!("| ball | drops | holds e | \\|z\\| 50 % | \\|z\\| 90 % | half-width | past 1 |");
    println!("|---|---:|---:|---:|---:|---:|---:|");
    for (group, laws) in [("contained", &INSIDE[..]), ("others", &OUTSIDE[..])] {
        let tallies: Vec<Tally> = std::thread::scope(|scope| {
            let running: Vec<_> = laws
                .iter()
                .map(|&law| scope.spawn(move || Tally::of(law, drops)))
                .collect();
            running.into_iter().map(|r| r.join().unwrap()).collect()
        });
        for (law, tally) in laws.iter().zip(&tallies) {
            println!("{}", tally.line(&format!("{law:?}")));
        }
        let all = tallies.iter().fold(Tally::default(), Tally::with);
        println!("{}", all.line(&format!("all {group}")));
    }
}
