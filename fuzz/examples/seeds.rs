//! Writes the valid inputs of each target into `corpus/TARGET`, to begin from.

use std::fs;
use std::path::Path;

fn main() -> std::io::Result<()> {
    for (name, inputs) in bounce_audio_fuzz::seeds() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("corpus")
            .join(name);
        fs::create_dir_all(&folder)?;
        for (number, input) in inputs.iter().enumerate() {
            fs::write(folder.join(format!("valid-{number}")), input)?;
        }
    }
    Ok(())
}
