//! Runs of the changed program, each in a process of its own: a change may end in a panic or never.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use super::figures::Figures;

/// Processes at a time.
const JOBS: usize = 2;
/// A run that lasts for so many of the run without a change is given up.
const TOO_LONG: f64 = 8.0;

/// Where a run's figures are kept.
pub(crate) fn result_path(results: &Path, change: &str) -> PathBuf {
    results.join(change.replace(['/', ':'], "_") + ".txt")
}

/// The figures of a run, if it came to its end.
pub(crate) fn result(results: &Path, change: &str) -> Option<Figures> {
    Figures::from_text(&fs::read_to_string(result_path(results, change)).ok()?)
}

/// Runs the program without a change and then with each.
pub(crate) fn all(
    scorer: &Path,
    suite: &Path,
    results: &Path,
    changes: &[String],
) -> io::Result<()> {
    fs::create_dir_all(results)?;
    let start = Instant::now();
    one(scorer, suite, results, "", Duration::from_secs(3600))?;
    let longest = start.elapsed().mul_f64(TOO_LONG) + Duration::from_secs(10);
    let next = AtomicUsize::new(0);
    thread::scope(|scope| {
        for _ in 0..JOBS {
            scope.spawn(|| {
                while let Some((i, change)) = take(&next, changes) {
                    if let Err(error) = one(scorer, suite, results, change, longest) {
                        eprintln!("{change}: {error}");
                    }
                    eprint!(
                        "\r{} of {}, {:.0} s ",
                        i + 1,
                        changes.len(),
                        start.elapsed().as_secs_f64()
                    );
                }
            });
        }
    });
    eprintln!();
    Ok(())
}

fn take<'a>(next: &AtomicUsize, changes: &'a [String]) -> Option<(usize, &'a String)> {
    let index = next.fetch_add(1, Ordering::Relaxed);
    changes.get(index).map(|change| (index, change))
}

fn one(
    scorer: &Path,
    suite: &Path,
    results: &Path,
    change: &str,
    longest: Duration,
) -> io::Result<()> {
    let output = File::create(result_path(results, change))?;
    let mut child = Command::new(scorer)
        .arg("score")
        .arg(suite)
        .env("BOUNCE_AUDIO_ABLATION", change)
        .stdout(Stdio::from(output))
        .stderr(Stdio::null())
        .spawn()?;
    let start = Instant::now();
    while child.try_wait()?.is_none() {
        if start.elapsed() > longest {
            child.kill()?;
        }
        thread::sleep(Duration::from_millis(20));
    }
    Ok(())
}
