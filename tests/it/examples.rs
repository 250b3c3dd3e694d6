//! The examples of the library run, and what they assert holds.

#[path = "../../examples/analyze_samples.rs"]
mod analyze_samples;
#[path = "../../examples/compare_models.rs"]
mod compare_models;
#[path = "../../examples/synthesize.rs"]
mod synthesize;

use bounce_audio::Error;

#[test]
fn samples_in_memory_are_analyzed() -> Result<(), Error> {
    analyze_samples::main()
}

#[test]
fn recordings_are_made() -> Result<(), Error> {
    synthesize::main()
}

#[test]
fn models_are_compared() -> Result<(), Error> {
    compare_models::main()
}
