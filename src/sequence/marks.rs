//! What an impact sounds like beside the one before it: its loudness and its sound, against those of events at large.

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_2_SQRT_PI};

use super::Event;
use crate::event::Profile;

/// Scale of the loudness of an impact about that of those before it, as a natural logarithm; measured: neighbours differ by a
/// factor of 1.4 on quiet recordings, and by two among noise.
const LOUDNESS_SPREAD: f64 = 0.6;
/// Density of the loudness of anything: from what can just be heard to the loudest are five units of ln.
pub(super) const LOUDNESS_AT_LARGE: f64 = 0.2;
/// Width of the kernel by which the loudness of clutter is estimated.
const KERNEL_WIDTH: f64 = 0.3;
/// Beyond this difference in loudness the kernel is nothing.
pub(super) const KERNEL_REACH: f64 = 3.0 * KERNEL_WIDTH;
/// Density of the difference in loudness of two impacts of one ball at 0. Derived: normal, √2·0.6 wide.
pub(super) const LOUDNESS_OF_ANOTHER: f64 = 0.47;

/// Profiles of neighbouring impacts of great strength are as unlike as this …
const LEAST_UNLIKENESS: f64 = 5e-3;
/// … and this divided by the strength more: the profile of a faint sound is known badly. Measured on neighbouring impacts.
const FAINT_UNLIKENESS: f64 = 2.2;
/// Mean unlikeness of two sounds at large; measured.
const UNLIKENESS_AT_LARGE: f64 = 0.25;
/// Share of impacts whose sound is like none before.
const OTHER: f64 = 0.1;

/// Sounds of the kind of one event: where one of them is found, others are, as loud and alike.
#[derive(Debug)]
pub(super) struct Kind<'a> {
    event: &'a Event,
    likeness: Likeness,
    /// Up to this unlikeness two sounds are likelier of one kind than of any.
    alike: f64,
}

impl<'a> Kind<'a> {
    pub(super) fn of(event: &'a Event) -> Self {
        let likeness = Likeness::among(event.strength);
        Self {
            event,
            alike: -likeness.width * likeness.at_large.ln(),
            likeness,
        }
    }

    /// Density of the loudness of the event where another was found, as far as that is of its kind.
    ///
    /// # Formula
    /// `φ((l − l')/h)/h · min(1, L)` for loudnesses l and l', L being how much likelier so like a sound is of one kind than of any:
    /// what sounds otherwise counts less, what sounds alike counts once.
    pub(super) fn density_near(&self, other: &Event) -> f64 {
        let off = (self.event.loudness - other.loudness).abs();
        if off > KERNEL_REACH {
            return 0.0;
        }
        let off = off / KERNEL_WIDTH;
        let loudness =
            0.5 * FRAC_1_SQRT_2 * FRAC_2_SQRT_PI / KERNEL_WIDTH * (-0.5 * off * off).exp();
        let unlikeness = self.event.profile.unlikeness(&other.profile);
        if unlikeness <= self.alike {
            loudness
        } else {
            loudness * self.likeness.of(unlikeness)
        }
    }
}

/// ln of the density of the loudness of an impact so far from what is expected: Student's with four degrees of freedom.
pub(super) fn ln_loudness_density(off: f64) -> f64 {
    let squared = (off / LOUDNESS_SPREAD).powi(2);
    (0.375 / LOUDNESS_SPREAD).ln() - 2.5 * (0.25 * squared).ln_1p()
}

/// How much likelier it is that two sounds of one ball are as unlike as this than that any two are.
#[derive(Debug, Clone, Copy)]
struct Likeness {
    /// Mean unlikeness of two sounds of one ball.
    width: f64,
    /// What it would be of any two, on average.
    at_large: f64,
}

impl Likeness {
    /// Of an event of so many nats.
    fn among(strength: f64) -> Self {
        let width = LEAST_UNLIKENESS + FAINT_UNLIKENESS / strength;
        Self {
            width,
            at_large: width / (width + UNLIKENESS_AT_LARGE),
        }
    }

    /// # Formula
    /// `(1 − ε)·exp(−u/τ)/Z + ε` for profiles as unlike as u, `τ = τ₀ + c/s` for an event of s nats, and `Z = τ/(τ + ū)`, the mean
    /// of `exp(−u/τ)` where u is exponential with mean ū, as it is of two sounds at large.
    fn of(self, unlikeness: f64) -> f64 {
        let like = (-unlikeness / self.width).exp() / self.at_large;
        (1.0 - OTHER) * like + OTHER
    }
}

/// ln of how much likelier the sound of an event is after one of the same ball than it is at large; 0 where nothing is
/// known of one of them.
pub(super) fn ln_likeness(event: &Event, before: &Profile) -> f64 {
    if !event.profile.is_known() || !before.is_known() {
        return 0.0;
    }
    let likeness = Likeness::among(event.strength);
    likeness.of(event.profile.unlikeness(before)).ln()
}

/// ln of the density of what an event sounds like as the next impact of a ball, whose speed changes by this ratio.
pub(super) fn ln_sounds(before: &Event, event: &Event, ratio: f64) -> f64 {
    let louder = event.loudness - before.loudness - ratio.ln();
    ln_loudness_density(louder) + ln_likeness(event, &before.profile)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn event(profile: Profile) -> Event {
        Event {
            time_s: 0.0,
            jitter_s: 1e-4,
            strength: 200.0,
            loudness: 1.0,
            profile,
        }
    }

    #[test]
    fn what_sounds_otherwise_counts_less_and_what_sounds_alike_or_is_unknown_once() {
        let one = event(Profile::new([9.0, 1.0].into_iter()));
        let other = event(Profile::new([0.0, 0.0, 5.0].into_iter()));
        let unknown = event(Profile::default());
        let once = FRAC_1_SQRT_2 * FRAC_2_SQRT_PI / (2.0 * KERNEL_WIDTH);
        let kind = Kind::of(&one);
        let near = |density: f64, expected: f64| (density / expected - 1.0).abs() < 1e-12;
        assert!(near(kind.density_near(&one), once));
        assert!(near(kind.density_near(&other), OTHER * once));
        assert!(near(kind.density_near(&unknown), once));
        assert!(near(Kind::of(&unknown).density_near(&other), once));
    }

    #[test]
    fn what_is_much_louder_or_fainter_does_not_count() {
        let one = event(Profile::new([9.0, 1.0].into_iter()));
        let far = Event {
            loudness: one.loudness + 1.01 * KERNEL_REACH,
            ..one
        };
        assert!(Kind::of(&one).density_near(&far) == 0.0);
    }
}
