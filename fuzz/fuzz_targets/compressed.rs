#![no_main]

libfuzzer_sys::fuzz_target!(|input: &[u8]| bounce_audio_fuzz::run("compressed", input));
