//! The `bounce-audio` command.

fn main() {}
