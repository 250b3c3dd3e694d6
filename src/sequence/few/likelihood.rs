//! How much better a ball explains sounds than chance or a hand.

use super::ClearSound;
use crate::event::Profile;
use crate::physics::priors::LN_RESTITUTION;
use crate::units::real;

/// Sounds of a new kind that a recording has beside those heard, and the seconds that are listened to for them elsewhere: three
/// a minute happen where balls are dropped.
const UNHEARD: f64 = 0.5;
const ELSEWHERE_S: f64 = 10.0;
/// Range of levels of sounds at large, in nats: 60 dB.
const LEVELS: f64 = 7.0;
/// Spread of the level from one impact to the next, and of sounds of one kind, in nats: it varies by a factor of two.
const LEVEL_SPREAD: f64 = 0.7;
/// Level of an impact by its speed, `level ∝ v^1.2`: the force of Hertz' contact.
const LEVEL_BY_SPEED: f64 = 1.2;
/// A ball that someone records is fainter than the loudest sound by so many nats on average, …
const FAINTER: f64 = 1.5;
/// … but for this share of recordings, where any level is as likely.
const ANY_LEVEL: f64 = 0.2;
/// Mean unlikeness of neighbouring impacts and of sounds at large. Measured: 0.06 and 0.3 on eight recordings of balls.
const UNLIKE: f64 = 0.08;
const UNLIKE_AT_LARGE: f64 = 0.3;
/// Share of neighbouring impacts that are as unlike as any sounds: the ball meets something else, or something else sounds.
const CHANGED: f64 = 0.15;
/// Share of impacts that last long, because something else sounds with them, and of sounds at large: speech, rustle, rumble.
/// Measured: without it 54 of 963 pieces of 18 recordings of speech give a few bounces, with it 2.
const LONG: f64 = 0.15;
const LONG_AT_LARGE: f64 = 0.6;
/// Sounds that are this much fainter than the faintest impact, in nats, count as others among the impacts: 10 dB; of those pieces 9
/// give a few bounces where only louder ones count. …
const COMPARABLE: f64 = 1.15;
/// … Chance of one more of them, where a ball was dropped to be recorded, and where things rattle, hands clap or someone talks.
/// Measured: none among the first impacts of seven recordings, more of them in one.
const ANOTHER: f64 = 0.15;
const ANOTHER_AT_LARGE: f64 = 0.5;
/// An impact is among them from this time before the first to as long after the last, in seconds.
const AROUND_S: f64 = 0.15;
/// e of a first impact reaches down to this.
const LEAST_RESTITUTION: f64 = 0.25;
/// Flights where no height is known, in seconds: rebounds of 1 cm to 5 m; …
const FLIGHTS_S: (f64, f64) = (0.1, 2.0);
/// … of most 10 cm to 2 m: their usual length in seconds and the spread of its ln. What rattles has shorter ones.
const USUAL_FLIGHT_S: f64 = 0.6;
const FLIGHT_SPREAD: f64 = 0.5;
/// Spread of ln(T₂/T₁) about ln e of the first impact: the scatter of a bounce, and e that rises as the speed falls.
const SPREAD: f64 = 0.06;
/// Share of three like sounds that a hand makes evenly, and the scatter of the ln of its intervals' ratio.
const BY_HAND: f64 = 0.3;
const HAND: f64 = 0.12;

/// What the sounds of a recording say of two or three of them.
#[derive(Debug)]
pub(super) struct Likelihood<'a> {
    sounds: &'a [ClearSound],
    duration_s: f64,
    longest_flight_s: Option<f64>,
    loudest: f64,
}

impl<'a> Likelihood<'a> {
    pub(super) fn new(
        sounds: &'a [ClearSound],
        duration_s: f64,
        longest_flight_s: Option<f64>,
    ) -> Self {
        let levels = sounds.iter().map(|s| s.level);
        Self {
            sounds,
            duration_s,
            longest_flight_s,
            loudest: levels.fold(f64::NEG_INFINITY, f64::max),
        }
    }

    fn flights_s(&self) -> (f64, f64) {
        self.longest_flight_s.map_or(FLIGHTS_S, |longest_s| {
            (LEAST_RESTITUTION * longest_s, longest_s)
        })
    }

    /// ln of the likelihood of two impacts over that of two sounds by chance; none where they are no flight apart.
    ///
    /// # Formula
    /// ```text
    /// p(m₁)·(1/D)·N(ln T₁)/T₁·f(m₂ | m₁) / (λ(m₁)·λ(m₂)),      λ(m) = (α·g(m) + Σ f(m | mᵢ))/(D + D₀)
    /// ```
    /// T₁ is that of balls at large from the height, which is their e, or that of most drops.
    /// A mark m is a level and a profile, p its density of a first impact, g that of sounds at large, f that of the next sound of
    /// one kind. λ is the rate of sounds like m, the sounds heard being the sample and α of another kind still to come; that of the
    /// second sound counts the first in, for also what is no ball comes in kinds. D is the length of the recording.
    pub(super) fn pair(&self, first: usize, second: usize) -> Option<f64> {
        let two = self.first_two(first, second, None)?;
        Some(two + self.ln_undisturbed(&[first, second]))
    }

