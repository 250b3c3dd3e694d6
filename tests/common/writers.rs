//! What writes files, for the tests of writing.

/// Every command that writes a file, up to the file's name, and an ending that it takes.
pub(crate) const WRITERS: [(&str, &str); 9] = [
    ("synth --preset dead -o", "wav"),
    ("analyze drop.wav --labels", "txt"),
    ("analyze drop.wav --plot", "svg"),
    ("analyze drop.wav --plot", "png"),
    (
        "solve --bounces 70 --total-time 7.5s --height 30.5cm --plot",
        "svg",
    ),
    ("evaluate . --plot", "svg"),
    ("evaluate . --tighten", "toml"),
    ("batch drop.wav -o", "csv"),
    ("batch drop.wav --plot", "svg"),
];
