//! One drop of a scene: the ball, its fall, its bounces and its sound.

use serde::{Deserialize, Serialize};

use super::scene::within;
use crate::Error;
use crate::units::real;

/// One drop.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DropScene {
    /// From the ball's lowest point to the surface, in metres.
    pub height_m: f64,
    /// Each seed drops it from another height within this share of `height_m`, up or down. Default 0.
    #[serde(default)]
    pub height_spread: f64,
    /// When it first hits, in seconds from the start of the scene, up to a sample more: elsewhere for every seed.
    pub first_impact_s: f64,
    /// Mass in kilograms.
    pub mass_kg: f64,
    /// Diameter in metres.
    pub diameter_m: f64,
    /// Whether the air slows it. Default no.
    #[serde(default)]
    pub drag: bool,
    /// What happens at an impact.
    pub bounce: BounceScene,
    /// Standard deviation of ln e from bounce to bounce. Default 0.
    #[serde(default)]
    pub bounce_scatter: f64,
    /// ln of the ratio of e at odd impacts (the first, third, …) to e at even ones, as of a ball with a seam; the geometric
    /// mean stays. Default 0.
    #[serde(default)]
    pub alternation: f64,
    /// Deviations from the law of the bounce, at single impacts or from one on.
    #[serde(default)]
    pub changes: Vec<BounceChange>,
    /// The ball is caught after this impact. Default: never.
    #[serde(default)]
    pub most_impacts: Option<usize>,
    /// Distance to the microphone at the first impact, in metres: the sound comes later by 2.9 ms per metre. Its level
    /// is `peak_db` whatever the distance. Default 0.
    #[serde(default)]
    pub microphone_distance_m: f64,
    /// Speed at which the ball rolls away from the microphone, in m/s: the delay grows, the level falls. Default 0.
    #[serde(default)]
    pub leaving_m_per_s: f64,
    /// What rings, ball and surface.
    pub modes: Vec<Mode>,
    /// Standard deviation of ln level of each mode from impact to impact. Default 0.
    #[serde(default)]
    pub level_scatter: f64,
    /// Standard deviation of ln frequency of each mode from impact to impact, as each hits another spot of ball and surface.
    /// `timing_floor_s` of the truth leaves it out. Default 0.
    #[serde(default)]
    pub frequency_scatter: f64,
    /// Standard deviation of ln level of whole impacts. Default 0.
    #[serde(default)]
    pub loudness_scatter: f64,
    /// The force lasts as (v/v₁)^this: −0.2 for a solid sphere (Hertz). It changes the sound, not the flights. Default 0.
    #[serde(default)]
    pub contact_exponent: f64,
    /// How unlike each other impacts sound, from 0 to 1, as each hits another spot of ball and surface. At 1 every mode of every
    /// impact has a phase of its own from −π to π, a level of its own (standard deviation 6 dB), and every impact another
    /// loudness (3 dB); below, all three are that share of it. Real table-tennis balls on hard surfaces are at 0.15 to 0.5, thuds on
    /// a floor near 1. `timing_floor_s` of the truth leaves the phases out. Default 0.
    #[serde(default)]
    pub unlike: f64,
    /// The level of a mode falls with the speed of impacts by (v/v₁)^(this·octaves above the lowest mode) more than that of the
    /// lowest: by 6 dB an octave for half the speed at 1. Thuds lose their treble so along a drop. Default 0.
    #[serde(default)]
    pub treble_loss: f64,
    /// Sideways speed that each bounce adds, in either direction along the surface, as a share of the speed on leaving: its
    /// standard deviation. A surface that slopes by an angle turns a rebound by twice as much. The flights stay as they are; the
    /// ball hits elsewhere, which microphones and walls with a place tell. Default 0.
    #[serde(default)]
    pub sideways: f64,
    /// Repetitions of the drop with the same random numbers. Default: none.
    #[serde(default)]
    pub copies: Option<Copies>,
}

/// A deviation from the law of the bounce.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BounceChange {
    /// Number of the impact, from 1.
    pub impact: usize,
    /// Factor on the rebound speed, 0.01 to 2. The rebound is never faster than the impact.
    pub restitution_factor: f64,
    /// Whether it lasts from this impact on, as on another surface. Default no: one odd bounce, as on a joint of tiles.
    #[serde(default)]
    pub lasting: bool,
}

/// Repetitions of a drop.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Copies {
    /// Number of drops in all.
    pub count: usize,
    /// Time from one first impact to the next, in seconds.
    pub every_s: f64,
}

/// What happens at an impact: one of the laws of [`crate::physics`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum BounceScene {
    /// The same e and contact time at every impact; rest by the paper's (19).
    Constant {
        /// e.
        restitution: f64,
        /// ΔT in seconds.
        contact_time_s: f64,
    },
    /// The linear ball with its weight, from e and ΔT of a fast impact.
    Linear {
        /// e without weight.
        restitution: f64,
        /// ΔT without weight, in seconds.
        contact_time_s: f64,
    },
    /// The linear ball with its weight, from k and c.
    Spring {
        /// k.
        stiffness_n_per_m: f64,
        /// c.
        damping_n_s_per_m: f64,
    },
    /// `e = 1 − γ₁v^(1/5) + γ₂v^(2/5)`.
    Viscoelastic {
        /// γ₁.
        gamma1: f64,
        /// γ₂.
        gamma2: f64,
        /// ΔT in seconds.
        contact_time_s: f64,
    },
    /// `e = e_y·(max(v, v_y)/v_y)^(−p)`.
    Power {
        /// e below the yield speed.
        restitution: f64,
        /// `v_y`.
        yield_speed_m_per_s: f64,
        /// p.
        exponent: f64,
        /// ΔT in seconds.
        contact_time_s: f64,
    },
}

