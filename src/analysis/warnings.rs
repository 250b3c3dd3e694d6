//! Warnings about a result, each with its remedy.

use super::model::Modelled;
use super::stretch::Stretch;
use crate::fit::Estimate;
use crate::fit::flights::Flights;
use crate::fit::total_time::{Missing, TotalTime, left_s};
use crate::impact::{Impact, Status};
use crate::report::{self, Candidate, GIVE_HEIGHT, LISTEN_TO_PART, Warning, WarningCode, counted};
use crate::sequence::Chain;

/// Fewest impacts without a warning: fewer flights hardly distinguish a trend of e from chance. Convention.
const FEW_IMPACTS: usize = 6;
/// With fewer than these [`few`](super::few) says what the answer rests on.
pub(super) const FEWEST_OF_CHAIN: usize = 4;
/// Samples of at least this size, as a share of full scale, count as clipped (convention) …
const CLIPPED: f32 = 0.9999;
/// … from this many on in the sound of the impacts.
const CLIPPED_SAMPLES: usize = 3;
/// Least strength of an event, in nats, that counts as a transient that a person would notice. Convention.
const NOTICEABLE: f64 = 30.0;

/// That e lies beyond the e of each bounce, and why.
pub(super) fn of_place(modelled: &Modelled, impacts: &[report::Impact]) -> Option<Warning> {
    let e = modelled.restitution.as_ref()?.estimate;
    e.interval95?;
    let bounces = impacts.iter().filter_map(|i| i.bounce.restitution);
    let (least, most) = bounces.fold((f64::INFINITY, 0.0_f64), |(least, most), e| {
        (least.min(e), most.max(e))
    });
    if most <= 0.0 || (least..=most).contains(&e.value) {
        return None;
    }
    let message = format!(
        "e is outside the values of the single bounces, {least:.4} to {most:.4}: those use the model {} alone, e is averaged over all models, \
         and with another contact or drag the same flights mean other speeds. To settle this, give the ball's mass and diameter, or its \
         contact time",
        modelled.model.selected
    );
    Some(Warning::new(WarningCode::BeyondBounces, message))
}

/// Sounds of the whole recording, for the warning where it has no drop.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Sounds {
    sound: bool,
    noticeable: usize,
}

impl Sounds {
    /// Adds a scene, by whether there was any sound and the strengths of its events.
    pub(super) fn add(&mut self, sound: bool, strengths: &[f64]) {
        self.sound |= sound;
        self.noticeable += strengths.iter().filter(|&&s| s >= NOTICEABLE).count();
    }

    /// Why there is no drop, what comes nearest to one, and what to do about it.
    pub(super) fn warning(self, candidate: Option<&Candidate>) -> Warning {
        // The first sound rises out of the silence before it, so a recording without a scene is silent.
        if !self.sound {
            return Warning::new(
                WarningCode::Silence,
                "the recording is silent: nothing in it is louder than -140 dB for a millisecond or more. Check that the \
                 right input was recorded",
            );
        }
        let message = match (candidate, self.noticeable) {
            (Some(candidate), 0) => format!(
                "no sharp sounds, and no drop beyond doubt. {}",
                candidate.in_words()
            ),
            (Some(candidate), sharp) => format!(
                "{}, but no drop beyond doubt. {}",
                counted(sharp, "sharp sound"),
                candidate.in_words()
            ),
            (None, 0) => {
                "no sound stands out clearly from the noise: move the microphone nearer, or check that the right input was recorded"
                    .to_owned()
            }
            (None, 1) => "one sharp sound, which is no flight: e takes two impacts and the height of release, or three impacts. Record for longer"
                .to_owned(),
            (None, sharp @ 2..=3) => format!(
                "{sharp} sharp sounds, but no two of them are alike and a flight apart as impacts of a ball are. {GIVE_HEIGHT}"
            ),
            (None, sharp) => format!(
                "{sharp} sharp sounds, but no sequence of them shrinks as the flights of a bouncing ball do. If there is a \
                 drop, {LISTEN_TO_PART}"
            ),
        };
        Warning::new(WarningCode::NoDrop, message)
    }
}

/// Warnings by the limit of memory.
pub(super) fn of_memory(left_out: usize, split: usize) -> Vec<Warning> {
    let mut warnings = Vec::new();
    if left_out > 0 {
        let message = format!(
            "{} with the least evidence left out: there are more than fit the memory. Listen to the recording part by part",
            counted(left_out, "drop")
        );
        warnings.push(Warning::new(WarningCode::LeftOut, message));
    }
    if split > 0 {
        let last = if split == 1 { "lasts" } else { "last" };
        let message = format!(
            "{} {last} longer than what is held in memory, and {} here in two parts. Record one drop at a time",
            counted(split, "drop"),
            if split == 1 { "stands" } else { "stand" }
        );
        warnings.push(Warning::new(WarningCode::Torn, message));
    }
    warnings
}

