//! Ten minutes of recording, mostly silence and all bouncing: time of the analysis against the limit, which is reading
//! the file in blocks and summing squares. `cargo bench --bench throughput`
#![expect(clippy::print_stdout, reason = "a benchmark prints")]
#![allow(clippy::unwrap_used, reason = "a failing benchmark should panic")]

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::time::Instant;

use bounce_audio::analysis::{Settings, analyze_clearest};
use bounce_audio::synth::{render, scene};
use bounce_audio::wav;

const DURATION_S: usize = 600;
const RATE_HZ: usize = 44_100;
const REPEATS: usize = 9;

/// A recording in which a drop of four seconds begins every `period_s`.
fn recording(name: &str, period_s: usize) -> PathBuf {
    let made = render(&scene::preset("steel").unwrap(), 1).unwrap().samples;
    let mut quiet = scene::preset("noise").unwrap();
    quiet.noise.white_db = -70.0;
    let hiss = render(&quiet, 1).unwrap().samples;
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let spec = hound::WavSpec {
        channels: 1,
        sample_rate: 44_100,
        bits_per_sample: 16,
        sample_format: hound::SampleFormat::Int,
    };
    let mut writer = hound::WavWriter::create(&path, spec).unwrap();
    for i in 0..DURATION_S * RATE_HZ {
        let drop = made.get(i % (period_s * RATE_HZ)).copied().unwrap_or(0.0);
        let sample = 0.9 * drop + hiss[i % hiss.len()];
        #[expect(clippy::cast_possible_truncation, reason = "samples of 16 bits")]
        writer.write_sample((32_767.0 * sample) as i16).unwrap();
    }
    writer.finalize().unwrap();
    path
}

/// The limit: blocks of bytes to 16-bit samples to a sum of squares, nothing kept.
fn sum_of_squares(path: &Path) -> f64 {
    let mut file = File::open(path).unwrap();
    let mut block = vec![0; 1 << 16];
    let mut sum = 0.0;
    loop {
        let got = file.read(&mut block).unwrap();
        if got == 0 {
            return sum;
        }
        let mut lanes = [0.0_f32; 16];
        for chunk in block[..got].as_chunks::<2>().0.as_chunks::<16>().0 {
            for (lane, bytes) in lanes.iter_mut().zip(chunk) {
                let x = f32::from(i16::from_le_bytes(*bytes));
                *lane += x * x;
            }
        }
        sum += lanes.iter().copied().map(f64::from).sum::<f64>();
    }
}

fn analysis(path: &Path) -> usize {
    let recording = wav::read_file(path).unwrap();
    let rate = f64::from(recording.sample_rate_hz);
    analyze_clearest(&recording.channels, rate, &Settings::default())
        .unwrap()
        .1
        .drops
        .len()
}

fn median_s(mut run: impl FnMut()) -> f64 {
    run();
    let mut times: Vec<f64> = (0..REPEATS)
        .map(|_| {
            let start = Instant::now();
            run();
            start.elapsed().as_secs_f64()
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[REPEATS / 2]
}

fn main() {
    println!("recording      analysis      limit   ratio  audio s per s  drops");
    for (name, period_s) in [("mostly-silent.wav", 60), ("dense.wav", 4)] {
        let path = recording(name, period_s);
        let limit_s = median_s(|| assert!(sum_of_squares(&path) > 0.0));
        let mut drops = 0;
        let own_s = median_s(|| drops = analysis(&path));
        #[expect(clippy::cast_precision_loss, reason = "600 s")]
        let speed = DURATION_S as f64 / own_s;
        println!(
            "{:<13} {:>7.0} ms {:>7.1} ms  {:.4} {speed:>14.0} {drops:>6}",
            name.trim_end_matches(".wav"),
            1e3 * own_s,
            1e3 * limit_s,
            limit_s / own_s
        );
    }
}
