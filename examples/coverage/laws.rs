//! Balls whose laws the fit does not contain, and some that it does: e and contact time at a speed.

use bounce_audio::random::SplitMix64;

/// A speed in the middle of a drop, in m/s, at which the laws state their e.
const MIDDLE: f64 = 1.5;

/// How a ball loses by speed, and how its bounces scatter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Law {
    /// The same at every speed, with contact and drag.
    Constant,
    /// A power of the speed, with contact and drag.
    Power,
    /// A sphere of Hertz's force with a viscoelastic loss, `m·ẍ = −k·x^(3/2) − A·k·√x·ẋ − m·g`, integrated.
    Hertz,
    /// A shell: stiff below a speed, above it buckling and losing.
    Shell,
    /// Elastic below a yield speed and plastic above it, after Walton and Braun: `(1 + (v/v_y)²)^(-1/8)`.
    Yielding,
    /// Spin that turns into speed at the first impacts: e falls towards fast ones.
    Spin,
    /// A step in e, smooth in ln v.
    Bend,
    /// A wave in e, one to the factor seven in speed.
    Wave,
    /// A contact that is the longer the slower the impact, `v^(−0.3)`.
    SoftContact,
    /// Two faces that hit in turns.
    Alternating,
    /// Seams: bounces that scatter by Student's distribution of three degrees of freedom.
    Seams,
}

pub(crate) const INSIDE: [Law; 2] = [Law::Constant, Law::Power];
pub(crate) const OUTSIDE: [Law; 9] = [
    Law::Hertz,
    Law::Shell,
    Law::Yielding,
    Law::Spin,
    Law::Bend,
    Law::Wave,
    Law::SoftContact,
    Law::Alternating,
    Law::Seams,
];

/// A ball of a law.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ball {
    pub(crate) law: Law,
    /// e in the middle; of a Hertz sphere it follows from the loss.
    e: f64,
    /// Contact time in the middle, in seconds.
    contact_s: f64,
    /// K in s⁻².
    pub(crate) drag_per_s2: f64,
    /// How much e depends on the speed.
    strength: f64,
    /// The speed at which the law turns, in m/s.
    turn: f64,
}

impl Ball {
    /// A ball as balls at large are: contact from 0.05 to 5 ms, no drag or that of up to a ping-pong ball.
    pub(crate) fn of(law: Law, rng: &mut SplitMix64) -> Self {
        let contact_s = 5e-5 * 100_f64.powf(rng.uniform());
        let heavy = rng.uniform() < 0.5;
        Self {
            law,
            e: 0.55 + 0.4 * rng.uniform(),
            contact_s,
            drag_per_s2: if heavy { 0.05 } else { 1.5 } * rng.uniform(),
            strength: rng.uniform(),
            turn: 1.0 + rng.uniform(),
        }
    }

    /// ln e and the contact time of an impact, before it scatters.
    pub(crate) fn impact(&self, speed: f64) -> (f64, f64) {
        let (ln, at) = (self.e.ln(), (speed / MIDDLE).ln());
        let beyond = (speed / self.turn).ln();
        let contact_s = self.contact_s;
        let shorter = |power: f64| contact_s * (-power * at).exp();
        match self.law {
            Law::Constant | Law::Alternating | Law::Seams => (ln, contact_s),
            Law::Power => (ln - 0.15 * self.strength * at, contact_s),
            Law::Hertz => self.hertz(speed),
            Law::Shell => (ln - 0.15 * self.strength * beyond.max(0.0), shorter(0.2)),
            Law::Yielding => {
                let plastic = -0.125 * (speed / (0.5 + self.turn)).powi(2).ln_1p();
                (0.3 * ln + self.strength * plastic, contact_s)
            }
            Law::Spin => (
                ln - 0.03 * self.strength * (2.0 * at).exp().min(4.0),
                contact_s,
            ),
            Law::Bend => (ln - 0.03 * self.strength * (2.0 * beyond).tanh(), contact_s),
            Law::Wave => {
                let wave = (std::f64::consts::PI * at).sin();
                (ln + 0.008 * self.strength * wave, contact_s)
            }
            Law::SoftContact => (ln, shorter(0.3)),
        }
    }

    /// What the bounce of this number adds to ln e, of a unit scatter.
    pub(crate) fn scatter(&self, number: usize, rng: &mut SplitMix64) -> f64 {
        match self.law {
            Law::Alternating => rng.normal() + if number.is_multiple_of(2) { 1.0 } else { -1.0 },
            Law::Seams => {
                let squares: f64 = (0..3).map(|_| rng.normal().powi(2)).sum();
                rng.normal() / (squares / 3.0).sqrt()
            }
            _ => rng.normal(),
        }
    }

    /// Runge and Kutta's fourth order through the contact, in steps of a four-hundredth of its usual length; the ball leaves
    /// where the force is none.
    fn hertz(&self, speed: f64) -> (f64, f64) {
        const STEPS: f64 = 400.0;
        // Hertz: T = 2.943·(m²/(k²·v))^(1/5).
        let stiffness = (2.943 / self.contact_s).powf(2.5) / MIDDLE.sqrt();
        let loss_s = 0.25 * self.contact_s * (0.05 + 0.3 * self.strength);
        let push = |x: f64, v: f64| {
            let x = x.max(0.0);
            stiffness * x.sqrt() * (x + loss_s * v)
        };
        let step_s = self.contact_s / STEPS;
        let (mut x, mut v, mut time_s) = (0.0, speed, 0.0);
        let slope = |x: f64, v: f64| (v, 9.81 - push(x, v));
        loop {
            let (a, b) = slope(x, v);
            let (c, d) = slope(x + 0.5 * step_s * a, v + 0.5 * step_s * b);
            let (e, f) = slope(x + 0.5 * step_s * c, v + 0.5 * step_s * d);
            let (g, h) = slope(x + step_s * e, v + step_s * f);
            let next = x + step_s / 6.0 * (a + 2.0 * c + 2.0 * e + g);
            v += step_s / 6.0 * (b + 2.0 * d + 2.0 * f + h);
            x = next;
            time_s += step_s;
            let resting = time_s > 4.0 * self.contact_s;
            if (v < 0.0 && push(x, v) <= 0.0) || resting {
                return ((-v / speed).max(1e-3).ln(), time_s);
            }
        }
    }
}
