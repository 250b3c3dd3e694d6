//! Two or three impacts of a ball that was caught, among the sounds that stand out: their flights are too few for a
//! chain, so all that a recording says of them counts.

mod likelihood;

use crate::event::Profile;
use crate::order::sort_by_number;
use likelihood::Likelihood;

/// A sound that stands out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClearSound {
    /// Its onset in seconds from the start of the recording.
    pub time_s: f64,
    /// How far off that may be, in seconds.
    pub jitter_s: f64,
    /// How loud it is: ln of the root mean square where it is loudest.
    pub level: f64,
    /// Whether most of it is over soon after its onset, as of what was struck.
    pub is_short: bool,
    /// Whether most of it was not there before: in flight a ball is silent.
    pub is_new: bool,
    /// How its energy is spread over the octaves.
    pub profile: Profile,
}

/// Sounds that may be the impacts of one drop.
#[derive(Debug, Clone, PartialEq)]
pub struct FewImpacts {
    /// Two sounds or three, in order of time.
    pub impacts: Vec<ClearSound>,
    /// ln of how much better a ball explains them than sounds that come by chance or from a hand.
    pub nats: f64,
    /// The same of the best other choice that takes another flight for the first; minus infinity where there is none.
    pub rival_nats: f64,
}

/// Nats by which a ball has to explain the impacts better than anything else. Measured: chosen where one of 200 clips without a ball
/// (`examples/found -- nothing`) has such a drop and those of `-- few` are kept; on seeds that were not looked at, 15 of 3,000 and
/// 777 of 800.
pub const LEAST_NATS: f64 = 6.5;
/// Nats by which it has to be better than any other choice: odds of 7 to 1.
const LEAST_LEAD: f64 = 2.0;

impl FewImpacts {
    /// Whether they are a drop.
    #[must_use]
    pub fn are_enough(&self) -> bool {
        self.nats >= LEAST_NATS && self.nats >= self.rival_nats + LEAST_LEAD
    }
}

/// The loudest sounds that may be impacts: a ball that someone records is not fainter than so many others.
const MOST_SOUNDS: usize = 60;

/// The two or three sounds that a ball explains best, whatever that is worth; none where no two are a flight apart.
///
/// `sounds` are in order of time, `duration_s` is how long they were listened for, `longest_flight_s` how long the first flight
/// from a known height is of a ball that loses nothing, `2√(2h/g)`.
#[must_use]
pub fn few_impacts(
    sounds: &[ClearSound],
    duration_s: f64,
    longest_flight_s: Option<f64>,
) -> Option<FewImpacts> {
    let likelihood = Likelihood::new(sounds, duration_s, longest_flight_s);
    let mut by_level: Vec<usize> = (0..sounds.len()).collect();
    sort_by_number(&mut by_level, |&i| -sounds[i].level);
    by_level.truncate(MOST_SOUNDS);
    // What only changes another sound is no impact, but stands beside those that may be.
    by_level.retain(|&i| sounds[i].is_new);
    by_level.sort_unstable();
    let mut choices: Vec<(Vec<usize>, f64)> = Vec::new();
    for (place, &first) in by_level.iter().enumerate() {
        for (further, &second) in by_level.iter().enumerate().skip(place + 1) {
            let Some(nats) = likelihood.pair(first, second) else {
                continue;
            };
            choices.push((vec![first, second], nats));
            let three = by_level[further + 1..].iter().filter_map(|&third| {
                let three = [first, second, third];
                Some((three.to_vec(), likelihood.three(three)?))
            });
            choices.extend(three.max_by(|a, b| a.1.total_cmp(&b.1)));
        }
    }
    sort_by_number(&mut choices, |(_, nats)| -nats);
    let (best, nats) = choices.first()?;
    let is_other = |choice: &&(Vec<usize>, f64)| choice.0[..2] != best[..2];
    let rival = choices.iter().find(is_other);
    Some(FewImpacts {
        impacts: best.iter().map(|&i| sounds[i]).collect(),
        nats: *nats,
        rival_nats: rival.map_or(f64::NEG_INFINITY, |choice| choice.1),
    })
}

#[cfg(test)]
mod tests;
