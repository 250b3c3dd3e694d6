//! Mutated and random input: nothing may panic, hang, or hold more than 256 MiB.
//!
//! A run of a few seconds with every `cargo test`, the same one each time. For a long run in which nothing may take
//! more than a second of a processor either:
//!
//! ```sh
//! BOUNCE_AUDIO_FUZZ=1000000 BOUNCE_AUDIO_FUZZ_SEED=2 cargo test --release --test fuzz walk -- --nocapture
//! ```
//!
//! `cargo fuzz` runs the same targets from `fuzz/`, guided by the paths that an input takes:
//!
//! ```sh
//! cd fuzz && cargo run --example seeds && cargo +nightly fuzz run --fuzz-dir . walk
//! ```
//!
//! What fails is written to `target/tmp/TARGET-SEED`; in `fixtures/crashes/TARGET` it is replayed from then on.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::print_stderr,
    reason = "a failing test should panic, and a long run says how far it came"
)]

mod choose;
mod mutate;
mod targets;

use std::env;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use bounce_audio::random::SplitMix64;
use targets::{Target, analyze, compressed, labels, scene, units, walk};

/// What one execution may take of a processor in a long run.
const LONGEST: Duration = Duration::from_secs(1);
/// What all of them may hold, in KiB.
const MOST_HELD_KIB: u64 = 256 << 10;

fn number(variable: &str) -> Option<u64> {
    Some(env::var(variable).ok()?.parse().unwrap())
}

/// The most that this process ever held, where the system says so.
fn most_held_kib() -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|l| l.starts_with("VmHWM:"))?;
    line.split_whitespace().nth(1)?.parse().ok()
}

/// How long this thread has had a processor, where the system says so.
fn on_processor() -> Option<Duration> {
    let text = fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds = text.split_whitespace().next()?.parse().ok()?;
    Some(Duration::from_nanos(nanoseconds))
}

/// Runs a target on one input; gives what it took.
fn execute(target: &Target, name: &str, input: &[u8], seed: u64) -> Duration {
    let start = Instant::now();
    let run = catch_unwind(AssertUnwindSafe(|| {
        (target.run)(input, &mut SplitMix64::new(seed));
    }));
    let took = start.elapsed();
    assert!(run.is_ok(), "{}", keep(target.name, name, input));
    took
}

/// Writes what failed where it can be had; gives where that is.
fn keep(target: &str, name: &str, input: &[u8]) -> String {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{target}-{name}"));
    fs::write(&path, input).unwrap();
    format!("failed on {}", path.display())
}

/// Runs a target so often, or as often as the environment says.
fn fuzz(target: &Target, times: u64) {
    let long = number("BOUNCE_AUDIO_FUZZ");
    let first = number("BOUNCE_AUDIO_FUZZ_SEED").unwrap_or(1) << 32;
    let valid = (target.valid)();
    let (mut slowest, mut slow) = (Duration::ZERO, 0);
    for seed in first..first + long.unwrap_or(times) {
        let input = mutate::mutated(&mut SplitMix64::new(seed), &valid, target.words);
        let mut took = execute(target, &seed.to_string(), &input, seed);
        // A busy machine is no hang: what counts is the time on a processor.
        if long.is_some() && took > LONGEST {
            let before = on_processor();
            took = execute(target, &seed.to_string(), &input, seed);
            if let (Some(before), Some(after)) = (before, on_processor()) {
                took = after - before;
            }
        }
        if long.is_some() && took > LONGEST {
            slow += 1;
            eprintln!(
                "{took:?}: {}",
                keep(target.name, &format!("slow-{seed}"), &input)
            );
        }
        slowest = slowest.max(took);
    }
    let held = most_held_kib();
    if long.is_some() {
        eprintln!(
            "{}: slowest {slowest:?}, most held {held:?} KiB",
            target.name
        );
    }
    assert_eq!(slow, 0, "took longer than {LONGEST:?}");
    assert!(
        held.is_none_or(|kib| kib < MOST_HELD_KIB),
        "{held:?} KiB held"
    );
}

#[test]
fn the_walk_and_the_decoders() {
    fuzz(&walk(), 3_000);
}

#[test]
fn compressed_sound() {
    fuzz(&compressed(), 300);
}

#[test]
fn labels_of_other_tools() {
    fuzz(&labels(), 20_000);
}

#[test]
fn quantities_with_units() {
    fuzz(&units(), 20_000);
}

#[test]
fn scenes() {
    fuzz(&scene(), 2_000);
}

#[test]
fn the_whole_analyze() {
    fuzz(&analyze(), 150);
}

#[test]
fn every_crash_found_is_mended() {
    let crashes = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/crashes");
    for target in targets::all() {
        let Ok(files) = fs::read_dir(crashes.join(target.name)) else {
            continue;
        };
        let mut files: Vec<PathBuf> = files.map(|file| file.unwrap().path()).collect();
        files.sort();
        for file in files {
            let name = file.file_name().unwrap().to_string_lossy().into_owned();
            // The name ends with the seed, which settings are made from.
            let seed = name.rsplit('-').next().and_then(|seed| seed.parse().ok());
            let took = execute(&target, &name, &fs::read(&file).unwrap(), seed.unwrap_or(1));
            // A hang that was found took half a minute; a busy machine takes some hundredths of a second now.
            assert!(took < 5 * LONGEST, "{name} took {took:?}");
        }
    }
}
