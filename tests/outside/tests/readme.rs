//! The README's example of the library, in a package of its own.

use bounce_audio::{Error, Listener, Settings, analyze};

/// A click every flight of a ball with e = 0.8, at 8 kHz.
fn clicks() -> Vec<f32> {
    let mut samples = vec![0.0_f32; 32_000];
    let (mut at_s, mut flight_s) = (0.5, 0.5);
    while flight_s > 0.01 {
        samples[(at_s * 8_000.0) as usize] = 0.5;
        at_s += flight_s;
        flight_s *= 0.8;
    }
    samples
}

#[test]
fn samples_give_the_restitution() -> Result<(), Error> {
    let analysis = analyze(&clicks(), 8_000.0, &Settings::default().height_m(1.0))?;
    let e = analysis.drops[0]
        .restitution
        .as_ref()
        .map(|r| r.estimate.value);
    assert!((e.unwrap_or_default() - 0.8).abs() < 0.002, "{e:?}");
    Ok(())
}

#[test]
fn blocks_give_what_the_whole_gives() -> Result<(), Error> {
    let settings = Settings::default();
    let mut listener = Listener::new(1, 8_000.0, &settings)?;
    for block in clicks().chunks(1_000) {
        listener.push(&[block])?;
    }
    let (_, heard) = listener.finish()?;
    assert_eq!(heard, analyze(&clicks(), 8_000.0, &settings)?);
    Ok(())
}
