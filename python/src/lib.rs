//! The Rust half of the Python package `bounce_audio`: arrays in, documents out.
//!
//! Results cross the border as the JSON documents of the command line, which the Python half makes into dataclasses, so
//! that both say the same to the last digit. Whatever takes long runs without the interpreter's lock.

mod asked;
mod compared;
mod errors;
mod failure;
mod listener;
mod pictures;
mod recordings;
mod samples;
mod solved;
mod synthetic;
mod timed;

use pyo3::prelude::pymodule;

/// It keeps memory that is given back. The system's would have the kernel clear it again, in a worker of Dask each time: that
/// costs a quarter of a drop's time.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// What the Python half of the package is built on; its names are not promised.
#[pymodule]
mod _core {
    #[pymodule_export]
    use crate::compared::{Digests, compare, drop_columns, drop_rows};
    #[pymodule_export]
    use crate::errors::system_words;
    #[pymodule_export]
    use crate::failure::break_off;
    #[pymodule_export]
    use crate::listener::Listener;
    #[pymodule_export]
    use crate::pictures::Pictures;
    #[pymodule_export]
    use crate::recordings::{analyze, analyze_bytes, analyze_file, is_named_as_recording, rules};
    #[pymodule_export]
    use crate::solved::{solve_contact, solve_total_time};
    #[pymodule_export]
    use crate::synthetic::{presets, synth};
    #[pymodule_export]
    use crate::timed::fit;

    /// Version of the package.
    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");
}