    /// The same where a third sound is an impact too, and so says nothing of chance.
    fn first_two(&self, first: usize, second: usize, third: Option<usize>) -> Option<f64> {
        let (a, b) = (&self.sounds[first], &self.sounds[second]);
        let flight_s = b.time_s - a.time_s;
        let (least_s, most_s) = self.flights_s();
        if !(least_s..most_s).contains(&flight_s) {
            return None;
        }
        let others = |i: usize| i != first && i != second && Some(i) != third;
        let (ln_restitution, ln_flight) = match self.longest_flight_s {
            Some(longest_s) => {
                let ln = (flight_s / longest_s).ln();
                (ln, ln_normal(ln - LN_RESTITUTION.value, LN_RESTITUTION.std))
            }
            None => {
                let off = (flight_s / USUAL_FLIGHT_S).ln();
                (LN_RESTITUTION.value, ln_normal(off, FLIGHT_SPREAD))
            }
        };
        let ball = self.ln_first(a) - self.duration_s.ln() + ln_flight - flight_s.ln()
            + ln_next(a, b, LEVEL_BY_SPEED * ln_restitution)
            + ln_short(a)
            + ln_short(b);
        let chance = self.ln_rate(a, others) + self.ln_rate(b, |i| i == first || others(i));
        Some(ball - chance)
    }

    /// The same of three impacts; none where their flights would grow.
    ///
    /// # Formula
    /// ```text
    /// L(m₁, m₂)·N(r)/T₂·f(m₃ | m₂) / ((1 − w)·λ(m₃) + w·N(r; 0, 0.12)/T₂·f(m₃ | m₂)),    r = ln(T₂/T₁)
    /// ```
    /// r of a ball is ln e of the first impact, where the height tells it, or that of balls at large; a hand makes r about 0.
    pub(super) fn three(&self, impacts: [usize; 3]) -> Option<f64> {
        let [first, second, third] = impacts;
        let [a, b, c] = impacts.map(|i| &self.sounds[i]);
        let (first_s, second_s) = (b.time_s - a.time_s, c.time_s - b.time_s);
        let ln_ratio = (second_s / first_s).ln();
        if ln_ratio >= 0.0 || second_s < FLIGHTS_S.0 {
            return None;
        }
        let next = ln_next(b, c, LEVEL_BY_SPEED * ln_ratio);
        let by_ball = match self.longest_flight_s {
            Some(longest_s) => ln_normal(ln_ratio - (first_s / longest_s).ln(), SPREAD),
            None => ln_normal(ln_ratio - LN_RESTITUTION.value, LN_RESTITUTION.std),
        };
        let even = ln_normal(ln_ratio, HAND) - second_s.ln() + ln_next(b, c, 0.0);
        let chance = self.ln_rate(c, |i| i != third);
        let rival = (1.0 - BY_HAND) * chance.exp() + BY_HAND * even.exp();
        let two = self.first_two(first, second, Some(third))?;
        let third = by_ball - second_s.ln() + next + ln_short(c) - rival.ln();
        Some(two + third + self.ln_undisturbed(&impacts))
    }

    /// ln of how much likelier it is for impacts than for sounds at large that so many others as loud stand among them.
    ///
    /// # Formula
    /// `ln[(1 − q)·qⁿ / ((1 − q₀)·q₀ⁿ)]` for n others.
    fn ln_undisturbed(&self, impacts: &[usize]) -> f64 {
        let levels = impacts.iter().map(|&i| self.sounds[i].level);
        let least = levels.fold(f64::INFINITY, f64::min) - COMPARABLE;
        let from_s = self.sounds[impacts[0]].time_s - AROUND_S;
        let to_s = self.sounds[impacts[impacts.len() - 1]].time_s + AROUND_S;
        let first = self.sounds.partition_point(|s| s.time_s < from_s);
        let around = self.sounds[first..].iter().take_while(|s| s.time_s < to_s);
        let others = around.filter(|s| s.level >= least).count() - impacts.len();
        ((1.0 - ANOTHER) / (1.0 - ANOTHER_AT_LARGE)).ln()
            + real(others) * (ANOTHER / ANOTHER_AT_LARGE).ln()
    }

    /// ln of the density of a first impact.
    fn ln_first(&self, sound: &ClearSound) -> f64 {
        let loud = (-(self.loudest - sound.level) / FAINTER).exp() / FAINTER;
        ((1.0 - ANY_LEVEL) * loud + ANY_LEVEL / LEVELS).ln()
    }

    /// ln of the rate of sounds like one, learnt from some.
    fn ln_rate(&self, sound: &ClearSound, counts: impl Fn(usize) -> bool) -> f64 {
        let like = |other: &ClearSound| ln_next(other, sound, 0.0).exp();
        let others = (0..self.sounds.len()).filter(|&i| counts(i));
        let heard: f64 = others.map(|i| like(&self.sounds[i])).sum();
        ((UNHEARD / LEVELS + heard) / (self.duration_s + ELSEWHERE_S)).ln()
    }
}

/// ln of the density of the next sound of a kind, whose level is expected to change by so much, over that of any profile.
fn ln_next(from: &ClearSound, to: &ClearSound, change: f64) -> f64 {
    ln_normal(to.level - from.level - change, LEVEL_SPREAD)
        + ln_likeness(&from.profile, &to.profile)
}

/// ln of how much likelier profiles as unlike as these are for two sounds of one kind than for any two.
fn ln_likeness(a: &Profile, b: &Profile) -> f64 {
    let unlike = a.unlikeness(b);
    let density = |mean: f64| (-unlike / mean).exp() / mean;
    let at_large = density(UNLIKE_AT_LARGE);
    ((1.0 - CHANGED) * density(UNLIKE) / at_large + CHANGED).ln()
}

/// ln of how much likelier it is for an impact than for a sound at large that it lasts as long, where that is unlikely: what is
/// struck may be no ball.
fn ln_short(sound: &ClearSound) -> f64 {
    if sound.is_short {
        0.0
    } else {
        (LONG / LONG_AT_LARGE).ln()
    }
}

fn ln_normal(deviation: f64, std: f64) -> f64 {
    -0.5 * (deviation / std).powi(2) - std.ln() - 0.5 * std::f64::consts::TAU.ln()
}