/// Warnings by the impacts of a drop.
pub(super) fn of_chain(stretch: &Stretch<'_>, chain: &Chain) -> Vec<Warning> {
    let mut warnings = Vec::new();
    let (timed, heard) = (&chain.impacts, chain.heard());
    if (FEWEST_OF_CHAIN..FEW_IMPACTS).contains(&heard) {
        let message = format!(
            "only {heard} impacts: the error of e rests on {}. Drop from higher, or record until the ball rests",
            counted(heard - 2, "ratio")
        );
        warnings.push(Warning::new(WarningCode::FewImpacts, message));
    }
    let inferred = timed.len() - heard;
    if inferred > 0 {
        let message = format!(
            "{inferred} of {} impacts not heard but inferred from their neighbours: move the microphone nearer",
            timed.len()
        );
        warnings.push(Warning::new(WarningCode::Inferred, message));
    }
    let doubtful = timed.iter().filter(|i| i.status == Status::Doubtful);
    let doubtful = doubtful.count();
    if doubtful > 0 {
        let message = format!(
            "{doubtful} of {heard} impacts doubtful, as noise offers sounds as strong nearby: record in a quieter room, or nearer"
        );
        warnings.push(Warning::new(WarningCode::Doubtful, message));
    }
    let clipped = timed
        .iter()
        .filter(|t| t.is_heard() && is_clipped(stretch, t.time_s))
        .count();
    if clipped > 0 {
        let message = {
            let reach = if clipped == 1 { "reaches" } else { "reach" };
            format!(
                "{} {reach} full scale: lower the recording level, or move the microphone away",
                counted(clipped, "impact")
            )
        };
        warnings.push(Warning::new(WarningCode::Clipped, message));
    }
    if let (Some(first), Some(second)) = (timed.first(), timed.get(1))
        && 2.0 * first.time_s - second.time_s < stretch.listened_from_s
    {
        let message = "the recording starts less than a flight before the first impact heard: earlier ones may be \
                       missing. Start recording before the drop";
        warnings.push(Warning::new(WarningCode::LateStart, message));
    }
    warnings
}

/// A contact time that was given, where two impacts are nearer than that.
pub(super) fn of_contact(given_s: Option<f64>, timed: &[Impact]) -> Option<Warning> {
    let apart_s = timed.windows(2).map(|w| w[1].time_s - w[0].time_s);
    let shortest_s = apart_s.fold(f64::INFINITY, f64::min);
    let given_s = given_s.filter(|&given_s| given_s >= shortest_s)?;
    let message = format!(
        "a contact of {} ms does not fit between impacts {:.1} ms apart, and nothing that rests on it holds: check \
         the contact time that was given",
        1e3 * given_s,
        1e3 * shortest_s
    );
    Some(Warning::new(WarningCode::ContactTooLong, message))
}

fn is_clipped(stretch: &Stretch<'_>, time_s: f64) -> bool {
    let sound = stretch.sound.between(time_s - 1e-3, time_s + 5e-3);
    sound.iter().filter(|x| x.abs() >= CLIPPED).count() >= CLIPPED_SAMPLES
}

/// The end of a drop whose flights have this ratio, in a recording that ends at `end_s`.
pub(super) fn of_end(
    timed: &[Impact],
    flights: &Flights,
    ratio: Option<Estimate>,
    end_s: f64,
) -> Option<Warning> {
    let left_s = left_s(timed, flights, ratio?.value);
    let recorded_s = end_s - timed.last()?.time_s;
    let message = format!(
        "the recording ends before the ball rests: it would go on for about {left_s:.2} s, of which {recorded_s:.2} s \
         were recorded. There is no total time, and equation (25) does not apply. Record for longer"
    );
    (left_s > recorded_s).then(|| Warning::new(WarningCode::CutEnd, message))
}

/// Why there is no total time, or no root.
pub(super) fn of_total_time(solved: &Result<TotalTime, Missing>) -> Option<Warning> {
    match *solved {
        Err(Missing::FirstImpact {
            first_flight_s,
            expected_s,
        }) => Some(Warning::new(
            WarningCode::FirstImpactMissing,
            format!(
                "the first flight heard is {first_flight_s:.3} s where the height makes it about {expected_s:.3} s: \
                 the first impact is missing or the height is wrong, so equation (25) does not apply. Record from \
                 before the drop, and measure the height from the ball's lowest point"
            ),
        )),
        Err(Missing::Height {
            first_flight_s,
            longest_s,
        }) => Some(Warning::new(
            WarningCode::HeightTooSmall,
            format!(
                "the first flight is {first_flight_s:.3} s, but from this height it cannot exceed {longest_s:.3} s: \
                 measure the height again, or the clock runs wrong, as that of a slowed recording does; equation (25) does not \
                 apply"
            ),
        )),
        Err(Missing::End { left_s }) => Some(Warning::new(
            WarningCode::EndedEarly,
            format!(
                "the impacts end {left_s:.2} s before the ball would rest: it was caught, or its last impacts are too \
                 faint. There is no total time, and equation (25) does not apply. Let it come to rest, and move the microphone nearer"
            ),
        )),
        Ok(TotalTime {
            eq25: None,
            total_time_s,
            ..
        }) => Some(Warning::new(
            WarningCode::NoRoot,
            format!(
                "no e gives a total time of {total_time_s:.3} s by equation (25): check the height"
            ),
        )),
        Ok(_) => None,
    }
}
