//! Builds the page: `xtask LIBRARY.wasm PAGE DIST`.
//!
//! The library is bound by `wasm-bindgen` of the locked version. DIST gets the page in files, to be served, and one file that
//! holds it whole and works from a disk.

mod pack;
mod scripts;

use std::error::Error;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

use wasm_bindgen_cli_support::Bindgen;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<PathBuf> = env::args_os().skip(1).map(PathBuf::from).collect();
    let [library, page, dist] = arguments.as_slice() else {
        return Err("usage: xtask LIBRARY.wasm PAGE DIST".into());
    };
    let (glue, wasm) = bound(library, dist)?;
    if dist.exists() {
        fs::remove_dir_all(dist)?;
    }
    fs::create_dir_all(dist)?;
    let parts = pack::Parts::read(page, &glue, wasm)?;
    parts.write_files(dist)?;
    parts.write_one(&dist.join("bounce-audio.html"))?;
    Ok(())
}

/// The script and the library that `wasm-bindgen` makes of what was compiled.
fn bound(library: &Path, dist: &Path) -> Result<(String, Vec<u8>), Box<dyn Error>> {
    let aside = dist.with_extension("bound");
    let mut bindgen = Bindgen::new();
    bindgen.input_path(library).out_name("library");
    bindgen.no_modules(true)?.typescript(false);
    bindgen
        .remove_producers_section(true)
        .remove_name_section(true);
    bindgen.generate(&aside)?;
    let read = || -> io::Result<(String, Vec<u8>)> {
        Ok((
            fs::read_to_string(aside.join("library.js"))?,
            fs::read(aside.join("library_bg.wasm"))?,
        ))
    };
    let bound = read()?;
    fs::remove_dir_all(&aside)?;
    Ok(bound)
}
