//! Speed and memory, against the limit, which is reading the files in blocks and summing squares: ten minutes of mostly
//! silence and of all bouncing; five seconds from process start to JSON; a folder of those, all cores at work. Then from a
//! minute to ten hours through a pipe.
//! `cargo bench --bench throughput`
#![expect(clippy::print_stdout, reason = "a benchmark prints")]
#![allow(clippy::unwrap_used, reason = "a failing benchmark should panic")]

use std::fs::{self, File};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Instant;

use bounce_audio::audio::Stream;
use bounce_audio::synth::{render, scene};
use bounce_audio::{Listener, Settings};

const DURATION_S: usize = 600;
const RATE_HZ: usize = 44_100;
const REPEATS: usize = 9;
/// Processes started for the time from start to JSON, and recordings of a folder.
const STARTS: usize = 20;
const IN_FOLDER: usize = 20;

/// Hiss, in which a drop of four seconds begins every `period_s`.
fn recording(name: &str, duration_s: usize, period_s: usize) -> PathBuf {
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
    for i in 0..duration_s * RATE_HZ {
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

/// Drops found in a file, as the command goes about it.
fn analysis(path: &Path) -> usize {
    let mut stream = Stream::open_file(path).unwrap();
    let rate = f64::from(stream.sample_rate_hz());
    let mut listener = Listener::new(1, rate, &Settings::default()).unwrap();
    let mut next = |room: &mut [Vec<f32>]| stream.append(&(0..1), room).unwrap();
    while listener.push_with(&mut next).unwrap() {}
    listener.finish().unwrap().1.drops.len()
}

fn median_s(repeats: usize, mut run: impl FnMut()) -> f64 {
    run();
    let mut times: Vec<f64> = (0..repeats)
        .map(|_| {
            let start = Instant::now();
            run();
            start.elapsed().as_secs_f64()
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[repeats / 2]
}

fn command(file: &str, input: Stdio) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_bounce-audio"));
    command.args(["analyze", file, "--format", "json"]);
    command.stdin(input).stdout(Stdio::null()).spawn().unwrap()
}

/// Greatest memory that a process has held so far, in MiB; none where the system does not say.
fn peak_mib(process: &Child) -> Option<f64> {
    let status = fs::read_to_string(format!("/proc/{}/status", process.id())).ok()?;
    let line = status.lines().find(|l| l.starts_with("VmHWM"))?;
    let kib: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kib / 1024.0)
}

/// Time and memory of the command on a pipe that gives a recording's samples again and again.
fn through_a_pipe(wav: &[u8], minutes: usize) -> (f64, Option<f64>) {
    let (header, samples) = wav.split_at(44);
    let start = Instant::now();
    let mut process = command("-", Stdio::piped());
    let mut pipe = process.stdin.take().unwrap();
    // A streamed header gives no length.
    pipe.write_all(&header[..40]).unwrap();
    pipe.write_all(&[0xFF; 4]).unwrap();
    let minute = 2 * 60 * RATE_HZ;
    for i in 0..minutes {
        let from = minute * (i % (samples.len() / minute));
        pipe.write_all(&samples[from..from + minute]).unwrap();
    }
    let memory = peak_mib(&process);
    drop(pipe);
    process.wait().unwrap();
    (start.elapsed().as_secs_f64(), memory)
}

/// A row of the table: a case, how much sound it has, its time and that of the limit.
fn tell(name: &str, sound_s: usize, own_s: f64, limit_s: f64, drops: usize) {
    #[expect(clippy::cast_precision_loss, reason = "600 s")]
    let speed = sound_s as f64 / own_s;
    println!(
        "{name:<13} {:>7.1} ms {:>8.2} ms  {:.4} {speed:>14.0} {drops:>6}",
        1e3 * own_s,
        1e3 * limit_s,
        limit_s / own_s
    );
}

/// Ten minutes in which a drop begins every `period_s`.
fn ten_minutes(name: &str, period_s: usize) -> PathBuf {
    let path = recording(&format!("{name}.wav"), DURATION_S, period_s);
    let limit_s = median_s(REPEATS, || assert!(sum_of_squares(&path) > 0.0));
    let mut drops = 0;
    let own_s = median_s(REPEATS, || drops = analysis(&path));
    tell(name, DURATION_S, own_s, limit_s, drops);
    path
}

/// Five seconds with a drop, by a process of their own; gives the recording.
fn from_start() -> PathBuf {
    let path = recording("five-seconds.wav", 5, 5);
    let limit_s = median_s(STARTS, || assert!(sum_of_squares(&path) > 0.0));
    let file = path.display().to_string();
    let own_s = median_s(STARTS, || {
        let status = command(&file, Stdio::null()).wait().unwrap();
        assert!(status.success());
    });
    tell("from-start", 5, own_s, limit_s, 1);
    path
}

/// A folder of copies of a recording of five seconds.
fn folder_of(recording: &Path) {
    let folder = recording.with_file_name("throughput-folder");
    fs::create_dir_all(&folder).unwrap();
    let copies = (0..IN_FOLDER).map(|i| folder.join(format!("{i}.wav")));
    let copies: Vec<PathBuf> = copies.collect();
    for copy in &copies {
        fs::copy(recording, copy).unwrap();
    }
    let limit_s = median_s(REPEATS, || {
        assert!(copies.iter().all(|copy| sum_of_squares(copy) > 0.0));
    });
    let own_s = median_s(REPEATS, || {
        let mut batch = Command::new(env!("CARGO_BIN_EXE_bounce-audio"));
        batch.arg("batch").arg(&folder);
        let status = batch.stdout(Stdio::null()).stderr(Stdio::null()).status();
        assert!(status.unwrap().success());
    });
    tell("folder", 5 * IN_FOLDER, own_s, limit_s, IN_FOLDER);
}

fn main() {
    println!("recording      analysis       limit   ratio  audio s per s  drops");
    ten_minutes("one-drop", DURATION_S);
    let mostly_silent = ten_minutes("mostly-silent", 60);
    ten_minutes("dense", 4);
    folder_of(&from_start());
    println!("\nmostly silent, through a pipe\n  minutes   seconds  seconds a minute   peak MiB");
    let wav = fs::read(mostly_silent).unwrap();
    for minutes in [1, 10, 60, 600] {
        let (seconds, memory) = through_a_pipe(&wav, minutes);
        #[expect(clippy::cast_precision_loss, reason = "600 minutes")]
        let each = seconds / minutes as f64;
        let memory = memory.map_or("-".to_owned(), |mib| format!("{mib:.1}"));
        println!("{minutes:>9} {seconds:>9.2} {each:>17.4} {memory:>10}");
    }
}
