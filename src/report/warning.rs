//! Warnings: a word for programs and a sentence for people, which is made where the cause is known.

use serde::{Deserialize, Serialize};

use crate::words::words;

/// A warning, with its remedy.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Warning {
    /// Which it is.
    pub code: WarningCode,
    /// A sentence for people.
    pub message: String,
}

/// Advice of which a front end may name the option: to listen to a part, and to give the height.
pub(crate) const LISTEN_TO_PART: &str = "listen only to its part of the recording";
pub(crate) const GIVE_HEIGHT: &str =
    "With the height of release two impacts are enough; more make it surer";

/// Words of what says that the height of release that was given does not fit the first flight.
const OF_HEIGHT: [WarningCode; 3] = [
    WarningCode::FirstImpactMissing,
    WarningCode::HeightTooSmall,
    WarningCode::WrongHeight,
];

/// Whether one of these words of warnings says that the height that was given does not fit.
pub(crate) fn doubt_height<'a>(mut words: impl Iterator<Item = &'a str>) -> bool {
    words.any(|word| OF_HEIGHT.iter().any(|code| code.word() == word))
}

impl Warning {
    /// A warning.
    #[must_use]
    pub fn new(code: WarningCode, message: impl Into<String>) -> Self {
        Self {
            code,
            message: message.into(),
        }
    }
}

words! {
    /// The cause of a warning.
    #[non_exhaustive]
    pub enum WarningCode {
        /// There is no sound in the recording.
        Silence = "silence",
        /// There are sounds, but no drop.
        NoDrop = "no_drop",
        /// There are more drops than fit the memory.
        LeftOut = "left_out",
        /// A drop lasts longer than what is held in memory, and stands in two parts.
        Torn = "torn",
        /// The recording was repaired before it was listened to.
        Repaired = "repaired",
        /// The file has several tracks of sound, of which one was listened to.
        SeveralTracks = "several_tracks",
        /// The recording is compressed with loss.
        Lossy = "lossy",
        /// The impacts are those of labels.
        ImpactsGiven = "impacts_given",
        /// There are only two impacts or three: e rests on the height, or on one ratio.
        FewBounces = "few_bounces",
        /// Bounces go by another e than the others, and are left out of it.
        IrregularBounces = "irregular_bounces",
        /// Bounces lose more and less by turns.
        BouncesAlternate = "bounces_alternate",
        /// Few flights tell the trend of e from chance badly.
        FewImpacts = "few_impacts",
        /// Impacts were not heard but inferred.
        Inferred = "inferred",
        /// Impacts may be chance.
        Doubtful = "doubtful",
        /// Impacts reach full scale.
        Clipped = "clipped",
        /// Impacts before the recording may be missing.
        LateStart = "late_start",
        /// Sounds as loud as the first impact and like it stand before it.
        LouderBefore = "louder_before",
        /// The recording ends before the ball rests.
        CutEnd = "cut_end",
        /// The impacts end before the ball would rest.
        EndedEarly = "ended_early",
        /// The first impact is missing, or the height is wrong.
        FirstImpactMissing = "first_impact_missing",
        /// The first flight is longer than the height allows.
        HeightTooSmall = "height_too_small",
        /// No e gives the total time.
        NoRoot = "no_root",
        /// The contact time that was given does not fit between impacts.
        ContactTooLong = "contact_too_long",
        /// A rebound is unlike the others.
        WildBounce = "wild_bounce",
        /// A time fits none of its neighbours.
        StrayTime = "stray_time",
        /// Another model explains the flights as well.
        ModelsAlike = "models_alike",
        /// e lies beyond that of each bounce.
        BeyondBounces = "beyond_bounces",
        /// The estimates of e disagree as the drag of the air makes them.
        AirDrag = "air_drag",
        /// They disagree as a wrong height makes them.
        WrongHeight = "wrong_height",
        /// They disagree as last bounces that were not heard make them.
        BouncesUnheard = "bounces_unheard",
        /// They disagree in another way.
        EstimatesDisagree = "estimates_disagree",
        /// With its weight the ball rests earlier than by (19).
        RestIsEarlier = "rest_is_earlier",
        /// (20) and (25) take the ball to rest after the last bounce heard.
        RestIsAssumed = "rest_is_assumed",
        /// ΔT by (20) moves much with e.
        ContactTimeIllConditioned = "contact_time_ill_conditioned",
        /// ΔT is known to its order only.
        ContactTimeUncertain = "contact_time_uncertain",
        /// The contact time that was given does not fit the bounces.
        ContactTimeDoesNotFit = "contact_time_does_not_fit",
        /// The contact time that was given and that of (20) differ.
        ContactTimesDisagree = "contact_times_disagree",
        /// More bounces than were heard may have been.
        BouncesAreALowerBound = "bounces_are_a_lower_bound",
        /// (30) is rough beside (25).
        Eq30IsRough = "eq30_is_rough",
        /// The drag of the air is left out.
        DragIsLeftOut = "drag_is_left_out",
        /// k and c belong to a rule of release.
        ReleaseRule = "release_rule",
    }
}
