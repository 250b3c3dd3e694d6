//! Draws Figures 2 to 7 of Nagurka and Huang from the equations, as SVG and PNG.
//!
//! ```text
//! cargo run --release --example paper_figures [FOLDER]      (default: target/figures)
//! ```
#![allow(clippy::print_stdout, reason = "an example says what it wrote")]

mod figures;

use std::path::PathBuf;

use bounce_audio::{Error, plot};

fn main() -> Result<(), Error> {
    let folder = std::env::args_os()
        .nth(1)
        .map_or_else(|| PathBuf::from("target/figures"), PathBuf::from);
    std::fs::create_dir_all(&folder).map_err(|e| Error::from(e).in_file(&folder))?;
    for (name, figure) in figures::all()? {
        for (ending, bytes) in [
            ("svg", plot::to_svg(&figure)?.into_bytes()),
            ("png", plot::to_png(&figure)?),
        ] {
            let path = folder.join(format!("{name}.{ending}"));
            std::fs::write(&path, bytes).map_err(|e| Error::from(e).in_file(&path))?;
            println!("{}", path.display());
        }
    }
    Ok(())
}
