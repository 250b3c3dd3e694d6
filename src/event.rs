//! What a detector gives a tracker.

/// A moment at which something may have struck.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// Seconds from the start of the recording.
    pub time_s: f64,
    /// Standard deviation of the time in seconds: of a rise in energy an eighth of a millisecond for a click and a
    /// millisecond or two for a thud, of a match 0.05 ms or more.
    pub jitter_s: f64,
    /// Evidence that something struck, in nats: the log-likelihood ratio of a rise in energy, summed over bands, or of a
    /// match of z standard deviations, z²/2.
    pub strength: f64,
    /// How loud it is, as a natural logarithm: of the size of a match, which goes with the speed of an impact, or of the
    /// nats of a rise. It is comparable among events that were found in one way.
    pub loudness: f64,
}
