//! How many threads a command has, and those that one recording is listened to with.

use std::thread;

use rayon::ThreadPoolBuilder;

use crate::workers::{Task, Workers};

/// As many threads as were asked for, or one for each core.
pub(super) fn count(asked: Option<u16>) -> usize {
    let cores = || thread::available_parallelism().map_or(1, usize::from);
    asked.map_or_else(cores, usize::from)
}

/// Most threads for one recording: each needs memory of its own, and more drops than that are seldom measured at once.
const MOST: usize = 8;

/// As many threads as were asked for, or one for each core, for the whole process; where the system gives none, all is done
/// by the one that there is.
pub(super) fn workers(asked: Option<u16>) -> Workers {
    let threads = count(asked).min(MOST);
    let pool = ThreadPoolBuilder::new().num_threads(threads);
    if threads > 1 && pool.build_global().is_ok() {
        Workers::new(side_by_side)
    } else {
        Workers::default()
    }
}

fn side_by_side(tasks: Vec<Task<'_>>) {
    rayon::scope(|scope| {
        for task in tasks {
            scope.spawn(|_| task());
        }
    });
}