/// A damped oscillation that an impact sets off.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mode {
    /// Frequency in Hz. Above 0.45 of the sample rate it is left out, as a recorder's filter does.
    pub frequency_hz: f64,
    /// Time in which it falls to 1/e, in seconds.
    pub decay_s: f64,
    /// Amplitude for an impact of 1 m/s, in any unit: only the ratios between modes matter.
    pub level: f64,
}

impl DropScene {
    pub(super) fn check(&self, duration_s: f64) -> Result<(), Error> {
        within(
            "first_impact_s",
            self.first_impact_s,
            0.0..=duration_s,
            "a time within the recording",
        )?;
        within("height_spread", self.height_spread, 0.0..=0.9, "0 to 0.9")?;
        within("alternation", self.alternation, -1.0..=1.0, "-1 to 1")?;
        within(
            "frequency_scatter",
            self.frequency_scatter,
            0.0..=1.0,
            "0 to 1",
        )?;
        for change in &self.changes {
            change.check()?;
        }
        if let Some(copies) = self.copies {
            copies.check(self.first_impact_s, duration_s)?;
        }
        within("level_scatter", self.level_scatter, 0.0..=3.0, "0 to 3")?;
        within(
            "loudness_scatter",
            self.loudness_scatter,
            0.0..=3.0,
            "0 to 3",
        )?;
        within("unlike", self.unlike, 0.0..=1.0, "0 to 1")?;
        within("treble_loss", self.treble_loss, 0.0..=3.0, "0 to 3")?;
        within("sideways", self.sideways, 0.0..=0.5, "0 to 0.5")?;
        within(
            "contact_exponent",
            self.contact_exponent,
            -1.0..=1.0,
            "-1 to 1",
        )?;
        within(
            "microphone_distance_m",
            self.microphone_distance_m,
            0.0..=1e4,
            "0 to 10 km",
        )?;
        within(
            "leaving_m_per_s",
            self.leaving_m_per_s,
            0.0..=30.0,
            "0 to 30 m/s",
        )?;
        self.modes.iter().try_for_each(Mode::check)
    }
}

impl Mode {
    pub(super) fn check(&self) -> Result<(), Error> {
        let expected = "0.001 to 1000000 Hz";
        within("frequency_hz", self.frequency_hz, 1e-3..=1e6, expected)?;
        within("decay_s", self.decay_s, 1e-6..=60.0, "1 us to 60 s")?;
        within("level", self.level, 0.0..=1e30, "0 to 1e30")
    }
}

impl BounceChange {
    fn check(self) -> Result<(), Error> {
        within("impact", real(self.impact), 1.0..=1e6, "1 or more")?;
        within(
            "restitution_factor",
            self.restitution_factor,
            0.01..=2.0,
            "0.01 to 2",
        )
    }
}

impl Copies {
    fn check(self, first_s: f64, duration_s: f64) -> Result<(), Error> {
        within("count", real(self.count), 1.0..=1e4, "1 to 10000")?;
        within("every_s", self.every_s, 1e-3..=86_400.0, "1 ms to a day")?;
        if first_s + real(self.count - 1) * self.every_s > duration_s {
            let expected = "all copies to begin within the recording";
            return Err(Error::argument("every_s", self.every_s, expected));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use crate::synth::scene::Scene;

    #[test]
    fn a_change_of_a_bounce_out_of_range_is_named() {
        const DROP: &str = "name = 'x'\nduration_s = 9.0\n[[drops]]\nheight_m = 0.3\nfirst_impact_s = 1.0\nmass_kg = 0.01\n\
             diameter_m = 0.04\nmodes = []\nbounce.constant = { restitution = 0.9, contact_time_s = 1e-3 }\n";
        assert!(Scene::from_toml(DROP).is_ok());
        for (more, name) in [
            (
                "changes = [{ impact = 0, restitution_factor = 0.8 }]",
                "impact",
            ),
            (
                "changes = [{ impact = 3, restitution_factor = 0.0 }]",
                "restitution_factor",
            ),
            ("alternation = 1.5", "alternation"),
            ("frequency_scatter = -0.1", "frequency_scatter"),
            ("unlike = 1.1", "unlike"),
            ("treble_loss = -0.1", "treble_loss"),
            ("sideways = 0.6", "sideways"),
            ("copies = { count = 0, every_s = 1.0 }", "count"),
            ("copies = { count = 4, every_s = 3.0 }", "every_s"),
        ] {
            let error = Scene::from_toml(&format!("{DROP}{more}")).unwrap_err();
            let error = error.to_string();
            assert!(error.starts_with(name), "{error}");
        }
    }
}
