//! Priors on balls at large, in one place: those of the tracker, of the fit, and of e drawn out beyond the speeds heard.
//!
//! Each is a convention: wide enough for every ball that is named beside it, and no wider than ten times that.
//!
//! | quantity | prior | balls that it has to hold |
//! |---|---|---|
//! | ln e | [`LN_RESTITUTION`] | e from 0.35 to 0.99 |
//! | C, contact time | [`CONTACT_S`], [`LONG_CONTACT_S`], [`MIDDLE_CONTACT_S`], [`LITTLE_CONTACT_S`], [`TRACKED_CONTACT_S`] | steel 0.1 ms, ping-pong 0.68 ms (Jena, Wassin and Gibbon 2021), basketball 12 ms |
//! | K, drag | [`DRAG_PER_S2`], [`TRACKED_DRAG_PER_S2`], [`MUCH_DRAG_PER_S2`], [`LITTLE_DRAG_PER_S2`] | `(g/v_t)²` of [`FlightLaw::in_air`](super::FlightLaw::in_air): steel 0.02, golf 0.1, ping-pong 1.4, foam 5 s⁻² |
//! | p, how e falls with the speed | [`SPEED_EXPONENT`], [`SPEED_EXPONENT_BEYOND`] | tennis 0.06; ¼ for plastic contact, by theory |
//! | smooth departure of ln e from its law | [`BEND`] | |
//! | scatter of ln e | [`BOUNCE_STD`], [`BOUNCE_STD_AT_LARGE`], [`TRACKED_BOUNCE_STD`] | ping-pong 0.005 (Erickson 2020) |
//!
//! The tracker, which takes all balls to be of one kind and their e to be the same at all speeds, has numbers of its own
//! where that makes its quantity another one; each says so.

/// A normal prior of a quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Known {
    /// Its centre.
    pub value: f64,
    /// Its standard deviation, > 0.
    pub std: f64,
}

impl Known {
    /// A quantity that is given, with its relative standard error.
    #[must_use]
    pub const fn within(value: f64, relative_std: f64) -> Self {
        Self {
            value,
            std: value * relative_std,
        }
    }

    /// The same for a multiple of the quantity.
    #[must_use]
    pub const fn times(self, factor: f64) -> Self {
        Self {
            value: factor * self.value,
            std: factor * self.std,
        }
    }
}

/// ln e before any flight is known: e about 0.82, with a spread that covers 0.35 to 0.99. The fit has none: three impacts
/// say more.
pub const LN_RESTITUTION: Known = Known {
    value: -0.2,
    std: 0.35,
};

/// C of balls at large where all have one prior, in seconds: from a steel ball's tenth of a millisecond to a basketball's twelve.
pub const CONTACT_S: Known = Known {
    value: 2e-3,
    std: 6e-3,
};

/// C of balls that hardly yield, in seconds: steel, glass, stone and golf balls; one in twenty has more than two of these.
pub const LITTLE_CONTACT_S: Known = Known {
    value: 0.0,
    std: 1.5e-4,
};

/// C of balls that yield a little, in seconds: ping-pong and bouncy balls of rubber.
pub const MIDDLE_CONTACT_S: Known = Known {
    value: 0.0,
    std: 1e-3,
};

/// C of soft balls, in seconds: the root of the mean square of tennis's 5 ms, a football's 8 and a basketball's 12.
pub const LONG_CONTACT_S: Known = Known {
    value: 0.0,
    std: 9e-3,
};

/// C for the tracker, in seconds: a fifth of [`CONTACT_S`]. The tracker takes e to be the same at all speeds, and of the
/// contact of a ball with its weight it then sees only `ΔT − 4ζ(1 + e)/(ω(1 − e))`, 0.19 to 0.20 of ΔT for e from 0.95 to
/// 0.5, as slow impacts lose more.
pub const TRACKED_CONTACT_S: Known = CONTACT_S.times(0.2);

/// Relative standard error of a contact time that is given: unless it is measured no one knows it better.
pub const CONTACT_RELATIVE_STD: f64 = 0.05;

/// K of balls that the air slows where all have one prior, in s⁻²: 1.4 for a ping-pong ball, 5 for a foam ball.
pub const DRAG_PER_S2: Known = Known {
    value: 1.0,
    std: 2.0,
};

/// K of balls that the air slows, in s⁻²: 1.4 for a ping-pong ball; a foam ball's 5 are more than three of these, and its
/// flights tell. Of a ball that the air hardly slows see [`LITTLE_DRAG_PER_S2`].
pub const MUCH_DRAG_PER_S2: Known = Known {
    value: 0.0,
    std: 1.5,
};

/// β/K of small balls, in s²: the air that a ball displaces, as a share of its mass, for the drag that slows it.
/// `β/K = 4d/(3·C_d·g)` is 0.30 times the diameter in metres: 0.005 for a marble, 0.012 for a ping-pong ball, 0.013 for a
/// golf ball.
pub const DISPLACED_PER_DRAG_S2: Known = Known {
    value: 0.012,
    std: 0.008,
};

/// What each second of contact adds to [`DISPLACED_PER_DRAG_S2`], in s: larger balls are softer. Tennis, 5 ms, has 0.020, a
/// football, 8 ms, 0.066, a basketball, 12 ms, 0.073.
pub const DISPLACED_PER_DRAG_AND_CONTACT_S: Known = Known {
    value: 4.0,
    std: 4.0,
};

/// β of balls at large where the flights do not tell their drag: steel 0.0002, golf 0.001, tennis 0.003, ping-pong and a
/// basketball 0.015, a volleyball 0.023.
pub const DISPLACED: Known = Known {
    value: 0.006,
    std: 0.008,
};

/// K for the tracker, in s⁻²: half of [`DRAG_PER_S2`], as half of the balls have next to none and it takes all to be of one
/// kind.
pub const TRACKED_DRAG_PER_S2: Known = DRAG_PER_S2.times(0.5);

/// K where drag is no part of the model, in s⁻²: there is air all the same, 0.02 for steel, 0.1 for a golf ball. One in ten
/// of what is thought of as such a ball has more than 0.1.
pub const LITTLE_DRAG_PER_S2: Known = Known {
    value: 0.0,
    std: 0.06,
};

/// p of balls at large, `e ∝ v^(−p)`: e of a tennis ball falls by 6 % where the speed grows by the factor 2.7, that of a
/// plastic one by 22 %.
pub const SPEED_EXPONENT: Known = Known {
    value: 0.05,
    std: 0.1,
};

/// Sizes that a smooth departure of ln e from its law can have over a factor of 2.5 in speed: e of real balls differs by 0.2 to
/// 0.5 % between the fast and the slow half of a drop beyond drag (17 recordings); of shells, and where spin turns into
/// speed, by some per cent.
pub const BEND: [f64; 2] = [4e-3, 3e-2];

/// Standard deviation of p about 0 for a ball whose e was the same at all speeds heard, beyond those: smaller than that of
/// [`SPEED_EXPONENT`], as what the drop showed speaks against a large one.
pub const SPEED_EXPONENT_BEYOND: f64 = 0.05;

/// ln e of a single bounce about that of its ball: standard deviation, and the half-width that holds 95 %. Derived from what
/// balls at large scatter by: 0.003 for three in ten, 0.01 for half, 0.03 for one in seven, 0.09 for one in 25, which is what the
/// first is of; the second allows for one bounce in fifty that is an accident of 0.3.
pub const ONE_BOUNCE: (f64, f64) = (0.022, 0.053);

/// Standard deviation of a contact time of which nothing is known, in seconds, about none: 0.1 ms for steel, and the 5 ms of a
/// tennis ball are two of these.
pub const UNKNOWN_CONTACT_STD_S: f64 = 2.5e-3;

/// Range of the scatter of ln e from bounce to bounce: below it no ball is known, and a bounce that differs by a third is
/// none.
pub const BOUNCE_STD: (f64, f64) = (1e-6, 0.3);

/// ln of the scatter of ln e from bounce to bounce for balls at large, and how widely that is spread: about 0.6 %, a factor of e
/// either way. Real balls have 0.25 % at least (17 recordings): less is not ruled out, as synthetic ones have it, but data
/// have to show it.
pub const BOUNCE_STD_AT_LARGE: Known = Known {
    value: -5.115_995_809_754_082,
    std: 1.0,
};

/// Scatter of the flights about their trend for the tracker before the drop's own is learnt: twice that of a ping-pong
/// ball.
pub const TRACKED_BOUNCE_STD: f64 = 0.01;

/// Range of the scatter that the tracker believes, which learns it from the last few bounces: a few flights may agree by
/// chance, and what scatters more is no ball.
pub const TRACKED_BOUNCE_STDS: (f64, f64) = (3e-3, 0.05);
